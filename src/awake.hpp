// Loops over what is awake (sleep.hpp): over all where nothing sleeps.
#pragma once

#include "parallel.hpp"
#include "world.hpp"

namespace gp {

// Calls body(block, begin, end) for the blocks of particles that are awake.
template <class Body> void for_each_awake_block(const World &world, const Body &body) {
    const Sleep &s = world.sleep;
    for_each_chosen_block(world.threads, world.particles.count, s.some ? s.lit.data() : nullptr, s.awake, body);
}

// And of those asleep that these see: what neighbours read of a particle and no pair loop makes.
template <class Body> void for_each_seen_block(const World &world, const Body &body) {
    const Sleep &s = world.sleep;
    for_each_chosen_block(world.threads, world.particles.count, s.some ? s.lit.data() : nullptr,
                          static_cast<int64_t>(s.lit.size()), body);
}

// Calls body(begin, end) for runs of the contacts of what is awake, and of the ghosts that it sees: few at a time.
template <class Body>
void for_each_awake_run(const World &world, const std::vector<IndexRun> &runs, int64_t n, const Body &body) {
    const bool some = world.sleep.some;
    const int64_t count = some ? static_cast<int64_t>(runs.size()) : block_count<ghost_block_size>(n);
    for_each_block<1>(world.threads, count, [&](int64_t k, int64_t, int64_t) {
        const IndexRun run = some ? runs[k] : IndexRun{k * ghost_block_size, std::min(n, (k + 1) * ghost_block_size)};
        body(run.begin, run.end);
    });
}
template <class Body> void for_each_awake_contact_run(const World &world, const Body &body) {
    for_each_awake_run(world, world.sleep.contacts, static_cast<int64_t>(world.walls.contacts.size()), body);
}
template <class Body> void for_each_awake_ghost_run(const World &world, const Body &body) {
    for_each_awake_run(world, world.sleep.ghosts, world.walls.ghost_count, body);
}

// The contacts of what is awake, in their order: for (const Contact &contact : AwakeContacts(world)).
class AwakeContacts {
public:
    explicit AwakeContacts(const World &world) : contacts_(world.walls.contacts.data()) {
        const Sleep &s = world.sleep;
        whole_ = {0, static_cast<int64_t>(world.walls.contacts.size())};
        first_ = s.some ? s.contacts.data() : &whole_;
        last_ = s.some ? first_ + s.contacts.size() : first_ + (whole_.end > 0);
    }
    AwakeContacts(const AwakeContacts &) = delete;
    AwakeContacts &operator=(const AwakeContacts &) = delete;

    class Iterator {
    public:
        Iterator(const Contact *contacts, const IndexRun *run, const IndexRun *last)
            : contacts_(contacts), run_(run), last_(last), k_(run == last ? 0 : run->begin) {}
        const Contact &operator*() const { return contacts_[k_]; }
        Iterator &operator++() {
            if (++k_ == run_->end && ++run_ != last_)
                k_ = run_->begin;
            return *this;
        }
        bool operator!=(const Iterator &other) const { return run_ != other.run_; }

    private:
        const Contact *contacts_;
        const IndexRun *run_, *last_;
        int64_t k_;
    };
    Iterator begin() const { return {contacts_, first_, last_}; }
    Iterator end() const { return {contacts_, last_, last_}; }

private:
    const Contact *contacts_;
    IndexRun whole_;
    const IndexRun *first_, *last_;
};

} // namespace gp
