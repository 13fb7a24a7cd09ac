// Items of which a checkpoint keeps each number as an array of its own, as those of a material or a plate: for_each calls
// visit(name, number) for each of them, number being a member or whatever else std::invoke makes a number of an item by.
#pragma once

#include <functional>
#include <type_traits>
#include <utility>
#include <vector>

#include "io/checkpoint_checks.hpp"

namespace gp::io {

// What the file has of a number: a bool is a 32-bit integer.
template <class Item, class Number> struct StoredNumber {
    using Own = std::decay_t<std::invoke_result_t<const Number &, Item &>>;
    using type = std::conditional_t<std::is_same_v<Own, bool>, int32_t, Own>;
};

template <class Item, class ForEach>
void write_items(CheckpointWriter &file, const std::vector<Item> &items, const ForEach &for_each) {
    for_each([&](const char *name, const auto &number) {
        std::vector<typename StoredNumber<const Item, std::decay_t<decltype(number)>>::type> values;
        values.reserve(items.size());
        for (const Item &item : items)
            values.push_back(std::invoke(number, item));
        file.array(name, values);
    });
}

// Of items that are there.
template <class Item, class ForEach>
void read_items(CheckpointReader &file, const Checker &check, std::vector<Item> &items, const ForEach &for_each) {
    for_each([&](const char *name, const auto &number) {
        std::vector<typename StoredNumber<Item, std::decay_t<decltype(number)>>::type> values;
        file.array(name, values);
        check.same_size(name, values, items.size());
        for (std::size_t k = 0; k < values.size(); ++k) {
            auto &own = std::invoke(number, items[k]);
            own = static_cast<std::decay_t<decltype(own)>>(values[k]);
        }
    });
}

// As many as there are of the first number; of the others there have to be as many.
template <class Item, class ForEach>
std::vector<Item> read_items(CheckpointReader &file, const Checker &check, const Item &blank, const ForEach &for_each) {
    std::vector<Item> items;
    bool first = true;
    for_each([&](const char *name, const auto &number) {
        if (std::exchange(first, false))
            items.assign(file.size_of<typename StoredNumber<Item, std::decay_t<decltype(number)>>::type>(name), blank);
    });
    read_items(file, check, items, for_each);
    return items;
}

} // namespace gp::io
