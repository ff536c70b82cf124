/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Event indicators: their roots are where an evaluation counts other pairs, and there are no others. */
#include "gearmesh/gearmesh.h"
#include "gm_test.h"
#include "plain_mesh.h"
#include "reference_gear.h"

/* A way of both gears: over four base pitches forwards, in and out of contact. */
typedef struct way {
    const gm_mesh *mesh;
    gm_pose pose;
    double side, depth, swing;
    double near; /* how close to a root the pairs have to have changed */
} way;

static gm_motion motion_at(const way *w, double time) {
    const gm_pair *pair = gm_mesh_pair(w->mesh);
    gm_motion motion = {.pose = w->pose};
    const double x = w->side * (0.5 * pair->backlash + w->depth + w->swing * sin(7.3 * time));
    (void)gm_position_from_pinion_angle(pair, 0.3 + 4.0 * time * pair->pinion.pitch_angle, x, 0.0,
                                        &motion.position);
    return motion;
}

static void look(const way *w, double time, double indicators[GM_EVENTS], int pairs[2]) {
    const gm_motion motion = motion_at(w, time);
    gm_mesh_result r;
    GM_ASSERT_INT(gm_mesh_event_indicators(w->mesh, &motion, indicators), GM_OK);
    GM_ASSERT_INT(gm_mesh_evaluate_posed(w->mesh, &motion, GM_WANT_FORCE, NULL, &r), GM_OK);
    pairs[GM_DRIVE] = r.contact.drive_pairs;
    pairs[GM_COAST] = r.contact.coast_pairs;
}

/* The root of one indicator between two times. */
static double root_of(const way *w, int event, double from, double to) {
    double ends[GM_EVENTS], middle[GM_EVENTS];
    gm_motion motion = motion_at(w, from);
    (void)gm_mesh_event_indicators(w->mesh, &motion, ends);
    for (int k = 0; k < 60; ++k) {
        const double time = 0.5 * (from + to);
        motion = motion_at(w, time);
        (void)gm_mesh_event_indicators(w->mesh, &motion, middle);
        if ((middle[event] > 0.0) == (ends[event] > 0.0)) {
            from = time;
        } else {
            to = time;
        }
    }
    return 0.5 * (from + to);
}

/* Roots of the way, each against the pairs just before and behind it; how many there were. */
static int roots_of(const way *w) {
    enum { STEPS = 400 };
    int roots = 0;
    double last[GM_EVENTS], now[GM_EVENTS];
    int last_pairs[2], pairs[2];

    look(w, 0.0, last, last_pairs);
    for (int k = 1; k <= STEPS; ++k) {
        const double from = (k - 1.0) / STEPS, to = (double)k / STEPS;
        look(w, to, now, pairs);

        /* Each indicator that changes its sign in this step. */
        int changes[2] = {0, 0};
        for (int event = 0; event < GM_EVENTS; ++event) {
            if ((now[event] > 0.0) == (last[event] > 0.0)) {
                continue;
            }

            /* What it says just before and just behind. */
            const int side = event / 3;
            const double time = root_of(w, event, from, to);
            double before[GM_EVENTS], behind[GM_EVENTS];
            int pairs_before[2], pairs_behind[2];
            look(w, time - w->near, before, pairs_before);
            look(w, time + w->near, behind, pairs_behind);

            /* Out of contact lines come and go without notice; and next to a
             * touch the ends of the path with corners move faster than lines. */
            const int is_contact = event % 3 == 0;
            if (!is_contact && fmin(before[3 * side], behind[3 * side]) <= 0.05 * w->depth) {
                changes[side] = 1;
                continue;
            }
            gm_test_context("event %d at %.9f", event, time);
            if (event % 3 == 0) {
                GM_ASSERT_INT(pairs_before[side] > 0, before[event] > 0.0);
                GM_ASSERT_INT(pairs_behind[side] > 0, behind[event] > 0.0);
                changes[side] = 1;
                ++roots;
            } else if ((behind[event] > 0.0) != (side == GM_DRIVE)) {
                GM_ASSERT_INT(pairs_behind[side],
                              pairs_before[side]); /* halfway between two events */
            } else {
                changes[side] = 1;
                ++roots;
                /* The pinion turns forwards: drive pairs enter at the lower end, coast pairs at the upper. */
                const int comes = event == GM_EVENT_DRIVE_LOWER || event == GM_EVENT_COAST_UPPER;
                GM_ASSERT_INT(pairs_behind[side] - pairs_before[side], comes ? 1 : -1);
            }
        }
        for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
            gm_test_context("side %d at %.9f", side, to);
            GM_ASSERT(pairs[side] == last_pairs[side] || changes[side]);
        }
        memcpy(last, now, sizeof last);
        memcpy(last_pairs, pairs, sizeof pairs);
    }
    return roots;
}

