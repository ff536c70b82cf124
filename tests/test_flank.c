/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Flank tables in the caller's memory: sizes, places, which tooth has which, and every refusal. */
#include "flank.h" /* what the objects hold */
#include "gearmesh/gearmesh.h"
#include "gm_test.h"
#include "reference_gear.h"

#include <string.h>

#define MEMORY_DOUBLES 4096

static const gm_flanks_params small_sizes = {.teeth = 45,
                                             .drive_tables = 2,
                                             .drive_face_nodes = 3,
                                             .drive_profile_nodes = 4,
                                             .coast_tables = 1,
                                             .coast_face_nodes = 2,
                                             .coast_profile_nodes = 2};

/** Flanks of 45 teeth in static memory. */
static gm_flanks *small_flanks(const gm_flanks_params *sizes) {
    static double memory[MEMORY_DOUBLES];
    gm_flanks *flanks;
    GM_ASSERT_INT(gm_flanks_init(&flanks, sizes, memory, sizeof memory), GM_OK);
    return flanks;
}

/** Evaluates the flanks on the pinion 1 um into drive or coast contact. */
static gm_penetration probe(const gm_flanks *pinion, int side, double angle) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const double x = pair.backlash / 2 + 1e-6;
    return at(&pair, pinion, NULL, angle, side == GM_DRIVE ? x : -x);
}

static void constant_table(double *values, int count, double value) {
    for (int i = 0; i < count; ++i) {
        values[i] = value;
    }
}

/* ---------------------------------------------------------------------------------------------
 * Memory
 * ------------------------------------------------------------------------------------------- */

static void size_grows_with_everything(void) {
    const size_t size = gm_flanks_size(&small_sizes);
    GM_ASSERT(size >= sizeof(double) * (2 * 12 + 1 * 4 + 2 * 45));
    for (int field = 0; field < 7; ++field) {
        gm_test_context("field %d", field);
        gm_flanks_params p = small_sizes;
        int *const fields[] = {
            &p.teeth,        &p.drive_tables,     &p.drive_face_nodes,   &p.drive_profile_nodes,
            &p.coast_tables, &p.coast_face_nodes, &p.coast_profile_nodes};
        *fields[field] += 1;
        GM_ASSERT(gm_flanks_size(&p) > size);
    }
}

static void nodes_of_a_side_without_tables_are_ignored(void) {
    gm_flanks_params p = small_sizes;
    p.coast_tables = 0;
    const size_t size = gm_flanks_size(&p);
    GM_ASSERT(size > 0);
    p.coast_face_nodes = 0;
    p.coast_profile_nodes = -7;
    GM_ASSERT(gm_flanks_size(&p) == size);
    p.drive_tables = 0;
    p.drive_face_nodes = 1000000;
    GM_ASSERT(gm_flanks_size(&p) > 0 && gm_flanks_size(&p) < size);
    const gm_flanks *flanks = small_flanks(&p);
    GM_ASSERT_REL(probe(flanks, GM_DRIVE, 0.1).drive, probe(NULL, GM_DRIVE, 0.1).drive, 1e-14);
}

static void sizes_out_of_range_are_refused(void) {
    static const struct {
        int field;
        int value;
    } wrong[] = {{0, 2}, {0, -1},    {0, 0},  {0, 100001}, {1, -1}, {1, 47},    {2, 1}, {2, 10001},
                 {3, 1}, {3, 10001}, {4, -1}, {4, 47},     {5, 1},  {5, 10001}, {6, 0}, {6, 10001}};
    static double memory[MEMORY_DOUBLES];
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; ++i) {
        gm_test_context("field %d = %d", wrong[i].field, wrong[i].value);
        gm_flanks_params p = small_sizes;
        int *const fields[] = {
            &p.teeth,        &p.drive_tables,     &p.drive_face_nodes,   &p.drive_profile_nodes,
            &p.coast_tables, &p.coast_face_nodes, &p.coast_profile_nodes};
        *fields[wrong[i].field] = wrong[i].value;
        GM_ASSERT(gm_flanks_size(&p) == 0);
        gm_flanks *flanks;
        GM_ASSERT_INT(gm_flanks_init(&flanks, &p, memory, sizeof memory), GM_ERR_PARAMETER);
    }
    GM_ASSERT(gm_flanks_size(NULL) == 0);
    /* The bounds themselves. */
    gm_flanks_params p = small_sizes;
    p.drive_tables = p.teeth + 1;
    p.drive_face_nodes = 10000;
    p.coast_profile_nodes = 10000;
    GM_ASSERT(gm_flanks_size(&p) > 0);
    p.teeth = 3;
    p.drive_tables = p.coast_tables = 0;
    GM_ASSERT(gm_flanks_size(&p) > 0);
    p.teeth = 100000;
    GM_ASSERT(gm_flanks_size(&p) > 0);
}

