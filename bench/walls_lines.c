/* Floors and bowls of several plates: they are to do what one plate, or a smooth curve, does. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "walls.h"

static void plate_between(gp_sim *sim, const walls_point *from, const walls_point *to, int32_t friction, int32_t *id) {
    gp_plate plate;
    CHECK(gp_plate_init(&plate, sizeof plate));
    plate.x0 = from->x;
    plate.y0 = from->y;
    plate.x1 = to->x;
    plate.y1 = to->y;
    plate.friction = friction;
    plate.wall_mu = friction == GP_WALL_COULOMB ? 0.3 : 0;
    CHECK(gp_add_plate(sim, &plate, id));
}

/* A straight way in so many pieces, plates of their own. */
static void add_pieces(gp_sim *sim, walls_point from, walls_point to, int count, int32_t friction) {
    int k;
    for (k = 0; k < count; ++k) {
        const walls_point a = {from.x + (to.x - from.x) * k / count, from.y + (to.y - from.y) * k / count};
        const walls_point b = {from.x + (to.x - from.x) * (k + 1) / count, from.y + (to.y - from.y) * (k + 1) / count};
        plate_between(sim, &a, &b, friction, NULL);
    }
}

void walls_fill(gp_sim *sim, double spacing, walls_point low, walls_point high,
                int (*inside)(double x, double y, const void *user), const void *user) {
    double *x = bench_doubles(WALLS_MOST), *y = bench_doubles(WALLS_MOST);
    int64_t n = 0;
    int i, j;
    for (j = 0; low.y + (j + 0.5) * spacing < high.y; ++j)
        for (i = 0; low.x + (i + 0.5) * spacing < high.x && n < WALLS_MOST; ++i) {
            x[n] = low.x + (i + 0.5) * spacing;
            y[n] = low.y + (j + 0.5) * spacing;
            n += inside(x[n], y[n], user) != 0;
        }
    CHECK(gp_add_particles(sim, 1, n, x, y, NULL, NULL, NULL));
    free(x);
    free(y);
}

int walls_arc(double radius, double from, double to, int count, walls_point *points) {
    int k;
    for (k = 0; k <= count; ++k) {
        const double angle = DEGREE * (from + (to - from) * k / count);
        points[k].x = radius * cos(angle);
        points[k].y = radius * sin(angle);
    }
    if (fabs(to - from) == 360) /* sines of a full turn are not quite zero */
        points[count] = points[0];
    return count + 1;
}

/* s, since when it is at rest, looked at every interval until the end; NAN: it is not. fallen: J/m, the most by which wall_dissipated
 * has been below an earlier value; taken: its highest. */
static double settle(gp_sim *sim, double end, double interval, double *fallen, double *taken) {
    double rest = NAN;
    int k;
    *fallen = *taken = 0;
    for (k = 1; k * interval < end + 0.5 * interval; ++k) {
        gp_state s;
        CHECK(gp_run(sim, k * interval));
        s = example_state(sim);
        if (!s.at_rest)
            rest = NAN;
        else if (isnan(rest))
            rest = s.time;
        *taken = fmax(*taken, s.wall_dissipated);
        *fallen = fmax(*fallen, *taken - s.wall_dissipated);
    }
    return rest;
}

/* A column of .2 x .1 m between smooth side walls; the floor begins half a spacing off its lattice. */
void pieces(const choices *c) {
    const double width = 0.2, height = 0.1, spacing = height / c->rows, off = spacing / 2;
    const gp_config config = walls_config(c, spacing);
    const walls_point right = {1.5 * width + off, 0}, left = {-width / 2 + off, 0};
    const walls_point sides[4] = {{0, -height / 2}, {0, 3 * height}, {width, 3 * height}, {width, -height / 2}};
    double *x, *y, *p, low = INFINITY, high = 0, rest, fallen, taken;
    int64_t n, k;
    gp_column column;
    gp_sim *sim;
    CHECK(gp_create(&config, &sim));
    walls_add_beads(sim, 0.002, 0);
    CHECK(gp_column_init(&column, sizeof column));
    column.width = width;
    column.height = height;
    column.material = 1;
    CHECK(gp_add_column(sim, &column, NULL));
    add_pieces(sim, right, left, (int)c->segments, c->wall);
    plate_between(sim, &sides[0], &sides[1], GP_WALL_FREE_SLIP, NULL);
    plate_between(sim, &sides[2], &sides[3], GP_WALL_FREE_SLIP, NULL);
    rest = settle(sim, c->end, 0.01, &fallen, &taken);
    n = example_state(sim).n_particles;
    x = bench_field(sim, GP_FIELD_X, n);
    y = bench_field(sim, GP_FIELD_Y, n);
    p = bench_field(sim, GP_FIELD_PRESSURE, n);
    for (k = 0; k < n; ++k)
        if (y[k] < spacing && x[k] > 2 * spacing && x[k] < width - 2 * spacing) {
            const double ratio = p[k] / (DENSITY * GRAVITY * (height - y[k]));
            low = fmin(low, ratio);
            high = fmax(high, ratio);
        }
    printf("pressure_least %.6f of the hydrostatic one, lowest row\n", low);
    printf("pressure_most %.6f of the hydrostatic one, lowest row\n", high);
    printf("rest %.4g s\n", rest);
    bench_print_cost(sim);
    free(x);
    free(y);
    free(p);
    gp_destroy(sim);
}

