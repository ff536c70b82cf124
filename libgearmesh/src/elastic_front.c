/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The linear equations of elastic teeth: symmetric, positive definite, and coupled from one station to the next alone. They
 * are eliminated station by station along the face, each with the lines that touch on both sides of it, one unknown each, and
 * the rim: one to four unknowns with usual gears, whatever the total contact ratio. The first and the last station of a
 * line belong to one element alone and are eliminated with it, before its stations. What a line leaves unloaded of its
 * tooth is eliminated beforehand (gmi_elastic_layer). So the result is that of the whole face.
 *
 * Eliminating an unknown leaves the inverse of its pivot, and its row of the upper factor (with ones on the diagonal) over
 * the unknowns that are still there and that it meets.
 */
#include "elastic.h"
#include "internal.h"
#include "wide.h"

/* The elimination is compiled once for each usual number of lines. */
#if defined(__GNUC__)
#define SPECIALIZED static inline __attribute__((always_inline))
#define SPECIAL     static __attribute__((noinline)) /* unrolled completely, each by itself */
#else
#define SPECIALIZED static inline
#define SPECIAL     static
#endif

enum { UNKNOWNS_MAX = GMI_ELASTIC_LINES_MAX + 1 };

/* ---------------------------------------------------------------------------------------------
 * Lines within one element
 * ------------------------------------------------------------------------------------------- */

/*
 * The lines of an element. Rows are sorted along the face: the first ones end in it, the next ones go through it, the last
 * ones begin in it. One that both begins and ends in it has no station of its own and stands before those that begin.
 */
typedef struct traffic {
    int ending, through, beginning;
    int alone; /* that both begin and end in it */
} traffic;

/* The equations of one line in one element: its left and right station, and what they have with the rim's. */
typedef struct part {
    double left, cross, right; /* tooth with tooth */
    double left_left,
        left_right; /* left station of the tooth with left and right station of the rim */
    double right_left, right_right; /* right station of the tooth likewise */
} part;

/* The rim within one element. */
typedef struct rim_part {
    double left, cross, right;
} rim_part;

/* The stiffness of the slots of a line, by their elements. */
static inline const double *slots_of(const gmi_elastic_work *work, int row) {
    const gmi_elastic_line *line = &work->line[row];
    return work->matrix + line->slot - line->element;
}

/* Takes the stiffness of a slot; the diagonals of the layer are still to be added. size: from matrix to matrix. */
static inline part part_of(const double *matrix, ptrdiff_t size, double beside, rim_part *rim) {
    const double *mixed = matrix + GMI_MIXED_LEFT * size;
    const double *of_rim = matrix + GMI_RIM_LEFT * size;
    rim->left += of_rim[0];
    rim->cross += of_rim[size];
    rim->right += of_rim[2 * size];
    const part p = {matrix[0],   beside + matrix[size], matrix[2 * size], mixed[0],
                    mixed[size], mixed[size],           mixed[2 * size]};
    return p;
}

/* The record of the end of a line: inverse pivot; row over the other end, the left and the right station of the rim. */
typedef struct end_row {
    double inverse, other, left, right;
} end_row;

static inline end_row *begin_row(const gmi_elastic_work *work, int row) {
    return (end_row *)(void *)work->end_record + 2 * row;
}

static inline end_row *end_row_of(const gmi_elastic_work *work, int row) {
    return begin_row(work, row) + 1;
}

/* Eliminates the station at which a line begins. */
static inline void take_begin(part *p, rim_part *rim, end_row *r) {
    r->inverse = 1.0 / p->left;
    r->other = p->cross * r->inverse;
    r->left = p->left_left * r->inverse;
    r->right = p->left_right * r->inverse;
    p->right -= r->other * p->cross;
    p->right_left -= r->other * p->left_left;
    p->right_right -= r->other * p->left_right;
    rim->left -= r->left * p->left_left;
    rim->cross -= r->left * p->left_right;
    rim->right -= r->right * p->left_right;
}

