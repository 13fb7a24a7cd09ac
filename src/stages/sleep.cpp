// Who rests and who wakes (gp_config.sleep).
//
// A particle is quiet from the moment on at which it has last gone more than `quiet_way` within `quiet_spans` sqrt(dl / g), or
// the mean stress of its span has last changed by more than `quiet_stress` of itself and of the weight of a spacing since,
// or the span's mean velocity has been such that a wave of half that stress would go out from it if it stopped. A span in
// which one has been quiet for less than that time is restless. What sees a restless span, or a ghost of a plate that acts, is
// computed, and nothing else: it is left out of the stages, at rest, with the stress and the mean pressure that it has. Between a
// restless span and one that sleeps there is a ring of spans as wide as particles see, horizon and skin; a wave takes several steps through it,
// each of which looks at the ring, so that all that changes a stress by more than the hundredths above wakes what is behind
// before it is there. What is weaker ends at the border: the force of what is awake on what sleeps is held, as by friction at
// rest, and its momentum with it.
//
// Who is reached follows from what all spans did in the step before, and is used twice: a span that sleeps and is reached wakes
// when the step begins, one that is awake, has not been reached and is not restless itself falls asleep at its end. So processes
// tell each other once in a step who is restless, with the velocities; and whether one of another process sleeps nobody asks.
//
// Spans at an edge may have three grains, whose stress changes by hundredths for long after the rest has come to rest: they count
// as full ones, of which the rest is quiet. Six collapses of a = 1.25, L/dl = 24, to 2 s, take .85 s, and 2.79 without sleep; with
// spans as they are 1.22, as 16 .97, as 64 .76. With ways of .005, .01, .02, .05, .2 1.13, .88, .86, .85, .85; with stresses of
// .005, .01, .02, .05, .1 1.38, 1.05, .85, .71, .69. All of these have the peaks of those without to 2e-5 of the width and the
// middle 90 % of the mass to 2e-4. Without the third rule a layer below a shear band that fell asleep woke itself: 65 Pa of a wave
// for the 20 that wake.
#include <algorithm>
#include <cmath>

#include "stages/sleep_work.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

constexpr double quiet_way = 0.05;             // dl
constexpr double quiet_stress = 0.02;          // of mean pressure and rho g dl
constexpr double quiet_spans = 8;              // sqrt(dl / g)
constexpr double full_span = 2 * span_columns; // particles
constexpr double quiet_waves = 10;             // and so many times what a wave needs for the way that particles see
constexpr double quiet_growth =
    0.1;                         // of the granular fluidity: where it grows, more than this, failure may be on its way
constexpr double mean_spans = 1; // sqrt(dl / g), over which loads are averaged

// s; infinite without gravity, which gives neither a time nor a stress to compare with: then nothing sleeps.
double fall_time(const Constants &c) {
    return std::sqrt(c.spacing / c.gravity.norm());
}
double quiet_time(const Constants &c) {
    return std::max(quiet_spans * fall_time(c), quiet_waves * c.reach / c.wave_speed);
}

bool acts(const Plate &plate) {
    return plate.motion().any() || plate.loaded() || plate.spec().surface_velocity != 0;
}

void find_reached(World &world) {
    Sleep &s = world.sleep;
    uint64_t acting = 0;
    const std::vector<Plate> &plates = world.walls.plates;
    for (std::size_t k = 0; k < plates.size(); ++k)
        if (acts(plates[k]))
            acting |= plate_bit(static_cast<int64_t>(k));
    for (std::size_t span = 0; span < s.stirs.size(); ++span)
        s.stirs[span] = s.restless[span] || (s.plates[span] & acting) != 0;
    for (int64_t span = 0; span < s.spans; ++span) {
        uint8_t reached = s.stirs[span];
        for_each_link(s, span, [&](int32_t other) { reached |= s.stirs[other]; });
        s.reached[span] = reached;
    }
}

void begin_anew(Particles &p, int64_t i) {
    Repose &r = p.repose;
    r.quiet_for[i] = r.way_x[i] = r.way_y[i] = 0;
    r.pressure[i] = p.pressure[i];
    r.sxx[i] = p.sxx[i];
    r.sxy[i] = p.sxy[i];
    r.fluidity[i] = p.fluidity.empty() ? 0.0 : p.fluidity[i];
}

