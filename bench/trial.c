#include "trial.h"

#include <math.h>
#include <string.h>

#include "../examples/c/example.h" /* CHECK, floor, gates */

enum { LAYER_WIDTH = 20 }; /* spacings: twice the largest horizon and some more */

/* What the scheme changes in the configuration of its preset. */
typedef struct scheme {
    const char *name;
    int32_t preset, stress;
} scheme;

enum { SCHEMES = 4 };
static const scheme schemes[SCHEMES] = {
    {"default", GP_PRESET_DEFAULT, GP_STRESS_ELASTIC},
    {"paper", GP_PRESET_PAPER, GP_STRESS_REGULARIZED},
    {"local", GP_PRESET_PAPER_LOCAL, GP_STRESS_REGULARIZED},
    {"implicit", GP_PRESET_DEFAULT, GP_STRESS_IMPLICIT},
};

enum { MODES = 3 };
static const char *const mode_names[MODES] = {"none", "checkerboard", "stripes"};

trial trial_defaults(trial_scene scene) {
    trial t = {.scene = scene, .scheme = "default", .resolution = 32, .threads = 1, .mode = "none"};
    t.sound_factor = 1;
    t.cfl = t.courant = t.horizon = t.interaction_radius = t.delta = t.collision_distance = NAN;
    t.zero_energy_penalty = t.density_diffusion = t.bulk_viscosity = t.friction_factor = NAN;
    t.retry_halvings = t.implicit_tolerance = NAN;
    t.mu_s_degrees = 21;
    t.mu_2_degrees = 32;
    t.diameter = 0.002;
    t.mode_speed = 1e-4;
    t.length = 0.08;
    t.aspect = 1.25;
    t.sides = 2;
    return t;
}

void trial_options(trial *t, bench_option *options) {
    const bench_option all[TRIAL_OPTIONS] = {
        {"--scheme", "default, paper, local or implicit [default]", BENCH_TEXT, &t->scheme, 0, 0},
        {"--resolution", "spacings in the length [32]", BENCH_WHOLE, &t->resolution, 1, 1e5},
        {"--length", "m, width of the column [0.08]", BENCH_NUMBER, &t->length, 1e-6, 1e6},
        {"--aspect", "height over L0, which is the length over --sides [1.25]", BENCH_NUMBER, &t->aspect, 0.01, 1000},
        {"--sides", "1: it stands beside a smooth wall; 2: it collapses to both sides [2]", BENCH_WHOLE, &t->sides, 1,
         2},
        {"--lift-time", "s in which a gate clears its column; 0: no gates [0]", BENCH_NUMBER, &t->lift_time, 0, 1e6},
        {"--sound-factor", "times the automatic sound speed [1]", BENCH_NUMBER, &t->sound_factor, 1e-3, 1e3},
        {"--cfl", "beyond the stable limit too; 0: the scheme's own [0]", BENCH_NUMBER, &t->cfl, 0, 8},
        {"--horizon", "spacings [the scheme's]", BENCH_NUMBER, &t->horizon, 1.8, 8},
        {"--interaction-radius", "spacings [the scheme's]", BENCH_NUMBER, &t->interaction_radius, 1.5, 8},
        {"--delta", "1/s [the scheme's]", BENCH_NUMBER, &t->delta, 1e-300, 1e300},
        {"--collision-distance", "spacings [the scheme's]", BENCH_NUMBER, &t->collision_distance, 0, 1},
        {"--penalty", "[the scheme's]", BENCH_NUMBER, &t->zero_energy_penalty, 0, 0.5},
        {"--diffusion", "[the scheme's]", BENCH_NUMBER, &t->density_diffusion, 0, 1},
        {"--bulk-viscosity", "[the scheme's]", BENCH_NUMBER, &t->bulk_viscosity, 0, 1},
        {"--friction-factor", "[the scheme's]", BENCH_NUMBER, &t->friction_factor, 0, 10},
        {"--retry-halvings", "[0]", BENCH_WHOLE, &t->retry_halvings, 0, 20},
        {"--implicit-tolerance", "[the scheme's]", BENCH_NUMBER, &t->implicit_tolerance, 1e-12, 1e-2},
        {"--jitter", "spacings, of the positions at the start [0]", BENCH_NUMBER, &t->jitter, 0, 0.49},
        {"--seed", "of the jitter [0]", BENCH_WHOLE, &t->seed, 0, 1e9},
        {"--threads", "0: the OpenMP default [1]", BENCH_WHOLE, &t->threads, 0, 1024},
        {"--mu-s-degrees", "friction angle at rest [21]", BENCH_NUMBER, &t->mu_s_degrees, 0, 89},
        {"--mu-2-degrees", "friction angle of fast flow [32]", BENCH_NUMBER, &t->mu_2_degrees, 0, 89},
        {"--diameter", "m, of the grains [0.002]", BENCH_NUMBER, &t->diameter, 1e-9, 1e6},
        {"--mode", "of the layer's initial velocity: none, checkerboard or stripes [none]", BENCH_TEXT, &t->mode, 0, 0},
        {"--mode-speed", "its amplitude over c0 [1e-4]", BENCH_NUMBER, &t->mode_speed, 0, 1},
    };
    memcpy(options, all, sizeof all);
}

