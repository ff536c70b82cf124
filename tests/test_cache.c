/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The cache against the exact evaluation: the same at nodes, as near as stated between them, exact or
 * exactly zero outside, and no more memory or work than asked for. */
#include "cache.h" /* what the objects hold */
#include "gearmesh/gearmesh_io.h"
#include "gm_test.h"
#include "reference_gear.h"

#include <pthread.h>

#define PAPER "../data/paper/"

/* Sum of the reference pair at 20 N m: F / K = 20 N m / 39.1 mm / 1.05e8 N/m (wheel's base radius). */
static const double sum_at_20_Nm = 4.9e-6;

/* A pair with flanks of its own on every tooth, and a cache of it. */
typedef struct fixture {
    gm_pair pair;
    gm_flanks *flanks[2];
    gm_mesh *mesh; /* answers from the cache */
    gm_cache *cache;
    size_t size; /* of its memory */
} fixture;

static void read_flanks(fixture *f, int gear, const char *deviation_file, const char *pitch_file) {
    const int teeth = gear == 0 ? f->pair.pinion.teeth : f->pair.wheel.teeth;
    gm_deviations deviations;
    gm_pitch pitch;
    gm_flanks_options options;
    gm_flanks_options_default(&options);
    options.normal_factor = f->pair.normal_to_transverse;

    fclose(gm_test_open(deviation_file));
    fclose(gm_test_open(pitch_file));
    GM_ASSERT_INT(gm_deviations_read(&deviations, deviation_file, teeth, NULL), GM_IO_OK);
    GM_ASSERT_INT(gm_pitch_read(&pitch, pitch_file, teeth, NULL), GM_IO_OK);
    GM_ASSERT_INT(
        gm_flanks_build(&f->flanks[gear], teeth, &deviations, &pitch, &options, NULL, NULL),
        GM_IO_OK);
    gm_deviations_free(&deviations);
    gm_pitch_free(&pitch);
}

/* Any stiffness will do: a cache holds sums of penetrations. */
static gm_mesh *make_mesh(const gm_pair *pair, const gm_flanks *pinion, const gm_flanks *wheel) {
    gm_mesh_params params;
    gm_mesh *mesh = NULL;
    gm_mesh_params_default(&params);
    params.stiffness = 1e8;
    const size_t size = gm_mesh_size(&params, pair);
    GM_ASSERT_INT(gm_mesh_init(&mesh, &params, pair, pinion, wheel, malloc(size), size), GM_OK);
    return mesh;
}

static void make_cache(fixture *f, const gm_cache_params *params) {
    f->mesh = make_mesh(&f->pair, f->flanks[0], f->flanks[1]);
    f->size = gm_cache_size(params, f->mesh);
    GM_ASSERT(f->size > 0);
    GM_ASSERT_INT(gm_cache_init(&f->cache, params, f->mesh, malloc(f->size), f->size), GM_OK);
    GM_ASSERT_INT(gm_mesh_use_cache(f->mesh, f->cache), GM_OK);
}

/* The cache points into the fixture, which must not move. */
static void make_paper(fixture *f, const gm_cache_params *params) {
    memset(f, 0, sizeof *f);
    f->pair = reference_pair(REFERENCE_FACE_WIDTH);
    read_flanks(f, 0, PAPER "pinion_flanks.csv", PAPER "pinion_pitch.csv");
    read_flanks(f, 1, PAPER "wheel_flanks.csv", PAPER "wheel_pitch.csv");
    make_cache(f, params);
}

static void free_fixture(fixture *f) {
    free(f->cache); /* each begins at its memory */
    free(f->mesh);
    gm_flanks_free(f->flanks[0]);
    gm_flanks_free(f->flanks[1]);
}

static gm_cache_params params_of(int side, int phase_cells, int depth_cells, double depth) {
    const gm_cache_params params = {side, phase_cells, depth_cells, depth};
    return params;
}

static gm_cache_params default_params(void) {
    gm_cache_params params;
    gm_cache_params_default(&params);
    return params;
}

static gm_penetration exact_at(const fixture *f, const gm_position *position) {
    gm_penetration result;
    GM_ASSERT_INT(penetration_3d_at(&f->pair, f->flanks[0], f->flanks[1], position, &result),
                  GM_OK);
    return result;
}

static gm_penetration looked_up_at(fixture *f, const gm_position *position) {
    gm_mesh_result result;
    GM_ASSERT_INT(gm_mesh_evaluate_at(f->mesh, position, GM_WANT_DERIVATIVES, NULL, &result),
                  GM_OK);
    return result.contact;
}

/* x at which a side has this delta. */
static double offset_of(const fixture *f, double delta) {
    const double offset = delta + 0.5 * f->pair.backlash;
    return f->cache->side == GM_DRIVE ? offset : -offset;
}

static double by_x(const fixture *f, const gm_penetration *r) {
    return -r->d_wheel_angle / f->pair.wheel.base_radius;
}

static double by_phase(const fixture *f, const gm_penetration *r) {
    return r->d_pinion_angle / f->pair.pinion.base_radius +
           r->d_wheel_angle / f->pair.wheel.base_radius;
}

static int was_looked_up(const fixture *f, const gm_penetration *r) {
    return (f->cache->side == GM_DRIVE ? r->drive_pairs : r->coast_pairs) == -1;
}

static double looked_up_sum(const fixture *f, const gm_penetration *r) {
    return f->cache->side == GM_DRIVE ? r->drive : r->coast;
}

/* A tooth pass, its teeth by the definition of a pass: both gears go back by one tooth at a time. */
static gm_position random_position(const fixture *f, uint64_t *seed) {
    const int turned = gm_test_integer(seed, 0, f->pair.pinion.teeth * f->pair.wheel.teeth - 1);
    gm_position position;
    GM_ASSERT_INT(gm_position_from_pinion_angle(&f->pair, turned * f->pair.pinion.pitch_angle, 0.0,
                                                0.25, &position),
                  GM_OK);
    position.phase = gm_test_uniform(seed, 0.0, f->pair.transverse_base_pitch);
    return position;
}

/* Number of the tooth pass where both gears have z flanks of their own and no common divisor. */
static size_t hunting_pass(const fixture *f, const gm_position *position) {
    return (size_t)position->pinion_tooth * (size_t)f->pair.wheel.teeth +
           (size_t)position->wheel_tooth;
}

/* The column of a pass at a place among its phases; p_bt is phase 0 of the pass in which both gears are a tooth further on. */
static size_t hunting_column(const fixture *f, const gm_position *position, int index) {
    gm_position next = *position;
    next.pinion_tooth = (position->pinion_tooth + f->pair.pinion.teeth - 1) % f->pair.pinion.teeth;
    next.wheel_tooth = (position->wheel_tooth + f->pair.wheel.teeth - 1) % f->pair.wheel.teeth;
    return index < f->cache->columns
               ? hunting_pass(f, position) * (size_t)f->cache->columns + (size_t)index
               : hunting_pass(f, &next) * (size_t)f->cache->columns;
}

/* Starts of the columns before and behind a phase, and the phases of both. */
typedef struct neighbours {
    double start[2], phase[2];
} neighbours;

static neighbours columns_around(const fixture *f, const gm_position *position) {
    neighbours found;
    int index = 0;
    while (index + 1 < f->cache->columns && f->cache->phases[index + 1] <= position->phase) {
        ++index;
    }
    for (int i = 0; i < 2; ++i) {
        found.start[i] = f->cache->starts[hunting_column(f, position, index + i)].delta;
        found.phase[i] = f->cache->phases[index + i];
    }
    return found;
}

/* ---------------------------------------------------------------------------------------------
 * Error
 * ------------------------------------------------------------------------------------------- */

typedef struct measured {
    double sum_largest, sum_squares, contact_largest, contact_squares;
    int states;
} measured;

static void measure(fixture *f, int states, uint64_t seed, measured *m) {
    const double full_turn = 6.283185307179586;
    const double sign = f->cache->side == GM_DRIVE ? 1.0 : -1.0;
    memset(m, 0, sizeof *m);
    for (int i = 0; i < states; ++i) {
        const double angle = gm_test_uniform(&seed, 0.0, full_turn * f->pair.wheel.teeth);
        const double torque = sign * gm_test_uniform(&seed, 1.0, 40.0);
        double offset;
        GM_ASSERT_INT(equilibrium(&f->pair, f->flanks[0], f->flanks[1], angle, REFERENCE_STIFFNESS,
                                  torque, &offset, NULL),
                      GM_OK);
        gm_position position;
        GM_ASSERT_INT(gm_position_from_pinion_angle(&f->pair, angle, offset, 0.25, &position),
                      GM_OK);
        const gm_penetration exact = exact_at(f, &position);
        const gm_penetration looked_up = looked_up_at(f, &position);
        const double sum = looked_up_sum(f, &looked_up) - looked_up_sum(f, &exact);
        const double contact = (looked_up.drive_contact - exact.drive_contact) +
                               (looked_up.coast_contact - exact.coast_contact);
        m->sum_largest = fmax(m->sum_largest, fabs(sum));
        m->contact_largest = fmax(m->contact_largest, fabs(contact));
        m->sum_squares += sum * sum;
        m->contact_squares += contact * contact;
        m->states += was_looked_up(f, &looked_up);
        GM_ASSERT_REL(looked_up.rate, 0.25 * (looked_up.drive_contact + looked_up.coast_contact),
                      1e-15);
        GM_ASSERT(looked_up.penetration == looked_up.drive - looked_up.coast);
    }
}

