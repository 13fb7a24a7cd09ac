#include "operators.hpp"
#include "parallel.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

struct View {
    const double *x, *y, *vx, *vy;
    const int64_t *start;
    const int32_t *index;
    const int32_t *contact_start; // NULL where no plate is in reach
    const Contact *contacts;
    const Plate *plates;
    const int32_t *ghost_index;
    const double *gx, *gy, *gvx, *gvy;
    double inverse_radius, lattice_moment;
    double *lxx, *lxy, *lyx, *lyy, *ixx, *ixy, *iyy;
};

// The ghosts of one plate. Through a plate without friction of its own passes no shear: the change along the normal of the
// velocity along the plate, t.M.n, is left out.
GP_INLINE void add_contact(Moments &sum, const View &v, int64_t i, const Contact &contact) {
    Moments m;
    add_moments(m, v.ghost_index + contact.begin, contact.end - contact.begin, v.x[i], v.y[i], v.vx[i], v.vy[i], v.gx,
                v.gy, v.gvx, v.gvy, v.inverse_radius);
    const Plate &plate = v.plates[contact.plate];
    if (plate.spec().friction != GP_WALL_NO_SLIP) {
        const Vector &t = plate.segment().tangent, &n = plate.segment().normal;
        const double shear = t.x() * (m.mxx * n.x() + m.mxy * n.y()) + t.y() * (m.myx * n.x() + m.myy * n.y());
        m.mxx -= shear * t.x() * n.x();
        m.mxy -= shear * t.x() * n.y();
        m.myx -= shear * t.y() * n.x();
        m.myy -= shear * t.y() * n.y();
    }
    sum.kxx += m.kxx;
    sum.kxy += m.kxy;
    sum.kyy += m.kyy;
    sum.mxx += m.mxx;
    sum.mxy += m.mxy;
    sum.myx += m.myx;
    sum.myy += m.myy;
}

GP_MULTIVERSION void gradient_rows(const View &v, int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i) {
        Moments m;
        add_moments(m, v.index + v.start[i], v.start[i + 1] - v.start[i], v.x[i], v.y[i], v.vx[i], v.vy[i], v.x, v.y,
                    v.vx, v.vy, v.inverse_radius);
        if (v.contact_start)
            for (int32_t k = v.contact_start[i]; k < v.contact_start[i + 1]; ++k)
                add_contact(m, v, i, v.contacts[k]);
        const SymmetricTensor g = inverse_shape(m, v.lattice_moment);
        v.ixx[i] = g.xx;
        v.ixy[i] = g.xy;
        v.iyy[i] = g.yy;
        v.lxx[i] = m.mxx * g.xx + m.mxy * g.xy;
        v.lxy[i] = m.mxx * g.xy + m.mxy * g.yy;
        v.lyx[i] = m.myx * g.xx + m.myy * g.xy;
        v.lyy[i] = m.myx * g.xy + m.myy * g.yy;
    }
}

} // namespace

void gradient(World &world) {
    Particles &p = world.particles;
    const Walls &w = world.walls;
    const bool walls = w.in_reach();
    const View view{p.x.data(),
                    p.y.data(),
                    p.vx.data(),
                    p.vy.data(),
                    world.neighbors.start.data(),
                    world.neighbors.index.data(),
                    walls ? w.contact_start.data() : nullptr,
                    w.contacts.data(),
                    w.plates.data(),
                    w.ghost_of_contact.data(),
                    w.ghost_x.data(),
                    w.ghost_y.data(),
                    w.ghost_vx.data(),
                    w.ghost_vy.data(),
                    1.0 / world.constants.horizon,
                    world.constants.lattice.second_moment,
                    p.lxx.data(),
                    p.lxy.data(),
                    p.lyx.data(),
                    p.lyy.data(),
                    p.gxx.data(),
                    p.gxy.data(),
                    p.gyy.data()};
    for_each_block(world.threads, p.count,
                   [&](int64_t, int64_t begin, int64_t end) { gradient_rows(view, begin, end); });
}

} // namespace gp::stages
