// The spans of particles that fall asleep and wake together (sleep.hpp), and which of them see each other.
//
// A span sees those of which a particle was within the lists' radius of one of its own when the lists were made: exactly these, not
// what a cluster sees, whose mates depend on the processes.

#include "stages/sleep_work.hpp"

namespace gp::stages {

void find_spans(World &world) {
    Sleep &s = world.sleep;
    const Particles &p = world.particles;
    const CellFrame &frame = world.grid.frame();
    Field<int64_t> &starts = world.clusters.starts;
    starts.assign(1, 0);
    s.span_of.resize(static_cast<std::size_t>(p.count));
    Cell last{};
    for (int64_t i = 0; i < p.count; ++i) {
        const Cell span = span_at(frame.cell_of(p.x[i], p.y[i]));
        if (i > 0 && (span.column != last.column || span.row != last.row))
            starts.push_back(i);
        last = span;
        s.span_of[i] = static_cast<int32_t>(starts.size()) - 1;
    }
    if (p.count > 0)
        starts.push_back(p.count);
    s.spans = static_cast<int64_t>(starts.size()) - 1;
    world.sums.assign(static_cast<std::size_t>(s.spans), BlockSums());
    world.ranges.assign(static_cast<std::size_t>(s.spans), BlockRange{0, 0, 0, 0});
}

namespace {

// Of images: of a process alone their particles' spans, else spans behind those here. Over an end of a period they are cut as
// there.
void find_spans_of_images(World &world) {
    Sleep &s = world.sleep;
    const int64_t count = world.particles.count, columns = world.grid.frame().columns();
    s.span_of.resize(static_cast<std::size_t>(count + world.images.count));
    s.others = 0;
    Cell last{};
    int64_t last_turn = 0;
    for (int64_t k = 0; k < world.images.count; ++k) {
        if (!world.crossing) {
            s.span_of[count + k] = s.span_of[world.images.source(count + k)];
            continue;
        }
        Cell cell = world.images.cell(k);
        const int64_t turn = columns > 0 ? floored(cell.column, columns) : 0;
        cell.column -= turn * columns;
        const Cell span = span_at(cell);
        if (k == 0 || span.column != last.column || span.row != last.row || turn != last_turn)
            ++s.others;
        last = span;
        last_turn = turn;
        s.span_of[count + k] = static_cast<int32_t>(s.spans + s.others - 1);
    }
}

bool any_within(const Particles &p, int64_t first, int64_t last, int64_t j, double radius2) {
    for (int64_t i = first; i < last; ++i) {
        const double dx = p.x[j] - p.x[i], dy = p.y[j] - p.y[i];
        if (dx * dx + dy * dy < radius2)
            return true;
    }
    return false;
}

} // namespace

void link_spans(World &world, double radius) {
    Sleep &s = world.sleep;
    const ClusterList &list = world.clusters;
    find_spans_of_images(world);
    s.links.clear();
    s.link_start.assign(static_cast<std::size_t>(s.spans + 1), 0);
    s.stamp.assign(static_cast<std::size_t>(s.spans + s.others), -1);
    for (int64_t span = 0; span < s.spans; ++span) {
        for (int32_t c = list.cluster_of_block[span]; c < list.cluster_of_block[span + 1]; ++c)
            for_each_entry(list, list.all, c, [&](int64_t, int32_t j) {
                const int32_t other = s.span_of[j];
                if (s.stamp[other] == span ||
                    !any_within(world.particles, list.first[c], list.first[c + 1], j, radius * radius))
                    return;
                s.stamp[other] = static_cast<int32_t>(span);
                s.links.push_back(other);
            });
        s.link_start[span + 1] = static_cast<int32_t>(s.links.size());
    }
    // What is found in a step has room: nothing may fail there.
    s.lit.reserve(static_cast<std::size_t>(s.spans));
    s.contacts.reserve(world.walls.contacts.size());
    s.ghosts.reserve(static_cast<std::size_t>(world.walls.ghost_count));
    s.ghost_seen.reserve(static_cast<std::size_t>(world.walls.ghost_count));
}

void take_over_spans(World &world, double quiet_time) {
    Sleep &s = world.sleep;
    Particles &p = world.particles;
    for (Field<uint8_t> *flags : {&s.asleep, &s.reached})
        flags->assign(static_cast<std::size_t>(s.spans), 0);
    for (Field<uint8_t> *flags : {&s.restless, &s.stirs})
        flags->assign(static_cast<std::size_t>(s.spans + s.others), 0);
    for (int64_t span = 0; span < s.spans; ++span) {
        bool asleep = true, restless = false;
        for_each_of(world, span, [&](int64_t i) {
            asleep &= p.repose.asleep[i] != 0;
            restless |= p.repose.quiet_for[i] < quiet_time;
        });
        s.asleep[span] = asleep;
        s.restless[span] = !asleep && restless;
        if (!asleep) // new neighbours in the order may be awake
            for_each_of(world, span, [&](int64_t i) { p.repose.asleep[i] = 0; });
        else
            clear_exchanged(world, span); // it is in the order of before
    }
    s.plates.assign(static_cast<std::size_t>(s.spans + s.others), 0);
    for (const Contact &contact : world.walls.contacts)
        s.plates[s.span_of[contact.particle]] |= plate_bit(world.walls.facets[contact.facet].plate);
    if (world.crossing)
        world.halo->copy_rest(s);
}

} // namespace gp::stages
