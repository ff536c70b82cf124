/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Measurements of a ring: internal teeth built in space point by point, with material added along the normals of their
 * flanks and every flank at a place of its own. They are looked at as a machine does, from both faces, counted both ways,
 * the flank that is on the left of a tooth with its tip up called left. What is read of this must touch a pinion where the
 * points in space do: the turn that brings the pinion's flank to a point is looked for over the points of a section.
 * Nothing here knows of drive and coast, lines of action, or in which direction a ring turns.
 */
#include "io_test.h"
#include "plain_mesh.h"

static const double pi = 3.14159265358979323846;

enum { PINION_TEETH = 23, RING_TEETH = 71, PROFILE_POINTS = 81, HELIX_POINTS = 61 };

static gm_pair pair;
static gm_measurement setup;
static gm_traces_options options;
static gm_io_error error;

static void make_pair(double helix_angle) {
    gm_pair_params params;
    gm_pair_params_default(&params);
    params.pinion_teeth = PINION_TEETH;
    params.wheel_teeth = -RING_TEETH;
    params.normal_module = 3e-3;
    params.normal_pressure_angle = pi / 9.0;
    params.helix_angle = helix_angle;
    params.center_distance = 72e-3 / cos(helix_angle);
    params.face_width = 30e-3;
    params.pinion_profile_shift = 0.35;
    params.wheel_profile_shift = -0.35;
    params.backlash = 120e-6;
    const int status = gm_pair_init(&pair, &params);
    if (status != GM_OK) {
        fprintf(stderr, "%s\n", gm_status_text(status));
        exit(1);
    }
}

/* ---------------------------------------------------------------------------------------------
 * The ring that is there
 * ------------------------------------------------------------------------------------------- */

typedef struct point {
    double x, y, z;
} point;

/* Of each flank [tooth][on the counter-clockwise side]: material along the normal (m), and by how much it is turned (rad). */
static double profile_slope[RING_TEETH][2], profile_curve[RING_TEETH][2];
static double helix_slope[RING_TEETH][2], helix_curve[RING_TEETH][2];
static double turned[RING_TEETH][2];

static double drawn(uint64_t *seed, double amplitude) {
    return gm_test_uniform(seed, -amplitude, amplitude);
}

static void make_flanks(uint64_t seed) {
    double mean[2] = {0.0, 0.0};
    for (int j = 0; j < RING_TEETH; ++j) {
        for (int k = 0; k < 2; ++k) {
            profile_slope[j][k] = drawn(&seed, 1.5e-6);
            profile_curve[j][k] = drawn(&seed, 1.5e-6);
            helix_slope[j][k] = drawn(&seed, 2e-6);
            helix_curve[j][k] = drawn(&seed, 2e-6);
            turned[j][k] = drawn(&seed, 3e-6) / pair.wheel.reference_radius;
            mean[k] += turned[j][k] / RING_TEETH;
        }
    }

    /* A pitch measurement does not say how thick the teeth are. */
    for (int j = 0; j < RING_TEETH; ++j) {
        for (int k = 0; k < 2; ++k) {
            turned[j][k] -= mean[k];
        }
    }
}

static double reference_roll(void) {
    return sqrt(pair.wheel.reference_radius * pair.wheel.reference_radius -
                pair.wheel.base_radius * pair.wheel.base_radius);
}

/* Material on a flank, none at mid-face on the reference circle. */
static double material(int tooth, int left_turn, double roll, double z) {
    const double s = (roll - reference_roll()) / (2.0 * pair.normal_module);
    const double u = 2.0 * z / pair.face_width - 1.0;
    return s * (profile_slope[tooth][left_turn] + s * profile_curve[tooth][left_turn]) +
           u * (helix_slope[tooth][left_turn] + u * helix_curve[tooth][left_turn]);
}

static double twist(double base_radius) {
    return tan(pair.base_helix_angle) / base_radius;
}

/* Direction of a tooth of the ring from its axis, counter-clockwise from +x, seen against z: docs/conventions.md. */
static double tooth_direction(int tooth, double z) {
    return (2 * tooth + 1) * pi / RING_TEETH + twist(pair.wheel.base_radius) * z;
}

