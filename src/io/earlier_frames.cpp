#include "io/earlier_frames.hpp"

#include <algorithm>
#include <cstring>

#include "io/hdf5_file.hpp"
#include "io/safe_file.hpp"

namespace gp::io {

struct EarlierFrames::Impl : Hdf5File {
    struct Element {
        std::string name;
        int components;
        Id value;
    };
    int64_t count = 0;
    std::vector<Element> elements; // those that change
    std::size_t observable_count = 0;
    Id observables;
    std::size_t wall_points = 0;
    mutable std::vector<double> packed;
    mutable std::vector<double> unpacked[2]; // two components of one field

    [[noreturn]] void refuse(const std::string &why) const {
        throw make_error(GP_E_IO, "%s: cannot be continued: %s", path.c_str(), why.c_str());
    }

    Id open(const std::string &name) const { return own(H5Dopen2(file, name.c_str(), H5P_DEFAULT), "read " + name); }

    std::vector<hsize_t> extent_of(hid_t dataset, const std::string &name) const {
        const Id extent = own(H5Dget_space(dataset), "read " + name);
        std::vector<hsize_t> shape(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(extent))));
        check(H5Sget_simple_extent_dims(extent, shape.data(), nullptr), "read " + name);
        return shape;
    }

    // A dataset of one dimension.
    template <class T> std::vector<T> read_row(const std::string &name, hid_t native) const {
        const Id dataset = open(name);
        const std::vector<hsize_t> shape = extent_of(dataset, name);
        if (shape.size() != 1 || shape[0] > (hsize_t{1} << 40))
            refuse(name + " has another shape");
        std::vector<T> values(shape[0]);
        if (!values.empty())
            check(H5Dread(dataset, native, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), "read " + name);
        return values;
    }

    void check_parameters(const FrameHeader &header) const {
        const std::string what = "read /parameters";
        double spacing = 0;
        int64_t particles = 0;
        const Id parameters = own(H5Gopen2(file, "/parameters", H5P_DEFAULT), what);
        const Id n = own(H5Aopen(parameters, "particles", H5P_DEFAULT), what);
        const Id dl = own(H5Aopen(parameters, "spacing", H5P_DEFAULT), what);
        check(H5Aread(n, H5T_NATIVE_INT64, &particles), what);
        check(H5Aread(dl, H5T_NATIVE_DOUBLE, &spacing), what);
        if (particles != header.count || spacing != header.spacing)
            refuse(format_text("it has %lld particles and spacing %g, the simulation %lld and %g",
                               static_cast<long long>(particles), spacing, static_cast<long long>(header.count),
                               header.spacing));
    }

    void open_fields(const std::vector<FrameField> &fields, const FrameRows &constant_values, bool single,
                     std::size_t frames) {
        const Id all = own(H5Gopen2(file, "/particles/all", H5P_DEFAULT), "read /particles/all");
        H5G_info_t info;
        check(H5Gget_info(all, &info), "read /particles/all");
        if (info.nlinks != fields.size() + 1) // and the box
            refuse("it has other fields (gp_output.fields)");
        std::size_t constant = 0;
        for (const FrameField &f : fields) {
            const std::string name = std::string("/particles/all/") + f.name;
            if (check(H5Lexists(file, name.c_str(), H5P_DEFAULT), "read " + name) == 0)
                refuse("it lacks the field " + std::string(f.name) + " (gp_output.fields)");
            if (f.constant) {
                if (!has_values(name, constant_values, constant))
                    refuse("it is of another simulation: other values of " + std::string(f.name));
                ++constant;
                continue;
            }
            Id value = open(name + "/value");
            std::vector<hsize_t> shape = extent_of(value, name), expected = {static_cast<hsize_t>(count)};
            if (f.components > 1)
                expected.push_back(3);
            if (shape.size() != expected.size() + 1 || shape[0] < frames ||
                !std::equal(expected.begin(), expected.end(), shape.begin() + 1))
                refuse(name + " has another shape");
            const Id type = own(H5Dget_type(value), "read " + name);
            const std::size_t bytes = H5Tget_size(type);
            const bool is_position = std::strcmp(f.name, "position") == 0; // 0.1 wrote 4 bytes: they become 8
            if (bytes != (single && !is_position ? 4u : 8u) && !(single && is_position && bytes == 4))
                refuse("it is of another precision (gp_output.single_precision)");
            elements.push_back({f.name, f.components, std::move(value)});
        }
    }

    void open_observables(std::size_t expected, std::size_t frames) {
        const std::string name = "/observables/state/value";
        observable_count = expected;
        if (expected == 0)
            return;
        observables = open(name);
        const std::vector<hsize_t> shape = extent_of(observables, name);
        if (shape.size() != 2 || shape[0] < frames || shape[1] != expected)
            refuse(name + " has another shape");
    }

    // One frame of a dataset; rest: its extent but for the frames.
    void read_frame(hid_t dataset, hsize_t frame, const std::vector<hsize_t> &rest, double *to,
                    const std::string &what) const {
        std::vector<hsize_t> start(rest.size() + 1, 0), slab = rest;
        start[0] = frame;
        slab.insert(slab.begin(), 1);
        const Id place = own(H5Dget_space(dataset), what), memory = space(slab, slab);
        check(H5Sselect_hyperslab(place, H5S_SELECT_SET, start.data(), nullptr, slab.data(), nullptr), what);
        check(H5Dread(dataset, H5T_NATIVE_DOUBLE, memory, place, H5P_DEFAULT, to), what);
    }

    void read_observables(hsize_t frame, std::vector<double> &values) const {
        values.resize(observable_count);
        if (!values.empty())
            read_frame(observables, frame, {observable_count}, values.data(),
                       "read frame " + std::to_string(frame) + " of the observables");
    }

    void check_walls(const WallLines &walls) {
        wall_points = walls.plate.size();
        const bool there = check(H5Lexists(file, "/walls", H5P_DEFAULT), "read /walls") > 0;
        if (walls.plate.empty() ? there : !there || read_row<int64_t>("/walls/plate", H5T_NATIVE_INT64) != walls.plate)
            refuse("it has other plates");
    }

    void read_walls(int64_t frame, std::vector<double> &points) const {
        points.resize(3 * wall_points);
        if (points.empty())
            return;
        const std::string name = group_of_frame(frame) + "/walls";
        const Id dataset = open(name);
        if (extent_of(dataset, name) != std::vector<hsize_t>{wall_points, 3})
            refuse(name + " has another shape");
        check(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, points.data()), "read " + name);
    }

    // Some values of one component.
    const double *rows_of(hsize_t frame, std::size_t component, int64_t first, int64_t some) const {
        std::size_t before = 0;
        auto element = elements.begin();
        for (; before + static_cast<std::size_t>(element->components) <= component; ++element)
            before += static_cast<std::size_t>(element->components);
        const std::size_t width = element->components == 1 ? 1 : 3, own = component - before;
        const std::string what = "read frame " + std::to_string(frame) + " of " + element->name;
        std::vector<hsize_t> start = {frame, static_cast<hsize_t>(first)}, slab = {1, static_cast<hsize_t>(some)};
        if (width > 1) {
            start.push_back(0);
            slab.push_back(width);
        }
        packed.resize(static_cast<std::size_t>(some) * width);
        const Id place = own_space(element->value, what), memory = space(slab, slab);
        check(H5Sselect_hyperslab(place, H5S_SELECT_SET, start.data(), nullptr, slab.data(), nullptr), what);
        check(H5Dread(element->value, H5T_NATIVE_DOUBLE, memory, place, H5P_DEFAULT, packed.data()), what);
        std::vector<double> &to = unpacked[own];
        to.resize(static_cast<std::size_t>(some));
        for (std::size_t k = 0; k < to.size(); ++k)
            to[k] = packed[width * k + own];
        return to.data();
    }

    Id own_space(hid_t dataset, const std::string &what) const { return own(H5Dget_space(dataset), what); }

    // Are these the values of a constant field?
    bool has_values(const std::string &name, const FrameRows &rows, std::size_t component) const {
        const Id dataset = open(name);
        if (extent_of(dataset, name) != std::vector<hsize_t>{static_cast<hsize_t>(count)})
            return false;
        std::vector<double> there;
        for (const RowRequest &request : row_requests(count, {1})) {
            const std::vector<hsize_t> start = {static_cast<hsize_t>(request.first)},
                                       slab = {static_cast<hsize_t>(request.count)};
            there.resize(slab[0]);
            const Id place = own_space(dataset, "read " + name), memory = space(slab, slab);
            check(H5Sselect_hyperslab(place, H5S_SELECT_SET, start.data(), nullptr, slab.data(), nullptr),
                  "read " + name);
            check(H5Dread(dataset, H5T_NATIVE_DOUBLE, memory, place, H5P_DEFAULT, there.data()), "read " + name);
            if (!std::equal(there.begin(), there.end(), rows(component, request.first, request.count)))
                return false;
        }
        return true;
    }
};

