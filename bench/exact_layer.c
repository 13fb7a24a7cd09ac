#include "exact_layer.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

void check(gp_status status, const char *call) {
    if (status >= 0)
        return;
    fprintf(stderr, "exact: %s: %s\n", call, gp_last_error());
    exit(status == GP_E_ARGUMENT ? 2 : 1);
}

law beads(double d) {
    law l;
    l.mu_s = tan(21 * PI / 180);
    l.mu_2 = tan(32 * PI / 180);
    l.i0 = 0.3;
    l.d = d;
    return l;
}

double friction(const law *l, double inertial) {
    return l->mu_s + (l->mu_2 - l->mu_s) * inertial / (l->i0 + inertial);
}

double inverse_friction(const law *l, double mu) {
    return mu <= l->mu_s ? 0 : l->i0 * (mu - l->mu_s) / (l->mu_2 - mu);
}

static double cpu_seconds(void) {
    return (double)clock() / CLOCKS_PER_SEC;
}

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
layer make_layer(const options *o, const scene *s) {
    layer a;
    gp_config config;
    gp_material material;
    gp_column column;
    int32_t id;
    int k;
    const double spacing = s->thickness / o->resolution, width = o->columns * spacing;
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
    a.columns = o->columns;
    a.count = (int64_t)o->columns * o->resolution;
    a.bottom = add_plate(a.sim, width, 0, 0, s->floor_speed, 0);
    a.top = s->load > 0 ? add_plate(a.sim, 0, width, s->thickness, s->lid_speed, s->load) : -1;
    return a;
}

double *field(const layer *a, uint32_t bit) {
    double *values = malloc(sizeof *values * (size_t)a->count);
    if (!values)
        exit(1);
    CHECK(gp_copy_field(a->sim, bit, values, a->count));
    return values;
}

gp_state state_of(gp_sim *sim) {
    gp_state s = {0};
    s.struct_size = sizeof s;
    CHECK(gp_get_state(sim, &s));
    return s;
}

double mean_plate_force(layer *a, double *fy, double from, double to) {
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

void print_cost(gp_sim *sim) {
    const gp_state s = state_of(sim);
    printf("time                %.6g s\n", s.time);
    printf("particles           %lld\n", (long long)s.n_particles);
    printf("steps               %lld\n", (long long)s.step);
    printf("cpu_seconds         %.3f s\n", cpu_seconds());
}

/* Compares the mean velocity of each row of particles with the exact one at its mean height. */
void print_profile(const layer *a, const options *o, profile exact, const void *data, double scale) {
    double *y = field(a, GP_FIELD_Y), *u = field(a, GP_FIELD_VX);
    double square = 0, norm = 0, largest = 0, top = 0;
    int k;
    for (k = 0; k < o->resolution; ++k) {
        double mean_u = 0, mean_exact = 0, mean_y = 0;
        int n;
        for (n = 0; n < a->columns; ++n) {
            mean_u += u[k * a->columns + n] / a->columns;
            mean_y += y[k * a->columns + n] / a->columns;
            mean_exact += exact(y[k * a->columns + n], data) / a->columns;
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
