/* Exact solutions: runs one of them and prints its error and what it cost, as lines of "name value unit".
 *
 *     exact CASE [--resolution N] [--horizon K] [--cfl C] [--sound-speed M] [--end SECONDS] [--angle DEGREES]
 *
 * Resolution: particles over the thickness of the layer (hydrostatic: height of the column). --sound-speed is in largest
 * flow speeds. Every steady flow starts from its exact solution, so the error is what the scheme makes of it. */
#include <granperi/gp.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static void check(gp_status status, const char *call) {
    if (status >= 0)
        return;
    fprintf(stderr, "exact: %s: %s\n", call, gp_last_error());
    exit(status == GP_E_ARGUMENT ? 2 : 1);
}
#define CHECK(call) check((call), #call)

typedef struct options {
    int resolution;
    double horizon, cfl, mach, end, angle; /* 0: the case's own */
    double penalty, diffusion, viscosity;  /* negative: the scheme's own */
    int profile;
} options;

enum { BOX_CELLS = 12 }; /* width of the periodic box in spacings */

static const double pi = 3.14159265358979323846;
static const double grain_density = 2500, fraction = 0.62, density = 1550, gravity = 9.81;

typedef struct law {
    double mu_s, mu_2, i0, d;
} law;

static law beads(double d) {
    law l;
    l.mu_s = tan(21 * pi / 180);
    l.mu_2 = tan(32 * pi / 180);
    l.i0 = 0.3;
    l.d = d;
    return l;
}

static double friction(const law *l, double inertial) {
    return l->mu_s + (l->mu_2 - l->mu_s) * inertial / (l->i0 + inertial);
}

static double inverse_friction(const law *l, double mu) {
    return mu <= l->mu_s ? 0 : l->i0 * (mu - l->mu_s) / (l->mu_2 - mu);
}

static double cpu_seconds(void) {
    return (double)clock() / CLOCKS_PER_SEC;
}

/* ------------------------------------------------------------------------------------ layers, periodic in x */

typedef double (*profile)(double y, const void *data);

typedef struct layer {
    gp_sim *sim;
    int64_t count;
    double spacing, thickness, c0;
    int32_t bottom, top;
} layer;

typedef struct scene {
    law material;
    double rho_s, phi, thickness, gx, gy;
    double fastest; /* m/s, for the sound speed */
    profile u;      /* velocity to begin with; NULL: rest */
    const void *data;
    double load, lid_speed, floor_speed; /* a rough lid if load > 0 */
} scene;

static void set_numbers(gp_config *config, const options *o) {
    if (o->penalty >= 0)
        config->zero_energy_penalty = o->penalty;
    if (o->diffusion >= 0)
        config->density_diffusion = o->diffusion;
    if (o->viscosity >= 0)
        config->bulk_viscosity = o->viscosity;
}

static int32_t add_plate(gp_sim *sim, double x0, double x1, double y, double vx, double load) {
    gp_plate plate;
    int32_t id;
    CHECK(gp_plate_init(&plate, sizeof plate));
    plate.x0 = x0;
    plate.x1 = x1;
    plate.y0 = plate.y1 = y;
    plate.vx = vx;
    plate.normal_pressure = load;
    CHECK(gp_add_plate(sim, &plate, &id));
    return id;
}

/* A layer from y = 0 to its thickness on a rough floor. Each row of particles is a column of its own, so that it can begin
 * with the velocity of its height: its column id is its row. */
static layer make_layer(const options *o, const scene *s) {
    layer a;
    gp_config config;
    gp_material material;
    gp_column column;
    int32_t id;
    int k;
    const double spacing = s->thickness / o->resolution, width = BOX_CELLS * spacing;
    CHECK(gp_config_init(&config, sizeof config, GP_PRESET_DEFAULT));
    config.spacing = spacing;
    config.gravity_x = s->gx;
    config.gravity_y = s->gy;
    config.periodic_x_max = width;
    config.sound_speed = a.c0 = (o->mach > 0 ? o->mach : 10) * s->fastest;
    config.threads = 1;
    if (o->horizon > 0)
        config.horizon = o->horizon;
    config.cfl = o->cfl;
    set_numbers(&config, o);
    CHECK(gp_create(&config, &a.sim));
    CHECK(gp_material_init(&material, sizeof material));
    material.grain_density = s->rho_s;
    material.volume_fraction = s->phi;
    material.grain_diameter = s->material.d;
    material.mu_s = s->material.mu_s;
    material.mu_2 = s->material.mu_2;
    material.i0 = s->material.i0;
    CHECK(gp_add_material(a.sim, &material, &id));
    CHECK(gp_column_init(&column, sizeof column));
    column.width = width;
    column.height = spacing;
    column.material = id;
    for (k = 0; k < o->resolution; ++k) {
        column.y_min = k * spacing;
        column.vx = s->u ? s->u((k + 0.5) * spacing, s->data) : 0;
        CHECK(gp_add_column(a.sim, &column, NULL));
    }
    a.spacing = spacing;
    a.thickness = s->thickness;
    a.count = (int64_t)BOX_CELLS * o->resolution;
    a.bottom = add_plate(a.sim, width, 0, 0, s->floor_speed, 0);
    a.top = s->load > 0 ? add_plate(a.sim, 0, width, s->thickness, s->lid_speed, s->load) : -1;
    return a;
}

