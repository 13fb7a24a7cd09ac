// The stress with which columns begin: in balance with gravity, with what rests on them and with what bears them, as far as
// the material's yield admits.
//
// What is not in balance at the start is made so by elastic waves, and they count as flow. On an incline, a layer that began
// without shear gained g sin(a) for the time that a shear wave takes from the floor to the surface, near the yield angle more
// than the flow's own velocity: 21.5 degrees, h = 4 cm, surface at .1 s .029 m/s with the automatic sound speed, .014 with
// four times that, .0095 with the shear and any sound speed. A column with free sides that began under a fluid's pressure let
// it go as waves of tension, in which a face that its friction could hold crumbled.
#include <algorithm>
#include <cmath>

#include "scene.hpp"

namespace gp {

namespace {

// What a column has to bear at a depth, its own weight included. Pa.
struct Burden {
    double weight = 0; // normal to the face that presses
    double load = 0;   // passed down from plates under a load
    double shear = 0;  // along that face, signed as the gravity along it
};

// One of the four directions in which a column can press on what is next to it.
class Direction {
public:
    Direction(const Scene &scene, const Constants &constants, const Vector &outward)
        : scene_(scene), outward_(outward), spacing_(constants.spacing) {
        const std::vector<Body> &bodies = scene.bodies();
        gradient_.assign(bodies.size(), 0);
        shear_gradient_.assign(bodies.size(), 0);
        for (std::size_t b = 0; b < bodies.size(); ++b) {
            const double density = material_of(constants, bodies[b]).density;
            gradient_[b] = std::max(0.0, outward.dot(constants.gravity)) * density;
            shear_gradient_[b] = (horizontal() ? constants.gravity.x() : constants.gravity.y()) * density;
        }
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
        grip_.assign(bodies.size(), 0);
        for (std::size_t b : order)
            if (borne_[b])
                grip_[b] = std::min(grip_below(b), material_of(constants, bodies[b]).map.mu_s);
        find_open();
    }

    // What body b has to bear at the point r, its own weight included.
    Burden pressure(std::size_t b, const Vector &r) const {
        if (!borne_[b])
            return {};
        const double depth =
            std::max(outward_.dot(r - face_centre(scene_.bodies()[b], -1)), 0.0); // jitter may lift one above the face
        return {burden_[b].weight + gradient_[b] * depth, burden_[b].load,
                burden_[b].shear + shear_gradient_[b] * depth};
    }

    // Largest ratio of shear to normal stress that the material and all that bears it admit.
    double grip(std::size_t b) const { return grip_[b]; }
    // Does the friction below hold what pulls along the face that presses? Of what is under a load nobody knows.
    bool holds(std::size_t b, const Burden &burden) const {
        return burden.weight > 0 && burden.load == 0 && std::abs(burden.shear) <= grip_[b] * burden.weight;
    }
    // Is a side of it free, or that of a column beside it?
    bool is_open(std::size_t b) const { return open_[b]; }

private:
    static const MaterialConstants &material_of(const Constants &constants, const Body &body) {
        return constants.materials[static_cast<std::size_t>(body.material)];
    }
    bool horizontal() const { return outward_.y() != 0; } // the face
    Vector along() const { return {horizontal() ? 1.0 : 0.0, horizontal() ? 0.0 : 1.0}; }
    double depth_of(const Body &body) const { return horizontal() ? body.height : body.width; }
    double length_of(const Body &body) const { return horizontal() ? body.width : body.height; }
    // Middle of the face that presses (side 1) or of the opposite one (side -1).
    Vector face_centre(const Body &body, int side) const {
        return Vector(body.x_min + 0.5 * body.width, body.y_min + 0.5 * body.height) +
               (0.5 * side * depth_of(body)) * outward_;
    }

