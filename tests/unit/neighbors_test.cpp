// Cell sort and lists against brute force; plates' ghosts and what they hide.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "neighbors.hpp"
#include "world_support.hpp"

using namespace gp;

namespace {

// A scene of given particles with unit spacing.
struct Points {
    explicit Points(const std::vector<double> &x, const std::vector<double> &y, double horizon = 4) {
        gp_config config = default_config(GP_PRESET_DEFAULT);
        config.spacing = 1;
        config.sound_speed = 10;
        config.horizon = horizon;
        config.threads = 1;
        scene = std::make_unique<Scene>(config);
        scene->add_particles(0, static_cast<int64_t>(x.size()), x.data(), y.data(), nullptr, nullptr);
    }
    void plate(double x0, double y0, double x1, double y1) {
        gp_plate p = default_plate();
        p.x0 = x0;
        p.y0 = y0;
        p.x1 = x1;
        p.y1 = y1;
        scene->add_plate(p);
    }
    World &build() {
        world = make_world(*scene);
        stages::update_neighbors(*world);
        return *world;
    }
    std::unique_ptr<Scene> scene;
    std::unique_ptr<World> world;
};

std::set<std::pair<int64_t, int64_t>> listed_pairs(const World &world) {
    std::set<std::pair<int64_t, int64_t>> pairs;
    for (int64_t i = 0; i < world.particles.count; ++i)
        for (int64_t k = world.neighbors.start[i]; k < world.neighbors.start[i + 1]; ++k)
            EXPECT_TRUE(pairs.insert({world.particles.id[i], world.particles.id[world.neighbors.index[k]]}).second);
    return pairs;
}

} // namespace

TEST(Neighbors, AgreeWithBruteForce) {
    std::mt19937 generator(3);
    std::uniform_real_distribution<double> uniform(-15, 15);
    std::vector<double> x, y;
    for (int k = 0; k < 500; ++k) {
        x.push_back(uniform(generator));
        y.push_back(uniform(generator));
    }
    for (double far : {0.0, 1e7}) { // a fragment far away changes the search, not its result
        x.back() = far;
        Points points(x, y);
        const World &world = points.build();
        const double radius = world.constants.horizon + world.skin;
        std::set<std::pair<int64_t, int64_t>> expected;
        for (int64_t i = 0; i < 500; ++i)
            for (int64_t j = 0; j < 500; ++j)
                if (i != j && std::hypot(x[i] - x[j], y[i] - y[j]) < radius)
                    expected.insert({i, j});
        EXPECT_EQ(listed_pairs(world), expected);
        const double close = 0.9 + world.skin;
        for (int64_t i = 0; i < 500; ++i)
            for (int64_t k = world.neighbors.start[i]; k < world.neighbors.start[i + 1]; ++k) {
                const int64_t j = world.neighbors.index[k];
                const double r = std::hypot(world.particles.x[i] - world.particles.x[j],
                                            world.particles.y[i] - world.particles.y[j]);
                EXPECT_EQ(k < world.neighbors.start[i] + world.neighbors.close_count[i], r < close);
            }
    }
}

TEST(Neighbors, DoNotSeeEachOtherThroughAPlate) {
    // Two particles on either side of a thin gate, one beyond its end.
    Points points({-0.5, 0.5, 0.5}, {1, 1, -2.5});
    points.plate(0, 3, 0, 0);
    points.plate(0, 0, 0, 3);
    const auto pairs = listed_pairs(points.build());
    EXPECT_EQ(pairs.count({0, 1}), 0u);
    EXPECT_EQ(pairs.count({0, 2}), 1u); // below the gate's end the way is free
    EXPECT_EQ(pairs.count({1, 2}), 1u);
}

TEST(Ghosts, FillACornerOnceAndOnlyInReach) {
    // A particle in the corner of floor and wall sees every lattice point behind them within the list's radius once.
    Points points({0.5}, {0.5});
    points.plate(30, 0, 0, 0);   // floor
    points.plate(0, 0, 0, 30);   // wall on the left
    points.plate(50, 30, 50, 0); // out of reach
    const World &world = points.build();
    const double radius = world.constants.horizon + world.skin;
    std::set<std::pair<double, double>> seen;
    for (const Contact &contact : world.walls.contacts)
        for (int64_t k = contact.begin; k < contact.end; ++k) {
            const int32_t g = world.walls.ghost_of_contact[k];
            EXPECT_TRUE(
                seen.insert({std::round(2 * world.walls.ghost_x[g]), std::round(2 * world.walls.ghost_y[g])}).second);
            EXPECT_NE(contact.plate, 2);
        }
    std::size_t expected = 0;
    for (int i = -10; i < 10; ++i)
        for (int j = -10; j < 10; ++j)
            if ((i < 0 || j < 0) && std::hypot(i, j) < radius)
                ++expected;
    EXPECT_EQ(seen.size(), expected);
    EXPECT_EQ(static_cast<std::size_t>(world.walls.ghost_count), expected);
    EXPECT_GT(world.walls.plates[2].gap, 40);
}

TEST(Ghosts, DoNotExistBehindOrBesideAPlate) {
    Points points({0.5, 8}, {-0.5, 0.5});
    points.plate(5, 0, 0, 0);
    const World &world = points.build();
    EXPECT_FALSE(world.walls.in_reach()); // one particle is on the body's side, the other past the end
}
