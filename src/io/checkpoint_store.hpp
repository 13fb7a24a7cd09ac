// How the HDF5 part of a checkpoint reaches the disk, and comes from there: behind a block of text. Only checkpoint_file.cpp
// includes this.
#pragma once

#include <algorithm>
#include <cerrno>
#include <cstdint>

#include <unistd.h>

#include "io/hdf5_driver.hpp"
#include "io/safe_file.hpp"

namespace gp::io {

// What HDF5 has as a file, in a part of another one.
struct CheckpointStore {
    int fd = -1;
    uint64_t shift = 0; // bytes of text
    int error = 0;      // errno of the first write that failed
    haddr_t eoa = 0;    // end of what HDF5 has allocated
    haddr_t end = 0;    // end of what is there

    void open() {}
    void write(H5FD_mem_t, haddr_t address, size_t size, const void *source) noexcept {
        end = std::max(end, address + size);
        if (error == 0 && !write_all(fd, source, size, shift + address))
            error = errno;
    }
    bool read(haddr_t address, size_t size, void *destination) const noexcept {
        return read_or_zeros(fd, destination, size, shift + address);
    }
    void truncate() noexcept {
        end = eoa;
        if (error == 0 && ::ftruncate(fd, static_cast<off_t>(shift + end)) != 0)
            error = errno;
    }
};

inline const H5FD_class_t &checkpoint_store_driver() {
    static const H5FD_class_t driver =
        driver_of<CheckpointStore, H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
                                       H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE>(
            "granperi checkpoint", 1025);
    return driver;
}

} // namespace gp::io
