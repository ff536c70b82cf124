/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * One evaluation of elastic teeth once more, for processors with vectors of four doubles; wide.h says when and how.
 */
#define GMI_IN_WIDE
#include "wide.h"

#include "gearmesh/gearmesh.h"

#include <float.h>
#include <limits.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#if GMI_HAS_WIDE

/* By these an evaluation is entered ... */
#define gmi_elastic_place                    gmi_wide_place
#define gmi_elastic_edges_add                gmi_wide_edges_add
#define gmi_elastic_set_material             gmi_wide_set_material
#define gmi_elastic_solve                    gmi_wide_solve
#define gmi_elastic_differentiate            gmi_wide_differentiate
#define gmi_elastic_differentiate_functional gmi_wide_differentiate_functional

/* ... and these are steps of it. */
#define gmi_corner_gaps         gmi_wide_corner_gaps
#define gmi_elastic_approach    gmi_wide_approach
#define gmi_elastic_factor      gmi_wide_factor
#define gmi_elastic_find_runs   gmi_wide_find_runs
#define gmi_elastic_follow      gmi_wide_follow
#define gmi_elastic_gather      gmi_wide_gather
#define gmi_elastic_load        gmi_wide_load
#define gmi_elastic_pull        gmi_wide_pull
#define gmi_elastic_stiffen     gmi_wide_stiffen
#define gmi_elastic_substitute  gmi_wide_substitute
#define gmi_surface_add_ramps   gmi_wide_surface_add_ramps
#define gmi_surface_add_tables  gmi_wide_surface_add_tables
#define gmi_surface_add_tilt    gmi_wide_surface_add_tilt
#define gmi_surface_hold_tables gmi_wide_surface_hold_tables

#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
/* Packing scalars into vectors takes more instructions than it saves, and some that valgrind does not know. */
#pragma GCC optimize("no-tree-slp-vectorize")
#endif

/* From here on all is for AVX2, what headers define as well: or it is not inlined. */
#include "internal.h"

#include "corner.c"
#include "elastic_corner.c"
#include "elastic_gradient.c"
#include "elastic_material.c"
#include "elastic_points.c"
#include "elastic_solve.c"
#include "surface.c"

/* These name types as the others name variables. */
#include "elastic_place.c"

#include "elastic_front.c"

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

#endif
