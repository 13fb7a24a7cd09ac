// What follows from a complete scene: the sound speed and the material constants.
#include <algorithm>
#include <cmath>

#include "scene.hpp"
#include "scene_falls.hpp"

namespace gp {

namespace {

// Shear modulus over bulk modulus. Any value of this order gives the same deposit: below yield the material only has to
// be stiff against its weight, and the wave speed, hence the time step, grows with it.
constexpr double shear_to_bulk = 0.3;

// Of a material with k0 it is such that stresses grow in that ratio where the material cannot spread, too, (K - G) / (K + G): so
// it stays while walls take weight over. A silo of .06 x .36 m whose walls have the friction .2, by k0: sigma_h / sigma_v after
// the floor has sunk by .2 to 1 dl, and the base load over Janssen's with k0 (the same by shear_to_bulk):
//   .5 .502 .97 (.490 .98)    .6 .602 .97 (.627 .93)    .64 .642 .97 (.70 .89)    .7 .702 .97 (.78 .86)    .8 .803 .97
// Collapses with a = 1.25 keep their peak and 95 % mark within their scatter, k0 .5 to 1.5. Not below this, lest rest be soft.
constexpr double least_shear_to_bulk = 0.1;

double shear_to_bulk_of(const gp_material &m) {
    if (m.k0 == 0 || m.k0 >= 1)
        return shear_to_bulk;
    return std::max((1 - m.k0) / (1 + m.k0), least_shear_to_bulk);
}

// Largest time step of a loaded plate of mass m per area, over sqrt(m dl / rho) / wave speed: it rests on a spring of the
// stiffness rho c^2 / dl per area.
constexpr double plate_share = 1.0;

// Mass per area of a loaded plate that has none of its own, in rho dl. A light plate follows its load at once; heavier
// ones ring on the material, which damps so slow a motion little: on a column of 20 spacings, masses of .01 to .5 come
// to rest, from 1 on plate and material keep trembling (kinetic energy 3e-6 of the whole).
constexpr double light_plate = 0.5;

// Share of the lattice's largest step in theory that material with a free surface can take.
//
// Theory: a wave of the lattice with frequency w and damping rate c, both by the discrete operators (Wave in kernel.hpp),
// elastic by the new strain, damped by the old velocity, grows unless w^2 dt^2 + 2 c dt < 4; density diffusion unless its
// own rate times dt is below 2. Where neighbours are missing the gradient is steeper: the same operators on a strip between two
// free surfaces (bench/stability/theory.py), and on deposits as collapses leave them, L/dl = 32 (undamped, the largest
// eigenvalue, the floor held). In dl / wave speed, by horizon; calm: a layer at rest, jittered by .05 dl, comes to rest up to it:
//
//   horizon   undamped: lattice   surface   share   deposit   default coefficients: lattice   surface   share   calm to
//   1.8 dl              1.69       1.28      .76                                    1.47       1.11      .75
//   2.2 dl              1.98       1.33      .67                                    1.75       1.15      .65     1.45
//   2.5 dl              2.20       1.43      .65                                    1.96       1.24      .63
//   3 dl                2.66       1.71      .64                                    2.40       1.51      .63     1.57
//   4 dl                3.52       2.26      .64     2.18                           3.21       2.04      .64     2.14
//   5 dl                4.39       2.84      .65                                    4.02       2.59      .65     2.67
//   6 dl                5.27       3.43      .65                                    4.81       3.15      .65
//
// So a free surface has .63 of the lattice's limit or more, and steps of that are calm.
constexpr double surface_share = 0.6;

// dl / c0, over which the pressure of the inertial number is averaged (stages/stress.cpp). Bagnold flow on 28 degrees, 10 rows: its
// speed at the surface after 8 s, c0 about 10 times that, is 43 % too high without, and 23, 15, 10, 9 % with 10, 30, 100, 300 (means of
// three). What the collapse with a = 1.25 runs out to (90 % of the mass) is less by .3, 1.0, .6, .2 % at L/dl = 16, 32, 64, 128.
constexpr double pressure_memory = 100;

// The scheme's own step over that limit, where little moves: so long that clumps of few grains are stable with it at any horizon
// (operators.hpp). With .5 six grains that meet in free space, 3 beside 3, leave with 1.8 times their energy. (A few_trace of
// .6 would bear .5, but leave neither a single row nor a corner its exact gradient.) Collapses with a = 1.25,
// horizon 4 dl, by this share; peak and R90 to those of the finest, L/dl = 32, twelve runs, +- .3 and .2 %; CPU time; of 192 deposits with
// L/dl = 8, looked at every .05 s from 1 to 2 s, those that once did not read rest, and the looks:
//   .38 -2.5 %  -.7 %  1    12, 55        .45 -2.8  -.6  .88   5, 19        .5 -2.3  -.4  .82   9, 16
// of 24 with L/dl = 16 not at rest for good by .42 s: .38 3, .5 0, .6 5, .66 6. With L/dl = 64 deposits of .38 and .66 without regard to
// motion are the same within .3 %. (Measured while what rests had collisions, too. Grains of the uppermost row that are at yield, or at tips
// without stress, may go on pushing each other, with some five steps a period; what is below them does not.)
constexpr double own_share = 0.45;

// The same of quick motion (stages/choose_dt.cpp), and where a blow is foreseen: its energy error is in proportion to the step, and the
// sound speed is chosen for it (scene.hpp).
constexpr double quick_share = 0.38;

// The printed schemes are far beyond the limit of their viscosity at any step that sound allows; what bounds them is
// |tau| <= mu p. On the collapse with a = 1.25 all steps up to 2.0 run (L/dl = 16 and 32), but the longer the step the more they
// creep. Non-local, factor 2: peak y/L .500, .505, .505, .491, .471, .456, .428 at .42 s for 0.05, 0.1, 0.2, 0.4, 0.8, 1.0
// and 1.4, and .482, .481, .462, .447, .406, .384, .343 at 1 s; local .361, .356, .351, .354 at .42 s for 0.2, 0.4, 0.8, 1.0.
// With the horizon 2.2 dl, 1.7 makes energy: five times that of the start by .42 s. In dl / c0:
constexpr double paper_own = 0.2, paper_stable = 1.0;

// The same of materials of different density. What a light particle is pushed with is as stiff, and as much damped, as its
// heavy neighbours: no arrangement has frequencies above sqrt(R) times those of one material, or damping rates above R times
// theirs, R the ratio of densities (the eigenvalues of M^-1 G^T K G with all M the lightest and all K the heaviest). Measured
// with the default coefficients: the largest step, in dl / wave speed, that keeps the ledger right to 1 % (2 was the largest
// tried) of 10 x 12 spacings at a wall, half light over half heavy, one light grain amid heavy ones, light and heavy in a
// chequerboard:
//
//   horizon       R   theory   layers    one     board
//   1.8 dl       10     .29      1.3     .9      .44
//               100     .039     1.1     .2      .07
//              1000     .004      .5     .03   < .016
//   2.2 dl       10     .37      1.8    1.3      .63
//               100     .052     1.1     .28     .10
//              1000     .006      .5     .06     .016
//   4 dl         10     .82      1.8    1.8     1.8
//               100     .15      1.6    1.6      .8
//              1000     .017      .5     .25     .18
//
// The theory has a factor of 1.5 or more in hand for any of them, so all of it may be taken.
constexpr double contrast_share = 1.0;

// Least zero-energy penalty inside the yield surface. What is elastic has many motions that the gradient does not see or
// hardly sees, and at free faces a part of the weight acts on them: of a block of 16 x 10 spacings with the horizon 4 dl, on a
// smooth floor, the elastic equilibrium by the discrete operators has pressures of -10 to 15 rho g dl in alternate rows where
// those of the continuum are 0 to 5. With zero_energy_penalty's .02, which is all that flow bears, such rows part in some
// .1 s, the one stress-free, and a vertical face of mu_s = 1.5 crumbles. Velocity alone is penalised: nothing at rest.
//
// Column a = 1.25 of mu_s = 1.5, peak over its height at .5 s, L/dl = 16 | 32, by this value:
//   horizon 4: .02 .834 | .793    .1 .998 | .896    .2 .998 | .999    .5 .998 | .999
//   horizon 3: .02 .998 | .999    .1 .998 | .999    .2 .999 | .999    .5 .999 | .999
// and of 21 / 32 degrees with jitter, peak / L and R90, 8 | 6 runs:
//   .02 .4197 1.036 | .4140 1.114    .1 .4187 1.024 | .4138 1.113    .2 .4194 1.036 | .4140 1.116    .5 .4202 1.023 | .4149 1.115
constexpr double least_elastic_penalty = 0.2;

struct Range {
    double low = INFINITY, high = -INFINITY;
    void add(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
    double span() const { return high > low ? high - low : 0.0; }
};

// Velocities of a plate that the material takes part in: a straight plate without friction passes on its normal motion alone.
template <class Add> void add_velocities(const PlateSpec &plate, const Motion &motion, const Add &add) {
    const Vector &n = plate.segments.front().normal, &v = motion.velocity;
    const bool normal_only = plate.friction == GP_WALL_FREE_SLIP && plate.segments.size() == 1 && motion.omega == 0;
    add(normal_only ? Vector(n * n.dot(v)) : v);
    if (const double rim = motion.omega * plate.farthest; rim != 0) // of its farthest point, in the course of a turn
        for (const Vector &turning : {Vector(rim, 0), Vector(-rim, 0), Vector(0, rim), Vector(0, -rim)})
            add(v + turning);
}

// Largest difference between any two velocities with which the scene begins or which it prescribes.
double velocity_span(const Scene &scene) {
    Range x, y;
    for (const Body &body : scene.bodies()) {
        for (const double value : body.set[2])
            x.add(value);
        for (const double value : body.set[3])
            y.add(value);
        if (body.rectangle) {
            x.add(body.vx);
            y.add(body.vy);
        }
    }
    const auto add = [&](const Vector &v) {
        x.add(v.x());
        y.add(v.y());
    };
    for (const PlateSpec &plate : scene.plates()) {
        add_velocities(plate, plate.motion, add);
        const MotionTable &table = plate.table;
        for (std::size_t k = 1; k < table.t.size(); ++k) {
            const double dt = table.t[k] - table.t[k - 1];
            const double omega = table.angle.empty() ? 0.0 : (table.angle[k] - table.angle[k - 1]) / dt;
            add_velocities(plate, {{(table.x[k] - table.x[k - 1]) / dt, (table.y[k] - table.y[k - 1]) / dt}, omega},
                           add);
        }
        for (const Segment &s : plate.segments)
            if (plate.surface_velocity != 0)
                add(plate.surface_velocity * s.tangent);
    }
    return std::hypot(x.span(), y.span());
}

// Height through which material can fall: from its highest point to its own lowest one or to the lowest point beneath it
// of a plate that faces up.
double fall_height(const Scene &scene, const Vector &gravity, const Scene::Places &for_each_place) {
    if (gravity.norm() == 0 || scene.particle_count() == 0)
        return 0;
    const Vector up = -gravity.normalized(), across(-up.y(), up.x());
    Range height, width;
    for_each_place([&](const Vector &r) {
        height.add(up.dot(r));
        width.add(across.dot(r));
    });
    const double half = 0.5 * scene.config().spacing;
    double lowest = height.low - half;
    const auto add_floor = [&](const Segment &s) {
        if (s.normal.dot(up) <= 0)
            return;
        // The stretch of the plate under the material.
        const double from = across.dot(s.origin), slope = across.dot(s.tangent);
        double t0 = 0, t1 = s.length;
        if (slope != 0) {
            const double a = (width.low - half - from) / slope, b = (width.high + half - from) / slope;
            t0 = std::max(t0, std::min(a, b));
            t1 = std::min(t1, std::max(a, b));
        } else if (from < width.low - half || from > width.high + half)
            return;
        if (t0 > t1)
            return;
        const double base = up.dot(s.origin), rise = up.dot(s.tangent);
        lowest = std::min({lowest, base + rise * t0, base + rise * t1});
    };
    for (const PlateSpec &plate : scene.plates())
        for (const Segment &segment : plate.segments)
            add_floor(segment);
    return height.high + half - lowest;
}

// kg/m3, of the materials in use.
Range densities_in_use(const Scene &scene) {
    Range densities;
    for (const Body &body : scene.bodies()) {
        const gp_material &m = scene.materials()[static_cast<std::size_t>(body.material)];
        densities.add(m.volume_fraction * m.grain_density);
    }
    return densities;
}

// Largest steps in theory, in dl / wave speed: by elastic waves alone, and with what damps them.
struct Courant {
    double undamped = INFINITY, damped = INFINITY;
};

// For densities that differ by this ratio.
Courant largest_courant(const gp_config &config, const Constants &c, double density_ratio) {
    const double sound = c.sound_speed / c.wave_speed;
    const double penalty = config.zero_energy_penalty * c.elastic_penalty;
    Courant least;
    for_each_wave(c.horizon, c.spacing, [&](const Wave &wave) {
        // Compression is damped by the bulk viscosity twice: as volume change and as shear. The penalty is by the lightest
        // material, diffusion by the denser one of each pair.
        const double frequency2 = density_ratio * wave.gradient2;
        const double rate = sound * (2 * config.bulk_viscosity * frequency2 + penalty * wave.unseen);
        const double diffusion = sound * config.density_diffusion * wave.difference;
        if (frequency2 > 0)
            least.undamped = std::min(least.undamped, 2 / std::sqrt(frequency2));
        if (rate > 0 || frequency2 > 0) // the root of frequency2 t^2 + 2 rate t = 4
            least.damped = std::min(least.damped, 4 / (rate + std::sqrt(rate * rate + 4 * frequency2)));
        if (diffusion > 0)
            least.damped = std::min(least.damped, 2 / diffusion);
    });
    return least;
}

} // namespace

void Scene::set_fall(Constants &c, const Vector &gravity, const Places &for_each_place) const {
    c.gravity = gravity;
    c.fall_height = fall_height(*this, gravity, for_each_place);
    const double span = velocity_span(*this), lightest = densities_in_use(*this).low;
    // A load p compresses the material as a column of the height p / (rho g) does.
    double load_height = 0; // m2/s2, times g
    for (const PlateSpec &plate : plates_)
        if (plate.load > 0)
            load_height = std::max(load_height, plate.load / lightest);
    c.flow_speed = std::sqrt(2 * (gravity.norm() * c.fall_height + load_height) + span * span);
}

// With a step of the host's own, the sound speed stays as it was: the step may be too long for a stiffer material.
Impact Scene::impact() const {
    return by_number_density(scheme_of(config_)) || config_.time_step != 0 ? Impact() : hardest_impact(*this);
}

Constants Scene::constants(const Impact &impact) const {
    Constants c;
    c.spacing = config_.spacing;
    c.volume = c.spacing * c.spacing;
    c.period = period();
    c.horizon = config_.horizon_length > 0 ? config_.horizon_length : config_.horizon * c.spacing;
    c.interaction_radius = config_.interaction_radius * c.spacing;
    c.lattice = lattice_sums(c.horizon, c.spacing);
    c.scheme = scheme_of(config_);
    c.interaction_lattice = lattice_sums(c.interaction_radius, c.spacing);
    c.reach = !by_number_density(c.scheme)      ? c.horizon
              : c.scheme == Scheme::paper_local ? c.interaction_radius
                                                : std::max(c.horizon, c.interaction_radius);

    const Range densities = densities_in_use(*this);
    const double lightest = densities.low, heaviest = std::max(densities.high, 0.0);
    set_fall(c, {config_.gravity_x, config_.gravity_y},
             [this](const auto &visit) { for_each_particle([&](int64_t, int32_t, const Vector &at) { visit(at); }); });
    c.impact = impact;
    const double of_flow = sound_to_flow_speed * c.flow_speed, of_impact = c.impact.speed / most_blow;
    c.sound_speed_is_arbitrary = config_.sound_speed == 0 && c.flow_speed == 0;
    c.sound_speed_is_of_impact = config_.sound_speed == 0 && of_impact > of_flow;
    c.sound_speed =
        config_.sound_speed > 0 ? config_.sound_speed : (c.flow_speed > 0 ? std::max(of_flow, of_impact) : 1.0);
    double stiffest = shear_to_bulk;
    for (const gp_material &m : materials_)
        stiffest = std::max(stiffest, shear_to_bulk_of(m));
    c.wave_speed = c.scheme == Scheme::adjoint ? c.sound_speed * std::sqrt(1 + stiffest) : c.sound_speed;

    for (const gp_material &m : materials_) {
        MaterialConstants k;
        k.grain_density = m.grain_density;
        k.grain_diameter = m.grain_diameter;
        k.k0 = m.k0;
        k.density = m.volume_fraction * m.grain_density;
        k.bulk_modulus = k.density * c.sound_speed * c.sound_speed;
        k.map.mu_s = config_.friction_factor * m.mu_s;
        k.map.mu_2 = config_.friction_factor * m.mu_2;
        k.map.rate_factor = m.i0 / (m.grain_diameter * std::sqrt(m.grain_density));
        k.map.shear_modulus = shear_to_bulk_of(m) * k.bulk_modulus;
        const double cooperativity = m.nonlocal_amplitude * m.grain_diameter;
        c.fluidities.push_back({cooperativity * cooperativity, m.fluidity_time});
        k.law = {k.map.mu_s, k.map.mu_2, k.map.rate_factor, config_.delta};
        c.materials.push_back(k);
    }
    c.body_material.reserve(bodies_.size());
    for (const Body &body : bodies_)
        c.body_material.push_back(body.material);
    const auto in_use = [&](const auto &is) { // one of which is(material, fluidity) holds
        return std::any_of(c.body_material.begin(), c.body_material.end(), [&](int32_t material) {
            const auto k = static_cast<std::size_t>(material);
            return is(c.materials[k], c.fluidities[k]);
        });
    };
    const auto is_fluid = [](const MaterialConstants &, const FluidityConstants &f) { return f.cooperativity2 > 0; };
    c.fluid = in_use(is_fluid);
    c.pressure_memory = pressure_memory * c.spacing / c.sound_speed;
    c.rate_dependent =
        c.scheme == Scheme::adjoint && in_use([&](const MaterialConstants &m, const FluidityConstants &f) {
            return m.map.mu_2 > m.map.mu_s && !is_fluid(m, f);
        });
    c.plate_mass = light_plate * heaviest * c.spacing;
    c.plate_step = INFINITY;
    for (const PlateSpec &plate : plates_)
        if (plate.load > 0 && heaviest > 0)
            c.plate_step =
                std::min(c.plate_step,
                         plate_share * std::sqrt((plate.mass > 0 ? plate.mass : c.plate_mass) * c.spacing / heaviest) /
                             c.wave_speed);
    c.elastic_penalty = c.scheme == Scheme::adjoint && config_.zero_energy_penalty > 0
                            ? std::max(1.0, least_elastic_penalty / config_.zero_energy_penalty)
                            : 1.0;
    const double crossing = c.spacing / c.wave_speed;
    const Courant one = largest_courant(config_, c, 1);
    if (by_number_density(c.scheme)) {
        c.sound_step = paper_stable * crossing;
        c.own_step = c.quick_step = paper_own * crossing;
    } else {
        c.sound_step = surface_share * one.undamped * crossing;
        c.quick_step = quick_share * c.sound_step;
        c.own_step = c.impact.speed > 0 ? c.quick_step : own_share * c.sound_step;
    }
    c.viscous_step = surface_share * one.damped * crossing;
    c.contrast_step = heaviest > lightest
                          ? contrast_share * largest_courant(config_, c, heaviest / lightest).damped * crossing
                          : INFINITY;
    // One coefficient for all pairs keeps momentum; the lightest material keeps it stable.
    c.penalty = bodies_.empty()
                    ? 0.0
                    : config_.zero_energy_penalty * lightest * c.sound_speed / (c.spacing * c.lattice.number_density);
    return c;
}

} // namespace gp
