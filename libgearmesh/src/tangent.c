/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The exact tangent: derivatives of force and wrench by the seven coordinates and their rates.
 *
 * penetration.c knows how the sums of a side move with the side's own coordinates, law.c what force that is. Here these
 * coordinates follow from the seven. With e the line of action and t across it, turned as the axes are, a movement dO of
 * the wheel's axis changes
 *
 *     delta by -dO.e,   T by dO.e + dO.t (r_bp + r_bw) / T,   the origin by dO.t r_bp / T,
 *     and turns e by dO.t / T, so that the tilt along it grows by its part across times that, and the one across falls.
 */
#include "contact.h"
#include "corner.h"
#include "friction.h"
#include "internal.h"
#include "line.h"
#include "mesh.h"
#include "meshing.h"
#include "penetration.h"
#include "position.h"
#include "side_tangent.h"
#include "wrench.h"

#include <math.h>
#include <string.h>

/* How all that the force of a side depends on follows the seven and their rates. */
typedef struct side_motion {
    double sign, tau, wheel_sign;
    gmi_plane plane;
    double pinion_arm, wheel_arm;               /* d delta / d angle of both gears (m) */
    double across[GMI_TIP_VARIABLES];           /* by a movement of the wheel's axis along t */
    double sideways_by_axial, forward_by_axial; /* (1/s) */
    double turning[2],
        sideways[2]; /* of tilts: their share in the sideways speeds, at t1 = 0 and per t1 (1, m) */
} side_motion;

/* e turns by 1 / T as the axis moves across it, and with it what tilts and rates of the pose are along it and across. */
static OWN_STACK void find_side_motion(const gm_mesh *mesh, int side, const gmi_rates *rates,
                                       const gm_pose *pose_rate, side_motion *motion) {
    const gm_pair *pair = mesh->pair;
    const gmi_engagement *at = &mesh->engagement;
    const double sign = gmi_side_sign(side);
    const double r_bp = pair->pinion.base_radius;
    const double turn = 1.0 / at->line_of_action;
    motion->sign = sign;
    motion->wheel_sign = pair->wheel.sign;
    motion->tau = sign * pair->face_advance / pair->face_width;
    motion->plane = gmi_plane_of(at, sign);
    motion->pinion_arm = sign * r_bp;
    motion->wheel_arm = -sign * pair->wheel.base_radius;

    /* The coordinates of the side, and the speeds. */
    const double *t = motion->plane.t;
    const double moving = t[0] * pose_rate->center_distance_change + t[1] * pose_rate->offset;
    double *across = motion->across;
    across[GMI_BY_ORIGIN] = r_bp * turn;
    across[GMI_BY_DELTA] = across[GMI_BY_AXIAL] = 0.0;
    across[GMI_BY_LENGTH] = (r_bp + at->wheel_base_radius) * turn;
    across[GMI_BY_ALONG] = at->across[side] * turn;
    across[GMI_BY_ACROSS] = -at->along[side] * turn;
    across[GMI_BY_DELTA_RATE] = -moving * turn;
    across[GMI_BY_ALONG_RATE] = rates->across * turn;
    across[GMI_BY_ACROSS_RATE] = -rates->along * turn;
    across[GMI_BY_PINION_SPEED] = across[GMI_BY_WHEEL_SPEED] = 0.0;
    across[GMI_BY_SIDEWAYS] = rates->forward[0] * turn;
    across[GMI_BY_SIDEWAYS_T1] = rates->forward[1] * turn;
    across[GMI_BY_FORWARD] = -rates->sideways[0] * turn;
    across[GMI_BY_FORWARD_T1] = -rates->sideways[1] * turn;

    /* Tilts turn what is away from the middle of the wheel's face sideways too. */
    motion->sideways_by_axial = -rates->sideways[1] / pair->face_width;
    motion->forward_by_axial = -rates->forward[1] / pair->face_width;
    motion->turning[0] = sign * t[1];
    motion->turning[1] = -sign * t[0];
    motion->sideways[0] = pair->face_start - at->face_center;
    motion->sideways[1] = pair->face_width;
}

/* Derivatives of a force and of its moments: by the seven and by their rates. */
typedef struct side_gradient {
    double by[GM_COORDINATES][GMI_WEIGHTS];
    double by_rate[GM_COORDINATES][GMI_WEIGHTS];
} side_gradient;

