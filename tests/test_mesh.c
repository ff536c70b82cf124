/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The mesh as an object: parameters, memory, what is wanted and what is not, the simple model, many threads. */
#include "gearmesh/gearmesh.h"
#include "gm_test.h"
#include "random_gears.h"
#include "reference_gear.h"

#include <pthread.h>

enum { ALL_WANTED = GM_WANT_DERIVATIVES | GM_WANT_WRENCH | GM_WANT_PAIRS | GM_WANT_ENERGY };

static gm_mesh_params good_params(int model) {
    gm_mesh_params params;
    gm_mesh_params_default(&params);
    params.model = model;
    params.stiffness = REFERENCE_STIFFNESS;
    params.damping = REFERENCE_DAMPING;
    return params;
}

static gm_mesh *make_mesh(plain_mesh *room, const gm_mesh_params *params, const gm_pair *pair,
                          const gm_flanks *pinion, const gm_flanks *wheel) {
    gm_mesh *mesh;
    GM_ASSERT_INT(gm_mesh_init(&mesh, params, pair, pinion, wheel, room->memory, sizeof *room),
                  GM_OK);
    return mesh;
}

static int same_bits(const void *a, const void *b, size_t size) {
    return memcmp(a, b, size) == 0;
}

/* A random case in which both gears have flanks of their own, and contact on at least one side. */
static void case_in_contact(random_case *c, uint64_t *seed, gm_position *position) {
    for (;;) {
        GM_ASSERT_INT(random_case_make(c, seed, 1), GM_OK);
        const gm_state state = {c->pinion_angle, c->wheel_angle,
                                gm_test_uniform(seed, -0.01, 0.01) * c->params.normal_module /
                                    c->pair.pinion.base_radius,
                                0.0};
        gm_mesh_result r;
        GM_ASSERT_INT(gm_position_from_state(&c->pair, &state, position), GM_OK);
        GM_ASSERT_INT(
            plain_evaluate(&c->pair, c->use[0], c->use[1], position, 1e8, 0.0, GM_WANT_FORCE, &r),
            GM_OK);
        if (c->use[0] != NULL && c->use[1] != NULL && r.drive_force + r.coast_force > 0.0) {
            return;
        }
        random_case_free(c);
    }
}

/* ---------------------------------------------------------------------------------------------
 * Parameters
 * ------------------------------------------------------------------------------------------- */

static void nothing_but_the_stiffness_is_required(void) {
    gm_mesh_params params;
    memset(&params, 0x5A, sizeof params);
    gm_mesh_params_default(&params);
    GM_ASSERT_INT(params.model, GM_MODEL_3D);
    GM_ASSERT_INT(params.law, GM_LAW_CONSTANT);
    GM_ASSERT_NAN(params.stiffness);
    GM_ASSERT_ABS(params.damping, 0.0, 0.0);
    GM_ASSERT_NAN(params.simple_stiffness);
    gm_mesh_params_default(NULL);

    const char *field = "", *requirement = "";
    GM_ASSERT_INT(gm_mesh_params_check(&params, &field, &requirement), GM_ERR_PARAMETER);
    GM_ASSERT_STRING(field, "stiffness");
    params.stiffness = 1e8;
    GM_ASSERT_INT(gm_mesh_params_check(&params, &field, &requirement), GM_OK);
    GM_ASSERT(field == NULL && requirement == NULL);
}

static void a_field_at_fault_is_named(void) {
    static const char stiffness[] = "a stiffness from 1e-30 to 1e30 N/m";
    static const char damping[] = "a damping from 0 to 1e30 N s/m";
    static const char model[] = "GM_MODEL_3D or GM_MODEL_SIMPLE";
    static const struct {
        const char *field, *requirement;
        double value;
    } wrong[] = {
        {"model", model, -1},
        {"model", model, 2},
        {"law", "GM_LAW_CONSTANT, GM_LAW_ISO6336 or GM_LAW_ELASTIC", -1},
        {"law", "GM_LAW_CONSTANT, GM_LAW_ISO6336 or GM_LAW_ELASTIC", 3},
        {"stiffness", stiffness, 0.0},
        {"stiffness", stiffness, -1e8},
        {"stiffness", stiffness, 0.99e-30},
        {"stiffness", stiffness, 1.01e30},
        {"stiffness", stiffness, HUGE_VAL},
        {"stiffness", stiffness, NAN},
        {"damping", damping, -1e-300},
        {"damping", damping, 1.01e30},
        {"damping", damping, HUGE_VAL},
        {"damping", damping, NAN},
        {"simple_stiffness", stiffness, 0.0},
        {"simple_stiffness", stiffness, 0.99e-30},
        {"simple_stiffness", stiffness, 1.01e30},
        {"simple_stiffness", stiffness, HUGE_VAL},
        {"simple_stiffness", stiffness, -HUGE_VAL},
    };

    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; ++i) {
        gm_test_context("%s = %g", wrong[i].field, wrong[i].value);
        gm_mesh_params params = good_params(GM_MODEL_SIMPLE);
        if (strcmp(wrong[i].field, "model") == 0) {
            params.model = (int)wrong[i].value;
        } else if (strcmp(wrong[i].field, "law") == 0) {
            params.law = (int)wrong[i].value;
        } else if (strcmp(wrong[i].field, "stiffness") == 0) {
            params.stiffness = wrong[i].value;
        } else if (strcmp(wrong[i].field, "damping") == 0) {
            params.damping = wrong[i].value;
        } else {
            params.simple_stiffness = wrong[i].value;
        }

        const char *field = NULL, *requirement = NULL;
        GM_ASSERT_INT(gm_mesh_params_check(&params, &field, &requirement), GM_ERR_PARAMETER);
        GM_ASSERT_STRING(field, wrong[i].field);
        GM_ASSERT_STRING(requirement, wrong[i].requirement);
        GM_ASSERT_INT(gm_mesh_params_check(&params, NULL, NULL), GM_ERR_PARAMETER);

        plain_mesh room;
        gm_mesh *mesh = (gm_mesh *)(void *)&room;
        GM_ASSERT(gm_mesh_size(&params, &pair) == 0);
        GM_ASSERT_INT(gm_mesh_init(&mesh, &params, &pair, NULL, NULL, &room, sizeof room),
                      GM_ERR_PARAMETER);
        GM_ASSERT(mesh == NULL);
    }
    GM_ASSERT_INT(gm_mesh_params_check(NULL, NULL, NULL), GM_ERR_NULL);
    const char *field = "", *requirement = "";
    GM_ASSERT_INT(gm_mesh_params_check(NULL, &field, &requirement), GM_ERR_NULL);
    GM_ASSERT(field == NULL && requirement == NULL);
}

