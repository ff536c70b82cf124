/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The library against reference cases computed elsewhere with 40 digits (reference/cases.txt, where
 * source, layout and tolerances stand). Another file of the same layout may be given as argument.
 */
#include "flank.h"
#include "gearmesh/gearmesh.h"
#include "gm_test.h"
#include "plain_mesh.h"
#include "reference_model.h"

#define CASES_FILE "reference/cases.txt"

enum { MAX_PAIRS = 128, MAX_POINTS = 128, DERIVED_COUNT = 25 };

/** Order of the flanks in a case. */
enum { P_DRIVE, P_COAST, W_DRIVE, W_COAST, FLANK_COUNT };

typedef struct table_record {
    int tooth; /**< or GM_ALL_TEETH */
    double *values;
    struct table_record *next;
} table_record;

typedef struct flank_record {
    int face_nodes;
    int profile_nodes;
    int table_count;
    table_record *tables; /**< in the order of the file */
    double *pitch;        /**< [teeth] or NULL */
} flank_record;

typedef struct pair_record {
    double length;
    double fraction;
} pair_record;

typedef struct side_record {
    double sum;
    double fraction;
    double overlap;
    int pair_count;
    pair_record pairs[MAX_PAIRS];
} side_record;

typedef struct point_record {
    double pinion_angle;
    double wheel_angle;
    double te;
} point_record;

typedef struct case_record {
    char id[64];
    char group[64];
    gm_pair_params params;
    double derived[DERIVED_COUNT];
    int has_deviation;
    int is_normal;
    flank_record flanks[FLANK_COUNT];
    /* penetration cases */
    double pinion_angle;
    double wheel_angle;
    double tolerance; /**< atol_pen or atol_te */
    side_record side[2];
    double net;
    /* equilibrium cases */
    int point_count;
    double stiffness;
    double torque;
    point_record points[MAX_POINTS];
    struct case_record *next;
} case_record;

static double relative_tolerance;
static case_record *all_cases;

/* ---------------------------------------------------------------------------------------------
 * Reading
 * ------------------------------------------------------------------------------------------- */

static const char *file_name = CASES_FILE;

static void stop_reading(const char *what, const char *word) {
    fprintf(stderr, "%s: %s: \"%s\"\n", file_name, what, word);
    exit(1);
}

static void *allocate(size_t count, size_t size) {
    void *memory = calloc(count, size);
    if (memory == NULL) {
        stop_reading("no memory", "");
    }
    return memory;
}

/** Next word; 0 at the end of the file. */
static int next_word(FILE *file, char word[64]) {
    return fscanf(file, "%63s", word) == 1;
}

static double next_number(FILE *file) {
    char word[64] = "";
    char *end = word;
    double value = 0.0;
    if (next_word(file, word)) {
        value = strtod(word, &end);
    }
    if (end == word || *end != '\0') {
        stop_reading("not a number", word);
    }
    return value;
}

static int next_integer(FILE *file, int low, int high) {
    const double value = next_number(file);
    if (!(value >= low && value <= high) || value != floor(value)) {
        stop_reading("integer out of range", "");
    }
    return (int)value;
}

static double *next_numbers(FILE *file, int count) {
    double *values = allocate((size_t)count, sizeof *values);
    for (int i = 0; i < count; ++i) {
        values[i] = next_number(file);
    }
    return values;
}

static flank_record *next_flank(FILE *file, case_record *c) {
    static const char *const names[FLANK_COUNT] = {"p_drive", "p_coast", "w_drive", "w_coast"};
    char word[64] = "";
    next_word(file, word);
    for (int i = 0; i < FLANK_COUNT; ++i) {
        if (strcmp(word, names[i]) == 0) {
            return &c->flanks[i];
        }
    }
    stop_reading("no such flank", word);
    return NULL;
}

