! Written by bindings/generate from include/granperi/gp.h. Do not edit.

!> Constructors of the structs that the library takes, views of those that it fills, and the constants.
module granperi_types
    use granperi_raw, raw_gp_particles => gp_particles
    use granperi_status, only: report
    implicit none
    private
    public :: gp_config
    public :: gp_material
    public :: gp_column
    public :: gp_plate
    public :: gp_particles
    public :: gp_state
    public :: gp_load
    public :: gp_output
    public :: raw_gp_particles
    public :: view_gp_particles
    public :: gp_status
    public :: GP_VERSION_MAJOR
    public :: GP_VERSION_MINOR
    public :: GP_VERSION_PATCH
    public :: GP_OK
    public :: GP_STOPPED
    public :: GP_E_ARGUMENT
    public :: GP_E_STATE
    public :: GP_E_MEMORY
    public :: GP_E_IO
    public :: GP_E_DIVERGED
    public :: GP_E_UNSUPPORTED
    public :: GP_E_VERSION
    public :: GP_E_INTERNAL
    public :: GP_PRESET_DEFAULT
    public :: GP_PRESET_PAPER
    public :: GP_PRESET_PAPER_LOCAL
    public :: GP_STRESS_ELASTIC
    public :: GP_STRESS_REGULARIZED
    public :: GP_STRESS_IMPLICIT
    public :: GP_DENSITY_CONTINUITY
    public :: GP_DENSITY_NUMBER
    public :: GP_INITIAL_HYDROSTATIC
    public :: GP_INITIAL_NONE
    public :: GP_WALL_NO_SLIP
    public :: GP_WALL_FREE_SLIP
    public :: GP_WALL_COULOMB
    public :: GP_FLUIDITY_FREE
    public :: GP_FLUIDITY_ZERO
    public :: GP_LOG_INFO
    public :: GP_LOG_WARNING
    public :: GP_FIELD_ID
    public :: GP_FIELD_COLUMN
    public :: GP_FIELD_X
    public :: GP_FIELD_Y
    public :: GP_FIELD_VX
    public :: GP_FIELD_VY
    public :: GP_FIELD_PRESSURE
    public :: GP_FIELD_DENSITY
    public :: GP_FIELD_SXX
    public :: GP_FIELD_SXY
    public :: GP_FIELD_SYY
    public :: GP_FIELD_SHEAR_RATE
    public :: GP_FIELD_INERTIAL_NUMBER
    public :: GP_FIELD_VISCOSITY
    public :: GP_FIELD_NUMBER_DENSITY
    public :: GP_FIELD_FLUIDITY
    public :: GP_FIELD_POSITION
    public :: GP_FIELD_VELOCITY
    public :: GP_FIELD_ALL
    public :: GP_DT_NONE
    public :: GP_DT_SOUND
    public :: GP_DT_FLOW
    public :: GP_DT_PLATE
    public :: GP_DT_VISCOSITY
    public :: GP_DT_DEMANDED
    public :: GP_DT_END
    public :: GP_DT_RETRY
    public :: GP_STATE_DEPOSIT
    public :: GP_STATE_MARKS
    public :: GP_STATE_DRIFT
    public :: GP_STATE_ALL

    !> What the library holds, not copied: read it, do not write it.
    type :: gp_particles
        integer(c_int64_t) :: count = 0 !! number of particles n; every array has the shape (n)
        integer(c_int64_t) :: epoch = 0
            !! number of changes to the simulation so far: a view is valid while it is the same
        integer(c_int64_t), pointer, contiguous :: id(:) => null()
            !! counted from 0 in the order in which particles were added
        integer(c_int32_t), pointer, contiguous :: column(:) => null()
            !! id of the column or set of particles it came with
        real(c_double), pointer, contiguous :: x(:) => null() !! m
        real(c_double), pointer, contiguous :: y(:) => null() !! m
        real(c_double), pointer, contiguous :: vx(:) => null() !! m/s
        real(c_double), pointer, contiguous :: vy(:) => null() !! m/s
        real(c_double), pointer, contiguous :: pressure(:) => null() !! Pa, p >= 0
        real(c_double), pointer, contiguous :: density(:) => null() !! kg/m3; with GP_DENSITY_NUMBER rho0 N / N0
        real(c_double), pointer, contiguous :: sxx(:) => null()
            !! Pa, deviatoric stress s: the Cauchy stress is s - p 1, and sxx + syy = 0; with GP_STRESS_REGULARIZED
            !! eta_r D, whose trace is not 0
        real(c_double), pointer, contiguous :: sxy(:) => null()
            !! Pa, deviatoric stress s: the Cauchy stress is s - p 1, and sxx + syy = 0; with GP_STRESS_REGULARIZED
            !! eta_r D, whose trace is not 0
        real(c_double), pointer, contiguous :: syy(:) => null()
            !! Pa, deviatoric stress s: the Cauchy stress is s - p 1, and sxx + syy = 0; with GP_STRESS_REGULARIZED
            !! eta_r D, whose trace is not 0
        real(c_double), pointer, contiguous :: shear_rate(:) => null()
            !! 1/s, |gamma| = sqrt(D:D / 2), D = (L + L^T)/2 ([1] 3.3)
        real(c_double), pointer, contiguous :: inertial_number(:) => null()
            !! I = 2 d |gamma| / sqrt(p / rho_s) ([1] 3.4), by the pressure of this moment; 0 where p = 0. In the
            !! default scheme the material's friction goes by a mean of the pressure over 100 dl / c0, not that of
            !! plates, nor with nonlocal_amplitude
        real(c_double), pointer, contiguous :: viscosity(:) => null()
            !! Pa s, tau / sqrt(|gamma|^2 + delta^2), tau = sqrt(s:s / 2); or eta_r ([1] 3.6)
        real(c_double), pointer, contiguous :: number_density(:) => null()
            !! N = sum of w over the neighbours within interaction_radius ([1] 2.4); with GP_DENSITY_NUMBER the scheme's
            !! own, with the ghosts behind plates
        real(c_double), pointer, contiguous :: fluidity(:) => null()
            !! 1/s, g: the plastic shear rate 2 |gamma| over tau / p; 0 without gp_material.nonlocal_amplitude
    end type

    interface gp_config
        module procedure new_gp_config
    end interface

    interface gp_material
        module procedure new_gp_material
    end interface

    interface gp_column
        module procedure new_gp_column
    end interface

    interface gp_plate
        module procedure new_gp_plate
    end interface

    interface gp_output
        module procedure new_gp_output
    end interface