/* What depends on a side: on its coordinates and its speeds of approach, on those of sliding too, or at tips on all. */
enum { PRESSING, RUBBING, RUBBING_TIPS };

/* What slides: f, derivatives by the variables; weight: of the force at hand. */
SPECIALIZED void add_sliding(const side_motion *motion, const double f[GMI_TIP_VARIABLES],
                             int weight, int what, side_gradient *gradient) {
    const double *e = motion->plane.e, *t = motion->plane.t;
    const double sign = motion->sign;
    double(*to)[GMI_WEIGHTS] = gradient->by, (*to_rate)[GMI_WEIGHTS] = gradient->by_rate;
    to[GM_AXIAL_SHIFT][weight] += motion->sideways_by_axial * f[GMI_BY_SIDEWAYS];
    to_rate[GM_PINION_ANGLE][weight] += f[GMI_BY_PINION_SPEED];
    to_rate[GM_WHEEL_ANGLE][weight] += motion->wheel_sign * f[GMI_BY_WHEEL_SPEED];
    const double tilting =
        motion->sideways[0] * f[GMI_BY_SIDEWAYS] + motion->sideways[1] * f[GMI_BY_SIDEWAYS_T1];
    for (int k = 0; k < 2; ++k) {
        to_rate[GM_CENTER_DISTANCE_CHANGE + k][weight] -= sign * t[k] * f[GMI_BY_SIDEWAYS];
        to_rate[GM_SKEW + k][weight] += motion->turning[k] * tilting;
    }
    if (what == RUBBING) {
        return;
    }

    /* At tips along the line of action as well. */
    to[GM_AXIAL_SHIFT][weight] += motion->forward_by_axial * f[GMI_BY_FORWARD];
    const double swinging =
        motion->sideways[0] * f[GMI_BY_FORWARD] + motion->sideways[1] * f[GMI_BY_FORWARD_T1];
    const double turned[2] = {-sign * e[1], sign * e[0]};
    for (int k = 0; k < 2; ++k) {
        to_rate[GM_CENTER_DISTANCE_CHANGE + k][weight] += sign * e[k] * f[GMI_BY_FORWARD];
        to_rate[GM_SKEW + k][weight] += turned[k] * swinging;
    }
}

/* by: derivatives of a force by the variables; what: a constant at each call. */
SPECIALIZED void find_gradient(const side_motion *motion, const double by[][GMI_WEIGHTS], int what,
                               side_gradient *gradient) {
    const int count = what == PRESSING  ? GMI_LOAD_VARIABLES
                      : what == RUBBING ? GMI_VARIABLES
                                        : GMI_TIP_VARIABLES;
    const double *e = motion->plane.e, *t = motion->plane.t;
    const double sign = motion->sign, tau = motion->tau;
    for (int weight = 0; weight < GMI_WEIGHTS; ++weight) {
        double f[GMI_TIP_VARIABLES], across = 0.0;
        for (int of = 0; of < count; ++of) {
            f[of] = by[of][weight];
            across += motion->across[of] * f[of];
        }

        /* Angles, and the wheel along its axis. */
        double(*to)[GMI_WEIGHTS] = gradient->by, (*to_rate)[GMI_WEIGHTS] = gradient->by_rate;
        to[GM_PINION_ANGLE][weight] = motion->pinion_arm * (f[GMI_BY_ORIGIN] + f[GMI_BY_DELTA]);
        to[GM_WHEEL_ANGLE][weight] = motion->wheel_arm * f[GMI_BY_DELTA];
        to[GM_AXIAL_SHIFT][weight] = tau * f[GMI_BY_DELTA] + f[GMI_BY_AXIAL];
        to_rate[GM_PINION_ANGLE][weight] = motion->pinion_arm * f[GMI_BY_DELTA_RATE];
        to_rate[GM_WHEEL_ANGLE][weight] = motion->wheel_arm * f[GMI_BY_DELTA_RATE];
        to_rate[GM_AXIAL_SHIFT][weight] = tau * f[GMI_BY_DELTA_RATE];

        /* The wheel's axis along the line of action and across it, and tilts. */
        const double against = f[GMI_BY_DELTA] - f[GMI_BY_LENGTH];
        for (int k = 0; k < 2; ++k) {
            const int moved = GM_CENTER_DISTANCE_CHANGE + k, tilted = GM_SKEW + k;
            to[moved][weight] = across * t[k] - against * e[k];
            to[tilted][weight] = -sign * (e[k] * f[GMI_BY_ALONG] + t[k] * f[GMI_BY_ACROSS]);
            to_rate[moved][weight] = -e[k] * f[GMI_BY_DELTA_RATE];
            to_rate[tilted][weight] =
                -sign * (e[k] * f[GMI_BY_ALONG_RATE] + t[k] * f[GMI_BY_ACROSS_RATE]);
        }
        if (what != PRESSING) {
            add_sliding(motion, f, weight, what, gradient);
        }
    }
}

