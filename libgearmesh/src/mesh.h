/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The prepared mesh, and what is asked of it as a whole: sums of its sides, evaluations, where it follows a motion. */
#ifndef GEARMESH_MESH_H
#define GEARMESH_MESH_H

#include "contact.h"
#include "corner.h"
#include "friction.h"
#include "internal.h"
#include "law.h"
#include "meshing.h"
#include "penetration.h"
#include "side_tangent.h"

struct gm_mesh {
    const gm_pair *pair;       /* as drawn */
    gm_pose pose;              /* that it was prepared in */
    gmi_engagement engagement; /* as posed */
    int is_posed;
    gmi_side side[2]; /* GM_DRIVE, GM_COAST */
    int model;        /* enum gm_model */
    int is_special;   /* it has a cache, friction, corners, or teeth that bend */
    int is_plain;     /* 3D and nothing of that, on parallel axes as drawn */
    gmi_law law;
    const struct gmi_elastic_mesh *elastic; /* NULL = constant stiffness */
    gmi_friction friction;
    double contact_compliance; /* 1 / E* = sum of (1 - nu^2) / E of both gears (m2/N) */
    gm_cache *cache;           /* NULL = exact */
    int has_corners;           /* lines go on beyond the path of contact */
    gmi_corner corners[2];     /* [enum gm_role] whose tip it is; set where it has them */
};

/* penetration.c: the sums of one side of a mesh. */

/* The energy of one side with constant stiffness, K / 2 times the integral of the overlap squared (J). */
double gmi_side_energy(const gm_mesh *mesh, int side, const gm_position *position);

/* The sum of a side with its friction, at a speed of approach that is the same all over it. */
void gmi_side_sum_sliding(const gm_mesh *mesh, int side, const gm_position *position,
                          double approach_speed, const gmi_sliding *sliding, gmi_side_sum *total,
                          gmi_rubbing *rubbing);

/*
 * Sum of a side with first moments, derivatives of the sum by origin and delta, and the tangent of its force, of rates that
 * are set in it; sliding: NULL = without friction, and rubbing and rubbing_by too.
 */
void gmi_side_sum_tangent(const gm_mesh *mesh, int side, const gm_position *position,
                          const gmi_sliding *sliding, gmi_side_sum *total,
                          gmi_side_tangent *tangent, gmi_rubbing *rubbing,
                          gmi_rubbing_by *rubbing_by);

/* All of enum gm_wanted. */
enum { GMI_WANT_ALL = GM_WANT_DERIVATIVES | GM_WANT_WRENCH | GM_WANT_PAIRS | GM_WANT_ENERGY };

/* As gm_mesh_evaluate_at() without the cache, of a position that has been checked and posed. GM_OK or GM_NO_CONVERGENCE. */
int gmi_mesh_evaluate_exact(const gm_mesh *mesh, const gm_position *position, int wanted,
                            gm_workspace *workspace, gm_mesh_result *result);
void gmi_mesh_result_set_nan(gm_mesh_result *result);

/*
 * The same mesh with its wheel in the pose of a motion too and without a cache, where it is then, and how fast the flanks
 * approach each other. Returns GM_OK, or a status of what is wrong with the motion.
 */
int gmi_mesh_follow(const gm_mesh *mesh, const gm_motion *motion, gm_mesh *moved,
                    gm_position *position, gmi_rates rates[2]);

/* The position in the coordinates of the posed pair. */
static inline gm_position gmi_mesh_posed(const gm_mesh *mesh, const gm_position *position) {
    gm_position posed = *position;
    posed.offset += mesh->engagement.offset_shift;
    posed.phase += mesh->engagement.phase_shift;
    return posed;
}

/*
 * Whether one walk tells of many depths: flanks between parallel axes that have tables where they touch, with teeth of a
 * constant stiffness.
 */
static inline int gmi_side_has_depths(const gm_mesh *mesh, int side) {
    const gmi_side *prepared = &mesh->side[side];
    return mesh->model != GM_MODEL_SIMPLE && mesh->elastic == NULL && !mesh->has_corners &&
           mesh->pair->face_advance != 0.0 && prepared->ramps == 0 && !prepared->is_tilted &&
           !prepared->starts_deeper && (prepared->pinion != NULL || prepared->wheel != NULL);
}

#endif
