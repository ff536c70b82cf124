/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file gearmesh_io.h
 * Flank and pitch files, read and written: the part of gearmesh that uses files and the heap.
 *
 * Deviations: header `tooth,flank,t1,t2,deviation_um`; pitch: header `tooth,flank,deviation_um`; both
 * described in libgearmesh/docs/flank-files.md. A file is read into plain data (gm_deviations, gm_pitch)
 * that can be changed and written back; gm_flanks_build() makes the prepared flanks of a gear from it.
 *
 * Functions return 0 or a negative gm_io_status and fill a gm_io_error that names file and line. On an
 * error nothing is allocated and outputs are empty. SI units inside, micrometres in the files.
 *
 * There is no global state: calls with different data may run at the same time. Time and memory grow linearly with the
 * data unless a function says otherwise. Numbers are read and written in the same way in every locale.
 */
#ifndef GEARMESH_IO_H
#define GEARMESH_IO_H

#include <stdint.h>
#include <stdio.h>

#include "gearmesh.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Status of a call of gearmesh_io: 0 done, < 0 failed. Apart from the statuses of gearmesh.h. */
enum gm_io_status {
    GM_IO_OK = 0,
    GM_IO_ERR_NULL = -101,   /**< a required pointer is NULL */
    GM_IO_ERR_FILE = -102,   /**< cannot be opened, read or written; a folder */
    GM_IO_ERR_FORMAT = -103, /**< the text is not what the format asks for */
    GM_IO_ERR_MEMORY = -104, /**< out of memory */
    GM_IO_ERR_OPTION = -105  /**< an option, or a value in what is handed in, is out of range */
};

/** Where and why a call failed: one sentence of ASCII without a line end, the same in every locale. */
typedef struct gm_io_error {
    long line;       /**< line in the file, from 1; 0 = the file as a whole */
    char file[1024]; /**< path as given (cut if longer), empty if no file is concerned */
    char text[512];  /**< what is wrong, and what would be right; empty if all is well */
    /** Field of gm_traces_options or gm_measurement that decides about it, as `hollow`: so that a program can say
     *  what it calls that; NULL = none */
    const char *option;
} gm_io_error;

/** One set of rows of a deviation file: the nodes of one tooth and flank, or of all (-1). */
typedef struct gm_deviation_set {
    int tooth;      /**< 0 .. teeth - 1, or -1 = `*` */
    int side;       /**< GM_DRIVE, GM_COAST, or -1 = `*` */
    double *values; /**< [face_nodes][profile_nodes], along the surface normal as measured (m) */
} gm_deviation_set;

/**
 * Contents of a deviation file. All arrays come from malloc(), so that a program may replace them; at
 * most one set per tooth and side.
 */
typedef struct gm_deviations {
    int teeth;              /**< of the gear, 3 .. 100000 */
    int face_nodes;         /**< along t1, 2 .. 10000 */
    int profile_nodes;      /**< along t2, 2 .. 10000 */
    int set_count;          /**< how many sets */
    gm_deviation_set *sets; /**< [set_count]; `*` first, then by tooth, whatever the file's order */
} gm_deviations;

/** Contents of a pitch file, resolved to every tooth and side. All arrays come from malloc(). */
typedef struct gm_pitch {
    int teeth; /**< of the gear, 3 .. 100000 */

    /** [teeth] along the line of action in the transverse section, > 0: material added (m) */
    double *drive;

    double *coast; /**< [teeth] likewise (m) */
    /** [teeth] 1 if the file has a row for it, 0 = the tooth stands where it should */
    int *drive_set;
    int *coast_set; /**< [teeth] likewise */
} gm_pitch;

/**
 * Reads a deviation file [libgearmesh/docs/flank-files.md]. Strict: what is not as the format says is an error.
 *
 * @param[out] deviations  the contents; free them with gm_deviations_free(). All zero on an error
 * @param[in]  path        the file, UTF-8 text
 * @param[in]  teeth       number of teeth of the gear, 3 .. 100000
 * @param[out] error       file, line and reason; may be NULL
 * @return GM_IO_OK, GM_IO_ERR_NULL, GM_IO_ERR_FILE, GM_IO_ERR_FORMAT, GM_IO_ERR_OPTION (teeth), GM_IO_ERR_MEMORY
 *
 * Accuracy: each value is the double nearest to the micrometres in the text, in metres.
 * Cost:     one pass; 58 590 rows in about 25 ms.
 */
GM_API int gm_deviations_read(gm_deviations *deviations, const char *path, int teeth,
                              gm_io_error *error);

