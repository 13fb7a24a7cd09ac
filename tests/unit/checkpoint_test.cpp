// Checkpoint files that are newer, damaged, or whole and wrong: each number in turn has values that no simulation has.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <hdf5.h>

#include "../support/bytes.hpp"
#include "../support/directory.hpp"
#include "granperi/gp.h"
#include "io/checkpoint_file.hpp"
#include "particles.hpp"

namespace {

std::vector<unsigned char> read_file(const std::string &path) {
    return test::bytes_of<std::vector<unsigned char>>(path);
}

constexpr std::size_t text_size = 512;

class CheckpointFileTest : public testing::Test {
protected:
    // A small scene with all that a checkpoint has: a period, plates with a table, a load and the host's own motion, a set of
    // particles, an output.
    void save_sample(bool periodic, bool sleep = false) {
        gp_config config;
        ASSERT_EQ(gp_config_init(&config, sizeof config, GP_PRESET_DEFAULT), GP_OK);
        config.threads = 1;
        config.retry_halvings = 3;
        config.sleep = sleep ? 1 : 0;
        if (periodic)
            config.periodic_x_max = 12 * config.spacing;
        gp_sim *sim = nullptr;
        ASSERT_EQ(gp_create(&config, &sim), GP_OK);
        gp_column column;
        gp_column_init(&column, sizeof column);
        column.width = 12 * config.spacing;
        column.height = 3 * config.spacing;
        ASSERT_EQ(gp_add_column(sim, &column, nullptr), GP_OK);
        const double x[] = {0.01, 0.02}, y[] = {0.011, 0.012};
        ASSERT_EQ(gp_add_particles(sim, 0, 2, x, y, nullptr, nullptr, nullptr), GP_OK);
        gp_plate plate;
        gp_plate_init(&plate, sizeof plate);
        plate.x0 = 12 * config.spacing;
        ASSERT_EQ(gp_add_plate(sim, &plate, nullptr), GP_OK);
        const double t[] = {0, 1}, up[] = {0, 0.1}, aside[] = {0, 0};
        plate.y0 = plate.y1 = -0.1;
        plate.n_knots = 2;
        plate.knot_t = t;
        plate.knot_x = aside;
        plate.knot_y = up;
        ASSERT_EQ(gp_add_plate(sim, &plate, nullptr), GP_OK);
        gp_plate_init(&plate, sizeof plate);
        plate.x1 = 12 * config.spacing;
        plate.y0 = plate.y1 = 6 * config.spacing;
        plate.normal_pressure = 100;
        ASSERT_EQ(gp_add_plate(sim, &plate, nullptr), GP_OK);
        ASSERT_EQ(gp_output_open(sim, (directory + "/run.h5").c_str(), nullptr), GP_OK) << gp_last_error();
        ASSERT_EQ(gp_step(sim, 3), GP_OK) << gp_last_error();
        ASSERT_EQ(gp_set_plate_velocity(sim, 1, 0.1, 0), GP_OK);
        ASSERT_EQ(gp_save(sim, path.c_str()), GP_OK) << gp_last_error();
        gp_destroy(sim);
    }

    // Loads, and if that can be done, steps and reads.
    gp_status use() {
        gp_sim *sim = nullptr;
        const gp_status status = gp_load(path.c_str(), &sim);
        if (status < 0) {
            EXPECT_EQ(sim, nullptr);
            return status;
        }
        gp_state state{};
        state.struct_size = sizeof state;
        gp_get_state(sim, &state);
        gp_step(sim, 2);
        gp_get_state(sim, &state);
        gp_destroy(sim);
        return GP_OK;
    }

