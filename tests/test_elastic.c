/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Elastic teeth: properties that physics and mathematics demand, and a second implementation by another method on random
 * gears. Reference numbers are in test_elastic_reference.c.
 */
#include "elastic.h"
#include "elastic_model.h"
#include "hertz.h"
#include "tooth_compliance.h"

#include <math.h>

static const double degree = 0.017453292519943295;
static const elastic_deviation ideal = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, {0.0, 0.0, 0.0}};

/* Spur pair, reference pair, wide wind turbine pair, planet in a ring. */
enum { KINDS = 4 };

static elastic_gear gear_of(int kind) {
    const elastic_gear drawings[KINDS] = {
        {.normal_module = 2e-3,
         .pressure_angle = 20.0 * degree,
         .center_distance = 0.124,
         .face_width = 0.02,
         .teeth = {62.0, 62.0},
         .tip_radius = {64e-3, 64e-3}},
        {.normal_module = 1.65e-3,
         .pressure_angle = 16.0 * degree,
         .helix_angle = 33.0 * degree,
         .center_distance = 85.0000164e-3,
         .face_width = 17.5e-3,
         .teeth = {45.0, 41.0},
         .shift = {0.1242, 0.1242},
         .tip_radius = {46.12141724645e-3, 42.18661838017e-3}},
        {.normal_module = 14e-3,
         .pressure_angle = 20.0 * degree,
         .helix_angle = -10.0 * degree,
         .center_distance = 861.0001467e-3,
         .face_width = 0.36,
         .teeth = {24.0, 95.0},
         .shift = {0.48, 0.6691},
         .tip_radius = {190.3736708e-3, 697.6880969e-3}},
        {.normal_module = 21e-3,
         .pressure_angle = 20.0 * degree,
         .helix_angle = 8.0 * degree,
         .center_distance = 589.74e-3,
         .face_width = 0.4,
         .teeth = {36.0, -93.0},
         .shift = {0.5039, 0.1171},
         .tip_radius = {411.54e-3, 962.64e-3}},
    };
    elastic_gear gear = drawings[kind];

    /* All cut by the same rack; steel, but for one wheel. */
    gear.dedendum = 1.25;
    gear.fillet_radius = 0.38;
    gear.stations = 17;
    for (int k = 0; k < 2; ++k) {
        const int is_softer = kind == 2 && k == 1;
        gear.youngs_modulus[k] = is_softer ? 170e9 : 206e9;
        gear.poisson_ratio[k] = is_softer ? 0.27 : 0.3;
    }
    return gear;
}

static void make(elastic_case *c, int kind, int stations) {
    elastic_gear gear = gear_of(kind);
    gear.stations = stations;
    GM_ASSERT_INT(elastic_case_make(c, &gear, 8), GM_OK);
}

static double middle_of(const elastic_case *c) {
    return 0.5 * (c->gear.path_start + c->gear.path_end) -
           0.5 * tan(c->gear.base_helix_angle) * c->gear.face_width;
}

/* ---------------------------------------------------------------------------------------------
 * A second implementation
 * ------------------------------------------------------------------------------------------- */

/* is_ring: the pinion turns in a ring. */
static elastic_gear random_gear(uint64_t *seed, int is_ring) {
    elastic_gear g;
    memset(&g, 0, sizeof g);
    g.normal_module = pow(10.0, gm_test_uniform(seed, -3.0, -1.7));
    g.pressure_angle = gm_test_uniform(seed, 17.0, 25.0) * degree;
    g.helix_angle =
        gm_test_integer(seed, 0, 3) == 0 ? 0.0 : gm_test_uniform(seed, -35.0, 35.0) * degree;
    g.face_width = g.normal_module * gm_test_uniform(seed, 4.0, 20.0);
    g.dedendum = gm_test_uniform(seed, 1.2, 1.3);
    g.fillet_radius = gm_test_uniform(seed, 0.2, 0.3);
    g.stations = gm_test_integer(seed, 2, 21);
    const double transverse = atan(tan(g.pressure_angle) / cos(g.helix_angle));
    double involute = tan(transverse) - transverse, radius = 0.0;
    double shifts = 0.0;
    for (int k = 0; k < 2; ++k) {
        g.teeth[k] = gm_test_integer(seed, 22, 110);
        g.shift[k] = gm_test_uniform(seed, 0.0, 0.5);
        if (is_ring && k == 1) {
            g.teeth[1] = -(g.teeth[0] + g.teeth[1] + 20.0);
            g.shift[1] -= g.shift[0] + 0.2;
        }
        g.youngs_modulus[k] = gm_test_uniform(seed, 70e9, 210e9);
        g.poisson_ratio[k] = gm_test_uniform(seed, 0.2, 0.35);
        radius += 0.5 * g.normal_module / cos(g.helix_angle) * g.teeth[k];
        shifts += g.shift[k];
    }

    /* Centre distance without backlash, tips with a clearance of about a quarter module. */
    involute += 2.0 * tan(g.pressure_angle) * shifts / (g.teeth[0] + g.teeth[1]);
    double low = 0.0, high = 1.2;
    for (int k = 0; k < 100; ++k) {
        const double angle = 0.5 * (low + high);
        if (tan(angle) - angle < involute) {
            low = angle;
        } else {
            high = angle;
        }
    }
    g.center_distance = radius * cos(transverse) / cos(low);
    const double cut = (g.center_distance - radius) / g.normal_module - shifts;
    for (int k = 0; k < 2; ++k) {
        g.tip_radius[k] = 0.5 * g.normal_module / cos(g.helix_angle) * g.teeth[k] +
                          g.normal_module * (0.95 + g.shift[k] + cut);
    }
    return g;
}

static elastic_deviation random_deviation(uint64_t *seed, const elastic_gear *g, double size) {
    elastic_deviation d = ideal;
    if (gm_test_integer(seed, 0, 3) > 0) {
        d.misalignment = gm_test_uniform(seed, -2.0, 2.0) * size;
        d.crowning = gm_test_uniform(seed, 0.0, 1.0) * size;
        d.wave = gm_test_uniform(seed, -0.3, 0.3) * size;
        d.wave_length = g->normal_module * gm_test_uniform(seed, 0.3, 3.0);
        d.relief = gm_test_uniform(seed, 0.0, 1.0) * size;
        d.from = g->path_start + 0.7 * (g->path_end - g->path_start);
        d.to = g->path_end;
        for (int k = 0; k < 3; ++k) {
            d.of_line[k] = gm_test_uniform(seed, -0.5, 0.5) * size;
        }
    }
    return d;
}

