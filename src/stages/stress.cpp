// Elastic trial, return map and sigma K^-1, four particles at a time.
//
// The inertial number goes by a mean of the pressure over time. Pressures of single particles fluctuate in fast flow by more than
// their mean, and mu(I) p is concave in p where I is of the same p: by 5 to 12 % less in the mean than at the mean pressure, on an
// incline of 28 degrees, where 1 % of friction is 9 % of the speed. A layer of 20 rows, 48 dl wide and periodic, was 9 % too fast
// after 4 s and 14 % after 8, and is 1.5 and 0 to 1 %.
//
// In a box of 12 dl, whose layer jumps as a whole, it was 23 % too fast after 8 s, and is 13 %. The rest comes of bulk viscosity, which
// bears weight there without friction. Two remedies were tried beside the mean pressure, and taken back. Friction on pressure and bulk
// part together: 5 to 8 %, but handfuls of grains gained energy as they met, and collapses ran out by less, 98 % of their mass by 2.6 %
// at L/dl = 32 and .7 % at 128, and otherwise with another sound speed. No bulk viscosity where it yields: 2 %, but deposits at
// L/dl = 16 came to rest at .5 s in place of .39, some of them not within a second, and ran out by 2 % less. The friction of plates
// (wall_law.hpp) goes by the pressure of the moment: by the mean, too, that layer is 10 % too fast; not tried elsewhere.
#include <algorithm>

#include "awake.hpp"
#include "lanes.hpp"
#include "material/fluidity.hpp"
#include "stages/rows.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

// The materials of four particles.
struct MaterialLanes {
    ReturnMapOf<Lanes> map;
    Lanes density, fluidity_time, is_fluid; // is_fluid: 1 or 0

    template <bool Fluid> GP_INLINE void set(const Constants &c, const int32_t *column, const LanePlaces &places) {
        for (int l = 0; l < lane_count; ++l) {
            const MaterialConstants &m = c.materials[c.body_material[column[places.at[l]]]];
            map.mu_s[l] = m.map.mu_s;
            map.mu_2[l] = m.map.mu_2;
            map.rate_factor[l] = m.map.rate_factor;
            map.shear_modulus[l] = m.map.shear_modulus;
            density[l] = m.density;
            if (Fluid) {
                const FluidityConstants &f = c.fluidities[c.body_material[column[places.at[l]]]];
                fluidity_time[l] = f.time;
                is_fluid[l] = f.cooperativity2 > 0 ? 1.0 : 0.0;
            }
        }
    }
};

struct StressSums {
    double plastic, internal, damped; // W/m3 or J/m3, of a block
};

// The factor by which the trial deviator shrinks by the granular fluidity, which it brings to the end of the step.
GP_INLINE Lanes shrink_by_fluidity(const Particles &p, const MaterialLanes &material, const LanePlaces &places,
                                   double dt, const Lanes &trial, const Lanes &pressure, const Lanes &rate,
                                   Lanes &fluidity) {
    const Lanes one = Lanes{} + 1.0, inertia = material.fluidity_time / dt;
    const Lanes borne = choose(pressure > 0.0, pressure, one);
    const Lanes under_pressure =
        Fluidity::after(material.map, trial, borne, dt, inertia + places.load(p.fluid_pace.data()),
                        inertia * places.load(p.fluidity.data()) + places.load(p.fluid_pull.data()));
    fluidity = where(material.is_fluid > 0.0,
                     choose(pressure > 0.0, under_pressure, Fluidity::without_pressure(material.map, rate)));
    return where(pressure > 0.0, one / (one + material.map.shear_modulus * dt / borne * fluidity));
}

// With the fluidity there is no inside of a yield surface in which the zero-energy penalty may be stiffer, but flow that is the
// more viscous the slower it is, tau over its rate = p / g. A tenth of that withstands what the gradient does not see, if it is
// more than the penalty in fast flow (plain: its viscosity, Pa s), up to the penalty of material at rest, `most` times as much.
//
// With the plain penalty a layer dragged slowly by a plate bore such modes: velocities that zigzag from row to row by a tenth,
// and 4 % too much stress (horizon 4, spacing of half a grain). In cells as slow as the tests' it is at that most nearly
// everywhere: with a thirtieth to three times the tenth their stress is within .1 % and velocities are within .001 of the plate's,
// with a zero_energy_penalty of .5 (in place of .02) within .2 % and .005.
GP_INLINE Lanes stiffness_of_creep(const Lanes &pressure, const Lanes &fluidity, const Lanes &plain, double most) {
    const Lanes one = Lanes{} + 1.0, share = 0.1 * pressure / plain; // over g
    const Lanes held = choose(share < most * fluidity, share / choose(fluidity > 0.0, fluidity, one), Lanes{} + most);
    return choose(held > 1.0, held, one);
}