static void roots_are_where_pairs_change(void) {
    for (int which = 0; which < 3; ++which) {
        gm_pair_params ring;
        gm_pair_params_default(&ring);
        ring.pinion_teeth = 36;
        ring.wheel_teeth = -93;
        ring.normal_module = 21e-3;
        ring.normal_pressure_angle = 0.3490658503988659;
        ring.center_distance = 584e-3;
        ring.face_width = 0.2;
        ring.pinion_profile_shift = 0.5;
        const gm_pair pair = which == 0   ? spur_pair()
                             : which == 1 ? reference_pair(REFERENCE_FACE_WIDTH)
                                          : make_pair(&ring);
        const double m = pair.normal_module;

        /* With corners and without, on both sides, in a pose and as drawn. */
        for (int kind = 0; kind < 8; ++kind) {
            gm_mesh_params params;
            gm_mesh_params_default(&params);
            params.stiffness = 1e8;
            params.corner_contact = kind % 2 == 0 ? GM_CORNER_OFF : GM_CORNER_ON;
            plain_mesh where;
            gm_mesh *mesh;
            GM_ASSERT_INT(
                gm_mesh_init(&mesh, &params, &pair, NULL, NULL, where.memory, sizeof where.memory),
                GM_OK);

            way w = {.mesh = mesh,
                     .side = kind / 2 % 2 == 0 ? 1.0 : -1.0,
                     .depth = 4e-3 * m,
                     .swing = 6e-3 * m,
                     /* The gap of helical gears is that of parabolas, 1e-7 base pitches off. */
                     .near = kind % 2 == 0 ? 1e-9 : 1e-4};
            if (kind >= 4) {
                w.pose.center_distance_change = 1e-3 * m;
                w.pose.axial_shift = 5e-3 * m;
            }

            gm_test_context("pair %d, kind %d", which, kind);
            GM_ASSERT(roots_of(&w) >= 6);
        }
    }
}

static void indicators_at(const gm_mesh *mesh, double x, double indicators[GM_EVENTS]) {
    gm_motion motion = {.position = {.offset = 0.0}};
    GM_ASSERT_INT(gm_position_from_pinion_angle(gm_mesh_pair(mesh), 0.37, x, 0.0, &motion.position),
                  GM_OK);
    GM_ASSERT_INT(gm_mesh_event_indicators(mesh, &motion, indicators), GM_OK);
}

/* Tip edges reach as far beyond the path as the highest flanks overlap: pitch on all teeth counts as so much overlap. */
static void corners_reach_as_far_as_the_highest_flanks(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const double pitch = 7e-6, x = 0.5 * pair.backlash + 3e-6;
    const gm_flanks_params sizes = {.teeth = pair.pinion.teeth};
    static double memory[4096];
    gm_flanks *flanks;
    GM_ASSERT_INT(gm_flanks_init(&flanks, &sizes, memory, sizeof memory), GM_OK);
    for (int tooth = 0; tooth < pair.pinion.teeth; ++tooth) {
        GM_ASSERT_INT(gm_flanks_set_pitch(flanks, GM_DRIVE, tooth, pitch), GM_OK);
    }

    /* The same gears with all teeth moved, and without. */
    gm_mesh_params params;
    gm_mesh_params_default(&params);
    params.stiffness = 1e8;
    params.corner_contact = GM_CORNER_ON;
    plain_mesh places[2];
    gm_mesh *high, *ideal;
    GM_ASSERT_INT(gm_mesh_init(&high, &params, &pair, flanks, NULL, places[0].memory,
                               sizeof places[0].memory),
                  GM_OK);
    GM_ASSERT_INT(
        gm_mesh_init(&ideal, &params, &pair, NULL, NULL, places[1].memory, sizeof places[1].memory),
        GM_OK);

    double with_pitch[GM_EVENTS], deeper[GM_EVENTS], as_deep[GM_EVENTS];
    indicators_at(high, x, with_pitch);
    indicators_at(ideal, x + pitch, deeper);
    indicators_at(ideal, x, as_deep);
    GM_ASSERT_ABS(with_pitch[GM_EVENT_DRIVE_UPPER], deeper[GM_EVENT_DRIVE_UPPER], 1e-9);
    GM_ASSERT(fabs(as_deep[GM_EVENT_DRIVE_UPPER] - deeper[GM_EVENT_DRIVE_UPPER]) > 1e-3);
}

