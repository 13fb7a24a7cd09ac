// Closes the step's books: energy ledger, loads, and the extremes that the next step's size follows from.
#include <algorithm>
#include <cmath>

#include "awake.hpp"
#include "parts.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

struct VelocityRange {
    Vector low, high; // m/s
};

// Velocities of a plate's surface where it may meet material. about: the box in which it does.
VelocityRange velocities_of(const Plate &plate, const Box &about) {
    const Motion &motion = plate.motion();
    VelocityRange range{motion.velocity, motion.velocity};
    if (motion.omega != 0) {
        const Vector pivot = plate.pivot();
        const double far = plate.spec().farthest;
        for (const double x : {std::clamp(about.x_min, pivot.x() - far, pivot.x() + far),
                               std::clamp(about.x_max, pivot.x() - far, pivot.x() + far)})
            for (const double y : {std::clamp(about.y_min, pivot.y() - far, pivot.y() + far),
                                   std::clamp(about.y_max, pivot.y() - far, pivot.y() + far)}) {
                const Vector velocity = plate.velocity_at({x, y});
                range.low = range.low.cwiseMin(velocity);
                range.high = range.high.cwiseMax(velocity);
            }
    }
    if (const double belt = std::abs(plate.spec().surface_velocity); belt > 0) {
        range.low -= Vector(belt, belt);
        range.high += Vector(belt, belt);
    }
    return range;
}

// Where material may meet plates until the next lists: of a periodic scene, at any x.
Box box_of_contacts(const World &world) {
    Box box = world.box;
    const double margin = world.constants.reach + world.skin;
    box = {box.x_min - margin, box.x_max + margin, box.y_min - margin, box.y_max + margin};
    if (world.constants.period) {
        box.x_min = -INFINITY;
        box.x_max = INFINITY;
    }
    return box;
}

// Velocities, kinetic energy and what is not balanced, of each block.
void measure_blocks(World &world) {
    const Particles &p = world.particles;
    const double threshold = rest_acceleration * world.constants.gravity.norm(), threshold2 = threshold * threshold;
    const double inverse_dt = world.clock.dt > 0 ? 1.0 / world.clock.dt : 0.0;
    for_each_awake_block(world, [&](int64_t block, int64_t begin, int64_t end) {
        BlockRange range{INFINITY, -INFINITY, INFINITY, -INFINITY};
        double kinetic = 0, unbalanced = 0;
        for (int64_t i = begin; i < end; ++i) {
            const double u = p.vx[i], v = p.vy[i];
            range.u_min = u < range.u_min ? u : range.u_min;
            range.u_max = u > range.u_max ? u : range.u_max;
            range.v_min = v < range.v_min ? v : range.v_min;
            range.v_max = v > range.v_max ? v : range.v_max;
            kinetic += world.material_of(i).density * (u * u + v * v);
            const double ax = p.ax[i] + inverse_dt * p.push_x[i], ay = p.ay[i] + inverse_dt * p.push_y[i];
            if (ax * ax + ay * ay > threshold2)
                unbalanced += world.material_of(i).density;
        }
        world.ranges[block] = range;
        world.sums[block].kinetic = 0.5 * p.volume * kinetic;
        world.sums[block].unbalanced = p.volume * unbalanced;
    });
}

BlockRange range_of_blocks(const World &world) {
    BlockRange all{INFINITY, -INFINITY, INFINITY, -INFINITY};
    for (const BlockRange &range : world.ranges) {
        all.u_min = std::min(all.u_min, range.u_min);
        all.u_max = std::max(all.u_max, range.u_max);
        all.v_min = std::min(all.v_min, range.v_min);
        all.v_max = std::max(all.v_max, range.v_max);
    }
    return all;
}

// all: the extremes of all particles.
void bound_velocities(World &world, BlockRange all) {
    if (!(all.u_min <= all.u_max)) // there are none
        return;
    world.fastest = std::hypot(std::max(-all.u_min, all.u_max), std::max(-all.v_min, all.v_max));
    const Box about = box_of_contacts(world);
    for (const Plate &plate : world.walls.plates) {
        if (plate.gap > 0) // too far away to matter
            continue;
        const VelocityRange own = velocities_of(plate, about);
        all.u_min = std::min(all.u_min, own.low.x());
        all.u_max = std::max(all.u_max, own.high.x());
        all.v_min = std::min(all.v_min, own.low.y());
        all.v_max = std::max(all.v_max, own.high.y());
    }
    world.velocity_span = std::hypot(all.u_max - all.u_min, all.v_max - all.v_min);
}

BlockSums sum_of_blocks(const World &world) {
    BlockSums total;
    for (const BlockSums &block : world.sums) {
        total.plastic += block.plastic;
        total.bulk += block.bulk;
        total.diffused += block.diffused;
        total.spaced += block.spaced;
        total.released += block.released;
        total.total_power += block.total_power;
        total.internal_power += block.internal_power;
        total.unbalanced += block.unbalanced;
        total.collision_loss += block.collision_loss;
        total.side_walls += block.side_walls;
        total.collisions += block.collisions;
        total.kinetic += block.kinetic;
        total.densest = std::max(total.densest, block.densest);
    }
    return total;
}

} // namespace

