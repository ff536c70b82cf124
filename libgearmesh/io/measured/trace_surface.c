/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The surface that the traces of one flank span: profiles interpolated linearly along the face, plus helices
 * interpolated linearly along the profile, less what both have in common, the bilinear surface through their
 * crossings (Boolean sum: Gordon 1969). With one of each it is profile + helix - common point.
 */

#include "trace_surface.h"

#include <math.h>
#include <stdlib.h>

#include "files/io_error.h"
#include "files/number_text.h"

/* The traces of one kind, or a flat one in place of none. */
typedef struct family {
    const gmi_measured *traces; /* NULL = flat */
    int count;                  /* at least 1 */
    int nodes;                  /* along each */
    double flat_at;             /* where the flat one lies */
    double *level;              /* [count] to be added (m) */
    double *lines;              /* [count][nodes] values at the nodes, levels added (m) */
} family;

typedef struct surface {
    family profile;
    family helix;
    double *crossing; /* [profile.count][helix.count] common values (m) */
} surface;

static double place_of(const family *of, int i) {
    return of->traces != NULL ? of->traces[i].at : of->flat_at;
}

static double value_at(const family *of, int i, double t) {
    return of->traces != NULL ? gmi_measured_at(&of->traces[i], t) : 0.0;
}

/* ---------------------------------------------------------------------------------------------
 * Levels: every trace has a constant of its own
 * ------------------------------------------------------------------------------------------- */

/* Helix less profile where they cross. */
static double mismatch(const surface *of, int i, int k) {
    return value_at(&of->helix, k, place_of(&of->profile, i)) -
           value_at(&of->profile, i, place_of(&of->helix, k));
}

/* The levels that make profiles and helices agree best where they cross (least squares): means of the differences. */
static void find_levels(surface *of) {
    double mean = 0.0;
    for (int k = 0; k < of->helix.count; ++k) {
        of->helix.level[k] = 0.0;
    }

    /* A profile is moved by its mean difference from the helices, a helix against its own from the profiles. */
    for (int i = 0; i < of->profile.count; ++i) {
        double sum = 0.0;
        for (int k = 0; k < of->helix.count; ++k) {
            sum += mismatch(of, i, k);
            of->helix.level[k] -= mismatch(of, i, k) / of->profile.count;
        }
        of->profile.level[i] = sum / of->helix.count;
        mean += of->profile.level[i] / of->profile.count;
    }

    /* What is common to all is counted once. */
    for (int k = 0; k < of->helix.count; ++k) {
        of->helix.level[k] += mean;
    }
}

/* Halfway between profile and helix where they cross; returns the largest distance of the two. */
static double find_crossings(surface *of) {
    double worst = 0.0;
    for (int i = 0; i < of->profile.count; ++i) {
        for (int k = 0; k < of->helix.count; ++k) {
            const double profile =
                value_at(&of->profile, i, place_of(&of->helix, k)) + of->profile.level[i];
            const double rest = mismatch(of, i, k) - of->profile.level[i] + of->helix.level[k];
            of->crossing[i * of->helix.count + k] = profile + 0.5 * rest;
            worst = fabs(rest) > worst ? fabs(rest) : worst;
        }
    }
    return worst;
}

static void find_lines(family *of) {
    for (int i = 0; i < of->count; ++i) {
        for (int node = 0; node < of->nodes; ++node) {
            of->lines[i * of->nodes + node] =
                value_at(of, i, (double)node / (of->nodes - 1)) + of->level[i];
        }
    }
}

/* Traces that contradict each other by more than this, and by more than a tenth of what they vary, do not
 * belong to one flank (m). */
static const double least_contradiction = 3e-6;

static double largest_range(const family *of) {
    double range = 0.0;
    for (int i = 0; i < of->count; ++i) {
        double low = (double)INFINITY;
        double high = -(double)INFINITY;
        for (int node = 0; node < of->nodes; ++node) {
            const double value = of->lines[i * of->nodes + node];
            low = value < low ? value : low;
            high = value > high ? value : high;
        }
        range = high - low > range ? high - low : range;
    }
    return range;
}

static int check_contradiction(const surface *of, double worst, gm_io_error *error) {
    const double range = fmax(largest_range(&of->profile), largest_range(&of->helix));
    if (worst <= fmax(least_contradiction, 0.1 * range)) {
        return GM_IO_OK;
    }

    char name[GMI_TRACE_NAME_SIZE];
    char text[GMI_NUMBER_SIZE];
    return gmi_error_set(
        error, GM_IO_ERR_FORMAT, gmi_measured_line(&of->profile.traces[0]),
        "%s: must be of the same flank as the others there, each with its own place (got a "
        "contradiction of %s um where they cross, whatever their levels)",
        gmi_trace_name(name, of->profile.traces[0].from), gmi_number_text(text, worst, 6, 3));
}

/* ---------------------------------------------------------------------------------------------
 * Surface
 * ------------------------------------------------------------------------------------------- */

/* Between which two traces a place lies, and where: 0 at the first, 1 at the second. */
typedef struct between {
    int first;
    int second;
    double share;
} between;

