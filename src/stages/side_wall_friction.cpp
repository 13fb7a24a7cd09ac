// Coulomb friction of the two side walls of a channel, averaged over its width W: 2 mu_w p / W per volume against the
// velocity (after Jop, Forterre & Pouliquen 2005 and Ionescu et al. 2015). It can hold a particle still, never drive it:
// a particle that the friction stops within the step stands, whatever the rest of the forces is.
#include <cmath>

#include "awake.hpp"
#include "stages/push.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

void side_wall_friction(World &world) {
    Particles &p = world.particles;
    const gp_config &config = world.scene->config();
    const double dt = world.clock.dt;
    const double impulse = 2 * config.channel_friction / config.channel_width * dt; // per pressure
    for_each_awake_block(world, [&](int64_t block, int64_t begin, int64_t end) {
        double loss = 0;
        for (int64_t i = begin; i < end; ++i) {
            const double speed = std::hypot(p.vx[i], p.vy[i]);
            if (speed == 0)
                continue;
            const double density = world.material_of(i).density;
            const double most = impulse * p.pressure[i] / density;
            const double share = most < speed ? most / speed : 1.0;
            loss -= density * push_particle(p, i, -share * p.vx[i], -share * p.vy[i], dt);
        }
        world.sums[block].side_walls = p.volume * loss;
    });
}

} // namespace gp::stages
