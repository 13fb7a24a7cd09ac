// Checks of numbers from outside: each failure names the argument, its value and what was expected.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include "error.hpp"

namespace gp {

// What an argument is called: "gx", or {"x", 3} for "x[3]" of an array, which is put together only where it is wrong.
class Name {
public:
    Name(const char *argument, int64_t index = -1) : argument_(argument), index_(index) {}
    std::string text() const {
        return index_ < 0 ? argument_ : format_text("%s[%lld]", argument_, static_cast<long long>(index_));
    }

private:
    const char *argument_;
    int64_t index_;
};

inline void require(bool ok, const Name &name, double value, const char *expected) {
    if (!ok)
        throw make_error(GP_E_ARGUMENT, "%s = %g: expected %s", name.text().c_str(), value, expected);
}

inline void require_finite(const Name &name, double value) {
    require(std::isfinite(value), name, value, "a finite number");
}

inline void require_positive(const Name &name, double value) {
    require(std::isfinite(value) && value > 0, name, value, "a finite number > 0");
}

inline void require_not_negative(const Name &name, double value) {
    require(std::isfinite(value) && value >= 0, name, value, "a finite number >= 0");
}

inline void require_between(const Name &name, double value, double low, double high) {
    if (!(value >= low && value <= high)) // written so that NaN fails
        throw make_error(GP_E_ARGUMENT, "%s = %g: expected a number from %g to %g", name.text().c_str(), value, low,
                         high);
}

// Speeds, accelerations and densities beyond this make energies that are no numbers.
constexpr double largest_quantity = 1e50; // SI

inline void require_quantity(const Name &name, double value) {
    require_between(name, value, -largest_quantity, largest_quantity);
}

// Positions beyond this many spacings from the origin no longer resolve the spacing well (to 2e-4 of it).
constexpr double farthest_position = 1e12; // dl

inline void require_position(const Name &name, double value, double spacing) {
    require_finite(name, value);
    const double limit = farthest_position * spacing;
    if (!(std::abs(value) <= limit))
        throw make_error(GP_E_ARGUMENT, "%s = %g: expected a number from %g to %g m, 1e12 spacings",
                         name.text().c_str(), value, -limit, limit);
}

inline void require_choice(const char *name, int64_t value, int64_t count) {
    if (count == 0)
        throw make_error(GP_E_ARGUMENT, "%s = %lld: the simulation has none yet, add it first", name,
                         static_cast<long long>(value));
    if (value < 0 || value >= count)
        throw make_error(GP_E_ARGUMENT, "%s = %lld: expected a whole number from 0 to %lld", name,
                         static_cast<long long>(value), static_cast<long long>(count - 1));
}

inline void require_pointer(const char *name, const void *pointer) {
    if (!pointer)
        throw make_error(GP_E_ARGUMENT, "%s = NULL: expected a pointer", name);
}

} // namespace gp
