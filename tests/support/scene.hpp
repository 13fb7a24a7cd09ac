// Short words for the tests: the usual config, plates and column.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "granperi/gp.h"
#include "sim.hpp"

namespace test {

const double pi = std::acos(-1.0);
inline double degrees(double angle) {
    return angle * pi / 180;
}

inline gp_config config(double spacing) {
    gp_config c;
    EXPECT_EQ(gp_config_init(&c, sizeof c, GP_PRESET_DEFAULT), GP_OK);
    c.spacing = spacing;
    c.threads = 1;
    return c;
}

// Periodic in x from 0 to `length`, and drawn to the right.
inline gp_config flowing_round(double spacing, double length, double gravity_x) {
    gp_config c = config(spacing);
    c.periodic_x_max = length;
    c.gravity_x = gravity_x;
    return c;
}

// A plate from (x0, y0) to (x1, y1): its body is on the left of that way.
inline gp_plate plate(double x0, double y0, double x1, double y1, int32_t friction = GP_WALL_NO_SLIP) {
    gp_plate p;
    EXPECT_EQ(gp_plate_init(&p, sizeof p), GP_OK);
    p.x0 = x0;
    p.y0 = y0;
    p.x1 = x1;
    p.y1 = y1;
    p.friction = friction;
    return p;
}

inline gp_plate floor_at(double y, double x_min, double x_max, int32_t friction = GP_WALL_NO_SLIP) {
    return plate(x_max, y, x_min, y, friction);
}

inline double mean(const std::vector<double> &values) {
    double sum = 0;
    for (const double value : values)
        sum += value;
    return sum / static_cast<double>(values.size());
}

// The column of the seed's first scene: a = 1.25, L = 0.08 m on a rough floor, released at once.
struct Collapse {
    static constexpr double length = 0.08, height = 0.05, density = 1550, gravity = 9.81;
    static constexpr double energy = density * gravity * length * height * height / 2; // J/m
    static constexpr double base_pressure = density * gravity * height;                // Pa
    Collapse(int resolution, double mu_s_degrees = 21, double mu_2_degrees = 32, int threads = 1,
             int32_t stress = GP_STRESS_ELASTIC, double delta = 1e-6, const gp_plate *floor = nullptr)
        : sim([&] {
              gp_config c = config(length / resolution);
              c.threads = threads;
              c.stress = stress;
              c.delta = delta;
              return c;
          }()) {
        const int32_t beads = sim.material(std::tan(degrees(mu_s_degrees)), std::tan(degrees(mu_2_degrees)));
        sim.column(-length / 2, 0, length, height, beads);
        sim.add(floor ? *floor : floor_at(0, -0.4, 0.4));
    }
    Sim sim;
};

} // namespace test
