/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "model.h"
#include "gear_contact.h"

#include <float.h>
#include <math.h>
#include <string.h>

static const double micrometre = 1e-6;
static const double per_micrometre = 1e6;
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

/* Of a tooth: a shorter time with one pair more or less than usual may be passed over. */
static const double least_share = 1.0 / 512.0;

/*
 * Steps per natural vibration at least, where the response to the noise is not in the state: the state may
 * be at rest while that response lifts the teeth off their mates for a while.
 */
static const double steps_per_vibration = 10.0;

/* Part of its speed that the pinion may gain or lose before its longest step is looked for again. */
static const double held_share = 1.0 / 512.0;

/* Bounds of the damping ratio that the response to the noise is computed with: it has to forget, and to
 * vibrate. */
static const double smallest_ratio = 0.02, largest_ratio = 0.5;

/*
 * Share of the tolerances for spur gears. Their sum of penetrations jumps, and each jump leaves an error of the size of
 * the tolerance with a sign by chance: noise about the natural frequency, which with the whole tolerances is only 25 dB
 * to 45 dB below the tooth orders.
 */
static const double share_of_jumps = 0.01;

/* Part of the mean contact length below which a contact is light. */
static const double light_contact = 0.5;

static double square(double value) {
    return value * value;
}

/* Of numbers, without the call that fmax() is for the sake of NaN. */
static double larger(double a, double b) {
    return a > b ? a : b;
}

static void init_bodies(gear_model *model, const config *conf) {
    const double r_bp = model->gears->pair.pinion.base_radius;
    const double r_bw = model->gears->pair.wheel.base_radius;

    /* What a force along the line of action, and a torque, do to the arcs of the base circles. */
    model->wheel_mobility = square(r_bw) / conf->wheel_inertia;
    model->torque_to_offset = r_bw / conf->wheel_inertia;

    if (model->drive.kind == DRIVE_SPEED) {
        /* A prescribed speed is an infinite inertia. */
        model->pinion_mobility = 0.0;
        model->pinion_inertia = HUGE_VAL;
        model->torque_to_pinion = 0.0;
        model->states = 2;
    } else {
        model->pinion_mobility = square(r_bp) / conf->pinion_inertia;
        model->pinion_inertia = conf->pinion_inertia;
        model->torque_to_pinion = r_bp / conf->pinion_inertia;
        model->states = 4;
    }

    /* Both together, and what holds them back. */
    model->moved_mass = 1.0 / (model->pinion_mobility + model->wheel_mobility);
    model->pinion_drag = conf->pinion_drag;
    model->wheel_drag = conf->wheel_drag;
}

/* Bounds of the flanks for the look ahead in free flight; the simple model has ideal flanks. */
static void init_flanks(gear_model *model) {
    const gear_mesh *gears = model->gears;
    const int has_flanks = model->mesh == MODEL_3D && !gear_contact_is_ideal(gears);

    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        model->is_ideal[side] = !has_flanks;
        model->reach[side] = has_flanks ? gear_contact_peak(gears, side) : 0.0;
        model->slope[side] = has_flanks ? gear_contact_slope(gears, side) : 0.0;
    }
}

static double mobility(const gear_model *model) {
    return model->pinion_mobility + model->wheel_mobility;
}

/* What the vibration of the mesh makes of it. */
static void init_vibration(gear_model *model) {
    const double stiffness = gear_contact_mean_stiffness(model->gears);
    const double w0 = sqrt(stiffness * mobility(model));

    model->natural_frequency = w0;
    model->per_frequency = 1.0 / w0;
    model->to_state = 1.0 / (w0 * micrometre);
    model->damping_time = gear_contact_mean_damping(model->gears) / stiffness;
}

/* Response with the damping of the mesh itself, so that as little as possible is left to the solver. */
static int init_response(gear_model *model) {
    const double w0 = model->natural_frequency;
    const double damping = gear_contact_mean_damping(model->gears);
    const double ratio = 0.5 * damping * mobility(model) / w0;
    const double bounded = fmin(fmax(ratio, smallest_ratio), largest_ratio);

    model->noise = NULL;
    model->response_decay = bounded * w0;
    if (response_is_useful(&model->load, w0)) {
        model->noise = response_create(&model->load, model->torque_to_offset, w0, bounded);
        return model->noise != NULL ? 0 : EXIT_RUN_FAILED;
    }
    return 0;
}

