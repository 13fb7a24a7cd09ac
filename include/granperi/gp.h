/* granperi: granular peridynamics.
 *
 * Dry granular flow in two dimensions, from first slip to full arrest, behind a stable C interface.
 *
 * Conventions that hold for every call
 *   - SI units throughout. The domain is two-dimensional; energies, masses and forces are per metre of depth.
 *   - Every call that can fail returns a gp_status: GP_OK (0), positive for information, negative for an error.
 *     After an error gp_last_error() holds a text that names the argument, its value and what was expected.
 *   - Unless a call says otherwise, an error leaves the simulation and all outputs as they were;
 *     a handle or count that the call was to fill in is set to NULL or 0.
 *   - Every number passed in is checked. A value outside the stated range is GP_E_ARGUMENT; nothing is ever clamped. Limits of
 *     all scenes: positions within 1e12 spacings of the origin, a plate's line shorter than 1e8 spacings, 2 147 483 646 particles,
 *     speeds, gravity and density up to 1e50.
 *   - A struct passed in begins with struct_size and is filled by its _init function first. Structs grow only at their end: a
 *     shorter one (an older program) is completed with defaults, a longer one whose unknown tail is not zero is GP_E_VERSION.
 *   - All input is copied: the caller may free its arrays when the call returns.
 *   - Distinct simulations may be used from distinct threads at the same time. One simulation belongs to one
 *     thread at a time.
 *   - After fork(), a child of a parent that has run simulations with several threads does its work in one, with the same
 *     bits: the others do not survive a fork.
 *   - The host's floating-point environment (rounding, flush-to-zero, traps, flags) and locale have no effect on results,
 *     files and messages; they are in force inside callbacks, and after a call as they were before.
 *   - No exception, abort, exit, signal or print leaves the library. Messages go to the callback of gp_set_log.
 *   - Inside a callback the simulation may be read (gp_get_..., gp_copy_field), saved (gp_save), written to its open output
 *     (gp_output_write) and driven (gp_set_plate_velocity, gp_set_plate_motion, gp_set_gravity). Every other call on it
 *     returns GP_E_STATE.
 *   - Undefined, and not looked for: a simulation after its gp_destroy, one simulation in two threads at the same time, any
 *     call from inside the log, pointers that do not point to what is said. NULL for a simulation is GP_E_ARGUMENT.
 *
 * References
 *   [1] Jin, Lu, Tai & Xu (2021), J. Fluid Mech. 917: peridynamics in a mesh-free method with the mu(I) rheology.
 *   [2] Dunatunga & Kamrin (2015), J. Fluid Mech. 779: the return map of the mu(I) law.
 *   [3] Adami, Hu & Adams (2012), J. Comput. Phys. 231: wall pressure extrapolated from the fluid.
 *   [4] Henann & Kamrin (2013), Proc. Natl. Acad. Sci. USA 110; Kamrin & Henann (2015), Soft Matter 11: granular fluidity.
 */
#ifndef GRANPERI_GP_H
#define GRANPERI_GP_H

#include <stddef.h>
#include <stdint.h>

#ifndef GP_API
#if defined(GP_BUILDING) && defined(__GNUC__)
#define GP_API __attribute__((visibility("default")))
#else
#define GP_API
#endif
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define GP_VERSION_MAJOR 0
#define GP_VERSION_MINOR 2
#define GP_VERSION_PATCH 0

/* ------------------------------------------------------------------------------------------------ status */

typedef int32_t gp_status;

enum {
    GP_OK = 0,
    GP_STOPPED = 1,        /* information: the callback asked to stop; the step it saw is complete */
    GP_E_ARGUMENT = -1,    /* an argument is missing, not finite, out of range or inconsistent */
    GP_E_STATE = -2,       /* the call is out of order, or was made from inside a callback */
    GP_E_MEMORY = -3,      /* out of memory */
    GP_E_IO = -4,          /* a file could not be created, written or read */
    GP_E_DIVERGED = -5,    /* a value became non-finite or unbounded (see gp_step): the simulation can be read and
                              saved at its last good step, not stepped */
    GP_E_UNSUPPORTED = -6, /* the option exists, but this build or version does not have it */
    GP_E_VERSION = -7,     /* a struct or file comes from a newer version, or a checkpoint is in another format */
    GP_E_INTERNAL = -8     /* a defect of the library: please report the text of gp_last_error() */
};

/* Static English text for a status; "unknown status" for any other number. Never NULL. */
GP_API const char *gp_status_string(gp_status status);

/* Text of this thread's most recent error, "" if there was none. Never NULL; valid until this thread's next call. */
GP_API const char *gp_last_error(void);

/* ----------------------------------------------------------------------------------------------- version */

/* Version of the library that runs, as major * 10000 + minor * 100 + patch. */
GP_API uint32_t gp_version(void);

/* The same as text, e.g. "0.2.0". */
GP_API const char *gp_version_string(void);

/* 1 if this build has the named feature, else 0. Features: "hdf5", "openmp", "mpi" (gp_mpi.h: the library granperi-mpi), and the
 * instruction set that the engine runs with, one of "x86-64", "x86-64-v2", "x86-64-v3" (AVX2, FMA), "x86-64-v4" (AVX-512), "generic"
 * (another processor). NULL or an unknown name gives 0.
 * A build for x86-64 has the engine twice, for x86-64 and x86-64-v3, and takes what the processor has; their results differ in the
 * last bits (docs/trust.md). The environment variable GRANPERI_LEVEL, set to one of the names before the first call, asks for one;
 * if it is not the one that runs, gp_create and gp_load are GP_E_UNSUPPORTED. */
GP_API int32_t gp_has_feature(const char *name);

/* --------------------------------------------------------------------------------------------- parameters */

/* Presets: which scheme gp_config_init describes. The scheme itself follows from nonlocal, stress and density:
 *   1, GP_STRESS_ELASTIC, GP_DENSITY_CONTINUITY: the default;
 *   1, GP_STRESS_IMPLICIT, GP_DENSITY_CONTINUITY: the same with the regularised law in place of the yield surface;
 *   1, GP_STRESS_REGULARIZED, GP_DENSITY_NUMBER: the non-local scheme of [1];
 *   0, GP_STRESS_REGULARIZED, GP_DENSITY_NUMBER: its local model.
 * Any other combination is GP_E_UNSUPPORTED at gp_create. The schemes of [1] are there to compare with: they do not come
 * to rest but creep, the more the longer the time step. They have no zero_energy_penalty, density_diffusion and
 * bulk_viscosity (else than 0: GP_E_ARGUMENT), and a column's pressure follows from its positions: its initial_pressure
 * has no effect. Plates have one layer of wall particles, and ghosts with the velocity and the stress of these behind. */
