// Plates as they are added: their lines and motions, checked.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "check.hpp"
#include "scene.hpp"

namespace gp {

namespace {

// Of a table at `time`, linear between knots, constant before and after. values: one of its columns.
double at_time(const std::vector<double> &t, const std::vector<double> &values, double time) {
    if (time <= t.front())
        return values.front();
    if (time >= t.back())
        return values.back();
    const auto next = static_cast<std::size_t>(std::upper_bound(t.begin(), t.end(), time) - t.begin());
    const double part = (time - t[next - 1]) / (t[next] - t[next - 1]);
    return values[next - 1] + part * (values[next] - values[next - 1]);
}

} // namespace

Vector MotionTable::displacement(double time) const {
    return {at_time(t, x, time), at_time(t, y, time)};
}

double MotionTable::turn(double time) const {
    return angle.empty() ? 0.0 : at_time(t, angle, time);
}

PlateSpec::PlateSpec(std::vector<Vector> line) : points(std::move(line)) {
    Vector low = points.front(), high = points.front();
    for (std::size_t k = 1; k < points.size(); ++k) {
        const Vector &from = points[k - 1], &to = points[k];
        segments.emplace_back(from.x(), from.y(), to.x(), to.y());
        length += segments.back().length;
        low = low.cwiseMin(to);
        high = high.cwiseMax(to);
    }
    middle = 0.5 * (low + high);
    extent = high - low;
    if (!closed()) {
        const Segment back(points.front().x(), points.front().y(), points.back().x(), points.back().y());
        back_normal = back.normal;
        back_length = back.length;
    }
    set_pivot(pivot);
}

void PlateSpec::set_pivot(const Vector &at) {
    pivot = at;
    farthest = 0;
    for (const Vector &point : points)
        farthest = std::max(farthest, (point - pivot).norm());
}

bool PlateSpec::lies_at(const Vector &point, const Vector &direction, double within) const {
    return std::any_of(segments.begin(), segments.end(), [&](const Segment &segment) {
        return segment.normal.dot(direction) > 0.99 && segment.nearest(point) < within;
    });
}

namespace {

constexpr double shortest_segment = 0.1; // dl, of a line of several
constexpr double longest_line = 1e8;     // dl
constexpr int64_t most_points = 10000000;

double cross(const Vector &a, const Vector &b) {
    return a.x() * b.y() - a.y() * b.x();
}

// Do the segments from a to b and from c to d have a point in common?
bool meet(const Vector &a, const Vector &b, const Vector &c, const Vector &d) {
    const auto side = [](const Vector &p, const Vector &q, const Vector &r) { return cross(q - p, r - p); };
    const auto within = [](const Vector &p, const Vector &q, const Vector &r) {
        return std::min(p.x(), q.x()) <= r.x() && r.x() <= std::max(p.x(), q.x()) && std::min(p.y(), q.y()) <= r.y() &&
               r.y() <= std::max(p.y(), q.y());
    };
    const double ca = side(c, d, a), cb = side(c, d, b), ac = side(a, b, c), ad = side(a, b, d);
    if (((ca > 0 && cb < 0) || (ca < 0 && cb > 0)) && ((ac > 0 && ad < 0) || (ac < 0 && ad > 0)))
        return true;
    return (ca == 0 && within(c, d, a)) || (cb == 0 && within(c, d, b)) || (ac == 0 && within(a, b, c)) ||
           (ad == 0 && within(a, b, d));
}

// A wall whose body is on both sides of itself has no inside.
void require_simple(const std::vector<Vector> &points) {
    const auto count = static_cast<int64_t>(points.size()) - 1; // of segments
    const bool closed = points.front() == points.back();
    const auto fail = [](int64_t a, int64_t b) {
        throw make_error(
            GP_E_ARGUMENT,
            "gp_plate.point_x, point_y: the segment from point %lld meets that from point %lld; expected a "
            "line that does not cross, touch or fold back on itself",
            static_cast<long long>(a), static_cast<long long>(b));
    };
    for (int64_t k = 0; k + 1 < count || (closed && k < count); ++k) { // neighbours share a point
        const int64_t next = k + 1 < count ? k + 1 : 0;
        const Vector way = points[k + 1] - points[k], on = points[next + 1] - points[next];
        if (cross(way, on) == 0 && way.dot(on) < 0)
            fail(k, next);
    }
    const auto left = [&](int64_t k) { return std::min(points[k].x(), points[k + 1].x()); };
    const auto right = [&](int64_t k) { return std::max(points[k].x(), points[k + 1].x()); };
    std::vector<int64_t> order(static_cast<std::size_t>(count));
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(),
              [&](int64_t a, int64_t b) { return left(a) != left(b) ? left(a) < left(b) : a < b; });
    for (std::size_t m = 0; m < order.size(); ++m)
        for (std::size_t n = m + 1; n < order.size() && left(order[n]) <= right(order[m]); ++n) {
            const int64_t a = std::min(order[m], order[n]), b = std::max(order[m], order[n]);
            if (b - a < 2 || (closed && a == 0 && b == count - 1))
                continue;
            if (meet(points[a], points[a + 1], points[b], points[b + 1]))
                fail(a, b);
        }
}

// The wetted line of a plate.
std::vector<Vector> line_of(const gp_plate &p, double spacing) {
    if (p.n_points == 0) {
        require_position("gp_plate.x0", p.x0, spacing);
        require_position("gp_plate.y0", p.y0, spacing);
        require_position("gp_plate.x1", p.x1, spacing);
        require_position("gp_plate.y1", p.y1, spacing);
        const double length = std::hypot(p.x1 - p.x0, p.y1 - p.y0);
        require(std::isfinite(length) && length > 1e-6 * spacing, "gp_plate length", length,
                "two ends that differ by more than 1e-6 of the spacing");
        require(length / spacing < longest_line, "gp_plate length", length, "less than 1e8 spacings");
        return {{p.x0, p.y0}, {p.x1, p.y1}};
    }
    if (p.n_points < 2 || p.n_points > most_points)
        throw make_error(GP_E_ARGUMENT, "gp_plate.n_points = %lld: expected 0 or a whole number from 2 to %lld",
                         static_cast<long long>(p.n_points), static_cast<long long>(most_points));
    require_pointer("gp_plate.point_x", p.point_x);
    require_pointer("gp_plate.point_y", p.point_y);
    for (const auto &[name, value] :
         {std::pair{"gp_plate.x0", p.x0}, {"gp_plate.y0", p.y0}, {"gp_plate.x1", p.x1}, {"gp_plate.y1", p.y1}})
        require(value == 0, name, value, "0 for a plate with n_points");
    std::vector<Vector> line;
    double length = 0;
    for (int64_t k = 0; k < p.n_points; ++k) {
        require_position({"gp_plate.point_x", k}, p.point_x[k], spacing);
        require_position({"gp_plate.point_y", k}, p.point_y[k], spacing);
        line.emplace_back(p.point_x[k], p.point_y[k]);
        if (k == 0)
            continue;
        const double way = (line[k] - line[k - 1]).norm();
        if (!(way >= shortest_segment * spacing))
            throw make_error(
                GP_E_ARGUMENT,
                "gp_plate.point_x[%lld], point_y[%lld] = (%g, %g): %g m from the point before, expected at "
                "least %g m, a tenth of the spacing",
                static_cast<long long>(k), static_cast<long long>(k), p.point_x[k], p.point_y[k], way,
                shortest_segment * spacing);
        length += way;
    }
    require(length / spacing < longest_line, "gp_plate length", length, "less than 1e8 spacings");
    require_simple(line);
    return line;
}

MotionTable table_of(const gp_plate &p) {
    require_pointer("gp_plate.knot_t", p.knot_t);
    if (!p.knot_angle) { // a plate that only turns needs no displacements
        require_pointer("gp_plate.knot_x", p.knot_x);
        require_pointer("gp_plate.knot_y", p.knot_y);
    } else if ((p.knot_x == nullptr) != (p.knot_y == nullptr)) {
        throw make_error(GP_E_ARGUMENT, "gp_plate.%s = NULL: expected knot_x and knot_y both given or both NULL",
                         p.knot_x ? "knot_y" : "knot_x");
    }
    const auto check = [&](const char *name, const double *values) {
        for (int64_t k = 0; values && k < p.n_knots; ++k)
            require_finite({name, k}, values[k]);
    };
    check("gp_plate.knot_t", p.knot_t);
    check("gp_plate.knot_x", p.knot_x);
    check("gp_plate.knot_y", p.knot_y);
    check("gp_plate.knot_angle", p.knot_angle);
    for (int64_t k = 1; k < p.n_knots; ++k)
        if (p.knot_t[k] <= p.knot_t[k - 1])
            throw make_error(GP_E_ARGUMENT, "gp_plate.knot_t[%lld] = %g: expected more than the knot before, %g",
                             static_cast<long long>(k), p.knot_t[k], p.knot_t[k - 1]);
    const auto check_speed = [&](const char *name, const double *values) {
        for (int64_t k = 1; values && k < p.n_knots; ++k) {
            const double speed = (values[k] - values[k - 1]) / (p.knot_t[k] - p.knot_t[k - 1]);
            if (!(std::abs(speed) <= largest_quantity))
                throw make_error(
                    GP_E_ARGUMENT,
                    "gp_plate.%s[%lld] = %g: %g per second from the knot before, expected from -1e+50 to 1e+50", name,
                    static_cast<long long>(k), values[k], speed);
        }
    };
    check_speed("knot_x", p.knot_x);
    check_speed("knot_y", p.knot_y);
    check_speed("knot_angle", p.knot_angle);
    const auto copy = [&](const double *values) {
        return values ? std::vector<double>(values, values + p.n_knots) : std::vector<double>(p.n_knots, 0.0);
    };
    MotionTable table{copy(p.knot_t), copy(p.knot_x), copy(p.knot_y), {}};
    if (p.knot_angle)
        table.angle = copy(p.knot_angle);
    return table;
}

} // namespace