static void a_size_beyond_the_machine_is_refused(void) {
    /* 1e5 tables of 1e8 nodes: 3e14 bytes; more than 32 bits can address, less than 64. */
    const gm_flanks_params p = {100000, 100001, 10000, 10000, 100001, 10000, 10000};
    const size_t size = gm_flanks_size(&p);
    GM_ASSERT(sizeof(size_t) >= 8 ? size / sizeof(double) > (size_t)200000 * 10000 * 5000
                                  : size == 0);
}

static void memory_is_used_up_to_its_size_and_no_further(void) {
    const size_t size = gm_flanks_size(&small_sizes);
    unsigned char *memory = malloc(size + 64);
    memset(memory, 0xA5, size + 64);
    gm_flanks *flanks;
    GM_ASSERT_INT(gm_flanks_init(&flanks, &small_sizes, memory, size - 1), GM_ERR_MEMORY);
    GM_ASSERT_INT(gm_flanks_init(&flanks, &small_sizes, memory, 0), GM_ERR_MEMORY);
    for (size_t i = 0; i < size; ++i) {
        if (memory[i] != 0xA5) {
            GM_ASSERT(!"memory that is too small was written to");
            break;
        }
    }
    GM_ASSERT_INT(gm_flanks_init(&flanks, &small_sizes, memory, size), GM_OK);
    double values[12];
    constant_table(values, 12, 1e-6);
    GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, GM_ALL_TEETH, values, 1.0), GM_OK);
    GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, 44, values, 1.0), GM_OK);
    GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_COAST, 44, values, 1.0), GM_OK);
    GM_ASSERT_INT(gm_flanks_set_pitch(flanks, GM_DRIVE, GM_ALL_TEETH, 1e-6), GM_OK);
    GM_ASSERT_INT(gm_flanks_set_pitch(flanks, GM_COAST, 44, 1e-6), GM_OK);
    for (size_t i = size; i < size + 64; ++i) {
        GM_ASSERT_INT(memory[i], 0xA5);
    }
    free(memory);
}

static void fresh_flanks_are_ideal(void) {
    const gm_flanks *flanks = small_flanks(&small_sizes);
    GM_ASSERT_INT(flanks->teeth, 45);
    GM_ASSERT_INT(flanks->side[GM_DRIVE].capacity, 2);
    GM_ASSERT_INT(flanks->side[GM_DRIVE].count, 0);
    GM_ASSERT_INT(flanks->side[GM_COAST].capacity, 1);
    for (int tooth = 0; tooth < 45; ++tooth) {
        GM_ASSERT_INT(flanks->side[GM_DRIVE].table[tooth], -1);
        GM_ASSERT_INT(flanks->side[GM_COAST].table[tooth], -1);
        GM_ASSERT_REL(flanks->side[GM_DRIVE].pitch[tooth], 0.0, 0.0);
        GM_ASSERT_REL(flanks->side[GM_COAST].pitch[tooth], 0.0, 0.0);
    }
    for (int k = 0; k < 20; ++k) {
        for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
            GM_ASSERT_REL(probe(flanks, side, 0.01 * k).penetration,
                          probe(NULL, side, 0.01 * k).penetration, 1e-14);
        }
    }
}

static void null_pointers_are_refused(void) {
    static double memory[MEMORY_DOUBLES];
    gm_flanks *flanks;
    double values[12] = {0.0};
    GM_ASSERT_INT(gm_flanks_init(NULL, &small_sizes, memory, sizeof memory), GM_ERR_NULL);
    GM_ASSERT_INT(gm_flanks_init(&flanks, NULL, memory, sizeof memory), GM_ERR_NULL);
    GM_ASSERT_INT(gm_flanks_init(&flanks, &small_sizes, NULL, sizeof memory), GM_ERR_NULL);
    GM_ASSERT_INT(gm_flanks_init(&flanks, &small_sizes, memory, sizeof memory), GM_OK);
    GM_ASSERT_INT(gm_flanks_set_table(NULL, GM_DRIVE, 0, values, 1.0), GM_ERR_NULL);
    GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, 0, NULL, 1.0), GM_ERR_NULL);
    GM_ASSERT_INT(gm_flanks_set_pitch(NULL, GM_DRIVE, 0, 0.0), GM_ERR_NULL);
    const gm_flank_ramp ramp = {1e-6, 0.0, 0.0};
    GM_ASSERT_INT(gm_flanks_set_ramps(NULL, GM_DRIVE, &ramp, 1, 1.0), GM_ERR_NULL);
    GM_ASSERT_INT(gm_flanks_set_ramps(flanks, GM_DRIVE, NULL, 1, 1.0), GM_ERR_NULL);
    GM_ASSERT_INT(gm_flanks_set_ramps(flanks, GM_DRIVE, NULL, 0, 1.0), GM_OK);
}

