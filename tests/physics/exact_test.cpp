// Exact solutions: free fall, hydrostatic column, balance of momentum.
#include <algorithm>

#include "../support/scene.hpp"

using namespace test;

TEST(FreeFall, FollowsTheDiscreteParabola) {
    gp_config c = config(0.0025);
    c.time_step = 1e-5;
    c.sound_speed = 10;
    Sim sim(c);
    sim.column(0, 1, 0.025, 0.025);
    const std::vector<double> x0 = sim.field(GP_FIELD_X), y0 = sim.field(GP_FIELD_Y);
    const int n = 1000;
    sim.step(n);
    const std::vector<double> x = sim.field(GP_FIELD_X), y = sim.field(GP_FIELD_Y), vy = sim.field(GP_FIELD_VY);
    // u, then r: y = y0 - g dt^2 n (n + 1) / 2.
    const double fallen = 9.81 * 1e-10 * n * (n + 1) / 2;
    for (std::size_t i = 0; i < x.size(); ++i) {
        EXPECT_NEAR(x[i], x0[i], 1e-12);
        EXPECT_NEAR(y[i], y0[i] - fallen, 1e-12);
        EXPECT_NEAR(vy[i], -9.81 * 1e-5 * n, 1e-12);
    }
    EXPECT_EQ(*std::max_element(vy.begin(), vy.end()), *std::min_element(vy.begin(), vy.end()));
}

TEST(UniformMotion, IsKept) {
    gp_config c = config(0.01);
    c.gravity_y = 0;
    c.sound_speed = 5;
    Sim sim(c);
    sim.column(0, 0, 0.1, 0.1, 0, 0.3, -0.7);
    sim.run(0.1);
    for (double v : sim.field(GP_FIELD_VX))
        EXPECT_NEAR(v, 0.3, 1e-13);
    for (double v : sim.field(GP_FIELD_VY))
        EXPECT_NEAR(v, -0.7, 1e-13);
    EXPECT_EQ(sim.state().at_rest, 0);
}

namespace {

struct Tank {
    explicit Tank(double spacing, int32_t friction)
        : sim([&] {
              gp_config c = config(spacing);
              c.sound_speed = 10;
              return c;
          }()) {
        sim.column(0, 0, 0.05, 0.05);
        bottom = sim.add(floor_at(0, 0, 0.05, friction));
        left = sim.add(plate(0, 0, 0, 0.1, friction));
        right = sim.add(plate(0.05, 0.1, 0.05, 0, friction));
    }
    Sim sim;
    int32_t bottom, left, right;
};

} // namespace

TEST(HydrostaticColumn, HasItsPressureAndStaysAtRest) {
    Tank tank(0.00125, GP_WALL_FREE_SLIP);
    const std::vector<double> y0 = tank.sim.field(GP_FIELD_Y);
    tank.sim.run(0.5);
    const std::vector<double> y = tank.sim.field(GP_FIELD_Y), p = tank.sim.field(GP_FIELD_PRESSURE);
    const double scale = 1550 * 9.81;
    double square = 0, base = 0;
    int base_count = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        square += std::pow(p[i] - scale * (0.05 - y[i]), 2);
        if (y[i] < 0.00125) {
            base += p[i] + scale * y[i];
            ++base_count;
        }
        EXPECT_NEAR(y[i], y0[i], 0.1 * 0.00125);
    }
    EXPECT_NEAR(base / base_count, 760.275, 0.005 * 760.275);
    EXPECT_LT(std::sqrt(square / static_cast<double>(p.size())), 0.01 * 760.275);
    const gp_state state = tank.sim.state();
    EXPECT_EQ(state.at_rest, 1);
    EXPECT_LT(state.kinetic, 1e-6 * 1550 * 9.81 * 0.05 * 0.05 * 0.025);
    // Together the plates bear the weight. The forces reach over the horizon, so a part of it of the order of dl / width
    // hangs on the side walls; and the corner's diagonal belongs to one of the two plates that meet there.
    const double weight = scale * 0.05 * 0.05;
    // At one instant the loads ring by 1.5e-4 of the weight; these are the means over .2 s.
    constexpr double time = 0.2;
    const auto loads = [&](int32_t id) { return tank.sim.load(id); };
    const gp_load before[] = {loads(tank.bottom), loads(tank.left), loads(tank.right)};
    double torque = 0;
    constexpr int samples = 20;
    for (int k = 1; k <= samples; ++k) {
        tank.sim.run(0.5 + time * k / samples);
        torque += loads(tank.left).torque / samples;
    }
    const auto mean_of = [&](int32_t id, const gp_load &then) {
        gp_load mean = loads(id);
        mean.fx = (mean.impulse_x - then.impulse_x) / time;
        mean.fy = (mean.impulse_y - then.impulse_y) / time;
        return mean;
    };
    const gp_load bottom = mean_of(tank.bottom, before[0]), left = mean_of(tank.left, before[1]),
                  right = mean_of(tank.right, before[2]);
    EXPECT_NEAR(bottom.fy + left.fy + right.fy, -weight, 1e-4 * weight);
    EXPECT_NEAR(bottom.fx + left.fx + right.fx, 0, 1e-4 * weight);
    EXPECT_NEAR(bottom.fy, -weight, 0.015 * weight);
    EXPECT_NEAR(left.fx, -weight / 2, 0.03 * weight / 2);
    EXPECT_NEAR(right.fx, weight / 2, 0.03 * weight / 2);
    // The resultant of a linear pressure acts at a third of the height; the left wall's end 0 is its foot.
    EXPECT_NEAR(torque, weight / 2 * 0.05 / 3, 0.04 * weight / 2 * 0.05 / 3);
}

