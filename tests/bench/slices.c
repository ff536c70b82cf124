/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "slices.h"

#include <math.h>

enum { NODE_DOUBLES = 4 }; /* of gm_flank_tables.values */

/* What all slices share. */
typedef struct slicing {
    const gm_flank_tables *pinion, *wheel;
    double delta;
    double lower, upper; /* rho_p of the path of contact */
    double pinion_start, wheel_reach;
    double pinion_scale, wheel_scale; /* v2 per rho */
} slicing;

static double look_up(const gm_flank_tables *tables, int tooth, double t1, double v2) {
    const double v1 = t1 * (tables->face_nodes - 1);
    int face = (int)v1, profile = (int)v2;
    face = face < tables->face_nodes - 2 ? face : tables->face_nodes - 2;
    profile = profile < tables->profile_nodes - 2 ? profile : tables->profile_nodes - 2;
    const double p = v1 - face, q = v2 - profile;
    const int row = tables->profile_nodes * NODE_DOUBLES;
    const double *node = tables->values +
                         (size_t)tables->table[tooth] * (size_t)tables->face_nodes * (size_t)row +
                         face * row + profile * NODE_DOUBLES;
    const double here = node[0] + q * (node[NODE_DOUBLES] - node[0]);
    const double next = node[row] + q * (node[row + NODE_DOUBLES] - node[row]);
    return here + p * (next - here) + tables->pitch[tooth];
}

static double pair_penetration(const slicing *s, int pinion_tooth, int wheel_tooth, double t1,
                               double rho) {
    const double f =
        s->delta + look_up(s->pinion, pinion_tooth, t1, (rho - s->pinion_start) * s->pinion_scale) +
        look_up(s->wheel, wheel_tooth, t1, (s->wheel_reach - rho) * s->wheel_scale);
    return f > 0.0 ? f : 0.0;
}

static int wrap(int tooth, int teeth) {
    return tooth < 0 ? tooth + teeth : tooth >= teeth ? tooth - teeth : tooth;
}

double slices_sum(const gm_pair *pair, const gm_flanks *pinion, const gm_flanks *wheel,
                  const gm_position *position, int slices, enum slice_pairs pairs) {
    slicing s = {&pinion->drive,
                 &wheel->drive,
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
    double sum = 0.0;
    for (int slice = 0; slice < slices; ++slice) {
        const double t1 = (slice + 0.5) / slices;
        const double origin = pair->phase_origin + position->phase + pair->twist * t1;
        int first = -pair->pinion.teeth / 2;
        int last = first + pair->pinion.teeth - 1;
        if (pairs == SLICES_TOUCHING) {
            first = (int)floor((s.lower - origin) * per_pitch) + 1;
            last = (int)floor((s.upper - origin) * per_pitch);
        }
        for (int k = first; k <= last; ++k) {
            const double rho = origin + k * pitch;
            if (rho < s.lower || rho > s.upper)
                continue;
            sum += pair_penetration(&s, wrap(position->pinion_tooth + k, pair->pinion.teeth),
                                    wrap(position->wheel_tooth + k, pair->wheel.teeth), t1, rho);
        }
    }
    return sum / slices;
}
