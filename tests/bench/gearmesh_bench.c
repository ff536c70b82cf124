/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * What an evaluation costs. `gearmesh_bench --help` says how to ask; scripts/bench asks everything.
 *
 * Every measurement goes through the same 256 states in quasi-static equilibrium at 20 N m, all over the hunting
 * period. Times are the shortest of several repetitions in processor time; instructions are for callgrind:
 * `--count CASE N` does nothing but set up and evaluate N times, the latter within the function counted().
 */
#include "bench_gears.h"
#include "slices.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { REPETITIONS = 7, NAME_MAX_LENGTH = 40, COUNTS_MAX = 64 };

static const double shortest_batch_s = 0.02;

#if defined(__GNUC__)
#define NEVER_INLINED __attribute__((noinline))
#else
#define NEVER_INLINED
#endif

typedef struct bench {
    const bench_gears *gears;
    int slices;
} bench;

/* What the evaluations give must be used, or the compiler leaves them out. */
static volatile double sink;

/* ---------------------------------------------------------------------------------------------
 * The cases: each evaluates `count` times
 * ------------------------------------------------------------------------------------------- */

static void run_positions(const bench *b, long count, int wanted) {
    const bench_gears *g = b->gears;
    gm_mesh_result result;
    double sum = 0.0;
    for (long k = 0; k < count; ++k) {
        (void)gm_mesh_evaluate_at(g->mesh, &g->positions[k % BENCH_STATES], wanted, NULL, &result);
        sum += result.force;
    }
    sink = sum;
}

static void run_force(const bench *b, long count) {
    run_positions(b, count, GM_WANT_FORCE);
}

static void run_derivatives(const bench *b, long count) {
    run_positions(b, count, GM_WANT_DERIVATIVES);
}

static void run_wrench(const bench *b, long count) {
    run_positions(b, count, GM_WANT_WRENCH);
}

static void run_energy(const bench *b, long count) {
    run_positions(b, count, GM_WANT_ENERGY);
}

/*
 * As a solver with shafts that bend asks: another pose at every call. A shift along the axis moves the face lines of both
 * tables apart.
 */
static gm_motion bench_motion(const bench_gears *g, long k, double axial_shift) {
    const double part = (double)(k % BENCH_STATES) / BENCH_STATES;
    const gm_motion motion = {
        g->positions[k % BENCH_STATES],
        {1e-6 * part, 1e-7 * part, axial_shift * part, 1e-5 * part, -1e-5 * part},
        {0.0, 0.0, 0.0, 0.0, 0.0},
    };
    return motion;
}

static const double bench_shift = 2e-6;

static void evaluate_posed(const bench *b, long count, double axial_shift) {
    gm_mesh_result result;
    double sum = 0.0;
    for (long k = 0; k < count; ++k) {
        const gm_motion motion = bench_motion(b->gears, k, axial_shift);
        (void)gm_mesh_evaluate_posed(b->gears->mesh, &motion, GM_WANT_FORCE, NULL, &result);
        sum += result.force;
    }
    sink = sum;
}

static void run_posed(const bench *b, long count) {
    evaluate_posed(b, count, bench_shift);
}

static void run_tilted(const bench *b, long count) {
    evaluate_posed(b, count, 0.0);
}

static void differentiate(const bench *b, long count, double axial_shift) {
    gm_tangent tangent;
    double sum = 0.0;
    for (long k = 0; k < count; ++k) {
        const gm_motion motion = bench_motion(b->gears, k, axial_shift);
        (void)gm_mesh_tangent(b->gears->mesh, &motion, &tangent);
        sum += tangent.force_by[GM_SKEW];
    }
    sink = sum;
}

static void run_tangent(const bench *b, long count) {
    differentiate(b, count, bench_shift);
}

static void run_tilted_tangent(const bench *b, long count) {
    differentiate(b, count, 0.0);
}

static void run_angles(const bench *b, long count) {
    const bench_gears *g = b->gears;
    gm_mesh_result result;
    double sum = 0.0;
    for (long k = 0; k < count; ++k) {
        (void)gm_mesh_evaluate(g->mesh, &g->states[k % BENCH_STATES], GM_WANT_DERIVATIVES, NULL,
                               &result);
        sum += result.force;
    }
    sink = sum;
}

static void run_equilibrium(const bench *b, long count) {
    const bench_gears *g = b->gears;
    double offset, sum = 0.0;
    for (long k = 0; k < count; ++k) {
        (void)gm_static_equilibrium(g->mesh, g->states[k % BENCH_STATES].pinion_angle, BENCH_TORQUE,
                                    (double)NAN, NULL, &offset, NULL);
        sum += offset;
    }
    sink = sum;
}

