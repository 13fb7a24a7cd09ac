// A world in parts, each with the particles of one process: what a step of one needs of the others (halo.hpp has the messages
// about single particles).
#pragma once

#include <array>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "binned_sum.hpp"
#include "error.hpp"
#include "world.hpp"

namespace gp {

// GP_E_UNSUPPORTED if a scene cannot be worked on in parts.
void require_partable(const Scene &scene);
// The part of a process, without particles.
std::unique_ptr<World> make_part(const Scene &scene, Crossing &crossing);
// That with an equal share of the scene's particles, as they begin: with the first lists they go to their owners.
std::unique_ptr<World> begin_part(const Scene &scene, Crossing &crossing);

// The sum of a number of each process, J/m.
double sum_of_all(const World &world, double energy);

int64_t sum_of_all(Crossing &crossing, int64_t count);

// Of rows of so many numbers, of which each process has none, one or some, the least by its first `keys` numbers; the first of equal
// ones. Empty where there is none.
std::vector<double> least_of_all(Crossing &crossing, const std::vector<double> &own, int64_t numbers, int64_t keys);

// Sums, no more than so many, and the largest of a number of each process: of all.
constexpr int most_sums = 4;
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

// Runs body, which only reads the world, on the first process. All throw what it throws there: an Error also where that is
// of memory, so that the simulation goes on.
void run_on_first(Crossing &crossing, const std::function<void()> &body);
// The same where there may be no others (NULL, a world that is no part): then here.
template <class Body> void on_first(Crossing *crossing, const Body &body) {
    if (crossing)
        run_on_first(*crossing, body);
    else
        body();
}
template <class Body> void on_first(const World &world, const Body &body) {
    on_first(world.crossing, body);
}

// What one process has goes to all, if there are others.
template <class T> void tell_all(Crossing *crossing, T *values, int64_t count = 1, int from = 0) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (crossing)
        crossing->broadcast(values, count * static_cast<int64_t>(sizeof(T)), from);
}
// As many as there are: of a vector or a text.
template <class Values> void tell_all_of(Crossing &crossing, Values &values, int from = 0) {
    auto size = static_cast<int64_t>(values.size());
    tell_all(&crossing, &size, 1, from);
    values.resize(static_cast<std::size_t>(size));
    tell_all(&crossing, values.data(), size, from);
}

// What is done on the first process while the others send: it goes on taking what they send when something fails, and all throw
// that in the end.
class OnFirst {
public:
    explicit OnFirst(Crossing &crossing) : crossing_(crossing) {}
    template <class Body> void run(const Body &body) {
        if (crossing_.rank() > 0 || failure_)
            return;
        try {
            body();
        } catch (const SharedFailure &) {
            throw;
        } catch (...) {
            failure_ = std::current_exception();
        }
    }
    void finish() {
        run_on_first(crossing_, [this] {
            if (failure_)
                std::rethrow_exception(failure_);
        });
    }

private:
    Crossing &crossing_;
    std::exception_ptr failure_;
};
// A step that diverges. key: the place, in the order in which a process alone looks at checks and particles.
class Divergence : public Error {
public:
    Divergence(const Error &error, const std::array<double, 4> &at) : Error(error), key(at) {}
    std::array<double, 4> key;
};
// Throws everywhere what look() throws anywhere: what a process alone would, of what is told apart by no key that of the lowest
// rank; look() is called where there is something suspect.
void require_bounded_everywhere(const World &world, bool suspect, const std::function<void()> &look);
// The text of the rank with the largest value.
std::string text_of_largest(Crossing &crossing, double &value, const std::string &text);

} // namespace gp
