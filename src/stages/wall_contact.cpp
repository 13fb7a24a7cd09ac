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

namespace {

// Shear rate between a plate's surface and a particle: the gradient's is a mean over the horizon, by which thin layers were
// braked by up to 10 % too little.
double rate_at(const Segment &s, const Vector &at, double slip, double spacing) {
    return std::abs(slip) / std::max(s.distance(at), contact_distance * spacing);
}

// Shear traction of a plate over its normal one. On a rough plate that of the material on planes along the plate, at the
// yield mu(I) p of the rate at the surface and in the direction of the particle's own deviator s: what stretches along the
// plate as well has less left to shear. (With mu(I) in full, R90 of the collapse with a = 1.25 is 22, 9, 2 % too small at
// L/dl = 16, 32, 64.)
//
// The rate is that of the velocities that the step's stresses are made of: with the slip that their forces leave before the
// friction, row 1 of a shear box slipped by 5 % too little. At the surface it is beyond the mean as far as to the particle by
// half of what that is beyond the gradient's at the particle: by all of it where the rate is linear and the gradient exact
// (chute, 40 rows: the plug -2.3 % with all, +.2 % with half, +4.6 % with none).
double wall_ratio(const World &world, const Contact &contact) {
    const Plate &plate = world.walls.plates[contact.plate];
    if (plate.spec().friction != GP_WALL_NO_SLIP)
        return plate.spec().wall_mu;
    const Particles &p = world.particles;
    const int64_t i = contact.particle;
    const Segment &s = plate.segment();
    const Vector at = world.walls.nearest_image(plate, {p.x[i], p.y[i]});
    const Vector velocity(p.vx[i] - world.clock.dt * p.ax[i], p.vy[i] - world.clock.dt * p.ay[i]);
    const double slip = s.tangent.dot(velocity - plate.velocity());
    Tensor l;
    l << p.lxx[i], p.lxy[i], p.lyx[i], p.lyy[i];
    const double mean = rate_at(s, at, slip, world.constants.spacing);
    const double rate = mean + 0.5 * (mean - (slip > 0 ? 1 : -1) * s.tangent.dot(l * s.normal));
    const double mu = world.map_of(i).friction(rate, p.pressure[i]); // mu_s for a negative rate
    Tensor deviator;
    deviator << p.sxx[i], p.sxy[i], p.sxy[i], -p.sxx[i];
    const Vector traction = deviator * s.normal;
    const double shear = mu * std::abs(s.tangent.dot(traction));
    const double normal = equivalent_stress({p.sxx[i], p.sxy[i]}) - mu * s.normal.dot(traction);
    return normal > 0 ? shear / normal : mu;
}

} // namespace

void wall_friction(World &world) {
    const Particles &p = world.particles;
    const bool by_stress = world.constants.scheme != Scheme::adjoint; // rough plates: part of the implicit solve
    for (const Contact &contact : world.walls.contacts) {
        const Plate &plate = world.walls.plates[contact.plate];
        const int32_t friction = plate.spec().friction;
        if (friction == GP_WALL_FREE_SLIP || (friction == GP_WALL_NO_SLIP && by_stress))
            continue;
        const int64_t i = contact.particle;
        const Segment &s = plate.segment();
        const double normal = s.normal.x() * contact.force_x + s.normal.y() * contact.force_y;
        const double slip = s.tangent.dot(Vector(p.vx[i], p.vy[i]) - plate.velocity());
        const double most = wall_ratio(world, contact) * normal * world.clock.dt / world.material_of(i).density;
        const double stop = std::min(std::abs(slip), most); // friction can hold, not drive
        if (stop <= 0)
            continue;
        const double before = world.ledger.dissipated;
        push(world, contact, (slip > 0 ? -stop : stop) * s.tangent);
        // The plastic part has counted the shear towards the ghosts of a rough plate already; that is taken off the walls'.
        if (friction == GP_WALL_NO_SLIP)
            world.ledger.walls += world.ledger.dissipated - before;
    }
}

