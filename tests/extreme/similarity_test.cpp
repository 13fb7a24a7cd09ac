// Scenes that are the same motion in other words: other densities, other gravity, turned, mirrored, moved far away, carried
// along, with another sound speed. Where the change is a power of two the numbers are the same bits. Elsewhere rounding
// differs, and a collapse multiplies it: early, positions agree to 1e-13 dl; in deposits a jitter of 1e-13 dl changes the
// peak by 1e-6 (L/dl = 16 and 32), one of 1e-10 dl by 1e-5, one of 1e-6 dl by 1e-4, one of 1e-3 dl by all that runs scatter
// by. So single runs tell whether a motion is the same but for rounding; one that is not is compared by ensembles.
#include "../support/ensemble.hpp"
#include "extreme_support.hpp"

#include <memory>
#include <random>

using namespace test;

namespace {

constexpr double length = Collapse::length, height = Collapse::height;
constexpr int resolution = 16;
constexpr double spacing = length / resolution;
constexpr double early = 0.05, late = 0.6; // s; the column falls fastest at .07 s, and is at rest from .42 s on

struct Motion {
    std::vector<double> x, y; // early
    gp_state deposit;         // late
    double spread = 0;        // m, late: mean distance from the mean
};

Motion watch(Sim &sim, double time_scale = 1) {
    Motion m;
    sim.run(early * time_scale);
    m.x = sim.field(GP_FIELD_X);
    m.y = sim.field(GP_FIELD_Y);
    sim.run(late * time_scale);
    m.deposit = sim.state();
    const std::vector<double> x = sim.field(GP_FIELD_X);
    const double middle = mean(x);
    for (const double value : x)
        m.spread += std::abs(value - middle) / static_cast<double>(x.size());
    expect_finite(sim);
    return m;
}

struct Change {
    double grain_density = 2500, gravity = 9.81, time_scale = 1, sound_speed = 0, offset = 0, drift = 0;
};

Motion collapse(const Change &change, gp_config c = config(spacing)) {
    c.gravity_y = -change.gravity;
    c.sound_speed = change.sound_speed;
    Sim sim(c);
    gp_material m;
    EXPECT_EQ(gp_material_init(&m, sizeof m), GP_OK);
    m.grain_density = change.grain_density;
    const int32_t beads = sim.add(m);
    sim.column(change.offset - length / 2, change.offset, length, height, beads, change.drift);
    gp_plate base = floor_at(change.offset, change.offset - 0.4, change.offset + 0.4);
    base.vx = change.drift;
    sim.add(base);
    return watch(sim, change.time_scale);
}

const Motion &reference() {
    static const Motion motion = collapse({});
    return motion;
}

// The mean of all grains tells more than the fronts, which at this resolution are a grain or two.
void expect_same_deposit(const Motion &a, const Motion &b, double tolerance) {
    EXPECT_NEAR(a.deposit.peak_height, b.deposit.peak_height, tolerance * b.deposit.peak_height);
    EXPECT_NEAR(a.spread, b.spread, tolerance * b.spread);
}

} // namespace

// I = 2 d |gamma| / sqrt(p / rho_s) with p ~ rho_s: the density of the grains drops out.
TEST(GrainDensity, DropsOutOfTheMotion) {
    for (const double density : {2500. / 4096, 2500. * 64}) {
        SCOPED_TRACE(density);
        const Motion motion = collapse({density});
        EXPECT_EQ(motion.x, reference().x);
        EXPECT_EQ(motion.y, reference().y);
        EXPECT_EQ(motion.deposit.x_right, reference().deposit.x_right);
    }
    for (const double density : {1., 1e5}) {
        SCOPED_TRACE(density);
        const Motion motion = collapse({density});
        EXPECT_LT(difference(motion.x, reference().x), 1e-9 * spacing);
        EXPECT_LT(difference(motion.y, reference().y), 1e-9 * spacing);
        expect_same_deposit(motion, reference(), 1e-4);
    }
}