static void the_bounds_themselves_are_taken(void) {
    static const double stiffness[] = {1e-30, 1e30};
    static const double damping[] = {0.0, 1e30};
    for (int i = 0; i < 8; ++i) {
        gm_test_context("bounds %d", i);
        gm_mesh_params params = good_params(GM_MODEL_SIMPLE);
        params.stiffness = stiffness[i & 1];
        params.damping = damping[i >> 1 & 1];
        params.simple_stiffness = stiffness[i >> 2 & 1];
        GM_ASSERT_INT(gm_mesh_params_check(&params, NULL, NULL), GM_OK);
    }
}

/* ---------------------------------------------------------------------------------------------
 * Memory
 * ------------------------------------------------------------------------------------------- */

static void memory_is_used_up_to_its_size_and_no_further(void) {
    enum { GUARD = 64 };
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const gm_mesh_params params = good_params(GM_MODEL_3D);
    const size_t size = gm_mesh_size(&params, &pair);
    GM_ASSERT(size > sizeof pair); /* it holds a copy */
    unsigned char *memory = malloc(size + GUARD);
    memset(memory, 0xA5, size + GUARD);
    gm_mesh *mesh = (gm_mesh *)(void *)memory;
    GM_ASSERT_INT(gm_mesh_init(&mesh, &params, &pair, NULL, NULL, memory, size - 1), GM_ERR_MEMORY);
    GM_ASSERT(mesh == NULL);
    GM_ASSERT_INT(gm_mesh_init(&mesh, &params, &pair, NULL, NULL, memory, 0), GM_ERR_MEMORY);
    GM_ASSERT_INT(gm_mesh_init(&mesh, &params, &pair, NULL, NULL, memory + 1, size + 8),
                  GM_ERR_MEMORY);
    for (size_t i = 0; i < size + GUARD; ++i) {
        if (memory[i] != 0xA5) {
            GM_ASSERT(!"memory that was refused has been written to");
            break;
        }
    }

    GM_ASSERT_INT(gm_mesh_init(&mesh, &params, &pair, NULL, NULL, memory, size), GM_OK);
    GM_ASSERT((void *)mesh == (void *)memory);
    const gm_state state = {.pinion_angle = 0.1, .wheel_angle = 0.1097};
    gm_mesh_result result;
    GM_ASSERT_INT(gm_mesh_evaluate(mesh, &state, ALL_WANTED, NULL, &result), GM_OK);
    for (size_t i = size; i < size + GUARD; ++i) {
        GM_ASSERT_INT(memory[i], 0xA5);
    }
    free(memory);
}

/* The mesh keeps its pair: the caller's may go. */
static void the_pair_is_copied(void) {
    const gm_mesh_params params = good_params(GM_MODEL_3D);
    gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const gm_pair kept = pair;
    plain_mesh room;
    const gm_mesh *mesh = make_mesh(&room, &params, &pair, NULL, NULL);
    const gm_position position = {.phase = 1e-3, .offset = 55e-6};
    gm_mesh_result before, after;
    GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, ALL_WANTED, NULL, &before), GM_OK);
    memset(&pair, 0, sizeof pair);
    GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, ALL_WANTED, NULL, &after), GM_OK);
    GM_ASSERT(before.force != 0.0);
    GM_ASSERT(same_bits(&before, &after, sizeof before));
    GM_ASSERT(same_bits(gm_mesh_pair(mesh), &kept, sizeof kept));
    GM_ASSERT(gm_mesh_pair(NULL) == NULL);
}

static void what_is_no_pair_or_does_not_belong_to_it_is_refused(void) {
    const gm_mesh_params params = good_params(GM_MODEL_3D);
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    plain_mesh room;
    gm_mesh *mesh;
    gm_pair none;
    memset(&none, 0, sizeof none);
    GM_ASSERT(gm_mesh_size(&params, &none) == 0);
    GM_ASSERT_INT(gm_mesh_init(&mesh, &params, &none, NULL, NULL, &room, sizeof room),
                  GM_ERR_GEOMETRY);

    /* What gm_pair_init() leaves of a pair that it refuses. */
    gm_pair_params drawing = reference_params(REFERENCE_FACE_WIDTH);
    drawing.center_distance = 70e-3;
    GM_ASSERT(gm_pair_init(&none, &drawing) != GM_OK);
    GM_ASSERT_INT(gm_mesh_init(&mesh, &params, &none, NULL, NULL, &room, sizeof room),
                  GM_ERR_GEOMETRY);
    for (int field = 0; field < 3; ++field) {
        gm_test_context("field %d", field);
        none = pair;
        *(field == 0 ? &none.pinion.teeth : &none.wheel.teeth) = field == 2 ? 41 : 0;
        none.transverse_base_pitch = field == 2 ? (double)NAN : pair.transverse_base_pitch;
        GM_ASSERT_INT(gm_mesh_init(&mesh, &params, &none, NULL, NULL, &room, sizeof room),
                      GM_ERR_GEOMETRY);
    }

    /* Flanks of 44 teeth on the pinion of 45, and on the wheel of 41. */
    static double memory[1024];
    const gm_flanks_params sizes = {.teeth = 44};
    gm_flanks *flanks;
    GM_ASSERT_INT(gm_flanks_init(&flanks, &sizes, memory, sizeof memory), GM_OK);
    GM_ASSERT_INT(gm_mesh_init(&mesh, &params, &pair, flanks, NULL, &room, sizeof room),
                  GM_ERR_TOOTH);
    GM_ASSERT_INT(gm_mesh_init(&mesh, &params, &pair, NULL, flanks, &room, sizeof room),
                  GM_ERR_TOOTH);
    GM_ASSERT(mesh == NULL);
}

