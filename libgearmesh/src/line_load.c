/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The load along the lines of contact, station by station. With constant stiffness K of a pair over the common face b the
 * line load is K f / b; elastic teeth have it from their deflections. The largest one of constant stiffness is looked for
 * where it can be: at the bends of the overlap and on top of its humps.
 */
#include "line_load.h"

#include "contact.h"
#include "corner.h"
#include "elastic.h"
#include "elastic_mesh.h"
#include "flank.h"
#include "internal.h"
#include "line.h"
#include "mesh.h"
#include "meshing.h"
#include "penetration.h"
#include "position.h"
#include "surface.h"
#include "tilt.h"

#include <math.h>

enum { STATIONS = 17 }; /* where the law has none of its own */

/* Contact pressure that is warned of: steel yields below half of it (N/m2). */
static const double largest_pressure = 10e9;

static int stations_of(const gm_mesh *mesh) {
    return mesh->elastic != NULL ? mesh->elastic->law.stations : STATIONS;
}

/* Lines at once with constant stiffness; with corners as far as these reach. */
static int lines_of(const gm_mesh *mesh) {
    const gm_pair *pair = mesh->pair;
    const gmi_engagement *at = &mesh->engagement;
    if (!mesh->has_corners) {
        return gmi_elastic_lines(pair->total_contact_ratio);
    }
    const double way = at->tip_roll_length[GM_PINION] + at->tip_roll_length[GM_WHEEL] -
                       at->line_of_action + mesh->corners[GM_PINION].reach +
                       mesh->corners[GM_WHEEL].reach + fabs(pair->face_advance);
    return 1 + gmi_elastic_lines(way / pair->transverse_base_pitch);
}

int gm_mesh_line_load_points(const gm_mesh *mesh) {
    if (mesh == NULL) {
        return 0;
    }
    return 2 * stations_of(mesh) *
           (mesh->elastic != NULL ? mesh->elastic->law.lines_max : lines_of(mesh));
}

/* All that is found, and where it goes. */
typedef struct walk {
    const gm_mesh *mesh;
    gm_line_load_point *points;
    int capacity;
    gm_line_loads *load;
    double force;  /* of all lines, transverse (N) */
    double length; /* of those that touch, along z (m) */
} walk;

/*
 * Line contact [Johnson]: half width a = sqrt(4 q rho_red / (pi E*)), p_0 = 2 q / (pi a), with the curvature of the normal
 * section, rho_red = rho_p rho_w / (T cos(beta_b)).
 */
static double pressure_of(const gm_mesh *mesh, double line_load, double roll, double wheel_roll,
                          double sharpness) {
    const double cosine = cos(mesh->pair->base_helix_angle);
    const double radius = sharpness * roll * wheel_roll / ((roll + wheel_roll) * cosine);
    const double half_width = sqrt(4.0 * line_load * radius * mesh->contact_compliance / GMI_PI);
    return line_load > 0.0 ? 2.0 * line_load / (GMI_PI * half_width) : 0.0;
}

/* Where one point of a line touches with constant stiffness. */
typedef struct place {
    double rolls[2]; /* [enum gm_role] roll lengths, in the signs of ISO 21771 (m) */
    double arms[2];  /* likewise of the tangent along which the flanks slide, about both axes (m) */
    double material; /* of both flanks, which end with their tables, less the gap of an edge (m) */
    int is_edge;
} place;

/* How fast flanks slide on each other whose tangent has these arms, as friction.c has it. */
static double sliding_speed(const gmi_side_lines *found, double pinion_arm, double wheel_arm) {
    return found->speeds[GM_PINION] * pinion_arm - found->speeds[GM_WHEEL] * wheel_arm;
}

static double held(double roll, double one_end, double other_end) {
    return fmin(fmax(roll, fmin(one_end, other_end)), fmax(one_end, other_end));
}

