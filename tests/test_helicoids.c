/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The overlap along a line of contact, and where the line ends, against involute helicoids in space: the wheel's is turned
 * and moved as a rigid body, cut by a plane across the pinion's axis, and the point looked for that the pinion's flank
 * reaches first. External pairs and rings, both hands, both sides, posed at random. Nothing here knows of lines of action.
 */
#include "contact.h" /* one line of contact by itself */
#include "gearmesh/gearmesh.h"
#include "gm_test.h"
#include "meshing.h"
#include "random_gears.h"
#include "reference_gear.h"
#include "tilt.h"

static const double pi = 3.14159265358979323846;

typedef struct point {
    double x, y, z;
} point;

/* A flank of one tooth: involute from the base circle point at the polar angle `begin` at z = 0, turning by `twist` per z. */
typedef struct helicoid {
    double base_radius, begin, twist;
} helicoid;

/* Its point at a roll length and height. */
static point point_of(const helicoid *flank, double roll, double z) {
    const double angle = flank->begin + flank->twist * z - roll / flank->base_radius;
    const point p = {flank->base_radius * cos(angle) - roll * sin(angle),
                     flank->base_radius * sin(angle) + roll * cos(angle), z};
    return p;
}

/* The angle `begin` with which a flank of this base circle and twist passes through a point. */
static double begin_through(double base_radius, double twist, point p) {
    const double t = sqrt((p.x * p.x + p.y * p.y) / (base_radius * base_radius) - 1.0);
    return atan2(p.y, p.x) + t - atan(t) - twist * p.z;
}

/* A rigid body moved: turned by a rotation vector about its point `middle`, which goes to `to` (Rodrigues). */
typedef struct motion {
    point middle, to, rotation;
} motion;

static point cross(point a, point b) {
    const point c = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    return c;
}

static point moved(const motion *m, point p) {
    const point w = m->rotation;
    const double angle = sqrt(w.x * w.x + w.y * w.y + w.z * w.z);
    const double first = angle > 0.0 ? sin(angle) / angle : 1.0;
    const double second = angle > 0.0 ? (1.0 - cos(angle)) / (angle * angle) : 0.5;
    const point arm = {p.x - m->middle.x, p.y - m->middle.y, p.z - m->middle.z};
    const point once = cross(w, arm), twice = cross(w, once);
    const point at = {m->to.x + arm.x + first * once.x + second * twice.x,
                      m->to.y + arm.y + first * once.y + second * twice.y,
                      m->to.z + arm.z + first * once.z + second * twice.z};
    return at;
}

/* Two flanks that face each other, as drive flanks: a coast pair is seen in a mirror. */
typedef struct facing {
    helicoid pinion, wheel;
    motion of_wheel;
} facing;

/* The wheel's flank in the plane at z: its own height is found by iteration. */
static point in_plane(const facing *f, double roll, double z, double *own_z) {
    point p = {0.0, 0.0, 0.0};
    for (int k = 0; k < 6; ++k) {
        p = moved(&f->of_wheel, point_of(&f->wheel, roll, *own_z));
        *own_z += z - p.z;
    }
    return p;
}

/* The point that the pinion's flank reaches first. */
typedef struct touch {
    double begin;                   /* of the pinion's flank there (rad) */
    double pinion_roll, wheel_roll; /* (m) */
    double wheel_z;                 /* along the wheel's own axis (m) */
} touch;

static touch first_touch(const facing *f, double z, double near_roll, double step) {
    touch found = {0.0, 0.0, near_roll, z - f->of_wheel.to.z + f->of_wheel.middle.z};
    for (int k = 0; k < 7; ++k) {
        double begin[3];
        for (int i = 0; i < 3; ++i) {
            const point p = in_plane(f, found.wheel_roll + (i - 1) * step, z, &found.wheel_z);
            begin[i] = begin_through(f->pinion.base_radius, f->pinion.twist, p);
        }

        /* Vertex of the parabola through three points that come closer. */
        const double slope = 0.5 * (begin[2] - begin[0]);
        const double bend = begin[2] - 2.0 * begin[1] + begin[0];
        found.wheel_roll -= step * fmax(-5.0, fmin(5.0, slope / bend));
        step *= 0.4;
    }
    const point p = in_plane(f, found.wheel_roll, z, &found.wheel_z);
    found.begin = begin_through(f->pinion.base_radius, f->pinion.twist, p);
    found.pinion_roll = sqrt(p.x * p.x + p.y * p.y - f->pinion.base_radius * f->pinion.base_radius);
    return found;
}

