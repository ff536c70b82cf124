/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Deviation files: sets, grids, files that are none, round trip, size. Lines, fields and numbers are tested
 * in test_pitch_file.c; both kinds of files are read by the same code.
 */
#define _POSIX_C_SOURCE 200809L

#include "io_test.h"

#include <locale.h>
#include <sys/stat.h>
#include <unistd.h>

#define TEETH  45
#define HEADER "tooth,flank,t1,t2,deviation_um\n"

/* A full set of 2 x 2 nodes with the deviations 1, 2, 3, 4 um for what is `key`. */
#define SET(key) key ",0,0,1\n" key ",0,1,2\n" key ",1,0,3\n" key ",1,1,4\n"

static gm_deviations deviations;
static gm_io_error error;

static int read_deviations(const char *text) {
    return gm_deviations_read(&deviations, file_of(text), TEETH, &error);
}

static void refused_path(const char *path, int status, long line, const char *value,
                         const char *right) {
    GM_ASSERT_INT(gm_deviations_read(&deviations, path, TEETH, &error), status);
    assert_error(&error, path, line, value, right);
    GM_ASSERT(deviations.sets == NULL && deviations.set_count == 0 && deviations.teeth == 0);
    GM_ASSERT(deviations.face_nodes == 0 && deviations.profile_nodes == 0);
    gm_deviations_free(&deviations);
}

/* Reads text that must be refused, in a line, naming a value and what would be right. */
static void refused(const char *text, long line, const char *value, const char *right) {
    refused_path(file_of(text), GM_IO_ERR_FORMAT, line, value, right);
}

static const gm_deviation_set *find_set(int tooth, int side) {
    for (int i = 0; i < deviations.set_count; ++i) {
        if (deviations.sets[i].tooth == tooth && deviations.sets[i].side == side) {
            return &deviations.sets[i];
        }
    }
    return NULL;
}

/* ---------------------------------------------------------------------------------------------
 * Sets and grids that are right
 * ------------------------------------------------------------------------------------------- */

static void nodes_are_stored_along_the_face_first_then_along_the_profile(void) {
    GM_ASSERT_INT(read_deviations(HEADER "7,coast,0,0,1\n7,coast,0,0.5,2\n7,coast,0,1,-3.5\n"
                                         "7,coast,1,0,4\n7,coast,1,0.5,5\n7,coast,1,1,6\n"),
                  GM_IO_OK);
    GM_ASSERT_INT(deviations.teeth, 45);
    GM_ASSERT_INT(deviations.face_nodes, 2);
    GM_ASSERT_INT(deviations.profile_nodes, 3);
    GM_ASSERT_INT(deviations.set_count, 1);
    const gm_deviation_set *set = find_set(7, GM_COAST);
    if (GM_ASSERT(set != NULL)) {
        static const double expected[] = {1e-6, 2e-6, -3.5e-6, 4e-6, 5e-6, 6e-6};
        for (int node = 0; node < 6; ++node) {
            GM_ASSERT_REL(set->values[node], expected[node], 0.0);
        }
    }
    gm_deviations_free(&deviations);
    GM_ASSERT(deviations.sets == NULL && deviations.set_count == 0);
}

static void every_kind_of_set_is_kept_apart(void) {
    static const int tooth[] = {-1, -1, -1, 0, 44, 44};
    static const int side[] = {-1, GM_DRIVE, GM_COAST, GM_DRIVE, -1, GM_COAST};
    GM_ASSERT_INT(read_deviations(HEADER SET("44,coast") SET("*,*") SET("44,*") SET("0,drive")
                                      SET("*,coast") SET("*,drive")),
                  GM_IO_OK);
    GM_ASSERT_INT(deviations.set_count, 6);
    for (int i = 0; i < 6 && i < deviations.set_count; ++i) {
        GM_ASSERT_INT(deviations.sets[i].tooth, tooth[i]); /* in the order that the header states */
        GM_ASSERT_INT(deviations.sets[i].side, side[i]);
        GM_ASSERT_REL(deviations.sets[i].values[3], 4e-6, 0.0);
    }
    gm_deviations_free(&deviations);
}

/* Writes the rows of a file of 3 sets with 4 x 3 nodes in the order that a permutation gives. */
static const char *shuffled_rows(uint64_t seed, int rows) {
    static char text[20000];
    int order[36];
    for (int i = 0; i < rows; ++i) {
        order[i] = i;
    }
    for (int i = rows - 1; i > 0 && seed != 0; --i) {
        const int other = gm_test_integer(&seed, 0, i);
        const int swap = order[i];
        order[i] = order[other];
        order[other] = swap;
    }
    strcpy(text, HEADER);
    for (int i = 0; i < rows; ++i) {
        const int set = order[i] / 12;
        const int face = order[i] % 12 / 3;
        const int profile = order[i] % 3;
        sprintf(text + strlen(text), "%d,drive,%.6f,%.6f,%d\n", set, face / 3.0, profile / 2.0,
                order[i]);
    }
    return text;
}

