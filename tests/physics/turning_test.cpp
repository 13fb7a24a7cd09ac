// Plates that turn, and what they do to the material.
#include <cmath>

#include "../support/lines.hpp"

using namespace test;

namespace {

// A box full of material that turns with it, in zero gravity.
struct TurningBox {
    static constexpr double spacing = 0.01, omega = 0.5;
    Sim sim;
    int32_t id = -1;
    TurningBox(const Point &pivot, double vx, int32_t friction)
        : sim([] {
              gp_config c = config(spacing);
              c.gravity_y = 0;
              c.sound_speed = 5;
              return c;
          }()) {
        std::vector<double> x, y, u, v;
        for (int j = 0; j < 12; ++j)
            for (int i = 0; i < 16; ++i) {
                x.push_back((i + 0.5) * spacing);
                y.push_back((j + 0.5) * spacing);
                u.push_back(vx - omega * (y.back() - pivot.y));
                v.push_back(omega * (x.back() - pivot.x));
            }
        EXPECT_EQ(
            gp_add_particles(sim, 0, static_cast<int64_t>(x.size()), x.data(), y.data(), u.data(), v.data(), nullptr),
            GP_OK)
            << gp_last_error();
        id = add_polyline(sim, {{0, 0}, {0, 0.12}, {0.16, 0.12}, {0.16, 0}, {0, 0}}, friction, [&](gp_plate &p) {
            p.omega = omega;
            p.pivot_x = pivot.x;
            p.pivot_y = pivot.y;
            p.vx = vx;
        });
    }
};

} // namespace

// A rigid rotation is no shear, at a wall neither: what moves is what a rigid body would.
TEST(Turning, WithTheMaterialShearsNothing) {
    for (const auto &[pivot, friction] : {std::pair(Point{0.08, 0.06}, GP_WALL_NO_SLIP),
                                          {Point{-0.2, 0}, GP_WALL_NO_SLIP},
                                          {Point{-0.2, 0}, GP_WALL_FREE_SLIP},
                                          {Point{-0.2, 0}, GP_WALL_COULOMB}}) {
        SCOPED_TRACE(friction);
        const double vx = 0.1, t = 1;
        TurningBox box(pivot, vx, friction);
        box.sim.run(t);
        const gp_state state = box.sim.state();
        const gp_load load = box.sim.load(box.id);
        EXPECT_NEAR(load.angle, TurningBox::omega * t, 1e-12);
        EXPECT_NEAR(load.dx, vx * t, 1e-12);
        // Where the body's centre of mass is and what it has in kinetic energy.
        const double c = std::cos(load.angle), s = std::sin(load.angle), x0 = 0.08 - pivot.x, y0 = 0.06 - pivot.y;
        const double x = c * x0 - s * y0, y = s * x0 + c * y0, mass = density * 0.12 * 0.16;
        EXPECT_NEAR(state.centre_x, pivot.x + vx * t + x, 0.01 * TurningBox::spacing);
        EXPECT_NEAR(state.centre_y, pivot.y + y, 0.01 * TurningBox::spacing);
        const double u = vx - TurningBox::omega * y, v = TurningBox::omega * x;
        const double inertia = (0.12 * 0.12 + 0.16 * 0.16) / 12 * mass;
        const double kinetic = 0.5 * mass * (u * u + v * v) + 0.5 * inertia * TurningBox::omega * TurningBox::omega;
        EXPECT_NEAR(state.kinetic, kinetic, 0.01 * kinetic);
        // Beginning without the pressure that turns it, it rings: 2e-4 to 9e-4 of its energy. A wall whose ghosts had one
        // velocity would shear it at omega.
        EXPECT_LT(state.dissipated, 2e-3 * kinetic);
        double squares = 0;
        for (const double rate : box.sim.field(GP_FIELD_SHEAR_RATE))
            squares += rate * rate;
        EXPECT_LT(std::sqrt(squares / static_cast<double>(state.n_particles)), 0.02 * TurningBox::omega);
    }
}

// At rest on a wall, its torque is that of the weight about the pivot: the shear force has the lever of the surface.
TEST(Turning, TorqueOfWhatRestsIsThatOfItsWeight) {
    for (const int32_t friction : {GP_WALL_NO_SLIP, GP_WALL_COULOMB}) {
        gp_config c = config(0.005);
        c.gravity_x = gravity * std::sin(degrees(15));
        c.gravity_y = -gravity * std::cos(degrees(15));
        Sim sim(c);
        sim.column(-0.15, 0, 0.3, 0.03);
        gp_plate floor = floor_at(0, -1, 1, friction);
        floor.wall_mu = friction == GP_WALL_COULOMB ? 0.5 : 0;
        const int32_t id = sim.add(floor);
        sim.run(1);
        const double from = sim.load(id).impulse_torque, impulse = sim.load(id).impulse_x;
        const double mass = density * 0.3 * 0.03, x = sim.state().centre_x, y = sim.state().centre_y, interval = 0.5;
        sim.run(1 + interval);
        const double torque = (sim.load(id).impulse_torque - from) / interval;
        const double shear = (sim.load(id).impulse_x - impulse) / interval;
        EXPECT_NEAR(shear, mass * c.gravity_x, 0.01 * shear) << friction;
        // With the lever of the particles .4 dl less, with that of the surface .4 dl more.
        EXPECT_NEAR(torque, mass * (x * c.gravity_y - y * c.gravity_x), 0.15 * 0.005 * shear) << friction;
    }
}