/* With corners a tip edge touches the flank off the line of action, as in corner_line.c. */
static void find_place(const gm_mesh *mesh, const gmi_side_lines *found,
                       const gmi_line_flanks *flanks, double origin, double t1, place *where) {
    const gmi_engagement *at = &mesh->engagement;
    const double roll = origin + found->lines.advance * t1;
    double by_roll, pinion = roll, wheel = found->reach - roll;
    where->rolls[GM_PINION] = pinion;
    where->rolls[GM_WHEEL] = wheel;
    where->arms[GM_PINION] = roll;
    where->arms[GM_WHEEL] = at->line_of_action - roll;
    where->is_edge = 0;
    if (!mesh->has_corners) {
        where->material = gmi_line_flanks_at(flanks, found->side, t1, roll, found->reach, &by_roll);
        return;
    }

    /* Beyond its ends a flank has the deviation of the end. */
    pinion = held(pinion, mesh->pair->pinion.start_roll_length, at->tip_roll_length[GM_PINION]);
    wheel = held(wheel, at->wheel_profile_start, at->tip_roll_length[GM_WHEEL]);
    where->material = gmi_line_flanks_at(flanks, found->side, t1, pinion, pinion + wheel, &by_roll);

    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        gmi_beyond beyond;
        gmi_corner_place corner;
        gmi_tilt_beyond(mesh->pair, at, found->side, origin, found->delta, role, &beyond);
        const double past = beyond.at_zero + beyond.per_t1 * t1;
        if (past > 0.0) {
            gmi_corner_at(&mesh->corners[role], fmin(past, mesh->corners[role].reach), &corner);
            where->material -= corner.gap;
            const int mate = role == GM_PINION ? GM_WHEEL : GM_PINION;
            where->rolls[role] = at->tip_roll_length[role];
            where->rolls[mate] = corner.mate_roll;
            where->is_edge = 1;

            /* Both arms together are the part of the centre distance along the turned normal. */
            where->arms[mate] += corner.gain;
            where->arms[role] = at->line_of_action * (1.0 - corner.versine) +
                                gmi_base_sum(mesh->pair) * sin(corner.turn) - where->arms[mate];
        }
    }
}

/* Of constant stiffness: from the overlap itself. The pressure under an edge is open, as nothing says how sharp it is. */
static gm_line_load_point point_of_overlap(const gm_mesh *mesh, const gmi_side_lines *found,
                                           const gmi_line_flanks *flanks, int index, double t1) {
    const gm_pair *pair = mesh->pair;

    /* The overlap there, which a tilt lets grow by other than x. */
    const double gain =
        mesh->engagement.is_tilted ? gmi_tilt_gain(pair, &mesh->engagement, found->side) : 1.0;
    place where;
    find_place(mesh, found, flanks,
               found->lines.origin + (double)index * pair->transverse_base_pitch, t1, &where);
    const double overlap = gain * found->delta + where.material;

    /* The stiffness is spread evenly over the face. */
    gm_line_load_point point = {
        .side = found->side,
        .pinion_tooth = flanks->pinion_tooth,
        .wheel_tooth = flanks->wheel_tooth,
        .z = pair->face_start + t1 * pair->face_width,
        .pinion_roll_length = where.rolls[GM_PINION],
        .wheel_roll_length = fabs(where.rolls[GM_WHEEL]),
        .line_load = fmax(0.0, overlap) * mesh->law.stiffness / pair->face_width,
        .gap = -overlap,
        .sliding_speed = sliding_speed(found, where.arms[GM_PINION], where.arms[GM_WHEEL]),
    };
    point.pressure = where.is_edge && point.line_load > 0.0
                         ? gmi_nan()
                         : pressure_of(mesh, point.line_load, where.rolls[GM_PINION],
                                       where.rolls[GM_WHEEL], 1.0);
    return point;
}