int32_t Scene::add_plate(const gp_plate &p) {
    PlateSpec spec(line_of(p, config_.spacing));
    if (const Period period = this->period(); period && spec.extent.x() > period.length * (1 + 1e-6))
        throw make_error(
            GP_E_ARGUMENT, "gp_plate from x = %g to %g m: expected an extent in x of at most the period, %g m",
            spec.middle.x() - 0.5 * spec.extent.x(), spec.middle.x() + 0.5 * spec.extent.x(), period.length);
    require_choice("gp_plate.friction", p.friction, 3);
    require_choice("gp_plate.fluidity", p.fluidity, 2);
    require_not_negative("gp_plate.wall_mu", p.wall_mu);
    require(p.wall_mu == 0 || p.friction == GP_WALL_COULOMB, "gp_plate.wall_mu", p.wall_mu,
            "0 unless friction is GP_WALL_COULOMB");
    require_quantity("gp_plate.vx", p.vx);
    require_quantity("gp_plate.vy", p.vy);
    require_quantity("gp_plate.omega", p.omega);
    require_quantity("gp_plate.surface_velocity", p.surface_velocity);
    require(p.surface_velocity == 0 || p.friction != GP_WALL_FREE_SLIP, "gp_plate.surface_velocity", p.surface_velocity,
            "0 for a plate without friction, which drives nothing");
    require_position("gp_plate.pivot_x", p.pivot_x, config_.spacing);
    require_position("gp_plate.pivot_y", p.pivot_y, config_.spacing);
    if (p.n_knots < 0)
        throw make_error(GP_E_ARGUMENT, "gp_plate.n_knots = %lld: expected a whole number >= 0",
                         static_cast<long long>(p.n_knots));
    require_not_negative("gp_plate.normal_pressure", p.normal_pressure);
    require_not_negative("gp_plate.mass_per_length", p.mass_per_length);
    require(p.mass_per_length == 0 || p.normal_pressure > 0, "gp_plate.mass_per_length", p.mass_per_length,
            "0 as long as normal_pressure is 0");

    spec.friction = p.friction;
    spec.wall_mu = p.wall_mu;
    spec.fluidity = p.fluidity;
    spec.set_pivot({p.pivot_x, p.pivot_y});
    spec.motion = {{p.vx, p.vy}, p.omega};
    spec.surface_velocity = p.surface_velocity;
    spec.load = p.normal_pressure;
    spec.mass = p.mass_per_length;
    if (p.normal_pressure > 0) {
        if (p.n_knots > 0)
            throw make_error(GP_E_ARGUMENT, "gp_plate.n_knots = %lld: expected 0 for a plate with normal_pressure",
                             static_cast<long long>(p.n_knots));
        require(!spec.closed(), "gp_plate.normal_pressure", p.normal_pressure,
                "0 for a closed line, which has no back for a load");
        require_tangential(spec, spec.motion, "gp_plate");
    }
    if (p.n_knots > 0) {
        for (const auto &[name, value] :
             {std::pair{"gp_plate.vx", p.vx}, {"gp_plate.vy", p.vy}, {"gp_plate.omega", p.omega}})
            require(value == 0, name, value, "0 when the plate has a table of its motion");
        spec.table = table_of(p);
    }
    require_room_to_turn(spec, spec.motion, "gp_plate");
    plates_.push_back(std::move(spec));
    return static_cast<int32_t>(plates_.size()) - 1;
}