enum {
    GP_PRESET_DEFAULT = 0,    /* continuity density, return map, extrapolated walls */
    GP_PRESET_PAPER = 1,      /* the non-local scheme of [1] as printed, but for misprints: friction_factor 2 */
    GP_PRESET_PAPER_LOCAL = 2 /* the local model of [1] by MPS operators: friction_factor 1 */
};

/* How the deviatoric stress follows from the motion. */
enum {
    GP_STRESS_ELASTIC = 0,     /* elastic trial with the mu(I) return map of [2]: a true yield, no regularisation */
    GP_STRESS_REGULARIZED = 1, /* tau = eta_r D of [1] 3.6, explicit: no yield, creep at rest */
    GP_STRESS_IMPLICIT = 2     /* tau = eta_r dev D, solved for the velocity at the end of the step: no yield either, but
                                  a creep in proportion to delta and no limit on the time step. The check on the first:
                                  14 (delta = 1e-2) to 86 times (1e-6) its work in docs/stability.md */
};

/* How the density is found. */
enum {
    GP_DENSITY_CONTINUITY = 0, /* D rho / Dt = -rho div u */
    GP_DENSITY_NUMBER = 1      /* from the particle number density, [1] 2.4, with the equation of state 2.8 */
};

typedef struct gp_config {
    uint32_t struct_size;
    double spacing;              /* m, particle distance dl; 1e-9 .. 1e9 [0.0025] */
    double gravity_x;            /* m/s2 [0] */
    double gravity_y;            /* m/s2 [-9.81] */
    double sound_speed;          /* m/s, artificial; 0: 10 x the largest speed that the scene can reach by falling
                                    from its highest to its lowest point, by its initial and plate velocities; or, if
                                    that is more, 60 x the speed of the hardest blow that it begins with: of a column
                                    that falls freely, through an opening too, or is thrown, against a plate or another
                                    column (not with GP_DENSITY_NUMBER, nor with a time_step). The log says so and what it
                                    costs. Else at least 1e-9 [0] */
    double cfl;                  /* time step over dl / (elastic wave speed), with GP_STRESS_REGULARIZED dl / c0;
                                    0: the scheme's own (horizon 2.5: 0.59, 3: 0.71, 4: 0.95, 6: 1.42), by the default
                                    coefficients half of gp_state.dt_limit, down to 0.42 of it where the material moves by
                                    more than 0.06 dl in a step and where a blow is foreseen; of the schemes of [1] 0.2. Else
                                    1e-6 .. 8; beyond gp_state.dt_limit (for these horizons 1.18, 1.44, 1.93, 2.88, in the
                                    schemes of [1] 1.0) it is refused at the first step, but see allow_unstable_step [0] */
    double time_step;            /* s, fixed; 0: adaptive, by the smallest of the limits GP_DT_SOUND to GP_DT_VISCOSITY.
                                    Beyond gp_state.dt_limit: refused at the first step, but see allow_unstable_step [0] */
    double interaction_radius;   /* dl, support of the number density and of the paper's MPS operators; 1.5 .. 8 [4] */
    double horizon;              /* dl, radius of the peridynamic operators; 1.8 .. 8: below, neighbours are too few [4] */
    double horizon_length;       /* m, the horizon as a fixed length; 0: use horizon [0] */
    int32_t nonlocal;            /* 1: peridynamic force states; 0: local model [1] */
    int32_t stress;              /* GP_STRESS_... [GP_STRESS_ELASTIC] */
    int32_t density;             /* GP_DENSITY_... [GP_DENSITY_CONTINUITY] */
    double friction_factor;      /* multiplies mu(I): [1] equation 3.12 as printed amounts to 2; 0 .. 10 [1] */
    double delta;                /* 1/s, regularisation of the viscosity ([1] 3.6); with GP_STRESS_ELASTIC only of the
                                    reported one; with GP_STRESS_IMPLICIT 1e-4 and below leave the same deposit; > 0
                                    [1e-6] */
    double collision_distance;   /* dl, closer approaching pairs of which both flow collide (in the schemes by number density all;
                                    [1] 2.9); 0: off; 0 .. 1 [0.9] */
    double zero_energy_penalty;  /* of the velocity that the gradient does not see, in rho c0 / dl; inside the yield
                                    surface at least 0.2 with GP_STRESS_ELASTIC; 0: off; 0 .. 0.5 [the scheme's own: 0.02] */
    double density_diffusion;    /* smoothing of the density where the material flows, in c0 dl; 0: off; 0 .. 1
                                    [the scheme's own: 0.2] */
    double channel_width;        /* m, W between the side walls; 0: none. Their friction, averaged over the width, is
                                    2 channel_friction p / W per volume against the velocity, and holds what it can [0] */
    double channel_friction;     /* Coulomb coefficient of the side walls; needs channel_width [0] */
    double periodic_x_min;       /* m; with periodic_x_max > periodic_x_min the scene is periodic in x: columns and
                                    particles begin within, positions return into the period now and then (they may be
                                    beyond its ends by less than a spacing), and a plate reaches over the period at most:
                                    one that just spans it has no ends */
    double periodic_x_max;       /* m; the period is at least twice the horizon and the interaction radius and two
                                    spacings more; best a whole number of spacings [0, 0] */
    int32_t threads;             /* threads that work on this simulation, the calling one among them; 0: OpenMP's default (all
                                    processors, or OMP_NUM_THREADS); 0 .. 1024 [1]. The results are the same bits for any
                                    number */
    uint64_t seed;               /* of the jitter [0] */
    double jitter;               /* dl, columns' particles are displaced at random by up to this much in x and y;
                                    0 .. 0.5 (exclusive) [0] */
    int32_t preset;              /* GP_PRESET_..., set by gp_config_init */
    double bulk_viscosity;       /* of volume changes under pressure and, inside the yield surface, of shear, in rho c0 dl:
                                    it damps elastic waves and does not act at rest; 0: off; 0 .. 1 [the scheme's own: 0.1] */
    double implicit_tolerance;   /* with GP_STRESS_IMPLICIT: the solve of a step has converged when what is left of the
                                    momentum balance is below this share of the forces in it (root mean squares), and the
                                    rates fit the stress to its root; 1e-12 .. 1e-2 [1e-5] */
    int32_t implicit_iterations; /* with GP_STRESS_IMPLICIT: Newton steps that one solve may take; a solve that needs more
                                    is GP_E_DIVERGED; 1 .. 10000 [100] */
    int32_t allow_unstable_step; /* 1: a demanded time_step or cfl beyond the stable limit is taken, with a warning; 0: it
                                    is refused [0] */
    int32_t retry_halvings;      /* a step that diverges is taken anew from where it began in two halves, these in halves
                                    again and so on, up to this many times; 0: it is GP_E_DIVERGED at once; 0 .. 20 [0] */
    int64_t sleep;               /* 1: what rests is left out of the work (gp_step, "Sleep"); 0: all material is computed in
                                    every step. Only with the default scheme, else GP_E_UNSUPPORTED; 0 .. 1 [0] */
} gp_config;

