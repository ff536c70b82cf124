/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "tool.h"

#include <stdio.h>

jmp_buf tool_return;
char tool_message[2000];

void ModelicaError(const char *text);

void ModelicaError(const char *text) {
    snprintf(tool_message, sizeof tool_message, "%s", text);
    longjmp(tool_return, 1);
}