TEST(Loads, SumToTheBalanceOfMomentum) {
    // A sloshing start (no initial pressure), rough walls: every kind of contact acts.
    gp_config c = config(0.0025);
    Sim sim(c);
    gp_column column;
    gp_column_init(&column, sizeof column);
    column.width = 0.05;
    column.height = 0.1;
    column.initial_pressure = GP_INITIAL_NONE;
    column.vx = 0.5;
    ASSERT_EQ(gp_add_column(sim, &column, nullptr), GP_OK);
    std::vector<int32_t> plates = {sim.add(floor_at(0, -0.1, 0.2)), sim.add(plate(0, 0, 0, 0.2, GP_WALL_FREE_SLIP))};
    gp_plate right = plate(0.06, 0.2, 0.06, 0, GP_WALL_COULOMB);
    right.wall_mu = 0.3;
    plates.push_back(sim.add(right));
    gp_state before = sim.state();
    const double weight = static_cast<double>(before.n_particles) * 1550 * 0.0025 * 0.0025 * 9.81;
    for (int k = 0; k < 400; ++k) {
        sim.step();
        const gp_state after = sim.state();
        double fx = 0, fy = 0;
        for (int32_t id : plates) {
            const gp_load load = sim.load(id);
            fx += load.fx;
            fy += load.fy;
        }
        ASSERT_NEAR((after.momentum_x - before.momentum_x) / after.dt, -fx, 1e-9 * weight) << k;
        ASSERT_NEAR((after.momentum_y - before.momentum_y) / after.dt, -fy - weight, 1e-9 * weight) << k;
        before = after;
    }
    double impulse_x = 0;
    for (int32_t id : plates)
        impulse_x += sim.load(id).impulse_x;
    EXPECT_NEAR(before.momentum_x, 0.5 * weight / 9.81 - impulse_x, 1e-9);
}

TEST(Collision, KeepsMomentumOfUnequalMaterials) {
    gp_config c = config(0.0025);
    c.gravity_y = 0;
    Sim sim(c);
    gp_material heavy;
    gp_material_init(&heavy, sizeof heavy);
    heavy.grain_density = 7800;
    const int32_t steel = sim.add(heavy);
    sim.column(0, 0, 0.025, 0.025, 0, 1, 0.1);
    sim.column(0.027, 0.003, 0.025, 0.025, steel, -1, 0);
    const gp_state before = sim.state();
    sim.run(0.02);
    const gp_state after = sim.state();
    EXPECT_NEAR(after.momentum_x, before.momentum_x, 1e-12);
    EXPECT_NEAR(after.momentum_y, before.momentum_y, 1e-12);
    EXPECT_LT(after.kinetic, before.kinetic);
    EXPECT_GT(after.dissipated, 0.05 * before.kinetic);
    EXPECT_NEAR(after.energy_error, 0, 0.02 * before.kinetic);
}
