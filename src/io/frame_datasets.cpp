#include "io/frame_datasets.hpp"

#include <algorithm>
#include <cmath>

namespace gp::io {

namespace {

constexpr int64_t groups_expected = 480; // a table of names in one page: see FrameStore
constexpr int64_t links_expected = 6; // what the name of the walls and a link to earlier ones take of a table, in names

// With single precision, positions are kept as 64 bits all the same: 32 would be 5 places for 160 particles in the coordinates
// of a map. They are rounded to a power of two of at most 1e-5 spacings, so that the rest of the bits compresses to nothing.
double position_unit(double spacing) {
    return std::exp2(std::floor(std::log2(1e-5 * spacing)));
}

} // namespace

std::vector<RowRequest> row_requests(int64_t count, const std::vector<int> &widths) {
    std::vector<RowRequest> requests;
    const auto most = static_cast<int64_t>(Hdf5File::rows_per_chunk(static_cast<hsize_t>(count)));
    std::size_t component = 0;
    for (const int width : widths) {
        for (int64_t first = 0; first < count; first += most)
            for (int k = 0; k < width; ++k)
                requests.push_back({component + static_cast<std::size_t>(k), first, std::min(most, count - first)});
        component += static_cast<std::size_t>(width);
    }
    return requests;
}

// ------------------------------------------------------------------------------------------------------ layout

// The extent of one frame of an element.
std::vector<hsize_t> FrameDatasets::shape_of(const Element &element) const {
    const hsize_t n = static_cast<hsize_t>(count);
    return element.components == 1 ? std::vector<hsize_t>{n} : std::vector<hsize_t>{n, 3};
}

void FrameDatasets::make_layout(const FrameHeader &header, const FrameRows &constant_values) {
    unit = single ? position_unit(header.spacing) : 0;
    const int64_t version[4] = {1, 1, 1, 0};
    Id h5md = make_group("/h5md", 4), author = make_group("/h5md/author", 0);
    Id creator = make_group("/h5md/creator", 0), modules = make_group("/h5md/modules", 2);
    Id units = make_group("/h5md/modules/units", 0), parameters = make_group("/parameters", 0);
    set_integers(h5md, "version", {2}, version);
    set_text(author, "name", "unknown");
    set_text(creator, "name", "granperi");
    set_text(creator, "version", header.creator_version != nullptr ? header.creator_version : "");
    set_integers(units, "version", {2}, version + 2);
    set_text(units, "system", "SI");

    set_integers(parameters, "particles", {}, &count);
    set_numbers(parameters, "spacing", {}, &header.spacing);
    set_numbers(parameters, "gravity", {2}, header.gravity);
    for (const auto &[name, value] : header.parameters) {
        if (check(H5Aexists(parameters, name.c_str()), "write the parameters") > 0)
            check(H5Adelete(parameters, name.c_str()), "write the parameters");
        set_numbers(parameters, name.c_str(), {}, &value);
    }

    Id particles = make_group("/particles", 1), all = make_group("/particles/all", 20);
    make_box();
    std::size_t component = 0;
    for (Element &element : elements) {
        const std::string name = element.path() + (element.constant ? "" : "/value");
        Id dataset =
            make_dataset(name, type_of(element), shape_of(element), !element.constant, compression, element.unit);
        if (!element.constant) {
            element.value = std::move(dataset);
            continue;
        }
        write_constant(element, dataset, constant_values, component);
        component += static_cast<std::size_t>(element.components);
    }
    make_scene(header.scene);
    make_observables(header.observables);
    make_walls(header.walls);
    // step before time, which a reader goes by: of two datasets the lower one in the file is written first.
    const std::string home = "/particles/all/position/";
    step = make_dataset(home + "step", H5T_STD_I64LE, {}, true, 0, "");
    time = make_dataset(home + "time", H5T_IEEE_F64LE, {}, true, 0, "s");
    for (const Element &element : elements)
        if (!element.constant && !element.is_position())
            link_clock(home, element.path());
    if (observable_count > 0)
        link_clock(home, "/observables/state");
    make_group("/frames", groups_expected);
}

void FrameDatasets::link_clock(const std::string &home, const std::string &element) const {
    for (const char *name : {"step", "time"})
        check(
            H5Lcreate_hard(file, (home + name).c_str(), file, (element + "/" + name).c_str(), H5P_DEFAULT, H5P_DEFAULT),
            "link " + element + "/" + name);
}

// A dataset, since an attribute ends at 64 KiB.
void FrameDatasets::make_scene(const std::string &text) const {
    if (text.empty())
        return;
    const std::string what = "write /parameters/scene";
    Id type = own(H5Tcopy(H5T_C_S1), what), extent = own(H5Screate(H5S_SCALAR), what);
    Id how = own(H5Pcreate(H5P_DATASET_CREATE), what);
    check(H5Tset_size(type, text.size() + 1), what);
    check(H5Pset_obj_track_times(how, false), what);
    Id dataset = own(H5Dcreate2(file, "/parameters/scene", type, extent, H5P_DEFAULT, how, H5P_DEFAULT), what);
    check(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.c_str()), what);
}

