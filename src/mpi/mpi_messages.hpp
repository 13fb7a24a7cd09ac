// Messages between the processes of a simulation, and how the failure of one of them comes to all.
//
// Whoever fails sends a notice to all, with the numbers of messages that it has sent and taken: so the others know which of
// theirs can still be done. Whoever waits has a receive posted for notices, and ends with one of its own where it would wait for
// ever. In the end all have the notices of all, which they judge alike, and have taken what was still on its way: for that alone
// memory is needed, as much as one message has, and who lacks it ends all (MPI_Abort). An error that all throw, after messages
// that say so, is told apart from one that is not shared: each gets as far as it can, whatever notices come before.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <mpi.h>

#include "error.hpp"

namespace gp::mpi {

// A communicator of its own, by MPI_Comm_dup.
class Communicator {
public:
    explicit Communicator(MPI_Comm of) { MPI_Comm_dup(of, &comm_); }
    Communicator(const Communicator &) = delete;
    Communicator &operator=(const Communicator &) = delete;
    ~Communicator();

    MPI_Comm get() const { return comm_; }
    MPI_Comm release();
    // Collective, for what needs no other process: all throw what one of them throws.
    void everywhere(const std::function<void()> &body) const;

private:
    MPI_Comm comm_ = MPI_COMM_NULL;
};

// What of many failures all are told. Those of lower ranks first.
class Verdict {
public:
    void add(int rank, bool met, const Failure &failure);
    bool is_of_all() const { return of_all_; } // all have met what they had foreseen
    Failure failure() const;

private:
    int rank_ = -1;
    bool of_all_ = true;
    Failure failure_;
};

class Messages {
public:
    explicit Messages(MPI_Comm comm); // sends nothing before begin
    Messages(const Messages &) = delete;
    Messages &operator=(const Messages &) = delete;
    ~Messages();
    void begin(); // the communicator is its own from here on

    MPI_Comm comm() const { return comm_; }
    int rank() const { return rank_; }
    int ranks() const { return ranks_; }

    // Up to 2 * ranks() of them, then wait for all: what is sent and received must stay until then, so nothing may throw in
    // between.
    void send(const void *data, int count, MPI_Datatype type, int to);
    void receive(void *data, int count, MPI_Datatype type, int from);
    void wait();

    SharedFailure fail(const Failure &failure) { return end(&failure); }
    void require_going() const {
        if (failed_)
            throw SharedFailure{failure_};
    }

private:
    struct Notice {
        int32_t rank, met; // met: by this one, not heard of
        Failure failure;
    };
    struct Counts { // of messages, since all have begun, or ended last
        int64_t sent, received;
    };
    struct Peer {
        Counts counts{};   // to it and from it
        int64_t asked = 0; // to be received, so far
        bool ended = false;
        Counts theirs{}; // when it ended: from it to this one, and from this one to it
    };
    struct Pending {
        int rank;
        bool in;
        int64_t number; // of those with that rank
    };
    void await_notice();
    void note(const Notice &notice);
    bool is_possible(const Pending &pending) const;
    SharedFailure end(const Failure *own);
    void take_rest_of(int rank);

    MPI_Comm comm_;
    bool begun_ = false;
    int at_end_ = MPI_KEYVAL_INVALID; // attribute by which MPI_Finalize ends the waiting for notices
    int rank_ = 0, ranks_ = 1;
    std::vector<Peer> peers_;
    std::vector<MPI_Request> requests_, end_requests_;
    std::vector<Pending> pending_; // of each request
    Notice incoming_{}, outgoing_{};
    MPI_Request notice_ = MPI_REQUEST_NULL;
    Verdict verdict_;
    bool failed_ = false;
    Failure failure_;
};

} // namespace gp::mpi
