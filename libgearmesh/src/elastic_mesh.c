/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Elastic teeth as the law of a mesh. Lines of contact are those of contact.c between flanks that just touch: what elastic
 * teeth give way by does not move the path. Deviations of the flanks, tilted axes and pitch act as material at the points
 * of each line.
 */
#include "elastic_mesh.h"

#include "contact.h"
#include "corner.h"
#include "elastic.h"
#include "internal.h"
#include "mesh.h"
#include "meshing.h"
#include "penetration.h"
#include "surface.h"
#include "tilt.h"
#include "tooth_compliance.h"

#include <math.h>
#include <string.h>

enum {
    STIFFNESS_POSITIONS = 32, /* of the mesh cycle, at which the mean stiffness is taken */
    LOAD_STEPS_MAX = 40,      /* until the force is found */
};

/* Force and wind-up of the bodies agree to this part of the force, where steps stop. */
static const double force_accuracy = 1e-12;

/* ---------------------------------------------------------------------------------------------
 * Preparing
 * ------------------------------------------------------------------------------------------- */

static int is_modulus(double value) {
    return value >= GMI_ELASTIC_LEAST_MODULUS && value <= GMI_ELASTIC_LARGEST_MODULUS;
}

static int is_ratio(double value) {
    return value >= 0.0 && value <= GMI_ELASTIC_LARGEST_RATIO;
}

/* Of a bore that is not given, or of one that is above 0: against the root radius the pair is needed. */
static int is_bore(double radius) {
    return isnan(radius) || (radius >= GMI_SMALLEST_LENGTH && radius <= GMI_LARGEST_LENGTH);
}

const char *gmi_elastic_field_at_fault(const gm_mesh_params *params, const char **wanted) {
    const struct {
        const char *field;
        int is_right;
        const char *wanted;
    } checks[] = {
        /* Materials and bodies. */
        {"pinion_youngs_modulus", is_modulus(params->pinion_youngs_modulus),
         "a modulus from 1e6 to 1e15 N/m2"},
        {"wheel_youngs_modulus", is_modulus(params->wheel_youngs_modulus),
         "a modulus from 1e6 to 1e15 N/m2"},
        {"pinion_poisson_ratio", is_ratio(params->pinion_poisson_ratio), "a ratio from 0 to 0.499"},
        {"wheel_poisson_ratio", is_ratio(params->wheel_poisson_ratio), "a ratio from 0 to 0.499"},
        {"pinion_bore_radius", is_bore(params->pinion_bore_radius), "a radius from 1e-6 to 1e9 m"},
        {"wheel_bore_radius", is_bore(params->wheel_bore_radius), "a radius from 1e-6 to 1e9 m"},

        /* The load that stiffness is stated at, edges, and the grid along the face. */
        {"reference_torque",
         isnan(params->reference_torque) ||
             (params->reference_torque > 0.0 && gmi_is_finite(params->reference_torque)),
         "a torque above 0 N m"},
        {"tip_rounding", params->tip_rounding >= 0.001 && params->tip_rounding <= 1.0,
         "a radius from 0.001 to 1 modules"},
        {"stations",
         params->stations == 0 ||
             (params->stations >= 2 && params->stations <= GMI_ELASTIC_STATIONS_MAX),
         "a whole number from 2 to 97, or 0: as gm_elastic_stations() says"},
    };

    /* The first that is wrong. */
    for (size_t k = 0; k < sizeof checks / sizeof checks[0]; ++k) {
        if (!checks[k].is_right) {
            *wanted = checks[k].wanted;
            return checks[k].field;
        }
    }
    return NULL;
}

/* The workspace, and behind it the arrays of both sides. */
size_t gmi_workspace_size(const gmi_elastic *law) {
    return sizeof(gm_workspace) +
           2 * gmi_elastic_work_size(law->stations, law->lines_max, law->creases_max);
}

void gmi_workspace_init(gm_workspace *workspace, const gmi_elastic *law) {
    unsigned char *memory = (unsigned char *)(workspace + 1);
    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        gmi_elastic_work_init(&workspace->side[side], law->stations, law->lines_max,
                              law->creases_max, memory);
        memory += gmi_elastic_work_size(law->stations, law->lines_max, law->creases_max);
    }
}

static int is_with_corners(const gm_mesh_params *params) {
    return params->law == GM_LAW_ELASTIC && params->corner_contact != GM_CORNER_OFF;
}

/* Lines that go on beyond the path at both ends are one more at most. */
static int lines_of(const gm_mesh_params *params, const gm_pair *pair) {
    return gmi_elastic_lines(pair->total_contact_ratio) + is_with_corners(params);
}

static int stations_of(const gm_mesh_params *params, const gm_pair *pair) {
    return params->stations != 0 ? params->stations : gm_elastic_stations(pair);
}

size_t gmi_elastic_mesh_size(const gm_mesh_params *params, const gm_pair *pair) {
    const size_t work = gmi_elastic_work_size(stations_of(params, pair), lines_of(params, pair), 0);
    return work == 0 ? 0 : sizeof(gmi_elastic_mesh) + sizeof(gmi_elastic_work) + work;
}

