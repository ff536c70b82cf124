/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Forces and moments on both gears. The force of each side acts along the surface normal: along the line of action in
 * the transverse section, and tan(beta_b) of it along the axis. Where it acts follows from its first moments over t1
 * and rho_p.
 */
#include "wrench.h"

#include "contact.h"
#include "corner.h"
#include "friction.h"
#include "internal.h"
#include "law.h"
#include "meshing.h"
#include "side_tangent.h"

#include <math.h>

/*
 * The coast plane of action is the drive one mirrored at the plane of both axes. With sign = +1 drive, -1 coast, on the
 * wheel acts force * (sin(alpha), sign cos(alpha), -sign tan(beta_b)) at
 *     (r_bp cos(alpha) + rho sin(alpha), sign (rho cos(alpha) - r_bp sin(alpha)), z_0 + b t1).
 */
void gmi_wrench_add_side(const gm_pair *pair, const gmi_engagement *at, const gmi_side_force *side,
                         int side_of_teeth, gm_wrench *wrench) {
    const double sin_alpha = at->sin_pressure_angle, cos_alpha = at->cos_pressure_angle;
    const double sign = gmi_side_sign(side_of_teeth);
    const double force = side->force;
    const double f_x = force * sin_alpha;
    const double f_y = force * sign * cos_alpha;
    const double axial_share = -sign * pair->face_advance / pair->face_width;
    const double f_z = force * axial_share;

    /* Moments of position times force, about the pinion axis at z = 0. */
    const double r_b = pair->pinion.base_radius;
    const double x_force = force * r_b * cos_alpha + side->force_rho * sin_alpha;
    const double y_force = sign * (side->force_rho * cos_alpha - force * r_b * sin_alpha);
    const double z_force = pair->face_start * force + pair->face_width * side->force_t1;
    const double m_x = y_force * axial_share - z_force * sign * cos_alpha;
    const double m_y = z_force * sin_alpha - x_force * axial_share;
    const double m_z = force * sign * r_b;

    /* About the wheel axis: less d e_x cross force. */
    const double d = at->center_distance;
    const double on_wheel_force[3] = {f_x, f_y, f_z};
    const double about_pinion[3] = {m_x, m_y, m_z};
    const double about_wheel[3] = {m_x, m_y + d * f_z, -force * sign * at->wheel_base_radius};

    /* What acts on the wheel acts on the pinion the other way. */
    for (int k = 0; k < 3; ++k) {
        wrench->wheel_force[k] += on_wheel_force[k];
        wrench->wheel_moment[k] += about_wheel[k];
        wrench->pinion_force[k] -= on_wheel_force[k];
        wrench->pinion_moment[k] -= about_pinion[k];
    }
}

/*
 * The same in the frame of the drawing, as a map: a force along e, its axial share, and its arms
 *     rho e + r_bp t + z k     from the pinion's axis.
 * As the wheel's axis moves by dO, e turns by dO.t / T towards t and t away from e, and the axis of the wheel's moments is
 * dO further: that is the map of those, without what keeps its direction.
 */
static gmi_wrench_map map_of_force(const gm_pair *pair, const double e[2], const double t[2],
                                   const double to_wheel[2], double axial_share) {
    const double r_b = pair->pinion.base_radius;
    const double z = pair->face_start, width = pair->face_width;
    const double about[2] = {r_b * t[1] * axial_share - z * e[1],
                             z * e[0] - r_b * t[0] * axial_share};
    const gmi_wrench_map map = {
        .force = {e[0], e[1], 0.0},
        .by_t1 = {-width * e[1], width * e[0]},
        .by_rho = {axial_share * e[1], -axial_share * e[0], 0.0},
        .pinion = {about[0], about[1], 0.0},
        .wheel = {about[0] - to_wheel[1] * axial_share, about[1] + to_wheel[0] * axial_share, 0.0}};
    return map;
}

