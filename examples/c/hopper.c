/* A hopper empties through its outlet onto a floor: how much flows out per second?
 *
 * Beverloo's law: rho sqrt(g) D^1.5 per metre of depth, times a number that does not know how much is left above: not that of a
 * fluid, which falls with the square root of the filling. */
#include <math.h>
#include <stdio.h>

#include "example.h"

enum { MOST_LOOKS = 100000 };

static const double outlet = 0.05, width = 0.25; /* m */

typedef struct record {
    double spacing, next;
    int n;
    double time[MOST_LOOKS], mass[MOST_LOOKS]; /* s; kg/m above the outlet */
} record;

/* Bin and funnel at 45 degrees: one line each side, from below upwards on the left, from above downwards on the right, as the
 * plate's body is on the left of its way. */
static void add_walls(gp_sim *sim, double top) {
    const double shoulder = (width - outlet) / 2;
    const double left_x[] = {-outlet / 2, -width / 2, -width / 2}, left_y[] = {0, shoulder, top};
    const double right_x[] = {width / 2, width / 2, outlet / 2}, right_y[] = {top, shoulder, 0};
    gp_plate wall;
    CHECK(gp_plate_init(&wall, sizeof wall));
    wall.n_points = 3;
    wall.point_x = left_x;
    wall.point_y = left_y;
    CHECK(gp_add_plate(sim, &wall, NULL));
    wall.point_x = right_x;
    wall.point_y = right_y;
    CHECK(gp_add_plate(sim, &wall, NULL));
}

/* Half a spacing off the walls. */
static int is_inside(double x, double y, const void *user) {
    const record *r = user;
    return (y - (fabs(x) - outlet / 2)) / sqrt(2.0) > 0.49 * r->spacing;
}

/* Between two steps, 100 times a second: what is still above the outlet? */
static int32_t look(void *user, gp_sim *sim) {
    record *r = user;
    gp_particles p = {.struct_size = sizeof p};
    double time;
    int64_t k;
    if (gp_get_clock(sim, &time, NULL, NULL) < 0 || time < r->next || r->n == MOST_LOOKS)
        return 0;
    if (gp_get_particles(sim, GP_FIELD_Y | GP_FIELD_DENSITY, &p) < 0)
        return 1;
    r->time[r->n] = time;
    r->mass[r->n] = 0;
    for (k = 0; k < p.count; ++k)
        r->mass[r->n] += p.y[k] > 0 ? 2500 * 0.62 * r->spacing * r->spacing : 0;
    ++r->n;
    r->next = time + 0.01;
    return 0;
}

/* kg/(m s) from the first look at or after `from`, and at the latest when a fifth is left, by a straight line. */
static double flow_rate(const record *r, double from) {
    double n = 0, t = 0, m = 0, tt = 0, tm = 0;
    int k;
    for (k = 0; k < r->n; ++k)
        if (r->time[k] >= from && r->mass[k] > 0.2 * r->mass[0]) {
            n += 1;
            t += r->time[k];
            m += r->mass[k];
            tt += r->time[k] * r->time[k];
            tm += r->time[k] * r->mass[k];
        }
    return -(n * tm - t * m) / (n * tt - t * t);
}

int main(int argc, char **argv) {
    static record r;
    double height = 0.25;
    example_options options = example_defaults(10, 1.2, "hopper.h5");
    const example_extra height_option = {"--height", "H", "filling above the outlet, m", &height, 0.12, 10, 0};
    gp_plate ground;
    gp_sim *sim;
    int k;

    options.lift_time = NAN;
    example_parse(
        argc, argv,
        "Glass beads flow out of a hopper, 0.25 m wide, with an outlet of 0.05 m. Reference length: the outlet.",
        &options, &height_option);
    r.spacing = outlet / options.resolution;
    sim = example_create(&options, r.spacing, 0.002);
    add_walls(sim, height + 6 * r.spacing);
    CHECK(gp_plate_init(&ground, sizeof ground));
    ground.x0 = 1;
    ground.x1 = -1;
    ground.y0 = ground.y1 = -0.3;
    CHECK(gp_add_plate(sim, &ground, NULL));
    example_fill(sim, r.spacing, -width / 2, width / 2, 0, height, is_inside, &r);

    example_run_and_look(sim, &options, 10, look, &r);
    printf("# time s, mass above the outlet kg/m\n");
    for (k = 0; k < r.n; k += 5)
        printf("%.3f %.4f\n", r.time[k], r.mass[k]);
    printf("flow_rate           %.5g kg/(m s), from 0.2 s on\n", flow_rate(&r, 0.2));
    printf("flow_rate_scaled    %.4f rho sqrt(g) D^1.5\n",
           flow_rate(&r, 0.2) / (2500 * 0.62 * sqrt(9.81) * pow(outlet, 1.5)));
    gp_destroy(sim);
    return 0;
}
