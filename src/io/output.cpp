#include "io/output.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "check.hpp"
#include "diagnostics.hpp"
#include "fields.hpp"
#include "parts.hpp"
#ifdef GP_WITH_HDF5
#include "io/earlier_frames.hpp"
#include "io/frame_file.hpp"
#include "io/scene_text.hpp"
#include "io/state_record.hpp"
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

namespace {

// A step that ends within rounding of a multiple has reached it.
double reached_time(const World &world) {
    return world.clock.time + 1e-9 * world.clock.dt;
}

int64_t next_multiple(double time, double every) {
    const double passed = std::floor(time / every);
    return passed < 0x1p62 ? static_cast<int64_t>(passed) + 1 : INT64_MAX; // of a tiny one, every step passes some
}

} // namespace

bool FrameTimes::due(const World &world) const {
    return every > 0 && reached_time(world) >= static_cast<double>(next) * every;
}

void FrameTimes::pass(const World &world) {
    if (every > 0)
        next = next_multiple(reached_time(world), every);
}

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
    {"fluidity", GP_FIELD_FLUIDITY, false, false, "s-1"},
};

FrameHeader header_of(const World &world, int64_t count) {
    const Constants &c = world.constants;
    FrameHeader header{};
    header.count = count;
    header.spacing = c.spacing;
    header.gravity[0] = c.gravity.x();
    header.gravity[1] = c.gravity.y();
    header.creator_version = gp_version_string();
    header.parameters = {{"sound_speed", c.sound_speed},
                         {"horizon", c.horizon},
                         {"friction_factor", world.scene->config().friction_factor}};
    header.observables = state_observables();
    header.scene = scene_text(*world.scene);
    const std::vector<PlateSpec> &plates = world.scene->plates();
    for (std::size_t p = 0; p < plates.size(); ++p)
        for (std::size_t k = 0; k < plates[p].points.size(); ++k) {
            const auto point = static_cast<int64_t>(header.walls.plate.size());
            header.walls.plate.push_back(static_cast<int64_t>(p));
            if (k > 0)
                header.walls.segments.insert(header.walls.segments.end(), {point - 1, point});
        }
    return header;
}

// x, y, z of the points of all plates, where these are by now.
std::vector<double> points_of_walls(const World &world) {
    std::vector<double> points;
    for (const Plate &plate : world.walls.plates) {
        const Placing placing(plate.pose(world.clock.time), plate.spec().pivot);
        for (const Vector &point : plate.spec().points) {
            const Vector at = placing.of(point);
            points.insert(points.end(), {at.x() - plate.state().wrapped, at.y(), 0.0});
        }
    }
    return points;
}

// The fields that are asked for, as the file has them, and the components of those that are constant and of the others.
struct OutputFields {
    std::vector<FrameField> fields;
    std::vector<uint32_t> constant_bits, bits;

    explicit OutputFields(uint32_t asked) {
        asked |= GP_FIELD_ID | GP_FIELD_POSITION;
        if (asked & GP_FIELD_VELOCITY)
            asked |= GP_FIELD_VELOCITY;
        for (const FileField &field : file_fields) {
            if (!(asked & field.bits))
                continue;
            int components = 0;
            for (uint32_t bit = 1; bit <= field.bits; bit <<= 1)
                if (field.bits & bit) {
                    ++components;
                    (field.constant ? constant_bits : bits).push_back(bit);
                }
            fields.push_back({field.name, components, field.constant, field.integer, field.unit});
        }
    }
    std::vector<int> widths(bool constant) const {
        std::vector<int> widths;
        for (const FrameField &field : fields)
            if (field.constant == constant)
                widths.push_back(field.components);
        return widths;
    }
};

// The particles of a world as rows of a frame. Of several processes the first one writes them, and asks the others for some at a
// time: for all, in the order of row_requests, also where writing fails.
class WorldRows {
public:
    WorldRows(const World &world, const OutputFields &fields, bool constant)
        : crossing_(world.crossing), bits_(constant ? fields.constant_bits : fields.bits), by_id_(world),
          requests_(row_requests(by_id_.count(), fields.widths(constant))), values_(bits_.size()) {}
    WorldRows(const WorldRows &) = delete;
    WorldRows &operator=(const WorldRows &) = delete;

    int64_t count() const { return by_id_.count(); }
    FrameRows rows() {
        return {bits_.size(), [this](std::size_t component, int64_t, int64_t) {
                    take_next();
                    return values_[component].data();
                }};
    }
    void take_rest() {
        while (next_ < requests_.size())
            take_next();
    }

private:
    void take_next() { // a failure in it is not one of writing: the others would go on to the next
        everywhere(crossing_, [this] { take(); });
    }
    void take() {
        const RowRequest &request = requests_[next_++];
        std::vector<double> &values = values_[request.component];
        values.resize(static_cast<std::size_t>(request.count));
        by_id_.read(bits_[request.component], request.first, request.count, values.data());
    }

    Crossing *crossing_;
    std::vector<uint32_t> bits_;
    FieldsById by_id_;
    std::vector<RowRequest> requests_;
    std::size_t next_ = 0;
    std::vector<std::vector<double>> values_;
};

