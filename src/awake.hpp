// Loops over what is awake (sleep.hpp): over all where nothing sleeps.
#pragma once

#include "parallel.hpp"
#include "world.hpp"

namespace gp {

// The span of a cell (sleep.hpp), by its column of spans and its row.
constexpr int64_t span_columns = 16;
// The quotient rounded down: a division rounds to zero.
inline int64_t floored(int64_t a, int64_t b) {
    return (a - (a < 0 ? b - 1 : 0)) / b;
}
inline Cell span_at(const Cell &cell) {
    return {floored(cell.column, span_columns), cell.row};
}
// The place that says whose a particle is: the middle of its cell, with sleep in use of the middle cell of its span.
inline Vector place_of_owner(const World &world, const CellFrame &frame, double x, double y) {
    Cell cell = frame.cell_of(x, y);
    if (world.sleep.in_use)
        cell.column = span_columns * span_at(cell).column + span_columns / 2;
    return frame.middle_of(cell);
}

// Calls body(span, begin, end) for the first `count` of lit, or of all where none sleeps.
template <class Body> void for_each_chosen_span(const World &world, int64_t count, const Body &body) {
    const Sleep &s = world.sleep;
    const int64_t *const starts = world.clusters.starts.data();
    for_each_share(world.threads, s.some ? count : static_cast<int64_t>(world.clusters.starts.size()) - 1,
                   [&](int64_t begin, int64_t end) {
                       for (int64_t k = begin; k < end; ++k) {
                           const int64_t span = s.some ? s.lit[k] : k;
                           body(span, starts[span], starts[span + 1]);
                       }
                   });
}

// Calls body(block, begin, end) for the blocks of particles that are awake. (Loops of their own without sleep: one for both had an
// instruction more for each particle.)
template <class Body> void for_each_awake_block(const World &world, const Body &body) {
    if (world.clusters.starts.empty())
        for_each_block(world.threads, world.particles.count, body);
    else
        for_each_chosen_span(world, world.sleep.awake, body);
}

// And of those asleep that these see: what neighbours read of a particle and no pair loop makes.
template <class Body> void for_each_seen_block(const World &world, const Body &body) {
    if (world.clusters.starts.empty())
        for_each_block(world.threads, world.particles.count, body);
    else
        for_each_chosen_span(world, static_cast<int64_t>(world.sleep.lit.size()), body);
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
    const Field<Contact> &contacts = world.walls.contacts;
    const IndexRun whole{0, static_cast<int64_t>(contacts.size())};
    const IndexRun *const first = s.some ? s.contacts.data() : &whole;
    const IndexRun *const last = first + (s.some ? s.contacts.size() : 1);
    for (const IndexRun *run = first; run != last; ++run)
        for (int64_t k = run->begin; k < run->end; ++k)
            body(contacts[k]);
}

} // namespace gp
