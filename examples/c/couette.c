/* Plane Couette flow under gravity: a rough upper plate, pressed onto the grains by a load, is dragged over them.
 *
 * Cases 1 and 2: the appendix of Jin, Lu, Tai & Xu (2021). Case 3: a shear cell of Cawthorn (2011), as calculated by the
 * public code of A. Choudhury in the Basilisk wiki. Beside the mean velocity it prints the exact profile of the mu(I) law. */
#include <math.h>
#include <stdio.h>
#include <time.h>

#include "example.h"

typedef struct cell {
    double speed, pressure, height, diameter; /* m/s, Pa, m, m */
    double density, volume_fraction, gravity; /* of the grains, kg/m3; -; m/s2 */
    double mu_s, mu_2, i0, sound_speed, end;  /* -, -, -, m/s, s */
    double horizon;                           /* spacings */
} cell;

static const double tan_21 = 0.383864, tan_32 = 0.624869;

/* In cases 1 and 2 the band that flows under the plate is thinner than a spacing. What is rigid below it has no mean
 * velocity gradient over the horizon, plate included: with a horizon of 4 its rows move against the plate, by up to 0.3 U, to
 * make up for it. The smallest horizon leaves least of that. */
static cell cell_of(int number) {
    cell c = {0.0003, 102.3, 0.010, 0.001, 2500, 0.62, 9.81, 0, 0, 0.3, 10, 1, 2.2};
    const cell cawthorn = {2.5, 1600, 0.075, 0.0025, 1000, 1, 7.5, 0.32, 0.6, 0.4, 25, 2, 4};
    c.mu_s = tan_21;
    c.mu_2 = tan_32;
    if (number == 2)
        c.speed = 0.0013;
    return number == 3 ? cawthorn : c;
}

/* Speed at the depth z below the plate for the shear stress tau, which is the same at every depth: p = P + rho g z,
 * I = I0 (tau / p - mu_s) / (mu_2 - tau / p), du/dz = -I sqrt(p / rho_s) / d down to where tau = mu_s p. Midpoint rule. */
static double speed_at(const cell *c, double tau, double z) {
    enum { STEPS = 4000 };
    const double weight = c->density * c->volume_fraction * c->gravity;
    const double yield = fmin(c->height, (tau / c->mu_s - c->pressure) / weight), step = (yield - z) / STEPS;
    double speed = 0;
    int k;
    for (k = 0; k < STEPS && step > 0; ++k) {
        const double p = c->pressure + weight * (z + (k + 0.5) * step);
        const double number = c->i0 * (tau / p - c->mu_s) / (c->mu_2 - tau / p);
        speed += step * number * sqrt(p / c->density) / c->diameter;
    }
    return speed;
}

/* The shear stress at which the speed at the plate is that of the plate. */
static double shear_stress(const cell *c) {
    double low = c->mu_s * c->pressure, high = 0.999999 * c->mu_2 * c->pressure;
    int k;
    for (k = 0; k < 100; ++k) {
        const double middle = (low + high) / 2;
        *(speed_at(c, middle, 0) < c->speed ? &low : &high) = middle;
    }
    return (low + high) / 2;
}

/* A scene that is periodic over `width`: its plates are as long as the period. */
static gp_sim *create(const cell *c, const example_options *options, double spacing, double width, int32_t *top) {
    gp_config config;
    gp_material material;
    gp_column column;
    gp_plate plate;
    gp_sim *sim;
    CHECK(gp_config_init(&config, sizeof config, GP_PRESET_DEFAULT));
    config.spacing = spacing;
    config.gravity_y = -c->gravity;
    config.sound_speed = c->sound_speed;
    config.horizon = c->horizon;
    config.periodic_x_min = 0;
    config.periodic_x_max = width;
    config.threads = (int32_t)options->threads;
    CHECK(gp_create(&config, &sim));
    CHECK(gp_set_log(sim, example_log, NULL));

    CHECK(gp_material_init(&material, sizeof material));
    material.grain_density = c->density;
    material.volume_fraction = c->volume_fraction;
    material.grain_diameter = c->diameter;
    material.mu_s = c->mu_s;
    material.mu_2 = c->mu_2;
    material.i0 = c->i0;
    CHECK(gp_add_material(sim, &material, NULL));

    CHECK(gp_column_init(&column, sizeof column));
    column.x_min = column.y_min = 0;
    column.width = width;
    column.height = c->height;
    column.material = 1;
    CHECK(gp_add_column(sim, &column, NULL));

    CHECK(gp_plate_init(&plate, sizeof plate)); /* the floor, from right to left: the material is above it */
    plate.x0 = width;
    CHECK(gp_add_plate(sim, &plate, NULL));
    CHECK(gp_plate_init(&plate, sizeof plate)); /* from left to right: the material is below it */
    plate.x1 = width;
    plate.y0 = plate.y1 = c->height;
    plate.vx = c->speed;
    plate.normal_pressure = c->pressure;
    plate.mass_per_length = c->pressure / c->gravity;
    CHECK(gp_add_plate(sim, &plate, top));
    return sim;
}

