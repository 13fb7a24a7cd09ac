#include "clusters.hpp"

#include <algorithm>
#include <numeric>

#include "lanes.hpp"
#include "parallel.hpp"

namespace gp {

int64_t ClusterList::bytes() const {
    std::size_t total = (first.capacity() + cluster_of_block.capacity() + draft.index.capacity()) * sizeof(int32_t) +
                        (draft.room.capacity() + starts.capacity()) * sizeof(int64_t) + partly_seen.capacity() +
                        draft.seen_by.capacity();
    for (const ClusterRows *rows : {&all, &close})
        total += rows->start.capacity() * sizeof(int64_t) + rows->step.capacity() * sizeof(int16_t) +
                 rows->seen_by.capacity();
    return static_cast<int64_t>(total);
}

namespace {

// Particles of a row of cells, next to each other: clusters no wider than this, over the radius, see little in vain.
constexpr double widest_cluster = 0.75;

// Calls body(i) for the first particle of each cluster of a block.
template <class Body>
void for_each_cluster(const Particles &p, const CellGrid &grid, double widest, int64_t begin, int64_t end,
                      const Body &body) {
    for (int64_t i = begin; i < end;) {
        body(static_cast<int32_t>(i));
        const int64_t row = grid.row_of(p.y[i]);
        double low = p.x[i], high = p.x[i];
        int64_t next = i + 1;
        for (; next < end && next < i + lane_count && grid.row_of(p.y[next]) == row; ++next) {
            low = std::min(low, p.x[next]);
            high = std::max(high, p.x[next]);
            if (high - low > widest)
                break;
        }
        i = next;
    }
}

template <class Body> void for_each_block_of(const ClusterList &list, int threads, int64_t count, const Body &body) {
    if (list.starts.empty())
        for_each_block(threads, count, body);
    else
        for_each_block<1>(threads, static_cast<int64_t>(list.starts.size()) - 1, [&](int64_t block, int64_t, int64_t) {
            body(block, list.starts[block], list.starts[block + 1]);
        });
}

void cut(const Particles &p, const CellGrid &grid, double radius, int threads, ClusterList &list) {
    const double widest = widest_cluster * radius;
    Field<int32_t> &of_block = list.cluster_of_block;
    of_block.resize(list.starts.empty() ? block_count(p.count) + 1 : static_cast<int64_t>(list.starts.size()));
    of_block[0] = 0;
    for_each_block_of(list, threads, p.count, [&](int64_t block, int64_t begin, int64_t end) {
        int32_t clusters = 0;
        for_each_cluster(p, grid, widest, begin, end, [&](int32_t) { ++clusters; });
        of_block[block + 1] = clusters;
    });
    std::partial_sum(of_block.begin(), of_block.end(), of_block.begin());
    list.first.resize(of_block.back() + 1);
    for_each_block_of(list, threads, p.count, [&](int64_t block, int64_t begin, int64_t end) {
        int32_t *next = list.first.data() + of_block[block];
        for_each_cluster(p, grid, widest, begin, end, [&](int32_t i) { *next++ = i; });
    });
    list.first.back() = static_cast<int32_t>(p.count);
}

} // namespace

void find_clusters(const Particles &p, const CellGrid &grid, const Images &images, double radius, double close_radius,
                   const Barriers &barriers, double tolerance, int threads, ClusterList &list) {
    cut(p, grid, radius, threads, list);
    const std::size_t count = list.first.size() - 1;
    list.all.start.resize(count + 1);
    list.close.start.resize(count + 1);
    if (barriers.segments.empty())
        list.partly_seen.clear();
    else
        list.partly_seen.resize(count);
    find_rows(p, grid, images, radius, close_radius, barriers, tolerance, threads, list);
}

void find_neighbors(const Particles &p, const ClusterList &clusters, double radius, int threads, NeighborList &list) {
    const int64_t n = p.count;
    const double radius2 = radius * radius;
    const auto visit = [&](int64_t cluster, int64_t i, const auto &found) {
        for_each_seen(clusters, cluster, i, [&](int32_t j) {
            const double dx = p.x[j] - p.x[i], dy = p.y[j] - p.y[i];
            if (dx * dx + dy * dy < radius2)
                found(j);
        });
    };
    list.start.resize(n + 1);
    list.start[0] = 0;
    for_each_block(threads, clusters.count(), [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t c = begin; c < end; ++c)
            for (int64_t i = clusters.first[c]; i < clusters.first[c + 1]; ++i) {
                int64_t all = 0;
                visit(c, i, [&](int32_t) { ++all; });
                list.start[i + 1] = all;
            }
    });
    std::partial_sum(list.start.begin(), list.start.end(), list.start.begin());
    if (static_cast<int64_t>(list.index.size()) < list.start[n])
        list.index.resize(list.start[n] + list.start[n] / 8); // room, so that later lists of about this size fit
    for_each_block(threads, clusters.count(), [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t c = begin; c < end; ++c)
            for (int64_t i = clusters.first[c]; i < clusters.first[c + 1]; ++i) {
                int32_t *next = list.index.data() + list.start[i];
                visit(c, i, [&](int32_t j) { *next++ = j; });
            }
    });
}

} // namespace gp
