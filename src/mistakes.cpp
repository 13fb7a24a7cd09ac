#include "mistakes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "error.hpp"
#include "parts.hpp"
#include "scene_falls.hpp"
#include "sight.hpp"

namespace gp {

namespace {

// How far behind a plate material is looked for, in dl beyond the horizon: nearer than a horizon the plate's ghosts stand where
// it begins.
constexpr double look_behind = 1;

// Calls visit(plate, segment) for the wetted lines as they stand.
template <class Visit> void for_each_segment(const Walls &walls, const Visit &visit) {
    for (const Facet &facet : walls.facets)
        visit(facet.plate, facet.segment);
}

// Calls visit(i, place) for the particles about a segment, and for their images where the segment reaches over an end of the
// period.
template <class Visit> void for_each_about(const World &world, const Segment &s, double margin, const Visit &visit) {
    const Box box = box_around(s, margin);
    const double length = world.constants.period.length;
    for (int side = length > 0 ? -1 : 0; side <= (length > 0 ? 1 : 0); ++side) {
        const double shift = side * length;
        world.grid.for_each_run({box.x_min - shift, box.x_max - shift, box.y_min, box.y_max},
                                [&](int64_t begin, int64_t last) {
                                    for (int64_t i = begin; i < last; ++i)
                                        visit(i, Vector(world.particles.x[i] + shift, world.particles.y[i]));
                                });
    }
}

// Does another segment stand between a place behind this one and it, and face the place?
bool is_faced(const World &world, const Segment &behind, const Vector &at) {
    const double spacing = world.constants.spacing;
    const Vector line = at - (behind.distance(at) - 0.01 * spacing) * behind.normal;
    bool faced = false;
    for_each_segment(world.walls, [&](int32_t, const Segment &s) {
        faced = faced || (&s != &behind && crossing(s, at, line, 1e-6 * spacing) >= 0);
    });
    return faced;
}

// A particle seen from a segment. key: its place in the order in which a process alone goes through segments and particles.
struct Sighting {
    std::array<double, 5> key; // segment, image, row, column, id
    double x, y, body;

    static constexpr int64_t numbers = 8;
    void pack(std::vector<double> &out) const {
        out.insert(out.end(), key.begin(), key.end());
        out.insert(out.end(), {x, y, body});
    }
    explicit Sighting(const double *n) : key{n[0], n[1], n[2], n[3], n[4]}, x(n[5]), y(n[6]), body(n[7]) {}
    Sighting(const std::array<double, 5> &at, double px, double py, double of) : key(at), x(px), y(py), body(of) {}
};

struct Sides {
    int64_t front = 0, behind = 0; // particles near the plate
    // The first of those behind; the last of a body that has particles on both sides, if there is one.
    Sighting first{{INFINITY}, 0, 0, -1}, split{{-INFINITY}, 0, 0, -1};

