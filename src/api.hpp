// What the calls of gp.h have in common, beside handle.hpp: api.cpp has those that make, change and save a simulation,
// api_read.cpp those that read it.
#pragma once

#include "handle.hpp"

namespace gp {

inline void require_simulation(const gp_sim *handle) {
    if (!handle)
        throw make_error(GP_E_ARGUMENT,
                         "sim = NULL: expected a simulation of gp_create or gp_load; has that call failed?");
}

inline Sim &readable(gp_sim *handle) {
    require_simulation(handle);
    handle->sim.prepare();
    return handle->sim;
}

} // namespace gp
