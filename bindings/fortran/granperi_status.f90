!> What every call does with its status, strings between Fortran and C, and what the library says about itself.
module granperi_status
    use, intrinsic :: iso_c_binding
    use granperi_raw, only: gp_last_error, gp_version_string, gp_has_feature, gp_status_string
    implicit none
    private
    public :: report, report_text, text_of, c_text, version_string, has_feature, status_string

    interface
        function c_strlen(text) bind(c, name="strlen") result(length)
            import
            type(c_ptr), value :: text
            integer(c_size_t) :: length
        end function
    end interface

contains

    !> Hands the status of the call `what` over, with the library's message; a failed call that the program does not ask
    !> about, by neither status nor message, ends it.
    subroutine report(what, answer, status, message)
        character(*), intent(in) :: what
        integer(c_int32_t), intent(in) :: answer
        integer(c_int32_t), intent(out), optional :: status
        character(*), intent(out), optional :: message
        if (answer < 0) then
            call report_text(answer, what//": "//text_of(gp_last_error()), status, message)
            return
        end if
        if (present(status)) status = answer
        if (present(message)) message = ""
    end subroutine

    !> The same for an error that this layer found, with its own text.
    subroutine report_text(answer, text, status, message)
        integer(c_int32_t), intent(in) :: answer
        character(*), intent(in) :: text
        integer(c_int32_t), intent(out), optional :: status
        character(*), intent(out), optional :: message
        if (.not. present(status) .and. .not. present(message)) error stop text
        if (present(status)) status = answer
        if (present(message)) message = text
    end subroutine

    !> A C string as a Fortran one; "" for NULL.
    function text_of(c_string) result(text)
        type(c_ptr), intent(in) :: c_string
        character(:), allocatable :: text
        character(kind=c_char), pointer :: characters(:)
        integer :: k
        if (.not. c_associated(c_string)) then
            text = ""
            return
        end if
        call c_f_pointer(c_string, characters, [c_strlen(c_string)])
        allocate (character(size(characters)) :: text)
        do k = 1, size(characters)
            text(k:k) = characters(k)
        end do
    end function

    !> A Fortran string for C: without trailing blanks, with the null at its end.
    pure function c_text(text) result(c_string)
        character(*), intent(in) :: text
        character(:, kind=c_char), allocatable :: c_string
        c_string = trim(text)//c_null_char
    end function

    !> Version of the library that runs, e.g. "0.2.0".
    function version_string() result(text)
        character(:), allocatable :: text
        text = text_of(gp_version_string())
    end function

    !> Whether this build has a feature: "hdf5", "openmp".
    function has_feature(name) result(answer)
        character(*), intent(in) :: name
        logical :: answer
        answer = gp_has_feature(c_text(name)) == 1
    end function

    !> Text for a status.
    function status_string(status) result(text)
        integer(c_int32_t), intent(in) :: status
        character(:), allocatable :: text
        text = text_of(gp_status_string(status))
    end function
end module
