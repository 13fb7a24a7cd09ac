// A step takes no memory from the heap once its tables have grown to the size of the scene. Counted through operator new,
// which is all that the library allocates with.
#include "../support/scene.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

using namespace test;

namespace {

std::atomic<long> allocations{0};

void *allocate(std::size_t size, std::size_t alignment) {
    ++allocations;
    void *memory = alignment > alignof(std::max_align_t)
                       ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
                       : std::malloc(size ? size : 1);
    if (!memory)
        throw std::bad_alloc();
    return memory;
}

} // namespace

void *operator new(std::size_t size) {
    return allocate(size, 0);
}
void *operator new(std::size_t size, std::align_val_t alignment) {
    return allocate(size, static_cast<std::size_t>(alignment));
}
void operator delete(void *memory) noexcept {
    std::free(memory);
}
void operator delete(void *memory, std::size_t) noexcept {
    std::free(memory);
}
void operator delete(void *memory, std::align_val_t) noexcept {
    std::free(memory);
}
void operator delete(void *memory, std::size_t, std::align_val_t) noexcept {
    std::free(memory);
}

namespace {

// A layer on a rough floor between two ends, of one plate or of a line of them, or, periodic, one that flows down an incline for
// good. All are thrown about by their initial velocity, so that lists are made anew every few steps.
enum class Flow { box, line, periodic };

gp_config flow_config(Flow flow) {
    const bool periodic = flow == Flow::periodic;
    gp_config c = config(0.01);
    c.jitter = 0.1;
    c.sound_speed = 20; // steps as long as the flow allows, so that the warm-up is long enough
    c.gravity_x = periodic ? 4.5 : 0;
    c.periodic_x_max = periodic ? 0.4 : 0;
    return c;
}

void add_flow(Sim &sim, Flow flow) {
    sim.column(0, 0, 0.4, 0.1, 0, 1);
    const int pieces = flow == Flow::line ? 30 : 1;
    for (int k = pieces; k > 0; --k)
        sim.add(floor_at(0, 0.4 * (k - 1) / pieces, 0.4 * k / pieces));
    if (flow != Flow::periodic) {
        sim.add(plate(0, 0, 0, 0.5));
        sim.add(plate(0.4, 0.5, 0.4, 0));
    }
}

class Allocations : public testing::TestWithParam<Flow> {};

} // namespace

TEST_P(Allocations, OfAStepAreNoneAfterWarmUp) {
    Sim sim(flow_config(GetParam()));
    add_flow(sim, GetParam());
    ASSERT_EQ(gp_step(sim, 1000), GP_OK) << gp_last_error();
    EXPECT_GT(allocations, 0) << "operator new is not counted";
    const long before = allocations;
    ASSERT_EQ(gp_step(sim, 300), GP_OK) << gp_last_error();
    EXPECT_EQ(allocations - before, 0);
}

INSTANTIATE_TEST_SUITE_P(Scene, Allocations, testing::Values(Flow::box, Flow::line, Flow::periodic),
                         [](const auto &flow) {
                             return flow.param == Flow::box ? "Box" : flow.param == Flow::line ? "Line" : "Periodic";
                         });