// Times go with 1/sqrt(g), speeds and the sound speed with sqrt(g), pressures with g: I is the same.
TEST(Gravity, OnlySetsTheClock) {
    const Motion exact = collapse({2500, 1024 * 9.81, 1. / 32});
    EXPECT_EQ(exact.x, reference().x);
    EXPECT_EQ(exact.y, reference().y);
    EXPECT_EQ(exact.deposit.x_right, reference().deposit.x_right);
    const Motion thousand = collapse({2500, 1000 * 9.81, std::sqrt(1e-3)});
    EXPECT_LT(difference(thousand.x, reference().x), 1e-9 * spacing);
    expect_same_deposit(thousand, reference(), 1e-4);
}

// Three and ten times as stiff. The centre of mass lies higher by 1.6 +- .2 and 1.2 +- .6 %, the spread is smaller by 2.0 +- .3 and
// 2.6 +- .4 %.
TEST(SoundSpeed, DoesNotShapeTheDeposit) {
    struct Deposits {
        Sample height, spread;
    };
    const auto deposits = [](double factor, int runs) {
        Deposits found;
        for (int k = 0; k < runs; ++k) {
            Change change;
            change.sound_speed = factor * reference().deposit.sound_speed;
            const Motion m = collapse(change, shaken(config(spacing), k));
            found.height.add(m.deposit.centre_y);
            found.spread.add(m.spread);
        }
        return found;
    };
    const Deposits usual = deposits(1, 12), stiff = deposits(3, 6), stiffest = deposits(10, 4);
    expect_means_near("height", stiff.height, usual.height, 0.03 * usual.height.mean());
    expect_means_near("spread", stiff.spread, usual.spread, 0.03 * usual.spread.mean());
    expect_means_near("height", stiffest.height, usual.height, 0.05 * usual.height.mean());
    expect_means_near("spread", stiffest.spread, usual.spread, 0.05 * usual.spread.mean());
}

// A hundred times as stiff, L/dl = 8, on the way down. Means of 12 and 3 runs: the centre of mass is as high to .02 dl, and the front,
// a grain or two, is behind by .86 +- .05 of a spacing.
TEST(SoundSpeed, MayBeAHundredTimesTheUsual) {
    const double l = 0.08, h = 1.25 * l, dl = l / 8;
    double usual = 0;
    gp_state end[2];
    Sample height[2], front[2];
    for (const int stiff : {0, 1})
        for (int k = 0; k < (stiff ? 3 : 12); ++k) {
            gp_config c = shaken(config(dl), k);
            c.sound_speed = stiff ? 100 * usual : 0;
            Sim sim(c);
            sim.column(0, 0, l, h);
            sim.add(floor_at(0, -1, 1));
            sim.add(plate(0, -1, 0, 1));
            const gp_state start = sim.state();
            sim.run(0.1);
            end[stiff] = sim.state();
            EXPECT_LT(std::abs(end[stiff].energy_error), 0.02 * start.potential);
            expect_finite(sim);
            height[stiff].add(end[stiff].centre_y);
            front[stiff].add(end[stiff].x_right);
            usual = end[0].sound_speed;
        }
    EXPECT_GT(end[1].step, 50 * end[0].step);
    EXPECT_LT(end[1].max_compression, 1e-3 * end[0].max_compression + 1e-4);
    expect_means_near("height", height[1], height[0], 0.01 * h);
    expect_means_near("front", front[1], front[0], 1.2 * dl);
}

TEST(Origin, MayBeFarAway) {
    for (const double offset : {1e3, 1e6}) {
        SCOPED_TRACE(offset);
        Change change;
        change.offset = offset;
        Motion motion = collapse(change);
        for (double &x : motion.x)
            x -= offset;
        // Positions are good to 1.1e-16 of the offset: 2e-8 dl at 1e6 m. It is rounded anew at each of 145 steps.
        EXPECT_LT(difference(motion.x, reference().x), 145 * 1.2e-16 * offset);
        motion.deposit.peak_height -= offset;
        expect_same_deposit(motion, reference(), 0.005);
    }
}

