/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The penetration models: simple [Paper, Eqs. 9-11] and 3D [Paper, Eqs. 12-25].
 *
 * 3D: the sum over all lines of the integral of max(0, delta + deviations) over t1. Between ideal flanks that is delta
 * times the clipped length; with tables line.c integrates along each line, ramp.c where there are linear reliefs. No
 * slices, no quadrature error.
 */
#include "internal.h"

#include <math.h>

/* Not inlined: a side that is clear then costs no stack frame. */
#if defined(__GNUC__)
#define SEPARATE static __attribute__((noinline))
#else
#define SEPARATE static
#endif

static const gmi_side_sum no_contact = {0.0, 0.0, 0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};

/* One side at one position: everything its lines have in common. */
typedef struct side_view {
    gmi_lines lines;
    const gm_flank_tables *pinion_tables; /* NULL = ideal */
    const gm_flank_tables *wheel_tables;
    gmi_grid pinion_grid;
    gmi_grid wheel_grid;
    int ramps;          /* of both flanks */
    double wheel_reach; /* rho_w - start of the wheel's flank = wheel_reach - rho_p (m) */
} side_view;

static double flank_length(const gm_gear *gear) {
    return gear->tip_roll_length - gear->start_roll_length;
}

static void find_grids(const gm_pair *pair, side_view *view) {
    const double advance = view->lines.advance;
    gmi_grid_init(&view->pinion_grid, view->pinion_tables, advance, flank_length(&pair->pinion));
    gmi_grid_init(&view->wheel_grid, view->wheel_tables, -advance, flank_length(&pair->wheel));
    view->wheel_reach = pair->line_of_action + view->lines.delta - pair->wheel.start_roll_length;
}

/*
 * The ends of a line that a limit of the flanks sets move with the line's origin and with delta:
 *     t1_end = (limit - rho_origin) / advance,
 * and each takes f there into the sum or out of it (Leibniz).
 */
static inline void add_end_derivatives(const gmi_lines *lines, gmi_interval part, double f_from,
                                       double f_to, gmi_side_sum *side) {
    if (part.from > 0.0 && f_from > 0.0) {
        const double flow = f_from * lines->per_advance;
        side->by_origin += flow;
        side->by_delta -= flow * lines->enter_by_delta;
    }
    if (part.to < 1.0 && f_to > 0.0) {
        const double flow = f_to * lines->per_advance;
        side->by_origin -= flow;
        side->by_delta += flow * lines->leave_by_delta;
    }
}

static void add_moments(const gmi_lines *lines, double rho_origin, const gmi_line_sum *line,
                        gmi_side_sum *side) {
    side->sum_t1 += line->sum_t1;
    side->sum_rho += rho_origin * line->sum + lines->advance * line->sum_t1;
    side->contact_t1 += line->contact_t1;
    side->contact_rho += rho_origin * line->contact + lines->advance * line->contact_t1;
}

static double line_origin(const gm_pair *pair, const gmi_lines *lines, int k) {
    return lines->origin + (double)k * pair->transverse_base_pitch;
}

static void add_line(const gm_pair *pair, const side_view *view, const gmi_flank *pinion,
                     const gmi_flank *wheel, int k, int wanted, gmi_side_sum *side) {
    const gmi_interval part = gmi_line_clip(&view->lines, k);
    if (!(part.from < part.to)) {
        return;
    }
    const double rho_origin = line_origin(pair, &view->lines, k);
    const gmi_line line = {
        part.from,
        part.to,
        view->lines.delta + pinion->pitch + wheel->pitch,
        0.0,
        pinion->values,
        wheel->values,
        (rho_origin - pair->pinion.start_roll_length) * view->pinion_grid.per_rho,
        (view->wheel_reach - rho_origin) * view->wheel_grid.per_rho,
    };
    gmi_line_sum sum;
    if (view->ramps > 0) {
        gmi_ramps_integrate(&line, &view->pinion_grid, &view->wheel_grid, view->pinion_tables,
                            view->wheel_tables, wanted, &sum);
    } else {
        gmi_line_integrate(&line, &view->pinion_grid, &view->wheel_grid, wanted, &sum);
    }

    side->sum += sum.sum;
    side->contact += sum.contact;
    side->pairs += sum.contact > 0.0;
    if (wanted & GMI_DERIVATIVES) {
        /* Inside, f follows the line's origin and delta through both points looked up. */
        const double by_pinion = sum.pinion * view->pinion_grid.per_rho;
        const double by_wheel = sum.wheel * view->wheel_grid.per_rho;
        side->by_origin += by_pinion - by_wheel;
        side->by_delta += sum.contact + by_wheel;
        add_end_derivatives(&view->lines, part, sum.at_from, sum.at_to, side);
    }
    if (wanted & GMI_MOMENTS) {
        add_moments(&view->lines, rho_origin, &sum, side);
    }
}

