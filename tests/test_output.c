/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* apps/gearsim/output*.c and columns.c: the result file, whole, cut short, and on a full disk. */
/* mkdtemp(), symlink() */
#define _XOPEN_SOURCE 700

#include "keys.h"
#include "output.h"
#include "platform.h"

#include "gm_test.h"

#ifdef GEARSIM_HDF5
#include <hdf5.h>
#endif
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

static const char *const names[] = {"time_s", "force_N", "pairs"};
enum { NAMES = 3 };

static char folder[] = "/tmp/gearsim_output_XXXXXX";
static char path[128], part[160];
static char *provenance[] = {"load.seed = 7", "output.digits = 10"};

static config case_of(const char *columns, int digits) {
    static struct key_entry *entries;

    if (entries == NULL) {
        entries = calloc((size_t)gearsim_keys.count, sizeof *entries);
    }
    const config conf = {
        .path = "test.ini",
        .output_file = path,
        .digits = digits,
        .columns = (char *)(uintptr_t)columns,
        .provenance = provenance,
        .provenance_count = 2,
        .entries = entries,
    };
    return conf;
}

/* Text of a file, "" if it is not there. */
static const char *text_of(const char *file) {
    static char text[1 << 20];
    FILE *stream = fopen(file, "rb");
    size_t size = 0;

    if (stream != NULL) {
        size = fread(text, 1, sizeof text - 1, stream);
        fclose(stream);
    }
    text[size] = '\0';
    return text;
}

static void write_text(const char *file, const char *text) {
    FILE *stream = fopen(file, "wb");
    fputs(text, stream);
    fclose(stream);
}

static int exists(const char *file) {
    return access(file, F_OK) == 0;
}

static void clean(void) {
    remove(path);
    remove(part);
}

#define HEAD "# gearsim " GM_VERSION_STRING "\n# load.seed = 7\n# output.digits = 10\n"

static void rows_come_back_as_written(void) {
    const config conf = case_of(NULL, 10);
    const double first[] = {0.0, -524.0666123456789, 4.0}, second[] = {3.90625e-05, -0.0, 3.0};
    int exit_code = -1;
    output_file *output = output_open(&conf, names, NAMES, &exit_code);

    GM_ASSERT(output != NULL);
    GM_ASSERT(exists(part) && !exists(path));
    GM_ASSERT_INT(output_row(output, first), 0);
    GM_ASSERT_INT(output_row(output, second), 0);
    GM_ASSERT_INT(output_close(output, NULL), 0);
    GM_ASSERT(exists(path) && !exists(part));
    GM_ASSERT_STRING(text_of(path),
                     HEAD "time_s,force_N,pairs\n0,-524.0666123,4\n3.90625e-05,0,3\n");
    clean();
}

static void columns_come_as_asked_for(void) {
    const config conf = case_of("pairs , time_s", 3);
    const double row[] = {1.23456, 2.0, 5.0};
    int exit_code = -1;
    output_file *output = output_open(&conf, names, NAMES, &exit_code);

    GM_ASSERT(output != NULL);
    GM_ASSERT(output_wants(output, 0) && !output_wants(output, 1) && output_wants(output, 2));
    output_row(output, row);
    GM_ASSERT_INT(output_close(output, NULL), 0);
    GM_ASSERT_STRING(text_of(path), HEAD "pairs,time_s\n5,1.23\n");
    clean();
}

static void seventeen_digits_give_every_bit(void) {
    const config conf = case_of("force_N", 17);
    int exit_code = -1;
    output_file *output = output_open(&conf, names, NAMES, &exit_code);
    uint64_t seed = 3;

    for (int i = 0; i < 5000; ++i) {
        const double row[] = {0.0, gm_test_uniform(&seed, -1e3, 1e3), 0.0};
        GM_ASSERT_INT(output_row(output, row), 0);
    }
    GM_ASSERT_INT(output_close(output, NULL), 0);

    const char *line = strstr(text_of(path), "force_N\n");
    GM_ASSERT(line != NULL);
    seed = 3;
    for (int i = 0; i < 5000; ++i) {
        line = strchr(line, '\n') + 1;
        GM_ASSERT(strtod(line, NULL) == gm_test_uniform(&seed, -1e3, 1e3));
    }
    GM_ASSERT_STRING(strchr(line, '\n'), "\n");
    clean();
}