/* The station at which it ends. */
static inline void take_end(part *p, rim_part *rim, end_row *r) {
    r->inverse = 1.0 / p->right;
    r->other = p->cross * r->inverse;
    r->left = p->right_left * r->inverse;
    r->right = p->right_right * r->inverse;
    p->left -= r->other * p->cross;
    p->left_left -= r->other * p->right_left;
    p->left_right -= r->other * p->right_right;
    rim->left -= r->left * p->right_left;
    rim->cross -= r->left * p->right_right;
    rim->right -= r->right * p->right_right;
}

/*
 * A line within one element, which begins and ends there. at: its first right-hand side, of which *fall grows by what
 * comes of it.
 */
static void take_both(const gmi_elastic *law, const gmi_elastic_work *work, int element, int row,
                      rim_part *rim, const double *at, double *fall) {
    part p = part_of(slots_of(work, row) + element, work->slots, law->tooth.beside[element], rim);
    end_row *first = begin_row(work, row), *second = end_row_of(work, row);
    p.left += law->tooth.left[element];
    p.right += law->tooth.right[element + 1];
    take_begin(&p, rim, first);
    p.cross = 0.0;
    take_end(&p, rim, second);
    const double rest = at[1] - first->other * at[0];
    *fall += at[0] * at[0] * first->inverse + rest * rest * second->inverse;
}

/*
 * Right-hand side: what hangs on the end of a line goes over to its other end and to the rim, of which the left station
 * may be elsewhere.
 */
static inline void forward_end(const end_row *r, double *value, double *other, double *rim,
                               double *rim_left) {
    const double taken = *value;
    *value = taken * r->inverse;
    *other -= r->other * taken;
    *rim_left -= r->left * taken;
    rim[1] -= r->right * taken;
}

static inline void back_end(const end_row *r, double *value, double other, const double *rim) {
    *value -= r->other * other + r->left * rim[0] + r->right * rim[1];
}

/* ---------------------------------------------------------------------------------------------
 * One element
 * ------------------------------------------------------------------------------------------- */

/* Unknowns: lines of the left station, its rim, lines of the right station, its rim. */
SPECIALIZED int left_lines(traffic t) {
    return t.ending + t.through;
}

SPECIALIZED int right_lines(traffic t) {
    return t.through + t.beginning;
}

/* Whether the row of an unknown on the left has nothing in a column: a line meets those on the right that go on before it. */
SPECIALIZED int is_empty(traffic t, int row, int column) {
    return row < left_lines(t) && column < right_lines(t) && column > row - t.ending;
}

/*
 * Parts of a row: to = from, to = factor * from, to -= factor * from. With vectors of four they have four numbers: those
 * behind a row's end, below the diagonal and in empty columns are of no use, but vectors have them for nothing.
 */
#if defined(__GNUC__) && (defined(GMI_IN_WIDE) || defined(__AVX__))
enum { LANES = 4 };
typedef double row_part __attribute__((vector_size(32), aligned(8), may_alias));

static inline void pack(double *to, const double *from) {
    const row_part packed = {from[0], from[1], from[2], from[3]};
    *(row_part *)to = packed;
}
#else
enum { LANES = 1 };
typedef double row_part;

static inline void pack(double *to, const double *from) {
    *to = *from;
}
#endif

static inline void copy_part(double *to, const double *from) {
    *(row_part *)to = *(const row_part *)from;
}

static inline void scale_part(double *to, double factor, const double *from) {
    *(row_part *)to = *(const row_part *)from * factor;
}

static inline void take_part(double *to, double factor, const double *from) {
    *(row_part *)to -= *(const row_part *)from * factor;
}

/* Size of a row over the unknowns of a station, with the right-hand side behind. */
SPECIALIZED int row_size(int unknowns) {
    return (unknowns + LANES) & -LANES;
}

enum { ROW_MAX = (UNKNOWNS_MAX + 4) & -4 };

