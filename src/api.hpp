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

// Of several processes each reads what it has by itself, once they have prepared it.
inline Sim &readable(gp_sim *handle) {
    require_simulation(handle);
    Sim &sim = handle->sim;
    if (sim.crossing())
        sim.crossing()->require_going();
    if (!sim.is_prepared())
        together(sim.crossing(), [&] {
            sim.prepare();
            return GP_OK;
        });
    return sim;
}

// guard for what all of several processes do together.
template <class Body> gp_status guard_together(gp_sim *handle, const Body &body) noexcept {
    return guard([&] {
        require_simulation(handle);
        return together(handle->sim.crossing(), body);
    });
}

} // namespace gp