static double *field(const layer *a, uint32_t bit) {
    double *values = malloc(sizeof *values * (size_t)a->count);
    if (!values)
        exit(1);
    CHECK(gp_copy_field(a->sim, bit, values, a->count));
    return values;
}

static gp_state state_of(gp_sim *sim) {
    gp_state s = {0};
    s.struct_size = sizeof s;
    CHECK(gp_get_state(sim, &s));
    return s;
}

static double mean_plate_force(layer *a, double *fy, double from, double to) {
    /* Mean over a time: the impulse divided by it. */
    gp_load before = {0}, after = {0};
    before.struct_size = after.struct_size = sizeof before;
    CHECK(gp_run(a->sim, from));
    CHECK(gp_get_plate_load(a->sim, a->bottom, &before));
    CHECK(gp_run(a->sim, to));
    CHECK(gp_get_plate_load(a->sim, a->bottom, &after));
    *fy = (after.impulse_y - before.impulse_y) / (to - from);
    return (after.impulse_x - before.impulse_x) / (to - from);
}

/* ------------------------------------------------------------------------------------------------ summary */

static void print_cost(gp_sim *sim) {
    const gp_state s = state_of(sim);
    printf("time                %.6g s\n", s.time);
    printf("particles           %lld\n", (long long)s.n_particles);
    printf("steps               %lld\n", (long long)s.step);
    printf("cpu_seconds         %.3f s\n", cpu_seconds());
}

/* Compares the mean velocity of each row of particles with the exact one at its mean height. */
static void print_profile(const layer *a, const options *o, profile exact, const void *data, double scale) {
    double *y = field(a, GP_FIELD_Y), *u = field(a, GP_FIELD_VX);
    double square = 0, norm = 0, largest = 0, top = 0;
    int k;
    for (k = 0; k < o->resolution; ++k) {
        double mean_u = 0, mean_exact = 0, mean_y = 0;
        int n;
        for (n = 0; n < BOX_CELLS; ++n) {
            mean_u += u[k * BOX_CELLS + n] / BOX_CELLS;
            mean_y += y[k * BOX_CELLS + n] / BOX_CELLS;
            mean_exact += exact(y[k * BOX_CELLS + n], data) / BOX_CELLS;
        }
        square += (mean_u - mean_exact) * (mean_u - mean_exact);
        norm += mean_exact * mean_exact;
        largest = fmax(largest, fabs(mean_u - mean_exact));
        top = mean_u / mean_exact - 1;
        if (o->profile)
            printf("row                 %.6g %.6g %.6g\n", mean_y, mean_u, mean_exact);
    }
    printf("error_surface       %.6g\n", top);
    printf("error_l2            %.6g\n", sqrt(square / norm));
    printf("error_max           %.6g of the largest velocity\n", largest / scale);
    free(y);
    free(u);
}

/* ------------------------------------------------------------------------------------------------- cases */

