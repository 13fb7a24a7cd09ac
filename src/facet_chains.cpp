#include "facet_chains.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gp {

namespace {

// Plates that turn by more at one corner, or bulge by more within a horizon, are walls of their own.
constexpr double largest_turn = 0.88; // radians: 50 degrees

double turn_between(const Segment &a, const Segment &b) {
    return std::atan2(a.tangent.y() * b.tangent.x() - a.tangent.x() * b.tangent.y(), a.tangent.dot(b.tangent));
}

} // namespace

// Chains follow from where the plates are, and change with it alone unless a host drives them.
bool FacetChains::are_where_they_were(const std::vector<Plate> &plates, const std::vector<FacetImage> &images) {
    const auto same = [](const FacetImage &image, const Segment &segment) {
        return image.segment.origin == segment.origin && image.segment.tangent == segment.tangent;
    };
    if (images.size() == segments_.size() && std::equal(images.begin(), images.end(), segments_.begin(), same) &&
        std::none_of(plates.begin(), plates.end(), [](const Plate &plate) { return plate.driven(); }))
        return true;
    segments_.clear();
    for (const FacetImage &image : images)
        segments_.push_back(image.segment);
    return false;
}

void FacetChains::find(const std::vector<Plate> &plates, const std::vector<Facet> &facets,
                       const std::vector<FacetImage> &images, double reach, double spacing, bool may_join) {
    if (are_where_they_were(plates, images))
        return;
    after_.assign(images.size(), -1);
    before_.assign(images.size(), -1);
    links_.assign(facets.size(), {});
    joints_.clear();
    if (may_join) {
        find_joints(facets, images, spacing);
        for (Joint &at : joints_) {
            at.together = plates[at.plate_before].moves_with(plates[at.plate_after]);
            if (at.together) {
                after_[at.before] = at.after;
                before_[at.after] = at.before;
            }
        }
        cut_bulges(images, reach);
        for (std::size_t a = 0; a < images.size(); ++a)
            if (after_[a] >= 0) {
                links_[images[a].facet].after = images[after_[a]].facet;
                links_[images[after_[a]].facet].before = images[a].facet;
            }
    }
    any_ = std::any_of(after_.begin(), after_.end(), [](int32_t k) { return k >= 0; });
    number_facets();
    line_up(images);
}

// Where one plate alone ends and one alone begins, without a sharp turn. The two sides of a gate, drawn to and fro, have
// beginnings and ends at the same places: what would turn back does not count.
void FacetChains::find_joints(const std::vector<Facet> &facets, const std::vector<FacetImage> &images, double spacing) {
    const double meet = joint * spacing;
    const auto x_of = [&](int32_t k) { return images[k].segment.origin.x(); };
    by_x_.resize(images.size());
    std::iota(by_x_.begin(), by_x_.end(), 0);
    std::sort(by_x_.begin(), by_x_.end(),
              [&](int32_t a, int32_t b) { return x_of(a) != x_of(b) ? x_of(a) < x_of(b) : a < b; });
    arrivals_.assign(images.size(), 0);
    for (std::size_t a = 0; a < images.size(); ++a) {
        const Segment &s = images[a].segment;
        if (images[a].before > 0) // spans the period: has no end
            continue;
        const Vector end = s.origin + s.length * s.tangent;
        auto found = std::lower_bound(by_x_.begin(), by_x_.end(), end.x() - meet,
                                      [&](int32_t k, double x) { return x_of(k) < x; });
        int32_t next = -1, departures = 0;
        for (; found != by_x_.end() && x_of(*found) <= end.x() + meet; ++found) {
            const FacetImage &other = images[*found];
            if (other.before > 0 || *found == static_cast<int32_t>(a) || (other.segment.origin - end).norm() > meet ||
                std::abs(turn_between(s, other.segment)) > largest_turn)
                continue;
            ++arrivals_[*found];
            ++departures;
            next = *found;
        }
        if (departures == 1)
            joints_.push_back({static_cast<int32_t>(a), next, facets[images[a].facet].plate,
                               facets[images[next].facet].plate, false});
    }
    joints_.erase(
        std::remove_if(joints_.begin(), joints_.end(), [&](const Joint &at) { return arrivals_[at.after] > 1; }),
        joints_.end());
}

