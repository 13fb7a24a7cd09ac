#include "diagnostics.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

#include "ledger.hpp"
#include "parts.hpp"
#include "stages/stages.hpp"
#include "stretches.hpp"
#include "volume_drift.hpp"

namespace gp {

namespace {

// Over one stretch of particles after the other.
class StateSums {
public:
    explicit StateSums(const World &world) : energies_(world) {}

    // asleep: of each particle, or NULL.
    void add(const World &world, const char *asleep) {
        const Particles &p = world.particles;
        energies_.add(world);
        centre_.add(world);
        box_.add(world);
        double momentum_x = momentum_x_, momentum_y = momentum_y_, speed2 = speed2_;
        for (int64_t i = 0; i < p.count; ++i) {
            const double mass = world.material_of(i).density * p.volume;
            const double own2 = p.vx[i] * p.vx[i] + p.vy[i] * p.vy[i];
            momentum_x += mass * p.vx[i];
            momentum_y += mass * p.vy[i];
            speed2 += own2;
            most_speed2_ = std::max(most_speed2_, own2);
            most_pressure_ = std::max(most_pressure_, p.pressure[i]);
        }
        momentum_x_ = momentum_x;
        momentum_y_ = momentum_y;
        speed2_ = speed2;
        count_ += p.count;
        if (asleep)
            asleep_ += std::count(asleep, asleep + p.count, 1);
    }

    void hand_out(const World &world, gp_state &s) const {
        const Energies &e = energies_.all();
        s.n_particles = count_;
        s.n_awake = count_ - asleep_;
        s.kinetic = e.kinetic;
        s.potential = e.potential;
        s.elastic = e.elastic;
        s.momentum_x = momentum_x_;
        s.momentum_y = momentum_y_;
        s.max_pressure = most_pressure_;
        s.max_speed = std::sqrt(most_speed2_);
        s.rms_speed = count_ > 0 ? std::sqrt(speed2_ / static_cast<double>(count_)) : 0.0;
        const Vector centre = centre_.of();
        s.centre_x = centre.x();
        s.centre_y = centre.y();
        s.energy_error = world.ledger.initial - (e.sum() + world.ledger.dissipated + world.ledger.plate_work);
        s.at_rest = is_at_rest(world, e.kinetic, count_, box_.of()) ? 1 : 0;
    }

private:
    EnergySums energies_;
    CentreSums centre_;
    BoxOfAll box_;
    int64_t count_ = 0, asleep_ = 0;
    double momentum_x_ = 0, momentum_y_ = 0, speed2_ = 0, most_speed2_ = 0, most_pressure_ = 0;
};

} // namespace

gp_state measure_sums(const World &world) {
    const Particles &p = world.particles;
    gp_state s{};
    s.struct_size = sizeof s;
    s.time = world.clock.time;
    s.step = world.clock.step;
    s.dt = world.clock.step > 0 ? world.clock.dt : 0.0;
    s.dt_reason = world.clock.step > 0 ? world.clock.reason : GP_DT_NONE;
    s.dt_limit = stages::stable_dt(world.constants);
    s.retries = world.retries;
    s.max_compression = world.max_compression;

    s.dissipated = world.ledger.dissipated;
    s.plate_work = world.ledger.plate_work;
    s.penalty_dissipated = world.ledger.penalty;
    s.wall_dissipated = world.ledger.walls;
    s.diffusion_dissipated = world.ledger.diffusion;
    s.spacing_dissipated = world.ledger.spacing;
    s.bulk_dissipated = world.ledger.bulk;
    s.collision_dissipated = world.ledger.collisions;
    s.channel_dissipated = world.ledger.side_walls;

    s.implicit_last = world.viscous.last;
    s.implicit_newton = world.viscous.newton;
    s.implicit_linear = world.viscous.linear;
    s.implicit_failures = world.viscous.failures;
    s.implicit_residual = world.viscous.last_residual;

    StateSums sums(world);
    std::vector<char> asleep;
    if (world.sleep.in_use)
        for (int64_t i = 0; i < p.count; ++i)
            asleep.push_back(p.repose.asleep[i] != 0);
    for_each_stretch(world, asleep, [&](const World &stretch, const char *flags) {
        sums.add(stretch, world.sleep.in_use ? flags : nullptr);
    });
    sums.hand_out(world, s);

    s.collisions = world.collisions;
    s.sound_speed = world.constants.sound_speed;
    s.gravity_x = world.constants.gravity.x();
    s.gravity_y = world.constants.gravity.y();
    tell_all(world.crossing, &s);
    return s;
}

void measure_parts(const World &world, uint32_t parts, gp_state &s) {
    if (parts & GP_STATE_DEPOSIT) {
        const std::vector<char> connected = connected_deposit(world);
        const Surface surface(world, connected);
        on_first(world, [&] {
            if (surface.empty())
                return;
            s.x_left = surface.left();
            s.x_right = surface.right();
            surface.peak(s.peak_x, s.peak_height);
        });
        s.detached = detached_share(world, connected);
    }
    if (parts & GP_STATE_MARKS) {
        const MassMarks marks = measure_marks(world);
        s.x_q01 = marks[0];
        s.x_q05 = marks[1];
        s.x_q25 = marks[2];
        s.x_q50 = marks[3];
        s.x_q75 = marks[4];
        s.x_q95 = marks[5];
        s.x_q99 = marks[6];
    }
    if (parts & GP_STATE_DRIFT)
        s.volume_drift = drift_of(world, measure_packing(world, Part::flowing));
    tell_all(world.crossing, &s);
}

void leave_out(uint32_t parts, gp_state &s) {
    const auto forget = [](std::initializer_list<double *> values) {
        for (double *value : values)
            *value = std::numeric_limits<double>::quiet_NaN();
    };
    if (parts & GP_STATE_DEPOSIT)
        forget({&s.x_left, &s.x_right, &s.peak_x, &s.peak_height, &s.detached});
    if (parts & GP_STATE_MARKS)
        forget({&s.x_q01, &s.x_q05, &s.x_q25, &s.x_q50, &s.x_q75, &s.x_q95, &s.x_q99});
    if (parts & GP_STATE_DRIFT)
        forget({&s.volume_drift});
}

gp_state measure_state(const World &world) {
    gp_state s = measure_sums(world);
    measure_parts(world, GP_STATE_ALL, s);
    return s;
}

} // namespace gp
