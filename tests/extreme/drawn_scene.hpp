// Scenes drawn at random, each from its own number: columns, sets of particles, plates of every kind in any place, periods,
// materials, laws, gravity in any direction.
#pragma once

#include <cmath>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "../support/scene.hpp"

namespace test {

class Dice {
public:
    explicit Dice(uint64_t seed) : generator_(seed) {}
    double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(generator_); }
    double log_between(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
    int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(generator_); }
    bool chance(double share) { return between(0, 1) < share; }
    template <class T> T one_of(std::initializer_list<T> choices) {
        return *(choices.begin() + whole(0, static_cast<int>(choices.size()) - 1));
    }

private:
    std::mt19937_64 generator_;
};

struct DrawnPlate {
    gp_plate plate;
    std::vector<double> t, x, y, angle; // its table; angle may be empty
    std::vector<double> line_x, line_y; // empty: a straight plate
};

struct DrawnSet {
    int32_t material;
    std::vector<double> x, y, vx, vy;
};

// All that a scene is made of, so that it can be built again: with other threads, or mirrored.
struct Drawn {
    gp_config config;
    std::vector<gp_material> materials;
    std::vector<gp_column> columns;
    std::vector<DrawnSet> sets;
    std::vector<DrawnPlate> plates;
    int64_t steps;
};

inline gp_config draw_scheme(Dice &dice) {
    gp_config c;
    const int32_t preset =
        dice.chance(0.7) ? GP_PRESET_DEFAULT : dice.one_of<int32_t>({GP_PRESET_PAPER, GP_PRESET_PAPER_LOCAL});
    EXPECT_EQ(gp_config_init(&c, sizeof c, preset), GP_OK);
    return c;
}

inline gp_config draw_config(Dice &dice) {
    gp_config c = draw_scheme(dice);
    c.threads = 1;
    c.spacing = dice.log_between(1e-4, 1);
    const double g = dice.chance(0.2) ? 0 : 9.81 * dice.log_between(0.1, 10);
    const double tilt = dice.chance(0.6) ? 0 : dice.between(-pi, pi);
    c.gravity_x = g * std::sin(tilt);
    c.gravity_y = -g * std::cos(tilt);
    if (dice.chance(0.3))
        c.sound_speed = std::sqrt(20 * 9.81 * c.spacing) * dice.log_between(1, 100);
    if (dice.chance(0.2))
        c.cfl = dice.between(0.05, 1);
    if (dice.chance(0.3))
        c.horizon = dice.between(1.8, 6);
    if (dice.chance(0.1))
        c.interaction_radius = dice.between(1.5, 5);
    if (dice.chance(0.2))
        c.friction_factor = dice.between(0, 3);
    if (dice.chance(0.2))
        c.collision_distance = dice.between(0, 1);
    if (c.preset == GP_PRESET_DEFAULT) {
        if (dice.chance(0.2))
            c.zero_energy_penalty = dice.between(0, 0.5);
        if (dice.chance(0.2))
            c.density_diffusion = dice.between(0, 1);
        if (dice.chance(0.2))
            c.bulk_viscosity = dice.between(0, 1);
    }
    if (dice.chance(0.1)) {
        c.channel_width = c.spacing * dice.log_between(1, 100);
        c.channel_friction = dice.between(0, 1);
    }
    if (dice.chance(0.2)) {
        c.periodic_x_min = -c.spacing * dice.whole(5, 12);
        c.periodic_x_max = c.spacing * dice.whole(5, 12);
    }
    if (dice.chance(0.3)) {
        c.jitter = dice.between(0, 0.49);
        c.seed = static_cast<uint64_t>(dice.whole(0, 1 << 30));
    }
    // What has to be refused.
    if (dice.chance(0.03))
        *dice.one_of({&c.spacing, &c.horizon, &c.jitter, &c.cfl, &c.delta}) =
            dice.one_of({-1.0, std::nan(""), HUGE_VAL, 1e300});
    return c;
}

inline gp_material draw_material(Dice &dice) {
    gp_material m;
    EXPECT_EQ(gp_material_init(&m, sizeof m), GP_OK);
    m.grain_density = dice.log_between(1, 1e5);
    m.volume_fraction = dice.between(0.05, 1);
    m.grain_diameter = dice.log_between(1e-5, 1);
    m.mu_s = dice.chance(0.2) ? 0 : dice.log_between(0.05, 2);
    m.mu_2 = m.mu_s * (dice.chance(0.3) ? 1 : dice.between(1, 3));
    m.i0 = dice.log_between(1e-9, 1e9);
    return m;
}