/* row: of the elastic workspace. */
static gm_line_load_point point_at(const gm_mesh *mesh, const gmi_side_lines *found,
                                   const gmi_line_flanks *flanks, int index, int row, double t1) {
    const gm_pair *pair = mesh->pair;
    if (found->work == NULL) {
        return point_of_overlap(mesh, found, flanks, index, t1);
    }

    /* Where it is, and how much material both flanks have there. */
    const double on_line = found->lines.origin + (double)index * pair->transverse_base_pitch +
                           found->lines.advance * t1;
    const gmi_elastic_lines_at *lines = found->has_tips ? &found->work->at : NULL;
    const double roll = lines != NULL ? fmin(fmax(on_line, lines->lower), lines->upper) : on_line;
    double by_roll;
    double material = gmi_line_flanks_at(flanks, found->side, t1, roll, found->reach, &by_roll);
    gm_line_load_point point = {
        .side = found->side,
        .pinion_tooth = flanks->pinion_tooth,
        .wheel_tooth = flanks->wheel_tooth,
        .z = pair->face_start + t1 * pair->face_width,
        .pinion_roll_length = roll,
        .wheel_roll_length = fabs(found->reach - roll),
        .sliding_speed = sliding_speed(found, roll, mesh->engagement.line_of_action - roll),
    };

    /* Beyond the path a tip edge touches, where the flanks end. */
    double sharpness = 1.0;
    if (lines != NULL) {
        const double beyond = on_line - roll;
        const gmi_elastic_edge edge = gmi_elastic_edge_at(&found->tips, found->delta, lines->lower,
                                                          lines->upper, roll, beyond);
        material += gmi_elastic_hold_at(lines, beyond).moved * by_roll - edge.gap.value;
        sharpness = edge.rate_factor;
    }

    /* What presses there, from the deflections. */
    double approach;
    const double z = (t1 - mesh->engagement.face_from) * pair->face_width;
    point.line_load = gmi_elastic_load_at(&mesh->elastic->law, found->work, row, z, material,
                                          sharpness, &approach);
    point.gap = -approach;
    point.pressure = pressure_of(mesh, point.line_load, roll, found->reach - roll, sharpness);
    return point;
}

static void count_point(walk *w, const gm_line_load_point *point) {
    w->load->largest_line_load = fmax(w->load->largest_line_load, point->line_load);
    w->load->largest_pressure = fmax(w->load->largest_pressure, point->pressure);
}

/* The part of a line within the path, where corners touch beyond it. */
static double length_on_path(const gm_mesh *mesh, const gmi_lines *path, int index) {
    if (index < path->first || index > path->last) {
        return 0.0;
    }
    const gmi_line_ends ends = gmi_line_ends_find(mesh->pair, &mesh->engagement, path);
    const gmi_interval part = gmi_line_clip(&ends, index);
    return fmax(part.to - part.from, 0.0) * mesh->pair->face_width;
}

/* What of a line is to bear load: all of it within the path, and beyond it where it does. */
static double bearing_length(const gm_mesh *mesh, const gmi_side_lines *found, int index, int row,
                             gmi_interval part) {
    const double width = mesh->pair->face_width;
    const double advance = found->lines.advance;
    if (mesh->has_corners) { /* what touches beyond is known of the whole side */
        return length_on_path(mesh, &found->path, index);
    }

    if (!found->has_tips || advance == 0.0) {
        return (part.to - part.from) * width;
    }

    /* What lies within the path, ... */
    const gmi_elastic_work *work = found->work;
    const double origin = found->lines.origin + (double)index * mesh->pair->transverse_base_pitch;
    const double lower =
        fmax(work->at.lower, origin + fmin(advance * part.from, advance * part.to));
    const double upper =
        fmin(work->at.upper, origin + fmax(advance * part.from, advance * part.to));
    double length = fmax(upper - lower, 0.0) * width / fabs(advance);

    /* ... and points beyond it that carry. */
    const gmi_elastic_line *line = &work->line[row];
    for (int half = 0; half < 2; ++half) {
        const int from = line->slot + half * work->slots;
        for (int p = from; p < from + line->slots; ++p) {
            length += work->beyond[p] != 0.0 && work->load[p] > 0.0 ? work->weight[p] : 0.0;
        }
    }
    return length;
}

/*
 * An edge presses hardest where its rounding has just taken the place of the flank, mostly between stations. Whether it
 * bears load there.
 */
