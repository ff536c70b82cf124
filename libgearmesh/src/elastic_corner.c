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
#include "elastic_mesh.h"

#include "internal.h"
#include "surface.h"

#include <math.h>

/* Lines go on for this part of the base pitch at most, and corners are followed so far. */
#define FARTHEST 0.5

/* Nor further than where this part of the roll goes into the gap, so that an edge always presses its own gear back. Usual
 * gears stay below 0.2. */
#define LARGEST_SLOPE 0.5

/* So much more gap than needed, as flanks may have a little more material where they fade. */
#define MARGIN 1.1

/* e^-x, 0 <= x < 50, to 1e-14: of a small part, squared. */
static double fall_of(double x) {
    const double y = x / 256.0;
    double sum = 1.0;
    for (int k = 10; k >= 1; --k) {
        sum = 1.0 - y / (double)k * sum;
    }
    for (int k = 0; k < 8; ++k) {
        sum *= sum;
    }
    return sum;
}

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
        tip->farthest = fmin(FARTHEST * pair->transverse_base_pitch, tip->corner.reach);
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

/* The gap after a roll; where nothing reaches any more it goes on straight. */
static gmi_elastic_gap gap_after(const gmi_elastic_tip *tip, double roll) {
    gmi_corner_place place;
    gmi_corner_at(&tip->corner, fmin(roll, tip->farthest), &place);
    const double more = roll - tip->farthest;
    const gmi_elastic_gap gap = {place.gap + fmax(more, 0.0) * place.by_roll, place.by_roll,
                                 more > 0.0 ? 0.0 : place.by_roll_twice};
    return gap;
}

gmi_elastic_edge gmi_elastic_edge_at(const gmi_elastic_tips *tips, double approach, double begin,
                                     double end, double roll, double beyond) {
    gmi_elastic_edge edge = {{0.0, 0.0, 0.0}, 0, 1.0, 0.0};
    if (roll > 0.5 * (begin + end)) {
        if (beyond > 0.0) {
            edge.gap = gap_after(&tips->tip[GM_PINION], beyond);
        }
    } else if (begin + approach - (roll + beyond) > 0.0) {
        edge.gap = gap_after(&tips->tip[GM_WHEEL], begin + approach - (roll + beyond));
        edge.enters = 1;
    }

    /* The edge in place of its flank. */
    if (beyond != 0.0) {
        const gmi_elastic_tip *tip = &tips->tip[beyond < 0.0 ? GM_WHEEL : GM_PINION];
        const double t = fabs(beyond) / tip->fading;
        edge.rate_factor = tip->blunt;
        if (t < 1.0) {
            const double direction = beyond < 0.0 ? 1.0 : -1.0;
            edge.rate_factor = fall_of(tip->logarithm * t * t * (3.0 - 2.0 * t));
            edge.rate_by_roll = direction * tip->logarithm * 6.0 * t * (1.0 - t) / tip->fading;
        }
    }
    return edge;
}

/* Whether the curvature of the gap alone leaves no contact; rho_p on the line. */
static int is_clear(const gmi_elastic_tips *tips, const gmi_elastic_lines_at *at, double approach,
                    double needed, double on_line) {
    const double leaving = on_line - at->upper, entering = at->lower + approach - on_line;
    const gmi_elastic_tip *tip = &tips->tip[leaving > 0.0 ? GM_PINION : GM_WHEEL];
    const double roll = leaving > 0.0 ? leaving : entering;
    return 0.5 * tip->curvature * roll * roll > MARGIN * needed;
}

int gmi_elastic_edges_add(const gmi_elastic_tips *tips, double approach, double peak,
                          gmi_elastic_work *work) {
    const gmi_elastic_lines_at *at = &work->at;
    int entering = 0;
    for (int p = 0; p < 2 * work->slots; ++p) {
        work->entry_slope[p] = work->entry_curvature[p] = 0.0;
        if (work->beyond[p] == 0.0 && !(work->roll[p] < at->lower + approach)) {
            continue;
        }

        /* Where nothing reaches it is enough to say so: tilted axes may leave the peak below 0, and x with it above. */
        if (is_clear(tips, at, approach, approach + peak, work->roll[p] + work->beyond[p])) {
            work->deviation[p] = -2.0 * (fabs(approach) + fabs(peak));
            continue;
        }
        const gmi_elastic_edge edge = gmi_elastic_edge_at(tips, approach, at->lower, at->upper,
                                                          work->roll[p], work->beyond[p]);
        work->deviation[p] -= edge.gap.value;
        work->deviation_by_roll[p] += edge.enters ? edge.gap.by_roll : -edge.gap.by_roll;
        work->rate[p] *= edge.rate_factor;
        work->rate_by_roll[p] += edge.rate_by_roll;
        if (edge.enters) {
            work->entry_slope[p] = edge.gap.by_roll;
            work->entry_curvature[p] = edge.gap.by_roll_twice;
            entering = 1;
        }
    }
    return entering;
}
