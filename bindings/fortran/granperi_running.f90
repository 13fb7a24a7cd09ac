!> Life, scene and run of a simulation; its callbacks.
submodule(granperi_simulation) granperi_running
    use, intrinsic :: iso_fortran_env, only: error_unit
    use granperi_raw, only: c_create => gp_create, c_destroy => gp_destroy, c_add_material => gp_add_material, &
                            c_add_column => gp_add_column, c_add_particles => gp_add_particles, &
                            c_add_plate => gp_add_plate, c_set_plate_velocity => gp_set_plate_velocity, &
                            c_set_plate_motion => gp_set_plate_motion, &
                            c_set_gravity => gp_set_gravity, &
                            c_step => gp_step, c_run => gp_run, c_set_callback => gp_set_callback, &
                            c_set_log => gp_set_log, c_load_file => gp_load_file
    use granperi_status, only: report, report_text, text_of, c_text
    implicit none

contains

    ! ------------------------------------------------------------------------------------------------- life

    module procedure create
        type(c_ptr) :: handle
        type(gp_config) :: used
        integer(c_int32_t) :: answer
        if (is_inside("create", self, status, message)) return
        if (present(config)) then
            if (is_unfilled("create", "gp_config", config%struct_size, status, message)) return
            used = config
        else
            used = gp_config()
        end if
        answer = c_create(used, handle)
        if (answer >= 0) call replace(self, handle)
        call report("create", answer, status, message)
    end procedure

    module procedure load_file
        type(c_ptr) :: handle
        integer(c_int32_t) :: answer
        if (is_inside("load", self, status, message)) return
        answer = c_load_file(c_text(path), handle)
        if (answer >= 0) call replace(self, handle)
        call report("load", answer, status, message)
    end procedure

    module procedure destroy
        if (is_inside("destroy", self, status, message)) return
        call finalize(self)
        call report("destroy", GP_OK, status, message)
    end procedure

    module procedure finalize
        if (.not. self%borrowed) then
            if (c_associated(self%handle)) call c_destroy(self%handle)
            if (associated(self%host)) deallocate (self%host)
        end if
        self%handle = c_null_ptr
        nullify (self%host)
    end procedure

    subroutine replace(self, handle)
        class(gp_simulation), intent(inout) :: self
        type(c_ptr), intent(in) :: handle
        call finalize(self)
        self%handle = handle
        allocate (self%host)
    end subroutine

    module procedure is_created
        answer = c_associated(self%handle)
    end procedure

    module procedure refuse_copy
        error stop "a gp_simulation cannot be copied: use a pointer to it, or save and load"
    end procedure

    ! ---------------------------------------------------------------------------------------------- refusals

    !> Whether this is inside a callback of the simulation, which may not free it.
    function is_inside(what, self, status, message) result(refused)
        character(*), intent(in) :: what
        class(gp_simulation), intent(in) :: self
        integer(c_int32_t), intent(out), optional :: status
        character(*), intent(out), optional :: message
        logical :: refused
        refused = self%borrowed
        if (associated(self%host)) refused = refused .or. self%host%inside
        if (refused) call report_text(GP_E_STATE, what//": not from inside the simulation's own callback: set stop_run, "// &
                                      "and do it after run or step", status, message)
    end function

    !> Whether there is no simulation, for instance after destroy.
    function is_missing(what, self, status, message) result(refused)
        character(*), intent(in) :: what
        class(gp_simulation), intent(in) :: self
        integer(c_int32_t), intent(out), optional :: status
        character(*), intent(out), optional :: message
        logical :: refused
        refused = .not. c_associated(self%handle)
        if (refused) call report_text(GP_E_STATE, what//": the simulation was never created, or has been destroyed: "// &
                                      "call create first", status, message)
    end function

    !> Whether a struct was declared, but never filled.
    function is_unfilled(what, type_name, struct_size, status, message) result(refused)
        character(*), intent(in) :: what, type_name
        integer(c_int32_t), intent(in) :: struct_size
        integer(c_int32_t), intent(out), optional :: status
        character(*), intent(out), optional :: message
        logical :: refused
        refused = struct_size == 0
        if (refused) call report_text(GP_E_ARGUMENT, what//": this "//type_name//" was never filled: begin with "// &
                                      type_name//"(...), which has the library's defaults", status, message)
    end function

    !> Whether arrays that belong together differ in size.
    function are_uneven(what, names, sizes, status, message) result(refused)
        character(*), intent(in) :: what, names
        integer(c_size_t), intent(in) :: sizes(:)
        integer(c_int32_t), intent(out), optional :: status
        character(*), intent(out), optional :: message
        logical :: refused
        character(200) :: text
        refused = any(sizes /= sizes(1))
        if (.not. refused) return
        write (text, "(*(i0, :, ', '))") sizes
        call report_text(GP_E_ARGUMENT, what//": "//names//" have the sizes "//trim(text)//": expected the same", &
                         status, message)
    end function

    ! ------------------------------------------------------------------------------------------------- scene

    module procedure add_material
        integer(c_int32_t) :: new, answer
        if (is_missing("add_material", self, status, message)) return
        if (is_unfilled("add_material", "gp_material", material%struct_size, status, message)) return
        answer = c_add_material(self%handle, material, new)
        if (present(id)) id = new
        call report("add_material", answer, status, message)
    end procedure

    module procedure add_column
        integer(c_int32_t) :: new, answer
        if (is_missing("add_column", self, status, message)) return
        if (is_unfilled("add_column", "gp_column", column%struct_size, status, message)) return
        answer = c_add_column(self%handle, column, new)
        if (present(id)) id = new
        call report("add_column", answer, status, message)
    end procedure

    module procedure add_particles
        integer(c_int32_t) :: new, answer, of_material
        if (is_missing("add_particles", self, status, message)) return
        if (present(vx) .neqv. present(vy)) then
            call report_text(GP_E_ARGUMENT, "add_particles: vx and vy come together, or neither", status, message)
            return
        end if
        if (are_uneven("add_particles", "x, y", [size(x, kind=c_size_t), size(y, kind=c_size_t)], status, message)) return
        if (present(vx)) then
            if (are_uneven("add_particles", "x, vx, vy", [size(x, kind=c_size_t), size(vx, kind=c_size_t), &
                                                          size(vy, kind=c_size_t)], status, message)) return
        end if
        of_material = 0
        if (present(material)) of_material = material
        answer = c_add_particles(self%handle, of_material, size(x, kind=c_int64_t), x, y, vx, vy, new)
        if (present(id)) id = new
        call report("add_particles", answer, status, message)
    end procedure

    module procedure add_plate
        type(gp_plate) :: with_arrays
        real(c_double), allocatable, target :: t(:), x(:), y(:), angle(:), line_x(:), line_y(:)
        integer(c_int32_t) :: new, answer
        if (is_missing("add_plate", self, status, message)) return
        if (is_unfilled("add_plate", "gp_plate", plate%struct_size, status, message)) return
        if (.not. have_even_arrays(knot_t, knot_x, knot_y, knot_angle, point_x, point_y, status, message)) return
        with_arrays = plate
        t = copy_of(knot_t)
        x = copy_of(knot_x)
        y = copy_of(knot_y)
        angle = copy_of(knot_angle)
        line_x = copy_of(point_x)
        line_y = copy_of(point_y)
        if (present(knot_t)) then
            with_arrays%n_knots = size(knot_t, kind=c_int64_t)
            with_arrays%knot_t = c_loc(t)
            if (present(knot_x)) with_arrays%knot_x = c_loc(x)
            if (present(knot_y)) with_arrays%knot_y = c_loc(y)
            if (present(knot_angle)) with_arrays%knot_angle = c_loc(angle)
        end if
        if (present(point_x)) then
            with_arrays%n_points = size(point_x, kind=c_int64_t)
            with_arrays%point_x = c_loc(line_x)
            with_arrays%point_y = c_loc(line_y)
        end if
        answer = c_add_plate(self%handle, with_arrays, new)
        if (present(id)) id = new
        call report("add_plate", answer, status, message)
    end procedure

    !> Which arrays come together, and that they have the same size: else the error of add_plate.
    logical function have_even_arrays(t, x, y, angle, line_x, line_y, status, message) result(even)
        real(c_double), intent(in), optional :: t(:), x(:), y(:), angle(:), line_x(:), line_y(:)
        integer(c_int32_t), intent(out), optional :: status
        character(*), intent(out), optional :: message
        even = .false.
        if ((present(x) .neqv. present(y)) .or. (present(t) .neqv. (present(x) .or. present(angle)))) then
            call report_text(GP_E_ARGUMENT, "add_plate: knot_t comes with knot_x and knot_y, with knot_angle, or with all "// &
                             "three, and none of these without it", status, message)
            return
        end if
        if (present(line_x) .neqv. present(line_y)) then
            call report_text(GP_E_ARGUMENT, "add_plate: point_x and point_y come together, or neither", status, message)
            return
        end if
        if (present(x)) then
            if (are_uneven("add_plate", "knot_t, knot_x, knot_y", [size(t, kind=c_size_t), size(x, kind=c_size_t), &
                                                                   size(y, kind=c_size_t)], status, message)) return
        end if
        if (present(angle)) then
            if (are_uneven("add_plate", "knot_t, knot_angle", [size(t, kind=c_size_t), size(angle, kind=c_size_t)], &
                           status, message)) return
        end if
        if (present(line_x)) then
            if (are_uneven("add_plate", "point_x, point_y", [size(line_x, kind=c_size_t), &
                                                             size(line_y, kind=c_size_t)], status, message)) return
            if (size(line_x) == 0) then
                call report_text(GP_E_ARGUMENT, "add_plate: point_x has the size 0: expected 2 or more points", status, message)
                return
            end if
        end if
        even = .true.
    end function

    !> A contiguous copy of an array that may be missing, with an address even if it is empty.
    function copy_of(array) result(copied)
        real(c_double), intent(in), optional :: array(:)
        real(c_double), allocatable :: copied(:)
        copied = [0.0_c_double]
        if (.not. present(array)) return
        if (size(array) > 0) copied = array
    end function

    module procedure set_plate_velocity
        if (is_missing("set_plate_velocity", self, status, message)) return
        call report("set_plate_velocity", c_set_plate_velocity(self%handle, plate, vx, vy), status, message)
    end procedure

    module procedure set_plate_motion
        if (is_missing("set_plate_motion", self, status, message)) return
        call report("set_plate_motion", c_set_plate_motion(self%handle, plate, vx, vy, omega), status, message)
    end procedure

    module procedure set_gravity
        if (is_missing("set_gravity", self, status, message)) return
        call report("set_gravity", c_set_gravity(self%handle, gx, gy), status, message)
    end procedure

    ! --------------------------------------------------------------------------------------------------- run

    module procedure step_int64
        if (is_missing("step", self, status, message)) return
        call report("step", c_step(self%handle, n), status, message)
    end procedure

    module procedure step_int32
        call step_int64(self, int(n, c_int64_t), status, message)
    end procedure

    module procedure run
        if (is_missing("run", self, status, message)) return
        call report("run", c_run(self%handle, t_end), status, message)
    end procedure

    ! The interface once more: gfortran 12 loses a dummy procedure's where it is left out.
    module subroutine set_callback(self, every, procedure, context, status, message)
        class(gp_simulation), intent(inout) :: self
        integer, intent(in) :: every
        procedure(gp_on_step) :: procedure
        class(*), intent(in), target, optional :: context
        integer(c_int32_t), intent(out), optional :: status
        character(*), intent(out), optional :: message
        integer(c_int32_t) :: answer
        if (is_missing("set_callback", self, status, message)) return
        if (is_inside("set_callback", self, status, message)) return
        answer = c_set_callback(self%handle, int(every, c_int64_t), c_funloc(call_on_step), c_loc(self%host))
        if (answer >= 0) then
            self%host%on_step => procedure
            nullify (self%host%step_context)
            if (present(context)) self%host%step_context => context
        end if
        call report("set_callback", answer, status, message)
    end subroutine

    module procedure remove_callback
        if (is_missing("remove_callback", self, status, message)) return
        call report("remove_callback", c_set_callback(self%handle, 1_c_int64_t, c_null_funptr, c_null_ptr), status, message)
    end procedure

    function call_on_step(user, sim) bind(c) result(stop_code)
        type(c_ptr), value :: user, sim
        integer(c_int32_t) :: stop_code
        type(host_procedures), pointer :: host
        type(gp_simulation) :: borrowed
        class(*), pointer :: context
        logical :: stop_run
        call c_f_pointer(user, host)
        context => host%step_context
        borrowed%handle = sim
        borrowed%borrowed = .true.
        stop_run = .false.
        host%inside = .true.
        call host%on_step(borrowed, context, stop_run)
        host%inside = .false.
        stop_code = merge(1_c_int32_t, 0_c_int32_t, stop_run)
    end function

    ! The interface once more: gfortran 12 loses a dummy procedure's where it is left out.
    module subroutine set_log(self, procedure, context, status, message)
        class(gp_simulation), intent(inout) :: self
        procedure(gp_on_log) :: procedure
        class(*), intent(in), target, optional :: context
        integer(c_int32_t), intent(out), optional :: status
        character(*), intent(out), optional :: message
        integer(c_int32_t) :: answer
        if (is_missing("set_log", self, status, message)) return
        if (is_inside("set_log", self, status, message)) return
        answer = c_set_log(self%handle, c_funloc(call_on_log), c_loc(self%host))
        if (answer >= 0) then
            self%host%on_log => procedure
            nullify (self%host%log_context)
            if (present(context)) self%host%log_context => context
        end if
        call report("set_log", answer, status, message)
    end subroutine

    module procedure remove_log
        if (is_missing("remove_log", self, status, message)) return
        call report("remove_log", c_set_log(self%handle, c_null_funptr, c_null_ptr), status, message)
    end procedure

    subroutine call_on_log(user, level, text) bind(c)
        type(c_ptr), value :: user, text
        integer(c_int32_t), value :: level
        type(host_procedures), pointer :: host
        class(*), pointer :: context
        call c_f_pointer(user, host)
        context => host%log_context
        call host%on_log(level, text_of(text), context)
    end subroutine

    module procedure gp_log_to_stderr
        if (level >= GP_LOG_WARNING) write (error_unit, "(2a)") "granperi: ", text
    end procedure
end submodule
