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

using Clock = std::chrono::steady_clock;

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
    const Clock::time_point end = Clock::now() + patience;
    do {
        for (int k = 0; k < 32; ++k) {
            if (done())
                return true;
            pause_processor();
        }
    } while (Clock::now() < end);
    return done();
}

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
        next_.store(0, std::memory_order_relaxed);
        door_.store(open | static_cast<uint32_t>(threads - 1) << 16, std::memory_order_release);
        loop_.fetch_add(1);
        if (sleepers_.load() > 0) {
            { const std::lock_guard<std::mutex> lock(mutex_); }
            to_helpers_.notify_all();
        }
        const int64_t own = take_shares(work);
        const Clock::duration lost = wait_for_helpers();
        if (lost > Clock::duration::zero())
            pause(pause_per_wait * lost);
        unhelped_ = own == work.blocks ? unhelped_ + 1 : 0;
        if (unhelped_ == loops_without_help) {
            unhelped_ = 0;
            pause(pause_when_busy);
        }
    }

private:
    bool is_pausing() {
        const Clock::time_point now = Clock::now();
        if (now >= next_look_) {
            const int64_t switches = involuntary_switches();
            next_look_ = now + look_every;
            if (std::exchange(switches_, switches) != switches)
                pause(pause_when_busy);
        }
        return now < pause_end_;
    }
    void pause(Clock::duration length) { pause_end_ = std::max(pause_end_, Clock::now() + length); }

    // Whether there are helpers; as many as wanted if the system has them.
    bool gather(int wanted) {
        if (static_cast<int>(helpers_.size()) >= wanted)
            return true;
        // The host's signals are for its own threads.
        sigset_t all, before;
        sigfillset(&all);
        pthread_sigmask(SIG_SETMASK, &all, &before);
        try {
            while (static_cast<int>(helpers_.size()) < wanted)
                helpers_.emplace_back([this, loop = loop_.load()] { help(loop); });
        } catch (const std::exception &) { // no memory, or no threads: the others do the work
        }
        pthread_sigmask(SIG_SETMASK, &before, nullptr);
        return !helpers_.empty();
    }

    // Returns how many blocks these were.
    int64_t take_shares(const SharedWork &work) {
        int64_t taken = 0;
        for (;;) {
            const int64_t begin = next_.fetch_add(work.share, std::memory_order_relaxed);
            if (begin >= work.blocks)
                return taken;
            const int64_t end = std::min(work.blocks, begin + work.share);
            work.run(work.body, begin, end);
            taken += end - begin;
        }
    }

    // Shuts the door behind the last share. Returns for how long it had to sleep.
    Clock::duration wait_for_helpers() {
        door_.fetch_and(~open);
        const auto nobody = [this] { return (door_.load() & inside) == 0; };
        if (look_on(nobody))
            return Clock::duration::zero();
        const Clock::time_point begin = Clock::now();
        std::unique_lock<std::mutex> lock(mutex_);
        is_waiting_.store(true);
        to_owner_.wait(lock, nobody);
        is_waiting_.store(false);
        return Clock::now() - begin;
    }

    bool enter() {
        uint32_t door = door_.load(std::memory_order_relaxed);
        while ((door & open) && (door & inside) < (door >> 16 & inside))
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

    void help(uint64_t seen) {
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
            if (enter()) {
                take_shares(work_);
                leave();
            }
        }
    }

    // door_: whether it is open, how many may be inside, how many are.
    static constexpr uint32_t open = 1u << 31, inside = 0x7fff;
    std::atomic<uint32_t> door_{0};
    std::atomic<uint64_t> loop_{0}; // that helpers are called to
    std::atomic<int64_t> next_{0};  // block that nobody has taken
    SharedWork work_{};             // while the door is open or somebody inside
    int unhelped_ = 0;              // loops in a row
    int64_t switches_ = involuntary_switches();
    Clock::time_point pause_end_, next_look_;

    std::mutex mutex_; // of those who sleep
    std::condition_variable to_helpers_, to_owner_;
    std::atomic<int> sleepers_{0};
    std::atomic<bool> is_waiting_{false}, over_{false};
    std::vector<std::thread> helpers_;
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
