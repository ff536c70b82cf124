/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Gears with faces of their own, and posed gears: against cases by brute force of displaced helicoids, against other
 * drawings of the same gears, and what a pose must not change.
 */
#include "gearmesh/gearmesh.h"
#include "gm_test.h"
#include "meshing.h" /* the engagement by itself */
#include "random_gears.h"
#include "reference_gear.h"

/* ---------------------------------------------------------------------------------------------
 * Cases computed elsewhere
 * ------------------------------------------------------------------------------------------- */

static FILE *case_file;

/* The next record that is no comment must have this key. */
static int read_key(const char *key) {
    char text[200];
    for (;;) {
        if (fscanf(case_file, "%199s", text) != 1) {
            return 0;
        }
        if (text[0] == '#') {
            int c;
            while ((c = fgetc(case_file)) != '\n' && c != EOF) {
            }
            continue;
        }
        return strcmp(text, key) == 0;
    }
}

static double read_number(void) {
    char text[80];
    GM_ASSERT_INT(fscanf(case_file, "%79s", text), 1);
    return strcmp(text, "nan") == 0 ? (double)NAN : strtod(text, NULL);
}

static int read_gears(gm_pair_params *params) {
    gm_pair_params_default(params);
    if (!read_key("teeth")) {
        return 0;
    }
    params->pinion_teeth = (int)read_number();
    params->wheel_teeth = (int)read_number();
    if (!read_key("gear")) {
        return 0;
    }
    double *const fields[] = {&params->normal_module,     &params->normal_pressure_angle,
                              &params->helix_angle,       &params->center_distance,
                              &params->backlash,          &params->face_width,
                              &params->pinion_face_width, &params->wheel_face_width,
                              &params->axial_offset,      &params->pinion_start_radius,
                              &params->wheel_start_radius};
    for (size_t k = 0; k < sizeof fields / sizeof fields[0]; ++k) {
        *fields[k] = read_number();
    }
    return 1;
}

static void transmission_error_is_that_of_displaced_helicoids(void) {
    case_file = gm_test_open("reference/pose.txt");
    int cases = 0, points = 0;
    while (read_key("case")) {
        char name[120];
        gm_pair_params params;
        GM_ASSERT_INT(fscanf(case_file, "%119s", name), 1);
        gm_test_context("%s", name);
        if (!GM_ASSERT(read_gears(&params)) || !GM_ASSERT(read_key("pose"))) {
            break;
        }

        /* The pose, the stiffness and the load of the case. */
        gm_mesh_params law;
        gm_mesh_params_default(&law);
        law.pose.center_distance_change = read_number();
        law.pose.offset = read_number();
        law.pose.axial_shift = read_number();
        law.pose.skew = read_number();
        law.pose.inclination = read_number();
        GM_ASSERT(read_key("load"));
        law.stiffness = read_number();
        const double torque = read_number(), tolerance = read_number();
        const int count = (int)read_number();

        const gm_pair pair = make_pair(&params);
        plain_mesh room;
        gm_mesh *mesh;
        GM_ASSERT_INT(gm_mesh_init(&mesh, &law, &pair, NULL, NULL, room.memory, sizeof room.memory),
                      GM_OK);
        for (int k = 0; k < count; ++k) {
            double offset = (double)NAN;
            GM_ASSERT(read_key("point"));
            const double angle = read_number(), te = read_number();
            GM_ASSERT_INT(
                gm_static_equilibrium(mesh, angle, torque, (double)NAN, NULL, &offset, NULL),
                GM_OK);
            GM_ASSERT_ABS(-offset, te, tolerance + 1e-8 * fabs(te));
            ++points;
        }
        ++cases;
    }
    fclose(case_file);
    gm_test_context("all cases");
    GM_ASSERT_INT(cases, 41);
    GM_ASSERT_INT(points, 205);
}

/* Printed values for the pair of the paper with default tips: te 0 and its changes (um), drive, K 2e8 N/m, 100 N m. */
static void changes_of_the_transmission_error_are_those_printed(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    params.pinion_tip_radius = params.wheel_tip_radius = (double)NAN;
    params.pinion_rack_addendum = params.wheel_rack_addendum = (double)NAN;
    const gm_pair pair = make_pair(&params);

    /* Each pose and the printed transmission error in um. */
    static const struct {
        gm_pose pose;
        double te;
    } moves[] = {{{0.0, 0.0, 0.0, 0.0, 0.0}, -58.6090},
                 {{40e-6, 0.0, 0.0, 0.0, 0.0}, -58.6090 - 13.604},
                 {{0.0, 40e-6, 0.0, 0.0, 0.0}, -58.6090 - 37.673},
                 {{0.0, 0.0, 100e-6, 0.0, 0.0}, -58.6090 + 61.416},
                 {{0.0, 0.0, 0.0, 1e-3, 0.0}, -58.6090 - 0.506},
                 {{0.0, 0.0, 0.0, 0.0, 1e-3}, -58.6090 + 25.088}};

    for (size_t k = 0; k < sizeof moves / sizeof moves[0]; ++k) {
        gm_test_context("move %d", (int)k);
        plain_mesh room;
        gm_mesh *mesh;
        gm_mesh_params law;
        double offset;
        gm_mesh_params_default(&law);
        law.stiffness = 2e8;
        law.pose = moves[k].pose;

        /* The equilibrium under the printed load. */
        GM_ASSERT_INT(gm_mesh_init(&mesh, &law, &pair, NULL, NULL, room.memory, sizeof room.memory),
                      GM_OK);
        GM_ASSERT_INT(gm_static_equilibrium(mesh, 0.0, 100.0, (double)NAN, NULL, &offset, NULL),
                      GM_OK);
        /* The digits printed, of both numbers: with tilts too, where lines end at the mate's tip, wherever that touches. */
        GM_ASSERT_ABS(-1e6 * offset, moves[k].te, 1.1e-3);
    }
}

