/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * What the Modelica package GearMesh calls. A mesh is an external object; arrays come with their size, as a tool passes
 * them. Where the library refuses a call, ModelicaError() of the tool takes over and these functions do not return.
 */
#ifndef GEARMESH_MODELICA_H
#define GEARMESH_MODELICA_H

#include <stddef.h>

/* pair, law: `values` of the records PairParameters and MeshParameters. gap: of a double-helical pair (m), 1e60: one helix.
 * Files: "" for none; those of the second half, at face II, "" as in the first. */
void *gearmesh_modelica_new(const double *pair, size_t pair_size, const double *law,
                            size_t law_size, double gap, const char *pinion_flanks,
                            const char *pinion_pitch, const char *wheel_flanks,
                            const char *wheel_pitch, const char *pinion_second_half,
                            const char *pinion_second_half_pitch, const char *wheel_second_half,
                            const char *wheel_second_half_pitch);
void gearmesh_modelica_free(void *object);

/* radii: [2] base radii of pinion and wheel (m). */
void gearmesh_modelica_base_radii(void *object, double *radii, size_t size);

/* state: [4] angles of pinion and wheel, their speeds. result: [3] torque taken from the pinion, torque given to the wheel
 * (N m), force (N). */
void gearmesh_modelica_evaluate(void *object, const double *state, size_t state_size,
                                double *result, size_t result_size);

/* The change of that result while the state changes at a rate. */
void gearmesh_modelica_evaluate_der(void *object, const double *state, size_t state_size,
                                    const double *state_rate, size_t rate_size, double *result_rate,
                                    size_t result_size);

/* Each body: [18] gm_body; loads: [12] force and moment on the pinion, then on the wheel, in the common frame. */
void gearmesh_modelica_loads(void *object, const double *pinion, size_t pinion_size,
                             const double *wheel, size_t wheel_size, double *loads,
                             size_t loads_size);

/* x in equilibrium with a torque on the wheel (m); the transmission error is -x. */
double gearmesh_modelica_static_offset(void *object, double pinion_angle, double wheel_torque);

#endif
