#include "ledger.hpp"

#include <algorithm>
#include <cmath>

#include "material/compression.hpp"

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

double measure_potential(const World &world) {
    const Particles &p = world.particles;
    const Vector &g = world.constants.gravity;
    const double reference = g.norm() * world.ledger.reference_height;
    double potential = world.ledger.level;
    for (int64_t i = 0; i < p.count; ++i)
        potential += world.material_of(i).density * p.volume * (-g.x() * p.x[i] - g.y() * p.y[i] - reference);
    return potential;
}

} // namespace

Energies measure_energies(const World &world) {
    const Particles &p = world.particles;
    const auto elastic = energy_of(world.constants.scheme);
    Energies e;
    e.potential = measure_potential(world);
    for (int64_t i = 0; i < p.count; ++i) {
        const MaterialConstants &m = world.material_of(i);
        e.kinetic += 0.5 * (m.density * p.volume) * (p.vx[i] * p.vx[i] + p.vy[i] * p.vy[i]);
        e.elastic += p.volume * elastic(p, m, i);
    }
    return e;
}

namespace {

// From here on the potential counts from the lowest face of the material.
void count_from_lowest(World &world) {
    const Particles &p = world.particles;
    const Vector &g = world.constants.gravity;
    Ledger &ledger = world.ledger;
    ledger.reference_height = 0;
    if (p.count > 0 && g.norm() > 0) {
        const Vector up = -g.normalized();
        double lowest = INFINITY;
        for (int64_t i = 0; i < p.count; ++i)
            lowest = std::min(lowest, up.dot(Vector(p.x[i], p.y[i])));
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

void change_gravity(World &world, const Vector &gravity) {
    const Energies before = measure_energies(world);
    const Particles &p = world.particles;
    world.scene->set_fall(world.constants, gravity, p.x.data(), p.y.data(), p.count);
    count_from_lowest(world);
    const double potential = measure_potential(world);
    Ledger &ledger = world.ledger;
    ledger.level = before.potential - potential;
    ledger.scale = before.kinetic + before.elastic + potential;
    ledger.largest_kinetic = before.kinetic;
    world.unbalanced_share = 1; // nobody knows yet what still bears
}

} // namespace gp
