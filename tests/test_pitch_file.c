/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Pitch files, and what they share with deviation files: lines, fields, numbers. A row of them is short, so
 * that each line of text shows one rule.
 */
#include "io_test.h"

#define TEETH  5
#define HEADER "tooth,flank,deviation_um\n"

static gm_pitch pitch;
static gm_io_error error;

static int read_pitch(const char *text) {
    return gm_pitch_read(&pitch, file_of(text), TEETH, &error);
}

/* Reads text that must be refused, in a line, naming a value and what would be right. */
static void refused_bytes(const char *text, size_t size, long line, const char *value,
                          const char *right) {
    const char *path = file_of_bytes(text, size);
    GM_ASSERT_INT(gm_pitch_read(&pitch, path, TEETH, &error), GM_IO_ERR_FORMAT);
    assert_error(&error, path, line, value, right);
    GM_ASSERT(pitch.drive == NULL && pitch.coast == NULL && pitch.teeth == 0);
    GM_ASSERT(pitch.drive_set == NULL && pitch.coast_set == NULL);
    gm_pitch_free(&pitch);
}

static void refused(const char *text, long line, const char *value, const char *right) {
    refused_bytes(text, strlen(text), line, value, right);
}

/* Reads text that must be accepted and give this deviation (m) for the drive flank of tooth 1. */
static void accepted(const char *text, double expected) {
    if (GM_ASSERT_INT(read_pitch(text), GM_IO_OK)) {
        GM_ASSERT_REL(pitch.drive[1], expected, 0.0);
        GM_ASSERT_STRING(error.text, "");
    }
    gm_pitch_free(&pitch);
}

/* ---------------------------------------------------------------------------------------------
 * Text
 * ------------------------------------------------------------------------------------------- */

static void a_plain_file_is_read(void) {
    accepted(HEADER "1,drive,3\n", 3e-6);
}

static void the_last_line_may_lack_its_end(void) {
    accepted(HEADER "1,drive,3", 3e-6);
}

static void line_ends_of_windows_are_accepted(void) {
    accepted("tooth,flank,deviation_um\r\n1,drive,3\r\n", 3e-6);
}

static void a_byte_order_mark_is_accepted(void) {
    accepted("\xEF\xBB\xBF" HEADER "1,drive,3\n", 3e-6);
}

static void a_byte_order_mark_within_the_file_is_refused(void) {
    refused(HEADER "\xEF\xBB\xBF"
                   "1,drive,3\n",
            2, "'???1'", "a whole number from 0 to 4");
}

static void blank_lines_and_comments_are_skipped(void) {
    accepted("# measured on a Monday, with commas\n\n" HEADER
             "  \t\n1,drive,3\n  # 1,drive,4\n\r\n\n",
             3e-6);
}

static void white_space_around_a_field_is_dropped(void) {
    accepted(" tooth, flank ,\tdeviation_um \n 1 ,\tdrive , 3 \n", 3e-6);
}

static void a_comment_may_be_longer_than_any_row(void) {
    char text[6000] = "#";
    memset(text + 1, 'x', 5000);
    strcpy(text + 5001, "\n" HEADER "1,drive,3\n");
    accepted(text, 3e-6);
}

static void an_error_behind_comments_and_blank_lines_names_its_own_line(void) {
    refused("# one\n\n" HEADER "\n# five\n1,drive,x\n", 6, "'x'", "a number like");
}

static void a_row_longer_than_a_line_can_be_is_refused(void) {
    char text[6000] = HEADER "1,drive,0.";
    const size_t used = strlen(text);
    memset(text + used, '1', 5000);
    strcpy(text + used + 5000, "\n");
    refused(text, 2, "(got more)", "a line must be one row of at most 1000 characters");
}

static void a_header_longer_than_a_line_can_be_is_refused(void) {
    char text[6000] = "";
    memset(text, 'x', 5000);
    refused(text, 1, "(got more)", "a line must be one row of at most 1000 characters");
}

