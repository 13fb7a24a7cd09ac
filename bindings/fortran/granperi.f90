!> Dry granular flow in two dimensions. A program says: use granperi. SI units throughout; the two-dimensional domain is one
!> metre deep where a mass, a force or an energy is asked for. What every call and field means, its range and its errors are
!> the same as in C.
module granperi
    use, intrinsic :: iso_c_binding, only: c_double, c_int64_t
    use granperi_types
    use granperi_simulation
    use granperi_status, only: gp_version_string => version_string, gp_has_feature => has_feature, &
                               gp_status_string => status_string
    implicit none
    public
    private :: raw_gp_particles, view_gp_particles, c_double, c_int64_t

    !> Kinds of every real, and of integers that are not default ones (a seed, counts): 0.08_gp_real, 7_gp_int64.
    integer, parameter :: gp_real = c_double, gp_int64 = c_int64_t
end module