/* Fills *config with the defaults of the preset. size: sizeof(gp_config). */
GP_API gp_status gp_config_init(gp_config *config, size_t size, int32_t preset);

typedef struct gp_material {
    uint32_t struct_size;
    double grain_density;   /* kg/m3, rho_s; > 0 [2500] */
    double volume_fraction; /* phi, so rho = phi rho_s; > 0, <= 1 [0.62] */
    double grain_diameter;  /* m, d; > 0 [0.002] */
    double mu_s;            /* friction at I = 0; >= 0 [tan 21 deg] */
    double mu_2;            /* friction at large I; >= mu_s [tan 32 deg] */
    double i0;              /* I at which mu is half way between; > 0 [0.3] */
    double nonlocal_amplitude; /* A of the granular fluidity [4], its length over grain_diameter; 0: the local mu(I) law; 0 .. 10;
                                  glass beads 0.48, discs 0.9. Needs mu_2 > mu_s > 0 and friction_factor > 0, and spacings of
                                  half a grain to resolve it; only with the default scheme, else GP_E_UNSUPPORTED. Uniform
                                  steady flow is mu(I) as well [0] */
    double fluidity_time;      /* s, t0 in which the fluidity follows; > 0; only with nonlocal_amplitude [1e-4] */
    double k0;              /* sigma_h / sigma_v with which columns begin (GP_INITIAL_HYDROSTATIC), the stress across over
                               that along the direction in which a column presses; 0: isotropic, or none across as
                               gp_column.initial_pressure says. Within yield: (1 - m) / (1 + m) .. (1 + m) / (1 - m) with
                               m = friction_factor mu_s, any above 0 where m >= 1. Else than 0 only with
                               GP_STRESS_ELASTIC. Walls' friction begins unmobilised: side walls bear k0 sigma_v, the base
                               all of the weight. Below 1 it is also the ratio in which the stresses change where the
                               material cannot spread, by its shear modulus, (1 - k0) / (1 + k0) of the bulk modulus, at
                               least .1 (without k0 .3): it stays while walls take weight over, until the material
                               yields; beside walls as rough as itself it then tends to 1. Columns side by side are in
                               balance if they have the same one [0] */
} gp_material;

/* Fills *material with glass beads. size: sizeof(gp_material). */
GP_API gp_status gp_material_init(gp_material *material, size_t size);

/* The stress with which a column begins. */
enum {
    GP_INITIAL_HYDROSTATIC = 0, /* in balance with the plates that support the column: no shock at the start */
    GP_INITIAL_NONE = 1         /* none: gravity sets in suddenly */
};

typedef struct gp_column {
    uint32_t struct_size;
    double x_min, y_min;      /* m, lower left corner */
    double width, height;     /* m; > 0, rounded to whole spacings (the log says so), at least one */
    int32_t material;         /* id of gp_add_material; 0 is always there [0] */
    double vx, vy;            /* m/s, initial velocity [0, 0] */
    int32_t initial_pressure; /* GP_INITIAL_... [GP_INITIAL_HYDROSTATIC]. Hydrostatic: p = rho |g.n| depth below the
                                 opposite face, for each face of normal n into which gravity presses and at least half of
                                 which rests on plates or on other hydrostatic columns so borne; to it is added what rests on
                                 the opposite face: such columns, and the normal_pressure of plates. 0 where nothing bears.
                                 With GP_STRESS_ELASTIC, where one such face alone bears and no plate loads the other: the
                                 shear stress rho g.t depth along that face too, as far as the friction of the material and
                                 of the plates under it bears it; and where a side is free and mu_s >= 1, so that the
                                 friction holds it, no stress across: half the pressure, the other half as deviator.
                                 No effect with GP_DENSITY_NUMBER */
} gp_column;

/* Fills *column with zeros: the rectangle has to be set. size: sizeof(gp_column). */
GP_API gp_status gp_column_init(gp_column *column, size_t size);

/* What the wall does to the tangential velocity. The traction along a wall is a law of friction: it holds what it can, never
 * drives, and is never more than the material itself bears there, mu(I) of the rate at the wall's surface times the wall's normal
 * force on each particle (with GP_STRESS_IMPLICIT the shear at a rough wall is part of the implicit solve). */
enum {
    GP_WALL_NO_SLIP = 0,   /* a rough wall: the material's own friction */
    GP_WALL_FREE_SLIP = 1, /* no shear traction. The forces reach over the horizon: beside a pressure that changes along
                              the plate, a share of the order of dl / extent of the scene still acts along it */
    GP_WALL_COULOMB = 2    /* up to wall_mu times the normal traction, or what the material bears, if that is less */
};

/* Plates whose ends meet within 0.01 dl (end 1 of one, end 0 of the next), that move alike, bear no load and turn by 50 degrees
 * at most are one wall, as the segments of one plate's line are: the joint is not felt. The paper's schemes take each segment
 * for a wall of its own. */

