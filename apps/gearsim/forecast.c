/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "forecast.h"
#include "dynamics.h"
#include "json.h"
#include "statics.h"

#include <string.h>

typedef struct forecast {
    const char *type, *model, *output;
    double rows;
    int count;
    const char *columns[COLUMNS_MAX];
} forecast;

static forecast make(const config *conf, const column_names *names) {
    const int is_static = conf->analysis == ANALYSIS_STATIC;
    forecast made = {.type = is_static ? "static" : "dynamic",
                     .model = conf->model == MODEL_3D ? "3d" : "simple",
                     .output = conf->output_file,
                     .rows = is_static ? statics_rows(conf) : dynamics_rows(conf)};
    column_list columns;

    if (columns_select(&columns, conf, names->name, names->count) == 0) {
        made.count = columns.count;
        for (int i = 0; i < columns.count; ++i) {
            made.columns[i] = names->name[columns.name[i]];
        }
    }
    return made;
}

static void print_json(const config *conf, const forecast *made, FILE *stream) {
    json_object object = json_begin(stream);

    json_text(&object, "file", conf->path);
    json_truth(&object, "ok", 1);
    json_text(&object, "type", made->type);
    json_text(&object, "model", made->model);
    if (conf->analysis == ANALYSIS_DYNAMIC) {
        json_number(&object, "duration_s", conf->duration);
    }
    json_number(&object, "rows", made->rows);
    json_texts(&object, "columns", made->columns, made->count);
    json_text(&object, "output", made->output);
    json_end(&object);
}

static void print_text(const config *conf, const forecast *made, FILE *stream) {
    fprintf(stream, "%s: ok\n%s run", strcmp(conf->path, "-") == 0 ? "standard input" : conf->path,
            made->type);
    if (conf->analysis == ANALYSIS_DYNAMIC) {
        fprintf(stream, " of %.6g s", conf->duration);
    } else {
        fprintf(stream, " of %d positions under %d load%s", conf->positions, conf->loads,
                conf->loads > 1 ? "s" : "");
    }
    fprintf(stream, ", model %s\n%.0f rows of %d columns into %s\n", made->model, made->rows,
            made->count, strcmp(made->output, "-") == 0 ? "standard output" : made->output);
}

void forecast_print(const config *conf, const column_names *names, int as_json, FILE *stream) {
    const forecast made = make(conf, names);

    if (as_json) {
        print_json(conf, &made, stream);
    } else if (conf->messages == NULL || !conf->messages->quiet) {
        print_text(conf, &made, stream);
    }
}
