#include "clusters.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>

#include "lanes.hpp"
#include "parallel.hpp"

namespace gp {

int64_t ClusterList::bytes() const {
    return static_cast<int64_t>((first.capacity() + index.capacity() + cluster_of_block.capacity()) * sizeof(int32_t) +
                                (start.capacity() + close_stop.capacity() + stop.capacity()) * sizeof(int64_t) +
                                beyond[0].capacity() * shells * sizeof(uint16_t) + partly_seen.capacity() +
                                seen_by.capacity());
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

void cut(const Particles &p, const CellGrid &grid, double radius, int threads, ClusterList &list) {
    const double widest = widest_cluster * radius;
    Field<int32_t> &of_block = list.cluster_of_block;
    of_block.resize(block_count(p.count) + 1);
    of_block[0] = 0;
    for_each_block(threads, p.count, [&](int64_t block, int64_t begin, int64_t end) {
        int32_t clusters = 0;
        for_each_cluster(p, grid, widest, begin, end, [&](int32_t) { ++clusters; });
        of_block[block + 1] = clusters;
    });
    std::partial_sum(of_block.begin(), of_block.end(), of_block.begin());
    list.first.resize(of_block.back() + 1);
    for_each_block(threads, p.count, [&](int64_t block, int64_t begin, int64_t end) {
        int32_t *next = list.first.data() + of_block[block];
        for_each_cluster(p, grid, widest, begin, end, [&](int32_t i) { *next++ = i; });
    });
    list.first.back() = static_cast<int32_t>(p.count);
}

// Calls body(begin, end, side) for the runs of candidates about a cluster: of particles (side -1) and of those whose images
// on a side of the period count.
template <class Body> void for_each_run(const CellGrid &grid, const Images &images, const Box &box, const Body &body) {
    grid.for_each_run(box, [&](int64_t begin, int64_t end) { body(begin, end, -1); });
    if (images.count == 0)
        return;
    for (int side = 0; side < 2; ++side) {
        const double shift = images.shift(side);
        grid.for_each_run({box.x_min - shift, box.x_max - shift, box.y_min, box.y_max},
                          [&](int64_t begin, int64_t end) { body(begin, end, side); });
    }
}

constexpr int64_t chunk = 64;

struct LanesAt {
    double x[lane_count], y[lane_count];
};

// Squares of the distances at which the shells of a row begin, and of the close ones' end and the radius.
struct Distances {
    double close2, shell2[ClusterList::shells], radius2;
};

// What a candidate is, in bits that add up without branches, which no processor foretells here: close; other, within reach; or of
// the skin, with the number of its shell above, from 1 on.
constexpr int32_t found_close = 1, found_other = 2, found_aside = 4, one_shell = 8;

typedef int64_t LaneInts __attribute__((vector_size(lane_count * sizeof(int64_t))));
typedef int32_t LaneKinds __attribute__((vector_size(lane_count * sizeof(int32_t))));

// found[k]: of particle begin + k, by its distance to the nearest lane. (Four particles at a time: most runs are of a dozen or
// so, of which longer vectors left half to single ones.) Writes up to a multiple of four.
void test_run(const double *__restrict x, const double *__restrict y, int64_t n, const LanesAt &at, const Distances &d,
              int32_t *__restrict found) {
    for (int64_t k = 0; k < n; k += lane_count) {
        Lanes xk, yk;
        if (k + lane_count <= n) {
            std::memcpy(&xk, x + k, sizeof xk);
            std::memcpy(&yk, y + k, sizeof yk);
        } else {
            const LanePlaces places(k, n);
            xk = places.load(x);
            yk = places.load(y);
        }
        Lanes nearest = Lanes{} + 1e300;
        for (int l = 0; l < lane_count; ++l) {
            const Lanes dx = xk - at.x[l], dy = yk - at.y[l];
            const Lanes r2 = dx * dx + dy * dy;
            nearest = r2 < nearest ? r2 : nearest;
        }
        LaneInts kind = LaneInts{} + found_aside;
        for (int s = 0; s < ClusterList::shells; ++s)
            kind -= (nearest >= d.shell2[s]) * one_shell;
        kind = nearest < d.shell2[0] ? LaneInts{} + found_other : kind;
        kind = nearest < d.radius2 ? kind : LaneInts{};
        kind = nearest < d.close2 ? LaneInts{} + found_close : kind;
        const LaneKinds kinds = __builtin_convertvector(kind, LaneKinds);
        std::memcpy(found + k, &kinds, sizeof kinds);
    }
}

// One cluster's row: close ones from the beginning of its room on, those within reach from its end down, and aside those of the
// skin.
struct Row {
    static constexpr int64_t most_aside = 1024; // of a row with more, the others count as within reach
    int32_t *close, *others;
    int64_t aside = 0;
    int32_t place_aside[most_aside], shell_aside[most_aside];

    Row(int32_t *begin, int32_t *end) : close(begin), others(end) {}

    void add(int32_t j, int32_t n, int32_t *found) {
        if (aside + n >= most_aside)
            for (int32_t k = 0; k < n; ++k)
                found[k] = found[k] & found_aside ? found_other : found[k];
        for (int32_t k = 0; k < n; ++k) {
            const int32_t kind = found[k];
            *close = j + k;
            close += kind & 1;
            others[-1] = j + k;
            others -= kind >> 1 & 1;
            place_aside[aside] = j + k;
            shell_aside[aside] = kind / one_shell;
            aside += kind >> 2 & 1;
        }
    }

    // Puts the others behind the close ones, then those of the skin, shell by shell. beyond[s]: how many are further away than
    // the reach and s shells. Returns the row's end.
    int32_t *settle(int32_t *end, int64_t (&beyond)[ClusterList::shells]) {
        int32_t *next = close + (end - others);
        if (close < others) // not where the room is full, or nothing at all
            std::copy(others, end, close);
        int32_t in_order[most_aside];
        int64_t n = 0;
        for (int32_t s = 0; s < ClusterList::shells; ++s) {
            beyond[s] = aside - n;
            for (int64_t k = 0; k < aside; ++k) {
                in_order[n] = place_aside[k];
                n += shell_aside[k] == s + 1;
            }
        }
        return std::copy(in_order, in_order + aside, next);
    }
};

Box box_of(const Particles &p, int64_t first, int64_t last, double margin) {
    Box box{p.x[first], p.x[first], p.y[first], p.y[first]};
    for (int64_t i = first + 1; i < last; ++i) {
        box.x_min = std::min(box.x_min, p.x[i]);
        box.x_max = std::max(box.x_max, p.x[i]);
        box.y_min = std::min(box.y_min, p.y[i]);
        box.y_max = std::max(box.y_max, p.y[i]);
    }
    return {box.x_min - margin, box.x_max + margin, box.y_min - margin, box.y_max + margin};
}

bool separated(const Barriers &barriers, const SegmentCells::Run &about, const Vector &a, const Vector &b,
               double tolerance) {
    return std::any_of(about.begin(), about.end(), [&](int32_t k) {
        const Segment &barrier = barriers.segments[k];
        return crossing(barrier, a, b, tolerance) >= 0 || crossing(barrier, b, a, tolerance) >= 0;
    });
}

// Which lanes see what of a row; true if not all see all.
bool look_through(const Particles &p, const Barriers &barriers, double tolerance, int64_t cluster, ClusterList &list) {
    SegmentCells::Run about[lane_count];
    bool any = false, partly = false;
    for (int32_t i = list.first[cluster], l = 0; i < list.first[cluster + 1]; ++i, ++l) {
        about[l] = barriers.cells.about(p.x[i], p.y[i]);
        any |= !about[l].empty();
    }
    if (!any)
        return false;
    for (int64_t k = list.start[cluster]; k < list.stop[cluster]; ++k) {
        const int32_t j = list.index[k];
        unsigned lanes = 0;
        for (int32_t i = list.first[cluster], l = 0; i < list.first[cluster + 1]; ++i, ++l)
            if (i == j || !separated(barriers, about[l], {p.x[i], p.y[i]}, {p.x[j], p.y[j]}, tolerance))
                lanes |= 1u << l;
            else
                partly = true;
        list.seen_by[k] = static_cast<uint8_t>(lanes);
    }
    return partly;
}

} // namespace

void find_clusters(const Particles &p, const CellGrid &grid, const Images &images, double radius, double skin,
                   double close_radius, const Barriers &barriers, double tolerance, int threads, ClusterList &list) {
    cut(p, grid, radius, threads, list);
    const int64_t count = static_cast<int64_t>(list.first.size()) - 1;
    list.shell = skin / ClusterList::shells;
    Distances distances{close_radius * close_radius, {}, radius * radius};
    for (int s = 0; s < ClusterList::shells; ++s) {
        const double begin =
            (radius - skin + s * list.shell) * (1 + 1e-9); // no rounding puts what has weight behind it
        distances.shell2[s] = begin * begin;
        list.beyond[s].resize(count);
    }
    list.start.resize(count + 1);
    list.close_stop.resize(count);
    list.stop.resize(count);
    // Room for all candidates: to count those within the radius would take as long as to list them.
    list.start[0] = 0;
    for_each_block(threads, count, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t c = begin; c < end; ++c) {
            int64_t most = 0;
            for_each_run(grid, images, box_of(p, list.first[c], list.first[c + 1], radius),
                         [&](int64_t from, int64_t to, int) { most += to - from; });
            list.start[c + 1] = most;
        }
    });
    std::partial_sum(list.start.begin(), list.start.end(), list.start.begin());
    if (static_cast<int64_t>(list.index.size()) < list.start[count])
        list.index.resize(list.start[count] + list.start[count] / 8); // so that later lists of about this size fit
    if (barriers.segments.empty()) {
        list.partly_seen.clear();
    } else {
        list.partly_seen.resize(count);
        list.seen_by.resize(list.index.size());
    }
    for_each_block(threads, count, [&](int64_t, int64_t begin, int64_t end) {
        int32_t found[chunk];
        for (int64_t c = begin; c < end; ++c) {
            const int64_t first = list.first[c], last = list.first[c + 1];
            const LanePlaces places(first, last);
            LanesAt at;
            for (int l = 0; l < lane_count; ++l) {
                at.x[l] = p.x[places.at[l]];
                at.y[l] = p.y[places.at[l]];
            }
            int32_t *const row_begin = list.index.data() + list.start[c];
            int32_t *const row_end = list.index.data() + list.start[c + 1];
            Row row(row_begin, row_end);
            for_each_run(grid, images, box_of(p, first, last, radius), [&](int64_t from, int64_t to, int side) {
                if (side >= 0) {
                    for (int64_t source = from; source < to; ++source)
                        if (const int32_t j = images.image_of(source, side); j >= 0) {
                            test_run(p.x.data() + j, p.y.data() + j, 1, at, distances, found);
                            row.add(j, 1, found);
                        }
                    return;
                }
                for (int64_t j = from; j < to; j += chunk) {
                    const int64_t n = std::min(chunk, to - j);
                    test_run(p.x.data() + j, p.y.data() + j, n, at, distances, found);
                    row.add(static_cast<int32_t>(j), static_cast<int32_t>(n), found);
                }
            });
            list.close_stop[c] = row.close - list.index.data();
            int64_t beyond[ClusterList::shells];
            list.stop[c] = row.settle(row_end, beyond) - list.index.data();
            for (int s = 0; s < ClusterList::shells; ++s) // as if fewer, where they are more than fit
                list.beyond[s][c] = static_cast<uint16_t>(std::min<int64_t>(beyond[s], UINT16_MAX));
            if (!barriers.segments.empty())
                list.partly_seen[c] = look_through(p, barriers, tolerance, c, list);
        }
    });
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