static void a_zero_byte_is_refused_wherever_it_stands(void) {
    static const char in_row[] = HEADER "1,drive,3\0\n";
    refused_bytes(in_row, sizeof in_row - 1, 2, "a zero byte", "UTF-8 text");
    static const char at_end[] = HEADER "1,drive,3\n\0";
    refused_bytes(at_end, sizeof at_end - 1, 3, "a zero byte", "UTF-8 text");
    static const char in_comment[] = "# a\0b\n" HEADER "1,drive,3\n";
    refused_bytes(in_comment, sizeof in_comment - 1, 1, "a zero byte", "UTF-8 text");
}

static void a_file_in_utf_16_is_refused(void) {
    static const char text[] = "\xFF\xFEt\0o\0o\0t\0h\0";
    refused_bytes(text, sizeof text - 1, 1, "a zero byte", "UTF-8 text");
}

static void line_ends_of_old_macs_are_refused(void) {
    refused("tooth,flank,deviation_um\r1,drive,3\r", 1, "a carriage return", "LF or CRLF");
    refused("# comment\rtooth,flank,deviation_um\r", 1, "a carriage return", "LF or CRLF");
}

/* ---------------------------------------------------------------------------------------------
 * Header and fields
 * ------------------------------------------------------------------------------------------- */

static void an_empty_file_is_refused(void) {
    refused("", 0, "(got nothing)", "the file must have the header line tooth,flank,deviation_um");
    refused("# nothing but this\n\n", 2, "(got nothing)",
            "the file must have the header line tooth,flank,deviation_um");
}

static void a_file_without_rows_is_refused(void) {
    refused(HEADER, 1, "(got none)", "at least one");
    refused(HEADER "# 1,drive,3\n\n", 3, "(got none)", "at least one");
}

static void a_missing_header_is_refused(void) {
    refused("1,drive,3\n", 1, "got the row '1,drive,3'", "tooth,flank,deviation_um");
    refused("*,drive,3\n", 1, "got the row '*,drive,3'", "tooth,flank,deviation_um");
}

static void a_wrong_header_is_refused(void) {
    refused("tooth,flank,t1,t2,deviation_um\n1,drive,0,0,1\n", 1,
            "'tooth,flank,t1,t2,deviation_um'", "must be tooth,flank,deviation_um");
    refused("tooth,flank,deviation\n1,drive,1\n", 1, "'tooth,flank,deviation'",
            "must be tooth,flank,deviation_um");
    refused("tooth,flank\n1,drive\n", 1, "'tooth,flank'", "must be tooth,flank,deviation_um");
    refused("tooth,flank,deviation_um,note\n1,drive,1\n", 1, "'tooth,flank,deviation_um,note'",
            "must be tooth,flank,deviation_um");
    refused("flank,tooth,deviation_um\ndrive,1,1\n", 1, "'flank,tooth,deviation_um'",
            "must be tooth,flank,deviation_um");
    refused("Tooth,flank,deviation_um\n1,drive,1\n", 1, "'Tooth,flank,deviation_um'",
            "must be tooth,flank,deviation_um");
}

static void a_second_header_is_refused(void) {
    refused(HEADER HEADER "1,drive,3\n", 2, "'tooth'", "a whole number from 0 to 4");
}

static void other_delimiters_are_named(void) {
    refused("tooth;flank;deviation_um\n1;drive;3\n", 1, "semicolons", "commas");
    refused("tooth\tflank\tdeviation_um\n1\tdrive\t3\n", 1, "tabs", "commas");
    refused(HEADER "1;drive;3\n", 2, "semicolons", "commas");
    refused(HEADER "1;drive;3,5\n", 2, "semicolons", "commas");
    refused(HEADER "1\tdrive\t3\n", 2, "tabs", "commas");
}

static void a_short_line_is_refused(void) {
    refused(HEADER "1,drive\n", 2, "(got 2", "must have 3 fields, tooth,flank,deviation_um");
    refused(HEADER "1\n", 2, "(got 1", "must have 3 fields, tooth,flank,deviation_um");
}

