/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The external functions of the Modelica package, called as the C code of a tool calls them: an external object made,
 * used and freed, arrays with their sizes, errors by ModelicaError(), which does not return. Prints the motion of
 * Examples.GearPair (time in s, x in um).
 *
 *     test_modelica GEARMESH_PACKAGE_FOLDER FLANKS.csv
 *
 * Of the meshes of tests/clients/random_meshes.py, whose tables are in files of the folder beside it, it prints torques and
 * force at each state, without the motion of the wheel.
 *
 *     test_modelica --meshes MESHES.txt FOLDER
 */
#include "gearmesh_modelica.h"

#include "tool.h"

#include <gearmesh/gearmesh.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failures;

static void expect(int condition, const char *what) {
    if (!condition) {
        fprintf(stderr, "not so: %s\n", what);
        ++failures;
    }
}

static void stop(const char *what) {
    fprintf(stderr, "test_modelica: %s\n", what);
    exit(1);
}

/* ---------------------------------------------------------------------------------------------
 * Records, as a tool lays them out
 * ------------------------------------------------------------------------------------------- */

enum { FIELDS_MAX = 80, NAME_SIZE = 64 };

typedef struct record {
    char name[FIELDS_MAX][NAME_SIZE];
    double value[FIELDS_MAX];
    size_t count;
} record;

/* Fields and defaults in the order of a record's text; what has no default is 0. */
static void read_record(record *made, const char *folder, const char *name) {
    char line[4096];
    snprintf(line, sizeof line, "%s/%s.mo", folder, name);
    FILE *file = fopen(line, "r");
    if (file == NULL) {
        stop("no such record");
    }

    made->count = 0;
    while (fgets(line, sizeof line, file) != NULL) {
        char kind[16];
        char *field = made->name[made->count];
        if (made->count == FIELDS_MAX ||
            sscanf(line, " parameter %15s %63[a-z_]", kind, field) != 2) {
            continue;
        }

        /* ` = value "what it is"`, or ` = derived`, or the text alone. */
        const char *binding = strstr(line, " = ");
        const char *description = strstr(line, " \"");
        const int has_default = binding != NULL && binding < description;
        const int is_derived = has_default && strncmp(binding, " = derived", 10) == 0;
        made->value[made->count] = is_derived    ? 1e60
                                   : has_default ? strtod(binding + 3, NULL)
                                                 : 0.0;
        ++made->count;
    }
    fclose(file);
}

static void set(record *of, const char *name, double value) {
    for (size_t k = 0; k < of->count; ++k) {
        if (strcmp(of->name[k], name) == 0) {
            of->value[k] = value;
            return;
        }
    }
    stop(name);
}

static void *new_mesh(const record *gears, const record *law, const char *pinion_flanks) {
    return gearmesh_modelica_new(gears->value, gears->count, law->value, law->count, 1e60,
                                 pinion_flanks, "", "", "", "", "", "", "");
}

/* Why a mesh is refused; "" if it is not. */
static const char *refusal(const record *gears, const record *law, const char *pinion_flanks) {
    tool_message[0] = '\0';
    if (setjmp(tool_return) == 0) {
        gearmesh_modelica_free(new_mesh(gears, law, pinion_flanks));
    }
    return tool_message;
}

/* What is said of double-helical gears between bodies, whose pinion floats without being told. */
static const char *refusal_of_halves(const record *gears, const record *law) {
    const double body[18] = {0.0};
    double loads[12];
    void *volatile halves = NULL;
    tool_message[0] = '\0';
    if (setjmp(tool_return) == 0) {
        halves = gearmesh_modelica_new(gears->value, gears->count, law->value, law->count, 1e-3, "",
                                       "", "", "", "", "", "", "");
        gearmesh_modelica_loads(halves, body, 18, body, 18, loads, 12);
    }
    gearmesh_modelica_free(halves);
    return tool_message;
}

/* ---------------------------------------------------------------------------------------------
 * Claims
 * ------------------------------------------------------------------------------------------- */