static void read_gear(FILE *file, gm_pair_params *params) {
    double *const fields[] = {&params->normal_module,
                              &params->normal_pressure_angle,
                              &params->helix_angle,
                              &params->center_distance,
                              &params->face_width,
                              &params->pinion_profile_shift,
                              &params->wheel_profile_shift,
                              &params->pinion_normal_thickness,
                              &params->wheel_normal_thickness,
                              &params->pinion_tip_radius,
                              &params->wheel_tip_radius,
                              &params->pinion_start_radius,
                              &params->wheel_start_radius};
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; ++i) {
        *fields[i] = next_number(file);
    }
}

static void read_table(FILE *file, case_record *c) {
    flank_record *flank = next_flank(file, c);
    flank->face_nodes = next_integer(file, 2, 10000);
    flank->profile_nodes = next_integer(file, 2, 10000);
    char word[64] = "";
    next_word(file, word);
    table_record **last = &flank->tables;
    while (*last != NULL) {
        last = &(*last)->next;
    }
    *last = allocate(1, sizeof **last);
    (*last)->tooth = strcmp(word, "all") == 0 ? GM_ALL_TEETH : (int)strtol(word, NULL, 10);
    (*last)->values = next_numbers(file, flank->face_nodes * flank->profile_nodes);
    ++flank->table_count;
}

static void read_side(FILE *file, side_record *side) {
    side->sum = next_number(file);
    side->fraction = next_number(file);
    side->overlap = next_number(file);
    side->pair_count = next_integer(file, 0, MAX_PAIRS);
    for (int i = 0; i < side->pair_count; ++i) {
        char word[64] = "";
        if (!next_word(file, word) || strcmp(word, "pair") != 0) {
            stop_reading("a pair is missing", word);
        }
        double value[9]; /* i j tooth_p tooth_w t1_lo t1_hi delta_ideal integral fraction */
        for (int k = 0; k < 9; ++k) {
            value[k] = next_number(file);
        }
        side->pairs[i] = (pair_record){.length = value[5] - value[4], .fraction = value[8]};
    }
}

static void read_points(FILE *file, case_record *c) {
    c->stiffness = next_number(file);
    c->torque = next_number(file);
    c->tolerance = next_number(file);
    c->point_count = next_integer(file, 1, MAX_POINTS);
    for (int i = 0; i < c->point_count; ++i) {
        char word[64] = "";
        if (!next_word(file, word) || strcmp(word, "point") != 0) {
            stop_reading("a point is missing", word);
        }
        c->points[i].pinion_angle = next_number(file);
        c->points[i].wheel_angle = next_number(file);
        c->points[i].te = next_number(file);
    }
}

static case_record *read_case(FILE *file) {
    case_record *c = allocate(1, sizeof *c);
    char word[64] = "";
    next_word(file, c->id);
    next_word(file, c->group);
    gm_pair_params_default(&c->params);

    /* Each record is a word and its numbers, in any order up to `end`. */
    while (next_word(file, word) && strcmp(word, "end") != 0) {
        if (strcmp(word, "teeth") == 0) {
            c->params.pinion_teeth = next_integer(file, 3, 100000);
            c->params.wheel_teeth = next_integer(file, 3, 100000);
        } else if (strcmp(word, "gear") == 0) {
            read_gear(file, &c->params);
        } else if (strcmp(word, "derived") == 0) {
            for (int i = 0; i < DERIVED_COUNT; ++i) {
                c->derived[i] = next_number(file);
            }
        } else if (strcmp(word, "deviation") == 0) {
            next_word(file, word);
            c->has_deviation = strcmp(word, "none") != 0;
            c->is_normal = strcmp(word, "normal") == 0;
        } else if (strcmp(word, "pitch") == 0) {
            flank_record *flank = next_flank(file, c);
            flank->pitch = next_numbers(file, next_integer(file, 3, 100000));
        } else if (strcmp(word, "table") == 0) {
            read_table(file, c);
        } else if (strcmp(word, "state") == 0) {
            c->pinion_angle = next_number(file);
            c->wheel_angle = next_number(file);
            c->tolerance = next_number(file);
        } else if (strcmp(word, "drive") == 0) {
            read_side(file, &c->side[GM_DRIVE]);
        } else if (strcmp(word, "coast") == 0) {
            read_side(file, &c->side[GM_COAST]);
        } else if (strcmp(word, "net") == 0) {
            c->net = next_number(file);
        } else if (strcmp(word, "equilibrium") == 0) {
            read_points(file, c);
        } else {
            stop_reading("unknown record", word);
        }
    }

    if (strcmp(word, "end") != 0) {
        stop_reading("the file ends inside a case", c->id);
    }
    return c;
}

