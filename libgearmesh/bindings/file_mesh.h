/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* A mesh from parameters and files of flanks, on the heap: what the bindings for simulators prepare alike. */
#ifndef FILE_MESH_H
#define FILE_MESH_H

#include <gearmesh/gearmesh_io.h>

/* Files of a mesh, each "" for none: the flanks are ideal there. */
typedef struct file_mesh_paths {
    const char *deviations[2]; /* of pinion and wheel */
    const char *pitch[2];
} file_mesh_paths;

/* Begins as all zero. */
typedef struct file_mesh {
    gm_mesh *mesh;           /* NULL: there is none */
    gm_workspace *workspace; /* of one thread; NULL: the law needs none */
    gm_flanks *flanks[2];
    void *memory;
    void *workspace_memory;
} file_mesh;

/* Prepares a mesh. 0; -1 after why it cannot be, with the name of the parameter or file at fault, is in the message. */
int file_mesh_init(file_mesh *made, const gm_pair_params *pair, const gm_mesh_params *law,
                   const file_mesh_paths *paths, char *message, size_t message_size);

/* Frees what it holds, and leaves it all zero. */
void file_mesh_free(file_mesh *made);

#endif