/* 500 random gears: the same forces, energies and shares by full compliance and active set. */
static void forces_are_those_of_full_compliance(void) {
    uint64_t seed = 17;
    int done = 0, with_deviation = 0, rings = 0;
    for (int k = 0; done < 500 && k < 1500; ++k) {
        const elastic_gear drawn = random_gear(&seed, k % 5 == 4);
        elastic_case c;
        if (elastic_case_make(&c, &drawn, 8) != GM_OK) {
            elastic_case_free(&c);
            continue;
        }

        /* A place on the path, deviations, and every third time teeth of their own softness. */
        const double size = drawn.normal_module * pow(10.0, gm_test_uniform(&seed, -4.0, -2.3));
        const elastic_deviation d = random_deviation(&seed, &c.gear, size);
        const double x = size * gm_test_uniform(&seed, 0.05, 3.0);
        const double o = c.gear.path_start + gm_test_uniform(&seed, 0.0, 1.0) * c.gear.pitch;

        double drawn_softness[2][3];
        const double(*softness)[3] = (const double(*)[3])drawn_softness;
        for (int i = 0; i < 6; ++i) {
            drawn_softness[i / 3][i % 3] = k % 3 == 0 ? gm_test_uniform(&seed, 0.9, 3.0) : 1.0;
        }

        gmi_elastic_lines_at at = elastic_lines_at(&c.gear, o);
        double soft[2][GMI_ELASTIC_LINES_MAX];
        for (int i = 0; i <= at.last - at.first; ++i) {
            soft[0][i] = softness[0][(((at.first + i) % 3) + 3) % 3];
            soft[1][i] = softness[1][(((at.first + i) % 3) + 3) % 3];
        }
        at.pinion_softness = soft[0];
        at.wheel_softness = soft[1];

        gm_test_context("gear %d: %g/%g teeth, helix %g deg, %d stations, x %g", k, drawn.teeth[0],
                        drawn.teeth[1], drawn.helix_angle / degree, drawn.stations, x);
        elastic_answer exact;
        const gmi_elastic_result got = elastic_solve_at(&c, &at, &d, x, 0);
        GM_ASSERT(elastic_model_solve(&c.gear, &d, softness, 0.0, NULL, o, x, &exact));

        /* Tables of the teeth: mostly 1e-7, more where the line of action passes the end of a fillet, as of many rings. */
        const double scale = (double)exact.force;
        const double accuracy = drawn.teeth[1] > 0.0 ? 1e-6 : 2e-5;
        GM_ASSERT_REL(got.force, (double)exact.force, accuracy);
        GM_ASSERT_REL(got.energy, (double)exact.energy, accuracy);

        GM_ASSERT_INT(c.work.count, exact.lines);
        for (int i = 0; i < c.work.count && i < exact.lines; ++i) {
            for (int j = 0; j < exact.lines; ++j) {
                if (exact.index[j] == c.work.line[i].index) {
                    GM_ASSERT_NEAR(got.line_force[i], (double)exact.line_force[j], accuracy,
                                   accuracy * scale);
                }
            }
        }

        with_deviation += d.crowning > 0.0 && exact.force > 0.0L;
        rings += drawn.teeth[1] < 0.0;
        ++done;
        elastic_case_free(&c);
    }
    gm_test_context("%s", "");
    GM_ASSERT_INT(done, 500);
    GM_ASSERT(with_deviation > 200);
    GM_ASSERT(rings > 60);
}

/* The same gears to the public interface, without backlash. */
static gm_pair_params drawing_of(const elastic_gear *g) {
    gm_pair_params p;
    gm_pair_params_default(&p);
    p.pinion_teeth = (int)g->teeth[0];
    p.wheel_teeth = (int)g->teeth[1];
    p.normal_module = g->normal_module;
    p.normal_pressure_angle = g->pressure_angle;
    p.helix_angle = g->helix_angle;
    p.face_width = g->face_width;
    p.center_distance = fabs(g->center_distance);
    p.pinion_profile_shift = g->shift[0];
    p.wheel_profile_shift = g->shift[1];
    p.pinion_tip_radius = fabs(g->tip_radius[0]);
    p.wheel_tip_radius = fabs(g->tip_radius[1]);
    p.pinion_rack_dedendum = p.wheel_rack_dedendum = g->dedendum;
    p.pinion_rack_fillet_radius = p.wheel_rack_fillet_radius = g->fillet_radius;
    return p;
}

/* Such a mesh with its workspace. */
typedef struct mesh_case {
    gm_pair pair;
    gm_mesh *mesh;
    gm_workspace *workspace;
    void *memory, *workspace_memory;
} mesh_case;

static void mesh_case_free(mesh_case *c) {
    free(c->memory);
    free(c->workspace_memory);
}

/* 0 where these gears are none, or have no elastic teeth. flanks: of the pinion; NULL = ideal. To be freed in any case. */
static int mesh_case_make(mesh_case *c, const elastic_gear *g, gm_mesh_params law,
                          const gm_flanks *flanks) {
    const gm_pair_params drawing = drawing_of(g);
    memset(c, 0, sizeof *c);
    law.law = GM_LAW_ELASTIC;
    law.pinion_youngs_modulus = g->youngs_modulus[0];
    law.wheel_youngs_modulus = g->youngs_modulus[1];
    law.pinion_poisson_ratio = g->poisson_ratio[0];
    law.wheel_poisson_ratio = g->poisson_ratio[1];

    const int is_pair = gm_pair_init(&c->pair, &drawing) == GM_OK;
    const size_t size = is_pair ? gm_mesh_size(&law, &c->pair) : 0;
    c->memory = malloc(size + 1);
    if (size == 0 || g->path_start < 0.1 * g->pitch ||
        gm_mesh_init(&c->mesh, &law, &c->pair, flanks, NULL, c->memory, size) != GM_OK) {
        return 0;
    }
    const size_t room = gm_workspace_size(c->mesh);
    c->workspace_memory = malloc(room);
    GM_ASSERT_INT(gm_workspace_init(&c->workspace, c->mesh, c->workspace_memory, room), GM_OK);
    return 1;
}

/* Tooth 0 touches at o in z = 0, pressed by x. */
static gm_mesh_result mesh_case_press(const mesh_case *c, double o, double x, int wanted) {
    const gm_pair *pair = &c->pair;
    gm_state state = {0};
    state.pinion_angle = (o - pair->phase_origin[GM_DRIVE]) / pair->pinion.base_radius;
    state.wheel_angle = (pair->pinion.base_radius * state.pinion_angle - x - 0.5 * pair->backlash) /
                        pair->wheel.base_radius;
    gm_mesh_result r;
    GM_ASSERT_INT(gm_mesh_evaluate(c->mesh, &state, wanted, c->workspace, &r), GM_OK);
    return r;
}

/* Cuts beyond the path: by 0.85 of the roll that opens the gap to x = 10 q / E at 100 N/mm. */
static void find_cuts(const elastic_gear *g, double cut[2]) {
    for (int of = 0; of < 2; ++of) {
        const double r_b = g->base_radius[1 - of], radius = g->tip_radius[1 - of];
        const double tip = copysign(sqrt((radius - r_b) * (radius + r_b)), r_b);
        const double curvature = tip * g->line_of_action / (r_b * r_b * (g->line_of_action - tip));
        const double approach =
            5.0 * 1e5 * (1.0 / g->youngs_modulus[0] + 1.0 / g->youngs_modulus[1]);
        cut[of] = 0.85 * sqrt(2.0 * approach / curvature);
    }
}