static double mean_way(gp_sim *sim, int64_t n, double c, double s) {
    double *x = bench_field(sim, GP_FIELD_X, n), *y = bench_field(sim, GP_FIELD_Y, n), sum = 0;
    int64_t k;
    for (k = 0; k < n; ++k)
        sum += (x[k] * c - y[k] * s) / (double)n;
    free(x);
    free(y);
    return sum;
}

/* A block of ten rows down a slope of .6 m. */
void pieces_slope(const choices *c) {
    const double spacing = 0.1 / c->rows, cosine = cos(c->angle * DEGREE), sine = sin(c->angle * DEGREE), length = 0.6;
    const walls_point foot = {length * cosine, -length * sine}, head = {0, 0};
    enum { ACROSS = 40, UP = 10, COUNT = ACROSS * UP };
    choices level = *c;
    double x[COUNT], y[COUNT], before;
    gp_config config;
    gp_sim *sim;
    int k;
    level.angle = 0; /* the plates are inclined, not gravity */
    config = walls_config(&level, spacing);
    for (k = 0; k < COUNT; ++k) {
        const double along = 0.1 + (k % ACROSS + 0.5) * spacing, above = (k / ACROSS + 0.5) * spacing;
        x[k] = along * cosine + above * sine;
        y[k] = above * cosine - along * sine;
    }
    CHECK(gp_create(&config, &sim));
    walls_add_beads(sim, 0.002, 0);
    CHECK(gp_add_particles(sim, 1, COUNT, x, y, NULL, NULL, NULL));
    add_pieces(sim, foot, head, (int)c->segments, c->wall);
    before = mean_way(sim, COUNT, cosine, sine);
    CHECK(gp_run(sim, c->end));
    printf("way %.6g m\n", mean_way(sim, COUNT, cosine, sine) - before);
    bench_print_cost(sim);
    gp_destroy(sim);
}

typedef struct bowl_line {
    walls_point points[WALLS_CORNERS];
    int count;
    double margin; /* m */
} bowl_line;

static int inside_bowl(double x, double y, const void *user) {
    const bowl_line *b = user;
    int k;
    for (k = 0; k + 1 < b->count; ++k) {
        const double tx = b->points[k + 1].x - b->points[k].x, ty = b->points[k + 1].y - b->points[k].y;
        if ((ty * (x - b->points[k].x) - tx * (y - b->points[k].y)) / hypot(tx, ty) <= b->margin)
            return 0;
    }
    return 1;
}

void bowl(const choices *c) {
    const double radius = 0.05, spacing = radius / c->rows;
    const gp_config config = walls_config(c, spacing);
    const walls_point low = {-radius, -radius}, high = {radius, 0};
    static bowl_line line;
    double rest, fallen, taken, weight;
    gp_sim *sim;
    int k;
    CHECK(gp_create(&config, &sim));
    walls_add_beads(sim, 0.002, 0);
    line.count = walls_arc(radius, 0, -180, (int)c->segments, line.points);
    line.margin = 0.499 * spacing;
    walls_fill(sim, spacing, low, high, inside_bowl, &line);
    for (k = 0; k + 1 < line.count; ++k)
        plate_between(sim, &line.points[k], &line.points[k + 1], GP_WALL_NO_SLIP, NULL);
    rest = settle(sim, c->end, 0.01, &fallen, &taken);
    weight = (double)example_state(sim).n_particles * spacing * spacing * DENSITY * GRAVITY;
    printf("rest %.4g s\n", rest);
    printf("fallen %.4g of the highest wall_dissipated\n", fallen / taken);
    printf("fallen_energy %.4g of weight times radius\n", fallen / (weight * radius));
    bench_print_cost(sim);
    gp_destroy(sim);
}
