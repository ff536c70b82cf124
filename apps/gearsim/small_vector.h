/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * The serial vector of SUNDIALS, with the operations of each step made for an even number of values: two or four.
 * Those of the package are made for millions; for two values their choice between cases costs more than the sums.
 */
#ifndef GEARSIM_SMALL_VECTOR_H
#define GEARSIM_SMALL_VECTOR_H

#include <nvector/nvector_serial.h>

/* NULL: out of memory. Clones have the same operations. */
N_Vector small_vector_create(sunindextype length, SUNContext context);

#endif
