/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "reference_model.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

/* pi = 3.243F6A88 85A308D3 13198A2E ... (hexadecimal) */
static const long double pi = 0x3.243F6A8885A308D3p0L;

/* 2 pi in parts of 27, 21 and then 24 bits: a part times an integer below 2^37 is exact. */
enum { PART_COUNT = 6 };
static const long double two_pi_parts[PART_COUNT] = {
    0x6487ED5p-24L, 0x110B46p-48L, 0x11A626p-72L, 0x33145Cp-96L, 0x06E0E6p-120L, 0x894812p-144L};

/** More breaks than any table of the tests has grid lines. */
enum { MAX_BREAKS = 8192 };

static long double involute(long double angle) {
    return tanl(angle) - angle;
}

static long double or_else(double value, long double fallback) {
    return isnan(value) ? fallback : (long double)value;
}

static long double maximum(long double a, long double b) {
    return a > b ? a : b;
}

static long double minimum(long double a, long double b) {
    return a < b ? a : b;
}

/* ---------------------------------------------------------------------------------------------
 * Geometry
 * ------------------------------------------------------------------------------------------- */

static int is_ring(const model_pair *pair, int g) {
    return g == 1 && pair->is_ring;
}

static void set_thickness(model_pair *pair, const gm_pair_params *params) {
    const long double m_n = params->normal_module;
    const long double alpha_n = params->normal_pressure_angle;
    const long double cos_beta = cosl(params->helix_angle);

    /* The thickness given or that of the rack, then once more with what the wanted backlash takes off. */
    const double given[2] = {params->pinion_normal_thickness, params->wheel_normal_thickness};
    long double change = 0.0L;
    for (int pass = 0; pass < 2; ++pass) {
        long double thick = 0.0L;
        for (int g = 0; g < 2; ++g) {
            const long double nominal = m_n * (pi / 2 + 2 * pair->shift[g] * tanl(alpha_n));
            pair->normal_thickness[g] = or_else(given[g], nominal) + change;
            const long double transverse = pair->normal_thickness[g] / cos_beta;
            const long double turn = involute(pair->alpha_t);
            pair->psi[g] =
                transverse / (2 * pair->reference_radius[g]) + (is_ring(pair, g) ? -turn : turn);
            thick += 2 * pair->base_radius[g] * pair->psi[g];
        }

        /* Backlash: what the thicknesses leave of the base pitch, with what the working angle adds. */
        const long double apart = pair->is_ring ? pair->base_radius[0] - pair->base_radius[1]
                                                : pair->base_radius[0] + pair->base_radius[1];
        pair->backlash = pair->base_pitch - thick + 2 * apart * involute(pair->alpha_wt);
        if (isnan(params->backlash)) {
            return;
        }
        /* A thickness s_t at r counts s_t r_b / r on the line of action, r_b / r = cos(alpha_t). */
        change =
            (pair->backlash - (long double)params->backlash) * cos_beta / (2 * cosl(pair->alpha_t));
    }
}

/** Roll length on gear g of the point where the mate's is rho. */
static long double mates_roll_length(const model_pair *pair, int g, long double rho) {
    if (pair->is_ring) {
        return g == 0 ? rho - pair->line_of_action : rho + pair->line_of_action;
    }
    return pair->line_of_action - rho;
}

