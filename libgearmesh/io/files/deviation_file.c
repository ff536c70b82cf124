/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Deviation files: `tooth,flank,t1,t2,deviation_um`, described in docs/flank-files.md. Rows are read and
 * kept first; when all are there, their grid is known and they are put into full tables.
 */

#include "deviation_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "deviation_grid.h"
#include "deviation_rows.h"
#include "flank_slot.h"
#include "io_error.h"
#include "number_text.h"
#include "shared.h"
#include "table_reader.h"
#include "table_writer.h"

enum { COLUMN_TOOTH, COLUMN_FLANK, COLUMN_T1, COLUMN_T2, COLUMN_DEVIATION, COLUMN_COUNT };

static const char *const columns[COLUMN_COUNT] = {"tooth", "flank", "t1", "t2", "deviation_um"};

/* Micrometres in the file, metres in memory. */
#define MICRO (-6)

/* Of t1 and t2 when written: nodes are told apart and found again with a tolerance of 1e-5. */
#define PLACE_DIGITS 6

static size_t node_count(const gm_deviations *deviations) {
    return (size_t)deviations->face_nodes * (size_t)deviations->profile_nodes;
}

/* ---------------------------------------------------------------------------------------------
 * Reading
 * ------------------------------------------------------------------------------------------- */

/* A file on its way into memory. */
typedef struct loader {
    int teeth;
    int slots;
    gmi_rows rows;
    size_t *row_count; /* [slots] */
    double **values;   /* [slots] full tables, once the grid is known */
    gmi_grid grid;
    gm_io_error *error;
} loader;

static int loader_init(loader *load, int teeth, gm_io_error *error) {
    memset(load, 0, sizeof *load);
    load->teeth = teeth;
    load->slots = gmi_slot_count(teeth);
    load->error = error;
    load->row_count = calloc((size_t)load->slots, sizeof *load->row_count);
    load->values = calloc((size_t)load->slots, sizeof *load->values);
    return load->row_count != NULL && load->values != NULL ? GM_IO_OK : gmi_error_memory(error);
}

/* Frees all that was not handed on. */
static void loader_free(loader *load) {
    gmi_rows_free(&load->rows);
    for (int slot = 0; load->values != NULL && slot < load->slots; ++slot) {
        free(load->values[slot]);
    }
    free(load->values);
    free(load->row_count);
}

static int is_position(double position) {
    return position >= -GMI_POSITION_TOLERANCE && position <= 1.0 + GMI_POSITION_TOLERANCE;
}

static int read_position(const gmi_table *table, int column, double *position) {
    const int status = gmi_table_number(table, column, 0, position);
    if (status != GM_IO_OK) {
        return status;
    }
    if (!is_position(*position)) {
        char quoted[GMI_QUOTE_SIZE];
        return gmi_error_set(table->error, GM_IO_ERR_FORMAT, table->line,
                             "%s: must be from 0 to 1 (got %s)", columns[column],
                             gmi_quote(quoted, table->fields[column]));
    }
    return GM_IO_OK;
}

/* What follows a word and a comma at the beginning of a text; NULL if they are not there. */
static const char *behind_word(const char *text, const char *word) {
    for (; *word != '\0'; ++word, ++text) {
        if (*text != *word) {
            return NULL;
        }
    }
    return *text == ',' ? text + 1 : NULL;
}

/* The same of a tooth. */
static const char *behind_tooth(const char *text, int teeth, int *tooth) {
    const char *begin = text;
    *tooth = 0;
    for (; *text >= '0' && *text <= '9' && *tooth < teeth; ++text) {
        *tooth = 10 * *tooth + (*text - '0');
    }
    return text > begin && *tooth < teeth && *text == ',' ? text + 1 : NULL;
}

/* The same of a plain number and the character behind it; the text may be NULL. */
static const char *behind_number(const char *text, int exponent, char last, double *value) {
    const char *end = text != NULL ? gmi_number_short(text, exponent, value) : NULL;
    return end != NULL && *end == last ? end + 1 : NULL;
}

/* How rows begin that follow each other along the profile: with the same tooth, flank and t1. */
typedef struct row_beginning {
    char text[32];
    size_t length; /* 0: none is known */
    int slot;
    double face;
} row_beginning;