typedef struct gp_plate {
    uint32_t struct_size;
    double x0, y0, x1, y1;  /* m, ends of the wetted line. The plate's body is on the left of the way from end 0 to
                               end 1, material is on the right; the plate acts on material on that side only, so a
                               plate wetted on both sides is two plates back to back, best a horizon apart: nearer
                               to each other, a floor under both sees the mean of both sides at their foot. The two
                               ends differ */
    int32_t friction;       /* GP_WALL_... [GP_WALL_NO_SLIP] */
    double wall_mu;         /* Coulomb coefficient, for GP_WALL_COULOMB only; >= 0 [0] */
    double vx, vy;          /* m/s, constant velocity; not with a table [0, 0] */
    int64_t n_knots;        /* length of the displacement table; 0: none [0] */
    const double *knot_t;   /* s, shape (n_knots), strictly increasing */
    const double *knot_x;   /* m, shape (n_knots), displacement; linear between knots, at rest before and after */
    const double *knot_y;   /* m, shape (n_knots) */
    double normal_pressure; /* Pa, a load on the plate's back: the plate moves along its normal as a rigid body under this
                               load and the material's reaction (its own weight is part of the load), and along its
                               tangent as prescribed: vx, vy then have no normal part, and there is no table and no turn.
                               Of a line of several points the straight way from the first to the last counts; a closed
                               one bears no load.
                               0: all of the motion is prescribed [0] */
    double mass_per_length; /* kg/m2, inertia of a loaded plate per length; only with normal_pressure. 0: light, as half
                               a spacing of the heaviest material: it follows its load at once. A heavy plate
                               rings on confined material, which damps its slow motion little [0] */
    int64_t n_points;       /* 0: the plate is the segment from (x0, y0) to (x1, y1); 2 to 10 000 000: it is the line
                               through that many points, with x0 to y1 0: one wall, one friction, one motion, one load.
                               Its segments are no shorter than a tenth of the spacing, and it does not cross, touch or
                               fold back on itself. No joint of it is felt, but for corners of more than 50 degrees and
                               bulges of more than that within a horizon [0] */
    const double *point_x;  /* m, shape (n_points); body on the left of the way. Last point = first point: a closed line,
                               as a drum (clockwise: material inside) or an obstacle (counter-clockwise) [NULL] */
    const double *point_y;  /* m, shape (n_points) [NULL] */
    double pivot_x, pivot_y; /* m, about this the plate turns, as a rigid body; it is displaced as the plate is. A plate that
                               turns in a periodic scene is no longer, corner to corner, than the period [0, 0] */
    double omega;           /* rad/s, constant rate of turning, counter-clockwise; not with a table or a load [0] */
    const double *knot_angle; /* rad, shape (n_knots), counter-clockwise, as knot_x; knot_x and knot_y may then both be NULL,
                               for none. NULL: the table does not turn the plate [NULL] */
    double surface_velocity; /* m/s, along the line from its first point to its last, of the wall's surface alone, which
                               stays where it is: a belt, a turning roll. Not with GP_WALL_FREE_SLIP [0] */
    int32_t fluidity;       /* GP_FLUIDITY_..., of materials with nonlocal_amplitude [GP_FLUIDITY_FREE] */
} gp_plate;

/* What a plate does to the granular fluidity of the material in front of it. */
enum {
    GP_FLUIDITY_FREE = 0, /* no flux: its gradient along the normal is 0 */
    GP_FLUIDITY_ZERO = 1  /* it is 0 at the surface: grains glued to the plate hold their neighbours */
};

/* Fills *plate with a fixed no-slip plate: its ends have to be set. size: sizeof(gp_plate). */
GP_API gp_status gp_plate_init(gp_plate *plate, size_t size);

/* -------------------------------------------------------------------------------------------------- scene */

typedef struct gp_sim gp_sim;

/* Creates an empty simulation; *sim is NULL on error. */
GP_API gp_status gp_create(const gp_config *config, gp_sim **sim);

/* Frees it, closing its output. NULL is fine. Ignored when called from inside its own callback. */
GP_API void gp_destroy(gp_sim *sim);

/* The calls that add to the scene are possible until the first step and while no output is open (nor after it, if a plate or
 * gravity was set while it was); else GP_E_STATE.
 * id: receives the new object's number, counted from 0 per kind; may be NULL.
 * Material 0 (glass beads) exists from the start, so the first added one is 1. Columns and sets of particles share
 * one count: it is the value of the field GP_FIELD_COLUMN. */
GP_API gp_status gp_add_material(gp_sim *sim, const gp_material *material, int32_t *id);

/* A rectangle of particles on the lattice of the spacing, the first half a spacing inside its corner. */
GP_API gp_status gp_add_column(gp_sim *sim, const gp_column *column, int32_t *id);

/* n >= 1 particles of any shape, each of the area spacing^2. x, y: shape (n), m; vx, vy: shape (n), m/s, or NULL for rest. */
GP_API gp_status gp_add_particles(gp_sim *sim, int32_t material, int64_t n, const double *x, const double *y,
                                  const double *vx, const double *vy, int32_t *id);

/* A floor, wall, gate or lid. Its table of displacements is copied. */
GP_API gp_status gp_add_plate(gp_sim *sim, const gp_plate *plate, int32_t *id);

/* The host drives the plate at this velocity (m/s) from now on, from where it is; replaces constant velocity or table.
 * Possible at any time, also from a callback. Before the first step, and while no output is open, it is the scene's. */
GP_API gp_status gp_set_plate_velocity(gp_sim *sim, int32_t plate, double vx, double vy);

/* The same for any rigid motion: the plate's pivot moves at (vx, vy), m/s, and the plate turns about it at omega, rad/s,
 * counter-clockwise. gp_set_plate_velocity is this with omega 0. A loaded plate does not turn: GP_E_ARGUMENT. */
GP_API gp_status gp_set_plate_motion(gp_sim *sim, int32_t plate, double vx, double vy, double omega);

/* Gravity (m/s2) from now on, for a box that is tilted or shaken, in its own frame, or gravity that sets in or ends. Finite.
 * Possible at any time, also from a callback, with every scheme. Before the first step, and while no output is open, it
 * replaces gp_config.gravity_x and gravity_y: columns begin in balance with it and the sound speed is made for it. After it
 *   - stresses and velocities are what they were: a jump makes elastic waves as a blow does. Turning it by small angles, such
 *     as once per step or per 0.1 degrees, does not;
 *   - gp_state.potential goes on without a jump, so that the energy ledger closes;
 *   - gp_state.at_rest is 0 for some 90 steps at least. Setting what it is already changes nothing;
 *   - the sound speed stays: gp_set_log warns if the scene can now fall so fast that it compresses by more than 3 %; then set
 *     gp_config.sound_speed, 0 is made for the first gravity alone.
 * Costs about a twentieth of a step. gp_save keeps it. Result files have it frame by frame (gp_state.gravity_x, gravity_y). */