static void rows_may_come_in_any_order(void) {
    for (uint64_t seed = 0; seed < 50; ++seed) {
        gm_test_context("seed %d", (int)seed);
        if (!GM_ASSERT_INT(read_deviations(shuffled_rows(seed, 36)), GM_IO_OK) ||
            !GM_ASSERT_INT(deviations.face_nodes, 4) ||
            !GM_ASSERT_INT(deviations.profile_nodes, 3)) {
            break;
        }
        for (int i = 0; i < 36; ++i) {
            GM_ASSERT_REL(deviations.sets[i / 12].values[i % 12], i / 1e6, 1e-15);
        }
        gm_deviations_free(&deviations);
    }
    gm_deviations_free(&deviations);
}

/* Files are read in buffers of 16 KiB: rows, the comments between them and the last line may end anywhere. */
static void lines_may_lie_across_what_is_read_at_a_time(void) {
    static char text[80000];
    static const char *const last[] = {"5,drive,1,1,-12.625\n", "5,drive,1,1,-12.625",
                                       "5,drive,1,1,-12.625\r\n", "5,drive,1,1,-12.625\n# end"};

    for (int length = 16200; length < 16420 + 33000; length += length == 16420 ? 32600 : 1) {
        char *end = text + sprintf(text, "%s#", HEADER);
        memset(end, 'c', (size_t)length);
        sprintf(end + length, "\n5,drive,0,0,1\n5,drive,0,1,2.5\n5,drive,1,0,3\n%s",
                last[length % 4]);
        gm_test_context("comment of %d characters", length);
        if (!GM_ASSERT_INT(read_deviations(text), GM_IO_OK) ||
            !GM_ASSERT_INT(deviations.set_count, 1)) {
            break;
        }
        const double expected[] = {1e-6, 2.5e-6, 3e-6, -12.625e-6};
        for (int node = 0; node < 4; ++node) {
            GM_ASSERT(same_bits(deviations.sets[0].values[node], expected[node]));
        }
        gm_deviations_free(&deviations);

        /* A wrong row behind it is told with its line. */
        sprintf(end + length, "\n5,drive,0,0,1\n5,drive,0,1,2x5\n");
        refused(text, 4, "'2x5'", "must be a number");

        /* And so is a carriage return within a line. */
        if (length % 16 == 0) {
            sprintf(end + length, "\n5,drive,0,0,1\n5,drive,0\r,1,2.5\n");
            refused(text, 4, "carriage return", "LF or CRLF");
        }
    }
}

/* Rows take a short way through the reader if they are plain: the bits are those of strtod() on either way. */
static void a_number_means_the_same_however_its_row_is_written(void) {
    uint64_t seed = 4;
    for (int k = 0; k < 2000; ++k) {
        char number[64], text[400];
        sprintf(number, "%.*f", gm_test_integer(&seed, 0, 17),
                gm_test_uniform(&seed, -999.0, 999.0));
        sprintf(text,
                HEADER "3,coast,0,0,%s\n3,coast,0,1,%s \n 3 ,coast,1.0,0.0,%s\n3,coast,1,1,%se0\n",
                number, number, number, number);
        gm_test_context("%s", number);
        if (!GM_ASSERT_INT(read_deviations(text), GM_IO_OK)) {
            break;
        }

        const double expected = strtod(strcat(number, "e-6"), NULL);
        for (int node = 0; node < 4; ++node) {
            GM_ASSERT(same_bits(deviations.sets[0].values[node], expected));
        }
        gm_deviations_free(&deviations);
    }
}

static void positions_may_be_rounded_to_1e_5(void) {
    /* 1/3 and 2/3 rounded to five digits, and rounding beyond the ends */
    GM_ASSERT_INT(read_deviations(HEADER "*,*,-0.000009,0,1\n*,*,0.33333,0,1\n*,*,0.66667,0,1\n"
                                         "*,*,1.000009,0,1\n*,*,0.000009,1,1\n*,*,0.33334,1,1\n"
                                         "*,*,0.66666,1,1\n*,*,0.999991,1,1\n"),
                  GM_IO_OK);
    GM_ASSERT_INT(deviations.face_nodes, 4);
    GM_ASSERT_INT(deviations.profile_nodes, 2);
    gm_deviations_free(&deviations);
}

