#include "walls.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "parallel.hpp"

namespace gp {

Vector Plate::prescribed_displacement(double time) const {
    if (driven_)
        return driven_from_ + (time - driven_since_) * driven_velocity_;
    if (!spec_->table.empty())
        return spec_->table.displacement(time);
    return spec_->start + time * spec_->velocity;
}

Vector Plate::displacement(double time) const {
    return prescribed_displacement(time) + fallen_ * spec_->segment.normal;
}

void Plate::fall(double dt, double default_mass) {
    const Segment &s = spec_->segment;
    const double mass = s.length * (spec_->mass > 0 ? spec_->mass : default_mass); // kg/m
    const double change = dt * (spec_->load * s.length + s.normal.dot(force)) / mass;
    fall_speed_ += change;
    fallen_ += dt * fall_speed_;
    velocity_ += change * s.normal;
}

void Plate::drive(double time, const Vector &velocity) {
    driven_from_ = prescribed_displacement(time);
    driven_since_ = time;
    driven_velocity_ = velocity;
    driven_ = true;
    velocity_ = velocity + fall_speed_ * spec_->segment.normal; // the next step's size goes by it
}

bool Plate::moves_after(double time) const {
    if (loaded())
        return true;
    if (driven_)
        return driven_velocity_ != Vector::Zero();
    if (!spec_->table.empty())
        return time < spec_->table.last_time();
    return spec_->velocity != Vector::Zero();
}

void Plate::wrap(const Period &period, double time) {
    const Segment &s = spec_->segment;
    wrapped_ = period.shift_of(s.origin.x() + 0.5 * s.length * s.tangent.x() + displacement(time).x());
}

void Plate::place(double time, double dt) {
    placed_ = spec_->segment.moved(displacement(time) - Vector(wrapped_, 0));
    if (driven_)
        velocity_ = driven_velocity_;
    else if (spec_->table.empty())
        velocity_ = spec_->velocity;
    else if (dt > 0)
        velocity_ = (spec_->table.displacement(time + dt) - spec_->table.displacement(time)) / dt;
    else // placed anew between steps, before the first one: as it was
        return;
    velocity_ += fall_speed_ * spec_->segment.normal;
}

Plate::Motion Plate::motion() const {
    return {driven_,     driven_since_, driven_from_,   driven_velocity_, fallen_,
            fall_speed_, wrapped_,      placed_.origin, velocity_};
}

void Plate::set_motion(const Motion &motion) {
    driven_ = motion.driven;
    driven_since_ = motion.driven_since;
    driven_from_ = motion.driven_from;
    driven_velocity_ = motion.driven_velocity;
    fallen_ = motion.fallen;
    fall_speed_ = motion.fall_speed;
    wrapped_ = motion.wrapped;
    placed_.origin = motion.origin;
    velocity_ = motion.velocity;
}

int64_t Walls::count_overlapping(const Particles &particles, double margin) const {
    int64_t found = 0;
    for (int64_t i = 0; i < particles.count; ++i) {
        const Vector at(particles.x[i], particles.y[i]);
        found += std::any_of(plates.begin(), plates.end(), [&](const Plate &plate) {
            const Vector image = nearest_image(plate, at);
            return std::abs(plate.segment().distance(image)) < margin &&
                   plate.segment().covers(plate.segment().along(image), 0);
        });
    }
    return found;
}

int64_t Walls::bytes() const {
    int64_t total = particles_of_ghost.bytes();
    for (const Field<double> *field : {&ghost_along, &ghost_depth, &ghost_shift, &ghost_x, &ghost_y, &ghost_vx,
                                       &ghost_vy, &ghost_axx, &ghost_axy, &ghost_ayy})
        total += static_cast<int64_t>(field->capacity() * sizeof(double));
    for (const Field<int32_t> *field : {&ghost_plate, &wall_particle, &ghost_of_contact, &contact_start, &fill_})
        total += static_cast<int64_t>(field->capacity() * sizeof(int32_t));
    return total +
           static_cast<int64_t>(contacts.capacity() * sizeof(Contact) + candidates_.capacity() * sizeof(Candidate) +
                                nearby_.capacity() * sizeof(Nearby));
}

namespace {

// Two plates passed at fractions of the way that differ by less are passed at their common corner: twice the tolerance of
// crossing(), 1e-9 dl, over ways of at least half a spacing.
constexpr double corner = 1e-8;

// A particle this close behind the line still counts as in front of it: the contact stage is about to push it back.
constexpr double penetration_allowed = 0.25; // dl

Box box_around(const Segment &s, double margin) {
    const Vector end = s.origin + s.length * s.tangent;
    return {std::min(s.origin.x(), end.x()) - margin, std::max(s.origin.x(), end.x()) + margin,
            std::min(s.origin.y(), end.y()) - margin, std::max(s.origin.y(), end.y()) + margin};
}

} // namespace

// A plate, and in a periodic scene its images across the ends. One that spans the period has no end: it is one long
// segment, that begins a period before its end 0.
const std::vector<Walls::Nearby> &Walls::images_of_plates() {
    std::vector<Nearby> &all = images_;
    all.clear();
    for (std::size_t p = 0; p < plates.size(); ++p) {
        const Segment &s = plates[p].segment();
        const auto id = static_cast<int32_t>(p);
        if (!period) {
            all.push_back({s, id, 0, 0});
        } else if (period.spanned_by(s)) {
            Segment endless = s.moved(-s.length * s.tangent);
            endless.length *= 3;
            all.push_back({endless, id, 0, s.length});
        } else {
            for (double shift : {0.0, period.length, -period.length})
                all.push_back({s.moved({shift, 0}), id, shift, 0});
        }
    }
    return all;
}

const std::vector<Segment> &Walls::barriers(const Particles &particles, const CellGrid &grid, double radius) {
    std::vector<Segment> &found = barriers_;
    found.clear();
    for (const Nearby &image : images_of_plates()) {
        const Segment &s = image.segment;
        const Box box = box_around(s, radius);
        if (particles.count == 0 || box.gap(grid.box()) > 0)
            continue;
        const double allowed = penetration_allowed * std::sqrt(particles.volume);
        bool behind = false;
        grid.for_each_run(box, [&](int64_t begin, int64_t end) {
            for (int64_t i = begin; i < end && !behind; ++i) {
                const Vector r(particles.x[i], particles.y[i]);
                const double d = s.distance(r), along = s.along(r);
                behind = d < -allowed && d > -radius && along > -radius && along < s.length + radius;
            }
        });
        if (behind)
            found.push_back(s);
    }
    return found;
}

void Walls::find_nearby(const Particles &particles, const CellGrid &grid, double radius) {
    nearby_.clear();
    if (particles.count == 0)
        return;
    for (Plate &plate : plates)
        plate.gap = INFINITY;
    for (const Nearby &image : images_of_plates()) {
        const double gap = box_around(image.segment, radius).gap(grid.box());
        plates[image.plate].gap = std::min(plates[image.plate].gap, gap);
        if (gap <= 0)
            nearby_.push_back(image);
    }
}

void Walls::place_candidates(const CellGrid &grid, double radius, double spacing) {
    candidates_.clear();
    // Lattice points behind each plate that lie within reach of the particles' box.
    const auto layers = static_cast<int64_t>(std::ceil(radius / spacing));
    for (std::size_t k = 0; k < nearby_.size(); ++k) {
        const Segment &s = nearby_[k].segment;
        double low = INFINITY, high = -INFINITY, near = INFINITY;
        for (double bx : {grid.box().x_min, grid.box().x_max})
            for (double by : {grid.box().y_min, grid.box().y_max}) {
                low = std::min(low, s.along({bx, by}));
                high = std::max(high, s.along({bx, by}));
                near = std::min(near, s.distance({bx, by}));
            }
        if (near > radius)
            continue;
        // Past the ends the lattice fills corners.
        const auto cells = static_cast<int64_t>(std::ceil(s.length / spacing - 1e-9));
        const int64_t from = std::max(-layers, static_cast<int64_t>(std::floor((low - radius) / spacing)));
        const int64_t to = std::min(cells + layers, static_cast<int64_t>(std::ceil((high + radius) / spacing)));
        for (int64_t layer = 0; layer < layers; ++layer)
            for (int64_t cell = from; cell < to; ++cell) {
                const double along = (static_cast<double>(cell) + 0.5) * spacing;
                const double depth = (static_cast<double>(layer) + 0.5) * spacing;
                const Vector at = s.origin + along * s.tangent - depth * s.normal;
                candidates_.push_back({static_cast<int32_t>(k), along, depth, at.x(), at.y(), 0, false});
            }
    }
}

void Walls::find_contacts(const Particles &particles, const CellGrid &grid, const Images &images, double radius,
                          double spacing, int threads) {
    const int64_t n = particles.count;
    const double tolerance = 1e-9 * spacing;
    find_nearby(particles, grid, radius);
    place_candidates(grid, radius, spacing);

    // Calls seen(i) for the particles and images that see a candidate.
    const double allowed = penetration_allowed * spacing;
    const auto visit = [&](const Candidate &ghost, const auto &seen) {
        const Segment &own = nearby_[ghost.nearby].segment;
        const Vector at(ghost.x, ghost.y);
        for_each_candidate(grid, images, ghost.x, ghost.y, radius, [&](int64_t i) {
            const double dx = particles.x[i] - ghost.x, dy = particles.y[i] - ghost.y;
            if (dx * dx + dy * dy >= radius * radius)
                return;
            Vector from(particles.x[i], particles.y[i]);
            const double d = own.distance(from);
            if (d <= 0) {
                if (d < -allowed || !own.covers(own.along(from), tolerance))
                    return;
                from += (tolerance - d) * own.normal;
            }
            const double own_fraction = crossing(own, from, at, tolerance);
            if (own_fraction < 0)
                return;
            for (std::size_t q = 0; q < nearby_.size(); ++q) {
                if (static_cast<int32_t>(q) == ghost.nearby)
                    continue;
                const double fraction = crossing(nearby_[q].segment, from, at, tolerance);
                // What is seen through a corner of two plates, as on the diagonal of a box, is the first one's.
                const double same =
                    static_cast<int32_t>(q) < ghost.nearby ? own_fraction + corner : own_fraction - corner;
                if (fraction >= 0 && fraction < same) // hidden
                    return;
            }
            seen(i);
        });
    };
    const auto candidate_count = static_cast<int64_t>(candidates_.size());
    for_each_block<ghost_block_size>(threads, candidate_count, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t k = begin; k < end; ++k)
            visit(candidates_[k], [&](int64_t i) {
                ++candidates_[k].neighbors;
                candidates_[k].seen |= i < n;
            });
    });
    candidates_.erase(std::remove_if(candidates_.begin(), candidates_.end(),
                                     [](const Candidate &candidate) { return !candidate.seen; }),
                      candidates_.end());

    ghost_count = static_cast<int64_t>(candidates_.size());
    ghost_plate.resize(ghost_count);
    if (period)
        ghost_shift.resize(ghost_count);
    for (Field<double> *field :
         {&ghost_along, &ghost_depth, &ghost_x, &ghost_y, &ghost_vx, &ghost_vy, &ghost_axx, &ghost_axy, &ghost_ayy})
        field->resize(ghost_count);
    particles_of_ghost.start.resize(ghost_count + 1);
    particles_of_ghost.start[0] = 0;
    for (int64_t k = 0; k < ghost_count; ++k) {
        const Nearby &nearby = nearby_[candidates_[k].nearby];
        ghost_plate[k] = nearby.plate;
        if (period)
            ghost_shift[k] = nearby.shift;
        ghost_along[k] = candidates_[k].along - nearby.before;
        ghost_depth[k] = candidates_[k].depth;
        ghost_x[k] = candidates_[k].x;
        ghost_y[k] = candidates_[k].y;
        particles_of_ghost.start[k + 1] = particles_of_ghost.start[k] + candidates_[k].neighbors;
    }
    const int64_t pairs = particles_of_ghost.start[ghost_count];
    particles_of_ghost.index.resize(pairs);
    for_each_block<ghost_block_size>(threads, ghost_count, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t k = begin; k < end; ++k) {
            int32_t *next = particles_of_ghost.index.data() + particles_of_ghost.start[k];
            visit(candidates_[k], [&](int64_t i) { *next++ = static_cast<int32_t>(i); });
        }
    });

    // The transposed list: ghosts of each particle, in ghost order and so plate by plate.
    fill_.assign(n + 1, 0);
    for (int64_t k = 0; k < pairs; ++k)
        if (particles_of_ghost.index[k] < n)
            ++fill_[particles_of_ghost.index[k] + 1];
    std::partial_sum(fill_.begin(), fill_.end(), fill_.begin());
    ghost_of_contact.resize(fill_[n]);
    for (int64_t k = 0; k < ghost_count; ++k)
        for (int64_t e = particles_of_ghost.start[k]; e < particles_of_ghost.start[k + 1]; ++e)
            if (particles_of_ghost.index[e] < n)
                ghost_of_contact[fill_[particles_of_ghost.index[e]]++] = static_cast<int32_t>(k);
    contacts.clear();
    contact_start.resize(n + 1);
    int64_t entry = 0;
    for (int64_t i = 0; i < n; ++i) {
        contact_start[i] = static_cast<int32_t>(contacts.size());
        while (entry < fill_[i]) { // fill_[i] has become the end of row i
            const int32_t plate = ghost_plate[ghost_of_contact[entry]];
            const int64_t begin = entry;
            while (entry < fill_[i] && ghost_plate[ghost_of_contact[entry]] == plate)
                ++entry;
            contacts.push_back({static_cast<int32_t>(i), plate, begin, entry, 0, 0, 0, 0});
        }
    }
    contact_start[n] = static_cast<int32_t>(contacts.size());
}

