!> What the examples share: options, lifted gates, a run with frames, a summary.
module example
    use, intrinsic :: iso_fortran_env, only: error_unit
    use, intrinsic :: iso_c_binding, only: c_int64_t
    use granperi
    implicit none
    private
    public :: example_options, example_extra, parse_options, stop_with
    public :: create_beads, add_floor, add_gate, fill, run_example, line, material_left, material_right

    type :: example_options
        real(gp_real) :: resolution = 32 !! particles over the reference length
        real(gp_real) :: end = 1 !! s; negative: depends on the case
        real(gp_real) :: threads = 1 !! 0: the OpenMP default
        real(gp_real) :: lift_time = 0.1_gp_real !! s in which a gate clears the height of its column; 0: no gates;
                                                 !! negative: no option of this example
        real(gp_real) :: mu_s_degrees = 21 !! friction angle at rest
        real(gp_real) :: mu_2_degrees = 32 !! friction angle of fast flow
        character(:), allocatable :: output !! HDF5 file; "none": no file
    end type

    !> One option more, a number, for a single example.
    type :: example_extra
        character(:), allocatable :: name, help
        real(gp_real) :: value = 0, low = 0, high = 0
        logical :: whole = .false.
    end type

    type :: watch
        real(gp_real) :: due = 0 !! s: the run stops after the first step at or past it, which leaves the steps as long as they are
        integer :: every = 1 !! steps between looks
        procedure(gp_on_step), pointer, nopass :: look => null() !! of the example
        class(*), pointer :: context => null()
    end type

    integer, parameter :: material_left = 0, material_right = 1

