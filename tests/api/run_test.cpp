// Steps, runs to a time, and the schemes that can be told exactly: nothing, and one falling particle.
#include <random>

#include "api_support.hpp"

using namespace api;

TEST(Step, TakesThatManySteps) {
    Sim sim;
    add_collapse(sim, 4, 4);
    EXPECT_EQ(gp_step(sim, 0), GP_OK);
    EXPECT_EQ(sim.state().step, 0);
    EXPECT_EQ(sim.state().dt, 0);
    EXPECT_EQ(gp_step(sim, 1), GP_OK);
    EXPECT_EQ(gp_step(sim, 4), GP_OK);
    EXPECT_EQ(sim.state().step, 5);
    EXPECT_GT(sim.state().dt, 0);
    EXPECT_GT(sim.state().time, 0);
    for (const int64_t n : {int64_t(-1), INT64_MIN})
        EXPECT_FAILS(gp_step(sim, n), GP_E_ARGUMENT, "n = ");
    EXPECT_EQ(sim.state().step, 5);
}

// No step has been taken: the scene is still open.
TEST(Step, ZeroStepsDoNotStart) {
    Sim sim;
    sim.add(make_column(2, 2));
    const uint64_t epoch = sim.epoch();
    EXPECT_EQ(gp_step(sim, 0), GP_OK);
    EXPECT_EQ(gp_run(sim, 0), GP_OK);
    EXPECT_EQ(sim.epoch(), epoch);
    sim.add(make_floor());
}

TEST(Run, LandsOnTheEndExactly) {
    for (const double time_step : {0.0, 1.7e-4}) {
        gp_config config = make_config();
        config.time_step = time_step;
        Sim sim(config);
        add_collapse(sim, 4, 4);
        double end = 0;
        for (const double more : {0.01, 1e-3, 0.0123456789, 1e-7, 0.02, 1.0 / 300}) {
            end += more;
            ASSERT_EQ(gp_run(sim, end), GP_OK) << gp_last_error();
            EXPECT_EQ(sim.state().time, end);
        }
    }
}

TEST(Run, ShortensTheLastStepsOnly) {
    gp_config config = make_config();
    config.time_step = 1e-4;
    Sim sim(config);
    sim.add(make_column(2, 2));
    std::vector<double> dt;
    const auto record = [](void *user, gp_sim *s) {
        gp_state state{};
        state.struct_size = sizeof state;
        gp_get_state(s, &state);
        static_cast<std::vector<double> *>(user)->push_back(state.dt);
        return int32_t(0);
    };
    ASSERT_EQ(gp_set_callback(sim, 1, record, &dt), GP_OK);
    ASSERT_EQ(gp_run(sim, 10.3e-4), GP_OK);
    ASSERT_GE(dt.size(), 10u);
    for (const double step : dt) {
        EXPECT_GT(step, 0);
        EXPECT_LE(step, 1e-4 * (1 + 1e-12));
    }
    for (std::size_t k = 0; k < 8; ++k)
        EXPECT_EQ(dt[k], 1e-4);
}

TEST(Run, EndInThePastIsRefusedAndNowDoesNothing) {
    Sim sim;
    add_collapse(sim, 4, 4);
    EXPECT_FAILS(gp_run(sim, -1e-300), GP_E_ARGUMENT, "t_end");
    ASSERT_EQ(gp_run(sim, 0.01), GP_OK);
    const int64_t step = sim.state().step;
    const uint64_t epoch = sim.epoch();
    EXPECT_EQ(gp_run(sim, 0.01), GP_OK);
    for (const double end : {std::nextafter(0.01, 0.0), 0.0, -1.0, not_a_number, infinite, -infinite})
        EXPECT_FAILS(gp_run(sim, end), GP_E_ARGUMENT, "t_end");
    EXPECT_EQ(sim.state().step, step);
    EXPECT_EQ(sim.epoch(), epoch);
    EXPECT_EQ(gp_run(sim, std::nextafter(0.01, 1.0)), GP_OK);
    EXPECT_EQ(sim.state().time, std::nextafter(0.01, 1.0));
}

// The clock's last correction must not hide behind a state that a callback has read before.
TEST(Run, LandsOnTheEndAlsoForCallbacksThatRead) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> part(0, 1);
    struct Seen {
        double time;
        int64_t step;
    } seen{};
    const auto read = [](void *user, gp_sim *s) {
        gp_state state{};
        state.struct_size = sizeof state;
        gp_get_state(s, &state);
        *static_cast<Seen *>(user) = {state.time, state.step};
        return int32_t(0);
    };
    int stale = 0, early = 0;
    for (int k = 0; k < 300; ++k) {
        Sim sim; // its time step is about 0.004 s
        ASSERT_EQ(gp_set_callback(sim, 1, read, &seen), GP_OK);
        const double first = 1e-3 * part(random), end = first + 2e-3 * part(random);
        ASSERT_EQ(gp_run(sim, first), GP_OK);
        ASSERT_EQ(gp_run(sim, end), GP_OK);
        ASSERT_EQ(sim.state().step, seen.step);
        stale += sim.state().time != end;
        early += seen.time != end;
    }
    EXPECT_EQ(stale, 0) << "gp_get_state shows another time than t_end after gp_run";
    EXPECT_EQ(early, 0) << "the last step's callback sees another time than t_end";
}

