/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Loaders, writers and the builder when the C library does not play along. The linker puts the functions
 * __wrap_... below in place of those of the C library (--wrap), so that here every allocation can fail,
 * what is not freed or closed is seen, and the locale has a decimal comma on any machine.
 */
#include "flank.h" /* what the objects hold */
#include "io_test.h"
#include "reference_gear.h"

#define TEETH 5

/* ---------------------------------------------------------------------------------------------
 * Allocations: the n-th fails, those that are alive are counted
 * ------------------------------------------------------------------------------------------- */

static long allocations_to_failure = -1; /* < 0: none fails */
static long alive;
static size_t largest;

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void __real_free(void *memory);
FILE *__real_fopen(const char *path, const char *mode);
int __real_fclose(FILE *file);

void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void __wrap_free(void *memory);
FILE *__wrap_fopen(const char *path, const char *mode);
int __wrap_fclose(FILE *file);

static int must_fail(size_t size) {
    largest = size > largest ? size : largest;
    return allocations_to_failure >= 0 && allocations_to_failure-- == 0;
}

static void *count_alive(void *memory) {
    alive += memory != NULL ? 1 : 0;
    return memory;
}

void *__wrap_malloc(size_t size) {
    return must_fail(size) ? NULL : count_alive(__real_malloc(size));
}

void *__wrap_calloc(size_t count, size_t size) {
    return must_fail(count * size) ? NULL : count_alive(__real_calloc(count, size));
}

void __wrap_free(void *memory) {
    alive -= memory != NULL ? 1 : 0;
    __real_free(memory);
}

static long open_files;

FILE *__wrap_fopen(const char *path, const char *mode) {
    FILE *file = __real_fopen(path, mode);
    open_files += file != NULL ? 1 : 0;
    return file;
}

int __wrap_fclose(FILE *file) {
    --open_files;
    return __real_fclose(file);
}

/* ---------------------------------------------------------------------------------------------
 * A locale with a decimal comma
 * ------------------------------------------------------------------------------------------- */

static int comma_locale;
static int strtod_calls;

double __real_strtod(const char *text, char **end);
double __wrap_strtod(const char *text, char **end);
int __wrap_snprintf(char *text, size_t size, const char *format, ...);

/* As there: a number ends at a point and goes on behind a comma. */
double __wrap_strtod(const char *text, char **end) {
    ++strtod_calls;
    if (!comma_locale) {
        return __real_strtod(text, end);
    }
    char translated[2000];
    snprintf(translated, sizeof translated, "%s", text);
    char *point = strchr(translated, '.');
    if (point != NULL) {
        *point = '\0';
    }
    char *comma = strchr(translated, ',');
    if (comma != NULL) {
        *comma = '.';
    }
    char *stop = NULL;
    const double value = __real_strtod(translated, &stop);
    if (end != NULL) {
        *end = (char *)text + (stop - translated);
    }
    return value;
}

/* As there: the numbers of %g, %e, %f have a comma. */
int __wrap_snprintf(char *text, size_t size, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(text, size, format, arguments);
    va_end(arguments);
    char *point = comma_locale && strpbrk(format, "gef") != NULL && strchr(format, 's') == NULL
                      ? strchr(text, '.')
                      : NULL;
    if (point != NULL) {
        *point = ',';
    }
    return length;
}

/* ---------------------------------------------------------------------------------------------
 * Everything that allocates
 * ------------------------------------------------------------------------------------------- */

#define DEVIATION_HEADER "tooth,flank,t1,t2,deviation_um\n"
#define PITCH_HEADER     "tooth,flank,deviation_um\n"

static const char deviation_text[] = DEVIATION_HEADER
    "*,*,0,0,1\n*,*,0,1,2\n*,*,1,0,3\n*,*,1,1,4\n"
    "4,drive,0,0,1.25e-3\n4,drive,0,1,-0.123456789012345678\n4,drive,1,0,33.3\n4,drive,1,1,1e5\n";
static const char pitch_text[] = PITCH_HEADER "*,*,1.5\n2,drive,-0.123456789012345678\n";