/* The numbers that gearmesh.h states, for both sides. */
static void error_is_as_stated(void) {
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        gm_test_context("side %d", side);
        gm_cache_params params = default_params();
        params.side = side;
        fixture f;
        make_paper(&f, &params);
        measured m;
        measure(&f, 1000, UINT64_C(81) + (unsigned)side, &m);
        GM_ASSERT(m.states >= 990);
        GM_ASSERT_ABS(m.sum_largest, 0.0, 3e-3 * sum_at_20_Nm);
        GM_ASSERT_ABS(sqrt(m.sum_squares / m.states), 0.0, 2.5e-4 * sum_at_20_Nm);
        GM_ASSERT_ABS(m.contact_largest, 0.0, 0.15);
        GM_ASSERT_ABS(sqrt(m.contact_squares / m.states), 0.0, 0.01);
        free_fixture(&f);
    }
}

/* Columns of 141 nodes take three walks, the last of them not a full one: the stated errors hold as with one walk. */
static void columns_of_many_walks_are_as_exact(void) {
    const gm_cache_params params = params_of(GM_DRIVE, 16, 140, 20e-6);
    fixture f;
    make_paper(&f, &params);
    gm_cache_errors errors;
    GM_ASSERT_INT(gm_cache_error(f.cache, 500, 7, NULL, &errors), GM_OK);
    GM_ASSERT(errors.sum_rms > 0.0 && errors.sum_rms <= 2.5e-4 * sum_at_20_Nm);
    GM_ASSERT(errors.sum_largest <= 3e-3 * sum_at_20_Nm);
    free_fixture(&f);
}

static void error_can_be_measured(void) {
    const gm_cache_params params = default_params();
    fixture f;
    make_paper(&f, &params);
    gm_cache_errors fine, again, spoilt;
    GM_ASSERT_INT(gm_cache_error(f.cache, 2000, 7, NULL, &fine), GM_OK);
    GM_ASSERT(fine.sum_rms > 0.0 && fine.sum_rms <= 2.5e-4 * sum_at_20_Nm);
    GM_ASSERT(fine.sum_largest >= fine.sum_rms && fine.sum_largest <= 3e-3 * sum_at_20_Nm);
    GM_ASSERT(fine.contact_rms > 0.0 && fine.contact_rms <= 0.01);
    GM_ASSERT(fine.contact_largest >= fine.contact_rms && fine.contact_largest <= 0.15);
    GM_ASSERT_INT(gm_cache_error(f.cache, 2000, 7, NULL, &again), GM_OK);
    GM_ASSERT(memcmp(&fine, &again, sizeof fine) == 0);
    GM_ASSERT_INT(gm_cache_error(f.cache, 2000, 8, NULL, &again), GM_OK);
    GM_ASSERT(fine.sum_largest != again.sum_largest);

    /* One per cent more in every node is seen as one: sums are 19 um on average at half the depth. */
    const size_t values =
        (size_t)f.cache->passes * (size_t)f.cache->columns * (size_t)f.cache->nodes * 4;
    for (size_t i = 0; i < values; ++i) {
        f.cache->values[i] *= 1.01F;
    }
    GM_ASSERT_INT(gm_cache_error(f.cache, 2000, 7, NULL, &spoilt), GM_OK);
    GM_ASSERT(spoilt.sum_rms > 5.0 * fine.sum_rms);
    free_fixture(&f);

    GM_ASSERT_INT(gm_cache_error(NULL, 10, 1, NULL, &spoilt), GM_ERR_NULL);
    GM_ASSERT_NAN(spoilt.sum_rms);
    GM_ASSERT_INT(gm_cache_error(f.cache, 10, 1, NULL, NULL), GM_ERR_NULL);
    GM_ASSERT_INT(gm_cache_error(f.cache, 0, 1, NULL, &spoilt), GM_ERR_PARAMETER);
    GM_ASSERT_NAN(spoilt.contact_largest);
}

/* How the derivative by x changes with phase behind a node is how that by phase changes from node to node around it. */
static void assert_mixed(fixture *f, const gm_position *node, const gm_penetration *there) {
    const double dphase = 1e-10, dx = f->cache->step;
    gm_position behind = *node, left = *node, right = *node;
    behind.phase += dphase;
    left.offset -= dx;
    right.offset += dx;
    const gm_penetration r = looked_up_at(f, &behind);
    if (was_looked_up(f, &r)) {
        const gm_penetration a = looked_up_at(f, &left), b = looked_up_at(f, &right);
        if (!was_looked_up(f, &a) || !was_looked_up(f, &b)) {
            return;
        }
        const double expected = (by_phase(f, &b) - by_phase(f, &a)) / (2.0 * dx);
        /* Of some 1000 / m; dphase is 1e-4 of the narrowest cell. */
        GM_ASSERT_NEAR((by_x(f, &r) - by_x(f, there)) / dphase, expected, 1e-3, 5.0);
    }
}

/* Nodes of random columns against the exact evaluation: root mean square of the sum's error (m). */
static double error_of_nodes(int side, double depth) {
    const gm_cache_params params = params_of(side, 16, 20, depth);
    fixture f;
    make_paper(&f, &params);
    uint64_t seed = UINT64_C(82);
    int count = 0;
    double squares = 0.0;
    for (int i = 0; i < 500; ++i) {
        gm_position position = random_position(&f, &seed);
        const int column = gm_test_integer(&seed, 0, f.cache->columns - 1);
        const int node = gm_test_integer(&seed, 1, f.cache->nodes - 2);
        position.phase = f.cache->phases[column];
        (void)looked_up_at(&f, &position); /* fills it */
        position.offset = offset_of(&f, 0.0);
        (void)looked_up_at(&f, &position);
        const gmi_cache_start *start = &f.cache->starts[hunting_column(&f, &position, column)];
        position.offset = offset_of(&f, start->delta + (node - start->ahead) * f.cache->step);
        const gm_penetration exact = exact_at(&f, &position);
        const gm_penetration r = looked_up_at(&f, &position);
        if (!was_looked_up(&f, &r)) {
            continue; /* the other column is at its end */
        }
        ++count;
        squares += pow(r.penetration - exact.penetration, 2);
        GM_ASSERT_ABS(r.penetration, exact.penetration, 1e-4 * sum_at_20_Nm);
        GM_ASSERT_ABS(by_x(&f, &r), by_x(&f, &exact), 0.03);
        if (node > 1) {
            assert_mixed(&f, &position, &r);
        }
    }
    GM_ASSERT(count > 300);
    free_fixture(&f);
    return sqrt(squares / count);
}

/*
 * One walk serves many nodes, to second order in their distance from it: over a kink of the flanks, the slope that it
 * adds times the way behind it. The way to a kink is as often short as long, which leaves the power of 1.5 in the mean.
 */
/* To single precision (6e-8), but for the few next to which a kink that moves passes a place where f is zero: each of them is
 * off by less than the triangle in which it does, 1e-3 of slope times the square of 20 um over the advance of 11 mm. */
static void nodes_are_exact(void) {
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        const double error = error_of_nodes(side, 20e-6);
        gm_test_context("side %d: %g m", side, error);
        GM_ASSERT(error < 1e-6 * sum_at_20_Nm);
    }
}

/* What Newton's iteration is told is what the right-hand side does. */
static void derivatives_are_those_of_the_sum(void) {
    const double dx = 1e-10, dphase = 1e-8; /* 5000 and 10000 times smaller than a cell */
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        const gm_cache_params params = params_of(side, 16, 40, 20e-6);
        fixture f;
        make_paper(&f, &params);
        uint64_t seed = UINT64_C(83);
        for (int i = 0; i < 300; ++i) {
            gm_test_context("side %d, state %d", side, i);
            gm_position position = random_position(&f, &seed);
            position.phase = gm_test_uniform(&seed, 0.001, 0.999) * f.pair.transverse_base_pitch;
            position.offset = offset_of(&f, gm_test_uniform(&seed, -10e-6, 10e-6));
            const gm_penetration r = looked_up_at(&f, &position);
            gm_position left = position, right = position;
            left.offset -= dx;
            right.offset += dx;
            const gm_penetration a = looked_up_at(&f, &left), b = looked_up_at(&f, &right);
            if (!was_looked_up(&f, &r) || !was_looked_up(&f, &a) || !was_looked_up(&f, &b)) {
                continue; /* nothing touches, or too deep */
            }
            /* Curvature at most 4 flanks per um, so 4e-4 over 1e-10 m; the sum's own rounding is less. */
            GM_ASSERT_ABS(by_x(&f, &r), (b.penetration - a.penetration) / (2.0 * dx), 5e-4);
            left = right = position;
            left.phase -= dphase;
            right.phase += dphase;
            const gm_penetration c = looked_up_at(&f, &left), d = looked_up_at(&f, &right);
            /* Slopes are up to 1e-3 and change within a cell of 1 um (at kinks) or 300 um. */
            GM_ASSERT_ABS(by_phase(&f, &r), (d.penetration - c.penetration) / (2.0 * dphase), 1e-5);
        }
        free_fixture(&f);
    }
}

