/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Flanks of a production: amounts that scatter from tooth to tooth about a mean. docs/flank-quality.md says how.
 */

#include "generate_scatter.h"

#include <math.h>
#include <string.h>

#include "files/io_error.h"
#include "quality/run_out.h"
#include "shared.h"
#include "spaces.h"
#include "waves.h"

void gm_flank_scatter_default(gm_flank_scatter *scatter) {
    if (scatter != NULL) {
        memset(scatter, 0, sizeof *scatter);
        scatter->profile.wave_count = scatter->helix.wave_count = (gm_scatter_uniform){1.0, 3.0};
        scatter->foot_end = 0.35;
        scatter->tip_start = 0.8;
    }
}

void gm_flank_scatter_paper(gm_flank_scatter *scatter) {
    gm_flank_scatter_default(scatter);
    if (scatter != NULL) {
        scatter->profile.slope = (gm_scatter_normal){0.0, 1e-6};
        scatter->profile.crowning = (gm_scatter_normal){1e-6, 0.3e-6};
        scatter->profile.wave = (gm_scatter_uniform){0.2e-6, 0.6e-6};
        scatter->helix.slope = (gm_scatter_normal){0.0, 2e-6};
        scatter->helix.crowning = (gm_scatter_normal){3e-6, 0.9e-6};
        scatter->helix.wave = (gm_scatter_uniform){0.2e-6, 0.6e-6};
        scatter->foot = (gm_scatter_normal){0.0, 6e-6};
        scatter->tip_relief = (gm_scatter_normal){4e-6, 0.0};
        scatter->roughness = 0.2e-6;
        scatter->pitch = 1e-6;
        scatter->eccentricity = 8e-6;
    }
}

/* ---------------------------------------------------------------------------------------------
 * Checks
 * ------------------------------------------------------------------------------------------- */

static int fail(const gmi_generator *make, const char *name, const char *right) {
    return gmi_error_set(make->error, GM_IO_ERR_OPTION, 0, "%s: must be %s", name, right);
}

static int is_size(double value) {
    return value >= 0.0 && value <= GMI_LARGEST_AMOUNT; /* false for NaN */
}

static int is_normal(const gm_scatter_normal *amount) {
    return fabs(amount->mean) <= GMI_LARGEST_AMOUNT && is_size(amount->deviation);
}

static int is_range(const gm_scatter_uniform *sizes) {
    return is_size(sizes->low) && is_size(sizes->high) && sizes->low <= sizes->high;
}

static int check_trace(const gmi_generator *make, const char *name, const gm_trace_scatter *trace,
                       int nodes) {
    const gm_scatter_uniform *count = &trace->wave_count;
    if (!is_normal(&trace->slope) || !is_normal(&trace->crowning)) {
        return fail(make, name,
                    "slope and crowning of at most 10 mm, with standard deviations not below 0");
    }
    if (!is_range(&trace->wave)) {
        return fail(make, name, "amplitudes of waves from low to high, from 0 to 10 mm");
    }
    if (!(count->low >= 0.0 && count->low <= count->high && isfinite(count->high))) {
        return fail(make, name, "numbers of waves from low to high, not below 0");
    }

    /* A wave of no amplitude needs no nodes. */
    if (trace->wave.high > 0.0 && GMI_NODES_PER_WAVE * count->high > nodes - 1) {
        return gmi_error_set(make->error, GM_IO_ERR_OPTION, 0,
                             "%s: must have %d nodes per wave (got too many waves for %d nodes)",
                             name, GMI_NODES_PER_WAVE, nodes);
    }
    return GM_IO_OK;
}

static int check_ends(const gmi_generator *make) {
    const gm_flank_scatter *scatter = make->options->scatter;
    if (!is_normal(&scatter->foot) || !(scatter->foot_end > 0.0 && scatter->foot_end <= 1.0)) {
        return fail(make, "foot", "at most 10 mm, with an end above 0 and not above 1");
    }
    if (!is_normal(&scatter->tip_relief) ||
        !(scatter->tip_start >= 0.0 && scatter->tip_start < 1.0)) {
        return fail(make, "tip relief", "at most 10 mm, with a start from 0 to below 1");
    }
    return GM_IO_OK;
}

int gmi_scatter_check(const gmi_generator *make) {
    const gm_flank_scatter *scatter = make->options->scatter;
    if (make->options->quality_class != 0) {
        return gmi_error_set(
            make->error, GM_IO_ERR_OPTION, 0,
            "flanks: must be of a class or have a scatter (got class %d and a scatter)",
            make->options->quality_class);
    }

    int status = check_trace(make, "profile", &scatter->profile, make->options->profile_nodes);
    if (status == GM_IO_OK) {
        status = check_trace(make, "helix", &scatter->helix, make->options->face_nodes);
    }
    if (status == GM_IO_OK) {
        status = check_ends(make);
    }
    if (status == GM_IO_OK && !(is_size(scatter->roughness) && is_size(scatter->pitch) &&
                                is_size(scatter->eccentricity))) {
        status = fail(make, "roughness, pitch, eccentricity", "from 0 to 10 mm");
    }
    return status;
}

