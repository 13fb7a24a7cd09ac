#include "operators.hpp"
#include "parallel.hpp"
#include "stages/rows.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

struct View {
    Rows rows;
    const double *x, *y, *vx, *vy;
    const Plate *plates;
    const double *gx, *gy, *gvx, *gvy;
    double inverse_radius, lattice_moment;
    double *lxx, *lxy, *lyx, *lyy, *ixx, *ixy, *iyy;
    double *carried; // NULL: no plates
};

GP_MULTIVERSION void gradient_rows(const View &v, int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i) {
        Moments m;
        add_moments(m, v.rows.row(i), v.rows.count(i), v.x[i], v.y[i], v.vx[i], v.vy[i], v.x, v.y, v.vx, v.vy,
                    v.inverse_radius);
        const double carried = carried_share(m.kxx + m.kyy, v.lattice_moment);
        for (const Contact &contact : v.rows.contacts_of(i)) {
            Moments own;
            add_moments(own, v.rows.ghosts(contact), Rows::ghost_count(contact), v.x[i], v.y[i], v.vx[i], v.vy[i], v.gx,
                        v.gy, v.gvx, v.gvy, v.inverse_radius);
            drop_wall_shear(v.plates[contact.plate], own.mxx, own.mxy, own.myx, own.myy);
            m += own;
        }
        SymmetricTensor g = inverse_shape(m, v.lattice_moment);
        g = {carried * g.xx, carried * g.xy, carried * g.yy};
        if (v.carried)
            v.carried[i] = carried;
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
    const View view{Rows(world),
                    p.x.data(),
                    p.y.data(),
                    p.vx.data(),
                    p.vy.data(),
                    w.plates.data(),
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
                    p.gyy.data(),
                    p.carried.empty() ? nullptr : p.carried.data()};
    for_each_block(world.threads, p.count,
                   [&](int64_t, int64_t begin, int64_t end) { gradient_rows(view, begin, end); });
}

} // namespace gp::stages
