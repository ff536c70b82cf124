/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Quasi-static equilibrium at one pinion angle: the x at which the net sum carries the torque. The net
 * sum grows with x (but see "departure" below) and its slope is exact, so Newton's method finds x, kept within
 * a bracket that bisection closes where Newton's method does not. Where the sum of a spur pair steps over the
 * torque the bracket closes on the step: there the edge of the entering pair carries the rest.
 *
 * Negative torque loads the coast flanks. What follows knows only a load that grows with "travel" = direction * x.
 */
#include "equilibrium.h"

#include "contact.h"
#include "internal.h"
#include "law.h"
#include "mesh.h"
#include "meshing.h"

#include <float.h>
#include <math.h>

#define NEWTON_STEPS  20  /* then every step halves the bracket, or doubles the reach */
#define LARGEST_STEPS 200 /* never needed: p_bt / 2 is halved to a rounding in 50 */

typedef struct problem {
    const gm_mesh *mesh;
    gm_workspace *workspace;
    const gm_pair *pair;
    gm_position position; /* phase and teeth; offset is the unknown */
    double direction;     /* +1: x grows with the load, -1: it falls */
    double target;        /* net sum that carries the torque, >= 0 in that direction (m) */
    int by_torque;        /* the torque does not follow from the sum alone */

    /* of x: the rounding of the lengths that the lines of contact are clipped to (m) */
    double resolution;
} problem;

/* The load is below the target at `lower`; what is known of `upper`: */
enum upper_end {
    RANGE_ENDS, /* only that the travel must not go beyond */
    LOAD_FALLS, /* the load is below the target there as well, its largest value lies between */
    CARRIES     /* the target is reached there */
};

typedef struct bracket {
    double lower, upper;
    enum upper_end end;
} bracket;

/* What is wanted of the mesh at a travel. Callers keep it below half a base pitch. */
static int evaluate(const problem *p, double travel, int wanted, gm_mesh_result *result) {
    gm_position position = p->position;
    position.offset = p->direction * travel;
    return gmi_mesh_evaluate_exact(p->mesh, &position, wanted, p->workspace, result);
}

/* Load less target at a travel, and the full result. */
static double residual(const problem *p, double travel, gm_mesh_result *result) {
    (void)evaluate(p, travel, GM_WANT_DERIVATIVES, result);
    const double sum = p->by_torque ? gmi_law_sum_of_torque(&p->mesh->law, result->wheel_torque,
                                                            p->pair->wheel.base_radius)
                                    : result->contact.penetration;
    return p->direction * sum - p->target;
}

/* Its derivative by the travel. */
static double slope_of(const problem *p, const gm_mesh_result *result) {
    const double r_bw = p->pair->wheel.base_radius;
    const double by_wheel_angle =
        p->by_torque
            ? gmi_law_sum_of_torque(&p->mesh->law, result->wheel_torque_by.wheel_angle, r_bw)
            : result->contact.d_wheel_angle;
    return -by_wheel_angle / r_bw;
}

/* No contact on a side whose ideal penetration is below minus this. */
static double sum_peak(const problem *p, int side) {
    return p->mesh->side[side].peak;
}

static int loaded_side(const problem *p) {
    return p->direction > 0.0 ? GM_DRIVE : GM_COAST;
}

/* Just inside |x| < p_bt / 2. */
static double largest_offset(const problem *p) {
    return 0.4999999 * p->pair->transverse_base_pitch;
}

static double clamp(double value, double limit) {
    return fmin(fmax(value, -limit), limit);
}

/* The largest load lies behind: it falls here, or all lines have left their path, which grows shorter with travel. */
static int is_beyond_largest(const problem *p, double travel, double slope) {
    if (slope != 0.0) {
        return slope < 0.0;
    }
    gm_position position = p->position;
    position.offset = p->direction * travel;
    gmi_side_sum lines = gmi_no_contact();
    gmi_side_sum_ideal(p->pair, &p->mesh->engagement, loaded_side(p), &position, GMI_SUM, &lines);
    return !(lines.contact > 0.0);
}

/*
 * From `travel` on: Newton's method within the bracket. Where nothing is known of its upper end, outwards by `reach` at
 * most, which doubles. Returns 0 if the load is not reached.
 */
