// The plan: which stages and fields a scene needs, in order. Made once, before the first step.
#pragma once

#include <cstdint>
#include <vector>

#include "world.hpp"

namespace gp {

// The scene's choices.
struct Traits {
    Scheme scheme;
    bool particles, periodic, plates, friction_plates, channel, side_walls, penalty, collisions, diffusion, fluid,
        sleep;
    bool parts = false; // others have the rest of it
};

Traits traits_of(const Scene &scene, const Constants &constants);

struct PlannedStage {
    const char *name;
    bool needed;         // by the scene
    const char *why;     // if needed
    const char *why_not; // if not
    void (*run)(World &);
    bool (*now)(const World &); // NULL, or: is there anything to do at the moment?
    const char *idle;           // the reason when there is not
    double seconds = 0;
    int64_t calls = 0;
};

std::vector<PlannedStage> make_stages(const Traits &traits);

// The lists of the other schemes. What they share with the default scheme they take from that one's list.
std::vector<PlannedStage> implicit_stages(const Traits &traits, const std::vector<PlannedStage> &default_stages);
std::vector<PlannedStage> paper_stages(const Traits &traits, const std::vector<PlannedStage> &default_stages);
std::vector<PlannedStage> paper_local_stages(const Traits &traits, const std::vector<PlannedStage> &default_stages);

// Entries for gp_get_plan: stages, then fields and tables.
std::vector<gp_plan_entry> describe_plan(const std::vector<PlannedStage> &stages, const Traits &traits,
                                         const World &world);

} // namespace gp
