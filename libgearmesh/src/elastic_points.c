/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * From deflections of the stations to loads at the points, and from there back to forces and stiffness of the stations.
 * The loops run over many slots, written so that a compiler does two or four at once: arrays as arguments that do not overlap.
 * Only the contact law, which looks up one row of a table for each, is written for four.
 */
#include "elastic.h"
#include "hertz.h"
#include "internal.h"
#include "wide.h"

#include <string.h>

/* Rows of an array over stations that the points of a cut take from: of its tooth, and of the rim. */
typedef struct cut_rows {
    const double *tooth, *rim;
} cut_rows;

static inline cut_rows rows_of_cut(const gmi_elastic_work *work, const double *rows,
                                   const gmi_elastic_cut *cut) {
    const ptrdiff_t n = work->stations;
    const cut_rows at = {rows + cut->row * n + cut->element,
                         rows + work->lines_max * n + cut->element};
    return at;
}

/* Between the two stations of an element. */
static inline double between(const double *row, double place) {
    return row[0] + place * (row[1] - row[0]);
}

/* Both points of each slot of one line, the second one `other` places behind the first. */
APART void approach_line(int count, int other, double x, const double *restrict place,
                         const double *restrict tooth, const double *restrict deviation,
                         const double *restrict tooth_row, const double *restrict rim_row,
                         double *restrict deflection, double *restrict approach) {
    for (int k = 0; k < count; ++k) {
        const double tooth_rise = tooth_row[k + 1] - tooth_row[k];
        const double rim_rise = rim_row[k + 1] - rim_row[k];
        const double phi = tooth_row[k] + place[k] * tooth_rise;
        const double psi = rim_row[k] + place[k] * rim_rise;
        deflection[k] = phi;
        approach[k] = (x + deviation[k]) - tooth[k] * phi - psi;
    }
    for (int k = 0; k < count; ++k) {
        const int p = k + other;
        const double phi = tooth_row[k] + place[p] * (tooth_row[k + 1] - tooth_row[k]);
        const double psi = rim_row[k] + place[p] * (rim_row[k + 1] - rim_row[k]);
        deflection[p] = phi;
        approach[p] = (x + deviation[p]) - tooth[p] * phi - psi;
    }
}

void gmi_elastic_approach(gmi_elastic_work *work, double x) {
    const double *rim = work->state + work->lines_max * work->stations;
    for (int k = 0; k < work->count; ++k) {
        const gmi_elastic_line *line = &work->line[k];
        const int s = line->slot;
        approach_line(line->elements, work->slots, x, work->place + s, work->tooth + s,
                      work->deviation + s, work->state + k * work->stations + line->element,
                      rim + line->element, work->deflection + s, work->approach_at + s);
    }

    /* What follows the cuts. */
    const double *place = work->place, *tooth = work->tooth, *deviation = work->deviation;
    double *deflection = work->deflection, *approach = work->approach_at;
    for (const gmi_elastic_cut *cut = work->cut, *end = cut + work->cuts; cut < end; ++cut) {
        const cut_rows at = rows_of_cut(work, work->state, cut);
        for (int half = 0, p = cut->after; half < 2; ++half, p += work->slots) {
            const double phi = between(at.tooth, place[p]), psi = between(at.rim, place[p]);
            deflection[p] = phi;
            approach[p] = (x + deviation[p]) - tooth[p] * phi - psi;
        }
    }
}

/* Arrays of gmi_elastic_load(). */
typedef struct load_arrays {
    const double *approach, *rate, *weight, *expected;
    double *slope, *load, *force, *stiffness, *excess;
} load_arrays;

/* Line loads, forces and stiffnesses from y of the contact law, which becomes B dq/d gamma. */
APART void load_points(int count, double per_compliance, const double *restrict approach,
                       const double *restrict weight, const double *restrict expected,
                       double *restrict slope, double *restrict load, double *restrict force,
                       double *restrict stiffness, double *restrict excess) {
    for (int k = 0; k < count; ++k) {
        /* y = 0 without contact; on the straight part of the law y > 1/2, and the slope is 1. */
        const double y = slope[k];
        const double steep = y / (1.0 - y);
        const double p = steep < 1.0 ? steep : 1.0;
        const double scaled = weight[k] * per_compliance;
        const double q = approach[k] * y;
        const double pushed = q * scaled;
        slope[k] = p;
        load[k] = q * per_compliance;
        force[k] = pushed;
        stiffness[k] = p * scaled;
        excess[k] = pushed - expected[k];
    }
}