/* ---------------------------------------------------------------------------------------------
 * Outside
 * ------------------------------------------------------------------------------------------- */

static void beyond_the_depth_it_is_exact(void) {
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        const gm_cache_params params = params_of(side, 8, 8, 4e-6);
        fixture f;
        make_paper(&f, &params);
        const double p_bt = f.pair.transverse_base_pitch;
        uint64_t seed = UINT64_C(84);
        for (int i = 0; i < 300; ++i) {
            gm_test_context("side %d, state %d", side, i);
            gm_position position = random_position(&f, &seed);
            position.offset = offset_of(&f, 0.0);
            (void)looked_up_at(&f, &position);
            const neighbours near = columns_around(&f, &position);
            const double end = fmin(near.start[0], near.start[1]) + 4e-6;
            position.offset = offset_of(
                &f, end + 1e-12 + (i % 2 == 0 ? 0.0 : gm_test_uniform(&seed, 0.0, 0.4 * p_bt)));
            const gm_penetration exact = exact_at(&f, &position);
            const gm_penetration r = looked_up_at(&f, &position);
            GM_ASSERT(exact.penetration != 0.0);
            GM_ASSERT(memcmp(&r, &exact, sizeof r) == 0);
        }
        free_fixture(&f);
    }
}

/*
 * A start is not needlessly far below: a walk says where contact begins to second order in the way there, with 1 um of it
 * and some 1e-3 of kinks that is a nanometre. Counts those off by more than one bisection step, depth / 4096.
 */
static int is_far_below(const fixture *f, gm_position *position, double first) {
    const double step = f->cache->depth / 4000.0;
    position->offset = offset_of(f, first + 2.0 * step);
    GM_ASSERT(exact_at(f, position).drive > 0.0);
    position->offset = offset_of(f, first + step);
    return !(exact_at(f, position).drive > 0.0);
}

static void assert_zero_below_first_touch(double depth) {
    const gm_cache_params params = params_of(GM_DRIVE, 8, 8, depth);
    fixture f;
    make_paper(&f, &params);
    uint64_t seed = UINT64_C(85);
    int far = 0;
    for (int i = 0; i < 300; ++i) {
        gm_test_context("depth %g, state %d", depth, i);
        gm_position position = random_position(&f, &seed);
        /* Below any touch no column is filled ... */
        position.offset = offset_of(&f, f.cache->lowest);
        gm_penetration r = looked_up_at(&f, &position);
        GM_ASSERT(r.penetration == 0.0 && r.drive_contact == 0.0 && r.rate == 0.0);
        GM_ASSERT(r.d_pinion_angle == 0.0 && r.d_wheel_angle == 0.0);
        GM_ASSERT_INT(r.drive_pairs, 0);
        GM_ASSERT(i > 0 || isnan(columns_around(&f, &position).start[0]));
        /* ... and below that of its columns there is nothing either, nor in truth at the columns. */
        position.offset = offset_of(&f, 0.0);
        (void)looked_up_at(&f, &position);
        const neighbours near = columns_around(&f, &position);
        GM_ASSERT(near.start[0] > f.cache->lowest && near.start[1] > f.cache->lowest);
        const double first = fmin(near.start[0], near.start[1]);
        position.offset = offset_of(&f, gm_test_uniform(&seed, f.cache->lowest, first));
        r = looked_up_at(&f, &position);
        GM_ASSERT(r.penetration == 0.0 && r.drive_contact == 0.0 && r.rate == 0.0);
        GM_ASSERT(r.d_pinion_angle == 0.0 && r.d_wheel_angle == 0.0);
        position.offset = offset_of(&f, first);
        position.phase = near.phase[first == near.start[1]];
        GM_ASSERT(exact_at(&f, &position).drive == 0.0);
        far += is_far_below(&f, &position, first);
    }
    GM_ASSERT(far <= 6); /* 2 % */
    free_fixture(&f);
}

/* However small the depth, a start is found as exactly and about as fast: distances are doubled, then halved. */
static void below_the_first_touch_it_is_zero(void) {
    assert_zero_below_first_touch(8e-6);
    assert_zero_below_first_touch(1e-9);
}

/* From far below to far above, no dip below zero, no jump and no step back larger than the error. */
static void sum_rises_from_zero_without_a_dip(void) {
    const gm_cache_params params = default_params();
    fixture f;
    make_paper(&f, &params);
    uint64_t seed = UINT64_C(86);
    for (int i = 0; i < 100; ++i) {
        gm_position position = random_position(&f, &seed);
        double before = 0.0;
        for (int k = 0; k <= 1000; ++k) {
            gm_test_context("state %d, step %d", i, k);
            position.offset = offset_of(&f, -40e-6 + 0.1e-6 * k);
            const double sum = looked_up_at(&f, &position).drive;
            GM_ASSERT(sum >= 0.0);
            /* 0.1 um more delta on at most 5 pairs over the whole face. */
            GM_ASSERT(sum - before <= 5 * 0.1e-6 && before - sum <= 3e-3 * sum_at_20_Nm);
            before = sum;
        }
    }
    free_fixture(&f);
}

/* The flanks that are not looked up are exact; deep on their side those that are looked up are far apart. */
static void other_flank_is_exact(void) {
    const gm_cache_params params = params_of(GM_DRIVE, 8, 8, 8e-6);
    fixture f;
    make_paper(&f, &params);
    uint64_t seed = UINT64_C(87);
    for (int i = 0; i < 200; ++i) {
        gm_position position = random_position(&f, &seed);
        position.offset = -0.5 * f.pair.backlash + gm_test_uniform(&seed, -30e-6, 30e-6);
        const gm_penetration exact = exact_at(&f, &position);
        const gm_penetration r = looked_up_at(&f, &position);
        GM_ASSERT(memcmp(&r, &exact, sizeof r) == 0);
    }
    free_fixture(&f);
}

static void bad_states_are_refused_as_without_a_cache(void) {
    const gm_cache_params params = params_of(GM_DRIVE, 8, 8, 8e-6);
    fixture f;
    make_paper(&f, &params);
    const double p_bt = f.pair.transverse_base_pitch;
    const gm_position good = {44, 40, 1e-3, 55e-6, 0.25, 0.0};

    /* No number, or beyond its range, in one field after the other. */
    gm_position wrong[16];
    int count = 0;
    static const double bad[] = {(double)NAN, HUGE_VAL, -HUGE_VAL};
    for (int k = 0; k < 3; ++k) {
        for (int field = 0; field < 3; ++field) {
            wrong[count] = good;
            double *const fields[] = {&wrong[count].phase, &wrong[count].offset,
                                      &wrong[count].offset_rate};
            *fields[field] = bad[k];
            ++count;
        }
    }
    wrong[count] = good, wrong[count++].offset = 0.5 * p_bt;
    wrong[count] = good, wrong[count++].phase = 1.5 * p_bt;
    wrong[count] = good, wrong[count++].pinion_tooth = 45;
    wrong[count] = good, wrong[count++].wheel_tooth = -1;

    for (int i = 0; i < count; ++i) {
        gm_test_context("position %d", i);
        gm_penetration exact;
        gm_mesh_result r;
        memset(&exact, 1, sizeof exact);
        memset(&r, 1, sizeof r);
        const int status = penetration_3d_at(&f.pair, f.flanks[0], f.flanks[1], &wrong[i], &exact);

        GM_ASSERT(status != GM_OK);
        GM_ASSERT_INT(gm_mesh_evaluate_at(f.mesh, &wrong[i], GM_WANT_DERIVATIVES, NULL, &r),
                      status);
        GM_ASSERT_NAN(r.force);
        GM_ASSERT_NAN(r.contact.penetration);
        GM_ASSERT_NAN(r.force_by.pinion_angle);
        GM_ASSERT_INT(r.contact.drive_pairs, 0);
    }
    /* A phase that is finite but not in [0, p_bt] is legal, and exact. */
    gm_position outside = good;
    for (int i = 0; i < 2; ++i) {
        gm_test_context("phase outside %d", i);
        outside.phase = i == 0 ? -1e-9 : p_bt * (1.0 + 1e-9);
        const gm_penetration exact = exact_at(&f, &outside), r = looked_up_at(&f, &outside);
        GM_ASSERT(memcmp(&r, &exact, sizeof r) == 0);
    }

    gm_test_context("none was filled");
    for (size_t i = 0; i < (size_t)f.cache->passes * (size_t)f.cache->columns; ++i) {
        if (!isnan(f.cache->starts[i].delta)) {
            GM_ASSERT_NAN(f.cache->starts[i].delta);
            break;
        }
    }
    free_fixture(&f);

    gm_cache_errors errors;
    GM_ASSERT_INT(gm_cache_fill(NULL, 0, 0, NULL), GM_ERR_NULL);
    GM_ASSERT_INT(gm_cache_error(NULL, 1, 1, NULL, &errors), GM_ERR_NULL);
    GM_ASSERT_INT(gm_cache_passes(NULL), 0);
}

