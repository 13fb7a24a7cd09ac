#include "io/output.hpp"

#include <cmath>
#include <filesystem>
#include <vector>

#include "check.hpp"
#include "fields.hpp"
#ifdef GP_WITH_HDF5
#include "io/frame_file.hpp"
#endif

namespace gp::io {

gp_output default_output() {
    gp_output output{};
    output.struct_size = sizeof output;
    output.fields = GP_FIELD_POSITION | GP_FIELD_VELOCITY | GP_FIELD_PRESSURE | GP_FIELD_SHEAR_RATE | GP_FIELD_COLUMN;
    output.compression = 4;
    return output;
}

namespace {

void check_options(const gp_output &o) {
    require_not_negative("gp_output.every_seconds", o.every_seconds);
    if (o.fields & ~GP_FIELD_ALL)
        throw make_error(GP_E_ARGUMENT, "gp_output.fields = 0x%x: expected bits GP_FIELD_... up to 0x%x", o.fields,
                         GP_FIELD_ALL);
    require_choice("gp_output.compression", o.compression, 10);
    require_choice("gp_output.single_precision", o.single_precision, 2);
    require_choice("gp_output.append", o.append, 2);
}

} // namespace

#ifdef GP_WITH_HDF5

namespace {

struct FileField {
    const char *name;
    uint32_t bits; // of its one or two components
    bool constant, integer;
    const char *unit;
};

constexpr FileField file_fields[] = {
    {"id", GP_FIELD_ID, true, true, nullptr},
    {"column", GP_FIELD_COLUMN, true, true, nullptr},
    {"position", GP_FIELD_POSITION, false, false, "m"},
    {"velocity", GP_FIELD_VELOCITY, false, false, "m s-1"},
    {"pressure", GP_FIELD_PRESSURE, false, false, "Pa"},
    {"density", GP_FIELD_DENSITY, false, false, "kg m-3"},
    {"sxx", GP_FIELD_SXX, false, false, "Pa"},
    {"sxy", GP_FIELD_SXY, false, false, "Pa"},
    {"syy", GP_FIELD_SYY, false, false, "Pa"},
    {"shear_rate", GP_FIELD_SHEAR_RATE, false, false, "s-1"},
    {"inertial_number", GP_FIELD_INERTIAL_NUMBER, false, false, nullptr},
    {"viscosity", GP_FIELD_VISCOSITY, false, false, "Pa s"},
    {"number_density", GP_FIELD_NUMBER_DENSITY, false, false, nullptr},
};

FrameHeader header_of(const World &world) {
    const Constants &c = world.constants;
    FrameHeader header{};
    header.count = world.particles.count;
    header.spacing = c.spacing;
    header.gravity[0] = c.gravity.x();
    header.gravity[1] = c.gravity.y();
    header.periodic_x = false;
    header.creator_version = gp_version_string();
    header.parameters = {{"sound_speed", c.sound_speed},
                         {"horizon", c.horizon},
                         {"friction_factor", world.scene->config().friction_factor}};
    return header;
}

} // namespace

struct Output::Impl {
    gp_output options;
    std::string path;           // absolute
    std::vector<uint32_t> bits; // of the components that change, in the order of the file
    std::vector<std::vector<double>> values;
    std::unique_ptr<FrameFile> file;
    int64_t next = 0; // the next frame by itself is due at next * every_seconds
};

Output::Output(const std::string &path, const gp_output &options, const World &world, const OutputPosition &left_off)
    : impl_(new Impl) {
    check_options(options);
    impl_->options = options;
    impl_->path = std::filesystem::absolute(path).lexically_normal().string();
    uint32_t asked = options.fields | GP_FIELD_ID | GP_FIELD_POSITION;
    if (asked & GP_FIELD_VELOCITY)
        asked |= GP_FIELD_VELOCITY;

    std::vector<FrameField> fields;
    std::vector<std::vector<double>> constants;
    for (const FileField &field : file_fields) {
        if (!(asked & field.bits))
            continue;
        int components = 0;
        for (uint32_t bit = 1; bit <= field.bits; bit <<= 1) {
            if (!(field.bits & bit))
                continue;
            ++components;
            if (field.constant) {
                constants.emplace_back(world.particles.count);
                copy_field_by_id(world, bit, constants.back().data());
            } else {
                impl_->bits.push_back(bit);
                impl_->values.emplace_back(world.particles.count);
            }
        }
        fields.push_back({field.name, components, field.constant, field.integer, field.unit});
    }
    std::vector<const double *> constant_values;
    for (const std::vector<double> &values : constants)
        constant_values.push_back(values.data());
    impl_->file = std::make_unique<FrameFile>(path, header_of(world), fields, constant_values, options.compression,
                                              options.single_precision != 0);
    if (options.every_seconds > 0) {
        write(world);
        impl_->next = static_cast<int64_t>(std::floor(world.clock.time / options.every_seconds)) + 1;
    }
}

Output::~Output() = default;

void Output::write(const World &world) {
    std::vector<const double *> components;
    for (std::size_t k = 0; k < impl_->bits.size(); ++k) {
        copy_field_by_id(world, impl_->bits[k], impl_->values[k].data());
        components.push_back(impl_->values[k].data());
    }
    impl_->file->write(world.clock.step, world.clock.time, components);
}

void Output::step_done(const World &world) {
    const double every = impl_->options.every_seconds;
    // A step that ends within rounding of a multiple has reached it.
    const double reached = world.clock.time + 1e-9 * world.clock.dt;
    if (every <= 0 || reached < static_cast<double>(impl_->next) * every)
        return;
    impl_->next = static_cast<int64_t>(std::floor(reached / every)) + 1;
    write(world);
}

void Output::close() {
    impl_->file->close();
}

OutputPosition Output::position(const World &world) const {
    return {impl_->path, impl_->options.every_seconds, impl_->next, impl_->file->frames(), world.clock.step};
}

#else

struct Output::Impl {};

Output::Output(const std::string &, const gp_output &options, const World &, const OutputPosition &) {
    check_options(options);
    throw make_error(GP_E_UNSUPPORTED, "gp_output_open: this build has no HDF5");
}
Output::~Output() = default;
void Output::step_done(const World &) {}
void Output::write(const World &) {}
void Output::close() {}
OutputPosition Output::position(const World &) const {
    return {};
}

#endif

} // namespace gp::io