template <bool Penalty, bool Fluid>
void stress_rows(World &world, bool one_material, int64_t begin, int64_t end, StressSums &sums) {
    Particles &p = world.particles;
    const double dt = world.clock.dt;
    const double half_penalty = 0.5 * world.constants.penalty, stiffer = world.constants.elastic_penalty;
    const double kinematic_viscosity =
        world.scene->config().bulk_viscosity * world.constants.sound_speed * world.constants.spacing;
    const double plain_viscosity = world.scene->config().zero_energy_penalty * world.constants.sound_speed *
                                   world.constants.spacing; // of the penalty, m2/s
    const double *const pressure_of_rate = world.constants.rate_dependent ? p.mean_pressure.data() : p.pressure.data();
    const bool near_plates = world.walls.in_reach();
    Lanes plastic{}, internal{}, damped{};
    MaterialLanes material{};
    if (one_material)
        material.set<Fluid>(world.constants, p.column.data(), LanePlaces(begin, end));
    for (int64_t first = begin; first < end; first += lane_count) {
        const LanePlaces places(first, end);
        if (!one_material)
            material.set<Fluid>(world.constants, p.column.data(), places);
        const ReturnMapOf<Lanes> &map = material.map;
        const Lanes lxx = places.load(p.lxx.data()), lxy = places.load(p.lxy.data());
        const Lanes lyx = places.load(p.lyx.data()), lyy = places.load(p.lyy.data());
        const Lanes pressure = places.load(p.pressure.data());
        const Lanes dxx = 0.5 * (lxx - lyy), dxy = 0.5 * (lxy + lyx); // deviator of D
        const DeviatorOf<Lanes> old{places.load(p.sxx.data()), places.load(p.sxy.data())};
        const Lanes spin = 0.5 * (lxy - lyx);
        const DeviatorOf<Lanes> before = rotate(old, spin, dt);
        const Lanes stiff = 2.0 * map.shear_modulus;
        const DeviatorOf<Lanes> trial{before.xx + stiff * dt * dxx, before.xy + stiff * dt * dxy};
        const int64_t last = first + lane_count < end ? first + lane_count : end;
        Lanes shrink = map.shrink(equivalent_stress(trial), pressure, places.load(pressure_of_rate), dt);
        const auto is_fluid = material.is_fluid > 0.0;
        Lanes fluidity{};
        if (Fluid) {
            const Lanes by_fluidity = shrink_by_fluidity(p, material, places, dt, equivalent_stress(trial), pressure,
                                                         2.0 * root(dxx * dxx + dxy * dxy), fluidity);
            shrink = choose(is_fluid, by_fluidity, shrink);
            places.store(p.fluidity.data(), last, fluidity);
        }
        const DeviatorOf<Lanes> after{shrink * trial.xx, shrink * trial.xy};

        // Mean stress of the step times plastic strain (s_trial - s) / 2G; s:e = 2 (s_xx e_xx + s_xy e_xy).
        const Lanes own = places.own();
        plastic += own *
                   ((before.xx + after.xx) * (trial.xx - after.xx) + (before.xy + after.xy) * (trial.xy - after.xy)) /
                   stiff;

        // What friction does not damp: volume changes under pressure, and shear inside the yield surface, where the
        // material is elastic. Together with the pressure the first never pulls; the second never takes the stress out of
        // the yield surface. Neither acts on a material at rest.
        const Lanes divergence = lxx + lyy;
        const Lanes viscosity = kinematic_viscosity * material.density;
        const Lanes viscous = -viscosity * divergence;
        const Lanes bulk = where(pressure > 0.0, choose(viscous > -pressure, viscous, -pressure));
        DeviatorOf<Lanes> drag{2.0 * viscosity * dxx, 2.0 * viscosity * dxy};
        if (Fluid) { // there is no yield surface: what is left of the rate is elastic
            const Lanes plastic_share = 2.0 * viscosity * (1.0 - shrink) / (stiff * dt);
            drag.xx -= where(is_fluid, plastic_share * trial.xx);
            drag.xy -= where(is_fluid, plastic_share * trial.xy);
        }
        const DeviatorOf<Lanes> total{after.xx + drag.xx, after.xy + drag.xy};
        auto elastic = (shrink == 1.0) & (equivalent_stress(total) <= map.mu_s * pressure);
        if (Fluid)
            elastic = elastic | (is_fluid & (equivalent_stress(total) <= map.mu_2 * pressure));
        const DeviatorOf<Lanes> s{choose(elastic, total.xx, after.xx), choose(elastic, total.xy, after.xy)};
        damped += own * (where(elastic, 2.0 * (drag.xx * dxx + drag.xy * dxy)) - bulk * divergence);
        internal += own * (2.0 * (s.xx * dxx + s.xy * dxy) - (pressure + bulk) * divergence);

        const Lanes gxx = places.load(p.gxx.data()), gxy = places.load(p.gxy.data()), gyy = places.load(p.gyy.data());
        const Lanes axx = s.xx - pressure - bulk, ayy = -s.xx - pressure - bulk, axy = s.xy;
        Lanes cxx = axx * gxx + axy * gxy;
        Lanes cxy = axx * gxy + axy * gyy;
        Lanes cyx = axy * gxx + ayy * gxy;
        Lanes cyy = axy * gxy + ayy * gyy;
        if (Penalty) {
            Lanes share_of_penalty = choose(elastic, Lanes{} + stiffer, Lanes{} + 1.0);
            if (Fluid)
                share_of_penalty = choose(
                    is_fluid, stiffness_of_creep(pressure, fluidity, material.density * plain_viscosity, stiffer),
                    share_of_penalty);
            const Lanes stressed = where(pressure > 0.0, share_of_penalty);
            const Lanes share = half_penalty * stressed;
            Lanes pxx = lxx, pxy = lxy, pyx = lyx, pyy = lyy;
            if (near_plates && world.walls.contact_start[first] < world.walls.contact_start[last])
                for (int64_t i = first; i < last; ++i) {
                    const Tensor inner = inner_gradient(world, i);
                    pxx[i - first] = inner(0, 0);
                    pxy[i - first] = inner(0, 1);
                    pyx[i - first] = inner(1, 0);
                    pyy[i - first] = inner(1, 1);
                }
            cxx -= share * pxx;
            cxy -= share * pxy;
            cyx -= share * pyx;
            cyy -= share * pyy;
            places.store(p.gyy.data(), last, stressed); // which is over
        }
        places.store(p.gxx.data(), last, old.xx);
        places.store(p.gxy.data(), last, old.xy);
        places.store(p.sxx.data(), last, after.xx);
        places.store(p.sxy.data(), last, after.xy);
        places.store(p.cxx.data(), last, cxx);
        places.store(p.cxy.data(), last, cxy);
        places.store(p.cyx.data(), last, cyx);
        places.store(p.cyy.data(), last, cyy);
    }
    sums = {sum_of(plastic), sum_of(internal), sum_of(damped)};
}

