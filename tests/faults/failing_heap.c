/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Preloaded, lets the allocation FAIL_ALLOCATION of a program fail, counted from 1, or with FAIL_FOREVER all from
 * that one on. ALLOCATION_COUNT names a file that gets the number of allocations. Calls from a library whose name
 * holds one of the texts in SPARE, separated by commas, are not counted and do not fail. For glibc.
 */
#define _GNU_SOURCE

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *memory, size_t size);

static long number, failing;
static int forever;
static const char *spared;

/* Before the libraries that are preloaded upon. */
static __attribute__((constructor)) void begin(void) {
    const char *text = getenv("FAIL_ALLOCATION");

    failing = text != NULL ? atol(text) : 0;
    forever = getenv("FAIL_FOREVER") != NULL;
    spared = getenv("SPARE");
    number = 0;
}

static __attribute__((destructor)) void end(void) {
    const char *path = getenv("ALLOCATION_COUNT");
    char text[32];
    const int size = snprintf(text, sizeof text, "%ld\n", number);
    const int file = path != NULL ? open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666) : -1;

    if (file >= 0) {
        if (write(file, text, (size_t)size) != size) {
            _exit(99);
        }
        close(file);
    }
}

static int is_spared(const void *caller) {
    Dl_info place;

    if (spared == NULL || dladdr(caller, &place) == 0 || place.dli_fname == NULL) {
        return 0;
    }
    for (const char *text = spared; *text != '\0'; text += strspn(text, ",")) {
        char name[64];
        const size_t length = strcspn(text, ",");
        snprintf(name, sizeof name, "%.*s", (int)length, text);
        if (strstr(place.dli_fname, name) != NULL) {
            return 1;
        }
        text += length;
    }
    return 0;
}

static int fails(const void *caller) {
    if (is_spared(caller)) {
        return 0;
    }
    ++number;
    if (number == failing || (forever && failing > 0 && number > failing)) {
        errno = ENOMEM;
        return 1;
    }
    return 0;
}

void *malloc(size_t size) {
    return fails(__builtin_return_address(0)) ? NULL : __libc_malloc(size);
}

void *calloc(size_t count, size_t size) {
    return fails(__builtin_return_address(0)) ? NULL : __libc_calloc(count, size);
}

void *realloc(void *memory, size_t size) {
    return fails(__builtin_return_address(0)) ? NULL : __libc_realloc(memory, size);
}

/* Here, so that its caller is known. */
char *strdup(const char *text) {
    const size_t size = strlen(text) + 1;
    char *copy = fails(__builtin_return_address(0)) ? NULL : __libc_malloc(size);

    return copy != NULL ? memcpy(copy, text, size) : NULL;
}