/**
 * Writes deviations so that gm_deviations_read() gives back the same bits.
 *
 * @param[in]  deviations  at least one set, at most one for each tooth and side, finite values
 * @param[in]  path        the file, which is replaced
 * @param[out] error       file and reason; may be NULL
 * @return GM_IO_OK, GM_IO_ERR_NULL, GM_IO_ERR_OPTION (nothing is written), GM_IO_ERR_MEMORY, or GM_IO_ERR_FILE, after
 *         which the file may be there in part
 */
GM_API int gm_deviations_write(const gm_deviations *deviations, const char *path,
                               gm_io_error *error);

/**
 * Writes the same text to an open stream, where it stands: behind comment lines, into a file that is locked, or one
 * that takes its name only when it is whole. The stream is flushed, so that a full disk is told, and stays open.
 *
 * @return GM_IO_OK or a gm_io_status; after GM_IO_ERR_FILE a part of the text may be written
 */
GM_API int gm_deviations_print(const gm_deviations *deviations, FILE *stream, gm_io_error *error);

/** Frees the arrays and zeroes the struct; NULL and an empty one are fine. */
GM_API void gm_deviations_free(gm_deviations *deviations);

/**
 * Reads a pitch file [libgearmesh/docs/flank-files.md]. Of several rows that serve a flank the most special one wins:
 * tooth and flank, then tooth, then flank, then `*`,`*`.
 *
 * @param[out] pitch  the contents; free them with gm_pitch_free(). All zero on an error
 * @param[in]  path   the file, UTF-8 text
 * @param[in]  teeth  number of teeth of the gear, 3 .. 100000
 * @param[out] error  file, line and reason; may be NULL
 * @return as gm_deviations_read(), with the same accuracy
 */
GM_API int gm_pitch_read(gm_pitch *pitch, const char *path, int teeth, gm_io_error *error);

/**
 * Writes one row for every tooth and side that is set, so that gm_pitch_read() gives back the same bits.
 *
 * @param[in]  pitch  at least one flank that is set, finite values
 * @param[in]  path   the file, which is replaced
 * @param[out] error  file and reason; may be NULL
 * @return as gm_deviations_write()
 */
GM_API int gm_pitch_write(const gm_pitch *pitch, const char *path, gm_io_error *error);

/** Writes the same text to an open stream, as gm_deviations_print(). */
GM_API int gm_pitch_print(const gm_pitch *pitch, FILE *stream, gm_io_error *error);

/** As gm_deviations_free(). */
GM_API void gm_pitch_free(gm_pitch *pitch);

/** How file contents become flanks. */
typedef struct gm_flanks_options {
    /** Multiplies deviations and pitch, finite [1] */
    double scale;
    /** Multiplies deviations only: pair.normal_to_transverse, or 1 for deviations in the transverse section; > 0 [1] */
    double normal_factor;
    /** Deviations (not pitch) count where profile_from <= t2 <= profile_to [0] */
    double profile_from;
    double profile_to; /**< > profile_from [1] */
    /** Width in t2 of the linear ramps to zero outside that range, >= 0 [0.1] */
    double profile_blend;

    /* Designed modifications of all teeth, added to what the files say. Scale and profile window do not act on
     * them, the normal factor does. Must be for a gear with this number of teeth. */
    const gm_modifications *drive_modifications; /**< NULL = none [NULL] */
    const gm_modifications *coast_modifications; /**< likewise [NULL] */
    double modification_tolerance; /**< see gm_modifications_grid_find(), >= 1e-12 m [1e-8] */
} gm_flanks_options;

/** Fills in the defaults. */
GM_API void gm_flanks_options_default(gm_flanks_options *options);

/** What holds the designed modifications of one side; all zero = there are none. */
typedef struct gm_flanks_side_report {
    int ramps;         /**< linear reliefs and corners, held exactly */
    int face_nodes;    /**< grid of the table that holds the others; 0 = no table is needed */
    int profile_nodes; /**< likewise */
    double error;      /**< bound of the error of that table (m); above the tolerance: a finer grid
                            would have too many nodes */
} gm_flanks_side_report;

/** What gm_flanks_build() has made. */
typedef struct gm_flanks_report {
    gm_flanks_side_report drive; /**< of the flanks GM_DRIVE */
    gm_flanks_side_report coast; /**< of the flanks GM_COAST */
} gm_flanks_report;

