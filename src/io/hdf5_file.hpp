// An HDF5 file that a library writes or reads: every error is an exception with HDF5's text and nothing of it on
// the host's screen, and every identifier closes itself.
#pragma once

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <hdf5.h>

#include "error.hpp"

namespace gp::io {

// The host's handler of HDF5 errors steps aside while HDF5 works for us: it may print, or even end the program.
class Session {
public:
    Session() {
        errno = 0;
        hbool_t safe = false;
        // Two simulations could meet inside an HDF5 without thread safety. One with it has its own lock, which the
        // host may hold already when it calls us: a second lock could then block both.
        if (H5is_library_threadsafe(&safe) < 0 || !safe)
            lock_ = std::unique_lock<std::mutex>(mutex());
        unsigned second = 1;
        H5Eauto_is_v2(H5E_DEFAULT, &second);
        second_ = second != 0;
        if (second_) {
            H5Eget_auto2(H5E_DEFAULT, &handler2_, &data_);
            H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
        } else {
            H5Eget_auto1(&handler1_, &data_);
            H5Eset_auto1(nullptr, nullptr);
        }
    }
    Session(const Session &) = delete;
    Session &operator=(const Session &) = delete;
    ~Session() {
        H5Eclear2(H5E_DEFAULT);
        if (second_)
            H5Eset_auto2(H5E_DEFAULT, handler2_, data_);
        else
            H5Eset_auto1(handler1_, data_);
    }

private:
    static std::mutex &mutex() {
        static std::mutex one;
        return one;
    }

    std::unique_lock<std::mutex> lock_;
    bool second_ = true;
    H5E_auto2_t handler2_ = nullptr;
    H5E_auto1_t handler1_ = nullptr;
    void *data_ = nullptr;
};

// Owns one HDF5 identifier of any kind.
class Id {
public:
    Id() = default;
    explicit Id(hid_t id) : id_(id) {}
    Id(Id &&other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)) {}
    Id &operator=(Id &&other) noexcept {
        std::swap(id_, other.id_);
        return *this;
    }
    ~Id() { close(); }
    void close() {
        if (id_ >= 0)
            H5Idec_ref(id_);
        id_ = H5I_INVALID_HID;
    }
    hid_t release() { return std::exchange(id_, H5I_INVALID_HID); }
    operator hid_t() const { return id_; }

private:
    hid_t id_ = H5I_INVALID_HID;
};

// The innermost message on HDF5's error stack: the one that tells the cause.
inline std::string hdf5_text() {
    char text[256] = "";
    const auto take = [](unsigned n, const H5E_error2_t *error, void *data) -> herr_t {
        if (n == 0 && error->desc != nullptr)
            std::snprintf(static_cast<char *>(data), sizeof text, "%s", error->desc);
        return 0;
    };
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take, text);
    return text[0] != '\0' ? text : "HDF5 gives no reason";
}

// Whether HDF5 failed for want of memory, as malloc or its messages tell: without memory it may have lost these.
inline bool hdf5_lacks_memory() {
    bool lacks = errno == ENOMEM;
    const auto look = [](unsigned, const H5E_error2_t *error, void *data) -> herr_t {
        const char *const text = error->desc != nullptr ? error->desc : "";
        if (error->min_num == H5E_NOSPACE || std::strstr(text, "memory alloc") != nullptr)
            *static_cast<bool *>(data) = true;
        return 0;
    };
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, look, &lacks);
    return lacks;
}

inline Error io_failure(const std::string &of, const std::string &what, const std::string &why,
                        gp_status status = GP_E_IO) {
    return make_error(status, "%s: cannot %s: %s", of.c_str(), what.c_str(), why.c_str());
}

// number: an errno.
inline Error io_failure(const std::string &of, const std::string &what, int number) {
    return io_failure(of, what, std::generic_category().message(number), number == ENOMEM ? GP_E_MEMORY : GP_E_IO);
}

inline Error hdf5_failure(const std::string &of, const std::string &what) {
    const bool lacks = hdf5_lacks_memory(); // first: errno
    return io_failure(of, what, hdf5_text(), lacks ? GP_E_MEMORY : GP_E_IO);
}

// One file, and the calls that make its objects.
struct Hdf5File {
    static constexpr hsize_t particles_per_chunk = 65536;
    static constexpr hsize_t times_per_chunk = 512;

    std::string path;
    Id driver, access, file;

    // HDF5 calls abort() where it finds another version than it was compiled for.
    void check_version() const {
        unsigned v[3] = {0, 0, 0};
        H5get_libversion(&v[0], &v[1], &v[2]);
        if (v[0] != H5_VERS_MAJOR || v[1] != H5_VERS_MINOR || v[2] != H5_VERS_RELEASE)
            throw io_failure(path, "use HDF5",
                             format_text("compiled for version %d.%d.%d, but %u.%u.%u is loaded", H5_VERS_MAJOR,
                                         H5_VERS_MINOR, H5_VERS_RELEASE, v[0], v[1], v[2]));
    }

