#include "stages/viscous_operators.hpp"

#include "operators.hpp"
#include "parallel.hpp"
#include "stages/rows.hpp"

namespace gp::stages {

namespace {

struct OperatorView {
    Rows rows;
    const Facet *facets;
    const double *qx, *qy, *w;                   // w r and w of pairs
    const double *ghost_qx, *ghost_qy, *ghost_w; // of contacts
    const double *gxx, *gxy, *gyy;               // K^-1
    const double *beside;
    const double *ixx, *ixy, *iyy; // of the particles alone

    explicit OperatorView(const World &world)
        : rows(world), facets(world.walls.facets.data()), qx(world.viscous.pair.x.data()),
          qy(world.viscous.pair.y.data()), w(world.viscous.pair_weight.data()),
          ghost_qx(world.viscous.contact_pair.x.data()), ghost_qy(world.viscous.contact_pair.y.data()),
          ghost_w(world.viscous.contact_weight.data()), gxx(world.particles.gxx.data()),
          gxy(world.particles.gxy.data()), gyy(world.particles.gyy.data()), beside(world.viscous.beside.data()),
          ixx(world.viscous.inner_xx.data()), ixy(world.viscous.inner_xy.data()), iyy(world.viscous.inner_yy.data()) {}
};

// (t (x) t + normal n (x) n) a
GP_INLINE Vector scaled(const Walls &w, int64_t ghost, double normal, const Vector &a) {
    const Vector n(w.ghost_nx[ghost], w.ghost_ny[ghost]);
    return a + (normal - 1) * n.dot(a) * n;
}

void find_ghost_velocities(World &world, const VectorField &u, Plates plates) {
    const Walls &w = world.walls;
    const NeighborList &mirrors = world.mirrors.of_ghost;
    ViscousSystem &v = world.viscous;
    for_each_block<ghost_block_size>(world.threads, w.ghost_count, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t g = begin; g < end; ++g) {
            Vector mean = Vector::Zero();
            for (int64_t k = mirrors.start[g]; k < mirrors.start[g + 1]; ++k) {
                const int32_t i = mirrors.index[k];
                mean += v.mirror_share[k] * Vector(u.x[i], u.y[i]);
            }
            Vector own = Vector::Zero(), mirrored = Vector::Zero(); // of the plate, here and at the mirror point
            if (plates == Plates::move) {
                const Vector at(w.ghost_x[g], w.ghost_y[g]), n(w.ghost_nx[g], w.ghost_ny[g]);
                own = w.velocity_at(w.ghost_facet[g], at);
                mirrored = w.velocity_at(w.ghost_facet[g], at + 2 * w.ghost_distance[g] * n);
            }
            const Vector ghost = own + scaled(w, g, v.ghost_normal[g], mean - mirrored);
            v.ghost_velocity.x[g] = ghost.x();
            v.ghost_velocity.y[g] = ghost.y();
        }
    });
}

struct Gradients {
    double *xx, *xy, *yx, *yy;                         // L
    double *inner_xx, *inner_xy, *inner_yx, *inner_yy; // that of the particles alone
};

