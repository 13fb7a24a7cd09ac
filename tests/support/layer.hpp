// Layers that are periodic in x, on a rough floor.
#pragma once

#include <algorithm>

#include "scene.hpp"

namespace test {

struct Law {
    double mu_s = std::tan(degrees(21)), mu_2 = std::tan(degrees(32)), i0 = 0.3, d = 0.002;
    double mu(double inertial) const { return mu_s + (mu_2 - mu_s) * inertial / (i0 + inertial); }
    double inertial(double mu) const { return i0 * (mu - mu_s) / (mu_2 - mu); }
    // Bagnold's flow of a layer down a slope in degrees, of volume fraction .62, at the height y:
    // u = 2/3 (I/d) sqrt(phi g cos) [h^1.5 - (h - y)^1.5].
    double bagnold(double slope, double thickness, double y) const {
        return 2.0 / 3 * inertial(std::tan(degrees(slope))) / d * std::sqrt(0.62 * 9.81 * std::cos(degrees(slope))) *
               (std::pow(thickness, 1.5) - std::pow(std::max(thickness - y, 0.0), 1.5));
    }
};

// Ten rows in one piece on a rough floor, at an angle in degrees.
struct InclinedLayer {
    static constexpr double spacing = 0.004, period = 12 * spacing, thickness = 10 * spacing;
    static constexpr double weight = 1550 * 9.81 * period * thickness; // N/m
    explicit InclinedLayer(double angle, int32_t sleep = 0)
        : sim([&] {
              gp_config c = config(spacing);
              c.sleep = sleep;
              c.periodic_x_max = period;
              c.gravity_x = 9.81 * std::sin(degrees(angle));
              c.gravity_y = -9.81 * std::cos(degrees(angle));
              return c;
          }()) {
        sim.column(0, 0, period, thickness);
        sim.add(plate(period, 0, 0, 0));
    }
    Sim sim;
};

// Turns gravity to an angle in degrees.
inline void tilt(gp_sim *sim, double angle) {
    EXPECT_EQ(gp_set_gravity(sim, 9.81 * std::sin(degrees(angle)), -9.81 * std::cos(degrees(angle))), GP_OK)
        << gp_last_error();
}

// Rows of particles, each a column, between y = 0 and thickness; a rough floor.
struct Layer {
    static constexpr int across = 12;
    template <class Velocity>
    Layer(int rows, double thickness, double gx, double gy, double sound_speed, double d, const Velocity &velocity,
          int threads = 1, int32_t stress = GP_STRESS_ELASTIC, double delta = 1e-6)
        : spacing(thickness / rows), width(across * spacing), sim([&] {
              gp_config c = config(thickness / rows);
              c.gravity_x = gx;
              c.gravity_y = gy;
              c.sound_speed = sound_speed;
              c.periodic_x_max = across * c.spacing;
              c.threads = threads;
              c.stress = stress;
              c.delta = delta;
              return c;
          }()) {
        gp_material beads;
        gp_material_init(&beads, sizeof beads);
        beads.grain_diameter = d;
        const int32_t id = sim.add(beads);
        for (int k = 0; k < rows; ++k)
            sim.column(0, k * spacing, width, spacing, id, velocity((k + 0.5) * spacing));
    }
    void lid(double y, double load, double vx) {
        gp_plate p = plate(0, y, width, y);
        p.normal_pressure = load;
        p.vx = vx;
        sim.add(p);
    }
    int32_t floor(double vx = 0) {
        gp_plate p = plate(width, 0, 0, 0);
        p.vx = vx;
        return sim.add(p);
    }
    // Mean over the uppermost twentieth of the rows, at least one, of value over exact.
    template <class Exact> double surface_ratio(int rows, const Exact &exact) {
        const std::vector<double> u = sim.field(GP_FIELD_VX), y = sim.field(GP_FIELD_Y);
        double sum = 0, reference = 0;
        for (std::size_t i = u.size() - static_cast<std::size_t>(across * std::max(1, rows / 20)); i < u.size(); ++i) {
            sum += u[i];
            reference += exact(y[i]);
        }
        return sum / reference;
    }
    double spacing, width;
    Sim sim;
};

} // namespace test
