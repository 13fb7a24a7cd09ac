// Short words for the tests: a simulation that frees itself, the usual plates, and fields as vectors.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "granperi/gp.h"

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

class Sim {
public:
    explicit Sim(const gp_config &c) { EXPECT_EQ(gp_create(&c, &sim_), GP_OK) << gp_last_error(); }
    explicit Sim(gp_sim *owned) : sim_(owned) {}
    Sim(const Sim &) = delete;
    Sim &operator=(const Sim &) = delete;
    ~Sim() { gp_destroy(sim_); }
    operator gp_sim *() { return sim_; }

    int32_t material(double mu_s, double mu_2) {
        gp_material m;
        EXPECT_EQ(gp_material_init(&m, sizeof m), GP_OK);
        m.mu_s = mu_s;
        m.mu_2 = mu_2;
        return material(m);
    }
    int32_t material(const gp_material &m) {
        int32_t id = -1;
        EXPECT_EQ(gp_add_material(sim_, &m, &id), GP_OK) << gp_last_error();
        return id;
    }
    int32_t column(double x_min, double y_min, double width, double height, int32_t material = 0, double vx = 0,
                   double vy = 0) {
        gp_column c;
        EXPECT_EQ(gp_column_init(&c, sizeof c), GP_OK);
        c.x_min = x_min;
        c.y_min = y_min;
        c.width = width;
        c.height = height;
        c.material = material;
        c.vx = vx;
        c.vy = vy;
        int32_t id = -1;
        EXPECT_EQ(gp_add_column(sim_, &c, &id), GP_OK) << gp_last_error();
        return id;
    }
    int32_t add(const gp_plate &p) {
        int32_t id = -1;
        EXPECT_EQ(gp_add_plate(sim_, &p, &id), GP_OK) << gp_last_error();
        return id;
    }
    void run(double t_end) { ASSERT_EQ(gp_run(sim_, t_end), GP_OK) << gp_last_error(); }
    void step(int64_t n = 1) { ASSERT_EQ(gp_step(sim_, n), GP_OK) << gp_last_error(); }

    gp_state state() {
        gp_state s{};
        s.struct_size = sizeof s;
        EXPECT_EQ(gp_get_state(sim_, &s), GP_OK) << gp_last_error();
        return s;
    }
    gp_load load(int32_t plate) {
        gp_load l{};
        l.struct_size = sizeof l;
        EXPECT_EQ(gp_get_plate_load(sim_, plate, &l), GP_OK) << gp_last_error();
        return l;
    }
    std::vector<double> field(uint32_t bit) {
        std::vector<double> values(static_cast<std::size_t>(state().n_particles));
        EXPECT_EQ(gp_copy_field(sim_, bit, values.data(), static_cast<int64_t>(values.size())), GP_OK)
            << gp_last_error();
        return values;
    }

private:
    gp_sim *sim_ = nullptr;
};

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
