// Drums that turn, partly filled: the slope, the work, the volume.
#include <cstdio>
#include <functional>

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

TEST(Drum, TurnsTheSameByARateByTheHostAndByATableIsTheSame) {
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

TEST(Drum, OfOtherSchemesHoldsItsMaterial) {
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
