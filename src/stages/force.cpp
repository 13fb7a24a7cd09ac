#include "awake.hpp"
#include "lanes.hpp"
#include "operators.hpp"
#include "stages/crowding.hpp"
#include "stages/rows.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

struct ForceView {
    Clusters clusters;
    const double *x, *y, *vx, *vy, *stressed;
    const double *cxx, *cxy, *cyx, *cyy;
    double inverse_radius, penalty;
    double *fx, *fy; // N/m3
    CrowdingView crowding;
};

struct LaneForce {
    Lanes x, y;
    Lanes wx, wy; // sum w r
};

// sum_j w (A_i + A_j) r_ij, and with the penalty on the velocity that the gradient does not see, z_ij = u_j - u_i - L_i r_ij,
// also kappa/2 sum_j w (z_ij - z_ji), each particle's half only where it is stressed. Since sum_j w z_ij (x) r_ij = 0 for
// the neighbours that L_i is made of, the penalty's power is -kappa/2 sum w |z|^2: it never drives (after Silling 2017).
// C = A - kappa L / 2 carries both of a neighbour's tensors at once.
template <bool Penalty, bool Partly>
GP_INLINE void add_neighbors(const ForceView &v, int64_t cluster, const LanePlaces &places, LaneForce &force) {
    const double *__restrict x = v.x, *__restrict y = v.y, *__restrict vx = v.vx, *__restrict vy = v.vy;
    const double *__restrict cxx = v.cxx, *__restrict cxy = v.cxy, *__restrict cyx = v.cyx, *__restrict cyy = v.cyy;
    const double *__restrict stressed = v.stressed;
    const Lanes xi = places.load(x), yi = places.load(y);
    Lanes ui{}, vi{}, own{};
    if (Penalty) {
        ui = places.load(vx);
        vi = places.load(vy);
        own = places.load(stressed);
    }
    const double inverse_radius = v.inverse_radius;
    Lanes wx{}, wy{}, tx{}, ty{}, pu{}, pv{};
    int32_t j = v.clusters.first[cluster];
    for (int64_t k = v.clusters.start[cluster], stop = v.clusters.stop(cluster); k < stop; ++k) {
        j += v.clusters.step[k];
        const Lanes dx = x[j] - xi, dy = y[j] - yi;
        Lanes w = weight(dx * dx + dy * dy, inverse_radius);
        if (Partly)
            w = v.clusters.seen(w, k);
        const Lanes wdx = w * dx, wdy = w * dy;
        wx += wdx;
        wy += wdy;
        tx += cxx[j] * wdx + cxy[j] * wdy;
        ty += cyx[j] * wdx + cyy[j] * wdy;
        if (Penalty) {
            const Lanes share = w * (own + stressed[j]);
            pu += share * (vx[j] - ui);
            pv += share * (vy[j] - vi);
        }
    }
    force.wx = wx;
    force.wy = wy;
    force.x = places.load(cxx) * wx + places.load(cxy) * wy + tx;
    force.y = places.load(cyx) * wx + places.load(cyy) * wy + ty;
    if (Penalty) {
        force.x += 0.5 * v.penalty * pu;
        force.y += 0.5 * v.penalty * pv;
    }
}

// Sums over the ghosts that the particles of a group of contacts see.
struct LaneContacts {
    Lanes wx{}, wy{}, tx{}, ty{}, gxx{}, gxy{}, gyx{}, gyy{}; // w r, w A_g r, w (u_g - u_i) (x) r
    Lanes sxx{}, sxy{}, syy{};                                // w r (x) r
};

