// A step takes no memory from the heap once its tables have grown to the size of the scene. Counted through operator new,
// which is all that the library allocates with.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "granperi/gp.h"

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

struct Flow {
    gp_sim *sim = nullptr;

    // A layer on a rough floor between two ends, or, periodic, one that flows down an incline for good. Both are thrown
    // about by their initial velocity, so that lists are made anew every few steps.
    explicit Flow(bool periodic) {
        gp_config config;
        EXPECT_EQ(gp_config_init(&config, sizeof config, GP_PRESET_DEFAULT), GP_OK);
        config.spacing = 0.01;
        config.jitter = 0.1;
        config.threads = 1;
        config.gravity_x = periodic ? 4.5 : 0;
        if (periodic)
            config.periodic_x_max = 0.4;
        EXPECT_EQ(gp_create(&config, &sim), GP_OK);
        gp_column column;
        EXPECT_EQ(gp_column_init(&column, sizeof column), GP_OK);
        column.width = 0.4;
        column.height = 0.1;
        column.vx = 1;
        EXPECT_EQ(gp_add_column(sim, &column, nullptr), GP_OK);
        add_plate(0.4, 0, 0, 0);
        if (!periodic) {
            add_plate(0, 0, 0, 0.5);
            add_plate(0.4, 0.5, 0.4, 0);
        }
    }
    Flow(const Flow &) = delete;
    Flow &operator=(const Flow &) = delete;
    ~Flow() { gp_destroy(sim); }

    void add_plate(double x0, double y0, double x1, double y1) {
        gp_plate plate;
        EXPECT_EQ(gp_plate_init(&plate, sizeof plate), GP_OK);
        plate.x0 = x0;
        plate.y0 = y0;
        plate.x1 = x1;
        plate.y1 = y1;
        EXPECT_EQ(gp_add_plate(sim, &plate, nullptr), GP_OK);
    }
};

class Allocations : public testing::TestWithParam<bool> {};

} // namespace

TEST_P(Allocations, OfAStepAreNoneAfterWarmUp) {
    const Flow flow(GetParam());
    ASSERT_EQ(gp_step(flow.sim, 600), GP_OK) << gp_last_error();
    EXPECT_GT(allocations, 0) << "operator new is not counted";
    const long before = allocations;
    ASSERT_EQ(gp_step(flow.sim, 300), GP_OK) << gp_last_error();
    EXPECT_EQ(allocations - before, 0);
}

INSTANTIATE_TEST_SUITE_P(Scene, Allocations, testing::Bool(),
                         [](const auto &periodic) { return periodic.param ? "Periodic" : "Box"; });
