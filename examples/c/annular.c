/* An annular shear cell: the inner wall turns, the outer one presses, no gravity. Torque and flow beside the law mu(I).
 *
 * The moment M of the stress does not depend on the radius, so tau = M / (2 pi r^2) falls outwards; where it falls below
 * mu_s p the material rests. The band that flows is 9 mm thick: with 4 spacings in it the moment is 10 % too large, with
 * 8 (--resolution 24) 2 %. The outer wall is a ring of plates under a load each, which keeps the pressure; it does not keep
 * its place, so a cell whose resting part is thick slowly begins to wander about the inner wall. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "example.h"

enum { CORNERS = 48, OUTER = 24, SLICES = 2000 };

static const double inner = 0.05, outer = 0.08, pressure = 1000, grain = 0.002; /* m, m, Pa, m */
static const double pi = 3.14159265358979323846;

static int32_t add_inner_wall(gp_sim *sim, double omega) {
    double x[CORNERS + 1], y[CORNERS + 1];
    gp_plate wall;
    int32_t id;
    int k;
    for (k = 0; k <= CORNERS; ++k) { /* counter-clockwise: material outside */
        x[k] = inner * cos(2 * pi * (k % CORNERS) / CORNERS);
        y[k] = inner * sin(2 * pi * (k % CORNERS) / CORNERS);
    }
    CHECK(gp_plate_init(&wall, sizeof wall));
    wall.n_points = CORNERS + 1;
    wall.point_x = x;
    wall.point_y = y;
    wall.omega = omega;
    CHECK(gp_add_plate(sim, &wall, &id));
    return id;
}

static void add_outer_ring(gp_sim *sim) {
    int k;
    for (k = 0; k < OUTER; ++k) { /* clockwise: material inside */
        const double from = -2 * pi * k / OUTER, to = -2 * pi * (k + 1) / OUTER;
        gp_plate wall;
        CHECK(gp_plate_init(&wall, sizeof wall));
        wall.x0 = outer * cos(from);
        wall.y0 = outer * sin(from);
        wall.x1 = outer * cos(to);
        wall.y1 = outer * sin(to);
        wall.normal_pressure = pressure;
        CHECK(gp_add_plate(sim, &wall, NULL));
    }
}

/* Rings of particles, each half a spacing turned against the next. */
static void fill(gp_sim *sim, double spacing) {
    const double ring = outer * cos(pi / OUTER) - inner; /* m, between the walls where they are nearest */
    const int rows = (int)lround(ring / spacing);
    const size_t most = (size_t)rows * (size_t)(2 * pi * outer / spacing + 1);
    double *x = malloc(most * sizeof *x), *y = malloc(most * sizeof *y);
    int64_t n = 0;
    int i, j;
    if (!x || !y)
        exit(1);
    for (j = 0; j < rows; ++j) {
        const double r = inner + ring * (j + 0.5) / rows;
        const int around = (int)lround(2 * pi * r / spacing);
        for (i = 0; i < around; ++i, ++n) {
            x[n] = r * cos(2 * pi * (i + 0.5 * (j % 2)) / around);
            y[n] = r * sin(2 * pi * (i + 0.5 * (j % 2)) / around);
        }
    }
    CHECK(gp_add_particles(sim, 1, n, x, y, NULL, NULL, NULL));
    free(x);
    free(y);
}

/* rad/s of the inner wall by mu(I) at this moment (N), and the radius at which the flow ends. */
static double exact_omega(const example_options *o, double moment, double *yield) {
    const double mu_s = tan(o->mu_s_degrees * pi / 180), mu_2 = tan(o->mu_2_degrees * pi / 180), i0 = 0.3;
    double omega = 0, end;
    int k;
    *yield = sqrt(moment / (2 * pi * mu_s * pressure));
    end = fmin(*yield, outer);
    for (k = 0; k < SLICES; ++k) {
        const double r = inner + (end - inner) * (k + 0.5) / SLICES, mu = moment / (2 * pi * r * r * pressure);
        const double inertial = i0 * (mu - mu_s) / (mu_2 - mu); /* I = d (r d(omega)/dr) / sqrt(p / rho_s) */
        omega += inertial * sqrt(pressure / 2500) / grain / r * (end - inner) / SLICES;
    }
    return omega;
}

static double exact_moment(const example_options *o, double omega, double *yield) {
    double low = 2 * pi * tan(o->mu_s_degrees * pi / 180) * pressure * inner * inner;
    double high = 2 * pi * tan(o->mu_2_degrees * pi / 180) * pressure * inner * inner * (1 - 1e-9);
    while (high - low > 1e-9 * high) {
        const double middle = (low + high) / 2;
        if (exact_omega(o, middle, yield) < omega)
            low = middle;
        else
            high = middle;
    }
    return low;
}

typedef struct half {
    double from, time, impulse; /* s, s, N s: where the mean begins */
} half;

static int32_t look(void *user, gp_sim *sim) {
    half *h = user;
    double time;
    if (h->time == 0 && gp_get_clock(sim, &time, NULL, NULL) >= 0 && time >= h->from) {
        h->time = time;
        h->impulse = example_load(sim, 0).impulse_torque;
    }
    return 0;
}

int main(int argc, char **argv) {
    double omega = 10, yield = 0, spacing, exact, moment;
    example_options options = example_defaults(12, 1, "annular.h5");
    const example_extra omega_option = {"--omega", "RATE", "of the inner wall, rad/s", &omega, 0.01, 100, 0};
    gp_config config;
    gp_sim *sim;
    half h = {0, 0, 0};

    options.lift_time = NAN;
    example_parse(
        argc, argv,
        "Glass beads between a wall that turns, of 0.05 m, and a ring that presses, of 0.08 m. Reference length: "
        "their distance.",
        &options, &omega_option);
    spacing = (outer - inner) / options.resolution;
    CHECK(gp_config_init(&config, sizeof config, GP_PRESET_DEFAULT));
    config.gravity_y = 0;
    sim = example_create_with(&options, config, spacing, grain);
    add_inner_wall(sim, omega);
    add_outer_ring(sim);
    fill(sim, spacing);
    exact = exact_moment(&options, omega, &yield);

    h.from = options.end / 2;
    example_run_and_look(sim, &options, 10, look, &h);
    moment = -(example_load(sim, 0).impulse_torque - h.impulse) / (example_state(sim).time - h.time);
    printf("moment              %.4f N, mean of the second half\n", moment);
    printf("exact_moment        %.4f N\n", exact);
    printf("moment_over_exact   %.4f\n", moment / exact);
    printf("exact_yield_radius  %.4f m\n", yield);
    gp_destroy(sim);
    return 0;
}