/* ---------------------------------------------------------------------------------------------
 * Other drawings of the same gears
 * ------------------------------------------------------------------------------------------- */

static int evaluate_posed(const gm_pair *pair, const gm_flanks *pinion, const gm_flanks *wheel,
                          const gm_pose *pose, const gm_position *position,
                          gm_mesh_result *result) {
    plain_mesh room;
    gm_mesh *mesh;
    gm_mesh_params law;
    gm_mesh_params_default(&law);
    law.stiffness = 1e8;
    law.damping = 1e3;
    law.pose = *pose;
    const int made =
        gm_mesh_init(&mesh, &law, pair, pinion, wheel, room.memory, sizeof room.memory);
    const int status =
        gm_mesh_evaluate_at(mesh, position, GM_WANT_DERIVATIVES | GM_WANT_WRENCH, NULL, result);
    return made != GM_OK ? made : status;
}

/* The same gears drawn at the other centre distance: everything but the frame of the forces is the same. */
static void another_centre_distance_is_another_drawing(void) {
    uint64_t seed = UINT64_C(101);
    int compared = 0;
    for (int i = 0; i < 300; ++i) {
        random_case c;
        gm_test_context("case %d, seed %llx", i, (unsigned long long)seed);
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);
        const double change = c.params.normal_module * gm_test_uniform(&seed, -0.02, 0.02);
        const double sign = c.pair.wheel.sign; /* a ring's axis is on the other side */

        gm_pair_params moved = c.params;
        moved.center_distance += sign * change;
        moved.backlash = (double)NAN;
        moved.pinion_normal_thickness = c.pair.pinion.normal_thickness;
        moved.wheel_normal_thickness = c.pair.wheel.normal_thickness;
        moved.pinion_profile_shift = c.pair.pinion.profile_shift;
        moved.wheel_profile_shift = c.pair.wheel.profile_shift;
        moved.pinion_tip_radius = c.pair.pinion.tip_radius;
        moved.wheel_tip_radius = c.pair.wheel.tip_radius;
        moved.pinion_start_radius = c.pair.pinion.start_radius;
        moved.wheel_start_radius = c.pair.wheel.start_radius;

        /* The drawing of both: the same gears at two centre distances. */
        gm_pair_params drawn = moved;
        drawn.center_distance = c.params.center_distance;
        gm_pair from, to;
        const gm_pose pose = {change, 0.0, 0.0, 0.0, 0.0};
        if (gm_pair_init(&from, &drawn) == GM_OK && gm_pair_init(&to, &moved) == GM_OK) {
            /* Moved apart by the pose, or drawn so: the same state. */
            const double x =
                0.5 * to.backlash + c.params.normal_module * gm_test_uniform(&seed, 0.0, 3e-3);
            gm_position position;
            gm_mesh_result posed, other;
            GM_ASSERT_INT(gm_position_from_pinion_angle(&to, gm_test_uniform(&seed, 0.0, 6.0), x,
                                                        1e-3, &position),
                          GM_OK);
            const gm_pose none = {0.0, 0.0, 0.0, 0.0, 0.0};
            const int a = evaluate_posed(&from, c.use[0], c.use[1], &pose, &position, &posed);
            const int b = evaluate_posed(&to, c.use[0], c.use[1], &none, &position, &other);
            if (a == GM_OK && b == GM_OK) {
                /* Backlash and roll lengths in two ways: some roundings of the centre distance. */
                const double longest = c.params.center_distance + c.pair.wheel.base_radius;
                const double little = 1e8 * 1e-13 * longest * (1.0 + other.contact.drive_contact);
                GM_ASSERT_ABS(posed.force, other.force, little);
                GM_ASSERT_ABS(posed.wrench.wheel_force[0], other.wrench.wheel_force[0], little);
                GM_ASSERT_ABS(posed.wrench.wheel_force[1], other.wrench.wheel_force[1], little);
                ++compared;
            }
        }
        random_case_free(&c);
    }
    gm_test_context("all cases");
    GM_ASSERT(compared > 150);
}

