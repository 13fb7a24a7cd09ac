// gp_get_clock.
#include "api_support.hpp"

using namespace api;

TEST(Clock, IsThatOfTheState) {
    Sim sim;
    double time = 7, dt = 7;
    int64_t step = 7;
    ASSERT_EQ(gp_get_clock(sim, &time, &dt, &step), GP_OK);
    EXPECT_EQ(time, 0);
    EXPECT_EQ(dt, 0);
    EXPECT_EQ(step, 0);
    add_collapse(sim);
    for (int k = 0; k < 3; ++k) {
        ASSERT_EQ(gp_step(sim, 10), GP_OK);
        ASSERT_EQ(gp_get_clock(sim, &time, &dt, &step), GP_OK);
        const gp_state s = sim.state();
        EXPECT_EQ(time, s.time);
        EXPECT_EQ(dt, s.dt);
        EXPECT_EQ(step, s.step);
        EXPECT_GT(dt, 0);
    }
}

TEST(Clock, GivesWhatIsAskedFor) {
    Sim sim;
    add_collapse(sim);
    ASSERT_EQ(gp_step(sim, 5), GP_OK);
    double time = 0, dt = 0;
    int64_t step = 0;
    EXPECT_EQ(gp_get_clock(sim, nullptr, nullptr, nullptr), GP_OK);
    EXPECT_EQ(gp_get_clock(sim, &time, nullptr, nullptr), GP_OK);
    EXPECT_EQ(gp_get_clock(sim, nullptr, &dt, nullptr), GP_OK);
    EXPECT_EQ(gp_get_clock(sim, nullptr, nullptr, &step), GP_OK);
    EXPECT_EQ(time, sim.state().time);
    EXPECT_EQ(dt, sim.state().dt);
    EXPECT_EQ(step, 5);
}

TEST(Clock, ChangesNothingAndPreparesNothing) {
    Sim sim;
    add_collapse(sim);
    const uint64_t epoch = sim.epoch();
    double time;
    ASSERT_EQ(gp_get_clock(sim, &time, nullptr, nullptr), GP_OK);
    EXPECT_EQ(sim.epoch(), epoch);
    sim.add(make_column(3, 3, 5, 0)); // the scene is open as before
    ASSERT_EQ(gp_step(sim, 1), GP_OK);
}

TEST(Clock, WantsASimulation) {
    double time = 7;
    EXPECT_FAILS(gp_get_clock(nullptr, &time, nullptr, nullptr), GP_E_ARGUMENT, "sim");
    EXPECT_EQ(time, 7);
}

namespace {

int32_t read_clock(void *user, gp_sim *sim) {
    double time = 0, dt = 0;
    int64_t step = 0;
    EXPECT_EQ(gp_get_clock(sim, &time, &dt, &step), GP_OK);
    EXPECT_EQ(step, ++*static_cast<int64_t *>(user));
    EXPECT_GT(time, 0);
    return 0;
}

} // namespace

TEST(Clock, IsReadInTheCallback) {
    Sim sim;
    add_collapse(sim);
    int64_t calls = 0;
    ASSERT_EQ(gp_set_callback(sim, 1, read_clock, &calls), GP_OK);
    ASSERT_EQ(gp_step(sim, 5), GP_OK);
    EXPECT_EQ(calls, 5);
}
