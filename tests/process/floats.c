/* A host that changes the floating-point environment: the library computes the same bits, survives traps, gives the host's
 * environment and raised flags back as they were, and lets callbacks have them. Built with OpenMP: the host's threads,
 * which the library uses, have an environment of their own.
 *
 * usage: floats [--cost]    --cost: what putting the environment aside costs in a call, in ns */
#define _GNU_SOURCE
#include "scene.h"

#include <fenv.h>
#include <math.h>
#include <omp.h>
#include <time.h>
#ifdef __SSE2__
#include <xmmintrin.h>
#define FLUSH_TO_ZERO 0x8040u /* and denormals are zero */
#endif

typedef struct environment {
    const char *name;
    int rounding, traps;
    unsigned sse;
} environment;

static const environment environments[] = {
    {"as it is", FE_TONEAREST, 0, 0},
    {"rounding up", FE_UPWARD, 0, 0},
    {"rounding down", FE_DOWNWARD, 0, 0},
    {"rounding to zero", FE_TOWARDZERO, 0, 0},
    {"traps on invalid, divide by zero, overflow", FE_TONEAREST, FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW, 0},
    {"all traps", FE_TONEAREST, FE_ALL_EXCEPT, 0},
#ifdef FLUSH_TO_ZERO
    {"flush to zero", FE_TONEAREST, 0, FLUSH_TO_ZERO},
    {"flush to zero, rounding up, traps", FE_UPWARD, FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW, FLUSH_TO_ZERO},
#endif
};
enum { ENVIRONMENTS = sizeof environments / sizeof environments[0] };

typedef struct reading {
    int rounding, traps, raised;
    unsigned sse;
} reading;

static reading read_environment(void) {
    reading now;
    now.rounding = fegetround();
    now.traps = fegetexcept();
    now.raised = fetestexcept(FE_ALL_EXCEPT);
    now.sse = 0;
#ifdef FLUSH_TO_ZERO
    now.sse = _mm_getcsr();
#endif
    return now;
}

static void set_environment(const environment *wanted) {
    fesetenv(FE_DFL_ENV);
    fesetround(wanted->rounding);
    feraiseexcept(FE_UNDERFLOW); /* a flag that the host has not looked at yet */
#ifdef FLUSH_TO_ZERO
    _mm_setcsr(_mm_getcsr() | wanted->sse);
#endif
    feenableexcept(wanted->traps & ~FE_UNDERFLOW);
}

static reading expected;

static void require_unchanged(const char *where) {
    const reading now = read_environment();
    if (memcmp(&now, &expected, sizeof now) != 0) {
        fesetenv(FE_DFL_ENV);
        fprintf(stderr, "FAILED: %s: rounding %d -> %d, traps %x -> %x, raised %x -> %x, SSE %x -> %x\n", where,
                expected.rounding, now.rounding, (unsigned)expected.traps, (unsigned)now.traps,
                (unsigned)expected.raised, (unsigned)now.raised, expected.sse, now.sse);
        exit(1);
    }
}

static int calls;

static int32_t in_callback(void *user, gp_sim *sim) {
    gp_state state;
    (void)user;
    require_unchanged("in the callback");
    state.struct_size = (uint32_t)sizeof state;
    gp_get_state(sim, &state);
    require_unchanged("in the callback, after a call");
    ++calls;
    return 0;
}

static void in_log(void *user, int32_t level, const char *text) {
    (void)user, (void)level, (void)text;
    require_unchanged("in the log");
    ++calls;
}

/* What a host does with a simulation: steps, files, a mistake. */
static uint64_t use(int scheme, int threads, const environment *wanted, const char *directory) {
    gp_config config;
    gp_sim *sim, *none = NULL;
    uint64_t hash;
    char path[4096];
    const int files = gp_has_feature("hdf5");
    sim = make_scene(scheme, threads); /* its own arithmetic rounds, too */
    set_environment(wanted);
    expected = read_environment();
    gp_set_log(sim, in_log, NULL);
    gp_set_callback(sim, 1, in_callback, NULL);
    snprintf(path, sizeof path, "%s/floats.h5", directory);
    require(!files || gp_output_open(sim, path, NULL) == GP_OK, "gp_output_open");
    require(gp_step(sim, scheme == IMPLICIT_SCHEME ? 3 : 10) == GP_OK, "gp_step");
    require_unchanged("after gp_step");
    require(!files || gp_output_write(sim) == GP_OK, "gp_output_write");
    hash = fingerprint(sim);
    snprintf(path, sizeof path, "%s/floats.gpc", directory);
    require(!files || gp_save(sim, path) == GP_OK, "gp_save");
    gp_destroy(sim);
    require_unchanged("after gp_destroy");
    if (files) {
        require(gp_load_file(path, &sim) == GP_OK, "gp_load");
        require(fingerprint(sim) == hash, "what is loaded has other bits");
        gp_destroy(sim);
    }
    gp_config_init(&config, sizeof config, GP_PRESET_DEFAULT);
    config.spacing = NAN;
    require(gp_create(&config, &none) == GP_E_ARGUMENT && strstr(gp_last_error(), "nan"), "NaN is not refused");
    require_unchanged("after a mistake");
    return hash;
}