/* ---------------------------------------------------------------------------------------------
 * Tables
 * ------------------------------------------------------------------------------------------- */

/** Penetration averaged over the mesh periods of one pinion turn: what all teeth add together. */
static double lift_of_all_teeth(const gm_flanks *flanks, int side) {
    enum { STEPS = 900 };
    double lift = 0.0;
    for (int k = 0; k < STEPS; ++k) {
        const double angle = 6.283185307179586 * k / STEPS;
        const gm_penetration real = probe(flanks, side, angle);
        const gm_penetration ideal = probe(NULL, side, angle);
        lift += side == GM_DRIVE ? real.drive - ideal.drive : real.coast - ideal.coast;
    }
    return lift / STEPS;
}

static void each_call_takes_a_place_until_none_is_left(void) {
    gm_flanks *flanks = small_flanks(&small_sizes);
    double values[12];
    constant_table(values, 12, 1e-6);
    GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, 3, values, 1.0), GM_OK);
    GM_ASSERT_INT(flanks->side[GM_DRIVE].count, 1);
    GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, 3, values, 1.0), GM_OK);
    GM_ASSERT_INT(flanks->side[GM_DRIVE].count, 2);
    GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, 5, values, 1.0), GM_ERR_MEMORY);
    GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, GM_ALL_TEETH, values, 1.0), GM_ERR_MEMORY);
    GM_ASSERT_INT(flanks->side[GM_DRIVE].table[5], -1);
    GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_COAST, 5, values, 1.0), GM_OK);
    GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_COAST, 5, values, 1.0), GM_ERR_MEMORY);
    gm_flanks_params none = small_sizes;
    none.drive_tables = 0;
    flanks = small_flanks(&none);
    GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, 0, values, 1.0), GM_ERR_MEMORY);
}

static void a_table_serves_its_tooth_or_all(void) {
    gm_flanks *flanks = small_flanks(&small_sizes);
    double values[12];
    constant_table(values, 12, 2e-6);
    GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, 7, values, 1.0), GM_OK);
    const double one = lift_of_all_teeth(flanks, GM_DRIVE);
    constant_table(values, 12, 1e-6);
    GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, GM_ALL_TEETH, values, 1.0), GM_OK);
    const double all = lift_of_all_teeth(flanks, GM_DRIVE);
    /* 45 teeth with 1 um each against one with 2 um: the sampling of 20 steps per pitch is the same for each
     * tooth, so only roundings are left (of 1e-6 m, times contact lengths). */
    GM_ASSERT_REL(all / one, 45.0 / 2.0, 1e-9);
    /* Nothing on the other side. */
    GM_ASSERT_ABS(lift_of_all_teeth(flanks, GM_COAST), 0.0, 1e-18);
}

static void a_later_table_replaces_that_of_its_tooth_alone(void) {
    gm_flanks *flanks = small_flanks(&small_sizes);
    double values[12];
    constant_table(values, 12, 1e-6);
    GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, GM_ALL_TEETH, values, 1.0), GM_OK);
    const double all = lift_of_all_teeth(flanks, GM_DRIVE);
    constant_table(values, 12, 3e-6);
    GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, 44, values, 1.0), GM_OK);
    GM_ASSERT_REL(lift_of_all_teeth(flanks, GM_DRIVE) / all, (44.0 + 3.0) / 45.0, 1e-9);
}

static void the_factor_multiplies_every_node(void) {
    gm_flanks *flanks = small_flanks(&small_sizes);
    double values[12];
    for (int i = 0; i < 12; ++i) {
        values[i] = 1e-6 * (i % 5);
    }
    GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, GM_ALL_TEETH, values, 1.0), GM_OK);
    const double plain = lift_of_all_teeth(flanks, GM_DRIVE);
    GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, GM_ALL_TEETH, values, 1.25), GM_OK);
    GM_ASSERT_REL(lift_of_all_teeth(flanks, GM_DRIVE), 1.25 * plain, 1e-9);
}

static void the_callers_table_is_copied(void) {
    gm_flanks *flanks = small_flanks(&small_sizes);
    double values[12];
    constant_table(values, 12, 1e-6);
    GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, GM_ALL_TEETH, values, 1.0), GM_OK);
    const double before = probe(flanks, GM_DRIVE, 0.1).drive;
    constant_table(values, 12, 5e-6);
    GM_ASSERT_REL(probe(flanks, GM_DRIVE, 0.1).drive, before, 0.0);
}

