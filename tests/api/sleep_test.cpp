// gp_config.sleep: what is refused, what the plan and the state tell, and steps that are taken back.
#include <algorithm>
#include <string>

#include "../support/scene.hpp"

using namespace test;

namespace {

gp_config sleeping(double spacing) {
    gp_config c = config(spacing);
    c.sleep = 1;
    return c;
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
        EXPECT_EQ(awake.entry(stage).active, 0);
        EXPECT_STREQ(awake.entry(stage).reason, "sleep is 0");
    }
    EXPECT_EQ(awake.entry("sleep", 1).bytes, 0);

    Sim sim(sleeping(0.005));
    fill(sim);
    sim.step();
    EXPECT_EQ(sim.entry("gradient").active, 1);
    sim.run(1);
    ASSERT_EQ(sim.state().n_awake, 0);
    for (const char *stage : {"gradient", "stress", "force", "integrate", "collide", "sleep"}) {
        EXPECT_EQ(sim.entry(stage).active, 0) << stage;
        EXPECT_STREQ(sim.entry(stage).reason, "all material sleeps") << stage;
    }
    const int64_t calls = sim.entry("gradient").calls;
    sim.step(100);
    EXPECT_EQ(sim.entry("gradient").calls, calls);
    EXPECT_EQ(sim.entry("wake").active, 1);
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

// A step that diverges elsewhere is taken back: what sleeps is as it was, and so is what is awake.
TEST(SleepChoice, AStepTakenBack) {
    gp_config c = sleeping(0.005);
    c.sound_speed = 10;
    Sim sim(c);
    fill(sim);
    // Between two plates that are to close up; higher, so that its spans are its own.
    sim.column(1, 1, 0.04, 0.04);
    sim.add(floor_at(1, 0.9, 1.2));
    sim.add(plate(1, 1, 1, 1.2, GP_WALL_FREE_SLIP));
    const int32_t right = sim.add(plate(1.04, 1.2, 1.04, 1, GP_WALL_FREE_SLIP));
    sim.run(1);
    ASSERT_EQ(sim.state().n_awake, 0);
    ASSERT_EQ(gp_set_plate_motion(sim, right, -20, 0, 0), GP_OK);
    gp_status status = GP_OK;
    std::vector<double> x, v, p;
    gp_state before{};
    for (int k = 0; k < 1000 && status == GP_OK; ++k) {
        x = sim.field(GP_FIELD_X);
        v = sim.field(GP_FIELD_VX);
        p = sim.field(GP_FIELD_PRESSURE);
        before = sim.state();
        status = gp_step(sim, 1);
    }
    EXPECT_EQ(status, GP_E_DIVERGED);
    EXPECT_GT(before.n_awake, 0);
    EXPECT_LT(before.n_awake, before.n_particles);
    EXPECT_EQ(sim.field(GP_FIELD_X), x);
    EXPECT_EQ(sim.field(GP_FIELD_VX), v);
    EXPECT_EQ(sim.field(GP_FIELD_PRESSURE), p);
    EXPECT_EQ(sim.state().dissipated, before.dissipated);
}
