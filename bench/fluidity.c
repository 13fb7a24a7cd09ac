/* Granular fluidity: runs one case and prints what came out and what it cost, as lines of "name value unit". A profile is lines of
 * three numbers: depth in grains, velocity over the lid's, the same of the layer in one dimension (nan without fluidity). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "fluidity.h"
#include "marks.h"
#include "options.h"

static const char usage[] = "usage: fluidity CASE [options]\n\n"
                            "cases: couette, shear, annular, incline, collapse\n";

static const double degree = 3.14159265358979323846 / 180, gravity = 9.81;
enum { ACROSS = 12, MOST_ROWS = 1000 }; /* spacings in the period of layers */

gp_config fluid_config(const choices *c, double spacing) {
    static const char *const names[] = {"default", "paper"};
    static const int32_t presets[] = {GP_PRESET_DEFAULT, GP_PRESET_PAPER};
    gp_config config;
    CHECK(gp_config_init(&config, sizeof config, presets[bench_choice("--preset", c->preset, 2, names)]));
    config.spacing = spacing;
    config.threads = 1;
    if (!isnan(c->horizon))
        config.horizon = c->horizon;
    config.sound_speed = c->sound_speed;
    config.jitter = c->jitter;
    return config;
}

gp_material fluid_beads(const choices *c, double diameter) {
    gp_material m;
    CHECK(gp_material_init(&m, sizeof m));
    m.grain_diameter = diameter;
    m.nonlocal_amplitude = c->amplitude;
    return m;
}

fluid_layer fluid_law(const gp_material *m) {
    fluid_layer f = {0};
    f.mu_s = m->mu_s;
    f.mu_2 = m->mu_2;
    f.i0 = m->i0;
    f.diameter = m->grain_diameter;
    f.grain_density = m->grain_density;
    f.amplitude = m->nonlocal_amplitude;
    return f;
}

static void add_column(gp_sim *sim, const gp_material *m, double x, double width, double height) {
    gp_column column;
    CHECK(gp_add_material(sim, m, NULL));
    CHECK(gp_column_init(&column, sizeof column));
    column.material = 1;
    column.x_min = x;
    column.width = width;
    column.height = height;
    CHECK(gp_add_column(sim, &column, NULL));
}

static int32_t add_floor(gp_sim *sim, double left, double right, double vx, int32_t fluidity) {
    gp_plate plate;
    int32_t id;
    CHECK(gp_plate_init(&plate, sizeof plate));
    plate.x0 = right;
    plate.x1 = left;
    plate.vx = vx;
    plate.fluidity = fluidity;
    CHECK(gp_add_plate(sim, &plate, &id));
    return id;
}

/* Over a layer that is `width` long, at the height y. */
static int32_t add_lid(gp_sim *sim, double width, double y, double load, double vx, int32_t fluidity) {
    gp_plate plate;
    int32_t id;
    CHECK(gp_plate_init(&plate, sizeof plate));
    plate.x1 = width;
    plate.y0 = plate.y1 = y;
    plate.normal_pressure = load;
    plate.vx = vx;
    plate.fluidity = fluidity;
    CHECK(gp_add_plate(sim, &plate, &id));
    return id;
}

typedef struct profile {
    int rows;
    double depth[MOST_ROWS], u[MOST_ROWS], count[MOST_ROWS]; /* means of rows */
} profile;

static void add_to_profile(profile *f, gp_sim *sim, double top, double spacing) {
    const int64_t count = example_state(sim).n_particles;
    double *y = bench_field(sim, GP_FIELD_Y, count), *vx = bench_field(sim, GP_FIELD_VX, count);
    int64_t i;
    for (i = 0; i < count; ++i) {
        const int row = (int)fmin(fmax(floor((top - y[i]) / spacing), 0), f->rows - 1);
        f->depth[row] += top - y[i];
        f->u[row] += vx[i];
        f->count[row] += 1;
    }
    free(y);
    free(vx);
}

/* Linear between the rows. */
static double velocity_at(const profile *f, double depth) {
    int k;
    for (k = 1; k < f->rows; ++k)
        if (f->depth[k] >= depth)
            return f->u[k - 1] + (depth - f->depth[k - 1]) / (f->depth[k] - f->depth[k - 1]) * (f->u[k] - f->u[k - 1]);
    return f->u[f->rows - 1];
}

