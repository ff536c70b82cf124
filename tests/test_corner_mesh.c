/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Lines of contact beyond the path: force, torques and wrench against sums over many points, their derivatives against
 * differences, and what the corner is there for: no jumps, no kinks, and an energy.
 */
#include "corner.h"
#include "flank.h"
#include "friction.h"
#include "gm_test.h"
#include "meshing.h"
#include "plain_mesh.h"
#include "random_gears.h"
#include "reference_gear.h"

enum { POINTS = 4000 };

/* NREL 5 MW, stage 3, and a helical and a spur pair of the tests. */
static gm_pair pair_of(int which) {
    gm_pair_params params;
    gm_pair_params_default(&params);
    const double degree = 0.017453292519943295;
    switch (which) {
    case 0:
        return spur_pair();
    case 1:
        return reference_pair(REFERENCE_FACE_WIDTH);
    default:
        params.pinion_teeth = 36;
        params.wheel_teeth = -93;
        params.normal_module = 21e-3;
        params.normal_pressure_angle = 20.0 * degree;
        params.helix_angle = which == 2 ? 0.0 : 8.0 * degree;
        params.center_distance = which == 2 ? 584e-3 : 590e-3;
        params.face_width = 200e-3;
        params.pinion_profile_shift = 0.5;
        return make_pair(&params);
    }
}

static gm_mesh_params params_with(int corner, double damping) {
    gm_mesh_params params = plain_law(corner);
    params.damping = damping;
    return params;
}

static int make_mesh(plain_mesh *where, const gm_pair *pair, const gm_flanks *pinion,
                     const gm_flanks *wheel, int corner, double damping, gm_mesh **mesh) {
    const gm_mesh_params params = params_with(corner, damping);
    return gm_mesh_init(mesh, &params, pair, pinion, wheel, where->memory, sizeof where->memory);
}

/* With friction, of the law of its index. */
static int make_rough(plain_mesh *where, const random_case *c, double damping, int law,
                      double speed, gm_mesh **mesh) {
    gm_mesh_params params = params_with(GM_CORNER_ON, damping);
    params.friction_law = law;
    params.friction_coefficient = 0.1;
    params.friction_speed = speed;
    params.oil_viscosity = 0.05;
    params.roughness = 0.6e-6;
    return gm_mesh_init(mesh, &params, &c->pair, c->use[0], c->use[1], where->memory,
                        sizeof where->memory);
}

/* ---------------------------------------------------------------------------------------------
 * Point by point
 * ------------------------------------------------------------------------------------------- */

/* A deviation, the table bilinear and with its edges held; t2 may be anything. */
static double deviation_at(const model_flanks *flanks, int side, int tooth, double t1, double t2) {
    if (flanks == NULL) {
        return 0.0;
    }
    t2 = fmin(fmax(t2, 0.0), 1.0);
    double value = flanks->pitch[side][tooth];
    const model_table *table = &flanks->table[side][tooth];
    if (table->face_nodes > 0) {
        const double v1 = t1 * (table->face_nodes - 1), v2 = t2 * (table->profile_nodes - 1);
        const int i = (int)fmin(v1, table->face_nodes - 2);
        const int j = (int)fmin(v2, table->profile_nodes - 2);
        const double *near = table->values + i * table->profile_nodes + j;
        const double *far = near + table->profile_nodes;
        const double p = v1 - i, q = v2 - j;
        value += (double)table->factor * ((1.0 - p) * ((1.0 - q) * near[0] + q * near[1]) +
                                          p * ((1.0 - q) * far[0] + q * far[1]));
    }
    for (int k = 0; k < flanks->ramp_count[side]; ++k) {
        const model_ramp *ramp = &flanks->ramp[side][k];
        value -=
            (double)ramp->factor * fmax(0.0, ramp->offset + ramp->per_t1 * t1 + ramp->per_t2 * t2);
    }
    return value;
}

typedef struct brute {
    double sum, square, largest, contact, arm[2]; /* of one side; arm: integral of f gap', [role] */
    double force[3], moment[3]; /* on the wheel, about the pinion's axis, per stiffness */
    double beyond;              /* part of the sum that is beyond the path */

    /* Friction, and by what: mu, v0, speeds of both gears counter-clockwise. */
    double coefficient, creep, pinion_speed, wheel_speed;
    double loss, slid; /* power and force that it takes, per stiffness */
    double turning;    /* and its moment about the pinion's axis */

    int is_chain; /* the gap as a chain of parabolas, as lines have it, and not as it is */
    int points;   /* along each line; 0: POINTS */
} brute;

/* A gap between two exact ones with their slopes: two parabolas that meet halfway without a kink. */
static double chained_gap(const gmi_corner *corner, double roll) {
    double half = corner->coarse;
    while (roll < 8.0 * half && half > corner->fine) {
        half *= 0.5;
    }
    const double from = floor(0.5 * roll / half) * 2.0 * half;
    gmi_corner_place a, b;
    gmi_corner_at(corner, from, &a);
    gmi_corner_at(corner, from + 2.0 * half, &b);
    const double bends[2] = {
        0.5 * (2.0 * (b.gap - a.gap) / half - 3.0 * a.by_roll - b.by_roll) / half,
        0.5 * (a.by_roll + 3.0 * b.by_roll - 2.0 * (b.gap - a.gap) / half) / half};
    const double gone = roll - from;
    if (gone < half) {
        return a.gap + gone * (a.by_roll + 0.5 * bends[0] * gone);
    }
    const double left = 2.0 * half - gone;
    return b.gap - left * (b.by_roll - 0.5 * bends[1] * left);
}

/* Unit normal of the mate's involute at C, on the side of e: tangent to its base circle. */
static void normal_at(double axis, double base, const double c[2], const double e[2],
                      double normal[2]) {
    const double x = c[0] - axis, y = c[1];
    const double squared = x * x + y * y, rho = sqrt(squared - base * base);
    double best = -1.0;
    for (int sign = -1; sign <= 1; sign += 2) {
        const double n[2] = {base * (base * x - sign * rho * y) / squared,
                             base * (base * y + sign * rho * x) / squared};
        const double way[2] = {(x - n[0]) / rho, (y - n[1]) / rho};
        const double along = way[0] * e[0] + way[1] * e[1];
        if (fabs(along) > best) {
            best = fabs(along);
            normal[0] = along < 0.0 ? -way[0] : way[0];
            normal[1] = along < 0.0 ? -way[1] : way[1];
        }
    }
}

/* What acts at one point, on the drive side; the other one is its mirror image. */
static void add_acting(const gm_pair *pair, const gmi_engagement *at, double sign, double q,
                       double rho, double delta, const double roll[2], double z, brute *b) {
    const double a = at->working_pressure_angle, r = pair->pinion.base_radius;
    const double e[2] = {sin(a), cos(a)}, n[2] = {cos(a), -sin(a)};
    double normal[2] = {e[0], e[1]};
    double place[2] = {r * n[0] + rho * e[0], r * n[1] + rho * e[1]};

    /* A corner that touches acts where it is, across the mate's flank. */
    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        if (roll[role] > 0.0) {
            /* The corner, turned about its own axis from where its tip meets the line of action. */
            const double d = at->center_distance;
            const double tip = role == GM_PINION
                                   ? at->tip_roll_length[GM_PINION]
                                   : at->line_of_action - at->tip_roll_length[GM_WHEEL];
            const double own = role == GM_PINION ? 0.0 : d;
            const double turn = roll[role] / (role == GM_PINION ? r : at->wheel_base_radius);
            const double x = r * n[0] + tip * e[0] - own, y = r * n[1] + tip * e[1];
            const double c = cos(turn), s = sin(turn);
            place[0] = own + c * x - s * y;
            place[1] = s * x + c * y;
            normal_at(role == GM_PINION ? d : 0.0,
                      fabs(role == GM_PINION ? at->wheel_base_radius : r), place, e, normal);
        }
    }

    /* Overlap is on the wheel's side of the pinion's flank: places are those of the pinion's roll. */
    for (int k = 0; k < 2 && b->is_chain && roll[GM_WHEEL] > 0.0; ++k) {
        place[k] += delta * normal[k];
    }

    /* The pinion's flank slides over the wheel's, and takes it along. */
    const double omega_p = sign * b->pinion_speed, omega_w = sign * b->wheel_speed;
    const double tangent[2] = {-normal[1], normal[0]};
    const double v_t =
        tangent[0] * (omega_w - omega_p) * place[1] +
        tangent[1] * (omega_p * place[0] - omega_w * (place[0] - at->center_distance));
    const double share =
        b->coefficient * v_t / sqrt(v_t * v_t + b->creep * b->creep) / cos(pair->base_helix_angle);
    const double slid = b->coefficient > 0.0 ? share * q : 0.0;
    b->loss += slid * v_t;
    b->slid += fabs(slid);
    b->turning += sign * slid * (place[0] * tangent[1] - place[1] * tangent[0]);

    /* Force and moment on the wheel; with an axial part of helical gears. */
    const double f[3] = {q * normal[0] + slid * tangent[0],
                         sign * (q * normal[1] + slid * tangent[1]),
                         -sign * q * pair->face_advance / pair->face_width};
    const double x[3] = {place[0], sign * place[1], z};
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        b->force[k] += f[k];
        b->moment[k] += x[i] * f[j] - x[j] * f[i];
    }
}

