/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "measured.h"
#include "report.h"
#include "write.h"

#include <math.h>
#include <string.h>

typedef struct measured_gear {
    const flanks_options *options;
    const gm_pair *pair;
    const gm_gear *gear;
    gm_deviations deviations; /* no sets = no traces were given */
    gm_traces_report traces;
    gm_trace constant; /* the first trace with one value all along; without arrays */
    gm_pitch pitch;    /* no teeth = no pitch was given */
    gm_measured_pitch_report pitch_report;
} measured_gear;

static const char *const side_names[] = {"drive", "coast"};

/* ---------------------------------------------------------------------------------------------
 * What was understood: in the report and in the head of the files
 * ------------------------------------------------------------------------------------------- */

static void print_sources(const measured_gear *of, FILE *file) {
    const flanks_options *options = of->options;

    fprintf(file, "# %s of %d teeth, from measurements: gearflanks %s,",
            of->gear->sign < 0.0 ? "ring"
            : options->wheel     ? "wheel"
                                 : "pinion",
            of->gear->teeth, gm_version());
    if (options->traces != NULL) {
        fprintf(file, " traces %s", options->traces);
    }
    if (options->measured_pitch != NULL) {
        fprintf(file, "%s pitch %s", options->traces != NULL ? "," : "", options->measured_pitch);
    }
    fputc('\n', file);
}

/* Left and right, direction of rotation, numbers of the teeth. */
static void print_mapping(const measured_gear *of, FILE *file) {
    const gm_measurement *how = &of->options->measurement;
    const int from_one = how->datum_face == GM_FACE_I;
    const int wheel = of->options->wheel;
    const int is_ring = of->gear->sign < 0.0;
    const int first = how->first_number;
    int tooth[4];

    for (int i = 0; i < 3; ++i) {
        tooth[i] = gm_measurement_tooth(how, of->pair, wheel, first + i);
    }
    tooth[3] = gm_measurement_tooth(how, of->pair, wheel, first + of->gear->teeth - 1);
    fprintf(file, "# datum face %s (t1 = %d): left flanks are %s, right flanks are %s\n",
            from_one ? "I" : "II", from_one ? 0 : 1, side_names[gm_measurement_side(how, GM_LEFT)],
            side_names[gm_measurement_side(how, GM_RIGHT)]);

    /* From face II the pinion turns counter-clockwise, an external wheel the other way, a ring as the pinion. */
    fprintf(file,
            "# seen from it the %s turns %s as it is driven forward, and teeth are counted %s\n",
            is_ring ? "ring"
            : wheel ? "wheel"
                    : "pinion",
            from_one == (!wheel || is_ring) ? "clockwise" : "counter-clockwise",
            how->counting == GM_CLOCKWISE ? "clockwise" : "counter-clockwise");
    fprintf(file, "# measured teeth %d, %d, %d .. %d are teeth %d, %d, %d .. %d\n", first,
            first + 1, first + 2, first + of->gear->teeth - 1, tooth[0], tooth[1], tooth[2],
            tooth[3]);
}

static void print_traces_of(const measured_gear *of, const char *kind, const int traces[2],
                            const int teeth[2], const char *without, FILE *file) {
    for (int side = 0; side < 2; ++side) {
        fprintf(file, "# %s, %s: ", side_names[side], kind);
        if (teeth[side] == 0) {
            fprintf(file, "no traces, %s\n", without);
        } else {
            fprintf(file,
                    teeth[side] == 1 ? "%d trace%s of %d tooth, which stands for all\n"
                                     : "%d trace%s of %d teeth, %d interpolated\n",
                    traces[side], traces[side] == 1 ? "" : "s", teeth[side],
                    of->gear->teeth - teeth[side]);
        }
    }
}

static void print_range(const char *kind, const double range[2], const char *coordinate,
                        FILE *file) {
    if (isnan(range[0])) {
        return;
    }
    fprintf(file, "# %s from %s = %.3f to %.3f on all traces", kind, coordinate, range[0],
            range[1]);
    fputs(range[0] > 0.0 || range[1] < 1.0 ? ", last values held beyond\n" : "\n", file);
}