/* Reads it in a plain row, and keeps it if it is short enough; returns what follows it, or NULL. */
static const char *read_beginning(const char *text, int teeth, row_beginning *begins) {
    if (begins->length > 0 && strncmp(text, begins->text, begins->length) == 0) {
        return text + begins->length;
    }
    begins->length = 0;

    int tooth = 0;
    const char *flank = behind_tooth(text, teeth, &tooth);
    if (flank == NULL) {
        return NULL;
    }
    const char *coast = behind_word(flank, gmi_side_name(GM_COAST));
    const char *face = coast != NULL ? coast : behind_word(flank, gmi_side_name(GM_DRIVE));
    const char *end = behind_number(face, 0, ',', &begins->face);
    if (end == NULL || !is_position(begins->face)) {
        return NULL;
    }

    begins->slot = gmi_slot(tooth, coast != NULL ? GM_COAST : GM_DRIVE);
    const size_t length = (size_t)(end - text);
    if (length <= sizeof begins->text) {
        memcpy(begins->text, text, length);
        begins->length = length;
    }
    return end;
}

/*
 * A row as programs write it: no blanks, one tooth and flank, plain numbers. Nearly all rows of nearly all files are of
 * this kind, and read twice as fast as by read_row(). 0: a row of another kind, or a wrong one.
 */
static int read_plain_row(const gmi_table *table, int teeth, row_beginning *begins, gmi_row *row) {
    const char *text = read_beginning(table->text, teeth, begins);

    text = behind_number(text, 0, ',', &row->position[GMI_PROFILE]);
    text = behind_number(text, MICRO, '\0', &row->value);
    if (text == NULL || !is_position(row->position[GMI_PROFILE])) {
        return 0;
    }
    row->position[GMI_FACE] = begins->face;
    row->line = table->line;
    row->slot = begins->slot;
    return 1;
}

static int read_row(const gmi_table *table, int teeth, gmi_row *row) {
    int tooth = GMI_ALL;
    int side = GMI_ALL;
    int status = gmi_table_tooth(table, COLUMN_TOOTH, teeth, &tooth);
    if (status == GM_IO_OK) {
        status = gmi_table_flank(table, COLUMN_FLANK, &side);
    }
    if (status == GM_IO_OK) {
        status = read_position(table, COLUMN_T1, &row->position[GMI_FACE]);
    }
    if (status == GM_IO_OK) {
        status = read_position(table, COLUMN_T2, &row->position[GMI_PROFILE]);
    }
    if (status == GM_IO_OK) {
        status = gmi_table_number(table, COLUMN_DEVIATION, MICRO, &row->value);
    }

    row->line = table->line;
    row->slot = gmi_slot(tooth, side);
    return status;
}

static int read_rows(loader *load, gmi_table *table) {
    row_beginning begins = {.length = 0};
    int more = 0;

    while ((more = gmi_table_line(table)) > 0) {
        gmi_row *row = gmi_rows_room(&load->rows);
        if (row == NULL) {
            return gmi_error_memory(load->error);
        }

        /* A plain row is read in one pass; any other one, and what is wrong with it, cell by cell. */
        if (!read_plain_row(table, load->teeth, &begins, row)) {
            more = gmi_table_split(table);
            const int status = more > 0 ? read_row(table, load->teeth, row) : more;
            if (status != GM_IO_OK) {
                return status;
            }
        }

        gmi_rows_take(&load->rows);
        ++load->row_count[row->slot];
    }

    if (more == 0 && load->rows.first == NULL) {
        return gmi_error_set(
            load->error, GM_IO_ERR_FORMAT, table->line,
            "there must be rows below the header, of at least 2 x 2 nodes (got none)");
    }
    return more;
}

static int read_file(loader *load, const char *path) {
    gmi_table table;
    int status = gmi_table_open(&table, path, columns, COLUMN_COUNT, load->error);
    if (status == GM_IO_OK) {
        status = read_rows(load, &table);
    }
    gmi_table_close(&table);
    return status;
}

/* Hands the tables over in the order of their slots, whatever the order in the file was. */
static int make_deviations(loader *load, gm_deviations *deviations) {
    int count = 0;
    for (int slot = 0; slot < load->slots; ++slot) {
        count += load->values[slot] != NULL ? 1 : 0;
    }
    deviations->sets = malloc((size_t)count * sizeof *deviations->sets);
    if (deviations->sets == NULL) {
        return gmi_error_memory(load->error);
    }

    deviations->teeth = load->teeth;
    deviations->face_nodes = load->grid.nodes[GMI_FACE];
    deviations->profile_nodes = load->grid.nodes[GMI_PROFILE];

    for (int slot = 0; slot < load->slots; ++slot) {
        if (load->values[slot] != NULL) {
            gm_deviation_set *set = &deviations->sets[deviations->set_count++];
            set->tooth = gmi_slot_tooth(slot);
            set->side = gmi_slot_side(slot);
            set->values = load->values[slot];
            load->values[slot] = NULL;
        }
    }
    return GM_IO_OK;
}