static void brute_side(const random_case *c, const gm_position *position, int side, brute *b) {
    const gm_pair *pair = &c->pair;
    gmi_engagement at;
    gmi_corner corners[2];
    (void)gmi_engagement_find(pair, NULL, &at);
    (void)gmi_corners_init(pair, &at, corners);

    /* Place on the path of contact, and lines that can be on it. */
    const double sign = side == GM_DRIVE ? 1.0 : -1.0;
    const double delta = sign * position->offset - 0.5 * pair->backlash;
    const double p = pair->transverse_base_pitch;
    const double length[2] = {
        pair->pinion.tip_roll_length - pair->pinion.start_roll_length,
        at.tip_roll_length[GM_WHEEL] - at.wheel_profile_start,
    };

    const int lines = 6 + (int)(pair->total_contact_ratio + 1.0);
    for (int k = -lines; k <= lines; ++k) {
        const int steps = side == GM_DRIVE ? k : -k;
        const int z_p = pair->pinion.teeth, z_w = pair->wheel.teeth;
        const int i = ((position->pinion_tooth + steps) % z_p + z_p) % z_p;
        const int j = ((position->wheel_tooth + steps - (side == GM_COAST)) % z_w + z_w) % z_w;

        /* Overlap at each point: that of the axes, and both deviations ... */
        const int points = b->points > 0 ? b->points : POINTS;
        for (int point = 0; point < points; ++point) {
            const double t1 = (point + 0.5) / points;
            const double rho = pair->phase_origin[side] + sign * position->phase + k * p +
                               sign * pair->face_advance * t1;
            const double rho_w = at.line_of_action + delta - rho;
            const double roll[2] = {rho - at.tip_roll_length[GM_PINION],
                                    rho_w - at.tip_roll_length[GM_WHEEL]};
            double f = delta;
            f += deviation_at(c->model_use[0], side, i, t1,
                              (rho - pair->pinion.start_roll_length) / length[0]);
            f += deviation_at(c->model_use[1], side, j, t1,
                              (rho_w - at.wheel_profile_start) / length[1]);

            /* ... less the gap of a tip that is beyond the path. */
            gmi_corner_place place[2];
            int is_off = 0;
            for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
                if (roll[role] > 0.0) {
                    is_off = is_off || roll[role] > corners[role].reach;
                    gmi_corner_at(&corners[role], fmin(roll[role], corners[role].reach),
                                  &place[role]);
                    f -= b->is_chain ? chained_gap(&corners[role], roll[role]) : place[role].gap;
                }
            }
            if (!(f > 0.0) || is_off) {
                continue;
            }

            const double share = f / points;
            b->sum += share;
            b->square += share * f;
            b->largest = fmax(b->largest, f);
            b->contact += 1.0 / points;
            for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
                b->arm[role] += roll[role] > 0.0 ? share * place[role].by_roll : 0.0;
                b->beyond += roll[role] > 0.0 ? share : 0.0;
            }

            add_acting(pair, &at, sign, share, rho, delta, roll,
                       pair->face_start + t1 * pair->face_width, b);
        }
    }
}

/* A pair whose corners touch flanks, rings among them; deviations of some micrometres per millimetre of module. */
static int random_corner_case(random_case *c, uint64_t *seed, int i) {
    int status = random_mixed_case_make(c, seed, i);
    gmi_engagement at;
    gmi_corner corners[2];
    if (status == GM_OK) {
        (void)gmi_engagement_find(&c->pair, NULL, &at);
        status = gmi_corners_init(&c->pair, &at, corners) ? GM_OK : GM_ERR_GEOMETRY;
    }
    return status == GM_OK && fabs(c->pair.face_advance) < 4.0 * c->pair.transverse_base_pitch;
}

/* What both sides are together, and that the overlap times the stiffness is the force. */
static void check_contact(const gm_mesh_result *r, double rate) {
    const gm_penetration *contact = &r->contact;
    const double k = plain_stiffness;
    GM_ASSERT_REL(contact->penetration, contact->drive - contact->coast, 1e-15);
    GM_ASSERT_REL(contact->drive_rate, rate * contact->drive_contact, 1e-15);
    GM_ASSERT_REL(contact->coast_rate, -rate * contact->coast_contact, 1e-15);
    GM_ASSERT_REL(contact->rate, contact->drive_rate - contact->coast_rate, 1e-15);
    GM_ASSERT_INT(contact->drive_pairs > 0, contact->drive_contact > 0.0);
    GM_ASSERT_INT(contact->coast_pairs > 0, contact->coast_contact > 0.0);

    GM_ASSERT_REL(k * contact->penetration, r->force, 1e-14);
    GM_ASSERT_REL(k * contact->d_pinion_angle, r->force_by.pinion_angle, 1e-14);
    GM_ASSERT_REL(k * contact->d_wheel_angle, r->force_by.wheel_angle, 1e-14);
}

static void forces_are_sums_over_points(void) {
    uint64_t seed = 4711;
    int met = 0, at_corners = 0;
    for (int i = 0; i < 90; ++i) {
        random_case c;
        plain_mesh where;
        gm_mesh *mesh;
        if (random_corner_case(&c, &seed, i)) {
            gm_test_context("case %d", i);
            GM_ASSERT_INT(make_mesh(&where, &c.pair, c.use[0], c.use[1], GM_CORNER_ON, 0.0, &mesh),
                          GM_OK);
            gm_position position = random_pressed(&seed, &c.pair, i);
            position.offset_rate = 0.01; /* of no force: without damping */
            gm_mesh_result r;
            const int wanted = GM_WANT_WRENCH | GM_WANT_DERIVATIVES | GM_WANT_ENERGY;
            GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, wanted, NULL, &r), GM_OK);

            /* The same by points. */
            brute b[2] = {{.sum = 0.0}, {.sum = 0.0}};
            brute_side(&c, &position, GM_DRIVE, &b[GM_DRIVE]);
            brute_side(&c, &position, GM_COAST, &b[GM_COAST]);
            const double largest = fmax(b[0].sum, b[1].sum);
            const double k = plain_stiffness, r_bp = c.pair.pinion.base_radius,
                         r_bw = c.pair.wheel.base_radius;

            /* A few points of so many are all that can be told apart. */
            const double e = 2e-5 * largest + 1e-8 * c.pair.normal_module;
            GM_ASSERT_ABS(r.contact.drive, b[GM_DRIVE].sum, e);
            GM_ASSERT_ABS(r.contact.coast, b[GM_COAST].sum, e);
            GM_ASSERT_ABS(r.contact.drive_contact, b[GM_DRIVE].contact, 30.0 / POINTS);

            const double square = b[GM_DRIVE].square + b[GM_COAST].square;
            GM_ASSERT_ABS(r.energy, 0.5 * k * square,
                          k * e * fmax(b[GM_DRIVE].largest, b[GM_COAST].largest));
            check_contact(&r, position.offset_rate);

            GM_ASSERT_ABS(r.pinion_torque,
                          k * r_bp *
                              (b[0].sum - b[0].arm[GM_PINION] - (b[1].sum - b[1].arm[GM_PINION])),
                          k * r_bp * e);
            GM_ASSERT_ABS(r.wheel_torque,
                          k * r_bw *
                              (b[0].sum - b[0].arm[GM_WHEEL] - (b[1].sum - b[1].arm[GM_WHEEL])),
                          k * r_bw * e);

            const double lever = c.pair.center_distance + c.pair.face_width;
            for (int axis = 0; axis < 3; ++axis) {
                GM_ASSERT_ABS(r.wrench.wheel_force[axis], k * (b[0].force[axis] + b[1].force[axis]),
                              4.0 * k * e);
                GM_ASSERT_ABS(-r.wrench.pinion_moment[axis],
                              k * (b[0].moment[axis] + b[1].moment[axis]), 4.0 * k * e * lever);
            }

            /* What acts on one gear acts on the other, and turns both as the torques say. */
            const double d = c.pair.center_distance * c.pair.wheel.sign;
            const double size = k * largest * lever;
            GM_ASSERT_ABS(-r.wrench.pinion_moment[2], r.pinion_torque, 1e-12 * size);
            GM_ASSERT_ABS(c.pair.wheel.sign * -r.wrench.wheel_moment[2], r.wheel_torque,
                          1e-12 * size);
            GM_ASSERT_ABS(r.wrench.wheel_moment[2] + d * r.wrench.wheel_force[1] +
                              r.wrench.pinion_moment[2],
                          0.0, 1e-12 * size);
            ++met;
            at_corners += b[0].beyond + b[1].beyond > 0.0;
        }
        random_case_free(&c);
    }
    GM_ASSERT(met > 50);
    GM_ASSERT(at_corners > 30);
}

