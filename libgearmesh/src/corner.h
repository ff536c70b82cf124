/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Corner contact: before and after the ideal path of contact the tip edge of one gear touches the flank of its mate, off
 * the line of action. All in the transverse section and in the signs of ISO 21771, so that rings are the same.
 */
#ifndef GEARMESH_CORNER_H
#define GEARMESH_CORNER_H

#include "contact.h"
#include "friction.h"
#include "internal.h"
#include "line.h"
#include "meshing.h"
#include "side_tangent.h"
#include "wrench.h"

/* The tip corner of one gear, as it comes to the mate's flank or goes off it. */
typedef struct gmi_corner {
    double tip_base;       /* r_b of the gear whose tip it is (m) */
    double mate_base;      /* of the gear whose flank it touches (m) */
    double line_of_action; /* T (m) */
    double tip_roll;       /* rho_a (m) */
    double mate_roll;      /* of the flank touched, at the end of the path: T - rho_a (m) */
    double along, across;  /* of the centre distance times r_a: the parts of its way (m2) */
    double reach;          /* roll beyond the path after which it is off the mate's flank (m) */
    double coarse, fine; /* width of a parabola of the gap far from the path, and at its end (m) */
} gmi_corner;

/* Where the corner is after some roll beyond the end of the path. */
typedef struct gmi_corner_place {
    double gap;           /* between corner and flank: what the overlap falls by (m) */
    double by_roll;       /* its first derivative by the roll (1) */
    double by_roll_twice; /* and the second (1/m) */
    double by_length;     /* its derivative by T (1) */
    double mate_roll;     /* roll length of the flank touched, its radius of curvature there (m) */

    /* From the point of the line of action with the same roll: away from the mate's axis, and along the line (m). */
    double across, along;
    double across_by_roll, along_by_roll; /* (1) */

    /* Turn of the normal from the line of action, with the axes held: the angle (rad), and 1 - cos of it. */
    double turn, versine;
    double versine_by_roll;
    double versine_by_length; /* and by T (1/m) */

    /* By how much roll lengths of the flank touched are longer than on the line of action (m). */
    double gain;
    double gain_by_roll, gain_by_length;

    /* Of that normal about the axis of the tip: d overlap / d angle (m). About the other axis it is mate_base. */
    double tip_arm;
} gmi_corner_place;

/*
 * role: enum gm_role of the gear whose tip it is: the wheel's where a pair enters, the pinion's where it leaves. Returns 0
 * if the tip reaches beyond the mate's base tangent point, or closer than a hundredth of the base pitch: there is no flank
 * to touch.
 */
int gmi_corner_init(const gm_pair *pair, const gmi_engagement *at, int role, gmi_corner *corner);

/* roll: of the gear whose tip it is, beyond the end of the path, 0 .. reach (m). Basic arithmetic and roots alone. */
void gmi_corner_at(const gmi_corner *corner, double roll, gmi_corner_place *place);

/* The gap after each of many rolls, with both derivatives by the roll: arrays that do not overlap. */
void gmi_corner_gaps(const gmi_corner *corner, int count, const double *roll, double *gap,
                     double *by_roll, double *by_roll_twice);

/* What lines that go on there need of it, at one roll. */
typedef struct gmi_corner_joint {
    double gap, slope;
    double versine, across, along, gain;
    double versine_by_roll, versine_by_length;
    double gain_by_roll, gain_by_length;
    double across_by_roll, along_by_roll; /* of spur gears */
} gmi_corner_joint;

void gmi_corner_joint_at(const gmi_corner *corner, double roll, gmi_corner_joint *found);

/*
 * The force of the parts of all lines of a side that are beyond the tip of one gear, in the transverse section, with
 * weights; of the stiffness and of damping.
 */
typedef struct gmi_tip_load {
    double contact; /* touching part of the lines there (1) */
    double arm,
        arm_t1; /* times gap', what the arm of the tip's gear is shorter by, over its r_b; and times t1 (N) */
    double versine, versine_t1;         /* times that of the turn of the normal; and times t1 (N) */
    double across, along;               /* times those of gmi_corner_place (N m) */
    double arm_by_origin, arm_by_delta; /* derivatives of arm (N/m) */
    double arm_by_speed;                /* and by the speed of approach (N s/m) */
} gmi_tip_load;

/* One side: its sum, the force at both tips, [enum gm_role], and friction, as far as there is any. */
typedef struct gmi_corner_sums {
    gmi_side_sum side;
    gmi_tip_load tips[2];
    gmi_friction_sum friction;
    gmi_tip_friction tip_friction;
} gmi_corner_sums;