/* A point of the flank that was drawn, about the ring's axis; turn 1 is the counter-clockwise flank of a tooth. */
static point drawn_point(int tooth, int turn, double roll, double z) {
    const double base = pair.wheel.base_radius;
    const double involute = roll / base - atan(roll / base);
    const double angle =
        tooth_direction(tooth, z) + turn * (pair.wheel.base_half_thickness + involute);
    const double radius = hypot(base, roll);
    return (point){radius * cos(angle), radius * sin(angle), z};
}

/* The normal of that flank out of the tooth, from its tangents. */
static point normal_of(int tooth, int turn, double roll, double z) {
    const double h = 1e-5;
    const point a = drawn_point(tooth, turn, roll - h, z);
    const point b = drawn_point(tooth, turn, roll + h, z);
    const point c = drawn_point(tooth, turn, roll, z - h);
    const point d = drawn_point(tooth, turn, roll, z + h);
    const point u = {b.x - a.x, b.y - a.y, b.z - a.z};
    const point v = {d.x - c.x, d.y - c.y, d.z - c.z};
    point n = {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};

    /* Out of a tooth is away from its middle. */
    const point at = drawn_point(tooth, turn, roll, z);
    const double away = turn * (at.x * n.y - at.y * n.x);
    const double scale = (away > 0.0 ? 1.0 : -1.0) / sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
    n = (point){scale * n.x, scale * n.y, scale * n.z};
    return n;
}

/* A point of the flank that is there, in the plane at z, with the ring turned by an angle and its axis where it stands. */
static point ring_point(int tooth, int turn, double roll, double z, double ring_angle) {
    double own_z = z;
    point p = {0.0, 0.0, 0.0};
    for (int k = 0; k < 3; ++k) {
        const double f = material(tooth, turn > 0, roll, own_z);
        const point n = normal_of(tooth, turn, roll, own_z);
        p = drawn_point(tooth, turn, roll, own_z);
        p = (point){p.x + f * n.x, p.y + f * n.y, p.z + f * n.z};
        own_z += z - p.z;
    }
    const double angle = ring_angle + turned[tooth][turn > 0];
    return (point){p.x * cos(angle) - p.y * sin(angle) - pair.center_distance,
                   p.x * sin(angle) + p.y * cos(angle), p.z};
}

/* ---------------------------------------------------------------------------------------------
 * What a machine prints of it
 * ------------------------------------------------------------------------------------------- */

/* From face I everything is mirrored. */
static double mirror(void) {
    return setup.datum_face == GM_FACE_II ? 1.0 : -1.0;
}

static double counted(void) {
    return mirror() * (setup.counting == GM_COUNTERCLOCKWISE ? 1.0 : -1.0);
}

static int number_of(int tooth) {
    const double angle = tooth_direction(tooth, 0.0) - tooth_direction(setup.first_tooth, 0.0);
    const int steps = (int)lround(counted() * angle * RING_TEETH / (2.0 * pi));
    return (steps % RING_TEETH + RING_TEETH) % RING_TEETH + setup.first_number;
}

/* Seen with the tip of the tooth up: a flank is left if the tip has to turn counter-clockwise to point to it. */
static const char *flank_of(int tooth, int turn) {
    const double direction = tooth_direction(tooth, 0.0);
    const point tip = {-mirror() * cos(direction), -sin(direction), 0.0};
    const point to_flank = {-turn * mirror() * sin(direction), turn * cos(direction), 0.0};
    return tip.x * to_flank.y - tip.y * to_flank.x > 0.0 ? "left" : "right";
}

static char text[4000000];
static size_t used;

static void add_row(int tooth, int turn, const char *kind, double z, double roll, double level) {
    const double face = setup.datum_face == GM_FACE_I ? z : pair.face_width - z;
    used += (size_t)snprintf(text + used, sizeof text - used, "%d,%s,%s,%.6f,%.7f,%.5f\n",
                             number_of(tooth), flank_of(tooth, turn), kind, 1e3 * face,
                             2e3 * hypot(roll, pair.wheel.base_radius),
                             1e6 * (material(tooth, turn > 0, roll, z) + level));
}

