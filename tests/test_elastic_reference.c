/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Elastic teeth against reference numbers: those of an independent implementation to its digits, and finite elements to the
 * error that the model was seen to have. Reads reference/elastic.txt, whose head describes it.
 */
#include "elastic.h"
#include "elastic_gear.h"
#include "hertz.h"
#include "tooth_compliance.h"

#include <math.h>

static const elastic_deviation ideal = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, {0.0, 0.0, 0.0}};
static const char *file_name = "reference/elastic.txt";

/* ---------------------------------------------------------------------------------------------
 * Reading
 * ------------------------------------------------------------------------------------------- */

enum { VALUES = 64 };

typedef struct reader {
    FILE *file;
    char key[64];
    elastic_gear gear; /* the last one */
    char gear_name[64];
} reader;

static void open_cases(reader *r) {
    memset(r, 0, sizeof *r);
    r->file = gm_test_open(file_name);
}

static double next_number(reader *r) {
    char word[64];
    if (fscanf(r->file, "%63s", word) != 1) {
        fprintf(stderr, "%s: a number is missing\n", file_name);
        exit(1);
    }
    return strtod(word, NULL);
}

static int next_int(reader *r) {
    return (int)next_number(r);
}

static void next_word(reader *r, char word[64]) {
    if (fscanf(r->file, "%63s", word) != 1) {
        fprintf(stderr, "%s: a word is missing\n", file_name);
        exit(1);
    }
}

static void next_numbers(reader *r, double *values, int count) {
    for (int k = 0; k < count; ++k) {
        values[k] = next_number(r);
    }
}

/* A line that begins with this key. */
static void expect(reader *r, const char *key) {
    char word[64];
    next_word(r, word);
    GM_ASSERT_STRING(word, key);
}

static void skip_line(reader *r) {
    int c = fgetc(r->file);
    while (c != '\n' && c != EOF) {
        c = fgetc(r->file);
    }
}

static void read_gear(reader *r) {
    double v[15];
    next_word(r, r->gear_name);
    next_numbers(r, v, 15);
    memset(&r->gear, 0, sizeof r->gear);
    r->gear = (elastic_gear){.normal_module = v[0],
                             .pressure_angle = v[1],
                             .helix_angle = v[2],
                             .center_distance = v[3],
                             .face_width = v[4],
                             .teeth = {v[5], v[6]},
                             .shift = {v[7], v[8]},
                             .tip_radius = {v[9], v[10]},
                             .dedendum = v[11],
                             .fillet_radius = v[12],
                             .youngs_modulus = {v[13], v[13]},
                             .poisson_ratio = {v[14], v[14]},
                             .stations = next_int(r)};
}

/* The next record of a kind; gears in between are read. 0 at the end. */
static int find_record(reader *r, const char *kind) {
    while (fscanf(r->file, "%63s", r->key) == 1) {
        if (strcmp(r->key, "gear") == 0) {
            read_gear(r);
        } else if (strcmp(r->key, kind) == 0) {
            return 1;
        } else {
            skip_line(r);
        }
    }
    fclose(r->file);
    return 0;
}

static void make(elastic_case *c, const elastic_gear *gear) {
    GM_ASSERT_INT(elastic_case_make(c, gear, 8), GM_OK);
}

/* x at which the force is F, by Newton's method. */
static double approach_at(elastic_case *c, const gmi_elastic_lines_at *at,
                          const elastic_deviation *d, double force) {
    double x = 1e-3 * c->gear.normal_module;
    for (int k = 0; k < 40; ++k) {
        const gmi_elastic_result result = elastic_solve_at(c, at, d, x, 1);
        if (fabs(result.force - force) <= 1e-12 * force) {
            break;
        }
        x += result.by_approach > 0.0 ? (force - result.force) / result.by_approach : x;
    }
    return x;
}

/* ---------------------------------------------------------------------------------------------
 * Numbers of the model
 * ------------------------------------------------------------------------------------------- */