/* Column at rest between smooth walls: p = rho g (H - y). */
static void hydrostatic(const options *o) {
    const double height = 0.05;
    const double ends[3][4] = {{0.05, 0, 0, 0}, {0, 0, 0, 0.1}, {0.05, 0.1, 0.05, 0}};
    gp_config config;
    gp_column column;
    gp_plate plate;
    layer a;
    double *y, *p, square = 0, base = 0;
    double n_base = 0;
    int64_t i;
    int k;
    CHECK(gp_config_init(&config, sizeof config, GP_PRESET_DEFAULT));
    a.spacing = config.spacing = height / o->resolution;
    config.sound_speed = o->mach > 0 ? o->mach : 10;
    config.cfl = o->cfl;
    config.threads = 1;
    if (o->horizon > 0)
        config.horizon = o->horizon;
    CHECK(gp_create(&config, &a.sim));
    CHECK(gp_column_init(&column, sizeof column));
    column.width = column.height = height;
    CHECK(gp_add_column(a.sim, &column, NULL));
    for (k = 0; k < 3; ++k) {
        CHECK(gp_plate_init(&plate, sizeof plate));
        plate.x0 = ends[k][0];
        plate.y0 = ends[k][1];
        plate.x1 = ends[k][2];
        plate.y1 = ends[k][3];
        plate.friction = GP_WALL_FREE_SLIP;
        CHECK(gp_add_plate(a.sim, &plate, NULL));
    }
    CHECK(gp_run(a.sim, o->end > 0 ? o->end : 0.5));
    a.count = state_of(a.sim).n_particles;
    y = field(&a, GP_FIELD_Y);
    p = field(&a, GP_FIELD_PRESSURE);
    for (i = 0; i < a.count; ++i) {
        square += pow(p[i] - density * gravity * (height - y[i]), 2);
        if (y[i] < a.spacing) {
            base += p[i] + density * gravity * y[i];
            n_base += 1;
        }
    }
    printf("pressure_base       %.6g Pa, exact %.6g\n", base / n_base, density * gravity * height);
    printf("error_base          %.6g\n", base / n_base / (density * gravity * height) - 1);
    printf("error               %.6g rms over the base pressure\n",
           sqrt(square / (double)a.count) / (density * gravity * height));
    printf("at_rest             %d\n", (int)state_of(a.sim).at_rest);
    print_cost(a.sim);
    gp_destroy(a.sim);
    free(y);
    free(p);
}

typedef struct shear {
    double rate, middle;
} shear;

static double linear(double y, const void *data) {
    const shear *s = data;
    return s->rate * (y - s->middle);
}

/* Simple shear between two rough plates, one under a load P: tau = mu(I) P. */
static void shear_box(const options *o) {
    const double load = 500, thickness = 0.04, rate = 50;
    const law l = beads(0.002);
    const shear data = {rate, thickness / 2};
    const double inertial = rate * l.d / sqrt(load / grain_density), mu = friction(&l, inertial);
    const scene s = {l,
                     grain_density,
                     fraction,
                     thickness,
                     0,
                     0,
                     2 * sqrt(load / density) + rate * thickness / 2,
                     linear,
                     &data,
                     load,
                     rate * thickness / 2,
                     -rate * thickness / 2};
    layer a = make_layer(o, &s);
    double fx, fy, tau_over_p = 0, *sxy, *p, *g;
    double bulk = 0;
    int64_t i, from = a.count / 4, to = 3 * a.count / 4;
    fx = mean_plate_force(&a, &fy, 0.2, o->end > 0 ? o->end : 0.6);
    sxy = field(&a, GP_FIELD_SXY);
    p = field(&a, GP_FIELD_PRESSURE);
    g = field(&a, GP_FIELD_SHEAR_RATE);
    for (i = from; i < to; ++i) {
        tau_over_p += sxy[i] / p[i] / (double)(to - from);
        bulk += friction(&l, 2 * l.d * g[i] / sqrt(p[i] / grain_density)) / (double)(to - from);
    }
    printf("inertial_number     %.6g\n", inertial);
    printf("mu                  %.6g exact, %.6g on the floor, %.6g inside at the local I %.6g\n", mu, fx / fabs(fy),
           tau_over_p, bulk);
    printf("error               %.6g of mu on the floor\n", fx / fabs(fy) / mu - 1);
    printf("error_inside        %.6g\n", tau_over_p / bulk - 1);
    printf("error_load          %.6g\n", fabs(fy) / (load * BOX_CELLS * a.spacing) - 1);
    print_profile(&a, o, linear, &data, rate * thickness / 2);
    print_cost(a.sim);
    gp_destroy(a.sim);
    free(sxy);
    free(p);
    free(g);
}

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
    b.factor = 2.0 / 3 * inverse_friction(l, tan(angle)) / l->d * sqrt(fraction * gravity * cos(angle));
    return b;
}

static double surface_velocity(const layer *a) {
    double *u = field(a, GP_FIELD_VX), mean = 0;
    int64_t i;
    for (i = a->count - BOX_CELLS; i < a->count; ++i)
        mean += u[i] / BOX_CELLS;
    free(u);
    return mean;
}

