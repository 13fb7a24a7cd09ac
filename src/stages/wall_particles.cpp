// Plates in the paper's schemes (Jin et al. 2021, 2.2): a layer of wall particles, and behind it layers of ghosts that have
// the velocity and the stress of their wall particle. The first layer of ghosts, half a spacing behind the surface, is the
// wall particles. Their number density is that of the particles that they see and of the plate's own half of the lattice.
//
// The paper names velocity and pressure, "such as", of the properties that ghosts share with their wall particle. Here they
// share the viscous stress, too, which a wall particle has by the same law from its own velocity gradient. Measured on the
// collapse with a = 1.25, L/dl = 32, factor 2: with it, peak y/L = .505 at .42 s (the paper: .508) and the deposit keeps its
// width; without, .452, and the deposit slides on over the floor, from 3 L wide to 4.1 L at 1 s.
#include <algorithm>
#include <cmath>

#include "mps_operators.hpp"
#include "parallel.hpp"
#include "stages/rows.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

struct WallState {
    double pressure = 0;
    Symmetric stress{0, 0, 0}; // viscous
};

// Of the other plates: near a corner their ghosts complete the wall particle's neighbourhood in front of its own plate.
double other_plates(const World &world, int64_t k) {
    const Walls &w = world.walls;
    const double radius = world.constants.interaction_radius;
    const Segment &own = w.facets[w.ghost_facet[k]].segment;
    const Vector at(w.ghost_x[k], w.ghost_y[k]);
    double sum = 0;
    for (std::size_t q = 0; q < w.facets.size(); ++q) {
        const Segment &other = w.facets[q].segment;
        if (static_cast<int32_t>(q) == w.ghost_facet[k] || w.plate_of(static_cast<int32_t>(q)).gap > 0 ||
            other.distance(at) <= 0 || other.nearest(at) >= radius)
            continue;
        const auto range =
            std::equal_range(w.ghost_facet.begin(), w.ghost_facet.end(), static_cast<int32_t>(q)); // in order of facet
        for (auto g = range.first - w.ghost_facet.begin(); g < range.second - w.ghost_facet.begin(); ++g)
            if (own.distance({w.ghost_x[g], w.ghost_y[g]}) > 0)
                sum += weight(std::hypot(w.ghost_x[g] - at.x(), w.ghost_y[g] - at.y()), 1.0 / radius);
    }
    return sum;
}

WallState wall_state(const World &world, int64_t k) {
    const Walls &w = world.walls;
    const Particles &p = world.particles;
    const Constants &c = world.constants;
    const double inverse_radius = 1.0 / c.interaction_radius, floor = nearest_square * c.volume;
    double sum = 0, nearest = 0, density = 0;
    int64_t closest = -1;
    Tensor l = Tensor::Zero();
    for (int64_t e = w.particles_of_ghost.start[k]; e < w.particles_of_ghost.start[k + 1]; ++e) {
        const int32_t i = w.particles_of_ghost.index[e];
        const Vector r(p.x[i] - w.ghost_x[k], p.y[i] - w.ghost_y[k]);
        const Vector du(p.vx[i] - w.ghost_vx[k], p.vy[i] - w.ghost_vy[k]);
        const double q = weight(r.norm(), inverse_radius);
        sum += q;
        density += q * world.material_of(i).density;
        l += q / (r.squaredNorm() + floor) * du * r.transpose();
        if (q > nearest) {
            nearest = q;
            closest = i;
        }
    }
    WallState state;
    if (closest < 0)
        return state;
    const double own_half = 0.5 * (c.interaction_lattice.number_density + c.interaction_lattice.row);
    const double ratio = (sum + own_half + other_plates(world, k)) / c.interaction_lattice.number_density;
    state.pressure = state_pressure(ratio, density / sum * c.sound_speed * c.sound_speed);
    l *= 2.0 / c.interaction_lattice.number_density;
    state.stress = world.material_of(closest).law.stress({l(0, 0), 0.5 * (l(0, 1) + l(1, 0)), l(1, 1)}, state.pressure);
    const Facet &facet = w.facets[w.ghost_facet[k]];
    if (!passes_shear(facet)) {
        const Vector &t = facet.segment.tangent, &n = facet.segment.normal;
        Tensor s;
        s << state.stress.xx, state.stress.xy, state.stress.xy, state.stress.yy;
        const double shear = t.dot(s * n);
        s -= shear * (t * n.transpose() + n * t.transpose());
        state.stress = {s(0, 0), s(0, 1), s(1, 1)};
    }
    return state;
}