static gmi_elastic_gear_params gear_params(const gm_gear *gear, const gmi_engagement *at, int role,
                                           double youngs_modulus, double poisson_ratio) {
    const gmi_elastic_gear_params params = {
        .teeth = gear->sign * (double)gear->teeth,
        .profile_shift = gear->profile_shift,
        .normal_thickness = gear->normal_thickness,
        .rack_dedendum = gear->rack_dedendum,
        .rack_fillet_radius = gear->rack_fillet_radius,
        .youngs_modulus = youngs_modulus,
        .poisson_ratio = poisson_ratio,
        .start_roll_length = at->start_roll_length[role],
        .tip_roll_length = gear->sign * gear->tip_roll_length,
    };
    return params;
}

static int refuse(const char *at_fault, const char *wanted, const char **field,
                  const char **requirement) {
    if (field != NULL) {
        *field = at_fault;
    }
    if (requirement != NULL) {
        *requirement = wanted;
    }
    return 0;
}

/* Why a tooth has no compliance, in the words of a drawing; [enum gm_role]. */
static void explain(int fault, int role, const char **field, const char **requirement) {
    /* Of the drawing's numbers the one that most likely has to change ... */
    static const char *const fields[][2] = {
        [GMI_TOOTH_FINE] = {"pinion_teeth", "wheel_teeth"},
        [GMI_TOOTH_FILLET] = {"pinion_rack_fillet_radius", "wheel_rack_fillet_radius"},
        [GMI_TOOTH_UNDERCUT] = {"pinion_profile_shift", "wheel_profile_shift"},
        [GMI_TOOTH_FOOT] = {"pinion_rack_fillet_radius", "wheel_rack_fillet_radius"},
        [GMI_TOOTH_CONTACT] = {"pinion_start_radius", "wheel_start_radius"},
        [GMI_TOOTH_POINTED] = {"pinion_tip_radius", "wheel_tip_radius"},
        [GMI_TOOTH_SPACE] = {"pinion_rack_fillet_radius", "wheel_rack_fillet_radius"},
    };

    /* ... and what would be right. */
    static const char *const requirements[] = {
        [GMI_TOOTH_FINE] = "teeth that give way by more than the rim under them",
        [GMI_TOOTH_FILLET] = "a rounding that fits between the rack's flanks: up to "
                             "(pi/4 - h_fP tan(alpha_n)) cos(alpha_n) / (1 - sin(alpha_n))",
        [GMI_TOOTH_UNDERCUT] = "a shift that leaves the teeth without undercut",
        [GMI_TOOTH_FOOT] = "a rounding with a tangent of 30 degrees (ring: 60) at the foot",
        [GMI_TOOTH_CONTACT] = "contact above the end of the root fillet: a deeper rack, or less "
                              "addendum of the mate",
        [GMI_TOOTH_POINTED] = "a tip below the point where the flanks meet",
        [GMI_TOOTH_SPACE] = "a rounding that fits into the spaces of the ring",
    };
    (void)refuse(fields[fault][role], requirements[fault], field, requirement);
}

/*
 * Wind-up of a disc between bore and root circle under a torque, along the line of action:
 * r_b^2 / (4 pi G b) (1 / r_bore^2 - 1 / r_f^2), from the shear stress T / (2 pi r^2 b).
 */
static double wind_up(const gm_gear *gear, double bore_radius, double youngs_modulus,
                      double poisson_ratio) {
    if (isnan(bore_radius)) {
        return 0.0;
    }
    const double shear_modulus = 0.5 * youngs_modulus / (1.0 + poisson_ratio);
    const double r_b = gear->base_radius;
    const double r_f = gear->root_radius;
    return r_b * r_b / (4.0 * GMI_PI * shear_modulus * gear->face_width) *
           (1.0 / (bore_radius * bore_radius) - 1.0 / (r_f * r_f));
}

/* What is wrong with bores and factors, which only the pair can tell. */
static int is_given_well(const gm_mesh_params *params, const gm_pair *pair, const char **field,
                         const char **requirement) {
    const struct {
        const char *bore_field, *factor_field;
        const gm_gear *gear;
        double bore;
        const double *factors;
    } given[2] = {{"pinion_bore_radius", "pinion_tooth_stiffness", &pair->pinion,
                   params->pinion_bore_radius, params->pinion_tooth_stiffness},
                  {"wheel_bore_radius", "wheel_tooth_stiffness", &pair->wheel,
                   params->wheel_bore_radius, params->wheel_tooth_stiffness}};
    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        /* A bore lies in the body below the teeth, which a ring has not. */
        if (given[role].gear->sign < 0.0 && !isnan(given[role].bore)) {
            return refuse(given[role].bore_field, "none: a ring has no bore below its teeth", field,
                          requirement);
        }
        if (given[role].bore >= given[role].gear->root_radius) {
            return refuse(given[role].bore_field, "a bore below the root circle", field,
                          requirement);
        }

        /* Teeth that are softer or stiffer than the others. */
        for (int k = 0; given[role].factors != NULL && k < given[role].gear->teeth; ++k) {
            if (!(given[role].factors[k] >= 0.01 && given[role].factors[k] <= 100.0)) {
                return refuse(given[role].factor_field, "factors from 0.01 to 100", field,
                              requirement);
            }
        }
    }
    return 1;
}