static void read_cases(void) {
    FILE *file = fopen(file_name, "r");
    if (file == NULL) {
        stop_reading("cannot be read", "");
    }
    char word[64];
    case_record **last = &all_cases;
    while (next_word(file, word)) {
        if (word[0] == '#') {
            if (fscanf(file, "%*[^\n]") == EOF) {
                break;
            }
        } else if (strcmp(word, "rel_tol") == 0) {
            relative_tolerance = next_number(file);
        } else if (strcmp(word, "case") == 0) {
            *last = read_case(file);
            last = &(*last)->next;
        } else {
            stop_reading("unknown record", word);
        }
    }
    fclose(file);
}

static void free_cases(void) {
    while (all_cases != NULL) {
        case_record *c = all_cases;
        all_cases = c->next;
        for (int i = 0; i < FLANK_COUNT; ++i) {
            while (c->flanks[i].tables != NULL) {
                table_record *table = c->flanks[i].tables;
                c->flanks[i].tables = table->next;
                free(table->values);
                free(table);
            }
            free(c->flanks[i].pitch);
        }
        free(c);
    }
}

/* ---------------------------------------------------------------------------------------------
 * A case, ready for the library and for the second model
 * ------------------------------------------------------------------------------------------- */

typedef struct prepared {
    gm_pair pair;
    void *memory[2];
    const gm_flanks *use[2]; /**< NULL without deviations */
} prepared;

static int set_side(gm_flanks *flanks, int side, const flank_record *record, double factor) {
    int status = GM_OK;
    for (const table_record *t = record->tables; t != NULL && status == GM_OK; t = t->next) {
        status = gm_flanks_set_table(flanks, side, t->tooth, t->values, factor);
    }
    for (int tooth = 0; record->pitch != NULL && tooth < gm_flanks_teeth(flanks) && status == GM_OK;
         ++tooth) {
        status = gm_flanks_set_pitch(flanks, side, tooth, record->pitch[tooth]);
    }
    return status;
}

static int prepare(prepared *p, const case_record *c) {
    memset(p, 0, sizeof *p);
    gm_test_context("%s", c->id);
    if (!GM_ASSERT_INT(gm_pair_init(&p->pair, &c->params), GM_OK)) {
        return 0;
    }

    /* The flanks of each gear, with both sides as the case has them. */
    const double factor = c->is_normal ? p->pair.normal_to_transverse : 1.0;
    const int teeth[2] = {c->params.pinion_teeth, c->params.wheel_teeth};
    for (int gear = 0; gear < 2 && c->has_deviation; ++gear) {
        const flank_record *drive = &c->flanks[gear == 0 ? P_DRIVE : W_DRIVE];
        const flank_record *coast = &c->flanks[gear == 0 ? P_COAST : W_COAST];
        const gm_flanks_params sizes = {.teeth = teeth[gear],
                                        .drive_tables = drive->table_count,
                                        .drive_face_nodes = drive->face_nodes,
                                        .drive_profile_nodes = drive->profile_nodes,
                                        .coast_tables = coast->table_count,
                                        .coast_face_nodes = coast->face_nodes,
                                        .coast_profile_nodes = coast->profile_nodes};
        const size_t size = gm_flanks_size(&sizes);
        p->memory[gear] = allocate(1, size + 1);
        gm_flanks *flanks = NULL;
        if (!GM_ASSERT_INT(gm_flanks_init(&flanks, &sizes, p->memory[gear], size), GM_OK) ||
            !GM_ASSERT_INT(set_side(flanks, GM_DRIVE, drive, factor), GM_OK) ||
            !GM_ASSERT_INT(set_side(flanks, GM_COAST, coast, factor), GM_OK)) {
            return 0;
        }
        p->use[gear] = flanks;
    }
    return 1;
}