/* Tooth pair i of a side at angles near 0, as drive flanks. */
static facing facing_of(const gm_pair *p, const gm_pose *pose, int side, int i, double phi_p,
                        double phi_w) {
    const double mirror = side == GM_DRIVE ? 1.0 : -1.0;
    const double hand = mirror * tan(p->base_helix_angle);
    const int is_ring = p->wheel.sign < 0.0;
    const double r_bp = p->pinion.base_radius, r_bw = p->wheel.base_radius;
    facing f;

    /* In the mirror pinion tooth i is -i, and its wheel tooth i - 1 is -i too. */
    f.pinion.base_radius = r_bp;
    f.pinion.twist = hand / r_bp;
    f.pinion.begin =
        mirror * phi_p + 2.0 * pi * i / p->pinion.teeth + p->pinion.base_half_thickness;
    const double tooth = mirror * phi_w + (2 * i + 1) * pi / p->wheel.teeth;
    f.wheel.base_radius = r_bw;
    f.wheel.twist = is_ring ? hand / r_bw : -hand / r_bw;
    f.wheel.begin =
        is_ring ? tooth - p->wheel.base_half_thickness : pi - tooth + p->wheel.base_half_thickness;

    /* A rotation vector is mirrored the other way. */
    const double middle = p->wheel.face_start + 0.5 * p->wheel.face_width;
    f.of_wheel.middle = (point){0.0, 0.0, middle};
    f.of_wheel.to =
        (point){(is_ring ? -1.0 : 1.0) * p->center_distance + pose->center_distance_change,
                mirror * pose->offset, middle + pose->axial_shift};
    f.of_wheel.rotation = (point){mirror * pose->skew, pose->inclination, 0.0};
    return f;
}

/* ---------------------------------------------------------------------------------------------
 * Against the core
 * ------------------------------------------------------------------------------------------- */

/* Numbers of the whole test. */
typedef struct tally {
    int cases, rings, points, ends;
    int reaching;                  /* lines that only tilted axes bring in */
    double worst_point, worst_end; /* of what is allowed */
} tally;

/* A start that is not given ends no line: the mate's tip does. The involute begins on the base circle, or goes on. */
static double start_of(const gm_gear *gear, double given) {
    return gear->start_is_given ? given : gear->sign < 0.0 ? -HUGE_VAL : 0.0;
}

/* How far a touching point is inside the flanks and faces of both gears: the least of it, below 0 outside (m). */
static double inside(const gm_pair *p, const gmi_engagement *at, const touch *t, double z) {
    const double sign = p->wheel.sign;
    const double *start = at->start_roll_length;
    const double middle = p->wheel.face_start + 0.5 * p->wheel.face_width;
    const double wheel_roll = sign * t->wheel_roll;
    const double limits[] = {
        t->pinion_roll - start_of(&p->pinion, start[GM_PINION]),
        p->pinion.tip_roll_length - t->pinion_roll,
        wheel_roll - start_of(&p->wheel, start[GM_WHEEL]),
        sign * p->wheel.tip_roll_length - wheel_roll,
        z,
        p->pinion.face_width - z,
        t->wheel_z - middle + 0.5 * p->wheel.face_width,
        middle + 0.5 * p->wheel.face_width - t->wheel_z,
    };
    double least = HUGE_VAL;
    for (size_t k = 0; k < sizeof limits / sizeof limits[0]; ++k) {
        least = fmin(least, limits[k]);
    }
    return least;
}