static void sections_are_those_of_the_reference(void) {
    reader r;
    int done = 0;
    for (open_cases(&r); find_record(&r, "section"); ++done) {
        double v[6];
        next_numbers(&r, v, 6);
        const int points = next_int(&r);

        /* The virtual spur gear of the pinion. */
        elastic_gear g = r.gear;
        elastic_gear_derive(&g);
        const double cosine = cos(g.base_helix_angle);
        const gmi_tooth_params params = {
            g.teeth[0] / (cosine * cosine * cos(g.helix_angle)),
            g.normal_module,
            g.pressure_angle,
            g.shift[0],
            g.normal_module * (0.5 * GMI_PI + 2.0 * g.shift[0] * tan(g.pressure_angle)),
            g.dedendum,
            g.fillet_radius,
            g.youngs_modulus[0],
            g.poisson_ratio[0]};

        gmi_tooth tooth;
        gm_test_context("%s", r.gear_name);
        GM_ASSERT_INT(gmi_tooth_init(&tooth, &params), GMI_TOOTH_FINE);
        GM_ASSERT_REL(params.virtual_teeth, v[1], v[0]);
        GM_ASSERT_REL(tooth.base_radius, v[2], v[0]);
        GM_ASSERT_REL(tooth.base_half_thickness, v[3], v[0]);
        GM_ASSERT_REL(0.5 * tooth.foot_chord, v[4], v[0]);
        GM_ASSERT_REL(tooth.foot_y, v[5], v[0]);

        /* Loads along the flank. */
        for (int k = 0; k < points; ++k) {
            double p[6];
            gmi_tooth_load load;
            expect(&r, "load");
            next_numbers(&r, p, 6);

            GM_ASSERT_INT(gmi_tooth_load_at(&tooth, p[0] / cosine, &load), GMI_TOOTH_FINE);
            GM_ASSERT_NEAR(load.angle, p[1], v[0], 1e-12);
            GM_ASSERT_REL(load.y, p[2], v[0]);
            GM_ASSERT_REL(load.depth, p[3], v[0]);
            GM_ASSERT_NEAR(load.bending, p[4], v[0], v[0] * p[5]);
            GM_ASSERT_REL(load.foundation, p[5], v[0]);
        }
    }
    GM_ASSERT_INT(done, 5);
}

static void contact_law_is_that_of_the_reference(void) {
    reader r;
    int done = 0;
    for (open_cases(&r); find_record(&r, "hertz"); ++done) {
        double v[7];
        next_numbers(&r, v, 7);
        gmi_hertz_state state;
        gmi_hertz_evaluate(v[1], 1.0 / (v[1] * exp(v[2])), v[3], &state);
        gm_test_context("gamma %g", v[3]);
        GM_ASSERT_REL(state.load, v[4], v[0]);
        GM_ASSERT_REL(state.stiffness, v[5], v[0]);
        GM_ASSERT_REL(state.energy, v[6], v[0]);
    }
    GM_ASSERT_INT(done, 10);
}

/* B and L of a pair: at the pitch point of the spur pair, from the tables. */
static void contact_law_follows_from_the_pair(void) {
    reader r;
    open_cases(&r);
    GM_ASSERT(find_record(&r, "mesh"));
    elastic_case c;
    make(&c, &r.gear);
    const gmi_elastic_lines_at at = elastic_lines_at(&c.gear, 0.5 * c.gear.line_of_action);
    GM_ASSERT_INT(gmi_elastic_place(&c.law, &at, &c.work), GM_OK);
    const double B = c.law.hertz_compliance;
    GM_ASSERT_REL(B, 2.8122523925e-12, 1e-10);
    GM_ASSERT_ABS(-log(B * c.work.rate[0]), 18.4578147841, 1e-7);
    fclose(r.file);
    elastic_case_free(&c);
}

