// The output that follows a run: which fields, when, in the order of id. It hands them to the file format.
#pragma once

#include <memory>
#include <string>

#include "sim.hpp"

namespace gp::io {

gp_output default_output();

// Checks the options, creates the file and, with every_seconds > 0, writes the first frame. Throws gp::Error;
// GP_E_UNSUPPORTED in a build without HDF5.
class Output : public FrameSink {
public:
    Output(const std::string &path, const gp_output &options, const World &world);
    ~Output() override;
    void step_done(const World &world) override;
    void write(const World &world);
    void close();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace gp::io
