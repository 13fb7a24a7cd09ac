/* What a feature costs in the smallest scene, a block that collapses on a floor, and what it costs while it is there but has
 * nothing to do. docs/performance.md is made with it. */
#define _POSIX_C_SOURCE 200112L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "../examples/c/example.h" /* CHECK */
#include "options.h"

static const char usage[] =
    "usage: features FEATURE [options]\n\n"
    "FEATURE: none, material, gate, gone_gate, walls, side_walls, periodic, loaded_plate, coulomb, penalty,\n"
    "diffusion, bulk_viscosity, collisions, retries, output, callback, log, default (the default scheme) or all\n"
    "The block without and with the feature, some steps of one and of the other in turn. Prints lines of\n"
    "\"name value unit\".\n";

enum { MINIMAL, IDLE, USED, STATES };
static const char *const state_names[STATES] = {"minimal", "idle", "used"};

/* clang-format off */
enum {
    NONE, MATERIAL, GATE, GONE_GATE, WALLS, SIDE_WALLS, PERIODIC, LOADED_PLATE, COULOMB, PENALTY, DIFFUSION,
    BULK_VISCOSITY, COLLISIONS, RETRIES, OUTPUT, CALLBACK, LOG, DEFAULT, ALL, FEATURES
};
static const char *const feature_names[FEATURES] = {
    "none", "material", "gate", "gone_gate", "walls", "side_walls", "periodic", "loaded_plate", "coulomb", "penalty",
    "diffusion", "bulk_viscosity", "collisions", "retries", "output", "callback", "log", "default", "all"};

/* clang-format on */

enum { ENTRIES_MAX = 128, REPEATS_MAX = 1000 };

typedef struct choices {
    double resolution, warm, steps, repeat;
    const char *state, *alone, *file;
    int feature;
} choices;

static const double width = 0.08, height = 0.05, period = 0.20; /* m; the block reaches its images while it collapses */

static double cpu_seconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* ------------------------------------------------------------------------------------------------- scene */

/* Whether the scene has a feature in this state. "all" has everything that one scene can have. */
static int is(const choices *c, int state, int feature, int as) {
    if (state == MINIMAL || state != as)
        return 0;
    if (c->feature == DEFAULT)
        return feature == PENALTY || feature == DIFFUSION || feature == BULK_VISCOSITY || feature == COLLISIONS;
    return c->feature == feature || (c->feature == ALL && feature != GATE && feature != GONE_GATE && feature != WALLS);
}

static gp_config config_of(const choices *c, int state) {
    gp_config config, own;
    CHECK(gp_config_init(&config, sizeof config, GP_PRESET_DEFAULT));
    own = config;
    config.spacing = width / c->resolution;
    config.sound_speed = 10 * sqrt(2 * 9.81 * height);
    config.threads = 1;
    config.zero_energy_penalty = is(c, state, PENALTY, USED) ? own.zero_energy_penalty : 0;
    config.density_diffusion = is(c, state, DIFFUSION, USED) ? own.density_diffusion : 0;
    config.bulk_viscosity = is(c, state, BULK_VISCOSITY, USED) ? own.bulk_viscosity : 0;
    config.collision_distance = is(c, state, COLLISIONS, USED) ? own.collision_distance : 0;
    if (is(c, state, SIDE_WALLS, IDLE) || is(c, state, SIDE_WALLS, USED))
        config.channel_width = 0.02;
    if (is(c, state, SIDE_WALLS, USED))
        config.channel_friction = 0.24;
    if (is(c, state, PERIODIC, USED)) {
        config.periodic_x_min = -period / 2;
        config.periodic_x_max = period / 2;
    }
    if (is(c, state, RETRIES, IDLE) || is(c, state, RETRIES, USED))
        config.retry_halvings = 4;
    return config;
}

static void add_column(gp_sim *sim, double x_min, double wide, int32_t material) {
    gp_column column;
    CHECK(gp_column_init(&column, sizeof column));
    column.x_min = x_min;
    column.width = wide;
    column.height = height;
    column.material = material;
    CHECK(gp_add_column(sim, &column, NULL));
}

