// Which particles flow: at yield, or without stress. What ties their densities to each other and to their spacing acts on
// these alone, so that it does nothing in material at rest.
#include "parallel.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

void flowing(World &world) {
    Particles &p = world.particles;
    for_each_block(world.threads, p.count, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) {
            const double stress = equivalent_stress({p.sxx[i], p.sxy[i]});
            p.flowing[i] = world.map_of(i).at_yield(stress, p.pressure[i]) ? 1.0 : 0.0;
        }
    });
}

} // namespace gp::stages
