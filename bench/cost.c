#include "cost.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "../examples/c/example.h"

double *bench_doubles(int64_t count) {
    double *values = malloc(sizeof *values * (size_t)count);
    if (!values) {
        fprintf(stderr, "out of memory\n");
        exit(1);
    }
    return values;
}

double *bench_field(gp_sim *sim, uint32_t bit, int64_t count) {
    double *values = bench_doubles(count);
    CHECK(gp_copy_field(sim, bit, values, count));
    return values;
}

void bench_print_cost(gp_sim *sim) {
    const gp_state s = example_state(sim);
    printf("time %.6g s\n", s.time);
    printf("particles %lld 1\n", (long long)s.n_particles);
    printf("steps %lld 1\n", (long long)s.step);
    printf("cpu_seconds %.3f s\n", (double)clock() / CLOCKS_PER_SEC);
}
