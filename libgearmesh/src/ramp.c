/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Linear reliefs along one line of contact.
 *
 * A line is straight in (t1, t2), so along it a ramp takes off what grows linearly from the place where the line
 * crosses the ramp's edge, if it does. There the line is cut. Between two cuts all ramps of both flanks together are
 * one straight line, which line.c takes as the value and the slope that f has beside the tables. So ramps are exact on
 * any grid and without one; each edge costs one more entry into the tables.
 *
 * A line may also run beyond an end of a table, t2 = 0 or 1: where a pose takes the start of a profile nearer to the root
 * than the drawing has it, and, between tilted axes of spur gears, as a whole, as tables are read a little off the point
 * that touches. The flank has the deviation of that end there. So the line is cut at the ends of tables too; in a part beyond one the flank is held: its
 * table is straight from face line to face line, and its ramps do not change with t2. The overlap is continuous at the
 * cuts: they add nothing when they move.
 */
#include "ramp.h"

#include "contact.h"
#include "flank.h"
#include "internal.h"
#include "line.h"
#include "stretch.h"

#include <math.h>

/* One ramp along the line: takes off max(0, at_zero + per_t1 t1). */
typedef struct trace {
    double at_zero; /* at t1 = 0 (m) */
    double per_t1;  /* (m) */
} trace;

/* The ramps that take something off the line. */
typedef struct traces {
    trace *list; /* NULL = found anew each time: a tangent has no stack to spare for them */
    unsigned char of[2 * GM_FLANK_RAMPS_MAX]; /* which ramps of their flank they are */
    int pinion;                               /* the first ones; the rest are the wheel's */
    int all;
} traces;

/* One flank, as the line runs along it. */
typedef struct flank_along {
    const gmi_tables *tables;
    const gmi_grid *grid;
    double profile; /* v2 at t1 = 0; of a flank that is held, all along */
} flank_along;

/* What a ramp takes off more per cell of v2 (m). */
static double per_profile_of(const gm_flank_ramp *ramp, const gmi_grid *grid) {
    return ramp->per_t2 / grid->profile_cells;
}

static trace trace_of(const gm_flank_ramp *ramp, const flank_along *flank, int is_held) {
    trace along;
    const gmi_grid *grid = flank->grid;
    const double per_profile = per_profile_of(ramp, grid);
    const double climb = is_held ? 0.0 : grid->direction * grid->climb;
    along.at_zero = ramp->offset + ramp->per_t1 * grid->face_origin + per_profile * flank->profile;
    along.per_t1 = ramp->per_t1 * grid->face_scale + per_profile * climb;
    return along;
}

/* Trace k of those found; of this flank. */
SPECIALIZED trace trace_at(const traces *found, int k, const flank_along *flank, int is_kept,
                           int is_held) {
    return is_kept ? found->list[k] : trace_of(&flank->tables->ramps[found->of[k]], flank, is_held);
}

static double height(const trace *ramp, double t1) {
    return ramp->at_zero + ramp->per_t1 * t1;
}

SPECIALIZED void add_traces(traces *found, const flank_along *flank, double from, double to,
                            int is_kept) {
    const int count = flank->tables == NULL ? 0 : flank->tables->ramp_count;
    for (int k = 0; k < count; ++k) {
        const trace along = trace_of(&flank->tables->ramps[k], flank, 0);
        if (height(&along, from) > 0.0 || height(&along, to) > 0.0) {
            if (is_kept) {
                found->list[found->all] = along;
            }
            found->of[found->all] = (unsigned char)k;
            ++found->all;
        }
    }
}

/* The first edge behind `from`, or `to`. held: NULL = none. */
SPECIALIZED double next_edge(const traces *ramps, const flank_along flanks[2], double from,
                             double to, int is_kept, const int *held) {
    double next = to;
    for (int k = 0; k < ramps->all; ++k) {
        /* Not a finite number if the line runs along it. */
        const int role = k >= ramps->pinion;
        const int is_held = held != NULL && held[role];
        const trace ramp = trace_at(ramps, k, &flanks[role], is_kept, is_held);
        const double edge = -ramp.at_zero / ramp.per_t1;
        if (edge > from && edge < next) {
            next = edge;
        }
    }
    return next;
}

/*
 * Takes ramps first .. last - 1, those of one flank, off a part of the line that no edge cuts: what a ramp does in its
 * middle it does all along. Returns their sum by v2 of the flank (m), and *per_face by v1, if wanted.
 */