static const char *path;
static gm_deviations deviations;
static gm_pitch pitch;
static gm_flanks *flanks;
static gm_io_error error;

static int read_deviations(void) {
    return gm_deviations_read(&deviations, path, TEETH, &error);
}

static int read_pitch(void) {
    return gm_pitch_read(&pitch, path, TEETH, &error);
}

static int build(void) {
    return gm_flanks_build(&flanks, TEETH, &deviations, &pitch, NULL, NULL, &error);
}

/* The same with a crowning and a ramp on both sides. */
static int build_with_design(void) {
    const gm_modification list[] = {
        {.kind = GM_MOD_CROWNING, .shape = GM_SHAPE_PARABOLIC, .amount = 5e-6},
        {.kind = GM_MOD_END_RELIEF_I, .amount = 5e-6, .face_range = 2e-3}};
    const gm_gear gear = {.teeth = TEETH, .tip_radius = 2e-2, .tip_roll_length = 1e-2};
    const gm_modifications design = {list, 2, &gear, 1e-2};
    gm_flanks_options options;
    gm_flanks_options_default(&options);
    options.drive_modifications = options.coast_modifications = &design;
    return gm_flanks_build(&flanks, TEETH, &deviations, &pitch, &options, NULL, &error);
}

static gm_pair gears;

static int generate(void) {
    gm_generate_options options;
    gm_generate_options_default(&options);
    options.quality_class = 6;
    return gm_flanks_generate(&deviations, &pitch, &gears, 1, &options, &error);
}

static int generate_scatter(void) {
    gm_flank_scatter scatter;
    gm_generate_options options;
    gm_flank_scatter_paper(&scatter);
    gm_generate_options_default(&options);
    options.scatter = &scatter;
    return gm_flanks_generate(&deviations, &pitch, &gears, 0, &options, &error);
}

static int evaluate(void) {
    gm_quality quality;
    return gm_quality_evaluate(&quality, NULL, &gears, 1, &deviations, &pitch, NULL, &error);
}

static gm_traces traces;
static gm_measured_pitch measured;

static gm_measurement measurement(void) {
    gm_measurement how;
    gm_measurement_default(&how);
    how.datum_face = GM_FACE_II;
    how.counting = GM_CLOCKWISE;
    return how;
}

static int read_traces(void) {
    return gm_traces_read(&traces, path, &gears, 0, GM_DECIMAL_POINT, &error);
}

static int read_measured_pitch(void) {
    return gm_measured_pitch_read(&measured, path, GM_DECIMAL_POINT, &error);
}

static int build_traces(void) {
    const gm_measurement how = measurement();
    return gm_traces_build(&deviations, NULL, &traces, &how, &gears, 0, NULL, &error);
}

static int build_measured_pitch(void) {
    const gm_measurement how = measurement();
    return gm_measured_pitch_build(&pitch, NULL, &measured, &how, &gears, 0, &error);
}

static int write_deviations(void) {
    return gm_deviations_write(&deviations, IO_TEST_PATH("out.csv"), &error);
}

static void free_all(void) {
    gm_deviations_free(&deviations);
    gm_pitch_free(&pitch);
    gm_flanks_free(flanks);
    flanks = NULL;
    flanks = NULL;
}

/* Calls with the first, second, third .. allocation failing, until the call needs no more of them. */
static void survives_any_failed_allocation(int (*call)(void), int least) {
    const long alive_before = alive;
    int failures = 0;
    for (; failures < 1000; ++failures) {
        allocations_to_failure = failures;
        const int status = call();
        allocations_to_failure = -1;
        if (status == GM_IO_OK) {
            break;
        }
        gm_test_context("allocation %d", failures);
        GM_ASSERT_INT(status, GM_IO_ERR_MEMORY);
        GM_ASSERT_STRING(error.text, "out of memory");
        GM_ASSERT_INT(alive, alive_before);
        GM_ASSERT_INT(open_files, 0);
    }
    gm_test_context("%s", "");
    GM_ASSERT_INT(open_files, 0);
    /* So many allocations are known to be needed: else the test would see none of them. */
    GM_ASSERT(failures >= least && failures < 1000);
}