static void assert_nan(const gm_mesh_result *r) {
    const double *fields[] = {&r->force,
                              &r->drive_force,
                              &r->coast_force,
                              &r->force_by.pinion_angle,
                              &r->force_by.wheel_angle,
                              &r->force_by.pinion_speed,
                              &r->force_by.wheel_speed,
                              &r->pinion_torque,
                              &r->wheel_torque,
                              &r->pinion_torque_by.pinion_angle,
                              &r->pinion_torque_by.wheel_speed,
                              &r->wheel_torque_by.pinion_angle,
                              &r->wheel_torque_by.wheel_speed,
                              &r->contact.penetration,
                              &r->contact.rate,
                              &r->contact.drive,
                              &r->contact.coast,
                              &r->contact.drive_rate,
                              &r->contact.coast_rate,
                              &r->contact.drive_contact,
                              &r->contact.coast_contact,
                              &r->contact.d_pinion_angle,
                              &r->contact.d_wheel_angle};
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; ++i) {
        GM_ASSERT_NAN(*fields[i]);
    }
    for (int k = 0; k < 3; ++k) {
        GM_ASSERT_NAN(r->wrench.pinion_force[k]);
        GM_ASSERT_NAN(r->wrench.pinion_moment[k]);
        GM_ASSERT_NAN(r->wrench.wheel_force[k]);
        GM_ASSERT_NAN(r->wrench.wheel_moment[k]);
    }
    GM_ASSERT_INT(r->contact.drive_pairs, 0);
    GM_ASSERT_INT(r->contact.coast_pairs, 0);
}

static void null_pointers_are_refused(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const gm_mesh_params params = good_params(GM_MODEL_3D);
    plain_mesh room;
    gm_mesh *mesh = make_mesh(&room, &params, &pair, NULL, NULL);
    gm_mesh *none;
    GM_ASSERT_INT(gm_mesh_init(NULL, &params, &pair, NULL, NULL, &room, sizeof room), GM_ERR_NULL);
    GM_ASSERT_INT(gm_mesh_init(&none, NULL, &pair, NULL, NULL, &room, sizeof room), GM_ERR_NULL);
    GM_ASSERT_INT(gm_mesh_init(&none, &params, NULL, NULL, NULL, &room, sizeof room), GM_ERR_NULL);
    GM_ASSERT_INT(gm_mesh_init(&none, &params, &pair, NULL, NULL, NULL, sizeof room), GM_ERR_NULL);
    GM_ASSERT(none == NULL);
    GM_ASSERT(gm_mesh_size(NULL, &pair) == 0);
    GM_ASSERT(gm_mesh_size(&params, NULL) == 0);
    GM_ASSERT_INT(gm_mesh_use_cache(NULL, NULL), GM_ERR_NULL);
    GM_ASSERT_INT(gm_mesh_use_cache(mesh, NULL), GM_OK);

    const gm_state state = {.pinion_angle = 0.1, .wheel_angle = 0.11};
    const gm_position position = {.phase = 1e-3, .offset = 55e-6};
    gm_mesh_result r;
    GM_ASSERT_INT(gm_mesh_evaluate(mesh, &state, ALL_WANTED, NULL, NULL), GM_ERR_NULL);
    GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, ALL_WANTED, NULL, NULL), GM_ERR_NULL);
    memset(&r, 0, sizeof r);
    GM_ASSERT_INT(gm_mesh_evaluate(NULL, &state, ALL_WANTED, NULL, &r), GM_ERR_NULL);
    assert_nan(&r);
    memset(&r, 0, sizeof r);
    GM_ASSERT_INT(gm_mesh_evaluate(mesh, NULL, ALL_WANTED, NULL, &r), GM_ERR_NULL);
    assert_nan(&r);
    memset(&r, 0, sizeof r);
    GM_ASSERT_INT(gm_mesh_evaluate_at(NULL, &position, ALL_WANTED, NULL, &r), GM_ERR_NULL);
    assert_nan(&r);
    memset(&r, 0, sizeof r);
    GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, NULL, ALL_WANTED, NULL, &r), GM_ERR_NULL);
    assert_nan(&r);
}

/* ---------------------------------------------------------------------------------------------
 * What is wanted
 * ------------------------------------------------------------------------------------------- */

static void only_what_is_known_can_be_wanted(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const gm_mesh_params params = good_params(GM_MODEL_3D);
    plain_mesh room;
    const gm_mesh *mesh = make_mesh(&room, &params, &pair, NULL, NULL);
    const gm_position position = {.phase = 1e-3, .offset = 55e-6};
    static const int bad[] = {ALL_WANTED + 1, -1, 1 << 10, -2147483647};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        gm_test_context("wanted = %d", bad[i]);
        gm_mesh_result r;
        memset(&r, 0, sizeof r);
        GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, bad[i], NULL, &r), GM_ERR_PARAMETER);
        assert_nan(&r);
    }
}

