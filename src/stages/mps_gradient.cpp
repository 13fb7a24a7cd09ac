#include "mps_operators.hpp"
#include "parallel.hpp"
#include "stages/rows.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

struct MpsGradientView {
    Rows rows;
    const double *x, *y, *vx, *vy;
    const Facet *facets;
    const double *gx, *gy, *gvx, *gvy;
    double inverse_radius, floor, scale;
    double *lxx, *lxy, *lyx, *lyy;
};

void mps_gradient_rows(const MpsGradientView &v, int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i) {
        MpsGradient m = mps_gradient_sum(v.rows.row(i), v.rows.count(i), v.x[i], v.y[i], v.vx[i], v.vy[i], v.x, v.y,
                                         v.vx, v.vy, v.inverse_radius, v.floor);
        for (const Contact &contact : v.rows.contacts_of(i)) {
            MpsGradient own = mps_gradient_sum(v.rows.ghosts(contact), Rows::ghost_count(contact), v.x[i], v.y[i],
                                               v.vx[i], v.vy[i], v.gx, v.gy, v.gvx, v.gvy, v.inverse_radius, v.floor);
            if (!passes_shear(v.facets[contact.facet]))
                drop_shear(v.facets[contact.facet], own.xx, own.xy, own.yx, own.yy);
            m += own;
        }
        v.lxx[i] = v.scale * m.xx;
        v.lxy[i] = v.scale * m.xy;
        v.lyx[i] = v.scale * m.yx;
        v.lyy[i] = v.scale * m.yy;
    }
}

} // namespace

void mps_gradient(World &world) {
    Particles &p = world.particles;
    const Constants &c = world.constants;
    const Walls &w = world.walls;
    const MpsGradientView view{Rows(world),
                               p.x.data(),
                               p.y.data(),
                               p.vx.data(),
                               p.vy.data(),
                               w.facets.data(),
                               w.ghost_x.data(),
                               w.ghost_y.data(),
                               w.ghost_vx.data(),
                               w.ghost_vy.data(),
                               1.0 / c.interaction_radius,
                               nearest_square * c.volume,
                               2.0 / c.interaction_lattice.number_density,
                               p.lxx.data(),
                               p.lxy.data(),
                               p.lyx.data(),
                               p.lyy.data()};
    for_each_block(world.threads, p.count,
                   [&](int64_t, int64_t begin, int64_t end) { mps_gradient_rows(view, begin, end); });
}

} // namespace gp::stages
