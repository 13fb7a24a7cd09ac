// What a checkpoint keeps of a scene that sleeps (gp_config.sleep) beside what is of each particle: the loads of what presses plates,
// in the order of id. Only checkpoint.cpp includes this. Spans and what they see follow from the lists, as after any new lists.
#pragma once

#include <algorithm>
#include <vector>

#include "io/checkpoint_items.hpp"
#include "stretches.hpp"

namespace gp::io {

// Every number of a load, by its name in the file.
inline constexpr auto for_each_of_load = [](const auto &visit) {
    visit("id", &MeanLoad::id);
    visit("plate", &MeanLoad::plate);
    visit("x", &MeanLoad::x);
    visit("y", &MeanLoad::y);
    visit("couple", &MeanLoad::couple);
};

// Those of all processes, on the first. Collective.
inline std::vector<MeanLoad> loads_of_all(const World &world) {
    std::vector<MeanLoad> own = world.sleep.loads, all;
    std::stable_sort(own.begin(), own.end(), [](const MeanLoad &a, const MeanLoad &b) { return a.id < b.id; });
    if (!world.crossing)
        return own;
    OrderedRows rows;
    rows.count = static_cast<int64_t>(own.size());
    rows.numbers = static_cast<int>(MeanLoad::numbers);
    rows.key_of = [&](int64_t k, double *key) {
        key[0] = static_cast<double>(own[static_cast<std::size_t>(k)].id);
        key[1] = static_cast<double>(k);
        key[2] = 0;
    };
    rows.pack = [&](int64_t k, double *out) { own[static_cast<std::size_t>(k)].put(out); };
    take_in_order(*world.crossing, rows, [&](const std::vector<const double *> &found) {
        for (const double *row : found)
            all.push_back(MeanLoad::of(row));
    });
    return all;
}

inline void write_loads(CheckpointWriter &file, const std::vector<MeanLoad> &loads) {
    file.group("/sleep");
    write_items(file, loads, for_each_of_load);
}

// Particles have been read: of several processes each keeps the loads of its own.
inline void read_sleep(CheckpointReader &file, const Checker &check, World &world) {
    const Particles &p = world.particles;
    for (int64_t i = 0; i < p.count; ++i)
        check.require_each(p.repose.asleep[i] == 0 || (p.vx[i] == 0 && p.vy[i] == 0),
                           [] { return std::string("a particle that sleeps and moves"); });
    file.group("/sleep");
    const std::vector<MeanLoad> loads = read_items(file, check, MeanLoad(), for_each_of_load);
    std::vector<int64_t> own(p.id.begin(), p.id.begin() + p.count);
    std::sort(own.begin(), own.end());
    for (const MeanLoad &load : loads) {
        for (const double value : {load.x, load.y, load.couple})
            check.finite("sleep", value);
        check.require(load.id >= 0 && load.id < world.scene->particle_count(), "a load by no particle");
        check.require(load.plate >= 0 && static_cast<std::size_t>(load.plate) < world.walls.plates.size(),
                      "a load on no plate");
        if (std::binary_search(own.begin(), own.end(), load.id))
            world.sleep.loads.push_back(load);
    }
}

} // namespace gp::io