/**
 * Builds the prepared flanks of a gear. The more special set wins (tooth and flank, then tooth, then
 * flank, then `*`,`*`). Scale and profile window act on node values, so that a table stays bilinear.
 * A set for all teeth is kept once per side, not once per tooth. Of modifications gm_modifications_split() makes ramps; if
 * others are left, the tables of the side have the grid that gm_modifications_grid_find() gives for those, on top of
 * that of the deviations (2 x 2 without).
 *
 * @param[out] flanks      the flanks, NULL on an error: free them with gm_flanks_free() after the last use
 * @param[in]  teeth       number of teeth of the gear
 * @param[in]  deviations  NULL = none
 * @param[in]  pitch       NULL = none
 * @param[in]  options     NULL = defaults
 * @param[out] report      how the modifications are held, all zero on an error; may be NULL
 * @param[out] error       why it failed; may be NULL
 * @return GM_IO_OK, GM_IO_ERR_NULL, GM_IO_ERR_OPTION (also another number of teeth, or values that are
 *         not finite), GM_IO_ERR_MEMORY
 */
GM_API int gm_flanks_build(gm_flanks **flanks, int teeth, const gm_deviations *deviations,
                           const gm_pitch *pitch, const gm_flanks_options *options,
                           gm_flanks_report *report, gm_io_error *error);

/** Frees what gm_flanks_build() allocated; NULL is fine. */
GM_API void gm_flanks_free(gm_flanks *flanks);

/** Number of teeth whose side no set covers, so that it is ideal; 0 for NULL or another side. */
GM_API int gm_deviations_ideal_teeth(const gm_deviations *deviations, int side);

/** Number of teeth whose side no row covers, so that it has no pitch deviation; 0 as above. */
GM_API int gm_pitch_ideal_teeth(const gm_pitch *pitch, int side);

/* ---------------------------------------------------------------------------------------------
 * Flank quality: measured values, tolerances and classes (libgearmesh/docs/flank-quality.md)
 * ------------------------------------------------------------------------------------------- */

/** What ISO 1328-1:2013 gives tolerances for. All values and tolerances in m, in the transverse section. */
enum gm_quality_kind {
    /** f_p: a pitch against the mean pitch, arc at the reference circle */
    GM_QUALITY_SINGLE_PITCH = 0,
    /** F_p: range of the positions of all flanks of a side, same arc */
    GM_QUALITY_TOTAL_PITCH = 1,
    GM_QUALITY_RUN_OUT = 2,       /**< F_r: range of the radial places of a ball in all spaces */
    GM_QUALITY_PROFILE_SLOPE = 3, /**< f_H_alpha, along the base tangent as all that follow */
    GM_QUALITY_PROFILE_FORM = 4,  /**< f_f_alpha */
    GM_QUALITY_PROFILE_TOTAL = 5, /**< F_alpha */
    GM_QUALITY_HELIX_SLOPE = 6,   /**< f_H_beta */
    GM_QUALITY_HELIX_FORM = 7,    /**< f_f_beta */
    GM_QUALITY_HELIX_TOTAL = 8    /**< F_beta */
};
#define GM_QUALITY_KINDS 9 /**< how many kinds there are */

#define GM_QUALITY_BEST_CLASS  1  /**< the class with the smallest tolerances */
#define GM_QUALITY_WORST_CLASS 11 /**< the class with the largest ones */

/** Symbol of a kind in ASCII, `f_H_alpha`; never NULL, "unknown" for any other integer. */
GM_API const char *gm_quality_symbol(int kind);

/**
 * Tolerance of one kind, rounded as the standard says [ISO 1328-1:2013, 5.2, 5.3; F_r: annex].
 *
 * @param[in] pair           the gear pair
 * @param[in] wheel          0 = its pinion, else its wheel
 * @param[in] kind           enum gm_quality_kind
 * @param[in] quality_class  GM_QUALITY_BEST_CLASS .. GM_QUALITY_WORST_CLASS
 * @return m, NaN for arguments out of range; outside the standard's ranges (gm_quality_is_in_scope())
 *         the formula is used all the same
 *
 * Accuracy: rounded as the standard rounds, so exact but for the conversion to metres. What was confirmed of each
 *           formula, and how, stands in libgearmesh/docs/flank-quality.md.
 */
GM_API double gm_quality_tolerance(const gm_pair *pair, int wheel, int kind, int quality_class);

/** Whether the standard's formulae are meant for this gear: 5 <= z <= 1000, 5 mm <= d <= 15 m, 0.5 mm <= m_n
 *  <= 70 mm, 4 mm <= b <= 1.2 m, |beta| <= 45 deg; 0 or 1. */
