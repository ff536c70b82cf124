/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file measured_table.h
 * What the readers of traces and of measured pitch share: the columns for tooth and flank.
 */
#ifndef GEARMESH_MEASURED_TABLE_H
#define GEARMESH_MEASURED_TABLE_H

#include "files/table_reader.h"

/** The first columns of both kinds of files. */
enum { GMI_COLUMN_TOOTH = 0, GMI_COLUMN_FLANK = 1 };

/** Reads tooth number and flank of a row, as the machine names them. */
int gmi_measured_place(const gmi_table *table, int *tooth, int *flank);

/** Says that a file has no rows. */
int gmi_measured_fail_empty(const gmi_table *table);

#endif /* GEARMESH_MEASURED_TABLE_H */
