#include <algorithm>
#include <cmath>

#include "parts.hpp"
#include "stages/sleep_work.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

void move_plates(World &world) {
    world.walls.place_plates(world.clock.time, world.clock.dt);
    world.walls.place_ghosts(world.threads);
}

namespace {

// Takes particles and plates that have left the period back into it.
void wrap(World &world) {
    Particles &p = world.particles;
    const Period &period = world.constants.period;
    double level = 0;
    for (int64_t i = 0; i < p.count; ++i)
        if (const double shift = period.shift_of(p.x[i]); shift != 0) {
            p.x[i] -= shift;
            level -= world.material_of(i).density * p.volume * world.constants.gravity.x() * shift;
        }
    world.ledger.level += world.crossing ? sum_of_all(world, level) : level;
    for (Plate &plate : world.walls.plates)
        plate.wrap(period, world.clock.time);
}

// Tiles are wider than the lists reach by so much, in dl: the most that any two may have moved against each other before those
// of tiles that are not next to each other count (shift_tiles.hpp).
constexpr double room_of_tiles = 2;

bool stands(const Plate &plate, const Plate::State &before) {
    const Pose &now = plate.placed(), &then = before.placed;
    return now.shift == then.shift && now.angle == then.angle;
}

// A bound on how far what may come into each other's reach has moved against each other. Particles and plates: as if all of them
// were near each other; where a plate in reach has moved, the bound is that of any two.
double measure_closing(World &world) {
    double plates_near = 0; // 1: there are some
    for (std::size_t k = 0; k < world.walls.plates.size(); ++k) {
        const Plate &plate = world.walls.plates[k];
        if (plate.gap > 0)
            continue;
        if (!stands(plate, world.list_origin.plates[k]))
            return world.closed_in;
        plates_near = 1;
    }
    ShiftTiles &tiles = world.tiles;
    tiles.measure(world.particles, world.grid, world.list_origin.x, world.list_origin.y, world.threads);
    if (world.crossing) {
        std::vector<double> &all = tiles.extremes();
        world.crossing->combine(all.data(), static_cast<int>(all.size()), nullptr, 0);
    }
    const ShiftTiles::Shifts shifts = tiles.shifts();
    const double reach = world.constants.reach;
    return std::max({shifts.near, plates_near * shifts.own, shifts.any - (tiles.width() - reach - world.skin)});
}

// Bounds of the skin in dl. The best skin weighs pairs that do nothing against rebuilds; with a rebuild as dear as a
// few steps it grows with the root of the shift per step.
constexpr double thinnest_skin = 0.1, thickest_skin = 0.8, skin_factor = 2.0;

// No skin is below this in shifts: lists are kept for as long as one more shift of any two fits in, however little those near
// each other have moved.
constexpr double least_shifts = 1.5;

// Cells, in dl. Clusters are as compact as two rows of particles make them; finer cells along the rows put particles nearly
// in the order of x.
constexpr double cell_width = 1, cell_height = 2;

// Of the particles about a ghost's mirror point, in dl: one of a dense set is always within a spacing.
constexpr double mirror_reach = 1.5;

// The cells for all particles, whoever works on them. count: how many these are.
CellFrame find_frame(World &world, int64_t &count) {
    world.box = box_of(world.particles);
    count = world.particles.count;
    if (world.crossing) {
        double far[4] = {-world.box.x_min, world.box.x_max, -world.box.y_min, world.box.y_max};
        Whole sum = count;
        world.crossing->combine(far, 4, &sum, 1);
        count = static_cast<int64_t>(sum);
        world.box = {-far[0], far[1], -far[2], far[3]};
    }
    const Constants &c = world.constants;
    return {world.box, c.period, cell_width * c.spacing, cell_height * c.spacing};
}

} // namespace

void update_neighbors(World &world) {
    const Constants &c = world.constants;
    // Before the first step nothing has moved, at whatever speed: that may be infinite, which the first step refuses.
    const double shift = world.clock.dt > 0 ? world.velocity_span * world.clock.dt : 0.0;
    // The collisions at the end of this step read the lists too: its own shift counts beforehand.
    const bool stand = world.lists_valid && world.walls.chains_stand();
    double share = 1; // of the shift of any two
    if (stand && world.closed_in + shift > world.skin) {
        world.closed_in = measure_closing(world);
        if (world.closed_in < world.shifted)
            share = world.closed_in / world.shifted;
    }
    if (stand && world.closed_in + shift <= world.skin) {
        if (!world.sleep.idle)
            world.walls.face_facets(world.particles);
        return;
    }
    const double least = std::clamp(least_shifts * shift / c.spacing, thinnest_skin, thickest_skin);
    world.skin = c.spacing * std::clamp(skin_factor * std::sqrt(share * shift / c.spacing), least, thickest_skin);
    world.shifted = world.closed_in = 0;
    if (c.period)
        wrap(world);
    world.walls.place_plates(world.clock.time, world.clock.dt);
    make_lists(world);
}