TEST(Drift, OfTheWholeSceneChangesNothing) {
    EXPECT_EQ(reference().deposit.at_rest, 1);
    Change change;
    change.drift = 0.25;
    Motion motion = collapse(change);
    for (double &x : motion.x)
        x -= change.drift * early;
    EXPECT_LT(difference(motion.x, reference().x), 1e-9 * spacing);
    expect_same_deposit(motion, reference(), 1e-4);
}

namespace {

// The collapse of a set of particles beside a wall, turned by an angle about the origin and mirrored before.
struct Turned {
    Turned(double angle, bool mirrored, double jitter = 0, int run = 0) {
        // Exact for right angles.
        cosine = angle == 90 ? 0 : std::cos(degrees(angle));
        sine = angle == 180 ? 0 : std::sin(degrees(angle));
        sign = mirrored ? -1 : 1;
        gp_config c = config(spacing);
        c.gravity_x = x_of(0, -9.81);
        c.gravity_y = y_of(0, -9.81);
        sim = std::make_unique<Sim>(c);
        std::mt19937_64 random(seed_of(run));
        const auto shift = [&] { return jitter * (2 * static_cast<double>(random() >> 11) * 0x1p-53 - 1); };
        std::vector<double> x, y;
        for (int row = 0; row < 10; ++row)
            for (int column = 0; column < 8; ++column) {
                const double across = (column + 0.5 + shift()) * spacing, up = (row + 0.5 + shift()) * spacing;
                x.push_back(x_of(across, up));
                y.push_back(y_of(across, up));
            }
        EXPECT_EQ(
            gp_add_particles(*sim, 0, static_cast<int64_t>(x.size()), x.data(), y.data(), nullptr, nullptr, nullptr),
            GP_OK);
        add(0.4, 0, -0.1, 0, GP_WALL_NO_SLIP, mirrored);
        add(0, 0, 0, 0.2, GP_WALL_FREE_SLIP, mirrored);
    }
    // Turned back.
    Motion at(double time) {
        sim->run(time);
        Motion m;
        const std::vector<double> px = sim->field(GP_FIELD_X), py = sim->field(GP_FIELD_Y);
        for (std::size_t i = 0; i < px.size(); ++i) {
            m.x.push_back(sign * (cosine * px[i] + sine * py[i]));
            m.y.push_back(cosine * py[i] - sine * px[i]);
        }
        m.deposit = sim->state();
        m.deposit.peak_height = *std::max_element(m.y.begin(), m.y.end());
        m.spread = mean(m.x); // from the wall
        return m;
    }

private:
    double x_of(double x, double y) const { return cosine * sign * x - sine * y; }
    double y_of(double x, double y) const { return sine * sign * x + cosine * y; }
    void add(double x0, double y0, double x1, double y1, int32_t friction, bool mirrored) {
        if (mirrored) { // the body stays on the left
            std::swap(x0, x1);
            std::swap(y0, y1);
        }
        sim->add(plate(x_of(x0, y0), y_of(x0, y0), x_of(x1, y1), y_of(x1, y1), friction));
    }
    double cosine, sine, sign;
    std::unique_ptr<Sim> sim;
};

void expect_same(double angle, bool mirrored, double exact_until) {
    SCOPED_TRACE(angle);
    Turned upright(0, false), other(angle, mirrored);
    for (const double time : {exact_until, early}) {
        const Motion a = upright.at(time), b = other.at(time);
        const double tolerance = (time == exact_until ? 1e-9 : 0.01) * spacing;
        EXPECT_LT(difference(a.x, b.x), tolerance);
        EXPECT_LT(difference(a.y, b.y), tolerance);
    }
    if (exact_until == early)
        expect_same_deposit(other.at(late), upright.at(late), 1e-4);
}

} // namespace

TEST(Turned, ByARightAngleIsTheSame) {
    expect_same(90, false, early);
    expect_same(180, false, early);
}