void FrameDatasets::make_observables(const std::vector<Observable> &all) {
    observable_count = all.size();
    if (all.empty())
        return;
    std::vector<std::string> names, units;
    for (const Observable &observable : all) {
        names.push_back(observable.name);
        units.push_back(observable.unit);
    }
    Id group = make_group("/observables", 1), state = make_group("/observables/state", 3);
    observables = make_dataset("/observables/state/value", H5T_IEEE_F64LE, {observable_count}, true, 0, "");
    set_texts(observables, "names", names);
    set_texts(observables, "units", units);
}

void FrameDatasets::make_walls(const WallLines &walls) {
    wall_point_count = walls.plate.size();
    wall_segment_count = walls.segments.size() / 2;
    if (walls.plate.empty())
        return;
    const auto put = [this](const std::string &name, const std::vector<int64_t> &values, std::vector<hsize_t> shape) {
        Id dataset = make_dataset(name, H5T_STD_I64LE, std::move(shape), false, compression, "");
        check(H5Dwrite(dataset, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), "write " + name);
    };
    make_group("/walls", 2);
    put("/walls/plate", walls.plate, {wall_point_count});
    put("/walls/segments", walls.segments, {wall_segment_count, 2});
}

void FrameDatasets::write_constant(const Element &element, hid_t dataset, const FrameRows &rows,
                                   std::size_t component) {
    const std::vector<hsize_t> shape = shape_of(element);
    bool numbered = count > 0 && element.name == "id" && element.integer && element.components == 1; // 0, 1, 2, ...
    write_rows(element, dataset, rows, component, std::vector<hsize_t>(shape.size(), 0), shape, 0,
               [&](const double *values, int64_t first, int64_t some) {
                   for (int64_t k = 0; k < some; ++k)
                       numbered = numbered && values[k] == static_cast<double>(first + k);
               });
    if (numbered)
        cells = element.path();
}

void FrameDatasets::make_box() const {
    const int64_t dimension = 3;
    const char boundary[3][9] = {"none", "none", "none"}; // as wide as "periodic": H5MD's box would begin at x = 0
    Id box = make_group("/particles/all/box", 1), type = own(H5Tcopy(H5T_C_S1), "describe a text");
    set_integers(box, "dimension", {}, &dimension);
    check(H5Tset_size(type, sizeof boundary[0]), "describe a text");
    set_attribute(box, "boundary", type, type, {3}, boundary);
}

void FrameDatasets::open_datasets() {
    const auto dataset = [this](const std::string &name) {
        return own(H5Dopen2(file, name.c_str(), H5P_DEFAULT), "open " + name + " again");
    };
    for (Element &element : elements)
        if (!element.constant)
            element.value = dataset(element.path() + "/value");
    if (observable_count > 0)
        observables = dataset("/observables/state/value");
    step = dataset("/particles/all/position/step");
    time = dataset("/particles/all/position/time");
}

void FrameDatasets::close_datasets() noexcept {
    for (Element &element : elements)
        element.value.close();
    observables.close();
    step.close();
    time.close();
}

std::size_t FrameDatasets::components(bool constant) const {
    std::size_t n = 0;
    for (const Element &element : elements)
        n += element.constant == constant ? static_cast<std::size_t>(element.components) : 0;
    return n;
}

// ------------------------------------------------------------------------------------------------------ frames

// Some values of an element as they are stored; component: its first one.
const double *FrameDatasets::pack(const Element &element, const FrameRows &rows, const RowRequest &some) {
    const double *const x = rows(some.component, some.first, some.count);
    if (element.components == 1)
        return x;
    const double *const y = rows(some.component + 1, some.first, some.count);
    packed.resize(static_cast<size_t>(some.count) * 3);
    const bool rounded = unit > 0 && element.is_position();
    const auto stored = [&](double value) { return rounded ? unit * std::nearbyint(value / unit) : value; };
    for (size_t k = 0; k < static_cast<size_t>(some.count); ++k) {
        packed[3 * k] = stored(x[k]);
        packed[3 * k + 1] = stored(y[k]);
        packed[3 * k + 2] = 0;
    }
    return packed.data();
}

// All values of an element, a row of chunks at a time. start, shape: of one frame in the dataset; particles: which of their
// numbers is that of particles; see: looks at what is written.
template <class See>
void FrameDatasets::write_rows(const Element &element, hid_t dataset, const FrameRows &rows, std::size_t component,
                               std::vector<hsize_t> start, std::vector<hsize_t> shape, std::size_t particles,
                               const See &see) {
    const std::string what = "write " + element.name;
    for (const RowRequest &request : row_requests(count, {1})) {
        start[particles] = static_cast<hsize_t>(request.first);
        shape[particles] = static_cast<hsize_t>(request.count);
        Id place = own(H5Dget_space(dataset), what), memory = space(shape, shape);
        check(H5Sselect_hyperslab(place, H5S_SELECT_SET, start.data(), nullptr, shape.data(), nullptr), what);
        const double *const values = pack(element, rows, {component, request.first, request.count});
        see(values, request.first, request.count);
        check(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, memory, place, H5P_DEFAULT, values), what);
    }
}

