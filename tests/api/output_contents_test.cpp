// What a result file holds of a run.
#ifdef GP_TEST_HDF5
#include <iterator>
#include <sstream>

#include "output_support.hpp"

using namespace api;
using test::Reader;

namespace {

// The last frame of an element, all components; or a constant element.
std::vector<double> last_frame(const std::string &path, const std::string &name) {
    const Reader file(path);
    const std::string base = "/particles/all/" + name, value = base + "/value";
    EXPECT_TRUE(file.has(base)) << base;
    if (file.shape(base) != "missing")
        return file.numbers(base);
    std::vector<double> values = file.numbers(value);
    const std::size_t frames = std::stoul(file.shape(value));
    values.erase(values.begin(), values.end() - static_cast<std::ptrdiff_t>(values.size() / frames));
    return values;
}

std::string scene_of(const std::string &path) {
    const Reader file(path);
    const hid_t data = H5Dopen2(file.file, "/parameters/scene", H5P_DEFAULT), type = H5Dget_type(data);
    std::string text(H5Tget_size(type), '\0');
    EXPECT_GE(H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()), 0);
    H5Tclose(type);
    H5Dclose(data);
    return text.c_str();
}

} // namespace

TEST_F(Output, NamesWithMarkupAreWrittenAsText) {
    Sim sim;
    add_collapse(sim, 5, 4);
    const std::string name = directory + "/a&b<c>\"--";
    ASSERT_EQ(gp_output_open(sim, (name + ".h5").c_str(), nullptr), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_output_write(sim), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    EXPECT_EQ(frame_times(name + ".h5").size(), 1u);
    std::ifstream xdmf(name + ".xdmf");
    const std::string text((std::istreambuf_iterator<char>(xdmf)), std::istreambuf_iterator<char>());
    EXPECT_NE(text.find("a&amp;b&lt;c&gt;&quot;&#45;&#45;.h5:"), std::string::npos);
    EXPECT_EQ(text.find("a&b"), std::string::npos);
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
    const Reader file(path);
    std::istringstream listed(file.text_attribute("/observables/state/value", "names"));
    const std::vector<std::string> names(std::istream_iterator<std::string>(listed), {});
    const std::vector<double> rows = file.numbers("/observables/state/value");
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

// A line of points that turns by a table, and one that the host drives from where its table begins.
TEST_F(Output, HoldsTheLinesAndMotionsOfPlates) {
    Sim sim;
    sim.add(make_column(3, 2, 0, 0.5));
    const double x[] = {1, 0.5, 0}, y[] = {0, 0.25, 0}, t[] = {0, 2}, dx[] = {0.125, 1}, dy[] = {0.375, 1},
                 angle[] = {0.75, 1};
    gp_plate line = make_plate(0, 0, 0, 0);
    line.n_points = 3;
    line.point_x = x;
    line.point_y = y;
    line.n_knots = 2;
    line.knot_t = t;
    line.knot_angle = angle;
    sim.add(line);
    gp_plate driven = make_plate(1, -1, 0, -1);
    driven.n_knots = 2;
    driven.knot_t = t;
    driven.knot_x = dx;
    driven.knot_y = dy;
    driven.knot_angle = angle;
    const int32_t id = sim.add(driven);
    ASSERT_EQ(gp_set_plate_motion(sim, id, 0.5, 0, 0.25), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_output_open(sim, path.c_str(), nullptr), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_output_write(sim), GP_OK);
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    const std::string scene = scene_of(path);
    for (const char *part :
         {R"("point_x": [1, 0.5, 0])", R"("point_y": [0, 0.25, 0])", R"("knot_angle": [0.75, 1])",
          R"("start_x": 0.125)", R"("start_y": 0.375)", R"("start_angle": 0.75)", R"("vx": 0.5)", R"("omega": 0.25)"})
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
        EXPECT_EQ(Reader(path).has("/particles/all/velocity"), c.velocity);
        EXPECT_FALSE(Reader(path).has("/particles/all/pressure"));
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
        EXPECT_EQ(frame_times(path), std::vector<double>{0.0123456789}) << "time stays 64 bits";
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
    EXPECT_EQ(frame_times(path).size(), 2u);
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

#endif
