/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file elastic_gear.h
 * What tests of elastic teeth share: a pair from the numbers of the reference cases, deviations with known slopes, and a
 * solution from them.
 */
#ifndef ELASTIC_GEAR_H
#define ELASTIC_GEAR_H

#include "elastic.h"
#include "gm_test.h"
#include "hertz.h"
#include "internal.h"

/** A pair as the reference cases give it, [0] the pinion; teeth may be a real number, and all of a ring counts below 0. */
typedef struct elastic_gear {
    double normal_module, pressure_angle, helix_angle, center_distance, face_width;
    double teeth[2], shift[2], tip_radius[2];
    double dedendum, fillet_radius, youngs_modulus[2], poisson_ratio[2];
    int stations;

    /* Derived. */
    double base_helix_angle, base_radius[2], line_of_action, pitch; /* p_bt */
    double path_start, path_end;
} elastic_gear;

/** Fills what follows from the drawing. */
GM_TEST_UNUSED static void elastic_gear_derive(elastic_gear *g) {
    const double cosine = cos(g->helix_angle);
    const double transverse = atan(tan(g->pressure_angle) / cosine);
    const double module = g->normal_module / cosine;
    g->base_helix_angle = atan(tan(g->helix_angle) * cos(transverse));
    g->pitch = GMI_PI * module * cos(transverse);
    double tip[2];
    for (int k = 0; k < 2; ++k) {
        g->base_radius[k] = 0.5 * g->teeth[k] * module * cos(transverse);
        tip[k] = copysign(
            sqrt(g->tip_radius[k] * g->tip_radius[k] - g->base_radius[k] * g->base_radius[k]),
            g->teeth[k]);
    }
    const double sum = g->base_radius[0] + g->base_radius[1];
    g->line_of_action =
        copysign(sqrt(g->center_distance * g->center_distance - sum * sum), g->teeth[1]);
    g->path_start = fmax(0.0, g->line_of_action - tip[1]);
    g->path_end = g->teeth[1] > 0.0 ? fmin(g->line_of_action, tip[0]) : tip[0];
}

/** Deviations w(line, rho_p, z): smooth, and one kink of a tip relief. */
typedef struct elastic_deviation {
    double misalignment;      /**< w = m z / b */
    double crowning;          /**< w = -c (2 z / b - 1)^2 */
    double wave, wave_length; /**< w = a sin(rho / length) */
    double relief, from, to;  /**< w = -C max(0, (rho - from) / (to - from)) */
    double of_line[3];        /**< of line k: [k mod 3] */
} elastic_deviation;

GM_TEST_UNUSED static double deviation_at(const elastic_gear *g, const elastic_deviation *d,
                                          int line, double roll, double z, double *by_roll,
                                          double *by_z) {
    const double u = 2.0 * z / g->face_width - 1.0;
    const int relieved = d->relief != 0.0 && roll > d->from;
    const double length = d->wave_length > 0.0 ? d->wave_length : 1.0;
    *by_z = (d->misalignment - 4.0 * d->crowning * u) / g->face_width;
    *by_roll =
        d->wave * cos(roll / length) / length - (relieved ? d->relief / (d->to - d->from) : 0.0);
    return d->misalignment * z / g->face_width - d->crowning * u * u +
           d->wave * sin(roll / length) -
           (relieved ? d->relief * (roll - d->from) / (d->to - d->from) : 0.0) +
           d->of_line[((line % 3) + 3) % 3];
}

/** A law with its workspace. */
typedef struct elastic_case {
    elastic_gear gear;
    gmi_elastic law;
    gmi_elastic_work work;
    void *memory;
} elastic_case;

