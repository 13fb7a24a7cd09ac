// Plates that turn, belts, and what bodies in motion do to the material.
#include "../support/directory.hpp"
#include "../support/lines.hpp"

using namespace test;

namespace {

// A drum of radius R about the origin, 30 % full.
struct Drum {
    static constexpr double radius = 0.1;
    Sim sim;
    std::vector<Point> points;
    int32_t id;
    double omega; // counter-clockwise: the surface rises to the right
    Drum(
        int count, double across, double froude, const gp_config &c,
        const std::function<void(gp_plate &)> &change = [](gp_plate &) {})
        : sim(c), points(arc(0, 0, radius, 0, -360, count)), omega(std::sqrt(froude * gravity / radius)) {
        const double spacing = radius / across, level = -0.34 * radius; // a segment of 30 % of the circle
        const double apothem = radius * std::cos(pi / count);
        fill(sim, {-radius, -radius}, {radius, level}, spacing,
             [&](double x, double y) { return inside(x, y, apothem - 0.5 * spacing, 0); });
        id = add_polyline(sim, points, GP_WALL_NO_SLIP, [&](gp_plate &p) {
            p.omega = omega;
            change(p);
        });
    }
    // Is a place so far from the middle at most, in the direction of each segment?
    bool inside(double x, double y, double distance, double angle) const {
        const auto count = static_cast<int>(points.size()) - 1;
        for (int k = 0; k < count; ++k) {
            const double at = angle - 2 * pi * (k + 0.5) / count;
            if (x * std::cos(at) + y * std::sin(at) > distance)
                return false;
        }
        return true;
    }
    int outside(double margin) {
        const double apothem = radius * std::cos(pi / static_cast<double>(points.size() - 1));
        const double angle = sim.load(id).angle;
        const std::vector<double> x = sim.field(GP_FIELD_X), y = sim.field(GP_FIELD_Y);
        int found = 0;
        for (std::size_t i = 0; i < x.size(); ++i)
            found += !inside(x[i], y[i], apothem + margin, angle);
        return found;
    }
    // Between the drum and the surface, m2.
    double area() {
        constexpr int strips = 400;
        const double apothem = radius * std::cos(pi / static_cast<double>(points.size() - 1)),
                     width = 2 * apothem / strips;
        std::vector<double> x, h(strips);
        for (int k = 0; k < strips; ++k)
            x.push_back(-apothem + (k + 0.5) * width);
        EXPECT_EQ(gp_get_surface(sim, strips, x.data(), h.data()), GP_OK) << gp_last_error();
        const double mean_radius = 0.5 * (radius + apothem);
        double sum = 0;
        for (int k = 0; k < strips; ++k) {
            const double at = x[static_cast<std::size_t>(k)], bottom = -std::sqrt(mean_radius * mean_radius - at * at);
            const double height = h[static_cast<std::size_t>(k)];
            if (height != 0) // no material there
                sum += std::max(0.0, height - bottom) * width;
        }
        return sum;
    }
    // Of a straight line through the surface in the middle half, degrees.
    double slope() {
        std::vector<double> x, h(21);
        for (int k = 0; k < 21; ++k)
            x.push_back(radius * (-0.5 + 0.05 * k));
        EXPECT_EQ(gp_get_surface(sim, 21, x.data(), h.data()), GP_OK) << gp_last_error();
        double xy = 0, xx = 0;
        for (int k = 0; k < 21; ++k) {
            xy += x[static_cast<std::size_t>(k)] * h[static_cast<std::size_t>(k)];
            xx += x[static_cast<std::size_t>(k)] * x[static_cast<std::size_t>(k)];
        }
        return std::atan(xy / xx) * 180 / pi;
    }
};

struct DrumCase {
    int count;
    double froude;
};

class RotatingDrum : public testing::TestWithParam<DrumCase> {};

} // namespace

// omega^2 R / g of 1e-4 to 1e-2, the rolling regime. At the start the fill turns with the drum until it slides.
TEST_P(RotatingDrum, RollsAtASteadySlope) {
    const double across = 16, spacing = Drum::radius / across;
    Drum drum(GetParam().count, across, GetParam().froude, config(spacing));
    const double turn = 2 * pi / drum.omega;
    // Steady from .3 of a turn on: the fill has gone round about once.
    drum.sim.run(0.3 * turn);
    const gp_state before = drum.sim.state();
    const gp_load first = drum.sim.load(drum.id);
    double low = INFINITY, high = -INFINITY;
    for (int k = 1; k <= 14; ++k) {
        drum.sim.run((0.3 + 0.05 * k) * turn);
        EXPECT_EQ(drum.outside(0), 0);
        const double slope = drum.slope();
        low = std::min(low, slope);
        high = std::max(high, slope);
    }
    const gp_state after = drum.sim.state();
    const gp_load last = drum.sim.load(drum.id);
    EXPECT_NEAR(last.angle, 2 * pi, 1e-9);
    // Between the angle of rest of the material and that of the fastest shear, and steady: a surface of so few spacings
    // is known to about a spacing over its length.
    EXPECT_GT(low, 21);
    EXPECT_LT(high, 32);
    EXPECT_LT(high - low, 6);
    // What the drum does is dissipated, but for what is stored at the two ends.
    const double work = -drum.omega * (last.impulse_torque - first.impulse_torque);
    const double stored =
        after.kinetic + after.potential + after.elastic - before.kinetic - before.potential - before.elastic;
    const double dissipated = after.dissipated - before.dissipated;
    EXPECT_GT(work, 0);
    EXPECT_NEAR(work, dissipated + stored, 0.03 * work);
    EXPECT_NEAR(before.plate_work - after.plate_work, work, 1e-9 * work);
}