static int count_edges(walk *w, const gmi_side_lines *found, const gmi_line_flanks *flanks,
                       int index, int row, gmi_interval part) {
    const gmi_elastic_lines_at *lines = &found->work->at;
    const double origin =
        found->lines.origin + (double)index * w->mesh->pair->transverse_base_pitch;
    const double rolls[2] = {lines->lower - lines->fading[0], lines->upper + lines->fading[1]};
    int touches = 0;
    for (int end = 0; end < 2; ++end) {
        const double t1 = (rolls[end] - origin) / found->lines.advance;
        if (t1 > part.from && t1 < part.to) {
            const gm_line_load_point point = point_at(w->mesh, found, flanks, index, row, t1);
            count_point(w, &point);
            touches = touches || point.line_load > 0.0;
        }
    }
    return touches;
}

/* The next place behind t1 at which something that is straight along the line is a whole number; infinite if it never is. */
static double next_whole(double at_zero, double per_t1, double t1) {
    const double rounding = 1e-9; /* a place this close to one is at it */
    const double here = at_zero + per_t1 * t1;
    const double whole = per_t1 > 0.0 ? floor(here + rounding) + 1.0 : ceil(here - rounding) - 1.0;
    return per_t1 != 0.0 ? (whole - at_zero) / per_t1 : HUGE_VAL;
}

static double next_zero(double at_zero, double per_t1, double t1, double next) {
    const double zero = -at_zero / per_t1; /* no finite number if it stays as it is */
    return zero > t1 && zero < next ? zero : next;
}

/* Where the overlap bends next: at lines of the grids, edges of linear reliefs, and tips. */
double gmi_line_next_bend(const gm_mesh *mesh, const gmi_side_lines *found, double origin,
                          double t1, double to) {
    double next = to;
    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        const gmi_surface_gear gear = gmi_surface_gear_of(mesh, found->side, role, found->reach);
        const double roll = gear.roll_from + gear.per_roll * origin;
        const double per_roll = gear.per_roll * found->lines.advance;

        /* Face and profile lines of its table, and edges of its ramps. */
        if (gear.tables != NULL) {
            const gmi_grid *grid = gear.grid;
            next = fmin(next, next_whole(grid->face_base, grid->face_rate, t1));
            next = fmin(next, next_whole(roll * grid->per_rho, per_roll * grid->per_rho, t1));
            for (int k = 0; k < gear.tables->ramp_count; ++k) {
                const gm_flank_ramp *ramp = &gear.tables->ramps[k];
                const double per_own = ramp->per_t2 / grid->profile_cells * grid->per_rho;
                next = next_zero(ramp->offset + ramp->per_t1 * grid->face_origin + per_own * roll,
                                 ramp->per_t1 * grid->face_scale + per_own * per_roll, t1, next);
            }
        }

        /* Where its tip is left. */
        if (mesh->has_corners) {
            gmi_beyond beyond;
            gmi_tilt_beyond(mesh->pair, &mesh->engagement, found->side, origin, found->delta, role,
                            &beyond);
            next = next_zero(beyond.at_zero, beyond.per_t1, t1, next);
        }
    }
    return next;
}

/*
 * With constant stiffness the overlap is a parabola between two bends (beyond a tip next to one): it is largest at a bend
 * or at the top of a hump. Whether the line touches there.
 */
static int count_bends(walk *w, const gmi_side_lines *found, const gmi_line_flanks *flanks,
                       int index, gmi_interval part) {
    const gm_mesh *mesh = w->mesh;
    const double origin = found->lines.origin + (double)index * mesh->pair->transverse_base_pitch;
    gm_line_load_point before = point_of_overlap(mesh, found, flanks, index, part.from);
    int touches = 0;
    for (double from = part.from, to; from < part.to; from = to) {
        to = gmi_line_next_bend(mesh, found, origin, from, part.to);
        const double half = 0.5 * (to - from), middle = from + half;
        const gm_line_load_point at = point_of_overlap(mesh, found, flanks, index, middle);
        const gm_line_load_point behind = point_of_overlap(mesh, found, flanks, index, to);
        count_point(w, &behind);
        touches = touches || behind.line_load > 0.0;

        /* The parabola by the halves of the piece, in gaps: a hump of the overlap is a hollow of the gap. */
        const double slope = 0.5 * (behind.gap - before.gap);
        const double bend = behind.gap - 2.0 * at.gap + before.gap;
        if (bend > 0.0 && fabs(slope) < bend) {
            const gm_line_load_point top =
                point_of_overlap(mesh, found, flanks, index, middle - half * slope / bend);
            count_point(w, &top);
            touches = touches || top.line_load > 0.0;
        }
        before = behind;
    }
    return touches;
}

