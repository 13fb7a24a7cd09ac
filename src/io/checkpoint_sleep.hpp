// What a checkpoint keeps of a scene that sleeps (gp_config.sleep): who sleeps, for how long each particle has been quiet, what
// the steps do not make anew of what sleeps, and the loads. Only checkpoint.cpp includes this. Blocks and what they see follow
// from the lists, as after any new lists.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "error.hpp"
#include "io/checkpoint_file.hpp"
#include "world.hpp"

namespace gp::io {

struct SleepTable {
    std::vector<uint8_t> asleep;
    std::vector<double> quiet_for, way_x, way_y, pressure, sxx, sxy, fluidity, gxx, gxy, gyy, stressed; // Repose
    std::vector<int64_t> load_id;
    std::vector<int32_t> load_plate;
    std::vector<double> load_x, load_y, load_couple;
};

template <class File, class Table> void exchange_sleep(File &file, Table &t) {
    file.group("/sleep");
    file.array("asleep", t.asleep);
    file.array("quiet_for", t.quiet_for);
    file.array("way_x", t.way_x);
    file.array("way_y", t.way_y);
    file.array("pressure", t.pressure);
    file.array("sxx", t.sxx);
    file.array("sxy", t.sxy);
    file.array("fluidity", t.fluidity);
    file.array("gxx", t.gxx);
    file.array("gxy", t.gxy);
    file.array("gyy", t.gyy);
    file.array("stressed", t.stressed);
    file.array("load_id", t.load_id);
    file.array("load_plate", t.load_plate);
    file.array("load_x", t.load_x);
    file.array("load_y", t.load_y);
    file.array("load_couple", t.load_couple);
}

inline void write_sleep(CheckpointWriter &file, const World &world) {
    const Particles &p = world.particles;
    SleepTable t;
    for (int64_t i = 0; i < p.count; ++i) {
        const Repose &r = p.repose[i];
        t.asleep.push_back(p.asleep[i]);
        t.quiet_for.push_back(r.quiet_for);
        t.way_x.push_back(r.way_x);
        t.way_y.push_back(r.way_y);
        t.pressure.push_back(r.pressure);
        t.sxx.push_back(r.sxx);
        t.sxy.push_back(r.sxy);
        t.fluidity.push_back(r.fluidity);
        t.gxx.push_back(r.gxx);
        t.gxy.push_back(r.gxy);
        t.gyy.push_back(r.gyy);
        t.stressed.push_back(r.stressed);
    }
    for (const MeanLoad &load : world.sleep.loads) {
        t.load_id.push_back(load.id);
        t.load_plate.push_back(load.plate);
        t.load_x.push_back(load.x);
        t.load_y.push_back(load.y);
        t.load_couple.push_back(load.couple);
    }
    exchange_sleep(file, t);
}

inline void read_sleep(CheckpointReader &file, World &world) {
    SleepTable t;
    exchange_sleep(file, t);
    Particles &p = world.particles;
    const auto require = [&](bool good, const char *what) {
        if (!good)
            file.refuse(format_text("sleep: %s", what));
    };
    const auto n = static_cast<std::size_t>(p.count);
    require(t.asleep.size() == n, "not one value for each particle");
    for (const auto *array : {&t.quiet_for, &t.way_x, &t.way_y, &t.pressure, &t.sxx, &t.sxy, &t.fluidity, &t.gxx,
                              &t.gxy, &t.gyy, &t.stressed}) {
        require(array->size() == n, "not one value for each particle");
        require(std::all_of(array->begin(), array->end(), [](double value) { return std::isfinite(value); }),
                "a number that is not finite");
    }
    for (std::size_t i = 0; i < n; ++i) {
        require(t.asleep[i] <= 1, "asleep is neither 0 nor 1");
        require(!t.asleep[i] || (p.vx[i] == 0 && p.vy[i] == 0), "a particle that sleeps and moves");
        p.asleep[i] = t.asleep[i];
        Repose &r = p.repose[i];
        r.quiet_for = static_cast<float>(t.quiet_for[i]);
        r.way_x = static_cast<float>(t.way_x[i]);
        r.way_y = static_cast<float>(t.way_y[i]);
        r.pressure = static_cast<float>(t.pressure[i]);
        r.sxx = static_cast<float>(t.sxx[i]);
        r.sxy = static_cast<float>(t.sxy[i]);
        r.fluidity = static_cast<float>(t.fluidity[i]);
        r.gxx = t.gxx[i];
        r.gxy = t.gxy[i];
        r.gyy = t.gyy[i];
        r.stressed = t.stressed[i];
    }
    const std::size_t loads = t.load_id.size();
    require(t.load_plate.size() == loads && t.load_x.size() == loads && t.load_y.size() == loads &&
                t.load_couple.size() == loads,
            "not as many loads as contacts");
    world.sleep.loads.clear();
    for (std::size_t k = 0; k < loads; ++k) {
        require(t.load_id[k] >= 0 && t.load_id[k] < p.count, "a load by no particle");
        require(t.load_plate[k] >= 0 && static_cast<std::size_t>(t.load_plate[k]) < world.walls.plates.size(),
                "a load on no plate");
        require(std::isfinite(t.load_x[k]) && std::isfinite(t.load_y[k]) && std::isfinite(t.load_couple[k]),
                "a number that is not finite");
        world.sleep.loads.push_back({t.load_id[k], t.load_plate[k], t.load_x[k], t.load_y[k], t.load_couple[k]});
    }
}

} // namespace gp::io
