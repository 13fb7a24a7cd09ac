// Plates of many segments: the same wall as plates that meet end to end, terrains, inclines, obstacles.
#include <memory>

#include "../support/lines.hpp"

using namespace test;

namespace {

// A wall of separate plates or of one plate, and what is about it.
struct Walled {
    Walled(const gp_config &c, const std::vector<Point> &points, bool as_one) : sim(c) {
        if (as_one)
            ids = {add_polyline(sim, points)};
        else
            ids = add_line(sim, points);
    }
    Sim sim;
    std::vector<int32_t> ids;
};

double largest_difference(const std::vector<double> &a, const std::vector<double> &b) {
    double largest = a.size() == b.size() ? 0 : INFINITY;
    for (std::size_t i = 0; i < a.size() && i < b.size(); ++i)
        largest = std::max(largest, std::abs(a[i] - b[i]));
    return largest;
}

// tolerance: m, 0 where both have the same lists at the same times.
template <class Scene> void expect_same(Scene &pieces, Scene &line, double t_end, double tolerance) {
    pieces.sim.run(t_end);
    line.sim.run(t_end);
    EXPECT_LE(largest_difference(line.sim.field(GP_FIELD_X), pieces.sim.field(GP_FIELD_X)), tolerance);
    EXPECT_LE(largest_difference(line.sim.field(GP_FIELD_Y), pieces.sim.field(GP_FIELD_Y)), tolerance);
    EXPECT_EQ(line.sim.state().step, pieces.sim.state().step);
    Force sum;
    for (const int32_t id : pieces.ids) {
        const gp_load l = pieces.sim.load(id);
        sum.x += l.fx;
        sum.y += l.fy;
        sum.moment += l.torque_pivot;
    }
    const gp_load one = line.sim.load(line.ids[0]);
    const double force = std::hypot(sum.x, sum.y), rounding = tolerance > 0 ? 1e-6 : 1e-12; // sums in another order
    EXPECT_NEAR(one.fx, sum.x, rounding * force);
    EXPECT_NEAR(one.fy, sum.y, rounding * force);
    EXPECT_NEAR(one.torque_pivot, sum.moment, rounding * force);
}

} // namespace

// The tests of chains hold separate plates to what is right; a line of one plate does the same, to the bit unless rounding
// of a joint's place gives another ghost.
TEST(Polyline, IsTheFloorOfItsPieces) {
    for (const int count : {2, 3, 9, 32}) {
        SCOPED_TRACE(count);
        const auto make = [&](bool as_one) {
            auto level = std::make_unique<Walled>(config(0.005), pieces({0.3025, 0}, {-0.0975, 0}, count), as_one);
            level->sim.column(0, 0, 0.2, 0.1);
            level->sim.add(plate(0, -0.05, 0, 0.3, GP_WALL_FREE_SLIP));
            level->sim.add(plate(0.2, 0.3, 0.2, -0.05, GP_WALL_FREE_SLIP));
            return level;
        };
        expect_same(*make(false), *make(true), 0.05, 1e-8 * 0.005);
    }
}

TEST(Polyline, IsTheBowlOfItsPieces) {
    for (const int count : {8, 24, 96}) {
        SCOPED_TRACE(count);
        Vessel pieces(-180, count), line(-180, count, true);
        expect_same(pieces, line, 0.1, 0);
    }
}

// The end of the line meets the image of its beginning.
TEST(Polyline, IsThePeriodicHillsOfItsPieces) {
    const double length = 0.1, spacing = 0.0025, amplitude = 0.006;
    for (const int count : {5, 32}) {
        SCOPED_TRACE(count);
        std::vector<Point> points;
        for (int k = count; k >= 0; --k)
            points.push_back({length * k / count, amplitude * std::cos(2 * pi * (k % count) / count)});
        const auto make = [&](bool as_one) {
            gp_config c = config(spacing);
            c.periodic_x_max = length;
            auto hills = std::make_unique<Walled>(c, points, as_one);
            fill(
                hills->sim, {0, -0.01}, {length, 0.03}, spacing,
                [&](double x, double y) { return y > amplitude * std::cos(2 * pi * x / length) + 0.4 * spacing; }, 0.3);
            return hills;
        };
        expect_same(*make(false), *make(true), 0.1, 0);
    }
}

