/* A column on a rough floor collapses to both sides when two gates are lifted.
 *
 * Jin, Lu, Tai & Xu (2021), section 4; the aspect ratio is H over half the width, 1.25 and 5 in the paper. */
#include "example.h"

int main(int argc, char **argv) {
    const double width = 0.08;           /* m, the reference length L */
    const double grain_diameter = 0.002; /* m */
    double aspect = 1.25, height, spacing, reach;
    example_options options = example_defaults(32, 1, "both_side.h5");
    const example_extra aspect_option = {"--aspect", "A", "height over half the width", &aspect, 0.01, 1000, 0};
    gp_column column;
    gp_sim *sim;

    example_parse(argc, argv,
                  "A column of glass beads, 0.08 m wide, collapses to both sides. Reference length: its width.",
                  &options, &aspect_option);
    height = aspect * width / 2;
    spacing = width / options.resolution;
    sim = example_create(&options, spacing, grain_diameter);

    CHECK(gp_column_init(&column, sizeof column));
    column.x_min = -width / 2;
    column.y_min = 0;
    column.width = width;
    column.height = height;
    column.material = 1;
    CHECK(gp_add_column(sim, &column, NULL));

    /* Run-outs reach about 2.5 heights beyond the foot of the column (Staron & Hinch 2005). */
    reach = width / 2 + 4 * height + 20 * spacing;
    example_add_floor(sim, -reach, reach);
    example_add_gate(sim, -width / 2, EXAMPLE_MATERIAL_RIGHT, height, spacing, options.lift_time);
    example_add_gate(sim, width / 2, EXAMPLE_MATERIAL_LEFT, height, spacing, options.lift_time);

    example_run(sim, &options);
    gp_destroy(sim);
    return 0;
}
