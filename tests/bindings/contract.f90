!> The contract of the Fortran module. Without an argument: every check; with one: a program that uses it wrongly.
module checks
    use, intrinsic :: iso_c_binding
    use, intrinsic :: ieee_arithmetic, only: ieee_is_nan, ieee_value, ieee_quiet_nan
    use granperi
    implicit none
    integer :: failures = 0

    type :: seen !! a callback's own data
        integer :: calls = 0
        real(gp_real) :: time = 0
        integer :: refused = 0
        logical :: current = .true.
    end type

    type(gp_simulation), pointer :: the_host_s => null() !! of_the_host knows it by itself
    integer :: inside = 0

    type :: heard !! of a log
        integer :: texts = 0
        character(:), allocatable :: last
    end type

contains

    subroutine expect(condition, what)
        logical, intent(in) :: condition
        character(*), intent(in) :: what
        if (condition) return
        print "(2a)", "FAILED: ", what
        failures = failures + 1
    end subroutine

    !> The status, and that the message has this part.
    subroutine expect_error(status, wanted, message, part)
        integer, intent(in) :: status, wanted
        character(*), intent(in) :: message, part
        call expect(status == wanted .and. index(message, part) > 0, "expected '"//part//"': "//trim(message))
    end subroutine

    !> A column of 8 x 6 particles on a floor.
    subroutine make_scene(sim)
        type(gp_simulation), intent(inout) :: sim
        call sim%create(gp_config(spacing=0.01_gp_real, sound_speed=10.0_gp_real, threads=1))
        call sim%add_column(gp_column(width=0.08_gp_real, height=0.06_gp_real))
        call sim%add_plate(gp_plate(x0=0.5_gp_real, x1=-0.5_gp_real))
    end subroutine

    subroutine check_structs()
        use granperi_raw, only: c_config_init => gp_config_init, c_plate_init => gp_plate_init
        type(gp_config) :: config, default_config
        type(gp_plate) :: plate, default_plate
        integer :: status
        character(300) :: message
        status = c_config_init(default_config, c_sizeof(default_config), GP_PRESET_PAPER)
        config = gp_config(preset=GP_PRESET_PAPER)
        call expect(same_bytes(config, default_config), "gp_config(preset) has the library's defaults")
        config = gp_config(preset=GP_PRESET_PAPER, spacing=0.5_gp_real, seed=3_c_int64_t)
        default_config%spacing = 0.5_gp_real
        default_config%seed = 3
        call expect(same_bytes(config, default_config), "gp_config takes keywords")
        status = c_plate_init(default_plate, c_sizeof(default_plate))
        plate = gp_plate()
        call expect(plate%struct_size == default_plate%struct_size .and. plate%n_knots == 0 .and. &
                    .not. c_associated(plate%knot_t), "gp_plate() has the library's defaults")
        config = gp_config(preset=99, status=status, message=message)
        call expect_error(status, GP_E_ARGUMENT, message, "gp_config: ")
    end subroutine

    function same_bytes(a, b) result(same)
        type(gp_config), intent(in) :: a, b
        logical :: same
        integer(c_int8_t), parameter :: mold(1) = [0_c_int8_t]
        ! Padding is the compiler's: struct_size is followed by 4 bytes, threads and preset likewise.
        same = a%struct_size == b%struct_size .and. abs(a%spacing - b%spacing) <= 0 .and. a%seed == b%seed .and. &
               a%stress == b%stress .and. a%density == b%density .and. a%preset == b%preset .and. &
               all(transfer([a%gravity_x, a%gravity_y, a%cfl, a%horizon, a%friction_factor, a%delta, a%jitter, &
                             a%collision_distance, a%zero_energy_penalty, a%bulk_viscosity], mold) == &
                   transfer([b%gravity_x, b%gravity_y, b%cfl, b%horizon, b%friction_factor, b%delta, b%jitter, &
                             b%collision_distance, b%zero_energy_penalty, b%bulk_viscosity], mold))
    end function

    subroutine check_errors()
        type(gp_simulation) :: sim
        type(gp_column) :: unfilled
        type(gp_state) :: state
        real(gp_real), allocatable :: values(:)
        real(gp_real) :: short(7)
        integer :: status, id
        character(300) :: message
        call sim%step(1, status, message)
        call expect_error(status, GP_E_STATE, message, "step: the simulation was never created")
        call make_scene(sim)
        call sim%step(1, status, message)
        call expect(status == GP_OK .and. message == "", "a good call has GP_OK and no message")
        call sim%run(-1.0_gp_real, status)
        call expect(status == GP_E_ARGUMENT, "status alone is enough")
        call sim%run(-1.0_gp_real, message=message)
        call expect(index(message, "run: ") == 1 .and. index(message, "t_end") > 0, "message alone is enough: "//trim(message))
        call sim%add_column(unfilled, id, status, message)
        call expect_error(status, GP_E_ARGUMENT, message, "this gp_column was never filled")
        call sim%create(gp_config(spacing=0.01_gp_real, sound_speed=10.0_gp_real, threads=1))
        call sim%add_particles([0.0_gp_real, 1.0_gp_real], [0.0_gp_real], status=status, message=message)
        call expect_error(status, GP_E_ARGUMENT, message, "x, y have the sizes 2, 1")
        call sim%add_particles([0.0_gp_real], [0.0_gp_real], [1.0_gp_real], status=status, message=message)
        call expect_error(status, GP_E_ARGUMENT, message, "vx and vy come together")
        call sim%add_particles([0.0_gp_real], [0.0_gp_real], [1.0_gp_real], [1.0_gp_real, 1.0_gp_real], status=status, &
                               message=message)
        call expect_error(status, GP_E_ARGUMENT, message, "x, vx, vy have the sizes 1, 1, 2")
        call sim%add_plate(gp_plate(x0=1.0_gp_real), [0.0_gp_real, 1.0_gp_real], status=status, message=message)
        call expect_error(status, GP_E_ARGUMENT, message, "knot_t comes with knot_x and knot_y, with knot_angle")
        call sim%add_plate(gp_plate(x0=1.0_gp_real), [0.0_gp_real, 1.0_gp_real], [0.0_gp_real], [0.0_gp_real], &
                           status=status, message=message)
        call expect_error(status, GP_E_ARGUMENT, message, "have the sizes 2, 1, 1")
        call sim%add_plate(gp_plate(x0=1.0_gp_real), knot_angle=short, status=status, message=message)
        call expect_error(status, GP_E_ARGUMENT, message, "none of these without it")
        call sim%add_plate(gp_plate(x0=1.0_gp_real), [0.0_gp_real], knot_angle=short, status=status, message=message)
        call expect_error(status, GP_E_ARGUMENT, message, "knot_t, knot_angle have the sizes 1, 7")
        call sim%add_plate(gp_plate(), point_x=short, status=status, message=message)
        call expect_error(status, GP_E_ARGUMENT, message, "point_x and point_y come together")
        call sim%add_plate(gp_plate(), point_x=short, point_y=[1.0_gp_real], status=status, message=message)
        call expect_error(status, GP_E_ARGUMENT, message, "point_x, point_y have the sizes 7, 1")
        call sim%add_plate(gp_plate(), point_x=short(1:0), point_y=short(1:0), status=status, message=message)
        call expect_error(status, GP_E_ARGUMENT, message, "expected 2 or more points")
        call sim%add_plate(gp_plate(), point_x=[0.0_gp_real, 1.0_gp_real], point_y=[0.0_gp_real, ieee_value(1.0_gp_real, &
                           ieee_quiet_nan)], status=status, message=message)
        call expect_error(status, GP_E_ARGUMENT, message, "gp_plate.point_y[1]")
        call sim%set_plate_motion(0, 0.0_gp_real, 0.0_gp_real, 1.0_gp_real, status, message)
        call expect_error(status, GP_E_ARGUMENT, message, "plate = 0")
        call sim%add_column(gp_column(width=0.04_gp_real, height=0.02_gp_real), id)
        call sim%copy_field(GP_FIELD_X, short, status, message)
        call expect_error(status, GP_E_ARGUMENT, message, "values has the size 7: expected 8")
        values = sim%copy(GP_FIELD_POSITION, status, message)
        call expect(status == GP_E_ARGUMENT .and. size(values) == 0, "two fields are no field: "//trim(message))
        call sim%destroy()
        call sim%destroy()
        call expect(.not. sim%is_created(), "destroyed")
        state = sim%state(status, message)
        call expect_error(status, GP_E_STATE, message, "state: the simulation was never created, or has been destroyed")
        call sim%clock(status=status, message=message)
        call expect_error(status, GP_E_STATE, message, "clock: the simulation was never created, or has been destroyed")
        values = sim%copy(GP_FIELD_X, status, message)
        call expect(status == GP_E_STATE .and. size(values) == 0, "no copy after destroy")
        call expect(size(sim%plan(status, message)) == 0 .and. status == GP_E_STATE, "no plan after destroy")
        call expect(gp_status_string(GP_E_STATE) /= gp_status_string(GP_OK), "text of a status")
    end subroutine

    subroutine check_fluidity()
        type(gp_simulation) :: sim
        type(gp_material) :: beads
        integer :: id, status
        character(300) :: message
        beads = gp_material(grain_diameter=0.02_gp_real, nonlocal_amplitude=0.48_gp_real)
        call expect(abs(beads%fluidity_time - 1e-4_gp_real) <= 0, "gp_material() has the library's fluidity_time")
        call sim%create(gp_config(spacing=0.01_gp_real, sound_speed=10.0_gp_real, threads=1))
        call sim%add_material(gp_material(nonlocal_amplitude=11.0_gp_real), id, status, message)
        call expect_error(status, GP_E_ARGUMENT, message, "gp_material.nonlocal_amplitude = 11")
        call sim%add_plate(gp_plate(x0=1.0_gp_real, fluidity=2), status=status, message=message)
        call expect_error(status, GP_E_ARGUMENT, message, "gp_plate.fluidity = 2")
        call sim%add_material(beads, id)
        call sim%add_column(gp_column(width=0.08_gp_real, height=0.06_gp_real, material=id))
        call sim%add_plate(gp_plate(x0=0.5_gp_real, x1=-0.5_gp_real, fluidity=GP_FLUIDITY_ZERO))
        call sim%step(200)
        call expect(maxval(sim%copy(GP_FIELD_FLUIDITY)) > 0, "what slumps has a fluidity")
    end subroutine

    subroutine check_reading()
        type(gp_simulation) :: sim
        type(gp_particles) :: view
        type(gp_state) :: state
        type(gp_load) :: load
        type(gp_plan_entry), allocatable :: plan(:)
        real(gp_real), allocatable :: x(:), height(:)
        real(gp_real) :: into(48), time, dt
        integer(c_int64_t) :: step
        integer :: k, left, right, status
        call make_scene(sim)
        call sim%step(2_c_int64_t)
        view = sim%particles(GP_FIELD_ID + GP_FIELD_POSITION)
        call expect(view%count == 48 .and. size(view%x) == 48 .and. size(view%id) == 48, "a view has the shape (n)")
        call expect(.not. associated(view%vx) .and. .not. associated(view%pressure), "what was not asked for is not there")
        call expect(sim%is_current(view), "a view is current")
        x = sim%copy(GP_FIELD_X)
        call sim%copy_field(GP_FIELD_X, into)
        call expect(all([(abs(x(view%id(k) + 1) - view%x(k)) <= 0, k=1, 48)]), "a copy is in the order of id")
        call expect(all(abs(x - into) <= 0), "both copies are the same")
        call sim%step(1)
        call expect(.not. sim%is_current(view), "a step ends a view")
        view = sim%particles()
        call expect(associated(view%number_density) .and. associated(view%fluidity), "all fields, where none is named")
        call expect(all(abs(view%fluidity) <= 0), "no fluidity where no material has an amplitude")
        call check_fluidity()
        state = sim%state()
        call expect(state%step == 3 .and. state%n_particles == 48, "the state is read")
        call sim%clock(time, dt, step)
        call expect(step == state%step .and. abs(time - state%time) <= 0 .and. abs(dt - state%dt) <= 0, "the clock is read")
        call sim%clock(step=step, status=status)
        call expect(step == 3 .and. status == GP_OK, "a part of the clock is read")
        height = sim%surface([0.04_gp_real, 9.0_gp_real])
        call expect(height(1) > 0.04_gp_real .and. height(1) < 0.08_gp_real .and. abs(height(2)) <= 0, "the surface is read")
        load = sim%plate_load(0)
        call expect(load%fy < 0, "the material presses on the floor")
        plan = sim%plan()
        call expect(any([(plan(k)%active .and. plan(k)%calls == 3 .and. .not. plan(k)%is_field, k=1, size(plan))]), &
                    "stages ran three times")
        call expect(all([(len(plan(k)%name) > 0 .and. len(plan(k)%reason) > 0, k=1, size(plan))]), "the plan has texts")
        call expect(any([(plan(k)%is_field .and. plan(k)%bytes > 0, k=1, size(plan))]), "the plan has fields")
        call sim%create(gp_config(spacing=0.01_gp_real, sound_speed=10.0_gp_real, threads=1))
        call sim%add_column(gp_column(width=0.04_gp_real, height=0.06_gp_real), left)
        call sim%add_column(gp_column(x_min=0.04_gp_real, width=0.04_gp_real, height=0.06_gp_real), right)
        x = sim%interface_between(left, right, [0.03_gp_real, 9.0_gp_real])
        call expect(left == 0 .and. right == 1 .and. abs(x(1) - 0.04_gp_real) < 0.006_gp_real .and. ieee_is_nan(x(2)), &
                    "the interface is where the columns touch, NaN elsewhere")
        call expect(index(gp_version_string(), ".") > 0, "the version is text")
        call expect(.not. gp_has_feature("wings"), "no such feature")
    end subroutine

    !> A square without material, turned by omega, by a table and by the host: about its pivot, which is a corner.
    subroutine check_turns()
        type(gp_simulation) :: sim
        type(gp_load) :: load
        real(gp_real), parameter :: x(5) = [0.0_gp_real, 0.0_gp_real, 1.0_gp_real, 1.0_gp_real, 0.0_gp_real]
        real(gp_real), parameter :: y(5) = [0.0_gp_real, 1.0_gp_real, 1.0_gp_real, 0.0_gp_real, 0.0_gp_real]
        real(gp_real) :: strided(2, 5)
        integer :: by_omega, by_table, by_host, k
        strided(1, :) = x
        strided(2, :) = y
        call sim%create(gp_config(spacing=0.01_gp_real, sound_speed=10.0_gp_real, threads=1))
        call sim%add_plate(gp_plate(omega=2.0_gp_real), point_x=x, point_y=y, id=by_omega)
        call sim%add_plate(gp_plate(pivot_x=3.0_gp_real, surface_velocity=1.0_gp_real), [0.0_gp_real, 1.0_gp_real], &
                           knot_angle=[0.0_gp_real, 2.0_gp_real], point_x=strided(1, :) + 3, point_y=strided(2, :), id=by_table)
        call sim%add_plate(gp_plate(pivot_x=6.0_gp_real), point_x=x + 6, point_y=y, id=by_host)
        call sim%set_plate_motion(by_host, 0.5_gp_real, 0.0_gp_real, 2.0_gp_real)
        call sim%run(0.5_gp_real)
        do k = by_omega, by_host
            load = sim%plate_load(k)
            call expect(abs(load%angle - 1) < 1e-12_gp_real, "a plate has turned")
            call expect(abs(load%dx - merge(0.25_gp_real, 0.0_gp_real, k == by_host)) < 1e-12_gp_real, "its pivot has moved")
            call expect(abs(load%torque_pivot) <= 0 .and. abs(load%impulse_torque) <= 0, "nothing resists it")
        end do
    end subroutine

    subroutine look(sim, context, stop_run)
        class(gp_simulation), intent(inout) :: sim
        class(*), pointer, intent(inout) :: context
        logical, intent(inout) :: stop_run
        type(gp_state) :: state
        integer :: status
        character(300) :: message
        state = sim%state()
        select type (context)
        type is (seen)
            context%calls = context%calls + 1
            context%time = state%time
            call sim%step(1, status, message)
            if (status == GP_E_STATE) context%refused = context%refused + 1
            call sim%destroy(status, message)
            if (status == GP_E_STATE .and. index(message, "not from inside") > 0) context%refused = context%refused + 1
            stop_run = context%calls == 3
        class default
            call expect(.false., "the context is the host's")
        end select
    end subroutine

    subroutine look_without(sim, context, stop_run)
        class(gp_simulation), intent(inout) :: sim
        class(*), pointer, intent(inout) :: context
        logical, intent(inout) :: stop_run
        stop_run = .not. associated(context)
    end subroutine

    subroutine listen(level, text, context)
        integer(c_int32_t), intent(in) :: level
        character(*), intent(in) :: text
        class(*), pointer, intent(inout) :: context
        select type (context)
        type is (heard)
            context%texts = context%texts + 1
            context%last = text
        end select
        call expect(level == GP_LOG_INFO .or. level == GP_LOG_WARNING, "a level")
    end subroutine

    subroutine check_callbacks()
        type(gp_simulation), target :: sim
        type(seen), target :: what
        type(heard), target :: words
        type(gp_state) :: state
        integer :: status
        character(300) :: message
        call make_scene(sim)
        call sim%set_callback(0, look, what, status, message)
        call expect_error(status, GP_E_ARGUMENT, message, "every")
        call sim%set_callback(2, look, what)
        call sim%step(100, status, message)
        call expect(status == GP_STOPPED .and. message == "", "the callback stops the run")
        state = sim%state()
        call expect(what%calls == 3 .and. state%step == 6 .and. abs(what%time - state%time) <= 0, "after every second step")
        call expect(what%refused == 6, "neither step nor destroy from inside")
        call sim%set_callback(1, look_without)
        call sim%step(5, status)
        call expect(status == GP_STOPPED, "a callback without a context")
        call sim%remove_callback()
        call sim%step(3, status)
        call expect(status == GP_OK, "a callback is removed")
        the_host_s => sim
        inside = 0
        call sim%set_callback(1, of_the_host)
        call sim%step(2)
        call expect(inside == 2, "each callback")

        call sim%create(gp_config(spacing=0.01_gp_real, sound_speed=10.0_gp_real, threads=1))
        call sim%set_log(listen, words)
        call sim%add_column(gp_column(width=0.084_gp_real, height=0.06_gp_real))
        call expect(words%texts == 1 .and. index(words%last, "rounded") > 0, "the log says that a width was rounded: "//words%last)
        call sim%remove_log()
        call sim%add_column(gp_column(y_min=0.2_gp_real, width=0.084_gp_real, height=0.06_gp_real))
        call expect(words%texts == 1, "a log is removed")
    end subroutine

    !> Not inside check_callbacks: an internal procedure as a callback asks for a stack that may be executed.
    subroutine of_the_host(simulation, context, stop_run)
        class(gp_simulation), intent(inout) :: simulation
        class(*), pointer, intent(inout) :: context
        logical, intent(inout) :: stop_run
        integer :: answer
        inside = inside + 1
        call the_host_s%destroy(answer) ! the host's own variable instead of the one that is handed over
        call expect(answer == GP_E_STATE, "the host's variable is refused, too")
    end subroutine

    subroutine check_files()
        type(gp_simulation) :: sim, other
        type(gp_state) :: state
        integer :: status, there
        character(300) :: message
        logical :: exists
        call make_scene(sim)
        call sim%output_open("contract_fortran.h5  ", gp_output(every_seconds=0.001_gp_real, compression=0), status, message)
        if (gp_has_feature("hdf5")) then
            call expect(status == GP_OK, "output_open: "//trim(message))
            call sim%step(1)
            call sim%output_write()
            call sim%output_close()
            inquire (file="contract_fortran.h5", exist=exists)
            call expect(exists, "trailing blanks are no part of a path")
        else
            call expect(status == GP_E_UNSUPPORTED, "output_open without HDF5")
        end if
        call sim%output_close(status, message)
        call expect_error(status, GP_E_STATE, message, "output_close: ")
        state = sim%state()
        there = int(state%step)
        state = sim%state(parts=GP_STATE_MARKS)
        call expect(state%step == there .and. state%x_q50 > 0 .and. ieee_is_nan(state%x_left), "a part of the state")
        state = sim%state(status, message, 8)
        call expect_error(status, GP_E_ARGUMENT, message, "parts = 0x8")

        ! As the library answers: with a checkpoint both work, without one both are unsupported and lose nothing.
        call sim%save("contract_fortran.gp", status, message)
        if (status == GP_OK) then
            call other%load("contract_fortran.gp")
            state = other%state()
            call expect(state%step == there, "what was saved is loaded")
        else
            call expect_error(status, GP_E_UNSUPPORTED, message, "save: ")
        end if
        call sim%load("there is no such file", status, message)
        call expect(status < 0 .and. index(message, "load: ") == 1, "load of what is not there: "//trim(message))
        state = sim%state()
        call expect(state%step == there, "a failed load leaves the simulation as it was")
    end subroutine

    !> Many simulations that come and go: the final procedure frees them (under valgrind or a sanitizer: all of them).
    subroutine check_life()
        type(gp_simulation), allocatable :: sims(:)
        integer :: k
        allocate (sims(3))
        do k = 1, 3
            call make_scene(sims(k))
            call sims(k)%step(k)
        end do
        call sims(2)%create()
        call expect(sims(2)%is_created(), "created anew")
        deallocate (sims)
    end subroutine
end module

program contract
    use checks
    implicit none
    character(40) :: wrong
    type(gp_simulation) :: sim, other
    type(gp_column) :: unfilled
    call get_command_argument(1, wrong)
    select case (wrong)
    case ("destroyed")
        call make_scene(sim)
        call sim%destroy()
        call sim%step(1)
    case ("copied")
        call make_scene(sim)
        other = sim
    case ("unfilled")
        call sim%create()
        call sim%add_column(unfilled)
    case ("refused")
        call sim%create()
        call sim%add_column(gp_column(width=-1.0_gp_real, height=1.0_gp_real))
    case ("")
        call check_structs()
        call check_errors()
        call check_reading()
        call check_turns()
        call check_callbacks()
        call check_files()
        call check_life()
        if (failures > 0) error stop "the contract is not kept"
        print "(a)", "passed"
    case default
        error stop "contract: no such case"
    end select
end program
