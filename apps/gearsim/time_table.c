/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "time_table.h"
#include "memory.h"
#include "number.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LINE_SIZE = 256 };

/* Rows that are closer are a slip, and could not be told from a step. */
static const double shortest_piece = 1e-9; /* s */

static const double rad_per_s = 3.14159265358979323846 / 30.0; /* of 1 rpm */

typedef struct row {
    double time, value;
    long line;
} row;

/* Between two rows: powers of the time since the first. */
typedef struct piece {
    double start, length;
    double c[4];
    double before; /* integral over the pieces before */
    int is_kink;   /* at its start, see time_table_next_row() */
} piece;

struct time_table {
    piece *pieces;
    int count;
    double end;      /* time of the last row */
    double last;     /* value behind it */
    double period;   /* 0: it does not repeat */
    double total;    /* integral over all pieces */
    double zero;     /* integral from the first row to t = 0 */
    int kink_at_end; /* where it repeats: between the last piece and the first */
    double largest;
};

/* ---------------------------------------------------------------------------------------------
 * Reading
 * ------------------------------------------------------------------------------------------- */

typedef struct table_reader {
    const config *conf;
    const char *path;
    const char *key; /* that names the file */
    int is_speed;
    FILE *file;
    long line;
    row *rows;
    int count, room;
} table_reader;

/* The file is at fault, and the key that names it tells where it came from. */
static int refuse(const table_reader *reader, long line, const char *text, const char *got) {
    char place[32] = "";

    if (line > 0) {
        snprintf(place, sizeof place, ":%ld", line);
    }
    if (got != NULL) {
        message_error(reader->conf->messages, "%s%s: %s (got %.80s)", reader->path, place, text,
                      got);
    } else {
        message_error(reader->conf->messages, "%s%s: %s", reader->path, place, text);
    }
    config_complain(reader->conf, reader->key, "names this file");
    return EXIT_BAD_INPUT;
}

static char *trim(char *text) {
    char *end = text + strlen(text);

    while (end > text && strchr(" \t\r\n", end[-1]) != NULL) {
        *--end = '\0';
    }
    return text + strspn(text, " \t");
}

/* The next line that counts: 1, 0 at the end, or -1: it is too long or holds a zero byte. */
static int next_line(table_reader *reader, char text[LINE_SIZE], char **trimmed) {
    while (fgets(text, LINE_SIZE, reader->file) != NULL) {
        ++reader->line;
        if (strchr(text, '\n') == NULL && !feof(reader->file)) {
            return -1;
        }
        char *start = text;
        if (reader->line == 1 && strncmp(start, "\xef\xbb\xbf", 3) == 0) {
            start += 3;
        }
        *trimmed = trim(start);
        if (**trimmed != '\0' && **trimmed != '#') {
            return 1;
        }
    }
    return 0;
}

/* Cuts a line into its two fields; 0 = there are two. */
static int split(char *text, char *fields[2]) {
    char *comma = strchr(text, ',');

    if (comma == NULL || strchr(comma + 1, ',') != NULL) {
        return -1;
    }
    *comma = '\0';
    fields[0] = trim(text);
    fields[1] = trim(comma + 1);
    return 0;
}

static int read_header(table_reader *reader) {
    static const char *const columns[2][2] = {{"time_s,torque_Nm", "torque_Nm"},
                                              {"time_s,speed_rpm", "speed_rpm"}};
    const char *const *right = columns[reader->is_speed];
    char must[80], text[LINE_SIZE], whole[LINE_SIZE] = "nothing";
    char *line = NULL, *fields[2];
    const int found = next_line(reader, text, &line);

    if (found > 0) {
        snprintf(whole, sizeof whole, "%s", line);
        if (split(line, fields) == 0 && strcmp(fields[0], "time_s") == 0 &&
            strcmp(fields[1], right[1]) == 0) {
            return 0;
        }
    }
    snprintf(must, sizeof must, "the columns must be %s", right[0]);
    return refuse(reader, reader->line, must, found >= 0 ? whole : "a very long line");
}