/* Axes at the same distance in another direction: the same mesh, turned as a whole. */
static void axes_in_another_direction_turn_everything(void) {
    uint64_t seed = UINT64_C(102);
    for (int i = 0; i < 200; ++i) {
        random_case c;
        gm_test_context("case %d, seed %llx", i, (unsigned long long)seed);
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);
        const double d = c.pair.center_distance;
        const double psi = i % 8 == 0 ? gm_test_uniform(&seed, -2.5, 2.5)
                                      : gm_test_uniform(&seed, -0.01, 0.01) *
                                            c.params.normal_module / c.pair.pinion.base_radius;
        const gm_pose none = {0.0, 0.0, 0.0, 0.0, 0.0};
        const double sign = c.pair.wheel.sign; /* a ring's axis is on the other side */
        const gm_pose turned = {sign * d * (cos(psi) - 1.0), sign * d * sin(psi), 0.0, 0.0, 0.0};

        /* phi_p and -phi_w turn with the axes by psi, phi_w of a ring. */
        const double r_bp = c.pair.pinion.base_radius, r_bw = sign * c.pair.wheel.base_radius;
        gm_position at, moved;
        const double angle = gm_test_uniform(&seed, 0.0, 6.0);
        const double x =
            0.5 * c.pair.backlash + c.params.normal_module * gm_test_uniform(&seed, 0.0, 3e-3);
        GM_ASSERT_INT(gm_position_from_pinion_angle(&c.pair, angle, x, 0.0, &at), GM_OK);
        moved = at;
        moved.phase += r_bp * psi;
        moved.offset += (r_bp + r_bw) * psi;
        gm_mesh_result a, b;
        const int first = evaluate_posed(&c.pair, c.use[0], c.use[1], &none, &at, &a);
        const int second = evaluate_posed(&c.pair, c.use[0], c.use[1], &turned, &moved, &b);
        if (fabs(x) < 0.4 * c.pair.transverse_base_pitch && GM_ASSERT_INT(first, GM_OK) &&
            GM_ASSERT_INT(second, GM_OK)) {
            const double little = 1e8 * 1e-12 * d * (1.0 + a.contact.drive_contact);
            const double *f = a.wrench.wheel_force;
            GM_ASSERT_ABS(b.force, a.force, little);
            GM_ASSERT_ABS(b.wrench.wheel_force[0], cos(psi) * f[0] - sin(psi) * f[1], little);
            GM_ASSERT_ABS(b.wrench.wheel_force[1], sin(psi) * f[0] + cos(psi) * f[1], little);
            GM_ASSERT_ABS(b.wrench.wheel_moment[2], a.wrench.wheel_moment[2], little * d);
            for (int k = 0; k < 3; ++k) {
                GM_ASSERT_ABS(b.wrench.pinion_force[k] + b.wrench.wheel_force[k], 0.0, little);
            }
        }
        random_case_free(&c);
    }
}

/* ---------------------------------------------------------------------------------------------
 * Tilts
 * ------------------------------------------------------------------------------------------- */

/* The gradient between tilted axes, against central differences; kinks are left out, and counted. */
static void gradient_between_tilted_axes_is_that_of_differences(void) {
    uint64_t seed = UINT64_C(106);
    int compared = 0, kinks = 0;
    for (int i = 0; i < 300; ++i) {
        random_case c;
        gm_test_context("case %d, seed %llx", i, (unsigned long long)seed);
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);

        /* Tilted and moved, damped and not. */
        plain_mesh room;
        gm_mesh *mesh;
        gm_mesh_params law;
        gm_mesh_params_default(&law);
        law.stiffness = 1e8;
        law.damping = i % 2 == 0 ? 0.0 : 1e3;

        const double reach = 2e-3 * c.params.normal_module / c.params.face_width;
        law.pose.skew = gm_test_uniform(&seed, -reach, reach);
        law.pose.inclination = gm_test_uniform(&seed, -reach, reach);
        law.pose.offset = gm_test_uniform(&seed, -1e-3, 1e-3) * c.params.normal_module;
        const double r_bp = c.pair.pinion.base_radius, r_bw = c.pair.wheel.base_radius;

        const int made =
            gm_mesh_init(&mesh, &law, &c.pair, c.use[0], c.use[1], room.memory, sizeof room.memory);

        const double angle = gm_test_uniform(&seed, 0.0, 1.0);
        const double x =
            0.5 * c.pair.backlash + c.params.normal_module * gm_test_uniform(&seed, -1e-3, 4e-3);
        const double h = 1e-5 * c.params.normal_module;
        gm_mesh_result at[5];
        int status = made;
        for (int k = 0; k < 5 && status == GM_OK; ++k) {
            /* At the place, moved in x at fixed phi_p, moved in phi_p at fixed x. */
            static const double by_x[5] = {0.0, 1.0, -1.0, 0.0, 0.0};
            static const double by_arc[5] = {0.0, 0.0, 0.0, 1.0, -1.0};
            gm_position position;
            status = gm_position_from_pinion_angle(&c.pair, angle + by_arc[k] * h / r_bp,
                                                   x + by_x[k] * h, 1e-4, &position);
            if (status == GM_OK) {
                status = gm_mesh_evaluate_at(mesh, &position, GM_WANT_DERIVATIVES, NULL, &at[k]);
            }
        }

        /* By x and by the roll, one-sided: both agree where nothing begins to touch between. */
        if (status == GM_OK && at[0].force > 0.0) {
            const double exact[2] = {-at[0].force_by.wheel_angle / r_bw,
                                     at[0].force_by.pinion_angle / r_bp +
                                         at[0].force_by.wheel_angle / r_bw};
            for (int k = 0; k < 2; ++k) {
                const double forward = (at[1 + 2 * k].force - at[0].force) / h;
                const double backward = (at[0].force - at[2 + 2 * k].force) / h;
                if (fabs(forward - backward) > 1e-4 * 1e8) {
                    ++kinks;
                    continue;
                }
                ++compared;
                GM_ASSERT_ABS(0.5 * (forward + backward), exact[k], 3e-5 * 1e8);
            }
        }
        random_case_free(&c);
    }
    gm_test_context("all cases");
    GM_ASSERT(compared > 150);
    GM_ASSERT(kinks < compared);
}

/* ---------------------------------------------------------------------------------------------
 * Faces
 * ------------------------------------------------------------------------------------------- */

enum { CELLS = 3, PROFILE_NODES = 5 };