void measure_velocities(World &world) {
    measure_blocks(world);
    BlockRange range = range_of_blocks(world);
    if (world.crossing) {
        double far[] = {-range.u_min, range.u_max, -range.v_min, range.v_max};
        world.crossing->combine(far, 4, nullptr, 0);
        range = {-far[0], far[1], -far[2], far[3]};
    }
    bound_velocities(world, range);
}

namespace {

// Adjoint operators leave a residual of the power balance that is the penalty's; otherwise it is the operators' own error,
// and stays in the ledger's. Measured on the collapse with a = 1.25, L/dl = 32, in shares of the initial energy: the paper's
// scheme -.057 at .42 s and -.135 at 1 s, with factor 1 +.036 and +.028, the local model +.038 and +.007. What it loses
// after the arrest is in proportion to the time step (-.027, -.045, -.078, -.153 from .42 to 1 s for a cfl of .05, .1, .2,
// .4): tau : D at u* counts shear that the forces of the same step undo.
template <bool Adjoint> void close_books(World &world) {
    const Particles &p = world.particles;
    const double dt = world.clock.dt;
    // Power balance of the force stage, exact by the adjoint operators: with the ghosts' share G of sigma : L,
    //   total = -internal + sum (G + f . u) over contacts - penalty,
    // and of a contact's part f . u_plate is work of the plate, the rest is lost between the ghosts and the surface. To a plate
    // that turns the couple is work too: then what turns with it loses nothing, and its torque is that which changes the
    // material's angular momentum. Without the couple a layer at rest on an incline had a torque off by .4 dl times its shear
    // force, and an inner wall of 16 dl radius turned with 4 % more than the material bears.
    double contact_power = 0, plate_power = 0;
    if (world.sleep.in_use)
        add_held_loads(world);
    for_each_awake_contact(world, [&](const Contact &contact) {
        const int64_t i = contact.particle;
        const Vector force(contact.force_x, contact.force_y), reaction = -p.volume * force;
        world.walls.add_load(contact.facet, {p.x[i], p.y[i]}, reaction);
        const int32_t id = world.walls.facets[contact.facet].plate;
        const Plate &plate = world.walls.plates[id];
        world.walls.add_couple(id, -p.volume * contact.couple);
        contact_power += p.volume * (contact.ghost_power + contact.power);
        plate_power -= reaction.dot(world.walls.velocity_at(contact.facet, {p.x[i], p.y[i]})) -
                       p.volume * contact.couple * plate.motion().omega;
    });
    measure_blocks(world);
    BlockSums total = sum_of_blocks(world);
    const double penalty = Adjoint ? dt * (contact_power - total.internal_power - total.total_power) : 0.0;
    const double lost_at_walls = total.released + (Adjoint ? dt * (plate_power - contact_power) : 0.0);

    Ledger &ledger = world.ledger;
    ledger.plate_work -= dt * plate_power;
    ledger.dissipated += total.plastic + total.bulk + total.diffused + total.spaced + total.collision_loss +
                         total.side_walls + penalty + lost_at_walls;
    ledger.penalty += penalty;
    ledger.walls += lost_at_walls;
    ledger.bulk += total.bulk;
    ledger.diffusion += total.diffused;
    ledger.spacing += total.spaced;
    ledger.collisions += total.collision_loss;
    ledger.side_walls += total.side_walls;

    BlockRange range = range_of_blocks(world);
    // The step's last message: from here to the callback nothing may allocate. Who failed would wait for all to hear of it, and
    // others may be in the callback already, in a call of MPI that waits for this one.
    if (world.crossing)
        combine_books(world, range, total);
    world.walls.take_loads();
    for (Plate &plate : world.walls.plates) {
        plate.impulse += dt * plate.force;
        plate.impulse_torque += dt * plate.torque_pivot;
        if (plate.loaded())
            plate.fall(dt, world.constants.plate_mass);
    }

    bound_velocities(world, range);
    world.shifted += world.velocity_span * dt;
    world.closed_in += world.velocity_span * dt;
    for (Plate &plate : world.walls.plates)
        if (plate.gap > 0) {
            const double approach = plate.fastest() + world.fastest;
            plate.gap -= dt * approach;
            if (plate.gap <= 0) { // it matters from the next step on, whose size a fast one limits
                world.lists_valid = false;
                if (approach * dt > flow_share * world.constants.spacing)
                    world.velocity_span = std::max(world.velocity_span, approach);
            }
        }

    ledger.largest_kinetic = std::max(ledger.largest_kinetic, total.kinetic);
    world.max_compression = std::max(world.max_compression, total.densest - 1);
    world.collisions += total.collisions / 2;
    world.plastic_power = total.plastic / dt;
    const double unbalanced = world.mass > 0 ? total.unbalanced / world.mass : 0.0;
    const double part = world.clock.step > 0 ? 1.0 / rest_steps : 1.0;
    world.unbalanced_share += part * (unbalanced - world.unbalanced_share);
}

} // namespace

void account(World &world) {
    close_books<true>(world);
}

void account_unbalanced(World &world) {
    close_books<false>(world);
}

} // namespace gp::stages