static void a_line_with_too_many_fields_is_refused(void) {
    refused(HEADER "1,drive,3,4\n", 2, "(got 4", "must have 3 fields, tooth,flank,deviation_um");
    refused(HEADER "1,drive,3,\n", 2, "(got 4", "must have 3 fields, tooth,flank,deviation_um");
    refused(HEADER "1,,,,,,,,,\n", 2, "(got 10", "must have 3 fields, tooth,flank,deviation_um");
}

static void a_decimal_comma_is_named(void) {
    refused(HEADER "1,drive,1,5\n", 2, "decimal comma", "write 1.5");
}

/* ---------------------------------------------------------------------------------------------
 * Tooth and flank
 * ------------------------------------------------------------------------------------------- */

static void the_first_and_the_last_tooth_are_accepted(void) {
    if (GM_ASSERT_INT(read_pitch(HEADER "0,drive,1\n4,coast,2\n"), GM_IO_OK)) {
        GM_ASSERT_REL(pitch.drive[0], 1e-6, 0.0);
        GM_ASSERT_REL(pitch.coast[4], 2e-6, 0.0);
    }
    gm_pitch_free(&pitch);
}

static void a_tooth_beyond_the_gear_is_refused(void) {
    refused(HEADER "5,drive,1\n", 2, "got '5'",
            "tooth: must be a whole number from 0 to 4 (the gear has 5 teeth)");
    refused(HEADER "4294967296,drive,1\n", 2, "'4294967296'", "from 0 to 4");
    refused(HEADER "99999999999999999999,drive,1\n", 2, "'99999999999999999999'", "from 0 to 4");
}

static void tooth_45_of_45_is_refused(void) {
    const char *path = file_of(HEADER "44,drive,1\n45,drive,1\n");
    GM_ASSERT_INT(gm_pitch_read(&pitch, path, 45, &error), GM_IO_ERR_FORMAT);
    assert_error(&error, path, 3, "'45'", "from 0 to 44 (the gear has 45 teeth)");
}

static void a_negative_tooth_is_refused(void) {
    refused(HEADER "-1,drive,1\n", 2, "'-1'", "from 0 to 4");
}

static void a_tooth_that_is_no_whole_number_is_refused(void) {
    refused(HEADER "1.0,drive,1\n", 2, "'1.0'", "a whole number");
    refused(HEADER "1.5,drive,1\n", 2, "'1.5'", "a whole number");
    refused(HEADER "0x1,drive,1\n", 2, "'0x1'", "a whole number");
    refused(HEADER "1e0,drive,1\n", 2, "'1e0'", "a whole number");
    refused(HEADER "one,drive,1\n", 2, "'one'", "a whole number");
    refused(HEADER ",drive,1\n", 2, "''", "a whole number");
    refused(HEADER "1 2,drive,1\n", 2, "'1 2'", "a whole number");
    refused(HEADER "**,drive,1\n", 2, "'**'", "or * for all teeth");
}

static void an_unknown_flank_is_refused(void) {
    refused(HEADER "1,left,1\n", 2, "got 'left'", "flank: must be drive, coast, or *");
    refused(HEADER "1,Drive,1\n", 2, "'Drive'", "drive, coast, or *");
    refused(HEADER "1,drivee,1\n", 2, "'drivee'", "drive, coast, or *");
    refused(HEADER "1,,1\n", 2, "''", "drive, coast, or *");
    refused(HEADER "1,\"drive\",1\n", 2, "'\"drive\"'", "drive, coast, or *");
}

static void what_is_quoted_is_short_and_printable(void) {
    refused(HEADER "1,\x1b[31mred\xc3\xa4,1\n", 2,
            "'?[31mred?"
            "?'",
            "drive, coast, or *");
    char text[400] = HEADER "1,";
    const size_t used = strlen(text);
    memset(text + used, 'y', 300);
    strcpy(text + used + 300, ",1\n");
    refused(text, 2, "yyy...'", "drive, coast, or *");
    GM_ASSERT(strlen(error.text) < 150);
}

