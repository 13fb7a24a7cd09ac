// gp_config.sleep: what is refused, what the plan and the state tell, and steps that are taken back.
#include <algorithm>
#include <cstring>
#include <string>

#include "../support/scene.hpp"

using namespace test;

namespace {

gp_config sleeping(double spacing) {
    gp_config c = config(spacing);
    c.sleep = 1;
    return c;
}

gp_plan_entry entry(gp_sim *sim, const char *name, int32_t kind = 0) {
    int64_t n = 0;
    EXPECT_EQ(gp_get_plan(sim, 0, nullptr, &n), GP_OK);
    std::vector<gp_plan_entry> plan(static_cast<std::size_t>(n));
    EXPECT_EQ(gp_get_plan(sim, n, plan.data(), &n), GP_OK);
    for (const gp_plan_entry &found : plan)
        if (found.kind == kind && !std::strcmp(found.name, name))
            return found;
    ADD_FAILURE() << "no entry " << name;
    return {};
}

void fill(Sim &sim) {
    sim.column(0, 0, 0.08, 0.04);
    sim.add(floor_at(0, 0, 0.08));
    sim.add(plate(0, 0, 0, 1, GP_WALL_FREE_SLIP));
    sim.add(plate(0.08, 1, 0.08, 0, GP_WALL_FREE_SLIP));
}

} // namespace

TEST(SleepChoice, IsOffAndChecked) {
    gp_config c = config(0.005);
    EXPECT_EQ(c.sleep, 0);
    gp_sim *sim = nullptr;
    for (const int32_t wrong : {-1, 2}) {
        c.sleep = wrong;
        EXPECT_EQ(gp_create(&c, &sim), GP_E_ARGUMENT);
        EXPECT_NE(std::string(gp_last_error()).find("gp_config.sleep"), std::string::npos) << gp_last_error();
    }
    c.sleep = 1;
    c.stress = GP_STRESS_IMPLICIT;
    EXPECT_EQ(gp_create(&c, &sim), GP_E_UNSUPPORTED);
    EXPECT_NE(std::string(gp_last_error()).find("gp_config.sleep"), std::string::npos) << gp_last_error();
    for (const int32_t preset : {GP_PRESET_PAPER, GP_PRESET_PAPER_LOCAL}) {
        ASSERT_EQ(gp_config_init(&c, sizeof c, preset), GP_OK);
        c.sleep = 1;
        EXPECT_EQ(gp_create(&c, &sim), GP_E_UNSUPPORTED);
    }
}

TEST(SleepChoice, ThePlanTellsWhatIsLeftOut) {
    Sim awake(config(0.005));
    fill(awake);
    awake.step();
    for (const char *stage : {"wake", "sleep"}) {
        EXPECT_EQ(entry(awake, stage).active, 0);
        EXPECT_STREQ(entry(awake, stage).reason, "sleep is 0");
    }
    EXPECT_EQ(entry(awake, "sleep", 1).bytes, 0);

    Sim sim(sleeping(0.005));
    fill(sim);
    sim.step();
    EXPECT_EQ(entry(sim, "gradient").active, 1);
    sim.run(1);
    ASSERT_EQ(sim.state().n_awake, 0);
    for (const char *stage : {"gradient", "stress", "force", "integrate", "collide", "sleep"}) {
        EXPECT_EQ(entry(sim, stage).active, 0) << stage;
        EXPECT_STREQ(entry(sim, stage).reason, "all material sleeps") << stage;
    }
    const int64_t calls = entry(sim, "gradient").calls;
    sim.step(100);
    EXPECT_EQ(entry(sim, "gradient").calls, calls);
    EXPECT_EQ(entry(sim, "wake").active, 1);
    for (const double value : sim.field(GP_FIELD_SHEAR_RATE))
        EXPECT_EQ(value, 0);
    // The impulse on the floor goes on to grow by the weight.
    const gp_load before = sim.load(0);
    const double begin = sim.state().time;
    sim.run(begin + 0.5);
    EXPECT_NEAR(sim.load(0).impulse_y - before.impulse_y, 0.5 * before.fy, 1e-9 * std::abs(before.fy));
}

TEST(SleepChoice, NothingToSleep) {
    Sim sim(sleeping(0.005));
    sim.add(floor_at(0, 0, 1));
    sim.step(3);
    EXPECT_EQ(sim.state().n_awake, 0);
    Sim lone(sleeping(0.005)); // falls for ever
    lone.column(0, 0, 0.005, 0.005);
    lone.run(0.5);
    EXPECT_EQ(lone.state().n_awake, 1);
}

// A plate of the host that strikes what sleeps so hard that the step diverges: the step is taken back, and what slept is as it was.
TEST(SleepChoice, AStepTakenBack) {
    Sim sim(sleeping(0.005));
    fill(sim);
    sim.run(1);
    ASSERT_EQ(sim.state().n_awake, 0);
    const std::vector<double> x = sim.field(GP_FIELD_X), p = sim.field(GP_FIELD_PRESSURE);
    ASSERT_EQ(gp_set_plate_motion(sim, 0, 0, 200, 0), GP_OK);
    gp_status status = GP_OK;
    for (int k = 0; k < 100 && status == GP_OK; ++k) {
        status = gp_step(sim, 1);
        if (status == GP_OK)
            FAIL() << "expected the first step to diverge";
    }
    EXPECT_EQ(status, GP_E_DIVERGED);
    EXPECT_EQ(sim.field(GP_FIELD_X), x);
    EXPECT_EQ(sim.field(GP_FIELD_PRESSURE), p);
}
