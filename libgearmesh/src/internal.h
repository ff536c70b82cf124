/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * What the sources of the core share and users never see. Dependencies run one way:
 * gear -> meshing -> pair -> position -> contact -> flank -> line -> ramp -> penetration -> force -> wrench, equilibrium.
 */
#ifndef GEARMESH_INTERNAL_H
#define GEARMESH_INTERNAL_H

#include "arithmetic.h"
#include "gearmesh/gearmesh.h"

#include <math.h>

#include "shared.h"

/* 2 pi = GMI_TWO_PI + GMI_TWO_PI_REMAINDER to 32 digits. */
#define GMI_TWO_PI           6.28318530717958647693
#define GMI_TWO_PI_REMAINDER 2.44929359829470635e-16

/* Angles beyond this are refused: at 1e9 rad one rounding already moves the flank by nanometres. */
#define GMI_LARGEST_ANGLE 1e9

/*
 * Numbers beyond these are refused where they come in. Nobody means them, and within them no product in an evaluation
 * overflows, so that nothing is looked for on the way.
 */
#define GMI_LARGEST_SPEED      1e9   /* of a gear (rad/s), and of approach (m/s) */
#define GMI_LARGEST_OFFSET     1e18  /* of the simple model, which takes any other x (m) */
#define GMI_SMALLEST_LENGTH    1e-6  /* of a pair (m) */
#define GMI_LARGEST_LENGTH     1e9   /* (m) */
#define GMI_LARGEST_DEVIATION  1.0   /* of a flank (m) */
#define GMI_LARGEST_RAMP       1e30  /* its parts (m): they are large where it is short */
#define GMI_SMALLEST_STIFFNESS 1e-30 /* (N/m) */
#define GMI_LARGEST_STIFFNESS  1e30  /* (N/m), and of damping (N s/m) */

static inline double gmi_nan(void) {
    return (double)NAN;
}

static inline int gmi_is_finite(double value) {
    return isfinite(value);
}

/* a * b = *product + return value, exactly (Dekker; no fused multiply-add needed). */
double gmi_product_remainder(double a, double b, double product);

/* gear.c: geometry of one gear. */
double gmi_involute(double angle);
void gmi_gear_init(gm_gear *gear, int teeth, double transverse_module,
                   double transverse_pressure_angle);
void gmi_gear_set_root(gm_gear *gear, double normal_module);
void gmi_gear_set_tip(gm_gear *gear, double tip_radius, double normal_module);
void gmi_gear_set_start(gm_gear *gear, double start_radius);
void gmi_gear_set_start_roll_length(gm_gear *gear, double start_roll_length);
void gmi_gear_set_thickness(gm_gear *gear, double normal_thickness, double helix_angle,
                            double transverse_pressure_angle);
void gmi_gear_set_tip_thickness(gm_gear *gear);

/* meshing.c: two gears at a centre distance. */

/*
 * What depends on the centre distance, the gears staying as drawn; the names are those of gm_pair. At the drawing's own
 * distance the numbers are the drawing's, to the last bit.
 */
typedef struct gmi_meshing {
    double center_distance;        /* (m) */
    double line_of_action;         /* T (m) */
    double working_pressure_angle; /* alpha_wt (rad) */
    double involute_difference;    /* inv(alpha_wt) - inv(alpha_t) (1) */
    double backlash;               /* transverse, along the line of action (m) */
    double start_roll_length
        [2]; /* [enum gm_role] where the active profile starts at this distance (m) */
    double path_start, path_end;     /* at zero penetration, from the pinion's tangent point (m) */
    double transverse_contact_ratio; /* (1) */
    double
        phase_origin[2]; /* [side] rho_p of tooth 0 at phi_p = 0 where the common face begins (m) */
    double working_pitch_radius[2]; /* [enum gm_role] (m) */
    double tip_clearance[2];        /* [enum gm_role] from this gear's tip to the mate's root (m) */
} gmi_meshing;

/* 1 if the gears mesh there: the base circles are apart and the path of contact is longer than 0; else 0. */
int gmi_meshing_find(const gm_pair *pair, double center_distance, gmi_meshing *meshing);

