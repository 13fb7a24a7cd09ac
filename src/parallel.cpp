#include "parallel.hpp"

#ifdef GP_WITH_OPENMP

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <new>
#include <thread>
#include <utility>
#include <vector>

#include <omp.h>
#include <pthread.h>
#include <signal.h>
#include <sys/resource.h>

#include "float_environment.hpp"

namespace gp {

namespace {

using SteadyClock = std::chrono::steady_clock;

// Who waits looks on for so long, then sleeps: longer than the gaps between the loops of a step, shorter than what the
// system's scheduler gives a process at a time.
constexpr std::chrono::microseconds patience{60};

// Nobody is asked to help for this long where other programs want the processors, told by the system having taken this thread's
// away (looked at so often): then a helper takes the time that the thread itself would get. So while this goes on there is none.
constexpr std::chrono::milliseconds pause_when_busy{10}, look_every{1};

// A helper whose processor is taken away in the middle of a share costs the time until it gets it back: for this many times as
// long nobody is asked, so that no more than a twentieth is lost in this way.
constexpr int pause_per_wait = 20;

// Nor where nobody has come in so many loops in a row: a helper that has slept needs two or three to wake up.
constexpr int loops_without_help = 16;

// How often this thread had to stop for others.
int64_t involuntary_switches() {
#ifdef RUSAGE_THREAD
    rusage usage;
    return getrusage(RUSAGE_THREAD, &usage) == 0 ? usage.ru_nivcsw : 0;
#else
    return 0;
#endif
}

void pause_processor() {
#if defined(__x86_64__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    __asm__ volatile("yield");
#endif
}

// True once done() is; false when patience has run out.
template <class Done> bool look_on(const Done &done) {
    SteadyClock::time_point end{};
    for (;;) {
        for (int k = 0; k < 32; ++k) {
            if (done())
                return true;
            pause_processor();
        }
        // Not before: what comes at once does not wait for the clock.
        const SteadyClock::time_point now = SteadyClock::now();
        if (end == SteadyClock::time_point{})
            end = now + patience;
        else if (now >= end)
            return done();
    }
}

// The blocks that one of a team begins with, in their order; who is done with its own takes others' from their ends, since
// blocks are not alike, and a processor may be taken away for a while. So a block's data stay, from loop to loop, in the cache
// of the processor that has written them: where each took the next share of all blocks, loops of a thousand particles that do
// little with each took 1.0 to 4 times as long on two threads as on one.
class alignas(64) OwnBlocks {
public:
    void set(int64_t begin, int64_t end) {
        range_.store(packed(static_cast<uint64_t>(begin), static_cast<uint64_t>(end)), std::memory_order_relaxed);
    }
    bool empty() const {
        const uint64_t range = range_.load(std::memory_order_relaxed);
        return begin_of(range) == end_of(range);
    }
    // Of what is left a quarter, so that little is left to wait for in the end. False if there is none.
    bool take(bool first, int64_t &begin, int64_t &end) {
        uint64_t range = range_.load(std::memory_order_relaxed);
        for (;;) {
            const uint64_t low = begin_of(range), high = end_of(range);
            if (low == high)
                return false;
            const uint64_t share = std::max<uint64_t>(1, (high - low) / 4);
            const uint64_t left = first ? packed(low + share, high) : packed(low, high - share);
            if (!range_.compare_exchange_weak(range, left, std::memory_order_relaxed))
                continue;
            begin = static_cast<int64_t>(first ? low : high - share);
            end = begin + static_cast<int64_t>(share);
            return true;
        }
    }

private:
    static uint64_t packed(uint64_t begin, uint64_t end) { return begin | end << 32; }
    static uint64_t begin_of(uint64_t range) { return range & 0xffffffff; }
    static uint64_t end_of(uint64_t range) { return range >> 32; }