/* One table for all teeth of both sides. */
static gm_flanks *flanks_with(int teeth, int face_nodes, const double *values,
                              const gm_flank_ramp *ramp) {
    const gm_flanks_params sizes = {teeth, 1,          face_nodes,   PROFILE_NODES,
                                    1,     face_nodes, PROFILE_NODES};
    const size_t size = gm_flanks_size(&sizes);
    gm_flanks *flanks;
    GM_ASSERT_INT(gm_flanks_init(&flanks, &sizes, malloc(size), size), GM_OK);
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        GM_ASSERT_INT(gm_flanks_set_table(flanks, side, GM_ALL_TEETH, values, 1.0), GM_OK);
        GM_ASSERT_INT(gm_flanks_set_ramps(flanks, side, ramp, 1, 1.0), GM_OK);
    }
    return flanks;
}

/* Pitch deviations go on with the tooth: they end no line where axes come closer, nor between tilted ones, as tables do. */
static void pitch_deviations_end_no_line(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    const gm_pair pair = make_pair(&params);
    const gm_flanks_params sizes = {.teeth = params.pinion_teeth};
    double memory[1024];
    gm_flanks *flanks;
    GM_ASSERT(gm_flanks_size(&sizes) <= sizeof memory);
    GM_ASSERT_INT(gm_flanks_init(&flanks, &sizes, memory, sizeof memory), GM_OK);
    const gm_pose poses[2] = {{-80e-6, 0.0, 0.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 0.4e-3, -0.3e-3}};
    for (int k = 0; k < 40; ++k) {
        gm_test_context("position %d", k);
        const gm_pose *pose = &poses[k / 20];
        gm_position position;
        gm_mesh_result ideal, even;
        GM_ASSERT_INT(gm_position_from_pinion_angle(&pair, 0.01 * k, 60e-6, 0.0, &position), GM_OK);
        GM_ASSERT_INT(evaluate_posed(&pair, NULL, NULL, pose, &position, &ideal), GM_OK);
        GM_ASSERT_INT(evaluate_posed(&pair, flanks, NULL, pose, &position, &even), GM_OK);
        GM_ASSERT_REL(even.force, ideal.force, 1e-12);
    }
}

/*
 * A wheel that is as wide as three pinions stands so that one third of its face, a cell of its table, is opposite the
 * pinion: the rest of the wheel takes no part, so a wheel of that third alone does the same. As drawn with an offset, and as
 * posed.
 */
static void only_the_common_face_takes_part(void) {
    uint64_t seed = UINT64_C(103);
    gm_pair_params own = reference_params(REFERENCE_FACE_WIDTH);
    const double b = REFERENCE_FACE_WIDTH;
    for (int i = 0; i < 60; ++i) {
        const int third = i % 3;
        const int by_pose = i % 2;
        own.helix_angle = (i % 4 < 2 ? 1.0 : -1.0) * 33.0 * 0.017453292519943295;
        gm_test_context("case %d", i);

        /* Tables of a wide gear, and of the third of it that the mate covers. */
        double whole[(CELLS + 1) * PROFILE_NODES], part[2 * PROFILE_NODES],
            of_pinion[2 * PROFILE_NODES];
        for (int k = 0; k < (CELLS + 1) * PROFILE_NODES; ++k) {
            whole[k] = gm_test_uniform(&seed, -3e-6, 3e-6);
        }
        memcpy(part, whole + third * PROFILE_NODES, sizeof part);
        for (int k = 0; k < 2 * PROFILE_NODES; ++k) {
            of_pinion[k] = gm_test_uniform(&seed, -3e-6, 3e-6);
        }

        /* The same with reliefs. */
        const gm_flank_ramp of_whole = {1e-6, -5e-6, 3e-6};
        const gm_flank_ramp of_part = {1e-6 - 5e-6 * third / 3.0, -5e-6 / 3.0, 3e-6};
        const gm_flank_ramp of_other = {-3e-6, 2e-6, 4e-6};

        /* Zero angles refer to z = 0, the pinion's face I, in both drawings. */
        gm_pair_params wide = own;
        wide.face_width = (double)NAN;
        wide.pinion_face_width = b;
        wide.wheel_face_width = 3.0 * b;
        wide.axial_offset = by_pose ? 0.0 : (1.0 - third) * b;
        const gm_pair narrow_pair = make_pair(&own), wide_pair = make_pair(&wide);
        const gm_pose none = {0.0, 0.0, 0.0, 0.0, 0.0};
        const gm_pose shift = {0.0, 0.0, by_pose ? (1.0 - third) * b : 0.0, 0.0, 0.0};

        gm_flanks *pinion = flanks_with(45, 2, of_pinion, &of_other);
        gm_flanks *wheel = flanks_with(41, 2, part, &of_part);
        gm_flanks *wide_wheel = flanks_with(41, CELLS + 1, whole, &of_whole);
        for (int k = 0; k < 20; ++k) {
            gm_position at, shifted;
            gm_mesh_result a, c;
            const double sign = k % 5 == 0 ? -1.0 : 1.0;
            GM_ASSERT_INT(
                gm_position_from_pinion_angle(
                    &narrow_pair, gm_test_uniform(&seed, 0.0, 6.0),
                    sign * (0.5 * narrow_pair.backlash + gm_test_uniform(&seed, -2e-6, 12e-6)),
                    1e-3, &at),
                GM_OK);

            /* A wheel that moves along its axis turns by its helix against the pinion: x is its, less that. */
            shifted = at;
            shifted.offset -= shift.axial_shift * narrow_pair.face_advance / narrow_pair.face_width;
            const int reaches = fabs(shifted.offset) < 0.5 * narrow_pair.transverse_base_pitch;
            const gm_flanks *use =
                k % 3 == 0 ? NULL : pinion; /* then the wheel's face lines lead */
            GM_ASSERT_INT(evaluate_posed(&narrow_pair, use, wheel, &none, &at, &a), GM_OK);
            const int status = evaluate_posed(&wide_pair, use, wide_wheel, &shift, &shifted, &c);
            if (!reaches && status != GM_OK) {
                continue; /* shifts by whole widths are more than half a base pitch */
            }
            GM_ASSERT_INT(status, GM_OK);
            GM_ASSERT_NEAR(c.force, a.force, 1e-9, 1e-6);
            GM_ASSERT_NEAR(c.force_by.pinion_angle, a.force_by.pinion_angle, 1e-8, 1e-1);
            GM_ASSERT_INT(c.contact.drive_pairs, a.contact.drive_pairs);
            for (int m = 0; m < 3; ++m) {
                GM_ASSERT_NEAR(c.wrench.wheel_moment[m], a.wrench.wheel_moment[m], 1e-9, 1e-8);
            }
        }
        free(pinion);
        free(wheel);
        free(wide_wheel);
    }
}

