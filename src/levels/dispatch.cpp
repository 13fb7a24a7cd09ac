// The interface of a library that has the engine more than once, compiled for different instruction sets: hands each call to the
// one that suits the processor.
//
// The choice is made once, in the first call, and not by the loader (ifunc, glibc-hwcaps): so it is the same for the shared and
// the static library, for dlopen, for sanitizers and for other C libraries, and the environment may have a say in it. It costs
// 1 to 2 ns per call.
#include <cpuid.h>

#include <cstdlib>
#include <cstring>

#include "levels/entries.hpp"

extern "C" {
extern const gp::Entries granperi_level_base, granperi_level_v3;
}

namespace {

// All that a compiler may use for x86-64-v3. The system's part of it, that it keeps the registers of AVX, is in "avx2".
bool processor_has_v3() {
    unsigned a, b, c, d;
    constexpr unsigned movbe_f16c = 1u << 22 | 1u << 29, lzcnt = 1u << 5;
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
           __builtin_cpu_supports("bmi2") && __get_cpuid(1, &a, &b, &c, &d) && (c & movbe_f16c) == movbe_f16c &&
           __get_cpuid(0x80000001u, &a, &b, &c, &d) && (c & lzcnt);
}

// The best that there is, or what GRANPERI_LEVEL names. If that is not there, gp_create and gp_load say so: require_level.
const gp::Entries &choose() {
    if (!processor_has_v3())
        return granperi_level_base;
    // NOLINTNEXTLINE(concurrency-mt-unsafe): a host that sets variables meanwhile is racing with itself
    const char *wanted = std::getenv("GRANPERI_LEVEL");
    return wanted && std::strcmp(wanted, granperi_level_base.level) == 0 ? granperi_level_base : granperi_level_v3;
}

const gp::Entries &engine() {
    static const gp::Entries &chosen = choose();
    return chosen;
}

} // namespace

extern "C" {
#define GP_CALL(result, name, parameters, arguments)                                                                   \
    result name parameters {                                                                                           \
        return engine().name arguments;                                                                                \
    }
#include "levels/calls.inc"
#ifdef GP_WITH_MPI
#include "levels/mpi_calls.inc"
#endif
#undef GP_CALL
}