// What the first process does with rows; all throw what it throws.
template <class Body> void write_on_first(const World &world, const std::vector<WorldRows *> &all, const Body &body) {
    if (!world.crossing) {
        body();
        return;
    }
    OnFirst first(*world.crossing);
    first.run(body);
    for (WorldRows *rows : all)
        rows->take_rest();
    first.finish();
}

} // namespace

struct Output::Impl {
    gp_output options;
    OutputFields fields;
    std::string path;                // absolute
    std::unique_ptr<FrameFile> file; // of several processes, the first one's
    FrameTimes times;

    explicit Impl(const gp_output &of) : options(of), fields(of.fields) {}

    // How many of the earlier frames are of the simulation as it is now.
    static int64_t frames_to_keep(const EarlierFrames &earlier, const std::string &path, const OutputPosition *left_off,
                                  const World &world) {
        const std::vector<int64_t> &steps = earlier.steps();
        const int64_t now = world.clock.step;
        const int64_t until_now = std::upper_bound(steps.begin(), steps.end(), now) - steps.begin();
        if (!left_off)
            return until_now;
        if (until_now < left_off->frames)
            throw make_error(GP_E_IO,
                             "%s: cannot be continued: %lld frames up to step %lld, but there were %lld when the "
                             "simulation was saved",
                             path.c_str(), static_cast<long long>(until_now), static_cast<long long>(now),
                             static_cast<long long>(left_off->frames));
        return left_off->frames;
    }

    // earlier, constants: the values of the constant fields, for the frames that are there and for the new file.
    void open(const std::string &given_path, const World &world, WorldRows &of_earlier, WorldRows &constants,
              const OutputPosition *left_off) {
        const FrameHeader header = header_of(world, constants.count());
        const bool single = options.single_precision != 0, append = options.append != 0;
        std::unique_ptr<EarlierFrames> earlier;
        if (append)
            earlier = std::make_unique<EarlierFrames>(given_path, header, fields.fields, of_earlier.rows(), single);
        const int64_t kept = append ? frames_to_keep(*earlier, given_path, left_off, world) : 0;
        file = std::make_unique<FrameFile>(given_path, header, fields.fields, constants.rows(), options.compression,
                                           single, append);
        if (!append)
            return;
        std::vector<double> observables, wall_points;
        for (int64_t frame = 0; frame < kept; ++frame) {
            earlier->read(frame, observables, wall_points);
            file->write(earlier->steps()[frame], earlier->times()[frame], earlier->rows(frame), observables,
                        wall_points);
        }
        earlier.reset();
        file->publish();
    }
};

namespace {

bool is_same_file(const std::string &a, const std::string &b) {
    std::error_code error;
    return a == b || std::filesystem::equivalent(a, b, error);
}

// Is the simulation where it was when the output was left off, and the file that one?
bool is_at(const OutputPosition &left_off, const std::string &path, const World &world) {
    return !left_off.path.empty() && left_off.step == world.clock.step && is_same_file(left_off.path, path);
}

} // namespace

Output::Output(const std::string &path, const gp_output &options, const World &world, const OutputPosition &left_off) {
    check_options(options);
    impl_ = std::make_unique<Impl>(options);
    Impl &impl = *impl_;
    impl.times.every = options.every_seconds;
    std::error_code none; // of a path that names no file: opening it says so
    impl.path = std::filesystem::absolute(path, none).lexically_normal().string();
    WorldRows of_earlier(world, impl.fields, true), constants(world, impl.fields, true);
    const bool append = options.append != 0;
    write_on_first(
        world, append ? std::vector<WorldRows *>{&of_earlier, &constants} : std::vector<WorldRows *>{&constants}, [&] {
            if (!append && !left_off.path.empty() && is_same_file(left_off.path, impl.path))
                throw make_error(
                    GP_E_STATE,
                    "gp_output.append = 0: %s is the output that was open when the simulation was saved; expected 1 "
                    "to continue it, or another path",
                    path.c_str());
            const bool own_position = append && is_at(left_off, impl.path, world);
            impl.open(path, world, of_earlier, constants, own_position ? &left_off : nullptr);
            if (own_position && left_off.every_seconds == options.every_seconds)
                impl.times.next = left_off.next;
            else
                impl.times.pass(world);
        });
    tell_all(world.crossing, &impl.times);
    if (!append && options.every_seconds > 0)
        write(world);
}

Output::~Output() = default;

void Output::write(const World &world) {
    const std::vector<double> observables = state_row(measure_state(world));
    WorldRows rows(world, impl_->fields, false);
    write_on_first(world, {&rows}, [&] {
        impl_->file->write(world.clock.step, world.clock.time, rows.rows(), observables, points_of_walls(world));
    });
}

void Output::step_done(const World &world) {
    if (!impl_->times.due(world))
        return;
    impl_->times.pass(world);
    write(world);
}

void Output::close() {
    if (impl_->file)
        impl_->file->close();
}

OutputPosition Output::position(const World &world) const {
    return {impl_->path, impl_->times.every, impl_->times.next, impl_->file ? impl_->file->frames() : 0,
            world.clock.step};
}

#else

struct Output::Impl {
    FrameTimes times;
};

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