/* Both gears as wide as three of their common face, which is the last third of the pinion and the first of the wheel. */
static void tables_begin_where_their_own_faces_do(void) {
    uint64_t seed = UINT64_C(105);
    const gm_pair_params own = reference_params(REFERENCE_FACE_WIDTH);
    gm_pair_params wide = own;
    wide.face_width = (double)NAN;
    wide.pinion_face_width = wide.wheel_face_width = 3.0 * REFERENCE_FACE_WIDTH;
    wide.axial_offset = 2.0 * REFERENCE_FACE_WIDTH;
    const gm_pair narrow_pair = make_pair(&own), wide_pair = make_pair(&wide);
    GM_ASSERT_REL(wide_pair.face_width, REFERENCE_FACE_WIDTH, 1e-14);

    double tables[2][(CELLS + 1) * PROFILE_NODES];
    for (int k = 0; k < (CELLS + 1) * PROFILE_NODES; ++k) {
        tables[GM_PINION][k] = gm_test_uniform(&seed, -3e-6, 3e-6);
        tables[GM_WHEEL][k] = gm_test_uniform(&seed, -3e-6, 3e-6);
    }
    const gm_flank_ramp none_at_all = {0.0, 0.0, 0.0};
    gm_flanks *wide_pinion = flanks_with(45, CELLS + 1, tables[GM_PINION], &none_at_all);
    gm_flanks *wide_wheel = flanks_with(41, CELLS + 1, tables[GM_WHEEL], &none_at_all);
    gm_flanks *pinion = flanks_with(45, 2, tables[GM_PINION] + 2 * PROFILE_NODES, &none_at_all);
    gm_flanks *wheel = flanks_with(41, 2, tables[GM_WHEEL], &none_at_all);

    /* All teeth are the same, so that whole pitches do not matter. */
    const gm_pose drawn = {0.0, 0.0, 0.0, 0.0, 0.0};
    const double p_bt = narrow_pair.transverse_base_pitch;
    for (int k = 0; k < 200; ++k) {
        gm_test_context("state %d", k);
        const double sign = k % 4 == 0 ? -1.0 : 1.0;
        const double x = sign * (0.5 * narrow_pair.backlash + gm_test_uniform(&seed, -2e-6, 12e-6));
        const double phase = gm_test_uniform(&seed, 0.0, p_bt);
        const double there =
            phase - 2.0 * narrow_pair.face_advance; /* where z = 0 of the wide pinion is */
        const gm_position at = {0, 0, phase, x, 1e-3, 0.0};
        const gm_position wide_at = {0, 0, there - p_bt * floor(there / p_bt), x, 1e-3, 0.0};
        gm_mesh_result a, c;
        GM_ASSERT_INT(evaluate_posed(&narrow_pair, pinion, wheel, &drawn, &at, &a), GM_OK);
        GM_ASSERT_INT(evaluate_posed(&wide_pair, wide_pinion, wide_wheel, &drawn, &wide_at, &c),
                      GM_OK);
        GM_ASSERT_NEAR(c.force, a.force, 1e-8, 1e-5);
        GM_ASSERT_NEAR(c.force_by.pinion_angle, a.force_by.pinion_angle, 1e-7, 1.0);

        /* The same force, two widths further along the axis. */
        const double arm = 2.0 * REFERENCE_FACE_WIDTH;
        GM_ASSERT_NEAR(c.wrench.wheel_moment[0],
                       a.wrench.wheel_moment[0] - arm * a.wrench.wheel_force[1], 1e-8, 1e-6);
        GM_ASSERT_NEAR(c.wrench.wheel_moment[1],
                       a.wrench.wheel_moment[1] + arm * a.wrench.wheel_force[0], 1e-8, 1e-6);
    }
    free(wide_pinion);
    free(wide_wheel);
    free(pinion);
    free(wheel);
}

