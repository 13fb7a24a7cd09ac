// What a simulation can tell of itself. Everything here only reads.
//
// Of a world in parts all calls are collective, and tell of the whole: surfaces, marks, sums and shares on the first process, states
// on all.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "world.hpp"

namespace gp {

// gp_state but for the wall-clock time and the parts GP_STATE_...
gp_state measure_sums(const World &world);
// Measures parts, too.
void measure_parts(const World &world, uint32_t parts, gp_state &state);
// Sets them to NaN.
void leave_out(uint32_t parts, gp_state &state);
gp_state measure_state(const World &world); // with all parts

// 1 for the particles (of this process) of the connected deposit: the largest set in which each is within 1.6 spacings of another (of equal
// sets the one with the smallest id).
std::vector<char> connected_deposit(const World &world);

// Free surface of the connected deposit at stations x between its fronts: the largest y where the smoothed volume fraction
// is 1/2, or half of the largest one at x where the material nowhere fills the smoothing radius (at fronts). Beside plates
// the deposit counts as mirrored, and what is behind one is not seen.
class Surface {
public:
    Surface(const World &world, const std::vector<char> &connected);
    bool empty() const { return points_.empty(); }
    // false where there is no material at x.
    bool height(double x, double &y) const;
    double left() const; // m, fronts with half a spacing added
    double right() const;
    // Highest point of the surface, with what the smoothing takes off a cusp.
    void peak(double &x, double &y) const;

private:
    class Strip;
    struct Point {
        double x, y;
        int32_t wall; // that mirrored it: its facet, then its place in walls_; -1: a particle
    };
    void add_mirrored(const Walls &walls, int64_t place, const Vector &at);
    void number_walls(const Walls &walls);
    bool height(double x, double radius, double &y, bool &full) const;
    bool is_filled(double x, double y, double radius) const; // half or more of the radius
    std::vector<double> stations_near_top() const;

    double spacing_;
    double x_min_ = -INFINITY, x_max_ = INFINITY; // ends of the period
    double left_ = INFINITY, right_ = -INFINITY;  // of the particles
    std::vector<Point> points_;                   // sorted by x
    std::vector<Segment> walls_;                  // that mirror some
};

// Where the mass lies: x, m, that has these shares of it on its left.
constexpr std::array<double, 7> mass_shares{0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99};
using MassMarks = std::array<double, mass_shares.size()>;
MassMarks measure_marks(const World &world);
// Over one stretch of particles after the other (stretches.hpp).
class CentreSums {
public:
    void add(const World &stretch);
    Vector of() const; // the centre of mass

private:
    bool begun_ = false;
    // x beside y: with the mass beside x, GCC rounds the products of x apart from the sum, and the last bit was another.
    double first_x_ = 0, first_y_ = 0, x_ = 0, y_ = 0, mass_ = 0;
};
class BoxOfAll {
public:
    void add(const World &stretch);
    const Box &of() const { return box_; }

private:
    Box box_{INFINITY, -INFINITY, INFINITY, -INFINITY};
};
double detached_share(const World &world, const std::vector<char> &connected); // outside of the connected deposit

// Has the material come to rest, and what moves it? gp_state.at_rest in gp.h says what that means. count, box: of all particles.
bool is_at_rest(const World &world, double kinetic, int64_t count, const Box &box);

// Interface of two bodies at heights y, n of them: x, NaN where they do not touch. y may be x.
void find_interface(const World &world, int32_t left, int32_t right, int64_t n, const double *y, double *x);

} // namespace gp