GP_INLINE LaneContacts sums_of_group(const World &world, int64_t group, const LanePlaces &places) {
    const Particles &p = world.particles;
    const Walls &walls = world.walls;
    const double *__restrict x = walls.ghost_x.data(), *__restrict y = walls.ghost_y.data();
    const double *__restrict vx = walls.ghost_vx.data(), *__restrict vy = walls.ghost_vy.data();
    const double *__restrict axx = walls.ghost_axx.data(), *__restrict axy = walls.ghost_axy.data();
    const double *__restrict ayy = walls.ghost_ayy.data();
    const Lanes xi = places.load(p.x.data()), yi = places.load(p.y.data());
    const Lanes ui = places.load(p.vx.data()), vi = places.load(p.vy.data());
    const double inverse_radius = 1.0 / world.constants.horizon;
    const LaneRows &rows = walls.lanes.ghosts_of_contacts;
    LaneContacts s;
    for (int64_t k = rows.start[group], end = rows.start[group + 1]; k < end; ++k) {
        const int32_t g = rows.index[k];
        const Lanes dx = x[g] - xi, dy = y[g] - yi;
        const Lanes w = seen_by_lanes(weight(dx * dx + dy * dy, inverse_radius), rows.seen_by[k]);
        const Lanes wdx = w * dx, wdy = w * dy;
        s.wx += wdx;
        s.wy += wdy;
        s.tx += axx[g] * wdx + axy[g] * wdy;
        s.ty += axy[g] * wdx + ayy[g] * wdy;
        const Lanes du = vx[g] - ui, dv = vy[g] - vi;
        s.gxx += du * wdx;
        s.gxy += du * wdy;
        s.gyx += dv * wdx;
        s.gyy += dv * wdy;
        s.sxx += wdx * dx;
        s.sxy += wdx * dy;
        s.syy += wdy * dy;
    }
    return s;
}

// The force density of one plate's ghosts on a particle, with A = sigma K^-1 as far as it acts through the plate's surface, and
// the ghosts' share of sigma : L, that is sum w (u_g - u_i) . A r with A as far as the gradient sees the ghosts.
GP_INLINE void finish_contact(World &world, Contact &contact, const LaneContacts &sums, int lane) {
    const Particles &p = world.particles;
    const double half = 0.5 * world.constants.penalty;
    const int64_t i = contact.particle;
    Tensor a;
    a << p.cxx[i], p.cxy[i], p.cyx[i], p.cyy[i];
    const double own_half = half > 0 ? half * p.stressed[i] : 0.0;
    a += own_half * inner_gradient(world, i); // C without the penalty's part
    // No shear traction through the surface: it is the stage wall_friction's, or the implicit solve's. Where the plate is
    // not rough, the gradient leaves out the same component.
    const Facet &facet = world.walls.facets[contact.facet];
    const Segment &s = facet.segment;
    const Tensor through = a - s.tangent.dot(a * s.normal) * s.tangent * s.normal.transpose();
    const bool rough = passes_shear(facet);
    const bool sticks = rough && by_number_density(world.constants.scheme);
    const Tensor &acts = sticks ? a : through, &seen = rough ? a : through;
    contact.force_x = acts(0, 0) * sums.wx[lane] + acts(0, 1) * sums.wy[lane] + sums.tx[lane];
    contact.force_y = acts(1, 0) * sums.wx[lane] + acts(1, 1) * sums.wy[lane] + sums.ty[lane];
    contact.ghost_power = seen(0, 0) * sums.gxx[lane] + seen(0, 1) * sums.gxy[lane] + seen(1, 0) * sums.gyx[lane] +
                          seen(1, 1) * sums.gyy[lane];
    // Their couple, which a turn works against: a particle's bonds bear none together, so those to particles leave the
    // opposite one in the material.
    const double xx = sums.sxx[lane], xy = sums.sxy[lane], yy = sums.syy[lane];
    contact.couple = a(1, 0) * xx + (a(1, 1) - a(0, 0)) * xy - a(0, 1) * yy;
    if (!rough) {
        const double omega = world.walls.plates[facet.plate].motion().omega;
        contact.ghost_power += s.tangent.dot(a * s.normal) * shear_of_turn(facet, omega, xx, xy, yy);
    }
    // A wall only pushes.
    const Vector &n = s.normal;
    const double pull = contact.force_x * n.x() + contact.force_y * n.y();
    if (pull < 0) {
        contact.force_x -= pull * n.x();
        contact.force_y -= pull * n.y();
    }
    contact.power = contact.force_x * p.vx[i] + contact.force_y * p.vy[i];
}

