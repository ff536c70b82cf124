/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "random_gears.h"

#include "gm_test.h"

static const double degree = 0.017453292519943295;

/** 10 to a uniform power. */
static double any_size(uint64_t *seed, double low, double high) {
    return pow(10.0, gm_test_uniform(seed, low, high));
}

static double any_sign(uint64_t *seed) {
    return gm_test_integer(seed, 0, 1) == 0 ? 1.0 : -1.0;
}

static int chance(uint64_t *seed, int percent) {
    return gm_test_integer(seed, 0, 99) < percent;
}

static double any_helix(uint64_t *seed) {
    const int kind = gm_test_integer(seed, 0, 99);
    if (kind < 20) {
        return 0.0;
    }
    if (kind < 30) {
        return any_sign(seed) * any_size(seed, -9.0, -3.0);
    }
    return any_sign(seed) * gm_test_uniform(seed, 1.0, kind < 95 ? 45.0 : 59.0) * degree;
}

/** Profile shifts and thicknesses in each of the ways that gm_pair_params allows. */
static void any_thickness(uint64_t *seed, gm_pair_params *params) {
    /* Shifts without backlash, divided at random; and what turns a shift into a thickness. */
    const double m_n = params->normal_module;
    model_pair zero_backlash;
    model_pair_init(&zero_backlash, params);
    const double sum = (double)(zero_backlash.shift[0] + zero_backlash.shift[1]);
    const double x_p = sum / 2 + gm_test_uniform(seed, -0.3, 0.3);
    const double rack = m_n * 1.5707963267948966;
    const double slope = 2.0 * m_n * tan(params->normal_pressure_angle);

    /* All ways to say how thick the teeth are. */
    switch (gm_test_integer(seed, 0, 4)) {
    case 0:
        params->pinion_profile_shift = x_p;
        params->backlash = m_n * gm_test_uniform(seed, -0.01, 0.1);
        break;
    case 1:
        params->wheel_profile_shift = sum - x_p;
        break;
    case 2:
        params->pinion_normal_thickness =
            rack + slope * x_p - m_n * gm_test_uniform(seed, -0.005, 0.05);
        params->wheel_normal_thickness =
            rack + slope * (sum - x_p) - m_n * gm_test_uniform(seed, -0.005, 0.05);
        break;
    case 3:
        params->pinion_profile_shift = x_p;
        params->wheel_profile_shift = sum - x_p - gm_test_uniform(seed, -0.005, 0.1);
        break;
    default:
        params->backlash = m_n * gm_test_uniform(seed, -0.01, 0.1);
        break;
    }
}

static void any_radii(uint64_t *seed, gm_pair_params *params) {
    model_pair model;
    model_pair_init(&model, params);
    double *const tip[2] = {&params->pinion_tip_radius, &params->wheel_tip_radius};
    double *const start[2] = {&params->pinion_start_radius, &params->wheel_start_radius};
    for (int g = 0; g < 2; ++g) {
        if (chance(seed, 70)) {
            const double height = gm_test_uniform(seed, 0.7, 1.5) + (double)model.shift[g];
            const double outwards = g == 1 && model.is_ring ? -1.0 : 1.0;
            *tip[g] = (double)model.reference_radius[g] + outwards * params->normal_module * height;
        }

        /* Where the active flank starts; a ring starts outside of its tip. */
        const double r_b = (double)model.base_radius[g];
        const double rho = (double)model.rho_end[g];
        if (g == 1 && model.is_ring) {
            if (chance(seed, 50)) {
                *start[g] = hypot(r_b, rho * gm_test_uniform(seed, 1.05, 1.4));
            }
            continue;
        }

        switch (gm_test_integer(seed, 0, 9)) {
        case 0:
            /* On the base circle. Not to the last bit: whether the radius is above or below the
             * rounded base radius moves the roll length by sqrt(r_b * rounding). */
            *start[g] = r_b * (1.0 - 1e-12);
            break;
        case 1:
            *start[g] = r_b * gm_test_uniform(seed, 0.8, 1.0);
            break;
        case 2:
        case 3:
        case 4:
        case 5:
            *start[g] = hypot(r_b, rho * gm_test_uniform(seed, 0.1, 0.7));
            break;
        default:
            break;
        }
    }
}

