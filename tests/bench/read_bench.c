/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * What a flank file costs: `read_bench FILE TEETH N` reads it N times and prints its nodes. For callgrind: the difference of
 * two N is exact.
 */
#include "gearmesh/gearmesh_io.h"

#include <stdio.h>
#include <stdlib.h>

int main(int argc, char **argv) {
    if (argc != 4) {
        fprintf(stderr, "usage: read_bench FILE TEETH N\n");
        return 2;
    }
    const int teeth = atoi(argv[2]);
    const long count = atol(argv[3]);
    long nodes = 0;

    for (long k = 0; k < count; ++k) {
        gm_deviations deviations;
        gm_io_error error;
        if (gm_deviations_read(&deviations, argv[1], teeth, &error) != GM_IO_OK) {
            fprintf(stderr, "read_bench: line %ld: %s\n", error.line, error.text);
            return 1;
        }
        nodes += (long)deviations.set_count * deviations.face_nodes * deviations.profile_nodes;
        gm_deviations_free(&deviations);
    }
    printf("%ld nodes\n", nodes);
    return 0;
}