/* A curve of 1000 positions over one turn of the pinion, each begun from the one before. */
static void run_curve(const bench *b, long count) {
    enum { POSITIONS = 1000 };
    const bench_gears *g = b->gears;
    const double step = 6.283185307179586 / POSITIONS;
    double guess = 0.0, offset, sum = 0.0;
    gm_mesh_result result;
    for (long k = 0; k < count * POSITIONS; ++k) {
        (void)gm_static_equilibrium(g->mesh, step * (double)(k % POSITIONS), BENCH_TORQUE,
                                    k % POSITIONS == 0 ? (double)NAN : guess, NULL, &offset,
                                    &result);
        guess = offset + step * (g->pair.pinion.base_radius + g->pair.wheel.base_radius *
                                                                  result.force_by.pinion_angle /
                                                                  result.force_by.wheel_angle);
        sum += offset;
    }
    sink = sum;
}

static void run_slices(const bench *b, long count, enum slice_pairs pairs) {
    const bench_gears *g = b->gears;
    double sum = 0.0;
    for (long k = 0; k < count; ++k) {
        sum += slices_sum(&g->pair, g->flanks[GM_PINION], g->flanks[GM_WHEEL],
                          &g->positions[k % BENCH_STATES], b->slices, pairs);
    }
    sink = sum;
}

static void run_slices_all(const bench *b, long count) {
    run_slices(b, count, SLICES_ALL_TEETH);
}

static void run_slices_touching(const bench *b, long count) {
    run_slices(b, count, SLICES_TOUCHING);
}

/* Which flanks. */
enum { IDEAL, TABLES, RAMPS, RELIEF_TABLE, TABLES_AND_RAMPS, FLANKS };

typedef struct bench_case {
    const char *name;
    const char *text;
    int flanks;
    void (*run)(const bench *b, long count);
} bench_case;

static const bench_case cases[] = {
    {"ideal.force", "ideal flanks, force", IDEAL, run_force},
    {"ideal.derivatives", "   with exact derivatives", IDEAL, run_derivatives},
    {"ideal.angles", "   from angles, with derivatives", IDEAL, run_angles},
    {"ideal.wrench", "   wrench", IDEAL, run_wrench},
    {"ideal.energy", "   force and stored energy", IDEAL, run_energy},
    {"ideal.equilibrium", "   equilibrium", IDEAL, run_equilibrium},
    {"ideal.curve", "   static curve, 1000 positions", IDEAL, run_curve},
    {"tables.force", "tables, force", TABLES, run_force},
    {"tables.derivatives", "   with exact derivatives", TABLES, run_derivatives},
    {"tables.angles", "   from angles, with derivatives", TABLES, run_angles},
    {"tables.wrench", "   wrench", TABLES, run_wrench},
    {"tables.energy", "   force and stored energy", TABLES, run_energy},
    {"tables.posed", "   force, in a pose of each call", TABLES, run_posed},
    {"tables.tangent", "   all derivatives of force and wrench there", TABLES, run_tangent},
    {"tables.tilted", "   force, there without a shift along the axis", TABLES, run_tilted},
    {"tables.tilted_tangent", "   all derivatives there", TABLES, run_tilted_tangent},
    {"tables.equilibrium", "   equilibrium", TABLES, run_equilibrium},
    {"tables.curve", "   static curve, 1000 positions", TABLES, run_curve},
    {"ramps.force", "linear reliefs, force", RAMPS, run_force},
    {"ramps.derivatives", "   with exact derivatives", RAMPS, run_derivatives},
    {"ramps.wrench", "   wrench", RAMPS, run_wrench},
    {"relief_table.force", "the same in a fine table, force", RELIEF_TABLE, run_force},
    {"relief_table.derivatives", "   with exact derivatives", RELIEF_TABLE, run_derivatives},
    {"relief_table.wrench", "   wrench", RELIEF_TABLE, run_wrench},
    {"both.force", "tables and linear reliefs, force", TABLES_AND_RAMPS, run_force},
    {"both.derivatives", "   with exact derivatives", TABLES_AND_RAMPS, run_derivatives},
    {"slices.all", "slices, all teeth", TABLES, run_slices_all},
    {"slices.touching", "slices, pairs that can touch", TABLES, run_slices_touching},
};
enum { CASES = sizeof cases / sizeof cases[0] };

