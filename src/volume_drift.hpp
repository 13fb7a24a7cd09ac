// Does the flowing material keep its volume? Told from the positions alone: the density may be that of the start while the
// particles come ever closer.
#pragma once

#include "world.hpp"

namespace gp {

// Mean number density (sum of the weight over neighbours within the horizon, ghosts included) of particles about which
// the horizon is full, so that free surfaces have no part in it.
struct Packing {
    double number_density = 0; // 0: there are none
    int64_t particles = 0;
};
enum class Part { all, flowing }; // flowing: at yield under pressure
Packing measure_packing(const World &world, Part part);

// gp_state.volume_drift.
double volume_drift(const World &world);

} // namespace gp
