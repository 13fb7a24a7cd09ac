// What the ghosts behind a plate carry: velocity and stress extrapolated from the particles that see them, after Adami,
// Hu & Adams (2012). Ghosts that simply carried the plate's velocity would put the no-slip surface about 1.3 dl too deep.
#include <algorithm>
#include <cmath>

#include "awake.hpp"
#include "kernel.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

struct View {
    const double *x, *y, *vx, *vy, *density, *pressure, *sxx, *sxy;
    double inverse_radius;

    explicit View(const World &world)
        : x(world.particles.x.data()), y(world.particles.y.data()), vx(world.particles.vx.data()),
          vy(world.particles.vy.data()), density(world.particles.density.data()),
          pressure(world.particles.pressure.data()), sxx(world.particles.sxx.data()), sxy(world.particles.sxy.data()),
          inverse_radius(1.0 / world.constants.horizon) {}
};

// The particles that a ghost sees.
struct GhostRow {
    double x, y; // of the ghost
    const int32_t *index;
    int64_t count;

    GhostRow(const Walls &w, int64_t ghost)
        : x(w.ghost_x[ghost]), y(w.ghost_y[ghost]),
          index(w.particles_of_ghost.index.data() + w.particles_of_ghost.start[ghost]),
          count(w.particles_of_ghost.start[ghost + 1] - w.particles_of_ghost.start[ghost]) {}
};

// Sums of w, and of w times velocity and way from the ghost.
struct VelocitySums {
    double w = 0, u = 0, v = 0, x = 0, y = 0;
};

void add_velocities(const View &view, const GhostRow &row, VelocitySums &sums) {
    const double *__restrict x = view.x, *__restrict y = view.y, *__restrict vx = view.vx, *__restrict vy = view.vy;
    const int32_t *__restrict index = row.index;
    const double inverse_radius = view.inverse_radius, at_x = row.x, at_y = row.y;
    double sw = 0, su = 0, sv = 0, sx = 0, sy = 0;
#pragma omp simd reduction(+ : sw, su, sv, sx, sy)
    for (int64_t e = 0; e < row.count; ++e) {
        const int32_t i = index[e];
        const double dx = x[i] - at_x, dy = y[i] - at_y;
        const double q = weight(std::sqrt(dx * dx + dy * dy), inverse_radius);
        sw += q;
        su += q * vx[i];
        sv += q * vy[i];
        sx += q * dx;
        sy += q * dy;
    }
    sums = {sw, su, sv, sx, sy};
}

// Sums of w, and over the particles under pressure of w times pressure, deviator, and rho times the way to the ghost.
struct WallStressSums {
    double w = 0, pressure = 0, xx = 0, xy = 0, down_x = 0, down_y = 0;
};

void add_stresses(const View &view, const GhostRow &row, WallStressSums &sums) {
    const double *__restrict x = view.x, *__restrict y = view.y, *__restrict density = view.density;
    const double *__restrict pressure = view.pressure, *__restrict xx = view.sxx, *__restrict xy = view.sxy;
    const int32_t *__restrict index = row.index;
    const double inverse_radius = view.inverse_radius, at_x = row.x, at_y = row.y;
    double sw = 0, sp = 0, sxx = 0, sxy = 0, down_x = 0, down_y = 0;
#pragma omp simd reduction(+ : sw, sp, sxx, sxy, down_x, down_y)
    for (int64_t e = 0; e < row.count; ++e) {
        const int32_t i = index[e];
        const double dx = at_x - x[i], dy = at_y - y[i];
        const double q = weight(std::sqrt(dx * dx + dy * dy), inverse_radius);
        const double bearing = pressure[i] > 0 ? q : 0.0; // stress-free material in flight feels no wall
        sw += q;
        sp += bearing * pressure[i];
        sxx += bearing * xx[i];
        sxy += bearing * xy[i];
        down_x += bearing * density[i] * dx;
        down_y += bearing * density[i] * dy;
    }
    sums = {sw, sp, sxx, sxy, down_x, down_y};
}

// Velocities are extrapolated linearly through the plate's surface, by the ratio of the ghost's depth to the particles'
// mean distance: without a limit where all that the ghost sees is at yield, which puts the no-slip surface where it is, and no
// steeper than this elsewhere: with 1, eight of 24 deposits at L/dl = 8 trembled on for more than a second, with .5 none did.
// Particles that touch the plate, as a scene may begin or a collision leave them, are taken to be where contact holds them:
// else the ratio has no bound (a particle .0003 dl off a plate sent its neighbours off at a thousand times the sound speed).
//
// Normal to the plate 1 would balance the ghosts' full pressure, so that a wall neither gives nor takes p u_n; but it lets a wall
// be felt a horizon ahead: 1.66 rho c v in a block that falls on a floor, for 1.27, energy from the floor in columns of few grains,
// 1.35 rho g H in single grains of a collapse's front, for 1.2. What a bowl of 24 plates gives back while the grains in it swing,
// 1.5e-4 J/m in all, is 5e-5 with 1.
constexpr double steepest_tangential = 0.5, normal_ratio = 0.25;

