/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * What elastic teeth cost: `elastic_bench PAIR N [FLANKS [EDGES [POSITIONS]]]` evaluates a mesh with all its derivatives at N
 * positions in a row, POSITIONS [60] to a base pitch, with an approach that swings by 5 % beside the roll, and prints the
 * processor time of each. For callgrind: the difference of two N is exact.
 *
 *     PAIR    0 the reference pair with its deep rack, 1 stage 3 of the NREL 5 MW gearbox, 2 a spur pair; 17 stations
 *     FLANKS  tables: of 21 x 31 nodes for each tooth of both gears; ideal
 *     EDGES   path: lines end with the path of contact; corners: they go on beyond it
 */
#include "gearmesh/gearmesh.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const double degree = 0.017453292519943295;
static const double two_pi = 6.283185307179586;

enum { FACE_NODES = 21, PROFILE_NODES = 31 };

typedef struct bench_pair {
    double normal_module, pressure_angle_deg, helix_angle_deg, center_distance, face_width;
    int teeth[2];
    double shift[2], tip_radius[2], dedendum, fillet_radius;
    double approach; /* the mean of x (m) */
} bench_pair;

static const bench_pair pairs[3] = {
    {1.65e-3,
     16.0,
     33.0,
     85e-3,
     17.5e-3,
     {45, 41},
     {0.1242, 0.1242},
     {46.93839e-3, 43.003591e-3},
     1.75,
     0.37,
     6e-6},
    {14e-3,
     20.0,
     10.0,
     0.8610001467,
     0.36,
     {24, 95},
     {0.48, 0.6691},
     {0.1903736708, 0.6976880969},
     1.25,
     0.38,
     32e-6},
    {2e-3, 20.0, 0.0, 0.124, 0.02, {62, 62}, {0.0, 0.0}, {0.064, 0.064}, 1.25, 0.38, 5.5e-6}};

/* What the evaluations give must be used, or the compiler leaves them out. */
static volatile double sink;

static void check(int status, const char *what) {
    if (status != GM_OK) {
        fprintf(stderr, "elastic_bench: %s: %s\n", what, gm_status_text(status));
        exit(1);
    }
}

static void *allocate(size_t size) {
    void *memory = malloc(size);
    if (memory == NULL) {
        check(GM_ERR_MEMORY, "memory");
    }
    return memory;
}

/* Crowned by a micrometre or two, with a wave that differs from tooth to tooth. */
static gm_flanks *make_flanks(const gm_pair *pair, int teeth) {
    const gm_flanks_params sizes = {teeth, teeth,      FACE_NODES,   PROFILE_NODES,
                                    teeth, FACE_NODES, PROFILE_NODES};
    const size_t size = gm_flanks_size(&sizes);
    gm_flanks *flanks;
    check(gm_flanks_init(&flanks, &sizes, allocate(size), size), "flanks");
    for (int tooth = 0; tooth < teeth; ++tooth) {
        double values[FACE_NODES * PROFILE_NODES];
        for (int face = 0; face < FACE_NODES; ++face) {
            for (int profile = 0; profile < PROFILE_NODES; ++profile) {
                const double u = 2.0 * (double)face / (FACE_NODES - 1) - 1.0;
                const double v = 2.0 * (double)profile / (PROFILE_NODES - 1) - 1.0;
                values[face * PROFILE_NODES + profile] =
                    1e-6 * (-1.0 * u * u - 0.7 * v * v + 0.2 * sin(4.0 * u + 3.0 * v + tooth));
            }
        }
        check(gm_flanks_set_table(flanks, GM_DRIVE, tooth, values, pair->normal_to_transverse),
              "table");
        check(gm_flanks_set_pitch(flanks, GM_DRIVE, tooth, 0.3e-6 * sin(two_pi * tooth / teeth)),
              "pitch");
    }
    return flanks;
}

