#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "parts.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

// Relative motion in one of the scheme's own steps, in dl, down to the step of quick motion. The collapse with a = 1.25, L/dl = 32,
// eight runs with an own share of .6 (scene_constants.cpp): its steps, peak and R90 to those of the finest, +- .3 %:
//   none  3600  -3.3 %  +.7 %      .07  3880  -2.5  -.3      always the step of quick motion  5700  -2.1  -.7
//   .1    3690  -3.1    +.3        .05  3980  -2.1  -.8
// and the energy error of a column with a = 50 falls from 4 to 3 %, to that of the last.
constexpr double own_motion = 0.06;

// The smallest step that the flow may ask for, over dl / wave speed: relative speeds of 32 wave speeds. An automatic sound
// speed keeps the flow below a tenth of one; what is beyond has been given a wrong sound speed or been flung away.
constexpr double least_flow_step = 1.0 / 128;

// Lets the steps land on a point of time: the last two share what is left, so that none is tiny.
bool land(double left, double &dt) {
    if (left >= 2 * dt || left == dt)
        return false;
    dt = left <= dt ? left : 0.5 * left;
    return true;
}

// A plate that is out of reach does not limit the step by the flow; but none may jump over what it has not seen.
double arrival(const World &world) {
    double soonest = INFINITY;
    for (const Plate &plate : world.walls.plates)
        if (plate.gap > 0)
            soonest = std::min(soonest, (plate.gap + world.constants.spacing) / (plate.fastest() + world.fastest));
    return soonest;
}

// Who is fastest, for an error: a particle, or a plate in its reach or about to be.
std::string fastest_of(const World &world) {
    const Particles &p = world.particles;
    double fastest = -1;
    int64_t particle = 0;
    for (int64_t i = 0; i < p.count; ++i)
        if (const double speed = std::hypot(p.vx[i], p.vy[i]); speed > fastest) {
            fastest = speed;
            particle = i;
        }
    std::string text;
    if (p.count > 0)
        text = format_text("the fastest particle is %lld at (%g, %g) m with (%g, %g) m/s",
                           static_cast<long long>(p.id[particle]), p.x[particle], p.y[particle], p.vx[particle],
                           p.vy[particle]);
    if (world.crossing)
        text = text_of_largest(*world.crossing, fastest, text);
    const std::vector<Plate> &plates = world.walls.plates;
    for (std::size_t k = 0; k < plates.size(); ++k)
        if (const double speed = plates[k].fastest(); speed > fastest && plates[k].gap <= speed * world.clock.dt) {
            const Motion &motion = plates[k].motion();
            return format_text("plate %zu moves at (%g, %g) m/s and %g rad/s, at most %g m/s", k, motion.velocity.x(),
                               motion.velocity.y(), motion.omega, speed);
        }
    return text;
}

} // namespace

double stable_dt(const Constants &constants) {
    return std::min({constants.sound_step, constants.viscous_step, constants.contrast_step, constants.plate_step});
}

void require_moderate_flow(const World &world) {
    const Constants &c = world.constants;
    const double dt = flow_share * c.spacing / world.velocity_span, least = least_flow_step * c.spacing / c.wave_speed;
    if (world.scene->config().time_step > 0 || !(dt < least))
        return;
    if (world.clock.step == 0)
        throw make_error(GP_E_ARGUMENT,
                         "gp_config.sound_speed = %g m/s in use: expected at least %g for speeds that differ by %g m/s "
                         "(time steps of %g s are below %g, the smallest); %s",
                         c.sound_speed, c.sound_speed * least / dt, world.velocity_span, dt, least,
                         fastest_of(world).c_str());
    throw make_error(GP_E_DIVERGED,
                     "flow: speeds differ by %g m/s, %g sound speeds, and ask for time steps of %g s, below %g, the "
                     "smallest; %s, time %g s, step %lld",
                     world.velocity_span, world.velocity_span / c.sound_speed, dt, least, fastest_of(world).c_str(),
                     world.clock.time, static_cast<long long>(world.clock.step));
}

void choose_dt(World &world) {
    const gp_config &config = world.scene->config();
    const Constants &c = world.constants;
    Clock &clock = world.clock;
    double dt = config.time_step;
    clock.reason = GP_DT_DEMANDED;
    if (dt == 0) {
        const auto limit = [&](double most, int32_t reason) {
            if (most < dt) {
                dt = most;
                clock.reason = reason;
            }
        };
        dt = config.cfl > 0 ? config.cfl * c.spacing / c.wave_speed : c.own_step;
        clock.reason = GP_DT_SOUND;
        if (config.cfl == 0 && world.velocity_span > 0)
            limit(std::max(own_motion * c.spacing / world.velocity_span, c.quick_step), GP_DT_FLOW);
        if (!config.allow_unstable_step || config.cfl == 0) {
            limit(c.plate_step, GP_DT_PLATE);
            limit(c.viscous_step, GP_DT_VISCOSITY);
            limit(c.contrast_step, GP_DT_SOUND);
        }
        if (world.velocity_span > 0)
            limit(flow_share * c.spacing / world.velocity_span, GP_DT_FLOW);
        limit(arrival(world), GP_DT_FLOW);
    }
    if (!world.pieces.empty()) {
        const double left = world.pieces.back().end - clock.time;
        const bool shorter = left < dt;
        if (land(left, dt) && shorter)
            clock.reason = GP_DT_RETRY;
    }
    if (clock.time_left > 0 && land(clock.time_left, dt))
        clock.reason = GP_DT_END;
    clock.dt = dt; // also where it is refused: whether half of it would do is asked of it
    if (!(clock.time + dt > clock.time))
        throw make_error(clock.step == 0 ? GP_E_ARGUMENT : GP_E_DIVERGED,
                         "time step %g s: too small to move the clock on from %g s; speeds differ by up to %g m/s", dt,
                         clock.time, world.velocity_span);
    // Only a demanded step is as long as this.
    const double motion = world.velocity_span * dt / c.spacing;
    if (!(motion <= motion_bound) || dt > arrival(world))
        throw make_error(GP_E_DIVERGED,
                         "flow: speeds differ by %g m/s, a motion of %g dl in a step of %g s, expected at most %g; %s, "
                         "time %g s, step %lld",
                         world.velocity_span, motion, dt, motion_bound, fastest_of(world).c_str(), clock.time,
                         static_cast<long long>(clock.step));
}

} // namespace gp::stages