// Lists are made anew after shifts that are bounded by the range of vx and that of vy: at other moments when the axes lie
// otherwise, and then which ghosts a particle sees through a corner changes at other moments, too (by .001 dl here): by
// more than rounding: most pairs of runs end alike to 1e-5, and single ones (those of the lattice) differ by 1 %. Hence the
// mean of pairs.
TEST(Turned, ByAnyAngleIsTheSame) {
    for (const double angle : {30., -77.}) {
        expect_same(angle, false, 0.01);
        Sample peak, spread;
        for (int k = 0; k < 16; ++k) {
            Turned upright(0, false, shake, k), other(angle, false, shake, k);
            const Motion a = upright.at(late), b = other.at(late);
            peak.add(b.deposit.peak_height / a.deposit.peak_height - 1);
            spread.add(b.spread / a.spread - 1);
        }
        SCOPED_TRACE(angle);
        expect_mean_near_zero("peak", peak, 0.01);
        expect_mean_near_zero("spread", spread, 0.01);
    }
}

// The plates are drawn from their other ends.
TEST(Mirrored, IsTheSame) {
    expect_same(0, true, early);
    expect_same(90, true, early);
}

// Columns begin with the pressure of any gravity along an axis.
TEST(Turned, ColumnIsTheSame) {
    gp_state deposit[2];
    for (const int turn : {0, 1}) {
        gp_config c = config(spacing);
        c.gravity_x = turn ? 9.81 : 0;
        c.gravity_y = turn ? 0 : -9.81;
        Sim sim(c);
        if (turn) { // by 90 degrees: gravity to the right
            sim.column(-height, -length / 2, height, length);
            sim.add(plate(0, 0.4, 0, -0.4));
        } else {
            sim.column(-length / 2, 0, length, height);
            sim.add(floor_at(0, -0.4, 0.4));
        }
        sim.run(early);
        deposit[turn] = sim.state();
    }
    EXPECT_NEAR(deposit[1].kinetic, deposit[0].kinetic, 1e-9 * deposit[0].kinetic);
    EXPECT_NEAR(deposit[1].elastic, deposit[0].elastic, 1e-9 * deposit[0].elastic);
    EXPECT_NEAR(deposit[1].momentum_x, -deposit[0].momentum_y, 1e-9 * -deposit[0].momentum_y);
}

// A column that falls on itself keeps its symmetry as long as rounding stays small.
TEST(Mirrored, HalvesOfAColumnMoveAlike) {
    Collapse collapse(resolution);
    collapse.sim.run(early);
    EXPECT_NEAR(collapse.sim.state().x_left, -collapse.sim.state().x_right, 1e-9 * spacing);
    collapse.sim.run(late);
    const double width = collapse.sim.state().x_right - collapse.sim.state().x_left;
    EXPECT_NEAR(collapse.sim.state().x_left, -collapse.sim.state().x_right, 1e-3 * width);
}

TEST(NoGravity, LeavesWhatRestsExactlyWhereItIs) {
    gp_config c = config(spacing);
    c.gravity_y = 0;
    c.sound_speed = 10;
    Sim sim(c);
    sim.column(-length / 2, 0, length, height);
    sim.add(floor_at(0, -0.4, 0.4));
    const std::vector<double> x = sim.field(GP_FIELD_X), y = sim.field(GP_FIELD_Y);
    sim.step(500);
    EXPECT_EQ(sim.field(GP_FIELD_X), x);
    EXPECT_EQ(sim.field(GP_FIELD_Y), y);
    EXPECT_EQ(sim.state().kinetic, 0);
    EXPECT_EQ(sim.state().max_pressure, 0);
}

TEST(NoGravity, KeepsAUniformVelocity) {
    gp_config c = config(spacing);
    c.gravity_y = 0;
    c.sound_speed = 10;
    c.jitter = 0.3;
    Sim sim(c);
    sim.column(-length / 2, 0, length, height, 0, 3, -4);
    sim.step(500);
    for (const double vx : sim.field(GP_FIELD_VX))
        EXPECT_NEAR(vx, 3, 5e-13);
    for (const double vy : sim.field(GP_FIELD_VY))
        EXPECT_NEAR(vy, -4, 5e-13);
    EXPECT_LT(sim.state().max_pressure, 1e-9);
}
