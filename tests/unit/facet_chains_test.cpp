// Which plates make one wall, and where the ghosts behind it stand.
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>

#include "facet_chains.hpp"

using namespace gp;

namespace {

constexpr double reach = 4; // of the ghosts; the spacing is 1
const double pi = std::acos(-1.0);

// Plates that stand where they are drawn.
struct Drawing {
    PlateSpec &add(double x0, double y0, double x1, double y1) {
        specs.push_back(PlateSpec({{x0, y0}, {x1, y1}}));
        return specs.back();
    }
    void line(const std::vector<Vector> &points) {
        for (std::size_t k = 0; k + 1 < points.size(); ++k)
            add(points[k].x(), points[k].y(), points[k + 1].x(), points[k + 1].y());
    }
    FacetChains &find(double period = 0) {
        plates.clear();
        facets.clear();
        images.clear();
        for (const PlateSpec &spec : specs) {
            facets.push_back({&spec, static_cast<int32_t>(plates.size()), 0, spec.segments[0]});
            plates.emplace_back(spec);
        }
        for (std::size_t p = 0; p < specs.size(); ++p)
            for (const int side : {0, 1, -1})
                if (const double shift = side * period; period > 0 || side == 0)
                    images.push_back({specs[p].segments[0].moved({shift, 0}), static_cast<int32_t>(p), shift, 0, true});
        chains.find(plates, facets, images, reach, 1, true);
        return chains;
    }
    // The number of each plate's chain.
    std::vector<int32_t> numbers() {
        find();
        std::vector<int32_t> found;
        for (std::size_t p = 0; p < specs.size(); ++p)
            found.push_back(chains.chain_of(static_cast<int32_t>(p)).number);
        return found;
    }
    // Places behind all chains within reach of a box.
    std::vector<WallPlace> places(const Box &box) {
        std::vector<WallPlace> found;
        for (const FacetChains::Chain &chain : chains.all())
            chains.add_places(chain, images, box, reach, 1, found);
        return found;
    }
    std::deque<PlateSpec> specs;
    std::vector<Plate> plates;
    std::vector<Facet> facets;
    std::vector<FacetImage> images;
    FacetChains chains;
};

using Numbers = std::vector<int32_t>;

Vector on_circle(double radius, double turns) {
    return {radius * std::cos(2 * pi * turns), radius * std::sin(2 * pi * turns)};
}

double nearest_other(const std::vector<WallPlace> &places, std::size_t k) {
    double nearest = INFINITY;
    for (std::size_t other = 0; other < places.size(); ++other)
        if (other != k)
            nearest = std::min(nearest, std::hypot(places[k].x - places[other].x, places[k].y - places[other].y));
    return nearest;
}

} // namespace

TEST(FacetChains, JoinWhatMeetsEndToEnd) {
    Drawing d;
    d.add(0, 0, -10, 0);        // 0, 1: out of order
    d.add(20, 0, 10, 0);        // begins the line
    d.add(10, 0.009, 0.004, 0); // meets both by less than .01
    d.add(-10.02, 0, -20, 0);   // too far off
    d.add(-30, 0, -20, 0);      // the other way round: its body is on the other side
    EXPECT_EQ(d.numbers(), (Numbers{0, 0, 0, 3, 4}));
    EXPECT_EQ(d.chains.link(2).before, 1);
    EXPECT_EQ(d.chains.link(2).after, 0);
    EXPECT_EQ(d.chains.link(1).before, -1);
    EXPECT_TRUE(d.chains.any());
}

TEST(FacetChains, BreakAtSharpTurnsAndBranches) {
    const auto turned = [](double degrees) { // towards the body or the material
        Drawing d;
        const Vector end = on_circle(10, 0.5 + degrees / 360);
        d.line({{10, 0}, {0, 0}, end});
        return d.numbers();
    };
    for (const double sign : {1.0, -1.0}) {
        EXPECT_EQ(turned(sign * 49), (Numbers{0, 0}));
        EXPECT_EQ(turned(sign * 52), (Numbers{0, 1}));
        EXPECT_EQ(turned(sign * 90), (Numbers{0, 1}));
    }
    Drawing fork; // one end, two ways on
    fork.line({{10, 0}, {0, 0}, {-10, 2}});
    fork.line({{0, 0}, {-10, -2}});
    EXPECT_EQ(fork.numbers(), (Numbers{0, 1, 2}));
    Drawing merging; // in another order, two ways to one
    merging.line({{10, 2}, {0, 0}, {-10, 0}});
    merging.line({{10, -2}, {0, 0}});
    EXPECT_EQ(merging.numbers(), (Numbers{0, 1, 2}));
    Drawing wall; // upright on a joint of the floor, which stays one
    wall.line({{10, 0}, {0, 0}, {-10, 0}});
    wall.line({{0, 0}, {0, 10}});
    EXPECT_EQ(wall.numbers(), (Numbers{0, 0, 2}));
    Drawing gate; // both sides of it
    gate.line({{0, 10}, {0, 5}, {0, 0}});
    gate.line({{0, 0}, {0, 5}, {0, 10}});
    EXPECT_EQ(gate.numbers(), (Numbers{0, 0, 2, 2}));
}