static void set_active_profile(model_pair *pair, const gm_pair_params *params) {
    const long double m_n = params->normal_module;
    const double tip[2] = {params->pinion_tip_radius, params->wheel_tip_radius};
    const double start[2] = {params->pinion_start_radius, params->wheel_start_radius};
    /* The axes are closer than the shifts ask for, those of a ring's pair further apart: both teeth are cut shorter by as
     * much. */
    const long double apart = pair->shift[0] + pair->shift[1];
    const long double spread =
        pair->is_ring
            ? pair->reference_radius[1] - pair->reference_radius[0] - pair->center_distance
            : pair->center_distance - pair->reference_radius[0] - pair->reference_radius[1];
    const long double cut = maximum(0.0L, apart - spread / m_n);
    for (int g = 0; g < 2; ++g) {
        const long double r_b = pair->base_radius[g];
        const long double height = m_n * (1 + pair->shift[g] - cut);
        pair->tip_radius[g] =
            or_else(tip[g], is_ring(pair, g) ? pair->reference_radius[g] - height
                                             : pair->reference_radius[g] + height);
        pair->rho_end[g] = sqrtl(pair->tip_radius[g] * pair->tip_radius[g] - r_b * r_b);
    }
    for (int g = 0; g < 2; ++g) {
        const long double r_b = pair->base_radius[g];
        if (isnan(start[g])) {
            pair->rho_start[g] = maximum(0.0L, mates_roll_length(pair, g, pair->rho_end[1 - g]));
        } else {
            const long double r = start[g];
            pair->rho_start[g] = r > r_b ? sqrtl((r - r_b) * (r + r_b)) : 0.0L;
        }
        pair->start_radius[g] = sqrtl(r_b * r_b + pair->rho_start[g] * pair->rho_start[g]);
    }
}

void model_pair_init(model_pair *pair, const gm_pair_params *params) {
    const long double m_n = params->normal_module;
    const long double alpha_n = params->normal_pressure_angle;
    const long double beta = params->helix_angle;
    const long double d = params->center_distance;

    pair->teeth[0] = params->pinion_teeth;
    pair->teeth[1] = abs(params->wheel_teeth);
    pair->is_ring = params->wheel_teeth < 0;
    pair->transverse_module = m_n / cosl(beta);
    pair->alpha_t = atanl(tanl(alpha_n) / cosl(beta));
    pair->beta_b = params->base_helix == GM_BASE_HELIX_PAPER
                       ? atanl(tanl(beta) / cosl(pair->alpha_t))
                       : asinl(sinl(beta) * cosl(alpha_n));

    /* Circles of both gears. */
    for (int g = 0; g < 2; ++g) {
        pair->reference_radius[g] = pair->transverse_module * pair->teeth[g] / 2;
        pair->base_radius[g] = pair->reference_radius[g] * cosl(pair->alpha_t);
    }

    /* Working angle and line of action. */
    const long double base_sum = pair->is_ring ? pair->base_radius[1] - pair->base_radius[0]
                                               : pair->base_radius[0] + pair->base_radius[1];
    pair->center_distance = d;
    pair->alpha_wt = acosl(base_sum / d);
    pair->line_of_action = sqrtl((d - base_sum) * (d + base_sum));

    pair->base_pitch = pi * pair->transverse_module * cosl(pair->alpha_t);
    pair->face_width = params->face_width;
    pair->face_advance = pair->face_width * tanl(pair->beta_b);

    const long double shift_sum = (params->pinion_teeth + params->wheel_teeth) *
                                  (involute(pair->alpha_wt) - involute(pair->alpha_t)) /
                                  (2 * tanl(alpha_n));
    const double x_p = params->pinion_profile_shift;
    const double x_w = params->wheel_profile_shift;
    pair->shift[0] = or_else(x_p, isnan(x_w) ? shift_sum / 2 : shift_sum - (long double)x_w);
    pair->shift[1] = or_else(x_w, isnan(x_p) ? shift_sum / 2 : shift_sum - (long double)x_p);
    set_thickness(pair, params);
    set_active_profile(pair, params);
}

long double model_path_length(const model_pair *pair) {
    const long double start =
        maximum(pair->rho_start[0], mates_roll_length(pair, 0, pair->rho_end[1]));
    const long double end =
        minimum(pair->rho_end[0], mates_roll_length(pair, 0, pair->rho_start[1]));
    return end - start;
}

/* ---------------------------------------------------------------------------------------------
 * One contact line
 * ------------------------------------------------------------------------------------------- */

/** Contact line of one pair: both rho are linear in t1. Index 0 = pinion, 1 = wheel. */
typedef struct line {
    const model_pair *pair;
    long double rho[2];   /**< ideal, at t1 = 0 */
    long double climb[2]; /**< change of rho over the face width */
    const model_table *table[2];
    const model_ramp *ramp[2];
    int ramp_count[2];
    long double extra; /**< pitch deviations and the shift asked for */
} line;

