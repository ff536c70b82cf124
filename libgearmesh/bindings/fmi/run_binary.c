/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Loads the binary of GearPair.fmu (FMI 2.0, co-simulation) and runs it: a hundred steps of 0.1 ms between 25 and 20 N m.
 * Prints x in um after each. For systems on which no importer is at hand.
 *
 *     run_binary GearPair.so|GearPair.dll TOKEN
 */
#include <fmi2FunctionTypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#include <windows.h>
#else
#include <dlfcn.h>
#endif

typedef void (*function)(void);

static void stop(const char *what) {
    fprintf(stderr, "run_binary: %s\n", what);
    exit(1);
}

/* A function of the binary; the program ends where there is none. */
static function find(const char *path, const char *name) {
    function found = NULL;
#ifdef _WIN32
    HMODULE binary = LoadLibraryA(path);
    found = binary != NULL ? (function)(void *)GetProcAddress(binary, name) : NULL;
#else
    void *binary = dlopen(path, RTLD_NOW);
    void *symbol = binary != NULL ? dlsym(binary, name) : NULL;
    memcpy(&found, &symbol, sizeof found); /* POSIX has them in one place */
#endif
    if (found == NULL) {
        stop(name);
    }
    return found;
}

static void say(fmi2ComponentEnvironment environment, fmi2String instance, fmi2Status status,
                fmi2String category, fmi2String message, ...) {
    (void)environment;
    (void)status;
    (void)category;
    va_list values;
    va_start(values, message);
    fprintf(stderr, "%s: ", instance);
    vfprintf(stderr, message, values);
    fputc('\n', stderr);
    va_end(values);
}

static void need(fmi2Status status, const char *what) {
    if (status != fmi2OK) {
        stop(what);
    }
}

int main(int argc, char **argv) {
    if (argc != 3) {
        stop("needs a binary and the token of its description");
    }
#define FIND(name) ((name##TYPE *)find(argv[1], #name))
    static const fmi2CallbackFunctions callbacks = {say, calloc, free, NULL, NULL};
    fmi2Component pair = FIND(fmi2Instantiate)("gears", fmi2CoSimulation, argv[2], "", &callbacks,
                                               fmi2False, fmi2False);
    if (pair == NULL) {
        stop("instantiation was refused");
    }

    /* References are places in the table of gear_pair.c: inputs, then the state x. */
    const fmi2ValueReference torques[] = {1, 2};
    const fmi2ValueReference offset[] = {5};
    const fmi2Real torque[] = {25.0, 20.0};
    double x[] = {53e-6};
    const double step = 1e-4;
    need(FIND(fmi2SetupExperiment)(pair, fmi2True, 1e-8, 0.0, fmi2False, 0.0), "setup");
    need(FIND(fmi2SetReal)(pair, torques, 2, torque), "torques");
    need(FIND(fmi2SetReal)(pair, offset, 1, x), "start");
    need(FIND(fmi2EnterInitializationMode)(pair), "initialization");
    need(FIND(fmi2ExitInitializationMode)(pair), "end of initialization");
    for (int n = 0; n < 100; ++n) {
        need(FIND(fmi2DoStep)(pair, n * step, step, fmi2True), "step");
        need(FIND(fmi2GetReal)(pair, offset, 1, x), "x");
        printf("%.9f\n", 1e6 * x[0]);
    }
    need(FIND(fmi2Terminate)(pair), "end");
    FIND(fmi2FreeInstance)(pair);
    return 0;
}