GP_API gp_status gp_set_gravity(gp_sim *sim, double gx, double gy);

/* ------------------------------------------------------------------------------------------------ running */

/* Takes n time steps; n >= 0. GP_STOPPED if the callback stopped it. A scene without particles only counts time. A
 * step that GP_E_MEMORY stops is undone and may be taken again, to the same bits (the order of views may be new); after
 * GP_E_IO or GP_E_MEMORY of an output that writes by itself, or of the log's texts, the step is complete, the frame or text is
 * lost and the run may go on: gp_state.step tells.
 *
 * A step is GP_E_DIVERGED, and its text names stage, field, particle, position, time and step, where
 *   - a density, a stress or an acceleration is not a finite number;
 *   - a density is negative or twice the material's own (a blow as fast as sound makes it so);
 *   - in the step a particle would move by more than a spacing by its acceleration, or against another particle or plate
 *     (this with a time_step; steps that the library chooses are shortened instead);
 *   - the flow asks for steps below 1/128 of spacing / wave speed: speeds differ by 32 wave speeds. At the first step this is
 *     GP_E_ARGUMENT: the sound_speed is wrong for the scene.
 * It is found before anything moves, and the step is undone: fields, their order, clock, energies, plates and loads have the
 * bits of the last good step. But GP_FIELD_NUMBER_DENSITY may differ by rounding, gp_state.volume_drift by the ghosts that are
 * seen anew (by some .001), and in a periodic scene particles that have just returned into the period stay there and the order
 * is new.
 *
 * With gp_config.retry_halvings a step that diverges is undone and taken as two steps of half its size, one after the other,
 * each of which is halved likewise if it diverges, up to that many times. Each of them is a whole step to the counter, the
 * callback and the output, with GP_DT_RETRY in gp_state.dt_reason; what is undone nobody sees. After the two halves the
 * size is chosen as always. Speeds that ask for too small a step are not retried: the step begins with them.
 *
 * Sleep. With gp_config.sleep = 1 material that rests is left out of the work, in spans of about 32 particles, those in 16 dl
 * by 2 dl of the plane: each of them has gone no more than 0.05 spacing dl within 8 sqrt(dl / g) (a mean speed of 0.006 sqrt(g
 * dl)), their mean stress has changed by less than 2 % of the pressure and of rho g dl, the wave that would go out if they
 * stopped is half of that at most, and all spans that see them, within the horizon, are as quiet. Then their velocity is 0,
 * density and stress stay as they are, and plates go on to bear their mean load; neighbours see them as ever, and what presses
 * them less than the above is held, as by friction at rest. What
 * of their motion is left counts as dissipated, 1e-9 of a deposit's energy. They wake, at the latest in the step in which they
 * would feel it, when what is within the horizon moves or changes its stress by more than that; when a plate that they see moves,
 * turns, runs as a belt or is loaded; and all of them by gp_set_gravity. Beside a loaded plate and a belt nothing sleeps, nor
 * without gravity. Up to the first sleep the bits are those without it. gp_state.n_awake tells how many are awake, gp_get_plan
 * which stages have nothing to do. */
GP_API gp_status gp_step(gp_sim *sim, int64_t n);

/* Steps until the clock shows t_end (s) exactly; the last steps are shortened to land on it. t_end earlier than the
 * clock is GP_E_ARGUMENT, equal to it does nothing. Otherwise as gp_step.
 *
 * Looks on the way must not be ends: each end is another run, in which single grains come to rest elsewhere. Frames of an
 * output, and gp_run to the same t_end again after a callback has stopped it, leave all steps as long as they are:
 *
 *     int32_t is_due(void *due, gp_sim *sim) {
 *         double time, dt;
 *         gp_get_clock(sim, &time, &dt, NULL);
 *         return time + 1e-9 * dt >= *(double *)due;
 *     } */
GP_API gp_status gp_run(gp_sim *sim, double t_end);

/* Called after every `every`-th step in the thread that runs gp_step or gp_run; a non-zero return stops the run. */
typedef int32_t (*gp_callback)(void *user, gp_sim *sim);

/* every >= 1; callback NULL removes it (every is then not read). */
GP_API gp_status gp_set_callback(gp_sim *sim, int64_t every, gp_callback callback, void *user);

enum { GP_LOG_INFO = 0, GP_LOG_WARNING = 1 };

/* text is valid during the call only. The library may not be called from inside it. */
typedef void (*gp_log)(void *user, int32_t level, const char *text);

/* log NULL: silent, as at the start. What is doubtful but no error is a GP_LOG_WARNING, each kind once per simulation, with
 * its figure and with what to change. At the first step:
 *   - a plate with material only on the side of its body; material within a horizon and a spacing behind a plate that no other
 *     plate faces, or across its line;
 *   - a column or set of particles more than half of which has nothing below it in the direction of gravity, neither a plate
 *     that faces it nor a column that is borne; a scene without material;
 *   - a sound_speed that nothing sets or below the speeds that the scene can reach, particles within a quarter spacing of a
 *     plate's line or of each other within half a spacing, a column thinner than 3 spacings, a time step beyond the stable limit;
 *   - a material with nonlocal_amplitude and a spacing of more than half of its grain_diameter.
 * Later: gravity for which the sound speed is too low (gp_set_gravity), a step taken anew, compression above 3 % of a fifth of the particles or above 9 % of any (not of the schemes of [1]),
 * a plate in reach of material at more than 0.3 sound speeds, and, looked at every 64 steps, a particle behind a plate,
 * particles that fall below all plates, more than 10 % of the dissipation by the zero-energy penalty, an energy error above 2 %
 * of the largest energy in the ledger and, every 1024 steps, particles that lie more than 2 % closer than their density says
 * where at least a fifth of them flow (gp_state.volume_drift; these three not of the schemes of [1]).
 * A GP_LOG_INFO at the first step: a sound_speed that a blow sets, and the one that saves its cost. */
GP_API gp_status gp_set_log(gp_sim *sim, gp_log log, void *user);

/* ------------------------------------------------------------------------------------------------ reading */

