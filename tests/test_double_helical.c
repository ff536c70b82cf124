/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Double-helical pairs: against two meshes of opposite hand between the same two bodies, which know of no mirror; closed
 * forms of symmetric pairs and of errors of one half; derivatives, equilibrium, line loads.
 */
#include "gearmesh/gearmesh.h"
#include "gm_test.h"

#include <stdlib.h>
#include <string.h>

enum { FACE_NODES = 4, PROFILE_NODES = 3, PINION_TEETH = 23, WHEEL_TEETH = 31 };

static const double degree = 3.14159265358979323846 / 180.0;
static const double gap = 6e-3;

/* The wheel is wider than the pinion, so that the contact is on the pinion's face wherever that floats. */
static gm_pair_params drawing(double helix_angle) {
    gm_pair_params params;
    gm_pair_params_default(&params);
    params.pinion_teeth = PINION_TEETH;
    params.wheel_teeth = WHEEL_TEETH;
    params.normal_module = 2e-3;
    params.normal_pressure_angle = 20.0 * degree;
    params.helix_angle = helix_angle;
    params.center_distance = 0.5 * (PINION_TEETH + WHEEL_TEETH) * 2e-3 / cos(helix_angle);
    params.pinion_face_width = 36e-3;
    params.wheel_face_width = 40e-3;
    params.axial_offset = 0.0;
    params.backlash = 60e-6;
    return params;
}

static gm_pair half_of(const gm_pair_params *whole) {
    gm_pair_params params;
    gm_pair pair;
    GM_ASSERT_INT(gm_double_helical_half(whole, gap, &params), GM_OK);
    GM_ASSERT_INT(gm_pair_init(&pair, &params), GM_OK);
    return pair;
}

static gm_mesh_params half_law(void) {
    gm_mesh_params law;
    gm_mesh_params_default(&law);
    law.stiffness = 1e8;
    law.damping = 500.0;
    return law;
}

static gm_mesh *mesh_of(const gm_mesh_params *law, const gm_pair *pair, const gm_flanks *pinion,
                        const gm_flanks *wheel) {
    const size_t size = gm_mesh_size(law, pair);
    gm_mesh *mesh;
    GM_ASSERT_INT(gm_mesh_init(&mesh, law, pair, pinion, wheel, malloc(size), size), GM_OK);
    return mesh;
}

static gm_workspace *workspace_of(const gm_mesh *mesh) {
    const size_t size = gm_workspace_size(mesh);
    gm_workspace *workspace;
    GM_ASSERT_INT(gm_workspace_init(&workspace, mesh, size > 0 ? malloc(size) : NULL, size), GM_OK);
    return workspace;
}

/* Without flanks, or with those of the first and of the second half; as drawn. */
static gm_double_helical gears_of(const gm_mesh_params *law, const gm_pair *pair,
                                  gm_flanks *const pinion[2], gm_flanks *const wheel[2]) {
    gm_double_helical gears = {.gap = gap};
    for (int k = 0; k < 2; ++k) {
        gears.half[k] =
            mesh_of(law, pair, pinion != NULL ? pinion[k] : NULL, wheel != NULL ? wheel[k] : NULL);
        gears.workspace[k] = workspace_of(gears.half[k]);
    }
    return gears;
}

static void free_gears(const gm_double_helical *gears) {
    for (int k = 0; k < 2; ++k) {
        free((void *)gears->half[k]);
        free(gears->workspace[k]);
    }
}

static gm_position position_at(const gm_pair *pair, double pinion_angle, double offset,
                               double offset_rate, double pinion_speed) {
    gm_position position;
    GM_ASSERT_INT(gm_position_from_pinion_angle(pair, pinion_angle, offset, offset_rate, &position),
                  GM_OK);
    position.pinion_speed = pinion_speed;
    return position;
}

/* ---------------------------------------------------------------------------------------------
 * Against two meshes of opposite hand between two bodies
 * ------------------------------------------------------------------------------------------- */

/* One table for all teeth and pitch of each; `back` turns the table around along the face. */
static gm_flanks *flanks_of(int teeth, const double table[FACE_NODES][PROFILE_NODES],
                            const double *pitch, int back) {
    const gm_flanks_params params = {.teeth = teeth,
                                     .drive_tables = 1,
                                     .drive_face_nodes = FACE_NODES,
                                     .drive_profile_nodes = PROFILE_NODES,
                                     .coast_tables = 1,
                                     .coast_face_nodes = FACE_NODES,
                                     .coast_profile_nodes = PROFILE_NODES};
    const size_t size = gm_flanks_size(&params);
    gm_flanks *flanks;
    double rows[FACE_NODES][PROFILE_NODES];
    GM_ASSERT_INT(gm_flanks_init(&flanks, &params, malloc(size), size), GM_OK);
    for (int i = 0; i < FACE_NODES; ++i) {
        memcpy(rows[i], table[back ? FACE_NODES - 1 - i : i], sizeof rows[i]);
    }
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        GM_ASSERT_INT(gm_flanks_set_table(flanks, side, GM_ALL_TEETH, &rows[0][0], 1.0), GM_OK);
        for (int tooth = 0; tooth < teeth; ++tooth) {
            GM_ASSERT_INT(gm_flanks_set_pitch(flanks, side, tooth, pitch[tooth]), GM_OK);
        }
    }
    return flanks;
}

/* R = exp(rotation vector in the plane z = 0) * rotation about z. */
static void rotation_of(double skew, double inclination, double about_z, double r[9]) {
    const double angle = hypot(skew, inclination);
    const double x = angle > 0.0 ? skew / angle : 1.0, y = angle > 0.0 ? inclination / angle : 0.0;
    const double c = cos(angle), s = sin(angle), v = 1.0 - c;
    const double tilt[9] = {c + x * x * v, x * y * v, y * s, x * y * v, c + y * y * v,
                            -x * s,        -y * s,    x * s, c};
    const double cz = cos(about_z), sz = sin(about_z);
    for (int i = 0; i < 3; ++i) {
        r[3 * i] = tilt[3 * i] * cz + tilt[3 * i + 1] * sz;
        r[3 * i + 1] = -tilt[3 * i] * sz + tilt[3 * i + 1] * cz;
        r[3 * i + 2] = tilt[3 * i + 2];
    }
}

/* What both halves of one wheel and one pinion do to each other as bodies in space, about z = 0 on the pinion's axis and on
 * the wheel's, moved by the pose but not tilted. */
typedef struct whole_load {
    double pinion_force[3], pinion_moment[3], wheel_force[3], wheel_moment[3];
    double force[2]; /* of each half along its line of action */
    double pinion_torque, wheel_torque, loss, energy;
} whole_load;

typedef struct two_bodies {
    gm_pair_params whole;
    gm_pose pose, pose_rate;
    double angle[2], speed[2], apex;
    int along_wheel;  /* 1: the pinion floats along the axis of the wheel, 0: along its own */
    gm_mesh *mesh[2]; /* as drawn: of the hand of each half */
    gm_workspace *workspace[2];
} two_bodies;

static void add_about(const gm_load *load, const double at[3], const double about[3],
                      double force[3], double moment[3]) {
    const double r[3] = {at[0] - about[0], at[1] - about[1], at[2] - about[2]};
    const double *f = load->force;
    moment[0] += load->moment[0] + r[1] * f[2] - r[2] * f[1];
    moment[1] += load->moment[1] + r[2] * f[0] - r[0] * f[2];
    moment[2] += load->moment[2] + r[0] * f[1] - r[1] * f[0];
    for (int i = 0; i < 3; ++i) {
        force[i] += f[i];
    }
}

