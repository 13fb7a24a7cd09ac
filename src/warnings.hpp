// States that are doubtful but no errors, told to the host's log: each kind once, with its figure and with what to change.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "world.hpp"

namespace gp {

class Warnings {
public:
    // Texts that have not been told yet.
    std::vector<std::string> of_scene(const World &world); // before the first step
    std::string note_of_scene(const World &world) const;   // what the library chose at a cost, no warning; or nothing
    std::vector<std::string> of_step(const World &world);  // after each
    std::vector<std::string> of_retry(const World &world, const char *error);
    std::vector<std::string> of_gravity(const World &world); // after a change of it

private:
    enum Kind {
        scene, // all of its own
        thin_column,
        retried,
        compressed,
        fast_plate,
        passed_plate,
        large_penalty,
        large_energy_error,
        lost_volume,
        more_gravity,
        lost_material,
        kinds
    };

public:
    // A bit per kind that has been told.
    uint32_t told() const { return told_; }
    void set_told(uint32_t told) { told_ = told; }
    static constexpr uint32_t all_kinds = (1u << kinds) - 1;

private:
    bool is_told(Kind kind) const { return (told_ & (1u << kind)) != 0; }
    bool is_new(Kind kind); // and not any more

    uint32_t told_ = 0; // bit per kind
};

} // namespace gp