static int solve(const problem *p, bracket within, double travel, double reach, double *found,
                 gm_mesh_result *result) {
    for (int k = 0; k < LARGEST_STEPS; ++k) {
        const double value = residual(p, travel, result);
        const double slope = slope_of(p, result);
        *found = travel;
        if (fabs(value) <= p->resolution * slope) {
            return 1;
        }
        if (isnan(value)) {
            return 0; /* elastic teeth that found no balance */
        }

        /* Where the load is reached is the upper end, where it is not the lower one. */
        if (value >= 0.0) {
            within.upper = travel;
            within.end = CARRIES;
        } else if (travel >= within.upper) {
            return 0;
        } else if (within.end == LOAD_FALLS && is_beyond_largest(p, travel, slope)) {
            within.upper = travel;
        } else {
            within.lower = travel;
        }

        if (within.end != RANGE_ENDS && within.upper - within.lower <= p->resolution) {
            return within.end == CARRIES; /* a step of the sum */
        }

        /* Newton, if it stays within the bracket; else half of it, or outwards. */
        const double newton = k < NEWTON_STEPS && slope > 0.0 ? travel - value / slope : gmi_nan();
        if (within.end == RANGE_ENDS) {
            travel = fmin(fmin(newton, travel + reach), within.upper);
            reach *= 2.0;
        } else {
            travel = newton > within.lower && newton < within.upper
                         ? newton
                         : within.lower + 0.5 * (within.upper - within.lower);
        }
    }
    return 0;
}

/*
 * Departure: the sum falls with x only where a line leaves the wheel's tip faster than the others press harder, on
 * spur pairs and next to spur. The travel at which the first line beyond `lower` begins to leave.
 */
static double departure(const problem *p, double lower) {
    const gm_pair *pair = p->pair;
    const gmi_engagement *at = &p->mesh->engagement;
    gmi_lines lines;
    gmi_lines_find(pair, at, loaded_side(p), &p->position, &lines);
    /* Line 0 begins to leave where T0 + delta - rho_w(tip) passes its lowest rho_p. */
    const double delta =
        lines.origin + lines.fall + at->tip_roll_length[GM_WHEEL] - at->line_of_action;
    const double travel = delta + 0.5 * at->backlash;
    const double pitch = pair->transverse_base_pitch;
    return travel + pitch * ceil((lower - travel) / pitch);
}

/*
 * If the load was carried before a line left: there, and not where the others have taken its share. Next to spur a line
 * leaves over as much travel as its face advances, and the load may still rise to its largest within that.
 */
static int solve_before_departure(const problem *p, double lower, double reached, double *found,
                                  gm_mesh_result *result) {
    const double before = departure(p, lower) - 8.0 * p->resolution;
    const double advance = fabs(p->pair->face_advance);
    if (!(advance < reached - lower && before > lower && before < reached)) {
        return 0;
    }
    gm_mesh_result there;
    const double value = residual(p, before, &there);
    if (value >= 0.0) {
        const bracket within = {lower, before, CARRIES};
        return solve(p, within, before, 0.0, found, result);
    }

    /* The slope that it has when the line begins to leave is the largest. */
    if (value + slope_of(p, &there) * advance < 0.0) {
        return 0;
    }
    const bracket leaving = {before, fmin(before + advance, reached), LOAD_FALLS};
    double travel;
    if (!solve(p, leaving, before, 0.0, &travel, &there)) {
        return 0;
    }
    *found = travel;
    *result = there;
    return 1;
}

static int find_loaded(const problem *p, double guess, double *found, gm_mesh_result *result) {
    const double limit = largest_offset(p);
    const double peak = sum_peak(p, loaded_side(p));
    const double lower =
        clamp(0.5 * p->mesh->engagement.backlash - peak, limit); /* nothing touches */

    /* Beyond all deviations the sum is next to linear: from there Newton's method comes close at once. */
    const double reach = fmax(p->target + 3.0 * fmax(peak, 0.0), p->resolution);
    const double start = fmin(lower + reach, limit);
    const int guessed = guess > lower && guess < limit;
    const bracket open = {lower, limit, RANGE_ENDS};
    const bracket bent = {lower, limit, LOAD_FALLS};

    /* From the guess, from beyond all deviations, and with a falling load in mind. */
    int carried = guessed && solve(p, open, guess, reach, found, result);
    if (!carried) {
        carried = solve(p, open, start, reach, found, result);
    }
    if (!carried) {
        carried = solve(p, bent, start, reach, found, result);
    }
    if (!carried) {
        /* Where ideal flanks carry it: teeth that stick out elsewhere have moved the start beyond the largest load. */
        const double ideal = 0.5 * p->mesh->engagement.backlash + p->target;
        carried = solve(p, bent, fmin(fmax(ideal, lower), limit), reach, found, result);
    }

    /* An earlier place, before a line leaves, counts first. */
    const double reached = carried ? *found : limit;
    if (solve_before_departure(p, lower, reached, found, result)) {
        carried = 1;
    }
    return carried ? GM_OK : GM_NO_EQUILIBRIUM;
}