/* ---------------------------------------------------------------------------------------------
 * Pitch
 * ------------------------------------------------------------------------------------------- */

static void draw_errors(uint64_t *random, double *error, int teeth) {
    double mean = 0.0;
    for (int i = 0; i < teeth; ++i) {
        error[i] = gmi_random_normal(random, 0.0, 1.0);
        mean += error[i] / teeth;
    }
    for (int i = 0; i < teeth; ++i) {
        error[i] -= mean;
    }
}

/*
 * A gear whose axis is off by e: along the normals of its flanks, which stand at an angle to the radius of the
 * space between them, that is e times a sine of the rotation on each side, and a ball in the space goes with the axis.
 */
static void fill_pitch(gmi_generator *make) {
    const gm_flank_scatter *scatter = make->options->scatter;
    const gm_gear *gear = make->gear;
    const double arc =
        gear->reference_radius / gear->base_radius; /* of a length along the normal */
    const double sine = gmi_ball_sine(make->pair, gear);
    const double phase = gmi_random_uniform(&make->random, 0.0, 1.0);
    gmi_spaces spaces = gmi_spaces_begin(gear->teeth, make->work, phase);
    draw_errors(&make->random, spaces.error, gear->teeth);

    /* Along the arc; the radial part moves both flanks of a space to the same side of it, the tangential one ahead. */
    spaces.factor = arc * scatter->pitch;
    spaces.radial = arc * scatter->eccentricity * sine;
    spaces.tangential = arc * scatter->eccentricity * sqrt(1.0 - sine * sine);
    gmi_spaces_to_pitch(&spaces, make->pitch, gear, make->wheel);
}

/* ---------------------------------------------------------------------------------------------
 * Flanks
 * ------------------------------------------------------------------------------------------- */

static double draw_normal(uint64_t *random, const gm_scatter_normal *from) {
    return gmi_random_normal(random, from->mean, from->deviation);
}

static double draw_uniform(uint64_t *random, const gm_scatter_uniform *from) {
    return gmi_random_uniform(random, from->low, from->high);
}

/* Slope, crowning and wave. */
static void draw_trace(uint64_t *random, double *trace, int nodes, const gm_trace_scatter *from) {
    const double slope = draw_normal(random, &from->slope);
    const double crowning = draw_normal(random, &from->crowning);
    const double wave = draw_uniform(random, &from->wave);
    const double count = draw_uniform(random, &from->wave_count);
    const double phase = gmi_random_uniform(random, 0.0, 1.0);

    for (int node = 0; node < nodes; ++node) {
        const double t = (double)node / (nodes - 1);
        const double v = 2.0 * t - 1.0;
        trace[node] =
            0.5 * slope * v - crowning * v * v + wave * gmi_sine_of_turns(count * t + phase);
    }
}

/* What both ends of the profile have of their own. */
static void add_ends(uint64_t *random, double *profile, int nodes,
                     const gm_flank_scatter *scatter) {
    const double foot = draw_normal(random, &scatter->foot);
    const double relief = draw_normal(random, &scatter->tip_relief);
    for (int node = 0; node < nodes; ++node) {
        const double t2 = (double)node / (nodes - 1);
        if (t2 < scatter->foot_end) {
            profile[node] += foot * (1.0 - t2 / scatter->foot_end);
        }
        if (t2 > scatter->tip_start) {
            const double part = (t2 - scatter->tip_start) / (1.0 - scatter->tip_start);
            profile[node] -= relief * part * part;
        }
    }
}

static void fill_flank(gmi_generator *make, const gm_deviation_set *set) {
    const gm_flank_scatter *scatter = make->options->scatter;
    const int face_nodes = make->options->face_nodes;
    const int profile_nodes = make->options->profile_nodes;
    double *profile = make->work;
    double *helix = make->work + GMI_MOST_NODES;
    draw_trace(&make->random, profile, profile_nodes, &scatter->profile);
    draw_trace(&make->random, helix, face_nodes, &scatter->helix);
    add_ends(&make->random, profile, profile_nodes, scatter);
    gmi_waves_fill(make, set);

    for (int node = 0; node < face_nodes * profile_nodes; ++node) {
        const double rough = gmi_random_normal(&make->random, 0.0, scatter->roughness);
        set->values[node] = gmi_rounded(set->values[node] + helix[node / profile_nodes] +
                                        profile[node % profile_nodes] + rough);
    }
}

void gmi_scatter_fill(gmi_generator *make) {
    fill_pitch(make);
    for (int flank = 0; flank < make->deviations->set_count; ++flank) {
        fill_flank(make, &make->deviations->sets[flank]);
    }
}
