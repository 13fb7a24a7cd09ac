// The interface as one engine out of several has it.
#pragma once

#ifdef GP_WITH_MPI
#include "granperi/gp_mpi.h"
#else
#include "granperi/gp.h"
#endif

namespace gp {

struct Entries {
    const char *level; // level_name
// NOLINTNEXTLINE(bugprone-macro-parentheses): a type and a list of parameters take none
#define GP_CALL(result, name, parameters, arguments) result(*name) parameters;
#include "levels/calls.inc"
#ifdef GP_WITH_MPI
#include "levels/mpi_calls.inc"
#endif
#undef GP_CALL
};

} // namespace gp
