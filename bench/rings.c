#include "rings.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "../examples/c/example.h" /* CHECK */

void add_rings(gp_sim *sim, int32_t material, double inner, double outer, int rings, double spacing) {
    enum { MOST = 100000 };
    const double turn = 2 * acos(-1);
    double *x = malloc(2 * MOST * sizeof *x), *y = x + MOST;
    int64_t n = 0;
    int j, k;
    if (!x) {
        fprintf(stderr, "out of memory\n");
        exit(1);
    }
    for (j = 0; j < rings; ++j) {
        const double r = inner + (outer - inner) * (j + 0.5) / rings;
        const int count = (int)round(turn * r / spacing);
        for (k = 0; k < count && n < MOST; ++k, ++n) {
            x[n] = r * cos(turn * (k + 0.5 * (j % 2)) / count);
            y[n] = r * sin(turn * (k + 0.5 * (j % 2)) / count);
        }
    }
    CHECK(gp_add_particles(sim, material, n, x, y, NULL, NULL, NULL));
    free(x);
}