static int keep_row(table_reader *reader, double time, double value) {
    if (reader->count == reader->room) {
        reader->room = reader->room > 0 ? 2 * reader->room : 256;
        row *more = realloc(reader->rows, (size_t)reader->room * sizeof *more);
        if (more == NULL) {
            return message_no_memory(reader->conf->messages);
        }
        reader->rows = more;
    }
    reader->rows[reader->count++] = (row){time, value, reader->line};
    return 0;
}

/* Times increase, or two rows make a step. */
static int check_row(const table_reader *reader, double time, double value, const char *text) {
    const row *before = reader->count > 0 ? &reader->rows[reader->count - 1] : NULL;

    if (before == NULL || time >= before->time + shortest_piece) {
        return 0;
    }
    if (time != before->time) {
        return refuse(
            reader, reader->line,
            "time_s must increase by 1e-9 at least, or be that of the row before for a step", text);
    }
    if (reader->count > 1 && reader->rows[reader->count - 2].time == time) {
        return refuse(reader, reader->line, "time_s must stand twice at most, for a step", text);
    }
    if (reader->is_speed && value != before->value) {
        return refuse(reader, reader->line, "speed_rpm must not step: give it a time to change",
                      text);
    }
    return 0;
}

static int read_row(table_reader *reader, char *line) {
    char *fields[2];
    double numbers[2];

    if (split(line, fields) != 0) {
        return refuse(reader, reader->line, "a row must be two numbers with a comma between them",
                      NULL);
    }
    for (int i = 0; i < 2; ++i) {
        numbers[i] = number_is_plain(fields[i]) ? strtod(fields[i], NULL) : (double)NAN;
        if (!(fabs(numbers[i]) <= 1e12)) {
            return refuse(reader, reader->line,
                          "must be a plain number from -1e12 to 1e12 with a decimal point",
                          fields[i]);
        }
    }

    const double value = (reader->is_speed ? rad_per_s : 1.0) * numbers[1];
    const int failed = check_row(reader, numbers[0], value, fields[0]);
    return failed ? failed : keep_row(reader, numbers[0], value);
}

static int read_rows(table_reader *reader) {
    char text[LINE_SIZE];
    char *line = NULL;
    int found, failed = read_header(reader);

    while (!failed && (found = next_line(reader, text, &line)) != 0) {
        failed = found < 0 ? refuse(reader, reader->line,
                                    "a row must be two numbers with a comma between them", NULL)
                           : read_row(reader, line);
    }
    if (!failed && ferror(reader->file)) {
        return refuse(reader, 0, "cannot be read", strerror(errno));
    }
    return failed;
}

/* Whether it says something for the whole run. */
static int check_span(const table_reader *reader, int repeats) {
    static const char two_times[] = "must have rows at two times at least";
    char got[48];

    if (reader->count < 2) { /* perhaps no memory at all */
        return refuse(reader, 0, two_times, NULL);
    }
    const row *first = &reader->rows[0], *last = &reader->rows[reader->count - 1];
    if (first->time == last->time) {
        return refuse(reader, 0, two_times, NULL);
    }

    /* From the begin of the run to its end. */
    if (first->time > 0.0) {
        snprintf(got, sizeof got, "%.9g s", first->time);
        return refuse(reader, first->line, "must begin at a time of 0 or before", got);
    }
    if (!repeats && last->time < reader->conf->duration) {
        char must[120];
        snprintf(got, sizeof got, "%.9g s", last->time);
        snprintf(must, sizeof must,
                 "must reach the end of the run, %.9g s, or be repeated by `repeat = on`",
                 reader->conf->duration);
        return refuse(reader, last->line, must, got);
    }

    /* Bodies cannot jump from one speed to another. */
    if (repeats && reader->is_speed && first->value != last->value) {
        snprintf(got, sizeof got, "%.9g and %.9g rpm", first->value / rad_per_s,
                 last->value / rad_per_s);
        return refuse(reader, last->line,
                      "speed_rpm must end with the value it begins with where it is repeated", got);
    }
    return 0;
}

/* ---------------------------------------------------------------------------------------------
 * Pieces
 * ------------------------------------------------------------------------------------------- */

