// What rests is left out of the work (gp_config.sleep), and nothing else changes: what moves it wakes it in time.
#include <algorithm>
#include <string>

#include "../support/directory.hpp"
#include "../support/layer.hpp"

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
    explicit Box(int32_t sleep, double height = 16 * dl, int32_t walls = GP_WALL_FREE_SLIP, double sound_speed = 0)
        : sim([&] {
              gp_config c = sleeping(dl, sleep);
              c.sound_speed = sound_speed;
              return c;
          }()),
          weight(1550 * 9.81 * width * height) {
        sim.column(0, 0, width, height);
        floor = sim.add(floor_at(0, 0, width));
        left = sim.add(plate(0, 0, 0, 1, walls));
        right = sim.add(plate(width, 1, width, 0, walls));
    }
    Sim sim;
    double weight;
    int32_t floor = 0, left = 0, right = 0;
};

} // namespace

// A deposit falls asleep as a whole, after some 8 sqrt(dl / g) of rest, and is what it would be without: up to then the bits are
// the same, from then on what would still creep has stopped.
TEST(Sleep, LeavesADepositAsItIs) {
    for (const uint64_t seed : {1, 2}) {
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
            sim.run(1.5);
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
    }
}

// The floor bears what sleeps: the weight of a column, of which rough walls bear a part as well.
TEST(Sleep, PlatesGoOnBearing) {
    for (const int32_t walls : {GP_WALL_FREE_SLIP, GP_WALL_NO_SLIP}) {
        Box awake(0, 24 * Box::dl, walls), asleep(1, 24 * Box::dl, walls);
        awake.sim.run(1);
        asleep.sim.run(1);
        EXPECT_EQ(asleep.sim.state().n_awake, 0);
        double down = 0;
        for (int32_t k = 0; k < 3; ++k) {
            const gp_load a = asleep.sim.load(k), b = awake.sim.load(k);
            down -= a.fy;
            EXPECT_NEAR(a.fx, b.fx, 0.02 * awake.weight) << walls << " " << k;
            EXPECT_NEAR(a.fy, b.fy, 0.02 * awake.weight) << walls << " " << k;
            EXPECT_NEAR(a.torque, b.torque, 0.02 * awake.weight * Box::width) << walls << " " << k;
        }
        EXPECT_NEAR(down, asleep.weight, 0.002 * asleep.weight) << walls;
        EXPECT_NEAR(asleep.sim.state().max_pressure, awake.sim.state().max_pressure,
                    0.02 * awake.sim.state().max_pressure);
    }
}

// A block that falls on a bed that sleeps: of 64 particles, in spans for itself.
TEST(Sleep, ABlowWakesABed) {
    constexpr double dl = Box::dl;
    gp_state end[2];
    double highest[2] = {0, 0};
    for (const int32_t sleep : {0, 1}) {
        Box box(sleep, 16 * dl, GP_WALL_FREE_SLIP, 25);
        box.sim.column(8 * dl, 0.5, 8 * dl, 8 * dl);
        box.sim.run(0.27);
        if (sleep) {
            EXPECT_EQ(box.sim.state().n_awake, 64) << "the block alone";
        }
        for (double t = 0.271; t < 0.4; t += 0.001) {
            box.sim.run(t);
            highest[sleep] = std::max(highest[sleep], -box.sim.load(box.floor).fy);
        }
        if (sleep) {
            EXPECT_EQ(box.sim.state().n_awake, box.sim.state().n_particles);
        }
        box.sim.run(sleep ? 2.2 : 1.5); // at rest since .9; its last swing dies away by 1.9
        end[sleep] = box.sim.state();
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
        if (sleep) {
            EXPECT_EQ(box.sim.state().n_awake, 0);
        }
        ASSERT_EQ(gp_set_plate_motion(box.sim, box.floor, 0, 0.02, 0), GP_OK);
        first[sleep] = fastest[sleep] = 0;
        for (int k = 0; k < 300; ++k) {
            if (k == 20) {
                ASSERT_EQ(gp_set_plate_motion(box.sim, box.floor, 0, 0, 0), GP_OK);
            }
            box.sim.step();
            const std::vector<double> y = box.sim.field(GP_FIELD_Y), v = box.sim.field(GP_FIELD_VY);
            for (std::size_t i = 0; i < y.size(); ++i)
                if (y[i] > 39 * dl) {
                    if (v[i] > 0.004 && first[sleep] == 0)
                        first[sleep] = box.sim.state().time - 1;
                    fastest[sleep] = std::max(fastest[sleep], v[i]);
                }
        }
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
        if (sleep) {
            EXPECT_EQ(sim.state().n_awake, 0);
        }
        sim.run(1.1);
        if (sleep) {
            EXPECT_EQ(sim.state().n_awake, sim.state().n_particles);
        }
        sim.run(3);
        end[sleep] = sim.state();
    }
    EXPECT_NEAR(end[1].x_q95, end[0].x_q95, 0.02 * end[0].x_q95);
    EXPECT_NEAR(end[1].peak_height, end[0].peak_height, 0.02 * end[0].peak_height);
    EXPECT_LT(std::abs(end[1].energy_error), 0.02 * end[1].dissipated);
}

