// The blocks that sleep, and what is left to do beside them (sleep.hpp). sleep.cpp says which these are.
#pragma once

#include <algorithm>

#include "awake.hpp"

namespace gp::stages {

inline int64_t blocks_of(const World &world) {
    return block_count(world.particles.count);
}
template <class Body> void for_each_of(const World &world, int64_t block, const Body &body) {
    const int64_t end = std::min(world.particles.count, (block + 1) * block_size);
    for (int64_t i = block * block_size; i < end; ++i)
        body(i);
}
template <class Found> void for_each_link(const Sleep &s, int64_t block, const Found &found) {
    for (int32_t k = s.link_start[block]; k < s.link_start[block + 1]; ++k)
        found(s.links[k]);
}

// After new lists: blocks of the new order, of which those whose particles have all been quiet for so many seconds are not
// restless; the contacts' loads.
void take_over_blocks(World &world, double quiet_time);
void take_over_contacts(World &world);
// The blocks whose particles a block sees, by the lists of its clusters.
void link_blocks(World &world);
// What there is to do, for the blocks that are awake now.
void choose_work(World &world);
// The memory of a block that changes places with that of the velocity gradient: what is made of nobody.
void clear_exchanged(World &world, int64_t block);

} // namespace gp::stages
