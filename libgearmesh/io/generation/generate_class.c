/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Flanks that measure to a class: random pitch, profile and helix deviations whose worst values are led to a
 * stated share of each tolerance. docs/flank-quality.md says how.
 */

#include "generate_class.h"

#include <math.h>

#include "files/io_error.h"
#include "quality/run_out.h"
#include "quality/trace_values.h"
#include "shared.h"
#include "spaces.h"
#include "waves.h"

/* Limits of the share. */
static const double least_share = 0.8;
static const double most_share = 0.99;

/* Draws until the wanted values agree with each other; one is the rule. */
#define MOST_DRAWS 50

/* Halvings until two doubles are neighbours, from any reasonable interval. */
#define HALVINGS 80

typedef struct generator {
    gmi_generator *common;
    uint64_t *random;
    gmi_range range[2];              /* of profile and helix */
    double target[GM_QUALITY_KINDS]; /* wanted worst values (m) */
} generator;

static int fail_contradiction(const generator *make, const char *what) {
    return gmi_error_set(make->common->error, GM_IO_ERR_OPTION, 0,
                         "%s: must be more teeth, or smaller or other waves", what);
}

static double draw(generator *make, double low, double high) {
    return gmi_random_uniform(make->random, low, high);
}

static double draw_sign(generator *make) {
    return gmi_random_bits(make->random) >> 63 ? 1.0 : -1.0;
}

/* Uniform in 0 .. count - 1, but for a share of count / 2^64. */
static int draw_below(generator *make, int count) {
    return (int)(gmi_random_bits(make->random) % (uint64_t)count);
}

/* ---------------------------------------------------------------------------------------------
 * Pitch
 *
 * Radial amplitude from the run-out, errors uniform. For each tangential amplitude t one factor s of the errors gives
 * the single pitch deviation; then t is found that gives the cumulative one.
 * ------------------------------------------------------------------------------------------- */

typedef struct positions {
    gmi_spaces spaces;
    double single; /* wanted f_p */
    double total;  /* wanted F_p */
} positions;

/* Largest s that keeps all pitches of a side within f_p; negative = even 0 does not. */
static double largest_factor(const positions *of, double side) {
    const gmi_spaces *spaces = &of->spaces;
    double least = (double)INFINITY;
    for (int i = 0; i < spaces->teeth; ++i) {
        const int before = i > 0 ? i - 1 : spaces->teeth - 1;
        const double steady =
            gmi_spaces_first_order(spaces, i, side) - gmi_spaces_first_order(spaces, before, side);
        const double change = spaces->error[i] - spaces->error[before];

        const double room = of->single - (change > 0.0 ? steady : -steady);
        if (fabs(steady) > of->single) {
            return -1.0;
        }
        if (change != 0.0 && room / fabs(change) < least) {
            least = room / fabs(change);
        }
    }
    return least;
}

static double total_of_side(const gmi_spaces *of, double side) {
    double low = (double)INFINITY;
    double high = -(double)INFINITY;
    for (int i = 0; i < of->teeth; ++i) {
        const double place = gmi_spaces_first_order(of, i, side) + of->factor * of->error[i];
        low = place < low ? place : low;
        high = place > high ? place : high;
    }
    return high - low;
}

/* F_p with this t and the s that belongs to it; infinite if f_p cannot be kept. */
static double total_with(positions *of, double tangential) {
    of->spaces.tangential = tangential;
    const double factor[2] = {largest_factor(of, 1.0), largest_factor(of, -1.0)};
    of->spaces.factor = factor[0] < factor[1] ? factor[0] : factor[1];
    if (of->spaces.factor < 0.0) {
        return (double)INFINITY;
    }
    const double total[2] = {total_of_side(&of->spaces, 1.0), total_of_side(&of->spaces, -1.0)};
    return total[0] > total[1] ? total[0] : total[1];
}

/* Finds t and s; 0 = there are none for these errors. */
static int solve_positions(positions *of) {
    double low = 0.0;
    double high = of->total;
    if (total_with(of, low) > of->total) {
        return 0;
    }

    for (int i = 0; i < HALVINGS; ++i) {
        const double middle = 0.5 * (low + high);
        if (total_with(of, middle) <= of->total) {
            low = middle;
        } else {
            high = middle;
        }
    }
    /* Else the single pitch, not the cumulative one, was what ended the search. */
    return total_with(of, low) > of->total * (1.0 - 1e-9);
}

