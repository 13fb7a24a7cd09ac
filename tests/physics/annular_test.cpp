// A Couette cell: the inner ring turns, the outer one is pressed on the material.
#include "../support/layer.hpp"
#include "../support/lines.hpp"

using namespace test;

namespace {

constexpr double inner = 0.04, outer = 0.066, spacing = 0.0025, load = 1000, omega = 1; // m, m, m, Pa, rad/s
constexpr int outer_plates = 24;

// mu(I) in one dimension: the shear stress is M / (2 pi r^2), at one pressure p. Coarse grains that bear more the faster they
// shear: the zone that flows is six spacings wide.
struct Cell {
    Law law{0.2, 0.8, 0.3, 0.01};
    double pressure; // Pa
    double yield_radius(double moment) const { return std::sqrt(moment / (2 * pi * law.mu_s * pressure)); }
    // m/s, of the material at r, at rest from the yield radius on.
    double velocity(double moment, double r) const {
        const double end = yield_radius(moment);
        double rate = 0; // d(u/r)/dr = -gamma / r, gamma = I sqrt(p / rho_s) / d
        const int steps = 400;
        for (int k = 0; k < steps && r < end; ++k) {
            const double at = r + (end - r) * (k + 0.5) / steps, mu = moment / (2 * pi * at * at * pressure);
            rate += law.inertial(mu) * std::sqrt(pressure / 2500) / law.d / at * (end - r) / steps;
        }
        return rate * r;
    }
    double moment() const {
        double low = 2 * pi * law.mu_s * pressure * inner * inner, high = 0.9999 * low * law.mu_2 / law.mu_s;
        for (int k = 0; k < 60; ++k) {
            const double middle = 0.5 * (low + high);
            (velocity(middle, inner) < omega * inner ? low : high) = middle;
        }
        return low;
    }
};

} // namespace

TEST(AnnularCell, HasTheTorqueAndTheYieldRadiusOfTheLaw) {
    gp_config c = config(spacing);
    c.gravity_y = 0;
    Sim sim(c);
    Cell cell;
    gp_material beads;
    gp_material_init(&beads, sizeof beads);
    beads.mu_s = cell.law.mu_s;
    beads.mu_2 = cell.law.mu_2;
    beads.i0 = cell.law.i0;
    beads.grain_diameter = cell.law.d;
    const int32_t material = sim.add(beads);
    const int32_t ring = add_polyline(sim, arc(0, 0, inner, 0, 360, 96), GP_WALL_NO_SLIP,
                                      [](gp_plate &p) { p.omega = omega; }); // counter-clockwise: material outside
    const std::vector<int32_t> around = add_line(sim, arc(0, 0, outer, 0, -360, outer_plates), GP_WALL_NO_SLIP,
                                                 [](gp_plate &p) { p.normal_pressure = load; });
    const double apothem = outer * std::cos(pi / outer_plates);
    const int rows = static_cast<int>(std::round((apothem - inner) / spacing));
    add_rings(sim, material, inner, apothem, rows, spacing);
    ASSERT_FALSE(testing::Test::HasFatalFailure());
    // Steady within .3 s. Means of .2 s.
    sim.run(0.4);
    const double before = sim.load(ring).impulse_torque;
    double outer_moment = 0;
    std::vector<double> speeds(static_cast<std::size_t>(rows), 0.0), counts(speeds);
    cell.pressure = load;
    const double zone = cell.yield_radius(cell.moment());
    double pressure = 0, in_zone = 0;
    const int samples = 20;
    for (int k = 1; k <= samples; ++k) {
        sim.run(0.4 + 0.2 * k / samples);
        for (const int32_t id : around)
            outer_moment += sim.load(id).torque_pivot / samples;
        const std::vector<double> px = sim.field(GP_FIELD_X), py = sim.field(GP_FIELD_Y), u = sim.field(GP_FIELD_VX),
                                  v = sim.field(GP_FIELD_VY), p = sim.field(GP_FIELD_PRESSURE);
        for (std::size_t i = 0; i < px.size(); ++i) {
            const double r = std::hypot(px[i], py[i]);
            const auto row = static_cast<std::size_t>(std::max(0.0, (r - inner) / spacing));
            if (row < speeds.size()) {
                speeds[row] += (px[i] * v[i] - py[i] * u[i]) / r;
                ++counts[row];
            }
            if (r < zone) {
                pressure += p[i];
                ++in_zone;
            }
        }
    }
    // Of the pressure the ring around decides only that of the outermost rows: what is at rest between may bear more along it
    // than across, as it began. So the law at the pressure that is where it flows.
    cell.pressure = pressure / in_zone;
    EXPECT_NEAR(cell.pressure, load, 0.06 * load);
    const double exact = cell.moment(), moment = -(sim.load(ring).impulse_torque - before) / 0.2;
    // Of ten to thirty rows in the gap it is .5 to 2.8 % too much with 16 spacings in the inner radius, 1.7 % with 24.
    EXPECT_NEAR(moment, exact, 0.04 * exact);
    EXPECT_NEAR(outer_moment, moment, 0.01 * moment); // angular momentum
    // Rings of particles roll on each other: the profile has steps of .05 of the ring's speed, and is .023 narrower than the
    // law's (with 24 spacings in the radius .010 wider). Where the law has rest there is less than .01.
    double width = 0, exact_width = 0;
    for (std::size_t row = 0; row < speeds.size(); ++row) {
        const double r = inner + (static_cast<double>(row) + 0.5) * spacing;
        const double share = speeds[row] / counts[row] / (omega * inner),
                     right = cell.velocity(exact, r) / (omega * inner);
        width += share;
        exact_width += right;
        EXPECT_NEAR(share, right, 0.06) << r;
        if (r > cell.yield_radius(exact)) {
            EXPECT_LT(std::abs(share), 0.01) << r;
        }
    }
    EXPECT_NEAR(width, exact_width, 0.05 * exact_width);
    EXPECT_GT(cell.yield_radius(exact), inner + 5 * spacing);
}
