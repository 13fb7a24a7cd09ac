// The particles about a ghost's mirror point, as far in front of the plate as the ghost is behind it: what the ghost's
// velocity follows from in the implicit scheme. Where there is none (thin layers, corners), those that see the ghost.
#pragma once

#include <cstdint>

#include "neighbors.hpp"
#include "particles.hpp"
#include "walls.hpp"

namespace gp {

struct Mirrors {
    NeighborList of_ghost;        // particles and images of each ghost
    Field<int64_t> contact_start; // entries of contact c: contact_start[c] .. contact_start[c + 1]
    Field<int32_t> ghost;         // of an entry
    Field<int64_t> place;         // of an entry in of_ghost.index

    // The plate that each entry of Walls::particles_of_ghost is in front of: that of the contact that it is part of.
    Field<int32_t> facet_of_entry;

    // Of particles within `radius` of the mirror points that are in contact with the ghost's plate.
    void find(const Walls &walls, const Particles &particles, const CellGrid &grid, const Images &images, double radius,
              Crossing *crossing);

    int64_t bytes() const {
        return of_ghost.bytes() +
               static_cast<int64_t>((contact_start.capacity() + place.capacity()) * sizeof(int64_t) +
                                    (ghost.capacity() + facet_of_entry.capacity()) * sizeof(int32_t) +
                                    contacts_of_images_.capacity() * sizeof(ContactOfImage));
    }

private:
    struct ContactOfImage {
        int32_t chain, facet; // -1: none
    };

    void tell_contacts(const Walls &walls, const Particles &particles, const Images &images, Crossing *crossing);
    int32_t facet_in_front(const Walls &walls, const Particles &particles, int64_t i, int64_t ghost) const;

    std::vector<ContactOfImage> contacts_of_images_; // as many for each of them
    int64_t most_contacts_ = 0;
};

} // namespace gp
