#include "parallel.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

// Share of a step's expansion e = dt div u that Euler's factor 1 - e follows. Beyond, where particles fly apart from on top
// of each other (the step bounds their motion by a quarter spacing, not by their distance), 1 / (4 e) goes on with the same
// value and slope: it stays positive, as the exact exp(-e) does. A deposit's steps expand by a hundredth.
constexpr double largest_expansion = 0.5;

} // namespace

void density(World &world) {
    Particles &p = world.particles;
    const double dt = world.clock.dt;
    const double c2 = world.constants.sound_speed * world.constants.sound_speed;
    for_each_block(world.threads, p.count, [&](int64_t block, int64_t begin, int64_t end) {
        double densest = 0;
        bool unbounded = false;
        for (int64_t i = begin; i < end; ++i) {
            // The density goes on evolving where the material is stretched, so that it reconnects at the right moment.
            const double before = p.density[i], divergence = p.lxx[i] + p.lyy[i];
            p.density[i] -= before * divergence * dt;
            if (divergence * dt > largest_expansion)
                p.density[i] = before / (4 * divergence * dt);
            const double own = world.material_of(i).density, pressure = c2 * (p.density[i] - own);
            p.pressure[i] = pressure > 0 ? pressure : 0.0;
            const double ratio = p.density[i] / own;
            densest = ratio > densest ? ratio : densest;
            unbounded |= !is_bounded_density(ratio);
        }
        world.sums[block].densest = densest;
        world.sums[block].unbounded = unbounded;
    });
}

} // namespace gp::stages
