/* A host in plain C for Linux and Windows: loads a unit's library, drives it by numbers from its input, and prints its outputs with 17
   digits. platforms.py compiles and runs it.

       host EDITION LIBRARY RESOURCES TOKEN < course

   EDITION is that of FMI, 2 or 3. The course: numbers of inputs, of their values, of outputs, of their values, and of steps, and the
   length of a step [s]; references of the inputs, then of the outputs; values of the inputs before the start, then for each step. */

#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#ifdef _WIN32
#include <windows.h>
static void *opened(const char *path) { return (void *)LoadLibraryA(path); }
static void *function(void *library, const char *name) { return (void *)GetProcAddress((HMODULE)library, name); }
static void closed(void *library) { FreeLibrary((HMODULE)library); }
#else
#include <dlfcn.h>
static void *opened(const char *path) { return dlopen(path, RTLD_NOW | RTLD_LOCAL); }
static void *function(void *library, const char *name) { return dlsym(library, name); }
static void closed(void *library) { dlclose(library); }
#endif

typedef struct {
    void (*logger)(void *, const char *, int, const char *, const char *, ...);
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void *step_finished;
    void *environment;
} Callbacks;

static void fail(const char *what) {
    fprintf(stderr, "%s\n", what);
    exit(1);
}

static void said(void *environment, const char *instance, int status, const char *category, const char *message, ...) {
    va_list values;
    (void)environment;
    fprintf(stderr, "%s: %s, status %d: ", instance, category, status);
    va_start(values, message);
    vfprintf(stderr, message, values);
    va_end(values);
    fputc('\n', stderr);
}

static void said3(void *environment, int status, const char *category, const char *message) {
    (void)environment;
    fprintf(stderr, "%s, status %d: %s\n", category, status, message);
}

static double number(void) {
    double value;
    if (scanf("%lf", &value) != 1) fail("the course: expected a number");
    return value;
}

static void numbers(double *values, size_t count) {
    for (size_t place = 0; place < count; place++) values[place] = number();
}

static void print(double time, const double *values, size_t count) {
    printf("%.17g", time);
    for (size_t place = 0; place < count; place++) printf(",%.17g", values[place]);
    putchar('\n');
}

/* The library that is open, and its one instance. */
static void *library, *unit;