/* A cache follows the pose: as near to the exact sums as without. */
static void a_cache_of_a_posed_mesh_is_as_good(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    params.wheel_face_width = 19e-3;
    const gm_pair pair = make_pair(&params);
    double errors[2] = {0.0, 0.0};
    for (int posed = 0; posed < 2; ++posed) {
        plain_mesh room;
        gm_mesh *mesh;
        gm_mesh_params law;
        gm_cache *cache;
        gm_cache_params resolution;
        gm_cache_errors found;
        gm_mesh_params_default(&law);
        law.stiffness = 1e8;
        if (posed) {
            law.pose.center_distance_change = 60e-6;
            law.pose.offset = -80e-6;
            law.pose.axial_shift = 6e-3;
        }
        GM_ASSERT_INT(gm_mesh_init(&mesh, &law, &pair, NULL, NULL, room.memory, sizeof room.memory),
                      GM_OK);
        gm_cache_params_default(&resolution);
        const size_t size = gm_cache_size(&resolution, mesh);
        void *memory = malloc(size);
        GM_ASSERT_INT(gm_cache_init(&cache, &resolution, mesh, memory, size), GM_OK);
        GM_ASSERT_INT(gm_cache_error(cache, 2000, 3, NULL, &found), GM_OK);
        errors[posed] = found.sum_rms;
        free(memory);
    }
    GM_ASSERT(errors[1] > 0.0 && errors[1] < 3.0 * errors[0] + 1e-10);
}

/* The touching part of one pair in the middle of its path, pressed by more than faces of 15 mm lean by 1 mrad. */
static double leaning_contact(const gm_pair *pair, int side, double inclination, double skew) {
    plain_mesh room;
    gm_mesh *mesh;
    gm_mesh_params law;
    gm_mesh_result result;
    gm_mesh_params_default(&law);
    law.stiffness = 1e8;
    law.pose.inclination = inclination;
    law.pose.skew = skew;
    GM_ASSERT_INT(gm_mesh_init(&mesh, &law, pair, NULL, NULL, room.memory, sizeof room.memory),
                  GM_OK);

    const double sign = side == GM_DRIVE ? 1.0 : -1.0;
    const double middle = 0.5 * (pair->path_start + pair->path_end);
    const double angle = sign * (middle - pair->phase_origin[side]) / pair->pinion.base_radius;
    const double offset = sign * (0.5 * pair->backlash + 60e-6);
    gm_position position;
    GM_ASSERT_INT(gm_position_from_pinion_angle(pair, angle, offset, 0.0, &position), GM_OK);
    GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, GM_WANT_FORCE, NULL, &result), GM_OK);
    return side == GM_DRIVE ? result.contact.drive_contact : result.contact.coast_contact;
}

/*
 * The faces of a leaning wheel move along z by its lean times their height, those of the pinion stay. On a pinion wider on
 * both sides lines keep their length. Gears shifted against each other end at a face of each: what is lost at the wheel's
 * when it is shifted one way is won when it is shifted the other way. All to second order, 1e-6.
 */
static void faces_end_the_lines_of_a_leaning_wheel(void) {
    static const double lean[4] = {1e-3, -1e-3, 0.0, 0.0}, skew[4] = {0.0, 0.0, 1e-3, -1e-3};
    gm_pair_params drawn = spur_pair_params();
    drawn.pinion_face_width = 19e-3;
    drawn.wheel_face_width = 15e-3;
    const gm_pair wider = make_pair(&drawn);
    drawn.pinion_face_width = 15e-3;
    drawn.axial_offset = 5e-3;
    const gm_pair behind = make_pair(&drawn);
    drawn.axial_offset = -5e-3;
    const gm_pair before = make_pair(&drawn);
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        for (int i = 0; i < 4; ++i) {
            gm_test_context("side %d, lean %g, skew %g", side, lean[i], skew[i]);
            GM_ASSERT_REL(leaning_contact(&wider, side, lean[i], skew[i]), 1.0, 5e-6);
            const double of_one = leaning_contact(&behind, side, lean[i], skew[i]);
            GM_ASSERT_REL(of_one + leaning_contact(&before, side, lean[i], skew[i]), 2.0, 2e-5);
            GM_ASSERT(skew[i] != 0.0 || fabs(of_one - 1.0) > 5e-4); /* the shift is there */
        }
        GM_ASSERT_ABS(leaning_contact(&wider, side, 0.0, 0.0), 1.0, 1e-15);
    }
}

/* ---------------------------------------------------------------------------------------------
 * What is refused, and what changes nothing
 * ------------------------------------------------------------------------------------------- */

static void no_pose_is_the_drawing_to_the_last_bit(void) {
    uint64_t seed = UINT64_C(104);
    for (int i = 0; i < 200; ++i) {
        random_case c;
        GM_ASSERT_INT(random_case_make(&c, &seed, 0), GM_OK);
        gmi_engagement drawn, posed;
        const gm_pose none = {0.0, -0.0, 0.0, -0.0, 0.0};
        memset(&drawn, 0, sizeof drawn);
        memset(&posed, 0, sizeof posed);
        GM_ASSERT_INT(gmi_engagement_find(&c.pair, NULL, &drawn), GM_OK);
        GM_ASSERT_INT(gmi_engagement_find(&c.pair, &none, &posed), GM_OK);
        GM_ASSERT(memcmp(&drawn, &posed, sizeof drawn) == 0);
        GM_ASSERT_REL(drawn.face_to - drawn.face_from, 1.0, 0.0);
        random_case_free(&c);
    }
}

