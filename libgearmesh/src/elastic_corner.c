/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Elastic teeth before and after the path of contact, where a tip edge touches the mate's flank.
 *
 * Where a line has come to rho_p beyond the path, its approach is smaller by the gap of the corner after the roll of the
 * gear whose tip it is. That is rho_p - rho_ap of the pinion where a pair leaves. Where it enters, the wheel has rolled to
 * rho_w = T + x - rho_p, of which T - rho_w,a is the begin of the path: so the gap depends on x, and the wheel's corner has
 * a shorter arm. With g = gap' there,
 *
 *     gamma = x + w - gap - s phi - psi,     F = dU/dx = sum W q (1 - g).
 *
 * Teeth, flanks and their slopes end at the tip; they fade into what they are there on the length of profile that the
 * rounding of the edge takes. On it the curvature, and with it ln of the contact law's rate, goes over from that of both
 * flanks to that of flank and edge, as 3 t^2 - 2 t^3. So nothing jumps, nor does its derivative.
 */
#include "corner.h"
#include "elastic.h"
#include "elastic_mesh.h"
#include "internal.h"
#include "meshing.h"
#include "wide.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

/* Lines go on for this part of the base pitch at most, and corners are followed so far. */
#define FARTHEST_ROLL 0.5

/* Nor further than where this part of the roll goes into the gap, so that an edge always presses its own gear back. Usual
 * gears stay below 0.2. */
#define LARGEST_SLOPE 0.5

/* So much more gap than needed, as flanks may have a little more material where they fade. */
#define MARGIN 1.1

/* e^-x, 0 <= x < 50, to 1e-14: of a small part, squared. */
static inline double fall_of(double x) {
    const double y = x / 256.0;
    double sum = 1.0 - (1.0 / 8.0) * y * (1.0 - (1.0 / 9.0) * y * (1.0 - (1.0 / 10.0) * y));
    sum = 1.0 - (1.0 / 5.0) * y * (1.0 - (1.0 / 6.0) * y * (1.0 - (1.0 / 7.0) * y * sum));
    sum = 1.0 - 0.5 * y * (1.0 - (1.0 / 3.0) * y * (1.0 - (1.0 / 4.0) * y * sum));
    sum = 1.0 - y * sum;
    const double square = sum * sum, of_4 = square * square, of_8 = of_4 * of_4;
    const double of_16 = of_8 * of_8, of_32 = of_16 * of_16, of_64 = of_32 * of_32;
    const double of_128 = of_64 * of_64;
    return of_128 * of_128;
}

/* Prepared once. */
#ifndef GMI_IN_WIDE
int gmi_elastic_tips_init(const gm_pair *pair, const gmi_engagement *at, double tip_rounding,
                          gmi_elastic_tips *tips) {
    const double base[2] = {pair->pinion.base_radius, at->wheel_base_radius};
    const double rounding = tip_rounding * pair->normal_module * cos(pair->base_helix_angle);
    int good = 1;
    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        gmi_elastic_tip *tip = &tips->tip[role];
        good = gmi_corner_init(pair, at, role, &tip->corner) && good;

        /* Both flanks at the end of the path, and flank and edge. */
        const double tip_roll = tip->corner.tip_roll, mate_roll = tip->corner.mate_roll;
        tip->fading = rounding * base[role] / tip_roll;
        tip->logarithm =
            log((1.0 / mate_roll + 1.0 / rounding) / (1.0 / mate_roll + 1.0 / tip_roll));
        tip->blunt = fall_of(tip->logarithm);

        /* The gap is more than its curvature there says. */
        gmi_corner_place place;
        gmi_corner_at(&tip->corner, 0.0, &place);
        tip->curvature = place.by_roll_twice;
        tip->farthest = fmin(FARTHEST_ROLL * pair->transverse_base_pitch, tip->corner.reach);
        gmi_corner_at(&tip->corner, tip->farthest, &place);
        for (int k = 0; k < 30 && !(place.by_roll <= LARGEST_SLOPE); ++k) {
            tip->farthest *= 0.5;
            gmi_corner_at(&tip->corner, tip->farthest, &place);
        }
        good = good && tip->logarithm > 0.0 && tip->curvature > 0.0;
    }
    return good;
}

