/* What calls of a unit cost. Built and called by unit_cost.py:  unit_cost LIBRARY RESOURCES GUID STEP COUNT OUTPUT [MANY [LENGTH]]
 *
 * With a LENGTH: does nothing but COUNT time steps, so many in each call, for who counts from outside.
 *
 * Writes lines of "name value": least processor time of each call over the repeats [us], of a value read [ns], bytes,
 * kB. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef struct {
    void (*logger)(void *, const char *, int, const char *, const char *, ...);
    void *(*allocate)(size_t, size_t);
    void (*free)(void *);
    void (*finished)(void *, int);
    void *environment;
} Callbacks;

static void told(void *environment, const char *name, int status, const char *category, const char *message, ...) {
    (void)environment, (void)name, (void)category;
    fprintf(stderr, "status %d: %s\n", status, message);
}

/* Processor time of all threads: a busy machine does not count. */
static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return time.tv_sec + 1e-9 * time.tv_nsec;
}

static long memory(const char *key) { /* [kB] */
    char line[256];
    long found = 0;
    FILE *file = fopen("/proc/self/status", "r");
    while (file && fgets(line, sizeof line, file))
        if (!strncmp(line, key, strlen(key))) found = atol(line + strlen(key) + 1);
    if (file) fclose(file);
    return found;
}

