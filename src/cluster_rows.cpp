// The rows of clusters: what each sees, as steps from place to place.
#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <numeric>

#include "clusters.hpp"
#include "error.hpp"
#include "lanes.hpp"
#include "parallel.hpp"

namespace gp {

namespace {

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

// found[k]: 0 for a particle begin + k out of reach of every lane, 1 for one within the radius of some, 3 for a close one.
void test_run(const double *__restrict x, const double *__restrict y, int64_t n, const LanesAt &at, double radius2,
              double close2, int32_t *__restrict found) {
    const LanesAt own = at;
#pragma omp simd
    for (int64_t k = 0; k < n; ++k) {
        double nearest = 1e300;
        for (int l = 0; l < lane_count; ++l) {
            const double dx = x[k] - own.x[l], dy = y[k] - own.y[l];
            const double r2 = dx * dx + dy * dy;
            nearest = r2 < nearest ? r2 : nearest;
        }
        found[k] = nearest < close2 ? 3 : (nearest < radius2 ? 1 : 0);
    }
}

// One cluster's row: close ones from the beginning of its room on, the others from its end down; then these move up.
struct Row {
    int32_t *close, *others;

    void add(int32_t j, int32_t found) {
        *close = j;
        close += found == 3;
        others[-1] = j;
        others -= found == 1;
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
bool look_through(const Particles &p, const Barriers &barriers, double tolerance, int32_t first, int32_t last,
                  const int32_t *row, int64_t n, uint8_t *seen_by) {
    SegmentCells::Run about[lane_count];
    bool any = false, partly = false;
    for (int32_t i = first; i < last; ++i) {
        about[i - first] = barriers.cells.about(p.x[i], p.y[i]);
        any |= !about[i - first].empty();
    }
    if (!any)
        return false;
    for (int64_t k = 0; k < n; ++k) {
        const int32_t j = row[k];
        unsigned lanes = 0;
        for (int32_t i = first; i < last; ++i)
            if (i == j || !separated(barriers, about[i - first], {p.x[i], p.y[i]}, {p.x[j], p.y[j]}, tolerance))
                lanes |= 1u << (i - first);
            else
                partly = true;
        seen_by[k] = static_cast<uint8_t>(lanes);
    }
    return partly;
}

// Finds the rows of some blocks at a time, all of the blocks' in room for all candidates, and then puts them one after the
// other into the list without any: to count what is within the radius would take as long as to find it, and room for what is
// not was two thirds of the list (295 bytes per particle with indices of 32 bits, 81 without that room, 41 as steps).
class RowFinder {
public:
    RowFinder(const Particles &particles, const CellGrid &grid, const Images &images, double radius,
              double close_radius, const Barriers &barriers, double tolerance, int threads, ClusterList &list)
        : p_(particles), grid_(grid), images_(images), radius_(radius), close2_(close_radius * close_radius),
          barriers_(barriers), tolerance_(tolerance), threads_(threads), list_(list) {}

    void find() {
        measure_room();
        const int64_t blocks = block_count(p_.count);
        const int64_t wave = blocks_of_thread * threads_;
        const bool hidden = !barriers_.segments.empty();
        int64_t most = 0;
        for (int64_t block = 0; block < blocks; block += wave)
            most = std::max(most, room_of(block, std::min(blocks, block + wave)));
        ClusterList::Draft &draft = list_.draft;
        draft.index.resize(most);
        draft.seen_by.resize(hidden ? most : 0);
        list_.start[0] = 0;
        for (int64_t block = 0; block < blocks; block += wave) {
            const int64_t end = std::min(blocks, block + wave);
            for_each_block<1>(threads_, end - block,
                              [&](int64_t k, int64_t, int64_t) { draft_block(block, block + k); });
            if (unwalkable_)
                throw make_error(GP_E_DIVERGED, "more than %d particles within %g m of one", longest_step, radius_);
            make_place(block, end);
            for_each_block<1>(threads_, end - block,
                              [&](int64_t k, int64_t, int64_t) { place_block(block, block + k); });
        }
    }

private:
    static constexpr int64_t blocks_of_thread = 8; // as many as a thread needs to be worth its while
    static constexpr int longest_step = INT16_MAX;

    int64_t room_of(int64_t begin, int64_t end) const { return list_.draft.room[end] - list_.draft.room[begin]; }
    Box box_of_reach(int64_t cluster) const {
        return box_of(p_, list_.first[cluster], list_.first[cluster + 1], radius_);
    }

    // Of each block: all candidates of its clusters, and the length of each row.
    void measure_room() {
        Field<int64_t> &room = list_.draft.room;
        const int64_t blocks = block_count(p_.count);
        room.resize(blocks + 1);
        room[0] = 0;
        for_each_block<1>(threads_, blocks, [&](int64_t block, int64_t, int64_t) {
            int64_t most = 0;
            for (int64_t c = list_.cluster_of_block[block]; c < list_.cluster_of_block[block + 1]; ++c) {
                ++most;
                for_each_run(grid_, images_, box_of_reach(c),
                             [&](int64_t from, int64_t to, int) { most += to - from; });
            }
            room[block + 1] = most;
        });
        std::partial_sum(room.begin(), room.end(), room.begin());
    }

    // The rows of a block, each behind its length; and how many steps they take.
    void draft_block(int64_t first_block, int64_t block) {
        ClusterList::Draft &draft = list_.draft;
        int32_t *at = draft.index.data() + room_of(first_block, block);
        int32_t *const end = draft.index.data() + room_of(first_block, block + 1);
        for (int64_t c = list_.cluster_of_block[block]; c < list_.cluster_of_block[block + 1]; ++c) {
            const int64_t first = list_.first[c], last = list_.first[c + 1];
            const LanesAt lanes = lanes_of(c);
            int32_t *const begin = at + 1;
            Row row{begin, end};
            find_row(c, lanes, row);
            const int64_t close = row.close - begin, n = close + (end - row.others);
            if (row.close < row.others) // not where the room is full, or nothing at all
                std::copy(row.others, end, row.close);
            if (!barriers_.segments.empty())
                list_.partly_seen[c] =
                    look_through(p_, barriers_, tolerance_, static_cast<int32_t>(first), static_cast<int32_t>(last),
                                 begin, n, draft.seen_by.data() + (begin - draft.index.data()));
            *at = static_cast<int32_t>(n);
            int64_t steps = n, close_steps = close;
            if (has_long_way(begin, n, static_cast<int32_t>(first))) {
                steps = close_steps = 0;
                walk(begin, n, first, lanes, [&](int32_t, int64_t k) {
                    ++steps;
                    if (k >= 0 && k < close)
                        close_steps = steps;
                });
            }
            list_.start[c + 1] = steps;
            list_.close[c] = static_cast<int32_t>(close_steps);
            at = begin + n;
        }
    }

    void find_row(int64_t cluster, const LanesAt &lanes, Row &row) const {
        int32_t found[chunk];
        const double radius2 = radius_ * radius_;
        for_each_run(grid_, images_, box_of_reach(cluster), [&](int64_t from, int64_t to, int side) {
            if (side >= 0) {
                for (int64_t source = from; source < to; ++source)
                    if (const int32_t j = images_.image_of(source, side); j >= 0) {
                        test_run(p_.x.data() + j, p_.y.data() + j, 1, lanes, radius2, close2_, found);
                        row.add(j, found[0]);
                    }
                return;
            }
            for (int64_t j = from; j < to; j += chunk) {
                const int64_t n = std::min(chunk, to - j);
                test_run(p_.x.data() + j, p_.y.data() + j, n, lanes, radius2, close2_, found);
                for (int64_t k = 0; k < n; ++k)
                    row.add(static_cast<int32_t>(j + k), found[k]);
            }
        });
    }

    static bool has_long_way(const int32_t *row, int64_t n, int32_t first) {
        int32_t longest = n > 0 ? std::abs(row[0] - first) : 0;
        for (int64_t k = 1; k < n; ++k)
            longest = std::max(longest, std::abs(row[k] - row[k - 1]));
        return longest > longest_step;
    }

    // Calls taken(step, k) for the steps along a row; k is -1 for those to places between its entries.
    template <class Taken>
    void walk(const int32_t *row, int64_t n, int64_t first, const LanesAt &lanes, const Taken &taken) {
        int32_t at = static_cast<int32_t>(first);
        for (int64_t k = 0; k < n; ++k) {
            while (std::abs(row[k] - at) > longest_step) {
                const int32_t forth = row[k] > at ? 1 : -1;
                int32_t next = at + forth * longest_step;
                while (next != at && is_seen(next, lanes))
                    next -= forth;
                if (next == at) {
                    unwalkable_ = true;
                    return;
                }
                taken(next - at, -1);
                at = next;
            }
            taken(row[k] - at, k);
            at = row[k];
        }
    }
    bool is_seen(int32_t j, const LanesAt &lanes) const {
        int32_t found;
        test_run(p_.x.data() + j, p_.y.data() + j, 1, lanes, radius_ * radius_, close2_, &found);
        return found != 0;
    }

    // Where the rows of some blocks begin; makes the list long enough.
    void make_place(int64_t begin, int64_t end) {
        const int64_t first = list_.cluster_of_block[begin], last = list_.cluster_of_block[end];
        for (int64_t c = first; c < last; ++c)
            list_.start[c + 1] += list_.start[c];
        const int64_t needed = list_.start[last];
        if (static_cast<int64_t>(list_.step.size()) < needed) {
            // As if all rows were as long as those so far, and some more, so that later lists of about this size fit.
            const double all =
                static_cast<double>(needed) / static_cast<double>(last) * static_cast<double>(list_.count());
            list_.step.reserve(static_cast<std::size_t>(1.04 * all));
            list_.step.resize(list_.step.capacity());
        }
        if (!barriers_.segments.empty())
            list_.seen_by.resize(list_.step.size());
    }

    void place_block(int64_t first_block, int64_t block) {
        const ClusterList::Draft &draft = list_.draft;
        const int32_t *at = draft.index.data() + room_of(first_block, block);
        for (int64_t c = list_.cluster_of_block[block]; c < list_.cluster_of_block[block + 1]; ++c) {
            const int64_t n = *at;
            const int32_t *const row = at + 1;
            const bool partly = !list_.partly_seen.empty() && list_.partly_seen[c];
            int16_t *const steps = list_.step.data() + list_.start[c];
            uint8_t *const seen_by = partly ? list_.seen_by.data() + list_.start[c] : nullptr;
            const uint8_t *const drafted = partly ? draft.seen_by.data() + (row - draft.index.data()) : nullptr;
            if (list_.start[c + 1] - list_.start[c] == n) { // no long ways
                for (int64_t k = 0; k < n; ++k)
                    steps[k] = static_cast<int16_t>(row[k] - (k > 0 ? row[k - 1] : list_.first[c]));
                if (partly)
                    std::copy_n(drafted, n, seen_by);
            } else {
                int64_t entry = 0;
                walk(row, n, list_.first[c], lanes_of(c), [&](int32_t step, int64_t k) {
                    if (partly)
                        seen_by[entry] = k < 0 ? uint8_t{0} : drafted[k];
                    steps[entry++] = static_cast<int16_t>(step);
                });
            }
            at = row + n;
        }
    }

    LanesAt lanes_of(int64_t cluster) const {
        const LanePlaces places(list_.first[cluster], list_.first[cluster + 1]);
        LanesAt lanes;
        for (int l = 0; l < lane_count; ++l) {
            lanes.x[l] = p_.x[places.at[l]];
            lanes.y[l] = p_.y[places.at[l]];
        }
        return lanes;
    }

    const Particles &p_;
    const CellGrid &grid_;
    const Images &images_;
    double radius_, close2_;
    const Barriers &barriers_;
    double tolerance_;
    int threads_;
    ClusterList &list_;
    std::atomic<bool> unwalkable_{false};
};

} // namespace

void find_rows(const Particles &p, const CellGrid &grid, const Images &images, double radius, double close_radius,
               const Barriers &barriers, double tolerance, int threads, ClusterList &list) {
    RowFinder(p, grid, images, radius, close_radius, barriers, tolerance, threads, list).find();
}

} // namespace gp