/* Force, and of the rest what is wanted: NaN, or that of the mask that wants this alone. */
static int agrees(const gm_mesh_result *r, int wanted, const gm_mesh_result *of_force,
                  const gm_mesh_result *of_derivatives, const gm_mesh_result *of_wrench) {
    const gm_penetration *c = &r->contact, *f = &of_force->contact;
    const size_t contact_doubles = offsetof(gm_penetration, d_pinion_angle);
    int good = GM_ASSERT(same_bits(&r->force, &of_force->force, 3 * sizeof(double)));
    good &= GM_ASSERT(same_bits(c, f, contact_doubles));
    good &= GM_ASSERT_INT(c->drive_pairs, f->drive_pairs);
    good &= GM_ASSERT_INT(c->coast_pairs, f->coast_pairs);

    const int with_derivatives = (wanted & GM_WANT_DERIVATIVES) != 0;
    const gm_mesh_result *derivatives = with_derivatives ? of_derivatives : of_force;
    good &= GM_ASSERT(same_bits(&r->force_by.pinion_angle, &derivatives->force_by.pinion_angle,
                                4 * sizeof(double)));
    good &= GM_ASSERT(
        same_bits(&c->d_pinion_angle, &derivatives->contact.d_pinion_angle, 2 * sizeof(double)));
    good &= GM_ASSERT_INT(isnan(r->force_by.pinion_angle) != 0, !with_derivatives);
    good &= GM_ASSERT_INT(isnan(r->force_by.wheel_angle) != 0, !with_derivatives);
    good &= GM_ASSERT_INT(isnan(r->force_by.pinion_speed) != 0, !with_derivatives);
    good &= GM_ASSERT_INT(isnan(r->force_by.wheel_speed) != 0, !with_derivatives);
    good &= GM_ASSERT_INT(isnan(c->d_pinion_angle) != 0, !with_derivatives);
    good &= GM_ASSERT_INT(isnan(c->d_wheel_angle) != 0, !with_derivatives);

    const int with_wrench = (wanted & GM_WANT_WRENCH) != 0;
    const gm_mesh_result *wrench = with_wrench ? of_wrench : of_force;
    good &= GM_ASSERT(same_bits(&r->wrench, &wrench->wrench, sizeof r->wrench));
    for (int k = 0; k < 3; ++k) {
        good &= GM_ASSERT_INT(isnan(r->wrench.pinion_force[k]) != 0, !with_wrench);
        good &= GM_ASSERT_INT(isnan(r->wrench.pinion_moment[k]) != 0, !with_wrench);
        good &= GM_ASSERT_INT(isnan(r->wrench.wheel_force[k]) != 0, !with_wrench);
        good &= GM_ASSERT_INT(isnan(r->wrench.wheel_moment[k]) != 0, !with_wrench);
    }
    return good;
}

/* Nothing that is wanted beside it changes what is asked for; what is not asked for is NaN. */
static void what_is_wanted_does_not_change_the_rest(void) {
    uint64_t seed = UINT64_C(91);
    int touching = 0, resting = 0;
    for (int i = 0; i < 400; ++i) {
        random_case c;
        gm_position position;
        gm_test_context("case %d, seed %llx", i, (unsigned long long)seed);
        case_in_contact(&c, &seed, &position);
        if (i % 5 == 0) {
            position.offset_rate = 0.0;
        }
        resting += position.offset_rate == 0.0;
        gm_mesh_params params = good_params(i % 4 == 3 ? GM_MODEL_SIMPLE : GM_MODEL_3D);
        params.damping = i % 3 == 0 ? 0.0 : 1e3;
        plain_mesh room;
        const gm_mesh *mesh =
            make_mesh(&room, &params, &c.pair, i % 7 == 1 ? NULL : c.use[0], c.use[1]);

        gm_mesh_result alone[4], r;
        for (int wanted = 0; wanted <= 2; ++wanted) {
            GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, wanted, NULL, &alone[wanted]),
                          GM_OK);
        }
        touching += alone[0].force != 0.0;
        int good = 1;
        for (int wanted = 0; wanted <= ALL_WANTED; ++wanted) {
            gm_test_context("case %d, wanted %d", i, wanted);
            memset(&r, 0, sizeof r);
            good &= GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, wanted, NULL, &r), GM_OK);
            good &=
                agrees(&r, wanted, &alone[0], &alone[GM_WANT_DERIVATIVES], &alone[GM_WANT_WRENCH]);
        }
        random_case_free(&c);
        if (!good) {
            return;
        }
    }
    gm_test_context("all cases");
    GM_ASSERT(touching > 300);
    GM_ASSERT(resting > 50);
}

/*
 * Pairs counted alone are those of the whole evaluation, for all kinds of flanks and whatever of a line touches: most depths
 * are a small part of the deviations, where many lines touch in a short part or not at all.
 */
static void pairs_alone_are_those_of_an_evaluation(void) {
    uint64_t seed = UINT64_C(93);
    int count[4] = {0, 0, 0, 0};
    for (int i = 0; i < 600; ++i) {
        random_case c;
        gm_test_context("case %d, seed %llx", i, (unsigned long long)seed);
        GM_ASSERT_INT(random_mixed_case_make(&c, &seed, i), GM_OK);
        gm_mesh_params params = good_params(i % 11 == 7 ? GM_MODEL_SIMPLE : GM_MODEL_3D);
        params.friction_coefficient = i % 4 == 1 ? 0.06 : 0.0;
        params.pose.axial_shift = i % 9 == 2 ? 1e-3 * c.pair.face_width : 0.0;
        plain_mesh room;
        const gm_mesh *mesh = make_mesh(&room, &params, &c.pair, c.use[0], c.use[1]);
        for (int k = 0; k < 12; ++k) {
            const int side = k % 2;
            const double deep = gm_test_uniform(&seed, 0.0, k % 3 == 0 ? 6.0 : 1.5) * c.amplitude;
            const double offset = gm_mesh_clearance(mesh, side) + deep;
            gm_position position;
            gm_mesh_result r;
            int pairs[2] = {-1, -1};
            GM_ASSERT_INT(gm_position_from_pinion_angle(&c.pair, gm_test_uniform(&seed, 0.0, 7.0),
                                                        side == GM_DRIVE ? offset : -offset, 0.0,
                                                        &position),
                          GM_OK);
            GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, GM_WANT_FORCE, NULL, &r), GM_OK);
            GM_ASSERT_INT(gm_mesh_pairs_at(mesh, &position, NULL, pairs), GM_OK);
            GM_ASSERT_INT(pairs[GM_DRIVE], r.contact.drive_pairs);
            GM_ASSERT_INT(pairs[GM_COAST], r.contact.coast_pairs);
            const int touching = pairs[GM_DRIVE] + pairs[GM_COAST];
            ++count[touching < 3 ? touching : 3];
        }
        random_case_free(&c);
    }
    gm_test_context("all cases");
    for (int touching = 0; touching < 4; ++touching) {
        GM_ASSERT(count[touching] > 100);
    }
}