static void a_set_that_serves_all_leaves_no_tooth_ideal(void) {
    GM_ASSERT_INT(read_deviations(HEADER SET("*,drive") SET("3,coast") SET("3,*") SET("4,*")),
                  GM_IO_OK);
    GM_ASSERT_INT(gm_deviations_ideal_teeth(&deviations, GM_DRIVE), 0);
    GM_ASSERT_INT(gm_deviations_ideal_teeth(&deviations, GM_COAST), 43);
    GM_ASSERT_INT(gm_deviations_ideal_teeth(&deviations, 2), 0);
    GM_ASSERT_INT(gm_deviations_ideal_teeth(NULL, GM_DRIVE), 0);
    gm_deviations_free(&deviations);
}

/* ---------------------------------------------------------------------------------------------
 * Grids that are wrong
 * ------------------------------------------------------------------------------------------- */

static void a_missing_node_is_named(void) {
    refused(HEADER "1,drive,0,0,1\n1,drive,0,1,2\n1,drive,1,0,3\n", 2,
            "tooth 1, flank drive, which begins here: must have 4 rows for 2 x 2 nodes (got 3",
            "none for t1 = 1, t2 = 1");
    refused(HEADER "# 3 x 2\n*,*,0,0,1\n*,*,0,1,1\n*,*,0.5,1,1\n*,*,1,0,1\n*,*,1,1,1\n", 3,
            "none for t1 = 0.5, t2 = 0", "must have 6 rows for 3 x 2 nodes (got 5");
}

static void a_node_missing_in_a_later_set_is_named(void) {
    refused(HEADER SET("1,drive") "2,drive,0,0,1\n2,drive,1,0,2\n2,drive,1,1,3\n", 6,
            "tooth 2, flank drive, which begins here: must have", "2 x 2");
}

static void a_repeated_node_is_named(void) {
    refused(HEADER SET("1,drive") "1,drive,1,0,3\n", 6, "a second one for t1 = 1, t2 = 0",
            "tooth 1, flank drive: must have one row per node");
    /* In place of a node that is missing: the number of rows looks right. */
    refused(HEADER "1,drive,0,0,1\n1,drive,0,1,2\n1,drive,1,0,3\n1,drive,1,0,4\n", 5,
            "a second one for t1 = 1, t2 = 0", "one row per node");
    /* Within the tolerance of positions. */
    refused(HEADER SET("1,drive") "1,drive,0.999995,0,3\n", 6, "a second one for t1 = 0.999995",
            "one row per node");
}

static void a_line_of_nodes_that_is_mostly_missing_is_named(void) {
    refused(HEADER "*,*,0,0,1\n*,*,0,0.2,1\n*,*,0,0.4,1\n*,*,0,0.6,1\n*,*,0,0.8,1\n*,*,0,1,1\n"
                   "*,*,1,1,1\n",
            2, "none for t1 = 1, t2 = 0", "must have 12 rows for 2 x 6 nodes (got 7");
}

static void a_file_that_holds_everything_twice_is_refused(void) {
    refused(HEADER SET("1,drive") SET("1,drive"), 6, "a second one for t1 = 0, t2 = 0",
            "one row per node");
}

static void an_uneven_grid_is_refused(void) {
    refused(HEADER "*,*,0,0,1\n*,*,0.3,0,1\n*,*,1,0,1\n*,*,0,1,1\n*,*,0.3,1,1\n*,*,1,1,1\n", 3,
            "t1: must be on the grid of 3 x 2 uniform nodes", "for example 0.5 (got 0.3)");
    refused(HEADER "*,*,0,0,1\n*,*,0,0.50002,1\n*,*,0,1,1\n*,*,1,0,1\n*,*,1,0.50002,1\n*,*,1,1,1\n",
            3, "t2: must be on the grid of 2 x 3 uniform nodes", "for example 0.5 (got 0.50002)");
}

static void one_wrong_position_among_many_rows_is_the_one_that_is_named(void) {
    char text[4000] = HEADER;
    for (int face = 0; face < 6; ++face) {
        for (int profile = 0; profile < 4; ++profile) {
            const double slip = face == 3 && profile == 2 ? 0.01 : 0.0;
            sprintf(text + strlen(text), "0,coast,%.6f,%.6f,1\n", face / 5.0 + slip, profile / 3.0);
        }
    }
    refused(text, 2 + 3 * 4 + 2, "t1: must be on the grid of 6 x 4 uniform nodes",
            "for example 0.6 (got 0.61)");
}

