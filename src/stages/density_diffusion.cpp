// Smoothing of the density, D rho/Dt += xi c0 dl lap(rho - rho0), between particles that flow: at yield or stress-free.
//
// Each particle integrates its own divergence, and nothing in the motion sees the difference between one particle's
// pressure and its neighbours': such spikes would stay. The hydrostatic part is taken out of the difference (as by
// Fourtakas et al. 2019), so the weight of the material does not diffuse; a fitted gradient instead would, at a wall, take
// a spike for a slope. Pairs with material inside its yield surface are left alone: diffusion at rest would be a pump.
// What is exchanged is the excess over rho0, continuous with the pressure also where materials of different density meet:
// there both change their relative volume by the same amount, as p d rho / rho is the energy that they exchange (the same
// amount of rho in both made energy: half of all there was, between densities of 1 and 40).
#include <cmath>

#include "kernel.hpp"
#include "parallel.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

struct View {
    const double *x, *y, *excess, *flowing, *rest;
    const int64_t *start;
    const int32_t *index;
    const double *density;
    double inverse_radius, rate;
    double hydrostatic_x, hydrostatic_y; // g / c0^2, 1/m
    double *change;
};

GP_MULTIVERSION void exchange(const View &v, int64_t begin, int64_t end) {
    const double *__restrict x = v.x, *__restrict y = v.y, *__restrict excess = v.excess,
                             *__restrict flowing = v.flowing;
    const double *__restrict density = v.density, *__restrict rest = v.rest;
    for (int64_t i = begin; i < end; ++i) {
        v.change[i] = 0;
        if (flowing[i] == 0)
            continue;
        const int32_t *__restrict row = v.index + v.start[i];
        const int64_t n = v.start[i + 1] - v.start[i];
        const double xi = x[i], yi = y[i], own = excess[i], own_density = density[i], own_rest = rest[i];
        const double inverse_radius = v.inverse_radius;
        // Weight counts between particles that both bear some.
        const double half_x = own > 0 ? 0.5 * v.hydrostatic_x : 0.0, half_y = own > 0 ? 0.5 * v.hydrostatic_y : 0.0;
        double sum = 0;
#pragma omp simd reduction(+ : sum)
        for (int64_t k = 0; k < n; ++k) {
            const int32_t j = row[k];
            const double dx = x[j] - xi, dy = y[j] - yi;
            const double w = weight(std::sqrt(dx * dx + dy * dy), inverse_radius) * flowing[j];
            const double borne = excess[j] > 0 ? own_density + density[j] : 0.0;
            const double share =
                own_rest / (own_rest > rest[j] ? own_rest : rest[j]); // the denser one's pace is stable
            sum += share * w * (excess[j] - own - borne * (half_x * dx + half_y * dy));
        }
        v.change[i] = v.rate * sum;
    }
}

// Integral of p d rho / rho from rho0 on over c0^2, kg/m3.
double compression_energy(double density, double rest_density) {
    const double compression = density / rest_density - 1;
    return compression > 0 ? rest_density * (compression - std::log1p(compression)) : 0.0;
}

} // namespace

void density_diffusion(World &world) {
    Particles &p = world.particles;
    const Constants &c = world.constants;
    const double c2 = c.sound_speed * c.sound_speed;
    // sigma K^-1 is made later in the step: until then it holds what is needed here.
    const View view{p.x.data(),
                    p.y.data(),
                    p.cxy.data(),
                    p.flowing.data(),
                    p.cyx.data(),
                    world.neighbors.start.data(),
                    world.neighbors.index.data(),
                    p.density.data(),
                    1.0 / c.horizon,
                    world.scene->config().density_diffusion * c.sound_speed * c.spacing * world.clock.dt * 2.0 /
                        c.lattice.second_moment,
                    c.gravity.x() / c2,
                    c.gravity.y() / c2,
                    p.cxx.data()};
    for_each_block(world.threads, p.count, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) {
            p.cyx[i] = world.material_of(i).density;
            p.cxy[i] = p.density[i] - p.cyx[i];
            const bool flows = world.map_of(i).at_yield(equivalent_stress({p.sxx[i], p.sxy[i]}), p.pressure[i]);
            p.flowing[i] = flows ? 1.0 : 0.0;
        }
    });
    world.images.copy({&p.cxy, &p.cyx, &p.flowing, &p.density});
    for_each_block(world.threads, p.count, [&](int64_t block, int64_t begin, int64_t end) {
        exchange(view, begin, end);
        double lost = 0;
        for (int64_t i = begin; i < end; ++i) {
            if (p.cxx[i] == 0)
                continue;
            const double rest = world.material_of(i).density;
            lost += compression_energy(p.density[i], rest) - compression_energy(p.density[i] + p.cxx[i], rest);
        }
        world.sums[block].diffused = p.volume * c2 * lost;
    });
    for_each_block(world.threads, p.count, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i)
            p.density[i] += p.cxx[i];
    });
}

} // namespace gp::stages