/* From point `from` on. */
static void load_from(int from, int count, double per_compliance, const load_arrays *at) {
    for (int k = from; k < count; ++k) {
        at->slope[k] = gmi_hertz_reciprocal(at->approach[k] * at->rate[k]);
    }
    load_points(count - from, per_compliance, at->approach + from, at->weight + from,
                at->expected + from, at->slope + from, at->load + from, at->force + from,
                at->stiffness + from, at->excess + from);
}

#ifdef GMI_IN_WIDE
/* gmi_hertz_reciprocal() of four numbers. */
static inline __m256d reciprocals_of_four(__m256d eta) {
    __m256i bits = _mm256_castpd_si256(eta);
    __m256d is_known = _mm256_castsi256_pd(_mm256_set1_epi64x(-1));
    const __m256d is_usual =
        _mm256_and_pd(_mm256_cmp_pd(eta, _mm256_set1_pd(GMI_HERTZ_FROM), _CMP_GE_OQ),
                      _mm256_cmp_pd(eta, _mm256_set1_pd(GMI_HERTZ_TO), _CMP_LT_OQ));

    /* Not touching: 0, with any row of the table; not in it: each for itself. */
    if (_mm256_movemask_pd(is_usual) != 15) {
        const __m256d is_touching = _mm256_cmp_pd(eta, _mm256_setzero_pd(), _CMP_NLE_UQ);
        if (_mm256_movemask_pd(_mm256_andnot_pd(is_usual, is_touching)) != 0) {
            double y[4];
            _mm256_storeu_pd(y, eta);
            for (int k = 0; k < 4; ++k) {
                y[k] = gmi_hertz_reciprocal(y[k]);
            }
            return _mm256_loadu_pd(y);
        }
        is_known = is_usual;
        bits = _mm256_castpd_si256(_mm256_blendv_pd(_mm256_set1_pd(GMI_HERTZ_FROM), eta, is_usual));
    }

    /* Rows and places from the bits, as there: a row has 4 + 2 numbers. */
    const __m256i place =
        _mm256_or_si256(_mm256_and_si256(bits, _mm256_set1_epi64x(INT64_C(0x0001FFFFFFFFFFFF))),
                        _mm256_set1_epi64x(INT64_C(0x3FF0000000000000)));
    const __m256d t = _mm256_sub_pd(_mm256_castsi256_pd(place), _mm256_set1_pd(1.0625));
    const __m256i number =
        _mm256_sub_epi64(_mm256_srli_epi64(bits, 49), _mm256_set1_epi64x(GMI_HERTZ_FIRST_ROW));
    int64_t at[4];
    _mm256_storeu_si256((__m256i *)(void *)at, _mm256_add_epi64(_mm256_slli_epi64(number, 2),
                                                                _mm256_slli_epi64(number, 1)));
    const double *row[4];
    for (int k = 0; k < 4; ++k) {
        row[k] = &gmi_hertz_table[0][0] + at[k];
    }

    /* The polynomial. */
    GMI_TWO_OF_FOUR(row, 0, c0, c1);
    GMI_TWO_OF_FOUR(row, 2, c2, c3);
    GMI_TWO_OF_FOUR(row, 4, c4, c5);
    __m256d sum = _mm256_add_pd(c4, _mm256_mul_pd(t, c5));
    sum = _mm256_add_pd(c3, _mm256_mul_pd(t, sum));
    sum = _mm256_add_pd(c2, _mm256_mul_pd(t, sum));
    sum = _mm256_add_pd(c1, _mm256_mul_pd(t, sum));
    sum = _mm256_add_pd(c0, _mm256_mul_pd(t, sum));
    return _mm256_and_pd(sum, is_known);
}

