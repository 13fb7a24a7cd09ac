// Columns that begin with a side stress, gp_material.k0.
#include <algorithm>

#include "../support/scene.hpp"

using namespace test;

namespace {

gp_material beads_with(double k0) {
    gp_material beads;
    gp_material_init(&beads, sizeof beads);
    beads.k0 = k0;
    return beads;
}

// A column between walls, 1.5 times as wide as high.
struct Box {
    static constexpr double height = 0.1, width = 0.15;
    static constexpr int rows = 20;
    Box(double k0, int32_t friction, int32_t initial = GP_INITIAL_HYDROSTATIC) : sim(config(height / rows)) {
        gp_column column;
        gp_column_init(&column, sizeof column);
        column.width = width;
        column.height = height;
        column.material = sim.add(beads_with(k0));
        column.initial_pressure = initial;
        EXPECT_EQ(gp_add_column(sim, &column, nullptr), GP_OK);
        base = sim.add(floor_at(0, 0, width, friction));
        left = sim.add(plate(0, -0.02, 0, 2 * height, friction));
        right = sim.add(plate(width, 2 * height, width, -0.02, friction));
    }
    // Mean loads from now to t, in those of a liquid; returns the largest speed meanwhile.
    double follow(double t, double &side, double &below) {
        const double begin = sim.state().time, from = sim.load(right).impulse_x - sim.load(left).impulse_x,
                     on = -sim.load(base).impulse_y;
        double fastest = 0;
        while (sim.state().time < t) {
            sim.step(4);
            fastest = std::max(fastest, sim.state().max_speed);
        }
        const double weight = 1550 * 9.81 * height, span = sim.state().time - begin;
        side = (sim.load(right).impulse_x - sim.load(left).impulse_x - from) / (span * weight * height);
        below = (-sim.load(base).impulse_y - on) / (span * weight * width);
        return fastest;
    }
    Sim sim;
    int32_t base, left, right;
};

class SideStress : public testing::TestWithParam<double> {};

} // namespace

// Side walls bear k0 rho g H^2 / 2 from the start on and for as long as nothing moves, the floor the weight. Plates' loads of 20
// rows are 2.7 and .8 % below that, for k0 as for a liquid's pressure (of 40 rows half as much): what the uppermost row presses.
// Nothing is set in motion: gravity that sets in at once drives the material at 29 (k0 = .5) to 45 times the speed.
TEST_P(SideStress, IsBorneByWallsAndMovesNothing) {
    const double k0 = GetParam();
    for (const int32_t friction : {GP_WALL_FREE_SLIP, GP_WALL_NO_SLIP}) {
        Box box(k0, friction);
        double side = 0, below = 0;
        const double fastest = box.follow(0.1, side, below);
        EXPECT_NEAR(side, 0.973 * k0, 0.015 * k0);
        EXPECT_NEAR(below, 0.992, 0.01);
        box.follow(0.3, side, below);
        EXPECT_NEAR(side, 0.973 * k0, 0.015 * k0);
        EXPECT_NEAR(below, 0.992, 0.01);
        EXPECT_EQ(box.sim.state().at_rest, 1);

        Box sudden(k0, friction, GP_INITIAL_NONE);
        EXPECT_LT(fastest, sudden.follow(0.02, side, below) / 20);
    }
}

INSTANTIATE_TEST_SUITE_P(Ratios, SideStress, testing::Values(0.5, 0.64, 1.5));

// In a silo, six times as high as wide, whose floor sinks, walls smoother than the material take over weight until all of their
// friction is called on. Janssen, with the side stress k0 of then as of before: the base bears (1 - exp(-e)) / e of the weight,
// e = 2 mu k0 H / W. The elastic law alone, blind to k0, has .89 of that for k0 = .64; and isotropic columns .6.
TEST(SideStressOfASilo, IsJanssens) {
    const double width = 0.06, height = 0.36;
    for (const double k0 : {0.5, 0.64, 0.8})
        for (const double mu : {0.2, 0.3}) {
            Sim sim(config(width / 12));
            sim.column(0, 0, width, height, sim.add(beads_with(k0)));
            gp_plate floor = floor_at(0, 0, width, GP_WALL_FREE_SLIP);
            floor.vy = -0.01;
            const int32_t base = sim.add(floor);
            for (gp_plate wall : {plate(0, -0.05, 0, 2 * height, GP_WALL_COULOMB),
                                  plate(width, 2 * height, width, -0.05, GP_WALL_COULOMB)}) {
                wall.wall_mu = mu;
                sim.add(wall);
            }
            sim.run(0.1);
            const double before = sim.load(base).impulse_y;
            sim.run(0.4);
            const double e = 2 * mu * k0 * height / width, weight = 1550 * 9.81 * width * height;
            const double share = (before - sim.load(base).impulse_y) / (0.3 * weight), janssen = (1 - std::exp(-e)) / e;
            EXPECT_NEAR(share, janssen, 0.06 * janssen) << k0 << " " << mu;
        }
}
