// Plane geometry of plates: a directed segment whose wetted side is on the right of the way from end 0 to end 1.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace gp {

using Vector = Eigen::Vector2d;
using Tensor = Eigen::Matrix2d;

struct Segment {
    Vector origin;  // end 0
    Vector tangent; // unit vector towards end 1
    Vector normal;  // unit vector into the material: the tangent turned clockwise
    double length;

    Segment(double x0, double y0, double x1, double y1) : origin(x0, y0) {
        const Vector way(x1 - x0, y1 - y0);
        length = way.norm();
        tangent = way / length;
        normal = Vector(tangent.y(), -tangent.x());
    }

    double along(const Vector &point) const { return tangent.dot(point - origin); }
    double distance(const Vector &point) const { return normal.dot(point - origin); }

    // Is `along` on the segment? Half open, so that of two plates that meet end to end exactly one owns the corner.
    bool covers(double s, double tolerance) const { return s >= -tolerance && s < length - tolerance; }

    Segment moved(const Vector &by) const {
        Segment other = *this;
        other.origin += by;
        return other;
    }

    // Distance of a point from the segment, and its square.
    double nearest(const Vector &point) const { return std::hypot(beyond(along(point)), distance(point)); }
    double nearest_square(const Vector &point) const {
        const double past = beyond(along(point)), off = distance(point);
        return past * past + off * off;
    }
    // How far `along` is past an end.
    double beyond(double s) const { return s < 0 ? -s : (s > length ? s - length : 0.0); }
};

// Where a rigid body is: turned by an angle about its pivot, which has been displaced.
struct Pose {
    Vector shift = Vector::Zero(); // m
    double angle = 0;              // rad, counter-clockwise
    bool operator==(const Pose &other) const { return shift == other.shift && angle == other.angle; }
};

// Takes what belongs to a rigid body from where it was at time 0 to a pose. What does not turn keeps its bits.
class Placing {
public:
    Placing(const Pose &pose, const Vector &pivot)
        : pivot_(pivot), shift_(pose.shift), turned_(pose.angle != 0), cosine_(std::cos(pose.angle)),
          sine_(std::sin(pose.angle)) {}
    Vector of(const Vector &point) const {
        return turned_ ? Vector(pivot_ + shift_ + turned(point - pivot_)) : Vector(point + shift_);
    }
    Segment of(const Segment &segment) const {
        Segment placed = segment.moved(shift_);
        if (turned_) {
            placed.origin = of(segment.origin);
            placed.tangent = turned(segment.tangent);
            placed.normal = {placed.tangent.y(), -placed.tangent.x()};
        }
        return placed;
    }

private:
    Vector turned(const Vector &arm) const {
        return {cosine_ * arm.x() - sine_ * arm.y(), sine_ * arm.x() + cosine_ * arm.y()};
    }
    Vector pivot_, shift_;
    bool turned_;
    double cosine_, sine_;
};

// Periodicity in x.
struct Period {
    double x_min = 0, length = 0; // m; length 0: not periodic
    explicit operator bool() const { return length > 0; }
    bool spanned_by(const Segment &s) const {
        return std::abs(std::abs(s.tangent.x() * s.length) - length) < 1e-6 * length && std::abs(s.tangent.y()) < 1e-9;
    }
    // Whole periods to take off x so that it lies in [x_min, x_min + length).
    double shift_of(double x) const { return length * std::floor((x - x_min) / length); }
};

// Where the way from a point on the wetted side to one on the body side passes the segment's line, as a fraction of the
// way in [0, 1); negative if it does not pass through the segment in that sense. Both ends belong to the segment: which one
// a plate was drawn from must not matter, nor rounding. A way through the corner of two plates passes through both.
// before, after: tolerances at end 0 and end 1.
inline double crossing(const Segment &segment, const Vector &from, const Vector &to, double before, double after) {
    const double d_from = segment.distance(from), d_to = segment.distance(to);
    if (d_from <= 0 || d_to > 0)
        return -1.0;
    const double fraction = d_from / (d_from - d_to);
    const double s_from = segment.along(from);
    const double s = s_from + fraction * (segment.along(to) - s_from);
    return s >= -before && s <= segment.length + after ? fraction : -1.0;
}
inline double crossing(const Segment &segment, const Vector &from, const Vector &to, double tolerance) {
    return crossing(segment, from, to, tolerance, tolerance);
}

} // namespace gp