void rate_rows(const OperatorView &v, const double *__restrict ux, const double *__restrict uy, const double *gx,
               const double *gy, const Gradients &l, int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i) {
        const double ui = ux[i], vi = uy[i];
        double mxx = 0, mxy = 0, myx = 0, myy = 0;
#pragma omp simd reduction(+ : mxx, mxy, myx, myy)
        for (int64_t k = v.rows.start[i]; k < v.rows.start[i + 1]; ++k) {
            const int32_t j = v.rows.index[k];
            const double du = ux[j] - ui, dv = uy[j] - vi;
            mxx += du * v.qx[k];
            mxy += du * v.qy[k];
            myx += dv * v.qx[k];
            myy += dv * v.qy[k];
        }
        l.inner_xx[i] = mxx * v.ixx[i] + mxy * v.ixy[i];
        l.inner_xy[i] = mxx * v.ixy[i] + mxy * v.iyy[i];
        l.inner_yx[i] = myx * v.ixx[i] + myy * v.ixy[i];
        l.inner_yy[i] = myx * v.ixy[i] + myy * v.iyy[i];
        for (const Contact &contact : v.rows.contacts_of(i)) {
            double xx = 0, xy = 0, yx = 0, yy = 0;
#pragma omp simd reduction(+ : xx, xy, yx, yy)
            for (int64_t k = contact.begin; k < contact.end; ++k) {
                const int32_t g = v.rows.ghost_index[k];
                const double du = gx[g] - ui, dv = gy[g] - vi;
                xx += du * v.ghost_qx[k];
                xy += du * v.ghost_qy[k];
                yx += dv * v.ghost_qx[k];
                yy += dv * v.ghost_qy[k];
            }
            drop_shear(v.facets[contact.listed_facet], xx, xy, yx, yy);
            mxx += xx;
            mxy += xy;
            myx += yx;
            myy += yy;
        }
        l.xx[i] = mxx * v.gxx[i] + mxy * v.gxy[i];
        l.xy[i] = mxx * v.gxy[i] + mxy * v.gyy[i];
        l.yx[i] = myx * v.gxx[i] + myy * v.gxy[i];
        l.yy[i] = myx * v.gxy[i] + myy * v.gyy[i];
        if (v.beside[i] > 0) {
            const Vector &n = v.facets[v.rows.contacts_of(i).first->listed_facet].segment.normal;
            const double x = n.x() * (l.xx[i] - l.inner_xx[i]) + n.y() * (l.yx[i] - l.inner_yx[i]);
            const double y = n.x() * (l.xy[i] - l.inner_xy[i]) + n.y() * (l.yy[i] - l.inner_yy[i]);
            l.inner_xx[i] += n.x() * x;
            l.inner_xy[i] += n.x() * y;
            l.inner_yx[i] += n.y() * x;
            l.inner_yy[i] += n.y() * y;
        }
    }
}

// What particle i's stress and hidden motion exert through the plate on its ghosts, of ways w r and per w: C w r + c w (u_g - u_i),
// along the normal what the hidden motion adds.
struct ThroughPlate {
    double xx, xy, yx, yy;
    Vector normal;
    double stiffness, away; // c, n . u_i

    GP_INLINE ThroughPlate(const World &world, const VectorField &u, int64_t i, const Facet &facet)
        : normal(facet.segment.normal) {
        const Particles &p = world.particles;
        const ViscousSystem &v = world.viscous;
        const double c = v.stiffness[i];
        xx = p.cxx[i] + c * v.lxx[i];
        xy = p.cxy[i] + c * v.lxy[i];
        yx = p.cyx[i] + c * v.lyx[i];
        yy = p.cyy[i] + c * v.lyy[i];
        drop_shear(facet, xx, xy, yx, yy);
        stiffness = c * v.beside[i];
        const Vector &n = normal;
        const double x = stiffness * (n.x() * v.lxx[i] + n.y() * v.lyx[i]);
        const double y = stiffness * (n.x() * v.lxy[i] + n.y() * v.lyy[i]);
        xx -= n.x() * x;
        xy -= n.x() * y;
        yx -= n.y() * x;
        yy -= n.y() * y;
        away = n.x() * u.x[i] + n.y() * u.y[i];
    }
    GP_INLINE Vector force(const ViscousSystem &v, int64_t g, double qx, double qy, double w) const {
        const double apart =
            stiffness * w * (normal.x() * v.ghost_velocity.x[g] + normal.y() * v.ghost_velocity.y[g] - away);
        return {xx * qx + xy * qy + apart * normal.x(), yx * qx + yy * qy + apart * normal.y()};
    }
};

// Force on each ghost: the opposite of what it exerts on the particles that see it.
void find_ghost_forces(World &world, const VectorField &u) {
    const Walls &w = world.walls;
    ViscousSystem &v = world.viscous;
    for_each_block<ghost_block_size>(world.threads, w.ghost_count, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t g = begin; g < end; ++g) {
            Vector force = Vector::Zero();
            for (int64_t k = w.particles_of_ghost.start[g]; k < w.particles_of_ghost.start[g + 1]; ++k) {
                const Facet &facet = w.facets[world.mirrors.facet_of_entry[k]];
                const ThroughPlate through(world, u, w.particles_of_ghost.index[k], facet);
                force -= through.force(v, g, v.seen_pair.x[k], v.seen_pair.y[k], v.seen_weight[k]);
            }
            v.ghost_force.x[g] = force.x();
            v.ghost_force.y[g] = force.y();
        }
    });
}