static void a_grid_that_differs_between_sets_is_refused(void) {
    refused(HEADER SET("1,drive") "2,drive,0,0,1\n2,drive,0.5,0,1\n2,drive,1,0,1\n"
                                  "2,drive,0,1,1\n2,drive,0.5,1,1\n2,drive,1,1,1\n",
            7, "t1: must be on the grid of 2 x 2 uniform nodes that tooth 1, flank drive",
            "(got 0.5)");
    /* Coarser than the first: all positions lie on its grid, nodes are missing. */
    refused(HEADER "2,drive,0,0,1\n2,drive,0.5,0,1\n2,drive,1,0,1\n2,drive,0,1,1\n2,drive,0.5,1,1\n"
                   "2,drive,1,1,1\n" SET("3,drive"),
            8, "tooth 3, flank drive, which begins here: must have 6 rows for 3 x 2 nodes (got 4",
            "none for t1 = 0.5, t2 = 0");
    /* Turned around: as many rows. */
    refused(HEADER "2,drive,0,0,1\n2,drive,0.5,0,1\n2,drive,1,0,1\n2,drive,0,1,1\n2,drive,0.5,1,1\n"
                   "2,drive,1,1,1\n3,drive,0,0,1\n3,drive,0,0.5,1\n3,drive,0,1,1\n3,drive,1,0,1\n"
                   "3,drive,1,0.5,1\n3,drive,1,1,1\n",
            9, "t2: must be on the grid of 3 x 2 uniform nodes", "for example 1 (got 0.5)");
}

static void fewer_than_two_nodes_along_a_direction_are_refused(void) {
    refused(HEADER "1,drive,0,0,1\n", 2, "only one position t1 = 0", "at least 2 x 2 nodes");
    refused(HEADER "1,drive,0.5,0,1\n1,drive,0.5,1,1\n", 2, "only one position t1 = 0.5",
            "at least 2 x 2 nodes");
    refused(HEADER "1,drive,0,1,1\n1,drive,1,1,1\n", 2, "only one position t2 = 1",
            "at least 2 x 2 nodes");
}

static void a_grid_that_does_not_reach_from_0_to_1_is_refused(void) {
    refused(HEADER "*,*,1,0,1\n*,*,0.1,0,1\n*,*,1,1,1\n*,*,0.1,1,1\n", 3, "t1 = 0.1 as first",
            "from 0 to 1");
    refused(HEADER "*,*,0,0,1\n*,*,0,0.9,1\n*,*,1,0,1\n*,*,1,0.9,1\n", 3, "t2 = 0.9 as last",
            "from 0 to 1");
}

static void positions_outside_0_to_1_are_refused(void) {
    refused(HEADER "1,drive,-0.1,0,1\n", 2, "got '-0.1'", "t1: must be from 0 to 1");
    refused(HEADER "1,drive,1.00002,0,1\n", 2, "got '1.00002'", "t1: must be from 0 to 1");
    refused(HEADER "1,drive,0,-0.00002,1\n", 2, "got '-0.00002'", "t2: must be from 0 to 1");
    refused(HEADER "1,drive,0,17.5,1\n", 2, "got '17.5'", "t2: must be from 0 to 1");
    refused(HEADER "1,drive,0,1e300,1\n", 2, "got '1e300'", "t2: must be from 0 to 1");
}

static void positions_in_micrometres_of_grid_lines_are_refused(void) {
    /* More lines than the core takes: 20001, closer than the tolerance can tell apart. */
    static char text[2000000];
    char *end = text + sprintf(text, HEADER);
    for (int face = 0; face <= 20000; ++face) {
        end += sprintf(end, "*,*,%.6f,0,1\n*,*,%.6f,1,1\n", face / 20000.0, face / 20000.0);
    }
    refused(text, 2, "too close together", "2 to 10000 uniform ones");
}

static void as_many_grid_lines_as_the_core_takes_are_accepted(void) {
    static char text[1000000];
    char *end = text + sprintf(text, HEADER);
    for (int face = 0; face < 10000; ++face) {
        end += sprintf(end, "*,*,%.5f,0,1\n*,*,%.5f,1,2\n", face / 9999.0, face / 9999.0);
    }
    GM_ASSERT_INT(read_deviations(text), GM_IO_OK);
    GM_ASSERT_INT(deviations.face_nodes, 10000);
    gm_deviations_free(&deviations);
}

static void a_few_scattered_rows_do_not_ask_for_a_large_table(void) {
    /* One row on each of 10000 x 10000 grid lines: the full table would have 800 MB. */
    static char text[1000000];
    char *end = text + sprintf(text, HEADER);
    for (int line = 0; line < 10000; ++line) {
        end += sprintf(end, "*,*,%.5f,%.5f,1\n", line / 9999.0, line / 9999.0);
    }
    refused(text, 2, "none for t1 = 0, t2 = 0.00010001",
            "must have 100000000 rows for 10000 x 10000 nodes (got 10000");
}

