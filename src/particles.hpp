// Particles: one contiguous array per field, kept in the order of the cell sort. Which fields exist is decided when the
// plan is made; a field that a scene does not need has no memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

namespace gp {

// Arrays begin on a cache line, so that no two threads' blocks share one at the array's start and vector loads are whole.
template <class T> struct CacheLineAllocator {
    using value_type = T;
    CacheLineAllocator() = default;
    template <class U> CacheLineAllocator(const CacheLineAllocator<U> &) {}
    T *allocate(std::size_t n) { return static_cast<T *>(::operator new(n * sizeof(T), std::align_val_t(64))); }
    void deallocate(T *p, std::size_t) { ::operator delete(p, std::align_val_t(64)); }
    template <class U> bool operator==(const CacheLineAllocator<U> &) const { return true; }
    template <class U> bool operator!=(const CacheLineAllocator<U> &) const { return false; }
};

template <class T> using Field = std::vector<T, CacheLineAllocator<T>>;

// The values of a field are over, those of another begin: it takes the memory. A field without memory has no values, so that
// what reads it too early or too late does not go unseen.
inline void hand_over(Field<double> &from, Field<double> &to) {
    to.swap(from);
}

// What a particle remembers so that it can be told whether it rests (stages/sleep.cpp), and what it needs while it sleeps; only with
// gp_config.sleep.
struct Repose {
    Field<double> asleep;             // 1 or 0
    Field<double> quiet_for;          // s, that it has been quiet
    Field<double> way_x, way_y;       // m, gone since
    Field<double> pressure, sxx, sxy; // Pa, when that began
    Field<double> fluidity;           // 1/s, likewise
    Field<double> gxx, gxy, gyy;      // 1/m2, the inverse shape tensor, and
    Field<double> stressed;           // the share of the penalty: of what is quiet, to stay so while it sleeps

    bool in_use() const { return !asleep.empty(); }
    // Calls visit(name, field) for all of them.
    template <class R, class Visit> static void for_each(R &repose, const Visit &visit) {
        visit("asleep", repose.asleep);
        visit("quiet_for", repose.quiet_for);
        visit("quiet_way_x", repose.way_x);
        visit("quiet_way_y", repose.way_y);
        visit("quiet_pressure", repose.pressure);
        visit("quiet_sxx", repose.sxx);
        visit("quiet_sxy", repose.sxy);
        visit("quiet_fluidity", repose.fluidity);
        visit("quiet_gxx", repose.gxx);
        visit("quiet_gxy", repose.gxy);
        visit("quiet_gyy", repose.gyy);
        visit("quiet_stressed", repose.stressed);
    }
};

struct Particles {
    int64_t count = 0;
    double volume = 0; // m2, spacing^2, of every particle

    // Carried from step to step.
    Field<int64_t> id;
    Field<int32_t> column;
    Field<double> x, y;     // m
    Field<double> vx, vy;   // m/s
    Field<double> density;  // kg/m3
    Field<double> pressure; // Pa
    Field<double> sxx, sxy; // Pa, deviatoric stress
    // Pa, over Constants::pressure_memory: the inertial number goes by it; only where friction goes by that (stages/stress.cpp)
    Field<double> mean_pressure;
    Field<double> syy; // only of the viscous stress eta_r D, which has a trace; else syy = -sxx

    Repose repose;

    Field<double> fluidity; // 1/s, g; only where a material has one (material/fluidity.hpp)

    // Made anew in each step.
    Field<double> lxx, lxy, lyx, lyy; // 1/s, velocity gradient L_ab = du_a/dr_b
    Field<double> gxx, gxy, gyy;      // 1/m2, inverse shape tensor K^-1
    Field<double> cxx, cxy, cyx, cyy; // sigma K^-1, less the penalty's half of L: what a neighbour needs of a particle
    Field<double> fluid_seen;         // 1/s, fluidity where there is pressure, else 0
    Field<double> fluid_pull, fluid_pace; // 1/s, 1: what its neighbours pull the fluidity to, and how hard
    Field<double> ax, ay;                 // m/s2, by the forces
    Field<double> push_x, push_y;         // m/s, by collisions and contacts with plates after that

    // Made anew, and over within the step: in the memory of fields that are made later.
    Field<double> flowing; // 1 at yield or without stress, else 0. From the stage flowing to gradient; then ax
    Field<double> bearing; // 1 under pressure, else 0; in gradient, with fluidity or several densities; then ay
    // `flowing` under pressure, else 0: in gradient, with density diffusion of one density; then ay. With fluidity, too, in
    // memory of its own.
    Field<double> bearing_flow;
    Field<double> crowding; // sum of w where it flows, else 0. From gradient to density_of_spacing; then cyx
    // Where collisions ask for what is crowded: N over the lattice's where it flows, else 0; density over the material's own, at
    // least 1, before the spacing has raised it. From density_of_spacing to force; then ax, ay
    Field<double> spaced, known;
    Field<double>
        carried; // share of its stress that a particle near a plate carries. From gradient to density; then cyy
    // Share of the penalty: where p > 0, more inside the yield surface; only with it. From stress to force; in the default scheme
    // in the memory of gyy, with which stress has done.
    Field<double> stressed;
    // kg/m3, m3/kg: the material's own density, for neighbours in gradient; only where there are several.
    Field<double> rest, inverse_rest;

    // Fields that only some scenes need.
    struct Optional {
        bool stressed = false;      // penalty, but in the default scheme
        bool fluidity = false;      // a material has one
        bool bearing_flow = false;  // density diffusion of one density beside fluidity
        bool densities = false;     // density diffusion between materials of different density
        bool shape = false;         // inverse shape tensor and the second row of sigma K^-1
        bool mean_pressure = false; // friction goes by the inertial number
        bool syy = false;
        bool sleep = false;
    };
    // Gives every field in use its size.
    void allocate(int64_t n, const Optional &use);

    // Makes room for images of particles behind the real ones (periodic.hpp) in every field that neighbours read.
    void make_room(int64_t images);

    // Another number of particles, in every field that is in use: those of a part of a world come and go.
    void resize(int64_t n);

    // Puts the carried fields into the order old_index[new], by way of ax: between steps nobody reads accelerations.
    void reorder(const Field<int32_t> &old_index, int threads);

    // After the gradient: what it went by in their memory is over.
    void give_back_accelerations();
    // The particles here in the order of their ids.
    std::vector<int32_t> by_id() const;
    // After a step that did not come to its end: what lies in the memory of other fields gives it back.
    void give_back(bool stressed_in_shape);
};

} // namespace gp