static void layers_are_those_of_the_reference(void) {
    reader r;
    int done = 0;
    for (open_cases(&r); find_record(&r, "strip"); ++done) {
        double diagonal[VALUES], beside[VALUES], rim_diagonal[VALUES], rim_beside[VALUES],
            load[VALUES];
        const double tolerance = next_number(&r);
        const int n = next_int(&r);

        /* The matrices of the record, and a load at the end. */
        expect(&r, "tooth_diagonal");
        next_numbers(&r, diagonal, n);
        expect(&r, "tooth_beside");
        next_numbers(&r, beside, n - 1);
        expect(&r, "rim_diagonal");
        next_numbers(&r, rim_diagonal, n);
        expect(&r, "rim_beside");
        next_numbers(&r, rim_beside, n - 1);
        expect(&r, "end_load");
        next_numbers(&r, load, n);

        elastic_case c;
        make(&c, &r.gear);
        const double r2 = c.law.rim_compliance;
        for (int k = 0; k < n; ++k) {
            GM_ASSERT_REL(c.law.tooth.diagonal[k], diagonal[k], tolerance);
            GM_ASSERT_REL(r2 * c.law.rim.diagonal[k], rim_diagonal[k], tolerance);
        }
        for (int k = 0; k + 1 < n; ++k) {
            GM_ASSERT_REL(c.law.tooth.beside[k], beside[k], tolerance);
            GM_ASSERT_REL(r2 * c.law.rim.beside[k], rim_beside[k], tolerance);
        }

        /* A unit load at node 0: the tails say the same without solving. */
        double v = 1.0 / c.law.tooth.right[0];
        for (int k = 0; k < n; ++k) {
            GM_ASSERT_REL(v, load[k], 1e-9);
            if (k + 1 < n) {
                v *= -c.law.tooth.beside[k] / c.law.tooth.right[k + 1];
            }
        }
        elastic_case_free(&c);
    }
    GM_ASSERT_INT(done, 1);
}

/* Line load at any place of a line: the contact law of gamma with deflections interpolated. */
static double load_at(const elastic_case *c, int row, double z, const elastic_deviation *d,
                      double x) {
    const gmi_elastic_work *w = &c->work;
    const gmi_elastic_line *line = &w->line[row];
    const double roll = w->at.origin + line->index * w->at.pitch + w->at.climb * z;
    if (roll < w->at.lower - 1e-7 || roll > w->at.upper + 1e-7) { /* z has few digits */
        return 0.0;
    }
    int element = (int)(z / c->law.spacing);
    element = element > w->stations - 2 ? w->stations - 2 : element;
    const double t = z / c->law.spacing - element;
    const double *tooth = w->state + row * w->stations + element;
    const double *rim = w->state + w->lines_max * w->stations + element;

    /* Tooth layer and contact law there, from a line of its own through that place: a spur pair of one point. */
    double s = 0.0, rate = 0.0, ignored[2];
    gmi_elastic_work other;
    void *memory = malloc(gmi_elastic_work_size(2, 1, 0));
    gmi_elastic spur = c->law;
    gmi_elastic_lines_at at = w->at;
    gmi_elastic_work_init(&other, 2, 1, 0, memory);
    spur.stations = 2;
    spur.spacing = spur.face_width;
    spur.per_spacing = 1.0 / spur.spacing;
    at.climb = 0.0;
    at.origin = fmin(fmax(roll, at.lower), at.upper);
    at.first = at.last = 0;
    if (gmi_elastic_place(&spur, &at, &other) == GM_OK && other.count == 1) {
        s = other.tooth[0];
        rate = other.rate[0];
    }
    free(memory);
    const double gamma =
        x + deviation_at(&c->gear, d, line->index, roll, z, &ignored[0], &ignored[1]) -
        s * (tooth[0] + t * (tooth[1] - tooth[0])) - rim[0] - t * (rim[1] - rim[0]);
    gmi_hertz_state state;
    gmi_hertz_evaluate(c->law.hertz_compliance, rate, gamma, &state);
    return state.load;
}

