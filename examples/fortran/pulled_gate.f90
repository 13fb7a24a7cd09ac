!> A gate that a falling weight pulls up over a pulley, as in the experiments with collapsing columns: how fast it opens is
!> not prescribed but follows from the weight, and from what the column does to the gate.
!>
!> The host owns the gate. After each step it reads the material's load on it (plate_load), integrates
!>     (m_gate + m_weight) dv/dt = (m_weight - m_gate) g + f_y - guide friction |f_x|
!> and hands the new velocity to the library (set_plate_velocity): f_y is the friction of the grains on the gate, f_x their
!> thrust, which the guides of the gate bear. When the gate is clear of the column it is caught.
module falling_weight
    use granperi
    implicit none

    type :: pulley
        integer :: gate = 0 !! id of the plate
        real(gp_real) :: gate_mass = 1, weight_mass = 4 !! kg/m
        real(gp_real) :: guide_friction = 0.1_gp_real !! Coulomb coefficient of gate on guides
        real(gp_real) :: gravity = 9.81_gp_real !! m/s2
        real(gp_real) :: clear = 0 !! m, where the gate is caught
        real(gp_real) :: lifted = 0, velocity = 0, acceleration = 0 !! m, m/s, m/s2
        real(gp_real) :: tension = 0 !! N/m, of the rope
        real(gp_real) :: fx = 0, fy = 0 !! N/m, of the material on the gate
        real(gp_real) :: pull_impulse = 0, guide_impulse = 0 !! N s/m
        logical :: caught = .false.
    end type

contains

    !> Takes one step of the grains, then one of the same length of gate and weight.
    subroutine advance(sim, p)
        type(gp_simulation), intent(inout) :: sim
        type(pulley), intent(inout) :: p
        type(gp_load) :: load
        type(gp_state) :: state
        real(gp_real) :: pull, friction, mass
        call sim%step(1)
        state = sim%state()
        load = sim%plate_load(p%gate)
        p%lifted = load%dy
        p%fx = load%fx
        p%fy = load%fy
        if (p%caught) return
        mass = p%gate_mass + p%weight_mass
        pull = (p%weight_mass - p%gate_mass)*p%gravity
        ! The guides' friction stops the gate, but does not turn it round; nor does the gate go down: it stands on the floor.
        friction = min(p%guide_friction*abs(p%fx), max(0.0_gp_real, mass*p%velocity/state%dt + pull + p%fy))
        p%acceleration = (pull + p%fy - friction)/mass
        if (p%velocity + p%acceleration*state%dt < 0) p%acceleration = -p%velocity/state%dt
        p%velocity = p%velocity + p%acceleration*state%dt
        p%tension = p%weight_mass*(p%gravity - p%acceleration)
        p%pull_impulse = p%pull_impulse + pull*state%dt
        p%guide_impulse = p%guide_impulse + friction*state%dt
        if (p%lifted >= p%clear) then
            p%caught = .true.
            p%velocity = 0
            p%acceleration = 0
            p%tension = p%weight_mass*p%gravity
        end if
        call sim%set_plate_velocity(p%gate, 0.0_gp_real, p%velocity)
    end subroutine
end module

program pulled_gate
    use granperi
    use falling_weight
    use example, only: example_options, example_extra, parse_options, create_beads, add_floor
    implicit none
    real(gp_real), parameter :: width = 0.08_gp_real, height = 0.08_gp_real ! m
    type(example_options) :: options
    type(example_extra) :: wall_friction
    type(gp_simulation) :: sim
    type(gp_state) :: state
    type(gp_load) :: load
    type(pulley) :: p
    real(gp_real) :: spacing, top, next, opened, error, worst_friction, largest_thrust

    options%output = "none"
    options%end = 0.5_gp_real
    options%lift_time = -1
    wall_friction = example_extra("--wall-mu", "Coulomb coefficient of grains on the gate", 0.3_gp_real, 0.0_gp_real, &
                                  5.0_gp_real)
    call parse_options("A weight of 4 kg pulls a gate of 1 kg (both per metre of depth) up from a column, 0.08 m wide and "// &
                       "0.08 m high. Reference length: 0.08 m.", options, wall_friction)
    spacing = width/options%resolution
    call create_beads(sim, options, spacing, grain_diameter=0.002_gp_real)
    call sim%add_column(gp_column(width=width, height=height, material=1))
    call add_floor(sim, 0.0_gp_real, width + 4*height + 20*spacing)
    top = height + 6*spacing
    call sim%add_plate(gp_plate(y1=top, friction=GP_WALL_FREE_SLIP))
    call sim%add_plate(gp_plate(x0=width, y0=top, x1=width, friction=GP_WALL_COULOMB, wall_mu=wall_friction%value), id=p%gate)
    p%clear = top
    if (options%output /= "none") call sim%output_open(options%output, gp_output(every_seconds=0.01_gp_real))

    print "(a)", "# time s, gate lifted m, its velocity m/s, acceleration m/s2, friction of the grains N/m, their thrust N/m,"// &
        " tension of the rope N/m, front m"
    next = 0
    opened = -1
    error = 0
    worst_friction = 0
    largest_thrust = 0
    do
        call advance(sim, p)
        state = sim%state()
        worst_friction = max(worst_friction, abs(p%fy) - wall_friction%value*abs(p%fx))
        largest_thrust = max(largest_thrust, p%fx)
        if (.not. p%caught) then
            ! What gate and weight have is what gravity, grains and guides gave.
            load = sim%plate_load(p%gate)
            error = max(error, abs((p%gate_mass + p%weight_mass)*p%velocity &
                                   - (p%pull_impulse + load%impulse_y - p%guide_impulse)))
        else if (opened < 0) then
            opened = state%time
        end if
        if (state%time >= next .or. (p%caught .and. opened >= state%time)) then
            print "(f7.4, 7(1x, f10.5))", state%time, p%lifted, p%velocity, p%acceleration, p%fy, p%fx, p%tension, &
                state%x_right
            next = next + merge(0.005_gp_real, 0.05_gp_real, .not. p%caught)
        end if
        if (state%time >= options%end) exit
    end do
    if (opened < 0) then
        print "(a)", "gate_clear_at       never: the run ended before"
    else
        print "(a, t21, g0.6, a)", "gate_clear_at", opened, " s"
    end if
    print "(a, t21, g0.6, a)", "without_grains", sqrt(2*p%clear*(p%gate_mass + p%weight_mass) &
                                                       /((p%weight_mass - p%gate_mass)*p%gravity)), " s"
    print "(a, t21, g0.6, a)", "largest_thrust", largest_thrust, " N/m"
    print "(a, t21, g0.6, a)", "momentum_error", error, " N s/m"
    print "(a, t21, g0.6, a)", "friction_excess", worst_friction, " N/m over wall_mu times the thrust of its step"
    print "(a, t21, g0.6, a)", "x_right", state%x_right, " m"
    if (options%output /= "none") call sim%output_close()
    call sim%destroy()
end program
