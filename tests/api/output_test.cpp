// Result files as a program sees them: opened, written, closed, and what happens when the disk says no. The layout of
// the file has its own tests (unit/frame_file_test.cpp).
#include <csignal>
#include <filesystem>
#include <fstream>

#include <sys/resource.h>
#include <unistd.h>

#include "../support/directory.hpp"
#include "api_support.hpp"

#ifdef GP_TEST_HDF5
#include <hdf5.h>
#endif

using namespace api;

namespace {

class Output : public testing::Test {
protected:
    const test::TemporaryDirectory temporary{"granperi_output"};
    const std::string directory = temporary.path(), path = directory + "/run.h5";
};

} // namespace

TEST_F(Output, DefaultsAreTheDocumentedOnes) {
    const gp_output o = make_output();
    EXPECT_EQ(o.struct_size, sizeof o);
    EXPECT_EQ(o.every_seconds, 0);
    EXPECT_EQ(o.fields,
              GP_FIELD_POSITION | GP_FIELD_VELOCITY | GP_FIELD_PRESSURE | GP_FIELD_SHEAR_RATE | GP_FIELD_COLUMN);
    EXPECT_EQ(o.compression, 4);
    EXPECT_EQ(o.single_precision, 0);
}

// In every build, also in one without HDF5.
TEST_F(Output, OptionsAreChecked) {
    Sim sim;
    sim.add(make_column(2, 2));
    const auto refuse = [&](const gp_output &output, const char *name) {
        EXPECT_FAILS(gp_output_open(sim, path.c_str(), &output), GP_E_ARGUMENT, name);
        EXPECT_FALSE(std::filesystem::exists(path)) << "nothing is created";
        EXPECT_EQ(gp_output_close(sim), GP_E_STATE) << "nothing is open";
    };
    for (const double value : {not_a_number, infinite, -infinite, -0.1}) {
        gp_output output = make_output();
        output.every_seconds = value;
        refuse(output, "every_seconds");
    }
    for (const uint32_t fields : {GP_FIELD_ALL + 1, UINT32_MAX}) {
        gp_output output = make_output();
        output.fields = fields;
        refuse(output, "fields");
    }
    for (const int32_t level : {-1, 10}) {
        gp_output output = make_output();
        output.compression = level;
        refuse(output, "compression");
    }
    for (const int32_t single : {-1, 2}) {
        gp_output output = make_output();
        output.single_precision = single;
        refuse(output, "single_precision");
    }
}

TEST_F(Output, WithoutHdf5IsUnsupported) {
    if (has("hdf5"))
        GTEST_SKIP() << "this build has HDF5";
    Sim sim;
    sim.add(make_column(2, 2));
    EXPECT_EQ(gp_output_open(sim, path.c_str(), nullptr), GP_E_UNSUPPORTED) << gp_last_error();
    EXPECT_EQ(gp_output_write(sim), GP_E_STATE);
    EXPECT_EQ(gp_output_close(sim), GP_E_STATE);
    EXPECT_EQ(gp_step(sim, 2), GP_OK);
}

TEST_F(Output, WriteAndCloseNeedAnOpenOne) {
    Sim sim;
    sim.add(make_column(2, 2));
    EXPECT_FAILS(gp_output_write(sim), GP_E_STATE, "gp_output_write");
    EXPECT_FAILS(gp_output_close(sim), GP_E_STATE, "gp_output_close");
}

#ifdef GP_TEST_HDF5

