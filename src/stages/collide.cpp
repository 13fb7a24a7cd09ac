// The collision safeguard (Jin et al. 2021, 2.9 and 2.10): approaching pairs that are closer than the collision distance
// lose the velocity of their approach, each taking the share of the other's mass. Where a particle collides with several
// at once, each pair's impulse is divided by the larger number of partners of the two: momentum is kept exactly and the
// energy cannot grow.
#include <algorithm>
#include <cmath>

#include "parallel.hpp"
#include "stages/push.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

// Calls found(j, e, u) for the colliding partners of i: e the unit vector to j, u the speed of approach.
template <class Found> void for_each_partner(const World &world, int64_t i, double distance, const Found &found) {
    const Particles &p = world.particles;
    const int64_t first = world.neighbors.start[i];
    for (int64_t k = first; k < first + world.neighbors.close_count[i]; ++k) {
        const int32_t j = world.neighbors.index[k];
        const double dx = p.x[j] - p.x[i], dy = p.y[j] - p.y[i];
        const double r2 = dx * dx + dy * dy;
        if (r2 >= distance * distance || r2 == 0)
            continue;
        const double approach = (p.vx[i] - p.vx[j]) * dx + (p.vy[i] - p.vy[j]) * dy;
        if (approach <= 0)
            continue;
        const double r = std::sqrt(r2);
        found(j, Vector(dx / r, dy / r), approach / r);
    }
}

} // namespace

void collide(World &world) {
    Particles &p = world.particles;
    const double distance = world.scene->config().collision_distance * world.constants.spacing;
    const double dt = world.clock.dt;
    update_images(world);
    for_each_block(world.threads, p.count, [&](int64_t block, int64_t begin, int64_t end) {
        int64_t colliding = 0;
        for (int64_t i = begin; i < end; ++i) {
            int partners = 0;
            for_each_partner(world, i, distance, [&](int32_t, const Vector &, double) { ++partners; });
            world.colliding[i] = static_cast<uint8_t>(std::min(partners, 255));
            colliding += partners;
        }
        world.sums[block].collisions = colliding;
        world.sums[block].collision_loss = 0;
    });
    int64_t colliding = 0;
    for (const BlockSums &block : world.sums)
        colliding += block.collisions;
    if (colliding == 0)
        return;

    world.images.copy(world.colliding);

    // sigma K^-1 has done its work: its first row holds the velocity changes.
    for_each_block(world.threads, p.count, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) {
            Vector change = Vector::Zero();
            const double own = world.material_of(i).density;
            for_each_partner(world, i, distance, [&](int32_t j, const Vector &e, double approach) {
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