void gmi_wrench_map_force(const gm_pair *pair, const gmi_engagement *at, int side,
                          gmi_wrench_map *map, gmi_wrench_map by[2]) {
    const double sign = gmi_side_sign(side);
    const double axial_share = -sign * pair->face_advance / pair->face_width;
    const gmi_plane plane = gmi_plane_of(at, sign);
    const double *e = plane.e, *t = plane.t;
    const double d = at->center_distance;
    const double to_wheel[2] = {d * at->axis[0], d * at->axis[1]};
    *map = map_of_force(pair, e, t, to_wheel, axial_share);
    map->force[2] = axial_share;
    map->pinion[2] = sign * pair->pinion.base_radius;
    map->wheel[2] = -sign * at->wheel_base_radius;

    for (int k = 0; k < 2; ++k) {
        const double turn = t[k] / at->line_of_action;
        const double e_by[2] = {turn * t[0], turn * t[1]}, t_by[2] = {-turn * e[0], -turn * e[1]};
        const double moved[2] = {k == 0, k == 1};
        by[k] = map_of_force(pair, e_by, t_by, moved, axial_share);
    }
}

/*
 * What a tip corner changes: the force turns by Delta, away from the pinion's axis, to cos(Delta) e + sin(Delta) n, and acts
 * where the corner is. T sin(Delta) = r_b gap' - (r_bp + r_bw) (1 - cos(Delta)). With the wheel's tip the pinion's flank
 * keeps its arm, with the pinion's tip the wheel's does; the wheel's axes n and e point the other way.
 */
void gmi_wrench_add_tip(const gm_pair *pair, const gmi_engagement *at, const gmi_tip_load *load,
                        int role, int side_of_teeth, gm_wrench *wrench) {
    const double sign = gmi_side_sign(side_of_teeth);
    const double sine = at->sin_pressure_angle;
    const double cosine = at->cos_pressure_angle;
    const double e[2] = {sine, sign * cosine}, n[2] = {cosine, -sign * sine};
    const double base_sum = pair->pinion.base_radius + at->wheel_base_radius;
    const double tip_base = role == GM_PINION ? pair->pinion.base_radius : at->wheel_base_radius;
    const double per_length = 1.0 / at->line_of_action;
    const double turned = (tip_base * load->arm - base_sum * load->versine) * per_length;
    const double turned_t1 = (tip_base * load->arm_t1 - base_sum * load->versine_t1) * per_length;

    /* Force, its moments by the place along z, and those of the axial force by where the corner is. */
    const double away = role == GM_PINION ? -1.0 : 1.0;
    const double axial_share = -sign * pair->face_advance / pair->face_width;
    double force[2], z_force[2], axial[2];
    for (int k = 0; k < 2; ++k) {
        force[k] = turned * n[k] - load->versine * e[k];
        const double force_t1 = turned_t1 * n[k] - load->versine_t1 * e[k];
        z_force[k] = pair->face_start * force[k] + pair->face_width * force_t1;
        axial[k] = away * (load->across * n[k] + load->along * e[k]) * axial_share;
    }

    const double tilting[2] = {axial[1] - z_force[1], z_force[0] - axial[0]};
    const double shorter = sign * tip_base * load->arm;
    for (int k = 0; k < 2; ++k) {
        wrench->wheel_force[k] += force[k];
        wrench->wheel_moment[k] += tilting[k];
        wrench->pinion_force[k] -= force[k];
        wrench->pinion_moment[k] -= tilting[k];
    }
    if (role == GM_PINION) {
        wrench->pinion_moment[2] += shorter;
    } else {
        wrench->wheel_moment[2] += shorter;
    }
}

/*
 * As maps, in the frame of the drawing, where n is t: what is times sin(Delta) = (r_b gap' - (r_bp + r_bw) (1 - cos(Delta))) / T
 * and times 1 - cos(Delta). turned: force on the wheel for the triple's first number; arm: where its third one is.
 */
static gmi_wrench_map map_of_tip(const gm_pair *pair, const double turned[2], const double arm[2],
                                 double axial_share) {
    const double z = pair->face_start, width = pair->face_width;
    const gmi_wrench_map map = {.force = {turned[0], turned[1], 0.0},
                                .by_t1 = {-width * turned[1], width * turned[0]},
                                .by_rho = {axial_share * arm[1], -axial_share * arm[0], 0.0},
                                .pinion = {-z * turned[1], z * turned[0], 0.0},
                                .wheel = {-z * turned[1], z * turned[0], 0.0}};
    return map;
}