/* No torque: equilibrium only where both sides press against each other (negative backlash). */
static int find_unloaded(const problem *p, double guess, double *found, gm_mesh_result *result) {
    const double half_backlash = 0.5 * p->mesh->engagement.backlash;
    const double limit = largest_offset(p);
    const bracket within = {
        clamp(half_backlash - sum_peak(p, GM_DRIVE), limit),  /* below: no drive contact */
        clamp(-half_backlash + sum_peak(p, GM_COAST), limit), /* above: no coast contact */
        CARRIES,
    };
    if (!(within.lower < within.upper)) {
        return GM_UNDETERMINED;
    }

    /* Both sides have to press there, or any place nearby would do as well. */
    const int guessed = guess > within.lower && guess < within.upper;
    const double middle = within.lower + 0.5 * (within.upper - within.lower);
    if (!solve(p, within, guessed ? guess : middle, 0.0, found, result) ||
        !(result->contact.drive_contact > 0.0 && result->contact.coast_contact > 0.0)) {
        return GM_UNDETERMINED;
    }
    return GM_OK;
}

/* The spring with backlash in closed form. */
static int find_simple(const problem *p, double *found) {
    const double clearance = 0.5 * p->mesh->engagement.backlash;
    const double compression = p->target;
    if (compression > 0.0) {
        /* Negative backlash: both flanks touch up to |x| = -clearance and push against each other. */
        *found = compression < -2.0 * clearance ? 0.5 * compression : clearance + compression;
    } else {
        *found = 0.0;
        if (!(clearance < 0.0)) {
            return GM_UNDETERMINED;
        }
    }
    return GM_OK;
}

static int find(const problem *p, double guess, double *found, gm_mesh_result *result) {
    if (p->mesh->model == GM_MODEL_SIMPLE) {
        const int status = find_simple(p, found);
        (void)residual(p, *found, result);

        /* The spring has no end, but numbers have. */
        const int is_number = gmi_is_finite(*found) && gmi_is_finite(result->force);
        return status == GM_OK && !is_number ? GM_NO_EQUILIBRIUM : status;
    }
    return p->target > 0.0 ? find_loaded(p, guess, found, result)
                           : find_unloaded(p, guess, found, result);
}

/* All but the load. */
static int begin(const gm_mesh *mesh, double pinion_angle, double pinion_speed,
                 gm_workspace *workspace, problem *p) {
    p->mesh = mesh;
    p->workspace = workspace;
    p->pair = mesh->pair;
    p->by_torque = mesh->friction.is_on || mesh->has_corners;
    p->resolution = DBL_EPSILON * p->pair->center_distance;
    const int status = gm_position_from_pinion_angle(p->pair, pinion_angle, 0.0, 0.0, &p->position);
    if (status != GM_OK) {
        return status;
    }

    if (!(fabs(pinion_speed) <= GMI_LARGEST_SPEED)) {
        return gmi_is_finite(pinion_speed) ? GM_STATE_OUT_OF_RANGE : GM_STATE_NOT_FINITE;
    }
    p->position.pinion_speed = pinion_speed;

    /* From here on in the coordinates of the posed pair. */
    if (mesh->is_posed) {
        p->position.phase += mesh->engagement.phase_shift;
    }
    return GM_OK;
}

/* Torque below zero loads the coast flanks. */
static void load(problem *p, double wheel_torque) {
    p->direction = wheel_torque < 0.0 ? -1.0 : 1.0;
    p->target = p->direction *
                gmi_law_sum_of_torque(&p->mesh->law, wheel_torque, p->pair->wheel.base_radius);
}

int gm_rolling_equilibrium(const gm_mesh *mesh, double pinion_angle, double pinion_speed,
                           double wheel_torque, double guess, gm_workspace *workspace,
                           double *offset, gm_mesh_result *result) {
    if (result != NULL) {
        gmi_mesh_result_set_nan(result); /* until found */
    }
    if (offset == NULL) {
        return GM_ERR_NULL;
    }
    *offset = gmi_nan();
    if (mesh == NULL) {
        return GM_ERR_NULL;
    }
    if (!gmi_is_finite(wheel_torque)) {
        return GM_ERR_PARAMETER;
    }

    problem p;
    int status = begin(mesh, pinion_angle, pinion_speed, workspace, &p);
    if (status != GM_OK) {
        return status;
    }
    load(&p, wheel_torque);
    const double shift = mesh->engagement.offset_shift;
    if (mesh->is_posed) {
        guess += shift;
    }

    double travel;
    gm_mesh_result at_equilibrium;
    status = find(&p, p.direction * guess, &travel, &at_equilibrium);
    if (status == GM_OK) {
        *offset = p.direction * travel - shift;
        if (result != NULL) {
            *result = at_equilibrium;
        }
    }
    return status;
}

