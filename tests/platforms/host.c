/* A host in plain C for Linux and Windows: loads a unit's library, drives it by numbers from its input, and prints its outputs with 17
   digits. platforms.py compiles and runs it.

       host LIBRARY RESOURCES GUID < course

   The course: numbers of inputs, outputs and steps, and the length of a step [s]; references of the inputs, then of the outputs; values
   of the inputs before the start, then for each step. */

#include <stdarg.h>
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

#define GET(result, name, arguments)                                      \
    result(*name) arguments = (result(*) arguments)function(library, #name); \
    if (!name) fail("the library: expected the function " #name)

#define DO(call) \
    if ((call) != 0) fail("refused: " #call)

int main(int count, char **words) {
    static Callbacks callbacks = {said, calloc, free, NULL, NULL};
    if (count != 4) fail("expected LIBRARY RESOURCES GUID");
    void *library = opened(words[1]);
    if (!library) fail("the library does not load");

    GET(void *, fmi2Instantiate, (const char *, int, const char *, const char *, const Callbacks *, int, int));
    GET(int, fmi2SetupExperiment, (void *, int, double, double, int, double));
    GET(int, fmi2EnterInitializationMode, (void *));
    GET(int, fmi2ExitInitializationMode, (void *));
    GET(int, fmi2SetReal, (void *, const unsigned *, size_t, const double *));
    GET(int, fmi2GetReal, (void *, const unsigned *, size_t, double *));
    GET(int, fmi2DoStep, (void *, double, double, int));
    GET(int, fmi2Terminate, (void *));
    GET(void, fmi2FreeInstance, (void *));

    size_t inputs = (size_t)number(), outputs = (size_t)number(), steps = (size_t)number();
    double length = number();
    unsigned *references = calloc(inputs + outputs + 1, sizeof *references);
    double *given = calloc(inputs + 1, sizeof *given), *read = calloc(outputs + 1, sizeof *read);
    if (!references || !given || !read) fail("no memory");
    for (size_t place = 0; place < inputs + outputs; place++) references[place] = (unsigned)number();

    void *unit = fmi2Instantiate("unit", 1, words[3], words[2], &callbacks, 0, 0);
    if (!unit) fail("no instance");
    DO(fmi2SetupExperiment(unit, 0, 0.0, 0.0, 0, 0.0));
    DO(fmi2EnterInitializationMode(unit));
    for (size_t step = 0; step <= steps; step++) {
        numbers(given, inputs);
        if (inputs) DO(fmi2SetReal(unit, references, inputs, given));
        if (step == 0) {
            DO(fmi2ExitInitializationMode(unit));
        } else {
            DO(fmi2DoStep(unit, (double)(step - 1) * length, length, 1));
        }
        DO(fmi2GetReal(unit, references + inputs, outputs, read));
        print((double)step * length, read, outputs);
    }
    DO(fmi2Terminate(unit));
    fmi2FreeInstance(unit);
    closed(library);
    free(references);
    free(given);
    free(read);
    return 0;
}
