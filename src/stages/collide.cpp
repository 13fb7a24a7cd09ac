// The collision safeguard (Jin et al. 2021, 2.9 and 2.10): approaching pairs that are closer than the collision distance
// lose the velocity of their approach, each taking the share of the other's mass. Where a particle collides with several
// at once, each pair's impulse is divided by the larger number of partners of the two: momentum is kept exactly and the
// energy cannot grow.
#include <algorithm>
#include <cmath>

#include "parallel.hpp"
#include "stages/push.hpp"
#include "stages/rows.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

// Calls found(j, e, u) for the colliding partners of i: e the unit vector to j, u the speed of approach.
template <class Found>
void for_each_partner(const World &world, int64_t cluster, int64_t i, double distance, const Found &found) {
    const Particles &p = world.particles;
    const ClusterList &clusters = world.clusters;
    const bool partly = !clusters.partly_seen.empty() && clusters.partly_seen[cluster];
    for (int64_t k = clusters.start[cluster]; k < clusters.close_stop[cluster]; ++k) {
        const int32_t j = clusters.index[k];
        const double dx = p.x[j] - p.x[i], dy = p.y[j] - p.y[i];
        const double r2 = dx * dx + dy * dy;
        if (r2 >= distance * distance || r2 == 0)
            continue;
        const double approach = (p.vx[i] - p.vx[j]) * dx + (p.vy[i] - p.vy[j]) * dy;
        if (approach <= 0 || (partly && !(clusters.seen_by[k] >> (i - clusters.first[cluster]) & 1)))
            continue;
        const double r = std::sqrt(r2);
        found(j, Vector(dx / r, dy / r), approach / r);
    }
}

struct View {
    Clusters clusters;
    const double *x, *y, *vx, *vy;
    double distance2;
    uint8_t *colliding;
};

// How many partners each particle has. Returns the sum.
GP_MULTIVERSION int64_t count_partners(const View &v, int64_t begin, int64_t end) {
    const double *__restrict x = v.x, *__restrict y = v.y, *__restrict vx = v.vx, *__restrict vy = v.vy;
    const Lanes one = Lanes{} + 1.0;
    int64_t sum = 0;
    for (int64_t c = begin; c < end; ++c) {
        const int64_t first = v.clusters.first[c], last = v.clusters.first[c + 1];
        const LanePlaces places(first, last);
        const Lanes xi = places.load(x), yi = places.load(y), ui = places.load(vx), vi = places.load(vy);
        const bool partly = v.clusters.is_partly_seen(c);
        Lanes partners{};
        for (int64_t k = v.clusters.start[c]; k < v.clusters.close_stop[c]; ++k) {
            const int32_t j = v.clusters.index[k];
            const Lanes dx = x[j] - xi, dy = y[j] - yi;
            const Lanes r2 = dx * dx + dy * dy;
            // Where they are in the same place they do not approach: one's self among them.
            const Lanes approach = (ui - vx[j]) * dx + (vi - vy[j]) * dy;
            const Lanes partner = where(approach > 0.0, where(r2 < v.distance2, one));
            partners += partly ? v.clusters.seen(partner, k) : partner;
        }
        for (int64_t i = first; i < last; ++i) {
            const auto found = static_cast<int64_t>(partners[i - first]);
            v.colliding[i] = static_cast<uint8_t>(found < 255 ? found : 255);
            sum += found;
        }
    }
    return sum;
}

} // namespace

void collide(World &world) {
    Particles &p = world.particles;
    const double distance = world.scene->config().collision_distance * world.constants.spacing;
    const double dt = world.clock.dt;
    update_images(world);
    const View view{Clusters(world), p.x.data(),           p.y.data(),
                    p.vx.data(),     p.vy.data(),          distance * distance,
                    world.colliding.data()};
    for_each_cluster_block(world, [&](int64_t block, int64_t begin, int64_t end) {
        world.sums[block].collisions = count_partners(view, begin, end);
        world.sums[block].collision_loss = 0;
    });
    int64_t colliding = 0;
    for (const BlockSums &block : world.sums)
        colliding += block.collisions;
    if (colliding == 0)
        return;

    world.images.copy(world.colliding);

    // sigma K^-1 has done its work: its first row holds the velocity changes.
    for_each_cluster_block(world, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t c = begin; c < end; ++c)
            for (int64_t i = world.clusters.first[c]; i < world.clusters.first[c + 1]; ++i) {
                if (world.colliding[i] == 0)
                    continue;
                Vector change = Vector::Zero();
                const double own = world.material_of(i).density;
                for_each_partner(world, c, i, distance, [&](int32_t j, const Vector &e, double approach) {
                    const double other = world.material_of(j).density;
                    const double partners = std::max(world.colliding[i], world.colliding[j]);
                    change -= e * (approach * other / ((own + other) * partners));
                });
                p.cxx[i] = change.x();
                p.cxy[i] = change.y();
            }
    });
    for_each_block(world.threads, p.count, [&](int64_t block, int64_t begin, int64_t end) {
        double loss = 0;
        for (int64_t i = begin; i < end; ++i) {
            if (world.colliding[i] == 0)
                continue;
            loss -= world.material_of(i).density * push_particle(p, i, p.cxx[i], p.cxy[i], dt);
        }
        world.sums[block].collision_loss = p.volume * loss;
    });
}

} // namespace gp::stages
