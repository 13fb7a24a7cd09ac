// A world in parts, each with the particles of one process: what a step of one needs of the others (halo.hpp has the messages
// about single particles).
#pragma once

#include <functional>
#include <string>

#include "binned_sum.hpp"
#include "world.hpp"

namespace gp {

// The sum of a number of each process, J/m.
double sum_of_all(const World &world, double energy);

// Sums, and the largest of a number of each process: of all.
void combine_sums(Crossing &crossing, BinnedSum *sums, int n_sums, double &largest);

// The extremes, sums and loads of a step, and what it adds to the ledger: of all parts.
void combine_books(World &world, BlockRange &range, BlockSums &total);

// Particles go to the process whose cells they are in. Now and then, when the work has become uneven, the cells are dealt out
// anew.
void go_to_owners(World &world, const CellFrame &frame);
// The fields that go with a particle.
std::vector<Field<double> *> carried_fields(Particles &particles);
// Room for so many particles.
void resize_part(World &world, int64_t count);

// Throws everywhere what look() throws anywhere, by the lowest rank; look() is called where there is something suspect.
void require_bounded_everywhere(const World &world, bool suspect, const std::function<void()> &look);
// The text of the rank with the largest value.
std::string text_of_largest(Crossing &crossing, double &value, const std::string &text);

} // namespace gp
