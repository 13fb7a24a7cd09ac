// The collision safeguard (Jin et al. 2021, 2.9 and 2.10): approaching pairs that are closer than the collision distance
// lose the velocity of their approach, each taking the share of the other's mass. Where a particle collides with several
// at once, each pair's impulse is divided by the larger number of partners of the two: momentum is kept exactly and the
// energy cannot grow.
#include <algorithm>
#include <cmath>

#include "awake.hpp"
#include "lanes.hpp"
#include "stages/push.hpp"
#include "stages/rows.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

constexpr double immovable = 1e100; // kg/m3

struct View {
    Clusters clusters;
    const double *x, *y, *vx, *vy;
    double distance2;
    const Constants *constants;
    const int32_t *column;
    const uint8_t *asleep; // NULL where nothing sleeps
    uint8_t *colliding;
    double *du, *dv; // velocity changes

    GP_INLINE double density(int64_t i) const {
        return constants->materials[constants->body_material[column[i]]].density;
    }
    // What sleeps does not give way: it is as heavy as a wall.
    GP_INLINE double partner_density(int64_t j) const { return asleep && asleep[j] ? immovable : density(j); }
};

// How many partners each particle has. Returns the sum.
int64_t count_partners(const View &v, int64_t begin, int64_t end) {
    const double *__restrict x = v.x, *__restrict y = v.y, *__restrict vx = v.vx, *__restrict vy = v.vy;
    const Lanes one = Lanes{} + 1.0;
    int64_t sum = 0;
    for (int64_t c = begin; c < end; ++c) {
        const int64_t first = v.clusters.first[c], last = v.clusters.first[c + 1];
        const LanePlaces places(first, last);
        const Lanes xi = places.load(x), yi = places.load(y), ui = places.load(vx), vi = places.load(vy);
        const bool partly = v.clusters.is_partly_seen(c);
        Lanes partners{};
        int32_t j = v.clusters.first[c];
        for (int64_t k = v.clusters.start[c], stop = v.clusters.stop(c); k < stop; ++k) {
            j += v.clusters.step[k];
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

// The velocity changes of the particles that have partners.
void find_pushes(const View &v, int64_t begin, int64_t end) {
    const double *__restrict x = v.x, *__restrict y = v.y, *__restrict vx = v.vx, *__restrict vy = v.vy;
    for (int64_t c = begin; c < end; ++c) {
        const int64_t first = v.clusters.first[c], last = v.clusters.first[c + 1];
        int any = 0;
        for (int64_t i = first; i < last; ++i)
            any |= v.colliding[i];
        if (!any)
            continue;
        const LanePlaces places(first, last);
        const Lanes xi = places.load(x), yi = places.load(y), ui = places.load(vx), vi = places.load(vy);
        Lanes own{}, partners{};
        for (int l = 0; l < lane_count; ++l) {
            own[l] = v.density(places.at[l]);
            partners[l] = v.colliding[places.at[l]];
        }
        const bool partly = v.clusters.is_partly_seen(c);
        Lanes du{}, dv{};
        int32_t j = v.clusters.first[c];
        for (int64_t k = v.clusters.start[c], stop = v.clusters.stop(c); k < stop; ++k) {
            j += v.clusters.step[k];
            if (v.colliding[j] == 0)
                continue;
            const Lanes dx = x[j] - xi, dy = y[j] - yi;
            const Lanes r2 = dx * dx + dy * dy;
            const Lanes approach = (ui - vx[j]) * dx + (vi - vy[j]) * dy;
            const double other = v.partner_density(j), others = v.colliding[j];
            const Lanes most = choose(partners > others, partners, Lanes{} + others);
            // Approach over r^2: of the speed u = approach / r, along e = (dx, dy) / r.
            Lanes impulse =
                where(approach > 0.0, where(r2 < v.distance2, approach * other / ((own + other) * most * r2)));
            if (partly)
                impulse = v.clusters.seen(impulse, k);
            du -= impulse * dx;
            dv -= impulse * dy;
        }
        places.store(v.du, last, du);
        places.store(v.dv, last, dv);
    }
}

} // namespace

void collide(World &world) {
    Particles &p = world.particles;
    const double distance = world.scene->config().collision_distance * world.constants.spacing;
    const double dt = world.clock.dt;
    update_images(world);
    // sigma K^-1 has done its work: its first row holds the velocity changes.
    const View view{Clusters(world.clusters, world.clusters.close),
                    p.x.data(),
                    p.y.data(),
                    p.vx.data(),
                    p.vy.data(),
                    distance * distance,
                    &world.constants,
                    p.column.data(),
                    world.sleep.some ? p.asleep.data() : nullptr,
                    world.colliding.data(),
                    p.cxx.data(),
                    p.cxy.data()};
    for_each_seen_cluster_block(world, [&](int64_t block, int64_t begin, int64_t end) {
        world.sums[block].collisions = count_partners(view, begin, end);
        world.sums[block].collision_loss = 0;
    });
    int64_t colliding = 0;
    for (const BlockSums &block : world.sums)
        colliding += block.collisions;
    if (colliding == 0 && !world.crossing) // where there are others, they may have some, and wait
        return;

    world.images.copy(world.colliding);

    for_each_awake_cluster_block(world, [&](int64_t, int64_t begin, int64_t end) { find_pushes(view, begin, end); });
    for_each_awake_block(world, [&](int64_t block, int64_t begin, int64_t end) {
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
