/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Windows by mingw-w64, tested under Wine. A file that becomes a result is shared for all: others may read, rename and
 * remove it while it is open here. Symbolic links are not followed by name: a result replaces the link.
 */
#include "exit_code.h"
#include "platform.h"

#include <errno.h>
#include <fcntl.h>
#include <io.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <windows.h>

/* The errno of the last failure, as far as the programs tell them apart. */
static int last_error(void) {
    switch (GetLastError()) {
    case ERROR_FILE_NOT_FOUND:
    case ERROR_PATH_NOT_FOUND:
    case ERROR_INVALID_NAME:
        return ENOENT;
    case ERROR_FILE_EXISTS:
    case ERROR_ALREADY_EXISTS:
        return EEXIST;
    case ERROR_ACCESS_DENIED:
    case ERROR_SHARING_VIOLATION:
    case ERROR_LOCK_VIOLATION:
    case ERROR_WRITE_PROTECT:
        return EACCES;
    case ERROR_HANDLE_DISK_FULL:
    case ERROR_DISK_FULL:
        return ENOSPC;
    default:
        return EIO;
    }
}

static HANDLE handle_of(int descriptor) {
    return (HANDLE)_get_osfhandle(descriptor);
}

/* ---------------------------------------------------------------------------------------------
 * The process
 * ------------------------------------------------------------------------------------------- */

/* The C library keeps the first three descriptors for itself, and no write kills. */
int process_prepare(void) {
    _fmode = _O_BINARY;
    (void)_setmode(_fileno(stdin), _O_BINARY);
    (void)_setmode(_fileno(stdout), _O_BINARY);
    return EXIT_DONE;
}

static volatile LONG requested;
static enum interrupt_second second_request;

/* Called in a thread of its own; FALSE leaves the rest to the system, which kills. */
static BOOL WINAPI request(DWORD event) {
    const LONG was_requested = InterlockedExchange(&requested, 1);

    if (was_requested && second_request == SECOND_KILLS) {
        return FALSE;
    }
    /* When a window closes or the session ends, the process is let live only as long as this lasts. */
    if (event != CTRL_C_EVENT && event != CTRL_BREAK_EVENT) {
        Sleep(INFINITE);
    }
    return TRUE;
}

void interrupt_watch(enum interrupt_second second) {
    second_request = second;
    InterlockedExchange(&requested, 0);
    SetConsoleCtrlHandler(request, TRUE);
}

void interrupt_unwatch(void) {
    SetConsoleCtrlHandler(request, FALSE);
}

int interrupt_requested(void) {
    return requested != 0;
}

/* One call of many. */
typedef struct thread_task {
    void (*work)(void *of, int which);
    void *of;
    int which;
} thread_task;

static DWORD WINAPI run_task(void *argument) {
    const thread_task *task = argument;
    task->work(task->of, task->which);
    return 0;
}

void threads_run(int count, void (*work)(void *of, int which), void *of) {
    thread_task tasks[THREADS_MAX];
    HANDLE threads[THREADS_MAX] = {NULL};

    for (int k = 1; k < count; ++k) {
        tasks[k] = (thread_task){work, of, k};
        threads[k] = CreateThread(NULL, 0, run_task, &tasks[k], 0, NULL);
    }

    /* Here: the first one, and those that got no thread. */
    for (int k = 0; k < count; ++k) {
        if (threads[k] == NULL) {
            work(of, k);
        }
    }
    for (int k = 1; k < count; ++k) {
        if (threads[k] != NULL) {
            (void)WaitForSingleObject(threads[k], INFINITE);
            (void)CloseHandle(threads[k]);
        }
    }
}

double wall_clock(void) {
    LARGE_INTEGER count, frequency;

    QueryPerformanceCounter(&count);
    QueryPerformanceFrequency(&frequency);
    return (double)count.QuadPart / (double)frequency.QuadPart;
}

int is_terminal(FILE *stream) {
    HANDLE console = handle_of(_fileno(stream));
    DWORD mode;

    return GetConsoleMode(console, &mode) &&
           SetConsoleMode(console, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING);
}

/* ---------------------------------------------------------------------------------------------
 * Paths
 * ------------------------------------------------------------------------------------------- */

static int is_separator(char c) {
    return c == '/' || c == '\\' || c == ':';
}

size_t path_name_start(const char *path) {
    size_t start = strlen(path);

    while (start > 0 && !is_separator(path[start - 1])) {
        --start;
    }
    return start;
}

