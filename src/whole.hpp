// The whole of a world that several processes have in parts: put together on the first of them, dealt out again.
#pragma once

#include <functional>
#include <memory>

#include "error.hpp"
#include "world.hpp"

namespace gp {

// GP_E_UNSUPPORTED if a scene cannot be worked on in parts.
void require_partable(const Scene &scene);

// The part of a process, plates where they begin, without particles.
std::unique_ptr<World> make_part(const Scene &scene, Crossing &crossing);

// The part of each process. whole: on the first process the world with its lists, elsewhere NULL.
std::unique_ptr<World> deal_out(const Scene &scene, Crossing &crossing, const World *whole);

// On the first process the world that one alone would have, but for what it need not keep between steps, with its lists;
// elsewhere NULL.
std::unique_ptr<World> put_together(const World &part);

} // namespace gp
