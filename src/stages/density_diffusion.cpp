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
    Field<double> &excess = p.cxy, &bears = one ? p.bearing_flow : p.bearing;
    if (bears.empty()) // it has no memory of its own
        hand_over(p.ay, bears);
    const auto make = [&](int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) {
            const MaterialConstants &m = world.material_of(i);
            const double over = p.density[i] - m.density, bearing = over > 0 ? 1.0 : 0.0;
            if (one) {
                excess[i] = p.flowing[i] * over;
                bears[i] = p.flowing[i] * bearing;
            } else {
                excess[i] = over;
                bears[i] = bearing;
                p.rest[i] = m.density;
                p.inverse_rest[i] = 1.0 / m.density;
            }
        }
    };
    if (one)
        make_for_neighbors(world, {&excess, &bears, &p.density}, make);
    else
        make_for_neighbors(world, {&excess, &bears, &p.density, &p.rest, &p.inverse_rest}, make);
    ExchangeView view{};
    view.density = p.density.data();
    view.flowing = p.flowing.data();
    view.excess = view.excess_there = excess.data();
    view.bears = view.bears_there = bears.data();
    view.rest = p.rest.data();
    view.inverse_rest = p.inverse_rest.data();
    view.rest_of_all = c.materials[c.body_material[0]].density;
    view.rate = world.scene->config().density_diffusion * c.sound_speed * c.spacing * world.clock.dt * 2.0 /
                c.lattice.second_moment;
    view.hydrostatic_x = c.gravity.x() / c2;
    view.hydrostatic_y = c.gravity.y() / c2;
    view.largest_pace =
        1.5 * c.lattice.number_density; // with the stable step less than all of the difference to the mean
    view.one_density = one;
    view.change = p.cxx.data();
    return view;
}

void density_diffusion(World &world) {
    Particles &p = world.particles;
    const double c2 = world.constants.sound_speed * world.constants.sound_speed;
    for_each_awake_block(world, [&](int64_t block, int64_t begin, int64_t end) {
        Lanes lost{};
        for (int64_t first = begin; first < end; first += lane_count) {
            const LanePlaces places(first, end);
            Lanes rest;
            for (int l = 0; l < lane_count; ++l)
                rest[l] = world.material_of(places.at[l]).density;
            const Lanes before = places.load(p.density.data()), after = before + places.load(p.cxx.data());
            const Lanes inverse = 1.0 / rest;
            lost += places.own() * (compression_energy(before * inverse, rest) -
                                    compression_energy(after * inverse, rest)); // over c0^2
            places.store(p.density.data(), std::min(end, first + lane_count), after);
        }
        world.sums[block].diffused = p.volume * c2 * sum_of(lost);
    });
}

} // namespace gp::stages
