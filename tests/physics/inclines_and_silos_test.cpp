// What rough walls bear of long fronts and of a tall filling: bench/walls runs the same at other sizes, docs/validation.md has them.
#include <algorithm>

#include "../support/scene.hpp"

using namespace test;

// A column with a = .7 against a wall, on an incline of 16 degrees. With a front whose single grains had the friction mu_s the mass
// ran on, the farther the finer the spacing: 98 % of it within 7.9 lengths at 5 mm. Here, at 7 mm, as at 5 and 2.5 mm: 5.3 to 5.4.
TEST(InclinedColumn, RunsOutAsFarAsAtFinerSpacings) {
    const double length = 0.2, height = 0.14, angle = degrees(16);
    gp_config c = config(length / 28);
    c.gravity_x = 9.81 * std::sin(angle);
    c.gravity_y = -9.81 * std::cos(angle);
    Sim sim(c);
    gp_material beads;
    gp_material_init(&beads, sizeof beads);
    beads.grain_diameter = 0.0007;
    sim.column(0, 0, length, height, sim.material(beads));
    sim.add(floor_at(0, -0.1, 3));
    sim.add(plate(0, 0, 0, 3 * height));
    sim.run(2);
    std::vector<double> x = sim.field(GP_FIELD_X);
    std::sort(x.begin(), x.end());
    const auto mark = [&](double share) { return x[static_cast<std::size_t>(share * static_cast<double>(x.size()))]; };
    EXPECT_NEAR(mark(0.98) / length, 5.4, 0.07 * 5.4);
    EXPECT_NEAR(mark(0.9) / length, 4.2, 0.05 * 4.2);
    EXPECT_LT(sim.state().detached, 0.02);
    EXPECT_LT(sim.state().kinetic, 1e-4 * sim.state().dissipated); // what is left is the tail of the arrest
}

// A silo, six times as high as wide, whose floor sinks by 1 cm/s: a plug that slides along its walls. With the shear linear from
// wall to core the wall has mu(I) = .409 there. (Walls that carried the larger of two extrapolated shear stresses had .466.)
TEST(Silo, WallsBearNoMoreThanTheMaterialsFriction) {
    const double width = 0.06, height = 0.36;
    Sim sim(config(width / 12));
    sim.column(0, 0, width, height);
    gp_plate floor = floor_at(0, 0, width, GP_WALL_FREE_SLIP);
    floor.vy = -0.01;
    const int32_t bottom = sim.add(floor), left = sim.add(plate(0, -0.05, 0, 2 * height)),
                  right = sim.add(plate(width, 2 * height, width, -0.05));
    sim.run(0.5);
    const gp_load before[] = {sim.load(bottom), sim.load(left), sim.load(right)};
    sim.run(1);
    const gp_load after[] = {sim.load(bottom), sim.load(left), sim.load(right)};
    const auto mean = [&](int k, double gp_load::*part) { return (after[k].*part - before[k].*part) / 0.5; };
    const double normal = mean(2, &gp_load::impulse_x) - mean(1, &gp_load::impulse_x),
                 shear = -mean(1, &gp_load::impulse_y) - mean(2, &gp_load::impulse_y),
                 weight = 1550 * 9.81 * width * height;
    EXPECT_LT(shear / normal, 1.02 * 0.409);
    EXPECT_GT(shear / normal, 0.95 * 0.384); // it yields all along them
    EXPECT_NEAR(shear - mean(0, &gp_load::impulse_y), weight, 0.01 * weight);
}