/*
 * Where lines are cut beyond the path: where the edge would leave the flank at that x if the teeth gave way by nothing more
 * than x. Fixed, so that the cuts move with the lines alone; under other loads they lie elsewhere on what the edge bears.
 */
static void set_cuts(const gmi_elastic_tips *tips, double approach, double cut[2]) {
    cut[0] = 0.85 * sqrt(2.0 * approach / tips->tip[GM_WHEEL].curvature);
    cut[1] = 0.85 * sqrt(2.0 * approach / tips->tip[GM_PINION].curvature);
}

static void find_stiffness(gmi_elastic_mesh *made, const gm_pair *pair, const gmi_engagement *at,
                           double force, gmi_elastic_work *work);

int gmi_elastic_mesh_init(gmi_elastic_mesh *made, const gm_mesh_params *params, const gm_pair *pair,
                          const gmi_engagement *at, const char **field, const char **requirement) {
    const double face = (at->face_to - at->face_from) * pair->face_width;
    const gmi_elastic_params law = {
        .normal_module = pair->normal_module,
        .normal_pressure_angle = pair->normal_pressure_angle,
        .helix_angle = pair->helix_angle,
        .base_helix_angle = pair->base_helix_angle,
        .face_width = face,
        .line_of_action = at->line_of_action,
        .stations = stations_of(params, pair),
        .lines = lines_of(params, pair),
        .gear = {gear_params(&pair->pinion, at, GM_PINION, params->pinion_youngs_modulus,
                             params->pinion_poisson_ratio),
                 gear_params(&pair->wheel, at, GM_WHEEL, params->wheel_youngs_modulus,
                             params->wheel_poisson_ratio)},
    };

    /* Where contact begins on each gear. */
    const double contact_start[2] = {
        fmax(at->start_roll_length[GM_PINION], at->line_of_action - at->tip_roll_length[GM_WHEEL]),
        fmax(at->start_roll_length[GM_WHEEL], at->line_of_action - at->tip_roll_length[GM_PINION])};

    if (!is_given_well(params, pair, field, requirement)) {
        return GM_ERR_GEOMETRY;
    }

    int fault;
    int role;
    const int status = gmi_elastic_init(&made->law, &law, contact_start, &fault, &role);
    if (status != GM_OK) {
        explain(fault, role, field, requirement);
        return GM_ERR_GEOMETRY;
    }

    made->tooth_stiffness[GM_PINION] = params->pinion_tooth_stiffness;
    made->tooth_stiffness[GM_WHEEL] = params->wheel_tooth_stiffness;
    made->body_compliance = 0.0;

    /* A tip that reaches too deep has no flank to touch beyond the path. */
    made->tip_rounding = params->tip_rounding;
    made->has_corners = is_with_corners(params) &&
                        gmi_elastic_tips_init(pair, at, params->tip_rounding, &made->tips);

    /* The scale of forces: stiffness at the torque that is to be carried, or at 100 N/mm. */
    const double force = gmi_elastic_usual_force(params, pair);
    made->usual_approach = gmi_elastic_usual_approach(params, force / face);
    gmi_elastic_work *work = (gmi_elastic_work *)(made + 1);
    gmi_elastic_work_init(work, law.stations, law.lines, 0, work + 1);
    find_stiffness(made, pair, at, force, work);

    /* Which is that of the teeth; bodies come on top. */
    made->body_compliance = wind_up(&pair->pinion, params->pinion_bore_radius,
                                    params->pinion_youngs_modulus, params->pinion_poisson_ratio) +
                            wind_up(&pair->wheel, params->wheel_bore_radius,
                                    params->wheel_youngs_modulus, params->wheel_poisson_ratio);
    return GM_OK;
}

void gmi_elastic_mesh_take_flanks(gmi_elastic_mesh *made, const gm_mesh *mesh, int stations) {
    const int drive = mesh->side[GM_DRIVE].ramps, coast = mesh->side[GM_COAST].ramps;
    made->law.creases_max = drive > coast ? drive : coast;

    /* The stiffness between ideal flanks is found: from now on on as many stations as these want. */
    if (stations == 0) {
        const gm_pair *pair = mesh->pair;
        gmi_elastic_divide(&made->law, pair->normal_module, pair->helix_angle,
                           gmi_elastic_stations_of(mesh, made->usual_approach));
    }
}

/* ---------------------------------------------------------------------------------------------
 * Lines of a mesh
 * ------------------------------------------------------------------------------------------- */

/* One side at one position, as the elastic law sees it. */
typedef struct side_view {
    const gm_mesh *mesh;
    const gmi_elastic_mesh *elastic;
    int side;
    double approach;       /* x of the rigid flanks (m) */
    gmi_lines lines;       /* between flanks that just touch */
    gmi_teeth teeth;       /* of line lines.first */
    double gain;           /* of x between tilted axes (1) */
    gmi_elastic_tips tips; /* of lines that go on beyond the path */
    int has_tips;
    double (*softness)[GMI_ELASTIC_NUMBERS_MAX]; /* [enum gm_role] of the workspace */
} side_view;

