/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Evaluations of a mesh that mesh_init.c has prepared. Nothing here but composition: what overlaps is found by
 * penetration.c or cache.c, law.c makes a force of it, wrench.c says where it acts.
 */
#include "mesh.h"

#include "cache.h"
#include "contact.h"
#include "corner.h"
#include "elastic_mesh.h"
#include "friction.h"
#include "internal.h"
#include "law.h"
#include "line_load.h"
#include "meshing.h"
#include "penetration.h"
#include "position.h"
#include "side_tangent.h"
#include "tilt.h"
#include "wrench.h"

#include <math.h>
#include <string.h>

static inline void set_gradients_nan(gm_mesh_result *result) {
    const double nan = gmi_nan();
    const gm_gradient none = {nan, nan, nan, nan};
    result->force_by = result->pinion_torque_by = result->wheel_torque_by = none;
}

void gmi_mesh_result_set_nan(gm_mesh_result *result) {
    const double nan = gmi_nan();
    result->force = result->drive_force = result->coast_force = nan;
    result->pinion_torque = result->wheel_torque = result->loss = result->energy = nan;
    set_gradients_nan(result);
    result->contact = gmi_penetration_nan();
    gmi_wrench_set(&result->wrench, nan);
}

/* What the sums have to accumulate. The size of the touching part matters to a gradient only where damping acts. */
static inline int accumulated(const gm_mesh *mesh, int is_moving, int wanted) {
    int mask = wanted & GM_WANT_WRENCH ? GMI_MOMENTS : GMI_SUM;
    if (wanted & GM_WANT_DERIVATIVES) {
        const int is_damped = mesh->law.damping > 0.0 && is_moving;
        mask |= GMI_DERIVATIVES | (is_damped ? GMI_CONTACT_DERIVATIVES : 0) |
                (mesh->engagement.is_tilted ? GMI_MOMENTS : 0);
    }
    return mask;
}

static inline gm_gradient scaled(const gm_gradient *gradient, double factor) {
    const gm_gradient result = {factor * gradient->pinion_angle, factor * gradient->wheel_angle,
                                factor * gradient->pinion_speed, factor * gradient->wheel_speed};
    return result;
}

/* From the forces of both sides to derivatives by angles and speeds; for the signs see gmi_penetration_set(). */
static inline void set_force_derivatives(const gm_pair *pair, const gmi_side_force *drive,
                                         const gmi_side_force *coast, gm_mesh_result *result) {
    const double r_bp = pair->pinion.base_radius;
    const double r_bw = pair->wheel.base_radius;
    const double by_offset = drive->by_delta + coast->by_delta;
    const double by_origin = drive->by_origin + coast->by_origin;
    const double by_rate = drive->by_speed + coast->by_speed;
    result->force_by.pinion_angle = r_bp * (by_offset + by_origin);
    result->force_by.wheel_angle = -r_bw * by_offset;
    result->force_by.pinion_speed = r_bp * by_rate;
    result->force_by.wheel_speed = -r_bw * by_rate;

    /* The torques follow the force. */
    result->pinion_torque_by = scaled(&result->force_by, r_bp);
    result->wheel_torque_by = scaled(&result->force_by, r_bw);
}

/* Of a side whose flanks are clear of each other. */
static const gmi_side_sum no_contact = {.sum = 0.0};
static const gmi_side_force no_force = {.force = 0.0};

static void add_to_gradient(const double by[GMI_MOTIONS], double factor, gm_gradient *gradient) {
    gradient->pinion_angle += factor * by[GMI_PINION_ANGLE];
    gradient->wheel_angle += factor * by[GMI_WHEEL_ANGLE];
    gradient->pinion_speed += factor * by[GMI_PINION_SPEED];
    gradient->wheel_speed += factor * by[GMI_WHEEL_SPEED];
}

/* The friction of one side acts on the pinion at rho_p, on the wheel at rho_w = T - rho_p. */
static void add_friction(const gm_mesh *mesh, const gmi_friction_sum *friction, int wanted,
                         gm_mesh_result *result) {
    const gmi_varying *force = &friction->force, *moment = &friction->moment;
    const double sign = mesh->pair->wheel.sign;
    const double length = sign * mesh->engagement.line_of_action;
    result->pinion_torque += moment->value;
    result->wheel_torque += length * force->value - sign * moment->value;
    result->loss += friction->loss;
    if (wanted & GM_WANT_DERIVATIVES) {
        add_to_gradient(moment->by, 1.0, &result->pinion_torque_by);
        add_to_gradient(moment->by, -sign, &result->wheel_torque_by);
        add_to_gradient(force->by, length, &result->wheel_torque_by);
    }
}

/* What a user sees of the forces of both sides, and of their friction, [side] or NULL; NaN in place of what was not asked
 * for. */
SPECIALIZED void set_forces(const gm_mesh *mesh, const gmi_side_force *drive_force,
                            const gmi_side_force *coast_force, const gmi_friction_sum *friction,
                            int wanted, gm_mesh_result *result) {
    result->drive_force = drive_force->force;
    result->coast_force = coast_force->force;
    result->force = drive_force->force - coast_force->force;
    result->pinion_torque = result->force * mesh->pair->pinion.base_radius;
    result->wheel_torque = result->force * mesh->pair->wheel.base_radius;
    result->loss = 0.0;
    result->energy = gmi_nan(); /* found apart, where it is wanted */

    if (wanted & GM_WANT_DERIVATIVES) {
        set_force_derivatives(mesh->pair, drive_force, coast_force, result);
    } else {
        set_gradients_nan(result);
    }
    if (friction != NULL) {
        add_friction(mesh, &friction[GM_DRIVE], wanted, result);
        add_friction(mesh, &friction[GM_COAST], wanted, result);
    }
    if (wanted & GM_WANT_WRENCH) {
        gmi_wrench_set(&result->wrench, 0.0);
        gmi_wrench_add_side(mesh->pair, &mesh->engagement, drive_force, GM_DRIVE, &result->wrench);
        gmi_wrench_add_side(mesh->pair, &mesh->engagement, coast_force, GM_COAST, &result->wrench);
        for (int side = GM_DRIVE; side <= GM_COAST && friction != NULL; ++side) {
            gmi_wrench_add_friction(mesh->pair, &mesh->engagement, &friction[side], side,
                                    &result->wrench);
        }
        if (mesh->engagement.axis_direction != 0.0) {
            gmi_wrench_turn(&result->wrench, mesh->engagement.axis);
        }
    } else {
        gmi_wrench_set(&result->wrench, gmi_nan());
    }
}

