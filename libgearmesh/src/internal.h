/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * What the sources of the core share and users never see. Dependencies run one way:
 * gear -> meshing -> pair -> iso6336, position -> contact -> corner -> flank -> line -> ramp, tilt -> penetration, corner_tangent
 * -> corner_line -> law -> wrench -> mesh -> equilibrium, cache, body, events, tangent.
 */
#ifndef GEARMESH_INTERNAL_H
#define GEARMESH_INTERNAL_H

#include "arithmetic.h"
#include "gearmesh/gearmesh.h"
#include "shared.h"

#include <math.h>
#include <stdint.h>

/* 2 pi = GMI_TWO_PI + GMI_TWO_PI_REMAINDER to 32 digits. */
#define GMI_TWO_PI           6.28318530717958647693
#define GMI_TWO_PI_REMAINDER 2.44929359829470635e-16

/* Angles beyond this are refused: at 1e9 rad one rounding already moves the flank by nanometres. */
#define GMI_LARGEST_ANGLE 1e9

/*
 * Numbers beyond these are refused where they come in. No gear has them, and within them no product in an evaluation
 * overflows, so that evaluations need no checks of their own.
 */
#define GMI_LARGEST_SPEED      1e9   /* of a gear (rad/s), and of approach (m/s) */
#define GMI_LARGEST_OFFSET     1e18  /* of the simple model, which takes any other x (m) */
#define GMI_SMALLEST_LENGTH    1e-6  /* of a pair (m) */
#define GMI_LARGEST_LENGTH     1e9   /* (m) */
#define GMI_LARGEST_DEVIATION  1.0   /* of a flank (m) */
#define GMI_LARGEST_RAMP       1e30  /* its parts (m): they are large where it is short */
#define GMI_SMALLEST_STIFFNESS 1e-30 /* (N/m) */
#define GMI_LARGEST_STIFFNESS  1e30  /* (N/m), and of damping (N s/m) */

/* Compiled once for each combination of its constant arguments. */
#if defined(__GNUC__)
#define SPECIALIZED static inline __attribute__((always_inline))
#else
#define SPECIALIZED static inline
#endif

/* Not inlined: what it has on the stack is not there when its caller calls others. */
#if defined(__GNUC__)
#define OWN_STACK __attribute__((noinline))
#else
#define OWN_STACK
#endif

/* Loops over arrays that do not overlap, as arguments: inlined, gcc forgets that and does one number at a time. */
#if defined(__GNUC__)
#define APART static __attribute__((noinline))
#else
#define APART static
#endif

static inline double gmi_nan(void) {
    return (double)NAN;
}

static inline int gmi_is_finite(double value) {
    return isfinite(value);
}

/* One instruction each, where fmin() and fmax() are calls; b if one of both is no number. */
static inline double gmi_smaller(double a, double b) {
    return a < b ? a : b;
}

static inline double gmi_larger(double a, double b) {
    return a > b ? a : b;
}

/*
 * Cell of a table that holds v, from 0 to last, as a number: adding 2^52 rounds to a whole one as a conversion would, but
 * two at once. Between two cells it is either.
 */
static inline double gmi_cell_of(double v, double last) {
    const double middle = v - 0.5;
    const double above = middle > 0.0 ? middle : 0.0;
    const double within = above < last ? above : last;
    return (within + 0x1p52) - 0x1p52;
}

/* Whether an object may begin at this address. */
static inline int gmi_is_aligned(const void *memory) {
    return (uintptr_t)memory % sizeof(double) == 0;
}

/* a * b = *product + return value, exactly (Dekker; no fused multiply-add needed). */
double gmi_product_remainder(double a, double b, double product);

/*
 * gear.c: geometry of one gear. ISO 21771 gives a ring a negative number of teeth, and with it negative radii and roll
 * lengths, centre distance and line of action: so the formulas of external gears hold for it as they are. What users see
 * has positive lengths; the sign of the gear turns them into those of the standard.
 */
double gmi_involute(double angle);
void gmi_gear_init(gm_gear *gear, int teeth, double transverse_module,
                   double transverse_pressure_angle);
void gmi_gear_set_root(gm_gear *gear, double normal_module);
void gmi_gear_set_tip(gm_gear *gear, double given_radius, double tip_alteration,
                      double normal_module);
void gmi_gear_set_start(gm_gear *gear, double start_radius);
void gmi_gear_set_start_roll_length(gm_gear *gear, double start_roll_length);
void gmi_gear_set_thickness(gm_gear *gear, double normal_thickness, double helix_angle,
                            double transverse_pressure_angle);
void gmi_gear_set_tip_thickness(gm_gear *gear, double helix_angle);

/* meshing.c: two gears at a centre distance. */

/* Of both base radii: the sum, and below 0 the difference of a ring's pair (m). */
static inline double gmi_base_sum(const gm_pair *pair) {
    return pair->pinion.base_radius + pair->wheel.sign * pair->wheel.base_radius;
}

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

    /* [enum gm_role] where the active profile starts at this distance (m) */
    double start_roll_length[2];

    double path_start, path_end;     /* at zero penetration, from the pinion's tangent point (m) */
    double transverse_contact_ratio; /* (1) */

    /* [side] rho_p of tooth 0 at phi_p = 0 where the common face begins (m) */
    double phase_origin[2];

    double working_pitch_radius[2]; /* [enum gm_role] (m) */
    double tip_clearance[2];        /* [enum gm_role] from this gear's tip to the mate's root (m) */
} gmi_meshing;

/* 1 if the gears mesh there: the line of action and the path of contact on it are longer than 0; else 0. */
int gmi_meshing_find(const gm_pair *pair, double center_distance, gmi_meshing *meshing);

/* What is in the way of a ring's pair. */
enum gmi_interference {
    GMI_CLEAR,
    GMI_INVOLUTE_INTERFERENCE, /* the ring's tip reaches beyond the pinion's tangent point */
    GMI_TROCHOID_INTERFERENCE, /* the tips meet beside the path of contact */
    GMI_TRIMMING               /* the tips meet when the pinion is moved in along the centre line */
};

enum gmi_interference gmi_meshing_interference(const gm_pair *pair, const gmi_meshing *meshing);

/* Where the active profile starts: as given, else where it meets the mate's tip; T of a ring's pair is below 0 (m). */
double gmi_start_roll_length(const gm_gear *gear, const gm_gear *mate, double line_of_action);

/* The first part of it, which needs no teeth: line_of_action, working_pressure_angle, involute_difference. */
void gmi_meshing_find_angles(const gm_pair *pair, double center_distance, gmi_meshing *meshing);

/*
 * The pair as it is posed: all of it that moves. t1 runs over the common face of the drawing, also where the faces have
 * moved against each other. Without a pose it is the drawing, to the last bit. The signs are those of ISO 21771, so that
 * what evaluates it knows nothing of rings: lengths of a ring, the centre distance and T are then below 0.
 */
