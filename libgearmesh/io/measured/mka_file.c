/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Text files of Klingelnberg gear measuring machines (.mka), German or English. The grammar is known from public readers
 * of such files alone: docs/measured-flanks.md says which and what of it. Letters beyond ASCII play no part, so that
 * UTF-8 and 8-bit code pages read the same.
 */

#include "mka_file.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "files/io_error.h"
#include "files/number_text.h"
#include "files/table_reader.h"
#include "measurement.h"
#include "shared.h"

/* Units of the file. */
#define MICRO (-6)
#define MILLI (-3)

static const double degree = 3.14159265358979323846 / 180.0;

/* Numbers of the header lines that are used. */
enum {
    MODULE = 21,
    TEETH = 22,
    HELIX_ANGLE = 23,
    PRESSURE_ANGLE = 24,
    PROFILE_FROM = 41,
    PROFILE_TO = 44,
    HELIX_FROM = 61,
    HELIX_TO = 64,
    CODES = 100
};

/* What the header says of a number: values for left and right flanks, where there are two. */
typedef struct header_line {
    int count; /* numbers there, 0 = none */
    double value[2];
    long line;
} header_line;

typedef struct point {
    int index; /* among all values of its trace */
    double deviation;
    long line;
} point;

/* A file on its way into memory. */
typedef struct reader {
    gmi_table lines;
    int is_again; /* the line in `lines.text` is to be read once more */
    int style;
    double undefined;          /* values up to this one stand for no point (um) */
    header_line header[CODES]; /* by number */
    const gm_pair *pair;       /* NULL = only the pitch is wanted */
    const gm_gear *gear;
    int is_wheel;
    int is_internal; /* said by the line of the teeth, or external, or neither */
    int is_external;
    int is_checked; /* the header belongs to the gear */
    gm_traces *traces;
    int trace_capacity;
    gm_measured_pitch *pitch;
    int pitch_capacity;
    point *points; /* of the trace that is read */
    int point_count;
    int point_capacity;
    gm_io_error *error;
} reader;

/* ---------------------------------------------------------------------------------------------
 * Text
 * ------------------------------------------------------------------------------------------- */

static int is_blank(char c) {
    return c == ' ' || c == '\t';
}

static char *skip_blanks(char *text) {
    while (is_blank(*text)) {
        ++text;
    }
    return text;
}

static int is_digit(char c) {
    return c >= '0' && c <= '9';
}

/* Whether a text begins with a word, whatever the case of its letters. */
static int begins_with(const char *text, const char *word) {
    for (; *word != '\0'; ++text, ++word) {
        if (tolower((unsigned char)*text) != *word) {
            return 0;
        }
    }
    return 1;
}

/* Behind the first of the words in a text, NULL = none is there; the words are in small letters, NULL ends them. */
static char *behind_word(char *text, const char *const *words) {
    for (; *text != '\0'; ++text) {
        for (const char *const *word = words; *word != NULL; ++word) {
            if (begins_with(text, *word)) {
                return text + strlen(*word);
            }
        }
    }
    return NULL;
}

static const char *const tooth_words[] = {"zahn-nr", "tooth-n", "tooth n", "tooth:", NULL};
static const char *const left_words[] = {"links", "linke ", "left", NULL};
static const char *const right_words[] = {"rechts", "rechte ", "right", NULL};
static const char *const flank_words[] = {"zahnflanke", "flank", NULL};

/* GM_LEFT or GM_RIGHT by the word that comes first, and the text behind it; -1 = neither. */
static int find_flank(char *text, char **behind) {
    char *left = behind_word(text, left_words);
    char *right = behind_word(text, right_words);

    *behind = left == NULL || (right != NULL && right < left) ? right : left;
    return *behind == NULL ? -1 : *behind == left ? GM_LEFT : GM_RIGHT;
}

/* Cuts the next word off a text; NULL = there is none. */
static char *next_word(char **text) {
    char *word = skip_blanks(*text);
    if (*word == '\0') {
        return NULL;
    }

    char *end = word;
    while (*end != '\0' && !is_blank(*end)) {
        ++end;
    }
    *text = *end != '\0' ? end + 1 : end;
    *end = '\0';
    return word;
}

