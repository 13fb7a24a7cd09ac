// Columns from flat to very tall, coarse ones, layers of one grain, and what stays at rest for long.
#include "extreme_support.hpp"

using namespace test;

namespace {

struct Deposit {
    gp_state state;
    double run_out, height; // (L_end - L) / L of the half width, and H_end / L
};

// Half a column of `across` x `up` spacings beside a smooth wall, its plane of symmetry.
Deposit fall(int across, int up) {
    const double dl = 0.0025, half = across * dl, height = up * dl, time = std::sqrt(height / 9.81);
    Sim sim(config(dl));
    sim.column(0, 0, half, height);
    sim.add(floor_at(0, -0.1, half + 20 * height));
    sim.add(plate(0, 0, 0, 2 * height, GP_WALL_FREE_SLIP));
    const gp_state s = run_to_rest(sim, time, 20 * time);
    EXPECT_EQ(s.at_rest, 1);
    expect_finite(sim);
    // The ledger's error, and what the scheme's own losses are to those by friction.
    EXPECT_LT(std::abs(s.energy_error), 0.02 * 1550 * 9.81 * half * height * height / 2);
    return {s, (s.x_right - half) / half, s.peak_height / half};
}

} // namespace

// (L - L0) / L0 = 1.2 a, 1.9 a^(2/3) from a = 2.3 on (Lube et al. 2005, channel); two-dimensional grains go further: 2.5 a,
// 3.25 a^0.7 from a = 2 on (Staron & Hinch 2005); so does the law: 2.2 a, 3.9 a^0.7 from a = 7 on (Lagree et al. 2011).
TEST(AspectRatio, RunsOutAsTheScalingLawsSay) {
    struct Case {
        int across, up;
    };
    for (const Case c : {Case{40, 4}, Case{32, 16}, Case{16, 16}, Case{12, 24}, Case{8, 40}, Case{6, 60}}) {
        const double a = static_cast<double>(c.up) / c.across;
        SCOPED_TRACE(a);
        const Deposit d = fall(c.across, c.up);
        const double low = a < 2.3 ? 1.2 * a : 1.9 * std::pow(a, 2. / 3);
        const double high =
            std::max(a < 2 ? 2.5 * a : 3.25 * std::pow(a, 0.7), a < 7 ? 2.2 * a : 3.9 * std::pow(a, 0.7));
        EXPECT_GT(d.run_out, 0.95 * low);
        EXPECT_LT(d.run_out, high);
        EXPECT_LE(d.height, a + 1e-6);
    }
}

TEST(AspectRatio, OfFiftyComesToRest) {
    const Deposit d = fall(4, 200);
    EXPECT_GT(d.run_out, 0.95 * 1.9 * std::pow(50, 2. / 3));
    EXPECT_LT(d.run_out, 3.9 * std::pow(50, 0.7));
}

// The front is a grain or two.
TEST(Resolution, OfEightGivesTheDepositOfThirtyTwo) {
    for (const int resolution : {8, 16, 32}) {
        SCOPED_TRACE(resolution);
        Collapse collapse(resolution);
        const gp_state s = run_to_rest(collapse.sim, 0.1, 1);
        EXPECT_EQ(s.at_rest, 1);
        EXPECT_NEAR(s.peak_height / Collapse::length, 0.408, 0.05 * 0.408);
        EXPECT_NEAR((s.x_right - s.x_left) / Collapse::length - 1, 2.04, 4. / resolution);
    }
}

// A row of grains (or two, or three) on a rough floor: its ends slump, its middle stays.
TEST(ThinLayer, OnAFloorStays) {
    for (const int rows : {1, 2, 3}) {
        SCOPED_TRACE(rows);
        Sim sim(config(0.0025));
        sim.column(0, 0, 0.05, rows * 0.0025);
        sim.add(floor_at(0, -0.1, 0.2));
        const std::vector<double> x = sim.field(GP_FIELD_X), y = sim.field(GP_FIELD_Y);
        sim.run(1);
        EXPECT_EQ(sim.state().at_rest, 1);
        const std::vector<double> x_end = sim.field(GP_FIELD_X), y_end = sim.field(GP_FIELD_Y);
        for (std::size_t i = 0; i < x.size(); ++i)
            if (rows == 1 || std::abs(x[i] - 0.025) < 0.01) {
                EXPECT_NEAR(x_end[i], x[i], 0.02 * 0.0025);
                EXPECT_NEAR(y_end[i], y[i], 0.02 * 0.0025);
            }
        expect_finite(sim);
    }
}

// Between tan 15 < mu_s = tan 21 < tan 30 < mu_2 = tan 32: in a period, thrown down the slope.
TEST(ThinLayer, FlowsOnASteepSlopeAndStopsOnAGentleOne) {
    for (const int rows : {1, 2, 3})
        for (const double slope : {15., 30.}) {
            SCOPED_TRACE(testing::Message() << rows << " rows, " << slope << " degrees");
            gp_config c = config(0.0025);
            c.gravity_x = 9.81 * std::sin(degrees(slope));
            c.gravity_y = -9.81 * std::cos(degrees(slope));
            c.periodic_x_max = 0.05;
            c.sound_speed = 5;
            Sim sim(c);
            sim.column(0, 0, 0.05, rows * 0.0025, 0, 0.1);
            sim.add(floor_at(0, 0, 0.05));
            sim.run(0.5);
            const double speed = mean(sim.field(GP_FIELD_VX));
            // tan 15 stops .1 m/s within .1 / (g (tan 21 cos 15 - sin 15)) = .09 s
            if (slope < 21) {
                EXPECT_LT(std::abs(speed), 1e-3);
            } else {
                // mu(I) = tan 30 at I = 1.2: a shear rate of 34 1/s under one row, over the way of half a spacing.
                EXPECT_GT(speed, 0.04);
            }
            expect_finite(sim);
        }
}

// A filled box: 6 s of the 60 s that are the study of docs/.
TEST(AtRest, NothingCreepsForSixSeconds) {
    const double dl = 0.005;
    Sim sim(config(dl));
    sim.column(-0.04, 0, 0.08, 0.05);
    for (const gp_plate &p : {floor_at(0, -0.04, 0.04), plate(-0.04, 0, -0.04, 0.1), plate(0.04, 0.1, 0.04, 0)})
        sim.add(p);
    const std::vector<double> x = sim.field(GP_FIELD_X), y = sim.field(GP_FIELD_Y);
    sim.run(1);
    const double early = sim.state().kinetic;
    const std::vector<double> x1 = sim.field(GP_FIELD_X), y1 = sim.field(GP_FIELD_Y);
    sim.run(6);
    const gp_state s = sim.state();
    EXPECT_EQ(s.at_rest, 1);
    EXPECT_LT(s.kinetic, 1e-6 * Collapse::energy);
    EXPECT_LE(s.kinetic, std::max(early, 1e-9 * Collapse::energy));
    EXPECT_LT(difference(sim.field(GP_FIELD_X), x1), 0.01 * dl);
    EXPECT_LT(difference(sim.field(GP_FIELD_Y), y1), 0.01 * dl);
}