static void set_softness(side_view *view, int count) {
    const gm_pair *pair = view->mesh->pair;
    const int all[2] = {pair->pinion.teeth, pair->wheel.teeth};
    int tooth[2] = {view->teeth.pinion, view->teeth.wheel};
    for (int k = 0; k < count; ++k) {
        for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
            const double *factors = view->elastic->tooth_stiffness[role];
            view->softness[role][k] = factors == NULL ? 1.0 : 1.0 / factors[tooth[role]];
            tooth[role] = gmi_surface_tooth(tooth[role], view->teeth.step, all[role]);
        }
    }
}

int gmi_elastic_tips_of(const gm_mesh *mesh, gmi_elastic_tips *tips) {
    const gmi_elastic_mesh *elastic = mesh->elastic;
    const gmi_engagement *at = &mesh->engagement;
    *tips = elastic->tips;
    const gmi_corner *pinion = &elastic->tips.tip[GM_PINION].corner;
    const gmi_corner *wheel = &elastic->tips.tip[GM_WHEEL].corner;
    const int is_prepared = pinion->line_of_action == at->line_of_action &&
                            pinion->tip_roll == at->tip_roll_length[GM_PINION] &&
                            wheel->tip_roll == at->tip_roll_length[GM_WHEEL];
    return elastic->has_corners &&
           (is_prepared || gmi_elastic_tips_init(mesh->pair, at, elastic->tip_rounding, tips));
}

/* Where the linear reliefs of both flanks begin, on the face and in rho_p; returns how many. */
static int find_creases(const gm_mesh *mesh, int side, gmi_elastic_work *work) {
    const gmi_engagement *at = &mesh->engagement;
    int count = 0;
    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        const gmi_surface_gear gear = gmi_surface_gear_of(mesh, side, role, at->line_of_action);
        const int ramps = gear.tables == NULL ? 0 : gear.tables->ramp_count;
        for (int k = 0; k < ramps && count < work->creases_max; ++k) {
            const gmi_surface_plane plane = gmi_surface_plane_of(
                &gear, &gear.tables->ramps[k], at->face_from, 1.0 / mesh->pair->face_width);
            const gmi_elastic_crease crease = {plane.from, plane.per_place, plane.per_roll};
            work->crease[count++] = crease;
        }
    }
    return count;
}

/* Where the lines are; GM_STATE_OUT_OF_RANGE for more of them than there is room for. */
static int place(side_view *view, const gm_position *position, int wanted, gmi_elastic_work *work) {
    const gm_mesh *mesh = view->mesh;
    const gm_pair *pair = mesh->pair;
    const gmi_engagement *at = &mesh->engagement;
    const gmi_elastic *law = &view->elastic->law;

    /* Lines are those of flanks that just touch: what the teeth give way by does not move them. */
    gm_position touching = *position;
    touching.offset = gmi_side_sign(view->side) * 0.5 * at->backlash;
    gmi_lines_find(pair, at, view->side, &touching, &view->lines);
    view->approach = gmi_ideal_penetration(at, view->side, position->offset);
    view->gain = at->is_tilted ? gmi_tilt_gain(pair, at, view->side) : 1.0;

    /* Tip edges carry them on beyond the path. */
    double below = 0.0, above = 0.0;
    double lower = view->lines.lower, upper = view->lines.upper;
    view->has_tips = gmi_elastic_tips_of(mesh, &view->tips);
    if (view->has_tips) {
        const double peak = mesh->side[view->side].peak;
        below = gmi_elastic_tips_below(&view->tips, view->approach, peak);
        above = gmi_elastic_tips_above(&view->tips, view->approach, peak);
        lower = at->line_of_action - at->tip_roll_length[GM_WHEEL];
        upper = at->tip_roll_length[GM_PINION];
        gmi_lines_widen(pair, lower - below, upper + above, &view->lines);
    }
    view->teeth = gmi_lines_teeth(pair, view->side, &touching, &view->lines);

    const int count = view->lines.last - view->lines.first + 1;
    if (count > GMI_ELASTIC_NUMBERS_MAX) {
        return GM_STATE_OUT_OF_RANGE;
    }

    /* Softer teeth, where there are any. */
    const int is_even = view->elastic->tooth_stiffness[GM_PINION] == NULL &&
                        view->elastic->tooth_stiffness[GM_WHEEL] == NULL;
    if (!is_even) {
        set_softness(view, count);
    }

    /* The lines of contact between the faces at this position. */
    gmi_elastic_lines_at lines = {
        .origin = view->lines.origin + view->lines.advance * at->face_from,
        .pitch = pair->transverse_base_pitch,
        .climb = view->lines.advance * (at->face_to - at->face_from) / law->face_width,
        .lower = lower,
        .upper = upper,
        .line_of_action = at->line_of_action,
        .goes_on = view->has_tips,
        .below = below,
        .above = above,
        .fading = {view->tips.tip[GM_WHEEL].fading, view->tips.tip[GM_PINION].fading},
        .first = view->lines.first,
        .last = view->lines.last,
        .slopes = wanted & (GMI_DERIVATIVES | GMI_ROLL) ? 1 : 0,
        .tooth = view->teeth.pinion,
        .step = view->teeth.step,
        .teeth = pair->pinion.teeth,
        .pinion_softness = is_even ? NULL : view->softness[GM_PINION],
        .wheel_softness = is_even ? NULL : view->softness[GM_WHEEL],
    };

    /* Where they are cut. */
    if (view->has_tips) {
        set_cuts(&view->tips, view->elastic->usual_approach, lines.cut);
    }
    if (mesh->side[view->side].ramps > 0) {
        lines.crease = work->crease;
        lines.creases = find_creases(mesh, view->side, work);
    }
    return gmi_elastic_place(law, &lines, work);
}

