/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "elastic_model.h"
#include "elastic.h"
#include "tooth_compliance.h"

enum { POINTS = 800, NODES = GMI_ELASTIC_STATIONS_MAX };

typedef struct model_point {
    int line; /* number in order */
    int element;
    long double t;      /* between the stations of the element */
    long double weight; /* over z */
    long double s;      /* of the tooth layer */
    long double w;      /* deviation, less the gap of an edge */
    long double grows;  /* of the approach with x: less by what the roll of the wheel takes */
    long double B, L;   /* delta = B q (L - ln q) */
} model_point;

typedef struct model {
    model_point point[POINTS];
    int points, lines;
    int index[GMI_ELASTIC_LINES_MAX];
    long double tooth[NODES][NODES], rim[NODES][NODES]; /* inverses of the layers */
    long double r2;
    long double compliance[POINTS][POINTS];
    long double matrix[POINTS][POINTS + 1];
    long double load[POINTS];
} model;

/* Gauss-Jordan on a symmetric positive definite matrix, in place. */
static void invert(int n, long double a[NODES][NODES]) {
    for (int k = 0; k < n; ++k) {
        const long double pivot = a[k][k];
        a[k][k] = 1.0L;
        for (int c = 0; c < n; ++c) {
            a[k][c] /= pivot;
        }
        for (int i = 0; i < n; ++i) {
            if (i != k) {
                const long double factor = a[i][k];
                a[i][k] = 0.0L;
                for (int c = 0; c < n; ++c) {
                    a[i][c] -= factor * a[k][c];
                }
            }
        }
    }
}

static void make_layer(const elastic_gear *g, long double length, long double softening,
                       long double a[NODES][NODES]) {
    const int n = g->stations;
    const long double m = g->normal_module, cosine = cosl(g->helix_angle);
    const long double h = (long double)g->face_width / (n - 1);
    for (int i = 0; i < n; ++i) {
        for (int k = 0; k < n; ++k) {
            a[i][k] = 0.0L;
        }
    }
    for (int e = 0; e < n - 1; ++e) {
        const long double middle = h * (e + 0.5L);
        const long double d = fminl(middle, g->face_width - middle) / cosine;
        const long double l2 =
            length * m * cosine * length * m * cosine * (1.0L - softening * expl(-d / (0.8L * m)));
        a[e][e] += h / 3.0L + l2 / h;
        a[e + 1][e + 1] += h / 3.0L + l2 / h;
        a[e][e + 1] += h / 6.0L - l2 / h;
        a[e + 1][e] = a[e][e + 1];
    }
    invert(n, a);
}

/* Teeth of both gears. */
typedef struct model_teeth {
    gmi_tooth tooth[2];
    long double cosine; /* cos(beta_b) */
} model_teeth;

static void make_teeth(const elastic_gear *g, model_teeth *teeth) {
    teeth->cosine = cosl(g->base_helix_angle);
    for (int k = 0; k < 2; ++k) {
        const gmi_tooth_params params = {
            (double)(g->teeth[k] / (teeth->cosine * teeth->cosine * cosl(g->helix_angle))),
            g->normal_module,
            g->pressure_angle,
            g->shift[k],
            g->normal_module * (0.5 * GMI_PI + 2.0 * g->shift[k] * tan(g->pressure_angle)),
            g->dedendum,
            g->fillet_radius,
            g->youngs_modulus[k],
            g->poisson_ratio[k]};
        GM_ASSERT_INT(gmi_tooth_init(&teeth->tooth[k], &params), GMI_TOOTH_FINE);
    }
}

