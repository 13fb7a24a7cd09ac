/* Material at rest or sheared as a block, and the gradient alone. */
#include "exact_cases.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

/* Column at rest between smooth walls: p = rho g (H - y). */
void hydrostatic(const options *o) {
    const double height = 0.05;
    const double ends[3][4] = {{0.05, 0, 0, 0}, {0, 0, 0, 0.1}, {0.05, 0.1, 0.05, 0}};
    gp_config config;
    gp_column column;
    gp_plate plate;
    layer a;
    double *y, *p, square = 0, base = 0;
    double n_base = 0;
    int64_t i;
    int k;
    CHECK(gp_config_init(&config, sizeof config, GP_PRESET_DEFAULT));
    a.spacing = config.spacing = height / o->resolution;
    config.sound_speed = o->mach > 0 ? o->mach : 10;
    config.cfl = o->cfl;
    config.threads = 1;
    if (o->horizon > 0)
        config.horizon = o->horizon;
    CHECK(gp_create(&config, &a.sim));
    CHECK(gp_column_init(&column, sizeof column));
    column.width = column.height = height;
    CHECK(gp_add_column(a.sim, &column, NULL));
    for (k = 0; k < 3; ++k) {
        CHECK(gp_plate_init(&plate, sizeof plate));
        plate.x0 = ends[k][0];
        plate.y0 = ends[k][1];
        plate.x1 = ends[k][2];
        plate.y1 = ends[k][3];
        plate.friction = GP_WALL_FREE_SLIP;
        CHECK(gp_add_plate(a.sim, &plate, NULL));
    }
    CHECK(gp_run(a.sim, o->end > 0 ? o->end : 0.5));
    a.count = state_of(a.sim).n_particles;
    y = field(&a, GP_FIELD_Y);
    p = field(&a, GP_FIELD_PRESSURE);
    for (i = 0; i < a.count; ++i) {
        square += pow(p[i] - DENSITY * GRAVITY * (height - y[i]), 2);
        if (y[i] < a.spacing) {
            base += p[i] + DENSITY * GRAVITY * y[i];
            n_base += 1;
        }
    }
    printf("pressure_base       %.6g Pa, exact %.6g\n", base / n_base, DENSITY * GRAVITY * height);
    printf("error_base          %.6g\n", base / n_base / (DENSITY * GRAVITY * height) - 1);
    printf("error               %.6g rms over the base pressure\n",
           sqrt(square / (double)a.count) / (DENSITY * GRAVITY * height));
    printf("at_rest             %d\n", (int)state_of(a.sim).at_rest);
    print_cost(a.sim);
    gp_destroy(a.sim);
    free(y);
    free(p);
}

typedef struct shear {
    double rate, middle;
} shear;

static double linear(double y, const void *data) {
    const shear *s = data;
    return s->rate * (y - s->middle);
}

/* Simple shear between two rough plates, one under a load P: tau = mu(I) P. */
void shear_box(const options *o) {
    const double load = 500, thickness = 0.04, rate = 50;
    const law l = beads(0.002);
    const shear data = {rate, thickness / 2};
    const double inertial = rate * l.d / sqrt(load / GRAIN_DENSITY), mu = friction(&l, inertial);
    const scene s = {l,
                     GRAIN_DENSITY,
                     FRACTION,
                     thickness,
                     0,
                     0,
                     2 * sqrt(load / DENSITY) + rate * thickness / 2,
                     linear,
                     &data,
                     load,
                     rate * thickness / 2,
                     -rate * thickness / 2};
    layer a = make_layer(o, &s);
    double fx, fy, tau_over_p = 0, *sxy, *p, *g;
    double bulk = 0;
    int64_t i, from = a.count / 4, to = 3 * a.count / 4;
    fx = mean_plate_force(&a, &fy, 0.2, o->end > 0 ? o->end : 0.6);
    sxy = field(&a, GP_FIELD_SXY);
    p = field(&a, GP_FIELD_PRESSURE);
    g = field(&a, GP_FIELD_SHEAR_RATE);
    for (i = from; i < to; ++i) {
        tau_over_p += sxy[i] / p[i] / (double)(to - from);
        bulk += friction(&l, 2 * l.d * g[i] / sqrt(p[i] / GRAIN_DENSITY)) / (double)(to - from);
    }
    printf("inertial_number     %.6g\n", inertial);
    printf("mu                  %.6g exact, %.6g on the floor, %.6g inside at the local I %.6g\n", mu, fx / fabs(fy),
           tau_over_p, bulk);
    printf("error               %.6g of mu on the floor\n", fx / fabs(fy) / mu - 1);
    printf("error_inside        %.6g\n", tau_over_p / bulk - 1);
    printf("error_load          %.6g\n", fabs(fy) / (load * a.columns * a.spacing) - 1);
    print_profile(&a, o, linear, &data, rate * thickness / 2);
    print_cost(a.sim);
    gp_destroy(a.sim);
    free(sxy);
    free(p);
    free(g);
}

/* Reproducible numbers in [-1, 1). */
static double scattered(uint64_t *state) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) / 4503599627370496.0 - 1;
}

/* The velocity gradient of a smooth field on a lattice jittered by 0.2 spacings, away from its edges. */
void gradient(const options *o) {
    const int n = o->resolution;
    const double spacing = 1.0 / n, k = 2 * PI;
    const size_t count = (size_t)n * (size_t)n;
    double *x = malloc(4 * count * sizeof *x), *y = x + count, *u = y + count, *v = u + count, *g;
    double square = 0, norm = 0;
    uint64_t random = 1;
    gp_config config;
    layer a;
    size_t i;
    if (!x)
        exit(1);
    for (i = 0; i < count; ++i) {
        x[i] = ((double)(i % (size_t)n) + 0.5 + 0.2 * scattered(&random)) * spacing;
        y[i] = ((double)(i / (size_t)n) + 0.5 + 0.2 * scattered(&random)) * spacing;
        u[i] = sin(k * x[i]) * cos(k * y[i]);
        v[i] = -cos(k * x[i]) * sin(k * y[i]);
    }
    CHECK(gp_config_init(&config, sizeof config, GP_PRESET_DEFAULT));
    config.spacing = spacing;
    config.gravity_y = 0;
    config.sound_speed = 10;
    config.collision_distance = 0;
    config.time_step = 1e-12;
    config.threads = 1;
    if (o->horizon > 0)
        config.horizon = o->horizon;
    CHECK(gp_create(&config, &a.sim));
    CHECK(gp_add_particles(a.sim, 0, (int64_t)count, x, y, u, v, NULL));
    CHECK(gp_step(a.sim, 1));
    a.count = (int64_t)count;
    g = field(&a, GP_FIELD_SHEAR_RATE);
    for (i = 0; i < count; ++i) {
        const double edge = fmin(fmin(x[i], 1 - x[i]), fmin(y[i], 1 - y[i]));
        /* D = diag(1, -1) k cos cos: its |gamma| = sqrt(D:D / 2). */
        const double exact = k * fabs(cos(k * x[i]) * cos(k * y[i]));
        if (edge < config.horizon * spacing)
            continue;
        square += (g[i] - exact) * (g[i] - exact);
        norm += exact * exact;
    }
    printf("error               %.6g in the norm L2\n", sqrt(square / norm));
    print_cost(a.sim);
    gp_destroy(a.sim);
    free(x);
    free(g);
}