/* Middle and axes of half k of the wheel after some time, in which pose and angle go on as they do; phi_w is its angle now. */
static void place_wheel(const two_bodies *gears, int k, double phi_w, double time, double middle[3],
                        double rotation[9]) {
    const gm_pair *pair = gm_mesh_pair(gears->mesh[k]);
    const gm_pose *pose = &gears->pose, *rate = &gears->pose_rate;
    const double to_half = (k == 0 ? -0.5 : 0.5) * (pair->wheel.face_width + gap);
    middle[0] =
        pair->center_distance + pose->center_distance_change + time * rate->center_distance_change;
    middle[1] = pose->offset + time * rate->offset;
    middle[2] = 0.5 * gears->whole.pinion_face_width;
    rotation_of(pose->skew + time * rate->skew, pose->inclination + time * rate->inclination,
                -(phi_w + time * gears->speed[1]), rotation);
    for (int i = 0; i < 3; ++i) {
        const double axis = rotation[3 * i + 2];
        const double own_axis = i == 2 ? 1.0 : 0.0;
        middle[i] += to_half * axis - gears->apex * (gears->along_wheel ? axis : own_axis);
    }
}

/* The wheel's half as a body, with its velocities by differences: R' R^T is the angular velocity's cross product. */
static gm_body wheel_body(const two_bodies *gears, int k, double phi_w) {
    const double time = 1e-7;
    gm_body body = {.velocity = {0.0}};
    double before[3], after[3], turned_before[9], turned_after[9];
    place_wheel(gears, k, phi_w, 0.0, body.position, body.rotation);
    place_wheel(gears, k, phi_w, -time, before, turned_before);
    place_wheel(gears, k, phi_w, time, after, turned_after);
    double spin[3][3] = {{0.0}};
    for (int i = 0; i < 3; ++i) {
        body.velocity[i] = (after[i] - before[i]) / (2.0 * time);
        for (int j = 0; j < 3; ++j) {
            for (int m = 0; m < 3; ++m) {
                const double change = turned_after[3 * i + m] - turned_before[3 * i + m];
                spin[i][j] += change / (2.0 * time) * body.rotation[3 * j + m];
            }
        }
    }
    body.angular_velocity[0] = 0.5 * (spin[2][1] - spin[1][2]);
    body.angular_velocity[1] = 0.5 * (spin[0][2] - spin[2][0]);
    body.angular_velocity[2] = 0.5 * (spin[1][0] - spin[0][1]);
    return body;
}

static whole_load load_of(const two_bodies *gears) {
    whole_load sum = {{0.0}, {0.0}, {0.0}, {0.0}, {0.0}, 0.0, 0.0, 0.0, 0.0};
    const double pinion_width = gears->whole.pinion_face_width;
    for (int k = 0; k < 2; ++k) {
        const gm_pair *pair = gm_mesh_pair(gears->mesh[k]);
        const double sign = k == 0 ? -1.0 : 1.0; /* towards which end of the axis the half is */

        /* Tooth 0 stands on the centre line at the pinion's face I, and at face II. The second half begins at the gap. */
        const double begins = k == 0 ? 0.0 : pair->pinion.face_width;
        const double helix =
            tan(fabs(pair->base_helix_angle)) * (gears->whole.helix_angle > 0.0 ? 1.0 : -1.0);
        const double phi_p = gears->angle[0] + begins * helix / pair->pinion.base_radius;
        const double phi_w = gears->angle[1] + begins * helix / pair->wheel.base_radius;

        /* The points of both: the middles of the halves on the axes of the whole gears. */
        gm_body pinion = {
            .position = {0.0, 0.0,
                         0.5 * pinion_width + sign * 0.5 * (pair->pinion.face_width + gap)},
            .angular_velocity = {0.0, 0.0, gears->speed[0]}};
        const gm_body wheel = wheel_body(gears, k, phi_w);
        rotation_of(0.0, 0.0, phi_p, pinion.rotation);

        gm_mesh_result result;
        gm_load on_pinion, on_wheel;
        GM_ASSERT_INT(gm_mesh_evaluate_bodies(gears->mesh[k], &pinion, &wheel, GM_WANT_ENERGY,
                                              gears->workspace[k], &result, &on_pinion, &on_wheel),
                      GM_OK);
        const double about_pinion[3] = {0.0, 0.0, 0.0};
        const double about_wheel[3] = {pair->center_distance + gears->pose.center_distance_change,
                                       gears->pose.offset, 0.0};
        add_about(&on_pinion, pinion.position, about_pinion, sum.pinion_force, sum.pinion_moment);
        add_about(&on_wheel, wheel.position, about_wheel, sum.wheel_force, sum.wheel_moment);
        sum.force[k] = result.force;
        sum.pinion_torque += result.pinion_torque;
        sum.wheel_torque += result.wheel_torque;
        sum.loss += result.loss;
        sum.energy += result.energy;
    }
    return sum;
}

static void compare_vectors(const double got[3], const double expected[3], double allowed) {
    for (int i = 0; i < 3; ++i) {
        GM_ASSERT_ABS(got[i], expected[i], allowed);
    }
}

/* The same gears both ways: the halves of the library, one hand and mirrored; and two meshes of opposite hand. */
typedef struct both_ways {
    gm_pair_params whole;
    gm_pair pair; /* of a half, as the library has it */
    gm_mesh_params law;
    gm_pose pose, poses[2];
    gm_double_helical gears;
    two_bodies bodies;
    gm_flanks *flanks[2][2][2]; /* [way][half][role] */
} both_ways;

/* Deviations on the pinion, another for each half, and pitch on both. */
typedef struct half_deviations {
    double table[2][FACE_NODES][PROFILE_NODES], pitch[2][2][WHEEL_TEETH];
} half_deviations;

/* Friction, tip edges and elastic teeth in turn; every third pair as drawn, others with all of a pose. */
static void draw_case(both_ways *made, int i, uint64_t *seed) {
    const double helix = (i % 2 == 0 ? 1.0 : -1.0) * gm_test_uniform(seed, 12.0, 32.0) * degree;
    made->whole = drawing(helix);
    made->pair = half_of(&made->whole);
    made->law = half_law();
    made->law.friction_coefficient = i % 3 == 0 ? 0.06 : 0.0;
    made->law.corner_contact = i % 4 == 1 ? GM_CORNER_ON : GM_CORNER_BY_LAW;
    if (i % 4 == 3) { /* with tip edges, as that law has them */
        made->law.law = GM_LAW_ELASTIC;
        made->law.stations = 5;
        made->law.reference_torque = 50.0;
    }

    made->pose = (gm_pose){0.0, 0.0, 0.0, 0.0, 0.0};
    if (i % 3 != 1) {
        made->pose.center_distance_change = gm_test_uniform(seed, -40e-6, 40e-6);
        made->pose.offset = gm_test_uniform(seed, -20e-6, 20e-6);
        made->pose.skew = gm_test_uniform(seed, -1e-3, 1e-3);
        made->pose.inclination = gm_test_uniform(seed, -1e-3, 1e-3);
    }
    GM_ASSERT_INT(gm_double_helical_pose(&made->pair, gap, &made->pose, made->poses), GM_OK);
}

/* With relief at the gap, where a float would move the ends of the faces against each other. */
static void draw_deviations(half_deviations *d, uint64_t *seed) {
    for (int k = 0; k < 2; ++k) {
        for (int node = 0; node < FACE_NODES * PROFILE_NODES; ++node) {
            d->table[k][node / PROFILE_NODES][node % PROFILE_NODES] =
                gm_test_uniform(seed, -3e-6, 3e-6);
        }
        for (int column = 0; column < PROFILE_NODES; ++column) {
            d->table[k][FACE_NODES - 1][column] = -300e-6;
        }
        for (int tooth = 0; tooth < WHEEL_TEETH; ++tooth) {
            d->pitch[GM_PINION][k][tooth] = gm_test_uniform(seed, -4e-6, 4e-6);
            d->pitch[GM_WHEEL][k][tooth] = gm_test_uniform(seed, -4e-6, 4e-6);
        }
    }
}

