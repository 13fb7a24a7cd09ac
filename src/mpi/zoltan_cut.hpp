// The plane in boxes of equal work, one for each process: recursive bisection by Zoltan. Only this and its .cpp know that.
#pragma once

#include <cstdint>

#include <mpi.h>

struct Zoltan_Struct;

namespace gp::mpi {

class ZoltanCut {
public:
    ZoltanCut() = default;
    ZoltanCut(const ZoltanCut &) = delete;
    ZoltanCut &operator=(const ZoltanCut &) = delete;
    ~ZoltanCut();

    void begin(MPI_Comm comm); // collective
    // Collective; it waits for all, and cannot be told of a failure. work: of the n places here together.
    void cut(int64_t n, const double *x, const double *y, double work);
    int owner(double x, double y) const; // 0 where nothing has been cut

private:
    MPI_Comm comm_ = MPI_COMM_NULL;
    Zoltan_Struct *zoltan_ = nullptr;
    bool cut_ = false;
    // While it cuts.
    int64_t n_ = 0, first_ = 0;
    const double *x_ = nullptr, *y_ = nullptr;
    double work_of_one_ = 0;
};

} // namespace gp::mpi
