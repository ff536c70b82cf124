/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The side of a Modelica tool in the test: its errors do not return to where they are told. */
#ifndef TOOL_H
#define TOOL_H

#include <setjmp.h>

extern jmp_buf tool_return; /* set by setjmp() before a call that may be refused */
extern char tool_message[2000];

#endif
