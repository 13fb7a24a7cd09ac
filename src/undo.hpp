// Takes an unfinished step back: the simulation then is what it was at the last good step, to be read or stepped anew.
//
// A step that diverges does so before it moves anything (stages::require_bounded_step). What stages have overwritten by
// then is kept: the density is copied beforehand, and the pressure follows from it; the stress before the step stays where the stage stress, which
// reads it, has K^-1 no more; positions and velocities are copied, too, where the forces come in two parts (the schemes of the
// paper have a predictor, the implicit one a solve that may fail). Of the velocity gradient, made anew in each step, two memories
// take turns; half of the other one is that of the pushes, which come after. The rest is small: clock, ledger, plates.
#pragma once

#include "world.hpp"

namespace gp {

// At the beginning of a step, before its first stage.
void begin_step(World &world);

// The stage of that name: after the particles have been sorted, before one of their fields changes.
void keep_fields(World &world);

// The default scheme's step is known to be good: the memory of what it would be undone with is free for what comes.
void accept_step(World &world);

// Undoes all of the step that has begun: values, their order, and the plates. In a periodic scene positions that returned
// into the period stay there, and the order is the new one; so it is with UndoneOrder::as_it_is, which needs no memory.
enum class UndoneOrder { before, as_it_is };
void undo_step(World &world, UndoneOrder order = UndoneOrder::before);

} // namespace gp