/* A number that fills a word; 0 = it is none. */
static int parse(const reader *from, char *word, int exponent, double *value) {
    char *comma = from->style == GM_DECIMAL_COMMA ? strchr(word, ',') : NULL;
    if (comma != NULL) {
        *comma = '.';
    }
    return gmi_number_parse(word, exponent, value) == GMI_NUMBER_OK;
}

static int fail_value(const reader *from, const char *what, const char *word) {
    char quoted[GMI_QUOTE_SIZE];
    if (strchr(word, ',') != NULL) {
        gmi_error_option(from->error, "style");
    }
    return gmi_error_set(from->error, GM_IO_ERR_FORMAT, from->lines.line,
                         "%s: must be a number like 1.5 (got %s)", what, gmi_quote(quoted, word));
}

/* The next line, or the last one again: 1 = a line, 0 = end of the file, < 0 = gm_io_status. */
static int next_line(reader *from) {
    if (from->is_again) {
        from->is_again = 0;
        return 1;
    }
    return gmi_lines_next(&from->lines);
}

/* ---------------------------------------------------------------------------------------------
 * Header
 * ------------------------------------------------------------------------------------------- */

/* ` 41 :Start Messbereich da [mm].: 84.600 84.600`: the number, and what stands behind its label. 0 = another line. */
static int header_code(char *text, char **values) {
    text = skip_blanks(text);
    int code = 0;
    int digits = 0;
    for (; is_digit(*text) && digits < 4; ++text, ++digits) {
        code = 10 * code + (*text - '0');
    }

    text = skip_blanks(text);
    if (digits == 0 || digits > 3 || *text != ':') {
        return 0;
    }
    char *colon = strchr(text + 1, ':');
    *values = colon != NULL ? colon + 1 : text + strlen(text);
    return code;
}

/* Degrees, minutes and seconds, whatever stands between them, and behind them the hand of a helix: 1 = right, -1 = left,
 * 0 = not said. */
static void read_angle(const reader *from, char *text, header_line *into) {
    char *behind;
    const int hand = find_flank(text, &behind);
    double part = 1.0;

    into->value[0] = 0.0;
    for (into->count = 0; into->count < 3 && *text != '\0'; ++into->count) {
        text += strcspn(text, "0123456789");
        const size_t length = strspn(text, "0123456789.,");
        char word[32];
        double value = 0.0;
        if (length == 0 || length >= sizeof word) {
            break;
        }

        memcpy(word, text, length);
        word[length] = '\0';
        text += length;
        if (!parse(from, word, 0, &value)) {
            break;
        }
        into->value[0] += value * part;
        part /= 60.0;
    }
    into->value[0] *= degree;
    into->value[1] = hand == GM_RIGHT ? 1.0 : hand == GM_LEFT ? -1.0 : 0.0;
}

/* Numbers among the words of a header line. */
static void read_numbers(const reader *from, char *text, header_line *into) {
    for (char *word = next_word(&text); word != NULL && into->count < 2; word = next_word(&text)) {
        into->count += parse(from, word, 0, &into->value[into->count]);
    }
}

static void read_header_line(reader *from, int code, char *values) {
    header_line *into = &from->header[code];
    into->count = 0;
    into->line = from->lines.line;
    if (code == HELIX_ANGLE || code == PRESSURE_ANGLE) {
        read_angle(from, values, into);
    } else {
        static const char *const internal[] = {"innenverz", "internal", NULL};
        static const char *const external[] = {"enverzahnung", "external",
                                               NULL}; /* Aussen-, in any code page */
        if (code == TEETH) {
            from->is_internal = behind_word(values, internal) != NULL;
            from->is_external = !from->is_internal && behind_word(values, external) != NULL;
        }
        read_numbers(from, values, into);
    }
}

