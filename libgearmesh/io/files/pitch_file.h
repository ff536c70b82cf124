/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file pitch_file.h
 * What others need of pitch deviations that may come from a file or a user's program.
 */
#ifndef GEARMESH_PITCH_FILE_H
#define GEARMESH_PITCH_FILE_H

#include "gearmesh/gearmesh_io.h"

/** Allocates the arrays, all zero; on an error nothing is left. */
int gmi_pitch_allocate(gm_pitch *pitch, int teeth, gm_io_error *error);

/** Checks numbers of teeth, arrays and values. */
int gmi_pitch_check(const gm_pitch *pitch, gm_io_error *error);

#endif /* GEARMESH_PITCH_FILE_H */