void random_params(uint64_t *seed, gm_pair_params *params, model_pair *model) {
    for (;;) {
        gm_pair_params_default(params);
        const int small = chance(seed, 20);
        params->pinion_teeth = gm_test_integer(seed, small ? 6 : 14, small ? 30 : 120);
        params->wheel_teeth = gm_test_integer(seed, small ? 6 : 14, small ? 150 : 120);
        params->normal_module = 1e-3 * any_size(seed, -0.7, 1.3);
        if (chance(seed, 3)) {
            params->normal_module = any_size(seed, -6.0, 1.0);
        }

        /* The drawing, mostly of usual proportions. */
        const double m_n = params->normal_module;
        params->normal_pressure_angle = gm_test_uniform(seed, 12.0, 28.0) * degree;
        params->helix_angle = any_helix(seed);
        params->face_width = m_n * (chance(seed, 90) ? gm_test_uniform(seed, 2.0, 25.0)
                                                     : gm_test_uniform(seed, 50.0, 200.0));
        params->center_distance =
            (params->pinion_teeth + params->wheel_teeth) * m_n / (2.0 * cos(params->helix_angle));
        if (chance(seed, 90)) {
            params->center_distance += m_n * gm_test_uniform(seed, -0.4, 1.2);
        }

        /* What follows from it, and what may be given beside it. */
        any_thickness(seed, params);
        any_radii(seed, params);
        model_pair_init(model, params);
        const long double p_bt = model->base_pitch;
        /* Comparisons that a NaN fails: no real path, no pair. */
        if (model_path_length(model) > 0.05L * p_bt && fabsl(model->backlash) < 0.3L * p_bt &&
            model->rho_start[0] < 0.9L * model->rho_end[0] &&
            model->rho_start[1] < 0.9L * model->rho_end[1]) {
            return;
        }
    }
}

void random_ring_params(uint64_t *seed, gm_pair_params *params, model_pair *model) {
    gm_pair pair;
    do {
        gm_pair_params_default(params);
        params->pinion_teeth = gm_test_integer(seed, 12, 60);
        params->wheel_teeth = -(params->pinion_teeth + gm_test_integer(seed, 8, 100));
        params->normal_module = 1e-3 * any_size(seed, -0.7, 1.3);
        params->normal_pressure_angle = gm_test_uniform(seed, 14.0, 28.0) * degree;
        params->helix_angle = any_helix(seed);
        const double m_n = params->normal_module;
        params->face_width = m_n * gm_test_uniform(seed, 2.0, 25.0);

        /* The way that the profile shifts let it off the reference distance. */
        params->center_distance =
            -(params->pinion_teeth + params->wheel_teeth) * m_n / (2.0 * cos(params->helix_angle));
        if (chance(seed, 90)) {
            params->center_distance += m_n * gm_test_uniform(seed, -0.8, 0.6);
        }
        any_thickness(seed, params);
        any_radii(seed, params);
        model_pair_init(model, params);
    } while (!(model_path_length(model) > 0.05L * model->base_pitch &&
               fabsl(model->backlash) < 0.3L * model->base_pitch &&
               gm_pair_init(&pair, params) == GM_OK));
}

/* ---------------------------------------------------------------------------------------------
 * Flanks
 * ------------------------------------------------------------------------------------------- */

static void any_grid(uint64_t *seed, int *face_nodes, int *profile_nodes) {
    *face_nodes = chance(seed, 30) ? 2 : gm_test_integer(seed, 2, chance(seed, 10) ? 60 : 12);
    *profile_nodes = chance(seed, 30) ? 2 : gm_test_integer(seed, 2, chance(seed, 10) ? 60 : 12);
}

