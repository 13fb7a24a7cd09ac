// The free surface of the deposit, beside walls too, and its highest point.
//
// Smoothed over a radius r a surface is unbiased where it is straight. A cusp it cuts off by r / 5 times the slope of its
// sides (the mean |x| under the weight in a strip is r / 5): with r = 2 dl that took 1.2 % off the peak of a deposit of 13
// spacings with sides of 21 degrees. So the peak is extrapolated from the heights at two radii, the second twice the first:
// exact for a cusp and a plateau, and at a top with the radius of curvature R high by 0.6 dl^2 / R (half disc of 13 dl: .3 %).
// Of radii that do this, 3 and 6 dl: with 2 and 4 the places of single grains scatter the peak by half as much again, and with
// 4 and 6 the peak of a plateau six spacings wide is .25 dl too high, with these .13.
//
// Beside walls half of what the weight reaches lies in the wall: the deposit is mirrored there.
#include <algorithm>
#include <cmath>

#include "diagnostics.hpp"
#include "kernel.hpp"
#include "parts.hpp"
#include "sight.hpp"
#include "sort_by_x.hpp"
#include "stretches.hpp"

namespace gp {

namespace {

constexpr double surface_radius = 2;  // dl: a straight row of particles still reaches a volume fraction of 1/2
constexpr double peak_radius = 3;     // dl, and twice this
constexpr double full_fraction = 0.9; // that the inside of the deposit reaches at least
constexpr double past_end = 0.5;      // dl, to which a plate mirrors beyond its ends

constexpr double pi = 3.14159265358979323846;

} // namespace

Surface::Surface(const World &world, const std::vector<char> &connected) : spacing_(world.constants.spacing) {
    const Period &period = world.constants.period;
    if (period) {
        x_min_ = period.x_min;
        x_max_ = period.x_min + period.length;
    }
    const Particles &p = world.particles;
    std::vector<int64_t> place_of(world.listed.empty() ? 0 : p.count); // in the lists, where a sort was undone
    for (std::size_t place = 0; place < place_of.size(); ++place)
        place_of[world.listed[place]] = static_cast<int64_t>(place);
    const auto add = [&](int64_t i, const Vector &at) {
        points_.push_back({at.x(), at.y(), -1});
        left_ = std::min(left_, at.x());
        right_ = std::max(right_, at.x());
        if (!world.walls.contact_start.empty())
            add_mirrored(world.walls, place_of.empty() ? i : place_of[i], at);
    };
    // What is beyond one end of a period comes in at the other, and what is near an end is seen across it, too.
    const double near = 2 * (world.constants.reach + world.skin);
    for (int64_t i = 0; i < p.count; ++i) {
        if (!connected[i])
            continue;
        const double x = period ? p.x[i] - period.shift_of(p.x[i]) : p.x[i];
        add(i, {x, p.y[i]});
        if (period && x - x_min_ <= near)
            add(i, {x + period.length, p.y[i]});
        if (period && x_max_ - x <= near)
            add(i, {x - period.length, p.y[i]});
    }
    if (world.crossing) {
        collect(world.crossing, points_);
        for (const Point &point : points_)
            if (point.wall < 0) {
                left_ = std::min(left_, point.x);
                right_ = std::max(right_, point.x);
            }
    }
    on_first(world, [&] {
        number_walls(world.walls);
        sort_by_x(points_, [](const Point &a, const Point &b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    });
}

// The mirror images of one particle in the plates that it is in contact with.
void Surface::add_mirrored(const Walls &walls, int64_t place, const Vector &at) {
    for (int64_t c = walls.contact_start[place]; c < walls.contact_start[place + 1]; ++c) {
        const int32_t id = walls.contacts[c].facet;
        const Segment &s = walls.facets[id].segment;
        const Vector image = walls.nearest_image(s, at);
        const double distance = s.distance(image), along = s.along(image), beyond = past_end * spacing_;
        if (distance > 2 * peak_radius * spacing_ || along < -beyond || along > s.length + beyond)
            continue;
        const Vector mirrored = at - 2 * distance * s.normal;
        points_.push_back({mirrored.x(), mirrored.y(), id});
    }
}

// Of all facets, those that mirror something.
void Surface::number_walls(const Walls &walls) {
    std::vector<int32_t> wall_of(walls.facets.size(), -1);
    for (Point &point : points_) {
        if (point.wall < 0)
            continue;
        int32_t &wall = wall_of[point.wall];
        if (wall < 0) {
            wall = static_cast<int32_t>(walls_.size());
            const Segment &s = walls.facets[point.wall].segment;
            walls_.push_back(s);
            if (walls.period && walls.period.spanned_by(s)) { // it has no ends
                walls_.back() = s.moved(-s.length * s.tangent);
                walls_.back().length *= 3;
            }
        }
        point.wall = wall;
    }
}

double Surface::left() const {
    return std::max(x_min_, left_ - 0.5 * spacing_);
}

double Surface::right() const {
    return std::min(x_max_, right_ + 0.5 * spacing_);
}

// What is seen from places at one x.
class Surface::Strip {
public:
    Strip(const Surface &surface, double x, double radius, double lowest) : x_(x), radius_(radius), surface_(surface) {
        const std::vector<Point> &all = surface.points_;
        const auto before = [](const Point &a, double value) { return a.x < value; };
        auto k = std::lower_bound(all.begin(), all.end(), x - radius, before);
        for (; k != all.end() && k->x < x + radius; ++k)
            if (k->y > lowest)
                points_.push_back(*k);
        std::sort(points_.begin(), points_.end(),
                  [](const Point &a, const Point &b) { return a.y != b.y ? a.y > b.y : a.x < b.x; });
        // The images of the walls about this x.
        const double period = surface.x_max_ - surface.x_min_;
        for (const Segment &wall : surface.walls_) {
            const double middle = wall.origin.x() + 0.5 * wall.length * wall.tangent.x();
            walls_.push_back(std::isfinite(period) ? wall.moved({period * std::round((x - middle) / period), 0})
                                                   : wall);
        }
    }

    // Volume fraction at (x, y): V sum of the weight over its integral pi R^2 / 10.
    double fraction(double y) const {
        near_.clear();
        for (std::size_t w = 0; w < walls_.size(); ++w)
            if (walls_[w].nearest({x_, y}) < radius_)
                near_.push_back(static_cast<int32_t>(w));
        auto k = std::lower_bound(points_.begin(), points_.end(), y + radius_,
                                  [](const Point &a, double value) { return a.y > value; });
        double sum = 0;
        for (; k != points_.end() && k->y > y - radius_; ++k)
            if (const double dx = k->x - x_, dy = k->y - y, r2 = dx * dx + dy * dy;
                r2 < radius_ * radius_ && sees(y, *k))
                sum += weight(std::sqrt(r2), 1.0 / radius_);
        return surface_.spacing_ * surface_.spacing_ * 10 / (pi * radius_ * radius_) * sum;
    }

    // Largest y where the fraction is 1/2, or half of the largest one where the material nowhere fills the radius (`full`
    // false: thin, at a front). false if there is none.
    bool height(double &y, bool &full) const {
        double fullest = 0;
        for (auto k = points_.begin(); k != points_.end() && fullest < full_fraction; ++k)
            if (k->wall < 0)
                fullest = std::max(fullest, fraction(k->y));
        full = fullest >= full_fraction;
        const double half = full ? 0.5 : 0.5 * fullest;
        // Down from above each particle in turn, by steps from outside to inside.
        constexpr int steps = 8;
        for (const Point &point : points_)
            for (int k = 1; k <= steps && point.wall < 0; ++k) {
                const double outside = point.y + radius_ * (steps - k + 1) / steps,
                             inside = point.y + radius_ * (steps - k) / steps;
                if (fraction(inside) < half)
                    continue;
                y = crossing(outside, inside, half);
                return true;
            }
        return false;
    }

private:
    // Where the fraction is `half`, by false position (the Illinois rule: an end that stays counts half).
    double crossing(double outside, double inside, double half) const {
        double lacks = fraction(outside) - half, exceeds = fraction(inside) - half;
        for (int k = 0, stayed = 0; k < 60 && outside - inside > 1e-12 * radius_ && exceeds > 0; ++k) {
            const double middle = inside + (outside - inside) * exceeds / (exceeds - lacks);
            const double there = fraction(middle) - half;
            if (there >= 0) {
                inside = middle;
                exceeds = there;
                lacks *= stayed > 0 ? 0.5 : 1;
                stayed = 1;
            } else {
                outside = middle;
                lacks = there;
                exceeds *= stayed < 0 ? 0.5 : 1;
                stayed = -1;
            }
        }
        return inside;
    }

    // A particle is seen unless a plate is between, its mirror image through its plate alone.
    bool sees(double y, const Point &point) const {
        if (near_.empty())
            return point.wall < 0;
        const double behind = -penetration_allowed * surface_.spacing_, beyond = past_end * surface_.spacing_;
        for (int32_t w : near_) {
            const Segment &s = walls_[w];
            const Vector from(x_, y), to(point.x, point.y);
            const double here = s.distance(from), there = s.distance(to);
            const bool mirrored = point.wall == w;
            if (mirrored && here < behind)
                return false;
            if (!mirrored && (here < behind) == (there < behind))
                continue;
            const double share = std::abs(here) / std::max(std::abs(here) + std::abs(there), 1e-300);
            const double along = s.along(from) + share * (s.along(to) - s.along(from));
            const bool passes = along > -beyond && along < s.length + beyond;
            if (passes != mirrored)
                return false;
        }
        return point.wall < 0 || std::find(near_.begin(), near_.end(), point.wall) != near_.end();
    }

    double x_, radius_;
    const Surface &surface_;
    std::vector<Point> points_; // from the highest down
    std::vector<Segment> walls_;
    mutable std::vector<int32_t> near_; // of walls_, about the place asked for
};

bool Surface::height(double x, double radius, double &y, bool &full) const {
    if (points_.empty() || x < left() || x > right())
        return false;
    const auto before = [](const Point &a, double value) { return a.x < value; };
    double top = -INFINITY;
    auto k = std::lower_bound(points_.begin(), points_.end(), x - radius, before);
    for (; k != points_.end() && k->x < x + radius; ++k)
        if (k->wall < 0)
            top = std::max(top, k->y);
    // Mostly the surface is that of the highest; where it is not, or thin, all that is below counts as well.
    return (Strip(*this, x, radius, top - 4 * radius).height(y, full) && full) ||
           Strip(*this, x, radius, -INFINITY).height(y, full);
}

bool Surface::is_filled(double x, double y, double radius) const {
    return Strip(*this, x, radius, y - radius).fraction(y) >= 0.5;
}

bool Surface::height(double x, double &y) const {
    bool full;
    return height(x, surface_radius * spacing_, y, full);
}

// Stations a quarter spacing and more apart, at particles less than two spacings below the highest; and the fronts beside
// them: against a wall the highest point is at the wall.
std::vector<double> Surface::stations_near_top() const {
    double top = -INFINITY;
    for (const Point &point : points_)
        if (point.wall < 0)
            top = std::max(top, point.y);
    std::vector<double> stations;
    for (const Point &point : points_)
        if (point.wall < 0 && point.y > top - 2 * spacing_ && point.x >= left() && point.x <= right() &&
            (stations.empty() || point.x - stations.back() > 0.25 * spacing_))
            stations.push_back(point.x);
    if (!stations.empty()) {
        const double first = stations.front(), last = stations.back();
        if (first - left() < spacing_)
            stations.push_back(left());
        if (right() - last < spacing_)
            stations.push_back(right());
    }
    return stations;
}

void Surface::peak(double &x, double &y) const {
    const double inner = peak_radius * spacing_, outer = 2 * inner;
    const std::vector<double> stations = stations_near_top();
    const auto highest = [&](double radius, bool thick) {
        bool found = false, full;
        double height;
        for (const double at : stations)
            // Finding a height takes some hundred sums; that it is above the highest so far, one.
            if ((!found || !thick || is_filled(at, y, radius)) && this->height(at, radius, height, full) &&
                (full || !thick) && (!found || height > y)) {
                x = at;
                y = height;
                found = true;
            }
        return found;
    };
    // The wider radius knows the place better.
    bool full;
    double near;
    if (highest(outer, true) && height(x, inner, near, full) && full) {
        y = near + (near - y);
        return;
    }
    y = -INFINITY;
    highest(surface_radius * spacing_, false); // too thin to say more
}

} // namespace gp