namespace {

// Frames by the times, as a reader counts them.
std::vector<double> times(const std::string &path) {
    std::vector<double> values;
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    EXPECT_GE(file, 0) << path;
    if (file < 0)
        return values;
    const hid_t data = H5Dopen2(file, "/particles/all/position/time", H5P_DEFAULT), space = H5Dget_space(data);
    values.resize(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
    if (!values.empty()) {
        EXPECT_GE(H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
    }
    H5Sclose(space);
    H5Dclose(data);
    H5Fclose(file);
    return values;
}

// The last frame of an element, all components; or a constant element.
std::vector<double> last_frame(const std::string &path, const std::string &name) {
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    const std::string base = "/particles/all/" + name;
    H5O_info_t info;
    EXPECT_GE(H5Oget_info_by_name(file, base.c_str(), &info, H5P_DEFAULT), 0) << base;
    const bool constant = info.type == H5O_TYPE_DATASET;
    const hid_t data = H5Dopen2(file, (base + (constant ? "" : "/value")).c_str(), H5P_DEFAULT);
    const hid_t space = H5Dget_space(data);
    hsize_t shape[3] = {0, 0, 0};
    H5Sget_simple_extent_dims(space, shape, nullptr);
    std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
    EXPECT_GE(H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
    H5Sclose(space);
    H5Dclose(data);
    H5Fclose(file);
    if (!constant)
        values.erase(values.begin(), values.end() - static_cast<std::ptrdiff_t>(values.size() / shape[0]));
    return values;
}

// All frames of the states, row by row.
std::vector<double> observables(const std::string &path) {
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    const hid_t data = H5Dopen2(file, "/observables/state/value", H5P_DEFAULT), space = H5Dget_space(data);
    std::vector<double> values(static_cast<std::size_t>(std::max<hssize_t>(0, H5Sget_simple_extent_npoints(space))));
    EXPECT_GE(H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
    H5Sclose(space);
    H5Dclose(data);
    H5Fclose(file);
    return values;
}

std::vector<std::string> observable_names(const std::string &path) {
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    const hid_t names = H5Aopen_by_name(file, "/observables/state/value", "names", H5P_DEFAULT, H5P_DEFAULT);
    const hid_t type = H5Aget_type(names), space = H5Aget_space(names);
    const std::size_t width = H5Tget_size(type), count = static_cast<std::size_t>(H5Sget_simple_extent_npoints(space));
    std::string packed(width * count, '\0');
    EXPECT_GE(H5Aread(names, type, packed.data()), 0);
    std::vector<std::string> found;
    for (std::size_t k = 0; k < count; ++k)
        found.push_back(packed.substr(k * width, width).c_str());
    H5Sclose(space);
    H5Tclose(type);
    H5Aclose(names);
    H5Fclose(file);
    return found;
}

std::string scene_of(const std::string &path) {
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    const hid_t data = H5Dopen2(file, "/parameters/scene", H5P_DEFAULT), type = H5Dget_type(data);
    std::string text(H5Tget_size(type), '\0');
    EXPECT_GE(H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()), 0);
    H5Tclose(type);
    H5Dclose(data);
    H5Fclose(file);
    return text.c_str();
}

bool has_element(const std::string &path, const std::string &name) {
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    const bool found = H5Lexists(file, ("/particles/all/" + name).c_str(), H5P_DEFAULT) > 0;
    H5Fclose(file);
    return found;
}

// Within its life this process cannot write files longer than `bytes`.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) {
        handler_ = std::signal(SIGXFSZ, SIG_IGN);
        ::getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit now{bytes, before_.rlim_max};
        EXPECT_EQ(::setrlimit(RLIMIT_FSIZE, &now), 0);
    }
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }

private:
    rlimit before_;
    void (*handler_)(int);
};

} // namespace

TEST_F(Output, FramesAreWrittenOnCall) {
    Sim sim;
    add_collapse(sim, 5, 4);
    ASSERT_EQ(gp_output_open(sim, path.c_str(), nullptr), GP_OK) << gp_last_error();
    EXPECT_TRUE(std::filesystem::exists(path));
    EXPECT_TRUE(std::filesystem::exists(directory + "/run.xdmf"));
    std::vector<double> expected;
    for (int k = 0; k < 3; ++k) {
        ASSERT_EQ(gp_output_write(sim), GP_OK) << gp_last_error();
        expected.push_back(sim.state().time);
        EXPECT_EQ(times(path), expected) << "a complete frame can be read while the output is open";
        ASSERT_EQ(gp_step(sim, 5), GP_OK);
    }
    ASSERT_EQ(gp_output_close(sim), GP_OK) << gp_last_error();
    EXPECT_EQ(times(path), expected);
    EXPECT_EQ(gp_output_write(sim), GP_E_STATE);
    EXPECT_EQ(gp_output_close(sim), GP_E_STATE);
    std::ifstream xdmf(directory + "/run.xdmf");
    const std::string text((std::istreambuf_iterator<char>(xdmf)), std::istreambuf_iterator<char>());
    EXPECT_NE(text.find("run.h5:"), std::string::npos);
}