/* All that a user sees, from the sums of both sides; friction: [side], or NULL. */
SPECIALIZED void set_result(const gm_mesh *mesh, const gmi_side_sum *drive,
                            const gmi_side_sum *coast, const gmi_friction_sum *friction,
                            const double approach[2], int wanted, gm_mesh_result *result) {
    const int is_moving = approach[GM_DRIVE] != 0.0 || approach[GM_COAST] != 0.0;
    const int mask = accumulated(mesh, is_moving, wanted);
    gmi_penetration_set(mesh->pair, drive, coast, approach, mask, &result->contact);

    gmi_side_force forces[2];
    const gmi_side_force *drive_force = &no_force, *coast_force = &no_force;
    if (drive != &no_contact) {
        gmi_law_force(&mesh->law, drive, approach[GM_DRIVE], mask, &forces[GM_DRIVE]);
        drive_force = &forces[GM_DRIVE];
    }
    if (coast != &no_contact) {
        gmi_law_force(&mesh->law, coast, approach[GM_COAST], mask, &forces[GM_COAST]);
        coast_force = &forces[GM_COAST];
    }

    set_forces(mesh, drive_force, coast_force, friction, wanted, result);
}

/* Which flanks both sides have: known where an evaluation is compiled for them, else found out. */
enum flank_kind { ANY_FLANKS, IDEAL_FLANKS, TABLES };

/* The sum of a side, by a mask of enum gmi_wanted: written to `memory`, or that of no contact. */
SPECIALIZED const gmi_side_sum *exact_sum(const gm_mesh *mesh, int side,
                                          const gm_position *position, int mask,
                                          enum flank_kind kind, gmi_side_sum *memory) {
    const gmi_engagement *at = &mesh->engagement;
    const gmi_side *prepared = &mesh->side[side];
    if (gmi_side_is_clear(at, prepared, side, position->offset)) {
        return &no_contact;
    }

    /* By the flanks it is compiled for, or by what the mesh has. */
    if (kind == IDEAL_FLANKS) {
        *memory = gmi_no_contact();
        gmi_sum_ideal(mesh->pair, at, side, position, mask, memory);
    } else if (kind == TABLES) {
        *memory = gmi_no_contact();
        gmi_side_sum_tables(mesh->pair, at, prepared, side, position, mask, memory);
    } else if (mesh->model == GM_MODEL_SIMPLE) {
        gmi_side_sum_simple(mesh->pair, at, side, position->offset, memory);
    } else {
        gmi_side_sum_3d(mesh->pair, at, prepared, side, position, mask, memory);
    }
    return memory;
}

/* Compiled for what most calls want, and once for any mask and flanks. */
SPECIALIZED void evaluate(const gm_mesh *mesh, const gm_position *position, int wanted,
                          enum flank_kind kind, gm_mesh_result *result) {
    const int mask = accumulated(mesh, position->offset_rate != 0.0, wanted);
    gmi_side_sum sums[2];
    const gmi_side_sum *drive = exact_sum(mesh, GM_DRIVE, position, mask, kind, &sums[GM_DRIVE]);
    const gmi_side_sum *coast = exact_sum(mesh, GM_COAST, position, mask, kind, &sums[GM_COAST]);

    /* The coast flanks approach each other while x falls. */
    const double approach[2] = {position->offset_rate, -position->offset_rate};
    set_result(mesh, drive, coast, NULL, approach, wanted, result);
}

static OWN_STACK int evaluate_ideal_force(const gm_mesh *mesh, const gm_position *position,
                                          gm_mesh_result *result) {
    evaluate(mesh, position, GM_WANT_FORCE, IDEAL_FLANKS, result);
    return GM_OK;
}

static OWN_STACK int evaluate_force(const gm_mesh *mesh, const gm_position *position,
                                    gm_mesh_result *result) {
    evaluate(mesh, position, GM_WANT_FORCE, TABLES, result);
    return GM_OK;
}

static OWN_STACK int evaluate_any(const gm_mesh *mesh, const gm_position *position, int wanted,
                                  gm_mesh_result *result) {
    evaluate(mesh, position, wanted, ANY_FLANKS, result);
    return GM_OK;
}

/* Energy with constant stiffness: a walk along the lines for itself, so that those for the force know nothing of it. */
static OWN_STACK void set_energy(const gm_mesh *mesh, const gm_position *position,
                                 gm_mesh_result *result) {
    result->energy = gmi_side_energy(mesh, GM_DRIVE, position);
    result->energy += gmi_side_energy(mesh, GM_COAST, position);
}

static OWN_STACK int evaluate_with_energy(const gm_mesh *mesh, const gm_position *position,
                                          int wanted, gm_mesh_result *result) {
    (void)evaluate_any(mesh, position, wanted, result);
    set_energy(mesh, position, result);
    return GM_OK;
}

/*
 * Elastic teeth do work when all lines roll on together, with x held: the torque on the pinion exceeds F r_bp by it, or the
 * energy would not be kept. Its derivative by the roll itself, below 1e-4 of the gradient, is left out of that.
 */