static void meshes_are_those_of_the_reference(void) {
    reader r;
    int done = 0;
    for (open_cases(&r); find_record(&r, "mesh"); ++done) {
        char id[64], name[64];
        double v[14], z[VALUES];
        next_word(&r, id);
        next_word(&r, name);
        next_numbers(&r, v, 14);
        const int lines = next_int(&r), count = next_int(&r);
        const double tolerance = v[0], x = v[2];

        /* Misalignment and relief of the record. */
        elastic_deviation d = ideal;
        d.misalignment = v[3];
        d.relief = v[4];
        d.from = v[5];
        d.to = v[6];

        elastic_case c;
        make(&c, &r.gear);
        const gmi_elastic_lines_at at = elastic_lines_at(&c.gear, v[1]);
        const gmi_elastic_result got = elastic_solve_at(&c, &at, &d, x, 0);
        gmi_elastic_gradient force, energy;
        gmi_elastic_differentiate(&c.law, &c.work, &force, &energy);
        gm_test_context("case %s, %s %s", id, r.gear_name, name);
        GM_ASSERT_REL(got.force, v[7], tolerance);
        GM_ASSERT_REL(got.by_approach, v[8], tolerance);
        GM_ASSERT_REL(got.energy, v[9], tolerance);
        GM_ASSERT_ABS(energy.by_roll, v[10], v[11] + 1e-6 * fabs(v[10]));
        if (!isnan(v[12])) {
            /* Slopes of the tables are true to 1e-4; and its size is that of the parts that cancel. */
            GM_ASSERT_NEAR(force.by_roll, v[12], 1e-4,
                           1e-7 * (fabs(force.by_lower) + fabs(force.by_upper)));
        }
        double largest = 0.0;
        for (int p = 0; p < 2 * c.work.slots; ++p) {
            largest = fmax(largest, c.work.load[p]);
        }
        GM_ASSERT_REL(largest, v[13], 1e-6); /* tables of the teeth */

        expect(&r, "z");
        next_numbers(&r, z, count);
        GM_ASSERT_INT(c.work.count, lines);
        for (int k = 0; k < lines; ++k) {
            double q[VALUES];
            expect(&r, "line");
            const int index = next_int(&r);
            const double line_force = next_number(&r);
            next_numbers(&r, q, count);
            for (int row = 0; row < c.work.count; ++row) {
                if (c.work.line[row].index == index) {
                    GM_ASSERT_NEAR(got.line_force[row], line_force, tolerance,
                                   tolerance * got.force);
                    for (int i = 0; i < count; ++i) {
                        GM_ASSERT_NEAR(load_at(&c, row, z[i], &d, x), q[i], 1e-6, 1e-6 * largest);
                    }
                }
            }
        }
        elastic_case_free(&c);
    }
    GM_ASSERT_INT(done, 25);
}

/* The check values of the specification: x for a force at a roll, with more and fewer stations. */
typedef struct check_row {
    const char *gear;
    int stations;
    double o, force, x;
} check_row;

static const check_row check_rows[] = {
    {"spur62", 17, 16.21679662e-3, 2000.0, 3.5204755e-6},
    {"spur62", 17, 18.87371492e-3, 2000.0, 3.3983351e-6},
    {"paper", 17, 12.06805254e-3, 1500.0, 4.3705490e-6},
    {"nrel3", 17, 60.71594136e-3, 259200.0, 31.313399e-6},
    {"paper", 9, 12.06805254e-3, 1500.0, 4.3519989e-6},
    {"paper", 25, 12.06805254e-3, 1500.0, 4.3764413e-6},
    {"paper", 33, 12.06805254e-3, 1500.0, 4.3787520e-6},
    {"paper", 97, 12.06805254e-3, 1500.0, 4.3813663e-6},
    {"nrel3", 9, 60.71594136e-3, 259200.0, 31.085570e-6},
    {"nrel3", 25, 60.71594136e-3, 259200.0, 31.344668e-6},
    {"nrel3", 33, 60.71594136e-3, 259200.0, 31.360436e-6},
    {"nrel3", 97, 60.71594136e-3, 259200.0, 31.380103e-6},
};

/* What it gives beside that for the first rows: dF/dx, energy, its slope by the roll, and the force of each line. */
typedef struct check_result {
    double stiffness, energy, by_roll;
    int first; /* line of line_force[0] */
    double line_force[4];
} check_result;

static const check_result check_results[] = {
    {5.9267690e8, 3.4476122e-3, 0.1399209, 0, {809.29229, 1190.70771}},
    {6.1402245e8, 3.3277843e-3, -0.0395395, 0, {1058.97202, 941.02798}},
    {3.5962402e8, 3.2032112e-3, 0.0357711, -2, {71.0459, 607.8484, 679.5523, 141.5534}},
    {8.7153952e9, 3.9564999, -61.00005, -1, {115130.35, 140346.03, 3723.63}},
};

enum {
    CHECK_ROWS = sizeof check_rows / sizeof check_rows[0],
    CHECK_RESULTS = sizeof check_results / sizeof check_results[0]
};

