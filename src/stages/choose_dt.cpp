#include <algorithm>

#include "error.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

// The scheme's own step over dl / wave speed, and the largest that a host may demand.
struct Cfl {
    double own, stable;
};

// Measured on the collapse with a = 1.25, L/dl = 32: steps of 0.3 to 2.0 are stable and leave the same deposit (peak y/L
// .402 to .409, at rest); with horizons of 2.2 and 3 dl, and with L/dl = 16, 1.0 and 1.3 are.
constexpr Cfl adjoint_cfl{0.8, 1.0};

// The printed schemes are far beyond the limit of their viscosity at any step that sound allows; what bounds them is
// |tau| <= mu p. On the same collapse all steps up to 2.0 run (L/dl = 16 and 32), but the longer the step the more they
// creep. Non-local, factor 2: peak y/L .500, .505, .505, .491, .471, .456, .428 at .42 s for 0.05, 0.1, 0.2, 0.4, 0.8, 1.0
// and 1.4, and .482, .481, .462, .447, .406, .384, .343 at 1 s; local .361, .356, .351, .354 at .42 s for 0.2, 0.4, 0.8, 1.0.
// With the horizon 2.2 dl, 1.7 makes energy: five times that of the start by .42 s.
constexpr Cfl paper_cfl{0.2, 1.0};

Cfl cfl_of(const Constants &c) {
    return by_number_density(c.scheme) ? paper_cfl : adjoint_cfl;
}

// Relative motion allowed in one step, in dl: positions, and so neighbours, change little.
constexpr double flow_share = 0.25;

} // namespace

double stable_dt(const Constants &constants) {
    return std::min(cfl_of(constants).stable * constants.spacing / constants.wave_speed, constants.plate_step);
}

void choose_dt(World &world) {
    const gp_config &config = world.scene->config();
    const Constants &c = world.constants;
    Clock &clock = world.clock;
    double dt = config.time_step;
    if (dt == 0) {
        const double cfl = config.cfl > 0 ? config.cfl : cfl_of(c).own;
        dt = std::min(cfl * c.spacing / c.wave_speed, c.plate_step);
        if (world.velocity_span > 0)
            dt = std::min(dt, flow_share * c.spacing / world.velocity_span);
    }
    if (clock.time_left > 0) {
        // The last two steps share what is left, so that none is tiny.
        if (clock.time_left <= dt)
            dt = clock.time_left;
        else if (clock.time_left < 2 * dt)
            dt = 0.5 * clock.time_left;
    }
    if (!(clock.time + dt > clock.time))
        throw make_error(clock.step == 0 ? GP_E_ARGUMENT : GP_E_DIVERGED,
                         "time step %g s: too small to move the clock on from %g s; speeds differ by up to %g m/s", dt,
                         clock.time, world.velocity_span);
    clock.dt = dt;
}

} // namespace gp::stages
