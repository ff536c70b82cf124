/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Elastic teeth: force, stiffness, energy and load distribution of one flank side. The model, its sources and its
 * validation: libgearmesh/docs/elastic.md. A wheel that is a ring has teeth, roll lengths and line of action below 0.
 *
 * One evaluation has three steps, all in the workspace of the caller:
 *
 *     gmi_elastic_place(&law, &lines, work)    where the lines of contact are, and the points at which they are evaluated
 *     work->deviation[p] = ...                 the caller says how much material both flanks have there
 *     gmi_elastic_solve(&law, work, x, &result)
 *
 * and then, if wanted, gmi_elastic_adjoint() for derivatives by anything that moves or changes the flanks.
 *
 * Points: a line of contact is cut at the stations, at the ends of the path, and where reliefs begin; each part is a slot with two
 * points. Point 0 of slot s has the number s, point 1 the number s + work->slots. All arrays over points have both halves one after the other:
 *
 *     for (int k = 0; k < work->count; ++k) {          // lines
 *         const gmi_elastic_line *line = &work->line[k];
 *         for (int half = 0; half < 2; ++half) {
 *             for (int s = line->slot; s < line->slot + line->slots; ++s) {
 *                 const int p = s + half * work->slots;
 *                 work->deviation[p] = f(line->index, work->z[p], work->roll[p]);
 *             }
 *         }
 *     }
 *
 * Signs: x > 0 presses the flanks together, deviations > 0 are material added, both along the transverse line of action.
 * Line loads are normal force per length of the contact line; their integral over z is the transverse force.
 * Nothing here calls libm beyond sqrt after gmi_elastic_init(): the same inputs give the same bits everywhere.
 */
#ifndef GEARMESH_ELASTIC_H
#define GEARMESH_ELASTIC_H

#include "internal.h"
#include "wide.h"

#include <stddef.h>

enum {
    GMI_ELASTIC_STATIONS_MAX = 97,
    GMI_ELASTIC_LINES_MAX = 12, /* on one flank side at once */
    GMI_ELASTIC_CREASES_MAX = 2 * GM_FLANK_RAMPS_MAX,
    GMI_ELASTIC_CELLS = 64, /* of the tables of a tooth */
    GMI_ELASTIC_ITERATIONS = 20
};

/* Materials beyond these are refused. */
#define GMI_ELASTIC_LEAST_MODULUS   1e6  /* (N/m2) */
#define GMI_ELASTIC_LARGEST_MODULUS 1e15 /* (N/m2) */
#define GMI_ELASTIC_LARGEST_RATIO   0.499

/* Constants of the model, fitted to finite elements; elastic.md says how. */
#define GMI_ELASTIC_HERTZ_OFFSET 0.06 /* kappa_H */
#define GMI_ELASTIC_TOOTH_LENGTH                                                                   \
    1.45 /* l, decay of a tooth's deflection along the face, in modules */
#define GMI_ELASTIC_RIM_LENGTH    2.9  /* l_rim, of the rim's, in modules */
#define GMI_ELASTIC_RIM_SHARE     0.37 /* chi, compliance that neighbouring teeth share, in 1/E */
#define GMI_ELASTIC_END_SOFTENING 0.7  /* of l^2 at the ends of the face ... */
#define GMI_ELASTIC_END_LENGTH    0.8  /* ... decaying over this length, in modules */

/* ---------------------------------------------------------------------------------------------
 * The law of a pair
 * ------------------------------------------------------------------------------------------- */

typedef struct gmi_elastic_gear_params {
    double
        teeth; /* z, a real number: virtual gears of a normal section have fractions; < 0: a ring */
    double profile_shift;      /* x (1) */
    double normal_thickness;   /* s_n at the reference circle (m) */
    double rack_dedendum;      /* h_fP in modules */
    double rack_fillet_radius; /* rho_fP in modules */
    double youngs_modulus;     /* E (N/m2) */
    double poisson_ratio;      /* nu */
    double start_roll_length;  /* active profile, on which the tables are made (m); */
    double tip_roll_length;    /* beyond it the compliance is that at its end */
} gmi_elastic_gear_params;

