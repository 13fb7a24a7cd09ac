!> A column against a smooth wall collapses to one side when a gate is lifted: examples/c/one_side.c in Fortran.
!>
!> Jin, Lu, Tai & Xu (2021), section 5: height 0.14 m, length 0.20 m, grains of 0.7 mm.
program one_side
    use granperi
    use example
    implicit none
    real(gp_real), parameter :: length = 0.20_gp_real, height = 0.14_gp_real ! m; the length is the reference length
    type(example_options) :: options
    type(gp_simulation) :: sim
    real(gp_real) :: spacing, near_wall(1)

    options%output = "one_side.h5"
    options%resolution = 80
    options%end = 1.02_gp_real
    call parse_options("A column of glass beads, 0.20 m long and 0.14 m high, collapses to the right. "// &
                       "Reference length: 0.20 m.", options)
    spacing = length/options%resolution
    call create_beads(sim, options, spacing, grain_diameter=0.0007_gp_real)

    call sim%add_column(gp_column(x_min=0.0_gp_real, y_min=0.0_gp_real, width=length, height=height, material=1))
    ! Material is on the right of the way up.
    call sim%add_plate(gp_plate(y1=height + 6*spacing, friction=GP_WALL_FREE_SLIP))

    ! Run-outs reach about 2.5 heights beyond the foot of the column (Staron & Hinch 2005).
    call add_floor(sim, 0.0_gp_real, length + 4*height + 20*spacing)
    call add_gate(sim, length, material_left, height, spacing, options%lift_time)

    call run_example(sim, options)
    ! Two spacings from it: nearer, the wall takes the place of material in the smoothed volume fraction.
    near_wall = 2*spacing
    print "(a, t21, g0.6, a)", "height_at_wall", sim%surface(near_wall), " m"
    call sim%destroy()
end program