static void pitch_deviations_replace_each_other(void) {
    gm_flanks *flanks = small_flanks(&small_sizes);
    GM_ASSERT_INT(gm_flanks_set_pitch(flanks, GM_COAST, GM_ALL_TEETH, 2e-6), GM_OK);
    const double all = lift_of_all_teeth(flanks, GM_COAST);
    GM_ASSERT_INT(gm_flanks_set_pitch(flanks, GM_COAST, 0, 4e-6), GM_OK);
    GM_ASSERT_REL(lift_of_all_teeth(flanks, GM_COAST) / all, 46.0 / 45.0, 1e-9);
    GM_ASSERT_INT(gm_flanks_set_pitch(flanks, GM_COAST, 0, 2e-6), GM_OK);
    GM_ASSERT_REL(lift_of_all_teeth(flanks, GM_COAST), all, 1e-12);
    GM_ASSERT_ABS(lift_of_all_teeth(flanks, GM_DRIVE), 0.0, 1e-18);
}

/* Which pairs can touch is decided by `peak`: it has to follow every change, down as well as up. */
static void peak_is_the_most_material_of_any_tooth(void) {
    gm_flanks *flanks = small_flanks(&small_sizes);
    GM_ASSERT_REL(flanks->side[GM_DRIVE].peak, 0.0, 0.0);
    double values[12];
    constant_table(values, 12, -3e-6);
    values[5] = -1e-6;
    GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, GM_ALL_TEETH, values, 1.0), GM_OK);
    GM_ASSERT_REL(flanks->side[GM_DRIVE].peak, -1e-6, 1e-15);
    GM_ASSERT_INT(gm_flanks_set_pitch(flanks, GM_DRIVE, 44, 4e-6), GM_OK);
    GM_ASSERT_REL(flanks->side[GM_DRIVE].peak, 3e-6, 1e-14);
    GM_ASSERT_INT(gm_flanks_set_pitch(flanks, GM_DRIVE, 44, -4e-6), GM_OK);
    GM_ASSERT_REL(flanks->side[GM_DRIVE].peak, -1e-6, 1e-14);
    constant_table(values, 12, 7e-6);
    GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, 20, values, 1.0), GM_OK);
    GM_ASSERT_REL(flanks->side[GM_DRIVE].peak, 7e-6, 1e-14);
    GM_ASSERT_INT(gm_flanks_set_pitch(flanks, GM_DRIVE, GM_ALL_TEETH, -1e-6), GM_OK);
    GM_ASSERT_REL(flanks->side[GM_DRIVE].peak, 6e-6, 1e-14);
    GM_ASSERT_REL(flanks->side[GM_COAST].peak, 0.0, 0.0);
}

/* Whatever is changed, in any order: against a list of the highest node and the pitch of each tooth. */
static void peak_follows_every_change(void) {
    enum { TEETH = 7, TABLES = 8, NODES = 6 };
    const gm_flanks_params sizes = {.teeth = TEETH,
                                    .drive_tables = TABLES,
                                    .drive_face_nodes = 2,
                                    .drive_profile_nodes = 3,
                                    .coast_tables = TABLES,
                                    .coast_face_nodes = 3,
                                    .coast_profile_nodes = 2};
    uint64_t seed = 11;
    for (int run = 0; run < 40; ++run) {
        gm_flanks *flanks = small_flanks(&sizes);
        double highest[2][TEETH] = {{0.0}}, pitch[2][TEETH] = {{0.0}};
        int places[2] = {0, 0};

        for (int change = 0; change < 60; ++change) {
            gm_test_context("run %d, change %d", run, change);
            const int side = (int)gm_test_uniform(&seed, 0.0, 2.0);
            const int tooth = (int)gm_test_uniform(&seed, -1.0, TEETH) + (change % 9 ? 0 : -1);
            const int one = tooth < 0 ? GM_ALL_TEETH : tooth;
            double value = gm_test_uniform(&seed, -5e-6, 5e-6);

            /* A table or a pitch, of one tooth or all; and which deviation is the highest now. */
            if (change % 4 == 0 && places[side] < TABLES) {
                double values[NODES];
                value = -1.0;
                for (int k = 0; k < NODES; ++k) {
                    values[k] = gm_test_uniform(&seed, -9e-6, 3e-6);
                    value = fmax(value, values[k]);
                }

                GM_ASSERT_INT(gm_flanks_set_table(flanks, side, one, values, 1.0), GM_OK);
                ++places[side];
                for (int k = 0; k < TEETH; ++k) {
                    highest[side][k] = one == GM_ALL_TEETH || one == k ? value : highest[side][k];
                }
            } else {
                GM_ASSERT_INT(gm_flanks_set_pitch(flanks, side, one, value), GM_OK);
                for (int k = 0; k < TEETH; ++k) {
                    pitch[side][k] = one == GM_ALL_TEETH || one == k ? value : pitch[side][k];
                }
            }

            for (int s = GM_DRIVE; s <= GM_COAST; ++s) {
                double expected = -1.0;
                for (int k = 0; k < TEETH; ++k) {
                    expected = fmax(expected, highest[s][k] + pitch[s][k]);
                }
                GM_ASSERT_ABS(gm_flanks_peak(flanks, s), expected, 1e-20);
            }
        }
    }
    gm_test_context("%s", "");
}

