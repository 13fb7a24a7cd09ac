// Smoothing of the density, D rho/Dt += xi c0 dl lap(rho - rho0), between particles that flow: at yield or stress-free.
//
// Each particle integrates its own divergence, and nothing in the motion sees the difference between one particle's
// pressure and its neighbours': such spikes would stay. The hydrostatic part is taken out of the difference (as by
// Fourtakas et al. 2019), so the weight of the material does not diffuse; a fitted gradient instead would, at a wall, take
// a spike for a slope. Pairs with material inside its yield surface are left alone: diffusion at rest would be a pump.
// What is exchanged is the excess over rho0, continuous with the pressure also where materials of different density meet:
// there both change their relative volume by the same amount, as p d rho / rho is the energy that they exchange (the same
// amount of rho in both made energy: half of all there was, between densities of 1 and 40). Of the stretched there is no
// pressure to be continuous: there it is rho / rho0, in the lighter one's measure (by the excess, a heavy particle of half
// its density took the light ones beside it below zero).
#include "awake.hpp"
#include "material/compression.hpp"
#include "stages/density_exchange.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

ExchangeView prepare_exchange(World &world) {
    Particles &p = world.particles;
    const Constants &c = world.constants;
    const double c2 = c.sound_speed * c.sound_speed;
    const bool one = c.one_density();
    // sigma K^-1 is made later in the step: until then its first row holds what is needed here, the excess and what changes.
    Field<double> &excess = p.cxy, &bears = p.bearing, &rest = p.rest, &inverse_rest = p.inverse_rest;
    hand_over(p.ay, p.bearing);
    for_each_seen_block(world, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) {
            const MaterialConstants &m = world.material_of(i);
            excess[i] = p.density[i] - m.density;
            bears[i] = excess[i] > 0 ? 1.0 : 0.0;
            if (!one) {
                rest[i] = m.density;
                inverse_rest[i] = 1.0 / m.density;
            }
        }
    });
    world.images.copy({&excess, &bears, &p.flowing, &p.density});
    if (!one)
        world.images.copy({&rest, &inverse_rest});
    return {p.density.data(),
            excess.data(),
            p.flowing.data(),
            bears.data(),
            rest.data(),
            inverse_rest.data(),
            world.scene->config().density_diffusion * c.sound_speed * c.spacing * world.clock.dt * 2.0 /
                c.lattice.second_moment,
            c.gravity.x() / c2,
            c.gravity.y() / c2,
            1.5 * c.lattice.number_density, // with the stable step less than all of the difference to the mean
            one,
            p.cxx.data()};
}

void density_diffusion(World &world) {
    Particles &p = world.particles;
    const double c2 = world.constants.sound_speed * world.constants.sound_speed;
    for_each_awake_block(world, [&](int64_t block, int64_t begin, int64_t end) {
        double lost = 0;
        for (int64_t i = begin; i < end; ++i) {
            if (p.cxx[i] == 0)
                continue;
            const double rest = world.material_of(i).density, after = p.density[i] + p.cxx[i];
            lost += compression_energy(p.density[i] / rest, rest) - compression_energy(after / rest, rest); // over c0^2
            p.density[i] = after;
        }
        world.sums[block].diffused = p.volume * c2 * lost;
    });
}

} // namespace gp::stages
