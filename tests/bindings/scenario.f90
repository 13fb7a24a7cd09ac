!> The scenario of scenario.c, which says what it is and what is printed.
module scenario_parts
    use, intrinsic :: iso_c_binding
    use granperi
    implicit none

    type :: lid_and_wheel
        integer :: ids(2)
    end type

contains

    !> FNV-1a, 64 bits. Fortran's integers have a sign and their overflow is not defined: the product is put together from
    !> parts of 32 bits.
    subroutine add_to_hash(hash, values)
        integer(c_int64_t), intent(inout) :: hash
        real(c_double), intent(in) :: values(:)
        integer(c_int8_t) :: bytes(8)
        integer :: i, k
        do i = 1, size(values)
            bytes = transfer(values(i), bytes)
            do k = 1, 8
                hash = times_prime(ieor(hash, iand(int(bytes(k), c_int64_t), 255_c_int64_t)))
            end do
        end do
    end subroutine

    !> hash * 1099511628211 modulo 2**64; the prime is 2**40 + 435.
    pure function times_prime(hash) result(product)
        integer(c_int64_t), intent(in) :: hash
        integer(c_int64_t) :: product, low, high
        low = iand(hash, 4294967295_c_int64_t)*435
        high = ishft(hash, -32)*435 + ishft(low, -32) + ishft(iand(hash, 16777215_c_int64_t), 8)
        product = ior(ishft(high, 32), iand(low, 4294967295_c_int64_t))
    end function

    function hash_of(sim, driven) result(hash)
        type(gp_simulation), intent(in) :: sim
        integer, intent(in) :: driven(2)
        integer(c_int64_t) :: hash
        type(gp_load) :: load
        integer, parameter :: fields(5) = [GP_FIELD_X, GP_FIELD_Y, GP_FIELD_VX, GP_FIELD_VY, GP_FIELD_PRESSURE]
        integer :: k
        hash = -3750763034362895579_c_int64_t ! 14695981039346656037 - 2**64
        do k = 1, size(fields)
            call add_to_hash(hash, sim%copy(fields(k)))
        end do
        do k = 1, size(driven)
            load = sim%plate_load(driven(k))
            call add_to_hash(hash, [load%fx, load%fy, load%torque, load%dx, load%dy, load%impulse_x, load%impulse_y, &
                                    load%torque_pivot, load%angle, load%impulse_torque])
        end do
    end function

    !> The lid sinks faster and faster: 4 m/s2; the wheel turns faster and faster; and the scene is tilted.
    subroutine drive(sim, context, stop_run)
        class(gp_simulation), intent(inout) :: sim
        class(*), pointer, intent(inout) :: context
        logical, intent(inout) :: stop_run
        type(gp_state) :: state
        state = sim%state()
        select type (plates => context)
        type is (lid_and_wheel)
            call sim%set_plate_velocity(plates%ids(1), 0.0_gp_real, -4*state%time)
            call sim%set_plate_motion(plates%ids(2), -0.25_gp_real, 0.0_gp_real, 512*state%time)
            call sim%set_gravity(50*state%time, -9.5_gp_real)
        class default
            stop_run = .true.
        end select
    end subroutine
end module

program scenario
    use scenario_parts
    implicit none
    real(gp_real), parameter :: knot_t(5) = [0.0_gp_real, 0.005_gp_real, 0.01_gp_real, 0.015_gp_real, 0.02_gp_real]
    real(gp_real), parameter :: knot_y(5) = [0.0_gp_real, 0.001_gp_real, 0.004_gp_real, 0.009_gp_real, 0.016_gp_real]
    real(gp_real), parameter :: knot_angle(5) = [0.0_gp_real, 0.0_gp_real, 0.0_gp_real, 0.03125_gp_real, 0.0625_gp_real]
    real(gp_real), parameter :: point_x(5) = [0.17_gp_real, 0.15_gp_real, 0.13_gp_real, 0.15_gp_real, 0.17_gp_real]
    real(gp_real), parameter :: point_y(5) = [0.03_gp_real, 0.05_gp_real, 0.03_gp_real, 0.01_gp_real, 0.03_gp_real]
    type(gp_simulation) :: sim
    type(gp_state) :: state
    real(gp_real) :: x(6), y(6), vx(6), vy(6), knot_x(5)
    type(lid_and_wheel), target :: plates
    integer :: beads, k

    call sim%create(gp_config(spacing=0.004_gp_real, sound_speed=20.0_gp_real, threads=1, seed=7_gp_int64, &
                              jitter=0.05_gp_real))
    call sim%add_material(gp_material(grain_diameter=0.001_gp_real, mu_s=0.4_gp_real), id=beads)
    call sim%add_column(gp_column(width=0.08_gp_real, height=0.064_gp_real, material=beads))
    x = 0.12_gp_real
    y = [(k*0.004_gp_real, k=1, 6)]
    vx = -0.5_gp_real
    vy = [(k*0.0625_gp_real, k=1, 6)]
    call sim%add_particles(x, y, vx, vy)

    call sim%add_plate(gp_plate(x0=0.3_gp_real, surface_velocity=0.25_gp_real))
    call sim%add_plate(gp_plate(y1=0.1_gp_real, friction=GP_WALL_FREE_SLIP))
    call sim%add_plate(gp_plate(y0=0.066_gp_real, x1=0.06_gp_real, y1=0.066_gp_real, friction=GP_WALL_COULOMB), &
                       id=plates%ids(1))
    knot_x = 0
    call sim%add_plate(gp_plate(x0=0.08_gp_real, y0=0.1_gp_real, x1=0.08_gp_real, friction=GP_WALL_FREE_SLIP, &
                                pivot_x=0.08_gp_real, pivot_y=0.1_gp_real), knot_t, knot_x, knot_y, knot_angle=knot_angle)
    call sim%add_plate(gp_plate(pivot_x=0.15_gp_real, pivot_y=0.03_gp_real), point_x=point_x, point_y=point_y, &
                       id=plates%ids(2))

    call sim%set_callback(7, drive, plates)
    do k = 1, 3
        call sim%step(100)
        state = sim%state()
        print "('step ', i0, ' particles ', i0, ' hash ', z16.16)", state%step, state%n_particles, hash_of(sim, plates%ids)
    end do
    call sim%destroy()
end program
