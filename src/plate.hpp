// A plate's motion, and what acts on it.
#pragma once

#include "geometry.hpp"
#include "scene.hpp"

namespace gp {

// A plate in motion.
class Plate {
public:
    explicit Plate(const PlateSpec &spec)
        : spec_(&spec), driven_from_(Vector::Zero()), driven_velocity_(Vector::Zero()) {}

    Vector displacement(double time) const;
    // The host drives the plate from now on.
    void drive(double time, const Vector &velocity);
    // Can it still move after `time` by its own motion?
    bool moves_after(double time) const;
    // Do the two keep their places to each other from now on, by how they are to move and not by how fast they are?
    bool moves_with(const Plate &other) const;
    bool driven() const { return driven_; }
    // Takes whole periods off where it stands, so that its middle is within the period. displacement() keeps them.
    void wrap(const Period &period, double time);
    // All that changes of a plate, but for the loads.
    struct Motion {
        bool driven = false;
        double driven_since = 0;
        Vector driven_from = Vector::Zero(), driven_velocity = Vector::Zero();
        double fallen = 0, fall_speed = 0; // m, m/s, along the normal, of a loaded plate
        double wrapped = 0;                // m, whole periods taken off in x
        Vector origin = Vector::Zero();    // m, where place() put end 0
        Vector velocity = Vector::Zero();
    };
    Motion motion() const;
    void set_motion(const Motion &motion);

    // Displacement at `time`, and the mean velocity of the step that follows.
    void place(double time, double dt);

    const PlateSpec &spec() const { return *spec_; }
    const Segment &segment() const { return placed_; } // where place() put it
    bool loaded() const { return spec_->load > 0; }
    // Moves a loaded plate along its normal: load and the material's force over one step. default_mass: kg/m2.
    void fall(double dt, double default_mass);
    const Vector &velocity() const { return velocity_; }

    Vector force = Vector::Zero();   // N/m, of the material on the plate over the last step
    double torque = 0;               // N, about end 0
    Vector impulse = Vector::Zero(); // N s/m, since the start
    double gap = 0;                  // m, by which plate and material are out of each other's reach at least

private:
    bool by_table() const { return !driven_ && !spec_->table.empty(); }
    Vector prescribed_displacement(double time) const;

    const PlateSpec *spec_;
    bool driven_ = false;
    double driven_since_ = 0;
    Vector driven_from_, driven_velocity_;
    double fallen_ = 0, fall_speed_ = 0; // m, m/s, along the normal, of a loaded plate
    double wrapped_ = 0;                 // m, whole periods taken off in x
    Segment placed_ = spec_->segment;
    Vector velocity_ = Vector::Zero();
};

} // namespace gp
