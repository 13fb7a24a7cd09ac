// How the HDF5 part of a checkpoint reaches the disk, and comes from there: behind a block of text. Only checkpoint_file.cpp
// includes this.
#pragma once

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iterator>

#include <hdf5.h>
#if H5_VERSION_GE(1, 13, 0)
#include <H5FDdevelop.h>
#endif
#include <sys/stat.h>
#include <unistd.h>

#include "io/safe_file.hpp"

namespace gp::io {

// What HDF5 has as a file, in a part of another one. After a write that failed HDF5 can neither close the file nor end quietly:
// it never sees one; `error` tells.
struct CheckpointStore {
    int fd = -1;
    uint64_t shift = 0; // bytes of text
    int error = 0;      // errno of the first write that failed
    haddr_t eoa = 0;    // end of what HDF5 has allocated
    haddr_t end = 0;    // end of what is there

    void write(haddr_t address, size_t size, const void *source) noexcept {
        end = std::max(end, address + size);
        if (error == 0 && !write_all(fd, source, size, shift + address))
            error = errno;
    }
    // Zeros where nothing has been written.
    bool read(haddr_t address, size_t size, void *destination) const noexcept {
        try {
            const std::size_t done = read_some(fd, destination, size, shift + address, "");
            std::memset(static_cast<char *>(destination) + done, 0, size - done);
            return true;
        } catch (const std::exception &) {
            return false;
        }
    }
};

struct CheckpointStoreFile {
    H5FD_t base; // HDF5's part, has to be first
    CheckpointStore *store;
};

inline CheckpointStore &checkpoint_store_of(const H5FD_t *file) {
    return *reinterpret_cast<const CheckpointStoreFile *>(file)->store;
}

inline H5FD_t *open_checkpoint_store(const char *, unsigned, hid_t access, haddr_t) {
    auto *file = static_cast<CheckpointStoreFile *>(std::calloc(1, sizeof(CheckpointStoreFile)));
    if (file == nullptr)
        return nullptr;
    file->store = *static_cast<CheckpointStore *const *>(H5Pget_driver_info(access));
    return &file->base;
}

// A driver of HDF5 that hands everything to a CheckpointStore.
inline const H5FD_class_t &checkpoint_store_driver() {
    static const H5FD_class_t driver = [] {
        H5FD_class_t c{};
#if H5_VERSION_GE(1, 13, 0)
        c.version = H5FD_CLASS_VERSION;
        c.value = 1025; // any number that HDF5 leaves to applications
#endif
        c.name = "granperi checkpoint";
        c.maxaddr = (haddr_t{1} << 62) - 1;
        c.fc_degree = H5F_CLOSE_STRONG;
        c.fapl_size = sizeof(void *); // of a property list: where its store is
        c.open = open_checkpoint_store;
        c.close = [](H5FD_t *file) -> herr_t { return std::free(file), 0; };
        c.query = [](const H5FD_t *, unsigned long *flags) -> herr_t {
            if (flags != nullptr)
                *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
                         H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
            return 0;
        };
        c.get_eoa = [](const H5FD_t *file, H5FD_mem_t) { return checkpoint_store_of(file).eoa; };
        c.set_eoa = [](H5FD_t *file, H5FD_mem_t, haddr_t eoa) -> herr_t {
            return checkpoint_store_of(file).eoa = eoa, 0;
        };
        c.get_eof = [](const H5FD_t *file, H5FD_mem_t) { return checkpoint_store_of(file).end; };
        c.read = [](H5FD_t *file, H5FD_mem_t, hid_t, haddr_t address, size_t size, void *bytes) -> herr_t {
            return checkpoint_store_of(file).read(address, size, bytes) ? 0 : -1;
        };
        c.write = [](H5FD_t *file, H5FD_mem_t, hid_t, haddr_t address, size_t size, const void *bytes) -> herr_t {
            return checkpoint_store_of(file).write(address, size, bytes), 0;
        };
        c.truncate = [](H5FD_t *file, hid_t, hbool_t) -> herr_t {
            CheckpointStore &store = checkpoint_store_of(file);
            store.end = store.eoa;
            if (store.error == 0 && ::ftruncate(store.fd, static_cast<off_t>(store.shift + store.end)) != 0)
                store.error = errno;
            return 0;
        };
        std::fill(std::begin(c.fl_map), std::end(c.fl_map), H5FD_MEM_DEFAULT);
        return c;
    }();
    return driver;
}

} // namespace gp::io
