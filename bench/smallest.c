/* The smallest program: a block on a floor, one step. bench/performance/builds.py measures how long it takes to start. */
#include <granperi/gp.h>

int main(void) {
    gp_config config;
    gp_column column;
    gp_plate ground;
    gp_sim *sim;
    gp_status status = gp_config_init(&config, sizeof config, GP_PRESET_DEFAULT);
    config.sound_speed = 10;
    config.threads = 1;
    if (status < 0 || gp_create(&config, &sim) < 0)
        return 1;
    gp_column_init(&column, sizeof column);
    column.width = column.height = 4 * config.spacing;
    gp_plate_init(&ground, sizeof ground);
    ground.x0 = 1;
    ground.x1 = -1;
    if (gp_add_column(sim, &column, NULL) < 0 || gp_add_plate(sim, &ground, NULL) < 0 || gp_step(sim, 1) < 0)
        return 1;
    gp_destroy(sim);
    return 0;
}
