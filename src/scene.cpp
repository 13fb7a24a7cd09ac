#include "scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "check.hpp"

namespace gp {

namespace {

// More particles than 32-bit neighbour indices can name.
constexpr int64_t most_particles = std::numeric_limits<int32_t>::max() - 1;

void check_config(const gp_config &c) {
    require_between("gp_config.spacing", c.spacing, 1e-9, 1e9);
    require_finite("gp_config.gravity_x", c.gravity_x);
    require_finite("gp_config.gravity_y", c.gravity_y);
    require_not_negative("gp_config.sound_speed", c.sound_speed);
    if (c.cfl != 0)
        require_between("gp_config.cfl", c.cfl, 1e-6, 2);
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
    require_finite("gp_config.periodic_x_min", c.periodic_x_min);
    require_finite("gp_config.periodic_x_max", c.periodic_x_max);
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

// Positions beyond this many spacings from the origin no longer resolve the spacing well (to 2e-4 of it).
constexpr double farthest = 1e12; // dl

void require_position(const char *name, double value, double spacing) {
    require_finite(name, value);
    const double limit = farthest * spacing;
    if (!(std::abs(value) <= limit))
        throw make_error(GP_E_ARGUMENT, "%s = %g: expected a number from %g to %g m, 1e12 spacings", name, value,
                         -limit, limit);
}

// A reproducible number in [-1, 1) from a seed and a counter (the SplitMix64 finaliser).
double hashed_uniform(uint64_t seed, uint64_t counter) {
    uint64_t z = seed + 0x9E3779B97F4A7C15u * (counter + 1);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    z ^= z >> 31;
    return static_cast<double>(z >> 11) * 0x1.0p-52 - 1.0;
}

} // namespace

Vector MotionTable::displacement(double time) const {
    if (time <= t.front())
        return {x.front(), y.front()};
    if (time >= t.back())
        return {x.back(), y.back()};
    const auto next = static_cast<std::size_t>(std::upper_bound(t.begin(), t.end(), time) - t.begin());
    const double part = (time - t[next - 1]) / (t[next] - t[next - 1]);
    return {x[next - 1] + part * (x[next] - x[next - 1]), y[next - 1] + part * (y[next] - y[next - 1])};
}

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
    require_positive("gp_material.grain_density", m.grain_density);
    require(m.volume_fraction > 0 && m.volume_fraction <= 1, "gp_material.volume_fraction", m.volume_fraction,
            "a number > 0 and <= 1");
    require_positive("gp_material.grain_diameter", m.grain_diameter);
    require_not_negative("gp_material.mu_s", m.mu_s);
    require_finite("gp_material.mu_2", m.mu_2);
    if (m.mu_2 < m.mu_s)
        throw make_error(GP_E_ARGUMENT, "gp_material.mu_2 = %g: expected a number >= mu_s = %g", m.mu_2, m.mu_s);
    require_positive("gp_material.i0", m.i0);
    check_k0(m, config_);
    materials_.push_back(m);
    return static_cast<int32_t>(materials_.size()) - 1;
}

void Scene::reserve(int64_t more) {
    const auto total = x.size() + static_cast<std::size_t>(more);
    for (std::vector<double> *field : {&x, &y, &vx, &vy})
        field->reserve(total);
    column.reserve(total);
    bodies_.reserve(bodies_.size() + 1);
}

int32_t Scene::add_column(const gp_column &c, std::string &note) {
    require_position("gp_column.x_min", c.x_min, config_.spacing);
    require_position("gp_column.y_min", c.y_min, config_.spacing);
    require_positive("gp_column.width", c.width);
    require_positive("gp_column.height", c.height);
    require_choice("gp_column.material", c.material, static_cast<int64_t>(materials_.size()));
    require_finite("gp_column.vx", c.vx);
    require_finite("gp_column.vy", c.vy);
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
    reserve(body.count);
    const auto column_id = static_cast<int32_t>(bodies_.size());
    for (int64_t row = 0; row < static_cast<int64_t>(rows); ++row)
        for (int64_t across = 0; across < static_cast<int64_t>(columns); ++across) {
            const auto counter = static_cast<uint64_t>(x.size());
            const double jitter = config_.jitter * spacing;
            const double dx = jitter > 0 ? jitter * hashed_uniform(config_.seed, 2 * counter) : 0.0;
            const double dy = jitter > 0 ? jitter * hashed_uniform(config_.seed, 2 * counter + 1) : 0.0;
            x.push_back(c.x_min + (static_cast<double>(across) + 0.5) * spacing + dx);
            y.push_back(c.y_min + (static_cast<double>(row) + 0.5) * spacing + dy);
            vx.push_back(c.vx);
            vy.push_back(c.vy);
            column.push_back(column_id);
        }
    bodies_.push_back(body);
    return column_id;
}

int32_t Scene::add_particles(int32_t material, int64_t n, const double *px, const double *py, const double *pvx,
                             const double *pvy) {
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
            if (!std::isfinite(values[k]))
                throw make_error(GP_E_ARGUMENT, "%s[%lld] = %g: expected a finite number", name,
                                 static_cast<long long>(k), values[k]);
    };
    for (int64_t k = 0; k < n; ++k) {
        require_position(format_text("x[%lld]", static_cast<long long>(k)).c_str(), px[k], config_.spacing);
        if (const Period p = period(); p && (px[k] < p.x_min || px[k] > p.x_min + p.length))
            throw make_error(GP_E_ARGUMENT, "x[%lld] = %g: expected a position within the period, %g to %g m",
                             static_cast<long long>(k), px[k], p.x_min, p.x_min + p.length);
        require_position(format_text("y[%lld]", static_cast<long long>(k)).c_str(), py[k], config_.spacing);
    }
    check("vx", pvx);
    check("vy", pvy);

