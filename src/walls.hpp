// Plates: their motion, the ghost particles that stand for their bodies, and the loads on them.
//
// A ghost exists only while a particle can see it: on the lattice of the spacing behind the plate's wetted line (extended
// past its ends to fill corners), within the horizon of a particle from which the straight way to the ghost passes
// through this plate and no other before it. So each point behind a corner belongs to exactly one plate, and a thin
// gate hides what is behind it.
#pragma once

#include <cstdint>
#include <vector>

#include "neighbors.hpp"
#include "particles.hpp"
#include "scene.hpp"

namespace gp {

// A particle nearer than this to a plate and approaching collides with it: the collision distance of 0.9 dl from the
// first layer of ghosts, half a spacing behind the surface.
constexpr double contact_distance = 0.4; // dl

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

// The ghosts that a particle sees of one plate, or of one chain of plates: then `plate` is the one nearest to the particle.
struct Contact {
    int32_t particle, plate, chain;
    int64_t begin, end;                          // in Walls::ghost_of_contact
    double force_x, force_y;                     // N/m3: force density on the particle
    double power;                                // W/m3: of that force on the particle
    double ghost_power;                          // W/m3: the ghosts' share of sigma : L
    double inner_xx = 0, inner_xy = 0, inner_yx = 0, inner_yy = 0; // 1/s: gradient of the particles alone, without ghosts;
                                                                   // kept with the first contact of each particle
    double held_normal = 0, held_tangential = 0; // m/s: by wall_support and wall_hold in this step
};

struct Walls {
    std::vector<Plate> plates;
    Period period; // of the scene

    // Ghosts in reach of material.
    int64_t ghost_count = 0;
    Field<int32_t> ghost_plate, ghost_chain;
    Field<int32_t> wall_particle; // the ghost of the first layer whose state it takes; only in the paper's schemes
    Field<double> ghost_along, ghost_depth;        // m, in the plate's frame: from end 0, and behind the wetted line
    Field<double> ghost_nx, ghost_ny;              // from the ghost to the wetted line, unit vector
    Field<double> ghost_distance;                  // m, on that way; ghost_depth but for the fans at corners of chains
    Field<double> ghost_shift;                     // m, 0 or a period up or down; periodic scenes only
    Field<double> ghost_x, ghost_y;                // m
    Field<double> ghost_vx, ghost_vy;              // m/s, extrapolated
    Field<double> ghost_axx, ghost_axy, ghost_ayy; // stress over the full-lattice shape tensor, N/m4 per unit of w r

    NeighborList particles_of_ghost; // (close_count unused)
    Field<int32_t> plate_of_entry;   // of particles_of_ghost.index: the plate of the chain nearest to the particle
    Field<int32_t> ghost_of_contact; // rows of contacts
    Field<int32_t> contact_start;    // contacts of particle i: contact_start[i] .. contact_start[i + 1]
    std::vector<Contact> contacts;   // ordered by particle, then plate

    // The image of a point that is nearest to a plate's middle.
    Vector nearest_image(const Plate &plate, Vector point) const {
        if (period) {
            const Segment &s = plate.segment();
            point.x() -=
                period.length * std::round((point.x() - s.origin.x() - 0.5 * s.length * s.tangent.x()) / period.length);
        }
        return point;
    }

    // The loads are those of one step: the stage that finds the forces clears them first.
    void clear_loads() {
        for (Plate &plate : plates) {
            plate.force = Vector::Zero();
            plate.torque = 0;
        }
    }

    // The material's force (N/m) on a plate, acting at a point.
    void add_load(int32_t id, const Vector &at, const Vector &force) {
        Plate &plate = plates[id];
        const Vector &t = plate.segment().tangent;
        plate.force += force;
        plate.torque += plate.segment().along(nearest_image(plate, at)) * (t.x() * force.y() - t.y() * force.x());
    }

    bool in_reach() const { return !contacts.empty(); }
    int64_t bytes() const;

    // Plates with material right behind them: pairs of particles do not interact through these.
    const std::vector<Segment> &barriers(const Particles &particles, const CellGrid &grid, double radius);

    // Finds ghosts and contacts within `radius` of the sorted particles.
    void find_contacts(const Particles &particles, const CellGrid &grid, const Images &images, double radius,
                       double spacing, bool chained, int threads);

    // The plate of the chain that a place is in front of, searched from `plate` on; nearest to it beside all ends.
    int32_t facing(int32_t plate, const Vector &at) const {
        for (int step = 0; step < 64; ++step) {
            const Segment &s = plates[plate].segment();
            const double along = s.along(nearest_image(plates[plate], at));
            const int32_t other = along < 0 ? links_[plate].before : along >= s.length ? links_[plate].after : -1;
            if (other < 0)
                return plate;
            const Segment &o = plates[other].segment();
            const Vector image = nearest_image(plates[other], at);
            if (o.nearest(image) > s.nearest(nearest_image(plates[plate], at)) ||
                (along < 0 ? o.along(image) >= o.length : o.along(image) < 0)) // between the two, or turning back
                return plate;
            plate = other;
        }
        return plate;
    }

    // Finds the wall particle of each ghost: the one in front of it, or the nearest that is between the plate's ends.
    void find_wall_particles(double spacing);

    // Moves the ghosts along with their plates.
    void place_ghosts(int threads);

    // Particles within `margin` of a plate's wetted line, on either side: a scene drawn wrongly.
    int64_t count_overlapping(const Particles &particles, double margin) const;

private:
    // Plates in reach, each with its images across the ends of the period.
    struct Nearby {
        Segment segment;
        int32_t plate;
        double shift;  // m, of the image
        double before; // m, from where the segment begins to end 0
        int32_t chain; // number
    };
    struct Link {
        int32_t before = -1, after = -1; // plates
    };
    struct Chain {
        int32_t root; // the same for all images
        std::vector<int32_t> members; // images, in order
        std::vector<double> turn;     // after each, radians, positive: opens on the body's side
        bool closed;
    };
    void find_chains(double radius, double spacing, bool chained);
    void place_chain(const Chain &chain, const CellGrid &grid, double radius, double spacing);
    const std::vector<Nearby> &images_of_plates();
    void find_nearby(const Particles &particles, const CellGrid &grid, double radius);
    void place_candidates(const CellGrid &grid, double radius, double spacing);

    struct Candidate {
        int32_t nearby; // which
        double along, depth, x, y, nx, ny, distance;
        int64_t neighbors; // particles and images that see it
        bool seen;         // by a particle
    };
    std::vector<Nearby> nearby_, images_;
    std::vector<int32_t> nearby_of_image_;
    std::vector<Link> links_;
    std::vector<Chain> chains_;
    std::vector<Segment> barriers_;
    std::vector<Candidate> candidates_;
    Field<int32_t> fill_, plate_of_contact_;
};

} // namespace gp