/* `KEY value`: what is said of all numbers. */
static int read_preamble(reader *from, char *text) {
    char *key = next_word(&text);
    char *word = next_word(&text);
    if (key == NULL || word == NULL) {
        return GM_IO_OK;
    }

    if (strcmp(key, "UNDEFINED") == 0) {
        double value = 0.0;
        if (!parse(from, word, 0, &value)) {
            return fail_value(from, key, word);
        }
        from->undefined = value + 1.0; /* it may be rounded */
    } else if (strcmp(key, "UNITS") == 0 && strcmp(word, "mm") != 0) {
        char quoted[GMI_QUOTE_SIZE];
        return gmi_error_set(from->error, GM_IO_ERR_FORMAT, from->lines.line,
                             "UNITS: must be mm (got %s)", gmi_quote(quoted, word));
    } else if (strcmp(key, "PROFILE") == 0 && !begins_with(word, "diamet") &&
               !begins_with(word, "durchm")) {
        char quoted[GMI_QUOTE_SIZE];
        return gmi_error_set(from->error, GM_IO_ERR_FORMAT, from->lines.line,
                             "PROFILE: must be diameter (got %s)", gmi_quote(quoted, word));
    }
    return GM_IO_OK;
}

/* ---------------------------------------------------------------------------------------------
 * The gear
 * ------------------------------------------------------------------------------------------- */

/*
 * What a header line says of the gear must be what the gear has; a line that is not there says nothing. Teeth of a ring
 * are counted above or below 0.
 */
static int check_value(const reader *from, int code, const char *what, double right, double unit,
                       double tolerance) {
    const header_line *line = &from->header[code];
    const int either_sign = code == TEETH && from->gear->sign < 0.0;
    char good[GMI_NUMBER_SIZE];
    char got[GMI_NUMBER_SIZE];
    if (line->count == 0 || fabs(line->value[0] - right) <= tolerance ||
        (either_sign && fabs(line->value[0] + right) <= tolerance)) {
        return GM_IO_OK;
    }
    return gmi_error_set(from->error, GM_IO_ERR_FORMAT, line->line,
                         "%s: must be %s, that of the %s in the parameter file (got %s)", what,
                         gmi_number_text(good, right / unit, 0, 6),
                         from->is_wheel ? "wheel" : "pinion",
                         gmi_number_text(got, line->value[0] / unit, 0, 6));
}

/* A right-handed pinion has a left-handed wheel, or a right-handed ring. */
static int check_hand(const reader *from) {
    const header_line *line = &from->header[HELIX_ANGLE];
    const double hand = from->is_wheel ? -from->gear->sign : 1.0;
    const double right = hand * from->pair->helix_angle;
    if (line->count == 0 || line->value[1] * right >= 0.0) {
        return GM_IO_OK;
    }
    return gmi_error_set(from->error, GM_IO_ERR_FORMAT, line->line,
                         "the helix must be %s-handed, as that of the %s in the parameter file "
                         "(got the other hand)",
                         right > 0.0 ? "right" : "left", from->is_wheel ? "wheel" : "pinion");
}

/* External or internal, where the line of the teeth says it. */
static int check_form(const reader *from) {
    const int is_ring = from->gear->sign < 0.0;
    if (!(is_ring ? from->is_external : from->is_internal)) {
        return GM_IO_OK;
    }
    return gmi_error_set(from->error, GM_IO_ERR_FORMAT, from->header[TEETH].line,
                         "must be an %s gear, as the %s in the parameter file (got an %s one)",
                         is_ring ? "internal" : "external", from->is_wheel ? "wheel" : "pinion",
                         is_ring ? "external" : "internal");
}

