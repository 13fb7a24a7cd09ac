// gp_state.volume_drift against the height of layers on an incline, which all flows.
#include "../support/scene.hpp"

using namespace test;

namespace {

constexpr int rows = 10, across = 24;
constexpr double dl = 0.004;

gp_config of_incline(double jitter, double horizon = 4) {
    gp_config c = config(dl);
    c.gravity_x = 9.81 * std::sin(degrees(26));
    c.gravity_y = -9.81 * std::cos(degrees(26));
    c.periodic_x_max = across * dl;
    c.jitter = jitter;
    c.horizon = horizon;
    return c;
}

struct Incline {
    explicit Incline(const gp_config &c) : sim(c) {
        sim.column(0, 0, across * dl, rows * dl);
        sim.add(plate(across * dl, 0, 0, 0));
    }
    Sim sim;
};

} // namespace

TEST(VolumeDrift, IsNothingAtTheStartAndAtRest) {
    Collapse collapse(16);
    EXPECT_EQ(collapse.sim.state().volume_drift, 0);
    collapse.sim.run(1);
    EXPECT_EQ(collapse.sim.state().at_rest, 1);
    EXPECT_EQ(collapse.sim.state().volume_drift, 0);
}

// Shear alone, and the disorder that it makes, are no loss; nor are the free surface and the floor.
TEST(VolumeDrift, IsSmallWhereTheHeightIsKept) {
    for (const double jitter : {0.0, 0.2})
        for (const double horizon : {3.0, 4.0}) {
            Incline layer(of_incline(jitter, horizon));
            const double height = layer.sim.state().centre_y;
            layer.sim.run(0.5);
            const gp_state s = layer.sim.state();
            EXPECT_NEAR(s.volume_drift, height / s.centre_y - 1, 0.005) << jitter << " " << horizon;
            EXPECT_NEAR(s.volume_drift, 0, 0.01) << jitter << " " << horizon;
        }
}

// Without what ties the density to the spacing of the particles the layer sinks, and its density is that of the start.
TEST(VolumeDrift, IsWhatASinkingLayerLoses) {
    gp_config c = of_incline(0.2);
    c.density_diffusion = 0;
    Incline layer(c);
    const double height = layer.sim.state().centre_y;
    layer.sim.run(2.5);
    const gp_state s = layer.sim.state();
    const double lost = height / s.centre_y - 1;
    EXPECT_GT(lost, 0.05);
    EXPECT_NEAR(s.volume_drift, lost, 0.2 * lost);
    double mean = 0;
    for (const double density : layer.sim.field(GP_FIELD_DENSITY))
        mean += density / (rows * across * 1550.0);
    EXPECT_LT(mean, 1.005) << "it does not know";
}
