/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * A mesh from parameters and files of flanks, on the heap: what the bindings for simulators prepare alike. Of a
 * double-helical pair it is both halves, with a pinion that floats between them.
 */
#ifndef FILE_MESH_H
#define FILE_MESH_H

#include <gearmesh/gearmesh_io.h>

/* Files of one half, or of all; each "" for none: the flanks are ideal there. */
typedef struct file_mesh_paths {
    const char *deviations[2]; /* of pinion and wheel */
    const char *pitch[2];
} file_mesh_paths;

/* What a mesh is made of. */
typedef struct file_mesh_params {
    gm_pair_params pair; /* of the whole gears */

    /* of both halves together: stiffness, damping, load. Without tables of single teeth */
    gm_mesh_params law;

    double gap; /* between two halves of opposite hand (m); NaN: one helix */

    /* of the half at face I, and of the one at face II: what that has no file for is as in the first */
    file_mesh_paths files[2];
} file_mesh_params;

/* Begins as all zero. */
typedef struct file_mesh {
    int halves; /* 1: one helix; 2: double-helical */
    gm_mesh *mesh[2];
    gm_workspace *workspace[2]; /* of one thread; NULL: the law needs none */
    gm_flanks *flanks[2][2];    /* [half][gear] */
    void *memory[2];
    void *workspace_memory[2];
    gm_double_helical floating; /* both halves, where there are two */
} file_mesh;

/* Prepares a mesh. 0; -1 after why it cannot be, with the name of the parameter or file at fault, is in the message. */
int file_mesh_init(file_mesh *made, const file_mesh_params *params, char *message,
                   size_t message_size);

/* Frees what it holds, and leaves it all zero. */
void file_mesh_free(file_mesh *made);

/* The pair; that of a half, whose radii and angles are those of the whole gears. */
const gm_pair *file_mesh_pair(const file_mesh *made);

/* How far x may go before flanks of a side can bear a force (m): gm_mesh_clearance(). */
double file_mesh_clearance(const file_mesh *made, int side);

/* How far the pinion of a double-helical pair has floated along +z (m), and by what (m/rad, m s/rad); 0 of one helix. */
typedef struct file_mesh_float {
    double shift;
    gm_gradient by; /* with GM_WANT_DERIVATIVES */
} file_mesh_float;

/* All of it at a position. Same position, same bits, but for what elastic teeth remember. Status of gearmesh.h. */
int file_mesh_evaluate(const file_mesh *made, const gm_position *position, int wanted,
                       file_mesh_float *floated, gm_mesh_result *result);

/* The same with the wheel in a motion beside its pose, as gm_mesh_evaluate_posed(). */
int file_mesh_evaluate_posed(const file_mesh *made, const gm_motion *motion, int wanted,
                             file_mesh_float *floated, gm_mesh_result *result);

/* x in equilibrium with a torque on the wheel (m), as gm_rolling_equilibrium(). Status of gearmesh.h. */
int file_mesh_equilibrium(const file_mesh *made, double pinion_angle, double pinion_speed,
                          double wheel_torque, double *offset);

#endif
