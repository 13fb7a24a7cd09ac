#include "scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "check.hpp"

namespace gp {

namespace {

// More particles than 32-bit neighbour indices can name.
constexpr int64_t most_particles = std::numeric_limits<int32_t>::max() - 1;

void check_config(const gp_config &c) {
    require_between("gp_config.spacing", c.spacing, 1e-9, 1e9);
    require_quantity("gp_config.gravity_x", c.gravity_x);
    require_quantity("gp_config.gravity_y", c.gravity_y);
    require_not_negative("gp_config.sound_speed", c.sound_speed);
    // Its square, over which densities are, is a number.
    require(c.sound_speed == 0 || c.sound_speed >= 1e-9, "gp_config.sound_speed", c.sound_speed,
            "0 or a number of at least 1e-9 m/s");
    if (c.cfl != 0)
        require_between("gp_config.cfl", c.cfl, 1e-6, 8);
    require_not_negative("gp_config.time_step", c.time_step);
    require_between("gp_config.interaction_radius", c.interaction_radius, 1.5, 8);
    require_between("gp_config.horizon", c.horizon, 1.8, 8);
    require_not_negative("gp_config.horizon_length", c.horizon_length);
    if (c.horizon_length > 0)
        require_between("gp_config.horizon_length / spacing", c.horizon_length / c.spacing, 1.8, 8);
    require_choice("gp_config.nonlocal", c.nonlocal, 2);
    require_choice("gp_config.stress", c.stress, 3);
    require_choice("gp_config.density", c.density, 2);
    require_between("gp_config.friction_factor", c.friction_factor, 0, 10);
    require_positive("gp_config.delta", c.delta);
    require_between("gp_config.collision_distance", c.collision_distance, 0, 1);
    require_between("gp_config.zero_energy_penalty", c.zero_energy_penalty, 0, 0.5);
    require_between("gp_config.density_diffusion", c.density_diffusion, 0, 1);
    require_between("gp_config.bulk_viscosity", c.bulk_viscosity, 0, 1);
    require_not_negative("gp_config.channel_width", c.channel_width);
    require_not_negative("gp_config.channel_friction", c.channel_friction);
    require(c.channel_friction == 0 || c.channel_width > 0, "gp_config.channel_friction", c.channel_friction,
            "0 as long as channel_width is 0");
    require_position("gp_config.periodic_x_min", c.periodic_x_min, c.spacing);
    require_position("gp_config.periodic_x_max", c.periodic_x_max, c.spacing);
    require(c.periodic_x_max >= c.periodic_x_min, "gp_config.periodic_x_max", c.periodic_x_max,
            "a number not below periodic_x_min");
    if (c.periodic_x_max > c.periodic_x_min) {
        const double reach = c.horizon_length > 0 ? c.horizon_length / c.spacing : c.horizon;
        const double least = (2 * std::max(reach, c.interaction_radius) + 2) * c.spacing;
        if (c.periodic_x_max - c.periodic_x_min < least)
            throw make_error(
                GP_E_ARGUMENT,
                "gp_config.periodic_x_max = %g: expected at least periodic_x_min + %g m, twice the horizon or "
                "the interaction radius and two spacings",
                c.periodic_x_max, least);
    }
    require_choice("gp_config.threads", c.threads, 1025);
    require(c.jitter >= 0 && c.jitter < 0.5, "gp_config.jitter", c.jitter, "a number from 0 to below 0.5");
    require_choice("gp_config.preset", c.preset, 3);
    require_between("gp_config.implicit_tolerance", c.implicit_tolerance, 1e-12, 1e-2);
    require_between("gp_config.implicit_iterations", c.implicit_iterations, 1, 10000);
    require_choice("gp_config.allow_unstable_step", c.allow_unstable_step, 2);
    require_choice("gp_config.retry_halvings", c.retry_halvings, 21);
    require_choice("gp_config.sleep", c.sleep, 2);
    if (c.sleep == 1 && scheme_of(c) != Scheme::adjoint)
        throw make_error(GP_E_UNSUPPORTED,
                         "gp_config.sleep = 1: expected 0 with this stress or preset, only the default scheme sleeps");

    if (by_number_density(scheme_of(c))) {
        const char *none = "0: the schemes with GP_DENSITY_NUMBER have none";
        require(c.zero_energy_penalty == 0, "gp_config.zero_energy_penalty", c.zero_energy_penalty, none);
        require(c.density_diffusion == 0, "gp_config.density_diffusion", c.density_diffusion, none);
        require(c.bulk_viscosity == 0, "gp_config.bulk_viscosity", c.bulk_viscosity, none);
    }
#ifndef GP_WITH_OPENMP
    if (c.threads > 1)
        throw make_error(GP_E_UNSUPPORTED, "gp_config.threads = %d: this build has no OpenMP", c.threads);
#endif
}

} // namespace

Scheme scheme_of(const gp_config &c) {
    const bool numbered = c.stress == GP_STRESS_REGULARIZED && c.density == GP_DENSITY_NUMBER;
    if (c.nonlocal == 1 && c.density == GP_DENSITY_CONTINUITY && c.stress != GP_STRESS_REGULARIZED)
        return c.stress == GP_STRESS_IMPLICIT ? Scheme::implicit : Scheme::adjoint;
    if (numbered)
        return c.nonlocal == 1 ? Scheme::paper : Scheme::paper_local;
    // The choice to name is the one that departs from the preset.
    const gp_config own = default_config(c.preset);
    const bool stress = c.stress != own.stress, density = c.density != own.density;
    throw make_error(GP_E_UNSUPPORTED,
                     "gp_config.%s = %d: not with stress = %d, density = %d, nonlocal = %d; possible are "
                     "GP_STRESS_ELASTIC or GP_STRESS_IMPLICIT with GP_DENSITY_CONTINUITY and nonlocal = 1, or "
                     "GP_STRESS_REGULARIZED with GP_DENSITY_NUMBER and nonlocal = 0 or 1",
                     stress    ? "stress"
                     : density ? "density"
                               : "nonlocal",
                     stress    ? c.stress
                     : density ? c.density
                               : c.nonlocal,
                     c.stress, c.density, c.nonlocal);
}

namespace {

// A reproducible number in [-1, 1) from a seed and a counter (the SplitMix64 finaliser).
double hashed_uniform(uint64_t seed, uint64_t counter) {
    uint64_t z = seed + 0x9E3779B97F4A7C15u * (counter + 1);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    z ^= z >> 31;
    return static_cast<double>(z >> 11) * 0x1.0p-52 - 1.0;
}

// A function of its own, so that the product is rounded before it is added to something: never one operation with that.
[[gnu::noinline]] double product(double a, double b) {
    return a * b;
}

} // namespace

Scene::Scene(const gp_config &config) : config_(config) {
    check_config(config_);
    materials_.push_back(default_material());
}

namespace {

// Is the stress with which columns of this material begin inside the yield surface?
void check_k0(const gp_material &m, const gp_config &config) {
    if (m.k0 == 0)
        return;
    require(scheme_of(config) == Scheme::adjoint, "gp_material.k0", m.k0,
            "0: only columns of GP_STRESS_ELASTIC begin with a deviator");
    const double mu = config.friction_factor * m.mu_s;
    const double least = mu < 1 ? (1 - mu) / (1 + mu) : 0, most = mu < 1 ? (1 + mu) / (1 - mu) : INFINITY;
    if (!(m.k0 > 0 && std::isfinite(m.k0) && m.k0 >= least * (1 - 1e-12) && m.k0 <= most * (1 + 1e-12)))
        throw make_error(
            GP_E_ARGUMENT,
            "gp_material.k0 = %g: expected 0 or a number from %g to %g, within the yield of friction_factor "
            "mu_s = %g",
            m.k0, least, most, mu);
}

} // namespace

int32_t Scene::add_material(const gp_material &m) {
    require(m.grain_density > 0 && m.grain_density <= largest_quantity, "gp_material.grain_density", m.grain_density,
            "a number > 0 and <= 1e50");
    require(m.volume_fraction > 0 && m.volume_fraction <= 1, "gp_material.volume_fraction", m.volume_fraction,
            "a number > 0 and <= 1");
    require_positive("gp_material.grain_diameter", m.grain_diameter);
    require_not_negative("gp_material.mu_s", m.mu_s);
    require_finite("gp_material.mu_2", m.mu_2);
    if (m.mu_2 < m.mu_s)
        throw make_error(GP_E_ARGUMENT, "gp_material.mu_2 = %g: expected a number >= mu_s = %g", m.mu_2, m.mu_s);
    require_positive("gp_material.i0", m.i0);
    require_between("gp_material.nonlocal_amplitude", m.nonlocal_amplitude, 0, 10);
    require_positive("gp_material.fluidity_time", m.fluidity_time);
    if (m.nonlocal_amplitude > 0) {
        if (scheme_of(config_) != Scheme::adjoint)
            throw make_error(GP_E_UNSUPPORTED,
                             "gp_material.nonlocal_amplitude = %g: expected 0, the fluidity is of the default scheme",
                             m.nonlocal_amplitude);
        require(m.mu_s > 0, "gp_material.mu_s", m.mu_s, "a number > 0 with nonlocal_amplitude");
        require(m.mu_2 > m.mu_s, "gp_material.mu_2", m.mu_2, "a number > mu_s with nonlocal_amplitude");
        require(config_.friction_factor > 0, "gp_config.friction_factor", config_.friction_factor,
                "a number > 0 with gp_material.nonlocal_amplitude");
    }
    check_k0(m, config_);
    materials_.push_back(m);
    return static_cast<int32_t>(materials_.size()) - 1;
}

Vector Scene::position(const Body &body, int64_t id) const {
    if (!body.rectangle)
        return {body.set[0][id - body.first], body.set[1][id - body.first]};
    const double spacing = config_.spacing, jitter = config_.jitter * spacing;
    const int64_t row = (id - body.first) / body.across, across = (id - body.first) % body.across;
    const auto counter = static_cast<uint64_t>(id);
    const auto displacement = [&](uint64_t number) {
        return jitter > 0 ? product(jitter, hashed_uniform(config_.seed, number)) : 0.0;
    };
    return {body.x_min + (static_cast<double>(across) + 0.5) * spacing + displacement(2 * counter),
            body.y_min + product(static_cast<double>(row) + 0.5, spacing) + displacement(2 * counter + 1)};
}

int32_t Scene::body_of(int64_t id) const {
    const auto after = std::upper_bound(bodies_.begin(), bodies_.end(), id,
                                        [](int64_t wanted, const Body &body) { return wanted < body.first; });
    return static_cast<int32_t>(after - bodies_.begin()) - 1;
}

int32_t Scene::add_column(const gp_column &c, std::string &note) {
    require_position("gp_column.x_min", c.x_min, config_.spacing);
    require_position("gp_column.y_min", c.y_min, config_.spacing);
    require_positive("gp_column.width", c.width);
    require_positive("gp_column.height", c.height);
    require_choice("gp_column.material", c.material, static_cast<int64_t>(materials_.size()));
    require_quantity("gp_column.vx", c.vx);
    require_quantity("gp_column.vy", c.vy);
    require_choice("gp_column.initial_pressure", c.initial_pressure, 2);
    const double spacing = config_.spacing;
    const double columns = std::round(c.width / spacing), rows = std::round(c.height / spacing);
    if (columns < 1 || rows < 1)
        throw make_error(GP_E_ARGUMENT, "%s = %g: expected at least half of the spacing %g",
                         columns < 1 ? "gp_column.width" : "gp_column.height", columns < 1 ? c.width : c.height,
                         spacing);
    if (columns * rows > static_cast<double>(most_particles - particle_count()))
        throw make_error(GP_E_ARGUMENT,
                         "gp_column.width x height = %g x %g: %g particles, more than the %lld that are left", c.width,
                         c.height, columns * rows, static_cast<long long>(most_particles - particle_count()));
    const double tolerance = 1e-6 * spacing;
    if (std::abs(columns * spacing - c.width) > tolerance || std::abs(rows * spacing - c.height) > tolerance)
        note = format_text("column %d: %g x %g m rounded to %g x %g m, whole numbers of the spacing %g m",
                           static_cast<int>(bodies_.size()), c.width, c.height, columns * spacing, rows * spacing,
                           spacing);

    if (const Period p = period();
        p && (c.x_min < p.x_min - tolerance || c.x_min + columns * spacing > p.x_min + p.length + tolerance))
        throw make_error(GP_E_ARGUMENT,
                         "gp_column from x = %g to %g m: expected a column within the period, %g to %g m", c.x_min,
                         c.x_min + columns * spacing, p.x_min, p.x_min + p.length);

    Body body;
    body.material = c.material;
    body.first = particle_count();
    body.count = static_cast<int64_t>(columns * rows);
    body.rectangle = true;
    body.x_min = c.x_min;
    body.y_min = c.y_min;
    body.width = columns * spacing;
    body.height = rows * spacing;
    body.hydrostatic = c.initial_pressure == GP_INITIAL_HYDROSTATIC;
    body.vx = c.vx;
    body.vy = c.vy;
    body.across = static_cast<int64_t>(columns);
    bodies_.push_back(std::move(body));
    return static_cast<int32_t>(bodies_.size()) - 1;
}

void Scene::check_particles(int32_t material, int64_t n, const double *px, const double *py, const double *pvx,
                            const double *pvy) const {
    require_choice("material", material, static_cast<int64_t>(materials_.size()));
    if (n < 1 || n > most_particles - particle_count())
        throw make_error(GP_E_ARGUMENT, "n = %lld: expected a whole number from 1 to %lld", static_cast<long long>(n),
                         static_cast<long long>(most_particles - particle_count()));
    require_pointer("x", px);
    require_pointer("y", py);
    if ((pvx == nullptr) != (pvy == nullptr))
        throw make_error(GP_E_ARGUMENT, "%s = NULL: expected vx and vy both given or both NULL", pvx ? "vy" : "vx");
    const auto check = [&](const char *name, const double *values) {
        for (int64_t k = 0; values && k < n; ++k)
            require_quantity({name, k}, values[k]);
    };
    for (int64_t k = 0; k < n; ++k) {
        require_position({"x", k}, px[k], config_.spacing);
        if (const Period p = period(); p && (px[k] < p.x_min || px[k] > p.x_min + p.length))
            throw make_error(GP_E_ARGUMENT, "x[%lld] = %g: expected a position within the period, %g to %g m",
                             static_cast<long long>(k), px[k], p.x_min, p.x_min + p.length);
        require_position({"y", k}, py[k], config_.spacing);
    }
    check("vx", pvx);
    check("vy", pvy);
}

int32_t Scene::add_particles(int32_t material, int64_t n, const double *px, const double *py, const double *pvx,
                             const double *pvy) {
    check_particles(material, n, px, py, pvx, pvy);
    Body body;
    body.material = material;
    body.first = particle_count();
    body.count = n;
    body.set[0].assign(px, px + n);
    body.set[1].assign(py, py + n);
    for (int k = 2; k < 4; ++k)
        body.set[k].assign(static_cast<std::size_t>(n), 0.0);
    if (pvx) {
        std::copy_n(pvx, n, body.set[2].begin());
        std::copy_n(pvy, n, body.set[3].begin());
    }
    bodies_.push_back(std::move(body));
    return static_cast<int32_t>(bodies_.size()) - 1;
}

void Scene::set_gravity(const Vector &gravity) {
    config_.gravity_x = gravity.x();
    config_.gravity_y = gravity.y();
}

} // namespace gp
