/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "model.h"

#include <math.h>

static const double micrometre = 1e-6;
static const double two_pi = 6.283185307179586;

/*
 * Absolute tolerance of x' / w0 in terms of that of x. Force errors come from x; x' only has to be good
 * enough not to spoil it. Between 10 and 30 the number of steps is smallest at the same error.
 */
static const double speed_tolerance_factor = 20.0;

/*
 * Absolute tolerance of the pinion's arc in terms of that of x. A shift of the phase moves the lines of
 * contact along the flanks, where form and contact length change by some um over some mm: a hundredth of
 * the same shift of x, and less.
 */
static const double arc_tolerance_factor = 10.0;

/*
 * Steps per tooth at least. With less, a solver that has met nothing for a while could step from tooth to
 * tooth and never see that the mesh changes in between.
 */
static const double steps_per_tooth = 8.0;

/*
 * Steps per natural vibration at least, where the response to the noise is not in the state: the state may
 * be at rest while that response lifts the teeth off their mates for a while.
 */
static const double steps_per_vibration = 10.0;

/* Bounds of the damping ratio that the response to the noise is computed with: it has to forget, and to
 * vibrate. */
static const double smallest_ratio = 0.02, largest_ratio = 0.5;

/* Part of the mean contact length below which a contact is light. */
static const double light_contact = 0.5;

static double square(double value) {
    return value * value;
}

static void init_mesh(gear_model *model, const config *conf) {
    const gear_mesh *gears = model->gears;

    if (model->mesh == MODEL_SIMPLE) {
        model->stiffness = gears->simple_stiffness;
        model->damping = gears->simple_damping;
        model->mean_stiffness = gears->simple_stiffness;
    } else {
        model->stiffness = conf->stiffness;
        model->damping = conf->damping;
        model->mean_stiffness = conf->stiffness * gears->pair.transverse_contact_ratio;
    }
}

static void init_bodies(gear_model *model, const config *conf) {
    const double r_bp = model->gears->pair.pinion.base_radius;
    const double r_bw = model->gears->pair.wheel.base_radius;

    model->wheel_mobility = square(r_bw) / conf->wheel_inertia;
    model->torque_to_offset = r_bw / conf->wheel_inertia;

    if (model->drive.kind == DRIVE_SPEED) {
        /* A prescribed speed is an infinite inertia. */
        model->pinion_mobility = 0.0;
        model->drive_to_offset = r_bp * model->drive.acceleration;
        model->states = 2;
    } else {
        model->pinion_mobility = square(r_bp) / conf->pinion_inertia;
        model->drive_to_offset = r_bp * model->drive.torque / conf->pinion_inertia;
        model->states = 4;
    }
}

/* The flanks of one side of a gear; NULL = ideal. */
static const gm_flank_tables *side_of(const gm_flanks *flanks, int side) {
    if (flanks == NULL) {
        return NULL;
    }
    return side == GM_DRIVE ? &flanks->drive : &flanks->coast;
}

/* Steepest rise along the profile of any table, over one cell: bilinear between its nodes (m). */
static double steepest_cell(const gm_flank_tables *tables) {
    enum { NODE_DOUBLES = 4 }; /* the node's value is the first */
    const size_t lines = (size_t)tables->count * (size_t)tables->face_nodes;
    const size_t nodes = (size_t)tables->profile_nodes;
    double steepest = 0.0;

    for (size_t line = 0; line < lines; ++line) {
        const double *node = tables->values + line * nodes * NODE_DOUBLES;
        for (size_t i = 1; i < nodes; ++i) {
            const double rise = node[i * NODE_DOUBLES] - node[(i - 1) * NODE_DOUBLES];
            steepest = fmax(steepest, fabs(rise));
        }
    }
    return steepest;
}

