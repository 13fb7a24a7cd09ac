// The shape of the material: what is connected, the interface of two bodies.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "diagnostics.hpp"
#include "parts.hpp"
#include "stretches.hpp"

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

// Calls linked(i, near) for the particles of one cluster and those in its row to which they are linked, but for those of which it is
// known; near: an index of the lists, of a particle or an image.
template <class Known, class Linked>
void for_each_link(const World &world, int64_t cluster, const ClusterRows &rows, const Known &known,
                   const Linked &linked) {
    const Particles &p = world.particles;
    const ClusterList &list = world.clusters;
    const double link = link_distance * world.constants.spacing;
    const bool partly = !list.partly_seen.empty() && list.partly_seen[cluster];
    for (int32_t place = list.first[cluster]; place < list.first[cluster + 1]; ++place) {
        const auto i = static_cast<int32_t>(world.particle_listed_at(place));
        const double x = p.x[i], y = p.y[i];
        for_each_entry(list, rows, cluster, [&](int64_t k, int32_t listed) {
            const int64_t near = world.particle_listed_at(listed);
            const double dx = p.x[near] - x, dy = p.y[near] - y;
            if (!known(i, near) && dx * dx + dy * dy < link * link &&
                (!partly || (rows.seen_by[k] >> (place - list.first[cluster]) & 1)))
                linked(i, near);
        });
    }
}

// Links the particles of one cluster with those in its row; of a part of a world not with those of other processes.
void link_cluster(const World &world, int64_t cluster, const ClusterRows &rows, Sets &sets) {
    const int64_t others = world.crossing ? world.particles.count : INT64_MAX;
    int32_t of = -1, root = -1;
    const auto is_known = [&](int32_t i, int64_t near) {
        if (of != i) {
            of = i;
            root = sets.root_of(i);
        }
        return near >= others || sets.are_near(static_cast<int32_t>(world.images.source(near)), root);
    };
    for_each_link(world, cluster, rows, is_known, [&](int32_t, int64_t near) {
        root = sets.unite(root, static_cast<int32_t>(world.images.source(near)));
    });
}

bool sees_others(const World &world, int64_t cluster) {
    bool found = false;
    for_each_entry(world.clusters, world.clusters.all, cluster,
                   [&](int64_t, int32_t near) { found = found || near >= world.particles.count; });
    return found;
}

// The sets of this process's particles.
Sets link_all(const World &world) {
    const ClusterList &clusters = world.clusters;
    Sets sets(world.particles.count);
    // Those that may collide make one set of nearly all; what is left to link then has an end outside of the largest.
    for (int64_t c = 0; c < clusters.count(); ++c)
        link_cluster(world, c, clusters.close, sets);
    const int32_t most = sets.largest(world.particles.id);
    for (int64_t c = 0; c < clusters.count(); ++c)
        for (int32_t place = clusters.first[c]; place < clusters.first[c + 1]; ++place)
            if (sets.root_of(static_cast<int32_t>(world.particle_listed_at(place))) != sets.root_of(most)) {
                link_cluster(world, c, clusters.all, sets);
                break;
            }
    return sets;
}

// A set of one process's particles: label is the id of one of them.
struct PartOfSet {
    double label, size, smallest_id;
    bool operator<(const PartOfSet &other) const { return label < other.label; }
};
struct Link {
    double a, b; // labels
    bool operator<(const Link &other) const { return a != other.a ? a < other.a : b < other.b; }
    bool operator==(const Link &other) const { return a == other.a && b == other.b; }
};

// The labels, in order, that together are the largest set.
std::vector<double> labels_of_largest(std::vector<PartOfSet> parts, const std::vector<Link> &links) {
    std::vector<double> labels;
    if (parts.empty())
        return labels;
    std::sort(parts.begin(), parts.end());
    const auto place_of = [&](double label) {
        return static_cast<int32_t>(std::lower_bound(parts.begin(), parts.end(), PartOfSet{label, 0, 0}) -
                                    parts.begin());
    };
    Sets sets(static_cast<int64_t>(parts.size()));
    for (const Link &link : links)
        sets.unite(place_of(link.a), place_of(link.b));
    std::vector<PartOfSet> whole = parts;
    std::size_t found = 0;
    for (std::size_t k = 0; k < parts.size(); ++k)
        if (const auto root = static_cast<std::size_t>(sets.root_of(static_cast<int32_t>(k))); root != k) {
            whole[root].size += parts[k].size;
            whole[root].smallest_id = std::min(whole[root].smallest_id, parts[k].smallest_id);
            whole[k].size = 0;
        }
    for (std::size_t k = 0; k < whole.size(); ++k)
        if (whole[k].size > whole[found].size ||
            (whole[k].size == whole[found].size && whole[k].smallest_id < whole[found].smallest_id))
            found = k;
    for (std::size_t k = 0; k < parts.size(); ++k)
        if (sets.root_of(static_cast<int32_t>(k)) == sets.root_of(static_cast<int32_t>(found)))
            labels.push_back(parts[k].label);
    return labels;
}

