#include "plate.hpp"

#include <cmath>

namespace gp {

Pose Plate::prescribed_pose(double time) const {
    if (state_.driven) {
        const double since = time - state_.driven_since;
        return {state_.driven_from.shift + since * state_.driven_motion.velocity,
                state_.driven_from.angle + since * state_.driven_motion.omega};
    }
    if (!spec_->table.empty())
        return {spec_->table.displacement(time), spec_->table.turn(time)};
    return {spec_->start + time * spec_->motion.velocity, spec_->start_angle + time * spec_->motion.omega};
}

Pose Plate::pose(double time) const {
    Pose pose = prescribed_pose(time);
    pose.shift += state_.fallen * spec_->back_normal;
    return pose;
}

void Plate::fall(double dt, double default_mass) {
    const Vector &normal = spec_->back_normal;
    const double mass = spec_->length * (spec_->mass > 0 ? spec_->mass : default_mass); // kg/m
    const double change = dt * (spec_->load * spec_->back_length + normal.dot(force)) / mass;
    state_.fall_speed += change;
    state_.fallen += dt * state_.fall_speed;
    state_.motion.velocity += change * normal;
}

void Plate::drive(double time, const Motion &motion) {
    state_.driven_from = prescribed_pose(time);
    state_.driven_since = time;
    state_.driven_motion = state_.motion = motion;
    state_.driven = true;
    state_.motion.velocity += state_.fall_speed * spec_->back_normal; // the next step's size goes by it
}

bool Plate::moves_after(double time) const {
    if (loaded())
        return true;
    if (by_table())
        return time < spec_->table.last_time();
    return prescribed_motion().any();
}

bool Plate::moves_with(const Plate &other) const {
    if (spec_ == other.spec_)
        return true;
    if (loaded() || other.loaded() || by_table() != other.by_table())
        return false;
    if (by_table()) {
        const MotionTable &own = spec_->table, &others = other.spec_->table;
        return own.t == others.t && own.x == others.x && own.y == others.y && own.angle == others.angle &&
               (own.angle.empty() || spec_->pivot == other.spec_->pivot);
    }
    const Motion motion = prescribed_motion();
    return motion == other.prescribed_motion() && (motion.omega == 0 || pivot() == other.pivot());
}

void Plate::wrap(const Period &period, double time) {
    state_.wrapped = period.shift_of(Placing(pose(time), spec_->pivot).of(spec_->middle).x());
}

void Plate::place(double time, double dt) {
    State &s = state_;
    s.placed = pose(time);
    s.placed.shift -= Vector(s.wrapped, 0);
    if (s.driven || spec_->table.empty())
        s.motion = prescribed_motion();
    else if (dt > 0) {
        const Pose now = prescribed_pose(time), then = prescribed_pose(time + dt);
        s.motion = {(then.shift - now.shift) / dt, (then.angle - now.angle) / dt};
    } else // placed anew between steps, before the first one: as it was
        return;
    s.motion.velocity += s.fall_speed * spec_->back_normal;
}

double Plate::fastest() const {
    return state_.motion.velocity.norm() + std::abs(spec_->surface_velocity) +
           std::abs(state_.motion.omega) * spec_->farthest;
}

} // namespace gp