/* The cell of Jin et al. (2021) with gravity: means of the second half. */
static void couette(const choices *c) {
    static const double grains[] = {1, 2, 3, 5};
    static const char *const lids[] = {"free", "zero"};
    const int zero = bench_choice("--lid", c->lid, 2, lids);
    const double d = 0.001, h = 10 * d, load = 102.3, spacing = d / c->per_grain;
    const gp_material m = fluid_beads(c, d);
    const int samples = 50;
    gp_config config = fluid_config(c, spacing);
    fluid_layer exact = fluid_law(&m);
    static profile mean;
    gp_sim *sim;
    gp_load before, after;
    int32_t lid;
    double least = INFINITY, most = 0;
    int k;
    config.periodic_x_max = ACROSS * spacing;
    CHECK(gp_create(&config, &sim));
    add_column(sim, &m, 0, config.periodic_x_max, h);
    add_floor(sim, 0, config.periodic_x_max, 0, GP_FLUIDITY_FREE);
    lid = add_lid(sim, config.periodic_x_max, h, load, c->speed, zero ? GP_FLUIDITY_ZERO : GP_FLUIDITY_FREE);
    CHECK(gp_run(sim, 0.5 * c->end));
    before = example_load(sim, lid);
    mean.rows = (int)lround(h / spacing);
    for (k = 1; k <= samples; ++k) {
        double stress;
        CHECK(gp_run(sim, 0.5 * c->end * (1 + (double)k / samples)));
        after = example_load(sim, lid);
        stress = fabs(after.fx) / config.periodic_x_max;
        least = fmin(least, stress);
        most = fmax(most, stress);
        add_to_profile(&mean, sim, h + after.dy, spacing);
    }
    if (m.nonlocal_amplitude > 0) {
        exact.thickness = h;
        exact.zero_top = zero;
        exact.load = load;
        exact.weight = m.volume_fraction * m.grain_density * gravity;
        fluid_layer_drag(&exact, c->speed);
        printf("stress_exact %.4f Pa\n", exact.stress);
    }
    printf("stress %.4f Pa\n", fabs(after.impulse_x - before.impulse_x) / (0.5 * c->end * config.periodic_x_max));
    printf("stress_least %.4f Pa\n", least);
    printf("stress_most %.4f Pa\n", most);
    for (k = 0; k < mean.rows; ++k) {
        mean.depth[k] /= mean.count[k];
        mean.u[k] /= mean.count[k] * c->speed;
        printf("%.4f %.5f %.5f\n", mean.depth[k] / d, mean.u[k],
               m.nonlocal_amplitude > 0 ? fluid_layer_velocity(&exact, mean.depth[k]) / c->speed : NAN);
    }
    for (k = 0; k < 4; ++k) {
        printf("u_%g %.4f of the lid's\n", grains[k], velocity_at(&mean, grains[k] * d));
        if (m.nonlocal_amplitude > 0)
            printf("u_%g_exact %.4f of the lid's\n", grains[k], fluid_layer_velocity(&exact, grains[k] * d) / c->speed);
    }
    bench_print_cost(sim);
    gp_destroy(sim);
}

/* Without gravity: uniform shear at 50 1/s, friction of the floor beside mu(I). */
static void shear(const choices *c) {
    const double d = 0.002, h = 10 * d, load = 500, rate = 50, spacing = d / c->per_grain;
    const gp_material m = fluid_beads(c, d);
    const double inertial = rate * d / sqrt(load / m.grain_density);
    gp_config config = fluid_config(c, spacing);
    static profile mean;
    gp_sim *sim;
    gp_load before, after;
    int32_t floor, lid;
    double worst = 0;
    int k;
    config.periodic_x_max = ACROSS * spacing;
    config.gravity_y = 0;
    CHECK(gp_create(&config, &sim));
    add_column(sim, &m, 0, config.periodic_x_max, h);
    floor = add_floor(sim, 0, config.periodic_x_max, -rate * h / 2, GP_FLUIDITY_FREE);
    lid = add_lid(sim, config.periodic_x_max, h, load, rate * h / 2, GP_FLUIDITY_FREE);
    CHECK(gp_run(sim, 0.6 * c->end));
    before = example_load(sim, floor);
    CHECK(gp_run(sim, c->end));
    after = example_load(sim, floor);
    mean.rows = (int)lround(h / spacing);
    add_to_profile(&mean, sim, h + example_load(sim, lid).dy, spacing);
    for (k = 0; k < mean.rows; ++k)
        worst = fmax(worst, fabs(mean.u[k] / mean.count[k] / (rate * h) - 0.5 + mean.depth[k] / mean.count[k] / h));
    printf("friction %.5f 1\n", (after.impulse_x - before.impulse_x) / -(after.impulse_y - before.impulse_y));
    printf("friction_exact %.5f 1\n", m.mu_s + (m.mu_2 - m.mu_s) * inertial / (m.i0 + inertial));
    printf("from_linear %.4f of the lid's\n", worst);
    bench_print_cost(sim);
    gp_destroy(sim);
}

/* A layer whose fluidity is 0 at its base: flows, or comes to rest. */
static void incline(const choices *c) {
    const double d = 0.001, spacing = d / c->per_grain, height = c->rows * spacing, angle = c->angle * degree;
    const gp_material m = fluid_beads(c, d);
    const fluid_layer law = fluid_law(&m);
    const double stop = fluid_layer_stopping_height(&law, tan(angle));
    gp_config config = fluid_config(c, spacing);
    gp_sim *sim;
    double *g, largest = 0;
    int64_t count, i;
    config.periodic_x_max = ACROSS * spacing;
    config.gravity_x = gravity * sin(angle);
    config.gravity_y = -gravity * cos(angle);
    CHECK(gp_create(&config, &sim));
    add_column(sim, &m, 0, config.periodic_x_max, height);
    add_floor(sim, 0, config.periodic_x_max, 0, GP_FLUIDITY_ZERO);
    CHECK(gp_run(sim, c->end));
    count = example_state(sim).n_particles;
    g = bench_field(sim, GP_FIELD_FLUIDITY, count);
    for (i = 0; i < count; ++i)
        largest = fmax(largest, g[i]);
    free(g);
    printf("stopping_height %.4f grains\n", stop / d);
    printf("height %.4f of the stopping height\n", height / stop);
    printf("fluidity %.4g 1/s\n", largest);
    printf("speed %.4g m/s\n", example_state(sim).rms_speed);
    bench_print_cost(sim);
    gp_destroy(sim);
}

