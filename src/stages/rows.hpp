// One particle's neighbours as the pair loops see them: its row of the lists, then its rows of ghosts, plate by plate.
#pragma once

#include "awake.hpp"
#include "lanes.hpp"
#include "operators.hpp"
#include "world.hpp"

namespace gp::stages {

struct Rows {
    const int64_t *start;
    const int32_t *index;
    const int32_t *contact_start; // NULL where no plate is in reach
    const Contact *contacts;
    const int32_t *ghost_index;

    explicit Rows(const World &world)
        : start(world.neighbors.start.data()), index(world.neighbors.index.data()),
          contact_start(world.walls.in_reach() ? world.walls.contact_start.data() : nullptr),
          contacts(world.walls.contacts.data()), ghost_index(world.walls.ghost_of_contact.data()) {}

    GP_INLINE const int32_t *row(int64_t i) const { return index + start[i]; }
    GP_INLINE int64_t count(int64_t i) const { return start[i + 1] - start[i]; }

    // The plates that particle i sees: none, or a run of contacts.
    struct Run {
        const Contact *first, *last;
        const Contact *begin() const { return first; }
        const Contact *end() const { return last; }
    };
    GP_INLINE Run contacts_of(int64_t i) const {
        if (!contact_start)
            return {contacts, contacts};
        return {contacts + contact_start[i], contacts + contact_start[i + 1]};
    }
    GP_INLINE const int32_t *ghosts(const Contact &contact) const { return ghost_index + contact.begin; }
    GP_INLINE static int64_t ghost_count(const Contact &contact) { return contact.end - contact.begin; }
};

// The clusters and their rows, as the pair loops see them: from first[c] on, step by step.
struct Clusters {
    const int32_t *first;
    const int64_t *start;
    const int16_t *step;
    const uint8_t *partly_seen; // NULL where no plate has material behind it
    const uint8_t *seen_by;

    explicit Clusters(const World &world) : Clusters(world.clusters, world.clusters.all) {}
    Clusters(const ClusterList &list, const ClusterRows &rows)
        : first(list.first.data()), start(rows.start.data()), step(rows.step.data()),
          partly_seen(list.partly_seen.empty() ? nullptr : list.partly_seen.data()), seen_by(rows.seen_by.data()) {}

    GP_INLINE int64_t stop(int64_t cluster) const { return start[cluster + 1]; }
    GP_INLINE bool is_partly_seen(int64_t cluster) const { return partly_seen && partly_seen[cluster]; }
    // The weight of entry k, 0 in the lanes that do not see it.
    GP_INLINE Lanes seen(const Lanes &w, int64_t k) const { return seen_by_lanes(w, seen_by[k]); }
};

// The first cluster of each half of a block, of which block b has 2 b and 2 b + 1. In halves no thread waits for long for the last of
// the sixteen blocks that a thousand particles are.
struct Halves {
    const int32_t *of_block;

