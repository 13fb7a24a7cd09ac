#include "scene_falls.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

namespace gp {

namespace {

// A blow needs some depth to compress: fewer rows than this are stopped one by one (blocks of 1, 3, 5, 10 rows at 0.1 sound
// speeds: by 0, .06, .08, .2 where they are densest).
constexpr double least_rows = 3;
// Gaps of up to this beyond the lattice's own, in dl, are no fall.
constexpr double standing_gap = 1;
// A plate that faces up by less than this (cosine) bears nothing.
constexpr double least_rise = 0.01;
// Width of the strips along gravity, in dl: each has a whole row of a lattice in it, also of one jittered by half a spacing.
constexpr double strip_width = 2;
// Images of the plates on each side of the period, at most.
constexpr double most_images = 64;

bool may_move(const PlateSpec &plate) {
    return plate.motion.any() || !plate.table.empty();
}

// The scene in strips along gravity.
class Strips {
public:
    Strips(const Scene &scene, bool with_moving_plates) : scene_(scene) {
        const Vector gravity(scene.config().gravity_x, scene.config().gravity_y);
        up_ = -gravity.normalized();
        across_ = Vector(-up_.y(), up_.x());
        find_strips();
        if (scene.particle_count() <= most_items)
            collect(-INFINITY, INFINITY, scene.particle_count(), all_);
        for_each_segment(scene, [&](int32_t plate, const Segment &segment) {
            const PlateSpec &spec = scene.plates()[plate];
            if (with_moving_plates || !may_move(spec))
                add_images(plate, segment);
        });
        std::sort(surfaces_.begin(), surfaces_.end(),
                  [](const Surface &a, const Surface &b) { return a.strip < b.strip; });
    }

    struct Item {
        double strip; // number: a whole one
        double across, height;
        int32_t particle, body;
    };
    // A plate that faces up, in one strip.
    struct Surface {
        double strip;
        int32_t plate;
        Segment segment;
        double rise; // cosine
    };
    double height_of(const Surface &s, const Item &item) const {
        return up_.dot(s.segment.origin) + up_.dot(s.segment.tangent) / across_.dot(s.segment.tangent) *
                                               (item.across - across_.dot(s.segment.origin));
    }
    const Vector &up() const { return up_; }

    // Calls visit(items, end, surfaces, end) for each strip with material; items from the lowest to the highest.
    template <class Visit> void for_each(const Visit &visit) const {
        auto surface = surfaces_.begin();
        if (!all_.empty()) {
            visit_strips(all_, surface, visit);
            return;
        }
        const int64_t most = std::max(most_items, scene_.particle_count() / most_passes);
        std::vector<Item> items;
        for (auto first = strips_.begin(); first != strips_.end();) {
            int64_t count = 0;
            auto next = first;
            while (next != strips_.end() && (next == first || count + next->particles <= most))
                count += (next++)->particles;
            collect(first->number, (next - 1)->number, count, items);
            visit_strips(items, surface, visit);
            first = next;
        }
    }

private:
    // So many particles are sorted at a time, or that part of all that takes so many passes over them.
    static constexpr int64_t most_items = 1 << 20, most_passes = 8;
    struct Strip {
        double number;
        int64_t particles;
    };

    template <class Visit>
    void visit_strips(const std::vector<Item> &items, std::vector<Surface>::const_iterator &surface,
                      const Visit &visit) const {
        for (auto begin = items.begin(); begin != items.end();) {
            const double strip = begin->strip;
            auto end = begin;
            while (end != items.end() && end->strip == strip)
                ++end;
            while (surface != surfaces_.end() && surface->strip < strip)
                ++surface;
            auto last = surface;
            while (last != surfaces_.end() && last->strip == strip)
                ++last;
            visit(begin, end, surface, last);
            begin = end;
        }
    }

    double strip_of(double across) const { return std::floor(across / (strip_width * scene_.config().spacing)); }

