#include "mpi/mpi_crossing.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "error.hpp"

namespace gp::mpi {

namespace {

// What is combined, in one piece: this, then sums, then the numbers of which the largest are wanted.
struct alignas(16) Head {
    int32_t purpose, sums, largest;
};

void combine_pieces(const void *in, void *inout) {
    const Head head = *static_cast<const Head *>(in);
    const Head expected = *static_cast<const Head *>(inout);
    if (head.purpose != expected.purpose || head.sums != expected.sums || head.largest != expected.largest)
        throw make_error(GP_E_STATE, "another process makes another call: expected the same ones, in the same order");
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

std::shared_ptr<MpiCrossing> MpiCrossing::between_all_of(MPI_Comm comm) {
    Communicator own(comm); // before anything of one process can fail
    std::shared_ptr<MpiCrossing> crossing;
    own.everywhere([&] { crossing = std::make_shared<MpiCrossing>(own.get()); });
    own.release();
    crossing->messages_.begin();
    everywhere(crossing.get(), [&] { crossing->cut_.begin(crossing->messages_.comm()); });
    return crossing;
}

// ---------------------------------------------------------------------------------------------- reductions

// By recursive doubling. What is combined is exact, so that the order does not matter.
void MpiCrossing::combine_for(Purpose purpose, double *largest, int n_largest, Whole *sums, int n_sums) {
    if (ranks() == 1)
        return;
    const Timer timer(waited_);
    ++traffic_.reductions;
    const Head head{static_cast<int32_t>(purpose), n_sums, n_largest};
    const std::size_t sums_bytes = sizeof(Whole) * static_cast<std::size_t>(n_sums);
    const std::size_t first = sizeof head + sums_bytes,
                      largest_bytes = sizeof(double) * static_cast<std::size_t>(n_largest);
    const std::size_t bytes = first + largest_bytes;
    constexpr std::size_t least = 256; // of another call's combination there is room, too: then it is found out
    in_.resize(std::max({in_.size(), least, (bytes + sizeof(Whole) - 1) / sizeof(Whole)}));
    out_.resize(in_.size());
    auto *const out = reinterpret_cast<unsigned char *>(out_.data());
    std::memcpy(out, &head, sizeof head);
    if (n_sums > 0)
        std::memcpy(out + sizeof head, sums, sums_bytes);
    if (n_largest > 0)
        std::memcpy(out + first, largest, largest_bytes);

    // Those beyond a power of two hand theirs to a partner, and get the result of it.
    const int count = count_of(static_cast<int64_t>(bytes));
    const int room = count_of(static_cast<int64_t>(sizeof(Whole) * in_.size()));
    int doubled = 1;
    while (2 * doubled <= ranks())
        doubled *= 2;
    const int rest = ranks() - doubled;
    if (rank() >= doubled) {
        messages_.send(out, count, MPI_BYTE, rank() - doubled);
        messages_.wait();
        messages_.receive(out, room, MPI_BYTE, rank() - doubled);
        messages_.wait();
    } else {
        if (rank() < rest) {
            messages_.receive(in_.data(), room, MPI_BYTE, rank() + doubled);
            messages_.wait();
            combine_pieces(in_.data(), out);
        }
        for (int bit = 1; bit < doubled; bit *= 2) {
            messages_.receive(in_.data(), room, MPI_BYTE, rank() ^ bit);
            messages_.send(out, count, MPI_BYTE, rank() ^ bit);
            messages_.wait();
            combine_pieces(in_.data(), out);
        }
        if (rank() < rest) {
            messages_.send(out, count, MPI_BYTE, rank() + doubled);
            messages_.wait();
        }
    }
    if (n_sums > 0)
        std::memcpy(sums, out + sizeof head, sums_bytes);
    if (n_largest > 0)
        std::memcpy(largest, out + first, largest_bytes);
}

// ---------------------------------------------------------------------------------------------- collections

// Down a binomial tree: `distance` is from the one that has it.
void MpiCrossing::broadcast(void *data, int64_t bytes, int from) {
    const Timer timer(waited_);
    const int all = ranks(), distance = (rank() - from + all) % all;
    for (auto *at = static_cast<unsigned char *>(data); bytes > 0;) {
        const int piece = static_cast<int>(std::min<int64_t>(bytes, 1 << 30));
        int bit = 1;
        for (; bit < all; bit *= 2)
            if (distance & bit) {
                messages_.receive(at, piece, MPI_BYTE, (rank() - bit + all) % all);
                messages_.wait();
                break;
            }
        for (bit /= 2; bit > 0; bit /= 2)
            if (distance + bit < all)
                messages_.send(at, piece, MPI_BYTE, (rank() + bit) % all);
        messages_.wait();
        at += piece;
        bytes -= piece;
    }
}

// Numbers of this process, then of the next one and so on: in each turn twice as many are known (Bruck et al. 1997). sizes: in
// that order.
void MpiCrossing::gather_rotated(const int64_t *sizes, double *numbers) {
    int64_t known = sizes[0];
    for (int turn = 1; turn < ranks(); turn *= 2) {
        const int more = std::min(turn, ranks() - turn);
        const int64_t out = std::accumulate(sizes, sizes + more, int64_t{0});
        const int64_t in = std::accumulate(sizes + turn, sizes + turn + more, int64_t{0});
        const int out_count = count_of(out), in_count = count_of(in);
        messages_.receive(numbers + known, in_count, MPI_DOUBLE, (rank() + turn) % ranks());
        messages_.send(numbers, out_count, MPI_DOUBLE, (rank() - turn + ranks()) % ranks());
        messages_.wait();
        known += in;
    }
}

std::vector<int64_t> MpiCrossing::sizes_of_all(std::size_t own) {
    const auto all = static_cast<std::size_t>(ranks());
    std::vector<int64_t> ones(all, 1), sizes(all);
    std::vector<double> rotated(all);
    rotated[0] = static_cast<double>(own);
    gather_rotated(ones.data(), rotated.data());
    for (std::size_t k = 0; k < all; ++k)
        sizes[(static_cast<std::size_t>(rank()) + k) % all] = static_cast<int64_t>(rotated[k]);
    return sizes;
}

void MpiCrossing::gather(const std::vector<double> &own, std::vector<double> &all) {
    const Timer timer(waited_);
    const std::vector<int64_t> sizes = sizes_of_all(own.size());
    for (const int64_t size : sizes)
        count_of(size);
    all.resize(rank() == 0 ? static_cast<std::size_t>(std::accumulate(sizes.begin(), sizes.end(), int64_t{0})) : 0);
    if (rank() == 0) {
        std::copy(own.begin(), own.end(), all.begin());
        double *next = all.data() + own.size();
        for (int from = 1; from < ranks(); next += sizes[static_cast<std::size_t>(from)], ++from)
            if (const auto size = static_cast<int>(sizes[static_cast<std::size_t>(from)]); size > 0)
                messages_.receive(next, size, MPI_DOUBLE, from);
    } else if (!own.empty()) {
        messages_.send(own.data(), static_cast<int>(own.size()), MPI_DOUBLE, 0);
    }
    messages_.wait();
}

void MpiCrossing::gather_everywhere(const std::vector<double> &own, std::vector<double> &all) {
    const Timer timer(waited_);
    std::vector<int64_t> sizes = sizes_of_all(own.size());
    const int64_t before = std::accumulate(sizes.begin(), sizes.begin() + rank(), int64_t{0});
    all.resize(static_cast<std::size_t>(std::accumulate(sizes.begin(), sizes.end(), int64_t{0})));
    std::rotate(sizes.begin(), sizes.begin() + rank(), sizes.end());
    std::copy(own.begin(), own.end(), all.begin());
    gather_rotated(sizes.data(), all.data());
    std::rotate(all.begin(), all.end() - before, all.end());
}

// What each is told by all, of what each tells all. In the turn of a bit goes what has a way with that bit to go (Bruck et
// al. 1997).
std::vector<int64_t> MpiCrossing::sizes_from_all(std::vector<int64_t> to) {
    const auto all = static_cast<std::size_t>(ranks()), own = static_cast<std::size_t>(rank());
    std::rotate(to.begin(), to.begin() + rank(), to.end()); // to[way]: for who is so far on
    std::vector<int64_t> out(all), in(all);
    for (std::size_t bit = 1; bit < all; bit *= 2) {
        int count = 0;
        for (std::size_t way = bit; way < all; ++way)
            if (way & bit)
                out[static_cast<std::size_t>(count++)] = to[way];
        messages_.receive(in.data(), count, MPI_INT64_T, static_cast<int>((own + all - bit) % all));
        messages_.send(out.data(), count, MPI_INT64_T, static_cast<int>((own + bit) % all));
        messages_.wait();
        count = 0;
        for (std::size_t way = bit; way < all; ++way)
            if (way & bit)
                to[way] = in[static_cast<std::size_t>(count++)];
    }
    for (std::size_t way = 0; way < all; ++way)
        in[(own + all - way) % all] = to[way];
    return in;
}

void MpiCrossing::deal(const std::vector<std::vector<double>> &out, std::vector<std::vector<double>> &in) {
    const Timer timer(waited_);
    std::vector<int64_t> to(out.size());
    for (std::size_t k = 0; k < out.size(); ++k)
        to[k] = count_of(static_cast<int64_t>(out[k].size()));
    const std::vector<int64_t> from = sizes_from_all(to);
    in.assign(out.size(), {});
    for (std::size_t k = 0; k < in.size(); ++k)
        in[k].resize(static_cast<std::size_t>(from[k]));
    const auto own = static_cast<std::size_t>(rank());
    in[own] = out[own];
    for (std::size_t k = 0; k < in.size(); ++k)
        if (from[k] > 0 && k != own)
            messages_.receive(in[k].data(), static_cast<int>(from[k]), MPI_DOUBLE, static_cast<int>(k));
    for (std::size_t k = 0; k < out.size(); ++k)
        if (to[k] > 0 && k != own)
            messages_.send(out[k].data(), static_cast<int>(to[k]), MPI_DOUBLE, static_cast<int>(k));
    messages_.wait();
}

// ------------------------------------------------------------------------------------------ about particles

void MpiCrossing::link(const std::vector<int64_t> &out, const std::vector<int64_t> &in) {
    links_.clear();
    int64_t first_out = 0, first_in = 0;
    for (int rank = 0; rank < ranks(); ++rank) {
        if (out[rank] > 0 || in[rank] > 0)
            links_.push_back({rank, first_out, out[rank], first_in, in[rank]});
        first_out += out[rank];
        first_in += in[rank];
    }
}

void MpiCrossing::swap(const double *out, double *in, int numbers) {
    const Timer timer(waited_);
    for (const Link &link : links_)
        count_of(numbers * std::max(link.in, link.out));
    for (const Link &link : links_)
        if (link.in > 0 && link.rank != rank())
            messages_.receive(in + numbers * link.first_in, static_cast<int>(numbers * link.in), MPI_DOUBLE, link.rank);
    for (const Link &link : links_) {
        const double *const first = out + numbers * link.first_out;
        if (link.rank == rank()) {
            std::copy_n(first, numbers * link.out, in + numbers * link.first_in);
        } else if (link.out > 0) {
            messages_.send(first, static_cast<int>(numbers * link.out), MPI_DOUBLE, link.rank);
            ++traffic_.messages;
            traffic_.bytes += 8 * numbers * link.out;
        }
    }
    messages_.wait();
}

void MpiCrossing::cut(int64_t n, const double *x, const double *y, double work) {
    combine_for(Purpose::cut, nullptr, 0, nullptr, 0); // Zoltan waits for all, and knows nothing of failures
    const Timer timer(waited_);
    ++traffic_.cuts;
    cut_.cut(n, x, y, work);
}

} // namespace gp::mpi