/* Friction acts across the normal at each point, against the speed at which the gears' bodies slide there. */
static void friction_is_that_of_the_bodies_at_each_point(void) {
    uint64_t seed = 4712;
    int met = 0, at_corners = 0;
    for (int i = 0; i < 90; ++i) {
        random_case c;
        plain_mesh where;
        gm_mesh *mesh;
        if (random_corner_case(&c, &seed, i)) {
            gm_test_context("case %d", i);
            const double creep = i % 2 != 0 && c.pair.face_advance == 0.0 ? 0.1 : 1e-6;

            /* The mesh, rolling at a speed. */
            GM_ASSERT_INT(make_rough(&where, &c, 0.0, GM_FRICTION_CONSTANT, creep, &mesh), GM_OK);
            gm_position position = random_pressed(&seed, &c.pair, i);
            position.pinion_speed = i % 3 == 0 ? -40.0 : 100.0;
            gm_mesh_result r;
            GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, GM_WANT_WRENCH, NULL, &r), GM_OK);

            /* The same by points. */
            const double k = plain_stiffness, sign = c.pair.wheel.sign;
            const brute rough = {.coefficient = 0.1,
                                 .creep = creep,
                                 .pinion_speed = position.pinion_speed,
                                 .wheel_speed = -sign * position.pinion_speed *
                                                c.pair.pinion.base_radius /
                                                c.pair.wheel.base_radius};
            brute b[2] = {rough, rough};
            brute_side(&c, &position, GM_DRIVE, &b[GM_DRIVE]);
            brute_side(&c, &position, GM_COAST, &b[GM_COAST]);

            /* The points' share, and that of parts of helical lines in which the sliding speed turns round. */
            const double sum = b[0].sum + b[1].sum;
            const double e = 4.0 * k * (2e-5 * sum + 1e-8 * c.pair.normal_module) +
                             2e-4 * k * (b[0].slid + b[1].slid);
            const double lever = c.pair.center_distance + c.pair.face_width;
            for (int axis = 0; axis < 3; ++axis) {
                GM_ASSERT_ABS(r.wrench.wheel_force[axis], k * (b[0].force[axis] + b[1].force[axis]),
                              e);
                GM_ASSERT_ABS(-r.wrench.pinion_moment[axis],
                              k * (b[0].moment[axis] + b[1].moment[axis]), e * lever);
            }

            const double fastest = fabs(position.pinion_speed) *
                                   (fabs(c.pair.line_of_action) + c.pair.normal_module) *
                                   (1.0 + c.pair.pinion.base_radius / c.pair.wheel.base_radius);
            GM_ASSERT_ABS(r.loss, k * (b[0].loss + b[1].loss), 0.5 * e * fastest);

            /* Action is reaction. */
            const double d = c.pair.center_distance * sign, size = k * sum * lever;
            GM_ASSERT_ABS(-r.wrench.pinion_moment[2], r.pinion_torque, 1e-12 * size);
            GM_ASSERT_ABS(sign * -r.wrench.wheel_moment[2], r.wheel_torque, 1e-12 * size);
            GM_ASSERT_ABS(r.wrench.wheel_moment[2] + d * r.wrench.wheel_force[1] +
                              r.wrench.pinion_moment[2],
                          0.0, 1e-12 * size);

            ++met;
            at_corners += b[0].beyond + b[1].beyond > 0.02 * sum;
        }
        random_case_free(&c);
    }
    GM_ASSERT(met > 50);
    GM_ASSERT(at_corners > 15);
}

/* Of the law of Schlenk in the pitch point, F/b in N/mm, viscosity in mPa s, roughness in um as make_rough() has them. */
static double iso_coefficient(const gm_pair *pair, double force, double pinion_speed,
                              double creep) {
    const double r_bp = pair->pinion.base_radius, sign = pair->wheel.sign;
    const double rho_p = r_bp * tan(pair->working_pressure_angle);
    const double rho_w = sign * pair->line_of_action - rho_p; /* of a ring below 0 */
    const double rolling = pinion_speed * (rho_p + sign * r_bp / pair->wheel.base_radius * rho_w);
    const double reduced = 1e3 * rho_p * rho_w / (rho_p + rho_w) / cos(pair->base_helix_angle);
    const double load = force / (1e3 * pair->face_width);
    return 0.048 * pow(load / (hypot(rolling, creep) * reduced), 0.2) * pow(50.0, -0.05) *
           pow(0.6, 0.25);
}

/* What friction adds to the torque of the pinion, and its loss, over what the force would: the points less the mesh. */
static void compare_friction(int i, double *torque_off, double *loss_off, double *beyond) {
    random_case c = {.pair = pair_of(i % 2 == 0 ? 1 : 3)};
    const gm_pair *pair = &c.pair;
    const double creep = i % 4 < 2 ? 1.0 : 0.03, k = plain_stiffness;
    const int law = i % 3 == 2 ? GM_FRICTION_ISO14179 : GM_FRICTION_CONSTANT;
    gm_test_context("case %d", i);
    plain_mesh rough_room, smooth_room;
    gm_mesh *rough, *smooth;
    GM_ASSERT_INT(make_rough(&rough_room, &c, 0.0, law, creep, &rough), GM_OK);
    GM_ASSERT_INT(make_mesh(&smooth_room, pair, NULL, NULL, GM_CORNER_ON, 0.0, &smooth), GM_OK);
    gm_position position;
    (void)gm_position_from_pinion_angle(
        pair, i * 0.13, 0.5 * pair->backlash + (2e-3 + 1e-3 * (i % 5)) * pair->normal_module, 0.0,
        &position);
    position.pinion_speed = i % 5 == 0 ? -40.0 : 100.0;
    gm_mesh_result with, without;
    GM_ASSERT_INT(gm_mesh_evaluate_at(rough, &position, 0, NULL, &with), GM_OK);
    GM_ASSERT_INT(gm_mesh_evaluate_at(smooth, &position, 0, NULL, &without), GM_OK);

    brute points = {.coefficient =
                        law == GM_FRICTION_CONSTANT
                            ? 0.1
                            : iso_coefficient(pair, with.force, position.pinion_speed, creep),
                    .creep = creep,
                    .pinion_speed = position.pinion_speed,
                    .wheel_speed = -pair->wheel.sign * position.pinion_speed *
                                   pair->pinion.base_radius / pair->wheel.base_radius,
                    .is_chain = 1,
                    .points = 10000};
    brute_side(&c, &position, GM_DRIVE, &points);
    const double torque = with.force * pair->pinion.base_radius;
    *torque_off = (with.pinion_torque - without.pinion_torque - k * points.turning) / torque;
    *loss_off = (with.loss - k * points.loss) / (torque * fabs(position.pinion_speed));
    *beyond = points.beyond / points.sum;

    /* Where no corner touches, it is as without them. */
    if (points.beyond == 0.0) {
        gm_mesh_params params = params_with(GM_CORNER_OFF, 0.0);
        params.friction_law = law;
        params.friction_coefficient = 0.1;
        params.friction_speed = creep;
        params.oil_viscosity = 0.05;
        params.roughness = 0.6e-6;
        GM_ASSERT_INT(gm_mesh_init(&smooth, &params, pair, NULL, NULL, smooth_room.memory,
                                   sizeof smooth_room.memory),
                      GM_OK);
        GM_ASSERT_INT(gm_mesh_evaluate_at(smooth, &position, 0, NULL, &without), GM_OK);
        GM_ASSERT_REL(with.loss, without.loss, 1e-12);
        GM_ASSERT_REL(with.pinion_torque, without.pinion_torque, 1e-13);
    }
}

