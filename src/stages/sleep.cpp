// Who rests and who wakes (gp_config.sleep).
//
// A particle is quiet from the moment on at which it has last gone more than `quiet_way` within `quiet_spans` sqrt(dl / g), or
// the mean stress of its block of 64 has last changed by more than `quiet_stress` of itself and of the weight of a spacing since,
// or the block's mean velocity has been such that a wave of half that stress would go out from it if it stopped. A block in
// which one has been quiet for less than that time is restless. What sees a restless block, or a ghost of a plate that acts, is
// computed, and nothing else: it is left out of the stages, at rest, with the stress that it has. Between a restless block and
// one that sleeps there is a ring of blocks as wide as particles see, horizon and skin; a wave takes several steps through it,
// each of which looks at the ring, so that all that changes a stress by more than the hundredths above wakes what is behind
// before it is there. What is weaker ends at the border: the force of what is awake on what sleeps is held, as by friction at
// rest, and its momentum with it.
//
// A deposit at rest still trembles: grains that touch push each other in each step, so that the pressure of single ones varies by
// a tenth, that of blocks by .005 at most, and the fastest grains drift by .007 dl in 4 sqrt(dl / g) (a = 1.25, L/dl = 32, 64).
// Therefore ways in place of speeds, and means of blocks. With ways of .005, .01, .02, .05, .1, .2 six such deposits have the same
// peak to 1e-5 of the width and the same middle 90 % of the mass to 3e-5, and take 1.87, 1.45, 1.31, .82, .75, .77 s to 2 s; with
// stresses of .005 to .1 likewise. Without the third rule a layer below a shear band that fell asleep woke itself: 65 Pa of a wave
// for the 20 that wake.
#include <algorithm>
#include <cmath>

#include "awake.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

constexpr double quiet_way = 0.05;    // dl
constexpr double quiet_stress = 0.02; // of mean pressure and rho g dl
constexpr double quiet_spans = 8;     // sqrt(dl / g)
constexpr double quiet_waves = 10;    // and so many times what a wave needs for the way that particles see
constexpr double quiet_growth =
    0.1;                         // of the granular fluidity: where it grows, more than this, failure may be on its way
constexpr double mean_spans = 1; // sqrt(dl / g), over which loads are averaged

// s; infinite without gravity, which gives neither a time nor a stress to compare with: then nothing sleeps.
double fall_time(const Constants &c) {
    return std::sqrt(c.spacing / c.gravity.norm());
}
double quiet_time(const Constants &c) {
    return std::max(quiet_spans * fall_time(c), quiet_waves * c.reach / c.wave_speed);
}

bool acts(const Plate &plate) {
    return plate.motion().any() || plate.loaded() || plate.spec().surface_velocity != 0;
}

int64_t blocks_of(const World &world) {
    return block_count(world.particles.count);
}
template <class Body> void for_each_of(const World &world, int64_t block, const Body &body) {
    const int64_t end = std::min(world.particles.count, (block + 1) * block_size);
    for (int64_t i = block * block_size; i < end; ++i)
        body(i);
}

// ------------------------------------------------------------------------------------------------- new lists

// The memory that changes places with that of the velocity gradient.
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