TEST_F(Output, NamesWithMarkupAreWrittenAsText) {
    Sim sim;
    add_collapse(sim, 5, 4);
    const std::string name = directory + "/a&b<c>\"--";
    ASSERT_EQ(gp_output_open(sim, (name + ".h5").c_str(), nullptr), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_output_write(sim), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    EXPECT_EQ(times(name + ".h5").size(), 1u);
    std::ifstream xdmf(name + ".xdmf");
    const std::string text((std::istreambuf_iterator<char>(xdmf)), std::istreambuf_iterator<char>());
    EXPECT_NE(text.find("a&amp;b&lt;c&gt;&quot;&#45;&#45;.h5:"), std::string::npos);
    EXPECT_EQ(text.find("a&b"), std::string::npos);
}

TEST_F(Output, FollowsTheRunByItself) {
    Sim sim;
    add_collapse(sim, 5, 4);
    gp_output output = make_output();
    output.every_seconds = 0.01;
    ASSERT_EQ(gp_output_open(sim, path.c_str(), &output), GP_OK) << gp_last_error();
    EXPECT_EQ(times(path), std::vector<double>{0});
    ASSERT_EQ(gp_run(sim, 0.052), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_output_write(sim), GP_OK) << "one more in between";
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    const std::vector<double> t = times(path);
    ASSERT_EQ(t.size(), 7u);
    for (std::size_t k = 1; k < 6; ++k) {
        EXPECT_GE(t[k], 0.01 * static_cast<double>(k) - 1e-12);
        EXPECT_LT(t[k], 0.01 * static_cast<double>(k) + 2 * sim.state().dt + 1e-3);
    }
    EXPECT_EQ(t.back(), 0.052);
}

// Runs that end on the multiples: each has its frame, and no multiple has two.
TEST_F(Output, HasOneFramePerMultipleAlsoWhereRunsEndOnThem) {
    Sim sim;
    add_collapse(sim, 3, 3);
    gp_output output = make_output();
    output.every_seconds = 0.003;
    ASSERT_EQ(gp_output_open(sim, path.c_str(), &output), GP_OK) << gp_last_error();
    for (int k = 1; k <= 10; ++k)
        ASSERT_EQ(gp_run(sim, 0.003 * k), GP_OK);
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    const std::vector<double> t = times(path);
    ASSERT_EQ(t.size(), 11u);
    for (std::size_t k = 0; k < t.size(); ++k)
        EXPECT_NEAR(t[k], 0.003 * static_cast<double>(k), 1e-12);
}

// A step longer than the interval: one frame, not one per multiple that it passes.
TEST_F(Output, AStepWritesAtMostOneFrame) {
    gp_config config = make_config();
    config.time_step = 2e-4;
    Sim sim(config);
    sim.add(make_column(2, 2));
    gp_output output = make_output();
    output.every_seconds = 3e-5;
    ASSERT_EQ(gp_output_open(sim, path.c_str(), &output), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_step(sim, 4), GP_OK);
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    EXPECT_EQ(times(path).size(), 5u);
}

TEST_F(Output, OnlyOneAtATime) {
    Sim sim;
    sim.add(make_column(2, 2));
    ASSERT_EQ(gp_output_open(sim, path.c_str(), nullptr), GP_OK);
    EXPECT_FAILS(gp_output_open(sim, (directory + "/other.h5").c_str(), nullptr), GP_E_STATE, "open");
    EXPECT_FALSE(std::filesystem::exists(directory + "/other.h5"));
    EXPECT_EQ(gp_output_write(sim), GP_OK) << "the first one is still open";
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    ASSERT_EQ(gp_output_open(sim, (directory + "/other.h5").c_str(), nullptr), GP_OK);
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    EXPECT_EQ(times(path).size(), 1u);
    EXPECT_EQ(times(directory + "/other.h5").size(), 0u);
}

TEST_F(Output, ReplacesAnExistingFile) {
    for (int k = 0; k < 2; ++k) {
        Sim sim;
        sim.add(make_column(2, 2));
        ASSERT_EQ(gp_output_open(sim, path.c_str(), nullptr), GP_OK) << gp_last_error();
        for (int frame = 0; frame < 3 - k; ++frame)
            ASSERT_EQ(gp_output_write(sim), GP_OK);
        ASSERT_EQ(gp_output_close(sim), GP_OK);
        EXPECT_EQ(times(path).size(), static_cast<std::size_t>(3 - k));
    }
}

TEST_F(Output, DestroyClosesIt) {
    {
        Sim sim;
        sim.add(make_column(2, 2));
        ASSERT_EQ(gp_output_open(sim, path.c_str(), nullptr), GP_OK);
        ASSERT_EQ(gp_output_write(sim), GP_OK);
    }
    EXPECT_EQ(times(path).size(), 1u);
}

TEST_F(Output, HoldsTheAskedFieldsInTheOrderOfId) {
    Sim sim;
    add_collapse(sim, 6, 5);
    gp_output output = make_output();
    output.fields = GP_FIELD_ALL;
    ASSERT_EQ(gp_output_open(sim, path.c_str(), &output), GP_OK);
    ASSERT_EQ(gp_step(sim, 30), GP_OK);
    ASSERT_EQ(gp_output_write(sim), GP_OK);
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    const struct {
        const char *name;
        uint32_t field;
    } scalars[] = {{"id", GP_FIELD_ID},
                   {"column", GP_FIELD_COLUMN},
                   {"pressure", GP_FIELD_PRESSURE},
                   {"density", GP_FIELD_DENSITY},
                   {"sxx", GP_FIELD_SXX},
                   {"sxy", GP_FIELD_SXY},
                   {"syy", GP_FIELD_SYY},
                   {"shear_rate", GP_FIELD_SHEAR_RATE},
                   {"inertial_number", GP_FIELD_INERTIAL_NUMBER},
                   {"viscosity", GP_FIELD_VISCOSITY},
                   {"number_density", GP_FIELD_NUMBER_DENSITY},
                   {"fluidity", GP_FIELD_FLUIDITY}};
    for (const auto &scalar : scalars)
        EXPECT_EQ(last_frame(path, scalar.name), sim.field(scalar.field)) << scalar.name;
    const std::vector<double> position = last_frame(path, "position"), velocity = last_frame(path, "velocity");
    const std::vector<double> x = sim.field(GP_FIELD_X), y = sim.field(GP_FIELD_Y), vx = sim.field(GP_FIELD_VX),
                              vy = sim.field(GP_FIELD_VY);
    ASSERT_EQ(position.size(), 90u);
    ASSERT_EQ(velocity.size(), 90u);
    for (std::size_t k = 0; k < 30; ++k) {
        EXPECT_EQ(position[3 * k], x[k]);
        EXPECT_EQ(position[3 * k + 1], y[k]);
        EXPECT_EQ(position[3 * k + 2], 0);
        EXPECT_EQ(velocity[3 * k], vx[k]);
        EXPECT_EQ(velocity[3 * k + 1], vy[k]);
    }
}

// The state of each frame and the scene: a file says what it is the result of.
TEST_F(Output, HoldsTheStateAtEachFrameAndTheScene) {
    Sim sim;
    add_collapse(sim, 6, 5);
    const gp_output output = make_output();
    ASSERT_EQ(gp_output_open(sim, path.c_str(), &output), GP_OK);
    std::vector<gp_state> states;
    for (int frame = 0; frame < 3; ++frame) {
        ASSERT_EQ(gp_step(sim, 10), GP_OK);
        ASSERT_EQ(gp_output_write(sim), GP_OK);
        states.push_back(sim.state());
    }
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    const std::vector<std::string> names = observable_names(path);
    const std::vector<double> rows = observables(path);
    ASSERT_EQ(rows.size(), names.size() * states.size());
    const auto column = [&](const char *name) {
        return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    };
    for (std::size_t k = 0; k < states.size(); ++k) {
        const double *const row = rows.data() + k * names.size();
        const gp_state &s = states[k];
        EXPECT_EQ(row[column("time")], s.time);
        EXPECT_EQ(row[column("step")], static_cast<double>(s.step));
        EXPECT_EQ(row[column("kinetic")], s.kinetic);
        EXPECT_EQ(row[column("potential")], s.potential);
        EXPECT_EQ(row[column("elastic")], s.elastic);
        EXPECT_EQ(row[column("dissipated")], s.dissipated);
        EXPECT_EQ(row[column("energy_error")], s.energy_error);
        EXPECT_EQ(row[column("x_right")], s.x_right);
        EXPECT_EQ(row[column("peak_height")], s.peak_height);
        EXPECT_EQ(row[column("max_compression")], s.max_compression);
    }
    const std::string scene = scene_of(path);
    const gp_config config = make_config();
    char spacing[64];
    std::snprintf(spacing, sizeof spacing, "\"spacing\": %.17g,", config.spacing);
    for (const char *part : {static_cast<const char *>(spacing),
                             "\"materials\": [{\"grain_density\": ", "\"columns\": [0]", "\"plates\": [{"})
        EXPECT_NE(scene.find(part), std::string::npos) << part << " in " << scene;
}

// "x and y come together, so do vx and vy; id and position are always written".
TEST_F(Output, PairsComeTogether) {
    const struct {
        uint32_t fields;
        bool velocity;
    } cases[] = {{0, false}, {GP_FIELD_Y, false}, {GP_FIELD_VY, true}, {GP_FIELD_VX, true}};
    for (const auto &c : cases) {
        Sim sim;
        sim.add(make_column(3, 2));
        gp_output output = make_output();
        output.fields = c.fields;
        ASSERT_EQ(gp_output_open(sim, path.c_str(), &output), GP_OK) << gp_last_error();
        ASSERT_EQ(gp_output_write(sim), GP_OK);
        ASSERT_EQ(gp_output_close(sim), GP_OK);
        EXPECT_EQ(last_frame(path, "position").size(), 18u);
        EXPECT_EQ(last_frame(path, "id").size(), 6u);
        EXPECT_EQ(has_element(path, "velocity"), c.velocity);
        EXPECT_FALSE(has_element(path, "pressure"));
        if (c.velocity) {
            EXPECT_EQ(last_frame(path, "velocity").size(), 18u);
        }
    }
}

TEST_F(Output, SinglePrecisionAndEveryCompression) {
    for (const int32_t level : {0, 1, 9}) {
        Sim sim;
        sim.add(make_column(7, 5));
        gp_output output = make_output();
        output.compression = level;
        output.single_precision = 1;
        ASSERT_EQ(gp_output_open(sim, path.c_str(), &output), GP_OK);
        ASSERT_EQ(gp_run(sim, 0.0123456789), GP_OK);
        ASSERT_EQ(gp_output_write(sim), GP_OK);
        ASSERT_EQ(gp_output_close(sim), GP_OK);
        EXPECT_EQ(times(path), std::vector<double>{0.0123456789}) << "time stays 64 bits";
        const std::vector<double> y = sim.field(GP_FIELD_Y), position = last_frame(path, "position");
        const std::vector<double> vy = sim.field(GP_FIELD_VY), velocity = last_frame(path, "velocity");
        for (std::size_t k = 0; k < y.size(); ++k) {
            EXPECT_NEAR(position[3 * k + 1], y[k], 1e-5 * 0.01) << "positions to 1e-5 spacings";
            EXPECT_EQ(velocity[3 * k + 1], static_cast<double>(static_cast<float>(vy[k])));
        }
    }
}

// In the coordinates of a map 32 bits resolve a quarter to half of a metre: 5 places for 160 particles of 5 mm.
TEST_F(Output, SinglePrecisionKeepsPositionsInTheCoordinatesOfAMap) {
    const double spacing = 0.005, east = 5e5, north = 4.2e6;
    gp_config config = make_config();
    config.spacing = spacing;
    Sim sim(config);
    gp_column column = make_column(16, 10);
    column.x_min = east;
    column.y_min = north;
    column.width = 16 * spacing;
    column.height = 10 * spacing;
    sim.add(column);
    gp_plate plate = make_plate(east + 1, north, east - 1, north);
    sim.add(plate);
    gp_output output = make_output();
    output.single_precision = 1;
    ASSERT_EQ(gp_output_open(sim, path.c_str(), &output), GP_OK) << gp_last_error();
    const auto check = [&] {
        const std::vector<double> x = sim.field(GP_FIELD_X), y = sim.field(GP_FIELD_Y);
        const std::vector<double> position = last_frame(path, "position");
        for (std::size_t k = 0; k < x.size(); ++k) {
            EXPECT_NEAR(position[3 * k], x[k], 1e-3 * spacing);
            EXPECT_NEAR(position[3 * k + 1], y[k], 1e-3 * spacing);
        }
    };
    ASSERT_EQ(gp_step(sim, 20), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_output_write(sim), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    check();
    // A frame that is read and written again, as an appended file's are, stays what it is.
    const std::vector<double> first = last_frame(path, "position");
    output.append = 1;
    ASSERT_EQ(gp_output_open(sim, path.c_str(), &output), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    EXPECT_EQ(last_frame(path, "position"), first);
    ASSERT_EQ(gp_output_open(sim, path.c_str(), &output), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_step(sim, 5), GP_OK);
    ASSERT_EQ(gp_output_write(sim), GP_OK);
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    check();
    EXPECT_EQ(times(path).size(), 2u);
}

// 0.1 wrote positions of single-precision files as 32 bits: such a file is continued, its frames as they are.
TEST_F(Output, SinglePrecisionFilesOfTheFirstVersionAreContinued) {
    Sim sim;
    add_collapse(sim);
    gp_output output = make_output();
    output.single_precision = 1;
    ASSERT_EQ(gp_output_open(sim, path.c_str(), &output), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_output_write(sim), GP_OK);
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    const std::vector<double> position = last_frame(path, "position");
    { // the dataset as 0.1 made it
        const std::vector<float> floats(position.begin(), position.end());
        const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
        ASSERT_GE(file, 0);
        const hsize_t extent[3] = {1, position.size() / 3, 3};
        const hid_t space = H5Screate_simple(3, extent, nullptr);
        ASSERT_GE(H5Ldelete(file, "/particles/all/position/value", H5P_DEFAULT), 0);
        const hid_t dataset = H5Dcreate2(file, "/particles/all/position/value", H5T_IEEE_F32LE, space, H5P_DEFAULT,
                                         H5P_DEFAULT, H5P_DEFAULT);
        ASSERT_GE(H5Dwrite(dataset, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, floats.data()), 0);
        H5Dclose(dataset);
        H5Sclose(space);
        H5Fclose(file);
    }
    output.append = 1;
    ASSERT_EQ(gp_output_open(sim, path.c_str(), &output), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    const std::vector<double> again = last_frame(path, "position");
    ASSERT_EQ(again.size(), position.size());
    for (std::size_t k = 0; k < position.size(); ++k)
        EXPECT_NEAR(again[k], position[k], 1e-4 * 0.01); // places of 32 bits near the origin
    output.single_precision = 0;
    EXPECT_FAILS(gp_output_open(sim, path.c_str(), &output), GP_E_IO, "precision");
}

TEST_F(Output, AnEmptySceneHasFramesToo) {
    Sim sim;
    ASSERT_EQ(gp_output_open(sim, path.c_str(), nullptr), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_output_write(sim), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_step(sim, 2), GP_OK);
    ASSERT_EQ(gp_output_write(sim), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    EXPECT_EQ(times(path).size(), 2u);
}

TEST_F(Output, PathsThatCannotBeWrittenAreAnIoErrorAndTheSimulationGoesOn) {
    std::vector<uint64_t> bits[2];
    for (int k = 0; k < 2; ++k) {
        Sim sim;
        add_collapse(sim, 4, 4);
        ASSERT_EQ(gp_step(sim, 3), GP_OK);
        const std::string missing = directory + "/missing/run.h5";
        for (const std::string &bad : {missing, directory, std::string(), std::string("/dev/full")})
            if (k == 1) {
                EXPECT_EQ(gp_output_open(sim, bad.c_str(), nullptr), GP_E_IO) << bad << ": " << gp_last_error();
                EXPECT_TRUE(last_error_has(bad)) << gp_last_error();
                EXPECT_EQ(gp_output_write(sim), GP_E_STATE) << "nothing is open";
            }
        ASSERT_EQ(gp_step(sim, 3), GP_OK);
        bits[k] = snapshot(sim, 3);
        ASSERT_EQ(gp_output_open(sim, path.c_str(), nullptr), GP_OK) << gp_last_error();
        ASSERT_EQ(gp_output_close(sim), GP_OK);
    }
    EXPECT_EQ(bits[0], bits[1]);
}

// A disk that is full for a while: gp_output_write says so, the frames before are kept, later ones are written again.
TEST_F(Output, AFullDiskCostsOnlyTheFrame) {
    Sim sim;
    sim.add(make_column(20, 20));
    ASSERT_EQ(gp_output_open(sim, path.c_str(), nullptr), GP_OK);
    ASSERT_EQ(gp_output_write(sim), GP_OK);
    ASSERT_EQ(gp_step(sim, 1), GP_OK);
    {
        const FileSizeLimit limit(std::filesystem::file_size(path));
        EXPECT_EQ(gp_output_write(sim), GP_E_IO) << gp_last_error();
        EXPECT_TRUE(last_error_has(path)) << gp_last_error();
    }
    EXPECT_EQ(times(path).size(), 1u);
    ASSERT_EQ(gp_step(sim, 1), GP_OK);
    ASSERT_EQ(gp_output_write(sim), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_output_close(sim), GP_OK) << gp_last_error();
    EXPECT_EQ(times(path), (std::vector<double>{0, sim.state().time}));
}

// "after GP_E_IO (of an output that writes by itself) the step is complete, the frame is lost and the run may go on".
TEST_F(Output, AFullDiskInARunLosesTheFrameAndNoStep) {
    gp_config config = make_config();
    config.time_step = 1e-4;
    std::vector<uint64_t> bits[2];
    for (int k = 0; k < 2; ++k) {
        Sim sim(config);
        sim.add(make_column(20, 20));
        int calls = 0;
        const auto count = [](void *user, gp_sim *) {
            ++*static_cast<int *>(user);
            return int32_t(0);
        };
        ASSERT_EQ(gp_set_callback(sim, 1, count, &calls), GP_OK);
        if (k == 1) {
            gp_output output = make_output();
            output.every_seconds = 1e-3;
            ASSERT_EQ(gp_output_open(sim, path.c_str(), &output), GP_OK) << gp_last_error();
            ASSERT_EQ(gp_step(sim, 15), GP_OK);
            const FileSizeLimit limit(std::filesystem::file_size(path));
            EXPECT_EQ(gp_step(sim, 10), GP_E_IO) << gp_last_error();
            EXPECT_EQ(sim.state().step, 20);
            EXPECT_EQ(gp_step(sim, 5), GP_OK) << "no frame is due: " << gp_last_error();
            EXPECT_EQ(calls, 25) << "the callback sees every complete step";
        } else {
            ASSERT_EQ(gp_step(sim, 25), GP_OK);
        }
        ASSERT_EQ(gp_run(sim, 4e-3), GP_OK) << gp_last_error();
        EXPECT_EQ(sim.state().time, 4e-3);
        if (k == 1) {
            ASSERT_EQ(gp_output_close(sim), GP_OK);
        }
        bits[k] = snapshot(sim);
    }
    EXPECT_EQ(bits[0], bits[1]);
    const std::vector<double> t = times(path);
    ASSERT_EQ(t.size(), 4u);
    for (std::size_t k = 0; k < 4; ++k)
        EXPECT_NEAR(t[k], static_cast<double>(k < 2 ? k : k + 1) * 1e-3, 1e-12);
}

TEST_F(Output, DoesNotChangeTheRun) {
    std::vector<uint64_t> bits[2];
    for (int k = 0; k < 2; ++k) {
        Sim sim;
        add_collapse(sim, 6, 6);
        gp_output output = make_output();
        output.every_seconds = 1e-3;
        output.fields = GP_FIELD_ALL;
        if (k == 1) {
            ASSERT_EQ(gp_output_open(sim, path.c_str(), &output), GP_OK);
        }
        ASSERT_EQ(gp_step(sim, 40), GP_OK);
        bits[k] = snapshot(sim, 3);
    }
    EXPECT_EQ(bits[0], bits[1]);
}

#endif
