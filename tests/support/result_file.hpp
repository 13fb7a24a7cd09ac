// Looks into result files by HDF5 alone.
#pragma once

#include <hdf5.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace test {

// Reads with HDF5's own driver.
class Reader {
public:
    explicit Reader(const std::string &path) : file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)) {}
    ~Reader() { file >= 0 && H5Fclose(file) >= 0; }

    template <class T> std::vector<T> read(const std::string &name, hid_t type) const {
        std::vector<T> values;
        const hid_t dataset = H5Dopen2(file, name.c_str(), H5P_DEFAULT), space = H5Dget_space(dataset);
        values.resize(static_cast<std::size_t>(std::max<hssize_t>(0, H5Sget_simple_extent_npoints(space))));
        if (!values.empty() && H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
            values.clear();
        H5Sclose(space);
        H5Dclose(dataset);
        return values;
    }
    std::vector<double> numbers(const std::string &name) const { return read<double>(name, H5T_NATIVE_DOUBLE); }
    std::vector<int64_t> integers(const std::string &name) const { return read<int64_t>(name, H5T_NATIVE_INT64); }

    std::string shape(const std::string &name) const {
        hid_t dataset = H5I_INVALID_HID;
        H5E_BEGIN_TRY {
            dataset = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
        }
        H5E_END_TRY
        if (dataset < 0)
            return "missing";
        const hid_t space = H5Dget_space(dataset);
        hsize_t size[3] = {0, 0, 0};
        std::string text;
        for (int k = 0, rank = H5Sget_simple_extent_dims(space, size, nullptr); k < rank; ++k)
            text += (k > 0 ? " " : "") + std::to_string(size[k]);
        H5Sclose(space);
        H5Dclose(dataset);
        return text;
    }

    std::string stored_type(const std::string &name) const {
        const hid_t dataset = H5Dopen2(file, name.c_str(), H5P_DEFAULT), type = H5Dget_type(dataset);
        const std::map<hid_t, std::string> known = {
            {H5T_IEEE_F64LE, "f64"}, {H5T_IEEE_F32LE, "f32"}, {H5T_STD_I64LE, "i64"}};
        std::string text = "other";
        for (const auto &[id, label] : known)
            text = H5Tequal(type, id) > 0 ? label : text;
        H5Tclose(type);
        H5Dclose(dataset);
        return text;
    }

    // The elements of an array are separated by blanks.
    std::string text_attribute(const std::string &object, const std::string &name) const {
        const hid_t attribute = H5Aopen_by_name(file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
        const hid_t type = H5Aget_type(attribute);
        const std::size_t length = H5Tget_size(type);
        std::string raw(static_cast<std::size_t>(H5Aget_storage_size(attribute)), '\0'), text;
        H5Aread(attribute, type, &raw[0]);
        for (std::size_t k = 0; k < raw.size(); k += length)
            text += (k > 0 ? " " : "") + std::string(raw.substr(k, length).c_str());
        H5Tclose(type);
        H5Aclose(attribute);
        return text;
    }

    bool has(const std::string &name) const { return H5Lexists(file, name.c_str(), H5P_DEFAULT) > 0; }

    bool is_soft_link(const std::string &name) const {
        H5L_info_t info;
        return H5Lget_info(file, name.c_str(), &info, H5P_DEFAULT) >= 0 && info.type == H5L_TYPE_SOFT;
    }

    std::vector<double> attribute(const std::string &object, const std::string &name) const {
        const hid_t attribute = H5Aopen_by_name(file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
        const hid_t space = H5Aget_space(attribute);
        std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
        H5Aread(attribute, H5T_NATIVE_DOUBLE, values.data());
        H5Sclose(space);
        H5Aclose(attribute);
        return values;
    }

    haddr_t address(const std::string &name) const {
        H5O_info_t info;
        return H5Oget_info_by_name(file, name.c_str(), &info, H5P_DEFAULT) >= 0 ? info.addr : HADDR_UNDEF;
    }

    hid_t file;
};

// The times of the frames, by which a reader counts them.
inline std::vector<double> frame_times(const std::string &path) {
    return Reader(path).numbers("/particles/all/position/time");
}

} // namespace test