static void discard(prepared *p) {
    free(p->memory[0]);
    free(p->memory[1]);
}

/** Makes the flanks of one gear for the second model; the tables stay those of the case. */
static model_flanks model_flanks_of(const case_record *c, int gear, const model_pair *pair) {
    model_flanks flanks = {0};
    const long double factor = c->is_normal ? 1.0L / cosl(pair->beta_b) : 1.0L;
    const int teeth = pair->teeth[gear];
    for (int side = 0; side < 2; ++side) {
        const flank_record *record = &c->flanks[2 * gear + side];
        flanks.table[side] = allocate((size_t)teeth, sizeof(model_table));
        flanks.pitch[side] = allocate((size_t)teeth, sizeof(double));
        for (const table_record *t = record->tables; t != NULL; t = t->next) {
            for (int tooth = 0; tooth < teeth; ++tooth) {
                if (t->tooth == GM_ALL_TEETH || t->tooth == tooth) {
                    flanks.table[side][tooth] =
                        (model_table){record->face_nodes, record->profile_nodes, t->values, factor};
                }
            }
        }
        if (record->pitch != NULL) {
            memcpy(flanks.pitch[side], record->pitch, (size_t)teeth * sizeof(double));
        }
    }
    return flanks;
}

static void free_model_flanks(model_flanks *flanks) {
    for (int side = 0; side < 2; ++side) {
        free(flanks->table[side]);
        free(flanks->pitch[side]);
    }
}

/** What the cases allow for fractions and lengths in t1. */
static double fraction_tolerance(const case_record *c, double advance) {
    return 1e-9 + (advance != 0.0 ? c->tolerance / fabs(advance) : 0.0);
}

/* ---------------------------------------------------------------------------------------------
 * Tests
 * ------------------------------------------------------------------------------------------- */

static void the_file_holds_cases_and_its_tolerance(void) {
    int penetrations = 0;
    int equilibria = 0;
    for (const case_record *c = all_cases; c != NULL; c = c->next) {
        penetrations += c->point_count == 0;
        equilibria += c->point_count > 0;
    }
    printf("%d states, %d equilibria ", penetrations, equilibria);
    GM_ASSERT(penetrations > 0);
    GM_ASSERT(equilibria > 0);
    GM_ASSERT_REL(relative_tolerance, 1e-10, 0.0); /* the limit that gearmesh.h promises */
}