/* Four points from k on: the same operations. */
static inline void load_four(double per_compliance, const load_arrays *at, int k) {
    const __m256d approach = _mm256_loadu_pd(at->approach + k);
    const __m256d y = reciprocals_of_four(_mm256_mul_pd(approach, _mm256_loadu_pd(at->rate + k)));
    const __m256d one = _mm256_set1_pd(1.0), per = _mm256_set1_pd(per_compliance);
    const __m256d p = _mm256_min_pd(_mm256_div_pd(y, _mm256_sub_pd(one, y)), one);
    const __m256d scaled = _mm256_mul_pd(_mm256_loadu_pd(at->weight + k), per);
    const __m256d q = _mm256_mul_pd(approach, y);
    const __m256d pushed = _mm256_mul_pd(q, scaled);
    _mm256_storeu_pd(at->slope + k, p);
    _mm256_storeu_pd(at->load + k, _mm256_mul_pd(q, per));
    _mm256_storeu_pd(at->force + k, pushed);
    _mm256_storeu_pd(at->stiffness + k, _mm256_mul_pd(p, scaled));
    _mm256_storeu_pd(at->excess + k, _mm256_sub_pd(pushed, _mm256_loadu_pd(at->expected + k)));
}
#endif

void gmi_elastic_load(const gmi_elastic *law, gmi_elastic_work *work) {
    const int count = 2 * work->slots;
    const double per_compliance = 1.0 / law->hertz_compliance;
    const load_arrays at = {work->approach_at, work->rate,      work->weight,
                            work->expected,    work->slope,     work->load,
                            work->force,       work->stiffness, work->scratch};
    int k = 0;
#ifdef GMI_IN_WIDE
    for (; k + 4 <= count; k += 4) {
        load_four(per_compliance, &at, k);
    }
#endif
    if (k < count) {
        load_from(k, count, per_compliance, &at);
    }
}

APART void follow_line(int count, int other, const double *restrict place,
                       const double *restrict tooth, const double *restrict force,
                       const double *restrict stiffness, const double *restrict tooth_row,
                       const double *restrict rim_row, double *restrict deflection,
                       double *restrict approach, double *restrict change,
                       double *restrict expected) {
    /* The first points of all slots: tooth and rim bend by phi and psi, the approach falls by both. */
    for (int k = 0; k < count; ++k) {
        const double phi = tooth_row[k] + place[k] * (tooth_row[k + 1] - tooth_row[k]);
        const double psi = rim_row[k] + place[k] * (rim_row[k + 1] - rim_row[k]);
        const double moved = tooth[k] * phi + psi;
        deflection[k] += phi;
        approach[k] -= moved;
        change[k] = -moved;
        expected[k] = force[k] - stiffness[k] * moved;
    }

    /* And the second ones. */
    for (int k = 0; k < count; ++k) {
        const int p = k + other;
        const double phi = tooth_row[k] + place[p] * (tooth_row[k + 1] - tooth_row[k]);
        const double psi = rim_row[k] + place[p] * (rim_row[k + 1] - rim_row[k]);
        const double moved = tooth[p] * phi + psi;
        deflection[p] += phi;
        approach[p] -= moved;
        change[p] = -moved;
        expected[p] = force[p] - stiffness[p] * moved;
    }
}

void gmi_elastic_follow(gmi_elastic_work *work) {
    const double *rim = work->change + work->lines_max * work->stations;
    for (int k = 0; k < work->count; ++k) {
        const gmi_elastic_line *line = &work->line[k];
        const int s = line->slot;
        follow_line(line->elements, work->slots, work->place + s, work->tooth + s, work->force + s,
                    work->stiffness + s, work->change + k * work->stations + line->element,
                    rim + line->element, work->deflection + s, work->approach_at + s,
                    work->change_at + s, work->expected + s);
    }

    /* What follows the cuts. */
    const double *place = work->place, *tooth = work->tooth;
    const double *force = work->force, *stiffness = work->stiffness;
    double *deflection = work->deflection, *approach = work->approach_at;
    double *change = work->change_at, *expected = work->expected;
    for (const gmi_elastic_cut *cut = work->cut, *end = cut + work->cuts; cut < end; ++cut) {
        const cut_rows at = rows_of_cut(work, work->change, cut);
        for (int half = 0, p = cut->after; half < 2; ++half, p += work->slots) {
            const double phi = between(at.tooth, place[p]);
            const double moved = tooth[p] * phi + between(at.rim, place[p]);
            deflection[p] += phi;
            approach[p] -= moved;
            change[p] = -moved;
            expected[p] = force[p] - stiffness[p] * moved;
        }
    }
}