typedef struct line {
    double x0, y0, x1, y1;
} line;

static gp_plate plate_at(line l, int32_t friction) {
    gp_plate plate;
    CHECK(gp_plate_init(&plate, sizeof plate));
    plate.x0 = l.x0;
    plate.y0 = l.y0;
    plate.x1 = l.x1;
    plate.y1 = l.y1;
    plate.friction = friction;
    if (friction == GP_WALL_COULOMB)
        plate.wall_mu = 0.3;
    return plate;
}

static void add_material_and_columns(gp_sim *sim, const choices *c, int state) {
    int32_t other = 0;
    if (is(c, state, MATERIAL, IDLE) || is(c, state, MATERIAL, USED)) {
        gp_material material;
        CHECK(gp_material_init(&material, sizeof material));
        material.grain_density *= 1.2;
        CHECK(gp_add_material(sim, &material, &other));
    }
    if (is(c, state, MATERIAL, USED)) {
        add_column(sim, -width / 2, width / 2, 0);
        add_column(sim, 0, width / 2, other);
    } else {
        add_column(sim, -width / 2, width, 0);
    }
}

static void add_plates(gp_sim *sim, const choices *c, int state) {
    const double reach = is(c, state, PERIODIC, USED) ? period / 2 : 0.5, far = 2;
    const line floor_line = {reach, 0, -reach, 0}, left = {-width / 2, 0, -width / 2, 2 * height},
               right = {width / 2, 2 * height, width / 2, 0}, away = {far, 2 * height, far, 0},
               lid = {-width / 2, height, width / 2, height}, far_floor = {far + 1, -1, far, -1};
    gp_plate plate = plate_at(floor_line, is(c, state, COULOMB, USED) ? GP_WALL_COULOMB : GP_WALL_NO_SLIP);
    CHECK(gp_add_plate(sim, &plate, NULL));
    if (is(c, state, COULOMB, IDLE)) {
        plate = plate_at(far_floor, GP_WALL_COULOMB);
        CHECK(gp_add_plate(sim, &plate, NULL));
    }
    if (is(c, state, GATE, IDLE) || is(c, state, WALLS, IDLE)) {
        plate = plate_at(away, GP_WALL_FREE_SLIP);
        CHECK(gp_add_plate(sim, &plate, NULL));
    }
    if (is(c, state, GATE, USED) || is(c, state, WALLS, USED)) {
        plate = plate_at(right, GP_WALL_FREE_SLIP);
        if (is(c, state, GATE, USED))
            plate.vy = 0.1; /* clears the column in half a second: it is there all the time */
        CHECK(gp_add_plate(sim, &plate, NULL));
    }
    if (is(c, state, WALLS, USED)) {
        plate = plate_at(left, GP_WALL_FREE_SLIP);
        CHECK(gp_add_plate(sim, &plate, NULL));
    }
    if (is(c, state, GONE_GATE, IDLE) || is(c, state, GONE_GATE, USED)) {
        plate = plate_at(right, GP_WALL_FREE_SLIP);
        plate.vx = 3; /* out of reach before the measurement begins */
        CHECK(gp_add_plate(sim, &plate, NULL));
    }
    if (is(c, state, LOADED_PLATE, USED)) {
        plate = plate_at(lid, GP_WALL_NO_SLIP);
        plate.normal_pressure = 50;
        CHECK(gp_add_plate(sim, &plate, NULL));
    }
}

static int32_t look(void *user, gp_sim *sim) {
    gp_particles particles;
    (void)user;
    particles.struct_size = sizeof particles;
    return gp_get_particles(sim, GP_FIELD_POSITION | GP_FIELD_VELOCITY, &particles) != GP_OK;
}