GP_INLINE Vector force_of_contact(const OperatorView &v, const World &world, const VectorField &u,
                                  const Contact &contact) {
    const ViscousSystem &s = world.viscous;
    const ThroughPlate through(world, u, contact.particle, v.facets[contact.listed_facet]);
    Vector force = Vector::Zero();
    for (int64_t k = contact.begin; k < contact.end; ++k)
        force += through.force(s, v.rows.ghost_index[k], v.ghost_qx[k], v.ghost_qy[k], v.ghost_w[k]);
    const Mirrors &mirrors = world.mirrors;
    const int64_t c = &contact - world.walls.contacts.data();
    for (int64_t k = mirrors.contact_start[c]; k < mirrors.contact_start[c + 1]; ++k) {
        const int32_t g = mirrors.ghost[k];
        force += s.mirror_share[mirrors.place[k]] *
                 scaled(world.walls, g, s.ghost_normal[g], Vector(s.ghost_force.x[g], s.ghost_force.y[g]));
    }
    return force;
}

struct Sources {
    const double *cxx, *cxy, *cyx, *cyy, *stiffness, *ux, *uy;
};

void force_rows(const OperatorView &v, const World &world, const VectorField &u, const Sources &sources, double *fx,
                double *fy, int64_t begin, int64_t end) {
    const double *__restrict cxx = sources.cxx, *__restrict cxy = sources.cxy, *__restrict cyx = sources.cyx,
                             *__restrict cyy = sources.cyy;
    const double *__restrict stiffness = sources.stiffness, *__restrict ux = sources.ux, *__restrict uy = sources.uy;
    for (int64_t i = begin; i < end; ++i) {
        double qx = 0, qy = 0, tx = 0, ty = 0;
        const double own = stiffness[i], ui = ux[i], vi = uy[i];
#pragma omp simd reduction(+ : qx, qy, tx, ty)
        for (int64_t k = v.rows.start[i]; k < v.rows.start[i + 1]; ++k) {
            const int32_t j = v.rows.index[k];
            const double share = v.w[k] * (own + stiffness[j]);
            qx += v.qx[k];
            qy += v.qy[k];
            tx += cxx[j] * v.qx[k] + cxy[j] * v.qy[k] + share * (ux[j] - ui);
            ty += cyx[j] * v.qx[k] + cyy[j] * v.qy[k] + share * (uy[j] - vi);
        }
        double sx = cxx[i] * qx + cxy[i] * qy + tx, sy = cyx[i] * qx + cyy[i] * qy + ty;
        for (const Contact &contact : v.rows.contacts_of(i)) {
            const Vector force = force_of_contact(v, world, u, contact);
            sx += force.x();
            sy += force.y();
        }
        fx[i] = sx;
        fy[i] = sy;
    }
}

void diagonal_rows(const OperatorView &v, const double *__restrict kxx, const double *__restrict kxy,
                   const double *__restrict kyy, const double *__restrict stiffness, double *diagonal, int64_t begin,
                   int64_t end) {
    for (int64_t i = begin; i < end; ++i) {
        double qx = 0, qy = 0, sum = 0;
#pragma omp simd reduction(+ : qx, qy, sum)
        for (int64_t k = v.rows.start[i]; k < v.rows.start[i + 1]; ++k) {
            const int32_t j = v.rows.index[k];
            const double x = v.qx[k], y = v.qy[k];
            qx += x;
            qy += y;
            sum += v.w[k] * (stiffness[i] + stiffness[j]) + kxx[j] * x * x + 2.0 * kxy[j] * x * y + kyy[j] * y * y;
        }
        for (const Contact &contact : v.rows.contacts_of(i))
            for (int64_t k = contact.begin; k < contact.end; ++k) {
                qx += v.ghost_qx[k];
                qy += v.ghost_qy[k];
            }
        diagonal[i] = sum + kxx[i] * qx * qx + 2.0 * kxy[i] * qx * qy + kyy[i] * qy * qy;
    }
}

} // namespace

