// Rows of the stage lists that are written with the default scheme's at hand.
#pragma once

#include <cstring>
#include <vector>

#include "error.hpp"
#include "plan.hpp"

namespace gp {

struct StageRows {
    const Traits &t;
    const std::vector<PlannedStage> &default_stages;

    // That of the default scheme.
    PlannedStage same(const char *name) const {
        for (const PlannedStage &stage : default_stages)
            if (!std::strcmp(stage.name, name))
                return stage;
        throw make_error(GP_E_INTERNAL, "plan: no stage %s", name);
    }
    // That of the default scheme with another function.
    PlannedStage other(const char *name, void (*run)(World &)) const {
        PlannedStage stage = same(name);
        stage.run = run;
        return stage;
    }
    // A new one, for scenes with particles; for scenes with plates, too.
    PlannedStage particles(const char *name, const char *why, void (*run)(World &)) const {
        return {name, t.particles, why, "the scene has no particles", run, nullptr, ""};
    }
    PlannedStage walls(const char *name, void (*run)(World &)) const {
        PlannedStage stage = same("wall_stress");
        stage.name = name;
        stage.run = run;
        return stage;
    }
};

} // namespace gp
