#include "parallel.hpp"
#include "stages/rows.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

// As the stage `stress` without its deviator, which the implicit solve finds.
void pressure_over_shape(World &world) {
    Particles &p = world.particles;
    const double dt = world.clock.dt;
    const bool penalty = world.constants.penalty > 0;
    const double kinematic_viscosity =
        world.scene->config().bulk_viscosity * world.constants.sound_speed * world.constants.spacing;
    for_each_block(world.threads, p.count, [&](int64_t block, int64_t begin, int64_t end) {
        double internal = 0, damped = 0;
        for (int64_t i = begin; i < end; ++i) {
            const double pressure = p.pressure[i], divergence = p.lxx[i] + p.lyy[i];
            const double viscous = -kinematic_viscosity * world.material_of(i).density * divergence;
            const double bulk = pressure > 0 ? (viscous > -pressure ? viscous : -pressure) : 0.0;
            const double total = pressure + bulk;
            damped -= bulk * divergence;
            internal -= total * divergence;
            Tensor drag = Tensor::Zero();
            if (penalty) {
                p.stressed[i] = pressure > 0 ? 1.0 : 0.0;
                drag = 0.5 * world.constants.penalty * p.stressed[i] * inner_gradient(world, i);
            }
            p.cxx[i] = -total * p.gxx[i] - drag(0, 0);
            p.cxy[i] = -total * p.gxy[i] - drag(0, 1);
            p.cyx[i] = -total * p.gxy[i] - drag(1, 0);
            p.cyy[i] = -total * p.gyy[i] - drag(1, 1);
        }
        world.sums[block].bulk = p.volume * damped * dt;
        world.sums[block].internal_power = p.volume * internal;
    });
    if (penalty)
        world.images.copy({&p.cxx, &p.cxy, &p.cyx, &p.cyy, &p.pressure, &p.density, &p.stressed});
    else
        world.images.copy({&p.cxx, &p.cxy, &p.cyx, &p.cyy, &p.pressure, &p.density});
}

} // namespace gp::stages