static gm_mesh *make_mesh(const bench_pair *b, int has_tables, int has_corners, gm_pair *pair) {
    gm_pair_params drawing;
    gm_pair_params_default(&drawing);
    drawing.pinion_teeth = b->teeth[0];
    drawing.wheel_teeth = b->teeth[1];
    drawing.normal_module = b->normal_module;
    drawing.normal_pressure_angle = b->pressure_angle_deg * degree;
    drawing.helix_angle = b->helix_angle_deg * degree;
    drawing.center_distance = b->center_distance;
    drawing.face_width = b->face_width;
    drawing.backlash = 100e-6;

    drawing.pinion_profile_shift = b->shift[0];
    drawing.wheel_profile_shift = b->shift[1];
    drawing.pinion_tip_radius = b->tip_radius[0];
    drawing.wheel_tip_radius = b->tip_radius[1];
    drawing.pinion_rack_dedendum = drawing.wheel_rack_dedendum = b->dedendum;
    drawing.pinion_rack_fillet_radius = drawing.wheel_rack_fillet_radius = b->fillet_radius;
    check(gm_pair_init(pair, &drawing), "pair");

    gm_flanks *flanks[2] = {NULL, NULL};
    for (int role = GM_PINION; has_tables && role <= GM_WHEEL; ++role) {
        flanks[role] = make_flanks(pair, b->teeth[role]);
    }
    gm_mesh_params params;
    gm_mesh_params_default(&params);
    params.law = GM_LAW_ELASTIC;
    params.stations = 17; /* whatever the pair wants */
    params.corner_contact = has_corners ? GM_CORNER_ON : GM_CORNER_OFF;
    const size_t size = gm_mesh_size(&params, pair);
    gm_mesh *mesh;
    check(gm_mesh_init(&mesh, &params, pair, flanks[GM_PINION], flanks[GM_WHEEL], allocate(size),
                       size),
          "mesh");
    return mesh;
}

/* Evaluations in a row: the sum of what they give. */
static double evaluate(const bench_pair *b, const gm_pair *pair, const gm_mesh *mesh, long count,
                       double positions) {
    const size_t size = gm_workspace_size(mesh);
    gm_workspace *workspace;
    check(gm_workspace_init(&workspace, mesh, allocate(size), size), "workspace");
    double sum = 0.0;
    for (long k = 0; k < count; ++k) {
        const double turns = (double)k / positions, whole = floor(turns);
        const double x = b->approach * (1.0 + 0.05 * sin(17.0 * turns));
        const gm_position position = {.pinion_tooth = (int)((long)whole % b->teeth[0]),
                                      .wheel_tooth = (int)((long)whole % b->teeth[1]),
                                      .phase = (turns - whole) * pair->transverse_base_pitch,
                                      .offset = x + 0.5 * pair->backlash};
        gm_mesh_result result;
        check(gm_mesh_evaluate_at(mesh, &position, GM_WANT_DERIVATIVES, workspace, &result),
              "evaluation");
        sum += result.force;
    }
    return sum;
}

int main(int argc, char **argv) {
    if (argc < 3 || atoi(argv[1]) < 0 || atoi(argv[1]) > 2) {
        fprintf(stderr,
                "usage: elastic_bench PAIR(0..2) N [tables|ideal [path|corners [POSITIONS]]]\n");
        return 2;
    }
    const bench_pair *b = &pairs[atoi(argv[1])];
    const long count = atol(argv[2]);
    const int has_tables = argc <= 3 || strcmp(argv[3], "ideal") != 0;
    const int has_corners = argc > 4 && strcmp(argv[4], "corners") == 0;
    const double positions = argc > 5 ? atof(argv[5]) : 60.0;
    gm_pair pair;
    const gm_mesh *mesh = make_mesh(b, has_tables, has_corners, &pair);
    const clock_t start = clock();
    const double sum = evaluate(b, &pair, mesh, count, positions);
    const double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
    sink = sum;
    printf("%.3f us, mean force %.9g N\n", 1e6 * seconds / (double)count, sum / (double)count);
    return 0;
}