EarlierFrames::EarlierFrames(const std::string &path, const FrameHeader &header, const std::vector<FrameField> &fields,
                             const FrameRows &constant_values, bool single_precision)
    : impl_(new Impl) {
    require_regular_file(path);
    const Session session;
    Impl &impl = *impl_;
    impl.path = path;
    impl.count = header.count;
    impl.check_version();
    impl.access = impl.own(H5Pcreate(H5P_FILE_ACCESS), "open the file");
    impl.check(H5Pset_fclose_degree(impl.access, H5F_CLOSE_STRONG), "open the file");
    impl.file = impl.own(H5Fopen(path.c_str(), H5F_ACC_RDONLY, impl.access), "continue the file");
    impl.check_parameters(header);
    const std::string home = "/particles/all/position/";
    steps_ = impl.read_row<int64_t>(home + "step", H5T_NATIVE_INT64);
    times_ = impl.read_row<double>(home + "time", H5T_NATIVE_DOUBLE);
    const std::size_t frames = std::min(steps_.size(), times_.size()); // of a killed writer
    steps_.resize(frames);
    times_.resize(frames);
    if (!std::is_sorted(steps_.begin(), steps_.end()))
        impl.refuse("its steps are not in order");
    impl.open_fields(fields, constant_values, single_precision, frames);
    impl.open_observables(header.observables.size(), frames);
    impl.check_walls(header.walls);
}

EarlierFrames::~EarlierFrames() {
    const Session session;
    impl_.reset();
}

FrameRows EarlierFrames::rows(int64_t frame) const {
    std::size_t components = 0;
    for (const Impl::Element &element : impl_->elements)
        components += static_cast<std::size_t>(element.components);
    return {components, [this, frame](std::size_t component, int64_t first, int64_t count) {
                return impl_->rows_of(static_cast<hsize_t>(frame), component, first, count);
            }};
}

void EarlierFrames::read(int64_t frame, std::vector<double> &observables, std::vector<double> &wall_points) const {
    const Session session;
    impl_->read_observables(static_cast<hsize_t>(frame), observables);
    impl_->read_walls(frame, wall_points);
}

} // namespace gp::io