/* ---------------------------------------------------------------------------------------------
 * One evaluation
 * ------------------------------------------------------------------------------------------- */

/*
 * Teeth, and bodies in series: x of both is x of the teeth and the wind-up c F. The force grows with x and bends upwards,
 * so Newton's method converges from above.
 */
static int solve(const gmi_elastic_mesh *elastic, gmi_elastic_work *work, double approach,
                 gmi_elastic_result *result) {
    const double compliance = elastic->body_compliance;
    double x = approach;
    int status = gmi_elastic_solve(&elastic->law, work, x, result);
    for (int step = 0; compliance > 0.0 && status == GM_OK && step < LOAD_STEPS_MAX; ++step) {
        const double excess = x + compliance * result->force - approach;
        if (fabs(excess) <= force_accuracy * fabs(approach)) {
            return GM_OK;
        }
        x -= excess / (1.0 + compliance * result->by_approach);
        status = gmi_elastic_solve(&elastic->law, work, x, result);
        if (status == GM_OK && step == LOAD_STEPS_MAX - 1) {
            status = GM_NO_CONVERGENCE;
        }
    }
    return status;
}

/*
 * d2F/dx2. The balance is a minimum of the energy, and only the contact law is not quadratic in it: so the third derivative
 * of the energy is the sum of W q'' (d gamma / dx)^3, with q'' = q'^3 B / q of the law q (L - ln q) = delta / B. Where a
 * wheel's edge bears load, its gap bends the approach as well: - 3 W q' (d gamma / dx) gap''. d gamma / dx is then what
 * enter() leaves in the derivatives by the deviations.
 */
static double stiffness_by_approach(const gmi_elastic *law, const gmi_elastic_work *work) {
    double sum = 0.0;
    for (int p = 0; p < 2 * work->slots; ++p) {
        const int is_curved = work->load[p] > 0.0 && work->slope[p] < 1.0 && work->weight[p] > 0.0;
        if (is_curved) {
            const double slope = work->stiffness[p] / work->weight[p];
            const double moved =
                work->is_entering ? work->table[2][p] / work->stiffness[p] : work->pull[p];
            sum += work->stiffness[p] * slope * slope * law->hertz_compliance / work->load[p] *
                   moved * moved * moved;
            sum -= work->is_entering ? 3.0 * work->stiffness[p] * moved * work->entry_curvature[p]
                                     : 0.0;
        }
    }
    return sum;
}

/* First moments of the loads, and of the stiffness at the points, over t1 and rho_p. */
static void add_moments(const side_view *view, const gmi_elastic_work *work, double per_stiffness,
                        gmi_side_sum *total) {
    const gm_pair *pair = view->mesh->pair;
    for (int p = 0; p < 2 * work->slots; ++p) {
        const double t1 = view->mesh->engagement.face_from + work->z[p] / pair->face_width;
        const double grows = work->is_entering ? 1.0 - work->entry_slope[p] : 1.0;
        const double sum = work->force[p] * grows * per_stiffness;
        const double contact = work->by_deviation[p] * grows * per_stiffness;
        total->sum_t1 += sum * t1;
        total->sum_rho += sum * work->roll[p];
        total->contact_t1 += contact * t1;
        total->contact_rho += contact * work->roll[p];
    }
}

/* Force of a side, and its derivatives by x of the rigid flanks and by the origin of the lines. */
typedef struct side_force {
    double value, by_approach, by_origin;
} side_force;

/* Whether a wheel's edge that its gap makes slower bears load. */
static int is_entry_loaded(const gmi_elastic_work *work) {
    for (int k = 0; k < work->outer_count[0]; ++k) {
        const int p = work->outer[0][k];
        if (work->entry_slope[p] != 0.0 && work->load[p] > 0.0) {
            return 1;
        }
    }
    return 0;
}

/* Sum of the products of two arrays at the points that a wheel's edge may touch. */
static double sum_entering(const gmi_elastic_work *work, const double *first,
                           const double *second) {
    double sum = 0.0;
    for (int k = 0; k < work->outer_count[0]; ++k) {
        const int p = work->outer[0][k];
        sum += first[p] * second[p];
    }
    return sum;
}

/*
 * Bodies in series, of compliance c: x of the teeth is x_t with c F_t = x - x_t, F_t = sum W q. Where the gap of an edge
 * depends on x itself, F = sum W q (1 - g) is another functional, with an adjoint of its own: F changes by x_t and, at
 * fixed x_t, by x, as the deviations there do by -g and 1 - g by -gap''. rolled: derivatives of F_t.
 */