/* Rows lie one behind the other, and tables too; a step from one to the next is none of the profile. */
static void slope_is_that_of_the_steepest_cell_within_a_row(void) {
    enum { FACES = 3, PROFILES = 5, TABLES = 3 };
    const gm_flanks_params sizes = {.teeth = 45,
                                    .drive_tables = TABLES,
                                    .drive_face_nodes = FACES,
                                    .drive_profile_nodes = PROFILES,
                                    .coast_face_nodes = 2,
                                    .coast_profile_nodes = 2};
    uint64_t seed = 12;
    for (int run = 0; run < 60; ++run) {
        gm_test_context("run %d", run);
        gm_flanks *flanks = small_flanks(&sizes);
        double steepest = 0.0;
        for (int table = 0; table < TABLES; ++table) {
            double values[FACES][PROFILES];
            for (int face = 0; face < FACES; ++face) {
                const double height = gm_test_uniform(&seed, -50e-6, 50e-6);
                for (int k = 0; k < PROFILES; ++k) {
                    values[face][k] = height + gm_test_uniform(&seed, -1e-6, 1e-6);
                    steepest = k == 0 ? steepest
                                      : fmax(steepest, fabs(values[face][k] - values[face][k - 1]));
                }
            }
            GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, table, &values[0][0], 1.0), GM_OK);
        }
        GM_ASSERT_REL(gm_flanks_profile_slope(flanks, GM_DRIVE), steepest * (PROFILES - 1), 1e-9);
    }
    gm_test_context("%s", "");
}

/* Memory that is not clean, and no flanks where there can be none. */
static void memory_may_hold_anything_before(void) {
    static double memory[MEMORY_DOUBLES];
    gm_flanks *flanks;
    memset(memory, 0x5a, sizeof memory);
    GM_ASSERT_INT(gm_flanks_init(&flanks, &small_sizes, memory, sizeof memory), GM_OK);
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        GM_ASSERT(gm_flanks_peak(flanks, side) == 0.0);
        GM_ASSERT(gm_flanks_profile_slope(flanks, side) == 0.0);
        const gm_penetration real = probe(flanks, side, 0.1), ideal = probe(NULL, side, 0.1);
        GM_ASSERT_REL(real.drive, ideal.drive, 1e-11);
        GM_ASSERT_REL(real.coast, ideal.coast, 1e-11);
    }

    gm_flanks_params wrong = small_sizes;
    wrong.teeth = 0;
    GM_ASSERT_INT(gm_flanks_init(&flanks, &wrong, memory, sizeof memory), GM_ERR_PARAMETER);
    GM_ASSERT(flanks == NULL);
    flanks = (gm_flanks *)memory;
    GM_ASSERT_INT(gm_flanks_init(&flanks, &small_sizes, memory, 8), GM_ERR_MEMORY);
    GM_ASSERT(flanks == NULL);
    flanks = (gm_flanks *)memory;
    GM_ASSERT_INT(gm_flanks_init(&flanks, &small_sizes, NULL, sizeof memory), GM_ERR_NULL);
    GM_ASSERT(flanks == NULL);
}

/* ---------------------------------------------------------------------------------------------
 * Ramps
 * ------------------------------------------------------------------------------------------- */

/* A ramp that is as high everywhere is a pitch deviation of all teeth. */
static void ramps_replace_each_other_and_take_the_factor(void) {
    gm_flanks_params sizes = small_sizes;
    sizes.drive_tables = sizes.coast_tables = 0;
    gm_flanks *flanks = small_flanks(&sizes);
    GM_ASSERT_INT(gm_flanks_set_pitch(flanks, GM_DRIVE, GM_ALL_TEETH, -0.5e-6), GM_OK);
    const double expected = probe(flanks, GM_DRIVE, 0.1).drive;
    flanks = small_flanks(&sizes);
    const gm_flank_ramp halves[] = {{0.2e-6, 0.0, 0.0}, {0.2e-6, 0.0, 0.0}};
    GM_ASSERT_INT(gm_flanks_set_ramps(flanks, GM_DRIVE, halves, 1, 7.0), GM_OK);
    GM_ASSERT_INT(gm_flanks_set_ramps(flanks, GM_DRIVE, halves, 2, 1.25), GM_OK);
    GM_ASSERT_INT(flanks->side[GM_DRIVE].face_nodes, 2);
    GM_ASSERT_REL(probe(flanks, GM_DRIVE, 0.1).drive, expected, 1e-9);
    GM_ASSERT_REL(probe(flanks, GM_COAST, 0.1).coast, probe(NULL, GM_COAST, 0.1).coast, 1e-14);
    GM_ASSERT_INT(gm_flanks_set_ramps(flanks, GM_DRIVE, NULL, 0, 1.0), GM_OK);
    GM_ASSERT_REL(probe(flanks, GM_DRIVE, 0.1).drive, probe(NULL, GM_DRIVE, 0.1).drive, 1e-14);
    GM_ASSERT_INT(flanks->side[GM_DRIVE].face_nodes, 0);
    /* there is still no room for a table */
    const double values[12] = {0.0};
    GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, 0, values, 1.0), GM_ERR_MEMORY);
}

