/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The `--geometry` listing of what follows from the drawing and the force law: `name = value` lines, or JSON. */
#ifndef APPS_GEOMETRY_LISTING_H
#define APPS_GEOMETRY_LISTING_H

#include "gear_mesh.h"

#include <stdio.h>

/* Names whose inputs are missing are left out. */
void geometry_print(const gear_mesh *mesh, const config *conf, int as_json, FILE *stream);

#endif