    explicit Halves(const World &world) : of_block(world.clusters.cluster_of_block.data()) {}
    GP_INLINE int32_t operator()(int64_t half) const {
        const int64_t block = half / 2;
        return half % 2 == 0 ? of_block[block] : (of_block[block] + of_block[block + 1]) / 2;
    }
};

// Calls body(first, last) for runs of clusters of what is awake: for stages that keep no sum of a block. In as few calls as may be.
template <class Body> void for_each_awake_cluster_run(const World &world, const Body &body) {
    const Sleep &s = world.sleep;
    const Halves edge(world);
    for_each_share(world.threads, 2 * (s.some ? s.awake : world.clusters.blocks()), [&](int64_t begin, int64_t end) {
        if (!s.some)
            body(edge(begin), edge(end));
        else
            for (int64_t half = begin; half < end; ++half) {
                const int64_t there = 2 * int64_t{s.lit[half / 2]} + half % 2;
                body(edge(there), edge(there + 1));
            }
    });
}
// For stages that do: calls part(first, last) for the clusters of halves of blocks, and whole(block, begin, end) for all of a block's
// particles once both halves are done.
template <class Part, class Whole>
void for_each_awake_block_by_halves(World &world, const Part &part, const Whole &whole) {
    const Sleep &s = world.sleep;
    const Halves edge(world);
    const auto particle_at = [&](int64_t half) -> int64_t { return world.clusters.first[edge(half)]; };
    const auto block_at = [&](int64_t k) { return s.some ? int64_t{s.lit[k]} : k; };
    for_each_block_by_halves(
        world.threads, s.some ? s.awake : world.clusters.blocks(),
        [&](int64_t k) -> uint8_t & { return world.sums[block_at(k)].half_done; },
        [&](int64_t k, int64_t from, int64_t to) {
            const int64_t half = 2 * block_at(k);
            part(edge(half + from), edge(half + to));
        },
        [&](int64_t k) {
            const int64_t block = block_at(k);
            whole(block, particle_at(2 * block), particle_at(2 * block + 2));
        });
}

// Calls body(block, first, last) for the clusters of each block of particles that is awake, and of those asleep that these see.
template <class Body> void for_each_seen_cluster_block(const World &world, const Body &body) {
    const int32_t *of_block = world.clusters.cluster_of_block.data();
    for_each_seen_block(world,
                        [&](int64_t block, int64_t, int64_t) { body(block, of_block[block], of_block[block + 1]); });
}

// A plate with its own idea of friction passes no shear: of a sum of velocity differences (x) ways to its ghosts, the
// change along the normal of the velocity along the plate, t.M.n, is left out.
GP_INLINE double shear_of(const Facet &facet, double xx, double xy, double yx, double yy) {
    const Vector &t = facet.segment.tangent, &n = facet.segment.normal;
    return t.x() * (xx * n.x() + xy * n.y()) + t.y() * (yx * n.x() + yy * n.y());
}
GP_INLINE void add_shear(const Facet &facet, double shear, double &xx, double &xy, double &yx, double &yy) {
    const Vector &t = facet.segment.tangent, &n = facet.segment.normal;
    xx += shear * t.x() * n.x();
    xy += shear * t.x() * n.y();
    yx += shear * t.y() * n.x();
    yy += shear * t.y() * n.y();
}
GP_INLINE void drop_shear(const Facet &facet, double &xx, double &xy, double &yx, double &yy) {
    add_shear(facet, -shear_of(facet, xx, xy, yx, yy), xx, xy, yx, yy);
}
// But not what has no shear in the plate's own frame: that of a turn with it, given sum w (way (x) way). Without this, material
// at rest in a smooth box that turns with it sheared by .11 of its rate.
GP_INLINE double shear_of_turn(const Facet &facet, double omega, double sxx, double sxy, double syy) {
    return omega == 0 ? 0.0 : shear_of(facet, -omega * sxy, -omega * syy, omega * sxx, omega * sxy);
}
// Only a rough one does: this decides it for all stages, and for every kind of wall.
GP_INLINE bool passes_shear(const Facet &facet) {
    return facet.spec->friction == GP_WALL_NO_SLIP;
}
GP_INLINE void drop_wall_shear(const Facet &facet, double omega, Moments &m) {
    if (passes_shear(facet))
        return;
    drop_shear(facet, m.mxx, m.mxy, m.myx, m.myy);
    if (omega != 0)
        add_shear(facet, shear_of_turn(facet, omega, m.kxx, m.kxy, m.kyy), m.mxx, m.mxy, m.myx, m.myy);
}

// The gradient that a particle's neighbours make without the ghosts of plates: what the zero-energy penalty, which acts
// between particles alone, goes by. (By the gradient with ghosts it sheared layers that slide on a rough plate: the lowest rows
// stopped, and the rows above slid on.) The first contact of a particle keeps it.
inline Tensor inner_gradient(const World &world, int64_t i) {
    const Particles &p = world.particles;
    const Rows::Run contacts = Rows(world).contacts_of(i);
    if (contacts.first != contacts.last)
        return contacts.first->inner;
    Tensor l;
    l << p.lxx[i], p.lxy[i], p.lyx[i], p.lyy[i];
    return l;
}

} // namespace gp::stages
