// What rests is left out of the work (gp_config.sleep), and nothing else changes: what moves it wakes it in time.
#include <algorithm>
#include <cstdio>

#include "../support/scene.hpp"

using namespace test;

namespace {

gp_config sleeping(double spacing, int32_t sleep = 1) {
    gp_config c = config(spacing);
    c.sleep = sleep;
    return c;
}

// A box with rough walls, of a whole number of spacings, filled up to `height`.
struct Box {
    static constexpr double dl = 0.005, width = 24 * dl;
    explicit Box(int32_t sleep, double height = 16 * dl, int32_t walls = GP_WALL_FREE_SLIP)
        : sim(sleeping(dl, sleep)), weight(1550 * 9.81 * width * height) {
        sim.column(0, 0, width, height);
        floor = sim.add(floor_at(0, 0, width));
        left = sim.add(plate(0, 0, 0, 1, walls));
        right = sim.add(plate(width, 1, width, 0, walls));
    }
    Sim sim;
    double weight;
    int32_t floor = 0, left = 0, right = 0;
};

double largest_difference(const std::vector<double> &a, const std::vector<double> &b) {
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        most = std::max(most, std::abs(a[i] - b[i]));
    return most;
}

} // namespace

// A deposit falls asleep as a whole, after some 8 sqrt(dl / g) of rest, and is what it would be without: up to then the bits are
// the same, from then on what would still creep has stopped.
TEST(Sleep, LeavesADepositAsItIs) {
    for (const uint64_t seed : {1, 2, 3}) {
        gp_state end[2];
        for (const int32_t sleep : {0, 1}) {
            gp_config c = sleeping(Collapse::length / 24, sleep);
            c.jitter = 0.01;
            c.seed = seed;
            Sim sim(c);
            sim.column(-Collapse::length / 2, 0, Collapse::length, Collapse::height);
            sim.add(floor_at(0, -0.4, 0.4));
            sim.run(0.2);
            EXPECT_EQ(sim.state().n_awake, sim.state().n_particles);
            sim.run(2);
            end[sleep] = sim.state();
            const double weight = 1550 * 9.81 * Collapse::length * Collapse::height;
            EXPECT_NEAR(sim.load(0).fy, -weight, 0.002 * weight);
        }
        EXPECT_EQ(end[0].n_awake, end[0].n_particles);
        EXPECT_EQ(end[1].n_awake, 0);
        EXPECT_EQ(end[1].kinetic, 0);
        EXPECT_EQ(end[1].at_rest, 1);
        EXPECT_NEAR(end[1].peak_height, end[0].peak_height, 0.002 * Collapse::length);
        EXPECT_NEAR(end[1].x_q95 - end[1].x_q05, end[0].x_q95 - end[0].x_q05, 0.002 * Collapse::length);
        EXPECT_NEAR(end[1].energy_error, end[0].energy_error, 1e-4 * Collapse::energy);
        std::printf("peak %g %g q %g %g err %g %g\n", end[0].peak_height, end[1].peak_height, end[0].x_q95, end[1].x_q95,
                    end[0].energy_error, end[1].energy_error);
    }
}

// The floor bears what sleeps: the weight of a column, of which rough walls bear a part as well.
TEST(Sleep, PlatesGoOnBearing) {
    for (const int32_t walls : {GP_WALL_FREE_SLIP, GP_WALL_NO_SLIP}) {
        Box awake(0, 24 * Box::dl, walls), asleep(1, 24 * Box::dl, walls);
        awake.sim.run(1.5);
        asleep.sim.run(1.5);
        EXPECT_EQ(asleep.sim.state().n_awake, 0);
        double down = 0;
        for (int32_t k = 0; k < 3; ++k) {
            const gp_load a = asleep.sim.load(k), b = awake.sim.load(k);
            down -= a.fy;
            EXPECT_NEAR(a.fx, b.fx, 0.02 * awake.weight) << walls << " " << k;
            EXPECT_NEAR(a.fy, b.fy, 0.02 * awake.weight) << walls << " " << k;
            EXPECT_NEAR(a.torque, b.torque, 0.02 * awake.weight * Box::width) << walls << " " << k;
            std::printf("%d %d: %g %g, %g %g, %g %g\n", walls, k, a.fx, b.fx, a.fy, b.fy, a.torque, b.torque);
        }
        EXPECT_NEAR(down, asleep.weight, 0.002 * asleep.weight) << walls;
        EXPECT_NEAR(asleep.sim.state().max_pressure, awake.sim.state().max_pressure,
                    0.02 * awake.sim.state().max_pressure);
    }
}