GM_TEST_UNUSED static gmi_elastic_params elastic_params_of(const elastic_gear *g, int lines) {
    gmi_elastic_params params = {.normal_module = g->normal_module,
                                 .normal_pressure_angle = g->pressure_angle,
                                 .helix_angle = g->helix_angle,
                                 .base_helix_angle = g->base_helix_angle,
                                 .face_width = g->face_width,
                                 .line_of_action = g->line_of_action,
                                 .stations = g->stations,
                                 .lines = lines};
    for (int k = 0; k < 2; ++k) {
        const double start = k == 0 ? g->path_start : g->line_of_action - g->path_end;
        const double end = k == 0 ? g->path_end : g->line_of_action - g->path_start;
        const double thickness =
            g->normal_module * (0.5 * GMI_PI + 2.0 * g->shift[k] * tan(g->pressure_angle));
        params.gear[k] = (gmi_elastic_gear_params){
            g->teeth[k],          g->shift[k],         thickness, g->dedendum, g->fillet_radius,
            g->youngs_modulus[k], g->poisson_ratio[k], start,     end};
    }
    return params;
}

/** Status of gmi_elastic_init(); the gear is derived. Free it in any case. */
GM_TEST_UNUSED static int elastic_case_make(elastic_case *c, const elastic_gear *gear, int lines) {
    c->gear = *gear;
    elastic_gear_derive(&c->gear);
    const gmi_elastic_params params = elastic_params_of(&c->gear, lines);
    const double contact[2] = {params.gear[0].start_roll_length, params.gear[1].start_roll_length};
    int fault, wheel;
    c->memory = malloc(gmi_elastic_work_size(gear->stations, lines, 0));
    gmi_elastic_work_init(&c->work, gear->stations, lines, 0, c->memory);
    return gmi_elastic_init(&c->law, &params, contact, &fault, &wheel);
}

GM_TEST_UNUSED static void elastic_case_free(elastic_case *c) {
    free(c->memory);
}

/** Where the lines are when line 0 has rho_p = o at z = 0. */
GM_TEST_UNUSED static gmi_elastic_lines_at elastic_lines_at(const elastic_gear *g, double o) {
    gmi_elastic_lines_at at = {.origin = o,
                               .pitch = g->pitch,
                               .climb = tan(g->base_helix_angle),
                               .lower = g->path_start,
                               .upper = g->path_end,
                               .line_of_action = g->line_of_action,
                               .slopes = 2,
                               .step = 1,
                               .teeth = (int)ceil(g->teeth[0])};
    const double rise = at.climb * g->face_width;
    at.first = (int)ceil((at.lower - o - fmax(rise, 0.0)) / at.pitch);
    at.last = (int)floor((at.upper - o - fmin(rise, 0.0)) / at.pitch);
    at.tooth = ((at.first % at.teeth) + at.teeth) % at.teeth;
    return at;
}

GM_TEST_UNUSED static void elastic_fill(const elastic_gear *g, const elastic_deviation *d,
                                        gmi_elastic_work *work) {
    for (int k = 0; k < work->count; ++k) {
        const gmi_elastic_line *line = &work->line[k];
        for (int half = 0; half < 2; ++half) {
            for (int s = line->slot; s < line->slot + line->slots; ++s) {
                const int p = s + half * work->slots;
                work->deviation[p] =
                    deviation_at(g, d, line->index, work->roll[p], work->z[p],
                                 &work->deviation_by_roll[p], &work->deviation_by_z[p]);
            }
        }
    }
}

/** Solves; warm = 0: from undeformed teeth. Asserts that it works. */
GM_TEST_UNUSED static gmi_elastic_result elastic_solve_at(elastic_case *c,
                                                          const gmi_elastic_lines_at *at,
                                                          const elastic_deviation *d, double x,
                                                          int warm) {
    gmi_elastic_result result;
    if (!warm) {
        gmi_elastic_work_reset(&c->work);
    }
    GM_ASSERT_INT(gmi_elastic_place(&c->law, at, &c->work), GM_OK);
    elastic_fill(&c->gear, d, &c->work);
    GM_ASSERT_INT(gmi_elastic_solve(&c->law, &c->work, x, &result), GM_OK);
    return result;
}

#endif /* ELASTIC_GEAR_H */