/* Half k as a pair of its own hand. */
static gm_pair pair_of_hand(const gm_pair_params *whole, int k) {
    gm_pair_params hand;
    gm_pair pair;
    GM_ASSERT_INT(gm_double_helical_half(whole, gap, &hand), GM_OK);
    if (k == 1) {
        hand.helix_angle = -whole->helix_angle;
        hand.axial_offset = -hand.axial_offset; /* both end at the gap, which is now face I */
    }
    GM_ASSERT_INT(gm_pair_init(&pair, &hand), GM_OK);
    return pair;
}

static void make_both_ways(both_ways *made, int i, uint64_t *seed) {
    static const double even[FACE_NODES][PROFILE_NODES] = {{0.0}};
    half_deviations d;
    draw_case(made, i, seed);
    draw_deviations(&d, seed);

    made->gears = (gm_double_helical){.gap = gap};
    made->bodies = (two_bodies){.whole = made->whole, .pose = made->pose};
    for (int k = 0; k < 2; ++k) {
        /* Tables of the second half run the other way along the face where it has its own hand. */
        gm_flanks *(*flanks)[2][2] = made->flanks;
        for (int way = 0; way < 2; ++way) {
            const int back = way == 1 && k == 1;
            flanks[way][k][GM_PINION] =
                flanks_of(PINION_TEETH, (const double(*)[PROFILE_NODES])d.table[k],
                          d.pitch[GM_PINION][k], back);
            flanks[way][k][GM_WHEEL] = flanks_of(WHEEL_TEETH, even, d.pitch[GM_WHEEL][k], back);
        }

        gm_mesh_params posed = made->law;
        posed.pose = made->poses[k];
        made->gears.half[k] =
            mesh_of(&posed, &made->pair, flanks[0][k][GM_PINION], flanks[0][k][GM_WHEEL]);
        made->gears.workspace[k] = workspace_of(made->gears.half[k]);

        const gm_pair of_hand = pair_of_hand(&made->whole, k);
        made->bodies.mesh[k] =
            mesh_of(&made->law, &of_hand, flanks[1][k][GM_PINION], flanks[1][k][GM_WHEEL]);
        made->bodies.workspace[k] = workspace_of(made->bodies.mesh[k]);
    }
}

static void free_both_ways(both_ways *made) {
    for (int k = 0; k < 2; ++k) {
        for (int way = 0; way < 2; ++way) {
            free(made->flanks[way][k][GM_PINION]);
            free(made->flanks[way][k][GM_WHEEL]);
        }
        free(made->bodies.mesh[k]);
        free(made->bodies.workspace[k]);
    }
    free_gears(&made->gears);
}

/* Both sides add up; and the arms of tilted halves: their axes stand where their poses say, not where the whole's does. */
static void check_sums(const both_ways *made, const gm_mesh_result each[2],
                       const gm_mesh_result *result) {
    GM_ASSERT_REL(result->drive_force - result->coast_force, result->force, 1e-14);
    GM_ASSERT_REL(result->drive_force + result->coast_force,
                  each[0].drive_force + each[0].coast_force + each[1].drive_force +
                      each[1].coast_force,
                  1e-14);

    const gm_penetration *contact = &result->contact;
    const gm_mesh_params *law = &made->law;
    if (law->law != GM_LAW_ELASTIC) {
        GM_ASSERT_REL(2.0 * law->stiffness * contact->drive +
                          2.0 * law->damping * contact->drive_rate,
                      result->drive_force, 1e-12);
        GM_ASSERT_REL(2.0 * law->stiffness * contact->coast +
                          2.0 * law->damping * contact->coast_rate,
                      result->coast_force, 1e-12);
    }
    GM_ASSERT_REL(contact->drive - contact->coast, contact->penetration, 1e-14);
    GM_ASSERT_REL(contact->drive_rate - contact->coast_rate, contact->rate, 1e-14);
    GM_ASSERT_REL(contact->coast_contact,
                  0.5 * (each[0].contact.coast_contact + each[1].contact.coast_contact), 1e-15);
    GM_ASSERT_INT(contact->coast_pairs, each[0].contact.coast_pairs + each[1].contact.coast_pairs);

    double moment = 0.0;
    for (int k = 0; k < 2; ++k) {
        const double x = made->poses[k].center_distance_change - made->pose.center_distance_change;
        const double y = made->poses[k].offset - made->pose.offset;
        const gm_wrench *half = &each[k].wrench;
        moment += half->wheel_moment[2] + x * half->wheel_force[1] - y * half->wheel_force[0];
    }
    GM_ASSERT_ABS(result->wrench.wheel_moment[2], moment,
                  1e-13 * fabs(result->force) * made->pair.wheel.base_radius);
}

static void compare_loads(const gm_mesh_result each[2], const gm_mesh_result *result,
                          const whole_load *load, double allowed, double radius) {
    const double force = fabs(result->force);
    GM_ASSERT(force > 100.0);
    GM_ASSERT_ABS(load->force[0], load->force[1], allowed);
    GM_ASSERT_ABS(each[0].force, load->force[0], allowed);
    GM_ASSERT_ABS(each[1].force, load->force[1], allowed);
    GM_ASSERT_ABS(result->force, load->force[0] + load->force[1], 2.0 * allowed);

    GM_ASSERT_ABS(result->pinion_torque, load->pinion_torque, 2.0 * allowed * radius);
    GM_ASSERT_ABS(result->wheel_torque, load->wheel_torque, 2.0 * allowed * radius);
    GM_ASSERT_ABS(result->loss, load->loss, 2.0 * allowed / force * load->loss);
    GM_ASSERT_ABS(result->energy, load->energy, 4.0 * allowed / force * load->energy);

    compare_vectors(result->wrench.pinion_force, load->pinion_force, 2.0 * allowed);
    compare_vectors(result->wrench.wheel_force, load->wheel_force, 2.0 * allowed);
    compare_vectors(result->wrench.pinion_moment, load->pinion_moment, 2.0 * allowed * radius);
    compare_vectors(result->wrench.wheel_moment, load->wheel_moment, 2.0 * allowed * radius);
}

/*
 * What the float s along the axis of a wheel tilted by theta does not do, and one along the pinion's own axis k does: the axis
 * a of the wheel is k + theta x k, so that -s k is -s a and a shift of the wheel across by s theta x k = s (inclination,
 * -skew, 0). Its component along the line of action (sin alpha, +-cos alpha, 0) takes that much overlap from both halves, as
 * the mirror turns both s and theta round. What is left is of second order in the tilt, times the wheel's half length of 20
 * mm over radii of curvature of some mm, one of them at least.
 */
static double lost_overlap(const both_ways *made, double force, double apex) {
    const double alpha = made->pair.working_pressure_angle;
    const double side = force > 0.0 ? 1.0 : -1.0;
    return side * apex *
           (made->pose.inclination * sin(alpha) - side * made->pose.skew * cos(alpha));
}

/*
 * Pinion and wheel in space, each with two halves, the wheel moved back by the float that was found. Both are the same
 * overlaps by other ways: roundings of 1e-16 m of overlaps of some um, and of angles of 1e-16 of radii, which is 1e-9. The
 * library's pinion floats along the axis of the wheel; along its own it loses the overlap above. The float does not shorten
 * the common face, over which elastic teeth carry each other: float over face width.
 */
