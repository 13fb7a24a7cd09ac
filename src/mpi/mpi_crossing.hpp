// What crosses between processes, by messages of MPI. Only the files of this directory know it.
#pragma once

#include <memory>

#include "crossing.hpp"
#include "mpi/mpi_messages.hpp"
#include "mpi/zoltan_cut.hpp"

namespace gp::mpi {

class MpiCrossing : public Crossing {
public:
    // Collective; all throw what one of them throws.
    static std::shared_ptr<MpiCrossing> between_all_of(MPI_Comm comm);
    explicit MpiCrossing(MPI_Comm comm) : messages_(comm) {}

    int rank() const override { return messages_.rank(); }
    int ranks() const override { return messages_.ranks(); }
    SharedFailure fail(const Failure &failure) override { return messages_.fail(failure); }
    void require_going() const override { messages_.require_going(); }
    double waited() const override { return waited_; }
    void combine(double *largest, int n_largest, Whole *sums, int n_sums) override {
        combine_for(Purpose::numbers, largest, n_largest, sums, n_sums);
    }
    void broadcast(void *data, int64_t bytes, int from) override;
    void gather(const std::vector<double> &own, std::vector<double> &all) override;
    void gather_everywhere(const std::vector<double> &own, std::vector<double> &all) override;
    void deal(const std::vector<std::vector<double>> &out, std::vector<std::vector<double>> &in) override;
    void link(const std::vector<int64_t> &out, const std::vector<int64_t> &in) override;
    void swap(const double *out, double *in, int numbers) override;
    void cut(int64_t n, const double *x, const double *y, double work) override;
    int owner(double x, double y) override { return cut_.owner(x, y); }
    Traffic traffic() const override { return traffic_; }

private:
    class Timer;
    enum class Purpose : int32_t { numbers, cut };
    void combine_for(Purpose purpose, double *largest, int n_largest, Whole *sums, int n_sums);
    void gather_rotated(const int64_t *sizes, double *numbers);
    std::vector<int64_t> sizes_of_all(std::size_t own);
    std::vector<int64_t> sizes_from_all(std::vector<int64_t> to);

    double waited_ = 0;
    Traffic traffic_;
    std::vector<Whole> in_, out_; // what is combined; aligned as its sums
    struct Link {
        int rank;
        int64_t first_out, out, first_in, in; // particles
    };
    std::vector<Link> links_;
    Messages messages_;
    ZoltanCut cut_; // it goes before the communicator
};

} // namespace gp::mpi