static void an_incomplete_run_leaves_the_old_result(void) {
    const config conf = case_of("time_s", 10);
    const double row[] = {0.5, 0.0, 0.0};
    int exit_code = -1;
    write_text(path, "an older result\n");

    output_file *output = output_open(&conf, names, NAMES, &exit_code);
    output_row(output, row);
    GM_ASSERT_INT(output_close(output, "interrupted at t = 0.7 s"), 0);
    GM_ASSERT_STRING(text_of(path), "an older result\n");
    GM_ASSERT_STRING(text_of(part), HEAD "time_s\n0.5\n# incomplete: interrupted at t = 0.7 s\n");
    clean();
}

/* A limit on the size of files stands for a full disk: writes fail in the middle of a line. */
static void a_full_disk_leaves_whole_lines(void) {
    const config conf = case_of(NULL, 10);
    const double row[] = {0.123456789, 1.0 / 3.0, 4.0};
    const char line[] = "0.123456789,0.3333333333,4\n";
    int exit_code = -1, failed = 0, rows = 0;
    struct rlimit before, small;
    getrlimit(RLIMIT_FSIZE, &before);
    small = before;
    small.rlim_cur = 100001;
    setrlimit(RLIMIT_FSIZE, &small);
    write_text(path, "an older result\n");

    output_file *output = output_open(&conf, names, NAMES, &exit_code);
    for (; rows < 1000000 && !failed; ++rows) {
        failed = output_row(output, row);
    }
    GM_ASSERT_INT(failed, EXIT_RUN_FAILED);
    GM_ASSERT_INT(output_close(output, "the disk is full"), EXIT_RUN_FAILED);
    setrlimit(RLIMIT_FSIZE, &before);

    const char *text = text_of(part);
    const size_t size = strlen(text);
    const char head[] = HEAD "time_s,force_N,pairs\n";
    GM_ASSERT(strncmp(text, head, strlen(head)) == 0);
    /* What fits of whole lines, each of them as it should be, and perhaps the reason. */
    const char *end = strstr(text, "# incomplete");
    const size_t data = (end != NULL ? (size_t)(end - text) : size) - strlen(head);
    GM_ASSERT_INT(data % strlen(line), 0);
    for (size_t at = strlen(head); at < strlen(head) + data; at += strlen(line)) {
        GM_ASSERT(strncmp(text + at, line, strlen(line)) == 0);
    }
    GM_ASSERT(size <= 100001 && size > 100001 - 100);
    GM_ASSERT(text[size - 1] == '\n');
    GM_ASSERT_STRING(text_of(path), "an older result\n");
    clean();
}

/* Found before a run of hours, not after it. */
static void a_disk_full_from_the_start_is_told_at_once(void) {
    const config conf = case_of(NULL, 10);
    int exit_code = -1;
    struct rlimit before, small;
    getrlimit(RLIMIT_FSIZE, &before);
    small = before;
    small.rlim_cur = 30;
    setrlimit(RLIMIT_FSIZE, &small);

    GM_ASSERT(output_open(&conf, names, NAMES, &exit_code) == NULL);
    setrlimit(RLIMIT_FSIZE, &before);
    GM_ASSERT_INT(exit_code, EXIT_RUN_FAILED);
    GM_ASSERT(!exists(path));
    clean();
}

static void bad_columns_are_refused(void) {
    const char *const bad[] = {"time_s,torque_Nm", "time_s,time_s", "", "time_s,", ",time_s",
                               "TIME_S",           "time_s force_N"};

    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        const config conf = case_of(bad[i], 10);
        gm_test_context("columns '%s'", bad[i]);
        GM_ASSERT_INT(output_check(&conf, names, NAMES), EXIT_BAD_INPUT);
        GM_ASSERT(!exists(part) && !exists(path));
    }
}