static void both_halves_are_two_meshes_between_two_bodies(void) {
    uint64_t seed = 71;
    double largest_lost = 0.0; /* m */
    for (int i = 0; i < 60; ++i) {
        gm_test_context("case %d", i);
        both_ways made;
        make_both_ways(&made, i, &seed);

        /* Somewhere under load, turning. */
        const double torque = (i % 5 == 0 ? -1.0 : 1.0) * gm_test_uniform(&seed, 20.0, 200.0);
        const double angle = gm_test_uniform(&seed, -3.0, 3.0);
        const double speed = gm_test_uniform(&seed, 10.0, 100.0);
        double offset, apex = 0.0;
        gm_mesh_result each[2], result;
        GM_ASSERT_INT(gm_double_helical_equilibrium(&made.gears, angle, speed, torque, (double)NAN,
                                                    &offset, &apex, each, &result),
                      GM_OK);
        const gm_position position = position_at(&made.pair, angle, offset, 1e-3, speed);
        GM_ASSERT_INT(gm_double_helical_evaluate_at(&made.gears, &position,
                                                    GM_WANT_WRENCH | GM_WANT_ENERGY, &apex, each,
                                                    &result),
                      GM_OK);

        /* The same as bodies. */
        const double r_bp = made.pair.pinion.base_radius, r_bw = made.pair.wheel.base_radius;
        made.bodies.angle[0] = angle;
        made.bodies.angle[1] = (r_bp * angle - offset) / r_bw;
        made.bodies.speed[0] = speed;
        made.bodies.speed[1] = (r_bp * speed - 1e-3) / r_bw;
        made.bodies.apex = apex;
        made.bodies.along_wheel = 1;
        const whole_load load = load_of(&made.bodies);

        const double tilt = fabs(made.pose.skew) + fabs(made.pose.inclination);
        const double stiffness = gm_mesh_touching_stiffness(made.gears.half[0], &result);
        const double of_face =
            made.law.law == GM_LAW_ELASTIC ? fabs(apex) / made.pair.face_width : 0.0;
        const double allowed =
            (1e-7 + of_face) * fabs(result.force) + 20.0 * tilt * tilt * fabs(apex) * stiffness;
        compare_loads(each, &result, &load, allowed, r_bw);
        check_sums(&made, each, &result);

        /* Along its own axis: both halves lose the same. */
        made.bodies.along_wheel = 0;
        const whole_load own = load_of(&made.bodies);
        const double lost = lost_overlap(&made, result.force, apex);
        for (int k = 0; k < 2; ++k) {
            const double slope = -each[k].force_by.wheel_angle / r_bw;
            GM_ASSERT_ABS(own.force[k], each[k].force - lost * slope, allowed);
        }
        largest_lost = fmax(largest_lost, fabs(lost));

        /* The axial forces cancel, though the halves are not alike. */
        GM_ASSERT_ABS(result.wrench.pinion_force[2], 0.0, 1e-9 * fabs(result.force));
        GM_ASSERT(fabs(apex) > 1e-8);
        free_both_ways(&made);
    }
    gm_test_context("%s", "");
    GM_ASSERT(largest_lost > 0.03e-6);
}

/*
 * The wheel somewhere beside the pose that the halves were prepared in, and moving on: the same as halves that were prepared
 * there, but for rounding; and as bodies, whose velocities damping feels. Of a changing tilt that is of first order, so that
 * what damping adds is off by the tilt. The axial shift, and its rate, take the pinion along.
 */
static void a_wheel_that_moves_is_two_meshes_between_two_bodies(void) {
    uint64_t seed = 72;
    int felt = 0;
    for (int i = 0; i < 40; ++i) {
        gm_test_context("case %d", i);
        both_ways made;
        make_both_ways(&made, i, &seed);
        gm_motion motion = {
            .pose = {gm_test_uniform(&seed, -40e-6, 40e-6), gm_test_uniform(&seed, -20e-6, 20e-6),
                     gm_test_uniform(&seed, -1e-3, 1e-3), gm_test_uniform(&seed, -1e-3, 1e-3),
                     gm_test_uniform(&seed, -1e-3, 1e-3)},
            .pose_rate = {gm_test_uniform(&seed, -0.3, 0.3), gm_test_uniform(&seed, -0.3, 0.3),
                          gm_test_uniform(&seed, -0.3, 0.3), gm_test_uniform(&seed, -5.0, 5.0),
                          gm_test_uniform(&seed, -5.0, 5.0)}};

        /* All of the pose at once. */
        gm_pose whole = made.pose;
        whole.center_distance_change += motion.pose.center_distance_change;
        whole.offset += motion.pose.offset;
        whole.skew += motion.pose.skew;
        whole.inclination += motion.pose.inclination;
        gm_pose poses[2];
        gm_double_helical there = {.gap = gap};
        GM_ASSERT_INT(gm_double_helical_pose(&made.pair, gap, &whole, poses), GM_OK);
        for (int k = 0; k < 2; ++k) {
            gm_mesh_params posed = made.law;
            posed.pose = poses[k];
            there.half[k] = mesh_of(&posed, &made.pair, made.flanks[0][k][GM_PINION],
                                    made.flanks[0][k][GM_WHEEL]);
            there.workspace[k] = workspace_of(there.half[k]);
        }

        /* Under load there; then the wheel moves on. */
        const double torque = (i % 5 == 0 ? -1.0 : 1.0) * gm_test_uniform(&seed, 20.0, 200.0);
        const double angle = gm_test_uniform(&seed, -3.0, 3.0);
        const double speed = gm_test_uniform(&seed, 10.0, 100.0);
        const int wanted = GM_WANT_WRENCH | GM_WANT_ENERGY;
        double offset, apex = 0.0;
        gm_mesh_result each[2], result, expected;
        GM_ASSERT_INT(gm_double_helical_equilibrium(&there, angle, speed, torque, (double)NAN,
                                                    &offset, &apex, each, &result),
                      GM_OK);
        motion.position = position_at(&made.pair, angle, offset, 1e-3, speed);
        GM_ASSERT_INT(
            gm_double_helical_evaluate_at(&there, &motion.position, wanted, &apex, each, &expected),
            GM_OK);
        gm_motion standing = motion;
        standing.pose_rate = (gm_pose){0.0, 0.0, 0.0, 0.0, 0.0};
        double moved_apex = 0.0;
        GM_ASSERT_INT(gm_double_helical_evaluate_posed(&made.gears, &standing, wanted, &moved_apex,
                                                       each, &result),
                      GM_OK);

        /* Overlaps of some um from angles and distances with 1e-16; compliances of elastic teeth are tabulated along the
         * path as prepared, to 1e-4 of what they are. */
        const int is_elastic = made.law.law == GM_LAW_ELASTIC;
        const double little = is_elastic ? 2e-4 : 1e-8;
        const double force = fabs(expected.force), radius = made.pair.wheel.base_radius;
        GM_ASSERT_REL(result.force, expected.force, little);
        GM_ASSERT_REL(result.energy, expected.energy, 2.0 * little);
        GM_ASSERT_REL(result.pinion_torque, expected.pinion_torque, little);
        GM_ASSERT_ABS(moved_apex, apex, little * 1e-4);
        compare_vectors(result.wrench.pinion_force, expected.wrench.pinion_force, little * force);
        compare_vectors(result.wrench.wheel_force, expected.wrench.wheel_force, little * force);
        compare_vectors(result.wrench.pinion_moment, expected.wrench.pinion_moment,
                        little * force * radius);
        compare_vectors(result.wrench.wheel_moment, expected.wrench.wheel_moment,
                        little * force * radius);

        /* With its rates, as bodies. Elastic teeth know the common face, which the float moves. */
        const double without = result.force;
        GM_ASSERT_INT(gm_double_helical_evaluate_posed(&made.gears, &motion, wanted, &moved_apex,
                                                       each, &result),
                      GM_OK);

        /* The same motion of two bodies. */
        const double r_bp = made.pair.pinion.base_radius, r_bw = made.pair.wheel.base_radius;
        made.bodies.pose = whole;
        made.bodies.pose_rate = motion.pose_rate;
        made.bodies.angle[0] = angle;
        made.bodies.angle[1] = (r_bp * angle - offset) / r_bw;
        made.bodies.speed[0] = speed;
        made.bodies.speed[1] = (r_bp * speed - 1e-3) / r_bw;
        made.bodies.apex = moved_apex;
        made.bodies.along_wheel = 1;
        const whole_load load = load_of(&made.bodies);

        /* What a float between tilted axes leaves out, and damping by one speed on each side. */
        const double tilt = fabs(whole.skew) + fabs(whole.inclination);
        const double stiffness = gm_mesh_touching_stiffness(made.gears.half[0], &result);
        const double damped = fabs(result.force - without);
        const double allowed = 1e-7 * fabs(result.force) + 4.0 * tilt * damped +
                               20.0 * tilt * tilt * fabs(moved_apex) * stiffness;
        if (!is_elastic) {
            compare_loads(each, &result, &load, allowed, r_bw);
            felt += damped > 0.05 * fabs(result.force);
        }

        free_gears(&there);
        free_both_ways(&made);
    }
    gm_test_context("%s", "");
    GM_ASSERT(felt > 10);
}

