!> A hopper empties through its outlet onto a floor: examples/c/hopper.c in Fortran.
!>
!> Beverloo's law: rho sqrt(g) D**1.5 per metre of depth, times a number that does not know how much is left above.
module hopper_scene
    use granperi
    use example, only: fill
    implicit none
    real(gp_real), parameter :: outlet = 0.05_gp_real, width = 0.25_gp_real ! m
    real(gp_real), parameter :: density = 2500*0.62_gp_real ! kg/m3, of the filling
    real(gp_real) :: spacing = 0

    type :: record
        real(gp_real) :: next = 0
        integer :: n = 0
        real(gp_real) :: time(100000), mass(100000) !! s; kg/m above the outlet
    end type

contains

    !> Bin and funnel at 45 degrees: one line each side, from below upwards on the left, from above downwards on the right, as
    !> the plate's body is on the left of its way.
    subroutine add_walls(sim, top)
        type(gp_simulation), intent(inout) :: sim
        real(gp_real), intent(in) :: top
        real(gp_real), parameter :: shoulder = (width - outlet)/2
        call sim%add_plate(gp_plate(), point_x=[-outlet/2, -width/2, -width/2], point_y=[0.0_gp_real, shoulder, top])
        call sim%add_plate(gp_plate(), point_x=[width/2, width/2, outlet/2], point_y=[top, shoulder, 0.0_gp_real])
    end subroutine

    !> Half a spacing off the walls.
    logical function is_inside(x, y)
        real(gp_real), intent(in) :: x, y
        is_inside = (y - (abs(x) - outlet/2))/sqrt(2.0_gp_real) > 0.49_gp_real*spacing
    end function

    !> Between two steps, 100 times a second: what is still above the outlet?
    subroutine look(sim, context, stop_run)
        class(gp_simulation), intent(inout) :: sim
        class(*), pointer, intent(inout) :: context
        logical, intent(inout) :: stop_run
        type(gp_particles) :: p
        real(gp_real) :: time
        call sim%clock(time)
        select type (r => context)
        type is (record)
            if (time < r%next .or. r%n == size(r%time)) return
            p = sim%particles(GP_FIELD_Y)
            r%n = r%n + 1
            r%time(r%n) = time
            r%mass(r%n) = count(p%y > 0)*(density*spacing*spacing)
            r%next = time + 0.01_gp_real
        class default
            stop_run = .true.
        end select
    end subroutine

    !> kg/(m s) from the first look at or after `from`, and at the latest when a fifth is left, by a straight line.
    function flow_rate(r, from) result(rate)
        type(record), intent(in) :: r
        real(gp_real), intent(in) :: from
        real(gp_real) :: rate, n, t, m, tt, tm
        integer :: k
        n = 0
        t = 0
        m = 0
        tt = 0
        tm = 0
        do k = 1, r%n
            if (r%time(k) < from .or. r%mass(k) <= 0.2_gp_real*r%mass(1)) cycle
            n = n + 1
            t = t + r%time(k)
            m = m + r%mass(k)
            tt = tt + r%time(k)**2
            tm = tm + r%time(k)*r%mass(k)
        end do
        rate = -(n*tm - t*m)/(n*tt - t*t)
    end function
end module

program hopper
    use granperi
    use example
    use hopper_scene
    implicit none
    type(example_options) :: options
    type(example_extra) :: height
    type(gp_simulation) :: sim
    type(record), target :: r
    integer :: k

    options%output = "hopper.h5"
    options%resolution = 10
    options%end = 1.2_gp_real
    options%lift_time = -1
    height = example_extra("--height", "filling above the outlet, m", 0.25_gp_real, 0.12_gp_real, 10.0_gp_real)
    call parse_options("Glass beads flow out of a hopper, 0.25 m wide, with an outlet of 0.05 m. Reference length: the outlet.", &
                       options, height)
    spacing = outlet/options%resolution
    call create_beads(sim, options, spacing, grain_diameter=0.002_gp_real)
    call add_walls(sim, height%value + 6*spacing)
    call sim%add_plate(gp_plate(x0=1.0_gp_real, x1=-1.0_gp_real, y0=-0.3_gp_real, y1=-0.3_gp_real))
    call fill(sim, spacing, -width/2, width/2, 0.0_gp_real, height%value, is_inside)

    call run_example(sim, options, 10, look, r)
    print "(a)", "# time s, mass above the outlet kg/m"
    do k = 1, r%n, 5
        print "(f5.3, 1x, f8.4)", r%time(k), r%mass(k)
    end do
    call line("flow_rate", flow_rate(r, 0.2_gp_real), "kg/(m s), from 0.2 s on")
    call line("flow_rate_scaled", flow_rate(r, 0.2_gp_real)/(density*sqrt(9.81_gp_real)*outlet**1.5_gp_real), &
              "rho sqrt(g) D**1.5")
    call sim%destroy()
end program