/* Adds what the flanks of one gear can do to meet their mates. */
static void add_flanks(gear_model *model, int side, const gm_flanks *flanks, const gm_gear *gear) {
    const gm_flank_tables *tables = side_of(flanks, side);
    if (tables == NULL) {
        return;
    }

    model->is_ideal[side] = 0;

    /* Ramps only take material away, so they do not count for the reach. */
    model->reach[side] += tables->peak;

    double steepest = 0.0;
    if (tables->count > 0) {
        steepest = steepest_cell(tables) * (double)(tables->profile_nodes - 1);
    }
    for (int i = 0; i < tables->ramp_count; ++i) {
        steepest += fabs(tables->ramps[i].per_t2);
    }
    model->slope[side] += steepest / (gear->tip_roll_length - gear->start_roll_length);
}

/* Bounds of the flanks for the look ahead in free flight; the simple model has ideal flanks. */
static void init_flanks(gear_model *model) {
    const gear_mesh *gears = model->gears;

    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        model->is_ideal[side] = 1;
        model->reach[side] = model->slope[side] = 0.0;
        if (model->mesh == MODEL_3D) {
            add_flanks(model, side, gears->pinion_flanks, &gears->pair.pinion);
            add_flanks(model, side, gears->wheel_flanks, &gears->pair.wheel);
        }
    }
}

static double mobility(const gear_model *model) {
    return model->pinion_mobility + model->wheel_mobility;
}

/* Response with the damping of the mesh itself, so that as little as possible is left to the solver. */
static int init_response(gear_model *model) {
    const double w0 = model->natural_frequency;
    const double pairs = model->mean_stiffness / model->stiffness;
    const double ratio = 0.5 * model->damping * pairs * mobility(model) / w0;
    const double bounded = fmin(fmax(ratio, smallest_ratio), largest_ratio);

    model->noise = NULL;
    model->response_decay = bounded * w0;
    if (response_is_useful(&model->load, w0)) {
        model->noise = response_create(&model->load, model->torque_to_offset, w0, bounded);
        return model->noise != NULL ? 0 : EXIT_RUN_FAILED;
    }
    return 0;
}

int model_init(gear_model *model, const config *conf, const gear_mesh *gears) {
    model->gears = gears;
    model->noise = NULL;
    model->lookup = NULL;
    model->mesh = conf->model;
    model->drive = drive_create(conf);
    model->load =
        load_create(conf->mean_load, conf->noise_amplitude, conf->noise_interval, conf->seed);
    init_mesh(model, conf);
    init_bodies(model, conf);
    init_flanks(model);

    model->natural_frequency = sqrt(model->mean_stiffness * mobility(model));
    if (init_response(model) != 0 || lookup_create(&model->lookup, conf, gears) != 0) {
        model_free(model);
        return EXIT_RUN_FAILED;
    }
    return 0;
}

void model_free(gear_model *model) {
    response_free(model->noise);
    lookup_free(model->lookup);
    model->noise = NULL;
    model->lookup = NULL;
}

/* ---------------------------------------------------------------------------------------------
 * Quasi-static start
 * ------------------------------------------------------------------------------------------- */

/* Smallest |x| for which the spring with backlash carries the force. */
static double simple_equilibrium(const gear_model *model, double force) {
    const double clearance = 0.5 * model->gears->pair.backlash;
    const double compression = fabs(force) / model->stiffness;

    /* Negative backlash: both flanks touch up to |x| = -clearance and push against each other. */
    const double size =
        compression < -2.0 * clearance ? 0.5 * compression : clearance + compression;

    return copysign(size, force);
}

static int equilibrium(const gear_model *model, double force, double *offset) {
    const gear_mesh *gears = model->gears;

    /* Nothing to carry: the middle of the backlash. */
    if (force == 0.0 && gears->pair.backlash >= 0.0) {
        *offset = 0.0;
        return GM_OK;
    }
    if (model->mesh == MODEL_SIMPLE) {
        *offset = simple_equilibrium(model, force);
        return GM_OK;
    }
    return gm_static_equilibrium(&gears->pair, gears->pinion_flanks, gears->wheel_flanks, 0.0,
                                 model->stiffness, force * gears->pair.wheel.base_radius, offset,
                                 NULL);
}