typedef struct gmi_engagement {
    double center_distance;        /* x of the wheel's axis (m) */
    double working_pressure_angle; /* alpha_wt (rad) */
    double sin_pressure_angle, cos_pressure_angle;
    double line_of_action;                /* T = rho_p + rho_w of points that touch (m) */
    double wheel_base_radius;             /* (m) */
    double backlash;                      /* (m) */
    double phase_origin[2];               /* [side] as in gm_pair (m) */
    double start_roll_length[2];          /* [enum gm_role] where the active profile begins (m) */
    int start_follows[2];                 /* 1 where that follows the mate's tip as T changes */
    double tip_roll_length[2];            /* [enum gm_role] where it ends (m) */
    double wheel_profile_start;           /* roll length of the wheel's t2 = 0 (m) */
    double face_from, face_to;            /* t1 between which both gears have a face */
    double face_origin[2], face_scale[2]; /* [enum gm_role] own t1 = face_origin + face_scale t1 */

    /* From the coordinates of the drawing to those of the posed pair; 0 without a pose. */
    double offset_shift; /* added to x (m) */
    double phase_shift;  /* added to the phase (m) */

    /* of the wheel's axis, seen from the pinion's, counter-clockwise from +x (rad) */
    double axis_direction;
    double axis[2]; /* its unit vector */

    /* The wheel's rotation vector about the middle of its own face, along the line of action and across it. */
    int is_tilted;
    double along[2], across[2]; /* [side] -+theta.e, -+theta.t, upper signs drive (rad) */
    double face_center;         /* z of that middle (m) */
} gmi_engagement;

static inline int gmi_is_at_rest(const gm_pose *pose) {
    return pose->center_distance_change == 0.0 && pose->offset == 0.0 && pose->axial_shift == 0.0 &&
           pose->skew == 0.0 && pose->inclination == 0.0;
}

/* How fast the flanks of one side approach each other: the same all over it but for what a tilt does. */
typedef struct gmi_rates {
    double delta;         /* of parallel axes (m/s) */
    double along, across; /* d gmi_engagement.along / dt, d across / dt (rad/s) */

    /* Of the wheel's body across the line of action, as friction has it, and along it, at t1 = 0 and more per t1 (m/s). */
    double sideways[2], forward[2];
} gmi_rates;

/* Line of action of a side in the transverse section: e along it, t across, clockwise from e on the drive side. */
typedef struct gmi_plane {
    double e[2], t[2];
} gmi_plane;

static inline gmi_plane gmi_plane_of(const gmi_engagement *at, double sign) {
    const double s = at->sin_pressure_angle, c = sign * at->cos_pressure_angle;
    const double e[2] = {at->axis[0] * s - at->axis[1] * c, at->axis[1] * s + at->axis[0] * c};
    const gmi_plane plane = {{e[0], e[1]}, {sign * e[1], -sign * e[0]}};
    return plane;
}

void gmi_rates_find(const gm_pair *pair, const gmi_engagement *at, double offset_rate,
                    const gm_pose *pose_rate, gmi_rates rates[2]);

/* NULL = no pose. Returns GM_OK, GM_STATE_NOT_FINITE or GM_POSE_OUT_OF_MESH. */
int gmi_engagement_find(const gm_pair *pair, const gm_pose *pose, gmi_engagement *engagement);

/* A gear with tables: they end where the drawing's profile does, also where that would now begin deeper. */
void gmi_engagement_keep_tables(const gm_pair *pair, int role, gmi_engagement *at);

/* What an evaluation accumulates beside sum, contact and pairs: a mask. */
enum gmi_wanted {
    GMI_SUM = 0,
    GMI_DERIVATIVES = 1,         /* of the sum, by the origin of the lines and by delta */
    GMI_MOMENTS = 2,             /* first moments over t1 and rho_p */
    GMI_ROLL = 8,                /* what a common roll of all lines does to the energy */
    GMI_CONTACT_DERIVATIVES = 4, /* of the touching part; only together with GMI_DERIVATIVES */
    GMI_TANGENT = 16,            /* all of gmi_side_tangent; only together with GMI_MOMENTS */
    GMI_DEPTHS = 32,    /* gmi_depths in place of the sums; only together with GMI_DERIVATIVES */
    GMI_SQUARES = 64,   /* the sum is that of the overlap squared (m2), and nothing else is there */
    GMI_STRETCHES = 128 /* where the flanks touch along a line, in place of the sums */
};

/* The sums over all lines of one side. */
typedef struct gmi_side_sum {
    double sum;     /* sum of the integrals of max(0, delta) dt1 (m) */
    double contact; /* touching part of the face width, summed (1) */
    int pairs;      /* lines that touch; -1: not counted */

    /* Partial derivatives by the origin of the lines and by delta: */
    double by_origin, by_delta; /* of the sum (GMI_DERIVATIVES) (1) */
    double contact_by_origin,
        contact_by_delta; /* of the touching part (GMI_CONTACT_DERIVATIVES) (1/m) */

    /* GMI_MOMENTS: integrals over the touching part. */
    double sum_t1;      /* of max(0, delta) t1 (m) */
    double sum_rho;     /* of max(0, delta) rho_p (m2) */
    double contact_t1;  /* of t1 (1) */
    double contact_rho; /* of rho_p (m) */

    /* GMI_ROLL: energy by a common roll of all lines, over the stiffness; 0 with constant stiffness (m) */
    double roll;
} gmi_side_sum;

