/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "memory.h"

#include <stdlib.h>
#include <string.h>

void *allocate(size_t count, size_t size) {
    return calloc(count, size);
}

char *copy_text(const char *text) {
    return join_texts(text, "");
}

char *join_texts(const char *first, const char *second) {
    const size_t length = strlen(first);
    const size_t size = strlen(second) + 1;
    char *joined = allocate(length + size, 1);

    if (joined != NULL) {
        memcpy(joined, first, length);
        memcpy(joined + length, second, size);
    }
    return joined;
}