GM_API int gm_quality_is_in_scope(const gm_pair *pair, int wheel);

/** Evaluation ranges. */
typedef struct gm_quality_options {
    double profile_from; /**< t2 where the evaluation of the profile begins [0] */
    double profile_to;   /**< t2 where it ends [0.95]; 0 <= profile_from < profile_to <= 1 */
    /** Cut off the helix evaluation at both ends, in t1, 0 .. 0.45 [NaN: the smaller one of 0.05 and m_n / b] */
    double face_margin;
    /** Slopes: 1 = rise of the mean line from t = 0 to 1, 0 = over the evaluation range only [1] */
    int extrapolate;
    /** 1 = behind the evaluation range (profile: at the tip; helix: at both ends) material that sticks out counts for
     *  form and total, 0 = nothing does [1] */
    int end_material;
} gm_quality_options;

/** Fills in the defaults. */
GM_API void gm_quality_options_default(gm_quality_options *options);

/** Values of one flank, signed where the standard has signs; NaN where no file says anything. */
typedef struct gm_flank_quality {
    /** f_p: > 0: the pitch from the tooth before (i - 1) to this one is too long (m) */
    double single_pitch;
    /** Against tooth 0 of the same side, > 0: ahead in the gear's positive direction of rotation (m) */
    double cumulative_pitch;
    double profile_slope; /**< f_H_alpha, > 0: material rises towards the tip (m) */
    double profile_form;  /**< f_f_alpha (m) */
    double profile_total; /**< F_alpha (m) */
    double helix_slope;   /**< f_H_beta, > 0: material rises with t1 (m) */
    double helix_form;    /**< f_f_beta (m) */
    double helix_total;   /**< F_beta (m) */
} gm_flank_quality;

/** The worst value of one kind. */
typedef struct gm_quality_value {
    double value; /**< absolute (m); NaN = not evaluated */
    /** Which tooth has it: for the single pitch the second one of the two, for the run-out the one whose drive flank
     *  bounds the outermost space; -1 for total pitch, or none */
    int tooth;
    int side; /**< GM_DRIVE or GM_COAST; -1 for the run-out, or none */
    /** Best class whose tolerance holds it; 12 = none does; 0 = not evaluated */
    int quality_class;
} gm_quality_value;

/** All of a gear. */
typedef struct gm_quality {
    gm_quality_value worst[GM_QUALITY_KINDS]; /**< by enum gm_quality_kind */
    int quality_class; /**< the worst class of those evaluated; 12, 0 as above */
} gm_quality;

/**
 * Evaluates flanks by the definitions of ISO 1328-1:2013: pitch and run-out from the pitch list (a side
 * without a row, and with it the run-out, is not evaluated), profile from the trace at t1 = 0.5, helix from that
 * at t2 = 0.5, of every flank that has a set. The mean line is that of least squares over the evaluation range,
 * exact for the polygon between the nodes. The design is the unmodified involute helicoid, and nothing is filtered.
 *
 * @param[out] quality     worst values and classes; all not evaluated on an error
 * @param[out] flanks      [2 * teeth] values of every flank, all drive flanks first; may be NULL
 * @param[in]  pair        the gear pair
 * @param[in]  wheel       0 = the pinion is evaluated, else the wheel
 * @param[in]  deviations  along the surface normal; NULL = none
 * @param[in]  pitch       NULL = none
 * @param[in]  options     NULL = defaults
 * @param[out] error       may be NULL
 * @return GM_IO_OK, GM_IO_ERR_NULL, GM_IO_ERR_OPTION (also another number of teeth, values that are not
 *         finite), GM_IO_ERR_MEMORY
 *
 * Source:   libgearmesh/docs/flank-quality.md, also on what of the standard was confirmed and how.
 * Accuracy: of the values a few roundings of the largest one; the grid stands for the trace.
 */
GM_API int gm_quality_evaluate(gm_quality *quality, gm_flank_quality *flanks, const gm_pair *pair,
                               int wheel, const gm_deviations *deviations, const gm_pitch *pitch,
                               const gm_quality_options *options, gm_io_error *error);

/** Most waves that gm_flanks_generate() takes. */
#define GM_FLANK_WAVES_MAX 100

/** A wave that goes on from tooth to tooth, as a ghost order of a machine: along the path of contact it is a
 *  pure sine of the gear's rotation. */
typedef struct gm_flank_wave {
    int order;        /**< waves per revolution of the gear, 1 .. 1000000 */
    double amplitude; /**< along the surface normal, m, >= 0 */
} gm_flank_wave;

