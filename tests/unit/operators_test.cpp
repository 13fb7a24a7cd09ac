// The peridynamic operators: exact for linear fields, second order, adjoint to each other.
#include <gtest/gtest.h>

#include <cmath>

#include "operators.hpp"
#include "world_support.hpp"

using namespace gp;
using test::Block;

namespace {

bool inside(double x, double y) {
    return std::min({x, y, 1 - x, 1 - y}) > 0.25;
}

// Root mean square error of L_xx for u = sin(3x + 2y) away from the edges.
double gradient_error(int n, double jitter) {
    Block block(n, jitter);
    Particles &p = block.world->particles;
    block.set(p.vx, [](double x, double y) { return std::sin(3 * x + 2 * y); });
    test::make_gradient(*block.world);
    double square = 0;
    int count = 0;
    for (int64_t i = 0; i < p.count; ++i)
        if (inside(p.x[i], p.y[i])) {
            square += std::pow(p.lxx[i] - 3 * std::cos(3 * p.x[i] + 2 * p.y[i]), 2);
            ++count;
        }
    return std::sqrt(square / count);
}

// The same for the force density of the pressure p = 2 + sin(3x + 2y), which is -grad p.
double force_error(int n, double jitter) {
    Block block(n, jitter);
    World &world = *block.world;
    Particles &p = world.particles;
    test::make_gradient(world); // at rest: only the shape tensor
    block.set(p.pressure, [](double x, double y) { return 2 + std::sin(3 * x + 2 * y); });
    test::make_force(world);
    const double density = world.constants.materials[0].density;
    double square = 0;
    int count = 0;
    for (int64_t i = 0; i < p.count; ++i)
        if (inside(p.x[i], p.y[i])) {
            square += std::pow(density * p.ax[i] + 3 * std::cos(3 * p.x[i] + 2 * p.y[i]), 2);
            ++count;
        }
    return std::sqrt(square / count);
}

} // namespace

TEST(Gradient, IsExactForLinearFieldsOnAnyParticles) {
    Block block(20, 0.3);
    Particles &p = block.world->particles;
    block.set(p.vx, [](double x, double y) { return 0.3 + 2 * x - 5 * y; });
    block.set(p.vy, [](double x, double y) { return -1 + 0.7 * x + 4 * y; });
    test::make_gradient(*block.world);
    for (int64_t i = 0; i < p.count; ++i) { // free edges and corners included
        ASSERT_NEAR(p.lxx[i], 2, 1e-12);
        ASSERT_NEAR(p.lxy[i], -5, 1e-12);
        ASSERT_NEAR(p.lyx[i], 0.7, 1e-12);
        ASSERT_NEAR(p.lyy[i], 4, 1e-12);
    }
}

TEST(Gradient, IsOfSecondOrder) {
    for (double jitter : {0.0, 0.1}) {
        const double order = std::log2(gradient_error(32, jitter) / gradient_error(64, jitter));
        EXPECT_GT(order, 1.9) << "jitter " << jitter;
    }
}

TEST(Force, IsOfSecondOrder) {
    const double order = std::log2(force_error(32, 0) / force_error(64, 0));
    EXPECT_GT(order, 1.9);
}

TEST(Force, KeepsMomentum) {
    Block block(16, 0.3, 0.05);
    World &world = *block.world;
    Particles &p = world.particles;
    block.randomise(p.vx, -1, 1);
    block.randomise(p.vy, -1, 1);
    test::make_gradient(world);
    block.randomise(p.pressure, -1, 1000); // some of it stress-free
    for (double &value : p.pressure)
        value = std::max(value, 0.0);
    block.randomise(p.sxx, -400, 400);
    block.randomise(p.sxy, -400, 400);
    test::make_force(world);
    double x = 0, y = 0, scale = 0;
    for (int64_t i = 0; i < p.count; ++i) {
        x += p.ax[i];
        y += p.ay[i];
        scale += std::abs(p.ax[i]) + std::abs(p.ay[i]);
    }
    EXPECT_NEAR(x, 0, 1e-12 * scale);
    EXPECT_NEAR(y, 0, 1e-12 * scale);
}

TEST(PowerIdentity, HoldsToRounding) {
    // sum u.f = -sum V sigma:L for any velocities and stresses.
    Block block(20, 0.3);
    World &world = *block.world;
    Particles &p = world.particles;
    block.randomise(p.vx, -1, 1);
    block.randomise(p.vy, -1, 1);
    test::make_gradient(world);
    block.randomise(p.pressure, 0, 1000);
    block.randomise(p.sxx, -400, 400);
    block.randomise(p.sxy, -400, 400);
    test::make_force(world);
    const double of_forces = block.sum(&BlockSums::total_power), of_stresses = block.sum(&BlockSums::internal_power);
    EXPECT_GT(std::abs(of_stresses), 1);
    EXPECT_NEAR(of_forces, -of_stresses, 1e-12 * std::abs(of_stresses) * 10);
}