SPECIALIZED double take_off(gmi_line *part, const traces *ramps, int first, int last,
                            const flank_along *flank, int wanted, int is_kept, int is_held,
                            double *per_face) {
    const double middle = 0.5 * (part->from + part->to);
    double per_profile = 0.0;
    *per_face = 0.0;
    for (int k = first; k < last; ++k) {
        const trace ramp = trace_at(ramps, k, flank, is_kept, is_held);
        if (!(height(&ramp, middle) > 0.0)) {
            continue;
        }

        /* Its height where the part begins, and its slopes. */
        part->overlap -= height(&ramp, part->from);
        part->half_slope -= 0.5 * ramp.per_t1;
        if (wanted & (GMI_DERIVATIVES | GMI_TANGENT)) {
            const gm_flank_ramp *taken = &flank->tables->ramps[ramps->of[k]];
            per_profile += is_held ? 0.0 : per_profile_of(taken, flank->grid);
            *per_face += taken->per_t1 * (flank->grid->face_scale / flank->grid->face_rate);
        }
    }
    return per_profile;
}

/* The slopes of the ramps, the same all along a part, as those of tables. */
static OWN_STACK void add_ramp_slopes(gmi_line_tangent *tangent, double pinion, double wheel,
                                      double face) {
    double by[GMI_COORDINATES] = {0.0};
    gmi_line_add_slopes(tangent, pinion, wheel, face, by);
    for (int k = 0; k < GMI_COORDINATES; ++k) {
        tangent->by[k][0] += by[k];
    }
}

/* Adds what is wanted of a part of the line to that of the whole. */
SPECIALIZED void add_part(const gmi_line_sum *part, int wanted, gmi_line_sum *result) {
    result->sum += part->sum;
    result->contact += part->contact;
    if (wanted & GMI_DERIVATIVES) {
        result->pinion += part->pinion;
        result->wheel += part->wheel;
    }
    if (wanted & GMI_MOMENTS) {
        result->sum_t1 += part->sum_t1;
        result->contact_t1 += part->contact_t1;
    }
    if (wanted & GMI_CONTACT_DERIVATIVES) {
        result->roots += part->roots;
        result->roots_pinion += part->roots_pinion;
        result->roots_wheel += part->roots_wheel;
    }
}

/* ---------------------------------------------------------------------------------------------
 * Beyond the ends of tables
 * ------------------------------------------------------------------------------------------- */

/* All ramps of a flank: what they do where it is held is not told by where they are along the line. */
static void add_all(traces *found, const flank_along *flank) {
    const int count = flank->tables == NULL ? 0 : flank->tables->ramp_count;
    for (int k = 0; k < count; ++k) {
        found->of[found->all] = (unsigned char)k;
        ++found->all;
    }
}

/* The next place behind `from` at which the line crosses an end of the table, or `to`. Spur lines cross none. */
static double next_end(const flank_along *flank, double from, double to) {
    const double rate = flank->grid->direction * flank->grid->climb;
    const double at[2] = {-flank->profile / rate,
                          (flank->grid->profile_cells - flank->profile) / rate};
    for (int k = 0; k < 2; ++k) {
        to = at[k] > from && at[k] < to ? at[k] : to; /* not a finite number for spur gears */
    }
    return to;
}

/* Holds the flank in a part that has its middle at t1 and crosses no end of the table, if it is beyond one: returns whether. */
static int hold_in_part(flank_along *flank, double t1) {
    const gmi_grid *grid = flank->grid;
    const double place = gmi_profile_at(grid, flank->profile, t1);
    const int is_held = gmi_is_beyond_table(grid, place, 0.0);
    if (is_held) {
        flank->profile = place < 0.0 ? 0.0 : grid->profile_cells;
    }
    return is_held;
}

/* The next face line of a table behind `from`, or `to`. */
static double next_face_line(const gmi_grid *grid, double from, double to) {
    const double rounding = 1e-9; /* a place this close to a face line is on it (cells) */
    const double line = floor(grid->face_base + grid->face_rate * from + rounding) + 1.0;
    const double at = (line - grid->face_base) / grid->face_rate;
    return at > from && at < to ? at : to;
}

