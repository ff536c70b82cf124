/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The mesh as an object: parameters and what is wrong with them, pair, flanks, model and law prepared in the memory of the
 * caller, and what is known of it without an evaluation. Then the same mesh where a motion has it.
 */
#include "mesh.h"

#include "cache.h"
#include "contact.h"
#include "corner.h"
#include "elastic_mesh.h"
#include "flank.h"
#include "friction.h"
#include "internal.h"
#include "law.h"
#include "meshing.h"
#include "penetration.h"
#include "position.h"

#include <math.h>
#include <string.h>

void gm_mesh_params_default(gm_mesh_params *params) {
    if (params == NULL) {
        return;
    }
    const gm_mesh_params defaults = {
        .model = GM_MODEL_3D,
        .law = GM_LAW_CONSTANT,
        .stiffness = gmi_nan(),
        .iso_blank_factor = 1.0,
        .damping = 0.0,
        .simple_stiffness = gmi_nan(),
        .pose = {0.0, 0.0, 0.0, 0.0, 0.0},

        /* Steel. */
        .pinion_youngs_modulus = 206e9,
        .wheel_youngs_modulus = 206e9,
        .pinion_poisson_ratio = 0.3,
        .wheel_poisson_ratio = 0.3,

        /* Elastic teeth: bodies do not wind up, and all teeth are whole. */
        .pinion_bore_radius = gmi_nan(),
        .wheel_bore_radius = gmi_nan(),
        .pinion_tooth_stiffness = NULL,
        .wheel_tooth_stiffness = NULL,
        .reference_torque = gmi_nan(),
        .stations = 0,

        /* Edges. */
        .corner_contact = GM_CORNER_BY_LAW,
        .tip_rounding = 0.05,

        /* No friction. */
        .friction_law = GM_FRICTION_CONSTANT,
        .friction_coefficient = 0.0,
        .friction_speed = 0.01,
        .oil_viscosity = gmi_nan(),
        .roughness = gmi_nan(),
    };
    *params = defaults;
}

static int is_stiffness(double value) {
    return value >= GMI_SMALLEST_STIFFNESS && value <= GMI_LARGEST_STIFFNESS;
}

static int is_within(double value, double from, double to) {
    return value >= from && value <= to;
}

/* The field at fault where corners are in contact, or NULL. */
static const char *corner_at_fault(const gm_mesh_params *params, const char **wanted) {
    const int corner = params->corner_contact;
    if (corner != GM_CORNER_BY_LAW && corner != GM_CORNER_OFF && corner != GM_CORNER_ON) {
        *wanted = "GM_CORNER_BY_LAW, GM_CORNER_OFF or GM_CORNER_ON";
        return "corner_contact";
    }
    if (corner != GM_CORNER_ON) {
        return NULL;
    }
    if (params->model == GM_MODEL_SIMPLE) {
        *wanted = "GM_CORNER_OFF with GM_MODEL_SIMPLE";
        return "corner_contact";
    }
    return NULL;
}

/* The field of the friction that is at fault, or NULL. */
static const char *friction_at_fault(const gm_mesh_params *params, const char **wanted) {
    const int law = params->friction_law;

    /* Which law, and whether the teeth can have it. */
    if (law != GM_FRICTION_CONSTANT && law != GM_FRICTION_ISO14179 &&
        law != GM_FRICTION_BENEDICT_KELLEY) {
        *wanted = "GM_FRICTION_CONSTANT, GM_FRICTION_ISO14179 or GM_FRICTION_BENEDICT_KELLEY";
        return "friction_law";
    }
    if (!is_within(params->friction_coefficient, 0.0, 1.0)) {
        *wanted = "a coefficient from 0 to 1";
        return "friction_coefficient";
    }

    /* Its numbers, as far as it takes them. */
    if (!is_within(params->friction_speed, 1e-9, 1e3)) {
        *wanted = "a speed from 1e-9 to 1e3 m/s";
        return "friction_speed";
    }
    if (law != GM_FRICTION_CONSTANT && !is_within(params->oil_viscosity, 1e-6, 1e6)) {
        *wanted = "a viscosity from 1e-6 to 1e6 Pa s";
        return "oil_viscosity";
    }
    if (law == GM_FRICTION_ISO14179 && !is_within(params->roughness, 1e-9, 1e-3)) {
        *wanted = "a roughness from 1e-9 to 1e-3 m";
        return "roughness";
    }
    return NULL;
}