inline DrawnPlate draw_plate(Dice &dice, double dl, double speed) {
    DrawnPlate drawn;
    gp_plate &p = drawn.plate;
    EXPECT_EQ(gp_plate_init(&p, sizeof p), GP_OK);
    if (dice.chance(0.4)) { // a floor
        p.x0 = dl * dice.between(10, 30);
        p.x1 = -p.x0;
        p.y0 = p.y1 = dice.chance(0.7) ? 0 : dl * dice.between(-3, 0);
    } else if (dice.chance(0.4)) { // a wall that faces the middle
        const double side = dice.one_of({-1.0, 1.0});
        p.x0 = p.x1 = side * dl * dice.whole(2, 8);
        p.y0 = side < 0 ? 0 : 20 * dl;
        p.y1 = side < 0 ? 20 * dl : 0;
    } else { // anywhere, also amid material
        for (double *each : {&p.x0, &p.y0, &p.x1, &p.y1})
            *each = dl * dice.between(-10, 10);
    }
    p.friction = dice.one_of<int32_t>({GP_WALL_NO_SLIP, GP_WALL_FREE_SLIP, GP_WALL_COULOMB});
    if (p.friction == GP_WALL_COULOMB)
        p.wall_mu = dice.between(0, 1);
    if (dice.chance(0.25)) {
        p.vx = speed * dice.between(-1, 1);
        p.vy = speed * dice.between(-1, 1);
    } else if (dice.chance(0.15)) {
        const int knots = dice.whole(1, 4);
        for (int k = 0; k < knots; ++k) {
            drawn.t.push_back((k > 0 ? drawn.t.back() : 0) + dl / speed * dice.log_between(0.1, 10));
            drawn.x.push_back((k > 0 ? drawn.x.back() : 0) + dl * dice.between(-0.5, 0.5));
            drawn.y.push_back((k > 0 ? drawn.y.back() : 0) + dl * dice.between(-0.5, 0.5));
        }
    } else if (dice.chance(0.15)) {
        p.normal_pressure = 1000 * 9.81 * dl * dice.log_between(0.1, 10);
        if (dice.chance(0.5))
            p.mass_per_length = 1000 * dl * dice.log_between(0.1, 10);
    }
    return drawn;
}

// Of a third of the scenes that can have one, materials with a granular fluidity, of any strength and pace. By dice of its own:
// the scenes are otherwise what they are without.
inline void draw_fluidity(uint64_t seed, Drawn &s) {
    Dice dice(seed + 0x9E3779B97F4A7C15u);
    if (s.config.preset != GP_PRESET_DEFAULT || s.config.stress != GP_STRESS_ELASTIC || !dice.chance(0.33))
        return;
    for (gp_material &m : s.materials)
        if ((m.mu_s > 0 && m.mu_2 > m.mu_s && dice.chance(0.8)) || dice.chance(0.02)) { // else refused
            m.nonlocal_amplitude = dice.log_between(1e-2, 10);
            m.fluidity_time = dice.log_between(1e-7, 1);
        }
    for (DrawnPlate &drawn : s.plates)
        drawn.plate.fluidity = dice.chance(0.5) ? GP_FLUIDITY_ZERO : GP_FLUIDITY_FREE;
}

// A quarter of the plates turn, run as a belt or are lines of several segments, some of which cross themselves.
inline void draw_more(Dice &dice, double dl, double speed, DrawnPlate &drawn) {
    gp_plate &p = drawn.plate;
    if (dice.chance(0.12)) {
        if (dice.chance(0.5)) { // a ring, the material inside or outside
            const int count = dice.whole(3, 12);
            const double radius = dl * dice.between(2, 12), sense = dice.one_of({-1.0, 1.0});
            for (int k = 0; k <= count; ++k) {
                drawn.line_x.push_back(radius * std::cos(sense * 2 * pi * (k % count) / count));
                drawn.line_y.push_back(radius * (1 + std::sin(sense * 2 * pi * (k % count) / count)));
            }
        } else { // the way of the plate, less straight
            const int count = dice.whole(1, 8);
            for (int k = 0; k <= count; ++k) {
                drawn.line_x.push_back(p.x0 + (p.x1 - p.x0) * k / count + dl * dice.between(-1, 1));
                drawn.line_y.push_back(p.y0 + (p.y1 - p.y0) * k / count + dl * dice.between(-1, 1));
            }
        }
        p.x0 = p.y0 = p.x1 = p.y1 = 0;
    }
    if (dice.chance(0.12) && p.normal_pressure == 0) {
        p.pivot_x = dl * dice.between(-10, 10);
        p.pivot_y = dl * dice.between(-5, 15);
        const double omega = 0.1 * speed / dl * dice.between(-1, 1);
        if (drawn.t.empty())
            p.omega = omega;
        for (const double t : drawn.t)
            drawn.angle.push_back(omega * t);
    }
    if (dice.chance(0.08) && p.friction != GP_WALL_FREE_SLIP)
        p.surface_velocity = speed * dice.between(-1, 1);
}

