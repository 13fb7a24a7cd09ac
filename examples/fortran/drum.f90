!> A drum turns and its filling flows: examples/c/drum.c in Fortran.
!>
!> The surface comes to a slope between the yield angle and that of fast flow; the moment that keeps the drum turning does the
!> work that the flow dissipates.
module drum_scene
    use granperi
    implicit none
    integer, parameter :: corners = 48
    real(gp_real), parameter :: radius = 0.1_gp_real, filling = 0.35_gp_real ! m; share of the drum
    real(gp_real), parameter :: pi = acos(-1.0_gp_real)
    real(gp_real) :: level = 0, inner = 0 ! m: the filling's surface at the start, and the radius that it stays within

    type :: record
        real(gp_real) :: omega = 1 !! rad/s
        real(gp_real) :: slope = 0 !! rad, sum of the looks from 1 rad on: by then the surface has come to its slope
        real(gp_real) :: angle = 0, work = 0, dissipated = 0 !! rad, J/m: by the first of them
        integer :: looks = 0
    end type

contains

    !> Clockwise, so that the body of the line is outside and the material inside.
    subroutine add_drum(sim, omega)
        type(gp_simulation), intent(inout) :: sim
        real(gp_real), intent(in) :: omega
        real(gp_real) :: angle(corners + 1)
        integer :: k
        angle = [(-2*pi*modulo(k, corners)/corners, k=0, corners)] ! the last is the first: closed
        ! About the pivot, which is the origin unless said otherwise.
        call sim%add_plate(gp_plate(omega=omega), point_x=radius*cos(angle), point_y=radius*sin(angle))
    end subroutine

    logical function is_inside(x, y)
        real(gp_real), intent(in) :: x, y
        is_inside = y < level .and. hypot(x, y) < inner
    end function

    !> The height below which a circle has this share of its area.
    function level_of(share) result(height)
        real(gp_real), intent(in) :: share
        real(gp_real) :: height, low, high, y
        low = -1
        high = 1
        do while (high - low > 1e-9_gp_real)
            y = (low + high)/2
            if ((asin(y) + y*sqrt(1 - y*y))/pi + 0.5_gp_real < share) then
                low = y
            else
                high = y
            end if
        end do
        height = low*radius
    end function

    !> Under a plane surface the centre of mass lies perpendicularly below the axis.
    subroutine look(sim, context, stop_run)
        class(gp_simulation), intent(inout) :: sim
        class(*), pointer, intent(inout) :: context
        logical, intent(inout) :: stop_run
        type(gp_state) :: state
        type(gp_load) :: load
        load = sim%plate_load(0)
        if (load%angle < 1) return
        state = sim%state()
        select type (r => context)
        type is (record)
            if (r%looks == 0) then
                r%angle = load%angle
                r%work = -r%omega*load%impulse_torque
                r%dissipated = state%dissipated
            end if
            r%looks = r%looks + 1
            r%slope = r%slope + atan2(state%centre_x, -state%centre_y)
        class default
            stop_run = .true.
        end select
    end subroutine
end module

program drum
    use granperi
    use example
    use drum_scene
    implicit none
    type(example_options) :: options
    type(example_extra) :: omega
    type(gp_simulation) :: sim
    type(gp_state) :: state
    type(gp_load) :: load
    type(record), target :: r
    real(gp_real) :: spacing, work

    options%output = "drum.h5"
    options%resolution = 40
    options%end = 4
    options%lift_time = -1
    omega = example_extra("--omega", "of turning, rad/s", 1.0_gp_real, 0.01_gp_real, 5.0_gp_real)
    call parse_options("Glass beads in a drum that turns, 0.2 m wide. Reference length: its radius.", options, omega)
    r%omega = omega%value
    spacing = radius/options%resolution
    call create_beads(sim, options, spacing, grain_diameter=0.002_gp_real)
    call add_drum(sim, r%omega)
    level = level_of(filling)
    inner = radius*cos(pi/corners) - spacing/2
    call fill(sim, spacing, -radius, radius, -radius, radius, is_inside)

    call run_example(sim, options, 100, look, r)
    state = sim%state()
    load = sim%plate_load(0)
    call line("turned", load%angle, "rad")
    if (r%looks > 1) then
        work = -r%omega*load%impulse_torque - r%work
        call line("surface_slope", r%slope/r%looks*180/pi, "degrees, mean from 1 rad on")
        call line("moment", work/(load%angle - r%angle), "N, that keeps it turning")
        call line("work_per_dissipated", work/(state%dissipated - r%dissipated), "from 1 rad on")
    end if
    call sim%destroy()
end program