/** Node values: noise from node to node mostly, sometimes constant or smooth. */
static double *any_table(uint64_t *seed, int face_nodes, int profile_nodes, double amplitude) {
    double *values = calloc((size_t)(face_nodes * profile_nodes), sizeof *values);
    const int kind = gm_test_integer(seed, 0, 9);
    const double level = gm_test_uniform(seed, -amplitude, amplitude);
    for (int i = 0; i < face_nodes * profile_nodes; ++i) {
        const double u = 2.0 * (i / profile_nodes) / (face_nodes - 1) - 1.0;
        const double v = 2.0 * (i % profile_nodes) / (profile_nodes - 1) - 1.0;
        values[i] = kind == 0   ? level
                    : kind <= 2 ? level * u * v - amplitude * (u * u + v * v) / 2
                                : gm_test_uniform(seed, -amplitude, amplitude);
    }
    return values;
}

static void fill_side(random_flanks *f, uint64_t *seed, int side, int tables, int face_nodes,
                      int profile_nodes, double amplitude, double factor, long double exact) {
    const int teeth = gm_flanks_teeth(f->flanks);
    for (int k = 0; k < tables; ++k) {
        /* One table: mostly for all teeth. As many as teeth: one each. Else: all, then some. */
        const int tooth = tables == teeth ? k
                          : k == 0 && (tables == 1 ? chance(seed, 70) : 1)
                              ? GM_ALL_TEETH
                              : gm_test_integer(seed, 0, teeth - 1);
        double *values = any_table(seed, face_nodes, profile_nodes, amplitude / factor);
        f->tables[side][f->table_count[side]++] = values;
        GM_ASSERT_INT(gm_flanks_set_table(f->flanks, side, tooth, values, factor), GM_OK);
        for (int t = 0; t < teeth; ++t) {
            if (tooth == GM_ALL_TEETH || tooth == t) {
                f->model.table[side][t] = (model_table){face_nodes, profile_nodes, values, exact};
            }
        }
    }
    if (chance(seed, 40)) {
        for (int t = 0; t < teeth; ++t) {
            const double pitch = gm_test_uniform(seed, -amplitude, amplitude);
            GM_ASSERT_INT(gm_flanks_set_pitch(f->flanks, side, t, pitch), GM_OK);
            f->model.pitch[side][t] = pitch;
        }
    }
}

/** 1 / the range of a relief, mostly one that ends on a grid line of some table. */
static double any_steepness(uint64_t *seed) {
    return chance(seed, 40) ? (double)gm_test_integer(seed, 1, 5) : gm_test_uniform(seed, 1.0, 8.0);
}

/** Reliefs of every kind, and planes that no drawing has: parallel to the lines of contact, which climb by `climb` in
 *  t2 over the face; nothing anywhere; something everywhere; anything. */
static gm_flank_ramp any_ramp(uint64_t *seed, double amplitude, double climb) {
    const double amount = gm_test_uniform(seed, 0.0, amplitude);
    const double face = any_steepness(seed) * any_sign(seed) * amount;
    const double profile = any_steepness(seed) * any_sign(seed) * amount;
    const double at_face = amount - fmax(face, 0.0);
    const double at_profile = amount - fmax(profile, 0.0);
    const double t1 = gm_test_uniform(seed, 0.0, 1.0);
    const double t2 = gm_test_uniform(seed, 0.0, 1.0);
    switch (gm_test_integer(seed, 0, 9)) {
    case 0:
        return (gm_flank_ramp){profile * (climb * t1 - t2), -profile * climb, profile};
    case 1:
        return (gm_flank_ramp){0.0, 0.0, 0.0};
    case 2:
        return (gm_flank_ramp){amount + fabs(face) + fabs(profile), face, profile};
    case 3:
        return (gm_flank_ramp){-face * t1 - profile * t2, face, profile};
    case 4:
    case 5:
        return (gm_flank_ramp){at_face, face, 0.0};
    case 6:
    case 7:
        return (gm_flank_ramp){at_profile, 0.0, profile};
    default:
        return (gm_flank_ramp){at_face + at_profile - amount, face, profile};
    }
}