// Brings what the particles of a span remember up to this step. Returns whether one of them has not been quiet for long enough.
bool is_restless(World &world, int64_t begin, int64_t end) {
    Particles &p = world.particles;
    const Constants &c = world.constants;
    const bool fluid = !p.fluidity.empty();
    const double dt = world.clock.dt, enough = quiet_time(c);
    const double way = quiet_way * c.spacing, fading = dt / enough;
    Repose &r = p.repose;
    double pressure = 0, change = 0, change_xx = 0, change_xy = 0, weight = 0, fluidity = 0, fluidity_before = 0;
    double momentum_x = 0, momentum_y = 0; // kg/m3 m/s
    double shortest = enough;
    for (int64_t i = begin; i < end; ++i) {
        r.quiet_for[i] += dt;
        r.way_x[i] += dt * p.vx[i] - fading * r.way_x[i];
        r.way_y[i] += dt * p.vy[i] - fading * r.way_y[i];
        if (r.way_x[i] * r.way_x[i] + r.way_y[i] * r.way_y[i] > way * way)
            begin_anew(p, i);
        shortest = std::min(shortest, r.quiet_for[i]);
        pressure += p.pressure[i];
        change += p.pressure[i] - r.pressure[i];
        change_xx += p.sxx[i] - r.sxx[i];
        change_xy += p.sxy[i] - r.sxy[i];
        const double density = world.material_of(i).density;
        weight += density;
        momentum_x += density * p.vx[i];
        momentum_y += density * p.vy[i];
        if (fluid) {
            fluidity += p.fluidity[i];
            fluidity_before += r.fluidity[i];
        }
    }
    const double size = std::max(1.0, full_span / static_cast<double>(end - begin));
    const double most = quiet_stress * (pressure + size * weight * c.gravity.norm() * c.spacing);
    const double blow = c.wave_speed * std::hypot(momentum_x, momentum_y); // the stress of the wave when it stops
    const bool grows = fluidity > (1 + quiet_growth) * fluidity_before;
    if (grows || !(blow <= 0.5 * most) || !(std::abs(change) <= most) || !(std::hypot(change_xx, change_xy) <= most)) {
        for (int64_t i = begin; i < end; ++i)
            begin_anew(p, i);
        return true;
    }
    return shortest < enough;
}

void average_loads(World &world) {
    Sleep &s = world.sleep;
    const double volume = world.particles.volume;
    const double share = std::min(1.0, world.clock.dt / (mean_spans * fall_time(world.constants)));
    const Contact *const first = world.walls.contacts.data();
    for_each_awake_contact(world, [&](const Contact &contact) {
        const auto k = static_cast<std::size_t>(&contact - first);
        MeanLoad &load = s.loads[k];
        load.x += share * (s.pushed[k].x() - volume * contact.force_x - load.x);
        load.y += share * (s.pushed[k].y() - volume * contact.force_y - load.y);
        load.couple += share * (-volume * contact.couple - load.couple);
        s.pushed[k] = Vector::Zero();
    });
}

// A span comes to rest: what is left of its motion is lost. Returns the energy, J/m.
double lay_down(World &world, int64_t span) {
    Particles &p = world.particles;
    double kinetic = 0;
    for_each_of(world, span, [&](int64_t i) {
        kinetic += world.material_of(i).density * (p.vx[i] * p.vx[i] + p.vy[i] * p.vy[i]);
        p.vx[i] = p.vy[i] = p.ax[i] = p.ay[i] = p.push_x[i] = p.push_y[i] = 0;
        p.lxx[i] = p.lxy[i] = p.lyx[i] = p.lyy[i] = 0;
        p.repose.asleep[i] = 1;
    });
    clear_exchanged(world, span);
    world.sleep.asleep[span] = 1;
    return 0.5 * p.volume * kinetic;
}

// Of several processes each must know that none of the others has work.
bool all_sleep(const World &world, bool stale) {
    const Sleep &s = world.sleep;
    if (!world.crossing)
        return s.some && s.awake == 0;
    const std::vector<Plate> &plates = world.walls.plates;
    return !stale && s.awake_of_all == 0 && std::none_of(plates.begin(), plates.end(), acts);
}

} // namespace

void wake(World &world) {
    Sleep &s = world.sleep;
    const bool stale = s.stale;
    bool changed = stale || s.fallen;
    if (stale) {
        take_over_spans(world, quiet_time(world.constants));
        take_over_contacts(world);
    }
    s.stale = s.fallen = false;
    s.may_rest = std::count(s.restless.begin(), s.restless.begin() + s.spans, 0) > 0;
    if (!s.may_rest) {
        s.some = false;
    } else {
        find_reached(world);
        for (int64_t span = 0; span < s.spans; ++span)
            if (s.asleep[span] && s.reached[span]) {
                s.asleep[span] = 0;
                for_each_of(world, span, [&](int64_t i) { world.particles.repose.asleep[i] = 0; });
                changed = true;
            }
        if (changed)
            choose_work(world);
    }
    s.idle = all_sleep(world, stale);
}

void sleep(World &world) {
    Sleep &s = world.sleep;
    for_each_awake_block(
        world, [&](int64_t span, int64_t begin, int64_t end) { s.restless[span] = is_restless(world, begin, end); });
    average_loads(world);
    if (!s.may_rest)
        return;
    for (int64_t span = 0; span < s.spans; ++span)
        if (!s.asleep[span] && !s.reached[span] && !s.restless[span]) {
            world.ledger.dissipated += lay_down(world, span);
            s.fallen = true;
        }
}

void wake_all(World &world) {
    Sleep &s = world.sleep;
    Particles &p = world.particles;
    for (int64_t i = 0; i < p.count; ++i) {
        begin_anew(p, i);
        p.repose.asleep[i] = 0;
    }
    s.some = s.idle = s.fallen = false;
    s.stale = true;
}

} // namespace gp::stages
