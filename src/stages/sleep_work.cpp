// What there is to do beside spans that sleep: which contacts and ghosts are left, what plates bear of those that sleep, and what
// neighbours read of them.
#include <algorithm>

#include "stages/sleep_work.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

void clear_exchanged(World &world, int64_t span) {
    // What is kept of the step before grows with the particles only when it is kept anew: with zeros.
    const auto clear = [&](Field<double> &field) {
        const auto size = static_cast<int64_t>(field.size());
        for_each_of(world, span, [&](int64_t i) {
            if (i < size)
                field[i] = 0;
        });
    };
    for (Field<double> &field : world.step_start.made)
        clear(field);
    clear(world.particles.push_x);
    clear(world.particles.push_y);
}

void take_over_contacts(World &world) {
    Sleep &s = world.sleep;
    const Walls &w = world.walls;
    const Particles &p = world.particles;
    const auto before = [](const MeanLoad &a, const MeanLoad &b) { return a.id < b.id; };
    s.earlier_loads.swap(s.loads);
    s.loads.clear();
    std::stable_sort(s.earlier_loads.begin(), s.earlier_loads.end(), before);
    for (const Contact &contact : w.contacts) {
        const int64_t id = p.id[contact.particle];
        const int32_t plate = w.facets[contact.facet].plate;
        MeanLoad load{id, plate, 0, 0, 0};
        // In a groove a particle has two contacts with one plate: the first is the first again.
        int64_t same = 0;
        for (std::size_t k = s.loads.size(); k > 0 && s.loads[k - 1].id == id; --k)
            same += s.loads[k - 1].plate == plate;
        const auto [first, last] = std::equal_range(s.earlier_loads.begin(), s.earlier_loads.end(), load, before);
        for (auto earlier = first; earlier != last; ++earlier)
            if (earlier->plate == plate && same-- == 0)
                load = *earlier;
        s.loads.push_back(load);
    }
    s.pushed.assign(w.contacts.size(), Vector::Zero());
    s.held.resize(w.plates.size());
}

namespace {

void choose_awake_spans(World &world) {
    Sleep &s = world.sleep;
    s.lit.clear();
    for (int64_t span = 0; span < s.spans; ++span)
        if (!s.asleep[span])
            s.lit.push_back(static_cast<int32_t>(span));
    s.awake = static_cast<int64_t>(s.lit.size());
    s.some = s.awake < s.spans;
}

// What sleeps within sight of what is awake, or of a ghost that this sees. Another process may look at what sees its particles, and
// does not tell whether it does.
void choose_seen_spans(World &world) {
    Sleep &s = world.sleep;
    const NeighborList &seen = world.walls.particles_of_ghost;
    std::fill(s.stamp.begin(), s.stamp.end(), 0);
    for (int64_t k = 0; k < s.awake; ++k)
        for_each_link(s, s.lit[k], [&](int32_t other) { s.stamp[other] = 1; });
    for (const IndexRun &run : s.ghosts)
        for (int64_t k = seen.start[run.begin]; k < seen.start[run.end]; ++k)
            s.stamp[s.span_of[seen.index[k]]] = 1;
    for (int64_t span = 0; span < s.spans; ++span)
        if (s.asleep[span]) {
            world.sums[span] = {};
            world.ranges[span] = {0, 0, 0, 0};
            bool lit = s.stamp[span] != 0;
            for_each_link(s, span, [&](int32_t other) { lit |= other >= s.spans; });
            if (lit)
                s.lit.push_back(static_cast<int32_t>(span));
        }
}

// Runs of at most so many as a block of ghosts has.
void add_to_runs(std::vector<IndexRun> &runs, int64_t begin, int64_t end) {
    for (; begin < end; begin += ghost_block_size)
        runs.push_back({begin, std::min(end, begin + ghost_block_size)});
}

void choose_contacts(World &world) {
    Sleep &s = world.sleep;
    const Walls &w = world.walls;
    s.contacts.clear();
    s.ghosts.clear();
    s.ghost_seen.assign(static_cast<std::size_t>(w.ghost_count), 0);
    if (!w.in_reach())
        return;
    for (int64_t b = 0; b < s.awake; ++b) {
        const Field<int64_t> &starts = world.clusters.starts;
        const int32_t begin = w.contact_start[starts[s.lit[b]]], end = w.contact_start[starts[s.lit[b] + 1]];
        add_to_runs(s.contacts, begin, end);
        for (int32_t k = begin; k < end; ++k)
            for (int64_t e = w.contacts[k].begin; e < w.contacts[k].end; ++e)
                s.ghost_seen[w.ghost_of_contact[e]] = 1;
    }
    for (int64_t g = 0; g < w.ghost_count;) {
        const int64_t begin = g;
        while (g < w.ghost_count && s.ghost_seen[g])
            ++g;
        add_to_runs(s.ghosts, begin, g);
        g += g == begin;
    }
}

// What sleeps goes on to press the plates with its mean load.
void sum_held_loads(World &world) {
    Sleep &s = world.sleep;
    Walls &w = world.walls;
    const Particles &p = world.particles;
    std::vector<Plate> &plates = w.plates;
    w.clear_loads(); // of a step that has not begun with them yet
    for (std::size_t k = 0; k < w.contacts.size(); ++k) {
        const Contact &contact = w.contacts[k];
        if (p.repose.asleep[contact.particle] == 0)
            continue;
        w.add_load(contact.facet, {p.x[contact.particle], p.y[contact.particle]}, {s.loads[k].x, s.loads[k].y});
        w.add_couple(s.loads[k].plate, s.loads[k].couple);
    }
    for (std::size_t k = 0; k < plates.size(); ++k)
        s.held[k] = plates[k].load;
    w.clear_loads();
}

} // namespace