void make_lists(World &world) {
    const Constants &c = world.constants;
    const double radius = c.reach + world.skin;
    const double close = world.scene->config().collision_distance * c.spacing + world.skin;
    const double tolerance = 1e-9 * c.spacing;
    world.lists_whole = world.lists_valid = false;
    int64_t count = 0;
    const CellFrame frame = find_frame(world, count);
    if (world.crossing)
        go_to_owners(world, frame);
    world.grid.sort(world.particles, frame, world.threads);
    if (world.sleep.in_use)
        find_spans(world);
    const Particles &p = world.particles;
    ListOrigin &origin = world.list_origin;
    origin.x.resize(p.count);
    origin.y.resize(p.count);
    for_each_block(world.threads, p.count, [&](int64_t, int64_t begin, int64_t end) {
        std::copy(p.x.data() + begin, p.x.data() + end, origin.x.data() + begin);
        std::copy(p.y.data() + begin, p.y.data() + end, origin.y.data() + begin);
    });
    origin.plates.clear();
    for (const Plate &plate : world.walls.plates)
        origin.plates.push_back(plate.state());
    // Ghosts up to `radius` beyond the particles extrapolate from what is within `radius` of them. In the implicit scheme a ghost
    // exerts its force on the particles about its mirror point, which may be as far in front of the wall as it is behind it, and
    // gets it from what sees it; past a convex corner both are up to sqrt(3) radii apart. GP_FIELD_NUMBER_DENSITY may reach farther:
    // those near each other have moved by no more than the skin, and what comes from other tiles has room as theirs.
    const bool mirrored = c.scheme == Scheme::implicit;
    const double counted = c.interaction_radius + world.skin + room_of_tiles * c.spacing;
    const double far = std::max((mirrored ? 3 : 2) * radius, counted);
    if (world.crossing) {
        world.halo->find(world.particles, frame, c.period, far);
        world.images.make(world.particles, world.grid, *world.halo);
    } else if (c.period) {
        world.images.make(world.particles, world.grid, c.period, far);
    }
    if (world.crossing || c.period) {
        const int64_t size = std::max<int64_t>(1, world.particles.count + world.images.count);
        if (!world.colliding.empty())
            world.colliding.resize(size);
        if (!world.crowded.empty())
            world.crowded.resize(size);
    }
    const Barriers &barriers = world.walls.barriers(world.particles, world.grid, radius, world.crossing);
    const auto find = [&] {
        world.tiles.cut(world.grid, world.box, count, c.reach + room_of_tiles * c.spacing);
        find_clusters(world.particles, world.grid, world.images, radius, close, barriers, tolerance, world.threads,
                      world.clusters);
    };
    if (world.crossing)
        require_bounded_everywhere(world, true, find);
    else
        find();
    if (c.scheme != Scheme::adjoint)
        find_neighbors(world.particles, world.clusters, radius, world.threads, world.neighbors);
    const double about_mirrors = mirror_reach * c.spacing + world.skin;
    world.walls.find_contacts(world.particles, world.grid, world.images, world.box, radius,
                              mirrored && world.images.in_use() ? radius + about_mirrors : 0.0, c.reach, c.spacing,
                              !by_number_density(c.scheme), world.threads);
    if (by_number_density(c.scheme))
        world.walls.find_wall_particles(c.spacing);
    world.walls.lanes.make(world.walls, world.clusters, world.grid, world.images);
    if (mirrored)
        world.mirrors.find(world.walls, world.particles, world.grid, world.images, about_mirrors, world.crossing);
    if (world.sleep.in_use)
        link_spans(world, radius);
    world.lists_valid = world.lists_new = world.lists_whole = world.sleep.stale = true;
    world.listed.clear();
}

void update_images(World &world) {
    if (world.crossing && world.sleep.in_use)
        world.halo->copy_motion(world.particles, world.sleep);
    else if (world.images.in_use())
        world.images.copy_motion(world.particles);
}

} // namespace gp::stages