/* Slope of the chord behind row i; NaN across a step and at the ends, where a period may go on. */
static double chord(const row *rows, int count, int i, int is_periodic, double *length) {
    if (i < 0 || i >= count - 1) {
        if (!is_periodic) {
            return (double)NAN;
        }
        i = i < 0 ? count - 2 : 0;
    }
    *length = rows[i + 1].time - rows[i].time;
    return *length > 0.0 ? (rows[i + 1].value - rows[i].value) / *length : (double)NAN;
}

/* Slope at a row of the parabola through it and its neighbours; where one is missing, through the next two. */
static double parabola_slope(const row *rows, int count, int i, int is_periodic, int is_end) {
    double before_length = 0.0, behind_length = 0.0;
    const double before = chord(rows, count, i - 1, is_periodic, &before_length);
    const double behind = chord(rows, count, i, is_periodic, &behind_length);

    if (!isnan(before) && !isnan(behind)) {
        return (before * behind_length + behind * before_length) / (before_length + behind_length);
    }

    /* At an end: by the chord next to it and the one farther on. */
    double far_length = 0.0;
    const double far = chord(rows, count, is_end ? i - 2 : i + 1, is_periodic, &far_length);
    const double near = is_end ? before : behind;
    const double near_length = is_end ? before_length : behind_length;
    return isnan(far) ? near : near + (near - far) * near_length / (near_length + far_length);
}

static void set_piece(piece *made, const row *rows, int count, int i, int is_cubic,
                      int is_periodic) {
    const double h = rows[i + 1].time - rows[i].time;
    const double rise = (rows[i + 1].value - rows[i].value) / h;

    made->start = rows[i].time;
    made->length = h;
    made->c[0] = rows[i].value;
    made->c[1] = rise;
    made->c[2] = made->c[3] = 0.0;
    if (is_cubic) {
        const double first = parabola_slope(rows, count, i, is_periodic, 0);
        const double last = parabola_slope(rows, count, i + 1, is_periodic, 1);

        made->c[1] = first;
        made->c[2] = (3.0 * rise - 2.0 * first - last) / h;
        made->c[3] = (first + last - 2.0 * rise) / (h * h);
    }
}

static double piece_value(const piece *part, double s) {
    return part->c[0] + s * (part->c[1] + s * (part->c[2] + s * part->c[3]));
}

static double piece_slope(const piece *part, double s) {
    return part->c[1] + s * (2.0 * part->c[2] + s * 3.0 * part->c[3]);
}

static double piece_integral(const piece *part, double s) {
    return s *
           (part->c[0] + s * (0.5 * part->c[1] + s * (part->c[2] / 3.0 + s * 0.25 * part->c[3])));
}

/* At both ends, or where the slope is 0: the roots of c1 + 2 c2 s + 3 c3 s^2, without loss of digits. */
static double piece_largest(const piece *part) {
    const double *c = part->c;
    const double discriminant = c[2] * c[2] - 3.0 * c[1] * c[3];
    double largest = fmax(fabs(c[0]), fabs(piece_value(part, part->length)));

    if (discriminant >= 0.0) {
        const double q = -(c[2] + copysign(sqrt(discriminant), c[2]));
        const double roots[2] = {q / (3.0 * c[3]), c[1] / q};

        for (int i = 0; i < 2; ++i) {
            if (roots[i] > 0.0 && roots[i] < part->length) {
                largest = fmax(largest, fabs(piece_value(part, roots[i])));
            }
        }
    }
    return largest;
}

/* Whether the solver has to start again between two pieces. */
static int is_kink(const piece *before, const piece *behind, int is_speed) {
    const double value = piece_value(before, before->length);
    const double slope = piece_slope(before, before->length);
    const double size = fabs(behind->c[0]) + fabs(value);
    const double steepness = fabs(slope) + fabs(behind->c[1]);

    /* Roundings are no step. */
    return fabs(value - behind->c[0]) > 1e-12 * size ||
           (is_speed && fabs(slope - behind->c[1]) > 1e-9 * steepness);
}

