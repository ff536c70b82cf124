// SPDX-FileCopyrightText: The gearmesh authors
// SPDX-License-Identifier: BSD-3-Clause

// Both headers are C++ as well, without a warning.
#include <gearmesh/gearmesh.h>
#include <gearmesh/gearmesh_io.h>
#include <string>

int main() {
    gm_pair_params params;
    gm_pair_params_default(&params);
    gm_pair pair;
    gm_flanks_options options;
    gm_flanks_options_default(&options);
    const bool refused = gm_pair_init(&pair, &params) < 0; // nothing required is set
    const bool same_version = std::string(gm_version()) == GM_VERSION_STRING;
    return refused && same_version ? 0 : 1;
}
