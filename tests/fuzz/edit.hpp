// Changes of HDF5 files in memory that HDF5 itself makes, so that they stay files which it can read: what is tested is the
// reader of granperi, not that of HDF5.
#pragma once

#include <hdf5.h>

#include "fuzz.hpp"

namespace fuzz {

constexpr double scene_dl = 0.0025;

inline gp_sim *make_scene(int kind) {
    gp_config config;
    ALWAYS(gp_config_init(&config, sizeof config, kind == 3 ? GP_PRESET_PAPER : GP_PRESET_DEFAULT) == GP_OK);
    config.threads = 1;
    config.retry_halvings = 3;
    if (kind == 2)
        config.periodic_x_max = 12 * scene_dl;
    gp_sim *sim = nullptr;
    ALWAYS(checked(gp_create(&config, &sim)) == GP_OK);
    gp_column column;
    ALWAYS(gp_column_init(&column, sizeof column) == GP_OK);
    column.width = 12 * scene_dl;
    column.height = 3 * scene_dl;
    ALWAYS(checked(gp_add_column(sim, &column, nullptr)) == GP_OK);
    const double x[] = {0.01, 0.02}, y[] = {0.011, 0.012}, t[] = {0, 1}, up[] = {0, 0.1};
    ALWAYS(checked(gp_add_particles(sim, 0, 2, x, y, nullptr, nullptr, nullptr)) == GP_OK);
    gp_plate plate;
    ALWAYS(gp_plate_init(&plate, sizeof plate) == GP_OK);
    plate.x0 = 12 * scene_dl;
    ALWAYS(checked(gp_add_plate(sim, &plate, nullptr)) == GP_OK);
    plate.y0 = plate.y1 = -0.1;
    plate.n_knots = 2;
    plate.knot_t = t;
    plate.knot_x = plate.knot_y = up;
    ALWAYS(checked(gp_add_plate(sim, &plate, nullptr)) == GP_OK);
    if (kind != 3) {
        ALWAYS(gp_plate_init(&plate, sizeof plate) == GP_OK);
        plate.x1 = 12 * scene_dl;
        plate.y0 = plate.y1 = 6 * scene_dl;
        plate.normal_pressure = 100;
        ALWAYS(checked(gp_add_plate(sim, &plate, nullptr)) == GP_OK);
    }
    return sim;
}

struct Place {
    std::string object, attribute; // attribute "": the array itself
};

// Every array and every attribute of a file.
inline std::vector<Place> places_of(hid_t file) {
    std::vector<Place> places;
    H5Ovisit(
        file, H5_INDEX_NAME, H5_ITER_INC,
        [](hid_t root, const char *name, const H5O_info_t *info, void *data) -> herr_t {
            auto &all = *static_cast<std::vector<Place> *>(data);
            if (info->type == H5O_TYPE_DATASET)
                all.push_back({name, ""});
            for (hsize_t k = 0; k < info->num_attrs; ++k) {
                char attribute[100] = "";
                H5Aget_name_by_idx(root, name, H5_INDEX_NAME, H5_ITER_INC, k, attribute, sizeof attribute, H5P_DEFAULT);
                all.push_back({name, attribute});
            }
            return 0;
        },
        &places);
    return places;
}

// Has it no values of its own? HDF5 1.10 crashes where a view is read whose array has become another one; the library reads none.
inline bool is_view(hid_t array) {
    const hid_t how = H5Dget_create_plist(array);
    const bool view = H5Pget_layout(how) == H5D_VIRTUAL;
    H5Pclose(how);
    return view;
}

inline void put_number(Bytes &in, hid_t object, hid_t extent, bool attribute) {
    const hssize_t count = H5Sget_simple_extent_npoints(extent);
    if (count < 1 || count > 100000 || (!attribute && is_view(object)))
        return;
    std::vector<double> values(static_cast<std::size_t>(count));
    if ((attribute ? H5Aread(object, H5T_NATIVE_DOUBLE, values.data())
                   : H5Dread(object, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data())) < 0)
        return;
    const auto at = static_cast<std::size_t>(in.byte() * 256 + in.byte()) % values.size();
    double number = in.number(values[at] != 0 ? values[at] : 1);
    if (in.byte() % 4 == 0)
        number = static_cast<double>(in.integer(static_cast<int64_t>(1)));
    values[at] = number;
    if (in.byte() % 8 == 0)
        std::fill(values.begin(), values.end(), number);
    if (attribute)
        H5Awrite(object, H5T_NATIVE_DOUBLE, values.data());
    else
        H5Dwrite(object, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
}

// Of another size, type or way of storing.
inline void put_array(Bytes &in, hid_t file, const std::string &name) {
    H5Ldelete(file, name.c_str(), H5P_DEFAULT);
    const hsize_t sizes[] = {0, 1, 2, 3, 38, 39, 100, hsize_t{1} << 20};
    const hsize_t size[2] = {sizes[in.byte() % 8], 3};
    const hid_t types[] = {H5T_IEEE_F64LE, H5T_STD_I64LE, H5T_STD_I32LE, H5T_IEEE_F32LE, H5T_STD_U8LE, H5T_C_S1};
    const uint8_t kind = in.byte();
    const hid_t extent =
        kind & 1 ? H5Screate(kind & 2 ? H5S_SCALAR : H5S_NULL) : H5Screate_simple(kind & 2 ? 2 : 1, size, nullptr);
    const hid_t how = H5Pcreate(H5P_DATASET_CREATE);
    if (kind & 4 && !(kind & 1)) {
        const hsize_t chunk[2] = {16, 3};
        H5Pset_chunk(how, kind & 2 ? 2 : 1, chunk);
        if (kind & 8)
            H5Pset_deflate(how, 1);
    } else if (kind & 8)
        H5Pset_external(how, "/etc/hostname", 0, H5F_UNLIMITED);
    else if (kind & 16)
        H5Pset_layout(how, H5D_COMPACT);
    const hid_t made = H5Dcreate2(file, name.c_str(), types[in.byte() % 6], extent, H5P_DEFAULT, how, H5P_DEFAULT);
    if (made >= 0)
        H5Dclose(made);
    H5Pclose(how);
    H5Sclose(extent);
}

inline hid_t open_image(const std::vector<unsigned char> &image) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_fapl_core(access, 1 << 16, false);
    H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
    H5Pset_file_image(access, const_cast<unsigned char *>(image.data()), image.size()); // copies them
    const hid_t file = H5Fopen("/dev/null/granperi fuzz", H5F_ACC_RDWR, access);
    ALWAYS(file >= 0);
    H5Pclose(access);
    return file;
}

struct Sample {
    explicit Sample(std::vector<unsigned char> bytes) : image(std::move(bytes)) {
        const hid_t file = open_image(image);
        places = places_of(file);
        H5Fclose(file);
    }
    std::vector<unsigned char> image;
    std::vector<Place> places;
};

inline std::vector<unsigned char> edit(const Sample &sample, Bytes &in) {
    std::vector<unsigned char> image = sample.image;
    const std::vector<Place> &places = sample.places;
    const hid_t file = open_image(image);
    for (int n = 1 + in.below(4); n > 0 && !in.empty(); --n) {
        const Place &place = places[static_cast<std::size_t>(in.byte() * 256 + in.byte()) % places.size()];
        const uint8_t what = in.byte();
        const hid_t object = H5Oopen(file, place.object.c_str(), H5P_DEFAULT);
        if (object < 0)
            continue;
        if (!place.attribute.empty()) {
            const hid_t attribute = H5Aopen(object, place.attribute.c_str(), H5P_DEFAULT);
            if (attribute >= 0 && what < 240) {
                const hid_t extent = H5Aget_space(attribute);
                put_number(in, attribute, extent, true);
                H5Sclose(extent);
            } else if (attribute >= 0) {
                H5Adelete(object, place.attribute.c_str());
            }
            H5Aclose(attribute);
        } else if (what < 160) {
            const hid_t extent = H5Dget_space(object);
            put_number(in, object, extent, false);
            H5Sclose(extent);
        } else if (what < 190) { // more or fewer frames
            const hid_t extent = H5Dget_space(object);
            hsize_t size[8];
            if (H5Sget_simple_extent_dims(extent, size, nullptr) > 0) {
                size[0] = in.byte() % 12;
                H5Dset_extent(object, size);
            }
            H5Sclose(extent);
        } else if (what < 240) {
            put_array(in, file, place.object);
        } else {
            H5Ldelete(file, place.object.c_str(), H5P_DEFAULT);
        }
        H5Oclose(object);
    }
    H5Fflush(file, H5F_SCOPE_LOCAL);
    image.resize(static_cast<std::size_t>(H5Fget_file_image(file, nullptr, 0)));
    H5Fget_file_image(file, image.data(), image.size());
    H5Fclose(file);
    H5Eclear2(H5E_DEFAULT);
    return image;
}

} // namespace fuzz
