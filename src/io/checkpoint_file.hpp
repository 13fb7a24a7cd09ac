// The container of a checkpoint: named numbers and arrays in an HDF5 file behind a block of text.
//
//   byte 0     granperi checkpoint
//              format 3
//              library 0.2.0
//              bytes <of the whole file, 20 digits>
//              checksum <of all other bytes, 16 hexadecimal digits>
//              and zeros up to byte 512
//   byte 512   HDF5: groups with numbers as attributes and arrays as one-dimensional datasets
//
// The text has this form in every format, so that damage can be told from a newer version. The file is made and read in
// memory: HDF5 sees nothing but what has the right checksum.
#pragma once

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "io/hdf5_writer.hpp"

namespace gp::io {

constexpr uint32_t checkpoint_format = 3;

// Writes the text in front of a whole file, whose first 512 bytes are free for it.
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

// Writer and reader have the same calls, so that one description of a part serves both.
class CheckpointWriter : private Hdf5Writer {
public:
    static constexpr bool reads = false;

    explicit CheckpointWriter(const std::string &file_path);

    void group(const char *name);
    template <class T> void value(const char *name, const T &number) {
        set_attribute(group_, name, stored_type<T>(), native_type<T>(), {}, &number);
    }
    void value(const char *name, const bool &yes) { value(name, static_cast<int32_t>(yes)); }
    template <class Array> void array(const char *name, const Array &values) {
        using T = typename Array::value_type;
        write_array(name, stored_type<T>(), native_type<T>(), values.size(), values.data());
    }

    // The whole file.
    std::vector<unsigned char> bytes();

private:
    void write_array(const char *name, hid_t stored, hid_t native, std::size_t size, const void *values);

    Id group_;
};

class CheckpointReader : private Hdf5Writer {
public:
    static constexpr bool reads = true;

    // Checks the text and the checksum, and takes the bytes. Throws gp::Error: GP_E_IO, GP_E_VERSION.
    CheckpointReader(const std::string &file_path, std::vector<unsigned char> bytes);

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
        using T = typename Array::value_type;
        const Id dataset = open_array(name, stored_type<T>());
        values.resize(array_size(name, dataset, sizeof(T)));
        read_array(name, dataset, native_type<T>(), values.data(), values.size());
    }

    // What the file holds cannot be.
    [[noreturn]] void refuse(const std::string &why) const;

private:
    void read_value(const char *name, hid_t stored, hid_t native, void *number) const;
    Id open_array(const char *name, hid_t stored) const;
    std::size_t array_size(const char *name, hid_t dataset, std::size_t item) const;
    void read_array(const char *name, hid_t dataset, hid_t native, void *values, std::size_t size) const;
    void require_type(const std::string &what, hid_t found, hid_t stored) const;

    std::size_t file_size_ = 0;
    std::string group_name_;
    Id group_;
};

} // namespace gp::io
