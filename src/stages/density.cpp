#include "awake.hpp"
#include "material/compression.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

// Share of a step's expansion e = dt div u that Euler's factor 1 - e follows. Beyond, where particles fly apart from on top
// of each other (the step bounds their motion by a quarter spacing, not by their distance), 1 / (4 e) goes on with the same
// value and slope: it stays positive, as the exact exp(-e) does. A deposit's steps expand by a hundredth.
constexpr double largest_expansion = 0.5;

// What is left of the compression of a grain in flight after a step: it springs back at the speed of sound, at once when it
// carries nothing. A grain that kept it stayed on the floor's springs while it flew: three grains that fell by 5 dl left
// with four times the energy of their fall.
double left_in_flight(double carried, double acoustic_steps) {
    return carried > 0 ? 1.0 / (1.0 + (1.0 / carried - 1.0) * acoustic_steps) : 0.0;
}

} // namespace

void density(World &world) {
    Particles &p = world.particles;
    const double dt = world.clock.dt;
    const double c2 = world.constants.sound_speed * world.constants.sound_speed;
    const double acoustic_steps = world.constants.sound_speed * dt / world.constants.spacing;
    const bool flights = !p.carried.empty();
    for_each_awake_block(world, [&](int64_t block, int64_t begin, int64_t end) {
        double densest = 0, released = 0; // J/m3
        bool unbounded = false;
        for (int64_t i = begin; i < end; ++i) {
            // The density goes on evolving where the material is stretched, so that it reconnects at the right moment.
            const double before = p.density[i], divergence = p.lxx[i] + p.lyy[i];
            p.density[i] -= before * divergence * dt;
            if (divergence * dt > largest_expansion)
                p.density[i] = before / (4 * divergence * dt);
            const double own = world.material_of(i).density;
            const bool in_flight = flights && p.carried[i] < 1;
            if (in_flight && p.density[i] > own)
                p.density[i] = own + left_in_flight(p.carried[i], acoustic_steps) * (p.density[i] - own);
            p.pressure[i] = pressure_of(p.density[i], own, c2);
            if (in_flight) { // what the stress of this step takes, less what is stored
                const double modulus = world.material_of(i).bulk_modulus;
                const double change =
                    compression_energy(p.density[i] / own, modulus) - compression_energy(before / own, modulus);
                released -= p.pressure[i] * divergence * dt + change;
            }
            const double ratio = p.density[i] / own;
            densest = ratio > densest ? ratio : densest;
            unbounded |= !is_bounded_density(ratio);
        }
        world.sums[block].released = p.volume * released;
        world.sums[block].densest = densest;
        world.sums[block].unbounded = unbounded;
    });
    if (flights)
        hand_over(p.carried, p.cyy);
}

} // namespace gp::stages
