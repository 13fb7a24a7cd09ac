// The collision safeguard (Jin et al. 2021, 2.9 and 2.10): approaching pairs that are closer than the collision distance
// lose the velocity of their approach, each taking the share of the other's mass. Where a particle collides with several
// at once, each pair's impulse is divided by the larger number of partners of the two: momentum is kept exactly and the
// energy cannot grow.
//
// What does not flow has no collisions: its stress keeps its particles apart. With them a pair at rest lost each approach but not
// each parting, and a heap crept by what trembled in it: in 3 s, from 3 s on, by .035 dl in the middle of 24 collapses of a = 1.25
// and L/dl = 16, at 3e-12 J/m for as long as it was looked at. So it creeps by .001 dl, what is at yield, and dies away to
// 1e-30 J/m. Where one particle flows and one does not they do not collide either: what falls on a heap is borne by its stress.
// By number density, where nothing says what flows, pairs collide everywhere.
//
// Where what flows is more crowded than its density knows, it has to come apart, not only to come no closer: there the part of
// the approach that the mean flow explains, -r.L.r of the two gradients' mean, stays in the velocities, and the positions make up
// for it: the pair moves apart as fast as that brings it together, about its centre of mass. Nothing else sees these moves -
// continuity integrates the gradient of the velocities - so it is done by the share of the crowding that has come up, and stops
// when there is room. What rests does not move, nor what is pressed together and dense for it.
//
// It keeps the volume of rows at free surfaces, which the tie of density and spacing does not see. Of a drum of 12 spacings in
// radius, at a Froude number of 1e-4, the area under the surface over that of its particles, mean of .4 to .75 turns, is .902
// without, and by full_crowding .05 1.002, .1 .983, .2 .967; by the whole moves everywhere 1.15. Collapses, inclined and sheared
// layers do as without within their scatter. (All that the mean flow explains left to the velocities, crowded or not, lets
// collapses at L/dl = 16 run 2 % and their fronts 5 % farther, but inclined layers sink by 1.5 % and pairs without stress overlap.)
#include <algorithm>

#include "awake.hpp"
#include "lanes.hpp"
#include "stages/crowding.hpp"
#include "stages/push.hpp"
#include "stages/rows.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

// Of the lattice's number density: from here on all that is explained is moved.
constexpr double full_crowding = 0.1;

struct CollisionView {
    Clusters clusters;
    const double *x, *y, *vx, *vy;
    double distance2;
    const Constants *constants;
    const int32_t *column;
    const double *asleep; // NULL where nothing sleeps
    uint8_t *colliding;
    double *du, *dv; // velocity changes
    const double *pressure, *lxx, *lxy, *lyx, *lyy;
    const float *crowded; // NULL: pairs are braked only, wherever they are
    double *su, *sv;      // m/s, of moves without a velocity

    GP_INLINE double density(int64_t i) const {
        return constants->materials[constants->body_material[column[i]]].density;
    }
    // What sleeps rests, whatever it did in its last step.
    GP_INLINE bool flows(int64_t i) const {
        return !(asleep && asleep[i] != 0) && (!crowded || crowded[i] != does_not_flow);
    }
    GP_INLINE bool any_flows(int64_t first, int64_t last) const {
        bool any = false;
        for (int64_t i = first; i < last; ++i)
            any |= flows(i);
        return any;
    }
};

// How many partners each particle has that flows: those that do not are counted with the others, and do not collide. Returns the
// sum.
int64_t count_partners(const CollisionView &v, int64_t begin, int64_t end) {
    const double *__restrict x = v.x, *__restrict y = v.y, *__restrict vx = v.vx, *__restrict vy = v.vy;
    const Lanes one = Lanes{} + 1.0;
    int64_t sum = 0;
    for (int64_t c = begin; c < end; ++c) {
        const int64_t first = v.clusters.first[c], last = v.clusters.first[c + 1];
        if (!v.any_flows(first, last)) {
            std::fill(v.colliding + first, v.colliding + last, static_cast<uint8_t>(0));
            continue;
        }
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
            const auto found = v.flows(i) ? static_cast<int64_t>(partners[i - first]) : 0;
            v.colliding[i] = static_cast<uint8_t>(found < 255 ? found : 255);
            sum += found;
        }
    }
    return sum;
}

// The entries of a cluster's row that have partners, some at a time: told apart without branches, which no processor foresees.
struct PartnersOfRow {
    static constexpr int64_t some = 32;
    int64_t k, stop;
    int32_t j;
    int count;
    int64_t entry[some];
    int32_t particle[some];

    GP_INLINE PartnersOfRow(const CollisionView &v, int64_t c)
        : k(v.clusters.start[c]), stop(v.clusters.stop(c)), j(v.clusters.first[c]) {}
    // False at the row's end.
    GP_INLINE bool find_some(const CollisionView &v) {
        if (k == stop)
            return false;
        count = 0;
        for (const int64_t end = std::min(stop, k + some); k < end; ++k) {
            j += v.clusters.step[k];
            entry[count] = k;
            particle[count] = j;
            count += v.colliding[j] != 0;
        }
        return true;
    }
};

