#include "parallel.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

void density(World &world) {
    Particles &p = world.particles;
    const double dt = world.clock.dt;
    const double c2 = world.constants.sound_speed * world.constants.sound_speed;
    for_each_block(world.threads, p.count, [&](int64_t block, int64_t begin, int64_t end) {
        double densest = 0;
        bool unbounded = false;
        for (int64_t i = begin; i < end; ++i) {
            // The density goes on evolving where the material is stretched, so that it reconnects at the right moment.
            p.density[i] -= p.density[i] * (p.lxx[i] + p.lyy[i]) * dt;
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