TEST(Run, SplittingARunInStepsIsTheSameRun) {
    std::vector<uint64_t> bits[2];
    for (int k = 0; k < 2; ++k) {
        Sim sim;
        add_collapse(sim, 6, 6);
        for (int part = 0; part < (k == 0 ? 1 : 10); ++part)
            ASSERT_EQ(gp_step(sim, k == 0 ? 30 : 3), GP_OK);
        bits[k] = snapshot(sim, 3);
    }
    EXPECT_EQ(bits[0], bits[1]);
}

// ---------------------------------------------------------------------------------------------- empty scenes

TEST(EmptyScene, OnlyCountsTime) {
    Sim sim;
    ASSERT_EQ(gp_step(sim, 3), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_run(sim, 1), GP_OK) << gp_last_error();
    const gp_state s = sim.state();
    EXPECT_EQ(s.time, 1);
    EXPECT_GT(s.step, 3);
    EXPECT_EQ(s.n_particles, 0);
    EXPECT_EQ(s.n_awake, 0);
    for (const double value : {s.kinetic, s.potential, s.elastic, s.dissipated, s.plate_work, s.energy_error,
                               s.momentum_x, s.momentum_y, s.max_speed, s.rms_speed, s.max_pressure})
        EXPECT_EQ(value, 0);
    EXPECT_EQ(sim.count(), 0);
    EXPECT_EQ(gp_copy_field(sim, GP_FIELD_X, nullptr, 0), GP_OK);
    double x = 0, height = 7;
    EXPECT_EQ(gp_get_surface(sim, 1, &x, &height), GP_OK);
    EXPECT_EQ(height, 0);
    EXPECT_EQ(gp_get_interface(sim, 0, 1, 1, &x, &height), GP_E_ARGUMENT);
}

TEST(EmptyScene, WithPlatesMovesThem) {
    Sim sim;
    gp_plate plate = make_floor();
    plate.vy = 2;
    sim.add(plate);
    ASSERT_EQ(gp_run(sim, 0.25), GP_OK) << gp_last_error();
    EXPECT_NEAR(sim.load(0).dy, 0.5, 1e-12);
    for (const double value : {sim.load(0).fx, sim.load(0).fy, sim.load(0).torque, sim.load(0).impulse_y})
        EXPECT_EQ(value, 0);
}

TEST(EmptyScene, WithoutGravityEither) {
    gp_config config = make_config();
    config.gravity_y = 0;
    Sim sim(config);
    sim.add({0.0}, {0.0});
    ASSERT_EQ(gp_run(sim, 0.1), GP_OK) << gp_last_error();
    EXPECT_EQ(sim.field(GP_FIELD_X), std::vector<double>{0});
    EXPECT_EQ(sim.field(GP_FIELD_VY), std::vector<double>{0});
}

// v += g dt, then x += v dt: the symplectic Euler scheme.
TEST(OneParticle, FallsAsTheSchemeSays) {
    gp_config config = make_config();
    config.gravity_x = 0.7;
    Sim sim(config);
    const double x0 = 0.3, y0 = 1.5, vx0 = -0.4, vy0 = 0.2;
    ASSERT_EQ(gp_add_particles(sim, 0, 1, &x0, &y0, &vx0, &vy0, nullptr), GP_OK);
    double x = x0, y = y0, vx = vx0, vy = vy0, time = 0;
    for (int k = 0; k < 100; ++k) {
        ASSERT_EQ(gp_step(sim, 1), GP_OK) << gp_last_error();
        const gp_state s = sim.state();
        vx += s.dt * config.gravity_x;
        vy += s.dt * config.gravity_y;
        x += s.dt * vx;
        y += s.dt * vy;
        time += s.dt;
        const double shown[5] = {sim.field(GP_FIELD_X)[0], sim.field(GP_FIELD_Y)[0], sim.field(GP_FIELD_VX)[0],
                                 sim.field(GP_FIELD_VY)[0], s.time};
        ASSERT_DOUBLE_EQ(shown[0], x);
        ASSERT_DOUBLE_EQ(shown[1], y);
        ASSERT_DOUBLE_EQ(shown[2], vx);
        ASSERT_DOUBLE_EQ(shown[3], vy);
        ASSERT_DOUBLE_EQ(shown[4], time);
        // From the shown numbers on, so that roundings do not add up where the compiler contracts operations.
        x = shown[0];
        y = shown[1];
        vx = shown[2];
        vy = shown[3];
        time = shown[4];
    }
    EXPECT_EQ(sim.field(GP_FIELD_PRESSURE)[0], 0);
    EXPECT_EQ(sim.field(GP_FIELD_SHEAR_RATE)[0], 0);
    EXPECT_EQ(sim.field(GP_FIELD_NUMBER_DENSITY)[0], 0);
    EXPECT_EQ(sim.state().collisions, 0);
}