    void find_strips() {
        std::unordered_map<double, int64_t> particles;
        scene_.for_each_particle([&](int64_t, int32_t, const Vector &r) {
            const double across = across_.dot(r);
            ++particles[strip_of(across)];
            low_ = std::min(low_, across);
            high_ = std::max(high_, across);
        });
        for (const auto &[number, count] : particles)
            strips_.push_back({number, count});
        std::sort(strips_.begin(), strips_.end(), [](const Strip &a, const Strip &b) { return a.number < b.number; });
    }

    // The particles of the strips from the first to the last.
    void collect(double first, double last, int64_t count, std::vector<Item> &items) const {
        items.clear();
        items.reserve(static_cast<std::size_t>(count));
        scene_.for_each_particle([&](int64_t id, int32_t body, const Vector &r) {
            const double across = across_.dot(r), strip = strip_of(across);
            if (strip >= first && strip <= last)
                items.push_back({strip, across, up_.dot(r), static_cast<int32_t>(id), body});
        });
        std::sort(items.begin(), items.end(), [](const Item &a, const Item &b) {
            return std::tie(a.strip, a.height, a.particle) < std::tie(b.strip, b.height, b.particle);
        });
    }

    void add_images(int32_t plate, const Segment &segment) {
        const Period period = scene_.period();
        const double shift = std::abs(across_.x()) * period.length;
        const double extent = segment.length * std::abs(across_.dot(segment.tangent));
        const double middle = across_.dot(segment.origin + 0.5 * segment.length * segment.tangent);
        const double far = std::max(std::abs(low_ - middle), std::abs(high_ - middle)) + extent;
        const auto images = static_cast<int>(shift > 0 ? std::min(most_images, std::ceil(far / shift)) : 0);
        for (int k = -images; k <= images; ++k)
            add(plate, segment.moved({k * period.length, 0}));
    }
    void add(int32_t plate, const Segment &segment) {
        const double rise = up_.dot(segment.normal);
        if (rise < least_rise)
            return;
        const double a = across_.dot(segment.origin), b = a + segment.length * across_.dot(segment.tangent);
        auto strip = std::lower_bound(strips_.begin(), strips_.end(), strip_of(std::min(a, b)),
                                      [](const Strip &one, double number) { return one.number < number; });
        for (const double last = strip_of(std::max(a, b)); strip != strips_.end() && strip->number <= last; ++strip)
            surfaces_.push_back({strip->number, plate, segment, rise});
    }

    const Scene &scene_;
    Vector up_, across_;
    double low_ = INFINITY, high_ = -INFINITY; // of the material, across
    std::vector<Strip> strips_;                // that have material
    std::vector<Item> all_;                    // of no more than are sorted at a time
    std::vector<Surface> surfaces_;            // by strip
};

// The hardest blow by falling. Of a body that stands on something only what is between the places where it does can fall, as
// through the opening of a hopper: the face of a column on an incline overhangs, and is held by what is behind it. Nor does
// a body fall on itself: a set of particles may have holes.
class Falls {
public:
    Falls(const Scene &scene, bool with_moving_plates, Impact &hardest)
        : scene_(scene), spacing_(scene.config().spacing),
          gravity_(std::hypot(scene.config().gravity_x, scene.config().gravity_y)), hardest_(hardest),
          strips_(scene, with_moving_plates), base_(scene.bodies().size()) {}

    void find() {
        for_each_landing([&](const Strips::Item &item, const Landing &landing, double) {
            if (landing.fall > 0)
                return;
            Base &base = base_[item.body];
            base.first = std::min(base.first, item.strip);
            base.last = std::max(base.last, item.strip);
        });
        for_each_landing([&](const Strips::Item &item, const Landing &landing, double pile) {
            const int32_t body = item.body;
            const Base &base = base_[body];
            const bool stands = base.first <= base.last, is_within = item.strip > base.first && item.strip < base.last;
            if (landing.fall > 0 && pile >= (least_rows - 1.5) * spacing_ && (!stands || is_within) &&
                landing.onto != body)
                meet(item, landing);
        });
    }

private:
    struct Base { // strips where a body stands on a plate or another body
        double first = INFINITY, last = -INFINITY;
    };
    struct Landing {
        double fall = 0; // m; 0: it stands
        int32_t plate = -1, onto = -1;
        Vector normal;
    };

