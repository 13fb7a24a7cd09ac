!> A program outside the tree: a column falls onto a floor. Argument: a directory for its result file.
program main
    use granperi
    implicit none
    type(gp_simulation) :: sim
    type(gp_config) :: config
    type(gp_state) :: state
    integer :: status
    character(4000) :: directory
    call get_command_argument(1, directory)
    config = gp_config()
    call sim%create(config)
    call sim%add_plate(gp_plate(x0=1.0_gp_real, x1=-1.0_gp_real))
    call sim%add_column(gp_column(y_min=config%spacing, width=10*config%spacing, height=10*config%spacing))
    call sim%output_open(trim(directory)//"/consumer_fortran.h5", status=status)
    if (status /= merge(GP_OK, GP_E_UNSUPPORTED, gp_has_feature("hdf5"))) error stop "output_open"
    call sim%run(0.05_gp_real)
    state = sim%state()
    if (abs(state%time - 0.05_gp_real) > 0 .or. state%n_particles /= 100) error stop "run"
    print "('granperi ', a, ' hdf5=', i0, ' openmp=', i0, ': ', i0, ' steps, highest point ', f6.4, ' m')", &
        gp_version_string(), merge(1, 0, gp_has_feature("hdf5")), merge(1, 0, gp_has_feature("openmp")), state%step, &
        state%peak_height
    call sim%destroy()
end program
