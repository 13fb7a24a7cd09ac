!> The simulation as a type with procedures over the C interface. What each does, its ranges and its errors are
!> documented with the C function of its name (gp_add_column, gp_run, ...); here stands what is Fortran's own.
!>
!> Every procedure ends with the optional status (GP_OK, positive for information, negative for an error) and message (blank
!> or what was wrong, cut to the length of the variable: 300 is enough). Where a call fails and has neither, the program ends
!> with error stop and the message.
module granperi_simulation
    use, intrinsic :: iso_c_binding
    use granperi_types
    implicit none
    private
    public :: gp_simulation, gp_plan_entry, gp_on_step, gp_on_log, gp_log_to_stderr

    !> One simulation. It is freed by destroy, by a new create or load, and where the variable goes out of scope (which
    !> those of a main program do not). It cannot be copied.
    type :: gp_simulation
        private
        type(c_ptr) :: handle = c_null_ptr
        type(host_procedures), pointer :: host => null()
        logical :: borrowed = .false. ! given to a callback: not its to destroy
    contains
        procedure, public :: create, destroy, is_created
        procedure, public :: add_material, add_column, add_particles, add_plate
        procedure, public :: set_plate_velocity, set_plate_motion, set_gravity
        procedure, public :: run, set_callback, remove_callback, set_log, remove_log
        procedure, public :: state, clock, particles, is_current, copy, copy_field, surface, interface_between, plate_load, plan
        procedure, public :: save => save_file, load => load_file, output_open, output_write, output_close
        generic, public :: step => step_int32, step_int64
        procedure, private :: step_int32, step_int64
        generic, public :: assignment(=) => refuse_copy
        procedure, private :: refuse_copy
        final :: finalize
    end type

    !> What the engine does for this scene, or leaves out. Units and meaning as in the C struct of the same name.
    type :: gp_plan_entry
        character(:), allocatable :: name
        character(:), allocatable :: reason !! why it is active or left out
        logical :: is_field !! a field or table; else a stage
        logical :: active
        integer(c_int64_t) :: bytes !! of memory held
        real(c_double) :: seconds !! wall-clock time spent so far
        integer(c_int64_t) :: calls !! times run so far
    end type

    abstract interface
        !> Called after every so many steps; stop_run is .false. on entry. sim is valid during the call only, and may be
        !> read, written to its output and driven by set_plate_velocity, set_plate_motion and set_gravity. context: as given to
        !> set_callback, else not associated; the host's own data, to be unpacked by select type and not to be pointed
        !> elsewhere (intent(in) would say so, but gfortran 12 then takes what it points to for constant, too).
        subroutine gp_on_step(sim, context, stop_run)
            import :: gp_simulation
            class(gp_simulation), intent(inout) :: sim
            class(*), pointer, intent(inout) :: context
            logical, intent(inout) :: stop_run
        end subroutine

        !> level: GP_LOG_INFO or GP_LOG_WARNING. The library may not be called from inside it.
        subroutine gp_on_log(level, text, context)
            import :: c_int32_t
            integer(c_int32_t), intent(in) :: level
            character(*), intent(in) :: text
            class(*), pointer, intent(inout) :: context
        end subroutine
    end interface

    !> The host's procedures, at an address that stays when the variable of the simulation moves.
    type :: host_procedures
        procedure(gp_on_step), pointer, nopass :: on_step => null()
        class(*), pointer :: step_context => null()
        procedure(gp_on_log), pointer, nopass :: on_log => null()
        class(*), pointer :: log_context => null()
        logical :: inside = .false. ! a callback is running
    end type

    interface
        ! ---------------------------------------------------------------------------------------- life, scene, run

        !> A new and empty simulation in place of the one that was there, if any. config: gp_config(...), else defaults.
        module subroutine create(self, config, status, message)
            class(gp_simulation), intent(inout) :: self
            type(gp_config), intent(in), optional :: config
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
        end subroutine

        !> Frees it; views of its particles end. Nothing if there is none. Not from its own callback: GP_E_STATE.
        module subroutine destroy(self, status, message)
            class(gp_simulation), intent(inout) :: self
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
        end subroutine

        !> Whether there is a simulation: after create or load, and before destroy.
        module function is_created(self) result(answer)
            class(gp_simulation), intent(in) :: self
            logical :: answer
        end function

        !> id: of the new material, from 1 on.
        module subroutine add_material(self, material, id, status, message)
            class(gp_simulation), intent(inout) :: self
            type(gp_material), intent(in) :: material
            integer(c_int32_t), intent(out), optional :: id
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
        end subroutine

        !> id: from 0 on, counted together with sets of particles.
        module subroutine add_column(self, column, id, status, message)
            class(gp_simulation), intent(inout) :: self
            type(gp_column), intent(in) :: column
            integer(c_int32_t), intent(out), optional :: id
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
        end subroutine

        !> x, y (m), vx, vy (m/s, both or neither): of one size. material: 0 if not given.
        module subroutine add_particles(self, x, y, vx, vy, material, id, status, message)
            class(gp_simulation), intent(inout) :: self
            real(c_double), intent(in) :: x(:), y(:)
            real(c_double), intent(in), optional :: vx(:), vy(:)
            integer(c_int32_t), intent(in), optional :: material
            integer(c_int32_t), intent(out), optional :: id
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
        end subroutine

        !> knot_t (s), knot_x, knot_y (m), knot_angle (rad, counter-clockwise): the table of the plate's motion, of one size;
        !> knot_angle, or knot_x and knot_y, may be left out, for none. point_x, point_y (m), both or none, of one size: the
        !> plate is the line through these points, its body on the left of the way; it is closed if the last is the first.
        !> id: from 0 on.
        module subroutine add_plate(self, plate, knot_t, knot_x, knot_y, id, status, message, point_x, point_y, knot_angle)
            class(gp_simulation), intent(inout) :: self
            type(gp_plate), intent(in) :: plate
            real(c_double), intent(in), optional :: knot_t(:), knot_x(:), knot_y(:)
            integer(c_int32_t), intent(out), optional :: id
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
            real(c_double), intent(in), optional :: point_x(:), point_y(:), knot_angle(:)
        end subroutine

        !> The host drives the plate at this velocity, m/s.
        module subroutine set_plate_velocity(self, plate, vx, vy, status, message)
            class(gp_simulation), intent(inout) :: self
            integer(c_int32_t), intent(in) :: plate
            real(c_double), intent(in) :: vx, vy
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
        end subroutine

        !> The same for any rigid motion: the plate's pivot moves at (vx, vy), m/s, and the plate turns about it at omega, rad/s,
        !> counter-clockwise. A plate under a load does not turn: GP_E_ARGUMENT.
        module subroutine set_plate_motion(self, plate, vx, vy, omega, status, message)
            class(gp_simulation), intent(inout) :: self
            integer(c_int32_t), intent(in) :: plate
            real(c_double), intent(in) :: vx, vy, omega
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
        end subroutine

        !> Gravity, m/s2, from now on; before the first step it replaces the config's.
        module subroutine set_gravity(self, gx, gy, status, message)
            class(gp_simulation), intent(inout) :: self
            real(c_double), intent(in) :: gx, gy
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
        end subroutine

        !> Takes n steps. status GP_STOPPED: the callback asked to stop.
        module subroutine step_int32(self, n, status, message)
            class(gp_simulation), intent(inout) :: self
            integer(c_int32_t), intent(in) :: n
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
        end subroutine

        module subroutine step_int64(self, n, status, message)
            class(gp_simulation), intent(inout) :: self
            integer(c_int64_t), intent(in) :: n
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
        end subroutine

        !> Steps until the clock shows t_end (s) exactly. status GP_STOPPED: the callback asked to stop.
        module subroutine run(self, t_end, status, message)
            class(gp_simulation), intent(inout) :: self
            real(c_double), intent(in) :: t_end
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
        end subroutine

        !> Calls procedure after every `every`-th step. context stays the host's: it has to outlive the callback.
        module subroutine set_callback(self, every, procedure, context, status, message)
            class(gp_simulation), intent(inout) :: self
            integer, intent(in) :: every
            procedure(gp_on_step) :: procedure
            class(*), intent(in), target, optional :: context
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
        end subroutine

        module subroutine remove_callback(self, status, message)
            class(gp_simulation), intent(inout) :: self
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
        end subroutine

        !> Hands what the library has to say to procedure, for instance gp_log_to_stderr.
        module subroutine set_log(self, procedure, context, status, message)
            class(gp_simulation), intent(inout) :: self
            procedure(gp_on_log) :: procedure
            class(*), intent(in), target, optional :: context
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
        end subroutine

        module subroutine remove_log(self, status, message)
            class(gp_simulation), intent(inout) :: self
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
        end subroutine

        !> For set_log: warnings to error_unit.
        module subroutine gp_log_to_stderr(level, text, context)
            integer(c_int32_t), intent(in) :: level
            character(*), intent(in) :: text
            class(*), pointer, intent(inout) :: context
        end subroutine

        !> Impure elemental, so that it serves arrays of simulations, too.
        impure elemental module subroutine finalize(self)
            type(gp_simulation), intent(inout) :: self
        end subroutine

        module subroutine refuse_copy(self, other)
            class(gp_simulation), intent(inout) :: self
            class(gp_simulation), intent(in) :: other
        end subroutine

        ! ------------------------------------------------------------------------------------------ reading, files

        !> Clock, energy ledger, shape, rest.
        module function state(self, status, message, parts) result(read)
            class(gp_simulation), intent(in) :: self
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
            integer(c_int32_t), intent(in), optional :: parts !! GP_STATE_... added up, or 0; else all. The others are NaN
            type(gp_state) :: read
        end function

        !> The clock alone, at no cost: time (s), dt (s, of the last step; 0 before the first), step (steps taken).
        module subroutine clock(self, time, dt, step, status, message)
            class(gp_simulation), intent(in) :: self
            real(c_double), intent(out), optional :: time, dt
            integer(c_int64_t), intent(out), optional :: step
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
        end subroutine

        !> The library's own arrays of shape (n), not copied, in its own order, which changes: use id. fields:
        !> GP_FIELD_... added up, else all; the pointers of others are not associated. Valid until the next call that
        !> changes the simulation: see is_current.
        module function particles(self, fields, status, message) result(view)
            class(gp_simulation), intent(in) :: self
            integer(c_int32_t), intent(in), optional :: fields
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
            type(gp_particles) :: view
        end function

        !> Whether the arrays of the view are still there: .false. once this simulation has changed.
        module function is_current(self, view) result(answer)
            class(gp_simulation), intent(in) :: self
            type(gp_particles), intent(in) :: view
            logical :: answer
        end function

        !> One field (GP_FIELD_...) as an array of shape (n) of one's own, in the order of id. After an error: shape (0).
        module function copy(self, field, status, message) result(values)
            class(gp_simulation), intent(in) :: self
            integer(c_int32_t), intent(in) :: field
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
            real(c_double), allocatable :: values(:)
        end function

        !> The same into an array that is there, of shape (n).
        module subroutine copy_field(self, field, values, status, message)
            class(gp_simulation), intent(in) :: self
            integer(c_int32_t), intent(in) :: field
            real(c_double), intent(inout) :: values(:)
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
        end subroutine

        !> Height (m) of the free surface at each x (m); 0 outside the deposit.
        module function surface(self, x, status, message) result(height)
            class(gp_simulation), intent(in) :: self
            real(c_double), intent(in) :: x(:)
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
            real(c_double) :: height(size(x))
        end function

        !> x (m) of the interface between two columns at each y (m); NaN where they do not touch.
        module function interface_between(self, left, right, y, status, message) result(x)
            class(gp_simulation), intent(in) :: self
            integer(c_int32_t), intent(in) :: left, right
            real(c_double), intent(in) :: y(:)
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
            real(c_double) :: x(size(y))
        end function

        !> Force, moment, displacement and impulse of a plate.
        module function plate_load(self, plate, status, message) result(load)
            class(gp_simulation), intent(in) :: self
            integer(c_int32_t), intent(in) :: plate
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
            type(gp_load) :: load
        end function

        !> What the engine does for this scene, and what it leaves out.
        module function plan(self, status, message) result(entries)
            class(gp_simulation), intent(in) :: self
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
            type(gp_plan_entry), allocatable :: entries(:)
        end function

        module subroutine save_file(self, path, status, message)
            class(gp_simulation), intent(inout) :: self
            character(*), intent(in) :: path
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
        end subroutine

        !> What save wrote, in place of the simulation that was there, if any; after an error that one is still there.
        module subroutine load_file(self, path, status, message)
            class(gp_simulation), intent(inout) :: self
            character(*), intent(in) :: path
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
        end subroutine

        !> output: gp_output(...), else defaults.
        module subroutine output_open(self, path, output, status, message)
            class(gp_simulation), intent(inout) :: self
            character(*), intent(in) :: path
            type(gp_output), intent(in), optional :: output
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
        end subroutine

        module subroutine output_write(self, status, message)
            class(gp_simulation), intent(inout) :: self
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
        end subroutine

        module subroutine output_close(self, status, message)
            class(gp_simulation), intent(inout) :: self
            integer(c_int32_t), intent(out), optional :: status
            character(*), intent(out), optional :: message
        end subroutine
    end interface
end module
