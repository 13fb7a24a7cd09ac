#include "marks.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "../examples/c/example.h" /* CHECK */

static double *positions(gp_sim *sim, int64_t *n) {
    gp_state state = {.struct_size = sizeof state};
    double *x;
    CHECK(gp_get_state(sim, &state));
    *n = state.n_particles;
    x = malloc(sizeof *x * (size_t)(*n > 0 ? *n : 1));
    if (!x) {
        fprintf(stderr, "out of memory\n");
        exit(1);
    }
    CHECK(gp_copy_field(sim, GP_FIELD_X, x, *n));
    return x;
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double mark_of(const double *sorted, int64_t n, double share) {
    const double place = fmin(fmax(share * (double)n - 0.5, 0), (double)(n - 1));
    const int64_t k = (int64_t)place;
    return k + 1 < n ? sorted[k] + (place - (double)k) * (sorted[k + 1] - sorted[k]) : sorted[k];
}

double run_out_between(const extent *e, double left, double right) {
    return (e->sides == 1 ? right - e->right : (right - e->right + e->left - left) / 2) / e->reference;
}

double run_out_of(gp_sim *sim, const extent *e, double share) {
    int64_t n;
    double *x = positions(sim, &n), way;
    qsort(x, (size_t)n, sizeof *x, ascending);
    way = e->sides == 1 ? run_out_between(e, 0, mark_of(x, n, share))
                        : run_out_between(e, mark_of(x, n, (1 - share) / 2), mark_of(x, n, (1 + share) / 2));
    free(x);
    return way;
}

double mean_distance(gp_sim *sim, const extent *e) {
    const double from = e->sides == 1 ? e->left : (e->left + e->right) / 2;
    int64_t n, k;
    double *x = positions(sim, &n), sum = 0;
    for (k = 0; k < n; ++k)
        sum += fabs(x[k] - from);
    free(x);
    return sum / (double)n / e->reference;
}
