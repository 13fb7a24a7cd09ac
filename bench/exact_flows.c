/* Steady flows, one start-up, and the slope on which the flow ends. */
#include "exact_cases.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct incline {
    double h, factor;
} incline;

/* u = 2/3 I / d sqrt(phi g cos) (h^1.5 - (h - y)^1.5) */
static double bagnold_velocity(double y, const void *data) {
    const incline *b = data;
    const double below = b->h - y;
    return b->factor * (pow(b->h, 1.5) - (below > 0 ? pow(below, 1.5) : 0));
}

static incline bagnold_data(const law *l, double h, double angle) {
    incline b;
    b.h = h;
    b.factor = 2.0 / 3 * inverse_friction(l, tan(angle)) / l->d * sqrt(FRACTION * GRAVITY * cos(angle));
    return b;
}

static double surface_velocity(const layer *a) {
    double *u = field(a, GP_FIELD_VX), mean = 0;
    int64_t i;
    for (i = a->count - a->columns; i < a->count; ++i)
        mean += u[i] / a->columns;
    free(u);
    return mean;
}

/* Steady flow down an incline; with start_up from rest, where u_s = g cos (tan - mu_s) t early. */
void bagnold(const options *o, int start_up) {
    const law l = beads(0.002);
    const double h = 0.04, angle = (o->angle > 0 ? o->angle : 26) * PI / 180;
    const incline b = bagnold_data(&l, h, angle);
    const double fastest = bagnold_velocity(h, &b);
    const double end = o->end > 0 ? o->end : (start_up ? 0.15 : 2);
    const scene s = {l,
                     GRAIN_DENSITY,
                     FRACTION,
                     h,
                     GRAVITY * sin(angle),
                     -GRAVITY * cos(angle),
                     fastest,
                     start_up ? NULL : bagnold_velocity,
                     &b,
                     0,
                     0,
                     0};
    layer a = make_layer(o, &s);
    if (start_up) {
        /* The elastic material takes up its shear first, which leaves an offset of the order of (g/c0) h: what the law
         * sets is the acceleration after that. */
        const double exact = GRAVITY * cos(angle) * (tan(angle) - l.mu_s);
        double early, late;
        CHECK(gp_run(a.sim, end / 3));
        early = surface_velocity(&a);
        CHECK(gp_run(a.sim, end));
        late = surface_velocity(&a);
        printf("acceleration        %.6g m/s2, exact %.6g\n", (late - early) / (2 * end / 3), exact);
        printf("error               %.6g of the acceleration\n", (late - early) / (2 * end / 3) / exact - 1);
        printf("error_velocity      %.6g of the velocity at the end\n", late / (exact * end) - 1);
    } else {
        CHECK(gp_run(a.sim, end));
        printf("surface_velocity    %.6g m/s exact\n", fastest);
        /* The uppermost twentieth of the layer, at least a row. */
        double *u = field(&a, GP_FIELD_VX), *y = field(&a, GP_FIELD_Y), mean = 0, at = 0;
        const int64_t rows = o->resolution >= 20 ? o->resolution / 20 : 1;
        int64_t i;
        for (i = a.count - rows * a.columns; i < a.count; ++i) {
            mean += u[i];
            at += bagnold_velocity(y[i], &b);
        }
        printf("error               %.6g of the surface velocity\n", mean / at - 1);
        print_profile(&a, o, bagnold_velocity, &b, fastest);
        free(u);
        free(y);
    }
    print_cost(a.sim);
    gp_destroy(a.sim);
}

typedef struct chute {
    law l;
    double load, half, slope; /* slope = rho g / P */
} chute;

static double chute_velocity(double y, const void *data) {
    const chute *c = data;
    const double range = c->l.mu_2 - c->l.mu_s, wall = c->slope * c->half;
    const double s = fmax(c->slope * fabs(y - c->half), c->l.mu_s);
    if (wall <= c->l.mu_s)
        return 0;
    return c->l.i0 / (c->slope * c->l.d) * sqrt(c->load / GRAIN_DENSITY) *
           (range * log((c->l.mu_2 - s) / (c->l.mu_2 - wall)) - (wall - s));
}

