/* Walls that turn: a rotating drum, and the inner ring of a Couette cell. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "rings.h"
#include "walls.h"

static const double pi = 3.14159265358979323846;

static int32_t add_ring(gp_sim *sim, const walls_point *points, int count, double omega) {
    double x[WALLS_CORNERS], y[WALLS_CORNERS];
    gp_plate ring;
    int32_t id;
    int k;
    for (k = 0; k < count; ++k) {
        x[k] = points[k].x;
        y[k] = points[k].y;
    }
    CHECK(gp_plate_init(&ring, sizeof ring));
    ring.n_points = count;
    ring.point_x = x;
    ring.point_y = y;
    ring.omega = omega; /* about the origin */
    CHECK(gp_add_plate(sim, &ring, &id));
    return id;
}

/* ------------------------------------------------------------------------------------------------------------- drum */

typedef struct drum_shape {
    int segments;
    double distance, angle; /* m, from the middle in the direction of each segment; rad, turned by */
} drum_shape;

static int inside_drum(double x, double y, const void *user) {
    const drum_shape *d = user;
    int k;
    for (k = 0; k < d->segments; ++k) {
        const double at = d->angle - 2 * pi * (k + 0.5) / d->segments;
        if (x * cos(at) + y * sin(at) > d->distance)
            return 0;
    }
    return 1;
}

static int64_t escaped(gp_sim *sim, drum_shape shape, double angle) {
    const int64_t n = example_state(sim).n_particles;
    double *x = bench_field(sim, GP_FIELD_X, n), *y = bench_field(sim, GP_FIELD_Y, n);
    int64_t k, found = 0;
    shape.angle = angle;
    for (k = 0; k < n; ++k)
        found += !inside_drum(x[k], y[k], &shape);
    free(x);
    free(y);
    return found;
}

/* Degrees, of a straight line through the surface in the middle half. */
static double slope_of(gp_sim *sim, double radius) {
    enum { STATIONS = 21 };
    double x[STATIONS], h[STATIONS], xy = 0, xx = 0;
    int k;
    for (k = 0; k < STATIONS; ++k)
        x[k] = radius * (k / (STATIONS - 1.0) - 0.5);
    CHECK(gp_get_surface(sim, STATIONS, x, h));
    for (k = 0; k < STATIONS; ++k) {
        xy += x[k] * h[k];
        xx += x[k] * x[k];
    }
    return atan(xy / xx) / DEGREE;
}

static double stored(const gp_state *s) {
    return s->kinetic + s->potential + s->elastic;
}