static side_force enter(const side_view *view, gmi_elastic_work *work,
                        const gmi_elastic_result *result, const gmi_elastic_gradient *rolled) {
    /* The weights 1 - g of the force, and what the teeth's place alone moves. */
    double *grows = work->table[0], *by_deviation = work->table[2];
    for (int p = 0; p < 2 * work->slots; ++p) {
        grows[p] = 1.0 - work->entry_slope[p];
    }
    const double held_teeth = sum_entering(work, work->by_deviation, work->entry_slope);
    const double sharper = sum_entering(work, work->force, work->entry_curvature);

    /* Its adjoint. */
    const gmi_elastic_functional functional = {grows, work->entry_curvature, NULL, NULL};
    gmi_elastic_gradient force;
    gmi_elastic_differentiate_functional(&view->elastic->law, work, &functional, by_deviation,
                                         &force);
    const double held = sum_entering(work, by_deviation, work->entry_slope);

    /* The bodies' share of x. */
    const double compliance = view->elastic->body_compliance;
    const double share = 1.0 / (1.0 + compliance * result->by_approach);
    const double teeth_by_approach = share * (view->gain + compliance * held_teeth);
    const side_force entering = {
        force.value, force.by_approach * teeth_by_approach - held - sharper,
        force.by_roll - force.by_approach * share * compliance * rolled->by_roll};
    return entering;
}

/* Before its lines are known. */
static void view_init(side_view *view, const gm_mesh *mesh, int side, gm_workspace *workspace) {
    *view = (side_view){.mesh = mesh,
                        .elastic = mesh->elastic,
                        .side = side,
                        .softness = workspace->softness[side]};
}

/* Lines, their flanks, and the deflections of all teeth. */
static int balance(side_view *view, const gm_position *position, int wanted, gmi_elastic_work *work,
                   gmi_elastic_result *result) {
    const gm_mesh *mesh = view->mesh;
    int status = place(view, position, wanted, work);
    if (status == GM_OK) {
        gmi_elastic_set_material(mesh, view->side, &view->lines, &view->teeth, work);
        work->is_entering = view->has_tips &&
                            gmi_elastic_edges_add(&view->elastic->law, &view->tips, view->approach,
                                                  mesh->side[view->side].peak, work);
        work->sums_alone = (wanted & GMI_ROLL) &&
                           !(wanted & (GMI_MOMENTS | GMI_CONTACT_DERIVATIVES)) &&
                           !mesh->friction.is_on;
        status = solve(view->elastic, work, view->gain * view->approach, result);
    }
    if (status == GM_NO_CONVERGENCE) {
        /* Once more without what the last balance suggests. */
        gmi_elastic_work_reset(work);
        status = solve(view->elastic, work, view->gain * view->approach, result);
    }
    return status;
}

static int elastic_sum(const gm_mesh *mesh, int side, const gm_position *position, int wanted,
                       gm_workspace *workspace, gmi_side_sum *total) {
    side_view view;
    view_init(&view, mesh, side, workspace);
    gmi_elastic_work *work = &workspace->side[side];
    gmi_elastic_result result;
    const int status = balance(&view, position, wanted, work, &result);
    if (status != GM_OK) {
        return status;
    }

    /* Force and energy by the roll; bodies in series make a change of x smaller. */
    const double share = 1.0 / (1.0 + view.elastic->body_compliance * result.by_approach);
    side_force force = {result.force, view.gain * share * result.by_approach, 0.0};
    work->is_entering = work->is_entering && is_entry_loaded(work);
    gmi_elastic_gradient rolled = {.by_roll = 0.0}, energy = {.by_roll = 0.0};
    if (wanted & (GMI_DERIVATIVES | GMI_ROLL)) {
        /* The sum of the loads is not the force where an edge enters, and bodies alone want to know of it then. */
        const int is_else = work->is_entering && view.elastic->body_compliance == 0.0;
        gmi_elastic_differentiate(&view.elastic->law, work, is_else ? NULL : &rolled, &energy);
        force.by_origin = share * rolled.by_roll;
    }
    if (work->is_entering) {
        force = enter(&view, work, &result, &rolled);
    }

    /* In the measure of the law's stiffness. */
    const double per_stiffness = 1.0 / mesh->law.stiffness;
    total->sum = force.value * per_stiffness;
    total->contact = total->by_delta = force.by_approach * per_stiffness;
    total->by_origin = force.by_origin * per_stiffness;
    total->roll = energy.by_roll * per_stiffness;
    for (int row = 0; row < work->count; ++row) {
        total->pairs += result.line_force[row] > 0.0;
    }
    if (wanted & GMI_CONTACT_DERIVATIVES) {
        total->contact_by_delta = view.gain * view.gain * share * share * share *
                                  stiffness_by_approach(&view.elastic->law, work) * per_stiffness;
    }
    if (wanted & GMI_MOMENTS) {
        add_moments(&view, work, per_stiffness, total);
    }
    return GM_OK;
}

