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

inline gp_column thrown(gp_column column, double vx, double vy) {
    column.vx = vx;
    column.vy = vy;
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

// What follows is what a simulation shows, as bits. Every field of these in the order of id.
inline void add_fields(std::vector<uint64_t> &bits, const Sim &sim, uint32_t fields = GP_FIELD_ALL) {
    for (uint32_t bit = 1; bit & GP_FIELD_ALL; bit <<= 1)
        if (bit & fields)
            for (const double value : sim.field(bit))
                bits.push_back(bits_of(value));
}

// The whole state, also what it will have one day, but for the wall-clock time. Nobody says what lies between its members:
// behind struct_size, with which it begins, and behind at_rest.
inline void add_state(std::vector<uint64_t> &bits, gp_state state) {
    static_assert(offsetof(gp_state, time) == sizeof(uint64_t) && sizeof state % sizeof(uint64_t) == 0);
    state.wall_seconds = 0;
    unsigned char bytes[sizeof state];
    std::memcpy(bytes, &state, sizeof state);
    constexpr std::size_t after_rest = offsetof(gp_state, at_rest) + sizeof state.at_rest;
    std::memset(bytes + after_rest, 0, offsetof(gp_state, collisions) - after_rest);
    for (std::size_t at = offsetof(gp_state, time); at < sizeof state; at += sizeof(uint64_t)) {
        uint64_t word;
        std::memcpy(&word, bytes + at, sizeof word);
        bits.push_back(word);
    }
}

inline void add_loads(std::vector<uint64_t> &bits, const Sim &sim, int32_t plates) {
    for (int32_t k = 0; k < plates; ++k) {
        const auto load = sim.load(k);
        for (const double value : {load.fx, load.fy, load.torque, load.dx, load.dy, load.impulse_x, load.impulse_y,
                                   load.torque_pivot, load.angle, load.impulse_torque})
            bits.push_back(bits_of(value));
    }
}

// All of that.
inline std::vector<uint64_t> snapshot(const Sim &sim, int32_t plates = 0) {
    std::vector<uint64_t> bits;
    add_fields(bits, sim);
    add_state(bits, sim.state());
    add_loads(bits, sim, plates);
    return bits;
}

// After a step that was taken back the lists are new ones, and with them the ghosts that volume_drift counts.
inline gp_state but_for_lists(gp_state state) {
    state.volume_drift = 0;
    return state;
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
