/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "gear_mesh.h"
#include "drawing.h"
#include "memory.h"
#include "modification_keys.h"
#include "tooth_stiffness.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static gm_gear *gear_of(gear_mesh *mesh, enum gm_role role) {
    return role == GM_PINION ? &mesh->pair.pinion : &mesh->pair.wheel;
}

/* The second half has the flanks of the first, unless files are given for it. */
static int load_flanks(gear_mesh *mesh, const config *conf) {
    int status = 0;
    for (int half = 0; half < mesh->halves; ++half) {
        for (enum gm_role role = GM_PINION; role <= GM_WHEEL && status == 0; ++role) {
            gear_flanks *flanks = &mesh->flanks[half][role];
            if (half > 0 && !gear_flanks_has_second(conf, role)) {
                *flanks = mesh->flanks[0][role];
            } else {
                status = gear_flanks_load(flanks, conf, &mesh->pair, role, half);
            }
        }
    }

    for (enum gm_role role = GM_PINION; role <= GM_WHEEL && status == 0; ++role) {
        if (conf->law == LAW_ELASTIC) {
            status = tooth_stiffness_load(&mesh->tooth_stiffness[role], conf, role,
                                          gear_of(mesh, role)->teeth);
        }
    }
    return status;
}

/* Whether a mesh of these gears can be in this pose, both halves of a double-helical one; the law has no part in that. */
static int is_in_mesh(const gear_mesh *mesh, const gm_pose *pose) {
    union {
        double alignment;
        char bytes[8192];
    } memory;
    gm_mesh *prepared;
    gm_mesh_params params;
    gm_mesh_params_default(&params);
    params.stiffness = 1.0;

    /* Each half has a pose of its own. */
    gm_pose poses[2] = {*pose, *pose};
    if (mesh->halves == 2) {
        gm_double_helical_pose(&mesh->pair, mesh->gap, pose, poses);
    }

    /* Where one cannot be prepared it is out of mesh. */
    for (int half = 0; half < mesh->halves; ++half) {
        params.pose = poses[half];
        if (gm_mesh_init(&prepared, &params, &mesh->pair, NULL, NULL, memory.bytes,
                         sizeof memory.bytes) != GM_OK) {
            return 0;
        }
    }
    return 1;
}

/* What share of an amount, one of those of the pose, leaves the gears in mesh with the others as they are: by halving; 0 if
 * they are not in mesh without it. */
static double largest_share(const gear_mesh *mesh, const gm_pose *pose, double *amount) {
    const double all = *amount;
    double low = 0.0;
    double high = 1.0;
    *amount = 0.0;
    if (!is_in_mesh(mesh, pose)) {
        return 0.0;
    }
    for (int k = 0; k < 30; ++k) {
        const double middle = 0.5 * (low + high);
        *amount = middle * all;
        *(is_in_mesh(mesh, pose) ? &low : &high) = middle;
    }
    return low;
}

/* The key of the pose that moves the wheel most is the one to look at. */
static int refuse_pose(const config *conf, const gear_mesh *mesh) {
    const double half_face = 0.5 * mesh->pair.face_width;
    gm_pose pose = conf->pose;
    struct {
        const char *key;
        double *amount; /* (m, rad) */
        double unit;    /* of the key */
        double arm;     /* by which it moves the wheel (1, m) */
    } moves[] = {
        {"pose.center_distance_change_um", &pose.center_distance_change, 1e-6, 1.0},
        {"pose.offset_um", &pose.offset, 1e-6, 1.0},
        {"pose.axial_shift_um", &pose.axial_shift, 1e-6, 1.0},
        {"pose.skew_mrad", &pose.skew, 1e-3, half_face},
        {"pose.inclination_mrad", &pose.inclination, 1e-3, half_face},
    };
    int largest = 0;
    for (int k = 1; k < (int)(sizeof moves / sizeof moves[0]); ++k) {
        if (fabs(moves[k].arm * *moves[k].amount) >
            fabs(moves[largest].arm * *moves[largest].amount)) {
            largest = k;
        }
    }

    /* The limit to three digits, rounded towards 0, so that it is one that will do. */
    const double amount = *moves[largest].amount / moves[largest].unit;
    char limit[64] = "";
    const double most = amount * largest_share(mesh, &pose, moves[largest].amount);
    if (most != 0.0) {
        const double digit = pow(10.0, floor(log10(fabs(most))) - 2.0);
        snprintf(limit, sizeof limit, "; here up to %.9g", trunc(most / digit) * digit);
    }
    config_complain(conf, moves[largest].key,
                    "must leave the gears in mesh, with tips that reach each other and stay clear "
                    "of the roots, faces that overlap, and tilts of less than an eighth of the "
                    "transverse base pitch over the face%s (got %.9g)",
                    limit, amount);
    return EXIT_BAD_INPUT;
}

