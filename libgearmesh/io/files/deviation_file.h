/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file deviation_file.h
 * What the builder of flanks needs of deviations that may come from a file or from a user's program.
 */
#ifndef GEARMESH_DEVIATION_FILE_H
#define GEARMESH_DEVIATION_FILE_H

#include "gearmesh/gearmesh_io.h"

/**
 * Checks deviations and finds the set of every slot.
 *
 * @param[out] set_of_slot  [gmi_slot_count(teeth)] index of the set, -1 = none; free it with free().
 *                          NULL on an error
 */
int gmi_deviations_index(const gm_deviations *deviations, int **set_of_slot, gm_io_error *error);

#endif /* GEARMESH_DEVIATION_FILE_H */
