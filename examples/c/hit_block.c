/* A column collapses against a wall, and its flow hits a rigid block that stands on the floor: two-way coupling by the host.
 *
 * The host owns the block. After each step it reads what the material does to the block's faces (gp_get_plate_load), finds
 * the block's new velocity under this force and the friction of the floor, and hands it to the faces
 * (gp_set_plate_velocity). The library need not know that there is a block.
 *
 * At the end it prints the balance of horizontal momentum: that of grains and block is the impulse which the wall and the
 * floor gave to the grains and the friction of the floor to the block, whatever passed between grains and block. */
#include <math.h>
#include <stdio.h>

#include "example.h"

enum { RIGHT_FACE, TOP_FACE, LEFT_FACE, N_FACES };

typedef struct block {
    int32_t faces[N_FACES];
    double mass, friction;         /* kg/m; Coulomb coefficient of block on floor */
    double x, velocity;            /* m, of its left face; m/s */
    double force_x, force_y;       /* N/m, of the material, over the last step */
    double floor_impulse;          /* N s/m, of the floor's friction on the block */
    double stopped_at, moved_from; /* s */
} block;

static gp_state state_of(gp_sim *sim) {
    gp_state state = {.struct_size = sizeof state};
    CHECK(gp_get_state(sim, &state));
    return state;
}

static gp_load load_of(gp_sim *sim, int32_t plate) {
    gp_load load = {.struct_size = sizeof load};
    CHECK(gp_get_plate_load(sim, plate, &load));
    return load;
}

static int32_t add_smooth_plate(gp_sim *sim, double x0, double y0, double x1, double y1) {
    gp_plate plate;
    int32_t id;
    CHECK(gp_plate_init(&plate, sizeof plate));
    plate.x0 = x0;
    plate.y0 = y0;
    plate.x1 = x1;
    plate.y1 = y1;
    plate.friction = GP_WALL_FREE_SLIP;
    CHECK(gp_add_plate(sim, &plate, &id));
    return id;
}

/* Counterclockwise, so that the body of each face is on the left of its way. */
static block add_block(gp_sim *sim, double x, double size, double density) {
    block b = {{0}, 0, 0.3, 0, 0, 0, 0, 0, 0, 0};
    b.faces[RIGHT_FACE] = add_smooth_plate(sim, x + size, 0, x + size, size);
    b.faces[TOP_FACE] = add_smooth_plate(sim, x + size, size, x, size);
    b.faces[LEFT_FACE] = add_smooth_plate(sim, x, size, x, 0);
    b.mass = density * size * size;
    b.x = x;
    return b;
}

/* One step of the block's own law, m dv/dt = force + friction, |friction| <= mu (weight + what lies on it): the floor takes as
 * much momentum as it may, but not more than there is. */
static void move_block(block *b, double dt, double time) {
    const double pressed = fmax(0, 9.81 * b->mass - b->force_y), limit = b->friction * pressed * dt;
    const double without = b->mass * b->velocity + b->force_x * dt;
    const double by_floor = fmax(-limit, fmin(limit, -without));
    const double velocity = (without + by_floor) / b->mass;
    if (velocity != 0 && b->moved_from == 0)
        b->moved_from = time;
    if (velocity == 0 && b->velocity != 0)
        b->stopped_at = time;
    b->velocity = velocity;
    b->floor_impulse += by_floor;
}

/* One step of both: what the grains do to the block acts until the end of the step in which they did it. */
static void step(gp_sim *sim, block *b) {
    gp_state state;
    int k;
    CHECK(gp_step(sim, 1));
    state = state_of(sim);
    b->force_x = b->force_y = 0;
    for (k = 0; k < N_FACES; ++k) {
        const gp_load load = load_of(sim, b->faces[k]);
        b->force_x += load.fx;
        b->force_y += load.fy;
    }
    b->x += b->velocity * state.dt;
    move_block(b, state.dt, state.time);
    for (k = 0; k < N_FACES; ++k)
        CHECK(gp_set_plate_velocity(sim, b->faces[k], b->velocity, 0));
}

int main(int argc, char **argv) {
    const double width = 0.08, height = 0.10, at = 0.15; /* m */
    double size = 0.03, spacing, next = 0, largest = 0, error;
    example_options options = example_defaults(32, 0.6, NULL);
    const example_extra size_option = {"--block", "SIZE", "side of the block, m", &size, 0.01, 0.05, 0};
    gp_column column;
    gp_sim *sim;
    gp_state state;
    gp_load ground, wall;
    block b;

    options.lift_time = NAN;
    example_parse(
        argc, argv,
        "A column, 0.08 m wide and 0.10 m high, collapses and its flow pushes a block. Reference length: 0.08 m.",
        &options, &size_option);
    spacing = width / options.resolution;
    sim = example_create(&options, spacing, 0.002);
    CHECK(gp_column_init(&column, sizeof column));
    column.width = width;
    column.height = height;
    column.material = 1;
    CHECK(gp_add_column(sim, &column, NULL));
    example_add_floor(sim, 0, 1); /* plate 0 */
    add_smooth_plate(sim, 0, 0, 0, height + 6 * spacing);
    b = add_block(sim, at, size, 1500);

    printf("# time s, block's left face m, its velocity m/s, force of the grains on it N/m: x, y;"
           " horizontal momentum kg/s: grains, block; impulse of ground on grains and block N s/m\n");
    do {
        step(sim, &b);
        state = state_of(sim);
        ground = load_of(sim, 0);
        wall = load_of(sim, 1);
        largest = fmax(largest, fabs(state.momentum_x));
        if (state.time >= next) {
            printf("%.4f %.5f %.5f %.4f %.4f %.6f %.6f %.6f\n", state.time, b.x, b.velocity, b.force_x, b.force_y,
                   state.momentum_x, b.mass * b.velocity, b.floor_impulse - ground.impulse_x - wall.impulse_x);
            next += 0.02;
        }
    } while (state.time < options.end);

    /* The load of a plate is the force on the plate: the opposite acts on the grains, which began at rest. */
    error = state.momentum_x + b.mass * b.velocity - (b.floor_impulse - ground.impulse_x - wall.impulse_x);
    printf("block_moved         %.5f m\n", b.x - at);
    printf("block_moves_from    %.4f s\n", b.moved_from);
    printf("block_stops_at      %.4f s\n", b.stopped_at);
    printf("momentum_largest    %.6g kg/s\n", largest);
    printf("momentum_error      %.3g kg/s\n", error);
    printf("momentum_error_share %.3g of momentum_largest\n", fabs(error) / largest);
    gp_destroy(sim);
    return 0;
}