TEST(Polyline, AsAnObstacleDividesAStream) {
    // In a periodic layer that is thrown to the right: material flows over and under it, none through, and it is pushed along.
    const double length = 0.2, spacing = 0.005;
    for (const int count : {8, 24}) {
        SCOPED_TRACE(count);
        const std::vector<Point> ring = arc(0.1, 0.04, 0.02, 0, 360, count);
        const auto make = [&](bool as_one) {
            gp_config c = config(spacing);
            c.periodic_x_max = length;
            auto stream = std::make_unique<Walled>(c, ring, as_one);
            fill(
                stream->sim, {0, 0}, {length, 0.08}, spacing,
                [&](double x, double y) { return !is_inside(ring, x, y, -0.5 * spacing); }, 0.5);
            stream->sim.add(floor_at(0, 0, length));
            return stream;
        };
        const auto pieces = make(false), line = make(true);
        expect_same(*pieces, *line, 0.02, 0); // for a while: it is chaotic
        line->sim.run(0.3);
        EXPECT_EQ(count_inside(line->sim, ring, 0.25 * spacing), 0);
        EXPECT_GT(line->sim.load(line->ids[0]).impulse_x, 0);
    }
}

namespace {

// Ridges and hollows with slopes of up to 45 degrees, from the right to the left: segments of one length.
struct Terrain {
    std::vector<Point> points;
    explicit Terrain(int count, double segment) {
        double x = 0, y = 0, slope = 0;
        for (int k = 0; k <= count; ++k) {
            points.push_back({x, y});
            // Turns of both signs and all sizes, up to 45 degrees within a segment at the sharpest ridges and hollows.
            slope = 45 * std::sin(0.31 * k) * std::cos(0.053 * k * k);
            x -= segment * std::cos(degrees(slope));
            y -= segment * std::sin(degrees(slope));
        }
    }
    double height(double x) const {
        for (std::size_t k = 0; k + 1 < points.size(); ++k)
            if (x <= points[k].x && x >= points[k + 1].x) {
                const double part = (x - points[k].x) / (points[k + 1].x - points[k].x);
                return points[k].y + part * (points[k + 1].y - points[k].y);
            }
        return -INFINITY;
    }
};

class TerrainAt : public testing::TestWithParam<double> {};

} // namespace

// dl in segments. A release on a terrain of ridges and hollows: whatever it does, it stays above.
TEST_P(TerrainAt, LetsNothingThrough) {
    const double segment = 0.02, dl = GetParam() * segment;
    const Terrain terrain(40, segment);
    Sim sim(config(dl));
    const double left = terrain.points.back().x, middle = 0.5 * left, thick = std::max(4 * dl, 2 * segment);
    double top = -INFINITY;
    for (const Point &point : terrain.points)
        top = std::max(top, point.y);
    fill(sim, {left, -1}, {0, top + thick}, dl, [&](double x, double y) {
        if (std::abs(x - middle) > 8 * segment)
            return false;
        double nearest = INFINITY; // of the line about it, so that none begins nearer than half a spacing to it
        for (double at = x - dl; at <= x + dl; at += 0.1 * dl)
            nearest = std::min(nearest, std::hypot(at - x, terrain.height(at) - y));
        return y > terrain.height(x) && nearest > 0.45 * dl && y < terrain.height(x) + thick;
    });
    add_polyline(sim, terrain.points);
    sim.run(1);
    const std::vector<double> x = sim.field(GP_FIELD_X), y = sim.field(GP_FIELD_Y);
    int below = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
        below += y[i] < terrain.height(x[i]);
    EXPECT_EQ(below, 0) << "of " << x.size();
}

INSTANTIATE_TEST_SUITE_P(Spacings, TerrainAt, testing::Values(0.5, 1, 4));

namespace {

// R90 down a plane of 16 degrees and so many segments, m.
double runout(int count) {
    const double dl = 0.01, c = std::cos(degrees(16)), s = std::sin(degrees(16)), length = 2;
    Sim sim(config(dl));
    const int32_t beads = sim.material(std::tan(degrees(21)), std::tan(degrees(32)));
    std::vector<double> x, y;
    for (int i = 0; i < 20; ++i)
        for (int j = 0; j < 14; ++j) {
            const double along = (i + 0.5) * dl, above = (j + 0.5) * dl;
            x.push_back(along * c + above * s);
            y.push_back(above * c - along * s);
        }
    EXPECT_EQ(
        gp_add_particles(sim, beads, static_cast<int64_t>(x.size()), x.data(), y.data(), nullptr, nullptr, nullptr),
        GP_OK);
    add_polyline(sim, pieces({length * c, -length * s}, {-0.1 * c, 0.1 * s}, count));
    sim.run(1.5);
    std::vector<double> way;
    const std::vector<double> x1 = sim.field(GP_FIELD_X), y1 = sim.field(GP_FIELD_Y);
    for (std::size_t i = 0; i < x1.size(); ++i)
        way.push_back(x1[i] * c - y1[i] * s);
    std::sort(way.begin(), way.end());
    return way[way.size() * 9 / 10];
}

} // namespace

TEST(Polyline, OfAnInclineIsThePlane) {
    const double plane = runout(1);
    for (const int count : {7, 200})
        EXPECT_NEAR(runout(count), plane, 0.01 * plane) << count;
}