/* Adds a force or the friction of one side to the derivatives of the wrench, in the frame of the drawing. */
static void add_wrenches(const gmi_wrench_map *map, const gmi_wrench_map map_by[2],
                         const side_gradient *gradient, const double force[GMI_WEIGHTS],
                         gm_tangent *tangent) {
    for (int k = 0; k < GM_COORDINATES; ++k) {
        gmi_wrench_map_add(map, gradient->by[k], &tangent->wrench_by[k]);
        gmi_wrench_map_add(map, gradient->by_rate[k], &tangent->wrench_by_rate[k]);
    }

    /* As the wheel's axis moves, the line of action turns, and the axis about which moments are taken goes with it. */
    for (int k = 0; k < 2; ++k) {
        gmi_wrench_map_add(&map_by[k], force, &tangent->wrench_by[GM_CENTER_DISTANCE_CHANGE + k]);
    }
}

/* And its friction. */
static OWN_STACK void add_rubbing(const gm_pair *pair, const gmi_engagement *at, int side,
                                  const side_motion *motion, const gmi_rubbing *rubbing,
                                  const gmi_rubbing_by *rubbing_by, gm_tangent *tangent) {
    gmi_wrench_map map, map_by[2];
    side_gradient gradient;
    gmi_wrench_map_friction(pair, at, side, &map, map_by);
    find_gradient(motion, rubbing_by->force, RUBBING, &gradient);
    add_wrenches(&map, map_by, &gradient, rubbing->force, tangent);
}

/* The normal force of a side: it, and its wrench. */
static OWN_STACK void add_force(const gm_pair *pair, const gmi_engagement *at, int side,
                                const side_motion *motion, const double force[GMI_WEIGHTS],
                                const double force_by[][GMI_WEIGHTS], gm_tangent *tangent) {
    gmi_wrench_map map, map_by[2];
    side_gradient gradient;
    gmi_wrench_map_force(pair, at, side, &map, map_by);
    find_gradient(motion, force_by, PRESSING, &gradient);
    for (int k = 0; k < GM_COORDINATES; ++k) {
        tangent->force_by[k] += motion->sign * gradient.by[k][GMI_WHOLE];
        tangent->force_by_rate[k] += motion->sign * gradient.by_rate[k][GMI_WHOLE];
    }
    add_wrenches(&map, map_by, &gradient, force, tangent);
}

static void set_tangent(gm_tangent *tangent, double value) {
    for (int k = 0; k < GM_COORDINATES; ++k) {
        tangent->force_by[k] = tangent->force_by_rate[k] = value;
        gmi_wrench_set(&tangent->wrench_by[k], value);
        gmi_wrench_set(&tangent->wrench_by_rate[k], value);
    }
}

/* All that is known of a side: its force and friction, and how they move. */
typedef struct followed_side {
    gmi_side_tangent tangent;
    gmi_rubbing rubbing;
    gmi_rubbing_by rubbing_by;
} followed_side;

/* Adds a side that presses. */
static OWN_STACK void add_pressed(const gm_mesh *moved, const gm_pose *pose_rate, int side,
                                  const followed_side *followed, gm_tangent *tangent) {
    const gm_pair *pair = moved->pair;
    const gmi_engagement *at = &moved->engagement;
    side_motion motion;
    find_side_motion(moved, side, &followed->tangent.rates, pose_rate, &motion);
    add_force(pair, at, side, &motion, followed->tangent.load.force, followed->tangent.by.force,
              tangent);
    if (moved->friction.is_on) {
        add_rubbing(pair, at, side, &motion, &followed->rubbing, &followed->rubbing_by, tangent);
    }
}