/* ---------------------------------------------------------------------------------------------
 * Rows that are wrong
 * ------------------------------------------------------------------------------------------- */

static void a_pitch_file_in_place_of_deviations_is_refused(void) {
    refused("tooth,flank,deviation_um\n1,drive,1\n", 1, "'tooth,flank,deviation_um'",
            "must be tooth,flank,t1,t2,deviation_um");
}

static void a_file_without_rows_is_refused(void) {
    refused(HEADER, 1, "(got none)", "at least 2 x 2 nodes");
}

static void every_column_is_checked(void) {
    refused(HEADER "45,drive,0,0,1\n", 2, "got '45'", "tooth: must be a whole number from 0 to 44");
    refused(HEADER "1,right,0,0,1\n", 2, "got 'right'", "flank: must be drive, coast, or *");
    refused(HEADER "1,drive,x,0,1\n", 2, "got 'x'", "t1: must be a number like");
    refused(HEADER "1,drive,0,nan,1\n", 2, "got 'nan'", "t2: must be a number like");
    refused(HEADER "1,drive,0,0,1um\n", 2, "got '1um'", "deviation_um: must be a number like");
    refused(HEADER "1,drive,0,0\n", 2, "(got 4", "must have 5 fields");
    refused(HEADER "1,drive,0,0,1,5\n", 2, "decimal comma", "write 1.5");
}

/* ---------------------------------------------------------------------------------------------
 * Files that are none
 * ------------------------------------------------------------------------------------------- */

static void a_missing_file_is_named(void) {
    refused_path(IO_TEST_PATH("missing.csv"), GM_IO_ERR_FILE, 0, "cannot be opened",
                 "there is no such file");
}

static void a_folder_is_no_file(void) {
    refused_path(GM_TEST_FOLDER, GM_IO_ERR_FILE, 0, "it is a folder", "a file is needed");
}

static void a_file_that_may_not_be_read_is_named(void) {
    const char *path = file_of(HEADER SET("*,*"));
    const int hidden = chmod(path, 0) == 0;
    FILE *file = fopen(path, "rb"); /* an administrator may read it all the same */
    if (file != NULL) {
        fclose(file);
    } else if (GM_ASSERT(hidden)) {
        refused_path(path, GM_IO_ERR_FILE, 0, "cannot be opened", "permission denied");
    }
    GM_ASSERT_INT(remove(path), 0);
}

static void a_failure_to_read_is_named(void) {
    /* Opens for everybody and fails at the first byte, page 0; not there on other systems. */
    refused_path("/proc/self/mem", GM_IO_ERR_FILE, 0, "cannot be", "");
}

static void two_gigabytes_of_zeros_are_refused_at_the_first_byte(void) {
    const char *path = file_of("");
    if (!GM_ASSERT_INT(truncate(path, 2147483647L), 0)) {
        return;
    }
    refused_path(path, GM_IO_ERR_FORMAT, 1, "a zero byte", "UTF-8 text");
    GM_ASSERT_INT(remove(path), 0);
}

/* ---------------------------------------------------------------------------------------------
 * Writing
 * ------------------------------------------------------------------------------------------- */

enum { FACE_NODES = 7, PROFILE_NODES = 4, NODES = 28 };

static double values[3][NODES];
static gm_deviation_set sets[3];
static gm_deviations own;

static void make_own(uint64_t seed) {
    static const int tooth[3] = {-1, 0, 44};
    static const int side[3] = {GM_DRIVE, -1, GM_COAST};
    for (int i = 0; i < 3; ++i) {
        for (int node = 0; node < NODES; ++node) {
            values[i][node] = ldexp(gm_test_uniform(&seed, -1.0, 1.0), node - 30);
        }
        sets[i] = (gm_deviation_set){tooth[i], side[i], values[i]};
    }
    own = (gm_deviations){TEETH, FACE_NODES, PROFILE_NODES, 3, sets};
}

static void a_written_file_reads_back_to_the_same_bits(void) {
    static const char path[] = IO_TEST_PATH("out.csv");
    for (uint64_t seed = 0; seed < 20; ++seed) {
        make_own(seed);
        if (!GM_ASSERT_INT(gm_deviations_write(&own, path, &error), GM_IO_OK) ||
            !GM_ASSERT_INT(gm_deviations_read(&deviations, path, TEETH, &error), GM_IO_OK)) {
            break;
        }
        GM_ASSERT_INT(deviations.face_nodes, FACE_NODES);
        GM_ASSERT_INT(deviations.profile_nodes, PROFILE_NODES);
        GM_ASSERT_INT(deviations.set_count, 3);
        for (int i = 0; i < 3; ++i) {
            const gm_deviation_set *set = find_set(sets[i].tooth, sets[i].side);
            for (int node = 0; node < NODES && GM_ASSERT(set != NULL); ++node) {
                GM_ASSERT(same_bits(set->values[node], values[i][node]));
            }
        }
        gm_deviations_free(&deviations);
    }
    gm_deviations_free(&deviations);
}

