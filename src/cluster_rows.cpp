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

// A row while it is found: its places, those of close ones with all bits turned, without branches.
struct Row {
    int32_t *end;
    int64_t close = 0;

    void add(int32_t j, int32_t found) {
        const int32_t is_close = found >> 1;
        *end = j ^ -is_close;
        end += found & 1;
        close += is_close;
    }
};

int32_t place_of(int32_t entry) {
    return entry ^ (entry >> 31);
}

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
        const int32_t j = place_of(row[k]);
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
        const int64_t blocks = list_.blocks();
        const int64_t wave = std::max(blocks_of_thread * threads_, threads_ > 1 ? blocks_of_several : 0);
        const bool hidden = !barriers_.segments.empty();
        int64_t most = 0;
        for (int64_t block = 0; block < blocks; block += wave)
            most = std::max(most, room_of(block, std::min(blocks, block + wave)));
        ClusterList::Draft &draft = list_.draft;
        draft.index.resize(most);
        draft.seen_by.resize(hidden ? most : 0);
        list_.all.start[0] = list_.close.start[0] = 0;
        for (int64_t block = 0; block < blocks; block += wave) {
            const int64_t end = std::min(blocks, block + wave);
            for_each_block<1>(threads_, end - block,
                              [&](int64_t k, int64_t, int64_t) { draft_block(block, block + k); });
            if (unwalkable_)
                throw make_error(GP_E_DIVERGED, "more than %d particles within %g m of one", longest_step, radius_);
            make_place(list_.all, block, end);
            make_place(list_.close, block, end);
            for_each_block<1>(threads_, end - block,
                              [&](int64_t k, int64_t, int64_t) { place_block(block, block + k); });
        }
    }

