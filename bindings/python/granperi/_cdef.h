/* Written by bindings/generate from include/granperi/gp.h. Do not edit. */

#define GP_VERSION_MAJOR 0
#define GP_VERSION_MINOR 2
#define GP_VERSION_PATCH 0

typedef int32_t gp_status;

enum {
    GP_OK = 0,
    GP_STOPPED = 1,
    GP_E_ARGUMENT = -1,
    GP_E_STATE = -2,
    GP_E_MEMORY = -3,
    GP_E_IO = -4,
    GP_E_DIVERGED = -5,
    GP_E_UNSUPPORTED = -6,
    GP_E_VERSION = -7,
    GP_E_INTERNAL = -8
};

const char *gp_status_string(gp_status status);

const char *gp_last_error(void);

uint32_t gp_version(void);

const char *gp_version_string(void);

int32_t gp_has_feature(const char *name);

enum {
    GP_PRESET_DEFAULT = 0,
    GP_PRESET_PAPER = 1,
    GP_PRESET_PAPER_LOCAL = 2
};

enum {
    GP_STRESS_ELASTIC = 0,
    GP_STRESS_REGULARIZED = 1,
    GP_STRESS_IMPLICIT = 2
};

enum {
    GP_DENSITY_CONTINUITY = 0,
    GP_DENSITY_NUMBER = 1
};

typedef struct gp_config {
    uint32_t struct_size;
    double spacing;
    double gravity_x;
    double gravity_y;
    double sound_speed;
    double cfl;
    double time_step;
    double interaction_radius;
    double horizon;
    double horizon_length;
    int32_t nonlocal;
    int32_t stress;
    int32_t density;
    double friction_factor;
    double delta;
    double collision_distance;
    double zero_energy_penalty;
    double density_diffusion;
    double channel_width;
    double channel_friction;
    double periodic_x_min;
    double periodic_x_max;
    int32_t threads;
    uint64_t seed;
    double jitter;
    int32_t preset;
    double bulk_viscosity;
    double implicit_tolerance;
    int32_t implicit_iterations;
    int32_t allow_unstable_step;
    int32_t retry_halvings;
    int64_t sleep;
} gp_config;

gp_status gp_config_init(gp_config *config, size_t size, int32_t preset);

typedef struct gp_material {
    uint32_t struct_size;
    double grain_density;
    double volume_fraction;
    double grain_diameter;
    double mu_s;
    double mu_2;
    double i0;
    double nonlocal_amplitude;
    double fluidity_time;
    double k0;
} gp_material;

gp_status gp_material_init(gp_material *material, size_t size);

enum {
    GP_INITIAL_HYDROSTATIC = 0,
    GP_INITIAL_NONE = 1
};

typedef struct gp_column {
    uint32_t struct_size;
    double x_min;
    double y_min;
    double width;
    double height;
    int32_t material;
    double vx;
    double vy;
    int32_t initial_pressure;
} gp_column;

gp_status gp_column_init(gp_column *column, size_t size);

enum {
    GP_WALL_NO_SLIP = 0,
    GP_WALL_FREE_SLIP = 1,
    GP_WALL_COULOMB = 2
};

typedef struct gp_plate {
    uint32_t struct_size;
    double x0;
    double y0;
    double x1;
    double y1;
    int32_t friction;
    double wall_mu;
    double vx;
    double vy;
    int64_t n_knots;
    const double *knot_t;
    const double *knot_x;
    const double *knot_y;
    double normal_pressure;
    double mass_per_length;
    int64_t n_points;
    const double *point_x;
    const double *point_y;
    double pivot_x;
    double pivot_y;
    double omega;
    const double *knot_angle;
    double surface_velocity;
    int32_t fluidity;
} gp_plate;

enum {
    GP_FLUIDITY_FREE = 0,
    GP_FLUIDITY_ZERO = 1
};

gp_status gp_plate_init(gp_plate *plate, size_t size);

typedef struct gp_sim gp_sim;

gp_status gp_create(const gp_config *config, gp_sim **sim);

void gp_destroy(gp_sim *sim);

gp_status gp_add_material(gp_sim *sim, const gp_material *material, int32_t *id);

gp_status gp_add_column(gp_sim *sim, const gp_column *column, int32_t *id);

gp_status gp_add_particles(gp_sim *sim, int32_t material, int64_t n, const double *x, const double *y, const double *vx, const double *vy, int32_t *id);

gp_status gp_add_plate(gp_sim *sim, const gp_plate *plate, int32_t *id);

gp_status gp_set_plate_velocity(gp_sim *sim, int32_t plate, double vx, double vy);

gp_status gp_set_plate_motion(gp_sim *sim, int32_t plate, double vx, double vy, double omega);

gp_status gp_set_gravity(gp_sim *sim, double gx, double gy);

gp_status gp_step(gp_sim *sim, int64_t n);

gp_status gp_run(gp_sim *sim, double t_end);

typedef int32_t (*gp_callback)(void *user, gp_sim *sim);

gp_status gp_set_callback(gp_sim *sim, int64_t every, gp_callback callback, void *user);

enum {
    GP_LOG_INFO = 0,
    GP_LOG_WARNING = 1
};

typedef void (*gp_log)(void *user, int32_t level, const char *text);

