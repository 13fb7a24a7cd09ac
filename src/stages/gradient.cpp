// Shape tensor and velocity gradient of each particle; where it flows also the number density, and with density diffusion the
// sums of that, over the same pairs.
#include "lanes.hpp"
#include "operators.hpp"
#include "parallel.hpp"
#include "stages/fluidity_exchange.hpp"
#include "stages/rows.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

struct GradientView {
    Rows rows;
    Clusters clusters;
    const double *x, *y, *vx, *vy;
    const Facet *facets;
    const Plate *plates;
    Contact *contacts;
    const double *gx, *gy, *gvx, *gvy;
    const WallLanes *ghosts; // NULL: no plate is in reach
    double inverse_radius, lattice_moment;
    double *lxx, *lxy, *lyx, *lyy, *ixx, *ixy, *iyy;
    double *carried; // NULL: no plates
    const double *flowing;
    double *crowding;
    ExchangeView exchange;
};

struct LaneMoments {
    Lanes n{}, kxx{}, kxy{}, kyy{}, mxx{}, mxy{}, myx{}, myy{};

    template <bool Counted> GP_INLINE void add(const LanePair &pair, const Lanes &du, const Lanes &dv) {
        if (Counted)
            n += pair.weight;
        kxx += pair.wdx * pair.dx;
        kxy += pair.wdx * pair.dy;
        kyy += pair.wdy * pair.dy;
        mxx += du * pair.wdx;
        mxy += du * pair.wdy;
        myx += dv * pair.wdx;
        myy += dv * pair.wdy;
    }
    GP_INLINE Moments of(int lane) const {
        return {n[lane], kxx[lane], kxy[lane], kyy[lane], mxx[lane], mxy[lane], myx[lane], myy[lane]};
    }
};

template <bool Partly, bool Flows, class Exchange>
GP_INLINE void add_neighbors(const GradientView &v, int64_t cluster, const LanePlaces &places, LaneMoments &sum,
                             Exchange &exchange) {
    const double *__restrict x = v.x, *__restrict y = v.y, *__restrict vx = v.vx, *__restrict vy = v.vy;
    const Lanes xi = places.load(x), yi = places.load(y), ui = places.load(vx), vi = places.load(vy);
    const double inverse_radius = v.inverse_radius;
    LaneMoments m;
    Exchange local = exchange;
    int32_t j = v.clusters.first[cluster];
    for (int64_t k = v.clusters.start[cluster], stop = v.clusters.stop(cluster); k < stop; ++k) {
        j += v.clusters.step[k];
        const Lanes dx = x[j] - xi, dy = y[j] - yi;
        Lanes w = weight(dx * dx + dy * dy, inverse_radius);
        if (Partly)
            w = v.clusters.seen(w, k);
        const Lanes wx = w * dx, wy = w * dy;
        m.add<Flows>({w, dx, dy, wx, wy}, vx[j] - ui, vy[j] - vi);
        local.add(j, {w, dx, dy, wx, wy});
    }
    sum = m;
    exchange = local;
}

// Adds to `ghosts` what the particles of a cluster see of plates. (The ghosts of single particles by vectors took a fifth of the
// gradient's time in a scene of 640 particles.)
GP_INLINE void add_ghosts(const GradientView &v, int64_t cluster, const LanePlaces &places, Moments *ghosts) {
    const double *__restrict x = v.gx, *__restrict y = v.gy, *__restrict vx = v.gvx, *__restrict vy = v.gvy;
    const Lanes xi = places.load(v.x), yi = places.load(v.y), ui = places.load(v.vx), vi = places.load(v.vy);
    const double inverse_radius = v.inverse_radius;
    const LaneRows &rows = v.ghosts->ghosts_of_contacts;
    for (int64_t g = v.ghosts->of_cluster[cluster]; g < v.ghosts->of_cluster[cluster + 1]; ++g) {
        LaneMoments m;
        for (int64_t k = rows.start[g], end = rows.start[g + 1]; k < end; ++k) {
            const int32_t j = rows.index[k];
            const Lanes dx = x[j] - xi, dy = y[j] - yi;
            const Lanes w = seen_by_lanes(weight(dx * dx + dy * dy, inverse_radius), rows.seen_by[k]);
            m.add<true>({w, dx, dy, w * dx, w * dy}, vx[j] - ui, vy[j] - vi);
        }
        for (int l = 0; l < lane_count; ++l)
            if (const int32_t c = v.ghosts->contacts[g].contact[l]; c >= 0) {
                Moments own = m.of(l);
                const Facet &facet = v.facets[v.contacts[c].facet];
                drop_wall_shear(facet, v.plates[facet.plate].motion().omega, own);
                ghosts[l] += own;
            }
    }
}

GP_INLINE Tensor gradient_of(const Moments &m, const SymmetricTensor &g) {
    Tensor l;
    l << m.mxx * g.xx + m.mxy * g.xy, m.mxx * g.xy + m.mxy * g.yy, m.myx * g.xx + m.myy * g.xy,
        m.myx * g.xy + m.myy * g.yy;
    return l;
}

