// Clusters of up to four particles that are next to each other, and their neighbours.
//
// The pair loops take a cluster at a time, a particle in each lane, and read its neighbours one by one: each is loaded once
// for four particles, without gathers, and the sum of a particle runs over the same neighbours in the same order on any
// processor. What a lane does not need is what its cluster mates see and it does not: about a quarter, of weight 0.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry.hpp"
#include "neighbors.hpp"
#include "periodic.hpp"
#include "segment_cells.hpp"

namespace gp {

// The row of cluster c: the entries start[c] .. start[c + 1], particles and images, in the order of their cells (neighbors.hpp).
//
// It is walked from the cluster's first particle on: step[k] leads from one entry's index to the next one's. A way that no
// step of 16 bits goes is gone in several, over places that none of the cluster sees: they add nothing, like all that is out of
// reach.
struct ClusterRows {
    Field<int64_t> start;
    Field<int16_t> step;
    Field<uint8_t> seen_by; // of partly_seen clusters: which lanes see an entry, bit by bit
};

struct ClusterList {
    // Cluster c holds the particles first[c] .. first[c + 1]. It sees `all`, itself among them, and may collide with `close`: two
    // rows, as a sum over the first has the same order whatever cluster a particle is in. (With the close ones first in one row, as
    // it was, that depended on who else was in it.)
    Field<int32_t> first;
    ClusterRows all, close;
    Field<int32_t>
        cluster_of_block; // the first one of each block of particles; clusters do not reach over a block's end
    // Blocks that are not all of block_size: the first particle of each, and their number; else empty.
    Field<int64_t> starts;

    Field<uint8_t> partly_seen; // by plates with material behind them; empty: there are none

    // Some blocks' rows while they are found: places, and lanes that see them.
    struct Draft {
        Field<int64_t> room; // of the blocks before each one: for all candidates
        Field<int32_t> index;
        Field<uint8_t> seen_by;
    } draft;

    int64_t count() const { return first.empty() ? 0 : static_cast<int64_t>(first.size()) - 1; }
    int64_t blocks() const { return static_cast<int64_t>(cluster_of_block.size()) - 1; } // of lists that have been made
    int64_t bytes() const;
};

// Calls found(k, j) for the entries k of a cluster's row, and their particles or images j.
template <class Found>
void for_each_entry(const ClusterList &list, const ClusterRows &rows, int64_t cluster, const Found &found) {
    int32_t j = list.first[cluster];
    for (int64_t k = rows.start[cluster]; k < rows.start[cluster + 1]; ++k) {
        j += rows.step[k];
        found(k, j);
    }
}

// Plates with material behind them: pairs of particles do not see each other through these.
struct Barriers {
    std::vector<Segment> segments;
    SegmentCells cells; // of those within the radius of the lists
};

// Cuts the sorted particles into clusters and finds, for each, the neighbours within `radius` of one of its particles, and
// those within `close_radius`. Pairs on both sides of one of `barriers` do not
// see each other.
void find_clusters(const Particles &particles, const CellGrid &grid, const Images &images, double radius,
                   double close_radius, const Barriers &barriers, double tolerance, int threads, ClusterList &list);

// The rows of clusters that have been cut (cluster_rows.cpp).
void find_rows(const Particles &particles, const CellGrid &grid, const Images &images, double radius,
               double close_radius, const Barriers &barriers, double tolerance, int threads, ClusterList &list);

// Calls found(j) for the particles and images in the list of particle i's cluster that i sees: all within the radius, and
// some that are not.
template <class Found> void for_each_seen(const ClusterList &list, int64_t cluster, int64_t i, const Found &found) {
    const bool partly = !list.partly_seen.empty() && list.partly_seen[cluster];
    for_each_entry(list, list.all, cluster, [&](int64_t k, int32_t j) {
        if (j != i && (!partly || (list.all.seen_by[k] >> (i - list.first[cluster]) & 1)))
            found(j);
    });
}

// The rows of single particles, from their clusters': exactly the neighbours within the radius.
void find_neighbors(const Particles &particles, const ClusterList &clusters, double radius, int threads,
                    NeighborList &list);

} // namespace gp
