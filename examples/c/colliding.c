/* Two columns with a gap between them collapse and collide.
 *
 * Jin, Lu, Tai & Xu (2021), section 6: case 1 with columns of different heights, case 2 of different widths. */
#include <math.h>
#include <stdio.h>

#include "example.h"

typedef struct scene {
    double left_height, left_width, right_height, right_width, end; /* m, s */
} scene;

static const scene scenes[] = {{0.156, 0.08, 0.054, 0.08, 1.61}, {0.152, 0.04, 0.152, 0.08, 0.60}};

static int32_t add_column(gp_sim *sim, double x_min, double width, double height) {
    gp_column column;
    int32_t id;
    CHECK(gp_column_init(&column, sizeof column));
    column.x_min = x_min;
    column.y_min = 0;
    column.width = width;
    column.height = height;
    column.material = 1;
    CHECK(gp_add_column(sim, &column, &id));
    return id;
}

/* Fits x = x0 + m y to the interface between 10 % and 60 % of its height: its foot is dragged by the floor and its top
 * by the surface flow. The angle to the vertical is atan m, positive if the interface leans to the right. */
static void print_interface(gp_sim *sim, int32_t left, int32_t right, double spacing, double highest) {
    enum { ROWS = 400 };
    double y[ROWS], x[ROWS];
    double top = 0, n = 0, sum_x = 0, sum_y = 0, sum_xy = 0, sum_yy = 0, slope;
    int k;
    const double step = highest / ROWS;
    for (k = 0; k < ROWS; ++k)
        y[k] = (k + 0.5) * step;
    CHECK(gp_get_interface(sim, left, right, ROWS, y, x));
    for (k = 0; k < ROWS; ++k)
        if (!isnan(x[k]))
            top = y[k];
    for (k = 0; k < ROWS; ++k)
        if (!isnan(x[k]) && y[k] >= 0.1 * top && y[k] <= 0.6 * top) {
            n += 1;
            sum_x += x[k];
            sum_y += y[k];
            sum_xy += x[k] * y[k];
            sum_yy += y[k] * y[k];
        }
    if (top < 4 * spacing) {
        printf("interface_top       0 m (the columns do not touch over a height of four spacings)\n");
        return;
    }
    slope = (n * sum_xy - sum_x * sum_y) / (n * sum_yy - sum_y * sum_y);
    printf("interface_top       %.5f m\n", top);
    printf("interface_foot_x    %.5f m\n", (sum_x - slope * sum_y) / n);
    printf("interface_angle     %.2f degrees to the vertical, fitted from 10 %% to 60 %% of interface_top\n",
           atan(slope) * 180 / acos(-1.0));
}

int main(int argc, char **argv) {
    const double gap = 0.04, reference = 0.08; /* m */
    const double grain_diameter = 0.002;       /* m */
    double number = 1, spacing, highest, reach, left_width, right_width;
    example_options options = example_defaults(40, NAN, "colliding.h5");
    const example_extra case_option = {
        "--case",
        "N",
        "1: heights 0.156/0.054 m, widths 0.08/0.08 m, end 1.61 s\n"
        "                         2: heights 0.152/0.152 m, widths 0.04/0.08 m, end 0.6 s",
        &number,
        1,
        2,
        1};
    int32_t left, right;
    const scene *s;
    gp_sim *sim;

    example_parse(argc, argv,
                  "Two columns of glass beads, 0.04 m apart, collapse and collide. Reference length: 0.08 m.", &options,
                  &case_option);
    s = &scenes[(int)number - 1];
    if (isnan(options.end))
        options.end = s->end;
    spacing = reference / options.resolution;
    highest = fmax(s->left_height, s->right_height);
    sim = example_create(&options, spacing, grain_diameter);

    /* The library rounds columns to whole spacings; the gates have to follow. */
    left_width = spacing * fmax(1, round(s->left_width / spacing));
    right_width = spacing * fmax(1, round(s->right_width / spacing));

    /* The middle of the gap is at x = 0. */
    left = add_column(sim, -gap / 2 - left_width, left_width, s->left_height);
    right = add_column(sim, gap / 2, right_width, s->right_height);
    reach = gap / 2 + 0.08 + 4 * highest + 20 * spacing;
    example_add_floor(sim, -reach, reach);
    example_add_gate(sim, -gap / 2 - left_width, EXAMPLE_MATERIAL_RIGHT, s->left_height, spacing, options.lift_time);
    example_add_gate(sim, -gap / 2, EXAMPLE_MATERIAL_LEFT, s->left_height, spacing, options.lift_time);
    example_add_gate(sim, gap / 2, EXAMPLE_MATERIAL_RIGHT, s->right_height, spacing, options.lift_time);
    example_add_gate(sim, gap / 2 + right_width, EXAMPLE_MATERIAL_LEFT, s->right_height, spacing, options.lift_time);

    example_run(sim, &options);
    print_interface(sim, left, right, spacing, highest);
    gp_destroy(sim);
    return 0;
}
