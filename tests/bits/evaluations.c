/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Prints the results of some thousand evaluations to the last bit, to be compared with those of another compiler or
 * machine. Trigonometry belongs to libm and may round otherwise there, so the pair's own numbers, which are derived
 * with it, are read from a file that one of the machines has written: from there on only +, -, *, / and sqrt follow.
 *
 *     evaluations FILE --write     writes the pair, and prints
 *     evaluations FILE             reads the pair, and prints
 */
#include "gearmesh/gearmesh.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FACE_NODES = 9, PROFILE_NODES = 13, OTHER_FACE_NODES = 6, STATES = 700, PAIRS = 4 };

static const double degree = 0.017453292519943295;

static double uniform(uint64_t *seed, double low, double high) {
    *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * ((double)(*seed >> 11) * 0x1p-53);
}

static void stop(const char *what) {
    fprintf(stderr, "evaluations: %s\n", what);
    exit(1);
}

static void check(int status) {
    if (status != GM_OK) {
        stop(gm_status_text(status));
    }
}

static gm_pair make_pair(int number) {
    static const double helix[PAIRS] = {33.0, -33.0, 8.0, 0.0};
    gm_pair_params params;
    gm_pair pair;
    gm_pair_params_default(&params);
    params.pinion_teeth = 45;
    params.wheel_teeth = 41;
    params.normal_module = 1.65e-3;
    params.normal_pressure_angle = 16.0 * degree;
    params.helix_angle = helix[number] * degree;
    params.center_distance = number < 2 ? 85e-3 : 72e-3;
    params.face_width = 17.5e-3;
    params.backlash = number == 1 ? -4e-6 : 100e-6; /* both sides touch, or one */
    check(gm_pair_init(&pair, &params));
    return pair;
}

static gm_flanks make_flanks(int teeth, int coast_face_nodes, uint64_t *seed, void **memory) {
    const gm_flanks_params sizes = {
        teeth, teeth, FACE_NODES, PROFILE_NODES, teeth, coast_face_nodes, PROFILE_NODES};
    const size_t size = gm_flanks_size(&sizes);
    double values[FACE_NODES * PROFILE_NODES];
    gm_flanks flanks;
    *memory = malloc(size);
    if (*memory == NULL) {
        stop("no memory");
    }
    check(gm_flanks_init(&flanks, &sizes, *memory, size));
    for (int tooth = 0; tooth < teeth; ++tooth) {
        for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
            for (int k = 0; k < FACE_NODES * PROFILE_NODES; ++k) {
                values[k] = uniform(seed, -3e-6, 3e-6);
            }
            check(gm_flanks_set_table(&flanks, side, tooth, values, 1.125));
            check(gm_flanks_set_pitch(&flanks, side, tooth, uniform(seed, -2e-6, 2e-6)));
        }
    }
    return flanks;
}

/* The same flanks with linear reliefs: an end, a tip and a corner. */
static gm_flanks with_ramps(const gm_flanks *flanks, uint64_t *seed) {
    gm_flanks ramped = *flanks;
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        const double face = uniform(seed, 5e-6, 20e-6), profile = uniform(seed, 5e-6, 20e-6);
        const gm_flank_ramp ramps[] = {
            {3e-6, -face, 0.0}, {4e-6 - profile, 0.0, profile}, {5e-6, -face, -profile}};
        check(gm_flanks_set_ramps(&ramped, side, ramps, 3, 1.125));
    }
    return ramped;
}

static void print_result(const gm_penetration *r) {
    printf("%a %a %a %a %a %a %d %d\n", r->penetration, r->rate, r->drive_contact, r->coast_contact,
           r->d_pinion_angle, r->d_wheel_angle, r->drive_pairs, r->coast_pairs);
}

static void print_pair(const gm_pair *pair, uint64_t *seed) {
    void *memory[2];
    const gm_flanks pinion = make_flanks(pair->pinion.teeth, FACE_NODES, seed, &memory[0]);
    const gm_flanks wheel = make_flanks(pair->wheel.teeth, OTHER_FACE_NODES, seed, &memory[1]);
    const gm_flanks ramped_pinion = with_ramps(&pinion, seed);
    const gm_flanks ramped_wheel = with_ramps(&wheel, seed);
    for (int k = 0; k < STATES; ++k) {
        const gm_flanks *wheel_flanks = k % 7 == 0 ? NULL : k % 3 == 0 ? &ramped_wheel : &wheel;
        const gm_flanks *pinion_flanks = k % 5 == 0 ? NULL : k % 4 == 0 ? &ramped_pinion : &pinion;
        const double angle = uniform(seed, -1e4, 1e4);
        const double offset = 0.5 * pair->backlash + uniform(seed, -8e-6, 8e-6);
        gm_position position;
        gm_penetration result;
        gm_state state = {angle, 0.0, 100.0, 0.0};
        check(gm_position_from_pinion_angle(pair, angle, k % 2 == 0 ? offset : -offset, 1e-3,
                                            &position));
        check(gm_penetration_3d_at(pair, pinion_flanks, wheel_flanks, &position, &result));
        print_result(&result);
        check(gm_penetration_3d_sum_at(pair, pinion_flanks, wheel_flanks, &position, &result));
        printf("%a %a\n", result.drive, result.coast);
        state.wheel_angle = (pair->pinion.base_radius * angle - offset) / pair->wheel.base_radius;
        check(gm_penetration_3d(pair, pinion_flanks, wheel_flanks, &state, &result));
        print_result(&result);
        if (k % 16 == 0) {
            const int status = gm_static_equilibrium(pair, pinion_flanks, wheel_flanks, angle, 1e8,
                                                     20.0, &position.offset, &result);
            printf("%d %a\n", status, position.offset);
        }
    }
    free(memory[0]);
    free(memory[1]);
}

int main(int argc, char **argv) {
    gm_pair pairs[PAIRS];
    uint64_t seed = 11;
    const int writes = argc == 3 && strcmp(argv[2], "--write") == 0;
    if (argc != 2 && !writes) {
        stop("usage: evaluations FILE [--write]");
    }

    memset(pairs, 0, sizeof pairs);
    if (writes) {
        for (int k = 0; k < PAIRS; ++k) {
            pairs[k] = make_pair(k);
        }
    }
    FILE *file = fopen(argv[1], writes ? "wb" : "rb");
    if (file == NULL || (writes ? fwrite(pairs, sizeof pairs, 1, file)
                                : fread(pairs, sizeof pairs, 1, file)) != 1) {
        stop("the file of the pairs");
    }
    if (fclose(file) != 0) {
        stop("the file of the pairs");
    }
    for (int k = 0; k < PAIRS; ++k) {
        print_pair(&pairs[k], &seed);
    }
    return 0;
}
