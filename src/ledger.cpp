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

Energies measure_energies(const World &world) {
    const Particles &p = world.particles;
    const Vector &g = world.constants.gravity;
    const auto elastic = energy_of(world.constants.scheme);
    Energies e;
    e.potential = world.ledger.wound;
    for (int64_t i = 0; i < p.count; ++i) {
        const MaterialConstants &m = world.material_of(i);
        const double mass = m.density * p.volume;
        e.kinetic += 0.5 * mass * (p.vx[i] * p.vx[i] + p.vy[i] * p.vy[i]);
        e.potential += mass * (-g.x() * p.x[i] - g.y() * p.y[i] - g.norm() * world.ledger.reference_height);
        e.elastic += p.volume * elastic(p, m, i);
    }
    return e;
}

void open_ledger(World &world) {
    const Particles &p = world.particles;
    const Vector &g = world.constants.gravity;
    if (p.count > 0 && g.norm() > 0) {
        const Vector up = -g.normalized();
        double lowest = INFINITY;
        for (int64_t i = 0; i < p.count; ++i)
            lowest = std::min(lowest, up.dot(Vector(p.x[i], p.y[i])));
        world.ledger.reference_height = lowest - 0.5 * world.constants.spacing;
    }
    const Energies e = measure_energies(world);
    world.ledger.initial = e.sum();
    world.ledger.largest_kinetic = e.kinetic;
}

} // namespace gp
