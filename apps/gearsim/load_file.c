/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "load_file.h"
#include "memory.h"
#include "number.h"
#include "result_file.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char key[] = "output.load_distribution";

struct load_file {
    result_file result;
    FILE *stream; /* on a descriptor of its own */
    int digits;
    message_sink *messages;
};

static int ends_with(const char *text, const char *suffix) {
    const size_t length = strlen(text), suffix_length = strlen(suffix);

    return length >= suffix_length && strcmp(text + length - suffix_length, suffix) == 0;
}

/* It is CSV, in a file of its own. */
static int check_names(const config *conf) {
    if (strcmp(conf->load_distribution, "-") == 0) {
        config_complain(conf, key, "must be a file (got -): standard output is for output.file");
        return EXIT_BAD_INPUT;
    }
    if (ends_with(conf->load_distribution, ".h5") || ends_with(conf->load_distribution, ".hdf5")) {
        config_complain(conf, key, "must be a CSV file, HDF5 is for output.file (got %s)",
                        conf->load_distribution);
        return EXIT_BAD_INPUT;
    }
    if (!result_file_would_replace(conf->load_distribution, conf->output_file)) {
        return 0;
    }
    config_complain(conf, key, "must be another file than output.file (got %s)",
                    conf->load_distribution);
    return EXIT_BAD_INPUT;
}

static int complain(const config *conf, const result_file *result, int exit_code) {
    if (exit_code != EXIT_DONE) {
        config_complain(conf, key, "'%s' %s", result->wrong_path, result->reason);
    }
    return exit_code;
}

int load_file_check(const config *conf) {
    if (conf->load_distribution == NULL || conf->analysis != ANALYSIS_STATIC) {
        return 0;
    }
    int status = check_names(conf);
    if (status == 0) {
        result_file result;
        status = complain(conf, &result, result_file_check(&result, conf->load_distribution));
        result_file_free(&result);
    }
    return status;
}

static int fail(const load_file *file) {
    message_of_program(file->messages, "%s: %s", file->result.part, strerror(errno));
    return EXIT_RUN_FAILED;
}

static void write_head(const load_file *file, const config *conf) {
    for (int i = 0; i < conf->provenance_count; ++i) {
        fprintf(file->stream, "# %s\n", conf->provenance[i]);
    }
    fputs("pinion_angle_rad,load_torque_Nm,pair,flank,z_mm,pinion_roll_length_mm,"
          "wheel_roll_length_mm,line_load_N_per_mm,pressure_N_per_mm2,gap_um\n",
          file->stream);
}

static void free_file(load_file *file) {
    if (file->stream != NULL) {
        fclose(file->stream);
    }
    result_file_free(&file->result);
    free(file);
}

int load_file_open(load_file **file, const config *conf) {
    *file = NULL;
    if (conf->load_distribution == NULL || conf->analysis != ANALYSIS_STATIC) {
        return 0;
    }
    int status = check_names(conf);
    if (status != 0) {
        return status;
    }

    /* The struct, with nothing open yet. */
    load_file *opened = allocate(1, sizeof *opened);
    if (opened == NULL) {
        return message_no_memory(conf->messages);
    }
    opened->messages = conf->messages;
    opened->digits = conf->digits;
    opened->result.data = opened->result.lock = -1;

    /* FILE.part, and a stream on it. */
    status = complain(conf, &opened->result,
                      result_file_check(&opened->result, conf->load_distribution));
    if (status == EXIT_DONE) {
        status = complain(conf, &opened->result, result_file_open(&opened->result));
    }
    if (status == EXIT_DONE) {
        const int descriptor = dup(opened->result.data);
        opened->stream = descriptor >= 0 ? fdopen(descriptor, "wb") : NULL;
        status = opened->stream != NULL ? EXIT_DONE : fail(opened);
    }
    if (status != EXIT_DONE) {
        free_file(opened);
        return status;
    }

    write_head(opened, conf);
    *file = opened;
    return 0;
}

static void put_number(const load_file *file, char before, double value) {
    char text[NUMBER_TEXT_SIZE];

    number_format(text, value, file->digits);
    fputc(before, file->stream);
    fputs(text, file->stream);
}

int load_file_rows(load_file *file, double pinion_angle, double load,
                   const gm_line_load_point *points, int count) {
    if (file == NULL) {
        return 0;
    }
    for (int i = 0; i < count; ++i) {
        /* Where: the position and its load, then tooth and flank. */
        const gm_line_load_point *point = &points[i];
        char angle[NUMBER_TEXT_SIZE];
        number_format(angle, pinion_angle, file->digits);
        fputs(angle, file->stream);
        put_number(file, ',', load);
        fprintf(file->stream, ",%d,%s", point->pinion_tooth,
                point->side == GM_DRIVE ? "drive" : "coast");

        /* The place on it, and what it carries, in the units of the column names. */
        put_number(file, ',', 1e3 * point->z);
        put_number(file, ',', 1e3 * point->pinion_roll_length);
        put_number(file, ',', 1e3 * point->wheel_roll_length);
        put_number(file, ',', 1e-3 * point->line_load);
        put_number(file, ',', 1e-6 * point->pressure);
        put_number(file, ',', 1e6 * point->gap);
        fputc('\n', file->stream);
    }
    return ferror(file->stream) ? fail(file) : 0;
}

int load_file_flush(load_file *file) {
    return file == NULL || fflush(file->stream) == 0 ? EXIT_DONE : fail(file);
}

result_file *load_file_result(load_file *file) {
    return file != NULL ? &file->result : NULL;
}

/* What a full disk has cut goes back to the end of a line, with room for `line` behind it. */
static void end_with_line(const load_file *file, const char *line) {
    char end[2048];
    const int data = file->result.data;
    const off_t size = lseek(data, 0, SEEK_END), room = (off_t)strlen(line);
    const off_t from = size > (off_t)sizeof end ? size - (off_t)sizeof end : 0;

    ssize_t kept = lseek(data, from, SEEK_SET) == from ? read(data, end, sizeof end) : -1;
    while (kept > 0 && (end[kept - 1] != '\n' || from + kept + room > size)) {
        --kept;
    }
    if (kept > 0 && ftruncate(data, from + kept) == 0 &&
        lseek(data, from + kept, SEEK_SET) == from + kept) {
        (void)!write(data, line, (size_t)room);
    }
}

void load_file_close(load_file *file, const char *incomplete) {
    if (file == NULL) {
        return;
    }
    if (incomplete != NULL) {
        char line[640];
        snprintf(line, sizeof line, "# incomplete: %.600s\n", incomplete);
        fputs(line, file->stream);
        const int is_cut = fflush(file->stream) != 0 || ferror(file->stream);

        /* The stream goes first, with what it has not written. */
        fclose(file->stream);
        file->stream = NULL;
        if (is_cut) {
            end_with_line(file, line);
        }
    }
    free_file(file);
}