/** An amount that is distributed normally from flank to flank, never beyond 6 standard deviations from the mean. */
typedef struct gm_scatter_normal {
    double mean;      /**< m */
    double deviation; /**< standard deviation, m, >= 0 */
} gm_scatter_normal;

/** An amount that is distributed uniformly from flank to flank: in low .. high, never beyond. */
typedef struct gm_scatter_uniform {
    double low;  /**< smallest amount (m, or a number of waves) */
    double high; /**< largest amount, >= low */
} gm_scatter_uniform;

/** What profile or helix has all along, t = 0 .. 1, along the surface normal. */
typedef struct gm_trace_scatter {
    gm_scatter_normal slope; /**< material rises so much from t = 0 to 1 [0] */
    /** So much is missing at both ends and none in the middle, a parabola [0] */
    gm_scatter_normal crowning;
    gm_scatter_uniform wave; /**< amplitude of a wave of any phase, m, >= 0 [0] */
    /** How many waves from t = 0 to 1, not whole; at least 4 nodes per wave [1 .. 3] */
    gm_scatter_uniform wave_count;
} gm_trace_scatter;

/** Flanks of a production: each one is drawn anew, from these. All amounts are 10 mm at most. */
typedef struct gm_flank_scatter {
    gm_trace_scatter profile;     /**< from t2 = 0 to 1 */
    gm_trace_scatter helix;       /**< from t1 = 0 to 1 */
    gm_scatter_normal foot;       /**< material at t2 = 0, falls linearly to 0 at foot_end [0] */
    double foot_end;              /**< t2, 0 < foot_end <= 1 [0.35] */
    gm_scatter_normal tip_relief; /**< missing at the tip, a parabola from 0 at tip_start on [0] */
    double tip_start;             /**< t2, 0 <= tip_start < 1 [0.8] */
    double roughness;             /**< standard deviation of every node, m [0] */
    /** Standard deviation of the place of each tooth space about their mean, along the line of action in the
     *  transverse section, m [0] */
    double pitch;
    /** Of the gear's axis, m: a first order of this amplitude in the pitch of drive and coast flanks, and twice as much
     *  run-out [0] */
    double eccentricity;
} gm_flank_scatter;

/** Ideal flanks: all amounts 0. */
GM_API void gm_flank_scatter_default(gm_flank_scatter *scatter);

/** The flanks that the synthetic figures of the paper are computed with (data/paper/README.md). */
GM_API void gm_flank_scatter_paper(gm_flank_scatter *scatter);

/** What is generated: flanks of a class, or with scatter flanks of a production. */
typedef struct gm_generate_options {
    int quality_class; /**< 1 .. 11, required without scatter [0] */
    /** Of a class: worst value / tolerance, of every kind, 0.8 .. 0.99: at least 0.8 keeps it out of the next better
     *  class [0.95] */
    double share;
    const gm_flank_scatter *scatter; /**< NULL = a class is wanted [NULL] */
    /** Same seed, same flanks; pinion and wheel have nothing in common [1] */
    uint64_t seed;
    int face_nodes;             /**< along t1, 9 .. 1000 [21] */
    int profile_nodes;          /**< along t2, 9 .. 1000 [31] */
    const gm_flank_wave *waves; /**< [wave_count], added to all flanks [NULL] */
    int wave_count;             /**< 0 .. GM_FLANK_WAVES_MAX [0] */
} gm_generate_options;

/** Fills in the defaults. */
GM_API void gm_generate_options_default(gm_generate_options *options);

/**
 * Makes flanks of a gear from random numbers; every tooth is different.
 *
 * Of a class: with the default options of gm_quality_evaluate(), the worst value of every kind is `share` times its
 * tolerance, to 1e-9 m. With scatter: amounts are drawn for each flank; gm_quality_evaluate() tells their class.
 *
 * @param[out] deviations  a set for every flank; free it with gm_deviations_free(). All zero on an error
 * @param[out] pitch       all flanks; free it with gm_pitch_free(). All zero on an error
 * @param[in]  pair        the gear pair
 * @param[in]  wheel       0 = its pinion, else its wheel
 * @param[in]  options     what is wanted
 * @param[out] error       may be NULL
 * @return GM_IO_OK, GM_IO_ERR_NULL, GM_IO_ERR_OPTION (also a class together with scatter, and where the values of a
 *         class contradict each other: the waves use up a tolerance, or about ten teeth and fewer), GM_IO_ERR_MEMORY
 *
 * Source:   libgearmesh/docs/flank-quality.md.
 * Accuracy: values are whole multiples of 1e-10 m, the same on every machine but for what the C library's trigonometry
 *           leaves in the last bits of the pair.
 */
