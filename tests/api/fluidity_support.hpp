// Small scenes with a granular fluidity.
#pragma once

#include <algorithm>

#include "api_support.hpp"

namespace api {

// Grains of two spacings.
inline gp_material make_fluid(double amplitude = 0.48) {
    gp_material material = make_material();
    material.grain_diameter = 2 * spacing;
    material.nonlocal_amplitude = amplitude;
    return material;
}

// A layer between a floor that holds its grains and a lid that drags it slowly, periodic in x.
constexpr int around = 12, couette_plates = 2;

inline gp_config couette_config() {
    gp_config config = make_config();
    config.sound_speed = 8;
    config.periodic_x_max = around * spacing;
    return config;
}

inline gp_plate couette_floor() {
    gp_plate floor = make_plate(around * spacing, 0, 0, 0);
    floor.fluidity = GP_FLUIDITY_ZERO;
    return floor;
}

inline void add_couette(Sim &sim, const gp_plate &floor) {
    gp_column layer = make_column(around, 8);
    layer.material = sim.add(make_fluid());
    sim.add(layer);
    sim.add(floor);
    gp_plate lid = make_plate(0, 8 * spacing, around * spacing, 8 * spacing);
    lid.normal_pressure = 400;
    lid.vx = 0.02;
    sim.add(lid);
}

inline void add_couette(Sim &sim) {
    add_couette(sim, couette_floor());
}

// The collapse of the other tests, of a material with a fluidity; a block of beads without falls onto it.
constexpr int collapse_plates = 3;

inline void add_fluid_collapse(Sim &sim, int columns = 12, int rows = 10, const gp_material &material = make_fluid()) {
    add_collapse(sim, 1, 1); // its plates, and a grain of beads
    gp_column column = make_column(columns, rows, spacing, 0);
    column.material = sim.add(material);
    sim.add(column);
    gp_column block = make_column(4, 3, 3 * spacing, (rows + 1) * spacing);
    block.vy = -0.5;
    sim.add(block);
}

// In the order of id, of the particles of one column.
inline std::vector<double> of_column(const Sim &sim, int32_t column, uint32_t field) {
    const std::vector<double> values = sim.field(field), columns = sim.field(GP_FIELD_COLUMN);
    std::vector<double> found;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (static_cast<int32_t>(columns[i]) == column)
            found.push_back(values[i]);
    return found;
}

inline double largest(const std::vector<double> &values) {
    return *std::max_element(values.begin(), values.end());
}

} // namespace api