static int next_tooth(int tooth, int step, int teeth) {
    const int next = tooth + step;
    return next < 0 ? teeth - 1 : next == teeth ? 0 : next;
}

static void sum_tables(const gm_pair *pair, side_view *view, gmi_teeth teeth, int wanted,
                       gmi_side_sum *side) {
    const gmi_lines *lines = &view->lines;
    for (int k = lines->first; k <= lines->last; ++k) {
        const gmi_flank pinion = gmi_flank_of(view->pinion_tables, teeth.pinion);
        const gmi_flank wheel = gmi_flank_of(view->wheel_tables, teeth.wheel);
        if (lines->delta + pinion.peak + wheel.peak > 0.0) {
            add_line(pair, view, &pinion, &wheel, k, wanted, side);
        }
        teeth.pinion = next_tooth(teeth.pinion, teeth.step, pair->pinion.teeth);
        teeth.wheel = next_tooth(teeth.wheel, teeth.step, pair->wheel.teeth);
    }
}

static int ramp_count(const gm_flank_tables *tables) {
    return tables == NULL ? 0 : tables->ramp_count;
}

SEPARATE void side_sum_tables(const gm_pair *pair, const gm_flank_tables *pinion,
                              const gm_flank_tables *wheel, int side, const gm_position *position,
                              int wanted, gmi_side_sum *total) {
    side_view view;
    view.pinion_tables = pinion;
    view.wheel_tables = wheel;
    view.ramps = ramp_count(pinion) + ramp_count(wheel);
    gmi_lines_find(pair, side, position, &view.lines);
    find_grids(pair, &view);
    sum_tables(pair, &view, gmi_lines_teeth(pair, side, position, &view.lines), wanted, total);
}

void gmi_side_sum_3d(const gm_pair *pair, const gm_flanks *pinion_flanks,
                     const gm_flanks *wheel_flanks, int side, const gm_position *position,
                     int wanted, gmi_side_sum *total) {
    const gm_flank_tables *pinion = gmi_flanks_side(pinion_flanks, side);
    const gm_flank_tables *wheel = gmi_flanks_side(wheel_flanks, side);
    *total = no_contact;

    /* Nothing reaches across the gap: the usual state of one of both sides. */
    double reach = gmi_ideal_penetration(pair, side, position->offset);
    if (pinion != NULL) {
        reach += pinion->peak;
    }
    if (wheel != NULL) {
        reach += wheel->peak;
    }
    if (reach <= 0.0) {
        return;
    }
    if (pinion == NULL && wheel == NULL) {
        gmi_side_sum_ideal(pair, side, position, wanted, total);
    } else {
        side_sum_tables(pair, pinion, wheel, side, position, wanted, total);
    }
}

static gm_penetration penetration_nan(void) {
    const double nan = gmi_nan();
    const gm_penetration result = {nan, nan, nan, nan, nan, nan, nan, nan, nan, nan, 0, 0};
    return result;
}

static void set_rates(gm_penetration *result, double offset_rate) {
    result->penetration = result->drive - result->coast;
    result->drive_rate = offset_rate * result->drive_contact;
    result->coast_rate = -offset_rate * result->coast_contact;
    result->rate = result->drive_rate - result->coast_rate;
}

int gm_penetration_simple_at(const gm_pair *pair, double offset, double offset_rate,
                             gm_penetration *result) {
    if (result == NULL) {
        return GM_ERR_NULL;
    }
    *result = penetration_nan();
    if (pair == NULL) {
        return GM_ERR_NULL;
    }
    if (!gmi_is_finite(offset) || !gmi_is_finite(offset_rate)) {
        return GM_STATE_NOT_FINITE;
    }
    if (fabs(offset) > GMI_LARGEST_OFFSET || fabs(offset_rate) > GMI_LARGEST_SPEED) {
        return GM_STATE_OUT_OF_RANGE;
    }

    const double drive = offset - 0.5 * pair->backlash;
    const double coast = -offset - 0.5 * pair->backlash;
    result->drive = drive > 0.0 ? drive : 0.0;
    result->coast = coast > 0.0 ? coast : 0.0;
    result->drive_pairs = drive > 0.0;
    result->coast_pairs = coast > 0.0;
    result->drive_contact = (double)result->drive_pairs;
    result->coast_contact = (double)result->coast_pairs;
    const double touching = result->drive_contact + result->coast_contact;
    result->d_pinion_angle = pair->pinion.base_radius * touching;
    result->d_wheel_angle = -pair->wheel.base_radius * touching;
    set_rates(result, offset_rate);
    return GM_OK;
}

