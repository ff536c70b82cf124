/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The meshes of random_meshes.py, evaluated in C; compiled as C++ too. One line for each state: status, and the bits of what
 * an evaluation gives.
 *
 *     random_meshes MESHES.txt
 */
#include "parameter_places.h"

#include <gearmesh/gearmesh.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TABLES = 3, NODES_MAX = 64 };

static void stop(const char *what) {
    fprintf(stderr, "random_meshes: %s\n", what);
    exit(1);
}

static double number(FILE *file) {
    double value;
    if (fscanf(file, "%lf", &value) != 1) {
        stop("a number is missing");
    }
    return value;
}

static void read_fields(FILE *file, void *params, const parameter_place *places, size_t count) {
    if ((size_t)number(file) != count) {
        stop("not the parameters of this header");
    }
    for (size_t k = 0; k < count; ++k) {
        parameter_set(params, &places[k], number(file));
    }
}

static void *memory_of(size_t size) {
    void *memory = calloc(1, size > 0 ? size : 1);
    if (memory == NULL) {
        stop("out of memory");
    }
    return memory;
}

static void check(int status) {
    if (status != GM_OK) {
        stop(gm_status_text(status));
    }
}

/* The same table for all teeth and both sides; NULL for no nodes. */
static gm_flanks *flanks_of(const gm_pair *pair, int gear, int rows, int columns,
                            const double *table) {
    gm_flanks_params params;
    gm_flanks *flanks = NULL;
    if (rows == 0) {
        return NULL;
    }
    params.teeth = gear == GM_PINION ? pair->pinion.teeth : pair->wheel.teeth;
    params.drive_tables = params.coast_tables = 1;
    params.drive_face_nodes = params.coast_face_nodes = rows;
    params.drive_profile_nodes = params.coast_profile_nodes = columns;
    const size_t size = gm_flanks_size(&params);
    check(gm_flanks_init(&flanks, &params, memory_of(size), size));
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        check(gm_flanks_set_table(flanks, side, GM_ALL_TEETH, table, pair->normal_to_transverse));
    }
    return flanks;
}

typedef struct random_mesh {
    double gap; /* NaN: one helix */
    gm_mesh *half[2];
    gm_double_helical gears;
} random_mesh;

static void read_mesh(FILE *file, random_mesh *made) {
    gm_pair_params drawing, half;
    gm_mesh_params law;
    gm_pair pair;
    double table[TABLES][NODES_MAX];
    gm_pair_params_default(&drawing);
    gm_mesh_params_default(&law);
    made->gap = number(file);
    read_fields(file, &drawing, pair_places, PAIR_PLACES);
    read_fields(file, &law, law_places, LAW_PLACES);

    /* Of the pinion, of the wheel, and of the pinion's second half, in um. */
    const int rows = (int)number(file), columns = (int)number(file);
    for (int k = 0; k < TABLES; ++k) {
        for (int node = 0; node < rows * columns; ++node) {
            table[k][node] = 1e-6 * number(file);
        }
    }

    const int halves = isnan(made->gap) ? 1 : 2;
    gm_pose poses[2] = {law.pose, law.pose};
    half = drawing;
    if (halves == 2) {
        check(gm_double_helical_half(&drawing, made->gap, &half));
    }
    check(gm_pair_init(&pair, &half));
    if (halves == 2) {
        check(gm_double_helical_pose(&pair, made->gap, &law.pose, poses));
        law.stiffness *= 0.5;
        law.damping *= 0.5;
        law.simple_stiffness *= 0.5;
        law.reference_torque *= 0.5;
        made->gears.gap = made->gap;
    }
    for (int k = 0; k < halves; ++k) {
        law.pose = poses[k];
        const size_t size = gm_mesh_size(&law, &pair);
        check(gm_mesh_init(&made->half[k], &law, &pair,
                           flanks_of(&pair, GM_PINION, rows, columns, table[k == 1 ? 2 : 0]),
                           flanks_of(&pair, GM_WHEEL, rows, columns, table[1]), memory_of(size),
                           size));
        const size_t workspace_size = gm_workspace_size(made->half[k]);
        made->gears.half[k] = made->half[k];
        check(gm_workspace_init(&made->gears.workspace[k], made->half[k], memory_of(workspace_size),
                                workspace_size));
    }
}

static void print_bits(const double *values, size_t count) {
    for (size_t k = 0; k < count; ++k) {
        uint64_t bits;
        memcpy(&bits, &values[k], sizeof bits);
        if (isnan(values[k])) {
            printf(" NaN"); /* of whatever bits */
        } else {
            printf(" %016" PRIX64, bits);
        }
    }
}

/* The tangent of laws that have one; else 0. */
static void print_tangent(const random_mesh *made, const gm_motion *motion) {
    gm_tangent tangent;
    memset(&tangent, 0, sizeof tangent);
    if (isnan(made->gap) && gm_mesh_tangent(made->half[0], motion, &tangent) != GM_OK) {
        memset(&tangent, 0, sizeof tangent);
    }
    print_bits(tangent.force_by, GM_COORDINATES);
    print_bits(tangent.force_by_rate, GM_COORDINATES);
    for (int k = 0; k < GM_COORDINATES; ++k) {
        print_bits(tangent.wrench_by[k].wheel_moment, 3);
    }
}

static gm_pose read_pose(FILE *file) {
    gm_pose pose;
    pose.center_distance_change = number(file);
    pose.offset = number(file);
    pose.axial_shift = number(file);
    pose.skew = number(file);
    pose.inclination = number(file);
    return pose;
}

static void evaluate_state(FILE *file, const random_mesh *made) {
    gm_state state;
    gm_motion motion;
    gm_mesh_result each[2], result;
    double apex = 0.0;
    state.pinion_angle = number(file);
    state.wheel_angle = number(file);
    state.pinion_speed = number(file);
    state.wheel_speed = number(file);
    motion.pose = read_pose(file);
    motion.pose_rate = read_pose(file);
    check(gm_position_from_state(gm_mesh_pair(made->half[0]), &state, &motion.position));

    const int wanted = GM_WANT_DERIVATIVES | GM_WANT_WRENCH;
    const int status = isnan(made->gap)
                           ? gm_mesh_evaluate_posed(made->half[0], &motion, wanted,
                                                    made->gears.workspace[0], &result)
                           : gm_double_helical_evaluate_at(&made->gears, &motion.position, wanted,
                                                           &apex, each, &result);
    printf("%d", status);
    print_bits(&result.force, 1);
    print_bits(&result.pinion_torque, 1);
    print_bits(&result.wheel_torque, 1);
    print_bits(&result.loss, 1);
    print_bits(&result.force_by.pinion_angle, 4);
    print_bits(result.wrench.pinion_force, 12);
    print_bits(&apex, 1);
    print_tangent(made, &motion);
    printf("\n");
}

int main(int argc, char **argv) {
    FILE *file = argc == 2 ? fopen(argv[1], "r") : NULL;
    if (file == NULL) {
        stop("needs a file of meshes");
    }
    const int meshes = (int)number(file);
    for (int k = 0; k < meshes; ++k) {
        random_mesh made;
        memset(&made, 0, sizeof made);
        read_mesh(file, &made);
        const int states = (int)number(file);
        for (int state = 0; state < states; ++state) {
            evaluate_state(file, &made);
        }
    }
    fclose(file);
    return 0;
}
