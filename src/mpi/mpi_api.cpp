// The extern "C" file of gp_mpi.h.
#include "granperi/gp_mpi.h"

#include "handle.hpp"
#include "io/checkpoint.hpp"
#include "level.hpp"
#include "mpi/mpi_crossing.hpp"
#include "scene.hpp"

namespace gp {

const bool has_mpi = true;

namespace {

void require_communicator(MPI_Comm comm) {
    int begun = 0, ended = 0;
    MPI_Initialized(&begun);
    MPI_Finalized(&ended);
    if (!begun || ended)
        throw make_error(GP_E_STATE, "MPI %s: expected a call between MPI_Init and MPI_Finalize",
                         begun ? "has been finalised" : "has not been initialised");
    if (comm == MPI_COMM_NULL)
        throw make_error(GP_E_ARGUMENT, "comm = MPI_COMM_NULL: expected a communicator");
}

// The threads of a simulation compute beside the one that calls MPI.
void require_funneled(const gp_config &config) {
    int provided = MPI_THREAD_SINGLE;
    MPI_Query_thread(&provided);
    if (config.threads != 1 && provided < MPI_THREAD_FUNNELED)
        throw make_error(GP_E_STATE,
                         "gp_config.threads = %d: expected 1, or MPI begun by MPI_Init_thread with at least "
                         "MPI_THREAD_FUNNELED",
                         config.threads);
}

// make(crossing) on all; where one of them cannot, none has a simulation.
template <class Make> gp_status make_together(MPI_Comm comm, gp_sim **sim, const Make &make) {
    return guard([&] {
        require_pointer("sim", sim);
        *sim = nullptr;
        require_communicator(comm);
        const auto crossing = mpi::MpiCrossing::between_all_of(comm);
        std::unique_ptr<gp_sim> made;
        together(crossing.get(), [&] {
            made = make(crossing);
            return GP_OK;
        });
        *sim = made.release();
        return GP_OK;
    });
}

} // namespace
} // namespace gp

extern "C" {

gp_status gp_create_mpi(const gp_config *config, MPI_Comm comm, gp_sim **sim) {
    using namespace gp;
    return make_together(comm, sim, [&](const std::shared_ptr<mpi::MpiCrossing> &crossing) {
        require_level();
        const gp_config whole = complete_config(config);
        auto made = std::make_unique<gp_sim>(whole, crossing); // with what is wrong in the config itself told first
        require_funneled(whole);
        return made;
    });
}

gp_status gp_load_mpi(const char *path, MPI_Comm comm, gp_sim **sim) {
    using namespace gp;
    return make_together(comm, sim, [&](const std::shared_ptr<mpi::MpiCrossing> &crossing) {
        require_pointer("path", path);
        require_level();
        std::unique_ptr<gp_sim> loaded;
        const auto create = [&](const gp_config &config) -> Sim & {
            loaded = std::make_unique<gp_sim>(config, crossing);
            return loaded->sim;
        };
        io::OutputPosition left_off;
        io::load_checkpoint(path, crossing.get(), create, left_off);
        require_funneled(loaded->sim.scene().config()); // not in create, whose errors are those of a damaged file
        loaded->left_off = std::move(left_off);
        return loaded;
    });
}

} // extern "C"