static void add_roll(const gm_mesh *mesh, const gmi_side_sum *drive, const gmi_side_sum *coast,
                     int wanted, gm_mesh_result *result) {
    const double r_bp = mesh->pair->pinion.base_radius;
    const double k = mesh->law.stiffness;
    result->pinion_torque += k * (drive->roll - coast->roll) * r_bp;
    if (wanted & GM_WANT_DERIVATIVES) {
        const double by_offset = k * (drive->by_origin + coast->by_origin) * r_bp;
        result->pinion_torque_by.pinion_angle += by_offset * r_bp;
        result->pinion_torque_by.wheel_angle -= by_offset * mesh->pair->wheel.base_radius;
    }
}

/* From the sums of elastic teeth to all that a user sees, apart from what has found them. rates: [side], NULL = axes at rest. */
static OWN_STACK void finish_elastic(const gm_mesh *mesh, const gm_position *position,
                                     const gmi_side_sum sums[2], const double approach[2],
                                     const gmi_rates *rates, int wanted, int mask,
                                     gm_workspace *workspace, gm_mesh_result *result) {
    gmi_friction_sum friction[2];
    const int slides = mesh->friction.is_on;
    for (int side = GM_DRIVE; side <= GM_COAST && slides; ++side) {
        gmi_sliding sliding;
        gmi_sliding_find(&mesh->friction, mesh->pair, &mesh->engagement, position,
                         rates == NULL ? NULL : &rates[side], &sliding);
        gmi_elastic_friction(mesh, side, approach[side], &sliding, &sums[side], mask, workspace,
                             &friction[side]);
    }

    /* Forces, the work of the common roll, and what is stored. */
    set_result(mesh, &sums[GM_DRIVE], &sums[GM_COAST], slides ? friction : NULL, approach, wanted,
               result);
    add_roll(mesh, &sums[GM_DRIVE], &sums[GM_COAST], wanted, result);
    if (wanted & GM_WANT_ENERGY) {
        result->energy = gmi_elastic_energy(mesh, GM_DRIVE, &sums[GM_DRIVE], workspace) +
                         gmi_elastic_energy(mesh, GM_COAST, &sums[GM_COAST], workspace);
    }
}

static OWN_STACK int evaluate_elastic(const gm_mesh *mesh, const gm_position *position, int wanted,
                                      gm_workspace *workspace, gm_mesh_result *result) {
    gmi_side_sum sums[2];
    const int mask = accumulated(mesh, position->offset_rate != 0.0, wanted) | GMI_ROLL;
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        const int status = gmi_side_sum_by_law(mesh, side, position, mask, workspace, &sums[side]);
        if (status != GM_OK) {
            gmi_mesh_result_set_nan(result);
            return status;
        }
    }
    const double approach[2] = {position->offset_rate, -position->offset_rate};
    finish_elastic(mesh, position, sums, approach, NULL, wanted, mask, workspace, result);
    return GM_OK;
}

/* Teeth that bend: the simple model has none. */
static inline int is_elastic(const gm_mesh *mesh) {
    return mesh->elastic != NULL && mesh->model != GM_MODEL_SIMPLE;
}

/* Axes at rest: only the angles move. */
static gmi_rates resting(const gm_position *position, int side) {
    const gmi_rates rates = {.delta = gmi_side_sign(side) * position->offset_rate};
    return rates;
}

/* One side by its tangent: what a user may see of it. rates: NULL = axes at rest, friction: NULL = without. */
static OWN_STACK void follow_side(const gm_mesh *mesh, const gm_position *position,
                                  const gmi_rates *rates, int side, gmi_side_sum *sum,
                                  gmi_side_force *force, gmi_friction_sum *friction,
                                  double *approach) {
    gmi_side_tangent tangent;
    gmi_rubbing rubbing;
    gmi_rubbing_by rubbing_by;
    gmi_sliding sliding;

    /* How fast the flanks approach, and how they slide. */
    tangent.rates = rates != NULL ? *rates : resting(position, side);
    if (friction != NULL) {
        gmi_sliding_find(&mesh->friction, mesh->pair, &mesh->engagement, position, &tangent.rates,
                         &sliding);
    }

    /* One walk along the lines gives overlap, force, moments of friction, and how all of it moves. */
    gmi_side_sum_tangent(mesh, side, position, friction != NULL ? &sliding : NULL, sum, &tangent,
                         &rubbing, &rubbing_by);
    gmi_law_force_of_tangent(&tangent, force);
    if (friction != NULL) {
        gmi_friction_sum_of(mesh->pair, side, &rubbing, &rubbing_by, friction);
    }

    /* The mean speed of approach where they touch. */
    *approach = sum->contact > 0.0 ? tangent.flow / sum->contact : 0.0;
}

/* By the tangents of both sides: with friction and derivatives, and where the speed of approach is another at each point. */
static OWN_STACK void evaluate_followed(const gm_mesh *mesh, const gm_position *position,
                                        const gmi_rates *rates, int wanted,
                                        gm_mesh_result *result) {
    gmi_side_sum sums[2];
    gmi_side_force forces[2];
    gmi_friction_sum friction[2];
    double approach[2];
    const int slides = mesh->friction.is_on;
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        follow_side(mesh, position, rates == NULL ? NULL : &rates[side], side, &sums[side],
                    &forces[side], slides ? &friction[side] : NULL, &approach[side]);
    }

    /* Both sides together. */
    gmi_penetration_set(mesh->pair, &sums[GM_DRIVE], &sums[GM_COAST], approach,
                        accumulated(mesh, 1, wanted), &result->contact);
    set_forces(mesh, &forces[GM_DRIVE], &forces[GM_COAST], slides ? friction : NULL, wanted,
               result);
    if (wanted & GM_WANT_ENERGY) {
        set_energy(mesh, position, result);
    }
}

static inline int are_tilting(const gmi_rates rates[2]) {
    return rates[GM_DRIVE].along != 0.0 || rates[GM_DRIVE].across != 0.0;
}