/* Tip edges of random gears through the mesh: force, and the work of the roll, by full compliance and a search for the gap. */
static void edges_are_those_of_full_compliance(void) {
    uint64_t seed = 71;
    int done = 0, rings = 0, edged = 0;
    for (int k = 0; done < 60 && k < 240; ++k) {
        elastic_gear g = random_gear(&seed, k % 5 == 4);
        g.stations = g.stations < 4 ? 4 : g.stations;
        gm_mesh_params law;
        gm_mesh_params_default(&law);
        law.stations = g.stations;
        law.tip_rounding = gm_test_uniform(&seed, 0.02, 0.3);
        const double x = g.normal_module * pow(10.0, gm_test_uniform(&seed, -3.5, -2.0));
        const double xi = gm_test_uniform(&seed, 0.0, 1.0);
        elastic_gear_derive(&g);
        mesh_case c;
        if (!mesh_case_make(&c, &g, law, NULL)) {
            mesh_case_free(&c);
            continue;
        }
        gm_test_context("gear %d: %g/%g teeth, helix %g deg, %d stations, x %g", k, g.teeth[0],
                        g.teeth[1], g.helix_angle / degree, g.stations, x);
        const double o = g.path_start + xi * g.pitch;
        const gm_mesh_result r = mesh_case_press(&c, o, x, GM_WANT_FORCE);

        double cut[2];
        find_cuts(&g, cut);
        elastic_answer exact, beside[2], without;
        GM_ASSERT(elastic_model_solve(&g, &ideal, NULL, law.tip_rounding, cut, o, x, &exact));
        GM_ASSERT_REL(r.drive_force, (double)exact.force, 1e-6);
        const double step = 1e-6 * g.normal_module;
        for (int side = 0; side < 2; ++side) {
            GM_ASSERT(elastic_model_solve(&g, &ideal, NULL, law.tip_rounding, cut,
                                          o + (side == 0 ? -step : step), x, &beside[side]));
        }
        const double rolled = (double)((beside[1].energy - beside[0].energy) / (2.0L * step));
        GM_ASSERT_ABS(r.pinion_torque / c.pair.pinion.base_radius - r.drive_force, rolled,
                      1e-6 * r.drive_force + 1e-5 * fabs(rolled));

        /* Edges that make a difference. */
        GM_ASSERT(elastic_model_solve(&g, &ideal, NULL, 0.0, NULL, o, x, &without));
        edged += fabsl(exact.force - without.force) > 1e-3L * exact.force;
        rings += g.teeth[1] < 0.0;
        ++done;
        mesh_case_free(&c);
    }
    gm_test_context("%s", "");
    GM_ASSERT_INT(done, 60);
    GM_ASSERT(edged > 30 && rings > 3);
}

/* A crowned pinion, both flanks: a parabola by so many chords that they leave 1e-5 of it. */
static gm_flanks *make_crowned(int teeth, double crowning) {
    enum { NODES = 401 };
    static double table[NODES][2];
    for (int k = 0; k < NODES; ++k) {
        const double u = 2.0 * k / (NODES - 1) - 1.0;
        table[k][0] = table[k][1] = -crowning * u * u;
    }
    const gm_flanks_params sizes = {teeth, 1, NODES, 2, 1, NODES, 2};
    const size_t size = gm_flanks_size(&sizes);
    gm_flanks *flanks;
    GM_ASSERT_INT(gm_flanks_init(&flanks, &sizes, malloc(size), size), GM_OK);
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        GM_ASSERT_INT(gm_flanks_set_table(flanks, side, GM_ALL_TEETH, &table[0][0], 1.0), GM_OK);
    }
    return flanks;
}

/*
 * The stations that a mesh takes by itself leave 0.4 % of the transmission error at every position: what x would have to
 * change for the force of full compliance with three times as many elements, 96 at most. Of an error that falls with h^2
 * those still have a ninth or more. Wide, narrow, spur, rings and crowned ones, with edges and without.
 */
static void stations_of_the_default_leave_0_4_percent(void) {
    uint64_t seed = 5;
    int done = 0, more = 0;
    double largest = 0.0;
    for (int k = 0; done < 15 && k < 150; ++k) {
        elastic_gear g = random_gear(&seed, done % 5 == 3);
        const int is_wide = done % 5 < 2;
        g.face_width = g.normal_module * (is_wide ? gm_test_uniform(&seed, 15.0, 35.0)
                                                  : gm_test_uniform(&seed, 3.0, 15.0));
        g.helix_angle = is_wide && g.helix_angle == 0.0 ? 30.0 * degree : g.helix_angle;
        elastic_gear_derive(&g);
        const double x = g.normal_module * pow(10.0, gm_test_uniform(&seed, -3.3, -2.3));
        elastic_deviation crowned = ideal;
        crowned.crowning = done % 5 == 4 ? x * gm_test_uniform(&seed, 0.2, 1.0) : 0.0;
        gm_mesh_params law;
        gm_mesh_params_default(&law);
        law.corner_contact = done % 2 == 0 ? GM_CORNER_ON : GM_CORNER_OFF;
        gm_flanks *flanks = make_crowned((int)g.teeth[0], crowned.crowning);
        mesh_case c;
        if (!mesh_case_make(&c, &g, law, flanks)) {
            mesh_case_free(&c);
            free(flanks);
            continue;
        }

        const int stations = gm_elastic_stations(&c.pair);
        g.stations = 3 * stations - 2 < 97 ? 3 * stations - 2 : 97;
        more += stations > 17;
        double cut[2];
        find_cuts(&g, cut);
        for (int position = 0; position < 2; ++position) {
            gm_test_context("gear %d: %g/%g teeth, helix %g deg, face %g modules, %d stations", k,
                            g.teeth[0], g.teeth[1], g.helix_angle / degree,
                            g.face_width / g.normal_module, stations);
            const double o =
                g.path_start + (position + gm_test_uniform(&seed, 0.0, 1.0)) * g.pitch / 2.0;
            const gm_mesh_result r = mesh_case_press(&c, o, x, GM_WANT_FORCE | GM_WANT_DERIVATIVES);
            const double stiffness = -r.force_by.wheel_angle / c.pair.wheel.base_radius;
            elastic_answer fine;
            GM_ASSERT(elastic_model_solve(
                &g, &crowned, NULL, done % 2 == 0 ? law.tip_rounding : 0.0, cut, o, x, &fine));
            const double ratio = (stations - 1.0) / (g.stations - 1.0);
            const double error = (r.force - (double)fine.force) / (stiffness * x);
            GM_ASSERT_ABS(error, 0.0, 0.004 * (1.0 - ratio * ratio));
            largest = fmax(largest, fabs(error));
        }
        ++done;
        mesh_case_free(&c);
        free(flanks);
    }
    gm_test_context("%s", "");
    GM_ASSERT_INT(done, 15);
    GM_ASSERT(more > 2);

    /* And no more of them than that needs. */
    GM_ASSERT(largest > 0.001);
}

/* ---------------------------------------------------------------------------------------------
 * Energy and derivatives
 * ------------------------------------------------------------------------------------------- */

/* Everything that a derivative can be taken by. */
enum { BY_APPROACH, BY_ROLL, BY_LOWER, BY_UPPER, BY_ACTION, PARAMETERS };

typedef struct probe {
    double force, energy, moment;
} probe;

static probe probe_at(elastic_case *c, const elastic_deviation *d, double o, double x,
                      const double change[PARAMETERS]) {
    gmi_elastic_lines_at at = elastic_lines_at(&c->gear, o);
    at.origin += change[BY_ROLL];
    at.lower += change[BY_LOWER];
    at.upper += change[BY_UPPER];
    at.line_of_action += change[BY_ACTION];
    /* From undeformed teeth, then once more: Newton's last digits. */
    (void)elastic_solve_at(c, &at, d, x + change[BY_APPROACH], 0);
    const gmi_elastic_result result = elastic_solve_at(c, &at, d, x + change[BY_APPROACH], 1);
    probe values = {result.force, result.energy, 0.0};
    for (int p = 0; p < 2 * c->work.slots; ++p) {
        values.moment += c->work.force[p] * c->work.z[p] * c->work.roll[p];
    }
    return values;
}

static double entry(const gmi_elastic_gradient *g, int parameter) {
    const double entries[PARAMETERS] = {g->by_approach, g->by_roll, g->by_lower, g->by_upper,
                                        g->by_action};
    return entries[parameter];
}