// The contacts of a cluster, and their part of sum w r.
struct GhostMoment {
    Lanes x{}, y{};
};

GhostMoment contacts_of_cluster(World &world, int64_t c) {
    const WallLanes &lanes = world.walls.lanes;
    const LanePlaces places(world.clusters.first[c], world.clusters.first[c + 1]);
    GhostMoment moment;
    for (int64_t g = lanes.of_cluster[c]; g < lanes.of_cluster[c + 1]; ++g) {
        const LaneContacts sums = sums_of_group(world, g, places);
        moment.x += sums.wx;
        moment.y += sums.wy;
        for (int l = 0; l < lane_count; ++l)
            if (const int32_t k = lanes.contacts[g].contact[l]; k >= 0)
                finish_contact(world, world.walls.contacts[k], sums, l);
    }
    return moment;
}

template <bool Penalty> void force_clusters(World &world, const ForceView &v, int64_t begin, int64_t end) {
    const bool in_reach = world.walls.in_reach();
    for (int64_t c = begin; c < end; ++c) {
        const int64_t first = v.clusters.first[c], last = v.clusters.first[c + 1];
        const LanePlaces places(first, last);
        LaneForce force;
        if (v.clusters.is_partly_seen(c))
            add_neighbors<Penalty, true>(v, c, places, force);
        else
            add_neighbors<Penalty, false>(v, c, places, force);
        if (in_reach && world.walls.lanes.of_cluster[c] < world.walls.lanes.of_cluster[c + 1]) {
            const GhostMoment ghosts = contacts_of_cluster(world, c);
            force.wx += ghosts.x;
            force.wy += ghosts.y;
        }
        if (v.crowding.crowded)
            v.crowding.finish(places, last, force.wx, force.wy);
        places.store(v.fx, last, force.x);
        places.store(v.fy, last, force.y);
    }
}

// find(begin, end): what else follows from the forces on some particles.
template <class Find> void find_forces(World &world, const Find &find) {
    Particles &p = world.particles;
    Walls &walls = world.walls;
    walls.clear_loads();
    const Constants &c = world.constants;
    const CrowdingView crowding(world);
    if (crowding.crowded) {
        hand_over(p.spaced, p.ax);
        hand_over(p.known, p.ay);
    }
    const ForceView view{Clusters(world),   p.x.data(),   p.y.data(),   p.vx.data(),  p.vy.data(),
                         p.stressed.data(), p.cxx.data(), p.cxy.data(), p.cyx.data(), p.cyy.data(),
                         1.0 / c.horizon,   c.penalty,    p.ax.data(),  p.ay.data(),  crowding};
    const bool in_reach = walls.in_reach();
    const auto clusters = c.penalty > 0 ? force_clusters<true> : force_clusters<false>;
    const auto find_pairs = [&](int64_t first, int64_t last) { clusters(world, view, first, last); };
    for_each_awake_block_by_halves(world, find_pairs, [&](int64_t block, int64_t begin, int64_t end) {
        double power = 0, acceleration2 = 0;
        for (int64_t i = begin; i < end; ++i) {
            double fx = p.ax[i], fy = p.ay[i];
            if (in_reach)
                for (int64_t k = walls.contact_start[i]; k < walls.contact_start[i + 1]; ++k) {
                    fx += walls.contacts[k].force_x;
                    fy += walls.contacts[k].force_y;
                }
            power += p.vx[i] * fx + p.vy[i] * fy;
            const double inverse_density = 1.0 / world.material_of(i).density;
            p.ax[i] = fx * inverse_density + c.gravity.x();
            p.ay[i] = fy * inverse_density + c.gravity.y();
            acceleration2 += p.ax[i] * p.ax[i] + p.ay[i] * p.ay[i];
        }
        world.sums[block].total_power = p.volume * power;
        world.sums[block].acceleration2 = acceleration2;
        find(begin, end);
    });
}

} // namespace

void force(World &world) {
    find_forces(world, [](int64_t, int64_t) {});
}

void force_and_friction(World &world) {
    find_forces(world, [&](int64_t begin, int64_t end) { find_friction(world, begin, end); });
}

} // namespace gp::stages
