#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "parallel.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

// Stops before a non-finite acceleration reaches velocities and positions.
void require_finite_accelerations(const World &world) {
    double sum = 0;
    for (const BlockSums &block : world.sums)
        sum += block.acceleration2;
    if (std::isfinite(sum))
        return;
    const Particles &p = world.particles;
    for (int64_t i = 0; i < p.count; ++i)
        if (!std::isfinite(p.ax[i] * p.ax[i] + p.ay[i] * p.ay[i]))
            throw make_error(GP_E_DIVERGED,
                             "forces: acceleration (%g, %g) m/s2 of particle %lld at (%g, %g) m, time %g s, step %lld",
                             p.ax[i], p.ay[i], static_cast<long long>(p.id[i]), p.x[i], p.y[i], world.clock.time,
                             static_cast<long long>(world.clock.step));
    throw make_error(GP_E_DIVERGED, "forces: accelerations too large to sum, time %g s, step %lld", world.clock.time,
                     static_cast<long long>(world.clock.step));
}

void integrate(World &world) {
    require_finite_accelerations(world);
    Particles &p = world.particles;
    const double dt = world.clock.dt;
    for_each_block(world.threads, p.count, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) {
            p.vx[i] += dt * p.ax[i];
            p.vy[i] += dt * p.ay[i];
            p.x[i] += dt * p.vx[i];
            p.y[i] += dt * p.vy[i];
            p.push_x[i] = p.push_y[i] = 0;
        }
    });
}

} // namespace gp::stages