void require_tangential(const PlateSpec &plate, const Motion &motion, const char *name) {
    if (plate.load == 0)
        return;
    const double normal = plate.back_normal.dot(motion.velocity);
    if (std::abs(normal) > 1e-12 * motion.velocity.norm())
        throw make_error(
            GP_E_ARGUMENT,
            "%s velocity = (%g, %g), %g along the normal: expected 0 along the normal of a plate that moves "
            "there under its load",
            name, motion.velocity.x(), motion.velocity.y(), normal);
    if (motion.omega != 0)
        throw make_error(GP_E_ARGUMENT, "%s omega = %g: expected 0 for a plate with normal_pressure", name,
                         motion.omega);
}

void Scene::require_room_to_turn(const PlateSpec &plate, const Motion &motion, const char *name) const {
    const Period period = this->period();
    if (!period || (motion.omega == 0 && plate.table.angle.empty()))
        return;
    const double across = plate.extent.norm();
    if (across > period.length)
        throw make_error(GP_E_ARGUMENT, "%s omega = %g: expected 0 for a plate of %g m, longer than the period of %g m",
                         name, motion.omega, across, period.length);
}

void Scene::set_plate_start(int32_t plate, const Vector &start, double angle) {
    require_finite("start x", start.x());
    require_finite("start y", start.y());
    require_finite("start angle", angle);
    plates_[plate].start = start;
    plates_[plate].start_angle = angle;
}

void Scene::drive_plate(int32_t plate, const Motion &motion) {
    PlateSpec &spec = plates_[plate];
    if (!spec.table.empty()) {
        spec.start = spec.table.displacement(0);
        spec.start_angle = spec.table.turn(0);
    }
    spec.motion = motion;
    spec.table = {};
}

} // namespace gp
