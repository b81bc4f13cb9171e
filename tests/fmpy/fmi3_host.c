/* A host for units of FMI 3.0: loads a library, moves one input, prints a force of three elements after each step with
   17 digits.

       host LIBRARY RESOURCES TOKEN INPUT FORCE STEPS LENGTH STRIDE

   INPUT and FORCE are value references. Before step n the input is n times STRIDE. */

#include <dlfcn.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

typedef void (*logger)(void *, int, const char *, const char *);

static void say(void *environment, int status, const char *category, const char *message) {
    (void)environment;
    fprintf(stderr, "%d %s: %s\n", status, category, message);
}

static void *symbol(void *library, const char *name) {
    void *found = dlsym(library, name);
    if (!found) {
        fprintf(stderr, "%s is missing\n", name);
        exit(2);
    }
    return found;
}

static void must(const char *name, int status) {
    if (status != 0) {
        fprintf(stderr, "%s returned %d\n", name, status);
        exit(1);
    }
}

/* A function of the library under its own name: POSIX has data and functions alike behind dlsym. */
#define FUNCTION(result, name, ...) \
    result (*name)(__VA_ARGS__);    \
    *(void **)&name = symbol(library, #name)

int main(int count, char **words) {
    if (count != 9) {
        fprintf(stderr, "expected 8 arguments, found %d\n", count - 1);
        return 2;
    }
    void *library = dlopen(words[1], RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        fprintf(stderr, "%s\n", dlerror());
        return 2;
    }
    FUNCTION(void *, fmi3InstantiateCoSimulation, const char *, const char *, const char *, bool, bool, bool, bool,
             const uint32_t *, size_t, void *, logger, void *);
    FUNCTION(int, fmi3EnterInitializationMode, void *, bool, double, double, bool, double);
    FUNCTION(int, fmi3ExitInitializationMode, void *);
    FUNCTION(int, fmi3SetFloat64, void *, const uint32_t *, size_t, const double *, size_t);
    FUNCTION(int, fmi3GetFloat64, void *, const uint32_t *, size_t, double *, size_t);
    FUNCTION(int, fmi3DoStep, void *, double, double, bool, bool *, bool *, bool *, double *);
    FUNCTION(int, fmi3Terminate, void *);
    FUNCTION(void, fmi3FreeInstance, void *);

    uint32_t input = (uint32_t)atoi(words[4]), force = (uint32_t)atoi(words[5]);
    int steps = atoi(words[6]);
    double length = atof(words[7]), stride = atof(words[8]), time = 0.0;
    void *unit = fmi3InstantiateCoSimulation("unit", words[3], words[2], false, false, false, false, NULL, 0, NULL, say, NULL);
    if (!unit) return 1;
    must("fmi3EnterInitializationMode", fmi3EnterInitializationMode(unit, false, 0.0, 0.0, false, 0.0));
    must("fmi3ExitInitializationMode", fmi3ExitInitializationMode(unit));
    for (int step = 1; step <= steps; step++) {
        double moved = stride * step, forces[3], reached;
        bool event = true, end = true, early = true;
        must("fmi3SetFloat64", fmi3SetFloat64(unit, &input, 1, &moved, 1));
        must("fmi3DoStep", fmi3DoStep(unit, time, length, true, &event, &end, &early, &reached));
        if (event || end || early) return 1;
        time = reached;
        must("fmi3GetFloat64", fmi3GetFloat64(unit, &force, 1, forces, 3));
        printf("%.17g %.17g %.17g\n", forces[0], forces[1], forces[2]);
    }
    must("fmi3Terminate", fmi3Terminate(unit));
    fmi3FreeInstance(unit);
    dlclose(library);
    return 0;
}