GM_API int gm_flanks_generate(gm_deviations *deviations, gm_pitch *pitch, const gm_pair *pair,
                              int wheel, const gm_generate_options *options, gm_io_error *error);

/* ---------------------------------------------------------------------------------------------
 * Measured flanks: traces of some teeth, pitch of all (libgearmesh/docs/measured-flanks.md)
 * ------------------------------------------------------------------------------------------- */

/**
 * Which flank, as measuring machines name them: seen from the datum face with the tip of the tooth up
 * [ISO21771]. Where a flank is asked for, GM_DRIVE and GM_COAST do as well.
 */
enum gm_measured_flank { GM_LEFT = 2, GM_RIGHT = 3 };

/** Along what a trace was taken. */
enum gm_trace_kind {
    GM_TRACE_PROFILE = 0, /**< from root to tip in one transverse section */
    GM_TRACE_HELIX = 1    /**< from face to face on one cylinder */
};

/** One trace as it was measured: teeth, flank and face as the machine names them, no mapping done. */
typedef struct gm_trace {
    int tooth; /**< number of the tooth as the machine counts, >= 0 */
    int flank; /**< GM_LEFT, GM_RIGHT, GM_DRIVE or GM_COAST */
    int kind;  /**< enum gm_trace_kind */
    double at; /**< where: a profile's distance from the datum face, a helix's roll length (m) */
    int count; /**< points, >= 2 */
    /** [count] strictly increasing, not necessarily uniform: roll length along a profile, distance from the datum face
     *  along a helix (m). The roll length is counted from the base circle: sqrt(d^2 - d_b^2) / 2 at the diameter d */
    double *position;
    /** [count] > 0: material added; up to a constant, which is the machine's (m) */
    double *deviation;
    /** [count] line of each point in the file, for messages; NULL = unknown */
    long *line;
} gm_trace;

/** The traces of one gear, in any order. All arrays come from malloc(). */
typedef struct gm_traces {
    char file[1024];  /**< where they come from, for messages (cut if longer) */
    int count;        /**< how many traces */
    gm_trace *traces; /**< [count] */
} gm_traces;

/** What was measured of the pitch on one flank. */
typedef struct gm_pitch_point {
    int tooth; /**< as in gm_trace */
    int flank; /**< as in gm_trace */
    /** Arc at the measuring circle in the transverse section (m). Cumulative: how far the flank stands ahead of its
     *  place in the direction of counting. Single: how much too long the pitch from the flank before (tooth - 1)
     *  to this one is */
    double value;
    long line; /**< in the file; 0 = unknown */
} gm_pitch_point;

/** The measured pitch of one gear: every flank of every tooth once, in any order. */
typedef struct gm_measured_pitch {
    char file[1024];        /**< as in gm_traces */
    int single;             /**< 0 = cumulative values, else single ones */
    int count;              /**< points, 2 per tooth, or 1 where one side was measured */
    gm_pitch_point *points; /**< [count] from malloc() */
} gm_measured_pitch;

/** The face of a gear that lay towards the datum of the measuring machine. */
enum gm_face {
    GM_FACE_I = 1, /**< t1 = 0; seen from it a driving pinion turns clockwise */
    GM_FACE_II = 2 /**< t1 = 1; seen from it a driving pinion turns counter-clockwise */
};

/** How tooth numbers grow, seen from the datum face. */
enum gm_counting { GM_CLOCKWISE = 1, GM_COUNTERCLOCKWISE = 2 };

/** How a gear stood on the machine and how the machine counts. */
typedef struct gm_measurement {
    int datum_face; /**< enum gm_face, required [0] */
    /** enum gm_counting: how tooth numbers grow, seen from the datum face, required [0] */
    int counting;
    int first_number; /**< number of the first tooth, 0 or 1; the last is z - 1 higher [1] */
    int first_tooth;  /**< which tooth of gearmesh that is, 0 .. z - 1 [0] */
    /** Deviations of traces: 0 = along the surface normal, 1 = in the transverse section along the base tangent [0] */
    int transverse;
    /** Measuring circle of the pitch, from base to tip circle, of a ring from tip to root, m [NaN: reference diameter] */
    double pitch_diameter;
} gm_measurement;

/** Fills in the defaults; the datum face and the direction of counting are left to be said. */
GM_API void gm_measurement_default(gm_measurement *measurement);