static void derived_geometry_is_that_of_the_cases(void) {
    for (const case_record *c = all_cases; c != NULL; c = c->next) {
        prepared p;
        if (prepare(&p, c)) {
            const gm_pair *q = &p.pair;
            const double cos_beta = cos(q->helix_angle);

            /* Differences of lengths of the size of the centre distance d lose some of its last
             * bits: backlash (p_bt minus both thicknesses plus the spread of the axes) and path
             * limits (line of action minus the mate's tip). 8 roundings of d, about 1e-15 d. */
            const double cancelled = 8.0 * 0x1p-53 * q->center_distance;
            const struct {
                const char *name;
                double got;
                double absolute;
            } derived[DERIVED_COUNT] = {
                {"transverse_module", q->transverse_module, 0.0},
                {"transverse_pressure_angle", q->transverse_pressure_angle, 0.0},
                {"base_helix_angle", q->base_helix_angle, 0.0},
                {"pinion.reference_radius", q->pinion.reference_radius, 0.0},
                {"wheel.reference_radius", q->wheel.reference_radius, 0.0},
                {"pinion.base_radius", q->pinion.base_radius, 0.0},
                {"wheel.base_radius", q->wheel.base_radius, 0.0},
                {"reference_center_distance", q->reference_center_distance, 0.0},
                {"working_pressure_angle", q->working_pressure_angle, 0.0},
                {"line_of_action", q->line_of_action, 0.0},
                {"transverse_base_pitch", q->transverse_base_pitch, 0.0},
                {"backlash", q->backlash, cancelled},
                {"pinion.normal_thickness / cos(beta)", q->pinion.normal_thickness / cos_beta, 0.0},
                {"wheel.normal_thickness / cos(beta)", q->wheel.normal_thickness / cos_beta, 0.0},
                {"pinion.base_half_thickness", q->pinion.base_half_thickness, 0.0},
                {"wheel.base_half_thickness", q->wheel.base_half_thickness, 0.0},
                {"pinion.tip_radius", q->pinion.tip_radius, 0.0},
                {"wheel.tip_radius", q->wheel.tip_radius, 0.0},
                {"pinion.start_radius", q->pinion.start_radius, 0.0},
                {"wheel.start_radius", q->wheel.start_radius, 0.0},
                {"path_start", q->path_start, cancelled},
                {"path_end", q->path_end, cancelled},
                {"transverse_contact_ratio", q->transverse_contact_ratio, 0.0},
                {"overlap_ratio", q->overlap_ratio, 0.0},
                {"total_contact_ratio", q->total_contact_ratio, 0.0},
            };

            for (int i = 0; i < DERIVED_COUNT; ++i) {
                /* 1e-12: some thousand roundings, far below any drawing, far above chance. */
                gm_test_near(derived[i].got, c->derived[i], 1e-12, derived[i].absolute,
                             derived[i].name, __FILE__, __LINE__);
            }
        }
        discard(&p);
    }
}

static void penetration_of_every_state(void) {
    for (const case_record *c = all_cases; c != NULL; c = c->next) {
        prepared p;
        if (prepare(&p, c) && c->point_count == 0) {
            const gm_state state = {.pinion_angle = c->pinion_angle, .wheel_angle = c->wheel_angle};
            gm_penetration got;
            GM_ASSERT_INT(gm_penetration_3d(&p.pair, p.use[0], p.use[1], &state, &got), GM_OK);
            GM_ASSERT_NEAR(got.drive, c->side[GM_DRIVE].sum, relative_tolerance, c->tolerance);
            GM_ASSERT_NEAR(got.coast, c->side[GM_COAST].sum, relative_tolerance, c->tolerance);
            GM_ASSERT_NEAR(got.penetration, c->net, relative_tolerance, c->tolerance);
            const double allowed = fraction_tolerance(c, p.pair.face_advance);
            GM_ASSERT_ABS(got.drive_contact, c->side[GM_DRIVE].fraction, allowed);
            GM_ASSERT_ABS(got.coast_contact, c->side[GM_COAST].fraction, allowed);
        }
        discard(&p);
    }
}

/** Pairs that touch for certain, and those that may or may not be counted. */
static void count_pairs(const case_record *c, int side, int *certain, int *doubtful) {
    *certain = 0;
    /* On a corner event a pair of no length may be listed or not. */
    *doubtful = strcmp(c->group, "corner") == 0;
    for (int i = 0; i < c->side[side].pair_count; ++i) {
        const pair_record *pair = &c->side[side].pairs[i];
        *certain += pair->fraction > 1e-9 && pair->length > 1e-9;
        *doubtful += pair->fraction > 0.0 && !(pair->fraction > 1e-9 && pair->length > 1e-9);
    }
}

