/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* What --template prints. */
#ifndef APPS_KEY_TEMPLATE_H
#define APPS_KEY_TEMPLATE_H

#include "config.h"

/*
 * A parameter file with comments: every key, or those of a kind of analysis, which is a value of the keys that decide
 * what is used, such as "torque" or "static". It runs as it stands. Returns 0, or EXIT_BAD_INPUT or EXIT_RUN_FAILED after a
 * message with nothing printed.
 */
int key_template_print(const char *kind, FILE *stream, message_sink *messages);

#endif