    template <class T> T check(T result, const std::string &what) const {
        if (result < 0)
            throw hdf5_failure(path, what);
        return result;
    }

    Id own(hid_t id, const std::string &what) const { return Id(check(id, what)); }

    Id space(const std::vector<hsize_t> &size, const std::vector<hsize_t> &limit) const {
        return own(H5Screate_simple(static_cast<int>(size.size()), size.data(), limit.data()), "describe an array");
    }

    // An even split, so that the last chunk is not mostly empty.
    static hsize_t rows_per_chunk(hsize_t rows) {
        const hsize_t parts = std::max<hsize_t>(1, (rows + particles_per_chunk - 1) / particles_per_chunk);
        return std::max<hsize_t>(1, (rows + parts - 1) / parts);
    }

    // An array of rows of this shape: frames, of which there are none yet, or a single one without a frame dimension.
    Id make_dataset(const std::string &name, hid_t type, std::vector<hsize_t> shape, bool per_frame, int compression,
                    const std::string &unit) const {
        const std::string what = "create " + name;
        std::vector<hsize_t> limit = shape, chunk = shape;
        for (hsize_t &extent : chunk)
            extent = rows_per_chunk(extent);
        if (per_frame) {
            chunk.insert(chunk.begin(), shape.empty() ? times_per_chunk : 1);
            limit.insert(limit.begin(), H5S_UNLIMITED);
            shape.insert(shape.begin(), 0);
        }
        Id how = own(H5Pcreate(H5P_DATASET_CREATE), what);
        Id links = own(H5Pcreate(H5P_LINK_CREATE), what);
        check(H5Pset_create_intermediate_group(links, 1), what);
        check(H5Pset_obj_track_times(how, false), what); // the same results give the same file
        check(H5Pset_chunk(how, static_cast<int>(chunk.size()), chunk.data()), what);
        if (compression > 0) {
            check(H5Pset_shuffle(how), what);
            check(H5Pset_deflate(how, static_cast<unsigned>(compression)), what);
        }
        Id dataset = own(H5Dcreate2(file, name.c_str(), type, space(shape, limit), links, how, H5P_DEFAULT), what);
        if (!unit.empty())
            set_text(dataset, "unit", unit);
        return dataset;
    }

    void set_attribute(hid_t object, const char *name, hid_t stored, hid_t type, const std::vector<hsize_t> &size,
                       const void *data) const {
        const std::string what = std::string("write the attribute ") + name;
        Id extent = size.empty() ? own(H5Screate(H5S_SCALAR), what) : space(size, size);
        Id attribute = own(H5Acreate2(object, name, stored, extent, H5P_DEFAULT, H5P_DEFAULT), what);
        check(H5Awrite(attribute, type, data), what);
    }

    void set_text(hid_t object, const char *name, const std::string &text) const {
        Id type = own(H5Tcopy(H5T_C_S1), "describe a text");
        check(H5Tset_size(type, text.size() + 1), "describe a text");
        set_attribute(object, name, type, type, {}, text.c_str());
    }

    void set_texts(hid_t object, const char *name, const std::vector<std::string> &texts) const {
        std::size_t width = 1; // of each, ended by a 0
        for (const std::string &text : texts)
            width = std::max(width, text.size() + 1);
        std::string packed;
        for (const std::string &text : texts)
            packed += text + std::string(width - text.size(), '\0');
        Id type = own(H5Tcopy(H5T_C_S1), "describe a text");
        check(H5Tset_size(type, width), "describe a text");
        set_attribute(object, name, type, type, {texts.size()}, packed.data());
    }

    void set_integers(hid_t object, const char *name, const std::vector<hsize_t> &size, const int64_t *values) const {
        set_attribute(object, name, H5T_STD_I64LE, H5T_NATIVE_INT64, size, values);
    }

    void set_numbers(hid_t object, const char *name, const std::vector<hsize_t> &size, const double *values) const {
        set_attribute(object, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, size, values);
    }

    Id make_group(const std::string &name, int64_t links_expected) const {
        Id how = own(H5Pcreate(H5P_GROUP_CREATE), "create " + name);
        // 8 bytes for each name of 6 or 7 digits, and some to spare
        check(H5Pset_local_heap_size_hint(how, static_cast<size_t>(8 * links_expected + 40)), "create " + name);
        return own(H5Gcreate2(file, name.c_str(), H5P_DEFAULT, how, H5P_DEFAULT), "create " + name);
    }
};

} // namespace gp::io