/* Of several static loads the largest, as the lines are cut for it where tip edges press: at one near 0 they are not yet. */
static double reference_load(const config *conf) {
    const int are_several = conf->analysis == ANALYSIS_STATIC && conf->loads > 1;

    return fmax(fabs(conf->mean_load), are_several ? fabs(conf->end_load) : 0.0);
}

static gm_mesh_params params_of(const config *conf, const gear_mesh *mesh) {
    static const int laws[] = {[LAW_CONSTANT] = GM_LAW_CONSTANT,
                               [LAW_ISO6336] = GM_LAW_ISO6336,
                               [LAW_ELASTIC] = GM_LAW_ELASTIC};
    const double share = 1.0 / mesh->halves; /* of stiffness, damping and load in each half */
    gm_mesh_params params;

    gm_mesh_params_default(&params);
    params.model = conf->model == MODEL_SIMPLE ? GM_MODEL_SIMPLE : GM_MODEL_3D;
    params.law = laws[conf->law];
    params.stiffness = share * conf->stiffness;
    params.iso_blank_factor = conf->iso_blank_factor;
    params.damping = isnan(conf->damping) ? 0.0 : share * conf->damping;
    params.simple_stiffness = share * conf->simple_stiffness;
    params.pose = conf->pose;

    /* What elastic teeth are made of, and the load that their stiffness is stated at. */
    params.pinion_youngs_modulus = conf->pinion_youngs_modulus;
    params.wheel_youngs_modulus = conf->wheel_youngs_modulus;
    params.pinion_poisson_ratio = conf->pinion_poisson_ratio;
    params.wheel_poisson_ratio = conf->wheel_poisson_ratio;
    params.pinion_bore_radius = conf->pinion_bore_radius;
    params.wheel_bore_radius = conf->wheel_bore_radius;
    params.pinion_tooth_stiffness = mesh->tooth_stiffness[GM_PINION];
    params.wheel_tooth_stiffness = mesh->tooth_stiffness[GM_WHEEL];
    params.corner_contact = conf->model == MODEL_3D && conf->corner_contact == CORNER_CONTACT_ON
                                ? GM_CORNER_ON
                                : GM_CORNER_OFF;
    params.tip_rounding = conf->tip_rounding;
    if (reference_load(conf) > 0) {
        params.reference_torque = share * reference_load(conf);
    }

    /* Friction of the flanks, off with a coefficient of 0. */
    const int friction_laws[] = {GM_FRICTION_CONSTANT, GM_FRICTION_ISO14179,
                                 GM_FRICTION_BENEDICT_KELLEY};
    params.friction_law = friction_laws[conf->friction_law];
    params.friction_coefficient = conf->friction_coefficient;
    params.friction_speed = conf->friction_speed;
    params.oil_viscosity = conf->oil_viscosity;
    params.roughness = conf->roughness;
    return params;
}

static int is_across_face(int kind) {
    return kind == GM_MOD_END_RELIEF_I || kind == GM_MOD_END_RELIEF_II ||
           kind == GM_MOD_TIP_CORNER_I || kind == GM_MOD_TIP_CORNER_II ||
           kind == GM_MOD_ROOT_CORNER_I || kind == GM_MOD_ROOT_CORNER_II;
}

/* How deep the flanks are that have been read, modifications included (m). */
static double depth_of_flanks(const gear_mesh *mesh) {
    double depth = 0.0;
    for (int half = 0; half < mesh->halves; ++half) {
        for (enum gm_role role = GM_PINION; role <= GM_WHEEL; ++role) {
            for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
                depth = fmax(depth, gm_flanks_depth(mesh->flanks[half][role].prepared, side));
            }
        }
    }
    return depth;
}

