// Who sees a ghost: the straight way to it passes through its wall and no other before it.
#pragma once

#include <algorithm>
#include <cmath>

#include "facet_chains.hpp"
#include "segment_cells.hpp"

namespace gp {

// Two plates passed at fractions of the way that differ by less are passed at their common corner: twice the tolerance of
// crossing(), 1e-9 dl, over ways of at least half a spacing.
constexpr double corner = 1e-8;

// A particle this close behind the line still counts as in front of it: the contact stage is about to push it back.
constexpr double penetration_allowed = 0.25; // dl

// What can be seen of a ghost, and through which plate of its chain.
//
// The chain's plates that turn by less than a right angle from the ghost's own are its own side, through any of which it is
// seen; those that face otherwise (the far side of a thin body) hide it like another chain's.
struct Sight {
    const std::vector<FacetImage> &images;
    const FacetChains &chains;
    double radius, spacing;
    int32_t *about; // room for the plates about a ghost: of its own side from the front on, others from the back on
    int64_t room;
    int64_t own = 0, others = 0;
    SegmentCells::Run run = {}; // all of them

    double tolerance() const { return 1e-9 * spacing; }
    // Where the way passes an image of its own side. Ends that meet within the joint's tolerance leave no slit.
    double passing(int32_t image, const Vector &from, const Vector &at) const {
        const FacetChains::Link &link = chains.link(images[image].facet);
        const double meet = joint * spacing;
        return crossing(images[image].segment, from, at, link.before < 0 ? tolerance() : meet,
                        link.after < 0 ? tolerance() : meet);
    }
    bool is_own(const WallPlace &ghost, int32_t image) const {
        return image == ghost.image || (chains.place_of(image) == chains.place_of(ghost.image) &&
                                        images[image].segment.tangent.dot(images[ghost.image].segment.tangent) > 0);
    }

    // False if another plate of its side is nearer to the ghost: that one has ghosts of its own there.
    bool look_about(const WallPlace &ghost, const SegmentCells &cells) {
        run = cells.about(ghost.x, ghost.y);
        own = others = 0;
        const Vector at(ghost.x, ghost.y);
        const double far = radius + tolerance(), nearer = std::max(0.0, ghost.distance - 0.1 * spacing);
        const auto add = [&](int32_t q) {
            const Segment &s = images[q].segment;
            const double distance2 = s.nearest_square(at);
            if (distance2 > far * far)
                return true;
            if (!is_own(ghost, q))
                about[room - ++others] = q;
            else {
                if (q != ghost.image && distance2 < nearer * nearer)
                    return false;
                about[own++] = q;
            }
            return true;
        };
        // Outwards from the ghost's own plate: through what is in front of it most see it.
        const int32_t *middle = std::lower_bound(run.first, run.last, ghost.image);
        for (const int32_t *up = middle, *down = middle; up != run.last || down != run.first;) {
            if (up != run.last && !add(*up++))
                return false;
            if (down != run.first && !add(*--down))
                return false;
        }
        return true;
    }

    // The image of its own side that the way passes first, -1 if it passes none. Which one matters only to what hides.
    int32_t pass(const Vector &from, const Vector &at, double &fraction) const {
        int32_t passed = -1;
        fraction = INFINITY;
        for (int64_t k = 0; k < own && (passed < 0 || others > 0); ++k)
            if (const double here = passing(about[k], from, at); here >= 0 && here < fraction) {
                fraction = here;
                passed = about[k];
            }
        return passed;
    }

    // The same for any place, also from slightly behind a plate; -1 if the ghost is hidden.
    int32_t seen_through(const WallPlace &ghost, Vector from) const {
        const Vector at(ghost.x, ghost.y);
        double fraction;
        int32_t passed = pass(from, at, fraction);
        for (const int32_t *q = run.first; passed < 0 && q != run.last; ++q) {
            const Segment &s = images[*q].segment;
            const double d = s.distance(from);
            if (d > 0 || d < -penetration_allowed * spacing || !s.covers(s.along(from), tolerance()) ||
                !is_own(ghost, *q))
                continue;
            from += (tolerance() - d) * s.normal;
            passed = pass(from, at, fraction);
            break;
        }
        if (passed < 0)
            return -1;
        const int32_t chain = chains.place_of(ghost.image);
        for (int64_t k = 1; k <= others; ++k) {
            const int32_t q = about[room - k];
            const double here = crossing(images[q].segment, from, at, tolerance());
            // What is seen through a corner of two walls, as on the diagonal of a box, is the first one's.
            if (here >= 0 && here < (chains.place_of(q) < chain ? fraction + corner : fraction - corner))
                return -1;
        }
        return passed;
    }
};

} // namespace gp