/* The gears of the check values stand in the file of cases. */
static elastic_gear gear_named(const char *name) {
    elastic_gear gear = {0};
    int found = 0;
    reader r;
    for (open_cases(&r); find_record(&r, "mesh");) {
        if (strcmp(r.gear_name, name) == 0) {
            gear = r.gear;
            found = 1;
        }
        skip_line(&r);
    }
    GM_ASSERT(found);
    return gear;
}

static void check_values_are_met(void) {
    for (int i = 0; i < CHECK_ROWS; ++i) {
        const check_row *row = &check_rows[i];
        elastic_gear gear = gear_named(row->gear);
        gear.stations = row->stations;
        elastic_case c;
        make(&c, &gear);
        gm_test_context("%s, %d stations", row->gear, row->stations);

        const gmi_elastic_lines_at at = elastic_lines_at(&c.gear, row->o);
        const double x = approach_at(&c, &at, &ideal, row->force);
        GM_ASSERT_REL(x, row->x, 1e-7);

        if (i < CHECK_RESULTS) {
            const check_result *expected = &check_results[i];
            const gmi_elastic_result got = elastic_solve_at(&c, &at, &ideal, x, 0);
            gmi_elastic_gradient force, energy;
            gmi_elastic_differentiate(&c.law, &c.work, &force, &energy);
            GM_ASSERT_REL(got.by_approach, expected->stiffness, 1e-7);
            GM_ASSERT_REL(got.energy, expected->energy, 1e-7);
            GM_ASSERT_ABS(energy.by_roll, expected->by_roll, 1e-7 * row->force);
            for (int k = 0; k < c.work.count; ++k) {
                const int number = c.work.line[k].index - expected->first;
                GM_ASSERT(number >= 0 && number < 4);
                GM_ASSERT_NEAR(got.line_force[k], expected->line_force[number], 1e-7,
                               1e-7 * row->force);
            }
        }
        elastic_case_free(&c);
    }
}

/* ---------------------------------------------------------------------------------------------
 * Finite elements
 * ------------------------------------------------------------------------------------------- */

/* Plane strain, spur gears of real numbers of teeth: mean and peak-to-peak of the transmission error over a mesh cycle. */
static void transmission_error_is_that_of_plane_finite_elements(void) {
    reader r;
    int done = 0;
    for (open_cases(&r); find_record(&r, "te2d"); ++done) {
        char name[64];
        double v[15];
        next_word(&r, name);
        next_numbers(&r, v, 15);
        const int points = next_int(&r);

        elastic_gear g = {.normal_module = v[2],
                          .pressure_angle = v[0],
                          .face_width = 1e-3,
                          .teeth = {v[1], v[5]},
                          .shift = {v[3], v[7]},
                          .tip_radius = {v[4], v[8]},
                          .dedendum = 1.25,
                          .fillet_radius = 0.38,
                          .youngs_modulus = {206e9, 206e9},
                          .poisson_ratio = {0.3, 0.3},
                          .stations = 2};

        /* d from the line of action: T^2 = d^2 - (r_bp + r_bw)^2. */
        const double base = 0.5 * v[2] * (v[1] + v[5]) * cos(v[0]);
        g.center_distance = sqrt(v[9] * v[9] + base * base);
        elastic_case c;
        gm_test_context("%s, %g N/m", name, v[12]);
        make(&c, &g);
        GM_ASSERT_REL(c.gear.pitch, v[10], 1e-9);
        GM_ASSERT_REL(c.gear.path_start, v[11], 1e-7);

        double low = 1.0, high = 0.0, low_fe = 1.0, high_fe = 0.0;
        for (int k = 0; k < points; ++k) {
            expect(&r, "point");
            const double xi = next_number(&r), te = next_number(&r);
            const gmi_elastic_lines_at at = elastic_lines_at(&c.gear, v[11] + xi * v[10]);
            const double x = approach_at(&c, &at, &ideal, v[12] * g.face_width);
            GM_ASSERT_REL(x, te, v[13]);
            low = fmin(low, x);
            high = fmax(high, x);
            low_fe = fmin(low_fe, te);
            high_fe = fmax(high_fe, te);
        }

        GM_ASSERT_REL(high - low, high_fe - low_fe, v[14]);
        elastic_case_free(&c);
    }
    GM_ASSERT_INT(done, 6);
}

