#include "mpi/mpi_crossing.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "error.hpp"

namespace gp::mpi {

namespace {

constexpr int tag = 20;

// What is combined, in one piece: this, then sums, then the numbers of which the largest are wanted.
struct alignas(16) Head {
    int32_t sums, largest;
};

void combine_pieces(void *in, void *inout, int *, MPI_Datatype *) {
    const Head head = *static_cast<const Head *>(in);
    const auto *sums = reinterpret_cast<const Whole *>(static_cast<const char *>(in) + sizeof(Head));
    auto *all_sums = reinterpret_cast<Whole *>(static_cast<char *>(inout) + sizeof(Head));
    for (int k = 0; k < head.sums; ++k)
        all_sums[k] += sums[k];
    const auto *largest = reinterpret_cast<const double *>(sums + head.sums);
    auto *largest_of_all = reinterpret_cast<double *>(all_sums + head.sums);
    for (int k = 0; k < head.largest; ++k)
        if (largest[k] > largest_of_all[k] || std::isnan(largest[k]))
            largest_of_all[k] = largest[k];
}

int count_of(int64_t numbers) {
    if (numbers > INT32_MAX)
        throw make_error(GP_E_UNSUPPORTED, "%lld numbers in one message: expected at most %d; take more processes",
                         static_cast<long long>(numbers), INT32_MAX);
    return static_cast<int>(numbers);
}

} // namespace

// Adds to the time waited.
class MpiCrossing::Timer {
public:
    explicit Timer(double &total) : total_(total), begin_(MPI_Wtime()) {}
    Timer(const Timer &) = delete;
    Timer &operator=(const Timer &) = delete;
    ~Timer() { total_ += MPI_Wtime() - begin_; }

private:
    double &total_;
    double begin_;
};

MpiCrossing::MpiCrossing(MPI_Comm comm) {
    MPI_Comm_dup(comm, &comm_);
    MPI_Comm_rank(comm_, &rank_);
    MPI_Comm_size(comm_, &ranks_);
    MPI_Op_create(combine_pieces, 1, &combine_);
    cut_ = std::make_unique<ZoltanCut>(comm_);
}

MpiCrossing::~MpiCrossing() {
    int finalized = 0;
    MPI_Finalized(&finalized);
    if (finalized) {
        static_cast<void>(cut_.release()); // its memory goes with the process
        return;
    }
    cut_.reset();
    for (auto &type : types_)
        MPI_Type_free(&type.second);
    MPI_Op_free(&combine_);
    MPI_Comm_free(&comm_);
}

// One item, so that no implementation takes it apart.
MPI_Datatype MpiCrossing::type_of(std::size_t bytes) {
    const auto found = types_.find(bytes);
    if (found != types_.end())
        return found->second;
    MPI_Datatype type;
    MPI_Type_contiguous(static_cast<int>(bytes), MPI_BYTE, &type);
    MPI_Type_commit(&type);
    return types_[bytes] = type;
}

void MpiCrossing::combine(double *largest, int n_largest, Whole *sums, int n_sums) {
    if (ranks_ == 1)
        return;
    const Timer timer(waited_);
    ++traffic_.reductions;
    const Head head{n_sums, n_largest};
    const std::size_t bytes = sizeof head + sizeof(Whole) * static_cast<std::size_t>(n_sums) +
                              sizeof(double) * static_cast<std::size_t>(n_largest);
    in_.resize((bytes + sizeof(Whole) - 1) / sizeof(Whole));
    out_.resize(in_.size());
    auto *const in = reinterpret_cast<unsigned char *>(in_.data()), *const out =
                                                                        reinterpret_cast<unsigned char *>(out_.data());
    std::memcpy(in, &head, sizeof head);
    if (n_sums > 0)
        std::memcpy(in + sizeof head, sums, sizeof(Whole) * static_cast<std::size_t>(n_sums));
    const std::size_t first = sizeof head + sizeof(Whole) * static_cast<std::size_t>(n_sums);
    if (n_largest > 0)
        std::memcpy(in + first, largest, sizeof(double) * static_cast<std::size_t>(n_largest));
    MPI_Allreduce(in, out, 1, type_of(bytes), combine_, comm_);
    if (n_sums > 0)
        std::memcpy(sums, out + sizeof head, sizeof(Whole) * static_cast<std::size_t>(n_sums));
    if (n_largest > 0)
        std::memcpy(largest, out + first, sizeof(double) * static_cast<std::size_t>(n_largest));
}

void MpiCrossing::broadcast(void *data, int64_t bytes, int from) {
    const Timer timer(waited_);
    for (auto *at = static_cast<unsigned char *>(data); bytes > 0;) {
        const int64_t piece = std::min<int64_t>(bytes, 1 << 30);
        MPI_Bcast(at, static_cast<int>(piece), MPI_BYTE, from, comm_);
        at += piece;
        bytes -= piece;
    }
}

namespace {

std::vector<int> places_of(const std::vector<int> &counts) {
    std::vector<int> places(counts.size(), 0);
    int64_t place = 0;
    for (std::size_t k = 0; k < counts.size(); ++k) {
        places[k] = count_of(place);
        place += counts[k];
    }
    count_of(place);
    return places;
}

} // namespace

void MpiCrossing::gather(const std::vector<double> &own, std::vector<double> &all) {
    const Timer timer(waited_);
    const int count = count_of(static_cast<int64_t>(own.size()));
    std::vector<int> counts(static_cast<std::size_t>(ranks_));
    MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, comm_);
    const std::vector<int> places = places_of(counts); // fails everywhere or nowhere
    all.resize(rank_ == 0 ? static_cast<std::size_t>(places.back()) + static_cast<std::size_t>(counts.back()) : 0);
    MPI_Gatherv(own.data(), count, MPI_DOUBLE, all.data(), counts.data(), places.data(), MPI_DOUBLE, 0, comm_);
}

