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

// The sum of (1 - r2/R2)2 about a particle, itself included. This weight is flat where the nearest neighbours are, so it
// tells how many there are and not how they are arranged: on inclined layers of 10 spacings it is within .002 of what their
// height says, from a lattice or a jittered start, at horizons of 3 and 4. The operators' own weight errs by -.007 and -.015.
//
// Sums are in whole units, so that they do not depend on the order of the lists, which an undone step leaves another.
constexpr int64_t unit = 1 << 24;

struct Neighborhood {
    double x = 0, y = 0, inverse2 = 0, inner = 0; // inverse2: 1 / R2; inner: where the ring begins, of r2/R2
    int64_t sum = 0, eighths = 0;                 // eighths of the circle with a neighbour in the ring, bit by bit

    Neighborhood() = default;
    Neighborhood(double at_x, double at_y, double radius, double spacing)
        : x(at_x), y(at_y), inverse2(1 / (radius * radius)), inner(1 - ring * spacing / radius) {
        inner *= inner;
    }
    bool full() const { return eighths == 255; }
};

// Adds neighbours, the particle itself among them. Eighths are centred on axes and diagonals: no place of a lattice lies on a
// border.
void add_run(const double *__restrict x, const double *__restrict y, int64_t n, Neighborhood &about) {
    constexpr double tan_22 = 0.41421356237309503; // of 22.5 degrees
    const double own_x = about.x, own_y = about.y, inverse2 = about.inverse2, inner = about.inner;
    int64_t sum = 0, eighths = 0;
#pragma omp simd reduction(+ : sum) reduction(| : eighths)
    for (int64_t k = 0; k < n; ++k) {
        const double dx = x[k] - own_x, dy = y[k] - own_y, r2 = (dx * dx + dy * dy) * inverse2;
        const double ax = std::abs(dx), ay = std::abs(dy), inside = r2 < 1 ? 1 - r2 : 0;
        // NOLINTNEXTLINE(bugprone-incorrect-roundings): never negative, and no processor has four lround at a time
        sum += static_cast<int32_t>(inside * inside * unit + 0.5);
        const int64_t on_x = dx > 0 ? 1 : 2, on_y = dy > 0 ? 4 : 8;
        const int64_t right = dy > 0 ? 16 : 64, left = dy > 0 ? 32 : 128, diagonal = dx > 0 ? right : left;
        const int64_t eighth = ay < tan_22 * ax ? on_x : ax < tan_22 * ay ? on_y : diagonal;
        eighths |= r2 > inner && r2 < 1 ? eighth : 0;
    }
    about.sum += sum;
    about.eighths |= eighths;
}

// Where its plate is: ghosts themselves are placed in the next step, and an undone one has done so.
void add_ghost(const Walls &walls, int32_t ghost, Neighborhood &about) {
    const Segment &s = walls.facets[walls.ghost_facet[ghost]].segment;
    const Vector at = s.origin + walls.ghost_along[ghost] * s.tangent - walls.ghost_depth[ghost] * s.normal;
    const double x = at.x() + (walls.ghost_shift.empty() ? 0.0 : walls.ghost_shift[ghost]), y = at.y();
    add_run(&x, &y, 1, about);
}

// Of some particles of one cluster, which have nearly the same candidates: these are collected once for all.
class ClusterNeighborhoods {
public:
    explicit ClusterNeighborhoods(const World &world) : world_(world), radius_(world.constants.horizon) {}
    void add_particle(int64_t at) {
        const int64_t i = world_.particle_listed_at(at);
        place[count] = at;
        of[count] = Neighborhood(world_.particles.x[i], world_.particles.y[i], radius_, world_.constants.spacing);
        // The cells are those of the last sort.
        const double x = world_.list_origin.x[at], y = world_.list_origin.y[at], reach = world_.radius_then(radius_);
        Box box{x - reach, x + reach, y - reach, y + reach};
        if (count++ > 0)
            box = {std::min(box.x_min, box_.x_min), std::max(box.x_max, box_.x_max), std::min(box.y_min, box_.y_min),
                   std::max(box.y_max, box_.y_max)};
        box_ = box;
    }
    void look_around() {
        if (count == 0)
            return;
        const Particles &p = world_.particles;
        for_each_run_in(world_.grid, world_.images, box_, [&](int64_t begin, int64_t end) {
            for (int64_t there = begin; there < end; ++there) {
                const int64_t j = world_.particle_listed_at(there);
                collect(p.x[j], p.y[j]);
            }
        });
        pass_on();
        const Walls &walls = world_.walls;
        if (!walls.contact_start.empty())
            for (int k = 0; k < count; ++k)
                for (int64_t c = walls.contact_start[place[k]]; c < walls.contact_start[place[k] + 1]; ++c)
                    for (int64_t g = walls.contacts[c].begin; g < walls.contacts[c].end; ++g)
                        add_ghost(walls, walls.ghost_of_contact[g], of[k]);
    }