namespace {

// A column between smooth walls whose right one is a flap: its pivot, and how fast it turns.
struct Flap {
    static constexpr double width = 0.1, height = 0.1, spacing = 0.005;
    Sim sim;
    int32_t id;
    explicit Flap(const Point &pivot, double omega = 0) : sim(config(spacing)) {
        sim.column(0, 0, width, height);
        sim.add(floor_at(0, -0.2, 0.4, GP_WALL_FREE_SLIP));
        sim.add(plate(0, -0.02, 0, 0.3, GP_WALL_FREE_SLIP));
        gp_plate flap = plate(width, 0.15, width, 0, GP_WALL_FREE_SLIP);
        flap.pivot_x = pivot.x;
        flap.pivot_y = pivot.y;
        flap.omega = omega;
        id = sim.add(flap);
    }
};

} // namespace

TEST(Turning, TorqueOfAHydrostaticLoadIsAboutThePivot) {
    // p = rho g (H - y): force rho g H^2 / 2 to the right, H / 3 above the base.
    const double force = 0.5 * density * gravity * Flap::height * Flap::height;
    for (const Point &pivot : {Point{Flap::width, 0}, Point{Flap::width, 0.15}, Point{0.3, 0.05}}) {
        Flap flap(pivot);
        flap.sim.run(0.05);
        const gp_load load = flap.sim.load(flap.id);
        // Material between smooth walls keeps the isotropic stress with which it begins; 2.6 % are lost in the corner at the top.
        EXPECT_NEAR(load.fx, force, 0.03 * force);
        EXPECT_NEAR(load.torque_pivot, -(Flap::height / 3 - pivot.y) * force,
                    0.03 * force * (Flap::height / 3 + pivot.y));
        // The same forces about two points; the one about the first point takes them to act on the line, and not, as the work
        // of a turn has it, where the particles are: what little shear there is has a lever of a spacing.
        const double arm_x = Flap::width - pivot.x, arm_y = 0.15 - pivot.y;
        EXPECT_NEAR(load.torque_pivot, load.torque + arm_x * load.fy - arm_y * load.fx, 1e-3 * force * Flap::height);
    }
}

TEST(Turning, ImpulseOfTheTorqueAndTheAngleAddUp) {
    Flap flap({Flap::width, 0}, -2); // it opens
    double impulse = 0, angle = 0, time = 0, work = 0;
    for (int k = 0; k < 200; ++k) {
        flap.sim.step();
        const gp_state state = flap.sim.state();
        const gp_load load = flap.sim.load(flap.id);
        impulse += (state.time - time) * load.torque_pivot;
        angle -= 2 * (state.time - time);
        work += -2 * (state.time - time) * load.torque_pivot;
        time = state.time;
        ASSERT_NEAR(load.impulse_torque, impulse, 1e-9 * std::abs(impulse)) << k;
        ASSERT_NEAR(load.angle, angle, 1e-12) << k;
    }
    EXPECT_GT(work, 0); // the material turns it
    EXPECT_NEAR(flap.sim.state().plate_work, work, 1e-9 * work);
    EXPECT_LT(flap.sim.load(flap.id).torque_pivot, 0);
}

TEST(Turning, AFlapPushesAndHoldsWhatItMeets) {
    // A rough vane sweeps through a heap at 3 rad/s, about a pivot above it that moves along: nothing passes through.
    const double spacing = 0.005;
    Sim sim(config(spacing));
    sim.column(0.02, 0, 0.1, 0.04);
    sim.add(floor_at(0, -0.4, 0.6));
    gp_plate vane = plate(0, 0.01, 0, 0.15); // material on its right
    vane.pivot_y = 0.15;
    vane.omega = 3;
    vane.vx = 0.1;
    const int32_t id = sim.add(vane);
    int touched = 0;
    for (const double t : {0.1, 0.15, 0.2, 0.3}) {
        sim.run(t);
        const gp_load load = sim.load(id);
        EXPECT_NEAR(load.angle, 3 * t, 1e-12);
        // The vane hangs from (dx, .15): from there along it, and in front of it.
        const double tx = std::sin(load.angle), ty = -std::cos(load.angle);
        const std::vector<double> x = sim.field(GP_FIELD_X), y = sim.field(GP_FIELD_Y);
        for (std::size_t i = 0; i < x.size(); ++i) {
            const double rx = x[i] - load.dx, ry = y[i] - 0.15, along = rx * tx + ry * ty, front = tx * ry - ty * rx;
            if (along > 0.14 || std::abs(front) > 2 * spacing)
                continue;
            EXPECT_GT(front, 0) << t << ": " << x[i] << ' ' << y[i];
            ++touched;
        }
    }
    EXPECT_GT(touched, 10);
    EXPECT_LT(sim.state().plate_work, 0);
}
