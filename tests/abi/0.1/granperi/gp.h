/* The header of 0.1.0 without its comments: what programs were compiled with that have to go on working. */
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
#define GP_VERSION_MINOR 1
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

GP_API const char *gp_status_string(gp_status status);

GP_API const char *gp_last_error(void);

GP_API uint32_t gp_version(void);

GP_API const char *gp_version_string(void);

GP_API int32_t gp_has_feature(const char *name);

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
} gp_config;

GP_API gp_status gp_config_init(gp_config *config, size_t size, int32_t preset);

typedef struct gp_material {
    uint32_t struct_size;
    double grain_density;
    double volume_fraction;
    double grain_diameter;
    double mu_s;
    double mu_2;
    double i0;
} gp_material;

GP_API gp_status gp_material_init(gp_material *material, size_t size);

enum {
    GP_INITIAL_HYDROSTATIC = 0,
    GP_INITIAL_NONE = 1
};

typedef struct gp_column {
    uint32_t struct_size;
    double x_min, y_min;
    double width, height;
    int32_t material;
    double vx, vy;
    int32_t initial_pressure;
} gp_column;

GP_API gp_status gp_column_init(gp_column *column, size_t size);

enum {
    GP_WALL_NO_SLIP = 0,
    GP_WALL_FREE_SLIP = 1,
    GP_WALL_COULOMB = 2
};

typedef struct gp_plate {
    uint32_t struct_size;
    double x0, y0, x1, y1;
    int32_t friction;
    double wall_mu;
    double vx, vy;
    int64_t n_knots;
    const double *knot_t;
    const double *knot_x;
    const double *knot_y;
    double normal_pressure;
    double mass_per_length;
} gp_plate;

GP_API gp_status gp_plate_init(gp_plate *plate, size_t size);

typedef struct gp_sim gp_sim;

GP_API gp_status gp_create(const gp_config *config, gp_sim **sim);

GP_API void gp_destroy(gp_sim *sim);

GP_API gp_status gp_add_material(gp_sim *sim, const gp_material *material, int32_t *id);

GP_API gp_status gp_add_column(gp_sim *sim, const gp_column *column, int32_t *id);

GP_API gp_status gp_add_particles(gp_sim *sim, int32_t material, int64_t n, const double *x, const double *y,
                                  const double *vx, const double *vy, int32_t *id);

GP_API gp_status gp_add_plate(gp_sim *sim, const gp_plate *plate, int32_t *id);

GP_API gp_status gp_set_plate_velocity(gp_sim *sim, int32_t plate, double vx, double vy);

GP_API gp_status gp_step(gp_sim *sim, int64_t n);

GP_API gp_status gp_run(gp_sim *sim, double t_end);

typedef int32_t (*gp_callback)(void *user, gp_sim *sim);

GP_API gp_status gp_set_callback(gp_sim *sim, int64_t every, gp_callback callback, void *user);

enum { GP_LOG_INFO = 0, GP_LOG_WARNING = 1 };

typedef void (*gp_log)(void *user, int32_t level, const char *text);

GP_API gp_status gp_set_log(gp_sim *sim, gp_log log, void *user);

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
#define GP_FIELD_POSITION (GP_FIELD_X | GP_FIELD_Y)
#define GP_FIELD_VELOCITY (GP_FIELD_VX | GP_FIELD_VY)
#define GP_FIELD_ALL ((1u << 15) - 1u)

typedef struct gp_particles {
    uint32_t struct_size;
    int64_t count;
    uint64_t epoch;
    const int64_t *id;
    const int32_t *column;
    const double *x, *y;
    const double *vx, *vy;
    const double *pressure;
    const double *density;
    const double *sxx, *sxy, *syy;
    const double *shear_rate;
    const double *inertial_number;
    const double *viscosity;
    const double *number_density;
} gp_particles;

GP_API gp_status gp_get_particles(gp_sim *sim, uint32_t fields, gp_particles *particles);

GP_API gp_status gp_copy_field(gp_sim *sim, uint32_t field, double *dst, int64_t n);

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
    double momentum_x, momentum_y;
    double max_speed, rms_speed;
    double x_left, x_right;
    double peak_x, peak_height;
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
} gp_state;

GP_API gp_status gp_get_state(gp_sim *sim, gp_state *state);

GP_API gp_status gp_get_surface(gp_sim *sim, int64_t n, const double *x, double *height);

GP_API gp_status gp_get_interface(gp_sim *sim, int32_t left, int32_t right, int64_t n, const double *y, double *x);

typedef struct gp_load {
    uint32_t struct_size;
    double fx, fy;
    double torque;
    double dx, dy;
    double impulse_x, impulse_y;
} gp_load;

GP_API gp_status gp_get_plate_load(gp_sim *sim, int32_t plate, gp_load *load);

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

GP_API gp_status gp_get_plan(gp_sim *sim, int64_t n, gp_plan_entry *entries, int64_t *n_out);

GP_API gp_status gp_save(gp_sim *sim, const char *path);
GP_API gp_status gp_load_file(const char *path, gp_sim **sim);
#define gp_load(path, sim) gp_load_file((path), (sim))

typedef struct gp_output {
    uint32_t struct_size;
    double every_seconds;
    uint32_t fields;
    int32_t compression;
    int32_t single_precision;
    int64_t append;
} gp_output;

GP_API gp_status gp_output_init(gp_output *output, size_t size);

GP_API gp_status gp_output_open(gp_sim *sim, const char *path, const gp_output *output);

GP_API gp_status gp_output_write(gp_sim *sim);

GP_API gp_status gp_output_close(gp_sim *sim);

#ifdef __cplusplus
}
#endif

#endif