    void take_first(const Sighting &one) {
        if (one.key < first.key)
            first = one;
    }
    void take_split(const Sighting &one) {
        if (split.key < one.key)
            split = one;
    }
};

// Those of all processes.
void combine_sides(Crossing &crossing, std::vector<Sides> &found) {
    for (Sides &sides : found) {
        sides.front = sum_of_all(crossing, sides.front);
        sides.behind = sum_of_all(crossing, sides.behind);
        if (sides.behind == 0)
            continue;
        std::vector<double> own, all;
        sides.first.pack(own);
        sides.split.pack(own);
        crossing.gather_everywhere(own, all);
        for (std::size_t at = 0; at < all.size(); at += 2 * Sighting::numbers) {
            sides.take_first(Sighting(&all[at]));
            sides.take_split(Sighting(&all[at + Sighting::numbers]));
        }
    }
}

std::vector<Sides> find_sides(const World &world) {
    const Particles &p = world.particles;
    const double spacing = world.constants.spacing, reach = world.constants.reach + look_behind * spacing;
    std::vector<Sides> found(world.walls.plates.size());
    std::vector<double> in_front(world.scene->bodies().size()); // 1 or 0
    double segment = 0;
    for_each_segment(world.walls, [&](int32_t plate, const Segment &s) {
        Sides &sides = found[plate];
        std::fill(in_front.begin(), in_front.end(), 0.0);
        const auto for_each_beside = [&](const auto &visit) {
            for_each_about(world, s, reach, [&](int64_t i, const Vector &at) {
                if (std::abs(s.distance(at)) < reach && s.covers(s.along(at), 0))
                    visit(i, at);
            });
        };
        for_each_beside([&](int64_t i, const Vector &at) {
            if (s.distance(at) > 0) {
                ++sides.front;
                in_front[p.column[i]] = 1;
            }
        });
        if (world.crossing)
            world.crossing->combine(in_front.data(), static_cast<int>(in_front.size()), nullptr, 0);
        for_each_beside([&](int64_t i, const Vector &at) {
            if (s.distance(at) > -penetration_allowed * spacing || is_faced(world, s, at))
                return;
            const Cell cell = world.grid.frame().cell_of(p.x[i], p.y[i]);
            const double image = at.x() > p.x[i] ? 1 : at.x() < p.x[i] ? -1 : 0;
            const Sighting here({segment, image, static_cast<double>(cell.row), static_cast<double>(cell.column),
                                 static_cast<double>(p.id[i])},
                                p.x[i], p.y[i], p.column[i]);
            ++sides.behind;
            sides.take_first(here);
            if (in_front[p.column[i]] > 0)
                sides.take_split(here);
        });
        ++segment;
    });
    if (world.crossing)
        combine_sides(*world.crossing, found);
    return found;
}

// Of the plates with material behind them, those where it lies on both sides of the line are told apart from those that have
// it only there.
void tell_sides(const World &world, std::vector<std::string> &texts) {
    const std::vector<Sides> found = find_sides(world);
    const auto tell = [&](const auto &is_meant, const auto &text_of) {
        const auto first = std::find_if(found.begin(), found.end(), is_meant);
        if (first == found.end())
            return;
        const int64_t count = std::count_if(first, found.end(), is_meant);
        std::string text = text_of(static_cast<int>(first - found.begin()), *first);
        if (count > 1)
            text += format_text(" (and so of %lld more plates)", static_cast<long long>(count - 1));
        texts.push_back(std::move(text));
    };
    const auto place_of = [](const Sides &sides) {
        return format_text("the first at (%g, %g) m", sides.first.x, sides.first.y);
    };
    tell([](const Sides &s) { return s.behind > 0 && s.front == 0; },
         [&](int plate, const Sides &s) {
             return format_text(
                 "plate %d has material only on the side of its body, %lld particles near it, %s: it acts "
                 "on its other side alone, on the right of the way from end 0 to end 1. Swap its ends?",
                 plate, static_cast<long long>(s.behind), place_of(s).c_str());
         });
    tell([](const Sides &s) { return s.behind > 0 && s.front > 0 && s.split.body >= 0; },
         [&](int plate, const Sides &s) {
             return format_text(
                 "column %d lies across the line of plate %d, %lld particles behind it, %s: nothing holds "
                 "those. Move the plate or the column",
                 static_cast<int>(s.split.body), plate, static_cast<long long>(s.behind), place_of(s).c_str());
         });
    tell([](const Sides &s) { return s.behind > 0 && s.front > 0 && s.split.body < 0; },
         [&](int plate, const Sides &s) {
             return format_text("%lld particles begin behind plate %d, on the side of its body, %s: it does not act on "
                                "them. Move them, or add a plate back to back with it that faces them",
                                static_cast<long long>(s.behind), plate, place_of(s).c_str());
         });
}

void tell_unborne(const Scene &scene, std::vector<std::string> &texts) {
    const std::vector<double> shares = borne_shares(scene);
    const auto is_unborne = [](double share) { return 2 * share < 1; };
    const auto first = std::find_if(shares.begin(), shares.end(), is_unborne);
    if (first == shares.end())
        return;
    const auto body = static_cast<int>(first - shares.begin());
    const int64_t more = std::count_if(first, shares.end(), is_unborne) - 1;
    const std::string part = *first > 0 ? format_text("%.3g %% of ", 100 * (1 - *first)) : std::string();
    const std::string others = more > 0 ? format_text(" (and so of %lld more)", static_cast<long long>(more)) : "";
    texts.push_back(
        format_text("%scolumn %d has nothing below it in the direction of gravity%s, neither a plate that "
                    "faces it nor a column that one bears: it falls for ever. Add a floor, make it longer, or "
                    "swap its ends",
                    part.c_str(), body, others.c_str()));
}

// The length over which flow spreads is A d, of glass beads half a grain: profiles are those of one dimension from two particles
// to a grain on.
constexpr double spacings_per_grain = 2;

void tell_coarse_fluidity(const Scene &scene, std::vector<std::string> &texts) {
    const double spacing = scene.config().spacing;
    for (const Body &body : scene.bodies()) {
        const gp_material &m = scene.materials()[static_cast<std::size_t>(body.material)];
        const double most = m.grain_diameter / spacings_per_grain;
        if (m.nonlocal_amplitude == 0 || spacing <= most * (1 + 1e-9))
            continue;
        texts.push_back(
            format_text("gp_material.nonlocal_amplitude = %g of material %d: its length of %.3g m is not resolved at a "
                        "spacing of %g "
                        "m: set gp_config.spacing to at most %.3g, half a grain, or nonlocal_amplitude to 0",
                        m.nonlocal_amplitude, body.material, m.nonlocal_amplitude * m.grain_diameter, spacing, most));
        return;
    }
}

} // namespace

std::vector<std::string> scene_mistakes(const World &world) {
    std::vector<std::string> texts;
    if (world.scene->particle_count() == 0) {
        texts.emplace_back("the scene has no material: add a column or particles");
        return texts;
    }
    tell_sides(world, texts);
    on_first(world, [&] { tell_unborne(*world.scene, texts); }); // who gives the texts
    tell_coarse_fluidity(*world.scene, texts);
    return texts;
}

int64_t count_on_lines(const World &world, double margin) {
    std::vector<uint8_t> found(static_cast<std::size_t>(world.particles.count));
    for_each_segment(world.walls, [&](int32_t, const Segment &s) {
        for_each_about(world, s, margin, [&](int64_t i, const Vector &at) {
            if (std::abs(s.distance(at)) < margin && s.covers(s.along(at), 0))
                found[i] = 1;
        });
    });
    const auto count = static_cast<int64_t>(std::count(found.begin(), found.end(), uint8_t{1}));
    return world.crossing ? sum_of_all(*world.crossing, count) : count;
}

std::string lost_particles(const World &world) {
    const Constants &c = world.constants;
    if (c.gravity == Vector::Zero() || world.walls.plates.empty())
        return {};
    const Vector up = -c.gravity.normalized();
    double lowest = INFINITY;
    for_each_segment(world.walls, [&](int32_t, const Segment &s) {
        const double begin = up.dot(s.origin);
        lowest = std::min({lowest, begin, begin + s.length * up.dot(s.tangent)});
    });
    lowest -= c.reach;
    const Particles &p = world.particles;
    int64_t count = 0, first = -1;
    for (int64_t i = 0; i < p.count; ++i)
        if (up.x() * p.x[i] + up.y() * p.y[i] < lowest && up.x() * p.vx[i] + up.y() * p.vy[i] < 0) {
            if (count++ == 0 || p.id[i] < p.id[first])
                first = i;
        }
    if (count == 0)
        return {};
    return format_text(
        "%lld of %lld particles have left every plate behind at time %g s and fall for ever, one at (%g, %g) "
        "m: make the plates longer, close the gap that they came through, or add a plate below",
        static_cast<long long>(count), static_cast<long long>(p.count), world.clock.time, p.x[first], p.y[first]);
}

} // namespace gp
