// Walls of several segments, as plates of their own or as one plate, and what rests on them.
#pragma once

#include <algorithm>
#include <functional>

#include "scene.hpp"

namespace test {

constexpr double density = 1550, gravity = 9.81;

struct Point {
    double x, y;
};

// Plates from point to point: the material is on the right of the way.
inline std::vector<int32_t> add_line(
    Sim &sim, const std::vector<Point> &points, int32_t friction = GP_WALL_NO_SLIP,
    const std::function<void(gp_plate &)> &change = [](gp_plate &) {}) {
    std::vector<int32_t> ids;
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        gp_plate p = plate(points[k].x, points[k].y, points[k + 1].x, points[k + 1].y, friction);
        p.wall_mu = friction == GP_WALL_COULOMB ? 0.3 : 0;
        change(p);
        ids.push_back(sim.add(p));
    }
    return ids;
}

// The same line as one plate.
inline int32_t add_polyline(
    Sim &sim, const std::vector<Point> &points, int32_t friction = GP_WALL_NO_SLIP,
    const std::function<void(gp_plate &)> &change = [](gp_plate &) {}) {
    std::vector<double> x, y;
    for (const Point &point : points) {
        x.push_back(point.x);
        y.push_back(point.y);
    }
    gp_plate p = plate(0, 0, 0, 0, friction);
    p.wall_mu = friction == GP_WALL_COULOMB ? 0.3 : 0;
    p.n_points = static_cast<int64_t>(x.size());
    p.point_x = x.data();
    p.point_y = y.data();
    change(p);
    return sim.add(p);
}

// The straight way from one point to another in pieces of equal length.
inline std::vector<Point> pieces(const Point &from, const Point &to, int count) {
    std::vector<Point> points;
    for (int k = 0; k <= count; ++k)
        points.push_back({from.x + (to.x - from.x) * k / count, from.y + (to.y - from.y) * k / count});
    return points;
}

// An arc about (x, y); clockwise, the material is inside.
inline std::vector<Point> arc(double x, double y, double radius, double from_degrees, double to_degrees, int count) {
    std::vector<Point> points;
    for (int k = 0; k <= count; ++k) {
        const double angle = degrees(from_degrees + (to_degrees - from_degrees) * k / count);
        points.push_back({x + radius * std::cos(angle), y + radius * std::sin(angle)});
    }
    if (std::abs(to_degrees - from_degrees) == 360) // sines of a full turn are not quite zero
        points.back() = points.front();
    return points;
}

// Particles in rings about the origin, between two radii, every other ring turned by half of its distance between them.
inline void add_rings(Sim &sim, int32_t material, double inner, double outer, int rings, double spacing) {
    std::vector<double> x, y;
    for (int j = 0; j < rings; ++j) {
        const double r = inner + (outer - inner) * (j + 0.5) / rings;
        const int count = static_cast<int>(std::round(2 * pi * r / spacing));
        for (int k = 0; k < count; ++k) {
            x.push_back(r * std::cos(2 * pi * (k + 0.5 * (j % 2)) / count));
            y.push_back(r * std::sin(2 * pi * (k + 0.5 * (j % 2)) / count));
        }
    }
    const auto n = static_cast<int64_t>(x.size());
    ASSERT_EQ(gp_add_particles(sim, material, n, x.data(), y.data(), nullptr, nullptr, nullptr), GP_OK);
}

// Particles on the lattice of the spacing where `inside` says so.
inline void fill(Sim &sim, const Point &low, const Point &high, double spacing,
                 const std::function<bool(double, double)> &inside, double vx = 0) {
    std::vector<double> x, y;
    for (int j = 0; low.y + (j + 0.5) * spacing < high.y; ++j)
        for (int i = 0; low.x + (i + 0.5) * spacing < high.x; ++i)
            if (const Point at{low.x + (i + 0.5) * spacing, low.y + (j + 0.5) * spacing}; inside(at.x, at.y)) {
                x.push_back(at.x);
                y.push_back(at.y);
            }
    const std::vector<double> u(x.size(), vx), v(x.size(), 0.0);
    ASSERT_EQ(gp_add_particles(sim, 0, static_cast<int64_t>(x.size()), x.data(), y.data(), u.data(), v.data(), nullptr),
              GP_OK)
        << gp_last_error();
}

struct Force {
    double x = 0, y = 0, moment = 0; // N/m, N about the origin
};
inline Force total_load(Sim &sim, const std::vector<int32_t> &ids, const std::vector<Point> &points) {
    Force sum;
    for (std::size_t k = 0; k < ids.size(); ++k) {
        const gp_load l = sim.load(ids[k]);
        sum.x += l.fx;
        sum.y += l.fy;
        sum.moment += l.torque + (points[k].x + l.dx) * l.fy - (points[k].y + l.dy) * l.fx;
    }
    return sum;
}

inline double weight_of(Sim &sim, double spacing) {
    return static_cast<double>(sim.state().n_particles) * spacing * spacing * density * gravity;
}

// What is said of a scene at rest on curved walls.
struct Settled {
    double at_rest = -1; // s, from when on
    double fallen = 0;   // J/m, the most by which wall_dissipated has been below an earlier value
    double late = 0;     // the same, of values from .45 s on
    double taken = 0;    // J/m, the highest wall_dissipated
};
inline Settled settle(Sim &sim, double t_end, double interval) {
    Settled s;
    double late = -INFINITY;
    for (double t = interval; t < t_end + 1e-9; t += interval) {
        sim.run(t);
        const gp_state state = sim.state();
        if (state.at_rest == 0)
            s.at_rest = -1;
        else if (s.at_rest < 0)
            s.at_rest = t;
        s.taken = std::max(s.taken, state.wall_dissipated);
        s.fallen = std::max(s.fallen, s.taken - state.wall_dissipated);
        if (t > 0.45 - 1e-9) {
            late = std::max(late, state.wall_dissipated);
            s.late = std::max(s.late, late - state.wall_dissipated);
        }
    }
    return s;
}

// Material up to the middle of a round vessel, at least half a spacing from its plates.
struct Vessel {
    static constexpr double radius = 0.05, spacing = 0.0025;
    Sim sim;
    std::vector<Point> points;
    std::vector<int32_t> ids;
    Vessel(double to_degrees, int count, bool as_one = false)
        : sim(config(spacing)), points(arc(0, 0, radius, 0, to_degrees, count)) {
        fill(sim, {-radius, -radius}, {radius, 0}, spacing, [&](double x, double y) {
            return std::all_of(points.begin() + 1, points.end(), [&](const Point &end) {
                const Point &begin = *(&end - 1);
                const double tx = end.x - begin.x, ty = end.y - begin.y;
                return (ty * (x - begin.x) - tx * (y - begin.y)) / std::hypot(tx, ty) > 0.499 * spacing;
            });
        });
        if (as_one)
            ids = {add_polyline(sim, points)};
        else
            ids = add_line(sim, points);
    }
};

inline bool is_inside(const std::vector<Point> &ring, double x, double y, double margin) {
    return std::all_of(ring.begin() + 1, ring.end(), [&](const Point &end) {
        const Point &begin = *(&end - 1);
        const double tx = end.x - begin.x, ty = end.y - begin.y;
        return (ty * (x - begin.x) - tx * (y - begin.y)) / std::hypot(tx, ty) < -margin;
    });
}

inline int count_inside(Sim &sim, const std::vector<Point> &ring, double margin) {
    const std::vector<double> x = sim.field(GP_FIELD_X), y = sim.field(GP_FIELD_Y);
    int found = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
        found += is_inside(ring, x[i], y[i], margin);
    return found;
}

} // namespace test
