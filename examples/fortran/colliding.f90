!> Two columns with a gap between them collapse and collide: examples/c/colliding.c in Fortran.
!>
!> Jin, Lu, Tai & Xu (2021), section 6: case 1 with columns of different heights, case 2 of different widths.
program colliding
    use granperi
    use example
    use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
    implicit none

    type :: scene
        real(gp_real) :: left_height, left_width, right_height, right_width, end ! m, s
    end type
    type(scene), parameter :: scenes(2) = [ &
                              scene(0.156_gp_real, 0.08_gp_real, 0.054_gp_real, 0.08_gp_real, 1.61_gp_real), &
                              scene(0.152_gp_real, 0.04_gp_real, 0.152_gp_real, 0.08_gp_real, 0.60_gp_real)]
    real(gp_real), parameter :: gap = 0.04_gp_real, reference = 0.08_gp_real ! m
    type(example_options) :: options
    type(example_extra) :: number
    type(gp_simulation) :: sim
    type(scene) :: s
    real(gp_real) :: spacing, highest, left_width, right_width, reach
    integer :: left, right

    options%output = "colliding.h5"
    options%resolution = 40
    options%end = -1
    number = example_extra("--case", "1: heights 0.156/0.054 m, widths 0.08/0.08 m, end 1.61 s; 2: heights "// &
                           "0.152/0.152 m, widths 0.04/0.08 m, end 0.6 s", 1.0_gp_real, 1.0_gp_real, 2.0_gp_real, .true.)
    call parse_options("Two columns of glass beads, 0.04 m apart, collapse and collide. Reference length: 0.08 m.", &
                       options, number)
    s = scenes(nint(number%value))
    if (options%end < 0) options%end = s%end
    spacing = reference/options%resolution
    highest = max(s%left_height, s%right_height)
    call create_beads(sim, options, spacing, grain_diameter=0.002_gp_real)

    ! The library rounds columns to whole spacings; the gates have to follow.
    left_width = spacing*max(1, nint(s%left_width/spacing))
    right_width = spacing*max(1, nint(s%right_width/spacing))

    ! The middle of the gap is at x = 0.
    call sim%add_column(gp_column(x_min=-gap/2 - left_width, y_min=0.0_gp_real, width=left_width, height=s%left_height, &
                                  material=1), left)
    call sim%add_column(gp_column(x_min=gap/2, y_min=0.0_gp_real, width=right_width, height=s%right_height, &
                                  material=1), right)
    reach = gap/2 + 0.08_gp_real + 4*highest + 20*spacing
    call add_floor(sim, -reach, reach)
    call add_gate(sim, -gap/2 - left_width, material_right, s%left_height, spacing, options%lift_time)
    call add_gate(sim, -gap/2, material_left, s%left_height, spacing, options%lift_time)
    call add_gate(sim, gap/2, material_right, s%right_height, spacing, options%lift_time)
    call add_gate(sim, gap/2 + right_width, material_left, s%right_height, spacing, options%lift_time)

    call run_example(sim, options)
    call print_interface()
    call sim%destroy()

contains

    !> Fits x = x0 + m y to the interface between 10 % and 60 % of its height: its foot is dragged by the floor and its top
    !> by the surface flow. The angle to the vertical is atan m, positive if the interface leans to the right.
    subroutine print_interface()
        integer, parameter :: rows = 400
        real(gp_real) :: x(rows), y(rows), top, slope
        logical :: there(rows), used(rows)
        integer :: k, n
        y = [((k - 0.5_gp_real)*(highest/rows), k=1, rows)]
        x = sim%interface_between(left, right, y)
        there = .not. ieee_is_nan(x)
        top = maxval(y, mask=there)
        if (.not. any(there) .or. top < 4*spacing) then
            print "(a)", "interface_top       0 m (the columns do not touch over a height of four spacings)"
            return
        end if
        used = there .and. y >= 0.1_gp_real*top .and. y <= 0.6_gp_real*top
        n = count(used)
        where (.not. used) x = 0 ! NaN times a mask stays NaN
        slope = (n*sum(x*y, used) - sum(x, used)*sum(y, used))/(n*sum(y*y, used) - sum(y, used)**2)
        print "(a, t21, g0.6, a)", "interface_top", top, " m"
        print "(a, t21, g0.6, a)", "interface_foot_x", (sum(x, used) - slope*sum(y, used))/n, " m"
        print "(a, t21, f0.2, a)", "interface_angle", atan(slope)*180/acos(-1.0_gp_real), &
            " degrees to the vertical, fitted from 10 % to 60 % of interface_top"
    end subroutine
end program