// What forces and, in the next step, ghosts and densities read of neighbours: all that is left of it in one message.
void copy_to_images(World &world) {
    Particles &p = world.particles;
    const Images &images = world.images;
    const bool penalty = world.constants.penalty > 0, fluid = world.constants.fluid;
    if (penalty && fluid)
        images.copy(
            {&p.cxx, &p.cxy, &p.cyx, &p.cyy, &p.pressure, &p.density, &p.sxx, &p.sxy, &p.stressed, &p.fluidity});
    else if (penalty)
        images.copy({&p.cxx, &p.cxy, &p.cyx, &p.cyy, &p.pressure, &p.density, &p.sxx, &p.sxy, &p.stressed});
    else if (fluid)
        images.copy({&p.cxx, &p.cxy, &p.cyx, &p.cyy, &p.pressure, &p.density, &p.sxx, &p.sxy, &p.fluidity});
    else
        images.copy({&p.cxx, &p.cxy, &p.cyx, &p.cyy, &p.pressure, &p.density, &p.sxx, &p.sxy});
}

} // namespace

void stress(World &world) {
    Particles &p = world.particles;
    const bool penalty = world.constants.penalty > 0;
    const auto rows = world.constants.fluid ? (penalty ? stress_rows<true, true> : stress_rows<false, true>)
                                            : (penalty ? stress_rows<true, false> : stress_rows<false, false>);
    const std::vector<int32_t> &materials = world.constants.body_material;
    const bool one_material =
        std::all_of(materials.begin(), materials.end(), [&](int32_t material) { return material == materials[0]; });
    if (world.sleep.may_rest)
        remember_shape(world);
    for_each_awake_block(world, [&](int64_t block, int64_t begin, int64_t end) {
        StressSums of_block;
        rows(world, one_material, begin, end, of_block);
        BlockSums &sums = world.sums[block];
        sums.plastic = p.volume * of_block.plastic;
        sums.bulk = p.volume * of_block.damped * world.clock.dt;
        sums.internal_power = p.volume * of_block.internal;
    });
    // K^-1 has done its work: in its memory are now the deviator before the step, should this be taken back, and what the
    // penalty goes by.
    hand_over(p.gxx, world.step_start.sxx);
    hand_over(p.gxy, world.step_start.sxy);
    if (penalty)
        hand_over(p.gyy, p.stressed);
    if (world.sleep.may_rest)
        hold_stress(world);
    copy_to_images(world);
}

} // namespace gp::stages