/*
 * Ideal flanks, to 1e-9 of the torque; to 4e-9 where the sliding turns round at the corner, next to which the force is not
 * straight along a part: of the ring, whose pitch point is where its tip enters.
 */
static void friction_is_the_integral_along_the_lines(void) {
    int at_corners = 0, without = 0;
    for (int i = 0; i < 30; ++i) {
        double torque_off, loss_off, beyond;
        compare_friction(i, &torque_off, &loss_off, &beyond);

        GM_ASSERT_ABS(torque_off, 0.0, beyond > 0.25 ? 4e-9 : 1e-9);
        GM_ASSERT_ABS(loss_off, 0.0, 1e-9);
        at_corners += beyond > 0.03;
        without += beyond == 0.0;
    }
    GM_ASSERT(at_corners > 15);
    GM_ASSERT(without > 3);
}

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Axes that move and tilt: what friction takes from both bodies is its loss. */
static void friction_takes_its_loss_from_the_bodies(void) {
    uint64_t seed = 4713;
    int met = 0, lossy = 0;
    for (int i = 0; i < 200; ++i) {
        random_case c;
        plain_mesh rough_room, smooth_room;
        gm_mesh *rough, *smooth;
        if (random_corner_case(&c, &seed, i)) {
            gm_test_context("case %d", i);

            /* One mesh with friction, one without; nearly always in a pose that changes. */
            const gm_pair *pair = &c.pair;
            const double damping = i % 2 == 0 ? 0.0 : 1e5, m = pair->normal_module;
            GM_ASSERT_INT(make_rough(&rough_room, &c, damping, i % 3, 0.01, &rough), GM_OK);
            GM_ASSERT_INT(
                make_mesh(&smooth_room, pair, c.use[0], c.use[1], GM_CORNER_ON, damping, &smooth),
                GM_OK);

            gm_motion motion = {.position = random_pressed(&seed, &c.pair, i)};
            motion.position.pinion_speed = gm_test_uniform(&seed, -100.0, 100.0);
            if (i % 4 != 0) {
                motion.pose = (gm_pose){gm_test_uniform(&seed, -0.01, 0.01) * m,
                                        gm_test_uniform(&seed, -0.01, 0.01) * m, 0.0, 0.0, 0.0};
                motion.pose_rate =
                    (gm_pose){gm_test_uniform(&seed, -1.0, 1.0), gm_test_uniform(&seed, -1.0, 1.0),
                              gm_test_uniform(&seed, -1.0, 1.0),
                              i % 4 < 2 ? 0.0 : gm_test_uniform(&seed, -5.0, 5.0),
                              i % 4 < 2 ? 0.0 : gm_test_uniform(&seed, -5.0, 5.0)};
            }

            gm_mesh_result with, without;
            const int wanted = GM_WANT_WRENCH;
            const int status = gm_mesh_evaluate_posed(rough, &motion, wanted, NULL, &with);
            GM_ASSERT_INT(gm_mesh_evaluate_posed(smooth, &motion, wanted, NULL, &without), status);
            if (status == GM_OK && with.drive_force + with.coast_force > 0.0) {
                /* The wheel's body, whose moments are about its own axis; its tilt is about the middle of its face. */
                const gm_pose *rate = &motion.pose_rate;
                const double velocity[3] = {rate->center_distance_change, rate->offset,
                                            rate->axial_shift};
                const double turning[3] = {rate->skew, rate->inclination, 0.0};
                const double z =
                    pair->face_start + pair->wheel.face_start + 0.5 * pair->wheel.face_width;
                double force[3], moment[3], pinion[3];
                for (int k = 0; k < 3; ++k) {
                    force[k] = with.wrench.wheel_force[k] - without.wrench.wheel_force[k];
                    moment[k] = with.wrench.wheel_moment[k] - without.wrench.wheel_moment[k];
                    pinion[k] = with.wrench.pinion_moment[k] - without.wrench.pinion_moment[k];
                }
                moment[0] += z * force[1];
                moment[1] -= z * force[0];

                /* Power of both shafts, and of the wheel's body as it moves. */
                const double wheel_speed =
                    (pair->pinion.base_radius * motion.position.pinion_speed -
                     motion.position.offset_rate) /
                    pair->wheel.base_radius;
                const double power = pinion[2] * motion.position.pinion_speed -
                                     pair->wheel.sign * moment[2] * wheel_speed +
                                     dot(force, velocity) + dot(moment, turning);

                const double size = (with.drive_force + with.coast_force) *
                                    (fabs(motion.position.pinion_speed) * pair->center_distance +
                                     3.0 + 5.0 * pair->face_width);
                GM_ASSERT(with.loss >= 0.0);

                GM_ASSERT_ABS(power, -with.loss, 1e-12 * size);
                lossy += with.loss > 1e-4 * size;
                ++met;
            }
        }
        random_case_free(&c);
    }
    GM_ASSERT(met > 100);
    GM_ASSERT(lossy > 50);
}

/* ---------------------------------------------------------------------------------------------
 * Derivatives
 * ------------------------------------------------------------------------------------------- */

static gm_motion turned(const gm_pair *pair, const gm_motion *motion, int which, double by) {
    gm_motion result = *motion;
    const double r_bp = pair->pinion.base_radius, r_bw = pair->wheel.base_radius;
    if (which == 0 || which == 1) {
        result.position.offset += which == 0 ? r_bp * by : -r_bw * by;
        result.position.phase += which == 0 ? r_bp * by : 0.0;
    } else {
        result.position.offset_rate += which == 2 ? r_bp * by : -r_bw * by;
        result.position.pinion_speed += which == 2 ? by : 0.0;
    }
    return result;
}

static double part_of(const gm_gradient *gradient, int which) {
    const double parts[4] = {gradient->pinion_angle, gradient->wheel_angle, gradient->pinion_speed,
                             gradient->wheel_speed};
    return parts[which];
}

/* Force and both torques by both angles and speeds; tables, ramps and tilted axes, damped and not, with friction and not. */
static void derivatives_are_those_of_differences(void) {
    uint64_t seed = 99;
    int met = 0, rejected = 0;
    for (int i = 0; i < 300; ++i) {
        random_case c;
        plain_mesh where;
        gm_mesh *mesh;
        if (random_corner_case(&c, &seed, i)) {
            /* A mesh of each kind, at a place of its own, and nearly always in a pose. */
            const gm_pair *pair = &c.pair;
            const double damping = i % 2 == 0 ? 0.0 : 1e5;
            const int is_rough = i % 4 < 2;
            GM_ASSERT_INT(is_rough ? make_rough(&where, &c, damping, i % 3, 0.1, &mesh)
                                   : make_mesh(&where, pair, c.use[0], c.use[1], GM_CORNER_ON,
                                               damping, &mesh),
                          GM_OK);

            const double m = pair->normal_module;
            const double tilt =
                i % 3 == 0 ? 0.02 * pair->transverse_base_pitch / pair->face_width : 0.0;
            gm_motion motion = {.position = random_pressed(&seed, &c.pair, i)};
            motion.position.offset_rate = gm_test_uniform(&seed, -1e-3, 1e-3) * m;
            motion.position.pinion_speed = is_rough ? 50.0 : 0.0;

            if (i % 3 != 1) {
                motion.pose = (gm_pose){gm_test_uniform(&seed, -0.01, 0.01) * m,
                                        gm_test_uniform(&seed, -0.01, 0.01) * m, 0.0,
                                        gm_test_uniform(&seed, -tilt, tilt),
                                        gm_test_uniform(&seed, -tilt, tilt)};
            }

            /* While axes tilt only without damping, whose speed is a mean then. */
            if (i % 8 == 0) {
                motion.pose_rate = (gm_pose){0.3, -0.2, 0.1, gm_test_uniform(&seed, -90.0, 90.0),
                                             gm_test_uniform(&seed, -90.0, 90.0)};
            }

            gm_mesh_result r, far[2], near[2];
            int status = gm_mesh_evaluate_posed(mesh, &motion, GM_WANT_DERIVATIVES, NULL, &r);
            for (int which = 0; which < 4 && status == GM_OK && r.force != 0.0; ++which) {
                gm_test_context("case %d, by %d", i, which);
                const double h = (which < 2 ? 2e-7 : 1e-4) * m / pair->pinion.base_radius;
                for (int k = 0; k < 2; ++k) {
                    const gm_motion a = turned(pair, &motion, which, k == 0 ? -h : h);
                    const gm_motion b = turned(pair, &motion, which, k == 0 ? -0.5 * h : 0.5 * h);
                    status |= gm_mesh_evaluate_posed(mesh, &a, 0, NULL, &far[k]);
                    status |= gm_mesh_evaluate_posed(mesh, &b, 0, NULL, &near[k]);
                }

                /* Two steps, which agree where nothing begins to touch between. */
                const double got[3] = {part_of(&r.force_by, which),
                                       part_of(&r.pinion_torque_by, which),
                                       part_of(&r.wheel_torque_by, which)};
                const double wide[3] = {far[1].force - far[0].force,
                                        far[1].pinion_torque - far[0].pinion_torque,
                                        far[1].wheel_torque - far[0].wheel_torque};
                const double narrow[3] = {near[1].force - near[0].force,
                                          near[1].pinion_torque - near[0].pinion_torque,
                                          near[1].wheel_torque - near[0].wheel_torque};
                const double value[3] = {r.force, r.pinion_torque, r.wheel_torque};

                for (int k = 0; k < 3; ++k) {
                    const double by = narrow[k] / h;
                    const double size = fabs(got[k]) + 1e-3 * fabs(got[0]);
                    if (fabs(by - 0.5 * wide[k] / h) > 2e-6 * size) {
                        ++rejected; /* a kink between */
                        continue;
                    }
                    const double rounding = 4.0 * DBL_EPSILON * fabs(value[k]) / h;
                    GM_ASSERT_ABS(got[k], by, 2e-5 * size + rounding);
                    ++met;
                }
            }

            GM_ASSERT(status == GM_OK || status == GM_POSE_OUT_OF_MESH);
        }
        random_case_free(&c);
    }
    GM_ASSERT(met > 1000);
    GM_ASSERT(rejected < met / 5);
}

