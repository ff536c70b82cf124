/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Stands in for inih in the tests under Wine: ini_parse_stream() as ini.h describes it, for lines without comments and
 * outer blanks, which is what the programs hand it. They are tested so, inih itself is not.
 */
#include <ini.h>
#include <string.h>

int ini_parse_stream(ini_reader reader, void *stream, ini_handler handler, void *user) {
    char line[4096], section[sizeof line] = "";
    int fault = 0;

    for (int number = 1; reader(line, sizeof line, stream) != NULL; ++number) {
        char *end = strpbrk(line, *line == '[' ? "]" : "=:");

        /* A section is told with each value until the next one. */
        if (end != NULL && *line == '[') {
            *end = '\0';
            strcpy(section, line + 1);
            continue;
        }

        /* A name without the blanks before the sign, a value without those behind it. */
        int understood = *line == '\0';
        if (end != NULL) {
            const char *value = end + 1 + strspn(end + 1, " \t");
            while (end > line && strchr(" \t", end[-1]) != NULL) {
                --end;
            }
            *end = '\0';
            understood = handler(user, section, line, value);
        }

        /* The first line that was not. */
        fault = fault == 0 && !understood ? number : fault;
    }
    return fault;
}