/* The most that any harmonic goes round in a turn of the pinion. */
static double highest_order(const gear_model *model) {
    return fmax(ripple_highest_order(&model->drive.ripple),
                ripple_highest_order(&model->load.ripple));
}

/*
 * Share of a tooth that a step may take. The force of a spur gear jumps twice in a tooth, where a pair comes and where
 * one leaves: if both are close together, all steps could pass over what lies between.
 */
static double tooth_share(const gear_model *model) {
    const gm_pair *pair = &model->gears->pair;
    const double usual = 1.0 / steps_per_tooth;
    const double rest = pair->transverse_contact_ratio - floor(pair->transverse_contact_ratio);
    const double between = fmin(rest, 1.0 - rest);

    return model->jumps ? fmin(usual, fmax(0.5 * between, least_share)) : usual;
}

/* Part of a turn that a step may take: of a tooth, which the simple model does not have, and of a ripple. */
static double step_angle(const gear_model *model) {
    const gm_pair *pair = &model->gears->pair;
    const double order = highest_order(model);
    const double wave = order > 0.0 ? two_pi / order / steps_per_tooth : HUGE_VAL;
    const double tooth =
        model->mesh == MODEL_3D ? tooth_share(model) * pair->pinion.pitch_angle : HUGE_VAL;

    return fmin(tooth, wave);
}

int model_init(gear_model *model, const config *conf, const gear_mesh *gears) {
    model->gears = gears;
    model->noise = NULL;
    model->cache = NULL;
    model->mesh = conf->model;
    model->jumps =
        conf->model == MODEL_3D && gears->pair.face_advance == 0.0 && !config_has_corners(conf);

    /* What drives, and what is carried. */
    if (drive_create(&model->drive, conf) != 0) {
        return EXIT_RUN_FAILED;
    }
    model->load =
        load_create(conf->mean_load, conf->noise_amplitude, conf->noise_interval, conf->seed);
    model->load.table = conf->load_table;
    model->load.ripple = conf->load_ripple;
    model->load.per_speed = conf->load_per_speed;
    model->load.per_speed_squared = conf->load_per_speed_squared;

    init_bodies(model, conf);
    init_flanks(model);
    init_vibration(model);

    if (init_response(model) != 0 || mesh_cache_create(&model->cache, conf, gears) != 0) {
        model_free(model);
        return EXIT_RUN_FAILED;
    }

    /* What is the same at every step. */
    model->torques_follow = model_follows_motion(model);
    model->step_angle = step_angle(model);
    model->longest_noisy_step =
        model->noise != NULL ? two_pi / steps_per_vibration * model->per_frequency : 0.0;
    return 0;
}

void model_free(gear_model *model) {
    drive_free(&model->drive);
    response_free(model->noise);
    mesh_cache_free(model->cache, model->gears);
    model->noise = NULL;
    model->cache = NULL;
}

/* ---------------------------------------------------------------------------------------------
 * Quasi-static start
 * ------------------------------------------------------------------------------------------- */

/* x'' that the mesh takes off: what its torques do to both bodies (m/s2). */
static double mesh_acceleration(const gear_model *model, const gm_mesh_result *mesh) {
    return model->torque_to_pinion * mesh->pinion_torque +
           model->torque_to_offset * mesh->wheel_torque;
}

/*
 * Where the mesh takes off the x'' that is applied. Without friction the torques are those of one force; with it they
 * share it by a little more or less, so that the wheel's is corrected by what the last one came to.
 */
static int equilibrium(const gear_model *model, double speed, double applied, double *offset) {
    enum { CORRECTIONS = 20 };
    const gear_mesh *gears = model->gears;
    double torque = applied / mobility(model) * gears->pair.wheel.base_radius;
    double guess = (double)NAN;
    int status = GM_OK;

    /* Nothing to carry: the middle of the backlash. */
    if (applied == 0.0 && gears->pair.backlash >= 0.0) {
        *offset = 0.0;
        return GM_OK;
    }

    /* Without friction the first one is right, and the share 1. */
    for (int k = 0; k < CORRECTIONS && status == GM_OK; ++k) {
        gm_mesh_result mesh;
        status = gear_contact_equilibrium(gears, 0.0, speed, torque, guess, offset, &mesh);
        const double share = mesh_acceleration(model, &mesh) / applied;
        if (fabs(share - 1.0) < 1e-12 || !(share > 0.0)) {
            break;
        }
        torque /= share;
        guess = *offset;
    }
    return status;
}