static inline gmi_side_sum gmi_no_contact(void) {
    const gmi_side_sum none = {0.0, 0.0, 0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    return none;
}

/* +1 for drive flanks, -1 for coast flanks: the coast side is the drive side seen in a mirror. */
static inline double gmi_side_sign(int side) {
    return side == GM_DRIVE ? 1.0 : -1.0;
}

/*
 * position.c: of angles whose whole turns are not known: that x + shift is taken which is within half a base pitch, and
 * the wheel's tooth that is there.
 */
int gmi_position_nearest(const gm_pair *pair, const gm_state *state, double shift,
                         gm_position *position);

/* contact.c: which lines of contact exist on one side, and where. */

/*
 * The lines of contact of one side (drive or coast) on its plane of action. Line k follows
 *     rho_p(t1) = origin + k p_bt + advance t1,
 * the distance from the pinion's base tangent point, and exists where lower <= rho_p <= upper.
 */
typedef struct gmi_lines {
    double delta;        /* ideal penetration, the same on every line (m) */
    double origin;       /* (m) */
    double advance;      /* (m) */
    double lower, upper; /* limits of rho_p (m) */

    /* 1 where the wheel sets the limit, so that it moves with delta; else 0 */
    double lower_by_delta;

    double upper_by_delta;
    double fall, rise; /* a line covers origin + [fall, rise] of the line of action (m) */
    int first, last;   /* lines that can exist, none if first > last */
} gmi_lines;

/* Where the lines enter and leave the flanks as t1 grows: line k at enter - k spacing and leave - k spacing. */
typedef struct gmi_line_ends {
    /* 1 / advance; 0 for spur gears, whose lines have no ends within the face (1/m) */
    double per_advance;

    double enter, leave, spacing;
    double enter_by_delta, leave_by_delta; /* 1 where the end moves with delta, else 0 */
    double face_from, face_to;             /* where the face begins and ends */
} gmi_line_ends;

/* The teeth of line `first`, and how they go on: step = +1 or -1 from line k to line k + 1. */
typedef struct gmi_teeth {
    int pinion, wheel;
    int step;
} gmi_teeth;

/* The tooth after this one, or before it. */
static inline int gmi_next_tooth(int tooth, int step, int teeth) {
    const int next = tooth + step;
    return next < 0 ? teeth - 1 : next == teeth ? 0 : next;
}

/* Ideal penetration of one side at x: x - backlash / 2, or -x - backlash / 2 [Paper, Eqs. 10, 20]. */
static inline double gmi_ideal_penetration(const gmi_engagement *at, int side, double offset) {
    return (side == GM_DRIVE ? offset : -offset) - 0.5 * at->backlash;
}

void gmi_lines_find(const gm_pair *pair, const gmi_engagement *at, int side,
                    const gm_position *position, gmi_lines *lines);

/* The same lines with other limits: also those that meet these. */
void gmi_lines_widen(const gm_pair *pair, double lower, double upper, gmi_lines *lines);

/* The same lines at another delta, which moves their limits. */
void gmi_lines_limit(const gmi_engagement *at, double delta, gmi_lines *lines);
gmi_line_ends gmi_line_ends_find(const gm_pair *pair, const gmi_engagement *at,
                                 const gmi_lines *lines);
gmi_teeth gmi_lines_teeth(const gm_pair *pair, int side, const gm_position *position,
                          const gmi_lines *lines);
void gmi_side_sum_ideal(const gm_pair *pair, const gmi_engagement *at, int side,
                        const gm_position *position, int wanted, gmi_side_sum *total);

/* Part of t1 in which line k exists; empty if from >= to. */
typedef struct gmi_interval {
    double from, to;
} gmi_interval;

static inline gmi_interval gmi_line_clip(const gmi_line_ends *ends, int k) {
    const double shift = (double)k * ends->spacing;
    const double enter = ends->enter - shift;
    const double leave = ends->leave - shift;
    const gmi_interval part = {enter > ends->face_from ? enter : ends->face_from,
                               leave < ends->face_to ? leave : ends->face_to};
    return part;
}

/* flank.c: the deviations of the tooth flanks of one gear. */

/* One side (drive or coast) of all teeth of a gear: views over the caller's memory, and ramps. */
typedef struct gmi_tables {
    int face_nodes;     /* grid lines along t1; without tables 0, or 2 if there are ramps */
    int profile_nodes;  /* grid lines along t2; likewise */
    int capacity;       /* table places */
    int count;          /* table places taken */
    double peak;        /* most material of any tooth, pitch included, before ramps (m) */
    double *values;     /* [capacity][face_nodes][profile_nodes][GMI_NODE_DOUBLES] (m) */
    double *table_peak; /* [capacity] largest node value (m) */
    double *pitch;      /* [teeth] transverse pitch deviation, > 0 material added (m) */
    int *table;         /* [teeth] table of a tooth, -1 = ideal */
    int ramp_count;     /* 0 .. GM_FLANK_RAMPS_MAX */
    gm_flank_ramp ramps[GM_FLANK_RAMPS_MAX]; /* of all teeth, in the transverse section */
} gmi_tables;

struct gm_flanks {
    int teeth;
    gmi_tables side[2]; /* GM_DRIVE, GM_COAST */
};

/* Doubles per node of a table: value, second difference along t1, along t2, and in place of one gmi_bounds. */
enum gmi_node {
    GMI_NODE_VALUE,
    GMI_NODE_FACE,
    GMI_NODE_PROFILE,
    GMI_NODE_BOUNDS,
    GMI_NODE_DOUBLES
};

/*
 * Lowest and highest node of a window: from its own node on so many cells across the face, and so many to either side along
 * the profile, as far as the table goes (m).
 */
enum { GMI_WINDOW_FACE = 2, GMI_WINDOW_PROFILE = 2 };
typedef struct gmi_bounds {
    float lowest, highest; /* rounded outwards by more than an evaluation rounds */
} gmi_bounds;

typedef struct gmi_flank {
    const double *values; /* [face_nodes][profile_nodes][4], NULL = no table */
    double pitch;         /* (m) */
    double peak;          /* most material, pitch included (m) */
} gmi_flank;

/* NULL = ideal. */
static inline const gmi_tables *gmi_flanks_side(const gm_flanks *flanks, int side) {
    return flanks == NULL ? NULL : &flanks->side[side];
}

static inline gmi_flank gmi_flank_of(const gmi_tables *tables, int tooth) {
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
    int shares_faces; /* of the wheel's: the face lines of both gears' tables are the same */
    int last_face, last_profile;    /* indices of the last cell */
    ptrdiff_t row;                  /* doubles from one face line to the next */
    ptrdiff_t step;                 /* doubles from one profile line to the next, signed */
    ptrdiff_t corner;               /* doubles from node 0 of a face line to that with u = 0 */
    double base, direction;         /* u = base + direction v2, direction +1 or -1 */
    double profile_cells;           /* largest u */
    double face_base, face_rate;    /* v1 = face_base + face_rate t1, t1 of the common face */
    double face_origin, face_scale; /* t1 of this gear = face_origin + face_scale t1 */
    double climb;                   /* d u / d t1 >= 0 */
    double per_rho;                 /* d v2 / d rho (1/m) */
    double face_ratio;              /* d v1 / d s: 1 for the table that leads */
    double rate;                    /* d u / d s > 0 */
    double profile_spacing;         /* its inverse */
    /* Half slope and curvature of f change by these times the second difference of the nodes. */
    double face_kick, profile_kick, bend;
} gmi_grid;

/* climb: d rho / d t1 of this gear along a line, signed (m); length: rho from start to tip (m); own t1 of the gear. */
void gmi_grid_init(gmi_grid *grid, const gmi_tables *tables, double climb, double length,
                   double face_origin, double face_scale);

/* The table of this gear now begins at another place along the common face. */
void gmi_grid_move(gmi_grid *grid, double face_origin);

/* Lines stay where they are along the profile of this table. */
void gmi_grid_hold(gmi_grid *grid);

/* What moves the lines of one side and what is on them: its coordinates. */
enum gmi_coordinate {
    GMI_BY_ORIGIN, /* of the lines (m) */
    GMI_BY_DELTA,  /* ideal penetration (m) */
    GMI_BY_LENGTH, /* of the line of action (m) */
    GMI_BY_ALONG,  /* the tilt along the line of action, gmi_engagement.along (rad) */
    GMI_BY_ACROSS, /* and across it (rad) */
    GMI_BY_AXIAL,  /* the wheel's face (m) */
    GMI_COORDINATES
};

/*
 * How f along a line moves with the coordinates of its side, and how fast it approaches: by polynomials in t1, and by
 * what the tables have at the points looked up. In the result integrals over the touching part.
 */
typedef struct gmi_line_tangent {
    double by[GMI_COORDINATES]
             [3];    /* beside the tables; of second order by the length and the tilts alone */
    double speed[2]; /* of approach (m/s); line.c leaves it and the next to others */

    /* u of tilt.c: the speed of approach falls by it times that of the tilt across (m) */
    double arm[2];

    double pinion_per_rho, wheel_per_rho,
        face_per_length; /* d v2 / d rho of both, d v1 / d z of the wheel (1/m) */

    /* Times 1 and t1, over all parts of the line: */
    double contact[4];                 /* of 1, t1, t1^2, t1^3 */
    double sum_by[GMI_COORDINATES][2]; /* of d f / d coordinate */
    double contact_by[GMI_COORDINATES]
                     [3]; /* how the touching part moves, at the roots of f; and times t1^2 */

} gmi_line_tangent;

/*
 * One line: t1 from `from` to `to`, with f = overlap + 2 half_slope s + curvature s^2 + tables of both flanks, s = t1 - from.
 */
typedef struct gmi_line {
    double from, to;
    double overlap;       /* delta, both pitch deviations, and ramps (m) */
    double half_slope;    /* half of what ramps and tilt make of d f / d t1 there (m) */
    double curvature;     /* half of what the tilt makes of d2 f / d t1^2 (m) */
    const double *pinion; /* table, NULL = none */
    const double *wheel;
    double pinion_profile; /* v2 of the pinion's table at t1 = 0 */
    double wheel_profile;
    gmi_line_tangent *tangent; /* GMI_TANGENT */
} gmi_line;

/* The part of a line between two places: the parabola as seen from where it begins. */
static inline gmi_line gmi_line_between(const gmi_line *line, double from, double to) {
    gmi_line part = *line;
    const double gone = from - line->from;
    part.from = from;
    part.to = to;
    part.overlap += gone * (2.0 * line->half_slope + gone * line->curvature);
    part.half_slope += gone * line->curvature;
    return part;
}

/* At one depth: the sum, its derivatives by delta and by the origin of the lines, and half of its second one by delta. */
typedef struct gmi_depth_sum {
    double sum, by_delta, by_origin, bend;
} gmi_depth_sum;

/* One end of a line: how f changes from there on with t1 and with the shift (m). */
typedef struct gmi_depth_end {
    double slope, curvature; /* the latter half the second derivative */
    double grows, grows_rate;
} gmi_depth_end;

/*
 * A side at many depths from one walk along its lines (GMI_DEPTHS): delta is that of the walk and a shift. With the shift f
 * grows by itself and by the slope of the wheel's flank, whose place moves, and with it the kinks of its table; where the
 * wheel sets the ends of lines these move. That is the whole of it as long as no kink or end that moves passes another one
 * or a place where f is zero.
 */
enum { GMI_DEPTHS_MAX = 41 };
typedef struct gmi_depths {
    int count;
    double shift[GMI_DEPTHS_MAX]; /* ascending (m) */
    double largest;               /* the last one; -infinite without any */
    double per_shift; /* depths per shift on average; 0 if they are all the same (1/m) */
    double touch; /* least shift at which anything touches, if it is below what it is set to (m) */

    /* Of pieces that touch all along from depth n on, without shift; of those that touch in part, and of the ends. */
    gmi_depth_sum whole[GMI_DEPTHS_MAX], part[GMI_DEPTHS_MAX];
    double cube[GMI_DEPTHS_MAX]; /* by the third power of the shift, from depth n on */

    /* Of the line at hand, by the slopes of the table that leads and of the other one: */
    double per_place;                 /* from its places to t1 */
    double shift_first, shift_second; /* d f / d shift */
    double origin_first, origin_second;
    gmi_depth_end from, to;
} gmi_depths;

/* Integrals over the part of a line where f > 0. */
typedef struct gmi_line_sum {
    double sum;        /* of f (m) */
    double contact;    /* of 1 (1) */
    double pinion;     /* of the pinion's d deviation / d v2 (GMI_DERIVATIVES) (m) */
    double wheel;      /* of the wheel's (m) */
    double sum_t1;     /* of f t1 (GMI_MOMENTS) (m) */
    double contact_t1; /* of t1 (1) */

    /* Over the roots of f within the line, where the touching part ends (GMI_CONTACT_DERIVATIVES): */
    double roots;        /* sum of 1 / |df/dt1| (1/m) */
    double roots_pinion; /* of the pinion's d deviation / d v2, over |df/dt1| (1) */
    double roots_wheel;  /* of the wheel's (1) */

    double at_from; /* f itself at both ends (m) */
    double at_to;
    gmi_depths *depths; /* GMI_DEPTHS */
} gmi_line_sum;

/* What the tables add to d f / d coordinate, from the slopes of the pinion, of the wheel and of the wheel's face. */
static inline void gmi_line_add_slopes(const gmi_line_tangent *tangent, double pinion, double wheel,
                                       double face, double by[GMI_COORDINATES]) {
    const double by_pinion = tangent->pinion_per_rho * pinion;
    const double by_wheel = tangent->wheel_per_rho * wheel;
    by[GMI_BY_ORIGIN] += by_pinion - by_wheel;
    by[GMI_BY_DELTA] += by_wheel;
    by[GMI_BY_LENGTH] += by_wheel;
    by[GMI_BY_AXIAL] -= tangent->face_per_length * face;
}

/* The same at all depths; the result has f at both ends of the line at the depth of the walk. */
void gmi_line_integrate_depths(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                               gmi_depths *depths, gmi_line_sum *result);

/* Of f squared, and of 1, alone. */
void gmi_line_integrate_squares(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                                gmi_line_sum *result);

/* f at one place of a line without ramps and tilt (m). */
double gmi_line_value(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                      double t1);

/* wanted: none of GMI_TANGENT, GMI_DEPTHS and GMI_SQUARES. */
void gmi_line_integrate(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                        int wanted, gmi_line_sum *result);

/* Sum and moments with the line's tangent: apart, as it takes more stack. */
void gmi_line_integrate_tangent(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                                gmi_line_sum *result);

/* ramp.c: gmi_line_integrate() with the ramps of both flanks, NULL = none, taken off. */
void gmi_ramps_integrate(const gmi_line *line, const gmi_grid *pinion, const gmi_grid *wheel,
                         const gmi_tables *pinion_tables, const gmi_tables *wheel_tables,
                         int wanted, gmi_line_sum *result);
void gmi_ramps_integrate_tangent(const gmi_line *line, const gmi_grid *pinion,
                                 const gmi_grid *wheel, const gmi_tables *pinion_tables,
                                 const gmi_tables *wheel_tables, gmi_line_sum *result);

/* tilt.c: lines of contact between tilted axes. */

/* The part of a line on both flanks, none where not from < to, what ends it, and how its ends move. */
typedef struct gmi_line_part {
    double from, to; /* t1 */
    int from_place, to_place;
    double from_by[GMI_COORDINATES], to_by[GMI_COORDINATES];
} gmi_line_part;

/* One end of the lines of a side: a place is within its limits from enter to leave (t1), less by_origin rho_origin. */
typedef struct gmi_tilt_cut {
    double enter, leave, by_origin;
} gmi_tilt_cut;

/* All that ends the lines of a side, and the pinion's face. */
enum { GMI_TILT_CUTS_MAX = 5 };
typedef struct gmi_tilt_cuts {
    gmi_interval face;
    gmi_tilt_cut cut[GMI_TILT_CUTS_MAX];
    unsigned char place[GMI_TILT_CUTS_MAX]; /* of each cut */
    unsigned char count;
} gmi_tilt_cuts;

/* What ends lines beside the faces, tips and starts, or does not: a sum of these. */
enum {
    GMI_ENDS_WITH_PINION_TABLE = 1,
    GMI_ENDS_WITH_WHEEL_TABLE = 2,
    GMI_FACES_ALONE = 4 /* tips and starts end none */
};

/* ends: a sum of the above. */
void gmi_tilt_cuts_find(const gm_pair *pair, const gmi_engagement *at, int side, double delta,
                        int ends, gmi_tilt_cuts *cuts);

/* The part of one line; 0 where there is none. Not from_by and to_by, which gmi_tilt_move_ends() sets. */
int gmi_tilt_cut_line(const gmi_tilt_cuts *cuts, double rho_origin, gmi_line_part *part);
void gmi_tilt_move_ends(const gm_pair *pair, const gmi_engagement *at, int side, double rho_origin,
                        double delta, gmi_line_part *part);

/* One of both ends alone; 0 where it does not move. */
int gmi_tilt_move_end(const gm_pair *pair, const gmi_engagement *at, int side, double rho_origin,
                      double delta, const gmi_line_part *part, int is_beginning,
                      double by[GMI_COORDINATES]);

/* How far a line is beyond the tip of a gear: at_zero + per_t1 t1 (m), and how it moves. */
typedef struct gmi_beyond {
    double at_zero, per_t1;
    double by_origin, by_delta; /* (1) */
} gmi_beyond;

void gmi_tilt_beyond(const gm_pair *pair, const gmi_engagement *at, int side, double rho_origin,
                     double delta, int role, gmi_beyond *beyond);

/* How it moves with all coordinates of the side: at t1 = 0, and per t1. */
void gmi_tilt_beyond_by(const gm_pair *pair, const gmi_engagement *at, int side, double rho_origin,
                        int role, double by[GMI_COORDINATES][2]);

/* Speed of approach, on average over the touching part; sum with GMI_MOMENTS where the tilt changes. */
double gmi_rates_mean_approach(const gmi_rates *rates, const gm_pair *pair,
                               const gmi_engagement *at, int side, const gmi_side_sum *sum);

/* f along a line is gain delta + shift, a polynomial in t1, and d f / d rho another. */
typedef struct gmi_tilted_line {
    double gain;         /* (1) */
    double shift[3];     /* (m) */
    double by_origin[2]; /* (1) */
} gmi_tilted_line;

/* The same for all lines of a side: polynomials in rho_p at t1 = 0 too. */
typedef struct gmi_tilt {
    double gain;           /* (1) */
    double shift[3];       /* (m) */
    double by_rho[2];      /* of the first two (1) */
    double by_rho_squared; /* of the first (1/m) */
} gmi_tilt;

void gmi_tilt_find(const gm_pair *pair, const gmi_engagement *at, int side, gmi_tilt *tilt);

static inline gmi_tilted_line gmi_tilt_of_line(const gmi_tilt *tilt, double rho_origin) {
    const double by_square = tilt->by_rho_squared * rho_origin;
    const gmi_tilted_line line = {
        tilt->gain,
        {tilt->shift[0] + rho_origin * (tilt->by_rho[0] + by_square),
         tilt->shift[1] + rho_origin * tilt->by_rho[1], tilt->shift[2]},
        {tilt->by_rho[0] + 2.0 * by_square, tilt->by_rho[1]},
    };
    return line;
}

void gmi_tilt_line(const gm_pair *pair, const gmi_engagement *at, int side, double rho_origin,
                   gmi_tilted_line *line);

/* What the polynomials of the tangents of all lines of a side follow from. */
typedef struct gmi_tilt_motion {
    double tau, u,
        u_per_t1;      /* u of the line with rho_p = 0 at t1 = 0, there and more per t1 (1, m) */
    double per_length; /* 1 / T (1/m) */
    double gain;       /* (1) */
    double linear, square;                        /* of the overlap as a polynomial in u (1, 1/m) */
    double along, across;                         /* the tilts (rad) */
    double by_along, by_across, by_across_per_t1; /* by the tilts, what does not go with u (m) */
    double speed, speed_by_arm;                   /* of approach (m/s, 1/s) */
} gmi_tilt_motion;

void gmi_tilt_motion_find(const gm_pair *pair, const gmi_engagement *at, int side, double delta,
                          const gmi_rates *rates, gmi_tilt_motion *motion);

/* Those of one line: by, arm and speed. */
void gmi_tilt_tangent(const gmi_tilt_motion *motion, double rho_origin, gmi_line_tangent *tangent);

/* d f / d delta of a side (1). */
double gmi_tilt_gain(const gm_pair *pair, const gmi_engagement *at, int side);

/* f exceeds delta nowhere on a side by more than this; and ends of lines move along rho_p by no more than *reach (m). */
double gmi_tilt_bound(const gm_pair *pair, const gmi_engagement *at, int side, double *reach);

/* By how much that bound grows with the roll beyond the tips (1). */
double gmi_tilt_bound_by_roll(const gm_pair *pair, const gmi_engagement *at, int side);

/* penetration.c: the sums over all lines of one side. */

/* One side of a mesh: what all its evaluations have in common. */
typedef struct gmi_side {
    const gmi_tables *pinion; /* NULL = ideal */
    const gmi_tables *wheel;
    gmi_grid pinion_grid; /* not set where both flanks are ideal */
    gmi_grid wheel_grid;
    int ramps;         /* of both flanks */
    int is_tilted;     /* the axes are */
    double tilt_bound; /* what tilted axes add to the overlap at most (m) */
    double tilt_reach; /* by what they move the ends of lines at most (m) */
    double flank_peak; /* most material of both flanks (m) */
    double peak;       /* both: nothing touches at a delta <= -peak (m) */
} gmi_side;

void gmi_side_init(gmi_side *prepared, const gm_pair *pair, const gmi_engagement *at,
                   const gm_flanks *pinion_flanks, const gm_flanks *wheel_flanks, int side);

/* The same side in another pose. */
void gmi_side_move(gmi_side *prepared, const gm_pair *pair, const gmi_engagement *at, int side);

/*
 * A side of flanks without ramps between parallel axes at all depths from one walk: `part` has the sums in the end.
 */
void gmi_side_sum_depths(const gm_pair *pair, const gmi_engagement *at, const gmi_side *prepared,
                         int side, const gm_position *position, gmi_depths *depths);

void gmi_side_sum_tables(const gm_pair *pair, const gmi_engagement *at, const gmi_side *prepared,
                         int side, const gm_position *position, int wanted, gmi_side_sum *total);

/* gmi_side_sum.pairs of such a side alone. */
int gmi_side_count_pairs(const gm_pair *pair, const gmi_engagement *at, const gmi_side *prepared,
                         int side, const gm_position *position);

void gmi_side_sum_simple(const gm_pair *pair, const gmi_engagement *at, int side, double offset,
                         gmi_side_sum *total);

/* penetration.c: the energy of one side with constant stiffness, K / 2 times the integral of the overlap squared (J). */
double gmi_side_energy(const gm_mesh *mesh, int side, const gm_position *position);

/* Weights of integrals over the touching part. */
enum gmi_weight { GMI_WHOLE, GMI_BY_T1, GMI_BY_RHO, GMI_WEIGHTS };

/* What the force of a side depends on: its coordinates, how fast its flanks approach, and with friction how they slide. */
enum gmi_variable {
    GMI_BY_DELTA_RATE = GMI_COORDINATES, /* of gmi_rates (m/s) */
    GMI_BY_ALONG_RATE,                   /* (rad/s) */
    GMI_BY_ACROSS_RATE,                  /* (rad/s) */
    GMI_LOAD_VARIABLES,

    GMI_BY_PINION_SPEED = GMI_LOAD_VARIABLES, /* of gmi_sliding (rad/s) */
    GMI_BY_WHEEL_SPEED,                       /* (rad/s) */
    GMI_BY_SIDEWAYS,                          /* both numbers of gmi_rates (m/s) */
    GMI_BY_SIDEWAYS_T1,
    GMI_VARIABLES,

    GMI_BY_FORWARD = GMI_VARIABLES, /* likewise; of friction at tips (m/s) */
    GMI_BY_FORWARD_T1,
    GMI_TIP_VARIABLES
};

/* The normal force of a part of a line or of a side, in the transverse section; and how it moves. */
typedef struct gmi_load {
    double force[GMI_WEIGHTS]; /* times 1, t1, rho_p (N, N, N m) */
    double contact[2];         /* touching part, times 1 and t1 (1) */
} gmi_load;

typedef struct gmi_load_by {
    double force[GMI_LOAD_VARIABLES][GMI_WEIGHTS];
    const double (*contact)[3]; /* gmi_line_tangent.contact_by of a part; NULL of a side */
} gmi_load_by;

/* The force of a side with all that moves it; below 0 where damping takes it away. */
typedef struct gmi_side_tangent {
    gmi_rates rates; /* given */
    double flow;     /* integral of the speed of approach over what touches (m/s) */
    gmi_load load;
    gmi_load_by by;
    double arm
        [GMI_WEIGHTS]; /* integrals of gmi_line_tangent.arm over what touches, but for friction (m) */
    gmi_line_tangent line; /* at hand */
} gmi_side_tangent;

gm_penetration gmi_penetration_nan(void);

/* One comparison: below 0 is far above as unsigned. */
static inline int gmi_is_tooth(int tooth, int teeth) {
    return (unsigned)tooth < (unsigned)teeth;
}

/* Status of a position in the 3D model. */
static inline int gmi_check_position(const gm_pair *pair, const gm_position *position) {
    /* Negated, so that NaN is caught; a phase may be rounded up to p_bt. */
    if (!(fabs(position->offset) < 0.5 * pair->transverse_base_pitch) ||
        !(fabs(position->phase) < 1.5 * pair->transverse_base_pitch) ||
        !(fabs(position->offset_rate) <= GMI_LARGEST_SPEED)) {
        return gmi_is_finite(position->offset) && gmi_is_finite(position->phase) &&
                       gmi_is_finite(position->offset_rate)
                   ? GM_STATE_OUT_OF_RANGE
                   : GM_STATE_NOT_FINITE;
    }
    if (!gmi_is_tooth(position->pinion_tooth, pair->pinion.teeth) ||
        !gmi_is_tooth(position->wheel_tooth, pair->wheel.teeth)) {
        return GM_ERR_TOOTH;
    }
    return GM_OK;
}

/* Status of x and dx/dt in any model. */
int gmi_check_offset(double offset, double offset_rate);

/* Status of a speed of a gear, as friction takes it. */
static inline int gmi_check_speed(double speed) {
    if (fabs(speed) <= GMI_LARGEST_SPEED) {
        return GM_OK;
    }
    return gmi_is_finite(speed) ? GM_STATE_OUT_OF_RANGE : GM_STATE_NOT_FINITE;
}

int gmi_check_flanks(const gm_pair *pair, const gm_flanks *pinion_flanks,
                     const gm_flanks *wheel_flanks);

/* law.c: from overlap to force, and back. */

/* The law of one mesh. */
typedef struct gmi_law {
    /* of one pair over the common face width; of the mesh in the simple model (N/m) */
    double stiffness;

    double damping;        /* likewise (N s/m) */
    double mean_stiffness; /* of the mesh over all pairs that touch on average (N/m) */
} gmi_law;

gmi_law gmi_law_of(const gm_mesh_params *params, const gm_pair *pair);

/* What the flanks of one side do. */
typedef struct gmi_side_force {
    double force;               /* >= 0, along the transverse line of action (N) */
    double by_origin, by_delta; /* its partial derivatives (N/m) */
    double by_speed;            /* by the approach speed (N s/m) */
    double force_t1;            /* force times mean t1 (N) */
    double force_rho;           /* force times mean rho_p (N m) */
} gmi_side_force;

/* Force of a side; here to be inlined. Constant law [Paper, Eq. 3]: K sum + D contact v, v the speed of approach. */
static inline void gmi_law_force(const gmi_law *law, const gmi_side_sum *sum, double approach_speed,
                                 int wanted, gmi_side_force *result) {
    const double k = law->stiffness;
    const double d = law->damping;
    const gmi_side_force none = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    *result = none;

    /* Teeth do not pull: damping may take the force of a side away, never turn it round. */
    const double force = k * sum->sum + d * (approach_speed * sum->contact);
    if (!(force > 0.0)) {
        return;
    }
    result->force = force;

    /* The touching part moves with the flanks as well, and with it the damping. */
    const double viscous = d * approach_speed;
    if (wanted & GMI_DERIVATIVES) {
        result->by_origin = k * sum->by_origin;
        result->by_delta = k * sum->by_delta;
        result->by_speed = d * sum->contact;
    }
    if (wanted & GMI_CONTACT_DERIVATIVES) {
        result->by_origin += viscous * sum->contact_by_origin;
        result->by_delta += viscous * sum->contact_by_delta;
    }
    if (wanted & GMI_MOMENTS) {
        result->force_t1 = k * sum->sum_t1 + viscous * sum->contact_t1;
        result->force_rho = k * sum->sum_rho + viscous * sum->contact_rho;
    }
}

/* The same from the tangent of a side, on which each point may have a speed of approach of its own. */
static inline void gmi_law_force_of_tangent(const gmi_side_tangent *tangent,
                                            gmi_side_force *result) {
    const gmi_side_force none = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    const double *force = tangent->load.force;
    *result = none;
    if (!(force[GMI_WHOLE] > 0.0)) {
        return;
    }
    result->force = force[GMI_WHOLE];
    result->force_t1 = force[GMI_BY_T1];
    result->force_rho = force[GMI_BY_RHO];
    result->by_origin = tangent->by.force[GMI_BY_ORIGIN][GMI_WHOLE];
    result->by_delta = tangent->by.force[GMI_BY_DELTA][GMI_WHOLE];
    result->by_speed = tangent->by.force[GMI_BY_DELTA_RATE][GMI_WHOLE];
}

/* Net sum of overlaps that carries a torque at rest (m). */
double gmi_law_sum_of_torque(const gmi_law *law, double torque, double base_radius);

/* friction.c: from the force of a part of a line to what friction makes of it. */

/* Places at which lines are cut into parts with a sliding speed each. */
enum { GMI_FRICTION_CUTS = 7 };

/* The friction of one mesh. */
typedef struct gmi_friction {
    int is_on;
    int law;                        /* enum gm_friction_law */
    double factor;                  /* mu of the constant law; else what of its law never changes */
    double normal;                  /* normal force per transverse force, 1 / cos(beta_b) (1) */
    double creep_squared;           /* v0^2 (m2/s2) */
    double pitch_point;             /* rho_p there (m) */
    double cuts[GMI_FRICTION_CUTS]; /* in rho_p, ascending; the pitch point in their middle (m) */
} gmi_friction;

gmi_friction gmi_friction_of(const gm_mesh_params *params, const gm_pair *pair,
                             const gmi_engagement *at);

/* Pitch point and cuts of the gears as they stand; and the derivative of cut k by T. */
void gmi_friction_place(const gm_pair *pair, const gmi_engagement *at, gmi_friction *friction);
double gmi_friction_cut_by_length(const gm_pair *pair, const gmi_engagement *at,
                                  const gmi_friction *friction, int k);

/* What a solver knows, in the order of gm_gradient. */
enum gmi_motion {
    GMI_PINION_ANGLE,
    GMI_WHEEL_ANGLE,
    GMI_PINION_SPEED,
    GMI_WHEEL_SPEED,
    GMI_MOTIONS
};

/* A number and its derivatives. */
typedef struct gmi_varying {
    double value;
    double by[GMI_MOTIONS];
} gmi_varying;

static inline void gmi_varying_add_product(const gmi_varying *a, const gmi_varying *b,
                                           gmi_varying *sum) {
    sum->value += a->value * b->value;
    for (int k = 0; k < GMI_MOTIONS; ++k) {
        sum->by[k] += a->value * b->by[k] + a->by[k] * b->value;
    }
}

/* From derivatives by line origin, delta and speed of approach of a side to those by what a solver knows. */
static inline gmi_varying gmi_varying_of(const gm_pair *pair, int side, double value,
                                         double by_origin, double by_delta, double by_speed) {
    const double r_bp = gmi_side_sign(side) * pair->pinion.base_radius;
    const double r_bw = gmi_side_sign(side) * pair->wheel.base_radius;
    const gmi_varying result = {
        value,
        {r_bp * (by_delta + by_origin), -r_bw * by_delta, r_bp * by_speed, -r_bw * by_speed}};
    return result;
}

/* How the flanks of one side slide on each other. */
typedef struct gmi_sliding {
    const gmi_friction *friction;
    double pinion_speed, wheel_speed; /* in the signs of ISO 21771 (rad/s) */
    double wheel_sign;
    double line_of_action; /* T (m) */
    double sideways[2],
        forward[2]; /* of gmi_rates: where the wheel's axis moves, the flanks slide by less (m/s) */
    gmi_varying rolling; /* sum of both speeds of rolling in the pitch point, v0 included (m/s) */
} gmi_sliding;

/* rates: of the side, NULL = the axes stand still. */
void gmi_sliding_find(const gmi_friction *friction, const gm_pair *pair, const gmi_engagement *at,
                      const gm_position *position, const gmi_rates *rates, gmi_sliding *sliding);

/* The normal force of a part of a line, in the transverse section. */
typedef struct gmi_part_force {
    gmi_varying force;      /* (N) */
    gmi_varying moment;     /* times mean rho_p (N m) */
    gmi_varying contact;    /* touching part (1) */
    gmi_varying force_t1;   /* times mean t1 (N) */
    gmi_varying contact_t1; /* touching part times its mean t1 (1) */
} gmi_part_force;

/* Friction on the wheel, in the sense in which the pinion's flank moves; on the pinion the other way. And how it moves. */
typedef struct gmi_rubbing {
    double force[GMI_WEIGHTS]; /* times 1, t1, rho_p (N, N, N m) */
    double loss;               /* (W) */
} gmi_rubbing;

typedef struct gmi_rubbing_by {
    double force[GMI_VARIABLES][GMI_WEIGHTS];
} gmi_rubbing_by;

/* The same with the derivatives by what a solver knows. */
typedef struct gmi_friction_sum {
    gmi_varying force;  /* (N) */
    gmi_varying moment; /* times rho_p (N m) */
    double force_t1;    /* times t1 (N) */
    double loss;        /* (W) */
} gmi_friction_sum;

/* Where a part is that a tip corner bears: off the line of action, whose place has the roll lengths rho_p and T - rho_p. */
typedef struct gmi_tip_place {
    gmi_varying
        lead; /* what the arm of friction about the pinion's axis is longer by, on average of the load (m) */
    gmi_varying longer;        /* and that of both together (m) */
    gmi_varying versine, sine; /* 1 - cos and sin of the turn of the normal */
    gmi_varying lead_t1, longer_t1, versine_t1, sine_t1; /* in the middle of the load by t1 */
} gmi_tip_place;

/* What friction at tips adds to gmi_friction_sum. */
typedef struct gmi_tip_friction {
    gmi_varying longer;         /* times what both arms together are longer by (N m) */
    double versine, versine_t1; /* times that of the turn; and times t1 (N) */
    double sine, sine_t1;       /* likewise */
} gmi_tip_friction;

/* Friction at one point: over the transverse force there, less what is the same all over a side. */
typedef struct gmi_point_friction {
    double share; /* mu_r / cos(beta_b) */
    double speed; /* of sliding (m/s) */

    /* Derivatives of the share: by that speed, and by the logarithms of the load and of the rolling speed. */
    double by_speed, by_load, by_rolling;
} gmi_point_friction;

/* load: transverse, over the common face width (N). */
gmi_point_friction gmi_friction_at(const gmi_sliding *sliding, double rho_p, double t1,
                                   double load);

/* A part of a line on which the sliding speed is straight: speeds in the middle of its load and of its touching length. */
typedef struct gmi_sliding_part {
    double load;    /* over the touching length (N) */
    double contact; /* that length, C (1) */
    double speed;   /* v, at the middle of the load (m/s) */
    double slope;   /* w = dv / dt1 (m/s) */
    double apart;   /* t1 of the middle of the touching length less that of the load (1) */
} gmi_sliding_part;

/*
 * Friction of a part over its transverse force, less what is the same all over a side, with derivatives: by the speed, by
 * the logarithms of load, rolling speed and touching length, by the slope, and by how far the two middles are apart.
 */
typedef struct gmi_part_share {
    double value, by_speed, by_load, by_rolling, by_contact, by_slope, by_apart;
} gmi_part_share;

/* The whole; and its moment over t1 about the middle of the load. */
typedef struct gmi_part_friction {
    gmi_part_share share, lean;
} gmi_part_friction;

void gmi_friction_of_part(const gmi_sliding *sliding, const gmi_sliding_part *part,
                          gmi_part_friction *found);

/* What of the coefficient is the same all over a side, and of it the power of the side's force over the rolling speed. */
typedef struct gmi_common_friction {
    double value, power;
} gmi_common_friction;

gmi_common_friction gmi_friction_common(const gmi_sliding *sliding, double force);

/* The logarithm of the rolling speed by both speeds, and by T. */
typedef struct gmi_rolling_by {
    double pinion_speed, wheel_speed, length;
} gmi_rolling_by;

gmi_rolling_by gmi_rolling_differentiate(const gmi_sliding *sliding);

/* Adds the friction of one part, with derivatives where load_by and by are not NULL. advance: of rho_p over t1 (m). */
void gmi_rubbing_add(const gmi_sliding *sliding, double advance, const gmi_load *load,
                     const gmi_load_by *load_by, gmi_rubbing *total, gmi_rubbing_by *by);

/* What of the law is the same all over a side, by all of its load. */
void gmi_rubbing_finish(const gmi_sliding *sliding, const gmi_load *load,
                        const gmi_load_by *load_by, gmi_rubbing *total, gmi_rubbing_by *by);

/* by: NULL = without derivatives, which are 0 then. */
void gmi_friction_sum_of(const gm_pair *pair, int side, const gmi_rubbing *rubbing,
                         const gmi_rubbing_by *by, gmi_friction_sum *sum);

/* Adds that of one part; advance: of rho_p over t1 (m). */
void gmi_friction_add(const gmi_sliding *sliding, double advance, const gmi_part_force *part,
                      gmi_friction_sum *total);

/* Adds that of one part at a tip, whose force is above 0. */
void gmi_friction_add_tip(const gmi_sliding *sliding, double advance, const gmi_part_force *part,
                          const gmi_tip_place *place, gmi_friction_sum *total,
                          gmi_tip_friction *tip);

/* What of the law is the same all over a side, by the side's force; tip: NULL = without. */
void gmi_friction_finish(const gmi_sliding *sliding, const gmi_varying *force,
                         gmi_friction_sum *total, gmi_tip_friction *tip);

/* penetration.c: the sum of a side with its friction, at a speed of approach that is the same all over it. */
void gmi_side_sum_sliding(const gm_mesh *mesh, int side, const gm_position *position,
                          double approach_speed, const gmi_sliding *sliding, gmi_side_sum *total,
                          gmi_rubbing *rubbing);

/* wrench.c: adds the forces of one side. */
void gmi_wrench_add_side(const gm_pair *pair, const gmi_engagement *at, const gmi_side_force *force,
                         int side, gm_wrench *wrench);

/* Adds the friction of one side. */
void gmi_wrench_add_friction(const gm_pair *pair, const gmi_engagement *at,
                             const gmi_friction_sum *friction, int side_of_teeth,
                             gm_wrench *wrench);

/* The wrench of a force of one side in the frame of the drawing, by its weights. */
typedef struct gmi_wrench_map {
    double force[3];            /* on the wheel by the force (1) */
    double by_t1[2], by_rho[3]; /* moments by the two others, about both axes (m, 1) */
    double pinion[3], wheel[3]; /* moments by the force, about either axis (m) */
} gmi_wrench_map;

/* Of the normal force, and of friction; by: how it changes as the wheel's axis moves along x and y. */
void gmi_wrench_map_force(const gm_pair *pair, const gmi_engagement *at, int side,
                          gmi_wrench_map *map, gmi_wrench_map by[2]);
void gmi_wrench_map_friction(const gm_pair *pair, const gmi_engagement *at, int side,
                             gmi_wrench_map *map, gmi_wrench_map by[2]);
static inline void gmi_wrench_map_add(const gmi_wrench_map *map, const double force[GMI_WEIGHTS],
                                      gm_wrench *wrench) {
    const double whole = force[GMI_WHOLE], by_t1 = force[GMI_BY_T1], by_rho = force[GMI_BY_RHO];
    const double moved[3] = {map->by_t1[0] * by_t1 + map->by_rho[0] * by_rho,
                             map->by_t1[1] * by_t1 + map->by_rho[1] * by_rho,
                             map->by_rho[2] * by_rho};
    for (int k = 0; k < 3; ++k) {
        const double on_wheel = map->force[k] * whole;
        wrench->wheel_force[k] += on_wheel;
        wrench->wheel_moment[k] += map->wheel[k] * whole + moved[k];
        wrench->pinion_force[k] -= on_wheel;
        wrench->pinion_moment[k] -= map->pinion[k] * whole + moved[k];
    }
}

/* From the frame in which the posed wheel's axis is on +x to that of the drawing: where that axis is there. */
void gmi_wrench_turn(gm_wrench *wrench, const double axis[2]);

static inline void gmi_wrench_set(gm_wrench *wrench, double value) {
    for (int k = 0; k < 3; ++k) {
        wrench->pinion_force[k] = wrench->pinion_moment[k] = value;
        wrench->wheel_force[k] = wrench->wheel_moment[k] = value;
    }
}

/* corner.c, corner.h: corner contact. */

/* The tip corner of one gear, as it comes to the mate's flank or goes off it. */
typedef struct gmi_corner {
    double tip_base;       /* r_b of the gear whose tip it is (m) */
    double mate_base;      /* of the gear whose flank it touches (m) */
    double line_of_action; /* T (m) */
    double tip_roll;       /* rho_a (m) */
    double mate_roll;      /* of the flank touched, at the end of the path: T - rho_a (m) */
    double along, across;  /* of the centre distance times r_a: the parts of its way (m2) */
    double reach;          /* roll beyond the path after which it is off the mate's flank (m) */
    double coarse, fine; /* width of a parabola of the gap far from the path, and at its end (m) */
} gmi_corner;

/* mesh.c: the prepared mesh. */
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

/*
 * Sum of a side with first moments, derivatives of the sum by origin and delta, and the tangent of its force, of rates that
 * are set in it; sliding: NULL = without friction, and rubbing and rubbing_by too.
 */
void gmi_side_sum_tangent(const gm_mesh *mesh, int side, const gm_position *position,
                          const gmi_sliding *sliding, gmi_side_sum *total,
                          gmi_side_tangent *tangent, gmi_rubbing *rubbing,
                          gmi_rubbing_by *rubbing_by);

/* equilibrium_guess.c: x of equilibria under several loads at a posed position without friction (m), next to exact, and the
 * slope of the sum there; NaN = none. */
enum { GMI_LOADS_MAX = 32 };
void gmi_equilibrium_guesses(const gm_mesh *mesh, const gm_position *position,
                             const double *wheel_torque, int count, double *offset, double *slope);

/* All of enum gm_wanted. */
enum { GMI_WANT_ALL = GM_WANT_DERIVATIVES | GM_WANT_WRENCH | GM_WANT_PAIRS | GM_WANT_ENERGY };

/* As gm_mesh_evaluate_at() without the cache, of a position that has been checked and posed. GM_OK or GM_NO_CONVERGENCE. */
int gmi_mesh_evaluate_exact(const gm_mesh *mesh, const gm_position *position, int wanted,
                            gm_workspace *workspace, gm_mesh_result *result);
void gmi_mesh_result_set_nan(gm_mesh_result *result);

/* The same mesh with its wheel in the pose of a motion too and without a cache, where it is then, and how fast the flanks
 * approach each other. Returns GM_OK, or a status of what is wrong with the motion. */
int gmi_mesh_follow(const gm_mesh *mesh, const gm_motion *motion, gm_mesh *moved,
                    gm_position *position, gmi_rates rates[2]);

/* The position in the coordinates of the posed pair. */
static inline gm_position gmi_mesh_posed(const gm_mesh *mesh, const gm_position *position) {
    gm_position posed = *position;
    posed.offset += mesh->engagement.offset_shift;
    posed.phase += mesh->engagement.phase_shift;
    return posed;
}

#endif
