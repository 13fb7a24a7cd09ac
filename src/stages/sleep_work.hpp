// The spans that sleep, and what is left to do beside them (sleep.hpp). sleep.cpp says which these are.
#pragma once

#include "awake.hpp"

namespace gp::stages {

template <class Body> void for_each_of(const World &world, int64_t span, const Body &body) {
    const Field<int64_t> &starts = world.clusters.starts;
    for (int64_t i = starts[span]; i < starts[span + 1]; ++i)
        body(i);
}
template <class Found> void for_each_link(const Sleep &s, int64_t span, const Found &found) {
    for (int32_t k = s.link_start[span]; k < s.link_start[span + 1]; ++k)
        found(s.links[k]);
}

// While lists are made: the spans of the sorted particles; then, by the lists, the spans within `radius` of each.
void find_spans(World &world);
void link_spans(World &world, double radius);
// After new lists: spans of the new order, of which those whose particles have all been quiet for so many seconds are not
// restless; the contacts' loads.
void take_over_spans(World &world, double quiet_time);
void take_over_contacts(World &world);
// What there is to do, for the spans that are awake now.
void choose_work(World &world);
// The memory of a span that changes places with that of the velocity gradient: what is made of nobody.
void clear_exchanged(World &world, int64_t span);

} // namespace gp::stages