// A layer without ends on a rough floor, mu_s = tan 21 degrees: it sleeps below that, and above it flows as without.
TEST(Sleep, InclinedLayersSleepUpToTheirAngleAlone) {
    for (const double angle : {20.8, 21.2}) {
        double speed[2];
        for (const int32_t sleep : {0, 1}) {
            InclinedLayer layer(angle, sleep);
            layer.sim.run(4);
            const gp_state s = layer.sim.state();
            speed[sleep] = s.rms_speed;
            if (sleep) {
                EXPECT_EQ(s.n_awake, angle < 21 ? 0 : s.n_particles) << angle;
            }
        }
        if (angle > 21) {
            EXPECT_GT(speed[0], 0.005);
            EXPECT_NEAR(speed[1], speed[0], 0.02 * speed[0]);
        }
    }
}

// A change of gravity wakes all: a layer that sleeps is tilted at once, stays at 20 degrees, and flows at 22.
TEST(Sleep, GravityWakes) {
    InclinedLayer layer(0, 1);
    Sim &sim = layer.sim;
    const auto turn_to = [&](double angle) {
        tilt(sim, angle);
        EXPECT_EQ(sim.state().n_awake, sim.state().n_particles);
    };
    sim.run(1);
    EXPECT_EQ(sim.state().n_awake, 0);
    turn_to(10);
    sim.run(2);
    EXPECT_EQ(sim.state().n_awake, 0);
    const gp_load load = sim.load(0); // of weight and shear
    EXPECT_NEAR(load.fy, -layer.weight * std::cos(degrees(10)), 0.005 * layer.weight);
    EXPECT_NEAR(load.fx, layer.weight * std::sin(degrees(10)), 0.005 * layer.weight);
    turn_to(22);
    sim.run(4);
    EXPECT_EQ(sim.state().n_awake, sim.state().n_particles);
    EXPECT_GT(sim.state().rms_speed, 0.01);
    const gp_state s = sim.state();
    EXPECT_LT(std::abs(s.energy_error), 2e-3 * s.dissipated);
}

// Without gravity there is nothing by which to tell that a motion is small: nothing sleeps.
TEST(Sleep, NotWithoutGravity) {
    gp_config c = sleeping(0.005);
    c.gravity_y = 0;
    c.sound_speed = 5;
    Sim sim(c);
    sim.column(0, 0, 0.05, 0.05, 0, 0, 1e-6);
    sim.run(1);
    EXPECT_EQ(sim.state().n_awake, 100);
}

namespace {

// A layer without ends under a lid that presses lightly and is drawn along: the upper rows are sheared for ever, below, where
// the weight has made the pressure larger than the shear stress needs, it sleeps. Two rows of 16 columns are a span.
struct PartlyAsleep {
    static constexpr double dl = 0.005, width = 32 * dl, height = 24 * dl;
    explicit PartlyAsleep(int32_t sleep, int threads = 1, double amplitude = 0)
        : sim([&] {
              gp_config c = sleeping(dl, sleep);
              c.threads = threads;
              c.periodic_x_max = width;
              return c;
          }()) {
        gp_material beads;
        gp_material_init(&beads, sizeof beads);
        beads.nonlocal_amplitude = amplitude;
        sim.column(0, 0, width, height, sim.add(beads));
        floor = sim.add(floor_at(0, 0, width));
        gp_plate loaded = plate(0, height, width, height);
        loaded.normal_pressure = 150;
        loaded.vx = 0.1;
        lid = sim.add(loaded);
    }
    Sim sim;
    int32_t floor = 0, lid = 0;
};

} // namespace

