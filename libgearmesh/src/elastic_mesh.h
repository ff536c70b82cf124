/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Elastic teeth as the law of a mesh: from pair, pose and flanks to what elastic.h solves, and back to the sums of a side
 * that mesh.c makes forces of.
 */
#ifndef GEARMESH_ELASTIC_MESH_H
#define GEARMESH_ELASTIC_MESH_H

#include "contact.h"
#include "corner.h"
#include "elastic.h"
#include "friction.h"
#include "internal.h"
#include "mesh.h"
#include "meshing.h"
#include "wide.h"

/* ---------------------------------------------------------------------------------------------
 * Corner contact: elastic_corner.c
 * ------------------------------------------------------------------------------------------- */

/* The tip edge of one gear. */
typedef struct gmi_elastic_tip {
    gmi_corner corner;
    double curvature; /* gap'' at the end of the path (1/m) */
    double farthest;  /* roll up to which it is followed (m) */
    double fading;    /* roll on which the flank goes over into the edge (m) */
    double logarithm; /* of the curvature of edge and flank over that of both flanks */
    double blunt;     /* its inverse: the factor of the contact law's rate under the edge */
} gmi_elastic_tip;

/* Those of both gears at one engagement, [enum gm_role]. */
typedef struct gmi_elastic_tips {
    gmi_elastic_tip tip[2];
} gmi_elastic_tips;

/* tip_rounding: radius of the edges in modules. 0 where a tip has no flank to touch. */
int gmi_elastic_tips_init(const gm_pair *pair, const gmi_engagement *at, double tip_rounding,
                          gmi_elastic_tips *tips);

/* How far lines have to go on below and above the path; peak: most material of both flanks (m). */
double gmi_elastic_tips_below(const gmi_elastic_tips *tips, double approach, double peak);
double gmi_elastic_tips_above(const gmi_elastic_tips *tips, double approach, double peak);

typedef struct gmi_elastic_gap {
    double value, by_roll, by_roll_twice; /* (m, 1, 1/m) */
} gmi_elastic_gap;

/* What an edge does at a point. */
typedef struct gmi_elastic_edge {
    gmi_elastic_gap gap;
    int enters;          /* the wheel's, whose roll grows with x */
    double rate_factor;  /* of the contact law's rate */
    double rate_by_roll; /* ln of it, along rho_p (1/m) */
} gmi_elastic_edge;

/* begin, end: of the path; roll, beyond: as gmi_elastic_work; approach: x of the rigid flanks (m). */
gmi_elastic_edge gmi_elastic_edge_at(const gmi_elastic_tips *tips, double approach, double begin,
                                     double end, double roll, double beyond);

/*
 * Adds the edges to deviations and rates of all points, and fills work->entry_slope and work->entry_curvature. Returns
 * whether there are wheel's edges among them. peak: as above.
 */
int gmi_elastic_edges_add(const gmi_elastic *law, const gmi_elastic_tips *tips, double approach,
                          double peak, gmi_elastic_work *work);
#if GMI_HAS_WIDE
int gmi_wide_edges_add(const gmi_elastic *law, const gmi_elastic_tips *tips, double approach,
                       double peak, gmi_elastic_work *work);
#endif

/* ---------------------------------------------------------------------------------------------
 * The law of a mesh
 * ------------------------------------------------------------------------------------------- */

/* The law of one mesh; both sides share it, as the coast side is the drive side in a mirror. */
typedef struct gmi_elastic_mesh {
    gmi_elastic law;
    const double *tooth_stiffness[2]; /* [enum gm_role][teeth] factors, NULL = 1 */
    double body_compliance;      /* wind-up of both bodies between bore and root, in series (m/N) */
    int has_corners;             /* whether lines go on beyond the path */
    double tip_rounding;         /* in modules */
    double usual_approach;       /* x at the reference torque, roughly (m) */
    gmi_elastic_tips tips;       /* as prepared */
    gm_mesh_stiffness stiffness; /* at the reference torque, between ideal flanks */
} gmi_elastic_mesh;

/* Lines of contact that there are, and some beside them that may touch. */
enum { GMI_ELASTIC_NUMBERS_MAX = GMI_ELASTIC_LINES_MAX + 4 };

struct gm_workspace {
    gmi_elastic_work side[2]; /* GM_DRIVE, GM_COAST */

