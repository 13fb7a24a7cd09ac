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
            all.push_back({s, id, 0, 0, 0});
        } else if (period.spanned_by(s)) {
            Segment endless = s.moved(-s.length * s.tangent);
            endless.length *= 3;
            all.push_back({endless, id, 0, s.length, 0});
        } else {
            for (double shift : {0.0, period.length, -period.length})
                all.push_back({s.moved({shift, 0}), id, shift, 0, 0});
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

namespace {

// Ends nearer to each other than this meet.
constexpr double joint = 0.01; // dl
// Plates that turn by more at one corner, or bulge by more within a horizon, are walls of their own.
constexpr double largest_turn = 0.88; // radians: 50 degrees

double turn_between(const Segment &a, const Segment &b) {
    return std::atan2(a.tangent.y() * b.tangent.x() - a.tangent.x() * b.tangent.y(), a.tangent.dot(b.tangent));
}

bool alike(const Plate &a, const Plate &b) {
    return a.spec().friction == b.spec().friction && a.spec().wall_mu == b.spec().wall_mu &&
           a.velocity() == b.velocity() && !a.loaded() && !b.loaded();
}

} // namespace

// Chains of the images in images_.
void Walls::find_chains(double radius, double spacing, bool chained) {
    const auto count = static_cast<int32_t>(images_.size());
    std::vector<int32_t> after(count, -1), before(count, -1), by_x(count);
    links_.assign(plates.size(), {});
    std::iota(by_x.begin(), by_x.end(), 0);
    if (chained) {
        const auto x_of = [&](int32_t k) { return images_[k].segment.origin.x(); };
        std::stable_sort(by_x.begin(), by_x.end(), [&](int32_t a, int32_t b) { return x_of(a) < x_of(b); });
        const double meet = joint * spacing;
        for (int32_t a = 0; a < count; ++a) {
            const Segment &s = images_[a].segment;
            const Vector end = s.origin + s.length * s.tangent;
            auto found = std::lower_bound(by_x.begin(), by_x.end(), end.x() - meet,
                                          [&](int32_t k, double x) { return x_of(k) < x; });
            int32_t next = -1, met = 0;
            for (; found != by_x.end() && x_of(*found) <= end.x() + meet; ++found)
                if ((images_[*found].segment.origin - end).norm() <= meet) {
                    ++met;
                    next = *found;
                }
            if (met != 1 || next == a || images_[next].before > 0 || images_[a].before > 0 || before[next] >= 0 ||
                !alike(plates[images_[a].plate], plates[images_[next].plate]) ||
                std::abs(turn_between(s, images_[next].segment)) > largest_turn)
                continue;
            after[a] = next;
            before[next] = a;
        }
        // A wall that bulges sharply has no inside for ghosts to be seen from all sides.
        for (int32_t a = 0; a < count; ++a) {
            double way = 0, bulge = 0;
            int32_t k = a;
            do {
                const double turn = after[k] < 0 ? 0.0 : turn_between(images_[k].segment, images_[after[k]].segment);
                bulge += turn < 0 ? -turn : 0.0;
                if (bulge > largest_turn && after[k] >= 0) {
                    before[after[k]] = -1;
                    after[k] = -1;
                }
                k = after[k];
                way += k < 0 ? 0.0 : images_[k].segment.length;
            } while (k >= 0 && k != a && way < radius);
        }
        for (int32_t a = 0; a < count; ++a)
            if (after[a] >= 0) {
                links_[images_[a].plate].after = images_[after[a]].plate;
                links_[images_[after[a]].plate].before = images_[a].plate;
            }
    }
    // The first plate in number stands for all images of a chain.
    std::vector<int32_t> root(plates.size());
    std::iota(root.begin(), root.end(), 0);
    const auto find = [&](int32_t p) {
        while (root[p] != p)
            p = root[p] = root[root[p]];
        return p;
    };
    for (std::size_t p = 0; p < plates.size(); ++p)
        if (links_[p].after >= 0) {
            const int32_t a = find(static_cast<int32_t>(p)), b = find(links_[p].after);
            root[std::max(a, b)] = std::min(a, b);
        }
    chains_.clear();
    std::vector<bool> done(count, false);
    for (int32_t a = 0; a < count; ++a) {
        if (done[a])
            continue;
        int32_t first = a;
        while (before[first] >= 0 && before[first] != a)
            first = before[first];
        Chain chain{find(images_[a].plate), {}, {}, before[first] >= 0};
        if (chain.closed)
            first = a;
        for (int32_t k = first; k >= 0 && !done[k]; k = after[k]) {
            done[k] = true;
            chain.members.push_back(k);
            chain.turn.push_back(after[k] < 0 ? 0.0 : turn_between(images_[k].segment, images_[after[k]].segment));
        }
        chains_.push_back(std::move(chain));
    }
    std::stable_sort(chains_.begin(), chains_.end(), [](const Chain &a, const Chain &b) { return a.root < b.root; });
    for (std::size_t c = 0; c < chains_.size(); ++c)
        for (int32_t k : chains_[c].members)
            images_[k].chain = static_cast<int32_t>(c);
}

void Walls::find_nearby(const Particles &particles, const CellGrid &grid, double radius) {
    nearby_.clear();
    nearby_of_image_.assign(images_.size(), -1);
    if (particles.count == 0)
        return;
    for (Plate &plate : plates)
        plate.gap = INFINITY;
    for (std::size_t k = 0; k < images_.size(); ++k) {
        const Nearby &image = images_[k];
        const double gap = box_around(image.segment, radius).gap(grid.box());
        plates[image.plate].gap = std::min(plates[image.plate].gap, gap);
        if (gap <= 0) {
            nearby_of_image_[k] = static_cast<int32_t>(nearby_.size());
            nearby_.push_back(image);
        }
    }
}

// Rows of lattice points behind a chain that lie within reach of the particles' box: each row keeps its distance from the
// wetted line, along which it turns with a fan where the body opens, and is cut at the bisector where it closes.
void Walls::place_chain(const Chain &chain, const CellGrid &grid, double radius, double spacing) {
    const Box &box = grid.box();
    const auto layers = static_cast<int64_t>(std::ceil(radius / spacing));
    const auto count = chain.members.size();
    struct Reach {
        double low, high;
        bool near;
    };
    std::vector<Reach> reach(count);
    bool any = false;
    for (std::size_t m = 0; m < count; ++m) {
        const Segment &s = images_[chain.members[m]].segment;
        double low = INFINITY, high = -INFINITY, near = INFINITY;
        for (double bx : {box.x_min, box.x_max})
            for (double by : {box.y_min, box.y_max}) {
                low = std::min(low, s.along({bx, by}));
                high = std::max(high, s.along({bx, by}));
                near = std::min(near, s.distance({bx, by}));
            }
        reach[m] = {low - radius, high + radius, near <= radius && nearby_of_image_[chain.members[m]] >= 0};
        any |= reach[m].near;
    }
    if (!any)
        return;
    for (int64_t layer = 0; layer < layers; ++layer) {
        const double depth = (static_cast<double>(layer) + 0.5) * spacing;
        const auto cut = [&](double turn) { return turn < 0 ? depth * std::tan(-0.5 * turn) : 0.0; };
        const auto fan = [&](double turn) { return turn > 0 ? depth * turn : 0.0; };
        double step = spacing;
        if (chain.closed) {
            double total = 0;
            for (std::size_t m = 0; m < count; ++m)
                total += images_[chain.members[m]].segment.length - 2 * cut(chain.turn[m]) + fan(chain.turn[m]);
            if (total < spacing)
                continue;
            step = total / std::round(total / spacing);
        }
        // Calls place(s) for the lattice places in [from, to) of the row.
        const auto each = [&](double from, double to, const auto &place) {
            const auto begin = static_cast<int64_t>(std::ceil(from / step - 0.5 - 1e-9));
            const auto end = static_cast<int64_t>(std::ceil(to / step - 0.5 - 1e-9));
            for (int64_t cell = begin; cell < end; ++cell)
                place((static_cast<double>(cell) + 0.5) * step);
        };
        double way = 0; // of the row, to the cut that begins the member
        for (std::size_t m = 0; m < count; ++m) {
            const Segment &s = images_[chain.members[m]].segment;
            const bool first = m == 0 && !chain.closed, last = m + 1 == count && !chain.closed;
            const double begin = first ? 0.0 : cut(chain.turn[m == 0 ? count - 1 : m - 1]);
            const double end = s.length - (last ? 0.0 : cut(chain.turn[m]));
            const double offset = begin - way; // along - way of the row
            // Past the ends the lattice fills corners.
            const double ahead = first ? static_cast<double>(-layers) * spacing : begin;
            const double past =
                last ? (std::ceil(s.length / spacing - 1e-9) + static_cast<double>(layers)) * spacing : end;
            if (reach[m].near)
                each(std::max(ahead, reach[m].low) - offset, std::min(past, reach[m].high) - offset, [&](double at) {
                    const double along = at + offset;
                    const Vector place = s.origin + along * s.tangent - depth * s.normal;
                    candidates_.push_back({nearby_of_image_[chain.members[m]], along, depth, place.x(), place.y(),
                                           s.normal.x(), s.normal.y(), depth, 0, false});
                });
            way += end - begin;
            const double arc = last ? 0.0 : fan(chain.turn[m]);
            if (arc > 0) {
                const std::size_t next = m + 1 == count ? 0 : m + 1;
                const Vector corner = s.origin + s.length * s.tangent;
                each(way, way + arc, [&](double at) {
                    const double angle = (at - way) / depth; // the material's side is on the right: it turns clockwise
                    const std::size_t mine = angle < 0.5 * chain.turn[m] ? m : next;
                    if (!reach[mine].near)
                        return;
                    const double c = std::cos(angle), sine = std::sin(angle);
                    const Vector n(c * s.normal.x() + sine * s.normal.y(), c * s.normal.y() - sine * s.normal.x());
                    const Vector place = corner - depth * n;
                    const Segment &own = images_[chain.members[mine]].segment;
                    candidates_.push_back({nearby_of_image_[chain.members[mine]], own.along(place),
                                           -own.distance(place), place.x(), place.y(), n.x(), n.y(), depth, 0, false});
                });
                way += arc;
            }
        }
    }
}

void Walls::place_candidates(const CellGrid &grid, double radius, double spacing) {
    candidates_.clear();
    for (const Chain &chain : chains_)
        place_chain(chain, grid, radius, spacing);
}

void Walls::find_contacts(const Particles &particles, const CellGrid &grid, const Images &images, double radius,
                          double spacing, bool chained, int threads) {
    const int64_t n = particles.count;
    const double tolerance = 1e-9 * spacing;
    images_of_plates();
    find_chains(radius, spacing, chained);
    find_nearby(particles, grid, radius);
    place_candidates(grid, radius, spacing);

    // The plates about a ghost.
    struct Around {
        std::vector<int32_t> own, own_wide, others; // in nearby_
    };
    // Calls seen(i, plate) for the particles and images that see a candidate; plate: the nearest one of its chain.
    const double allowed = penetration_allowed * spacing;
    const auto visit = [&](const Candidate &ghost, Around &around, const auto &seen) {
        const int32_t chain = nearby_[ghost.nearby].chain;
        const Vector at(ghost.x, ghost.y);
        around.own.clear();
        around.own_wide.clear();
        around.others.clear();
        for (std::size_t q = 0; q < nearby_.size(); ++q) {
            const Segment &segment = nearby_[q].segment;
            const double far = 0.5 * segment.length + 2 * radius;
            if ((segment.origin + 0.5 * segment.length * segment.tangent - at).squaredNorm() > far * far)
                continue;
            const double distance = segment.nearest(at);
            if (distance > 2 * radius)
                continue;
            const auto k = static_cast<int32_t>(q);
            if (nearby_[q].chain == chain) {
                around.own_wide.push_back(k);
                if (distance <= radius + tolerance)
                    around.own.push_back(k);
            } else if (distance <= radius + tolerance)
                around.others.push_back(k);
        }
        // Nearer to another plate of its chain: that one has ghosts of its own there.
        if (around.own.size() > 1)
            for (int32_t q : around.own)
                if (nearby_[q].segment.nearest(at) < ghost.distance - 0.1 * spacing)
                    return;
        if (around.own_wide.empty())
            return;
        for_each_candidate(grid, images, ghost.x, ghost.y, radius, [&](int64_t i) {
            const double dx = particles.x[i] - ghost.x, dy = particles.y[i] - ghost.y;
            if (dx * dx + dy * dy >= radius * radius)
                return;
            Vector from(particles.x[i], particles.y[i]);
            // The first of the chain's plates that the way passes.
            double own_fraction = INFINITY;
            int32_t nearest = -1;
            const auto pass = [&] {
                for (int32_t q : around.own) {
                    const double fraction = crossing(nearby_[q].segment, from, at, tolerance);
                    if (fraction >= 0 && fraction < own_fraction) {
                        own_fraction = fraction;
                        nearest = q;
                    }
                }
            };
            pass();
            if (nearest < 0) { // from slightly behind a plate?
                double best = INFINITY;
                for (int32_t q : around.own_wide) {
                    const double distance = nearby_[q].segment.nearest(from) -
                                            (nearby_[q].segment.distance(from) > 0 ? tolerance : 0.0);
                    if (distance < best) {
                        best = distance;
                        nearest = q;
                    }
                }
                const Segment &own = nearby_[nearest].segment;
                const double d = own.distance(from);
                if (d > 0 || d < -allowed || !own.covers(own.along(from), tolerance))
                    return;
                from += (tolerance - d) * own.normal;
                pass();
                if (own_fraction == INFINITY)
                    return;
            }
            for (int32_t q : around.others) {
                const double fraction = crossing(nearby_[q].segment, from, at, tolerance);
                // What is seen through a corner of two walls, as on the diagonal of a box, is the first one's.
                const double same = nearby_[q].chain < chain ? own_fraction + corner : own_fraction - corner;
                if (fraction >= 0 && fraction < same) // hidden
                    return;
            }
            seen(i, nearby_[nearest].plate);
        });
    };
    const auto candidate_count = static_cast<int64_t>(candidates_.size());
    for_each_block<ghost_block_size>(threads, candidate_count, [&](int64_t, int64_t begin, int64_t end) {
        Around around;
        for (int64_t k = begin; k < end; ++k)
            visit(candidates_[k], around, [&](int64_t i, int32_t) {
                ++candidates_[k].neighbors;
                candidates_[k].seen |= i < n;
            });
    });
    candidates_.erase(std::remove_if(candidates_.begin(), candidates_.end(),
                                     [](const Candidate &candidate) { return !candidate.seen; }),
                      candidates_.end());

    ghost_count = static_cast<int64_t>(candidates_.size());
    ghost_plate.resize(ghost_count);
    ghost_chain.resize(ghost_count);
    if (period)
        ghost_shift.resize(ghost_count);
    for (Field<double> *field :
         {&ghost_along, &ghost_depth, &ghost_nx, &ghost_ny, &ghost_distance, &ghost_x, &ghost_y, &ghost_vx, &ghost_vy, &ghost_axx, &ghost_axy, &ghost_ayy})
        field->resize(ghost_count);
    particles_of_ghost.start.resize(ghost_count + 1);
    particles_of_ghost.start[0] = 0;
    for (int64_t k = 0; k < ghost_count; ++k) {
        const Nearby &nearby = nearby_[candidates_[k].nearby];
        ghost_plate[k] = nearby.plate;
        ghost_chain[k] = chains_[nearby.chain].root;
        ghost_nx[k] = candidates_[k].nx;
        ghost_ny[k] = candidates_[k].ny;
        ghost_distance[k] = candidates_[k].distance;
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
    plate_of_entry.resize(pairs);
    for_each_block<ghost_block_size>(threads, ghost_count, [&](int64_t, int64_t begin, int64_t end) {
        Around around;
        for (int64_t k = begin; k < end; ++k) {
            int64_t next = particles_of_ghost.start[k];
            visit(candidates_[k], around, [&](int64_t i, int32_t plate) {
                particles_of_ghost.index[next] = static_cast<int32_t>(i);
                plate_of_entry[next++] = facing(plate, Vector(particles.x[i], particles.y[i]));
            });
        }
    });

    // The transposed list: ghosts of each particle, in ghost order and so plate by plate.
    fill_.assign(n + 1, 0);
    for (int64_t k = 0; k < pairs; ++k)
        if (particles_of_ghost.index[k] < n)
            ++fill_[particles_of_ghost.index[k] + 1];
    std::partial_sum(fill_.begin(), fill_.end(), fill_.begin());
    ghost_of_contact.resize(fill_[n]);
    plate_of_contact_.resize(fill_[n]);
    for (int64_t k = 0; k < ghost_count; ++k)
        for (int64_t e = particles_of_ghost.start[k]; e < particles_of_ghost.start[k + 1]; ++e)
            if (particles_of_ghost.index[e] < n) {
                const int32_t place = fill_[particles_of_ghost.index[e]]++;
                ghost_of_contact[place] = static_cast<int32_t>(k);
                plate_of_contact_[place] = plate_of_entry[e];
            }
    contacts.clear();
    contact_start.resize(n + 1);
    int64_t entry = 0;
    for (int64_t i = 0; i < n; ++i) {
        contact_start[i] = static_cast<int32_t>(contacts.size());
        while (entry < fill_[i]) { // fill_[i] has become the end of row i
            const int32_t chain = ghost_chain[ghost_of_contact[entry]], plate = plate_of_contact_[entry];
            const int64_t begin = entry;
            while (entry < fill_[i] && ghost_chain[ghost_of_contact[entry]] == chain)
                ++entry;
            contacts.push_back({static_cast<int32_t>(i), plate, chain, begin, entry, 0, 0, 0, 0});
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