void gmi_wrench_map_tip(const gm_pair *pair, const gmi_engagement *at, int role, int part, int side,
                        gmi_wrench_map *map, gmi_wrench_map by[2]) {
    const double sign = gmi_side_sign(side);
    const gmi_plane plane = gmi_plane_of(at, sign);
    const double *e = plane.e, *n = plane.t;
    const double base_sum = pair->pinion.base_radius + at->wheel_base_radius;
    const double tip_base = role == GM_PINION ? pair->pinion.base_radius : at->wheel_base_radius;
    const double per_length = 1.0 / at->line_of_action;
    const double away = role == GM_PINION ? -1.0 : 1.0;
    const double axial_share = -away * sign * pair->face_advance / pair->face_width;

    /* Along n goes sin(Delta), against e the rest of the turn. */
    const int is_versine = part == GMI_TIP_VERSINE;
    const double along_n = (is_versine ? -base_sum : tip_base) * per_length;
    const double along_e = is_versine ? -1.0 : 0.0;
    const double turned[2] = {along_n * n[0] + along_e * e[0], along_n * n[1] + along_e * e[1]};
    *map = map_of_tip(pair, turned, is_versine ? e : n, axial_share);
    if (!is_versine) { /* the arm of the tip's own gear is shorter */
        *(role == GM_PINION ? &map->pinion[2] : &map->wheel[2]) = away * sign * tip_base;
    }

    /* As the wheel's axis moves, T changes and e turns towards n, n away from e. */
    for (int k = 0; k < 2; ++k) {
        const double turn = n[k] * per_length;
        const double along_n_by = -along_n * per_length * (e[k] + base_sum * turn);
        double turned_by[2], arm_by[2];
        for (int l = 0; l < 2; ++l) {
            turned_by[l] = along_n_by * n[l] + turn * (along_e * n[l] - along_n * e[l]);
            arm_by[l] = is_versine ? turn * n[l] : -turn * e[l];
        }
        by[k] = map_of_tip(pair, turned_by, arm_by, axial_share);
    }
}

/*
 * Friction acts across the line of action, on the wheel as the pinion's flank moves there: friction * (-sign cos(alpha),
 * sin(alpha), 0), at the same points. about_wheel: of the friction about that axis.
 */
static void add_friction(const gm_pair *pair, const double friction[GMI_WEIGHTS],
                         const double across[2], double about_pinion, double about_wheel,
                         gm_wrench *wrench) {
    const double force = friction[GMI_WHOLE];
    const double z_force = pair->face_start * force + pair->face_width * friction[GMI_BY_T1];
    const double on_wheel[2] = {force * across[0], force * across[1]};
    const double tilting[2] = {-z_force * across[1], z_force * across[0]};
    for (int k = 0; k < 2; ++k) {
        wrench->wheel_force[k] += on_wheel[k];
        wrench->wheel_moment[k] += tilting[k];
        wrench->pinion_force[k] -= on_wheel[k];
        wrench->pinion_moment[k] -= tilting[k];
    }
    wrench->pinion_moment[2] -= about_pinion;
    wrench->wheel_moment[2] += about_wheel;
}

/* About the pinion's axis the arm is rho_p, about the wheel's -rho_w. */
static void add_friction_as_it_acts(const gm_pair *pair, const gmi_engagement *at,
                                    const double friction[GMI_WEIGHTS], int side_of_teeth,
                                    gm_wrench *wrench) {
    const double across[2] = {-gmi_side_sign(side_of_teeth) * at->cos_pressure_angle,
                              at->sin_pressure_angle};
    const double about_pinion = friction[GMI_BY_RHO];
    add_friction(pair, friction, across, about_pinion,
                 about_pinion - at->line_of_action * friction[GMI_WHOLE], wrench);
}

void gmi_wrench_add_friction(const gm_pair *pair, const gmi_engagement *at,
                             const gmi_friction_sum *friction, int side_of_teeth,
                             gm_wrench *wrench) {
    const double weighted[GMI_WEIGHTS] = {[GMI_WHOLE] = friction->force.value,
                                          [GMI_BY_T1] = friction->force_t1,
                                          [GMI_BY_RHO] = friction->moment.value};
    add_friction_as_it_acts(pair, at, weighted, side_of_teeth, wrench);
}

/* As a map, and how it turns as the wheel's axis moves: the arm about that axis grows with T. */
static gmi_wrench_map map_of_friction(const gm_pair *pair, const double across[2], double length) {
    const double z = pair->face_start, width = pair->face_width;
    const gmi_wrench_map map = {.force = {across[0], across[1], 0.0},
                                .by_t1 = {-width * across[1], width * across[0]},
                                .by_rho = {0.0, 0.0, 0.0},
                                .pinion = {-z * across[1], z * across[0], 0.0},
                                .wheel = {-z * across[1], z * across[0], -length}};
    return map;
}