/* Bits of the particle fields. */
#define GP_FIELD_ID (1u << 0)
#define GP_FIELD_COLUMN (1u << 1)
#define GP_FIELD_X (1u << 2)
#define GP_FIELD_Y (1u << 3)
#define GP_FIELD_VX (1u << 4)
#define GP_FIELD_VY (1u << 5)
#define GP_FIELD_PRESSURE (1u << 6)
#define GP_FIELD_DENSITY (1u << 7)
#define GP_FIELD_SXX (1u << 8)
#define GP_FIELD_SXY (1u << 9)
#define GP_FIELD_SYY (1u << 10)
#define GP_FIELD_SHEAR_RATE (1u << 11)
#define GP_FIELD_INERTIAL_NUMBER (1u << 12)
#define GP_FIELD_VISCOSITY (1u << 13)
#define GP_FIELD_NUMBER_DENSITY (1u << 14)
#define GP_FIELD_FLUIDITY (1u << 15)
#define GP_FIELD_POSITION (GP_FIELD_X | GP_FIELD_Y)
#define GP_FIELD_VELOCITY (GP_FIELD_VX | GP_FIELD_VY)
#define GP_FIELD_ALL ((1u << 16) - 1u)

typedef struct gp_particles {
    uint32_t struct_size;   /* set by the caller */
    int64_t count;          /* number of particles n; every array has the shape (n) */
    uint64_t epoch;         /* number of changes to the simulation so far: a view is valid while it is the same */
    const int64_t *id;      /* counted from 0 in the order in which particles were added */
    const int32_t *column;  /* id of the column or set of particles it came with */
    const double *x, *y;    /* m */
    const double *vx, *vy;  /* m/s */
    const double *pressure; /* Pa, p >= 0 */
    const double *density;  /* kg/m3; with GP_DENSITY_NUMBER rho0 N / N0 */
    const double *sxx, *sxy, *syy;  /* Pa, deviatoric stress s: the Cauchy stress is s - p 1, and sxx + syy = 0; with
                                       GP_STRESS_REGULARIZED eta_r D, whose trace is not 0 */
    const double *shear_rate;       /* 1/s, |gamma| = sqrt(D:D / 2), D = (L + L^T)/2 ([1] 3.3) */
    const double *inertial_number;  /* I = 2 d |gamma| / sqrt(p / rho_s) ([1] 3.4), by the pressure of this moment; 0 where
                                       p = 0. In the default scheme the material's friction goes by a mean of the
                                       pressure over 100 dl / c0, not that of plates, nor with nonlocal_amplitude */
    const double *viscosity;        /* Pa s, tau / sqrt(|gamma|^2 + delta^2), tau = sqrt(s:s / 2); or eta_r ([1] 3.6) */
    const double *number_density;   /* N = sum of w over the neighbours within interaction_radius ([1] 2.4); with
                                       GP_DENSITY_NUMBER the scheme's own, with the ghosts behind plates */
    const double *fluidity;         /* 1/s, g: the plastic shear rate 2 |gamma| over tau / p; 0 without
                                       gp_material.nonlocal_amplitude */
} gp_particles;

/* Read-only views of the asked fields (GP_FIELD_... or-ed), in the library's own order, which changes from step to
 * step: use id. Fields not asked for are NULL. Valid until the next call that changes the simulation. */
GP_API gp_status gp_get_particles(gp_sim *sim, uint32_t fields, gp_particles *particles);

/* One field (exactly one bit), converted to double, in the order of id. n: length of dst, equal to the count. */
GP_API gp_status gp_copy_field(gp_sim *sim, uint32_t field, double *dst, int64_t n);

/* What set the time step. */
enum {
    GP_DT_NONE = 0,      /* no step taken yet */
    GP_DT_SOUND = 1,     /* elastic waves: cfl dl / wave speed; less where the scene's materials differ in density: the
                            lighter is pushed by the stiffness of the heavier (from a ratio of 9 to 10 on) */
    GP_DT_FLOW = 2,      /* relative motion: of the scheme's own step .06 spacings, but not below .42 of gp_state.dt_limit
                            (gp_config.cfl); of any, a quarter spacing per step */
    GP_DT_PLATE = 3,     /* the inertia of a loaded plate */
    GP_DT_VISCOSITY = 4, /* bulk_viscosity, zero_energy_penalty or density_diffusion */
    GP_DT_DEMANDED = 5,  /* gp_config.time_step */
    GP_DT_END = 6,       /* shortened to land on the t_end of gp_run */
    GP_DT_RETRY = 7      /* what is left of a step that diverged, halved (gp_config.retry_halvings) */
};

