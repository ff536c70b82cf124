/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * [modifications]: from its keys to the designed modifications of each flank. A key with a flank replaces the one
 * without there, key by key; the three ways to give a range count as one key.
 */
#ifndef APPS_MODIFICATION_KEYS_H
#define APPS_MODIFICATION_KEYS_H

#include "config.h"

/* The designs of one gear; the lists are its own, so it must not move while `of` is in use. */
typedef struct gear_design {
    gm_modification list[2][GM_MODIFICATION_KINDS];
    gm_modifications of[2]; /* GM_DRIVE, GM_COAST; count 0 = none */
} gear_design;

/* Places of keys in config.modifications[gear]: both flanks, drive, coast. */
enum { MODIFICATION_PLACES = 3, MODIFICATION_KEY_SIZE = 80 };

/* "modifications.pinion_drive_tip_relief_um" */
const char *modification_key_name(char name[MODIFICATION_KEY_SIZE], enum gm_role gear, int place,
                                  int kind, int field);

/* Marks all keys as not given, those included that a modification does not have. */
void modification_keys_clear(config *config);

/* Ranges that are missing or given twice. Returns the number of faults, each told. */
int modification_keys_check(const config *config);

/* Warns of keys that change nothing. */
void modification_keys_warn(const config *config);

/* The designs of a gear (0 = pinion, 1 = wheel), checked against its flanks. Returns 0 or EXIT_BAD_INPUT after a
 * message. */
int gear_design_make(gear_design *design, const config *config, const gm_pair *pair,
                     enum gm_role gear);

#endif
