// The particles of other processes that those here see, directly or by way of the ghosts of plates, and messages about them.
// In a periodic scene also particles of this process itself, across an end.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <vector>

#include "crossing.hpp"
#include "geometry.hpp"
#include "neighbors.hpp"
#include "particles.hpp"
#include "sleep.hpp"

namespace gp {

class Halo {
public:
    explicit Halo(Crossing &crossing) : crossing_(crossing) {}

    // Finds who sees whom: particles within `reach` of the box around those of another process. The particles are in order.
    void find(const Particles &particles, const CellFrame &frame, const Period &period, double reach);

    int64_t count() const { return static_cast<int64_t>(id_.size()); }
    const std::vector<int64_t> &ids() const { return id_; }
    const Cell &cell(int64_t k) const { return cell_[k]; }
    // order[k]: which one is the k-th of those behind the particles; tells their columns.
    void set_order(const Field<int32_t> &order, int64_t first, int32_t *column);

    // Takes the values of fields over, one message to each neighbour for all of them. motion: x, y, and velocities.
    void copy(std::initializer_list<Field<double> *> fields);
    void copy_collisions(std::initializer_list<Field<double> *> fields, Field<uint8_t> &partners,
                         Field<float> &crowded);
    void copy_motion(Particles &particles);
    void copy_motion(Particles &particles, Sleep &sleep); // and whose spans are restless
    void copy_rest(Sleep &sleep);                         // that, and which plates they touch

    int64_t bytes() const;

private:
    template <class Pack, class Unpack> void exchange(int numbers, const Pack &pack, const Unpack &unpack);

    Crossing &crossing_;
    std::vector<int32_t> source_; // particle of each thing to send, rank by rank
    std::vector<double> shift_;   // m, a period or none
    std::vector<int64_t> id_;     // of those that come in, as they come
    std::vector<Cell> cell_;
    std::vector<int32_t> column_, place_; // place_: index of each behind the particles
    std::vector<double> out_, in_;
};

} // namespace gp