/* Tooth layer and contact law of a point with this rho_p. */
static void set_teeth(const elastic_gear *g, const model_teeth *teeth, const long double soft[2],
                      long double rho, long double r2, model_point *p) {
    const long double roll[2] = {rho, g->line_of_action - rho};
    long double c = 0.0L, sum = 0.0L, level = 0.0L, moduli = 0.0L;
    for (int k = 0; k < 2; ++k) {
        const long double nu = g->poisson_ratio[k], E = g->youngs_modulus[k];
        const long double B = 2.0L * (1.0L - nu * nu) / (GMI_PI * E);
        gmi_tooth_load load;
        GM_ASSERT_INT(gmi_tooth_load_at(&teeth->tooth[k], (double)(roll[k] / teeth->cosine), &load),
                      GMI_TOOTH_FINE);
        c += soft[k] * ((long double)load.bending + load.foundation);
        sum += B;
        moduli += (1.0L - nu * nu) / E;
        level += B * (logl(2.0L * load.depth) + 0.06L);
    }
    const long double rho_red = roll[0] * roll[1] / (g->line_of_action * teeth->cosine);
    const long double a_1 = sqrtl(4.0L * rho_red / GMI_PI * moduli);
    p->s = sqrtl(c / teeth->cosine - r2);
    p->B = sum / (2.0L * teeth->cosine);
    p->L = (level - sum * logl(a_1)) / (0.5L * sum);
}

/* ---------------------------------------------------------------------------------------------
 * Tip edges
 * ------------------------------------------------------------------------------------------- */

/*
 * Roll of the mate at which its flank goes through a point. Lengths over its base radius, its axis in the origin: on the line
 * of action the point (1, tau) has the roll tau.
 */
static long double roll_through(long double x, long double y) {
    const long double distance = hypotl(x, y);
    long double low = 0.0L, high = 10.0L;
    for (int k = 0; k < 80; ++k) {
        const long double tau = 0.5L * (low + high);
        *(hypotl(1.0L, tau) < distance ? &low : &high) = tau;
    }

    /* The involute unwound by tau that began at the angle 0, and how far it has to turn. */
    const long double flank_x = cosl(low) + low * sinl(low);
    const long double flank_y = low * cosl(low) - sinl(low);
    return atan2l(y, x) - atan2l(flank_y, flank_x);
}

/*
 * Gap along the line of action after a roll of the gear whose tip it is: the corner is turned back about its axis, then the
 * mate until it touches. [0] pinion's tip, [1] wheel's.
 */
static long double gap_of(const elastic_gear *g, int of, long double roll) {
    const long double r_g = g->base_radius[of], r_m = g->base_radius[1 - of];
    const long double radius = g->tip_radius[of];
    const long double tip = copysignl(sqrtl((radius - r_g) * (radius + r_g)), r_g);
    const long double length = g->line_of_action, start = length - tip;

    /* Axes at (-r_m, 0) and (r_g, length), the corner on the line of action at first. */
    const long double turn = roll / r_g;
    const long double n = r_g - r_g * cosl(turn) + tip * sinl(turn);
    const long double e = length - tip * cosl(turn) - r_g * sinl(turn);
    const long double touching = r_m * roll_through((n + r_m) / r_m, e / r_m);
    return touching - start + roll;
}

/* Tooth and contact law go on beyond the path as the slopes at its end say, for a while; the edge takes over. */
static void hold_at_tip(const elastic_gear *g, const model_teeth *teeth, long double r2,
                        long double rounding, long double end, long double beyond, model_point *p) {
    const int of = beyond > 0.0L ? 0 : 1;
    const long double radius = g->tip_radius[of], r_b = g->base_radius[of];
    const long double tip = copysignl(sqrtl((radius - r_b) * (radius + r_b)), r_b);
    const long double mate = g->line_of_action - tip;
    const long double fading = rounding * r_b / tip;
    const long double t = fminl(fabsl(beyond) / fading, 1.0L);
    const long double moved = copysignl(fading * t * (1.0L - 0.5L * t), beyond);

    /* Slopes by differences within the path. */
    const long double soft[2] = {1.0L, 1.0L}, step = 1e-5L * g->normal_module;
    model_point first = *p, second = *p;
    set_teeth(g, teeth, soft, end - copysignl(step, beyond), r2, &first);
    set_teeth(g, teeth, soft, end - copysignl(2.0L * step, beyond), r2, &second);
    set_teeth(g, teeth, soft, end, r2, p);
    const long double direction = copysignl(1.0L, beyond) / (2.0L * step);
    const long double s_slope = direction * (3.0L * p->s - 4.0L * first.s + second.s);
    const long double L_slope = direction * (3.0L * p->L - 4.0L * first.L + second.L);
    p->s += moved * s_slope;
    p->L -= logl(1.0L - moved * L_slope);

    /* From the curvature of both flanks to that of flank and edge. */
    const long double sharper = (1.0L / mate + 1.0L / rounding) / (1.0L / mate + 1.0L / tip);
    p->L += logl(sharper) * t * t * (3.0L - 2.0L * t);
}

