/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * CSV: provenance lines that begin with '#', a line of names, rows; a run that ends early leaves whole
 * lines and a last line `# incomplete: why`, which takes the place of rows where the disk is full.
 * A program that reads standard output may have the numbers of rows as they are in memory, in blocks
 * behind a line `# rows COUNT` each.
 */
#include "number.h"
#include "output_format.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { BUFFER_SIZE = 1 << 16, ROW_SIZE_MAX = COLUMNS_MAX * NUMBER_TEXT_SIZE };

typedef struct csv_memory {
    off_t head;    /* bytes of the lines before the first row */
    off_t written; /* bytes of whole lines in the file */
    size_t used;   /* bytes in the buffer; whole lines or whole rows only */
    long rows;     /* in the buffer as they are in memory */
    char buffer[BUFFER_SIZE];
} csv_memory;

/* Writes as much as the disk takes, in *done; returns an errno or 0. Buffers are far below the 4 GB of an unsigned. */
static int write_all(int file, const char *text, size_t size, size_t *done) {
    *done = 0;
    while (*done < size) {
        const ssize_t count = write(file, text + *done, (unsigned)(size - *done));
        if (count < 0 && errno != EINTR) {
            return errno;
        }
        if (count > 0) {
            *done += (size_t)count;
        }
    }
    return 0;
}

/* Length of the whole lines at the start of a text. */
static size_t whole_lines(const char *text, size_t size) {
    while (size > 0 && text[size - 1] != '\n') {
        --size;
    }
    return size;
}

/* Cuts the line that a full disk has left half written. */
static void cut_to_whole_lines(const output_file *output) {
    const csv_memory *memory = output->memory;

    if (!output->is_stream && ftruncate(output->result.data, memory->written) == 0) {
        (void)lseek(output->result.data, memory->written, SEEK_SET);
    }
}

/* So many rows follow as they are in memory. */
static int announce(const output_file *output, long rows) {
    char line[32];
    size_t done;

    const int length = snprintf(line, sizeof line, "# rows %ld\n", rows);
    return write_all(output->result.data, line, (size_t)length, &done);
}

/* Empties the buffer. After an error nothing more is written. */
static int flush(output_file *output) {
    csv_memory *memory = output->memory;
    size_t done;

    if (output->error != 0) {
        return output->error;
    }
    int error = memory->rows > 0 ? announce(output, memory->rows) : 0;
    if (error == 0) {
        error = write_all(output->result.data, memory->buffer, memory->used, &done);
        memory->written += (off_t)whole_lines(memory->buffer, done);
    }
    memory->used = 0;
    memory->rows = 0;
    if (error != 0) {
        cut_to_whole_lines(output);
    }
    return error;
}

/* A line of any length, which must end in '\n' and not be split: longer than the buffer is an error. */
static int put_line(output_file *output, const char *first, const char *second) {
    csv_memory *memory = output->memory;
    const size_t size = strlen(first) + strlen(second) + 1;

    const int error = size > BUFFER_SIZE - memory->used ? flush(output) : 0;
    if (error != 0 || size >= BUFFER_SIZE) {
        return error != 0 ? error : EOVERFLOW;
    }
    memory->used += (size_t)sprintf(memory->buffer + memory->used, "%s%s", first, second);
    memory->buffer[memory->used++] = '\n';
    return 0;
}

static int begin(output_file *output, const config *conf, const char *const names[]) {
    char header[BUFFER_SIZE / 16] = "";

    output->memory = calloc(1, sizeof(csv_memory));
    if (output->memory == NULL) {
        return ENOMEM;
    }

    int error = put_line(output, "# gearsim ", GM_VERSION_STRING);
    for (int i = 0; i < conf->provenance_count && error == 0; ++i) {
        error = put_line(output, "# ", conf->provenance[i]);
    }
    for (int i = 0; i < output->columns.count; ++i) {
        if (i > 0) {
            strcat(header, ",");
        }
        strcat(header, names[output->columns.name[i]]);
    }
    error = error != 0 ? error : put_line(output, header, "");
    error = error != 0 ? error : flush(output);

    csv_memory *memory = output->memory;
    memory->head = memory->written;
    return error;
}

/* Both return where the text, or the numbers, end. */
static char *put_text(char *out, const output_file *output, const double values[]) {
    for (int i = 0; i < output->columns.count; ++i) {
        /* + 0.0: no "-0" in tables. */
        out += number_format(out, values[output->columns.name[i]] + 0.0, output->digits);
        *out++ = ',';
    }
    out[-1] = '\n';
    return out;
}

static char *put_numbers(char *out, const output_file *output, const double values[]) {
    for (int i = 0; i < output->columns.count; ++i) {
        const double value = values[output->columns.name[i]];
        memcpy(out, &value, sizeof value);
        out += sizeof value;
    }
    return out;
}

static int row(output_file *output, const double values[]) {
    csv_memory *memory = output->memory;

    const int error = memory->used > BUFFER_SIZE - ROW_SIZE_MAX ? flush(output) : 0;
    if (error != 0) {
        return error;
    }

    char *start = memory->buffer + memory->used;
    const char *behind =
        output->is_binary ? put_numbers(start, output, values) : put_text(start, output, values);
    memory->used = (size_t)(behind - memory->buffer);
    memory->rows += output->is_binary;
    return 0;
}

/* Gives up as many of the last rows as hold so many bytes. Uses the buffer, which is empty by now. */
static void give_up_rows(const output_file *output, size_t bytes) {
    csv_memory *memory = output->memory;
    const off_t rows = memory->written - memory->head;
    const size_t size = rows < BUFFER_SIZE ? (size_t)rows : BUFFER_SIZE;

    /* The end of the file, and within it the end of the last row that can stay. */
    (void)lseek(output->result.data, memory->written - (off_t)size, SEEK_SET);
    if (size >= bytes &&
        read(output->result.data, memory->buffer, (unsigned)size) == (ssize_t)size) {
        memory->written -= (off_t)(size - whole_lines(memory->buffer, size - bytes));
    }
    cut_to_whole_lines(output);
}

/* Says in the file that it is not whole; if the disk takes no more, in the place of the last rows. */
static void mark_incomplete(const output_file *output, const char *why) {
    char line[512];
    size_t done;
    const int length = snprintf(line, sizeof line, "# incomplete: %s\n", why);

    if (length < 0 || (size_t)length >= sizeof line ||
        write_all(output->result.data, line, (size_t)length, &done) == 0 || output->is_stream) {
        return;
    }
    give_up_rows(output, (size_t)length);
    if (write_all(output->result.data, line, (size_t)length, &done) != 0) {
        cut_to_whole_lines(output);
    }
}

static int end(output_file *output, const char *incomplete) {
    if (output->memory == NULL) {
        return ENOMEM;
    }

    const int error = flush(output);
    const char *why = error != 0 ? strerror(error) : incomplete;
    if (why != NULL) {
        mark_incomplete(output, why);
    }
    free(output->memory);
    output->memory = NULL;
    return error;
}

const output_format csv_format = {
    .version = GM_VERSION_STRING, .begin = begin, .row = row, .end = end};