static void pairs_of_no_position_are_refused(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const gm_mesh_params params = good_params(GM_MODEL_3D);
    plain_mesh room;
    const gm_mesh *mesh = make_mesh(&room, &params, &pair, NULL, NULL);
    const gm_position good = {.phase = 1e-3, .offset = 55e-6}, bad = {.phase = (double)NAN};
    int pairs[2] = {7, 7};
    GM_ASSERT_INT(gm_mesh_pairs_at(mesh, &good, NULL, NULL), GM_ERR_NULL);
    GM_ASSERT_INT(gm_mesh_pairs_at(NULL, &good, NULL, pairs), GM_ERR_NULL);
    GM_ASSERT_INT(pairs[GM_DRIVE] + pairs[GM_COAST], 0);
    GM_ASSERT_INT(gm_mesh_pairs_at(mesh, NULL, NULL, pairs), GM_ERR_NULL);
    pairs[GM_DRIVE] = 7;
    GM_ASSERT_INT(gm_mesh_pairs_at(mesh, &bad, NULL, pairs), GM_STATE_NOT_FINITE);
    GM_ASSERT_INT(pairs[GM_DRIVE], 0);
}

static void state_and_position_give_the_same_bits(void) {
    uint64_t seed = UINT64_C(92);
    for (int i = 0; i < 100; ++i) {
        random_case c;
        gm_test_context("case %d", i);
        GM_ASSERT_INT(random_case_make(&c, &seed, 1), GM_OK);
        const gm_mesh_params params = good_params(i % 3 == 0 ? GM_MODEL_SIMPLE : GM_MODEL_3D);
        plain_mesh room;
        const gm_mesh *mesh = make_mesh(&room, &params, &c.pair, c.use[0], c.use[1]);
        const gm_state state = {c.pinion_angle, c.wheel_angle, 0.03, 0.02};
        gm_position position;
        gm_mesh_result by_state, by_position;
        GM_ASSERT_INT(gm_position_from_state(&c.pair, &state, &position), GM_OK);
        GM_ASSERT_INT(gm_mesh_evaluate(mesh, &state, ALL_WANTED, NULL, &by_state), GM_OK);
        GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, ALL_WANTED, NULL, &by_position), GM_OK);
        GM_ASSERT(same_bits(&by_state, &by_position, sizeof by_state));
        random_case_free(&c);
    }
}

/* What a solver may reach on a bad step is a status > 0; the simple model has no teeth to skip. */
static void states_out_of_range_leave_nan(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH);
    const double half_pitch = 0.5 * pair.transverse_base_pitch;
    for (int model = GM_MODEL_3D; model <= GM_MODEL_SIMPLE; ++model) {
        const gm_mesh_params params = good_params(model);
        plain_mesh room;
        const gm_mesh *mesh = make_mesh(&room, &params, &pair, NULL, NULL);
        const struct {
            gm_position position;
            int status_3d, status_simple;
        } cases[] = {
            {{0, 0, 1e-3, NAN, 0.0, 0.0}, GM_STATE_NOT_FINITE, GM_STATE_NOT_FINITE},
            {{0, 0, 1e-3, 0.0, HUGE_VAL, 0.0}, GM_STATE_NOT_FINITE, GM_STATE_NOT_FINITE},
            {{0, 0, 1e-3, 0.0, 1.01e9, 0.0}, GM_STATE_OUT_OF_RANGE, GM_STATE_OUT_OF_RANGE},
            {{0, 0, 1e-3, half_pitch, 0.0, 0.0}, GM_STATE_OUT_OF_RANGE, GM_OK},
            {{0, 0, 1e-3, -1e18, 0.0, 0.0}, GM_STATE_OUT_OF_RANGE, GM_OK},
            {{0, 0, 1e-3, -1.01e18, 0.0, 0.0}, GM_STATE_OUT_OF_RANGE, GM_STATE_OUT_OF_RANGE},
            {{45, 0, 1e-3, 0.0, 0.0, 0.0}, GM_ERR_TOOTH, GM_OK},
            {{0, -1, 1e-3, 0.0, 0.0, 0.0}, GM_ERR_TOOTH, GM_OK},
            {{44, 40, 1e-3, 0.0, -1e9, 0.0}, GM_OK, GM_OK},
        };
        for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
            gm_test_context("model %d, case %zu", model, i);
            const int status = model == GM_MODEL_3D ? cases[i].status_3d : cases[i].status_simple;
            gm_mesh_result r;
            memset(&r, 0, sizeof r);
            GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &cases[i].position, ALL_WANTED, NULL, &r),
                          status);
            if (status != GM_OK) {
                assert_nan(&r);
            } else {
                GM_ASSERT(isfinite(r.force) && isfinite(r.wrench.wheel_moment[1]));
            }
        }
    }
}

/* ---------------------------------------------------------------------------------------------
 * What a mesh tells of itself
 * ------------------------------------------------------------------------------------------- */

