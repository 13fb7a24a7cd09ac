// What the volume drift makes of particles that have come closer than their density says, and the warning of it: no scene does
// that by itself any more, so they are put there.
#include <gtest/gtest.h>

#include "volume_drift.hpp"
#include "warnings.hpp"
#include "world_support.hpp"

using namespace gp;
using test::Block;

namespace {

// A block in shear at yield, its packing known, whose particles then lie closer by `share` in both directions.
struct Sheared {
    explicit Sheared(double share, double jitter = 0.2) : block(32, jitter) {
        World &world = *block.world;
        Particles &p = world.particles;
        world.packing_at_start = measure_packing(world, Part::all).number_density;
        const double rate = 1 / world.constants.time_scale();
        block.set(p.pressure, [](double, double) { return 1.0; });
        block.set(p.sxy, [](double, double) { return 1.0; }); // mu of 1, above any of the law's
        block.set(p.lxy, [&](double, double) { return rate; });
        for (int64_t i = 0; i < p.count; ++i) {
            p.x[i] *= 1 - share;
            p.y[i] *= 1 - share;
        }
        stages::update_neighbors(world);
        world.clock.step = 1024;
    }
    Block block;
};

double lost_by(double share) {
    return 1 / ((1 - share) * (1 - share)) - 1;
}

int told_of_volume(const std::vector<std::string> &texts) {
    int found = 0;
    for (const std::string &text : texts)
        found += text.find("lost volume") != std::string::npos &&
                 text.find("closer than their density says") != std::string::npos &&
                 text.find("gp_config.spacing") != std::string::npos;
    return found;
}

} // namespace

TEST(VolumeDrift, IsTheVolumeThatParticlesHaveLost) {
    for (const double jitter : {0.0, 0.2})
        for (const double share : {-0.01, 0.0, 0.01, 0.03, 0.05}) {
            const Sheared sheared(share, jitter);
            const Packing flowing = measure_packing(*sheared.block.world, Part::flowing);
            EXPECT_GT(flowing.particles, 1024 / 3) << share; // the inner ones: full horizons
            // The sum over a lattice is not quite that over a plane, and full neighbourhoods are another few.
            EXPECT_NEAR(drift_of(*sheared.block.world, flowing), lost_by(share),
                        0.05 * std::abs(lost_by(share)) + 1e-12)
                << share << ", jitter " << jitter;
            EXPECT_NEAR(flowing.density, 1, 1e-12) << "it does not know";
        }
}

TEST(VolumeDrift, IsNothingWhereNothingFlows) {
    for (const bool sheared : {true, false}) { // at rest at yield, or in shear inside the yield surface
        Sheared still(0.03);
        Particles &p = still.block.world->particles;
        still.block.set(sheared ? p.sxy : p.lxy, [](double, double) { return 0.0; });
        const Packing flowing = measure_packing(*still.block.world, Part::flowing);
        EXPECT_EQ(flowing.particles, 0);
        EXPECT_EQ(drift_of(*still.block.world, flowing), 0);
    }
}

TEST(VolumeDrift, IsToldOfOnceFromTwoPerCentOn) {
    for (const double share : {0.0, 0.008, 0.013, 0.05}) {
        Sheared sheared(share);
        Warnings warnings;
        EXPECT_EQ(told_of_volume(warnings.of_step(*sheared.block.world)), lost_by(share) > 0.02) << share;
        EXPECT_EQ(told_of_volume(warnings.of_step(*sheared.block.world)), 0) << share;
    }
    // A density that says so, too, is compression.
    Sheared compressed(0.05);
    World &world = *compressed.block.world;
    for (double &density : world.particles.density)
        density *= 1 + lost_by(0.05);
    EXPECT_EQ(told_of_volume(Warnings().of_step(world)), 0);
    // Looked at every 1024 steps.
    Sheared between(0.05);
    between.block.world->clock.step = 1023;
    EXPECT_EQ(told_of_volume(Warnings().of_step(*between.block.world)), 0);
}