static const bench_case *find_case(const char *name) {
    for (int k = 0; k < CASES; ++k) {
        if (strcmp(cases[k].name, name) == 0) {
            return &cases[k];
        }
    }
    fprintf(stderr, "gearmesh_bench: no such case: %s; there are:", name);
    for (int k = 0; k < CASES; ++k) {
        fprintf(stderr, " %s", cases[k].name);
    }
    fprintf(stderr, "\n");
    exit(2);
}

/* ---------------------------------------------------------------------------------------------
 * Time
 * ------------------------------------------------------------------------------------------- */

/* A function of its own, which callgrind finds by its name and which does not end with the call. */
NEVER_INLINED static void counted(const bench_case *c, const bench *b, long count) {
    c->run(b, count);
    sink += 0.0;
}

static double batch_seconds(const bench_case *c, const bench *b, long count) {
    const clock_t begin = clock();
    c->run(b, count);
    return (double)(clock() - begin) / CLOCKS_PER_SEC;
}

/* Seconds of one evaluation: the shortest of the repetitions. */
static double measure(const bench_case *c, const bench *b) {
    long count = 1;
    double shortest = batch_seconds(c, b, count);
    while (shortest < shortest_batch_s) {
        count *= shortest < 0.1 * shortest_batch_s ? 8 : 2;
        shortest = batch_seconds(c, b, count);
    }
    for (int k = 1; k < REPETITIONS; ++k) {
        shortest = fmin(shortest, batch_seconds(c, b, count));
    }
    return shortest / (double)count;
}

/* ---------------------------------------------------------------------------------------------
 * Commands
 * ------------------------------------------------------------------------------------------- */

/* Instructions counted elsewhere: lines "case,instructions" of a file. */
typedef struct counts {
    int number;
    char name[COUNTS_MAX][NAME_MAX_LENGTH + 1];
    double value[COUNTS_MAX];
} counts;

static int read_counts(counts *read, const char *file_name) {
    FILE *file = fopen(file_name, "r");
    char line[200];
    if (file == NULL) {
        perror(file_name);
        return 2;
    }
    while (read->number < COUNTS_MAX && fgets(line, sizeof line, file) != NULL) {
        if (sscanf(line, "%40[^,],%lf", read->name[read->number], &read->value[read->number]) ==
            2) {
            ++read->number;
        }
    }
    fclose(file);
    return 0;
}

static double count_of(const counts *read, const char *name) {
    for (int k = 0; k < read->number; ++k) {
        if (strcmp(read->name[k], name) == 0) {
            return read->value[k];
        }
    }
    return (double)NAN;
}

static void print_table(const bench_gears gears[FLANKS], const counts *counted) {
    printf("%-34s %14s %14s %14s\n", "", "evaluations/s", "ns", "instructions");
    for (int k = 0; k < CASES; ++k) {
        const bench b = {&gears[cases[k].flanks], 51};
        const double seconds = measure(&cases[k], &b);
        const double instructions = count_of(counted, cases[k].name);
        printf("%-34s %14.0f %14.1f ", cases[k].text, 1.0 / seconds, 1e9 * seconds);
        if (instructions > 0.0) {
            printf("%14.0f\n", instructions);
        } else {
            printf("%14s\n", "-");
        }
        fflush(stdout);
    }
    printf(
        "\nWith tables: %.2f lines of contact and %.1f smooth pieces per evaluation; slices: 51.\n",
        gears[TABLES].mean_lines, gears[TABLES].mean_pieces);
}

/* Error of the sum, in parts of the mean sum. */
static void slice_errors(const bench *b, double *rms, double *largest) {
    const bench_gears *g = b->gears;
    double squares = 0.0;
    *largest = 0.0;
    for (int k = 0; k < BENCH_STATES; ++k) {
        gm_mesh_result exact;
        bench_check(gm_mesh_evaluate_at(g->mesh, &g->positions[k], GM_WANT_FORCE, NULL, &exact),
                    "evaluation");
        const double sum = slices_sum(&g->pair, g->flanks[GM_PINION], g->flanks[GM_WHEEL],
                                      &g->positions[k], b->slices, SLICES_TOUCHING);
        const double error = (sum - exact.contact.drive) / g->mean_sum;
        squares += error * error;
        *largest = fmax(*largest, fabs(error));
    }
    *rms = sqrt(squares / BENCH_STATES);
}

static void print_slices(const bench_gears *tables) {
    static const int numbers[] = {5, 11, 21, 51, 101, 201, 501, 1001, 2001, 5001, 10001};
    printf("slices,error_rms,error_max,ns\n");
    for (size_t k = 0; k < sizeof numbers / sizeof numbers[0]; ++k) {
        const bench b = {tables, numbers[k]};
        double rms, largest;
        slice_errors(&b, &rms, &largest);
        printf("%d,%.3e,%.3e,%.1f\n", numbers[k], rms, largest,
               1e9 * measure(find_case("slices.touching"), &b));
    }
}