gp_status gp_set_log(gp_sim *sim, gp_log log, void *user);

#define GP_FIELD_ID 1
#define GP_FIELD_COLUMN 2
#define GP_FIELD_X 4
#define GP_FIELD_Y 8
#define GP_FIELD_VX 16
#define GP_FIELD_VY 32
#define GP_FIELD_PRESSURE 64
#define GP_FIELD_DENSITY 128
#define GP_FIELD_SXX 256
#define GP_FIELD_SXY 512
#define GP_FIELD_SYY 1024
#define GP_FIELD_SHEAR_RATE 2048
#define GP_FIELD_INERTIAL_NUMBER 4096
#define GP_FIELD_VISCOSITY 8192
#define GP_FIELD_NUMBER_DENSITY 16384
#define GP_FIELD_FLUIDITY 32768
#define GP_FIELD_POSITION 12
#define GP_FIELD_VELOCITY 48
#define GP_FIELD_ALL 65535

typedef struct gp_particles {
    uint32_t struct_size;
    int64_t count;
    uint64_t epoch;
    const int64_t *id;
    const int32_t *column;
    const double *x;
    const double *y;
    const double *vx;
    const double *vy;
    const double *pressure;
    const double *density;
    const double *sxx;
    const double *sxy;
    const double *syy;
    const double *shear_rate;
    const double *inertial_number;
    const double *viscosity;
    const double *number_density;
    const double *fluidity;
} gp_particles;

gp_status gp_get_particles(gp_sim *sim, uint32_t fields, gp_particles *particles);

gp_status gp_copy_field(gp_sim *sim, uint32_t field, double *dst, int64_t n);

enum {
    GP_DT_NONE = 0,
    GP_DT_SOUND = 1,
    GP_DT_FLOW = 2,
    GP_DT_PLATE = 3,
    GP_DT_VISCOSITY = 4,
    GP_DT_DEMANDED = 5,
    GP_DT_END = 6,
    GP_DT_RETRY = 7
};

typedef struct gp_state {
    uint32_t struct_size;
    double time;
    int64_t step;
    double dt;
    int64_t n_particles;
    int64_t n_awake;
    double kinetic;
    double potential;
    double elastic;
    double dissipated;
    double plate_work;
    double energy_error;
    double momentum_x;
    double momentum_y;
    double max_speed;
    double rms_speed;
    double x_left;
    double x_right;
    double peak_x;
    double peak_height;
    double max_pressure;
    int32_t at_rest;
    int64_t collisions;
    double wall_seconds;
    double sound_speed;
    double penalty_dissipated;
    double wall_dissipated;
    double diffusion_dissipated;
    double bulk_dissipated;
    double collision_dissipated;
    double channel_dissipated;
    int32_t dt_reason;
    int32_t implicit_last;
    int64_t implicit_newton;
    int64_t implicit_linear;
    int64_t implicit_failures;
    double implicit_residual;
    int64_t retries;
    double dt_limit;
    double max_compression;
    double spacing_dissipated;
    double x_q01;
    double x_q05;
    double x_q25;
    double x_q50;
    double x_q75;
    double x_q95;
    double x_q99;
    double centre_x;
    double centre_y;
    double detached;
    double volume_drift;
    double gravity_x;
    double gravity_y;
} gp_state;

enum {
    GP_STATE_DEPOSIT = 1,
    GP_STATE_MARKS = 2,
    GP_STATE_DRIFT = 4,
    GP_STATE_ALL = 7
};

gp_status gp_get_state(gp_sim *sim, gp_state *state);

gp_status gp_get_state_parts(gp_sim *sim, uint32_t parts, gp_state *state);

gp_status gp_get_clock(gp_sim *sim, double *time, double *dt, int64_t *step);

gp_status gp_get_surface(gp_sim *sim, int64_t n, const double *x, double *height);

gp_status gp_get_interface(gp_sim *sim, int32_t left, int32_t right, int64_t n, const double *y, double *x);

typedef struct gp_load {
    uint32_t struct_size;
    double fx;
    double fy;
    double torque;
    double dx;
    double dy;
    double impulse_x;
    double impulse_y;
    double torque_pivot;
    double angle;
    double impulse_torque;
} gp_load;

gp_status gp_get_plate_load(gp_sim *sim, int32_t plate, gp_load *load);

typedef struct gp_plan_entry {
    const char *name;
    const char *reason;
    int32_t kind;
    int32_t active;
    int64_t bytes;
    double seconds;
    int64_t calls;
    int64_t reserved[2];
} gp_plan_entry;

gp_status gp_get_plan(gp_sim *sim, int64_t n, gp_plan_entry *entries, int64_t *n_out);

gp_status gp_save(gp_sim *sim, const char *path);

gp_status gp_load_file(const char *path, gp_sim **sim);

typedef struct gp_output {
    uint32_t struct_size;
    double every_seconds;
    uint32_t fields;
    int32_t compression;
    int32_t single_precision;
    int64_t append;
} gp_output;

gp_status gp_output_init(gp_output *output, size_t size);

gp_status gp_output_open(gp_sim *sim, const char *path, const gp_output *output);

gp_status gp_output_write(gp_sim *sim);

gp_status gp_output_close(gp_sim *sim);