// What sleeps beside what flows changes neither, keeps the ledger, and bears on.
TEST(Sleep, BesideWhatFlows) {
    for (const double amplitude : {0.0, 0.48}) {
        double kinetic[2], dissipated[2];
        for (const int32_t sleep : {0, 1}) {
            PartlyAsleep bed(sleep, 1, amplitude);
            bed.sim.run(1);
            const gp_state begin = bed.sim.state();
            double sum = 0;
            int steps = 0;
            for (double t = 1.01; t < 2; t += 0.01, ++steps) {
                bed.sim.run(t);
                sum += bed.sim.state().kinetic;
            }
            const gp_state s = bed.sim.state();
            kinetic[sleep] = sum / steps;
            dissipated[sleep] = s.dissipated - begin.dissipated;
            if (sleep) {
                EXPECT_LT(s.n_awake, 0.8 * double(s.n_particles)) << amplitude;
                EXPECT_GT(s.n_awake, 0.2 * double(s.n_particles)) << amplitude;
            }
            EXPECT_LT(std::abs(s.energy_error), 2e-3 * s.potential) << amplitude;
            const double weight = (1550 * 9.81 * bed.height + 150) * bed.width;
            EXPECT_NEAR(bed.sim.load(bed.floor).fy, -weight, 0.03 * weight);
        }
        EXPECT_NEAR(kinetic[1], kinetic[0], 0.1 * kinetic[0]) << amplitude;
        EXPECT_NEAR(dissipated[1], dissipated[0], 0.1 * dissipated[0]) << amplitude;
    }
}

TEST(Sleep, ThreadsDoNotChangeTheBits) {
    std::vector<double> x[2], p[2];
    for (const int threads : {1, 4}) {
        PartlyAsleep bed(1, threads);
        bed.sim.run(1.6);
        EXPECT_LT(bed.sim.state().n_awake, 0.8 * double(bed.sim.state().n_particles));
        x[threads == 4] = bed.sim.field(GP_FIELD_X);
        p[threads == 4] = bed.sim.field(GP_FIELD_PRESSURE);
    }
    EXPECT_EQ(x[0], x[1]);
    EXPECT_EQ(p[0], p[1]);
}

// A run that goes on from a file written while a part sleeps has the same bits as one that has never stopped.
TEST(Sleep, GoesOnFromAFile) {
    const TemporaryDirectory directory("sleep");
    const std::string path = directory.path() + "/saved";
    PartlyAsleep bed(1);
    bed.sim.run(1.6);
    EXPECT_LT(bed.sim.state().n_awake, bed.sim.state().n_particles);
    for (int k = 0; k < 3; ++k) {
        ASSERT_EQ(gp_save(bed.sim, path.c_str()), GP_OK) << gp_last_error();
        gp_sim *loaded = nullptr;
        ASSERT_EQ(gp_load(path.c_str(), &loaded), GP_OK) << gp_last_error();
        Sim again(loaded);
        const int64_t steps = 1 + 150 * k;
        bed.sim.step(steps);
        again.step(steps);
        EXPECT_EQ(again.state().n_awake, bed.sim.state().n_awake);
        for (const uint32_t field : {GP_FIELD_X, GP_FIELD_VX, GP_FIELD_PRESSURE, GP_FIELD_SXX, GP_FIELD_DENSITY})
            EXPECT_EQ(again.field(field), bed.sim.field(field)) << field << " " << k;
        for (const int32_t plate : {0, 1}) {
            EXPECT_EQ(again.load(plate).fx, bed.sim.load(plate).fx) << plate;
            EXPECT_EQ(again.load(plate).fy, bed.sim.load(plate).fy) << plate;
            EXPECT_EQ(again.load(plate).torque, bed.sim.load(plate).torque) << plate;
        }
        EXPECT_EQ(again.state().dissipated, bed.sim.state().dissipated);
    }
}

// A hopper that has been filled and sleeps: its outlet opens, and it runs empty as it would.
TEST(Sleep, AHopperRunsOut) {
    constexpr double dl = 0.005;
    double left[2];
    for (const int32_t sleep : {0, 1}) {
        Sim sim(sleeping(dl, sleep));
        sim.column(-8 * dl, 0, 16 * dl, 30 * dl);
        sim.add(plate(-8 * dl, 0, -8 * dl, 1, GP_WALL_COULOMB));
        sim.add(plate(8 * dl, 1, 8 * dl, 0, GP_WALL_COULOMB));
        sim.add(plate(-4 * dl, 0, -8 * dl, 0)); // the bottom on both sides of the outlet
        sim.add(plate(8 * dl, 0, 4 * dl, 0));
        const int32_t slide = sim.add(plate(4 * dl, 0, -4 * dl, 0, GP_WALL_FREE_SLIP));
        sim.run(0.8);
        if (sleep) {
            EXPECT_EQ(sim.state().n_awake, 0);
        }
        ASSERT_EQ(gp_set_plate_motion(sim, slide, 0, -3, 0), GP_OK) << gp_last_error();
        sim.run(1.1);
        left[sleep] = 0;
        for (const double y : sim.field(GP_FIELD_Y))
            left[sleep] += y > 0;
    }
    EXPECT_LT(left[0], 400);
    EXPECT_NEAR(left[1], left[0], 0.05 * 480);
}
