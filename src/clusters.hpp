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
#include "segment_cells.hpp"

namespace gp {

struct ClusterList {
    static constexpr int shells = 3; // of the skin

    // Cluster c holds the particles first[c] .. first[c + 1], and sees the particles and images index[start[c]] .. index[stop[c]],
    // itself among them. Those that may collide with one of it come first, up to close_stop[c]; then those within reach; then
    // those of the skin, shell by shell: the last beyond[s][c] are further away than the reach and s shells, and weigh
    // nothing before particles have moved by as much against each other.
    Field<int32_t> first;
    Field<int64_t> start, close_stop, stop;
    Field<int32_t> index;
    Field<uint16_t> beyond[shells];
    double shell = 0; // m, thickness
    Field<int32_t>
        cluster_of_block; // the first one of each block of particles; clusters do not reach over a block's end

    // Where plates have material behind them: which lanes see an entry, bit by bit, in the rows of partly_seen clusters.
    Field<uint8_t> partly_seen;
    Field<uint8_t> seen_by;

    int64_t count() const { return static_cast<int64_t>(stop.size()); }
    int64_t bytes() const;
};

// Plates with material behind them: pairs of particles do not see each other through these.
struct Barriers {
    std::vector<Segment> segments;
    SegmentCells cells; // of those within the radius of the lists
};

// Cuts the sorted particles into clusters and finds, for each, the neighbours within `radius`, reach and skin, of one of its
// particles; those within `close_radius` of one come first. Pairs on both sides of one of `barriers` do not
// see each other.
void find_clusters(const Particles &particles, const CellGrid &grid, const Images &images, double radius, double skin,
                   double close_radius, const Barriers &barriers, double tolerance, int threads, ClusterList &list);

// Calls found(j) for the particles and images in the list of particle i's cluster that i sees: all within the radius, and
// some that are not.
template <class Found> void for_each_seen(const ClusterList &list, int64_t cluster, int64_t i, const Found &found) {
    const bool partly = !list.partly_seen.empty() && list.partly_seen[cluster];
    for (int64_t k = list.start[cluster]; k < list.stop[cluster]; ++k)
        if (list.index[k] != i && (!partly || (list.seen_by[k] >> (i - list.first[cluster]) & 1)))
            found(list.index[k]);
}

// The rows of single particles, from their clusters': exactly the neighbours within the radius.
void find_neighbors(const Particles &particles, const ClusterList &clusters, double radius, int threads,
                    NeighborList &list);

} // namespace gp