typedef struct gmi_elastic_params {
    double normal_module;         /* (m) */
    double normal_pressure_angle; /* (rad) */
    double helix_angle;           /* (rad), either sign */
    double base_helix_angle;      /* (rad) */
    double face_width;            /* on which the teeth stand together (m) */
    double line_of_action;        /* T; < 0 in a ring (m) */
    int stations;                 /* 2 .. GMI_ELASTIC_STATIONS_MAX */
    int lines; /* lines at once, 1 .. GMI_ELASTIC_LINES_MAX, see gmi_elastic_lines() */
    gmi_elastic_gear_params gear[2]; /* pinion, wheel */
} gmi_elastic_params;

/*
 * A cell of a table: cubics in the place 0 .. 1 within it, lowest power first. Columns: compliance c_n / cos(beta_b), and
 * curvature factor.
 */
typedef struct gmi_elastic_cell {
    double value[4][2];
} gmi_elastic_cell;

/*
 * What a tooth contributes at the roll length rho: its compliance in the transverse measure (m per N/m), and the
 * curvature factor h = rho / (2 t e^kappa_H)^(B_i / B_m). Those of both gears give the rate of the contact law:
 * 1 / (B e^L) = 4 h_p h_w / T, which needs no logarithm.
 */
typedef struct gmi_elastic_gear {
    double start, per_cell; /* (m, 1/m) */
    double last;            /* number of the last cell */

    /* the first and the last hold the values beyond the ends */
    gmi_elastic_cell cell[GMI_ELASTIC_CELLS + 2];
} gmi_elastic_gear;

/*
 * A layer along the face: a tridiagonal matrix of mass and coupling. left[k] and right[k] are the diagonals after all
 * nodes before k, or behind k, are eliminated: a layer that is loaded from node a to node b alone needs no others.
 */
typedef struct gmi_elastic_layer {
    double diagonal[GMI_ELASTIC_STATIONS_MAX];
    double beside[GMI_ELASTIC_STATIONS_MAX]; /* between k and k + 1 */
    double left[GMI_ELASTIC_STATIONS_MAX];
    double right[GMI_ELASTIC_STATIONS_MAX];
} gmi_elastic_layer;

/* Plain data, 19 kB; read-only after gmi_elastic_init(). */
typedef struct gmi_elastic {
    int stations;
    int lines_max;
    int creases_max; /* of the flanks of one side; 0 until a mesh says how many */
    int is_wide;     /* whether the processor has vectors of four doubles, see wide.h */
    double face_width;
    double spacing, per_spacing; /* of the stations (m, 1/m) */
    double hertz_compliance;     /* B (m per N/m) */
    double rim_compliance;       /* r^2 (m per N/m) */
    double line_of_action;       /* T of the drawing (m) */
    double least_compliance[2];  /* of the teeth on their profiles, pinion, wheel (m per N/m) */
    gmi_elastic_gear gear[2];

    /* both whole teeth on the line of action of the drawing: s and 1 / (B e^L) by rho_p */
    gmi_elastic_gear pair;

    gmi_elastic_layer tooth;
    gmi_elastic_layer rim; /* divided by r^2: the rim's unknown is its own deflection */
} gmi_elastic;

/* How many lines can touch at once with this total contact ratio; may exceed GMI_ELASTIC_LINES_MAX. */
int gmi_elastic_lines(double total_contact_ratio);

/*
 * Prepares the law. GM_OK; GM_ERR_PARAMETER for sizes or materials out of range; GM_ERR_GEOMETRY with
 * *fault (enum gmi_tooth_fault) and *wheel (0, 1) telling what is wrong with which tooth. contact_start: least roll length
 * of each gear at which the mate touches (m), to find out contact below the end of the fillet.
 */
int gmi_elastic_init(gmi_elastic *law, const gmi_elastic_params *params,
                     const double contact_start[2], int *fault, int *wheel);

/* Divides the face anew, by 2 .. GMI_ELASTIC_STATIONS_MAX stations: the layers follow, all else stays. */
void gmi_elastic_divide(gmi_elastic *law, double normal_module, double helix_angle, int stations);

/* ---------------------------------------------------------------------------------------------
 * One evaluation
 * ------------------------------------------------------------------------------------------- */

/* Where a linear relief of a flank begins: offset + per_z z + per_roll rho_p = 0, straight on the face and the path. */
typedef struct gmi_elastic_crease {
    double offset;   /* (m) */
    double per_z;    /* (1) */
    double per_roll; /* (1) */
} gmi_elastic_crease;

/*
 * Where the lines of contact are. Line k has rho_p = origin + k pitch + climb z on the pinion and rho_w = line_of_action -
 * rho_p on the wheel, and touches where lower <= rho_p <= upper.
 */
