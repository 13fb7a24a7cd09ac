#include "level.hpp"

#include <cstdlib>
#include <cstring>

#include "error.hpp"

#ifndef GP_LEVELS // of a build with one engine
#define GP_LEVELS level_name
#endif

namespace gp {

void require_level() {
    // NOLINTNEXTLINE(concurrency-mt-unsafe): a host that sets variables meanwhile is racing with itself
    const char *wanted = std::getenv("GRANPERI_LEVEL");
    if (wanted && std::strcmp(wanted, level_name) != 0)
        throw make_error(
            GP_E_UNSUPPORTED,
            "the environment variable GRANPERI_LEVEL = \"%s\": expected %s, as far as this processor has it, "
            "and before the first call; what runs is %s",
            wanted, GP_LEVELS, level_name);
}

} // namespace gp