/* The column of a = 1.25, released at once: height and width over L, rest, and what they do after 2 s. */
static void collapse(const choices *c) {
    const double width = 0.08, height = 0.05, spacing = width / c->rows;
    const gp_material m = fluid_beads(c, 0.002);
    const double energy = m.volume_fraction * m.grain_density * gravity * width * height * height / 2;
    gp_config config = fluid_config(c, spacing);
    gp_sim *sim;
    const extent feet = {-width / 2, width / 2, width / 2, 2};
    double rest = NAN, peak_2 = NAN, bulk_2 = NAN;
    int k;
    CHECK(gp_create(&config, &sim));
    add_column(sim, &m, -width / 2, width, height);
    add_floor(sim, -0.4, 0.4, 0, GP_FLUIDITY_FREE);
    for (k = 1; k <= (int)lround(c->end / 0.02); ++k) {
        gp_state s;
        CHECK(gp_run(sim, 0.02 * k));
        s = example_state(sim);
        if (!s.at_rest)
            rest = NAN;
        else if (isnan(rest))
            rest = s.time;
        if (k == 21)
            printf("peak_042 %.4f of L\n", s.peak_height / width);
        if (k == 100) {
            peak_2 = s.peak_height;
            bulk_2 = run_out_of(sim, &feet, 0.9);
            printf("peak %.4f of L\n", peak_2 / width);
            printf("run_out_90 %.4f L0\n", bulk_2);
            printf("kinetic %.3g of the potential energy at the start\n", s.kinetic / energy);
        }
    }
    printf("rest %.3g s\n", rest);
    printf("peak_drift %.2e of that at 2 s\n", example_state(sim).peak_height / peak_2 - 1);
    printf("run_out_90_drift %.2e of that at 2 s\n", run_out_of(sim, &feet, 0.9) / bulk_2 - 1);
    bench_print_cost(sim);
    gp_destroy(sim);
}

int main(int argc, char **argv) {
    static const struct {
        const char *name;
        void (*run)(const choices *);
        double end, sound_speed; /* its own */
    } cases[] = {{"couette", couette, 1, 5},
                 {"shear", shear, 0.25, 21},
                 {"annular", fluid_annular, 0.5, 11.4},
                 {"incline", incline, 2, 3},
                 {"collapse", collapse, 2, 0}};
    const int n = (int)(sizeof cases / sizeof cases[0]);
    choices c = {2, NAN, 0.48, 0.003, NAN, 24, 40, NAN, 0, "default", "free"};
    const bench_option options[] = {
        {"--per-grain", "spacings in a grain, of layers [2]", BENCH_WHOLE, &c.per_grain, 1, 64},
        {"--horizon", "spacings [the preset's]", BENCH_NUMBER, &c.horizon, 1.8, 8},
        {"--amplitude", "of the fluidity; 0: local [0.48]", BENCH_NUMBER, &c.amplitude, 0, 10},
        {"--speed", "m/s, of the lid of the Couette cell [0.003]", BENCH_NUMBER, &c.speed, 1e-6, 10},
        {"--sound-speed", "m/s [5, 21, 11.4, 3, by the library]", BENCH_NUMBER, &c.sound_speed, 1e-3, 1e4},
        {"--angle", "degrees, of the incline [24]", BENCH_NUMBER, &c.angle, 21.1, 31.9},
        {"--rows", "spacings in the layer on the incline, and in the width of the column [40]", BENCH_WHOLE, &c.rows, 1,
         1000},
        {"--jitter", "spacings [0]", BENCH_NUMBER, &c.jitter, 0, 0.3},
        {"--end", "s, end of the run; of a collapse 2 or more [1, 0.25, 0.5, 2, 2]", BENCH_NUMBER, &c.end, 1e-2, 1e4},
        {"--preset", "default or paper, of cells and columns; paper without fluidity [default]", BENCH_TEXT, &c.preset,
         0, 0},
        {"--lid", "free: the lid of the Couette cell passes no flux; zero: its grains are glued to it [free]",
         BENCH_TEXT, &c.lid, 0, 0},
    };
    int k;
    example_program(argv[0]);
    bench_parse(argc, argv, 2, usage, (int)(sizeof options / sizeof options[0]), options);
    k = bench_case(argc, argv, cases, sizeof cases[0], n);
    c.end = isnan(c.end) ? cases[k].end : c.end;
    c.sound_speed = isnan(c.sound_speed) ? cases[k].sound_speed : c.sound_speed;
    cases[k].run(&c);
    return 0;
}
