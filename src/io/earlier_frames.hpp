// The frames of a result file that an output is to continue.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "io/frame_file.hpp"

namespace gp::io {

class EarlierFrames {
public:
    // Throws gp::Error(GP_E_IO) if there is no such file, or one with other particles, fields or precision.
    EarlierFrames(const std::string &path, const FrameHeader &header, const std::vector<FrameField> &fields,
                  const FrameRows &constant_values, bool single_precision);
    EarlierFrames(const EarlierFrames &) = delete;
    EarlierFrames &operator=(const EarlierFrames &) = delete;
    ~EarlierFrames();

    // Of each complete frame.
    const std::vector<int64_t> &steps() const { return steps_; }
    const std::vector<double> &times() const { return times_; }

    // One frame: the components of the fields that are not constant, in order (for another file to ask for, while HDF5 works),
    FrameRows rows(int64_t frame) const;
    // the observables, and the points of the walls.
    void read(int64_t frame, std::vector<double> &observables, std::vector<double> &wall_points) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
    std::vector<int64_t> steps_;
    std::vector<double> times_;
};

} // namespace gp::io
