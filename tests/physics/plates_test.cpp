// Gates, moving plates and friction at plates.
#include <algorithm>

#include "../support/scene.hpp"

using namespace test;

namespace {

// Uniformly accelerated lift through `height` in `duration`, then at rest.
struct Lift {
    Lift(double height, double duration) {
        for (int k = 0; k <= 20; ++k) {
            t.push_back(duration * k / 20);
            x.push_back(0);
            y.push_back(height * k * k / 400);
        }
    }
    void apply(gp_plate &plate) const {
        plate.n_knots = static_cast<int64_t>(t.size());
        plate.knot_t = t.data();
        plate.knot_x = x.data();
        plate.knot_y = y.data();
    }
    std::vector<double> t, x, y;
};

} // namespace

TEST(Gates, HoldTheColumnThenLetItGoAndLeaveThePlan) {
    const double height = 0.05, half = 0.04, dl = 0.0025;
    Sim sim(config(dl));
    sim.column(-half, 0, 2 * half, height);
    sim.add(floor_at(0, -0.4, 0.4));
    const Lift lift(height + 6 * dl, 0.1);
    gp_plate left = plate(-half, 0, -half, 0.1, GP_WALL_FREE_SLIP),
             right = plate(half, 0.1, half, 0, GP_WALL_FREE_SLIP);
    lift.apply(left);
    lift.apply(right);
    const int32_t left_id = sim.add(left), right_id = sim.add(right);
    sim.step(2);
    EXPECT_EQ(sim.entry("move_plates").active, 1);
    EXPECT_EQ(sim.entry("wall_velocity").active, 1);
    EXPECT_LT(sim.load(left_id).fx, 0);
    EXPECT_NEAR(sim.load(left_id).fx, -sim.load(right_id).fx, 0.03 * -sim.load(left_id).fx);
    while (sim.state().time < 0.1) {
        sim.run(sim.state().time + 0.002);
        // Above the gates' lower edge nothing is outside them, and nothing is carried up by them.
        const double edge = sim.load(left_id).dy;
        const std::vector<double> x = sim.field(GP_FIELD_X), y = sim.field(GP_FIELD_Y);
        for (std::size_t i = 0; i < x.size(); ++i)
            if (y[i] > edge + dl) {
                EXPECT_LT(std::abs(x[i]), half) << "y " << y[i] << " edge " << edge;
            }
        EXPECT_LT(*std::max_element(y.begin(), y.end()), height);
    }
    sim.run(0.8);
    EXPECT_EQ(sim.entry("move_plates").active, 0);
    EXPECT_EQ(sim.load(left_id).fx, 0);
    EXPECT_EQ(sim.load(left_id).fy, 0);
    const gp_state state = sim.state();
    EXPECT_EQ(state.at_rest, 1);
    EXPECT_NEAR(state.peak_height / 0.08, 0.415, 0.03);
    EXPECT_NEAR(state.energy_error, 0, 0.01 * Collapse::energy);
}

TEST(Gates, OnePassingAtConstantSpeedLeavesTheSceneForGood) {
    Sim sim(config(0.0025));
    sim.column(0, 0, 0.05, 0.05);
    sim.add(floor_at(0, -0.2, 0.4));
    sim.add(plate(0, 0, 0, 0.1, GP_WALL_FREE_SLIP));
    gp_plate gate = plate(0.05, 0.1, 0.05, 0, GP_WALL_FREE_SLIP);
    gate.vy = 2;
    const int32_t id = sim.add(gate);
    sim.run(0.4);
    EXPECT_NEAR(sim.load(id).dy, 0.8, 1e-12);
    sim.step();
    const gp_state state = sim.state();
    EXPECT_EQ(sim.load(id).fx, 0);
    EXPECT_GT(state.x_right, 0.08);
    // It is far away, so its speed no longer bounds the time step.
    EXPECT_GT(state.dt, 0.9 * 0.8 * 0.0025 / (state.sound_speed * std::sqrt(1.3)));
}

