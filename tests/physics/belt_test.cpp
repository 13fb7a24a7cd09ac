// Plates whose surface runs as a belt.
#include <cmath>

#include "../support/lines.hpp"

using namespace test;

namespace {

constexpr double belt_speed = 0.4; // m/s, to the right

// A periodic layer that begins at rest on a floor that moves to the right, as a belt or as a whole.
struct OnABelt {
    static constexpr double spacing = 0.005, width = 0.1, thickness = 0.04;
    Sim sim;
    int32_t floor;
    OnABelt(bool belt, int32_t friction, double gx, double v0 = 0)
        : sim([&] {
              gp_config c = config(spacing);
              c.periodic_x_max = width;
              c.gravity_x = gx;
              return c;
          }()) {
        sim.column(0, 0, width, thickness, 0, v0);
        gp_plate p = plate(width, 0, 0, 0, friction);
        p.wall_mu = friction == GP_WALL_COULOMB ? 0.2 : 0;
        (belt ? p.surface_velocity : p.vx) = belt ? -belt_speed : belt_speed; // its line runs to the left
        floor = sim.add(p);
    }
    double velocity() { return mean(sim.field(GP_FIELD_VX)); }
};

} // namespace

TEST(Belt, IsAFloorThatMoves) {
    for (const int32_t friction : {GP_WALL_NO_SLIP, GP_WALL_COULOMB}) {
        OnABelt belt(true, friction, 0), floor(false, friction, 0);
        for (const double t : {0.05, 0.1, 0.3}) {
            belt.sim.run(t);
            floor.sim.run(t);
            // Only the place of the lattice of ghosts below a layer is another.
            EXPECT_NEAR(belt.velocity(), floor.velocity(), 2e-3 * belt_speed) << friction << ' ' << t;
            const gp_load on_belt = belt.sim.load(belt.floor), on_floor = floor.sim.load(floor.floor);
            EXPECT_NEAR(on_belt.impulse_x, on_floor.impulse_x, 2e-3 * std::abs(on_floor.impulse_x)) << friction;
            EXPECT_EQ(on_belt.dx, 0);
        }
        EXPECT_NEAR(belt.velocity(), belt_speed, 1e-3 * belt_speed) << friction;
    }
}

TEST(Belt, DrivesByItsFrictionAndWorksByItsSpeed) {
    OnABelt belt(true, GP_WALL_COULOMB, 0);
    const double mass = density * OnABelt::width * OnABelt::thickness, pull = 0.2 * mass * gravity;
    const double t = 0.5 * belt_speed / (0.2 * gravity); // half way to its speed
    belt.sim.run(t);
    EXPECT_NEAR(belt.velocity(), 0.5 * belt_speed, 0.01 * belt_speed);
    const gp_load load = belt.sim.load(belt.floor);
    const gp_state state = belt.sim.state();
    EXPECT_NEAR(load.impulse_x, -pull * t, 0.01 * pull * t);
    EXPECT_NEAR(state.plate_work, belt_speed * load.impulse_x, 1e-9 * pull * belt_speed * t);
    // Of the work half is kinetic energy when the layer has half the speed times 3/4 of the way lost to slip.
    EXPECT_NEAR(state.dissipated, -state.plate_work - state.kinetic, 0.01 * -state.plate_work);
}

TEST(Belt, CarriesWhatLiesOnItUphill) {
    // 10 degrees up, below the angle of rest: once it has caught up, it moves with the belt.
    const double tilt = degrees(10), c = std::cos(tilt), s = std::sin(tilt), spacing = 0.005;
    Sim sim(config(spacing));
    std::vector<double> x, y;
    for (int i = 0; i < 30; ++i)
        for (int j = 0; j < 6; ++j) {
            const double along = (i + 0.5) * spacing, above = (j + 0.5) * spacing;
            x.push_back(along * c - above * s);
            y.push_back(along * s + above * c);
        }
    ASSERT_EQ(gp_add_particles(sim, 0, static_cast<int64_t>(x.size()), x.data(), y.data(), nullptr, nullptr, nullptr),
              GP_OK);
    const int32_t id = add_polyline(sim, pieces({c, s}, {-0.2 * c, -0.2 * s}, 7), GP_WALL_NO_SLIP,
                                    [&](gp_plate &p) { p.surface_velocity = -belt_speed; });
    sim.run(0.6);
    const std::vector<double> u = sim.field(GP_FIELD_VX), v = sim.field(GP_FIELD_VY);
    EXPECT_NEAR(mean(u) * c + mean(v) * s, belt_speed, 0.01 * belt_speed);
    EXPECT_EQ(sim.load(id).dx, 0);
    EXPECT_EQ(sim.state().at_rest, 0);
}