/* A cache holds the sums of one mesh; without one a mesh is exact again. */
static void a_cache_serves_its_own_mesh_alone(void) {
    const gm_cache_params params = params_of(GM_DRIVE, 8, 8, 8e-6);
    fixture f, other;
    make_paper(&f, &params);
    make_paper(&other, &params);
    GM_ASSERT_INT(gm_mesh_use_cache(NULL, f.cache), GM_ERR_NULL);
    GM_ASSERT_INT(gm_mesh_use_cache(other.mesh, f.cache), GM_ERR_PARAMETER);

    const gm_position position = {44, 40, 1e-3, 55e-6, 0.25, 0.0};
    const gm_penetration held = looked_up_at(&f, &position);
    GM_ASSERT(was_looked_up(&f, &held));
    GM_ASSERT_INT(gm_mesh_use_cache(f.mesh, NULL), GM_OK);
    const gm_penetration exact = exact_at(&f, &position), again = looked_up_at(&f, &position);
    GM_ASSERT(memcmp(&exact, &again, sizeof exact) == 0);
    free_fixture(&f);
    free_fixture(&other);
}

/* Numbers of pairs, wrenches and energies are exact on request, the force beside the pairs is that of the cache. */
static void pairs_and_wrenches_are_exact_on_request(void) {
    const gm_cache_params params = params_of(GM_DRIVE, 8, 8, 8e-6);
    fixture f;
    make_paper(&f, &params);
    uint64_t seed = UINT64_C(90);
    for (int i = 0; i < 200; ++i) {
        gm_test_context("state %d", i);
        gm_position position = random_position(&f, &seed);
        position.offset = offset_of(&f, gm_test_uniform(&seed, 0.0, 6e-6));
        gm_mesh_result held, counted, wrench, energy, exact;
        GM_ASSERT_INT(gm_mesh_evaluate_at(f.mesh, &position, GM_WANT_FORCE, NULL, &held), GM_OK);
        GM_ASSERT_INT(gm_mesh_evaluate_at(f.mesh, &position, GM_WANT_PAIRS, NULL, &counted), GM_OK);
        GM_ASSERT_INT(gm_mesh_evaluate_at(f.mesh, &position, GM_WANT_WRENCH, NULL, &wrench), GM_OK);
        GM_ASSERT_INT(gm_mesh_evaluate_at(f.mesh, &position, GM_WANT_ENERGY, NULL, &energy), GM_OK);
        GM_ASSERT_INT(plain_evaluate(&f.pair, f.flanks[0], f.flanks[1], &position, 1e8, 0.0,
                                     GM_WANT_WRENCH | GM_WANT_ENERGY, &exact),
                      GM_OK);
        GM_ASSERT_REL(energy.energy, exact.energy, 0.0);
        GM_ASSERT_REL(counted.force, held.force, 0.0);
        GM_ASSERT_INT(counted.contact.drive_pairs, exact.contact.drive_pairs);
        int pairs[2];
        GM_ASSERT_INT(gm_mesh_pairs_at(f.mesh, &position, NULL, pairs), GM_OK);
        GM_ASSERT_INT(pairs[GM_DRIVE], exact.contact.drive_pairs);
        GM_ASSERT(memcmp(&wrench.wrench, &exact.wrench, sizeof exact.wrench) == 0);
        GM_ASSERT_REL(wrench.force, exact.force, 0.0);
    }
    free_fixture(&f);
}

/* ---------------------------------------------------------------------------------------------
 * Tooth passes
 * ------------------------------------------------------------------------------------------- */

/* delta times the length of the lines: quadratic in delta, piecewise linear in phase. */
static void assert_one_pass_serves(const gm_pair_params *drawn) {
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        gm_test_context("side %d", side);
        gm_cache_params params = default_params();
        params.side = side;
        fixture f;
        memset(&f, 0, sizeof f);
        f.pair = make_pair(drawn);
        make_cache(&f, &params);
        GM_ASSERT_INT(f.cache->passes, 1);
        uint64_t seed = UINT64_C(88);
        int count = 0;
        for (int i = 0; i < 2000; ++i) {
            gm_position position = random_position(&f, &seed);
            const double delta = gm_test_uniform(&seed, -10e-6, 30e-6);
            position.offset = offset_of(&f, delta);
            const gm_penetration exact = exact_at(&f, &position);
            const gm_penetration r = looked_up_at(&f, &position);
            count += was_looked_up(&f, &r);
            if (delta <= 0.0) {
                GM_ASSERT(r.penetration == 0.0);
            }
            /* A kink is a change of slope by delta / advance; a cubic that starts with the wrong one is off by
             * 4/27 of the cell: 41 um and 1 um, of 9.5 mm and a length of 1.6: 4e-4 of the sum. */
            GM_ASSERT_REL(r.penetration, exact.penetration, 5e-4);
        }
        GM_ASSERT(count > 900);
        free_fixture(&f);
    }
}

static void ideal_flanks_need_one_pass(void) {
    const gm_pair_params drawn = reference_params(REFERENCE_FACE_WIDTH);
    assert_one_pass_serves(&drawn);
}

/* Profiles that begin late end the lines there: columns stand at the kinks of those ends. */
static void kinks_of_a_given_start_have_their_columns(void) {
    gm_pair_params drawn = reference_params(REFERENCE_FACE_WIDTH);
    drawn.pinion_start_radius = 43.6e-3;
    drawn.wheel_start_radius = 39.6e-3;
    assert_one_pass_serves(&drawn);
}

typedef struct small_flanks {
    gm_flanks *flanks;
    double memory[2000];
} small_flanks;

/* Different teeth by their pitch alone, or all the same. */
static void make_pitch(small_flanks *own, int teeth, int different) {
    const gm_flanks_params params = {.teeth = teeth};
    GM_ASSERT_INT(gm_flanks_init(&own->flanks, &params, own->memory, sizeof own->memory), GM_OK);
    for (int tooth = 0; tooth < teeth; ++tooth) {
        const double pitch = different ? 1e-6 * (tooth % 7) : 2e-6;
        GM_ASSERT_INT(gm_flanks_set_pitch(own->flanks, GM_DRIVE, tooth, pitch), GM_OK);
    }
}

/*
 * The coarse tables of a run, as docs/cache.md states, without columns at kinks: a kink leaves less error than what flanks
 * do that deviate by more than the tables are deep, at most 33 um.
 */
static void coarse_tables_have_better_cells_in_place_of_columns_at_kinks(void) {
    const gm_cache_params coarse = params_of(GM_DRIVE, 8, 16, 20e-6);
    fixture f;
    make_paper(&f, &coarse);
    GM_ASSERT_INT(f.cache->columns, 9);
    measured m;
    measure(&f, 2000, 84, &m);
    GM_ASSERT_INT(m.states, 2000);
    GM_ASSERT_ABS(m.sum_largest, 0.0, 1.6e-2 * sum_at_20_Nm);
    GM_ASSERT_ABS(sqrt(m.sum_squares / m.states), 0.0, 1.3e-3 * sum_at_20_Nm);
    GM_ASSERT_ABS(sqrt(m.contact_squares / m.states), 0.0, 0.015);

    /* Deep tables and fine ones have them, and those of a narrow pair, whose lines grow fast. */
    const gm_cache_params with_kinks[] = {params_of(GM_DRIVE, 8, 16, 40e-6),
                                          params_of(GM_DRIVE, 12, 16, 20e-6), coarse};
    const double widths[] = {REFERENCE_FACE_WIDTH, REFERENCE_FACE_WIDTH,
                             0.5 * REFERENCE_FACE_WIDTH};
    for (int i = 0; i < 3; ++i) {
        gm_test_context("case %d", i);
        fixture other = f;
        other.pair = reference_pair(widths[i]);
        make_cache(&other, &with_kinks[i]);
        GM_ASSERT(other.cache->columns >= with_kinks[i].phase_cells + 4);
        free(other.cache);
        free(other.mesh);
    }
    free_fixture(&f);

    /* So have those of ideal flanks, of which one pass is all. */
    memset(&f, 0, sizeof f);
    f.pair = reference_pair(REFERENCE_FACE_WIDTH);
    make_cache(&f, &coarse);
    GM_ASSERT_INT(f.cache->passes, 1);
    GM_ASSERT(f.cache->columns >= 8 + 4);
    free_fixture(&f);
}

