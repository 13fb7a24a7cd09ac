// Result files: an HDF5 file in the layout of H5MD 1.1 and, beside it, an XDMF file through which ParaView reads it.
//
//   /h5md                                   who wrote it; the units module
//   /particles/all/box                      H5MD asks for it
//   /particles/all/position/{step,time,value[T][N][3]}, velocity likewise; scalars have value[T][N]
//                                           step and time are the same two datasets in every element
//   /particles/all/<constant field>[N]
//   /parameters                             attributes; the scene as JSON text in the dataset `scene`
//   /observables/state/{step,time,value[T][K]}   K numbers of the whole simulation, named by the attribute `names`
//   /walls/plate[M], /walls/segments[S][2]  of the lines of all plates: the plate of each point, and the points of each segment
//   /frames/<first of its 256>/<frame>/<field>   views of one frame each, [N] or [N][3], without data of their own:
//                                           ParaView reads them where H5MD has one dataset for all frames
//   /frames/<first of its 256>/<frame>/walls     where the points of the plates are, [M][3]; a link to those of an earlier frame
//                                           where none has moved
//
// A reader of a file that is still being written, or whose writer was killed, takes the first len(time) frames.
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace gp::io {

// Views per group. A small group's table of names never has to move, which keeps every change of it a single write.
constexpr int64_t views_per_group = 256;
// Of the views of frame `frame` and its neighbours, and of its own.
std::string group_of_views(int64_t frame);
std::string group_of_frame(int64_t frame);

struct FrameField {
    const char *name;
    int components;   // 1, or 2 for a vector, which is stored with z = 0
    bool constant;    // written once and not per frame
    bool integer;     // stored as 64-bit integers
    const char *unit; // as H5MD's units module writes it, e.g. "m s-1"; NULL or "": none
};

struct Observable {
    const char *name, *unit;
};

// The lines of all plates.
struct WallLines {
    std::vector<int64_t> plate;    // of each point
    std::vector<int64_t> segments; // numbers of their two points, one segment after the other
};

struct FrameHeader {
    int64_t count; // particles
    double spacing;
    double gravity[2];
    const char *creator_version;
    std::vector<std::pair<std::string, double>> parameters;
    std::vector<Observable> observables = {}; // none: no such dataset
    std::string scene = {};                   // empty: no such dataset
    WallLines walls = {};                     // empty: no such group
};

// Values of particles in the order of id, component by component: whole arrays, or whoever has some particles at a time. What
// it gives is good until it is next asked for that component.
class FrameRows {
public:
    using Get = std::function<const double *(std::size_t component, int64_t first, int64_t count)>;
    FrameRows() = default;
    FrameRows(std::vector<const double *> arrays)
        : components_(arrays.size()),
          get_([arrays](std::size_t component, int64_t first, int64_t) { return arrays[component] + first; }) {}
    FrameRows(std::initializer_list<const double *> arrays) : FrameRows(std::vector<const double *>(arrays)) {}
    FrameRows(std::size_t components, Get get) : components_(components), get_(std::move(get)) {}
    std::size_t components() const { return components_; }
    const double *operator()(std::size_t component, int64_t first, int64_t count) const {
        return get_(component, first, count);
    }

private:
    std::size_t components_ = 0;
    Get get_;
};

// How the rows of a frame are asked for, a chunk of the file at a time. widths: the components of its fields.
struct RowRequest {
    std::size_t component;
    int64_t first, count;
};
std::vector<RowRequest> row_requests(int64_t count, const std::vector<int> &widths);

// Every call may throw gp::Error with GP_E_IO. Not for use by two threads at once; two files in two threads are fine.
class FrameFile {
public:
    // Replaces an existing file. (ParaView's reader takes no file whose name contains a colon.) The fields must include
    // a "position" of two components. constant_values: the components of each constant field, in order.
    // compression: deflate level, 0 for none. single_precision: all but times, observables and positions as 32 bits; positions to
    // 1e-5 spacings. beside: the files are <path>.part and the like until publish().
    FrameFile(const std::string &path, const FrameHeader &header, std::vector<FrameField> fields,
              const FrameRows &constant_values, int compression, bool single_precision, bool beside = false);
    FrameFile(const FrameFile &) = delete;
    FrameFile &operator=(const FrameFile &) = delete;
    ~FrameFile(); // closes; an error then is lost

    // rows: the components of each field that is not constant, in order; observables: as many as the header has. After an error the frame is lost, the earlier ones are not, and
    // the next call tries again. wall_points: x, y, z of each point of the header's walls.
    void write(int64_t step, double time, const FrameRows &rows, const std::vector<double> &observables = {},
               const std::vector<double> &wall_points = {});

    // Puts the files into their place. Before, those that are there are as they were.
    void publish();

    // The file is closed also when this throws. A second call does nothing.
    void close();

    int64_t frames() const; // complete ones in the HDF5 file

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace gp::io