static void reading_deviations_survives_any_failed_allocation(void) {
    path = file_of(deviation_text);
    survives_any_failed_allocation(read_deviations, 5); /* rows, two tables, list of sets, work */
    GM_ASSERT_INT(deviations.set_count, 2);
    free_all();
    GM_ASSERT_INT(alive, 0);
}

static void reading_an_mka_survives_any_failed_allocation(void) {
    path = file_of("HEADER KS.MK.FILE\n 41 :x: 90\n 44 :x: 93\n 61 :x: 0\n 64 :x: 10\n"
                   "Zahn-Nr.: 1 links / 2 Werte z= 3\n1 2\nZahn-Nr.: 1 links / 2 Werte x= 15\n1 2\n"
                   "linke Zahnflanke\nZahn-Nr. fp Fp\n1 1 2\n");
    survives_any_failed_allocation(read_traces, 8); /* points, list, three arrays of each trace */
    GM_ASSERT_INT(traces.count, 2);
    gm_traces_free(&traces);
    survives_any_failed_allocation(read_measured_pitch, 1);
    gm_measured_pitch_free(&measured);
    GM_ASSERT_INT(alive, 0);
}

static void explaining_a_missing_node_survives_any_failed_allocation(void) {
    path = file_of(DEVIATION_HEADER "*,*,0,0,1\n*,*,0,1,2\n*,*,1,0,3\n");
    int failures = 0;
    int status = GM_IO_ERR_MEMORY;
    for (; failures < 100 && status == GM_IO_ERR_MEMORY; ++failures) {
        allocations_to_failure = failures;
        status = read_deviations();
        allocations_to_failure = -1;
        GM_ASSERT_INT(alive, 0);
        GM_ASSERT_INT(open_files, 0);
    }
    GM_ASSERT_INT(status, GM_IO_ERR_FORMAT);
    GM_ASSERT(failures > 2);
}

static void reading_pitch_survives_any_failed_allocation(void) {
    path = file_of(pitch_text);
    survives_any_failed_allocation(read_pitch, 4); /* the four arrays of the result */
    GM_ASSERT_REL(pitch.coast[2], 1.5e-6, 0.0);
    free_all();
    GM_ASSERT_INT(alive, 0);
}

static void building_flanks_survives_any_failed_allocation(void) {
    path = file_of(deviation_text);
    GM_ASSERT_INT(read_deviations(), GM_IO_OK);
    path = file_of(pitch_text);
    GM_ASSERT_INT(read_pitch(), GM_IO_OK);
    survives_any_failed_allocation(build, 1); /* the flanks */
    GM_ASSERT_INT(flanks->side[GM_DRIVE].count, 2);
    gm_flanks_free(flanks);
    flanks = NULL;
    survives_any_failed_allocation(build_with_design, 4);     /* also two designs and a table */
    GM_ASSERT_INT(flanks->side[GM_COAST].face_nodes - 1, 23); /* 5 um / 23^2 is below 0.01 um */
    free_all();
    GM_ASSERT_INT(alive, 0);
}

static void flank_quality_survives_any_failed_allocation(void) {
    gears = reference_pair(REFERENCE_FACE_WIDTH);
    survives_any_failed_allocation(generate_scatter,
                                   1 + 90 + 4 + 2); /* sets, tables, pitch, work */
    free_all();
    survives_any_failed_allocation(generate, 1 + 82 + 4 + 2);
    survives_any_failed_allocation(evaluate, 3); /* values, index, trace */
    free_all();
    GM_ASSERT_INT(alive, 0);
}

#define TRACE_HEADER "tooth,flank,trace,face_mm,roll_length_mm,deviation_um\n"