/* Follows the lines of a side. */
static OWN_STACK void follow(const gm_mesh *moved, const gm_position *position,
                             const gmi_rates *rates, int side, followed_side *followed) {
    gmi_sliding sliding;
    gmi_side_sum sum;
    followed->tangent.rates = *rates;
    if (moved->friction.is_on) {
        gmi_sliding_find(&moved->friction, moved->pair, &moved->engagement, position, rates,
                         &sliding);
    }
    gmi_side_sum_tangent(moved, side, position, moved->friction.is_on ? &sliding : NULL, &sum,
                         &followed->tangent, &followed->rubbing, &followed->rubbing_by);
}

/* Adds a side, if it presses. */
static OWN_STACK void add_side(const gm_mesh *moved, const gm_position *position,
                               const gm_pose *pose_rate, const gmi_rates *rates, int side,
                               gm_tangent *tangent) {
    const gmi_engagement *at = &moved->engagement;
    if (gmi_side_is_clear(at, &moved->side[side], side, position->offset)) {
        return;
    }
    followed_side followed;
    follow(moved, position, rates, side, &followed);
    if (followed.tangent.load.force[GMI_WHOLE] > 0.0) {
        add_pressed(moved, pose_rate, side, &followed, tangent);
    }
}

/*
 * With corners: the whole side approaches at the mean speed over what touches, and its tips at that of parallel axes, as in
 * evaluations. The mean moves with what touches and with how fast each of its points approaches.
 */
static void find_corner_load(const gm_mesh *moved, int side, const gmi_corner_tangent *followed,
                             gmi_load *load, gmi_load_by *by) {
    const double k = moved->law.stiffness, d = moved->law.damping;
    const double tau = gmi_side_sign(side) * moved->pair->face_advance / moved->pair->face_width;
    const double of_along = -tau * moved->engagement.wheel_base_radius;
    const gmi_rates *rates = &followed->rates;
    const double touching = followed->contact[GMI_WHOLE];
    const double arm = followed->arm[GMI_WHOLE] / touching;
    const double speed = rates->delta + of_along * rates->along - rates->across * arm;

    /* The mean, by the coordinates and by the rates. */
    double speed_by[GMI_LOAD_VARIABLES];
    for (int of = 0; of < GMI_COORDINATES; ++of) {
        speed_by[of] =
            (followed->flow_by[of] - speed * followed->contact_by[of][GMI_WHOLE]) / touching;
    }
    speed_by[GMI_BY_ORIGIN] -= rates->across * tau;
    speed_by[GMI_BY_LENGTH] += rates->across * tau;
    speed_by[GMI_BY_AXIAL] += rates->across;
    speed_by[GMI_BY_DELTA_RATE] = 1.0;
    speed_by[GMI_BY_ALONG_RATE] = of_along;
    speed_by[GMI_BY_ACROSS_RATE] = -arm;

    for (int weight = 0; weight < GMI_WEIGHTS; ++weight) {
        const double contact = followed->contact[weight];
        load->force[weight] = k * followed->sum[weight] + d * speed * contact;
        for (int of = 0; of < GMI_LOAD_VARIABLES; ++of) {
            by->force[of][weight] = d * contact * speed_by[of];
            if (of < GMI_COORDINATES) {
                by->force[of][weight] +=
                    k * followed->sum_by[of][weight] + d * speed * followed->contact_by[of][weight];
            }
        }
    }
}

/* What the tip of one gear changes. */
static OWN_STACK void add_tip(const gm_pair *pair, const gmi_engagement *at, int side, int role,
                              const side_motion *motion, const gmi_tip_tangent *tip,
                              gm_tangent *tangent) {
    for (int part = 0; part < GMI_TIP_PARTS; ++part) {
        gmi_wrench_map map, map_by[2];
        side_gradient gradient;
        gmi_wrench_map_tip(pair, at, role, part, side, &map, map_by);
        find_gradient(motion, tip->by[part], PRESSING, &gradient);
        add_wrenches(&map, map_by, &gradient, tip->sum[part], tangent);
    }
}

/* 1 where it presses. */
static OWN_STACK int add_pressed_corners(const gm_mesh *moved, const gm_pose *pose_rate, int side,
                                         const gmi_corner_tangent *followed, gm_tangent *tangent) {
    const gm_pair *pair = moved->pair;
    const gmi_engagement *at = &moved->engagement;
    gmi_load load;
    gmi_load_by by;
    const gmi_load_by *found = &by;
    find_corner_load(moved, side, followed, &load, &by);
    if (!(load.force[GMI_WHOLE] > 0.0)) {
        return 0;
    }
    side_motion motion;
    find_side_motion(moved, side, &followed->rates, pose_rate, &motion);
    add_force(pair, at, side, &motion, load.force, found->force, tangent);
    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        add_tip(pair, at, side, role, &motion, &followed->tips[role], tangent);
    }
    return 1;
}

