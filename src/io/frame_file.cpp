#include "io/frame_file.hpp"

#include <cerrno>
#include <filesystem>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "error.hpp"
#include "io/frame_datasets.hpp"
#include "io/frame_store.hpp"
#include "io/safe_file.hpp"
#include "io/xdmf_file.hpp"

namespace gp::io {

std::string group_of_views(int64_t frame) {
    return format_text("/frames/%06lld", static_cast<long long>(frame - frame % views_per_group));
}
std::string group_of_frame(int64_t frame) {
    return group_of_views(frame) + format_text("/%06lld", static_cast<long long>(frame));
}

struct FrameFile::Impl : FrameDatasets {
    std::string side_path;
    bool is_open = false;                  // the files on the disk are ours
    const char *suffix = "";               // of the files until they are published
    std::string file_name, side_file_name; // with it
    int replaced_fd = -1;                  // of the XDMF file that will be replaced: holds its lock
    FrameStore store;
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
        close_datasets();
        return file < 0 || H5Fclose(file.release()) >= 0;
    }

    // Leaves the file on the disk as it was last committed. HDF5 itself closes as usual, into memory: see FrameStore.
    void abandon() noexcept {
        if (!is_open)
            return;
        store.error = store.error != 0 ? store.error : ECANCELED;
        close_hdf5();
        store.rollback();
    }

    void create(const FrameHeader &header, const FrameRows &constant_values) {
        driver = own(H5FDregister(&frame_store_driver()), "register the file driver");
        access = own(H5Pcreate(H5P_FILE_ACCESS), "describe the file");
        FrameStore *const target = &store;
        check(H5Pset_driver(access, driver, &target), "set the file driver");
        check(H5Pset_fclose_degree(access, H5F_CLOSE_STRONG), "describe the file");
        check(H5Pset_cache(access, 0, 0, 0, 0.0), "describe the file"); // every chunk is written once and whole
        Id how = own(H5Pcreate(H5P_FILE_CREATE), "describe the file");
        // Freed space is never used again: an earlier state of the file may still refer to it.
        check(H5Pset_file_space_strategy(how, H5F_FSPACE_STRATEGY_NONE, false, 1), "describe the file");
        file = own(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, how, access), "create the file");
        make_layout(header, constant_values);
        commit("create the file");
        side.set_cells(cells);
        side.set_walls("/walls/segments", wall_segment_count, "/walls/plate", wall_point_count);
    }

    void reopen() {
        file = own(H5Fopen(path.c_str(), H5F_ACC_RDWR, access), "open the file again");
        open_datasets();
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

    void write(int64_t step_number, double seconds, const FrameRows &rows, const std::vector<double> &values,
               const std::vector<double> &points) {
        append_values(rows, values, points);
        commit("write a frame");
        append_clock(step_number, seconds); // only now: a reader that goes by the number of times finds all else
        commit("write a frame");
        remember_walls(points);
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
    bool has_position = false;
    for (const FrameField &f : fields) {
        impl_->elements.push_back({f.name, f.unit != nullptr ? f.unit : "", f.components, f.constant, f.integer, Id()});
        has_position |= impl_->elements.back().name == "position" && f.components == 2 && !f.constant;
    }
    if (!has_position || impl_->components(true) != constant_values.components())
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
    const char *const wrong = !impl.is_open                                     ? "it is closed"
                              : impl.components(false) != rows.components()     ? "wrong number of components"
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
        impl.forget_walls(); // with what was not committed
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