/*
 * The largest amount in the file, across the flank (m). usual: what teeth give way by. A modification that is there, be it of
 * 0, counts as one of about as much, so that a search over amounts mostly keeps its stations.
 */
static double deepest_modification(const config *conf, double usual) {
    double depth = 0.0;
    for (enum gm_role role = GM_PINION; role <= GM_WHEEL; ++role) {
        for (int place = 0; place < MODIFICATION_PLACES; ++place) {
            for (int kind = 0; kind < GM_MODIFICATION_KINDS; ++kind) {
                const modification_values *given = &conf->modifications[role][place][kind];
                const double amount = given->value[MODIFICATION_AMOUNT];
                if (!isnan(amount)) {
                    const double least = is_across_face(kind) ? 1.6 * usual : 0.5 * usual;
                    depth = fmax(depth, fmax(fabs(amount), least));
                }
            }
        }
    }
    return depth;
}

int gear_mesh_stations(const gear_mesh *mesh, const config *conf) {
    if (conf->stations > 0) {
        return conf->stations;
    }

    /* Flanks that have been read, and amounts, so that the reliefs of a search count before there are any. */
    const gm_mesh_params params = params_of(conf, mesh);
    const gm_pair *pair = &mesh->pair;
    const double line_load =
        isnan(params.reference_torque)
            ? 1e5
            : params.reference_torque / fabs(pair->wheel.base_radius) / pair->face_width;
    const double usual = 5 * line_load *
                         (1 / params.pinion_youngs_modulus + 1 / params.wheel_youngs_modulus) /
                         pair->normal_to_transverse;
    const double amount = conf->model == MODEL_3D ? deepest_modification(conf, usual) : 0.0;
    const double depth = fmax(depth_of_flanks(mesh), amount * pair->normal_to_transverse);
    return gm_elastic_stations_modified(pair, &params, depth);
}

/* Gears to which ISO 6336-1 gives a stiffness, but not with the accuracy that it states. */
static void warn_of_iso6336(const config *conf, const gm_pair *pair) {
    const int warnings = gm_iso6336_warnings(pair);
    const double x_p = pair->pinion.profile_shift, x_w = pair->wheel.profile_shift;

    if (warnings & GM_WARN_ISO6336_SHIFT_ORDER) {
        config_warn(conf, "mesh.law",
                    "the gear with fewer teeth has the smaller profile shift (%.6g of the pinion, "
                    "%.6g of the wheel), for which ISO 6336-1 does not give its stiffness",
                    x_p, x_w);
    }
    if (warnings & GM_WARN_ISO6336_SHIFT_SUM) {
        config_warn(conf, "mesh.law",
                    "the sum of the profile shifts is %.6g, outside the -0.5 to 2 for which ISO "
                    "6336-1 gives its stiffness",
                    x_p + x_w);
    }
    if (warnings & GM_WARN_ISO6336_HELIX) {
        config_warn(conf, "mesh.law",
                    "the helix angle is beyond the 45 degrees for which ISO 6336-1 gives its "
                    "stiffness");
    }
}

/* The standard's stiffness is that of teeth under a good load: F_t / b at the reference circle. */
static void warn_of_light_load(const config *conf, const gear_mesh *mesh) {
    const double least = 100e3, most = 1600e3; /* N/m */
    const gm_pair *pair = &mesh->pair;
    const double line_load =
        fabs(conf->mean_load) / (pair->wheel.reference_radius * mesh->halves * pair->face_width);

    if (line_load > 0 && line_load < least) {
        config_warn(conf, "mesh.law",
                    "the mean load is %.3g N per mm of face width; below 100 ISO 6336-1 has softer "
                    "teeth, here by the factor %.3f",
                    1e-3 * line_load, pow(line_load / least, 0.25));
    }
    if (line_load > most) {
        config_warn(conf, "mesh.law",
                    "the mean load is %.4g N per mm of face width, beyond the 1600 for which ISO "
                    "6336-1 gives its stiffness",
                    1e-3 * line_load);
    }
}