static void print_help(void) {
    puts(
        "gearmesh_bench [--instructions FILE]   the table of all cases, with instructions from "
        "lines case,number\n"
        "gearmesh_bench --count CASE N [OPTION]...   sets up and evaluates N times, for callgrind\n"
        "gearmesh_bench --time CASE [OPTION]...      ns, lines of contact and pieces of one "
        "evaluation as CSV\n"
        "gearmesh_bench --slices                     error and time of slices as CSV\n"
        "\n"
        "Options: --teeth Z, --helix DEGREES, --grid FACE PROFILE (nodes), --angle RADIANS, "
        "--number SLICES");
}

/* Reads the options of --count and --time; returns 0 or 2. */
static int read_options(int argc, char **argv, bench_params *params, int *slices) {
    for (int k = 0; k < argc; ++k) {
        const char *name = argv[k];
        if (strcmp(name, "--teeth") == 0 && k + 1 < argc) {
            params->pinion_teeth = atoi(argv[++k]);
            params->wheel_teeth = params->pinion_teeth + 1;
        } else if (strcmp(name, "--helix") == 0 && k + 1 < argc) {
            params->helix_angle_deg = strtod(argv[++k], NULL);
        } else if (strcmp(name, "--grid") == 0 && k + 2 < argc) {
            params->face_nodes = atoi(argv[++k]);
            params->profile_nodes = atoi(argv[++k]);
        } else if (strcmp(name, "--angle") == 0 && k + 1 < argc) {
            params->first_angle = strtod(argv[++k], NULL);
        } else if (strcmp(name, "--number") == 0 && k + 1 < argc) {
            *slices = atoi(argv[++k]);
        } else {
            fprintf(stderr, "gearmesh_bench: what is %s?\n", name);
            return 2;
        }
    }
    return 0;
}

static bench_params params_of(int flanks) {
    bench_params params = bench_params_default();
    if (flanks != TABLES && flanks != TABLES_AND_RAMPS) {
        params.face_nodes = params.profile_nodes = 0;
    }
    if (flanks == RAMPS || flanks == TABLES_AND_RAMPS) {
        params.reliefs = BENCH_RAMPS;
    }
    if (flanks == RELIEF_TABLE) {
        params.reliefs = BENCH_RELIEF_TABLE;
    }
    return params;
}

/* count < 0: measure the time instead. */
static int run_one(const char *name, long count, int argc, char **argv) {
    static bench_gears gears;
    const bench_case *c = find_case(name);
    bench_params params = params_of(c->flanks);
    bench b = {&gears, 51};
    if (read_options(argc, argv, &params, &b.slices) != 0) {
        return 2;
    }
    bench_gears_make(&gears, &params);
    if (count < 0) {
        printf("%.1f,%.2f,%.1f\n", 1e9 * measure(c, &b), gears.mean_lines, gears.mean_pieces);
    } else {
        counted(c, &b, count);
    }
    bench_gears_free(&gears);
    return 0;
}

static int run_all(const char *command, const char *instructions) {
    static bench_gears gears[FLANKS];
    static counts counted;
    if (instructions != NULL && read_counts(&counted, instructions) != 0) {
        return 2;
    }
    for (int flanks = 0; flanks < FLANKS; ++flanks) {
        const bench_params params = params_of(flanks);
        bench_gears_make(&gears[flanks], &params);
    }
    if (strcmp(command, "--slices") == 0) {
        print_slices(&gears[TABLES]);
    } else {
        print_table(gears, &counted);
    }
    for (int flanks = 0; flanks < FLANKS; ++flanks) {
        bench_gears_free(&gears[flanks]);
    }
    return 0;
}

int main(int argc, char **argv) {
    const char *command = argc > 1 ? argv[1] : "";
    if (strcmp(command, "--count") == 0 && argc >= 4) {
        return run_one(argv[2], atol(argv[3]), argc - 4, argv + 4);
    }
    if (strcmp(command, "--time") == 0 && argc >= 3) {
        return run_one(argv[2], -1, argc - 3, argv + 3);
    }
    if (argc == 1 || strcmp(command, "--slices") == 0) {
        return run_all(command, NULL);
    }
    if (strcmp(command, "--instructions") == 0 && argc == 3) {
        return run_all(command, argv[2]);
    }
    print_help();
    return strcmp(command, "--help") == 0 ? 0 : 2;
}
