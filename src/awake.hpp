// Loops over what is awake (sleep.hpp): over all where nothing sleeps.
#pragma once

#include "parallel.hpp"
#include "world.hpp"

namespace gp {

// Calls body(block, begin, end) for the blocks of particles that are awake. (Loops of their own where nothing sleeps: one for
// both had an instruction more for each particle.)
template <class Body> void for_each_awake_block(const World &world, const Body &body) {
    const Sleep &s = world.sleep;
    if (s.some)
        for_each_chosen_block(world.threads, world.particles.count, s.lit.data(), s.awake, body);
    else
        for_each_block(world.threads, world.particles.count, body);
}

// And of those asleep that these see: what neighbours read of a particle and no pair loop makes.
template <class Body> void for_each_seen_block(const World &world, const Body &body) {
    const Sleep &s = world.sleep;
    if (s.some)
        for_each_chosen_block(world.threads, world.particles.count, s.lit.data(), static_cast<int64_t>(s.lit.size()),
                              body);
    else
        for_each_block(world.threads, world.particles.count, body);
}

// Makes fields of all that is seen: make(begin, end). They follow from what images have, too, so that those of other processes'
// particles need no message; others are copied.
template <class Make>
void make_for_neighbors(World &world, std::initializer_list<Field<double> *> fields, const Make &make) {
    for_each_seen_block(world, [&](int64_t, int64_t begin, int64_t end) { make(begin, end); });
    const int64_t first = world.particles.count;
    if (world.crossing)
        make(first, first + world.images.count);
    else if (world.images.count > 0)
        world.images.copy(fields);
}

// Calls body(begin, end) for runs of the ghosts that what is awake sees: few at a time.
template <class Body> void for_each_awake_ghost_run(const World &world, const Body &body) {
    const std::vector<IndexRun> &runs = world.sleep.ghosts;
    if (world.sleep.some)
        for_each_block<1>(world.threads, static_cast<int64_t>(runs.size()),
                          [&](int64_t k, int64_t, int64_t) { body(runs[k].begin, runs[k].end); });
    else
        for_each_block<ghost_block_size>(world.threads, world.walls.ghost_count,
                                         [&](int64_t, int64_t begin, int64_t end) { body(begin, end); });
}

// Calls body(contact) for the contacts of what is awake, in their order.
template <class Body> void for_each_awake_contact(const World &world, const Body &body) {
    const Sleep &s = world.sleep;
    const std::vector<Contact> &contacts = world.walls.contacts;
    const IndexRun whole{0, static_cast<int64_t>(contacts.size())};
    const IndexRun *const first = s.some ? s.contacts.data() : &whole;
    const IndexRun *const last = first + (s.some ? s.contacts.size() : 1);
    for (const IndexRun *run = first; run != last; ++run)
        for (int64_t k = run->begin; k < run->end; ++k)
            body(contacts[k]);
}

} // namespace gp
