/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Any bytes as the INI file of gearflanks --scatter: refused, or flanks are made whose every value is finite and not
 * larger than all amounts together, or the amounts are refused. Twice the same bytes, twice the same flanks.
 */
#include "fuzz.h"
#include "fuzz_file.h"

#include <config.h>
#include <math.h>
#include <scatter.h>

static fuzz_file input;

static gm_pair gears(void) {
    gm_pair_params params;
    gm_pair pair;
    gm_pair_params_default(&params);
    params.pinion_teeth = 9;
    params.wheel_teeth = 11;
    params.normal_module = 2e-3;
    params.normal_pressure_angle = 0.35;
    params.helix_angle = 0.2;
    params.center_distance = 20.5e-3;
    params.face_width = 10e-3;
    params.pinion_profile_shift = 0.3;
    FUZZ_CLAIM(gm_pair_init(&pair, &params) == GM_OK);
    return pair;
}

/* Each amount is 10 mm at most, and six standard deviations of as much. */
static int is_value(double value) {
    return isfinite(value) && fabs(value) < 1.0;
}

static void claim_flanks(const gm_deviations *deviations, const gm_pitch *pitch) {
    for (int i = 0; i < deviations->set_count; ++i)
        for (int node = 0; node < 9 * 9; ++node)
            FUZZ_CLAIM(is_value(deviations->sets[i].values[node]));
    for (int i = 0; i < pitch->teeth; ++i)
        FUZZ_CLAIM(is_value(pitch->drive[i]) && is_value(pitch->coast[i]));
}

/* A number that tells the flanks from others; -1 = refused by the library, -2 = with the file. */
static double make(const gm_pair *pair) {
    scatter_file file;
    gm_generate_options options;
    gm_deviations deviations;
    gm_pitch pitch;
    double sum = -1.0;

    if (scatter_read(&file, fuzz_file_path(&input), NULL) != 0)
        return -2.0;
    gm_generate_options_default(&options);
    options.scatter = &file.amounts;
    options.face_nodes = options.profile_nodes = 9;
    if (gm_flanks_generate(&deviations, &pitch, pair, 0, &options, NULL) == GM_IO_OK) {
        claim_flanks(&deviations, &pitch);
        sum = 100.0 + deviations.sets[0].values[0] + pitch.drive[0];
        gm_deviations_free(&deviations);
        gm_pitch_free(&pitch);
    }
    scatter_free(&file);
    return sum;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    const gm_pair pair = gears();
    fuzz_file_with(&input, data, size);
    const double first = make(&pair);
    FUZZ_CLAIM(first == make(&pair));
    return 0;
}
