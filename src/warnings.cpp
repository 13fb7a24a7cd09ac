#include "warnings.hpp"

#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "ledger.hpp"
#include "mistakes.hpp"
#include "parts.hpp"
#include "stages/stages.hpp"
#include "volume_drift.hpp"

namespace gp {

namespace {

// From here on a state is doubtful.
constexpr double compression_limit = 0.03,
                 good_compression = 0.01; // the scene's own sound speed is made for the latter
// In a blow the row at the plate is compressed by two to three times what the material is: so it is of a share of the
// particles that the limit is asked, and of single ones thrice as much.
constexpr double compressed_share = 0.2, single_limit = 3 * compression_limit;
constexpr double plate_share = 0.3;   // of the sound speed
constexpr double least_layers = 3;    // of a column
constexpr double penalty_share = 0.1; // of the dissipation
constexpr double error_share = 0.02;  // of the ledger's scale
constexpr double passed_share = 0.05; // dl behind a plate; on its line particles are while they collide
constexpr double overlap_share = 0.5; // dl between particles as they begin

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

// Where the material is compressed beyond the limits, in the present step.
struct Compressed {
    bool doubtful = false;
    int64_t particle = -1; // the densest
    double most = 0;       // its compression
};

Compressed find_compressed(const World &world) {
    const Particles &p = world.particles;
    Compressed found;
    int64_t count = 0;
    for (int64_t i = 0; i < p.count; ++i) {
        const double compression = p.density[i] / world.material_of(i).density - 1;
        count += compression > compression_limit;
        if (compression > found.most) {
            found.most = compression;
            found.particle = i;
        }
    }
    found.doubtful = found.most > single_limit ||
                     (count > 0 && static_cast<double>(count) >= compressed_share * static_cast<double>(p.count));
    return found;
}

// How fast what is about a particle comes at it, or it at a plate: m/s.
double approach_to(const World &world, int64_t i) {
    const Particles &p = world.particles;
    const Vector at(p.x[i], p.y[i]), velocity(p.vx[i], p.vy[i]);
    const double about = 2 * world.constants.reach;
    const ListOrigin &origin = world.list_origin; // the step is a good one: particles are in the order of the lists
    double fastest = 0;
    for_each_candidate(world.grid, world.images, origin.x[i], origin.y[i], world.radius_then(about), [&](int64_t j) {
        const Vector apart = Vector(p.x[j], p.y[j]) - at;
        const double distance = apart.norm();
        if (distance > 0 && distance < about)
            fastest = std::max(fastest, -apart.dot(Vector(p.vx[j], p.vy[j]) - velocity) / distance);
    });
    const Walls &walls = world.walls;
    for (std::size_t f = 0; f < walls.facets.size(); ++f) {
        const Segment &s = walls.facets[f].segment;
        if (s.nearest(walls.nearest_image(s, at)) < world.constants.reach)
            fastest = std::max(fastest, s.normal.dot(walls.velocity_at(static_cast<int32_t>(f), at) - velocity));
    }
    return fastest;
}

// Whether what is stopped at this speed is compressed by more than it should be.
bool is_too_hard(const Constants &c, double speed) {
    return speed > most_blow * c.sound_speed;
}

// What bears or flows is compressed by its pressure, as the square of speeds that the scene foresees over the sound speed; what
// is stopped at once, by the ratio of its speed to that: a blow, a jet. The remedy for the one is too small for the other.
std::string text_of_compression(const World &world, const Compressed &found) {
    const Constants &c = world.constants;
    const Particles &p = world.particles;
    const double by_pressure = c.sound_speed * std::sqrt(found.most / good_compression);
    // Seen some steps after it has begun a blow is slower than it was: where the scene foresees one, by the speed of that.
    const double speed = approach_to(world, found.particle), hardest = std::max(speed, c.impact.speed);
    std::string text = format_text("compression of %.3g %% at (%g, %g) m, time %g s: ", 100 * found.most,
                                   p.x[found.particle], p.y[found.particle], world.clock.time);
    // Where it is densest a blow compresses by up to three times that ratio, a squeeze at any speed. One that the scene
    // foresees, too hard for its sound speed, has just begun where it is no denser yet than a pressure makes it.
    const bool is_hard =
        is_too_hard(c, c.impact.speed) || found.most * c.sound_speed * c.sound_speed > c.flow_speed * c.flow_speed;
    const bool is_blow = is_hard && 3 * speed > 0.5 * found.most * c.sound_speed;
    if (is_blow)
        return text +
               format_text("what is stopped at %.3g m/s, as in a blow or a jet, is compressed by the ratio of that "
                           "and the sound speed of %g m/s; set gp_config.sound_speed to about %.3g or let it "
                           "meet more slowly",
                           hardest, c.sound_speed, std::max(hardest / most_blow, by_pressure));
    return text + format_text("the sound speed of %g m/s is too low for what acts here; set gp_config.sound_speed to "
                              "about %.3g",
                              c.sound_speed, by_pressure);
}

// Of a particle that has come behind the line of a plate that it sees; NULL: none.
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

// The error is in proportion to the time step.
std::string text_of_energy(const World &world, double error) {
    const Constants &c = world.constants;
    const gp_config &config = world.scene->config();
    const double share = 0.5 * error_share / std::abs(error), speed = c.impact.speed;
    std::string text =
        format_text("the energy ledger is wrong by %.3g %% at time %g s: set ", 100 * error, world.clock.time);
    text += config.time_step > 0 ? format_text("gp_config.time_step to about %.2g s", share * config.time_step)
                                 : format_text("gp_config.cfl to about %.2g (the last time_step was %.3g s)",
                                               share * world.clock.dt * c.wave_speed / c.spacing, world.clock.dt);
    if (is_too_hard(c, speed))
        text += format_text(
            " or, if it is from the blow at %.3g m/s with which the scene begins, gp_config.sound_speed to about %.3g",
            speed, speed / most_blow);
    return text;
}

// Another plate near a particle that a plate moves against; -1: none.
int32_t closing_plate(const World &world, int32_t plate, const Vector &at) {
    const Walls &walls = world.walls;
    for (const Facet &facet : walls.facets)
        if (facet.plate != plate && !(walls.plates[facet.plate].motion() == walls.plates[plate].motion()) &&
            facet.segment.nearest(walls.nearest_image(facet.segment, at)) < 2 * world.constants.spacing)
            return facet.plate;
    return -1;
}

std::string text_of_passed(const World &world, const Contact &contact) {
    const Particles &p = world.particles;
    const Constants &c = world.constants;
    const int64_t i = contact.particle;
    const int32_t id = world.walls.facets[contact.facet].plate;
    const Plate &plate = world.walls.plates[id];
    const auto at_time = [&](const char *does) {
        return format_text("plate %d %s particle %lld at (%g, %g) m, time %g s: ", id, does,
                           static_cast<long long>(p.id[i]), p.x[i], p.y[i], world.clock.time);
    };
    const bool moves = plate.motion().any();
    if (const int32_t other = closing_plate(world, id, {p.x[i], p.y[i]}); other >= 0)
        return at_time(moves ? "passes over" : "is passed by") +
               format_text("plates %d and %d close on it; let them stay a spacing apart, %g m", id, other, c.spacing);
    if (moves)
        return at_time("passes over") + "drive the plate slower, or keep plates that meet a spacing apart";
    // Of 1800 blocks and towers thrown at floors and slopes, with sound speeds of 1.5 to 40 times their own and horizons of
    // 2.2 to 4, 231 pass: with a sound speed of .3 to 5.9 times the fastest then, a tower three wide on a smooth floor up to 10.3.
    if (sound_to_flow_speed * world.velocity_span > c.sound_speed)
        return at_time("is passed by") +
               format_text("the plate is at rest, and material comes at up to %.3g m/s; set gp_config.sound_speed to "
                           "about %.3g (%g m/s now) or let it meet more slowly",
                           world.velocity_span, world.velocity_span / most_blow, c.sound_speed);
    return at_time("is passed by") +
           "the plate is at rest; begin material half a spacing in front of its line, on the right of the way "
           "from end 0 to end 1, and let the ends of plates that meet coincide or overlap";
}

struct Overlaps {
    int64_t count = 0;                // pairs
    int64_t first = -1, second = -1;  // ids of the closest two
    double closest = 0, x = 0, y = 0; // m: their distance, and where the first is
};

// Those of all processes. Of pairs that are as close the first is that which a process alone finds first.
void combine_overlaps(const World &world, Overlaps &found) {
    const auto number = [](int64_t whole) { return static_cast<double>(whole); };
    std::vector<double> own;
    if (found.count > 0) {
        const Cell cell = world.grid.frame().cell_of(found.x, found.y);
        own = {found.closest, number(cell.row), number(cell.column), number(found.first), number(found.second),
               found.x,       found.y};
    }
    found.count = sum_of_all(*world.crossing, found.count);
    const std::vector<double> least = least_of_all(*world.crossing, own, 7, 4);
    if (found.count > 0)
        found = {found.count, static_cast<int64_t>(least[3]), static_cast<int64_t>(least[4]), least[0], least[5],
                 least[6]};
}

// Pairs that begin closer than overlap_share: the lattice of two columns laid over each other, particles put in twice.
Overlaps find_overlaps(const World &world) {
    Overlaps found;
    const Particles &p = world.particles;
    const double reach = overlap_share * world.constants.spacing;
    for (int64_t i = 0; i < p.count; ++i)
        for_each_candidate(world.grid, world.images, p.x[i], p.y[i], reach, [&](int64_t j) {
            const double distance = std::hypot(p.x[j] - p.x[i], p.y[j] - p.y[i]);
            const int64_t other = world.images.id_of(p, j);
            if (other <= p.id[i] || distance >= reach)
                return;
            if (found.count == 0 || distance < found.closest)
                found = {found.count, p.id[i], other, distance, p.x[i], p.y[i]};
            ++found.count;
        });
    if (world.crossing)
        combine_overlaps(world, found);
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
    if (!is_new(scene))
        return texts;
    for (std::string &text : scene_mistakes(world))
        texts.push_back(std::move(text));
    if (world.scene->particle_count() == 0)
        return texts;
    if (c.sound_speed_is_arbitrary)
        texts.push_back("sound_speed: nothing in the scene sets a speed, so 1 m/s is used");
    if (c.sound_speed < c.flow_speed)
        texts.push_back(format_text("gp_config.sound_speed = %g m/s: the scene can reach %g m/s; set 0 or about %g",
                                    c.sound_speed, c.flow_speed, sound_to_flow_speed * c.flow_speed));
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
    const int64_t wrong_side = count_on_lines(world, 0.25 * c.spacing);
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

std::string Warnings::note_of_scene(const World &world) const {
    const Constants &c = world.constants;
    if (is_told(scene) || !c.sound_speed_is_of_impact)
        return {};
    const Impact &impact = c.impact;
    const std::string met =
        impact.plate >= 0 ? format_text("plate %d", impact.plate) : format_text("column %d", impact.onto);
    const std::string fall = impact.fall > 0 ? format_text(" after a fall of %.3g m", impact.fall) : std::string();
    const double of_flow = sound_to_flow_speed * c.flow_speed;
    return format_text(
        "the sound speed is %.4g m/s, %g times the %.3g m/s at which column %d meets %s%s. That takes %.2g "
        "times the steps that the flow alone needs; gp_config.sound_speed = %.4g saves them, at the price "
        "of a soft blow from which the material springs back",
        c.sound_speed, 1 / most_blow, impact.speed, impact.body, met.c_str(), fall.c_str(), c.sound_speed / of_flow,
        of_flow);
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
        c.gravity.x(), c.gravity.y(), c.flow_speed, c.sound_speed, 100 * compression,
        sound_to_flow_speed * c.flow_speed)};
}

std::vector<std::string> Warnings::of_step(const World &world) {
    std::vector<std::string> texts;
    const Constants &c = world.constants;
    const double time = world.clock.time;
    // By number density the lattice beside a wall is compressed by 7 % as it stands.
    if (!by_number_density(c.scheme) && world.max_compression > compression_limit && !is_told(compressed))
        if (const Compressed found = find_compressed(world); found.doubtful && is_new(compressed))
            texts.push_back(text_of_compression(world, found));
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

    if (const Contact *contact = passed_contact(world); contact && is_new(passed_plate))
        texts.push_back(text_of_passed(world, *contact));
    if (!is_told(lost_material))
        if (std::string text = lost_particles(world); !text.empty() && is_new(lost_material))
            texts.push_back(std::move(text));
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
        texts.push_back(text_of_energy(world, error / scale));
    return texts;
}

} // namespace gp