    void put(const std::vector<unsigned char> &bytes) {
        std::ofstream(path, std::ios::binary)
            .write(reinterpret_cast<const char *>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    }

    // The file `good` with the right checksum and a change, used.
    template <class Change> gp_status use_with(const std::vector<unsigned char> &good, const Change &change) {
        std::ofstream(image, std::ios::binary)
            .write(reinterpret_cast<const char *>(good.data()) + text_size,
                   static_cast<std::streamsize>(good.size() - text_size));
        const hid_t file = H5Fopen(image.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
        change(file);
        H5Fclose(file);
        std::vector<unsigned char> bytes = read_file(image);
        bytes.insert(bytes.begin(), text_size, 0);
        gp::io::seal(bytes);
        put(bytes);
        return use();
    }

    const test::TemporaryDirectory temporary{"checkpoint"};
    const std::string directory = temporary.path(), path = directory + "/state.gpc", image = directory + "/image.h5";
};

TEST_F(CheckpointFileTest, AnotherFormatIsRefused) {
    save_sample(false);
    std::vector<unsigned char> bytes = read_file(path);
    for (const uint32_t format : {gp::io::checkpoint_format + 1, gp::io::checkpoint_format - 1}) {
        gp::io::seal(bytes, format);
        put(bytes);
        EXPECT_EQ(use(), GP_E_VERSION);
        EXPECT_NE(std::string(gp_last_error()).find("format " + std::to_string(format)), std::string::npos)
            << gp_last_error();
    }
    gp::io::seal(bytes, 0);
    put(bytes);
    EXPECT_EQ(use(), GP_E_IO);
    gp::io::seal(bytes);
    put(bytes);
    EXPECT_EQ(use(), GP_OK) << gp_last_error();
}

TEST_F(CheckpointFileTest, SameStateGivesTheSameBytes) {
    save_sample(true);
    gp_sim *sim = nullptr;
    ASSERT_EQ(gp_load(path.c_str(), &sim), GP_OK) << gp_last_error();
    const std::string again = directory + "/again.gpc";
    ASSERT_EQ(gp_save(sim, again.c_str()), GP_OK) << gp_last_error();
    gp_destroy(sim);
    EXPECT_EQ(read_file(path), read_file(again));
}

TEST_F(CheckpointFileTest, EveryChangedByteIsFound) {
    save_sample(false);
    const std::vector<unsigned char> good = read_file(path);
    int64_t loaded = 0;
    for (std::size_t k = 0; k < good.size(); k += k < 600 ? 1 : 37) {
        std::vector<unsigned char> bad = good;
        bad[k] = static_cast<unsigned char>(bad[k] ^ (1u << (k % 8)));
        put(bad);
        loaded += use() != GP_E_IO;
    }
    EXPECT_EQ(loaded, 0);
    for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{20}, text_size - 1, text_size,
                                   text_size + 1, good.size() / 2, good.size() - 1}) {
        put({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)});
        EXPECT_EQ(use(), GP_E_IO) << size;
    }
    std::vector<unsigned char> longer = good;
    longer.push_back(0);
    put(longer);
    EXPECT_EQ(use(), GP_E_IO);
}

// Names of all arrays, and of all numbers as group/name.
struct Names {
    std::vector<std::string> arrays, groups;
    std::vector<std::pair<std::string, std::string>> numbers;
};

Names names_in(hid_t file) {
    Names names;
    H5Ovisit(
        file, H5_INDEX_NAME, H5_ITER_INC,
        [](hid_t, const char *name, const H5O_info_t *info, void *data) -> herr_t {
            Names &found = *static_cast<Names *>(data);
            (info->type == H5O_TYPE_DATASET ? found.arrays : found.groups).push_back(name);
            return 0;
        },
        &names);
    for (const std::string &group : names.groups) {
        const hid_t opened = H5Oopen(file, group.c_str(), H5P_DEFAULT);
        std::vector<std::string> attributes;
        H5Aiterate2(
            opened, H5_INDEX_NAME, H5_ITER_INC, nullptr,
            [](hid_t, const char *name, const H5A_info_t *, void *data) -> herr_t {
                static_cast<std::vector<std::string> *>(data)->push_back(name);
                return 0;
            },
            &attributes);
        H5Oclose(opened);
        for (const std::string &name : attributes)
            names.numbers.push_back({group, name});
    }
    return names;
}

const double hostile[] = {std::numeric_limits<double>::quiet_NaN(), -1, 1e300, 2147483647, 1e-300};

void change_array(hid_t file, const std::string &name, double value, bool last) {
    const hid_t dataset = H5Dopen2(file, name.c_str(), H5P_DEFAULT), space = H5Dget_space(dataset);
    hsize_t size = 0;
    H5Sget_simple_extent_dims(space, &size, nullptr);
    if (size > 0) {
        std::vector<double> values(size);
        H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
        values[last ? size - 1 : 0] = value;
        H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    }
    H5Sclose(space);
    H5Dclose(dataset);
}

