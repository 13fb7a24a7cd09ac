/* A mass of debris is released on a hillside: how far does it go? The profile comes from a file of two columns.
 *
 * The terrain is one line of any number of points; what is asked of it is that its segments are no shorter than a tenth of the
 * spacing and that it does not cross itself. The spacing has to leave the flow some four rows where it is thinnest: fewer pack
 * too closely (the library warns of it). */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "example.h"

enum { MOST_POINTS = 10000 };

static const double from = 4, to = 32, depth = 6; /* m: the release area in x, and how deep it is */

typedef struct profile {
    int n;
    double x[MOST_POINTS], y[MOST_POINTS];
    double spacing;
} profile;

/* Lines of x, y in m; what follows a # and a title in the first line do not count. */
static void read_profile(profile *p, const char *path) {
    char line[256];
    int number, titled = 0;
    FILE *file = fopen(path, "r");
    if (!file) {
        fprintf(stderr, "terrain: %s: %s\n", path, strerror(errno));
        exit(2);
    }
    for (number = 1; fgets(line, sizeof line, file); ++number) {
        char rest[2];
        line[strcspn(line, "#\n")] = '\0';
        if (line[strspn(line, " \t\r")] == '\0')
            continue;
        if (p->n < MOST_POINTS && sscanf(line, "%lf , %lf %1s", &p->x[p->n], &p->y[p->n], rest) == 2 &&
            (p->n == 0 || p->x[p->n] > p->x[p->n - 1])) {
            ++p->n;
        } else if (p->n > 0 || titled++) {
            fprintf(stderr, "terrain: %s, line %d: expected x, y with x above that before, and %d points at most: %s\n",
                    path, number, MOST_POINTS, line);
            exit(2);
        }
    }
    fclose(file);
}

static double height_at(const profile *p, double x) {
    int k = 1;
    while (k < p->n - 1 && x > p->x[k])
        ++k;
    return p->y[k - 1] + (x - p->x[k - 1]) * (p->y[k] - p->y[k - 1]) / (p->x[k] - p->x[k - 1]);
}

/* The profile runs from left to right; the plate's body is on the left of its way, so the plate runs the other way. */
static void add_terrain(gp_sim *sim, const profile *p) {
    static double x[MOST_POINTS], y[MOST_POINTS];
    gp_plate ground;
    int k;
    for (k = 0; k < p->n; ++k) {
        x[k] = p->x[p->n - 1 - k];
        y[k] = p->y[p->n - 1 - k];
    }
    CHECK(gp_plate_init(&ground, sizeof ground));
    ground.n_points = p->n;
    ground.point_x = x;
    ground.point_y = y;
    CHECK(gp_add_plate(sim, &ground, NULL));
}

/* Between the ground, half a spacing off it, and the depth above it; thinner towards both ends. */
static int is_inside(double x, double y, const void *user) {
    const profile *p = user;
    const double slope = (height_at(p, x + p->spacing) - height_at(p, x - p->spacing)) / (2 * p->spacing);
    const double above = (y - height_at(p, x)) / sqrt(1 + slope * slope); /* about the distance to the ground */
    const double thickness = fmin(depth, fmin(x - from, to - x));
    return above > 0.49 * p->spacing && above < thickness;
}

int main(int argc, char **argv) {
    static profile p;
    const char *path = argc > 1 && argv[1][0] != '-' ? argv[1] : NULL;
    double top, reach;
    example_options options = example_defaults(15, 16, "terrain.h5");
    gp_sim *sim;
    gp_state state;

    options.lift_time = NAN;
    options.mu_s_degrees = 24;
    options.mu_2_degrees = 34;
    if (path)
        argv[1] = argv[0];
    example_parse(
        argc - (path != NULL), argv + (path != NULL),
        "terrain PROFILE.csv [options]: debris, released on the hillside of this file (x, y in m, from left to right) "
        "between x = 4 and 32 m. Reference length: the depth of the release, 6 m.",
        &options, NULL);
    if (!path) {
        fprintf(stderr, "terrain: expected the file of a profile first, as examples/data/hillside.csv (see --help)\n");
        return 2;
    }
    read_profile(&p, path);
    if (p.n < 2 || p.x[0] > from || p.x[p.n - 1] < to) {
        fprintf(stderr, "terrain: %s: expected a profile from x <= %g to x >= %g m\n", path, from, to);
        return 2;
    }
    p.spacing = depth / options.resolution;
    sim = example_create(&options, p.spacing, 0.2);
    add_terrain(sim, &p);
    example_fill(sim, p.spacing, from, to, height_at(&p, to), height_at(&p, from) + depth, is_inside, &p);
    state = example_state(sim);
    top = height_at(&p, from);

    example_run(sim, &options);
    reach = example_state(sim).x_q95;
    printf("released            %.4g m2\n", (double)state.n_particles * p.spacing * p.spacing);
    printf("centre_moves_by     %.2f m in x\n", example_state(sim).centre_x - state.centre_x);
    printf("reach_95            %.2f m: 95 %% of the mass lie to the left\n", reach);
    printf("travel_angle        %.2f degrees from the top of the release to there\n",
           atan2(top - height_at(&p, reach), reach - from) * 180 / acos(-1.0));
    gp_destroy(sim);
    return 0;
}
