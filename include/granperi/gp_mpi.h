/* granperi on several processes: library granperi-mpi (pkg-config granperi-mpi, CMake component mpi), which has all that
 * granperi/gp.h declares and these two. A program links it in place of granperi, not beside it.
 *
 * A simulation of gp_create_mpi or gp_load_mpi belongs to all processes of the communicator: each has a part of the particles. All
 * of them make the same gp_ calls, in the same order and with the same arguments, but for
 *   gp_add_particles   each process adds its own, n may be 0; ids go on from process to process;
 *   gp_get_particles   each process sees those that it works on, which change whenever neighbour lists are made;
 *   gp_copy_field      the first process gets all, in the order of id; the others pass NULL and n = 0;
 *   gp_set_log         messages come on the first process; those about a running flow (gp_set_log) do not come;
 *   callbacks          are called on each process, and have to return the same everywhere.
 * States, loads, surfaces and interfaces are those of the whole, on every process; for them and for frames the first process needs
 * about 100 bytes for each particle of the whole. No process ever has all particles: each lays its part of the columns (those of
 * gp_add_particles every process keeps as they were added, 32 bytes each) and reads its part of a checkpoint; for gp_save they come
 * to the first process some at a time. gp_set_gravity passes all particles to it twice, as two states do. Files are written by the
 * first process, in the layout of a process alone: either goes on from the other's, on any number of processes.
 *
 * Positions, velocities, stresses, loads and the clock are the same bits on any number of processes and threads; the energies
 * of gp_state that are summed up in the course of a run are the same but for rounding.
 *
 * Errors come everywhere in the same call, with one status and one text. That of one process alone, out of memory for instance, is
 * named, "rank 2: out of memory"; it is the end of this simulation, whose later calls say the same, but not of the program: others
 * can be made. Work that the first process does alone for all, in gp_save, frames, states, surfaces and gp_set_gravity, is an
 * exception: what it meets there ends the call, and leaves the simulation as it was; gp_step(sim, 0) says which it is. In the
 * middle of a step any error but GP_E_DIVERGED is the end. The calls that only read what is here (gp_get_particles,
 * gp_get_plate_load, gp_get_plan, gp_get_clock) fail here alone, and do no harm; before the first step all but gp_get_clock are
 * made by all, as the others. gp_set_callback, gp_set_log and gp_get_clock are possible after the end. Memory that MPI or Zoltan
 * lack themselves is beyond this library, and so is room for a message on its way when another process failed: MPI_Abort.
 * The paper's schemes are GP_E_UNSUPPORTED. With gp_config.sleep = 1 a process has whole spans of 16 spacings (gp_step, "Sleep"). */
#ifndef GRANPERI_GP_MPI_H
#define GRANPERI_GP_MPI_H

#include <mpi.h>

#include "gp.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Collective, as gp_create. MPI has been initialised, with MPI_THREAD_FUNNELED for gp_config.threads other than 1, and not yet
 * finalised, else GP_E_STATE. It may be finalised before gp_destroy, which then only frees memory here. The communicator is copied;
 * MPI_COMM_NULL is GP_E_ARGUMENT. */
GP_API gp_status gp_create_mpi(const gp_config *config, MPI_Comm comm, gp_sim **sim);

/* Collective, as gp_load: of a checkpoint by any number of processes, which every process can read; MPI and the communicator as for
 * gp_create_mpi, with the threads that the checkpoint has. Where HDF5 is not thread-safe, it is not called by two threads at once, for two
 * communicators. */
GP_API gp_status gp_load_mpi(const char *path, MPI_Comm comm, gp_sim **sim);

#ifdef __cplusplus
}
#endif

#endif
