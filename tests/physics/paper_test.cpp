// The schemes of Jin et al. (2021) on their first scene: a = 1.25, L/dl = 32.
#include <algorithm>
#include <string>

#include "../support/ensemble.hpp"
#include "../support/layer.hpp"
#include "../support/scene.hpp"

using namespace test;

namespace {

gp_config paper(int32_t preset, int resolution = 32, int threads = 1) {
    gp_config c;
    EXPECT_EQ(gp_config_init(&c, sizeof c, preset), GP_OK);
    c.spacing = Collapse::length / resolution;
    c.threads = threads;
    return c;
}

struct Scene {
    explicit Scene(const gp_config &c, int32_t friction = GP_WALL_NO_SLIP) : sim(c) {
        sim.column(-Collapse::length / 2, 0, Collapse::length, Collapse::height);
        floor = sim.add(floor_at(0, -0.4, 0.4, friction));
    }
    gp_state at(double time) {
        sim.run(time);
        return sim.state();
    }
    Sim sim;
    int32_t floor = -1;
};

} // namespace

TEST(Paper, PeakIsThePrintedOneWithThePrintedStress) {
    Scene scene(paper(GP_PRESET_PAPER));
    const gp_state state = scene.at(0.42);
    EXPECT_NEAR(state.peak_height / Collapse::length, 0.508, 0.05 * 0.508); // the paper's section 4.2
    EXPECT_NEAR((state.x_left + state.x_right) / (state.x_right - state.x_left), 0, 0.05);

    // The ledger: the predictor's velocity overstates what friction dissipates, so more is accounted for than there was.
    EXPECT_LT(state.energy_error, 0);
    EXPECT_GT(state.energy_error, -0.12 * Collapse::energy);
    EXPECT_GT(state.dissipated, 0.3 * Collapse::energy);
    EXPECT_EQ(state.penalty_dissipated, 0);
    EXPECT_EQ(state.bulk_dissipated, 0);

    // The forces keep momentum: over many steps the floor bears the weight, though in single ones up to 1.3 of it.
    double load = 0;
    const int steps = 400;
    for (int k = 0; k < steps; ++k) {
        scene.sim.step();
        load -= scene.sim.load(scene.floor).fy;
    }
    const double weight = Collapse::density * Collapse::gravity * Collapse::length * Collapse::height;
    EXPECT_NEAR(load / steps, weight, 0.03 * weight);

    // It creeps, and says so.
    EXPECT_EQ(scene.sim.state().at_rest, 0);

    // Fields are those of the law: tau = eta D, |tau| <= 2 mu_2 p, N = N0 rho / rho0.
    const std::vector<double> p = scene.sim.field(GP_FIELD_PRESSURE), eta = scene.sim.field(GP_FIELD_VISCOSITY),
                              rate = scene.sim.field(GP_FIELD_SHEAR_RATE), sxx = scene.sim.field(GP_FIELD_SXX),
                              sxy = scene.sim.field(GP_FIELD_SXY), syy = scene.sim.field(GP_FIELD_SYY),
                              number = scene.sim.field(GP_FIELD_NUMBER_DENSITY),
                              density = scene.sim.field(GP_FIELD_DENSITY),
                              inertial = scene.sim.field(GP_FIELD_INERTIAL_NUMBER);
    for (std::size_t i = 0; i < p.size(); ++i) {
        const double tau = std::sqrt(0.5 * (sxx[i] * sxx[i] + syy[i] * syy[i]) + sxy[i] * sxy[i]);
        ASSERT_NEAR(tau, eta[i] * rate[i], 1e-9 * (1 + tau));
        ASSERT_LE(tau, 2 * std::tan(degrees(32)) * p[i] * (1 + 1e-12));
        ASSERT_NEAR(number[i], 4.198295818402637 * density[i] / Collapse::density, 1e-9);
        if (p[i] > 0) {
            ASSERT_NEAR(inertial[i], 2 * 0.002 * rate[i] / std::sqrt(p[i] / 2500), 1e-9 * (1 + inertial[i]));
        }
    }
}

TEST(Paper, LocalModelIsFlatterThanTheForceStates) {
    gp_config config = paper(GP_PRESET_PAPER);
    config.friction_factor = 1; // as the local model
    const gp_state nonlocal = Scene(config).at(0.42), local = Scene(paper(GP_PRESET_PAPER_LOCAL)).at(0.42);
    EXPECT_NEAR(nonlocal.peak_height / Collapse::length, 0.376, 0.05 * 0.376); // an independent implementation's
    EXPECT_LT(local.peak_height, 0.98 * nonlocal.peak_height);
    for (const gp_state &state : {nonlocal, local}) {
        EXPECT_TRUE(std::isfinite(state.energy_error));
        EXPECT_LT(std::abs(state.energy_error), 0.1 * Collapse::energy);
    }
}