static int32_t rounds_up(void *user, gp_sim *sim) {
    (void)user, (void)sim;
    fesetround(FE_UPWARD);
    return 0;
}

/* What a callback sets stays set. */
static void check_change_in_callback(void) {
    gp_sim *sim = make_scene(DEFAULT_SCHEME, 2);
    uint64_t hash;
    fesetenv(FE_DFL_ENV);
    gp_set_callback(sim, 1, rounds_up, NULL);
    require(gp_step(sim, 10) == GP_OK, "gp_step");
    require(fegetround() == FE_UPWARD, "the rounding that a callback has set is gone");
    fesetenv(FE_DFL_ENV);
    hash = fingerprint(sim);
    gp_destroy(sim);
    require(hash == run_scene(DEFAULT_SCHEME, 2), "a callback's rounding changes bits");
}

#ifdef FLUSH_TO_ZERO
/* The host's own threads flush to zero, the thread that calls does not. Two in all: GNU OpenMP ends
 * threads that a smaller region does not need. */
static void check_threads(uint64_t alone) {
    int lost = 0;
    omp_set_dynamic(0);
#pragma omp parallel num_threads(2)
    if (omp_get_thread_num() > 0)
        _mm_setcsr(_mm_getcsr() | FLUSH_TO_ZERO);
    require(run_scene(DEFAULT_SCHEME, 2) == alone, "other bits where OpenMP's threads flush to zero");
#pragma omp parallel num_threads(2) reduction(+ : lost)
    lost += omp_get_thread_num() > 0 && (_mm_getcsr() & FLUSH_TO_ZERO) != FLUSH_TO_ZERO;
    require(lost == 0, "the host's threads no longer flush to zero");
}
#endif

static double seconds_of_calls(gp_sim *sim, int n) {
    struct timespec from, to;
    int k;
    clock_gettime(CLOCK_MONOTONIC, &from);
    for (k = 0; k < n; ++k)
        gp_set_log(sim, NULL, NULL);
    clock_gettime(CLOCK_MONOTONIC, &to);
    return (double)(to.tv_sec - from.tv_sec) + 1e-9 * (double)(to.tv_nsec - from.tv_nsec);
}

static void print_cost(void) {
    gp_sim *sim = make_scene(DEFAULT_SCHEME, 1);
    const int n = 3000000;
    double usual = 1, traps = 1;
    int repeat;
    for (repeat = 0; repeat < 5; ++repeat) {
        double seconds = seconds_of_calls(sim, n);
        usual = seconds < usual ? seconds : usual;
        feenableexcept(FE_INVALID);
        seconds = seconds_of_calls(sim, n / 10) * 10;
        traps = seconds < traps ? seconds : traps;
        fesetenv(FE_DFL_ENV);
    }
    printf("the shortest call: %.0f ns, of a host with traps %.0f ns\n", usual / n * 1e9, traps / n * 1e9);
    gp_destroy(sim);
}

int main(int argc, char **argv) {
    int scheme, threads, k, runs = 0;
    if (argc > 1 && strcmp(argv[1], "--cost") == 0) {
        print_cost();
        return 0;
    }
    for (scheme = 0; scheme < SCHEMES; ++scheme) {
        uint64_t alone = 0;
        for (threads = 1; threads <= 3; threads += 2)
            for (k = 0; k < ENVIRONMENTS; ++k) {
                uint64_t hash;
                hash = use(scheme, threads, &environments[k], argc > 1 ? argv[1] : ".");
                fesetenv(FE_DFL_ENV);
                if (runs++ == 0 || alone == 0)
                    alone = hash;
                if (hash != alone) {
                    fprintf(stderr, "FAILED: scheme %d, %d threads, %s: other bits\n", scheme, threads,
                            environments[k].name);
                    return 1;
                }
            }
#ifdef FLUSH_TO_ZERO
        if (scheme == DEFAULT_SCHEME && gp_has_feature("openmp"))
            check_threads(alone);
#endif
    }
    check_change_in_callback();
    printf("%d runs in %d environments: the same bits, environments as they were in %d callbacks and after all calls\n",
           runs, (int)ENVIRONMENTS, calls);
    return 0;
}