TEST(FacetChains, BreakWhereTheyBulgeSharplyWithinAHorizon) {
    // A quarter of a circle towards the material from 9 plates of 10 degrees: with a radius of 2 it is a corner, with one of 20
    // a curve. As a hollow it is a curve in both.
    const auto count = [](double radius, bool bulge) {
        Drawing d;
        std::vector<Vector> points;
        for (int k = 0; k <= 9; ++k)
            points.push_back(on_circle(radius, (bulge ? 1 : -1) * k / 36.0));
        d.line(points);
        d.find();
        return d.chains.all().size();
    };
    EXPECT_EQ(count(2, true), 2u);
    EXPECT_EQ(count(20, true), 1u);
    EXPECT_EQ(count(2, false), 1u);
    EXPECT_EQ(count(20, false), 1u);
}

TEST(FacetChains, MoveTogether) {
    const auto pair = [](const auto &change) {
        Drawing d;
        d.line({{10, 0}, {0, 0}, {-10, 0}});
        change(d.specs[0], d.specs[1]);
        return d.numbers();
    };
    const MotionTable lift{{0, 1}, {0, 0}, {0, 2}, {}}, later{{0, 2}, {0, 0}, {0, 2}, {}},
        swing{{0, 1}, {0, 0}, {0, 2}, {0, 1}};
    EXPECT_EQ(pair([](PlateSpec &a, PlateSpec &b) {
                  a.motion.velocity = b.motion.velocity = {1, 2};
              }),
              (Numbers{0, 0}));
    EXPECT_EQ(pair([](PlateSpec &a, PlateSpec &) { a.motion.velocity = {1, 2}; }), (Numbers{0, 1}));
    EXPECT_EQ(pair([&](PlateSpec &a, PlateSpec &b) { a.table = b.table = lift; }), (Numbers{0, 0}));
    EXPECT_EQ(pair([&](PlateSpec &a, PlateSpec &b) {
                  a.table = lift;
                  b.table = later;
              }),
              (Numbers{0, 1}));
    EXPECT_EQ(pair([](PlateSpec &a, PlateSpec &b) { a.motion.omega = b.motion.omega = 1; }), (Numbers{0, 0}));
    EXPECT_EQ(pair([](PlateSpec &a, PlateSpec &b) {
                  a.motion.omega = b.motion.omega = 1;
                  b.pivot = {0, 1};
              }),
              (Numbers{0, 1}));
    EXPECT_EQ(pair([&](PlateSpec &a, PlateSpec &b) { a.table = b.table = swing; }), (Numbers{0, 0}));
    EXPECT_EQ(pair([&](PlateSpec &a, PlateSpec &b) {
                  a.table = b.table = swing;
                  b.pivot = {0, 1};
              }),
              (Numbers{0, 1}));
    EXPECT_EQ(pair([](PlateSpec &a, PlateSpec &b) { a.load = b.load = 100; }), (Numbers{0, 1}));
    EXPECT_EQ(pair([](PlateSpec &a, PlateSpec &b) { // friction is each plate's own
                  a.friction = GP_WALL_COULOMB;
                  b.friction = GP_WALL_FREE_SLIP;
              }),
              (Numbers{0, 0}));
}

TEST(FacetChains, NoticeThatOneIsDrivenAway) {
    Drawing d;
    d.line({{10, 0}, {0, 0}, {-10, 0}});
    d.find();
    EXPECT_TRUE(d.chains.stand(d.plates));
    d.plates[0].drive(0, {{1, 0}, 0});
    EXPECT_FALSE(d.chains.stand(d.plates));
    d.plates[1].drive(0, {{1, 0}, 0});
    EXPECT_TRUE(d.chains.stand(d.plates));
    d.plates[1].drive(1, {{0, 0}, 0});
    d.chains.find(d.plates, d.facets, d.images, reach, 1, true);
    EXPECT_NE(d.chains.chain_of(0).number, d.chains.chain_of(1).number);
    EXPECT_TRUE(d.chains.stand(d.plates));
    d.plates[0].drive(1, {{0, 0}, 0}); // together again
    EXPECT_FALSE(d.chains.stand(d.plates));
}

