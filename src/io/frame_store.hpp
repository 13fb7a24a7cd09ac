// How the bytes of a result file reach the disk. Only frame_file.cpp includes this.
#pragma once

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <exception>
#include <vector>

#include <sys/stat.h>
#include <unistd.h>

#include "io/hdf5_driver.hpp"
#include "io/safe_file.hpp"

namespace gp::io {

// The bytes of the HDF5 file. HDF5's own drivers write in any order, so that a program killed between two writes can
// leave a file without a readable frame, and after a failed write HDF5 can neither close the file nor end quietly.
// Here, what falls on new space goes to the disk at once, because nothing refers to it yet; what changes the committed
// part waits for commit(), which writes it in an order in which the file is valid after each write. HDF5 never sees a
// write fail: after a failure everything stays in memory, and commit() tells. Readers may look at the file while it grows.
struct FrameStore {
    struct Change {
        int rank;
        haddr_t address;
        std::vector<unsigned char> bytes;
    };

    int fd = -1;
    int error = 0;         // errno of the first failure since the last rollback
    haddr_t committed = 0; // end of the committed part
    haddr_t eoa = 0;       // end of what HDF5 has allocated
    haddr_t end = 0;       // end of what HDF5 has written
    std::vector<Change> changes;

    // The place of a change in commit(). First the superblock, which makes new space legal to refer to; then what only
    // adds: names, values, and the global heap, which HDF5 hands over as values; trees from the root down, so that a
    // node that was split is never looked up in the half that it no longer has; and last the sizes of the datasets.
    static int rank(H5FD_mem_t type, const unsigned char *bytes, size_t size) {
        switch (type) {
        case H5FD_MEM_SUPER: return 0;
        case H5FD_MEM_LHEAP: return 1;
        case H5FD_MEM_DRAW:
        case H5FD_MEM_GHEAP: return 2;
        case H5FD_MEM_BTREE: return size > 5 && std::memcmp(bytes, "TREE", 4) == 0 ? 300 - bytes[5] : 301;
        default: return 302;
        }
    }

    // A program that is killed while it writes leaves a part of it: the kernel copies page by page and looks for a kill
    // between two. So no block lies across the end of a page: half of a changed table of names or of a node could not be
    // read (HDF5 goes round for ever in half of a global heap). A global heap, of a page, must not grow either, as it would
    // if it were the last block.
    static constexpr haddr_t page = 4096; // or a multiple

    void open() {
        struct stat status;
        eoa = 0;
        end = ::fstat(fd, &status) == 0 ? static_cast<haddr_t>(status.st_size) : 0;
    }
    void truncate() noexcept { end = eoa; }

    haddr_t allocate(hsize_t size) noexcept {
        const haddr_t address = size <= page && eoa % page + size > page ? eoa + page - eoa % page : eoa;
        eoa = address + size + (size == page ? 8 : 0);
        return address;
    }

    void write(H5FD_mem_t type, haddr_t address, size_t size, const void *source) noexcept {
        end = std::max(end, address + size);
        if (error == 0 && address >= committed) {
            if (write_all(fd, source, size, address))
                return;
            error = errno;
        }
        try {
            const unsigned char *bytes = static_cast<const unsigned char *>(source);
            const auto same = [=](const Change &c) { return c.address == address && c.bytes.size() == size; };
            changes.erase(std::remove_if(changes.begin(), changes.end(), same), changes.end());
            changes.push_back({rank(type, bytes, size), address, std::vector<unsigned char>(bytes, bytes + size)});
        } catch (const std::exception &) {
            error = ENOMEM;
        }
    }

    bool read(haddr_t address, size_t size, void *destination) const noexcept {
        if (!read_or_zeros(fd, destination, size, address))
            return false;
        char *bytes = static_cast<char *>(destination);
        for (const Change &change : changes) {
            const haddr_t first = std::max(address, change.address);
            const haddr_t last = std::min(address + size, change.address + change.bytes.size());
            if (first < last)
                std::memcpy(bytes + (first - address), &change.bytes[first - change.address], last - first);
        }
        return true;
    }

    // Makes all that was written part of the file. Returns 0 or an errno.
    int commit() {
        struct stat status;
        if (error == 0 && (::fstat(fd, &status) != 0 || (static_cast<haddr_t>(status.st_size) < eoa &&
                                                         ::ftruncate(fd, static_cast<off_t>(eoa)) != 0)))
            error = errno;
        if (error != 0)
            return error;
        committed = std::max(committed, eoa); // from here on the file may refer to it
        std::stable_sort(changes.begin(), changes.end(),
                         [](const Change &a, const Change &b) { return a.rank < b.rank; });
        for (const Change &change : changes)
            if (error == 0 && !write_all(fd, change.bytes.data(), change.bytes.size(), change.address))
                error = errno;
        if (error == 0)
            changes.clear();
        return error;
    }

    void rollback() noexcept {
        changes.clear();
        error = 0;
        eoa = committed;
        if (fd >= 0 && ::ftruncate(fd, static_cast<off_t>(committed)) != 0)
            return; // longer than it needs to be, but valid
    }
};

inline const H5FD_class_t &frame_store_driver() {
    static const H5FD_class_t driver = [] {
        H5FD_class_t c =
            driver_of<FrameStore, H5FD_FEAT_DATA_SIEVE | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE>("granperi", 1024);
        c.alloc = [](H5FD_t *file, H5FD_mem_t, hid_t, hsize_t size) {
            return store_of<FrameStore>(file).allocate(size);
        };
        return c;
    }();
    return driver;
}

} // namespace gp::io