int model_quasi_static_start(const gear_model *model, double state[]) {
    /* x'' = 0: the force that balances drive and load, acceleration torque included. */
    const double applied = model->drive_to_offset + model->torque_to_offset * model->load.mean;
    double offset = 0.0;
    const int status = equilibrium(model, applied / mobility(model), &offset);

    state[STATE_OFFSET] = offset / micrometre;
    state[STATE_OFFSET_RATE] = 0.0;
    if (model->states == STATES_MAX) {
        const double r_bp = model->gears->pair.pinion.base_radius;

        state[STATE_PINION_ARC] = 0.0;
        state[STATE_PINION_SPEED] =
            r_bp * model->drive.start_speed / (model->natural_frequency * micrometre);
    }
    return status;
}

/* ---------------------------------------------------------------------------------------------
 * Right-hand side
 * ------------------------------------------------------------------------------------------- */

/* Part of x that is not in the state. */
static response_value noise_response(const gear_model *model, double time) {
    const response_value none = {0.0, 0.0};

    return model->noise != NULL ? response_at(model->noise, time) : none;
}

/* x'' or u'' without the force: what drive and load would do, and what p assumes of the mesh. */
static double applied_acceleration(const gear_model *model, double time,
                                   const response_value *noise) {
    if (model->noise == NULL) {
        return model->drive_to_offset + model->torque_to_offset * load_torque(&model->load, time);
    }
    return model->drive_to_offset + model->torque_to_offset * model->load.mean +
           2.0 * model->response_decay * noise->rate +
           square(model->natural_frequency) * noise->offset;
}

static double pinion_speed(const gear_model *model, double time, const double state[]) {
    if (model->states == STATES_MAX) {
        return state[STATE_PINION_SPEED] * model->natural_frequency * micrometre /
               model->gears->pair.pinion.base_radius;
    }
    return drive_at(&model->drive, time).speed;
}

static double pinion_angle(const gear_model *model, double time, const double state[]) {
    if (model->states == STATES_MAX) {
        return state[STATE_PINION_ARC] * micrometre / model->gears->pair.pinion.base_radius;
    }
    return drive_at(&model->drive, time).angle;
}

double model_speed_unit(const gear_model *model) {
    return model->natural_frequency * micrometre;
}

static gear_motion motion_with(const gear_model *model, double time, const double state[],
                               const response_value *noise) {
    const double speed_unit = model_speed_unit(model);
    const gear_motion motion = {
        .pinion_angle = pinion_angle(model, time, state),
        .pinion_speed = pinion_speed(model, time, state),
        .offset = state[STATE_OFFSET] * micrometre + noise->offset,
        .offset_rate = state[STATE_OFFSET_RATE] * speed_unit + noise->rate,
    };

    return motion;
}

gear_motion model_motion(const gear_model *model, double time, const double state[]) {
    const response_value noise = noise_response(model, time);

    return motion_with(model, time, state, &noise);
}

/* The one of the library's exact functions that does no more than is asked for. */
static int exact_penetration(const gear_model *model, const gear_motion *motion, int derivatives,
                             gm_penetration *penetration) {
    const gear_mesh *gears = model->gears;

    if (model->mesh == MODEL_SIMPLE) {
        return gm_penetration_simple_at(&gears->pair, motion->offset, motion->offset_rate,
                                        penetration);
    }

    gm_position position;
    const int status = gm_position_from_pinion_angle(
        &gears->pair, motion->pinion_angle, motion->offset, motion->offset_rate, &position);
    if (status != GM_OK) {
        return status;
    }
    return (derivatives ? gm_penetration_3d_at : gm_penetration_3d_sum_at)(
        &gears->pair, gears->pinion_flanks, gears->wheel_flanks, &position, penetration);
}

/* From the look-up if there is one. */
static int penetration_of(const gear_model *model, const gear_motion *motion, int derivatives,
                          gm_penetration *penetration) {
    if (model->lookup == NULL) {
        return exact_penetration(model, motion, derivatives, penetration);
    }

    gm_position position;
    const int status = gm_position_from_pinion_angle(
        &model->gears->pair, motion->pinion_angle, motion->offset, motion->offset_rate, &position);
    return status != GM_OK ? status
                           : gm_cache_penetration_at(model->lookup, &position, penetration);
}