typedef struct gmi_elastic_lines_at {
    double origin, pitch, climb;
    double lower, upper;
    double line_of_action;

    /*
     * Lines that go on beyond the path, over whole elements of the face, until they are so far below `lower` or above `upper`.
     * Teeth change on from its end for half the lengths `fading` (below, above), ever less, and stay what they are then. What
     * the corners do is the caller's, see gmi_elastic_work.beyond.
     */
    int goes_on;
    double below, above;
    double fading[2];

    /* Such lines are cut where the path ends, and once more so far below and above it, where edges leave the flank. */
    double cut[2];

    /* Lines are cut at these too, [creases]; up to gmi_elastic.creases_max of them. */
    const gmi_elastic_crease *crease;
    int creases;

    int first, last; /* lines that can touch; others in between are left out by themselves */
    int slopes;      /* derivatives wanted: 0 none, 1 all but by the line of action, 2 all */

    /*
     * Which pair is which, so that the workspace follows its teeth: line `first` belongs to tooth `tooth` and line k + 1 to the
     * next tooth in direction `step` (+1, -1) of `teeth`.
     */
    int tooth, step, teeth;

    /* Softness of each line's teeth, [last - first + 1], 1 = whole, 2 = twice the compliance; NULL = all whole. */
    const double *pinion_softness, *wheel_softness;
} gmi_elastic_lines_at;

/* How far beyond the end of the path teeth and flanks are read, and by how much that grows with rho_p. */
typedef struct gmi_elastic_hold {
    double moved; /* from the end (m) */
    double by_roll;
} gmi_elastic_hold;

static inline gmi_elastic_hold gmi_elastic_hold_at(const gmi_elastic_lines_at *at, double beyond) {
    const double length = at->fading[beyond > 0.0];
    const double part = (beyond < 0.0 ? -beyond : beyond) / length;
    const double t = part < 1.0 ? part : 1.0;
    const double moved = length * t * (1.0 - 0.5 * t);
    const gmi_elastic_hold hold = {beyond < 0.0 ? -moved : moved, 1.0 - t};
    return hold;
}

/* Parts of the matrix of an element: tooth with tooth, tooth with rim, rim with rim; station left with left, ... */
enum {
    GMI_TOOTH_LEFT,
    GMI_TOOTH_CROSS,
    GMI_TOOTH_RIGHT,
    GMI_MIXED_LEFT,
    GMI_MIXED_CROSS,
    GMI_MIXED_RIGHT,
    GMI_RIM_LEFT,
    GMI_RIM_CROSS,
    GMI_RIM_RIGHT,
    GMI_ELASTIC_MATRICES
};

/* A cut within an element, between two slots that share its stations. */
typedef struct gmi_elastic_cut {
    double z; /* moves with the line (m), ... */
    double
        by_roll; /* ... by this along its roll: of a crease; of an end of the path it is -1 / climb */
    int row;     /* of the line */
    int element; /* that is cut */
    int whole;   /* slot of that element */
    int before;  /* slot up to the cut ... */
    int after;   /* ... and from there on */
    int is_last; /* of its element: none follows in it */
    int limit;   /* end of the path it belongs to: -1 lower, +1 upper; 0: a crease */
} gmi_elastic_cut;

/*
 * Cuts of all lines at ends of the path: each end of the path, and each place beyond, is passed on the face by no more lines than the face is
 * pitches long, and one. Lines at once are more by the path, which is longer than a pitch; where not, some cuts are left out.
 */
static inline int gmi_elastic_cuts_of(int lines, int creases) {
    return (lines > 3 ? 4 * (lines - 2) : 4) + creases * lines; /* a line passes a crease once */
}

/* One line of contact as placed. */
typedef struct gmi_elastic_line {
    int index;    /* k of gmi_elastic_lines_at */
    int slot;     /* its first slot */
    int element;  /* element of the face that slot lies in: from station `element` on */
    int elements; /* how many, each with a slot */
    int slots;    /* those, and behind them one for each cut: what follows it */
    int end;      /* slot of the part at its end */

    /* whether its begin and end along z are those of the path: -1 lower, +1 upper, 0: of the face */
    int limited[2];
} gmi_elastic_line;

/* Elements first .. last have the same lines, all of which go through them; or one element. */
typedef struct gmi_elastic_run {
    int first, last;
    int kind; /* what the lines do there, see elastic_front.c */
    int low;  /* first row: those of an element follow one another */
    int ending, through, beginning,
        alone;  /* how many lines do what there, in this order but for `alone` */
    int record; /* where the records of the elimination begin */
} gmi_elastic_run;

