// What a simulation can tell of itself. Everything here only reads.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "world.hpp"

namespace gp {

// The whole of gp_state but for the wall-clock time.
gp_state measure_state(const World &world);

// 1 for the particles of the connected deposit: the largest set in which each is within 1.6 spacings of another (of equal
// sets the one with the smallest id).
std::vector<char> connected_deposit(const World &world);

// Free surface of the connected deposit at stations x between its fronts: the largest y where the smoothed volume fraction
// is 1/2, or half of the largest one at x where the material nowhere fills the smoothing radius (beside walls, at fronts).
class Surface {
public:
    explicit Surface(const World &world);
    bool empty() const { return points_.empty(); }
    // false where there is no material at x.
    bool height(double x, double &y) const;
    double left() const; // m, fronts with half a spacing added
    double right() const;
    // Highest point of the surface.
    void peak(double &x, double &y) const;

private:
    struct Point {
        double x, y;
    };
    double spacing_, radius_;
    double x_min_ = -INFINITY, x_max_ = INFINITY; // ends of the period
    std::vector<Point> points_;                   // sorted by x
};

// Interface of two bodies at height y; false where they do not touch.
bool interface_at(const World &world, int32_t left, int32_t right, double y, double &x);

} // namespace gp
