/* What a time step costs: a collapse (both_side, a = 1.25) is run to the middle of its flow, then some steps are measured.
 * docs/hot-path.md is made with it; bench/README.md says how to measure. */
#define _POSIX_C_SOURCE 200112L
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "../examples/c/example.h" /* CHECK, floor */
#include "options.h"

enum { ENTRIES_MAX = 128 };

typedef struct choices {
    double resolution, threads, from, steps, repeat, horizon, diffusion, walls, amplitude;
    const char *read, *write;
} choices;

static const char usage[] = "usage: step [options]\n\n"
                            "A column, 0.08 m wide and 0.05 m high, collapses to both sides; after --from seconds the\n"
                            "costs of --steps steps are measured. Prints lines of \"name value unit\".\n";

static double cpu_seconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double wall_seconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Bytes, of this program. What getrusage says on Linux may be that of the program that started it. */
static double peak_memory(void) {
    char line[200];
    double kibibytes = NAN;
    FILE *status = fopen("/proc/self/status", "r");
    while (status && fgets(line, sizeof line, status))
        if (sscanf(line, "VmHWM: %lf", &kibibytes) == 1)
            break;
    if (status)
        fclose(status);
    return 1024 * kibibytes;
}

static int64_t count_of(gp_sim *sim) {
    gp_state state;
    state.struct_size = sizeof state;
    CHECK(gp_get_state(sim, &state));
    return state.n_particles;
}

/* A file of x, y, vx, vy: a run on is long at high resolutions, and its end is good for many measurements. */
static void read_particles(gp_sim *sim, const char *path) {
    FILE *file = fopen(path, "rb");
    int64_t n = 0;
    double *data;
    if (!file || fread(&n, sizeof n, 1, file) != 1 || n < 1 || n > 100000000)
        bench_refuse("--read", path, "expected a file that --write made");
    data = malloc(sizeof *data * 4 * (size_t)n);
    if (!data || fread(data, sizeof *data * 4, (size_t)n, file) != (size_t)n)
        bench_refuse("--read", path, "expected a file that --write made");
    CHECK(gp_add_particles(sim, 1, n, data, data + n, data + 2 * n, data + 3 * n, NULL));
    free(data);
    fclose(file);
}

static void write_particles(gp_sim *sim, const char *path) {
    static const uint32_t fields[] = {GP_FIELD_X, GP_FIELD_Y, GP_FIELD_VX, GP_FIELD_VY};
    const int64_t n = count_of(sim);
    double *data = malloc(sizeof *data * (size_t)n);
    FILE *file = fopen(path, "wb");
    int k, good = data && file && fwrite(&n, sizeof n, 1, file) == 1;
    for (k = 0; good && k < 4; ++k) {
        CHECK(gp_copy_field(sim, fields[k], data, n));
        good = fwrite(data, sizeof *data, (size_t)n, file) == (size_t)n;
    }
    if (!good || fclose(file) != 0)
        bench_refuse("--write", path, "expected a file that can be written");
    free(data);
}

/* Smooth; material on the right of the way from y0 to y1. */
static void add_wall(gp_sim *sim, double x, double y0, double y1) {
    gp_plate wall;
    CHECK(gp_plate_init(&wall, sizeof wall));
    wall.x0 = wall.x1 = x;
    wall.y0 = y0;
    wall.y1 = y1;
    wall.friction = GP_WALL_FREE_SLIP;
    CHECK(gp_add_plate(sim, &wall, NULL));
}

static gp_sim *create(const choices *c) {
    const double width = 0.08, height = 0.05, spacing = width / c->resolution;
    const double reach = width / 2 + 4 * height + 20 * spacing;
    gp_config config;
    gp_column column;
    gp_material material;
    gp_sim *sim;
    CHECK(gp_config_init(&config, sizeof config, GP_PRESET_DEFAULT));
    config.spacing = spacing;
    config.threads = (int32_t)c->threads;
    config.horizon = c->horizon;
    config.sound_speed = 10 * sqrt(2 * 9.81 * height);
    if (!isnan(c->diffusion))
        config.density_diffusion = c->diffusion;
    CHECK(gp_create(&config, &sim));
    CHECK(gp_material_init(&material, sizeof material));
    material.nonlocal_amplitude = c->amplitude;
    CHECK(gp_add_material(sim, &material, NULL));
    if (c->read) {
        read_particles(sim, c->read);
    } else {
        CHECK(gp_column_init(&column, sizeof column));
        column.x_min = -width / 2;
        column.width = width;
        column.height = height;
        column.material = 1;
        CHECK(gp_add_column(sim, &column, NULL));
    }
    example_add_floor(sim, -reach, reach);
    if (c->walls != 0) {
        add_wall(sim, -width / 2, 0, height + 6 * spacing);
        add_wall(sim, width / 2, height + 6 * spacing, 0);
    }
    return sim;
}

static int64_t plan_of(gp_sim *sim, gp_plan_entry *entries) {
    int64_t n;
    CHECK(gp_get_plan(sim, ENTRIES_MAX, entries, &n));
    return n < ENTRIES_MAX ? n : ENTRIES_MAX;
}

/* What one measurement found, ns per particle and step. */
typedef struct cost {
    double cpu, wall, stage[ENTRIES_MAX];
} cost;

