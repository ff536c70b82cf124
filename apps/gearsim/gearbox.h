/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The gear pair and its flanks as loaded from a configuration; shared read-only by all analyses. */
#ifndef GEARSIM_GEARBOX_H
#define GEARSIM_GEARBOX_H

#include "config.h"

/* What holds the design of a flank; all zero = no design. */
typedef struct design_form {
    int ramps;                  /* linear reliefs, exact */
    gm_modifications_grid grid; /* of the table of the others, 0 nodes = none */
} design_form;

typedef struct gearbox {
    gm_pair pair;
    const gm_flanks *pinion_flanks; /* NULL = ideal */
    const gm_flanks *wheel_flanks;
    double simple_stiffness; /* K_simple, N/m: of the simple model */
    double simple_damping;   /* D_simple = D eps_alpha, N s/m */

    design_form design_form[2][2]; /* [gear][side] */

    gm_flanks flank_storage[2];
    void *flank_memory[2];
} gearbox;

/* Returns 0 or EXIT_BAD_INPUT after a message on stderr. */
int gearbox_open(gearbox *gearbox, const config *config);
void gearbox_close(gearbox *gearbox);

/* Notes what follows from the configuration and a reader of the output needs. */
void gearbox_note(const gearbox *gearbox, config *config);

/* The `--geometry` listing: `name = value` lines. */
void gearbox_print_geometry(const gearbox *gearbox, const config *config, FILE *stream);

#endif