namespace {

// Where the particle is by now, for the plate as it was placed when the step began.
Vector place_over(const World &world, const Contact &contact) {
    const Particles &p = world.particles;
    const Plate &plate = world.walls.plates[contact.plate];
    return world.walls.nearest_image(plate, {p.x[contact.particle], p.y[contact.particle]}) -
           world.clock.dt * plate.velocity();
}

// The friction of a blow that stops `approach` within the step: that of the material itself on a rough plate, under the
// blow's pressure on the particle's width. (With mu_s, fronts of grains without stress ran on: a column with a = .7 on an
// incline of 16 degrees had 98 % of its mass within 1.34 m, with this .84 m.)
double friction_of_blow(const World &world, const Contact &contact, double approach, double rate) {
    const PlateSpec &spec = world.walls.plates[contact.plate].spec();
    if (spec.friction != GP_WALL_NO_SLIP)
        return spec.wall_mu;
    const double mass = world.material_of(contact.particle).density * world.constants.spacing; // kg/m2
    return world.map_of(contact.particle).friction(rate, mass * approach / world.clock.dt);
}

} // namespace

void wall_contact(World &world) {
    const Particles &p = world.particles;
    const double nearest = contact_distance * world.constants.spacing;
    for (const Contact &contact : world.walls.contacts) {
        const Plate &plate = world.walls.plates[contact.plate];
        const Segment &s = plate.segment();
        const int64_t i = contact.particle;
        const Vector at = place_over(world, contact);
        if (s.distance(at) >= nearest || !world.walls.faces(contact.plate, at))
            continue;
        const Vector relative = Vector(p.vx[i], p.vy[i]) - plate.velocity();
        const double approach = -s.normal.dot(relative);
        if (approach <= 0)
            continue;
        const double slip = s.tangent.dot(relative);
        const double mu = friction_of_blow(world, contact, approach, rate_at(s, at, slip, world.constants.spacing));
        const double stop = std::min(std::abs(slip), mu * approach);
        push(world, contact, approach * s.normal + (slip > 0 ? -stop : stop) * s.tangent);
    }
}

// What a plate does to a particle in a step of the implicit scheme is one impulse, found before the solve for what the stress
// before the step is about to do, and corrected after the solve and the collisions: N >= 0 so that the particle does not come
// nearer than the contact distance, or than it was, and friction of up to mu N against its slip. What the step lifts by less
// than the plate has borne stays on the plate, and what it drags along by less than the friction left stays where it is.
//
// A grain at the tip of a deposit has no stress of its own, and its neighbours' stress, which does not become less with delta,
// draws at it. With a blow of its own after the solve, as above, it was lifted step by step, with nothing to press it back
// within the height of a step's fall, then fell freely for a step (g dt: 6e-8 of the initial energy of the collapse with a =
// 1.25, L/dl = 16); and as it did not approach, no friction held it. Without regard to that stress it slipped in the solve at
// some mu g dt before it was stopped: its neighbours followed, or were hit by it and went to and fro (8e-11 instead of 1e-13,
// horizon 3, delta 1e-5).
namespace {

// ahead: change of velocity that is still to be expected in this step.
void hold(World &world, Contact &contact, const Vector &ahead) {
    const Particles &p = world.particles;
    const Plate &plate = world.walls.plates[contact.plate];
    const Segment &s = plate.segment();
    const Vector at = place_over(world, contact);
    if (!world.walls.faces(contact.plate, at))
        return;
    const Vector present = Vector(p.vx[contact.particle], p.vy[contact.particle]) - plate.velocity();
    const Vector expected = present + ahead;
    const double dt = world.clock.dt, away = s.normal.dot(expected), slip = s.tangent.dot(expected);
    const double nearest = contact_distance * world.constants.spacing;
    const double gap = s.distance(at) - dt * s.normal.dot(present) - nearest; // when the step began
    const double least = -std::max(0.0, gap) / dt;                            // of away
    const double pressed = std::max(0.0, contact.held_normal + least - away);
    const double most = friction_of_blow(world, contact, pressed, 0) * pressed; // mu_s: the solve has the rate's part
    const double dragged = std::clamp(contact.held_tangential - slip, -most, most);
    const Vector change = (pressed - contact.held_normal) * s.normal + (dragged - contact.held_tangential) * s.tangent;
    if (change == Vector::Zero())
        return;
    push(world, contact, change);
    contact.held_normal = pressed;
    contact.held_tangential = dragged;
}

} // namespace

void wall_support(World &world) {
    if (world.walls.contacts.empty())
        return;
    viscous_forecast(world);
    const VectorField &force = world.viscous.force;
    for (Contact &contact : world.walls.contacts) {
        const int64_t i = contact.particle;
        contact.held_normal = contact.held_tangential = 0;
        hold(world, contact, world.clock.dt / world.material_of(i).density * Vector(force.x[i], force.y[i]));
    }
}

void wall_hold(World &world) {
    for (Contact &contact : world.walls.contacts)
        hold(world, contact, Vector::Zero());
}

} // namespace gp::stages
