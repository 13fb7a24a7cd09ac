// What a checkpoint keeps of a scene that sleeps (gp_config.sleep): who sleeps, for how long each particle has been quiet, what
// the steps do not make anew of what sleeps, and the loads. Only checkpoint.cpp includes this. Blocks and what they see follow
// from the lists, as after any new lists.
#pragma once

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>
#include <vector>

#include "error.hpp"
#include "io/checkpoint_file.hpp"
#include "world.hpp"

namespace gp::io {

// Every number of a particle's rest that there is, and of a load, by its name in the file.
template <class Visit> void for_each_of_repose(const Visit &visit) {
    visit("quiet_for", &Repose::quiet_for);
    visit("way_x", &Repose::way_x);
    visit("way_y", &Repose::way_y);
    visit("pressure", &Repose::pressure);
    visit("sxx", &Repose::sxx);
    visit("sxy", &Repose::sxy);
    visit("fluidity", &Repose::fluidity);
    visit("gxx", &Repose::gxx);
    visit("gxy", &Repose::gxy);
    visit("gyy", &Repose::gyy);
    visit("stressed", &Repose::stressed);
}
template <class Visit> void for_each_of_load(const Visit &visit) {
    visit("load_id", &MeanLoad::id);
    visit("load_plate", &MeanLoad::plate);
    visit("load_x", &MeanLoad::x);
    visit("load_y", &MeanLoad::y);
    visit("load_couple", &MeanLoad::couple);
}

inline void write_sleep(CheckpointWriter &file, const World &world) {
    const Particles &p = world.particles;
    file.group("/sleep");
    file.array("asleep", std::vector<uint8_t>(p.asleep.begin(), p.asleep.begin() + p.count));
    for_each_of_repose([&](const char *name, auto member) {
        std::vector<double> values;
        for (int64_t i = 0; i < p.count; ++i)
            values.push_back(p.repose[i].*member);
        file.array(name, values);
    });
    for_each_of_load([&](const char *name, auto member) {
        std::vector<std::decay_t<decltype(std::declval<MeanLoad>().*member)>> values;
        for (const MeanLoad &load : world.sleep.loads)
            values.push_back(load.*member);
        file.array(name, values);
    });
}

inline void read_sleep(CheckpointReader &file, World &world) {
    Particles &p = world.particles;
    const auto require = [&](bool good, const char *what) {
        if (!good)
            file.refuse(format_text("sleep: %s", what));
    };
    const auto require_finite = [&](const auto &values) {
        require(std::all_of(values.begin(), values.end(), [](auto value) { return std::isfinite(double(value)); }),
                "a number that is not finite");
    };
    const auto n = static_cast<std::size_t>(p.count);
    file.group("/sleep");
    std::vector<uint8_t> asleep;
    file.array("asleep", asleep);
    require(asleep.size() == n, "not one value for each particle");
    for (std::size_t i = 0; i < n; ++i) {
        require(asleep[i] <= 1, "asleep is neither 0 nor 1");
        require(!asleep[i] || (p.vx[i] == 0 && p.vy[i] == 0), "a particle that sleeps and moves");
        p.asleep[i] = asleep[i];
    }
    for_each_of_repose([&](const char *name, auto member) {
        std::vector<double> values;
        file.array(name, values);
        require(values.size() == n, "not one value for each particle");
        require_finite(values);
        for (std::size_t i = 0; i < n; ++i) {
            auto &number = p.repose[i].*member;
            number = static_cast<std::decay_t<decltype(number)>>(values[i]);
        }
    });
    std::vector<MeanLoad> loads;
    bool first = true; // of the arrays, which says how many there are
    for_each_of_load([&](const char *name, auto member) {
        std::vector<std::decay_t<decltype(std::declval<MeanLoad>().*member)>> values;
        file.array(name, values);
        if (first)
            loads.resize(values.size());
        first = false;
        require(values.size() == loads.size(), "not as many loads as contacts");
        require_finite(values);
        for (std::size_t k = 0; k < values.size(); ++k)
            loads[k].*member = values[k];
    });
    for (const MeanLoad &load : loads) {
        require(load.id >= 0 && load.id < p.count, "a load by no particle");
        require(load.plate >= 0 && static_cast<std::size_t>(load.plate) < world.walls.plates.size(),
                "a load on no plate");
    }
    world.sleep.loads = std::move(loads);
}

} // namespace gp::io