/* Up to the clearance of a side nothing touches; ideal flanks touch right behind it. */
static void clearance_ends_where_flanks_touch(void) {
    const gm_pair pair = reference_pair(REFERENCE_FACE_WIDTH); /* 50 um to either side */
    const gm_mesh_params params = good_params(GM_MODEL_3D);
    static double memory[2][1024];
    gm_flanks *flanks[2];
    for (int gear = 0; gear < 2; ++gear) {
        const gm_flanks_params sizes = {.teeth = gear == 0 ? 45 : 41};
        GM_ASSERT_INT(gm_flanks_init(&flanks[gear], &sizes, memory[gear], sizeof memory[gear]),
                      GM_OK);
    }
    /* All teeth alike, so that the highest one is always in mesh. */
    GM_ASSERT_INT(gm_flanks_set_pitch(flanks[0], GM_DRIVE, GM_ALL_TEETH, 3e-6), GM_OK);
    GM_ASSERT_INT(gm_flanks_set_pitch(flanks[1], GM_DRIVE, GM_ALL_TEETH, 4e-6), GM_OK);
    GM_ASSERT_INT(gm_flanks_set_pitch(flanks[1], GM_COAST, GM_ALL_TEETH, -10e-6), GM_OK);
    plain_mesh room, ideal_room;
    const gm_mesh *mesh = make_mesh(&room, &params, &pair, flanks[0], flanks[1]);
    const gm_mesh *ideal = make_mesh(&ideal_room, &params, &pair, NULL, NULL);
    GM_ASSERT_ABS(gm_mesh_clearance(mesh, GM_DRIVE), 43e-6, 1e-19);
    GM_ASSERT_ABS(gm_mesh_clearance(mesh, GM_COAST), 60e-6, 1e-19);
    GM_ASSERT_ABS(gm_mesh_clearance(ideal, GM_DRIVE), 50e-6, 1e-19);
    GM_ASSERT_ABS(gm_mesh_clearance(ideal, GM_COAST), 50e-6, 1e-19);
    GM_ASSERT_NAN(gm_mesh_clearance(mesh, 2));
    GM_ASSERT_NAN(gm_mesh_clearance(mesh, -1));
    GM_ASSERT_NAN(gm_mesh_clearance(NULL, GM_DRIVE));

    for (int i = 0; i < 20; ++i) {
        gm_test_context("position %d", i);
        gm_position position;
        gm_mesh_result r;
        const int side = i % 2;
        const double clearance = gm_mesh_clearance(mesh, side);
        const double direction = side == GM_DRIVE ? 1.0 : -1.0;
        GM_ASSERT_INT(gm_position_from_pinion_angle(&pair, 0.03 * i, 0.0, 0.0, &position), GM_OK);
        position.offset = direction * (clearance - 1e-15);
        GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, GM_WANT_FORCE, NULL, &r), GM_OK);
        GM_ASSERT_ABS(r.force, 0.0, 0.0);
        GM_ASSERT_INT(r.contact.drive_pairs + r.contact.coast_pairs, 0);
        position.offset = direction * (clearance + 1e-15);
        GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, GM_WANT_FORCE, NULL, &r), GM_OK);
        GM_ASSERT(direction * r.force > 0.0);
    }
}

static void stiffness_of_what_touches_counts_faces(void) {
    gm_pair_params drawing = reference_params(REFERENCE_FACE_WIDTH);
    drawing.backlash = -20e-6; /* both sides touch */
    const gm_pair pair = make_pair(&drawing);
    const gm_mesh_params params = good_params(GM_MODEL_3D);
    plain_mesh room;
    const gm_mesh *mesh = make_mesh(&room, &params, &pair, NULL, NULL);
    const gm_position position = {.phase = 1e-3, .offset = 2e-6};
    gm_mesh_result r;
    GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, GM_WANT_FORCE, NULL, &r), GM_OK);
    GM_ASSERT(r.contact.drive_contact > 1.0 && r.contact.coast_contact > 1.0);
    GM_ASSERT_REL(gm_mesh_touching_stiffness(mesh, &r),
                  REFERENCE_STIFFNESS * (r.contact.drive_contact + r.contact.coast_contact), 4e-16);
    GM_ASSERT_NAN(gm_mesh_touching_stiffness(NULL, &r));
    GM_ASSERT_NAN(gm_mesh_touching_stiffness(mesh, NULL));
}

/* ---------------------------------------------------------------------------------------------
 * The simple model
 * ------------------------------------------------------------------------------------------- */

static void simple_model_is_one_spring_and_damper(void) {
    static const double springs[] = {NAN, 3e8};
    static const double backlashes[] = {100e-6, -20e-6};
    for (int i = 0; i < 4; ++i) {
        gm_pair_params drawing = reference_params(REFERENCE_FACE_WIDTH);
        drawing.backlash = backlashes[i / 2];
        const gm_pair pair = make_pair(&drawing);
        gm_mesh_params params = good_params(GM_MODEL_SIMPLE);
        params.simple_stiffness = springs[i % 2];
        plain_mesh room;
        const gm_mesh *mesh = make_mesh(&room, &params, &pair, NULL, NULL);

        /* As stiff as the contact ratio makes it, or as given. */
        const double eps_alpha = pair.transverse_contact_ratio;
        const double k = i % 2 == 0 ? REFERENCE_STIFFNESS * eps_alpha : 3e8;
        const double d = REFERENCE_DAMPING * eps_alpha;
        GM_ASSERT_REL(gm_mesh_mean_stiffness(mesh), k, 1e-15);
        GM_ASSERT_REL(gm_mesh_mean_damping(mesh), d, 1e-15);

        for (int step = -12; step <= 12; ++step) {
            gm_test_context("case %d, step %d", i, step);
            gm_state state = {.pinion_angle = 0.1, .pinion_speed = 0.01 * (step % 5)};
            state.wheel_angle =
                (pair.pinion.base_radius * 0.1 - 7e-6 * step) / pair.wheel.base_radius;
            gm_penetration p;
            gm_mesh_result r;
            GM_ASSERT_INT(gm_penetration_simple(&pair, &state, &p), GM_OK);
            GM_ASSERT_INT(gm_mesh_evaluate(mesh, &state, GM_WANT_DERIVATIVES, NULL, &r), GM_OK);
            GM_ASSERT(same_bits(&r.contact, &p, sizeof p));

            const double drive = fmax(0.0, k * p.drive + d * p.drive_rate);
            const double coast = fmax(0.0, k * p.coast + d * p.coast_rate);
            GM_ASSERT_REL(r.drive_force, drive, 1e-14);
            GM_ASSERT_REL(r.coast_force, coast, 1e-14);
            const double sides = (drive > 0.0) + (coast > 0.0);
            GM_ASSERT_REL(r.force_by.pinion_angle, k * sides * pair.pinion.base_radius, 1e-14);
            GM_ASSERT_REL(r.force_by.wheel_angle, -k * sides * pair.wheel.base_radius, 1e-14);
            GM_ASSERT_REL(r.force_by.pinion_speed, d * sides * pair.pinion.base_radius, 1e-14);
            GM_ASSERT_REL(r.force_by.wheel_speed, -d * sides * pair.wheel.base_radius, 1e-14);

            /* The torques act at the base radii. */
            GM_ASSERT_REL(r.pinion_torque, r.force * pair.pinion.base_radius, 1e-15);
            GM_ASSERT_REL(r.wheel_torque, r.force * pair.wheel.base_radius, 1e-15);
            GM_ASSERT_REL(r.pinion_torque_by.wheel_angle,
                          r.force_by.wheel_angle * pair.pinion.base_radius, 1e-15);
            GM_ASSERT_REL(r.wheel_torque_by.pinion_speed,
                          r.force_by.pinion_speed * pair.wheel.base_radius, 1e-15);
        }
    }
}

