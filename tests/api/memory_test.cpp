// Out of memory at every single allocation of every call: GP_E_MEMORY, and all is as it was.
#include <cstdlib>
#include <functional>
#include <new>
#include <utility>

#include "api_support.hpp"

using namespace api;

namespace {

// Of this thread: allocations until one fails, or negative while none does. Replacing the operators here replaces them
// in the shared library, too.
thread_local long allocations_left = -1;
thread_local bool has_failed = false;

void *allocate(std::size_t size, std::size_t alignment) {
    if (allocations_left >= 0 && allocations_left-- == 0) {
        has_failed = true;
        throw std::bad_alloc();
    }
    void *memory = nullptr;
    if (alignment <= alignof(std::max_align_t))
        memory = std::malloc(size > 0 ? size : 1);
    else if (::posix_memalign(&memory, alignment, size > 0 ? size : 1) != 0)
        memory = nullptr;
    if (!memory)
        throw std::bad_alloc();
    return memory;
}

} // namespace

// Each stays a function of its own: a checker of memory that puts its operators in the place of these has to find all.
#ifdef __clang__
#define REPLACED [[gnu::noinline]]
#else
#define REPLACED [[gnu::noipa]]
#endif

// clang-format off
REPLACED void *operator new(std::size_t size) { return allocate(size, 1); }
REPLACED void *operator new[](std::size_t size) { return allocate(size, 1); }
REPLACED void *operator new(std::size_t size, std::align_val_t a) { return allocate(size, std::size_t(a)); }
REPLACED void *operator new[](std::size_t size, std::align_val_t a) { return allocate(size, std::size_t(a)); }
REPLACED void *operator new(std::size_t size, const std::nothrow_t &) noexcept { return std::malloc(size + 1); }
REPLACED void *operator new[](std::size_t size, const std::nothrow_t &) noexcept { return std::malloc(size + 1); }
REPLACED void operator delete(void *memory) noexcept { std::free(memory); }
REPLACED void operator delete[](void *memory) noexcept { std::free(memory); }
REPLACED void operator delete(void *memory, const std::nothrow_t &) noexcept { std::free(memory); }
REPLACED void operator delete[](void *memory, const std::nothrow_t &) noexcept { std::free(memory); }
REPLACED void operator delete(void *memory, std::size_t) noexcept { std::free(memory); }
REPLACED void operator delete[](void *memory, std::size_t) noexcept { std::free(memory); }
REPLACED void operator delete(void *memory, std::align_val_t) noexcept { std::free(memory); }
REPLACED void operator delete[](void *memory, std::align_val_t) noexcept { std::free(memory); }
REPLACED void operator delete(void *memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
REPLACED void operator delete[](void *memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
// clang-format on

namespace {

// Calls with the n-th allocation failing, n = 0, 1, ..., until nothing fails any more; `check` looks after each
// failure. `call` hands over the result of the library's call only: no test macro may need memory within.
void fail_each_allocation(const char *name, const std::function<gp_status()> &call,
                          const std::function<void()> &check) {
    SCOPED_TRACE(name);
    for (long n = 0; n < 1000; ++n) {
        has_failed = false;
        allocations_left = n;
        const gp_status status = call();
        allocations_left = -1;
        if (!has_failed) {
            EXPECT_EQ(status, GP_OK) << gp_last_error();
            return;
        }
        ASSERT_EQ(status, GP_E_MEMORY) << "allocation " << n << ": " << gp_last_error();
        ASSERT_STRNE(gp_last_error(), "");
        check();
        if (testing::Test::HasFailure())
            return;
    }
    ADD_FAILURE() << "a thousand allocations";
}

class Memory : public testing::Test {
protected:
    void SetUp() override {
        allocations_left = 0;
        try {
            ::operator delete(::operator new(1));
        } catch (const std::bad_alloc &) {
        }
        const bool replaced = std::exchange(has_failed, false);
        allocations_left = -1;
        if (!replaced)
            GTEST_SKIP() << "another program has replaced the operators";
    }
};

} // namespace

TEST_F(Memory, CreateSaysSo) {
    const gp_config config = make_config();
    gp_sim *sim = nullptr;
    fail_each_allocation(
        "gp_create",
        [&] {
            gp_destroy(sim);
            sim = reinterpret_cast<gp_sim *>(1);
            return gp_create(&config, &sim);
        },
        [&] { EXPECT_EQ(sim, nullptr); });
    gp_destroy(sim);
}

TEST_F(Memory, AddingLeavesTheSceneAsItWas) {
    Sim sim;
    const gp_material material = make_material();
    gp_column column = make_column(5, 5);
    column.width = 5.3 * spacing; // with a note for the log
    const std::vector<double> x(30, 1.0), t = {0, 1};
    gp_plate plate = make_floor();
    plate.n_knots = 2;
    plate.knot_t = plate.knot_x = plate.knot_y = t.data();
    std::size_t count = 0;
    const auto unchanged = [&](const std::function<gp_status()> &call, const char *name, int added) {
        const uint64_t epoch = sim.epoch();
        fail_each_allocation(name, call, [&] {
            EXPECT_EQ(sim.epoch(), epoch);
            EXPECT_EQ(static_cast<std::size_t>(sim.count()), count);
        });
        count += static_cast<std::size_t>(added);
        EXPECT_EQ(static_cast<std::size_t>(sim.count()), count);
    };
    for (int again = 0; again < 3; ++again) { // vectors grow at some calls and not at others
        unchanged([&] { return gp_add_material(sim, &material, nullptr); }, "gp_add_material", 0);
        unchanged([&] { return gp_add_plate(sim, &plate, nullptr); }, "gp_add_plate", 0);
        unchanged([&] { return gp_add_column(sim, &column, nullptr); }, "gp_add_column", 25);
        unchanged([&] { return gp_add_particles(sim, 0, 30, x.data(), x.data(), x.data(), x.data(), nullptr); },
                  "gp_add_particles", 30);
    }
    // Ids go on without gaps.
    EXPECT_EQ(sim.add(make_material()), 4);
    EXPECT_EQ(sim.add(make_floor()), 3);
    EXPECT_EQ(sim.add(make_column(2, 2)), 6);
}

// The first reader or step makes the engine's arrays; if that fails, the next one makes them, and all of them.
TEST_F(Memory, ReadingCanBeTriedAgain) {
    std::vector<uint64_t> expected;
    for (int k = 0; k < 2; ++k) {
        Sim sim;
        add_collapse(sim, 6, 6);
        double field[36], x = 0.02, height;
        gp_state state{};
        state.struct_size = sizeof state;
        gp_particles particles{};
        particles.struct_size = sizeof particles;
        gp_plan_entry entries[50];
        int64_t n;
        if (k == 1) {
            fail_each_allocation(
                "gp_get_state", [&] { return gp_get_state(sim, &state); }, [] {});
            fail_each_allocation(
                "gp_get_particles", [&] { return gp_get_particles(sim, GP_FIELD_ALL, &particles); }, [] {});
            fail_each_allocation(
                "gp_copy_field", [&] { return gp_copy_field(sim, GP_FIELD_VISCOSITY, field, 36); }, [] {});
            fail_each_allocation(
                "gp_get_surface", [&] { return gp_get_surface(sim, 1, &x, &height); }, [] {});
            fail_each_allocation(
                "gp_get_plan", [&] { return gp_get_plan(sim, 50, entries, &n); }, [&] { EXPECT_EQ(n, 0); });
        }
        ASSERT_EQ(gp_step(sim, 10), GP_OK) << gp_last_error();
        EXPECT_GT(sim.state().time, 0);
        if (k == 0)
            expected = snapshot(sim, 3);
        else {
            EXPECT_EQ(snapshot(sim, 3), expected);
        }
    }
}

// The step is taken again, and nothing tells the two runs apart. All the stages of all schemes: tests/trust/oom.cpp.
TEST_F(Memory, AStepCanBeTakenAgain) {
    Sim calm;
    add_collapse(calm, 6, 6);
    ASSERT_EQ(gp_step(calm, 1), GP_OK);
    const std::vector<uint64_t> expected = snapshot(calm, 3);
    for (long n = 0; n < 1000; ++n) {
        Sim sim;
        add_collapse(sim, 6, 6);
        has_failed = false;
        allocations_left = n;
        const gp_status status = gp_step(sim, 1);
        allocations_left = -1;
        if (!has_failed) {
            EXPECT_EQ(status, GP_OK);
            EXPECT_GT(n, 10);
            return;
        }
        ASSERT_EQ(status, GP_E_MEMORY) << gp_last_error();
        sim.view(GP_FIELD_ALL);
        ASSERT_EQ(gp_step(sim, 1), GP_OK) << "allocation " << n << ": " << gp_last_error();
        ASSERT_EQ(snapshot(sim, 3), expected) << "allocation " << n;
        for (const gp_plan_entry &entry : sim.plan())
            if (entry.kind == 0 && entry.active) {
                ASSERT_GT(entry.calls, 0) << entry.name << ", allocation " << n;
            }
    }
    ADD_FAILURE() << "a thousand allocations";
}
