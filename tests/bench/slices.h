/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file slices.h
 * The usual way, for comparison: the face cut into slices, the penetration looked up in the middle of each. Only
 * here, never in the library.
 */
#ifndef SLICES_H
#define SLICES_H

#include "gearmesh/gearmesh.h"

/** Which tooth pairs each slice asks. */
enum slice_pairs {
    SLICES_ALL_TEETH, /**< every tooth of the pinion, as [Paper, Eq. 24] is written */
    SLICES_TOUCHING   /**< those between the ends of the path of contact */
};

/** Sum over the drive flanks (m). Both gears have tables of the same size for all teeth. */
double slices_sum(const gm_pair *pair, const gm_flanks *pinion, const gm_flanks *wheel,
                  const gm_position *position, int slices, enum slice_pairs pairs);

#endif /* SLICES_H */
