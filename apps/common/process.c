/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "process.h"
#include "exit_code.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

/*
 * Opened the wrong way round, so that reading and writing fail as with a closed descriptor: a text that nobody gets
 * must not count as written.
 */
static int hold_descriptor(int descriptor) {
    if (fcntl(descriptor, F_GETFD) != -1 || errno != EBADF) {
        return EXIT_DONE;
    }
    /* The lowest number that is free, which is this one. */
    return open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY) == descriptor
               ? EXIT_DONE
               : EXIT_RUN_FAILED;
}

int process_prepare(void) {
    for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor) {
        if (hold_descriptor(descriptor) != EXIT_DONE) {
            return EXIT_RUN_FAILED;
        }
    }

#ifdef SIGXFSZ
    (void)signal(SIGXFSZ, SIG_IGN);
#endif
    (void)signal(SIGPIPE, SIG_IGN);
    return EXIT_DONE;
}
