/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* One flat object of JSON, member by member. */
#ifndef APPS_JSON_H
#define APPS_JSON_H

#include <stdio.h>

typedef struct json_object {
    FILE *stream;
    int members; /* written so far */
} json_object;

json_object json_begin(FILE *stream);

/* Members with 17 digits, and null for what is no number. */
void json_number(json_object *object, const char *name, double value);
void json_text(json_object *object, const char *name, const char *text);
void json_truth(json_object *object, const char *name, int is_true);
void json_texts(json_object *object, const char *name, const char *const texts[], int count);

void json_end(json_object *object);

#endif