static cost measure(gp_sim *sim, const choices *c) {
    gp_plan_entry before[ENTRIES_MAX], after[ENTRIES_MAX];
    const int64_t entries = plan_of(sim, before);
    const double cpu = cpu_seconds(), wall = wall_seconds();
    const double each = 1e9 / ((double)count_of(sim) * c->steps);
    cost found;
    int64_t k;
    CHECK(gp_step(sim, (int64_t)c->steps));
    found.cpu = each * (cpu_seconds() - cpu);
    found.wall = each * (wall_seconds() - wall);
    plan_of(sim, after);
    for (k = 0; k < entries; ++k)
        found.stage[k] = each * (after[k].seconds - before[k].seconds);
    return found;
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Of the member at `offset` of each of n costs; sorts them into `sorted`. */
static double median_of(const cost *costs, size_t offset, int n, double *sorted) {
    int k;
    for (k = 0; k < n; ++k)
        memcpy(&sorted[k], (const char *)&costs[k] + offset, sizeof *sorted);
    qsort(sorted, (size_t)n, sizeof *sorted, ascending);
    return (sorted[(n - 1) / 2] + sorted[n / 2]) / 2;
}

static void report(gp_sim *sim, const cost *costs, int n, double *sorted) {
    gp_plan_entry plan[ENTRIES_MAX];
    const int64_t entries = plan_of(sim, plan);
    const double cpu = median_of(costs, offsetof(cost, cpu), n, sorted), least = sorted[0];
    double bytes = 0;
    int64_t k;
    printf("particles %.0f 1\n", (double)count_of(sim));
    printf("cpu %.6g ns/particle-step\n", cpu);
    printf("cpu_least %.6g ns/particle-step\n", least);
    printf("wall %.6g ns/particle-step\n", median_of(costs, offsetof(cost, wall), n, sorted));
    printf("rate %.6g 1e6 particle-steps/cpu-second\n", 1e3 / cpu);
    for (k = 0; k < entries; ++k) {
        const double stage = median_of(costs, offsetof(cost, stage) + (size_t)k * sizeof(double), n, sorted);
        bytes += (double)plan[k].bytes;
        if (stage > 0)
            printf("stage_%s %.6g ns/particle-step\n", plan[k].name, stage);
    }
    for (k = 0; k < entries; ++k)
        if (plan[k].bytes > 0)
            printf("bytes_%s %.6g bytes/particle\n", plan[k].name, (double)plan[k].bytes / (double)count_of(sim));
    printf("bytes %.6g bytes/particle\n", bytes / (double)count_of(sim));
    printf("peak_memory %.6g bytes, of the whole program so far\n", peak_memory());
    printf("cpu_seconds %.6g s, of the whole program so far\n", cpu_seconds());
}

static void measure_and_report(gp_sim *sim, const choices *c) {
    const int n = (int)c->repeat;
    cost *costs = malloc(sizeof *costs * (size_t)n);
    double *sorted = malloc(sizeof *sorted * (size_t)n);
    int k;
    if (!costs || !sorted)
        bench_refuse("--repeat", "that many", "no memory for as many measurements");
    for (k = 0; k < n; ++k)
        costs[k] = measure(sim, c);
    report(sim, costs, n, sorted);
    free(sorted);
    free(costs);
}

int main(int argc, char **argv) {
    choices c = {126, 1, 0.15, 300, 1, 4, NAN, 0, 0, NULL, NULL};
    const bench_option options[] = {
        {"--resolution", "particles over the width; N = 0.625 of its square [126]", BENCH_WHOLE, &c.resolution, 4, 1e5},
        {"--threads", "threads, 0 for the OpenMP default [1]", BENCH_WHOLE, &c.threads, 0, 1024},
        {"--from", "s, when the measurement begins [0.15]", BENCH_NUMBER, &c.from, 0, 1e6},
        {"--steps", "steps to measure [300]", BENCH_WHOLE, &c.steps, 1, 1e9},
        {"--repeat", "measurements of --steps steps, one after the other: their medians and the least CPU time [1]",
         BENCH_WHOLE, &c.repeat, 1, 1e6},
        {"--horizon", "spacings [4]", BENCH_NUMBER, &c.horizon, 1.8, 8},
        {"--diffusion", "density diffusion [the scheme's own]", BENCH_NUMBER, &c.diffusion, 0, 1},
        {"--walls", "1: between smooth walls, so that it stays at rest [0]", BENCH_WHOLE, &c.walls, 0, 1},
        {"--amplitude", "of the granular fluidity [0: the local law]", BENCH_NUMBER, &c.amplitude, 0, 10},
        {"--read", "begin with the particles of this file [with a column at rest]", BENCH_TEXT, &c.read, 0, 0},
        {"--write", "write the particles at --from to this file, and end", BENCH_TEXT, &c.write, 0, 0},
    };
    gp_sim *sim;
    example_program(argv[0]);
    bench_parse(argc, argv, 1, usage, (int)(sizeof options / sizeof options[0]), options);
    sim = create(&c);
    if (c.from > 0)
        CHECK(gp_run(sim, c.from));
    if (c.write)
        write_particles(sim, c.write);
    else
        measure_and_report(sim, &c);
    gp_destroy(sim);
    return 0;
}