void gmi_wrench_map_friction(const gm_pair *pair, const gmi_engagement *at, int side,
                             gmi_wrench_map *map, gmi_wrench_map by[2]) {
    const double sign = gmi_side_sign(side);
    const gmi_plane plane = gmi_plane_of(at, sign);
    const double *e = plane.e, *t = plane.t;
    const double across[2] = {-sign * t[0], -sign * t[1]};
    *map = map_of_friction(pair, across, at->line_of_action);
    map->by_rho[2] = 1.0;

    const double base_sum = pair->pinion.base_radius + at->wheel_base_radius;
    for (int k = 0; k < 2; ++k) {
        const double turn = t[k] / at->line_of_action;
        const double across_by[2] = {sign * turn * e[0], sign * turn * e[1]};
        by[k] = map_of_friction(pair, across_by, e[k] + base_sum * turn);
    }
}

/* At tips, below: both arms together are longer by (r_bp + r_bw) sin(Delta) - T (1 - cos(Delta)). */
void gmi_wrench_map_tip_friction(const gm_pair *pair, const gmi_engagement *at, int part, int side,
                                 gmi_wrench_map *map, gmi_wrench_map by[2]) {
    const double sign = gmi_side_sign(side);
    const gmi_plane plane = gmi_plane_of(at, sign);
    const double *e = plane.e, *n = plane.t;
    const double base_sum = pair->pinion.base_radius + at->wheel_base_radius;
    const int is_sine = part == GMI_RUBBING_SINE;
    const double *along = is_sine ? e : n;
    const double across[2] = {sign * along[0], sign * along[1]};
    *map = map_of_friction(pair, across, is_sine ? base_sum : -at->line_of_action);

    for (int k = 0; k < 2; ++k) {
        const double turn = n[k] / at->line_of_action;
        const double across_by[2] = {sign * turn * (is_sine ? n[0] : -e[0]),
                                     sign * turn * (is_sine ? n[1] : -e[1])};
        by[k] = map_of_friction(pair, across_by, is_sine ? 0.0 : -(e[k] + base_sum * turn));
    }
}

/*
 * At a tip corner it acts across the turned normal: on the wheel -sign (cos(Delta) n - sin(Delta) e), with n, e and Delta as
 * above, where across the line of action is -sign n. Both arms together are the part of the centre distance along the
 * normal.
 */
void gmi_wrench_add_tip_friction(const gm_pair *pair, const gmi_engagement *at,
                                 const gmi_tip_friction *friction, int side_of_teeth,
                                 gm_wrench *wrench) {
    const double sign = gmi_side_sign(side_of_teeth);
    const double sine = at->sin_pressure_angle, cosine = at->cos_pressure_angle;
    const double e[2] = {sine, sign * cosine}, n[2] = {cosine, -sign * sine};
    double force[2], z_force[2];
    for (int k = 0; k < 2; ++k) {
        force[k] = sign * (friction->versine * n[k] + friction->sine * e[k]);
        const double force_t1 = sign * (friction->versine_t1 * n[k] + friction->sine_t1 * e[k]);
        z_force[k] = pair->face_start * force[k] + pair->face_width * force_t1;
    }

    const double tilting[2] = {-z_force[1], z_force[0]};
    for (int k = 0; k < 2; ++k) {
        wrench->wheel_force[k] += force[k];
        wrench->wheel_moment[k] += tilting[k];
        wrench->pinion_force[k] -= force[k];
        wrench->pinion_moment[k] -= tilting[k];
    }
    wrench->wheel_moment[2] -= friction->longer.value;
}

/* The same vector, seen from axes that are turned back by the angle. */
static void turn(double vector[3], double cosine, double sine) {
    const double x = vector[0];
    vector[0] = cosine * x - sine * vector[1];
    vector[1] = sine * x + cosine * vector[1];
}

void gmi_wrench_turn(gm_wrench *wrench, const double axis[2]) {
    const double cosine = axis[0];
    const double sine = axis[1];
    turn(wrench->pinion_force, cosine, sine);
    turn(wrench->pinion_moment, cosine, sine);
    turn(wrench->wheel_force, cosine, sine);
    turn(wrench->wheel_moment, cosine, sine);
}