static void add_host(gp_sim *sim, const choices *c, int state) {
    if (is(c, state, CALLBACK, IDLE) || is(c, state, CALLBACK, USED))
        CHECK(gp_set_callback(sim, 1, look, NULL));
    if (is(c, state, CALLBACK, IDLE))
        CHECK(gp_set_callback(sim, 1, NULL, NULL));
    if (is(c, state, LOG, IDLE) || is(c, state, LOG, USED))
        CHECK(gp_set_log(sim, example_log, NULL));
    if ((is(c, state, OUTPUT, IDLE) || is(c, state, OUTPUT, USED)) && gp_has_feature("hdf5")) {
        gp_output output;
        CHECK(gp_output_init(&output, sizeof output));
        output.every_seconds = is(c, state, OUTPUT, USED) ? 0.01 : 0;
        CHECK(gp_output_open(sim, c->file, &output));
    }
}

static gp_sim *create(const choices *c, int state) {
    const gp_config config = config_of(c, state);
    gp_sim *sim;
    CHECK(gp_create(&config, &sim));
    add_material_and_columns(sim, c, state);
    add_plates(sim, c, state);
    add_host(sim, c, state);
    return sim;
}

/* ----------------------------------------------------------------------------------------------- measures */

static int64_t count_of(gp_sim *sim) {
    gp_state state;
    state.struct_size = sizeof state;
    CHECK(gp_get_state(sim, &state));
    return state.n_particles;
}

static int64_t plan_of(gp_sim *sim, gp_plan_entry *entries) {
    int64_t n;
    CHECK(gp_get_plan(sim, ENTRIES_MAX, entries, &n));
    return n < ENTRIES_MAX ? n : ENTRIES_MAX;
}

static double bytes_of(const gp_plan_entry *entries, int64_t n) {
    double sum = 0;
    int64_t k;
    for (k = 0; k < n; ++k)
        sum += (double)entries[k].bytes;
    return sum;
}

static double cpu_of(gp_sim *sim, int64_t steps) {
    const double begin = cpu_seconds();
    CHECK(gp_step(sim, steps));
    return cpu_seconds() - begin;
}

static int same_field(gp_sim *a, gp_sim *b, uint32_t field, int64_t n) {
    double *values = malloc(2 * (size_t)n * sizeof *values);
    int same;
    if (!values)
        exit(1);
    CHECK(gp_copy_field(a, field, values, n));
    CHECK(gp_copy_field(b, field, values + n, n));
    same = memcmp(values, values + n, (size_t)n * sizeof *values) == 0;
    free(values);
    return same;
}

/* What the feature adds to the plan, and what the smallest scene holds and spends for it: of stages and fields that it has
 * and the smallest scene has not. */