/* A device would be replaced by a file, a folder cannot be. */
static void places_that_take_no_file_are_refused(void) {
    char inside[160], beyond[160];
    snprintf(inside, sizeof inside, "%s/no/such/result.csv", folder);
    snprintf(beyond, sizeof beyond, "%s", folder);
    char *const bad[] = {inside, beyond, "/dev/null"};

    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        config conf = case_of(NULL, 10);
        conf.output_file = bad[i];
        gm_test_context("file '%s'", bad[i]);
        GM_ASSERT_INT(output_check(&conf, names, NAMES), EXIT_BAD_INPUT);
    }
    struct stat status;
    GM_ASSERT(stat("/dev/null", &status) == 0 && S_ISCHR(status.st_mode));
}

static void a_check_leaves_nothing_behind(void) {
    const config conf = case_of("time_s", 10);

    GM_ASSERT_INT(output_check(&conf, names, NAMES), 0);
    GM_ASSERT(!exists(part) && !exists(path));
}

/* The result replaces the file that the link names, not the link. */
static void a_link_stays_a_link(void) {
    char target[160];
    struct stat status;
    int exit_code = -1;
    const config conf = case_of("pairs", 10);
    const double row[] = {0.0, 0.0, 2.0};
    snprintf(target, sizeof target, "%s/target.csv", folder);
    write_text(target, "an older result\n");
    GM_ASSERT_INT(symlink(target, path), 0);

    output_file *output = output_open(&conf, names, NAMES, &exit_code);
    output_row(output, row);
    GM_ASSERT_INT(output_close(output, NULL), 0);
    GM_ASSERT(lstat(path, &status) == 0 && S_ISLNK(status.st_mode));
    GM_ASSERT_STRING(text_of(target), HEAD "pairs\n2\n");
    remove(target);
    clean();
}

/* ---------------------------------------------------------------------------------------------
 * HDF5
 * ------------------------------------------------------------------------------------------- */

/* The same case with another name of the file; the folder's files go with clean_hdf5(). */
static char path_h5[128], part_h5[160];

static config hdf5_case(const char *columns) {
    config conf = case_of(columns, 10);
    conf.output_file = path_h5;
    return conf;
}

#ifdef GEARSIM_HDF5

static void clean_hdf5(void) {
    remove(path_h5);
    remove(part_h5);
}

/* Values of a data set, their number; -1: there is none of that name. */
static int read_set(hid_t file, const char *name, double values[], int size) {
    const hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
    hsize_t count = 0;
    if (set < 0) {
        return -1;
    }

    const hid_t space = H5Dget_space(set);
    GM_ASSERT_INT(H5Sget_simple_extent_ndims(space), 1);
    H5Sget_simple_extent_dims(space, &count, NULL);
    GM_ASSERT(count <= (hsize_t)size);
    GM_ASSERT(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0);
    H5Sclose(space);
    H5Dclose(set);
    return (int)count;
}

/* Text of an attribute of variable or fixed length, "" if it is not there. */
static const char *read_text(hid_t file, const char *name) {
    static char text[1024];
    const hid_t attribute = H5Aopen(file, name, H5P_DEFAULT);
    char *variable = NULL;

    memset(text, 0, sizeof text);
    if (attribute >= 0) {
        const hid_t type = H5Aget_type(attribute);
        const int is_variable = H5Tis_variable_str(type) > 0;
        H5Aread(attribute, type, is_variable ? (void *)&variable : (void *)text);
        if (is_variable) {
            snprintf(text, sizeof text, "%s", variable);
            H5free_memory(variable);
        }
        H5Tclose(type);
        H5Aclose(attribute);
    }
    return text;
}

enum { HDF5_ROWS = 20000 };
static double read_back[HDF5_ROWS];

