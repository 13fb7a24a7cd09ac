// What becomes of each number of a struct that is added to a scene.
#pragma once

#include "api_support.hpp"

namespace api {

template <class T> struct Number {
    const char *name;
    double T::*member;
    std::vector<double> bad, good; // NaN and the infinities are bad for every field
};

// Adds `valid` with one field changed; each refusal names the field and leaves the simulation as it was.
template <class T, class Add> void check_numbers(const std::vector<Number<T>> &numbers, const T &valid, Add add) {
    Sim sim;
    const uint64_t epoch = sim.epoch();
    for (const Number<T> &field : numbers) {
        std::vector<double> bad = field.bad;
        bad.insert(bad.end(), {not_a_number, infinite, -infinite});
        for (const double value : bad) {
            SCOPED_TRACE(testing::Message() << field.name << " = " << value);
            T changed = valid;
            changed.*field.member = value;
            int32_t id = 55;
            EXPECT_FAILS(add(sim, &changed, &id), GP_E_ARGUMENT, field.name);
            EXPECT_EQ(id, 0);
        }
    }
    EXPECT_EQ(sim.epoch(), epoch);
    EXPECT_EQ(sim.count(), 0);
    for (const Number<T> &field : numbers)
        for (const double value : field.good) {
            SCOPED_TRACE(testing::Message() << field.name << " = " << value);
            T changed = valid;
            changed.*field.member = value;
            EXPECT_EQ(add(sim, &changed, nullptr), GP_OK) << gp_last_error();
        }
}

} // namespace api
