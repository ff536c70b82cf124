/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Two gears at a centre distance, and the pair as it is posed: where it is, and how fast its flanks approach each
 * other.
 */
#ifndef GEARMESH_MESHING_H
#define GEARMESH_MESHING_H

#include "internal.h"

/* Of both base radii: the sum, and below 0 the difference of a ring's pair (m). */
static inline double gmi_base_sum(const gm_pair *pair) {
    return pair->pinion.base_radius + pair->wheel.sign * pair->wheel.base_radius;
}

/*
 * What depends on the centre distance, the gears staying as drawn; the names are those of gm_pair. At the drawing's own
 * distance the numbers are the drawing's, to the last bit.
 */
typedef struct gmi_meshing {
    double center_distance;        /* (m) */
    double line_of_action;         /* T (m) */
    double working_pressure_angle; /* alpha_wt (rad) */
    double involute_difference;    /* inv(alpha_wt) - inv(alpha_t) (1) */
    double backlash;               /* transverse, along the line of action (m) */

    /* [enum gm_role] where the active profile starts at this distance (m) */
    double start_roll_length[2];

    double path_start, path_end;     /* at zero penetration, from the pinion's tangent point (m) */
    double transverse_contact_ratio; /* (1) */

    /* [side] rho_p of tooth 0 at phi_p = 0 where the common face begins (m) */
    double phase_origin[2];

    double working_pitch_radius[2]; /* [enum gm_role] (m) */
    double tip_clearance[2];        /* [enum gm_role] from this gear's tip to the mate's root (m) */
} gmi_meshing;

/* 1 if the gears mesh there: the line of action and the path of contact on it are longer than 0; else 0. */
int gmi_meshing_find(const gm_pair *pair, double center_distance, gmi_meshing *meshing);

/* What is in the way of a ring's pair. */
enum gmi_interference {
    GMI_CLEAR,
    GMI_INVOLUTE_INTERFERENCE, /* the ring's tip reaches beyond the pinion's tangent point */
    GMI_TROCHOID_INTERFERENCE, /* the tips meet beside the path of contact */
    GMI_TRIMMING               /* the tips meet when the pinion is moved in along the centre line */
};

enum gmi_interference gmi_meshing_interference(const gm_pair *pair, const gmi_meshing *meshing);

/* Where the active profile starts: as given, else where it meets the mate's tip; T of a ring's pair is below 0 (m). */
double gmi_start_roll_length(const gm_gear *gear, const gm_gear *mate, double line_of_action);

/* The first part of it, which needs no teeth: line_of_action, working_pressure_angle, involute_difference. */
void gmi_meshing_find_angles(const gm_pair *pair, double center_distance, gmi_meshing *meshing);

/*
 * The pair as it is posed: all of it that moves. t1 runs over the common face of the drawing, also where the faces have
 * moved against each other. Without a pose it is the drawing, to the last bit. The signs are those of ISO 21771, so that
 * what evaluates it knows nothing of rings: lengths of a ring, the centre distance and T are then below 0.
 */
typedef struct gmi_engagement {
    double center_distance;        /* x of the wheel's axis (m) */
    double working_pressure_angle; /* alpha_wt (rad) */
    double sin_pressure_angle, cos_pressure_angle;
    double line_of_action;                /* T = rho_p + rho_w of points that touch (m) */
    double wheel_base_radius;             /* (m) */
    double backlash;                      /* (m) */
    double phase_origin[2];               /* [side] as in gm_pair (m) */
    double start_roll_length[2];          /* [enum gm_role] where the active profile begins (m) */
    int start_follows[2];                 /* 1 where that follows the mate's tip as T changes */
    int starts_deeper[2];                 /* 1 where that is nearer to the root than as drawn */
    double tip_roll_length[2];            /* [enum gm_role] where it ends (m) */
    double wheel_profile_start;           /* roll length of the wheel's t2 = 0 (m) */
    double face_from, face_to;            /* t1 between which both gears have a face */
    double face_origin[2], face_scale[2]; /* [enum gm_role] own t1 = face_origin + face_scale t1 */

    /* From the coordinates of the drawing to those of the posed pair; 0 without a pose. */
    double offset_shift; /* added to x (m) */
    double phase_shift;  /* added to the phase (m) */

    /* of the wheel's axis, seen from the pinion's, counter-clockwise from +x (rad) */
    double axis_direction;
    double axis[2]; /* its unit vector */

    /* The wheel's rotation vector about the middle of its own face, along the line of action and across it. */
    int is_tilted;
    double along[2], across[2]; /* [side] -+theta.e, -+theta.t, upper signs drive (rad) */
    double face_center;         /* z of that middle (m) */
} gmi_engagement;

static inline int gmi_is_at_rest(const gm_pose *pose) {
    return pose->center_distance_change == 0.0 && pose->offset == 0.0 && pose->axial_shift == 0.0 &&
           pose->skew == 0.0 && pose->inclination == 0.0;
}

/* How fast the flanks of one side approach each other: the same all over it but for what a tilt does. */
typedef struct gmi_rates {
    double delta;         /* of parallel axes (m/s) */
    double along, across; /* d gmi_engagement.along / dt, d across / dt (rad/s) */

    /* Of the wheel's body across the line of action, as friction has it, and along it, at t1 = 0 and more per t1 (m/s). */
    double sideways[2], forward[2];
} gmi_rates;

/* Line of action of a side in the transverse section: e along it, t across, clockwise from e on the drive side. */
typedef struct gmi_plane {
    double e[2], t[2];
} gmi_plane;

static inline gmi_plane gmi_plane_of(const gmi_engagement *at, double sign) {
    const double s = at->sin_pressure_angle, c = sign * at->cos_pressure_angle;
    const double e[2] = {at->axis[0] * s - at->axis[1] * c, at->axis[1] * s + at->axis[0] * c};
    const gmi_plane plane = {{e[0], e[1]}, {sign * e[1], -sign * e[0]}};
    return plane;
}

void gmi_rates_find(const gm_pair *pair, const gmi_engagement *at, double offset_rate,
                    const gm_pose *pose_rate, gmi_rates rates[2]);

/* NULL = no pose. Returns GM_OK, GM_STATE_NOT_FINITE or GM_POSE_OUT_OF_MESH. */
int gmi_engagement_find(const gm_pair *pair, const gm_pose *pose, gmi_engagement *engagement);

#endif