/*
 * Torques with friction as both gears roll on and x stays: what the arms of a tip change by, next to which the stiffness of
 * the teeth would stand far above. Spur gears; and helical ones with damping.
 */
static void torques_follow_the_roll_of_tips(void) {
    int met = 0, rejected = 0;
    for (int which = 0; which < 4; ++which) {
        random_case c = {0};
        c.pair = pair_of(which);
        const gm_pair *pair = &c.pair;
        const double pitch = pair->transverse_base_pitch;
        const double damping = which % 2 == 0 ? 0.0 : 1e5;
        plain_mesh where;
        gm_mesh *mesh;
        GM_ASSERT_INT(make_rough(&where, &c, damping, GM_FRICTION_CONSTANT, 0.1, &mesh), GM_OK);

        /* Over a base pitch, at places a little before and behind. */
        for (int i = 0; i < 200; ++i) {
            const double h = 1e-5 * pitch;
            gm_position place = {.offset = 0.5 * pair->backlash + 4e-3 * pair->normal_module,
                                 .offset_rate = pair->normal_module, /* a second */
                                 .pinion_speed = 50.0};

            gm_mesh_result at, far[2], near[2];
            place.phase = (0.0025 + 0.005 * i) * pitch;
            int status = gm_mesh_evaluate_at(mesh, &place, GM_WANT_DERIVATIVES, NULL, &at);
            for (int k = 0; k < 4; ++k) {
                gm_position moved = place;
                moved.phase += (k % 2 == 0 ? -h : h) * (k < 2 ? 1.0 : 0.5);
                status |=
                    gm_mesh_evaluate_at(mesh, &moved, 0, NULL, k < 2 ? &far[k] : &near[k - 2]);
            }
            GM_ASSERT_INT(status, GM_OK);

            /* The phase is r_bp phi_p; x stays where the wheel turns by r_bp / r_bw as much. */
            const double r_bp = pair->pinion.base_radius, r_bw = pair->wheel.base_radius;
            const gm_gradient *by[2] = {&at.pinion_torque_by, &at.wheel_torque_by};
            const double wide[2] = {far[1].pinion_torque - far[0].pinion_torque,
                                    far[1].wheel_torque - far[0].wheel_torque};
            const double narrow[2] = {near[1].pinion_torque - near[0].pinion_torque,
                                      near[1].wheel_torque - near[0].wheel_torque};
            for (int k = 0; k < 2; ++k) {
                gm_test_context("pair %d, place %d, gear %d", which, i, k);
                const double got = by[k]->pinion_angle / r_bp + by[k]->wheel_angle / r_bw;
                if (fabs(narrow[k] - 0.5 * wide[k]) > 1e-5 * fabs(narrow[k])) {
                    ++rejected; /* a kink between */
                    continue;
                }
                GM_ASSERT_ABS(got, narrow[k] / h, 1e-5 * (fabs(got) + at.force));
                ++met;
            }
        }
    }
    GM_ASSERT(met > 1200);
    GM_ASSERT(rejected < met / 5);
}

/* A number that changes with each motion, and what it is after one of them. */
static gmi_varying random_varying(uint64_t *seed, double least, double most) {
    gmi_varying result = {.value = gm_test_uniform(seed, least, most)};
    for (int k = 0; k < GMI_MOTIONS; ++k) {
        result.by[k] = gm_test_uniform(seed, -most, most);
    }
    return result;
}

static gmi_varying moved_by(const gmi_varying *varying, int which, double by) {
    gmi_varying result = *varying;
    result.value += by * varying->by[which];
    return result;
}

/* One part alone, where nothing else is large beside its friction: every term of the sliding speed at a turned tangent. */
static void friction_of_a_tip_follows_each_motion(void) {
    uint64_t seed = 4714;
    for (int i = 0; i < 40; ++i) {
        const gmi_friction friction = {
            .is_on = 1, .law = GM_FRICTION_CONSTANT, .normal = 1.1, .creep_squared = 4.0};
        const gmi_sliding sliding = {
            .friction = &friction,
            .pinion_speed = gm_test_uniform(&seed, -2.0, 2.0),
            .wheel_speed = gm_test_uniform(&seed, -2.0, 2.0),
            .wheel_sign = i % 2 == 0 ? 1.0 : -1.0,
            .line_of_action = 3.0,
            .rolling = {.value = 1.0},
            .sideways = {gm_test_uniform(&seed, -1.0, 1.0), gm_test_uniform(&seed, -1.0, 1.0)},
            .forward = {gm_test_uniform(&seed, -1.0, 1.0), gm_test_uniform(&seed, -1.0, 1.0)}};
        const gmi_part_force part = {
            random_varying(&seed, 1.0, 2.0), random_varying(&seed, 1.0, 2.0),
            random_varying(&seed, 1.0, 2.0), random_varying(&seed, 1.0, 2.0),
            random_varying(&seed, 1.0, 2.0)};
        const double advance = gm_test_uniform(&seed, -2.0, 2.0);
        const gmi_tip_place place = {
            random_varying(&seed, 0.1, 0.5),  random_varying(&seed, 0.1, 0.5),
            random_varying(&seed, 0.1, 0.5),  random_varying(&seed, 0.1, 0.5),
            random_varying(&seed, -1.0, 1.0), random_varying(&seed, -1.0, 1.0),
            random_varying(&seed, -1.0, 1.0), random_varying(&seed, -1.0, 1.0)};

        gmi_friction_sum at = {.loss = 0.0};
        gmi_tip_friction tip_at = {.versine = 0.0};
        gmi_friction_add_tip(&sliding, advance, &part, &place, &at, &tip_at);

        /* Against the slope between both sides of the place, where all numbers have moved by one motion. */
        for (int which = 0; which < GMI_MOTIONS; ++which) {
            gm_test_context("case %d, by %d", i, which);
            const double h = 1e-5;
            gmi_friction_sum sums[2] = {{.loss = 0.0}, {.loss = 0.0}};
            gmi_tip_friction tips[2] = {{.versine = 0.0}, {.versine = 0.0}};
            for (int k = 0; k < 2; ++k) {
                const double by = k == 0 ? -h : h;
                gmi_sliding s = sliding;
                s.pinion_speed += which == GMI_PINION_SPEED ? by : 0.0;
                s.wheel_speed += which == GMI_WHEEL_SPEED ? s.wheel_sign * by : 0.0;
                const gmi_part_force p = {
                    moved_by(&part.force, which, by), moved_by(&part.moment, which, by),
                    moved_by(&part.contact, which, by), moved_by(&part.force_t1, which, by),
                    moved_by(&part.contact_t1, which, by)};
                const gmi_tip_place q = {
                    moved_by(&place.lead, which, by),       moved_by(&place.longer, which, by),
                    moved_by(&place.versine, which, by),    moved_by(&place.sine, which, by),
                    moved_by(&place.lead_t1, which, by),    moved_by(&place.longer_t1, which, by),
                    moved_by(&place.versine_t1, which, by), moved_by(&place.sine_t1, which, by)};
                gmi_friction_add_tip(&s, advance, &p, &q, &sums[k], &tips[k]);
            }

            GM_ASSERT_ABS(at.force.by[which],
                          (sums[1].force.value - sums[0].force.value) / (2.0 * h), 1e-7);
            GM_ASSERT_ABS(at.moment.by[which],
                          (sums[1].moment.value - sums[0].moment.value) / (2.0 * h), 1e-7);
            GM_ASSERT_ABS(tip_at.longer.by[which],
                          (tips[1].longer.value - tips[0].longer.value) / (2.0 * h), 1e-7);
        }
    }
}

