// Predictor and corrector of the paper's schemes (Jin et al. 2021, 3.14 to 3.17). Positions and velocities hold u^k, r^k
// before the predictor, u*, r* until the corrector, then u^{k+1}, r^{k+1}: since r* = r^k + u* dt, the last step is
// r^{k+1} = r^k + u^{k+1} dt = r* + (u^{k+1} - u*) dt.
#include "parallel.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

// As the particles, the plates are where they will be at the end of the step.
void advance_ghosts(World &world) {
    Walls &w = world.walls;
    const double dt = world.clock.dt;
    for_each_block<ghost_block_size>(world.threads, w.ghost_count, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t k = begin; k < end; ++k) {
            const Vector moved = dt * w.velocity_at(w.ghost_facet[k], {w.ghost_x[k], w.ghost_y[k]});
            w.ghost_x[k] += moved.x();
            w.ghost_y[k] += moved.y();
        }
    });
}

// Predictor with the forces known beforehand: none, or the viscous ones in ax, ay.
template <bool Viscous> void advance_particles(World &world) {
    Particles &p = world.particles;
    const double dt = world.clock.dt;
    const Vector g = world.constants.gravity;
    for_each_block(world.threads, p.count, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) {
            p.vx[i] += dt * (g.x() + (Viscous ? p.ax[i] : 0.0));
            p.vy[i] += dt * (g.y() + (Viscous ? p.ay[i] : 0.0));
            p.x[i] += dt * p.vx[i];
            p.y[i] += dt * p.vy[i];
        }
    });
    update_images(world);
}

// ax, ay are left as the whole step's acceleration: what the ledger and gp_state.at_rest go by.
template <class Late> void correct_by(World &world, const Late &late) {
    Particles &p = world.particles;
    const double dt = world.clock.dt;
    for_each_block(world.threads, p.count, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) {
            const Vector a = late(i);
            p.vx[i] += dt * a.x();
            p.vy[i] += dt * a.y();
            p.x[i] += dt * dt * a.x();
            p.y[i] += dt * dt * a.y();
            p.push_x[i] = p.push_y[i] = 0;
        }
    });
}

} // namespace

void predict(World &world) {
    advance_particles<false>(world);
    advance_ghosts(world);
}

void predict_with_viscosity(World &world) {
    require_bounded_step(world, world.particles.ax, world.particles.ay);
    advance_particles<true>(world);
    advance_ghosts(world);
}

void correct(World &world) {
    const Particles &p = world.particles;
    require_bounded_step(world, p.ax, p.ay);
    const Vector g = world.constants.gravity; // in the predictor already
    correct_by(world, [&](int64_t i) { return Vector(p.ax[i] - g.x(), p.ay[i] - g.y()); });
}

void correct_by_pressure(World &world) {
    Particles &p = world.particles;
    require_bounded_step(world, p.cxx, p.cxy);
    const Vector g = world.constants.gravity;
    correct_by(world, [&](int64_t i) {
        const Vector a(p.cxx[i], p.cxy[i]);
        p.ax[i] += a.x() + g.x();
        p.ay[i] += a.y() + g.y();
        return a;
    });
}

} // namespace gp::stages
