// A driver of HDF5 by which it has for its file a Store of ours: all that it reads and writes goes through that. Without a lock.
//
// HDF5 finds the store in the property list of access, as a pointer to it. A Store has
//   haddr_t eoa, end                            end of what HDF5 has allocated, and of what is there
//   void open()                                 HDF5 begins with it
//   bool read(address, size, bytes) const       false: it could not
//   void write(type, address, size, bytes)      after a write that failed HDF5 can neither close the file nor end quietly: it never
//                                               sees one, and the store tells
//   void truncate()                             to what has been allocated
#pragma once

#include <algorithm>
#include <cstdlib>
#include <iterator>

#include <hdf5.h>
#if H5_VERSION_GE(1, 13, 0)
#include <H5FDdevelop.h>
#endif

namespace gp::io {

template <class Store> struct StoreFile {
    H5FD_t base; // HDF5's part, has to be first
    Store *store;
};

template <class Store> Store &store_of(const H5FD_t *file) {
    return *reinterpret_cast<const StoreFile<Store> *>(file)->store;
}

// number: any that HDF5 leaves to applications. Features: those of H5FD_FEAT_... that HDF5 may count on.
template <class Store, unsigned long Features> H5FD_class_t driver_of(const char *name, [[maybe_unused]] int number) {
    H5FD_class_t c{};
#if H5_VERSION_GE(1, 13, 0)
    c.version = H5FD_CLASS_VERSION;
    c.value = number;
#endif
    c.name = name;
    c.maxaddr = (haddr_t{1} << 62) - 1;
    c.fc_degree = H5F_CLOSE_STRONG;
    c.fapl_size = sizeof(void *); // of a property list: where its store is
    c.open = [](const char *, unsigned, hid_t access, haddr_t) -> H5FD_t * {
        auto *file = static_cast<StoreFile<Store> *>(std::calloc(1, sizeof(StoreFile<Store>)));
        if (file == nullptr)
            return nullptr;
        file->store = *static_cast<Store *const *>(H5Pget_driver_info(access));
        file->store->open();
        return &file->base;
    };
    c.close = [](H5FD_t *file) -> herr_t { return std::free(file), 0; };
    c.query = [](const H5FD_t *, unsigned long *flags) -> herr_t {
        if (flags != nullptr)
            *flags = Features;
        return 0;
    };
    c.get_eoa = [](const H5FD_t *file, H5FD_mem_t) { return store_of<Store>(file).eoa; };
    c.set_eoa = [](H5FD_t *file, H5FD_mem_t, haddr_t eoa) -> herr_t { return store_of<Store>(file).eoa = eoa, 0; };
    c.get_eof = [](const H5FD_t *file, H5FD_mem_t) { return store_of<Store>(file).end; };
    c.read = [](H5FD_t *file, H5FD_mem_t, hid_t, haddr_t address, size_t size, void *bytes) -> herr_t {
        return store_of<Store>(file).read(address, size, bytes) ? 0 : -1;
    };
    c.write = [](H5FD_t *file, H5FD_mem_t type, hid_t, haddr_t address, size_t size, const void *bytes) -> herr_t {
        return store_of<Store>(file).write(type, address, size, bytes), 0;
    };
    c.truncate = [](H5FD_t *file, hid_t, hbool_t) -> herr_t { return store_of<Store>(file).truncate(), 0; };
    std::fill(std::begin(c.fl_map), std::end(c.fl_map), H5FD_MEM_DEFAULT);
    return c;
}

} // namespace gp::io
