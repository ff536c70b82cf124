/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * What elastic teeth cost: `elastic_bench PAIR N [POSITIONS]` evaluates N positions in a row, POSITIONS [60] to a base pitch, with
 * an approach that swings by 5 % beside the roll, and prints the mean number of Newton steps. PAIR: 0 the reference pair with
 * its deep rack, 1 stage 3 of the NREL 5 MW gearbox, 2 a spur pair. For callgrind: the difference of two N is exact.
 */
#include "elastic.h"
#include "internal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct bench_pair {
    double normal_module, pressure_angle_deg, helix_angle_deg, center_distance, face_width;
    double teeth[2], shift[2], tip_radius[2], dedendum, fillet_radius;
    double approach;
} bench_pair;

static const bench_pair pairs[3] = {
    {1.65e-3,
     16.0,
     33.0,
     85e-3,
     17.5e-3,
     {45.0, 41.0},
     {0.1242, 0.1242},
     {46.93839e-3, 43.003591e-3},
     1.75,
     0.37,
     4e-6},
    {14e-3,
     20.0,
     10.0,
     0.8610001467,
     0.36,
     {24.0, 95.0},
     {0.48, 0.6691},
     {0.1903736708, 0.6976880969},
     1.25,
     0.38,
     30e-6},
    {2e-3, 20.0, 0.0, 0.124, 0.02, {62.0, 62.0}, {0.0, 0.0}, {0.064, 0.064}, 1.25, 0.38, 3.5e-6}};

static volatile double sink;

int main(int argc, char **argv) {
    if (argc < 3 || atoi(argv[1]) < 0 || atoi(argv[1]) > 2) {
        fprintf(stderr, "usage: elastic_bench PAIR(0..2) N [POSITIONS]\n");
        return 2;
    }
    const bench_pair *b = &pairs[atoi(argv[1])];
    const long count = atol(argv[2]);
    const double positions = argc > 3 ? atof(argv[3]) : 60.0;
    const double degree = GMI_PI / 180.0;

    /* Geometry. */
    const double alpha_n = b->pressure_angle_deg * degree, beta = b->helix_angle_deg * degree;
    const double alpha_t = atan(tan(alpha_n) / cos(beta));
    const double module = b->normal_module / cos(beta);
    const double base[2] = {0.5 * b->teeth[0] * module * cos(alpha_t),
                            0.5 * b->teeth[1] * module * cos(alpha_t)};
    const double sum = base[0] + base[1];
    const double action = sqrt(b->center_distance * b->center_distance - sum * sum);
    const double pitch = GMI_PI * module * cos(alpha_t);
    const double start = action - sqrt(b->tip_radius[1] * b->tip_radius[1] - base[1] * base[1]);
    const double end = sqrt(b->tip_radius[0] * b->tip_radius[0] - base[0] * base[0]);
    gmi_elastic_params params = {.normal_module = b->normal_module,
                                 .normal_pressure_angle = alpha_n,
                                 .helix_angle = beta,
                                 .base_helix_angle = atan(tan(beta) * cos(alpha_t)),
                                 .face_width = b->face_width,
                                 .line_of_action = action,
                                 .stations = 17,
                                 .lines = 8};
    for (int k = 0; k < 2; ++k) {
        const gmi_elastic_gear_params gear = {b->teeth[k],
                                              b->shift[k],
                                              b->normal_module *
                                                  (0.5 * GMI_PI + 2.0 * b->shift[k] * tan(alpha_n)),
                                              b->dedendum,
                                              b->fillet_radius,
                                              206e9,
                                              0.3,
                                              k == 0 ? start : action - end,
                                              k == 0 ? end : action - start};
        params.gear[k] = gear;
    }
    const double contact[2] = {start, action - end};
    static gmi_elastic law;
    gmi_elastic_work work;
    int fault, wheel;
    void *memory = malloc(gmi_elastic_work_size(17, 8));
    if (memory == NULL || gmi_elastic_init(&law, &params, contact, &fault, &wheel) != GM_OK) {
        fprintf(stderr, "elastic_bench: no law\n");
        free(memory);
        return 1;
    }
    gmi_elastic_work_init(&work, 17, 8, memory);

    /* Evaluations in a row. */
    const double climb = tan(params.base_helix_angle);
    const int teeth = (int)b->teeth[0];
    long steps = 0;
    double total = 0.0;
    for (long k = 0; k < count; ++k) {
        const double turns = (double)k / positions, phase = turns - floor(turns);
        gmi_elastic_lines_at at = {.origin = start + phase * pitch,
                                   .pitch = pitch,
                                   .climb = climb,
                                   .lower = start,
                                   .upper = end,
                                   .line_of_action = action,
                                   .slopes = 1,
                                   .step = 1,
                                   .teeth = teeth};
        at.first = (int)ceil((start - at.origin - climb * b->face_width) / pitch);
        at.last = (int)floor((end - at.origin) / pitch);
        at.tooth = (int)(((at.first - (long)floor(turns)) % teeth + teeth) % teeth);
        gmi_elastic_result result;
        gmi_elastic_gradient force, energy;
        const double x = b->approach * (1.0 + 0.05 * sin(17.0 * turns));
        if (gmi_elastic_place(&law, &at, &work) != GM_OK ||
            gmi_elastic_solve(&law, &work, x, &result) != GM_OK) {
            fprintf(stderr, "elastic_bench: no solution\n");
            free(memory);
            return 1;
        }
        gmi_elastic_differentiate(&law, &work, &force, &energy);
        total += result.force + force.by_roll + energy.by_roll;
        steps += result.iterations;
    }
    sink = total;
    printf("Newton steps per evaluation: %.3f\n", (double)steps / (double)count);
    free(memory);
    return 0;
}
