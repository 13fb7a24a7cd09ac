// Cell sort and lists against brute force; plates' ghosts and what they hide.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "clusters.hpp"
#include "lanes.hpp"
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

// Calls found(i, j, entry) for what each particle sees, by its cluster's row.
template <class Found> void for_each_seen_of(const World &world, const Found &found) {
    const ClusterList &clusters = world.clusters;
    int64_t expected = 0;
    for (int64_t c = 0; c < clusters.count(); ++c) {
        EXPECT_LE(clusters.first[c + 1] - clusters.first[c], lane_count);
        for (int64_t i = clusters.first[c]; i < clusters.first[c + 1]; ++i) {
            EXPECT_EQ(i, expected++);
            for_each_seen(clusters, c, i, [&](int64_t j) { found(c, i, j); });
        }
    }
    EXPECT_EQ(expected, world.particles.count);
}

double distance(const World &world, int64_t i, int64_t j) {
    const Particles &p = world.particles;
    return std::hypot(p.x[i] - p.x[j], p.y[i] - p.y[j]);
}

std::set<std::pair<int64_t, int64_t>> listed_pairs(const World &world) {
    std::set<std::pair<int64_t, int64_t>> pairs;
    const double radius = world.constants.horizon + world.skin;
    for_each_seen_of(world, [&](int64_t, int64_t i, int64_t j) {
        if (distance(world, i, j) < radius) {
            EXPECT_TRUE(pairs.insert({world.particles.id[i], world.particles.id[j]}).second);
        }
    });
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
        // Those that may collide with one of a cluster are in a row of their own, too.
        const ClusterList &clusters = world.clusters;
        const double close = 0.9 + world.skin;
        for (int64_t c = 0; c < clusters.count(); ++c) {
            std::vector<int32_t> near, listed;
            for_each_entry(clusters, clusters.all, c, [&](int64_t, int32_t j) {
                double nearest = INFINITY;
                for (int64_t i = clusters.first[c]; i < clusters.first[c + 1]; ++i)
                    nearest = std::min(nearest, distance(world, i, j));
                EXPECT_LT(nearest, radius);
                if (nearest < close)
                    near.push_back(j);
            });
            for_each_entry(clusters, clusters.close, c, [&](int64_t, int32_t j) { listed.push_back(j); });
            EXPECT_EQ(listed, near);
        }
        // The rows of single particles hold the same.
        NeighborList rows;
        find_neighbors(world.particles, clusters, radius, 1, rows);
        std::set<std::pair<int64_t, int64_t>> of_rows;
        for (int64_t i = 0; i < 500; ++i)
            for (int64_t k = rows.start[i]; k < rows.start[i + 1]; ++k)
                of_rows.insert({world.particles.id[i], world.particles.id[rows.index[k]]});
        EXPECT_EQ(of_rows, expected);
        EXPECT_EQ(rows.start[500], static_cast<int64_t>(expected.size()));
    }
}

// Rows of cells so long that no step of 16 bits leads to the row above: the way goes over places that nobody sees.
TEST(Neighbors, AreFoundFartherThanAStep) {
    const int columns = 40000, rows = 4;
    std::vector<double> x, y;
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            x.push_back(i + 0.1 * std::sin(7.0 * i + j));
            y.push_back(j + 0.1 * std::cos(5.0 * i - j));
        }
    Points points(x, y);
    const World &world = points.build();
    const Particles &p = world.particles;
    const double radius = world.constants.horizon + world.skin;
    int64_t longest = 0;
    for (int64_t c = 0; c < world.clusters.count(); c += 97) {
        const int64_t first = world.clusters.first[c];
        std::set<int64_t> seen, expected;
        for_each_entry(world.clusters, world.clusters.all, c, [&](int64_t, int32_t j) {
            ASSERT_GE(j, 0);
            ASSERT_LT(j, p.count);
            if (distance(world, first, j) < radius) {
                EXPECT_TRUE(seen.insert(p.id[j]).second) << "twice";
                longest = std::max(longest, std::abs(j - first));
            }
        });
        const int64_t own = p.id[first] % columns;
        for (int j = 0; j < rows; ++j)
            for (int64_t i = std::max<int64_t>(0, own - 6); i < std::min<int64_t>(columns, own + 7); ++i)
                if (const int64_t id = j * columns + i; std::hypot(x[id] - p.x[first], y[id] - p.y[first]) < radius)
                    expected.insert(id);
        EXPECT_EQ(seen, expected);
    }
    EXPECT_GT(longest, 2 * INT16_MAX);
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
            EXPECT_NE(contact.facet, 2);
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
