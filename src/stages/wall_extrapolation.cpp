// What the ghosts behind a plate carry: velocity and stress extrapolated from the particles that see them, after Adami,
// Hu & Adams (2012). Ghosts that simply carried the plate's velocity would put the no-slip surface about 1.3 dl too deep.
#include <algorithm>

#include "awake.hpp"
#include "lanes.hpp"
#include "stages/rows.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

struct ExtrapolationView {
    const Walls &walls;
    const double *x, *y, *vx, *vy, *density, *pressure, *sxx, *sxy, *flowing;
    double inverse_radius;

    explicit ExtrapolationView(const World &world)
        : walls(world.walls), x(world.particles.x.data()), y(world.particles.y.data()), vx(world.particles.vx.data()),
          vy(world.particles.vy.data()), density(world.particles.density.data()),
          pressure(world.particles.pressure.data()), sxx(world.particles.sxx.data()), sxy(world.particles.sxy.data()),
          flowing(world.particles.flowing.data()), inverse_radius(1.0 / world.constants.horizon) {}
};

// Adds what a group of four ghosts sees: add(i, w, dx, dy) for the particles i, with the lanes' weights and ways from the ghosts.
template <class Sums> GP_INLINE Sums sums_of_group(const ExtrapolationView &view, int64_t group, Sums sums) {
    const double *__restrict x = view.x, *__restrict y = view.y;
    const LaneRows &rows = view.walls.lanes.particles_of_ghosts;
    const int32_t *__restrict index = rows.index.data();
    const uint8_t *__restrict seen_by = rows.seen_by.data();
    const LanePlaces places(group * lane_count, view.walls.ghost_count);
    const Lanes at_x = places.load(view.walls.ghost_x.data()), at_y = places.load(view.walls.ghost_y.data());
    const double inverse_radius = view.inverse_radius;
    Sums local = sums;
    for (int64_t k = rows.start[group], end = rows.start[group + 1]; k < end; ++k) {
        const int32_t i = index[k];
        const Lanes dx = x[i] - at_x, dy = y[i] - at_y;
        local.add(i, seen_by_lanes(weight(dx * dx + dy * dy, inverse_radius), seen_by[k]), dx, dy);
    }
    return local;
}

// Sums of w, of w times velocity and way from the ghost, and, for ghosts that carry the shear on, of w of what does not flow under
// pressure.
template <bool Sheared> struct VelocitySums {
    const double *__restrict vx, *__restrict vy, *__restrict pressure, *__restrict flowing;
    Lanes w{}, u{}, v{}, x{}, y{}, held{};

    explicit VelocitySums(const ExtrapolationView &view)
        : vx(view.vx), vy(view.vy), pressure(view.pressure), flowing(view.flowing) {}
    GP_INLINE void add(int32_t i, const Lanes &weight, const Lanes &dx, const Lanes &dy) {
        w += weight;
        u += weight * vx[i];
        v += weight * vy[i];
        x += weight * dx;
        y += weight * dy;
        if (Sheared) // else nobody has found out yet who flows
            held += weight * (pressure[i] > 0 && flowing[i] > 0 ? 0.0 : 1.0);
    }
};

// Sums of w, and over the particles under pressure of w times pressure, deviator, and rho times the way from the ghost.
struct WallStressSums {
    const double *__restrict density, *__restrict pressure_of, *__restrict sxx, *__restrict sxy;
    Lanes w{}, pressure{}, xx{}, xy{}, up_x{}, up_y{};

    explicit WallStressSums(const ExtrapolationView &view)
        : density(view.density), pressure_of(view.pressure), sxx(view.sxx), sxy(view.sxy) {}
    GP_INLINE void add(int32_t i, const Lanes &weight, const Lanes &dx, const Lanes &dy) {
        w += weight;
        const double p = pressure_of[i];
        const Lanes bearing = weight * (p > 0 ? 1.0 : 0.0); // stress-free material in flight feels no wall
        pressure += bearing * p;
        xx += bearing * sxx[i];
        xy += bearing * sxy[i];
        const Lanes mass = bearing * density[i];
        up_x += mass * dx;
        up_y += mass * dy;
    }
};

// Calls body(k, sums, lane) for the ghosts k in begin .. end.
template <class Sums, class Body>
GP_INLINE void sum_up_ghosts(const ExtrapolationView &view, int64_t begin, int64_t end, const Body &body) {
    for (int64_t k = begin; k < end;) {
        const int64_t group = k / lane_count, stop = std::min(end, (group + 1) * lane_count);
        const Sums sums = sums_of_group(view, group, Sums(view));
        for (; k < stop; ++k)
            body(k, sums, static_cast<int>(k % lane_count));
    }
}

template <class Sums, class Body> void for_each_ghost(const World &world, const Body &body) {
    const ExtrapolationView view(world);
    for_each_awake_ghost_run(world, [&](int64_t begin, int64_t end) { sum_up_ghosts<Sums>(view, begin, end, body); });
}