static void compare_line(const gm_pair *p, const gm_pose *pose, const gmi_engagement *at, int side,
                         int i, double phi_p, double phi_w, tally *all) {
    const double mirror = side == GM_DRIVE ? 1.0 : -1.0;
    const facing f = facing_of(p, pose, side, i, phi_p, phi_w);

    /* The line in the terms of the core. */
    const double x = p->pinion.base_radius * phi_p - p->wheel.base_radius * phi_w;
    const double delta = gmi_ideal_penetration(at, side, x + at->offset_shift);
    const double origin = at->phase_origin[side] +
                          mirror * (p->pinion.base_radius * phi_p + at->phase_shift) +
                          i * p->transverse_base_pitch;
    gmi_tilted_line tilted;
    gmi_tilt_cuts cuts;
    gmi_line_part part;
    gmi_tilt_line(p, at, side, origin, &tilted);
    GM_ASSERT_REL(gmi_tilt_gain(p, at, side), tilted.gain, 4.0 * DBL_EPSILON);
    gmi_tilt_cuts_find(p, at, side, delta, 0, &cuts);
    if (!gmi_tilt_cut_line(&cuts, origin, &part)) {
        return;
    }

    /*
     * What is left out is of third order in the tilt, over arms that are long against the line of action where the base
     * circles are close; and of second order in tilt and overlap together. Ends are straight lines in the tilt, so that
     * second order is left out of them.
     */
    const double theta = hypot(pose->skew, pose->inclination);
    const double arm = p->wheel.face_width + 0.5 * p->wheel.tip_radius;
    const double lever = 1.0 + arm / fabs(at->line_of_action);
    const double little = 8.0 * theta * theta * (theta * arm * lever * lever + fabs(delta)) +
                          2e-15 + 1e-9 * fabs(delta);
    for (int k = 0; k <= 4; ++k) {
        const double t1 = part.from + 0.25 * k * (part.to - part.from);
        const double z = p->face_start + t1 * p->face_width;
        const double rho = origin + mirror * p->face_advance * t1;
        const double near = p->wheel.sign * (at->line_of_action - rho);
        touch t = first_touch(&f, z, near, 0.02 * p->normal_module);
        const double expected = p->pinion.base_radius * (f.pinion.begin - t.begin);
        const double got =
            tilted.gain * delta + tilted.shift[0] + t1 * (tilted.shift[1] + t1 * tilted.shift[2]);
        GM_ASSERT_ABS(got, expected, little);
        all->worst_point = fmax(all->worst_point, fabs(got - expected) / little);
        ++all->points;

        /*
         * Within the line the touching point is on all flanks and faces, at its ends on the border of one. Roll lengths of
         * the pinion count as it stands, turned forward by the overlap.
         */
        t.pinion_roll += expected;
        const double least = inside(p, at, &t, z);
        const double small = 20.0 * theta * theta * arm * lever * lever + 1e-9;
        GM_ASSERT(least > -small);
        if (k % 4 == 0 && p->face_advance != 0.0) {
            GM_ASSERT_ABS(least, 0.0, small);
            all->worst_end = fmax(all->worst_end, fabs(least) / small);
            ++all->ends;
        }
    }
}

/* A line that misses the path between parallel axes by more than its ends can move has no part on both flanks. */
static void check_reach(const gm_pair *p, const gmi_engagement *at, int side, double phi_p,
                        double phi_w, tally *all) {
    gm_position position = {.phase = p->pinion.base_radius * phi_p + at->phase_shift};
    position.offset =
        p->pinion.base_radius * phi_p - p->wheel.base_radius * phi_w + at->offset_shift;
    gmi_lines lines;
    double reach;
    gmi_lines_find(p, at, side, &position, &lines);
    (void)gmi_tilt_bound(p, at, side, &reach);
    gmi_tilt_cuts cuts;
    gmi_tilt_cuts_find(p, at, side, lines.delta, 0, &cuts);

    /* Just as far from the path as that, before it and behind it. */
    const double origins[2] = {lines.lower - lines.rise - reach, lines.upper - lines.fall + reach};
    for (int k = 0; k < 2; ++k) {
        gmi_line_part part;
        (void)gmi_tilt_cut_line(&cuts, origins[k], &part);
        const int is_outside = !(part.to - part.from > 1e-9);
        GM_ASSERT(is_outside);

        /* And some of it is needed. */
        (void)gmi_tilt_cut_line(&cuts, k == 0 ? lines.lower - lines.rise : lines.upper - lines.fall,
                                &part);
        all->reaching += part.to - part.from > 1e-6;
    }
}

/* Lengths within mm or so, as the tolerances above are for gears. */
static int is_usual(const gm_pair *p) {
    return fabs(p->helix_angle) < 0.7 && p->normal_module > 0.5e-3 && p->normal_module < 20e-3 &&
           p->face_width < 20.0 * p->normal_module && p->transverse_contact_ratio > 0.5 &&
           p->pinion.start_roll_length > 0.05 * p->line_of_action &&
           (p->wheel.sign < 0.0 || p->wheel.start_roll_length > 0.05 * p->line_of_action);
}