    // Calls visit(item, landing, pile) for the items that do not stand on one of their own body and have something beneath;
    // pile: m, the height of what stands on them without a gap.
    template <class Visit> void for_each_landing(const Visit &visit) const {
        strips_.for_each([&](auto item, auto end, auto surface, auto last) {
            double fall = 0; // m, of the item before
            for (auto begin = item; item != end; ++item) {
                const bool lowest = item == begin;
                const int32_t beneath_body = lowest ? -1 : (item - 1)->body;
                const double gap = lowest ? INFINITY : item->height - (item - 1)->height - spacing_;
                const bool stands = gap <= standing_gap * spacing_;
                if (stands && beneath_body == item->body)
                    continue;        // and falls with it
                auto beneath = last; // the highest plate above the item before
                double top = lowest ? -INFINITY : (item - 1)->height;
                for (auto s = surface; s != last && !stands; ++s)
                    if (const double height = strips_.height_of(*s, *item); height > top && height <= item->height) {
                        top = height;
                        beneath = s;
                    }
                if (beneath != last) {
                    const double apart = (item->height - top) * beneath->rise - 0.5 * spacing_;
                    fall = apart > standing_gap * spacing_ ? apart / beneath->rise : 0;
                    visit(*item, Landing{fall, beneath->plate, -1, beneath->segment.normal}, pile_from(item, end));
                } else if (!lowest) {
                    fall += stands ? 0 : gap;
                    visit(*item, Landing{fall, -1, beneath_body, strips_.up()}, pile_from(item, end));
                } else
                    fall = 0;
            }
        });
    }

    template <class Iterator> double pile_from(Iterator item, Iterator end) const {
        const double base = item->height;
        while (item + 1 != end && (item + 1)->height - item->height <= (1 + standing_gap) * spacing_)
            ++item;
        return item->height - base;
    }
    void meet(const Strips::Item &item, const Landing &landing) {
        const double down = -strips_.up().dot(scene_.velocity(scene_.bodies()[item.body], item.particle));
        double speed = std::sqrt(down * down + 2 * gravity_ * landing.fall) * strips_.up().dot(landing.normal);
        if (landing.plate >= 0)
            speed += std::max(0.0, landing.normal.dot(scene_.plates()[landing.plate].motion.velocity));
        if (speed > hardest_.speed)
            hardest_ = {speed, landing.fall, item.body, landing.plate, landing.onto};
    }