/** Ramps of one side; some twice, so that edges coincide. */
static void set_ramps(random_flanks *f, uint64_t *seed, int side, double amplitude, double climb,
                      double factor, long double exact) {
    gm_flank_ramp ramps[MODEL_RAMPS];
    const int count = chance(seed, 50)  ? 0
                      : chance(seed, 5) ? MODEL_RAMPS
                                        : gm_test_integer(seed, 1, 5);
    for (int k = 0; k < count; ++k) {
        ramps[k] = k > 0 && chance(seed, 10) ? ramps[k - 1] : any_ramp(seed, amplitude, climb);
        f->model.ramp[side][k] =
            (model_ramp){exact, ramps[k].offset, ramps[k].per_t1, ramps[k].per_t2};
    }
    f->model.ramp_count[side] = count;
    GM_ASSERT_INT(gm_flanks_set_ramps(f->flanks, side, ramps, count, factor), GM_OK);
}

void random_flanks_make(random_flanks *f, uint64_t *seed, const gm_pair *pair, int wheel,
                        double amplitude) {
    static const int table_counts[] = {0, 1, 1, 3};
    const gm_gear *gear = wheel ? &pair->wheel : &pair->pinion;
    const int teeth = gear->teeth;
    memset(f, 0, sizeof *f);
    int tables[2];
    int face_nodes[2];
    int profile_nodes[2];
    for (int side = 0; side < 2; ++side) {
        tables[side] = chance(seed, 10) ? teeth : table_counts[gm_test_integer(seed, 0, 3)];
        any_grid(seed, &face_nodes[side], &profile_nodes[side]);
        f->model.table[side] = calloc((size_t)teeth, sizeof(model_table));
        f->model.pitch[side] = calloc((size_t)teeth, sizeof(double));
    }
    const gm_flanks_params sizes = {.teeth = teeth,
                                    .drive_tables = tables[0],
                                    .drive_face_nodes = face_nodes[0],
                                    .drive_profile_nodes = profile_nodes[0],
                                    .coast_tables = tables[1],
                                    .coast_face_nodes = face_nodes[1],
                                    .coast_profile_nodes = profile_nodes[1]};
    const size_t size = gm_flanks_size(&sizes);
    f->memory = malloc(size + 1);
    GM_ASSERT_INT(gm_flanks_init(&f->flanks, &sizes, f->memory, size), GM_OK);
    const int normal = chance(seed, 50);
    const long double exact =
        1.0L / cosl(atanl((long double)pair->face_advance / pair->face_width));
    uint64_t ramp_seed = *seed; /* a sequence of their own */
    for (int side = 0; side < 2; ++side) {
        fill_side(f, seed, side, tables[side], face_nodes[side], profile_nodes[side], amplitude,
                  normal ? pair->normal_to_transverse : 1.0, normal ? exact : 1.0L);
        const double climb = (side == wheel ? 1.0 : -1.0) * pair->face_advance /
                             fabs(gear->tip_roll_length - gear->start_roll_length);
        set_ramps(f, &ramp_seed, side, amplitude, climb, normal ? pair->normal_to_transverse : 1.0,
                  normal ? exact : 1.0L);
    }
}

void random_flanks_free(random_flanks *f) {
    for (int side = 0; side < 2; ++side) {
        for (int k = 0; k < f->table_count[side]; ++k) {
            free(f->tables[side][k]);
        }
        free(f->model.table[side]);
        free(f->model.pitch[side]);
    }
    free(f->memory);
}

void random_flanks_grow(const random_flanks *f, int side, double by) {
    for (int tooth = 0; tooth < gm_flanks_teeth(f->flanks); ++tooth) {
        GM_ASSERT_INT(gm_flanks_set_pitch(f->flanks, side, tooth, f->model.pitch[side][tooth] + by),
                      GM_OK);
    }
}