/* With friction, which needs the moments of the force: in plain sums, with one speed of approach for each side. */
static OWN_STACK void evaluate_rubbing(const gm_mesh *mesh, const gm_position *position,
                                       const gmi_rates *rates, int wanted, gm_mesh_result *result) {
    gmi_side_sum memory[2];
    gmi_friction_sum friction[2];
    const gmi_side_sum *sums[2];
    double approach[2];

    /* A side that is clear of its mate has no force, and nothing rubs. */
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        gmi_rubbing rubbing = {{0.0, 0.0, 0.0}, 0.0};
        sums[side] = &no_contact;
        approach[side] =
            rates != NULL ? rates[side].delta : gmi_side_sign(side) * position->offset_rate;
        if (!gmi_side_is_clear(&mesh->engagement, &mesh->side[side], side, position->offset)) {
            gmi_sliding sliding;
            gmi_sliding_find(&mesh->friction, mesh->pair, &mesh->engagement, position,
                             rates == NULL ? NULL : &rates[side], &sliding);
            gmi_side_sum_sliding(mesh, side, position, approach[side], &sliding, &memory[side],
                                 &rubbing);
            sums[side] = &memory[side];
        }
        gmi_friction_sum_of(mesh->pair, side, &rubbing, NULL, &friction[side]);
    }
    set_result(mesh, sums[GM_DRIVE], sums[GM_COAST], friction, approach, wanted, result);
    if (wanted & GM_WANT_ENERGY) {
        set_energy(mesh, position, result);
    }
}

/* rates: NULL = axes at rest. */
static void evaluate_sliding(const gm_mesh *mesh, const gm_position *position,
                             const gmi_rates *rates, int wanted, gm_mesh_result *result) {
    if ((wanted & GM_WANT_DERIVATIVES) || (rates != NULL && are_tilting(rates))) {
        evaluate_followed(mesh, position, rates, wanted, result);
    } else {
        evaluate_rubbing(mesh, position, rates, wanted, result);
    }
}

/* A corner has a shorter arm about the axis of its own gear: torque = force times d overlap / d angle. */
static void add_tip(const gm_mesh *mesh, const gmi_tip_load *force, int role, int side, int wanted,
                    gm_mesh_result *result) {
    const gm_pair *pair = mesh->pair;
    const double sign = gmi_side_sign(side);
    const double r_bp = pair->pinion.base_radius, r_bw = pair->wheel.base_radius;
    const double arm = role == GM_PINION ? r_bp : r_bw;

    /* The torque is less by this than force times base radius. */
    *(role == GM_PINION ? &result->pinion_torque : &result->wheel_torque) -=
        sign * arm * force->arm;

    /* Its derivatives by the chain rule: the origin of the lines follows phi_p, delta both angles. */
    if (wanted & GM_WANT_DERIVATIVES) {
        gm_gradient *by = role == GM_PINION ? &result->pinion_torque_by : &result->wheel_torque_by;
        by->pinion_angle -= arm * r_bp * (force->arm_by_delta + force->arm_by_origin);
        by->wheel_angle += arm * r_bw * force->arm_by_delta;
        by->pinion_speed -= arm * r_bp * force->arm_by_speed;
        by->wheel_speed += arm * r_bw * force->arm_by_speed;
    }
}

/* Friction of a side with corners: what is plain friction, and what both arms together are longer by at tips. */
static void add_corner_friction(const gm_mesh *mesh, const gmi_corner_sums *sums, int wanted,
                                gm_mesh_result *result) {
    const double sign = mesh->pair->wheel.sign;
    const gmi_varying *longer = &sums->tip_friction.longer;
    add_friction(mesh, &sums->friction, wanted, result);
    result->wheel_torque += sign * longer->value;
    if (wanted & GM_WANT_DERIVATIVES) {
        add_to_gradient(longer->by, sign, &result->wheel_torque_by);
    }
}

static void add_wrench(const gm_wrench *more, gm_wrench *wrench) {
    for (int k = 0; k < 3; ++k) {
        wrench->pinion_force[k] += more->pinion_force[k];
        wrench->pinion_moment[k] += more->pinion_moment[k];
        wrench->wheel_force[k] += more->wheel_force[k];
        wrench->wheel_moment[k] += more->wheel_moment[k];
    }
}

/* All that a side with corners adds to the wrench of the normal force on the line of action, in the frame of the drawing. */
static OWN_STACK void add_corner_wrench(const gm_mesh *mesh, const gmi_corner_sums *sums, int side,
                                        gm_wrench *wrench) {
    const gm_pair *pair = mesh->pair;
    const gmi_engagement *at = &mesh->engagement;
    gm_wrench more;
    gmi_wrench_set(&more, 0.0);

    /* The force is along the normal of the flank that the corner touches, friction across it. */
    gmi_wrench_add_tip(pair, at, &sums->tips[GM_PINION], GM_PINION, side, &more);
    gmi_wrench_add_tip(pair, at, &sums->tips[GM_WHEEL], GM_WHEEL, side, &more);
    if (mesh->friction.is_on) {
        gmi_wrench_add_friction(pair, at, &sums->friction, side, &more);
        gmi_wrench_add_tip_friction(pair, at, &sums->tip_friction, side, &more);
    }
    gmi_wrench_turn(&more, at->axis);
    add_wrench(&more, wrench);
}

/* What the sums of one side are for the user, as if the other one did not touch. */
static void set_corner_result(const gm_mesh *mesh, const gmi_corner_sums *sums, int side,
                              const double approach[2], int wanted, gm_mesh_result *result) {
    const gmi_side_sum *sides[2] = {&no_contact, &no_contact};
    sides[side] = &sums->side;
    set_result(mesh, sides[GM_DRIVE], sides[GM_COAST], NULL, approach, wanted, result);
    if (!(result->drive_force + result->coast_force > 0.0)) {
        return;
    }

    /* It presses: so do its tips, and the flanks rub. */
    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        add_tip(mesh, &sums->tips[role], role, side, wanted, result);
    }
    if (mesh->friction.is_on) {
        add_corner_friction(mesh, sums, wanted, result);
    }
    if (wanted & GM_WANT_WRENCH) {
        add_corner_wrench(mesh, sums, side, &result->wrench);
    }
}

