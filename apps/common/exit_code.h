/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* How the programs end; functions that can fail return one of these. */
#ifndef APPS_EXIT_CODE_H
#define APPS_EXIT_CODE_H

enum exit_code {
    EXIT_DONE = 0,
    EXIT_RUN_FAILED = 1, /* the solver, the disk, memory */
    EXIT_BAD_INPUT = 2,  /* the command line, a file */
    EXIT_INTERRUPTED = 130
};

#endif