/* Columns begin where contact does, within 1 / 4096 of the depth as cache.c says, and are as exact behind it. */
static void assert_columns_begin_at(fixture *f, double touch) {
    const double depth = f->cache->depth, fine = depth / 4096.0;
    GM_ASSERT_INT(gm_cache_fill(f->cache, 0, f->cache->passes, NULL), GM_OK);
    for (int column = 0; column < f->cache->columns; ++column) {
        GM_ASSERT_ABS(f->cache->starts[column].delta, touch - 0.5 * fine, 0.5000001 * fine);
    }

    /*
     * Kinks as in ideal_flanks_need_one_pass(), and the way from the first node to where contact begins. Kinks have
     * columns of their own up to twice the depth; the others are in the middle of a cell.
     */
    const double cell = f->pair.transverse_base_pitch / 16.0;
    const double kink =
        touch > depth ? 4.0 / 27.0 * cell * depth / fabs(f->pair.face_advance) : 0.0;
    uint64_t seed = UINT64_C(89);
    for (int i = 0; i < 500; ++i) {
        gm_position position = random_position(f, &seed);
        position.offset = offset_of(f, touch + gm_test_uniform(&seed, fine, 18e-6));
        const gm_penetration exact = exact_at(f, &position);
        const gm_penetration r = looked_up_at(f, &position);
        GM_ASSERT(was_looked_up(f, &r));
        GM_ASSERT_NEAR(r.penetration, exact.penetration, 5e-4, 2.0 * fine + kink);
    }
}

/*
 * All that is missing of both flanks, or added to them, moves the first touch by as much, however far that is beyond the
 * depth: a relief that takes the same off everywhere (evaluated node by node), a pitch deviation (by walks).
 */
static void columns_begin_where_contact_does(void) {
    static small_flanks own;
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        for (int i = 0; i < 4; ++i) {
            static const double missing[] = {3.3e-6, 50e-6, 70e-6, -2e-6};
            gm_test_context("side %d, %g m missing", side, missing[i]);
            fixture f;
            memset(&f, 0, sizeof f);
            f.pair = reference_pair(REFERENCE_FACE_WIDTH);
            make_pitch(&own, 45, 0);
            if (missing[i] > 0.0) {
                const gm_flanks_params sizes = {.teeth = 45};
                const gm_flank_ramp even = {.offset = missing[i]};
                GM_ASSERT_INT(gm_flanks_init(&own.flanks, &sizes, own.memory, sizeof own.memory),
                              GM_OK);
                GM_ASSERT_INT(gm_flanks_set_ramps(own.flanks, side, &even, 1, 1.0), GM_OK);
            } else if (side == GM_COAST) {
                for (int tooth = 0; tooth < 45; ++tooth) {
                    GM_ASSERT_INT(gm_flanks_set_pitch(own.flanks, side, tooth, -missing[i]), GM_OK);
                }
            }
            f.flanks[0] = own.flanks;
            gm_cache_params params = default_params();
            params.side = side;
            make_cache(&f, &params);
            GM_ASSERT_INT(f.cache->side, side);
            assert_columns_begin_at(&f, missing[i]);
            free(f.cache);
            free(f.mesh);
        }
    }
}

/*
 * A relief that grows along the whole profile of a pinion so narrow that one line is alone at some phases: contact begins
 * there further above what is the least missing anywhere than the depth reaches, as the exact sum says.
 */
static void columns_begin_where_the_exact_sum_does(void) {
    for (int missing = 0; missing <= 1; ++missing) {
        gm_pair_params drawn = reference_params(0.5e-3);
        if (!missing) { /* no line at all at some phases */
            drawn.pinion_tip_radius = 44.913e-3;
            drawn.wheel_tip_radius = 40.978e-3;
        }
        static small_flanks own;
        const gm_flanks_params sizes = {.teeth = 45};
        const gm_flank_ramp growing = {.offset = 0.0, .per_t2 = 300e-6};
        GM_ASSERT_INT(gm_flanks_init(&own.flanks, &sizes, own.memory, sizeof own.memory), GM_OK);
        GM_ASSERT_INT(gm_flanks_set_ramps(own.flanks, GM_DRIVE, &growing, missing, 1.0), GM_OK);
        fixture f;
        memset(&f, 0, sizeof f);
        f.pair = make_pair(&drawn);
        f.flanks[0] = missing ? own.flanks : NULL;
        const gm_cache_params params = params_of(GM_DRIVE, 16, 8, 20e-6);
        make_cache(&f, &params);
        GM_ASSERT_INT(gm_cache_fill(f.cache, 0, f.cache->passes, NULL), GM_OK);

        const double fine = params.depth / 4096.0;
        double highest = 0.0;
        int without = 0;
        for (int column = 0; column < f.cache->columns; ++column) {
            gm_test_context("missing %d, column %d", missing, column);
            const double start = f.cache->starts[column].delta;
            gm_position position = {.phase = f.cache->phases[column]};
            if (start < HUGE_VAL) {
                position.offset = offset_of(&f, start);
                GM_ASSERT(exact_at(&f, &position).drive == 0.0);
                position.offset = offset_of(&f, start + 1.000001 * fine);
                GM_ASSERT(exact_at(&f, &position).drive > 0.0);
                highest = fmax(highest, start);
            } else {
                position.offset = 0.4999 * f.pair.transverse_base_pitch;
                GM_ASSERT(exact_at(&f, &position).drive == 0.0);
                ++without;
            }
        }
        GM_ASSERT(missing ? without == 0 && highest > 3.0 * params.depth
                          : without > 0 && without < f.cache->columns);
        free(f.cache);
        free(f.mesh);
    }
}

static gm_pair pair_of_teeth(int pinion, int wheel) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    params.pinion_teeth = pinion;
    params.wheel_teeth = wheel;
    params.center_distance = 85e-3 * (pinion + wheel) / 86.0;
    params.pinion_tip_radius = params.wheel_tip_radius = (double)NAN;
    params.pinion_rack_addendum = params.wheel_rack_addendum = 1.0;
    params.pinion_tip_alteration = params.wheel_tip_alteration = 0.0;
    return make_pair(&params);
}

static void passes_are_those_that_happen(void) {
    static const struct {
        int pinion, wheel, pinion_differs, wheel_differs, passes;
    } cases[] = {
        {45, 41, 1, 1, 1845}, {45, 41, 1, 0, 45}, {45, 41, 0, 1, 41}, {45, 41, 0, 0, 1},
        {40, 30, 1, 1, 120},  {40, 30, 0, 1, 30}, {30, 30, 1, 1, 30}, {20, 60, 1, 1, 60},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        gm_test_context("case %d", (int)i);
        static small_flanks own[2];
        fixture f;
        memset(&f, 0, sizeof f);
        f.pair = pair_of_teeth(cases[i].pinion, cases[i].wheel);
        make_pitch(&own[0], cases[i].pinion, cases[i].pinion_differs);
        make_pitch(&own[1], cases[i].wheel, cases[i].wheel_differs);
        f.flanks[0] = own[0].flanks;
        f.flanks[1] = own[1].flanks;
        const gm_cache_params params = params_of(GM_DRIVE, 8, 8, 20e-6);
        make_cache(&f, &params);
        GM_ASSERT_INT(f.cache->passes, cases[i].passes);

        /* All that a rotation brings together is looked up, each pass in a place of its own. */
        for (int turned = -200; turned < 2000; turned += 3) {
            gm_position position;
            GM_ASSERT_INT(
                gm_position_from_pinion_angle(&f.pair, (turned + 0.37) * f.pair.pinion.pitch_angle,
                                              0.5 * f.pair.backlash + 5e-6, 0.0, &position),
                GM_OK);
            const gm_penetration exact = exact_at(&f, &position);
            const gm_penetration r = looked_up_at(&f, &position);
            GM_ASSERT(was_looked_up(&f, &r));
            /* Steps of 2.5 um and kinks of several teeth within them. */
            GM_ASSERT_NEAR(r.drive, exact.drive, 0.02, 1e-7);
        }
        free(f.cache);
        free(f.mesh);
    }
}

/* The last column of a pass is the first of the next one, in which both gears are a tooth further on: between its own column
 * before it and that one, the sum is as exact as anywhere. */