TEST(Plates, HostDrivenPistonDoesItsWork) {
    // A piston pushes a block along a smooth floor: its work is the block's energy and what was dissipated.
    gp_config c = config(0.0025);
    c.sound_speed = 5;
    Sim sim(c);
    sim.column(0, 0, 0.05, 0.025);
    sim.add(floor_at(0, -0.2, 0.5, GP_WALL_FREE_SLIP));
    const int32_t piston = sim.add(plate(0, 0, 0, 0.05, GP_WALL_FREE_SLIP));
    ASSERT_EQ(gp_set_plate_velocity(sim, piston, 0.2, 0), GP_OK);
    sim.run(0.1);
    EXPECT_NEAR(sim.load(piston).dx, 0.02, 1e-12);
    ASSERT_EQ(gp_set_plate_velocity(sim, piston, -0.1, 0), GP_OK);
    sim.run(0.15);
    EXPECT_NEAR(sim.load(piston).dx, 0.015, 1e-12);
    const gp_state state = sim.state();
    EXPECT_LT(state.plate_work, 0); // the material received it
    EXPECT_NEAR(state.energy_error, 0, 0.02 * -state.plate_work);
    for (double x : sim.field(GP_FIELD_X))
        EXPECT_GT(x, 0.015);
    // Material does not stick: a retreating piston feels no more than single grains that slump after it.
    EXPECT_LE(sim.load(piston).fx, 0);
    EXPECT_GT(sim.load(piston).fx, -1e-4 * 1550 * 9.81 * 0.05 * 0.025);
}

TEST(Plates, CoulombFrictionIsCoulombs) {
    // A layer on a plate, gravity tilted by 20 degrees: mu_w = tan 22 holds it, mu_w = tan 15 lets it slide at
    // g (sin 20 - mu_w cos 20), and mu_w = 0 does not act at all.
    struct Outcome {
        double velocity, friction;
    };
    const auto slide = [](double wall_degrees) {
        gp_config c = config(0.0025);
        c.gravity_x = 9.81 * std::sin(degrees(20));
        c.gravity_y = -9.81 * std::cos(degrees(20));
        c.sound_speed = 10;
        Sim sim(c);
        sim.column(0, 0, 0.2, 0.02, sim.material(0.8, 0.9)); // itself stronger than the slope
        gp_plate base = floor_at(0, -0.2, 0.8, GP_WALL_COULOMB);
        base.wall_mu = std::tan(degrees(wall_degrees));
        const int32_t id = sim.add(base);
        const std::vector<double> x0 = sim.field(GP_FIELD_X);
        sim.run(0.2);
        // The layer's middle part: its ends crumble.
        const std::vector<double> vx = sim.field(GP_FIELD_VX);
        double sum = 0;
        int count = 0;
        for (std::size_t i = 0; i < vx.size(); ++i)
            if (x0[i] > 0.08 && x0[i] < 0.12) {
                sum += vx[i];
                ++count;
            }
        return Outcome{sum / count, sim.load(id).impulse_x / -sim.load(id).impulse_y};
    };
    const Outcome held = slide(22), sliding = slide(15), free = slide(0);
    EXPECT_NEAR(held.velocity, 0, 0.005);
    const double expected = 0.2 * 9.81 * (std::sin(degrees(20)) - std::tan(degrees(15)) * std::cos(degrees(20)));
    EXPECT_NEAR(sliding.velocity, expected, 0.05 * expected);
    EXPECT_NEAR(sliding.friction, std::tan(degrees(15)), 0.02 * std::tan(degrees(15))); // the start included
    EXPECT_NEAR(free.friction, 0, 1e-3);
    EXPECT_NEAR(free.velocity, 0.2 * 9.81 * std::sin(degrees(20)), 0.01);
}

TEST(Plates, FastPlateIsNotPassedThrough) {
    gp_config c = config(0.0025);
    Sim sim(c);
    sim.column(0.01, 0, 0.05, 0.025);
    sim.add(floor_at(0, -1, 4));
    gp_plate ram = plate(0, 0, 0, 0.5, GP_WALL_FREE_SLIP);
    ram.vx = 10;
    const int32_t id = sim.add(ram);
    sim.run(0.05);
    const double face = sim.load(id).dx;
    for (double x : sim.field(GP_FIELD_X))
        EXPECT_GT(x, face);
    for (double y : sim.field(GP_FIELD_Y))
        EXPECT_GT(y, 0);
}

TEST(RoughFloor, BrakesASingleLayerByTheLawsFriction) {
    // A front thins out to a single layer. Thrown along the floor at u, it stops between u^2/(2 mu_2 g) and u^2/(2 mu_s g).
    const double speed = 0.5;
    Sim sim(config(0.0025));
    sim.column(0, 0, 0.05, 0.0025, 0, speed);
    sim.add(floor_at(0, -0.2, 0.4));
    const auto centre = [&] {
        double sum = 0;
        const std::vector<double> x = sim.field(GP_FIELD_X);
        for (double value : x)
            sum += value / static_cast<double>(x.size());
        return sum;
    };
    const double start = centre();
    sim.run(0.3);
    const double way = centre() - start, unit = speed * speed / (2 * 9.81);
    EXPECT_GT(way, unit / std::tan(degrees(32)));
    EXPECT_LT(way, unit / std::tan(degrees(21)));
    EXPECT_LT(sim.state().rms_speed, 1e-3 * speed);
}