static void add_gradient(const gm_gradient *more, gm_gradient *gradient) {
    const double by[GMI_MOTIONS] = {[GMI_PINION_ANGLE] = more->pinion_angle,
                                    [GMI_WHEEL_ANGLE] = more->wheel_angle,
                                    [GMI_PINION_SPEED] = more->pinion_speed,
                                    [GMI_WHEEL_SPEED] = more->wheel_speed};
    add_to_gradient(by, 1.0, gradient);
}

/* The coast side on top of the drive side: flanks without backlash touch on both. */
static OWN_STACK void add_coast(const gm_mesh *mesh, const gmi_corner_sums *sums,
                                const double approach[2], int wanted, gm_mesh_result *result) {
    gm_mesh_result more;
    set_corner_result(mesh, sums, GM_COAST, approach, wanted, &more);
    result->force += more.force;
    result->coast_force = more.coast_force;
    result->pinion_torque += more.pinion_torque;
    result->wheel_torque += more.wheel_torque;
    result->loss += more.loss;
    add_gradient(&more.force_by, &result->force_by);
    add_gradient(&more.pinion_torque_by, &result->pinion_torque_by);
    add_gradient(&more.wheel_torque_by, &result->wheel_torque_by);
    add_wrench(&more.wrench, &result->wrench);

    /* The overlap, and what of it is of this side alone. */
    gm_penetration *contact = &result->contact;
    contact->penetration += more.contact.penetration;
    contact->rate += more.contact.rate;
    contact->coast = more.contact.coast;
    contact->coast_rate = more.contact.coast_rate;
    contact->coast_contact = more.contact.coast_contact;
    contact->d_pinion_angle += more.contact.d_pinion_angle;
    contact->d_wheel_angle += more.contact.d_wheel_angle;
    contact->coast_pairs = more.contact.coast_pairs;
}

static OWN_STACK void set_drive(const gm_mesh *mesh, const gmi_corner_sums *sums,
                                const double approach[2], int wanted, gm_mesh_result *result) {
    set_corner_result(mesh, sums, GM_DRIVE, approach, wanted, result);
}

/*
 * Lines that go on beyond the path of contact; rates: [side], NULL where the axes are at rest. One side at a time: the sums
 * of both would be twice the stack.
 */
static OWN_STACK void evaluate_corners(const gm_mesh *mesh, const gm_position *position,
                                       const gmi_rates *rates, int wanted, gm_mesh_result *result) {
    const int moments = (wanted & GM_WANT_WRENCH) || rates != NULL ? GMI_MOMENTS : GMI_SUM;
    const int mask = moments | (wanted & GM_WANT_DERIVATIVES ? GMI_DERIVATIVES : GMI_SUM);
    const int slides = mesh->friction.is_on;
    gmi_corner_sums sums;
    gmi_sliding sliding;
    double approach[2] = {position->offset_rate, -position->offset_rate};
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        /* All lines of the side, with what rubs on them. */
        approach[side] = rates != NULL ? rates[side].delta : approach[side];
        if (slides) {
            gmi_sliding_find(&mesh->friction, mesh->pair, &mesh->engagement, position,
                             rates == NULL ? NULL : &rates[side], &sliding);
        }
        gmi_side_sum_corners(mesh, side, position, mask, approach[side], slides ? &sliding : NULL,
                             &sums);
        if (rates != NULL) {
            approach[side] = gmi_rates_mean_approach(&rates[side], mesh->pair, &mesh->engagement,
                                                     side, &sums.side);
        }

        /* What it is for the user. */
        if (side == GM_DRIVE) {
            set_drive(mesh, &sums, approach, wanted, result);
        } else if (sums.side.contact > 0.0) {
            add_coast(mesh, &sums, approach, wanted, result);
        }

        /* The lines once more, for the squares. */
        if (wanted & GM_WANT_ENERGY) {
            gmi_side_sum_corners(mesh, side, position, GMI_SQUARES, 0.0, NULL, &sums);
            const double energy = 0.5 * mesh->law.stiffness * sums.side.sum;
            result->energy = side == GM_DRIVE ? energy : result->energy + energy;
        }
    }
}

int gmi_mesh_evaluate_exact(const gm_mesh *mesh, const gm_position *position, int wanted,
                            gm_workspace *workspace, gm_mesh_result *result) {
    if (is_elastic(mesh)) {
        return evaluate_elastic(mesh, position, wanted, workspace, result);
    }
    if (mesh->has_corners) {
        evaluate_corners(mesh, position, NULL, wanted, result);
    } else if (mesh->friction.is_on) {
        evaluate_sliding(mesh, position, NULL, wanted, result);
    } else {
        return wanted & GM_WANT_ENERGY ? evaluate_with_energy(mesh, position, wanted, result)
                                       : evaluate_any(mesh, position, wanted, result);
    }
    return GM_OK;
}

/* Tips of a side that the cache holds. What damps there grows with what touches, as the arms do with delta. */
static void set_cached_tips(const gmi_law *law, const gmi_cache_arm arms[2], double approach,
                            gmi_corner_sums *sums) {
    const double viscous = law->damping * approach;
    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        const gmi_cache_arm *arm = &arms[role];
        gmi_tip_load *tip = &sums->tips[role];
        tip->arm = law->stiffness * arm->value + viscous * arm->by_delta;
        tip->arm_by_origin = law->stiffness * arm->by_origin;
        tip->arm_by_delta = law->stiffness * arm->by_delta;
        tip->arm_by_speed = law->damping * arm->by_delta;
    }
}