// Velocities are extrapolated linearly through the plate's surface, by the ratio of the ghost's depth to the particles'
// mean distance: without a limit where all that the ghost sees is at yield, which puts the no-slip surface where it is, and no
// steeper than this elsewhere: with 1, eight of 24 deposits at L/dl = 8 trembled on for more than a second, with .5 none did.
// Particles that touch the plate, as a scene may begin or a collision leave them, are taken to be where contact holds them:
// else the ratio has no bound (a particle .0003 dl off a plate sent its neighbours off at a thousand times the sound speed).
//
// Normal to the plate 1 would balance the ghosts' full pressure, so that a wall neither gives nor takes p u_n; but it lets a wall
// be felt a horizon ahead: 1.66 rho c v in a block that falls on a floor, for 1.27, energy from the floor in columns of few grains,
// 1.35 rho g H in single grains of a collapse's front, for 1.2.
//
// With less a wall is a spring of its own: the part of the first rows' compression that their density does not tell takes p u_n
// from what comes nearer, and gives it to what goes away. A bowl swings on it, of 5 cm radius, of 96 plates and 2400 grains, in its
// lowest wave (93 % of the kinetic energy is in v = a cos(pi r / 2R), 59 Hz): 2.4e-4 of weight times radius comes back in all,
// 3e-6 with 1. Of the friction 2e-7 comes back. 1 where p is well above what a blow by u_n brings, the rest of the ratio being
// 1 / (1 + (p / (k rho c u_n))^2) of its .75, gives back 3e-6, 7e-6, 6e-5 with k = 4, 8, 16, and single grains of the block bear
// 1.34, 1.22 rho c v with k = 3, 8; but a layer on 20 degrees, below yield, between walls then moves by .1 dl for less than .05,
// and a collapse with 25.5 and 36.5 degrees is 2.2 % lower at .42 s.
constexpr double steepest_tangential = 0.5, normal_ratio = 0.25;

// Sheared: ghosts of a rough plate carry the shear on through its surface. Else they move with the plate along it: the
// implicit scheme takes only the change of volume from them, and has ghosts of its own for the shear. (Ghosts turned round
// drive its collapses with 1.6 % of the initial energy at L/dl = 32, these with .6 %.)
template <bool Sheared> void extrapolate_velocity(World &world) {
    Walls &w = world.walls;
    for_each_ghost<VelocitySums<Sheared>>(world, [&](int64_t k, const VelocitySums<Sheared> &sums, int lane) {
        const int32_t facet = w.ghost_facet[k];
        const Vector at(w.ghost_x[k], w.ghost_y[k]), own = w.velocity_at(facet, at);
        const Vector n(w.ghost_nx[k], w.ghost_ny[k]), t(-n.y(), n.x());
        const double sw = sums.w[lane];
        if (sw <= 0) { // in the skin only
            w.ghost_vx[k] = own.x();
            w.ghost_vy[k] = own.y();
            return;
        }
        const Vector way = Vector(sums.x[lane], sums.y[lane]) / sw; // to the mean place of the particles
        const Vector relative = Vector(sums.u[lane], sums.v[lane]) / sw - w.velocity_at(facet, at + way);
        const double distance = std::max(n.dot(way) - w.ghost_distance[k], contact_distance * world.constants.spacing);
        const double ratio = w.ghost_distance[k] / distance;
        const double normal = -normal_ratio * n.dot(relative);
        // Only a rough plate passes shear through its surface; along any other ghosts move with the particles.
        const bool rough = passes_shear(w.facets[facet]), flows = Sheared && sums.held[lane] == 0;
        const double carried = Sheared ? -(flows ? ratio : std::min(ratio, steepest_tangential)) : 0.0;
        const double tangential = (rough ? carried : 1.0) * t.dot(relative);
        const Vector ghost = own + normal * n + tangential * t;
        w.ghost_vx[k] = ghost.x();
        w.ghost_vy[k] = ghost.y();
    });
}

template <bool Deviatoric> void extrapolate_stress(World &world) {
    Walls &w = world.walls;
    const Constants &c = world.constants;
    const double inverse_moment = 1.0 / c.lattice.second_moment;
    for_each_ghost<WallStressSums>(world, [&](int64_t k, const WallStressSums &sums, int lane) {
        const Vector n(w.ghost_nx[k], w.ghost_ny[k]);
        const double sw = sums.w[lane], sp = sums.pressure[lane];
        double sxx = Deviatoric ? sums.xx[lane] : 0.0, sxy = Deviatoric ? sums.xy[lane] : 0.0;
        const double heavier = -(c.gravity.x() * sums.up_x[lane] + c.gravity.y() * sums.up_y[lane]);
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
    });
}

} // namespace

void wall_velocity(World &world) {
    extrapolate_velocity<true>(world);
}

void wall_volume_velocity(World &world) {
    extrapolate_velocity<false>(world);
}

void wall_stress(World &world) {
    extrapolate_stress<true>(world);
}

void wall_isotropic_stress(World &world) {
    extrapolate_stress<false>(world);
}

} // namespace gp::stages