/* Whether the overlap of constant stiffness changes along a line. */
static int has_bends(const gm_mesh *mesh, const gmi_side_lines *found) {
    const gmi_side *prepared = &mesh->side[found->side];
    return found->work == NULL && (prepared->pinion != NULL || prepared->wheel != NULL ||
                                   mesh->engagement.is_tilted || mesh->has_corners);
}

/*
 * Stations of one line as parallel axes have it, and what its own part bears, ends included. Returns GM_OK or
 * GM_ERR_MEMORY.
 */
static int walk_line(walk *w, const gmi_side_lines *found, int index, int row, gmi_interval listed,
                     gmi_interval part) {
    const gm_mesh *mesh = w->mesh;
    const gmi_engagement *at = &mesh->engagement;
    const gmi_line_flanks flanks =
        gmi_line_flanks_of(mesh, found->side, &found->lines, &found->teeth, index);

    /* At equal steps along the common face. */
    const int stations = stations_of(mesh);
    const double spacing = (at->face_to - at->face_from) / (double)(stations - 1);
    int touches = 0;

    /* The stations that the line passes go to the caller. */
    for (int k = 0; k < stations; ++k) {
        const double t1 = k == stations - 1 ? at->face_to : at->face_from + (double)k * spacing;
        if (!(t1 >= listed.from && t1 <= listed.to && listed.from < listed.to)) {
            continue;
        }
        const gm_line_load_point point = point_at(mesh, found, &flanks, index, row, t1);
        if (t1 >= part.from && t1 <= part.to) {
            count_point(w, &point);
            touches = touches || point.line_load > 0.0;
        }

        /* Counted in any case, also for a caller who asks only how many there are. */
        if (w->points != NULL) {
            if (w->load->points == w->capacity) {
                return GM_ERR_MEMORY;
            }
            w->points[w->load->points] = point;
        }
        ++w->load->points;
    }

    /* Between stations the load may be largest where the line ends. */
    for (int end = 0; end < 2 && part.from < part.to; ++end) {
        const gm_line_load_point point =
            point_at(mesh, found, &flanks, index, row, end == 0 ? part.from : part.to);
        count_point(w, &point);
        touches = touches || point.line_load > 0.0;
    }

    if (found->has_tips && found->lines.advance != 0.0) {
        touches = count_edges(w, found, &flanks, index, row, part) || touches;
    }
    if (has_bends(mesh, found)) {
        touches = count_bends(w, found, &flanks, index, part) || touches;
    }

    /* All of a line that touches anywhere bears the mean line load. */
    w->length += touches ? bearing_length(mesh, found, index, row, part) : 0.0;
    return GM_OK;
}

/* Row of a line in the workspace; -1: it is not there. */
static int row_of(const gmi_elastic_work *work, int index) {
    for (int row = 0; row < work->count; ++row) {
        if (work->line[row].index == index) {
            return row;
        }
    }
    return -1;
}

/* Of elastic teeth: where their points carry load. */
static double touching_width(const gmi_elastic_work *work) {
    double width = 0.0;
    for (int p = 0; p < 2 * work->slots; ++p) {
        width += work->load[p] > 0.0 ? work->weight[p] : 0.0;
    }
    return width;
}

/* The lines of constant stiffness as far as corners touch; edges that may be there are looked at all along. */
static void widen(const gm_mesh *mesh, gmi_side_lines *found) {
    const gmi_engagement *at = &mesh->engagement;
    const gmi_side *prepared = &mesh->side[found->side];
    const double overlap = found->delta + prepared->peak, moved = prepared->tilt_reach;
    const double lower = found->reach - at->tip_roll_length[GM_WHEEL];
    const double upper = at->tip_roll_length[GM_PINION];
    gmi_lines_widen(mesh->pair, lower, upper, &found->lines);
    found->path = found->lines;
    gmi_lines_widen(mesh->pair, lower - gmi_corner_touch(&mesh->corners[GM_WHEEL], overlap) - moved,
                    upper + gmi_corner_touch(&mesh->corners[GM_PINION], overlap) + moved,
                    &found->lines);
}

