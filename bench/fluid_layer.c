#include "fluid_layer.h"

#include <math.h>

static const double pi = 3.14159265358979323846;
enum { NEWTON_STEPS = 500, BISECTIONS = 60 };

/* Of the cells in a row: conductances towards the one before and after, growth by the stress ratio, drag (s). The outermost lead to a
 * fluidity of 0; where they are 0 there is no flux. */
typedef struct cells {
    double before[FLUID_CELLS], after[FLUID_CELLS], growth[FLUID_CELLS], drag[FLUID_CELLS];
} cells;

static void fill_cell(cells *s, int i, const fluid_layer *law, double mu, double pressure) {
    const double span = law->mu_2 - law->mu_s;
    s->growth[i] = span * (mu - law->mu_s) / (law->mu_2 - mu);
    s->drag[i] = span / law->i0 * law->diameter * sqrt(law->grain_density / pressure) * mu;
}

/* Steady fluidity g, 1/s: Newton from above, each step by Thomas. */
static void solve(const cells *s, double *g) {
    const int last = FLUID_CELLS - 1;
    int i, step;
    for (i = 0; i <= last; ++i)
        g[i] = 1e3;
    for (step = 0; step < NEWTON_STEPS; ++step) {
        double diagonal[FLUID_CELLS], right[FLUID_CELLS], change = 0, largest = 0;
        for (i = 0; i <= last; ++i) {
            const double there = i > 0 ? g[i - 1] : 0, beyond = i < last ? g[i + 1] : 0;
            right[i] = -(s->before[i] * (there - g[i]) + s->after[i] * (beyond - g[i]) + s->growth[i] * g[i] -
                         s->drag[i] * g[i] * g[i]);
            diagonal[i] = -s->before[i] - s->after[i] + s->growth[i] - 2 * s->drag[i] * g[i];
            if (i > 0) {
                const double m = s->before[i] / diagonal[i - 1];
                diagonal[i] -= m * s->after[i - 1];
                right[i] -= m * right[i - 1];
            }
        }
        for (i = FLUID_CELLS; i-- > 0;) {
            right[i] = (right[i] - (i < last ? s->after[i] * right[i + 1] : 0)) / diagonal[i];
            g[i] = fmax(0, g[i] + right[i]);
            change = fmax(change, fabs(right[i]));
            largest = fmax(largest, g[i]);
        }
        if (change < 1e-10 * largest + 1e-14)
            break;
    }
}

/* Rates at the stress f->stress. */
static void shear_layer(fluid_layer *f) {
    const double width = f->thickness / FLUID_CELLS, k = pow(f->amplitude * f->diameter / width, 2);
    double mu[FLUID_CELLS];
    cells s;
    int i;
    for (i = 0; i < FLUID_CELLS; ++i) {
        const double p = f->load + f->weight * (i + 0.5) * width;
        mu[i] = f->stress / p;
        s.before[i] = i > 0 ? k : f->zero_top ? 2 * k : 0; /* half a cell away */
        s.after[i] = i + 1 < FLUID_CELLS ? k : 0;
        fill_cell(&s, i, f, mu[i], p);
    }
    solve(&s, f->rate);
    for (i = 0; i < FLUID_CELLS; ++i)
        f->rate[i] *= mu[i];
}

void fluid_layer_drag(fluid_layer *f, double speed) {
    double low = 0.5 * f->mu_s * f->load, high = (1 - 1e-5) * f->mu_2 * f->load;
    int k;
    for (k = 0; k < BISECTIONS; ++k) {
        f->stress = 0.5 * (low + high);
        shear_layer(f);
        if (fluid_layer_velocity(f, 0) < speed)
            low = f->stress;
        else
            high = f->stress;
    }
}

double fluid_layer_velocity(const fluid_layer *f, double depth) {
    const double width = f->thickness / FLUID_CELLS;
    double sum = 0;
    int i;
    for (i = 0; i < FLUID_CELLS; ++i)
        sum += f->rate[i] * fmin(fmax((i + 1) * width - depth, 0), width);
    return sum;
}

double fluid_layer_stopping_height(const fluid_layer *f, double slope) {
    return pi / 2 * f->amplitude * f->diameter * sqrt((f->mu_2 - slope) / ((f->mu_2 - f->mu_s) * (slope - f->mu_s)));
}

static void turn_annulus(fluid_annulus *f) {
    const double width = (f->outer - f->inner) / FLUID_CELLS, k = pow(f->law->amplitude * f->law->diameter / width, 2);
    double mu[FLUID_CELLS];
    cells s;
    int i;
    for (i = 0; i < FLUID_CELLS; ++i) {
        const double r = f->inner + (i + 0.5) * width;
        mu[i] = f->moment / (2 * pi * r * r * f->pressure);
        s.before[i] = i > 0 ? k * (r - 0.5 * width) / r : 0;
        s.after[i] = i + 1 < FLUID_CELLS ? k * (r + 0.5 * width) / r : 0;
        fill_cell(&s, i, f->law, mu[i], f->pressure);
    }
    solve(&s, f->turning);
    for (i = 0; i < FLUID_CELLS; ++i)
        f->turning[i] *= mu[i] / (f->inner + (i + 0.5) * width);
}

double fluid_annulus_velocity(const fluid_annulus *f, double radius) {
    const double width = (f->outer - f->inner) / FLUID_CELLS;
    double sum = 0; /* d(u/r)/dr = -rate / r */
    int i;
    for (i = 0; i < FLUID_CELLS; ++i)
        sum += f->turning[i] * fmin(fmax(f->inner + (i + 1) * width - radius, 0), width);
    return sum * radius;
}

void fluid_annulus_turn(fluid_annulus *f, double omega) {
    const double unit = 2 * pi * f->inner * f->inner * f->pressure;
    double low = 0.5 * f->law->mu_s * unit, high = (1 - 1e-5) * f->law->mu_2 * unit;
    int k;
    for (k = 0; k < BISECTIONS; ++k) {
        f->moment = 0.5 * (low + high);
        turn_annulus(f);
        if (fluid_annulus_velocity(f, f->inner) < omega * f->inner)
            low = f->moment;
        else
            high = f->moment;
    }
}
