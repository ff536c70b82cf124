/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Prints the results of some thousand evaluations to the last bit, to be compared with those of another compiler or
 * machine. Trigonometry belongs to libm and may round otherwise there, so the pair's own numbers, which are derived
 * with it, are read from a file that one of the machines has written: from there on only +, -, *, / and sqrt follow.
 *
 *     evaluations FILE --write     writes the pair, and prints
 *     evaluations FILE             reads the pair, and prints
 *     evaluations FILE --plain     the same without vectors of four doubles, even if the processor has them
 *
 * So are elastic teeth, whose tables are made with it: the law of a mesh is replaced by that of the file.
 */
#include "elastic.h"
#include "gearmesh/gearmesh.h"
#include "law.h"
#include "mesh.h"
#include "meshing.h"

#include "elastic_mesh.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FACE_NODES = 9, PROFILE_NODES = 13, OTHER_FACE_NODES = 6, STATES = 700, PAIRS = 4 };
enum { ELASTIC_STATES = 150 };

static const double degree = 0.017453292519943295;
static int is_plain;

static double uniform(uint64_t *seed, double low, double high) {
    *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * ((double)(*seed >> 11) * 0x1p-53);
}

static void stop(const char *what) {
    fprintf(stderr, "evaluations: %s\n", what);
    exit(1);
}

static void check(int status) {
    if (status != GM_OK) {
        stop(gm_status_text(status));
    }
}

static gm_pair make_pair(int number) {
    static const double helix[PAIRS] = {33.0, -33.0, 8.0, 0.0};
    gm_pair_params params;
    gm_pair pair;
    gm_pair_params_default(&params);
    params.pinion_teeth = 45;
    params.wheel_teeth = 41;
    params.normal_module = 1.65e-3;
    params.normal_pressure_angle = 16.0 * degree;
    params.helix_angle = helix[number] * degree;
    params.center_distance = number < 2 ? 85e-3 : 72e-3;
    params.face_width = 17.5e-3;
    params.backlash = number == 1 ? -4e-6 : 100e-6; /* both sides touch, or one */
    check(gm_pair_init(&pair, &params));
    return pair;
}

/* Memory of the whole run: freed at its end. */
enum { BLOCKS = 64 };
static void *blocks[BLOCKS];
static int block_count;

static void *block(size_t size) {
    void *memory = block_count < BLOCKS ? malloc(size) : NULL;
    if (memory == NULL) {
        stop("no memory");
    }
    blocks[block_count++] = memory;
    return memory;
}

/* Tables and pitch of all teeth; the same numbers for the same seed. */
static gm_flanks *make_flanks(int teeth, int coast_face_nodes, uint64_t *seed) {
    const gm_flanks_params sizes = {
        teeth, teeth, FACE_NODES, PROFILE_NODES, teeth, coast_face_nodes, PROFILE_NODES};
    const size_t size = gm_flanks_size(&sizes);
    double values[FACE_NODES * PROFILE_NODES];
    gm_flanks *flanks;
    check(gm_flanks_init(&flanks, &sizes, block(size), size));
    for (int tooth = 0; tooth < teeth; ++tooth) {
        for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
            for (int k = 0; k < FACE_NODES * PROFILE_NODES; ++k) {
                values[k] = uniform(seed, -3e-6, 3e-6);
            }
            check(gm_flanks_set_table(flanks, side, tooth, values, 1.125));
            check(gm_flanks_set_pitch(flanks, side, tooth, uniform(seed, -2e-6, 2e-6)));
        }
    }
    return flanks;
}

/* Linear reliefs: an end, a tip and a corner. */
static void add_ramps(gm_flanks *flanks, uint64_t *seed) {
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        const double face = uniform(seed, 5e-6, 20e-6), profile = uniform(seed, 5e-6, 20e-6);
        const gm_flank_ramp ramps[] = {
            {3e-6, -face, 0.0}, {4e-6 - profile, 0.0, profile}, {5e-6, -face, -profile}};
        check(gm_flanks_set_ramps(flanks, side, ramps, 3, 1.125));
    }
}

