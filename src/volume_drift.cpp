#include "volume_drift.hpp"

#include <cmath>

#include "kernel.hpp"
#include "parallel.hpp"

namespace gp {

namespace {

// The horizon about a particle is full if each eighth of its circle has a neighbour in the outermost ring of this width: on
// the lattice from the last row on whose own neighbours of any weight are all there. Narrower, the lattice itself has gaps.
constexpr double ring = 1.25; // dl

// Eighth of the circle, centred on axes and diagonals, so that no place of a lattice lies on a border.
unsigned eighth_of(double x, double y) {
    const double tan_22 = std::sqrt(2.0) - 1, ax = std::abs(x), ay = std::abs(y);
    if (ay < tan_22 * ax)
        return x > 0 ? 1u : 2u;
    if (ax < tan_22 * ay)
        return y > 0 ? 4u : 8u;
    return (x > 0 ? 16u : 64u) << (y > 0 ? 0 : 1);
}

class Neighborhood {
public:
    Neighborhood(double x, double y, double radius, double spacing)
        : x_(x), y_(y), radius_(radius), inner_(radius - ring * spacing) {}

    void add(double x, double y) {
        const double dx = x - x_, dy = y - y_, r = std::hypot(dx, dy);
        if (r >= radius_)
            return;
        sum_ += weight(r, 1.0 / radius_);
        if (r > inner_)
            eighths_ |= eighth_of(dx, dy);
    }
    bool full() const { return eighths_ == 255; }
    double number_density() const { return sum_; }

private:
    double x_, y_, radius_, inner_, sum_ = 0;
    unsigned eighths_ = 0;
};

} // namespace

Packing measure_packing(const World &world, Part part) {
    const Particles &p = world.particles;
    const Walls &walls = world.walls;
    const double radius = world.constants.horizon;
    std::vector<Packing> blocks(block_count(p.count)); // sums
    for_each_block(world.threads, p.count, [&](int64_t block, int64_t begin, int64_t end) {
        for (int64_t place = begin; place < end; ++place) {
            const int64_t i = world.particle_listed_at(place);
            if (part == Part::flowing &&
                !(p.pressure[i] > 0 &&
                  world.map_of(i).at_yield(equivalent_stress({p.sxx[i], p.sxy[i]}), p.pressure[i])))
                continue;
            Neighborhood about(p.x[i], p.y[i], radius, world.constants.spacing);
            for_each_candidate(world.grid, world.images, p.x[i], p.y[i], radius + world.shifted, [&](int64_t there) {
                if (there != place)
                    about.add(p.x[world.particle_listed_at(there)], p.y[world.particle_listed_at(there)]);
            });
            if (!walls.contact_start.empty())
                for (int64_t c = walls.contact_start[place]; c < walls.contact_start[place + 1]; ++c)
                    for (int64_t k = walls.contacts[c].begin; k < walls.contacts[c].end; ++k)
                        about.add(walls.ghost_x[walls.ghost_of_contact[k]], walls.ghost_y[walls.ghost_of_contact[k]]);
            if (!about.full())
                continue;
            blocks[block].number_density += about.number_density();
            ++blocks[block].particles;
        }
    });
    Packing packing;
    for (const Packing &block : blocks) {
        packing.number_density += block.number_density;
        packing.particles += block.particles;
    }
    if (packing.particles > 0)
        packing.number_density /= static_cast<double>(packing.particles);
    return packing;
}

double volume_drift(const World &world) {
    const Packing flowing = measure_packing(world, Part::flowing);
    return flowing.particles > 0 ? flowing.number_density / world.packing_at_start - 1 : 0.0;
}

} // namespace gp