/* The first field at fault, in the order of the struct; NULL if all is well. */
static const char *field_at_fault(const gm_mesh_params *params, const char **wanted) {
    static const char stiffness[] = "a stiffness from 1e-30 to 1e30 N/m";

    /* Which model and law. */
    if (params->model != GM_MODEL_3D && params->model != GM_MODEL_SIMPLE) {
        *wanted = "GM_MODEL_3D or GM_MODEL_SIMPLE";
        return "model";
    }
    if (params->law != GM_LAW_CONSTANT && params->law != GM_LAW_ISO6336 &&
        params->law != GM_LAW_ELASTIC) {
        *wanted = "GM_LAW_CONSTANT, GM_LAW_ISO6336 or GM_LAW_ELASTIC";
        return "law";
    }

    /* Their numbers. */
    if (params->law == GM_LAW_CONSTANT && !is_stiffness(params->stiffness)) {
        *wanted = stiffness;
        return "stiffness";
    }
    if (!(params->iso_blank_factor >= 0.01 && params->iso_blank_factor <= 2.0)) {
        *wanted = "a factor from 0.01 to 2";
        return "iso_blank_factor";
    }
    if (!(params->damping >= 0.0 && params->damping <= GMI_LARGEST_STIFFNESS)) {
        *wanted = "a damping from 0 to 1e30 N s/m";
        return "damping";
    }
    if (!isnan(params->simple_stiffness) && !is_stiffness(params->simple_stiffness)) {
        *wanted = stiffness;
        return "simple_stiffness";
    }

    /* Materials, and then friction and what does not go with it. */
    const char *at_fault = gmi_elastic_field_at_fault(params, wanted);
    if (at_fault == NULL) {
        at_fault = friction_at_fault(params, wanted);
    }
    return at_fault != NULL ? at_fault : corner_at_fault(params, wanted);
}

int gm_mesh_params_check(const gm_mesh_params *params, const char **field,
                         const char **requirement) {
    const char *wanted = NULL;
    const char *at_fault = params == NULL ? NULL : field_at_fault(params, &wanted);
    if (field != NULL) {
        *field = at_fault;
    }
    if (requirement != NULL) {
        *requirement = wanted;
    }
    return params == NULL ? GM_ERR_NULL : at_fault != NULL ? GM_ERR_PARAMETER : GM_OK;
}

/* Whether gm_pair_init() has made it. */
static int is_pair(const gm_pair *pair) {
    return pair->pinion.teeth > 0 && pair->wheel.teeth > 0 && pair->transverse_base_pitch > 0.0;
}

static int check(const gm_mesh_params *params, const gm_pair *pair) {
    if (params == NULL || pair == NULL) {
        return GM_ERR_NULL;
    }
    const int status = gm_mesh_params_check(params, NULL, NULL);
    if (status != GM_OK) {
        return status;
    }
    if (!is_pair(pair)) {
        return GM_ERR_GEOMETRY;
    }

    /* Gears may be too far off for the stiffness of a law that has its own. */
    const int has_own = params->law == GM_LAW_ISO6336;
    return !has_own || is_stiffness(gmi_law_of(params, pair).stiffness) ? GM_OK : GM_ERR_GEOMETRY;
}

size_t gm_mesh_size(const gm_mesh_params *params, const gm_pair *pair) {
    if (check(params, pair) != GM_OK) {
        return 0;
    }
    const size_t rigid = sizeof(gm_mesh) + sizeof(gm_pair);
    if (params->law != GM_LAW_ELASTIC) {
        return rigid;
    }
    const size_t elastic = gmi_elastic_mesh_size(params, pair);
    return elastic == 0 ? 0 : rigid + elastic;
}