static long double profile_position(const line *l, int gear, long double t1) {
    const model_pair *pair = l->pair;
    return (l->rho[gear] + l->climb[gear] * t1 - pair->rho_start[gear]) /
           (pair->rho_end[gear] - pair->rho_start[gear]);
}

static int cell_of(long double position, int nodes) {
    int cell = (int)floorl(position * (nodes - 1));
    if (cell > nodes - 2) {
        cell = nodes - 2;
    }
    return cell < 0 ? 0 : cell;
}

/** Deviation at (t1, t2), bilinear. */
static long double deviation(const model_table *table, long double t1, long double t2) {
    if (table == NULL || table->face_nodes == 0) {
        return 0.0L;
    }
    const int n2 = table->profile_nodes;
    const int k1 = cell_of(t1, table->face_nodes);
    const int k2 = cell_of(t2, n2);
    const long double u = t1 * (table->face_nodes - 1) - k1;
    const long double v = t2 * (n2 - 1) - k2;
    const double *row = table->values + (size_t)k1 * (size_t)n2 + k2;
    const double *next = row + n2;
    return table->factor *
           ((1 - u) * ((1 - v) * row[0] + v * row[1]) + u * ((1 - v) * next[0] + v * next[1]));
}

/** Where the plane of a ramp is above the flank: the height that it lacks, else below 0. */
static long double plane_of(const model_ramp *ramp, long double t1, long double t2) {
    return ramp->factor * (ramp->offset + ramp->per_t1 * t1 + ramp->per_t2 * t2);
}

static long double approach_at(const line *l, long double t1) {
    long double delta =
        l->extra + (l->pair->is_ring ? l->rho[0] - l->rho[1] + l->pair->line_of_action
                                     : l->rho[0] + l->rho[1] - l->pair->line_of_action);
    for (int g = 0; g < 2; ++g) {
        const long double t2 = profile_position(l, g, t1);
        delta += deviation(l->table[g], t1, t2);
        for (int k = 0; k < l->ramp_count[g]; ++k) {
            delta -= maximum(0.0L, plane_of(&l->ramp[g][k], t1, t2));
        }
    }
    return delta;
}

static int compare(const void *a, const void *b) {
    const long double x = *(const long double *)a;
    const long double y = *(const long double *)b;
    return (x > y) - (x < y);
}

/** All t1 in (low, high) where the line crosses a grid line of either table or the edge of a ramp, and the two ends. */
static int find_breaks(const line *l, long double low, long double high, long double *breaks) {
    int count = 0;

    /* The ends of the line, and for each gear ... */
    breaks[count++] = low;
    breaks[count++] = high;
    for (int g = 0; g < 2; ++g) {
        /* ... where its ramps begin, ... */
        for (int k = 0; k < l->ramp_count[g]; ++k) {
            const long double first = plane_of(&l->ramp[g][k], 0.0L, profile_position(l, g, 0.0L));
            const long double last = plane_of(&l->ramp[g][k], 1.0L, profile_position(l, g, 1.0L));
            if (first != last) {
                breaks[count++] = first / (first - last);
            }
        }

        /* ... where the line crosses the grid of its table. */
        const model_table *table = l->table[g];
        if (table == NULL || table->face_nodes == 0) {
            continue;
        }
        for (int k = 0; k < table->face_nodes; ++k) {
            breaks[count++] = (long double)k / (table->face_nodes - 1);
        }
        const long double t2_first = profile_position(l, g, 0.0L);
        const long double slope = profile_position(l, g, 1.0L) - t2_first;
        for (int k = 0; k < table->profile_nodes && slope != 0.0L; ++k) {
            breaks[count++] = ((long double)k / (table->profile_nodes - 1) - t2_first) / slope;
        }
        if (count > MAX_BREAKS) {
            abort();
        }
    }

    /* Those within the line, in order. */
    int inside = 0;
    for (int i = 0; i < count; ++i) {
        if (breaks[i] >= low && breaks[i] <= high) {
            breaks[inside++] = breaks[i];
        }
    }
    qsort(breaks, (size_t)inside, sizeof *breaks, compare);
    return inside;
}

