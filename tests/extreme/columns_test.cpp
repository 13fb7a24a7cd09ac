// Columns from flat to very tall, coarse ones, layers of one grain, and what stays at rest for long.
#include "../support/ensemble.hpp"
#include "extreme_support.hpp"

using namespace test;

namespace {

struct Deposit {
    gp_state state;
    double run_out, height,
        error; // (L_end - L) / L of the half width, H_end / L, that of the ledger over the start's energy
};

// Half a column of `across` x `up` spacings beside a smooth wall, its plane of symmetry; the k-th of its runs.
Deposit fall(int across, int up, int k) {
    const double dl = 0.0025, half = across * dl, height = up * dl, time = std::sqrt(height / 9.81);
    Sim sim(shaken(config(dl), k));
    sim.column(0, 0, half, height);
    sim.add(floor_at(0, -0.1, half + 20 * height));
    sim.add(plate(0, 0, 0, 2 * height, GP_WALL_FREE_SLIP));
    const gp_state s = run_to_rest(sim, time, 20 * time);
    EXPECT_EQ(s.at_rest, 1);
    expect_finite(sim);
    const double energy = 1550 * 9.81 * half * height * height / 2;
    // The material ends half a spacing beyond its last particle, as the column did.
    return {s, (s.x_right + dl / 2 - half) / half, s.peak_height / half, std::abs(s.energy_error) / energy};
}

} // namespace

// (L - L0) / L0 = 1.2 a, 1.9 a^(2/3) from a = 2.3 on (Lube et al. 2005, channel); two-dimensional grains go further: 2.5 a,
// 3.25 a^0.7 from a = 2 on (Staron & Hinch 2005); so does the law: 2.2 a, 3.9 a^0.7 from a = 7 on (Lagree et al. 2011).
TEST(AspectRatio, RunsOutAsTheScalingLawsSay) {
    struct Case {
        int across, up, runs;
    };
    for (const Case c :
         {Case{80, 8, 6}, Case{32, 16, 3}, Case{16, 16, 3}, Case{12, 24, 3}, Case{8, 40, 4}, Case{6, 60, 4}}) {
        const double a = static_cast<double>(c.up) / c.across;
        SCOPED_TRACE(a);
        Sample run_out;
        for (int k = 0; k < c.runs; ++k) {
            const Deposit d = fall(c.across, c.up, k);
            run_out.add(d.run_out);
            EXPECT_LE(d.height, a + shake / c.across + 1e-6);
            EXPECT_LT(d.error, 0.02);
        }
        const double low = a < 2.3 ? 1.2 * a : 1.9 * std::pow(a, 2. / 3);
        const double high =
            std::max(a < 2 ? 2.5 * a : 3.25 * std::pow(a, 0.7), a < 7 ? 2.2 * a : 3.9 * std::pow(a, 0.7));
        expect_mean_above("run-out", run_out, 0.95 * low);
        expect_mean_below("run-out", run_out, high);
    }
}

// One run scatters by 7 % in the run-out, 30 % away from the nearer bound, and by 2 % of it in the error of the ledger. That
// is one of the time integration, 2.9 % of the energy, 1.5 % with half the step; 3.2 and 2.5 % with a bulk viscosity of .05
// and .2 (8 and 2 runs; without jitter 2.2 % at the default, which is off by more than the scatter).
TEST(AspectRatio, OfFiftyComesToRest) {
    const Deposit d = fall(4, 200, 0);
    EXPECT_GT(d.run_out, 0.95 * 1.9 * std::pow(50, 2. / 3));
    EXPECT_LT(d.run_out, 3.9 * std::pow(50, 0.7));
    EXPECT_LT(d.error, 0.032);
}

