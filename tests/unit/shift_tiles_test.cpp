// Lists are kept until particles near each other have moved: none may come within reach of one that is not in its row.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "clusters.hpp"
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

// Steps with lists that another bound would have made anew.
int64_t run(Sim &sim, int steps) {
    int64_t kept = 0;
    for (int k = 0; k < steps; ++k) {
        EXPECT_EQ(sim.step(nullptr, 1), GP_OK);
        kept += sim.world().shifted > sim.world().skin;
        if (k % 3 == 0) {
            const Pairs pairs = look_at_pairs(sim.world());
            EXPECT_GT(pairs.near, sim.world().particles.count);
            EXPECT_EQ(pairs.missing, 0) << "step " << k;
        }
    }
    return kept;
}

gp_config config_of(double spacing) {
    gp_config config = default_config(GP_PRESET_DEFAULT);
    config.spacing = spacing;
    config.threads = 1;
    config.jitter = 0.1;
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
    EXPECT_GT(run(sim, 150), 30);
}

// Across the ends of the period, where the last tile is next to the first, they come towards each other; the tiles are few.
TEST(ShiftTiles, RowsOfWhatMeetsAcrossThePeriodHaveAllInReach) {
    gp_config config = config_of(1);
    config.sound_speed = 100;
    config.gravity_y = 0;

    config.periodic_x_min = 0;
    config.periodic_x_max = 40;
    Sim sim(config);
    std::vector<double> x, y, vx, vy;
    for (int k = 0; k < 16; ++k)
        for (int row = 0; row < 8; ++row) {
            x.push_back(0.5 + k + (k < 8 ? 0 : 40 - 16));
            y.push_back(0.5 + row);
            vx.push_back(k < 8 ? -5 : 3);
            vy.push_back(k < 8 ? 1 : -1);
        }
    sim.add_particles(0, static_cast<int64_t>(x.size()), x.data(), y.data(), vx.data(), vy.data());
    run(sim, 200);
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
    tiles.cut(grid, grid.box(), 6);
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