/* Both flanks in the part of the line ahead of `from`; returns where it ends, before edges of ramps. */
static double begin_held_part(const gmi_line *line, double from, flank_along flanks[2],
                              int held[2]) {
    flanks[GM_PINION].profile = line->pinion_profile;
    flanks[GM_WHEEL].profile = line->wheel_profile;
    double to = next_end(&flanks[GM_PINION], from, line->to);
    to = next_end(&flanks[GM_WHEEL], from, to);
    const double middle = 0.5 * (from + to);
    for (int role = GM_PINION; role <= GM_WHEEL; ++role) {
        held[role] = hold_in_part(&flanks[role], middle);
        to = held[role] ? next_face_line(flanks[role].grid, from, to) : to;
    }
    return to;
}

/* Takes the table of a flank that is held into the straight line of a part, between two face lines; returns its slope by v1 (m). */
static double add_held_table(const flank_along *flank, const double **values, gmi_line *part) {
    const gmi_grid *grid = flank->grid;
    if (*values == NULL) {
        return 0.0;
    }

    /* The row of nodes at that end of the table, in the cell of the face that the part is in. */
    const double middle = 0.5 * (part->from + part->to);
    const int cell = gmi_cell_index(grid->face_base + grid->face_rate * middle, grid->last_face);
    const ptrdiff_t node = flank->profile > 0.0 ? grid->row - GMI_NODE_DOUBLES : 0;
    const double *near = *values + cell * grid->row + node;

    /* A straight line across it, and no table any more. */
    const double slope = near[grid->row] - near[0];
    const double gone = grid->face_base + grid->face_rate * part->from - (double)cell;
    part->overlap += near[0] + slope * gone;
    part->half_slope += 0.5 * slope * grid->face_rate;
    *values = NULL;
    return slope;
}

/* ---------------------------------------------------------------------------------------------
 * From edge to edge
 * ------------------------------------------------------------------------------------------- */

/* wanted, holds: constants where they matter; list: where traces are kept, or NULL; holds: beyond the ends of tables. */
SPECIALIZED void follow_edges(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                              const gmi_tables *pinion_tables, const gmi_tables *wheel_tables,
                              int wanted, int holds, trace *list, gmi_line_sum *result) {
    const gmi_line_sum none = {.sum = 0.0};
    const int is_kept = list != NULL;
    flank_along flanks[2] = {{pinion_tables, pinion, line->pinion_profile},
                             {wheel_tables, wheel, line->wheel_profile}};
    int held[2] = {0, 0};

    /* The ramps on the way: all of a flank where it may be held, else those that the line comes to. */
    traces ramps;
    ramps.list = list;
    ramps.all = 0;
    if (holds) {
        add_all(&ramps, &flanks[GM_PINION]);
        ramps.pinion = ramps.all;
        add_all(&ramps, &flanks[GM_WHEEL]);
    } else {
        add_traces(&ramps, &flanks[GM_PINION], line->from, line->to, is_kept);
        ramps.pinion = ramps.all;
        add_traces(&ramps, &flanks[GM_WHEEL], line->from, line->to, is_kept);
    }

    /* From edge to edge: between two of them all ramps together are one straight line. */
    *result = none;
    for (double from = line->from; from < line->to;) {
        gmi_line part = *line;
        gmi_line_sum sum;
        part.from = from;
        const double gone = from - line->from; /* the parabola as seen from here */
        part.overlap += gone * (2.0 * line->half_slope + gone * line->curvature);
        part.half_slope += gone * line->curvature;

        /* Where it ends: at the next edge of a ramp, or where a flank begins or ends to be held. */
        part.to = holds ? begin_held_part(line, from, flanks, held) : line->to;
        part.to = next_edge(&ramps, flanks, from, part.to, is_kept, holds ? held : NULL);

        /* What the ramps take off, and what held tables have, into its straight line. */
        double pinion_face, wheel_face;
        const double by_pinion = take_off(&part, &ramps, 0, ramps.pinion, &flanks[GM_PINION],
                                          wanted, is_kept, holds && held[GM_PINION], &pinion_face);
        const double by_wheel = take_off(&part, &ramps, ramps.pinion, ramps.all, &flanks[GM_WHEEL],
                                         wanted, is_kept, holds && held[GM_WHEEL], &wheel_face);
        if (holds && held[GM_PINION]) {
            (void)add_held_table(&flanks[GM_PINION], &part.pinion, &part);
        }
        if (holds && held[GM_WHEEL]) {
            wheel_face -= add_held_table(&flanks[GM_WHEEL], &part.wheel, &part);
        }

        /* Tables and straight line as one; the slope of the ramps counts where the flanks touch. */
        if (wanted & GMI_TANGENT) {
            add_ramp_slopes(line->tangent, -by_pinion, -by_wheel, -wheel_face);
        }
        if (wanted & GMI_TANGENT) {
            gmi_line_integrate_tangent(&part, pinion, wheel, &sum);
        } else if (wanted & GMI_SQUARES) {
            gmi_line_integrate_squares(&part, pinion, wheel, &sum);
        } else {
            gmi_line_integrate(&part, pinion, wheel, wanted, &sum);
        }
        if (wanted & GMI_TANGENT) {
            add_ramp_slopes(line->tangent, by_pinion, by_wheel, wheel_face);
        }

        /* Their slopes, over what touches and at its ends. */
        if (wanted & GMI_DERIVATIVES) {
            sum.pinion -= by_pinion * sum.contact;
            sum.wheel -= by_wheel * sum.contact;
        }
        if (wanted & GMI_CONTACT_DERIVATIVES) {
            sum.roots_pinion -= by_pinion * sum.roots;
            sum.roots_wheel -= by_wheel * sum.roots;
        }

        add_part(&sum, wanted, result);
        if (from == line->from) {
            result->at_from = sum.at_from;
        }
        result->at_to = sum.at_to;
        from = part.to;
    }
}

