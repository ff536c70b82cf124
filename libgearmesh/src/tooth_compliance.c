/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Compliance of one tooth against its body, plane strain [Weber, Banaschek 1953]: the tooth as a tapered beam that is
 * clamped at its foot, and the foot on an elastic half-plane. Everything happens in the normal section of the virtual
 * spur gear [ISO21771]. The frame of the tooth: Y along its centre line from the gear's centre outwards, X its half thickness.
 *
 * A load along the line of action at the normal roll length rho_n leans by alpha' = rho_n / r_bn - psi_n against the
 * normal of the centre line and meets that line at y_p = r_bn / cos(alpha'). With u = y_p - y_f, S the chord of the foot and
 * k = cos(alpha')^2 (1 - nu^2) / E,
 *
 *     c_tooth = k [12 int (y_p - Y)^2 / (2 X)^3 dY + (2.4 / (1 - nu) + tan(alpha')^2) int dY / (2 X)],  y_f .. y_p
 *     c_found = k [18/pi (u/S)^2 + 2 (1 - 2 nu)/(1 - nu) u/S + 4.8/pi (1 + (1 - nu)/2.4 tan(alpha')^2)].
 *
 * Where y_p lies below the foot the integrals go on down the fillet with their sign, and u is negative: the compliance
 * stays smooth. Below the root circle the half thickness is that of the end of the fillet: lines of action reach it from
 * some 60 virtual teeth at a pressure angle of 25 degrees, and from some 120 at 20 degrees.
 *
 * ISO 21771 counts the teeth of a ring below 0, and with them its radii and roll lengths. So Y = -|Y| still grows towards
 * the tip, and all of this holds as it is. Only the fillet is another one, as no rack cuts a ring: a circle with the radius
 * of the rack's rounding that touches flank and root circle, as that of the rack itself does, 1/z = 0. The foot of a
 * ring has the tangent of 60 degrees [ISO6336, part 3].
 */
#include "tooth_compliance.h"

#include "gear.h"
#include "internal.h"

#include <math.h>

/* Between fillet and centre line at the foot. */
#define FOOT_TANGENT      (30.0 * GMI_PI / 180.0)
#define RING_FOOT_TANGENT (60.0 * GMI_PI / 180.0)

enum { GAUSS_HALF = 8, PANELS = 2, BISECTIONS = 100 };

/* Gauss-Legendre, 16 points on [-1, 1]: the positive half [Abramowitz, Stegun, table 25.4]. */
static const double gauss_place[GAUSS_HALF] = {
    0.0950125098376374402, 0.2816035507792589132, 0.4580167776572273863, 0.6178762444026437484,
    0.7554044083550030339, 0.8656312023878317439, 0.9445750230732325761, 0.9894009349916499326};
static const double gauss_weight[GAUSS_HALF] = {
    0.1894506104550684963, 0.1826034150449235889, 0.1691565193950025382, 0.1495959888165767321,
    0.1246289712555338720, 0.0951585116824927848, 0.0622535239386478929, 0.0271524594117540949};

/* A point of the profile and d Y / d parameter. */
typedef struct profile_point {
    double x, y, y_rate;
} profile_point;

/* Involute, parameter: the roll length r. R = hypot(r_bn, r), half angle H = psi_n - (r / r_bn - atan(r / r_bn)). */
static profile_point involute_point(const gmi_tooth *tooth, double r) {
    const double tangent = r / tooth->base_radius;
    const double radius = copysign(hypot(tooth->base_radius, r), tooth->base_radius);
    const double half_angle = tooth->base_half_thickness - (tangent - atan(tangent));
    const double x = radius * sin(half_angle);
    const double y = radius * cos(half_angle);

    /* dR/dr = r / R, dH/dr = -(r / R)^2 / r_bn */
    const double ratio = r / radius;
    const profile_point point = {x, y,
                                 ratio * cos(half_angle) + x * ratio * ratio / tooth->base_radius};
    return point;
}

/* By how much the rack has rolled when its rounding cuts with the tangent theta: the angle a. */
static double rolled_angle(const gmi_tooth *tooth, double theta) {
    const double along = -tooth->rounding_center * cos(theta) / sin(theta);
    return (along - tooth->rounding_offset) / tooth->reference_radius;
}

/* Fillet, parameter: theta, from fillet_begin at the involute to pi/2 at the root: of the rack, of a ring's circle. */
static profile_point fillet_point(const gmi_tooth *tooth, double theta) {
    const double sine = sin(theta), cosine = cos(theta);
    const double round = tooth->rounding_radius;
    if (tooth->base_radius < 0.0) {
        const profile_point point = {tooth->circle_x - round * cosine,
                                     tooth->circle_y - round * sine, -round * cosine};
        return point;
    }

    /* The rack's point that cuts there, X_c from the pitch point, and its change with theta. */
    const double along = -tooth->rounding_center * cosine / sine;
    const double along_rate = tooth->rounding_center / (sine * sine);
    const double p_x = along + round * cosine;
    const double p_y = tooth->reference_radius + tooth->rounding_center - round * sine;
    const double p_x_rate = along_rate - round * sine;
    const double p_y_rate = -round * cosine;

    /* Turned back by the angle that the gear has rolled: from the middle of the tooth space. */
    const double a = (along - tooth->rounding_offset) / tooth->reference_radius;
    const double a_rate = along_rate / tooth->reference_radius;
    const double cos_a = cos(a), sin_a = sin(a);
    const double g_x = p_x * cos_a - p_y * sin_a;
    const double g_y = p_x * sin_a + p_y * cos_a;
    const double g_x_rate = p_x_rate * cos_a - p_y_rate * sin_a - a_rate * g_y;
    const double g_y_rate = p_x_rate * sin_a + p_y_rate * cos_a + a_rate * g_x;

    /* Half a pitch further to the tooth's centre line. The fillet is its own mirror image beyond the middle. */
    const double side = g_x < 0.0 ? -1.0 : 1.0;
    const double sine_pitch = sin(tooth->half_pitch_angle);
    const double cosine_pitch = cos(tooth->half_pitch_angle);
    const profile_point point = {sine_pitch * g_y - cosine_pitch * side * g_x,
                                 cosine_pitch * g_y + sine_pitch * side * g_x,
                                 cosine_pitch * g_y_rate + sine_pitch * side * g_x_rate};
    return point;
}

/* Angle between a gear's fillet and the centre line: grows with theta. */
static double fillet_tangent(const gmi_tooth *tooth, double theta) {
    return theta - rolled_angle(tooth, theta) - tooth->half_pitch_angle;
}

/* theta of the tangent of 30 degrees, between alpha_n and pi/2. */
static double find_foot(const gmi_tooth *tooth) {
    double below = tooth->pressure_angle, above = 0.5 * GMI_PI;
    for (int k = 0; k < BISECTIONS; ++k) {
        const double middle = 0.5 * (below + above);
        if (fillet_tangent(tooth, middle) < FOOT_TANGENT) {
            below = middle;
        } else {
            above = middle;
        }
    }
    return 0.5 * (below + above);
}

/* The fillet that a rack's rounded tip cuts: where it begins, and the foot on it. */
static int set_rack_fillet(gmi_tooth *tooth, const gmi_tooth_params *params) {
    const double m_n = params->normal_module;
    const double alpha_n = params->normal_pressure_angle;
    const double round = params->rack_fillet_radius;
    const double straight = params->rack_dedendum - round;

    /* A thinner tooth is one between farther racks. */
    const double nominal = m_n * (0.5 * GMI_PI + 2.0 * params->profile_shift * tan(alpha_n));
    tooth->rounding_offset =
        m_n * (0.25 * GMI_PI - straight * tan(alpha_n) - round / cos(alpha_n)) +
        0.5 * (nominal - params->normal_thickness);
    if (!(tooth->rounding_offset >= 0.0)) {
        return GMI_TOOTH_FILLET;
    }

    /* Where the rack's straight flank ends, the fillet begins; a rounding above the pitch line cuts no fillet. */
    const double reach = straight + round * sin(alpha_n) - params->profile_shift;
    tooth->fillet_begin = alpha_n;
    tooth->fillet_roll_length = tooth->reference_radius * sin(alpha_n) - m_n * reach / sin(alpha_n);
    if (!(tooth->fillet_roll_length >= 0.0)) {
        return GMI_TOOTH_UNDERCUT;
    }
    if (!(tooth->rounding_center < 0.0) || !(fillet_tangent(tooth, alpha_n) <= FOOT_TANGENT) ||
        !(fillet_tangent(tooth, 0.5 * GMI_PI) > FOOT_TANGENT)) {
        return GMI_TOOTH_FOOT;
    }
    tooth->foot_angle = find_foot(tooth);
    return GMI_TOOTH_FINE;
}

/* The circle in a ring: its centre lies on the normal of the flank where both touch, and within the space. */
static int set_ring_fillet(gmi_tooth *tooth) {
    const double radius = tooth->reference_radius + tooth->rounding_center;
    const double along = -sqrt(radius * radius - tooth->base_radius * tooth->base_radius);
    tooth->fillet_roll_length = along - tooth->rounding_radius;
    tooth->fillet_begin =
        tooth->fillet_roll_length / tooth->base_radius - tooth->base_half_thickness;

    /* Both fillets of a space lie beside each other. */
    const double from_tooth = tooth->fillet_begin - atan(along / tooth->base_radius);
    if (!(from_tooth <= -tooth->half_pitch_angle)) {
        return GMI_TOOTH_SPACE;
    }

    /* The foot is where the tangent stands at its angle to the tooth's axis; it must lie on the circle. */
    tooth->circle_x = -radius * sin(from_tooth);
    tooth->circle_y = radius * cos(from_tooth);
    tooth->foot_angle = RING_FOOT_TANGENT;
    return tooth->fillet_begin <= RING_FOOT_TANGENT ? GMI_TOOTH_FINE : GMI_TOOTH_FOOT;
}

int gmi_tooth_init(gmi_tooth *tooth, const gmi_tooth_params *params) {
    const double m_n = params->normal_module;
    const double alpha_n = params->normal_pressure_angle;
    tooth->pressure_angle = alpha_n;
    tooth->youngs_modulus = params->youngs_modulus;
    tooth->poisson_ratio = params->poisson_ratio;

    /* The virtual spur gear. */
    tooth->reference_radius = 0.5 * m_n * params->virtual_teeth;
    tooth->base_radius = tooth->reference_radius * cos(alpha_n);
    tooth->base_half_thickness =
        0.5 * params->normal_thickness / tooth->reference_radius + gmi_involute(alpha_n);
    tooth->half_pitch_angle = GMI_PI / params->virtual_teeth;

    /* The rounding at the rack's tip, or in a ring. */
    const double straight = params->rack_dedendum - params->rack_fillet_radius;
    tooth->rounding_radius = params->rack_fillet_radius * m_n;
    tooth->rounding_center = -(straight - params->profile_shift) * m_n;
    const int fault =
        tooth->base_radius < 0.0 ? set_ring_fillet(tooth) : set_rack_fillet(tooth, params);
    if (fault != GMI_TOOTH_FINE) {
        return fault;
    }

    const profile_point foot = fillet_point(tooth, tooth->foot_angle);
    const profile_point root = fillet_point(tooth, 0.5 * GMI_PI);
    tooth->foot_y = foot.y;
    tooth->foot_chord = 2.0 * foot.x;
    tooth->root_y = root.y;
    tooth->root_half_thickness = root.x;
    return foot.x > 0.0 && root.x > 0.0 ? GMI_TOOTH_FINE : GMI_TOOTH_FOOT;
}

/* Integrals over the profile from the foot up to y_p. */
typedef struct beam {
    double y_p;
    double bending; /* of (y_p - Y)^2 / (2 X)^3 dY (1) */
    double lever;   /* of (y_p - Y) / (2 X)^3 dY (1/m) */
    double shear;   /* of 1 / (2 X) dY (1) */
    double top;     /* X at y_p (m) */
} beam;

static void add_to_beam(beam *sums, const profile_point *point, double weight) {
    const double dy = weight * point->y_rate;
    const double chord = 2.0 * point->x;
    const double arm = sums->y_p - point->y;
    const double stiff = dy / (chord * chord * chord);
    sums->bending += arm * arm * stiff;
    sums->lever += arm * stiff;
    sums->shear += dy / chord;
}

enum part { INVOLUTE, FILLET };

static profile_point profile_at(const gmi_tooth *tooth, enum part part, double parameter) {
    return part == INVOLUTE ? involute_point(tooth, parameter) : fillet_point(tooth, parameter);
}

/* Adds the part between two values of its parameter, signed. */
static void integrate(const gmi_tooth *tooth, enum part part, double from, double to, beam *sums) {
    const double half = 0.5 * (to - from) / (double)PANELS;
    for (int panel = 0; panel < PANELS; ++panel) {
        const double middle = from + half * (double)(2 * panel + 1);
        for (int k = 0; k < 2 * GAUSS_HALF; ++k) {
            const double place = k < GAUSS_HALF ? gauss_place[k] : -gauss_place[k - GAUSS_HALF];
            const profile_point point = profile_at(tooth, part, middle + half * place);
            add_to_beam(sums, &point, half * gauss_weight[k % GAUSS_HALF]);
        }
    }
}

/* Parameter of the part at which Y = y, between two values; Y grows from `below` to `above`. */
static double parameter_at(const gmi_tooth *tooth, enum part part, double y, double below,
                           double above) {
    double parameter = 0.5 * (below + above);
    for (int k = 0; k < BISECTIONS; ++k) {
        const profile_point point = profile_at(tooth, part, parameter);
        const double miss = y - point.y;
        if (miss > 0.0) {
            below = parameter;
        } else {
            above = parameter;
        }

        /* Newton, as long as it stays between the bounds; else halve. */
        const double next = parameter + miss / point.y_rate;
        const double low = fmin(below, above), high = fmax(below, above);
        if (next == parameter) {
            break;
        }
        parameter = next > low && next < high ? next : 0.5 * (below + above);
    }
    return parameter;
}

/* Sums of the beam from the foot up to y_p, where the line of action meets the centre line: on the involute, on the fillet,
 * or below the root. */
static void integrate_beam(const gmi_tooth *tooth, double roll_length, beam *sums) {
    const double begin = tooth->fillet_begin;
    const double end_of_involute = tooth->fillet_roll_length;
    const double joint_y = involute_point(tooth, end_of_involute).y;
    if (sums->y_p >= joint_y) {
        /*
         * The line of action comes from above y_p, so the point at y_p has a smaller roll length. Where the load leans the
         * other way, near the base circle, that holds of the load that leans as much this way, which has the same y_p.
         */
        const double mirrored = 2.0 * tooth->base_radius * tooth->base_half_thickness - roll_length;
        const double above = tooth->base_radius > 0.0 ? fmax(roll_length, mirrored) : roll_length;
        const double top =
            parameter_at(tooth, INVOLUTE, sums->y_p, end_of_involute, fmax(above, end_of_involute));
        integrate(tooth, FILLET, tooth->foot_angle, begin, sums);
        integrate(tooth, INVOLUTE, end_of_involute, top, sums);
        sums->top = involute_point(tooth, top).x;
    } else if (sums->y_p >= tooth->root_y) {
        const double top = parameter_at(tooth, FILLET, sums->y_p, 0.5 * GMI_PI, begin);
        integrate(tooth, FILLET, tooth->foot_angle, top, sums);
        sums->top = fillet_point(tooth, top).x;
    } else {
        /* What lies between the root and y_p counts negative, with the thickness at the root. */
        integrate(tooth, FILLET, tooth->foot_angle, 0.5 * GMI_PI, sums);
        const double chord = 2.0 * tooth->root_half_thickness;
        const double length = sums->y_p - tooth->root_y; /* < 0 */
        const double stiff = length / (chord * chord * chord);
        sums->bending += stiff * length * length * (1.0 / 3.0);
        sums->lever += stiff * length * 0.5;
        sums->shear += length / chord;
        sums->top = tooth->root_half_thickness;
    }
}

int gmi_tooth_load_at(const gmi_tooth *tooth, double roll_length, gmi_tooth_load *load) {
    /* Where the line of action meets the centre line, and how far below the flank. */
    const double angle = roll_length / tooth->base_radius - tooth->base_half_thickness;
    if (!(fabs(angle) < 0.45 * GMI_PI)) {
        return GMI_TOOTH_POINTED;
    }
    const double tangent = tan(angle);
    load->angle = angle;
    load->y = tooth->base_radius / cos(angle);
    load->depth = roll_length - tooth->base_radius * tangent;
    if (!(load->depth > 0.0)) {
        return GMI_TOOTH_POINTED;
    }

    beam sums = {load->y, 0.0, 0.0, 0.0, 0.0};
    integrate_beam(tooth, roll_length, &sums);

    /* Bending, and shear with pressure. */
    const double nu = tooth->poisson_ratio;
    const double square = tangent * tangent;
    const double k = (1.0 - nu * nu) / (tooth->youngs_modulus * (1.0 + square));
    const double shear = 2.4 / (1.0 - nu) + square;
    const double in_tooth = 12.0 * sums.bending + shear * sums.shear;

    /* The foundation. */
    const double chord = tooth->foot_chord;
    const double arm = (load->y - tooth->foot_y) / chord;
    const double turn = 18.0 / GMI_PI, coupling = 2.0 * (1.0 - 2.0 * nu) / (1.0 - nu);
    const double push = 4.8 / GMI_PI, lean = (1.0 - nu) / 2.4;
    const double in_foundation = turn * arm * arm + coupling * arm + push * (1.0 + lean * square);
    load->bending = k * in_tooth;
    load->foundation = k * in_foundation;

    /* Slope: dy_p/d alpha' = y_p tan(alpha'), and the upper ends of the integrals move with y_p. */
    const double y_rate = load->y * tangent;
    const double square_rate = 2.0 * tangent * (1.0 + square);
    const double tooth_rate =
        24.0 * sums.lever * y_rate + square_rate * sums.shear + shear * y_rate / (2.0 * sums.top);
    const double foundation_rate =
        (2.0 * turn * arm + coupling) * y_rate / chord + push * lean * square_rate;
    const double by_angle =
        k * (tooth_rate + foundation_rate - 2.0 * tangent * (in_tooth + in_foundation));
    load->slope = by_angle / tooth->base_radius;
    return GMI_TOOTH_FINE;
}