/* The first part of it, which needs no teeth: line_of_action, working_pressure_angle, involute_difference. */
void gmi_meshing_find_angles(const gm_pair *pair, double center_distance, gmi_meshing *meshing);

/* What to compute beside sum, contact and pairs. */
enum gmi_wanted { GMI_SUM = 0, GMI_DERIVATIVES = 1, GMI_MOMENTS = 2 };

/* The sums over all lines of one side. */
typedef struct gmi_side_sum {
    double sum;     /* sum of the integrals of max(0, delta) dt1 (m) */
    double contact; /* touching part of the face width, summed (1) */
    int pairs;      /* lines that touch */

    double by_origin; /* partial derivatives of sum by the origin of the lines ... */
    double by_delta;  /* ... and by delta (GMI_DERIVATIVES) (1) */

    double sum_t1;      /* first moments (GMI_MOMENTS): integrals of max(0, delta) t1 (m), */
    double sum_rho;     /* of max(0, delta) rho_p (m2), */
    double contact_t1;  /* of t1 (1) */
    double contact_rho; /* and of rho_p over the touching part (m) */
} gmi_side_sum;

/* contact.c: which lines of contact exist on one side, and where. */

/*
 * The lines of contact of one side (drive or coast) on its plane of action. Line k follows
 *     rho_p(t1) = origin + k p_bt + advance t1,
 * the distance from the pinion's base tangent point, and exists where lower <= rho_p <= upper.
 */
typedef struct gmi_lines {
    double delta;   /* ideal penetration, the same on every line (m) */
    double origin;  /* (m) */
    double advance; /* (m) */
    double
        per_advance; /* its inverse; 0 for spur gears, whose lines have no ends within the face (1/m) */

    /* Line k enters the flanks at t1 = enter - k spacing and leaves them at leave - k spacing. */
    double enter, leave, spacing;
    double
        enter_by_delta; /* 1 where a limit of the wheel sets the end, so that it moves with delta; else 0 */
    double leave_by_delta;

    int first, last; /* lines that can exist, none if first > last */
} gmi_lines;

/* The teeth of line `first`, and how they go on: step = +1 or -1 from line k to line k + 1. */
typedef struct gmi_teeth {
    int pinion, wheel;
    int step;
} gmi_teeth;

/* Ideal penetration of one side at x: x - backlash / 2, or -x - backlash / 2 [Paper, Eqs. 10, 20]. */
static inline double gmi_ideal_penetration(const gm_pair *pair, int side, double offset) {
    return (side == GM_DRIVE ? offset : -offset) - 0.5 * pair->backlash;
}

void gmi_lines_find(const gm_pair *pair, int side, const gm_position *position, gmi_lines *lines);
gmi_teeth gmi_lines_teeth(const gm_pair *pair, int side, const gm_position *position,
                          const gmi_lines *lines);
void gmi_side_sum_ideal(const gm_pair *pair, int side, const gm_position *position, int wanted,
                        gmi_side_sum *total);

/* Part of t1 in which line k exists; empty if from >= to. */
typedef struct gmi_interval {
    double from, to;
} gmi_interval;

static inline gmi_interval gmi_line_clip(const gmi_lines *lines, int k) {
    const double shift = (double)k * lines->spacing;
    const double enter = lines->enter - shift;
    const double leave = lines->leave - shift;
    const gmi_interval part = {enter > 0.0 ? enter : 0.0, leave < 1.0 ? leave : 1.0};
    return part;
}

/* flank.c: the deviations of one tooth flank. */

/* Doubles per node of a table: value, second difference along t1, along t2, padding. */
enum gmi_node { GMI_NODE_VALUE, GMI_NODE_FACE, GMI_NODE_PROFILE, GMI_NODE_DOUBLES = 4 };

typedef struct gmi_flank {
    const double *values; /* [face_nodes][profile_nodes][4], NULL = no table */
    double pitch;         /* (m) */
    double peak;          /* most material, pitch included (m) */
} gmi_flank;

/* NULL = ideal. */
static inline const gm_flank_tables *gmi_flanks_side(const gm_flanks *flanks, int side) {
    return flanks == NULL ? NULL : side == GM_DRIVE ? &flanks->drive : &flanks->coast;
}