/* ---------------------------------------------------------------------------------------------
 * Cases
 * ------------------------------------------------------------------------------------------- */

void random_case_place(random_case *c, double pinion_angle, double offset) {
    c->pinion_angle = pinion_angle;
    c->wheel_angle =
        (double)((c->model.base_radius[0] * pinion_angle - offset) / c->model.base_radius[1]);
}

static void any_state(random_case *c, uint64_t *seed) {
    const double p_bt = (double)c->model.base_pitch;
    const double half_gap = (double)c->model.backlash / 2;
    double offset =
        any_sign(seed) * (half_gap + c->amplitude * gm_test_uniform(seed, -2.0, 4.0) +
                          c->params.normal_module * gm_test_uniform(seed, -0.5e-3, 5e-3));
    if (chance(seed, 15) || fabs(offset) > 0.49 * p_bt) {
        offset = p_bt * gm_test_uniform(seed, -0.49, 0.49);
    }
    double angle = gm_test_uniform(seed, -7.0, 7.0);
    if (chance(seed, 20)) {
        angle = any_sign(seed) * any_size(seed, 1.0, 6.0);
    } else if (chance(seed, 5)) {
        angle = 0.0;
    }
    random_case_place(c, angle, offset);
}

static int complete(random_case *c, uint64_t *seed, int with_flanks) {
    const int status = gm_pair_init(&c->pair, &c->params);
    c->amplitude = with_flanks ? c->params.normal_module * any_size(seed, -4.0, -2.3) : 0.0;
    for (int g = 0; g < 2 && status == GM_OK; ++g) {
        if (with_flanks && chance(seed, 80)) {
            random_flanks_make(&c->flanks[g], seed, &c->pair, g, c->amplitude);
            c->use[g] = c->flanks[g].flanks;
            c->model_use[g] = &c->flanks[g].model;
        }
    }
    any_state(c, seed);
    return status;
}

int random_case_make(random_case *c, uint64_t *seed, int with_flanks) {
    memset(c, 0, sizeof *c);
    random_params(seed, &c->params, &c->model);
    return complete(c, seed, with_flanks);
}

int random_ring_case_make(random_case *c, uint64_t *seed, int with_flanks) {
    memset(c, 0, sizeof *c);
    random_ring_params(seed, &c->params, &c->model);
    return complete(c, seed, with_flanks);
}

int random_mixed_case_make(random_case *c, uint64_t *seed, int i) {
    const int with_flanks = i % 4 != 0;
    return i % 5 == 2 ? random_ring_case_make(c, seed, with_flanks)
                      : random_case_make(c, seed, with_flanks);
}

gm_position random_pressed(uint64_t *seed, const gm_pair *pair, int i) {
    gm_position position;
    const double side = i % 5 == 0 ? -1.0 : 1.0;
    const double depth = gm_test_uniform(seed, 0.5e-3, 8e-3) * pair->normal_module;
    (void)gm_position_from_pinion_angle(pair, gm_test_uniform(seed, 0.0, 6.0),
                                        side * (0.5 * pair->backlash + depth), 0.0, &position);
    return position;
}

gm_pose random_pose(uint64_t *seed, const gm_pair *pair, double tilt) {
    const double m = pair->normal_module;
    const double tilted = tilt * pair->transverse_base_pitch / pair->face_width;
    const gm_pose pose = {
        gm_test_uniform(seed, -5e-3, 5e-3) * m, gm_test_uniform(seed, -1e-3, 1e-3) * m,
        gm_test_uniform(seed, -1e-2, 1e-2) * m, gm_test_uniform(seed, -tilted, tilted),
        gm_test_uniform(seed, -tilted, tilted)};
    return pose;
}

void random_case_free(random_case *c) {
    random_flanks_free(&c->flanks[0]);
    random_flanks_free(&c->flanks[1]);
}
