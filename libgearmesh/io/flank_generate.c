/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Flanks that measure to a class: random pitch, profile and helix deviations whose worst values are led to a
 * stated share of each tolerance. docs/flank-quality.md says how.
 *
 * Same flanks on every machine: integers, + - * / and sqrt only, and a sine of its own, as those of the C
 * libraries differ in the last bit. What the pair derives with them is wiped out by rounding to 1e-10 m.
 */

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "flank_slot.h"
#include "flank_trace.h"
#include "io_error.h"

static const double pi = 3.14159265358979323846;

/* Limits of the options. */
enum {
    LEAST_NODES = 9,
    MOST_NODES = 1000,
    MOST_WAVES = 100,
    MOST_ORDER = 1000000,
    NODES_PER_WAVE = 4
};
static const double least_share = 0.8;
static const double most_share = 0.99;

/* Draws until the wanted values agree with each other; one is the rule. */
#define MOST_DRAWS 50

/* Halvings until two doubles are neighbours, from any reasonable interval. */
#define HALVINGS 80

typedef struct generator {
    gm_deviations *deviations;
    gm_pitch *pitch;
    const gm_pair *pair;
    const gm_gear *gear;
    int wheel;
    const gm_generate_options *options;
    gmi_range range[2];              /* of profile and helix */
    double target[GM_QUALITY_KINDS]; /* wanted worst values (m) */
    uint64_t random;                 /* state of the random numbers */
    double *wave_phase;              /* [2 * wave_count] turns, of both sides */
    double *work;                    /* room for the traces of a flank, or for the pitch */
    gm_io_error *error;
} generator;

void gm_generate_options_default(gm_generate_options *options) {
    if (options != NULL) {
        memset(options, 0, sizeof *options);
        options->seed = 1;
        options->share = 0.95;
        options->face_nodes = 21;
        options->profile_nodes = 31;
        options->waves = NULL;
    }
}

static int fail_memory(gm_io_error *error) {
    return gmi_error_set(error, GM_IO_ERR_MEMORY, 0, "out of memory");
}

static int fail_contradiction(const generator *make, const char *what) {
    return gmi_error_set(make->error, GM_IO_ERR_OPTION, 0,
                         "%s; more teeth, or smaller or other waves, are right", what);
}

/* ---------------------------------------------------------------------------------------------
 * Random numbers and sine
 * ------------------------------------------------------------------------------------------- */

