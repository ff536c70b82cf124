/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* apps/common/messages.c: whole lines, bounded per input, silent where nobody listens. */
#include "exit_code.h"
#include "gm_test.h"
#include "messages.h"

#include <string.h>

typedef struct heard {
    int lines;
    char last[16384];
} heard;

static void hear(void *user, const char *line) {
    heard *to = user;

    ++to->lines;
    snprintf(to->last, sizeof to->last, "%s", line);
}

static message_sink sink_to(heard *to) {
    memset(to, 0, sizeof *to);
    const message_sink made = {.program = "gears", .put = hear, .user = to};
    return made;
}

static void a_message_is_one_line(void) {
    heard got;
    message_sink sink = sink_to(&got);

    message_error(&sink, "%s:%d: %s", "a.ini", 3, "text");
    GM_ASSERT_STRING(got.last, "a.ini:3: text\n");
    message_of_program(&sink, "a %g", 1.5);
    GM_ASSERT_STRING(got.last, "gears: a 1.5\n");
    GM_ASSERT_INT(message_no_memory(&sink), EXIT_RUN_FAILED);
    GM_ASSERT_STRING(got.last, "gears: out of memory\n");
    GM_ASSERT_INT(got.lines, 3);
    message_error(&sink, "%s: %s", "two\nlines\033[31m\t\x7f", "\xc3\xa9");
    GM_ASSERT_STRING(got.last, "two?lines?[31m??: \xc3\xa9\n");
}

static void notes_are_left_out_when_quiet_and_errors_are_not(void) {
    heard got;
    message_sink sink = sink_to(&got);

    message_note(&sink, "note");
    GM_ASSERT_STRING(got.last, "note\n");
    sink.quiet = 1;
    message_note(&sink, "another");
    GM_ASSERT_STRING(got.last, "note\n");
    message_error(&sink, "error");
    GM_ASSERT_STRING(got.last, "error\n");
}

static void the_first_of_many_are_told_and_the_others_counted(void) {
    heard got;
    message_sink sink = sink_to(&got);

    for (int count = 18; count <= 23; ++count) {
        got.lines = 0;
        message_begin(&sink, 20);
        for (int i = 0; i < count; ++i) {
            GM_ASSERT_INT(message_is_full(&sink), i >= 20);
            message_error(&sink, "fault %d", i);
        }
        message_end(&sink, "a.ini");
        GM_ASSERT_INT(got.lines, count <= 20 ? count : 21);
    }
    GM_ASSERT_STRING(got.last, "a.ini: and 3 more\n");

    /* Afterwards there is no bound. */
    for (int i = 0; i < 30; ++i) {
        message_error(&sink, "fault %d", i);
    }
    GM_ASSERT_INT(got.lines, 51);
    GM_ASSERT_STRING(got.last, "fault 29\n");
}

static void quiet_notes_do_not_count(void) {
    heard got;
    message_sink sink = sink_to(&got);

    sink.quiet = 1;
    message_begin(&sink, 1);
    message_note(&sink, "note");
    message_error(&sink, "error");
    message_end(&sink, "a.ini");
    GM_ASSERT_INT(got.lines, 1);
    GM_ASSERT_STRING(got.last, "error\n");
}

static void long_lines_are_cut_but_end(void) {
    static char text[20000];
    heard got;
    message_sink sink = sink_to(&got);

    memset(text, 'x', sizeof text - 1);
    message_error(&sink, "%s", text);
    const size_t length = strlen(got.last);
    GM_ASSERT(length > 4096 && length < sizeof text);
    GM_ASSERT(got.last[length - 1] == '\n' && got.last[length - 2] == 'x');
}

static void nobody_needs_to_listen(void) {
    message_sink deaf = {.program = "gears"};

    message_error(NULL, "error");
    message_error(&deaf, "error");
    message_note(NULL, "note");
    message_show(NULL, "line");
    message_show(&deaf, "line");
    message_begin(NULL, 1);
    message_end(NULL, "a.ini");
    GM_ASSERT_INT(message_no_memory(NULL), EXIT_RUN_FAILED);
    GM_ASSERT(message_is_full(NULL) && message_is_full(&deaf));
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(a_message_is_one_line),
        GM_TEST(notes_are_left_out_when_quiet_and_errors_are_not),
        GM_TEST(the_first_of_many_are_told_and_the_others_counted),
        GM_TEST(quiet_notes_do_not_count),
        GM_TEST(long_lines_are_cut_but_end),
        GM_TEST(nobody_needs_to_listen),
    };
    return gm_test_main("apps.messages", tests, GM_TEST_COUNT(tests), argc, argv);
}
