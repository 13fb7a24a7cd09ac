// What crosses between processes, by MPI. Only the files of this directory know it.
#pragma once

#include <map>
#include <memory>

#include <mpi.h>

#include "crossing.hpp"
#include "mpi/zoltan_cut.hpp"

namespace gp::mpi {

class MpiCrossing : public Crossing {
public:
    explicit MpiCrossing(MPI_Comm comm); // makes a communicator of its own of it
    MpiCrossing(const MpiCrossing &) = delete;
    MpiCrossing &operator=(const MpiCrossing &) = delete;
    ~MpiCrossing() override;

    int rank() const override { return rank_; }
    int ranks() const override { return ranks_; }
    double waited() const override { return waited_; }
    void combine(double *largest, int n_largest, Whole *sums, int n_sums) override;
    void broadcast(void *data, int64_t bytes, int from) override;
    void gather(const std::vector<double> &own, std::vector<double> &all) override;
    void gather_everywhere(const std::vector<double> &own, std::vector<double> &all) override;
    void deal(const std::vector<std::vector<double>> &out, std::vector<std::vector<double>> &in) override;
    void link(const std::vector<int64_t> &out, const std::vector<int64_t> &in) override;
    void swap(const double *out, double *in, int numbers) override;
    void cut(int64_t n, const double *x, const double *y, double work) override;
    int owner(double x, double y) override { return cut_->owner(x, y); }
    Traffic traffic() const override { return traffic_; }

private:
    class Timer;
    MPI_Datatype type_of(std::size_t bytes);

    MPI_Comm comm_ = MPI_COMM_NULL;
    int rank_ = 0, ranks_ = 1;
    double waited_ = 0;
    Traffic traffic_;
    MPI_Op combine_ = MPI_OP_NULL;
    std::map<std::size_t, MPI_Datatype> types_; // of what is combined, by size
    std::vector<Whole> in_, out_;               // what is combined; aligned as its sums
    struct Link {
        int rank;
        int64_t first_out, out, first_in, in; // particles
    };
    std::vector<Link> links_;
    std::vector<MPI_Request> requests_;
    std::unique_ptr<ZoltanCut> cut_;
};

} // namespace gp::mpi
