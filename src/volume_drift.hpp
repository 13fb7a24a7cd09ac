// Does the flowing material keep its volume? Told from the positions alone: the density may be that of the start while the
// particles come ever closer.
#pragma once

#include "world.hpp"

namespace gp {

// Mean number density within the horizon, ghosts included, of particles about which the horizon is full: free surfaces have
// no part in it.
struct Packing {
    double number_density = 0; // in the measure of volume_drift.cpp
    double density = 0;        // over the material's own; of a part of a world it is not known
    int64_t particles = 0;     // that these are the means of
};
enum class Part { all, flowing }; // flowing: at yield under pressure, and shearing
Packing measure_packing(const World &world, Part part);

double packing_of_lattice(double radius, double spacing);

// gp_state.volume_drift.
double drift_of(const World &world, const Packing &flowing);

} // namespace gp
