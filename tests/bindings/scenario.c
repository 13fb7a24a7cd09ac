/* The scenario that is written in C, Fortran and Python: each has to leave the same particles to the last bit.
 *
 * A column between a wall and a gate that a table lifts and turns, on a belt, is hit by a handful of particles that a wheel of
 * four corners throws, and a lid that the host drives from a callback comes down on it, as it drives the wheel. After 100, 200 and 300 steps it prints
 *     step N particles N hash H
 * where H is FNV-1a (64 bits) over the bytes of x, y, vx, vy and pressure of all particles in the order of id, then those of
 * fx, fy, torque, dx, dy, impulse_x, impulse_y, torque_pivot, angle, impulse_torque of the loads of lid and wheel.
 *
 * No number that goes in is of the form a * b + c, which one compiler rounds once and another one twice. */
#include <granperi/gp.h>
#include <stdio.h>
#include <stdlib.h>

enum { N_THROWN = 6, N_KNOTS = 5, N_CORNERS = 5, N_STEPS = 100, EVERY = 7 };

typedef struct driven {
    int32_t lid, wheel;
} driven;

static void check(gp_status status) {
    if (status < 0) {
        fprintf(stderr, "%s\n", gp_last_error());
        exit(1);
    }
}

static uint64_t add_to_hash(uint64_t hash, const double *values, int64_t n) {
    const unsigned char *byte = (const unsigned char *)values, *end = byte + (size_t)n * sizeof *values;
    while (byte < end)
        hash = (hash ^ *byte++) * UINT64_C(1099511628211);
    return hash;
}

static uint64_t add_load(uint64_t hash, gp_sim *sim, int32_t plate) {
    gp_load load = {.struct_size = sizeof load};
    check(gp_get_plate_load(sim, plate, &load));
    {
        const double values[] = {load.fx,        load.fy,        load.torque,       load.dx,    load.dy,
                                 load.impulse_x, load.impulse_y, load.torque_pivot, load.angle, load.impulse_torque};
        return add_to_hash(hash, values, sizeof values / sizeof values[0]);
    }
}

static uint64_t hash_of(gp_sim *sim, int64_t n, const driven *plates) {
    static const uint32_t fields[] = {GP_FIELD_X, GP_FIELD_Y, GP_FIELD_VX, GP_FIELD_VY, GP_FIELD_PRESSURE};
    double *values = malloc((size_t)n * sizeof *values);
    uint64_t hash = UINT64_C(14695981039346656037);
    if (!values)
        exit(1);
    for (size_t k = 0; k < sizeof fields / sizeof fields[0]; ++k) {
        check(gp_copy_field(sim, fields[k], values, n));
        hash = add_to_hash(hash, values, n);
    }
    free(values);
    return add_load(add_load(hash, sim, plates->lid), sim, plates->wheel);
}

/* The lid sinks faster and faster: 4 m/s2; the wheel turns faster and faster; and the scene is tilted. */
static int32_t drive(void *user, gp_sim *sim) {
    const driven *plates = user;
    gp_state state = {.struct_size = sizeof state};
    return gp_get_state(sim, &state) < 0 || gp_set_plate_velocity(sim, plates->lid, 0, -4 * state.time) < 0 ||
           gp_set_plate_motion(sim, plates->wheel, -0.25, 0, 512 * state.time) < 0 ||
           gp_set_gravity(sim, 50 * state.time, -9.5) < 0;
}

static int32_t add_plate(gp_sim *sim, double x0, double y0, double x1, double y1, int32_t friction) {
    gp_plate plate;
    int32_t id;
    check(gp_plate_init(&plate, sizeof plate));
    plate.x0 = x0;
    plate.y0 = y0;
    plate.x1 = x1;
    plate.y1 = y1;
    plate.friction = friction;
    check(gp_add_plate(sim, &plate, &id));
    return id;
}

int main(void) {
    const double knot_t[N_KNOTS] = {0, 0.005, 0.01, 0.015, 0.02}, knot_x[N_KNOTS] = {0};
    const double knot_y[N_KNOTS] = {0, 0.001, 0.004, 0.009, 0.016}, knot_angle[N_KNOTS] = {0, 0, 0, 0.03125, 0.0625};
    /* Counter-clockwise: the material is outside. */
    const double point_x[N_CORNERS] = {0.17, 0.15, 0.13, 0.15, 0.17},
                 point_y[N_CORNERS] = {0.03, 0.05, 0.03, 0.01, 0.03};
    double x[N_THROWN], y[N_THROWN], vx[N_THROWN], vy[N_THROWN];
    gp_config config;
    gp_material material;
    gp_column column;
    gp_plate belt, gate, wheel;
    gp_state state = {.struct_size = sizeof state};
    gp_sim *sim;
    int32_t beads;
    driven plates;
    int k;

    check(gp_config_init(&config, sizeof config, GP_PRESET_DEFAULT));
    config.spacing = 0.004;
    config.sound_speed = 20;
    config.threads = 1;
    config.seed = 7;
    config.jitter = 0.05;
    check(gp_create(&config, &sim));

    check(gp_material_init(&material, sizeof material));
    material.grain_diameter = 0.001;
    material.mu_s = 0.4;
    check(gp_add_material(sim, &material, &beads));

    check(gp_column_init(&column, sizeof column));
    column.width = 0.08;
    column.height = 0.064;
    column.material = beads;
    check(gp_add_column(sim, &column, NULL));

    for (k = 0; k < N_THROWN; ++k) {
        x[k] = 0.12;
        y[k] = (k + 1) * 0.004;
        vx[k] = -0.5;
        vy[k] = (k + 1) * 0.0625;
    }
    check(gp_add_particles(sim, 0, N_THROWN, x, y, vx, vy, NULL));

    check(gp_plate_init(&belt, sizeof belt));
    belt.x0 = 0.3;
    belt.surface_velocity = 0.25;
    check(gp_add_plate(sim, &belt, NULL));
    add_plate(sim, 0, 0, 0, 0.1, GP_WALL_FREE_SLIP);
    plates.lid = add_plate(sim, 0, 0.066, 0.06, 0.066, GP_WALL_COULOMB);
    check(gp_plate_init(&gate, sizeof gate));
    gate.x0 = gate.x1 = 0.08;
    gate.y0 = 0.1;
    gate.friction = GP_WALL_FREE_SLIP;
    gate.n_knots = N_KNOTS;
    gate.knot_t = knot_t;
    gate.knot_x = knot_x;
    gate.knot_y = knot_y;
    gate.knot_angle = knot_angle;
    gate.pivot_x = 0.08;
    gate.pivot_y = 0.1;
    check(gp_add_plate(sim, &gate, NULL));
    check(gp_plate_init(&wheel, sizeof wheel));
    wheel.n_points = N_CORNERS;
    wheel.point_x = point_x;
    wheel.point_y = point_y;
    wheel.pivot_x = 0.15;
    wheel.pivot_y = 0.03;
    check(gp_add_plate(sim, &wheel, &plates.wheel));

    check(gp_set_callback(sim, EVERY, drive, &plates));
    for (k = 0; k < 3; ++k) {
        check(gp_step(sim, N_STEPS));
        check(gp_get_state(sim, &state));
        printf("step %lld particles %lld hash %016llx\n", (long long)state.step, (long long)state.n_particles,
               (unsigned long long)hash_of(sim, state.n_particles, &plates));
    }
    gp_destroy(sim);
    return 0;
}