/* Force, energy, and a moment that depends on both places, by all parameters. */
static void derivatives_are_those_of_differences(void) {
    uint64_t seed = 23;
    for (int k = 0; k < 66; ++k) {
        elastic_case c;
        make(&c, k % KINDS, k % 2 == 0 ? 17 : 9);
        const double size = 2e-3 * c.gear.normal_module;
        const elastic_deviation d = random_deviation(&seed, &c.gear, size);

        /* The last ones on the straight part of the contact law, under loads that no gear bears. */
        const double x = size * (k < 60 ? gm_test_uniform(&seed, 0.5, 3.0) : 300.0);
        const double o = c.gear.path_start + gm_test_uniform(&seed, 0.0, 1.0) * c.gear.pitch;
        const double none[PARAMETERS] = {0.0};
        const probe here = probe_at(&c, &d, o, x, none);

        gmi_elastic_gradient force, energy, moment;
        gmi_elastic_differentiate(&c.law, &c.work, &force, &energy);
        double *factors = calloc(8 * (size_t)c.work.slots, sizeof *factors);
        const int n = 2 * c.work.slots;
        for (int p = 0; p < n; ++p) {
            factors[p] = c.work.z[p] * c.work.roll[p];
            factors[n + p] = c.work.z[p];
            factors[2 * n + p] = c.work.roll[p];
        }
        const gmi_elastic_functional functional = {factors, factors + n, factors + 2 * n, NULL};
        gmi_elastic_differentiate_functional(&c.law, &c.work, &functional, factors + 3 * n,
                                             &moment);
        GM_ASSERT_REL(moment.value, here.moment, 1e-12);
        GM_ASSERT_REL(force.value, here.force, 1e-12);
        GM_ASSERT_REL(energy.by_approach, here.force, 1e-12);
        GM_ASSERT_REL(energy.value, here.energy, 1e-12);

        for (int i = 0; i < PARAMETERS; ++i) {
            double up[PARAMETERS] = {0.0}, down[PARAMETERS] = {0.0};
            const double step = i == BY_APPROACH ? 1e-4 * x : 2e-6 * c.gear.normal_module;
            up[i] = step;
            down[i] = -step;
            const probe above = probe_at(&c, &d, o, x, up), below = probe_at(&c, &d, o, x, down);
            /* Differences lose what a step loses: 1e-12 of the value over the step. */
            const double lost = 2e-12 / step;
            gm_test_context("case %d, parameter %d", k, i);
            GM_ASSERT_NEAR(entry(&force, i), (above.force - below.force) / (2.0 * step), 2e-6,
                           lost * here.force + 1e-8 * fabs(force.by_approach) * (i == BY_APPROACH));
            GM_ASSERT_NEAR(entry(&energy, i), (above.energy - below.energy) / (2.0 * step), 2e-6,
                           lost * here.energy);
            GM_ASSERT_NEAR(entry(&moment, i), (above.moment - below.moment) / (2.0 * step), 2e-6,
                           lost * fabs(here.moment) +
                               1e-8 * fabs(moment.by_approach) * (i == BY_APPROACH));
        }
        free(factors);
        elastic_case_free(&c);
    }
}

/* By the deviation of each point, which makes all of them. */
static void deviation_of_a_point_counts_as_it_says(void) {
    elastic_case c;
    make(&c, 1, 9);
    const double x = 5e-6, o = c.gear.path_start + 0.3 * c.gear.pitch;
    const gmi_elastic_lines_at at = elastic_lines_at(&c.gear, o);
    gmi_elastic_result result = elastic_solve_at(&c, &at, &ideal, x, 0);
    result = elastic_solve_at(&c, &at, &ideal, x, 1);
    double by_deviation[300], sum = 0.0;
    const int n = 2 * c.work.slots;
    GM_ASSERT(n <= 300);
    for (int p = 0; p < n; ++p) {
        by_deviation[p] = c.work.by_deviation[p];
        sum += by_deviation[p];
    }
    GM_ASSERT_REL(sum, result.by_approach, 1e-12);
    const double step = 1e-9;
    for (int p = 0; p < n; ++p) {
        double force[2];
        for (int side = 0; side < 2; ++side) {
            gmi_elastic_work_reset(&c.work);
            for (int again = 0; again < 2; ++again) {
                GM_ASSERT_INT(gmi_elastic_place(&c.law, &at, &c.work), GM_OK);
                elastic_fill(&c.gear, &ideal, &c.work);
                c.work.deviation[p] += side == 0 ? step : -step;
                GM_ASSERT_INT(gmi_elastic_solve(&c.law, &c.work, x, &result), GM_OK);
            }
            force[side] = result.force;
        }
        GM_ASSERT_NEAR((force[0] - force[1]) / (2.0 * step), by_deviation[p], 1e-6,
                       2e-12 * result.force / step);
    }
    elastic_case_free(&c);
}

static int ascending(const void *a, const void *b) {
    const double first = *(const double *)a, second = *(const double *)b;
    return (first > second) - (first < second);
}

/* Work of the torques over a mesh cycle at constant x: as much goes in as comes out. Between two places at which an end of a
 * line passes a station all is smooth, so that Gauss' rule leaves next to nothing. */
static void energy_is_kept_over_a_mesh_cycle(void) {
    enum { PIECES = 64 }; /* of the cycle at least, for the cells of the tables */
    static const double place[5] = {0.0469100770306680, 0.2307653449471585, 0.5, 0.7692346550528415,
                                    0.9530899229693320};
    static const double weight[5] = {0.1184634425280945, 0.2393143352496832, 0.2844444444444444,
                                     0.2393143352496832, 0.1184634425280945};
    for (int kind = 1; kind < KINDS; ++kind) { /* helical: continuous */
        elastic_case c;
        make(&c, kind, 17);

        /* Smooth from event to event: where a station enters or leaves, and where cells of the tables end. */
        double events[2 * 17 + PIECES + 1];
        int count = 0;
        for (int k = 0; k <= PIECES; ++k) {
            events[count++] = (double)k / PIECES;
        }
        for (int k = 0; k < 17; ++k) {
            const double rise = tan(c.gear.base_helix_angle) * c.law.spacing * k;
            const double upper = (c.gear.path_end - c.gear.path_start - rise) / c.gear.pitch;
            events[count++] = -rise / c.gear.pitch - floor(-rise / c.gear.pitch);
            events[count++] = upper - floor(upper);
        }

        qsort(events, (size_t)count, sizeof *events, ascending);
        const double x = 2e-3 * c.gear.normal_module;
        double sum = 0.0, mean = 0.0;

        /* Gauss's rule of five points between them. */
        for (int k = 0; k + 1 < count; ++k) {
            const double length = events[k + 1] - events[k];
            for (int i = 0; i < 5 && length > 1e-12; ++i) {
                const double xi = events[k] + place[i] * length;

                const gmi_elastic_lines_at at =
                    elastic_lines_at(&c.gear, c.gear.path_start + xi * c.gear.pitch);
                gmi_elastic_gradient force, energy;
                (void)elastic_solve_at(&c, &at, &ideal, x, 1);
                gmi_elastic_differentiate(&c.law, &c.work, &force, &energy);

                sum += weight[i] * length * energy.by_roll;
                mean += weight[i] * length * force.value;
            }
        }

        gm_test_context("kind %d", kind);
        GM_ASSERT_ABS(sum, 0.0, 1e-10 * mean);
        elastic_case_free(&c);
    }
}

/* Between two places U changes by the work of U_o, to the error of Gauss' rule on a smooth piece. */
static void energy_changes_by_the_work_done(void) {
    static const double place[3] = {0.1127016653792583, 0.5, 0.8872983346207417};
    static const double weight[3] = {0.2777777777777778, 0.4444444444444444, 0.2777777777777778};
    for (int kind = 0; kind < KINDS; ++kind) {
        elastic_case c;
        make(&c, kind, 17);
        const double x = 2e-3 * c.gear.normal_module, h = 5e-3 * c.gear.pitch;
        const double from = c.gear.path_start + 0.403 * c.gear.pitch;
        gmi_elastic_lines_at at = elastic_lines_at(&c.gear, from);
        const double first = elastic_solve_at(&c, &at, &ideal, x, 0).energy;
        double work = 0.0;
        for (int k = 0; k < 3; ++k) {
            gmi_elastic_gradient force, energy;
            at = elastic_lines_at(&c.gear, from + place[k] * h);
            (void)elastic_solve_at(&c, &at, &ideal, x, 1);
            gmi_elastic_differentiate(&c.law, &c.work, &force, &energy);
            work += h * weight[k] * energy.by_roll;
        }
        at = elastic_lines_at(&c.gear, from + h);
        const double last = elastic_solve_at(&c, &at, &ideal, x, 1).energy;
        gm_test_context("kind %d", kind);
        GM_ASSERT_ABS(last - first, work, 1e-10 * first);
        elastic_case_free(&c);
    }
}

