// What is in the HDF5 file of results: groups, attributes and datasets as frame_file.hpp lists them, and the values of each frame.
// Where the file is on the disk, and when a state of it counts, frame_file.cpp knows.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/frame_file.hpp"
#include "io/hdf5_file.hpp"

namespace gp::io {

struct Element {
    std::string name, unit;
    int components;
    bool constant, integer;
    Id value; // of a time-dependent element

    std::string path() const { return "/particles/all/" + name; }
    bool is_position() const { return name == "position"; }
};

struct FrameDatasets : Hdf5File {
    int64_t count = 0, frames = 0; // frames: complete ones
    int compression = 0;
    bool single = false;
    std::vector<Element> elements;
    std::size_t observable_count = 0, wall_point_count = 0, wall_segment_count = 0;
    std::string cells;     // path of the numbers 0, 1, 2, ..., if there are any
    std::string wall_path; // of the walls' points in the last frame that counts

    // count, compression, single and elements are set before.
    void make_layout(const FrameHeader &header, const FrameRows &constant_values);

    // Of a layout that has been made, after the file was closed and opened again.
    void open_datasets();
    void close_datasets() noexcept;

    // The next frame; until append_clock a reader, who goes by the number of times, does not count it. After an error what was
    // appended is appended again.
    void append_values(const FrameRows &rows, const std::vector<double> &values, const std::vector<double> &points);
    void append_clock(int64_t step_number, double seconds);

    // Later frames may refer to these points: of a frame that counts. Or to none so far.
    void remember_walls(const std::vector<double> &points);
    void forget_walls() { wall_path.clear(); }

    std::string frame_group() const { return group_of_frame(frames); }

    // How many components the constant fields have, or the others.
    std::size_t components(bool constant) const;

private:
    double unit = 0; // m, to which positions are rounded; 0: not at all
    std::vector<double> packed;
    Id step, time, observables;      // observables: /observables/state/value, if there are any
    std::vector<double> wall_points; // at wall_path

    hid_t type_of(const Element &element) const {
        return element.integer ? H5T_STD_I64LE : single && !element.is_position() ? H5T_IEEE_F32LE : H5T_IEEE_F64LE;
    }
    std::vector<hsize_t> shape_of(const Element &element) const;
    void link_clock(const std::string &home, const std::string &element) const;
    void make_scene(const std::string &text) const;
    void make_observables(const std::vector<Observable> &all);
    void make_walls(const WallLines &walls);
    void make_box() const;
    void write_constant(const Element &element, hid_t dataset, const FrameRows &rows, std::size_t component);
    const double *pack(const Element &element, const FrameRows &rows, const RowRequest &some);
    template <class See>
    void write_rows(const Element &element, hid_t dataset, const FrameRows &rows, std::size_t component,
                    std::vector<hsize_t> start, std::vector<hsize_t> shape, std::size_t particles, const See &see);
    void extend(hid_t dataset, std::vector<hsize_t> shape, const std::string &what) const;
    void append_rows(const Element &element, const FrameRows &rows, std::size_t component);
    void append(hid_t dataset, std::vector<hsize_t> shape, hid_t type, const void *data, const std::string &what) const;
    void make_view(const std::string &name, const Element &element) const;
    void make_views() const;
    void place_walls(const std::vector<double> &points);
};

} // namespace gp::io