/* Looks from .3 of a turn on: by then the fill has gone round about once. */
void drum(const choices *c) {
    enum { LOOKS_PER_TURN = 20 };
    const double radius = 0.1, spacing = radius / c->rows, omega = sqrt(c->froude * GRAVITY / radius),
                 turn = 2 * pi / omega, from = 0.3;
    const gp_config config = walls_config(c, spacing);
    const int segments = (int)c->segments, looks = (int)lround((c->turns - from) * LOOKS_PER_TURN);
    const double apothem = radius * cos(pi / segments);
    const drum_shape start = {segments, apothem - spacing / 2, 0}, shape = {segments, apothem, 0};
    const walls_point low = {-radius, -radius}, high = {radius, -0.34 * radius}; /* a segment of 30 % of the circle */
    static walls_point points[WALLS_CORNERS];
    double least = INFINITY, most = -INFINITY, mean = 0, half[2] = {0, 0};
    gp_state before, after;
    gp_load first, last;
    gp_sim *sim;
    int64_t lost = 0;
    int32_t id;
    int k;
    CHECK(gp_create(&config, &sim));
    walls_add_beads(sim, 0.002, 0);
    walls_fill(sim, spacing, low, high, inside_drum, &start);
    id = add_ring(sim, points, walls_arc(radius, 0, -360, segments, points), omega);
    CHECK(gp_run(sim, from * turn));
    before = example_state(sim);
    first = example_load(sim, id);
    for (k = 1; k <= looks; ++k) {
        double slope;
        int64_t out;
        CHECK(gp_run(sim, (from + (double)k / LOOKS_PER_TURN) * turn));
        slope = slope_of(sim, radius);
        out = escaped(sim, shape, example_load(sim, id).angle);
        lost = out > lost ? out : lost;
        least = fmin(least, slope);
        most = fmax(most, slope);
        mean += slope / looks;
        half[k > looks / 2] += slope / (k > looks / 2 ? looks - looks / 2 : looks / 2);
    }
    after = example_state(sim);
    last = example_load(sim, id);
    printf("turns %.5g 1\n", last.angle / (2 * pi));
    printf("outside %lld particles, at most\n", (long long)lost);
    printf("slope %.4g degrees\n", mean);
    printf("slope_least %.4g degrees\n", least);
    printf("slope_most %.4g degrees\n", most);
    printf("slope_early %.4g degrees, mean of the first half\n", half[0]);
    printf("slope_late %.4g degrees, mean of the second half\n", half[1]);
    printf("work %.5g of what is dissipated and stored\n",
           -omega * (last.impulse_torque - first.impulse_torque) /
               (after.dissipated - before.dissipated + stored(&after) - stored(&before)));
    bench_print_cost(sim);
    gp_destroy(sim);
}

/* ---------------------------------------------------------------------------------------------------- annular cell */

static const double inner = 0.04, outer = 0.066, load = 1000, turning = 1; /* m, m, Pa, rad/s */
/* Coarse grains that bear more the faster they shear: the zone that flows is 15 mm wide. */
static const double mu_s = 0.2, mu_2 = 0.8, i0 = 0.3, diameter = 0.01, grain_density = 2500;

static double yield_radius(double moment, double pressure) {
    return sqrt(moment / (2 * pi * mu_s * pressure));
}

/* m/s, of mu(I) in one dimension at r: the shear stress is M / (2 pi r^2), and rest from the yield radius on. */
static double law_velocity(double moment, double pressure, double r) {
    enum { STEPS = 400 };
    const double end = yield_radius(moment, pressure);
    double rate = 0;
    int k;
    for (k = 0; k < STEPS && r < end; ++k) {
        const double at = r + (end - r) * (k + 0.5) / STEPS, mu = moment / (2 * pi * at * at * pressure);
        const double inertial = mu > mu_s ? i0 * (mu - mu_s) / (mu_2 - mu) : 0;
        rate += inertial * sqrt(pressure / grain_density) / diameter / at * (end - r) / STEPS;
    }
    return rate * r;
}

