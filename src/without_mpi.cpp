// In the library for one process; in the other one src/mpi/mpi_api.cpp has this.
#include "level.hpp"

namespace gp {

const bool has_mpi = false;

} // namespace gp
