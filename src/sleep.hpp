// Who rests (gp_config.sleep): blocks of particles whose motion and change of stress have died away, and what the stages have
// to do while they are left out. stages/sleep.cpp says when a block rests and when it wakes; awake.hpp has the loops over what
// is awake.
//
// Blocks are those of parallel.hpp: 64 particles that follow each other in the order of the cell sort. What tells whether
// material rests is kept by particle (Particles::repose), so that it survives a new order.
#pragma once

#include <cstdint>
#include <vector>

#include "exact_sum.hpp"
#include "geometry.hpp"
#include "particles.hpp"

namespace gp {

struct IndexRun {
    int64_t begin, end;
};

// The mean force (N/m) on a plate by a particle that touches it, and the couple (N) beside it: its load while it sleeps.
struct MeanLoad {
    int64_t id; // of the particle
    int32_t plate;
    double x, y, couple;
};

struct Sleep {
    bool in_use = false; // gp_config.sleep
    bool stale = true;   // lists have been made since the next ones were
    bool linked = false; // links are those of the lists
    bool may_rest = false;

    // Of blocks: 1 or 0. reached: restless, or it sees one that is.
    Field<uint8_t> asleep, restless, reached;
    // The blocks whose particles a block sees.
    Field<int32_t> link_start, links, stamp;
    struct Touch {
        int32_t block, plate;
    };
    std::vector<Touch> touches; // who sees ghosts of which plate

    // While some sleep: the blocks that are awake, then those asleep that these see; runs of the contacts of what is awake,
    // and of the ghosts that it sees.
    bool some = false;
    Field<int32_t> lit;
    int64_t awake = 0; // of lit
    std::vector<IndexRun> contacts, ghosts;
    Field<uint8_t> ghost_seen;

    std::vector<MeanLoad> loads, earlier_loads; // by contact
    Field<int32_t> load_of_id;
    std::vector<Vector> pushed;  // N/m, by pushes in this step, by contact
    std::vector<ExactLoad> held; // by what sleeps, on each plate

    bool all() const { return some && awake == 0; }
    int64_t bytes() const {
        return static_cast<int64_t>(
            asleep.capacity() + restless.capacity() + reached.capacity() + ghost_seen.capacity() +
            (link_start.capacity() + links.capacity() + stamp.capacity() + lit.capacity() + load_of_id.capacity()) *
                sizeof(int32_t) +
            touches.capacity() * sizeof(Touch) + (contacts.capacity() + ghosts.capacity()) * sizeof(IndexRun) +
            (loads.capacity() + earlier_loads.capacity()) * sizeof(MeanLoad) + pushed.capacity() * sizeof(Vector) +
            held.capacity() * sizeof(ExactLoad));
    }
};

} // namespace gp