/*
 * corner_line.c: of a side whose lines go on beyond the path, at a speed of approach. wanted: GMI_MOMENTS and
 * GMI_DERIVATIVES, which here are those of the touching part too; sliding: NULL = without friction.
 */
void gmi_side_sum_corners(const gm_mesh *mesh, int side, const gm_position *position, int wanted,
                          double approach_speed, const gmi_sliding *sliding, gmi_corner_sums *sums);

/* What a tip makes of the wrench: its sums as two triples, each with weights as of a force. */
enum gmi_tip_part { GMI_TIP_TURNED, GMI_TIP_VERSINE, GMI_TIP_PARTS };
enum { GMI_TIP_OWN = GMI_BY_DELTA_RATE + 1 }; /* variables that these move with */

/* arm, arm_t1, across; and versine, versine_t1, along of gmi_tip_load; and how they move. */
typedef struct gmi_tip_tangent {
    double sum[GMI_TIP_PARTS][GMI_WEIGHTS];
    double by[GMI_TIP_PARTS][GMI_LOAD_VARIABLES][GMI_WEIGHTS];
} gmi_tip_tangent;

/* A side with corners, and how all of it moves with its coordinates: integrals over what touches, times the weights. */
typedef struct gmi_corner_tangent {
    gmi_rates rates;                             /* given */
    double sum[GMI_WEIGHTS];                     /* of the overlap (m) */
    double contact[GMI_WEIGHTS];                 /* of 1 (1) */
    double arm[GMI_WEIGHTS];                     /* of gmi_line_tangent.arm (m) */
    double sum_by[GMI_COORDINATES][GMI_WEIGHTS]; /* derivatives */
    double contact_by[GMI_COORDINATES][GMI_WEIGHTS];
    double flow_by
        [GMI_COORDINATES];   /* of the speed of approach, where the ends of what touches move */
    gmi_tip_tangent tips[2]; /* [enum gm_role] */
    gmi_line_tangent line;   /* at hand */
} gmi_corner_tangent;

/* corner_line.c: of a side that is not clear, but for friction. */
void gmi_side_sum_corner_tangent(const gm_mesh *mesh, int side, const gm_position *position,
                                 gmi_corner_tangent *tangent);

/* Friction: as if on the line of action, with its arm about the pinion's axis; and at tips times sine and versine of the turn. */
enum gmi_rubbing_part {
    GMI_RUBBING_FLANKS,
    GMI_RUBBING_SINE,
    GMI_RUBBING_VERSINE,
    GMI_RUBBING_PARTS
};

typedef struct gmi_corner_rubbing {
    gmi_rates rates; /* given */
    double force,
        force_by[GMI_TIP_OWN]; /* normal force at the speed of approach of parallel axes (N) */
    double sum[GMI_RUBBING_PARTS][GMI_WEIGHTS];
    double by[GMI_RUBBING_PARTS][GMI_TIP_VARIABLES][GMI_WEIGHTS];
    gmi_line_tangent line; /* at hand */
} gmi_corner_rubbing;

/* The friction of the same side. */
void gmi_side_sum_corner_rubbing(const gm_mesh *mesh, int side, const gm_position *position,
                                 const gmi_sliding *sliding, gmi_corner_rubbing *rubbing);
void gmi_wrench_map_tip_friction(const gm_pair *pair, const gmi_engagement *at, int part, int side,
                                 gmi_wrench_map *map, gmi_wrench_map by[2]);

/* wrench.c: the wrench of a tip as a map of one of its triples; and how it changes as the wheel's axis moves. */
void gmi_wrench_map_tip(const gm_pair *pair, const gmi_engagement *at, int role, int part, int side,
                        gmi_wrench_map *map, gmi_wrench_map by[2]);

/* The reach by T (1). */
double gmi_corner_reach_by_length(const gmi_corner *corner);

/* The roll at which the gap is as large as an overlap, or the corner is off the flank; 0 for an overlap <= 0 (m). */
double gmi_corner_touch(const gmi_corner *corner, double overlap);

/* wrench.c: what the tip of one gear changes. */
void gmi_wrench_add_tip(const gm_pair *pair, const gmi_engagement *at, const gmi_tip_load *load,
                        int role, int side_of_teeth, gm_wrench *wrench);

/* And the friction at both. */
void gmi_wrench_add_tip_friction(const gm_pair *pair, const gmi_engagement *at,
                                 const gmi_tip_friction *friction, int side_of_teeth,
                                 gm_wrench *wrench);

/* The tips of both gears at one engagement, [enum gm_role]; 0 where one of them has no flank to touch. */
int gmi_corners_init(const gm_pair *pair, const gmi_engagement *at, gmi_corner corners[2]);

#endif