static int check_gear(reader *from) {
    static const double minute = 3.14159265358979323846 / 180.0 / 60.0;
    const gm_pair *pair = from->pair;
    const double helix = fabs(pair->helix_angle);
    if (from->is_checked) {
        return GM_IO_OK;
    }

    from->is_checked = 1;
    int status = check_form(from);
    if (status != GM_IO_OK) {
        return status;
    }
    status = check_value(from, TEETH, "number of teeth", from->gear->teeth, 1.0, 0.5);
    if (status == GM_IO_OK) {
        status = check_value(from, MODULE, "normal module (mm)", 1e3 * pair->normal_module, 1.0,
                             1e-3 * 1e3 * pair->normal_module);
    }
    if (status == GM_IO_OK) {
        status = check_value(from, PRESSURE_ANGLE, "pressure angle (deg)",
                             pair->normal_pressure_angle, degree, minute);
    }
    if (status == GM_IO_OK) {
        status = check_value(from, HELIX_ANGLE, "helix angle (deg)", helix, degree, minute);
    }
    return status == GM_IO_OK ? check_hand(from) : status;
}

/* ---------------------------------------------------------------------------------------------
 * Traces
 * ------------------------------------------------------------------------------------------- */

/* `Zahn-Nr.: 1k /Flankenlinie:3 links / 480  Werte  x= 10.263` */
typedef struct trace_head {
    gm_trace trace; /* without points */
    int values;     /* that follow */

    /* z: a profile at a distance from the datum, x: a helix at a roll length, d: at a diameter */
    char axis;
} trace_head;

static int fail_head(const reader *from, const char *right) {
    return gmi_error_set(from->error, GM_IO_ERR_FORMAT, from->lines.line,
                         "the head of a trace: must have %s, as in `Zahn-Nr.: 1 links / 480 Werte "
                         "z= 7.5`",
                         right);
}

static char *read_count(char *text, int *value) {
    *value = 0;
    for (; is_digit(*text) && *value < 100000000; ++text) {
        *value = 10 * *value + (*text - '0');
    }
    return text;
}

/* `text` is behind the word for a tooth, and a flank is named somewhere behind it. */
static int read_head(const reader *from, char *text, trace_head *head) {
    memset(head, 0, sizeof *head);

    /* The tooth, perhaps with the letter of a twist or repeated trace. */
    text += strcspn(text, "0123456789:");
    text = *text == ':' ? skip_blanks(text + 1) : text;
    if (!is_digit(*text)) {
        return fail_head(from, "the number of a tooth");
    }
    text = read_count(text, &head->trace.tooth);

    /* The flank, and how many values there are. */
    head->trace.flank = find_flank(text, &text);
    if (head->trace.flank < 0) {
        return fail_head(from, "its flank behind the tooth");
    }
    text += strcspn(text, "0123456789");
    text = read_count(text, &head->values);
    if (head->values < 2) {
        return fail_head(from, "a number of values, 2 or more");
    }

    /* Where the trace lies. */
    char *equals = strchr(text, '=');
    char *axis = equals;
    while (axis != NULL && axis > text && (axis == equals || is_blank(*axis))) {
        --axis;
    }
    head->axis = axis != NULL ? (char)tolower((unsigned char)*axis) : '\0';
    if (head->axis != 'x' && head->axis != 'z' && head->axis != 'd') {
        return fail_head(from, "its place z=, x= or d=");
    }
    text = equals + 1;
    char *word = next_word(&text);
    return word != NULL && parse(from, word, MILLI, &head->trace.at)
               ? GM_IO_OK
               : fail_head(from, "a number of its place");
}

/* The measured values behind a head. */
static int read_values(reader *from, const trace_head *head) {
    const long begin = from->lines.line;
    int count = 0;

    from->point_count = 0;
    while (count < head->values) {
        const int more = next_line(from);
        char *text = skip_blanks(from->lines.text);
        if (more < 0) {
            return more;
        }
        if (more == 0 || (*text != '\0' && strchr("+-.0123456789", *text) == NULL)) {
            return gmi_error_set(from->error, GM_IO_ERR_FORMAT,
                                 more == 0 ? begin : from->lines.line,
                                 "the trace that begins in line %ld: must have %d values (got %d)",
                                 begin, head->values, count);
        }

        for (char *word = next_word(&text); word != NULL; word = next_word(&text), ++count) {
            double value = 0.0;
            double micrometres = 0.0;
            if (count == head->values) {
                return gmi_error_set(from->error, GM_IO_ERR_FORMAT, from->lines.line,
                                     "the trace that begins in line %ld: must have %d values (got "
                                     "more)",
                                     begin, head->values);
            }
            if (!parse(from, word, MICRO, &value)) {
                return fail_value(from, "a deviation", word);
            }
            (void)gmi_number_parse(word, 0, &micrometres);
            if (micrometres <= from->undefined) {
                continue;
            }

            point *grown = gmi_array_grow(from->points, sizeof *grown, from->point_count,
                                          &from->point_capacity);
            if (grown == NULL) {
                return gmi_error_memory(from->error);
            }
            from->points = grown;
            from->points[from->point_count++] = (point){count, value, from->lines.line};
        }
    }
    return GM_IO_OK;
}

