/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#define _XOPEN_SOURCE 700 /* SIGXCPU, flock's neighbours */

#include "exit_code.h"
#include "platform.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { FILE_MODE = 0666 /* as the umask allows */ };

/* ---------------------------------------------------------------------------------------------
 * The process
 * ------------------------------------------------------------------------------------------- */

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

/* What asks a process to end, or would end it. SIGQUIT stays the way to a core file. */
static const int watched[] = {SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGALRM, SIGUSR1, SIGUSR2};
enum { WATCHED_COUNT = sizeof watched / sizeof watched[0] };

static volatile sig_atomic_t requested;
static struct sigaction previous[WATCHED_COUNT];

static void request(int signal_number) {
    (void)signal_number;
    requested = 1;
}

void interrupt_watch(enum interrupt_second second) {
    /* SA_RESTART: a write is not cut short. SA_RESETHAND: the second signal finds the default again. */
    struct sigaction action = {.sa_handler = request, .sa_flags = SA_RESTART};
    if (second == SECOND_KILLS) {
        action.sa_flags |= (int)SA_RESETHAND;
    }
    sigemptyset(&action.sa_mask);

    requested = 0;
    for (int i = 0; i < WATCHED_COUNT; ++i) {
        sigaction(watched[i], NULL, &previous[i]);
        /* A signal that the caller had ignored (nohup, a background job) stays ignored. */
        if (previous[i].sa_handler != SIG_IGN) {
            sigaction(watched[i], &action, NULL);
        }
    }
}

void interrupt_unwatch(void) {
    for (int i = 0; i < WATCHED_COUNT; ++i) {
        sigaction(watched[i], &previous[i], NULL);
    }
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

static void *run_task(void *argument) {
    const thread_task *task = argument;
    task->work(task->of, task->which);
    return NULL;
}

void threads_run(int count, void (*work)(void *of, int which), void *of) {
    thread_task tasks[THREADS_MAX];
    pthread_t threads[THREADS_MAX];
    int started[THREADS_MAX] = {0};

    /* Signals are for the thread of main(). */
    sigset_t all, before;
    sigfillset(&all);
    (void)pthread_sigmask(SIG_SETMASK, &all, &before);
    for (int k = 1; k < count; ++k) {
        tasks[k] = (thread_task){work, of, k};
        started[k] = pthread_create(&threads[k], NULL, run_task, &tasks[k]) == 0;
    }
    (void)pthread_sigmask(SIG_SETMASK, &before, NULL);

    /* Here: the first one, and those that got no thread. */
    for (int k = 0; k < count; ++k) {
        if (!started[k]) {
            work(of, k);
        }
    }
    for (int k = 1; k < count; ++k) {
        if (started[k]) {
            (void)pthread_join(threads[k], NULL);
        }
    }
}

double wall_clock(void) {
    struct timespec time;

    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

int is_terminal(FILE *stream) {
    return isatty(fileno(stream));
}

/* ---------------------------------------------------------------------------------------------
 * Paths
 * ------------------------------------------------------------------------------------------- */

size_t path_name_start(const char *path) {
    const char *slash = strrchr(path, '/');

    return slash == NULL ? 0 : (size_t)(slash - path) + 1;
}

int path_is_absolute(const char *path) {
    return *path == '/';
}

int is_same_name(const char *a, const char *b) {
    return strcmp(a, b) == 0;
}

static int is_same_status(const struct stat *a, const struct stat *b) {
    return a->st_dev == b->st_dev && a->st_ino == b->st_ino;
}

int is_same_file(const char *a, const char *b) {
    struct stat status_a, status_b;

    if (strcmp(a, b) == 0) {
        return 1;
    }
    return stat(a, &status_a) == 0 && stat(b, &status_b) == 0 &&
           is_same_status(&status_a, &status_b);
}

int path_read_link(const char *path, char *text, size_t size) {
    const ssize_t length = readlink(path, text, size - 1);

    if (length < 0) {
        return 0;
    }
    text[length] = '\0';
    return 1;
}

enum path_kind path_kind(const char *path) {
    struct stat status;

    if (lstat(path, &status) != 0) {
        return errno == ENOENT ? PATH_NOTHING : PATH_UNKNOWN;
    }
    return S_ISLNK(status.st_mode) ? PATH_LINK : PATH_TAKEN;
}

int folder_refusal(const char *folder) {
    return access(folder, W_OK | X_OK) == 0 ? 0 : errno;
}

/* ---------------------------------------------------------------------------------------------
 * Files that become results
 * ------------------------------------------------------------------------------------------- */

int file_create(const char *path) {
    return open(path, O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, FILE_MODE);
}

int file_open_old(const char *path) {
    return open(path, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
}

int file_duplicate(int descriptor) {
    return fcntl(descriptor, F_DUPFD_CLOEXEC, 0);
}

int file_lock(int descriptor) {
    int failed;

    do {
        failed = flock(descriptor, LOCK_EX | LOCK_NB);
    } while (failed != 0 && errno == EINTR);
    return failed != 0 && errno == EWOULDBLOCK ? -1 : 0;
}

int file_is_at(const char *path, int descriptor) {
    struct stat at_path, opened;

    if (lstat(path, &at_path) != 0) {
        return errno == ENOENT ? 0 : -1;
    }
    if (fstat(descriptor, &opened) != 0) {
        return -1;
    }
    return is_same_status(&at_path, &opened);
}

/* Some file systems have nothing to bring to the disk, or no way to. */
int file_sync(int descriptor) {
    return fsync(descriptor) == 0 || errno == EINVAL || errno == ENOTSUP || errno == ENOSYS ||
                   errno == EROFS
               ? 0
               : errno;
}

/* A folder that may not be read cannot be told to. */
int folder_sync(const char *folder) {
    const int opened = open(folder, O_RDONLY | O_CLOEXEC);

    if (opened < 0) {
        return 0;
    }
    const int error = file_sync(opened);
    close(opened);
    return error;
}

int file_rename(const char *path, const char *name) {
    return rename(path, name) == 0 ? 0 : errno;
}

int file_link(const char *path, const char *name) {
    return link(path, name) == 0 ? 0 : errno;
}
