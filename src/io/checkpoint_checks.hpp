// Checks of a checkpoint's numbers that the host's own checks do not see: that tables fit together and indices stay within.
#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "error.hpp"
#include "io/checkpoint_file.hpp"

namespace gp::io {

class Checker {
public:
    explicit Checker(const CheckpointReader &file) : file_(file) {}

    void require(bool good, const std::string &what) const {
        if (!good)
            file_.refuse(what);
    }
    // text(): made only where it is wanted, for what is required of each particle.
    template <class Text> void require_each(bool good, const Text &text) const {
        if (!good)
            file_.refuse(text());
    }
    template <class Array> void same_size(const char *what, const Array &array, std::size_t size) const {
        require(array.size() == size, format_text("%s: %zu values, expected %zu", what, array.size(), size));
    }
    template <class Array> void all_finite(const char *what, const Array &array) const {
        for (const double value : array)
            finite(what, value);
    }
    void finite(const char *what, double value) const {
        require_each(std::isfinite(value),
                     [&] { return format_text("%s: %g, expected a finite number", what, value); });
    }
    void not_negative(const char *what, double value) const {
        require(std::isfinite(value) && value >= 0, format_text("%s: %g, expected a number >= 0", what, value));
    }
    template <class Array> void permutation(const char *what, const Array &array) const {
        std::vector<bool> seen(array.size());
        for (const auto value : array) {
            const bool good = value >= 0 && static_cast<std::size_t>(value) < array.size() && !seen[value];
            require_each(good, [&] {
                return format_text("%s: %lld, expected each place once", what, static_cast<long long>(value));
            });
            seen[value] = true;
        }
    }

private:
    const CheckpointReader &file_;
};

} // namespace gp::io
