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
 */
#ifndef GEARMESH_IO_H
#define GEARMESH_IO_H

#include "gearmesh.h"

#ifdef __cplusplus
extern "C" {
#endif

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
    int teeth;         /**< of the gear, 3 .. 100000 */
    int face_nodes;    /**< along t1, 2 .. 10000 */
    int profile_nodes; /**< along t2, 2 .. 10000 */
    int set_count;
    gm_deviation_set *sets; /**< [set_count]; `*` first, then by tooth, whatever the file's order */
} gm_deviations;

/** Contents of a pitch file, resolved to every tooth and side. All arrays come from malloc(). */
typedef struct gm_pitch {
    int teeth;
    double *drive; /**< [teeth] transverse (m) */
    double *coast; /**< [teeth] transverse (m) */
    int *
        drive_set; /**< [teeth] 1 if the file has a row for it, 0 = the tooth stands where it should */
    int *coast_set; /**< [teeth] */
} gm_pitch;

/**
 * Reads a deviation file: strict, in one pass, in time and memory that grow linearly with its rows.
 *
 * @param[out] deviations  the contents; free them with gm_deviations_free(). All zero on an error
 * @param[in]  path        the file
 * @param[in]  teeth       number of teeth of the gear
 * @param[out] error       file, line and reason; may be NULL
 * @return GM_IO_OK or a gm_io_status
 */
GM_API int gm_deviations_read(gm_deviations *deviations, const char *path, int teeth,
                              gm_io_error *error);

/**
 * Writes deviations so that gm_deviations_read() gives back the same bits, at least one set.
 *
 * @return GM_IO_OK or a gm_io_status; after GM_IO_ERR_FILE the file may be there in part
 */
GM_API int gm_deviations_write(const gm_deviations *deviations, const char *path,
                               gm_io_error *error);

/** Frees the arrays and zeroes the struct; NULL and an empty one are fine. */
GM_API void gm_deviations_free(gm_deviations *deviations);

/** Reads a pitch file, as gm_deviations_read(). The most special row wins. */
GM_API int gm_pitch_read(gm_pitch *pitch, const char *path, int teeth, gm_io_error *error);

/** Writes one row per tooth and side that is set, as gm_deviations_write(); at least one. */
GM_API int gm_pitch_write(const gm_pitch *pitch, const char *path, gm_io_error *error);

GM_API void gm_pitch_free(gm_pitch *pitch);

/** How file contents become flanks. */
typedef struct gm_flanks_options {
    double scale; /**< multiplies deviations and pitch [1] */
    double
        normal_factor; /**< multiplies deviations only: pair.normal_to_transverse, or 1; > 0 [1] */
    double
        profile_from;  /**< deviations (not pitch) count in profile_from <= t2 <= profile_to [0] */
    double profile_to; /**< [1] */
    double profile_blend; /**< width in t2 of the linear ramps to zero outside that range [0.1] */

    /* Designed modifications of all teeth, added to what the files say. Scale and profile window do not act on
     * them, the normal factor does. Must be for a gear with this number of teeth. */
    const gm_modifications *drive_modifications; /**< NULL = none [NULL] */
    const gm_modifications *coast_modifications; /**< likewise [NULL] */
    double modification_tolerance; /**< see gm_modifications_grid_find(), >= 1e-12 m [1e-8] */
} gm_flanks_options;

GM_API void gm_flanks_options_default(gm_flanks_options *options);

/**
 * Builds the prepared flanks of a gear. The more special set wins (tooth and flank, then tooth, then
 * flank, then `*`,`*`). Scale and profile window act on node values, so that a table stays bilinear.
 * A set for all teeth is kept once per side, not once per tooth. With modifications the tables of a side have
 * the grid that gm_modifications_grid_find() gives for those of the deviations (2 x 2 without).
 *
 * @param[out] flanks      the flanks
 * @param[out] memory      what they live in: free it with gm_flanks_memory_free() after the last use
 * @param[in]  teeth       number of teeth of the gear
 * @param[in]  deviations  NULL = none
 * @param[in]  pitch       NULL = none
 * @param[in]  options     NULL = defaults
 * @param[out] error       why it failed; may be NULL
 * @return GM_IO_OK, GM_IO_ERR_NULL, GM_IO_ERR_OPTION (also another number of teeth, or values that are
 *         not finite), GM_IO_ERR_MEMORY; on an error memory is NULL and the flanks are all zero
 */
GM_API int gm_flanks_build(gm_flanks *flanks, void **memory, int teeth,
                           const gm_deviations *deviations, const gm_pitch *pitch,
                           const gm_flanks_options *options, gm_io_error *error);

/** Frees what gm_flanks_build() allocated; NULL is fine. */
GM_API void gm_flanks_memory_free(void *memory);

/** Number of teeth whose side no set covers, so that it is ideal; 0 for NULL or another side. */
GM_API int gm_deviations_ideal_teeth(const gm_deviations *deviations, int side);

/** Number of teeth whose side no row covers, so that it has no pitch deviation; 0 as above. */
GM_API int gm_pitch_ideal_teeth(const gm_pitch *pitch, int side);

#ifdef __cplusplus
}
#endif

#endif /* GEARMESH_IO_H */
