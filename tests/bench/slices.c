/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "slices.h"

#include "flank.h" /* the nodes where the core keeps them: the same data for both */

#include <math.h>

enum { NODE_DOUBLES = GMI_NODE_DOUBLES };

/* What all slices share. */
typedef struct slicing {
    const gmi_tables *pinion, *wheel;
    double delta;
    double lower, upper; /* rho_p of the path of contact */
    double pinion_start, wheel_reach;
    double pinion_scale, wheel_scale; /* v2 per rho */
} slicing;

/* Where a slice lies in tables whose face lines are the same. */
typedef struct face_place {
    int face;
    double p;
} face_place;

static double look_up(const gmi_tables *tables, int tooth, face_place place, double v2) {
    int profile = (int)v2;
    profile = profile < tables->profile_nodes - 2 ? profile : tables->profile_nodes - 2;
    const double q = v2 - profile;
    const int row = tables->profile_nodes * NODE_DOUBLES;
    const int rows = tables->table[tooth] * tables->face_nodes + place.face;
    const double *node = tables->values + (ptrdiff_t)rows * row + profile * NODE_DOUBLES;
    const double here = node[0] + q * (node[NODE_DOUBLES] - node[0]);
    const double next = node[row] + q * (node[row + NODE_DOUBLES] - node[row]);
    return here + place.p * (next - here) + tables->pitch[tooth];
}

static double pair_penetration(const slicing *s, int pinion_tooth, int wheel_tooth,
                               face_place place, double rho) {
    const double f =
        s->delta +
        look_up(s->pinion, pinion_tooth, place, (rho - s->pinion_start) * s->pinion_scale) +
        look_up(s->wheel, wheel_tooth, place, (s->wheel_reach - rho) * s->wheel_scale);
    return f > 0.0 ? f : 0.0;
}

/* Largest whole number <= value. */
static int floor_of(double value) {
    const int truncated = (int)value;
    return truncated - (value < truncated);
}

static int wrap(int tooth, int teeth) {
    return tooth < 0 ? tooth + teeth : tooth >= teeth ? tooth - teeth : tooth;
}

double slices_sum(const gm_pair *pair, const gm_flanks *pinion, const gm_flanks *wheel,
                  const gm_position *position, int slices, enum slice_pairs pairs) {
    slicing s = {gmi_flanks_side(pinion, GM_DRIVE),
                 gmi_flanks_side(wheel, GM_DRIVE),
                 position->offset - 0.5 * pair->backlash,
                 0.0,
                 0.0,
                 0.0,
                 0.0,
                 0.0,
                 0.0};
    const double reach = pair->line_of_action + s.delta;
    s.lower = fmax(pair->pinion.start_roll_length, reach - pair->wheel.tip_roll_length);
    s.upper = fmin(pair->pinion.tip_roll_length, reach - pair->wheel.start_roll_length);
    s.pinion_start = pair->pinion.start_roll_length;
    s.wheel_reach = reach - pair->wheel.start_roll_length;
    s.pinion_scale = (s.pinion->profile_nodes - 1) /
                     (pair->pinion.tip_roll_length - pair->pinion.start_roll_length);
    s.wheel_scale = (s.wheel->profile_nodes - 1) /
                    (pair->wheel.tip_roll_length - pair->wheel.start_roll_length);

    const double pitch = pair->transverse_base_pitch;
    const double per_pitch = 1.0 / pitch;
    const double per_slices = 1.0 / slices;
    double sum = 0.0;
    for (int slice = 0; slice < slices; ++slice) {
        const double t1 = (slice + 0.5) * per_slices;
        const double v1 = t1 * (s.pinion->face_nodes - 1);
        const face_place place = {(int)v1, v1 - (int)v1};
        const double origin =
            pair->phase_origin[GM_DRIVE] + position->phase + pair->face_advance * t1;
        int first = -pair->pinion.teeth / 2;
        int last = first + pair->pinion.teeth - 1;
        if (pairs == SLICES_TOUCHING) {
            first = floor_of((s.lower - origin) * per_pitch) + 1;
            last = floor_of((s.upper - origin) * per_pitch);
        }
        for (int k = first; k <= last; ++k) {
            const double rho = origin + k * pitch;
            if (rho < s.lower || rho > s.upper) {
                continue;
            }
            sum += pair_penetration(&s, wrap(position->pinion_tooth + k, pair->pinion.teeth),
                                    wrap(position->wheel_tooth + k, pair->wheel.teeth), place, rho);
        }
    }
    return sum * per_slices;
}