contains

    ! ------------------------------------------------------------------------------------------- options

    !> Reads the command line. --help ends the program with status 0, a bad option with a message and status 2.
    subroutine parse_options(about, options, extra)
        character(*), intent(in) :: about
        type(example_options), intent(inout) :: options
        type(example_extra), intent(inout), optional :: extra
        integer :: k
        if (.not. gp_has_feature("hdf5")) options%output = "none"
        do k = 1, command_argument_count()
            if (argument(k) == "--help") call print_help(about, options, extra)
        end do
        do k = 1, command_argument_count(), 2
            if (present(extra)) then
                if (argument(k) == extra%name) then
                    call read_number(k, extra%low, extra%high, extra%whole, extra%value)
                    cycle
                end if
            end if
            select case (argument(k))
            case ("--resolution"); call read_number(k, 1.0_gp_real, 1e5_gp_real, .true., options%resolution)
            case ("--end"); call read_number(k, 1e-9_gp_real, 1e6_gp_real, .false., options%end)
            case ("--threads"); call read_number(k, 0.0_gp_real, 1024.0_gp_real, .true., options%threads)
            case ("--lift-time")
                if (options%lift_time < 0) call stop_with(2, argument(k)//": unknown option (see --help)")
                call read_number(k, 0.0_gp_real, 1e6_gp_real, .false., options%lift_time)
            case ("--mu-s-degrees"); call read_number(k, 0.0_gp_real, 89.0_gp_real, .false., options%mu_s_degrees)
            case ("--mu-2-degrees"); call read_number(k, 0.0_gp_real, 89.0_gp_real, .false., options%mu_2_degrees)
            case ("--output")
                if (k == command_argument_count()) call stop_with(2, "--output: expected a value after it (see --help)")
                options%output = argument(k + 1)
            case default
                call stop_with(2, argument(k)//": unknown option (see --help)")
            end select
        end do
        if (options%mu_2_degrees < options%mu_s_degrees) &
            call stop_with(2, "--mu-2-degrees: expected an angle not below that of --mu-s-degrees (see --help)")
    end subroutine

    function argument(k) result(text)
        integer, intent(in) :: k
        character(:), allocatable :: text
        integer :: length
        call get_command_argument(k, length=length)
        allocate (character(length) :: text)
        call get_command_argument(k, text)
    end function

    subroutine read_number(k, low, high, whole, value)
        integer, intent(in) :: k
        real(gp_real), intent(in) :: low, high
        logical, intent(in) :: whole
        real(gp_real), intent(inout) :: value
        integer :: problem
        character(:), allocatable :: text
        if (k == command_argument_count()) call stop_with(2, argument(k)//": expected a value after it (see --help)")
        text = argument(k + 1)
        read (text, *, iostat=problem) value
        if (problem == 0 .and. value >= low .and. value <= high .and. .not. (whole .and. value > aint(value))) return
        call stop_with(2, argument(k)//" "//text//": expected a "//trim(merge("whole number", "number      ", whole))// &
                       " from "//plain(low)//" to "//plain(high)//" (see --help)")
    end subroutine

    !> A number as one would write it.
    function plain(value) result(text)
        real(gp_real), intent(in) :: value
        character(:), allocatable :: text
        character(20) :: written
        if (abs(value - nint(value)) <= 0) then
            write (written, "(i0)") nint(value)
        else if (abs(value) < 0.001_gp_real) then
            write (written, "(es7.1)") value
        else
            write (written, "(f7.3)") value
        end if
        text = trim(adjustl(written))
    end function

    subroutine print_help(about, options, extra)
        character(*), intent(in) :: about
        type(example_options), intent(in) :: options
        type(example_extra), intent(in), optional :: extra
        character(300) :: program_name
        call get_command_argument(0, program_name)
        print "(a)", "usage: "//trim(program_name)//" [options]", "", about, "", "options [default]"
        if (present(extra)) print "(2x, a, t26, a, ' [', a, ']')", extra%name, extra%help, plain(extra%value)
        print "(2x, a, t26, a, ' [', i0, ']')", "--resolution N", "particles over the reference length", &
            nint(options%resolution)
        if (options%end < 0) then
            print "(2x, a, t26, a)", "--end SECONDS", "end of the run [depends on the case]"
        else
            print "(2x, a, t26, a, ' [', f0.2, ']')", "--end SECONDS", "end of the run", options%end
        end if
        print "(2x, a, t26, a, ' [', i0, ']')", "--threads N", "threads, 0 for the OpenMP default", nint(options%threads)
        print "(2x, a, t26, a, ' [', a, ']')", "--output FILE.h5", "frames every 0.01 s, ""none"" for no file", &
            options%output
        if (options%lift_time >= 0) print "(2x, a, t26, a, ' [', f4.2, ']')", "--lift-time SECONDS", &
            "a gate, lifted with uniform acceleration, clears the height of its column in this time; 0: no gates", &
            options%lift_time
        print "(2x, a, t26, a, ' [', i0, ']')", "--mu-s-degrees ANGLE", "friction angle at rest", nint(options%mu_s_degrees)
        print "(2x, a, t26, a, ' [', i0, ']')", "--mu-2-degrees ANGLE", "friction angle of fast flow", &
            nint(options%mu_2_degrees)
        print "(2x, a, t26, a)", "--help", "print this and end"
        stop
    end subroutine

    subroutine stop_with(code, text)
        integer, intent(in) :: code
        character(*), intent(in) :: text
        write (error_unit, "(a)") text
        stop code, quiet=.true.
    end subroutine

    ! --------------------------------------------------------------------------------------------- scene

    !> A simulation of this spacing whose material 1 is glass beads of this diameter (m) with the friction of the options.
    subroutine create_beads(sim, options, spacing, grain_diameter)
        type(gp_simulation), intent(inout) :: sim
        type(example_options), intent(in) :: options
        real(gp_real), intent(in) :: spacing, grain_diameter
        real(gp_real) :: degree
        degree = acos(-1.0_gp_real)/180
        call sim%create(gp_config(spacing=spacing, threads=nint(options%threads)))
        call sim%set_log(gp_log_to_stderr)
        call sim%add_material(gp_material(grain_diameter=grain_diameter, mu_s=tan(options%mu_s_degrees*degree), &
                                          mu_2=tan(options%mu_2_degrees*degree)))
    end subroutine

    !> A rough floor at y = 0. The body of a plate is on the left of the way from end 0 to end 1: a floor runs from right
    !> to left.
    subroutine add_floor(sim, x_left, x_right)
        type(gp_simulation), intent(inout) :: sim
        real(gp_real), intent(in) :: x_left, x_right
        call sim%add_plate(gp_plate(x0=x_right, x1=x_left))
    end subroutine

    !> A smooth gate at x, wetted on the given side, that is lifted off a column of this height until its lower end is well
    !> clear of it: displacement = height (t / lift_time)**2. Nothing if lift_time is 0.
    subroutine add_gate(sim, x, side, height, spacing, lift_time)
        type(gp_simulation), intent(inout) :: sim
        real(gp_real), intent(in) :: x, height, spacing, lift_time
        integer, intent(in) :: side
        integer, parameter :: knots = 41
        real(gp_real) :: t(knots), dx(knots), dy(knots), clear, t_clear, part, y0, y1
        integer :: k
        if (lift_time <= 0) return
        clear = height + 6*spacing
        t_clear = lift_time*sqrt(clear/height)
        do k = 1, knots
            part = real(k - 1, gp_real)/(knots - 1)
            t(k) = part*t_clear
            dx(k) = 0
            dy(k) = part*part*clear
        end do
        ! Upwards the body is on the left and the material on the right; downwards the other way round.
        y0 = merge(0.0_gp_real, clear, side == material_right)
        y1 = merge(clear, 0.0_gp_real, side == material_right)
        call sim%add_plate(gp_plate(x0=x, y0=y0, x1=x, y1=y1, friction=GP_WALL_FREE_SLIP), t, dx, dy)
    end subroutine

    !> Particles of material 1 at rest on the lattice of the spacing, within the box and where inside(x, y) is true.
    subroutine fill(sim, spacing, x_min, x_max, y_min, y_max, inside)
        type(gp_simulation), intent(inout) :: sim
        real(gp_real), intent(in) :: spacing, x_min, x_max, y_min, y_max
        interface
            logical function inside(x, y)
                import :: gp_real
                real(gp_real), intent(in) :: x, y
            end function
        end interface
        real(gp_real), allocatable :: x(:), y(:)
        integer :: columns, rows, i, j, n
        columns = nint((x_max - x_min)/spacing)
        rows = nint((y_max - y_min)/spacing)
        allocate (x(columns*rows + 1), y(columns*rows + 1))
        n = 0
        do j = 1, rows
            do i = 1, columns
                x(n + 1) = x_min + (i - 0.5_gp_real)*spacing
                y(n + 1) = y_min + (j - 0.5_gp_real)*spacing
                if (inside(x(n + 1), y(n + 1))) n = n + 1
            end do
        end do
        call sim%add_particles(x(1:n), y(1:n), material=1)
    end subroutine

    ! ----------------------------------------------------------------------------------------------- run

    !> Runs to options%end with a frame every 0.01 s and prints the summary: lines of "name value unit".
    !> With look, that is called after each `every`-th step.
    subroutine run_example(sim, options, every, look, context)
        type(gp_simulation), intent(inout) :: sim
        type(example_options), intent(in) :: options
        integer, intent(in), optional :: every
        procedure(gp_on_step), optional :: look
        class(*), intent(in), target, optional :: context
        real(gp_real), parameter :: interval = 0.01_gp_real ! s between frames, and between looks at the state
        real(gp_real) :: begin, end, rest_since
        type(watch), target :: w
        logical :: was_at_rest
        integer :: status
        type(gp_state) :: state
        call cpu_time(begin)
        if (options%output /= "none") call sim%output_open(options%output, gp_output(every_seconds=interval))
        rest_since = 0
        was_at_rest = .false.
        state = sim%state()
        if (present(look)) w%look => look
        if (present(every)) w%every = every
        if (present(context)) w%context => context
        call sim%set_callback(1, after_step, w)
        do while (state%time < options%end)
            w%due = interval*(floor((state%time + 1e-9_gp_real*state%dt)/interval) + 1)
            call sim%run(options%end, status)
            if (status < 0) error stop
            state = sim%state()
            if (state%at_rest == 1 .and. .not. was_at_rest) rest_since = state%time
            was_at_rest = state%at_rest == 1
        end do
        call sim%remove_callback()
        if (options%output /= "none") call sim%output_close()
        call cpu_time(end)
        call print_summary(state, rest_since, end - begin)
    end subroutine

    subroutine after_step(sim, context, stop_run)
        class(gp_simulation), intent(inout) :: sim
        class(*), pointer, intent(inout) :: context
        logical, intent(inout) :: stop_run
        real(gp_real) :: time, dt
        integer(c_int64_t) :: step
        logical :: ignored
        call sim%clock(time, dt, step)
        select type (context)
        type is (watch)
            if (associated(context%look) .and. mod(step, int(context%every, c_int64_t)) == 0) &
                call context%look(sim, context%context, ignored)
            stop_run = time + 1e-9_gp_real*dt >= context%due
        end select
    end subroutine

    subroutine print_summary(s, rest_since, cpu_seconds)
        type(gp_state), intent(in) :: s
        real(gp_real), intent(in) :: rest_since, cpu_seconds
        real(gp_real) :: energy
        energy = s%kinetic + s%potential + s%elastic + s%dissipated + s%plate_work + s%energy_error
        call line("time", s%time, "s")
        print "(a, t21, i0)", "particles", s%n_particles, "steps", s%step
        call line("peak_height", s%peak_height, "m")
        call line("peak_x", s%peak_x, "m")
        call line("x_left", s%x_left, "m")
        call line("x_right", s%x_right, "m")
        print "(a, t21, i0)", "at_rest", s%at_rest
        if (s%at_rest == 1) call line("at_rest_since", rest_since, "s")
        call line("energy_initial", energy, "J/m")
        call line("kinetic", s%kinetic, "J/m")
        call line("potential", s%potential, "J/m")
        call line("elastic", s%elastic, "J/m")
        call line("dissipated", s%dissipated, "J/m")
        call line("plate_work", s%plate_work, "J/m")
        call line("energy_error", s%energy_error, "J/m")
        if (energy > 0) call line("energy_error_share", 100*s%energy_error/energy, "% of energy_initial")
        call line("cpu_seconds", cpu_seconds, "s")
    end subroutine

    subroutine line(name, value, unit)
        character(*), intent(in) :: name, unit
        real(gp_real), intent(in) :: value
        print "(a, t21, g0.6, 1x, a)", name, value, unit
    end subroutine
end module