static void the_most_special_row_wins_in_any_order(void) {
    static const char *const rows[] = {"*,*,1\n", "*,drive,2\n", "3,*,4\n", "3,drive,8\n"};
    /* Expected for tooth 3 drive, tooth 3 coast, tooth 0 drive, tooth 0 coast; by the rule: tooth and
       flank, then tooth, then flank, then all. Bit i of `present`: row i is there. */
    for (int present = 1; present < 16; ++present) {
        const double all = present & 1 ? 1e-6 : 0.0;
        const double drive = present & 2 ? 2e-6 : all;
        const double own = present & 4 ? 4e-6 : -1.0;
        const double expected[4] = {present & 8  ? 8e-6
                                    : own >= 0.0 ? own
                                                 : drive,
                                    own >= 0.0 ? own : all, drive, all};
        for (int backward = 0; backward < 2; ++backward) {
            char text[200] = HEADER;
            for (int i = 0; i < 4; ++i) {
                const int row = backward ? 3 - i : i;
                strcat(text, present & (1 << row) ? rows[row] : "");
            }
            gm_test_context("present %d backward %d", present, backward);
            if (GM_ASSERT_INT(read_pitch(text), GM_IO_OK)) {
                GM_ASSERT_REL(pitch.drive[3], expected[0], 0.0);
                GM_ASSERT_REL(pitch.coast[3], expected[1], 0.0);
                GM_ASSERT_REL(pitch.drive[0], expected[2], 0.0);
                GM_ASSERT_REL(pitch.coast[0], expected[3], 0.0);
            }
            gm_pitch_free(&pitch);
        }
    }
}

static void a_repeated_row_is_refused(void) {
    refused(HEADER "1,drive,1\n2,drive,1\n1,drive,2\n", 4, "tooth 1, flank drive",
            "the first is in line 2");
    refused(HEADER "*,*,1\n*,*,1\n", 3, "tooth *, flank *", "the first is in line 2");
    refused(HEADER "3,*,1\n3,*,1\n", 3, "tooth 3, flank *", "the first is in line 2");
}

static void teeth_without_rows_are_counted(void) {
    GM_ASSERT_INT(read_pitch(HEADER "1,drive,0\n2,*,0\n"), GM_IO_OK);
    GM_ASSERT_INT(gm_pitch_ideal_teeth(&pitch, GM_DRIVE), 3);
    GM_ASSERT_INT(gm_pitch_ideal_teeth(&pitch, GM_COAST), 4);
    GM_ASSERT_INT(gm_pitch_ideal_teeth(&pitch, 2), 0);
    GM_ASSERT_INT(gm_pitch_ideal_teeth(NULL, GM_DRIVE), 0);
    gm_pitch_free(&pitch);
    GM_ASSERT_INT(read_pitch(HEADER "*,coast,0\n"), GM_IO_OK);
    GM_ASSERT_INT(gm_pitch_ideal_teeth(&pitch, GM_DRIVE), 5);
    GM_ASSERT_INT(gm_pitch_ideal_teeth(&pitch, GM_COAST), 0);
    gm_pitch_free(&pitch);
}

/* ---------------------------------------------------------------------------------------------
 * Numbers
 * ------------------------------------------------------------------------------------------- */

/* Reads one number and holds it against the same in metres as the compiler understands it. */
static void number_is(const char *text, double expected) {
    char file[200];
    snprintf(file, sizeof file, HEADER "1,drive,%s\n", text);
    gm_test_context("%s", text);
    if (GM_ASSERT_INT(read_pitch(file), GM_IO_OK)) {
        GM_ASSERT(same_bits(pitch.drive[1], expected));
    }
    gm_pitch_free(&pitch);
}

static void number_is_refused(const char *text) {
    char file[200];
    snprintf(file, sizeof file, HEADER "1,drive,%s\n", text);
    char quoted[100];
    snprintf(quoted, sizeof quoted, "(got '%s')", text);
    refused(file, 2, quoted, "deviation_um: must be a number like 1.5");
}

