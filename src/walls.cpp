#include "walls.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "parallel.hpp"
#include "sight.hpp"

namespace gp {

int64_t Walls::bytes() const {
    int64_t total =
        particles_of_ghost.bytes() + lanes.bytes() + chains_.bytes() + cells_.bytes() + barriers_.cells.bytes();
    for (const Field<double> *field :
         {&ghost_along, &ghost_depth, &ghost_nx, &ghost_ny, &ghost_lean, &ghost_distance, &ghost_shift, &ghost_x,
          &ghost_y, &ghost_vx, &ghost_vy, &ghost_axx, &ghost_axy, &ghost_ayy})
        total += static_cast<int64_t>(field->capacity() * sizeof(double));
    for (const Field<int32_t> *field : {&ghost_facet, &ghost_chain, &wall_particle, &ghost_of_contact, &contact_start,
                                        &passed_, &about_, &passed_of_contact_})
        total += static_cast<int64_t>(field->capacity() * sizeof(int32_t));
    return total + static_cast<int64_t>(
                       contacts.capacity() * sizeof(Contact) + candidates_.capacity() * sizeof(Candidate) +
                       places_.capacity() * sizeof(WallPlace) + images_.capacity() * sizeof(FacetImage) +
                       barriers_.segments.capacity() * sizeof(Segment) + has_behind_.capacity() * sizeof(double));
}

void Walls::make_facets(const Scene &scene) {
    facets.clear();
    for (std::size_t p = 0; p < scene.plates().size(); ++p) {
        const PlateSpec &spec = scene.plates()[p];
        for (std::size_t k = 0; k < spec.segments.size(); ++k)
            facets.push_back({&spec, static_cast<int32_t>(p), static_cast<int32_t>(k), spec.segments[k]});
    }
}

void Walls::place_facets() {
    auto facet = facets.begin();
    for (const Plate &plate : plates) {
        const Placing placing = plate.placing();
        for (const Segment &segment : plate.spec().segments)
            (facet++)->segment = placing.of(segment);
    }
}

void Walls::place_plates(double time, double dt) {
    auto facet = facets.begin();
    for (Plate &plate : plates) {
        const Pose before = plate.placed();
        plate.place(time, dt);
        const std::vector<Segment> &segments = plate.spec().segments;
        if (plate.placed() == before) {
            facet += static_cast<std::ptrdiff_t>(segments.size());
            continue;
        }
        const Placing placing = plate.placing();
        for (const Segment &segment : segments)
            (facet++)->segment = placing.of(segment);
    }
}

void Walls::add_load(int32_t facet, const Vector &at, const Vector &force) {
    const Facet &f = facets[facet];
    Plate &plate = plates[f.plate];
    const auto moment = [&](const Vector &arm) { return arm.x() * force.y() - arm.y() * force.x(); };
    const Segment &s = f.segment, &first = facets[facet - f.number].segment;
    const Vector image = nearest_image(s, at);
    const double torque = s.along(image) * moment(s.tangent) + moment(s.origin - first.origin);
    plate.load.add(Lanes{force.x(), force.y(), torque, moment(image - plate.pivot())},
                   Lanes{load_scale.force, load_scale.force, load_scale.torque, load_scale.torque});
}

// A facet, and in a periodic scene its images across the ends. One that spans the period has no end: it is one long
// segment, that begins a period before its end 0.
const std::vector<FacetImage> &Walls::images_of_facets() {
    std::vector<FacetImage> &all = images_;
    all.clear();
    for (std::size_t f = 0; f < facets.size(); ++f) {
        const Segment &s = facets[f].segment;
        const auto id = static_cast<int32_t>(f);
        if (!period) {
            all.push_back({s, id, 0, 0, false});
        } else if (period.spanned_by(s)) {
            Segment endless = s.moved(-s.length * s.tangent);
            endless.length *= 3;
            all.push_back({endless, id, 0, s.length, false});
        } else {
            for (double shift : {0.0, period.length, -period.length})
                all.push_back({s.moved({shift, 0}), id, shift, 0, false});
        }
    }
    return all;
}

const Barriers &Walls::barriers(const Particles &particles, const CellGrid &grid, double radius, Crossing *crossing) {
    std::vector<Segment> &found = barriers_.segments;
    found.clear();
    has_behind_.clear();
    for (const FacetImage &image : images_of_facets()) {
        has_behind_.push_back(0);
        const Segment &s = image.segment;
        const Box box = box_around(s, radius);
        if (particles.count == 0 || box.gap(grid.box()) > 0)
            continue;
        const double allowed = penetration_allowed * std::sqrt(particles.volume);
        bool behind = false;
        grid.for_each_run(box, [&](int64_t begin, int64_t end) {
            for (int64_t i = begin; i < end && !behind; ++i) {
                const Vector r(particles.x[i], particles.y[i]);
                behind = s.distance(r) < -allowed && s.nearest_square(r) < radius * radius;
            }
        });
        has_behind_.back() = behind ? 1 : 0;
    }
    if (crossing)
        crossing->combine(has_behind_.data(), static_cast<int>(has_behind_.size()), nullptr, 0);
    for (std::size_t k = 0; k < has_behind_.size(); ++k)
        if (has_behind_[k] > 0)
            found.push_back(images_[k].segment);
    barriers_.cells.sort(
        static_cast<int64_t>(found.size()), [&](int64_t k) { return &found[k]; }, grid.box(), radius);
    return barriers_;
}

void Walls::find_near(const Box &everywhere, double radius) {
    for (Plate &plate : plates)
        plate.gap = INFINITY;
    for (FacetImage &image : images_) {
        const double gap = box_around(image.segment, radius).gap(everywhere);
        Plate &plate = plates[facets[image.facet].plate];
        plate.gap = std::min(plate.gap, gap);
        image.near = gap <= 0;
    }
}

void Walls::place_candidates(const Box &about, double radius, double spacing) {
    places_.clear();
    for (const FacetChains::Chain &chain : chains_.all())
        if (about.x_min <= about.x_max) // there are particles
            chains_.add_places(chain, images_, about, radius, spacing, places_);
    candidates_.assign(places_.size(), {0, 0, false});
}

namespace {

// Calls found(i) for the particles and images within `radius` of a place.
template <class Found>
void for_each_within(const Particles &particles, const CellGrid &grid, const Images &images, const WallPlace &at,
                     double radius, const Found &found) {
    for_each_candidate(grid, images, at.x, at.y, radius, [&](int64_t i) {
        const double dx = particles.x[i] - at.x, dy = particles.y[i] - at.y;
        if (dx * dx + dy * dy < radius * radius)
            found(i);
    });
}

} // namespace

// Who sees each candidate: in reach of it first, which tells the room needed, then those whose way to it is free.
void Walls::find_seeing(const Particles &particles, const CellGrid &grid, const Images &images, double radius,
                        double spacing, bool images_count, int threads) {
    const auto count = static_cast<int64_t>(candidates_.size());
    for_each_block<ghost_block_size>(threads, count, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t k = begin; k < end; ++k)
            for_each_within(particles, grid, images, places_[k], radius, [&](int64_t) { ++candidates_[k].neighbors; });
    });
    int64_t entries = 0;
    for (Candidate &candidate : candidates_) {
        candidate.first = entries;
        entries += candidate.neighbors;
    }
    Field<int32_t> &seeing = particles_of_ghost.index;
    seeing.resize(entries);
    const bool several = chains_.any(); // else what passes a chain passes its only facet
    passed_.resize(several ? entries : 0);
    const int64_t room = cells_.longest();
    about_.resize(room * block_count<ghost_block_size>(count));
    for_each_block<ghost_block_size>(threads, count, [&](int64_t block, int64_t begin, int64_t end) {
        Sight sight{images_, chains_, radius, spacing, about_.data() + room * block, room};
        for (int64_t k = begin; k < end; ++k) {
            Candidate &ghost = candidates_[k];
            if (ghost.neighbors == 0)
                continue;
            ghost.neighbors = 0;
            if (!sight.look_about(places_[k], cells_))
                continue;
            for_each_within(particles, grid, images, places_[k], radius, [&](int64_t i) {
                const int32_t image = sight.seen_through(places_[k], {particles.x[i], particles.y[i]});
                if (image < 0)
                    return;
                const int64_t entry = ghost.first + ghost.neighbors++;
                seeing[entry] = static_cast<int32_t>(i);
                if (several)
                    passed_[entry] = images_[image].facet;
                ghost.seen |= images_count || i < particles.count;
            });
        }
    });
}