#define GET(result, name, arguments)                                      \
    result(*name) arguments = (result(*) arguments)function(library, #name); \
    if (!name) fail("the library: expected the function " #name)

#define DO(call) \
    if ((call) != 0) fail("refused: " #call)

/* What the two editions call otherwise. */
typedef struct {
    void (*enter)(const char *resources, const char *token);
    void (*start)(void);
    void (*set)(const unsigned *references, size_t count, const double *values, size_t length);
    void (*get)(const unsigned *references, size_t count, double *values, size_t length);
    void (*step)(double time, double length);
    void (*end)(void);
} Edition;

static void enter2(const char *resources, const char *token) {
    static Callbacks callbacks = {said, calloc, free, NULL, NULL};
    GET(void *, fmi2Instantiate, (const char *, int, const char *, const char *, const Callbacks *, int, int));
    GET(int, fmi2SetupExperiment, (void *, int, double, double, int, double));
    GET(int, fmi2EnterInitializationMode, (void *));
    unit = fmi2Instantiate("unit", 1, token, resources, &callbacks, 0, 0);
    if (!unit) fail("no instance");
    DO(fmi2SetupExperiment(unit, 0, 0.0, 0.0, 0, 0.0));
    DO(fmi2EnterInitializationMode(unit));
}

static void start2(void) {
    GET(int, fmi2ExitInitializationMode, (void *));
    DO(fmi2ExitInitializationMode(unit));
}

static void set2(const unsigned *references, size_t count, const double *values, size_t length) {
    GET(int, fmi2SetReal, (void *, const unsigned *, size_t, const double *));
    (void)length;
    DO(fmi2SetReal(unit, references, count, values));
}

static void get2(const unsigned *references, size_t count, double *values, size_t length) {
    GET(int, fmi2GetReal, (void *, const unsigned *, size_t, double *));
    (void)length;
    DO(fmi2GetReal(unit, references, count, values));
}

static void step2(double time, double length) {
    GET(int, fmi2DoStep, (void *, double, double, int));
    DO(fmi2DoStep(unit, time, length, 1));
}

static void end2(void) {
    GET(int, fmi2Terminate, (void *));
    GET(void, fmi2FreeInstance, (void *));
    DO(fmi2Terminate(unit));
    fmi2FreeInstance(unit);
}

static void enter3(const char *resources, const char *token) {
    GET(void *, fmi3InstantiateCoSimulation,
        (const char *, const char *, const char *, bool, bool, bool, bool, const unsigned *, size_t, void *,
         void (*)(void *, int, const char *, const char *), void *));
    GET(int, fmi3EnterInitializationMode, (void *, bool, double, double, bool, double));
    unit = fmi3InstantiateCoSimulation("unit", token, resources, false, false, false, false, NULL, 0, NULL, said3, NULL);
    if (!unit) fail("no instance");
    DO(fmi3EnterInitializationMode(unit, false, 0.0, 0.0, false, 0.0));
}

static void start3(void) {
    GET(int, fmi3ExitInitializationMode, (void *));
    DO(fmi3ExitInitializationMode(unit));
}

static void set3(const unsigned *references, size_t count, const double *values, size_t length) {
    GET(int, fmi3SetFloat64, (void *, const unsigned *, size_t, const double *, size_t));
    DO(fmi3SetFloat64(unit, references, count, values, length));
}

static void get3(const unsigned *references, size_t count, double *values, size_t length) {
    GET(int, fmi3GetFloat64, (void *, const unsigned *, size_t, double *, size_t));
    DO(fmi3GetFloat64(unit, references, count, values, length));
}

static void step3(double time, double length) {
    bool event, over, early;
    double reached;
    GET(int, fmi3DoStep, (void *, double, double, bool, bool *, bool *, bool *, double *));
    DO(fmi3DoStep(unit, time, length, true, &event, &over, &early, &reached));
}

static void end3(void) {
    GET(int, fmi3Terminate, (void *));
    GET(void, fmi3FreeInstance, (void *));
    DO(fmi3Terminate(unit));
    fmi3FreeInstance(unit);
}

int main(int count, char **words) {
    static const Edition editions[] = {
        {enter2, start2, set2, get2, step2, end2},
        {enter3, start3, set3, get3, step3, end3},
    };
    if (count != 5) fail("expected EDITION LIBRARY RESOURCES TOKEN");
    const Edition *edition = &editions[words[1][0] == '3'];
    library = opened(words[2]);
    if (!library) fail("the library does not load");

    size_t inputs = (size_t)number(), set = (size_t)number(), outputs = (size_t)number(), got = (size_t)number();
    size_t steps = (size_t)number();
    double length = number();
    unsigned *references = calloc(inputs + outputs + 1, sizeof *references);
    double *given = calloc(set + 1, sizeof *given), *read = calloc(got + 1, sizeof *read);
    if (!references || !given || !read) fail("no memory");
    for (size_t place = 0; place < inputs + outputs; place++) references[place] = (unsigned)number();

    edition->enter(words[3], words[4]);
    for (size_t step = 0; step <= steps; step++) {
        numbers(given, set);
        if (inputs) edition->set(references, inputs, given, set);
        if (step == 0) {
            edition->start();
        } else {
            edition->step((double)(step - 1) * length, length);
        }
        edition->get(references + inputs, outputs, read, got);
        print((double)step * length, read, got);
    }
    edition->end();
    closed(library);
    free(references);
    free(given);
    free(read);
    return 0;
}
