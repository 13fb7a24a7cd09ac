#include "parallel.hpp"

#include <atomic>

#include <pthread.h>

namespace gp {

namespace {

std::atomic<bool> used{false}, left_behind{false};

void in_forked_child() {
    if (used)
        left_behind = true;
}

} // namespace

bool threads_survive() {
    static const int registered = pthread_atfork(nullptr, nullptr, in_forked_child);
    (void)registered; // if there was no memory for it, a child needs threads = 1, as without this
    used.store(true, std::memory_order_relaxed);
    return !left_behind.load(std::memory_order_relaxed);
}

} // namespace gp