static void plain_and_exponent_numbers_are_read(void) {
    number_is("0", 0.0);
    number_is("-0", -0.0);
    number_is("7", 7e-6);
    number_is("+7", 7e-6);
    number_is("-12.5", -12.5e-6);
    number_is(".5", 0.5e-6);
    number_is("5.", 5e-6);
    number_is("007.250", 7.25e-6);
    number_is("1e3", 1e-3);
    number_is("1E+3", 1e-3);
    number_is("-2.5e-3", -2.5e-9);
    number_is("0e99999", 0.0);
    number_is("1e-400", 0.0);
    number_is("179769313486231570e297", 1.7976931348623157e308);
    number_is("4.940656458412465e-318", 4.940656458412465e-324);
}

static void numbers_of_many_digits_are_read_correctly_rounded(void) {
    number_is("0.1000000000000000055511151231257827021181583404541015625",
              0.1000000000000000055511151231257827021181583404541015625e-6);
    number_is("9007199254740993", 9007199254740993e-6);
    number_is("0.00000000000000000000000000000000000000012345678901234567890",
              0.00000000000000000000000000000000000000012345678901234567890e-6);
    number_is("123456789012345678901234567890", 123456789012345678901234567890e-6);
}

static void any_decimal_is_the_nearest_double_in_metres(void) {
    enum { MANY = 2000, ROOM = 100 };
    static char text[MANY * ROOM] = HEADER;
    static double expected[MANY];
    uint64_t seed = 11;
    char *end = text + strlen(text);
    for (int tooth = 0; tooth < MANY; ++tooth) {
        char number[60];
        char metres[80];
        const int decimals = gm_test_integer(&seed, 0, 18);
        snprintf(number, sizeof number, "%.*f", decimals, gm_test_uniform(&seed, -200.0, 200.0));
        snprintf(metres, sizeof metres, "%se-6", number);
        expected[tooth] = strtod(metres, NULL);
        end += sprintf(end, "%d,drive,%s\n", tooth, number);
    }
    if (GM_ASSERT_INT(gm_pitch_read(&pitch, file_of(text), MANY, &error), GM_IO_OK)) {
        for (int tooth = 0; tooth < MANY; ++tooth) {
            gm_test_context("tooth %d: %.17g m", tooth, expected[tooth]);
            GM_ASSERT(same_bits(pitch.drive[tooth], expected[tooth]));
        }
    }
    gm_pitch_free(&pitch);
}

static void hexadecimal_nan_and_inf_are_no_numbers(void) {
    number_is_refused("0x10");
    number_is_refused("0x1p3");
    number_is_refused("nan");
    number_is_refused("NaN");
    number_is_refused("nan(1)");
    number_is_refused("inf");
    number_is_refused("-Infinity");
}

static void text_where_a_number_belongs_is_refused(void) {
    number_is_refused("abc");
    number_is_refused("");
    number_is_refused("-");
    number_is_refused(".");
    number_is_refused("+-1");
    number_is_refused("--1");
    number_is_refused("e5");
    number_is_refused("1 000");
    number_is_refused("1'000");
}

static void text_behind_a_number_is_refused(void) {
    number_is_refused("1.5um");
    number_is_refused("1.5.2");
    number_is_refused("1e");
    number_is_refused("1e+");
    number_is_refused("1e5.5");
    number_is_refused("1d5");
    number_is_refused("1.5 # why");
    number_is_refused("1.5f");
}

static void a_number_beyond_the_range_of_a_double_is_refused(void) {
    refused(HEADER "1,drive,1e400\n", 2, "'1e400', which is too large", "a number like");
    refused(HEADER "1,drive,-1e400\n", 2, "'-1e400', which is too large", "a number like");
    refused(HEADER "1,drive,1e4294967297\n", 2, "which is too large", "a number like");
    refused(HEADER "1,drive,1e99999999999999999999\n", 2, "which is too large", "a number like");
}