    std::atomic<uint64_t> range_{0};
};

// A thread of the host and its helpers. A loop ends when its shares are done, and not when every helper has been there: one
// that the system does not let run is not waited for, as OpenMP's barrier would, unless it has begun a share. On a processor
// that other programs want, too, OpenMP's two threads took 15 times the time of one.
class Team {
public:
    Team() = default;
    Team(const Team &) = delete;
    Team &operator=(const Team &) = delete;
    ~Team() {
        {
            const std::lock_guard<std::mutex> lock(mutex_);
            over_ = true;
            loop_.fetch_add(1);
        }
        to_helpers_.notify_all();
        for (std::thread &helper : helpers_)
            helper.join();
    }

    void share_out(const SharedWork &work, int threads) {
        if (is_pausing() || !gather(threads - 1)) {
            work.run(work.body, 0, work.blocks);
            return;
        }
        work_ = work;
        members_ = std::min(threads, static_cast<int>(helpers_.size()) + 1);
        for (int k = 0; k < members_; ++k)
            blocks_[k].set(k * work.blocks / members_, (k + 1) * work.blocks / members_);
        door_.store(open | static_cast<uint32_t>(members_ - 1) << 16, std::memory_order_release);
        loop_.fetch_add(1);
        if (sleepers_.load() > 0) {
            { const std::lock_guard<std::mutex> lock(mutex_); }
            to_helpers_.notify_all();
        }
        const int64_t own = take_shares(work, 0);
        const SteadyClock::duration lost = wait_for_helpers();
        if (lost > SteadyClock::duration::zero())
            pause(pause_per_wait * lost);
        unhelped_ = own == work.blocks ? unhelped_ + 1 : 0;
        if (unhelped_ == loops_without_help) {
            unhelped_ = 0;
            pause(pause_when_busy);
        }
    }

private:
    bool is_pausing() {
        const SteadyClock::time_point now = SteadyClock::now();
        if (now >= next_look_) {
            const int64_t switches = involuntary_switches();
            next_look_ = now + look_every;
            if (std::exchange(switches_, switches) != switches)
                pause(pause_when_busy);
        }
        return now < pause_end_;
    }
    void pause(SteadyClock::duration length) { pause_end_ = std::max(pause_end_, SteadyClock::now() + length); }

    // Whether there are helpers; as many as wanted if the system has them.
    bool gather(int wanted) {
        if (static_cast<int>(helpers_.size()) >= wanted)
            return true;
        // The host's signals are for its own threads.
        sigset_t all, before;
        sigfillset(&all);
        pthread_sigmask(SIG_SETMASK, &all, &before);
        try {
            if (wanted > room_) { // nobody is inside
                blocks_ = std::make_unique<OwnBlocks[]>(static_cast<std::size_t>(wanted) + 1);
                room_ = wanted;
            }
            while (static_cast<int>(helpers_.size()) < wanted) {
                const int member = static_cast<int>(helpers_.size()) + 1;
                helpers_.emplace_back([this, member, loop = loop_.load()] { help(member, loop); });
            }
        } catch (const std::exception &) { // no memory, or no threads: the others do the work
        }
        pthread_sigmask(SIG_SETMASK, &before, nullptr);
        return !helpers_.empty();
    }

    // Returns how many blocks these were.
    int64_t take_shares(const SharedWork &work, int member) {
        int64_t taken = 0, begin = 0, end = 0;
        for (int k = 0; k < members_; ++k) {
            OwnBlocks &blocks = blocks_[(member + k) % members_];
            if (k > 0 && is_done_soon(blocks))
                continue;
            while (blocks.take(k == 0, begin, end)) {
                work.run(work.body, begin, end);
                taken += end - begin;
            }
        }
        return taken;
    }

    // What takes no longer than these looks, some 1.5 us, is done sooner by the one whose processor has it.
    static bool is_done_soon(const OwnBlocks &blocks) {
        for (int look = 0; look < 8; ++look) {
            if (blocks.empty())
                return true;
            for (int k = 0; k < 4; ++k)
                pause_processor();
        }
        return false;
    }

