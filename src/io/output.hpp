// The output that follows a run: which fields, when, in the order of id. It hands them to the file format.
#pragma once

#include <memory>
#include <string>

#include "sim.hpp"

namespace gp::io {

gp_output default_output();

// Where an output is: what a checkpoint keeps of it.
struct OutputPosition {
    std::string path; // absolute; "": none
    double every_seconds = 0;
    int64_t next = 0;   // the next frame by itself is due at next * every_seconds
    int64_t frames = 0; // written
    int64_t step = 0;   // of the simulation, then
};

// When frames are due by themselves.
struct FrameTimes {
    double every = 0; // s; 0: never
    int64_t next = 0; // the next one is due at next * every
    bool due(const World &world) const;
    void pass(const World &world); // that of now is done
};

// Checks the options, creates the file and, with every_seconds > 0, writes the first frame; or with append continues a file:
// as it was at left_off, if that is of this file and of the world's step, else with the frames up to the world's step.
// Throws gp::Error; GP_E_UNSUPPORTED in a build without HDF5. Of several processes each has one, and the first one the file:
// all calls but position() are collective.
class Output : public FrameSink {
public:
    Output(const std::string &path, const gp_output &options, const World &world, const OutputPosition &left_off);
    ~Output() override;
    void step_done(const World &world) override;
    void write(const World &world);
    void close();
    OutputPosition position(const World &world) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace gp::io
