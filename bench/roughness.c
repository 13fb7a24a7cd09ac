#include "roughness.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "../examples/c/example.h" /* CHECK */

/* Particles by square cells as wide as the radius: those of cell c are order[begin[c]] to order[begin[c + 1]]. */
typedef struct cells {
    double x, y, width;
    int64_t columns, rows, *begin, *order;
} cells;

static void *allocate(size_t n, size_t size) {
    void *memory = calloc(n > 0 ? n : 1, size);
    if (!memory) {
        fprintf(stderr, "out of memory\n");
        exit(1);
    }
    return memory;
}

static int64_t cell_of(const cells *c, double x, double y) {
    return (int64_t)((y - c->y) / c->width) * c->columns + (int64_t)((x - c->x) / c->width);
}

static cells sort_particles(const gp_particles *p, double width) {
    cells c = {.x = INFINITY, .y = INFINITY, .width = width};
    double right = -INFINITY, top = -INFINITY;
    int64_t i, *next;
    for (i = 0; i < p->count; ++i) {
        c.x = fmin(c.x, p->x[i]);
        c.y = fmin(c.y, p->y[i]);
        right = fmax(right, p->x[i]);
        top = fmax(top, p->y[i]);
    }
    c.columns = (int64_t)((right - c.x) / width) + 1;
    c.rows = (int64_t)((top - c.y) / width) + 1;
    c.begin = allocate((size_t)(c.columns * c.rows + 1), sizeof *c.begin);
    next = allocate((size_t)(c.columns * c.rows), sizeof *next);
    c.order = allocate((size_t)p->count, sizeof *c.order);
    for (i = 0; i < p->count; ++i)
        ++c.begin[cell_of(&c, p->x[i], p->y[i]) + 1];
    for (i = 0; i < c.columns * c.rows; ++i)
        c.begin[i + 1] += c.begin[i];
    for (i = 0; i < p->count; ++i) {
        const int64_t k = cell_of(&c, p->x[i], p->y[i]);
        c.order[c.begin[k] + next[k]++] = i;
    }
    free(next);
    return c;
}

/* Weighted sums over the neighbours of one particle. */
typedef struct sums {
    int64_t neighbours;
    double w, x, y, xx, xy, yy, p, px, py;
    double ux, uy, vx, vy, square; /* of velocity differences with the distance, and of their square */
} sums;

static void add(sums *s, const gp_particles *q, int64_t i, int64_t j, double radius) {
    const double x = q->x[j] - q->x[i], y = q->y[j] - q->y[i], r = hypot(x, y);
    const double w = r < radius ? pow(1 - r / radius, 3) : 0; /* the method's own weight */
    const double u = q->vx[j] - q->vx[i], v = q->vy[j] - q->vy[i];
    if (i == j || w == 0)
        return;
    ++s->neighbours;
    s->w += w;
    s->x += w * x;
    s->y += w * y;
    s->xx += w * x * x;
    s->xy += w * x * y;
    s->yy += w * y * y;
    s->p += w * q->pressure[j];
    s->px += w * q->pressure[j] * x;
    s->py += w * q->pressure[j] * y;
    s->ux += w * u * x;
    s->uy += w * u * y;
    s->vx += w * v * x;
    s->vy += w * v * y;
    s->square += w * (u * u + v * v);
}

/* What the plane through the neighbours' pressures has at the particle itself: Cramer's rule. */
static double fitted_pressure(const sums *s) {
    const double a = s->xx * s->yy - s->xy * s->xy, b = s->xy * s->y - s->x * s->yy, c = s->x * s->xy - s->xx * s->y;
    return (s->p * a + s->px * b + s->py * c) / (s->w * a + s->x * b + s->y * c);
}

/* Sum of w |du - L dx|^2 over that of w, with L the gradient that fits best: twice the energy per mass that is unseen. */
static double unseen_square(const sums *s) {
    const double determinant = s->xx * s->yy - s->xy * s->xy;
    const double seen_u = s->ux * s->ux * s->yy - 2 * s->ux * s->uy * s->xy + s->uy * s->uy * s->xx;
    const double seen_v = s->vx * s->vx * s->yy - 2 * s->vx * s->vy * s->xy + s->vy * s->vy * s->xx;
    return fmax(0, s->square - (seen_u + seen_v) / determinant) / s->w;
}

enum { ENOUGH = 8 }; /* neighbours: the three coefficients of a plane, and some to depart from it */

static sums sums_about(const gp_particles *p, const cells *c, int64_t i, double radius) {
    const int64_t own = cell_of(c, p->x[i], p->y[i]);
    int64_t k, column, row;
    sums s = {0};
    for (row = own / c->columns - 1; row <= own / c->columns + 1; ++row)
        for (column = own % c->columns - 1; column <= own % c->columns + 1; ++column)
            if (row >= 0 && row < c->rows && column >= 0 && column < c->columns)
                for (k = c->begin[row * c->columns + column]; k < c->begin[row * c->columns + column + 1]; ++k)
                    add(&s, p, i, c->order[k], radius);
    return s;
}

static void free_cells(cells *c) {
    free(c->begin);
    free(c->order);
}

roughness roughness_of(gp_sim *sim, double radius) {
    gp_particles p = {.struct_size = sizeof p};
    roughness result = {0, 0};
    double pressure2 = 0, unseen = 0, kinetic = 0;
    int64_t counted = 0, i;
    cells c;
    CHECK(gp_get_particles(sim, GP_FIELD_POSITION | GP_FIELD_VELOCITY | GP_FIELD_PRESSURE, &p));
    c = sort_particles(&p, radius);
    for (i = 0; i < p.count; ++i) {
        sums s;
        if (p.pressure[i] <= 0)
            continue;
        s = sums_about(&p, &c, i, radius);
        if (s.neighbours < ENOUGH)
            continue;
        ++counted;
        pressure2 += pow(p.pressure[i] - fitted_pressure(&s), 2);
        /* Pairs share the difference: half of its square is the energy of each. */
        unseen += unseen_square(&s) / 2;
        kinetic += p.vx[i] * p.vx[i] + p.vy[i] * p.vy[i];
    }
    free_cells(&c);
    if (counted > 0)
        result.pressure = sqrt(pressure2 / (double)counted);
    if (kinetic > 0)
        result.unseen = unseen / kinetic;
    return result;
}

double highest_mean_pressure(gp_sim *sim, double radius) {
    gp_particles p = {.struct_size = sizeof p};
    double highest = 0;
    int64_t i;
    cells c;
    CHECK(gp_get_particles(sim, GP_FIELD_POSITION | GP_FIELD_VELOCITY | GP_FIELD_PRESSURE, &p));
    c = sort_particles(&p, radius);
    for (i = 0; i < p.count; ++i) {
        const sums s = sums_about(&p, &c, i, radius);
        if (s.neighbours >= ENOUGH)
            highest = fmax(highest, (p.pressure[i] + s.p) / (1 + s.w));
    }
    free_cells(&c);
    return highest;
}
