#include <array>
#include <cmath>

#include "awake.hpp"
#include "error.hpp"
#include "parts.hpp"
#include "stages/stages.hpp"
#include "stretches.hpp"
#include "undo.hpp"

namespace gp::stages {

namespace {

// check: its number, in the order in which they are made.
[[noreturn]] void diverged(const World &world, double check, int64_t i, const std::string &what) {
    const Particles &p = world.particles;
    const Error error = make_error(GP_E_DIVERGED, "%s of particle %lld at (%g, %g) m, time %g s, step %lld of %g s",
                                   what.c_str(), static_cast<long long>(p.id[i]), p.x[i], p.y[i], world.clock.time,
                                   static_cast<long long>(world.clock.step), world.clock.dt);
    if (!world.crossing)
        throw Error(error);
    std::array<double, 4> key{check};
    key_of_cell(world, i, 0, key.data() + 1);
    throw Divergence(error, key);
}

void require_bounded_particles(const World &world, const Field<double> &ax, const Field<double> &ay, double most) {
    const Particles &p = world.particles;
    for (int64_t i = 0; i < p.count; ++i) {
        const double own = world.material_of(i).density;
        if (!is_bounded_density(p.density[i] / own))
            diverged(world, 0, i,
                     format_text("density: %g kg/m3, expected from 0 to below %g, %g times its material's own,",
                                 p.density[i], density_bound * own, density_bound));
    }
    for (int64_t i = 0; i < p.count; ++i)
        if (!std::isfinite(p.sxx[i]) || !std::isfinite(p.sxy[i]))
            diverged(world, 1, i, format_text("stress: deviator (%g, %g) Pa", p.sxx[i], p.sxy[i]));
    for (int64_t i = 0; i < p.count; ++i)
        if (!(std::hypot(ax[i], ay[i]) <= most))
            diverged(world, 2, i,
                     format_text("force: acceleration (%g, %g) m/s2, expected at most %g, a motion of %g dl in the "
                                 "step,",
                                 ax[i], ay[i], most, motion_bound));
}

} // namespace

// The stages leave a sum per block: what is looked at particle by particle is a step that may be bad.
void require_bounded_step(const World &world, const Field<double> &ax, const Field<double> &ay) {
    const double dt = world.clock.dt;
    const double most = motion_bound * world.constants.spacing / (dt * dt); // m/s2
    // By one thread: to call the others takes longer, at a thousand particles seven times as long.
    bool suspect = false;
    const Sleep &s = world.sleep;
    const int64_t count = s.some ? s.awake : static_cast<int64_t>(world.sums.size());
    for (int64_t k = 0; k < count; ++k) {
        const BlockSums &block = world.sums[s.some ? s.lit[k] : k];
        suspect |= block.unbounded || !(block.acceleration2 <= most * most);
    }
    if (world.crossing)
        require_bounded_everywhere(world, suspect, [&] { require_bounded_particles(world, ax, ay, most); });
    else if (suspect)
        require_bounded_particles(world, ax, ay, most);
}

void integrate(World &world) {
    Particles &p = world.particles;
    require_bounded_step(world, p.ax, p.ay);
    if (world.constants.scheme == Scheme::adjoint)
        accept_step(world);
    const double dt = world.clock.dt;
    const double share = dt / (dt + world.constants.pressure_memory); // of the present pressure in the mean
    constexpr double least = 1e-200; // Pa: what fades beyond is none, before its digits end
    for_each_awake_block(world, [&](int64_t, int64_t begin, int64_t end) {
        if (world.constants.rate_dependent)
            for (int64_t i = begin; i < end; ++i) {
                const double mean = p.mean_pressure[i] + share * (p.pressure[i] - p.mean_pressure[i]);
                p.mean_pressure[i] = mean > least ? mean : 0.0;
            }
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