#define FUNCTION(result, name, ...) result (*name)(__VA_ARGS__) = (result(*)(__VA_ARGS__))dlsym(library, #name)
#define DEMAND(call) \
    if (call) { fprintf(stderr, "%s failed\n", #call); exit(1); }
#define LEAST(variable, action) \
    do { double begun = now(); action; double took = now() - begun; if (took < variable) variable = took; } while (0)

enum { VALUES = 10000, REPEATS = 5, PIECES = 20, STATES = 30 };

int main(int count, char **arguments) {
    if (count < 7) return 2;
    void *library = dlopen(arguments[1], RTLD_NOW | RTLD_LOCAL);
    if (!library) { fprintf(stderr, "%s\n", dlerror()); return 1; }
    char location[4096];
    snprintf(location, sizeof location, "file://%s", arguments[2]);
    const double step = atof(arguments[4]);
    const long steps = atol(arguments[5]);
    const unsigned output = (unsigned)atol(arguments[6]);
    FUNCTION(void *, fmi2Instantiate, const char *, int, const char *, const char *, Callbacks *, int, int);
    FUNCTION(int, fmi2SetupExperiment, void *, int, double, double, int, double);
    FUNCTION(int, fmi2EnterInitializationMode, void *);
    FUNCTION(int, fmi2ExitInitializationMode, void *);
    FUNCTION(int, fmi2DoStep, void *, double, double, int);
    FUNCTION(int, fmi2GetReal, void *, const unsigned *, size_t, double *);
    FUNCTION(int, fmi2GetFMUstate, void *, void **);
    FUNCTION(int, fmi2SetFMUstate, void *, void *);
    FUNCTION(int, fmi2FreeFMUstate, void *, void **);
    FUNCTION(int, fmi2SerializedFMUstateSize, void *, void *, size_t *);
    FUNCTION(int, fmi2SerializeFMUstate, void *, void *, char *, size_t);
    FUNCTION(int, fmi2DeSerializeFMUstate, void *, const char *, size_t, void **);
    FUNCTION(void, fmi2FreeInstance, void *);

    Callbacks callbacks = {told, calloc, free, 0, 0};
    double least = 1e9;
    void *unit = 0;
    LEAST(least, unit = fmi2Instantiate("unit", 1, arguments[3], location, &callbacks, 0, 0));
    if (!unit) return 1;
    printf("instantiate %.3f\n", least * 1e6);
    DEMAND(fmi2SetupExperiment(unit, 0, 0, 0, 0, 0));
    DEMAND(fmi2EnterInitializationMode(unit));
    DEMAND(fmi2ExitInitializationMode(unit));

    const int only = count > 8 ? atoi(arguments[8]) : 0;
    if (only) {
        for (long call = 0; call < steps / only; call++) DEMAND(fmi2DoStep(unit, call * only * step, only * step, 0));
        fmi2FreeInstance(unit);
        return 0;
    }

    long done = 0;
    const int lengths[] = {1, 10, 100};
    double of_length[] = {1e9, 1e9, 1e9};
    for (; done < steps / 10; done++) DEMAND(fmi2DoStep(unit, done * step, step, 0));
    for (int repeat = 0; repeat < REPEATS * PIECES; repeat++)
        for (int which = 0; which < 3; which++) {
            const int length = lengths[which];
            const long calls = steps / PIECES / length > 0 ? steps / PIECES / length : 1;
            const double begun = now();
            for (long call = 0; call < calls; call++, done += length)
                DEMAND(fmi2DoStep(unit, done * step, length * step, 0));
            const double took = (now() - begun) / calls;
            if (took < of_length[which]) of_length[which] = took;
        }
    for (int which = 0; which < 3; which++) printf("step_%d %.4f\n", lengths[which], of_length[which] * 1e6);

    static unsigned references[VALUES];
    static double values[VALUES];
    for (int place = 0; place < VALUES; place++) references[place] = output;
    least = 1e9;
    for (int repeat = 0; repeat < STATES; repeat++) LEAST(least, DEMAND(fmi2GetReal(unit, references, VALUES, values)));
    printf("value %.3f\n", least * 1e9 / VALUES);
    least = 1e9;
    for (int repeat = 0; repeat < 1000; repeat++) LEAST(least, DEMAND(fmi2GetReal(unit, references, 1, values)));
    printf("read_one %.4f\n", least * 1e6);

    double get = 1e9, again = 1e9, set = 1e9, to_bytes = 1e9, from_bytes = 1e9;
    size_t size = 0;
    char *bytes = 0;
    void *kept = 0;
    for (int repeat = 0; repeat < STATES; repeat++) {
        void *state = 0, *other = 0;
        LEAST(get, DEMAND(fmi2GetFMUstate(unit, &state)));
        LEAST(again, DEMAND(fmi2GetFMUstate(unit, &kept)));
        LEAST(set, DEMAND(fmi2SetFMUstate(unit, state)));
        LEAST(to_bytes, DEMAND(fmi2SerializedFMUstateSize(unit, state, &size));
              if (!bytes) bytes = malloc(size); DEMAND(fmi2SerializeFMUstate(unit, state, bytes, size)));
        LEAST(from_bytes, DEMAND(fmi2DeSerializeFMUstate(unit, bytes, size, &other)));
        DEMAND(fmi2FreeFMUstate(unit, &state));
        DEMAND(fmi2FreeFMUstate(unit, &other));
    }
    printf("get_state %.2f\nget_state_again %.2f\nset_state %.2f\nserialize %.2f\ndeserialize %.2f\nbytes %zu\n", get * 1e6,
           again * 1e6, set * 1e6, to_bytes * 1e6, from_bytes * 1e6, size);
    fmi2FreeInstance(unit);

    /* units that come and go, steps made, with the threads that the scene asks for */
    const int many = count > 7 ? atoi(arguments[7]) : 0;
    long early = 0;
    for (int number = 0; number < many; number++) {
        unit = fmi2Instantiate("unit", 1, arguments[3], location, &callbacks, 0, 0);
        if (!unit) return 1;
        DEMAND(fmi2SetupExperiment(unit, 0, 0, 0, 0, 0));
        DEMAND(fmi2EnterInitializationMode(unit));
        DEMAND(fmi2ExitInitializationMode(unit));
        for (int call = 0; call < 3; call++) DEMAND(fmi2DoStep(unit, call * step, step, 0));
        fmi2FreeInstance(unit);
        if (number + 1 == many / 10) early = memory("VmRSS:");
    }
    if (many) printf("memory_after_tenth %ld\nmemory_after_all %ld\nthreads %ld\n", early, memory("VmRSS:"), memory("Threads:"));

    /* as many side by side */
    void **units = calloc(many > 0 ? many : 1, sizeof *units);
    for (int number = 0; number < many; number++) {
        units[number] = fmi2Instantiate("unit", 1, arguments[3], location, &callbacks, 0, 0);
        if (!units[number]) return 1;
        DEMAND(fmi2SetupExperiment(units[number], 0, 0, 0, 0, 0));
        DEMAND(fmi2EnterInitializationMode(units[number]));
        DEMAND(fmi2ExitInitializationMode(units[number]));
    }
    for (int call = 0; call < 3 * many; call++) DEMAND(fmi2DoStep(units[call % many], call / many * step, step, 0));
    if (many) printf("memory_together %ld\nthreads_together %ld\n", memory("VmRSS:"), memory("Threads:"));
    for (int number = 0; number < many; number++) fmi2FreeInstance(units[number]);
    free(units);
    return 0;
}
