/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * HDF5: a data set of doubles for each column, by its name; provenance as attributes of the root, by the
 * names of the keys. While the file grows, and if the run ends early, the root has an attribute
 * `incomplete` that says why.
 *
 * A write that fails in the middle would leave a file that nobody can open. Room is therefore reserved on
 * the disk before each block of rows; where there is none, the blocks before it are all that the file
 * holds. Every block is flushed, so that a file is whole even if the process is killed.
 *
 * This is the module that output.c loads. It takes no symbol from the program.
 */
#include "output_format.h"

#include <errno.h>
#include <fcntl.h>
#include <hdf5.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum {
    BLOCK_ROWS = 4096, /* of a chunk and of a flush: 32 KiB of each column */
    REASON_SIZE = 512,
    HEAD_ROOM =
        1 << 16, /* for the head without the texts, and for what a block adds to the index */
    NAME_SIZE = 128
};

static const char incomplete_name[] = "incomplete";

typedef struct hdf5_memory {
    hid_t file;
    hid_t sets[COLUMNS_MAX];
    hid_t incomplete; /* attribute */
    hid_t reason;     /* its type */
    hsize_t rows;     /* in the file */
    int used;         /* rows in the block */
    double block[COLUMNS_MAX][BLOCK_ROWS];
} hdf5_memory;

/* errno of a call that HDF5 has made in vain; it has other reasons as well. */
static int reason(void) {
    return errno != 0 ? errno : EIO;
}

/* ---------------------------------------------------------------------------------------------
 * Room
 * ------------------------------------------------------------------------------------------- */

/* So that the next bytes will not meet a full disk. HDF5 cuts what it has not used. */
static int reserve(const output_file *output, size_t size) {
    const hdf5_memory *memory = output->memory;
    hsize_t end = 0;

    if (memory->file >= 0 && H5Fget_filesize(memory->file, &end) < 0) {
        return reason();
    }
    const int error = posix_fallocate(output->result.data, (off_t)end, (off_t)size);

    /* Some file systems cannot reserve. */
    return error == EINVAL || error == EOPNOTSUPP ? 0 : error;
}

static int flush(const hdf5_memory *memory) {
    errno = 0;
    return H5Fflush(memory->file, H5F_SCOPE_LOCAL) < 0 ? reason() : 0;
}

/* ---------------------------------------------------------------------------------------------
 * Head
 * ------------------------------------------------------------------------------------------- */

/* Returns < 0 if it cannot be done, as all below that return herr_t. */
static herr_t write_text(hid_t place, const char *name, const char *text) {
    const hid_t space = H5Screate(H5S_SCALAR);
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, H5T_VARIABLE);
    H5Tset_cset(type, H5T_CSET_UTF8);

    const hid_t attribute = H5Acreate2(place, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    const herr_t failed = attribute < 0 ? -1 : H5Awrite(attribute, type, &text);
    H5Aclose(attribute);
    H5Tclose(type);
    H5Sclose(space);
    return failed;
}

/* A line "name = value" of the provenance. */
static herr_t write_provenance(hid_t place, const char *line) {
    const char *equals = strstr(line, " = ");
    char name[NAME_SIZE];

    if (equals == NULL || (size_t)(equals - line) >= sizeof name) {
        return -1;
    }
    memcpy(name, line, (size_t)(equals - line));
    name[equals - line] = '\0';
    return write_text(place, name, equals + 3);
}

/* Of a fixed size, so that a full disk has room for the reason. */
static herr_t write_incomplete(hdf5_memory *memory, const char *why) {
    char text[REASON_SIZE] = "";

    snprintf(text, sizeof text, "%s", why);
    return H5Awrite(memory->incomplete, memory->reason, text);
}

static herr_t create_incomplete(hdf5_memory *memory) {
    const hid_t space = H5Screate(H5S_SCALAR);

    memory->reason = H5Tcopy(H5T_C_S1);
    H5Tset_size(memory->reason, REASON_SIZE);
    H5Tset_cset(memory->reason, H5T_CSET_UTF8);
    memory->incomplete =
        H5Acreate2(memory->file, incomplete_name, memory->reason, space, H5P_DEFAULT, H5P_DEFAULT);
    H5Sclose(space);
    return memory->incomplete < 0 ? -1 : write_incomplete(memory, "not ended yet");
}

/* Grows without end, block by block. */
static hid_t create_set(hid_t file, const char *name) {
    const hsize_t none = 0, any = H5S_UNLIMITED, chunk = BLOCK_ROWS;
    const hid_t space = H5Screate_simple(1, &none, &any);
    const hid_t how = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(how, 1, &chunk);
    H5Pset_fill_time(how, H5D_FILL_TIME_NEVER);

    const hid_t set = H5Dcreate2(file, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, how, H5P_DEFAULT);
    H5Pclose(how);
    H5Sclose(space);
    return set;
}

static herr_t write_head(const output_file *output, const config *conf, const char *const names[]) {
    hdf5_memory *memory = output->memory;
    herr_t failed = write_text(memory->file, "gearsim", GM_VERSION_STRING);

    for (int i = 0; i < conf->provenance_count && failed >= 0; ++i) {
        failed = write_provenance(memory->file, conf->provenance[i]);
    }
    for (int i = 0; i < output->columns.count && failed >= 0; ++i) {
        memory->sets[i] = create_set(memory->file, names[output->columns.name[i]]);
        failed = memory->sets[i] < 0 ? -1 : 0;
    }
    return failed < 0 ? failed : create_incomplete(memory);
}