static void lines_between_posed_gears_are_those_of_helicoids(void) {
    uint64_t seed = UINT64_C(301);
    tally all = {0, 0, 0, 0, 0, 0.0, 0.0};
    for (int n = 0; all.cases < 400 && n < 6000; ++n) {
        gm_pair_params params;
        model_pair model;
        gm_pair pair;
        const uint64_t first = seed;
        if (n % 2 == 0) {
            random_ring_params(&seed, &params, &model);
        } else {
            random_params(&seed, &params, &model);
        }
        params.wheel_face_width = params.face_width * (n % 3 == 0 ? 1.3 : 1.0);
        params.axial_offset = n % 3 == 0 ? 0.1 * params.face_width : 0.0;
        if (gm_pair_init(&pair, &params) != GM_OK || !is_usual(&pair)) {
            continue;
        }

        /* Half an eighth of the base pitch over the face at most, and 4 mrad. */
        const double m_n = params.normal_module;
        const double most = fmin(4e-3, pair.transverse_base_pitch / (16.0 * pair.face_width));
        const double theta = n % 7 == 0 ? 0.0 : most * gm_test_uniform(&seed, 0.1, 1.0);
        const double way = gm_test_uniform(&seed, 0.0, 2.0 * pi);
        const gm_pose pose = {
            m_n * gm_test_uniform(&seed, -0.03, 0.03), m_n * gm_test_uniform(&seed, -0.03, 0.03),
            n % 5 == 0 ? 0.0 : 0.1 * params.face_width * gm_test_uniform(&seed, -1.0, 1.0),
            theta * cos(way), theta * sin(way)};
        gmi_engagement at;
        if (gmi_engagement_find(&pair, &pose, &at) != GM_OK) {
            continue;
        }

        /* Away from the base circle, where the involute ends, also where a tilt moves a point of the line towards it. */
        const double pinion_start = at.start_roll_length[GM_PINION];
        const double closer = theta * pair.wheel.face_width;
        if (pinion_start * pinion_start < 2.0 * pair.pinion.base_radius * closer) {
            continue;
        }
        gm_test_context("case %d, seed %llx, z %d/%d, helix %.3g, tilt %.3g mrad", n,
                        (unsigned long long)first, params.pinion_teeth, params.wheel_teeth,
                        params.helix_angle, 1e3 * theta);
        ++all.cases;
        all.rings += params.wheel_teeth < 0;

        /* All lines of a side at some angle, a little overlap. */
        for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
            const double mirror = side == GM_DRIVE ? 1.0 : -1.0;
            const double overlap = m_n * gm_test_uniform(&seed, 0.0, 1e-3);
            const double x = mirror * (0.5 * at.backlash + overlap) - at.offset_shift;
            const double phi_p = gm_test_uniform(&seed, -0.02, 0.02);
            const double phi_w = (pair.pinion.base_radius * phi_p - x) / pair.wheel.base_radius;
            if (at.is_tilted) {
                check_reach(&pair, &at, side, phi_p, phi_w, &all);
            }
            const double middle = 0.5 * (pair.path_start + pair.path_end);
            const double origin = at.phase_origin[side] + mirror * pair.pinion.base_radius * phi_p;
            const int nearest = (int)floor((middle - origin) / pair.transverse_base_pitch);
            for (int i = nearest - 3; i <= nearest + 3; ++i) {
                compare_line(&pair, &pose, &at, side, i, phi_p, phi_w, &all);
            }
        }
    }
    gm_test_context("all cases");
    GM_ASSERT(all.reaching > 100);
    printf("%d cases, %d rings, %d points within %.2g, %d ends within %.2g of what is allowed ",
           all.cases, all.rings, all.points, all.worst_point, all.ends, all.worst_end);
    GM_ASSERT_INT(all.cases, 400);
    GM_ASSERT(all.rings > 150 && all.rings < 250);
    GM_ASSERT(all.points > 6000);
    GM_ASSERT(all.ends > 2000);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(lines_between_posed_gears_are_those_of_helicoids),
    };
    return gm_test_main("reference.helicoids", tests, GM_TEST_COUNT(tests), argc, argv);
}
