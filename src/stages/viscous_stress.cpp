// The regularised law's stress (Jin et al. 2021, 3.6 and 3.12), from the pressure and the velocity gradient as they are.
//
// D is the whole tensor, as printed. Of its deviator alone the collapse with a = 1.25, L/dl = 32, factor 2 leaves nearly
// the same peak at .42 s (y/L .503 for .505) and creeps less (.481 for .462 at 1 s), but with pressures up to 4.0 rho g H
// for 2.3.
#include "parallel.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

// With force states also sigma K^-1, what a neighbour needs of a particle (3.10).
template <bool ForceStates> void stress_rows(World &world, int64_t block, int64_t begin, int64_t end) {
    Particles &p = world.particles;
    double dissipation = 0;
    for (int64_t i = begin; i < end; ++i) {
        const Symmetric d{p.lxx[i], 0.5 * (p.lxy[i] + p.lyx[i]), p.lyy[i]};
        const Symmetric tau = world.material_of(i).law.stress(d, p.pressure[i]);
        p.sxx[i] = tau.xx;
        p.sxy[i] = tau.xy;
        p.syy[i] = tau.yy;
        dissipation += contract(tau, d);
        if (ForceStates) {
            const double axx = tau.xx - p.pressure[i], ayy = tau.yy - p.pressure[i];
            p.cxx[i] = axx * p.gxx[i] + tau.xy * p.gxy[i];
            p.cxy[i] = axx * p.gxy[i] + tau.xy * p.gyy[i];
            p.cyx[i] = tau.xy * p.gxx[i] + ayy * p.gxy[i];
            p.cyy[i] = tau.xy * p.gxy[i] + ayy * p.gyy[i];
        }
    }
    world.sums[block].plastic = p.volume * dissipation * world.clock.dt;
}

} // namespace

void viscous_stress(World &world) {
    for_each_block(world.threads, world.particles.count,
                   [&](int64_t block, int64_t begin, int64_t end) { stress_rows<false>(world, block, begin, end); });
    Particles &p = world.particles;
    world.images.copy({&p.sxx, &p.sxy, &p.syy});
}

void viscous_stress_over_shape(World &world) {
    for_each_block(world.threads, world.particles.count,
                   [&](int64_t block, int64_t begin, int64_t end) { stress_rows<true>(world, block, begin, end); });
    Particles &p = world.particles;
    world.images.copy({&p.cxx, &p.cxy, &p.cyx, &p.cyy});
}

} // namespace gp::stages
