!> A column on a rough floor collapses to both sides when two gates are lifted: examples/c/both_side.c in Fortran.
!>
!> Jin, Lu, Tai & Xu (2021), section 4; the aspect ratio is H over half the width, 1.25 and 5 in the paper.
program both_side
    use granperi
    use example
    implicit none
    real(gp_real), parameter :: width = 0.08_gp_real ! m, the reference length L
    type(example_options) :: options
    type(example_extra) :: aspect
    type(gp_simulation) :: sim
    real(gp_real) :: height, spacing, reach

    options%output = "both_side.h5"
    aspect = example_extra("--aspect", "height over half the width", 1.25_gp_real, 0.01_gp_real, 1000.0_gp_real)
    call parse_options("A column of glass beads, 0.08 m wide, collapses to both sides. Reference length: its width.", &
                       options, aspect)
    height = aspect%value*width/2
    spacing = width/options%resolution
    call create_beads(sim, options, spacing, grain_diameter=0.002_gp_real)

    call sim%add_column(gp_column(x_min=-width/2, y_min=0.0_gp_real, width=width, height=height, material=1))

    ! Run-outs reach about 2.5 heights beyond the foot of the column (Staron & Hinch 2005).
    reach = width/2 + 4*height + 20*spacing
    call add_floor(sim, -reach, reach)
    call add_gate(sim, -width/2, material_right, height, spacing, options%lift_time)
    call add_gate(sim, width/2, material_left, height, spacing, options%lift_time)

    call run_example(sim, options)
    call sim%destroy()
end program