inline Drawn draw(uint64_t seed) {
    Dice dice(seed), more(~seed);
    Drawn s;
    s.config = draw_config(dice);
    const double dl = s.config.spacing > 0 && s.config.spacing < 1e9 ? s.config.spacing : 1;
    const double speed = std::sqrt(9.81 * dl) * dice.log_between(0.1, 30);
    for (int n = dice.whole(0, 2); n > 0; --n)
        s.materials.push_back(draw_material(dice));
    const auto material = [&] { return static_cast<int32_t>(dice.whole(0, static_cast<int>(s.materials.size()))); };
    const bool moving = dice.chance(0.4);
    for (int n = dice.whole(0, 2); n > 0; --n) {
        gp_column c;
        EXPECT_EQ(gp_column_init(&c, sizeof c), GP_OK);
        c.x_min = dl * dice.whole(-5, 1);
        c.y_min = dice.chance(0.7) ? 0 : dl * dice.between(-2, 8);
        c.width = dl * dice.whole(1, 9);
        c.height = dl * dice.whole(1, 8);
        c.material = material();
        c.initial_pressure = dice.whole(0, 1);
        if (moving) {
            c.vx = speed * dice.between(-1, 1);
            c.vy = speed * dice.between(-1, 1);
        }
        s.columns.push_back(c);
    }
    for (int n = dice.whole(0, 2); n > 0; --n) {
        DrawnSet set{material(), {}, {}, {}, {}};
        const double extent = dl * dice.log_between(0.01, 20); // down to heaps of particles on top of each other
        const bool collinear = dice.chance(0.2), coincident = dice.chance(0.1);
        for (int k = dice.whole(1, 30); k > 0; --k) {
            set.x.push_back(coincident ? 0 : extent * dice.between(-0.5, 0.5));
            set.y.push_back(coincident || collinear ? dl : dl + extent * dice.between(0, 1));
            set.vx.push_back(moving ? speed * dice.between(-1, 1) : 0);
            set.vy.push_back(moving ? speed * dice.between(-1, 1) : 0);
        }
        s.sets.push_back(set);
    }
    for (int n = dice.whole(0, 4); n > 0; --n)
        s.plates.push_back(draw_plate(dice, dl, speed));
    for (DrawnPlate &drawn : s.plates)
        draw_more(more, dl, speed, drawn);
    s.steps = dice.whole(20, 100);
    if (s.config.preset == GP_PRESET_DEFAULT && dice.chance(0.14)) { // a tenth of all scenes
        s.config.stress = GP_STRESS_IMPLICIT;
        s.config.delta = dice.log_between(1e-8, 1e-2);
    }
    draw_fluidity(seed, s);
    return s;
}

// Ghosts stand on a lattice that begins at a plate's end 0: only with whole spacings does the other end give the same one.
inline void make_plates_whole(Drawn &scene) {
    for (DrawnPlate &drawn : scene.plates) {
        gp_plate &p = drawn.plate;
        const double dl = scene.config.spacing, length = std::hypot(p.x1 - p.x0, p.y1 - p.y0);
        const double scale = std::max(1.0, std::round(length / dl)) * dl / length;
        p.x1 = p.x0 + scale * (p.x1 - p.x0);
        p.y1 = p.y0 + scale * (p.y1 - p.y0);
    }
}

// The same about the axis x = 0. Plates change ends: their body stays on the left.
inline Drawn mirrored(const Drawn &scene) {
    Drawn m = scene;
    m.config.gravity_x = -m.config.gravity_x;
    m.config.periodic_x_min = -scene.config.periodic_x_max;
    m.config.periodic_x_max = -scene.config.periodic_x_min;
    for (gp_column &c : m.columns) {
        c.x_min = -c.x_min - std::round(c.width / m.config.spacing) * m.config.spacing;
        c.vx = -c.vx;
    }
    for (DrawnSet &set : m.sets)
        for (std::vector<double> *each : {&set.x, &set.vx})
            for (double &value : *each)
                value = -value;
    for (DrawnPlate &drawn : m.plates) {
        gp_plate &p = drawn.plate;
        std::swap(p.x0, p.x1);
        std::swap(p.y0, p.y1);
        p.x0 = -p.x0;
        p.x1 = -p.x1;
        p.vx = -p.vx;
        p.pivot_x = -p.pivot_x;
        p.omega = -p.omega;
        p.surface_velocity = -p.surface_velocity; // the way is the other one
        for (std::vector<double> *each : {&drawn.x, &drawn.angle})
            for (double &value : *each)
                value = -value;
    }
    return m;
}