/* Elastic teeth behind the pair; what follows from them as parameters of the force law. */
static int make_elastic(gm_mesh *mesh, gmi_elastic_mesh *elastic, gm_mesh_params *params) {
    int status = gmi_elastic_mesh_init(elastic, params, mesh->pair, &mesh->engagement, NULL, NULL);
    if (status == GM_OK) {
        mesh->elastic = elastic;
        params->stiffness = elastic->stiffness.mesh_mean / mesh->pair->transverse_contact_ratio;

        /* Of gears that hardly reach each other none of its positions may be in contact. */
        status = is_stiffness(params->stiffness) ? GM_OK : GM_ERR_GEOMETRY;
    }
    return status;
}

/* The pair of the simple model touches at mid-face, wherever the axes tilt to. */
static int knows_tilts(const gm_mesh *mesh) {
    return mesh->model != GM_MODEL_SIMPLE;
}

/* Which way its evaluations go. */
static void set_kind(gm_mesh *mesh) {
    const gmi_engagement *at = &mesh->engagement;
    mesh->is_special =
        mesh->cache != NULL || mesh->friction.is_on || mesh->elastic != NULL || mesh->has_corners;
    mesh->is_posed = at->offset_shift != 0.0 || at->phase_shift != 0.0;
    mesh->is_plain =
        mesh->model == GM_MODEL_3D && !mesh->is_special && !mesh->is_posed && !at->is_tilted;
}

static int has_room(const gm_mesh_params *params, const gm_pair *pair, const void *memory,
                    size_t memory_size) {
    return memory_size >= gm_mesh_size(params, pair) && gmi_is_aligned(memory);
}

/* Constant stiffness at tip edges; elastic teeth have their own. */
static int wants_corners(const gm_mesh_params *params) {
    return params->corner_contact == GM_CORNER_ON && params->law != GM_LAW_ELASTIC;
}

/* 1 / E' of both materials together: what flattens under a line of contact. */
static double compliance_of(const gm_mesh_params *params) {
    const double nu_p = params->pinion_poisson_ratio, nu_w = params->wheel_poisson_ratio;
    return (1.0 - nu_p * nu_p) / params->pinion_youngs_modulus +
           (1.0 - nu_w * nu_w) / params->wheel_youngs_modulus;
}

/* Which flanks each side has, and how lines are followed along them. */
static void take_flanks(gm_mesh *made, const gm_flanks *pinion, const gm_flanks *wheel) {
    const int is_wide = gmi_processor_is_wide();
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        gmi_side *prepared = &made->side[side];
        gmi_side_init(prepared, made->pair, &made->engagement, pinion, wheel, side);
        prepared->pinion_grid.is_wide = prepared->wheel_grid.is_wide = is_wide;
    }
}

int gm_mesh_init(gm_mesh **mesh, const gm_mesh_params *params, const gm_pair *pair,
                 const gm_flanks *pinion_flanks, const gm_flanks *wheel_flanks, void *memory,
                 size_t memory_size) {
    if (mesh == NULL) {
        return GM_ERR_NULL;
    }
    *mesh = NULL;

    /* The call: each of its arguments, and all of them together. */
    int status = memory == NULL ? GM_ERR_NULL : check(params, pair);
    if (status == GM_OK) {
        status = gmi_check_flanks(pair, pinion_flanks, wheel_flanks);
    }
    if (status == GM_OK && gm_mesh_size(params, pair) == 0) {
        status = GM_ERR_GEOMETRY;
    }
    if (status == GM_OK && !has_room(params, pair, memory, memory_size)) {
        status = GM_ERR_MEMORY;
    }

    /* How the gears stand in their pose. Nothing is written to the memory before that is known to be possible. */
    gmi_engagement engagement;
    gmi_corner corners[2];
    if (status == GM_OK) {
        status = gmi_engagement_find(pair, &params->pose, &engagement);
    }
    if (status == GM_OK && wants_corners(params) && !gmi_corners_init(pair, &engagement, corners)) {
        status = GM_ERR_GEOMETRY;
    }
    if (status != GM_OK) {
        return status;
    }

    /* The object, and behind it its copy of the pair. */
    gm_mesh *made = (gm_mesh *)memory;
    gm_pair *own_pair = (gm_pair *)(made + 1);
    memset(made, 0, sizeof *made);
    *own_pair = *pair;
    made->pair = own_pair;
    made->pose = params->pose;
    made->model = params->model;
    made->engagement = engagement;
    made->engagement.is_tilted = engagement.is_tilted && knows_tilts(made);

    /* The law; that of elastic teeth lies behind the pair. */
    gm_mesh_params law = *params;
    gmi_elastic_mesh *elastic = NULL;
    if (params->law == GM_LAW_ELASTIC) {
        elastic = (gmi_elastic_mesh *)(own_pair + 1);
        status = make_elastic(made, elastic, &law);
        if (status != GM_OK) {
            return status;
        }
    }
    made->law = gmi_law_of(&law, pair);
    made->contact_compliance = compliance_of(params);
    made->friction = gmi_friction_of(params, own_pair, &engagement);
    made->has_corners = wants_corners(params);
    if (made->has_corners) {
        memcpy(made->corners, corners, sizeof corners);
    }
    set_kind(made);

    /* The simple model has ideal flanks. */
    const int has_flanks = params->model != GM_MODEL_SIMPLE;
    take_flanks(made, has_flanks ? pinion_flanks : NULL, has_flanks ? wheel_flanks : NULL);
    if (elastic != NULL) {
        gmi_elastic_mesh_take_flanks(elastic, made, params->stations);
    }
    *mesh = made;
    return GM_OK;
}