typedef struct gp_state {
    uint32_t struct_size; /* set by the caller */
    double time;          /* s */
    int64_t step;         /* steps taken */
    double dt;            /* s, last time step */
    int64_t n_particles;  /* how many there are */
    int64_t n_awake;      /* particles that take part in the work: all of them but for those that sleep (gp_config.sleep) */
    /* Energy ledger, J per metre of depth: the initial kinetic + potential + elastic energy equals
     * kinetic + potential + elastic + dissipated + plate_work + energy_error. */
    double kinetic;
    double potential;     /* gravitational, zero at the lowest face of the initial material. gp_set_gravity leaves it as it is:
                             from there on it is less by what the new gravity has done, and may fall below 0 */
    double elastic;       /* of compression and shear */
    double dissipated;    /* by friction, collisions, walls and the scheme itself */
    double plate_work;    /* done by the material on moving plates */
    double energy_error;  /* what the ledger does not account for: error of the time integration; in the schemes of [1]
                             also that of their operators, which are not adjoint: several per cent of the energy,
                             and at rest more and more of it is dissipated on paper alone (below 0) */
    double momentum_x, momentum_y; /* kg/s: kg m/s per metre of depth */
    double max_speed, rms_speed;   /* m/s */
    double x_left, x_right;        /* m, fronts of the connected deposit: the largest set of particles each within
                                      1.6 dl of another, half a spacing added */
    double peak_x, peak_height;    /* m, highest point of its surface: x, and y (an absolute coordinate). Extrapolated from
                                      the surface smoothed over 6 and 3 dl to one that is not: without bias at a cusp, on a
                                      plateau, and beside walls. Single grains scatter it by some 0.3 dl. Of a deposit too
                                      thin for that, and by itself in space, the highest of gp_get_surface */
    double max_pressure;           /* Pa */
    int32_t at_rest;               /* 1: the material has come to rest: the kinetic energy is below 1e-6 of the scene's
                                      energy scale, the plastic power of the last step would dissipate less than 1e-4 of it
                                      in the scene's free-fall time, and no more than 1 % of the mass is accelerated by
                                      more than 0.05 g, on average over some 20 steps (single grains at yield, at tips and
                                      surfaces, may push each other; of fewer than 200 particles two, but no more than 5 %
                                      of the mass).
                                      And no plate has motion of its own left (a velocity or a turn, also of
                                      gp_set_plate_motion, a belt, or knots that displace it further) that is within the horizon
                                      of the box around all particles, or will come so near on its way, as straight lines
                                      between here and the farthest places that it comes to have it; a plate under a load
                                      there rests itself: its kinetic energy is below the same 1e-6, and the material bears
                                      its load within 5 %.
                                      The energy scale is the largest of the initial energy of the ledger and the
                                      largest kinetic energy so far; after gp_set_gravity the energy then, with the potential
                                      from the lowest face of the material on, and the largest kinetic energy since */
    int64_t collisions;            /* colliding pairs so far ([1] 2.9), each step's counted anew; with them half of the pairs
                                      that are as close and approach, but of which only one particle flows */
    double wall_seconds;           /* s of wall-clock time inside the steps so far */
    double sound_speed;            /* m/s, c0 in use */
    double penalty_dissipated;     /* J/m, the part of dissipated that the zero-energy penalty took, and with
                                      GP_STRESS_IMPLICIT the like of it in the solve */
    double wall_dissipated;        /* J/m, the part taken at plates beyond the material's own: by the extrapolation, of either
                                      sign, and by the friction of rough plates */
    double diffusion_dissipated;   /* J/m, the part that density diffusion took */
    double bulk_dissipated;        /* J/m, the part that the bulk viscosity took */
    double collision_dissipated;   /* J/m, the part that collisions took */
    double channel_dissipated;     /* J/m, the part that the friction of side walls took */
    int32_t dt_reason;             /* GP_DT_...: what set dt */
    int32_t implicit_last;         /* Newton steps of the last step's solve; this and the next four with
                                      GP_STRESS_IMPLICIT only, else 0 */
    int64_t implicit_newton;       /* Newton steps so far */
    int64_t implicit_linear;       /* iterations of conjugate gradients so far */
    int64_t implicit_failures;     /* solves that did not converge, so far: each is GP_E_DIVERGED or a retry */
    double implicit_residual;      /* of the last solve, as gp_config.implicit_tolerance */
    int64_t retries;               /* steps undone and taken anew so far (gp_config.retry_halvings) */
    double dt_limit;               /* s, the largest time_step that is stable for this scene: for waves, loaded plates and the
                                      coefficients that damp, not for the flow */
    double max_compression;        /* largest density over the material's own so far, less 1 */
    double spacing_dissipated;     /* J/m, the part that making the density follow the spacing of the particles took: below 0,
                                      it compresses what flows */
    /* Marks of the mass, m: x_q05 has 5 % of the mass on its left, and so on, all of the material, detached grains too.
     * Each particle's mass is spread evenly over one spacing in x, so a column from 0 to L has its marks at .01 L, .05 L,
     * ...; where a mark falls into a gap it is the gap's middle. In a periodic scene what reaches beyond an end of the
     * period counts at the other. Unlike the fronts x_left and x_right, which single grains set, they converge with the
     * spacing. 0 without particles, as the next four */
    double x_q01, x_q05, x_q25, x_q50, x_q75, x_q95, x_q99;
    double centre_x, centre_y;     /* m, centre of mass */
    double detached;               /* share of the mass outside of the connected deposit (of x_left), 0 .. 1: what x_left,
                                      x_right and the peak do not know of */
    double volume_drift;           /* mean number density where the material flows over that at the start, less 1: above 0 it
                                      has lost volume, whatever its density says. Number density: sum of
                                      (1 - r^2 / R^2)^2 over a particle and its neighbours within the horizon R, ghosts
                                      behind plates included. Flows: at yield, under pressure, and sheared by more than
                                      0.01 in the scene's free-fall time. Only particles whose horizon is full count (a
                                      neighbour in each eighth of its outermost 1.25 dl), so free surfaces have no part in
                                      it; at the start all of these, of the lattice if there are none. 0 where nothing
                                      flows. Layers that keep their height stay within .01; what topples and spreads opens
                                      up, by some 0.5 dl / height. Above .02 gp_set_log warns */
    double gravity_x, gravity_y;   /* m/s2, in force from here on */
} gp_state;

/* Parts of gp_state that take time to find. */
enum {
    GP_STATE_DEPOSIT = 1, /* x_left, x_right, peak_x, peak_height, detached */
    GP_STATE_MARKS = 2,   /* x_q01 .. x_q99 */
    GP_STATE_DRIFT = 4,   /* volume_drift */
    GP_STATE_ALL = 7
};

/* The state at this instant; state->struct_size has to be set. It costs as much as 1.5 to 2.5 time steps (10 000 to 600
 * particles; with fewer more: 5 with 160); a second call without a step between costs nothing. */
GP_API gp_status gp_get_state(gp_sim *sim, gp_state *state);

/* The same with these parts only, GP_STATE_... bits or 0: the fields of the others are NaN. Clock, ledger, momentum, speeds,
 * max_pressure, at_rest, counters and the centre of mass are always there: these cost 4 to 5 % of a time step,
 * GP_STATE_DEPOSIT 60 to 150 %, GP_STATE_MARKS 10 to 20 %, GP_STATE_DRIFT 50 to 75 % where all flows (from 600 particles on). */
GP_API gp_status gp_get_state_parts(gp_sim *sim, uint32_t parts, gp_state *state);

/* The clock alone, which costs nothing: *time (s), *dt (s, of the last step; 0 before the first) and *step (steps taken) as in
 * gp_state. Any of the pointers may be NULL. */
GP_API gp_status gp_get_clock(gp_sim *sim, double *time, double *dt, int64_t *step);

/* Free surface of the connected deposit: height[k] is the largest y at x[k] where the smoothed volume fraction (radius 2 dl)
 * is 1/2, or half of the largest one at x[k] where that stays below 0.9 (at fronts); 0 outside the fronts. Beside plates the
 * material counts as mirrored in them, and that behind them does not count. The smoothing takes half a dl times the slope off
 * a cusp, also off one that a wall makes of a slope. x, height: shape (n), m. n >= 0. */
GP_API gp_status gp_get_surface(gp_sim *sim, int64_t n, const double *x, double *height);

