// What follows from a complete scene: the sound speed and the material constants.
#include <algorithm>
#include <cmath>

#include "scene.hpp"

namespace gp {

namespace {

// Shear modulus over bulk modulus. Any value of this order gives the same deposit: below yield the material only has to
// be stiff against its weight, and the wave speed, hence the time step, grows with it.
constexpr double shear_to_bulk = 0.3;

// Sound speed over the largest flow speed, so that the density varies by about 1 % ([1], section 2.2).
constexpr double sound_to_flow_speed = 10.0;

// Largest time step of a loaded plate of mass m per area, over sqrt(m dl / rho) / wave speed: it rests on a spring of the
// stiffness rho c^2 / dl per area.
constexpr double plate_share = 1.0;

// Mass per area of a loaded plate that has none of its own, in rho dl. A light plate follows its load at once; heavier
// ones ring on the material, which damps so slow a motion little: on a column of 20 spacings, masses of .01 to .5 come
// to rest, from 1 on plate and material keep trembling (kinetic energy 3e-6 of the whole).
constexpr double light_plate = 0.5;

struct Range {
    double low = INFINITY, high = -INFINITY;
    void add(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
    double span() const { return high > low ? high - low : 0.0; }
};

// The part of a plate's velocity that the material takes part in: a free-slip plate passes on its normal motion alone.
Vector effective_velocity(const PlateSpec &plate, const Vector &velocity) {
    if (plate.friction == GP_WALL_FREE_SLIP)
        return plate.segment.normal * plate.segment.normal.dot(velocity);
    return velocity;
}

// Largest difference between any two velocities with which the scene begins or which it prescribes.
double velocity_span(const Scene &scene) {
    Range x, y;
    for (std::size_t i = 0; i < scene.vx.size(); ++i) {
        x.add(scene.vx[i]);
        y.add(scene.vy[i]);
    }
    const auto add = [&](const Vector &v) {
        x.add(v.x());
        y.add(v.y());
    };
    for (const PlateSpec &plate : scene.plates()) {
        add(effective_velocity(plate, plate.velocity));
        for (std::size_t k = 1; k < plate.table.t.size(); ++k) {
            const double dt = plate.table.t[k] - plate.table.t[k - 1];
            add(effective_velocity(plate, {(plate.table.x[k] - plate.table.x[k - 1]) / dt,
                                           (plate.table.y[k] - plate.table.y[k - 1]) / dt}));
        }
    }
    return std::hypot(x.span(), y.span());
}

// Height through which material can fall: from its highest point to its own lowest one or to the lowest point beneath it
// of a plate that faces up.
double fall_height(const Scene &scene, const Vector &gravity) {
    if (gravity.norm() == 0 || scene.x.empty())
        return 0;
    const Vector up = -gravity.normalized(), across(-up.y(), up.x());
    Range height, width;
    for (std::size_t i = 0; i < scene.x.size(); ++i) {
        const Vector r(scene.x[i], scene.y[i]);
        height.add(up.dot(r));
        width.add(across.dot(r));
    }
    const double half = 0.5 * scene.config().spacing;
    double lowest = height.low - half;
    for (const PlateSpec &plate : scene.plates()) {
        const Segment &s = plate.segment;
        if (s.normal.dot(up) <= 0)
            continue;
        // The stretch of the plate under the material.
        const double from = across.dot(s.origin), slope = across.dot(s.tangent);
        double t0 = 0, t1 = s.length;
        if (slope != 0) {
            const double a = (width.low - half - from) / slope, b = (width.high + half - from) / slope;
            t0 = std::max(t0, std::min(a, b));
            t1 = std::min(t1, std::max(a, b));
        } else if (from < width.low - half || from > width.high + half)
            continue;
        if (t0 > t1)
            continue;
        const double base = up.dot(s.origin), rise = up.dot(s.tangent);
        lowest = std::min({lowest, base + rise * t0, base + rise * t1});
    }
    return height.high + half - lowest;
}

} // namespace

Constants Scene::constants() const {
    Constants c;
    c.spacing = config_.spacing;
    c.volume = c.spacing * c.spacing;
    c.gravity = Vector(config_.gravity_x, config_.gravity_y);
    c.period = period();
    c.horizon = config_.horizon_length > 0 ? config_.horizon_length : config_.horizon * c.spacing;
    c.interaction_radius = config_.interaction_radius * c.spacing;
    c.lattice = lattice_sums(c.horizon, c.spacing);
    c.scheme = scheme_of(config_);
    c.interaction_lattice = lattice_sums(c.interaction_radius, c.spacing);
    c.reach = !by_number_density(c.scheme)      ? c.horizon
              : c.scheme == Scheme::paper_local ? c.interaction_radius
                                                : std::max(c.horizon, c.interaction_radius);

    double lightest = INFINITY, heaviest = 0; // kg/m3, of the materials in use
    for (const Body &body : bodies_) {
        const gp_material &m = materials_[static_cast<std::size_t>(body.material)];
        lightest = std::min(lightest, m.volume_fraction * m.grain_density);
        heaviest = std::max(heaviest, m.volume_fraction * m.grain_density);
    }

    const double g = c.gravity.norm();
    c.fall_height = fall_height(*this, c.gravity);
    const double span = velocity_span(*this);
    // A load p compresses the material as a column of the height p / (rho g) does.
    double load_height = 0; // m2/s2, times g
    for (const PlateSpec &plate : plates_)
        if (plate.load > 0)
            load_height = std::max(load_height, plate.load / lightest);
    const double fastest = std::sqrt(2 * (g * c.fall_height + load_height) + span * span);
    c.sound_speed_is_arbitrary = config_.sound_speed == 0 && fastest == 0;
    c.sound_speed = config_.sound_speed > 0 ? config_.sound_speed : (fastest > 0 ? sound_to_flow_speed * fastest : 1.0);
    c.wave_speed = c.scheme == Scheme::adjoint ? c.sound_speed * std::sqrt(1 + shear_to_bulk) : c.sound_speed;
    c.time_scale = g > 0 && c.fall_height > 0 ? std::sqrt(c.fall_height / g) : 100 * c.spacing / c.sound_speed;

    for (const gp_material &m : materials_) {
        MaterialConstants k;
        k.grain_density = m.grain_density;
        k.grain_diameter = m.grain_diameter;
        k.density = m.volume_fraction * m.grain_density;
        k.bulk_modulus = k.density * c.sound_speed * c.sound_speed;
        k.map.mu_s = config_.friction_factor * m.mu_s;
        k.map.mu_2 = config_.friction_factor * m.mu_2;
        k.map.rate_factor = m.i0 / (m.grain_diameter * std::sqrt(m.grain_density));
        k.map.shear_modulus = shear_to_bulk * k.bulk_modulus;
        k.law = {k.map.mu_s, k.map.mu_2, k.map.rate_factor, config_.delta};
        c.materials.push_back(k);
    }
    c.body_material.reserve(bodies_.size());
    for (const Body &body : bodies_)
        c.body_material.push_back(body.material);
    c.plate_mass = light_plate * heaviest * c.spacing;
    c.plate_step = INFINITY;
    for (const PlateSpec &plate : plates_)
        if (plate.load > 0 && heaviest > 0)
            c.plate_step =
                std::min(c.plate_step,
                         plate_share * std::sqrt((plate.mass > 0 ? plate.mass : c.plate_mass) * c.spacing / heaviest) /
                             c.wave_speed);
    // One coefficient for all pairs keeps momentum; the lightest material keeps it stable.
    c.penalty = bodies_.empty()
                    ? 0.0
                    : config_.zero_energy_penalty * lightest * c.sound_speed / (c.spacing * c.lattice.number_density);
    return c;
}

} // namespace gp
