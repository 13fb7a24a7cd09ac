// What changes a particle's velocity after the step's forces have moved it: friction of side walls, collisions.
#pragma once

#include "world.hpp"

namespace gp::stages {

// Changes the velocity of particle i by (du, dv), and its position as if the step had had that velocity. Returns the work
// per mass. Forces are accounted for at the mean velocity of the step, pushes included: what that leaves for a push is its
// work at the mean of the velocities before and after it, less half the acceleration's share.
inline double push_particle(Particles &p, int64_t i, double du, double dv, double dt) {
    const double work = du * (p.vx[i] + 0.5 * (du - dt * p.ax[i])) + dv * (p.vy[i] + 0.5 * (dv - dt * p.ay[i]));
    p.vx[i] += du;
    p.vy[i] += dv;
    p.push_x[i] += du;
    p.push_y[i] += dv;
    p.x[i] += dt * du;
    p.y[i] += dt * dv;
    return work;
}

// Gives a contact's particle the velocity change (relative to nothing: the lab's) that its plate causes in this step.
inline void push_by_plate(World &world, const Contact &contact, const Vector &change) {
    Particles &p = world.particles;
    const int64_t i = contact.particle;
    const double mass = world.material_of(i).density * p.volume;
    const Vector load = -mass / world.clock.dt * change;
    world.walls.add_load(contact.facet, {p.x[i], p.y[i]}, load);
    if (world.sleep.in_use)
        world.sleep.pushed[&contact - world.walls.contacts.data()] += load;
    const double plate_power_on_material = mass * change.dot(world.walls.velocity_at(contact.facet, {p.x[i], p.y[i]}));
    world.ledger.plate_work -= plate_power_on_material;
    world.ledger.dissipated +=
        plate_power_on_material - mass * push_particle(p, i, change.x(), change.y(), world.clock.dt);
}

} // namespace gp::stages