// Evaluates the wall particles and hands on to the ghosts behind what `keep` has stored of them.
template <class Keep> void for_each_wall_particle(World &world, const Keep &keep) {
    Walls &w = world.walls;
    for_each_block<ghost_block_size>(world.threads, w.ghost_count, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t k = begin; k < end; ++k)
            if (w.wall_particle[k] == k)
                keep(k, wall_state(world, k));
    });
    for_each_block<ghost_block_size>(world.threads, w.ghost_count, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t k = begin; k < end; ++k) {
            const int32_t from = w.wall_particle[k];
            if (from == k)
                continue;
            w.ghost_axx[k] = w.ghost_axx[from];
            w.ghost_axy[k] = w.ghost_axy[from];
            w.ghost_ayy[k] = w.ghost_ayy[from];
        }
    });
}

} // namespace

void ghost_velocity(World &world) {
    Walls &w = world.walls;
    const Particles &p = world.particles;
    const double inverse_radius = 1.0 / world.constants.interaction_radius;
    for_each_block<ghost_block_size>(world.threads, w.ghost_count, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t k = begin; k < end; ++k) {
            const Facet &facet = w.facets[w.ghost_facet[k]];
            Vector ghost = w.velocity_at(w.ghost_facet[k], {w.ghost_x[k], w.ghost_y[k]});
            if (!passes_shear(facet)) { // ghosts move with the particles along it
                double sum = 0;
                Vector flow = Vector::Zero();
                for (int64_t e = w.particles_of_ghost.start[k]; e < w.particles_of_ghost.start[k + 1]; ++e) {
                    const int32_t i = w.particles_of_ghost.index[e];
                    const double q = weight(std::hypot(p.x[i] - w.ghost_x[k], p.y[i] - w.ghost_y[k]), inverse_radius);
                    sum += q;
                    flow += q * Vector(p.vx[i], p.vy[i]);
                }
                const Vector &t = facet.segment.tangent;
                if (sum > 0)
                    ghost += t.dot(flow / sum - ghost) * t;
            }
            w.ghost_vx[k] = ghost.x();
            w.ghost_vy[k] = ghost.y();
        }
    });
}

void wall_particles(World &world) {
    Walls &w = world.walls;
    const double inverse_moment = 1.0 / world.constants.lattice.second_moment;
    for_each_wall_particle(world, [&](int64_t k, const WallState &state) {
        w.ghost_axx[k] = inverse_moment * (state.stress.xx - state.pressure);
        w.ghost_axy[k] = inverse_moment * state.stress.xy;
        w.ghost_ayy[k] = inverse_moment * (state.stress.yy - state.pressure);
    });
}

void wall_viscous_stress(World &world) {
    Walls &w = world.walls;
    for_each_wall_particle(world, [&](int64_t k, const WallState &state) {
        w.ghost_axx[k] = state.stress.xx;
        w.ghost_axy[k] = state.stress.xy;
        w.ghost_ayy[k] = state.stress.yy;
    });
}

void wall_pressure(World &world) {
    Walls &w = world.walls;
    for_each_wall_particle(world, [&](int64_t k, const WallState &state) { w.ghost_axx[k] = state.pressure; });
}

} // namespace gp::stages
