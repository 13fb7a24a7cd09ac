/* A column against a smooth wall collapses to one side when a gate is lifted.
 *
 * Jin, Lu, Tai & Xu (2021), section 5: height 0.14 m, length 0.20 m, grains of 0.7 mm. */
#include <stdio.h>

#include "example.h"

int main(int argc, char **argv) {
    const double length = 0.20, height = 0.14; /* m; the length is the reference length */
    const double grain_diameter = 0.0007;      /* m */
    double spacing, near_wall, height_at_wall;
    example_options options = example_defaults(80, 1.02, "one_side.h5");
    gp_column column;
    gp_plate wall;
    gp_sim *sim;

    example_parse(
        argc, argv,
        "A column of glass beads, 0.20 m long and 0.14 m high, collapses to the right. Reference length: 0.20 m.",
        &options, NULL);
    spacing = length / options.resolution;
    sim = example_create(&options, spacing, grain_diameter);

    CHECK(gp_column_init(&column, sizeof column));
    column.x_min = 0;
    column.y_min = 0;
    column.width = length;
    column.height = height;
    column.material = 1;
    CHECK(gp_add_column(sim, &column, NULL));

    CHECK(gp_plate_init(&wall, sizeof wall)); /* material on the right of the way up */
    wall.y1 = height + 6 * spacing;
    wall.friction = GP_WALL_FREE_SLIP;
    CHECK(gp_add_plate(sim, &wall, NULL));

    /* Run-outs reach about 2.5 heights beyond the foot of the column (Staron & Hinch 2005). */
    example_add_floor(sim, 0, length + 4 * height + 20 * spacing);
    example_add_gate(sim, length, EXAMPLE_MATERIAL_LEFT, height, spacing, options.lift_time);

    example_run(sim, &options);
    /* Two spacings from it: nearer, the wall takes the place of material in the smoothed volume fraction. */
    near_wall = 2 * spacing;
    CHECK(gp_get_surface(sim, 1, &near_wall, &height_at_wall));
    printf("height_at_wall      %.5f m\n", height_at_wall);
    gp_destroy(sim);
    return 0;
}