// m: of its neighbours; ghosts: of plates.
GP_INLINE void finish(const GradientView &v, int64_t i, Moments m, const Moments &ghosts) {
    const double carried = carried_share(m.kxx + m.kyy, v.lattice_moment);
    const Rows::Run run = v.rows.contacts_of(i);
    if (run.first != run.last) {
        v.contacts[run.first - v.rows.contacts].inner = gradient_of(m, inverse_shape(m, v.lattice_moment));
        m += ghosts;
    }
    SymmetricTensor g = inverse_shape(m, v.lattice_moment);
    g = {carried * g.xx, carried * g.xy, carried * g.yy};
    if (v.carried)
        v.carried[i] = carried;
    v.ixx[i] = g.xx;
    v.ixy[i] = g.xy;
    v.iyy[i] = g.yy;
    const Tensor l = gradient_of(m, g);
    v.lxx[i] = l(0, 0);
    v.lxy[i] = l(0, 1);
    v.lyx[i] = l(1, 0);
    v.lyy[i] = l(1, 1);
    v.crowding[i] = v.flowing[i] > 0 ? m.n - 1 : 0.0; // without itself
}

template <bool Flows, class Exchange> GP_INLINE void cluster_gradient(const GradientView &v, int64_t cluster) {
    const int64_t first = v.clusters.first[cluster], last = v.clusters.first[cluster + 1];
    const LanePlaces places(first, last);
    LaneMoments sum;
    Exchange exchange(v.exchange, places);
    if (v.clusters.is_partly_seen(cluster))
        add_neighbors<true, Flows>(v, cluster, places, sum, exchange);
    else
        add_neighbors<false, Flows>(v, cluster, places, sum, exchange);
    Moments ghosts[lane_count];
    if (v.ghosts)
        add_ghosts(v, cluster, places, ghosts);
    for (int64_t i = first; i < last; ++i) {
        finish(v, i, sum.of(static_cast<int>(i - first)), ghosts[i - first]);
        exchange.finish(v.exchange, i, static_cast<int>(i - first));
    }
}

template <class Exchange> void gradient_of_clusters(const GradientView &v, int64_t begin, int64_t end) {
    for (int64_t c = begin; c < end; ++c) {
        double flows = 0;
        for (int64_t i = v.clusters.first[c]; i < v.clusters.first[c + 1]; ++i)
            flows += v.flowing[i];
        if (flows > 0)
            cluster_gradient<true, Exchange>(v, c);
        else
            cluster_gradient<false, typename Idle<Exchange>::Sums>(v, c);
    }
}

using ClusterLoop = void (*)(const GradientView &, int64_t, int64_t);

ClusterLoop exchanging_loop(bool one_density, bool fluid) {
    if (fluid)
        return one_density ? gradient_of_clusters<AndFluidity<Exchange<true>>>
                           : gradient_of_clusters<AndFluidity<Exchange<false>>>;
    return one_density ? gradient_of_clusters<Exchange<true>> : gradient_of_clusters<Exchange<false>>;
}

GradientView view_of(World &world, const ExchangeView &exchange) {
    Particles &p = world.particles;
    Walls &w = world.walls;
    return {Rows(world),
            Clusters(world),
            p.x.data(),
            p.y.data(),
            p.vx.data(),
            p.vy.data(),
            w.facets.data(),
            w.plates.data(),
            w.contacts.data(),
            w.ghost_x.data(),
            w.ghost_y.data(),
            w.ghost_vx.data(),
            w.ghost_vy.data(),
            w.in_reach() ? &w.lanes : nullptr,
            1.0 / world.constants.horizon,
            world.constants.lattice.second_moment,
            p.lxx.data(),
            p.lxy.data(),
            p.lyx.data(),
            p.lyy.data(),
            p.gxx.data(),
            p.gxy.data(),
            p.gyy.data(),
            p.carried.empty() ? nullptr : p.carried.data(),
            p.flowing.data(),
            p.crowding.data(),
            exchange};
}

void run(World &world, const ExchangeView &exchange, ClusterLoop clusters) {
    Particles &p = world.particles;
    hand_over(p.cyx, p.crowding);
    if (!world.walls.plates.empty())
        hand_over(p.cyy, p.carried);
    const GradientView view = view_of(world, exchange);
    for_each_awake_cluster_run(world, [&](int64_t begin, int64_t end) { clusters(view, begin, end); });
    p.give_back_accelerations();
}

} // namespace

void gradient(World &world) {
    ExchangeView exchange{};
    if (world.constants.fluid)
        exchange.fluidity = prepare_fluidity(world);
    run(world, exchange,
        world.constants.fluid ? gradient_of_clusters<AndFluidity<NoExchange>> : gradient_of_clusters<NoExchange>);
}

void gradient_and_exchange(World &world) {
    ExchangeView exchange = prepare_exchange(world);
    if (world.constants.fluid)
        exchange.fluidity = prepare_fluidity(world);
    run(world, exchange, exchanging_loop(exchange.one_density, world.constants.fluid));
}

} // namespace gp::stages
