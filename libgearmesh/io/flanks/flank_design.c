/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The ramps of a flank's designed modifications, and the table of the others on a refined grid of the file. */

#include "flank_design.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "files/io_error.h"
#include "files/number_text.h"

static size_t node_count(const gmi_design *design) {
    return (size_t)design->nodes[0] * (size_t)design->nodes[1];
}

static int fail_modification(const gm_modifications *modifications, gm_io_error *error) {
    int index = -1;
    const char *field = NULL;
    const char *requirement = NULL;
    const int status = gm_modifications_check(modifications, &index, &field, &requirement);
    if (field == NULL) {
        return gmi_error_set(error, GM_IO_ERR_OPTION, 0, "the modifications cannot be used: %s",
                             gm_status_text(status));
    }
    return gmi_error_set(error, GM_IO_ERR_OPTION, 0, "modification %d: its %s must be %s", index,
                         field, requirement);
}

static int find_grid(gmi_design *design, const gm_modifications *modifications, double tolerance,
                     gm_io_error *error) {
    gm_modifications_grid grid;
    const int status = gm_modifications_grid_find(modifications, design->file_nodes[0],
                                                  design->file_nodes[1], tolerance, &grid);
    if (status != GM_OK) {
        char text[GMI_NUMBER_SIZE];
        return gmi_error_set(
            error, GM_IO_ERR_OPTION, 0, "modification_tolerance: must be at least 1e-12 m (got %s)",
            isfinite(tolerance) ? gmi_number_text(text, tolerance, 0, 6) : "not finite");
    }
    design->nodes[0] = grid.face_nodes;
    design->nodes[1] = grid.profile_nodes;
    design->error = grid.error;
    return GM_IO_OK;
}

int gmi_design_make(gmi_design *design, const gm_modifications *modifications,
                    const gm_deviations *deviations, double tolerance, gm_io_error *error) {
    memset(design, 0, sizeof *design);
    if (modifications == NULL || modifications->count == 0) {
        return GM_IO_OK;
    }

    /* The grid of a file is kept, and refined. */
    const int has_file = deviations != NULL && deviations->set_count > 0;
    design->file_nodes[0] = has_file ? deviations->face_nodes : 2;
    design->file_nodes[1] = has_file ? deviations->profile_nodes : 2;
    if (gm_modifications_check(modifications, NULL, NULL, NULL) != GM_OK) {
        return fail_modification(modifications, error);
    }

    /* Ramps hold what is linear exactly; the table takes the rest. */
    gm_modification list[GM_MODIFICATIONS_MAX];
    gm_modifications rest = *modifications; /* what ramps leave for the table */
    rest.list = list;
    (void)gm_modifications_split(modifications, design->ramps, &design->ramp_count, list,
                                 &rest.count); /* checked above: cannot fail */
    const int status = find_grid(design, &rest, tolerance, error);
    if (status != GM_IO_OK || rest.count == 0) {
        return status;
    }

    design->values = calloc(node_count(design), sizeof *design->values);
    if (design->values == NULL) {
        return gmi_error_memory(error);
    }
    (void)gm_modifications_add(&rest, design->nodes[0], design->nodes[1], design->values);
    return GM_IO_OK;
}

/* Where line k of the fine grid lies on the coarse one: cell, and share of the cell behind it. */
typedef struct place {
    int cell;
    double share;
} place;

static place place_of(int k, int fine_nodes, int coarse_nodes) {
    const int lines_per_cell = (fine_nodes - 1) / (coarse_nodes - 1);
    place found = {k / lines_per_cell, (double)(k % lines_per_cell) / lines_per_cell};
    if (found.cell == coarse_nodes - 1) { /* the last line ends the last cell */
        --found.cell;
        found.share = 1.0;
    }
    return found;
}

static double between(double from, double to, double share) {
    return from * (1.0 - share) + to * share; /* exact at both ends */
}

void gmi_design_table(const gmi_design *design, const double *deviation, double *table) {
    memcpy(table, design->values, node_count(design) * sizeof *table);
    if (deviation == NULL) {
        return;
    }
    const int coarse_profile = design->file_nodes[1];

    for (int face = 0; face < design->nodes[0]; ++face) {
        const place t1 = place_of(face, design->nodes[0], design->file_nodes[0]);
        const double *line = deviation + (size_t)t1.cell * (size_t)coarse_profile;
        for (int profile = 0; profile < design->nodes[1]; ++profile) {
            const place t2 = place_of(profile, design->nodes[1], coarse_profile);
            const double *low = line + t2.cell;
            const double *high = low + coarse_profile;
            *table++ += between(between(low[0], low[1], t2.share),
                                between(high[0], high[1], t2.share), t1.share);
        }
    }
}

void gmi_design_free(gmi_design *design) {
    free(design->values);
    memset(design, 0, sizeof *design);
}