/* ---------------------------------------------------------------------------------------------
 * Closed forms
 * ------------------------------------------------------------------------------------------- */

static void halves_without_deviations_are_alike(void) {
    const gm_pair_params whole = drawing(24.0 * degree);
    const gm_pair pair = half_of(&whole);
    const gm_mesh_params law = half_law();
    const gm_double_helical gears = gears_of(&law, &pair, NULL, NULL);
    for (int i = 0; i < 20; ++i) {
        gm_position position = position_at(&pair, 0.013 * i, 40e-6, 2e-3, 50.0);
        double apex = 0.0;
        gm_mesh_result each[2], result, half;
        GM_ASSERT_INT(gm_double_helical_evaluate_at(&gears, &position,
                                                    GM_WANT_WRENCH | GM_WANT_DERIVATIVES, &apex,
                                                    each, &result),
                      GM_OK);
        GM_ASSERT_INT(
            gm_mesh_evaluate_at(gears.half[0], &position, GM_WANT_DERIVATIVES, NULL, &half), GM_OK);

        /* Twice one half; nothing along the axis, and no tilting moment of axial forces about the middle. */
        GM_ASSERT(result.force > 0.0);
        GM_ASSERT_REL(result.force, 2.0 * half.force, 1e-14);
        GM_ASSERT_REL(result.force_by.wheel_angle, 2.0 * half.force_by.wheel_angle, 1e-13);
        GM_ASSERT_REL(result.contact.penetration, half.contact.penetration, 1e-14);
        GM_ASSERT_REL(result.contact.drive_contact, half.contact.drive_contact, 1e-14);
        GM_ASSERT_INT(result.contact.drive_pairs, 2 * half.contact.drive_pairs);
        GM_ASSERT_ABS(result.wrench.pinion_force[2], 0.0, 1e-12 * result.force);
        GM_ASSERT_ABS(result.wrench.wheel_force[2], 0.0, 1e-12 * result.force);
        GM_ASSERT(fabs(each[0].wrench.pinion_force[2]) > 0.3 * each[0].force);
        const double middle = 0.5 * whole.pinion_face_width;
        GM_ASSERT_ABS(result.wrench.pinion_moment[0] + middle * result.wrench.pinion_force[1], 0.0,
                      1e-12 * result.force);
        GM_ASSERT_ABS(result.wrench.pinion_moment[1] - middle * result.wrench.pinion_force[0], 0.0,
                      1e-12 * result.force);
        GM_ASSERT(apex == 0.0);
    }
    free_gears(&gears);
}

/* At a given overlap each section hands on the same force over a tooth, whichever lines it belongs to. */
static void mean_force_is_that_of_a_single_helix_of_the_summed_width(void) {
    gm_pair_params whole = drawing(24.0 * degree);
    whole.pinion_face_width = whole.wheel_face_width = 36e-3;
    const gm_pair pair = half_of(&whole);
    const gm_mesh_params law = half_law();
    const gm_double_helical gears = gears_of(&law, &pair, NULL, NULL);

    whole.pinion_face_width = whole.wheel_face_width = 36e-3 - gap;
    gm_pair single;
    gm_mesh_params single_law = law;
    single_law.stiffness = 2.0 * law.stiffness;
    single_law.damping = 2.0 * law.damping;
    GM_ASSERT_INT(gm_pair_init(&single, &whole), GM_OK);
    gm_mesh *mesh = mesh_of(&single_law, &single, NULL, NULL);

    double both = 0.0, one = 0.0, apex = 0.0;
    enum { POSITIONS = 2000 };
    for (int i = 0; i < POSITIONS; ++i) {
        const double angle = single.pinion.pitch_angle * i / POSITIONS;
        const gm_position position = position_at(&pair, angle, 40e-6, 1e-3, 50.0);
        gm_mesh_result each[2], result;
        GM_ASSERT_INT(
            gm_double_helical_evaluate_at(&gears, &position, GM_WANT_FORCE, &apex, each, &result),
            GM_OK);
        both += result.force;
        GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, GM_WANT_FORCE, NULL, &result), GM_OK);
        one += result.force;
    }
    /* Sums over a period of a function with kinks: (1 / POSITIONS)^2. */
    GM_ASSERT_REL(both, one, 1e-6);
    free(mesh);
    free_gears(&gears);
}

/* In equilibrium with friction, from any guess: each half carries what it would alone. */
static void friction_is_in_the_equilibrium(void) {
    const gm_pair_params whole = drawing(24.0 * degree);
    const gm_pair pair = half_of(&whole);
    gm_mesh_params law = half_law();
    law.friction_coefficient = 0.1;
    const gm_double_helical gears = gears_of(&law, &pair, NULL, NULL);
    for (int i = 0; i < 8; ++i) {
        const double angle = 0.03 * i, torque = i % 2 == 0 ? 150.0 : -90.0;
        double offset, apex = 1e-6 * i, alone;
        gm_mesh_result each[2], result, half;
        GM_ASSERT_INT(gm_double_helical_equilibrium(&gears, angle, 60.0, torque,
                                                    i > 3 ? (double)NAN : 50e-6, &offset, &apex,
                                                    each, &result),
                      GM_OK);
        GM_ASSERT_INT(gm_rolling_equilibrium(gears.half[0], angle, 60.0, 0.5 * torque, (double)NAN,
                                             NULL, &alone, &half),
                      GM_OK);

        /* Half the torque on a half alone is the same state, and nothing moves along the axis. */
        GM_ASSERT_REL(offset, alone, 1e-10);
        GM_ASSERT_REL(result.wheel_torque, torque, 1e-12);
        GM_ASSERT_REL(result.force, 2.0 * half.force, 1e-10);
        GM_ASSERT_REL(result.loss, 2.0 * half.loss, 1e-9);
        GM_ASSERT(fabs(result.loss) > 1.0);
        GM_ASSERT_ABS(apex, 0.0, 1e-15);

        /* Whatever was not asked for is no number. */
        const gm_position position = position_at(&pair, angle, offset, 0.0, 60.0);
        GM_ASSERT_INT(
            gm_double_helical_evaluate_at(&gears, &position, GM_WANT_FORCE, &apex, each, &result),
            GM_OK);
        GM_ASSERT_NAN(result.contact.d_pinion_angle);
        GM_ASSERT_NAN(result.contact.d_wheel_angle);
        GM_ASSERT_NAN(result.force_by.wheel_angle);
        GM_ASSERT_NAN(result.wrench.wheel_force[0]);
    }
    free_gears(&gears);
}

static gm_flanks *shifted_flanks(int teeth, double drive, int only_tooth) {
    const gm_flanks_params params = {.teeth = teeth,
                                     .drive_face_nodes = 2,
                                     .drive_profile_nodes = 2,
                                     .coast_face_nodes = 2,
                                     .coast_profile_nodes = 2};
    const size_t size = gm_flanks_size(&params);
    gm_flanks *flanks;
    GM_ASSERT_INT(gm_flanks_init(&flanks, &params, malloc(size), size), GM_OK);
    GM_ASSERT_INT(gm_flanks_set_pitch(flanks, GM_DRIVE, only_tooth, drive), GM_OK);
    return flanks;
}