/* Ideal, tables, tables with ramps: of one gear. */
enum { FORMS = 3 };

static void make_forms(int teeth, int coast_face_nodes, uint64_t *seed, gm_flanks *forms[FORMS]) {
    uint64_t again = *seed;
    forms[0] = NULL;
    forms[1] = make_flanks(teeth, coast_face_nodes, seed);
    forms[2] = make_flanks(teeth, coast_face_nodes, &again);
}

/* Teeth of constant stiffness; or elastic ones, if the stiffness is NaN. */
static gm_mesh *make_mesh(const gm_pair *pair, const gm_flanks *pinion, const gm_flanks *wheel,
                          double stiffness) {
    gm_mesh_params params;
    gm_mesh *mesh;
    gm_mesh_params_default(&params);
    params.stiffness = stiffness;
    params.law = isnan(stiffness) ? GM_LAW_ELASTIC : params.law;
    const size_t size = gm_mesh_size(&params, pair);
    check(gm_mesh_init(&mesh, &params, pair, pinion, wheel, block(size), size));
    for (int side = GM_DRIVE; is_plain && side <= GM_COAST; ++side) {
        mesh->side[side].pinion_grid.is_wide = mesh->side[side].wheel_grid.is_wide = 0;
    }
    return mesh;
}

/* The bits of a number, as small C libraries cannot print %a; a NaN has many. */
static void print_bits(double number) {
    uint64_t bits;
    memcpy(&bits, &number, sizeof bits);
    if (isnan(number)) {
        printf("nan ");
    } else {
        printf("%08lx%08lx ", (unsigned long)(bits >> 32), (unsigned long)(bits & 0xFFFFFFFFu));
    }
}

static void print_result(const gm_penetration *r) {
    const double numbers[] = {r->penetration,   r->rate,           r->drive_contact,
                              r->coast_contact, r->d_pinion_angle, r->d_wheel_angle};
    for (size_t k = 0; k < sizeof numbers / sizeof numbers[0]; ++k) {
        print_bits(numbers[k]);
    }
    printf("%d %d\n", r->drive_pairs, r->coast_pairs);
}

/* What is prepared with libm: of a pair, and of its teeth as elastic ones. */
typedef struct prepared {
    gm_pair pair;
    gmi_engagement engagement;
    gmi_law mean; /* of the mesh: its mean stiffness */
    gmi_elastic law;
    gmi_elastic_tips tips;
    double body_compliance;
} prepared;

static void prepare(int number, prepared *made) {
    made->pair = make_pair(number);
    const gm_mesh *mesh = make_mesh(&made->pair, NULL, NULL, (double)NAN);
    made->engagement = mesh->engagement;
    made->mean = mesh->law;
    made->law = mesh->elastic->law;
    made->tips = mesh->elastic->tips;
    made->body_compliance = mesh->elastic->body_compliance;
}

/* Elastic teeth along a few pitches: the solution before is where the next one begins. */
static void print_elastic(const prepared *given, const gm_flanks *pinion, const gm_flanks *wheel,
                          uint64_t *seed) {
    const gm_pair *pair = &given->pair;
    gm_mesh *mesh = make_mesh(pair, pinion, wheel, (double)NAN);
    gmi_elastic_mesh *elastic = (gmi_elastic_mesh *)(uintptr_t)mesh->elastic;
    mesh->engagement = given->engagement;
    mesh->law = given->mean;
    const int is_wide = elastic->law.is_wide;
    elastic->law = given->law;
    elastic->law.is_wide = is_wide && !is_plain;
    elastic->tips = given->tips;
    elastic->body_compliance = given->body_compliance;
    const size_t size = gm_workspace_size(mesh);
    gm_workspace *workspace;
    check(gm_workspace_init(&workspace, mesh, block(size), size));
    for (int k = 0; k < ELASTIC_STATES; ++k) {
        const double angle = 0.005 * k;
        gm_position position;
        gm_mesh_result r;
        check(gm_position_from_pinion_angle(
            pair, angle, 0.5 * pair->backlash + uniform(seed, 0.0, 9e-6), 0.0, &position));
        check(gm_mesh_evaluate_at(mesh, &position, GM_WANT_DERIVATIVES | GM_WANT_WRENCH, workspace,
                                  &r));
        const double numbers[] = {r.force,
                                  r.pinion_torque,
                                  r.force_by.pinion_angle,
                                  r.force_by.wheel_angle,
                                  r.pinion_torque_by.pinion_angle,
                                  r.wrench.pinion_moment[0],
                                  r.wrench.pinion_moment[1]};
        for (size_t n = 0; n < sizeof numbers / sizeof numbers[0]; ++n) {
            print_bits(numbers[n]);
        }
        printf("\n");
    }
}