static int is_listing_without_law(const config *conf) {
    return conf->purpose == CONFIG_FOR_GEOMETRY && config_text(conf, "mesh.law") == NULL;
}

/* Teeth of a ring are computed, but nothing has been held against them. */
static void warn_of_ring(const config *conf, const gm_pair *pair) {
    if (pair->wheel.sign < 0 && !is_listing_without_law(conf)) {
        config_warn(conf, "gears.wheel_teeth",
                    "the elastic law of a ring is unmeasured: its teeth are those of gears with a "
                    "foot under 60 degrees, held against no finite elements; its rim is rigid");
    }
}

/* Radius in modules at which the rounding of the rack's tip fills the space between its flanks. */
static double largest_fillet_radius(const gm_pair *pair, const char *field) {
    const gm_gear *gear = strncmp(field, "pinion", 6) == 0 ? &pair->pinion : &pair->wheel;
    const double alpha = pair->normal_pressure_angle;

    return (0.25 * 3.14159265358979323846 - gear->rack_dedendum * tan(alpha)) * cos(alpha) /
           (1 - sin(alpha));
}

/* Gears whose teeth have no elastic law; without a law asked for, a listing of the drawing goes without. */
static int refuse_elastic(const config *conf, const gm_pair *pair, const gm_mesh_params *params,
                          void *memory, size_t size) {
    const char *field = NULL;
    const char *requirement = NULL;
    const int status = gm_mesh_check_teeth(params, pair, &field, &requirement, memory, size);
    if (status != GM_ERR_GEOMETRY || field == NULL) {
        return EXIT_RUN_FAILED;
    }
    if (is_listing_without_law(conf)) {
        return 0;
    }

    /* Bores are no field of the drawing. */
    const char *key = strcmp(field, "pinion_bore_radius") == 0  ? "gears.pinion_bore_diameter_mm"
                      : strcmp(field, "wheel_bore_radius") == 0 ? "gears.wheel_bore_diameter_mm"
                                                                : config_key_of_field(field);
    const char *text = config_text(conf, key);
    char most[48] = "";
    char derived[48] = "none, so it is derived";
    if (strstr(field, "fillet_radius") != NULL) {
        const gm_gear *gear = *field == 'p' ? &pair->pinion : &pair->wheel;
        snprintf(derived, sizeof derived, "none, so it is %.6g", gear->rack_fillet_radius);
        if (strstr(requirement, "rack's flanks") != NULL) {
            snprintf(most, sizeof most, ", here %.6g", largest_fillet_radius(pair, field));
        }
    }
    const int is_asked_for = config_text(conf, "mesh.law") != NULL;
    config_complain(conf, key, "must be %s%s (got %s), for elastic teeth: mesh.law = elastic%s",
                    requirement, most, text != NULL ? text : derived,
                    is_asked_for ? "" : " is taken without mesh.stiffness_N_per_m");
    return EXIT_BAD_INPUT;
}

static int refuse_iso6336(const config *conf) {
    config_complain(conf, "mesh.law",
                    "must be constant for these gears, to which ISO 6336-1 gives no stiffness: "
                    "numbers of teeth, profile shifts or racks are too far off (got iso6336)");
    return EXIT_BAD_INPUT;
}

/* D of a pair of teeth, in each half, that gives both bodies on the mean mesh the damping ratio: 2 zeta K_mean / w0 for all
 * pairs. */
static double damping_of_ratio(const gear_mesh *mesh, const config *conf) {
    const double w0 = 2 * 3.14159265358979323846 * gear_mesh_eigenfrequency(mesh, conf);
    const double damping = 2 * conf->damping_ratio * gm_mesh_mean_stiffness(mesh->prepared[0]) / w0;

    return isfinite(damping) ? damping / mesh->pair.transverse_contact_ratio : 0.0;
}