/* Roll after which a corner leaves a gap of at least that (m). */
static double roll_of_gap(const gmi_elastic_tip *tip, double gap) {
    const double roll = gap > 0.0 ? sqrt(2.0 * MARGIN * gap / tip->curvature) : 0.0;
    return fmin(roll, tip->farthest);
}

double gmi_elastic_tips_below(const gmi_elastic_tips *tips, double approach, double peak) {
    return fmax(0.0, roll_of_gap(&tips->tip[GM_WHEEL], approach + peak) - approach);
}

double gmi_elastic_tips_above(const gmi_elastic_tips *tips, double approach, double peak) {
    return roll_of_gap(&tips->tip[GM_PINION], approach + peak);
}
#endif

/* Edges of one gear at many points: arrays over them. */
typedef struct edge_arrays {
    double *after;                      /* roll of that gear since its path ended (m) */
    double *outside;                    /* how far the point is beyond the path along rho_p (m) */
    double *gap, *slope, *curvature;    /* by the roll */
    double *rate_factor, *rate_by_roll; /* as gmi_elastic_edge */
} edge_arrays;

/* Rolls on which a gap is followed. */
APART void keep_rolls(int count, double farthest, const double *restrict after,
                      double *restrict kept) {
    for (int k = 0; k < count; ++k) {
        const double roll = after[k] > 0.0 ? after[k] : 0.0;
        kept[k] = roll < farthest ? roll : farthest;
    }
}

/* Where nothing reaches any more the gap goes on straight. */
static void lengthen_gaps(int count, double farthest, const edge_arrays *at) {
    for (int k = 0; k < count; ++k) {
        const double more = at->after[k] - farthest;
        if (more > 0.0) {
            at->gap[k] += more * at->slope[k];
            at->curvature[k] = 0.0;
        }
    }
}

/* How far the points are on the way from the flank to the edge: 0 .. 1. */
APART void find_parts(int count, double per_fading, const double *restrict outside,
                      double *restrict part) {
    for (int k = 0; k < count; ++k) {
        const double t = fabs(outside[k]) * per_fading;
        part[k] = t < 1.0 ? t : 1.0;
    }
}

/* The edge in place of its flank. rise: of the logarithm along rho_p. */
APART void blunt_edges(int count, double logarithm, double rise, double *restrict part,
                       double *restrict rate_factor) {
    for (int k = 0; k < count; ++k) {
        const double t = part[k];
        rate_factor[k] = fall_of(logarithm * (t * t * (3.0 - 2.0 * t)));
        part[k] = rise * (t * (1.0 - t));
    }
}

/* From after and outside, the rest. role: enum gm_role of the gear whose edges these are. */
static void find_edges(const gmi_elastic_tips *tips, int role, int count, const edge_arrays *at) {
    const gmi_elastic_tip *tip = &tips->tip[role];
    double *kept = at->rate_factor; /* not yet found */
    keep_rolls(count, tip->farthest, at->after, kept);
    gmi_corner_gaps(&tip->corner, count, kept, at->gap, at->slope, at->curvature);
    lengthen_gaps(count, tip->farthest, at);

    /* rho_p goes back to the path of the wheel's edges, and away from it under the pinion's. */
    const double per_fading = role == GM_WHEEL ? 1.0 / tip->fading : -1.0 / tip->fading;
    find_parts(count, fabs(per_fading), at->outside, at->rate_by_roll);
    blunt_edges(count, tip->logarithm, 6.0 * tip->logarithm * per_fading, at->rate_by_roll,
                at->rate_factor);
}

/* One at a time is no work for vectors. */
#ifndef GMI_IN_WIDE
gmi_elastic_edge gmi_elastic_edge_at(const gmi_elastic_tips *tips, double approach, double begin,
                                     double end, double roll, double beyond) {
    const int leaves = roll > 0.5 * (begin + end);
    double after = leaves ? beyond : begin + approach - (roll + beyond), outside = beyond;
    gmi_elastic_edge edge = {{0.0, 0.0, 0.0}, !leaves && after > 0.0, 1.0, 0.0};
    const edge_arrays at = {&after,
                            &outside,
                            &edge.gap.value,
                            &edge.gap.by_roll,
                            &edge.gap.by_roll_twice,
                            &edge.rate_factor,
                            &edge.rate_by_roll};
    find_edges(tips, leaves ? GM_PINION : GM_WHEEL, 1, &at);
    if (!(after > 0.0)) {
        edge.gap.by_roll_twice = 0.0;
    }
    return edge;
}
#endif