/* A side whose lines go on beyond the path of contact. 1 where it presses. */
static OWN_STACK int add_corner_side(const gm_mesh *moved, const gm_position *position,
                                     const gm_pose *pose_rate, const gmi_rates *rates, int side,
                                     gm_tangent *tangent) {
    gmi_corner_tangent followed;
    memset(&followed, 0, sizeof followed);
    followed.rates = *rates;
    gmi_side_sum_corner_tangent(moved, side, position, &followed);
    return followed.contact[GMI_WHOLE] > 0.0 &&
           add_pressed_corners(moved, pose_rate, side, &followed, tangent);
}

/* The friction of flanks and tips. */
static OWN_STACK void add_rubbed(const gm_mesh *moved, const gm_pose *pose_rate, int side,
                                 const gmi_corner_rubbing *rubbing, gm_tangent *tangent) {
    side_motion motion;
    find_side_motion(moved, side, &rubbing->rates, pose_rate, &motion);
    for (int part = 0; part < GMI_RUBBING_PARTS; ++part) {
        gmi_wrench_map map, map_by[2];
        side_gradient gradient;
        if (part == GMI_RUBBING_FLANKS) {
            gmi_wrench_map_friction(moved->pair, &moved->engagement, side, &map, map_by);
        } else {
            gmi_wrench_map_tip_friction(moved->pair, &moved->engagement, part, side, &map, map_by);
        }
        find_gradient(&motion, rubbing->by[part], RUBBING_TIPS, &gradient);
        add_wrenches(&map, map_by, &gradient, rubbing->sum[part], tangent);
    }
}

/* On a walk of its own along the lines: the force and the friction at once would be too much stack. */
static OWN_STACK void add_corner_rubbing(const gm_mesh *moved, const gm_position *position,
                                         const gm_pose *pose_rate, const gmi_rates *rates, int side,
                                         gm_tangent *tangent) {
    gmi_sliding sliding;
    gmi_corner_rubbing rubbing;
    memset(&rubbing, 0, sizeof rubbing);
    rubbing.rates = *rates;
    gmi_sliding_find(&moved->friction, moved->pair, &moved->engagement, position, rates, &sliding);
    gmi_side_sum_corner_rubbing(moved, side, position, &sliding, &rubbing);
    add_rubbed(moved, pose_rate, side, &rubbing, tangent);
}

/* Adds a side with corners, if it presses. */
static void add_side_with_corners(const gm_mesh *moved, const gm_position *position,
                                  const gm_pose *pose_rate, const gmi_rates *rates, int side,
                                  gm_tangent *tangent) {
    if (gmi_side_is_clear(&moved->engagement, &moved->side[side], side, position->offset)) {
        return;
    }
    if (add_corner_side(moved, position, pose_rate, rates, side, tangent) &&
        moved->friction.is_on) {
        add_corner_rubbing(moved, position, pose_rate, rates, side, tangent);
    }
}

static int find_tangent(const gm_mesh *mesh, const gm_motion *motion, gm_tangent *tangent) {
    if (mesh == NULL || motion == NULL) {
        return GM_ERR_NULL;
    }
    if (mesh->elastic != NULL) {
        return GM_ERR_PARAMETER;
    }

    gm_mesh moved;
    gm_position position;
    gmi_rates rates[2];
    int status = gmi_mesh_follow(mesh, motion, &moved, &position, rates);
    if (status == GM_OK && moved.friction.is_on) {
        status = gmi_check_speed(position.pinion_speed);
    }
    if (status != GM_OK) {
        return status;
    }

    set_tangent(tangent, 0.0);
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        if (moved.has_corners) {
            add_side_with_corners(&moved, &position, &motion->pose_rate, &rates[side], side,
                                  tangent);
        } else {
            add_side(&moved, &position, &motion->pose_rate, &rates[side], side, tangent);
        }
    }
    return GM_OK;
}

int gm_mesh_tangent(const gm_mesh *mesh, const gm_motion *motion, gm_tangent *tangent) {
    const int status = tangent == NULL ? GM_ERR_NULL : find_tangent(mesh, motion, tangent);
    if (status != GM_OK && tangent != NULL) {
        set_tangent(tangent, gmi_nan());
    }
    return status;
}
