/* What the first step, a state, a frame, a checkpoint saved and one loaded take of the first process's memory: mpirun -n 2 memory
 * PARTICLES [FRAME CHECKPOINT] prints the bytes of these, beyond what it holds; of what is loaded all. FRAME, CHECKPOINT: files.
 * Status 77 where the system does not tell. */
#include <malloc.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <granperi/gp_mpi.h>

static void check(gp_status status) {
    if (status < 0) {
        fprintf(stderr, "memory: %s\n", gp_last_error());
        MPI_Abort(MPI_COMM_WORLD, 2);
    }
}

/* Bytes, of a line of /proc/self/status; -1: there is none. */
static double told(const char *name) {
    char line[256];
    double bytes = -1;
    FILE *file = fopen("/proc/self/status", "r");
    while (file && fgets(line, sizeof line, file))
        if (!strncmp(line, name, strlen(name)))
            bytes = 1024 * atof(line + strlen(name));
    if (file)
        fclose(file);
    return bytes;
}

/* From here on the peak is that of what follows. */
static int begin(void) {
    malloc_trim(0);
    FILE *file = fopen("/proc/self/clear_refs", "w");
    if (!file)
        return 0;
    const int good = fputs("5", file) >= 0;
    return fclose(file) == 0 && good;
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    int rank;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    gp_config config;
    gp_column column;
    gp_plate plate;
    gp_sim *sim;
    check(gp_config_init(&config, sizeof config, GP_PRESET_DEFAULT));
    check(gp_column_init(&column, sizeof column));
    check(gp_plate_init(&plate, sizeof plate));
    config.threads = 1, config.spacing = 1 / sqrt(atof(argv[1]));
    column.width = column.height = 1;
    plate.x0 = 2, plate.x1 = -2;
    check(gp_create_mpi(&config, MPI_COMM_WORLD, &sim));
    check(gp_add_column(sim, &column, NULL));
    check(gp_add_plate(sim, &plate, NULL));
    int known = begin() && told("VmRSS:") > 0 && told("VmHWM:") > 0;
    double held = told("VmRSS:");
    check(gp_step(sim, 1));
    const double of_start = told("VmHWM:") - held;

    known = known && begin();
    held = told("VmRSS:");
    gp_state state;
    memset(&state, 0, sizeof state);
    state.struct_size = sizeof state;
    check(gp_get_state(sim, &state));
    const double of_state = told("VmHWM:") - held;
    double of_frame = 0, of_save = 0, of_load = 0;
    if (argc > 2) {
        gp_output output;
        check(gp_output_init(&output, sizeof output));
        output.compression = 0;
        check(gp_output_open(sim, argv[2], &output));
        check(gp_step(sim, 1));
        known = known && begin();
        held = told("VmRSS:");
        check(gp_output_write(sim));
        of_frame = told("VmHWM:") - held;
        check(gp_output_close(sim));
    }
    if (argc > 3) {
        known = known && begin();
        held = told("VmRSS:");
        double seconds = MPI_Wtime();
        check(gp_save(sim, argv[3]));
        of_save = told("VmHWM:") - held;
        fprintf(stderr, "rank %d: saved in %.2f s\n", rank, MPI_Wtime() - seconds);
        gp_destroy(sim);
        known = known && begin();
        held = told("VmRSS:");
        seconds = MPI_Wtime();
        check(gp_load_mpi(argv[3], MPI_COMM_WORLD, &sim));
        of_load = told("VmHWM:") - held;
        fprintf(stderr, "rank %d: loaded in %.2f s\n", rank, MPI_Wtime() - seconds);
    }
    if (rank == 0 && known)
        printf("%.0f %.0f %.0f %.0f %.0f\n", of_start, of_state, of_frame, of_save, of_load);
    gp_destroy(sim);
    MPI_Finalize();
    return known ? 0 : 77;
}
