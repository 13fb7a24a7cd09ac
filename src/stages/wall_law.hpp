// The law of friction at a wall: |T| <= mu N of the plate's force on each particle, mu that of the plate or of the material at
// the plate's surface, whichever is less. What ghosts carry across the surface is pressure and velocity, no shear.
#pragma once

#include <algorithm>

#include "world.hpp"

namespace gp::stages {

// Mean shear rate between a plate's surface and a particle that slips along it, over the slip, 1/m.
inline double rate_per_slip(const Segment &s, const Vector &at, double spacing) {
    return 1.0 / std::max(s.distance(at), contact_distance * spacing);
}

// The rate at the plate's surface as a linear function of a particle's slip, 1/s: at = slope * slip + inside.
struct SurfaceRate {
    double slope, inside;
};

// mu(I) of the rate that is left after the friction of `per_mu` (m/s) for each unit of mu has taken what it can of the slip: the
// root of
//   rate = slope (slip - per_mu mu(rate)) + inside.
// By the rate before the step large grains, which go from mu_s to mu_2 with the least motion, were held and let go by turns.
// half: of the material under the particle's pressure (ReturnMap::half_rate).
inline double friction_left(const ReturnMap &law, double half, const SurfaceRate &rate, double slip, double per_mu) {
    const double free = rate.slope * slip + rate.inside, held = rate.slope * per_mu;
    const double c = half * (held * law.mu_s - free);
    if (c >= 0) // mu_s stops it
        return law.mu_s;
    const double b = half - free + held * law.mu_2;
    const double discriminant = root(b * b - 4 * c);
    return law.friction(b > 0 ? -2 * c / (b + discriminant) : 0.5 * (discriminant - b), half);
}

// The same with the granular fluidity: of uniform shear stress between plate and particle it is the mean rate over the mean
// fluidity there, up to mu_2; where that is 0, all slip is held. (By the rate at the surface over the fluidity of each particle,
// which is less further in, a slow plate dragged with 4 % too much; with the fluidity of the first row for all, it slipped.)
inline double fluid_friction_left(const ReturnMap &law, double fluidity, const SurfaceRate &rate, double slip,
                                  double per_mu) {
    const double mu = (rate.slope * slip + rate.inside) / (fluidity + rate.slope * per_mu);
    return std::clamp(mu, 0.0, law.mu_2);
}

// A rough plate is as rough as the material; another has its own friction, where the material can bear it.
inline double wall_friction_bound(const PlateSpec &plate, double material) {
    return plate.friction == GP_WALL_NO_SLIP ? material : std::min(plate.wall_mu, material);
}

} // namespace gp::stages
