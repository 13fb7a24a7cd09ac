// The one name by which an engine out of several is known outside: CMakeLists.txt compiles this with each of them, with its own
// GP_LEVEL_TABLE, and makes all other names of it local.
#include "level.hpp"
#include "levels/entries.hpp"

extern "C" const gp::Entries GP_LEVEL_TABLE;
// Known when it is compiled: nothing of an engine runs before the processor has been asked.
extern "C" constexpr gp::Entries GP_LEVEL_TABLE = {
    gp::level_name,
#define GP_CALL(result, name, parameters, arguments) name,
#include "levels/calls.inc"
#ifdef GP_WITH_MPI
#include "levels/mpi_calls.inc"
#endif
#undef GP_CALL
};