static double range_of(const double *values, int count) {
    double low = values[0];
    double high = values[0];
    for (int i = 1; i < count; ++i) {
        low = values[i] < low ? values[i] : low;
        high = values[i] > high ? values[i] : high;
    }
    return high - low;
}

static positions draw_positions(generator *make) {
    const gm_gear *gear = make->common->gear;
    const double phase = draw(make, 0.0, 1.0);
    positions of = {.spaces = gmi_spaces_begin(gear->teeth, make->common->work, phase),
                    .single = make->target[GM_QUALITY_SINGLE_PITCH],
                    .total = make->target[GM_QUALITY_TOTAL_PITCH]};

    for (int i = 0; i < gear->teeth; ++i) {
        of.spaces.error[i] = draw(make, -1.0, 1.0);
    }
    /* What a radial shift is to each flank, as an arc. */
    const double arc =
        gmi_ball_sine(make->common->pair, gear) / (gear->base_radius / gear->reference_radius);
    of.spaces.radial =
        arc * make->target[GM_QUALITY_RUN_OUT] / range_of(of.spaces.cosine, gear->teeth);
    return of;
}

static int generate_pitch(generator *make) {
    for (int i = 0; i < MOST_DRAWS; ++i) {
        positions of = draw_positions(make);
        if (solve_positions(&of)) {
            gmi_spaces_to_pitch(&of.spaces, make->common->pitch, make->common->gear,
                                make->common->wheel);
            return GM_IO_OK;
        }
    }
    return fail_contradiction(make, "run-out, single and cumulative pitch of this class exclude "
                                    "each other for this number of teeth");
}

/* ---------------------------------------------------------------------------------------------
 * One trace: wave + slope * (t - 1/2) + form * shape
 * ------------------------------------------------------------------------------------------- */

/* What a trace is to be: one flank of the gear has the worst slope, others the worst form and the worst total. */
enum role { ORDINARY, WORST_SLOPE, WORST_FORM, WORST_TOTAL };

typedef struct trace {
    int nodes;
    const gmi_range *range;
    double *wave;  /* [nodes] given */
    double *shape; /* [nodes] without slope, its form deviation is 1 */
    double *sum;   /* [nodes] */
    gmi_trace_values limit;
} trace;

/* How much of what. */
typedef struct mixture {
    double slope;
    double form;
} mixture;

static gmi_trace_values values_of(const trace *of, mixture amounts) {
    for (int node = 0; node < of->nodes; ++node) {
        const double t = (double)node / (of->nodes - 1);
        of->sum[node] = of->wave[node] + amounts.slope * (t - 0.5) + amounts.form * of->shape[node];
    }
    return gmi_trace_evaluate(of->sum, of->nodes, of->range);
}

static int fits(const trace *of, mixture amounts) {
    const double slack = 1.0 + 1e-12; /* limits are to be reached */
    const gmi_trace_values values = values_of(of, amounts);
    return fabs(values.slope) <= of->limit.slope * slack && values.form <= of->limit.form * slack &&
           values.total <= of->limit.total * slack;
}

static mixture between(mixture from, mixture to, double part) {
    const mixture result = {from.slope + part * (to.slope - from.slope),
                            from.form + part * (to.form - from.form)};
    return result;
}

