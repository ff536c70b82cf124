/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Runs a program, lets one of its system calls fail, or sends it a signal there, and says how it ended.
 *
 *     inject REPORT WHAT AT PROGRAM [ARGUMENT]...
 *
 * WHAT is `count` (nothing happens), `error=ERRNO` (the call is not made and fails with this number; calls that map
 * memory fail with ENOMEM), `short` (a write takes a single byte) or `signal=NUMBER` (as the call begins). AT counts the
 * system calls from 1, beginning with the first fcntl(0, F_GETFD), with which the programs begin their work: what the
 * loader does before it does not count. REPORT gets a line for each call that counts, the name or the number of the
 * call, and a last line `exited CODE` or `killed SIGNAL`.
 *
 * Exits with 0, or 77 where this cannot be done.
 */
#define _GNU_SOURCE

#include <elf.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/user.h>
#include <sys/wait.h>
#include <unistd.h>

enum { CANNOT = 77 };

typedef struct fault {
    enum { NOTHING, FAIL, SHORT_WRITE, SEND } kind;
    int number; /* errno or signal */
    long at;
} fault;

/* ---------------------------------------------------------------------------------------------
 * Registers
 * ------------------------------------------------------------------------------------------- */

#if defined __x86_64__

/* No call has the number -1: the kernel does nothing, and its ENOSYS is replaced afterwards. */
static void skip_call(pid_t child) {
    struct user_regs_struct registers;

    ptrace(PTRACE_GETREGS, child, NULL, &registers);
    registers.orig_rax = (unsigned long long)-1;
    ptrace(PTRACE_SETREGS, child, NULL, &registers);
}

static void set_result(pid_t child, long result) {
    struct user_regs_struct registers;

    ptrace(PTRACE_GETREGS, child, NULL, &registers);
    registers.rax = (unsigned long long)result;
    ptrace(PTRACE_SETREGS, child, NULL, &registers);
}

static void set_size(pid_t child, long size) {
    struct user_regs_struct registers;

    ptrace(PTRACE_GETREGS, child, NULL, &registers);
    registers.rdx = (unsigned long long)size;
    ptrace(PTRACE_SETREGS, child, NULL, &registers);
}

#elif defined __aarch64__

static void skip_call(pid_t child) {
    int number = -1;
    struct iovec vector = {&number, sizeof number};

    ptrace(PTRACE_SETREGSET, child, (void *)(uintptr_t)NT_ARM_SYSTEM_CALL, &vector);
}

static void set_register(pid_t child, int index, long value) {
    struct user_regs_struct registers;
    struct iovec vector = {&registers, sizeof registers};

    ptrace(PTRACE_GETREGSET, child, (void *)(uintptr_t)NT_PRSTATUS, &vector);
    registers.regs[index] = (unsigned long long)value;
    ptrace(PTRACE_SETREGSET, child, (void *)(uintptr_t)NT_PRSTATUS, &vector);
}

static void set_result(pid_t child, long result) {
    set_register(child, 0, result);
}

static void set_size(pid_t child, long size) {
    set_register(child, 2, size);
}

#else
#error "inject knows the registers of x86-64 and AArch64 only"
#endif

/* ---------------------------------------------------------------------------------------------
 * System calls
 * ------------------------------------------------------------------------------------------- */

static const struct {
    uint64_t number;
    const char *name;
} names[] = {
    {SYS_write, "write"},
    {SYS_pwrite64, "pwrite"},
    {SYS_read, "read"},
    {SYS_pread64, "pread"},
    {SYS_openat, "open"},
    {SYS_close, "close"},
    {SYS_fsync, "fsync"},
    {SYS_ftruncate, "ftruncate"},
    {SYS_fallocate, "fallocate"},
    {SYS_flock, "flock"},
    {SYS_linkat, "link"},
    {SYS_unlinkat, "unlink"},
    {SYS_renameat, "rename"},
    {SYS_fcntl, "fcntl"},
    {SYS_dup, "dup"},
    {SYS_newfstatat, "stat"},
    {SYS_fstat, "fstat"},
    {SYS_faccessat, "access"},
    {SYS_readlinkat, "readlink"},
    {SYS_lseek, "lseek"},
    {SYS_mmap, "mmap"},
    {SYS_mremap, "mremap"},
    {SYS_munmap, "munmap"},
    {SYS_brk, "brk"},
    {SYS_exit_group, "exit"},
    {SYS_rt_sigaction, "sigaction"},
    {SYS_rt_sigreturn, "sigreturn"},
#ifdef __x86_64__
    {SYS_link, "link"},
    {SYS_unlink, "unlink"},
    {SYS_rename, "rename"},
    {SYS_access, "access"},
    {SYS_readlink, "readlink"},
    {SYS_stat, "stat"},
    {SYS_lstat, "stat"},
#endif
};