int gm_mesh_check_teeth(const gm_mesh_params *params, const gm_pair *pair, const char **field,
                        const char **requirement, void *memory, size_t memory_size) {
    if (field != NULL) {
        *field = NULL;
    }
    if (requirement != NULL) {
        *requirement = NULL;
    }

    /* The call, as that of gm_mesh_init(). */
    int status = memory == NULL ? GM_ERR_NULL : check(params, pair);
    if (status == GM_OK && params->law != GM_LAW_ELASTIC) {
        status = GM_ERR_PARAMETER;
    }
    if (status == GM_OK && !has_room(params, pair, memory, memory_size)) {
        status = GM_ERR_MEMORY;
    }

    /* The law is made where it would be without mesh and pair, and what is at fault is told. */
    gmi_engagement at;
    if (status == GM_OK) {
        status = gmi_engagement_find(pair, &params->pose, &at);
    }
    return status == GM_OK ? gmi_elastic_mesh_init(memory, params, pair, &at, field, requirement)
                           : status;
}

size_t gm_workspace_size(const gm_mesh *mesh) {
    return mesh == NULL || mesh->elastic == NULL || mesh->model == GM_MODEL_SIMPLE
               ? 0
               : gmi_workspace_size(&mesh->elastic->law);
}

int gm_workspace_init(gm_workspace **workspace, const gm_mesh *mesh, void *memory,
                      size_t memory_size) {
    if (workspace == NULL) {
        return GM_ERR_NULL;
    }
    *workspace = NULL;
    const size_t size = gm_workspace_size(mesh);
    if (mesh == NULL || (size > 0 && memory == NULL)) {
        return GM_ERR_NULL;
    }
    if (memory_size < size || !gmi_is_aligned(memory)) {
        return GM_ERR_MEMORY;
    }
    if (size > 0) {
        *workspace = memory;
        gmi_workspace_init(*workspace, &mesh->elastic->law);
    }
    return GM_OK;
}

int gm_mesh_elastic_stiffness(const gm_mesh *mesh, gm_mesh_stiffness *stiffness) {
    if (stiffness == NULL) {
        return GM_ERR_NULL;
    }

    /* NaN unless there is an answer. */
    const double nan = gmi_nan();
    const gm_mesh_stiffness none = {nan, nan, nan, nan, nan, nan};
    *stiffness = none;
    if (mesh == NULL) {
        return GM_ERR_NULL;
    }

    /* Known since the mesh was prepared. */
    if (mesh->elastic == NULL) {
        return GM_ERR_PARAMETER;
    }
    *stiffness = mesh->elastic->stiffness;
    return GM_OK;
}