/* The last mixture on the way from one that fits to another one; all values are convex on the way. */
static mixture as_far_as_fits(const trace *of, mixture from, mixture to) {
    if (fits(of, to)) {
        return to;
    }

    double low = 0.0;
    double high = 1.0;
    for (int i = 0; i < HALVINGS; ++i) {
        const double middle = 0.5 * (low + high);
        if (fits(of, between(from, to, middle))) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return between(from, to, low);
}

/* Random shape: a crowning or hollow, three waves, roughness; then its slope is taken off and its size made 1. */
static void draw_shape(generator *make, const trace *of) {
    const double crowning = draw_sign(make) * draw(make, 0.5, 1.0);
    double size[3];
    double phase[3];
    for (int k = 0; k < 3; ++k) {
        size[k] = draw(make, 0.0, 0.4);
        phase[k] = draw(make, 0.0, 1.0);
    }

    for (int node = 0; node < of->nodes; ++node) {
        const double t = (double)node / (of->nodes - 1);
        of->shape[node] = crowning * 4.0 * t * (1.0 - t) + draw(make, -0.1, 0.1);
        for (int k = 0; k < 3; ++k) {
            of->shape[node] += size[k] * gmi_sine_of_turns((k + 1) * t + phase[k]);
        }
    }

    const gmi_line mean = gmi_trace_mean_line(of->shape, of->nodes, of->range);
    const double form = gmi_trace_evaluate(of->shape, of->nodes, of->range).form;
    for (int node = 0; node < of->nodes; ++node) {
        const double t = (double)node / (of->nodes - 1);
        of->shape[node] = (of->shape[node] - mean.level - mean.gradient * t) / form;
    }
}

/* Amount of shape whose form deviation is the limit; the slope plays no part. */
static double full_form(const trace *of) {
    double low = 0.0;
    double high = of->limit.form;
    while (values_of(of, (mixture){0.0, high}).form < of->limit.form) {
        high *= 2.0;
    }

    /* Then halve between an amount that is within the limit and one that is beyond. */
    for (int i = 0; i < HALVINGS; ++i) {
        const double middle = 0.5 * (low + high);
        if (values_of(of, (mixture){0.0, middle}).form <= of->limit.form) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

/* A mixture for a role with the shape drawn; 0 = this shape does not allow it. */
static int mix(generator *make, const trace *of, enum role role, mixture *result) {
    const double wave_slope = values_of(of, (mixture){0.0, 0.0}).slope;
    const mixture flat = {-wave_slope, 0.0};
    const double sign = draw_sign(make);
    mixture full = {sign * of->limit.slope - wave_slope, full_form(of)};

    /* How much of slope and form an ordinary flank has. */
    const double part = draw(make, 0.3, 0.9);
    const mixture partial = {draw(make, -0.8, 0.8) * of->limit.slope, part * full.form};
    const mixture slope_only = {full.slope, 0.0};
    const mixture form_only = {flat.slope, full.form};

    /* From a mixture that is sure to fit towards one that is too large, as far as the limits allow. */
    switch (role) {
    case WORST_SLOPE:
        *result = as_far_as_fits(of, slope_only, (mixture){full.slope, partial.form});
        return fits(of, slope_only);
    case WORST_FORM:
        *result = as_far_as_fits(of, form_only, (mixture){partial.slope, full.form});
        return fits(of, form_only);
    case WORST_TOTAL:
        *result = as_far_as_fits(of, flat, full);
        return fits(of, flat) && values_of(of, full).total >= of->limit.total;
    default:
        *result = as_far_as_fits(of, flat, partial);
        return fits(of, flat);
    }
}

static double middle_of(const double *values, int nodes) {
    return 0.5 * (values[(nodes - 1) / 2] + values[nodes / 2]);
}

/* Draws shapes until one allows the role; 0 = none did. */
static int draw_mixture(generator *make, const trace *of, enum role role, mixture *amounts) {
    const mixture none = {0.0, 0.0};
    if (values_of(of, none).form > of->limit.form) {
        return 0;
    }
    for (int i = 0; i < MOST_DRAWS; ++i) {
        draw_shape(make, of);
        if (mix(make, of, role, amounts)) {
            return 1;
        }
    }
    return 0;
}

/* What is to be added to the wave: 0 in the middle, where the pitch is measured. Left in trace.sum. */
static int make_trace(generator *make, const trace *of, enum role role) {
    mixture amounts = {0.0, 0.0};
    if (!draw_mixture(make, of, role, &amounts)) {
        return fail_contradiction(make, "the waves use up a tolerance of profile or helix");
    }
    const double middle = amounts.form * middle_of(of->shape, of->nodes);
    for (int node = 0; node < of->nodes; ++node) {
        const double t = (double)node / (of->nodes - 1);
        of->sum[node] = amounts.slope * (t - 0.5) + amounts.form * of->shape[node] - middle;
    }
    return GM_IO_OK;
}

/* ---------------------------------------------------------------------------------------------
 * Flanks
 * ------------------------------------------------------------------------------------------- */

/* Which flanks have the worst values, of profile and helix: three different ones each. */
typedef struct roles {
    int flank[2][3];
} roles;

static void draw_roles(generator *make, roles *of) {
    const int count = 2 * make->common->gear->teeth;
    for (int axis = 0; axis < 2; ++axis) {
        int *flank = of->flank[axis];
        flank[0] = draw_below(make, count);
        flank[1] = (flank[0] + 1 + draw_below(make, count - 1)) % count;
        do {
            flank[2] = draw_below(make, count);
        } while (flank[2] == flank[0] || flank[2] == flank[1]);
    }
}

static enum role role_of(const roles *of, int axis, int flank) {
    static const enum role role[3] = {WORST_SLOPE, WORST_FORM, WORST_TOTAL};
    for (int i = 0; i < 3; ++i) {
        if (of->flank[axis][i] == flank) {
            return role[i];
        }
    }
    return ORDINARY;
}

/* Axis 0 = profile, 1 = helix. */
static trace trace_of(const generator *make, int axis) {
    const gm_generate_options *options = make->common->options;
    const int kind = axis == 0 ? GM_QUALITY_PROFILE_SLOPE : GM_QUALITY_HELIX_SLOPE;
    double *work = make->common->work + 3 * (size_t)axis * GMI_MOST_NODES;
    const trace result = {
        .nodes = axis == 0 ? options->profile_nodes : options->face_nodes,
        .range = &make->range[axis],
        .wave = work,
        .shape = work + GMI_MOST_NODES,
        .sum = work + 2 * (size_t)GMI_MOST_NODES,
        .limit = {make->target[kind], make->target[kind + 1], make->target[kind + 2]}};
    return result;
}

static int generate_flank(generator *make, const roles *parts, int flank) {
    const int face_nodes = make->common->options->face_nodes;
    const int profile_nodes = make->common->options->profile_nodes;
    const double factor = make->common->pair->normal_to_transverse;
    const gm_deviation_set *set = &make->common->deviations->sets[flank];
    double *table = set->values;
    const trace profile = trace_of(make, 0);
    const trace helix = trace_of(make, 1);

    gmi_waves_fill(make->common, set);
    gmi_profile_trace(profile.wave, table, face_nodes, profile_nodes, factor);
    gmi_helix_trace(helix.wave, table, face_nodes, profile_nodes, factor);

    int status = make_trace(make, &profile, role_of(parts, 0, flank));
    if (status == GM_IO_OK) {
        status = make_trace(make, &helix, role_of(parts, 1, flank));
    }
    for (int node = 0; status == GM_IO_OK && node < face_nodes * profile_nodes; ++node) {
        const double added = helix.sum[node / profile_nodes] + profile.sum[node % profile_nodes];
        table[node] = gmi_rounded(table[node] + added / factor);
    }
    return status;
}

static int generate_flanks(generator *make) {
    roles of;
    draw_roles(make, &of);
    int status = GM_IO_OK;
    for (int flank = 0; status == GM_IO_OK && flank < make->common->deviations->set_count;
         ++flank) {
        status = generate_flank(make, &of, flank);
    }
    return status;
}

/* ---------------------------------------------------------------------------------------------
 * The calls
 * ------------------------------------------------------------------------------------------- */

int gmi_class_check(const gmi_generator *make) {
    const gm_generate_options *options = make->options;
    if (options->quality_class < GM_QUALITY_BEST_CLASS ||
        options->quality_class > GM_QUALITY_WORST_CLASS) {
        return gmi_error_set(make->error, GM_IO_ERR_OPTION, 0,
                             "class: must be from %d to %d (got %d)", GM_QUALITY_BEST_CLASS,
                             GM_QUALITY_WORST_CLASS, options->quality_class);
    }
    if (!(options->share >= least_share && options->share <= most_share)) {
        return gmi_error_set(make->error, GM_IO_ERR_OPTION, 0,
                             "the share of the tolerances must be from 0.8 to 0.99");
    }
    return GM_IO_OK;
}

int gmi_class_fill(gmi_generator *common) {
    generator make = {.common = common, .random = &common->random};
    gm_quality_options ranges;
    gm_quality_options_default(&ranges);
    int status = gmi_trace_ranges(make.range, common->pair, common->gear, &ranges, common->error);

    /* The wanted worst values. */
    for (int kind = 0; kind < GM_QUALITY_KINDS; ++kind) {
        make.target[kind] =
            common->options->share *
            gm_quality_tolerance(common->pair, common->wheel, kind, common->options->quality_class);
    }

    if (status == GM_IO_OK) {
        status = generate_pitch(&make);
    }
    if (status == GM_IO_OK) {
        status = generate_flanks(&make);
    }
    return status;
}