/* Elastic teeth have the lines of gears that just touch, however deep they are pressed. */
static void lines_of_elastic_teeth_are_those_without_load(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    gm_mesh_params params;
    gm_mesh_params_default(&params);
    params.stiffness = 1e8;
    params.corner_contact = GM_CORNER_OFF;
    plain_mesh where;
    gm_mesh *stiff, *elastic;
    GM_ASSERT_INT(
        gm_mesh_init(&stiff, &params, &pair, NULL, NULL, where.memory, sizeof where.memory), GM_OK);
    params.law = GM_LAW_ELASTIC;
    const size_t size = gm_mesh_size(&params, &pair);
    void *memory = malloc(size);
    GM_ASSERT_INT(gm_mesh_init(&elastic, &params, &pair, NULL, NULL, memory, size), GM_OK);

    double pressed[GM_EVENTS], touching[GM_EVENTS];
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        const double sign = side == GM_DRIVE ? 1.0 : -1.0;
        const int first = side == GM_DRIVE ? GM_EVENT_DRIVE_CONTACT : GM_EVENT_COAST_CONTACT;
        indicators_at(elastic, sign * (0.5 * pair.backlash + 40e-6), pressed);
        indicators_at(stiff, sign * 0.5 * pair.backlash, touching);
        for (int k = first + 1; k <= first + 2; ++k) {
            gm_test_context("indicator %d", k);
            GM_ASSERT_ABS(pressed[k], touching[k], 1e-9);
        }
    }
    free(memory);
}

/* Without contact the indicator of a side is how far its flanks are apart, with deviations the highest. */
static void contact_is_told_by_the_clearance(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const gm_flanks_params sizes = {.teeth = pair.pinion.teeth};
    static double memory[4096];
    gm_flanks *flanks;
    GM_ASSERT_INT(gm_flanks_init(&flanks, &sizes, memory, sizeof memory), GM_OK);
    GM_ASSERT_INT(gm_flanks_set_pitch(flanks, GM_DRIVE, 3, 7e-6), GM_OK);

    /* One tooth that stands out. */
    plain_mesh where;
    gm_mesh *mesh;
    gm_mesh_params params;
    gm_mesh_params_default(&params);
    params.stiffness = 1e8;
    GM_ASSERT_INT(
        gm_mesh_init(&mesh, &params, &pair, flanks, NULL, where.memory, sizeof where.memory),
        GM_OK);
    const gm_motion motion = {.position = {.offset = 1e-6}};
    double indicators[GM_EVENTS];
    GM_ASSERT_INT(gm_mesh_event_indicators(mesh, &motion, indicators), GM_OK);
    GM_ASSERT_ABS(indicators[GM_EVENT_DRIVE_CONTACT], 1e-6 - gm_mesh_clearance(mesh, GM_DRIVE),
                  1e-18);
    GM_ASSERT_ABS(indicators[GM_EVENT_COAST_CONTACT], -1e-6 - gm_mesh_clearance(mesh, GM_COAST),
                  1e-18);

    /* Bad input. */
    const gm_motion bad = {.position = {.offset = (double)NAN}};
    GM_ASSERT_INT(gm_mesh_event_indicators(mesh, &bad, indicators), GM_STATE_NOT_FINITE);
    GM_ASSERT_NAN(indicators[GM_EVENT_COAST_UPPER]);
    GM_ASSERT_INT(gm_mesh_event_indicators(NULL, &motion, indicators), GM_ERR_NULL);
    GM_ASSERT_INT(gm_mesh_event_indicators(mesh, NULL, indicators), GM_ERR_NULL);
    GM_ASSERT_INT(gm_mesh_event_indicators(mesh, &motion, NULL), GM_ERR_NULL);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(roots_are_where_pairs_change),
        GM_TEST(corners_reach_as_far_as_the_highest_flanks),
        GM_TEST(lines_of_elastic_teeth_are_those_without_load),
        GM_TEST(contact_is_told_by_the_clearance),
    };
    return gm_test_main("unit.events", tests, GM_TEST_COUNT(tests), argc, argv);
}
