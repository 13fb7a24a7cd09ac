// Particle fields by their bit in gp.h: the stored ones as they lie, the derived ones computed when asked for.
#pragma once

#include <cstdint>

#include "world.hpp"

namespace gp {

// Values of one floating-point field (every GP_FIELD_... but ID and COLUMN) in the order of the particles: a pointer into
// the particles, or to scratch, which then holds the derived values.
const double *read_field(const World &world, uint32_t bit, Field<double> &scratch);

// The same for any field, copied in the order of id and converted to double. out: shape (count).
void copy_field_by_id(const World &world, uint32_t bit, double *out);

} // namespace gp