/* Gravity along a channel between two rough walls under the pressure P. */
void chute_flow(const options *o) {
    const law l = beads(0.001);
    const chute c = {l, 600, 0.02, DENSITY * GRAVITY / 600};
    const double fastest = chute_velocity(c.half, &c);
    const scene s = {
        l,  GRAIN_DENSITY, FRACTION, 2 * c.half, GRAVITY, 0, fmax(fastest, sqrt(2 * c.load / DENSITY)), chute_velocity,
        &c, c.load,        0,        0};
    layer a = make_layer(o, &s);
    double *u, *y, *g, plug = 0, speed = 0, n = 0;
    int64_t i;
    CHECK(gp_run(a.sim, o->end > 0 ? o->end : 1));
    u = field(&a, GP_FIELD_VX);
    y = field(&a, GP_FIELD_Y);
    g = field(&a, GP_FIELD_SHEAR_RATE);
    for (i = 0; i < a.count; ++i)
        if (fabs(y[i] - c.half) < 0.25 * c.half) {
            speed += u[i];
            n += 1;
        }
    speed /= n;
    /* The plug ends where the velocity has fallen by 1 % of the plug's. */
    for (i = 0; i < a.count; ++i)
        if (u[i] > 0.99 * speed)
            plug = fmax(plug, fabs(y[i] - c.half) + 0.5 * a.spacing);
    {
        double lo = 0, hi = c.half;
        int k;
        for (k = 0; k < 60; ++k) {
            const double mid = 0.5 * (lo + hi);
            if (chute_velocity(c.half + mid, &c) > 0.99 * fastest)
                lo = mid;
            else
                hi = mid;
        }
        printf("plug_half_width     %.6g m where u = 0.99 u_plug, exact %.6g\n", plug, lo);
        printf("error_plug_width    %.6g spacings\n", (plug - lo) / a.spacing);
    }
    printf("plug_velocity       %.6g m/s, exact %.6g\n", speed, fastest);
    printf("error               %.6g of the speed of the plug\n", speed / fastest - 1);
    print_profile(&a, o, chute_velocity, &c, fastest);
    print_cost(a.sim);
    gp_destroy(a.sim);
    free(u);
    free(y);
    free(g);
}

/* Plane Couette flow with GRAVITY under a loaded lid: tau is uniform, p = P + rho g (H - y). */
typedef struct couette {
    law l;
    double rho, rho_s, g, load, height, lid, tau;
} couette;

static double couette_rate(double y, const couette *c) {
    const double p = c->load + c->rho * c->g * (c->height - y);
    return inverse_friction(&c->l, c->tau / p) * sqrt(p / c->rho_s) / c->l.d;
}

static double couette_velocity(double y, const void *data) {
    const couette *c = data;
    const int n = 2000;
    double sum = 0;
    int k;
    if (y <= 0)
        return 0;
    for (k = 0; k < n; ++k)
        sum += couette_rate((k + 0.5) * y / n, c) * y / n;
    return sum;
}

/* The shear cell of Cawthorn (2011). */
void couette_cell(const options *o) {
    couette c = {{0.32, 0.6, 0.4, 0.075 / 30}, 1000, 1000, 7.5, 1600, 0.075, 2.5, 0};
    double low = c.l.mu_s * c.load, high = c.l.mu_2 * c.load;
    scene s = {c.l, c.rho_s, 1, c.height, 0, -c.g, 0, couette_velocity, NULL, c.load, c.lid, 0};
    layer a;
    int k;
    for (k = 0; k < 60; ++k) {
        c.tau = 0.5 * (low + high);
        if (couette_velocity(c.height, &c) < c.lid)
            low = c.tau;
        else
            high = c.tau;
    }
    s.data = &c;
    s.fastest = fmax(c.lid, sqrt(2 * (c.load / c.rho + c.g * c.height)));
    a = make_layer(o, &s);
    {
        double fx, fy;
        const double end = o->end > 0 ? o->end : 2;
        fx = mean_plate_force(&a, &fy, 0.5 * end, end);
        printf("shear_stress        %.6g Pa, exact %.6g\n", fx / (a.columns * a.spacing), c.tau);
        printf("error_stress        %.6g of the shear stress\n", fx / (a.columns * a.spacing) / c.tau - 1);
    }
    print_profile(&a, o, couette_velocity, &c, c.lid);
    print_cost(a.sim);
    gp_destroy(a.sim);
}

/* A layer on an incline below the angle of friction stays, above it flows. */
void slope(const options *o) {
    const double h = 0.04, angle = (o->angle > 0 ? o->angle : 20) * PI / 180, end = o->end > 0 ? o->end : 2;
    const law l = beads(0.002);
    const scene s = {l,
                     GRAIN_DENSITY,
                     FRACTION,
                     h,
                     GRAVITY * sin(angle),
                     -GRAVITY * cos(angle),
                     sqrt(2 * GRAVITY * h),
                     NULL,
                     NULL,
                     0,
                     0,
                     0};
    layer a = make_layer(o, &s);
    double *u, moved = 0, half_way = 0, last = 0;
    int k, n;
    const int pieces = 200;
    /* Displacement of the surface: positions wrap, velocities do not. */
    for (k = 1; k <= pieces; ++k) {
        double mean = 0;
        CHECK(gp_run(a.sim, end * k / pieces));
        u = field(&a, GP_FIELD_VX);
        for (n = 0; n < a.columns; ++n)
            mean += u[a.count - 1 - n] / a.columns;
        moved += 0.5 * (mean + last) * end / pieces;
        if (2 * k == pieces)
            half_way = moved;
        last = mean;
        free(u);
    }
    printf("displacement        %.6g spacings of the surface\n", moved / a.spacing);
    printf("surface_velocity    %.6g m/s\n", last);
    printf("kinetic             %.6g of the initial energy\n",
           state_of(a.sim).kinetic / (DENSITY * GRAVITY * h * h / 2 * a.columns * a.spacing));
    printf("at_rest             %d\n", (int)state_of(a.sim).at_rest);
    /* Gravity sets in at once and shears the layer a little: what counts is the second half of the time. */
    printf("error               %.6g spacings in the second half\n", fabs(moved - half_way) / a.spacing);
    print_cost(a.sim);
    gp_destroy(a.sim);
}
