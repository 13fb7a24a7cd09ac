// What sets the time step, and what is refused as too long or too short.
#include "log_support.hpp"

using namespace api;

namespace {

// s, in which an elastic wave crosses a spacing
double crossing(const gp_state &state) {
    return spacing / (state.sound_speed * std::sqrt(1.3));
}

} // namespace

TEST(TimeStep, SaysWhatSetIt) {
    {
        Sim sim;
        sim.add(make_floor());
        sim.add(make_column(10, 10));
        EXPECT_EQ(sim.state().dt_reason, GP_DT_NONE);
        ASSERT_EQ(gp_step(sim, 1), GP_OK);
        const gp_state s = sim.state();
        EXPECT_EQ(s.dt_reason, GP_DT_SOUND);
        EXPECT_NEAR(s.dt, 0.950 * crossing(s), 1e-3 * s.dt); // von Neumann's analysis, bench/stability/theory.py
        EXPECT_NEAR(s.dt_limit, 1.928 * crossing(s), 1e-3 * s.dt_limit);
        ASSERT_EQ(gp_run(sim, s.time + 0.4 * s.dt), GP_OK);
        EXPECT_EQ(sim.state().dt_reason, GP_DT_END);
    }
    {
        gp_config config = make_config();
        config.time_step = 1e-4;
        Sim sim(config);
        add_collapse(sim);
        ASSERT_EQ(gp_step(sim, 1), GP_OK);
        EXPECT_EQ(sim.state().dt_reason, GP_DT_DEMANDED);
    }
    {
        gp_config config = make_config();
        config.sound_speed = 1;
        config.gravity_y = 0;
        Sim sim(config);
        const double x[2] = {0, 5 * spacing}, y[2] = {0, 0}, vx[2] = {-1, 1}, vy[2] = {0, 0};
        ASSERT_EQ(gp_add_particles(sim, 0, 2, x, y, vx, vy, nullptr), GP_OK);
        ASSERT_EQ(gp_step(sim, 1), GP_OK) << gp_last_error();
        EXPECT_EQ(sim.state().dt_reason, GP_DT_FLOW);
        EXPECT_DOUBLE_EQ(sim.state().dt, 0.25 * spacing / 2);
    }
    {
        Sim sim;
        sim.add(make_floor());
        sim.add(make_column(10, 10));
        gp_plate lid = make_plate(0, 10 * spacing, 10 * spacing, 10 * spacing);
        lid.normal_pressure = 100;
        lid.mass_per_length = 0.01;
        sim.add(lid);
        ASSERT_EQ(gp_step(sim, 1), GP_OK) << gp_last_error();
        const gp_state s = sim.state();
        EXPECT_EQ(s.dt_reason, GP_DT_PLATE);
        EXPECT_EQ(s.dt, s.dt_limit);
    }
}

// A scene that its own sound step makes explode: the collapse with a horizon of 2.2 dl and all of one coefficient.
TEST(TimeStep, CoefficientsThatDampShortenIt) {
    struct Choice {
        const char *name;
        double gp_config::*member;
        double largest, unstable; // the latter in the sound limit, measured (src/scene_constants.cpp)
    };
    for (const Choice &choice : {Choice{"bulk_viscosity", &gp_config::bulk_viscosity, 1, 1.3},
                                 Choice{"density_diffusion", &gp_config::density_diffusion, 1, 1.0}}) {
        SCOPED_TRACE(choice.name);
        const auto build = [](Sim &sim) {
            sim.add(make_floor());
            sim.add(make_column(16, 10, -8 * spacing));
        };
        gp_config config = make_config();
        config.horizon = 2.2;
        double sound_limit;
        {
            Sim sim(config);
            build(sim);
            sound_limit = crossing(sim.state());
            ASSERT_EQ(gp_step(sim, 1), GP_OK);
            EXPECT_EQ(sim.state().dt_reason, GP_DT_SOUND) << "the default coefficients leave the step to sound";
        }
        config.*choice.member = choice.largest;
        Sim sim(config);
        build(sim);
        const double energy = sim.state().potential;
        ASSERT_EQ(gp_step(sim, 1), GP_OK);
        EXPECT_EQ(sim.state().dt_reason, GP_DT_VISCOSITY);
        EXPECT_EQ(sim.state().dt, sim.state().dt_limit);
        EXPECT_LT(sim.state().dt, 0.8 * sound_limit);
        ASSERT_EQ(gp_run(sim, 0.4), GP_OK) << gp_last_error();
        EXPECT_LT(std::abs(sim.state().energy_error), 0.02 * energy);

        config.time_step = choice.unstable * sound_limit;
        Sim refused(config);
        build(refused);
        EXPECT_FAILS(gp_step(refused, 1), GP_E_ARGUMENT, "time_step");
        config.allow_unstable_step = 1;
        Sim unstable(config);
        build(unstable);
        const gp_status status = gp_run(unstable, 0.4);
        EXPECT_TRUE(status == GP_E_DIVERGED || std::abs(unstable.state().energy_error) > 0.05 * energy)
            << "there would be no need for the limit";
    }
}

