// What a plate takes from the material is the sum of Q s over the rows that see its ghosts: their mean stress, as it is about a
// spacing inside, in place of that at the plate. On a floor, where the pressure grows by the weight, this is too little by a
// spacing over the depth. So these rows' yield stress goes by a pressure that is larger by the weight of as much material, in
// proportion to Q.
#include "stages/yield_pressure.hpp"

#include <algorithm>
#include <cmath>

#include "kernel.hpp"

namespace gp::stages {

namespace {

// Over a lattice that ends at a plate: sum of Q y / sum of Q^2 over one column of particles, where y is a particle's
// distance from the plate and Q = sum of w (way across the plate) over the ghosts that it sees.
double lever_of_lattice(double horizon, double spacing) {
    const int reach = static_cast<int>(std::ceil(horizon / spacing));
    double first = 0, second = 0;
    for (int row = 0; row < reach; ++row) {
        double q = 0;
        for (int down = row + 1; down <= reach; ++down)
            for (int along = -reach; along <= reach; ++along)
                q += down * spacing * weight(spacing * std::hypot(down, along), 1.0 / horizon);
        first += q * (row + 0.5) * spacing;
        second += q * q;
    }
    return first / second;
}

} // namespace

void find_yield_pressure(World &world) {
    const Particles &p = world.particles;
    const Walls &w = world.walls;
    const Constants &c = world.constants;
    ViscousSystem &v = world.viscous;
    if (v.lever == 0)
        v.lever = lever_of_lattice(c.horizon, c.spacing);
    v.pressure.resize(p.count);
    std::copy(p.pressure.begin(), p.pressure.begin() + p.count, v.pressure.begin());
    if (!w.in_reach())
        return;
    for (const Contact &contact : w.contacts) {
        const Vector &n = w.plates[contact.plate].segment().normal;
        const int64_t i = contact.particle;
        if (p.pressure[i] <= 0)
            continue;
        double q = 0;
        for (int64_t k = contact.begin; k < contact.end; ++k) {
            const int32_t g = w.ghost_of_contact[k];
            const Vector way(w.ghost_x[g] - p.x[i], w.ghost_y[g] - p.y[i]);
            q -= weight(way.norm(), 1.0 / c.horizon) * way.dot(n);
        }
        const double weight_of_lever = -p.density[i] * c.gravity.dot(n) * v.lever * q;
        v.pressure[i] = std::max(0.0, v.pressure[i] + weight_of_lever);
    }
}

} // namespace gp::stages
