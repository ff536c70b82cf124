/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Memory on the heap, to be freed with free(). NULL: there is none left. */
#ifndef APPS_MEMORY_H
#define APPS_MEMORY_H

#include <stddef.h>

/* `count` zeroed objects. */
void *allocate(size_t count, size_t size);

char *copy_text(const char *text);

/* One text behind the other. */
char *join_texts(const char *first, const char *second);

#endif