/* ---------------------------------------------------------------------------------------------
 * Start, limits, symmetry
 * ------------------------------------------------------------------------------------------- */

/* The answer does not depend on what was solved before: jumps, other teeth, loss of contact. */
static void warm_start_gives_the_cold_answer(void) {
    uint64_t seed = 29;
    for (int kind = 0; kind < 3; ++kind) {
        elastic_case warm, cold;
        make(&warm, kind, 17);
        make(&cold, kind, 17);

        const double size = 2e-3 * warm.gear.normal_module;
        elastic_deviation d = random_deviation(&seed, &warm.gear, size);
        double o = warm.gear.path_start, x = size;
        int tooth = 0;
        for (int k = 0; k < 600; ++k) {
            /* Small steps, and now and then a leap or other flanks. */
            if (k % 40 == 0) {
                o += gm_test_uniform(&seed, -3.0, 3.0) * warm.gear.pitch;
                x = size * gm_test_uniform(&seed, -1.0, 3.0);
            }
            if (k % 97 == 0) {
                d = random_deviation(&seed, &warm.gear, size);
            }

            o += gm_test_uniform(&seed, -0.02, 0.05) * warm.gear.pitch;
            x += gm_test_uniform(&seed, -0.05, 0.05) * size;

            /* Line 0 may be any: the workspace follows the teeth by their numbers. */
            const int skipped = gm_test_integer(&seed, -1, 1);
            gmi_elastic_lines_at at = elastic_lines_at(&warm.gear, o + skipped * warm.gear.pitch);
            at.tooth = (((at.tooth + skipped + tooth) % at.teeth) + at.teeth) % at.teeth;
            elastic_deviation shifted = d;
            for (int i = 0; i < 3; ++i) {
                shifted.of_line[i] = d.of_line[(i + skipped + 3) % 3];
            }

            const gmi_elastic_result got = elastic_solve_at(&warm, &at, &shifted, x, 1);
            const gmi_elastic_result expected = elastic_solve_at(&cold, &at, &shifted, x, 0);
            gm_test_context("kind %d, step %d", kind, k);
            GM_ASSERT_REL(got.force, expected.force, 2e-9);
            GM_ASSERT_REL(got.energy, expected.energy, 2e-9);
            GM_ASSERT_REL(got.by_approach, expected.by_approach, 1e-4);
            GM_ASSERT(got.iterations <= 10);
        }
        elastic_case_free(&warm);
        elastic_case_free(&cold);
    }
}

/* Where only sums are wanted, one step is mostly enough as lines roll on, and leaves what undeformed teeth lead to. */
static void sums_of_one_step_are_those_of_undeformed_teeth(void) {
    uint64_t seed = 31;
    for (int kind = 0; kind < 3; ++kind) {
        elastic_case warm, cold;
        make(&warm, kind, 17);
        make(&cold, kind, 17);
        warm.work.sums_alone = 1;

        const double size = 2e-3 * warm.gear.normal_module;
        const elastic_deviation d = random_deviation(&seed, &warm.gear, 0.1 * size);
        double o = warm.gear.path_start, x = size;
        int single = 0, count = 0;
        for (int k = 0; k < 600; ++k) {
            o += gm_test_uniform(&seed, 0.002, 0.01) * warm.gear.pitch;
            x += k % 5 == 0 ? 0.0 : gm_test_uniform(&seed, -0.02, 0.02) * size;
            const gmi_elastic_lines_at at = elastic_lines_at(&warm.gear, o);
            const gmi_elastic_result got = elastic_solve_at(&warm, &at, &d, x, 1);
            const gmi_elastic_result expected = elastic_solve_at(&cold, &at, &d, x, 0);
            gmi_elastic_gradient force[2], energy[2];
            gmi_elastic_differentiate(&warm.law, &warm.work, &force[0], &energy[0]);
            gmi_elastic_differentiate(&cold.law, &cold.work, &force[1], &energy[1]);

            gm_test_context("kind %d, step %d", kind, k);
            GM_ASSERT_REL(got.force, expected.force, 8e-9);
            GM_ASSERT_REL(got.energy, expected.energy, 2e-9);
            GM_ASSERT_REL(got.by_approach, expected.by_approach, 5e-6);
            GM_ASSERT_ABS(force[0].by_roll, force[1].by_roll, 2e-7 * expected.by_approach);
            GM_ASSERT_ABS(energy[0].by_roll, energy[1].by_roll, 2e-8 * expected.force);
            single += got.iterations == 1;
            ++count;
        }
        GM_ASSERT(single > 0.7 * count);
        elastic_case_free(&warm);
        elastic_case_free(&cold);
    }
}

/* The last solution goes with its teeth when the lines are counted from another one: no more steps there than elsewhere. */
static void teeth_are_followed_over_many_pitches(void) {
    for (int hand = -1; hand <= 1; hand += 2) {
        elastic_gear gear = gear_of(1);
        elastic_case c;
        gear.helix_angle *= hand;
        GM_ASSERT_INT(elastic_case_make(&c, &gear, 8), GM_OK);
        for (int k = 0; k < 4000; ++k) {
            const double turns = -0.2 + k / 400.0; /* ten pitches onwards */
            const double whole = floor(turns);
            const double o = c.gear.path_start + (turns - whole) * c.gear.pitch;
            gmi_elastic_lines_at at = elastic_lines_at(&c.gear, o);
            at.tooth = (((at.tooth - (int)whole) % at.teeth) + at.teeth) % at.teeth;
            const gmi_elastic_result result = elastic_solve_at(&c, &at, &ideal, 4e-6, k > 0);
            gm_test_context("hand %d, position %d", hand, k);
            GM_ASSERT(k < 3 || result.iterations <= 2);
        }
        elastic_case_free(&c);
    }
}

/* Teeth that come back from a flight: the last solution, elsewhere and under another load, tells nothing of the touch. */
static void touch_after_a_flight_needs_few_steps(void) {
    uint64_t seed = 32;
    for (int kind = 0; kind < 3; ++kind) {
        elastic_case warm, cold;
        make(&warm, kind, 5);
        make(&cold, kind, 5);
        warm.work.sums_alone = 1;
        double o = warm.gear.path_start;
        for (int k = 0; k < 3000; ++k) {
            const int returns = k % 4 == 3;
            const double least = returns ? -7.0 : -3.0, most = returns ? -2.0 : -2.5;
            const double x =
                warm.gear.normal_module * pow(10.0, gm_test_uniform(&seed, least, most));
            o += (returns ? gm_test_uniform(&seed, -0.3, 0.3) : 0.02) * warm.gear.pitch;
            o = o > warm.gear.path_start + warm.gear.pitch || o < warm.gear.path_start
                    ? warm.gear.path_start + gm_test_uniform(&seed, 0.0, 0.5) * warm.gear.pitch
                    : o;
            const gmi_elastic_lines_at at = elastic_lines_at(&warm.gear, o);
            const gmi_elastic_result got = elastic_solve_at(&warm, &at, &ideal, x, 1);
            const gmi_elastic_result expected = elastic_solve_at(&cold, &at, &ideal, x, 0);

            gm_test_context("kind %d, state %d, x %g", kind, k, x);
            GM_ASSERT(got.iterations <= 12);
            GM_ASSERT_REL(got.force, expected.force, 2e-8);
        }
        elastic_case_free(&warm);
        elastic_case_free(&cold);
    }
}