/*
 * Of the points of a list those that an edge may touch: into `chosen`, with how far they are. The gap is at least what its
 * curvature at the end of the path makes of it; where that is more than x and the material there, nothing touches.
 */
static int choose(const gmi_elastic_tips *tips, int role, double approach, double none,
                  const int *list, int count, gmi_elastic_work *work, const edge_arrays *at) {
    const double least = 0.5 * tips->tip[role].curvature / MARGIN;
    const double entry = work->at.lower + approach;
    int chosen = 0;
    for (int k = 0; k < count; ++k) {
        const int p = list[k];
        const double beyond = work->beyond[p];
        const double roll = role == GM_PINION ? beyond : entry - (work->roll[p] + beyond);
        if (least * roll * roll > approach + work->deviation[p]) {
            work->deviation[p] = none;
            continue;
        }
        at->after[chosen] = roll;
        at->outside[chosen] = beyond;
        work->chosen[chosen++] = p;
    }
    return chosen;
}

APART int is_any_below(int count, double limit, const double *roll) {
    int64_t any = 0;
    for (int p = 0; p < count; ++p) {
        any |= roll[p] < limit;
    }
    return any != 0;
}

/* Points within the path that the wheel's edge reaches as x grows: behind those outside. Returns how many there are now. */
static int add_within(double entry, gmi_elastic_work *work) {
    int count = work->outer_count[0];
    const int all = is_any_below(2 * work->slots, entry, work->roll) ? 2 * work->slots : 0;
    for (int p = 0; p < all; ++p) {
        if (work->beyond[p] == 0.0 && work->roll[p] < entry) {
            work->outer[0][count++] = p;
        }
    }
    return count;
}

/* The edges of one gear, at the points of a list. Returns whether its roll contains x, as that of the wheel does. */
static int add_edges(const gmi_elastic_tips *tips, int role, int count, const int *list,
                     const edge_arrays *at, gmi_elastic_work *work) {
    const double sign = role == GM_WHEEL ? 1.0 : -1.0;
    int entering = 0, wanted = count;
#ifdef GMI_IN_WIDE
    /* Fours of points, the last one over and over. */
    for (; count > 0 && wanted % 4 != 0 && wanted < 2 * work->slots; ++wanted) {
        at->after[wanted] = at->after[count - 1];
        at->outside[wanted] = at->outside[count - 1];
    }
#endif
    find_edges(tips, role, wanted, at);

    /* Each gap, and what follows from it, goes to its point. */
    for (int k = 0; k < count; ++k) {
        const int p = list[k];
        work->deviation[p] -= at->gap[k];
        work->deviation_by_roll[p] += sign * at->slope[k];
        work->rate[p] *= at->rate_factor[k];
        work->rate_by_roll[p] += at->rate_by_roll[k];
        if (role == GM_WHEEL && at->after[k] > 0.0) {
            work->entry_slope[p] = at->slope[k];
            work->entry_curvature[p] = at->curvature[k];
            entering = 1;
        }
    }
    return entering;
}

int gmi_elastic_edges_add(const gmi_elastic *law, const gmi_elastic_tips *tips, double approach,
                          double peak, gmi_elastic_work *work) {
    GMI_RETURN_WIDE(law, gmi_wide_edges_add(law, tips, approach, peak, work))
    (void)law;
    const int points = 2 * work->slots;
    const size_t bytes = sizeof(double) * (size_t)points;
    memset(work->entry_slope, 0, bytes);
    memset(work->entry_curvature, 0, bytes);

    /* In what is free now. Tilted axes may leave the peak below 0, and x with it above. */
    const edge_arrays at = {
        work->table[0], work->table[0] + points, work->table[1], work->table[1] + points,
        work->table[2], work->table[2] + points, work->table[3]};
    const double none = -2.0 * (fabs(approach) + fabs(peak));
    work->outer_count[0] = add_within(work->at.lower + approach, work);
    int entering = 0;
    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        const int which = role == GM_PINION;
        const int count = choose(tips, role, approach, none, work->outer[which],
                                 work->outer_count[which], work, &at);
        entering = add_edges(tips, role, count, work->chosen, &at, work) || entering;
    }
    return entering;
}
