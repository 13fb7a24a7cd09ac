/* Gravity that is turned by one degree per second: a layer without ends, and a closed box. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "walls.h"

typedef struct tilting {
    double from; /* degrees at the time 0 */
} tilting;

static int32_t turn_gravity(void *user, gp_sim *sim) {
    const tilting *t = user;
    double time, angle;
    CHECK(gp_get_clock(sim, &time, NULL, NULL));
    angle = DEGREE * (t->from + time);
    CHECK(gp_set_gravity(sim, GRAVITY * sin(angle), -GRAVITY * cos(angle)));
    return 0;
}

static void add_plate(gp_sim *sim, double x0, double y0, double x1, double y1) {
    gp_plate plate;
    CHECK(gp_plate_init(&plate, sizeof plate));
    plate.x0 = x0;
    plate.y0 = y0;
    plate.x1 = x1;
    plate.y1 = y1;
    CHECK(gp_add_plate(sim, &plate, NULL));
}

static gp_sim *create(const choices *c, double spacing, double width, double height, double period, tilting *t) {
    choices start = *c;
    gp_config config;
    gp_column column;
    gp_sim *sim;
    start.angle = t->from;
    config = walls_config(&start, spacing);
    config.periodic_x_max = period;
    CHECK(gp_create(&config, &sim));
    walls_add_beads(sim, 0.002, 0);
    CHECK(gp_column_init(&column, sizeof column));
    column.width = width;
    column.height = height;
    column.material = 1;
    CHECK(gp_add_column(sim, &column, NULL));
    CHECK(gp_set_callback(sim, 1, turn_gravity, t));
    return sim;
}

/* Largest way along a layer that is periodic, spacings. */
static double moved(gp_sim *sim, const double *begin, int64_t n, double period, double spacing) {
    double *x = bench_field(sim, GP_FIELD_X, n), most = 0;
    int64_t k;
    for (k = 0; k < n; ++k) {
        const double way = x[k] - begin[k];
        most = fmax(most, fabs(way - period * round(way / period)));
    }
    free(x);
    return most / spacing;
}

void tilt_layer(const choices *c) {
    enum { ACROSS = 12 };
    const double thickness = 0.04, spacing = thickness / c->rows, period = ACROSS * spacing;
    tilting t = {0};
    gp_sim *sim = create(c, spacing, period, thickness, period, &t);
    const int64_t n = example_state(sim).n_particles;
    double *begin = bench_field(sim, GP_FIELD_X, n), held = NAN, flow = NAN, way = 0;
    gp_state s;
    int k;
    add_plate(sim, period, 0, 0, 0);
    for (k = 1; k <= 220; ++k) {
        const double angle = 0.1 * k;
        CHECK(gp_run(sim, angle));
        way = moved(sim, begin, n, period, spacing);
        if (k == 205)
            held = way;
        if (isnan(flow) && example_state(sim).max_speed > 1e-3)
            flow = angle;
    }
    s = example_state(sim);
    printf("held %.4g dl, largest way by 20.5 degrees\n", held);
    printf("way %.4g dl, by 22 degrees\n", way);
    printf("flow %.4g degrees, from where on something is faster than 1 mm/s\n", flow);
    printf("error %.3g of what is dissipated, of the ledger\n", fabs(s.energy_error) / s.dissipated);
    bench_print_cost(sim);
    free(begin);
    gp_destroy(sim);
}

/* 60 spacings long, 6 high: in a closed box the lower wall holds what would slip. */
void tilt_box(const choices *c) {
    const double spacing = 0.03 / c->rows, length = 60 * spacing, height = 6 * spacing;
    tilting t = {19};
    gp_sim *sim = create(c, spacing, length, height, 0, &t);
    double stations[2], heights[2], before, held;
    gp_state s;
    add_plate(sim, length, 0, 0, 0);
    add_plate(sim, 0, 0, 0, 5 * height);
    add_plate(sim, length, 5 * height, length, 0);
    CHECK(gp_run(sim, 20 - t.from));
    before = example_state(sim).x_q50;
    CHECK(gp_run(sim, 20.5 - t.from));
    held = example_state(sim).x_q50;
    CHECK(gp_run(sim, 26 - t.from));
    s = example_state(sim);
    stations[0] = 0.15 * length;
    stations[1] = 0.85 * length;
    CHECK(gp_get_surface(sim, 2, stations, heights));
    printf("held %.4g dl, of the middle from 20 to 20.5 degrees\n", fabs(held - before) / spacing);
    printf("surface %.4g degrees to gravity at 26\n", 26 - atan((heights[1] - heights[0]) / (0.7 * length)) / DEGREE);
    printf("error %.3g of what is dissipated, of the ledger\n", fabs(s.energy_error) / s.dissipated);
    bench_print_cost(sim);
    gp_destroy(sim);
}