/* ---------------------------------------------------------------------------------------------
 * What the corner is there for
 * ------------------------------------------------------------------------------------------- */

/* Work over a closed way of both angles: nothing is lost and nothing won. */
static void energy_is_kept_over_a_mesh_cycle(void) {
    for (int which = 0; which < 4; ++which) {
        for (int corner = GM_CORNER_OFF; corner <= GM_CORNER_ON; ++corner) {
            gm_test_context("pair %d, corner %d", which, corner);
            const gm_pair pair = pair_of(which);
            plain_mesh where;
            gm_mesh *mesh;
            GM_ASSERT_INT(make_mesh(&where, &pair, NULL, NULL, corner, 0.0, &mesh), GM_OK);

            enum { STEPS = 4000 };
            const double m = pair.normal_module;
            double work = 0.0, turned_over = 0.0;
            for (int k = 0; k < STEPS; ++k) {
                /* x goes round once per base pitch of the roll. */
                const double turn = 6.283185307179586 * k / STEPS;
                const double x = 0.5 * pair.backlash + m * (5e-3 + 2e-3 * sin(turn));
                const double x_by = m * 2e-3 * cos(turn);
                const double roll_by = pair.transverse_base_pitch / 6.283185307179586;

                gm_position position;
                gm_mesh_result r;
                (void)gm_position_from_pinion_angle(&pair, roll_by * turn / pair.pinion.base_radius,
                                                    x, 0.0, &position);
                GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, 0, NULL, &r), GM_OK);

                const double pinion_by = roll_by / pair.pinion.base_radius;
                const double wheel_by = (roll_by - x_by) / pair.wheel.base_radius;
                work += (r.pinion_torque * pinion_by - r.wheel_torque * wheel_by) *
                        6.283185307179586 / STEPS;
                turned_over += fabs(r.force * x_by) * 6.283185307179586 / STEPS;
            }

            if (corner == GM_CORNER_ON) {
                GM_ASSERT_ABS(work, 0.0, 1e-5 * turned_over);
            } else {
                GM_ASSERT(fabs(work) > 1e-3 * turned_over); /* flanks leave with some overlap */
            }
        }
    }
}

/* Largest first or second difference of the force on a way of so many steps. */
static double largest_difference(const gm_mesh *mesh, const gm_motion *begins, int coordinate,
                                 double range, int steps, int order) {
    const gm_pair *pair = gm_mesh_pair(mesh);
    double last[2] = {(double)NAN, (double)NAN}, largest = 0.0;

    for (int k = 0; k <= steps; ++k) {
        const double by = range * k / steps;
        gm_motion there = *begins;
        double *const places[5] = {&there.pose.center_distance_change, &there.pose.offset,
                                   &there.pose.axial_shift, &there.pose.skew,
                                   &there.pose.inclination};
        if (coordinate < 2) {
            there = turned(pair, begins, coordinate, by);
        } else {
            *places[coordinate - 2] += by;
        }

        gm_mesh_result r;
        GM_ASSERT_INT(gm_mesh_evaluate_posed(mesh, &there, 0, NULL, &r), GM_OK);
        const double difference =
            order == 1 ? r.force - last[0] : r.force - 2.0 * last[0] + last[1];
        largest = fmax(largest, isnan(difference) ? 0.0 : fabs(difference));
        last[1] = last[0];
        last[0] = r.force;
    }
    return largest;
}

/*
 * With steps a quarter as long, the largest difference is a quarter without a jump, and the largest second difference a
 * sixteenth without a kink. With the path's ends as they are neither is so.
 */
static void nothing_jumps_and_helical_gears_have_no_kinks(void) {
    for (int which = 0; which < 4; ++which) {
        const gm_pair pair = pair_of(which);
        const int is_helical = pair.face_advance != 0.0;
        plain_mesh with_room, without_room;
        gm_mesh *with, *without;
        GM_ASSERT_INT(make_mesh(&with_room, &pair, NULL, NULL, GM_CORNER_ON, 0.0, &with), GM_OK);
        GM_ASSERT_INT(make_mesh(&without_room, &pair, NULL, NULL, GM_CORNER_OFF, 0.0, &without),
                      GM_OK);
        const double m = pair.normal_module, p = pair.transverse_base_pitch;

        /* Deeper and less deep, but never out of contact: ideal flanks touch with a kink. */
        const double range[7] = {1e-2 * m / pair.pinion.base_radius,
                                 4e-3 * m / pair.wheel.base_radius,
                                 4e-3 * m,
                                 4e-3 * m,
                                 0.02 * m,
                                 0.01 * p / pair.face_width,
                                 0.01 * p / pair.face_width};
        for (int coordinate = -1; coordinate < 7; ++coordinate) {
            gm_test_context("pair %d, coordinate %d", which, coordinate);
            gm_motion begins = {.pose.skew = coordinate < 5 ? 0.0 : 1e-6};
            const double x = 0.5 * pair.backlash + 5e-3 * m;
            (void)gm_position_from_pinion_angle(&pair, 0.0, x, 0.0, &begins.position);

            /* Roll at a held x: coordinate -1. The others begin where a pair enters. */
            if (coordinate < 0) {
                double jumps[2] = {0.0, 0.0}, kinks[2] = {0.0, 0.0}, bare[2] = {0.0, 0.0};
                for (int fine = 0; fine < 2; ++fine) {
                    const int steps = fine == 0 ? 4000 : 16000;
                    double last[2] = {(double)NAN, (double)NAN}, last_bare = (double)NAN;
                    for (int k = 0; k <= steps; ++k) {
                        gm_position there = begins.position;
                        there.phase = p * k / steps;
                        gm_mesh_result r;
                        GM_ASSERT_INT(gm_mesh_evaluate_at(with, &there, 0, NULL, &r), GM_OK);

                        const double second = fabs(r.force - 2.0 * last[0] + last[1]);
                        if (second > kinks[fine]) {
                            kinks[fine] = second;
                        }
                        if (fabs(r.force - last[0]) > jumps[fine]) {
                            jumps[fine] = fabs(r.force - last[0]);
                        }
                        last[1] = last[0];
                        last[0] = r.force;

                        GM_ASSERT_INT(gm_mesh_evaluate_at(without, &there, 0, NULL, &r), GM_OK);
                        if (fabs(r.force - last_bare) > bare[fine]) {
                            bare[fine] = fabs(r.force - last_bare);
                        }
                        last_bare = r.force;
                    }
                }

                GM_ASSERT(jumps[1] < 0.3 * jumps[0]);
                if (is_helical) {
                    GM_ASSERT(kinks[1] < 0.09 * kinks[0]);
                } else {
                    GM_ASSERT(bare[1] > 0.9 * bare[0]);
                }
                continue;
            }

            const double first[2] = {
                largest_difference(with, &begins, coordinate, range[coordinate], 1000, 1),
                largest_difference(with, &begins, coordinate, range[coordinate], 4000, 1)};
            GM_ASSERT(first[1] < 0.3 * first[0]);
            if (is_helical) {
                const double second[2] = {
                    largest_difference(with, &begins, coordinate, range[coordinate], 250, 2),
                    largest_difference(with, &begins, coordinate, range[coordinate], 1000, 2)};
                GM_ASSERT(second[1] < 0.09 * second[0]);
            }
        }
    }
}

/* The torque of the load is what is carried, with the arms of the corners. */
static void equilibrium_carries_the_torque(void) {
    for (int which = 0; which < 4; ++which) {
        const gm_pair pair = pair_of(which);
        plain_mesh where;
        gm_mesh *mesh;
        GM_ASSERT_INT(make_mesh(&where, &pair, NULL, NULL, GM_CORNER_ON, 0.0, &mesh), GM_OK);

        const double torque = 5e-3 * pair.normal_module * 1e8 * pair.wheel.base_radius;
        int at_corners = 0;

        for (int k = 0; k < 100; ++k) {
            gm_test_context("pair %d, position %d", which, k);
            const double angle = 1e-2 * k * pair.pinion.pitch_angle;
            double x;
            gm_mesh_result r;
            GM_ASSERT_INT(gm_static_equilibrium(mesh, angle, torque, (double)NAN, NULL, &x, &r),
                          GM_OK);
            GM_ASSERT_REL(r.wheel_torque, torque, 1e-9);
            at_corners += fabs(r.wheel_torque - r.force * pair.wheel.base_radius) > 1e-9 * torque;
        }
        GM_ASSERT(at_corners > 2);
    }
}