    /* [side][enum gm_role] of the teeth of the lines last placed, from the first number on; 1 = whole */
    double softness[2][2][GMI_ELASTIC_NUMBERS_MAX];
};

/* The first field of elastic teeth at fault; NULL if all is well. */
const char *gmi_elastic_field_at_fault(const gm_mesh_params *params, const char **wanted);

size_t gmi_workspace_size(const gmi_elastic *law);
void gmi_workspace_init(gm_workspace *workspace, const gmi_elastic *law);

/* Bytes of the law with what its preparation needs; 0 where the pair has too many lines at once. */
size_t gmi_elastic_mesh_size(const gm_mesh_params *params, const gm_pair *pair);

/*
 * Prepares the law in that memory. GM_OK or GM_ERR_GEOMETRY, with the field of gm_mesh_params or gm_pair_params at fault and
 * what would be right, both constant strings; NULL: not wanted.
 */
int gmi_elastic_mesh_init(gmi_elastic_mesh *made, const gm_mesh_params *params, const gm_pair *pair,
                          const gmi_engagement *at, const char **field, const char **requirement);

/* What the flanks of the mesh want of its law: room for their creases, and stations where 0 are given. */
void gmi_elastic_mesh_take_flanks(gmi_elastic_mesh *made, const gm_mesh *mesh, int stations);

/*
 * elastic_stations.c: whatever the gears, a mesh is about as stiff per face width as a tenth of their modulus. So x (m) at a
 * force per width, and the force that is to be carried: at the reference torque, or 100 N/mm.
 */
double gmi_elastic_usual_approach(const gm_mesh_params *params, double force_per_width);
double gmi_elastic_usual_force(const gm_mesh_params *params, const gm_pair *pair);

/* Stations for the pair and the flanks of a mesh. */
int gmi_elastic_stations_of(const gm_mesh *mesh, double usual_approach);

/* The tips of the gears as they stand: as prepared, or found anew in a pose of this call. 0: lines end with the path. */
int gmi_elastic_tips_of(const gm_mesh *mesh, gmi_elastic_tips *tips);

/* Whether the teeth of a gear are not all as stiff. */
static inline int gmi_elastic_is_uneven(const gm_mesh *mesh, int role) {
    return mesh->elastic != NULL && mesh->elastic->tooth_stiffness[role] != NULL;
}

/*
 * elastic_material.c: deviations of both flanks at all points of a side as placed, with their slopes; teeth: those of
 * line lines->first.
 */
void gmi_elastic_set_material(const gm_mesh *mesh, int side, const gmi_lines *lines,
                              const gmi_teeth *teeth, gmi_elastic_work *work);
#if GMI_HAS_WIDE
void gmi_wide_set_material(const gm_mesh *mesh, int side, const gmi_lines *lines,
                           const gmi_teeth *teeth, gmi_elastic_work *work);
#endif

/*
 * The sums of one side by the law of the mesh, without its cache; elastic teeth need the workspace. Theirs are what a mesh of
 * constant stiffness K (the law's, of one pair of teeth) has to overlap for the same force: sum = F / K,
 * contact = dF/dx / K. GM_OK, GM_STATE_OUT_OF_RANGE (more lines than there is room for), GM_NO_CONVERGENCE.
 */
int gmi_side_sum_by_law(const gm_mesh *mesh, int side, const gm_position *position, int wanted,
                        gm_workspace *workspace, gmi_side_sum *total);

/*
 * Adds to force_by[count] the derivatives of the net force by what is added to the flanks of one side: as
 * gm_mesh_force_by_flanks(), of a position that has been checked and posed.
 */
int gmi_elastic_side_by_flanks(const gm_mesh *mesh, int side, const gm_position *position,
                               const gm_flanks **pinion_changes, const gm_flanks **wheel_changes,
                               int count, gm_workspace *workspace, double *force_by);

/* Energy of one side with its bodies, from its last sum in that workspace (J). */
double gmi_elastic_energy(const gm_mesh *mesh, int side, const gmi_side_sum *total,
                          const gm_workspace *workspace);

/*
 * elastic_friction.c: friction of one side, from its last sum in that workspace; mask: of that sum, derivatives with it.
 */
void gmi_elastic_friction(const gm_mesh *mesh, int side, double approach_speed,
                          const gmi_sliding *sliding, const gmi_side_sum *total, int mask,
                          gm_workspace *workspace, gmi_friction_sum *friction);

#endif
