/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* What the drawing of the gears says, [gears], and what is to be said of it. */
#ifndef APPS_DRAWING_H
#define APPS_DRAWING_H

#include "config.h"

/* Derives the pair, or one half of a double-helical one. Returns 0, or EXIT_BAD_INPUT after a message that names the key at fault. */
int drawing_derive(gm_pair *pair, const config *conf);

/* Warns of undercut, thin tips, small tip clearance, root fillets in contact, small contact ratio and negative backlash;
 * notes profile shifts that are rounded. */
void drawing_warn(const config *conf, const gm_pair *pair);

#endif