// A wall that bulges sharply has no inside for ghosts to be seen from all sides.
void FacetChains::cut_bulges(const std::vector<FacetImage> &images, double reach) {
    for (std::size_t a = 0; a < images.size(); ++a) {
        double way = 0, bulge = 0;
        auto k = static_cast<int32_t>(a);
        do {
            const int32_t next = after_[k];
            if (next < 0)
                break;
            bulge += std::max(0.0, -turn_between(images[k].segment, images[next].segment));
            if (bulge > largest_turn) {
                before_[next] = after_[k] = -1;
                break;
            }
            k = next;
            way += images[k].segment.length;
        } while (k != static_cast<int32_t>(a) && way < reach);
    }
}

void FacetChains::number_facets() {
    number_.resize(links_.size());
    std::iota(number_.begin(), number_.end(), 0);
    const auto first_of = [&](int32_t p) {
        while (number_[p] != p)
            p = number_[p] = number_[number_[p]];
        return p;
    };
    for (std::size_t p = 0; p < links_.size(); ++p)
        if (links_[p].after >= 0) {
            const int32_t a = first_of(static_cast<int32_t>(p)), b = first_of(links_[p].after);
            number_[std::max(a, b)] = std::min(a, b);
        }
    for (std::size_t p = 0; p < links_.size(); ++p)
        number_[p] = first_of(static_cast<int32_t>(p));
}

void FacetChains::line_up(const std::vector<FacetImage> &images) {
    chains_.clear();
    members_.clear();
    chain_of_image_.assign(images.size(), -1);
    for (std::size_t a = 0; a < images.size(); ++a) {
        const auto start = static_cast<int32_t>(a);
        if (chain_of_image_[a] >= 0)
            continue;
        int32_t first = start;
        while (before_[first] >= 0 && before_[first] != start)
            first = before_[first];
        const bool closed = before_[first] >= 0;
        Chain chain{number_[images[a].facet], static_cast<int32_t>(members_.size()), 0, 0};
        for (int32_t k = closed ? start : first; k >= 0 && chain_of_image_[k] < 0; k = after_[k]) {
            const auto count = static_cast<int32_t>(members_.size()) - chain.begin;
            if (chain.repeats == 0 && count > 0 && images[k].facet == images[members_[chain.begin].image].facet)
                chain.repeats = count;
            chain_of_image_[k] = 0;
            members_.push_back({k, after_[k] < 0 ? 0.0 : turn_between(images[k].segment, images[after_[k]].segment)});
        }
        chain.end = static_cast<int32_t>(members_.size());
        if (closed)
            chain.repeats = chain.end - chain.begin;
        chains_.push_back(chain);
    }
    std::sort(chains_.begin(), chains_.end(), [](const Chain &a, const Chain &b) {
        return a.number != b.number ? a.number < b.number : a.begin < b.begin;
    });
    for (std::size_t c = 0; c < chains_.size(); ++c)
        for (int32_t m = chains_[c].begin; m < chains_[c].end; ++m)
            chain_of_image_[members_[m].image] = static_cast<int32_t>(c);
}

bool FacetChains::stand(const std::vector<Plate> &plates) const {
    return std::all_of(joints_.begin(), joints_.end(), [&](const Joint &at) {
        const Plate &a = plates[at.plate_before], &b = plates[at.plate_after];
        return (!a.driven() && !b.driven()) || a.moves_with(b) == at.together;
    });
}

// What a row of places at one depth behind a chain is made of.
struct FacetChains::Row {
    const Chain &chain;
    double depth, step; // m
    int64_t layers;
    double spacing;

    // m, by which a bend towards the material cuts the rows of both its plates short, and the arc about one away from it.
    double cut(double turn) const { return turn < 0 ? depth * std::tan(-0.5 * turn) : 0.0; }
    double arc(double turn) const { return turn > 0 ? depth * turn : 0.0; }

    // Calls place(s) for the lattice places in [from, to) of the row.
    template <class Place> void each(double from, double to, const Place &place) const {
        const auto begin = static_cast<int64_t>(std::ceil(from / step - 0.5 - 1e-9));
        const auto end = static_cast<int64_t>(std::ceil(to / step - 0.5 - 1e-9));
        for (int64_t cell = begin; cell < end; ++cell)
            place((static_cast<double>(cell) + 0.5) * step);
    }
};