static const char *name_of(uint64_t number) {
    static char text[32];

    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        if (names[i].number == number) {
            return names[i].name;
        }
    }
    snprintf(text, sizeof text, "call %llu", (unsigned long long)number);
    return text;
}

static int error_of(const fault *what, uint64_t number) {
    return number == SYS_mmap || number == SYS_mremap ? ENOMEM : what->number;
}

/* What a call that fails comes back with: the kernel's brk has no error, but says where the heap ends. */
static long result_of(uint64_t number, int error) {
    return number == SYS_brk ? 0 : -error;
}

/* Two do not come back, or not to where they were called; the C library stops where the third one fails. */
static int can_fail(uint64_t number) {
    return number != SYS_exit_group && number != SYS_rt_sigreturn && number != SYS_futex;
}

/* Lets it happen as a call begins; returns whether it has to end with *result. */
static int begin_fault(pid_t child, const fault *what, uint64_t number, long *result) {
    if (what->kind == SEND) {
        kill(child, what->number);
    } else if (what->kind == SHORT_WRITE && (number == SYS_write || number == SYS_pwrite64)) {
        set_size(child, 1);
    } else if (what->kind == FAIL && can_fail(number)) {
        skip_call(child);
        *result = result_of(number, error_of(what, number));
        return 1;
    }
    return 0;
}

/* ---------------------------------------------------------------------------------------------
 * The run
 * ------------------------------------------------------------------------------------------- */

typedef struct following {
    long count; /* calls begun */
    int failing;
    long result; /* of the one that fails */
} following;

/* One stop at a system call: counts it as it begins, and gives it its error as it ends. */
static void at_call(pid_t child, const fault *what, following *state, FILE *report) {
    struct __ptrace_syscall_info info;

    memset(&info, 0, sizeof info);
    if (ptrace(PTRACE_GET_SYSCALL_INFO, child, (void *)sizeof info, &info) < 0) {
        exit(CANNOT);
    }
    if (info.op == PTRACE_SYSCALL_INFO_ENTRY) {
        const int is_first =
            info.entry.nr == SYS_fcntl && info.entry.args[0] == 0 && info.entry.args[1] == F_GETFD;
        if (state->count == 0 && !is_first) {
            return;
        }
        fprintf(report, "%s\n", name_of(info.entry.nr));
        state->failing =
            ++state->count == what->at && begin_fault(child, what, info.entry.nr, &state->result);
    } else if (info.op == PTRACE_SYSCALL_INFO_EXIT && state->failing) {
        set_result(child, state->result);
        state->failing = 0;
    }
}

static int follow(pid_t child, const fault *what, FILE *report) {
    following state = {0, 0, 0};
    int status, deliver = 0;

    if (waitpid(child, &status, 0) < 0 || !WIFSTOPPED(status)) {
        return CANNOT;
    }
    ptrace(PTRACE_SETOPTIONS, child, NULL, (void *)(PTRACE_O_TRACESYSGOOD | PTRACE_O_EXITKILL));
    for (;;) {
        ptrace(PTRACE_SYSCALL, child, NULL, (void *)(intptr_t)deliver);
        deliver = 0;
        if (waitpid(child, &status, 0) < 0) {
            return CANNOT;
        }
        if (WIFEXITED(status)) {
            fprintf(report, "exited %d\n", WEXITSTATUS(status));
            return 0;
        }
        if (WIFSIGNALED(status)) {
            fprintf(report, "killed %d\n", WTERMSIG(status));
            return 0;
        }
        if (WSTOPSIG(status) == (SIGTRAP | 0x80)) {
            at_call(child, what, &state, report);
        } else if (WSTOPSIG(status) != SIGTRAP) {
            deliver = WSTOPSIG(status);
        }
    }
}

static fault understand(const char *what, const char *at) {
    fault understood = {NOTHING, 0, atol(at)};

    if (sscanf(what, "error=%d", &understood.number) == 1) {
        understood.kind = FAIL;
    } else if (sscanf(what, "signal=%d", &understood.number) == 1) {
        understood.kind = SEND;
    } else if (strcmp(what, "short") == 0) {
        understood.kind = SHORT_WRITE;
    }
    return understood;
}

int main(int argc, char *argv[]) {
    if (argc < 5) {
        fprintf(stderr, "usage: inject REPORT WHAT AT PROGRAM [ARGUMENT]...\n");
        return 2;
    }
    const fault what = understand(argv[2], argv[3]);
    FILE *report = fopen(argv[1], "we");
    const pid_t child = report != NULL ? fork() : -1;

    if (child < 0) {
        perror(argv[1]);
        return 2;
    }
    if (child == 0) {
        if (ptrace(PTRACE_TRACEME, 0, NULL, NULL) < 0) {
            _exit(CANNOT);
        }
        execv(argv[4], argv + 4);
        _exit(CANNOT);
    }
    const int failed = follow(child, &what, report);
    return fclose(report) != 0 ? 2 : failed;
}
