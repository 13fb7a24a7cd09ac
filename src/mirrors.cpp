#include "mirrors.hpp"

#include <numeric>

namespace gp {

void Mirrors::find(const Walls &walls, const Particles &particles, const CellGrid &grid, const Images &images,
                   double radius) {
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
            if (dx * dx + dy * dy < radius * radius && walls.contact_of(images.source(i), g) >= 0)
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
            const int64_t c = walls.contact_of(images.source(walls.particles_of_ghost.index[k]), g);
            facet_of_entry[k] = c < 0 ? walls.ghost_facet[g] : walls.contacts[c].listed_facet;
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