int gm_static_equilibrium(const gm_mesh *mesh, double pinion_angle, double wheel_torque,
                          double guess, gm_workspace *workspace, double *offset,
                          gm_mesh_result *result) {
    return gm_rolling_equilibrium(mesh, pinion_angle, 0.0, wheel_torque, guess, workspace, offset,
                                  result);
}

/* ---------------------------------------------------------------------------------------------
 * Several loads at one position
 * ------------------------------------------------------------------------------------------- */

/* Newton's method from a place so good that its slope serves all steps. Returns 0 if it is not. */
static int settle(const problem *p, double travel, double slope, int wanted, double *found,
                  gm_mesh_result *result) {
    enum { STEPS = 3 };
    const double limit = largest_offset(p);
    for (int k = 0; k < STEPS && travel > -limit && travel < limit; ++k) {
        (void)evaluate(p, travel, wanted, result);
        const double value = p->direction * result->contact.penetration - p->target;
        if (fabs(value) <= p->resolution * slope) {
            *found = travel;
            return 1;
        }
        travel -= value / slope;
    }
    return 0;
}

/* From a guess of any quality, and then what is wanted there beyond derivatives. */
static int find_wanted(const problem *p, double guess, int wanted, double *found, double *slope,
                       gm_mesh_result *result) {
    int status = find(p, guess, found, result);
    if (status == GM_OK) {
        *slope = slope_of(p, result);
        if ((wanted | GM_WANT_DERIVATIVES) != GM_WANT_DERIVATIVES) {
            status = evaluate(p, *found, wanted, result);
        }
    }
    return status;
}

/* Each from the guess that stands in its place, and the slope there. Without one it is guessed from the one before. */
static OWN_STACK int find_each(problem *p, const double *wheel_torque, int count,
                               const double *slope, int wanted, double *offset,
                               gm_mesh_result *result) {
    const double shift = p->mesh->engagement.offset_shift;
    double before = gmi_nan(), before_target = 0.0, before_slope = gmi_nan();
    int worst = GM_OK;
    for (int k = 0; k < count; ++k) {
        load(p, wheel_torque[k]);
        gm_mesh_result here;
        double travel = p->direction * offset[k];
        int status = GM_OK;

        /* Searched where the guess is not that good, from the load before if there is none. */
        if (p->by_torque || !settle(p, travel, slope[k], wanted, &travel, &here)) {
            const double signed_target = p->direction * p->target;
            const double from_before =
                p->direction * (before + (signed_target - before_target) / before_slope);
            status = find_wanted(p, isnan(travel) ? from_before : travel, wanted, &travel,
                                 &before_slope, &here);
            before = p->direction * travel;
            before_target = signed_target;
        }

        /* In the coordinates of the drawing. */
        offset[k] = status == GM_OK ? p->direction * travel - shift : gmi_nan();
        if (status == GM_OK && result != NULL) {
            result[k] = here;
        }
        worst = worst != GM_OK ? worst : status;
    }
    return worst;
}

int gm_rolling_equilibria(const gm_mesh *mesh, double pinion_angle, double pinion_speed,
                          const double *wheel_torque, int count, int wanted,
                          gm_workspace *workspace, double *offset, gm_mesh_result *result) {
    if (count < 0) {
        return GM_ERR_PARAMETER;
    }
    for (int k = 0; k < count && result != NULL; ++k) {
        gmi_mesh_result_set_nan(&result[k]);
    }
    if (offset == NULL) {
        return GM_ERR_NULL;
    }
    for (int k = 0; k < count; ++k) {
        offset[k] = gmi_nan();
    }
    if (mesh == NULL || wheel_torque == NULL) {
        return GM_ERR_NULL;
    }
    int is_right = (wanted & ~GMI_WANT_ALL) == 0;
    for (int k = 0; k < count; ++k) {
        is_right = is_right && gmi_is_finite(wheel_torque[k]);
    }
    if (!is_right) {
        return GM_ERR_PARAMETER;
    }

    problem p;
    int worst = begin(mesh, pinion_angle, pinion_speed, workspace, &p);
    if (worst != GM_OK) {
        return worst;
    }

    /* In blocks of the same size. */
    double slope[GMI_LOADS_MAX];
    const int blocks = count / GMI_LOADS_MAX + (count % GMI_LOADS_MAX != 0);
    for (int k = 0, first = 0; k < blocks; ++k) {
        const int size = (count - first) / (blocks - k);
        gmi_equilibrium_guesses(mesh, &p.position, wheel_torque + first, size, offset + first,
                                slope);
        const int status = find_each(&p, wheel_torque + first, size, slope, wanted, offset + first,
                                     result != NULL ? result + first : NULL);
        worst = worst != GM_OK ? worst : status;
        first += size;
    }
    return worst;
}