/* From undeformed teeth, from 1 nm to 1 mm: few steps, no failure, and all finite. */
static void cold_start_needs_few_steps(void) {
    for (int kind = 0; kind < 3; ++kind) {
        elastic_case c;
        make(&c, kind, 17);
        for (double x = 1e-9; x <= 1.001e-3; x *= 1.7) {
            const gmi_elastic_lines_at at = elastic_lines_at(&c.gear, middle_of(&c));
            const gmi_elastic_result result = elastic_solve_at(&c, &at, &ideal, x, 0);
            gm_test_context("kind %d, x %g", kind, x);
            GM_ASSERT(result.iterations <= 7);
            GM_ASSERT(isfinite(result.force) && result.force > 0.0);
        }
        elastic_case_free(&c);
    }
}

static void nothing_touches_without_approach(void) {
    elastic_case c;
    make(&c, 1, 17);
    const gmi_elastic_lines_at at = elastic_lines_at(&c.gear, middle_of(&c));
    gmi_elastic_gradient force, energy;
    for (int warm = 0; warm < 2; ++warm) {
        if (warm) {
            (void)elastic_solve_at(&c, &at, &ideal, 5e-6, 0);
        }
        const gmi_elastic_result result = elastic_solve_at(&c, &at, &ideal, -1e-7, warm);
        GM_ASSERT(result.force == 0.0 && result.energy == 0.0 && result.by_approach == 0.0);
        gmi_elastic_differentiate(&c.law, &c.work, &force, &energy);
        GM_ASSERT(force.by_roll == 0.0 && energy.by_roll == 0.0 && force.by_approach == 0.0);
    }
    elastic_case_free(&c);
}

/* Teeth much stiffer than their contacts: the contact law of each pair alone. */
static void rigid_teeth_leave_the_contact_law(void) {
    elastic_case c;
    make(&c, 0, 17);
    const double stiff = 1e-7;
    for (int g = 0; g < 2; ++g) {
        for (int k = 0; k < GMI_ELASTIC_CELLS + 2; ++k) {
            for (int i = 0; i < 4; ++i) {
                c.law.gear[g].cell[k].value[i][0] *= stiff;
            }
        }
    }
    c.law.rim_compliance *= stiff;
    for (int k = 0; k < 17; ++k) {
        c.law.rim.diagonal[k] /= stiff;
        c.law.rim.beside[k] /= stiff;
        c.law.rim.left[k] /= stiff;
        c.law.rim.right[k] /= stiff;
    }
    const double x = 2e-6, o = middle_of(&c);
    const gmi_elastic_lines_at at = elastic_lines_at(&c.gear, o);
    const gmi_elastic_result result = elastic_solve_at(&c, &at, &ideal, x, 0);
    double expected = 0.0;
    for (int p = 0; p < 2 * c.work.slots; ++p) {
        gmi_hertz_state state;
        gmi_hertz_evaluate(c.law.hertz_compliance, c.work.rate[p], x, &state);
        expected += c.work.weight[p] * state.load;
    }
    GM_ASSERT_REL(result.force, expected, 1e-5);
    elastic_case_free(&c);
}

/* A spur pair alone, evenly loaded, deflects evenly: a spring and its contact in series, and as many stations as one likes. */
static void even_load_deflects_evenly(void) {
    double forces[3];
    const int stations[3] = {2, 17, 97};
    for (int k = 0; k < 3; ++k) {
        elastic_case c;
        make(&c, 0, stations[k]);
        gmi_elastic_lines_at at = elastic_lines_at(&c.gear, middle_of(&c));
        at.tooth += (0 - at.first);
        at.first = at.last = 0; /* the others are kept apart */
        const double x = 3e-6;
        forces[k] = elastic_solve_at(&c, &at, &ideal, x, 0).force;
        const double q = c.work.load[0];
        for (int p = 0; p < 2 * c.work.slots; ++p) {
            const double s = c.work.tooth[p], r = sqrt(c.law.rim_compliance);
            gmi_hertz_state state;
            GM_ASSERT_REL(c.work.load[p], q, 1e-9);
            gmi_hertz_evaluate(c.law.hertz_compliance, c.work.rate[p], x - (s * s + r * r) * q,
                               &state);
            GM_ASSERT_REL(state.load, q, 1e-8);
        }
        elastic_case_free(&c);
    }
    GM_ASSERT_REL(forces[1], forces[0], 1e-10);
    GM_ASSERT_REL(forces[2], forces[0], 1e-10);
}

/* The same gear seen from its other face: lines climb the other way, and everything is mirrored. */
static void mirrored_face_gives_the_same(void) {
    for (int kind = 1; kind < 3; ++kind) {
        elastic_case right, left;
        make(&right, kind, 17);
        elastic_gear gear = right.gear;
        gear.helix_angle = -gear.helix_angle;
        GM_ASSERT_INT(elastic_case_make(&left, &gear, 8), GM_OK);
        const double o = right.gear.path_start + 0.3 * right.gear.pitch;
        const double rise = tan(right.gear.base_helix_angle) * right.gear.face_width;
        const double x = 2e-3 * gear.normal_module;
        elastic_deviation d = ideal;
        d.crowning = 0.3 * x;
        const gmi_elastic_lines_at at_right = elastic_lines_at(&right.gear, o);
        const gmi_elastic_lines_at at_left = elastic_lines_at(&left.gear, o + rise);
        const gmi_elastic_result first = elastic_solve_at(&right, &at_right, &d, x, 0);
        const gmi_elastic_result second = elastic_solve_at(&left, &at_left, &d, x, 0);
        gmi_elastic_gradient force[2], energy[2];
        gmi_elastic_differentiate(&right.law, &right.work, &force[0], &energy[0]);
        gmi_elastic_differentiate(&left.law, &left.work, &force[1], &energy[1]);
        GM_ASSERT_REL(second.force, first.force, 1e-9);
        GM_ASSERT_REL(second.energy, first.energy, 1e-9);
        GM_ASSERT_NEAR(force[1].by_roll, force[0].by_roll, 1e-6, 1e-9 * fabs(force[0].by_lower));
        GM_ASSERT_NEAR(energy[1].by_roll, energy[0].by_roll, 1e-6, 1e-9 * fabs(energy[0].by_lower));
        elastic_case_free(&right);
        elastic_case_free(&left);
    }
}

/* A cracked tooth carries less, its neighbours more, and the mesh is softer. */
static void soft_tooth_gives_its_load_away(void) {
    elastic_case c;
    make(&c, 0, 17);
    gmi_elastic_lines_at at = elastic_lines_at(&c.gear, c.gear.path_start + 0.4 * c.gear.pitch);
    const double x = 3e-6;
    const gmi_elastic_result whole = elastic_solve_at(&c, &at, &ideal, x, 0);
    GM_ASSERT_INT(c.work.count, 2);
    const double softness[2] = {1.0, 2.0};
    at.pinion_softness = softness;
    const gmi_elastic_result cracked = elastic_solve_at(&c, &at, &ideal, x, 0);
    GM_ASSERT(cracked.line_force[1] < 0.9 * whole.line_force[1]);
    GM_ASSERT(cracked.line_force[0] > whole.line_force[0]);
    GM_ASSERT(cracked.force < whole.force);
    const double stiff[2] = {1.0, 1e-3};
    at.pinion_softness = at.wheel_softness = stiff;
    GM_ASSERT_INT(gmi_elastic_place(&c.law, &at, &c.work), GM_ERR_PARAMETER);
    elastic_case_free(&c);
}

