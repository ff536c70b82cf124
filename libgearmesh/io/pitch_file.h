/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file pitch_file.h
 * What the builder of flanks needs of pitch deviations that may come from a file or a user's program.
 */
#ifndef GEARMESH_PITCH_FILE_H
#define GEARMESH_PITCH_FILE_H

#include "gearmesh/gearmesh_io.h"

/** Checks numbers of teeth, arrays and values. */
int gmi_pitch_check(const gm_pitch *pitch, gm_io_error *error);

#endif /* GEARMESH_PITCH_FILE_H */
