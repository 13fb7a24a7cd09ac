/* What a step costs on several processes: the collapse with a = 1.25 in its flow, CPU time per particle and step of the busiest
 * process, what of it is spent in MPI, and what is sent. mpirun -n N mpi [particles over the width [steps]] */
#define _POSIX_C_SOURCE 200809L

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <granperi/gp_mpi.h>

static double cpu(void) {
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* By MPI's profiling interface: what waiting takes of the processor. The clock itself takes 0.5 us a call, 6 % of a step of 640
 * particles on two processes. */
static double in_mpi;
#define TIMED(call)                                                                                                    \
    const double begun = cpu();                                                                                        \
    const int status = call;                                                                                           \
    in_mpi += cpu() - begun;                                                                                           \
    return status
int MPI_Waitany(int n, MPI_Request *requests, int *which, MPI_Status *status_of) {
    TIMED(PMPI_Waitany(n, requests, which, status_of));
}

static void check(gp_status status) {
    if (status < 0) {
        fprintf(stderr, "%s\n", gp_last_error());
        MPI_Abort(MPI_COMM_WORLD, 1);
    }
}

static gp_plan_entry entry_of(gp_sim *sim, const char *name) {
    gp_plan_entry plan[128];
    int64_t n;
    check(gp_get_plan(sim, 128, plan, &n));
    for (int64_t k = 0; k < n && k < 128; ++k)
        if (!strcmp(plan[k].name, name))
            return plan[k];
    memset(plan, 0, sizeof *plan);
    return *plan;
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    int rank, ranks;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    const int resolution = argc > 1 ? atoi(argv[1]) : 64, steps = argc > 2 ? atoi(argv[2]) : 300;
    const int serial = argc > 3; /* by the functions for one process */
    gp_config config;
    gp_column column;
    gp_plate plate;
    gp_sim *sim;
    check(gp_config_init(&config, sizeof config, GP_PRESET_DEFAULT));
    config.spacing = 0.08 / resolution, config.threads = 1;
    check(serial ? gp_create(&config, &sim) : gp_create_mpi(&config, MPI_COMM_WORLD, &sim));
    check(gp_column_init(&column, sizeof column));
    column.x_min = -0.04, column.width = 0.08, column.height = 0.05;
    check(gp_add_column(sim, &column, NULL));
    check(gp_plate_init(&plate, sizeof plate));
    plate.x0 = 1, plate.x1 = -1;
    check(gp_add_plate(sim, &plate, NULL));
    check(gp_run(sim, 0.02));
    const gp_plan_entry before = entry_of(sim, "messages"), reduced = entry_of(sim, "reductions");
    gp_particles own;
    memset(&own, 0, sizeof own);
    own.struct_size = sizeof own;
    MPI_Barrier(MPI_COMM_WORLD);
    const double begun = cpu(), wall = MPI_Wtime(), mpi = in_mpi;
    check(gp_step(sim, steps));
    double spent[3] = {cpu() - begun, in_mpi - mpi, MPI_Wtime() - wall}, work = spent[0] - spent[1], most = work,
           all = work;
    MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    MPI_Allreduce(MPI_IN_PLACE, spent, 3, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    const gp_plan_entry after = entry_of(sim, "messages"), reduced_after = entry_of(sim, "reductions");
    /* Messages and bytes that a process sends in a step: in all, and of the one that sends most. */
    double sent[2] = {(double)(after.calls - before.calls) / steps, (double)(after.bytes - before.bytes) / steps},
           most_sent[2];
    MPI_Allreduce(sent, most_sent, 2, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    MPI_Allreduce(MPI_IN_PLACE, sent, 2, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    check(gp_get_particles(sim, GP_FIELD_ID, &own));
    double n = (double)own.count;
    MPI_Allreduce(MPI_IN_PLACE, &n, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    if (rank == 0)
        printf("particles %.0f ranks %d: outside of MPI %.1f ns/particle-step in all, busiest %.4f s, with MPI %.4f s, "
               "wall %.4f s; per step: "
               "%.2f messages in all, %.2f of one process, %.0f bytes in all, %.0f of one, %.2f reductions\n",
               serial ? n / ranks : n, ranks, 1e9 * all / n / steps, most, spent[0], spent[2], sent[0], most_sent[0],
               sent[1], most_sent[1], (double)(reduced_after.calls - reduced.calls) / steps);
    gp_destroy(sim);
    MPI_Finalize();
    return 0;
}
