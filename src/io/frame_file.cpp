#include "io/frame_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "error.hpp"
#include "io/frame_store.hpp"
#include "io/hdf5_writer.hpp"
#include "io/safe_file.hpp"
#include "io/xdmf_file.hpp"

namespace gp::io {

namespace {

constexpr int64_t groups_expected = 480; // a table of names in one page: see Store
constexpr int64_t links_expected = 6; // what the name of the walls and a link to earlier ones take of a table, in names

struct Element {
    std::string name, unit;
    int components;
    bool constant, integer;
    Id value; // of a time-dependent element

    std::string path() const { return "/particles/all/" + name; }
    bool is_position() const { return name == "position"; }
};

// With single precision, positions are kept as 64 bits all the same: 32 would be 5 places for 160 particles in the coordinates
// of a map. They are rounded to a power of two of at most 1e-5 spacings, so that the rest of the bits compresses to nothing.
double position_unit(double spacing) {
    return std::exp2(std::floor(std::log2(1e-5 * spacing)));
}

} // namespace

std::vector<RowRequest> row_requests(int64_t count, const std::vector<int> &widths) {
    std::vector<RowRequest> requests;
    const auto most = static_cast<int64_t>(Hdf5Writer::rows_per_chunk(static_cast<hsize_t>(count)));
    std::size_t component = 0;
    for (const int width : widths) {
        for (int64_t first = 0; first < count; first += most)
            for (int k = 0; k < width; ++k)
                requests.push_back({component + static_cast<std::size_t>(k), first, std::min(most, count - first)});
        component += static_cast<std::size_t>(width);
    }
    return requests;
}

struct FrameFile::Impl : Hdf5Writer {
    std::string side_path;
    int64_t count = 0, frames = 0;
    int compression = 0;
    bool single = false, is_open = false;  // open: the files on the disk are ours
    double unit = 0;                       // m, to which positions are rounded; 0: not at all
    const char *suffix = "";               // of the files until they are published
    std::string file_name, side_file_name; // with it
    int replaced_fd = -1;                  // of the XDMF file that will be replaced: holds its lock
    std::vector<Element> elements;
    std::vector<double> packed;

    Store store;
    Id step, time;
    std::size_t observable_count = 0;
    Id observables; // /observables/state/value, if there are any
    std::size_t wall_point_count = 0, wall_segment_count = 0;
    std::vector<double> wall_points; // as they were last written,
    std::string wall_path;           // there
    XdmfFile side;

    ~Impl() {
        if (store.fd >= 0)
            ::close(store.fd);
        release_replaced();
        if (*suffix != '\0' && !side_file_name.empty()) { // never published
            ::unlink(file_name.c_str());
            ::unlink(side_file_name.c_str());
        }
    }

    void release_replaced() {
        if (replaced_fd >= 0)
            ::close(std::exchange(replaced_fd, -1));
    }

    // ----------------------------------------------------------------------------------------- opening and closing

    static int open_file(const std::string &name) {
        struct stat status;
        const int fd = ::open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (fd < 0)
            throw io_failure(name, "create the file", errno);
        if (::fstat(fd, &status) == 0 && S_ISREG(status.st_mode))
            return fd;
        ::close(fd);
        throw io_failure(name, "create the file", "not a regular file");
    }

