#include "plate.hpp"

namespace gp {

Vector Plate::prescribed_displacement(double time) const {
    if (driven_)
        return driven_from_ + (time - driven_since_) * driven_velocity_;
    if (!spec_->table.empty())
        return spec_->table.displacement(time);
    return spec_->start + time * spec_->velocity;
}

Vector Plate::displacement(double time) const {
    return prescribed_displacement(time) + fallen_ * spec_->segment.normal;
}

void Plate::fall(double dt, double default_mass) {
    const Segment &s = spec_->segment;
    const double mass = s.length * (spec_->mass > 0 ? spec_->mass : default_mass); // kg/m
    const double change = dt * (spec_->load * s.length + s.normal.dot(force)) / mass;
    fall_speed_ += change;
    fallen_ += dt * fall_speed_;
    velocity_ += change * s.normal;
}

void Plate::drive(double time, const Vector &velocity) {
    driven_from_ = prescribed_displacement(time);
    driven_since_ = time;
    driven_velocity_ = velocity;
    driven_ = true;
    velocity_ = velocity + fall_speed_ * spec_->segment.normal; // the next step's size goes by it
}

bool Plate::moves_after(double time) const {
    if (loaded())
        return true;
    if (driven_)
        return driven_velocity_ != Vector::Zero();
    if (by_table())
        return time < spec_->table.last_time();
    return spec_->velocity != Vector::Zero();
}

bool Plate::moves_with(const Plate &other) const {
    if (loaded() || other.loaded() || by_table() != other.by_table())
        return false;
    if (by_table()) {
        const MotionTable &own = spec_->table, &others = other.spec_->table;
        return own.t == others.t && own.x == others.x && own.y == others.y;
    }
    return (driven_ ? driven_velocity_ : spec_->velocity) ==
           (other.driven_ ? other.driven_velocity_ : other.spec_->velocity);
}

void Plate::wrap(const Period &period, double time) {
    const Segment &s = spec_->segment;
    wrapped_ = period.shift_of(s.origin.x() + 0.5 * s.length * s.tangent.x() + displacement(time).x());
}

void Plate::place(double time, double dt) {
    placed_ = spec_->segment.moved(displacement(time) - Vector(wrapped_, 0));
    if (driven_)
        velocity_ = driven_velocity_;
    else if (spec_->table.empty())
        velocity_ = spec_->velocity;
    else if (dt > 0)
        velocity_ = (spec_->table.displacement(time + dt) - spec_->table.displacement(time)) / dt;
    else // placed anew between steps, before the first one: as it was
        return;
    velocity_ += fall_speed_ * spec_->segment.normal;
}

Plate::Motion Plate::motion() const {
    return {driven_,     driven_since_, driven_from_,   driven_velocity_, fallen_,
            fall_speed_, wrapped_,      placed_.origin, velocity_};
}

void Plate::set_motion(const Motion &motion) {
    driven_ = motion.driven;
    driven_since_ = motion.driven_since;
    driven_from_ = motion.driven_from;
    driven_velocity_ = motion.driven_velocity;
    fallen_ = motion.fallen;
    fall_speed_ = motion.fall_speed;
    wrapped_ = motion.wrapped;
    placed_.origin = motion.origin;
    velocity_ = motion.velocity;
}

} // namespace gp
