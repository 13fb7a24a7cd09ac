// What flows keeps its volume: the density is tied to the spacing of the particles, and so is what bears the weight. Without
// the tie disordered layers sink for ever while their density reads that of the start.
#include <algorithm>
#include <numeric>

#include "../support/ensemble.hpp"

using namespace test;

namespace {

constexpr double thickness = 0.04; // m, of every layer here: 20 grains

// A layer that is periodic in x, its lattice shaken by a fifth of a spacing: as disordered as one that has flown for long.
struct ShakenLayer {
    static constexpr int across = 12;
    ShakenLayer(int rows, double slope, int k, double diffusion = -1, int32_t stress = GP_STRESS_ELASTIC,
                double gravity = 9.81, int threads = 1)
        : spacing(thickness / rows), width(across * spacing), sim([&] {
              gp_config c = config(thickness / rows);
              c.gravity_x = gravity * std::sin(degrees(slope));
              c.gravity_y = -gravity * std::cos(degrees(slope));
              c.periodic_x_max = across * c.spacing;
              c.jitter = 0.2;
              c.seed = seed_of(k);
              c.threads = threads;
              if (diffusion >= 0)
                  c.density_diffusion = diffusion;
              c.stress = stress;
              if (stress == GP_STRESS_IMPLICIT)
                  c.delta = 1e-2;
              if (gravity == 0) // nothing to choose it by
                  c.sound_speed = 20;
              return c;
          }()) {
        sim.column(0, 0, width, thickness);
        floor = sim.add(plate(width, 0, 0, 0));
        start = height();
    }
    double height() {
        const std::vector<double> y = sim.field(GP_FIELD_Y);
        return std::accumulate(y.begin(), y.end(), 0.0) / static_cast<double>(y.size());
    }

    // Means over the second half of a run.
    struct Means {
        double height = 0;  // over that of the start
        double surface = 0; // velocity of the uppermost particles over Bagnold's at their heights
        double highest = 0; // largest mean height over that of the start
    };
    template <class Profile> Means run(double time, const Profile &exact) {
        constexpr int samples = 40;
        Means m;
        for (int k = 1; k <= samples; ++k) {
            sim.run(time * 0.5 * (1 + double(k) / samples));
            const double h = height() / start;
            m.height += h / samples;
            m.highest = std::max(m.highest, h);
            const std::vector<double> y = sim.field(GP_FIELD_Y), u = sim.field(GP_FIELD_VX);
            std::vector<std::size_t> order(y.size());
            std::iota(order.begin(), order.end(), std::size_t(0));
            std::nth_element(order.begin(), order.begin() + across, order.end(),
                             [&](std::size_t a, std::size_t b) { return y[a] > y[b]; });
            double sum = 0, reference = 0;
            for (int i = 0; i < across; ++i) {
                sum += u[order[i]];
                reference += exact(y[order[i]]);
            }
            m.surface += sum / reference / samples;
        }
        return m;
    }
    double spacing, width, start = 0;
    Sim sim;
    int32_t floor = -1;
};

// u = 2/3 (I/d) sqrt(phi g cos) [h^1.5 - (h - y)^1.5], of glass beads of 2 mm.
double bagnold(double slope, double y) {
    const double mu = std::tan(degrees(slope)), mu_s = std::tan(degrees(21)), mu_2 = std::tan(degrees(32)), d = 0.002;
    const double inertial = 0.3 * (mu - mu_s) / (mu_2 - mu);
    return 2. / 3 * inertial / d * std::sqrt(0.62 * 9.81 * std::cos(degrees(slope))) *
           (std::pow(thickness, 1.5) - std::pow(std::max(0.0, thickness - y), 1.5));
}

} // namespace

// At 20 s, after a strain of some 600, the height was .57 of that of the start without jitter, less with. 1 % and 2 % are what
// is asked for at 10 and 20 spacings; from 8 s on the start-up lacks .3 % of the steady velocity, its mean over 8 s scatters
// by .3 %.
TEST(Volume, OfAnInclinedLayerIsKeptAndItFlowsAsBagnolds) {
    const double slope = 26;
    ShakenLayer layer(10, slope, 1);
    const ShakenLayer::Means m = layer.run(16, [&](double y) { return bagnold(slope, y); });
    std::printf("  height %.4f, surface velocity over Bagnold's %.4f\n", m.height, m.surface);
    EXPECT_NEAR(m.height, 1, 0.01);
    EXPECT_NEAR(m.surface, 1, 0.025);
    const gp_state s = layer.sim.state();
    EXPECT_LT(s.spacing_dissipated, 0); // it compresses: by what the sinking layer gives
    EXPECT_GT(s.spacing_dissipated, -0.01 * s.dissipated);
}

// Neither the free surface nor p >= 0 is needed to lose volume: under a lid a shaken layer lost .025 of it in a strain of 125,
// .045 in 250. A lattice that is disordered at the same density has some .002 more than N0, and is held by that.
TEST(Volume, OfALayerUnderALoadedLidIsKept) {
    const double load = 1000, speed = 1;
    ShakenLayer layer(8, 0, 1, -1, GP_STRESS_ELASTIC, 0);
    gp_plate lid = plate(0, thickness, layer.width, thickness);
    lid.vx = speed;
    lid.normal_pressure = load;
    const int32_t id = layer.sim.add(lid);
    layer.sim.run(2.5);
    const double early = layer.sim.load(id).dy / thickness;
    layer.sim.run(5); // a strain of 125
    const double late = layer.sim.load(id).dy / thickness;
    std::printf("  lid at %.4f, then %.4f of the thickness\n", 1 + early, 1 + late);
    EXPECT_GT(late, -0.005);
    EXPECT_LT(late, 0.01);
    EXPECT_NEAR(late, early, 0.002); // and stays there
}

// The tie is part of the density by continuity, not of its diffusion. Without diffusion each density is its own, and two thirds
// of the particles bear nothing: the layer stands higher by a few hundredths. It sank to .66 in 12 s.
TEST(Volume, IsKeptWithoutDensityDiffusion) {
    const double slope = 26;
    ShakenLayer layer(8, slope, 1, 0);
    const ShakenLayer::Means m = layer.run(8, [&](double y) { return bagnold(slope, y); });
    std::printf("  height %.4f, at most %.4f\n", m.height, m.highest);
    EXPECT_GT(m.height, 0.99);
    EXPECT_LT(m.highest, 1.08);
    EXPECT_EQ(layer.sim.state().diffusion_dissipated, 0);
}

// The implicit scheme integrates the same density: .83 in 5 s, and falling.
TEST(Volume, OfTheImplicitSchemesLayerIsKept) {
    const double slope = 26;
    ShakenLayer layer(6, slope, 1, -1, GP_STRESS_IMPLICIT);
    const ShakenLayer::Means m = layer.run(5, [&](double y) { return bagnold(slope, y); });
    std::printf("  height %.4f\n", m.height);
    EXPECT_NEAR(m.height, 1, 0.01);
}