/* Profiles from the tip to the root, at mid-face; helices on the reference circle. Levels mean nothing. */
static const char *measured_traces(uint64_t seed) {
    const double root = sqrt(pair.wheel.root_radius * pair.wheel.root_radius -
                             pair.wheel.base_radius * pair.wheel.base_radius);
    used = (size_t)sprintf(text, "tooth,flank,trace,face_mm,diameter_mm,deviation_um\n");
    for (int which = 0; which < 2 * RING_TEETH; ++which) {
        const int tooth = which / 2;
        const int turn = which % 2 ? 1 : -1;
        const double levels[2] = {drawn(&seed, 50e-6), drawn(&seed, 50e-6)};
        for (int i = 0; i < PROFILE_POINTS; ++i) {
            const double share = (double)i / (PROFILE_POINTS - 1);
            add_row(tooth, turn, "profile", 0.5 * pair.face_width,
                    pair.wheel.tip_roll_length + share * (root - pair.wheel.tip_roll_length),
                    levels[0]);
        }
        for (int i = 0; i < HELIX_POINTS; ++i) {
            add_row(tooth, turn, "helix", pair.face_width * i / (HELIX_POINTS - 1),
                    reference_roll(), levels[1]);
        }
    }
    return file_of(text);
}

/* How far flanks stand ahead in the direction of counting, as an arc of the reference circle. */
static const char *measured_pitch(void) {
    used = (size_t)sprintf(text, "tooth,flank,cumulative_pitch_um\n");
    for (int which = 0; which < 2 * RING_TEETH; ++which) {
        const int tooth = which / 2;
        const int turn = which % 2 ? 1 : -1;
        used += (size_t)sprintf(
            text + used, "%d,%s,%.5f\n", number_of(tooth), flank_of(tooth, turn),
            1e6 * counted() * turned[tooth][turn > 0] * pair.wheel.reference_radius);
    }
    return file_of(text);
}

static gm_flanks *loaded_flanks(uint64_t seed) {
    gm_traces traces;
    gm_measured_pitch places;
    gm_deviations deviations;
    gm_pitch pitch;
    gm_flanks *flanks = NULL;
    gm_flanks_options how;
    gm_flanks_options_default(&how);
    how.normal_factor = pair.normal_to_transverse;

    GM_ASSERT_INT(
        gm_traces_read(&traces, measured_traces(seed), &pair, 1, GM_DECIMAL_POINT, &error),
        GM_IO_OK);
    GM_ASSERT_INT(gm_traces_build(&deviations, NULL, &traces, &setup, &pair, 1, &options, &error),
                  GM_IO_OK);
    GM_ASSERT_INT(gm_measured_pitch_read(&places, measured_pitch(), GM_DECIMAL_POINT, &error),
                  GM_IO_OK);
    GM_ASSERT_INT(gm_measured_pitch_build(&pitch, NULL, &places, &setup, &pair, 1, &error),
                  GM_IO_OK);
    GM_ASSERT_INT(gm_flanks_build(&flanks, RING_TEETH, &deviations, &pitch, &how, NULL, &error),
                  GM_IO_OK);
    if (flanks == NULL) {
        fprintf(stderr, "%s\n", error.text);
    }
    gm_traces_free(&traces);
    gm_measured_pitch_free(&places);
    gm_deviations_free(&deviations);
    gm_pitch_free(&pitch);
    return flanks;
}

/* ---------------------------------------------------------------------------------------------
 * Where the pinion touches it
 * ------------------------------------------------------------------------------------------- */

/* By what angle the pinion has to turn for the flank of its tooth to pass through a point; turn 1: its leading flank, that
 * turns forward, -1: the other one, that turns backward. */
static double turn_to(int tooth, int turn, point p, double pinion_angle) {
    const double base = pair.pinion.base_radius;
    const double roll = sqrt(fmax(p.x * p.x + p.y * p.y - base * base, 0.0));
    const double involute = roll / base - atan(roll / base);
    const double direction = pinion_angle + 2.0 * pi * tooth / PINION_TEETH + twist(base) * p.z;
    const double flank = direction + turn * (pair.pinion.base_half_thickness - involute);
    return turn * remainder(atan2(p.y, p.x) - flank, 2.0 * pi);
}

