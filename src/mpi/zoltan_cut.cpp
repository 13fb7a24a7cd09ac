#include "mpi/zoltan_cut.hpp"

#include <zoltan.h>

#include "error.hpp"

namespace gp::mpi {

namespace {

void require(int status, const char *what) {
    if (status != ZOLTAN_OK && status != ZOLTAN_WARN)
        throw make_error(GP_E_INTERNAL, "Zoltan: %s failed with status %d", what, status);
}

} // namespace

void ZoltanCut::begin(MPI_Comm comm) {
    comm_ = comm;
    float version;
    require(Zoltan_Initialize(0, nullptr, &version), "Zoltan_Initialize");
    zoltan_ = Zoltan_Create(comm);
    if (!zoltan_)
        throw make_error(GP_E_MEMORY, "Zoltan_Create: out of memory");
    // The cuts are kept, to be asked for the owners of places; who is to go where follows from that.
    const char *const parameters[][2] = {{"DEBUG_LEVEL", "0"}, // first: the next one is told on the standard output
                                         {"LB_METHOD", "RCB"},     {"KEEP_CUTS", "1"},       {"RETURN_LISTS", "NONE"},
                                         {"NUM_GID_ENTRIES", "1"}, {"NUM_LID_ENTRIES", "0"}, {"OBJ_WEIGHT_DIM", "1"}};
    for (const auto &parameter : parameters)
        require(Zoltan_Set_Param(zoltan_, parameter[0], parameter[1]), parameter[0]);
    require(Zoltan_Set_Num_Obj_Fn(
                zoltan_,
                [](void *data, int *error) {
                    *error = ZOLTAN_OK;
                    return static_cast<int>(static_cast<ZoltanCut *>(data)->n_);
                },
                this),
            "Zoltan_Set_Num_Obj_Fn");
    require(Zoltan_Set_Obj_List_Fn(
                zoltan_,
                [](void *data, int, int, ZOLTAN_ID_PTR id, ZOLTAN_ID_PTR, int, float *weight, int *error) {
                    const ZoltanCut &self = *static_cast<ZoltanCut *>(data);
                    for (int64_t i = 0; i < self.n_; ++i) {
                        id[i] = static_cast<ZOLTAN_ID_TYPE>(self.first_ + i);
                        weight[i] = static_cast<float>(self.work_of_one_);
                    }
                    *error = ZOLTAN_OK;
                },
                this),
            "Zoltan_Set_Obj_List_Fn");
    require(Zoltan_Set_Num_Geom_Fn(
                zoltan_,
                [](void *, int *error) {
                    *error = ZOLTAN_OK;
                    return 2;
                },
                nullptr),
            "Zoltan_Set_Num_Geom_Fn");
    require(Zoltan_Set_Geom_Multi_Fn(
                zoltan_,
                [](void *data, int, int, int n, ZOLTAN_ID_PTR id, ZOLTAN_ID_PTR, int, double *place, int *error) {
                    const ZoltanCut &self = *static_cast<ZoltanCut *>(data);
                    for (int k = 0; k < n; ++k) {
                        const int64_t i = static_cast<int64_t>(id[k]) - self.first_;
                        place[2 * k] = self.x_[i];
                        place[2 * k + 1] = self.y_[i];
                    }
                    *error = ZOLTAN_OK;
                },
                this),
            "Zoltan_Set_Geom_Multi_Fn");
}

ZoltanCut::~ZoltanCut() {
    int finalised = 0;
    MPI_Finalized(&finalised);
    if (zoltan_ && !finalised) // else its memory goes with the process
        Zoltan_Destroy(&zoltan_);
}

void ZoltanCut::cut(int64_t n, const double *x, const double *y, double work) {
    int64_t all = 0;
    first_ = 0;
    MPI_Exscan(&n, &first_, 1, MPI_INT64_T, MPI_SUM, comm_);
    MPI_Allreduce(&n, &all, 1, MPI_INT64_T, MPI_SUM, comm_);
    int rank, ranks;
    MPI_Comm_rank(comm_, &rank);
    MPI_Comm_size(comm_, &ranks);
    if (rank == 0)
        first_ = 0; // which MPI_Exscan leaves alone
    cut_ = all > 0 && ranks > 1;
    if (!cut_)
        return;
    n_ = n;
    x_ = x;
    y_ = y;
    work_of_one_ = n > 0 ? work / static_cast<double>(n) : 0.0;
    int changes, id_size, place_size, n_in, n_out;
    ZOLTAN_ID_PTR in_id, in_place, out_id, out_place;
    int *in_rank, *in_part, *out_rank, *out_part;
    require(Zoltan_LB_Partition(zoltan_, &changes, &id_size, &place_size, &n_in, &in_id, &in_place, &in_rank, &in_part,
                                &n_out, &out_id, &out_place, &out_rank, &out_part),
            "Zoltan_LB_Partition");
}

int ZoltanCut::owner(double x, double y) const {
    if (!cut_)
        return 0;
    double place[2] = {x, y};
    int rank, part;
    require(Zoltan_LB_Point_PP_Assign(zoltan_, place, &rank, &part), "Zoltan_LB_Point_PP_Assign");
    return rank;
}

} // namespace gp::mpi
