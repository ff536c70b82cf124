/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Waves of a gear: where on its way round a point of a flank comes into contact, and what a wave adds there. */

#include "waves.h"

#include <math.h>

#include "files/io_error.h"
#include "shared.h"

/* Waves per revolution. */
enum { MOST_ORDER = 1000000 };

/* How far a contact line advances over the gear's own face (m). */
static double face_advance(const gmi_generator *make) {
    return make->pair->face_advance * (make->gear->face_width / make->pair->face_width);
}

/*
 * Turns of the gear at which a point of a flank comes into contact, less a constant and with the opposite
 * sign. Forward rotation moves the contact of pinion drive and wheel coast flanks to the tip, that of the
 * others to the root; so it is on a ring, whose roll lengths fall towards the tip.
 */
static double contact_turns(const gmi_generator *make, int tooth, int side, double t1, double t2) {
    const gm_gear *gear = make->gear;
    const double rho = gear->sign * (gear->start_roll_length +
                                     t2 * (gear->tip_roll_length - gear->start_roll_length));
    const double roll = (side == GM_DRIVE) == !make->wheel ? -rho : rho;
    return (double)tooth / gear->teeth +
           (roll + t1 * face_advance(make)) / (2.0 * GMI_PI * gear->base_radius);
}

void gmi_waves_draw(const gmi_generator *make) {
    uint64_t start = make->random;
    uint64_t own = gmi_random_bits(&start);
    for (int i = 0; i < 2 * make->options->wave_count; ++i) {
        make->wave_phase[i] = gmi_random_uniform(&own, 0.0, 1.0);
    }
}

void gmi_waves_fill(const gmi_generator *make, const gm_deviation_set *set) {
    const int face_nodes = make->options->face_nodes;
    const int profile_nodes = make->options->profile_nodes;
    for (int node = 0; node < face_nodes * profile_nodes; ++node) {
        const double t1 = (double)(node / profile_nodes) / (face_nodes - 1);
        const double t2 = (double)(node % profile_nodes) / (profile_nodes - 1);
        const double turns = contact_turns(make, set->tooth, set->side, t1, t2);

        set->values[node] = 0.0;
        for (int i = 0; i < make->options->wave_count; ++i) {
            const gm_flank_wave *wave = &make->options->waves[i];
            const double phase = make->wave_phase[2 * i + set->side];
            set->values[node] += wave->amplitude * gmi_sine_of_turns(wave->order * turns + phase);
        }
    }
}

static int check_resolution(const gmi_generator *make, const char *axis, double length, int nodes,
                            int order) {
    const double waves = order * fabs(length) / (2.0 * GMI_PI * make->gear->base_radius);
    if (nodes - 1 >= GMI_NODES_PER_WAVE * waves) {
        return GM_IO_OK;
    }
    return gmi_error_set(
        make->error, GM_IO_ERR_OPTION, 0,
        "order %d: must have %d nodes per wave (got %ld waves along %s for %d nodes)", order,
        GMI_NODES_PER_WAVE, (long)waves + 1, axis, nodes);
}

int gmi_waves_check(const gmi_generator *make) {
    const gm_generate_options *options = make->options;
    if (options->wave_count < 0 || options->wave_count > GM_FLANK_WAVES_MAX ||
        (options->wave_count > 0 && options->waves == NULL)) {
        return gmi_error_set(make->error, GM_IO_ERR_OPTION, 0, "waves: must be 0 to %d (got %d)",
                             GM_FLANK_WAVES_MAX, options->wave_count);
    }

    /* Each wave by itself: order, amplitude, and nodes enough along both directions. */
    int status = GM_IO_OK;
    for (int i = 0; status == GM_IO_OK && i < options->wave_count; ++i) {
        const gm_flank_wave *wave = &options->waves[i];
        if (wave->order < 1 || wave->order > MOST_ORDER) {
            return gmi_error_set(make->error, GM_IO_ERR_OPTION, 0,
                                 "the order of a wave: must be from 1 to %d (got %d)", MOST_ORDER,
                                 wave->order);
        }
        if (!(wave->amplitude >= 0.0) || !isfinite(wave->amplitude)) {
            return gmi_error_set(make->error, GM_IO_ERR_OPTION, 0,
                                 "the amplitude of a wave must be finite and not below 0");
        }

        status = check_resolution(make, "t1", face_advance(make), options->face_nodes, wave->order);
        if (status == GM_IO_OK) {
            status = check_resolution(make, "t2",
                                      make->gear->tip_roll_length - make->gear->start_roll_length,
                                      options->profile_nodes, wave->order);
        }
    }
    return status;
}