/* Also those that a double holds with fewer digits, and the largest. */
static void values_of_any_size_read_back_to_the_same_bits(void) {
    static const double sizes[] = {4.9406564584124654e-324,
                                   1e-320,
                                   2.2250738585072009e-308,
                                   2.2250738585072014e-308,
                                   1e-304,
                                   1e-30,
                                   1e300,
                                   1e302};
    static const char path[] = IO_TEST_PATH("out.csv");
    make_own(0);
    for (int node = 0; node < NODES; ++node) {
        values[0][node] = (node % 2 ? -1.0 : 1.0) * sizes[node % 8];
    }
    GM_ASSERT_INT(gm_deviations_write(&own, path, &error), GM_IO_OK);
    if (!GM_ASSERT_INT(gm_deviations_read(&deviations, path, TEETH, &error), GM_IO_OK)) {
        return;
    }
    const gm_deviation_set *set = find_set(sets[0].tooth, sets[0].side);
    for (int node = 0; node < NODES && GM_ASSERT(set != NULL); ++node) {
        GM_ASSERT(same_bits(set->values[node], values[0][node]));
    }
    gm_deviations_free(&deviations);
}

/* One set of 2 x profile_nodes nodes with 1, 2, 3 .. um. */
static void assert_written(int profile_nodes, const char *expected) {
    static const char path[] = IO_TEST_PATH("out.csv");
    make_own(0);
    own.face_nodes = 2;
    own.profile_nodes = profile_nodes;
    own.set_count = 1;
    for (int node = 0; node < 2 * profile_nodes; ++node) {
        values[0][node] = (node + 1) / 1e6;
    }
    GM_ASSERT_INT(gm_deviations_write(&own, path, &error), GM_IO_OK);
    char text[1000] = "";
    FILE *file = fopen(path, "rb");
    if (GM_ASSERT(file != NULL)) {
        text[fread(text, 1, sizeof text - 1, file)] = '\0';
        fclose(file);
    }
    GM_ASSERT_STRING(text, expected);
}

static void a_written_file_is_what_a_user_would_write(void) {
    assert_written(2, HEADER SET("*,drive"));
    assert_written(4, HEADER "*,drive,0,0,1\n*,drive,0,0.333333,2\n*,drive,0,0.666667,3\n"
                             "*,drive,0,1,4\n*,drive,1,0,5\n*,drive,1,0.333333,6\n"
                             "*,drive,1,0.666667,7\n*,drive,1,1,8\n");
}

static void a_stream_gets_what_a_file_would_hold(void) {
    static const char path[] = IO_TEST_PATH("out.csv");
    make_own(3);
    FILE *stream = fopen(path, "wb");
    if (!GM_ASSERT(stream != NULL)) {
        return;
    }
    fputs("# a comment of the caller's\n", stream);
    GM_ASSERT_INT(gm_deviations_print(&own, stream, &error), GM_IO_OK);
    GM_ASSERT_INT(gm_deviations_print(NULL, stream, &error), GM_IO_ERR_NULL);
    GM_ASSERT_INT(gm_deviations_print(&own, NULL, &error), GM_IO_ERR_NULL);
    own.set_count = 0;
    GM_ASSERT_INT(gm_deviations_print(&own, stream, &error), GM_IO_ERR_OPTION);
    fclose(stream);

    if (GM_ASSERT_INT(gm_deviations_read(&deviations, path, TEETH, &error), GM_IO_OK)) {
        GM_ASSERT_INT(deviations.set_count, 3);
        GM_ASSERT(same_bits(find_set(sets[2].tooth, sets[2].side)->values[NODES - 1],
                            values[2][NODES - 1]));
    }
    gm_deviations_free(&deviations);

    FILE *full = fopen("/dev/full", "wb"); /* where a system has it */
    if (full != NULL) {
        make_own(3);
        GM_ASSERT_INT(gm_deviations_print(&own, full, &error), GM_IO_ERR_FILE);
        assert_error(&error, "", 0, "cannot be written", "");
        fclose(full);
    }
}