    int count = 0;
    int64_t place[lane_count]; // in the lists
    Neighborhood of[lane_count];

private:
    void collect(double x, double y) {
        x_[collected_] = x;
        y_[collected_] = y;
        if (++collected_ == room)
            pass_on();
    }
    void pass_on() {
        for (; collected_ % 8 != 0; ++collected_) // whole vectors: what is infinitely far away does not count
            x_[collected_] = y_[collected_] = INFINITY;
        for (int k = 0; k < count; ++k)
            add_run(x_, y_, collected_, of[k]);
        collected_ = 0;
    }

    static constexpr int64_t room = 256; // a multiple of 8
    const World &world_;
    double radius_;
    Box box_;
    int64_t collected_ = 0;
    double x_[room], y_[room];
};

bool flows(const World &world, int64_t i) {
    const Particles &p = world.particles;
    const double dxx = 0.5 * (p.lxx[i] - p.lyy[i]), dxy = 0.5 * (p.lxy[i] + p.lyx[i]);
    const bool yields = world.is_fluid(i)
                            ? p.fluidity[i] > 0
                            : world.map_of(i).at_yield(equivalent_stress({p.sxx[i], p.sxy[i]}), p.pressure[i]);
    return p.pressure[i] > 0 && yields &&
           2 * std::sqrt(dxx * dxx + dxy * dxy) * world.constants.time_scale() > least_strain;
}

} // namespace

Packing measure_packing(const World &world, Part part) {
    const Particles &p = world.particles;
    struct Sums {
        int64_t weights = 0, particles = 0;
        double density = 0;
    };
    const Field<int32_t> &of_block = world.clusters.cluster_of_block;
    std::vector<Sums> blocks(static_cast<std::size_t>(world.clusters.blocks()));
    for_each_block<1>(world.threads, world.clusters.blocks(), [&](int64_t block, int64_t, int64_t) {
        for (int64_t c = of_block[block]; c < of_block[block + 1]; ++c) {
            ClusterNeighborhoods about(world);
            for (int64_t place = world.clusters.first[c]; place < world.clusters.first[c + 1]; ++place)
                if (part == Part::all || flows(world, world.particle_listed_at(place)))
                    about.add_particle(place);
            about.look_around();
            for (int k = 0; k < about.count; ++k) {
                if (!about.of[k].full())
                    continue;
                const int64_t i = world.particle_listed_at(about.place[k]);
                blocks[block].weights += about.of[k].sum;
                blocks[block].density += p.density[i] / world.material_of(i).density;
                ++blocks[block].particles;
            }
        }
    });
    Sums all;
    for (const Sums &block : blocks) {
        all.weights += block.weights;
        all.particles += block.particles;
        all.density += block.density;
    }
    if (world.crossing) {
        Whole sums[] = {all.weights, all.particles};
        world.crossing->combine(nullptr, 0, sums, 2);
        all.weights = static_cast<int64_t>(sums[0]);
        all.particles = static_cast<int64_t>(sums[1]);
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
        for (int i = -reach; i <= reach; ++i) {
            const double x = i * spacing, y = j * spacing;
            add_run(&x, &y, 1, about);
        }
    return static_cast<double>(about.sum) / static_cast<double>(unit);
}

double drift_of(const World &world, const Packing &flowing) {
    return flowing.particles > 0 ? flowing.number_density / world.packing_at_start - 1 : 0.0;
}

} // namespace gp