/** Adds the part a .. b of a line, on which delta = c0 + c1 u + c2 u^2 > 0, u in [0, 1] over low .. high. */
static void add_touching(const line *l, const long double c[3], long double low, long double high,
                         long double u_a, long double u_b, int side, model_result *result) {
    const long double length = (high - low) * (u_b - u_a);
    for (int k = 0; k < 3; ++k) {
        /* Simpson's rule: exact for delta times a linear function. */
        const long double weight = (k == 1 ? 4.0L : 1.0L) / 6.0L * length;
        const long double u = u_a + (u_b - u_a) * k / 2;
        const long double delta = c[0] + u * (c[1] + u * c[2]);
        const long double t1 = low + (high - low) * u;
        const long double rho = l->rho[0] + l->climb[0] * t1;
        result->sum[side] += weight * delta;
        result->sum_t1[side] += weight * delta * t1;
        result->sum_rho[side] += weight * delta * rho;
        result->contact[side] += weight;
        result->contact_t1[side] += weight * t1;
        result->contact_rho[side] += weight * rho;
    }

    /* Largest at an end, or where the slope is 0. */
    const long double top = -c[1] / (2 * c[2]);
    const long double places[3] = {u_a, u_b, top > u_a && top < u_b ? top : u_a};
    for (int k = 0; k < 3; ++k) {
        const long double u = places[k];
        result->largest[side] = maximum(result->largest[side], c[0] + u * (c[1] + u * c[2]));
    }

    /* Boole's rule: exact for delta squared, which is of fourth degree. */
    static const long double boole[5] = {7.0L, 32.0L, 12.0L, 32.0L, 7.0L};
    for (int k = 0; k < 5; ++k) {
        const long double u = u_a + (u_b - u_a) * k / 4;
        const long double delta = c[0] + u * (c[1] + u * c[2]);
        result->square[side] += boole[k] / 90.0L * length * delta * delta;
    }
}

/** Adds the piece low .. high, on which delta is a polynomial of second degree. */
static void add_piece(const line *l, long double low, long double high, int side,
                      model_result *result) {
    const long double first = approach_at(l, low);
    const long double middle = approach_at(l, (low + high) / 2);
    const long double last = approach_at(l, high);
    const long double c[3] = {first, -3 * first + 4 * middle - last,
                              2 * first - 4 * middle + 2 * last};

    /* The piece is cut where that parabola passes through 0, by the formula that loses no digits. */
    long double cuts[4] = {0.0L, 1.0L, 1.0L, 1.0L};
    int count = 1;
    const long double discriminant = c[1] * c[1] - 4 * c[2] * c[0];
    if (discriminant > 0.0L) {
        const long double q = -(c[1] + copysignl(sqrtl(discriminant), c[1])) / 2;
        const long double roots[2] = {c[2] != 0.0L ? q / c[2] : -1.0L,
                                      q != 0.0L ? c[0] / q : -1.0L};
        for (int i = 0; i < 2; ++i) {
            if (roots[i] > 0.0L && roots[i] < 1.0L) {
                cuts[count++] = roots[i];
            }
        }
    }

    /* What is above 0 between two cuts touches. */
    qsort(cuts, (size_t)count, sizeof *cuts, compare);
    for (int i = 0; i < count; ++i) {
        const long double u_a = cuts[i];
        const long double u_b = i + 1 < count ? cuts[i + 1] : 1.0L;
        const long double u = (u_a + u_b) / 2;
        if (c[0] + u * (c[1] + u * c[2]) > 0.0L) {
            add_touching(l, c, low, high, u_a, u_b, side, result);
        }
    }
}

static void add_line(const line *l, long double border, int side, model_result *result) {
    const model_pair *pair = l->pair;
    long double low = 0.0L;
    long double high = 1.0L;

    /* The part of the line on which both flanks are there. */
    for (int g = 0; g < 2; ++g) {
        const long double first = minimum(pair->rho_start[g], pair->rho_end[g]) - border;
        const long double last = maximum(pair->rho_start[g], pair->rho_end[g]) + border;
        if (l->climb[g] == 0.0L) {
            if (l->rho[g] < first || l->rho[g] > last) {
                return;
            }
            continue;
        }
        const long double a = (first - l->rho[g]) / l->climb[g];
        const long double b = (last - l->rho[g]) / l->climb[g];
        low = maximum(low, minimum(a, b));
        high = minimum(high, maximum(a, b));
    }

    if (high <= low) {
        return;
    }
    result->overlap[side] += high - low;

    static long double breaks[MAX_BREAKS];
    const int count = find_breaks(l, low, high, breaks);
    const long double before = result->contact[side];
    for (int i = 0; i + 1 < count; ++i) {
        if (breaks[i + 1] > breaks[i]) {
            add_piece(l, breaks[i], breaks[i + 1], side, result);
        }
    }
    result->pairs[side] += result->contact[side] > before;
}