static time_table *make_table(const table_reader *reader, int is_cubic, int repeats) {
    const row *rows = reader->rows;
    const int count = reader->count;
    const int is_periodic = repeats && rows[0].value == rows[count - 1].value;
    time_table *table = allocate(1, sizeof *table);
    piece *pieces = allocate((size_t)count, sizeof *pieces);

    if (table == NULL || pieces == NULL) {
        free(table);
        free(pieces);
        return NULL;
    }
    table->pieces = pieces;
    table->end = rows[count - 1].time;
    table->last = rows[count - 1].value;
    table->period = repeats ? table->end - rows[0].time : 0.0;

    /* Pieces between rows at different times. */
    for (int i = 0; i + 1 < count; ++i) {
        if (rows[i + 1].time > rows[i].time) {
            piece *part = &pieces[table->count++];
            set_piece(part, rows, count, i, is_cubic, is_periodic);
            part->before = table->total;
            part->is_kink = table->count > 1 && is_kink(part - 1, part, reader->is_speed);
            table->total += piece_integral(part, part->length);
        }
    }

    /* Where it goes on from its end, and how large it gets. */
    table->kink_at_end =
        repeats ? is_kink(&pieces[table->count - 1], &pieces[0], reader->is_speed) : 1;
    table->largest = fabs(table->last);
    for (int i = 0; i < table->count; ++i) {
        table->largest = fmax(table->largest, piece_largest(&pieces[i]));
    }

    /* Integrals count from the time 0, which may lie within the table. */
    table->zero = 0.0;
    table->zero = time_table_integral(table, 0.0);
    return table;
}

/* Cubics through rows at uneven distances may swing far beyond them. */
static void warn_of_swing(const table_reader *reader, const time_table *table) {
    double lowest = reader->rows[0].value, highest = lowest;

    for (int i = 1; i < reader->count; ++i) {
        lowest = fmin(lowest, reader->rows[i].value);
        highest = fmax(highest, reader->rows[i].value);
    }
    const double unit = reader->is_speed ? rad_per_s : 1.0;
    if (table->largest > fmax(fabs(lowest), fabs(highest)) + 0.5 * (highest - lowest)) {
        config_warn(reader->conf, reader->key,
                    "cubic, the table goes to %.6g where its rows are from %.6g to %.6g: rows at "
                    "even distances, or interpolation = linear, would keep it near them",
                    table->largest / unit, lowest / unit, highest / unit);
    }
}

static int read_table(const config *conf, time_table **table, const char *path, const char *key,
                      int is_speed, enum table_interpolation interpolation, int repeats) {
    table_reader reader = {.conf = conf, .path = path, .key = key, .is_speed = is_speed};

    reader.file = fopen(path, "r");
    if (reader.file == NULL) {
        return refuse(&reader, 0, "cannot be read", strerror(errno));
    }
    int failed = read_rows(&reader);
    fclose(reader.file);

    if (!failed) {
        failed = check_span(&reader, repeats);
    }
    if (!failed) {
        *table = make_table(&reader, interpolation == INTERPOLATION_CUBIC, repeats);
        failed = *table == NULL ? message_no_memory(conf->messages) : 0;
    }
    if (!failed) {
        warn_of_swing(&reader, *table);
    }
    free(reader.rows);
    return failed;
}

int time_tables_read(config *conf) {
    int failed = 0;

    if (conf->analysis != ANALYSIS_DYNAMIC || conf->purpose != CONFIG_FOR_RUN) {
        return 0;
    }
    if (conf->drive_file != NULL) {
        failed = read_table(conf, &conf->drive_table, conf->drive_file, "drive.file",
                            conf->drive == DRIVE_SPEED, conf->drive_interpolation,
                            conf->drive_repeat == REPEAT_ON);
    }
    if (!failed && conf->load_file != NULL) {
        failed = read_table(conf, &conf->load_table, conf->load_file, "load.file", 0,
                            conf->load_interpolation, conf->load_repeat == REPEAT_ON);
    }
    return failed;
}

static void free_table(time_table *table) {
    if (table != NULL) {
        free(table->pieces);
    }
    free(table);
}

void time_tables_free(config *conf) {
    free_table(conf->drive_table);
    free_table(conf->load_table);
    conf->drive_table = conf->load_table = NULL;
}

/* ---------------------------------------------------------------------------------------------
 * Values
 * ------------------------------------------------------------------------------------------- */

