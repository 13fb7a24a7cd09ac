// Lists are kept until particles near each other have moved: none may come within reach of one that is not in its row.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "clusters.hpp"
#include "fields.hpp"
#include "kernel.hpp"
#include "shift_tiles.hpp"
#include "sim.hpp"

using namespace gp;

namespace {

// Pairs within the horizon, and those of them that the particle's row has not.
struct Pairs {
    int64_t near = 0, missing = 0;
};

Pairs look_at_pairs(const World &world) {
    const Particles &p = world.particles;
    const int64_t places = p.count + world.images.count;
    const double reach2 = world.constants.horizon * world.constants.horizon;
    std::vector<char> seen(static_cast<std::size_t>(places));
    Pairs pairs;
    for (int64_t c = 0; c < world.clusters.count(); ++c) {
        std::fill(seen.begin(), seen.end(), 0);
        for_each_entry(world.clusters, world.clusters.all, c, [&](int64_t, int32_t j) { seen[j] = 1; });
        for (int64_t i = world.clusters.first[c]; i < world.clusters.first[c + 1]; ++i)
            for (int64_t j = 0; j < places; ++j) {
                const double dx = p.x[j] - p.x[i], dy = p.y[j] - p.y[i];
                if (dx * dx + dy * dy < reach2) {
                    ++pairs.near;
                    pairs.missing += !seen[j];
                }
            }
    }
    return pairs;
}

// Ghosts of a floor that is a single line, within the horizon, and those of them that the particle's rows have not. Where ghosts
// belong is told from any of them: they are a lattice, of which those in reach have to be there.
Pairs look_at_ghosts(const World &world) {
    const Particles &p = world.particles;
    const Walls &walls = world.walls;
    const double spacing = world.constants.spacing, horizon = world.constants.horizon;
    const auto layers = static_cast<int>(std::ceil(horizon / spacing)), across = layers + 1;
    Pairs pairs;
    if (walls.ghost_count == 0)
        return pairs;
    const Segment &line = walls.facets[0].segment;
    const double first = walls.ghost_along[0];
    for (int64_t i = 0; i < p.count; ++i) {
        const Vector at(p.x[i], p.y[i]);
        const double height = line.distance(at), along = line.along(at);
        const double nearest = first + spacing * std::round((along - first) / spacing);
        for (int layer = 0; layer < layers; ++layer)
            for (int k = -across; k <= across; ++k) {
                const double depth = (layer + 0.5) * spacing, place = nearest + k * spacing;
                if (std::hypot(place - along, height + depth) >= horizon)
                    continue;
                ++pairs.near;
                bool found = false;
                for (int64_t c = walls.contact_start[i]; c < walls.contact_start[i + 1]; ++c)
                    for (int64_t g = walls.contacts[c].begin; g < walls.contacts[c].end; ++g) {
                        const int32_t ghost = walls.ghost_of_contact[g];
                        found |= std::abs(walls.ghost_along[ghost] - place) < 0.01 * spacing &&
                                 std::abs(walls.ghost_depth[ghost] - depth) < 0.01 * spacing;
                    }
                pairs.missing += !found;
            }
    }
    return pairs;
}

// The number density is looked up in cells of when the lists were made.
void expect_number_density(const World &world) {
    const Particles &p = world.particles;
    const double radius = world.constants.interaction_radius;
    Field<double> scratch;
    const double *read = read_field(world, GP_FIELD_NUMBER_DENSITY, scratch);
    for (int64_t i = 0; i < p.count; ++i) {
        double sum = 0;
        for (int64_t j = 0; j < p.count + world.images.count; ++j)
            if (j != i)
                sum += weight(std::hypot(p.x[j] - p.x[i], p.y[j] - p.y[i]), 1.0 / radius);
        ASSERT_NEAR(read[i], sum, 1e-9 * (1 + sum)) << i;
    }
}

struct Found {
    int64_t kept = 0; // steps with lists that another bound would have made anew
    int64_t made = 0; // with new ones
    int64_t ghosts = 0;
};

Found run(Sim &sim, int steps) {
    Found found;
    for (int k = 0; k < steps; ++k) {
        EXPECT_EQ(sim.step(nullptr, 1), GP_OK);
        const World &world = sim.world();
        found.kept += world.shifted > world.skin;
        found.made += world.lists_new;
        if (k % 3 == 0) {
            const Pairs pairs = look_at_pairs(world);
            EXPECT_GT(pairs.near, world.particles.count);
            EXPECT_EQ(pairs.missing, 0) << "step " << k;
            const Pairs ghosts = look_at_ghosts(world);
            EXPECT_EQ(ghosts.missing, 0) << "step " << k;
            found.ghosts += ghosts.near;
            expect_number_density(world);
        }
    }
    return found;
}

// A block of 8 x 8, a spacing apart.
void add_block(Sim &sim, double from, double bottom, double u, double v) {
    std::vector<double> x, y;
    for (int k = 0; k < 64; ++k) {
        x.push_back(from + k % 8);
        y.push_back(bottom + static_cast<double>(k / 8));
    }
    const std::vector<double> vx(64, u), vy(64, v);
    sim.add_particles(0, 64, x.data(), y.data(), vx.data(), vy.data());
}

gp_config config_of(double spacing) {
    gp_config config = default_config(GP_PRESET_DEFAULT);
    config.spacing = spacing;
    config.threads = 1;
    config.jitter = 0.1;
    return config;
}

// Blocks that fly, a spacing of 1 m.
gp_config config_of_blocks(double jitter) {
    gp_config config = config_of(1);
    config.sound_speed = 100;
    config.gravity_y = 0;
    config.jitter = jitter;
    return config;
}

} // namespace