template <bool Fluid> bool at_yield(const World &world, int32_t i) {
    const Particles &p = world.particles;
    if (Fluid && world.is_fluid(i)) // it yields at any stress
        return p.pressure[i] > 0 && p.fluidity[i] > 0;
    return p.pressure[i] > 0 && world.map_of(i).at_yield(equivalent_stress({p.sxx[i], p.sxy[i]}), p.pressure[i]);
}

// Is all that the ghost sees at yield?
template <bool Fluid> bool flows_before(const World &world, const GhostRow &row) {
    const Particles &p = world.particles;
    const double horizon2 = world.constants.horizon * world.constants.horizon;
    for (int64_t e = 0; e < row.count; ++e) {
        const int32_t i = row.index[e];
        const double dx = p.x[i] - row.x, dy = p.y[i] - row.y;
        if (dx * dx + dy * dy < horizon2 && !at_yield<Fluid>(world, i)) // the lists reach further than the horizon
            return false;
    }
    return true;
}

// Sheared: ghosts of a rough plate carry the shear on through its surface. Else they move with the plate along it: the
// implicit scheme takes only the change of volume from them, and has ghosts of its own for the shear. (Ghosts turned round
// drive its collapses with 1.6 % of the initial energy at L/dl = 32, these with .6 %.)
template <bool Sheared, bool Fluid> void extrapolate_velocity(World &world) {
    Walls &w = world.walls;
    const View view(world);
    for_each_awake_ghost_run(world, [&](int64_t begin, int64_t end) {
        for (int64_t k = begin; k < end; ++k) {
            const int32_t facet = w.ghost_facet[k];
            const Vector at(w.ghost_x[k], w.ghost_y[k]), own = w.velocity_at(facet, at);
            const Vector n(w.ghost_nx[k], w.ghost_ny[k]), t(-n.y(), n.x());
            const GhostRow row(w, k);
            VelocitySums sums;
            add_velocities(view, row, sums);
            const bool rough = w.facets[facet].spec->friction == GP_WALL_NO_SLIP;
            const bool flows = rough && flows_before<Fluid>(world, row);
            if (sums.w <= 0) { // in the skin only
                w.ghost_vx[k] = own.x();
                w.ghost_vy[k] = own.y();
                continue;
            }
            const Vector way = Vector(sums.x, sums.y) / sums.w; // to the mean place of the particles
            const Vector relative = Vector(sums.u, sums.v) / sums.w - w.velocity_at(facet, at + way);
            const double mean_distance = n.dot(Vector(sums.x, sums.y)) / sums.w - w.ghost_distance[k];
            const double distance = std::max(mean_distance, contact_distance * world.constants.spacing);
            const double ratio = w.ghost_distance[k] / distance;
            const double normal = -normal_ratio * n.dot(relative);
            // Without friction of its own a plate passes no shear through its surface.
            const double carried = Sheared ? -(flows ? ratio : std::min(ratio, steepest_tangential)) : 0.0;
            const double tangential = (rough ? carried : 1.0) * t.dot(relative);
            const Vector ghost = own + normal * n + tangential * t;
            w.ghost_vx[k] = ghost.x();
            w.ghost_vy[k] = ghost.y();
        }
    });
}

} // namespace

void wall_velocity(World &world) {
    if (world.constants.fluid)
        extrapolate_velocity<true, true>(world);
    else
        extrapolate_velocity<true, false>(world);
}

void wall_volume_velocity(World &world) {
    extrapolate_velocity<false, false>(world);
}

namespace {

template <bool Deviatoric> void extrapolate_stress(World &world) {
    Walls &w = world.walls;
    const Constants &c = world.constants;
    const View view(world);
    const double inverse_moment = 1.0 / c.lattice.second_moment;
    for_each_awake_ghost_run(world, [&](int64_t begin, int64_t end) {
        for (int64_t k = begin; k < end; ++k) {
            const Vector n(w.ghost_nx[k], w.ghost_ny[k]);
            WallStressSums sums;
            add_stresses(view, GhostRow(w, k), sums);
            const double sw = sums.w, sp = sums.pressure, down_x = sums.down_x, down_y = sums.down_y;
            double sxx = Deviatoric ? sums.xx : 0.0, sxy = Deviatoric ? sums.xy : 0.0;
            const double heavier = c.gravity.x() * down_x + c.gravity.y() * down_y;
            const double pressure = sw > 0 ? std::max(0.0, (sp + heavier) / sw) : 0.0;
            // The stress ratio, not the stress, carries over: it is what the friction law bounds.
            const double scale = sp > 0 ? pressure / sp : 0.0;
            // s = s_nn (n n - t t)
            const double cosine = n.x() * n.x() - n.y() * n.y(), sine = 2 * n.x() * n.y();
            const double normal = scale * (sxx * cosine + sxy * sine);
            sxx = normal * cosine; // no shear: the stage wall_friction has it
            sxy = normal * sine;
            w.ghost_axx[k] = inverse_moment * (sxx - pressure);
            w.ghost_axy[k] = inverse_moment * sxy;
            w.ghost_ayy[k] = inverse_moment * (-sxx - pressure);
        }
    });
}

} // namespace

void wall_stress(World &world) {
    extrapolate_stress<true>(world);
}

void wall_isotropic_stress(World &world) {
    extrapolate_stress<false>(world);
}

} // namespace gp::stages