const gm_pair *gm_mesh_pair(const gm_mesh *mesh) {
    return mesh == NULL ? NULL : mesh->pair;
}

double gm_mesh_clearance(const gm_mesh *mesh, int side) {
    if (mesh == NULL || (side != GM_DRIVE && side != GM_COAST)) {
        return gmi_nan();
    }
    return 0.5 * mesh->engagement.backlash - mesh->side[side].peak -
           gmi_side_sign(side) * mesh->engagement.offset_shift;
}

int gm_mesh_use_cache(gm_mesh *mesh, gm_cache *cache) {
    if (mesh == NULL) {
        return GM_ERR_NULL;
    }
    if (cache != NULL && cache->mesh != mesh) {
        return GM_ERR_PARAMETER;
    }
    mesh->cache = cache;
    set_kind(mesh);
    return GM_OK;
}

/* ---------------------------------------------------------------------------------------------
 * In a pose of its own
 * ------------------------------------------------------------------------------------------- */

static gm_pose both_poses(const gm_pose *a, const gm_pose *b) {
    const gm_pose both = {a->center_distance_change + b->center_distance_change,
                          a->offset + b->offset, a->axial_shift + b->axial_shift, a->skew + b->skew,
                          a->inclination + b->inclination};
    return both;
}

static int move_mesh(const gm_mesh *mesh, const gm_pose *pose, gm_mesh *moved) {
    const gm_pose both = both_poses(&mesh->pose, pose);
    *moved = *mesh;
    moved->cache = NULL;

    /* The gears in the pose, and their corners. */
    const int status = gmi_engagement_find(mesh->pair, &both, &moved->engagement);
    if (status != GM_OK) {
        return status;
    }
    moved->engagement.is_tilted = moved->engagement.is_tilted && knows_tilts(mesh);
    if (mesh->has_corners && !gmi_corners_init(mesh->pair, &moved->engagement, moved->corners)) {
        return GM_POSE_OUT_OF_MESH;
    }

    /* The pitch point and both sides follow. */
    if (mesh->friction.is_on) {
        gmi_friction_place(mesh->pair, &moved->engagement, &moved->friction);
    }

    /* Which evaluation it has now, and where its sides begin and end. */
    set_kind(moved);
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        gmi_side_move(&moved->side[side], mesh->pair, &moved->engagement, side);
    }
    return GM_OK;
}

static int is_finite_pose(const gm_pose *pose) {
    return gmi_is_finite(pose->center_distance_change + pose->offset + pose->axial_shift) &&
           gmi_is_finite(pose->skew + pose->inclination);
}

/* Speeds are bounded as those of angles are. */
static int check_rate(const gm_pose *rate) {
    if (gmi_is_at_rest(rate)) {
        return GM_OK;
    }
    if (!is_finite_pose(rate)) {
        return GM_STATE_NOT_FINITE;
    }
    const double largest =
        fmax(fmax(fabs(rate->center_distance_change), fabs(rate->offset)),
             fmax(fabs(rate->axial_shift), fmax(fabs(rate->skew), fabs(rate->inclination))));
    return largest <= GMI_LARGEST_SPEED ? GM_OK : GM_STATE_OUT_OF_RANGE;
}

int gmi_mesh_follow(const gm_mesh *mesh, const gm_motion *motion, gm_mesh *moved,
                    gm_position *position, gmi_rates rates[2]) {
    int status = check_rate(&motion->pose_rate);
    if (status == GM_OK) {
        status = move_mesh(mesh, &motion->pose, moved);
    }
    if (status != GM_OK) {
        return status;
    }
    *position = gmi_mesh_posed(moved, &motion->position);
    gmi_rates_find(mesh->pair, &moved->engagement, position->offset_rate, &motion->pose_rate,
                   rates);
    if (moved->model == GM_MODEL_SIMPLE) {
        rates[GM_DRIVE].along = rates[GM_DRIVE].across = 0.0; /* it knows no tilts */
        rates[GM_COAST].along = rates[GM_COAST].across = 0.0;
        return gmi_check_offset(position->offset, position->offset_rate);
    }
    return gmi_check_position(moved->pair, position);
}