// In single runs of L/dl = 32 1.5 to 3 times as fast (2.24 +- .42 in three): a bound on one says nothing. At 24 it is less and
// scatters less, 2.04 +- .13 in six; at 16, 1.58 +- .26, a run may be slower.
TEST(Paper, LocalModelIsFasterOnAverage) {
    Sample ratio;
    for (int k = 0; k < 4; ++k) {
        gp_config config = paper(GP_PRESET_PAPER, 24);
        config.friction_factor = 1;
        const double nonlocal = Scene(shaken(config, k)).at(0.42).rms_speed;
        ratio.add(Scene(shaken(paper(GP_PRESET_PAPER_LOCAL, 24), k)).at(0.42).rms_speed / nonlocal);
    }
    expect_mean_above("speed of the local model over the non-local one's", ratio, 1);
}

TEST(Paper, IsTheSameForAnyNumberOfThreads) {
    for (const int32_t preset : {GP_PRESET_PAPER, GP_PRESET_PAPER_LOCAL}) {
        std::vector<double> first;
        for (const int threads : {1, 2, 4}) {
            Scene scene(paper(preset, 24, threads));
            scene.sim.step(400);
            std::vector<double> all;
            for (const uint32_t bit : {GP_FIELD_X, GP_FIELD_Y, GP_FIELD_VX, GP_FIELD_VY, GP_FIELD_PRESSURE,
                                       GP_FIELD_SXX, GP_FIELD_SYY, GP_FIELD_SXY})
                for (const double value : scene.sim.field(bit))
                    all.push_back(value);
            if (first.empty())
                first = all;
            EXPECT_EQ(all, first) << threads << " threads";
        }
    }
}

TEST(Paper, PlanNamesWhatIsLeftOut) {
    Scene nonlocal(paper(GP_PRESET_PAPER, 8)), local(paper(GP_PRESET_PAPER_LOCAL, 8)), own(config(0.01));
    const Sim &n = nonlocal.sim, &l = local.sim, &o = own.sim;
    for (const char *stage : {"density", "gradient", "stress", "wall_stress", "integrate"}) {
        EXPECT_EQ(n.entry(stage).active, 0) << stage;
        EXPECT_NE(std::string(n.entry(stage).reason).find("default scheme"), std::string::npos) << stage;
        EXPECT_EQ(l.entry(stage).active, 0) << stage;
        EXPECT_EQ(o.entry(stage).active, 1) << stage;
    }
    for (const char *stage : {"predict", "number_density", "mps_gradient", "viscous_stress", "correct"}) {
        EXPECT_EQ(n.entry(stage).active, 1) << stage;
        EXPECT_EQ(l.entry(stage).active, 1) << stage;
        EXPECT_EQ(o.entry(stage).active, 0) << stage;
        EXPECT_NE(std::string(o.entry(stage).reason).find("paper"), std::string::npos) << stage;
    }
    EXPECT_EQ(n.entry("force").active, 1);
    EXPECT_EQ(l.entry("force").active, 0);
    EXPECT_EQ(l.entry("pressure_gradient").active, 1);
    EXPECT_EQ(n.entry("pressure_gradient").active, 0);
    EXPECT_EQ(n.entry("flowing", 1).bytes, 0);
    EXPECT_EQ(n.entry("stressed", 1).bytes, 0);
    EXPECT_EQ(l.entry("inverse_shape_tensor", 1).bytes, 0);
    EXPECT_EQ(o.entry("viscous_stress_yy", 1).bytes, 0);
    EXPECT_GT(n.entry("viscous_stress_yy", 1).bytes, 0);
}

// Nothing leaves a box through its plates, whatever they are made of.
TEST(Paper, NothingPassesAPlate) {
    for (const int32_t preset : {GP_PRESET_PAPER, GP_PRESET_PAPER_LOCAL})
        for (const int32_t friction : {GP_WALL_NO_SLIP, GP_WALL_FREE_SLIP, GP_WALL_COULOMB}) {
            Sim sim(paper(preset, 16));
            sim.column(0, 0, 0.04, 0.04);
            gp_plate plates[] = {floor_at(0, 0, 0.08, friction), plate(0, 0, 0, 0.2, friction),
                                 plate(0.08, 0.2, 0.08, 0, friction)};
            for (gp_plate &each : plates) {
                each.wall_mu = friction == GP_WALL_COULOMB ? 0.3 : 0;
                sim.add(each);
            }
            sim.run(0.3);
            for (const double x : sim.field(GP_FIELD_X)) {
                ASSERT_GT(x, 0);
                ASSERT_LT(x, 0.08);
            }
            for (const double y : sim.field(GP_FIELD_Y))
                ASSERT_GT(y, 0);
        }
}