static void a_pass_ends_where_the_next_one_begins(void) {
    const gm_cache_params params = default_params();
    fixture f;
    make_paper(&f, &params);
    const double p_bt = f.pair.transverse_base_pitch;
    uint64_t seed = UINT64_C(91);
    int count = 0;
    for (int i = 0; i < 300; ++i) {
        gm_test_context("state %d", i);
        gm_position end = random_position(&f, &seed), begin = end;
        end.phase = p_bt;
        end.offset = offset_of(&f, gm_test_uniform(&seed, -10e-6, 10e-6));
        begin = end;
        begin.phase = 0.0;
        begin.pinion_tooth = (end.pinion_tooth + 44) % 45;
        begin.wheel_tooth = (end.wheel_tooth + 40) % 41;
        const gm_penetration a = looked_up_at(&f, &end), b = looked_up_at(&f, &begin);
        if (was_looked_up(&f, &a) && was_looked_up(&f, &b)) {
            GM_ASSERT_NEAR(a.drive, b.drive, 1e-14, 0.0);
            GM_ASSERT_NEAR(by_x(&f, &a), by_x(&f, &b), 1e-12, 1e-12);
            ++count;
        }

        /* And just before the end, of what the column there holds. */
        end.phase = p_bt * (1.0 - 1e-6);
        const gm_penetration exact = exact_at(&f, &end), r = looked_up_at(&f, &end);
        GM_ASSERT_ABS(r.drive, exact.drive, 3e-3 * sum_at_20_Nm);
    }
    GM_ASSERT(count > 150);
    free_fixture(&f);
}

/* Teeth that never meet, as with 40/30 teeth assembled one tooth further. */
static void strangers_are_evaluated_exactly(void) {
    static small_flanks own[2];
    fixture f;
    memset(&f, 0, sizeof f);
    f.pair = pair_of_teeth(40, 30);
    make_pitch(&own[0], 40, 1);
    make_pitch(&own[1], 30, 1);
    f.flanks[0] = own[0].flanks;
    f.flanks[1] = own[1].flanks;
    const gm_cache_params params = params_of(GM_DRIVE, 8, 8, 20e-6);
    make_cache(&f, &params);
    for (int pinion = 0; pinion < 40; ++pinion) {
        for (int wheel = 0; wheel < 30; ++wheel) {
            const gm_position position = {pinion, wheel, 1e-3, 0.5 * f.pair.backlash + 5e-6,
                                          0.0,    0.0};
            const gm_penetration exact = exact_at(&f, &position);
            const gm_penetration r = looked_up_at(&f, &position);
            GM_ASSERT_INT(was_looked_up(&f, &r), (pinion - wheel) % 10 == 0);
            if ((pinion - wheel) % 10 != 0) {
                GM_ASSERT(memcmp(&r, &exact, sizeof r) == 0);
            }
        }
    }
    free(f.cache);
    free(f.mesh);
}

/* ---------------------------------------------------------------------------------------------
 * Filling
 * ------------------------------------------------------------------------------------------- */

typedef struct filler {
    gm_cache *cache;
    int first, count, status;
} filler;

static void *fill(void *argument) {
    filler *work = argument;
    work->status = gm_cache_fill(work->cache, work->first, work->count, NULL);
    return NULL;
}

/* Several threads fill, then nothing is written any more; lazily the same comes out. */
static void threads_may_fill_and_then_share(void) {
    enum { THREADS = 3 };
    const gm_cache_params params = params_of(GM_DRIVE, 4, 4, 20e-6);
    fixture filled, lazy;
    make_paper(&filled, &params);
    make_paper(&lazy, &params);
    const int passes = filled.cache->passes, share = passes / THREADS;
    pthread_t threads[THREADS];
    filler work[THREADS];
    for (int t = 0; t < THREADS; ++t) {
        work[t] = (filler){filled.cache, t * share, share, -99};
        GM_ASSERT_INT(pthread_create(&threads[t], NULL, fill, &work[t]), 0);
    }
    for (int t = 0; t < THREADS; ++t) {
        pthread_join(threads[t], NULL);
        GM_ASSERT_INT(work[t].status, GM_OK);
    }
    for (size_t i = 0; i < (size_t)passes * (size_t)filled.cache->columns; ++i) {
        if (isnan(filled.cache->starts[i].delta)) {
            GM_ASSERT_INT(i, -1);
            break;
        }
    }
    void *before = malloc(filled.size);
    memcpy(before, filled.cache, filled.size);
    uint64_t seed = UINT64_C(89);
    for (int i = 0; i < 500; ++i) {
        gm_position position = random_position(&filled, &seed);
        position.offset = offset_of(&filled, gm_test_uniform(&seed, -20e-6, 20e-6));
        const gm_penetration a = looked_up_at(&filled, &position);
        const gm_penetration b = looked_up_at(&lazy, &position);
        GM_ASSERT(memcmp(&a, &b, sizeof a) == 0);
    }
    GM_ASSERT(memcmp(before, filled.cache, filled.size) == 0);
    free(before);

    GM_ASSERT_INT(gm_cache_fill(NULL, 0, 1, NULL), GM_ERR_NULL);
    GM_ASSERT_INT(gm_cache_fill(lazy.cache, -1, 1, NULL), GM_ERR_PARAMETER);
    GM_ASSERT_INT(gm_cache_fill(lazy.cache, 0, -1, NULL), GM_ERR_PARAMETER);
    GM_ASSERT_INT(gm_cache_fill(lazy.cache, passes, 1, NULL), GM_ERR_PARAMETER);
    GM_ASSERT_INT(gm_cache_fill(lazy.cache, 1, passes, NULL), GM_ERR_PARAMETER);
    GM_ASSERT_INT(gm_cache_fill(lazy.cache, passes, 0, NULL), GM_OK);
    free_fixture(&filled);
    free_fixture(&lazy);
}

/* A run pays for what it meets: two columns per state in passes that are all different. */
static void only_what_is_met_is_filled(void) {
    const gm_cache_params params = default_params();
    fixture f;
    make_paper(&f, &params);
    for (int pass = 0; pass < 10; ++pass) {
        const gm_position position = {pass, pass, 1e-3, 0.5 * f.pair.backlash, 0.0, 0.0};
        (void)looked_up_at(&f, &position);
        (void)looked_up_at(&f, &position);
    }
    int filled = 0;
    for (size_t i = 0; i < (size_t)f.cache->passes * (size_t)f.cache->columns; ++i) {
        filled += !isnan(f.cache->starts[i].delta);
    }
    GM_ASSERT_INT(filled, 20);
    free_fixture(&f);
}

/* ---------------------------------------------------------------------------------------------
 * Size and refusals
 * ------------------------------------------------------------------------------------------- */

static void memory_grows_with_the_resolution_alone(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    static small_flanks own[2];
    make_pitch(&own[0], 45, 1);
    make_pitch(&own[1], 41, 1);
    gm_mesh *ideal = make_mesh(&pair, NULL, NULL);
    gm_mesh *own_pitch = make_mesh(&pair, own[0].flanks, own[1].flanks);
    size_t before = 0;
    for (int cells = 4; cells <= 64; ++cells) {
        gm_test_context("%d cells", cells);
        const gm_cache_params in_phase = params_of(GM_DRIVE, cells, 16, 20e-6);
        const size_t size = gm_cache_size(&in_phase, ideal);
        GM_ASSERT(size >= before);
        before = size;
        /* 16 bytes per node, 24 per column, and 8 columns more than cells at most: at the kinks. */
        GM_ASSERT(size >= (size_t)cells * 17 * 16);
        GM_ASSERT(size <= sizeof(gm_cache) + ((size_t)cells + 9) * (17 * 16 + 24));
        const gm_cache_params in_depth = params_of(GM_DRIVE, 16, cells, 20e-6);
        const gm_cache_params one_more = params_of(GM_DRIVE, 16, cells + 1, 20e-6);
        GM_ASSERT(gm_cache_size(&in_depth, ideal) < gm_cache_size(&one_more, ideal));
    }
    const gm_cache_params params = default_params();
    const size_t one = gm_cache_size(&params, ideal);
    const size_t all = gm_cache_size(&params, own_pitch);
    gm_test_context("all passes");
    GM_ASSERT(all > 1700 * one && all < 1845 * one);
    GM_ASSERT(all <= 30000000);
    free(ideal);
    free(own_pitch);
}

static void assert_refused(const gm_cache_params *params, const gm_mesh *mesh, int status) {
    double memory[4000];
    gm_cache *cache = (gm_cache *)memory;
    GM_ASSERT_INT(gm_cache_size(params, mesh), 0);
    GM_ASSERT_INT(gm_cache_init(&cache, params, mesh, memory, sizeof memory), status);
    GM_ASSERT(cache == NULL);
}