/* How far a pinion flank is inside a ring flank in the plane at z, as an arc of the base circle: there where the turn is
 * least, which is looked for from a roll length of the ring on. */
static double overlap_at(int pinion_tooth, int ring_tooth, int turn, double z, double roll,
                         double phi_p, double phi_w) {
    double step = 0.2 * pair.normal_module;
    for (int k = 0; k < 8; ++k) {
        double needed[3];
        for (int i = 0; i < 3; ++i) {
            const point p = ring_point(ring_tooth, -turn, roll + (i - 1) * step, z, phi_w);
            needed[i] = turn_to(pinion_tooth, turn, p, phi_p);
        }

        /* Vertex of a parabola through three points that come closer. */
        const double slope = 0.5 * (needed[2] - needed[0]);
        const double bend = needed[2] - 2.0 * needed[1] + needed[0];
        const double move = bend > 0.0 ? -slope / bend : slope > 0.0 ? -2.0 : 2.0;
        roll += step * fmax(-4.0, fmin(4.0, move));
        step *= 0.5;
    }
    const point touch = ring_point(ring_tooth, -turn, roll, z, phi_w);
    return -turn_to(pinion_tooth, turn, touch, phi_p) * pair.pinion.base_radius;
}

/* The deepest of it over all flanks of the ring that are near: nothing is said of which tooth meets which. */
static double deepest_overlap(int pinion_tooth, int turn, double z, double roll, double phi_p,
                              double phi_w) {
    double deepest = -1.0;
    for (int tooth = 0; tooth < RING_TEETH; ++tooth) {
        const point p = ring_point(tooth, -turn, roll, z, phi_w);
        const double off = pair.pinion.base_radius * turn_to(pinion_tooth, turn, p, phi_p);
        const int is_near = hypot(p.x, p.y) < pair.pinion.tip_radius + pair.normal_module;
        if (is_near && fabs(off) < 0.25 * pair.transverse_base_pitch) {
            deepest = fmax(deepest, overlap_at(pinion_tooth, tooth, turn, z, roll, phi_p, phi_w));
        }
    }
    return deepest;
}

/*
 * What the model leaves out is of second order: it reads the material where ideal flanks touch. With a slope of the
 * material along the profile the surfaces touch beside that, and are nearer by half of slope squared times the relative
 * radius of curvature (a roll length dr is the length rho / r_b dr along an involute); and the touching point moves with
 * the overlap, which counts slope times overlap. The rest, third order and the polygons through the points, is below 1 nm.
 */
static double second_order(const gm_line_load_point *at, int turn, double overlap) {
    const double h = 1e-5;
    const int tooth = at->wheel_tooth;
    const double roll = at->wheel_roll_length;
    const double slope =
        pair.normal_to_transverse *
        (material(tooth, turn < 0, roll + h, at->z) - material(tooth, turn < 0, roll - h, at->z)) /
        (2.0 * h);
    const double along = at->wheel_roll_length / pair.wheel.base_radius;
    const double curvature =
        (1.0 / at->pinion_roll_length - 1.0 / at->wheel_roll_length) * along * along;
    return 0.5 * slope * slope / curvature + fabs(slope) * overlap;
}