/* Of the teeth as the balance has it, and of the bodies, springs in series that bear the sum of the loads. */
double gmi_elastic_energy(const gm_mesh *mesh, int side, const gmi_side_sum *total,
                          const gm_workspace *workspace) {
    const gmi_elastic_work *work = &workspace->side[side];
    if (!(total->sum > 0.0)) {
        return 0.0; /* clear of each other, and the workspace may be of another position */
    }
    const double load = gmi_elastic_sum(2 * work->slots, work->force);
    return work->energy + 0.5 * mesh->elastic->body_compliance * load * load;
}

int gmi_side_sum_by_law(const gm_mesh *mesh, int side, const gm_position *position, int wanted,
                        gm_workspace *workspace, gmi_side_sum *total) {
    *total = gmi_no_contact();
    if (gmi_side_is_clear(&mesh->engagement, &mesh->side[side], side, position->offset)) {
        return GM_OK;
    }
    if (mesh->elastic != NULL) {
        return elastic_sum(mesh, side, position, wanted, workspace, total);
    }
    gmi_side_sum_3d(mesh->pair, &mesh->engagement, &mesh->side[side], side, position, wanted,
                    total);
    return GM_OK;
}

/* ---------------------------------------------------------------------------------------------
 * Other flanks
 * ------------------------------------------------------------------------------------------- */

/*
 * Derivative of the force by the deviation of each point, in work->by_deviation: of F = sum W q, or where an edge enters of
 * F = sum W q (1 - g), whose adjoint is another one. Bodies of compliance c give way by c times what sum W q grows by.
 */
static void weigh_points(const side_view *view, gmi_elastic_work *work,
                         const gmi_elastic_result *result) {
    const double compliance = view->elastic->body_compliance;
    const double share = 1.0 / (1.0 + compliance * result->by_approach);
    const double *of_force = work->by_deviation;
    double by_approach = result->by_approach;
    work->is_entering = work->is_entering && is_entry_loaded(work);
    if (work->is_entering) {
        const gmi_elastic_gradient unused = {.by_roll = 0.0};
        (void)enter(view, work, result, &unused);
        of_force = work->table[2];
        by_approach = gmi_elastic_sum(2 * work->slots, of_force);
    }
    for (int p = 0; p < 2 * work->slots; ++p) {
        const double yields = by_approach * share * compliance * work->by_deviation[p];
        work->by_deviation[p] = of_force[p] - yields;
    }
}

/* The same mesh with these flanks alone, so that what they have at the points can be read. */
static OWN_STACK double effect_of(const side_view *view, const gm_flanks *pinion,
                                  const gm_flanks *wheel, gmi_elastic_work *work) {
    gm_mesh other = *view->mesh;
    other.engagement.is_tilted = 0;
    gmi_side_init(&other.side[view->side], other.pair, &other.engagement, pinion, wheel,
                  view->side);
    gmi_elastic_set_material(&other, view->side, &view->lines, &view->teeth, work);

    double effect = 0.0;
    for (int p = 0; p < 2 * work->slots; ++p) {
        effect += work->by_deviation[p] * work->deviation[p];
    }
    return effect;
}

int gmi_elastic_side_by_flanks(const gm_mesh *mesh, int side, const gm_position *position,
                               const gm_flanks **pinion_changes, const gm_flanks **wheel_changes,
                               int count, gm_workspace *workspace, double *force_by) {
    if (gmi_side_is_clear(&mesh->engagement, &mesh->side[side], side, position->offset)) {
        return GM_OK;
    }
    side_view view;
    view_init(&view, mesh, side, workspace);
    gmi_elastic_work *work = &workspace->side[side];
    gmi_elastic_result result;
    const int status = balance(&view, position, GMI_SUM, work, &result);
    if (status != GM_OK || !work->touching) {
        return status;
    }

    /* One adjoint for all of them: then each is a sum over the points. */
    weigh_points(&view, work, &result);
    for (int k = 0; k < count; ++k) {
        force_by[k] +=
            gmi_side_sign(side) * effect_of(&view, pinion_changes[k], wheel_changes[k], work);
    }
    return GM_OK;
}

/* ---------------------------------------------------------------------------------------------
 * Stiffness between ideal flanks
 * ------------------------------------------------------------------------------------------- */

/* Lines between ideal flanks at the approach x, with the edges that touch then where tips is not NULL. */
static int place_ideal(const gmi_elastic_mesh *made, const gmi_elastic_lines_at *within,
                       const gmi_elastic_tips *tips, double x, gmi_elastic_work *work) {
    const gmi_elastic *law = &made->law;
    gmi_elastic_lines_at lines = *within;
    const double rise = lines.climb * law->face_width;

    /* Beyond the path as far as the edges touch. */
    if (tips != NULL) {
        lines.goes_on = lines.slopes = 1;
        lines.below = gmi_elastic_tips_below(tips, x, 0.0);
        lines.above = gmi_elastic_tips_above(tips, x, 0.0);
        lines.fading[0] = tips->tip[GM_WHEEL].fading;
        lines.fading[1] = tips->tip[GM_PINION].fading;
        set_cuts(tips, made->usual_approach, lines.cut);
    }

    /* All lines that are there. */
    const double lower = lines.lower - lines.below - lines.origin;
    const double upper = lines.upper + lines.above - lines.origin;
    lines.first = (int)ceil((lower - fmax(rise, 0.0)) / lines.pitch);
    lines.last = (int)floor((upper - fmin(rise, 0.0)) / lines.pitch);
    lines.tooth = (lines.first % lines.teeth + lines.teeth) % lines.teeth;
    const int status = gmi_elastic_place(law, &lines, work);

    /* Ideal flanks have no deviations but the gaps of the edges. */
    const size_t bytes = 2 * sizeof(double) * (size_t)work->slots;
    memset(work->deviation, 0, bytes);
    memset(work->deviation_by_roll, 0, bytes);
    memset(work->deviation_by_z, 0, bytes);
    work->is_entering = tips != NULL && gmi_elastic_edges_add(law, tips, x, 0.0, work);
    return status;
}

