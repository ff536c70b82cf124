/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* How the rows of key tables are written. */
#ifndef APPS_KEY_MACROS_H
#define APPS_KEY_MACROS_H

#include "key_table.h"

#include <math.h>
#include <stddef.h>

#define NAME(the_section, the_name)                                                                \
    .section = (the_section), .name = (the_name), .full_name = the_section "." the_name

#define ANY                                                                                        \
    { -HUGE_VAL, HUGE_VAL, 1, 1, 0 }
#define ABOVE_ZERO                                                                                 \
    { 0, HUGE_VAL, 1, 1, 0 }
#define NOT_NEGATIVE                                                                               \
    { 0, HUGE_VAL, 0, 1, 0 }
#define BETWEEN(a, b)                                                                              \
    { a, b, 0, 0, 0 }
#define WITHIN(a, b)                                                                               \
    { a, b, 1, 1, 0 }
#define SIZE_BETWEEN(a, b)                                                                         \
    { a, b, 0, 0, 1 }
#define UP_TO(size) BETWEEN(-(size), size) /* either way */

#define NUMBER(key_unit, ...)   .kind = KEY_NUMBER, .unit = (key_unit), .range = __VA_ARGS__
#define COUNT(low, high)        .kind = KEY_COUNT, .range = BETWEEN(low, high)
#define SIGNED_COUNT(low, high) .kind = KEY_COUNT, .range = SIZE_BETWEEN(low, high)
#define CHOICE(names)           .kind = KEY_CHOICE, .choices = (names)

#endif
