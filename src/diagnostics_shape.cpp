// The shape of the deposit: what is connected, its surface, the interface of two bodies.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "diagnostics.hpp"
#include "kernel.hpp"

namespace gp {

namespace {

constexpr double link_distance = 1.6;    // dl: a little more than the diagonal of the lattice
constexpr double smoothing_radius = 2.0; // dl: a straight row of particles still reaches a volume fraction of 1/2
const double pi = std::acos(-1.0);

int32_t root_of(std::vector<int32_t> &parent, int32_t i) {
    while (parent[i] != i)
        i = parent[i] = parent[parent[i]];
    return i;
}

} // namespace

std::vector<char> connected_deposit(const World &world) {
    const Particles &p = world.particles;
    std::vector<int32_t> parent(p.count);
    std::iota(parent.begin(), parent.end(), 0);
    const double link = link_distance * world.constants.spacing, link2 = link * link;
    const ClusterList &clusters = world.clusters;
    for (int64_t c = 0; c < clusters.count(); ++c)
        for (int64_t place = clusters.first[c]; place < clusters.first[c + 1]; ++place) {
            const auto i = static_cast<int32_t>(world.particle_listed_at(place));
            for_each_seen(clusters, c, place, [&](int32_t there) {
                const int64_t near = world.particle_listed_at(there);
                const double dx = p.x[near] - p.x[i], dy = p.y[near] - p.y[i];
                const auto j = static_cast<int32_t>(world.images.source(near));
                if (j > i && dx * dx + dy * dy < link2)
                    parent[root_of(parent, i)] = root_of(parent, j);
            });
        }
    std::vector<int32_t> size(p.count, 0);
    std::vector<int64_t> smallest_id(p.count, INT64_MAX);
    for (int32_t i = 0; i < p.count; ++i) {
        const int32_t root = root_of(parent, i);
        ++size[root];
        smallest_id[root] = std::min(smallest_id[root], p.id[i]);
    }
    int32_t largest = 0;
    for (int32_t i = 0; i < p.count; ++i)
        if (size[i] > size[largest] || (size[i] == size[largest] && smallest_id[i] < smallest_id[largest]))
            largest = i;
    std::vector<char> connected(p.count);
    for (int32_t i = 0; i < p.count; ++i)
        connected[i] = root_of(parent, i) == largest;
    return connected;
}

Surface::Surface(const World &world)
    : spacing_(world.constants.spacing), radius_(smoothing_radius * world.constants.spacing) {
    if (const Period &period = world.constants.period) {
        x_min_ = period.x_min;
        x_max_ = period.x_min + period.length;
    }
    const std::vector<char> connected = connected_deposit(world);
    const Particles &p = world.particles;
    for (int64_t i = 0; i < p.count + world.images.count; ++i)
        if (connected[world.images.source(i)])
            points_.push_back({p.x[i], p.y[i]});
    std::sort(points_.begin(), points_.end(),
              [](const Point &a, const Point &b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
}

double Surface::left() const {
    return std::max(x_min_, points_.front().x - 0.5 * spacing_);
}

double Surface::right() const {
    return std::min(x_max_, points_.back().x + 0.5 * spacing_);
}

bool Surface::height(double x, double &y) const {
    if (points_.empty() || x < left() || x > right())
        return false;
    const auto before = [](const Point &a, double value) { return a.x < value; };
    const auto first = std::lower_bound(points_.begin(), points_.end(), x - radius_, before);
    const auto last = std::lower_bound(first, points_.end(), x + radius_, before);
    if (first == last)
        return false;
    std::vector<Point> strip(first, last);
    std::sort(strip.begin(), strip.end(), [](const Point &a, const Point &b) { return a.y > b.y; });
    // Volume fraction at (x, at): V sum of the weight over its integral pi R^2 / 10.
    const double scale = spacing_ * spacing_ * 10 / (pi * radius_ * radius_);
    const auto fraction = [&](double at) {
        auto k = std::lower_bound(strip.begin(), strip.end(), at + radius_,
                                  [](const Point &a, double value) { return a.y > value; });
        double sum = 0;
        for (; k != strip.end() && k->y > at - radius_; ++k)
            sum += weight(std::hypot(k->x - x, k->y - at), 1.0 / radius_);
        return scale * sum;
    };
    // Beside a wall or at a front the material nowhere fills the radius: what counts is half of what it reaches.
    double fullest = 0;
    for (auto k = strip.begin(); k != strip.end() && fullest < 0.9; ++k)
        fullest = std::max(fullest, fraction(k->y));
    const double half = fullest < 0.9 ? 0.5 * fullest : 0.5;
    // Down from above each particle in turn, by steps from outside to inside; then bisection.
    constexpr int steps = 8;
    for (const Point &point : strip)
        for (int k = 1; k <= steps; ++k) {
            double outside = point.y + radius_ * (steps - k + 1) / steps,
                   inside = point.y + radius_ * (steps - k) / steps;
            if (fraction(inside) < half)
                continue;
            for (int halving = 0; halving < 40; ++halving) {
                const double middle = 0.5 * (inside + outside);
                (fraction(middle) >= half ? inside : outside) = middle;
            }
            y = inside;
            return true;
        }
    return false;
}

void Surface::peak(double &x, double &y) const {
    double top = -INFINITY;
    for (const Point &point : points_)
        top = std::max(top, point.y);
    y = -INFINITY;
    // The highest point of the surface lies within half a spacing of a particle near the top.
    for (const Point &point : points_) {
        if (point.y < top - spacing_)
            continue;
        for (double shift : {-0.5, 0.0, 0.5}) {
            double height;
            const double at = point.x + shift * spacing_;
            if (this->height(at, height) && height > y) {
                x = at;
                y = height;
            }
        }
    }
}

bool interface_at(const World &world, int32_t left, int32_t right, double y, double &x) {
    const Particles &p = world.particles;
    const double spacing = world.constants.spacing;
    struct Row {
        double x;
        bool left;
    };
    std::vector<Row> row;
    int64_t wrong = 0; // with the border left of everything: all of `left` is on the wrong side
    for (int64_t i = 0; i < p.count; ++i)
        if (std::abs(p.y[i] - y) <= spacing && (p.column[i] == left || p.column[i] == right)) {
            row.push_back({p.x[i], p.column[i] == left});
            wrong += p.column[i] == left;
        }
    const auto lefts = wrong;
    if (lefts == 0 || lefts == static_cast<int64_t>(row.size()))
        return false;
    std::sort(row.begin(), row.end(), [](const Row &a, const Row &b) { return a.x < b.x; });
    int64_t best = INT64_MAX;
    bool found = false;
    for (std::size_t k = 0; k + 1 < row.size(); ++k) {
        wrong += row[k].left ? -1 : 1;
        if (wrong < best) {
            best = wrong;
            x = 0.5 * (row[k].x + row[k + 1].x);
            found = row[k + 1].x - row[k].x < 2 * spacing; // they touch there
        }
    }
    return found;
}

} // namespace gp
