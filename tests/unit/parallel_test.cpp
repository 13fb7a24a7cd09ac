// Loops that are shared out: every block once, whoever does it.
#include <algorithm>
#include <atomic>
#include <numeric>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "parallel.hpp"

namespace {

// Every item of n exactly once, `loops` times, from one thread.
bool does_all_once(int threads, int64_t n, int loops) {
    std::vector<int> done(n, 0);
    std::vector<int64_t> sums(gp::block_count(n));
    for (int loop = 1; loop <= loops; ++loop) {
        gp::for_each_block(threads, n, [&](int64_t block, int64_t begin, int64_t end) {
            int64_t sum = 0;
            for (int64_t i = begin; i < end; ++i)
                sum += ++done[i];
            sums[block] = sum;
        });
        if (std::accumulate(sums.begin(), sums.end(), int64_t{0}) != n * loop)
            return false;
    }
    return true;
}

} // namespace

// Short loops one after the other: helpers come late, leave late, sleep and wake.
TEST(Parallel, EveryBlockIsDoneOnce) {
    for (const int threads : {1, 2, 3, 8})
        for (const int64_t n : {0, 1, 63, 64, 65, 1100, 4097})
            EXPECT_TRUE(does_all_once(threads, n, 2000)) << threads << " threads, " << n << " items";
}

TEST(Parallel, WithPausesBetweenTheLoops) {
    for (int k = 0; k < 30; ++k) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1)); // helpers fall asleep
        ASSERT_TRUE(does_all_once(3, 4097, 20));
    }
}

// Halves of a block in two threads or in one: all of it comes after both.
TEST(Parallel, BlocksAreDoneByHalves) {
    for (const int threads : {1, 2, 3, 8})
        for (const int64_t blocks : {0, 1, 4, 5, 17, 64}) {
            std::vector<uint8_t> marks(blocks, 0);
            std::vector<int> halves(2 * blocks, 0), wholes(blocks, 0);
            for (int loop = 1; loop <= 2000; ++loop) {
                std::atomic<int64_t> late{0};
                gp::for_each_block_by_halves(
                    threads, blocks, [&](int64_t block) -> uint8_t & { return marks[block]; },
                    [&](int64_t block, int64_t from, int64_t to) {
                        for (int64_t half = from; half < to; ++half)
                            ++halves[2 * block + half];
                    },
                    [&](int64_t block) {
                        late += halves[2 * block] == loop && halves[2 * block + 1] == loop;
                        ++wholes[block];
                    });
                ASSERT_EQ(late, blocks) << threads << " threads";
            }
            EXPECT_EQ(std::count(halves.begin(), halves.end(), 2000), 2 * blocks);
            EXPECT_EQ(std::count(wholes.begin(), wholes.end(), 2000), blocks);
            EXPECT_EQ(std::count(marks.begin(), marks.end(), 0), blocks);
        }
}

// Each thread of the host has helpers of its own, and they end with it.
TEST(Parallel, FromSeveralThreadsThatEnd) {
    std::atomic<int> good{0};
    for (int round = 0; round < 10; ++round) {
        std::vector<std::thread> hosts;
        for (int k = 0; k < 4; ++k)
            hosts.emplace_back([&] { good += does_all_once(3, 2000, 100); });
        for (std::thread &host : hosts)
            host.join();
    }
    EXPECT_EQ(good, 40);
}