/* A locale with a decimal comma, made here. Returns 0 where the system cannot make one. */
static int use_decimal_comma(void) {
    static const char folder[] = IO_TEST_PATH("locales");
    static const char source[] = IO_TEST_PATH("comma");
    static const char make[] = "rm -rf \"$LOCPATH\" && mkdir \"$LOCPATH\" && "
                               "localedef -c -i \"$COMMA\" \"$LOCPATH/xx_XX\" >/dev/null 2>&1";

    FILE *file = fopen(source, "w");
    if (!GM_ASSERT(file != NULL)) {
        return 0;
    }
    fputs("LC_NUMERIC\ndecimal_point \",\"\nthousands_sep \".\"\ngrouping 3;3\nEND LC_NUMERIC\n",
          file);
    fclose(file);

    /* It warns of the categories that are missing, with a status of its own. */
    setenv("LOCPATH", folder, 1);
    setenv("COMMA", source, 1);
    (void)!system(make);
    return setlocale(LC_NUMERIC, "xx_XX") != NULL && *localeconv()->decimal_point == ',';
}

/* Whatever the program around the library has chosen: 17 digits go through strtod() and printf(). */
static void numbers_have_a_point_in_every_locale(void) {
    if (!use_decimal_comma()) {
        printf(" skipped: localedef makes no locale with a decimal comma ");
        return;
    }
    a_written_file_is_what_a_user_would_write();
    a_written_file_reads_back_to_the_same_bits();
    values_of_any_size_read_back_to_the_same_bits();

    const char *text = HEADER "*,*,0,0,-1.2345678901234567e-1\n*,*,0,1,0.10000000000000000555\n"
                              "*,*,1,0,3\n*,*,1,1,4\n";
    if (GM_ASSERT_INT(read_deviations(text), GM_IO_OK)) {
        GM_ASSERT(same_bits(deviations.sets[0].values[0], -0.12345678901234567e-6));
        GM_ASSERT(same_bits(deviations.sets[0].values[1], 0.10000000000000000555e-6));
    }
    gm_deviations_free(&deviations);
    setlocale(LC_NUMERIC, "C");
}

static void a_file_that_cannot_be_written_is_an_error(void) {
    make_own(0);
    GM_ASSERT_INT(gm_deviations_write(&own, GM_TEST_FOLDER, &error), GM_IO_ERR_FILE);
    assert_error(&error, GM_TEST_FOLDER, 0, "cannot be opened for writing", "a file is needed");
    FILE *full = fopen("/dev/full", "wb"); /* where a system has it */
    if (full != NULL) {
        fclose(full);
        GM_ASSERT_INT(gm_deviations_write(&own, "/dev/full", &error), GM_IO_ERR_FILE);
        assert_error(&error, "/dev/full", 0, "cannot be written", "");
    }
}

/* Tries to write and expects a refusal that leaves no file. */
static void not_written(const char *value) {
    static const char path[] = IO_TEST_PATH("never.csv");
    remove(path);
    GM_ASSERT_INT(gm_deviations_write(&own, path, &error), GM_IO_ERR_OPTION);
    assert_error(&error, path, 0, value, "");
    FILE *file = fopen(path, "rb");
    GM_ASSERT(file == NULL);
    if (file != NULL) {
        fclose(file);
    }
}

static void what_could_not_be_read_back_is_not_written(void) {
    make_own(0);
    values[1][5] = (double)NAN;
    not_written("set 1 of the deviations: all values must be finite");
    make_own(0);
    sets[2].tooth = 45;
    not_written("(got tooth 45 and side 1)");
    make_own(0);
    sets[2].side = 2;
    not_written("side 2");
    make_own(0);
    sets[2].values = NULL;
    not_written("without values");
    make_own(0);
    sets[2] = sets[0];
    not_written("tooth *, flank drive: must have one set of deviations (got two, 0 and 2)");
    make_own(0);
    own.set_count = 0;
    not_written("deviations to write: must be at least one set");
    make_own(0);
    own.sets = NULL;
    not_written("must have the sets that they count");
    make_own(0);
    own.profile_nodes = 1;
    not_written("(got 7 x 1)");
    make_own(0);
    own.face_nodes = 1;
    not_written("(got 1 x 4)");
    make_own(0);
    own.face_nodes = 10001;
    not_written("(got 10001 x 4)");
    make_own(0);
    own.teeth = 2;
    not_written("(got 2)");
}

static void a_call_without_a_required_pointer_is_refused(void) {
    const char *path = file_of(HEADER SET("*,*"));
    GM_ASSERT_INT(gm_deviations_read(NULL, path, TEETH, &error), GM_IO_ERR_NULL);
    GM_ASSERT_INT(gm_deviations_read(&deviations, NULL, TEETH, &error), GM_IO_ERR_NULL);
    GM_ASSERT_INT(gm_deviations_write(NULL, path, &error), GM_IO_ERR_NULL);
    GM_ASSERT_INT(gm_deviations_write(&deviations, NULL, &error), GM_IO_ERR_NULL);
    GM_ASSERT_INT(gm_deviations_read(&deviations, path, TEETH, NULL), GM_IO_OK);
    gm_deviations_free(&deviations);
    gm_deviations_free(NULL);
}

