// What flows keeps its volume: the density is tied to the spacing of the particles, and so is what bears the weight. Without
// the tie disordered layers sink for ever while their density reads that of the start.
#include <algorithm>
#include <array>
#include <cstdio>
#include <numeric>

#include "../support/ensemble.hpp"
#include "../support/layer.hpp"

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

double bagnold(double slope, double y) {
    return Law().bagnold(slope, thickness, y);
}

} // namespace

// At 20 s, after a strain of some 600, the height was .57 of that of the start without jitter, less with. 1 % and 2 % are what
// is asked for at 10 and 20 spacings; from 8 s on the start-up lacks .3 % of the steady velocity. The velocity of one run in its
// mean over 8 s scatters by 1.5 %: eight seeds have .984 +- .005 by one build, .989 +- .006 by another. So what is asked of three
// runs' mean is 2 % and two of its standard errors.
TEST(Volume, OfAnInclinedLayerIsKeptAndItFlowsAsBagnolds) {
    const double slope = 26;
    constexpr int runs = 3;
    constexpr double scatter = 0.015;
    double surface = 0;
    for (int k = 1; k <= runs; ++k) {
        ShakenLayer layer(10, slope, k);
        const ShakenLayer::Means m = layer.run(16, [&](double y) { return bagnold(slope, y); });
        std::printf("  height %.4f, surface velocity over Bagnold's %.4f\n", m.height, m.surface);
        EXPECT_NEAR(m.height, 1, 0.01);
        surface += m.surface / runs;
        const gp_state s = layer.sim.state();
        EXPECT_LT(s.spacing_dissipated, 0); // it compresses: by what the sinking layer gives
        EXPECT_GT(s.spacing_dissipated, -0.01 * s.dissipated);
    }
    EXPECT_NEAR(surface, 1, 0.02 + 2 * scatter / std::sqrt(runs));
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
    layer.sim.run(6); // what the lattice shaken at rest had more volume than a sheared one is gone: .004 of the height
    const double early = layer.sim.load(id).dy / thickness;
    layer.sim.run(8); // a strain of 200
    const double late = layer.sim.load(id).dy / thickness;
    std::printf("  lid at %.4f, then %.4f of the thickness\n", 1 + early, 1 + late);
    EXPECT_GT(late, -0.005);
    EXPECT_LT(late, 0.01);
    EXPECT_NEAR(late, early, 0.001); // and stays there: .0003 in a strain of 125 at most, over three seeds
}

// The tie is part of the density by continuity, not of its diffusion: without either a layer sank to .66 in 12 s. Without
// diffusion each density is its own, two thirds of the particles bear nothing, and as the tie raises densities and lowers none,
// the layer stands higher: by .04 to .08 over three seeds.
TEST(Volume, IsKeptWithoutDensityDiffusion) {
    const double slope = 26;
    ShakenLayer layer(8, slope, 1, 0);
    const ShakenLayer::Means m = layer.run(8, [&](double y) { return bagnold(slope, y); });
    std::printf("  height %.4f, at most %.4f\n", m.height, m.highest);
    EXPECT_GT(m.height, 0.99);
    EXPECT_LT(m.highest, 1.1);
    EXPECT_EQ(layer.sim.state().diffusion_dissipated, 0);
}

// The implicit scheme integrates the same density: it was .83 in 5 s, and falling.
TEST(Volume, OfTheImplicitSchemesLayerIsKept) {
    const double slope = 26;
    constexpr int runs = 3; // heights of runs scatter by .004 about .993
    double height = 0;
    for (int k = 1; k <= runs; ++k) {
        ShakenLayer layer(6, slope, k, -1, GP_STRESS_IMPLICIT);
        const ShakenLayer::Means m = layer.run(4, [&](double y) { return bagnold(slope, y); });
        std::printf("  height %.4f\n", m.height);
        height += m.height / runs;
    }
    EXPECT_NEAR(height, 1, 0.01);
}

namespace {

// Pairs of the scene that are closer than `distance` spacings, counted where one of them bears nothing.
int loose_pairs(Sim &sim, double spacing, double distance) {
    const std::vector<double> x = sim.field(GP_FIELD_X), y = sim.field(GP_FIELD_Y), p = sim.field(GP_FIELD_PRESSURE);
    int pairs = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if ((p[i] == 0 || p[j] == 0) && std::hypot(x[i] - x[j], y[i] - y[j]) < distance * spacing)
                ++pairs;
    return pairs;
}

} // namespace