/* ---------------------------------------------------------------------------------------------
 * All pairs
 * ------------------------------------------------------------------------------------------- */

/** angle = 2 pi * turns / teeth + remainder, |remainder| <= pi / teeth. */
static long double reduce(long double angle, int teeth, long long *turns) {
    const long double product = angle * teeth; /* exact: 53 bits times at most 11 */
    const long double k = roundl(product / (2 * pi));
    long double rest = product;
    for (int i = 0; i < PART_COUNT; ++i) {
        rest -= k * two_pi_parts[i];
    }
    *turns = (long long)k;
    return rest / teeth;
}

static int modulo(long long tooth, int teeth) {
    const int rest = (int)(tooth % teeth);
    return rest < 0 ? rest + teeth : rest;
}

void model_evaluate(const model_pair *pair, const model_flanks *pinion, const model_flanks *wheel,
                    long double pinion_angle, long double wheel_angle, long double approach,
                    long double border, model_result *result) {
    const int z_p = pair->teeth[0];
    const int z_w = pair->teeth[1];
    const long double r_bp = pair->base_radius[0];
    const long double r_bw = pair->base_radius[1];
    long long turns_p = 0;
    long long turns_w = 0;
    const long double phi_p = reduce(pinion_angle, z_p, &turns_p);
    const long double phi_w = reduce(wheel_angle, z_w, &turns_w);

    /* Teeth far beyond both ends of the lines of action of all sections. */
    const long long reach =
        2 * z_p + (long long)ceill(2 * fabsl(pair->face_advance) / pair->base_pitch);

    *result = (model_result){0};
    result->offset = r_bp * phi_p - r_bw * phi_w + pair->base_pitch * (turns_p - turns_w);
    for (int side = 0; side < 2; ++side) {
        const int s = side == 0 ? 1 : -1;
        for (long long i = -reach; i <= reach; ++i) {
            /* Drive: wheel tooth j = i; coast: j = i - 1; both counted before the reduction. */
            const long long j = i - turns_p + turns_w - side;
            const int tooth_p = modulo(i - turns_p, z_p);
            const int tooth_w = modulo(j - turns_w, z_w);
            const long double angle_p = phi_p + 2 * pi * i / z_p;
            const long double angle_w = phi_w + (2 * j + 1) * pi / z_w;
            line l = {.pair = pair, .extra = approach};
            l.rho[0] = r_bp * (pair->alpha_wt + pair->psi[0] + s * angle_p);
            l.climb[0] = s * pair->face_advance;
            if (pair->is_ring) {
                /* The flanks that look towards the pinion: on the other side of the tooth, and they turn with it. */
                l.rho[1] = r_bw * (pair->alpha_wt - pair->psi[1] + s * angle_w);
                l.climb[1] = s * pair->face_advance;
            } else {
                l.rho[1] = r_bw * (pair->alpha_wt + pair->psi[1] - s * angle_w);
                l.climb[1] = -s * pair->face_advance;
            }
            if (pinion != NULL) {
                l.table[0] = &pinion->table[side][tooth_p];
                l.ramp[0] = pinion->ramp[side];
                l.ramp_count[0] = pinion->ramp_count[side];
                l.extra += pinion->pitch[side][tooth_p];
            }
            if (wheel != NULL) {
                l.table[1] = &wheel->table[side][tooth_w];
                l.ramp[1] = wheel->ramp[side];
                l.ramp_count[1] = wheel->ramp_count[side];
                l.extra += wheel->pitch[side][tooth_w];
            }
            add_line(&l, border, side, result);
        }
    }
}
