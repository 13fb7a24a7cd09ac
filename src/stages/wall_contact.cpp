// What plates do to single particles after the step: Coulomb friction, and the guarantee that nothing passes through.
// Both run over the contacts in their order; contacts are few.
#include <algorithm>
#include <cmath>

#include "stages/push.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

// Gives particle i the velocity change (relative to nothing: the lab's) that a plate causes in this step.
void push(World &world, const Contact &contact, const Vector &change) {
    Particles &p = world.particles;
    const int64_t i = contact.particle;
    const double mass = world.material_of(i).density * p.volume;
    world.walls.add_load(contact.plate, {p.x[i], p.y[i]}, -mass / world.clock.dt * change);
    const double plate_power_on_material = mass * change.dot(world.walls.plates[contact.plate].velocity());
    world.ledger.plate_work -= plate_power_on_material;
    world.ledger.dissipated +=
        plate_power_on_material - mass * push_particle(p, i, change.x(), change.y(), world.clock.dt);
}

} // namespace

void wall_friction(World &world) {
    const Particles &p = world.particles;
    for (const Contact &contact : world.walls.contacts) {
        const Plate &plate = world.walls.plates[contact.plate];
        if (plate.spec().friction != GP_WALL_COULOMB)
            continue;
        const int64_t i = contact.particle;
        const Segment &s = plate.segment();
        const double normal = s.normal.x() * contact.force_x + s.normal.y() * contact.force_y;
        const double slip = s.tangent.dot(Vector(p.vx[i], p.vy[i]) - plate.velocity());
        const double most = plate.spec().wall_mu * normal * world.clock.dt / world.material_of(i).density;
        const double stop = std::min(std::abs(slip), most); // friction can hold, not drive
        if (stop > 0)
            push(world, contact, (slip > 0 ? -stop : stop) * s.tangent);
    }
}

void wall_contact(World &world) {
    const Particles &p = world.particles;
    const double nearest = contact_distance * world.constants.spacing;
    for (const Contact &contact : world.walls.contacts) {
        const Plate &plate = world.walls.plates[contact.plate];
        const Segment &s = plate.segment();
        const int64_t i = contact.particle;
        const Vector moved = world.clock.dt * plate.velocity(); // of the plate in this step
        const Vector at = world.walls.nearest_image(plate, {p.x[i], p.y[i]}) - moved;
        if (s.distance(at) >= nearest || !s.covers(s.along(at), 0.0))
            continue;
        const Vector relative = Vector(p.vx[i], p.vy[i]) - plate.velocity();
        const double approach = -s.normal.dot(relative);
        if (approach <= 0)
            continue;
        // The blow's friction: that of the material itself on a rough plate.
        const double mu = plate.spec().friction == GP_WALL_NO_SLIP ? world.map_of(i).mu_s : plate.spec().wall_mu;
        const double slip = s.tangent.dot(relative);
        const double stop = std::min(std::abs(slip), mu * approach);
        push(world, contact, approach * s.normal + (slip > 0 ? -stop : stop) * s.tangent);
    }
}

} // namespace gp::stages
