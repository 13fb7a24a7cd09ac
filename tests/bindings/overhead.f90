!> What the module costs over the C interface, by CPU time: the least of several rounds in which calls through the type and
!> direct ones alternate, in a scene without particles, where a step is cheapest.
!>   step   gp_step of one step
!>   host   what a host does that drives a plate: a step, the state, the plate's load, its velocity
!> Prints the difference in nanoseconds. Fails if anything takes more than twice what it takes without the module.
!> The procedures are those of a module: internal ones, handed over, ask for a stack that may be executed.
module overhead_work
    use, intrinsic :: iso_c_binding
    use granperi
    use granperi_raw, only: gp_create, gp_add_plate, gp_step, gp_get_state, gp_get_plate_load, gp_set_plate_velocity, &
                            gp_destroy
    implicit none
    integer, parameter :: steps = 20000, rounds = 15
    type(gp_simulation) :: sim
    type(gp_state) :: state
    type(gp_load) :: load
    type(c_ptr) :: handle
    integer :: failures

contains

    subroutine compare(name, directly, through)
        character(*), intent(in) :: name
        interface
            subroutine directly()
            end subroutine
            subroutine through()
            end subroutine
        end interface
        real(gp_real) :: without, with
        integer :: round
        without = huge(without)
        with = huge(with)
        do round = 1, rounds
            without = min(without, seconds_of(directly))
            with = min(with, seconds_of(through))
        end do
        print "(2a, f6.1, a, f6.1, a, f6.1, a)", name, ": C ", 1e9*without/steps, " ns, Fortran ", 1e9*with/steps, &
            " ns, overhead ", 1e9*(with - without)/steps, " ns"
        if (with > 2*without) failures = failures + 1
    end subroutine

    function seconds_of(work) result(seconds)
        interface
            subroutine work()
            end subroutine
        end interface
        real(gp_real) :: seconds, begin
        call cpu_time(begin)
        call work()
        call cpu_time(seconds)
        seconds = seconds - begin
    end function

    subroutine step_directly()
        integer :: k
        do k = 1, steps
            if (gp_step(handle, 1_c_int64_t) < 0) error stop "gp_step"
        end do
    end subroutine

    subroutine step_through()
        integer :: k
        do k = 1, steps
            call sim%step(1)
        end do
    end subroutine

    subroutine host_directly()
        integer :: k
        state%struct_size = int(c_sizeof(state), c_int32_t)
        load%struct_size = int(c_sizeof(load), c_int32_t)
        do k = 1, steps
            if (gp_step(handle, 1_c_int64_t) < 0) error stop "gp_step"
            if (gp_get_state(handle, state) < 0) error stop "gp_get_state"
            if (gp_get_plate_load(handle, 0, load) < 0) error stop "gp_get_plate_load"
            if (gp_set_plate_velocity(handle, 0, load%fx + state%momentum_x, 0.0_gp_real) < 0) error stop "gp_set_..."
        end do
    end subroutine

    subroutine host_through()
        integer :: k
        do k = 1, steps
            call sim%step(1)
            state = sim%state()
            load = sim%plate_load(0)
            call sim%set_plate_velocity(0, load%fx + state%momentum_x, 0.0_gp_real)
        end do
    end subroutine
end module

program overhead
    use overhead_work
    implicit none
    integer :: status
    integer(c_int32_t) :: id

    status = gp_create(gp_config(threads=1, sound_speed=10.0_gp_real), handle)
    status = gp_add_plate(handle, gp_plate(x0=1.0_gp_real), id)
    call sim%create(gp_config(threads=1, sound_speed=10.0_gp_real))
    call sim%add_plate(gp_plate(x0=1.0_gp_real))
    failures = 0
    call compare("step", step_directly, step_through)
    call compare("host", host_directly, host_through)
    state = sim%state()
    if (state%step /= 2_c_int64_t*steps*rounds) error stop "the steps were not taken"
    call gp_destroy(handle)
    if (failures > 0) error stop "the module costs more than the library"
end program
