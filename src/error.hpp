// Errors inside the library are exceptions of this type; guard (handle.hpp) turns them into a status and a thread-local text.
#pragma once

#include <stdexcept>
#include <string>

#include "granperi/gp.h"

namespace gp {

class Error : public std::runtime_error {
public:
    Error(gp_status status, const std::string &text) : std::runtime_error(text), status_(status) {}
    gp_status status() const noexcept { return status_; }

private:
    gp_status status_;
};

// What has been thrown, as the interface tells of it, without memory of its own.
struct Failure {
    gp_status status = GP_OK;
    bool foreseen = false; // an Error: it leaves what all can go on with
    char text[1024] = "";
};
// In a handler of any exception.
Failure failure_at_hand() noexcept;
// Puts "rank N: " before the text, unless that stands there already.
void name_rank(Failure &failure, int rank) noexcept;

// What all of several processes have been told of (crossing.hpp): each of them throws it.
struct SharedFailure {
    Failure failure;
};

// printf-style construction, so that every message can carry the argument's value.
[[gnu::format(printf, 2, 3)]] Error make_error(gp_status status, const char *format, ...);
[[gnu::format(printf, 1, 2)]] std::string format_text(const char *format, ...);

// The text of this thread's last error, for gp_last_error. Never allocates: a longer text is cut.
void set_last_error(const char *text) noexcept;
const char *last_error() noexcept;

const char *status_text(gp_status status) noexcept;

} // namespace gp