// A drum this slow flows in the three or four rows at its surface alone, within a horizon of it, where no sum of weights says
// that they are full: .902 of the area were left before collisions moved apart what had become crowded.
TEST(SlowDrum, KeepsItsVolume) {
    const double across = 12, spacing = Drum::radius / across;
    Drum drum(48, across, 1e-4, config(spacing));
    const double turn = 2 * pi / drum.omega;
    const auto particles = static_cast<double>(drum.sim.field(GP_FIELD_X).size());
    constexpr int samples = 8;
    double mean = 0;
    for (int k = 1; k <= samples; ++k) {
        drum.sim.run((0.4 + 0.35 * k / samples) * turn);
        mean += drum.area() / (particles * spacing * spacing) / samples;
    }
    std::printf("  area under the surface over that of the particles: %.4f\n", mean);
    EXPECT_GT(mean, 0.95);
    EXPECT_LT(mean, 1.03);
}

INSTANTIATE_TEST_SUITE_P(Drums, RotatingDrum,
                         testing::Values(DrumCase{24, 1e-2}, DrumCase{96, 1e-2}, DrumCase{24, 1e-3}));

namespace {

// The motion of a drum by a table of its angle, and driven by the host, where `omega` is another number.
std::vector<double> turned(int how) {
    const double t_end = 0.3;
    const gp_config c = config(0.01);
    const std::vector<double> t{0, 0.1, 2}, none{0, 0, 0};
    double w = std::sqrt(1e-2 * gravity / Drum::radius);
    const std::vector<double> angle{0, 0.1 * w, 2 * w};
    Drum drum(24, 10, 1e-2, c, [&](gp_plate &p) {
        if (how == 0)
            return;
        p.omega = 0;
        if (how == 2)
            return;
        p.n_knots = 3;
        p.knot_t = t.data();
        p.knot_angle = angle.data();
        if (how == 3)
            p.knot_x = p.knot_y = none.data();
    });
    if (how == 2) {
        EXPECT_EQ(gp_set_plate_motion(drum.sim, drum.id, 0, 0, drum.omega), GP_OK) << gp_last_error();
    }
    drum.sim.run(t_end);
    std::vector<double> shown = drum.sim.field(GP_FIELD_X);
    const gp_load load = drum.sim.load(drum.id);
    EXPECT_NEAR(load.angle, drum.omega * t_end, 1e-12);
    shown.push_back(load.impulse_torque);
    return shown;
}

} // namespace

TEST(Turning, ByARateByTheHostAndByATableIsTheSame) {
    const std::vector<double> rate = turned(0);
    EXPECT_EQ(turned(2), rate) << "driven by the host";
    const std::vector<double> table = turned(1);
    EXPECT_EQ(turned(3), table) << "with displacements of zero";
    // The mean rate of a step by its two ends is another number in the last places, and grains amplify that.
    double largest = 0;
    for (std::size_t i = 0; i < rate.size(); ++i)
        largest = std::max(largest, std::abs(table[i] - rate[i]));
    EXPECT_LT(largest, 0.05 * 0.01);
}

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

// ------------------------------------------------------------------------------------------------ belts

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

// ------------------------------------------------------------------------------------------------ the other schemes

TEST(Turning, OfOtherSchemesHoldsTheirMaterial) {
    // The implicit one on the way to its slope, and the paper's two, which let a grain into a wall by half a spacing.
    for (const int scheme : {0, 1, 2}) {
        const double spacing = Drum::radius / 10;
        gp_config c = config(spacing);
        if (scheme > 0) {
            ASSERT_EQ(gp_config_init(&c, sizeof c, scheme == 1 ? GP_PRESET_PAPER : GP_PRESET_PAPER_LOCAL), GP_OK);
            c.spacing = spacing;
            c.threads = 1;
        } else {
            c.stress = GP_STRESS_IMPLICIT;
            c.delta = 1e-4;
        }
        Drum drum(24, 10, 1e-2, c);
        drum.sim.run(0.1 * 2 * pi / drum.omega);
        const gp_load load = drum.sim.load(drum.id);
        EXPECT_EQ(drum.outside(scheme == 0 ? 0 : 0.5 * spacing), 0) << scheme;
        EXPECT_NEAR(load.angle, 0.2 * pi, 1e-9);
        EXPECT_LT(load.impulse_torque, 0) << scheme; // the material hangs back
    }
}
