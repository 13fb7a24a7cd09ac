/* A step of one particle above nothing, on however many processes it is run. */
#include <granperi/gp_mpi.h>

#include <stdio.h>

int main(int argc, char **argv) {
    gp_config config;
    gp_sim *sim = NULL;
    const double x = 0, y = 0, still = 0;
    double time = 0;
    int wrong;
    MPI_Init(&argc, &argv);
    wrong = gp_has_feature("mpi") != 1 || gp_config_init(&config, sizeof config, GP_PRESET_DEFAULT) != GP_OK ||
            gp_create_mpi(&config, MPI_COMM_WORLD, &sim) != GP_OK ||
            gp_add_particles(sim, 0, 1, &x, &y, &still, &still, NULL) != GP_OK || gp_step(sim, 1) != GP_OK ||
            gp_get_clock(sim, &time, NULL, NULL) != GP_OK || !(time > 0);
    if (wrong)
        fprintf(stderr, "%s\n", gp_last_error());
    gp_destroy(sim);
    MPI_Finalize();
    return wrong;
}