    // Shuts the door behind the last share. Returns for how long it had to sleep.
    SteadyClock::duration wait_for_helpers() {
        door_.fetch_and(~open);
        const auto nobody = [this] { return (door_.load() & inside) == 0; };
        if (look_on(nobody))
            return SteadyClock::duration::zero();
        const SteadyClock::time_point begin = SteadyClock::now();
        std::unique_lock<std::mutex> lock(mutex_);
        is_waiting_.store(true);
        to_owner_.wait(lock, nobody);
        is_waiting_.store(false);
        return SteadyClock::now() - begin;
    }

    bool enter(int member) {
        uint32_t door = door_.load(std::memory_order_relaxed);
        while ((door & open) && static_cast<uint32_t>(member) <= (door >> 16 & inside))
            if (door_.compare_exchange_weak(door, door + 1, std::memory_order_acquire))
                return true;
        return false;
    }

    void leave() {
        const uint32_t before = door_.fetch_sub(1);
        if ((before & inside) == 1 && is_waiting_.load()) {
            { const std::lock_guard<std::mutex> lock(mutex_); }
            to_owner_.notify_all();
        }
    }

    void help(int member, uint64_t seen) {
        const UsualFloats floats;
        for (;;) {
            const auto called = [&] { return loop_.load() != seen; };
            if (!look_on(called)) {
                std::unique_lock<std::mutex> lock(mutex_);
                sleepers_.fetch_add(1);
                to_helpers_.wait(lock, called);
                sleepers_.fetch_sub(1);
            }
            seen = loop_.load();
            if (over_)
                return;
            if (enter(member)) {
                take_shares(work_, member);
                leave();
            }
        }
    }

    // What a helper reads when it is called, all of it in one line of the cache.
    // door_: whether it is open, up to which number helpers may enter, how many are inside.
    static constexpr uint32_t open = 1u << 31, inside = 0x7fff;
    alignas(64) std::atomic<uint32_t> door_{0};
    int members_ = 1; // this and the next two: while the door is open or somebody inside
    SharedWork work_{};
    std::unique_ptr<OwnBlocks[]> blocks_; // of each member, this thread's first
    std::atomic<uint64_t> loop_{0};       // that helpers are called to

    alignas(64) int unhelped_ = 0; // loops in a row
    int64_t switches_ = involuntary_switches();
    SteadyClock::time_point pause_end_, next_look_;

    std::mutex mutex_; // of those who sleep
    std::condition_variable to_helpers_, to_owner_;
    std::atomic<int> sleepers_{0};
    std::atomic<bool> is_waiting_{false}, over_{false};
    std::vector<std::thread> helpers_;
    int room_ = 0; // in blocks_, for so many helpers
};

std::atomic<bool> used{false}, left_behind{false};

void in_forked_child() {
    if (used)
        left_behind = true;
}

// False in a child that was forked after this library had used threads, which fork leaves behind. All of a child's work is then
// done by the thread that calls, with the same bits.
bool threads_survive() {
    static const int registered = pthread_atfork(nullptr, nullptr, in_forked_child);
    (void)registered; // if there was no memory for it, a child needs threads = 1, as without this
    used.store(true, std::memory_order_relaxed);
    return !left_behind.load(std::memory_order_relaxed);
}

thread_local bool is_ending = false; // this thread of the host

struct TeamOfThread {
    std::unique_ptr<Team> team;
    ~TeamOfThread() {
        is_ending = true;
        if (left_behind) // its helpers cannot be joined
            (void)team.release();
    }
};

Team *team_of_thread() {
    if (is_ending)
        return nullptr;
    static thread_local TeamOfThread own;
    if (!own.team)
        own.team.reset(new (std::nothrow) Team);
    return own.team.get();
}

} // namespace

int default_threads() {
    return omp_get_max_threads();
}

// Inside a region of the host's OpenMP its other threads want the processors.
void share_out(const SharedWork &work, int threads) {
    Team *const team = threads_survive() && !omp_in_parallel() ? team_of_thread() : nullptr;
    if (team)
        team->share_out(work, threads);
    else
        work.run(work.body, 0, work.blocks);
}

} // namespace gp

#else

namespace gp {

int default_threads() {
    return 1;
}

void share_out(const SharedWork &work, int) {
    work.run(work.body, 0, work.blocks);
}

} // namespace gp

#endif