void viscous_rates(World &world, VectorField &u, Plates plates, VectorField &e) {
    ViscousSystem &v = world.viscous;
    world.images.copy({&u.x, &u.y});
    if (world.walls.in_reach())
        find_ghost_velocities(world, u, plates);
    const OperatorView view(world);
    const Gradients gradients{v.full_xx.data(), v.full_xy.data(), v.full_yx.data(), v.full_yy.data(),
                              v.lxx.data(),     v.lxy.data(),     v.lyx.data(),     v.lyy.data()};
    for_each_block(world.threads, world.particles.count, [&](int64_t, int64_t begin, int64_t end) {
        rate_rows(view, u.x.data(), u.y.data(), v.ghost_velocity.x.data(), v.ghost_velocity.y.data(), gradients, begin,
                  end);
        for (int64_t i = begin; i < end; ++i) {
            e.x[i] = 0.5 * (gradients.xx[i] - gradients.yy[i]);
            e.y[i] = 0.5 * (gradients.xy[i] + gradients.yx[i]);
        }
    });
}

void viscous_forces(World &world, const VectorField &s, const VectorField &u, VectorField &f) {
    Particles &p = world.particles;
    ViscousSystem &v = world.viscous;
    for_each_block(world.threads, p.count, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) {
            const double c = v.stiffness[i];
            p.cxx[i] = s.x[i] * p.gxx[i] + s.y[i] * p.gxy[i] - c * v.lxx[i];
            p.cxy[i] = s.x[i] * p.gxy[i] + s.y[i] * p.gyy[i] - c * v.lxy[i];
            p.cyx[i] = s.y[i] * p.gxx[i] - s.x[i] * p.gxy[i] - c * v.lyx[i];
            p.cyy[i] = s.y[i] * p.gxy[i] - s.x[i] * p.gyy[i] - c * v.lyy[i];
        }
    });
    world.images.copy({&p.cxx, &p.cxy, &p.cyx, &p.cyy, &v.lxx, &v.lxy, &v.lyx, &v.lyy});
    if (world.walls.in_reach())
        find_ghost_forces(world, u);
    const OperatorView view(world);
    const Sources sources{p.cxx.data(),       p.cxy.data(), p.cyx.data(), p.cyy.data(),
                          v.stiffness.data(), u.x.data(),   u.y.data()};
    for_each_block(world.threads, p.count, [&](int64_t, int64_t begin, int64_t end) {
        force_rows(view, world, u, sources, f.x.data(), f.y.data(), begin, end);
    });
}

Vector viscous_contact_force(const World &world, const VectorField &u, const Contact &contact) {
    return force_of_contact(OperatorView(world), world, u, contact);
}

// With eta in place of H the block of particle i is eta/2 |K^-1 q|^2 for each row of rates that q stands in.
void viscous_diagonal(World &world, const Field<double> &eta, Field<double> &diagonal) {
    Particles &p = world.particles;
    ViscousSystem &v = world.viscous;
    for_each_block(world.threads, p.count, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) {
            const double half = 0.5 * eta[i];
            v.kxx[i] = half * (p.gxx[i] * p.gxx[i] + p.gxy[i] * p.gxy[i]);
            v.kxy[i] = half * p.gxy[i] * (p.gxx[i] + p.gyy[i]);
            v.kyy[i] = half * (p.gxy[i] * p.gxy[i] + p.gyy[i] * p.gyy[i]);
        }
    });
    world.images.copy({&v.kxx, &v.kxy, &v.kyy});
    const OperatorView view(world);
    for_each_block(world.threads, p.count, [&](int64_t, int64_t begin, int64_t end) {
        diagonal_rows(view, v.kxx.data(), v.kxy.data(), v.kyy.data(), v.stiffness.data(), diagonal.data(), begin, end);
    });
}

} // namespace gp::stages