/* Where the values of a trace begin or end: the number of a header line for this flank (mm). */
static int range_end(const reader *from, const trace_head *head, int code, double *value) {
    const header_line *line = &from->header[code];
    if (line->count == 0) {
        return gmi_error_set(from->error, GM_IO_ERR_FORMAT, from->lines.line,
                             "the header must say in its line %d where the traces %s (got nothing)",
                             code, code == PROFILE_FROM || code == HELIX_FROM ? "begin" : "end");
    }
    *value = 1e-3 * line->value[line->count == 2 && head->trace.flank == GM_RIGHT];
    if (head->axis != 'z') {
        return GM_IO_OK;
    }

    /* Of a profile it is a diameter, and the machine counts along the string that unwinds. */
    const double base = from->gear->base_radius;
    if (!(0.5 * *value >= base * (1.0 - 5e-6)) || 0.5 * *value > 1e3) {
        char low[GMI_NUMBER_SIZE];
        char got[GMI_NUMBER_SIZE];
        return gmi_error_set(from->error, GM_IO_ERR_FORMAT, line->line,
                             "must be a diameter from %s mm (base circle) on (got %s)",
                             gmi_number_text(low, 2.0 * base, 3, 7),
                             gmi_number_text(got, *value, 3, 7));
    }
    *value = gmi_roll_length(0.5 * *value, base);
    return GM_IO_OK;
}

/* Points at equal distances, with rising positions; those without a value are left out. */
static int fill_trace(const reader *from, const trace_head *head, double first, double last,
                      gm_trace *trace) {
    const size_t count = (size_t)from->point_count;
    const int falls = last < first;
    *trace = head->trace;
    trace->count = from->point_count;
    trace->position = malloc(count * sizeof *trace->position);
    trace->deviation = malloc(count * sizeof *trace->deviation);
    trace->line = malloc(count * sizeof *trace->line);
    if (!trace->position || !trace->deviation || !trace->line) {
        return gmi_error_memory(from->error);
    }

    for (size_t i = 0; i < count; ++i) {
        const point *at = &from->points[falls ? count - 1 - i : i];
        const double share = (double)at->index / (head->values - 1);
        trace->position[i] = first + share * (last - first);
        trace->deviation[i] = at->deviation;
        trace->line[i] = at->line;
    }
    return GM_IO_OK;
}

/* A topography may repeat the trace of a block before it. */
static int is_known(const gm_traces *traces, const gm_trace *trace) {
    static const double same_place = 1e-5;
    for (int i = 0; i < traces->count; ++i) {
        const gm_trace *other = &traces->traces[i];
        if (other->tooth == trace->tooth && other->flank == trace->flank &&
            other->kind == trace->kind && fabs(other->at - trace->at) <= same_place) {
            return 1;
        }
    }
    return 0;
}

