/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file flank_slot.h
 * One number for what stands in the first two columns of a flank file: a tooth or `*`, a flank or `*`.
 *
 * Slots run from 0 to gmi_slot_count() - 1, `*`,`*` first, then tooth by tooth.
 */
#ifndef GEARMESH_FLANK_SLOT_H
#define GEARMESH_FLANK_SLOT_H

#include "gearmesh/gearmesh_io.h"

/** A tooth or flank that is `*`. */
#define GMI_ALL (-1)

/** How many slots can serve one flank of one tooth. */
#define GMI_CANDIDATES 4

/** Room for the name of a slot. */
#define GMI_SLOT_NAME_SIZE 48

int gmi_slot_count(int teeth);

/** Slot of tooth GMI_ALL .. teeth - 1 and side GMI_ALL, GM_DRIVE, GM_COAST. */
int gmi_slot(int tooth, int side);

/** Slots that can serve a flank, k = 0 .. GMI_CANDIDATES - 1, the more special one first. */
int gmi_slot_candidate(int tooth, int side, int k);

int gmi_slot_tooth(int slot);
int gmi_slot_side(int slot);

/** `drive`, `coast` or `*`. */
const char *gmi_side_name(int side);

/** The tooth as it stands in a file: a number or `*`. Returns name. */
const char *gmi_tooth_name(char name[GMI_SLOT_NAME_SIZE], int tooth);

/** `tooth 3, flank drive`, for messages. Returns name. */
const char *gmi_slot_name(char name[GMI_SLOT_NAME_SIZE], int slot);

/** Checks a number of teeth handed in by the caller. */
int gmi_check_teeth(int teeth, gm_io_error *error);

/** Checks that deviations, `flank` or `pitch`, are for as many teeth as the gear has. */
int gmi_check_same_teeth(int teeth, int got, const char *what, gm_io_error *error);

#endif /* GEARMESH_FLANK_SLOT_H */
