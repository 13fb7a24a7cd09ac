// The scene as JSON text: a result file tells with it what it is the result of.
#pragma once

#include <string>

#include "scene.hpp"

namespace gp::io {

// {"config": {...}, "materials": [{...}], "columns": [material of each], "plates": [{...}]}, with the names of gp.h.
std::string scene_text(const Scene &scene);

} // namespace gp::io