static void print_pair(const prepared *given, uint64_t *seed) {
    const gm_pair *pair = &given->pair;
    gm_flanks *pinions[FORMS], *wheels[FORMS];
    const gm_mesh *meshes[FORMS][FORMS];
    make_forms(pair->pinion.teeth, FACE_NODES, seed, pinions);
    make_forms(pair->wheel.teeth, OTHER_FACE_NODES, seed, wheels);
    add_ramps(pinions[2], seed);
    add_ramps(wheels[2], seed);
    for (int p = 0; p < FORMS; ++p) {
        for (int w = 0; w < FORMS; ++w) {
            meshes[p][w] = make_mesh(pair, pinions[p], wheels[w], 1e8);
        }
    }

    for (int k = 0; k < STATES; ++k) {
        const int wheel = k % 7 == 0 ? 0 : k % 3 == 0 ? 2 : 1;
        const int pinion = k % 5 == 0 ? 0 : k % 4 == 0 ? 2 : 1;
        const gm_mesh *mesh = meshes[pinion][wheel];
        const double angle = uniform(seed, -1e4, 1e4);
        const double offset = 0.5 * pair->backlash + uniform(seed, -8e-6, 8e-6);
        gm_position position;
        gm_mesh_result result;
        gm_penetration plain;
        gm_state state = {angle, 0.0, 100.0, 0.0};
        check(gm_position_from_pinion_angle(pair, angle, k % 2 == 0 ? offset : -offset, 1e-3,
                                            &position));
        check(gm_mesh_evaluate_at(mesh, &position, GM_WANT_DERIVATIVES, NULL, &result));
        print_result(&result.contact);
        check(gm_mesh_evaluate_at(mesh, &position, GM_WANT_FORCE, NULL, &result));
        print_bits(result.contact.drive);
        print_bits(result.contact.coast);
        state.wheel_angle = (pair->pinion.base_radius * angle - offset) / pair->wheel.base_radius;
        check(gm_penetration_3d(pair, pinions[pinion], wheels[wheel], &state, &plain));
        print_result(&plain);
        if (k % 16 == 0) {
            const int status = gm_static_equilibrium(mesh, angle, 20.0, (double)NAN, NULL,
                                                     &position.offset, &result);
            print_bits(position.offset);
            printf("%d\n", status);
        }
    }
    print_elastic(given, pinions[1], wheels[2], seed);
    while (block_count > 0) {
        free(blocks[--block_count]);
    }
}

int main(int argc, char **argv) {
    static prepared pairs[PAIRS];
    uint64_t seed = 11;
    const int writes = argc == 3 && strcmp(argv[2], "--write") == 0;
    is_plain = argc == 3 && strcmp(argv[2], "--plain") == 0;
    if (argc != 2 && !writes && !is_plain) {
        stop("usage: evaluations FILE [--write | --plain]");
    }

    if (writes) {
        for (int k = 0; k < PAIRS; ++k) {
            prepare(k, &pairs[k]);
        }
    }
    FILE *file = fopen(argv[1], writes ? "wb" : "rb");
    if (file == NULL || (writes ? fwrite(pairs, sizeof pairs, 1, file)
                                : fread(pairs, sizeof pairs, 1, file)) != 1) {
        stop("the file of what is prepared");
    }
    if (fclose(file) != 0) {
        stop("the file of what is prepared");
    }
    for (int k = 0; k < PAIRS; ++k) {
        print_pair(&pairs[k], &seed);
    }
    return 0;
}