    // Calls visit(point) for each spacing of a length.
    template <class Visit>
    int64_t for_each_cell(const Vector &centre, const Vector &along, double length, const Visit &visit) const {
        const auto cells = static_cast<int64_t>(std::round(length / spacing_));
        for (int64_t k = 0; k < cells; ++k)
            visit(Vector(centre + along * ((static_cast<double>(k) + 0.5) * spacing_ - 0.5 * length)));
        return cells;
    }
    // The same along a face of a body.
    template <class Visit> int64_t for_each_cell(const Body &body, int side, const Visit &visit) const {
        return for_each_cell(face_centre(body, side), along(), length_of(body), visit);
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
                return plate.lies_at(point, -outward_, 0.5 * spacing_);
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
                    sum.shear += burden_[c].shear + shear_gradient_[c] * depth_of(bodies[c]);
                    return;
                }
            double load = 0;
            for (const PlateSpec &plate : scene_.plates())
                if (plate.lies_at(point, outward_, 0.5 * spacing_))
                    load = std::max(load, plate.load);
            sum.load += load;
        });
        const auto count = static_cast<double>(cells);
        return {sum.weight / count, sum.load / count, sum.shear / count};
    }

    // The least friction of what a column stands on, and of what that stands on.
    double grip_below(std::size_t b) const {
        const std::vector<Body> &bodies = scene_.bodies();
        double least = INFINITY;
        for_each_cell(bodies[b], 1, [&](const Vector &point) {
            for (const PlateSpec &plate : scene_.plates())
                if (plate.friction != GP_WALL_NO_SLIP && plate.lies_at(point, -outward_, 0.5 * spacing_))
                    least = std::min(least, plate.friction == GP_WALL_COULOMB ? plate.wall_mu : 0.0);
            for (std::size_t c = 0; c < bodies.size(); ++c)
                if (borne_[c] && touches(bodies[c], -1, point))
                    least = std::min(least, grip_[c]);
        });
        return least;
    }

    Vector side_centre(const Body &body, int side) const {
        return Vector(body.x_min + 0.5 * body.width, body.y_min + 0.5 * body.height) +
               (0.5 * side * length_of(body)) * along();
    }

    // Does column c lie beside b at the point of b's side?
    bool lies_beside(std::size_t c, int side, const Vector &point) const {
        const Body &body = scene_.bodies()[c];
        const Vector apart = point - side_centre(body, -side);
        return borne_[c] && std::abs(along().dot(apart)) < 0.5 * spacing_ &&
               std::abs(outward_.dot(apart)) < 0.5 * depth_of(body);
    }

    // Is half of a side covered, by the points that are?
    template <class Covered> bool is_covered(std::size_t b, int side, const Covered &covered) const {
        const Body &body = scene_.bodies()[b];
        int64_t count = 0;
        const int64_t cells = for_each_cell(side_centre(body, side), outward_, depth_of(body),
                                            [&](const Vector &point) { count += covered(point); });
        return 2 * count >= cells;
    }

    bool has_free_side(std::size_t b) const {
        const auto covered_at = [&](int side) {
            return [this, b, side](const Vector &point) {
                for (const PlateSpec &plate : scene_.plates())
                    if (plate.lies_at(point, -side * along(), 0.5 * spacing_))
                        return true;
                for (std::size_t c = 0; c < borne_.size(); ++c)
                    if (c != b && lies_beside(c, side, point))
                        return true;
                return false;
            };
        };
        return !is_covered(b, -1, covered_at(-1)) || !is_covered(b, 1, covered_at(1));
    }

    // One free side is enough, as a column that presses on nothing there presses on nothing at the other either; and columns
    // side by side are one.
    void find_open() {
        open_.assign(borne_.size(), false);
        if (horizontal() && scene_.period())
            return;
        std::vector<std::size_t> found;
        const auto open = [&](std::size_t b) {
            open_[b] = true;
            found.push_back(b);
        };
        for (std::size_t b = 0; b < borne_.size(); ++b)
            if (borne_[b] && has_free_side(b))
                open(b);
        while (!found.empty()) {
            const std::size_t c = found.back();
            found.pop_back();
            for (std::size_t b = 0; b < borne_.size(); ++b)
                for (const int side : {-1, 1})
                    if (borne_[b] && !open_[b] &&
                        is_covered(b, side, [&](const Vector &point) { return lies_beside(c, side, point); }))
                        open(b);
        }
    }

    const Scene &scene_;
    Vector outward_;
    double spacing_;
    std::vector<double> gradient_, shear_gradient_; // Pa/m
    std::vector<bool> borne_, open_;
    std::vector<Burden> burden_;
    std::vector<double> grip_;
};

