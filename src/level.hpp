// The instruction set that whoever includes this is compiled for. The engine may be in a library more than once, for several of
// them (levels/dispatch.cpp); each knows only its own.
#pragma once

namespace gp {

// The x86-64 psABI's names.
#if !defined(__x86_64__)
constexpr const char *level_name = "generic";
#elif defined(__AVX512F__) && defined(__AVX512VL__) && defined(__AVX512BW__) && defined(__AVX512DQ__)
constexpr const char *level_name = "x86-64-v4";
#elif defined(__AVX2__) && defined(__FMA__) && defined(__BMI2__) && defined(__F16C__) && defined(__LZCNT__)
constexpr const char *level_name = "x86-64-v3";
#elif defined(__SSE4_2__) && defined(__POPCNT__)
constexpr const char *level_name = "x86-64-v2";
#else
constexpr const char *level_name = "x86-64";
#endif

// Is this the library for several processes? src/without_mpi.cpp, or src/mpi.
extern const bool has_mpi;

// GP_E_UNSUPPORTED if the environment variable GRANPERI_LEVEL asks for another one.
void require_level();

} // namespace gp
