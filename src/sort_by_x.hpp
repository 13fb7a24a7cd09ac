// Sorting what lies about evenly along x, some 5 times faster than by comparing alone.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace gp {

// Sorts items with a member x, finite, by `before`, for which a smaller x comes first: into as many bins as there are items,
// then within each.
template <class Item, class Before> void sort_by_x(std::vector<Item> &items, const Before &before) {
    const auto [first, last] =
        std::minmax_element(items.begin(), items.end(), [](const Item &a, const Item &b) { return a.x < b.x; });
    if (first == last)
        return;
    const double left = first->x, bins = static_cast<double>(items.size());
    const double scale = last->x > left ? 0.999 * bins / (last->x - left) : 0.0;
    const auto bin_of = [&](const Item &item) { return static_cast<std::size_t>((item.x - left) * scale); };
    std::vector<std::size_t> end(items.size() + 1, 0); // of each bin, shifted by one until all are placed
    for (const Item &item : items)
        ++end[bin_of(item) + 1];
    for (std::size_t bin = 1; bin < end.size(); ++bin)
        end[bin] += end[bin - 1];
    std::vector<Item> sorted(items.size());
    for (const Item &item : items)
        sorted[end[bin_of(item)]++] = item;
    for (std::size_t bin = 0; bin + 1 < end.size(); ++bin) {
        const auto begin = sorted.begin() + static_cast<std::ptrdiff_t>(bin > 0 ? end[bin - 1] : 0);
        std::sort(begin, sorted.begin() + static_cast<std::ptrdiff_t>(end[bin]), before);
    }
    items.swap(sorted);
}

} // namespace gp
