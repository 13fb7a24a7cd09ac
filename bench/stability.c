/* Runs trials of the numerical coefficients from the command line: what docs/stability.md is made of. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../examples/c/example.h" /* CHECK, example_program */
#include "follow.h"
#include "limit.h"
#include "options.h"
#include "table.h"
#include "trial.h"

enum { COLLAPSE, LAYER, LIMIT_COLLAPSE, LIMIT_LAYER, COMMANDS };
static const char *const command_names[COMMANDS] = {"collapse", "layer", "limit_collapse", "limit_layer"};

static const char usage[] = "usage: stability collapse|layer|limit_collapse|limit_layer [options]\n\n"
                            "collapse  a column, 0.08 m wide and 0.05 m high unless said otherwise, collapses; "
                            "--seeds: again for that many seeds\n"
                            "layer     a layer, 0.05 m deep and periodic, that should stay at rest on its rough floor\n"
                            "limit_... searches the largest stable time step of the scene\n"
                            "Prints lines of \"name value unit\".\n";

typedef struct choices {
    following follow;
    criterion limit;
    const char *prefix;
    double seeds;
} choices;

static void print_outcome(const outcome *o, double seconds, double particle_steps) {
    const gp_state *s = &o->state;
    printf("version             %s\n", gp_version_string());
    printf("diverged            %d\n", o->status == GP_E_DIVERGED);
    printf("time                %.6g s\n", s->time);
    printf("particles           %lld\n", (long long)s->n_particles);
    printf("steps               %lld\n", (long long)s->step);
    printf("dt                  %.6g s\n", s->dt);
    printf("sound_speed         %.6g m/s\n", s->sound_speed);
    printf("energy_initial      %.6g J/m\n", o->energy);
    printf("peak                %.8g m\n", o->peak);
    printf("tip                 %.8g L0\n", o->tip);
    printf("front               %.8g L0\n", o->front);
    printf("spread              %.8g L0\n", o->spread);
    printf("bulk                %.8g L0\n", o->bulk);
    printf("early               %.8g L0\n", o->early);
    printf("rest                %.6g s\n", o->rest);
    printf("gain                %.6g E0\n", o->gain);
    printf("error               %.6g E0\n", o->error);
    printf("kinetic             %.6g E0\n", o->kinetic);
    printf("pressure            %.6g rho g H\n", o->pressure);
    printf("late_pressure       %.6g rho g H\n", o->late_pressure);
    printf("late_mean           %.6g rho g H\n", o->late_mean);
    printf("memory              %.6g bytes\n", o->memory);
    printf("drift               %.6g dl\n", o->drift);
    printf("friction_share      %.6g of dissipated\n",
           1 - (s->penalty_dissipated + s->wall_dissipated + s->diffusion_dissipated + s->spacing_dissipated +
                s->bulk_dissipated + s->collision_dissipated) /
                   s->dissipated);
    printf("penalty_share       %.6g of dissipated\n", s->penalty_dissipated / s->dissipated);
    printf("wall_share          %.6g of dissipated\n", s->wall_dissipated / s->dissipated);
    printf("diffusion_share     %.6g of dissipated\n", s->diffusion_dissipated / s->dissipated);
    printf("spacing_share       %.6g of dissipated\n", s->spacing_dissipated / s->dissipated);
    printf("bulk_share          %.6g of dissipated\n", s->bulk_dissipated / s->dissipated);
    printf("collision_share     %.6g of dissipated\n", s->collision_dissipated / s->dissipated);
    printf("implicit_newton     %lld\n", (long long)s->implicit_newton);
    printf("implicit_linear     %lld\n", (long long)s->implicit_linear);
    printf("cpu_seconds         %.3f s\n", seconds);
    printf("particle_steps_rate %.4g per CPU second\n", seconds > 0 ? particle_steps / seconds : 0);
}