// Candidates that a particle sees become ghosts; what sees them moves together.
void Walls::keep_seen() {
    std::size_t kept = 0;
    int64_t entries = 0;
    for (std::size_t k = 0; k < candidates_.size(); ++k) {
        if (!candidates_[k].seen)
            continue;
        candidates_[kept] = candidates_[k];
        places_[kept] = places_[k];
        Candidate &ghost = candidates_[kept++];
        for (Field<int32_t> *rows : {&particles_of_ghost.index, &passed_})
            if (!rows->empty())
                std::copy_n(rows->begin() + ghost.first, ghost.neighbors, rows->begin() + entries);
        ghost.first = entries;
        entries += ghost.neighbors;
    }
    candidates_.resize(kept);
    places_.resize(kept);
    particles_of_ghost.index.resize(entries);
    ghost_count = static_cast<int64_t>(candidates_.size());
    ghosts_placed = false;
    ghost_facet.resize(ghost_count);
    ghost_chain.resize(ghost_count);
    if (period)
        ghost_shift.resize(ghost_count);
    for (Field<double> *field : {&ghost_along, &ghost_depth, &ghost_nx, &ghost_ny, &ghost_lean, &ghost_distance,
                                 &ghost_x, &ghost_y, &ghost_vx, &ghost_vy, &ghost_axx, &ghost_axy, &ghost_ayy})
        field->resize(ghost_count);
    particles_of_ghost.start.resize(ghost_count + 1);
    particles_of_ghost.start[0] = 0;
    for (int64_t k = 0; k < ghost_count; ++k) {
        const WallPlace &place = places_[k];
        const FacetImage &image = images_[place.image];
        ghost_facet[k] = image.facet;
        ghost_chain[k] = chains_.chain_of(place.image).number;
        if (period)
            ghost_shift[k] = image.shift;
        ghost_along[k] = place.along - image.before;
        ghost_depth[k] = place.depth;
        ghost_nx[k] = place.nx;
        ghost_ny[k] = place.ny;
        ghost_lean[k] = place.lean;
        ghost_distance[k] = place.distance;
        ghost_x[k] = place.x;
        ghost_y[k] = place.y;
        particles_of_ghost.start[k + 1] = particles_of_ghost.start[k] + candidates_[k].neighbors;
    }
}

