/* A column that is released on an incline, a vertical face that should stand, and a tall silo whose floor sinks. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "walls.h"

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static int32_t add_column(gp_sim *sim, double y_min, double width, double height, int32_t material) {
    gp_column column;
    int32_t id;
    CHECK(gp_column_init(&column, sizeof column));
    column.y_min = y_min;
    column.width = width;
    column.height = height;
    column.material = material;
    CHECK(gp_add_column(sim, &column, &id));
    return id;
}

static int32_t add_plate(gp_sim *sim, double x0, double y0, double x1, double y1, int32_t friction, double vy) {
    gp_plate plate;
    int32_t id;
    CHECK(gp_plate_init(&plate, sizeof plate));
    plate.x0 = x0;
    plate.y0 = y0;
    plate.x1 = x1;
    plate.y1 = y1;
    plate.friction = friction;
    plate.vy = vy;
    CHECK(gp_add_plate(sim, &plate, &id));
    return id;
}

void incline_column(const choices *c) {
    const double width = 0.20, height = 0.14, interval = 0.05,
                 bed_length = 0.9; /* farther than it runs on 10 degrees */
    const gp_config config = walls_config(c, height / c->rows);
    gp_sim *sim;
    gp_state state;
    double *x, *y, *p, *columns, t, clump = 0;
    int64_t k, own = 0;
    int32_t column;
    CHECK(gp_create(&config, &sim));
    walls_add_beads(sim, 0.0007, 0);
    column = add_column(sim, c->bed, width, height, 1);
    if (c->bed > 0)
        add_column(sim, 0, bed_length, c->bed, 1);
    add_plate(sim, 10, 0, 0, 0, GP_WALL_NO_SLIP, 0);
    add_plate(sim, 0, 0, 0, 1, GP_WALL_FREE_SLIP, 0);
    for (t = interval; t < c->end + 0.5 * interval; t += interval) {
        CHECK(gp_run(sim, t));
        state = example_state(sim);
        if (state.at_rest)
            break;
    }
    state = example_state(sim);
    x = bench_field(sim, GP_FIELD_X, state.n_particles);
    y = bench_field(sim, GP_FIELD_Y, state.n_particles);
    p = bench_field(sim, GP_FIELD_PRESSURE, state.n_particles);
    columns = bench_field(sim, GP_FIELD_COLUMN, state.n_particles);
    for (k = 0; k < state.n_particles; ++k) /* of what has come off in front of the deposit, and bears nothing */
        if (x[k] > state.x_right && p[k] == 0 && state.at_rest)
            clump = fmax(clump, ceil((y[k] - c->bed) / config.spacing - 0.25));
    for (k = 0; k < state.n_particles; ++k)
        if (columns[k] == column)
            x[own++] = x[k];
    qsort(x, (size_t)own, sizeof *x, ascending);
    printf("x_90 %.5g m\n", x[(int64_t)(0.90 * (double)own)]);
    printf("x_98 %.5g m\n", x[(int64_t)(0.98 * (double)own)]);
    printf("tip %.5g m\n", c->bed > 0 ? x[own - 1] : state.x_right);
    printf("detached %.5g of the mass\n", state.detached);
    printf("clump %.3g rows, of what has come off and bears no pressure, at rest\n", clump);
    printf("at_rest %d 1\n", state.at_rest);
    bench_print_cost(sim);
    free(x);
    free(y);
    free(p);
    free(columns);
    gp_destroy(sim);
}

void face(const choices *c) {
    const double width = 0.08, height = 0.05, mu = 1.5;
    const gp_config config = walls_config(c, width / c->rows);
    gp_material material;
    gp_state state;
    gp_sim *sim;
    CHECK(gp_create(&config, &sim));
    CHECK(gp_material_init(&material, sizeof material));
    material.mu_s = material.mu_2 = mu;
    CHECK(gp_add_material(sim, &material, NULL));
    add_column(sim, 0, width, height, 1);
    add_plate(sim, width + 0.4, 0, -0.4, 0, GP_WALL_NO_SLIP, 0);
    CHECK(gp_run(sim, c->end));
    state = example_state(sim);
    printf("peak %.5g of the height\n", state.peak_height / height);
    printf("at_rest %d 1\n", state.at_rest);
    bench_print_cost(sim);
    gp_destroy(sim);
}

/* Sums of stresses of the particles that lie less than a width above the floor: vertical ones, horizontal ones beside walls. */
typedef struct bottom_sums {
    double vertical, horizontal; /* Pa */
    int64_t all, beside;
} bottom_sums;

static void add_bottom(bottom_sums *b, gp_sim *sim, double floor, double width, double beside) {
    const int64_t count = example_state(sim).n_particles;
    double *x = bench_field(sim, GP_FIELD_X, count), *y = bench_field(sim, GP_FIELD_Y, count);
    double *pressure = bench_field(sim, GP_FIELD_PRESSURE, count), *sxx = bench_field(sim, GP_FIELD_SXX, count);
    int64_t k;
    for (k = 0; k < count; ++k) {
        if (y[k] > floor + width)
            continue;
        b->vertical += pressure[k] + sxx[k]; /* sxx + syy = 0 */
        ++b->all;
        if (x[k] > beside && x[k] < width - beside)
            continue;
        b->horizontal += pressure[k] - sxx[k];
        ++b->beside;
    }
    free(x);
    free(y);
    free(pressure);
    free(sxx);
}

void silo(const choices *c) {
    enum { SAMPLES = 50 };
    const double width = 0.06, height = 0.36, sinking = 0.01, from = 0.5, below = 0.05;
    const gp_config config = walls_config(c, width / c->rows);
    const double weight = DENSITY * GRAVITY * width * height;
    gp_load before[3], after[3];
    int32_t plates[3];
    bottom_sums bottom = {0};
    double normal, shear;
    gp_sim *sim;
    int k;
    CHECK(gp_create(&config, &sim));
    walls_add_beads(sim, 0.002, 0);
    add_column(sim, 0, width, height, 1);
    plates[0] = add_plate(sim, width, 0, 0, 0, GP_WALL_FREE_SLIP, -sinking);
    plates[1] = add_plate(sim, 0, -below, 0, 2 * height, GP_WALL_NO_SLIP, 0);
    plates[2] = add_plate(sim, width, 2 * height, width, -below, GP_WALL_NO_SLIP, 0);
    CHECK(gp_run(sim, from));
    for (k = 0; k < 3; ++k)
        before[k] = example_load(sim, plates[k]);
    for (k = 1; k <= SAMPLES; ++k) {
        CHECK(gp_run(sim, from + (c->end - from) * k / SAMPLES));
        add_bottom(&bottom, sim, -sinking * example_state(sim).time, width, 2 * config.spacing);
    }
    for (k = 0; k < 3; ++k)
        after[k] = example_load(sim, plates[k]);
    normal = after[2].impulse_x - before[2].impulse_x - (after[1].impulse_x - before[1].impulse_x);
    shear = after[1].impulse_y - before[1].impulse_y + after[2].impulse_y - before[2].impulse_y;
    printf("friction %.5g traction over normal force of the walls\n", fabs(shear / normal));
    printf("floor %.5g of the weight\n", fabs(after[0].impulse_y - before[0].impulse_y) / (c->end - from) / weight);
    printf("walls %.5g of the weight\n", fabs(shear) / (c->end - from) / weight);
    printf("ratio %.5g horizontal stress beside the walls over vertical stress, less than a width above the floor\n",
           bottom.horizontal / (double)bottom.beside / (bottom.vertical / (double)bottom.all));
    bench_print_cost(sim);
    gp_destroy(sim);
}
