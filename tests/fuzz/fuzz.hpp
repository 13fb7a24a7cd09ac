// What the fuzzers share: values taken from the input's bytes, hostile ones among them, and what must always hold.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "granperi/gp.h"

namespace fuzz {

[[noreturn]] inline void broken(const char *what) {
    std::fprintf(stderr, "broken: %s; gp_last_error: %s\n", what, gp_last_error());
    std::abort();
}

#define ALWAYS(condition)                                                                                              \
    do {                                                                                                               \
        if (!(condition))                                                                                              \
            ::fuzz::broken(#condition);                                                                                \
    } while (false)

// The input, byte by byte; zeros after its end.
class Bytes {
public:
    Bytes(const uint8_t *data, std::size_t size) : at_(data), end_(data + size) {}
    bool empty() const { return at_ == end_; }
    uint8_t byte() { return empty() ? uint8_t{0} : *at_++; }
    int below(int n) { return byte() % n; }

    // Mostly a multiple of what is usual, sometimes what no host means.
    double number(double usual) {
        static constexpr double hostile[] = {std::numeric_limits<double>::quiet_NaN(),
                                             std::numeric_limits<double>::infinity(),
                                             -std::numeric_limits<double>::infinity(),
                                             1.7e308,
                                             -1.7e308,
                                             5e-324,
                                             -1.0,
                                             0.0,
                                             1e-12,
                                             1e12,
                                             1e100,
                                             -1e-300};
        const uint8_t kind = byte();
        if (kind < 160)
            return usual * (1 + (kind % 40 - 20) / 20.0 * (kind / 40));
        if (kind < 240)
            return hostile[kind % (sizeof hostile / sizeof *hostile)];
        uint64_t bits = 0;
        for (int k = 0; k < 8; ++k)
            bits = bits << 8 | byte();
        double value;
        std::memcpy(&value, &bits, sizeof value);
        return value;
    }
    int64_t integer(int64_t usual) {
        static constexpr int64_t hostile[] = {INT64_MIN, INT64_MAX, INT32_MIN, INT32_MAX, -1, 0, 1, 2, 3, 1000};
        const uint8_t kind = byte();
        return kind < 160 ? usual : kind < 240 ? hostile[kind % 10] : static_cast<int8_t>(byte());
    }

private:
    const uint8_t *at_, *end_;
};

// Every call's status: one of the documented, with a text if it is an error, and never a defect.
inline gp_status checked(gp_status status) {
    ALWAYS(status <= GP_STOPPED && status >= GP_E_INTERNAL);
    ALWAYS(status != GP_E_INTERNAL);
    ALWAYS(status >= 0 || *gp_last_error() != '\0');
    return status;
}

inline gp_state state_of(gp_sim *sim) {
    gp_state state{};
    state.struct_size = sizeof state;
    ALWAYS(checked(gp_get_state(sim, &state)) == GP_OK);
    state.wall_seconds = 0;
    return state;
}

// All that can be read, as bytes; finite: also that it consists of finite numbers.
inline std::string bits_of(gp_sim *sim, bool finite) {
    gp_particles p{};
    p.struct_size = sizeof p;
    ALWAYS(checked(gp_get_particles(sim, GP_FIELD_ALL, &p)) == GP_OK);
    std::string bits;
    const auto n = static_cast<std::size_t>(p.count);
    if (n > 0)
        bits.append(reinterpret_cast<const char *>(p.id), n * sizeof *p.id);
    for (const double *field : {p.x, p.y, p.vx, p.vy, p.pressure, p.density, p.sxx, p.sxy})
        for (std::size_t k = 0; k < n; ++k) {
            ALWAYS(!finite || std::isfinite(field[k]));
            bits.append(reinterpret_cast<const char *>(&field[k]), sizeof field[k]);
        }
    for (std::size_t k = 0; finite && k < n; ++k)
        if (!(p.density[k] >= 0 && p.pressure[k] >= 0)) { // 0: of a lone particle with GP_DENSITY_NUMBER
            std::fprintf(stderr, "particle %zu: density %g, pressure %g\n", k, p.density[k], p.pressure[k]);
            broken("density or pressure");
        }
    const gp_state s = state_of(sim);
    ALWAYS(!finite || (std::isfinite(s.time) && std::isfinite(s.dt)));
    return bits.append(reinterpret_cast<const char *>(&s), sizeof s);
}

// A file of this process in memory, gone when it ends by itself.
inline std::string own_file(const char *name) {
    struct Directory {
        std::string path =
            std::filesystem::exists("/dev/shm") ? "/dev/shm/granperi_fuzz_XXXXXX" : "/tmp/granperi_fuzz_XXXXXX";
        Directory() { ALWAYS(::mkdtemp(&path[0]) != nullptr); }
        ~Directory() { std::filesystem::remove_all(path); }
    };
    static const Directory directory;
    return directory.path + "/" + name;
}

} // namespace fuzz