static void simple_model_knows_no_flanks(void) {
    uint64_t seed = UINT64_C(93);
    const gm_mesh_params params = good_params(GM_MODEL_SIMPLE);
    for (int i = 0; i < 20; ++i) {
        random_case c;
        gm_position position;
        gm_test_context("case %d", i);
        case_in_contact(&c, &seed, &position);
        position.offset += position.offset > 0.0 ? c.pair.backlash : -c.pair.backlash;
        plain_mesh room, ideal_room;
        const gm_mesh *mesh = make_mesh(&room, &params, &c.pair, c.use[0], c.use[1]);
        const gm_mesh *ideal = make_mesh(&ideal_room, &params, &c.pair, NULL, NULL);
        gm_mesh_result got, expected;
        GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, ALL_WANTED, NULL, &got), GM_OK);
        GM_ASSERT_INT(gm_mesh_evaluate_at(ideal, &position, ALL_WANTED, NULL, &expected), GM_OK);
        GM_ASSERT(same_bits(&got, &expected, sizeof got));
        GM_ASSERT_REL(gm_mesh_clearance(mesh, GM_COAST), 0.5 * c.pair.backlash, 0.0);
        random_case_free(&c);
    }
}

/* F along the normal of the flanks, through the point where both pitch circles meet, in the middle of the face. */
static void simple_model_pushes_in_the_pitch_point(void) {
    gm_pair_params drawing = reference_params((double)NAN);
    drawing.wheel_face_width = 20e-3;
    drawing.pinion_face_width = 26e-3; /* the common face is 3 to 23 mm from the pinion's end */
    const gm_pair pair = make_pair(&drawing);
    const gm_mesh_params params = good_params(GM_MODEL_SIMPLE);
    plain_mesh room;
    const gm_mesh *mesh = make_mesh(&room, &params, &pair, NULL, NULL);

    /* The pitch point at mid-face. */
    const double alpha = pair.working_pressure_angle;
    const double z = 13e-3;
    const double to_pinion = pair.pinion.base_radius / cos(alpha);
    const double to_wheel = pair.wheel.base_radius / cos(alpha);
    GM_ASSERT_REL(to_pinion + to_wheel, pair.center_distance, 1e-14);

    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        gm_test_context("side %d", side);
        const double sign = side == GM_DRIVE ? 1.0 : -1.0;
        const gm_position position = {0, 0, 1e-3, sign * 60e-6, 0.0, 0.0};
        gm_mesh_result r;
        GM_ASSERT_INT(gm_mesh_evaluate_at(mesh, &position, GM_WANT_WRENCH, NULL, &r), GM_OK);

        const double f = fabs(r.force);
        const double on_wheel[3] = {f * sin(alpha), sign * f * cos(alpha),
                                    -sign * f * tan(pair.base_helix_angle)};
        GM_ASSERT(f > 1000.0);

        /* Moment of a force at (x, 0, z): (-z f_y, z f_x - x f_z, x f_y), x from each gear's own axis. */
        const double x[2] = {to_pinion, -to_wheel};
        for (int gear = 0; gear < 2; ++gear) {
            const double s = gear == GM_PINION ? -1.0 : 1.0;
            const double *force = gear == 0 ? r.wrench.pinion_force : r.wrench.wheel_force;
            const double *moment = gear == 0 ? r.wrench.pinion_moment : r.wrench.wheel_moment;
            const double expected[3] = {-s * z * on_wheel[1],
                                        s * (z * on_wheel[0] - x[gear] * on_wheel[2]),
                                        s * x[gear] * on_wheel[1]};
            for (int k = 0; k < 3; ++k) {
                GM_ASSERT_ABS(force[k], s * on_wheel[k], 1e-13 * f);
                GM_ASSERT_ABS(moment[k], expected[k], 1e-13 * f * pair.center_distance);
            }
        }
    }
}

/*
 * The spring with backlash in closed form, c = T / (K r_bw): x = j / 2 + c. With negative backlash both flanks press up to
 * |x| = -j / 2, together with 2 K: x = c / 2 there, beyond it as above.
 */