/* splitmix64 (Steele, Lea, Flood 2014). */
static uint64_t draw_bits(generator *make) {
    make->random += UINT64_C(0x9E3779B97F4A7C15);
    uint64_t bits = make->random;
    bits = (bits ^ (bits >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    bits = (bits ^ (bits >> 27)) * UINT64_C(0x94D049BB133111EB);
    return bits ^ (bits >> 31);
}

/* Uniform in [low, high). */
static double draw(generator *make, double low, double high) {
    const double unit = (double)(draw_bits(make) >> 11) * (1.0 / 9007199254740992.0);
    return low + (high - low) * unit;
}

static double draw_sign(generator *make) {
    return draw_bits(make) >> 63 ? 1.0 : -1.0;
}

/* Uniform in 0 .. count - 1, as good as it need be. */
static int draw_below(generator *make, int count) {
    return (int)(draw_bits(make) % (uint64_t)count);
}

/* sin(2 pi turns), to 1e-15. */
static double sine_of_turns(double turns) {
    double part = turns - floor(turns + 0.5);
    if (part > 0.25) {
        part = 0.5 - part;
    } else if (part < -0.25) {
        part = -0.5 - part;
    }
    const double angle = 2.0 * pi * part;
    const double square = angle * angle;
    /* The series up to the power 21; the next term is below 1e-18 at pi / 2. */
    double sum = 0.0;
    for (int power = 21; power >= 3; power -= 2) {
        sum = -(square / ((double)power * (power - 1))) * (1.0 + sum);
    }
    return angle * (1.0 + sum);
}

/* To 1e-10 m: plain numbers in a file, and no trace of the last bit of a libm. */
static double rounded(double value) {
    return floor(value * 1e10 + 0.5) / 1e10;
}

/* ---------------------------------------------------------------------------------------------
 * Pitch
 *
 * A space is moved radially by y and, in the positive direction of rotation, by x (arc at the reference
 * circle); both of its flanks follow. y is a pure first order, which alone makes the run-out; x is a first
 * order with another amplitude t, and independent errors with a factor s. For each t one s gives the single
 * pitch deviation; then t is found that gives the cumulative one.
 * ------------------------------------------------------------------------------------------- */

typedef struct positions {
    int teeth;
    double *cosine; /* [teeth] first order */
    double *sine;
    double *error;  /* [teeth] independent errors, of size 1 */
    double radial;  /* amplitude of what y is to each flank, as an arc */
    double single;  /* wanted f_p */
    double total;   /* wanted F_p */
    double factor;  /* s */
    double tangent; /* t */
} positions;

/* Place of a flank without the independent errors; side = 1 or -1, as y moves it ahead or back. */
static double first_order(const positions *of, int space, double side, double tangent) {
    return side * of->radial * of->cosine[space] - tangent * of->sine[space];
}

/* Largest s that keeps all pitches of a side within f_p; negative = even 0 does not. */
static double largest_factor(const positions *of, double side, double tangent) {
    double least = (double)INFINITY;
    for (int i = 0; i < of->teeth; i++) {
        const int before = i > 0 ? i - 1 : of->teeth - 1;
        const double steady =
            first_order(of, i, side, tangent) - first_order(of, before, side, tangent);
        const double change = of->error[i] - of->error[before];
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

static double total_of_side(const positions *of, double side) {
    double low = (double)INFINITY;
    double high = -(double)INFINITY;
    for (int i = 0; i < of->teeth; i++) {
        const double place = first_order(of, i, side, of->tangent) + of->factor * of->error[i];
        low = place < low ? place : low;
        high = place > high ? place : high;
    }
    return high - low;
}

/* F_p with this t and the s that belongs to it; infinite if f_p cannot be kept. */
static double total_with(positions *of, double tangent) {
    const double factor[2] = {largest_factor(of, 1.0, tangent), largest_factor(of, -1.0, tangent)};
    of->tangent = tangent;
    of->factor = factor[0] < factor[1] ? factor[0] : factor[1];
    if (of->factor < 0.0) {
        return (double)INFINITY;
    }
    const double total[2] = {total_of_side(of, 1.0), total_of_side(of, -1.0)};
    return total[0] > total[1] ? total[0] : total[1];
}

/* Finds t and s; 0 = there are none for these errors. */
static int solve_positions(positions *of) {
    double low = 0.0;
    double high = of->total;
    if (total_with(of, low) > of->total) {
        return 0;
    }
    for (int i = 0; i < HALVINGS; i++) {
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
    for (int i = 1; i < count; i++) {
        low = values[i] < low ? values[i] : low;
        high = values[i] > high ? values[i] : high;
    }
    return high - low;
}

/* arc = what a radial shift is to each flank, as an arc. */
static void draw_positions(generator *make, positions *of, double arc) {
    const double phase = draw(make, 0.0, 1.0);
    for (int i = 0; i < of->teeth; i++) {
        const double turns = (double)i / of->teeth + phase;
        of->cosine[i] = sine_of_turns(turns + 0.25);
        of->sine[i] = sine_of_turns(turns);
        of->error[i] = draw(make, -1.0, 1.0);
    }
    of->radial = arc * make->target[GM_QUALITY_RUN_OUT] / range_of(of->cosine, of->teeth);
}

/* From places of spaces to material on their flanks. */
static void set_pitch(const generator *make, const positions *of, double cosine_of_angle) {
    const int teeth = of->teeth;
    const double ahead = make->wheel ? -1.0 : 1.0;
    for (int i = 0; i < teeth; i++) {
        const int neighbour = (i + (make->wheel ? teeth - 1 : 1)) % teeth;
        const double drive = first_order(of, i, ahead, of->tangent) + of->factor * of->error[i];
        const double coast = first_order(of, i, -ahead, of->tangent) + of->factor * of->error[i];
        make->pitch->drive[i] = rounded(ahead * cosine_of_angle * drive);
        make->pitch->coast[neighbour] = rounded(-ahead * cosine_of_angle * coast);
        make->pitch->drive_set[i] = make->pitch->coast_set[i] = 1;
    }
}

static int generate_pitch(generator *make) {
    const int teeth = make->gear->teeth;
    const double cosine = make->gear->base_radius / make->gear->reference_radius;
    positions of = {.teeth = teeth,
                    .cosine = make->work,
                    .sine = make->work + teeth,
                    .error = make->work + 2 * (size_t)teeth,
                    .single = make->target[GM_QUALITY_SINGLE_PITCH],
                    .total = make->target[GM_QUALITY_TOTAL_PITCH]};
    for (int i = 0; i < MOST_DRAWS; i++) {
        draw_positions(make, &of, gmi_ball_sine(make->pair, make->gear) / cosine);
        if (solve_positions(&of)) {
            set_pitch(make, &of, cosine);
            return GM_IO_OK;
        }
    }
    return fail_contradiction(make, "run-out, single and cumulative pitch of this class exclude "
                                    "each other for this number of teeth");
}

/* ---------------------------------------------------------------------------------------------
 * Waves
 * ------------------------------------------------------------------------------------------- */

/*
 * Turns of the gear at which a point of a flank comes into contact, less a constant and with the opposite
 * sign. Forward rotation moves the contact of pinion drive and wheel coast flanks to the tip, that of the
 * others to the root.
 */
static double contact_turns(const generator *make, int tooth, int side, double t1, double t2) {
    const gm_gear *gear = make->gear;
    const double rho =
        gear->start_roll_length + t2 * (gear->tip_roll_length - gear->start_roll_length);
    const double roll = (side == GM_DRIVE) == !make->wheel ? -rho : rho;
    return (double)tooth / gear->teeth +
           (roll + t1 * make->pair->twist) / (2.0 * pi * gear->base_radius);
}

/* Sum of all waves at the nodes of a flank, along the normal. */
static void fill_waves(const generator *make, double *table, int tooth, int side) {
    const int face_nodes = make->options->face_nodes;
    const int profile_nodes = make->options->profile_nodes;
    for (int node = 0; node < face_nodes * profile_nodes; node++) {
        const double t1 = (double)(node / profile_nodes) / (face_nodes - 1);
        const double t2 = (double)(node % profile_nodes) / (profile_nodes - 1);
        const double turns = contact_turns(make, tooth, side, t1, t2);
        table[node] = 0.0;
        for (int i = 0; i < make->options->wave_count; i++) {
            const gm_flank_wave *wave = &make->options->waves[i];
            const double phase = make->wave_phase[2 * i + side];
            table[node] += wave->amplitude * sine_of_turns(wave->order * turns + phase);
        }
    }
}

static int check_resolution(const generator *make, const char *axis, double length, int nodes,
                            int order) {
    const double waves = order * fabs(length) / (2.0 * pi * make->gear->base_radius);
    if (nodes - 1 >= NODES_PER_WAVE * waves) {
        return GM_IO_OK;
    }
    return gmi_error_set(make->error, GM_IO_ERR_OPTION, 0,
                         "order %d makes %ld waves along %s, too many for %d nodes; %d nodes per "
                         "wave are right",
                         order, (long)waves + 1, axis, nodes, NODES_PER_WAVE);
}

static int check_waves(const generator *make) {
    const gm_generate_options *options = make->options;
    if (options->wave_count < 0 || options->wave_count > MOST_WAVES ||
        (options->wave_count > 0 && options->waves == NULL)) {
        return gmi_error_set(make->error, GM_IO_ERR_OPTION, 0, "%d waves; 0 to %d are right",
                             options->wave_count, MOST_WAVES);
    }
    int status = GM_IO_OK;
    for (int i = 0; status == GM_IO_OK && i < options->wave_count; i++) {
        const gm_flank_wave *wave = &options->waves[i];
        if (wave->order < 1 || wave->order > MOST_ORDER) {
            return gmi_error_set(make->error, GM_IO_ERR_OPTION, 0,
                                 "a wave of order %d; 1 to %d are right", wave->order, MOST_ORDER);
        }
        if (!(wave->amplitude >= 0.0) || !isfinite(wave->amplitude)) {
            return gmi_error_set(make->error, GM_IO_ERR_OPTION, 0,
                                 "the amplitude of a wave must be finite and not below 0");
        }
        status = check_resolution(make, "t1", make->pair->twist, options->face_nodes, wave->order);
        if (status == GM_IO_OK) {
            status = check_resolution(make, "t2",
                                      make->gear->tip_roll_length - make->gear->start_roll_length,
                                      options->profile_nodes, wave->order);
        }
    }
    return status;
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
    for (int node = 0; node < of->nodes; node++) {
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
    for (int i = 0; i < HALVINGS; i++) {
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
    for (int k = 0; k < 3; k++) {
        size[k] = draw(make, 0.0, 0.4);
        phase[k] = draw(make, 0.0, 1.0);
    }
    for (int node = 0; node < of->nodes; node++) {
        const double t = (double)node / (of->nodes - 1);
        of->shape[node] = crowning * 4.0 * t * (1.0 - t) + draw(make, -0.1, 0.1);
        for (int k = 0; k < 3; k++) {
            of->shape[node] += size[k] * sine_of_turns((k + 1) * t + phase[k]);
        }
    }
    const gmi_line mean = gmi_trace_mean_line(of->shape, of->nodes, of->range);
    const double form = gmi_trace_evaluate(of->shape, of->nodes, of->range).form;
    for (int node = 0; node < of->nodes; node++) {
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
    for (int i = 0; i < HALVINGS; i++) {
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
    const double part = draw(make, 0.3, 0.9);
    const mixture partial = {draw(make, -0.8, 0.8) * of->limit.slope, part * full.form};
    const mixture slope_only = {full.slope, 0.0};
    const mixture form_only = {flat.slope, full.form};
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
    for (int i = 0; i < MOST_DRAWS; i++) {
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
    for (int node = 0; node < of->nodes; node++) {
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
    const int count = 2 * make->gear->teeth;
    for (int axis = 0; axis < 2; axis++) {
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
    for (int i = 0; i < 3; i++) {
        if (of->flank[axis][i] == flank) {
            return role[i];
        }
    }
    return ORDINARY;
}

/* Axis 0 = profile, 1 = helix. */
static trace trace_of(const generator *make, int axis) {
    const int kind = axis == 0 ? GM_QUALITY_PROFILE_SLOPE : GM_QUALITY_HELIX_SLOPE;
    double *work = make->work + 3 * (size_t)axis * MOST_NODES;
    const trace result = {
        .nodes = axis == 0 ? make->options->profile_nodes : make->options->face_nodes,
        .range = &make->range[axis],
        .wave = work,
        .shape = work + MOST_NODES,
        .sum = work + 2 * (size_t)MOST_NODES,
        .limit = {make->target[kind], make->target[kind + 1], make->target[kind + 2]}};
    return result;
}

static int generate_flank(generator *make, const roles *parts, int flank) {
    const int face_nodes = make->options->face_nodes;
    const int profile_nodes = make->options->profile_nodes;
    const double factor = make->pair->normal_to_transverse;
    double *table = make->deviations->sets[flank].values;
    const trace profile = trace_of(make, 0);
    const trace helix = trace_of(make, 1);

    fill_waves(make, table, make->deviations->sets[flank].tooth,
               make->deviations->sets[flank].side);
    gmi_profile_trace(profile.wave, table, face_nodes, profile_nodes, factor);
    gmi_helix_trace(helix.wave, table, face_nodes, profile_nodes, factor);
    int status = make_trace(make, &profile, role_of(parts, 0, flank));
    if (status == GM_IO_OK) {
        status = make_trace(make, &helix, role_of(parts, 1, flank));
    }
    for (int node = 0; status == GM_IO_OK && node < face_nodes * profile_nodes; node++) {
        const double added = helix.sum[node / profile_nodes] + profile.sum[node % profile_nodes];
        table[node] = rounded(table[node] + added / factor);
    }
    return status;
}

static int generate_flanks(generator *make) {
    roles of;
    draw_roles(make, &of);
    for (int i = 0; i < 2 * make->options->wave_count; i++) {
        make->wave_phase[i] = draw(make, 0.0, 1.0);
    }
    int status = GM_IO_OK;
    for (int flank = 0; status == GM_IO_OK && flank < make->deviations->set_count; flank++) {
        status = generate_flank(make, &of, flank);
    }
    return status;
}

/* ---------------------------------------------------------------------------------------------
 * Memory, checks, and the call
 * ------------------------------------------------------------------------------------------- */

static int allocate_deviations(generator *make) {
    gm_deviations *deviations = make->deviations;
    const size_t nodes = (size_t)make->options->face_nodes * (size_t)make->options->profile_nodes;
    const size_t flanks = 2 * (size_t)make->gear->teeth;
    deviations->teeth = make->gear->teeth;
    deviations->face_nodes = make->options->face_nodes;
    deviations->profile_nodes = make->options->profile_nodes;
    deviations->sets = calloc(flanks, sizeof *deviations->sets);
    if (deviations->sets == NULL) {
        return fail_memory(make->error);
    }
    for (size_t i = 0; i < flanks; i++) {
        gm_deviation_set *set = &deviations->sets[i];
        set->tooth = (int)(i / 2);
        set->side = i % 2 == 0 ? GM_DRIVE : GM_COAST;
        set->values = malloc(nodes * sizeof *set->values);
        deviations->set_count++;
        if (set->values == NULL) {
            return fail_memory(make->error);
        }
    }
    return GM_IO_OK;
}

static int allocate_pitch(generator *make) {
    gm_pitch *pitch = make->pitch;
    const size_t teeth = (size_t)make->gear->teeth;
    pitch->teeth = make->gear->teeth;
    pitch->drive = malloc(teeth * sizeof *pitch->drive);
    pitch->coast = malloc(teeth * sizeof *pitch->coast);
    pitch->drive_set = malloc(teeth * sizeof *pitch->drive_set);
    pitch->coast_set = malloc(teeth * sizeof *pitch->coast_set);
    return pitch->drive && pitch->coast && pitch->drive_set && pitch->coast_set
               ? GM_IO_OK
               : fail_memory(make->error);
}

static int allocate(generator *make) {
    const size_t pitch_work = 3 * (size_t)make->gear->teeth;
    const size_t trace_work = 6 * (size_t)MOST_NODES;
    const size_t work = pitch_work > trace_work ? pitch_work : trace_work;
    int status = allocate_deviations(make);
    if (status == GM_IO_OK) {
        status = allocate_pitch(make);
    }
    if (status == GM_IO_OK) {
        make->work = malloc(work * sizeof *make->work);
        make->wave_phase =
            malloc((2 * (size_t)make->options->wave_count + 1) * sizeof *make->wave_phase);
        status = make->work && make->wave_phase ? GM_IO_OK : fail_memory(make->error);
    }
    return status;
}

static int check_options(const generator *make) {
    const gm_generate_options *options = make->options;
    if (options->quality_class < GM_QUALITY_BEST_CLASS ||
        options->quality_class > GM_QUALITY_WORST_CLASS) {
        return gmi_error_set(make->error, GM_IO_ERR_OPTION, 0, "class %d; %d to %d are right",
                             options->quality_class, GM_QUALITY_BEST_CLASS, GM_QUALITY_WORST_CLASS);
    }
    if (!(options->share >= least_share && options->share <= most_share)) {
        return gmi_error_set(make->error, GM_IO_ERR_OPTION, 0,
                             "the share of the tolerances must be from 0.8 to 0.99");
    }
    if (options->face_nodes < LEAST_NODES || options->face_nodes > MOST_NODES ||
        options->profile_nodes < LEAST_NODES || options->profile_nodes > MOST_NODES) {
        return gmi_error_set(make->error, GM_IO_ERR_OPTION, 0,
                             "a grid of %d x %d nodes; %d to %d each way are right",
                             options->face_nodes, options->profile_nodes, LEAST_NODES, MOST_NODES);
    }
    return check_waves(make);
}

static int prepare(generator *make) {
    gm_quality_options ranges;
    gm_quality_options_default(&ranges);
    int status = gmi_check_teeth(make->gear->teeth, make->error);
    if (status == GM_IO_OK) {
        status = check_options(make);
    }
    if (status == GM_IO_OK) {
        status = gmi_trace_ranges(make->range, make->pair, &ranges, make->error);
    }
    for (int kind = 0; status == GM_IO_OK && kind < GM_QUALITY_KINDS; kind++) {
        make->target[kind] =
            make->options->share *
            gm_quality_tolerance(make->pair, make->wheel, kind, make->options->quality_class);
    }
    return status == GM_IO_OK ? allocate(make) : status;
}

static void clear(gm_deviations *deviations, gm_pitch *pitch) {
    if (deviations != NULL) {
        memset(deviations, 0, sizeof *deviations);
    }
    if (pitch != NULL) {
        memset(pitch, 0, sizeof *pitch);
    }
}

int gm_flanks_generate(gm_deviations *deviations, gm_pitch *pitch, const gm_pair *pair, int wheel,
                       const gm_generate_options *options, gm_io_error *error) {
    gmi_error_begin(error, NULL);
    clear(deviations, pitch);
    if (deviations == NULL || pitch == NULL || pair == NULL || options == NULL) {
        return gmi_error_set(error, GM_IO_ERR_NULL, 0, "a required pointer is NULL");
    }
    generator make = {.deviations = deviations,
                      .pitch = pitch,
                      .pair = pair,
                      .gear = wheel ? &pair->wheel : &pair->pinion,
                      .wheel = wheel != 0,
                      .options = options,
                      .random = options->seed,
                      .error = error};
    int status = prepare(&make);
    if (status == GM_IO_OK) {
        status = generate_pitch(&make);
    }
    if (status == GM_IO_OK) {
        status = generate_flanks(&make);
    }
    free(make.work);
    free(make.wave_phase);
    if (status != GM_IO_OK) {
        gm_deviations_free(deviations);
        gm_pitch_free(pitch);
    }
    return status;
}