/* Most calls want the sum alone. */
static OWN_STACK void integrate_sum(const gmi_line *line, const gmi_grid *pinion,
                                    const gmi_grid *wheel, const gmi_tables *pinion_tables,
                                    const gmi_tables *wheel_tables, gmi_line_sum *result) {
    trace list[2 * GM_FLANK_RAMPS_MAX];
    follow_edges(line, pinion, wheel, pinion_tables, wheel_tables, GMI_SUM, 0, list, result);
}

static OWN_STACK void integrate_all(const gmi_line *line, const gmi_grid *pinion,
                                    const gmi_grid *wheel, const gmi_tables *pinion_tables,
                                    const gmi_tables *wheel_tables, int wanted,
                                    gmi_line_sum *result) {
    trace list[2 * GM_FLANK_RAMPS_MAX];
    follow_edges(line, pinion, wheel, pinion_tables, wheel_tables,
                 wanted & ~(GMI_TANGENT | GMI_SQUARES), 0, list, result);
}

static OWN_STACK void integrate_squares(const gmi_line *line, const gmi_grid *pinion,
                                        const gmi_grid *wheel, const gmi_tables *pinion_tables,
                                        const gmi_tables *wheel_tables, gmi_line_sum *result) {
    trace list[2 * GM_FLANK_RAMPS_MAX];
    follow_edges(line, pinion, wheel, pinion_tables, wheel_tables, GMI_SQUARES, 0, list, result);
}

void gmi_ramps_integrate_tangent(const gmi_line *line, const gmi_grid *pinion,
                                 const gmi_grid *wheel, const gmi_tables *pinion_tables,
                                 const gmi_tables *wheel_tables, gmi_line_sum *result) {
    follow_edges(line, pinion, wheel, pinion_tables, wheel_tables, GMI_TANGENT | GMI_MOMENTS, 0,
                 NULL, result);
}

void gmi_ramps_integrate(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                         const gmi_tables *pinion_tables, const gmi_tables *wheel_tables,
                         int wanted, gmi_line_sum *result) {
    if (wanted == GMI_SUM) {
        integrate_sum(line, pinion, wheel, pinion_tables, wheel_tables, result);
    } else if (wanted & GMI_SQUARES) {
        integrate_squares(line, pinion, wheel, pinion_tables, wheel_tables, result);
    } else {
        integrate_all(line, pinion, wheel, pinion_tables, wheel_tables, wanted, result);
    }
}

OWN_STACK void gmi_ramps_integrate_beyond(const gmi_line *line, const gmi_grid *pinion,
                                          const gmi_grid *wheel, const gmi_tables *pinion_tables,
                                          const gmi_tables *wheel_tables, int wanted,
                                          gmi_line_sum *result) {
    follow_edges(line, pinion, wheel, pinion_tables, wheel_tables, wanted & ~GMI_TANGENT, 1, NULL,
                 result);
}

OWN_STACK void gmi_ramps_integrate_tangent_beyond(const gmi_line *line, const gmi_grid *pinion,
                                                  const gmi_grid *wheel,
                                                  const gmi_tables *pinion_tables,
                                                  const gmi_tables *wheel_tables,
                                                  gmi_line_sum *result) {
    follow_edges(line, pinion, wheel, pinion_tables, wheel_tables, GMI_TANGENT | GMI_MOMENTS, 1,
                 NULL, result);
}