// Each process links its own; the first one links their sets, by the links across.
std::vector<char> connected_deposit_of_parts(const World &world) {
    const Particles &p = world.particles;
    Crossing &crossing = *world.crossing;
    Sets sets = link_all(world);
    Field<double> label(static_cast<std::size_t>(p.count + world.images.count));
    std::vector<PartOfSet> parts;
    std::vector<std::size_t> part_of(static_cast<std::size_t>(p.count));
    for (int64_t i = 0; i < p.count; ++i) { // a root is the first of its set
        const int32_t root = sets.root_of(static_cast<int32_t>(i));
        const auto id = static_cast<double>(p.id[i]);
        if (root == i) {
            part_of[i] = parts.size();
            parts.push_back({id, 0, id});
        }
        part_of[i] = part_of[root];
        PartOfSet &part = parts[part_of[i]];
        ++part.size;
        part.smallest_id = std::min(part.smallest_id, id);
        label[i] = part.label;
    }
    world.images.copy(label);
    std::vector<Link> links;
    for (int64_t c = 0; c < world.clusters.count(); ++c)
        if (sees_others(world, c))
            for_each_link(
                world, c, world.clusters.all, [&](int32_t, int64_t near) { return near < p.count; },
                [&](int32_t i, int64_t near) {
                    links.push_back({label[i], label[near]});
                });
    std::sort(links.begin(), links.end());
    links.erase(std::unique(links.begin(), links.end()), links.end());
    collect(&crossing, links);
    collect(&crossing, parts);
    std::vector<double> largest;
    on_first(world, [&] { largest = labels_of_largest(parts, links); });
    tell_all_of(crossing, largest);
    std::vector<char> connected(static_cast<std::size_t>(p.count));
    for (int64_t i = 0; i < p.count; ++i)
        connected[i] = std::binary_search(largest.begin(), largest.end(), label[i]);
    return connected;
}

} // namespace

std::vector<char> connected_deposit(const World &world) {
    if (world.crossing)
        return connected_deposit_of_parts(world);
    Sets sets = link_all(world);
    const int32_t largest = sets.largest(world.particles.id);
    std::vector<char> connected(world.particles.count);
    for (int32_t i = 0; i < world.particles.count; ++i)
        connected[i] = sets.root_of(i) == largest;
    return connected;
}

namespace {

struct BesideInterface {
    double x;
    bool left;
};

// NaN where the bodies do not touch. row: what lies at one height.
double interface_in(std::vector<BesideInterface> &row, double spacing) {
    const auto lefts = std::count_if(row.begin(), row.end(), [](const BesideInterface &one) { return one.left; });
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    if (lefts == 0 || lefts == static_cast<std::ptrdiff_t>(row.size()))
        return none;
    std::sort(row.begin(), row.end(), [](const BesideInterface &a, const BesideInterface &b) { return a.x < b.x; });
    auto wrong = lefts,
         best = std::numeric_limits<std::ptrdiff_t>::max(); // the border left of everything: all of `left`
    double x = none;
    for (std::size_t k = 0; k + 1 < row.size(); ++k) {
        wrong += row[k].left ? -1 : 1;
        if (wrong < best) {
            best = wrong;
            const bool touch = row[k + 1].x - row[k].x < 2 * spacing;
            x = touch ? 0.5 * (row[k].x + row[k + 1].x) : none;
        }
    }
    return x;
}

} // namespace

void find_interface(const World &world, int32_t left, int32_t right, int64_t n, const double *y, double *x) {
    const double spacing = world.constants.spacing;
    std::vector<std::vector<BesideInterface>> rows(static_cast<std::size_t>(n));
    for_each_stretch(world, {}, [&](const World &stretch, const char *) {
        const Particles &p = stretch.particles;
        for (int64_t i = 0; i < p.count; ++i)
            if (p.column[i] == left || p.column[i] == right)
                for (int64_t k = 0; k < n; ++k)
                    if (std::abs(p.y[i] - y[k]) <= spacing)
                        rows[k].push_back({p.x[i], p.column[i] == left});
    });
    for (int64_t k = 0; k < n; ++k)
        x[k] = interface_in(rows[k], spacing);
}

} // namespace gp