/* ---------------------------------------------------------------------------------------------
 * Calls
 * ------------------------------------------------------------------------------------------- */

static void a_call_without_a_required_pointer_is_refused(void) {
    const char *path = file_of(HEADER "1,drive,3\n");
    GM_ASSERT_INT(gm_pitch_read(NULL, path, TEETH, &error), GM_IO_ERR_NULL);
    GM_ASSERT_INT(gm_pitch_read(&pitch, NULL, TEETH, &error), GM_IO_ERR_NULL);
    GM_ASSERT_STRING(error.file, "");
    GM_ASSERT_INT(gm_pitch_write(NULL, path, &error), GM_IO_ERR_NULL);
    GM_ASSERT_INT(gm_pitch_write(&pitch, NULL, &error), GM_IO_ERR_NULL);
    gm_pitch_free(NULL);
}

static void the_error_may_be_left_out(void) {
    GM_ASSERT_INT(gm_pitch_read(&pitch, file_of(HEADER "1,drive,x\n"), TEETH, NULL),
                  GM_IO_ERR_FORMAT);
    GM_ASSERT_INT(gm_pitch_read(&pitch, file_of(HEADER "1,drive,3\n"), TEETH, NULL), GM_IO_OK);
    gm_pitch_free(&pitch);
}

static void impossible_numbers_of_teeth_are_refused(void) {
    const char *path = file_of(HEADER "1,drive,3\n");
    GM_ASSERT_INT(gm_pitch_read(&pitch, path, 2, &error), GM_IO_ERR_OPTION);
    GM_ASSERT_INT(gm_pitch_read(&pitch, path, -1, &error), GM_IO_ERR_OPTION);
    GM_ASSERT_INT(gm_pitch_read(&pitch, path, 100001, &error), GM_IO_ERR_OPTION);
    GM_ASSERT_INT(gm_pitch_read(&pitch, path, 100000, &error), GM_IO_OK);
    gm_pitch_free(&pitch);
}

/* ---------------------------------------------------------------------------------------------
 * Writing
 * ------------------------------------------------------------------------------------------- */

static double drive[TEETH];
static double coast[TEETH];
static int drive_set[TEETH];
static int coast_set[TEETH];
static gm_pitch own;

static void make_own(void) {
    own = (gm_pitch){TEETH, drive, coast, drive_set, coast_set};
    for (int tooth = 0; tooth < TEETH; ++tooth) {
        drive[tooth] = 1.5e-6 * tooth;
        coast[tooth] = -0.25e-6;
        drive_set[tooth] = 1;
        coast_set[tooth] = tooth == 2 ? 1 : 0;
    }
}

static void a_written_file_reads_back_to_the_same_bits(void) {
    enum { MANY = 5000 };
    static const char path[] = IO_TEST_PATH("out.csv");
    static double many[MANY] = {-0.0,
                                1.0 / 3.0,
                                4.940656458412465e-324,
                                1.5e-6,
                                1.7976931348623157e308,
                                -2.2250738585072014e-308,
                                1e-5,
                                0.1,
                                123456789.0};
    static int all_set[MANY];
    uint64_t seed = 5;
    for (int tooth = 0; tooth < MANY; ++tooth) {
        all_set[tooth] = 1;
        if (tooth >= 9) {
            many[tooth] = ldexp(gm_test_uniform(&seed, -1.0, 1.0), tooth % 40 - 30);
        }
    }
    const gm_pitch written = {MANY, many, many, all_set, all_set};
    GM_ASSERT_INT(gm_pitch_write(&written, path, &error), GM_IO_OK);
    if (GM_ASSERT_INT(gm_pitch_read(&pitch, path, MANY, &error), GM_IO_OK)) {
        for (int tooth = 0; tooth < MANY; ++tooth) {
            gm_test_context("%.17g", many[tooth]);
            GM_ASSERT(same_bits(pitch.drive[tooth], many[tooth]));
            GM_ASSERT(same_bits(pitch.coast[tooth], many[tooth]));
        }
    }
    gm_pitch_free(&pitch);
}