static void measured_flanks_survive_any_failed_allocation(void) {
    gears = reference_pair(REFERENCE_FACE_WIDTH);
    path = file_of(TRACE_HEADER "1,left,profile,8,9,0\n1,left,profile,8,21,1\n"
                                "1,left,helix,0,15,0\n1,left,helix,17.5,15,1\n"
                                "9,left,profile,8,9,0\n9,left,profile,8,21,1\n");
    survives_any_failed_allocation(read_traces, 2 + 3 * 3); /* traces, points; the arrays of each */
    GM_ASSERT_INT(traces.count, 3);
    /* Traces, points, work; sets and their tables; parts, their list, a surface each. */
    survives_any_failed_allocation(build_traces, 3 + 1 + 45 + 2 + 2);
    GM_ASSERT_INT(deviations.set_count, 45);

    char text[2000] = "tooth,flank,single_pitch_um\n";
    for (int tooth = 1; tooth <= 45; ++tooth) {
        sprintf(text + strlen(text), "%d,left,%d\n", tooth, tooth == 1 ? 1 : tooth == 9 ? -1 : 0);
    }
    path = file_of(text);
    survives_any_failed_allocation(read_measured_pitch, 1);
    survives_any_failed_allocation(build_measured_pitch, 4 + 2); /* the result; flanks, places */
    gm_traces_free(&traces);
    gm_measured_pitch_free(&measured);
    free_all();
    GM_ASSERT_INT(alive, 0);
}

static void writing_survives_any_failed_allocation(void) {
    path = file_of(deviation_text);
    GM_ASSERT_INT(read_deviations(), GM_IO_OK);
    survives_any_failed_allocation(write_deviations, 0);
    free_all();
    GM_ASSERT_INT(alive, 0);
}

static void refusing_a_file_leaves_nothing_behind(void) {
    static const char *const texts[] = {
        "",
        "tooth;flank\n",
        DEVIATION_HEADER,
        DEVIATION_HEADER "x\n",
        DEVIATION_HEADER "*,*,0,0,1\n*,*,0,1,x\n",
        DEVIATION_HEADER "*,*,0,0,1\n",
        DEVIATION_HEADER "*,*,0,0,1\n*,*,1,0,1\n*,*,1,0,1\n*,*,1,1,1\n",
        DEVIATION_HEADER "*,*,0,0,1\n*,*,0,1,1\n*,*,1,0,1\n*,*,1,1,1\n1,*,0,0,1\n",
        DEVIATION_HEADER "*,*,0,0,1\n*,*,0,1,1\n*,*,1,0,1\n*,*,1,0.5,1\n",
        PITCH_HEADER "1,drive,1\n1,drive,1\n",
        PITCH_HEADER "1,drive,x\n",
        TRACE_HEADER "1,left,profile,8,9,0\n1,left,profile,8,9,0\n",
        TRACE_HEADER "1,left,helix,8,9,0\n1,left,profile,8,9,x\n",
        "tooth,flank,single_pitch_um\n1,left,1\n1,left,x\n",
    };
    for (size_t i = 0; i < GM_TEST_COUNT(texts); ++i) {
        path = file_of(texts[i]);
        gm_test_context("text %d", (int)i);
        GM_ASSERT_INT(read_deviations(), GM_IO_ERR_FORMAT);
        GM_ASSERT_INT(read_pitch(), GM_IO_ERR_FORMAT);
        GM_ASSERT_INT(read_traces(), GM_IO_ERR_FORMAT);
        GM_ASSERT_INT(read_measured_pitch(), GM_IO_ERR_FORMAT);
        GM_ASSERT_INT(alive, 0);
        GM_ASSERT_INT(open_files, 0);
    }
}