/* Points of the lines of contact that touch, all of which are at the overlap of the gears in space. */
static int compare(gm_mesh *mesh, const gm_flanks *flanks, int turn, double phi_p) {
    /* Pressed together by 15 um beyond half the backlash, the pinion forward or backward. */
    const double x = turn * (0.5 * pair.backlash + 15e-6);
    const double phi_w = (pair.pinion.base_radius * phi_p - x) / pair.wheel.base_radius;
    const gm_state state = {.pinion_angle = phi_p, .wheel_angle = phi_w};
    gm_penetration sums;
    GM_ASSERT_INT(gm_penetration_3d(&pair, NULL, flanks, &state, &sums), GM_OK);
    GM_ASSERT((turn > 0 ? sums.drive : sums.coast) > 10e-6);
    GM_ASSERT_ABS(turn > 0 ? sums.coast : sums.drive, 0.0, 0.0);

    gm_position position;
    gm_line_loads load;
    gm_line_load_point points[400];
    GM_ASSERT_INT(gm_position_from_state(&pair, &state, &position), GM_OK);
    GM_ASSERT_INT(gm_mesh_line_loads(mesh, &position, NULL, points, 400, &load), GM_OK);
    int compared = 0;
    for (int i = 0; i < load.points; ++i) {
        const gm_line_load_point *at = &points[i];
        if (!(at->line_load > 0.0)) {
            continue;
        }
        const double overlap =
            deepest_overlap(at->pinion_tooth, turn, at->z, at->wheel_roll_length, phi_p, phi_w);
        const double allowed = second_order(at, turn, overlap);
        GM_ASSERT_ABS(-at->gap, overlap, allowed + 1e-9);
        ++compared;
    }
    return compared;
}

static void compare_all(double helix_angle, uint64_t seed) {
    plain_mesh room;
    gm_mesh *mesh = NULL;
    make_pair(helix_angle);
    make_flanks(seed);
    gm_flanks *flanks = loaded_flanks(seed);
    GM_ASSERT_INT(plain_mesh_make(&room, &pair, NULL, flanks, 1e9, 0.0, &mesh), GM_OK);

    /* Three positions, so that one pinion tooth meets several of the ring. */
    for (int k = 0; flanks != NULL && mesh != NULL && k < 3; ++k) {
        for (int turn = -1; turn <= 1; turn += 2) {
            gm_test_context("helix %.2f seed %d position %d turn %d", helix_angle, (int)seed, k,
                            turn);
            GM_ASSERT(compare(mesh, flanks, turn, 0.37 + 2.1 * k) > 10);
        }
    }
    gm_flanks_free(flanks);
}

static void begin(int which) {
    gm_measurement_default(&setup);
    gm_traces_options_default(&options);
    options.face_nodes = HELIX_POINTS;
    options.profile_nodes = 101;
    options.hollow = 1;
    setup.datum_face = which & 1 ? GM_FACE_I : GM_FACE_II;
    setup.counting = which & 2 ? GM_CLOCKWISE : GM_COUNTERCLOCKWISE;
    setup.first_number = which & 4 ? 0 : 1;
    setup.first_tooth = 5 * which;
}

static void a_measured_ring_touches_where_its_points_do(void) {
    for (int which = 0; which < 8; ++which) {
        begin(which);
        compare_all(0.0, (uint64_t)(100 + which));
        compare_all(which & 1 ? 0.3 : -0.3, (uint64_t)(200 + which));
    }
}

/* ---------------------------------------------------------------------------------------------
 * What does not fit a ring
 * ------------------------------------------------------------------------------------------- */

/* One profile of three points and the status that it comes to. */
static int try_profile(double from_mm, double to_mm) {
    gm_traces traces;
    gm_deviations deviations;
    static const char head[] = "tooth,flank,trace,face_mm,diameter_mm,deviation_um\n";
    used = (size_t)snprintf(text, sizeof text,
                            "%s1,left,profile,15,%.4f,-1\n1,left,profile,15,%.4f,0.5\n"
                            "1,left,profile,15,%.4f,-2\n",
                            head, from_mm, 0.5 * (from_mm + to_mm), to_mm);
    int status = gm_traces_read(&traces, file_of(text), &pair, 1, GM_DECIMAL_POINT, &error);
    if (status == GM_IO_OK) {
        status = gm_traces_build(&deviations, NULL, &traces, &setup, &pair, 1, &options, &error);
        gm_traces_free(&traces);
        gm_deviations_free(&deviations);
    }
    return status;
}

