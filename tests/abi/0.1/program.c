/* A program of 0.1: compiled with that version's header, it runs with the library of now. Behind each struct that the library
 * fills it has bytes of its own, and in what the compiler left at the end of a struct lies whatever happened to be there. */
#include <granperi/gp.h>

#include <stdio.h>
#include <string.h>

static int failures;

static void expect(int truth, const char *what) {
    if (truth)
        return;
    printf("FAILED: %s (last error: %s)\n", what, gp_last_error());
    ++failures;
}

#define OK(call) expect((call) == GP_OK, #call)

/* The bytes behind `last`, up to the end of the struct. */
#define LITTER_BEHIND(object, last)                                                                                                \
    memset((unsigned char *)&(object).last + sizeof (object).last, 0xa5,                                                           \
           sizeof(object) - (size_t)((unsigned char *)&(object).last - (unsigned char *)&(object)) - sizeof (object).last)

/* A struct, and what belongs to the program. */
#define GUARDED(type, name)                                                                                                        \
    struct {                                                                                                                       \
        type it;                                                                                                                   \
        unsigned char ours[128];                                                                                                   \
    } name;                                                                                                                        \
    memset(&name, 0xa5, sizeof name);                                                                                              \
    name.it.struct_size = sizeof name.it

#define EXPECT_OURS(name)                                                                                                          \
    do {                                                                                                                           \
        size_t k;                                                                                                                  \
        for (k = 0; k < sizeof name.ours; ++k)                                                                                     \
            if (name.ours[k] != 0xa5)                                                                                              \
                break;                                                                                                             \
        expect(k == sizeof name.ours, "nothing is written behind " #name);                                                         \
    } while (0)

static int32_t count_call(void *user, gp_sim *sim) {
    (void)sim;
    ++*(int *)user;
    return 0;
}

static void add_scene(gp_sim *sim) {
    GUARDED(gp_material, material);
    GUARDED(gp_column, column);
    GUARDED(gp_plate, plate);
    static const double t[] = {0, 0.01, 0.1}, x[] = {0, 0, 0}, y[] = {0, 0, 0.1};
    int32_t id = -1;
    OK(gp_material_init(&material.it, sizeof material.it));
    material.it.mu_s = 0.4, material.it.mu_2 = 0.7;
    OK(gp_add_material(sim, &material.it, &id));
    OK(gp_column_init(&column.it, sizeof column.it));
    column.it.width = 0.05, column.it.height = 0.04, column.it.material = id;
    LITTER_BEHIND(column.it, initial_pressure);
    OK(gp_add_column(sim, &column.it, &id));
    OK(gp_plate_init(&plate.it, sizeof plate.it));
    plate.it.x0 = 0.5, plate.it.x1 = -0.5;
    OK(gp_add_plate(sim, &plate.it, &id));
    OK(gp_plate_init(&plate.it, sizeof plate.it));
    plate.it.friction = GP_WALL_FREE_SLIP;
    plate.it.x0 = plate.it.x1 = 0.05, plate.it.y0 = 0.1; /* a gate */
    plate.it.n_knots = 3, plate.it.knot_t = t, plate.it.knot_x = x, plate.it.knot_y = y;
    OK(gp_add_plate(sim, &plate.it, &id));
    EXPECT_OURS(material);
    EXPECT_OURS(column);
    EXPECT_OURS(plate);
}

static void look(gp_sim *sim) {
    GUARDED(gp_state, state);
    GUARDED(gp_particles, own);
    GUARDED(gp_load, load);
    double field[200];
    uint32_t bit;
    OK(gp_get_state(sim, &state.it));
    expect(state.it.n_particles == 80 && state.it.n_awake == 80 && state.it.time == 0.05 && state.it.peak_height > 0.02 &&
               state.it.max_compression < 0.1 && state.it.dt_limit > state.it.dt,
           "the state");
    OK(gp_get_particles(sim, GP_FIELD_ALL, &own.it));
    expect(own.it.count == 80 && own.it.x && own.it.number_density && own.it.number_density[0] > 0, "the particles");
    OK(gp_get_plate_load(sim, 0, &load.it));
    expect(load.it.fy < 0 && load.it.dx == 0, "the load on the floor");
    for (bit = 1; bit < GP_FIELD_ALL; bit <<= 1)
        expect(gp_copy_field(sim, bit, field, 80) == GP_OK, "a field");
    EXPECT_OURS(state);
    EXPECT_OURS(own);
    EXPECT_OURS(load);
}

int main(int argc, char **argv) {
    GUARDED(gp_config, config);
    GUARDED(gp_output, output);
    gp_sim *sim = NULL, *again = NULL;
    gp_plan_entry plan[256];
    int64_t n = 0;
    int calls = 0;
    char path[2][1024];
    if (argc != 2)
        return 2;
    snprintf(path[0], sizeof path[0], "%s/frames.h5", argv[1]);
    snprintf(path[1], sizeof path[1], "%s/checkpoint.h5", argv[1]);
    printf("compiled with %d.%d.%d, running with %s\n", GP_VERSION_MAJOR, GP_VERSION_MINOR, GP_VERSION_PATCH, gp_version_string());
    OK(gp_config_init(&config.it, sizeof config.it, GP_PRESET_DEFAULT));
    config.it.spacing = 0.005, config.it.cfl = 0.8, config.it.retry_halvings = 2, config.it.threads = 1;
    LITTER_BEHIND(config.it, retry_halvings);
    OK(gp_create(&config.it, &sim));
    if (!sim)
        return 1;
    EXPECT_OURS(config);
    add_scene(sim);
    OK(gp_set_callback(sim, 10, count_call, &calls));
    if (gp_has_feature("hdf5")) {
        OK(gp_output_init(&output.it, sizeof output.it));
        output.it.every_seconds = 0.01;
        LITTER_BEHIND(output.it, append);
        OK(gp_output_open(sim, path[0], &output.it));
        EXPECT_OURS(output);
    }
    OK(gp_run(sim, 0.05));
    expect(calls > 0, "the callback");
    look(sim);
    OK(gp_get_plan(sim, 256, plan, &n));
    expect(n > 0 && n <= 256 && plan[0].kind == 0 && plan[0].calls > 0, "the plan");
    if (gp_has_feature("hdf5")) {
        OK(gp_output_close(sim));
        OK(gp_save(sim, path[1]));
        OK(gp_load(path[1], &again));
        look(again);
        gp_destroy(again);
    }
    gp_destroy(sim);
    return failures != 0;
}
