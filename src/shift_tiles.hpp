// How far particles that are near each other have moved against each other since the lists were made.
//
// By the sum over the steps of the largest difference of any two velocities in the scene the lists of a collapse are made anew
// twice as often as need be: its fronts run apart, and its fastest grains are far from what rests. So the places where the lists
// were made are cut into tiles, wider than the lists reach. Particles whose tiles are not next to each other were too far apart
// to come near, and of the others each two tiles' ranges of motion bound what any pair of theirs has done. The ranges are
// extremes, of all processes' particles: whoever has which of them, the bound is the same.
#pragma once

#include <vector>

#include "neighbors.hpp"
#include "particles.hpp"

namespace gp {

class ShiftTiles {
public:
    // Tiles over all particles' cells, with sides of `least` or more. box, count: of all particles; grid: of those that are here.
    void cut(const CellGrid &grid, const Box &box, int64_t count, double least);

    // The ranges of motion of the particles that are here, sorted as they were when the lists were made, from where they were then.
    void measure(const Particles &particles, const CellGrid &grid, const Field<double> &x, const Field<double> &y,
                 int threads);
    // To be combined with those of other processes' particles by the largest of each.
    std::vector<double> &extremes() { return extremes_; }

    // m, bounds by the ranges: on the shift of any two particles in the same tile or in tiles next to each other, of any two, and
    // of any from its place.
    struct Shifts {
        double near, any, own;
    };
    Shifts shifts() const;

    // m, by which particles at least were apart that were not in tiles next to each other.
    double width() const { return width_; }
    int64_t bytes() const { return static_cast<int64_t>(extremes_.capacity() * sizeof(double)); }

private:
    // Of one tile: the largest of -dx, dx, -dy and dy, -infinity where there is no particle.
    struct Range {
        double left = -INFINITY, right = -INFINITY, down = -INFINITY, up = -INFINITY;
        void add(const Range &other) {
            left = std::max(left, other.left);
            right = std::max(right, other.right);
            down = std::max(down, other.down);
            up = std::max(up, other.up);
        }
        // Between one of this and one of the other.
        double shift2(const Range &other) const {
            const double x = std::max(right + other.left, left + other.right);
            const double y = std::max(up + other.down, down + other.up);
            return right > -INFINITY && other.right > -INFINITY ? x * x + y * y : 0.0;
        }
    };
    Range range_of(int64_t tile) const {
        const double *e = extremes_.data() + 4 * tile;
        return {e[0], e[1], e[2], e[3]};
    }

    int64_t first_column_ = 0, first_row_ = 0, last_column_ = 0, last_row_ = 0; // cells
    int64_t wide_ = 1, high_ = 1;                                               // cells of a tile
    int64_t columns_ = 0, rows_ = 0;                                            // tiles
    bool closed_ = false; // the last column of tiles is next to the first
    double width_ = 0;
    std::vector<double> extremes_;
};

} // namespace gp