APART void pull_line(int count, int other, const double *restrict place,
                     const double *restrict tooth, const double *restrict tooth_row,
                     const double *restrict rim_row, double *restrict pull,
                     double *restrict tooth_adjoint) {
    for (int k = 0; k < count; ++k) {
        const double phi = tooth_row[k] + place[k] * (tooth_row[k + 1] - tooth_row[k]);
        const double psi = rim_row[k] + place[k] * (rim_row[k + 1] - rim_row[k]);
        tooth_adjoint[k] = phi;
        pull[k] -= tooth[k] * phi + psi;
    }
    for (int k = 0; k < count; ++k) {
        const int p = k + other;
        const double phi = tooth_row[k] + place[p] * (tooth_row[k + 1] - tooth_row[k]);
        const double psi = rim_row[k] + place[p] * (rim_row[k + 1] - rim_row[k]);
        tooth_adjoint[p] = phi;
        pull[p] -= tooth[p] * phi + psi;
    }
}

void gmi_elastic_pull(gmi_elastic_work *work, const double *factor, const double *rows) {
    const int count = 2 * work->slots;
    if (factor != NULL) {
        memcpy(work->pull, factor, sizeof(double) * (size_t)count);
    }
    for (int p = 0; p < count && factor == NULL; ++p) {
        work->pull[p] = 1.0;
    }
    const double *rim = rows + work->lines_max * work->stations;
    for (int k = 0; k < work->count; ++k) {
        const gmi_elastic_line *line = &work->line[k];
        const int s = line->slot;
        pull_line(line->elements, work->slots, work->place + s, work->tooth + s,
                  rows + k * work->stations + line->element, rim + line->element, work->pull + s,
                  work->tooth_adjoint + s);
    }

    /* What follows the cuts. */
    const double *place = work->place, *tooth = work->tooth;
    double *pull = work->pull, *tooth_adjoint = work->tooth_adjoint;
    for (const gmi_elastic_cut *cut = work->cut, *end = cut + work->cuts; cut < end; ++cut) {
        const cut_rows at = rows_of_cut(work, rows, cut);
        for (int half = 0, p = cut->after; half < 2; ++half, p += work->slots) {
            const double phi = between(at.tooth, place[p]);
            tooth_adjoint[p] = phi;
            pull[p] -= tooth[p] * phi + between(at.rim, place[p]);
        }
    }
}

/* Forces of the two stations of each slot: of both points together. */
APART void divide(int count, const double *restrict first_force,
                  const double *restrict second_force, const double *restrict first_place,
                  const double *restrict second_place, const double *restrict first_tooth,
                  const double *restrict second_tooth, double *restrict tooth_left,
                  double *restrict tooth_right, double *restrict rim_left,
                  double *restrict rim_right) {
    for (int k = 0; k < count; ++k) {
        const double first = first_force[k], second = second_force[k];
        const double first_right = first * first_place[k];
        const double second_right = second * second_place[k];
        const double first_left = first - first_right, second_left = second - second_right;
        tooth_left[k] = first_tooth[k] * first_left + second_tooth[k] * second_left;
        tooth_right[k] = first_tooth[k] * first_right + second_tooth[k] * second_right;
        rim_left[k] = first_left + second_left;
        rim_right[k] = first_right + second_right;
    }
}

/* A station takes from the elements on both sides. */
APART void add_rows(int count, const double *restrict tooth_left,
                    const double *restrict tooth_right, const double *restrict rim_left,
                    const double *restrict rim_right, double *restrict tooth_row,
                    double *restrict rim_row) {
    tooth_row[0] += tooth_left[0];
    rim_row[0] += rim_left[0];
    for (int k = 1; k < count; ++k) {
        tooth_row[k] += tooth_right[k - 1] + tooth_left[k];
        rim_row[k] += rim_right[k - 1] + rim_left[k];
    }
    tooth_row[count] += tooth_right[count - 1];
    rim_row[count] += rim_right[count - 1];
}

