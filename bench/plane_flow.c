#include "plane_flow.h"

#include <math.h>

static const double degree = 3.14159265358979323846 / 180;
static const double time_step = 5e-5; /* s; half of it changes no digit that is shown */
/* 1/s, below which what should stand creeps. A start just above yield feels it: 21.5 degrees, 4 cm, surface at .5 s .0561,
 * .0418, .0404, .0402 m/s with 1e-1 to 1e-4, and no less with more passes and 1e-6. */
static const double smallest_rate = 1e-4;
enum { PASSES = 4 }; /* for the viscosity of the new rate */

plane_flow plane_flow_at(double thickness, double speed, double along, double down) {
    plane_flow f = {0};
    int k;
    f.mu_s = tan(21 * degree);
    f.mu_2 = tan(32 * degree);
    f.i0 = 0.3;
    f.diameter = 0.002;
    f.grain_density = 2500;
    f.density = 0.62 * f.grain_density;
    f.width = thickness / PLANE_CELLS;
    f.along = along;
    f.down = down;
    for (k = 0; k < PLANE_CELLS; ++k)
        f.u[k] = speed;
    f.rate[0] = speed / (f.width / 2);
    return f;
}

/* Stress over rate at the lower face of cell k, over the distance of the velocities there. */
static double stiffness(const plane_flow *f, int k) {
    const double p = f->density * f->down * f->width * (PLANE_CELLS - k), gamma = fabs(f->rate[k]);
    const double inertial = gamma * f->diameter / sqrt(p / f->grain_density);
    const double mu = f->mu_s + (f->mu_2 - f->mu_s) * inertial / (f->i0 + inertial);
    return mu * p / hypot(gamma, smallest_rate) / (k == 0 ? f->width / 2 : f->width);
}

/* Thomas: -a s_k u_(k-1) + (1 + a (s_k + s_(k+1))) u_k - a s_(k+1) u_(k+1) = u_k before + dt along. */
static void solve(const plane_flow *f, double *u) {
    const double a = time_step / (f->density * f->width);
    double upper[PLANE_CELLS], s = stiffness(f, 0), before = 0;
    int k;
    for (k = 0; k < PLANE_CELLS; ++k) {
        const double above = k + 1 < PLANE_CELLS ? stiffness(f, k + 1) : 0, below = k > 0 ? a * s : 0;
        const double diagonal = 1 + a * (s + above) - below * (k > 0 ? upper[k - 1] : 0);
        u[k] = (f->u[k] + time_step * f->along + below * before) / diagonal;
        upper[k] = a * above / diagonal;
        before = u[k];
        s = above;
    }
    for (k = PLANE_CELLS - 1; k-- > 0;)
        u[k] += upper[k] * u[k + 1];
}

void plane_flow_run(plane_flow *f, double end) {
    double u[PLANE_CELLS];
    int k, pass;
    for (; f->time < end - 0.5 * time_step; f->time += time_step) {
        for (pass = 0; pass < PASSES; ++pass) {
            solve(f, u);
            f->rate[0] = u[0] / (f->width / 2);
            for (k = 1; k < PLANE_CELLS; ++k)
                f->rate[k] = (u[k] - u[k - 1]) / f->width;
        }
        for (k = 0; k < PLANE_CELLS; ++k)
            f->u[k] = u[k];
    }
}

double plane_flow_surface(const plane_flow *f) {
    return f->u[PLANE_CELLS - 1];
}

double plane_flow_mean(const plane_flow *f) {
    double sum = 0;
    int k;
    for (k = 0; k < PLANE_CELLS; ++k)
        sum += f->u[k] / PLANE_CELLS;
    return sum;
}
