// Who sees what through the surfaces of plates, four at a time: the loops over ghosts take a group of them at once, one in each
// lane, as the pair loops take clusters of particles (clusters.hpp). A group's row is what any of its lanes sees, in the order in
// which each lane's own row has it, with the lanes that do.
#pragma once

#include <cstdint>

#include "lanes.hpp"
#include "particles.hpp"

namespace gp {

class CellGrid;
struct ClusterList;
class Images;
struct Walls;

struct LaneRows {
    Field<int32_t> start; // entries of group g: start[g] .. start[g + 1]
    Field<int32_t> index;
    Field<uint8_t> seen_by; // bit l: lane l sees the entry

    struct Row {
        const int32_t *next = nullptr, *end = nullptr;
    };

    int64_t bytes() const {
        return static_cast<int64_t>((start.capacity() + index.capacity()) * sizeof(int32_t) + seen_by.capacity());
    }
    void clear();
    void add(Row (&rows)[lane_count]); // one more group; uses the rows up
};

// Contacts of particles of one cluster with one chain, in the lanes of their particles; -1 where a lane has none.
struct ContactGroup {
    int32_t contact[lane_count];
};

struct WallLanes {
    LaneRows particles_of_ghosts; // group g: of the ghosts 4 g .. 4 g + 3; particles and images
    LaneRows ghosts_of_contacts;  // group g: of contacts[g]
    Field<ContactGroup> contacts; // cluster by cluster, of each in the order of its particles' contacts
    Field<int32_t> of_cluster;    // groups of cluster c: of_cluster[c] .. of_cluster[c + 1]

    int64_t bytes() const;
    void make(const Walls &walls, const ClusterList &clusters, const CellGrid &grid, const Images &images);

private:
    void make_rows_of_ghosts(const Walls &walls, const CellGrid &grid, const Images &images);

    // With images, that lie before and between the particles in the order of cells: which is the how many-th there.
    Field<int32_t> number_of_, of_number_, numbers_;
};

} // namespace gp