/* Interface of two columns: x[k] separates the particles of `left` from those of `right` in the row of height
 * 2 dl about y[k] with the fewest on the wrong side; NaN where they do not touch. left, right: ids of columns or sets of
 * particles. y, x: shape (n), m. */
GP_API gp_status gp_get_interface(gp_sim *sim, int32_t left, int32_t right, int64_t n, const double *y, double *x);

typedef struct gp_load {
    uint32_t struct_size; /* set by the caller */
    double fx, fy;        /* N/m, force of the material on the plate over the last step */
    double torque;        /* N, its moment about the plate's first point, counter-clockwise */
    double dx, dy;        /* m, displacement of the plate, where it turns of its pivot, since the start */
    double impulse_x, impulse_y; /* N s/m, integral of fx and fy over time since the start */
    double torque_pivot;  /* N, moment of the force about the plate's pivot, counter-clockwise */
    double angle;         /* rad, by which it has turned since the start */
    double impulse_torque; /* N s, integral of torque_pivot over time since the start */
} gp_load;

/* What the material does to a plate, and where the plate has got to; load->struct_size has to be set. */
GP_API gp_status gp_get_plate_load(gp_sim *sim, int32_t plate, gp_load *load);

typedef struct gp_plan_entry {
    const char *name;   /* static text */
    const char *reason; /* static text: why it is active or left out */
    int32_t kind;       /* 0: stage, in the order in which they run; 1: field or table; 2: between processes (gp_mpi.h) */
    int32_t active;     /* 1, or 0 if this scene leaves it out */
    int64_t bytes;      /* of memory held; 0 for a stage */
    double seconds;     /* wall-clock time spent so far; 0 for a field */
    int64_t calls;      /* times run so far; 0 for a field */
    int64_t reserved[2];
} gp_plan_entry;

/* What the engine does for this scene and what it leaves out. Fills up to n entries; *n_out receives how many there
 * are in all, so a first call with n = 0 and entries = NULL tells the size. */
GP_API gp_status gp_get_plan(gp_sim *sim, int64_t n, gp_plan_entry *entries, int64_t *n_out);

/* -------------------------------------------------------------------------------------------------- files */

/* Checkpoint: gp_save writes all of a simulation to one file, from which gp_load makes another one that goes on with the
 * same bits: in another process, with any number of threads, on a processor with the same instruction sets (docs/trust.md).
 *
 * Saved are config, materials, columns, particles and plates with their motion, the state of the engine, energies, loads,
 * counters, which warnings were given, and where the open output stands. Not saved are the host's own: callback and log,
 * which are to be set again; an open output, which is to be opened again with gp_output.append = 1; the counters of
 * gp_get_plan begin anew. gp_config.threads is saved: with 0 it is the default of the new process.
 *
 * gp_save only reads: epoch and views stay as they are. It may be called before the first step, after GP_E_DIVERGED (what is
 * loaded can be read and saved, too, not stepped) and inside the callback, where the step is complete. The file
 * is written beside its place as <path>.part-<process>-<number>, synced and renamed: whatever
 * happens, path is the new checkpoint or the one before. A program that is killed may leave the part, to be deleted. After
 * GP_E_IO (disk full, no such directory, ...) the old file is there as before, and the simulation can go on or be saved
 * elsewhere. The file has about 133 bytes per particle (125 where mu_2 = mu_s), 96 more with sleep = 1, and 32 more for those of
 * gp_add_particles; it takes no memory to speak of.
 *
 * gp_load refuses a file that is cut off, damaged (the file has a checksum) or not a checkpoint: GP_E_IO; one in another
 * format, as those of 0.1 are: GP_E_VERSION; *sim is then NULL. A checkpoint is for the version of the library that wrote it;
 * another one may load it, if it has the format, but with other bits from there on. Both are GP_E_UNSUPPORTED in a build
 * without HDF5.
 *
 * C has one name space for types and functions, and gp_load is also the type above: hence a macro over the function
 * gp_load_file (binaries also export it as gp_load). */
GP_API gp_status gp_save(gp_sim *sim, const char *path);
GP_API gp_status gp_load_file(const char *path, gp_sim **sim);
#define gp_load(path, sim) gp_load_file((path), (sim))

typedef struct gp_output {
    uint32_t struct_size;
    double every_seconds;     /* s; > 0: a frame at the start and after the first step at or past each multiple;
                                 0: only by gp_output_write [0] */
    uint32_t fields;          /* GP_FIELD_...; x and y come together, so do vx and vy; id and position are always written
                                 [position, velocity, pressure, shear_rate, column] */
    int32_t compression;      /* deflate level, 0 .. 9 [4] */
    int32_t single_precision; /* 1: floating-point fields as 32 bits [0]. Times, the state and positions stay 64; positions are
                                 rounded to 1e-5 spacings, wherever they are, which compresses as well as 32 bits */
    int64_t append;           /* 1: an existing file of this simulation is continued, see gp_output_open; 0: it is replaced
                                 [0] */
} gp_output;

/* Fills *output with the defaults. size: sizeof(gp_output). */
GP_API gp_status gp_output_init(gp_output *output, size_t size);

/* Creates the HDF5 file `path` (H5MD layout, an existing one is replaced) and beside it an XDMF file (path with its
 * extension replaced by .xdmf) for ParaView. Every completed frame survives a crash of the program. output NULL: the
 * defaults. One output at a time: GP_E_STATE if one is open.
 *
 * With append = 1 the file has to exist, with the same particles, fields and precision: GP_E_IO if it does not. Frames
 * that are later than the simulation are removed from it, and the next ones follow without a gap or a double:
 *   - right after gp_load, if the file was open at gp_save: the file goes back to the frames that it had then, and the next
 *     one is due when it was due then. GP_E_IO if some of them are missing;
 *   - else frames of later steps are removed, and the next one is due at the next multiple of every_seconds.
 * No frame is written at the start. The file is written anew beside its place and renamed: until then it is as it was.
 * After gp_load the file that was open at gp_save is not replaced: with append = 0 this is GP_E_STATE. */
GP_API gp_status gp_output_open(gp_sim *sim, const char *path, const gp_output *output);

/* Writes a frame of the present state; GP_E_STATE if no output is open. */
GP_API gp_status gp_output_write(gp_sim *sim);

/* Closes the output; GP_E_STATE if none is open. The file is closed also when this returns GP_E_IO. */
GP_API gp_status gp_output_close(gp_sim *sim);

#ifdef __cplusplus
}
#endif

#endif
