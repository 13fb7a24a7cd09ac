// The only files that know threads: this and its .cpp.
//
// Work is cut into blocks of a fixed number of items. Each block is done by one thread, sums are kept per block and
// added in block order, so results do not depend on the number of threads.
#pragma once

#include <algorithm>
#include <cstdint>

namespace gp {

constexpr int64_t block_size = 64;
// Ghosts and contacts are few, and each is a sum over some 25 particles: blocks of 64 would leave them to one thread in
// scenes of a thousand particles, where they are a quarter of the work.
constexpr int64_t ghost_block_size = 16;

template <int64_t Size = block_size> int64_t block_count(int64_t n) {
    return (n + Size - 1) / Size;
}

// Threads that a simulation uses when its config says 0.
int default_threads();

// Work that is shared out: run(body, begin, end) for shares of `blocks` blocks. A thread gets, as far as may be, the same part of
// the blocks in each loop, and so finds in its cache what it has left there.
struct SharedWork {
    void (*run)(const void *body, int64_t begin, int64_t end);
    const void *body;
    int64_t blocks;
};
void share_out(const SharedWork &work, int threads);

// Shares out run(begin, end) over `blocks` blocks. run must not throw: nobody would catch it in another thread.
template <class Run> void for_each_share(int threads, int64_t blocks, const Run &run) {
    // A thread with less than this to do costs more than it brings.
    constexpr int64_t least_blocks = 8;
    const int useful = static_cast<int>(std::max<int64_t>(1, std::min<int64_t>(threads, blocks / least_blocks)));
    if (useful == 1) {
        run(0, blocks);
        return;
    }
    share_out(
        {[](const void *it, int64_t begin, int64_t end) { (*static_cast<const Run *>(it))(begin, end); }, &run, blocks},
        useful);
}

// Calls body(block, begin, end) for the blocks of n items.
template <int64_t Size = block_size, class Body> void for_each_block(int threads, int64_t n, const Body &body) {
    for_each_share(threads, block_count<Size>(n), [&](int64_t begin, int64_t end) {
        for (int64_t block = begin; block < end; ++block)
            body(block, block * Size, std::min(n, (block + 1) * Size));
    });
}

// Shares out blocks by halves, for work of which some needs all of a block: calls part(block, from, to) for the halves 0 to 1, 1 to 2
// or, where one thread has both, 0 to 2, and then whole(block), by the thread that comes later. mark_of(block): a byte of its own, 0
// before and after.
template <class MarkOf, class Part, class Whole>
void for_each_block_by_halves(int threads, int64_t blocks, const MarkOf &mark_of, const Part &part,
                              const Whole &whole) {
    for_each_share(threads, 2 * blocks, [&](int64_t begin, int64_t end) {
        for (int64_t half = begin; half < end;) {
            const int64_t block = half / 2, from = half % 2, to = end - half >= 2 ? 2 : from + 1;
            part(block, from, to);
            half += to - from;
            if (to - from == 2 || __atomic_fetch_xor(&mark_of(block), uint8_t{1}, __ATOMIC_ACQ_REL) != 0)
                whole(block);
        }
    });
}

} // namespace gp