// One more frame of a dataset, of which nothing is written yet.
void FrameDatasets::extend(hid_t dataset, std::vector<hsize_t> shape, const std::string &what) const {
    shape.insert(shape.begin(), static_cast<hsize_t>(frames) + 1);
    check(H5Dset_extent(dataset, shape.data()), what);
}

void FrameDatasets::append_rows(const Element &element, const FrameRows &rows, std::size_t component) {
    std::vector<hsize_t> shape = shape_of(element);
    extend(element.value, shape, "write " + element.name);
    shape.insert(shape.begin(), 1);
    std::vector<hsize_t> start(shape.size(), 0);
    start[0] = static_cast<hsize_t>(frames);
    write_rows(element, element.value, rows, component, start, shape, 1, [](const double *, int64_t, int64_t) {});
}

void FrameDatasets::append(hid_t dataset, std::vector<hsize_t> shape, hid_t type, const void *data,
                           const std::string &what) const {
    extend(dataset, shape, what);
    std::vector<hsize_t> start(shape.size() + 1, 0);
    start[0] = static_cast<hsize_t>(frames);
    shape.insert(shape.begin(), 1);
    Id place = own(H5Dget_space(dataset), what), memory = space(shape, shape);
    check(H5Sselect_hyperslab(place, H5S_SELECT_SET, start.data(), nullptr, shape.data(), nullptr), what);
    check(H5Dwrite(dataset, type, memory, place, H5P_DEFAULT, data), what);
}

// An array without data of its own that shows one frame of an element.
void FrameDatasets::make_view(const std::string &name, const Element &element) const {
    const std::string what = "create " + name;
    const std::vector<hsize_t> shape = shape_of(element);
    std::vector<hsize_t> start(shape.size() + 1, 0), slab = shape, extent = shape;
    start[0] = static_cast<hsize_t>(frames);
    slab.insert(slab.begin(), 1);
    extent.insert(extent.begin(), start[0] + 1);
    Id how = own(H5Pcreate(H5P_DATASET_CREATE), what), source = space(extent, extent), view = space(shape, shape);
    check(H5Sselect_hyperslab(source, H5S_SELECT_SET, start.data(), nullptr, slab.data(), nullptr), what);
    check(H5Pset_obj_track_times(how, false), what);
    if (count > 0)
        check(H5Pset_virtual(how, view, ".", (element.path() + "/value").c_str(), source), what);
    own(H5Dcreate2(file, name.c_str(), type_of(element), view, H5P_DEFAULT, how, H5P_DEFAULT), what);
}

void FrameDatasets::make_views() const {
    const std::string outer = group_of_views(frames), inner = frame_group();
    if (check(H5Lexists(file, outer.c_str(), H5P_DEFAULT), "create " + outer) == 0)
        make_group(outer, views_per_group);
    if (check(H5Lexists(file, inner.c_str(), H5P_DEFAULT), "create " + inner) > 0)
        return; // of an attempt that came so far and then failed
    make_group(inner, static_cast<int64_t>(elements.size()) + links_expected);
    for (const Element &element : elements)
        if (!element.constant)
            make_view(inner + "/" + element.name, element);
}

// Where the plates' points are, or a link to where it says so already.
void FrameDatasets::place_walls(const std::vector<double> &points) {
    const std::string name = frame_group() + "/walls", what = "write " + name;
    if (check(H5Lexists(file, name.c_str(), H5P_DEFAULT), what) > 0) // of an attempt that failed
        check(H5Ldelete(file, name.c_str(), H5P_DEFAULT), what);
    if (!wall_path.empty() && points == wall_points) {
        check(H5Lcreate_soft(wall_path.c_str(), file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT), what);
        return;
    }
    wall_path.clear();
    Id dataset = make_dataset(name, H5T_IEEE_F64LE, {wall_point_count, 3}, false, compression, "m");
    check(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, points.data()), what);
}

void FrameDatasets::append_values(const FrameRows &rows, const std::vector<double> &values,
                                  const std::vector<double> &points) {
    std::size_t component = 0;
    for (const Element &element : elements)
        if (!element.constant) {
            append_rows(element, rows, component);
            component += static_cast<std::size_t>(element.components);
        }
    if (observable_count > 0)
        append(observables, {observable_count}, H5T_NATIVE_DOUBLE, values.data(), "write /observables/state");
    make_views();
    if (wall_point_count > 0)
        place_walls(points);
}

void FrameDatasets::append_clock(int64_t step_number, double seconds) {
    append(step, {}, H5T_NATIVE_INT64, &step_number, "write the step");
    append(time, {}, H5T_NATIVE_DOUBLE, &seconds, "write the time");
}

void FrameDatasets::remember_walls(const std::vector<double> &points) {
    if (wall_point_count > 0 && wall_path.empty()) {
        wall_points = points;
        wall_path = frame_group() + "/walls";
    }
}

} // namespace gp::io