void take_over_blocks(World &world) {
    Sleep &s = world.sleep;
    Particles &p = world.particles;
    const auto blocks = static_cast<std::size_t>(blocks_of(world));
    for (Field<uint8_t> *flags : {&s.asleep, &s.restless, &s.reached})
        flags->assign(blocks, 0);
    const auto enough = static_cast<float>(quiet_time(world.constants));
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

// The blocks whose particles a block sees, by the lists of its clusters.
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

// ------------------------------------------------------------------------------------------- what is left out

template <class Found> void for_each_link(const Sleep &s, int64_t block, const Found &found) {
    for (int32_t k = s.link_start[block]; k < s.link_start[block + 1]; ++k)
        found(s.links[k]);
}

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

void choose_work(World &world) {
    choose_awake_blocks(world);
    if (world.sleep.some) {
        choose_contacts(world);
        choose_seen_blocks(world);
        sum_held_loads(world);
        world.images.copy(world.particles.asleep);
    }
}

// ------------------------------------------------------------------------------------------ what tells of rest

void find_reached(World &world) {
    Sleep &s = world.sleep;
    constexpr uint8_t source = 2;
    for (std::size_t block = 0; block < s.reached.size(); ++block)
        s.reached[block] = s.restless[block] ? source : 0;
    for (const Sleep::Touch &touch : s.touches)
        if (acts(world.walls.plates[touch.plate]))
            s.reached[touch.block] = source;
    for (std::size_t block = 0; block < s.reached.size(); ++block)
        if (s.reached[block] == source)
            for_each_link(s, static_cast<int64_t>(block),
                          [&](int32_t other) { s.reached[other] = std::max<uint8_t>(s.reached[other], 1); });
}

void begin_anew(const Particles &p, int64_t i, Repose &repose) {
    repose.quiet_for = repose.way_x = repose.way_y = 0;
    repose.pressure = static_cast<float>(p.pressure[i]);
    repose.sxx = static_cast<float>(p.sxx[i]);
    repose.sxy = static_cast<float>(p.sxy[i]);
    repose.fluidity = p.fluidity.empty() ? 0.0f : static_cast<float>(p.fluidity[i]);
}

// Brings what the particles of a block remember up to this step. Returns whether one of them has not been quiet for long enough.
bool is_restless(World &world, int64_t begin, int64_t end) {
    Particles &p = world.particles;
    const Constants &c = world.constants;
    const bool fluid = !p.fluidity.empty();
    const auto dt = static_cast<float>(world.clock.dt), enough = static_cast<float>(quiet_time(c));
    const auto way = static_cast<float>(quiet_way * c.spacing), fading = dt / enough;
    double pressure = 0, change = 0, change_xx = 0, change_xy = 0, weight = 0, fluidity = 0, fluidity_before = 0;
    double momentum_x = 0, momentum_y = 0; // kg/m3 m/s
    float shortest = enough;
    for (int64_t i = begin; i < end; ++i) {
        Repose &repose = p.repose[i];
        repose.quiet_for += dt;
        repose.way_x += dt * static_cast<float>(p.vx[i]) - fading * repose.way_x;
        repose.way_y += dt * static_cast<float>(p.vy[i]) - fading * repose.way_y;
        if (repose.way_x * repose.way_x + repose.way_y * repose.way_y > way * way)
            begin_anew(p, i, repose);
        shortest = std::min(shortest, repose.quiet_for);
        pressure += p.pressure[i];
        change += p.pressure[i] - repose.pressure;
        change_xx += p.sxx[i] - repose.sxx;
        change_xy += p.sxy[i] - repose.sxy;
        const double density = world.material_of(i).density;
        weight += density;
        momentum_x += density * p.vx[i];
        momentum_y += density * p.vy[i];
        if (fluid) {
            fluidity += p.fluidity[i];
            fluidity_before += repose.fluidity;
        }
    }
    const double most = quiet_stress * (pressure + weight * c.gravity.norm() * c.spacing);
    const double blow = c.wave_speed * std::hypot(momentum_x, momentum_y); // the stress of the wave when it stops
    const bool grows = fluidity > (1 + quiet_growth) * fluidity_before;
    if (grows || !(blow <= 0.5 * most) || !(std::abs(change) <= most) || !(std::hypot(change_xx, change_xy) <= most)) {
        for (int64_t i = begin; i < end; ++i)
            begin_anew(p, i, p.repose[i]);
        return true;
    }
    return shortest < enough;
}

void average_loads(World &world) {
    Sleep &s = world.sleep;
    const double volume = world.particles.volume;
    const double share = std::min(1.0, world.clock.dt / (mean_spans * fall_time(world.constants)));
    const Contact *const first = world.walls.contacts.data();
    for_each_awake_contact(world, [&](const Contact &contact) {
        const auto k = static_cast<std::size_t>(&contact - first);
        MeanLoad &load = s.loads[k];
        load.x += share * (s.pushed[k].x() - volume * contact.force_x - load.x);
        load.y += share * (s.pushed[k].y() - volume * contact.force_y - load.y);
        load.couple += share * (-volume * contact.couple - load.couple);
        s.pushed[k] = Vector::Zero();
    });
}

// A block comes to rest: what is left of its motion is lost. Returns the energy, J/m.
double lay_down(World &world, int64_t block) {
    Particles &p = world.particles;
    double kinetic = 0;
    for_each_of(world, block, [&](int64_t i) {
        kinetic += world.material_of(i).density * (p.vx[i] * p.vx[i] + p.vy[i] * p.vy[i]);
        p.vx[i] = p.vy[i] = p.ax[i] = p.ay[i] = p.push_x[i] = p.push_y[i] = 0;
        p.lxx[i] = p.lxy[i] = p.lyx[i] = p.lyy[i] = 0;
        p.asleep[i] = 1;
    });
    clear_exchanged(world, block);
    world.sleep.asleep[block] = 1;
    return 0.5 * p.volume * kinetic;
}

} // namespace

void wake(World &world) {
    Sleep &s = world.sleep;
    const bool stale = s.stale;
    if (stale) {
        take_over_blocks(world);
        take_over_contacts(world);
        s.linked = false;
        s.stale = false;
    }
    s.may_rest = std::any_of(s.restless.begin(), s.restless.end(), [](uint8_t restless) { return !restless; });
    if (!s.may_rest) {
        s.some = false;
        return;
    }
    if (!s.linked)
        link_blocks(world);
    find_reached(world);
    bool woken = false;
    for (std::size_t block = 0; block < s.asleep.size(); ++block)
        if (s.asleep[block] && s.reached[block]) {
            s.asleep[block] = 0;
            for_each_of(world, static_cast<int64_t>(block), [&](int64_t i) { world.particles.asleep[i] = 0; });
            woken = true;
        }
    if (stale || woken)
        choose_work(world);
}

void sleep(World &world) {
    Sleep &s = world.sleep;
    if (s.all())
        return;
    for_each_awake_block(
        world, [&](int64_t block, int64_t begin, int64_t end) { s.restless[block] = is_restless(world, begin, end); });
    average_loads(world);
    if (!s.may_rest)
        return;
    find_reached(world);
    bool fallen = false;
    for (std::size_t block = 0; block < s.asleep.size(); ++block)
        if (!s.asleep[block] && !s.reached[block]) {
            world.ledger.dissipated += lay_down(world, static_cast<int64_t>(block));
            fallen = true;
        }
    if (!fallen)
        return;
    choose_work(world);
    world.images.copy({&world.particles.vx, &world.particles.vy});
}

void wake_all(World &world) {
    Sleep &s = world.sleep;
    Particles &p = world.particles;
    for (std::size_t i = 0; i < p.repose.size(); ++i) {
        begin_anew(p, static_cast<int64_t>(i), p.repose[i]);
        p.asleep[i] = 0;
    }
    s.some = false;
    s.stale = true;
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