// The velocity changes, and moves, of the particles that have partners.
template <bool Moves> void find_pushes(const CollisionView &v, int64_t begin, int64_t end) {
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
        Lanes du{}, dv{}, su{}, sv{};
        Lanes pi{}, lxx{}, lyy{}, shear{}, crowded{};
        double most_crowded = -1e300;
        if (Moves) {
            pi = places.load(v.pressure);
            lxx = places.load(v.lxx);
            lyy = places.load(v.lyy);
            shear = places.load(v.lxy) + places.load(v.lyx);
            for (int l = 0; l < lane_count; ++l) {
                crowded[l] = v.crowded[places.at[l]];
                most_crowded = std::max(most_crowded, crowded[l]);
            }
        }
        PartnersOfRow row(v, c);
        while (row.find_some(v))
            for (int e = 0; e < row.count; ++e) {
                const int64_t k = row.entry[e];
                const int32_t j = row.particle[e];
                const Lanes dx = x[j] - xi, dy = y[j] - yi;
                const Lanes r2 = dx * dx + dy * dy;
                const Lanes approach = (ui - vx[j]) * dx + (vi - vy[j]) * dy;
                const double other = v.density(j), others = v.colliding[j];
                const Lanes most = choose(partners > others, partners, Lanes{} + others);
                const auto collides = (approach > 0.0) & (r2 < v.distance2) & (partners > 0.0);
                // Approach over r^2: of the speed u = approach / r, along e = (dx, dy) / r.
                Lanes share = where(collides, other / ((own + other) * r2));
                if (partly)
                    share = v.clusters.seen(share, k);
                Lanes random = approach;
                if (Moves && v.crowded[j] + most_crowded > 0 && v.pressure[j] > 0) {
                    const Lanes mean = -0.5 * ((lxx + v.lxx[j]) * dx * dx + (shear + (v.lxy[j] + v.lyx[j])) * dx * dy +
                                               (lyy + v.lyy[j]) * dy * dy);
                    const Lanes excess = (0.5 / full_crowding) * (crowded + v.crowded[j]), one = Lanes{} + 1.0;
                    const Lanes explained =
                        where((mean > 0.0) & (pi > 0.0) & (excess > 0.0),
                              choose(mean < approach, mean, approach) * choose(excess < one, excess, one));
                    const Lanes moves = share * explained;
                    su -= moves * dx;
                    sv -= moves * dy;
                    random -= explained;
                }
                const Lanes impulse = share * random / most;
                du -= impulse * dx;
                dv -= impulse * dy;
            }
        places.store(v.du, last, du);
        places.store(v.dv, last, dv);
        if (Moves) {
            places.store(v.su, last, su);
            places.store(v.sv, last, sv);
        }
    }
}

} // namespace

void collide(World &world) {
    Particles &p = world.particles;
    const double distance = world.scene->config().collision_distance * world.constants.spacing;
    const double dt = world.clock.dt;
    update_images(world);
    // sigma K^-1 has done its work: its first row holds the velocity changes, its second one the moves.
    const bool moves = !world.crowded.empty();
    const CollisionView view{Clusters(world.clusters, world.clusters.close),
                             p.x.data(),
                             p.y.data(),
                             p.vx.data(),
                             p.vy.data(),
                             distance * distance,
                             &world.constants,
                             p.column.data(),
                             world.sleep.some ? p.repose.asleep.data() : nullptr,
                             world.colliding.data(),
                             p.cxx.data(),
                             p.cxy.data(),
                             p.pressure.data(),
                             p.lxx.data(),
                             p.lxy.data(),
                             p.lyx.data(),
                             p.lyy.data(),
                             moves ? world.crowded.data() : nullptr,
                             p.cyx.data(),
                             p.cyy.data()};
    for_each_seen_cluster_block(world, [&](int64_t block, int64_t begin, int64_t end) {
        world.sums[block].collisions = count_partners(view, begin, end);
        world.sums[block].collision_loss = 0;
    });
    int64_t colliding = 0;
    for (const BlockSums &block : world.sums)
        colliding += block.collisions;
    if (colliding == 0 && !world.crossing) // where there are others, they may have some, and wait
        return;

    // The pressure is that of the stress, which they have.
    if (moves)
        world.images.copy_collisions({&p.lxx, &p.lxy, &p.lyx, &p.lyy}, world.colliding, world.crowded);
    else
        world.images.copy(world.colliding);

    for_each_awake_cluster_run(world, [&](int64_t begin, int64_t end) {
        moves ? find_pushes<true>(view, begin, end) : find_pushes<false>(view, begin, end);
    });
    for_each_awake_block(world, [&](int64_t block, int64_t begin, int64_t end) {
        double loss = 0;
        for (int64_t i = begin; i < end; ++i) {
            if (world.colliding[i] == 0)
                continue;
            if (moves) {
                p.x[i] += dt * p.cyx[i];
                p.y[i] += dt * p.cyy[i];
            }
            loss -= world.material_of(i).density * push_particle(p, i, p.cxx[i], p.cxy[i], dt);
        }
        world.sums[block].collision_loss = p.volume * loss;
    });
}

} // namespace gp::stages