/* The sum of a side, and beyond the path the touching part. */
static OWN_STACK int sum_side(const gm_mesh *mesh, int side, const gm_position *position,
                              gm_workspace *workspace, gmi_side_sum *sum, double *beyond) {
    *beyond = 0.0;
    if (!mesh->has_corners) {
        return gmi_side_sum_by_law(mesh, side, position, GMI_SUM, workspace, sum);
    }
    gmi_corner_sums sums;
    gmi_side_sum_corners(mesh, side, position, GMI_SUM, 0.0, NULL, &sums);
    *sum = sums.side;
    *beyond = sums.tips[GM_PINION].contact + sums.tips[GM_WHEEL].contact;
    return GM_OK;
}

/* With constant stiffness as penetration.c and corner_line.c have it. */
void gmi_side_ends_find(const gm_mesh *mesh, gmi_side_lines *found, gmi_side_ends *ends) {
    const gmi_engagement *at = &mesh->engagement;
    const gmi_side *prepared = &mesh->side[found->side];
    ends->path = gmi_line_ends_find(mesh->pair, at, &found->lines);
    ends->first = found->lines.first;
    ends->last = found->lines.last;
    ends->is_tilted = at->is_tilted && found->work == NULL;
    if (!ends->is_tilted) {
        return;
    }

    const gmi_lines *lines = &found->lines;
    gmi_tilt_cuts_find(mesh->pair, at, found->side, found->delta,
                       mesh->has_corners ? GMI_FACES_ALONE
                                         : gmi_side_table_ends(mesh->pair, prepared),
                       &ends->cuts);

    /* That may bring a line in that is just outside; where corners touch, widen() knows. */
    if (!mesh->has_corners) {
        const double pitch = mesh->pair->transverse_base_pitch;
        const double before = lines->origin + (double)(lines->first - 1) * pitch + lines->rise;
        const double behind = lines->origin + (double)(lines->last + 1) * pitch + lines->fall;
        found->lines.first -= before > lines->lower - prepared->tilt_reach;
        found->lines.last += behind < lines->upper + prepared->tilt_reach;
    }
}

/* listed: of the line between parallel axes. */
gmi_interval gmi_side_line_part(const gmi_side_ends *ends, const gm_mesh *mesh,
                                const gmi_side_lines *found, int index, gmi_interval listed) {
    if (!ends->is_tilted) {
        return listed;
    }
    const double pitch = mesh->pair->transverse_base_pitch;
    gmi_line_part tilted;
    if (!gmi_tilt_cut_line(&ends->cuts, found->lines.origin + (double)index * pitch, &tilted)) {
        const gmi_interval none = {0.0, 0.0};
        return none;
    }
    gmi_interval part = {tilted.from, tilted.to};
    if (mesh->has_corners) {
        gmi_line_ends reached = ends->path; /* as far as corners touch, whatever the faces */
        reached.face_from = -HUGE_VAL;
        reached.face_to = HUGE_VAL;
        const gmi_interval edges = gmi_line_clip(&reached, index);
        part.from = fmax(part.from, edges.from);
        part.to = fmin(part.to, edges.to);
    }
    return part;
}

