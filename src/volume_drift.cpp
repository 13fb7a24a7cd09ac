#include "volume_drift.hpp"

#include <cmath>

#include "parallel.hpp"

namespace gp {

namespace {

// The horizon about a particle is full if each eighth of its circle has a neighbour in the outermost ring of this width: on
// the lattice so are all but the last three rows of a horizon of 4. Narrower, the lattice itself has gaps.
constexpr double ring = 1.25; // dl

// What is at yield flows if it shears by this much within the scene's time scale, that of a free fall: at the tips of a
// deposit at rest a few grains stay at yield.
constexpr double least_strain = 0.01;

// Eighth of the circle, centred on axes and diagonals: no place of a lattice lies on a border.
unsigned eighth_of(double x, double y) {
    const double tan_22 = std::sqrt(2.0) - 1, ax = std::abs(x), ay = std::abs(y);
    if (ay < tan_22 * ax)
        return x > 0 ? 1 : 2;
    if (ax < tan_22 * ay)
        return y > 0 ? 4 : 8;
    return x > 0 ? (y > 0 ? 16 : 32) : (y > 0 ? 64 : 128);
}
constexpr unsigned all_eighths = 255;

// The sum of (1 - r2/R2)2 about a particle, itself included. This weight is flat where the nearest neighbours are, so it
// tells how many there are and not how they are arranged: on inclined layers of 10 spacings it is within .002 of what their
// height says, from a lattice or a jittered start, at horizons of 3 and 4. The operators' own weight errs by -.007 and -.015.
//
// Sums are in whole units, so that they do not depend on the order of the lists, which an undone step leaves another.
constexpr int64_t unit = 1 << 24;

class Neighborhood {
public:
    Neighborhood(double x, double y, double radius, double spacing)
        : x_(x), y_(y), inverse2_(1 / (radius * radius)), inner_(1 - ring * spacing / radius) {
        inner_ *= inner_;
    }

    void add(double x, double y) {
        const double dx = x - x_, dy = y - y_, r2 = (dx * dx + dy * dy) * inverse2_;
        if (r2 >= 1)
            return;
        sum_ += std::llround((1 - r2) * (1 - r2) * unit);
        if (r2 > inner_)
            eighths_ |= eighth_of(dx, dy);
    }
    bool full() const { return eighths_ == all_eighths; }
    int64_t sum() const { return sum_; }

private:
    double x_, y_, inverse2_, inner_;
    int64_t sum_ = unit;
    unsigned eighths_ = 0;
};

// Where its plate is: ghosts themselves are placed in the next step, and an undone one has done so.
void add_ghost(const Walls &walls, int32_t ghost, Neighborhood &about) {
    const Segment &s = walls.facets[walls.ghost_facet[ghost]].segment;
    const Vector at = s.origin + walls.ghost_along[ghost] * s.tangent - walls.ghost_depth[ghost] * s.normal;
    about.add(at.x() + (walls.ghost_shift.empty() ? 0.0 : walls.ghost_shift[ghost]), at.y());
}

bool flows(const World &world, int64_t i) {
    const Particles &p = world.particles;
    const double dxx = 0.5 * (p.lxx[i] - p.lyy[i]), dxy = 0.5 * (p.lxy[i] + p.lyx[i]);
    const bool yields = world.material_of(i).cooperativity2 > 0
                            ? p.fluidity[i] > 0
                            : world.map_of(i).at_yield(equivalent_stress({p.sxx[i], p.sxy[i]}), p.pressure[i]);
    return p.pressure[i] > 0 && yields &&
           2 * std::sqrt(dxx * dxx + dxy * dxy) * world.constants.time_scale > least_strain;
}

} // namespace

Packing measure_packing(const World &world, Part part) {
    const Particles &p = world.particles;
    const Walls &walls = world.walls;
    const double radius = world.constants.horizon;
    struct Sums {
        int64_t weights = 0, particles = 0;
        double density = 0;
    };
    std::vector<Sums> blocks(block_count(p.count));
    for_each_block(world.threads, p.count, [&](int64_t block, int64_t begin, int64_t end) {
        for (int64_t place = begin; place < end; ++place) {
            const int64_t i = world.particle_listed_at(place);
            if (part == Part::flowing && !flows(world, i))
                continue;
            Neighborhood about(p.x[i], p.y[i], radius, world.constants.spacing);
            for_each_candidate(world.grid, world.images, p.x[i], p.y[i], radius + world.shifted, [&](int64_t there) {
                const int64_t j = world.particle_listed_at(there);
                if (j != i)
                    about.add(p.x[j], p.y[j]);
            });
            if (!walls.contact_start.empty())
                for (int64_t c = walls.contact_start[place]; c < walls.contact_start[place + 1]; ++c)
                    for (int64_t k = walls.contacts[c].begin; k < walls.contacts[c].end; ++k)
                        add_ghost(walls, walls.ghost_of_contact[k], about);
            if (!about.full())
                continue;
            blocks[block].weights += about.sum();
            blocks[block].density += p.density[i] / world.material_of(i).density;
            ++blocks[block].particles;
        }
    });
    Sums all;
    for (const Sums &block : blocks) {
        all.weights += block.weights;
        all.particles += block.particles;
        all.density += block.density;
    }
    Packing packing;
    packing.particles = all.particles;
    if (all.particles > 0) {
        packing.number_density =
            static_cast<double>(all.weights) / static_cast<double>(unit) / static_cast<double>(all.particles);
        packing.density = all.density / static_cast<double>(all.particles);
    }
    return packing;
}

double packing_of_lattice(double radius, double spacing) {
    Neighborhood about(0, 0, radius, spacing);
    const int reach = static_cast<int>(std::ceil(radius / spacing));
    for (int j = -reach; j <= reach; ++j)
        for (int i = -reach; i <= reach; ++i)
            if (i != 0 || j != 0)
                about.add(i * spacing, j * spacing);
    return static_cast<double>(about.sum()) / static_cast<double>(unit);
}

double drift_of(const World &world, const Packing &flowing) {
    return flowing.particles > 0 ? flowing.number_density / world.packing_at_start - 1 : 0.0;
}

} // namespace gp