void change_number(hid_t file, const std::string &group, const std::string &name, double value) {
    const hid_t attribute = H5Aopen_by_name(file, group.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(attribute, H5T_NATIVE_DOUBLE, &value);
    H5Aclose(attribute);
}

// An array of zeros in the place of another one.
void replace_array(hid_t file, const std::string &name, hsize_t size) {
    const hid_t old = H5Dopen2(file, name.c_str(), H5P_DEFAULT), type = H5Dget_type(old),
                how = H5Dget_create_plist(old);
    H5Dclose(old);
    H5Ldelete(file, name.c_str(), H5P_DEFAULT);
    const hid_t space = H5Screate_simple(1, &size, &size);
    const hid_t dataset = H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, how, H5P_DEFAULT);
    const std::vector<double> zeros(size);
    if (size > 0)
        H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, zeros.data());
    for (const hid_t id : {dataset, space, type, how})
        H5Idec_ref(id);
}

// What a particle remembers of its rest acts seldom enough for a restart without one field of it to give equal bits. So the fields
// that are kept are counted.
TEST(CheckpointFields, AllThatAParticleRemembersOfItsRestIsKept) {
    gp::Repose repose;
    std::set<const void *> fields;
    std::set<std::string> names;
    gp::Repose::for_each(repose, [&](const char *name, gp::Field<double> &field) {
        fields.insert(&field);
        names.insert(name);
    });
    EXPECT_EQ(fields.size() * sizeof(gp::Field<double>), sizeof(gp::Repose));
    EXPECT_EQ(names.size(), fields.size());
}

// Items whose numbers stand in arrays of other sizes: also where the first of them is the empty one.
TEST_F(CheckpointFileTest, ItemsHaveAllOfTheirNumbers) {
    save_sample(false, true);
    const std::vector<unsigned char> good = read_file(path);
    const std::vector<std::string> loads = {"sleep/id", "sleep/plate", "sleep/x", "sleep/y", "sleep/couple"},
                                   materials = {"materials/grain_density", "materials/mu_s", "materials/k0"};
    const auto sizes = [&](const std::string &other, hsize_t size) {
        return use_with(good, [&](hid_t file) {
            for (const std::string &name : loads)
                replace_array(file, name, name == other ? size : hsize_t{3});
        });
    };
    EXPECT_EQ(sizes("none", 0), GP_OK) << gp_last_error();
    for (const std::string &shorter : loads)
        for (const hsize_t size : {hsize_t{0}, hsize_t{2}})
            EXPECT_EQ(sizes(shorter, size), GP_E_IO) << shorter << " of " << size;
    for (const std::string &shorter : materials)
        EXPECT_EQ(use_with(good, [&](hid_t file) { replace_array(file, shorter, 0); }), GP_E_IO) << shorter;
}

// A file with the right checksum and one wrong number: it is refused, or does no harm.
TEST_F(CheckpointFileTest, WrongNumbersDoNoHarm) {
    for (const bool periodic : {false, true}) {
        save_sample(periodic);
        const std::vector<unsigned char> good = read_file(path);
        const auto with_change = [&](const auto &change) { return use_with(good, change); };
        Names names;
        ASSERT_EQ(with_change([&](hid_t file) { names = names_in(file); }), GP_OK) << gp_last_error();
        ASSERT_GT(names.arrays.size(), 70u);
        ASSERT_GT(names.numbers.size(), 60u);
        int64_t refused = 0, harmless = 0;
        const auto count = [&](gp_status status, const std::string &what) {
            EXPECT_TRUE(status == GP_OK || status == GP_E_IO || status == GP_E_UNSUPPORTED || status == GP_E_MEMORY)
                << what << ": " << gp_last_error();
            ++(status == GP_OK ? harmless : refused);
        };
        for (const double value : hostile) {
            for (const std::string &name : names.arrays)
                count(with_change([&](hid_t file) { change_array(file, name, value, periodic); }), name);
            for (const auto &[group, name] : names.numbers)
                if (name != "threads") // 1024 are allowed
                    count(with_change([&, &group = group, &name = name](hid_t file) {
                              change_number(file, group, name, value);
                          }),
                          name);
        }
        std::printf("%lld files refused, %lld harmless\n", static_cast<long long>(refused),
                    static_cast<long long>(harmless));
        EXPECT_GT(refused, 100);
        // A part that is missing.
        for (const std::string &name : names.arrays)
            EXPECT_EQ(with_change([&](hid_t file) { H5Ldelete(file, name.c_str(), H5P_DEFAULT); }), GP_E_IO) << name;
        for (const auto &[group, name] : names.numbers)
            EXPECT_EQ(with_change([&group = group, &name = name](hid_t file) {
                          H5Adelete_by_name(file, group.c_str(), name.c_str(), H5P_DEFAULT);
                      }),
                      GP_E_IO)
                << name;
    }
}

} // namespace