contains

    !> The library's defaults, but for what is given, by keyword: the order may change.
    function new_gp_config( &
            preset, spacing, gravity_x, gravity_y, sound_speed, cfl, time_step, interaction_radius, horizon, &
            horizon_length, nonlocal, stress, density, friction_factor, delta, collision_distance, &
            zero_energy_penalty, density_diffusion, channel_width, channel_friction, periodic_x_min, periodic_x_max, &
            threads, seed, jitter, bulk_viscosity, implicit_tolerance, implicit_iterations, allow_unstable_step, &
            retry_halvings, sleep, status, message) result(made)
        integer(c_int32_t), intent(in), optional :: preset
        real(c_double), intent(in), optional :: spacing !! m, particle distance dl; 1e-9 .. 1e9 [0.0025]
        real(c_double), intent(in), optional :: gravity_x !! m/s2 [0]
        real(c_double), intent(in), optional :: gravity_y !! m/s2 [-9.81]
        real(c_double), intent(in), optional :: sound_speed
            !! m/s, artificial; 0: 10 x the largest speed that the scene can reach by falling from its highest to its
            !! lowest point, by its initial and plate velocities; or, if that is more, 60 x the speed of the hardest
            !! blow that it begins with: of a column that falls freely, through an opening too, or is thrown, against a
            !! plate or another column (not with GP_DENSITY_NUMBER, nor with a time_step). The log says so and what it
            !! costs. Else at least 1e-9 [0]
        real(c_double), intent(in), optional :: cfl
            !! time step over dl / (elastic wave speed), with GP_STRESS_REGULARIZED dl / c0; 0: the scheme's own
            !! (horizon 2.5: 0.59, 3: 0.71, 4: 0.95, 6: 1.42), by the default coefficients half of gp_state.dt_limit,
            !! down to 0.42 of it where the material moves by more than 0.06 dl in a step and where a blow is foreseen;
            !! of the schemes of [1] 0.2. Else 1e-6 .. 8; beyond gp_state.dt_limit (for these horizons 1.18, 1.44, 1.93,
            !! 2.88, in the schemes of [1] 1.0) it is refused at the first step, but see allow_unstable_step [0]
        real(c_double), intent(in), optional :: time_step
            !! s, fixed; 0: adaptive, by the smallest of the limits GP_DT_SOUND to GP_DT_VISCOSITY. Beyond
            !! gp_state.dt_limit: refused at the first step, but see allow_unstable_step [0]
        real(c_double), intent(in), optional :: interaction_radius
            !! dl, support of the number density and of the paper's MPS operators; 1.5 .. 8 [4]
        real(c_double), intent(in), optional :: horizon
            !! dl, radius of the peridynamic operators; 1.8 .. 8: below, neighbours are too few [4]
        real(c_double), intent(in), optional :: horizon_length !! m, the horizon as a fixed length; 0: use horizon [0]
        integer(c_int32_t), intent(in), optional :: nonlocal !! 1: peridynamic force states; 0: local model [1]
        integer(c_int32_t), intent(in), optional :: stress !! GP_STRESS_... [GP_STRESS_ELASTIC]
        integer(c_int32_t), intent(in), optional :: density !! GP_DENSITY_... [GP_DENSITY_CONTINUITY]
        real(c_double), intent(in), optional :: friction_factor
            !! multiplies mu(I): [1] equation 3.12 as printed amounts to 2; 0 .. 10 [1]
        real(c_double), intent(in), optional :: delta
            !! 1/s, regularisation of the viscosity ([1] 3.6); with GP_STRESS_ELASTIC only of the reported one; with
            !! GP_STRESS_IMPLICIT 1e-4 and below leave the same deposit; > 0 [1e-6]
        real(c_double), intent(in), optional :: collision_distance
            !! dl, closer approaching pairs of which both flow collide (in the schemes by number density all; [1] 2.9);
            !! 0: off; 0 .. 1 [0.9]
        real(c_double), intent(in), optional :: zero_energy_penalty
            !! of the velocity that the gradient does not see, in rho c0 / dl; inside the yield surface at least 0.2
            !! with GP_STRESS_ELASTIC; 0: off; 0 .. 0.5 [the scheme's own: 0.02]
        real(c_double), intent(in), optional :: density_diffusion
            !! smoothing of the density where the material flows, in c0 dl; 0: off; 0 .. 1 [the scheme's own: 0.2]
        real(c_double), intent(in), optional :: channel_width
            !! m, W between the side walls; 0: none. Their friction, averaged over the width, is 2 channel_friction p /
            !! W per volume against the velocity, and holds what it can [0]
        real(c_double), intent(in), optional :: channel_friction
            !! Coulomb coefficient of the side walls; needs channel_width [0]
        real(c_double), intent(in), optional :: periodic_x_min
            !! m; with periodic_x_max > periodic_x_min the scene is periodic in x: columns and particles begin within,
            !! positions return into the period now and then (they may be beyond its ends by less than a spacing), and a
            !! plate reaches over the period at most: one that just spans it has no ends
        real(c_double), intent(in), optional :: periodic_x_max
            !! m; the period is at least twice the horizon and the interaction radius and two spacings more; best a
            !! whole number of spacings [0, 0]
        integer(c_int32_t), intent(in), optional :: threads
            !! threads that work on this simulation, the calling one among them; 0: OpenMP's default (all processors, or
            !! OMP_NUM_THREADS); 0 .. 1024 [1]. The results are the same bits for any number
        integer(c_int64_t), intent(in), optional :: seed !! of the jitter [0]
        real(c_double), intent(in), optional :: jitter
            !! dl, columns' particles are displaced at random by up to this much in x and y; 0 .. 0.5 (exclusive) [0]
        real(c_double), intent(in), optional :: bulk_viscosity
            !! of volume changes under pressure and, inside the yield surface, of shear, in rho c0 dl: it damps elastic
            !! waves and does not act at rest; 0: off; 0 .. 1 [the scheme's own: 0.1]
        real(c_double), intent(in), optional :: implicit_tolerance
            !! with GP_STRESS_IMPLICIT: the solve of a step has converged when what is left of the momentum balance is
            !! below this share of the forces in it (root mean squares), and the rates fit the stress to its root; 1e-12
            !! .. 1e-2 [1e-5]
        integer(c_int32_t), intent(in), optional :: implicit_iterations
            !! with GP_STRESS_IMPLICIT: Newton steps that one solve may take; a solve that needs more is GP_E_DIVERGED;
            !! 1 .. 10000 [100]
        integer(c_int32_t), intent(in), optional :: allow_unstable_step
            !! 1: a demanded time_step or cfl beyond the stable limit is taken, with a warning; 0: it is refused [0]
        integer(c_int32_t), intent(in), optional :: retry_halvings
            !! a step that diverges is taken anew from where it began in two halves, these in halves again and so on, up
            !! to this many times; 0: it is GP_E_DIVERGED at once; 0 .. 20 [0]
        integer(c_int64_t), intent(in), optional :: sleep
            !! 1: what rests is left out of the work (gp_step, "Sleep"); 0: all material is computed in every step. Only
            !! with the default scheme, else GP_E_UNSUPPORTED; 0 .. 1 [0]
        integer(c_int32_t), intent(out), optional :: status
        character(*), intent(out), optional :: message
        type(gp_config) :: made
        integer(c_int32_t) :: answer
        integer(c_int32_t) :: init_preset
        init_preset = 0
        if (present(preset)) init_preset = preset
        answer = gp_config_init(made, c_sizeof(made), init_preset)
        call report("gp_config", answer, status, message)
        if (answer < 0) return
        if (present(spacing)) made%spacing = spacing
        if (present(gravity_x)) made%gravity_x = gravity_x
        if (present(gravity_y)) made%gravity_y = gravity_y
        if (present(sound_speed)) made%sound_speed = sound_speed
        if (present(cfl)) made%cfl = cfl
        if (present(time_step)) made%time_step = time_step
        if (present(interaction_radius)) made%interaction_radius = interaction_radius
        if (present(horizon)) made%horizon = horizon
        if (present(horizon_length)) made%horizon_length = horizon_length
        if (present(nonlocal)) made%nonlocal = nonlocal
        if (present(stress)) made%stress = stress
        if (present(density)) made%density = density
        if (present(friction_factor)) made%friction_factor = friction_factor
        if (present(delta)) made%delta = delta
        if (present(collision_distance)) made%collision_distance = collision_distance
        if (present(zero_energy_penalty)) made%zero_energy_penalty = zero_energy_penalty
        if (present(density_diffusion)) made%density_diffusion = density_diffusion
        if (present(channel_width)) made%channel_width = channel_width
        if (present(channel_friction)) made%channel_friction = channel_friction
        if (present(periodic_x_min)) made%periodic_x_min = periodic_x_min
        if (present(periodic_x_max)) made%periodic_x_max = periodic_x_max
        if (present(threads)) made%threads = threads
        if (present(seed)) made%seed = seed
        if (present(jitter)) made%jitter = jitter
        if (present(bulk_viscosity)) made%bulk_viscosity = bulk_viscosity
        if (present(implicit_tolerance)) made%implicit_tolerance = implicit_tolerance
        if (present(implicit_iterations)) made%implicit_iterations = implicit_iterations
        if (present(allow_unstable_step)) made%allow_unstable_step = allow_unstable_step
        if (present(retry_halvings)) made%retry_halvings = retry_halvings
        if (present(sleep)) made%sleep = sleep
    end function

    !> The library's defaults, but for what is given, by keyword: the order may change.
    function new_gp_material( &
            grain_density, volume_fraction, grain_diameter, mu_s, mu_2, i0, nonlocal_amplitude, fluidity_time, k0, &
            status, message) result(made)
        real(c_double), intent(in), optional :: grain_density !! kg/m3, rho_s; > 0 [2500]
        real(c_double), intent(in), optional :: volume_fraction !! phi, so rho = phi rho_s; > 0, <= 1 [0.62]
        real(c_double), intent(in), optional :: grain_diameter !! m, d; > 0 [0.002]
        real(c_double), intent(in), optional :: mu_s !! friction at I = 0; >= 0 [tan 21 deg]
        real(c_double), intent(in), optional :: mu_2 !! friction at large I; >= mu_s [tan 32 deg]
        real(c_double), intent(in), optional :: i0 !! I at which mu is half way between; > 0 [0.3]
        real(c_double), intent(in), optional :: nonlocal_amplitude
            !! A of the granular fluidity [4], its length over grain_diameter; 0: the local mu(I) law; 0 .. 10; glass
            !! beads 0.48, discs 0.9. Needs mu_2 > mu_s > 0 and friction_factor > 0, and spacings of half a grain to
            !! resolve it; only with the default scheme, else GP_E_UNSUPPORTED. Uniform steady flow is mu(I) as well [0]
        real(c_double), intent(in), optional :: fluidity_time
            !! s, t0 in which the fluidity follows; > 0; only with nonlocal_amplitude [1e-4]
        real(c_double), intent(in), optional :: k0
            !! sigma_h / sigma_v with which columns begin (GP_INITIAL_HYDROSTATIC), the stress across over that along
            !! the direction in which a column presses; 0: isotropic, or none across as gp_column.initial_pressure says.
            !! Within yield: (1 - m) / (1 + m) .. (1 + m) / (1 - m) with m = friction_factor mu_s, any above 0 where m
            !! >= 1. Else than 0 only with GP_STRESS_ELASTIC. Walls' friction begins unmobilised: side walls bear k0
            !! sigma_v, the base all of the weight. Below 1 it is also the ratio in which the stresses change where the
            !! material cannot spread, by its shear modulus, (1 - k0) / (1 + k0) of the bulk modulus, at least .1
            !! (without k0 .3): it stays while walls take weight over, until the material yields; beside walls as rough
            !! as itself it then tends to 1. Columns side by side are in balance if they have the same one [0]
        integer(c_int32_t), intent(out), optional :: status
        character(*), intent(out), optional :: message
        type(gp_material) :: made
        integer(c_int32_t) :: answer
        answer = gp_material_init(made, c_sizeof(made))
        call report("gp_material", answer, status, message)
        if (answer < 0) return
        if (present(grain_density)) made%grain_density = grain_density
        if (present(volume_fraction)) made%volume_fraction = volume_fraction
        if (present(grain_diameter)) made%grain_diameter = grain_diameter
        if (present(mu_s)) made%mu_s = mu_s
        if (present(mu_2)) made%mu_2 = mu_2
        if (present(i0)) made%i0 = i0
        if (present(nonlocal_amplitude)) made%nonlocal_amplitude = nonlocal_amplitude
        if (present(fluidity_time)) made%fluidity_time = fluidity_time
        if (present(k0)) made%k0 = k0
    end function

    !> The library's defaults, but for what is given, by keyword: the order may change.
    function new_gp_column( &
            x_min, y_min, width, height, material, vx, vy, initial_pressure, status, message) result(made)
        real(c_double), intent(in), optional :: x_min !! m, lower left corner
        real(c_double), intent(in), optional :: y_min !! m, lower left corner
        real(c_double), intent(in), optional :: width
            !! m; > 0, rounded to whole spacings (the log says so), at least one
        real(c_double), intent(in), optional :: height
            !! m; > 0, rounded to whole spacings (the log says so), at least one
        integer(c_int32_t), intent(in), optional :: material !! id of gp_add_material; 0 is always there [0]
        real(c_double), intent(in), optional :: vx !! m/s, initial velocity [0, 0]
        real(c_double), intent(in), optional :: vy !! m/s, initial velocity [0, 0]
        integer(c_int32_t), intent(in), optional :: initial_pressure
            !! GP_INITIAL_... [GP_INITIAL_HYDROSTATIC]. Hydrostatic: p = rho |g.n| depth below the opposite face, for
            !! each face of normal n into which gravity presses and at least half of which rests on plates or on other
            !! hydrostatic columns so borne; to it is added what rests on the opposite face: such columns, and the
            !! normal_pressure of plates. 0 where nothing bears. With GP_STRESS_ELASTIC, where one such face alone bears
            !! and no plate loads the other: the shear stress rho g.t depth along that face too, as far as the friction
            !! of the material and of the plates under it bears it; and where a side is free and mu_s >= 1, so that the
            !! friction holds it, no stress across: half the pressure, the other half as deviator. No effect with
            !! GP_DENSITY_NUMBER
        integer(c_int32_t), intent(out), optional :: status
        character(*), intent(out), optional :: message
        type(gp_column) :: made
        integer(c_int32_t) :: answer
        answer = gp_column_init(made, c_sizeof(made))
        call report("gp_column", answer, status, message)
        if (answer < 0) return
        if (present(x_min)) made%x_min = x_min
        if (present(y_min)) made%y_min = y_min
        if (present(width)) made%width = width
        if (present(height)) made%height = height
        if (present(material)) made%material = material
        if (present(vx)) made%vx = vx
        if (present(vy)) made%vy = vy
        if (present(initial_pressure)) made%initial_pressure = initial_pressure
    end function

    !> The library's defaults, but for what is given, by keyword: the order may change.
    function new_gp_plate( &
            x0, y0, x1, y1, friction, wall_mu, vx, vy, normal_pressure, mass_per_length, pivot_x, pivot_y, omega, &
            surface_velocity, fluidity, status, message) result(made)
        real(c_double), intent(in), optional :: x0
            !! m, ends of the wetted line. The plate's body is on the left of the way from end 0 to end 1, material is
            !! on the right; the plate acts on material on that side only, so a plate wetted on both sides is two plates
            !! back to back, best a horizon apart: nearer to each other, a floor under both sees the mean of both sides
            !! at their foot. The two ends differ
        real(c_double), intent(in), optional :: y0
            !! m, ends of the wetted line. The plate's body is on the left of the way from end 0 to end 1, material is
            !! on the right; the plate acts on material on that side only, so a plate wetted on both sides is two plates
            !! back to back, best a horizon apart: nearer to each other, a floor under both sees the mean of both sides
            !! at their foot. The two ends differ
        real(c_double), intent(in), optional :: x1
            !! m, ends of the wetted line. The plate's body is on the left of the way from end 0 to end 1, material is
            !! on the right; the plate acts on material on that side only, so a plate wetted on both sides is two plates
            !! back to back, best a horizon apart: nearer to each other, a floor under both sees the mean of both sides
            !! at their foot. The two ends differ
        real(c_double), intent(in), optional :: y1
            !! m, ends of the wetted line. The plate's body is on the left of the way from end 0 to end 1, material is
            !! on the right; the plate acts on material on that side only, so a plate wetted on both sides is two plates
            !! back to back, best a horizon apart: nearer to each other, a floor under both sees the mean of both sides
            !! at their foot. The two ends differ
        integer(c_int32_t), intent(in), optional :: friction !! GP_WALL_... [GP_WALL_NO_SLIP]
        real(c_double), intent(in), optional :: wall_mu !! Coulomb coefficient, for GP_WALL_COULOMB only; >= 0 [0]
        real(c_double), intent(in), optional :: vx !! m/s, constant velocity; not with a table [0, 0]
        real(c_double), intent(in), optional :: vy !! m/s, constant velocity; not with a table [0, 0]
        real(c_double), intent(in), optional :: normal_pressure
            !! Pa, a load on the plate's back: the plate moves along its normal as a rigid body under this load and the
            !! material's reaction (its own weight is part of the load), and along its tangent as prescribed: vx, vy
            !! then have no normal part, and there is no table and no turn. Of a line of several points the straight way
            !! from the first to the last counts; a closed one bears no load. 0: all of the motion is prescribed [0]
        real(c_double), intent(in), optional :: mass_per_length
            !! kg/m2, inertia of a loaded plate per length; only with normal_pressure. 0: light, as half a spacing of
            !! the heaviest material: it follows its load at once. A heavy plate rings on confined material, which damps
            !! its slow motion little [0]
        real(c_double), intent(in), optional :: pivot_x
            !! m, about this the plate turns, as a rigid body; it is displaced as the plate is. A plate that turns in a
            !! periodic scene is no longer, corner to corner, than the period [0, 0]
        real(c_double), intent(in), optional :: pivot_y
            !! m, about this the plate turns, as a rigid body; it is displaced as the plate is. A plate that turns in a
            !! periodic scene is no longer, corner to corner, than the period [0, 0]
        real(c_double), intent(in), optional :: omega
            !! rad/s, constant rate of turning, counter-clockwise; not with a table or a load [0]
        real(c_double), intent(in), optional :: surface_velocity
            !! m/s, along the line from its first point to its last, of the wall's surface alone, which stays where it
            !! is: a belt, a turning roll. Not with GP_WALL_FREE_SLIP [0]
        integer(c_int32_t), intent(in), optional :: fluidity
            !! GP_FLUIDITY_..., of materials with nonlocal_amplitude [GP_FLUIDITY_FREE]
        integer(c_int32_t), intent(out), optional :: status
        character(*), intent(out), optional :: message
        type(gp_plate) :: made
        integer(c_int32_t) :: answer
        answer = gp_plate_init(made, c_sizeof(made))
        call report("gp_plate", answer, status, message)
        if (answer < 0) return
        if (present(x0)) made%x0 = x0
        if (present(y0)) made%y0 = y0
        if (present(x1)) made%x1 = x1
        if (present(y1)) made%y1 = y1
        if (present(friction)) made%friction = friction
        if (present(wall_mu)) made%wall_mu = wall_mu
        if (present(vx)) made%vx = vx
        if (present(vy)) made%vy = vy
        if (present(normal_pressure)) made%normal_pressure = normal_pressure
        if (present(mass_per_length)) made%mass_per_length = mass_per_length
        if (present(pivot_x)) made%pivot_x = pivot_x
        if (present(pivot_y)) made%pivot_y = pivot_y
        if (present(omega)) made%omega = omega
        if (present(surface_velocity)) made%surface_velocity = surface_velocity
        if (present(fluidity)) made%fluidity = fluidity
    end function

    !> The library's defaults, but for what is given, by keyword: the order may change.
    function new_gp_output(every_seconds, fields, compression, single_precision, append, status, message) result(made)
        real(c_double), intent(in), optional :: every_seconds
            !! s; > 0: a frame at the start and after the first step at or past each multiple; 0: only by
            !! gp_output_write [0]
        integer(c_int32_t), intent(in), optional :: fields
            !! GP_FIELD_...; x and y come together, so do vx and vy; id and position are always written [position,
            !! velocity, pressure, shear_rate, column]
        integer(c_int32_t), intent(in), optional :: compression !! deflate level, 0 .. 9 [4]
        integer(c_int32_t), intent(in), optional :: single_precision
            !! 1: floating-point fields as 32 bits [0]. Times, the state and positions stay 64; positions are rounded to
            !! 1e-5 spacings, wherever they are, which compresses as well as 32 bits
        integer(c_int64_t), intent(in), optional :: append
            !! 1: an existing file of this simulation is continued, see gp_output_open; 0: it is replaced [0]
        integer(c_int32_t), intent(out), optional :: status
        character(*), intent(out), optional :: message
        type(gp_output) :: made
        integer(c_int32_t) :: answer
        answer = gp_output_init(made, c_sizeof(made))
        call report("gp_output", answer, status, message)
        if (answer < 0) return
        if (present(every_seconds)) made%every_seconds = every_seconds
        if (present(fields)) made%fields = fields
        if (present(compression)) made%compression = compression
        if (present(single_precision)) made%single_precision = single_precision
        if (present(append)) made%append = append
    end function

    subroutine view_gp_particles(raw, view)
        type(raw_gp_particles), intent(in) :: raw
        type(gp_particles), intent(out) :: view
        view%count = raw%count
        view%epoch = raw%epoch
        if (c_associated(raw%id)) call c_f_pointer(raw%id, view%id, [raw%count])
        if (c_associated(raw%column)) call c_f_pointer(raw%column, view%column, [raw%count])
        if (c_associated(raw%x)) call c_f_pointer(raw%x, view%x, [raw%count])
        if (c_associated(raw%y)) call c_f_pointer(raw%y, view%y, [raw%count])
        if (c_associated(raw%vx)) call c_f_pointer(raw%vx, view%vx, [raw%count])
        if (c_associated(raw%vy)) call c_f_pointer(raw%vy, view%vy, [raw%count])
        if (c_associated(raw%pressure)) call c_f_pointer(raw%pressure, view%pressure, [raw%count])
        if (c_associated(raw%density)) call c_f_pointer(raw%density, view%density, [raw%count])
        if (c_associated(raw%sxx)) call c_f_pointer(raw%sxx, view%sxx, [raw%count])
        if (c_associated(raw%sxy)) call c_f_pointer(raw%sxy, view%sxy, [raw%count])
        if (c_associated(raw%syy)) call c_f_pointer(raw%syy, view%syy, [raw%count])
        if (c_associated(raw%shear_rate)) call c_f_pointer(raw%shear_rate, view%shear_rate, [raw%count])
        if (c_associated(raw%inertial_number)) call c_f_pointer(raw%inertial_number, view%inertial_number, [raw%count])
        if (c_associated(raw%viscosity)) call c_f_pointer(raw%viscosity, view%viscosity, [raw%count])
        if (c_associated(raw%number_density)) call c_f_pointer(raw%number_density, view%number_density, [raw%count])
        if (c_associated(raw%fluidity)) call c_f_pointer(raw%fluidity, view%fluidity, [raw%count])
    end subroutine
end module
