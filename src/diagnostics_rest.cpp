// Rest: gp_state.at_rest in gp.h defines it with these numbers.
#include <algorithm>
#include <cmath>

#include "diagnostics.hpp"

namespace gp {

namespace {

constexpr double rest_kinetic = 1e-6, rest_plastic = 1e-4, rest_unbalanced = 0.01;
// Grains without stress, at the tips, count as flowing, and may go on pushing each other; the bulk does not. Below 200 particles
// two are more than 1 %.
constexpr double trembling_particles = 2, rest_unbalanced_few = 0.05;
constexpr double plate_unbalanced = 0.05; // of a plate's load, that the material does not bear

double unbalanced_share_at_rest(int64_t particles) {
    return std::max(rest_unbalanced,
                    std::min(trembling_particles / static_cast<double>(particles), rest_unbalanced_few));
}

// The way that a plate has still before it by its own motion, as a box about where it is now.
Box way_ahead(const Plate &plate, double time) {
    Box way;
    const auto without_end = [&](const Vector &velocity) {
        (velocity.x() < 0 ? way.x_min : way.x_max) = velocity.x() == 0 ? 0.0 : std::copysign(INFINITY, velocity.x());
        (velocity.y() < 0 ? way.y_min : way.y_max) = velocity.y() == 0 ? 0.0 : std::copysign(INFINITY, velocity.y());
    };
    const MotionTable &table = plate.spec().table;
    if (plate.driven() || table.empty()) {
        without_end(plate.prescribed_motion().velocity);
    } else {
        const Vector now = table.displacement(time);
        for (std::size_t k = 0; k < table.t.size(); ++k)
            if (table.t[k] > time) {
                way.x_min = std::min(way.x_min, table.x[k] - now.x());
                way.x_max = std::max(way.x_max, table.x[k] - now.x());
                way.y_min = std::min(way.y_min, table.y[k] - now.y());
                way.y_max = std::max(way.y_max, table.y[k] - now.y());
            }
    }
    return way;
}

bool turns_after(const Plate &plate, double time) {
    const MotionTable &table = plate.spec().table;
    if (plate.driven() || table.empty())
        return plate.prescribed_motion().omega != 0;
    for (std::size_t k = 0; k < table.angle.size(); ++k)
        if (table.t[k] > time && table.angle[k] != table.turn(time))
            return true;
    return false;
}

// All that it may come to by turning about where its pivot is.
Box box_of_turns(const Plate &plate) {
    const Vector pivot = plate.pivot();
    const double far = plate.spec().farthest;
    return {pivot.x() - far, pivot.x() + far, pivot.y() - far, pivot.y() + far};
}

Box box_of_line(const Plate &plate) {
    const Placing placing = plate.placing();
    Box box{INFINITY, -INFINITY, INFINITY, -INFINITY};
    for (const Vector &point : plate.spec().points) {
        const Vector at = placing.of(point);
        box = {std::min(box.x_min, at.x()), std::max(box.x_max, at.x()), std::min(box.y_min, at.y()),
               std::max(box.y_max, at.y())};
    }
    return box;
}

// Has a loaded plate come to rest on the material? energy: below this it counts as such, J/m.
bool rests(const World &world, const Plate &plate, double energy) {
    const PlateSpec &spec = plate.spec();
    const double mass = spec.length * (spec.mass > 0 ? spec.mass : world.constants.plate_mass);
    const double speed = plate.state().fall_speed, load = spec.load * spec.back_length;
    return 0.5 * mass * speed * speed <= energy &&
           std::abs(load + spec.back_normal.dot(plate.force)) <= plate_unbalanced * load;
}

// Does a plate move, or will it, that the material feels or comes to feel?
bool plates_move(const World &world, const Box &material, double energy) {
    if (!(material.x_min <= material.x_max)) // there is none
        return false;
    return std::any_of(world.walls.plates.begin(), world.walls.plates.end(), [&](const Plate &plate) {
        Box way = way_ahead(plate, world.clock.time);
        const Vector &push = plate.spec().back_normal;
        if (plate.loaded() && !rests(world, plate, energy)) {
            way.x_min -= push.x() < 0 ? INFINITY : 0.0;
            way.x_max += push.x() > 0 ? INFINITY : 0.0;
            way.y_min -= push.y() < 0 ? INFINITY : 0.0;
            way.y_max += push.y() > 0 ? INFINITY : 0.0;
        }
        const bool turns = turns_after(plate, world.clock.time);
        if (way.x_min == way.x_max && way.y_min == way.y_max && !turns && plate.spec().surface_velocity == 0)
            return false;
        const Box about = turns ? box_of_turns(plate) : box_of_line(plate);
        Box swept{about.x_min + way.x_min, about.x_max + way.x_max, about.y_min + way.y_min, about.y_max + way.y_max};
        if (world.constants.period) { // it has images at every x
            swept.x_min = -INFINITY;
            swept.x_max = INFINITY;
        }
        return swept.gap(material) <= world.constants.horizon;
    });
}

} // namespace

void BoxOfAll::add(const World &stretch) {
    const Box of = box_of(stretch.particles);
    box_ = {std::min(box_.x_min, of.x_min), std::max(box_.x_max, of.x_max), std::min(box_.y_min, of.y_min),
            std::max(box_.y_max, of.y_max)};
}

bool is_at_rest(const World &world, double kinetic, int64_t count, const Box &box) {
    const double scale = std::max(world.ledger.scale, world.ledger.largest_kinetic);
    const Constants &c = world.constants;
    const bool still = world.clock.step == 0 ? kinetic == 0 && c.gravity.norm() == 0
                                             : kinetic <= rest_kinetic * scale &&
                                                   world.plastic_power * c.time_scale() <= rest_plastic * scale &&
                                                   world.unbalanced_share <= unbalanced_share_at_rest(count);
    return still && !plates_move(world, box, rest_kinetic * scale);
}

} // namespace gp