static void poses_out_of_mesh_are_refused(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    static const struct {
        gm_pose pose;
        int status;
    } wrong[] = {
        {{5e-3, 0.0, 0.0, 0.0, 0.0}, GM_POSE_OUT_OF_MESH},    /* tips miss each other */
        {{0.0, 30e-3, 0.0, 0.0, 0.0}, GM_POSE_OUT_OF_MESH},   /* the same */
        {{-0.9e-3, 0.0, 0.0, 0.0, 0.0}, GM_POSE_OUT_OF_MESH}, /* tips meet the roots */
        {{-6e-3, 0.0, 0.0, 0.0, 0.0}, GM_POSE_OUT_OF_MESH},   /* base circles overlap */
        {{0.0, 0.0, 17.5e-3, 0.0, 0.0}, GM_POSE_OUT_OF_MESH}, /* faces miss each other */
        {{0.0, 0.0, -17.6e-3, 0.0, 0.0}, GM_POSE_OUT_OF_MESH},
        {{(double)NAN, 0.0, 0.0, 0.0, 0.0}, GM_STATE_NOT_FINITE},
        {{0.0, HUGE_VAL, 0.0, 0.0, 0.0}, GM_STATE_NOT_FINITE},
        {{0.0, 0.0, -HUGE_VAL, 0.0, 0.0}, GM_STATE_NOT_FINITE},
        {{0.0, 0.0, 0.0, (double)NAN, 0.0}, GM_STATE_NOT_FINITE},
        {{0.0, 0.0, 0.0, 0.0, HUGE_VAL}, GM_STATE_NOT_FINITE},
        {{0.0, 0.0, 0.0, 0.05, 0.0}, GM_POSE_OUT_OF_MESH}, /* p_bt / 8 is 42 mrad of 17.5 mm */
    };
    for (size_t k = 0; k < sizeof wrong / sizeof wrong[0]; ++k) {
        gm_test_context("pose %d", (int)k);
        plain_mesh room;
        gm_mesh *mesh = (gm_mesh *)&room;
        gm_mesh_params law;
        gm_mesh_params_default(&law);
        law.stiffness = 1e8;
        law.pose = wrong[k].pose;
        GM_ASSERT_INT(gm_mesh_init(&mesh, &law, &pair, NULL, NULL, room.memory, sizeof room.memory),
                      wrong[k].status);
        GM_ASSERT(mesh == NULL);
    }
}

/* Half a face less, half the force of a spur pair; and the clearance follows the axes. */
static void a_shorter_common_face_carries_less(void) {
    gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
    params.helix_angle = 0.0;
    params.center_distance = 71.2e-3;
    params.pinion_tip_radius = 39.0e-3;
    params.wheel_tip_radius = 35.7e-3;
    const gm_pair pair = make_pair(&params);
    gm_position at;
    gm_mesh_result whole, half;
    const gm_pose none = {0.0, 0.0, 0.0, 0.0, 0.0};
    const gm_pose shifted = {0.0, 0.0, 0.5 * REFERENCE_FACE_WIDTH, 0.0, 0.0};
    GM_ASSERT_INT(gm_position_from_pinion_angle(&pair, 0.011, 0.5 * pair.backlash + 5e-6, 0.0, &at),
                  GM_OK);
    GM_ASSERT_INT(evaluate_posed(&pair, NULL, NULL, &none, &at, &whole), GM_OK);
    GM_ASSERT_INT(evaluate_posed(&pair, NULL, NULL, &shifted, &at, &half), GM_OK);
    GM_ASSERT(whole.force > 100.0);
    GM_ASSERT_REL(half.force, 0.5 * whole.force, 1e-14);
    /* It acts in the middle of the half that is left, z = 3/4 b: the moment about x is -z F_y. */
    GM_ASSERT_REL(half.wrench.wheel_moment[0],
                  -0.75 * REFERENCE_FACE_WIDTH * half.wrench.wheel_force[1], 1e-12);
}

/*
 * A wheel moved along its axis is one drawn there, turned by the helix: the same lines of contact on the same faces, whose
 * common width is another one. Faces of their own on both gears, which may begin anywhere.
 */
static void a_shifted_face_is_another_drawing(void) {
    uint64_t seed = UINT64_C(303);
    int compared = 0;
    for (int i = 0; i < 200; ++i) {
        gm_test_context("case %d", i);
        gm_pair_params params = reference_params((double)NAN);
        params.pinion_face_width = gm_test_uniform(&seed, 10e-3, 25e-3);
        params.wheel_face_width = gm_test_uniform(&seed, 10e-3, 25e-3);
        params.axial_offset = gm_test_uniform(&seed, -6e-3, 6e-3);
        params.helix_angle *= i % 2 ? 1.0 : -1.0;
        const double shift = gm_test_uniform(&seed, -6e-3, 6e-3);
        gm_pair_params there = params;
        there.axial_offset += shift;
        gm_pair from, to;
        if (gm_pair_init(&from, &params) != GM_OK || gm_pair_init(&to, &there) != GM_OK) {
            continue;
        }

        /* Turned by less than half a tooth, so that the same teeth meet. */
        const double turned = shift * tan(from.base_helix_angle);
        const double x = gm_test_uniform(&seed, 60e-6, 80e-6);
        if (!(fabs(x - turned) < 0.49 * from.transverse_base_pitch)) {
            continue;
        }
        const double phi = gm_test_uniform(&seed, -3.0, 3.0);
        gm_position position, other_position;
        gm_mesh_result posed, other;
        const gm_pose pose = {0.0, 0.0, shift, 0.0, 0.0}, none = {0.0, 0.0, 0.0, 0.0, 0.0};
        GM_ASSERT_INT(gm_position_from_pinion_angle(&to, phi, x, 1e-3, &other_position), GM_OK);
        GM_ASSERT_INT(gm_position_from_pinion_angle(&from, phi, x - turned, 1e-3, &position),
                      GM_OK);
        GM_ASSERT_INT(evaluate_posed(&from, NULL, NULL, &pose, &position, &posed), GM_OK);
        GM_ASSERT_INT(evaluate_posed(&to, NULL, NULL, &none, &other_position, &other), GM_OK);

        /* K belongs to the common face as drawn. */
        const double share = from.face_width / to.face_width;
        GM_ASSERT(other.force > 100.0);
        GM_ASSERT_REL(posed.force * share, other.force, 1e-8);
        GM_ASSERT_REL(posed.wrench.wheel_moment[0] * share, other.wrench.wheel_moment[0], 1e-7);
        GM_ASSERT_REL(posed.contact.drive_contact * share, other.contact.drive_contact, 1e-9);
        ++compared;
    }
    gm_test_context("%s", "");
    GM_ASSERT(compared > 80);
}