/* Rows 0.. of the same random numbers. */
static int put_random_rows(output_file *output, int rows) {
    uint64_t seed = 5;
    int failed = 0;

    for (int i = 0; i < rows && !failed; ++i) {
        double row[NAMES];
        for (int j = 0; j < NAMES; ++j) {
            row[j] = gm_test_uniform(&seed, -1e3, 1e3);
        }
        failed = output_row(output, row);
    }
    return failed;
}

/* Number of rows in a file, which must be the first of those above in each of its columns. */
static int check_random_rows(hid_t file) {
    int rows = -1, wrong = 0;

    for (int column = 0; column < NAMES; ++column) {
        uint64_t seed = 5;
        const int count = read_set(file, names[column], read_back, HDF5_ROWS);
        GM_ASSERT(column == 0 || count == rows);
        rows = count;
        for (int i = 0; i < count; ++i) {
            for (int j = 0; j < NAMES; ++j) {
                const double expected = gm_test_uniform(&seed, -1e3, 1e3);
                wrong += j == column && read_back[i] != expected;
            }
        }
    }
    GM_ASSERT_INT(wrong, 0);
    return rows;
}

static hid_t open_hdf5(const char *file) {
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    return H5Fopen(file, H5F_ACC_RDONLY, H5P_DEFAULT);
}

/* Every bit, whatever the digits; across blocks, and a part of one at the end. */
static void hdf5_rows_come_back_as_written(void) {
    const int rows[] = {0, 1, 4095, 4096, 4097, HDF5_ROWS};

    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        const config conf = hdf5_case(NULL);
        int exit_code = -1;
        output_file *output = output_open(&conf, names, NAMES, &exit_code);
        gm_test_context("%d rows", rows[i]);
        GM_ASSERT(output != NULL && exists(part_h5) && !exists(path_h5));
        GM_ASSERT_INT(put_random_rows(output, rows[i]), 0);
        GM_ASSERT_INT(output_close(output, NULL), 0);
        GM_ASSERT(exists(path_h5) && !exists(part_h5));

        const hid_t file = open_hdf5(path_h5);
        GM_ASSERT(file >= 0);
        GM_ASSERT_INT(check_random_rows(file), rows[i]);
        GM_ASSERT_STRING(read_text(file, "gearsim"), GM_VERSION_STRING);
        GM_ASSERT_STRING(read_text(file, "load.seed"), "7");
        GM_ASSERT_STRING(read_text(file, "output.digits"), "10");
        GM_ASSERT_STRING(read_text(file, "incomplete"), "");
        H5Fclose(file);
        clean_hdf5();
    }
}

static void hdf5_columns_come_as_asked_for(void) {
    const config conf = hdf5_case("pairs , time_s");
    const double row[] = {1.25, 2.0, -0.0};
    int exit_code = -1;
    output_file *output = output_open(&conf, names, NAMES, &exit_code);
    GM_ASSERT(output != NULL);
    output_row(output, row);
    GM_ASSERT_INT(output_close(output, NULL), 0);

    const hid_t file = open_hdf5(path_h5);
    GM_ASSERT_INT(read_set(file, "force_N", read_back, 1), -1);
    GM_ASSERT_INT(read_set(file, "time_s", read_back, 1), 1);
    GM_ASSERT(read_back[0] == 1.25);
    GM_ASSERT_INT(read_set(file, "pairs", read_back, 1), 1);
    GM_ASSERT(read_back[0] == 0.0 && 1.0 / read_back[0] > 0.0); /* no -0 */
    H5Fclose(file);
    clean_hdf5();
}

static void an_incomplete_hdf5_says_why(void) {
    const config conf = hdf5_case(NULL);
    int exit_code = -1;
    write_text(path_h5, "an older result\n");

    output_file *output = output_open(&conf, names, NAMES, &exit_code);
    GM_ASSERT_INT(put_random_rows(output, 5000), 0);
    GM_ASSERT_INT(output_close(output, "interrupted at t = 0.7 s"), 0);
    GM_ASSERT_STRING(text_of(path_h5), "an older result\n");

    const hid_t file = open_hdf5(part_h5);
    GM_ASSERT_INT(check_random_rows(file), 5000);
    GM_ASSERT_STRING(read_text(file, "incomplete"), "interrupted at t = 0.7 s");
    H5Fclose(file);
    clean_hdf5();
}