static void simple_equilibrium_is_closed(void) {
    static const double backlashes[] = {100e-6, 0.0, -20e-6};
    for (int i = 0; i < 3; ++i) {
        gm_pair_params drawing = reference_params(REFERENCE_FACE_WIDTH);
        drawing.backlash = backlashes[i];
        const gm_pair pair = make_pair(&drawing);
        const gm_mesh_params params = good_params(GM_MODEL_SIMPLE);
        plain_mesh room;
        const gm_mesh *mesh = make_mesh(&room, &params, &pair, NULL, NULL);
        const double j = pair.backlash;
        const double r_bw = pair.wheel.base_radius;
        const double k = REFERENCE_STIFFNESS * pair.transverse_contact_ratio;
        for (int load = -6; load <= 6; ++load) {
            gm_test_context("backlash %g, load %d", backlashes[i], load);
            const double c =
                6e-6 * abs(load); /* -j = 20 um lies between the third and the fourth */
            const double torque = (load < 0 ? -1.0 : 1.0) * c * k * r_bw;
            double x = 0.0;
            gm_mesh_result r;
            const int status = gm_static_equilibrium(mesh, 0.3, torque, (double)NAN, NULL, &x, &r);
            if (load == 0 && i < 2) {
                GM_ASSERT_INT(status, GM_UNDETERMINED);
                GM_ASSERT_NAN(x);
                assert_nan(&r);
                continue;
            }
            const double expected = c < -j ? 0.5 * c : 0.5 * j + c;
            GM_ASSERT_INT(status, GM_OK);
            GM_ASSERT_ABS(x, load < 0 ? -expected : expected, 1e-19);
            GM_ASSERT_ABS(r.force * r_bw, torque, 1e-12 * fabs(torque) + 1e-9);
        }
    }
}

/* ---------------------------------------------------------------------------------------------
 * Threads
 * ------------------------------------------------------------------------------------------- */

enum { THREADS = 4, EVALUATIONS = 1000 };

typedef struct worker {
    const gm_mesh *mesh;
    gm_mesh_result results[EVALUATIONS];
    double equilibrium;
    int failures;
} worker;

static void *work(void *argument) {
    worker *w = argument;
    const gm_pair *pair = gm_mesh_pair(w->mesh);
    for (int i = 0; i < EVALUATIONS; ++i) {
        gm_position position;
        const double x = (i % 2 == 0 ? 1.0 : -1.0) * (pair->backlash / 2 + 1e-9 * i);
        w->failures += gm_position_from_pinion_angle(pair, 0.01 * i - 5.0, x, 0.1, &position) != 0;
        w->failures +=
            gm_mesh_evaluate_at(w->mesh, &position, ALL_WANTED, NULL, &w->results[i]) != GM_OK;
    }
    w->failures += gm_static_equilibrium(w->mesh, 0.1, 20.0, (double)NAN, NULL, &w->equilibrium,
                                         NULL) != GM_OK;
    return NULL;
}

static void threads_share_one_mesh(void) {
    static worker workers[THREADS];
    uint64_t seed = UINT64_C(94);
    random_case c;
    gm_position position;

    /* A case with a helix, whose contact is worth a comparison. */
    for (;;) {
        case_in_contact(&c, &seed, &position);
        if (fabs(c.params.helix_angle) > 0.1 && c.params.normal_module > 1e-3) {
            break;
        }
        random_case_free(&c);
    }

    const gm_mesh_params params = good_params(GM_MODEL_3D);
    plain_mesh room;
    const gm_mesh *mesh = make_mesh(&room, &params, &c.pair, c.use[0], c.use[1]);
    const plain_mesh before = room;

    memset(workers, 0, sizeof workers);
    pthread_t threads[THREADS];
    for (int t = 0; t < THREADS; ++t) {
        workers[t].mesh = mesh;
        GM_ASSERT_INT(pthread_create(&threads[t], NULL, work, &workers[t]), 0);
    }
    for (int t = 0; t < THREADS; ++t) {
        GM_ASSERT_INT(pthread_join(threads[t], NULL), 0);
    }

    int touching = 0;
    for (int i = 0; i < EVALUATIONS; ++i) {
        touching += workers[0].results[i].force != 0.0;
    }
    GM_ASSERT(touching > EVALUATIONS / 4);
    for (int t = 0; t < THREADS; ++t) {
        gm_test_context("thread %d", t);
        GM_ASSERT_INT(workers[t].failures, 0);
        GM_ASSERT(same_bits(workers[t].results, workers[0].results, sizeof workers[0].results));
        GM_ASSERT_REL(workers[t].equilibrium, workers[0].equilibrium, 0.0);
    }
    GM_ASSERT(same_bits(&room, &before, gm_mesh_size(&params, &c.pair))); /* nothing was written */
    random_case_free(&c);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(nothing_but_the_stiffness_is_required),
        GM_TEST(a_field_at_fault_is_named),
        GM_TEST(the_bounds_themselves_are_taken),
        GM_TEST(memory_is_used_up_to_its_size_and_no_further),
        GM_TEST(the_pair_is_copied),
        GM_TEST(what_is_no_pair_or_does_not_belong_to_it_is_refused),
        GM_TEST(null_pointers_are_refused),
        GM_TEST(only_what_is_known_can_be_wanted),
        GM_TEST(what_is_wanted_does_not_change_the_rest),
        GM_TEST(pairs_alone_are_those_of_an_evaluation),
        GM_TEST(pairs_of_no_position_are_refused),
        GM_TEST(state_and_position_give_the_same_bits),
        GM_TEST(states_out_of_range_leave_nan),
        GM_TEST(clearance_ends_where_flanks_touch),
        GM_TEST(stiffness_of_what_touches_counts_faces),
        GM_TEST(simple_model_is_one_spring_and_damper),
        GM_TEST(simple_model_knows_no_flanks),
        GM_TEST(simple_model_pushes_in_the_pitch_point),
        GM_TEST(simple_equilibrium_is_closed),
        GM_TEST(threads_share_one_mesh),
    };
    return gm_test_main("unit.mesh", tests, GM_TEST_COUNT(tests), argc, argv);
}