/* What edges change at a point of rho_p: beyond the path, and where the wheel has rolled on by x. */
static void add_edge(const elastic_gear *g, const model_teeth *teeth, long double r2,
                     long double rounding, long double rho, long double x, model_point *p) {
    const long double begin = g->path_start, end = g->path_end;
    const int leaves = rho > 0.5L * (begin + end);
    const long double roll = leaves ? rho - end : begin + x - rho;
    if (rho > end || rho < begin) {
        hold_at_tip(g, teeth, r2, rounding, leaves ? end : begin, leaves ? rho - end : rho - begin,
                    p);
    }
    if (roll > 0.0L) {
        const long double step = 1e-5L * g->normal_module;
        p->w -= gap_of(g, leaves ? 0 : 1, roll);
        p->grows -=
            leaves ? 0.0L : (gap_of(g, 1, roll + step) - gap_of(g, 1, roll - step)) / (2.0L * step);
    }
}

/* What a line is made of beside the gears. */
typedef struct model_lines {
    const elastic_deviation *deviation;
    const double (*softness)[3];
    long double rounding, x; /* (m); 0: no edges */
    const double *cut;       /* beyond the path (m) */
} model_lines;

static void sort(int count, long double *values) {
    for (int k = 1; k < count; ++k) {
        for (int i = k; i > 0 && values[i] < values[i - 1]; --i) {
            const long double swap = values[i];
            values[i] = values[i - 1];
            values[i - 1] = swap;
        }
    }
}

static void add_line(model *m, const elastic_gear *g, const model_lines *lines,
                     const model_teeth *teeth, int k, long double rho_0) {
    const double(*softness)[3] = lines->softness;
    const long double further = lines->rounding > 0.0L ? 0.5L * g->pitch : 0.0L;
    const long double begin = g->path_start - further, end = g->path_end + further;
    const long double climb = tanl(g->base_helix_angle), b = g->face_width;
    const long double h = b / (g->stations - 1);

    /* The part of the line within the path, or as far beyond it as edges are looked for. */
    long double from = 0.0L, to = b;
    if (climb == 0.0L) {
        to = rho_0 >= begin && rho_0 <= end ? b : 0.0L;
    } else {
        const long double ends[2] = {(begin - rho_0) / climb, (end - rho_0) / climb};
        from = fmaxl(from, fminl(ends[0], ends[1]));
        to = fminl(to, fmaxl(ends[0], ends[1]));
    }
    if (from >= to) {
        return;
    }

    const long double soft[2] = {softness != NULL ? softness[0][((k % 3) + 3) % 3] : 1.0L,
                                 softness != NULL ? softness[1][((k % 3) + 3) % 3] : 1.0L};

    for (int e = 0; e < g->stations - 1; ++e) {
        /* Lines with edges go over whole elements, in parts between the cuts within. */
        long double bound[6] = {fmaxl(from, e * h), fminl(to, (e + 1) * h)};
        int bounds = 2;
        if (!(bound[1] > bound[0])) {
            continue;
        }
        for (int c = 0; c < 4 && further > 0.0L; ++c) {
            const long double rho = c < 2 ? g->path_start - (c == 0 ? lines->cut[0] : 0.0)
                                          : g->path_end + (c == 2 ? lines->cut[1] : 0.0);
            const long double z = climb == 0.0L ? -1.0L : (rho - rho_0) / climb;
            if (z > e * h && z < (e + 1) * h) {
                bound[bounds++] = z;
            }
        }

        if (further > 0.0L) {
            bound[0] = e * h;
            bound[1] = (e + 1) * h;
        }
        sort(bounds, bound);

        /* Two points of Gauss in each part. */
        for (int part = 0; part < 2 * (bounds - 1); ++part) {
            const long double low = bound[part / 2], high = bound[part / 2 + 1];
            model_point *p = &m->point[m->points++];
            const long double xi = 0.5L + (part % 2 == 0 ? -0.5L : 0.5L) / sqrtl(3.0L);
            const long double z = low + xi * (high - low), rho = rho_0 + climb * z;
            double ignored[2];

            p->line = m->lines;
            p->element = e;
            p->t = z / h - e;
            p->weight = 0.5L * (high - low);
            p->w = deviation_at(g, lines->deviation, k, (double)rho, (double)z, &ignored[0],
                                &ignored[1]);
            p->grows = 1.0L;
            set_teeth(g, teeth, soft, fminl(fmaxl(rho, g->path_start), g->path_end), m->r2, p);
            if (further > 0.0L) {
                add_edge(g, teeth, m->r2, lines->rounding, rho, lines->x, p);
            }
        }
    }
    m->index[m->lines++] = k;
}