/* dF/dx of lines that carry the force, and the place x where they do; NaN where none does. */
static double stiffness_at(const gmi_elastic_mesh *made, const gmi_elastic_lines_at *lines,
                           const gmi_elastic_tips *tips, double force, double *approach,
                           gmi_elastic_work *work) {
    const side_view view = {.elastic = made, .gain = 1.0};
    double x = *approach;
    for (int step = 0; step < LOAD_STEPS_MAX; ++step) {
        gmi_elastic_result result;
        int status = place_ideal(made, lines, tips, x, work);
        if (status != GM_OK || work->count == 0) {
            break;
        }
        status = gmi_elastic_solve(&made->law, work, x, &result);
        side_force found = {result.force, result.by_approach, 0.0};
        if (status == GM_OK && work->is_entering && is_entry_loaded(work)) {
            const gmi_elastic_gradient rolled = {.by_roll = 0.0};
            found = enter(&view, work, &result, &rolled);
        }
        const double missing = force - found.value;
        if (status != GM_OK || fabs(missing) <= 1e-9 * force) {
            *approach = status == GM_OK ? x : *approach;
            return status == GM_OK ? found.by_approach : gmi_nan();
        }

        /* The force bends upwards: a step from above stays above; from no contact the way is doubled. */
        const double next = x + missing / found.by_approach;
        x = next > 0.25 * x && found.by_approach > 0.0 ? next : (missing > 0.0 ? 2.0 : 0.5) * x;
    }
    return gmi_nan();
}

typedef struct spread {
    double sum, smallest, largest;
    int count;
} spread;

static void add_to_spread(spread *values, double value) {
    if (value > 0.0) {
        values->smallest = values->count == 0 ? value : fmin(values->smallest, value);
        values->largest = values->count == 0 ? value : fmax(values->largest, value);
        values->sum += value;
        ++values->count;
    }
}

static void find_stiffness(gmi_elastic_mesh *made, const gm_pair *pair, const gmi_engagement *at,
                           double force, gmi_elastic_work *work) {
    const gmi_elastic_tips *tips = made->has_corners ? &made->tips : NULL;
    const double lower = at->line_of_action - at->tip_roll_length[GM_WHEEL];
    const double upper = at->tip_roll_length[GM_PINION];
    const double start = fmax(at->start_roll_length[GM_PINION], lower);
    const double end = fmin(upper, at->line_of_action - at->start_roll_length[GM_WHEEL]);
    const double pitch = pair->transverse_base_pitch;
    gmi_elastic_lines_at lines = {.pitch = pitch,
                                  .climb = pair->face_advance / pair->face_width,
                                  .lower = tips != NULL ? lower : start,
                                  .upper = tips != NULL ? upper : end,
                                  .line_of_action = at->line_of_action,
                                  .step = 1,
                                  .teeth = pair->pinion.teeth};

    /* A first guess of x: 10 N/(mm um). */
    double approach = force / (1e10 * made->law.face_width);
    spread mesh = {0.0, 0.0, 0.0, 0};
    for (int k = 0; k < STIFFNESS_POSITIONS; ++k) {
        lines.origin = start + pitch * ((double)k + 0.5) / STIFFNESS_POSITIONS;
        add_to_spread(&mesh, stiffness_at(made, &lines, tips, force, &approach, work));
    }

    /* One pair alone, all along the face, over its path. */
    gmi_elastic_lines_at alone = lines;
    alone.climb = 0.0;
    alone.lower = start;
    alone.upper = end;
    alone.pitch = 2.0 * (end - start);
    spread single = {0.0, 0.0, 0.0, 0};
    gmi_elastic_work_reset(work);
    for (int k = 0; k < STIFFNESS_POSITIONS; ++k) {
        alone.origin = start + (end - start) * ((double)k + 0.5) / STIFFNESS_POSITIONS;
        add_to_spread(&single, stiffness_at(made, &alone, NULL, force, &approach, work));
    }

    const gm_mesh_stiffness stiffness = {
        .mesh_mean = mesh.sum / mesh.count,
        .mesh_smallest = mesh.smallest,
        .mesh_largest = mesh.largest,
        .single_mean = single.sum / single.count,
        .single_smallest = single.smallest,
        .single_largest = single.largest,
    };
    made->stiffness = stiffness;
}
