// A plate's motion as a rigid body, and what acts on it. Its line is made of facets.
#pragma once

#include <algorithm>
#include <cmath>

#include "exact_sum.hpp"
#include "geometry.hpp"
#include "scene.hpp"

namespace gp {

// One over the units in which loads are added up exactly: a 2^60th of what a spacing bears under the pressure rho c0^2.
struct LoadScale {
    double force = 1, torque = 1; // m/N, 1/N

    LoadScale() = default;
    explicit LoadScale(const Constants &c) {
        double modulus = 0;
        for (const MaterialConstants &m : c.materials)
            modulus = std::max(modulus, m.bulk_modulus);
        force = std::exp2(60 - std::ilogb(modulus * c.spacing));
        torque = std::exp2(60 - std::ilogb(modulus * c.spacing * c.spacing));
    }
};

// A plate in motion.
class Plate {
public:
    explicit Plate(const PlateSpec &spec) : spec_(&spec) {}

    // Where it is at `time`, periods not taken off.
    Pose pose(double time) const;
    // The host drives the plate from now on.
    void drive(double time, const Motion &motion);
    // Can it still move after `time` by its own motion?
    bool moves_after(double time) const;
    // Do the two keep their places to each other from now on, by how they are to move and not by how fast they are?
    bool moves_with(const Plate &other) const;
    bool driven() const { return state_.driven; }
    // Of a plate without a table, and of one that the host has taken from it.
    Motion prescribed_motion() const { return state_.driven ? state_.driven_motion : spec_->motion; }
    // Takes whole periods off where it stands, so that its middle is within the period. pose() keeps them.
    void wrap(const Period &period, double time);
    // All that changes of a plate, but for the loads.
    struct State {
        bool driven = false;
        double driven_since = 0;
        Pose driven_from;
        Motion driven_motion;
        double fallen = 0, fall_speed = 0; // m, m/s, along the normal, of a loaded plate
        double wrapped = 0;                // m, whole periods taken off in x
        Pose placed;                       // by place()
        Motion motion;
    };
    const State &state() const { return state_; }
    State &state() { return state_; }

    // Its pose at `time`, and its mean motion in the step that follows.
    void place(double time, double dt);

    const PlateSpec &spec() const { return *spec_; }
    // Of the time-0 line to where place() put it.
    Placing placing() const { return {state_.placed, spec_->pivot}; }
    const Pose &placed() const { return state_.placed; }
    const Motion &motion() const { return state_.motion; }
    Vector pivot() const { return spec_->pivot + state_.placed.shift; } // where place() put it
    // Does it turn, has it turned, or may it?
    bool may_turn() const {
        return state_.placed.angle != 0 || state_.motion.omega != 0 || state_.driven || !spec_->table.angle.empty();
    }
    bool loaded() const { return spec_->load > 0; }
    // Moves a loaded plate along its normal: load and the material's force over one step. default_mass: kg/m2.
    void fall(double dt, double default_mass);
    // m/s, of the body at a place that turns with it.
    Vector velocity_at(const Vector &at) const {
        const Vector arm = at - pivot();
        return {state_.motion.velocity.x() - state_.motion.omega * arm.y(),
                state_.motion.velocity.y() + state_.motion.omega * arm.x()};
    }
    // m/s, no point of its line is faster, the motion of a belt's surface included.
    double fastest() const;

    ExactLoad load; // of the step under way; at its end the next three are taken from it
    void take_load(const LoadScale &scale) {
        const auto &[fx, fy, about_first, about_pivot] = load.all();
        force = Vector(fx.value(scale.force), fy.value(scale.force));
        torque = about_first.value(scale.torque);
        torque_pivot = about_pivot.value(scale.torque);
    }

    Vector force = Vector::Zero();   // N/m, of the material on the plate over the last step
    double torque = 0;               // N, about its first point
    double torque_pivot = 0;         // N, about the pivot
    Vector impulse = Vector::Zero(); // N s/m, since the start
    double impulse_torque = 0;       // N s, of torque_pivot, since the start
    double gap = 0;                  // m, by which plate and material are out of each other's reach at least

private:
    bool by_table() const { return !state_.driven && !spec_->table.empty(); }
    Pose prescribed_pose(double time) const;

    const PlateSpec *spec_;
    State state_;
};

// A straight part of a plate's line.
struct Facet {
    const PlateSpec *spec; // of the plate
    int32_t plate;
    int32_t number;  // in the plate's line
    Segment segment; // where it is
};

} // namespace gp