/* A half with thicker teeth: the pinion floats until both press alike, f / (2 tan(beta_b)). */
static void the_apex_moves_by_half_the_error_of_one_half(void) {
    const double error = 8e-6;
    for (int hand = -1; hand <= 1; hand += 2) {
        const gm_pair_params whole = drawing(hand * 24.0 * degree);
        const gm_pair pair = half_of(&whole);
        const gm_mesh_params law = half_law();
        gm_flanks *thick = shifted_flanks(PINION_TEETH, error, GM_ALL_TEETH);
        gm_flanks *const pinion[2] = {thick, NULL};
        const gm_double_helical gears = gears_of(&law, &pair, pinion, NULL);
        const gm_double_helical ideal = gears_of(&law, &pair, NULL, NULL);
        gm_mesh_result each[2], result, without;
        double apex = 0.0, none = 0.0;
        const gm_position position = position_at(&pair, 0.3, 40e-6, 1e-3, 50.0);
        GM_ASSERT_INT(
            gm_double_helical_evaluate_at(&gears, &position, GM_WANT_WRENCH, &apex, each, &result),
            GM_OK);
        const gm_position deeper = position_at(&pair, 0.3, 40e-6 + 0.5 * error, 1e-3, 50.0);
        GM_ASSERT_INT(
            gm_double_helical_evaluate_at(&ideal, &deeper, GM_WANT_FORCE, &none, each, &without),
            GM_OK);
        /* The ends of the path follow x, not the thickness: error over its length. */
        const double path = pair.path_end - pair.path_start;
        GM_ASSERT_REL(apex, 0.5 * error / tan(pair.base_helix_angle), 2.0 * error / path);
        GM_ASSERT_REL(result.force, without.force, 2.0 * error / path);
        GM_ASSERT_ABS(result.wrench.pinion_force[2], 0.0, 1e-9 * result.force);
        free(thick);
        free_gears(&gears);
        free_gears(&ideal);
    }
}

/* One tooth of one half, with elastic teeth too: wherever it is, both halves carry the same. */
static void both_halves_carry_the_same_past_a_tooth_with_an_error(void) {
    const gm_pair_params whole = drawing(24.0 * degree);
    const gm_pair pair = half_of(&whole);
    for (int elastic = 0; elastic < 2; ++elastic) {
        gm_mesh_params law = half_law();
        law.law = elastic ? GM_LAW_ELASTIC : GM_LAW_CONSTANT;

        /* One thick tooth on the first half of the pinion. */
        gm_flanks *thick = shifted_flanks(PINION_TEETH, 10e-6, 0);
        gm_flanks *const pinion[2] = {thick, NULL};
        const gm_double_helical gears = gears_of(&law, &pair, pinion, NULL);

        /* It passes through the mesh, and the pinion gives way along its axis. */
        double lowest = HUGE_VAL, highest = -HUGE_VAL, apex = 0.0;
        for (int i = -8; i < 8; ++i) {
            const double angle = 0.25 * i * pair.pinion.pitch_angle;
            gm_mesh_result each[2], result;
            double offset;
            GM_ASSERT_INT(gm_double_helical_equilibrium(&gears, angle, 0.0, 150.0, (double)NAN,
                                                        &offset, &apex, each, &result),
                          GM_OK);
            GM_ASSERT_REL(each[0].force, each[1].force, 1e-9);
            GM_ASSERT_REL(result.wheel_torque, 150.0, 1e-9);
            lowest = fmin(lowest, apex);
            highest = fmax(highest, apex);

            /* The same from scratch, without knowing the float. */
            const gm_position position = position_at(&pair, angle, offset, 0.0, 0.0);
            double found = 0.0;
            GM_ASSERT_INT(gm_double_helical_evaluate_at(&gears, &position, GM_WANT_FORCE, &found,
                                                        each, &result),
                          GM_OK);
            GM_ASSERT_REL(result.wheel_torque, 150.0, 1e-7);
            GM_ASSERT_ABS(found, apex, 1e-6 * fabs(apex) + 1e-12);
        }

        /* Where the tooth is away the pinion is where it was drawn; where it passes it has floated, no more than
         * half of 10 um asks for. */
        GM_ASSERT(highest > 2e-6 && highest < 5e-6 / tan(pair.base_helix_angle));
        GM_ASSERT_ABS(lowest, 0.0, 1e-12);
        free(thick);
        free_gears(&gears);
    }
}

/* The middle of each half of the wheel, turned about the middle of the whole; the second one seen in a mirror. */
static void a_tilt_moves_both_halves_as_one_body(void) {
    const gm_pair_params whole = drawing(24.0 * degree);
    const gm_pair pair = half_of(&whole);
    const gm_pose pose = {30e-6, -20e-6, 0.0, 0.03, -0.05};
    const double to_half = 0.5 * whole.wheel_face_width - 0.5 * pair.wheel.face_width;
    gm_pose poses[2];
    double r[9];
    GM_ASSERT_INT(gm_double_helical_pose(&pair, gap, &pose, poses), GM_OK);
    rotation_of(pose.skew, pose.inclination, 0.0, r);
    for (int k = 0; k < 2; ++k) {
        const double mirror = k == 0 ? 1.0 : -1.0, z = -mirror * to_half;
        GM_ASSERT_ABS(poses[k].center_distance_change, 30e-6 + r[2] * z, 1e-17);
        GM_ASSERT_ABS(poses[k].offset, -20e-6 + r[5] * z, 1e-17);
        GM_ASSERT_ABS(poses[k].axial_shift, mirror * (r[8] - 1.0) * z, 1e-17);
        GM_ASSERT(poses[k].skew == mirror * pose.skew);
        GM_ASSERT(poses[k].inclination == mirror * pose.inclination);
    }
    GM_ASSERT_INT(gm_double_helical_pose(NULL, gap, &pose, poses), GM_ERR_NULL);
    GM_ASSERT_INT(gm_double_helical_pose(&pair, gap, NULL, poses), GM_ERR_NULL);
    GM_ASSERT_INT(gm_double_helical_pose(&pair, gap, &pose, NULL), GM_ERR_NULL);
}

static void the_axial_shift_of_a_wheel_takes_the_pinion_along(void) {
    const gm_pair_params whole = drawing(24.0 * degree);
    const gm_pair pair = half_of(&whole);
    const gm_pose shifted = {0.0, 0.0, 50e-6, 0.0, 0.0};
    gm_pose poses[2];
    GM_ASSERT_INT(gm_double_helical_pose(&pair, gap, &shifted, poses), GM_OK);
    for (int k = 0; k < 2; ++k) {
        GM_ASSERT(poses[k].center_distance_change == 0.0 && poses[k].offset == 0.0);
        GM_ASSERT(poses[k].axial_shift == 0.0);
    }
}

static void flanks_that_do_not_touch_leave_the_pinion_where_it_is(void) {
    const gm_pair_params whole = drawing(24.0 * degree);
    const gm_pair pair = half_of(&whole);
    const gm_mesh_params law = half_law();
    const gm_double_helical gears = gears_of(&law, &pair, NULL, NULL);
    gm_mesh_result each[2], result;
    double apex = 3e-6;
    const gm_position free_play = position_at(&pair, 0.3, 10e-6, 1e-3, 50.0);
    GM_ASSERT_INT(gm_double_helical_evaluate_at(&gears, &free_play,
                                                GM_WANT_WRENCH | GM_WANT_DERIVATIVES, &apex, each,
                                                &result),
                  GM_OK);
    GM_ASSERT(result.force == 0.0 && result.force_by.wheel_angle == 0.0);
    GM_ASSERT_REL(apex, 3e-6, 1e-15);

    /* From far away too, where one half would press on each side. */
    apex = 400e-6;
    GM_ASSERT_INT(
        gm_double_helical_evaluate_at(&gears, &free_play, GM_WANT_FORCE, &apex, each, &result),
        GM_OK);
    GM_ASSERT(result.force == 0.0);
    GM_ASSERT(fabs(apex) * tan(pair.base_helix_angle) <= 40e-6);
    free_gears(&gears);
}

