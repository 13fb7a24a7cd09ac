/* A program outside the tree: a column falls onto a floor. Argument: a directory for its result file. */
#include <granperi/gp.h>
#include <stdio.h>
#include <string.h>

int main(int argc, char **argv) {
    gp_config config;
    gp_column column;
    gp_plate floor;
    gp_state state;
    gp_sim *sim = NULL;
    char path[4096];
    int32_t hdf5 = gp_has_feature("hdf5");
    gp_status status;
    if (argc != 2 || gp_config_init(&config, sizeof config, GP_PRESET_DEFAULT) || gp_create(&config, &sim))
        return 1;
    gp_column_init(&column, sizeof column);
    column.width = column.height = 10 * config.spacing;
    column.y_min = config.spacing;
    gp_plate_init(&floor, sizeof floor);
    floor.x0 = 1;
    floor.x1 = -1;
    if (gp_add_plate(sim, &floor, NULL) || gp_add_column(sim, &column, NULL))
        return 2;
    snprintf(path, sizeof path, "%s/consumer.h5", argv[1]);
    status = gp_output_open(sim, path, NULL);
    if (status != (hdf5 ? GP_OK : GP_E_UNSUPPORTED))
        return 3;
    state.struct_size = (uint32_t)sizeof state;
    if (gp_run(sim, 0.05) || gp_get_state(sim, &state) || state.time != 0.05 || state.n_particles != 100)
        return 4;
    if (hdf5 && (gp_output_write(sim) || gp_output_close(sim)))
        return 5;
    printf("granperi %s hdf5=%d openmp=%d: %d steps, highest point %.4f m\n", gp_version_string(), (int)hdf5,
           (int)gp_has_feature("openmp"), (int)state.step, state.peak_height);
    gp_destroy(sim);
    return 0;
}
