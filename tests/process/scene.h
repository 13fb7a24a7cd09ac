/* What the host programs of these tests share: a short run in each scheme, and a fingerprint of what it leaves. */
#ifndef GRANPERI_TESTS_PROCESS_SCENE_H
#define GRANPERI_TESTS_PROCESS_SCENE_H

#include <granperi/gp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DEFAULT_SCHEME, IMPLICIT_SCHEME, PAPER_SCHEME, LOCAL_SCHEME, SCHEMES };

static void give_up(const char *what) {
    fprintf(stderr, "FAILED: %s: %s\n", what, gp_last_error());
    exit(1);
}

static void require(int true_, const char *what) {
    if (!true_)
        give_up(what);
}

static void add_to(uint64_t *hash, const void *data, size_t size) {
    const unsigned char *bytes = (const unsigned char *)data;
    size_t k;
    for (k = 0; k < size; ++k)
        *hash = (*hash ^ bytes[k]) * 1099511628211u;
}

/* Of all fields in the order of id, and of the state but its wall-clock time. */
static uint64_t fingerprint(gp_sim *sim) {
    uint64_t hash = 14695981039346656037u;
    gp_state state;
    double *values;
    uint32_t field;
    memset(&state, 0, sizeof state);
    state.struct_size = (uint32_t)sizeof state;
    require(gp_get_state(sim, &state) == GP_OK, "gp_get_state");
    state.wall_seconds = 0;
    add_to(&hash, &state, sizeof state);
    values = (double *)malloc((size_t)state.n_particles * sizeof *values);
    for (field = 1; field & GP_FIELD_ALL; field <<= 1) {
        require(gp_copy_field(sim, field, values, state.n_particles) == GP_OK, "gp_copy_field");
        add_to(&hash, values, (size_t)state.n_particles * sizeof *values);
    }
    free(values);
    return hash;
}

/* 4800 particles, enough for several threads, on a floor; and a block in free flight whose velocity is subnormal. */
static gp_sim *make_scene(int scheme, int threads) {
    const int32_t presets[SCHEMES] = {GP_PRESET_DEFAULT, GP_PRESET_DEFAULT, GP_PRESET_PAPER, GP_PRESET_PAPER_LOCAL};
    gp_config config;
    gp_column column;
    gp_plate plate;
    gp_sim *sim = NULL;
    require(gp_config_init(&config, sizeof config, presets[scheme]) == GP_OK, "gp_config_init");
    if (scheme == IMPLICIT_SCHEME) {
        config.stress = GP_STRESS_IMPLICIT;
        config.delta = 1; /* the solve is soon done */
        config.time_step = 1e-4;
    }
    config.threads = threads;
    require(gp_create(&config, &sim) == GP_OK, "gp_create");
    gp_column_init(&column, sizeof column);
    column.width = 80 * config.spacing;
    column.height = 60 * config.spacing;
    require(gp_add_column(sim, &column, NULL) == GP_OK, "gp_add_column");
    column.x_min = 3 * column.width;
    column.y_min = column.height;
    column.width = column.height = 4 * config.spacing;
    column.vx = 1e-310;
    require(gp_add_column(sim, &column, NULL) == GP_OK, "gp_add_column, in flight");
    gp_plate_init(&plate, sizeof plate);
    plate.x0 = 1;
    plate.x1 = -1;
    require(gp_add_plate(sim, &plate, NULL) == GP_OK, "gp_add_plate");
    return sim;
}

static uint64_t run_scene(int scheme, int threads) {
    gp_sim *sim = make_scene(scheme, threads);
    uint64_t hash;
    require(gp_step(sim, scheme == IMPLICIT_SCHEME ? 3 : 10) == GP_OK, "gp_step");
    hash = fingerprint(sim);
    gp_destroy(sim);
    return hash;
}

#endif