static void pairs_in_contact_of_every_state(void) {
    for (const case_record *c = all_cases; c != NULL; c = c->next) {
        prepared p;
        if (prepare(&p, c) && c->point_count == 0) {
            const gm_state state = {.pinion_angle = c->pinion_angle, .wheel_angle = c->wheel_angle};
            gm_penetration result;
            GM_ASSERT_INT(gm_penetration_3d(&p.pair, p.use[0], p.use[1], &state, &result), GM_OK);
            for (int side = 0; side < 2; ++side) {
                const int got = side == GM_DRIVE ? result.drive_pairs : result.coast_pairs;
                int certain = 0;
                int doubtful = 0;
                count_pairs(c, side, &certain, &doubtful);
                gm_test_report(got >= certain && got <= certain + doubtful, __FILE__, __LINE__,
                               "%s pairs: got %d, expected %d (and up to %d of no length)",
                               side == GM_DRIVE ? "drive" : "coast", got, certain, doubtful);
            }
        }
        discard(&p);
    }
}

static void equilibria_are_those_of_the_cases(void) {
    for (const case_record *c = all_cases; c != NULL; c = c->next) {
        prepared p;
        if (prepare(&p, c)) {
            for (int i = 0; i < c->point_count; ++i) {
                const point_record *point = &c->points[i];
                gm_test_context("%s, point %d", c->id, i);
                double offset = NAN;
                gm_penetration result;
                GM_ASSERT_INT(equilibrium(&p.pair, p.use[0], p.use[1], point->pinion_angle,
                                          c->stiffness, c->torque, &offset, &result),
                              GM_OK);
                GM_ASSERT_NEAR(-offset, point->te, relative_tolerance, c->tolerance);
                /* The wheel angle of the case is that position, rounded as an angle is. */
                const gm_state state = {.pinion_angle = point->pinion_angle,
                                        .wheel_angle = point->wheel_angle};
                gm_position position;
                GM_ASSERT_INT(gm_position_from_state(&p.pair, &state, &position), GM_OK);
                GM_ASSERT_NEAR(-position.offset, point->te, relative_tolerance, c->tolerance);
                GM_ASSERT_NEAR(c->stiffness * p.pair.wheel.base_radius * result.penetration,
                               c->torque, 1e-9, 0.0);
            }
        }
        discard(&p);
    }
}

/* The second model carries 64 bits, so it has to hold the cases to their own rounding: 2^-53, plus the
 * same of the lengths that it takes as doubles. This is what entitles it to judge elsewhere. */
static void the_second_model_agrees(void) {
    for (const case_record *c = all_cases; c != NULL; c = c->next) {
        gm_test_context("%s", c->id);
        if (c->point_count > 0) {
            continue;
        }
        model_pair pair;
        model_pair_init(&pair, &c->params);
        model_flanks flanks[2];
        for (int gear = 0; gear < 2; ++gear) {
            flanks[gear] = model_flanks_of(c, gear, &pair);
        }
        model_result result;
        model_evaluate(&pair, &flanks[0], &flanks[1], c->pinion_angle, c->wheel_angle, 0.0L, 0.0L,
                       &result);
        for (int side = 0; side < 2; ++side) {
            const side_record *expected = &c->side[side];
            GM_ASSERT_NEAR((double)result.sum[side], expected->sum, 1e-14, 1e-2 * c->tolerance);
            GM_ASSERT_ABS((double)result.contact[side], expected->fraction,
                          1e-10 + 1e-2 * (fraction_tolerance(c, (double)pair.face_advance) - 1e-9));
            GM_ASSERT_ABS((double)result.overlap[side], expected->overlap,
                          1e-10 + 1e-2 * (fraction_tolerance(c, (double)pair.face_advance) - 1e-9));
        }
        free_model_flanks(&flanks[0]);
        free_model_flanks(&flanks[1]);
    }
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(the_file_holds_cases_and_its_tolerance), GM_TEST(the_second_model_agrees),
        GM_TEST(derived_geometry_is_that_of_the_cases),  GM_TEST(penetration_of_every_state),
        GM_TEST(pairs_in_contact_of_every_state),        GM_TEST(equilibria_are_those_of_the_cases),
    };
    if (argc > 1) {
        file_name = argv[1];
    }
    read_cases();
    const int failed = gm_test_main("reference.cases", tests, GM_TEST_COUNT(tests), 1, argv);
    free_cases();
    return failed;
}