static void wrong_calls_are_refused(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH), spur = spur_pair();
    const gm_cache_params good = params_of(GM_DRIVE, 4, 4, 20e-6);
    const double p_bt = pair.transverse_base_pitch;
    gm_mesh *mesh = make_mesh(&pair, NULL, NULL), *jumping = make_mesh(&spur, NULL, NULL);
    const gm_cache_params wrong[] = {
        params_of(-1, 4, 4, 20e-6),
        params_of(2, 4, 4, 20e-6),
        params_of(GM_DRIVE, 3, 4, 20e-6),
        params_of(GM_DRIVE, 10001, 4, 20e-6),
        params_of(GM_DRIVE, 4, 3, 20e-6),
        params_of(GM_DRIVE, 4, 10001, 20e-6),
        params_of(GM_DRIVE, 4, 4, 0.0),
        params_of(GM_DRIVE, 4, 4, 0.9e-10),
        params_of(GM_DRIVE, 4, 4, (double)NAN),
        params_of(GM_DRIVE, 4, 4, HUGE_VAL),
        params_of(GM_DRIVE, 4, 4, 0.26 * p_bt),
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; ++i) {
        gm_test_context("params %d", (int)i);
        assert_refused(&wrong[i], mesh, GM_ERR_PARAMETER);
    }
    const gm_cache_params ends[] = {
        params_of(GM_DRIVE, 4, 10000, 20e-6),
        params_of(GM_DRIVE, 10000, 4, 20e-6),
        params_of(GM_DRIVE, 4, 4, 1e-10),
        params_of(GM_COAST, 4, 4, 0.25 * p_bt),
    };
    for (size_t i = 0; i < sizeof ends / sizeof ends[0]; ++i) {
        gm_test_context("end of a range %d", (int)i);
        GM_ASSERT(gm_cache_size(&ends[i], mesh) > 0);
    }

    /* What a table over phase cannot hold: forces that jump, no lines at all. */
    gm_test_context("spur");
    assert_refused(&good, jumping, GM_ERR_GEOMETRY);
    gm_test_context("simple");
    gm_mesh_params law;
    gm_mesh *other = NULL;
    gm_mesh_params_default(&law);
    law.stiffness = 1e8;
    law.model = GM_MODEL_SIMPLE;
    const size_t room = gm_mesh_size(&law, &pair);
    void *place = malloc(room);
    GM_ASSERT_INT(gm_mesh_init(&other, &law, &pair, NULL, NULL, place, room), GM_OK);
    assert_refused(&good, other, GM_ERR_GEOMETRY);
    free(place);
    gm_test_context("NULL");
    assert_refused(NULL, mesh, GM_ERR_NULL);
    assert_refused(&good, NULL, GM_ERR_NULL);
    gm_cache_params_default(NULL);

    gm_test_context("memory");
    double memory[2000];
    gm_cache *cache;
    const size_t size = gm_cache_size(&good, mesh);
    GM_ASSERT(size > 0 && size <= sizeof memory - sizeof(double));
    GM_ASSERT_INT(gm_cache_init(&cache, &good, mesh, memory, size - 1), GM_ERR_MEMORY);
    GM_ASSERT_INT(gm_cache_init(&cache, &good, mesh, (char *)memory + 1, size), GM_ERR_MEMORY);
    GM_ASSERT_INT(gm_cache_init(&cache, &good, mesh, NULL, size), GM_ERR_NULL);
    GM_ASSERT(cache == NULL);
    GM_ASSERT_INT(gm_cache_init(NULL, &good, mesh, memory, size), GM_ERR_NULL);
    GM_ASSERT_INT(gm_cache_init(&cache, &good, mesh, memory, size), GM_OK);
    GM_ASSERT_INT(gm_cache_fill(cache, 0, 1, NULL), GM_OK);
    free(mesh);
    free(jumping);
}

/* The paper's gears with their edges in contact, twice: exact, and with a cache that both meshes' flanks are for. */
typedef struct edged {
    fixture f;
    gm_mesh *exact;
} edged;

static gm_mesh *make_edged_mesh(const fixture *f, int corner, double damping) {
    gm_mesh_params params;
    gm_mesh *mesh = NULL;
    gm_mesh_params_default(&params);
    params.stiffness = 1e8;
    params.damping = damping;
    params.corner_contact = corner;
    const size_t size = gm_mesh_size(&params, &f->pair);
    GM_ASSERT_INT(
        gm_mesh_init(&mesh, &params, &f->pair, f->flanks[0], f->flanks[1], malloc(size), size),
        GM_OK);
    return mesh;
}

static void make_edged(edged *e, int side, int corner, int has_flanks) {
    fixture *f = &e->f;
    memset(e, 0, sizeof *e);
    f->pair = reference_pair(REFERENCE_FACE_WIDTH);
    if (has_flanks) {
        read_flanks(f, 0, PAPER "pinion_flanks.csv", PAPER "pinion_pitch.csv");
        read_flanks(f, 1, PAPER "wheel_flanks.csv", PAPER "wheel_pitch.csv");
    }
    gm_cache_params params = default_params();
    params.side = side;
    f->mesh = make_edged_mesh(f, corner, 2e3);
    e->exact = make_edged_mesh(f, corner, 2e3);
    f->size = gm_cache_size(&params, f->mesh);
    GM_ASSERT_INT(gm_cache_init(&f->cache, &params, f->mesh, malloc(f->size), f->size), GM_OK);
    GM_ASSERT_INT(gm_mesh_use_cache(f->mesh, f->cache), GM_OK);
}

static void free_edged(edged *e) {
    free(e->exact);
    free_fixture(&e->f);
}

/* A random state as deep as under about 1 to 40 N m. */
static gm_position edged_position(edged *e, uint64_t *seed, int i) {
    fixture *f = &e->f;
    gm_position position = random_position(f, seed);
    position.offset = offset_of(f, gm_test_uniform(seed, 0.5e-6, 14e-6));
    position.offset_rate = i % 2 == 0 ? 0.0 : gm_test_uniform(seed, -2e-4, 2e-4);
    return position;
}

typedef struct edged_errors {
    double force, force_rms, torque, torque_rms; /* over the mean force, and of that times r_b */
} edged_errors;

/* How far the cache is off, of force and of what both torques are beside it. */
static void measure_edged(edged *e, int states, edged_errors *errors) {
    fixture *f = &e->f;
    uint64_t seed = 5;
    const edged_errors none = {0.0, 0.0, 0.0, 0.0};
    const double force = 1e8 * sum_at_20_Nm;
    const double r_bp = f->pair.pinion.base_radius, r_bw = f->pair.wheel.base_radius;
    *errors = none;
    for (int i = 0; i < states; ++i) {
        const gm_position position = edged_position(e, &seed, i);
        gm_mesh_result exact, found;
        GM_ASSERT_INT(gm_mesh_evaluate_at(e->exact, &position, 0, NULL, &exact), GM_OK);
        GM_ASSERT_INT(gm_mesh_evaluate_at(f->mesh, &position, 0, NULL, &found), GM_OK);
        const double off = fabs(found.force - exact.force) / force;
        const double arms[2] = {
            (found.pinion_torque / r_bp - found.force) - (exact.pinion_torque / r_bp - exact.force),
            (found.wheel_torque / r_bw - found.force) - (exact.wheel_torque / r_bw - exact.force)};
        errors->force = fmax(errors->force, off);
        errors->force_rms += off * off / states;
        for (int gear = 0; gear < 2; ++gear) {
            errors->torque = fmax(errors->torque, fabs(arms[gear]) / force);
            errors->torque_rms += arms[gear] * arms[gear] / (2.0 * states * force * force);
        }
    }
    errors->force_rms = sqrt(errors->force_rms);
    errors->torque_rms = sqrt(errors->torque_rms);
}

static void corners_are_held(void) {
    for (int i = 0; i < 4; ++i) {
        /* With measured flanks nearly each state fills a column of its own. */
        const int has_flanks = i < 2, states = has_flanks ? 500 : 4000;
        edged e;
        edged_errors with, without;
        gm_test_context("case %d", i);
        make_edged(&e, i % 2 == 0 ? GM_DRIVE : GM_COAST, GM_CORNER_ON, has_flanks);
        measure_edged(&e, states, &with);
        free_edged(&e);
        make_edged(&e, i % 2 == 0 ? GM_DRIVE : GM_COAST, GM_CORNER_OFF, has_flanks);
        measure_edged(&e, states, &without);
        free_edged(&e);

        /* As near as without them; and what edges make of the torques is 1 % of that. */
        GM_ASSERT(with.force_rms < 3e-4);
        GM_ASSERT(with.force < 4e-3);
        GM_ASSERT(with.torque_rms < 4e-5);
        GM_ASSERT(with.torque < 4e-4);
        GM_ASSERT(without.force_rms < 2.5e-4);
    }
}