TEST(ShiftTiles, RowsOfACollapseHaveAllInReach) {
    gp_config config = config_of(0.0025);
    config.sound_speed = 10;
    Sim sim(config);
    gp_column column = default_column();
    column.x_min = -0.04;
    column.width = 0.08;
    column.height = 0.05;
    sim.add_column(column);
    gp_plate floor = default_plate();
    floor.x0 = 0.4;
    floor.x1 = -0.4;
    sim.add_plate(floor);
    sim.run(nullptr, 0.1);
    EXPECT_GT(run(sim, 150).kept, 30);
}

// Across the ends of the period, where the last tile is next to the first, they come towards each other; the tiles are few.
TEST(ShiftTiles, RowsOfWhatMeetsAcrossThePeriodHaveAllInReach) {
    gp_config config = config_of_blocks(0.1);
    config.periodic_x_max = 40;
    config.interaction_radius = 6; // of the number density: farther than the lists reach
    Sim sim(config);
    add_block(sim, 0.5, 0.5, -5, 1);
    add_block(sim, 40 - 7.5, 0.5, 3, -1);
    EXPECT_LT(run(sim, 200).made, 40);
}

// In a step two of different blocks move by .15 dl against each other, more than the thinnest skin, and those of one block not at
// all. The space that they fly through has wide tiles, so that some fifty steps count for nothing: the share of what counts comes to
// nothing as well.
TEST(ShiftTiles, ListsAreKeptWhereOneStepIsMoreThanTheThinnestSkin) {
    gp_config config = config_of_blocks(0);
    config.time_step = 0.01;
    Sim sim(config);
    add_block(sim, 0, 0, 7.5, 0);
    add_block(sim, 100, 100, -7.5, 0);
    const int steps = 300;
    EXPECT_LT(run(sim, steps).made, steps / 10);
}

// A block that slides on a floor as a whole comes to other ghosts, though nothing in it moves against anything.
TEST(ShiftTiles, RowsOfGhostsAreThoseOfWhereTheBlockIs) {
    for (const bool plate_moves : {false, true}) {
        Sim sim(config_of_blocks(0));
        add_block(sim, 0, 0.5, plate_moves ? 0 : 4, 0);
        gp_plate floor = default_plate();
        floor.x0 = 100;
        floor.x1 = -100;
        floor.friction = GP_WALL_FREE_SLIP;
        const int32_t plate = sim.add_plate(floor);
        const int steps = 150;
        if (plate_moves) {
            EXPECT_EQ(sim.step(nullptr, 20), GP_OK);
            sim.set_plate_motion(plate, 4, 0, 0);
        }
        const double from = sim.clock().time;
        const Found found = run(sim, steps);
        EXPECT_GT(found.ghosts, 0);
        EXPECT_GT(4 * (sim.clock().time - from), 3) << "dl: less, and the ghosts would be the same";
        EXPECT_GT(found.made, 3);
        EXPECT_LT(found.made, steps / 5);
    }
}

// Material that is stretched: what is near moves apart by far less than the ends do, and whoever has which particles finds the same.
TEST(ShiftTiles, BoundWhatIsNearAndWhatIsAnywhere) {
    const double strain = 0.01;
    std::mt19937 generator(5);
    std::uniform_real_distribution<double> uniform(0, 1);
    Particles p;
    p.allocate(2000, {});
    for (int64_t i = 0; i < p.count; ++i) {
        p.id[i] = i;
        p.x[i] = 100 * uniform(generator);
        p.y[i] = 20 * uniform(generator);
    }
    CellGrid grid;
    grid.sort(p, CellFrame(box_of(p), Period{}, 1, 2), 1);
    const Field<double> x = p.x, y = p.y;
    for (int64_t i = 0; i < p.count; ++i) {
        p.x[i] += strain * p.x[i];
        p.y[i] -= strain * p.y[i];
    }
    ShiftTiles tiles;
    tiles.cut(grid, grid.box(), p.count, 6);
    EXPECT_GE(tiles.width(), 6);
    tiles.measure(p, grid, x, y, 1);
    const ShiftTiles::Shifts shifts = tiles.shifts();
    EXPECT_NEAR(shifts.any, strain * std::hypot(100, 20), 0.02 * strain * 100);
    EXPECT_NEAR(shifts.own, strain * std::hypot(100, 20), 0.02 * strain * 100);
    // Two tiles of 6, those at the ends wider by up to another.
    EXPECT_LT(shifts.near, strain * std::hypot(18, 18));
    for (int64_t i = 0; i < p.count; ++i)
        for (int64_t j = 0; j < i; ++j)
            if (const double dx = x[i] - x[j], dy = y[i] - y[j]; dx * dx + dy * dy < tiles.width() * tiles.width()) {
                EXPECT_LE(strain * std::hypot(dx, dy), shifts.near * (1 + 1e-12));
            }
}