/* Memory of the solver. Points into the memory of the caller; one for each flank side and thread. */
typedef struct gmi_elastic_work {
    int stations, lines_max, creases_max;
    gmi_elastic_crease *crease; /* the caller's, for gmi_elastic_lines_at: [creases_max] */

    /* Of the last gmi_elastic_place(). */
    int count; /* lines */
    int slots;
    gmi_elastic_lines_at at;
    gmi_elastic_line line[GMI_ELASTIC_LINES_MAX];
    int cuts; /* line by line, in the order of z */
    gmi_elastic_cut *cut;

    /* Points beyond the path, where lines go on: below and above it. The first list has room for all points. */
    int *outer[2];
    int outer_count[2];
    int *chosen; /* the caller's, [2 slots] */

    /*
     * The caller's: whether only the sums are wanted, of force and energy, by the approach and by the roll. Points and other
     * functionals are then known to 1e-5.
     */
    int sums_alone;

    /* Of the last gmi_elastic_solve(). */
    int touching;   /* whether anything does: else loads and derivatives are 0 */
    int warm;       /* solutions to begin from: 0, 1, 2 with a rate by the roll, 3 with its bend */
    int warm_tooth; /* tooth of row 0 */
    double warm_place; /* roll of that tooth at z = 0 (m) */
    double approach;   /* x (m) */
    double rolled;     /* since the solution before (m) */
    double energy;     /* U (J) */
    int is_foretold;   /* whether its state was near the one expected, when the lines rolled last */
    int is_rolling;    /* whether held_by_roll is set, where the last step was not small */
    int straight;      /* whether a point is on the straight part of the contact law */

    /* Over points, [2][slots]. What the caller reads and writes: */
    double *z;         /* (m) */
    double *roll;      /* rho_p, kept within the path (m) */
    double *beyond;    /* where lines go on: by how much it is below (< 0) or above the path (m) */
    double *weight;    /* W, integral over z (m) */
    double *deviation; /* w, of both flanks: the caller's (m) */

    /* its slope along rho_p at fixed z, the caller's for derivatives (1) */
    double *deviation_by_roll;

    double *deviation_by_z; /* its slope along z at fixed rho_p, likewise (1) */
    double *load;           /* q (N/m) */
    double *approach_at;    /* gamma, local approach of the surfaces (m) */
    double *force;          /* W q (N) */
    double *stiffness;      /* W dq/d gamma (N/m) */
    double *by_deviation;   /* derivative of the force by the deviation of each point (N/m) */

    /* Of a gap that the wheel's tip edge leaves, by its roll: 1 - entry_slope is what the approach grows with x. */
    int is_entering;         /* whether such an edge bears load; the arrays are not set if not */
    double *entry_slope;     /* (1) */
    double *entry_curvature; /* (1/m) */

    /* Own: */
    double *place;           /* t, between the two stations of the element, 0 .. 1 */
    double *tooth;           /* s */
    double *tooth_by_roll;   /* its slope along rho_p (1/m), */
    double *tooth_by_action; /* and by the line of action at fixed rho_p */
    double *rate;            /* 1 / (B e^L), the caller's to change beyond the path (1/m) */
    double *rate_by_roll;    /* d ln(rate) likewise (1/m) */
    double *rate_by_action;
    double *deflection;   /* of the tooth layer, before s */
    double *slope;        /* B dq/d gamma */
    double *change_at;    /* of gamma in the last step (m) */
    double *expected;     /* W q after the step, in first order (N) */
    double *excess;       /* what the force exceeds that by, with the approach of that order (N) */
    double *stiffer;      /* what the series of the contact law adds to the stiffness (N/m) */
    double *held_by_roll; /* 1 less what the layers give way by as the lines roll (1) */
    double *scratch;      /* forces, ... */

    /* [2 slots][2]: values and slopes of pinion and wheel, while they are placed; then free for the
       caller */
    double *table[4];

    double *pull;          /* m - J lambda */
    double *tooth_adjoint; /* lambda of the tooth layer */

    /* Over slots: the element's part of the Newton matrix, and forces of its two stations. */
    double *matrix;   /* [GMI_ELASTIC_MATRICES][slots] */
    double *parts[4]; /* tooth left, tooth right, rim left, rim right */

    /* Over stations: [lines_max + 1][stations], the last row is the rim's. */
    double *state;       /* deflections of the layers */
    double *change;      /* of a step: residual, then change */
    double *adjoint;     /* of the force; also the derivative of the state by x */
    double *last;        /* state of the solution before */
    double *by_place;    /* derivative of the state by the roll, from both, ... */
    double *place_curve; /* ... and half its second one, with the solution before those */
    double *last_step;
    double *other; /* adjoint of another functional */

    /* 0, which compilers must not know: gcc clears half a vector by an instruction that valgrind does not know. */
    double none;

    double *carry;        /* scratch of the elimination, ... */
    double *front;        /* ... and for unusual numbers of lines */
    double *factor;       /* its records */
    double *end_record;   /* those of the ends of each line, [lines_max][2][4] */
    int begin, end;       /* elements in which any line touches: begin .. end - 1 */
    gmi_elastic_run *run; /* [stations] elements that are alike, of begin .. end - 1 ... */
    int runs;             /* ... how many */
    int last_record;      /* that of the last station */
} gmi_elastic_work;