void choose_work(World &world) {
    choose_awake_spans(world);
    if (world.sleep.some) {
        choose_contacts(world);
        choose_seen_spans(world);
        sum_held_loads(world);
    }
}

void add_held_loads(World &world) {
    Walls &w = world.walls;
    if (world.sleep.idle) // no force stage has
        w.clear_loads();
    if (!world.sleep.some)
        return;
    for (std::size_t k = 0; k < w.plates.size(); ++k)
        w.plates[k].load += world.sleep.held[k];
}

void remember_shape(World &world) {
    Particles &p = world.particles;
    for_each_awake_block(world, [&](int64_t span, int64_t begin, int64_t end) {
        if (world.sleep.restless[span])
            return;
        for (int64_t i = begin; i < end; ++i) {
            p.repose.gxx[i] = p.gxx[i];
            p.repose.gxy[i] = p.gxy[i];
            p.repose.gyy[i] = p.gyy[i];
        }
    });
}

void hold_stress(World &world) {
    Particles &p = world.particles;
    Repose &r = p.repose;
    const bool penalty = !p.stressed.empty();
    for_each_seen_block(world, [&](int64_t span, int64_t begin, int64_t end) {
        if (world.sleep.asleep[span])
            for (int64_t i = begin; i < end; ++i) {
                const double xx = p.sxx[i] - p.pressure[i], xy = p.sxy[i], yy = -p.sxx[i] - p.pressure[i];
                p.cxx[i] = xx * r.gxx[i] + xy * r.gxy[i];
                p.cxy[i] = xx * r.gxy[i] + xy * r.gyy[i];
                p.cyx[i] = xy * r.gxx[i] + yy * r.gxy[i];
                p.cyy[i] = xy * r.gxy[i] + yy * r.gyy[i];
                if (penalty)
                    p.stressed[i] = r.stressed[i];
            }
        else if (penalty && !world.sleep.restless[span])
            for (int64_t i = begin; i < end; ++i)
                r.stressed[i] = p.stressed[i];
    });
}

} // namespace gp::stages
