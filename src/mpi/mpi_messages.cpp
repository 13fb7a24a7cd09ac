#include "mpi/mpi_messages.hpp"

#include <algorithm>
#include <cstdlib>

namespace gp::mpi {

namespace {

constexpr int tag = 20, notice_tag = 21, count_tag = 22;

bool is_finalised() {
    int finalised = 0;
    MPI_Finalized(&finalised);
    return finalised != 0;
}

// Takes a receive back. Has it got its message all the same?
bool take_back(MPI_Request &request) {
    if (request == MPI_REQUEST_NULL)
        return false;
    MPI_Status status;
    int cancelled;
    MPI_Cancel(&request);
    MPI_Wait(&request, &status);
    MPI_Test_cancelled(&status, &cancelled);
    return !cancelled;
}

} // namespace

// ------------------------------------------------------------------------------------------- communicator

Communicator::~Communicator() {
    if (comm_ != MPI_COMM_NULL && !is_finalised())
        MPI_Comm_free(&comm_);
}

MPI_Comm Communicator::release() {
    const MPI_Comm comm = comm_;
    comm_ = MPI_COMM_NULL;
    return comm;
}

void Communicator::everywhere(const std::function<void()> &body) const {
    Failure failure;
    try {
        body();
    } catch (...) {
        failure = failure_at_hand();
    }
    int rank, ranks;
    MPI_Comm_rank(comm_, &rank);
    MPI_Comm_size(comm_, &ranks);
    // The lowest rank that has failed; is there one that has not?
    const bool met = failure.status != GP_OK;
    int own[2] = {met ? rank : ranks, met && failure.foreseen ? 1 : 0}, all[2];
    MPI_Allreduce(own, all, 2, MPI_INT, MPI_MIN, comm_);
    if (all[0] == ranks)
        return;
    MPI_Bcast(&failure, sizeof failure, MPI_BYTE, all[0], comm_);
    Verdict verdict;
    verdict.add(all[0], true, failure);
    if (!all[1])
        verdict.add(ranks, false, {});
    throw SharedFailure{verdict.failure()};
}

// ------------------------------------------------------------------------------------------------ verdict

void Verdict::add(int rank, bool met, const Failure &failure) {
    of_all_ = of_all_ && met && failure.foreseen && (rank_ < 0 || failure.status == failure_.status);
    if (met && (rank_ < 0 || rank < rank_)) {
        rank_ = rank;
        failure_ = failure;
    }
}

Failure Verdict::failure() const {
    if (of_all_)
        return failure_;
    Failure named = failure_;
    name_rank(named, rank_);
    return named;
}

// ----------------------------------------------------------------------------------------------- messages

Messages::Messages(MPI_Comm comm) : comm_(comm) {
    MPI_Comm_rank(comm_, &rank_);
    MPI_Comm_size(comm_, &ranks_);
    const auto ranks = static_cast<std::size_t>(ranks_);
    peers_.resize(ranks);
    requests_.reserve(2 * ranks);
    pending_.reserve(2 * ranks);
    end_requests_.reserve(2 * ranks);
}

// MPI_Finalize begins with the attributes of MPI_COMM_SELF: a host may call it before gp_destroy.
void Messages::begin() {
    begun_ = true;
    MPI_Comm_create_keyval(
        MPI_COMM_NULL_COPY_FN,
        [](MPI_Comm, int, void *self, void *) {
            take_back(static_cast<Messages *>(self)->notice_);
            return MPI_SUCCESS;
        },
        &at_end_, nullptr);
    MPI_Comm_set_attr(MPI_COMM_SELF, at_end_, this);
    await_notice();
}

Messages::~Messages() {
    if (!begun_ || is_finalised())
        return;
    MPI_Comm_delete_attr(MPI_COMM_SELF, at_end_); // takes back the notice
    MPI_Comm_free_keyval(&at_end_);
    MPI_Comm_free(&comm_);
}

void Messages::send(const void *data, int count, MPI_Datatype type, int to) {
    require_going();
    MPI_Isend(data, count, type, to, tag, comm_, &requests_.emplace_back());
    pending_.push_back({to, false, ++peers_[to].counts.sent});
}

void Messages::receive(void *data, int count, MPI_Datatype type, int from) {
    require_going();
    MPI_Irecv(data, count, type, from, tag, comm_, &requests_.emplace_back());
    pending_.push_back({from, true, ++peers_[from].asked});
}

void Messages::wait() {
    require_going();
    for (std::size_t k = 0; k < requests_.size();) {
        if (!is_possible(pending_[k]))
            throw end(nullptr);
        MPI_Request either[2] = {requests_[k], notice_};
        int which;
        MPI_Waitany(2, either, &which, MPI_STATUS_IGNORE);
        requests_[k] = either[0];
        notice_ = either[1];
        if (which == 1) {
            note(incoming_);
            await_notice();
            continue;
        }
        peers_[pending_[k].rank].counts.received += pending_[k].in;
        ++k;
    }
    requests_.clear();
    pending_.clear();
}

// ------------------------------------------------------------------------------------------------- notices

void Messages::await_notice() {
    if (ranks_ > 1)
        MPI_Irecv(&incoming_, sizeof incoming_, MPI_BYTE, MPI_ANY_SOURCE, notice_tag, comm_, &notice_);
}

void Messages::note(const Notice &notice) {
    Peer &peer = peers_[notice.rank];
    peer.ended = true;
    MPI_Recv(&peer.theirs, sizeof peer.theirs, MPI_BYTE, notice.rank, count_tag, comm_, MPI_STATUS_IGNORE);
    verdict_.add(notice.rank, notice.met, notice.failure);
}

bool Messages::is_possible(const Pending &pending) const {
    const Peer &peer = peers_[pending.rank];
    return !peer.ended || pending.number <= (pending.in ? peer.theirs.sent : peer.theirs.received);
}

// own: what this one has met; NULL: it would wait for ever. Any rank's notice is awaited only until this one has sent its own: who
// has the notices of all goes on, and may send that of a next failure.
SharedFailure Messages::end(const Failure *own) {
    require_going();
    for (std::size_t k = 0; k < requests_.size(); ++k)
        if (pending_[k].in && take_back(requests_[k]))
            ++peers_[pending_[k].rank].counts.received;
    if (take_back(notice_))
        note(incoming_);
    outgoing_ = {rank_, own != nullptr, own ? *own : Failure()};
    verdict_.add(rank_, own != nullptr, outgoing_.failure);
    for (int rank = 0; rank < ranks_; ++rank)
        if (rank != rank_) {
            MPI_Isend(&outgoing_, sizeof outgoing_, MPI_BYTE, rank, notice_tag, comm_, &end_requests_.emplace_back());
            MPI_Isend(&peers_[rank].counts, sizeof(Counts), MPI_BYTE, rank, count_tag, comm_,
                      &end_requests_.emplace_back());
        }
    for (int rank = 0; rank < ranks_; ++rank)
        if (rank != rank_ && !peers_[rank].ended) {
            MPI_Recv(&incoming_, sizeof incoming_, MPI_BYTE, rank, notice_tag, comm_, MPI_STATUS_IGNORE);
            note(incoming_);
        }
    for (int rank = 0; rank < ranks_; ++rank)
        if (rank != rank_)
            take_rest_of(rank);
    MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
    MPI_Waitall(static_cast<int>(end_requests_.size()), end_requests_.data(), MPI_STATUSES_IGNORE);

    requests_.clear();
    pending_.clear();
    end_requests_.clear();
    std::fill(peers_.begin(), peers_.end(), Peer());
    failure_ = verdict_.failure();
    failed_ = !verdict_.is_of_all();
    verdict_ = Verdict();
    if (!failed_)
        await_notice();
    return {failure_};
}

// In room of its size. Open MPI 4.1 writes beyond what is given where a message is longer, and ends the process.
void Messages::take_rest_of(int rank) {
    for (int64_t left = peers_[rank].theirs.sent - peers_[rank].counts.received; left > 0; --left) {
        MPI_Status status;
        MPI_Probe(rank, tag, comm_, &status);
        MPI_Datatype type = MPI_BYTE;
        int count;
        MPI_Get_count(&status, type, &count);
        if (count == MPI_UNDEFINED) // More bytes than an int holds: then it is of doubles.
            MPI_Get_count(&status, type = MPI_DOUBLE, &count);
        void *const room = std::malloc((type == MPI_BYTE ? 1 : sizeof(double)) * static_cast<std::size_t>(count) + 1);
        if (!room)
            MPI_Abort(comm_, 1);
        MPI_Recv(room, count, type, rank, tag, comm_, MPI_STATUS_IGNORE);
        std::free(room);
    }
}

} // namespace gp::mpi