static int add_trace(reader *from, const trace_head *head) {
    const int is_profile = head->axis == 'z';
    double first = 0.0;
    double last = 0.0;
    int status = range_end(from, head, is_profile ? PROFILE_FROM : HELIX_FROM, &first);
    if (status == GM_IO_OK) {
        status = range_end(from, head, is_profile ? PROFILE_TO : HELIX_TO, &last);
    }
    if (status == GM_IO_OK && (!(fabs(last - first) > 1e-9) || from->point_count < 2)) {
        return gmi_error_set(from->error, GM_IO_ERR_FORMAT, from->lines.line,
                             "a trace: must have at least 2 measured points over a range (got %d)",
                             from->point_count);
    }
    if (status != GM_IO_OK || is_known(from->traces, &head->trace)) {
        return status;
    }

    gm_trace *grown = gmi_array_grow(from->traces->traces, sizeof *grown, from->traces->count,
                                     &from->trace_capacity);
    if (grown == NULL) {
        return gmi_error_memory(from->error);
    }
    from->traces->traces = grown;
    return fill_trace(from, head, first, last, &grown[from->traces->count++]);
}

/* A trace, if it is wanted; its values are read in any case. */
static int read_trace(reader *from, char *text) {
    trace_head head;
    int status = read_head(from, text, &head);
    if (status == GM_IO_OK && from->traces != NULL) {
        status = check_gear(from);
    }
    if (status == GM_IO_OK) {
        status = read_values(from, &head);
    }
    if (status != GM_IO_OK || from->traces == NULL) {
        return status;
    }

    /* A helix lies at a roll length, or at a diameter. */
    head.trace.kind = head.axis == 'z' ? GM_TRACE_PROFILE : GM_TRACE_HELIX;
    if (head.axis == 'd') {
        const double base = from->gear->base_radius;
        if (!(0.5 * head.trace.at >= base) || head.trace.at > 1e3) {
            return fail_head(from, "a diameter above the base circle");
        }
        head.trace.at = gmi_roll_length(0.5 * head.trace.at, base);
    }
    return add_trace(from, &head);
}

/* ---------------------------------------------------------------------------------------------
 * Pitch
 * ------------------------------------------------------------------------------------------- */

/* Which word of the table's header is Fp, the cumulative pitch; 0 = none. */
static int find_cumulative(char *text) {
    int place = 0;
    for (char *word = next_word(&text); word != NULL; word = next_word(&text), ++place) {
        if (strcmp(word, "Fp") == 0) {
            return place;
        }
    }
    return 0;
}

static int add_pitch(reader *from, int flank, int tooth, double value) {
    gm_pitch_point *grown = gmi_array_grow(from->pitch->points, sizeof *grown, from->pitch->count,
                                           &from->pitch_capacity);
    if (grown == NULL) {
        return gmi_error_memory(from->error);
    }
    from->pitch->points = grown;
    grown[from->pitch->count++] =
        (gm_pitch_point){.tooth = tooth, .flank = flank, .value = value, .line = from->lines.line};
    return GM_IO_OK;
}

/* The next line that is not empty: 1, 0 or < 0 as next_line(). */
static int next_content(reader *from) {
    for (;;) {
        const int more = next_line(from);
        if (more <= 0 || *skip_blanks(from->lines.text) != '\0') {
            return more;
        }
    }
}

/* `  12  -0.275 3.742 0.000` */
static int read_pitch_row(reader *from, int flank, int column) {
    char *text = from->lines.text;
    char *word = next_word(&text);
    int tooth = 0;
    double value = 0.0;
    if (*read_count(word, &tooth) != '\0') {
        return fail_value(from, "the number of a tooth", word);
    }

    for (int i = 0; i < column && word != NULL; ++i) {
        word = next_word(&text);
    }
    if (word == NULL || !parse(from, word, MICRO, &value)) {
        return fail_value(from, "Fp", word != NULL ? word : "");
    }
    return from->pitch != NULL ? add_pitch(from, flank, tooth, value) : GM_IO_OK;
}

/* The table below `linke Zahnflanke`; a title without a table is one of something else. */
static int read_pitch_table(reader *from, int flank) {
    int more = next_content(from);
    int column = 0;
    if (more > 0) {
        char header[GMI_LINE_LENGTH + 1];
        strcpy(header, from->lines.text);
        column = find_cumulative(header);
    }
    if (column == 0) {
        from->is_again = more > 0;
        return more < 0 ? more : GM_IO_OK;
    }

    /* Up to a line that is no row. */
    while ((more = next_content(from)) > 0 && is_digit(*skip_blanks(from->lines.text))) {
        const int status = read_pitch_row(from, flank, column);
        if (status != GM_IO_OK) {
            return status;
        }
    }
    from->is_again = more > 0;
    return more < 0 ? more : GM_IO_OK;
}