/*
 * Wherever the disk is full: either that is told at the start, or what is left can be opened and holds
 * whole blocks, all the same number of rows, and the reason. 98 KB make a block, up to 64 KB more are
 * reserved with it.
 */
static void a_full_disk_leaves_an_hdf5_that_opens(void) {
    struct rlimit before;
    int refused = 0, most = 0;
    getrlimit(RLIMIT_FSIZE, &before);

    for (int limit = 0; limit < 550000; limit += 9973) {
        const config conf = hdf5_case(NULL);
        int exit_code = -1;
        struct rlimit small = before;
        small.rlim_cur = (rlim_t)limit;
        gm_test_context("room for %d bytes", limit);

        setrlimit(RLIMIT_FSIZE, &small);
        output_file *output = output_open(&conf, names, NAMES, &exit_code);
        if (output != NULL) {
            put_random_rows(output, HDF5_ROWS);
        }
        const int closed = output != NULL ? output_close(output, "the disk is full") : exit_code;
        setrlimit(RLIMIT_FSIZE, &before);

        GM_ASSERT(!exists(path_h5));
        GM_ASSERT_INT(closed, EXIT_RUN_FAILED);
        refused += output == NULL;
        if (output != NULL) {
            const hid_t file = open_hdf5(part_h5);
            GM_ASSERT(file >= 0);
            const int rows = check_random_rows(file);
            GM_ASSERT(rows % 4096 == 0 && rows * 24 <= limit && rows * 24 > limit - 300000);
            GM_ASSERT_STRING(read_text(file, "incomplete"), "File too large");
            most = rows > most ? rows : most;
            H5Fclose(file);
        }
        clean_hdf5();
    }
    GM_ASSERT(refused > 0 && refused < 20);
    GM_ASSERT(most >= 4 * 4096);
}

#else

/* Not written as CSV under a name that says otherwise. */
static void hdf5_is_refused_where_it_was_not_built_in(void) {
    const config conf = hdf5_case(NULL);

    GM_ASSERT_INT(output_check(&conf, names, NAMES), EXIT_BAD_INPUT);
    GM_ASSERT(!exists(part_h5) && !exists(path_h5));
}

#endif

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(rows_come_back_as_written),
        GM_TEST(columns_come_as_asked_for),
        GM_TEST(seventeen_digits_give_every_bit),
        GM_TEST(an_incomplete_run_leaves_the_old_result),
        GM_TEST(a_full_disk_leaves_whole_lines),
        GM_TEST(a_disk_full_from_the_start_is_told_at_once),
        GM_TEST(bad_columns_are_refused),
        GM_TEST(places_that_take_no_file_are_refused),
        GM_TEST(a_check_leaves_nothing_behind),
        GM_TEST(a_link_stays_a_link),
#ifdef GEARSIM_HDF5
        GM_TEST(hdf5_rows_come_back_as_written),
        GM_TEST(hdf5_columns_come_as_asked_for),
        GM_TEST(an_incomplete_hdf5_says_why),
        GM_TEST(a_full_disk_leaves_an_hdf5_that_opens),
#else
        GM_TEST(hdf5_is_refused_where_it_was_not_built_in),
#endif
    };
    if (process_prepare() != EXIT_DONE) {
        return 1;
    }
    if (mkdtemp(folder) == NULL) {
        perror(folder);
        return 1;
    }
    snprintf(path, sizeof path, "%s/result.csv", folder);
    snprintf(part, sizeof part, "%s.part", path);
    snprintf(path_h5, sizeof path_h5, "%s/result.h5", folder);
    snprintf(part_h5, sizeof part_h5, "%s.part", path_h5);
    const int result = gm_test_main("gearsim.output", tests, GM_TEST_COUNT(tests), argc, argv);
    rmdir(folder);
    return result;
}