static void refusing_to_write_or_to_build_leaves_nothing_behind(void) {
    path = file_of(deviation_text);
    GM_ASSERT_INT(read_deviations(), GM_IO_OK);
    path = file_of(pitch_text);
    GM_ASSERT_INT(read_pitch(), GM_IO_OK);
    const long alive_before = alive;

    deviations.sets[1].tooth = TEETH;
    GM_ASSERT_INT(write_deviations(), GM_IO_ERR_OPTION);
    GM_ASSERT_INT(build(), GM_IO_ERR_OPTION);
    deviations.sets[1].tooth = 4;
    gm_flanks_options options;
    gm_flanks_options_default(&options);
    options.scale = 1e308;
    options.normal_factor = 1e308;
    GM_ASSERT_INT(gm_flanks_build(&flanks, TEETH, &deviations, &pitch, &options, NULL, &error),
                  GM_IO_ERR_OPTION);
    pitch.drive[0] = (double)NAN;
    GM_ASSERT_INT(build(), GM_IO_ERR_OPTION);
    GM_ASSERT_INT(gm_pitch_write(&pitch, IO_TEST_PATH("out.csv"), &error), GM_IO_ERR_OPTION);
    GM_ASSERT_INT(gm_deviations_write(&deviations, GM_TEST_FOLDER, &error), GM_IO_ERR_FILE);

    GM_ASSERT_INT(alive, alive_before);
    GM_ASSERT_INT(open_files, 0);
    free_all();
    GM_ASSERT_INT(alive, 0);
}

static void a_file_of_endless_text_is_refused_in_little_memory(void) {
    /* 1 MB without a line end, behind a comment of 1 MB */
    enum { size = 2000000 };
    static char text[size];
    memset(text, '1', size);
    text[0] = '#';
    text[size / 2] = '\n';
    path = file_of_bytes(text, size);
    largest = 0;
    GM_ASSERT_INT(read_deviations(), GM_IO_ERR_FORMAT);
    GM_ASSERT_INT(error.line, 2);
    GM_ASSERT(largest < 100000);
    GM_ASSERT_INT(remove(path), 0);
}

static void a_locale_with_a_decimal_comma_changes_nothing(void) {
    comma_locale = 1;
    char text[32];
    snprintf(text, sizeof text, "%.1f", 1.5);
    GM_ASSERT_STRING(text, "1,5"); /* so there is such a locale */
    strtod_calls = 0;

    path = file_of(deviation_text);
    GM_ASSERT_INT(read_deviations(), GM_IO_OK);
    GM_ASSERT_INT(write_deviations(), GM_IO_OK);
    gm_deviations copy = deviations;
    path = IO_TEST_PATH("out.csv");
    GM_ASSERT_INT(read_deviations(), GM_IO_OK);
    comma_locale = 0;
    GM_ASSERT(strtod_calls > 0);

    if (GM_ASSERT_INT(copy.set_count, 2) && GM_ASSERT_INT(deviations.set_count, 2)) {
        static const double expected[] = {1.25e-9, -0.123456789012345678e-6, 33.3e-6, 0.1};
        for (int node = 0; node < 4; ++node) {
            GM_ASSERT(same_bits(copy.sets[1].values[node], expected[node]));
            GM_ASSERT(same_bits(deviations.sets[1].values[node], expected[node]));
        }
    }
    gm_deviations_free(&copy);
    free_all();
    path = file_of(DEVIATION_HEADER "*,*,0.25,0,1\n*,*,1,0,1\n");
    comma_locale = 1;
    GM_ASSERT_INT(read_deviations(), GM_IO_ERR_FORMAT);
    comma_locale = 0;
    GM_ASSERT(strstr(error.text, "t1 = 0.25") != NULL);
    GM_ASSERT_INT(alive, 0);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(reading_deviations_survives_any_failed_allocation),
        GM_TEST(reading_an_mka_survives_any_failed_allocation),
        GM_TEST(explaining_a_missing_node_survives_any_failed_allocation),
        GM_TEST(reading_pitch_survives_any_failed_allocation),
        GM_TEST(building_flanks_survives_any_failed_allocation),
        GM_TEST(flank_quality_survives_any_failed_allocation),
        GM_TEST(measured_flanks_survive_any_failed_allocation),
        GM_TEST(writing_survives_any_failed_allocation),
        GM_TEST(refusing_a_file_leaves_nothing_behind),
        GM_TEST(refusing_to_write_or_to_build_leaves_nothing_behind),
        GM_TEST(a_file_of_endless_text_is_refused_in_little_memory),
        GM_TEST(a_locale_with_a_decimal_comma_changes_nothing),
    };
    return gm_test_main("unit.io_failures", tests, GM_TEST_COUNT(tests), argc, argv);
}