int model_quasi_static_start(const gear_model *model, double state[]) {
    const double start_speed =
        model->states == STATES_MAX ? model->drive.start_speed : drive_at(&model->drive, 0.0).speed;

    /* x' = x'' = 0: the force that balances drive, load and drag, acceleration torque included. */
    const gear_motion motion = {.pinion_speed = start_speed};
    const model_torques torques = model_applied(model, 0.0, &motion);
    const double applied = torques.drive + model->torque_to_offset * (torques.load + torques.drag);
    double offset = 0.0;
    const int status = equilibrium(model, start_speed, applied, &offset);

    state[STATE_OFFSET] = offset / micrometre;
    state[STATE_OFFSET_RATE] = 0.0;
    if (model->states == STATES_MAX) {
        const double r_bp = model->gears->pair.pinion.base_radius;

        state[STATE_PINION_ARC] = 0.0;
        state[STATE_PINION_SPEED] = r_bp * start_speed / (model->natural_frequency * micrometre);
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

/* x'' or u'' without the force: what drive, load and drag would do, and what p assumes of the mesh. */
static double applied_acceleration(const gear_model *model, double time,
                                   const model_torques *torques, const response_value *noise) {
    if (model->noise == NULL) {
        const double load = load_with_noise(&model->load, torques->load, time);
        return torques->drive + model->torque_to_offset * (load + torques->drag);
    }
    return torques->drive + model->torque_to_offset * (torques->load + torques->drag) +
           2.0 * model->response_decay * noise->rate +
           square(model->natural_frequency) * noise->offset;
}

/* Angle and speed of the pinion, prescribed or from the state. */
static drive_motion pinion_motion(const gear_model *model, double time, const double state[]) {
    if (model->states != STATES_MAX) {
        return drive_at(&model->drive, time);
    }

    const double r_bp = model->gears->pair.pinion.base_radius;
    const drive_motion motion = {
        .angle = state[STATE_PINION_ARC] * micrometre / r_bp,
        .speed = state[STATE_PINION_SPEED] * model->natural_frequency * micrometre / r_bp,
    };
    return motion;
}

double model_speed_unit(const gear_model *model) {
    return model->natural_frequency * micrometre;
}

static gear_motion motion_with(const gear_model *model, double time, const double state[],
                               const response_value *noise) {
    const double speed_unit = model_speed_unit(model);
    const drive_motion pinion = pinion_motion(model, time, state);
    const gear_motion motion = {
        .pinion_angle = pinion.angle,
        .pinion_speed = pinion.speed,
        .offset = state[STATE_OFFSET] * micrometre + noise->offset,
        .offset_rate = state[STATE_OFFSET_RATE] * speed_unit + noise->rate,
    };

    return motion;
}

gear_motion model_motion(const gear_model *model, double time, const double state[]) {
    const response_value noise = noise_response(model, time);

    return motion_with(model, time, state, &noise);
}

gear_motion model_prescribed_motion(const gear_model *model, double time) {
    const drive_motion pinion = drive_at(&model->drive, time);

    return (gear_motion){.pinion_angle = pinion.angle, .pinion_speed = pinion.speed};
}

/* x' = u' + p', and of p' the noise has made all but what was carried. */
void model_edges(const gear_model *model, int count, const double times[],
                 const double *const states[], int wanted, model_edge edges[]) {
    const double speed_unit = model_speed_unit(model);
    const int is_with_offset = wanted & (EDGE_OFFSET | EDGE_PINION);
    response_sum sums[MODEL_EDGES_MAX];

    if (model->noise != NULL) {
        response_given(model->noise, count, times, is_with_offset, sums);
    }
    for (int k = 0; k < count; ++k) {
        const double rate = states[k][STATE_OFFSET_RATE] * speed_unit;
        const response_sum none = {.given = 0.0};
        const response_sum noise = model->noise != NULL ? sums[k] : none;
        const response_value more = noise.value;

        edges[k].momentum = rate - (noise.given - more.rate);
        edges[k].given = noise.given;
        edges[k].motion = (gear_motion){.offset = 0.0};
        if (is_with_offset) {
            const drive_motion none_known = {.angle = 0.0};
            const drive_motion pinion =
                wanted & EDGE_PINION ? pinion_motion(model, times[k], states[k]) : none_known;
            edges[k].motion = (gear_motion){
                .pinion_angle = pinion.angle,
                .pinion_speed = pinion.speed,
                .offset = states[k][STATE_OFFSET] * micrometre + more.offset,
                .offset_rate = rate + more.rate,
            };
        }
    }
}

int model_evaluate(const gear_model *model, const gear_motion *motion, int wanted,
                   gm_mesh_result *result) {
    gm_position position;
    const int status = gm_position_from_pinion_angle(
        &model->gears->pair, motion->pinion_angle, motion->offset, motion->offset_rate, &position);

    position.pinion_speed = motion->pinion_speed;
    return status != GM_OK ? status
                           : gear_contact_evaluate(model->gears, &position, wanted, result);
}

int model_count_pairs(const gear_model *model, const gear_motion *motion, int *pairs) {
    gm_position position;
    const int status = gm_position_from_pinion_angle(&model->gears->pair, motion->pinion_angle,
                                                     motion->offset, 0.0, &position);

    return status != GM_OK ? status : gear_contact_pairs(model->gears, &position, pairs);
}

/* From x' = r_bp phi_p' - r_bw phi_w'. */
double model_wheel_speed(const gear_model *model, const gear_motion *motion) {
    const gm_pair *pair = &model->gears->pair;

    return (pair->pinion.base_radius * motion->pinion_speed - motion->offset_rate) /
           pair->wheel.base_radius;
}

double model_load(const gear_model *model, double time, const gear_motion *motion) {
    const double torque = load_steady(&model->load, time) +
                          ripple_value(&model->load.ripple, motion->pinion_angle) +
                          load_at_speed(&model->load, model_wheel_speed(model, motion));

    return load_with_noise(&model->load, torque, time);
}

model_torques model_by_speeds(const gear_model *model, double pinion_speed, double wheel_speed) {
    const model_torques torques = {
        .drive = -model->torque_to_pinion * model->pinion_drag * pinion_speed,
        .load = model->load.per_speed * wheel_speed,
        .drag = model->wheel_drag * wheel_speed,
    };
    return torques;
}

/* What ripples over the pinion's own angle: a torque; a prescribed speed does not (N m). */
static double drive_ripple(const gear_model *model, double angle) {
    return model->states == STATES_MAX ? ripple_value(&model->drive.ripple, angle) : 0.0;
}

/* x'' that drive and pinion's drag cause at an angle and speed of the pinion (m/s2). */
static double driven(const gear_model *model, double time, double angle, double speed) {
    const double r_bp = model->gears->pair.pinion.base_radius;

    return model->states == STATES_MAX
               ? model->torque_to_pinion * (drive_torque(&model->drive, time) +
                                            drive_ripple(model, angle) - model->pinion_drag * speed)
               : r_bp * drive_acceleration(&model->drive, time);
}

model_torques model_by_motion(const gear_model *model, const gear_motion *motion) {
    const double wheel_speed = model_wheel_speed(model, motion);
    const model_torques torques = {
        .drive = model->torque_to_pinion * drive_ripple(model, motion->pinion_angle),
        .load = load_at_speed(&model->load, wheel_speed) - model->load.per_speed * wheel_speed +
                ripple_value(&model->load.ripple, motion->pinion_angle),
    };
    return torques;
}

int model_follows_motion(const gear_model *model) {
    const int ripples = model->load.ripple.count > 0 ||
                        (model->states == STATES_MAX && model->drive.ripple.count > 0);

    return ripples || model->load.per_speed != 0.0 || model->load.per_speed_squared != 0.0 ||
           model->wheel_drag != 0.0 || model->torque_to_pinion * model->pinion_drag != 0.0;
}

double model_smooth_time(const gear_model *model, const gear_motion *motion) {
    return 1.0 / fmax(model->natural_frequency, highest_order(model) * fabs(motion->pinion_speed));
}

model_torques model_applied(const gear_model *model, double time, const gear_motion *motion) {
    model_torques torques = {
        .drive = driven(model, time, motion->pinion_angle, motion->pinion_speed),
        .load = load_steady(&model->load, time),
    };

    if (model->torques_follow) {
        const double wheel_speed = model_wheel_speed(model, motion);
        torques.load += ripple_value(&model->load.ripple, motion->pinion_angle) +
                        load_at_speed(&model->load, wheel_speed);
        torques.drag = model->wheel_drag * wheel_speed;
    }
    return torques;
}

double model_mean_force(const gear_model *model, const model_torques *mean, double acceleration) {
    const double applied = mean->drive + model->torque_to_offset * (mean->load + mean->drag);

    return (applied - acceleration) * model->moved_mass;
}

/* Mean of a table over the time between two weights, or the number that stands in its place. */
static double mean_of(const time_table *table, double number, const mean_weight *weight) {
    if (table == NULL) {
        return number;
    }

    double mean = 0.0;
    for (int side = 0; side < 2; ++side) {
        if (weight->time[side] < weight->time[side + 1]) {
            mean += time_table_weighted(table, weight->time[side], weight->time[side + 1],
                                        weight->weight[side][0], weight->weight[side][1]);
        }
    }
    return mean;
}

model_torques model_mean_over_time(const gear_model *model, const mean_weight *weight,
                                   double pinion_acceleration) {
    const double r_bp = model->gears->pair.pinion.base_radius;
    const int is_prescribed = model->states != STATES_MAX;
    const double drive_torque = mean_of(
        model->drive.kind == DRIVE_TORQUE ? model->drive.table : NULL, model->drive.torque, weight);
    const model_torques mean = {
        .drive = is_prescribed ? r_bp * (drive_is_linear(&model->drive) ? model->drive.acceleration
                                                                        : pinion_acceleration)
                               : r_bp * drive_torque / model->pinion_inertia,
        .load = mean_of(model->load.table, model->load.mean, weight),
    };
    return mean;
}

/* Speed of the pinion until the horizon, at most; its own drag only slows it down (rad/s). */
static double fastest_pinion(const gear_model *model, const gear_motion *motion,
                             const model_torques *torques, double table_rate, double horizon) {
    const pinion_drive *drive = &model->drive;
    if (model->states != STATES_MAX) {
        return drive->fastest + ripple_largest(&drive->ripple, 0);
    }

    /* The drive as it is, with what the table may add and the ripple come to from its lowest. */
    const double more = table_rate * horizon + 2.0 * ripple_largest(&drive->ripple, 0);
    const double acceleration = (fabs(torques->drive) + model->torque_to_pinion * more) /
                                model->gears->pair.pinion.base_radius;
    return fabs(motion->pinion_speed) + acceleration * horizon;
}

/* Without contact every torque that follows a speed slows its body down, and what it does becomes less. */
model_flight model_without_contact(const gear_model *model, double time, const gear_motion *motion,
                                   double horizon) {
    const gm_pair *pair = &model->gears->pair;
    const double r_bp = pair->pinion.base_radius, r_bw = pair->wheel.base_radius;
    const model_torques torques = model_applied(model, time, motion);
    const double load_part = model->torque_to_offset * (torques.load + torques.drag);

    /* What the tables change by until their next row, beyond which the horizon does not go, and ripple at the speed that
     * the pinion can have by then. */
    const time_table *drive_table = model->drive.table, *load_table = model->load.table;
    const int is_prescribed = model->states != STATES_MAX;
    const double table_rate =
        drive_table != NULL && !is_prescribed ? time_table_steepest(drive_table, time) : 0.0;
    const double pinion_speed = fastest_pinion(model, motion, &torques, table_rate, horizon);
    const double drive_rate = /* of x'' (m/s3) */
        is_prescribed ? r_bp * drive_jerk(&model->drive, time)
                      : model->torque_to_pinion *
                            (table_rate + pinion_speed * ripple_largest(&model->drive.ripple, 1));
    const double load_rate = (load_table != NULL ? time_table_steepest(load_table, time) : 0.0) +
                             pinion_speed * ripple_largest(&model->load.ripple, 1);

    /* The load's torques fall by their slope times what the wheel's speed changes by until the horizon. */
    const double wheel_acceleration =
        (fabs(load_part) + model->torque_to_offset * load_rate * horizon) / r_bw;
    const double wheel_speed =
        fabs(model_wheel_speed(model, motion)) + wheel_acceleration * horizon;
    const double wheel_slope = model->wheel_drag + load_by_speed(&model->load, wheel_speed);

    /* The pinion likewise, or as its speed is prescribed. */
    const double pinion_jerk =
        (drive_rate + model->torque_to_pinion * model->pinion_drag *
                          (fabs(torques.drive) + drive_rate * horizon) / r_bp) /
        r_bp;
    const model_flight flight = {
        .acceleration = torques.drive + load_part,
        .pinion_acceleration = torques.drive / r_bp,
        .jerk = model->torque_to_offset * (load_rate + wheel_slope * wheel_acceleration) +
                r_bp * pinion_jerk,
        .pinion_jerk = pinion_jerk,
    };
    return flight;
}

static enum mesh_contact contact_of(const gear_model *model, const gm_mesh_result *mesh) {
    const double touching = mesh->contact.drive_contact + mesh->contact.coast_contact;
    if (touching == 0.0) {
        return MESH_FREE;
    }

    /* Flanks that would have to pull carry nothing either. */
    const double pairs =
        model->mesh == MODEL_3D ? model->gears->pair.transverse_contact_ratio : 1.0;
    return mesh->force == 0.0 || touching < light_contact * pairs ? MESH_LIGHT : MESH_CARRIES;
}

/* Motion and mesh in a state, and what the state changes by with the time. */
static int evaluate_rates(const gear_model *model, double time, const double state[],
                          double derivative[], gear_motion *motion, gm_mesh_result *mesh) {
    /* Evaluated once: after the mesh it costs most. */
    const response_value noise = noise_response(model, time);
    *motion = motion_with(model, time, state, &noise);
    const int status = model_evaluate(model, motion, GM_WANT_FORCE, mesh);
    if (status != GM_OK) {
        return status;
    }

    const double w0 = model->natural_frequency;
    const model_torques torques = model_applied(model, time, motion);
    const double applied = applied_acceleration(model, time, &torques, &noise);

    derivative[STATE_OFFSET] = w0 * state[STATE_OFFSET_RATE];
    derivative[STATE_OFFSET_RATE] = (applied - mesh_acceleration(model, mesh)) * model->to_state;

    if (model->states == STATES_MAX) {
        derivative[STATE_PINION_ARC] = w0 * state[STATE_PINION_SPEED];
        derivative[STATE_PINION_SPEED] =
            (torques.drive - model->torque_to_pinion * mesh->pinion_torque) * model->to_state;
    }
    return GM_OK;
}

int model_derivative(const gear_model *model, double time, const double state[],
                     double derivative[], enum mesh_contact *contact) {
    gear_motion motion;
    gm_mesh_result mesh;
    const int status = evaluate_rates(model, time, state, derivative, &motion, &mesh);

    if (status == GM_OK) {
        *contact = contact_of(model, &mesh);
    }
    return status;
}

/* ---------------------------------------------------------------------------------------------
 * Jacobian
 * ------------------------------------------------------------------------------------------- */

/* What the force does to the row of a speed, x' or r_bp phi_p', of which 1 N takes `mobility` (1/kg) off. */
static void set_force(double jacobian[STATES_MAX][STATES_MAX], int row, const gear_model *model,
                      double mobility, double stiffness) {
    jacobian[STATE_OFFSET][row] = -mobility * stiffness * model->per_frequency;
    jacobian[STATE_OFFSET_RATE][row] = -mobility * stiffness * model->damping_time;
}

/* Adds what drag and load do to the rows of the speeds, by x' = r_bp phi_p' - r_bw phi_w'. */
static void add_torques(double jacobian[STATES_MAX][STATES_MAX], const gear_model *model,
                        const gear_motion *motion) {
    const gm_pair *pair = &model->gears->pair;
    const double ratio = pair->pinion.base_radius / pair->wheel.base_radius;
    const double wheel_speed = model_wheel_speed(model, motion);
    const double wheel_slope =
        model->torque_to_offset * (model->wheel_drag + load_by_speed(&model->load, wheel_speed));
    const double pinion_slope = model->torque_to_pinion * model->pinion_drag;

    /* Ripple over the pinion's angle, of its own torque (which moves both coordinates) and of the load. */
    const double to_arc = 1.0 / (model->natural_frequency * pair->pinion.base_radius);
    const double drive_ripple_slope =
        model->torque_to_pinion * ripple_slope(&model->drive.ripple, motion->pinion_angle);
    const double load_ripple_slope =
        model->torque_to_offset * ripple_slope(&model->load.ripple, motion->pinion_angle);

    jacobian[STATE_OFFSET_RATE][STATE_OFFSET_RATE] -= wheel_slope / pair->wheel.base_radius;
    if (model->states != STATES_MAX) {
        return;
    }
    jacobian[STATE_PINION_ARC][STATE_OFFSET_RATE] +=
        to_arc * (drive_ripple_slope + load_ripple_slope);
    jacobian[STATE_PINION_ARC][STATE_PINION_SPEED] += to_arc * drive_ripple_slope;
    jacobian[STATE_PINION_SPEED][STATE_OFFSET_RATE] +=
        (wheel_slope * ratio - pinion_slope) / pair->pinion.base_radius;
    jacobian[STATE_PINION_SPEED][STATE_PINION_SPEED] -= pinion_slope / pair->pinion.base_radius;
}

int model_derivative_and_tangent(const gear_model *model, double time, const double state[],
                                 double derivative[], model_tangent *tangent,
                                 enum mesh_contact *contact) {
    const gear_mesh *gears = model->gears;
    double(*jacobian)[STATES_MAX] = tangent->jacobian;
    gear_motion motion;
    gm_mesh_result mesh;
    const int status = evaluate_rates(model, time, state, derivative, &motion, &mesh);
    if (status != GM_OK) {
        return status;
    }
    *contact = contact_of(model, &mesh);

    /* The flanks that touch are springs and dampers; where they would have to pull they are neither. */
    const double stiffness =
        mesh.force != 0.0 ? gear_contact_touching_stiffness(gears, &mesh) : 0.0;
    tangent->touching = mesh.contact.drive_contact + mesh.contact.coast_contact;
    tangent->is_spring = (mesh.drive_force > 0.0 || mesh.coast_force > 0.0) &&
                         (mesh.drive_force > 0.0) == (mesh.contact.drive_contact > 0.0) &&
                         (mesh.coast_force > 0.0) == (mesh.contact.coast_contact > 0.0);
    tangent->carried = mesh_acceleration(model, &mesh) * model->to_state;

    /* The rows and columns of the states that there are: with a prescribed speed those of x alone. */
    if (model->states == STATES_MAX) {
        memset(jacobian, 0, sizeof tangent->jacobian);
        jacobian[STATE_PINION_SPEED][STATE_PINION_ARC] = model->natural_frequency;
        set_force(jacobian, STATE_PINION_SPEED, model, model->pinion_mobility, stiffness);
    }
    jacobian[STATE_OFFSET][STATE_OFFSET] = 0.0;
    jacobian[STATE_OFFSET_RATE][STATE_OFFSET] = model->natural_frequency;
    set_force(jacobian, STATE_OFFSET_RATE, model, mobility(model), stiffness);
    if (model->torques_follow) {
        add_torques(jacobian, model, &motion);
    }
    return GM_OK;
}

/* ---------------------------------------------------------------------------------------------
 * Steps and tolerances
 * ------------------------------------------------------------------------------------------- */

/* Time in which the pinion turns by the angle of a step, from the speed at hand and the acceleration without contact; 0 = any. */
static double turning_step(const gear_model *model, double time, const double state[]) {
    const double angle = model->step_angle;
    if (angle == HUGE_VAL) {
        return 0.0;
    }

    const drive_motion motion = pinion_motion(model, time, state);
    const double speed = fabs(motion.speed);
    const double acceleration = fabs(driven(model, time, motion.angle, motion.speed)) /
                                model->gears->pair.pinion.base_radius;
    const double reach = speed + sqrt(speed * speed + 2.0 * acceleration * angle);

    return reach > 0.0 ? 2.0 * angle / reach : 0.0;
}

double model_next_row(const gear_model *model, double time, int *is_kink) {
    const time_table *tables[2] = {model->drive.table, model->load.table};
    double next = HUGE_VAL;

    *is_kink = 0;
    for (int i = 0; i < 2; ++i) {
        if (tables[i] != NULL) {
            int kink;
            const double row = time_table_next_row(tables[i], time, &kink);
            const double same = isfinite(row) ? 2.0 * time_table_tolerance(tables[i], row) : 0.0;

            /* Rows of both tables at one time, to rounding, are one. */
            if (row < next - same) {
                *is_kink = kink;
            } else if (row <= next + same) {
                *is_kink |= kink;
            }
            next = fmin(next, row);
        }
    }
    return next;
}

double model_before_row(const gear_model *model, double row) {
    const time_table *tables[2] = {model->drive.table, model->load.table};
    double before = row;

    for (int i = 0; i < 2; ++i) {
        if (tables[i] != NULL && isfinite(row)) {
            before = fmin(before, row - 4.0 * time_table_tolerance(tables[i], row));
        }
    }
    return before;
}

double model_max_step(const gear_model *model, double time, const double state[]) {
    const double turning = turning_step(model, time, state);
    const double noisy = model->longest_noisy_step;
    const int is_noisy_shorter = noisy > 0.0 && (turning == 0.0 || noisy < turning);

    return is_noisy_shorter ? noisy : turning;
}

double model_held_step(const gear_model *model, double time, const double state[], double *until) {
    const double now = model_max_step(model, time, state);

    /* A speed that follows the state, a table or a ripple may be another one after any step. */
    *until = time;
    if (model->states == STATES_MAX || !drive_is_linear(&model->drive)) {
        return now;
    }

    /* The speed goes from one end to the other, and the longest step with it. */
    const double speed = fabs(drive_at(&model->drive, time).speed);
    const double acceleration = fabs(model->drive.acceleration);
    *until = acceleration > 0.0 ? time + held_share * speed / acceleration : HUGE_VAL;
    return acceleration > 0.0 ? fmin(now, model_max_step(model, *until, state)) : now;
}

static double jump_share(const gear_model *model) {
    return model->jumps ? share_of_jumps : 1.0;
}

/* A tolerance below what the digits of the value hold would stop the solver. */
static double weight_of(double tolerance, double value) {
    return 1.0 / larger(tolerance, 4.0 * DBL_EPSILON * fabs(value));
}

void model_error_weights(const gear_model *model, double relative_tolerance,
                         double absolute_tolerance, const double state[], double weights[]) {
    const double share = jump_share(model);
    const double offset_tolerance = share * absolute_tolerance * per_micrometre;
    const double speed_tolerance = speed_tolerance_factor * offset_tolerance;
    const double clearance = 0.5 * fabs(model->gears->pair.backlash) * per_micrometre;

    /* Relative to the penetration: half the backlash is a choice of where zero is. */
    const double depth = larger(fabs(state[STATE_OFFSET]) - clearance, 0.0);

    weights[STATE_OFFSET] =
        weight_of(share * relative_tolerance * depth + offset_tolerance, state[STATE_OFFSET]);
    weights[STATE_OFFSET_RATE] =
        weight_of(share * relative_tolerance * fabs(state[STATE_OFFSET_RATE]) + speed_tolerance,
                  state[STATE_OFFSET_RATE]);

    /* The angle grows without end; a tolerance relative to it would soon be wider than a tooth. */
    if (model->states == STATES_MAX) {
        weights[STATE_PINION_ARC] =
            weight_of(arc_tolerance_factor * offset_tolerance, state[STATE_PINION_ARC]);
        weights[STATE_PINION_SPEED] =
            weight_of(arc_tolerance_factor * speed_tolerance, state[STATE_PINION_SPEED]);
    }
}
