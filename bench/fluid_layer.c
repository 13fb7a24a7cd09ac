#include "fluid_layer.h"

#include <math.h>

static const double pi = 3.14159265358979323846;
enum { NEWTON_STEPS = 500, BISECTIONS = 60 };

/* Rates at the stress f->stress: Newton from above, each step by Thomas. */
static void solve(fluid_layer *f) {
    const double width = f->thickness / FLUID_CELLS, span = f->mu_2 - f->mu_s;
    const double k = pow(f->amplitude * f->diameter / width, 2);
    double g[FLUID_CELLS], growth[FLUID_CELLS], drag[FLUID_CELLS], mu[FLUID_CELLS];
    int i, step;
    for (i = 0; i < FLUID_CELLS; ++i) {
        const double p = f->load + f->weight * (i + 0.5) * width;
        mu[i] = f->stress / p;
        growth[i] = span * (mu[i] - f->mu_s) / (f->mu_2 - mu[i]);
        drag[i] = span / f->i0 * f->diameter * sqrt(f->grain_density / p) * mu[i];
        g[i] = 1e3;
    }
    for (step = 0; step < NEWTON_STEPS; ++step) {
        double diagonal[FLUID_CELLS], right[FLUID_CELLS], change = 0, largest = 0;
        for (i = 0; i < FLUID_CELLS; ++i) {
            const int above = i > 0, below = i + 1 < FLUID_CELLS;
            const double sum = (above ? g[i - 1] - g[i] : 0) + (below ? g[i + 1] - g[i] : 0);
            right[i] = -(k * sum + growth[i] * g[i] - drag[i] * g[i] * g[i]);
            diagonal[i] = -k * (above + below) + growth[i] - 2 * drag[i] * g[i];
            if (above) {
                const double m = k / diagonal[i - 1];
                diagonal[i] -= m * k;
                right[i] -= m * right[i - 1];
            }
        }
        for (i = FLUID_CELLS; i-- > 0;) {
            right[i] = (right[i] - (i + 1 < FLUID_CELLS ? k * right[i + 1] : 0)) / diagonal[i];
            g[i] = fmax(0, g[i] + right[i]);
            change = fmax(change, fabs(right[i]));
            largest = fmax(largest, g[i]);
        }
        if (change < 1e-10 * largest + 1e-14)
            break;
    }
    for (i = 0; i < FLUID_CELLS; ++i)
        f->rate[i] = g[i] * mu[i];
}

void fluid_layer_drag(fluid_layer *f, double speed) {
    double low = 0.5 * f->mu_s * f->load, high = (1 - 1e-5) * f->mu_2 * f->load;
    int k;
    for (k = 0; k < BISECTIONS; ++k) {
        f->stress = 0.5 * (low + high);
        solve(f);
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
