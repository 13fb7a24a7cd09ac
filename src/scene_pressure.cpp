// The pressure with which columns begin: in balance with gravity, with what rests on them and with what bears them.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "scene.hpp"

namespace gp {

namespace {

struct Burden {
    double weight = 0; // Pa, of what rests on a body
    double load = 0;   // Pa, passed down from plates under a load
};

// One of the four directions in which a column can press on what is next to it.
class Direction {
public:
    Direction(const Scene &scene, const Constants &constants, const Vector &outward)
        : scene_(scene), outward_(outward), spacing_(constants.spacing) {
        const std::vector<Body> &bodies = scene.bodies();
        gradient_.assign(bodies.size(), 0);
        for (std::size_t b = 0; b < bodies.size(); ++b)
            gradient_[b] = std::max(0.0, outward.dot(constants.gravity)) *
                           constants.materials[static_cast<std::size_t>(bodies[b].material)].density;
        std::vector<std::size_t> order;
        for (std::size_t b = 0; b < bodies.size(); ++b)
            if (bodies[b].rectangle && bodies[b].hydrostatic)
                order.push_back(b);
        // What bears comes before what it bears.
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return outward.dot(face_centre(bodies[a], 1)) > outward.dot(face_centre(bodies[b], 1));
        });
        borne_.assign(bodies.size(), false);
        for (std::size_t b : order)
            borne_[b] = is_borne(b);
        burden_.assign(bodies.size(), {});
        for (auto b = order.rbegin(); b != order.rend(); ++b)
            if (borne_[*b])
                burden_[*b] = burden_of(*b);
    }

    // What body b has to bear at the point r, its own weight included.
    Burden pressure(std::size_t b, const Vector &r) const {
        if (!borne_[b])
            return {};
        const double depth = outward_.dot(r - face_centre(scene_.bodies()[b], -1));
        return {burden_[b].weight + gradient_[b] * std::max(depth, 0.0),
                burden_[b].load}; // jitter may lift one above the face
    }

private:
    bool horizontal() const { return outward_.y() != 0; } // the face
    double depth_of(const Body &body) const { return horizontal() ? body.height : body.width; }
    double length_of(const Body &body) const { return horizontal() ? body.width : body.height; }
    // Middle of the face that presses (side 1) or of the opposite one (side -1).
    Vector face_centre(const Body &body, int side) const {
        return Vector(body.x_min + 0.5 * body.width, body.y_min + 0.5 * body.height) +
               (0.5 * side * depth_of(body)) * outward_;
    }

    // Calls visit(point) for each spacing along a face of a body.
    template <class Visit> int64_t for_each_cell(const Body &body, int side, const Visit &visit) const {
        const Vector centre = face_centre(body, side);
        const Vector along(horizontal() ? 1.0 : 0.0, horizontal() ? 0.0 : 1.0);
        const auto cells = static_cast<int64_t>(std::round(length_of(body) / spacing_));
        for (int64_t k = 0; k < cells; ++k)
            visit(Vector(centre + along * ((static_cast<double>(k) + 0.5) * spacing_ - 0.5 * length_of(body))));
        return cells;
    }

    // Does this face of a body lie at the point?
    bool touches(const Body &body, int side, const Vector &point) const {
        const Vector apart = point - face_centre(body, side);
        return std::abs(outward_.dot(apart)) < 0.5 * spacing_ &&
               std::abs(horizontal() ? apart.x() : apart.y()) < 0.5 * length_of(body);
    }

    bool is_borne(std::size_t b) const {
        const std::vector<Body> &bodies = scene_.bodies();
        int64_t covered = 0;
        const int64_t cells = for_each_cell(bodies[b], 1, [&](const Vector &point) {
            bool found = std::any_of(scene_.plates().begin(), scene_.plates().end(), [&](const PlateSpec &plate) {
                return plate.segment.normal.dot(outward_) < -0.99 && plate.segment.nearest(point) < 0.5 * spacing_;
            });
            for (std::size_t c = 0; c < bodies.size() && !found; ++c)
                found = borne_[c] && touches(bodies[c], -1, point);
            covered += found;
        });
        return 2 * covered >= cells;
    }

    // Mean over a body's back of what rests on it: other columns, and plates under a load.
    Burden burden_of(std::size_t b) const {
        const std::vector<Body> &bodies = scene_.bodies();
        Burden sum;
        const int64_t cells = for_each_cell(bodies[b], -1, [&](const Vector &point) {
            for (std::size_t c = 0; c < bodies.size(); ++c)
                if (c != b && borne_[c] && touches(bodies[c], 1, point)) {
                    sum.weight += burden_[c].weight + gradient_[c] * depth_of(bodies[c]);
                    sum.load += burden_[c].load;
                    return;
                }
            double load = 0;
            for (const PlateSpec &plate : scene_.plates())
                if (plate.segment.normal.dot(outward_) > 0.99 && plate.segment.nearest(point) < 0.5 * spacing_)
                    load = std::max(load, plate.load);
            sum.load += load;
        });
        const auto count = static_cast<double>(cells);
        return {sum.weight / count, sum.load / count};
    }

    const Scene &scene_;
    Vector outward_;
    double spacing_;
    std::vector<double> gradient_; // Pa/m
    std::vector<bool> borne_;
    std::vector<Burden> burden_;
};

} // namespace

std::vector<double> Scene::initial_pressure(const Constants &constants) const {
    const bool down = constants.gravity.y() <= 0, left = constants.gravity.x() <= 0;
    const Direction vertical(*this, constants, Vector(0, down ? -1 : 1)),
        across(*this, constants, Vector(left ? -1 : 1, 0));
    std::vector<double> pressure(x.size(), 0.0);
    for (std::size_t b = 0; b < bodies_.size(); ++b)
        for (int64_t i = bodies_[b].first; i < bodies_[b].first + bodies_[b].count; ++i) {
            // The weights of both directions add up; loads from two sides are one pressure.
            const Burden v = vertical.pressure(b, {x[i], y[i]}), a = across.pressure(b, {x[i], y[i]});
            pressure[i] = v.weight + a.weight + std::max(v.load, a.load);
        }
    return pressure;
}

} // namespace gp