/* What goes from element to element. */
typedef struct front_state {
    const gmi_elastic *law;
    gmi_elastic_work *work;
    double *rows;   /* right-hand side, becomes that of back() */
    double *record; /* behind the records so far */
    double fall;    /* product of the right-hand side with its solution, so far */
} front_state;

#define ELASTIC_NAME(name) any_##name
#define UNROLLED
#include "elastic_step.h"

/* ---------------------------------------------------------------------------------------------
 * The usual elements, and any
 * ------------------------------------------------------------------------------------------- */

/*
 * Ending, through, beginning; lines alone where none goes through. The copies for them are large and take clang, and sanitizers, minutes to compile: those, and
 * builds for size, go without, to the same bits.
 */
#if defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) &&                  \
    !defined(__OPTIMIZE_SIZE__)
#define ELASTIC_NAME(name) usual_##name
#define UNROLLED           _Pragma("GCC unroll 16")
#include "elastic_step.h"
/* clang-format off */
#define USUAL_TRAFFIC(X)                                                                           \
    X(0, 0, 0) X(0, 0, 1) X(0, 0, 2) X(0, 0, 3) X(1, 0, 0) X(2, 0, 0) X(3, 0, 0) X(1, 0, 1)         \
    X(0, 1, 0) X(0, 1, 1) X(1, 1, 0) X(1, 1, 1) X(0, 2, 0) X(0, 2, 1) X(1, 2, 0) X(1, 2, 1)         \
    X(0, 3, 0)
/* clang-format on */
#else
#define USUAL_TRAFFIC(X)
#endif

/* From element to element of a run. Fronts of usual size are on the stack. */
#define ALONE(g) ((g) == 0 ? run->alone : 0)
#define SPECIAL_FUNCTIONS(e, g, b)                                                                 \
    SPECIAL void step_##e##g##b(front_state *f, gmi_elastic_run *run) {                            \
        const traffic t = {e, g, b, ALONE(g)};                                                     \
        double front[((e) + (g) + 1) * ((e) + (g) + 1) +                                           \
                     ((e) + 2 * (g) + (b) + 2) * (((g) + (b) + 1 + LANES) & -LANES)];              \
        usual_step(t, f, run, front);                                                              \
    }                                                                                              \
    SPECIAL void forward_##e##g##b(const gmi_elastic_work *work, const gmi_elastic_run *run,       \
                                   double *rows) {                                                 \
        const traffic t = {e, g, b, ALONE(g)};                                                     \
        usual_forward(t, work, run, rows);                                                         \
    }                                                                                              \
    SPECIAL void back_##e##g##b(const gmi_elastic_work *work, const gmi_elastic_run *run,          \
                                double *rows) {                                                    \
        const traffic t = {e, g, b, ALONE(g)};                                                     \
        usual_back(t, work, run, rows);                                                            \
    }
USUAL_TRAFFIC(SPECIAL_FUNCTIONS)

static traffic traffic_of(const gmi_elastic_run *run) {
    const traffic t = {run->ending, run->through, run->beginning, run->alone};
    return t;
}

/* The same as a small number for what may be usual. */
#define KIND(e, g, b) (16 * (e) + 4 * (g) + (b))

static int kind_of(const gmi_elastic_run *run) {
    const int is_small = run->ending < 4 && run->through < 4 && run->beginning < 4;
    const int is_usual = is_small && (run->alone == 0 || run->through == 0);
    return is_usual ? KIND(run->ending, run->through, run->beginning) : -1;
}

/* Any: apart, as it needs more of the stack than all usual ones. */
SPECIAL void step_any(front_state *f, gmi_elastic_run *run) {
    any_step(traffic_of(run), f, run, f->work->front);
}

static void step_run(front_state *f, gmi_elastic_run *run) {
    switch (run->kind) {
#define CASE(e, g, b)                                                                              \
    case KIND(e, g, b):                                                                            \
        step_##e##g##b(f, run);                                                                    \
        return;
        USUAL_TRAFFIC(CASE)
#undef CASE
    default:
        step_any(f, run);
    }
}

