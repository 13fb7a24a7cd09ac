#define _POSIX_C_SOURCE 200112L /* isatty */
#include "example.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static const char *program = "example";

/* ------------------------------------------------------------------------------------------- options */

example_options example_defaults(double resolution, double end, const char *output) {
    example_options options = {0};
    options.resolution = resolution;
    options.end = end;
    options.lift_time = 0.1;
    options.threads = 1;
    options.mu_s_degrees = 21;
    options.mu_2_degrees = 32;
    options.output = gp_has_feature("hdf5") || !output ? output : "none";
    return options;
}

static void print_help(const char *about, const example_options *o, const example_extra *extra) {
    printf("usage: %s [options]\n\n%s\n\noptions [default]\n", program, about);
    if (extra)
        printf("  %s %-*s %s [%g]\n", extra->name, 21 - (int)strlen(extra->name), extra->argument, extra->help,
               *extra->value);
    printf("  --resolution N         particles over the reference length [%g]\n", o->resolution);
    if (isnan(o->end))
        printf("  --end SECONDS          end of the run [depends on the case]\n");
    else
        printf("  --end SECONDS          end of the run [%g]\n", o->end);
    printf("  --threads N            threads, 0 for the OpenMP default [%g]\n", o->threads);
    if (o->output)
        printf("  --output FILE.h5       frames every 0.01 s, \"none\" for no file [%s]\n", o->output);
    if (!isnan(o->lift_time))
        printf("  --lift-time SECONDS    a gate, lifted with uniform acceleration, clears the height\n"
               "                         of its column in this time; 0: no gates [%g]\n",
               o->lift_time);
    if (!isnan(o->mu_s_degrees)) {
        printf("  --mu-s-degrees ANGLE   friction angle at rest [%g]\n", o->mu_s_degrees);
        printf("  --mu-2-degrees ANGLE   friction angle of fast flow [%g]\n", o->mu_2_degrees);
    }
    printf("  --help                 print this and end\n");
}

static void bad_option(const char *name, const char *value, const char *expected) {
    fprintf(stderr, "%s: %s%s%s: %s (see --help)\n", program, name, value ? " " : "", value ? value : "", expected);
    exit(2);
}

static double parse_number(const char *name, const char *text, double low, double high, int whole) {
    char *rest;
    char expected[120];
    const double value = strtod(text, &rest);
    if (rest == text || *rest != '\0' || !(value >= low && value <= high) || (whole && value != floor(value))) {
        snprintf(expected, sizeof expected, "expected a %snumber from %g to %g", whole ? "whole " : "", low, high);
        bad_option(name, text, expected);
    }
    return value;
}

void example_program(const char *path) {
    const char *slash = strrchr(path, '/');
    program = slash ? slash + 1 : path;
}

void example_parse(int argc, char **argv, const char *about, example_options *o, const example_extra *extra) {
    const example_extra known[] = {
        {"--resolution", "", "", &o->resolution, 1, 1e5, 1},    {"--end", "", "", &o->end, 1e-9, 1e6, 0},
        {"--threads", "", "", &o->threads, 0, 1024, 1},         {"--lift-time", "", "", &o->lift_time, 0, 1e6, 0},
        {"--mu-s-degrees", "", "", &o->mu_s_degrees, 0, 89, 0}, {"--mu-2-degrees", "", "", &o->mu_2_degrees, 0, 89, 0},
    };
    const example_extra *option;
    size_t n;
    int k;
    example_program(argv[0]);
    for (k = 1; k < argc; ++k)
        if (strcmp(argv[k], "--help") == 0) {
            print_help(about, o, extra);
            exit(0);
        }
    for (k = 1; k < argc; k += 2) {
        option = extra && strcmp(argv[k], extra->name) == 0 ? extra : NULL;
        for (n = 0; n < sizeof known / sizeof known[0]; ++n)
            if (strcmp(argv[k], known[n].name) == 0)
                option = isnan(*known[n].value) && known[n].value != &o->end ? NULL : &known[n];
        if (!option && (!o->output || strcmp(argv[k], "--output") != 0))
            bad_option(argv[k], NULL, "unknown option");
        if (k + 1 == argc || argv[k + 1][0] == '\0')
            bad_option(argv[k], NULL, "expected a value after it");
        if (option)
            *option->value = parse_number(option->name, argv[k + 1], option->low, option->high, option->whole);
        else
            o->output = argv[k + 1];
    }
    if (o->mu_2_degrees < o->mu_s_degrees)
        bad_option("--mu-2-degrees", NULL, "expected an angle not below that of --mu-s-degrees");
}

