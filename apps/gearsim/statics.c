/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Loaded transmission error: at each pinion angle the position in which the flanks carry the mean load.
 */
#include "statics.h"
#include "interrupt.h"
#include "output.h"

#include <math.h>

/* Places of static_columns. */
enum column { PINION_ANGLE, TE, MESH_STIFFNESS, CONTACT_LENGTH, PAIRS, COLUMNS };

static const double two_pi = 6.283185307179586;

static int greatest_common_divisor(int a, int b) {
    while (b != 0) {
        const int rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

/* Tooth passes in the period: the hunting period is over when the first pair of teeth meets again. */
static double tooth_passes(const config *conf) {
    const int pinion = conf->gears.pinion_teeth;
    const int wheel = conf->gears.wheel_teeth;

    switch (conf->period) {
    case PERIOD_PINION:
        return pinion;
    case PERIOD_HUNTING:
        return (double)pinion * (wheel / greatest_common_divisor(pinion, wheel));
    case PERIOD_MESH:
    default:
        return 1.0;
    }
}

/* From a fraction of whole numbers, so that no error adds up along the period. */
static double pinion_angle(const config *conf, int position) {
    return two_pi * (tooth_passes(conf) * position) /
           ((double)conf->positions * conf->gears.pinion_teeth);
}

/* Where the position before was in equilibrium, and how it goes on from there. */
typedef struct course {
    double angle;  /* (rad) */
    double offset; /* (m), NaN = not known yet */
    double slope;  /* its derivative by the pinion angle (m/rad) */
} course;

static int write_position(const config *conf, const gearbox *gears, double angle, course *before,
                          output_file *output, int *status) {
    const gm_pair *pair = &gears->pair;
    const double guess = before->offset + before->slope * (angle - before->angle);
    gm_penetration mesh;
    double offset;

    *status = gm_static_equilibrium_near(pair, gears->pinion_flanks, gears->wheel_flanks, angle,
                                         conf->stiffness, conf->mean_load, guess, &offset, &mesh);
    if (*status != GM_OK) {
        return EXIT_RUN_FAILED;
    }
    before->angle = angle;
    before->offset = offset;
    before->slope = pair->pinion.base_radius +
                    pair->wheel.base_radius * mesh.d_pinion_angle / mesh.d_wheel_angle;

    /* Of the face width, summed over the pairs and both flanks. */
    const double touching = mesh.drive_contact + mesh.coast_contact;
    const double values[COLUMNS] = {
        [PINION_ANGLE] = angle,
        [TE] = -offset * 1e6,
        [MESH_STIFFNESS] = conf->stiffness * touching * 1e-6,
        [CONTACT_LENGTH] = touching * pair->face_width / cos(pair->base_helix_angle) * 1e3,
        [PAIRS] = mesh.drive_pairs + mesh.coast_pairs,
    };
    return output_row(output, values);
}

/* Why a position could not be written, as a message and in the file. */
static int fail(output_file *output, double angle, int status) {
    char why[256];

    if (status == GM_OK) {
        snprintf(why, sizeof why, "the disk took no more at a pinion angle of %.9g rad", angle);
    } else {
        snprintf(why, sizeof why, "no equilibrium at a pinion angle of %.9g rad: %s", angle,
                 gm_status_text(status));
    }
    fprintf(stderr, "gearsim: %s\n", why);
    output_close(output, why);
    return EXIT_RUN_FAILED;
}

static int interrupted(output_file *output, double angle) {
    char why[128];

    snprintf(why, sizeof why, "interrupted at a pinion angle of %.9g rad", angle);
    fprintf(stderr, "gearsim: %s\n", why);
    output_close(output, why);
    return EXIT_INTERRUPTED;
}

static int write_all(const config *conf, const gearbox *gears, output_file *output) {
    course before = {0.0, NAN, 0.0};

    for (int position = 0; position < conf->positions; ++position) {
        const double angle = pinion_angle(conf, position);
        int status;

        if (interrupt_requested()) {
            return interrupted(output, angle);
        }
        if (write_position(conf, gears, angle, &before, output, &status) != 0) {
            return fail(output, angle, status);
        }
    }
    return output_close(output, NULL);
}

int statics_run(const config *conf, const gearbox *gears) {
    int exit_code = 0;

    interrupt_watch();
    output_file *const output = output_open(conf, static_columns, static_column_count, &exit_code);
    if (output != NULL) {
        exit_code = write_all(conf, gears, output);
    }
    interrupt_unwatch();
    return exit_code;
}