// The transposed list: ghosts of each particle, in ghost order and so chain by chain.
void Walls::make_contacts(const Particles &particles) {
    const int64_t n = particles.count;
    // First the ghosts of each particle, then its contacts, of which there are no more.
    contact_start.assign(n + 1, 0);
    for (const int32_t i : particles_of_ghost.index)
        if (i < n)
            ++contact_start[i + 1];
    std::partial_sum(contact_start.begin(), contact_start.end(), contact_start.begin());
    ghost_of_contact.resize(contact_start[n]);
    passed_of_contact_.resize(passed_.empty() ? 0 : contact_start[n]);
    for (int64_t k = 0; k < ghost_count; ++k)
        for (int64_t e = particles_of_ghost.start[k]; e < particles_of_ghost.start[k + 1]; ++e)
            if (const int32_t i = particles_of_ghost.index[e]; i < n) {
                const int32_t place = contact_start[i]++; // becomes the end of row i
                ghost_of_contact[place] = static_cast<int32_t>(k);
                if (!passed_.empty())
                    passed_of_contact_[place] = passed_[e];
            }
    contacts.clear();
    int32_t entry = 0;
    for (int64_t i = 0; i < n; ++i) {
        const int32_t row_end = contact_start[i];
        contact_start[i] = static_cast<int32_t>(contacts.size());
        while (entry < row_end) {
            const int32_t begin = entry, chain = ghost_chain[ghost_of_contact[entry]];
            while (entry < row_end && ghost_chain[ghost_of_contact[entry]] == chain)
                ++entry;
            add_contacts(particles, i, begin, entry);
        }
    }
    contact_start[n] = static_cast<int32_t>(contacts.size());
}