    // Not the HDF5 file itself is locked, because the readers of HDF5 do that. A writer renames a new XDMF file into the
    // place of the one that it has locked, which then is no more the file of that name.
    static bool lock(int side_fd, const std::string &name) {
        struct stat own, there;
        if (::flock(side_fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
            return false;
        return ::fstat(side_fd, &own) == 0 && ::stat(name.c_str(), &there) == 0 && own.st_ino == there.st_ino &&
               own.st_dev == there.st_dev;
    }

    void open_files() {
        check_version();
        const std::filesystem::path given(path);
        if (!given.has_filename())
            throw io_failure(path, "create the file", "the path names no file");
        side_path = std::filesystem::path(given).replace_extension(".xdmf").string();
        if (side_path == path)
            throw io_failure(path, "create the file", "the extension .xdmf is for the file beside it");
        const char *const locked = "another output is writing to it";
        if (*suffix != '\0') {
            replaced_fd = ::open(side_path.c_str(), O_RDWR | O_CLOEXEC);
            if (replaced_fd >= 0 && !lock(replaced_fd, side_path))
                throw io_failure(path, "continue the file", locked);
        }
        file_name = path + suffix;
        side_file_name = side_path + suffix;
        store.fd = open_file(file_name);
        const int side_fd = open_file(side_file_name);
        side.own(side_fd);
        side.start(replaceable_path(side_file_name), given.filename().string(), count, single);
        if (!lock(side_fd, side_file_name))
            throw io_failure(path, "create the file", locked);
        if (::ftruncate(store.fd, 0) != 0 || ::ftruncate(side_fd, 0) != 0)
            throw io_failure(path, "empty the file", errno);
        is_open = true;
    }

    void commit(const std::string &what) {
        const bool good = H5Fflush(file, H5F_SCOPE_LOCAL) >= 0;
        if (good || store.error != 0)
            if (const int error = store.commit())
                throw io_failure(path, what, error);
        check(good ? 0 : -1, what);
    }

    bool close_hdf5() noexcept {
        for (Element &element : elements)
            element.value.close();
        observables.close();
        step.close();
        time.close();
        return file < 0 || H5Fclose(file.release()) >= 0;
    }

    // Leaves the file on the disk as it was last committed. HDF5 itself closes as usual, into memory: see Store.
    void abandon() noexcept {
        if (!is_open)
            return;
        store.error = store.error != 0 ? store.error : ECANCELED;
        close_hdf5();
        store.rollback();
    }

    void reopen() {
        const auto dataset = [this](const std::string &name) {
            return own(H5Dopen2(file, name.c_str(), H5P_DEFAULT), "open " + name + " again");
        };
        file = own(H5Fopen(path.c_str(), H5F_ACC_RDWR, access), "open the file again");
        for (Element &element : elements)
            if (!element.constant)
                element.value = dataset(element.path() + "/value");
        if (observable_count > 0)
            observables = dataset("/observables/state/value");
        step = dataset("/particles/all/position/step");
        time = dataset("/particles/all/position/time");
    }

    void close() {
        if (!std::exchange(is_open, false))
            return;
        const bool good = close_hdf5();
        int error = good ? store.commit() : EIO;
        if (error != 0)
            store.rollback();
        if (::close(std::exchange(store.fd, -1)) != 0 && error == 0)
            error = errno;
        const int side_error = side.close();
        if (error != 0)
            throw good ? io_failure(path, "close the file", error) : hdf5_failure(path, "close the file");
        if (side_error != 0)
            throw io_failure(side_path, "close the file", side_error);
    }

    // ---------------------------------------------------------------------------------------------------- layout

    hid_t type_of(const Element &element) const {
        return element.integer ? H5T_STD_I64LE : single && !element.is_position() ? H5T_IEEE_F32LE : H5T_IEEE_F64LE;
    }

    // The extent of one frame of an element.
    std::vector<hsize_t> shape_of(const Element &element) const {
        const hsize_t n = static_cast<hsize_t>(count);
        return element.components == 1 ? std::vector<hsize_t>{n} : std::vector<hsize_t>{n, 3};
    }

    void create(const FrameHeader &header, const FrameRows &constant_values) {
        driver = own(H5FDregister(&store_driver()), "register the file driver");
        access = own(H5Pcreate(H5P_FILE_ACCESS), "describe the file");
        Store *const target = &store;
        check(H5Pset_driver(access, driver, &target), "set the file driver");
        check(H5Pset_fclose_degree(access, H5F_CLOSE_STRONG), "describe the file");
        check(H5Pset_cache(access, 0, 0, 0, 0.0), "describe the file"); // every chunk is written once and whole
        Id how = own(H5Pcreate(H5P_FILE_CREATE), "describe the file");
        // Freed space is never used again: an earlier state of the file may still refer to it.
        check(H5Pset_file_space_strategy(how, H5F_FSPACE_STRATEGY_NONE, false, 1), "describe the file");
        file = own(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, how, access), "create the file");

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
        make_box(header);
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
        commit("create the file");
    }

    void link_clock(const std::string &home, const std::string &element) const {
        for (const char *name : {"step", "time"})
            check(H5Lcreate_hard(file, (home + name).c_str(), file, (element + "/" + name).c_str(), H5P_DEFAULT,
                                 H5P_DEFAULT),
                  "link " + element + "/" + name);
    }

    // A dataset, since an attribute ends at 64 KiB.
    void make_scene(const std::string &text) const {
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

    void make_observables(const std::vector<Observable> &all) {
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

    void make_walls(const WallLines &walls) {
        wall_point_count = walls.plate.size();
        wall_segment_count = walls.segments.size() / 2;
        if (walls.plate.empty())
            return;
        const auto put = [this](const std::string &name, const std::vector<int64_t> &values,
                                std::vector<hsize_t> shape) {
            Id dataset = make_dataset(name, H5T_STD_I64LE, std::move(shape), false, compression, "");
            check(H5Dwrite(dataset, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), "write " + name);
        };
        make_group("/walls", 2);
        put("/walls/plate", walls.plate, {wall_point_count});
        put("/walls/segments", walls.segments, {wall_segment_count, 2});
        side.set_walls("/walls/segments", wall_segment_count, "/walls/plate", wall_point_count);
    }

    void write_constant(const Element &element, hid_t dataset, const FrameRows &rows, std::size_t component) {
        const std::vector<hsize_t> shape = shape_of(element);
        bool numbered = count > 0 && element.name == "id" && element.integer && element.components == 1; // 0, 1, 2, ...
        write_rows(element, dataset, rows, component, std::vector<hsize_t>(shape.size(), 0), shape, 0,
                   [&](const double *values, int64_t first, int64_t some) {
                       for (int64_t k = 0; k < some; ++k)
                           numbered = numbered && values[k] == static_cast<double>(first + k);
                   });
        if (numbered)
            side.set_cells(element.path());
    }

    void make_box(const FrameHeader &header) const {
        const int64_t dimension = 3;
        char boundary[3][9] = {"none", "none", "none"};
        Id box = make_group("/particles/all/box", 1), type = own(H5Tcopy(H5T_C_S1), "describe a text");
        if (header.periodic_x) {
            double edges[3] = {0, 0, 0}; // H5MD: placeholders where the boundary is none
            std::snprintf(boundary[0], sizeof boundary[0], "periodic");
            for (const auto &[name, value] : header.parameters)
                edges[0] += name == "periodic_x_max" ? value : name == "periodic_x_min" ? -value : 0;
            if (!(edges[0] > 0))
                throw io_failure(path, "write the box", "periodic_x_max has to be larger than periodic_x_min");
            Id dataset = make_dataset("/particles/all/box/edges", H5T_IEEE_F64LE, {3}, false, 0, "m");
            check(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, edges), "write the box");
        }
        set_integers(box, "dimension", {}, &dimension);
        check(H5Tset_size(type, sizeof boundary[0]), "describe a text");
        set_attribute(box, "boundary", type, type, {3}, boundary);
    }

    // --------------------------------------------------------------------------------------------------- frames

    // Some values of an element as they are stored; component: its first one.
    const double *pack(const Element &element, const FrameRows &rows, const RowRequest &some) {
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
    void write_rows(const Element &element, hid_t dataset, const FrameRows &rows, std::size_t component,
                    std::vector<hsize_t> start, std::vector<hsize_t> shape, std::size_t particles, const See &see) {
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
    void extend(hid_t dataset, std::vector<hsize_t> shape, const std::string &what) const {
        shape.insert(shape.begin(), static_cast<hsize_t>(frames) + 1);
        check(H5Dset_extent(dataset, shape.data()), what);
    }

    void append_rows(const Element &element, const FrameRows &rows, std::size_t component) {
        std::vector<hsize_t> shape = shape_of(element);
        extend(element.value, shape, "write " + element.name);
        shape.insert(shape.begin(), 1);
        std::vector<hsize_t> start(shape.size(), 0);
        start[0] = static_cast<hsize_t>(frames);
        write_rows(element, element.value, rows, component, start, shape, 1, [](const double *, int64_t, int64_t) {});
    }

    void append(hid_t dataset, std::vector<hsize_t> shape, hid_t type, const void *data,
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
    void make_view(const std::string &name, const Element &element) const {
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

    std::string outer_group() const { return group_of_views(frames); }

    std::string frame_group() const { return group_of_frame(frames); }

    void make_views() const {
        const std::string outer = outer_group(), inner = frame_group();
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
    void place_walls(const std::vector<double> &points) {
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

    void write(int64_t step_number, double seconds, const FrameRows &rows, const std::vector<double> &values,
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
        commit("write a frame");
        // Only now: a reader that goes by the number of times finds all else.
        append(step, {}, H5T_NATIVE_INT64, &step_number, "write the step");
        append(time, {}, H5T_NATIVE_DOUBLE, &seconds, "write the time");
        commit("write a frame");
        if (wall_point_count > 0 && wall_path.empty()) { // later frames may refer to it only now
            wall_points = points;
            wall_path = frame_group() + "/walls";
        }
    }

    void list_frame(double seconds) {
        const std::string group = frame_group() + "/";
        side.begin_frame(frames, seconds, group + "position");
        for (const Element &element : elements)
            if (!element.is_position())
                side.add_field(element.name, element.components, element.integer,
                               element.constant ? element.path() : group + element.name);
        side.end_frame(wall_path); // VTK's readers follow no links
    }

    // The XDMF file first: it lists frames that the HDF5 file has before and after.
    void publish() {
        if (::fsync(store.fd) != 0)
            throw io_failure(path, "sync the file", errno);
        const std::string side_target = replaceable_path(side_path);
        move_into_place(side_file_name, side_target);
        side.renamed(side_target);
        move_into_place(file_name, replaceable_path(path));
        suffix = "";
        release_replaced();
    }

    void write_side() {
        if (const int error = side.write())
            throw io_failure(side_path, "write the file", error);
    }

    // How many pointers to values the constant fields have, or the others.
    static size_t pointers(const std::vector<Element> &elements, bool constant) {
        size_t n = 0;
        for (const Element &element : elements)
            n += element.constant == constant ? static_cast<size_t>(element.components) : 0;
        return n;
    }
};

FrameFile::FrameFile(const std::string &path, const FrameHeader &header, std::vector<FrameField> fields,
                     const FrameRows &constant_values, int compression, bool single_precision, bool beside)
    : impl_(new Impl) {
    Session session;
    impl_->suffix = beside ? ".part" : "";
    impl_->path = path;
    impl_->count = header.count;
    impl_->compression = compression;
    impl_->single = single_precision;
    impl_->unit = single_precision ? position_unit(header.spacing) : 0;
    bool has_position = false;
    for (const FrameField &f : fields) {
        impl_->elements.push_back({f.name, f.unit != nullptr ? f.unit : "", f.components, f.constant, f.integer, Id()});
        has_position |= impl_->elements.back().name == "position" && f.components == 2 && !f.constant;
    }
    if (!has_position || Impl::pointers(impl_->elements, true) != constant_values.components())
        throw io_failure(path, "create the file", "the fields lack a position, or a constant field its values");
    try {
        impl_->open_files();
        impl_->create(header, constant_values);
        impl_->write_side();
    } catch (...) {
        impl_->abandon();
        impl_.reset();
        throw;
    }
}

FrameFile::~FrameFile() {
    try {
        close();
    } catch (const std::exception &) {
    }
    Session session;
    impl_.reset();
}

void FrameFile::write(int64_t step, double time, const FrameRows &rows, const std::vector<double> &observables,
                      const std::vector<double> &wall_points) {
    Session session;
    Impl &impl = *impl_;
    const char *const wrong = !impl.is_open                                               ? "it is closed"
                              : Impl::pointers(impl.elements, false) != rows.components() ? "wrong number of components"
                              : impl.observable_count != observables.size()     ? "wrong number of observables"
                              : 3 * impl.wall_point_count != wall_points.size() ? "wrong number of points of walls"
                                                                                : nullptr;
    if (wrong)
        throw io_failure(impl.path, "write a frame", wrong);
    try {
        if (impl.file < 0)
            impl.reopen();
        impl.write(step, time, rows, observables, wall_points);
    } catch (...) {
        impl.wall_path.clear(); // with what was not committed
        impl.abandon();
        throw;
    }
    impl.list_frame(time);
    ++impl.frames;
    impl.write_side();
}

void FrameFile::publish() {
    Session session;
    impl_->publish();
}

void FrameFile::close() {
    Session session;
    impl_->close();
}

int64_t FrameFile::frames() const {
    return impl_->frames;
}

} // namespace gp::io