/* Bytes of memory for one flank side with so many creases; 0 if the sizes are out of range. */
size_t gmi_elastic_work_size(int stations, int lines, int creases);

/* Lays the arrays into memory of gmi_elastic_work_size() bytes, aligned for double. */
void gmi_elastic_work_init(gmi_elastic_work *work, int stations, int lines, int creases,
                           void *memory);

/* Forgets the last solution: the next one begins from undeformed teeth. */
void gmi_elastic_work_reset(gmi_elastic_work *work);

/*
 * Finds the lines and their points: line, z, roll, weight. GM_OK; GM_STATE_OUT_OF_RANGE for more lines than the
 * workspace holds; GM_ERR_PARAMETER where a softness leaves no compliance.
 */
int gmi_elastic_place(const gmi_elastic *law, const gmi_elastic_lines_at *at,
                      gmi_elastic_work *work);

typedef struct gmi_elastic_result {
    double force;       /* F, transverse (N) */
    double energy;      /* U, of teeth and contacts (J) */
    double by_approach; /* dF/dx (N/m); by the deviation of each point: work->by_deviation */
    int iterations;
    double line_force[GMI_ELASTIC_LINES_MAX]; /* [work->count] */
} gmi_elastic_result;

/*
 * Deflections of all teeth at the approach x, all lines together. GM_OK or GM_NO_CONVERGENCE (results NaN).
 * Fills load, approach_at and stiffness over the points.
 */
int gmi_elastic_solve(const gmi_elastic *law, gmi_elastic_work *work, double approach,
                      gmi_elastic_result *result);

/*
 * Line load at any z of a placed line, after gmi_elastic_solve(): from the deflections of the stations beside it.
 * deviation: of both flanks there (m); rate_factor: of the contact law's rate, 1 within the path. *gamma: approach of the
 * surfaces, <= 0 where they do not touch (m).
 */
double gmi_elastic_load_at(const gmi_elastic *law, const gmi_elastic_work *work, int row, double z,
                           double deviation, double rate_factor, double *gamma);

/* ---------------------------------------------------------------------------------------------
 * Derivatives
 * ------------------------------------------------------------------------------------------- */

/*
 * What is to be differentiated: G = sum of factor W q over the points. NULL = 1, the force itself, and slopes 0. With
 * factor = z it is the tilting moment, with the friction of each point over its line load the friction force, ...
 */
typedef struct gmi_elastic_functional {
    const double *factor;         /* over the points */
    const double *factor_by_roll; /* its slope along rho_p at fixed z */
    const double *factor_by_z;    /* its slope along z at fixed rho_p */
    const double *
        by_load; /* of a factor m that follows the load, dm / d ln q: factor is then m + dm / d ln q */
} gmi_elastic_functional;

/* Total derivatives: teeth and contacts stay in balance. */
typedef struct gmi_elastic_gradient {
    double value;       /* G */
    double by_approach; /* by x, and by a common deviation of all points */

    /* by the origin of the lines, which move through the path and past the stations */
    double by_roll;

    double by_lower; /* by the ends of the path ... */
    double by_upper;
    double by_action; /* ... and by the line of action, at fixed rho_p; 0 unless slopes were 2 */
} gmi_elastic_gradient;

/*
 * Derivatives of the force (NULL: not wanted) and of the energy at the last solution. Needs slopes of gmi_elastic_lines_at, deviation_by_roll,
 * and deviation_by_z where lines are cut. Those of the energy leave the balance out, which is its minimum. The torques that
 * keep the energy balance exactly are r_bp (F + energy.by_roll) on the pinion and r_bw F on the wheel.
 */