static double law_moment(double pressure) {
    double low = 2 * pi * mu_s * pressure * inner * inner, high = 0.9999 * low * mu_2 / mu_s;
    int k;
    for (k = 0; k < 60; ++k) {
        const double middle = (low + high) / 2;
        if (law_velocity(middle, pressure, inner) < turning * inner)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* Where a falling profile of n bins, at radii from `first` in steps, goes below a value. */
static double falls_to(const double *u, int n, double first, double step, double value) {
    int k;
    for (k = 1; k < n; ++k)
        if (u[k] < value)
            return first + step * (k - 1 + (u[k - 1] - value) / (u[k - 1] - u[k]));
    return NAN;
}

static void add_outer_plates(gp_sim *sim, int count) {
    walls_point points[WALLS_CORNERS];
    int k;
    walls_arc(outer, 0, -360, count, points);
    for (k = 0; k < count; ++k) {
        gp_plate p;
        CHECK(gp_plate_init(&p, sizeof p));
        p.x0 = points[k].x;
        p.y0 = points[k].y;
        p.x1 = points[k + 1].x;
        p.y1 = points[k + 1].y;
        p.normal_pressure = load;
        CHECK(gp_add_plate(sim, &p, NULL));
    }
}

/* The inner ring turns, the outer one of 24 plates is pressed on. Steady within .3 s; means of the second half. */
void annular(const choices *c) {
    enum { PLATES = 24, SEGMENTS = 96, SAMPLES = 20, BINS = 256 };
    const double spacing = inner / c->rows, apothem = outer * cos(pi / PLATES), edge = 0.02;
    const int rows = (int)round((apothem - inner) / spacing);
    gp_config config = walls_config(c, spacing);
    double speed[BINS] = {0}, count[BINS] = {0}, exact[BINS], before, moment, right, pressure = 0, in_zone = 0, off = 0;
    const double zone = yield_radius(law_moment(load), load);
    static walls_point points[WALLS_CORNERS];
    gp_material material;
    gp_sim *sim;
    int32_t ring;
    int k;
    config.gravity_x = config.gravity_y = 0;
    CHECK(gp_create(&config, &sim));
    CHECK(gp_material_init(&material, sizeof material));
    material.mu_s = mu_s;
    material.mu_2 = mu_2;
    material.i0 = i0;
    material.grain_diameter = diameter;
    CHECK(gp_add_material(sim, &material, NULL));
    ring = add_ring(sim, points, walls_arc(inner, 0, 360, SEGMENTS, points), turning);
    add_outer_plates(sim, PLATES);
    add_rings(sim, 1, inner, apothem, rows, spacing);
    CHECK(gp_run(sim, 0.5 * c->end));
    before = example_load(sim, ring).impulse_torque;
    for (k = 1; k <= SAMPLES; ++k) {
        int64_t n, i;
        double *x, *y, *u, *v, *p;
        CHECK(gp_run(sim, 0.5 * c->end * (1 + (double)k / SAMPLES)));
        n = example_state(sim).n_particles;
        x = bench_field(sim, GP_FIELD_X, n);
        y = bench_field(sim, GP_FIELD_Y, n);
        u = bench_field(sim, GP_FIELD_VX, n);
        v = bench_field(sim, GP_FIELD_VY, n);
        p = bench_field(sim, GP_FIELD_PRESSURE, n);
        for (i = 0; i < n; ++i) {
            const double r = hypot(x[i], y[i]);
            const int row = (int)fmin(fmax(0, (r - inner) / spacing), BINS - 1);
            speed[row] += (x[i] * v[i] - y[i] * u[i]) / r;
            count[row] += 1;
            if (r < zone) {
                pressure += p[i];
                in_zone += 1;
            }
        }
        free(x);
        free(y);
        free(u);
        free(v);
        free(p);
    }
    /* The outer ring decides only the pressure of the outermost rows: the law at the pressure that is where it flows. */
    pressure /= in_zone;
    right = law_moment(pressure);
    moment = -(example_load(sim, ring).impulse_torque - before) / (0.5 * c->end);
    for (k = 0; k < rows; ++k) {
        speed[k] /= fmax(1, count[k]) * turning * inner;
        exact[k] = law_velocity(right, pressure, inner + (k + 0.5) * spacing) / (turning * inner);
        off = fmax(off, fabs(speed[k] - exact[k]));
    }
    printf("pressure %.5g of the load, where it flows\n", pressure / load);
    printf("torque %.5g N\n", moment);
    printf("torque_exact %.5g N\n", right);
    printf("edge %.5g m, where the speed is .02 of the ring's\n",
           falls_to(speed, rows, inner + spacing / 2, spacing, edge));
    printf("edge_exact %.5g m\n", falls_to(exact, rows, inner + spacing / 2, spacing, edge));
    printf("yield_radius %.5g m, by the torque\n", yield_radius(moment, pressure));
    printf("yield_radius_exact %.5g m\n", yield_radius(right, pressure));
    printf("profile %.4f of the ring's speed, the largest error\n", off);
    bench_print_cost(sim);
    gp_destroy(sim);
}
