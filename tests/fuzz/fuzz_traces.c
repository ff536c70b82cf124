/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Any bytes as a trace file and as a measured pitch file, of a gear that stood any way: there are finite tables that can
 * be written, or there is an error with a text. */
#include "fuzz.h"
#include "fuzz_file.h"

#include <gearmesh/gearmesh_io.h>
#include <math.h>

static fuzz_file input, output;

/* z = 7, so that numbers of teeth are soon right. */
static gm_pair small_pair(void) {
    gm_pair_params params;
    gm_pair pair;
    gm_pair_params_default(&params);
    params.pinion_teeth = 7;
    params.wheel_teeth = 9;
    params.normal_module = 2e-3;
    params.normal_pressure_angle = 0.4;
    params.helix_angle = 0.2;
    params.center_distance = 17e-3;
    params.face_width = 10e-3;
    FUZZ_CLAIM(gm_pair_init(&pair, &params) == GM_OK);
    return pair;
}

static void claim_error(int status, const gm_io_error *error) {
    FUZZ_CLAIM(status < 0 && error->text[0] != '\0' && error->line >= 0);
}

static void try_traces(const gm_pair *pair, const gm_measurement *how, int wheel, int style,
                       const gm_traces_options *options) {
    gm_traces traces;
    gm_deviations deviations;
    gm_traces_report report;
    gm_io_error error;
    int status = gm_traces_read(&traces, fuzz_file_path(&input), pair, wheel, style, &error);
    if (status != GM_IO_OK) {
        claim_error(status, &error);
        return;
    }
    status = gm_traces_build(&deviations, &report, &traces, how, pair, wheel, options, &error);
    if (status == GM_IO_OK) {
        FUZZ_CLAIM(isfinite(report.resampling_error) && isfinite(report.crossing_error));
        FUZZ_CLAIM(gm_deviations_write(&deviations, fuzz_file_path(&output), &error) == GM_IO_OK);
        gm_deviations_free(&deviations);
    } else {
        claim_error(status, &error);
        FUZZ_CLAIM(deviations.sets == NULL);
    }
    gm_traces_free(&traces);
}

static void try_pitch(const gm_pair *pair, const gm_measurement *how, int wheel, int style) {
    gm_measured_pitch measured;
    gm_pitch pitch;
    gm_io_error error;
    int status = gm_measured_pitch_read(&measured, fuzz_file_path(&input), style, &error);
    if (status != GM_IO_OK) {
        claim_error(status, &error);
        return;
    }
    status = gm_measured_pitch_build(&pitch, NULL, &measured, how, pair, wheel, &error);
    if (status == GM_IO_OK) {
        FUZZ_CLAIM(gm_pitch_write(&pitch, fuzz_file_path(&output), &error) == GM_IO_OK);
        gm_pitch_free(&pitch);
    } else {
        claim_error(status, &error);
        FUZZ_CLAIM(pitch.drive == NULL);
    }
    gm_measured_pitch_free(&measured);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    const gm_pair pair = small_pair();
    gm_measurement how;
    gm_traces_options options;
    gm_measurement_default(&how);
    gm_traces_options_default(&options);
    /* The last byte says how the gear stood. */
    const int way = size > 0 ? data[size - 1] : 0;
    how.datum_face = way & 1 ? GM_FACE_I : GM_FACE_II;
    how.counting = way & 2 ? GM_CLOCKWISE : GM_COUNTERCLOCKWISE;
    how.first_number = way >> 3 & 1; /* a line feed: the first tooth is 1 */
    options.remove_spikes = way >> 2 & 1;
    options.face_nodes = 3;
    options.profile_nodes = 4;
    fuzz_file_with(&input, data, size);
    const int style = way >> 5 & 1 ? GM_DECIMAL_COMMA : GM_DECIMAL_POINT;
    options.tip_form_diameter = way >> 6 & 1 ? 17e-3 : (double)NAN;
    try_traces(&pair, &how, way >> 4 & 1, style, &options);
    try_pitch(&pair, &how, way >> 4 & 1, style);
    return 0;
}
