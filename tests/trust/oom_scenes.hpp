// Small scenes that a call out of memory is tried on, and what they are compared by.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "failing_memory.hpp"
#include "granperi/gp.h"

namespace test {

// Ends the program, with memory.
[[noreturn, gnu::format(printf, 1, 2)]] void fail(const char *format, ...);
void check(gp_status status, const char *call);
#define CHECK(call) test::check(call, #call)

constexpr double dl = 0.0025; // m, the spacing
constexpr int steps = 8;
constexpr const char *scenes[] = {"default", "implicit", "periodic", "channel", "retry", "paper", "paper_local"};

gp_config config_of(const std::string &scene);

// Everything that can be added to a scene, each piece as a call that can be repeated until it succeeds.
using Piece = std::pair<const char *, std::function<gp_status(gp_sim *)>>;
std::vector<Piece> pieces_of(const std::string &scene);

void count_lines_of_log(gp_sim *sim);
gp_sim *make(const std::string &scene);

gp_state state_of(gp_sim *sim);
std::string bits_of(gp_sim *sim); // all that can be read, as bytes
void require_same(const std::string &found, const std::string &expected, const char *what);

// What becomes of calls when a malloc of HDF5 fails (oom_hdf5.cpp).
void report_hdf5(const std::string &directory);

} // namespace test