// A block that falls on a bed that sleeps.
TEST(Sleep, ABlowWakesABed) {
    constexpr double dl = Box::dl;
    gp_state end[2];
    double highest[2] = {0, 0};
    for (const int32_t sleep : {0, 1}) {
        Box box(sleep, 12 * dl);
        box.sim.column(8 * dl, 0.6, 8 * dl, 8 * dl);
        box.sim.run(0.30);
        if (sleep) {
            EXPECT_EQ(box.sim.state().n_awake, 64) << "the block alone";
            std::printf("before the blow %g awake\n", double(box.sim.state().n_awake));
        }
        for (double t = 0.301; t < 0.6; t += 0.001) {
            box.sim.run(t);
            highest[sleep] = std::max(highest[sleep], -box.sim.load(box.floor).fy);
        }
        if (sleep)
            EXPECT_GT(box.sim.state().n_awake, 0.5 * double(box.sim.state().n_particles));
        box.sim.run(3);
        end[sleep] = box.sim.state();
        std::printf("%d awake %g highest load %g peak %g pot %g err %g coll %g\n", sleep, double(end[sleep].n_awake),
                    highest[sleep], end[sleep].peak_height, end[sleep].potential, end[sleep].energy_error,
                    end[sleep].max_compression);
    }
    EXPECT_EQ(end[1].n_awake, 0);
    EXPECT_NEAR(highest[1], highest[0], 0.03 * highest[0]);
    EXPECT_NEAR(end[1].potential, end[0].potential, 0.01 * end[0].potential);
}

// A wave: the floor of a column that sleeps is moved up for a moment, and the row at the top feels it when and as it would.
TEST(Sleep, AWaveArrives) {
    constexpr double dl = Box::dl;
    double first[2], fastest[2];
    for (const int32_t sleep : {0, 1}) {
        Box box(sleep, 40 * dl);
        box.sim.run(1);
        if (sleep)
            EXPECT_EQ(box.sim.state().n_awake, 0);
        ASSERT_EQ(gp_set_plate_motion(box.sim, box.floor, 0, 0.02, 0), GP_OK);
        first[sleep] = fastest[sleep] = 0;
        for (int k = 0; k < 300; ++k) {
            if (k == 20)
                ASSERT_EQ(gp_set_plate_motion(box.sim, box.floor, 0, 0, 0), GP_OK);
            box.sim.step();
            const std::vector<double> y = box.sim.field(GP_FIELD_Y), v = box.sim.field(GP_FIELD_VY);
            for (std::size_t i = 0; i < y.size(); ++i)
                if (y[i] > 39 * dl) {
                    if (v[i] > 0.004 && first[sleep] == 0)
                        first[sleep] = box.sim.state().time - 1;
                    fastest[sleep] = std::max(fastest[sleep], v[i]);
                }
        }
        std::printf("%d first %g fastest %g dt %g\n", sleep, first[sleep], fastest[sleep], box.sim.state().dt);
    }
    EXPECT_GT(first[0], 0);
    EXPECT_NEAR(first[1], first[0], 0.05 * first[0]);
    EXPECT_NEAR(fastest[1], fastest[0], 0.05 * fastest[0]);
}

// A gate that holds a column asleep is drawn up: the collapse is that of a column that has been awake.
TEST(Sleep, AGateLetsAColumnGo) {
    gp_state end[2];
    for (const int32_t sleep : {0, 1}) {
        Sim sim(sleeping(0.005, sleep));
        sim.column(0, 0, 0.12, 0.12);
        sim.add(floor_at(0, -0.1, 1));
        sim.add(plate(0, 0, 0, 0.5, GP_WALL_FREE_SLIP));
        gp_plate gate = plate(0.12, 0.3, 0.12, 0, GP_WALL_FREE_SLIP);
        const double t[] = {1, 1.1}, x[] = {0, 0}, y[] = {0, 0.3};
        gate.n_knots = 2;
        gate.knot_t = t;
        gate.knot_x = x;
        gate.knot_y = y;
        sim.add(gate);
        sim.run(0.99);
        if (sleep)
            EXPECT_EQ(sim.state().n_awake, 0);
        sim.run(1.1);
        if (sleep)
            EXPECT_EQ(sim.state().n_awake, sim.state().n_particles);
        sim.run(3);
        end[sleep] = sim.state();
        std::printf("%d peak %g q95 %g awake %g\n", sleep, end[sleep].peak_height, end[sleep].x_q95, double(end[sleep].n_awake));
    }
    EXPECT_NEAR(end[1].x_q95, end[0].x_q95, 0.02 * end[0].x_q95);
    EXPECT_NEAR(end[1].peak_height, end[0].peak_height, 0.02 * end[0].peak_height);
    EXPECT_LT(std::abs(end[1].energy_error), 0.02 * end[1].dissipated);
}