/* With friction torques do not jump either, where pairs come and go: steps a quarter as long, a quarter of the jump. */
static void torques_of_friction_have_no_jumps(void) {
    for (int which = 0; which < 4; ++which) {
        random_case c = {0};
        c.pair = pair_of(which);
        const gm_pair *pair = &c.pair;
        plain_mesh where;
        gm_mesh *mesh;
        GM_ASSERT_INT(make_rough(&where, &c, 0.0, GM_FRICTION_CONSTANT, 0.01, &mesh), GM_OK);
        double largest[2][2] = {{0.0, 0.0}, {0.0, 0.0}};
        for (int fine = 0; fine < 2; ++fine) {
            const int steps = fine == 0 ? 4000 : 16000;
            double last[2] = {(double)NAN, (double)NAN};
            for (int k = 0; k <= steps; ++k) {
                gm_position there = {0};
                gm_mesh_result r;
                const double x = 0.5 * pair->backlash + 5e-3 * pair->normal_module;
                (void)gm_position_from_pinion_angle(pair, 0.0, x, 0.0, &there);
                there.phase = pair->transverse_base_pitch * k / steps;
                there.pinion_speed = 10.0;
                GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &there, 0, NULL, &r), GM_OK);
                const double friction[2] = {r.pinion_torque, r.wheel_torque};
                for (int gear = 0; gear < 2; ++gear) {
                    const double step = fabs(friction[gear] - last[gear]);
                    largest[fine][gear] = k == 0 ? 0.0 : fmax(largest[fine][gear], step);
                    last[gear] = friction[gear];
                }
            }
        }
        for (int gear = 0; gear < 2; ++gear) {
            gm_test_context("pair %d, gear %d", which, gear);
            GM_ASSERT(largest[1][gear] < 0.3 * largest[0][gear]);
        }
    }
}

/* ---------------------------------------------------------------------------------------------
 * Along the lines
 * ------------------------------------------------------------------------------------------- */

/* The overlap at one place of a line of brute_side(); whose edge it is under, or -1. */
static double overlap_at(const random_case *c, const gmi_engagement *at,
                         const gmi_corner corners[2], const gm_line_load_point *point, double delta,
                         double rho, int *edge) {
    const gm_pair *pair = &c->pair;
    const double t1 = (point->z - pair->face_start) / pair->face_width;
    const double roll[2] = {rho, at->line_of_action + delta - rho};
    const double start[2] = {pair->pinion.start_roll_length, at->wheel_profile_start};
    const int tooth[2] = {point->pinion_tooth, point->wheel_tooth};
    double f = delta;
    *edge = -1;
    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        const double length = at->tip_roll_length[role] - start[role];
        f += deviation_at(c->model_use[role], point->side, tooth[role], t1,
                          (roll[role] - start[role]) / length);
        const double beyond = roll[role] - at->tip_roll_length[role];
        if (beyond > 0.0) {
            gmi_corner_place place;
            gmi_corner_at(&corners[role], fmin(beyond, corners[role].reach), &place);
            f -= place.gap;
            *edge = role;
        }
    }
    return f;
}

/* Each point has the overlap of its place; edges have no pressure; the largest are those of all points. */
static void lines_are_loaded_as_the_overlap_says(void) {
    uint64_t seed = 4716;
    int met = 0, edges = 0;
    for (int i = 0; i < 90; ++i) {
        random_case c;
        plain_mesh where;
        gm_mesh *mesh;
        if (random_corner_case(&c, &seed, i)) {
            gm_test_context("case %d", i);
            const gm_pair *pair = &c.pair;
            GM_ASSERT_INT(make_mesh(&where, pair, c.use[0], c.use[1], GM_CORNER_ON, 0.0, &mesh),
                          GM_OK);
            const gm_position position = random_pressed(&seed, &c.pair, i);

            enum { MOST = 20000 };
            static gm_line_load_point points[MOST];
            gm_line_loads loads;
            GM_ASSERT(gm_mesh_line_load_points(mesh) <= MOST);
            GM_ASSERT_INT(gm_mesh_line_loads(mesh, &position, NULL, points,
                                             gm_mesh_line_load_points(mesh), &loads),
                          GM_OK);

            gmi_engagement at;
            gmi_corner corners[2];
            (void)gmi_engagement_find(pair, NULL, &at);
            (void)gmi_corners_init(pair, &at, corners);
            const double per_width = plain_stiffness / pair->face_width;
            double largest = 0.0;
            for (int k = 0; k < loads.points; ++k) {
                /* Which of the parallel lines it is on follows from the teeth. */
                const gm_line_load_point *point = &points[k];
                const double sign = point->side == GM_DRIVE ? 1.0 : -1.0;
                const double delta = sign * position.offset - 0.5 * pair->backlash;
                const double t1 = (point->z - pair->face_start) / pair->face_width;

                const double first = pair->phase_origin[point->side] + sign * position.phase +
                                     sign * pair->face_advance * t1;
                const double p = pair->transverse_base_pitch;
                const double past = point->pinion_roll_length - at.tip_roll_length[GM_PINION];
                int index = (int)floor((point->pinion_roll_length - first) / p + 0.5), edge = -1;
                double f = overlap_at(&c, &at, corners, point, delta, first + index * p, &edge);
                for (int step = -1; step <= 1 && fabs(point->gap + f) > 1e-9; step += 2) {
                    f = overlap_at(&c, &at, corners, point, delta, first + (index + step) * p,
                                   &edge);
                }

                /* The stations of an edge carry load without a pressure. */
                GM_ASSERT_ABS(point->gap, -f, 1e-12 + 1e-13 * pair->center_distance);
                GM_ASSERT_REL(point->line_load, fmax(-point->gap, 0.0) * per_width, 1e-14);
                if (edge >= 0 && point->line_load > 0.0) {
                    GM_ASSERT_NAN(point->pressure);
                    GM_ASSERT(edge == GM_WHEEL || past == 0.0);
                    ++edges;
                } else {
                    GM_ASSERT(point->pressure >= 0.0 &&
                              !(point->pressure > loads.largest_pressure * (1.0 + 1e-14)));
                }
                largest = fmax(largest, point->line_load);
            }

            /* Sums and largest of the points are those of the mesh. */
            gm_mesh_result r;
            GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, 0, NULL, &r), GM_OK);
            GM_ASSERT_REL(loads.touching_width,
                          pair->face_width * (r.contact.drive_contact + r.contact.coast_contact),
                          1e-12);
            GM_ASSERT(largest == 0.0 || (largest <= loads.largest_line_load * (1.0 + 1e-14) &&
                                         loads.face_load_factor > 0.99));
            ++met;
        }
        random_case_free(&c);
    }
    GM_ASSERT(met > 50);
    GM_ASSERT(edges > 100);
}

/* Ideal spur gears: each pair bears the same all along the face, also the one that comes in at an edge. */
static void loads_of_spur_lines_are_the_force(void) {
    const gm_pair pair = spur_pair();
    plain_mesh where;
    gm_mesh *mesh;
    GM_ASSERT_INT(make_mesh(&where, &pair, NULL, NULL, GM_CORNER_ON, 0.0, &mesh), GM_OK);
    int edges = 0, alone = 0;

    for (int k = 0; k < 400; ++k) {
        gm_position position;
        gm_line_load_point points[400];
        gm_line_loads loads;
        gm_mesh_result r;
        gm_test_context("place %d", k);
        (void)gm_position_from_pinion_angle(&pair, 0.001 * k, 0.5 * pair.backlash + 10e-6, 0.0,
                                            &position);
        GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, 0, NULL, &r), GM_OK);
        GM_ASSERT_INT(gm_mesh_line_loads(mesh, &position, NULL, points, 400, &loads), GM_OK);

        double force = 0.0;
        for (int n = 0; n < loads.points; n += 17) {
            force += points[n].line_load * pair.face_width;
            edges += isnan(points[n].pressure);
            GM_ASSERT_REL(points[n].line_load, points[n + 16].line_load, 1e-12);
        }

        GM_ASSERT_REL(force, r.force, 1e-12);
        if (r.contact.drive_pairs == 1) {
            GM_ASSERT_REL(loads.face_load_factor, 1.0, 1e-12);
            ++alone;
        }
    }
    GM_ASSERT(edges > 10);
    GM_ASSERT(alone > 10);
}

