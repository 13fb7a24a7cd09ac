// The whole of a world that several processes have in parts: put together on the first of them, dealt out again.
#pragma once

#include <functional>
#include <memory>

#include "error.hpp"
#include "world.hpp"

namespace gp {

// GP_E_UNSUPPORTED if a scene cannot be worked on in parts.
void require_partable(const Scene &scene);

// Runs body on the first process; all throw what it throws there.
void run_on_first(Crossing &crossing, const std::function<void()> &body);

// The part of each process. whole: on the first process the world with its lists, elsewhere NULL.
std::unique_ptr<World> deal_out(const Scene &scene, Crossing &crossing, const World *whole);

// On the first process the world that one alone would have, but for what it need not keep between steps, with its lists;
// elsewhere NULL.
std::unique_ptr<World> put_together(const World &part);

// What is not of particles, as the first process has it in `whole`, goes to all parts.
void spread_common(World &part, const World *whole);

} // namespace gp
