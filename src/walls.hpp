// Plates: the ghost particles that stand for their bodies, and the loads on them.
//
// A ghost exists only while a particle can see it: on the lattice of the spacing behind the wetted line of a chain of plates
// (extended past its ends to fill corners), within the horizon of a particle from which the straight way to the ghost passes
// through this chain and no other before it. So each point behind a corner belongs to exactly one wall, and a thin gate
// hides what is behind it.
#pragma once

#include <cstdint>
#include <vector>

#include "clusters.hpp"
#include "crossing.hpp"
#include "facet_chains.hpp"
#include "neighbors.hpp"
#include "particles.hpp"
#include "plate.hpp"
#include "segment_cells.hpp"
#include "wall_lanes.hpp"

namespace gp {

// A particle nearer than this to a plate and approaching collides with it: the collision distance of 0.9 dl from the
// first layer of ghosts, half a spacing behind the surface.
constexpr double contact_distance = 0.4; // dl

// The ghosts that a particle sees of one side of a chain of facets, and the facet of it that the particle is in front of:
// what pushes it, rubs it and bears its load. In a narrow groove a particle has contacts with both sides.
struct Contact {
    int32_t particle;
    int32_t facet, listed_facet; // in front of which it is in this step, and was when the lists were made
    int32_t chain;               // its number
    int64_t begin, end;          // in Walls::ghost_of_contact
    double force_x, force_y;     // N/m3: force density on the particle
    double power;                // W/m3: of that force on the particle
    double ghost_power;          // W/m3: the ghosts' share of sigma : L
    // 1/s: the velocity gradient that the particle's neighbours make without ghosts; kept by its first contact.
    Tensor inner = Tensor::Zero();
    // m/s, what plates give in this step: by wall_support and wall_hold; the second by wall_friction in the default scheme
    double held_normal = 0, held_tangential = 0;
    double couple = 0; // N/m2, a density as the force: on the particle beside it
};

struct Walls {
    std::vector<Plate> plates;
    std::vector<Facet> facets; // of all plates, one plate after the other
    Period period;             // of the scene
    LoadScale load_scale;      // likewise

    // Ghosts in reach of material.
    int64_t ghost_count = 0;
    bool ghosts_placed = false;   // by place_ghosts, since the lists were made
    Field<int32_t> ghost_facet;   // the one in front of it
    Field<int32_t> ghost_chain;   // number
    Field<int32_t> wall_particle; // the ghost of the first layer whose state it takes; only in the paper's schemes
    Field<double> ghost_along, ghost_depth;        // m, in the facet's frame: from end 0, and behind the wetted line
    Field<double> ghost_nx, ghost_ny;              // from the ghost to the wetted line of its chain, unit vector
    Field<double> ghost_lean;                      // along the facet's tangent, of that vector
    Field<double> ghost_distance;                  // m, on that way; ghost_depth but where the line turns
    Field<double> ghost_shift;                     // m, 0 or a period up or down; periodic scenes only
    Field<double> ghost_x, ghost_y;                // m
    Field<double> ghost_vx, ghost_vy;              // m/s, extrapolated
    Field<double> ghost_axx, ghost_axy, ghost_ayy; // stress over the full-lattice shape tensor, N/m4 per unit of w r

    NeighborList particles_of_ghost;
    Field<int32_t> ghost_of_contact; // rows of contacts
    Field<int32_t> contact_start;    // contacts of particle i: contact_start[i] .. contact_start[i + 1]
    Field<Contact> contacts;         // ordered by particle, then chain
    WallLanes lanes;                 // both, four at a time

    const Plate &plate_of(int32_t facet) const { return plates[facets[facet].plate]; }

    // m/s, of a facet's surface at a place: of the body, and of the belt on it.
    Vector velocity_at(int32_t facet, const Vector &at) const {
        const Facet &f = facets[facet];
        return plates[f.plate].velocity_at(nearest_image(f.segment, at)) + f.spec->surface_velocity * f.segment.tangent;
    }

    // The image of a point that is nearest to a facet's middle. (A point changed in place is stored by halves and read as a whole,
    // for which processors wait.)
    Vector nearest_image(const Segment &s, const Vector &point) const {
        if (!period)
            return point;
        const double periods = std::round((point.x() - s.origin.x() - 0.5 * s.length * s.tangent.x()) / period.length);
        return {point.x() - period.length * periods, point.y()};
    }

