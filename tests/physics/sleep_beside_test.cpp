// Sleep (gp_config.sleep) beside belts and between the side walls of a channel, and of a mirrored scene.
#include <algorithm>

#include "../support/scene.hpp"

using namespace test;

namespace {

constexpr double dl = 0.005;

gp_config sleeping(int32_t sleep, double spacing = dl) {
    gp_config c = config(spacing);
    c.sleep = sleep;
    return c;
}

// A bed between smooth walls, on a floor whose right part is a belt that slips beneath it: it presses the bed to the right wall
// and moves nothing.
struct OverABelt {
    static constexpr double width = 96 * dl, height = 10 * dl, belt_width = 24 * dl, belt_speed = 0.2, wall_mu = 0.1;
    explicit OverABelt(int32_t sleep) : sim(sleeping(sleep)) {
        sim.column(0, 0, width, height);
        sim.add(floor_at(0, 0, width - belt_width));
        gp_plate moving = floor_at(0, width - belt_width, width, GP_WALL_COULOMB);
        moving.wall_mu = wall_mu;
        moving.surface_velocity = -belt_speed; // its line runs to the left
        belt = sim.add(moving);
        sim.add(plate(0, 0, 0, 1, GP_WALL_FREE_SLIP));
        right = sim.add(plate(width, 1, width, 0, GP_WALL_FREE_SLIP));
    }
    Sim sim;
    int32_t belt = 0, right = 0;
};

} // namespace

// What sees the belt is computed in every step, what is farther off sleeps; the belt pulls and works as without.
TEST(SleepBeside, ABeltGoesOnPulling) {
    double pull[2], weight[2], push[2], work[2];
    for (const int32_t sleep : {0, 1}) {
        OverABelt bed(sleep);
        bed.sim.run(1.2);
        const gp_state begin = bed.sim.state();
        const gp_load before = bed.sim.load(bed.belt), wall_before = bed.sim.load(bed.right);
        bed.sim.run(1.8);
        const gp_state end = bed.sim.state();
        pull[sleep] = bed.sim.load(bed.belt).impulse_x - before.impulse_x;
        weight[sleep] = bed.sim.load(bed.belt).impulse_y - before.impulse_y;
        push[sleep] = bed.sim.load(bed.right).impulse_x - wall_before.impulse_x;
        work[sleep] = end.plate_work - begin.plate_work;
        if (sleep) {
            EXPECT_LT(end.n_awake, 0.7 * double(end.n_particles));
            EXPECT_GT(end.n_awake, 0.2 * double(end.n_particles)); // those over the belt alone are a quarter
        }
        // All that the belt gives is lost in the slip.
        EXPECT_NEAR(end.dissipated - begin.dissipated, -work[sleep], 1e-3 * -work[sleep]);
        EXPECT_NEAR(work[sleep], OverABelt::belt_speed * pull[sleep], 1e-6 * -work[sleep]);
        EXPECT_LT(pull[sleep], 0); // of the bed on the belt
    }
    EXPECT_NEAR(pull[1], pull[0], 0.01 * std::abs(pull[0]));
    EXPECT_NEAR(weight[1], weight[0], 0.01 * std::abs(weight[0]));
    EXPECT_NEAR(push[1], push[0], 0.01 * std::abs(push[0]));
    EXPECT_NEAR(work[1], work[0], 0.01 * std::abs(work[0]));
}

// Side walls of a channel: the deposit that they hold falls asleep as it is, and their share of the ledger stays.
TEST(SleepBeside, SideWallsHoldWhatSleeps) {
    gp_state end[2];
    for (const int32_t sleep : {0, 1}) {
        gp_config c = sleeping(sleep, Collapse::length / 24);
        c.channel_width = 0.02;
        c.channel_friction = 0.2;
        Sim sim(c);
        sim.column(-Collapse::length / 2, 0, Collapse::length, Collapse::height);
        sim.add(floor_at(0, -0.4, 0.4));
        sim.run(1.5);
        end[sleep] = sim.state();
    }
    EXPECT_EQ(end[1].n_awake, 0);
    EXPECT_EQ(end[1].at_rest, 1);
    EXPECT_GT(end[1].channel_dissipated, 0.05 * end[1].dissipated);
    // A trembling grain whose friction is counted on and on is what they differ by.
    EXPECT_NEAR(end[1].channel_dissipated, end[0].channel_dissipated, 0.01 * end[0].channel_dissipated);
    EXPECT_NEAR(end[1].peak_height, end[0].peak_height, 0.002 * Collapse::length);
    EXPECT_NEAR(end[1].x_q95 - end[1].x_q05, end[0].x_q95 - end[0].x_q05, 0.002 * Collapse::length);
    EXPECT_NEAR(end[1].energy_error, end[0].energy_error, 1e-4 * Collapse::energy);
}

// Particles are sorted from left to right, so that the sums of a mirrored scene are added up in another order; what comes of it is
// the same.
TEST(SleepBeside, AMirroredSceneIsMirrored) {
    gp_state end[2];
    double floor[2], wall[2];
    for (const int32_t mirrored : {0, 1}) {
        const double sign = mirrored ? -1 : 1;
        Sim sim(sleeping(1));
        std::vector<double> x, y;
        for (int row = 0; row < 28; ++row)
            for (int column = 0; column < 40; ++column) {
                x.push_back(sign * (column + 0.5) * dl);
                y.push_back((row + 0.5) * dl);
            }
        ASSERT_EQ(
            gp_add_particles(sim, 0, static_cast<int64_t>(x.size()), x.data(), y.data(), nullptr, nullptr, nullptr),
            GP_OK);
        sim.add(mirrored ? floor_at(0, -1.5, 0) : floor_at(0, 0, 1.5));
        sim.add(mirrored ? plate(0, 1, 0, 0, GP_WALL_FREE_SLIP) : plate(0, 0, 0, 1, GP_WALL_FREE_SLIP));
        bool part = false;
        for (double time = 0.75; time < 1.5; time += 0.05) {
            sim.run(time);
            const gp_state s = sim.state();
            part |= s.n_awake > 0 && s.n_awake < s.n_particles;
        }
        EXPECT_TRUE(part) << "a part of it sleeps before the rest";
        end[mirrored] = sim.state();
        EXPECT_EQ(end[mirrored].n_awake, 0);
        floor[mirrored] = sim.load(0).fy;
        wall[mirrored] = sign * sim.load(1).fx;
    }
    // Rounding has grown to 1e-5 of the width when the first span sleeps.
    const double width = end[0].x_right - end[0].x_left;
    EXPECT_NEAR(end[1].centre_x, -end[0].centre_x, 1e-4 * width);
    EXPECT_NEAR(end[1].peak_height, end[0].peak_height, 1e-3 * width);
    EXPECT_NEAR(end[1].x_q05, -end[0].x_q95, 1e-3 * width);
    EXPECT_NEAR(floor[1], floor[0], 0.002 * std::abs(floor[0]));
    EXPECT_NEAR(wall[1], wall[0], 0.005 * std::abs(wall[0]));
}