/* One side with corners: from the cache, if that holds it. */
static OWN_STACK void set_cached_side(const gm_mesh *mesh, const gm_position *position, int side,
                                      const double approach[2], int wanted,
                                      const gmi_side_sum *found, const gmi_cache_arm arms[2],
                                      gm_mesh_result *result) {
    const int mask = wanted & GM_WANT_DERIVATIVES ? GMI_DERIVATIVES : GMI_SUM;
    const int is_held = side == mesh->cache->side;
    gmi_corner_sums sums;
    int pairs = found->pairs;

    /* The other side, and pairs that the cache does not count, are exact. */
    if (!is_held || ((wanted & GM_WANT_PAIRS) && pairs < 0)) {
        gmi_side_sum_corners(mesh, side, position, is_held ? GMI_SUM : mask, approach[side], NULL,
                             &sums);
        pairs = sums.side.pairs;
    }

    /* Sum and arms of the tips from the cache. */
    if (is_held) {
        memset(&sums, 0, sizeof sums);
        sums.side = *found;
        sums.side.pairs = pairs;
        set_cached_tips(&mesh->law, arms, approach[side], &sums);
    }

    if (side == GM_DRIVE) {
        set_drive(mesh, &sums, approach, wanted, result);
    } else if (sums.side.contact > 0.0) {
        add_coast(mesh, &sums, approach, wanted, result);
    }
}

/* The other side than that of the cache hardly ever touches, and is exact. */
static inline int is_other_clear(const gm_mesh *mesh, const gm_position *position) {
    const int other = mesh->cache->side == GM_DRIVE ? GM_COAST : GM_DRIVE;
    return gmi_side_is_clear(&mesh->engagement, &mesh->side[other], other, position->offset);
}

/* What the cache says of its side, with what the exact evaluation says of the other one, and of pairs, which it alone counts. */
static OWN_STACK int set_both_sides(const gm_mesh *mesh, const gm_position *position, int wanted,
                                    gmi_side_sum *found, gm_workspace *workspace,
                                    gm_mesh_result *result) {
    const int held = mesh->cache->side;
    const int other = held == GM_DRIVE ? GM_COAST : GM_DRIVE;
    const int mask = accumulated(mesh, position->offset_rate != 0.0, wanted);
    const gmi_side_sum *sides[2] = {&no_contact, &no_contact};
    gmi_side_sum exact;
    int status = GM_OK;
    sides[held] = found;
    if (!is_other_clear(mesh, position)) {
        status = gmi_side_sum_by_law(mesh, other, position, mask, workspace, &exact);
        sides[other] = &exact;
    }
    if (status == GM_OK && (wanted & GM_WANT_PAIRS) && found->pairs < 0) {
        gmi_side_sum counted;
        status = gmi_side_sum_by_law(mesh, held, position, GMI_SUM, workspace, &counted);
        found->pairs = counted.pairs;
    }
    if (status != GM_OK) {
        gmi_mesh_result_set_nan(result);
        return status;
    }

    const double approach[2] = {position->offset_rate, -position->offset_rate};
    set_result(mesh, sides[GM_DRIVE], sides[GM_COAST], NULL, approach, wanted, result);
    return GM_OK;
}

/* The force alone, as a run wants it, while the other side is clear: compiled without all else. */
SPECIALIZED void set_one_side(const gm_mesh *mesh, const gm_position *position,
                              const gmi_side_sum *found, gm_mesh_result *result) {
    const double approach[2] = {position->offset_rate, -position->offset_rate};
    if (mesh->cache->side == GM_DRIVE) {
        set_result(mesh, found, &no_contact, NULL, approach, GM_WANT_FORCE, result);
    } else {
        set_result(mesh, &no_contact, found, NULL, approach, GM_WANT_FORCE, result);
    }
}

/* Both sides with corners: one from the cache. */
static OWN_STACK void set_cached_sides(const gm_mesh *mesh, const gm_position *position, int wanted,
                                       const gmi_side_sum *found, const gmi_cache_arm arms[2],
                                       gm_mesh_result *result) {
    const double approach[2] = {position->offset_rate, -position->offset_rate};
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        set_cached_side(mesh, position, side, approach, wanted, found, arms, result);
    }
}

static int evaluate_cached(const gm_mesh *mesh, const gm_position *position, int wanted,
                           gm_workspace *workspace, gm_mesh_result *result) {
    gmi_side_sum found;
    gmi_cache_arm arms[2];
    const int mask = accumulated(mesh, position->offset_rate != 0.0, wanted);
    if ((wanted & (GM_WANT_WRENCH | GM_WANT_ENERGY)) ||
        !gmi_cache_look_up(mesh->cache, position, mask, workspace, &found, arms)) {
        return gmi_mesh_evaluate_exact(mesh, position, wanted, workspace, result);
    }
    if (mesh->has_corners) {
        set_cached_sides(mesh, position, wanted, &found, arms, result);
        return GM_OK;
    }
    if (wanted == GM_WANT_FORCE && is_other_clear(mesh, position)) {
        set_one_side(mesh, position, &found, result);
        return GM_OK;
    }
    return set_both_sides(mesh, position, wanted, &found, workspace, result);
}

/* A sum of enum gm_wanted. */
static inline int is_mask(int wanted) {
    return (wanted & ~GMI_WANT_ALL) == 0;
}

static inline int check_evaluation(const gm_mesh *mesh, const gm_position *position, int wanted,
                                   const gm_workspace *workspace) {
    if (mesh == NULL || position == NULL || (workspace == NULL && is_elastic(mesh))) {
        return GM_ERR_NULL;
    }
    if (!is_mask(wanted)) {
        return GM_ERR_PARAMETER;
    }
    return mesh->model == GM_MODEL_SIMPLE
               ? gmi_check_offset(position->offset, position->offset_rate)
               : gmi_check_position(mesh->pair, position);
}

/* With friction, or a cache, or teeth that bend. */
static int evaluate_special(const gm_mesh *mesh, const gm_position *position, int wanted,
                            gm_workspace *workspace, gm_mesh_result *result) {
    return mesh->cache != NULL && !mesh->friction.is_on
               ? evaluate_cached(mesh, position, wanted, workspace, result)
               : gmi_mesh_evaluate_exact(mesh, position, wanted, workspace, result);
}