// A particle's contacts with one chain: one for what it sees through facets that turn by less than a right angle, which is all
// but in a narrow groove.
void Walls::add_contacts(const Particles &particles, int64_t i, int32_t begin, int32_t end) {
    while (begin < end) {
        int32_t stop = end;
        const int32_t passed =
            passed_of_contact_.empty() ? ghost_facet[ghost_of_contact[begin]] : passed_of_contact_[begin];
        if (chains_.joined(passed)) {
            const Vector &tangent = facets[passed].segment.tangent;
            stop = begin;
            for (int32_t k = begin; k < end; ++k)
                if (tangent.dot(facets[passed_of_contact_[k]].segment.tangent) > 0) {
                    std::rotate(ghost_of_contact.begin() + stop, ghost_of_contact.begin() + k,
                                ghost_of_contact.begin() + k + 1);
                    std::rotate(passed_of_contact_.begin() + stop, passed_of_contact_.begin() + k,
                                passed_of_contact_.begin() + k + 1);
                    ++stop;
                }
        }
        const int32_t facet = facing(passed, Vector(particles.x[i], particles.y[i]));
        contacts.push_back(
            {static_cast<int32_t>(i), facet, facet, ghost_chain[ghost_of_contact[begin]], begin, stop, 0, 0, 0, 0});
        begin = stop;
    }
}

void Walls::find_contacts(const Particles &particles, const CellGrid &grid, const Images &images, const Box &everywhere,
                          double radius, double beyond, double reach, double spacing, bool may_join, int threads) {
    images_of_facets();
    find_near(everywhere, radius);
    chains_.find(plates, facets, images_, reach, spacing, may_join);
    const Box &own = grid.box();
    const Box about{own.x_min - beyond, own.x_max + beyond, own.y_min - beyond, own.y_max + beyond};
    place_candidates(about, radius, spacing);
    cells_.sort(
        static_cast<int64_t>(images_.size()),
        [&](int64_t k) { return images_[k].near ? &images_[k].segment : nullptr; }, about,
        radius + penetration_allowed * spacing);
    find_seeing(particles, grid, images, radius, spacing, beyond > 0, threads);
    keep_seen();
    make_contacts(particles);
}

// The facet of the chain that is nearest to a place, going from one to the next.
int32_t Walls::facing(int32_t facet, const Vector &at) const {
    while (chains_.joined(facet)) {
        const Segment &s = facets[facet].segment;
        const Vector image = nearest_image(s, at);
        const FacetChains::Link &link = chains_.link(facet);
        const int32_t other = s.along(image) < 0.5 * s.length ? link.before : link.after;
        if (other < 0)
            break;
        const Segment &next = facets[other].segment;
        if (next.nearest_square(nearest_image(next, at)) >= s.nearest_square(image))
            break;
        facet = other;
    }
    return facet;
}

// From where it was when the lists were made, so that a run that goes on from a checkpoint finds the same.
void Walls::face_facets(const Particles &particles) {
    if (!chains_.any())
        return;
    for (Contact &contact : contacts)
        contact.facet =
            facing(contact.listed_facet, Vector(particles.x[contact.particle], particles.y[contact.particle]));
}

int64_t Walls::contact_of(int64_t i, int64_t ghost) const {
    int64_t found = -1;
    double most = -INFINITY;
    for (int32_t c = contact_start[i]; c < contact_start[i + 1]; ++c) {
        if (const double here = alike(contacts[c].chain, contacts[c].listed_facet, ghost); here > most) {
            most = here;
            found = c;
        }
    }
    return found;
}

void Walls::find_wall_particles(double spacing) {
    wall_particle.resize(ghost_count);
    // Ghosts are in order of facet, layer and place along the facet.
    int64_t first = 0, last = 0; // wall particles of this facet
    for (int64_t k = 0; k < ghost_count; ++k) {
        const bool new_facet = k == 0 || ghost_facet[k] != ghost_facet[k - 1];
        if (new_facet) {
            const double length = facets[ghost_facet[k]].segment.length;
            const auto usable = [&](int64_t g) {
                return g < ghost_count && ghost_facet[g] == ghost_facet[k] && ghost_depth[g] < spacing;
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
    ghosts_placed = true;
    for_each_block<ghost_block_size>(threads, ghost_count, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t k = begin; k < end; ++k) {
            const Segment &s = facets[ghost_facet[k]].segment;
            const Vector at = s.origin + ghost_along[k] * s.tangent - ghost_depth[k] * s.normal;
            ghost_x[k] = at.x() + (ghost_shift.empty() ? 0.0 : ghost_shift[k]);
            ghost_y[k] = at.y();
            if (plate_of(ghost_facet[k]).may_turn()) {
                const double lean = ghost_lean[k], across = std::sqrt(1 - lean * lean);
                ghost_nx[k] = across * s.normal.x() + lean * s.tangent.x();
                ghost_ny[k] = across * s.normal.y() + lean * s.tangent.y();
            }
        }
    });
}

} // namespace gp