static void a_trace_stays_between_tip_and_root(void) {
    begin(0);
    make_pair(0.0);
    const double tip = 2e3 * pair.wheel.tip_radius;
    const double root = 2e3 * pair.wheel.root_radius;
    const double start = 2e3 * hypot(pair.wheel.base_radius, pair.wheel.start_roll_length);
    const char *path = IO_TEST_PATH("csv");
    GM_ASSERT_INT(try_profile(tip, root), GM_IO_OK);
    GM_ASSERT_INT(try_profile(root, tip), GM_IO_OK);

    /* Beyond the tip, which is the inner end; perhaps on a chamfer. */
    GM_ASSERT_INT(try_profile(tip - 0.1, root), GM_IO_ERR_FORMAT);
    assert_error(&error, path, 2, "leaves the ring", "the tip");
    GM_ASSERT_STRING(error.option, "tip_form_diameter");

    /* Beyond the root, where no flank can be, and lengths in other units. */
    GM_ASSERT_INT(try_profile(tip, root + 0.1), GM_IO_ERR_FORMAT);
    assert_error(&error, path, 4, "leaves the ring", "the root");
    GM_ASSERT_INT(try_profile(0.5 * tip, 0.5 * root), GM_IO_ERR_FORMAT);
    assert_error(&error, path, 2, "it looks like a radius", "(root)");

    /* Too little of the flank: the message has the ends in the order of the file. */
    GM_ASSERT_INT(try_profile(tip, tip + 0.4 * (start - tip)), GM_IO_ERR_FORMAT);
    char right[100];
    snprintf(right, sizeof right, "must reach from %.5g to %.5g mm",
             1e3 * pair.wheel.tip_roll_length, 1e3 * pair.wheel.start_roll_length);
    assert_error(&error, path, 2, right, "roll length");
}

static void a_chamfer_of_a_ring_is_at_its_inner_end(void) {
    begin(0);
    make_pair(0.0);
    const double tip = 2.0 * pair.wheel.tip_radius;
    const double root = 2.0 * pair.wheel.root_radius;
    gm_trace trace = {.tooth = 1, .flank = GM_LEFT, .kind = GM_TRACE_PROFILE, .count = 41};
    double position[41], deviation[41];
    const gm_traces traces = {.count = 1, .traces = &trace};
    const double base = pair.wheel.base_radius;
    trace.at = 0.5 * pair.face_width;
    trace.position = position;
    trace.deviation = deviation;

    /* Material is missing by 100 um within 0.6 mm of the tip. */
    options.tip_form_diameter = tip + 0.6e-3;
    int chamfered = 0;
    for (int i = 0; i < 41; ++i) {
        const double radius = 0.5 * (tip + i / 40.0 * (root - tip));
        const int on_chamfer = radius < 0.5 * options.tip_form_diameter;
        position[i] = sqrt(radius * radius - base * base);
        deviation[i] = on_chamfer ? -100e-6 : 1e-6 * i * i / 1600.0;
        chamfered += on_chamfer;
    }
    gm_deviations deviations;
    gm_traces_report report;
    GM_ASSERT_INT(
        gm_traces_build(&deviations, &report, &traces, &setup, &pair, 1, &options, &error),
        GM_IO_OK);
    GM_ASSERT(chamfered > 1);
    GM_ASSERT_INT(report.chamfer_points, chamfered);

    /* Nothing of it is left, and the end at the tip is t2 = 1. */
    const double *values = deviations.sets[0].values;
    double low = 0.0;
    for (int k = 0; k < options.profile_nodes; ++k) {
        low = fmin(low, values[k]);
    }
    GM_ASSERT(low > -2e-6);
    GM_ASSERT(report.profile_range[0] == 0.0 && report.profile_range[1] < 1.0);
    gm_deviations_free(&deviations);

    /* A form circle beyond the trace leaves nothing. */
    options.tip_form_diameter = root + 1e-3;
    GM_ASSERT_INT(gm_traces_build(&deviations, NULL, &traces, &setup, &pair, 1, &options, &error),
                  GM_IO_ERR_FORMAT);
    GM_ASSERT(strstr(error.text, "got none outside") != NULL);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(a_measured_ring_touches_where_its_points_do),
        GM_TEST(a_trace_stays_between_tip_and_root),
        GM_TEST(a_chamfer_of_a_ring_is_at_its_inner_end),
    };
    return gm_test_main("unit.measured_ring", tests, GM_TEST_COUNT(tests), argc, argv);
}