/* Moved closer, the tip that has less clearance meets its mate's root first, of whichever gear it is. */
static void either_tip_may_meet_a_root(void) {
    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        gm_test_context("role %d", role);
        gm_pair_params params = reference_params(REFERENCE_FACE_WIDTH);
        *(role == GM_PINION ? &params.wheel_rack_dedendum : &params.pinion_rack_dedendum) = 1.65;
        const gm_pair pair = make_pair(&params);
        const double least =
            role == GM_PINION ? pair.pinion_tip_clearance : pair.wheel_tip_clearance;
        const double most =
            role == GM_PINION ? pair.wheel_tip_clearance : pair.pinion_tip_clearance;
        GM_ASSERT(least > 0.1e-3 && most > least + 0.05e-3);
        for (int beyond = 0; beyond < 2; ++beyond) {
            plain_mesh room;
            gm_mesh *mesh;
            gm_mesh_params law;
            gm_mesh_params_default(&law);
            law.stiffness = 1e8;
            law.pose.center_distance_change = -least + (beyond ? -1e-6 : 1e-6);
            GM_ASSERT_INT(
                gm_mesh_init(&mesh, &law, &pair, NULL, NULL, room.memory, sizeof room.memory),
                beyond ? GM_POSE_OUT_OF_MESH : GM_OK);
        }
    }
    gm_test_context("%s", "");
}

/* Its one pair touches at mid-face, wherever the axes tilt to: prepared so or moved there, on both sides. */
static void the_simple_model_knows_no_tilts(void) {
    const gm_pair pair = reference_pair(17.5e-3);
    for (int i = 0; i < 8; ++i) {
        gm_test_context("case %d", i);
        const double tilt = (i & 1 ? 1.0 : -1.0) * 1e-3;
        const double x = (i & 4 ? -1.0 : 1.0) * (0.5 * pair.backlash + 0.2e-6);
        gm_motion motion = {
            .pose = {.skew = i & 2 ? tilt : 0.0, .inclination = i & 2 ? 0.0 : tilt}};
        GM_ASSERT_INT(gm_position_from_pinion_angle(&pair, 0.3, x, 0.0, &motion.position), GM_OK);

        /* One mesh drawn so, one tilted in its pose. */
        plain_mesh rooms[2];
        gm_mesh *mesh, *tilted;
        gm_mesh_params law;
        gm_mesh_params_default(&law);
        law.stiffness = 1e8;
        law.model = GM_MODEL_SIMPLE;
        GM_ASSERT_INT(gm_mesh_init(&mesh, &law, &pair, NULL, NULL, &rooms[0], sizeof rooms[0]),
                      GM_OK);
        law.pose = motion.pose;
        GM_ASSERT_INT(gm_mesh_init(&tilted, &law, &pair, NULL, NULL, &rooms[1], sizeof rooms[1]),
                      GM_OK);

        gm_mesh_result plain, prepared, moved;
        GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &motion.position, 0, NULL, &plain), GM_OK);
        GM_ASSERT_INT(gm_mesh_evaluate_at(tilted, &motion.position, 0, NULL, &prepared), GM_OK);
        GM_ASSERT_INT(gm_mesh_evaluate_posed(mesh, &motion, 0, NULL, &moved), GM_OK);
        GM_ASSERT(fabs(plain.force) > 1.0);
        GM_ASSERT(prepared.force == plain.force);
        GM_ASSERT(moved.force == plain.force);
        for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
            GM_ASSERT(gm_mesh_clearance(tilted, side) == gm_mesh_clearance(mesh, side));
        }
    }
    gm_test_context("%s", "");
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(transmission_error_is_that_of_displaced_helicoids),
        GM_TEST(changes_of_the_transmission_error_are_those_printed),
        GM_TEST(another_centre_distance_is_another_drawing),
        GM_TEST(pitch_deviations_end_no_line),
        GM_TEST(axes_in_another_direction_turn_everything),
        GM_TEST(gradient_between_tilted_axes_is_that_of_differences),
        GM_TEST(only_the_common_face_takes_part),
        GM_TEST(tables_begin_where_their_own_faces_do),
        GM_TEST(a_cache_of_a_posed_mesh_is_as_good),
        GM_TEST(faces_end_the_lines_of_a_leaning_wheel),
        GM_TEST(no_pose_is_the_drawing_to_the_last_bit),
        GM_TEST(poses_out_of_mesh_are_refused),
        GM_TEST(either_tip_may_meet_a_root),
        GM_TEST(a_shifted_face_is_another_drawing),
        GM_TEST(a_shorter_common_face_carries_less),
        GM_TEST(the_simple_model_knows_no_tilts),
    };
    return gm_test_main("unit.pose", tests, GM_TEST_COUNT(tests), argc, argv);
}