static OWN_STACK int evaluate_checked(const gm_mesh *mesh, const gm_position *position, int wanted,
                                      gm_workspace *workspace, gm_mesh_result *result) {
    gm_position posed;
    if (mesh != NULL && position != NULL && mesh->is_posed) {
        posed = gmi_mesh_posed(mesh, position);
        position = &posed;
    }

    /* What is asked for, and where: as posed. */
    int status = check_evaluation(mesh, position, wanted, workspace);
    if (status == GM_OK && mesh->friction.is_on) {
        status = gmi_check_speed(position->pinion_speed);
    }
    if (status != GM_OK) {
        gmi_mesh_result_set_nan(result);
        return status;
    }

    /* By what the mesh is. */
    if (mesh->is_special) {
        return evaluate_special(mesh, position, wanted, workspace, result);
    }
    return wanted & GM_WANT_ENERGY ? evaluate_with_energy(mesh, position, wanted, result)
                                   : evaluate_any(mesh, position, wanted, result);
}

int gm_mesh_evaluate_at(const gm_mesh *mesh, const gm_position *position, int wanted,
                        gm_workspace *workspace, gm_mesh_result *result) {
    if (result == NULL) {
        return GM_ERR_NULL;
    }

    /* Most calls are for a mesh that is nothing special, and want the force alone. */
    if (mesh != NULL && position != NULL && mesh->is_plain && is_mask(wanted) &&
        gmi_check_position(mesh->pair, position) == GM_OK) {
        if (wanted != GM_WANT_FORCE) {
            return wanted & GM_WANT_ENERGY ? evaluate_with_energy(mesh, position, wanted, result)
                                           : evaluate_any(mesh, position, wanted, result);
        }
        return mesh->side[GM_DRIVE].pinion == NULL && mesh->side[GM_DRIVE].wheel == NULL
                   ? evaluate_ideal_force(mesh, position, result)
                   : evaluate_force(mesh, position, result);
    }
    return evaluate_checked(mesh, position, wanted, workspace, result);
}

int gm_mesh_evaluate(const gm_mesh *mesh, const gm_state *state, int wanted,
                     gm_workspace *workspace, gm_mesh_result *result) {
    if (result == NULL) {
        return GM_ERR_NULL;
    }
    gm_position position;
    const int status = gm_position_from_state(gm_mesh_pair(mesh), state, &position);
    if (status != GM_OK) {
        gmi_mesh_result_set_nan(result);
        return status;
    }
    return gm_mesh_evaluate_at(mesh, &position, wanted, workspace, result);
}

/* ---------------------------------------------------------------------------------------------
 * Numbers of pairs
 * ------------------------------------------------------------------------------------------- */

/* Whether lines can be told to touch without their sum: tables in the pose of the drawing, without corners. */
static int counts_alone(const gm_mesh *mesh) {
    const gmi_side *drive = &mesh->side[GM_DRIVE];
    const int has_tables = drive->pinion != NULL || drive->wheel != NULL;
    return mesh->model == GM_MODEL_3D && has_tables && mesh->elastic == NULL &&
           !mesh->has_corners && !mesh->is_posed && !mesh->engagement.is_tilted &&
           drive->ramps == 0 && mesh->side[GM_COAST].ramps == 0 && !drive->starts_deeper &&
           !mesh->side[GM_COAST].starts_deeper;
}

/* The force of a mesh that has a cache, exactly: a look-up would count nothing. */
static OWN_STACK int evaluate_beside_cache(const gm_mesh *mesh, const gm_position *position,
                                           gm_workspace *workspace, gm_mesh_result *result) {
    const gm_position posed = gmi_mesh_posed(mesh, position);
    int status = check_evaluation(mesh, &posed, GM_WANT_FORCE, workspace);
    if (status == GM_OK && mesh->friction.is_on) {
        status = gmi_check_speed(posed.pinion_speed);
    }
    return status == GM_OK ? gmi_mesh_evaluate_exact(mesh, &posed, GM_WANT_FORCE, workspace, result)
                           : status;
}

int gm_mesh_pairs_at(const gm_mesh *mesh, const gm_position *position, gm_workspace *workspace,
                     int pairs[2]) {
    if (pairs == NULL) {
        return GM_ERR_NULL;
    }
    pairs[GM_DRIVE] = pairs[GM_COAST] = 0;
    if (mesh != NULL && counts_alone(mesh)) {
        const int status = check_evaluation(mesh, position, GM_WANT_PAIRS, workspace);
        for (int side = GM_DRIVE; side <= GM_COAST && status == GM_OK; ++side) {
            pairs[side] = gmi_side_count_pairs(mesh->pair, &mesh->engagement, &mesh->side[side],
                                               side, position);
        }
        return status;
    }

    /* Any exact evaluation counts them. */
    gm_mesh_result result;
    const int status = mesh != NULL && position != NULL && mesh->cache != NULL
                           ? evaluate_beside_cache(mesh, position, workspace, &result)
                           : gm_mesh_evaluate_at(mesh, position, GM_WANT_FORCE, workspace, &result);
    if (status == GM_OK) {
        pairs[GM_DRIVE] = result.contact.drive_pairs;
        pairs[GM_COAST] = result.contact.coast_pairs;
    }
    return status;
}

/* ---------------------------------------------------------------------------------------------
 * Other flanks
 * ------------------------------------------------------------------------------------------- */

/* Whether all changes are flanks of these gears. */
static int check_changes(const gm_mesh *mesh, const gm_flanks **pinion_changes,
                         const gm_flanks **wheel_changes, int count) {
    if (count < 0 || mesh->model == GM_MODEL_SIMPLE || mesh->has_corners) {
        return GM_ERR_PARAMETER;
    }
    if (count > 0 && (pinion_changes == NULL || wheel_changes == NULL)) {
        return GM_ERR_NULL;
    }
    int status = GM_OK;
    for (int k = 0; k < count && status == GM_OK; ++k) {
        status = gmi_check_flanks(mesh->pair, pinion_changes[k], wheel_changes[k]);
    }
    return status;
}