/** GM_DRIVE or GM_COAST for a measured flank: from face II, left is drive, on both gears and on a ring; -1 if the flank
 *  or the datum face is unknown. */
GM_API int gm_measurement_side(const gm_measurement *measurement, int flank);

/** Which tooth of gearmesh a number on the machine is, 0 .. teeth - 1; -1 if the gear has no such tooth. */
GM_API int gm_measurement_tooth(const gm_measurement *measurement, const gm_pair *pair, int wheel,
                                int number);

/** Numbers in files of measured values. */
enum gm_number_style {
    GM_DECIMAL_POINT = 0, /**< 1.5, fields separated by commas */
    GM_DECIMAL_COMMA = 1  /**< 1,5 or 1.5, fields separated by semicolons */
};

/**
 * Reads traces [libgearmesh/docs/measured-flanks.md]: header `tooth,flank,trace,face_mm,roll_length_mm,deviation_um`,
 * or `diameter_mm` or `roll_angle_deg` in place of the roll length; the rows of a trace stand together. Or a text file of
 * Klingelnberg machines (.mka), known by its first line, with the traces of profile, helix and twist. Strict. Only the
 * text is checked here, and the gear data of an .mka; all else in gm_traces_build().
 *
 * @param[out] traces  free them with gm_traces_free(). All zero on an error
 * @param[in]  path    the file
 * @param[in]  pair    the gear pair
 * @param[in]  wheel   0 = the pinion was measured, else the wheel; its base circle makes roll lengths of diameters
 * @param[in]  style   enum gm_number_style
 * @param[out] error   file, line and reason; may be NULL
 * @return GM_IO_OK, GM_IO_ERR_NULL, GM_IO_ERR_FILE, GM_IO_ERR_FORMAT, GM_IO_ERR_OPTION (a ring), GM_IO_ERR_MEMORY
 *
 * Accuracy: each number is the double nearest to the text in metres; roll lengths of diameters to two roundings, next
 *           to the base circle too.
 */
GM_API int gm_traces_read(gm_traces *traces, const char *path, const gm_pair *pair, int wheel,
                          int style, gm_io_error *error);

/** As gm_deviations_free(). */
GM_API void gm_traces_free(gm_traces *traces);

/**
 * Reads measured pitch [libgearmesh/docs/measured-flanks.md]: header `tooth,flank,cumulative_pitch_um` or
 * `tooth,flank,single_pitch_um`; or the column Fp of both tables of a text file of Klingelnberg machines (.mka). Strict.
 * Only the text is checked here, all else in gm_measured_pitch_build().
 *
 * @param[out] pitch  free it with gm_measured_pitch_free(). All zero on an error
 * @param[in]  path   the file
 * @param[in]  style  enum gm_number_style
 * @param[out] error  file, line and reason; may be NULL
 * @return as gm_traces_read()
 */
GM_API int gm_measured_pitch_read(gm_measured_pitch *pitch, const char *path, int style,
                                  gm_io_error *error);

/** As gm_deviations_free(). */
GM_API void gm_measured_pitch_free(gm_measured_pitch *pitch);

/** What becomes of traces. */
typedef struct gm_traces_options {
    int face_nodes;    /**< along t1, 2 .. 1000 [21] */
    int profile_nodes; /**< along t2, 2 .. 1000 [31] */
    /** How much of t1 or t2 may lie behind either end of a trace, where its last value is held, 0 .. 0.45 [0.2] */
    double held_limit;
    int hollow; /**< 1 = flanks that stand out at their edges are meant so [0] */
    /** 1 = points far off their neighbours, and those that were filled in, are left out; 0 = an error [0] */
    int remove_spikes;
    /** Points of profiles beyond this diameter are left out, as those on a chamfer, m [NaN: none are] */
    double tip_form_diameter;
    /** 1 = deviations of traces are those of the probe in one direction of rotation: > 0 is material added on right flanks
     *  and removed on left ones [0] */
    int probe_sign;
} gm_traces_options;

/** Fills in the defaults. */
GM_API void gm_traces_options_default(gm_traces_options *options);

