/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The `--geometry` listing: `name = value` lines of what follows from the drawing and the force law. */
#ifndef APPS_GEOMETRY_LISTING_H
#define APPS_GEOMETRY_LISTING_H

#include "gear_mesh.h"

#include <stdio.h>

/* Lines whose inputs are missing are left out. */
void geometry_print(const gear_mesh *mesh, const config *conf, FILE *stream);

#endif