static void a_written_file_holds_the_rows_that_are_set_and_no_others(void) {
    static const char path[] = IO_TEST_PATH("out.csv");
    make_own();
    drive[0] = -1.25e-11;
    drive[1] = 1.25e-13;
    drive[2] = 0.0;
    drive[3] = 1.2e8;
    drive[4] = 1.2e12;
    GM_ASSERT_INT(gm_pitch_write(&own, path, &error), GM_IO_OK);
    char text[1000] = "";
    FILE *file = fopen(path, "rb");
    if (GM_ASSERT(file != NULL)) {
        text[fread(text, 1, sizeof text - 1, file)] = '\0';
        fclose(file);
    }
    GM_ASSERT_STRING(text, HEADER "0,drive,-0.0000125\n1,drive,1.25e-7\n2,drive,0\n"
                                  "2,coast,-0.25\n3,drive,120000000000000\n4,drive,1.2e18\n");
}

static void a_file_that_cannot_be_written_is_an_error(void) {
    make_own();
    GM_ASSERT_INT(gm_pitch_write(&own, GM_TEST_FOLDER, &error), GM_IO_ERR_FILE);
    assert_error(&error, GM_TEST_FOLDER, 0, "cannot be opened for writing", "a file is needed");
    GM_ASSERT_INT(gm_pitch_write(&own, IO_TEST_PATH("none/out.csv"), &error), GM_IO_ERR_FILE);
    assert_error(&error, IO_TEST_PATH("none/out.csv"), 0, "cannot be opened", "no such file");
}

static void a_full_disk_is_an_error(void) {
    FILE *full = fopen("/dev/full", "wb"); /* where a system has it */
    if (full == NULL) {
        return;
    }
    fclose(full);
    make_own();
    GM_ASSERT_INT(gm_pitch_write(&own, "/dev/full", &error), GM_IO_ERR_FILE);
    assert_error(&error, "/dev/full", 0, "cannot be written", "");
    full = fopen("/dev/full", "wb");
    if (GM_ASSERT(full != NULL)) {
        GM_ASSERT_INT(gm_pitch_print(&own, full, &error), GM_IO_ERR_FILE);
        assert_error(&error, "", 0, "cannot be written", "");
        fclose(full);
    }
}

static void a_stream_gets_what_a_file_would_hold(void) {
    static const char path[] = IO_TEST_PATH("out.csv");
    make_own();
    FILE *stream = fopen(path, "wb");
    if (!GM_ASSERT(stream != NULL)) {
        return;
    }
    fputs("# a comment of the caller's\n", stream);
    GM_ASSERT_INT(gm_pitch_print(&own, stream, &error), GM_IO_OK);
    GM_ASSERT_INT(gm_pitch_print(NULL, stream, &error), GM_IO_ERR_NULL);
    GM_ASSERT_INT(gm_pitch_print(&own, NULL, &error), GM_IO_ERR_NULL);
    fclose(stream);

    if (GM_ASSERT_INT(gm_pitch_read(&pitch, path, own.teeth, &error), GM_IO_OK)) {
        for (int tooth = 0; tooth < own.teeth; ++tooth) {
            GM_ASSERT_INT(pitch.drive_set[tooth], own.drive_set[tooth]);
            GM_ASSERT(!own.drive_set[tooth] || same_bits(pitch.drive[tooth], own.drive[tooth]));
        }
    }
    gm_pitch_free(&pitch);
}