private:
    // As many as a thread needs to be worth its while, and is to find in its cache when they are put down. Of several threads each
    // waits for the last, twice for these: they have some more.
    static constexpr int64_t blocks_of_thread = 8, blocks_of_several = 32;
    static constexpr int longest_step = INT16_MAX;

    int64_t room_of(int64_t begin, int64_t end) const { return list_.draft.room[end] - list_.draft.room[begin]; }
    Box box_of_reach(int64_t cluster) const {
        return box_of(p_, list_.first[cluster], list_.first[cluster + 1], radius_);
    }

    // Of each block: all candidates of its clusters, the length of each row, and a place more: what is out of reach is written, too,
    // before that is told.
    void measure_room() {
        Field<int64_t> &room = list_.draft.room;
        const int64_t blocks = list_.blocks();
        room.resize(blocks + 1);
        room[0] = 0;
        for_each_block<1>(threads_, blocks, [&](int64_t block, int64_t, int64_t) {
            int64_t most = 0;
            for (int64_t c = list_.cluster_of_block[block]; c < list_.cluster_of_block[block + 1]; ++c) {
                most += 2;
                for_each_run_in(grid_, images_, box_of_reach(c), [&](int64_t from, int64_t to) { most += to - from; });
            }
            room[block + 1] = most;
        });
        std::partial_sum(room.begin(), room.end(), room.begin());
    }

    // The rows of a block, each behind its length, with all bits turned where it may have long ways; and how many steps they take.
    void draft_block(int64_t first_block, int64_t block) {
        ClusterList::Draft &draft = list_.draft;
        int32_t *at = draft.index.data() + room_of(first_block, block);
        for (int64_t c = list_.cluster_of_block[block]; c < list_.cluster_of_block[block + 1]; ++c) {
            const LanesAt lanes = lanes_of(c);
            int32_t *const begin = at + 1;
            Row row{begin};
            find_row(c, lanes, row);
            const int64_t n = row.end - begin;
            if (!barriers_.segments.empty())
                list_.partly_seen[c] = look_through(p_, barriers_, tolerance_, list_.first[c], list_.first[c + 1],
                                                    begin, n, draft.seen_by.data() + (begin - draft.index.data()));
            const bool may_be_long = may_have_long_way(begin, n, list_.first[c]);
            *at = static_cast<int32_t>(may_be_long ? ~n : n);
            int64_t steps = n, close_steps = row.close;
            if (may_be_long) {
                steps = close_steps = 0;
                walk(begin, n, false, c, lanes, [&](int32_t, int64_t) { ++steps; });
                walk(begin, n, true, c, lanes, [&](int32_t, int64_t) { ++close_steps; });
            }
            list_.all.start[c + 1] = steps;
            list_.close.start[c + 1] = close_steps;
            at = begin + n;
        }
    }

    void find_row(int64_t cluster, const LanesAt &lanes, Row &row) const {
        int32_t found[chunk];
        const double radius2 = radius_ * radius_;
        for_each_run_in(grid_, images_, box_of_reach(cluster), [&](int64_t from, int64_t to) {
            for (int64_t j = from; j < to; j += chunk) {
                const int64_t n = std::min(chunk, to - j);
                test_run(p_.x.data() + j, p_.y.data() + j, n, lanes, radius2, close2_, found);
                for (int64_t k = 0; k < n; ++k)
                    row.add(static_cast<int32_t>(j + k), found[k]);
            }
        });
    }

    static bool may_have_long_way(const int32_t *row, int64_t n, int32_t first) {
        int32_t low = first, high = first;
        for (int64_t k = 0; k < n; ++k) {
            low = std::min(low, place_of(row[k]));
            high = std::max(high, place_of(row[k]));
        }
        return high - low > longest_step;
    }

    // Calls taken(step, k) for the steps along a row, or the close ones in it; k is -1 for those to places between its entries.
    template <class Taken>
    void walk(const int32_t *row, int64_t n, bool close, int64_t cluster, const LanesAt &lanes, const Taken &taken) {
        int32_t at = list_.first[cluster];
        for (int64_t k = 0; k < n; ++k) {
            if (close && row[k] >= 0)
                continue;
            const int32_t j = place_of(row[k]);
            while (std::abs(j - at) > longest_step) {
                const int32_t forth = j > at ? 1 : -1;
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
            taken(j - at, k);
            at = j;
        }
    }
    bool is_seen(int32_t j, const LanesAt &lanes) const {
        int32_t found;
        test_run(p_.x.data() + j, p_.y.data() + j, 1, lanes, radius_ * radius_, close2_, &found);
        return found != 0;
    }

    // Where the rows of some blocks begin; makes the list long enough.
    void make_place(ClusterRows &rows, int64_t begin, int64_t end) {
        const int64_t first = list_.cluster_of_block[begin], last = list_.cluster_of_block[end];
        for (int64_t c = first; c < last; ++c)
            rows.start[c + 1] += rows.start[c];
        const int64_t needed = rows.start[last];
        if (static_cast<int64_t>(rows.step.size()) < needed) {
            // As if all rows were as long as those so far, and some more, so that later lists of about this size fit.
            const double all =
                static_cast<double>(needed) / static_cast<double>(last) * static_cast<double>(list_.count());
            rows.step.reserve(static_cast<std::size_t>(1.04 * all));
            rows.step.resize(rows.step.capacity());
        }
        if (!barriers_.segments.empty())
            rows.seen_by.resize(rows.step.size());
    }

    void place_block(int64_t first_block, int64_t block) {
        const int32_t *at = list_.draft.index.data() + room_of(first_block, block);
        for (int64_t c = list_.cluster_of_block[block]; c < list_.cluster_of_block[block + 1]; ++c) {
            const bool may_be_long = *at < 0;
            const int64_t n = may_be_long ? ~*at : *at;
            if (may_be_long || (!list_.partly_seen.empty() && list_.partly_seen[c])) {
                walk_row(list_.all, false, c, at + 1, n);
                walk_row(list_.close, true, c, at + 1, n);
            } else {
                place_row(c, at + 1, n);
            }
            at += 1 + n;
        }
    }

    // Both rows of a cluster, step by step; without branches, since which entries are close no processor foresees.
    void place_row(int64_t c, const int32_t *__restrict row, int64_t n) {
        const int32_t first = list_.first[c];
        int16_t *__restrict step = list_.all.step.data() + list_.all.start[c];
        step[0] = static_cast<int16_t>(place_of(row[0]) - first);
        for (int64_t k = 1; k < n; ++k)
            step[k] = static_cast<int16_t>(place_of(row[k]) - place_of(row[k - 1]));
        step = list_.close.step.data() + list_.close.start[c];
        const int16_t *const end = list_.close.step.data() + list_.close.start[c + 1];
        int32_t at = first;
        for (int64_t k = 0; step < end; ++k) { // what is not close is written, too, and then what follows in its place
            const int32_t is_close = row[k] >> 31, j = row[k] ^ is_close;
            *step = static_cast<int16_t>(j - at);
            step -= is_close;
            at += is_close & (j - at);
        }
    }

    // A row some of whose entries not all of its lanes see, or with long ways.
    void walk_row(ClusterRows &rows, bool close, int64_t c, const int32_t *row, int64_t n) {
        const bool partly = !list_.partly_seen.empty() && list_.partly_seen[c];
        int16_t *const steps = rows.step.data() + rows.start[c];
        uint8_t *const seen_by = partly ? rows.seen_by.data() + rows.start[c] : nullptr;
        const uint8_t *const drafted = partly ? list_.draft.seen_by.data() + (row - list_.draft.index.data()) : nullptr;
        int64_t entry = 0;
        walk(row, n, close, c, lanes_of(c), [&](int32_t step, int64_t k) {
            if (partly)
                seen_by[entry] = k < 0 ? uint8_t{0} : drafted[k];
            steps[entry++] = static_cast<int16_t>(step);
        });
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