static void ramps_that_cannot_be_change_nothing(void) {
    gm_flanks *flanks = small_flanks(&small_sizes);
    gm_flank_ramp ramps[GM_FLANK_RAMPS_MAX + 1];
    for (int k = 0; k <= GM_FLANK_RAMPS_MAX; ++k) {
        ramps[k] = (gm_flank_ramp){1e-6, -2e-6, 0.5e-6};
    }
    GM_ASSERT_INT(gm_flanks_set_ramps(flanks, GM_COAST, ramps, GM_FLANK_RAMPS_MAX, 1.0), GM_OK);
    GM_ASSERT_INT(flanks->side[GM_COAST].ramp_count, GM_FLANK_RAMPS_MAX);
    const gm_flanks before = *flanks;
    GM_ASSERT_INT(gm_flanks_set_ramps(flanks, 2, ramps, 1, 1.0), GM_ERR_TOOTH);
    GM_ASSERT_INT(gm_flanks_set_ramps(flanks, -1, ramps, 1, 1.0), GM_ERR_TOOTH);
    GM_ASSERT_INT(gm_flanks_set_ramps(flanks, GM_COAST, ramps, -1, 1.0), GM_ERR_PARAMETER);
    GM_ASSERT_INT(gm_flanks_set_ramps(flanks, GM_COAST, ramps, GM_FLANK_RAMPS_MAX + 1, 1.0),
                  GM_ERR_PARAMETER);
    static const double factors[] = {0.0, -1.0, NAN};
    for (int k = 0; k < 3; ++k) {
        GM_ASSERT_INT(gm_flanks_set_ramps(flanks, GM_COAST, ramps, 1, factors[k]),
                      GM_ERR_PARAMETER);
    }
    static const double bad[] = {NAN, HUGE_VAL, -HUGE_VAL, 1e308, -0.51e30};
    for (int k = 0; k < 5; ++k) {
        for (int field = 0; field < 3; ++field) {
            gm_test_context("field %d = %g", field, bad[k]);
            gm_flank_ramp wrong[2] = {{3e-6, 0.0, 0.0}, {0.0, 0.0, 0.0}};
            double *const fields[] = {&wrong[1].offset, &wrong[1].per_t1, &wrong[1].per_t2};
            *fields[field] = bad[k];
            GM_ASSERT_INT(gm_flanks_set_ramps(flanks, GM_COAST, wrong, 2, 2.0), GM_ERR_DEVIATION);
        }
    }
    GM_ASSERT(memcmp(&before, flanks, sizeof before) == 0);
}

/* ---------------------------------------------------------------------------------------------
 * Refusals
 * ------------------------------------------------------------------------------------------- */

static void teeth_and_sides_that_do_not_exist_are_refused(void) {
    gm_flanks *flanks = small_flanks(&small_sizes);
    const double values[12] = {0.0};
    static const struct {
        int side;
        int tooth;
    } wrong[] = {{GM_DRIVE, 45}, {GM_DRIVE, -2}, {GM_COAST, 1000},
                 {2, 0},         {-1, 0},        {2, GM_ALL_TEETH}};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; ++i) {
        gm_test_context("side %d, tooth %d", wrong[i].side, wrong[i].tooth);
        GM_ASSERT_INT(gm_flanks_set_table(flanks, wrong[i].side, wrong[i].tooth, values, 1.0),
                      GM_ERR_TOOTH);
        GM_ASSERT_INT(gm_flanks_set_pitch(flanks, wrong[i].side, wrong[i].tooth, 0.0),
                      GM_ERR_TOOTH);
    }
    GM_ASSERT_INT(flanks->side[GM_DRIVE].count, 0);
    GM_ASSERT_INT(flanks->side[GM_COAST].count, 0);
}