/* Twisted teeth in three dimensions: transmission error, its shape after one constant offset, line loads. */
static void loads_are_those_of_finite_elements_of_twisted_teeth(void) {
    reader r;
    int done = 0;
    for (open_cases(&r); find_record(&r, "te3d"); ++done) {
        double v[6], difference[16], offset = 0.0;
        next_numbers(&r, v, 6);
        const int rows = next_int(&r);

        elastic_case c;
        make(&c, &r.gear);
        elastic_deviation d = ideal; /* -m (z/b - 1/2): the half belongs to x */
        d.misalignment = -v[1];
        for (int i = 0; i < 3; ++i) {
            d.of_line[i] = 0.5 * v[1];
        }

        gm_test_context("%s, misaligned by %g m", r.gear_name, v[1]);
        for (int k = 0; k < rows; ++k) {
            /* The transmission error, within what the specification allows. */
            expect(&r, "row");
            const double o = next_number(&r), te = next_number(&r);
            const int points = next_int(&r);
            const gmi_elastic_lines_at at = elastic_lines_at(&c.gear, o);
            const double x = approach_at(&c, &at, &d, v[0]);
            GM_ASSERT_REL(x, te, v[2]);
            difference[k] = x - te;
            offset += difference[k] / rows;

            /* Line loads, by their rms and by the largest. */
            double squares = 0.0, weights = 0.0, sum = 0.0, largest = 0.0, largest_fe = 0.0;
            for (int p = 0; p < points; ++p) {
                expect(&r, "load");
                const int index = next_int(&r);
                const double z = next_number(&r), q = next_number(&r), weight = next_number(&r);
                double ours = 0.0;
                for (int row = 0; row < c.work.count; ++row) {
                    if (c.work.line[row].index == index) {
                        ours = load_at(&c, row, z, &d, x);
                    }
                }

                squares += weight * (ours - q) * (ours - q);
                sum += weight * q;
                weights += weight;
                largest = fmax(largest, ours);
                largest_fe = fmax(largest_fe, q);
            }

            const double mean = sum / weights;
            GM_ASSERT(sqrt(squares / weights) <= v[4] * mean);
            GM_ASSERT_REL(largest, largest_fe, v[5]);
        }

        /* Its shape, after one constant offset. */
        for (int k = 0; k < rows; ++k) {
            GM_ASSERT_ABS(difference[k], offset, v[3]);
        }
        elastic_case_free(&c);
    }
    GM_ASSERT_INT(done, 4);
}

/* Face load factor of one pair at the pitch point. */
static void face_load_factor_is_that_of_finite_elements(void) {
    reader r;
    int done = 0;
    for (open_cases(&r); find_record(&r, "khb"); ++done) {
        double v[4];
        next_numbers(&r, v, 4);
        elastic_case c;
        elastic_gear gear = r.gear;
        gear.stations = 33;
        make(&c, &gear);
        elastic_deviation d = ideal;
        d.misalignment = -v[1];
        gmi_elastic_lines_at at = elastic_lines_at(&c.gear, 0.5 * c.gear.line_of_action);
        at.tooth -= at.first;
        at.first = at.last = 0;
        const double force = v[0] * c.gear.face_width;
        const double x = approach_at(&c, &at, &d, force);
        double largest = 0.0;
        for (int k = 0; k <= 100; ++k) {
            largest = fmax(largest, load_at(&c, 0, c.gear.face_width * k / 100.0, &d, x));
        }
        gm_test_context("misaligned by %g m", v[1]);
        GM_ASSERT_REL(largest * c.gear.face_width / force, v[2], v[3]);
        elastic_case_free(&c);
    }
    GM_ASSERT_INT(done, 2);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {GM_TEST(sections_are_those_of_the_reference),
                                    GM_TEST(contact_law_is_that_of_the_reference),
                                    GM_TEST(contact_law_follows_from_the_pair),
                                    GM_TEST(layers_are_those_of_the_reference),
                                    GM_TEST(meshes_are_those_of_the_reference),
                                    GM_TEST(check_values_are_met),
                                    GM_TEST(transmission_error_is_that_of_plane_finite_elements),
                                    GM_TEST(loads_are_those_of_finite_elements_of_twisted_teeth),
                                    GM_TEST(face_load_factor_is_that_of_finite_elements)};
    return gm_test_main("reference.elastic", tests, GM_TEST_COUNT(tests), argc, argv);
}