// A simulation, if no call refused it.
struct Built {
    gp_status status; // GP_OK, or the refusal of the first call that refused
    Sim sim;
};

inline Built build(const Drawn &scene) {
    gp_sim *sim = nullptr;
    gp_status status = gp_create(&scene.config, &sim);
    const auto then = [&](gp_status next) { status = status == GP_OK ? next : status; };
    for (std::size_t k = 0; status == GP_OK && k < scene.materials.size(); ++k)
        then(gp_add_material(sim, &scene.materials[k], nullptr));
    for (std::size_t k = 0; status == GP_OK && k < scene.columns.size(); ++k)
        then(gp_add_column(sim, &scene.columns[k], nullptr));
    for (std::size_t k = 0; status == GP_OK && k < scene.sets.size(); ++k) {
        const DrawnSet &s = scene.sets[k];
        then(gp_add_particles(sim, s.material, static_cast<int64_t>(s.x.size()), s.x.data(), s.y.data(), s.vx.data(),
                              s.vy.data(), nullptr));
    }
    for (std::size_t k = 0; status == GP_OK && k < scene.plates.size(); ++k) {
        gp_plate p = scene.plates[k].plate;
        p.n_knots = static_cast<int64_t>(scene.plates[k].t.size());
        p.knot_t = scene.plates[k].t.data();
        p.knot_x = scene.plates[k].x.data();
        p.knot_y = scene.plates[k].y.data();
        p.knot_angle = scene.plates[k].angle.empty() ? nullptr : scene.plates[k].angle.data();
        p.n_points = static_cast<int64_t>(scene.plates[k].line_x.size());
        p.point_x = scene.plates[k].line_x.data();
        p.point_y = scene.plates[k].line_y.data();
        then(gp_add_plate(sim, &p, nullptr));
    }
    return {status, Sim(sim)};
}

inline std::string description(uint64_t seed, const Drawn &s) {
    std::ostringstream text;
    text << "GRANPERI_SEED=" << seed << " GRANPERI_SCENES=1; preset " << s.config.preset << ", stress "
         << s.config.stress << ", delta " << s.config.delta << ", dl " << s.config.spacing << ", g ("
         << s.config.gravity_x << ", " << s.config.gravity_y << "), c " << s.config.sound_speed << ", horizon "
         << s.config.horizon << ", cfl " << s.config.cfl << ", collisions " << s.config.collision_distance
         << ", penalty " << s.config.zero_energy_penalty << ", diffusion " << s.config.density_diffusion << ", bulk "
         << s.config.bulk_viscosity << ", period " << s.config.periodic_x_max - s.config.periodic_x_min << ", channel "
         << s.config.channel_width << ", jitter " << s.config.jitter;
    for (const gp_material &m : s.materials)
        text << "; material of " << m.grain_density * m.volume_fraction << " kg/m3, d " << m.grain_diameter << ", mu "
             << m.mu_s << " to " << m.mu_2 << ", I0 " << m.i0 << ", amplitude " << m.nonlocal_amplitude << ", t0 "
             << m.fluidity_time;
    for (const gp_column &c : s.columns)
        text << "; column (" << c.x_min / s.config.spacing << ", " << c.y_min / s.config.spacing << ") "
             << c.width / s.config.spacing << " x " << c.height / s.config.spacing << " dl, material " << c.material
             << ", v (" << c.vx << ", " << c.vy << ")";
    for (const DrawnSet &set : s.sets)
        text << "; " << set.x.size() << " particles of material " << set.material;
    for (const DrawnPlate &d : s.plates)
        text << "; plate (" << d.plate.x0 / s.config.spacing << ", " << d.plate.y0 / s.config.spacing << ")-("
             << d.plate.x1 / s.config.spacing << ", " << d.plate.y1 / s.config.spacing << ") dl, friction "
             << d.plate.friction << ", v (" << d.plate.vx << ", " << d.plate.vy << "), knots " << d.t.size()
             << ", load " << d.plate.normal_pressure << ", mass " << d.plate.mass_per_length << ", points "
             << d.line_x.size() << ", omega " << d.plate.omega << ", angles " << d.angle.size() << ", belt "
             << d.plate.surface_velocity;
    return text.str();
}

} // namespace test
