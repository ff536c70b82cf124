/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file waves.h
 * Waves that go on from tooth to tooth, on all flanks of a gear.
 */
#ifndef GEARMESH_WAVES_H
#define GEARMESH_WAVES_H

#include "generator.h"

/** Checks order, amplitude and resolution of every wave that is asked for. */
int gmi_waves_check(const gmi_generator *make);

/** Draws the phase of every wave on either side, from a stream of its own, so that a wave leaves all else as it is. */
void gmi_waves_draw(const gmi_generator *make);

/** Sum of all waves at the nodes of a set, along the normal; replaces what is there. */
void gmi_waves_fill(const gmi_generator *make, const gm_deviation_set *set);

#endif /* GEARMESH_WAVES_H */
