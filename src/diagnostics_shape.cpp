// The shape of the material: what is connected, the interface of two bodies.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "diagnostics.hpp"

namespace gp {

namespace {

constexpr double link_distance = 1.6; // dl: a little more than the diagonal of the lattice

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