namespace {

// What two particles that were nearer to each other than tiles are wide have done, and the ranges of all.
void expect_bound(const Particles &p, const Field<double> &x, const Field<double> &y, const ShiftTiles &tiles) {
    const ShiftTiles::Shifts shifts = tiles.shifts();
    double near2 = 0, own2 = 0, any2 = 0;
    for (int64_t i = 0; i < p.count; ++i) {
        const double u = p.x[i] - x[i], v = p.y[i] - y[i];
        own2 = std::max(own2, u * u + v * v);
        for (int64_t j = 0; j < i; ++j) {
            const double du = u - (p.x[j] - x[j]), dv = v - (p.y[j] - y[j]), shift2 = du * du + dv * dv;
            const double dx = x[i] - x[j], dy = y[i] - y[j];
            any2 = std::max(any2, shift2);
            if (dx * dx + dy * dy < tiles.width() * tiles.width())
                near2 = std::max(near2, shift2);
        }
    }
    const double rounded = 1 - 1e-12;
    EXPECT_GE(shifts.near, rounded * std::sqrt(near2));
    EXPECT_GE(shifts.own, rounded * std::sqrt(own2));
    EXPECT_GE(shifts.any, rounded * std::sqrt(any2));
    // Ranges of x and y are extremes of different particles: of two numbers each, the root of two at most.
    EXPECT_LE(shifts.own, std::sqrt(2 * own2) / rounded);
    EXPECT_LE(shifts.any, std::sqrt(2 * any2) / rounded);
}

// Scattered over a box.
Particles scattered(int64_t count, double width, double height) {
    std::mt19937 generator(7);
    std::uniform_real_distribution<double> uniform(0, 1);
    Particles p;
    p.allocate(count, {});
    for (int64_t i = 0; i < count; ++i) {
        p.id[i] = i;
        p.x[i] = width * uniform(generator);
        p.y[i] = height * uniform(generator);
    }
    return p;
}

// Eddies, so that what is near moves alike.
void stir(Particles &p) {
    for (int64_t i = 0; i < p.count; ++i) {
        const double x = p.x[i], y = p.y[i];
        p.x[i] += 0.3 * std::sin(0.02 * y);
        p.y[i] += 0.2 * std::cos(0.03 * x);
    }
}

} // namespace

TEST(ShiftTiles, BoundWhatIsNearInTilesThatAreWideForTheirNumber) {
    Particles p = scattered(6000, 600, 600); // a hundred tiles of 6 each way are more than there may be
    CellGrid grid;
    grid.sort(p, CellFrame(box_of(p), Period{}, 1, 2), 1);
    const Field<double> x = p.x, y = p.y;
    stir(p);
    ShiftTiles tiles;
    tiles.cut(grid, grid.box(), p.count, 6);
    EXPECT_GE(tiles.width(), 12);
    EXPECT_LE(tiles.width(), 24);
    tiles.measure(p, grid, x, y, 1);
    expect_bound(p, x, y, tiles);
    EXPECT_LT(tiles.shifts().near, 0.8 * tiles.shifts().any);
}

// Of a grain that has fallen a hundred million spacings all rows between are empty.
TEST(ShiftTiles, EmptyRowsAreNotLookedThrough) {
    Particles p = scattered(500, 60, 20);
    p.y[17] = -1e8;
    CellGrid grid;
    grid.sort(p, CellFrame(box_of(p), Period{}, 1, 2), 1);
    int64_t rows = 0, seen = 0;
    for (int64_t row = grid.row_from(grid.first_row()); row <= grid.last_row(); row = grid.row_from(row + 1), ++rows)
        grid.run(row, grid.first_column(), INT64_MAX / 2, [&](int64_t begin, int64_t end) { seen += end - begin; });
    EXPECT_LE(rows, 12);
    EXPECT_EQ(seen, p.count);
    EXPECT_GT(grid.row_from(grid.last_row() + 1), grid.last_row());
    const Field<double> x = p.x, y = p.y;
    stir(p);
    ShiftTiles tiles;
    tiles.cut(grid, grid.box(), p.count, 6);
    EXPECT_GT(tiles.width(), 6);
    tiles.measure(p, grid, x, y, 1);
    expect_bound(p, x, y, tiles);
}