static inline gmi_flank gmi_flank_of(const gm_flank_tables *tables, int tooth) {
    gmi_flank flank = {NULL, 0.0, 0.0};
    if (tables == NULL) {
        return flank;
    }
    const int table = tables->table[tooth];
    flank.pitch = tables->pitch[tooth];
    flank.peak = flank.pitch;
    if (table >= 0) {
        const size_t nodes = (size_t)tables->face_nodes * (size_t)tables->profile_nodes;
        flank.values = tables->values + (size_t)table * nodes * GMI_NODE_DOUBLES;
        flank.peak += tables->table_peak[table];
    }
    return flank;
}

/* line.c: the integral along one line of contact. */

/*
 * How the lines of one side run through the tables of one gear: the same for all its teeth and all lines. Lines are
 * followed in grid units: v1 = face_rate t1 across the face, s = v1 of the table whose face lines lead, and along
 * the profile u = v2 counted in the direction in which the lines climb. All zero for ideal flanks; a flank with ramps
 * and no tables is one cell, so that v2 = t2.
 */
typedef struct gmi_grid {
    int last_face, last_profile; /* indices of the last cell */
    ptrdiff_t row;               /* doubles from one face line to the next */
    ptrdiff_t step;              /* doubles from one profile line to the next, signed */
    ptrdiff_t corner;            /* doubles from node 0 of a face line to that with u = 0 */
    double base, direction;      /* u = base + direction v2, direction +1 or -1 */
    double profile_cells;        /* largest u */
    double face_rate;            /* d v1 / d t1 */
    double climb;                /* d u / d t1 >= 0 */
    double per_rho;              /* d v2 / d rho (1/m) */
    double face_ratio;           /* d v1 / d s: 1 for the table that leads */
    double rate;                 /* d u / d s > 0 */
    double profile_spacing;      /* its inverse */
    /* Half slope and curvature of f change by these times the second difference of the nodes. */
    double face_kick, profile_kick, bend;
} gmi_grid;

/* climb: d rho / d t1 of this gear along a line, signed (m); length: rho from start to tip (m). */
void gmi_grid_init(gmi_grid *grid, const gm_flank_tables *tables, double climb, double length);

/* One line: t1 from `from` to `to`, with f = gap + 2 half_slope (t1 - from) + tables of both flanks. */
typedef struct gmi_line {
    double from, to;
    double gap;           /* delta, both pitch deviations, and ramps (m) */
    double half_slope;    /* half of what the ramps make of d f / d t1 (m) */
    const double *pinion; /* table, NULL = none */
    const double *wheel;
    double pinion_profile; /* v2 of the pinion's table at t1 = 0 */
    double wheel_profile;
} gmi_line;

/* Integrals over the part of a line where f > 0. */
typedef struct gmi_line_sum {
    double sum;        /* of f (m) */
    double contact;    /* of 1 (1) */
    double pinion;     /* of the pinion's d deviation / d v2 (GMI_DERIVATIVES) (m) */
    double wheel;      /* of the wheel's (m) */
    double sum_t1;     /* of f t1 (GMI_MOMENTS) (m) */
    double contact_t1; /* of t1 (1) */
    double at_from;    /* f itself at both ends (m) */
    double at_to;
} gmi_line_sum;

void gmi_line_integrate(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                        int wanted, gmi_line_sum *result);

/* ramp.c: gmi_line_integrate() with the ramps of both flanks, NULL = none, taken off; line->half_slope is 0. */
void gmi_ramps_integrate(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                         const gm_flank_tables *pinion_tables, const gm_flank_tables *wheel_tables,
                         int wanted, gmi_line_sum *result);

/* penetration.c: the sums over all lines of one side. */
void gmi_side_sum_3d(const gm_pair *pair, const gm_flanks *pinion_flanks,
                     const gm_flanks *wheel_flanks, int side, const gm_position *position,
                     int wanted, gmi_side_sum *total);

/* Status of what an evaluation is given, beyond the pair. */
int gmi_check_evaluation(const gm_pair *pair, const gm_flanks *pinion_flanks,
                         const gm_flanks *wheel_flanks, const gm_position *position);

#endif
