/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Messages of the programs go nowhere, but each must be one that can be shown, and they must not be thousands. */
#ifndef GEARMESH_FUZZ_MESSAGES_H
#define GEARMESH_FUZZ_MESSAGES_H

#include "fuzz.h"

#include <messages.h>

/* The user is a counter. */
static inline void fuzz_take_message(void *user, const char *line) {
    int *count = user;
    const size_t length = strlen(line);
    FUZZ_CLAIM(length > 1 && line[length - 1] == '\n');
    ++*count;
}

static inline message_sink fuzz_messages(int *count) {
    const message_sink sink = {.program = "fuzz", .put = fuzz_take_message, .user = count};
    *count = 0;
    return sink;
}

#endif
