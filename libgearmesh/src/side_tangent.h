/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The force of a side before it is a wrench: its weights, what it depends on, and how it moves with all of that. */
#ifndef GEARMESH_SIDE_TANGENT_H
#define GEARMESH_SIDE_TANGENT_H

#include "internal.h"
#include "line.h"
#include "meshing.h"

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

#endif