/* The mesh of the examples by the names of the library. */
static gm_mesh *library_mesh(void) {
    static double memory[512];
    gm_pair_params params;
    gm_pair_params_default(&params);
    params.pinion_teeth = 45;
    params.wheel_teeth = 41;
    params.normal_module = 1.65e-3;
    params.normal_pressure_angle = 0.27925268031909273;
    params.helix_angle = 0.57595865315812877;
    params.center_distance = 0.085;
    params.face_width = 0.0175;
    params.backlash = 100e-6;

    gm_mesh_params law;
    gm_mesh_params_default(&law);
    law.stiffness = 1.05e8;
    law.damping = 844.361;

    gm_pair pair;
    gm_mesh *mesh = NULL;
    if (gm_pair_init(&pair, &params) != GM_OK ||
        gm_mesh_init(&mesh, &law, &pair, NULL, NULL, memory, sizeof memory) != GM_OK) {
        stop("the library refuses the gears");
    }
    return mesh;
}

static void mesh_is_that_of_the_library(void *mesh) {
    const gm_state state = {0.31, 0.3389, 20.0, 21.9};
    double result[3];
    gm_mesh_result expected;
    gm_mesh_evaluate(library_mesh(), &state, GM_WANT_FORCE, NULL, &expected);
    gearmesh_modelica_evaluate(mesh, &state.pinion_angle, 4, result, 3);

    expect(expected.force > 100.0, "the flanks touch");
    expect(result[0] == expected.pinion_torque && result[1] == expected.wheel_torque &&
               result[2] == expected.force,
           "torques and force are those of the library");
}

/* What is refused names the parameter or the file, and leaves nothing behind. */
static void refusals_say_what_is_wrong(const record *gears, const record *law, const char *flanks) {
    static record wrong;
    wrong = *law;
    set(&wrong, "damping", -1.0);
    expect(strstr(refusal(gears, &wrong, ""), "damping: must be") != NULL, "a parameter is named");
    expect(strstr(refusal(gears, law, "nowhere.csv"), "nowhere.csv") != NULL, "a file is named");

    wrong = *law;
    --wrong.count;
    expect(strstr(refusal(gears, &wrong, ""), "one version") != NULL, "a value is missing");

    expect(refusal(gears, law, flanks)[0] == '\0', "flanks from a file");
    expect(strstr(refusal_of_halves(gears, law), "opposite hand") != NULL, "halves between bodies");
}

/* A record as it is, and one that leaves all but stiffness and damping to the library, are the same mesh. */
static void defaults_are_those_of_the_library(const record *gears, const record *law) {
    static record plain;
    plain = *law;
    for (size_t k = 0; k < plain.count; ++k) {
        plain.value[k] = 1e60;
    }
    set(&plain, "stiffness", 1.05e8);
    set(&plain, "damping", 844.361);

    for (int k = 0; k < 2; ++k) {
        void *mesh = new_mesh(gears, k == 0 ? law : &plain, "");
        mesh_is_that_of_the_library(mesh);
        gearmesh_modelica_free(mesh);
    }
}

/* An error leaves by ModelicaError(), and the mesh may be freed after it. */
static void a_skipped_tooth_is_refused(void *mesh) {
    const double too_far[4] = {0.0, 0.5, 0.0, 0.0};
    if (setjmp(tool_return) == 0) {
        double result[3];
        gearmesh_modelica_evaluate(mesh, too_far, 4, result, 3);
        expect(0, "a state that skips a tooth is refused");
    }
}

/* Step 1e-7: a few nanometres, 1e-5 of the penetration; second differences are below 1e-4 of the slope. */
static void derivative_is_that_of_the_function(void *mesh) {
    const double state[4] = {0.31, 0.3389, 20.0, 21.9};
    const double rate[4] = {1.0, -0.4, 300.0, 200.0};
    const double step = 1e-7;
    double side[2][3], found[3];
    for (int k = 0; k < 2; ++k) {
        double moved[4];
        for (int i = 0; i < 4; ++i) {
            moved[i] = state[i] + (k == 0 ? -step : step) * rate[i];
        }
        gearmesh_modelica_evaluate(mesh, moved, 4, side[k], 3);
    }

    gearmesh_modelica_evaluate_der(mesh, state, 4, rate, 4, found, 3);
    for (int i = 0; i < 3; ++i) {
        const double difference = (side[1][i] - side[0][i]) / (2.0 * step);
        expect(fabs(found[i] - difference) <= 1e-4 * fabs(difference),
               "the derivative is that of the function");
    }
}