static int refuse(const config *conf, const gear_mesh *mesh, const gm_mesh_params *params,
                  int status, void *memory, size_t size) {
    if (status == GM_POSE_OUT_OF_MESH) {
        return refuse_pose(conf, mesh);
    }
    if (status == GM_ERR_GEOMETRY && conf->law == LAW_ELASTIC) {
        return refuse_elastic(conf, &mesh->pair, params, memory, size);
    }
    if (status == GM_ERR_GEOMETRY && config_has_corners(conf)) {
        config_complain(conf, "mesh.corner_contact",
                        "must be off for these gears: a tip reaches to the base circle of its "
                        "mate, where it has no flank to touch (got on)");
        return EXIT_BAD_INPUT;
    }
    return EXIT_RUN_FAILED;
}

/* Too many lines of contact at once, or gears that ISO 6336-1 does not know. */
static int refuse_without_size(const config *conf, const gm_pair *pair) {
    if (conf->law == LAW_ISO6336) {
        return refuse_iso6336(conf);
    }
    if (is_listing_without_law(conf)) {
        return 0;
    }
    config_complain(conf, "mesh.law",
                    "must be constant for these gears, of which more teeth touch at once than "
                    "elastic ones may: a total contact ratio of 10 (got elastic, and %.3f)",
                    pair->total_contact_ratio);
    return EXIT_BAD_INPUT;
}

/* Memory in which elastic teeth keep their last balance. */
static int make_workspace(gear_mesh *mesh, const config *conf, int half) {
    const size_t size = gm_workspace_size(mesh->prepared[half]);
    void *memory = size > 0 ? malloc(size) : NULL;

    if (size > 0 && memory == NULL) {
        return message_no_memory(conf->messages);
    }
    return gm_workspace_init(&mesh->workspace[half], mesh->prepared[half], memory, size) == GM_OK
               ? 0
               : EXIT_RUN_FAILED;
}

/* Pair, flanks and law of one half, or of all, as one object. */
static int prepare_half(gear_mesh *mesh, const config *conf, gm_mesh_params *params, int half) {
    const size_t size = gm_mesh_size(params, &mesh->pair);
    if (size == 0) {
        return refuse_without_size(conf, &mesh->pair);
    }
    void *memory = malloc(size);
    if (memory == NULL) {
        return message_no_memory(conf->messages);
    }
    gm_mesh **prepared = &mesh->prepared[half];
    const gm_flanks *pinion = mesh->flanks[half][GM_PINION].prepared;
    const gm_flanks *wheel = mesh->flanks[half][GM_WHEEL].prepared;
    int status = gm_mesh_init(prepared, params, &mesh->pair, pinion, wheel, memory, size);

    /* What a damping ratio means is known once there is a mesh without damping. */
    if (status == GM_OK && !isnan(conf->damping_ratio)) {
        params->damping = damping_of_ratio(mesh, conf);
        status = gm_mesh_init(prepared, params, &mesh->pair, pinion, wheel, memory, size);
    }
    if (status == GM_OK) {
        return make_workspace(mesh, conf, half);
    }
    const int exit_code = refuse(conf, mesh, params, status, memory, size);
    free(memory);
    return exit_code;
}

/* Two halves with a pinion that floats between them. */
static int join_halves(gear_mesh *mesh, const config *conf) {
    pinion_float *floating = allocate(1, sizeof *floating);
    if (floating == NULL) {
        return message_no_memory(conf->messages);
    }
    floating->gears.gap = mesh->gap;
    for (int half = 0; half < 2; ++half) {
        floating->gears.half[half] = mesh->prepared[half];
        floating->gears.workspace[half] = mesh->workspace[half];
    }
    mesh->floating = floating;
    return 0;
}

static void remark_few_stations(const config *conf, const gear_mesh *mesh) {
    const int stations = gear_mesh_stations(mesh, conf);
    const double error = gm_elastic_stations_error(&mesh->pair, stations);

    if (error > 0.006) { /* not where NaN */
        config_remark(
            conf, "mesh.stations",
            "%d stations leave some %.1f %% in the transmission error, as they are far apart "
            "on short lines of contact; %d leave 0.4",
            stations, 100 * error, gm_elastic_stations(&mesh->pair));
    }
}