/* All lines of one side, and what that side carries as a whole. */
static int walk_side(walk *w, int side, const gm_position *position, gm_workspace *workspace) {
    const gm_mesh *mesh = w->mesh;
    const gm_pair *pair = mesh->pair;
    const gmi_engagement *at = &mesh->engagement;
    gmi_side_sum sum;
    double beyond;
    int status = sum_side(mesh, side, position, workspace, &sum, &beyond);
    if (status != GM_OK || sum.sum == 0.0) {
        return status;
    }

    /* The sums of the side. Edges beyond the path bear along their width. */
    w->length += beyond * pair->face_width;
    w->force += mesh->law.stiffness * sum.sum;
    w->load->touching_width += mesh->elastic != NULL ? touching_width(&workspace->side[side])
                                                     : sum.contact * pair->face_width;

    /* Elastic teeth do not move the path by what they give way. */
    gmi_side_lines found = {.side = side,
                            .delta = gmi_ideal_penetration(at, side, position->offset)};
    found.speeds[GM_PINION] = position->pinion_speed;
    found.speeds[GM_WHEEL] =
        (pair->pinion.base_radius * position->pinion_speed - position->offset_rate) /
        at->wheel_base_radius;
    found.work = mesh->elastic != NULL ? &workspace->side[side] : NULL;
    found.reach = at->line_of_action + (found.work != NULL ? 0.0 : found.delta);
    gm_position lines_at = *position;
    if (found.work != NULL) {
        lines_at.offset = gmi_side_sign(side) * 0.5 * at->backlash;
    }

    /* The lines that can touch; edges carry some of them on beyond the path. */
    gmi_lines_find(pair, at, side, &lines_at, &found.lines);
    found.has_tips = found.work != NULL && gmi_elastic_tips_of(mesh, &found.tips);
    if (found.has_tips) {
        const gmi_elastic_lines_at *lines = &found.work->at;
        gmi_lines_widen(pair, lines->lower - lines->below, lines->upper + lines->above,
                        &found.lines);
    }
    if (mesh->has_corners) {
        widen(mesh, &found);
    }

    /* Line by line, within the face and the path. */
    gmi_side_ends ends;
    gmi_side_ends_find(mesh, &found, &ends);
    found.teeth = gmi_lines_teeth(pair, side, &lines_at, &found.lines);
    for (int k = found.lines.first; k <= found.lines.last && status == GM_OK; ++k) {
        const gmi_interval none = {0.0, 0.0};
        const int is_listed = k >= ends.first && k <= ends.last;
        const gmi_interval listed = is_listed ? gmi_line_clip(&ends.path, k) : none;
        const gmi_interval part = gmi_side_line_part(&ends, mesh, &found, k, listed);
        const int row = found.work != NULL ? row_of(found.work, k) : 0;
        if ((listed.from < listed.to || part.from < part.to) && row >= 0) {
            status = walk_line(w, &found, k, row, listed, part);
        }
    }
    return status;
}

int gm_mesh_line_loads(const gm_mesh *mesh, const gm_position *position, gm_workspace *workspace,
                       gm_line_load_point *points, int capacity, gm_line_loads *load) {
    if (load == NULL) {
        return GM_ERR_NULL;
    }
    const gm_line_loads none = {gmi_nan(), gmi_nan(), gmi_nan(), gmi_nan(), 0, 0};
    *load = none;
    if (mesh == NULL || position == NULL || (mesh->elastic != NULL && workspace == NULL)) {
        return GM_ERR_NULL;
    }
    if (mesh->model == GM_MODEL_SIMPLE) {
        return GM_ERR_GEOMETRY;
    }
    const gm_position posed = gmi_mesh_posed(mesh, position);
    int status = gmi_check_position(mesh->pair, &posed);

    gm_line_loads found = {0.0, 0.0, 0.0, 0.0, 0, 0};
    walk w = {.mesh = mesh, .points = points, .capacity = capacity, .load = &found};
    for (int side = GM_DRIVE; side <= GM_COAST && status == GM_OK; ++side) {
        status = walk_side(&w, side, &posed, workspace);
    }
    if (status != GM_OK) {
        return status;
    }
    if (found.largest_line_load > 0.0) {
        *load = found;
        load->face_load_factor = found.largest_line_load * w.length / w.force;
        if (!(found.largest_pressure > 0.0)) { /* edges alone bear it */
            load->largest_pressure = gmi_nan();
        }

        /* What to think of it. */
        const int is_ring = mesh->elastic != NULL && mesh->pair->wheel.sign < 0.0;
        load->warnings = (found.largest_pressure > largest_pressure ? GM_WARN_LOAD_PRESSURE : 0) |
                         (is_ring ? GM_WARN_LOAD_RING : 0);
    }
    load->touching_width = found.touching_width;
    load->points = found.points;
    return GM_OK;
}