/* Force and torques with corners: derivatives are those of what is looked up, what damps held in those by angles. */
static void derivatives_with_corners_are_those_of_differences(void) {
    edged e;
    fixture *f = &e.f;
    make_edged(&e, GM_DRIVE, GM_CORNER_ON, 1);
    uint64_t seed = 17;
    int met = 0, rejected = 0;
    for (int i = 0; i < 300; ++i) {
        const gm_position position = edged_position(&e, &seed, i);
        gm_mesh_result r;
        GM_ASSERT_INT(gm_mesh_evaluate_at(f->mesh, &position, GM_WANT_DERIVATIVES, NULL, &r),
                      GM_OK);

        /* Differences of two steps, which agree where nothing begins to touch between. */
        for (int which = position.offset_rate == 0.0 ? 0 : 2; which < 4; ++which) {
            gm_test_context("state %d, by %d", i, which);
            const double r_bp = f->pair.pinion.base_radius, r_bw = f->pair.wheel.base_radius;
            const double h = which < 2 ? 2e-9 / r_bp : 1e-5;
            double difference[2][3] = {{0.0}};
            for (int k = 0; k < 4; ++k) {
                gm_position moved = position;
                const double by = (k % 2 == 0 ? -h : h) * (k < 2 ? 1.0 : 0.5);
                moved.offset += which == 0 ? r_bp * by : which == 1 ? -r_bw * by : 0.0;
                moved.phase += which == 0 ? r_bp * by : 0.0;
                moved.offset_rate += which == 2 ? r_bp * by : which == 3 ? -r_bw * by : 0.0;
                gm_mesh_result at;
                GM_ASSERT_INT(gm_mesh_evaluate_at(f->mesh, &moved, 0, NULL, &at), GM_OK);
                const double value[3] = {at.force, at.pinion_torque, at.wheel_torque};
                for (int of = 0; of < 3; ++of) {
                    difference[k / 2][of] += (k % 2 == 0 ? -0.5 : 0.5) * value[of] / fabs(by);
                }
            }

            const gm_gradient *by[3] = {&r.force_by, &r.pinion_torque_by, &r.wheel_torque_by};
            double found[3], expected[3], doubt[3];

            for (int of = 0; of < 3; ++of) {
                const double parts[4] = {by[of]->pinion_angle, by[of]->wheel_angle,
                                         by[of]->pinion_speed, by[of]->wheel_speed};
                const double arm = of == 0 ? 1.0 : of == 1 ? r_bp : r_bw;
                found[of] = parts[which] / arm;
                expected[of] = difference[1][of] / arm;
                doubt[of] = fabs(difference[0][of] - difference[1][of]) / arm;
            }

            const double size = fabs(found[0]) + (which < 2 ? 1e5 : 1.0);
            if (doubt[0] + doubt[1] + doubt[2] > 1e-5 * size) {
                ++rejected; /* an edge of a cell between */
                continue;
            }
            GM_ASSERT_ABS(found[0], expected[0], 1e-4 * size);

            /* And what edges add to it in both torques. */
            for (int of = 1; of < 3; ++of) {
                GM_ASSERT_ABS(found[of] - found[0], expected[of] - expected[0],
                              1e-6 * size + 1e-3 * fabs(found[of] - found[0]));
                ++met;
            }
        }
    }
    GM_ASSERT(met > 1500);
    GM_ASSERT(rejected < 100);
    free_edged(&e);
}

/* Pairs are counted, wrenches and the other flank are exact, and so is what is deeper than the cache. */
static void what_a_cache_does_not_hold_of_corners_is_exact(void) {
    edged e;
    fixture *f = &e.f;
    make_edged(&e, GM_DRIVE, GM_CORNER_ON, 1);
    uint64_t seed = 23;
    for (int i = 0; i < 200; ++i) {
        gm_test_context("state %d", i);
        gm_position position = edged_position(&e, &seed, i);
        if (i % 4 >= 2) {
            position.offset = i % 4 == 2 ? -position.offset : offset_of(f, 90e-6);
        }
        const int wanted = i % 4 == 0   ? GM_WANT_PAIRS
                           : i % 4 == 1 ? GM_WANT_WRENCH
                                        : GM_WANT_DERIVATIVES;
        gm_mesh_result exact, found;
        GM_ASSERT_INT(gm_mesh_evaluate_at(e.exact, &position, wanted, NULL, &exact), GM_OK);
        GM_ASSERT_INT(gm_mesh_evaluate_at(f->mesh, &position, wanted, NULL, &found), GM_OK);
        if (i % 4 == 0) {
            GM_ASSERT_INT(found.contact.drive_pairs, exact.contact.drive_pairs);
            GM_ASSERT_INT(found.contact.coast_pairs, exact.contact.coast_pairs);
            int pairs[2];
            GM_ASSERT_INT(gm_mesh_pairs_at(f->mesh, &position, NULL, pairs), GM_OK);
            GM_ASSERT_INT(pairs[GM_DRIVE], exact.contact.drive_pairs);
            GM_ASSERT_INT(pairs[GM_COAST], exact.contact.coast_pairs);
            position.phase = (double)NAN;
            GM_ASSERT_INT(gm_mesh_pairs_at(f->mesh, &position, NULL, pairs), GM_STATE_NOT_FINITE);
            GM_ASSERT(pairs[GM_DRIVE] == 0 && pairs[GM_COAST] == 0);
        } else {
            GM_ASSERT(memcmp(&found.force, &exact.force, sizeof found.force) == 0);
            GM_ASSERT(found.wheel_torque == exact.wheel_torque);
            GM_ASSERT(found.pinion_torque == exact.pinion_torque);
        }
    }
    free_edged(&e);
}

/* Tips so short that some phases have no line of contact: nothing to look up, and nothing to look for without end. */
static void a_pair_that_hardly_touches_is_measured_in_bounded_time(void) {
    gm_pair_params params = reference_params(0.5e-3);
    params.pinion_tip_radius = 44.913e-3;
    params.wheel_tip_radius = 40.978e-3;
    fixture f;
    memset(&f, 0, sizeof f);
    f.pair = make_pair(&params);
    GM_ASSERT(f.pair.total_contact_ratio < 0.9);
    static small_flanks own;
    make_pitch(&own, 45, 1);
    f.flanks[0] = own.flanks;
    const gm_cache_params coarse = params_of(GM_DRIVE, 8, 8, 20e-6);
    make_cache(&f, &coarse);
    gm_cache_errors errors;
    GM_ASSERT_INT(gm_cache_error(f.cache, 500, 1, NULL, &errors), GM_OK);
    GM_ASSERT(errors.sum_largest < 1e-6); /* steps of 2.5 um */

    GM_ASSERT_INT(gm_cache_fill(f.cache, 0, f.cache->passes, NULL), GM_OK);
    int without = 0;
    const int all = f.cache->passes * f.cache->columns;
    for (int i = 0; i < all; ++i) {
        without += !(f.cache->starts[i].delta < HUGE_VAL);
    }
    GM_ASSERT(without > 0 && without < all);
    free(f.cache);
    free(f.mesh);
}

/* Two gears of 20000 teeth, all different: 4e8 tooth passes. */
static void more_passes_than_any_memory_are_refused(void) {
    const gm_pair pair = pair_of_teeth(20011, 20021);
    const gm_cache_params params = params_of(GM_DRIVE, 4, 4, 20e-6);
    const int teeth[2] = {20011, 20021};
    gm_flanks *flanks[2];
    void *memory[2];
    for (int gear = 0; gear < 2; ++gear) {
        const gm_flanks_params sizes = {.teeth = teeth[gear]};
        const size_t size = gm_flanks_size(&sizes);
        memory[gear] = malloc(size);
        GM_ASSERT_INT(gm_flanks_init(&flanks[gear], &sizes, memory[gear], size), GM_OK);
        GM_ASSERT_INT(gm_flanks_set_pitch(flanks[gear], GM_DRIVE, 1, 1e-6), GM_OK);
    }
    gm_mesh *mesh = make_mesh(&pair, flanks[0], flanks[1]);
    assert_refused(&params, mesh, GM_ERR_MEMORY);
    free(mesh);
    free(memory[0]);
    free(memory[1]);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(error_is_as_stated),
        GM_TEST(coarse_tables_have_better_cells_in_place_of_columns_at_kinks),
        GM_TEST(columns_of_many_walks_are_as_exact),
        GM_TEST(error_can_be_measured),
        GM_TEST(nodes_are_exact),
        GM_TEST(derivatives_are_those_of_the_sum),
        GM_TEST(beyond_the_depth_it_is_exact),
        GM_TEST(below_the_first_touch_it_is_zero),
        GM_TEST(sum_rises_from_zero_without_a_dip),
        GM_TEST(other_flank_is_exact),
        GM_TEST(bad_states_are_refused_as_without_a_cache),
        GM_TEST(a_cache_serves_its_own_mesh_alone),
        GM_TEST(pairs_and_wrenches_are_exact_on_request),
        GM_TEST(ideal_flanks_need_one_pass),
        GM_TEST(kinks_of_a_given_start_have_their_columns),
        GM_TEST(columns_begin_where_contact_does),
        GM_TEST(columns_begin_where_the_exact_sum_does),
        GM_TEST(corners_are_held),
        GM_TEST(derivatives_with_corners_are_those_of_differences),
        GM_TEST(what_a_cache_does_not_hold_of_corners_is_exact),
        GM_TEST(a_pair_that_hardly_touches_is_measured_in_bounded_time),
        GM_TEST(passes_are_those_that_happen),
        GM_TEST(a_pass_ends_where_the_next_one_begins),
        GM_TEST(strangers_are_evaluated_exactly),
        GM_TEST(threads_may_fill_and_then_share),
        GM_TEST(only_what_is_met_is_filled),
        GM_TEST(memory_grows_with_the_resolution_alone),
        GM_TEST(wrong_calls_are_refused),
        GM_TEST(more_passes_than_any_memory_are_refused),
    };
    return gm_test_main("unit.cache", tests, GM_TEST_COUNT(tests), argc, argv);
}
