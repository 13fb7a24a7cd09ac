#include "mirrors.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gp {

// The contacts of the particles that images stand for: those are in contact with what they see, of which some may be too far away
// to be seen by anything here.
void Mirrors::tell_contacts(const Walls &walls, const Particles &particles, const Images &images, Crossing *crossing) {
    contacts_of_images_.clear();
    if (!images.in_use())
        return;
    int32_t most = 0;
    for (int64_t i = 0; i < particles.count; ++i)
        most = std::max(most, walls.contact_start[i + 1] - walls.contact_start[i]);
    if (crossing) {
        double most_of_all = most;
        crossing->combine(&most_of_all, 1, nullptr, 0);
        most = static_cast<int32_t>(most_of_all);
    }
    most_contacts_ = most;
    contacts_of_images_.resize(static_cast<std::size_t>(most * images.count));
    Field<double> chain(particles.count + images.count), facet(chain.size());
    for (int32_t k = 0; k < most; ++k) {
        for (int64_t i = 0; i < particles.count; ++i) {
            const int32_t c = walls.contact_start[i] + k;
            const bool any = c < walls.contact_start[i + 1];
            chain[i] = any ? walls.contacts[c].chain : -1;
            facet[i] = any ? walls.contacts[c].listed_facet : -1;
        }
        images.copy({&chain, &facet});
        for (int64_t j = 0; j < images.count; ++j)
            contacts_of_images_[j * most + k] = {static_cast<int32_t>(chain[particles.count + j]),
                                                 static_cast<int32_t>(facet[particles.count + j])};
    }
}

// Of the contact that a particle or image has with the wall in front of a ghost; -1 if there is none.
int32_t Mirrors::facet_in_front(const Walls &walls, const Particles &particles, int64_t i, int64_t g) const {
    if (i < particles.count) {
        const int64_t c = walls.contact_of(i, g);
        return c < 0 ? -1 : walls.contacts[c].listed_facet;
    }
    const ContactOfImage *const first = contacts_of_images_.data() + (i - particles.count) * most_contacts_;
    int32_t found = -1;
    double most = -INFINITY;
    for (const ContactOfImage *contact = first; contact != first + most_contacts_ && contact->chain >= 0; ++contact)
        if (const double here = walls.alike(contact->chain, contact->facet, g); here > most) {
            most = here;
            found = contact->facet;
        }
    return found;
}

void Mirrors::find(const Walls &walls, const Particles &particles, const CellGrid &grid, const Images &images,
                   double radius, Crossing *crossing) {
    tell_contacts(walls, particles, images, crossing);
    of_ghost.start.resize(walls.ghost_count + 1);
    of_ghost.start[0] = 0;
    of_ghost.index.clear();
    const int64_t contacts = static_cast<int64_t>(walls.contacts.size());
    contact_start.assign(contacts + 1, 0);
    for (int64_t g = 0; g < walls.ghost_count; ++g) {
        const Vector mirror = Vector(walls.ghost_x[g], walls.ghost_y[g]) +
                              2 * walls.ghost_distance[g] * Vector(walls.ghost_nx[g], walls.ghost_ny[g]);
        for_each_candidate(grid, images, mirror.x(), mirror.y(), radius, [&](int64_t i) {
            const double dx = particles.x[i] - mirror.x(), dy = particles.y[i] - mirror.y();
            if (dx * dx + dy * dy < radius * radius && facet_in_front(walls, particles, i, g) >= 0)
                of_ghost.index.push_back(static_cast<int32_t>(i));
        });
        if (static_cast<int64_t>(of_ghost.index.size()) == of_ghost.start[g]) {
            const auto begin = walls.particles_of_ghost.index.begin();
            of_ghost.index.insert(of_ghost.index.end(), begin + walls.particles_of_ghost.start[g],
                                  begin + walls.particles_of_ghost.start[g + 1]);
        }
        of_ghost.start[g + 1] = static_cast<int64_t>(of_ghost.index.size());
    }

    facet_of_entry.resize(walls.particles_of_ghost.index.size());
    for (int64_t g = 0; g < walls.ghost_count; ++g)
        for (int64_t k = walls.particles_of_ghost.start[g]; k < walls.particles_of_ghost.start[g + 1]; ++k) {
            const int32_t facet = facet_in_front(walls, particles, walls.particles_of_ghost.index[k], g);
            facet_of_entry[k] = facet < 0 ? walls.ghost_facet[g] : facet;
        }

    // The same by contact. Those of images belong to the contacts of other particles.
    const auto for_each_entry = [&](const auto &found) {
        for (int64_t g = 0; g < walls.ghost_count; ++g)
            for (int64_t k = of_ghost.start[g]; k < of_ghost.start[g + 1]; ++k)
                if (of_ghost.index[k] < particles.count)
                    found(walls.contact_of(of_ghost.index[k], g), g, k);
    };
    for_each_entry([&](int64_t c, int64_t, int64_t) { ++contact_start[c + 1]; });
    std::partial_sum(contact_start.begin(), contact_start.end(), contact_start.begin());
    ghost.resize(contact_start[contacts]);
    place.resize(contact_start[contacts]);
    for_each_entry([&](int64_t c, int64_t g, int64_t k) {
        const int64_t next = contact_start[c]++;
        ghost[next] = static_cast<int32_t>(g);
        place[next] = k;
    });
    for (int64_t c = contacts; c > 0; --c)
        contact_start[c] = contact_start[c - 1];
    contact_start[0] = 0;
}

} // namespace gp