/* The table "series" is of the first seed; "seeds" has a row for each. */
static void run(trial *t, choices *c) {
    FILE *seeds = bench_open_table(c->prefix, "seeds");
    double seconds = 0, particle_steps = 0;
    outcome first, o;
    int k;
    memset(&first, 0, sizeof first);
    if (seeds)
        fprintf(seeds, "seed,diverged,peak,tip,front,spread,bulk,early,rest,error,gain,kinetic,pressure,late_pressure,"
                       "late_mean,steps\n");
    for (k = 0; k < (int)c->seeds; ++k, ++t->seed) {
        gp_sim *sim = trial_create(t);
        c->follow.table = k == 0 ? bench_open_table(c->prefix, "series") : NULL;
        o = follow(sim, t, &c->follow);
        bench_close_table(c->follow.table);
        gp_destroy(sim);
        seconds += o.seconds;
        particle_steps += (double)o.state.n_particles * (double)o.state.step;
        if (k == 0)
            first = o;
        if (seeds)
            fprintf(seeds, "%g,%d,%.8g,%.8g,%.8g,%.8g,%.8g,%.8g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%lld\n", t->seed,
                    o.status == GP_E_DIVERGED, o.peak, o.tip, o.front, o.spread, o.bulk, o.early, o.rest, o.error,
                    o.gain, o.kinetic, o.pressure, o.late_pressure, o.late_mean, (long long)o.state.step);
    }
    bench_close_table(seeds);
    print_outcome(&first, seconds, particle_steps);
}

int main(int argc, char **argv) {
    trial t;
    choices c = {.follow = {.end = 0.8, .interval = 0.01, .drift_from = INFINITY, .rested = INFINITY},
                 .limit = {0.2, 0.7, 6, 0},
                 .prefix = "none",
                 .seeds = 1};
    double rough = 0;
    const bench_option own[] = {
        {"--end", "s [0.8]", BENCH_NUMBER, &c.follow.end, 1e-9, 1e6},
        {"--steps", "at most; 0: until the end [0]", BENCH_WHOLE, &c.follow.steps, 0, 1e15},
        {"--interval", "s between rows of the series [0.01]", BENCH_NUMBER, &c.follow.interval, 1e-6, 1e6},
        {"--drift-from", "s, from where displacements count [never]", BENCH_NUMBER, &c.follow.drift_from, 0, 1e6},
        {"--rested", "s: a run that has been at rest for so long ends [never]", BENCH_NUMBER, &c.follow.rested, 0, 1e6},
        {"--rough", "1: the roughness of pressure and velocity in the series [0]", BENCH_WHOLE, &rough, 0, 1},
        {"--seeds", "runs, of --seed and those that follow it [1]", BENCH_WHOLE, &c.seeds, 1, 1e6},
        {"--smallest", "Courant number of the reference of limit_... [0.2]", BENCH_NUMBER, &c.limit.smallest, 1e-6,
         1e3},
        {"--first", "of the first trial [0.7]", BENCH_NUMBER, &c.limit.first, 1e-6, 1e3},
        {"--largest", "of the last [6]", BENCH_NUMBER, &c.limit.largest, 1e-6, 1e3},
        {"--output", "prefix of the tables, or none [none]", BENCH_TEXT, &c.prefix, 0, 0},
    };
    enum { OWN = sizeof own / sizeof own[0] };
    bench_option options[OWN + TRIAL_OPTIONS];
    int command;

    example_program(argv[0]);
    t = trial_defaults(TRIAL_COLLAPSE);
    memcpy(options, own, sizeof own);
    trial_options(&t, options + OWN);
    bench_parse(argc, argv, argc, usage, OWN + TRIAL_OPTIONS, options); /* only for --help */
    if (argc < 2)
        bench_refuse("command", NULL, "expected collapse, layer, limit_collapse or limit_layer first");
    command = bench_choice("command", argv[1], COMMANDS, command_names);
    t.scene = command == LAYER || command == LIMIT_LAYER ? TRIAL_LAYER : TRIAL_COLLAPSE;
    bench_parse(argc, argv, 2, usage, OWN + TRIAL_OPTIONS, options);
    c.follow.rough = rough != 0;
    if (command == COLLAPSE || command == LAYER) {
        run(&t, &c);
    } else {
        FILE *table = bench_open_table(c.prefix, "trials");
        /* The last grains of a collapse are still settling; a layer has only what its jitter began. */
        c.limit.at_rest = command == LIMIT_LAYER ? 1e-7 : 1e-5;
        search_limit(&t, &c.follow, &c.limit, (int)c.seeds, table);
        bench_close_table(table);
    }
    return 0;
}
