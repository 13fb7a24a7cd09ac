// The shape of the material: what is connected, the interface of two bodies.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "diagnostics.hpp"

namespace gp {

namespace {

constexpr double link_distance = 1.6; // dl: a little more than the diagonal of the lattice

// Sets of particles, each known by the first of its particles.
class Sets {
public:
    explicit Sets(int64_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
    int32_t root_of(int32_t i) {
        while (parent_[i] != i)
            i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    // Without the way to the root: true tells that i is in the root's set, false tells nothing.
    bool are_near(int32_t i, int32_t root) const { return parent_[i] == root; }
    int32_t unite(int32_t i, int32_t j) { // the new root
        i = root_of(i);
        j = root_of(j);
        return parent_[std::max(i, j)] = std::min(i, j);
    }
    // The root of the set with the most particles; of equal ones that with the smallest id.
    int32_t largest(const Field<int64_t> &id) {
        std::vector<int32_t> size(parent_.size(), 0);
        std::vector<int64_t> smallest(parent_.size(), INT64_MAX);
        int32_t found = 0;
        for (std::size_t i = 0; i < parent_.size(); ++i) {
            const int32_t root = root_of(static_cast<int32_t>(i));
            ++size[root];
            smallest[root] = std::min(smallest[root], id[i]);
        }
        for (std::size_t i = 0; i < parent_.size(); ++i)
            if (size[i] > size[found] || (size[i] == size[found] && smallest[i] < smallest[found]))
                found = static_cast<int32_t>(i);
        return found;
    }

private:
    std::vector<int32_t> parent_;
};

// Links the particles of one cluster with those in its row.
void link_cluster(const World &world, int64_t cluster, const ClusterRows &rows, Sets &sets) {
    const Particles &p = world.particles;
    const ClusterList &list = world.clusters;
    const double link = link_distance * world.constants.spacing;
    const bool partly = !list.partly_seen.empty() && list.partly_seen[cluster];
    for (int32_t place = list.first[cluster]; place < list.first[cluster + 1]; ++place) {
        const auto i = static_cast<int32_t>(world.particle_listed_at(place));
        const double x = p.x[i], y = p.y[i];
        int32_t root = sets.root_of(i);
        for_each_entry(list, rows, cluster, [&](int64_t k, int32_t listed) {
            const int64_t near = world.particle_listed_at(listed);
            const auto j = static_cast<int32_t>(world.images.source(near));
            const double dx = p.x[near] - x, dy = p.y[near] - y;
            if (!sets.are_near(j, root) && dx * dx + dy * dy < link * link &&
                (!partly || (rows.seen_by[k] >> (place - list.first[cluster]) & 1)))
                root = sets.unite(root, j);
        });
    }
}

} // namespace

std::vector<char> connected_deposit(const World &world) {
    const Particles &p = world.particles;
    const ClusterList &clusters = world.clusters;
    Sets sets(p.count);
    // Those that may collide make one set of nearly all; what is left to link then has an end outside of the largest.
    for (int64_t c = 0; c < clusters.count(); ++c)
        link_cluster(world, c, clusters.close, sets);
    const int32_t most = sets.largest(p.id);
    for (int64_t c = 0; c < clusters.count(); ++c)
        for (int32_t place = clusters.first[c]; place < clusters.first[c + 1]; ++place)
            if (sets.root_of(static_cast<int32_t>(world.particle_listed_at(place))) != sets.root_of(most)) {
                link_cluster(world, c, clusters.all, sets);
                break;
            }
    const int32_t largest = sets.largest(p.id);
    std::vector<char> connected(p.count);
    for (int32_t i = 0; i < p.count; ++i)
        connected[i] = sets.root_of(i) == largest;
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