/* All of it; none without a stiffness, which only a run requires. */
static int prepare(gear_mesh *mesh, const config *conf) {
    gm_mesh_params params = params_of(conf, mesh);
    if (conf->law == LAW_ELASTIC) {
        params.stations = gear_mesh_stations(mesh, conf);
    }
    if (gm_mesh_params_check(&params, NULL, NULL) != GM_OK) {
        return 0;
    }
    if (mesh->halves == 1) {
        return prepare_half(mesh, conf, &params, 0);
    }

    gm_pose poses[2];
    (void)gm_double_helical_pose(&mesh->pair, mesh->gap, &conf->pose, poses);
    int status = 0;
    for (int half = 0; half < 2 && status == 0; ++half) {
        params.pose = poses[half];
        status = prepare_half(mesh, conf, &params, half);
    }
    return status == 0 && mesh->prepared[1] != NULL ? join_halves(mesh, conf) : status;
}

int gear_mesh_open(gear_mesh *mesh, const config *conf) {
    memset(mesh, 0, sizeof *mesh);
    const int is_double = !isnan(conf->double_helical_gap);
    mesh->halves = is_double ? 2 : 1;
    mesh->gap = is_double ? conf->double_helical_gap : 0.0;
    mesh->wheel_shift = is_double ? 0.0 : conf->pose.axial_shift;

    int status = drawing_derive(&mesh->pair, conf);
    if (status != 0) {
        return status;
    }
    if (conf->purpose != CONFIG_FOR_FLANKS) {
        drawing_warn(conf, &mesh->pair);
        if (conf->law == LAW_ELASTIC) {
            warn_of_ring(conf, &mesh->pair);
        }
        if (conf->law == LAW_ISO6336) {
            warn_of_iso6336(conf, &mesh->pair);
            warn_of_light_load(conf, mesh);
        }
    }

    if (conf->model == MODEL_3D && conf->purpose == CONFIG_FOR_RUN) {
        status = load_flanks(mesh, conf);
    }
    if (status == 0 && !(conf->purpose == CONFIG_FOR_FLANKS && conf->law == LAW_ELASTIC)) {
        status = prepare(mesh, conf);
        if (status == 0 && mesh->prepared[0] != NULL && conf->purpose == CONFIG_FOR_RUN &&
            conf->law == LAW_ELASTIC) {
            remark_few_stations(conf, mesh);
        }
    }
    if (status != 0) {
        gear_mesh_close(mesh);
    }
    return status;
}

void gear_mesh_close(gear_mesh *mesh) {
    for (int half = 1; half >= 0; --half) {
        free(mesh->prepared[half]); /* they begin at their memory */
        free(mesh->workspace[half]);
        for (enum gm_role role = GM_PINION; role <= GM_WHEEL; ++role) {
            gear_flanks *flanks = &mesh->flanks[half][role];
            if (half == 0 || flanks->prepared != mesh->flanks[0][role].prepared) {
                gear_flanks_free(flanks);
            }
        }
    }
    free(mesh->floating);
    free(mesh->tooth_stiffness[GM_PINION]);
    free(mesh->tooth_stiffness[GM_WHEEL]);
    memset(mesh, 0, sizeof *mesh);
}

double gear_mesh_eigenfrequency(const gear_mesh *mesh, const config *conf) {
    const double pinion_inertia = conf->drive == DRIVE_TORQUE ? conf->pinion_inertia : HUGE_VAL;

    return sqrt(mesh->halves) *
           gm_mesh_eigenfrequency(mesh->prepared[0], pinion_inertia, conf->wheel_inertia);
}

double gear_mesh_face_width(const gear_mesh *mesh, const gm_gear *gear) {
    return mesh->halves * gear->face_width + mesh->gap;
}

int gear_mesh_note(const gear_mesh *mesh, config *conf) {
    const double frequency = gear_mesh_eigenfrequency(mesh, conf);
    int status = 0;

    for (enum gm_role gear = GM_PINION; gear <= GM_WHEEL && status == 0; ++gear) {
        status = gear_flanks_note(&mesh->flanks[0][gear], conf, gear);
    }
    if (status == 0 && isfinite(frequency)) {
        status = config_note(conf, "eigenfrequency_Hz", frequency);
    }
    if (status == 0 && conf->law == LAW_ELASTIC) {
        status = config_note(conf, "stations", gear_mesh_stations(mesh, conf));
    }
    return status == 0 ? 0 : message_no_memory(conf->messages);
}
