// What plates do to single particles after the step: the guarantee that nothing passes through. Runs over the contacts in
// their order; contacts are few.
#include <algorithm>
#include <cmath>

#include "awake.hpp"
#include "stages/push.hpp"
#include "stages/stages.hpp"
#include "stages/wall_law.hpp"

namespace gp::stages {

namespace {

// Where the particle is by now, for the plate as it was placed when the step began.
GP_INLINE Vector place_over(const World &world, const Contact &contact) {
    const Particles &p = world.particles;
    const Walls &w = world.walls;
    const Vector now = w.nearest_image(w.facets[contact.facet].segment, {p.x[contact.particle], p.y[contact.particle]});
    return now - world.clock.dt * w.plate_of(contact.facet).velocity_at(now);
}

// The friction of a blow that stops `approach` within the step, under the blow's pressure on the particle's width. (With
// mu_s, fronts of grains without stress ran on: a column with a = .7 on an incline of 16 degrees had 98 % of its mass within
// 1.34 m, with this .84 m.)
double friction_of_blow(const World &world, const Contact &contact, double approach, const SurfaceRate &rate,
                        double slip) {
    const double mass = world.material_of(contact.particle).density * world.constants.spacing; // kg/m2
    const ReturnMap &law = world.map_of(contact.particle);
    const double material = friction_left(law, law.half_rate(mass * approach / world.clock.dt), rate, slip, approach);
    return wall_friction_bound(*world.walls.facets[contact.facet].spec, material);
}

} // namespace

void wall_contact(World &world) {
    const Particles &p = world.particles;
    const double nearest = contact_distance * world.constants.spacing;
    for_each_awake_contact(world, [&](const Contact &contact) {
        const Segment &s = world.walls.facets[contact.facet].segment;
        const int64_t i = contact.particle;
        const Vector at = place_over(world, contact);
        if (s.distance(at) >= nearest || !world.walls.faces(contact.facet, at))
            return;
        const Vector relative = Vector(p.vx[i], p.vy[i]) - world.walls.velocity_at(contact.facet, at);
        const double approach = -s.normal.dot(relative);
        if (approach <= 0)
            return;
        const double slip = s.tangent.dot(relative);
        const double mu = friction_of_blow(world, contact, approach, {rate_per_slip(s, at, world.constants.spacing), 0},
                                           std::abs(slip));
        const double stop = std::min(std::abs(slip), mu * approach);
        push_by_plate(world, contact, approach * s.normal + (slip > 0 ? -stop : stop) * s.tangent);
    });
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
    const Segment &s = world.walls.facets[contact.facet].segment;
    const Vector at = place_over(world, contact);
    if (!world.walls.faces(contact.facet, at))
        return;
    const Vector present =
        Vector(p.vx[contact.particle], p.vy[contact.particle]) - world.walls.velocity_at(contact.facet, at);
    const Vector expected = present + ahead;
    const double dt = world.clock.dt, away = s.normal.dot(expected), slip = s.tangent.dot(expected);
    const double nearest = contact_distance * world.constants.spacing;
    const double gap = s.distance(at) - dt * s.normal.dot(present) - nearest; // when the step began
    const double least = -std::max(0.0, gap) / dt;                            // of away
    const double pressed = std::max(0.0, contact.held_normal + least - away);
    const double most =
        friction_of_blow(world, contact, pressed, {0, 0}, 0) * pressed; // mu_s: the solve has the rate's part
    const double dragged = std::clamp(contact.held_tangential - slip, -most, most);
    const Vector change = (pressed - contact.held_normal) * s.normal + (dragged - contact.held_tangential) * s.tangent;
    if (change == Vector::Zero())
        return;
    push_by_plate(world, contact, change);
    contact.held_normal = pressed;
    contact.held_tangential = dragged;
}

} // namespace

void wall_support(World &world) {
    if (world.walls.contacts.empty() && !world.crossing) // where there are others, they may have some, and wait
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
