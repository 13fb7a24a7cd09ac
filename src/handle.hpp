// What a gp_sim is, and what its calls have in common: for the files with extern "C" functions.
#pragma once

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>

#include "check.hpp"
#include "entry.hpp"
#include "error.hpp"
#include "io/output.hpp"
#include "scene.hpp"
#include "sim.hpp"

struct gp_sim {
    explicit gp_sim(const gp_config &config, std::shared_ptr<gp::Crossing> crossing = nullptr)
        : sim(config, std::move(crossing)) {}

    gp::Sim sim;
    std::unique_ptr<gp::io::Output> output;
    gp::io::OutputPosition left_off; // of a checkpoint that this was loaded from, until an output is open again

    // What views point to, and the last measured state; good while the epoch is the same.
    gp::Field<double> derived[14];
    gp_state state{};
    uint32_t state_parts = 0;
    uint64_t state_epoch = std::numeric_limits<uint64_t>::max();
};

namespace gp {

// Runs body, with the host's environment put aside, and turns what it throws into a status and a text.
template <class Body> gp_status guard(const Body &body) noexcept {
    const Entry entry;
    try {
        return body();
    } catch (...) {
        const Failure failure = failure_at_hand();
        set_last_error(failure.text);
        return failure.status;
    }
}

// The struct that the caller means: an older, shorter one is completed with defaults; a newer one is understood as long
// as what this version does not know is zero.
template <class T> T complete(const T *given, const T &defaults, const char *name) {
    require_pointer(name, given);
    uint32_t size;
    std::memcpy(&size, given, sizeof size);
    if (size < 2 * sizeof(uint32_t) || size > 65536) // an uninitialised one must not be read past its end
        throw make_error(GP_E_ARGUMENT, "%s.struct_size = %u: expected the size that %s_init sets", name, size, name);
    T whole = defaults;
    std::memcpy(static_cast<void *>(&whole), given, std::min<std::size_t>(size, sizeof(T)));
    whole.struct_size = sizeof(T);
    const auto *bytes = reinterpret_cast<const unsigned char *>(given);
    for (std::size_t k = sizeof(T); k < size; ++k)
        if (bytes[k] != 0)
            throw make_error(GP_E_VERSION,
                             "%s.struct_size = %u: sets a field that this version (%zu bytes) does not know", name,
                             size, sizeof(T));
    return whole;
}

// Fields that an older program does not know are those of the preset whose density it asks for.
inline gp_config complete_config(const gp_config *given) {
    const gp_config whole = complete(given, default_config(GP_PRESET_DEFAULT), "gp_config");
    if (whole.density != GP_DENSITY_NUMBER)
        return whole;
    return complete(given, default_config(whole.nonlocal ? GP_PRESET_PAPER : GP_PRESET_PAPER_LOCAL), "gp_config");
}

} // namespace gp
