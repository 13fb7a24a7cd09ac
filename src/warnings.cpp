#include "warnings.hpp"

#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "ledger.hpp"
#include "stages/stages.hpp"
#include "volume_drift.hpp"

namespace gp {

namespace {

// From here on a state is doubtful.
constexpr double compression_limit = 0.03,
                 good_compression = 0.01; // the scene's own sound speed is made for the latter
constexpr double plate_share = 0.3;       // of the sound speed
constexpr double least_layers = 3;        // of a column
constexpr double penalty_share = 0.1;     // of the dissipation
constexpr double error_share = 0.02;      // of the ledger's scale
constexpr double passed_share = 0.05;     // dl behind a plate; on its line particles are while they collide
constexpr double overlap_share = 0.5;     // dl between particles as they begin

// Steps between looks at what takes a pass over particles or contacts, and at what takes one over pairs.
constexpr int64_t interval = 64, pair_interval = 1024;

// Particles that lie so much closer than their density says have lost volume. Layers at 26 degrees of 10 spacings read .005
// at most, from lattice or jitter, at horizons 2.2 to 6, and .05 after 2 s without what ties the density to the spacing;
// collapses .01 at most (a = 1.25, L / dl 8 to 64, horizons 3 and 4). Of the foot of tall columns a tenth of the particles read
// .03 to .06 for some .05 s: a few are no measure. What topples and spreads opens up (-.01 at L / dl 64, -.06 at 16): of that
// nothing is said.
constexpr double drift_limit = 0.02;
constexpr double flowing_share = 0.2; // of the particles, at least

std::string text_of_drift(const World &world, double drift) {
    return format_text(
        "where the material flows the particles lie %.2g %% closer than their density says at time %g s, so "
        "the material has lost volume (gp_state.volume_drift): set a smaller gp_config.spacing or a larger "
        "horizon",
        100 * drift, world.clock.time);
}

// The largest energy that the ledger has dealt with, J/m.
double ledger_scale(const Ledger &ledger) {
    return std::max({std::abs(ledger.initial), ledger.scale, ledger.largest_kinetic, ledger.dissipated,
                     std::abs(ledger.plate_work)});
}

// A particle that has come behind the line of a plate that it sees; -1: none.
const Contact *passed_contact(const World &world) {
    const Particles &p = world.particles;
    for (const Contact &contact : world.walls.contacts) {
        const Segment &s = world.walls.facets[contact.facet].segment;
        const Vector now = world.walls.nearest_image(s, {p.x[contact.particle], p.y[contact.particle]});
        const Vector at = now - world.clock.dt * world.walls.plate_of(contact.facet).velocity_at(now);
        if (s.distance(at) < -passed_share * world.constants.spacing && s.covers(s.along(at), 0))
            return &contact;
    }
    return nullptr;
}

struct Overlaps {
    int64_t count = 0;                // pairs
    int64_t first = -1, second = -1;  // ids of the closest two
    double closest = 0, x = 0, y = 0; // m: their distance, and where the first is
};

// Pairs that begin closer than overlap_share: the lattice of two columns laid over each other, particles put in twice.
Overlaps find_overlaps(const World &world) {
    Overlaps found;
    const Particles &p = world.particles;
    const double reach = overlap_share * world.constants.spacing;
    for (int64_t i = 0; i < p.count; ++i)
        for_each_candidate(world.grid, world.images, p.x[i], p.y[i], reach, [&](int64_t j) {
            const double distance = std::hypot(p.x[j] - p.x[i], p.y[j] - p.y[i]);
            const int64_t other = p.id[world.images.source(j)];
            if (other <= p.id[i] || distance >= reach)
                return;
            if (found.count == 0 || distance < found.closest)
                found = {found.count, p.id[i], other, distance, p.x[i], p.y[i]};
            ++found.count;
        });
    return found;
}

} // namespace

bool Warnings::is_new(Kind kind) {
    const uint32_t bit = 1u << kind;
    const bool fresh = !(told_ & bit);
    told_ |= bit;
    return fresh;
}

std::vector<std::string> Warnings::of_scene(const World &world) {
    std::vector<std::string> texts;
    const Constants &c = world.constants;
    const gp_config &config = world.scene->config();
    if (!is_new(scene) || world.particles.count == 0)
        return texts;
    if (c.sound_speed_is_arbitrary)
        texts.push_back("sound_speed: nothing in the scene sets a speed, so 1 m/s is used");
    if (c.sound_speed < c.flow_speed)
        texts.push_back(format_text("gp_config.sound_speed = %g m/s: the scene can reach %g m/s; set 0 or about %g",
                                    c.sound_speed, c.flow_speed, 10 * c.flow_speed));
    for (std::size_t k = 0; k < world.scene->bodies().size(); ++k) {
        const Body &body = world.scene->bodies()[k];
        const double thinnest = std::min(body.width, body.height);
        if (body.rectangle && thinnest < (least_layers - 0.5) * c.spacing && is_new(thin_column))
            texts.push_back(
                format_text("column %zu is %g m thin, less than %g spacings of %g m, too few for its stress: "
                            "set gp_config.spacing to at most %g",
                            k, thinnest, least_layers, c.spacing, thinnest / least_layers));
    }
    const double limit = stages::stable_dt(c);
    if (config.time_step > limit)
        texts.push_back(
            format_text("gp_config.time_step = %g is beyond the stable limit of %g s", config.time_step, limit));
    if (config.cfl * c.spacing / c.wave_speed > limit)
        texts.push_back(format_text("gp_config.cfl = %g is beyond the stable limit of %g", config.cfl,
                                    limit * c.wave_speed / c.spacing));
    const int64_t wrong_side = world.walls.count_overlapping(world.particles, 0.25 * c.spacing);
    if (wrong_side > 0)
        texts.push_back(format_text("%lld particles begin within a quarter spacing of a plate's wetted line or just "
                                    "behind it",
                                    static_cast<long long>(wrong_side)));
    if (const Overlaps found = find_overlaps(world); found.count > 0)
        texts.push_back(format_text(
            "pairs of particles that begin closer than half a spacing, %g m: %lld; they drive each "
            "other apart. The closest are particles %lld and %lld, %g m apart at (%g, %g) m",
            overlap_share * c.spacing, static_cast<long long>(found.count), static_cast<long long>(found.first),
            static_cast<long long>(found.second), found.closest, found.x, found.y));
    return texts;
}

std::vector<std::string> Warnings::of_retry(const World &world, const char *error) {
    if (!is_new(retried))
        return {};
    return {format_text("step %lld is taken anew in halves (gp_config.retry_halvings): %s",
                        static_cast<long long>(world.clock.step), error)};
}

std::vector<std::string> Warnings::of_gravity(const World &world) {
    const Constants &c = world.constants;
    // A fall of the height h and a column of that height compress by g h / c0^2.
    const double compression = 0.5 * std::pow(c.flow_speed / c.sound_speed, 2);
    if (compression <= compression_limit || !is_new(more_gravity))
        return {};
    return {format_text(
        "gp_set_gravity = (%g, %g) m/s2: the scene can now reach %g m/s, for which the sound speed of %g m/s "
        "is too low (compression of some %.2g %%): set gp_config.sound_speed to about %g",
        c.gravity.x(), c.gravity.y(), c.flow_speed, c.sound_speed, 100 * compression, 10 * c.flow_speed)};
}

std::vector<std::string> Warnings::of_step(const World &world) {
    std::vector<std::string> texts;
    const Constants &c = world.constants;
    const double time = world.clock.time;
    // By number density the lattice beside a wall is compressed by 7 % as it stands.
    if (!by_number_density(c.scheme) && world.max_compression > compression_limit && is_new(compressed))
        texts.push_back(
            format_text("compression of %g %% at time %g s: the sound speed of %g m/s is too low for what acts "
                        "here; set gp_config.sound_speed to about %g",
                        100 * world.max_compression, time, c.sound_speed,
                        c.sound_speed * std::sqrt(world.max_compression / good_compression)));
    for (std::size_t k = 0; k < world.walls.plates.size(); ++k) {
        const Plate &plate = world.walls.plates[k];
        const double speed = plate.fastest();
        if (plate.gap <= 0 && speed > plate_share * c.sound_speed && is_new(fast_plate))
            texts.push_back(format_text("plate %zu moves at %g m/s at time %g s, %g of the sound speed: set "
                                        "gp_config.sound_speed to about %g or drive it slower",
                                        k, speed, time, speed / c.sound_speed, 10 * speed));
    }
    if (world.clock.step % interval != 0)
        return texts;

    if (const Contact *contact = passed_contact(world); contact && is_new(passed_plate)) {
        const Particles &p = world.particles;
        const int64_t i = contact->particle;
        texts.push_back(format_text(
            "plate %d passes over particle %lld at (%g, %g) m, time %g s: drive the plate slower, "
            "or keep plates that meet a spacing apart",
            world.walls.facets[contact->facet].plate, static_cast<long long>(p.id[i]), p.x[i], p.y[i], time));
    }
    if (by_number_density(c.scheme)) // the paper's schemes have no penalty, and lose energy by their nature
        return texts;
    if (world.clock.step % pair_interval == 0) {
        const Packing flowing = measure_packing(world, Part::flowing);
        const double drift = drift_of(world, flowing) + 1 - flowing.density;
        if (static_cast<double>(flowing.particles) > flowing_share * static_cast<double>(world.particles.count) &&
            drift > drift_limit && is_new(lost_volume))
            texts.push_back(text_of_drift(world, drift));
    }
    const Ledger &ledger = world.ledger;
    const double scale = ledger_scale(ledger);
    if (ledger.dissipated > error_share * scale && ledger.penalty > penalty_share * ledger.dissipated &&
        is_new(large_penalty))
        texts.push_back(
            format_text("the zero-energy penalty has taken %g %% of all that was dissipated by time %g s: set a "
                        "smaller gp_config.zero_energy_penalty or spacing",
                        100 * ledger.penalty / ledger.dissipated, time));
    const double error = ledger.initial - (measure_energies(world).sum() + ledger.dissipated + ledger.plate_work);
    if (std::abs(error) > error_share * scale && is_new(large_energy_error))
        texts.push_back(format_text("the energy ledger is wrong by %g %% at time %g s: set a smaller gp_config.cfl or "
                                    "time_step (the last step was %g s)",
                                    100 * error / scale, time, world.clock.dt));
    return texts;
}

} // namespace gp
