// Peak, surface and marks of the mass, of exact shapes made of particles.
#include <algorithm>
#include <functional>
#include <random>

#include "api_support.hpp"

using namespace api;

namespace {

constexpr double height = 13 * spacing; // of a deposit at L / dl = 32
const double slope = std::tan(21 * std::acos(-1.0) / 180);

double wedge(double x) {
    return height - slope * std::abs(x);
}
double layer(double) {
    return height;
}
double half_disc(double x) {
    return std::sqrt(std::max(0.0, height * height - x * x));
}

// Particles below top(x) on a floor, in columns a spacing apart with the first at `first`, each from its top down; displaced
// by up to `jitter` spacings.
struct Shape {
    std::function<double(double)> top;
    double jitter = 0;
    bool wall = false; // at x = 0, the shape on its right
};

void put(Sim &sim, const Shape &shape, double first, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> shift(-shape.jitter * spacing, shape.jitter * spacing);
    std::vector<double> x, y;
    for (int column = shape.wall ? 0 : -40; column < 40; ++column) {
        const double at = (column + first) * spacing;
        for (double place = shape.top(at) - 0.5 * spacing; place > 0; place -= spacing) {
            x.push_back(at + shift(random));
            y.push_back(std::max(place + shift(random), 0.05 * spacing));
            if (shape.wall)
                x.back() = std::max(x.back(), 0.05 * spacing);
        }
    }
    sim.add(x, y);
    sim.add(make_floor());
    if (shape.wall)
        sim.add(make_left_wall(0, 1));
}

// Mean error of the peak over places of the columns, in spacings.
double peak_error(const Shape &shape) {
    constexpr int places = 16;
    double sum = 0;
    for (int k = 0; k < places; ++k) {
        Sim sim;
        put(sim, shape, shape.wall ? 0.5 : (k + 0.5) / places, static_cast<unsigned>(k + 1));
        sum += (sim.state().peak_height - height) / spacing;
    }
    return sum / places;
}

} // namespace

// Of 13 spacings .13 are 1 %. What is left comes of the columns' places: a top between two has no particle.
TEST(Peak, IsRightOfACuspAPlateauAndADome) {
    EXPECT_NEAR(peak_error({wedge}), 0, 0.05); // smoothed over two spacings -.18
    EXPECT_NEAR(peak_error({layer}), 0, 0.05);
    EXPECT_NEAR(peak_error({half_disc}), 0, 0.07); // .6 dl / 13 by its curvature
}

// Of a disordered layer the highest point is above the mean surface.
TEST(Peak, IsRightOfDisorderedParticles) {
    EXPECT_NEAR(peak_error({wedge, 0.2}), 0, 0.1);
    EXPECT_NEAR(peak_error({half_disc, 0.2}), 0.05, 0.1);
    const double plateau = peak_error({layer, 0.2});
    EXPECT_GT(plateau, 0);
    EXPECT_LT(plateau, 0.2);
}

TEST(Peak, IsRightAgainstAWall) {
    EXPECT_NEAR(peak_error({wedge, 0, true}), 0, 0.13);
    EXPECT_NEAR(peak_error({layer, 0, true}), 0, 0.05);
    EXPECT_NEAR(peak_error({half_disc, 0, true}), 0, 0.07);
}

TEST(Peak, IsRightOfALayerOfAnyThickness) {
    for (int rows = 1; rows <= 8; ++rows) {
        Sim sim;
        sim.add(make_floor());
        sim.add(make_column(30, rows));
        EXPECT_NEAR(sim.state().peak_height / spacing, rows, 0.1) << rows;
    }
}

TEST(Surface, DoesNotFallBesideAWall) {
    for (const bool disordered : {false, true}) {
        Sim sim;
        put(sim, {layer, disordered ? 0.2 : 0.0, true}, 0.5, 1);
        std::vector<double> x, found(9);
        for (int k = 0; k <= 8; ++k)
            x.push_back(0.25 * k * spacing);
        ASSERT_EQ(gp_get_surface(sim, 9, x.data(), found.data()), GP_OK);
        for (std::size_t k = 0; k < x.size(); ++k)
            EXPECT_NEAR(found[k] / spacing, height / spacing, disordered ? 0.35 : 0.1) << x[k] / spacing;
    }
}

// A slope that falls towards the wall and one that falls from it: off by what the smoothing makes of the cusp.
TEST(Surface, KeepsASlopeBesideAWall) {
    for (const double rise : {-slope, slope}) {
        Sim sim;
        const auto line = [&](double x) { return 0.5 * height + rise * x; };
        put(sim, {[&](double x) { return x < 20 * spacing ? line(x) : 0.0; }, 0, true}, 0.5, 1);
        for (int k = 0; k <= 16; ++k) {
            const double x = 0.25 * k * spacing;
            double found = 0;
            ASSERT_EQ(gp_get_surface(sim, 1, &x, &found), GP_OK);
            EXPECT_NEAR(found / spacing, line(x) / spacing, k < 4 ? 0.3 : 0.1) << x / spacing << " " << rise;
        }
    }
}