double trial_spacing(const trial *t) {
    return t->length / t->resolution;
}

double trial_reference(const trial *t) {
    return t->length / t->sides;
}

double trial_height(const trial *t) {
    return t->aspect * trial_reference(t);
}

static void set(double *field, double value) {
    if (!isnan(value))
        *field = value;
}

static gp_config config_of(const trial *t) {
    const char *names[SCHEMES];
    const scheme *chosen;
    gp_config config;
    int k;
    for (k = 0; k < SCHEMES; ++k)
        names[k] = schemes[k].name;
    chosen = &schemes[bench_choice("--scheme", t->scheme, SCHEMES, names)];
    CHECK(gp_config_init(&config, sizeof config, chosen->preset));
    config.stress = chosen->stress;
    config.spacing = trial_spacing(t);
    config.threads = (int32_t)t->threads;
    config.jitter = t->jitter;
    config.seed = (uint64_t)t->seed;
    set(&config.cfl, t->cfl);
    config.allow_unstable_step = !isnan(t->cfl);
    set(&config.horizon, t->horizon);
    set(&config.interaction_radius, t->interaction_radius);
    set(&config.delta, t->delta);
    set(&config.collision_distance, t->collision_distance);
    set(&config.zero_energy_penalty, t->zero_energy_penalty);
    set(&config.density_diffusion, t->density_diffusion);
    set(&config.bulk_viscosity, t->bulk_viscosity);
    set(&config.friction_factor, t->friction_factor);
    set(&config.implicit_tolerance, t->implicit_tolerance);
    if (!isnan(t->retry_halvings))
        config.retry_halvings = (int32_t)t->retry_halvings;
    if (t->scene == TRIAL_LAYER) {
        config.periodic_x_min = 0;
        config.periodic_x_max = LAYER_WIDTH * config.spacing;
    }
    return config;
}

static void add_column(gp_sim *sim, double x_min, double y_min, double width, double height, double vx) {
    gp_column column;
    CHECK(gp_column_init(&column, sizeof column));
    column.x_min = x_min;
    column.y_min = y_min;
    column.width = width;
    column.height = height;
    column.vx = vx;
    column.material = 1;
    CHECK(gp_add_column(sim, &column, NULL));
}

/* Velocities of alternating sign on the lattice, which the gradient does not see: a column for each particle. */
static void add_mode(gp_sim *sim, const trial *t, double speed) {
    const int checkerboard = bench_choice("--mode", t->mode, MODES, mode_names) == 1;
    const double dl = trial_spacing(t);
    const int rows = (int)round(trial_height(t) / dl);
    int i, j;
    for (j = 0; j < rows; ++j)
        for (i = 0; i < LAYER_WIDTH; ++i)
            add_column(sim, i * dl, j * dl, dl, dl, (j + checkerboard * i) % 2 ? -speed : speed);
}

