// Boxes that are tilted by gp_set_gravity, by one degree per second.
#include <algorithm>

#include "../support/layer.hpp"

using namespace test;

namespace {

struct Tilt {
    double from; // degrees at the time 0
    static int32_t run(void *user, gp_sim *sim) {
        double time = 0;
        EXPECT_EQ(gp_get_clock(sim, &time, nullptr, nullptr), GP_OK);
        tilt(sim, static_cast<Tilt *>(user)->from + time);
        return 0;
    }
};

} // namespace

// A layer without ends on a rough floor, mu_s = tan 21 degrees, from the level on. Until 21 degrees it creeps by .035 dl in all,
// .003 dl of it in the last degree, as the floor takes over the shear; at 21.5 it has moved by .2, at 22 by 4.6 dl. The ledger
// closes to a thousandth of what is dissipated.
TEST(TiltedLayer, FlowsFromItsAngleOfFrictionOn) {
    InclinedLayer layer(0);
    Sim &sim = layer.sim;
    const double dl = layer.spacing, period = layer.period;
    Tilt steadily{0};
    ASSERT_EQ(gp_set_callback(sim, 1, Tilt::run, &steadily), GP_OK);
    const std::vector<double> begin = sim.field(GP_FIELD_X);
    const auto moved = [&] {
        const std::vector<double> x = sim.field(GP_FIELD_X);
        double most = 0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            const double way = x[i] - begin[i];
            most = std::max(most, std::abs(way - period * std::round(way / period)));
        }
        return most;
    };
    sim.run(19.5);
    const double until = moved();
    sim.run(20.5);
    EXPECT_LT(moved(), 0.1 * dl);
    EXPECT_LT(moved() - until, 0.01 * dl);
    EXPECT_LT(sim.state().max_speed, 1e-4);
    sim.run(22);
    EXPECT_GT(moved(), dl);
    EXPECT_GT(sim.state().max_speed, 0.02);
    const gp_state s = sim.state();
    EXPECT_LT(std::abs(s.energy_error), 2e-3 * s.dissipated);
    EXPECT_LT(s.potential, 0.9 * layer.weight * layer.thickness / 2); // it has slid down
}

// In a closed box the lower wall holds what would slip: a sheet of the depth d and the length L flows from
// tan a = mu_s + (Kp - Ka) d / 2L on, Kp - Ka = 1.8: two rows of 60 spacings from 22.4 degrees. From then on the surface stays at
// the angle of friction to gravity, between 21.4 and 22.5 degrees in boxes of 40, 60 and 80 spacings.
TEST(TiltedBox, HoldsItsSurfaceAtTheAngleOfFriction) {
    const double dl = 0.005, length = 60 * dl, height = 6 * dl;
    Tilt steadily{19};
    Sim sim(config(dl));
    tilt(sim, steadily.from);
    sim.column(0, 0, length, height);
    sim.add(floor_at(0, 0, length));
    sim.add(plate(0, 0, 0, 5 * height));
    sim.add(plate(length, 5 * height, length, 0));
    ASSERT_EQ(gp_set_callback(sim, 1, Tilt::run, &steadily), GP_OK);
    const auto run_to = [&](double angle) {
        sim.run(angle - steadily.from);
        return sim.state();
    };
    const gp_state before = run_to(20), held = run_to(20.5), flows = run_to(24.5), end = run_to(26);
    EXPECT_LT(std::abs(held.x_q50 - before.x_q50), 0.01 * dl);
    EXPECT_LT(held.max_speed, 1e-3);
    EXPECT_GT(flows.x_q50 - held.x_q50, 0.5 * dl);
    const double stations[] = {0.15 * length, 0.85 * length};
    double heights[2];
    ASSERT_EQ(gp_get_surface(sim, 2, stations, heights), GP_OK);
    const double slope = std::atan((heights[1] - heights[0]) / (0.7 * length)) * 180 / pi;
    EXPECT_NEAR(26 - slope, 22, 1);
    EXPECT_LT(std::abs(end.energy_error), 2e-3 * end.dissipated);
}
