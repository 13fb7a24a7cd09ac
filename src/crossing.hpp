// What crosses between the worlds of several processes. src/mpi knows how; a process alone has none, and pays nothing.
//
// All calls are collective: each of the processes makes them, in the same order. One that cannot go on, because it lacks memory
// for instance, calls fail: those that wait in another call then learn of it. All leave what they are in with the same
// SharedFailure, and nothing is left on its way.
#pragma once

#include <cstdint>
#include <vector>

#include "error.hpp"
#include "exact_sum.hpp"

namespace gp {

// So far, by this process.
struct Traffic {
    int64_t messages = 0, bytes = 0; // about single particles, sent in steps and readings
    int64_t reductions = 0, cuts = 0;
};

class Crossing {
public:
    virtual ~Crossing() = default;

    virtual int rank() const = 0; // 0 .. ranks() - 1
    virtual int ranks() const = 0;

    // What this process has met; returns what all are to throw. Where all have met what they had foreseen, they may go on; else no
    // more can be done together.
    virtual SharedFailure fail(const Failure &failure) = 0;
    // Throws what has ended it before, if anything.
    virtual void require_going() const = 0;

    virtual double waited() const = 0; // s, in all calls so far
    virtual Traffic traffic() const = 0;

    // Over all: the largest of each of some numbers, and the sums of others. Alike everywhere.
    virtual void combine(double *largest, int n_largest, Whole *sums, int n_sums) = 0;
    virtual void broadcast(void *data, int64_t bytes, int from) = 0;
    // Of all, in the order of rank: on rank 0 (elsewhere `all` is left empty), or everywhere.
    virtual void gather(const std::vector<double> &own, std::vector<double> &all) = 0;
    virtual void gather_everywhere(const std::vector<double> &own, std::vector<double> &all) = 0;
    // out: what each rank is to have of this one; in: what this one has of each.
    virtual void deal(const std::vector<std::vector<double>> &out, std::vector<std::vector<double>> &in) = 0;

    // Messages about particles, in each step: from now on so many go out to each rank and come in from each.
    virtual void link(const std::vector<int64_t> &out, const std::vector<int64_t> &in) = 0;
    // So many numbers of each particle, particle by particle, rank by rank.
    virtual void swap(const double *out, double *in, int numbers) = 0;

    // Whose is a place? Until a place is asked for, and when it is told, the plane is cut into boxes of equal work. work: of all
    // the places here together.
    virtual void cut(int64_t n, const double *x, const double *y, double work) = 0;
    virtual int owner(double x, double y) = 0;
};

// Are there others that wait?
inline bool is_shared(const Crossing *crossing) {
    return crossing && crossing->ranks() > 1;
}

// Runs body; all throw what one of them throws.
template <class Body> auto everywhere(Crossing *crossing, const Body &body) {
    if (!is_shared(crossing))
        return body();
    crossing->require_going();
    Failure failure;
    try {
        return body();
    } catch (const SharedFailure &) {
        throw;
    } catch (...) {
        failure = failure_at_hand();
    }
    throw crossing->fail(failure);
}

// And none goes on before all have succeeded. Returns what body returns, a status.
template <class Body> gp_status together(Crossing *crossing, const Body &body) {
    return everywhere(crossing, [&] {
        const gp_status status = body();
        if (is_shared(crossing))
            crossing->combine(nullptr, 0, nullptr, 0);
        return status;
    });
}

} // namespace gp