static void print_plan(gp_sim *minimal, gp_sim *with, double particles) {
    gp_plan_entry a[ENTRIES_MAX], b[ENTRIES_MAX];
    const int64_t n = plan_of(minimal, a), m = plan_of(with, b);
    double held = 0, seconds = 0, calls = 0;
    int64_t k;
    for (k = 0; k < n && k < m; ++k) {
        if (a[k].calls == 0 && b[k].calls > 0)
            printf("stage_%s %lld calls\n", b[k].name, (long long)b[k].calls);
        if (!a[k].active && b[k].active && b[k].kind == 1)
            printf("field_%s %.6g bytes/particle\n", b[k].name, (double)b[k].bytes / particles);
        if (!a[k].active) {
            held += (double)a[k].bytes;
            seconds += a[k].seconds;
            calls += (double)a[k].calls;
        }
    }
    printf("unused_bytes %.6g held by the smallest scene for what it leaves out\n", held);
    printf("unused_seconds %.6g spent there\n", seconds);
    printf("unused_calls %.6g made there\n", calls);
    printf("bytes_minimal %.6g bytes/particle\n", bytes_of(a, n) / particles);
    printf("bytes %.6g bytes/particle\n", bytes_of(b, m) / particles);
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Steps of both scenes in turn: what else the machine does then falls on both alike. */
static void compare(const choices *c, int state) {
    static double minimal_cpu[REPEATS_MAX], cpu[REPEATS_MAX], ratio[REPEATS_MAX];
    const int n = (int)c->repeat;
    const int64_t steps = (int64_t)c->steps;
    gp_sim *minimal = create(c, MINIMAL), *with = create(c, state);
    const double particles = (double)count_of(with), unit = 1e9 / particles / c->steps;
    int k;
    CHECK(gp_step(minimal, (int64_t)c->warm));
    CHECK(gp_step(with, (int64_t)c->warm));
    for (k = 0; k < n; ++k) {
        if (k % 2 == 0)
            minimal_cpu[k] = cpu_of(minimal, steps);
        cpu[k] = cpu_of(with, steps);
        if (k % 2 == 1)
            minimal_cpu[k] = cpu_of(minimal, steps);
        ratio[k] = cpu[k] / minimal_cpu[k];
    }
    print_plan(minimal, with, particles);
    printf("same_bits %d\n", same_field(minimal, with, GP_FIELD_X, (int64_t)particles) &&
                                 same_field(minimal, with, GP_FIELD_VY, (int64_t)particles) &&
                                 same_field(minimal, with, GP_FIELD_PRESSURE, (int64_t)particles));
    qsort(minimal_cpu, (size_t)n, sizeof *cpu, ascending);
    qsort(cpu, (size_t)n, sizeof *cpu, ascending);
    qsort(ratio, (size_t)n, sizeof *ratio, ascending);
    printf("particles %.0f\n", particles);
    printf("cpu_minimal %.6g ns/particle-step\n", minimal_cpu[n / 2] * unit);
    printf("cpu %.6g ns/particle-step\n", cpu[n / 2] * unit);
    printf("ratio %.6g of CPU times, median\n", ratio[n / 2]);
    printf("ratio_low %.6g lower quartile\n", ratio[n / 4]);
    printf("ratio_high %.6g upper quartile\n", ratio[3 * n / 4]);
    gp_destroy(minimal);
    gp_destroy(with);
}

int main(int argc, char **argv) {
    choices c = {32, 200, 50, 41, "used", "no", "features.h5", NONE};
    const bench_option options[] = {
        {"--resolution", "particles over the width [32]", BENCH_WHOLE, &c.resolution, 8, 1e4},
        {"--state", "used, or idle: there, with nothing to do [used]", BENCH_TEXT, &c.state, 0, 0},
        {"--alone", "minimal, idle or used: steps of this scene alone, unmeasured [no]", BENCH_TEXT, &c.alone, 0, 0},
        {"--warm", "steps before the measurement [200]", BENCH_WHOLE, &c.warm, 1, 1e9},
        {"--steps", "of each scene at a time [50]", BENCH_WHOLE, &c.steps, 1, 1e9},
        {"--repeat", "[41]", BENCH_WHOLE, &c.repeat, 1, REPEATS_MAX},
        {"--file", "of the output [features.h5]", BENCH_TEXT, &c.file, 0, 0},
    };
    enum { OPTIONS = sizeof options / sizeof options[0] };
    example_program(argv[0]);
    bench_parse(argc, argv, argc, usage, OPTIONS, options); /* only for --help */
    if (argc < 2)
        bench_refuse("FEATURE", NULL, "expected one first");
    c.feature = bench_choice("FEATURE", argv[1], FEATURES, feature_names);
    bench_parse(argc, argv, 2, usage, OPTIONS, options);
    if (strcmp(c.alone, "no") != 0) {
        gp_sim *sim = create(&c, bench_choice("--alone", c.alone, STATES, state_names));
        CHECK(gp_step(sim, (int64_t)c.steps));
        printf("particles %.0f\n", (double)count_of(sim));
        gp_destroy(sim);
    } else {
        const int state = bench_choice("--state", c.state, STATES, state_names);
        compare(&c, state);
    }
    printf("cpu_seconds %.6g s, of the whole program\n", cpu_seconds());
    return 0;
}
