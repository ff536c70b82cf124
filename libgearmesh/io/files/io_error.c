/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Messages of the loaders and writers. */

#include "io_error.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void gmi_error_begin(gm_io_error *error, const char *path) {
    if (error == NULL) {
        return;
    }
    error->line = 0;
    error->text[0] = '\0';
    error->option = NULL;
    snprintf(error->file, sizeof error->file, "%s", path != NULL ? path : "");
}

int gmi_error_set(gm_io_error *error, int status, long line, const char *format, ...) {
    if (error != NULL) {
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(error->text, sizeof error->text, format, arguments);
        va_end(arguments);
        error->line = line;
    }
    return status;
}

int gmi_error_null(gm_io_error *error) {
    return gmi_error_set(error, GM_IO_ERR_NULL, 0, "a required pointer is NULL");
}

int gmi_error_memory(gm_io_error *error) {
    return gmi_error_set(error, GM_IO_ERR_MEMORY, 0, "out of memory");
}

void gmi_error_option(gm_io_error *error, const char *option) {
    if (error != NULL) {
        error->option = option;
    }
}

int gmi_error_file(gm_io_error *error, long line, const char *action, int error_number) {
    const char *reason = error_number != 0 ? strerror(error_number) : "unknown reason";
    if (error_number == ENOENT) {
        reason = "there is no such file or folder";
    }
    if (error_number == EACCES) {
        reason = "permission denied";
    }
    if (error_number == EISDIR) {
        reason = "it is a folder, a file is needed";
    }
    return gmi_error_set(error, GM_IO_ERR_FILE, line, "cannot be %s: %s", action, reason);
}

const char *gmi_quote(char quoted[GMI_QUOTE_SIZE], const char *text) {
    const size_t longest = 48;
    const size_t length = strlen(text);
    const size_t shown = length <= longest ? length : longest;

    size_t end = 0;
    quoted[end++] = '\'';
    for (size_t i = 0; i < shown; ++i) {
        /* Anything that could disturb a terminal or a log is shown as a question mark. */
        const int printable = text[i] >= ' ' && text[i] <= '~';
        quoted[end++] = printable ? text[i] : '?';
    }
    strcpy(quoted + end, length <= longest ? "'" : "...'");
    return quoted;
}
