// For the tests of the contract of gp.h: small scenes, and everything that a simulation shows as numbers to compare.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "../support/sim.hpp"
#include "granperi/gp.h"

namespace api {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

// Of all the scenes here, unless they say otherwise.
constexpr double spacing = 0.01;

inline gp_config make_config() {
    gp_config config;
    EXPECT_EQ(gp_config_init(&config, sizeof config, GP_PRESET_DEFAULT), GP_OK);
    config.spacing = spacing;
    config.threads = 1;
    return config;
}

inline gp_material make_material() {
    gp_material material;
    EXPECT_EQ(gp_material_init(&material, sizeof material), GP_OK);
    return material;
}

// A rectangle of whole spacings.
inline gp_column make_column(int columns, int rows, double x_min = 0, double y_min = 0) {
    gp_column column;
    EXPECT_EQ(gp_column_init(&column, sizeof column), GP_OK);
    column.x_min = x_min;
    column.y_min = y_min;
    column.width = columns * spacing;
    column.height = rows * spacing;
    return column;
}

inline gp_plate make_plate(double x0, double y0, double x1, double y1) {
    gp_plate plate;
    EXPECT_EQ(gp_plate_init(&plate, sizeof plate), GP_OK);
    plate.x0 = x0;
    plate.y0 = y0;
    plate.x1 = x1;
    plate.y1 = y1;
    return plate;
}

inline gp_output make_output() {
    gp_output output;
    EXPECT_EQ(gp_output_init(&output, sizeof output), GP_OK);
    return output;
}

// Material lies above it: the way from end 0 to end 1 leads to the left.
inline gp_plate make_floor(double half_length = 2) {
    return make_plate(half_length, 0, -half_length, 0);
}

// Material is on its right.
inline gp_plate make_left_wall(double x, double height) {
    return make_plate(x, 0, x, height);
}

// Material is on its left, as behind a gate that will be lifted.
inline gp_plate make_right_wall(double x, double height) {
    return make_plate(x, height, x, 0);
}

// With the config of these tests unless it is another one.
struct Sim : test::Sim {
    explicit Sim(const gp_config &config = make_config()) : test::Sim(config) {}
};

// A column on a floor beside a wall, held by a gate that is lifted at 1 m/s: plate 2.
inline void add_collapse(Sim &sim, int columns = 12, int rows = 10) {
    sim.add(make_floor());
    sim.add(make_left_wall(0, (rows + 2) * spacing));
    gp_plate gate = make_right_wall(columns * spacing, (rows + 2) * spacing);
    gate.vy = 1;
    gate.friction = GP_WALL_COULOMB;
    gate.wall_mu = 0.2;
    sim.add(gate);
    sim.add(make_column(columns, rows));
}

inline uint64_t bits_of(double value) {
    uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
}

constexpr int numbers_of_load = 10;

// All that the simulation shows, as bits: every field in the order of id, the state but for the wall-clock time, loads.
inline std::vector<uint64_t> snapshot(const Sim &sim, int32_t plates = 0) {
    std::vector<uint64_t> bits;
    const auto add = [&](double value) { bits.push_back(bits_of(value)); };
    for (uint32_t bit = 1; bit & GP_FIELD_ALL; bit <<= 1)
        for (const double value : sim.field(bit))
            add(value);
    const gp_state s = sim.state();
    for (const double value : {s.time,
                               static_cast<double>(s.step),
                               s.dt,
                               static_cast<double>(s.n_particles),
                               static_cast<double>(s.n_awake),
                               s.kinetic,
                               s.potential,
                               s.elastic,
                               s.dissipated,
                               s.plate_work,
                               s.energy_error,
                               s.momentum_x,
                               s.momentum_y,
                               s.max_speed,
                               s.rms_speed,
                               s.x_left,
                               s.x_right,
                               s.peak_x,
                               s.peak_height,
                               s.max_pressure,
                               static_cast<double>(s.at_rest),
                               static_cast<double>(s.collisions),
                               s.sound_speed,
                               s.penalty_dissipated,
                               s.wall_dissipated,
                               s.bulk_dissipated,
                               s.collision_dissipated,
                               s.spacing_dissipated,
                               s.x_q01,
                               s.x_q05,
                               s.x_q25,
                               s.x_q50,
                               s.x_q75,
                               s.x_q95,
                               s.x_q99,
                               s.centre_x,
                               s.centre_y,
                               s.detached,
                               s.volume_drift})
        add(value);
    for (int32_t k = 0; k < plates; ++k) {
        const auto load = sim.load(k);
        for (const double value : {load.fx, load.fy, load.torque, load.dx, load.dy, load.impulse_x, load.impulse_y,
                                   load.torque_pivot, load.angle, load.impulse_torque})
            add(value);
    }
    return bits;
}

inline bool last_error_has(const std::string &text) {
    return std::string(gp_last_error()).find(text) != std::string::npos;
}

// The call failed with this status, and the text names what was wrong.
#define EXPECT_FAILS(call, expected_status, named)                                                                     \
    do {                                                                                                               \
        EXPECT_EQ(call, expected_status) << gp_last_error();                                                           \
        EXPECT_TRUE(::api::last_error_has(named))                                                                      \
            << "gp_last_error() = \"" << gp_last_error() << "\" does not name " << (named);                            \
    } while (false)

inline bool has(const char *feature) {
    return gp_has_feature(feature) == 1;
}

} // namespace api