/* --------------------------------------------------------------------------------------------- scene */

void example_check(gp_status status, const char *call) {
    if (status >= 0)
        return;
    fprintf(stderr, "%s: %.*s: %s\n", program, (int)strcspn(call, "("), call, gp_last_error());
    exit(status == GP_E_ARGUMENT ? 2 : status == GP_E_UNSUPPORTED ? 3 : 1);
}

void example_log(void *user, int32_t level, const char *text) {
    (void)user;
    if (level >= GP_LOG_WARNING)
        fprintf(stderr, "%s: %s\n", program, text);
}

gp_sim *example_create(const example_options *options, double spacing, double grain_diameter) {
    gp_config config;
    CHECK(gp_config_init(&config, sizeof config, GP_PRESET_DEFAULT));
    return example_create_with(options, config, spacing, grain_diameter);
}

gp_sim *example_create_with(const example_options *options, gp_config config, double spacing, double grain_diameter) {
    const double degree = acos(-1.0) / 180;
    gp_material material;
    gp_sim *sim;
    config.spacing = spacing;
    config.threads = (int32_t)options->threads;
    CHECK(gp_create(&config, &sim));
    CHECK(gp_set_log(sim, example_log, NULL));

    CHECK(gp_material_init(&material, sizeof material));
    material.grain_diameter = grain_diameter;
    material.mu_s = tan(options->mu_s_degrees * degree);
    material.mu_2 = tan(options->mu_2_degrees * degree);
    CHECK(gp_add_material(sim, &material, NULL));
    return sim;
}

void example_add_floor(gp_sim *sim, double x_left, double x_right) {
    gp_plate floor_plate;
    CHECK(gp_plate_init(&floor_plate, sizeof floor_plate));
    /* The body of a plate is on the left of the way from end 0 to end 1: a floor runs from right to left. */
    floor_plate.x0 = x_right;
    floor_plate.x1 = x_left;
    CHECK(gp_add_plate(sim, &floor_plate, NULL));
}

void example_add_gate(gp_sim *sim, double x, int side, double height, double spacing, double lift_time) {
    enum { KNOTS = 41 };
    double t[KNOTS], dx[KNOTS] = {0}, dy[KNOTS];
    /* The gate goes on until its lower end is well clear of the column: displacement = height (t / lift_time)^2. */
    const double clear = height + 6 * spacing, t_clear = lift_time * sqrt(clear / height);
    const double top = height + 6 * spacing;
    gp_plate gate;
    int k;
    if (lift_time == 0)
        return;
    for (k = 0; k < KNOTS; ++k) {
        const double part = (double)k / (KNOTS - 1);
        t[k] = part * t_clear;
        dy[k] = part * part * clear;
    }
    CHECK(gp_plate_init(&gate, sizeof gate));
    gate.x0 = gate.x1 = x;
    /* Upwards the body is on the left and the material on the right; downwards the other way round. */
    gate.y0 = side == EXAMPLE_MATERIAL_RIGHT ? 0 : top;
    gate.y1 = side == EXAMPLE_MATERIAL_RIGHT ? top : 0;
    gate.friction = GP_WALL_FREE_SLIP;
    gate.n_knots = KNOTS;
    gate.knot_t = t;
    gate.knot_x = dx;
    gate.knot_y = dy;
    CHECK(gp_add_plate(sim, &gate, NULL));
}

void example_fill(gp_sim *sim, double spacing, double x_min, double x_max, double y_min, double y_max,
                  int (*inside)(double x, double y, const void *user), const void *user) {
    const long columns = lround((x_max - x_min) / spacing), rows = lround((y_max - y_min) / spacing);
    double *x = malloc((size_t)(columns * rows) * sizeof *x), *y = malloc((size_t)(columns * rows) * sizeof *y);
    long i, j, n = 0;
    if (!x || !y) {
        fprintf(stderr, "%s: no memory for %ld particles\n", program, columns * rows);
        exit(1);
    }
    for (j = 0; j < rows; ++j)
        for (i = 0; i < columns; ++i) {
            x[n] = x_min + ((double)i + 0.5) * spacing;
            y[n] = y_min + ((double)j + 0.5) * spacing;
            n += inside(x[n], y[n], user) != 0;
        }
    CHECK(gp_add_particles(sim, 1, n, x, y, NULL, NULL, NULL));
    free(x);
    free(y);
}

/* ----------------------------------------------------------------------------------------------- run */

