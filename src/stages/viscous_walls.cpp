#include "stages/viscous_walls.hpp"

#include <algorithm>
#include <cmath>

#include "parallel.hpp"
#include "stages/viscous_operators.hpp"

namespace gp::stages {

namespace {

template <class Body> void for_each_contact(World &world, const Body &body) {
    for_each_block<ghost_block_size>(world.threads, static_cast<int64_t>(world.walls.contacts.size()),
                                     [&](int64_t, int64_t begin, int64_t end) {
                                         for (int64_t c = begin; c < end; ++c)
                                             body(c);
                                     });
}

// Runs body(i, c) for the contacts c of every particle i that has any.
template <class Body> void for_each_contact_of_particles(World &world, const Body &body) {
    const Walls &w = world.walls;
    if (w.contacts.empty())
        return;
    for_each_block(world.threads, world.particles.count, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i)
            for (int64_t c = w.contact_start[i]; c < w.contact_start[i + 1]; ++c)
                body(i, c);
    });
}

// Of p, where the wall's material stretches across the plate: what it bears of N can be no less than this share.
constexpr double least_borne = 0.1;

// mu N / p of the material on planes along the plate; with a friction of the plate's own no more than that.
WallLaw law_of(const World &world, const Contact &contact, double normal) {
    const ViscousSystem &v = world.viscous;
    const Walls &w = world.walls;
    const int64_t i = contact.particle;
    const Facet &facet = w.facets[contact.facet];
    const Segment &s = facet.segment;
    WallLaw wall{};
    wall.tangent = s.tangent;
    const Vector at = w.nearest_image(s, {world.particles.x[i], world.particles.y[i]});
    wall.lever = 2 * std::max(s.distance(at), contact_distance * world.constants.spacing);
    wall.law = world.material_of(i).law;
    if (facet.spec->friction == GP_WALL_FREE_SLIP || normal <= 0)
        return wall;
    const Vector slip = Vector(v.velocity.x[i], v.velocity.y[i]) - w.velocity_at(contact.facet, at);
    const double g = s.tangent.dot(slip) / wall.lever;
    wall.pressure = v.pressure[i] > 0 ? v.pressure[i] : normal * world.constants.spacing;
    const double mu = wall.law.yield(std::abs(g), wall.pressure).stress / wall.pressure;
    double borne = 1; // N over p
    if (facet.spec->friction == GP_WALL_COULOMB) {
        wall.law.mu_s = wall.law.mu_2 = std::min(facet.spec->wall_mu, mu);
    } else {
        Tensor rate;
        rate << v.rate.x[i], v.rate.y[i], v.rate.y[i], -v.rate.x[i];
        // Mean between the particle and the plate, which does not stretch.
        const double stretching = 0.5 * s.normal.dot(rate * s.normal);
        wall.law.delta = std::hypot(wall.law.delta, stretching);
        borne = std::max(1 - mu * stretching / std::hypot(g, wall.law.delta), least_borne);
    }
    wall.share = normal / (borne * wall.pressure);
    return wall;
}

} // namespace

void find_wall_laws(World &world) {
    const Walls &w = world.walls;
    ViscousSystem &v = world.viscous;
    const auto count = static_cast<int64_t>(w.contacts.size());
    v.wall_laws.resize(w.contacts.size());
    for (Field<double> *field : {&v.wall_rate, &v.wall_stress, &v.wall_change, &v.wall_h})
        field->resize(count);
    for_each_contact(world, [&](int64_t c) {
        const Contact &contact = w.contacts[c];
        const Vector &n = w.facets[contact.facet].segment.normal;
        const Vector viscous = viscous_contact_force(world, v.velocity, contact);
        v.wall_laws[c] = law_of(world, contact, n.dot(Vector(contact.force_x, contact.force_y) + viscous));
    });
    wall_rates(world, v.velocity, Plates::move, v.wall_rate);
    for_each_contact(world, [&](int64_t c) {
        const WallLaw &wall = v.wall_laws[c];
        v.wall_stress[c] = wall.law.viscosity(std::abs(v.wall_rate[c]), wall.pressure) * v.wall_rate[c];
    });
}

void wall_rates(World &world, const VectorField &u, Plates plates, Field<double> &rate) {
    const Walls &w = world.walls;
    const ViscousSystem &v = world.viscous;
    for_each_contact(world, [&](int64_t c) {
        const Contact &contact = w.contacts[c];
        const int64_t i = contact.particle;
        Vector slip(u.x[i], u.y[i]);
        if (plates == Plates::move)
            slip -= w.velocity_at(contact.facet, {world.particles.x[i], world.particles.y[i]});
        rate[c] = v.wall_laws[c].tangent.dot(slip) / v.wall_laws[c].lever;
    });
}

void add_wall_tractions(World &world, const Field<double> &stress, VectorField &f) {
    const ViscousSystem &v = world.viscous;
    for_each_contact_of_particles(world, [&](int64_t i, int64_t c) {
        const double force = v.wall_laws[c].share * stress[c];
        f.x[i] -= force * v.wall_laws[c].tangent.x();
        f.y[i] -= force * v.wall_laws[c].tangent.y();
    });
}

Vector wall_traction(const World &world, const Contact &contact) {
    const ViscousSystem &v = world.viscous;
    const int64_t c = &contact - world.walls.contacts.data();
    return -v.wall_laws[c].share * v.wall_stress[c] * v.wall_laws[c].tangent;
}

void add_wall_diagonal(World &world, Field<double> &diagonal) {
    const ViscousSystem &v = world.viscous;
    for_each_contact_of_particles(world, [&](int64_t i, int64_t c) {
        const WallLaw &wall = v.wall_laws[c];
        diagonal[i] += wall.share / wall.lever * wall.law.viscosity(std::abs(v.wall_rate[c]), wall.pressure);
    });
}

} // namespace gp::stages
