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
    double spacing, thickness;
    int32_t bottom, top;
    int64_t *rows; /* row of each particle, by id */
    int n_rows;
} layer;

static int32_t add_plate(gp_sim *sim, double x0, double x1, double y, int32_t slip, double vx, double load) {
    gp_plate plate;
    int32_t id;
    CHECK(gp_plate_init(&plate, sizeof plate));
    plate.x0 = x0;
    plate.x1 = x1;
    plate.y0 = plate.y1 = y;
    plate.friction = slip;
    plate.vx = vx;
    plate.normal_pressure = load;
    CHECK(gp_add_plate(sim, &plate, &id));
    return id;
}

/* A layer between y = 0 and thickness on a rough floor, with velocities u(y); a rough lid with a load if load > 0. */
static layer make_layer(const options *o, const law *l, double rho_s, double phi, double thickness, double gx, double gy,
                        double sound_speed, profile u, const void *data, double load, double lid_speed, double floor_speed) {
    layer a;
    gp_config config;
    gp_material material;
    gp_column column;
    int64_t k, per_row = BOX_CELLS;
    double *x, *y, *vx, *vy, width;
    int32_t id;
    a.spacing = thickness / o->resolution;
    a.thickness = thickness;
    width = BOX_CELLS * a.spacing;
    CHECK(gp_config_init(&config, sizeof config, GP_PRESET_DEFAULT));
    config.spacing = a.spacing;
    config.gravity_x = gx;
    config.gravity_y = gy;
    config.periodic_x_min = 0;
    config.periodic_x_max = width;
    config.sound_speed = sound_speed;
    config.threads = 1;
    if (o->horizon > 0)
        config.horizon = o->horizon;
    config.cfl = o->cfl;
    CHECK(gp_create(&config, &a.sim));
    CHECK(gp_material_init(&material, sizeof material));
    material.grain_density = rho_s;
    material.volume_fraction = phi;
    material.grain_diameter = l->d;
    material.mu_s = l->mu_s;
    material.mu_2 = l->mu_2;
    material.i0 = l->i0;
    CHECK(gp_add_material(a.sim, &material, &id));
    a.count = per_row * o->resolution;
    a.n_rows = o->resolution;
    /* Rows as columns of their own: each begins with the velocity of its height, and with the layer's pressure. */
    (void)x, (void)y, (void)vx, (void)vy;
    a.rows = malloc(sizeof *a.rows * (size_t)a.count);
    CHECK(gp_column_init(&column, sizeof column));
    for (k = 0; k < a.n_rows; ++k) {
        column.x_min = 0;
        column.width = width;
        column.y_min = (double)k * a.spacing;
        column.height = a.spacing;
        column.material = id;
        column.vx = u ? u((k + 0.5) * a.spacing, data) : 0;
        CHECK(gp_add_column(a.sim, &column, NULL));
    }
    a.bottom = add_plate(a.sim, width, 0, 0, GP_WALL_NO_SLIP, floor_speed, 0);
    a.top = load > 0 ? add_plate(a.sim, 0, width, thickness, GP_WALL_NO_SLIP, lid_speed, load) : -1;
    return a;
}