/* ---------------------------------------------------------------------------------------------
 * The file
 * ------------------------------------------------------------------------------------------- */

/* One line, and what belongs to it. Titles of blocks and tables of other things are passed over. */
static int read_part(reader *from) {
    char *text = from->lines.text;
    char *values;
    char *behind;
    const int code = header_code(text, &values);
    if (code > 0) {
        if (code < CODES) {
            read_header_line(from, code, values);
        }
        return GM_IO_OK;
    }

    /* A head names a tooth and a flank, the title of a table a flank alone. */
    char *tooth = behind_word(text, tooth_words);
    const int flank = find_flank(tooth != NULL ? tooth : text, &behind);
    if (tooth != NULL && flank >= 0) {
        return read_trace(from, tooth);
    }
    if (tooth == NULL && flank >= 0 && behind_word(behind, flank_words) != NULL) {
        return read_pitch_table(from, flank);
    }
    return read_preamble(from, text);
}

/* The first line says what kind of file it is: curves, or values that were evaluated. */
static int check_kind(reader *from) {
    const int more = gmi_lines_next(&from->lines);
    if (more <= 0 || strstr(from->lines.text, "KS.MK.FILE") != NULL) {
        return more < 0 ? more : GM_IO_OK;
    }
    char quoted[GMI_QUOTE_SIZE];
    return gmi_error_set(from->error, GM_IO_ERR_FORMAT, from->lines.line,
                         "must be a file of measured curves, HEADER KS.MK.FILE (got %s%s)",
                         gmi_quote(quoted, from->lines.text),
                         strstr(from->lines.text, "KS.MW.FILE") != NULL
                             ? ", values that were evaluated: give the .mka of this measurement"
                             : "");
}

static int read_file(reader *from, const char *path) {
    int status = gmi_lines_open(&from->lines, path, from->error);
    if (status == GM_IO_OK) {
        status = check_kind(from);
    }
    while (status == GM_IO_OK) {
        const int more = next_line(from);
        if (more <= 0) {
            status = more;
            break;
        }
        status = read_part(from);
    }
    gmi_table_close(&from->lines);
    free(from->points);
    return status;
}

int gmi_is_mka(const char *path) {
    static const char word[] = "HEADER";
    char begin[16] = "";
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return 0;
    }
    const size_t size = fread(begin, 1, sizeof begin - 1, file);
    fclose(file);

    const size_t mark = size >= 3 && memcmp(begin, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
    return strncmp(begin + mark, word, sizeof word - 1) == 0 &&
           is_blank(begin[mark + sizeof word - 1]);
}

static reader reader_for(int style, gm_io_error *error) {
    reader made;
    memset(&made, 0, sizeof made);
    made.style = style;
    made.undefined = -1e6; /* no deviation is a metre */
    made.error = error;
    return made;
}

int gmi_mka_traces(gm_traces *traces, const char *path, const gm_pair *pair, int wheel, int style,
                   gm_io_error *error) {
    reader from = reader_for(style, error);
    from.traces = traces;
    from.pair = pair;
    from.gear = gmi_gear_of(pair, wheel);
    from.is_wheel = wheel != 0;

    const int status = read_file(&from, path);
    return status == GM_IO_OK && traces->count == 0
               ? gmi_error_set(error, GM_IO_ERR_FORMAT, 0, "there must be traces (got none)")
               : status;
}

int gmi_mka_pitch(gm_measured_pitch *pitch, const char *path, int style, gm_io_error *error) {
    reader from = reader_for(style, error);
    from.pitch = pitch;

    const int status = read_file(&from, path);
    return status == GM_IO_OK && pitch->count == 0
               ? gmi_error_set(error, GM_IO_ERR_FORMAT, 0,
                               "there must be a table of the pitch, with a column Fp (got none)")
               : status;
}