/* Spur gears: friction of each line is mu_r times its force, and takes that times the sliding speed of its points. */
static void points_slide_as_friction_has_it(void) {
    const double mu = 0.1, creep = 0.02, width = 12e-3;
    int slow = 0, either_way[2] = {0, 0};
    for (int k = 0; k < 4 * 300; ++k) {
        /* External and in a ring, with edges and without, either way round, on drive and coast flanks. */
        const int is_ring = k % 2, corners = k / 2 % 2 ? GM_CORNER_ON : GM_CORNER_OFF;
        const double side = k / 4 % 2 ? 1.0 : -1.0, speed = k / 8 % 2 ? 3.0 : -40.0;
        gm_pair_params gears;
        gm_pair pair;
        gm_pair_params_default(&gears);
        gears.pinion_teeth = 25;
        gears.wheel_teeth = is_ring ? -68 : 37;
        gears.normal_module = 2e-3;
        gears.normal_pressure_angle = 0.349;
        gears.center_distance = 1e-3 * (is_ring ? 43.0 : 62.1);
        gears.face_width = width;
        gears.backlash = 80e-6;
        GM_ASSERT_INT(gm_pair_init(&pair, &gears), GM_OK);

        gm_mesh_params params = params_with(corners, 0.0);
        params.friction_coefficient = mu;
        params.friction_speed = creep;
        plain_mesh where;
        gm_mesh *mesh;
        GM_ASSERT_INT(
            gm_mesh_init(&mesh, &params, &pair, NULL, NULL, where.memory, sizeof where.memory),
            GM_OK);

        gm_position position;
        gm_line_load_point points[400];
        gm_line_loads loads;
        gm_mesh_result r;
        gm_test_context("place %d", k);
        (void)gm_position_from_pinion_angle(&pair, 0.0011 * k, side * (40e-6 + 8e-6), 1e-4,
                                            &position);
        position.pinion_speed = speed;
        GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, 0, NULL, &r), GM_OK);
        GM_ASSERT_INT(gm_mesh_line_loads(mesh, &position, NULL, points, 400, &loads), GM_OK);

        double loss = 0.0, largest = 0.0;
        for (int n = 0; n < loads.points; n += 17) {
            const double v = points[n].sliding_speed;
            loss += mu * v * v / sqrt(v * v + creep * creep) * points[n].line_load * width;
            largest = fmax(largest, mu * fabs(v) * points[n].line_load * width);
            slow += fabs(v) < creep;
            ++either_way[v > 0.0];
            GM_ASSERT(points[n].sliding_speed == points[n + 16].sliding_speed);
        }
        GM_ASSERT_ABS(loss, r.loss, 1e-9 * largest);
    }
    GM_ASSERT(slow > 20);
    GM_ASSERT(either_way[0] > 300 && either_way[1] > 300);
}

/* Between tilted axes the load of a spur line is next to a parabola: Simpson's rule over the 17 stations has its integral,
 * up to what the tilt moves the ends of the wheel's face by. And the force acts where it is. */
static void loads_of_tilted_spur_lines_are_the_force(void) {
    const gm_pair pair = spur_pair();
    gm_mesh_params params = params_with(GM_CORNER_ON, 0.0);
    params.pose.skew = 0.5e-4;
    params.pose.inclination = -0.3e-4;
    plain_mesh where;
    gm_mesh *mesh;
    GM_ASSERT_INT(
        gm_mesh_init(&mesh, &params, &pair, NULL, NULL, where.memory, sizeof where.memory), GM_OK);
    int compared = 0, edges = 0;

    for (int k = 0; k < 400; ++k) {
        gm_position position;
        gm_line_load_point points[400];
        gm_line_loads loads;
        gm_mesh_result r;
        gm_test_context("place %d", k);
        (void)gm_position_from_pinion_angle(&pair, 0.001 * k, 0.5 * pair.backlash + 10e-6, 0.0,
                                            &position);
        GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, GM_WANT_WRENCH, NULL, &r), GM_OK);
        GM_ASSERT_INT(gm_mesh_line_loads(mesh, &position, NULL, points, 400, &loads), GM_OK);

        double force = 0.0, moment = 0.0;
        int is_whole = loads.points % 17 == 0, has_edge = 0;
        for (int n = 0; n < loads.points; ++n) {
            const int at = n % 17;
            const int is_pressed = points[n].line_load > 0.0;
            is_whole = is_whole && is_pressed == (points[n - at].line_load > 0.0);
            has_edge += isnan(points[n].pressure);
            const double weight = (at == 0 || at == 16 ? 1.0 : at % 2 != 0 ? 4.0 : 2.0) / 48.0;
            force += points[n].line_load * pair.face_width * weight;
            moment += points[n].line_load * pair.face_width * weight * points[n].z;
        }

        if (is_whole) {
            const double moved = 0.8e-4 * pair.wheel.tip_radius / pair.face_width;
            GM_ASSERT_REL(force, r.force, moved);
            if (has_edge == 0) {
                const double *f = r.wrench.wheel_force, *m = r.wrench.wheel_moment;
                const double squared = f[0] * f[0] + f[1] * f[1];
                const double z = (m[1] * f[0] - m[0] * f[1]) / squared;
                GM_ASSERT_ABS(moment / force, z, 2.0 * moved * pair.face_width);
                GM_ASSERT(fabs(z - 0.5 * pair.face_width) > 10.0 * moved * pair.face_width);
            }
            ++compared;
            edges += has_edge > 0;
        }
    }
    GM_ASSERT(compared > 100);
    GM_ASSERT(edges > 10);
}

/* A pair of which a tip reaches to the mate's base circle, and what no corner goes with. */
static void what_corners_do_not_go_with_is_refused(void) {
    gm_mesh_params params;
    const char *field, *requirement;
    gm_mesh_params_default(&params);
    params.stiffness = 1e8;
    params.corner_contact = GM_CORNER_ON;
    GM_ASSERT_INT(gm_mesh_params_check(&params, &field, &requirement), GM_OK);
    params.model = GM_MODEL_SIMPLE;
    GM_ASSERT_INT(gm_mesh_params_check(&params, &field, &requirement), GM_ERR_PARAMETER);
    GM_ASSERT_STRING(field, "corner_contact");
    params.model = GM_MODEL_3D;
    params.corner_contact = 3;
    GM_ASSERT_INT(gm_mesh_params_check(&params, &field, &requirement), GM_ERR_PARAMETER);
    GM_ASSERT_STRING(field, "corner_contact");

    /* 10 teeth without shift are cut by the tips of 60. */
    gm_pair_params cut;
    gm_pair_params_default(&cut);
    cut.pinion_teeth = 10;
    cut.wheel_teeth = 60;
    cut.normal_module = 2e-3;
    cut.normal_pressure_angle = 0.3490658503988659;
    cut.center_distance = 70e-3;
    cut.face_width = 10e-3;
    const gm_pair undercut = make_pair(&cut);
    plain_mesh where;
    gm_mesh *mesh;
    GM_ASSERT_INT(make_mesh(&where, &undercut, NULL, NULL, GM_CORNER_ON, 0.0, &mesh),
                  GM_ERR_GEOMETRY);
    GM_ASSERT_INT(make_mesh(&where, &undercut, NULL, NULL, GM_CORNER_BY_LAW, 0.0, &mesh), GM_OK);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(forces_are_sums_over_points),
        GM_TEST(friction_is_that_of_the_bodies_at_each_point),
        GM_TEST(friction_is_the_integral_along_the_lines),
        GM_TEST(friction_takes_its_loss_from_the_bodies),
        GM_TEST(derivatives_are_those_of_differences),
        GM_TEST(torques_follow_the_roll_of_tips),
        GM_TEST(friction_of_a_tip_follows_each_motion),
        GM_TEST(energy_is_kept_over_a_mesh_cycle),
        GM_TEST(nothing_jumps_and_helical_gears_have_no_kinks),
        GM_TEST(torques_of_friction_have_no_jumps),
        GM_TEST(equilibrium_carries_the_torque),
        GM_TEST(lines_are_loaded_as_the_overlap_says),
        GM_TEST(loads_of_spur_lines_are_the_force),
        GM_TEST(points_slide_as_friction_has_it),
        GM_TEST(loads_of_tilted_spur_lines_are_the_force),
        GM_TEST(what_corners_do_not_go_with_is_refused),
    };
    return gm_test_main("unit.corner_mesh", tests, GM_TEST_COUNT(tests), argc, argv);
}
