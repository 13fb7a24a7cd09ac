#include <algorithm>
#include <cmath>

#include "stages/stages.hpp"

namespace gp::stages {

void move_plates(World &world) {
    for (Plate &plate : world.walls.plates)
        plate.place(world.clock.time, world.clock.dt);
    world.walls.place_ghosts(world.threads);
}

namespace {

// Bounds of the skin in dl. The best skin weighs pairs that do nothing against rebuilds; with a rebuild as dear as a
// few steps it grows with the root of the shift per step.
constexpr double thinnest_skin = 0.1, thickest_skin = 0.8, skin_factor = 2.0;

} // namespace

void update_neighbors(World &world) {
    const Constants &c = world.constants;
    const double shift = world.velocity_span * world.clock.dt;
    // The collisions at the end of this step read the lists too: its own shift counts beforehand.
    if (world.lists_valid && world.shifted + shift <= world.skin)
        return;
    world.skin = c.spacing * std::clamp(skin_factor * std::sqrt(shift / c.spacing), thinnest_skin, thickest_skin);
    world.shifted = 0;
    const double radius = c.reach + world.skin;
    const double close = world.scene->config().collision_distance * c.spacing + world.skin;
    const double tolerance = 1e-9 * c.spacing;
    world.grid.sort(world.particles, 0.5 * radius, world.threads);
    for (Plate &plate : world.walls.plates)
        plate.place(world.clock.time, world.clock.dt);
    find_neighbors(world.particles, world.grid, radius, close,
                   world.walls.barriers(world.particles, world.grid, radius), tolerance, world.threads,
                   world.neighbors);
    world.walls.find_contacts(world.particles, world.grid, radius, c.spacing, world.threads);
    if (c.scheme != Scheme::adjoint)
        world.walls.find_wall_particles(c.spacing);
    world.lists_valid = true;
}

} // namespace gp::stages
