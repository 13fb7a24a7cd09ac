// Which particles flow: at yield, or without stress. What ties their densities to each other and to their spacing acts on
// these alone, so that it does nothing in material at rest.
//
// With the granular fluidity there is no yield surface: how much it flows goes by the rate at which it yields. It flows with
// all its weight where it shears as fast as the local law's flows do, and the weight falls off with the root of the rate (a
// pair's is the product of both), so that at rest nothing is tied.
#include <cmath>

#include "awake.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

// c0 / dl, at which the weight of a pair is half. From 1e-5 to 1e-2 the slow cell's stress is 48.79 Pa, its velocities differ by
// .0001 of the lid's, the jittered collapse is at rest by .34 to .36 s with less than 1e-8 of its energy at 2 s, and moves by less
// than 4e-4 of its height and width from then to 6 s.
constexpr double half_rate = 1e-3;

double weight_of_flow(const World &world, int64_t i, double stress) {
    const Particles &p = world.particles;
    if (p.pressure[i] <= 0)
        return 1;
    const double rate = p.fluidity[i] * stress / p.pressure[i];
    return std::sqrt(rate / (rate + half_rate * world.constants.sound_speed / world.constants.spacing));
}

template <bool Fluid> void find_flowing(World &world) {
    Particles &p = world.particles;
    make_for_neighbors(world, {&p.flowing}, [&](int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) {
            const double stress = equivalent_stress({p.sxx[i], p.sxy[i]});
            if (Fluid && world.is_fluid(i))
                p.flowing[i] = weight_of_flow(world, i, stress);
            else
                p.flowing[i] = world.map_of(i).at_yield(stress, p.pressure[i]) ? 1.0 : 0.0;
        }
    });
}

} // namespace

void flowing(World &world) {
    hand_over(world.particles.ax, world.particles.flowing);
    if (world.constants.fluid)
        find_flowing<true>(world);
    else
        find_flowing<false>(world);
}

} // namespace gp::stages