gp_state example_state(gp_sim *sim) {
    gp_state state;
    state.struct_size = sizeof state;
    CHECK(gp_get_state(sim, &state));
    return state;
}

gp_load example_load(gp_sim *sim, int32_t plate) {
    gp_load load;
    load.struct_size = sizeof load;
    CHECK(gp_get_plate_load(sim, plate, &load));
    return load;
}

static void print_progress(const gp_state *s, double end) {
    const double rate = s->wall_seconds > 0 ? (double)s->n_particles * (double)s->step / s->wall_seconds : 0;
    fprintf(stderr, "\r%8.3f s  %3.0f %%  %8.2e particle-steps/s  %5.0f s left ", s->time, floor(100 * s->time / end),
            rate, s->wall_seconds * (end - s->time) / s->time);
    fflush(stderr);
}

static void print_summary(const gp_state *s, double rest_since, double cpu_seconds) {
    const double energy = s->kinetic + s->potential + s->elastic + s->dissipated + s->plate_work + s->energy_error;
    printf("time                %.6g s\n", s->time);
    printf("particles           %lld\n", (long long)s->n_particles);
    printf("steps               %lld\n", (long long)s->step);
    printf("peak_height         %.5f m\n", s->peak_height);
    printf("peak_x              %.5f m\n", s->peak_x);
    printf("x_left              %.5f m\n", s->x_left);
    printf("x_right             %.5f m\n", s->x_right);
    printf("at_rest             %d\n", s->at_rest);
    if (s->at_rest)
        printf("at_rest_since       %.2f s\n", rest_since);
    printf("energy_initial      %.6g J/m\n", energy);
    printf("kinetic             %.6g J/m\n", s->kinetic);
    printf("potential           %.6g J/m\n", s->potential);
    printf("elastic             %.6g J/m\n", s->elastic);
    printf("dissipated          %.6g J/m\n", s->dissipated);
    printf("plate_work          %.6g J/m\n", s->plate_work);
    printf("energy_error        %.6g J/m\n", s->energy_error);
    printf("energy_error_share  %.4f %% of energy_initial\n", energy > 0 ? 100 * s->energy_error / energy : 0);
    printf("cpu_seconds         %.2f s\n", cpu_seconds);
    printf("particle_steps_rate %.4g per CPU second\n",
           cpu_seconds > 0 ? (double)s->n_particles * (double)s->step / cpu_seconds : 0);
}

typedef struct {
    double due;    /* s: the run stops after the first step at or past it, which leaves the steps as long as they are */
    int64_t every; /* steps between looks */
    gp_callback look; /* of the example; or NULL */
    void *user;
} watch;

static int32_t after_step(void *user, gp_sim *sim) {
    const watch *w = user;
    double time, dt;
    int64_t step;
    CHECK(gp_get_clock(sim, &time, &dt, &step));
    if (w->look != NULL && step % w->every == 0)
        w->look(w->user, sim);
    return time + 1e-9 * dt >= w->due;
}

void example_run(gp_sim *sim, const example_options *options) {
    example_run_and_look(sim, options, 1, NULL, NULL);
}

void example_run_and_look(gp_sim *sim, const example_options *options, int64_t every, gp_callback look, void *user) {
    const double interval = 0.01; /* s between frames, and between looks at the state */
    const int progress = isatty(STDERR_FILENO), file = strcmp(options->output, "none") != 0;
    const clock_t begin = clock(); /* the CPU time of all threads */
    watch w = {0, every, look, user};
    double rest_since = 0;
    int was_at_rest = 0;
    gp_state state = example_state(sim);
    if (file) {
        gp_output output;
        CHECK(gp_output_init(&output, sizeof output));
        output.every_seconds = interval;
        CHECK(gp_output_open(sim, options->output, &output));
    }
    CHECK(gp_set_callback(sim, 1, after_step, &w));
    while (state.time < options->end) {
        w.due = interval * (floor((state.time + 1e-9 * state.dt) / interval) + 1);
        CHECK(gp_run(sim, options->end));
        state = example_state(sim);
        if (state.at_rest && !was_at_rest)
            rest_since = state.time;
        was_at_rest = state.at_rest;
        if (progress)
            print_progress(&state, options->end);
    }
    CHECK(gp_set_callback(sim, 0, NULL, NULL));
    if (progress)
        fputc('\n', stderr);
    if (file)
        CHECK(gp_output_close(sim));
    print_summary(&state, rest_since, (double)(clock() - begin) / CLOCKS_PER_SEC);
}
