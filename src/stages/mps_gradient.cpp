#include "mps_operators.hpp"
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
    double inverse_radius, floor, scale;
    double *lxx, *lxy, *lyx, *lyy;
};

GP_INLINE void add_contact(MpsGradient &sum, const View &v, int64_t i, const Contact &contact) {
    MpsGradient m = mps_gradient_sum(v.ghost_index + contact.begin, contact.end - contact.begin, v.x[i], v.y[i],
                                     v.vx[i], v.vy[i], v.gx, v.gy, v.gvx, v.gvy, v.inverse_radius, v.floor);
    const Plate &plate = v.plates[contact.plate];
    if (plate.spec().friction != GP_WALL_NO_SLIP) { // no shear passes, as in gradient.cpp
        const Vector &t = plate.segment().tangent, &n = plate.segment().normal;
        const double shear = t.x() * (m.xx * n.x() + m.xy * n.y()) + t.y() * (m.yx * n.x() + m.yy * n.y());
        m.xx -= shear * t.x() * n.x();
        m.xy -= shear * t.x() * n.y();
        m.yx -= shear * t.y() * n.x();
        m.yy -= shear * t.y() * n.y();
    }
    sum.xx += m.xx;
    sum.xy += m.xy;
    sum.yx += m.yx;
    sum.yy += m.yy;
}

GP_MULTIVERSION void mps_gradient_rows(const View &v, int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i) {
        MpsGradient m = mps_gradient_sum(v.index + v.start[i], v.start[i + 1] - v.start[i], v.x[i], v.y[i], v.vx[i],
                                         v.vy[i], v.x, v.y, v.vx, v.vy, v.inverse_radius, v.floor);
        if (v.contact_start)
            for (int32_t k = v.contact_start[i]; k < v.contact_start[i + 1]; ++k)
                add_contact(m, v, i, v.contacts[k]);
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
    const View view{p.x.data(),
                    p.y.data(),
                    p.vx.data(),
                    p.vy.data(),
                    world.neighbors.start.data(),
                    world.neighbors.index.data(),
                    w.in_reach() ? w.contact_start.data() : nullptr,
                    w.contacts.data(),
                    w.plates.data(),
                    w.ghost_of_contact.data(),
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