void gmi_elastic_gather(gmi_elastic_work *work, const double *force, double *rows) {
    const int slots = work->slots;
    divide(slots, force, force + slots, work->place, work->place + slots, work->tooth,
           work->tooth + slots, work->parts[0], work->parts[1], work->parts[2], work->parts[3]);
    double *rim = rows + work->lines_max * work->stations;
    for (int k = 0; k < work->count; ++k) {
        const gmi_elastic_line *line = &work->line[k];
        const int s = line->slot;
        add_rows(line->elements, work->parts[0] + s, work->parts[1] + s, work->parts[2] + s,
                 work->parts[3] + s, rows + k * work->stations + line->element,
                 rim + line->element);
    }

    /* What follows the cuts. */
    const double *const part[4] = {work->parts[0], work->parts[1], work->parts[2], work->parts[3]};
    for (const gmi_elastic_cut *cut = work->cut, *end = cut + work->cuts; cut < end; ++cut) {
        double *row = rows + cut->row * work->stations + cut->element;
        row[0] += part[0][cut->after];
        row[1] += part[1][cut->after];
        rim[cut->element] += part[2][cut->after];
        rim[cut->element + 1] += part[3][cut->after];
    }
}

/* Stiffness of the two stations of each slot: left with left, left with right, right with right. */
APART void stiffen(int count, const double *restrict first_stiffness,
                   const double *restrict second_stiffness, const double *restrict first_place,
                   const double *restrict second_place, const double *restrict first_tooth,
                   const double *restrict second_tooth, double *restrict tooth_left,
                   double *restrict mixed_left, double *restrict rim_left) {
    double *tooth_cross = tooth_left + count, *tooth_right = tooth_cross + count;
    double *mixed_cross = mixed_left + count, *mixed_right = mixed_cross + count;
    double *rim_cross = rim_left + count, *rim_right = rim_cross + count;
    for (int k = 0; k < count; ++k) {
        const double t = first_place[k], u = second_place[k];
        const double first = first_stiffness[k], second = second_stiffness[k];
        const double s = first_tooth[k], r = second_tooth[k];

        /* Rim with rim: products of the shares of both stations. */
        const double first_r = first * t, second_r = second * u;
        const double first_rr = first_r * t, second_rr = second_r * u;
        const double first_lr = first_r - first_rr, second_lr = second_r - second_rr;
        const double first_ll = first - first_r - first_lr;
        const double second_ll = second - second_r - second_lr;
        rim_left[k] = first_ll + second_ll;
        rim_cross[k] = first_lr + second_lr;
        rim_right[k] = first_rr + second_rr;

        /* Times s: tooth with rim. Times s again: tooth with tooth. */
        const double mixed_ll = first_ll * s, other_ll = second_ll * r;
        const double mixed_lr = first_lr * s, other_lr = second_lr * r;
        const double mixed_rr = first_rr * s, other_rr = second_rr * r;
        mixed_left[k] = mixed_ll + other_ll;
        mixed_cross[k] = mixed_lr + other_lr;
        mixed_right[k] = mixed_rr + other_rr;
        tooth_left[k] = mixed_ll * s + other_ll * r;
        tooth_cross[k] = mixed_lr * s + other_lr * r;
        tooth_right[k] = mixed_rr * s + other_rr * r;
    }
}

void gmi_elastic_stiffen(gmi_elastic_work *work) {
    const int slots = work->slots;
    stiffen(slots, work->stiffness, work->stiffness + slots, work->place, work->place + slots,
            work->tooth, work->tooth + slots, work->matrix + GMI_TOOTH_LEFT * slots,
            work->matrix + GMI_MIXED_LEFT * slots, work->matrix + GMI_RIM_LEFT * slots);

    /* What follows a cut is stiffness of the same element. */
    for (const gmi_elastic_cut *cut = work->cut, *end = cut + work->cuts; cut < end; ++cut) {
        double *whole = work->matrix + cut->whole;
        const double *behind = work->matrix + cut->after;
        for (int m = 0; m < GMI_ELASTIC_MATRICES; ++m, whole += slots, behind += slots) {
            *whole += *behind;
        }
    }
}
