#include "wall_lanes.hpp"

#include <algorithm>

#include "walls.hpp"

namespace gp {

void LaneRows::clear() {
    start.assign(1, 0);
    index.clear();
    seen_by.clear();
}

void LaneRows::add(Row (&rows)[lane_count]) {
    int64_t room = 0;
    for (const Row &row : rows)
        room += row.end - row.next;
    const auto used = static_cast<int64_t>(index.size());
    index.resize(used + room);
    seen_by.resize(used + room);
    int32_t *at = index.data() + used;
    uint8_t *by = seen_by.data() + used;
    // Without branches, which no processor foretells here.
    static constexpr int32_t none = INT32_MAX;
    const auto head = [](const Row &row) { return *(row.next != row.end ? row.next : &none); };
    int32_t heads[lane_count];
    for (int l = 0; l < lane_count; ++l)
        heads[l] = head(rows[l]);
    for (;;) {
        const int32_t least = std::min(std::min(heads[0], heads[1]), std::min(heads[2], heads[3]));
        if (least == none)
            break;
        unsigned lanes = 0;
        for (int l = 0; l < lane_count; ++l) {
            const bool sees = heads[l] == least;
            lanes |= static_cast<unsigned>(sees) << l;
            rows[l].next += sees;
            heads[l] = head(rows[l]);
        }
        *at++ = least;
        *by++ = static_cast<uint8_t>(lanes);
    }
    index.resize(at - index.data());
    seen_by.resize(index.size());
    start.push_back(static_cast<int32_t>(index.size()));
}

int64_t WallLanes::bytes() const {
    return particles_of_ghosts.bytes() + ghosts_of_contacts.bytes() +
           static_cast<int64_t>(
               contacts.capacity() * sizeof(ContactGroup) +
               (of_cluster.capacity() + number_of_.capacity() + of_number_.capacity() + numbers_.capacity()) *
                   sizeof(int32_t));
}

void WallLanes::make_rows_of_ghosts(const Walls &walls, const CellGrid &grid, const Images &images) {
    const NeighborList &seen = walls.particles_of_ghost;
    const bool numbered = images.count > 0;
    const int32_t *entries = seen.index.data();
    if (numbered) {
        of_number_.clear();
        number_of_.resize(grid.count() + images.count);
        const Box all{-INFINITY, INFINITY, -INFINITY, INFINITY};
        for_each_run_in(grid, images, all, [&](int64_t begin, int64_t end) {
            for (int64_t j = begin; j < end; ++j) {
                number_of_[j] = static_cast<int32_t>(of_number_.size());
                of_number_.push_back(static_cast<int32_t>(j));
            }
        });
        numbers_.resize(seen.index.size());
        std::transform(seen.index.begin(), seen.index.end(), numbers_.begin(),
                       [&](int32_t j) { return number_of_[j]; });
        entries = numbers_.data();
    }
    for (int64_t first = 0; first < walls.ghost_count; first += lane_count) {
        LaneRows::Row rows[lane_count];
        for (int l = 0; l < lane_count && first + l < walls.ghost_count; ++l)
            rows[l] = {entries + seen.start[first + l], entries + seen.start[first + l + 1]};
        particles_of_ghosts.add(rows);
    }
    if (numbered)
        for (int32_t &entry : particles_of_ghosts.index)
            entry = of_number_[entry];
}

void WallLanes::make(const Walls &walls, const ClusterList &clusters, const CellGrid &grid, const Images &images) {
    particles_of_ghosts.clear();
    ghosts_of_contacts.clear();
    contacts.clear();
    of_cluster.clear();
    if (!walls.in_reach())
        return;
    make_rows_of_ghosts(walls, grid, images);
    of_cluster.push_back(0);
    for (int64_t c = 0; c < clusters.count(); ++c) {
        const int32_t first = clusters.first[c], lanes = clusters.first[c + 1] - first;
        int32_t next[lane_count], end[lane_count];
        for (int32_t l = 0; l < lanes; ++l) {
            next[l] = walls.contact_start[first + l];
            end[l] = walls.contact_start[first + l + 1];
        }
        // Contacts of a particle are in order of chain; of two with one chain, each goes into a group of its own.
        for (;;) {
            int32_t chain = INT32_MAX;
            for (int32_t l = 0; l < lanes; ++l)
                if (next[l] < end[l])
                    chain = std::min(chain, walls.contacts[next[l]].chain);
            if (chain == INT32_MAX)
                break;
            ContactGroup group{{-1, -1, -1, -1}};
            LaneRows::Row rows[lane_count];
            for (int32_t l = 0; l < lanes; ++l)
                if (next[l] < end[l] && walls.contacts[next[l]].chain == chain) {
                    group.contact[l] = next[l]++;
                    const Contact &contact = walls.contacts[group.contact[l]];
                    rows[l] = {walls.ghost_of_contact.data() + contact.begin,
                               walls.ghost_of_contact.data() + contact.end};
                }
            contacts.push_back(group);
            ghosts_of_contacts.add(rows);
        }
        of_cluster.push_back(static_cast<int32_t>(contacts.size()));
    }
}

} // namespace gp