/* ---------------------------------------------------------------------------------------------
 * Derivatives, line loads, faults
 * ------------------------------------------------------------------------------------------- */

/* Against differences of fourth order: 1e-6 of the largest. */
static void derivatives_are_those_with_a_floating_pinion(void) {
    uint64_t seed = 5;
    const gm_pair_params whole = drawing(24.0 * degree);
    const gm_pair pair = half_of(&whole);
    double table[2][FACE_NODES][PROFILE_NODES];
    static const double no_pitch[PINION_TEETH] = {0.0};

    /* Deviations of the pinion, others on each half; friction. */
    gm_flanks *pinion[2];
    for (int k = 0; k < 2; ++k) {
        for (int node = 0; node < FACE_NODES * PROFILE_NODES; ++node) {
            table[k][node / PROFILE_NODES][node % PROFILE_NODES] =
                gm_test_uniform(&seed, -3e-6, 3e-6);
        }
        pinion[k] = flanks_of(PINION_TEETH, (const double(*)[PROFILE_NODES])table[k], no_pitch, 0);
    }
    gm_mesh_params law = half_law();
    law.friction_coefficient = 0.08;
    const gm_double_helical gears = gears_of(&law, &pair, pinion, NULL);

    static const double weight[4] = {1.0 / 12.0, -2.0 / 3.0, 2.0 / 3.0, -1.0 / 12.0};
    static const double place[4] = {-2.0, -1.0, 1.0, 2.0};
    int far_off = 0, compared = 0;
    for (int i = 0; i < 40; ++i) {
        /* A state at which flanks press, and turn at the speeds of the ratio. */
        const gm_state state = {.pinion_angle = gm_test_uniform(&seed, -3.0, 3.0),
                                .pinion_speed = 40.0};
        gm_state at = state;
        at.wheel_angle =
            (pair.pinion.base_radius * state.pinion_angle - gm_test_uniform(&seed, 32e-6, 40e-6)) /
            pair.wheel.base_radius;
        at.wheel_speed = 40.0 * pair.pinion.base_radius / pair.wheel.base_radius;

        for (int by = 0; by < 4; ++by) {
            const double step = by < 2 ? 2e-6 : 1e-3;
            double found[4] = {0.0};
            gm_mesh_result each[2], result;
            gm_position position;
            double apex = 0.0;

            /* Force, both torques and overlap beside the state. */
            for (int k = 0; k < 4; ++k) {
                gm_state moved = at;
                double *const values[4] = {&moved.pinion_angle, &moved.wheel_angle,
                                           &moved.pinion_speed, &moved.wheel_speed};
                *values[by] += place[k] * step;
                GM_ASSERT_INT(gm_position_from_state(&pair, &moved, &position), GM_OK);
                GM_ASSERT_INT(gm_double_helical_evaluate_at(&gears, &position, GM_WANT_FORCE, &apex,
                                                            each, &result),
                              GM_OK);
                found[0] += weight[k] / step * result.force;
                found[1] += weight[k] / step * result.pinion_torque;
                found[2] += weight[k] / step * result.wheel_torque;
                found[3] += weight[k] / step * result.contact.penetration;
            }

            /* What the library says there. */
            GM_ASSERT_INT(gm_position_from_state(&pair, &at, &position), GM_OK);
            GM_ASSERT_INT(gm_double_helical_evaluate_at(&gears, &position, GM_WANT_DERIVATIVES,
                                                        &apex, each, &result),
                          GM_OK);
            const gm_gradient *gradients[3] = {&result.force_by, &result.pinion_torque_by,
                                               &result.wheel_torque_by};

            /* Derivatives of the force and the torques, and of the overlap by the angles. */
            const double largest =
                by < 2 ? fabs(result.force_by.wheel_angle) : fabs(result.force_by.wheel_speed);
            const double arm[3] = {1.0, pair.pinion.base_radius, pair.wheel.base_radius};
            for (int q = 0; q < 3; ++q) {
                const double *exact = &gradients[q]->pinion_angle;
                far_off += !(fabs(found[q] - exact[by]) <= 1e-5 * largest * arm[q]);
                ++compared;
            }

            if (by < 2) {
                const double exact =
                    by == 0 ? result.contact.d_pinion_angle : result.contact.d_wheel_angle;
                far_off += !(fabs(found[3] - exact) <= 1e-5 * fabs(result.contact.d_wheel_angle));
                ++compared;
            }
        }
    }

    /* Differences across a kink are off: a few of them. */
    GM_ASSERT(compared == 40 * 14 && far_off <= compared / 20);
    for (int k = 0; k < 2; ++k) {
        free(pinion[k]);
    }
    free_gears(&gears);
}

/* Trapezia over the stations of each line come to the force of its half, as finely as stations lie. */
static void line_loads_lie_on_both_halves(void) {
    const gm_pair_params whole = drawing(24.0 * degree);
    const gm_pair pair = half_of(&whole);
    gm_mesh_params law = half_law();
    gm_flanks *thick = shifted_flanks(PINION_TEETH, 10e-6, 0);
    gm_flanks *const pinion[2] = {thick, NULL};
    const gm_double_helical gears = gears_of(&law, &pair, pinion, NULL);
    gm_mesh_result each[2], result;
    double offset, apex = 0.0;
    GM_ASSERT_INT(gm_double_helical_equilibrium(&gears, 0.1, 0.0, 150.0, (double)NAN, &offset,
                                                &apex, each, &result),
                  GM_OK);

    enum { CAPACITY = 1000 };
    static gm_line_load_point points[CAPACITY];
    const gm_position position = position_at(&pair, 0.1, offset, 0.0, 0.0);
    gm_line_loads loads;
    GM_ASSERT_INT(gm_double_helical_line_loads(&gears, &position, apex, points, CAPACITY, &loads),
                  GM_OK);

    /* Each half alone, where the float has moved it to. */
    double force[2] = {0.0, 0.0}, largest = 0.0, pressure = 0.0, width = 0.0;
    gm_line_loads alone[2];
    for (int k = 0; k < 2; ++k) {
        gm_position of_half = position;
        of_half.offset += (k == 0 ? -1.0 : 1.0) * apex * tan(pair.base_helix_angle);
        GM_ASSERT_INT(gm_mesh_line_loads(gears.half[k], &of_half, NULL, NULL, 0, &alone[k]), GM_OK);
        pressure = fmax(pressure, alone[k].largest_pressure);
        width += alone[k].touching_width;
    }

    /* Together they have all points, and the largest of both. */
    GM_ASSERT_INT(loads.points, alone[0].points + alone[1].points);
    GM_ASSERT_REL(loads.touching_width, width, 1e-14);
    GM_ASSERT_REL(loads.largest_pressure, pressure, 1e-14);

    /* The points of each half lie on its own face, and their loads add up to its force. */
    for (int i = 0; i < loads.points; ++i) {
        const gm_line_load_point *a = &points[i], *b = &points[i + 1];
        const int half = a->z > 0.5 * whole.pinion_face_width;
        GM_ASSERT_INT(half, i >= alone[0].points);
        GM_ASSERT(half ? a->z > 15e-3 + gap - 1e-9 && a->z < 36e-3 + 1e-9
                       : a->z > -1e-9 && a->z < 15e-3 + 1e-9);
        largest = fmax(largest, a->line_load);
        if (i + 1 < loads.points && a->pinion_tooth == b->pinion_tooth &&
            half == (b->z > 0.5 * whole.pinion_face_width)) {
            force[half] += 0.5 * (a->line_load + b->line_load) * fabs(b->z - a->z);
        }
    }
    GM_ASSERT_REL(force[0], each[0].force, 0.1);
    GM_ASSERT_REL(force[1], each[1].force, 0.1);
    GM_ASSERT_REL(loads.largest_line_load, largest, 0.05);

    /* The mean along all that touches, of loads per length of the line, whose integral over z is the force. */
    GM_ASSERT_REL(loads.face_load_factor,
                  loads.largest_line_load * loads.touching_width / result.force, 1e-9);
    GM_ASSERT_INT(gm_double_helical_line_loads(&gears, &position, apex, points, 3, &loads),
                  GM_ERR_MEMORY);
    GM_ASSERT_NAN(loads.largest_line_load);
    free(thick);
    free_gears(&gears);
}

