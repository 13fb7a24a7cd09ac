// The particles of a checkpoint on several processes: each writes and reads those that it has, some at a time, so that nobody
// holds all of them. The file is that of a process alone.
#pragma once

#include <functional>
#include <vector>

#include "io/checkpoint_checks.hpp"
#include "parts.hpp"

namespace gp::io {

// In the file's order, on the first process. Collective.
class RowWriter {
public:
    // The group is open; all: of all processes.
    RowWriter(CheckpointWriter &file, const World &part, int64_t all);
    void append(const std::vector<const double *> &rows);

private:
    using Rows = std::vector<const double *>;
    template <class T> void begin(const char *name, std::size_t size);

    CheckpointWriter &file_;
    std::vector<std::function<void(const Rows &rows, std::size_t column)>> columns_;
};
// Collective; take is called on the first process. All throw what it throws.
void for_each_row(const World &part, const std::function<void(const std::vector<const double *> &rows)> &take);

// Beyond so many spacings, lattice points behind a plate cannot be counted.
constexpr double farthest_of_lists = 1e15;
// Of the first so many particles, of which lists are to be made.
void check_list_positions(const Checker &check, const World &world, int64_t count);

// Numbers of so many particles, by the name of their array.
void check_numbers(const Checker &check, const World &world, const char *name, const int32_t *column,
                   const double *values, std::size_t count);

// Particles with their fields, lists as they were made: plates are where they were then. Collective.
void read_rows(const CheckpointReader &file, const Checker &check, World &part);

} // namespace gp::io
