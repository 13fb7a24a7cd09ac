#include "ledger.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "material/compression.hpp"
#include "stretches.hpp"

namespace gp {

namespace {

// Per volume. A viscous stress stores nothing.
double isotropic_energy(const Particles &p, const MaterialConstants &m, int64_t i) {
    return compression_energy(p.density[i] / m.density, m.bulk_modulus);
}

// That and s:s / 4G.
double elastic_energy(const Particles &p, const MaterialConstants &m, int64_t i) {
    return isotropic_energy(p, m, i) + (p.sxx[i] * p.sxx[i] + p.sxy[i] * p.sxy[i]) / (2 * m.map.shear_modulus);
}

// The same as the first with the paper's equation of state.
double number_density_energy(const Particles &p, const MaterialConstants &m, int64_t i) {
    return state_energy(p.density[i] / m.density, m.bulk_modulus);
}

auto energy_of(Scheme scheme) {
    switch (scheme) {
    case Scheme::adjoint: return elastic_energy;
    case Scheme::implicit: return isotropic_energy;
    default: return number_density_energy;
    }
}

} // namespace

namespace {

double potential_of(const World &world, double potential) {
    const Particles &p = world.particles;
    const Vector &g = world.constants.gravity;
    const double reference = g.norm() * world.ledger.reference_height;
    for (int64_t i = 0; i < p.count; ++i)
        potential += world.material_of(i).density * p.volume * (-g.x() * p.x[i] - g.y() * p.y[i] - reference);
    return potential;
}

} // namespace

EnergySums::EnergySums(const World &world) {
    sums_.potential = world.ledger.level;
}

void EnergySums::add(const World &world) {
    const Particles &p = world.particles;
    const auto elastic = energy_of(world.constants.scheme);
    Energies e = sums_;
    e.potential = potential_of(world, e.potential);
    for (int64_t i = 0; i < p.count; ++i) {
        const MaterialConstants &m = world.material_of(i);
        e.kinetic += 0.5 * (m.density * p.volume) * (p.vx[i] * p.vx[i] + p.vy[i] * p.vy[i]);
        e.elastic += p.volume * elastic(p, m, i);
    }
    sums_ = e;
}

Energies measure_energies(const World &world) {
    EnergySums sums(world);
    for_each_stretch(world, {}, [&](const World &stretch, const char *) { sums.add(stretch); });
    Energies e = sums.all();
    tell_all(world.crossing, &e);
    return e;
}

namespace {

// From here on the potential counts from the lowest face of the material.
void count_from_lowest(World &world) {
    const Particles &p = world.particles;
    const Vector &g = world.constants.gravity;
    Ledger &ledger = world.ledger;
    ledger.reference_height = 0;
    if (g.norm() > 0) {
        const Vector up = -g.normalized();
        double lowest = INFINITY;
        for (int64_t i = 0; i < p.count; ++i)
            lowest = std::min(lowest, up.dot(Vector(p.x[i], p.y[i])));
        if (double highest = -lowest; world.crossing) {
            world.crossing->combine(&highest, 1, nullptr, 0);
            lowest = -highest;
        }
        if (lowest < INFINITY)
            ledger.reference_height = lowest - 0.5 * world.constants.spacing;
    }
    ledger.level = 0;
}

} // namespace

void open_ledger(World &world) {
    count_from_lowest(world);
    const Energies e = measure_energies(world);
    world.ledger.initial = world.ledger.scale = e.sum();
    world.ledger.largest_kinetic = e.kinetic;
}

namespace {

// The particles that are the farthest along gravity and across it: all that a fall is told from. Of all processes.
void find_farthest(const World &world, const Vector &gravity, std::vector<double> &x, std::vector<double> &y) {
    const Particles &p = world.particles;
    const Vector along = gravity.norm() > 0 ? gravity.normalized() : Vector(0, -1);
    std::vector<double> own_x, own_y;
    for (const Vector &way : {along, Vector(-along), Vector(-along.y(), along.x()), Vector(along.y(), -along.x())}) {
        int64_t farthest = 0;
        for (int64_t i = 1; i < p.count; ++i)
            if (way.dot(Vector(p.x[i], p.y[i])) > way.dot(Vector(p.x[farthest], p.y[farthest])))
                farthest = i;
        if (p.count > 0) {
            own_x.push_back(p.x[farthest]);
            own_y.push_back(p.y[farthest]);
        }
    }
    world.crossing->gather_everywhere(own_x, x);
    world.crossing->gather_everywhere(own_y, y);
}

void fall_by(World &world, const Vector &gravity, const Energies &before) {
    const Particles &p = world.particles;
    if (world.crossing) {
        std::vector<double> x, y;
        find_farthest(world, gravity, x, y);
        world.scene->set_fall(world.constants, gravity, [&](const auto &visit) {
            for (std::size_t k = 0; k < x.size(); ++k)
                visit(Vector(x[k], y[k]));
        });
    } else {
        world.scene->set_fall(world.constants, gravity, [&](const auto &visit) {
            for (int64_t i = 0; i < p.count; ++i)
                visit(Vector(p.x[i], p.y[i]));
        });
    }
    count_from_lowest(world);
    const double potential = measure_energies(world).potential;
    Ledger &ledger = world.ledger;
    ledger.level = before.potential - potential;
    ledger.scale = before.kinetic + before.elastic + potential;
    ledger.largest_kinetic = before.kinetic;
}

} // namespace

void change_gravity(World &world, const Vector &gravity) {
    const Energies before = measure_energies(world);
    Constants constants = world.constants;
    const Ledger ledger = world.ledger;
    try {
        fall_by(world, gravity, before);
    } catch (...) { // the first process lacks memory to measure
        world.constants = std::move(constants);
        world.ledger = ledger;
        throw;
    }
    world.unbalanced_share = 1; // nobody knows yet what still bears
}

} // namespace gp