// Fronts of coarse columns lag behind: 90 % of the mass lie within one grain a side of where those of the fine one do (.8 and
// .7 of a grain, so -.21 and -.09 of 2.08 L with L/dl = 8 and 16). Peaks of 16 are within 5 % (-2.3), those of 8 within 10 % (+7.7: a
// heap of 40 grains, five rows high, has steps). The tips' single grains lag by three a side at most with 16; with 8 no more can be
// said of them than that they are within the fine ones' (1.08 of 1.81 L).
TEST(Resolution, OfEightGivesTheDepositOfThirtyTwo) {
    struct Ensemble {
        Sample peak, width, run_out;
    };
    const auto deposits = [](int resolution, int runs) {
        Ensemble found;
        for (int k = 0; k < runs; ++k) {
            Sim sim(shaken(config(Collapse::length / resolution), k));
            sim.column(-Collapse::length / 2, 0, Collapse::length, Collapse::height);
            sim.add(floor_at(0, -0.4, 0.4));
            sim.run(1); // of coarse deposits single grains tremble until then
            const gp_state s = sim.state();
            EXPECT_LT(s.kinetic, 1e-6 * Collapse::energy);
            found.peak.add(s.peak_height / Collapse::length);
            found.width.add((s.x_q95 - s.x_q05) / Collapse::length);
            found.run_out.add((s.x_right - s.x_left) / Collapse::length - 1);
        }
        return found;
    };
    const Ensemble fine = deposits(32, 6);
    for (const int resolution : {8, 16}) {
        SCOPED_TRACE(resolution);
        const Ensemble coarse = deposits(resolution, resolution == 8 ? 40 : 12);
        expect_means_near("peak", coarse.peak, fine.peak, (resolution == 8 ? 0.1 : 0.05) * fine.peak.mean());
        expect_means_near("width of 90 % of the mass", coarse.width, fine.width, 2. / resolution);
        if (resolution == 16)
            expect_means_near("run-out", coarse.run_out, fine.run_out, 6. / resolution);
        else
            expect_mean_larger("run-out", fine.run_out, 1, coarse.run_out);
    }
}

// A row of grains (or two, or three) on a rough floor: its ends slump, and reach their middle by no more than the wave of
// their release, which is over within a second. (The slump moves what is 2 heights from an end by .02 dl, at any speed of
// sound; here the middle is 6 heights away and more, and moves by .001 to .005 dl; one row, with its ends, by .005.)
TEST(ThinLayer, OnAFloorStays) {
    const double dl = 0.0025, width = 48 * dl;
    for (const int rows : {1, 2, 3}) {
        SCOPED_TRACE(rows);
        Sim sim(config(dl));
        sim.column(0, 0, width, rows * dl);
        sim.add(floor_at(0, -0.1, width + 0.1));
        const std::vector<double> x = sim.field(GP_FIELD_X), y = sim.field(GP_FIELD_Y);
        sim.run(1);
        const std::vector<double> x_early = sim.field(GP_FIELD_X), y_early = sim.field(GP_FIELD_Y);
        sim.run(2);
        EXPECT_EQ(sim.state().at_rest, 1);
        const std::vector<double> x_end = sim.field(GP_FIELD_X), y_end = sim.field(GP_FIELD_Y);
        for (std::size_t i = 0; i < x.size(); ++i)
            if (rows == 1 || std::abs(x[i] - width / 2) < 4 * dl) {
                EXPECT_NEAR(x_end[i], x[i], 0.01 * dl);
                EXPECT_NEAR(y_end[i], y[i], 0.01 * dl);
                EXPECT_NEAR(x_end[i], x_early[i], 1e-4 * dl);
                EXPECT_NEAR(y_end[i], y_early[i], 1e-4 * dl);
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

// Of forty particles two at the tips may tremble: each is 2.5 % of the mass. (With 1 % of the mass as the limit 2 of these 24
// deposits were not at rest, at a kinetic energy of 1e-8 of the scene's.) A third one does at times: of 192 deposits, looked at twenty
// times each, 5 did not read rest at 19 looks, .5 % (with steps of .8 dl / wave speed 12 at 55, 1.4 %).
TEST(AtRest, CoarseDepositsAreSeenToRestAndTheirFallIsNot) {
    int looks = 0, seen = 0;
    for (int k = 0; k < 24; ++k) {
        SCOPED_TRACE(k);
        Sim sim(shaken(config(Collapse::length / 8), k));
        sim.column(-Collapse::length / 2, 0, Collapse::length, Collapse::height);
        sim.add(floor_at(0, -0.4, 0.4));
        while (sim.state().time < 0.2) {
            sim.step(1);
            ASSERT_EQ(sim.state().at_rest, 0) << sim.state().time << " s";
        }
        for (double time = 1; time < 2; time += 0.05) {
            sim.run(time);
            ++looks;
            seen += sim.state().at_rest;
        }
        EXPECT_LT(sim.state().kinetic, 1e-6 * Collapse::energy);
    }
    EXPECT_GE(seen, 0.98 * looks);
}