static void forward_run(const gmi_elastic_work *work, const gmi_elastic_run *run, double *rows) {
    switch (run->kind) {
#define CASE(e, g, b)                                                                              \
    case KIND(e, g, b):                                                                            \
        forward_##e##g##b(work, run, rows);                                                        \
        return;
        USUAL_TRAFFIC(CASE)
#undef CASE
    default:
        any_forward(traffic_of(run), work, run, rows);
    }
}

static void back_run(const gmi_elastic_work *work, const gmi_elastic_run *run, double *rows) {
    switch (run->kind) {
#define CASE(e, g, b)                                                                              \
    case KIND(e, g, b):                                                                            \
        back_##e##g##b(work, run, rows);                                                           \
        return;
        USUAL_TRAFFIC(CASE)
#undef CASE
    default:
        any_back(traffic_of(run), work, run, rows);
    }
}

/* ---------------------------------------------------------------------------------------------
 * The whole face
 * ------------------------------------------------------------------------------------------- */

/* One behind the last element of a line. */
static int end_of(const gmi_elastic_line *line) {
    return line->element + line->elements;
}

/* How many of the rows low .. high - 1 have ended before element e. They are sorted by begin as by end. */
static int ended(const gmi_elastic_line *line, int low, int high, int e) {
    int row = low;
    while (row < high && end_of(&line[row]) <= e) {
        ++row;
    }
    return row - low;
}

void gmi_elastic_find_runs(gmi_elastic_work *work) {
    const gmi_elastic_line *line = work->line;
    const int count = work->count;
    gmi_elastic_run *run = work->run;
    work->begin = count > 0 ? line[0].element : 0;
    work->end = count > 0 ? end_of(&line[count - 1]) : 0;

    /* Elements from the first line on, in runs with the same lines. */
    int low = 0, high = 0;
    for (int e = work->begin; e < work->end; e = run++->last + 1) {
        /* Those that began before, and those that begin here. */
        const int before = high;
        while (high < count && line[high].element == e) {
            ++high;
        }

        const int ending = ended(line, low, before, e + 1);
        const int alone = ended(line, before, high, e + 1);

        run->first = run->last = e;
        run->low = low;
        run->ending = ending;
        run->through = before - low - ending;
        run->beginning = high - before - alone;
        run->alone = alone;
        run->kind = kind_of(run);
        low += ending + alone;

        /* The same up to where the next one begins, or the first one ends. */
        if (ending == 0 && high == before) {
            const int next = high < count ? line[high].element : work->end;
            const int last = low < high ? end_of(&line[low]) - 1 : next;
            run->last = (next < last ? next : last) - 1;
        }
    }
    work->runs = (int)(run - work->run);
}

static void back_all(const gmi_elastic_work *work, double *rows) {
    for (int k = work->runs - 1; k >= 0; --k) {
        back_run(work, &work->run[k], rows);
    }
}

double gmi_elastic_factor(const gmi_elastic *law, gmi_elastic_work *work, double *rows) {
    double *rim = rows + work->lines_max * work->stations;
    front_state f = {law, work, rows, work->factor, 0.0};
    work->carry[0] = law->rim.left[work->begin];
    work->carry[1] = rim[work->begin];
    for (int k = 0; k < work->runs; ++k) {
        step_run(&f, &work->run[k]);
    }

    /* The last station has the rim alone. */
    work->last_record = (int)(f.record - work->factor);
    f.record[0] = 1.0 / work->carry[0];
    rim[work->end] = work->carry[1] * f.record[0];
    f.fall += work->carry[1] * rim[work->end];
    back_all(work, rows);
    return f.fall;
}

void gmi_elastic_substitute(const gmi_elastic_work *work, double *rows) {
    for (int k = 0; k < work->runs; ++k) {
        forward_run(work, &work->run[k], rows);
    }
    gmi_elastic_rim(work, rows)[work->end] *= work->factor[work->last_record];
    back_all(work, rows);
}