static int load_deviations(loader *load, gm_deviations *deviations, const char *path) {
    int status = read_file(load, path);
    if (status == GM_IO_OK) {
        status = gmi_grid_find(&load->grid, &load->rows, load->row_count, load->error);
    }
    if (status == GM_IO_OK) {
        status = gmi_grid_fill(&load->grid, &load->rows, load->row_count, load->values, load->slots,
                               load->error);
    }
    return status == GM_IO_OK ? make_deviations(load, deviations) : status;
}

int gm_deviations_read(gm_deviations *deviations, const char *path, int teeth, gm_io_error *error) {
    gmi_error_begin(error, path);
    if (deviations != NULL) {
        memset(deviations, 0, sizeof *deviations);
    }
    if (deviations == NULL || path == NULL) {
        return gmi_error_null(error);
    }
    int status = gmi_check_teeth(teeth, error);
    if (status != GM_IO_OK) {
        return status;
    }

    loader load;
    status = loader_init(&load, teeth, error);
    if (status == GM_IO_OK) {
        status = load_deviations(&load, deviations, path);
    }
    loader_free(&load);
    return status;
}

void gm_deviations_free(gm_deviations *deviations) {
    if (deviations == NULL) {
        return;
    }
    for (int i = 0; deviations->sets != NULL && i < deviations->set_count; ++i) {
        free(deviations->sets[i].values);
    }
    free(deviations->sets);
    memset(deviations, 0, sizeof *deviations);
}

/* ---------------------------------------------------------------------------------------------
 * Checking deviations that a user's program may have made or changed
 * ------------------------------------------------------------------------------------------- */

static int check_sizes(const gm_deviations *deviations, gm_io_error *error) {
    const int status = gmi_check_teeth(deviations->teeth, error);
    if (status != GM_IO_OK) {
        return status;
    }

    if (deviations->face_nodes < GMI_SMALLEST_NODES || deviations->face_nodes > GMI_LARGEST_NODES ||
        deviations->profile_nodes < GMI_SMALLEST_NODES ||
        deviations->profile_nodes > GMI_LARGEST_NODES) {
        return gmi_error_set(
            error, GM_IO_ERR_OPTION, 0,
            "deviations: must be on 2 to %d nodes along each direction (got %d x %d)",
            GMI_LARGEST_NODES, deviations->face_nodes, deviations->profile_nodes);
    }

    if (deviations->set_count < 0 || (deviations->set_count > 0 && deviations->sets == NULL)) {
        return gmi_error_set(
            error, GM_IO_ERR_OPTION, 0,
            "deviations: must have the sets that they count (got %d and no list of them)",
            deviations->set_count);
    }
    return GM_IO_OK;
}

static int check_set(const gm_deviations *deviations, int index, gm_io_error *error) {
    const gm_deviation_set *set = &deviations->sets[index];
    if (set->tooth < GMI_ALL || set->tooth >= deviations->teeth || set->side < GMI_ALL ||
        set->side > GM_COAST || set->values == NULL) {
        return gmi_error_set(error, GM_IO_ERR_OPTION, 0,
                             "set %d of the deviations: must have values, for a tooth from -1 to "
                             "%d and a side from -1 to 1 (got tooth %d and side %d%s)",
                             index, deviations->teeth - 1, set->tooth, set->side,
                             set->values ? "" : " without values");
    }

    for (size_t node = 0; node < node_count(deviations); ++node) {
        if (!isfinite(set->values[node])) {
            return gmi_error_set(
                error, GM_IO_ERR_OPTION, 0,
                "set %d of the deviations: all values must be finite (got one that is not)", index);
        }
    }
    return GM_IO_OK;
}

static int index_set(const gm_deviations *deviations, int index, int *set_of_slot,
                     gm_io_error *error) {
    const int status = check_set(deviations, index, error);
    if (status != GM_IO_OK) {
        return status;
    }
    const int slot = gmi_slot(deviations->sets[index].tooth, deviations->sets[index].side);
    if (set_of_slot[slot] >= 0) {
        char name[GMI_SLOT_NAME_SIZE];
        return gmi_error_set(error, GM_IO_ERR_OPTION, 0,
                             "%s: must have one set of deviations (got two, %d and %d)",
                             gmi_slot_name(name, slot), set_of_slot[slot], index);
    }
    set_of_slot[slot] = index;
    return GM_IO_OK;
}