void MpiCrossing::gather_everywhere(const std::vector<double> &own, std::vector<double> &all) {
    const Timer timer(waited_);
    const int count = count_of(static_cast<int64_t>(own.size()));
    std::vector<int> counts(static_cast<std::size_t>(ranks_));
    MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, comm_);
    const std::vector<int> places = places_of(counts);
    all.resize(static_cast<std::size_t>(places.back()) + static_cast<std::size_t>(counts.back()));
    MPI_Allgatherv(own.data(), count, MPI_DOUBLE, all.data(), counts.data(), places.data(), MPI_DOUBLE, comm_);
}

void MpiCrossing::deal(const std::vector<std::vector<double>> &out, std::vector<std::vector<double>> &in) {
    const Timer timer(waited_);
    const auto ranks = static_cast<std::size_t>(ranks_);
    std::vector<int> to(ranks), from(ranks);
    for (std::size_t k = 0; k < ranks; ++k)
        to[k] = count_of(static_cast<int64_t>(out[k].size()));
    MPI_Alltoall(to.data(), 1, MPI_INT, from.data(), 1, MPI_INT, comm_);
    in.assign(ranks, {});
    requests_.clear();
    for (int rank = 0; rank < ranks_; ++rank) {
        in[rank].resize(static_cast<std::size_t>(from[rank]));
        if (from[rank] > 0 && rank != rank_)
            MPI_Irecv(in[rank].data(), from[rank], MPI_DOUBLE, rank, tag, comm_, &requests_.emplace_back());
    }
    for (int rank = 0; rank < ranks_; ++rank)
        if (rank == rank_)
            in[rank] = out[rank];
        else if (to[rank] > 0)
            MPI_Isend(out[rank].data(), to[rank], MPI_DOUBLE, rank, tag, comm_, &requests_.emplace_back());
    MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
}

void MpiCrossing::link(const std::vector<int64_t> &out, const std::vector<int64_t> &in) {
    links_.clear();
    int64_t first_out = 0, first_in = 0;
    for (int rank = 0; rank < ranks_; ++rank) {
        if (out[rank] > 0 || in[rank] > 0)
            links_.push_back({rank, first_out, out[rank], first_in, in[rank]});
        first_out += out[rank];
        first_in += in[rank];
    }
}

void MpiCrossing::swap(const double *out, double *in, int numbers) {
    const Timer timer(waited_);
    requests_.clear();
    for (const Link &link : links_)
        if (link.in > 0 && link.rank != rank_)
            MPI_Irecv(in + numbers * link.first_in, count_of(numbers * link.in), MPI_DOUBLE, link.rank, tag, comm_,
                      &requests_.emplace_back());
    for (const Link &link : links_) {
        const double *const first = out + numbers * link.first_out;
        if (link.rank == rank_) {
            std::copy_n(first, numbers * link.out, in + numbers * link.first_in);
        } else if (link.out > 0) {
            MPI_Isend(first, count_of(numbers * link.out), MPI_DOUBLE, link.rank, tag, comm_,
                      &requests_.emplace_back());
            ++traffic_.messages;
            traffic_.bytes += 8 * numbers * link.out;
        }
    }
    MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
}

void MpiCrossing::cut(int64_t n, const double *x, const double *y, double work) {
    const Timer timer(waited_);
    ++traffic_.cuts;
    cut_->cut(n, x, y, work);
}

} // namespace gp::mpi
