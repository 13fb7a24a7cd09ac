// What there is to do beside blocks that sleep: who sees whom, which contacts and ghosts are left, what plates bear of those that
// sleep, and what neighbours read of them.
#include "stages/sleep_work.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

void clear_exchanged(World &world, int64_t block) {
    const auto clear = [&](Field<double> &field) {
        if (!field.empty())
            for_each_of(world, block, [&](int64_t i) { field[i] = 0; });
    };
    for (Field<double> &field : world.step_start.made)
        clear(field);
    clear(world.particles.push_x);
    clear(world.particles.push_y);
}

void take_over_blocks(World &world, double quiet_time) {
    Sleep &s = world.sleep;
    Particles &p = world.particles;
    const auto blocks = static_cast<std::size_t>(blocks_of(world));
    for (Field<uint8_t> *flags : {&s.asleep, &s.restless, &s.reached})
        flags->assign(blocks, 0);
    const auto enough = static_cast<float>(quiet_time);
    for (std::size_t block = 0; block < blocks; ++block) {
        bool asleep = true, restless = false;
        for_each_of(world, block, [&](int64_t i) {
            asleep &= p.asleep[i] != 0;
            restless |= p.repose[i].quiet_for < enough;
        });
        s.asleep[block] = asleep;
        s.restless[block] = !asleep && restless;
        if (!asleep) // new neighbours in the order may be awake
            for_each_of(world, block, [&](int64_t i) { p.asleep[i] = 0; });
        else
            clear_exchanged(world, static_cast<int64_t>(block)); // it is in the order of before
    }
}

void take_over_contacts(World &world) {
    Sleep &s = world.sleep;
    const Walls &w = world.walls;
    const Particles &p = world.particles;
    s.touches.clear();
    s.earlier_loads.swap(s.loads);
    s.loads.clear();
    s.load_of_id.assign(static_cast<std::size_t>(p.count), -1);
    for (std::size_t k = s.earlier_loads.size(); k-- > 0;)
        s.load_of_id[s.earlier_loads[k].id] = static_cast<int32_t>(k); // its first
    for (const Contact &contact : w.contacts) {
        const int64_t id = p.id[contact.particle];
        const auto block = static_cast<int32_t>(contact.particle / block_size);
        const int32_t plate = w.facets[contact.facet].plate;
        MeanLoad load{id, plate, 0, 0, 0};
        // In a groove a particle has two contacts with one plate: the first is the first again.
        int64_t same = 0;
        for (std::size_t k = s.loads.size(); k > 0 && s.loads[k - 1].id == id; --k)
            same += s.loads[k - 1].plate == plate;
        if (const int32_t first = s.load_of_id[id]; first >= 0)
            for (auto k = static_cast<std::size_t>(first); k < s.earlier_loads.size() && s.earlier_loads[k].id == id;
                 ++k)
                if (s.earlier_loads[k].plate == plate && same-- == 0)
                    load = s.earlier_loads[k];
        s.loads.push_back(load);
        bool known = false;
        for (std::size_t k = s.touches.size(); k > 0 && s.touches[k - 1].block == block; --k)
            known |= s.touches[k - 1].plate == plate;
        if (!known)
            s.touches.push_back({block, plate});
    }
    s.pushed.assign(w.contacts.size(), Vector::Zero());
    s.held.resize(w.plates.size());
}

void link_blocks(World &world) {
    Sleep &s = world.sleep;
    const ClusterList &list = world.clusters;
    const int64_t blocks = blocks_of(world), count = world.particles.count;
    s.links.clear();
    s.link_start.assign(static_cast<std::size_t>(blocks + 1), 0);
    s.stamp.assign(static_cast<std::size_t>(blocks), -1);
    for (int64_t block = 0; block < blocks; ++block) {
        for (int32_t c = list.cluster_of_block[block]; c < list.cluster_of_block[block + 1]; ++c)
            for_each_entry(list, list.all, c, [&](int64_t, int32_t j) {
                const int64_t other = (j < count ? j : world.images.source(j)) / block_size;
                if (s.stamp[other] == block)
                    return;
                s.stamp[other] = static_cast<int32_t>(block);
                s.links.push_back(static_cast<int32_t>(other));
            });
        s.link_start[block + 1] = static_cast<int32_t>(s.links.size());
    }
    s.linked = true;
    // What is found at the end of a step has room: nothing may fail there.
    s.lit.reserve(static_cast<std::size_t>(blocks));
    s.contacts.reserve(world.walls.contacts.size());
    s.ghosts.reserve(static_cast<std::size_t>(world.walls.ghost_count));
    s.ghost_seen.reserve(static_cast<std::size_t>(world.walls.ghost_count));
}

