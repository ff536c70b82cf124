/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Columns that files of traces and of measured pitch have in common. */

#include "measured_table.h"

#include "files/io_error.h"

int gmi_measured_place(const gmi_table *table, int *tooth, int *flank) {
    static const char *const words[] = {"drive", "coast", "left", "right"}; /* by their numbers */
    const int status = gmi_table_whole(table, GMI_COLUMN_TOOTH, tooth);
    return status == GM_IO_OK ? gmi_table_word(table, GMI_COLUMN_FLANK, words, 4, flank) : status;
}

int gmi_measured_fail_empty(const gmi_table *table) {
    return gmi_error_set(table->error, GM_IO_ERR_FORMAT, table->line,
                         "there must be rows of what was measured below the header (got none)");
}