/** What gm_traces_build() found. */
typedef struct gm_traces_report {
    int profile_traces[2]; /**< [side] GM_DRIVE, GM_COAST */
    int helix_traces[2];   /**< [side] */
    int profile_teeth[2];  /**< [side] teeth with a profile trace; the others are interpolated */
    int helix_teeth[2];    /**< [side] likewise with a helix trace; 0: constant along t1 */
    /** t2 from and to where all profile traces reach; held beyond; NaN = none */
    double profile_range[2];
    double face_range[2]; /**< t1 of all helix traces, likewise */
    /** Largest distance of a measured point from the polygon between nodes, as measured (m) */
    double resampling_error;
    /** Largest contradiction of profile and helix traces where they cross, after constants are taken out; 0 where each
     *  flank has one of each (m) */
    double crossing_error;
    int chamfer_points; /**< points left out: beyond the tip form circle */
    int spikes;         /**< points left out: far off their neighbours */
    int filled_points;  /**< points left out: one value in place of a measurement */
    /** Traces with one value all along while others of their kind vary: were they measured? */
    int constant_traces;
    int constant_trace; /**< index of the first one in gm_traces; -1 = none */
    int hollow_traces;  /**< traces whose ends stand out beyond their middle ... */
    int judged_traces;  /**< ... of so many */
} gm_traces_report;

/**
 * Makes the tables of all teeth from the traces of some. A flank is profile + helix - common point; with several
 * traces along one direction it is the surface that interpolates all of them (linear in between, Boolean sum). Each
 * flank is 0 where the pitch is measured (mid-face, measuring circle), so that the pitch alone says where it stands.
 * Teeth in between are interpolated linearly around the gear, node by node, each side by itself.
 *
 * Refused are traces that leave the gear, miss too much of it, double ones, those of another gear, spikes, ends
 * that were filled in, deviations or lengths in other units, and the opposite sign where it shows.
 *
 * @param[out] deviations   along the surface normal; free them with gm_deviations_free(). All zero on an error
 * @param[out] report       may be NULL
 * @param[in]  traces       what was measured
 * @param[in]  measurement  how
 * @param[in]  pair         the gear pair
 * @param[in]  wheel        0 = the pinion was measured, else the wheel
 * @param[in]  options      NULL = defaults
 * @param[out] error        file and line of the trace, and reason; may be NULL
 * @return GM_IO_OK, GM_IO_ERR_NULL, GM_IO_ERR_FORMAT (what was measured), GM_IO_ERR_OPTION (how),
 *         GM_IO_ERR_MEMORY
 *
 * Source:   libgearmesh/docs/measured-flanks.md; Boolean sum: W. J. Gordon, 1969.
 * Accuracy: exact at the nodes for a flank that is the sum of a profile and a helix; between nodes and points the
 *           resampling error of the report.
 * Cost:     linear in the points and in the nodes of all teeth; on one flank up to 100 traces of a kind.
 */
GM_API int gm_traces_build(gm_deviations *deviations, gm_traces_report *report,
                           const gm_traces *traces, const gm_measurement *measurement,
                           const gm_pair *pair, int wheel, const gm_traces_options *options,
                           gm_io_error *error);

/** What gm_measured_pitch_build() found, [side] with arcs at the measuring circle. The last three fields compare what
 *  varies once per revolution on both sides with a gear that is displaced as a whole; NaN if one side is missing. */
typedef struct gm_measured_pitch_report {
    /** [side] of the single pitches, spread evenly over them; 0 for cumulative values (m) */
    double sum[2];

    /** [side] mean of the cumulative values, taken out: no pitch says how thick teeth are (m) */
    double level[2];

    double displacement; /**< of the axis, that fits best (m) */
    double rest;         /**< share (of squares) of the first order that it leaves, 0 .. 1 */
    /** The same if left and right, or else the direction of counting, were the other way round than said */
    double mirrored_rest;
} gm_measured_pitch_report;

/**
 * Makes the pitch list of all teeth: transverse along the line of action, > 0 material added.
 *
 * Refused are missing and double teeth, those of another gear, values in other units, and single pitches
 * that do not add up to zero.
 *
 * @param[out] pitch        free it with gm_pitch_free(). All zero on an error
 * @param[out] report       may be NULL
 * @param[in]  measured     what was measured
 * @param[in]  measurement  how
 * @param[in]  pair         the gear pair
 * @param[in]  wheel        0 = the pinion was measured, else the wheel
 * @param[out] error        file and line of the value, and reason; may be NULL
 * @return as gm_traces_build()
 *
 * Source:   libgearmesh/docs/measured-flanks.md.
 * Accuracy: a few roundings of the largest value.
 */
GM_API int gm_measured_pitch_build(gm_pitch *pitch, gm_measured_pitch_report *report,
                                   const gm_measured_pitch *measured,
                                   const gm_measurement *measurement, const gm_pair *pair,
                                   int wheel, gm_io_error *error);

#ifdef __cplusplus
}
#endif

#endif /* GEARMESH_IO_H */
