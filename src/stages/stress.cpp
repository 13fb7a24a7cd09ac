#include "parallel.hpp"
#include "stages/rows.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

template <bool Penalty> void stress_rows(World &world, int64_t block, int64_t begin, int64_t end) {
    Particles &p = world.particles;
    const double dt = world.clock.dt;
    const double half_penalty = 0.5 * world.constants.penalty;
    const double kinematic_viscosity =
        world.scene->config().bulk_viscosity * world.constants.sound_speed * world.constants.spacing;
    double plastic = 0, internal = 0, damped = 0;
    for (int64_t i = begin; i < end; ++i) {
        const ReturnMap &map = world.map_of(i);
        const double lxx = p.lxx[i], lxy = p.lxy[i], lyx = p.lyx[i], lyy = p.lyy[i];
        const double pressure = p.pressure[i];
        const double dxx = 0.5 * (lxx - lyy), dxy = 0.5 * (lxy + lyx); // deviator of D
        const Deviator before = rotate({p.sxx[i], p.sxy[i]}, 0.5 * (lxy - lyx), dt);
        const double stiff = 2.0 * map.shear_modulus;
        const Deviator trial{before.xx + stiff * dt * dxx, before.xy + stiff * dt * dxy};
        const double shrink = map.shrink(equivalent_stress(trial), pressure, dt);
        const Deviator after{shrink * trial.xx, shrink * trial.xy};
        p.sxx[i] = after.xx;
        p.sxy[i] = after.xy;

        // Mean stress of the step times plastic strain (s_trial - s) / 2G; s:e = 2 (s_xx e_xx + s_xy e_xy).
        plastic +=
            ((before.xx + after.xx) * (trial.xx - after.xx) + (before.xy + after.xy) * (trial.xy - after.xy)) / stiff;

        // What friction does not damp: volume changes under pressure, and shear inside the yield surface, where the
        // material is elastic. Together with the pressure the first never pulls; the second never takes the stress out of
        // the yield surface. Neither acts on a material at rest.
        const double divergence = lxx + lyy;
        const double viscosity = kinematic_viscosity * world.material_of(i).density;
        const double viscous = -viscosity * divergence;
        const double bulk = pressure > 0 ? (viscous > -pressure ? viscous : -pressure) : 0.0;
        const Deviator drag{2.0 * viscosity * dxx, 2.0 * viscosity * dxy};
        const Deviator total{after.xx + drag.xx, after.xy + drag.xy};
        const bool elastic = shrink == 1.0 && equivalent_stress(total) <= map.mu_s * pressure;
        const Deviator s = elastic ? total : after;
        damped += (elastic ? 2.0 * (drag.xx * dxx + drag.xy * dxy) : 0.0) - bulk * divergence;
        internal += 2.0 * (s.xx * dxx + s.xy * dxy) - (pressure + bulk) * divergence;

        const double axx = s.xx - pressure - bulk, ayy = -s.xx - pressure - bulk, axy = s.xy;
        double cxx = axx * p.gxx[i] + axy * p.gxy[i];
        double cxy = axx * p.gxy[i] + axy * p.gyy[i];
        double cyx = axy * p.gxx[i] + ayy * p.gxy[i];
        double cyy = axy * p.gxy[i] + ayy * p.gyy[i];
        if (Penalty) {
            const double stressed = pressure > 0 && !touches_slip(world, i) ? 1.0 : 0.0;
            const double share = half_penalty * stressed;
            p.stressed[i] = stressed;
            cxx -= share * lxx;
            cxy -= share * lxy;
            cyx -= share * lyx;
            cyy -= share * lyy;
        }
        p.cxx[i] = cxx;
        p.cxy[i] = cxy;
        p.cyx[i] = cyx;
        p.cyy[i] = cyy;
    }
    world.sums[block].plastic = p.volume * plastic;
    world.sums[block].bulk = p.volume * damped * dt;
    world.sums[block].internal_power = p.volume * internal;
}

} // namespace

void stress(World &world) {
    const auto rows = world.constants.penalty > 0 ? stress_rows<true> : stress_rows<false>;
    for_each_block(world.threads, world.particles.count,
                   [&](int64_t block, int64_t begin, int64_t end) { rows(world, block, begin, end); });
    Particles &p = world.particles;
    world.images.copy({&p.cxx, &p.cxy, &p.cyx, &p.cyy});
    if (world.constants.penalty > 0)
        world.images.copy(p.stressed);
    if (world.walls.in_reach()) // ghosts extrapolate from these
        world.images.copy({&p.pressure, &p.density, &p.sxx, &p.sxy});
}

} // namespace gp::stages