/* The table of the pair says what those of both gears say, with its slopes. */
static void table_of_the_pair_is_that_of_both_gears(void) {
    for (int kind = 0; kind < 3; ++kind) {
        elastic_case c;
        make(&c, kind, 17);
        for (int k = 0; k < 10; ++k) {
            const double x = 2e-3 * c.gear.normal_module;
            const double o = c.gear.path_start + (0.1 * k + 0.03) * c.gear.pitch;
            gmi_elastic_lines_at at = elastic_lines_at(&c.gear, o);
            gmi_elastic_gradient force[2], energy[2];
            gmi_elastic_result result[2];
            for (int i = 0; i < 2; ++i) {
                at.slopes = i + 1;
                result[i] = elastic_solve_at(&c, &at, &ideal, x, 0);
                gmi_elastic_differentiate(&c.law, &c.work, &force[i], &energy[i]);
            }
            gm_test_context("kind %d, place %d", kind, k);
            GM_ASSERT_REL(result[0].force, result[1].force, 1e-7);
            GM_ASSERT_REL(result[0].by_approach, result[1].by_approach, 1e-7);
            const double size = fabs(force[1].by_action) + fabs(force[1].by_lower);
            GM_ASSERT_ABS(force[0].by_roll, force[1].by_roll, 1e-4 * size);
            GM_ASSERT_ABS(energy[0].by_roll, energy[1].by_roll, 1e-6 * result[1].force);
            GM_ASSERT(force[0].by_action == 0.0 && force[1].by_action != 0.0);
        }
        elastic_case_free(&c);
    }
}

/* Tip radius of the pinion of a spur pair at which its teeth are as thick as that. */
static double tip_radius_of(const elastic_gear *g, double thickness) {
    const double alpha = g->pressure_angle;
    const double radius = 0.5 * g->normal_module * g->teeth[0];
    const double half_angle =
        (0.25 * GMI_PI + g->shift[0] * tan(alpha)) * g->normal_module / radius + tan(alpha) - alpha;
    double low = radius, high = 1.5 * radius;
    for (int k = 0; k < 100; ++k) {
        const double tip = 0.5 * (low + high);
        const double roll = tan(acos(radius * cos(alpha) / tip));
        if (2.0 * tip * (half_angle - roll + atan(roll)) > thickness) {
            low = tip;
        } else {
            high = tip;
        }
    }
    return low;
}

/* Largest relative error of the compliance in the pinion's table: its cubics against the tooth itself. */
static double error_of_table(const elastic_case *c) {
    const elastic_gear *g = &c->gear;
    const gmi_elastic_params params = elastic_params_of(g, 8);
    const gmi_tooth_params data = {g->teeth[0],
                                   g->normal_module,
                                   g->pressure_angle,
                                   g->shift[0],
                                   params.gear[0].normal_thickness,
                                   g->dedendum,
                                   g->fillet_radius,
                                   g->youngs_modulus[0],
                                   g->poisson_ratio[0]};
    gmi_tooth tooth;
    GM_ASSERT_INT(gmi_tooth_init(&tooth, &data), GMI_TOOTH_FINE);
    const gmi_elastic_gear *table = &c->law.gear[0];
    double largest = 0.0;
    for (int cell = 0; cell < GMI_ELASTIC_CELLS; ++cell) {
        for (int k = 0; k < 8; ++k) {
            const double t = (k + 0.5) / 8.0;
            gmi_tooth_load load;
            GM_ASSERT_INT(
                gmi_tooth_load_at(&tooth, table->start + (cell + t) / table->per_cell, &load),
                GMI_TOOTH_FINE);
            const gmi_elastic_cell *cubic = &table->cell[cell + 1];
            const double value =
                cubic->value[0][0] +
                t * (cubic->value[1][0] + t * (cubic->value[2][0] + t * cubic->value[3][0]));
            largest = fmax(largest, fabs(value / (load.bending + load.foundation) - 1.0));
        }
    }
    return largest;
}

/* Towards a point the compliance grows as a logarithm, which the cubics of the last cells follow less well. */
static void tables_are_as_near_as_tips_are_thick(void) {
    static const double rows[][2] = {
        {0.6, 1e-6}, {0.5, 2e-6}, {0.3, 3e-5}, {0.2, 1.3e-4}, {0.05, 5e-3}};
    for (int row = 0; row < (int)(sizeof rows / sizeof rows[0]); ++row) {
        elastic_gear g = gear_of(0);
        g.teeth[0] = 14.0;
        g.teeth[1] = 40.0;
        g.shift[0] = 0.5;
        g.center_distance = 55e-3;
        g.tip_radius[0] = tip_radius_of(&g, rows[row][0] * g.normal_module);
        g.tip_radius[1] = 42e-3;
        elastic_case c;
        GM_ASSERT_INT(elastic_case_make(&c, &g, 8), GM_OK);
        gm_test_context("%g modules at the tip", rows[row][0]);
        GM_ASSERT(error_of_table(&c) < rows[row][1]);
        elastic_case_free(&c);
    }
}

/* Next to a point the rate of the contact law stays between the values at the ends of the cell, and so above 0. */
static void pointed_tips_keep_their_contact_law(void) {
    elastic_gear g = gear_of(0);
    g.teeth[0] = 14.0;
    g.teeth[1] = 40.0;
    g.shift[0] = 0.5;
    g.center_distance = 55e-3;
    g.tip_radius[0] = tip_radius_of(&g, 0.01 * g.normal_module);
    g.tip_radius[1] = 42e-3;
    elastic_case c;
    GM_ASSERT_INT(elastic_case_make(&c, &g, 8), GM_OK);
    const gmi_elastic_gear *tables[] = {&c.law.gear[0], &c.law.pair};
    for (int k = 0; k < 2; ++k) {
        const gmi_elastic_cell *cubic = &tables[k]->cell[GMI_ELASTIC_CELLS];
        const double low = cubic->value[0][1];
        const double high = tables[k]->cell[GMI_ELASTIC_CELLS + 1].value[0][1];
        for (int step = 1; step < 32; ++step) {
            const double t = step / 32.0;
            const double rate =
                low + t * (cubic->value[1][1] + t * (cubic->value[2][1] + t * cubic->value[3][1]));
            gm_test_context("table %d, %g of the last cell", k, t);
            GM_ASSERT(low < rate && rate < high);
        }
    }
    elastic_case_free(&c);
}

/* What does not fit is refused. */
static void sizes_out_of_range_are_refused(void) {
    GM_ASSERT(gmi_elastic_work_size(1, 4, 0) == 0);
    GM_ASSERT(gmi_elastic_work_size(98, 4, 0) == 0);
    GM_ASSERT(gmi_elastic_work_size(17, 0, 0) == 0);
    GM_ASSERT(gmi_elastic_work_size(17, 13, 0) == 0);
    GM_ASSERT(gmi_elastic_work_size(17, 4, -1) == 0);
    GM_ASSERT(gmi_elastic_work_size(17, 4, 33) == 0);
    GM_ASSERT(gmi_elastic_work_size(97, 12, 0) > 0);
    GM_ASSERT(gmi_elastic_work_size(97, 12, 32) > gmi_elastic_work_size(97, 12, 0));
    elastic_gear gear = gear_of(1);
    elastic_case c;
    GM_ASSERT_INT(elastic_case_make(&c, &gear, 2), GM_OK);
    const gmi_elastic_lines_at at = elastic_lines_at(&c.gear, middle_of(&c));
    GM_ASSERT_INT(gmi_elastic_place(&c.law, &at, &c.work), GM_STATE_OUT_OF_RANGE);
    elastic_case_free(&c);
    gear.youngs_modulus[1] = 0.0;
    GM_ASSERT_INT(elastic_case_make(&c, &gear, 8), GM_ERR_PARAMETER);
    elastic_case_free(&c);
    gear = gear_of(1);
    gear.poisson_ratio[0] = 0.5;
    GM_ASSERT_INT(elastic_case_make(&c, &gear, 8), GM_ERR_PARAMETER);
    elastic_case_free(&c);

    /* Tips that reach below the fillet of the mate. */
    gear = gear_of(1);
    gear.tip_radius[1] += 0.8e-3;
    gear.tip_radius[0] += 0.8e-3;
    GM_ASSERT_INT(elastic_case_make(&c, &gear, 8), GM_ERR_GEOMETRY);
    elastic_case_free(&c);
}