int gm_mesh_force_by_flanks(const gm_mesh *mesh, const gm_position *position,
                            const gm_flanks **pinion_changes, const gm_flanks **wheel_changes,
                            int count, gm_workspace *workspace, double *force_by) {
    if (force_by == NULL) {
        return GM_ERR_NULL;
    }
    for (int k = 0; k < count; ++k) {
        force_by[k] = gmi_nan();
    }

    /* What is asked for, and where: as posed. */
    gm_position posed;
    if (mesh != NULL && position != NULL) {
        posed = gmi_mesh_posed(mesh, position);
        position = &posed;
    }
    int status = check_evaluation(mesh, position, GM_WANT_FORCE, workspace);
    if (status == GM_OK) {
        status = check_changes(mesh, pinion_changes, wheel_changes, count);
    }
    if (status != GM_OK) {
        return status;
    }

    /* Both sides push against each other. */
    for (int k = 0; k < count; ++k) {
        force_by[k] = 0.0;
    }
    for (int side = GM_DRIVE; side <= GM_COAST && status == GM_OK; ++side) {
        if (mesh->elastic == NULL) {
            gmi_side_by_flanks(mesh, side, position, pinion_changes, wheel_changes, count,
                               force_by);
        } else {
            status = gmi_elastic_side_by_flanks(mesh, side, position, pinion_changes, wheel_changes,
                                                count, workspace, force_by);
        }
    }
    for (int k = 0; k < count && status != GM_OK; ++k) {
        force_by[k] = gmi_nan();
    }
    return status;
}

/* ---------------------------------------------------------------------------------------------
 * In a pose of its own at every call
 * ------------------------------------------------------------------------------------------- */

/* As the axes move, each side has an approach speed of its own: its mean over what touches. */
static int sum_moving(const gm_mesh *mesh, const gm_position *position, const gmi_rates rates[2],
                      int mask, gm_workspace *workspace, gmi_side_sum sums[2], double approach[2]) {
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        if (mesh->model == GM_MODEL_SIMPLE) {
            gmi_side_sum_simple(mesh->pair, &mesh->engagement, side, position->offset, &sums[side]);
        } else {
            const int status =
                gmi_side_sum_by_law(mesh, side, position, mask, workspace, &sums[side]);
            if (status != GM_OK) {
                return status;
            }
        }
        approach[side] =
            gmi_rates_mean_approach(&rates[side], mesh->pair, &mesh->engagement, side, &sums[side]);
    }
    return GM_OK;
}

static OWN_STACK int evaluate_moving(const gm_mesh *mesh, const gm_position *position,
                                     const gmi_rates rates[2], int wanted, gm_workspace *workspace,
                                     gm_mesh_result *result) {
    const int mask = accumulated(mesh, 1, wanted) | (are_tilting(rates) ? GMI_MOMENTS : GMI_SUM) |
                     (is_elastic(mesh) ? GMI_ROLL : GMI_SUM);
    gmi_side_sum sums[2];
    double approach[2];
    const int status = sum_moving(mesh, position, rates, mask, workspace, sums, approach);
    if (status != GM_OK) {
        return status;
    }

    /* And what they mean. */
    if (is_elastic(mesh)) {
        finish_elastic(mesh, position, sums, approach, rates, wanted, mask, workspace, result);
    } else {
        set_result(mesh, &sums[GM_DRIVE], &sums[GM_COAST], NULL, approach, wanted, result);
        if (wanted & GM_WANT_ENERGY) {
            set_energy(mesh, position, result);
        }
    }
    return GM_OK;
}

/* The mesh as posed is no small thing. */
static OWN_STACK int evaluate_posed(const gm_mesh *mesh, const gm_motion *motion, int wanted,
                                    gm_workspace *workspace, gm_mesh_result *result) {
    gm_mesh moved;
    gm_position position;
    gmi_rates rates[2];

    /* The mesh where the motion has it, and whether all that is asked for can be had there. */
    int status = gmi_mesh_follow(mesh, motion, &moved, &position, rates);
    if (status == GM_OK) {
        status = check_evaluation(&moved, &position, wanted, workspace);
    }
    if (status == GM_OK && mesh->friction.is_on) {
        status = gmi_check_speed(position.pinion_speed);
    }
    if (status != GM_OK) {
        return status;
    }

    /* Axes at rest: as any mesh that was prepared there. */
    if (gmi_is_at_rest(&motion->pose_rate)) {
        return gmi_mesh_evaluate_exact(&moved, &position, wanted, workspace, result);
    }

    /* Moving axes change the speed of approach: each way to add up a side takes it in its own way. */
    if (mesh->has_corners) {
        evaluate_corners(&moved, &position, rates, wanted, result);
        return GM_OK;
    }
    if (mesh->friction.is_on && !is_elastic(mesh)) {
        evaluate_sliding(&moved, &position, rates, wanted, result);
        return GM_OK;
    }

    /* While the tilt changes, each point of a side has a speed of its own; else the whole side has one. */
    if (are_tilting(rates) && !is_elastic(mesh)) {
        evaluate_followed(&moved, &position, rates, wanted, result);
        return GM_OK;
    }
    return evaluate_moving(&moved, &position, rates, wanted, workspace, result);
}

int gm_mesh_evaluate_posed(const gm_mesh *mesh, const gm_motion *motion, int wanted,
                           gm_workspace *workspace, gm_mesh_result *result) {
    if (result == NULL) {
        return GM_ERR_NULL;
    }
    if (mesh == NULL || motion == NULL) {
        gmi_mesh_result_set_nan(result);
        return GM_ERR_NULL;
    }

    /* Where nothing but the angles moves it is the plain evaluation. */
    if (gmi_is_at_rest(&motion->pose) && gmi_is_at_rest(&motion->pose_rate)) {
        return gm_mesh_evaluate_at(mesh, &motion->position, wanted, workspace, result);
    }
    const int status = evaluate_posed(mesh, motion, wanted, workspace, result);
    if (status != GM_OK) {
        gmi_mesh_result_set_nan(result);
    }
    return status;
}
