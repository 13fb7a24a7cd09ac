// The shear traction of plates on what slips along them (wall_law.hpp). Friction can hold, not drive.
//
// What a particle's plates take off its slip follows from its own state: in the default scheme the loop over forces finds it, for the
// particles that it has at hand, and the stage wall_friction gives it to them, and the reaction to the plates and the ledger, contact
// by contact in their order; contacts are few. (All of it there was 5 % of a step of 1 000 particles, done by one thread; a loop of
// its own brought two threads little, since the contacts of a floor are in the cache of the one that has the lowest rows.)
//
// A stress or a stress ratio carried on through the surface by ghosts, and the zero-energy penalty towards them, braked a
// sliding layer of 2, 3, 6, 10 rows with 1.11, 1.14, 1.09, 1.05 of mu times its weight, and put 18 % too much on the rough walls
// of a silo; the run-out of a collapse erred by 15 % at L/dl = 32 for it, and depended on the horizon.
#include "awake.hpp"
#include "stages/push.hpp"
#include "stages/rows.hpp"
#include "stages/stages.hpp"
#include "stages/wall_law.hpp"

namespace gp::stages {

namespace {

// Where a particle is at the end of the step, m, and how fast it moves, m/s: by what has acted on it so far.
struct Course {
    double x, y, u, v;
};

// Where the particle was when the step began.
GP_INLINE Vector place_before(const World &world, const Contact &contact, const Course &course) {
    const double dt = world.clock.dt;
    return world.walls.nearest_image(world.walls.facets[contact.facet].segment,
                                     {course.x - dt * course.u, course.y - dt * course.v});
}

double rate_per_slip_of(const World &world, const Contact &contact, const Course &course) {
    return rate_per_slip(world.walls.facets[contact.facet].segment, place_before(world, contact, course),
                         world.constants.spacing);
}

// Between surface and particle the mean rate is slip over distance, y; of a curved profile that is the rate at y/2. The gradient
// that the particle's neighbours make, all on one side, is the rate further inside; so the difference tells the curvature, and
// the rate at the surface (OneSidedSlope in kernel.hpp). It is exact for a parabola. The paper's schemes take no gradient without
// ghosts, and have the mean rate. direction: 1 or -1, of the slip along the tangent.
GP_INLINE SurfaceRate surface_rate(const World &world, const Contact &contact, const Course &course, double direction) {
    const Constants &c = world.constants;
    const int64_t i = contact.particle;
    const Segment &s = world.walls.facets[contact.facet].segment;
    const Vector at = place_before(world, contact, course);
    if (by_number_density(c.scheme))
        return {rate_per_slip(s, at, c.spacing), 0};
    const double share = c.one_sided.share(s.distance(at) / c.horizon);
    const double inside = direction * s.tangent.dot(inner_gradient(world, i) * s.normal);
    return {(1 + share) * rate_per_slip(s, at, c.spacing), -share * inside};
}

// The part of a particle's shear rate along the plate that loads its stress; the rest is plastic, by the granular fluidity. It is
// taken to be the same between particle and plate, where friction is of the plastic part. With friction of the whole rate the
// first rows were tied to the plate whenever the fluidity was low, and a plate dragged at .3 mm/s stuck and slipped without end,
// 39 to 56 Pa (the law has 47.4, the layer in one dimension comes to rest at that within a second).
double elastic_rate(const World &world, const Contact &contact) {
    const Particles &p = world.particles;
    const int64_t i = contact.particle;
    const Segment &s = world.walls.facets[contact.facet].segment;
    const Vector &n = s.normal, &t = s.tangent;
    const double xx = n.x() * t.x() - n.y() * t.y(), xy = n.x() * t.y() + n.y() * t.x();
    const double rate = (p.lxx[i] - p.lyy[i]) * xx + (p.lxy[i] + p.lyx[i]) * xy;
    return rate - p.fluidity[i] * (p.sxx[i] * xx + p.sxy[i] * xy) / p.pressure[i];
}

// Shear over normal traction that a particle's material bears on planes along the plate, at the yield mu p of the rate at the
// surface. What stretches along the plate as well has less left to shear: of the deviator s at yield, its part s_nn across
// the plate is the particle's own (the material's, not the wall's); with mu N in full, R90 of the collapse with a = 1.25 is
// 24, 10 % too small at L/dl = 16, 32. Inside the yield surface it may shear until it is there.
struct RoughShare {
    double whole = 0, across = 0, shear = 0; // Pa: |s| at yield, s_nn, what is left to shear