/* Many lines at once: a wide face with a large helix angle, more than the specialised eliminations know. */
static void parameters_out_of_range_are_refused(void) {
    elastic_gear gear = gear_of(2);
    gear.stations = 9;
    elastic_gear_derive(&gear);
    const gmi_elastic_params good = elastic_params_of(&gear, 6);
    const double contact[2] = {good.gear[0].start_roll_length, good.gear[1].start_roll_length};
    const struct {
        size_t place;
        double value;
        int status;
    } wrong[] = {
        {offsetof(gmi_elastic_params, line_of_action), 0.0, GM_ERR_PARAMETER},
        {offsetof(gmi_elastic_params, gear[0].youngs_modulus), 0.0, GM_ERR_PARAMETER},
        {offsetof(gmi_elastic_params, gear[1].youngs_modulus), 1e16, GM_ERR_PARAMETER},
        {offsetof(gmi_elastic_params, gear[0].poisson_ratio), -0.1, GM_ERR_PARAMETER},
        {offsetof(gmi_elastic_params, gear[1].poisson_ratio), 0.5, GM_ERR_PARAMETER},
        {offsetof(gmi_elastic_params, gear[0].rack_dedendum), 0.0, GM_ERR_PARAMETER},
        {offsetof(gmi_elastic_params, gear[1].rack_fillet_radius), -0.1, GM_ERR_PARAMETER},
        {offsetof(gmi_elastic_params, gear[1].rack_fillet_radius), 1.3, GM_ERR_PARAMETER},
        {offsetof(gmi_elastic_params, gear[0].start_roll_length), -1e-3, GM_ERR_PARAMETER},
        {offsetof(gmi_elastic_params, gear[1].tip_roll_length), 0.0, GM_ERR_PARAMETER},
        {offsetof(gmi_elastic_params, gear[0].rack_fillet_radius), 1.0, GM_ERR_GEOMETRY},
        {offsetof(gmi_elastic_params, gear[0].tip_roll_length), 0.5, GM_ERR_GEOMETRY},
    };
    gmi_elastic law;
    int fault, wheel;
    GM_ASSERT_INT(gmi_elastic_init(&law, &good, contact, &fault, &wheel), GM_OK);
    for (size_t k = 0; k < sizeof wrong / sizeof wrong[0]; ++k) {
        gm_test_context("case %zu", k);
        gmi_elastic_params params = good;
        memcpy((char *)&params + wrong[k].place, &wrong[k].value, sizeof wrong[k].value);
        GM_ASSERT_INT(gmi_elastic_init(&law, &params, contact, &fault, &wheel), wrong[k].status);
        GM_ASSERT((fault == GMI_TOOTH_FINE) == (wrong[k].status == GM_ERR_PARAMETER));
    }

    /* Contact below the end of the fillet. */
    const double low[2] = {contact[0], 0.2 * contact[1]};
    GM_ASSERT_INT(gmi_elastic_init(&law, &good, low, &fault, &wheel), GM_ERR_GEOMETRY);
    GM_ASSERT_INT(fault, GMI_TOOTH_CONTACT);
    GM_ASSERT_INT(wheel, 1);
}

static void many_lines_are_no_other_case(void) {
    elastic_gear gear = gear_of(1);
    gear.face_width = 60e-3;
    gear.stations = 13;
    elastic_case c;
    GM_ASSERT_INT(elastic_case_make(&c, &gear, 12), GM_OK);
    for (int k = 0; k < 10; ++k) {
        const double o = c.gear.path_start - (5.0 + 0.1 * k) * c.gear.pitch;
        elastic_answer exact;
        gmi_elastic_lines_at at = elastic_lines_at(&c.gear, o);
        at.tooth = 0;
        const gmi_elastic_result got = elastic_solve_at(&c, &at, &ideal, 4e-6, k > 0);
        GM_ASSERT(c.work.count >= 7);
        GM_ASSERT(elastic_model_solve(&c.gear, &ideal, NULL, 0.0, NULL, o, 4e-6, &exact));
        GM_ASSERT_REL(got.force, (double)exact.force, 1e-7);
        GM_ASSERT_REL(got.energy, (double)exact.energy, 1e-7);
    }
    elastic_case_free(&c);
}

/* Error against many stations: what the specification states of 9, 17 and 25. */
static void stations_converge(void) {
    for (int kind = 0; kind < 3; ++kind) {
        double force[4];
        const int stations[4] = {9, 17, 25, 97};
        for (int k = 0; k < 4; ++k) {
            elastic_case c;
            make(&c, kind, stations[k]);
            const gmi_elastic_lines_at at =
                elastic_lines_at(&c.gear, c.gear.path_start + 0.45 * c.gear.pitch);
            elastic_deviation d = ideal;
            d.misalignment = 0.5e-3 * c.gear.normal_module;
            force[k] = elastic_solve_at(&c, &at, &d, 2e-3 * c.gear.normal_module, 0).force;
            elastic_case_free(&c);
        }
        gm_test_context("kind %d", kind);
        GM_ASSERT_REL(force[0], force[3], 1.5e-2);
        GM_ASSERT_REL(force[1], force[3], 4e-3);
        GM_ASSERT_REL(force[2], force[3], 1.8e-3);
    }
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {GM_TEST(forces_are_those_of_full_compliance),
                                    GM_TEST(edges_are_those_of_full_compliance),
                                    GM_TEST(stations_of_the_default_leave_0_4_percent),
                                    GM_TEST(derivatives_are_those_of_differences),
                                    GM_TEST(deviation_of_a_point_counts_as_it_says),
                                    GM_TEST(energy_is_kept_over_a_mesh_cycle),
                                    GM_TEST(energy_changes_by_the_work_done),
                                    GM_TEST(warm_start_gives_the_cold_answer),
                                    GM_TEST(sums_of_one_step_are_those_of_undeformed_teeth),
                                    GM_TEST(teeth_are_followed_over_many_pitches),
                                    GM_TEST(touch_after_a_flight_needs_few_steps),
                                    GM_TEST(cold_start_needs_few_steps),
                                    GM_TEST(nothing_touches_without_approach),
                                    GM_TEST(rigid_teeth_leave_the_contact_law),
                                    GM_TEST(even_load_deflects_evenly),
                                    GM_TEST(mirrored_face_gives_the_same),
                                    GM_TEST(soft_tooth_gives_its_load_away),
                                    GM_TEST(table_of_the_pair_is_that_of_both_gears),
                                    GM_TEST(tables_are_as_near_as_tips_are_thick),
                                    GM_TEST(pointed_tips_keep_their_contact_law),
                                    GM_TEST(sizes_out_of_range_are_refused),
                                    GM_TEST(parameters_out_of_range_are_refused),
                                    GM_TEST(many_lines_are_no_other_case),
                                    GM_TEST(stations_converge)};
    return gm_test_main("unit.elastic", tests, GM_TEST_COUNT(tests), argc, argv);
}
