// Lines of facets: what meets end to end and moves together, of one plate or of several, is one wall, a chain. Its ghosts stand on one lattice that follows
// the line, so that a joint is no seam: with a lattice of its own behind each plate, a joint half a spacing off the lattice
// left the row above a level floor at .39 to 1.52 of the hydrostatic pressure, never at rest.
//
// Friction is each plate's own. Not of a chain: loaded plates; plates that turn by more than 50 degrees at a corner, or bulge
// towards the material by more than that within a horizon (floor and wall of a box, the edges of a sharp obstacle); ends
// that three or more could continue.
#pragma once

#include <cstdint>
#include <vector>

#include "neighbors.hpp"
#include "plate.hpp"

namespace gp {

// A facet where it stands, or its image across an end of the period.
struct FacetImage {
    Segment segment;
    int32_t facet;
    double shift;  // m, of the image
    double before; // m, from where the segment begins to end 0
    bool near;     // within reach of the particles' box
};

// Ends nearer to each other than this meet.
constexpr double joint = 0.01; // dl

// A place for a ghost.
struct WallPlace {
    int32_t image;                 // of the facet in front of it
    double along, depth;           // m, in the frame of that image's segment
    double x, y, nx, ny, distance; // m; unit vector to the wetted line, and the distance on that way
    double lean;                   // of the unit vector along the segment
};

class FacetChains {
public:
    struct Member {
        int32_t image;
        double turn; // to the next one, radians, positive: the body's side opens
    };
    struct Chain {
        int32_t number;     // of the first of its facets: the same for all images of a chain
        int32_t begin, end; // in members_
        int32_t repeats;    // members after which it begins anew: all of a ring, those of one period, else 0
    };
    // The facets of the chain before end 0 and after end 1 of a facet; -1: none.
    struct Link {
        int32_t before = -1, after = -1;
    };

    // Finds the chains of the images; each is one of its own unless they may join. reach: m, of the ghosts.
    void find(const std::vector<Plate> &plates, const std::vector<Facet> &facets, const std::vector<FacetImage> &images,
              double reach, double spacing, bool may_join);

    // Do all plates still move with those that they have moved with since find()? A host may drive one of them away.
    bool stand(const std::vector<Plate> &plates) const;

    const std::vector<Chain> &all() const { return chains_; } // in order of number
    const Chain &chain_of(int32_t image) const { return chains_[chain_of_image_[image]]; }
    int32_t place_of(int32_t image) const { return chain_of_image_[image]; } // in all()
    const Link &link(int32_t facet) const { return links_[facet]; }
    bool joined(int32_t facet) const { return links_[facet].before >= 0 || links_[facet].after >= 0; }
    bool any() const { return any_; } // has any chain more than one facet?

    // Rows of lattice points behind the chain's near facets that lie within `radius` of the box: each row keeps its distance
    // from the wetted line, along which it turns with a fan where the body opens, and is cut at the bisector where it closes.
    void add_places(const Chain &chain, const std::vector<FacetImage> &images, const Box &box, double radius,
                    double spacing, std::vector<WallPlace> &places);

    int64_t bytes() const;

private:
    struct Joint {
        int32_t before, after;             // images
        int32_t plate_before, plate_after; // theirs
        bool together;
    };
    struct Reach { // of a member: where along it places are of use
        double low, high;
        bool near;
    };
    struct Row;
    bool are_where_they_were(const std::vector<Plate> &plates, const std::vector<FacetImage> &images);
    void find_joints(const std::vector<Facet> &facets, const std::vector<FacetImage> &images, double spacing);
    void cut_bulges(const std::vector<FacetImage> &images, double reach);
    void number_facets();
    void line_up(const std::vector<FacetImage> &images);
    bool find_reaches(const Chain &chain, const std::vector<FacetImage> &images, const Box &box, double radius);
    void add_row(const Row &row, const std::vector<FacetImage> &images, std::vector<WallPlace> &places) const;

    std::vector<Segment> segments_;                         // of the images, when the chains were found
    std::vector<Joint> joints_;                             // where they meet, moving together or not
    std::vector<int32_t> before_, after_, by_x_, arrivals_; // of images
    std::vector<Link> links_;                               // of facets
    std::vector<int32_t> number_;                           // of facets
    std::vector<Member> members_;
    std::vector<Chain> chains_;
    std::vector<int32_t> chain_of_image_;
    std::vector<Reach> reaches_;
    bool any_ = false;
};

} // namespace gp
