!> What the module costs per call over the C interface: gp_step of one step, of a scene without particles (where a step is
!> cheapest), called directly and through the type. CPU time, the least of several rounds that alternate.
!>
!> Prints the difference in nanoseconds per step. Fails if a step through the module takes more than twice what the same step
!> takes without it.
program overhead
    use, intrinsic :: iso_c_binding
    use granperi
    use granperi_raw, only: gp_create, gp_step, gp_destroy
    implicit none
    integer, parameter :: steps = 200000, rounds = 15
    type(gp_simulation) :: sim
    type(gp_state) :: state
    type(c_ptr) :: handle
    real(gp_real) :: direct, through, begin, end
    integer :: k, round, status

    status = gp_create(gp_config(threads=1, sound_speed=10.0_gp_real), handle)
    call sim%create(gp_config(threads=1, sound_speed=10.0_gp_real))
    direct = huge(direct)
    through = huge(through)
    do round = 1, rounds
        call cpu_time(begin)
        do k = 1, steps
            status = gp_step(handle, 1_c_int64_t)
            if (status < 0) error stop "gp_step"
        end do
        call cpu_time(end)
        direct = min(direct, end - begin)
        call cpu_time(begin)
        do k = 1, steps
            call sim%step(1, status)
            if (status < 0) error stop "step"
        end do
        call cpu_time(end)
        through = min(through, end - begin)
    end do
    state = sim%state()
    if (state%step /= int(steps, c_int64_t)*rounds) error stop "the steps were not taken"
    print "(a, f0.1, a, f0.1, a, f0.1, a)", "per step: C ", 1e9*direct/steps, " ns, Fortran ", 1e9*through/steps, &
        " ns, overhead ", 1e9*(through - direct)/steps, " ns"
    call gp_destroy(handle)
    if (through > 2*direct) error stop "the module costs more than the step"
end program