// Along a plate that is rougher than the material, friction is mu(I) of the mean shear rate between particle and plate: a layer in
// simple shear has it in full. (By a rate made for the gradient that these schemes do not take it was 3 % too high with the force
// states; the load in the local model had half of the material's own shear beside it, 46 %, on smooth plates, too.)
TEST(Paper, FrictionOfARoughPlateIsOfTheMeanRate) {
    for (const int32_t preset : {GP_PRESET_PAPER, GP_PRESET_PAPER_LOCAL}) {
        SCOPED_TRACE(preset);
        constexpr int columns = 24, rows = 8;
        gp_config c = paper(preset);
        c.friction_factor = 1;
        c.periodic_x_max = columns * c.spacing;
        Sim sim(c);
        const Law beads;
        const double grain_density = 2500;        // kg/m3
        const double shear = 100, dl = c.spacing; // 1/s; I about its I0
        std::vector<double> x, y, u, v;
        for (int k = 0; k < columns * rows; ++k) {
            x.push_back((k % columns + 0.5) * dl);
            y.push_back((k / columns + 0.5) * dl);
            u.push_back(shear * y.back());
            v.push_back(0);
        }
        ASSERT_EQ(gp_add_particles(sim, 0, columns * rows, x.data(), y.data(), u.data(), v.data(), nullptr), GP_OK);
        gp_plate rough = floor_at(0, 0, c.periodic_x_max, GP_WALL_COULOMB);
        rough.wall_mu = 2;
        const int32_t floor = sim.add(rough);
        sim.step(20);
        double along = 0, onto = 0, law = 0;
        for (int k = 0; k < 100; ++k) {
            const std::vector<double> height = sim.field(GP_FIELD_Y), speed = sim.field(GP_FIELD_VX),
                                      p = sim.field(GP_FIELD_PRESSURE);
            double ratio = 0, pressing = 0;
            for (std::size_t i = 0; i < p.size(); ++i)
                if (height[i] < dl && p[i] > 0) {
                    const double rate = speed[i] / height[i],
                                 inertial = beads.d * rate / std::sqrt(p[i] / grain_density);
                    ratio += p[i] * beads.mu(inertial);
                    pressing += p[i];
                }
            sim.step();
            const gp_load load = sim.load(floor);
            along += load.fx;
            onto -= load.fy;
            law += -load.fy * ratio / pressing;
        }
        EXPECT_NEAR(along / onto, law / onto, 0.01 * law / onto);
    }
}

TEST(Presets, TakeHorizonAndFrictionFactorAlike) {
    for (const int32_t preset : {GP_PRESET_DEFAULT, GP_PRESET_PAPER, GP_PRESET_PAPER_LOCAL}) {
        SCOPED_TRACE(preset);
        const auto speeds = [&](auto set) {
            gp_config c = paper(preset, 16);
            set(c);
            Scene scene(c);
            scene.sim.run(0.1);
            return scene.sim.field(GP_FIELD_VX);
        };
        const std::vector<double> own = speeds([](gp_config &) {});
        // A fixed length is the same horizon in other words; the spacing is 2^-n x 0.08, so that the product is exact.
        const std::vector<double> three = speeds([](gp_config &c) { c.horizon = 3; }),
                                  length = speeds([](gp_config &c) { c.horizon_length = 3 * c.spacing; });
        EXPECT_EQ(three, length);
        if (preset != GP_PRESET_PAPER_LOCAL) { // whose operators go by the interaction radius
            EXPECT_NE(three, own);
        }
        // More friction, less speed.
        const auto fastest = [](const std::vector<double> &u) { return *std::max_element(u.begin(), u.end()); };
        const double one = fastest(speeds([](gp_config &c) { c.friction_factor = 1; })),
                     two = fastest(speeds([](gp_config &c) { c.friction_factor = 2; }));
        EXPECT_LT(two, 0.95 * one);
    }
}

TEST(Presets, RunInPeriodsAndChannels) {
    for (const int32_t preset : {GP_PRESET_PAPER, GP_PRESET_PAPER_LOCAL}) {
        SCOPED_TRACE(preset);
        // The same layer begun across the ends of the period is the same motion, friction of side walls included.
        double kinetic[2] = {0, 0};
        for (int k = 0; k < 2; ++k) {
            gp_config c = paper(preset, 32);
            c.periodic_x_max = 0.08;
            c.channel_width = 0.05;
            c.channel_friction = 0.3;
            Sim sim(c);
            sim.column(k == 0 ? 0.03 : 0.05, 0, 0.03, 0.03);
            sim.add(plate(0.08, 0, 0, 0));
            sim.run(0.02); // in the second case the front crosses an end; later their chatter makes rounding visible
            kinetic[k] = sim.state().kinetic;
            EXPECT_GT(sim.state().channel_dissipated, 0);
        }
        EXPECT_NEAR(kinetic[1], kinetic[0], 1e-6 * kinetic[0]);
    }
}