    // The loads are those of one step: the stage that finds the forces clears them first.
    void clear_loads() {
        for (Plate &plate : plates)
            plate.load = {};
    }
    void take_loads() {
        for (Plate &plate : plates)
            plate.take_load(load_scale);
    }

    // The material's force (N/m) on a facet of a plate, acting at a point.
    void add_load(int32_t facet, const Vector &at, const Vector &force);
    void add_couple(int32_t plate, double couple) { plates[plate].load.add_couple(couple, load_scale.torque); }

    // The facets of all plates, where these are.
    void make_facets(const Scene &scene);
    void place_facets();
    // Places the plates for the step from `time` on, and the facets of those that have moved.
    void place_plates(double time, double dt);

    bool in_reach() const { return !contacts.empty(); }
    int64_t bytes() const;

    // Plates with material right behind them, anywhere.
    const Barriers &barriers(const Particles &particles, const CellGrid &grid, double radius, Crossing *crossing);

    // Finds ghosts and contacts within `radius` of the sorted particles. everywhere: the box of all particles, also those of other
    // processes; beyond: how much farther ghosts are that images alone see, 0 where nobody asks for these; reach: the radius
    // without a skin; may_join: plates that meet become one wall.
    void find_contacts(const Particles &particles, const CellGrid &grid, const Images &images, const Box &everywhere,
                       double radius, double beyond, double reach, double spacing, bool may_join, int threads);

    // Do the plates that made a wall when the lists were made still move together?
    bool chains_stand() const { return chains_.stand(plates); }

    // Turns each contact to the facet of its chain that the particle is in front of by now.
    void face_facets(const Particles &particles);

    // Is a place in front of the facet's surface, not past a free end of it? Past a joint, the next facet has it from the next
    // step on.
    bool faces(int32_t facet, const Vector &at) const {
        const Segment &s = facets[facet].segment;
        const double along = s.along(at);
        const FacetChains::Link &link = chains_.link(facet);
        return (along >= 0 || link.before >= 0) && (along < s.length || link.after >= 0);
    }

    // Particle i's contact with the wall in front of a ghost, -1 if there is none.
    int64_t contact_of(int64_t i, int64_t ghost) const;
    // How much a facet of a chain faces as a ghost does; -infinity if it is another chain's.
    double alike(int32_t chain, int32_t facet, int64_t ghost) const {
        const Vector &n = facets[facet].segment.normal;
        return chain == ghost_chain[ghost] ? n.x() * ghost_nx[ghost] + n.y() * ghost_ny[ghost] : -INFINITY;
    }

    // Finds the wall particle of each ghost: the one in front of it, or the nearest that is between the plate's ends.
    void find_wall_particles(double spacing);

    // Moves the ghosts along with their plates.
    void place_ghosts(int threads);

private:
    const std::vector<FacetImage> &images_of_facets();
    void find_near(const Box &everywhere, double radius);
    void place_candidates(const Box &about, double radius, double spacing);
    void find_seeing(const Particles &particles, const CellGrid &grid, const Images &images, double radius,
                     double spacing, bool images_count, int threads);
    void keep_seen();
    void make_contacts(const Particles &particles);
    void add_contacts(const Particles &particles, int64_t i, int32_t begin, int32_t end);
    int32_t facing(int32_t facet, const Vector &at) const;

    struct Candidate {     // of the place of the same number
        int64_t first;     // of its entries in particles_of_ghost and passed_
        int64_t neighbors; // particles and images that see it
        bool seen;         // by a particle
    };
    std::vector<FacetImage> images_; // facets, and in a periodic scene their images
    FacetChains chains_;
    SegmentCells cells_;
    Barriers barriers_;
    std::vector<double> has_behind_; // of images, 1 or 0: material right behind it
    std::vector<WallPlace> places_;  // of ghosts
    std::vector<Candidate> candidates_;
    Field<int32_t> passed_; // the plate that the way passes from who sees a candidate
    Field<int32_t> about_;  // facets about a ghost, for each block of ghosts
    Field<int32_t> passed_of_contact_;
};

} // namespace gp