static void deviations_that_are_no_numbers_change_nothing(void) {
    gm_flanks *flanks = small_flanks(&small_sizes);
    double values[12];
    constant_table(values, 12, 1e-6);
    GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, GM_ALL_TEETH, values, 1.0), GM_OK);
    GM_ASSERT_INT(gm_flanks_set_pitch(flanks, GM_DRIVE, GM_ALL_TEETH, 0.5e-6), GM_OK);

    const gm_flanks before = *flanks;
    const double drive = probe(flanks, GM_DRIVE, 0.1).drive;

    /* In a node, as the scale of a table, as pitch. */
    static const double bad[] = {NAN, HUGE_VAL, -HUGE_VAL, 1.01, -1.01, 1e80, -1e300};
    for (size_t k = 0; k < sizeof bad / sizeof bad[0]; ++k) {
        for (int node = 0; node < 12; node += 11) {
            gm_test_context("node %d = %g", node, bad[k]);
            constant_table(values, 12, 9e-6);
            values[node] = bad[k];
            GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, GM_ALL_TEETH, values, 1.0),
                          GM_ERR_DEVIATION);
        }
        constant_table(values, 12, 1.0);
        GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, 0, values, bad[k]), GM_ERR_DEVIATION);
        GM_ASSERT_INT(gm_flanks_set_pitch(flanks, GM_DRIVE, 0, bad[k]), GM_ERR_DEVIATION);
        GM_ASSERT_INT(gm_flanks_set_pitch(flanks, GM_DRIVE, GM_ALL_TEETH, bad[k]),
                      GM_ERR_DEVIATION);
    }
    /* A product that overflows is no number either. */
    constant_table(values, 12, 1e200);
    GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, 0, values, 1e200), GM_ERR_DEVIATION);
    GM_ASSERT(memcmp(&before, flanks, sizeof before) == 0);
    GM_ASSERT_REL(probe(flanks, GM_DRIVE, 0.1).drive, drive, 0.0);
}

/* A metre of material on one gear and a metre less on the other, in all combinations: nothing overflows. */
static void the_largest_deviations_give_numbers(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    gm_flanks *flanks = small_flanks(&small_sizes);
    double values[12];
    for (int i = 0; i < 12; ++i) {
        values[i] = i % 2 == 0 ? 1.0 : -1.0;
    }
    GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, GM_ALL_TEETH, values, 1.0), GM_OK);
    for (int sign = -1; sign <= 1; sign += 2) {
        GM_ASSERT_INT(gm_flanks_set_pitch(flanks, GM_DRIVE, GM_ALL_TEETH, sign), GM_OK);
        gm_position position;
        gm_penetration r;
        gm_wrench w;
        GM_ASSERT_INT(gm_position_from_pinion_angle(&pair, 0.1, 1e-3, -1e9, &position), GM_OK);
        GM_ASSERT_INT(penetration_3d_at(&pair, flanks, NULL, &position, &r), GM_OK);
        GM_ASSERT(isfinite(r.drive) && isfinite(r.rate) && isfinite(r.d_pinion_angle) &&
                  isfinite(r.d_wheel_angle));
        gm_mesh_result whole;
        GM_ASSERT_INT(
            plain_evaluate(&pair, flanks, NULL, &position, 1e30, 1e30, GM_WANT_DERIVATIVES, &whole),
            GM_OK);
        GM_ASSERT(isfinite(whole.force) && isfinite(whole.force_by.pinion_angle));
        GM_ASSERT_INT(wrench_3d_at(&pair, flanks, NULL, &position, 1e30, 1e30, &w), GM_OK);
        for (int k = 0; k < 3; ++k) {
            GM_ASSERT(isfinite(w.pinion_force[k]) && isfinite(w.pinion_moment[k]));
            GM_ASSERT(isfinite(w.wheel_force[k]) && isfinite(w.wheel_moment[k]));
        }
    }
}

