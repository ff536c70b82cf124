/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "json.h"

#include <math.h>

/* A text in quotes. Bytes beyond ASCII pass as they are: names of files are UTF-8. */
static void put_text(FILE *stream, const char *text) {
    fputc('"', stream);
    for (; *text != '\0'; ++text) {
        const unsigned char c = (unsigned char)*text;
        if (c < ' ') {
            fprintf(stream, "\\u%04x", c);
        } else {
            if (c == '"' || c == '\\') {
                fputc('\\', stream);
            }
            fputc(c, stream);
        }
    }
    fputc('"', stream);
}

static void put_name(json_object *object, const char *name) {
    fputs(object->members++ > 0 ? ",\n  " : "\n  ", object->stream);
    put_text(object->stream, name);
    fputs(": ", object->stream);
}

json_object json_begin(FILE *stream) {
    fputc('{', stream);
    return (json_object){.stream = stream};
}

void json_number(json_object *object, const char *name, double value) {
    put_name(object, name);
    if (isfinite(value)) {
        fprintf(object->stream, "%.17g", value);
    } else {
        fputs("null", object->stream);
    }
}

void json_text(json_object *object, const char *name, const char *text) {
    put_name(object, name);
    put_text(object->stream, text);
}

void json_truth(json_object *object, const char *name, int is_true) {
    put_name(object, name);
    fputs(is_true ? "true" : "false", object->stream);
}

void json_texts(json_object *object, const char *name, const char *const texts[], int count) {
    put_name(object, name);
    fputc('[', object->stream);
    for (int i = 0; i < count; ++i) {
        fputs(i > 0 ? ", " : "", object->stream);
        put_text(object->stream, texts[i]);
    }
    fputc(']', object->stream);
}

void json_end(json_object *object) {
    fputs("\n}\n", object->stream);
}