// The stress of what presses in one direction alone, in that direction's measure.
struct Principal {
    double pressure = 0, excess = 0,
           shear = 0; // Pa: excess: half of what the stress along the direction is beyond that across

    Principal(const Direction &direction, std::size_t b, const Burden &burden, const MaterialConstants &material) {
        const double normal = burden.weight + burden.load, mu = material.map.mu_s;
        // Of the stress across to that along. Uniaxial where the sides are free and the friction holds a vertical face
        // (tau <= mu p). Where it does not, there is no balance to begin in.
        const double ratio = material.k0 > 0 ? material.k0 : direction.is_open(b) && mu >= 1 ? 0.0 : 1.0;
        pressure = 0.5 * (1 + ratio) * normal;
        excess = 0.5 * (1 - ratio) * normal;
        // A plate on the other face has its share of the weight along it: nobody knows which.
        if (burden.load > 0)
            return;
        // As a product: of two squares the difference is their rounding where all of the yield is spent, 2e-6 Pa of a kPa with fused
        // multiplications.
        const double yield = std::sqrt(std::max((mu * pressure - excess) * (mu * pressure + excess), 0.0));
        const double most = std::min(direction.grip(b) * normal, yield);
        shear = std::clamp(burden.shear, -most, most);
    }
};

} // namespace

std::vector<InitialStress> Scene::initial_stress(const Constants &constants, int64_t first, int64_t end) const {
    const bool down = constants.gravity.y() <= 0, left = constants.gravity.x() <= 0;
    const Direction vertical(*this, constants, Vector(0, down ? -1 : 1)),
        across(*this, constants, Vector(left ? -1 : 1, 0));
    std::vector<InitialStress> stress(static_cast<std::size_t>(end - first));
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        const MaterialConstants &material = constants.materials[static_cast<std::size_t>(bodies_[b].material)];
        const int64_t last = std::min(end, bodies_[b].first + bodies_[b].count);
        for (int64_t i = std::max(first, bodies_[b].first); i < last; ++i) {
            // The weights of both directions add up; loads from two sides are one pressure. But what the friction of its floor
            // holds does not press on the wall at its lower end: a layer of 1 cm on 20 degrees between walls .4 m apart began
            // under the pressure of .14 m, which let go at its surface, and slid by .6 to 7.6 mm before it bore its weight.
            const Vector at = position(bodies_[b], i);
            Burden v = vertical.pressure(b, at), a = across.pressure(b, at);
            if (constants.scheme == Scheme::adjoint && vertical.holds(b, v))
                a = {};
            else if (constants.scheme == Scheme::adjoint && across.holds(b, a))
                v = {};
            InitialStress &s = stress[i - first];
            s.pressure = v.weight + a.weight + std::max(v.load, a.load);
            const bool by_v = v.weight + v.load > 0, by_a = a.weight + a.load > 0;
            if (constants.scheme != Scheme::adjoint || by_v + by_a == 0) // the other schemes' deviator is viscous
                continue;
            if (by_v && by_a) { // each has its own across
                const double ratio = material.k0 > 0 ? material.k0 : 1.0;
                s.pressure = 0.5 * (1 + ratio) * (v.weight + a.weight) + std::max(v.load, a.load);
                s.sxx = 0.5 * (1 - ratio) * (v.weight - a.weight);
                continue;
            }
            const Principal principal(by_v ? vertical : across, b, by_v ? v : a, material);
            s.pressure = principal.pressure;
            s.sxx = by_v ? principal.excess : -principal.excess;
            s.sxy = (by_v ? down : left) ? principal.shear : -principal.shear;
        }
    }
    return stress;
}

} // namespace gp
