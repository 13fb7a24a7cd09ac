// Particle fields by their bit in gp.h: the stored ones as they lie, the derived ones computed when asked for.
#pragma once

#include <cstdint>
#include <vector>

#include "world.hpp"

namespace gp {

// Values of one floating-point field (every GP_FIELD_... but ID and COLUMN) in the order of the particles: a pointer into
// the particles, or to scratch, which then holds the derived values.
const double *read_field(const World &world, uint32_t bit, Field<double> &scratch);

// Any fields, in the order of id and converted to double, of a world that may be in parts: some particles at a time. Collective.
class FieldsById {
public:
    explicit FieldsById(const World &world);
    int64_t count() const { return count_; } // of all processes
    // On the first process out: (count), those of the ids from `first` on.
    void read(uint32_t bit, int64_t first, int64_t count, double *out);

private:
    const World &world_;
    int64_t count_;
    std::vector<int32_t> by_id_; // the particles here
    uint32_t bit_ = 0;           // whose values these are
    const double *values_ = nullptr;
    Field<double> scratch_;
};

} // namespace gp