    RoughShare(const World &world, const Contact &contact) {
        const Particles &p = world.particles;
        const int64_t i = contact.particle;
        const Vector &n = world.walls.facets[contact.facet].segment.normal;
        across = p.sxx[i] * (n.x() * n.x() - n.y() * n.y()) + 2 * p.sxy[i] * n.x() * n.y();
        whole = std::max(equivalent_stress({p.sxx[i], p.sxy[i]}), world.map_of(i).mu_s * p.pressure[i]);
        const double shear2 = whole * whole - across * across;
        shear = shear2 > 0 ? std::sqrt(shear2) : 0.0;
    }
    double of(double mu) const {
        const double normal = whole - mu * across;
        return normal > 0 ? mu * shear / normal : mu; // mu: free of stress
    }
};

// The velocity along the plate's tangent that friction gives a contact's particle, m/s. A function of its own, of numbers: what a
// compiler takes together with the products that these are made of is rounded otherwise.
template <bool Fluid>
__attribute__((noinline)) double friction_of(const World &world, const Contact &contact, double x, double y, double u,
                                             double v) {
    const Course course{x, y, u, v};
    const Facet &facet = world.walls.facets[contact.facet];
    const bool rough = passes_shear(facet);
    // Rough plates in the paper's schemes: by their ghosts.
    if (facet.spec->friction == GP_WALL_FREE_SLIP || (rough && world.constants.scheme != Scheme::adjoint))
        return 0;
    const Particles &p = world.particles;
    const int64_t i = contact.particle;
    const Segment &s = facet.segment;
    const double normal = s.normal.x() * contact.force_x + s.normal.y() * contact.force_y;
    if (normal <= 0)
        return 0;
    const double slip =
        s.tangent.dot(Vector(course.u, course.v) - world.walls.velocity_at(contact.facet, {course.x, course.y}));
    if (slip == 0)
        return 0;
    const double direction = slip > 0 ? 1 : -1;
    // A particle without stress of its own is under what its plate presses it with.
    const double pressure = std::max(p.pressure[i], normal * world.constants.spacing);
    const double once = normal * world.clock.dt / world.material_of(i).density; // m/s, of friction 1
    const ReturnMap &law = world.map_of(i);
    const SurfaceRate rate = surface_rate(world, contact, course, direction);
    const double half = law.half_rate(pressure);
    const RoughShare share(world, contact);
    const auto ratio_of = [&](double mu) { return rough ? share.of(mu) : wall_friction_bound(*facet.spec, mu); };
    const bool fluid = Fluid && world.is_fluid(i) && p.pressure[i] > 0;
    // Between plate and particle: of the fluidity, and of the plastic rate.
    const double between = fluid ? (facet.spec->fluidity == GP_FLUIDITY_ZERO ? 0.5 : 1.0) * p.fluidity[i] : 0.0;
    const SurfaceRate mean_rate{fluid ? rate_per_slip_of(world, contact, course) : 0.0,
                                fluid ? -direction * elastic_rate(world, contact) : 0.0};
    // The share of mu that acts along the plate depends on mu itself, weakly.
    double mu = law.mu_s;
    for (int pass = 0; pass < 2; ++pass) {
        const double per_mu = once * ratio_of(mu) / std::max(mu, 1e-300);
        mu = fluid ? fluid_friction_left(law, between, mean_rate, std::abs(slip), per_mu)
                   : friction_left(law, half, rate, std::abs(slip), per_mu);
    }
    const double stop = std::min(std::abs(slip), ratio_of(mu) * once);
    return stop <= 0 ? 0.0 : -direction * stop;
}

using FrictionOf = double (*)(const World &, const Contact &, double, double, double, double);

FrictionOf friction_in(const World &world) {
    return world.constants.fluid ? friction_of<true> : friction_of<false>;
}

} // namespace

void find_friction(World &world, int64_t begin, int64_t end) {
    Walls &w = world.walls;
    if (!w.in_reach() || w.contact_start[begin] == w.contact_start[end])
        return;
    const Particles &p = world.particles;
    const double dt = world.clock.dt;
    const FrictionOf friction = friction_in(world);
    for (int64_t i = begin; i < end; ++i) {
        const int64_t first = w.contact_start[i], last = w.contact_start[i + 1];
        if (first == last)
            continue;
        // As integrate is about to move it, and then one plate after the other.
        double u = p.vx[i] + dt * p.ax[i], v = p.vy[i] + dt * p.ay[i];
        double x = p.x[i] + dt * u, y = p.y[i] + dt * v;
        for (int64_t k = first; k < last; ++k) {
            Contact &contact = w.contacts[k];
            contact.held_tangential = friction(world, contact, x, y, u, v);
            if (k + 1 == last || contact.held_tangential == 0)
                continue;
            const Vector change = contact.held_tangential * w.facets[contact.facet].segment.tangent;
            u += change.x();
            v += change.y();
            x += dt * change.x();
            y += dt * change.y();
        }
    }
}

void wall_friction(World &world) {
    const Particles &p = world.particles;
    const bool is_found = world.constants.scheme == Scheme::adjoint;
    const FrictionOf friction = friction_in(world);
    for_each_awake_contact(world, [&](const Contact &contact) {
        const int64_t i = contact.particle;
        const double change =
            is_found ? contact.held_tangential : friction(world, contact, p.x[i], p.y[i], p.vx[i], p.vy[i]);
        if (change == 0)
            return;
        const Facet &facet = world.walls.facets[contact.facet];
        const double before = world.ledger.dissipated;
        push_by_plate(world, contact, change * facet.segment.tangent);
        // The plastic part has counted the shear towards the ghosts of a rough plate already; that is taken off the walls'.
        if (passes_shear(facet))
            world.ledger.walls += world.ledger.dissipated - before;
    });
}

} // namespace gp::stages