/* Steady flow down an incline; with start_up from rest, where u_s = g cos (tan - mu_s) t early. */
static void bagnold(const options *o, int start_up) {
    const law l = beads(0.002);
    const double h = 0.04, angle = (o->angle > 0 ? o->angle : 26) * pi / 180;
    const incline b = bagnold_data(&l, h, angle);
    const double fastest = bagnold_velocity(h, &b);
    const double end = o->end > 0 ? o->end : (start_up ? 0.15 : 2);
    const scene s = {l,
                     grain_density,
                     fraction,
                     h,
                     gravity * sin(angle),
                     -gravity * cos(angle),
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
        const double exact = gravity * cos(angle) * (tan(angle) - l.mu_s);
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
        for (i = a.count - rows * BOX_CELLS; i < a.count; ++i) {
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
    return c->l.i0 / (c->slope * c->l.d) * sqrt(c->load / grain_density) *
           (range * log((c->l.mu_2 - s) / (c->l.mu_2 - wall)) - (wall - s));
}

/* Gravity along a channel between two rough walls under the pressure P. */
static void chute_flow(const options *o) {
    const law l = beads(0.001);
    const chute c = {l, 600, 0.02, density * gravity / 600};
    const double fastest = chute_velocity(c.half, &c);
    const scene s = {
        l,  grain_density, fraction, 2 * c.half, gravity, 0, fmax(fastest, sqrt(2 * c.load / density)), chute_velocity,
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

/* Plane Couette flow with gravity under a loaded lid: tau is uniform, p = P + rho g (H - y). */
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
static void couette_cell(const options *o) {
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
        printf("shear_stress        %.6g Pa, exact %.6g\n", fx / (BOX_CELLS * a.spacing), c.tau);
        printf("error_stress        %.6g of the shear stress\n", fx / (BOX_CELLS * a.spacing) / c.tau - 1);
    }
    print_profile(&a, o, couette_velocity, &c, c.lid);
    print_cost(a.sim);
    gp_destroy(a.sim);
}

/* Reproducible numbers in [-1, 1). */
static double scattered(uint64_t *state) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) / 4503599627370496.0 - 1;
}

/* The velocity gradient of a smooth field on a lattice jittered by 0.2 spacings, away from its edges. */
static void gradient(const options *o) {
    const int n = o->resolution;
    const double spacing = 1.0 / n, k = 2 * pi;
    const size_t count = (size_t)n * (size_t)n;
    double *x = malloc(4 * count * sizeof *x), *y = x + count, *u = y + count, *v = u + count, *g;
    double square = 0, norm = 0;
    uint64_t random = 1;
    gp_config config;
    layer a;
    size_t i;
    if (!x)
        exit(1);
    for (i = 0; i < count; ++i) {
        x[i] = ((double)(i % (size_t)n) + 0.5 + 0.2 * scattered(&random)) * spacing;
        y[i] = ((double)(i / (size_t)n) + 0.5 + 0.2 * scattered(&random)) * spacing;
        u[i] = sin(k * x[i]) * cos(k * y[i]);
        v[i] = -cos(k * x[i]) * sin(k * y[i]);
    }
    CHECK(gp_config_init(&config, sizeof config, GP_PRESET_DEFAULT));
    config.spacing = spacing;
    config.gravity_y = 0;
    config.sound_speed = 10;
    config.collision_distance = 0;
    config.time_step = 1e-12;
    config.threads = 1;
    if (o->horizon > 0)
        config.horizon = o->horizon;
    CHECK(gp_create(&config, &a.sim));
    CHECK(gp_add_particles(a.sim, 0, (int64_t)count, x, y, u, v, NULL));
    CHECK(gp_step(a.sim, 1));
    a.count = (int64_t)count;
    g = field(&a, GP_FIELD_SHEAR_RATE);
    for (i = 0; i < count; ++i) {
        const double edge = fmin(fmin(x[i], 1 - x[i]), fmin(y[i], 1 - y[i]));
        /* D = diag(1, -1) k cos cos: its |gamma| = sqrt(D:D / 2). */
        const double exact = k * fabs(cos(k * x[i]) * cos(k * y[i]));
        if (edge < config.horizon * spacing)
            continue;
        square += (g[i] - exact) * (g[i] - exact);
        norm += exact * exact;
    }
    printf("error               %.6g in the norm L2\n", sqrt(square / norm));
    print_cost(a.sim);
    gp_destroy(a.sim);
    free(x);
    free(g);
}

/* A layer on an incline below the angle of friction stays, above it flows. */
static void slope(const options *o) {
    const double h = 0.04, angle = (o->angle > 0 ? o->angle : 20) * pi / 180, end = o->end > 0 ? o->end : 2;
    const law l = beads(0.002);
    const scene s = {l,
                     grain_density,
                     fraction,
                     h,
                     gravity * sin(angle),
                     -gravity * cos(angle),
                     sqrt(2 * gravity * h),
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
        for (n = 0; n < BOX_CELLS; ++n)
            mean += u[a.count - 1 - n] / BOX_CELLS;
        moved += 0.5 * (mean + last) * end / pieces;
        if (2 * k == pieces)
            half_way = moved;
        last = mean;
        free(u);
    }
    printf("displacement        %.6g spacings of the surface\n", moved / a.spacing);
    printf("surface_velocity    %.6g m/s\n", last);
    printf("kinetic             %.6g of the initial energy\n",
           state_of(a.sim).kinetic / (density * gravity * h * h / 2 * BOX_CELLS * a.spacing));
    printf("at_rest             %d\n", (int)state_of(a.sim).at_rest);
    /* Gravity sets in at once and shears the layer a little: what counts is the second half of the time. */
    printf("error               %.6g spacings in the second half\n", fabs(moved - half_way) / a.spacing);
    print_cost(a.sim);
    gp_destroy(a.sim);
}

/* --------------------------------------------------------------------------------------------------- main */

static void usage(FILE *out) {
    fprintf(out,
            "usage: exact CASE [options]\n\n"
            "cases: hydrostatic, shear_box, bagnold, bagnold_startup, chute, couette_cell, slope,\n       gradient\n\n"
            "options [default]\n"
            "  --resolution N    particles over the height of the scene [20]\n"
            "  --horizon K       in spacings [the scheme's own]\n"
            "  --cfl C           time step over spacing / wave speed [the scheme's own]\n"
            "  --sound-speed M   over the largest flow speed; hydrostatic: m/s [10]\n"
            "  --end SECONDS     end of the run [depends on the case]\n"
            "  --angle DEGREES   of the incline [bagnold 26, slope 20]\n"
            "  --penalty, --diffusion, --viscosity X\n"
            "                    of the scheme [its own]\n"
            "  --profile 1       prints rows of y, velocity, exact velocity [0]\n");
}

int main(int argc, char **argv) {
    options o = {20, 0, 0, 0, 0, 0, -1, -1, -1, 0};
    double resolution = 20, profile_rows = 0;
    const struct {
        const char *name;
        double *value;
    } known[] = {{"--resolution", &resolution},
                 {"--horizon", &o.horizon},
                 {"--cfl", &o.cfl},
                 {"--sound-speed", &o.mach},
                 {"--end", &o.end},
                 {"--angle", &o.angle},
                 {"--penalty", &o.penalty},
                 {"--diffusion", &o.diffusion},
                 {"--viscosity", &o.viscosity},
                 {"--profile", &profile_rows}};
    int k;
    size_t n;
    if (argc == 2 && strcmp(argv[1], "--help") == 0) {
        usage(stdout);
        return 0;
    }
    for (k = 2; k < argc; k += 2) {
        char *rest = NULL;
        for (n = 0; n < sizeof known / sizeof known[0]; ++n)
            if (k + 1 < argc && strcmp(argv[k], known[n].name) == 0)
                *known[n].value = strtod(argv[k + 1], &rest);
        if (!rest || rest == argv[k + 1] || *rest) {
            fprintf(stderr, "exact: %s: unknown option, or no number after it (see --help)\n", argv[k]);
            return 2;
        }
    }
    if (!(resolution >= 4 && resolution <= 2000)) {
        fprintf(stderr, "exact: --resolution %g: expected a whole number from 4 to 2000\n", resolution);
        return 2;
    }
    o.resolution = (int)resolution;
    o.profile = profile_rows != 0;
    if (argc < 2) {
        usage(stderr);
        return 2;
    }
    if (strcmp(argv[1], "hydrostatic") == 0)
        hydrostatic(&o);
    else if (strcmp(argv[1], "shear_box") == 0)
        shear_box(&o);
    else if (strcmp(argv[1], "bagnold") == 0)
        bagnold(&o, 0);
    else if (strcmp(argv[1], "bagnold_startup") == 0)
        bagnold(&o, 1);
    else if (strcmp(argv[1], "chute") == 0)
        chute_flow(&o);
    else if (strcmp(argv[1], "couette_cell") == 0)
        couette_cell(&o);
    else if (strcmp(argv[1], "slope") == 0)
        slope(&o);
    else if (strcmp(argv[1], "gradient") == 0)
        gradient(&o);
    else {
        fprintf(stderr, "exact: %s: unknown case (see --help)\n", argv[1]);
        return 2;
    }
    return 0;
}
