// Who rests (gp_config.sleep): spans of particles whose motion and change of stress have died away, and what the stages have
// to do while they are left out. stages/sleep.cpp says when a span rests and when it wakes; awake.hpp has the loops over what
// is awake.
//
// A span is what is in a row of cells, in 16 columns counted from the frame's first: some 32 particles that follow each other in
// the order of the cell sort. The frame is that of all particles, whoever works on them, and a span is one process's as a whole:
// so who sleeps does not depend on the processes. With sleep in use spans are the blocks that work is cut into
// (ClusterList::starts). What tells whether material rests is kept by particle (Particles::repose), so that it survives a new
// order.
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

    static constexpr std::size_t numbers = 5;
    void put(double *out) const {
        out[0] = static_cast<double>(id);
        out[1] = plate;
        out[2] = x;
        out[3] = y;
        out[4] = couple;
    }
    static MeanLoad of(const double *in) {
        return {static_cast<int64_t>(in[0]), static_cast<int32_t>(in[1]), in[2], in[3], in[4]};
    }
};

// One of the bits that a double holds; where there are more plates some share one, and wake what touches the other, too.
inline uint64_t plate_bit(int64_t plate) {
    return uint64_t{1} << (plate % 52);
}

struct Sleep {
    bool in_use = false; // gp_config.sleep
    bool stale = true;   // lists have been made since the next ones were
    bool fallen = false; // some have fallen asleep since the work was chosen
    bool may_rest = false;
    bool idle = false; // all sleep, those of all processes

    // The span of each particle and image. Those of other processes' particles are behind the ones here.
    Field<int32_t> span_of;
    int64_t spans = 0, others = 0;
    // Of spans: 1 or 0. reached: restless or beside a plate that acts, or it sees one that is.
    Field<uint8_t> asleep, restless, stirs, reached;
    Field<uint64_t> plates; // whose ghosts a span sees, bit by bit (plate_bit)
    // The spans whose particles a span sees.
    Field<int32_t> link_start, links, stamp;
    int64_t awake_of_all = 1; // spans, those of all processes, after the last step

    // While some sleep: the spans that are awake, then those asleep that these see; runs of the contacts of what is awake,
    // and of the ghosts that it sees.
    bool some = false;
    Field<int32_t> lit;
    int64_t awake = 0; // of lit
    std::vector<IndexRun> contacts, ghosts;
    Field<uint8_t> ghost_seen;

    std::vector<MeanLoad> loads, earlier_loads; // by contact
    std::vector<Vector> pushed;                 // N/m, by pushes in this step, by contact
    std::vector<ExactLoad> held;                // by what sleeps, on each plate

    int64_t bytes() const {
        return static_cast<int64_t>(
            asleep.capacity() + restless.capacity() + stirs.capacity() + reached.capacity() + ghost_seen.capacity() +
            (span_of.capacity() + link_start.capacity() + links.capacity() + stamp.capacity() + lit.capacity()) *
                sizeof(int32_t) +
            plates.capacity() * sizeof(uint64_t) + (contacts.capacity() + ghosts.capacity()) * sizeof(IndexRun) +
            (loads.capacity() + earlier_loads.capacity()) * sizeof(MeanLoad) + pushed.capacity() * sizeof(Vector) +
            held.capacity() * sizeof(ExactLoad));
    }
};

} // namespace gp