TEST(Penalty, OnlyTakesEnergyAndLeavesLinearMotionAlone) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
        Block block(16, 0.3, 0.05, seed);
        World &world = *block.world;
        Particles &p = world.particles;
        block.generator.seed(seed);
        block.randomise(p.vx, -1, 1);
        block.randomise(p.vy, -1, 1);
        test::make_gradient(world);
        block.randomise(p.pressure, -500, 500); // half of it stress-free
        for (double &value : p.pressure)
            value = std::max(value, 0.0);
        test::make_force(world);
        const double taken = -block.sum(&BlockSums::total_power) - block.sum(&BlockSums::internal_power);
        EXPECT_GT(taken, 0) << seed;

        block.set(p.vx, [](double x, double y) { return 0.3 + 2 * x - 5 * y; });
        block.set(p.vy, [](double x, double y) { return -1 + 0.7 * x - 2 * y; });
        test::make_gradient(world);
        for (double &value : p.pressure)
            value = 1e-9;
        test::make_force(world);
        for (int64_t i = 0; i < p.count; ++i)
            ASSERT_NEAR(p.ax[i], 0, 1e-9);
    }
}

TEST(InverseShape, IsPlainWhereItCanAndVanishesWhereItMust) {
    const double k0 = 3;
    // Full neighbourhood: the inverse.
    Moments m;
    m.kxx = 3;
    m.kxy = 0.5;
    m.kyy = 2;
    const SymmetricTensor g = inverse_shape(m, k0);
    EXPECT_NEAR(g.xx * m.kxx + g.xy * m.kxy, 1, 1e-14);
    EXPECT_NEAR(g.xx * m.kxy + g.xy * m.kyy, 0, 1e-14);
    EXPECT_NEAR(g.xy * m.kxy + g.yy * m.kyy, 1, 1e-14);
    // None at all, and a straight row at 30 degrees: nothing across it.
    const SymmetricTensor none = inverse_shape(Moments{}, k0);
    EXPECT_EQ(none.xx, 0);
    EXPECT_EQ(none.xy, 0);
    EXPECT_EQ(none.yy, 0);
    const double c = std::cos(0.5), s = std::sin(0.5);
    Moments row;
    row.kxx = 1.5 * c * c;
    row.kxy = 1.5 * c * s;
    row.kyy = 1.5 * s * s;
    const SymmetricTensor r = inverse_shape(row, k0);
    EXPECT_NEAR(r.xx * c + r.xy * s, c / 1.5, 1e-12);
    EXPECT_NEAR(r.xy * c + r.yy * s, s / 1.5, 1e-12);
    EXPECT_NEAR(-r.xx * s + r.xy * c, 0, 1e-9);
    // Continuous at the floor.
    const double floor = deficient_share * k0;
    const Tensor below = deficient_inverse(1, 0, floor * (1 - 1e-9), k0),
                 above = deficient_inverse(1, 0, floor * (1 + 1e-9), k0);
    EXPECT_NEAR(below(1, 1), above(1, 1), 1e-6 * above(1, 1));
}

// What the time step's limit takes from the lattice's waves is what the stages do to one, away from the edges.
TEST(Wave, IsWhatTheStagesMakeOfIt) {
    constexpr int n = 32, a = 16, b = 8; // of the half period's 32 parts
    Block block(n, 0, 0.05);
    World &world = *block.world;
    Particles &p = world.particles;
    const Constants &c = world.constants;
    Wave wave{};
    int next = 0;
    for_each_wave(c.horizon, c.spacing, [&](const Wave &visited) {
        if (next++ == a * (a + 1) / 2 + b)
            wave = visited;
    });
    EXPECT_EQ(next, 33 * 34 / 2);
    const double k = std::acos(-1.0) / 32 / c.spacing;
    const auto phase = [&](double x, double y) { return k * (a * x + b * y); };
    const auto sine = [&](double x, double y) { return std::sin(phase(x, y)); };
    const auto interior = [](double x, double y) { return std::min({x, y, 1 - x, 1 - y}) > 0.3; };

    block.set(p.vx, sine);
    test::make_gradient(world);
    for (double &value : p.pressure) // stressed and elastic, as the penalty wants it, but without a force of its own
        value = 1e-9;
    test::make_force(world);
    int64_t looked_at = 0;
    for (int64_t i = 0; i < p.count; ++i) {
        if (!interior(p.x[i], p.y[i]))
            continue;
        ++looked_at;
        const double cosine = std::cos(phase(p.x[i], p.y[i]));
        const double gradient2 = c.volume * (p.lxx[i] * p.lxx[i] + p.lxy[i] * p.lxy[i]);
        ASSERT_NEAR(gradient2, wave.gradient2 * cosine * cosine, 1e-12);
        const double rate = c.elastic_penalty * c.penalty * c.lattice.number_density / world.material_of(i).density;
        ASSERT_NEAR(p.ax[i], -rate * wave.unseen * p.vx[i], 1e-9 * rate);
    }
    EXPECT_GT(looked_at, 100);

    world.clock.dt = 1e-4;
    const double own = world.material_of(0).density, height = 1e-3 * own;
    block.set(p.density, [&](double x, double y) { return own + height * sine(x, y); });
    for (double &value : p.pressure) // without pressure all of it flows
        value = 0;
    stages::flowing(world); // says so to diffusion, which is alone here: density_of_spacing, the tie to N, does not run
    stages::gradient_and_exchange(world);
    stages::density_diffusion(world);
    const double share = world.scene->config().density_diffusion * c.sound_speed / c.spacing * world.clock.dt;
    for (int64_t i = 0; i < p.count; ++i)
        if (interior(p.x[i], p.y[i])) {
            ASSERT_NEAR(p.density[i] - own, (1 - share * wave.difference) * height * sine(p.x[i], p.y[i]),
                        1e-9 * height);
        }
}