TEST(FacetChains, StandOnTheLatticeOfOnePlate) {
    const Box box{-8, 8, 0, 5};
    const auto sorted = [&](const std::vector<Vector> &points) {
        Drawing d;
        d.line(points);
        d.find();
        std::vector<std::pair<double, double>> found;
        for (const WallPlace &place : d.places(box)) {
            EXPECT_DOUBLE_EQ(place.distance, -place.y);
            found.push_back({std::round(1e9 * place.y), std::round(1e9 * place.x)});
        }
        std::sort(found.begin(), found.end());
        return found;
    };
    const auto one = sorted({{20, 0}, {-20, 0}});
    EXPECT_GT(one.size(), 80u);
    EXPECT_EQ(sorted({{20, 0}, {2.3, 0}, {1.9, 0}, {-7.05, 0}, {-20, 0}}), one);
}

TEST(FacetChains, FillBendsEvenly) {
    // Behind a hollow rows turn with a fan, behind a bulge they are cut at the bisector: nowhere a hole or a heap.
    for (const double turn : {40.0, 15.0, -15.0, -40.0}) {
        Drawing d;
        const Vector end = on_circle(20, 0.5 - turn / 360);
        d.line({{20, 0}, {0, 0}, end});
        d.find();
        const std::vector<WallPlace> places = d.places({-10, 10, -8, 8});
        for (std::size_t k = 0; k < places.size(); ++k) {
            const WallPlace &p = places[k];
            const Vector at(p.x, p.y);
            double line = INFINITY;
            for (const FacetImage &image : d.images)
                line = std::min(line, image.segment.nearest(at));
            if (at.norm() < 6) {
                EXPECT_NEAR(line, p.distance, 1e-9) << turn;
                EXPECT_GT(nearest_other(places, k), 0.45) << turn;
                EXPECT_LT(nearest_other(places, k), 1.05) << turn;
            }
            // The way to the wetted line leads to it.
            EXPECT_NEAR(d.images[p.image].segment.nearest(at + p.distance * Vector(p.nx, p.ny)), 0, 1e-9);
        }
    }
}

TEST(FacetChains, CloseRingsWithoutASeam) {
    for (const double sense : {-1.0, 1.0}) { // a drum, a solid
        Drawing d;
        std::vector<Vector> points;
        for (int k = 0; k <= 24; ++k)
            points.push_back(on_circle(15, sense * (k % 24) / 24));
        d.line(points);
        d.find();
        ASSERT_EQ(d.chains.all().size(), 1u);
        EXPECT_EQ(d.chains.all()[0].repeats, 24);
        EXPECT_EQ(d.chains.link(0).before, 23);
        const std::vector<WallPlace> places = d.places({-20, 20, -20, 20});
        const auto first =
            std::count_if(places.begin(), places.end(), [](const WallPlace &p) { return p.distance < 1; });
        EXPECT_NEAR(static_cast<double>(first), 2 * pi * (15 - sense * 0.5), 2);
        for (std::size_t k = 0; k < places.size(); ++k) {
            EXPECT_GT(nearest_other(places, k), 0.45);
            EXPECT_LT(nearest_other(places, k), 1.05);
        }
    }
}

TEST(FacetChains, RepeatAcrossThePeriod) {
    Drawing d; // 20.5 spacings long, with waves
    std::vector<Vector> points;
    for (int k = 8; k >= 0; --k)
        points.push_back({20.5 * k / 8, std::cos(pi * k / 4)});
    d.line(points);
    d.find(20.5);
    ASSERT_EQ(d.chains.all().size(), 1u);
    EXPECT_EQ(d.chains.all()[0].repeats, 8);
    EXPECT_EQ(d.chains.link(0).before, 7);
    const std::vector<WallPlace> places = d.places({-10, 31, -2, 8});
    int compared = 0;
    for (const WallPlace &p : places)
        if (p.x > 0 && p.x < 5) {
            double nearest = INFINITY;
            for (const WallPlace &q : places)
                nearest = std::min(nearest, std::hypot(q.x - p.x - 20.5, q.y - p.y));
            EXPECT_NEAR(nearest, 0, 1e-9);
            ++compared;
        }
    EXPECT_GT(compared, 15);
}