int gmi_deviations_index(const gm_deviations *deviations, int **set_of_slot, gm_io_error *error) {
    *set_of_slot = NULL;
    int status = check_sizes(deviations, error);
    if (status != GM_IO_OK) {
        return status;
    }
    const int slots = gmi_slot_count(deviations->teeth);
    int *index = malloc((size_t)slots * sizeof *index);
    if (index == NULL) {
        return gmi_error_memory(error);
    }

    for (int slot = 0; slot < slots; ++slot) {
        index[slot] = -1;
    }
    for (int i = 0; i < deviations->set_count && status == GM_IO_OK; ++i) {
        status = index_set(deviations, i, index, error);
    }

    if (status != GM_IO_OK) {
        free(index);
        return status;
    }
    *set_of_slot = index;
    return GM_IO_OK;
}

int gm_deviations_ideal_teeth(const gm_deviations *deviations, int side) {
    if (deviations == NULL || deviations->teeth > GMI_LARGEST_TEETH ||
        (side != GM_DRIVE && side != GM_COAST)) {
        return 0;
    }
    unsigned char covered[GMI_LARGEST_TEETH / 8 + 1] = {0}; /* one bit per tooth */
    int ideal = deviations->teeth;

    for (int i = 0; i < deviations->set_count; ++i) {
        const gm_deviation_set *set = &deviations->sets[i];
        const int serves_side = set->side == side || set->side == GMI_ALL;
        if (!serves_side || set->tooth < GMI_ALL || set->tooth >= deviations->teeth) {
            continue;
        }
        if (set->tooth == GMI_ALL) {
            return 0;
        }

        /* A tooth with two sets counts once. */
        const unsigned bit = 1U << (set->tooth % 8);
        if ((covered[set->tooth / 8] & bit) == 0) {
            covered[set->tooth / 8] = (unsigned char)(covered[set->tooth / 8] | bit);
            --ideal;
        }
    }
    return ideal;
}

/* ---------------------------------------------------------------------------------------------
 * Writing
 * ------------------------------------------------------------------------------------------- */

/* Nonzero if it failed. */
static int print_node(FILE *stream, const gm_deviations *deviations, const gm_deviation_set *set,
                      int face, int profile) {
    const size_t node = (size_t)face * (size_t)deviations->profile_nodes + (size_t)profile;
    const double t1 = (double)face / (deviations->face_nodes - 1);
    const double t2 = (double)profile / (deviations->profile_nodes - 1);
    char tooth[GMI_SLOT_NAME_SIZE];
    char place[2][GMI_NUMBER_SIZE];
    char value[GMI_NUMBER_SIZE];

    return fprintf(stream, "%s,%s,%s,%s,%s\n", gmi_tooth_name(tooth, set->tooth),
                   gmi_side_name(set->side), gmi_number_text(place[0], t1, 0, PLACE_DIGITS),
                   gmi_number_text(place[1], t2, 0, PLACE_DIGITS),
                   gmi_number_text(value, set->values[node], -MICRO, 0)) < 0;
}

static int print_rows(FILE *stream, const void *data) {
    const gm_deviations *deviations = data;
    int failed = 0;

    for (int i = 0; i < deviations->set_count; ++i) {
        for (int face = 0; face < deviations->face_nodes; ++face) {
            for (int profile = 0; profile < deviations->profile_nodes && !failed; ++profile) {
                failed = print_node(stream, deviations, &deviations->sets[i], face, profile);
            }
        }
    }
    return failed;
}

/* Deviations that cannot be read back are not written. */
static int check_writable(const gm_deviations *deviations, gm_io_error *error) {
    int *set_of_slot = NULL;
    const int status = gmi_deviations_index(deviations, &set_of_slot, error);
    free(set_of_slot);
    if (status == GM_IO_OK && deviations->set_count == 0) {
        return gmi_error_set(error, GM_IO_ERR_OPTION, 0,
                             "deviations to write: must be at least one set (got none)");
    }
    return status;
}

int gm_deviations_print(const gm_deviations *deviations, FILE *stream, gm_io_error *error) {
    gmi_error_begin(error, NULL);
    if (deviations == NULL || stream == NULL) {
        return gmi_error_null(error);
    }

    const int status = check_writable(deviations, error);
    const gmi_written table = {columns, COLUMN_COUNT, print_rows, deviations};
    return status == GM_IO_OK ? gmi_table_print(&table, stream, error) : status;
}

int gm_deviations_write(const gm_deviations *deviations, const char *path, gm_io_error *error) {
    gmi_error_begin(error, path);
    if (deviations == NULL || path == NULL) {
        return gmi_error_null(error);
    }

    /* No file is touched for data that cannot be read back. */
    const int status = check_writable(deviations, error);
    const gmi_written table = {columns, COLUMN_COUNT, print_rows, deviations};
    return status == GM_IO_OK ? gmi_table_write(&table, path, error) : status;
}