/* Bodies as drawn, the wheel turned clockwise: torque about each axis, and balance of both loads. */
static void loads_on_bodies_are_in_balance(void *mesh) {
    const double x = 52e-6;
    double radii[2];
    gearmesh_modelica_base_radii(mesh, radii, 2);

    /* Position, rotation matrix by rows, velocity and angular velocity of each body. */
    const double turn = x / radii[1];
    const double c = cos(turn), s = sin(turn);
    const double pinion[18] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0};
    const double wheel[18] = {0.085, 0, 0, c, -s, 0, s, c, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0};
    double loads[12], result[3];
    gearmesh_modelica_loads(mesh, pinion, 18, wheel, 18, loads, 12);

    /* The same between shafts. */
    const double state[4] = {0.0, -turn, 0.0, 0.0};
    gearmesh_modelica_evaluate(mesh, state, 4, result, 3);

    expect(result[2] > 100.0, "the flanks of the bodies touch");
    expect(fabs(loads[5] + result[0]) <= 1e-9 * result[0], "torque taken from the pinion's body");
    expect(fabs(loads[11] + result[1]) <= 1e-9 * result[1], "torque given to the wheel's body");
    for (int i = 0; i < 3; ++i) {
        expect(fabs(loads[i] + loads[6 + i]) <= 1e-9 * result[2], "action and reaction");
    }
}

/* I phi'' of both bodies, as the equations of Examples.GearPair say. */
static void motion_of(void *mesh, const double state[4], double rate[4]) {
    double result[3];
    gearmesh_modelica_evaluate(mesh, state, 4, result, 3);
    rate[0] = state[2];
    rate[1] = state[3];
    rate[2] = (25.0 - result[0]) / 2.1e-3;
    rate[3] = (result[1] - 20.0) / 2.1e-3;
}

/* By the classical method of Runge and Kutta in steps of 1e-6 s, from where both bodies are accelerated alike. */
static void print_motion(void *mesh) {
    double radii[2];
    gearmesh_modelica_base_radii(mesh, radii, 2);
    const double sum = radii[0] * radii[0] + radii[1] * radii[1];
    const double torque = radii[1] * (25.0 * radii[0] + 20.0 * radii[1]) / sum;
    const double offset = gearmesh_modelica_static_offset(mesh, 0.0, torque);

    const double speed = 104.71975511965977, step = 1e-6;
    double state[4] = {0.0, -offset / radii[1], speed, speed * radii[0] / radii[1]};
    for (int n = 0; n <= 20000; ++n) {
        if (n % 100 == 0) {
            printf("%.9f,%.12g\n", n * step, 1e6 * (radii[0] * state[0] - radii[1] * state[1]));
        }

        double rate[4][4], next[4];
        const double share[4] = {0.0, 0.5, 0.5, 1.0};
        for (int stage = 0; stage < 4; ++stage) {
            for (int i = 0; i < 4; ++i) {
                next[i] = state[i] + (stage == 0 ? 0.0 : share[stage] * step * rate[stage - 1][i]);
            }
            motion_of(mesh, next, rate[stage]);
        }
        for (int i = 0; i < 4; ++i) {
            state[i] +=
                step / 6.0 * (rate[0][i] + 2.0 * rate[1][i] + 2.0 * rate[2][i] + rate[3][i]);
        }
    }
}

/* ---------------------------------------------------------------------------------------------
 * Random meshes
 * ------------------------------------------------------------------------------------------- */

enum { TABLES = 3, PATH_SIZE = 1024 };

static double number(FILE *file) {
    double value;
    if (fscanf(file, "%lf", &value) != 1) {
        stop("a number is missing");
    }
    return value;
}