/* Beyond the outer traces the surface goes on straight, but no farther than these are apart. */
static between find_between(const family *of, double t) {
    between found = {0, 0, 0.0};
    if (of->count > 1) {
        while (found.first < of->count - 2 && t > place_of(of, found.first + 1)) {
            ++found.first;
        }
        found.second = found.first + 1;
        const double from = place_of(of, found.first);
        found.share = (t - from) / (place_of(of, found.second) - from);
        found.share = found.share < -1.0 ? -1.0 : found.share > 2.0 ? 2.0 : found.share;
    }
    return found;
}

static double mix(double first, double second, double share) {
    return first + share * (second - first);
}

static double node_value(const surface *of, int face, const between *along_face, int profile,
                         const between *along_profile) {
    const double *lines = of->profile.lines + profile;
    const double *crossing = of->crossing;
    const int nodes = of->profile.nodes;
    const int row = of->helix.count;
    const int i0 = along_face->first;
    const int i1 = along_face->second;
    const int k0 = along_profile->first;
    const int k1 = along_profile->second;

    /* Between two profiles, between two helices, and the bilinear surface that both contain. */
    const double profiles = mix(lines[i0 * nodes], lines[i1 * nodes], along_face->share);
    const double helices = mix(of->helix.lines[k0 * of->helix.nodes + face],
                               of->helix.lines[k1 * of->helix.nodes + face], along_profile->share);
    const double common =
        mix(mix(crossing[i0 * row + k0], crossing[i1 * row + k0], along_face->share),
            mix(crossing[i0 * row + k1], crossing[i1 * row + k1], along_face->share),
            along_profile->share);
    return profiles + (helices - common);
}

static void fill_table(const surface *of, double *table) {
    const int face_nodes = of->helix.nodes;
    const int profile_nodes = of->profile.nodes;
    for (int face = 0; face < face_nodes; ++face) {
        const between along_face = find_between(&of->profile, (double)face / (face_nodes - 1));
        for (int node = 0; node < profile_nodes; ++node) {
            const between along_profile =
                find_between(&of->helix, (double)node / (profile_nodes - 1));
            *table++ = node_value(of, face, &along_face, node, &along_profile);
        }
    }
}

double gmi_table_at(const double *table, int face_nodes, int profile_nodes, double t1, double t2) {
    const double x = t1 * (face_nodes - 1);
    const double y = t2 * (profile_nodes - 1);
    const int face = x < face_nodes - 2 ? (int)x : face_nodes - 2;
    const int profile = y < profile_nodes - 2 ? (int)y : profile_nodes - 2;
    const double *low = table + (size_t)face * (size_t)profile_nodes + profile;
    const double *high = low + profile_nodes;
    return mix(mix(low[0], low[1], y - profile), mix(high[0], high[1], y - profile), x - face);
}

static void family_init(family *of, const gmi_measured *traces, int count, int nodes,
                        double flat_at) {
    of->traces = count > 0 ? traces : NULL;
    of->count = count > 0 ? count : 1;
    of->nodes = nodes;
    of->flat_at = flat_at;
}

/* Cuts one piece of memory into what a surface needs; NULL = there is none. */
static double *surface_memory(surface *of) {
    const size_t profiles = (size_t)of->profile.count;
    const size_t helices = (size_t)of->helix.count;
    const size_t profile_lines = profiles * (size_t)of->profile.nodes;
    const size_t helix_lines = helices * (size_t)of->helix.nodes;
    double *memory = malloc(
        (profiles + helices + profile_lines + helix_lines + profiles * helices) * sizeof *memory);
    if (memory != NULL) {
        of->profile.level = memory;
        of->helix.level = of->profile.level + profiles;
        of->profile.lines = of->helix.level + helices;
        of->helix.lines = of->profile.lines + profile_lines;
        of->crossing = of->helix.lines + helix_lines;
    }
    return memory;
}

int gmi_surface_make(double *table, const gm_traces_options *options, const gmi_measured *traces,
                     int profiles, int helices, double t2_zero, gm_traces_report *report,
                     gm_io_error *error) {
    surface of;
    family_init(&of.profile, traces, profiles, options->profile_nodes, 0.5);
    family_init(&of.helix, traces + profiles, helices, options->face_nodes, t2_zero);
    double *memory = surface_memory(&of);
    if (memory == NULL) {
        return gmi_error_memory(error);
    }

    /* Levels first: the crossings and the lines contain them. */
    find_levels(&of);
    const double worst = find_crossings(&of);
    find_lines(&of.profile);
    find_lines(&of.helix);

    const int status = check_contradiction(&of, worst, error);
    if (status == GM_IO_OK) {
        report->crossing_error = fmax(report->crossing_error, worst);
        fill_table(&of, table);

        /* Zero where the pitch is measured. */
        const double level =
            gmi_table_at(table, options->face_nodes, options->profile_nodes, 0.5, t2_zero);
        for (int node = 0; node < options->face_nodes * options->profile_nodes; ++node) {
            table[node] -= level;
        }
    }
    free(memory);
    return status;
}
