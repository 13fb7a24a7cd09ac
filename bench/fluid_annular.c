/* Granular fluidity in an annular Couette cell: the velocity falls off from the inner ring, as the stress does by 1/r^2. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "fluidity.h"
#include "rings.h"

static const double pi = 3.14159265358979323846, omega = 0.4; /* rad/s */
enum { SEGMENTS = 48, PLATES = 24, SAMPLES = 10, BINS = 256 };

static int32_t add_inner_ring(gp_sim *sim, double radius) {
    double x[SEGMENTS + 1], y[SEGMENTS + 1];
    gp_plate ring;
    int32_t id;
    int k;
    for (k = 0; k <= SEGMENTS; ++k) { /* counter-clockwise: material outside */
        x[k] = radius * cos(2 * pi * (k % SEGMENTS) / SEGMENTS);
        y[k] = radius * sin(2 * pi * (k % SEGMENTS) / SEGMENTS);
    }
    CHECK(gp_plate_init(&ring, sizeof ring));
    ring.n_points = SEGMENTS + 1;
    ring.point_x = x;
    ring.point_y = y;
    ring.omega = omega;
    CHECK(gp_add_plate(sim, &ring, &id));
    return id;
}

/* It moves in by a twentieth of a spacing and stays: some 1000 Pa. Plates that bear a load each would follow the material, which the
 * friction of the inner ring then pushes round it, as a shaft whirls in a dry bearing. */
static void add_outer_ring(gp_sim *sim, double radius, double spacing) {
    static const double time[2] = {0, 0.02};
    int k;
    for (k = 0; k < PLATES; ++k) {
        const double from = -2 * pi * k / PLATES, to = -2 * pi * (k + 1) / PLATES, middle = (from + to) / 2;
        const double x[2] = {0, -0.05 * spacing * cos(middle)}, y[2] = {0, -0.05 * spacing * sin(middle)};
        gp_plate p;
        CHECK(gp_plate_init(&p, sizeof p));
        p.x0 = radius * cos(from);
        p.y0 = radius * sin(from);
        p.x1 = radius * cos(to);
        p.y1 = radius * sin(to);
        p.n_knots = 2;
        p.knot_t = time;
        p.knot_x = x;
        p.knot_y = y;
        CHECK(gp_add_plate(sim, &p, NULL));
    }
}

typedef struct sums {
    double speed[BINS], count[BINS]; /* of rings, a spacing wide */
    double pressure, in_zone;        /* within three grains of the inner ring */
} sums;

static void add_sample(sums *s, gp_sim *sim, double inner, double zone, double spacing) {
    const int64_t n = example_state(sim).n_particles;
    double *x = bench_field(sim, GP_FIELD_X, n), *y = bench_field(sim, GP_FIELD_Y, n);
    double *u = bench_field(sim, GP_FIELD_VX, n), *v = bench_field(sim, GP_FIELD_VY, n);
    double *p = bench_field(sim, GP_FIELD_PRESSURE, n);
    int64_t i;
    for (i = 0; i < n; ++i) {
        const double r = hypot(x[i], y[i]);
        const int row = (int)fmin(fmax(0, (r - inner) / spacing), BINS - 1);
        s->speed[row] += (x[i] * v[i] - y[i] * u[i]) / r;
        s->count[row] += 1;
        if (r < zone) {
            s->pressure += p[i];
            s->in_zone += 1;
        }
    }
    free(x);
    free(y);
    free(u);
    free(v);
    free(p);
}

/* Means of the last .2 s. */
void fluid_annular(const choices *c) {
    const double d = 0.005, inner = 10 * d, outer = 15 * d, spacing = d / c->per_grain, span = 0.2;
    const gp_material m = fluid_beads(c, d);
    const fluid_layer law = fluid_law(&m);
    const int rows = (int)round((outer - inner) / spacing);
    gp_config config = fluid_config(c, spacing);
    fluid_annulus exact = {&law, inner, outer, 0, 0, {0}};
    static sums s;
    double before, moment, worst = 0;
    gp_sim *sim;
    int32_t ring;
    int k;
    config.gravity_y = 0;
    CHECK(gp_create(&config, &sim));
    CHECK(gp_add_material(sim, &m, NULL));
    ring = add_inner_ring(sim, inner);
    add_outer_ring(sim, outer, spacing);
    add_rings(sim, 1, inner, outer * cos(pi / PLATES), rows, spacing);
    CHECK(gp_run(sim, c->end - span));
    before = example_load(sim, ring).impulse_torque;
    for (k = 1; k <= SAMPLES; ++k) {
        CHECK(gp_run(sim, c->end - span + span * k / SAMPLES));
        add_sample(&s, sim, inner, inner + 3 * d, spacing);
    }
    exact.pressure = s.pressure / s.in_zone; /* it rises slowly, as the material cannot */
    fluid_annulus_turn(&exact, omega);
    moment = -(example_load(sim, ring).impulse_torque - before) / span;
    for (k = 0; k < rows; ++k) {
        const double right = fluid_annulus_velocity(&exact, inner + (k + 0.5) * spacing) / (omega * inner);
        worst = fmax(worst, fabs(s.speed[k] / fmax(1, s.count[k]) / (omega * inner) - right));
    }
    printf("pressure %.5g Pa\n", exact.pressure);
    printf("torque %.5g N\n", moment);
    printf("torque_exact %.5g N\n", exact.moment);
    printf("profile %.4f of the ring's speed, the largest error\n", worst);
    bench_print_cost(sim);
    gp_destroy(sim);
}
