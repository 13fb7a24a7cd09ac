// The law of friction at a wall: |T| <= mu N of the plate's force on each particle, mu that of the plate or of the material at
// the plate's surface, whichever is less. What ghosts carry across the surface is pressure and velocity, no shear.
#pragma once

#include <algorithm>
#include <cmath>

#include "world.hpp"

namespace gp::stages {

// Mean shear rate, 1/s, between a plate's surface and a particle that slips along it.
inline double rate_at_wall(const Segment &s, const Vector &at, double slip, double spacing) {
    return slip / std::max(s.distance(at), contact_distance * spacing);
}

// A rough plate is as rough as the material; another has its own friction, where the material can bear it.
inline double wall_friction_bound(const PlateSpec &plate, double material) {
    return plate.friction == GP_WALL_NO_SLIP ? material : std::min(plate.wall_mu, material);
}

} // namespace gp::stages