int path_is_absolute(const char *path) {
    return is_separator(path[0]) || (path[0] != '\0' && path[1] == ':');
}

int is_same_name(const char *a, const char *b) {
    return _stricmp(a, b) == 0;
}

/* Which file it is; 0 with errno if it cannot be told. */
static int identify(const char *path, BY_HANDLE_FILE_INFORMATION *file) {
    HANDLE opened = CreateFileA(path, 0, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE,
                                NULL, OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, NULL);
    if (opened == INVALID_HANDLE_VALUE) {
        errno = last_error();
        return 0;
    }
    const BOOL found = GetFileInformationByHandle(opened, file);
    errno = found ? 0 : last_error();
    CloseHandle(opened);
    return found;
}

static int is_same(const BY_HANDLE_FILE_INFORMATION *a, const BY_HANDLE_FILE_INFORMATION *b) {
    return a->dwVolumeSerialNumber == b->dwVolumeSerialNumber &&
           a->nFileIndexHigh == b->nFileIndexHigh && a->nFileIndexLow == b->nFileIndexLow;
}

int is_same_file(const char *a, const char *b) {
    BY_HANDLE_FILE_INFORMATION file_a, file_b;

    if (strcmp(a, b) == 0) {
        return 1;
    }
    return identify(a, &file_a) && identify(b, &file_b) && is_same(&file_a, &file_b);
}

int path_read_link(const char *path, char *text, size_t size) {
    (void)path;
    (void)text;
    (void)size;
    return 0;
}

enum path_kind path_kind(const char *path) {
    const DWORD attributes = GetFileAttributesA(path);

    if (attributes == INVALID_FILE_ATTRIBUTES) {
        return last_error() == ENOENT ? PATH_NOTHING : PATH_UNKNOWN;
    }
    return attributes & FILE_ATTRIBUTE_REPARSE_POINT ? PATH_LINK : PATH_TAKEN;
}

int folder_refusal(const char *folder) {
    const DWORD attributes = GetFileAttributesA(folder);

    if (attributes == INVALID_FILE_ATTRIBUTES) {
        return last_error();
    }
    return attributes & FILE_ATTRIBUTE_DIRECTORY ? 0 : ENOTDIR;
}

/* ---------------------------------------------------------------------------------------------
 * Files that become results
 * ------------------------------------------------------------------------------------------- */

static int open_shared(const char *path, DWORD how) {
    HANDLE opened = CreateFileA(path, GENERIC_READ | GENERIC_WRITE,
                                FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, NULL, how,
                                FILE_ATTRIBUTE_NORMAL, NULL);
    if (opened == INVALID_HANDLE_VALUE) {
        errno = last_error();
        return -1;
    }
    return _open_osfhandle((intptr_t)opened, _O_RDWR | _O_BINARY | _O_NOINHERIT);
}

int file_create(const char *path) {
    return open_shared(path, CREATE_NEW);
}

int file_open_old(const char *path) {
    return open_shared(path, OPEN_EXISTING);
}

int file_duplicate(int descriptor) {
    return _dup(descriptor);
}

/* Of a byte far behind all others, as locked bytes cannot be read by others. */
int file_lock(int descriptor) {
    OVERLAPPED place = {.OffsetHigh = 0x7fffffff};

    const BOOL locked =
        LockFileEx(handle_of(descriptor), LOCKFILE_EXCLUSIVE_LOCK | LOCKFILE_FAIL_IMMEDIATELY, 0, 1,
                   0, &place);
    return !locked && GetLastError() == ERROR_LOCK_VIOLATION ? -1 : 0;
}

int file_is_at(const char *path, int descriptor) {
    BY_HANDLE_FILE_INFORMATION at_path, opened;

    if (!identify(path, &at_path)) {
        return errno == ENOENT ? 0 : -1;
    }
    if (!GetFileInformationByHandle(handle_of(descriptor), &opened)) {
        errno = last_error();
        return -1;
    }
    return is_same(&at_path, &opened);
}

int file_sync(int descriptor) {
    return FlushFileBuffers(handle_of(descriptor)) ? 0 : last_error();
}

/* Done by file_rename(). */
int folder_sync(const char *folder) {
    (void)folder;
    return 0;
}

int file_rename(const char *path, const char *name) {
    return MoveFileExA(path, name, MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH)
               ? 0
               : last_error();
}

int file_link(const char *path, const char *name) {
    return CreateHardLinkA(name, path, NULL) ? 0 : last_error();
}