bool FacetChains::find_reaches(const Chain &chain, const std::vector<FacetImage> &images, const Box &box,
                               double radius) {
    reaches_.clear();
    bool any = false;
    for (int32_t m = chain.begin; m < chain.end; ++m) {
        const FacetImage &image = images[members_[m].image];
        Reach reach{0, 0, image.near};
        if (image.near) {
            double low = INFINITY, high = -INFINITY, near = INFINITY;
            for (double bx : {box.x_min, box.x_max})
                for (double by : {box.y_min, box.y_max}) {
                    low = std::min(low, image.segment.along({bx, by}));
                    high = std::max(high, image.segment.along({bx, by}));
                    near = std::min(near, image.segment.distance({bx, by}));
                }
            reach = {low - radius, high + radius, near <= radius};
        }
        any |= reach.near;
        reaches_.push_back(reach);
    }
    return any;
}

void FacetChains::add_row(const Row &row, const std::vector<FacetImage> &images, std::vector<WallPlace> &places) const {
    const Chain &chain = row.chain;
    const int32_t count = chain.end - chain.begin;
    const bool closed = chain.repeats == count;
    const Member *members = members_.data() + chain.begin;
    double way = 0; // of the row, to where the member's part begins
    for (int32_t m = 0; m < count; ++m) {
        const int32_t image = members[m].image;
        const Segment &s = images[image].segment;
        const bool first = m == 0 && !closed, last = m + 1 == count && !closed;
        const double begin = first ? 0.0 : row.cut(members[m == 0 ? count - 1 : m - 1].turn);
        const double end = s.length - (last ? 0.0 : row.cut(members[m].turn));
        const double offset = begin - way; // along - way of the row
        if (reaches_[m].near) {
            // Past the ends the lattice fills corners.
            const double beyond = static_cast<double>(row.layers) * row.spacing;
            const double from = first ? -beyond : begin;
            const double to = last ? std::ceil(s.length / row.spacing - 1e-9) * row.spacing + beyond : end;
            row.each(std::max(from, reaches_[m].low) - offset, std::min(to, reaches_[m].high) - offset, [&](double at) {
                const Vector place = s.origin + (at + offset) * s.tangent - row.depth * s.normal;
                places.push_back(
                    {image, at + offset, row.depth, place.x(), place.y(), s.normal.x(), s.normal.y(), row.depth, 0});
            });
        }
        way += end - begin;
        const double arc = last ? 0.0 : row.arc(members[m].turn);
        if (arc <= 0)
            continue;
        const int32_t next = m + 1 == count ? 0 : m + 1;
        if (reaches_[m].near || reaches_[next].near)
            row.each(way, way + arc, [&](double at) {
                const double angle = (at - way) / row.depth; // clockwise from the normal
                const int32_t mine = angle < 0.5 * members[m].turn ? m : next;
                if (!reaches_[mine].near)
                    return;
                const double c = std::cos(angle), sine = std::sin(angle);
                const Vector n(c * s.normal.x() + sine * s.normal.y(), c * s.normal.y() - sine * s.normal.x());
                const Vector place = s.origin + s.length * s.tangent - row.depth * n;
                const Segment &own = images[members[mine].image].segment;
                places.push_back({members[mine].image, own.along(place), -own.distance(place), place.x(), place.y(),
                                  n.x(), n.y(), row.depth, own.tangent.dot(n)});
            });
        way += arc;
    }
}

void FacetChains::add_places(const Chain &chain, const std::vector<FacetImage> &images, const Box &box, double radius,
                             double spacing, std::vector<WallPlace> &places) {
    if (!find_reaches(chain, images, box, radius))
        return;
    const auto layers = static_cast<int64_t>(std::ceil(radius / spacing));
    for (int64_t layer = 0; layer < layers; ++layer) {
        Row row{chain, (static_cast<double>(layer) + 0.5) * spacing, spacing, layers, spacing};
        if (chain.repeats > 0) { // so does its lattice
            double total = 0;
            for (int32_t m = chain.begin; m < chain.begin + chain.repeats; ++m) {
                const double turn = members_[m].turn;
                total += images[members_[m].image].segment.length - 2 * row.cut(turn) + row.arc(turn);
            }
            if (total < spacing)
                continue;
            row.step = total / std::round(total / spacing);
        }
        add_row(row, images, places);
    }
}

int64_t FacetChains::bytes() const {
    const auto of = [](const auto &vector) {
        return static_cast<int64_t>(vector.capacity() * sizeof(typename std::decay_t<decltype(vector)>::value_type));
    };
    return of(segments_) + of(joints_) + of(before_) + of(after_) + of(by_x_) + of(arrivals_) + of(links_) +
           of(number_) + of(members_) + of(chains_) + of(chain_of_image_) + of(reaches_);
}

} // namespace gp
