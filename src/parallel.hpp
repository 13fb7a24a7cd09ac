// The only file, with its .cpp, that knows OpenMP.
//
// Work is cut into blocks of a fixed number of items. Each block is done by one thread, sums are kept per block and
// added in block order, so results do not depend on the number of threads.
#pragma once

#include <algorithm>
#include <cstdint>

#include "float_environment.hpp"

#ifdef GP_WITH_OPENMP
#include <omp.h>
#endif

// Pair loops are compiled once per instruction set and chosen when the library is loaded. Sanitizers run before the
// loader has resolved such functions, and clang's OpenMP outlining defeats them, so they are for plain g++ builds.
#if defined(GP_ONE_VERSION)
#define GP_MULTIVERSION __attribute__((target(GP_ONE_VERSION)))
#elif defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && !defined(GP_NO_MULTIVERSION)
#define GP_MULTIVERSION __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define GP_MULTIVERSION
#endif
#define GP_INLINE inline __attribute__((always_inline))

namespace gp {

constexpr int64_t block_size = 64;
// Ghosts and contacts are few, and each is a sum over some 25 particles: blocks of 64 would leave them to one thread in
// scenes of a thousand particles, where they are a quarter of the work.
constexpr int64_t ghost_block_size = 16;

template <int64_t Size = block_size> int64_t block_count(int64_t n) {
    return (n + Size - 1) / Size;
}

// Threads that a simulation uses when its config says 0.
inline int default_threads() {
#ifdef GP_WITH_OPENMP
    return omp_get_max_threads();
#else
    return 1;
#endif
}

// False in a child that was forked after this library had used threads: GNU OpenMP waits for ever for those that fork left
// behind. All of a child's work is then done by the thread that calls, with the same bits. Asked before each use.
bool threads_survive();

// Calls body(block, begin, end) for the blocks of n items. body must not throw: an exception cannot leave a parallel
// region. The number of threads is passed to this region alone; the host's OpenMP settings are never changed.
template <int64_t Size = block_size, class Body> void for_each_block(int threads, int64_t n, const Body &body) {
    const int64_t blocks = block_count<Size>(n);
#ifdef GP_WITH_OPENMP
    // A thread with less than this to do costs more than it brings, above all where other programs want the processors.
    constexpr int64_t least_blocks = 8;
    const int useful = static_cast<int>(std::max<int64_t>(1, std::min<int64_t>(threads, blocks / least_blocks)));
    if (useful > 1 && threads_survive()) {
        // Blocks are not alike (what flows has more to do, and lies above what rests), and a processor may be taken away for
        // a while: whoever is done takes the next share. Were they all alike, each thread would have so many:
        constexpr int64_t turns = 8;
        const int64_t share = std::max<int64_t>(1, blocks / (useful * turns));
#pragma omp parallel num_threads(useful)
        {
            const UsualFloats floats;
#pragma omp for schedule(dynamic, share) nowait
            for (int64_t block = 0; block < blocks; ++block)
                body(block, block * Size, std::min(n, (block + 1) * Size));
        }
        return;
    }
#else
    (void)threads;
#endif
    for (int64_t block = 0; block < blocks; ++block)
        body(block, block * Size, std::min(n, (block + 1) * Size));
}

} // namespace gp
