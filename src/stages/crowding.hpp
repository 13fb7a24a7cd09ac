// How crowded what flows is: more than its density knows, as if no free surface were near. Collisions go by it, and by whether it
// flows at all (collide.cpp).
//
// What N lacks for the surface follows from sum w r. The force sums that for its own sake, over the same neighbours as the
// gradient N, so it is finished there: with two sums more the gradient took 1.08 to 1.1 times as long.
#pragma once

#include "lanes.hpp"
#include "world.hpp"

namespace gp::stages {

// Of the squared first moment in the row at a free surface: below it is taken to be that of disorder, about a hundredth in the
// middle of sheared layers.
constexpr double moment_of_disorder = 0.04;

// Crowding of what does not flow: it is inside its yield surface.
constexpr float does_not_flow = -1e30F;

struct CrowdingView {
    const double *spaced, *known; // Particles
    float *crowded;               // World; NULL: no collisions ask for it
    double inverse_number, inverse_surface_moment2, lack;

    explicit CrowdingView(World &world)
        : spaced(world.particles.spaced.data()), known(world.particles.known.data()),
          crowded(world.crowded.empty() ? nullptr : world.crowded.data()),
          inverse_number(1.0 / world.constants.lattice.number_density),
          inverse_surface_moment2(1.0 /
                                  (world.constants.lattice.surface_moment * world.constants.lattice.surface_moment)),
          lack(world.constants.lattice.surface_lack / (1 - moment_of_disorder)) {}

    // What N lacks for a free surface within the horizon: the neighbours that are left lie to one side. By the square of the first
    // moment (x, y) this is exact in the row at the surface; on the lattice of a horizon of 4 the first three rows, with .634, .908
    // and .991 of N0, get 1, .957 and .991. It is 0 in the middle of the material, and too little at corners.
    GP_INLINE Lanes lack_of(const Lanes &x, const Lanes &y) const {
        const Lanes share = (x * x + y * y) * inverse_surface_moment2 - moment_of_disorder;
        return where(share > 0.0, lack * share);
    }

    GP_INLINE void finish(const LanePlaces &places, int64_t last, const Lanes &x, const Lanes &y) const {
        const Lanes n = places.load(spaced), dense = places.load(known), lacking = lack_of(x, y);
        for (int64_t i = places.at[0]; i < last; ++i) {
            const auto l = static_cast<int>(i - places.at[0]);
            const auto missing = static_cast<float>(lacking[l]);
            crowded[i] = static_cast<float>(n[l] > 0 ? n[l] + inverse_number * missing - dense[l] : does_not_flow);
        }
    }
};

} // namespace gp::stages
