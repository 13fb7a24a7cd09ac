// Materials at the ends of what is allowed: grains from dust to boulders, no friction, so much of it that a column stands,
// laws that do not depend on the rate.
#include "extreme_support.hpp"

using namespace test;

namespace {

constexpr int resolution = 16;

gp_material beads() {
    gp_material m;
    EXPECT_EQ(gp_material_init(&m, sizeof m), GP_OK);
    return m;
}

// The collapse with a = 1.25 of a material.
gp_state deposit(const gp_material &m, double end = 1) {
    Sim sim(config(Collapse::length / resolution));
    sim.column(-Collapse::length / 2, 0, Collapse::length, Collapse::height, sim.material(m));
    sim.add(floor_at(0, -0.6, 0.6));
    const gp_state state = run_to_rest(sim, 0.05, end);
    EXPECT_EQ(state.at_rest, 1);
    EXPECT_LT(std::abs(state.energy_error), 0.01 * Collapse::energy);
    expect_finite(sim);
    return state;
}

gp_state deposit_of_friction(double mu) {
    gp_material m = beads();
    m.mu_s = m.mu_2 = mu;
    return deposit(m);
}

} // namespace

// I = 2 d |gamma| / sqrt(p / rho_s): small grains have the friction mu_s at any rate, large ones mu_2.
TEST(GrainDiameter, GoesFromOneLimitOfTheLawToTheOther) {
    std::vector<double> peak;
    for (const double d : {1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.}) {
        SCOPED_TRACE(d);
        gp_material m = beads();
        m.grain_diameter = d;
        peak.push_back(deposit(m).peak_height);
        printf("d %g peak %g\n", d, peak.back());
    }
    for (std::size_t k = 1; k < peak.size(); ++k)
        EXPECT_GT(peak[k], 0.98 * peak[k - 1]); // more friction, a higher heap
    const double weak = deposit_of_friction(std::tan(degrees(21))).peak_height,
                 strong = deposit_of_friction(std::tan(degrees(32))).peak_height;
    printf("weak %g strong %g\n", weak, strong);
    EXPECT_NEAR(peak.front(), weak, 0.02 * weak);
    EXPECT_NEAR(peak.back(), strong, 0.02 * strong);
    EXPECT_GT(strong, 1.05 * weak);
}

TEST(RateConstant, GoesFromOneLimitOfTheLawToTheOther) {
    gp_material m = beads();
    m.i0 = 1e9;
    const double weak = deposit(m).peak_height;
    EXPECT_NEAR(weak, deposit_of_friction(m.mu_s).peak_height, 1e-6 * weak);
    m.i0 = 1e-9;
    const double strong = deposit(m).peak_height;
    EXPECT_NEAR(strong, deposit_of_friction(m.mu_2).peak_height, 0.01 * strong);
    printf("weak %g strong %g\n", weak, strong);
}

TEST(VolumeFraction, MayBeOneOrNearlyNothing) {
    gp_material m = beads();
    const double peak = deposit(m).peak_height;
    for (const double share : {1e-6, 1.}) {
        m.volume_fraction = share;
        printf("phi %g peak %g (%g)\n", share, deposit(m).peak_height, peak);
    }
}

// Dam break: the front approaches 2 sqrt(g H) from below, and nothing comes to rest.
TEST(NoFriction, IsADamBreak) {
    const double h = 0.08, dl = h / 16;
    Sim sim(config(dl));
    sim.column(0, 0, 2 * h, h, sim.material(0, 0));
    sim.add(floor_at(0, -0.1, 2, GP_WALL_FREE_SLIP));
    sim.add(plate(0, 0, 0, 2 * h, GP_WALL_FREE_SLIP));
    const double unit = 2 * std::sqrt(9.81 * h), time = std::sqrt(h / 9.81);
    const double energy = Collapse::density * 9.81 * 2 * h * h * h / 2;
    double front = 2 * h;
    for (int k = 1; k <= 6; ++k) {
        sim.run(k * time / 2);
        const std::vector<double> x = sim.field(GP_FIELD_X);
        const double now = *std::max_element(x.begin(), x.end());
        const gp_state s = sim.state();
        printf("t %g front speed %g of 2 sqrt(gH), E %g\n", k * .5, (now - front) / (time / 2) / unit,
               (s.kinetic + s.potential + s.elastic) / energy);
        front = now;
    }
}

TEST(MuchFriction, LetsAColumnStand) {
    for (int diff : {0, 1}) {
        gp_config c = config(0.005);
        if (!diff)
            c.density_diffusion = 0;
        Sim sim(c);
        sim.column(-0.04, 0, 0.08, 0.05, sim.material(1.5, 1.5));
        sim.add(floor_at(0, -0.4, 0.4));
        sim.run(0.5);
        const gp_state s = sim.state();
        printf("peak/H %g width %g ke %g\n", s.peak_height / 0.05, (s.x_right - s.x_left) / 0.08,
               s.kinetic / Collapse::energy);
    }
}