// Grains without stress went through each other in falling faces and fronts: 7 to 17 pairs of which one bore nothing were
// closer than .6 dl from .2 s on, and stayed so.
TEST(Volume, OfFragmentsAndFrontsIsTheirOwn) {
    int pairs = 0;
    for (int k = 0; k < 3; ++k) {
        Sim sim(shaken(config(Collapse::length / 32), k));
        sim.column(-Collapse::length / 2, 0, Collapse::length, Collapse::height);
        sim.add(floor_at(0, -0.4, 0.4));
        for (const double time : {0.2, 0.3, 0.4}) {
            sim.run(time);
            pairs += loose_pairs(sim, Collapse::length / 32, 0.6);
        }
    }
    std::printf("  %d loose pairs closer than .6 dl, of 9 states\n", pairs);
    EXPECT_LE(pairs, 9); // one at a time may be on its way through a collision
}

// The tie changes densities alone: forces stay pairwise. A free shaken body, sheared and pressed together, keeps its momentum.
TEST(Volume, IsKeptWithoutMomentum) {
    gp_config c = config(0.005);
    c.gravity_y = 0;
    c.sound_speed = 10;
    c.jitter = 0.2;
    Sim sim(c);
    // Two halves that slide along each other and meet.
    sim.column(0, 0, 0.1, 0.05, 0, 1, 0.2);
    sim.column(0, 0.05, 0.1, 0.05, 0, -0.5, -0.3);
    const auto momentum = [&] {
        const std::vector<double> u = sim.field(GP_FIELD_VX), v = sim.field(GP_FIELD_VY);
        return std::array<double, 2>{std::accumulate(u.begin(), u.end(), 0.0),
                                     std::accumulate(v.begin(), v.end(), 0.0)};
    };
    const auto before = momentum();
    sim.run(0.1);
    const auto after = momentum();
    EXPECT_LT(sim.state().spacing_dissipated, 0); // it acted
    const double scale = 400;                     // particles, at 1 m/s
    EXPECT_NEAR(after[0], before[0], 1e-12 * scale);
    EXPECT_NEAR(after[1], before[1], 1e-12 * scale);
}

TEST(Volume, IsKeptWithTheSameBitsByAnyNumberOfThreads) {
    std::vector<double> one;
    for (const int threads : {1, 2, 3, 4}) {
        ShakenLayer layer(100, 26, 1, 0, GP_STRESS_ELASTIC, 9.81, threads); // 1200 particles: several blocks
        layer.sim.step(150);
        EXPECT_NE(layer.sim.state().spacing_dissipated, 0);
        std::vector<double> all = layer.sim.field(GP_FIELD_DENSITY);
        for (const uint32_t field : {GP_FIELD_X, GP_FIELD_Y, GP_FIELD_VX, GP_FIELD_VY}) {
            const std::vector<double> more = layer.sim.field(field);
            all.insert(all.end(), more.begin(), more.end());
        }
        all.push_back(layer.sim.state().spacing_dissipated);
        if (threads == 1)
            one = all;
        else
            EXPECT_EQ(all, one) << threads << " threads";
    }
}

// At rest nothing flows and the tie does nothing: half of these particles are closer than on the lattice.
TEST(Volume, IsLeftAloneAtRest) {
    gp_config c = config(0.005);
    c.jitter = 0.05;
    Sim sim(c);
    sim.column(-0.04, 0, 0.08, 0.05);
    for (const gp_plate &p : {floor_at(0, -0.04, 0.04), plate(-0.04, 0, -0.04, 0.1), plate(0.04, 0.1, 0.04, 0)})
        sim.add(p);
    sim.run(2);
    const double early = sim.state().spacing_dissipated;
    const std::vector<double> x = sim.field(GP_FIELD_X), y = sim.field(GP_FIELD_Y);
    sim.run(4);
    EXPECT_EQ(sim.state().at_rest, 1);
    EXPECT_NEAR(sim.state().spacing_dissipated, early, 1e-9 * Collapse::energy);
    const std::vector<double> x1 = sim.field(GP_FIELD_X), y1 = sim.field(GP_FIELD_Y);
    for (std::size_t i = 0; i < x.size(); ++i)
        EXPECT_LT(std::hypot(x1[i] - x[i], y1[i] - y[i]), 1e-3 * c.spacing);
}
