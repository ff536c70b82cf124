/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The equations of motion as a first-order system, and their Jacobian.
 *
 *     x  = r_bp phi_p - r_bw phi_w
 *     x'' = r_bp alpha_p + r_bw M_w / I_w - r_bw T_w / I_w
 *
 * with the torque T_w that the mesh gives to the wheel, and the prescribed alpha_p, or
 * alpha_p = (M_p - c_p phi_p' - T_p) / I_p if the pinion is driven by a torque. Without friction T_w = F r_bw and
 * T_p = F r_bp. M_w contains the wheel's drag c_w phi_w', what of the load follows its speed, and ripple over phi_p, as M_p
 * does. Both cases read
 * x'' = a - mobility F, where a is what drive, load and drag would do to x without contact, and the mobility
 * is what a force of 1 N along the line of action does; with friction mobility F is what both torques do.
 *
 * The solver's state is scaled to the size of the vibration: micrometres, and micrometres times the
 * natural frequency. With an absolute wheel angle of thousands of radians as state, its tolerance
 * would swallow the whole penetration.
 *
 * With a noisy load the state is not x but u = x - p, where p(t) is what the noise does to a linear mesh,
 * known as a series (response.h). As p'' = noise - 2 zeta w0 p' - w0^2 p,
 *
 *     u'' = a(t) without the noise + 2 zeta w0 p' + w0^2 p - mobility F(u + p, u' + p').
 */
#ifndef GEARSIM_MODEL_H
#define GEARSIM_MODEL_H

#include "drive.h"
#include "gear_mesh.h"
#include "load.h"
#include "mesh_cache.h"
#include "response.h"

/* Places in the state vector. A prescribed speed needs the first two only. */
enum model_state {
    STATE_OFFSET,       /* u / 1 um */
    STATE_OFFSET_RATE,  /* u' / (w0 1 um) */
    STATE_PINION_ARC,   /* r_bp phi_p / 1 um */
    STATE_PINION_SPEED, /* r_bp phi_p' / (w0 1 um) */
    STATES_MAX
};

typedef struct gear_model {
    const gear_mesh *gears;
    enum mesh_model mesh;
    int jumps; /* the force does, where a pair of spur gears comes or goes */
    pinion_drive drive;
    load_signal load;
    double pinion_mobility;  /* r_bp^2 / I_p, 0 if its speed is prescribed (1/kg) */
    double wheel_mobility;   /* r_bw^2 / I_w (1/kg) */
    double moved_mass;       /* what a force on both accelerates: 1 over the sum of both (kg) */
    double torque_to_offset; /* r_bw / I_w: from the load to x'' (1/(kg m)) */
    double pinion_inertia;   /* I_p, infinite if its speed is prescribed (kg m2) */
    double torque_to_pinion; /* r_bp / I_p: from the pinion's torque to x'' (1/(kg m)) */
    double pinion_drag;      /* c_p (N m s) */
    double wheel_drag;       /* c_w (N m s) */
    int torques_follow; /* load, its drag or a ripple over the pinion's angle follow the motion */
    double natural_frequency;  /* w0 (rad/s) */
    double per_frequency;      /* 1 / w0 (s) */
    double to_state;           /* from x'' to the derivative of its state (s2/m 1/s) */
    double damping_time;       /* of the mesh, its damping over its stiffness (s) */
    double step_angle;         /* most that the pinion may turn in a step, HUGE_VAL = any (rad) */
    double longest_noisy_step; /* beside the response to the noise, 0 = any (s) */
    double response_decay;     /* zeta w0 of the response (1/s) */
    response *noise;           /* to the noise; NULL: the load is as it is, and u = x */
    gm_cache *cache;           /* that the mesh answers from; NULL: exactly */
    int is_ideal[2];           /* [side] neither flank deviates: the gap depends on x alone */
    double reach[2];           /* [side] highest points of both flanks together (m) */
    double slope[2];           /* [side] steepest rise of both along the profile together (m/m) */
    int states;
} gear_model;

/* What the flanks do in a state. */
enum mesh_contact {
    MESH_FREE, /* nothing touches: x is in free flight */
    MESH_LIGHT, /* a small part of the lines touches, or flanks part so fast that they carry nothing */
    MESH_CARRIES
};

/* Motion in SI units. */
typedef struct gear_motion {
    double pinion_angle;
    double pinion_speed;
    double offset;      /* x (m) */
    double offset_rate; /* x' (m/s) */
} gear_motion;

/* Returns 0, or EXIT_RUN_FAILED if there is no memory. */
int model_init(gear_model *model, const config *conf, const gear_mesh *gears);
void model_free(gear_model *model);

/* State in which x' = x'' = 0 at the mean load, drag and speed included. Returns a library status. */
int model_quasi_static_start(const gear_model *model, double state[]);

/* x' of 1 in the state (m/s). */
double model_speed_unit(const gear_model *model);

gear_motion model_motion(const gear_model *model, double time, const double state[]);

/* The pinion's part of the motion where its speed is prescribed; the rest is 0. */
gear_motion model_prescribed_motion(const gear_model *model, double time);

/*
 * The edge of a mean: the motion there, with the part of x' that the noise has not made, which changes by the force and the
 * other torques alone (m/s). Where the response to the noise is not known (model->noise), it is all of x'.
 */
typedef struct model_edge {
    double momentum;
    double given; /* x' by the load's noise so far, 0 where it has no response (m/s) */
    gear_motion motion;
} model_edge;

/* What of the motion at edges is wanted beside x' (a sum). */
enum edge_wanted { EDGE_MOMENTUM = 0, EDGE_OFFSET = 1, EDGE_PINION = 2 };

/* For states at times, no more than MODEL_EDGES_MAX. What is not wanted is 0. */
enum { MODEL_EDGES_MAX = 64 };
void model_edges(const gear_model *model, int count, const double times[],
                 const double *const states[], int wanted, model_edge edges[]);

/* Force and contact of the mesh; wanted: a sum of enum gm_wanted. Returns a library status. */
int model_evaluate(const gear_model *model, const gear_motion *motion, int wanted,
                   gm_mesh_result *result);

/* Pairs that touch; of a pair of one half. Returns a library status. */
int model_count_pairs(const gear_model *model, const gear_motion *motion, int *pairs);

/* Speed of the wheel in a motion (rad/s). */
double model_wheel_speed(const gear_model *model, const gear_motion *motion);

/* M_w in a motion, without the drag: what the column of the load shows (N m). */
double model_load(const gear_model *model, double time, const gear_motion *motion);

/* What drive, load and drag do, at a time or in the mean over one. */
typedef struct model_torques {
    double drive; /* x'' that drive and pinion's drag cause (m/s2) */
    double load;  /* M_w without drag and noise (N m) */
    double drag;  /* of the wheel (N m) */
} model_torques;

model_torques model_applied(const gear_model *model, double time, const gear_motion *motion);

/* How a mean is weighted: by straight lines between the weights at both ends, over one or two times in a row. */
typedef struct mean_weight {
    double time[3];
    double weight[2][2];
} mean_weight;

/* Mean of what depends on time alone, without the noise; of the pinion's acceleration as it is given. */
model_torques model_mean_over_time(const gear_model *model, const mean_weight *weight,
                                   double pinion_acceleration);

/* The parts of it that are linear in both speeds, and those that follow the motion in any other way. */
model_torques model_by_speeds(const gear_model *model, double pinion_speed, double wheel_speed);
model_torques model_by_motion(const gear_model *model, const gear_motion *motion);

/* Whether there is any such part. */
int model_follows_motion(const gear_model *model);

/* Time in which they change so little that a polynomial describes them (s). */
double model_smooth_time(const gear_model *model, const gear_motion *motion);

/*
 * Mean of the force over a time in which the torques (noise included) and x'' (m/s2) have the means given: the momentum
 * that neither load nor drive accounts for has come through the mesh. Exact, whatever the force does meanwhile.
 */
double model_mean_force(const gear_model *model, const model_torques *mean, double acceleration);

/* Motion as long as nothing touches. */
typedef struct model_flight {
    double acceleration;        /* x'' without the noise (m/s2) */
    double pinion_acceleration; /* (rad/s2) */
    double jerk;                /* most that both change by, until the horizon (m/s3, rad/s3) */
    double pinion_jerk;
} model_flight;

model_flight model_without_contact(const gear_model *model, double time, const gear_motion *motion,
                                   double horizon);

/* d state / dt, and the contact that it belongs to. Returns a library status: > 0 a smaller step may help,
 * < 0 it cannot. */
int model_derivative(const gear_model *model, double time, const double state[],
                     double derivative[], enum mesh_contact *contact);

/* How the derivative follows the state, from what every evaluation knows. */
typedef struct model_tangent {
    double jacobian[STATES_MAX]
                   [STATES_MAX]; /* [column][row]: d derivative[row] / d state[column] */
    double carried;              /* what the mesh takes off the derivative of x' */
    double touching;             /* part of the flanks that touches, of both sides, */
    int is_spring;               /* and whether all of that carries, as a spring and a damper do */
} model_tangent;

/*
 * The same with its tangent. The mesh is in it as the part of the flanks that touches: force by x and x'. How the force
 * follows the pinion's angle at the same x is left out, and so is what friction adds to the torques: some per cent.
 */
int model_derivative_and_tangent(const gear_model *model, double time, const double state[],
                                 double derivative[], model_tangent *tangent,
                                 enum mesh_contact *contact);

/* Next row of the tables behind a time, HUGE_VAL = there is none. At a kink the solver has to start again. */
double model_next_row(const gear_model *model, double time, int *is_kink);

/* A time before a row that is near to it, where what is before the row still counts. */
double model_before_row(const gear_model *model, double row);

/* Longest step at a time that cannot miss a tooth or a loss of contact (s); 0 = any. */
double model_max_step(const gear_model *model, double time, const double state[]);

/* The same for all steps that begin before a time, which is the one given where the next step may be another one. */
double model_held_step(const gear_model *model, double time, const double state[], double *until);

/* Reciprocals of the errors that the solver may make in one step; absolute tolerance of x in m, the
 * relative one of its part beyond the backlash. */
void model_error_weights(const gear_model *model, double relative_tolerance,
                         double absolute_tolerance, const double state[], double weights[]);

#endif