int model_penetration(const gear_model *model, const gear_motion *motion,
                      gm_penetration *penetration) {
    return penetration_of(model, motion, 0, penetration);
}

int model_pairs(const gear_model *model, const gear_motion *motion, gm_penetration *penetration) {
    if (penetration->drive_pairs >= 0 && penetration->coast_pairs >= 0) {
        return GM_OK;
    }

    gm_penetration exact;
    const int status = exact_penetration(model, motion, 0, &exact);
    penetration->drive_pairs = exact.drive_pairs;
    penetration->coast_pairs = exact.coast_pairs;
    return status;
}

double model_force(const gear_model *model, const gm_penetration *penetration) {
    return gm_contact_force(model->stiffness, model->damping, penetration);
}

static enum mesh_contact contact_of(const gear_model *model, const gm_penetration *penetration,
                                    double force) {
    const double touching = penetration->drive_contact + penetration->coast_contact;
    if (touching == 0.0) {
        return MESH_FREE;
    }

    /* Flanks that would have to pull carry nothing either. */
    const double pairs = model->mean_stiffness / model->stiffness;
    return force == 0.0 || touching < light_contact * pairs ? MESH_LIGHT : MESH_CARRIES;
}

int model_derivative(const gear_model *model, double time, const double state[],
                     double derivative[], enum mesh_contact *contact) {
    /* Once: next to the mesh it is the dearest part. */
    const response_value noise = noise_response(model, time);
    const gear_motion motion = motion_with(model, time, state, &noise);
    gm_penetration penetration;
    const int status = model_penetration(model, &motion, &penetration);
    if (status != GM_OK) {
        return status;
    }

    const double w0 = model->natural_frequency;
    const double to_state = 1.0 / (w0 * micrometre);
    const double force = model_force(model, &penetration);
    const double applied = applied_acceleration(model, time, &noise);
    *contact = contact_of(model, &penetration, force);

    derivative[STATE_OFFSET] = w0 * state[STATE_OFFSET_RATE];
    derivative[STATE_OFFSET_RATE] = (applied - mobility(model) * force) * to_state;

    if (model->states == STATES_MAX) {
        derivative[STATE_PINION_ARC] = w0 * state[STATE_PINION_SPEED];
        derivative[STATE_PINION_SPEED] =
            (model->drive_to_offset - model->pinion_mobility * force) * to_state;
    }
    return GM_OK;
}

/* ---------------------------------------------------------------------------------------------
 * Jacobian
 * ------------------------------------------------------------------------------------------- */

typedef struct force_gradient {
    double by_offset;      /* dF/dx at fixed phi_p (N/m) */
    double by_offset_rate; /* dF/dx' (N s/m) */
    double by_arc;         /* dF/d(r_bp phi_p) at fixed x (N/m) */
} force_gradient;

/*
 * At fixed phi_p a change of x is one of -phi_w; at fixed x, phi_w follows phi_p by r_bp / r_bw. How the
 * touching width, and with it the damping, changes with x is left out: it is of second order in the
 * motion, and Newton's iteration corrects it.
 */
static force_gradient gradient(const gear_model *model, const gm_penetration *penetration) {
    const gm_pair *pair = &model->gears->pair;
    const double k = model->stiffness;
    const double d = model->damping;

    /* A flank that would have to pull gives no force, and no derivative. */
    const int drive = k * penetration->drive + d * penetration->drive_rate > 0.0;
    const int coast = k * penetration->coast + d * penetration->coast_rate > 0.0;
    const double stiffness = drive || coast ? k : 0.0;

    const force_gradient result = {
        .by_offset = -stiffness * penetration->d_wheel_angle / pair->wheel.base_radius,
        .by_offset_rate = d * ((drive ? penetration->drive_contact : 0.0) +
                               (coast ? penetration->coast_contact : 0.0)),
        .by_arc = stiffness * (penetration->d_pinion_angle / pair->pinion.base_radius +
                               penetration->d_wheel_angle / pair->wheel.base_radius),
    };
    return result;
}

