// The interface as one engine out of several has it.
#pragma once

#include "granperi/gp.h"

namespace gp {

struct Entries {
    const char *level; // level_name
#define GP_CALL(result, name, parameters, arguments) result(*name) parameters;
#include "levels/calls.inc"
#undef GP_CALL
};

} // namespace gp