int main(int argc, char **argv) {
    enum { SAMPLES = 200, MOST_BINS = 1000 };
    double number = 1, sum[MOST_BINS] = {0}, count[MOST_BINS] = {0}, tau, width, spacing, bin_height, error = 0;
    example_options options = example_defaults(20, NAN, NULL);
    const example_extra case_option = {"--case",
                                       "N",
                                       "1: plate at 0.0003 m/s, 102.3 Pa; 2: at 0.0013 m/s\n"
                                       "                         3: at 2.5 m/s, 1600 Pa",
                                       &number,
                                       1,
                                       3,
                                       1};
    const clock_t begin = clock(); /* the CPU time of all threads */
    gp_particles particles;
    gp_load load;
    gp_state state;
    gp_sim *sim;
    int32_t top;
    int bins, k;
    cell c;

    options.lift_time = options.mu_s_degrees = options.mu_2_degrees = NAN; /* no gates, friction by the case */
    example_parse(argc, argv, "Grains are sheared under a loaded plate. Reference length: the height of the cell.",
                  &options, &case_option);
    c = cell_of((int)number);
    if (isnan(options.end))
        options.end = c.end;
    spacing = c.height / options.resolution;
    width = 20 * spacing;
    sim = create(&c, &options, spacing, width, &top);

    /* The mean of the second half of the run over pairs of rows, as in the paper, counted from the plate downwards. */
    bin_height = 2 * spacing;
    bins = (int)fmin(ceil(options.resolution / 2), MOST_BINS);
    particles.struct_size = sizeof particles;
    load.struct_size = sizeof load;
    for (k = 0; k < SAMPLES; ++k) {
        int64_t i;
        CHECK(gp_run(sim, options.end * (1 + (k + 1.0) / SAMPLES) / 2));
        CHECK(gp_get_plate_load(sim, top, &load));
        CHECK(gp_get_particles(sim, GP_FIELD_POSITION | GP_FIELD_VELOCITY, &particles));
        for (i = 0; i < particles.count; ++i) {
            const int bin = (int)floor((c.height + load.dy - particles.y[i]) / bin_height);
            if (bin >= 0 && bin < bins) {
                sum[bin] += particles.vx[i];
                count[bin] += 1;
            }
        }
    }

    tau = shear_stress(&c);
    printf("#    z/d      u/U    exact   z: below the plate\n");
    for (k = 0; k < bins; ++k)
        if (count[k] > 0) {
            const double z = (k + 0.5) * bin_height, mean = sum[k] / count[k] / c.speed,
                         exact = speed_at(&c, tau, z) / c.speed;
            printf("%8.3f %8.4f %8.4f\n", z / c.diameter, mean, exact);
            error = fmax(error, fabs(mean - exact));
        }
    state.struct_size = sizeof state;
    CHECK(gp_get_state(sim, &state));
    printf("time                %.6g s\n", state.time);
    printf("particles           %lld\n", (long long)state.n_particles);
    printf("steps               %lld\n", (long long)state.step);
    printf("shear_stress        %.6g Pa, exact %.6g Pa\n", fabs(load.fx) / width, tau);
    printf("plate_displacement  %.6g m\n", load.dy);
    printf("error               %.6g largest difference of u/U\n", error);
    printf("cpu_seconds         %.2f s\n", (double)(clock() - begin) / CLOCKS_PER_SEC);
    gp_destroy(sim);
    return 0;
}
