/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * What the evaluations of the loop of fixed steps cost on a Cortex-M7: instructions and stack of each, linked around
 * libgearmesh/examples/fixed_step.c by --wrap. QEMU with `-icount shift=0` takes one unit of time for each instruction; the
 * system timer, which runs slower, is held against a loop of known length. Prints one line for each law:
 *
 *     LAW: N evaluations, MEAN LARGEST instructions, STACK bytes of stack
 */
#include <gearmesh/gearmesh.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

enum { LAWS = 2, STACK_LOOKED_AT = 32768, TIMER_RANGE = 0x1000000 };

static const uint32_t untouched = 0x5AA5F00D;
static volatile uint32_t *const timer =
    (volatile uint32_t *)0xE000E010; /* control, reload, value */

static struct {
    unsigned count;
    uint64_t sum;
    uint32_t largest;
    uint32_t stack;
} law[LAWS];
static double instructions_per_tick;

static void __attribute__((noinline)) known_loop(uint32_t turns) {
    __asm volatile("1: subs %0, #1\n bne 1b" : "+r"(turns) : : "cc");
}

static uint32_t ticks_since(uint32_t then) {
    return (then - timer[2]) % TIMER_RANGE; /* it counts down */
}

static void print(void) {
    static const char *const name[LAWS] = {"constant", "elastic"};
    for (int k = 0; k < LAWS; ++k) {
        printf("%s: %u evaluations, %.0f %.0f instructions, %u bytes of stack\n", name[k],
               law[k].count, instructions_per_tick * (double)law[k].sum / law[k].count,
               instructions_per_tick * law[k].largest, (unsigned)law[k].stack);
    }
}

static void begin(void) {
    const uint32_t turns = 1000000;
    timer[1] = TIMER_RANGE - 1;
    timer[2] = 0;
    timer[0] = 5; /* on, at the clock of the processor */
    const uint32_t then = timer[2];
    known_loop(turns);
    instructions_per_tick = 2.0 * turns / ticks_since(then);
    atexit(print);
}

int __real_gm_mesh_evaluate_at(const gm_mesh *mesh, const gm_position *position, int wanted,
                               gm_workspace *workspace, gm_mesh_result *result);
int __wrap_gm_mesh_evaluate_at(const gm_mesh *mesh, const gm_position *position, int wanted,
                               gm_workspace *workspace, gm_mesh_result *result);

int __wrap_gm_mesh_evaluate_at(const gm_mesh *mesh, const gm_position *position, int wanted,
                               gm_workspace *workspace, gm_mesh_result *result) {
    const int k = workspace != NULL;
    if (instructions_per_tick == 0.0) {
        begin();
    }

    /* Below this function the stack is marked, and looked at again. */
    uint32_t *here;
    __asm volatile("mov %0, sp" : "=r"(here));
    uint32_t *deepest = here - STACK_LOOKED_AT / sizeof *here;
    for (uint32_t *mark = deepest; mark < here; ++mark) {
        *mark = untouched;
    }
    const uint32_t then = timer[2];
    const int status = __real_gm_mesh_evaluate_at(mesh, position, wanted, workspace, result);
    const uint32_t ticks = ticks_since(then);
    while (deepest < here && *deepest == untouched) {
        ++deepest;
    }

    const uint32_t stack = (uint32_t)((char *)here - (char *)deepest);
    law[k].stack = stack > law[k].stack ? stack : law[k].stack;
    law[k].largest = ticks > law[k].largest ? ticks : law[k].largest;
    law[k].sum += ticks;
    ++law[k].count;
    return status;
}