static size_t head_size(const config *conf) {
    size_t size = HEAD_ROOM;

    for (int i = 0; i < conf->provenance_count; ++i) {
        size += 2 * strlen(conf->provenance[i]) + NAME_SIZE;
    }
    return size;
}

static int begin(output_file *output, const config *conf, const char *const names[]) {
    hdf5_memory *memory = calloc(1, sizeof *memory);
    if (memory == NULL) {
        return ENOMEM;
    }
    output->memory = memory;
    memory->file = memory->incomplete = memory->reason = -1;

    /* Messages are ours; and after a failure there is nothing that HDF5 could still do at the exit. */
    H5dont_atexit();
    /* FILE.part is locked already. A second lock of the same kind would be refused to HDF5. */
    if (setenv("HDF5_USE_FILE_LOCKING", "FALSE", 1) != 0) {
        return errno;
    }
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);

    /* Room, the file, which takes that room back, and room again. */
    int error = reserve(output, head_size(conf));
    if (error != 0) {
        return error;
    }
    errno = 0;
    memory->file = H5Fcreate(output->result.part, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    if (memory->file < 0) {
        return reason();
    }
    error = reserve(output, head_size(conf));
    if (error != 0) {
        return error;
    }
    errno = 0;
    return write_head(output, conf, names) < 0 ? reason() : flush(memory);
}

/* ---------------------------------------------------------------------------------------------
 * Rows
 * ------------------------------------------------------------------------------------------- */

static herr_t append(hid_t set, hsize_t rows, const double values[], hsize_t count) {
    const hsize_t size = rows + count;

    if (H5Dset_extent(set, &size) < 0) {
        return -1;
    }
    const hid_t target = H5Dget_space(set);
    const hid_t source = H5Screate_simple(1, &count, NULL);
    H5Sselect_hyperslab(target, H5S_SELECT_SET, &rows, NULL, &count, NULL);

    const herr_t failed = H5Dwrite(set, H5T_NATIVE_DOUBLE, source, target, H5P_DEFAULT, values);
    H5Sclose(source);
    H5Sclose(target);
    return failed;
}

/* Empties the block. After an error nothing more is written. */
static int write_block(output_file *output) {
    hdf5_memory *memory = output->memory;
    const size_t size = (size_t)output->columns.count * sizeof memory->block[0] + HEAD_ROOM;

    if (output->error != 0 || memory->used == 0) {
        return output->error;
    }
    const int error = reserve(output, size);
    if (error != 0) {
        return error;
    }
    errno = 0;
    for (int i = 0; i < output->columns.count; ++i) {
        if (append(memory->sets[i], memory->rows, memory->block[i], (hsize_t)memory->used) < 0) {
            return reason();
        }
    }
    memory->rows += (hsize_t)memory->used;
    memory->used = 0;
    return flush(memory);
}

static int row(output_file *output, const double values[]) {
    hdf5_memory *memory = output->memory;

    for (int i = 0; i < output->columns.count; ++i) {
        /* + 0.0: no "-0" in tables. */
        memory->block[i][memory->used] = values[output->columns.name[i]] + 0.0;
    }
    ++memory->used;
    return memory->used == BLOCK_ROWS ? write_block(output) : 0;
}

/* ---------------------------------------------------------------------------------------------
 * The end
 * ------------------------------------------------------------------------------------------- */

/* What is reserved and not used is cut off. */
static int close_file(output_file *output) {
    hdf5_memory *memory = output->memory;
    hsize_t size = 0;

    for (int i = 0; i < output->columns.count; ++i) {
        H5Dclose(memory->sets[i]);
    }
    errno = 0;
    if (H5Fflush(memory->file, H5F_SCOPE_LOCAL) < 0 || H5Fget_filesize(memory->file, &size) < 0 ||
        H5Fclose(memory->file) < 0 || ftruncate(output->result.data, (off_t)size) != 0) {
        return reason();
    }
    return 0;
}

/* The attribute goes when the file is whole, else it says why not. */
static herr_t settle_incomplete(hdf5_memory *memory, const char *why) {
    if (memory->incomplete < 0) {
        return 0;
    }
    const herr_t failed = why != NULL ? write_incomplete(memory, why) : 0;

    H5Aclose(memory->incomplete);
    H5Tclose(memory->reason);
    return why != NULL ? failed : H5Adelete(memory->file, incomplete_name);
}

static int end(output_file *output, const char *incomplete) {
    hdf5_memory *memory = output->memory;
    if (memory == NULL) {
        return ENOMEM;
    }

    /* The first of all errors is told, and is the reason in the file. */
    int error = output->error;
    if (memory->file >= 0) {
        error = write_block(output);
        const char *why = error != 0 ? strerror(error) : incomplete;
        if (settle_incomplete(memory, why) < 0 && error == 0) {
            error = reason();
        }
        const int closed = close_file(output);
        error = error != 0 ? error : closed;
    }
    free(memory);
    output->memory = NULL;
    return error;
}

#if defined(__GNUC__)
__attribute__((visibility("default")))
#endif
const output_format gearsim_hdf5_format = {
    .version = GM_VERSION_STRING, .begin = begin, .row = row, .end = end};