/* ---------------------------------------------------------------------------------------------
 * Size
 * ------------------------------------------------------------------------------------------- */

static void write_large_file(const char *path, int teeth, int face_nodes, int profile_nodes) {
    FILE *file = fopen(path, "wb");
    if (!GM_ASSERT(file != NULL)) {
        return;
    }
    uint64_t seed = 3;
    fprintf(file, HEADER);
    for (int flank = 0; flank < 2 * teeth; ++flank) {
        for (int face = 0; face < face_nodes; ++face) {
            for (int profile = 0; profile < profile_nodes; ++profile) {
                fprintf(file, "%d,%s,%.6g,%.6g,%.4f\n", flank / 2, flank % 2 ? "coast" : "drive",
                        (double)face / (face_nodes - 1), (double)profile / (profile_nodes - 1),
                        gm_test_uniform(&seed, -20.0, 20.0));
            }
        }
    }
    GM_ASSERT_INT(fclose(file), 0);
}

static void a_file_of_a_whole_gear_is_loaded(void) {
    static const char path[] = IO_TEST_PATH("large.csv");
    write_large_file(path, 45, 21, 31);
    GM_ASSERT_INT(gm_deviations_read(&deviations, path, TEETH, &error), GM_IO_OK);
    GM_ASSERT_INT(deviations.set_count, 90);
    GM_ASSERT_INT(deviations.face_nodes, 21);
    GM_ASSERT_INT(deviations.profile_nodes, 31);
    gm_deviations_free(&deviations);
    GM_ASSERT_INT(remove(path), 0);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(nodes_are_stored_along_the_face_first_then_along_the_profile),
        GM_TEST(every_kind_of_set_is_kept_apart),
        GM_TEST(rows_may_come_in_any_order),
        GM_TEST(lines_may_lie_across_what_is_read_at_a_time),
        GM_TEST(a_number_means_the_same_however_its_row_is_written),
        GM_TEST(positions_may_be_rounded_to_1e_5),
        GM_TEST(a_set_that_serves_all_leaves_no_tooth_ideal),
        GM_TEST(a_missing_node_is_named),
        GM_TEST(a_node_missing_in_a_later_set_is_named),
        GM_TEST(a_repeated_node_is_named),
        GM_TEST(a_line_of_nodes_that_is_mostly_missing_is_named),
        GM_TEST(a_file_that_holds_everything_twice_is_refused),
        GM_TEST(an_uneven_grid_is_refused),
        GM_TEST(one_wrong_position_among_many_rows_is_the_one_that_is_named),
        GM_TEST(a_grid_that_differs_between_sets_is_refused),
        GM_TEST(fewer_than_two_nodes_along_a_direction_are_refused),
        GM_TEST(a_grid_that_does_not_reach_from_0_to_1_is_refused),
        GM_TEST(positions_outside_0_to_1_are_refused),
        GM_TEST(positions_in_micrometres_of_grid_lines_are_refused),
        GM_TEST(as_many_grid_lines_as_the_core_takes_are_accepted),
        GM_TEST(a_few_scattered_rows_do_not_ask_for_a_large_table),
        GM_TEST(a_pitch_file_in_place_of_deviations_is_refused),
        GM_TEST(a_file_without_rows_is_refused),
        GM_TEST(every_column_is_checked),
        GM_TEST(a_missing_file_is_named),
        GM_TEST(a_folder_is_no_file),
        GM_TEST(a_file_that_may_not_be_read_is_named),
        GM_TEST(a_failure_to_read_is_named),
        GM_TEST(two_gigabytes_of_zeros_are_refused_at_the_first_byte),
        GM_TEST(a_written_file_reads_back_to_the_same_bits),
        GM_TEST(values_of_any_size_read_back_to_the_same_bits),
        GM_TEST(a_stream_gets_what_a_file_would_hold),
        GM_TEST(a_written_file_is_what_a_user_would_write),
        GM_TEST(numbers_have_a_point_in_every_locale),
        GM_TEST(a_file_that_cannot_be_written_is_an_error),
        GM_TEST(what_could_not_be_read_back_is_not_written),
        GM_TEST(a_call_without_a_required_pointer_is_refused),
        GM_TEST(a_file_of_a_whole_gear_is_loaded),
    };
    return gm_test_main("unit.deviation_file", tests, GM_TEST_COUNT(tests), argc, argv);
}