/* Row of a speed on which the force acts with the given mobility. */
static void speed_row(double jacobian[STATES_MAX][STATES_MAX], int row, const gear_model *model,
                      double row_mobility, const force_gradient *force) {
    const double w0 = model->natural_frequency;

    jacobian[STATE_OFFSET][row] = -row_mobility * force->by_offset / w0;
    jacobian[STATE_OFFSET_RATE][row] = -row_mobility * force->by_offset_rate;
    jacobian[STATE_PINION_ARC][row] = -row_mobility * force->by_arc / w0;
    jacobian[STATE_PINION_SPEED][row] = 0.0;
}

/* Row of a coordinate: its derivative is w0 times its speed. */
static void coordinate_row(double jacobian[STATES_MAX][STATES_MAX], int row, int speed, double w0) {
    for (int column = 0; column < STATES_MAX; ++column) {
        jacobian[column][row] = column == speed ? w0 : 0.0;
    }
}

int model_jacobian(const gear_model *model, double time, const double state[],
                   double jacobian[STATES_MAX][STATES_MAX]) {
    const gear_motion motion = model_motion(model, time, state);
    gm_penetration penetration;
    const int status = penetration_of(model, &motion, 1, &penetration);
    if (status != GM_OK) {
        return status;
    }

    const double w0 = model->natural_frequency;
    const force_gradient force = gradient(model, &penetration);

    coordinate_row(jacobian, STATE_OFFSET, STATE_OFFSET_RATE, w0);
    speed_row(jacobian, STATE_OFFSET_RATE, model, mobility(model), &force);
    coordinate_row(jacobian, STATE_PINION_ARC, STATE_PINION_SPEED, w0);
    speed_row(jacobian, STATE_PINION_SPEED, model, model->pinion_mobility, &force);

    return GM_OK;
}

/* ---------------------------------------------------------------------------------------------
 * Steps and tolerances
 * ------------------------------------------------------------------------------------------- */

/* Time for a share of a tooth, from the speed at hand and the acceleration without contact. */
static double tooth_step(const gear_model *model, double time, const double state[]) {
    const gm_gear *pinion = &model->gears->pair.pinion;
    const double angle = pinion->pitch_angle / steps_per_tooth;
    const double speed = fabs(pinion_speed(model, time, state));
    const double acceleration = fabs(model->drive_to_offset) / pinion->base_radius;
    const double reach = speed + sqrt(speed * speed + 2.0 * acceleration * angle);

    return reach > 0.0 ? 2.0 * angle / reach : 0.0;
}

/* Time for a share of a natural vibration. */
static double vibration_step(const gear_model *model) {
    return two_pi / (steps_per_vibration * model->natural_frequency);
}

double model_max_step(const gear_model *model, double time, const double state[]) {
    const double tooth = model->mesh == MODEL_3D ? tooth_step(model, time, state) : 0.0;
    const double vibration = model->noise != NULL ? vibration_step(model) : 0.0;

    return tooth > 0.0 && vibration > 0.0 ? fmin(tooth, vibration) : fmax(tooth, vibration);
}

void model_error_weights(const gear_model *model, double relative_tolerance,
                         double absolute_tolerance, const double state[], double weights[]) {
    const double offset_tolerance = absolute_tolerance / micrometre;
    const double speed_tolerance = speed_tolerance_factor * offset_tolerance;
    const double clearance = 0.5 * fabs(model->gears->pair.backlash) / micrometre;

    /* Relative to the penetration: half the backlash is a choice of where zero is. */
    const double depth = fmax(fabs(state[STATE_OFFSET]) - clearance, 0.0);

    weights[STATE_OFFSET] = 1.0 / (relative_tolerance * depth + offset_tolerance);
    weights[STATE_OFFSET_RATE] =
        1.0 / (relative_tolerance * fabs(state[STATE_OFFSET_RATE]) + speed_tolerance);

    /* The angle grows without end; a tolerance relative to it would soon be wider than a tooth. */
    if (model->states == STATES_MAX) {
        weights[STATE_PINION_ARC] = 1.0 / (arc_tolerance_factor * offset_tolerance);
        weights[STATE_PINION_SPEED] = 1.0 / (arc_tolerance_factor * speed_tolerance);
    }
}