void Walls::find_wall_particles(double spacing) {
    wall_particle.resize(ghost_count);
    // Ghosts are in order of plate, layer and place along the plate.
    int64_t first = 0, last = 0; // wall particles of this plate
    for (int64_t k = 0; k < ghost_count; ++k) {
        const bool new_plate = k == 0 || ghost_plate[k] != ghost_plate[k - 1];
        if (new_plate) {
            const double length = plates[ghost_plate[k]].segment().length;
            const auto usable = [&](int64_t g) {
                return g < ghost_count && ghost_plate[g] == ghost_plate[k] && ghost_depth[g] < spacing;
            };
            first = k;
            while (usable(first) && ghost_along[first] < 0)
                ++first;
            last = first;
            while (usable(last) && ghost_along[last] < length)
                ++last;
        }
        if (first == last) { // none is seen
            wall_particle[k] = static_cast<int32_t>(k);
            continue;
        }
        const auto begin = ghost_along.begin() + first, end = ghost_along.begin() + last;
        auto nearest = std::lower_bound(begin, end, ghost_along[k]);
        if (nearest == end || (nearest != begin && ghost_along[k] - *(nearest - 1) < *nearest - ghost_along[k]))
            --nearest;
        wall_particle[k] = static_cast<int32_t>(nearest - ghost_along.begin());
    }
}

void Walls::place_ghosts(int threads) {
    for_each_block<ghost_block_size>(threads, ghost_count, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t k = begin; k < end; ++k) {
            const Segment &s = plates[ghost_plate[k]].segment();
            const Vector at = s.origin + ghost_along[k] * s.tangent - ghost_depth[k] * s.normal;
            ghost_x[k] = at.x() + (ghost_shift.empty() ? 0.0 : ghost_shift[k]);
            ghost_y[k] = at.y();
        }
    });
}

} // namespace gp