    const Scene &scene_;
    double spacing_, gravity_; // m, m/s2
    Impact &hardest_;
    Strips strips_;
    std::vector<Base> base_; // of bodies
};

// A body as a disc with its mean velocity.
struct Disc {
    Vector centre = Vector::Zero(), velocity = Vector::Zero();
    double radius = 0;
};

std::vector<Disc> discs_of(const Scene &scene) {
    std::vector<Disc> discs;
    for (const Body &body : scene.bodies()) {
        Disc disc;
        const double share = 1 / static_cast<double>(body.count);
        for (int64_t i = body.first; i < body.first + body.count; ++i) {
            disc.centre += share * scene.position(body, i);
            disc.velocity += share * scene.velocity(body, i);
        }
        for (int64_t i = body.first; i < body.first + body.count; ++i)
            disc.radius = std::max(disc.radius, (scene.position(body, i) - disc.centre).norm());
        discs.push_back(disc);
    }
    return discs;
}

// Blows by the velocities with which bodies begin, as if nothing else changed them: of a body on a plate in front of it, and of
// two on each other, where each is stopped from half of what they differ by.
void find_throws(const Scene &scene, Impact &hardest) {
    const std::vector<Disc> discs = discs_of(scene);
    const double spacing = scene.config().spacing;
    const auto is_body = [&](std::size_t k) {
        return static_cast<double>(scene.bodies()[k].count) >= least_rows * least_rows;
    };
    for (std::size_t k = 0; k < discs.size(); ++k) {
        const Disc &disc = discs[k];
        if (!is_body(k))
            continue;
        if (disc.velocity != Vector::Zero())
            for_each_segment(scene, [&](int32_t plate, const Segment &s) {
                const Vector relative = disc.velocity - scene.plates()[plate].motion.velocity;
                const double speed = -s.normal.dot(relative), apart = s.distance(disc.centre);
                if (speed <= hardest.speed || apart <= 0)
                    return;
                const double along = s.along(disc.centre + (apart / speed) * relative);
                if (s.beyond(along) < disc.radius)
                    hardest = {speed, 0, static_cast<int32_t>(k), plate, -1};
            });
        for (std::size_t other = 0; other < k; ++other) {
            if (!is_body(other))
                continue;
            const Vector relative = disc.velocity - discs[other].velocity, apart = discs[other].centre - disc.centre;
            const double speed = relative.norm(), reach = disc.radius + discs[other].radius + spacing;
            if (0.5 * speed <= hardest.speed || apart.dot(relative) <= 0)
                continue;
            const double missed = std::abs(apart.x() * relative.y() - apart.y() * relative.x()) / speed;
            if (missed < reach)
                hardest = {0.5 * speed, 0, static_cast<int32_t>(k), -1, static_cast<int32_t>(other)};
        }
    }
}

bool has_gravity(const Scene &scene) {
    return scene.config().gravity_x != 0 || scene.config().gravity_y != 0;
}

} // namespace

Impact hardest_impact(const Scene &scene) {
    Impact hardest;
    if (has_gravity(scene)) {
        Falls(scene, true, hardest).find();
        if (std::any_of(scene.plates().begin(), scene.plates().end(), may_move))
            Falls(scene, false, hardest).find();
    }
    find_throws(scene, hardest);
    return hardest;
}

std::vector<double> borne_shares(const Scene &scene) {
    std::vector<double> shares(scene.bodies().size(), 1.0);
    const gp_config &config = scene.config();
    if (!has_gravity(scene) || (scene.period() && std::abs(config.gravity_y) < least_rise * std::abs(config.gravity_x)))
        return shares;
    const Strips strips(scene, true);
    std::vector<double> borne(shares.size(), 0.0);
    std::map<std::pair<int32_t, int32_t>, double> above; // particles of the first body over the second in their strip
    strips.for_each([&](auto item, auto end, auto surface, auto last) {
        int32_t body = -1, beneath = -1; // of the item before, and the other body beneath that
        for (; item != end; ++item) {
            const int32_t own = item->body;
            if (own != body) {
                beneath = body;
                body = own;
            }
            const bool by_plate = std::any_of(
                surface, last, [&](const Strips::Surface &s) { return strips.height_of(s, *item) <= item->height; });
            if (by_plate)
                borne[own] += 1;
            else if (beneath >= 0)
                above[{own, beneath}] += 1;
        }
    });
    for (bool changed = true; changed;) {
        changed = false;
        std::vector<double> found = borne;
        for (const auto &[pair, count] : above)
            if (2 * shares[pair.second] >= 1)
                found[pair.first] += count;
        for (std::size_t k = 0; k < shares.size(); ++k) {
            const double share = found[k] / static_cast<double>(scene.bodies()[k].count);
            changed = changed || (2 * share >= 1) != (2 * shares[k] >= 1);
            shares[k] = share;
        }
    }
    return shares;
}

} // namespace gp
