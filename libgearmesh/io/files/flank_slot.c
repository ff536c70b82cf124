/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Which flank of which tooth a row or a set of rows is for, and which of several wins. */

#include "flank_slot.h"

#include <stdio.h>

#include "io_error.h"
#include "shared.h"

/* *, drive, coast */
#define SIDES 3

int gmi_slot_count(int teeth) {
    return SIDES * (teeth + 1);
}

int gmi_slot(int tooth, int side) {
    return SIDES * (tooth + 1) + (side + 1);
}

int gmi_slot_candidate(int tooth, int side, int k) {
    const int tooth_or_all = k < 2 ? tooth : GMI_ALL;
    const int side_or_all = k % 2 == 0 ? side : GMI_ALL;
    return gmi_slot(tooth_or_all, side_or_all);
}

int gmi_slot_tooth(int slot) {
    return slot / SIDES - 1;
}

int gmi_slot_side(int slot) {
    return slot % SIDES - 1;
}

const char *gmi_side_name(int side) {
    return side == GM_DRIVE ? "drive" : side == GM_COAST ? "coast" : "*";
}

const char *gmi_tooth_name(char name[GMI_SLOT_NAME_SIZE], int tooth) {
    if (tooth == GMI_ALL) {
        snprintf(name, GMI_SLOT_NAME_SIZE, "*");
    } else {
        snprintf(name, GMI_SLOT_NAME_SIZE, "%d", tooth);
    }
    return name;
}

const char *gmi_slot_name(char name[GMI_SLOT_NAME_SIZE], int slot) {
    char tooth[GMI_SLOT_NAME_SIZE];
    snprintf(name, GMI_SLOT_NAME_SIZE, "tooth %.11s, flank %s",
             gmi_tooth_name(tooth, gmi_slot_tooth(slot)), gmi_side_name(gmi_slot_side(slot)));
    return name;
}

int gmi_check_teeth(int teeth, gm_io_error *error) {
    if (teeth >= GMI_SMALLEST_TEETH && teeth <= GMI_LARGEST_TEETH) {
        return GM_IO_OK;
    }
    return gmi_error_set(error, GM_IO_ERR_OPTION, 0, "teeth: must be from %d to %d (got %d)",
                         GMI_SMALLEST_TEETH, GMI_LARGEST_TEETH, teeth);
}

int gmi_check_same_teeth(int teeth, int got, const char *what, gm_io_error *error) {
    return got == teeth
               ? GM_IO_OK
               : gmi_error_set(error, GM_IO_ERR_OPTION, 0,
                               "the %s deviations must be for the %d teeth of the gear (got %d)",
                               what, teeth, got);
}