static long double between(int n, long double a[NODES][NODES], const model_point *p,
                           const model_point *q) {
    (void)n;
    const int i = p->element, k = q->element;
    const long double low = (1.0L - q->t) * a[i][k] + q->t * a[i][k + 1];
    const long double high = (1.0L - q->t) * a[i + 1][k] + q->t * a[i + 1][k + 1];
    return (1.0L - p->t) * low + p->t * high;
}

/* Deflection at point i under a unit force at point k. */
static void make_compliance(model *m, int n) {
    for (int i = 0; i < m->points; ++i) {
        for (int k = 0; k < m->points; ++k) {
            const model_point *p = &m->point[i], *q = &m->point[k];
            long double c = m->r2 * between(n, m->rim, p, q);
            if (p->line == q->line) {
                c += p->s * q->s * between(n, m->tooth, p, q);
            }
            m->compliance[i][k] = c;
        }
    }
}

/* Gap that is left at point i with the loads as they are: x + w less all deflections. */
static long double approach_of(const model *m, int i, long double x) {
    long double gamma = x + m->point[i].w;
    for (int k = 0; k < m->points; ++k) {
        gamma -= m->compliance[i][k] * m->point[k].weight * m->load[k];
    }
    return gamma;
}

/* One step of Newton's method for the loads of the active points; returns the largest relative change. */
static long double step(model *m, long double x, const int *active, int count) {
    for (int i = 0; i < count; ++i) {
        const model_point *p = &m->point[active[i]];
        const long double q = m->load[active[i]];
        for (int k = 0; k < count; ++k) {
            m->matrix[i][k] = m->compliance[active[i]][active[k]] * m->point[active[k]].weight;
        }
        m->matrix[i][i] += p->B * (p->L - 1.0L - logl(q));
        m->matrix[i][count] = approach_of(m, active[i], x) - p->B * q * (p->L - logl(q));
    }

    /* Gauss with the largest pivot of each column. */
    for (int k = 0; k < count; ++k) {
        int best = k;
        for (int i = k + 1; i < count; ++i) {
            best = fabsl(m->matrix[i][k]) > fabsl(m->matrix[best][k]) ? i : best;
        }

        for (int c = 0; c <= count; ++c) {
            const long double swap = m->matrix[k][c];
            m->matrix[k][c] = m->matrix[best][c];
            m->matrix[best][c] = swap;
        }

        for (int i = k + 1; i < count; ++i) {
            const long double factor = m->matrix[i][k] / m->matrix[k][k];
            for (int c = k; c <= count && factor != 0.0L; ++c) {
                m->matrix[i][c] -= factor * m->matrix[k][c];
            }
        }
    }

    for (int k = count - 1; k >= 0; --k) {
        for (int c = k + 1; c < count; ++c) {
            m->matrix[k][count] -= m->matrix[k][c] * m->matrix[c][count];
        }
        m->matrix[k][count] /= m->matrix[k][k];
    }

    /* Loads stay above 0: no step takes more than 99 in 100 of one. */
    long double largest = 0.0L;
    for (int i = 0; i < count; ++i) {
        const long double before = m->load[active[i]];
        const long double after = fmaxl(before + m->matrix[i][count], 0.01L * before);
        largest = fmaxl(largest, fabsl(after - before) / before);
        m->load[active[i]] = after;
    }
    return largest;
}

