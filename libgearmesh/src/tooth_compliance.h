/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Compliance of one tooth: bending, shear, pressure and the foundation, after Weber and Banaschek.
 */
#ifndef GEARMESH_TOOTH_COMPLIANCE_H
#define GEARMESH_TOOTH_COMPLIANCE_H

/* Why a tooth has no compliance. */
enum gmi_tooth_fault {
    GMI_TOOTH_FINE = 0,
    GMI_TOOTH_FILLET = 1,   /* the rounding of the rack's tip does not fit between its flanks */
    GMI_TOOTH_UNDERCUT = 2, /* the rack cuts the involute away at the base circle */
    GMI_TOOTH_FOOT = 3,     /* no point of the fillet has the tangent of the foot */
    GMI_TOOTH_CONTACT = 4,  /* the mate touches below the end of the fillet */
    GMI_TOOTH_POINTED = 5,  /* the contact lies beyond the tip of a pointed tooth */
    GMI_TOOTH_SPACE = 6     /* the rounding does not fit into the space of a ring */
};

/* What a tooth is made of: the virtual spur gear of the normal section. */
typedef struct gmi_tooth_params {
    double
        virtual_teeth; /* z_n = z / (cos(beta_b)^2 cos(beta)), a real number; < 0: a ring, whose radii and roll
                             lengths are below 0 as well */
    double normal_module;         /* m_n (m) */
    double normal_pressure_angle; /* alpha_n (rad) */
    double profile_shift;         /* x (1) */
    double normal_thickness;      /* s_n at the reference circle (m) */
    double rack_dedendum;         /* h_fP in modules */
    double rack_fillet_radius;    /* rho_fP in modules */
    double youngs_modulus;        /* E (N/m2) */
    double poisson_ratio;         /* nu */
} gmi_tooth_params;

/* The profile of the tooth. Lengths in m, angles in rad, all in the normal section. */
typedef struct gmi_tooth {
    double reference_radius, base_radius; /* r_n, r_bn */
    double base_half_thickness;           /* psi_n */
    double pressure_angle;                /* alpha_n */
    double half_pitch_angle;              /* pi / z_n */
    double rounding_center; /* y_c of the rack's rounding, from the reference line, < 0 */
    double rounding_offset; /* e_c, from the middle of the space, >= 0 */
    double rounding_radius;
    double circle_x,
        circle_y; /* centre of a ring's rounding, from the centre line and the gear's centre */
    double fillet_begin;                /* theta where fillet and involute meet */
    double fillet_roll_length;          /* rho_n where fillet and involute meet */
    double foot_angle;                  /* theta of its tangent: 30 degrees, 60 of a ring */
    double foot_y;                      /* y_f, along the centre line from the gear's centre */
    double foot_chord;                  /* S, whole thickness there */
    double root_y, root_half_thickness; /* end of the fillet on the root circle */
    double youngs_modulus, poisson_ratio;
} gmi_tooth;

/* Derives the profile; enum gmi_tooth_fault. Needs parameters that are finite and > 0 where they are lengths. */
int gmi_tooth_init(gmi_tooth *tooth, const gmi_tooth_params *params);

/* The state of a tooth that is loaded at the normal roll length rho_n. */
typedef struct gmi_tooth_load {
    double angle;      /* alpha', of the load to the normal of the centre line (rad) */
    double y;          /* y_p, where the line of action meets the centre line (m) */
    double depth;      /* t, from the flank to that point along the line of action (m) */
    double bending;    /* c_tooth (m per N/m) */
    double foundation; /* c_found (m per N/m) */
    double slope;      /* of their sum by rho_n (1 per N/m) */
} gmi_tooth_load;

/* enum gmi_tooth_fault: GMI_TOOTH_FINE, GMI_TOOTH_POINTED. Costs two integrals of 64 points each. */
int gmi_tooth_load_at(const gmi_tooth *tooth, double roll_length, gmi_tooth_load *load);

#endif