double time_table_tolerance(const time_table *table, double time) {
    return 4e-15 * (fabs(time) + table->end - table->pieces[0].start);
}

/* Where a time lies: the piece, the time since its start, and the periods before. NULL: behind the last row. */
static const piece *locate(const time_table *table, double time, double *s, double *periods) {
    const double first = table->pieces[0].start;
    const double shifted = time + time_table_tolerance(table, time);
    double local = time;

    *periods = 0.0;
    if (table->period > 0.0) {
        *periods = floor((shifted - first) / table->period);
        local = time - *periods * table->period;
    } else if (shifted >= table->end) {
        *s = time - table->end;
        return NULL;
    }

    /* The last piece that does not begin later. */
    int low = 0, high = table->count - 1;
    const double rounded = local + (shifted - time);
    while (low < high) {
        const int middle = (low + high + 1) / 2;
        if (table->pieces[middle].start <= rounded) {
            low = middle;
        } else {
            high = middle - 1;
        }
    }
    *s = fmax(local - table->pieces[low].start, 0.0);
    return &table->pieces[low];
}

double time_table_value(const time_table *table, double time) {
    double s, periods;
    const piece *part = locate(table, fmax(time, 0.0), &s, &periods);

    return part != NULL ? piece_value(part, s) : table->last;
}

double time_table_slope(const time_table *table, double time) {
    double s, periods;
    const piece *part = locate(table, time, &s, &periods);

    return part != NULL ? piece_slope(part, s) : 0.0;
}

double time_table_integral(const time_table *table, double time) {
    double s, periods;
    const piece *part = locate(table, fmax(time, 0.0), &s, &periods);
    const double held = fmin(time, 0.0) * time_table_value(table, 0.0);
    const double since =
        part != NULL ? part->before + piece_integral(part, s) : table->total + table->last * s;

    return held + periods * table->total + since - table->zero;
}

/* Gauss's rule of three points is exact for a cubic times a straight line. */
static double gauss(const time_table *table, double from, double to, double begin, double length,
                    double first_weight, double last_weight) {
    static const double nodes[3] = {0.1127016653792583, 0.5, 0.8872983346207417};
    static const double shares[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
    double sum = 0.0;

    for (int k = 0; k < 3; ++k) {
        const double time = from + nodes[k] * (to - from);
        const double share = (time - begin) / length;
        const double weight = first_weight + (last_weight - first_weight) * share;
        sum += shares[k] * (to - from) * weight * time_table_value(table, time);
    }
    return sum;
}

double time_table_weighted(const time_table *table, double from, double to, double first_weight,
                           double last_weight) {
    double sum = 0.0;

    /* Row by row, and the value held before t = 0 as a piece of its own. */
    for (double begin = from, end; begin < to; begin = end) {
        int kink;
        end = begin < 0.0 ? 0.0 : time_table_next_row(table, begin, &kink);
        end = fmin(end, to);
        sum += gauss(table, begin, end, from, to - from, first_weight, last_weight);
    }
    return sum;
}

double time_table_steepest(const time_table *table, double time) {
    double s, periods;
    const piece *part = locate(table, time, &s, &periods);

    return part == NULL ? 0.0
                        : fabs(part->c[1]) + part->length * (2.0 * fabs(part->c[2]) +
                                                             3.0 * part->length * fabs(part->c[3]));
}

double time_table_curvature(const time_table *table, double time) {
    double s, periods;
    const piece *part = locate(table, time, &s, &periods);

    return part == NULL ? 0.0 : 2.0 * fabs(part->c[2]) + 6.0 * part->length * fabs(part->c[3]);
}

double time_table_next_row(const time_table *table, double time, int *kink) {
    double s, periods;
    const piece *part = locate(table, time, &s, &periods);

    *kink = 0;
    if (part == NULL) {
        return HUGE_VAL;
    }

    const int is_last = part == &table->pieces[table->count - 1];
    *kink = is_last ? table->kink_at_end : part[1].is_kink;
    return periods * table->period + (is_last ? table->end : part[1].start);
}

double time_table_largest(const time_table *table) {
    return table->largest;
}
