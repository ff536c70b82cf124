/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Where force and its derivatives are not smooth, as functions that are: roots for a solver that looks for them. Lines of
 * contact are p_bt apart, so that one of them begins or ends wherever the way of the lines past a limit is a whole number
 * of base pitches. Whole turns are not known, so that what tells it has the period of a base pitch: a sine, whose other
 * zeros go the other way.
 */
#include "contact.h"
#include "corner.h"
#include "internal.h"
#include "mesh.h"
#include "meshing.h"

#include <math.h>

/* The ends of the path on which lines touch: of elastic teeth that without load, with corners where their gap is closed. */
static void find_lines(const gm_mesh *mesh, int side, const gm_position *position,
                       gmi_lines *lines) {
    const gmi_engagement *at = &mesh->engagement;
    gm_position there = *position;
    if (mesh->elastic != NULL) {
        there.offset = gmi_side_sign(side) * 0.5 * at->backlash;
    }
    gmi_lines_find(mesh->pair, at, side, &there, lines);
    if (mesh->has_corners) {
        const double overlap = lines->delta + mesh->side[side].peak;
        lines->lower = at->line_of_action + lines->delta - at->tip_roll_length[GM_WHEEL] -
                       gmi_corner_touch(&mesh->corners[GM_WHEEL], overlap);
        lines->upper =
            at->tip_roll_length[GM_PINION] + gmi_corner_touch(&mesh->corners[GM_PINION], overlap);
    }
}

int gm_mesh_event_indicators(const gm_mesh *mesh, const gm_motion *motion,
                             double indicators[GM_EVENTS]) {
    if (indicators == NULL) {
        return GM_ERR_NULL;
    }
    for (int k = 0; k < GM_EVENTS; ++k) {
        indicators[k] = gmi_nan();
    }
    if (mesh == NULL || motion == NULL) {
        return GM_ERR_NULL;
    }

    gm_mesh moved;
    gm_position position;
    gmi_rates rates[2];
    const int status = gmi_mesh_follow(mesh, motion, &moved, &position, rates);
    if (status != GM_OK) {
        return status;
    }

    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        const int first = side == GM_DRIVE ? GM_EVENT_DRIVE_CONTACT : GM_EVENT_COAST_CONTACT;
        indicators[first] =
            gmi_ideal_penetration(&moved.engagement, side, position.offset) + moved.side[side].peak;
        indicators[first + 1] = indicators[first + 2] = 1.0; /* the simple model has no lines */
        if (moved.model != GM_MODEL_SIMPLE) {
            gmi_lines lines;
            find_lines(&moved, side, &position, &lines);
            const double per_pitch = GMI_TWO_PI / mesh->pair->transverse_base_pitch;
            indicators[first + 1] = sin((lines.origin + lines.rise - lines.lower) * per_pitch);
            indicators[first + 2] = sin((lines.origin + lines.fall - lines.upper) * per_pitch);
        }
    }
    return GM_OK;
}
