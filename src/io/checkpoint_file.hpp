// The container of a checkpoint: named numbers and arrays in an HDF5 file behind a block of text.
//
//   byte 0     granperi checkpoint
//              format 5
//              library 0.2.0
//              bytes <of the whole file, 20 digits>
//              checksum <of all other bytes, 16 hexadecimal digits>
//              and zeros up to byte 512
//   byte 512   HDF5: groups with numbers as attributes and arrays as one-dimensional datasets
//
// The text has this form in every format, so that damage can be told from a newer version. HDF5 reads nothing before the checksum
// has been found right: by the first of several processes, which read the same file. Nothing of the file is held in memory: what
// writes and reads arrays some values at a time needs no more.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "io/hdf5_file.hpp"
#include "io/safe_file.hpp"

namespace gp::io {

constexpr uint32_t checkpoint_format = 5;

// Writes the text in front of a whole file in memory, whose first 512 bytes are free for it.
void seal(std::vector<unsigned char> &file, uint32_t format = checkpoint_format);

template <class T> hid_t stored_type() {
    if constexpr (std::is_same_v<T, double>)
        return H5T_IEEE_F64LE;
    else if constexpr (std::is_same_v<T, int64_t>)
        return H5T_STD_I64LE;
    else if constexpr (std::is_same_v<T, uint64_t>)
        return H5T_STD_U64LE;
    else if constexpr (std::is_same_v<T, uint32_t>)
        return H5T_STD_U32LE;
    else if constexpr (std::is_same_v<T, uint8_t>)
        return H5T_STD_U8LE;
    else {
        static_assert(std::is_same_v<T, int32_t>);
        return H5T_STD_I32LE;
    }
}

template <class T> hid_t native_type() {
    if constexpr (std::is_same_v<T, double>)
        return H5T_NATIVE_DOUBLE;
    else if constexpr (std::is_same_v<T, int64_t>)
        return H5T_NATIVE_INT64;
    else if constexpr (std::is_same_v<T, uint64_t>)
        return H5T_NATIVE_UINT64;
    else if constexpr (std::is_same_v<T, uint32_t>)
        return H5T_NATIVE_UINT32;
    else if constexpr (std::is_same_v<T, uint8_t>)
        return H5T_NATIVE_UINT8;
    else {
        static_assert(std::is_same_v<T, int32_t>);
        return H5T_NATIVE_INT32;
    }
}

struct CheckpointStore;

// Writer and reader have the same calls, so that one description of a part serves both.
class CheckpointWriter : private Hdf5File {
public:
    static constexpr bool reads = false;

    explicit CheckpointWriter(const std::string &file_path);
    ~CheckpointWriter();

    void group(const char *name);
    template <class T> void value(const char *name, const T &number) {
        set_attribute(group_, name, stored_type<T>(), native_type<T>(), {}, &number);
    }
    void value(const char *name, const bool &yes) { value(name, static_cast<int32_t>(yes)); }
    template <class Array> void array(const char *name, const Array &values) { array(name, values, values.size()); }
    // Of the first so many values.
    template <class Array> void array(const char *name, const Array &values, std::size_t size) {
        using T = typename Array::value_type;
        Growing array = begin_array<T>(name, size);
        append(array, values.data(), size);
    }

    // An array of so many values, which come some at a time.
    struct Growing {
        std::string name;
        Id dataset;
        hid_t native;
        std::size_t size, done = 0;
    };
    template <class T> Growing begin_array(const char *name, std::size_t size) {
        return {name, make_array(name, stored_type<T>(), size), native_type<T>(), size};
    }
    void append(Growing &array, const void *values, std::size_t count);

    // The file is whole.
    void put_into_place();

private:
    Id make_array(const char *name, hid_t stored, std::size_t size);

    std::unique_ptr<CheckpointStore> store_;
    NewFile new_file_;
    Id group_;
};

class CheckpointReader : private Hdf5File {
public:
    static constexpr bool reads = true;

    // Checks what the text says of the file but for its checksum. Throws gp::Error: GP_E_IO.
    explicit CheckpointReader(const std::string &file_path);
    ~CheckpointReader();
    // Reads all of the file for its checksum. Throws gp::Error: GP_E_IO, GP_E_VERSION.
    void require_whole() const;
    // Of a file that is whole. Within a Session.
    void open();
    // With its checksum.
    const std::string &text() const { return text_; }

    void group(const char *name);
    template <class T> void value(const char *name, T &number) {
        read_value(name, stored_type<T>(), native_type<T>(), &number);
    }
    void value(const char *name, bool &yes) {
        int32_t number = 0;
        value(name, number);
        if (number != 0 && number != 1)
            refuse(group_name_ + "/" + name + " is neither 0 nor 1");
        yes = number == 1;
    }
    template <class Array> void array(const char *name, Array &values) {
        values.resize(size_of<typename Array::value_type>(name));
        array(name, values, values.size());
    }
    // Of so many values, which is what there has to be; what is behind them stays as it is.
    template <class Array> void array(const char *name, Array &values, std::size_t size) {
        using T = typename Array::value_type;
        require_size(name, size_of<T>(name), size);
        some(name, 0, size, values.data());
    }
    template <class T> std::size_t size_of(const char *name) const {
        return array_size(name, open_array(name, stored_type<T>()), sizeof(T));
    }
    // A stretch of an array, or its values at some places: those are within it.
    template <class T> void some(const char *name, std::size_t first, std::size_t count, T *values) const {
        read_some_of(name, open_array(name, stored_type<T>()), native_type<T>(), first, count, values);
    }
    template <class T> void some(const char *name, const std::vector<hsize_t> &places, T *values) const {
        read_at(name, open_array(name, stored_type<T>()), native_type<T>(), places, values);
    }

    // What the file holds cannot be.
    [[noreturn]] void refuse(const std::string &why) const;

private:
    void read_value(const char *name, hid_t stored, hid_t native, void *number) const;
    Id open_array(const char *name, hid_t stored) const;
    std::size_t array_size(const char *name, hid_t dataset, std::size_t item) const;
    void require_size(const char *name, std::size_t size, std::size_t expected) const;
    void read_some_of(const char *name, hid_t dataset, hid_t native, std::size_t first, std::size_t count,
                      void *values) const;
    void read_at(const char *name, hid_t dataset, hid_t native, const std::vector<hsize_t> &places, void *values) const;
    void require_type(const std::string &what, hid_t found, hid_t stored) const;

    OldFile old_file_;
    std::string text_;
    std::unique_ptr<CheckpointStore> store_;
    std::string group_name_;
    Id group_;
};

} // namespace gp::io