    Body body;
    body.material = material;
    body.first = particle_count();
    body.count = n;
    reserve(n);
    const auto column_id = static_cast<int32_t>(bodies_.size());
    x.insert(x.end(), px, px + n);
    y.insert(y.end(), py, py + n);
    vx.resize(x.size(), 0.0);
    vy.resize(x.size(), 0.0);
    if (pvx) {
        std::copy(pvx, pvx + n, vx.begin() + body.first);
        std::copy(pvy, pvy + n, vy.begin() + body.first);
    }
    column.resize(x.size(), column_id);
    bodies_.push_back(body);
    return column_id;
}

int32_t Scene::add_plate(const gp_plate &p) {
    require_position("gp_plate.x0", p.x0, config_.spacing);
    require_position("gp_plate.y0", p.y0, config_.spacing);
    require_position("gp_plate.x1", p.x1, config_.spacing);
    require_position("gp_plate.y1", p.y1, config_.spacing);
    const double length = std::hypot(p.x1 - p.x0, p.y1 - p.y0);
    require(std::isfinite(length) && length > 1e-6 * config_.spacing, "gp_plate length", length,
            "two ends that differ by more than 1e-6 of the spacing");
    require(length / config_.spacing < 1e8, "gp_plate length", length, "less than 1e8 spacings");
    if (const Period period = this->period(); period && std::abs(p.x1 - p.x0) > period.length * (1 + 1e-6))
        throw make_error(GP_E_ARGUMENT,
                         "gp_plate from x = %g to %g m: expected an extent in x of at most the period, %g m", p.x0,
                         p.x1, period.length);
    require_choice("gp_plate.friction", p.friction, 3);
    require_not_negative("gp_plate.wall_mu", p.wall_mu);
    require(p.wall_mu == 0 || p.friction == GP_WALL_COULOMB, "gp_plate.wall_mu", p.wall_mu,
            "0 unless friction is GP_WALL_COULOMB");
    require_finite("gp_plate.vx", p.vx);
    require_finite("gp_plate.vy", p.vy);
    if (p.n_knots < 0)
        throw make_error(GP_E_ARGUMENT, "gp_plate.n_knots = %lld: expected a whole number >= 0",
                         static_cast<long long>(p.n_knots));
    require_not_negative("gp_plate.normal_pressure", p.normal_pressure);
    require_not_negative("gp_plate.mass_per_length", p.mass_per_length);
    require(p.mass_per_length == 0 || p.normal_pressure > 0, "gp_plate.mass_per_length", p.mass_per_length,
            "0 as long as normal_pressure is 0");

    PlateSpec spec{Segment(p.x0, p.y0, p.x1, p.y1),
                   {p.x1, p.y1},
                   p.friction,
                   p.wall_mu,
                   {p.vx, p.vy},
                   {},
                   Vector::Zero(),
                   p.normal_pressure,
                   p.mass_per_length};
    if (p.normal_pressure > 0) {
        if (p.n_knots > 0)
            throw make_error(GP_E_ARGUMENT, "gp_plate.n_knots = %lld: expected 0 for a plate with normal_pressure",
                             static_cast<long long>(p.n_knots));
        require_tangential(spec, {p.vx, p.vy}, "gp_plate");
    }
    if (p.n_knots > 0) {
        require(p.vx == 0 && p.vy == 0, p.vx != 0 ? "gp_plate.vx" : "gp_plate.vy", p.vx != 0 ? p.vx : p.vy,
                "0 when the plate has a displacement table");
        require_pointer("gp_plate.knot_t", p.knot_t);
        require_pointer("gp_plate.knot_x", p.knot_x);
        require_pointer("gp_plate.knot_y", p.knot_y);
        for (int64_t k = 0; k < p.n_knots; ++k) {
            const auto at = static_cast<long long>(k);
            require_finite(format_text("gp_plate.knot_t[%lld]", at).c_str(), p.knot_t[k]);
            require_finite(format_text("gp_plate.knot_x[%lld]", at).c_str(), p.knot_x[k]);
            require_finite(format_text("gp_plate.knot_y[%lld]", at).c_str(), p.knot_y[k]);
            if (k > 0 && p.knot_t[k] <= p.knot_t[k - 1])
                throw make_error(GP_E_ARGUMENT, "gp_plate.knot_t[%lld] = %g: expected more than the knot before, %g",
                                 at, p.knot_t[k], p.knot_t[k - 1]);
        }
        spec.table.t.assign(p.knot_t, p.knot_t + p.n_knots);
        spec.table.x.assign(p.knot_x, p.knot_x + p.n_knots);
        spec.table.y.assign(p.knot_y, p.knot_y + p.n_knots);
    }
    plates_.push_back(std::move(spec));
    return static_cast<int32_t>(plates_.size()) - 1;
}

void require_tangential(const PlateSpec &plate, const Vector &velocity, const char *name) {
    const double normal = plate.segment.normal.dot(velocity);
    if (plate.load > 0 && std::abs(normal) > 1e-12 * velocity.norm())
        throw make_error(
            GP_E_ARGUMENT,
            "%s velocity = (%g, %g), %g along the normal: expected 0 along the normal of a plate that moves "
            "there under its load",
            name, velocity.x(), velocity.y(), normal);
}

void Scene::set_plate_start(int32_t plate, const Vector &start) {
    require_finite("start x", start.x());
    require_finite("start y", start.y());
    plates_[plate].start = start;
}

void Scene::set_gravity(const Vector &gravity) {
    config_.gravity_x = gravity.x();
    config_.gravity_y = gravity.y();
}

void Scene::drive_plate(int32_t plate, const Vector &velocity) {
    PlateSpec &spec = plates_[plate];
    if (!spec.table.empty())
        spec.start = spec.table.displacement(0);
    spec.velocity = velocity;
    spec.table = {};
}

} // namespace gp
