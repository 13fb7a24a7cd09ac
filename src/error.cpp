#include "error.hpp"

#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <new>

namespace gp {

namespace {

thread_local char last_error_text[1024] = "";

std::string format_list(const char *format, va_list arguments) {
    char text[1024];
    // NOLINTNEXTLINE(clang-analyzer-valist.Uninitialized): who calls this has begun it
    std::vsnprintf(text, sizeof text, format, arguments);
    return text;
}

} // namespace

Error make_error(gp_status status, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    std::string text = format_list(format, arguments);
    va_end(arguments);
    return Error(status, text);
}

std::string format_text(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    std::string text = format_list(format, arguments);
    va_end(arguments);
    return text;
}

Failure failure_at_hand() noexcept {
    Failure failure;
    const auto tell = [&](gp_status status, const char *text) {
        failure.status = status;
        std::snprintf(failure.text, sizeof failure.text, "%s", text);
    };
    try {
        throw;
    } catch (const SharedFailure &shared) {
        failure = shared.failure;
    } catch (const Error &error) {
        failure.foreseen = true;
        tell(error.status(), error.what());
    } catch (const std::bad_alloc &) {
        tell(GP_E_MEMORY, "out of memory");
    } catch (const std::length_error &) {
        tell(GP_E_MEMORY, "out of memory");
    } catch (const std::exception &error) {
        tell(GP_E_INTERNAL, error.what());
    } catch (...) {
        tell(GP_E_INTERNAL, "unknown exception");
    }
    return failure;
}

void name_rank(Failure &failure, int rank) noexcept {
    char name[32];
    std::snprintf(name, sizeof name, "rank %d: ", rank);
    if (std::strncmp(failure.text, name, std::strlen(name)) == 0)
        return;
    const Failure unnamed = failure;
    std::snprintf(failure.text, sizeof failure.text, "%s%.980s", name, unnamed.text);
}

void set_last_error(const char *text) noexcept {
    std::snprintf(last_error_text, sizeof last_error_text, "%s", text);
}

const char *last_error() noexcept {
    return last_error_text;
}

const char *status_text(gp_status status) noexcept {
    switch (status) {
    case GP_OK: return "success";
    case GP_STOPPED: return "stopped by the callback";
    case GP_E_ARGUMENT: return "invalid argument";
    case GP_E_STATE: return "call out of order";
    case GP_E_MEMORY: return "out of memory";
    case GP_E_IO: return "input or output failed";
    case GP_E_DIVERGED: return "the simulation diverged";
    case GP_E_UNSUPPORTED: return "not supported by this build or version";
    case GP_E_VERSION: return "made by another version";
    case GP_E_INTERNAL: return "internal error";
    default: return "unknown status";
    }
}

} // namespace gp