/* One comparison: below 0 is far above as unsigned. */
static inline int is_tooth(int tooth, int teeth) {
    return (unsigned)tooth < (unsigned)teeth;
}

int gmi_check_evaluation(const gm_pair *pair, const gm_flanks *pinion_flanks,
                         const gm_flanks *wheel_flanks, const gm_position *position) {
    if (pair == NULL || position == NULL) {
        return GM_ERR_NULL;
    }
    if ((pinion_flanks != NULL && pinion_flanks->teeth != pair->pinion.teeth) ||
        (wheel_flanks != NULL && wheel_flanks->teeth != pair->wheel.teeth)) {
        return GM_ERR_TOOTH;
    }
    /* Negated, so that NaN is caught; a phase may be rounded up to p_bt. */
    if (!(fabs(position->offset) < 0.5 * pair->transverse_base_pitch) ||
        !(fabs(position->phase) < 1.5 * pair->transverse_base_pitch) ||
        !(fabs(position->offset_rate) <= GMI_LARGEST_SPEED)) {
        return gmi_is_finite(position->offset) && gmi_is_finite(position->phase) &&
                       gmi_is_finite(position->offset_rate)
                   ? GM_STATE_OUT_OF_RANGE
                   : GM_STATE_NOT_FINITE;
    }
    if (!is_tooth(position->pinion_tooth, pair->pinion.teeth) ||
        !is_tooth(position->wheel_tooth, pair->wheel.teeth)) {
        return GM_ERR_TOOTH;
    }
    return GM_OK;
}

/*
 * From line origin and delta to angles. Drive: origin grows with r_bp phi_p, delta with x; coast: both with the
 * opposite sign, and it counts negatively in the net sum, so that the signs are the same again.
 */
static void set_derivatives(const gm_pair *pair, const gmi_side_sum *drive,
                            const gmi_side_sum *coast, gm_penetration *result) {
    const double by_offset = drive->by_delta + coast->by_delta;
    const double by_origin = drive->by_origin + coast->by_origin;
    result->d_pinion_angle = pair->pinion.base_radius * (by_offset + by_origin);
    result->d_wheel_angle = -pair->wheel.base_radius * by_offset;
}

static int evaluate(const gm_pair *pair, const gm_flanks *pinion_flanks,
                    const gm_flanks *wheel_flanks, const gm_position *position, int wanted,
                    gm_penetration *result) {
    if (result == NULL) {
        return GM_ERR_NULL;
    }
    const int status = gmi_check_evaluation(pair, pinion_flanks, wheel_flanks, position);
    if (status != GM_OK) {
        *result = penetration_nan();
        return status;
    }

    gmi_side_sum drive, coast;
    gmi_side_sum_3d(pair, pinion_flanks, wheel_flanks, GM_DRIVE, position, wanted, &drive);
    gmi_side_sum_3d(pair, pinion_flanks, wheel_flanks, GM_COAST, position, wanted, &coast);
    result->drive = drive.sum;
    result->coast = coast.sum;
    result->drive_contact = drive.contact;
    result->coast_contact = coast.contact;
    result->drive_pairs = drive.pairs;
    result->coast_pairs = coast.pairs;
    set_rates(result, position->offset_rate);
    if (wanted & GMI_DERIVATIVES) {
        set_derivatives(pair, &drive, &coast, result);
    } else {
        result->d_pinion_angle = result->d_wheel_angle = gmi_nan();
    }
    return GM_OK;
}

int gm_penetration_3d_at(const gm_pair *pair, const gm_flanks *pinion_flanks,
                         const gm_flanks *wheel_flanks, const gm_position *position,
                         gm_penetration *result) {
    return evaluate(pair, pinion_flanks, wheel_flanks, position, GMI_DERIVATIVES, result);
}

int gm_penetration_3d_sum_at(const gm_pair *pair, const gm_flanks *pinion_flanks,
                             const gm_flanks *wheel_flanks, const gm_position *position,
                             gm_penetration *result) {
    return evaluate(pair, pinion_flanks, wheel_flanks, position, GMI_SUM, result);
}

int gm_penetration_3d(const gm_pair *pair, const gm_flanks *pinion_flanks,
                      const gm_flanks *wheel_flanks, const gm_state *state,
                      gm_penetration *result) {
    if (result == NULL) {
        return GM_ERR_NULL;
    }
    gm_position position;
    const int status = gm_position_from_state(pair, state, &position);
    if (status != GM_OK) {
        *result = penetration_nan();
        return status;
    }
    return gm_penetration_3d_at(pair, pinion_flanks, wheel_flanks, &position, result);
}