static void add_scene(gp_sim *sim, const trial *t, double sound_speed) {
    const double dl = trial_spacing(t), height = dl * round(trial_height(t) / dl);
    if (t->scene == TRIAL_LAYER) {
        example_add_floor(sim, 0, LAYER_WIDTH * dl);
        if (bench_choice("--mode", t->mode, MODES, mode_names) != 0)
            add_mode(sim, t, t->mode_speed * sound_speed);
        else
            add_column(sim, 0, 0, LAYER_WIDTH * dl, height, 0);
    } else if (t->sides == 1) {
        gp_plate wall;
        add_column(sim, 0, 0, t->length, height, 0);
        CHECK(gp_plate_init(&wall, sizeof wall)); /* material on the right of the way up */
        wall.y1 = height + 6 * dl;
        wall.friction = GP_WALL_FREE_SLIP;
        CHECK(gp_add_plate(sim, &wall, NULL));
        example_add_floor(sim, 0, t->length + 4 * height + 20 * dl);
        example_add_gate(sim, t->length, EXAMPLE_MATERIAL_LEFT, height, dl, t->lift_time);
    } else {
        const double half = t->length / 2, reach = half + 4 * height + 20 * dl; /* run-outs reach some 2.5 heights */
        add_column(sim, -half, 0, 2 * half, height, 0);
        example_add_floor(sim, -reach, reach);
        example_add_gate(sim, -half, EXAMPLE_MATERIAL_RIGHT, height, dl, t->lift_time);
        example_add_gate(sim, half, EXAMPLE_MATERIAL_LEFT, height, dl, t->lift_time);
    }
}

static gp_material material_of(const trial *t) {
    const double degree = acos(-1.0) / 180;
    gp_material material;
    CHECK(gp_material_init(&material, sizeof material));
    if (t) {
        material.grain_diameter = t->diameter;
        material.mu_s = tan(t->mu_s_degrees * degree);
        material.mu_2 = tan(t->mu_2_degrees * degree);
    }
    return material;
}

double trial_density(void) {
    const gp_material material = material_of(NULL);
    return material.grain_density * material.volume_fraction;
}

static gp_sim *create(const trial *t, const gp_config *config, double sound_speed) {
    const gp_material material = material_of(t);
    gp_sim *sim;
    CHECK(gp_create(config, &sim));
    CHECK(gp_add_material(sim, &material, NULL));
    add_scene(sim, t, sound_speed);
    return sim;
}

static gp_state state_after(gp_sim *sim, int64_t steps) {
    gp_state state = {.struct_size = sizeof state};
    CHECK(gp_step(sim, steps));
    CHECK(gp_get_state(sim, &state));
    return state;
}

/* The automatic sound speed of the scene, times the factor. */
static double sound_speed_of(const trial *t) {
    trial bare = *t;
    gp_config config;
    gp_sim *sim;
    double speed;
    bare.mode = "none"; /* its speed would raise the automatic one */
    config = config_of(&bare);
    config.cfl = 0;
    sim = create(&bare, &config, 0);
    speed = state_after(sim, 0).sound_speed;
    gp_destroy(sim);
    return t->sound_factor * speed;
}

/* Nothing moves yet at the first step, so that the elastic waves alone set it. */
double trial_wave_speed(const trial *t) {
    const double cfl = 0.1;
    trial bare = *t;
    gp_config config;
    gp_sim *sim;
    double speed;
    bare.mode = "none";
    config = config_of(&bare);
    config.sound_speed = sound_speed_of(t);
    config.cfl = cfl;
    sim = create(&bare, &config, 0);
    speed = cfl * config.spacing / state_after(sim, 1).dt;
    gp_destroy(sim);
    return speed;
}

gp_sim *trial_create(const trial *t) {
    gp_config config = config_of(t);
    gp_sim *sim;
    config.sound_speed = sound_speed_of(t);
    if (!isnan(t->courant)) {
        config.time_step = t->courant * config.spacing / trial_wave_speed(t);
        config.allow_unstable_step = 1;
    }
    sim = create(t, &config, config.sound_speed);
    return sim;
}
