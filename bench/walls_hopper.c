/* A silo with a flat floor that empties through an outlet: how much flows out, and whether the filling matters. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "walls.h"

/* Outlet, silo: m. The friction of Staron, Lagree & Popinet (2012); grains of a twentieth of the outlet. */
static const double outlet = 0.05, width = 0.25, diameter = 0.0025;
static const double mu_s = 0.32, mu_2 = 0.60, i0 = 0.4;

static void add_material(gp_sim *sim) {
    gp_material material;
    CHECK(gp_material_init(&material, sizeof material));
    material.grain_diameter = diameter;
    material.mu_s = mu_s;
    material.mu_2 = mu_2;
    material.i0 = i0;
    CHECK(gp_add_material(sim, &material, NULL));
}

static void add_line(gp_sim *sim, const double *x, const double *y) {
    gp_plate wall;
    CHECK(gp_plate_init(&wall, sizeof wall));
    wall.n_points = 3;
    wall.point_x = x;
    wall.point_y = y;
    CHECK(gp_add_plate(sim, &wall, NULL));
}

/* kg/m above the outlet, over that of the whole filling. */
static double left_of(gp_sim *sim, double whole, double spacing) {
    gp_particles p = {0};
    int64_t k, above = 0;
    p.struct_size = sizeof p;
    CHECK(gp_get_particles(sim, GP_FIELD_Y, &p));
    for (k = 0; k < p.count; ++k)
        above += p.y[k] > 0;
    return (double)above * DENSITY * spacing * spacing / whole;
}

/* Of the straight line through n points of y at x. */
static double slope(int n, const double *x, const double *y) {
    double mx = 0, my = 0, xx = 0, xy = 0;
    int k;
    for (k = 0; k < n; ++k) {
        mx += x[k] / n;
        my += y[k] / n;
    }
    for (k = 0; k < n; ++k) {
        xx += (x[k] - mx) * (x[k] - mx);
        xy += (x[k] - mx) * (y[k] - my);
    }
    return xy / xx;
}

void hopper(const choices *c) {
    enum { LOOKS = 120, PARTS = 4 };
    const double spacing = outlet / c->rows, height = c->filling * outlet, top = height + 8 * spacing, from = 0.2;
    const double left_x[] = {-outlet / 2, -width / 2, -width / 2}, left_y[] = {0, 0, top};
    const double right_x[] = {width / 2, width / 2, outlet / 2}, right_y[] = {top, 0, 0};
    const double whole = DENSITY * width * height, scale = DENSITY * sqrt(GRAVITY) * pow(outlet, 1.5);
    double time[LOOKS], left[LOOKS];
    gp_config config = walls_config(c, spacing);
    gp_column column;
    gp_sim *sim;
    int k;
    config.sound_speed = 40; /* m/s: what has left falls on and reaches 7 m/s by itself, which needs no more */
    CHECK(gp_create(&config, &sim));
    if (c->beads)
        walls_add_beads(sim, diameter, 0);
    else
        add_material(sim);
    add_line(sim, left_x, left_y);
    add_line(sim, right_x, right_y);
    CHECK(gp_column_init(&column, sizeof column));
    column.x_min = -width / 2;
    column.width = width;
    column.height = height;
    column.material = 1;
    CHECK(gp_add_column(sim, &column, NULL));
    for (k = 0; k < LOOKS; ++k) {
        CHECK(gp_run(sim, from + (c->end - from) * k / (LOOKS - 1)));
        time[k] = example_state(sim).time;
        left[k] = left_of(sim, whole, spacing);
    }
    printf("rate %.5g rho sqrt(g) D^1.5\n", -slope(LOOKS, time, left) * whole / scale);
    for (k = 0; k < PARTS; ++k) {
        const int first = k * (LOOKS / PARTS), n = LOOKS / PARTS;
        printf("rate_%d %.5g rho sqrt(g) D^1.5\n", k, -slope(n, time + first, left + first) * whole / scale);
        printf("left_%d %.5g of the filling\n", k, left[first + n / 2]);
    }
    bench_print_cost(sim);
    gp_destroy(sim);
}
