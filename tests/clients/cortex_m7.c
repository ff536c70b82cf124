/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Start of a Cortex-M7 without a system below it: vectors, floating point on, then newlib, which talks to the host by
 * semihosting. A fault ends the run with an error. */
#include <stdint.h>

extern uint32_t stack_top[];
void _start(void);

static void reset(void) {
    volatile uint32_t *access = (volatile uint32_t *)0xE000ED88; /* of coprocessors 10 and 11 */
    *access |= 0xFu << 20;
    __asm volatile("dsb\nisb");
    _start();
}

static void fault(void) {
    register uint32_t operation __asm("r0") = 0x18; /* exit */
    register uint32_t reason __asm("r1") = 0x20023; /* a run-time error */
    __asm volatile("bkpt 0xab" : : "r"(operation), "r"(reason) : "memory");
    for (;;) {
    }
}

__attribute__((section(".vectors"), used)) static const void *const vectors[16] = {
    stack_top,     (void *)reset, (void *)fault, (void *)fault,
    (void *)fault, (void *)fault, (void *)fault};