/* Bounds that a solver looks ahead with, and the depth: the highest point of any tooth, the steepest profile. */
static void peak_slope_and_depth_are_those_of_the_deepest_tooth(void) {
    gm_flanks_params sizes = small_sizes;
    sizes.drive_face_nodes = 3;
    sizes.drive_profile_nodes = 4;
    gm_flanks *flanks = small_flanks(&sizes);
    GM_ASSERT_ABS(gm_flanks_profile_slope(flanks, GM_DRIVE), 0.0, 0.0);
    const double values[12] = {0.0, 1e-6, 1e-6, 0.0, 0.0, 0.0, 0.0, 0.0, 2e-6, -3e-6, 0.0, 0.0};
    GM_ASSERT_INT(gm_flanks_set_table(flanks, GM_DRIVE, 7, values, 2.0), GM_OK);
    GM_ASSERT_INT(gm_flanks_set_pitch(flanks, GM_DRIVE, 7, 1e-6), GM_OK);
    GM_ASSERT_REL(gm_flanks_peak(flanks, GM_DRIVE), 5e-6, 1e-15);
    GM_ASSERT_ABS(gm_flanks_peak(flanks, GM_COAST), 0.0, 0.0);

    /* From 2 um to -3 um, doubled, over a third of the profile. */
    GM_ASSERT_REL(gm_flanks_profile_slope(flanks, GM_DRIVE), 10e-6 * 3.0, 1e-14);
    GM_ASSERT_REL(gm_flanks_depth(flanks, GM_DRIVE), 10e-6, 1e-14);

    /* Reliefs add their slopes; at a corner of the flank these take off 0 and 3 um together, or 1 um and 0. */
    const gm_flank_ramp ramps[2] = {{0.0, 1e-6, -4e-6}, {0.0, 0.0, 3e-6}};
    GM_ASSERT_INT(gm_flanks_set_ramps(flanks, GM_DRIVE, ramps, 2, 1.0), GM_OK);
    GM_ASSERT_REL(gm_flanks_profile_slope(flanks, GM_DRIVE), 37e-6, 1e-14);
    GM_ASSERT_REL(gm_flanks_depth(flanks, GM_DRIVE), 13e-6, 1e-14);
    GM_ASSERT_ABS(gm_flanks_depth(flanks, GM_COAST), 0.0, 0.0);
    GM_ASSERT_ABS(gm_flanks_profile_slope(flanks, GM_COAST), 0.0, 0.0);

    GM_ASSERT_ABS(gm_flanks_peak(NULL, GM_DRIVE), 0.0, 0.0);
    GM_ASSERT_ABS(gm_flanks_profile_slope(NULL, GM_COAST), 0.0, 0.0);
    GM_ASSERT_ABS(gm_flanks_depth(NULL, GM_DRIVE), 0.0, 0.0);
    GM_ASSERT_NAN(gm_flanks_peak(flanks, 2));
    GM_ASSERT_NAN(gm_flanks_depth(flanks, 2));
    GM_ASSERT_NAN(gm_flanks_profile_slope(flanks, -1));
    GM_ASSERT_INT(gm_flanks_teeth(flanks), 45);
    GM_ASSERT_INT(gm_flanks_teeth(NULL), 0);
}

static void flanks_of_another_gear_are_refused(void) {
    gm_flanks_params sizes = small_sizes;
    sizes.teeth = 44;
    const gm_flanks *flanks = small_flanks(&sizes);
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const gm_state state = {.pinion_angle = 0.1, .wheel_angle = 0.1 * 45.0 / 41.0};
    gm_position position;
    gm_penetration r;
    gm_wrench w;
    GM_ASSERT_INT(gm_position_from_state(&pair, &state, &position), GM_OK);
    for (int gear = 0; gear < 2; ++gear) {
        gm_test_context("gear %d", gear);
        const gm_flanks *pinion = gear == 0 ? flanks : NULL;
        const gm_flanks *wheel = gear == 1 ? flanks : NULL;
        r.penetration = 0.0;
        GM_ASSERT_INT(gm_penetration_3d(&pair, pinion, wheel, &state, &r), GM_ERR_TOOTH);
        GM_ASSERT_NAN(r.penetration);
        r.penetration = 0.0;
        GM_ASSERT_INT(penetration_3d_at(&pair, pinion, wheel, &position, &r), GM_ERR_TOOTH);
        GM_ASSERT_NAN(r.penetration);
        w.wheel_force[0] = 0.0;
        GM_ASSERT_INT(wrench_3d_at(&pair, pinion, wheel, &position, 1e8, 0.0, &w), GM_ERR_TOOTH);
        GM_ASSERT_NAN(w.wheel_force[0]);
    }
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(size_grows_with_everything),
        GM_TEST(nodes_of_a_side_without_tables_are_ignored),
        GM_TEST(sizes_out_of_range_are_refused),
        GM_TEST(a_size_beyond_the_machine_is_refused),
        GM_TEST(memory_is_used_up_to_its_size_and_no_further),
        GM_TEST(fresh_flanks_are_ideal),
        GM_TEST(null_pointers_are_refused),
        GM_TEST(each_call_takes_a_place_until_none_is_left),
        GM_TEST(a_table_serves_its_tooth_or_all),
        GM_TEST(a_later_table_replaces_that_of_its_tooth_alone),
        GM_TEST(the_factor_multiplies_every_node),
        GM_TEST(the_callers_table_is_copied),
        GM_TEST(pitch_deviations_replace_each_other),
        GM_TEST(peak_is_the_most_material_of_any_tooth),
        GM_TEST(peak_follows_every_change),
        GM_TEST(slope_is_that_of_the_steepest_cell_within_a_row),
        GM_TEST(memory_may_hold_anything_before),
        GM_TEST(ramps_replace_each_other_and_take_the_factor),
        GM_TEST(ramps_that_cannot_be_change_nothing),
        GM_TEST(teeth_and_sides_that_do_not_exist_are_refused),
        GM_TEST(deviations_that_are_no_numbers_change_nothing),
        GM_TEST(the_largest_deviations_give_numbers),
        GM_TEST(peak_slope_and_depth_are_those_of_the_deepest_tooth),
        GM_TEST(flanks_of_another_gear_are_refused),
    };
    return gm_test_main("unit.flank", tests, GM_TEST_COUNT(tests), argc, argv);
}