// A gate between two heights: each side has its own, up to the gate.
TEST(Surface, OfOneSideOfAGateDoesNotSeeTheOther) {
    Sim sim;
    sim.add(make_floor());
    sim.add(make_column(20, 12));
    sim.add(make_column(20, 4, 0.21, 0));
    sim.add(make_plate(0.2, 0.5, 0.2, 0));
    sim.add(make_plate(0.21, 0, 0.21, 0.5));
    const std::vector<double> x = {0.185, 0.195, 0.198, 0.212, 0.215, 0.225};
    std::vector<double> found(x.size());
    ASSERT_EQ(gp_get_surface(sim, static_cast<int64_t>(x.size()), x.data(), found.data()), GP_OK);
    for (std::size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(found[k] / spacing, 12, 0.15) << x[k];
    // The lower one is not of the connected deposit unless the gap between them links it.
    for (std::size_t k = 3; k < x.size(); ++k)
        EXPECT_TRUE(found[k] == 0 || std::abs(found[k] / spacing - 4) < 0.15) << x[k] << " " << found[k];
}

// ------------------------------------------------------------------------------------------------------- mass

TEST(Mass, MarksOfAColumnAreItsShares) {
    Sim sim;
    sim.add(make_column(7, 5, 0.3, 0.1));
    const gp_state s = sim.state();
    const double left = 0.3, width = 7 * spacing;
    const double marks[] = {s.x_q01, s.x_q05, s.x_q25, s.x_q50, s.x_q75, s.x_q95, s.x_q99};
    const double shares[] = {0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99};
    for (int k = 0; k < 7; ++k)
        EXPECT_NEAR(marks[k], left + shares[k] * width, 1e-9 * width) << shares[k];
    EXPECT_NEAR(s.centre_x, left + 0.5 * width, 1e-12);
    EXPECT_NEAR(s.centre_y, 0.1 + 2.5 * spacing, 1e-12);
    EXPECT_EQ(s.detached, 0);
}

TEST(Mass, CountsByMassAndWithWhatIsDetached) {
    Sim sim;
    gp_material heavy = make_material();
    heavy.grain_density *= 3;
    gp_column column = make_column(10, 10, 2, 0); // 3/4 of the mass, a metre away
    column.material = sim.add(heavy);
    sim.add(make_column(10, 10));
    sim.add(column);
    sim.add({1.0}, {5.0});
    const gp_state s = sim.state();
    const double all = 401, width = 10 * spacing;
    EXPECT_NEAR(s.x_q05, 0.05 * all / 100 * width, 1e-9);
    EXPECT_NEAR(s.x_q50, 2 + (0.5 * all - 101) / 300 * width, 1e-9);
    EXPECT_NEAR(s.centre_x, (100 * 0.5 * width + 1 + 300 * (2 + 0.5 * width)) / all, 1e-12);
    EXPECT_NEAR(s.detached, 301 / all, 1e-12)
        << "of two sets with as many particles the one with the smallest id counts";
}

TEST(Mass, AMarkInAGapIsItsMiddle) {
    Sim sim;
    sim.add(make_column(5, 4, 0, 0));
    sim.add(make_column(5, 4, 1, 0));
    EXPECT_NEAR(sim.state().x_q50, 0.5 * (5 * spacing + 1), 1e-6 * spacing);
}

TEST(Mass, InAPeriodWhatReachesBeyondAnEndCountsAtTheOther) {
    gp_config config = make_config();
    config.periodic_x_min = -0.1;
    config.periodic_x_max = 0.3;
    for (const double first : {0.0, 0.25, 0.5, 0.9}) {
        Sim sim(config);
        std::vector<double> x, y;
        for (int i = 0; i < 40; ++i)
            for (int j = 0; j < 6; ++j) {
                x.push_back(-0.1 + (i + first) * spacing);
                y.push_back((j + 0.5) * spacing);
            }
        sim.add(x, y);
        const gp_state s = sim.state();
        EXPECT_NEAR(s.x_q01, -0.1 + 0.01 * 0.4, 1e-9) << first;
        EXPECT_NEAR(s.x_q50, 0.1, 1e-9) << first;
        EXPECT_NEAR(s.x_q99, 0.3 - 0.01 * 0.4, 1e-9) << first;
    }
}

TEST(Mass, OfNothingIsZero) {
    Sim sim;
    const gp_state s = sim.state();
    for (const double value : {s.x_q01, s.x_q50, s.x_q99, s.centre_x, s.centre_y, s.detached, s.volume_drift})
        EXPECT_EQ(value, 0);
}

TEST(Mass, MarksAndSharesAreInOrderInARun) {
    Sim sim;
    add_collapse(sim);
    for (int k = 1; k <= 4; ++k) {
        ASSERT_EQ(gp_run(sim, 0.1 * k), GP_OK);
        const gp_state s = sim.state();
        const std::vector<double> marks = {s.x_q01, s.x_q05, s.x_q25, s.x_q50, s.x_q75, s.x_q95, s.x_q99};
        EXPECT_TRUE(std::is_sorted(marks.begin(), marks.end()));
        std::vector<double> x = sim.field(GP_FIELD_X), y = sim.field(GP_FIELD_Y);
        double mean_x = 0, mean_y = 0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            mean_x += x[i] / static_cast<double>(x.size());
            mean_y += y[i] / static_cast<double>(x.size());
        }
        std::sort(x.begin(), x.end());
        EXPECT_NEAR(s.x_q50, x[x.size() / 2], spacing);
        EXPECT_NEAR(s.centre_x, mean_x, 1e-12);
        EXPECT_NEAR(s.centre_y, mean_y, 1e-12);
    }
}