static void drawings_that_cannot_be_are_refused(void) {
    gm_pair_params whole = drawing(24.0 * degree), half;
    GM_ASSERT_INT(gm_double_helical_half(&whole, 0.0, &half), GM_OK);
    GM_ASSERT_REL(half.pinion_face_width, 18e-3, 1e-15);
    GM_ASSERT_INT(gm_double_helical_half(NULL, 0.0, &half), GM_ERR_NULL);
    GM_ASSERT_INT(gm_double_helical_half(&whole, 0.0, NULL), GM_ERR_NULL);
    GM_ASSERT_INT(gm_double_helical_half(&whole, -1e-3, &half), GM_ERR_PARAMETER);
    GM_ASSERT_INT(gm_double_helical_half(&whole, (double)NAN, &half), GM_ERR_PARAMETER);
    GM_ASSERT_INT(gm_double_helical_half(&whole, HUGE_VAL, &half), GM_ERR_PARAMETER);
    GM_ASSERT_INT(gm_double_helical_half(&whole, 36e-3, &half), GM_ERR_GEOMETRY);
    GM_ASSERT_INT(half.pinion_teeth, 0);
    whole.axial_offset = 1e-3;
    GM_ASSERT_INT(gm_double_helical_half(&whole, 1e-3, &half), GM_ERR_GEOMETRY);
    whole = drawing(0.0);
    GM_ASSERT_INT(gm_double_helical_half(&whole, 1e-3, &half), GM_ERR_GEOMETRY);

    /* The face width common to both, where the gears have none of their own. */
    whole = drawing(24.0 * degree);
    whole.pinion_face_width = whole.wheel_face_width = (double)NAN;
    GM_ASSERT_INT(gm_double_helical_half(&whole, 1e-3, &half), GM_ERR_GEOMETRY);
    whole.face_width = 21e-3;
    GM_ASSERT_INT(gm_double_helical_half(&whole, 1e-3, &half), GM_OK);
    GM_ASSERT_REL(half.wheel_face_width, 10e-3, 1e-14);
}

static void calls_that_cannot_be_are_refused(void) {
    const gm_pair_params whole = drawing(24.0 * degree), other_hand = drawing(-24.0 * degree);
    const gm_pair pair = half_of(&whole), other = half_of(&other_hand);
    const gm_mesh_params law = half_law();
    gm_double_helical gears = gears_of(&law, &pair, NULL, NULL);
    gm_mesh *stranger = mesh_of(&law, &other, NULL, NULL);
    const gm_mesh *second = gears.half[1];
    gm_position position = position_at(&pair, 0.3, 40e-6, 1e-3, 50.0);
    gm_mesh_result each[2], result;
    gm_line_loads loads;
    double apex = 0.0, offset;

    GM_ASSERT_INT(
        gm_double_helical_evaluate_at(NULL, &position, GM_WANT_FORCE, &apex, each, &result),
        GM_ERR_NULL);
    GM_ASSERT_NAN(result.force);
    GM_ASSERT_INT(gm_double_helical_evaluate_at(&gears, NULL, GM_WANT_FORCE, &apex, each, &result),
                  GM_ERR_NULL);
    GM_ASSERT_INT(
        gm_double_helical_evaluate_at(&gears, &position, GM_WANT_FORCE, NULL, each, &result),
        GM_ERR_NULL);
    GM_ASSERT_INT(
        gm_double_helical_evaluate_at(&gears, &position, GM_WANT_FORCE, &apex, NULL, &result),
        GM_ERR_NULL);

    GM_ASSERT_INT(gm_double_helical_equilibrium(&gears, 0.0, 0.0, 10.0, (double)NAN, NULL, &apex,
                                                each, &result),
                  GM_ERR_NULL);
    GM_ASSERT_INT(gm_double_helical_equilibrium(&gears, 0.0, 0.0, 10.0, (double)NAN, &offset, NULL,
                                                each, &result),
                  GM_ERR_NULL);
    GM_ASSERT_INT(gm_double_helical_equilibrium(&gears, 0.0, 0.0, 10.0, (double)NAN, &offset, &apex,
                                                each, NULL),
                  GM_ERR_NULL);

    GM_ASSERT_INT(gm_double_helical_line_loads(&gears, NULL, 0.0, NULL, 0, &loads), GM_ERR_NULL);
    GM_ASSERT_INT(gm_double_helical_evaluate_at(&gears, &position, 4711, &apex, each, &result),
                  GM_ERR_PARAMETER);

    /* Halves that are not alike. */
    gears.half[1] = stranger;
    GM_ASSERT_INT(
        gm_double_helical_evaluate_at(&gears, &position, GM_WANT_FORCE, &apex, each, &result),
        GM_ERR_GEOMETRY);
    GM_ASSERT_NAN(each[1].force);
    GM_ASSERT_INT(gm_double_helical_line_loads(&gears, &position, apex, NULL, 0, &loads),
                  GM_ERR_GEOMETRY);
    GM_ASSERT_INT(gm_double_helical_equilibrium(&gears, 0.0, 0.0, 10.0, (double)NAN, &offset, &apex,
                                                each, &result),
                  GM_ERR_GEOMETRY);
    GM_ASSERT_NAN(offset);

    /* States: none, out of range, and no load. A float that is no number is no place to begin. */
    gears.half[1] = second;
    position.offset = (double)NAN;
    GM_ASSERT_INT(
        gm_double_helical_evaluate_at(&gears, &position, GM_WANT_FORCE, &apex, each, &result),
        GM_STATE_NOT_FINITE);
    position.offset = pair.transverse_base_pitch;
    GM_ASSERT_INT(
        gm_double_helical_evaluate_at(&gears, &position, GM_WANT_FORCE, &apex, each, &result),
        GM_STATE_OUT_OF_RANGE);
    GM_ASSERT_INT(gm_double_helical_equilibrium(&gears, 0.0, 0.0, 0.0, (double)NAN, &offset, &apex,
                                                each, &result),
                  GM_UNDETERMINED);
    GM_ASSERT_NAN(result.force);

    position.offset = 40e-6;
    apex = (double)NAN;
    GM_ASSERT_INT(
        gm_double_helical_evaluate_at(&gears, &position, GM_WANT_FORCE, &apex, each, &result),
        GM_OK);
    GM_ASSERT(apex == 0.0);
    free(stranger);
    free_gears(&gears);
}

int main(int argc, char *argv[]) {
    static const gm_test tests[] = {
        GM_TEST(both_halves_are_two_meshes_between_two_bodies),
        GM_TEST(a_wheel_that_moves_is_two_meshes_between_two_bodies),
        GM_TEST(halves_without_deviations_are_alike),
        GM_TEST(mean_force_is_that_of_a_single_helix_of_the_summed_width),
        GM_TEST(friction_is_in_the_equilibrium),
        GM_TEST(the_apex_moves_by_half_the_error_of_one_half),
        GM_TEST(both_halves_carry_the_same_past_a_tooth_with_an_error),
        GM_TEST(a_tilt_moves_both_halves_as_one_body),
        GM_TEST(the_axial_shift_of_a_wheel_takes_the_pinion_along),
        GM_TEST(flanks_that_do_not_touch_leave_the_pinion_where_it_is),
        GM_TEST(derivatives_are_those_with_a_floating_pinion),
        GM_TEST(line_loads_lie_on_both_halves),
        GM_TEST(drawings_that_cannot_be_are_refused),
        GM_TEST(calls_that_cannot_be_are_refused),
    };
    return gm_test_main("unit.double_helical", tests, GM_TEST_COUNT(tests), argc, argv);
}