/* As a record has them: what is left to the library is 1e60. */
static size_t read_values(FILE *file, double *values) {
    const size_t count = (size_t)number(file);
    for (size_t k = 0; k < count && k < FIELDS_MAX; ++k) {
        values[k] = number(file);
        values[k] = isnan(values[k]) ? 1e60 : values[k];
    }
    return count;
}

static void *read_mesh(FILE *file, const char *folder, int mesh) {
    double pair[FIELDS_MAX], law[FIELDS_MAX];
    char path[TABLES][PATH_SIZE] = {"", "", ""};
    const double gap = number(file);
    const size_t pair_size = read_values(file, pair);
    const size_t law_size = read_values(file, law);

    /* Numbers of tables are passed over: the binding reads them from their files. */
    const int nodes = (int)number(file) * (int)number(file);
    for (int k = 0; k < TABLES && nodes > 0; ++k) {
        snprintf(path[k], PATH_SIZE, "%s/%d_%d.csv", folder, mesh, k);
        for (int node = 0; node < nodes; ++node) {
            number(file);
        }
    }
    return gearmesh_modelica_new(pair, pair_size, law, law_size, isnan(gap) ? 1e60 : gap, path[0],
                                 "", path[1], "", path[2], "", "", "");
}

static int print_meshes(const char *path, const char *folder) {
    FILE *file = fopen(path, "r");
    if (file == NULL) {
        stop("no such file of meshes");
    }
    if (setjmp(tool_return) != 0) {
        stop(tool_message);
    }

    const int meshes = (int)number(file);
    for (int mesh = 0; mesh < meshes; ++mesh) {
        void *made = read_mesh(file, folder, mesh);
        const int states = (int)number(file);
        for (int k = 0; k < states; ++k) {
            double state[14], result[3]; /* angles and speeds; motion, which shafts have not */
            for (int i = 0; i < 14; ++i) {
                state[i] = number(file);
            }
            gearmesh_modelica_evaluate(made, state, 4, result, 3);
            printf("%.17g %.17g %.17g\n", result[0], result[1], result[2]);
        }
        gearmesh_modelica_free(made);
    }
    fclose(file);
    return 0;
}

/* ---------------------------------------------------------------------------------------------
 * Program
 * ------------------------------------------------------------------------------------------- */

/* The records of a package, filled as Examples.GearPair fills them. */
static void read_gear_pair(record *gears, record *law, const char *package) {
    static const struct {
        const char *name;
        double value;
    } drawing[] = {{"pinion_teeth", 45},
                   {"wheel_teeth", 41},
                   {"normal_module", 1.65e-3},
                   {"normal_pressure_angle", 0.27925268031909273},
                   {"helix_angle", 0.57595865315812877},
                   {"center_distance", 0.085},
                   {"face_width", 0.0175},
                   {"backlash", 100e-6}};
    read_record(gears, package, "PairParameters");
    for (size_t k = 0; k < sizeof drawing / sizeof drawing[0]; ++k) {
        set(gears, drawing[k].name, drawing[k].value);
    }

    read_record(law, package, "MeshParameters");
    set(law, "stiffness", 1.05e8);
    set(law, "damping", 844.361);
}

int main(int argc, char **argv) {
    if (argc == 4 && strcmp(argv[1], "--meshes") == 0) {
        return print_meshes(argv[2], argv[3]);
    }
    if (argc != 3) {
        stop("needs a package and a file of flanks");
    }

    static record gears, law;
    read_gear_pair(&gears, &law, argv[1]);
    refusals_say_what_is_wrong(&gears, &law, argv[2]);

    /* From here on nothing may be refused. */
    if (setjmp(tool_return) != 0) {
        stop(tool_message);
    }
    defaults_are_those_of_the_library(&gears, &law);
    void *mesh = new_mesh(&gears, &law, "");
    derivative_is_that_of_the_function(mesh);
    loads_on_bodies_are_in_balance(mesh);
    print_motion(mesh);

    a_skipped_tooth_is_refused(mesh);
    gearmesh_modelica_free(mesh);
    gearmesh_modelica_free(NULL);
    return failures != 0;
}
