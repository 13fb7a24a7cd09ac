!> What a simulation can be asked, and its files.
submodule(granperi_simulation:granperi_running) granperi_reading
    use granperi_raw, only: c_plan_entry => gp_plan_entry, c_get_state_parts => gp_get_state_parts, &
                            c_get_clock => gp_get_clock, &
                            c_get_particles => gp_get_particles, c_copy_field => gp_copy_field, &
                            c_get_surface => gp_get_surface, c_get_interface => gp_get_interface, &
                            c_get_plate_load => gp_get_plate_load, c_get_plan => gp_get_plan, c_save => gp_save, &
                            c_output_open => gp_output_open, c_output_write => gp_output_write, &
                            c_output_close => gp_output_close
    implicit none

contains

    module procedure state
        integer(c_int32_t) :: asked
        asked = GP_STATE_ALL
        if (present(parts)) asked = parts
        if (is_missing("state", self, status, message)) return
        read%struct_size = int(c_sizeof(read), c_int32_t)
        call report("state", c_get_state_parts(self%handle, asked, read), status, message)
    end procedure

    module procedure clock
        real(c_double) :: seconds(1), length(1)
        integer(c_int64_t) :: count
        integer(c_int32_t) :: answer
        seconds = 0
        length = 0
        count = 0
        if (.not. is_missing("clock", self, status, message)) then
            answer = c_get_clock(self%handle, seconds, length, count)
            call report("clock", answer, status, message)
        end if
        if (present(time)) time = seconds(1)
        if (present(dt)) dt = length(1)
        if (present(step)) step = count
    end procedure

    module procedure particles
        type(raw_gp_particles) :: raw
        integer(c_int32_t) :: answer, asked
        if (is_missing("particles", self, status, message)) return
        asked = GP_FIELD_ALL
        if (present(fields)) asked = fields
        raw%struct_size = int(c_sizeof(raw), c_int32_t)
        answer = c_get_particles(self%handle, asked, raw)
        if (answer >= 0) call view_gp_particles(raw, view)
        call report("particles", answer, status, message)
    end procedure

    module procedure is_current
        type(raw_gp_particles) :: raw
        answer = .false.
        if (.not. c_associated(self%handle)) return
        raw%struct_size = int(c_sizeof(raw), c_int32_t)
        if (c_get_particles(self%handle, 0_c_int32_t, raw) >= 0) answer = raw%epoch == view%epoch
    end procedure

    !> Number of particles; the caller has seen to it that there is a simulation.
    function count_of(self) result(n)
        class(gp_simulation), intent(in) :: self
        integer(c_int64_t) :: n
        type(raw_gp_particles) :: raw
        raw%struct_size = int(c_sizeof(raw), c_int32_t)
        n = 0
        if (c_get_particles(self%handle, 0_c_int32_t, raw) >= 0) n = raw%count
    end function

    module procedure copy
        integer(c_int32_t) :: answer
        if (is_missing("copy", self, status, message)) then
            allocate (values(0))
            return
        end if
        allocate (values(count_of(self)))
        answer = c_copy_field(self%handle, field, values, size(values, kind=c_int64_t))
        if (answer < 0) then
            deallocate (values)
            allocate (values(0))
        end if
        call report("copy", answer, status, message)
    end procedure

    module procedure copy_field
        integer(c_int64_t) :: n
        character(120) :: text
        if (is_missing("copy_field", self, status, message)) return
        n = count_of(self)
        if (size(values, kind=c_int64_t) /= n) then
            write (text, "('copy_field: values has the size ', i0, ': expected ', i0, ', the number of particles')") &
                size(values, kind=c_int64_t), n
            call report_text(GP_E_ARGUMENT, trim(text), status, message)
            return
        end if
        call report("copy_field", c_copy_field(self%handle, field, values, n), status, message)
    end procedure

    module procedure surface
        height = 0
        if (is_missing("surface", self, status, message)) return
        call report("surface", c_get_surface(self%handle, size(x, kind=c_int64_t), x, height), status, message)
    end procedure

    module procedure interface_between
        x = 0
        if (is_missing("interface_between", self, status, message)) return
        call report("interface_between", c_get_interface(self%handle, left, right, size(y, kind=c_int64_t), y, x), &
                    status, message)
    end procedure

    module procedure plate_load
        if (is_missing("plate_load", self, status, message)) return
        load%struct_size = int(c_sizeof(load), c_int32_t)
        call report("plate_load", c_get_plate_load(self%handle, plate, load), status, message)
    end procedure

    module procedure plan
        type(c_plan_entry), allocatable :: found(:)
        integer(c_int64_t) :: n, k
        integer(c_int32_t) :: answer
        n = 0
        if (.not. is_missing("plan", self, status, message)) then
            answer = c_get_plan(self%handle, 0_c_int64_t, n_out=n)
            allocate (found(n))
            if (answer >= 0) answer = c_get_plan(self%handle, n, found, n)
            if (answer < 0) n = 0
            call report("plan", answer, status, message)
        end if
        allocate (entries(n))
        do k = 1, n
            entries(k)%name = text_of(found(k)%name)
            entries(k)%reason = text_of(found(k)%reason)
            entries(k)%is_field = found(k)%kind == 1
            entries(k)%active = found(k)%active == 1
            entries(k)%bytes = found(k)%bytes
            entries(k)%seconds = found(k)%seconds
            entries(k)%calls = found(k)%calls
        end do
    end procedure

    ! ------------------------------------------------------------------------------------------------- files

    module procedure save_file
        if (is_missing("save", self, status, message)) return
        call report("save", c_save(self%handle, c_text(path)), status, message)
    end procedure

    module procedure output_open
        if (is_missing("output_open", self, status, message)) return
        if (present(output)) then
            if (is_unfilled("output_open", "gp_output", output%struct_size, status, message)) return
        end if
        call report("output_open", c_output_open(self%handle, c_text(path), output), status, message)
    end procedure

    module procedure output_write
        if (is_missing("output_write", self, status, message)) return
        call report("output_write", c_output_write(self%handle), status, message)
    end procedure

    module procedure output_close
        if (is_missing("output_close", self, status, message)) return
        call report("output_close", c_output_close(self%handle), status, message)
    end procedure
end submodule