TEST(TimeStep, BeyondTheLimitIsRefusedOrTakenWithOneWarning) {
    struct Choice {
        const char *name;
        double gp_config::*member;
    };
    double limit, limit_of_cfl;
    {
        Sim sim;
        add_collapse(sim);
        limit = sim.state().dt_limit;
        limit_of_cfl = limit / crossing(sim.state());
    }
    for (const Choice &choice : {Choice{"time_step", &gp_config::time_step}, Choice{"cfl", &gp_config::cfl}}) {
        SCOPED_TRACE(choice.name);
        gp_config config = make_config();
        config.*choice.member = 1.5 * (std::string(choice.name) == "cfl" ? limit_of_cfl : limit);
        Sim refused(config);
        add_collapse(refused);
        EXPECT_FAILS(gp_step(refused, 1), GP_E_ARGUMENT, choice.name);
        EXPECT_TRUE(last_error_has("allow_unstable_step")) << gp_last_error();

        config.allow_unstable_step = 1;
        Sim taken(config);
        Log log;
        ASSERT_EQ(gp_set_log(taken, Log::run, &log), GP_OK);
        add_collapse(taken);
        ASSERT_EQ(gp_step(taken, 1), GP_OK) << gp_last_error();
        ASSERT_EQ(gp_step(taken, 1), GP_OK) << gp_last_error();
        EXPECT_DOUBLE_EQ(taken.state().dt, 1.5 * limit);
        EXPECT_DOUBLE_EQ(taken.state().dt_limit, limit);
        EXPECT_EQ(log.count({choice.name}), 1);
        EXPECT_EQ(log.count({"stable limit"}), 1);

        config.*choice.member = 0.5 * (std::string(choice.name) == "cfl" ? limit_of_cfl : limit);
        Sim stable(config);
        Log silent;
        ASSERT_EQ(gp_set_log(stable, Log::run, &silent), GP_OK);
        add_collapse(stable);
        ASSERT_EQ(gp_step(stable, 1), GP_OK) << gp_last_error();
        EXPECT_TRUE(silent.warnings.empty()) << silent.warnings[0];
    }
}

// Speeds that a sound speed from the scene is made for run at the sound step; a given one that they leave behind by far is
// refused rather than followed in steps next to nothing.
TEST(TimeStep, IsBoundedBelow) {
    const auto shoot = [](Sim &sim, double speed) {
        gp_column column = make_column(6, 6, 0, 10 * spacing);
        column.vy = -speed;
        sim.add(make_floor());
        sim.add(column);
    };
    {
        Sim sim;
        shoot(sim, 100);
        ASSERT_EQ(gp_run(sim, 3 * 10 * spacing / 100), GP_OK) << gp_last_error();
        EXPECT_GT(sim.state().dissipated, 0);
    }
    gp_config config = make_config();
    config.sound_speed = 20;
    {
        Sim sim(config); // five times as fast as sound: wrong, but it can be followed
        shoot(sim, 100);
        gp_step(sim, 1);
        EXPECT_EQ(sim.state().dt_reason, GP_DT_FLOW);
    }
    {
        Sim sim(config);
        shoot(sim, 1000);
        EXPECT_FAILS(gp_step(sim, 1), GP_E_ARGUMENT, "sound_speed");
        EXPECT_EQ(sim.state().step, 0);
        EXPECT_TRUE(last_error_has("particle")) << gp_last_error();
    }
    Sim sim(config);
    shoot(sim, 1);
    ASSERT_EQ(gp_step(sim, 2), GP_OK);
    ASSERT_EQ(gp_set_plate_velocity(sim, 0, 0, 1000), GP_OK);
    EXPECT_EQ(gp_run(sim, 1), GP_E_DIVERGED);
    EXPECT_TRUE(last_error_has("plate 0 moves at (0, 1000)")) << gp_last_error();
    EXPECT_LT(sim.load(0).dy, 11 * spacing) << "it has not jumped over the column";
    EXPECT_EQ(gp_step(sim, 1), GP_E_STATE);
}
