// What four ghosts, or the particles of a cluster, see together is what each of them sees.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "operators.hpp"
#include "stages/stages.hpp"
#include "world_support.hpp"

using namespace gp;

namespace {

std::vector<int32_t> seen_by_lane(const LaneRows &rows, int64_t group, int lane) {
    std::vector<int32_t> seen;
    for (int64_t k = rows.start[group]; k < rows.start[group + 1]; ++k)
        if (rows.seen_by[k] >> lane & 1)
            seen.push_back(rows.index[k]);
    return seen;
}

// A jittered column in the corner of a floor and a wall.
struct Corner {
    Corner() {
        gp_config config = default_config(GP_PRESET_DEFAULT);
        config.spacing = 0.1;
        config.jitter = 0.2;
        config.threads = 1;
        scene = std::make_unique<Scene>(config);
        gp_column column = default_column();
        column.width = column.height = 1.23;
        std::string note;
        scene->add_column(column, note);
        gp_plate plate = default_plate();
        plate.x0 = 3;
        plate.x1 = -0.5;
        scene->add_plate(plate);
        plate.x0 = plate.x1 = 0;
        plate.y0 = 0;
        plate.y1 = 2;
        plate.friction = GP_WALL_FREE_SLIP;
        scene->add_plate(plate);
        world = make_world(*scene);
        stages::update_neighbors(*world);
    }
    std::unique_ptr<Scene> scene;
    std::unique_ptr<World> world;
};

} // namespace

TEST(WallLanes, SeeWhatEachSees) {
    const Corner corner;
    const Walls &walls = corner.world->walls;
    const WallLanes &lanes = walls.lanes;
    ASSERT_GT(walls.ghost_count, 50);
    for (int64_t k = 0; k < walls.ghost_count; ++k) {
        const NeighborList &rows = walls.particles_of_ghost;
        const std::vector<int32_t> plain(rows.index.begin() + rows.start[k], rows.index.begin() + rows.start[k + 1]);
        EXPECT_EQ(seen_by_lane(lanes.particles_of_ghosts, k / lane_count, static_cast<int>(k % lane_count)), plain);
    }
    const ClusterList &clusters = corner.world->clusters;
    std::vector<int> found(walls.contacts.size(), 0);
    for (int64_t c = 0; c < clusters.count(); ++c)
        for (int32_t g = lanes.of_cluster[c]; g < lanes.of_cluster[c + 1]; ++g)
            for (int l = 0; l < lane_count; ++l) {
                const int32_t k = lanes.contacts[g].contact[l];
                const std::vector<int32_t> seen = seen_by_lane(lanes.ghosts_of_contacts, g, l);
                if (k < 0) {
                    EXPECT_TRUE(seen.empty());
                    continue;
                }
                const Contact &contact = walls.contacts[k];
                ++found[k];
                EXPECT_EQ(contact.particle, clusters.first[c] + l);
                EXPECT_EQ(seen, std::vector<int32_t>(walls.ghost_of_contact.begin() + contact.begin,
                                                     walls.ghost_of_contact.begin() + contact.end));
            }
    EXPECT_EQ(found, std::vector<int>(walls.contacts.size(), 1)); // each once
}

// The shape tensor of a particle and its ghosts, by plain sums; to rounding, of some hundred terms.
TEST(WallLanes, AddUpToPlainSums) {
    const Corner corner;
    World &world = *corner.world;
    Particles &p = world.particles;
    const Walls &walls = world.walls;
    stages::flowing(world);
    stages::wall_velocity(world);
    stages::gradient(world);
    const double moment = world.constants.lattice.second_moment, inverse = 1 / world.constants.horizon;
    int compared = 0;
    for (const Contact &contact : walls.contacts) {
        const int64_t i = contact.particle;
        Moments m;
        const auto add = [&](double x, double y) {
            const double dx = x - p.x[i], dy = y - p.y[i], w = weight(std::hypot(dx, dy), inverse);
            m.kxx += w * dx * dx;
            m.kxy += w * dx * dy;
            m.kyy += w * dy * dy;
        };
        for (int64_t j = 0; j < p.count; ++j)
            add(p.x[j], p.y[j]);
        const double carried = carried_share(m.kxx + m.kyy, moment);
        for (int32_t c = walls.contact_start[i]; c < walls.contact_start[i + 1]; ++c)
            for (int64_t k = walls.contacts[c].begin; k < walls.contacts[c].end; ++k)
                add(walls.ghost_x[walls.ghost_of_contact[k]], walls.ghost_y[walls.ghost_of_contact[k]]);
        const SymmetricTensor k = inverse_shape(m, moment);
        const double tolerance = 1e-12 / moment;
        EXPECT_NEAR(p.gxx[i], carried * k.xx, tolerance);
        EXPECT_NEAR(p.gxy[i], carried * k.xy, tolerance);
        EXPECT_NEAR(p.gyy[i], carried * k.yy, tolerance);
        ++compared;
    }
    EXPECT_GT(compared, 50);
}
