/* A drum turns and its filling flows: one closed line of corners, one rigid body, one load.
 *
 * The surface comes to a slope between the yield angle and that of fast flow; the moment that keeps the drum turning does the
 * work that the flow dissipates. */
#include <math.h>
#include <stdio.h>

#include "example.h"

enum { CORNERS = 48 };

static const double radius = 0.1, filling = 0.35; /* m; share of the drum */
static const double pi = 3.14159265358979323846;

typedef struct record {
    double level, inner;            /* m: the filling's surface at the start, and the radius that it stays within */
    double slope;                   /* rad, sum of the looks from 1 rad on: by then the surface has come to its slope */
    double angle, work, dissipated; /* rad, J/m: by the first of them */
    double omega;
    int looks;
} record;

/* Clockwise, so that the body of the line is outside and the material inside. */
static int32_t add_drum(gp_sim *sim, double omega) {
    double x[CORNERS + 1], y[CORNERS + 1];
    gp_plate drum;
    int32_t id;
    int k;
    for (k = 0; k <= CORNERS; ++k) {
        x[k] = radius * cos(-2 * pi * (k % CORNERS) / CORNERS);
        y[k] = radius * sin(-2 * pi * (k % CORNERS) / CORNERS);
    }
    CHECK(gp_plate_init(&drum, sizeof drum));
    drum.n_points = CORNERS + 1; /* the last is the first: closed */
    drum.point_x = x;
    drum.point_y = y;
    drum.omega = omega; /* about the pivot, which is the origin unless said otherwise */
    CHECK(gp_add_plate(sim, &drum, &id));
    return id;
}

static int is_inside(double x, double y, const void *user) {
    const record *r = user;
    return y < r->level && hypot(x, y) < r->inner;
}

/* The height below which a circle has this share of its area. */
static double level_of(double share) {
    double low = -1, high = 1;
    while (high - low > 1e-9) {
        const double y = (low + high) / 2;
        if ((asin(y) + y * sqrt(1 - y * y)) / pi + 0.5 < share)
            low = y;
        else
            high = y;
    }
    return low * radius;
}

/* Under a plane surface the centre of mass lies perpendicularly below the axis. */
static int32_t look(void *user, gp_sim *sim) {
    record *r = user;
    const gp_load load = example_load(sim, 0);
    gp_state state;
    if (load.angle < 1)
        return 0;
    state = example_state(sim);
    if (r->looks++ == 0) {
        r->angle = load.angle;
        r->work = -r->omega * load.impulse_torque;
        r->dissipated = state.dissipated;
    }
    r->slope += atan2(state.centre_x, -state.centre_y);
    return 0;
}

int main(int argc, char **argv) {
    static record r;
    double spacing;
    example_options options = example_defaults(40, 4, "drum.h5");
    const example_extra omega_option = {"--omega", "RATE", "of turning, rad/s", &r.omega, 0.01, 5, 0};
    gp_sim *sim;
    gp_state state;
    gp_load load;

    r.omega = 1;
    options.lift_time = NAN;
    example_parse(argc, argv, "Glass beads in a drum that turns, 0.2 m wide. Reference length: its radius.", &options,
                  &omega_option);
    spacing = radius / options.resolution;
    sim = example_create(&options, spacing, 0.002);
    add_drum(sim, r.omega);
    r.level = level_of(filling);
    r.inner = radius * cos(pi / CORNERS) - spacing / 2;
    example_fill(sim, spacing, -radius, radius, -radius, radius, is_inside, &r);

    example_run_and_look(sim, &options, 100, look, &r);
    state = example_state(sim);
    load = example_load(sim, 0);
    printf("turned              %.4f rad\n", load.angle);
    if (r.looks > 1) {
        printf("surface_slope       %.2f degrees, mean from 1 rad on\n", r.slope / r.looks * 180 / pi);
        printf("moment              %.4f N, that keeps it turning\n",
               (-r.omega * load.impulse_torque - r.work) / (load.angle - r.angle));
        printf("work_per_dissipated %.4f from 1 rad on\n",
               (-r.omega * load.impulse_torque - r.work) / (state.dissipated - r.dissipated));
    }
    gp_destroy(sim);
    return 0;
}
