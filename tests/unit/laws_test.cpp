// The kernel's lattice sums and the return map.
#include <gtest/gtest.h>

#include "kernel.hpp"
#include "material/return_map.hpp"

using namespace gp;

TEST(Kernel, HasTheLatticeSumsOfTheMethod) {
    // Worked out independently for w = (1 - r/R)^3 on the square lattice.
    EXPECT_NEAR(lattice_sums(2.1, 1).number_density, 0.7146215074215582, 1e-12);
    EXPECT_NEAR(lattice_sums(2.2, 1).number_density, 0.8344071936876292, 1e-12);
    EXPECT_NEAR(lattice_sums(3.0, 1).number_density, 2.0569639651966, 1e-12);
    EXPECT_NEAR(lattice_sums(4.0, 1).number_density, 4.198295818402637, 1e-12);
    EXPECT_NEAR(lattice_sums(0.4, 0.1).second_moment, 0.01 * lattice_sums(4.0, 1).second_moment, 1e-14);
    EXPECT_EQ(weight(1.0, 1.0), 0);
    EXPECT_EQ(weight(1.5, 1.0), 0);
    EXPECT_EQ(weight(0.0, 1.0), 1);
}

// The half plane below a row, the row among it: what it lacks to N0, and its first moment; R = 1.5: one row of three below it.
TEST(Kernel, KnowsTheRowAtAFreeSurface) {
    const double straight = weight(1, 1 / 1.5), across = weight(std::sqrt(2.0), 1 / 1.5);
    EXPECT_NEAR(lattice_sums(1.5, 1).surface_lack, straight + 2 * across, 1e-15);
    EXPECT_NEAR(lattice_sums(1.5, 1).surface_moment, straight + 2 * across, 1e-15);
    for (const double horizon : {2.5, 4.0}) {
        const LatticeSums sums = lattice_sums(horizon, 1);
        EXPECT_NEAR(2 * sums.surface_lack + sums.row, sums.number_density, 1e-14);
        EXPECT_NEAR(lattice_sums(0.1 * horizon, 0.1).surface_moment, 0.1 * sums.surface_moment, 1e-14);
    }
}

namespace {

const double d = 0.002, rho_s = 2500, i0 = 0.3;
const ReturnMap beads{0.384, 0.625, i0 / (d * std::sqrt(rho_s)), 5e4};

} // namespace

TEST(ReturnMap, LandsOnTheFrictionLaw) {
    const double dt = 1e-4;
    for (double pressure : {1.0, 50.0, 700.0})
        for (double over : {1.0001, 1.1, 2.0, 10.0, 1000.0})
            for (double of_rate : {pressure, 0.2 * pressure, 3 * pressure}) {
                const double trial = over * beads.mu_s * pressure;
                const double tau = beads.shrink(trial, pressure, of_rate, dt) * trial;
                // The plastic shear rate is what the stress came back by; I follows from it, and mu from I.
                const double rate = (trial - tau) / (beads.shear_modulus * dt);
                const double inertial = rate * d / std::sqrt(of_rate / rho_s);
                const double mu = beads.mu_s + (beads.mu_2 - beads.mu_s) / (i0 / inertial + 1);
                EXPECT_NEAR(tau, mu * pressure, 1e-9 * pressure) << "p " << pressure << " trial " << trial;
            }
}

TEST(ReturnMap, LeavesWhatIsInsideAndBoundsWhatIsOutside) {
    EXPECT_EQ(beads.shrink(0.999 * beads.mu_s * 100, 100, 100, 1e-4), 1);
    EXPECT_EQ(beads.shrink(5, 0, 100, 1e-4), 0);
    EXPECT_EQ(beads.shrink(0, 100, 100, 1e-4), 1);
    // Where the pressure has just begun, I knows of none: the largest friction.
    EXPECT_NEAR(beads.shrink(90, 100, 0, 1e-4) * 90, beads.mu_2 * 100, 1e-12 * 100);
    EXPECT_NEAR(beads.shrink(50, 100, 0, 1e-4) * 50, 50, 1e-12 * 100);
    EXPECT_LE(beads.shrink(1e12, 100, 100, 1e-4) * 1e12, beads.mu_2 * 100 * (1 + 1e-9));
    const ReturnMap fluid{0, 0, beads.rate_factor, beads.shear_modulus};
    EXPECT_EQ(fluid.shrink(5, 100, 100, 1e-4), 0);
}

TEST(Rotation, KeepsTheMagnitudeAndTurnsByTwiceTheAngle) {
    const Deviator s{3, -4};
    Deviator turned = s;
    const int n = 1000;
    for (int k = 0; k < n; ++k)
        turned = rotate(turned, -0.5, 1e-3); // spin -w: the body turns by +w in total angle 0.5
    EXPECT_NEAR(equivalent_stress(turned), 5, 1e-12);
    const double angle = 0.5;
    EXPECT_NEAR(turned.xx, std::cos(2 * angle) * 3 - std::sin(2 * angle) * -4, 1e-5);
    EXPECT_NEAR(turned.xy, std::sin(2 * angle) * 3 + std::cos(2 * angle) * -4, 1e-5);
}