/* Active set: points with a load so small that it is none go, points that are pressed come. */
static int solve(model *m, long double x) {
    int active[POINTS], count = 0;
    for (int i = 0; i < m->points; ++i) {
        const long double gamma = x + m->point[i].w;
        m->load[i] = gamma > 0.0L ? 0.1L * gamma / (m->point[i].B * m->point[i].L) : 0.0L;
    }
    for (int iteration = 0; iteration < 300; ++iteration) {
        int changed = 0;
        count = 0;
        for (int i = 0; i < m->points; ++i) {
            if (m->load[i] == 0.0L && approach_of(m, i, x) > 0.0L) {
                m->load[i] = 1e-3L * approach_of(m, i, x) / (m->point[i].B * m->point[i].L);
                changed = 1;
            } else if (m->load[i] > 0.0L && m->load[i] < 1e-15L * expl(m->point[i].L)) {
                m->load[i] = 0.0L;
                changed = 1;
            }
            if (m->load[i] > 0.0L) {
                active[count++] = i;
            }
        }
        if (step(m, x, active, count) < 1e-13L && !changed) {
            return 1;
        }
    }
    return 0;
}

int elastic_model_solve(const elastic_gear *g, const elastic_deviation *d,
                        const double softness[2][3], double tip_rounding, const double cut[2],
                        double o, double x, elastic_answer *answer) {
    static model m;
    model_teeth teeth;
    make_teeth(g, &teeth);
    m.points = m.lines = 0;
    m.r2 = 0.37L * (1.0L / g->youngs_modulus[0] + 1.0L / g->youngs_modulus[1]) / teeth.cosine;
    make_layer(g, 1.45L, 0.7L, m.tooth);
    make_layer(g, 2.9L, 0.0L, m.rim);
    const model_lines lines = {d, softness, tip_rounding * g->normal_module * teeth.cosine, x, cut};
    for (int k = -40; k <= 40; ++k) {
        add_line(&m, g, &lines, &teeth, k, o + k * (long double)g->pitch);
    }
    make_compliance(&m, g->stations);
    const int converged = solve(&m, x);

    memset(answer, 0, sizeof *answer);
    answer->lines = m.lines;
    answer->points = m.points;
    for (int k = 0; k < m.lines; ++k) {
        answer->index[k] = m.index[k];
    }
    for (int i = 0; i < m.points; ++i) {
        /* Half the work of the loads on the teeth, and the integral of q d delta in the contact. */
        const model_point *p = &m.point[i];
        const long double q = m.load[i], gamma = approach_of(&m, i, x);
        answer->line_force[p->line] += p->weight * q;
        answer->force += p->weight * q * p->grows;
        answer->energy += p->weight * 0.5L * q * (x + p->w - gamma);
        if (q > 0.0L) {
            answer->energy +=
                p->weight * (gamma * q - 0.5L * p->B * q * q * (p->L - logl(q) + 0.5L));
        }
    }
    return converged;
}