void gmi_elastic_differentiate(const gmi_elastic *law, gmi_elastic_work *work,
                               gmi_elastic_gradient *force, gmi_elastic_gradient *energy);

/*
 * Derivatives of another functional, by one adjoint solution more. by_deviation: over the points, by the deviation of each;
 * anything that acts through deviations follows from it by the chain rule.
 */
void gmi_elastic_differentiate_functional(const gmi_elastic *law, gmi_elastic_work *work,
                                          const gmi_elastic_functional *functional,
                                          double *by_deviation, gmi_elastic_gradient *gradient);

/* The same on processors with vectors of four doubles: elastic_wide.c, not to be called but from the functions above. */
#if GMI_HAS_WIDE
int gmi_wide_place(const gmi_elastic *law, const gmi_elastic_lines_at *at, gmi_elastic_work *work);
int gmi_wide_solve(const gmi_elastic *law, gmi_elastic_work *work, double approach,
                   gmi_elastic_result *result);
void gmi_wide_differentiate(const gmi_elastic *law, gmi_elastic_work *work,
                            gmi_elastic_gradient *force, gmi_elastic_gradient *energy);
void gmi_wide_differentiate_functional(const gmi_elastic *law, gmi_elastic_work *work,
                                       const gmi_elastic_functional *functional,
                                       double *by_deviation, gmi_elastic_gradient *gradient);
#endif

/* ---------------------------------------------------------------------------------------------
 * Shared between the sources
 * ------------------------------------------------------------------------------------------- */

/* The rim's row of an array over stations. */
static inline double *gmi_elastic_rim(const gmi_elastic_work *work, double *rows) {
    return rows + work->lines_max * work->stations;
}

/* First and one behind the last station of a row; row = work->count: the rim, whose row in arrays is lines_max. */
typedef struct gmi_elastic_span {
    int begin, end;
    int at; /* of the row in an array over stations */
} gmi_elastic_span;

static inline gmi_elastic_span gmi_elastic_span_of(const gmi_elastic_work *work, int row) {
    const gmi_elastic_span rim = {work->begin, work->end + 1, work->lines_max * work->stations};
    if (row == work->count) {
        return rim;
    }
    const gmi_elastic_line *line = &work->line[row];
    const gmi_elastic_span span = {line->element, line->element + line->elements + 1,
                                   row * work->stations};
    return span;
}

/* Sum over the points, in four parts that a processor adds side by side. */
static inline double gmi_elastic_sum(int count, const double *values) {
    double sums[4] = {0.0, 0.0, 0.0, 0.0};
    int k = 0;
    for (; k + 4 <= count; k += 4) {
        sums[0] += values[k];
        sums[1] += values[k + 1];
        sums[2] += values[k + 2];
        sums[3] += values[k + 3];
    }
    for (; k < count; ++k) {
        sums[0] += values[k];
    }
    return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

/* elastic_points.c: approach of all points, from the deflections of work->state. */
void gmi_elastic_approach(gmi_elastic_work *work, double x);

/* Loads, forces, stiffness from the approach; work->scratch: how much the forces exceed work->expected. */
void gmi_elastic_load(const gmi_elastic *law, gmi_elastic_work *work);

/* Approach and expected forces after the step work->change. */
void gmi_elastic_follow(gmi_elastic_work *work);

/* Adds forces at the points to those of the stations, as the deflections there see them. */
void gmi_elastic_gather(gmi_elastic_work *work, const double *force, double *rows);

/* work->matrix from the stiffness at the points. */
void gmi_elastic_stiffen(gmi_elastic_work *work);

/* What is left of a functional's factor after the adjoint: work->pull, work->tooth_adjoint. factor NULL: 1. */
void gmi_elastic_pull(gmi_elastic_work *work, const double *factor, const double *rows);

/*
 * elastic_front.c: eliminates the Newton matrix of work->matrix and the layers, and solves for a right-hand side, in place,
 * within the nodes that lines touch. Returns the product of it with its solution.
 */
double gmi_elastic_factor(const gmi_elastic *law, gmi_elastic_work *work, double *rows);

/* Finds begin, end and the runs of elements that are alike, which all of that go through. */
void gmi_elastic_find_runs(gmi_elastic_work *work);

/* Solves for another one. */
void gmi_elastic_substitute(const gmi_elastic_work *work, double *rows);

#endif
