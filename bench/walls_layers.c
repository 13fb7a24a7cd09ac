/* Layers that are periodic in x: thrown along a level floor, and flowing down an incline. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "plane_flow.h"
#include "walls.h"

enum { SLIDE_ACROSS = 40, INCLINE_ACROSS = 12 }; /* spacings in the period */

typedef struct layer {
    gp_sim *sim;
    double width, mass; /* m, kg/m */
    int32_t floor;
} layer;

static layer make_layer(const choices *c, double thickness, int across, double speed, double sound_speed,
                        int constant) {
    layer a;
    const double spacing = thickness / c->rows;
    gp_config config = walls_config(c, spacing);
    gp_column column;
    gp_plate plate;
    a.width = across * spacing;
    a.mass = DENSITY * thickness * a.width;
    config.periodic_x_max = a.width;
    config.sound_speed = sound_speed;
    CHECK(gp_create(&config, &a.sim));
    walls_add_beads(a.sim, 0.002, constant);
    CHECK(gp_column_init(&column, sizeof column));
    column.width = a.width;
    column.height = thickness;
    column.material = 1;
    column.vx = speed;
    CHECK(gp_add_column(a.sim, &column, NULL));
    CHECK(gp_plate_init(&plate, sizeof plate));
    plate.x0 = a.width;
    if (c->coulomb) {
        plate.friction = GP_WALL_COULOMB;
        plate.wall_mu = tan(21 * DEGREE);
    }
    CHECK(gp_add_plate(a.sim, &plate, &a.floor));
    return a;
}

static double mean_speed(const layer *a) {
    return example_state(a->sim).momentum_x / a->mass;
}

/* The way of the layer's mean until the end, by the trapezoidal rule. */
static double way_of(const layer *a, double speed, double end, int intervals) {
    const double dt = end / intervals;
    double way = 0, before = speed;
    int k;
    for (k = 1; k <= intervals; ++k) {
        double now;
        CHECK(gp_run(a->sim, k * dt));
        now = mean_speed(a);
        way += 0.5 * dt * (before + now);
        before = now;
    }
    printf("speed_left %.3g of that at the start\n", before / speed);
    return way;
}

void slide_coulomb(const choices *c) {
    const double speed = 0.5, mu = tan(21 * DEGREE), stop = speed / (mu * GRAVITY), exact = 0.5 * speed * stop;
    layer a = make_layer(c, c->rows * 0.0025, SLIDE_ACROSS, speed, 10, 1);
    gp_load before, after;
    double way;
    CHECK(gp_run(a.sim, 0.1 * stop));
    before = example_load(a.sim, a.floor);
    CHECK(gp_run(a.sim, 0.4 * stop));
    after = example_load(a.sim, a.floor);
    printf("traction %.5f of mu times the weight\n",
           (after.impulse_x - before.impulse_x) / (0.3 * stop) / (mu * a.mass * GRAVITY));
    gp_destroy(a.sim);
    a = make_layer(c, c->rows * 0.0025, SLIDE_ACROSS, speed, 10, 1);
    way = way_of(&a, speed, 1.1 * stop, 165);
    printf("way %.5g m\n", way);
    printf("exact %.5g m\n", exact);
    bench_print_cost(a.sim);
    gp_destroy(a.sim);
}

void slide_inertial(const choices *c) {
    const double thickness = 0.005, speed = 0.8, dt = 1e-3;
    plane_flow exact = plane_flow_at(thickness, speed, 0, GRAVITY);
    layer a = make_layer(c, thickness, SLIDE_ACROSS, speed, 10, 0);
    double way = 0, before = speed;
    printf("way %.5g m\n", way_of(&a, speed, c->end, 180));
    while (exact.time < c->end) {
        plane_flow_run(&exact, exact.time + dt);
        way += 0.5 * dt * (before + plane_flow_mean(&exact));
        before = plane_flow_mean(&exact);
    }
    printf("exact %.5g m\n", way);
    bench_print_cost(a.sim);
    gp_destroy(a.sim);
}

static int highest_first(const void *a, const void *b) {
    const double x = ((const double *)a)[0], y = ((const double *)b)[0];
    return (x < y) - (x > y);
}

/* Mean over the uppermost row, or twentieth of the rows: of the velocity (m/s), and the depth below `thickness` (m). */
static double surface_speed(gp_sim *sim, int rows, double thickness, double *depth) {
    const int64_t count = example_state(sim).n_particles, chosen = INCLINE_ACROSS * (rows < 40 ? 1 : rows / 20);
    double *y = bench_field(sim, GP_FIELD_Y, count), *u = bench_field(sim, GP_FIELD_VX, count);
    double *pairs = malloc(2 * sizeof *pairs * (size_t)count), speed = 0;
    int64_t k;
    if (!pairs)
        exit(1);
    for (k = 0; k < count; ++k) {
        pairs[2 * k] = y[k];
        pairs[2 * k + 1] = u[k];
    }
    qsort(pairs, (size_t)count, 2 * sizeof *pairs, highest_first);
    *depth = thickness;
    for (k = 0; k < chosen; ++k) {
        *depth -= pairs[2 * k] / (double)chosen;
        speed += pairs[2 * k + 1] / (double)chosen;
    }
    free(y);
    free(u);
    free(pairs);
    return speed;
}

enum { THICKNESS_MM = 40 }; /* of layers on inclines: 20 diameters */

void incline_start(const choices *c) {
    static const double times[] = {0.5, 1, 2, 5};
    const double thickness = 1e-3 * THICKNESS_MM, angle = c->angle * DEGREE;
    plane_flow exact = plane_flow_at(thickness, 0, GRAVITY * sin(angle), GRAVITY * cos(angle));
    layer a = make_layer(c, thickness, INCLINE_ACROSS, 0, 0, 0);
    int k;
    for (k = 0; k < 4 && times[k] <= c->end; ++k) {
        double depth;
        CHECK(gp_run(a.sim, times[k]));
        plane_flow_run(&exact, times[k]);
        printf("surface_%d %.5g m/s\n", k, surface_speed(a.sim, (int)c->rows, thickness, &depth));
        printf("exact_%d %.5g m/s\n", k, plane_flow_surface(&exact));
    }
    bench_print_cost(a.sim);
    gp_destroy(a.sim);
}

static double mean_height(gp_sim *sim) {
    return example_state(sim).centre_y;
}

void incline_shear(const choices *c) {
    const double thickness = 1e-3 * THICKNESS_MM, angle = c->angle * DEGREE, mu = tan(angle), d = 0.002;
    const double mu_s = tan(21 * DEGREE), mu_2 = tan(32 * DEGREE), inertial = 0.3 * (mu - mu_s) / (mu_2 - mu);
    const double bagnold = 2.0 / 3 * inertial / d * sqrt(0.62 * GRAVITY * cos(angle)) * pow(thickness, 1.5);
    layer a = make_layer(c, thickness, INCLINE_ACROSS, 0, 0, 0);
    const double height = mean_height(a.sim);
    int k;
    for (k = 1; k <= 4; ++k) {
        double depth, speed;
        CHECK(gp_run(a.sim, c->end * k / 4));
        speed = surface_speed(a.sim, (int)c->rows, thickness, &depth);
        printf("height_%d %.5g of that at the start\n", k, mean_height(a.sim) / height);
        printf("surface_%d %.5g of Bagnold's at that height\n", k,
               speed / (bagnold * (1 - pow(fmax(0, depth / thickness), 1.5))));
    }
    bench_print_cost(a.sim);
    gp_destroy(a.sim);
}