namespace {

void choose_awake_blocks(World &world) {
    Sleep &s = world.sleep;
    const int64_t blocks = blocks_of(world);
    s.lit.clear();
    for (int64_t block = 0; block < blocks; ++block)
        if (!s.asleep[block])
            s.lit.push_back(static_cast<int32_t>(block));
    s.awake = static_cast<int64_t>(s.lit.size());
    s.some = s.awake < blocks;
}

// What sleeps within sight of what is awake, or of a ghost that this sees.
void choose_seen_blocks(World &world) {
    Sleep &s = world.sleep;
    const NeighborList &seen = world.walls.particles_of_ghost;
    const int64_t blocks = blocks_of(world), count = world.particles.count;
    std::fill(s.stamp.begin(), s.stamp.end(), 0);
    for (int64_t k = 0; k < s.awake; ++k)
        for_each_link(s, s.lit[k], [&](int32_t other) { s.stamp[other] = 1; });
    for (const IndexRun &run : s.ghosts)
        for (int64_t k = seen.start[run.begin]; k < seen.start[run.end]; ++k) {
            const int64_t j = seen.index[k];
            s.stamp[(j < count ? j : world.images.source(j)) / block_size] = 1;
        }
    for (int64_t block = 0; block < blocks; ++block)
        if (s.asleep[block]) {
            world.sums[block] = {};
            world.ranges[block] = {0, 0, 0, 0};
            if (s.stamp[block])
                s.lit.push_back(static_cast<int32_t>(block));
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
        const int64_t first = s.lit[b] * block_size, last = std::min(world.particles.count, first + block_size);
        const int32_t begin = w.contact_start[first], end = w.contact_start[last];
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
        if (!p.asleep[contact.particle])
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
    choose_awake_blocks(world);
    if (world.sleep.some) {
        choose_contacts(world);
        choose_seen_blocks(world);
        sum_held_loads(world);
        world.images.copy(world.particles.asleep);
    }
}

void add_held_loads(World &world) {
    Walls &w = world.walls;
    if (world.sleep.all())
        w.clear_loads();
    for (std::size_t k = 0; k < w.plates.size(); ++k)
        w.plates[k].load += world.sleep.held[k];
}

void remember_shape(World &world) {
    Particles &p = world.particles;
    for_each_awake_block(world, [&](int64_t block, int64_t begin, int64_t end) {
        if (world.sleep.restless[block])
            return;
        for (int64_t i = begin; i < end; ++i) {
            p.repose[i].gxx = p.gxx[i];
            p.repose[i].gxy = p.gxy[i];
            p.repose[i].gyy = p.gyy[i];
        }
    });
}

void hold_stress(World &world) {
    Particles &p = world.particles;
    const bool penalty = !p.stressed.empty();
    for_each_seen_block(world, [&](int64_t block, int64_t begin, int64_t end) {
        if (world.sleep.asleep[block])
            for (int64_t i = begin; i < end; ++i) {
                const Repose &own = p.repose[i];
                const double xx = p.sxx[i] - p.pressure[i], xy = p.sxy[i], yy = -p.sxx[i] - p.pressure[i];
                p.cxx[i] = xx * own.gxx + xy * own.gxy;
                p.cxy[i] = xx * own.gxy + xy * own.gyy;
                p.cyx[i] = xy * own.gxx + yy * own.gxy;
                p.cyy[i] = xy * own.gxy + yy * own.gyy;
                if (penalty)
                    p.stressed[i] = own.stressed;
            }
        else if (penalty && !world.sleep.restless[block])
            for (int64_t i = begin; i < end; ++i)
                p.repose[i].stressed = p.stressed[i];
    });
}

} // namespace gp::stages