static void what_could_not_be_read_back_is_not_written(void) {
    static const char path[] = IO_TEST_PATH("never.csv");
    remove(path);
    make_own();
    drive[3] = (double)NAN;
    GM_ASSERT_INT(gm_pitch_write(&own, path, &error), GM_IO_ERR_OPTION);
    make_own();
    coast[4] = -(double)INFINITY;
    GM_ASSERT_INT(gm_pitch_write(&own, path, &error), GM_IO_ERR_OPTION);
    make_own();
    own.teeth = 2;
    GM_ASSERT_INT(gm_pitch_write(&own, path, &error), GM_IO_ERR_OPTION);
    make_own();
    own.coast = NULL;
    GM_ASSERT_INT(gm_pitch_write(&own, path, &error), GM_IO_ERR_NULL);
    make_own();
    memset(drive_set, 0, sizeof drive_set);
    memset(coast_set, 0, sizeof coast_set);
    GM_ASSERT_INT(gm_pitch_write(&own, path, &error), GM_IO_ERR_OPTION);
    FILE *file = fopen(path, "rb");
    GM_ASSERT(file == NULL);
    if (file != NULL) {
        fclose(file);
    }
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(a_plain_file_is_read),
        GM_TEST(the_last_line_may_lack_its_end),
        GM_TEST(line_ends_of_windows_are_accepted),
        GM_TEST(a_byte_order_mark_is_accepted),
        GM_TEST(a_byte_order_mark_within_the_file_is_refused),
        GM_TEST(blank_lines_and_comments_are_skipped),
        GM_TEST(white_space_around_a_field_is_dropped),
        GM_TEST(a_comment_may_be_longer_than_any_row),
        GM_TEST(an_error_behind_comments_and_blank_lines_names_its_own_line),
        GM_TEST(a_row_longer_than_a_line_can_be_is_refused),
        GM_TEST(a_header_longer_than_a_line_can_be_is_refused),
        GM_TEST(a_zero_byte_is_refused_wherever_it_stands),
        GM_TEST(a_file_in_utf_16_is_refused),
        GM_TEST(line_ends_of_old_macs_are_refused),
        GM_TEST(an_empty_file_is_refused),
        GM_TEST(a_file_without_rows_is_refused),
        GM_TEST(a_missing_header_is_refused),
        GM_TEST(a_wrong_header_is_refused),
        GM_TEST(a_second_header_is_refused),
        GM_TEST(other_delimiters_are_named),
        GM_TEST(a_short_line_is_refused),
        GM_TEST(a_line_with_too_many_fields_is_refused),
        GM_TEST(a_decimal_comma_is_named),
        GM_TEST(the_first_and_the_last_tooth_are_accepted),
        GM_TEST(a_tooth_beyond_the_gear_is_refused),
        GM_TEST(tooth_45_of_45_is_refused),
        GM_TEST(a_negative_tooth_is_refused),
        GM_TEST(a_tooth_that_is_no_whole_number_is_refused),
        GM_TEST(an_unknown_flank_is_refused),
        GM_TEST(what_is_quoted_is_short_and_printable),
        GM_TEST(the_most_special_row_wins_in_any_order),
        GM_TEST(a_repeated_row_is_refused),
        GM_TEST(teeth_without_rows_are_counted),
        GM_TEST(plain_and_exponent_numbers_are_read),
        GM_TEST(numbers_of_many_digits_are_read_correctly_rounded),
        GM_TEST(any_decimal_is_the_nearest_double_in_metres),
        GM_TEST(hexadecimal_nan_and_inf_are_no_numbers),
        GM_TEST(text_where_a_number_belongs_is_refused),
        GM_TEST(text_behind_a_number_is_refused),
        GM_TEST(a_number_beyond_the_range_of_a_double_is_refused),
        GM_TEST(a_call_without_a_required_pointer_is_refused),
        GM_TEST(the_error_may_be_left_out),
        GM_TEST(impossible_numbers_of_teeth_are_refused),
        GM_TEST(a_written_file_reads_back_to_the_same_bits),
        GM_TEST(a_written_file_holds_the_rows_that_are_set_and_no_others),
        GM_TEST(a_file_that_cannot_be_written_is_an_error),
        GM_TEST(a_full_disk_is_an_error),
        GM_TEST(a_stream_gets_what_a_file_would_hold),
        GM_TEST(what_could_not_be_read_back_is_not_written),
    };
    return gm_test_main("unit.pitch_file", tests, GM_TEST_COUNT(tests), argc, argv);
}