static void print_traces(const measured_gear *of, FILE *file) {
    const gm_traces_report *found = &of->traces;

    /* What was measured, and how well the grid holds it. */
    print_traces_of(of, "profile", found->profile_traces, found->profile_teeth,
                    "constant along the profile", file);
    print_traces_of(of, "helix", found->helix_traces, found->helix_teeth, "constant along the face",
                    file);
    print_range("profile", found->profile_range, "t2", file);
    print_range("helix", found->face_range, "t1", file);
    fprintf(file, "# %d x %d nodes: no measured point is off by more than %.3f um\n",
            of->deviations.face_nodes, of->deviations.profile_nodes, 1e6 * found->resampling_error);

    /* What of it is doubtful. */
    if (found->crossing_error > 1e-12) {
        fprintf(file,
                "# where traces of a flank cross they contradict each other by %.3f um at most\n",
                1e6 * found->crossing_error);
    }
    if (found->chamfer_points > 0) {
        fprintf(file, "# %d points left out: beyond the tip form circle\n", found->chamfer_points);
    }
    if (found->spikes > 0) {
        fprintf(file, "# %d point%s left out: spikes\n", found->spikes,
                found->spikes == 1 ? "" : "s");
    }

    /* Values that were probably not measured, or counted the other way. */
    if (found->filled_points > 0) {
        fprintf(file, "# %d points left out: filled in, not measured\n", found->filled_points);
    }
    if (found->constant_traces > 0) {
        static const char *const flanks[] = {"drive", "coast", "left", "right"};
        fprintf(file,
                "# the %s trace of tooth %d, flank %s%s, has one value all along and others vary: "
                "was it "
                "measured?\n",
                of->constant.kind == GM_TRACE_PROFILE ? "profile" : "helix", of->constant.tooth,
                flanks[of->constant.flank], found->constant_traces > 1 ? ", as some others" : "");
    }

    if (2 * found->hollow_traces > found->judged_traces) {
        fprintf(file, "# %d of %d traces stand out at their ends: is material added counted > 0?\n",
                found->hollow_traces, found->judged_traces);
    }
}

static void print_pitch(const measured_gear *of, FILE *file) {
    for (int side = 0; side < 2; ++side) {
        if (gm_pitch_ideal_teeth(&of->pitch, side) > 0) {
            fprintf(file, "# %s, pitch: not measured, ideal\n", side_names[side]);
            continue;
        }
        fprintf(file, "# %s, pitch: mean of %.3f um taken out", side_names[side],
                1e6 * of->pitch_report.level[side]);
        if (fabs(of->pitch_report.sum[side]) >= 0.5e-9) { /* what is shown of it */
            fprintf(file, ", sum of the single pitches of %.3f um spread over all",
                    1e6 * of->pitch_report.sum[side]);
        }
        fputc('\n', file);
    }
}

/* What runs out does so on both sides, as if the gear were displaced. */
static void print_displacement(const measured_gear *of, FILE *file) {
    const gm_measured_pitch_report *found = &of->pitch_report;

    if (isnan(found->displacement)) {
        return;
    }
    fprintf(
        file,
        "# what the pitch varies once per revolution is that of a gear displaced by %.3f um, but "
        "for %.0f %%\n",
        1e6 * found->displacement, 100.0 * found->rest);
    if (found->rest > 0.15 && found->mirrored_rest < 0.25 * found->rest) {
        fprintf(file,
                "# but for %.0f %% if left and right, or else the direction of counting, were the "
                "other "
                "way round: are they as said?\n",
                100.0 * found->mirrored_rest);
    }
}

/* In the file of the flanks. */
static void print_traces_head(FILE *file, const void *context) {
    print_sources(context, file);
    print_mapping(context, file);
    print_traces(context, file);
}

static void print_pitch_head(FILE *file, const void *context) {
    print_sources(context, file);
    print_mapping(context, file);
    print_pitch(context, file);
    print_displacement(context, file);
}

