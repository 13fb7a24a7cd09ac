// What a plate at rest does to material that falls on it: it takes energy, and gives none.
#include <algorithm>

#include "../support/scene.hpp"

using namespace test;

namespace {

// Most that the energy of a block of `width` x `height` grains grew by that fell `drop` spacings, over the largest energy of
// its motion and compression and that of a fall by a spacing.
double growth(int width, int height, double drop, int32_t friction) {
    gp_config c = config(0.01);
    c.gravity_y = -1.5;
    Sim sim(c);
    sim.column(-0.5 * width * c.spacing, 0, width * c.spacing, height * c.spacing);
    sim.add(floor_at(-drop * c.spacing, -0.2, 0.2, friction));
    const gp_state start = sim.state();
    const double energy = start.kinetic + start.potential + start.elastic;
    const double weight = 1550 * 1.5 * width * height * c.spacing * c.spacing; // N/m
    double most = 0, moved = 0;
    for (int k = 0; k < 400; ++k) {
        sim.step();
        const gp_state s = sim.state();
        moved = std::max(moved, s.kinetic + s.elastic);
        most = std::max(most, s.kinetic + s.potential + s.elastic - energy);
    }
    return most / (moved + weight * c.spacing);
}

} // namespace

// Few grains compress by the inverse of a poor shape tensor, ghosts push by that of a full one: while a grain saw the whole of
// the ghosts' motion towards it, such blocks gained up to .27 of their energy. The most that is left is .002, the error of
// the steps.
TEST(WallEnergy, DoesNotGrowWhereFewGrainsFallOnAFloor) {
    double most = 0;
    for (const int32_t friction : {GP_WALL_FREE_SLIP, GP_WALL_NO_SLIP})
        for (const int width : {1, 2, 8})
            for (const int height : {1, 2, 3, 5})
                for (const double drop : {0.0, 1.3, 2.57}) {
                    const double grown = growth(width, height, drop, friction);
                    most = std::max(most, grown);
                    EXPECT_LT(grown, 0.02) << width << " x " << height << ", " << drop << ", friction " << friction;
                }
    std::printf("  most %.3f\n", most);
}
