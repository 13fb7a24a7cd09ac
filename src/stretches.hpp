// What is to be told or written of all particles of a world in parts: they come to the first process some at a time, so that
// it never has all of them.
//
// All calls are collective; for a world that is no part they are loops over it.
#pragma once

#include <cstring>
#include <functional>
#include <type_traits>
#include <vector>

#include "parts.hpp"

namespace gp {

// So many particles of all processes come at a time.
constexpr int64_t stretch_size = 65536;

int64_t count_of_all(const World &world);

// Calls body on the first process with worlds of some particles each, in the order in which a process alone has them: so a sum
// over them is to the last bit what that one finds. They have what such sums are of: positions, velocities, densities and
// stresses, no lists. flags: one of each particle, for body, or empty. All throw what body throws.
using TakeStretch = std::function<void(const World &stretch, const char *flags)>;
void for_each_stretch(const World &world, const std::vector<char> &flags, const TakeStretch &body);

// Rows of numbers, ever more of them, in the order of their keys of three numbers: those of each process are so already.
constexpr int key_numbers = 3;
struct OrderedRows {
    int64_t count = 0; // here
    int numbers = 0;   // of each
    std::function<void(int64_t row, double *key)> key_of;
    std::function<void(int64_t row, double *out)> pack;
};
using TakeRows = std::function<void(const std::vector<const double *> &rows)>;
void take_in_order(Crossing &crossing, const OrderedRows &own, const TakeRows &body);

// The place in the order of cells of the k-th particle; columns: to add to its column.
void key_of_cell(const World &part, int64_t k, int64_t columns, double *key);

// As many turns on each process as the one needs that has most; of all together no more than stretch_size items are in one.
void for_each_turn(Crossing &crossing, int64_t count, const std::function<void(int64_t begin, int64_t end)> &body);

// Numbers of this process, in pieces of a size at most, to the first one: body gets those of all, piece by piece, of each process a
// multiple of so many, or the rest.
constexpr int64_t collected_numbers = 3 * 4;
void collect_numbers(Crossing &crossing, const double *own, int64_t count,
                     const std::function<void(int64_t all)> &make_room,
                     const std::function<void(const std::vector<double> &piece)> &body);

// Items of all processes on the first of them; elsewhere none.
template <class Item> void collect(Crossing *crossing, std::vector<Item> &items) {
    static_assert(std::is_trivially_copyable_v<Item> && sizeof(Item) % sizeof(double) == 0);
    if (!crossing)
        return;
    constexpr std::size_t numbers = sizeof(Item) / sizeof(double);
    static_assert(collected_numbers % numbers == 0, "a piece has whole items");
    std::vector<Item> own;
    own.swap(items);
    collect_numbers(
        *crossing, reinterpret_cast<const double *>(own.data()), static_cast<int64_t>(own.size() * numbers),
        [&](int64_t all) { items.reserve(static_cast<std::size_t>(all) / numbers); },
        [&](const std::vector<double> &piece) {
            const std::size_t before = items.size();
            items.resize(before + piece.size() / numbers);
            std::memcpy(static_cast<void *>(items.data() + before), piece.data(), piece.size() * sizeof(double));
        });
}

} // namespace gp