static void print_report(const measured_gear *of) {
    print_sources(of, stdout);
    print_mapping(of, stdout);
    if (of->options->traces != NULL) {
        print_traces(of, stdout);
    }
    if (of->options->measured_pitch != NULL) {
        print_pitch(of, stdout);
        print_displacement(of, stdout);
    }
}

/* ---------------------------------------------------------------------------------------------
 * Reading, building, writing
 * ------------------------------------------------------------------------------------------- */

/* To 0.1 nm, far below what a machine can tell: short numbers in the file. */
static void round_values(double *values, size_t count) {
    for (size_t i = 0; i < count; ++i) {
        values[i] = round(1e10 * values[i]) / 1e10;
    }
}

static void round_deviations(gm_deviations *deviations) {
    for (int i = 0; i < deviations->set_count; ++i) {
        round_values(deviations->sets[i].values,
                     (size_t)deviations->face_nodes * (size_t)deviations->profile_nodes);
    }
}

static int read_traces(measured_gear *of) {
    const flanks_options *options = of->options;
    gm_traces traces;
    gm_io_error error;
    int status = gm_traces_read(&traces, options->traces, of->pair, options->wheel,
                                options->number_style, &error);

    if (status == GM_IO_OK) {
        status = gm_traces_build(&of->deviations, &of->traces, &traces, &options->measurement,
                                 of->pair, options->wheel, &options->from_traces, &error);
        if (status == GM_IO_OK && of->traces.constant_trace >= 0) {
            of->constant = traces.traces[of->traces.constant_trace];
        }
        gm_traces_free(&traces);
        round_deviations(&of->deviations);
    }
    return status == GM_IO_OK ? EXIT_DONE : refuse_input(options->messages, status, &error);
}

static int read_pitch(measured_gear *of) {
    const flanks_options *options = of->options;
    gm_measured_pitch pitch;
    gm_io_error error;
    int status =
        gm_measured_pitch_read(&pitch, options->measured_pitch, options->number_style, &error);

    if (status == GM_IO_OK) {
        status = gm_measured_pitch_build(&of->pitch, &of->pitch_report, &pitch,
                                         &options->measurement, of->pair, options->wheel, &error);
        gm_measured_pitch_free(&pitch);
    }
    if (status == GM_IO_OK) {
        round_values(of->pitch.drive, (size_t)of->gear->teeth);
        round_values(of->pitch.coast, (size_t)of->gear->teeth);
    }
    return status == GM_IO_OK ? EXIT_DONE : refuse_input(options->messages, status, &error);
}

static int write_all(const measured_gear *of) {
    const flanks_options *options = of->options;
    written files[WRITTEN_MAX];
    int count = 0;

    if (options->traces != NULL) {
        files[count++] =
            (written){options->deviations, &of->deviations, NULL, print_traces_head, of};
    }
    if (options->measured_pitch != NULL) {
        files[count++] = (written){options->pitch, NULL, &of->pitch, print_pitch_head, of};
    }
    return write_files(files, count, options->messages);
}

int build_measured(const flanks_options *options, const gm_pair *pair) {
    measured_gear of = {
        .options = options, .pair = pair, .gear = options->wheel ? &pair->wheel : &pair->pinion};
    int status = EXIT_DONE;

    /* Traces and pitch, or one of them. */
    if (options->traces != NULL) {
        status = read_traces(&of);
    }
    if (status == EXIT_DONE && options->measured_pitch != NULL) {
        status = read_pitch(&of);
    }
    if (status == EXIT_DONE) {
        status = write_all(&of);
    }

    /* How it was understood, and the class that it has. */
    if (status == EXIT_DONE) {
        print_report(&of);
        status = report_quality(options, pair, options->traces != NULL ? &of.deviations : NULL,
                                options->measured_pitch != NULL ? &of.pitch : NULL);
    }
    gm_deviations_free(&of.deviations);
    gm_pitch_free(&of.pitch);
    return status;
}
