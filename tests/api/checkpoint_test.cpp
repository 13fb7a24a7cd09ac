// Checkpoints as a program sees them: when they can be made, what is refused, and how result files go on. That the bits go on
// in another process is tested by trust/trust.py, what a wrong file does by unit/checkpoint_test.cpp.
#include <filesystem>
#include <fstream>

#include <unistd.h>

#include "../support/bytes.hpp"
#include "../support/directory.hpp"
#include "api_support.hpp"

#ifdef GP_TEST_HDF5
#include "../support/file_size_limit.hpp"
#include "../support/result_file.hpp"
#endif

using namespace api;
#ifdef GP_TEST_HDF5
using test::bytes_of;
using test::frame_times;
#endif

namespace {

class Checkpoint : public testing::Test {
protected:
    // Nothing but these names.
    std::size_t files() const {
        std::size_t n = 0;
        for ([[maybe_unused]] const auto &entry : std::filesystem::directory_iterator(directory))
            ++n;
        return n;
    }

    const test::TemporaryDirectory temporary{"granperi_checkpoint"};
    const std::string directory = temporary.path(), path = directory + "/state.gpc", h5 = directory + "/run.h5";
};

} // namespace

#ifndef GP_TEST_HDF5

TEST_F(Checkpoint, NeedsHdf5) {
    Sim sim;
    EXPECT_FAILS(gp_save(sim, path.c_str()), GP_E_UNSUPPORTED, "HDF5");
    gp_sim *loaded = sim.handle;
    EXPECT_FAILS(gp_load(path.c_str(), &loaded), GP_E_UNSUPPORTED, "HDF5");
    EXPECT_EQ(loaded, nullptr);
}

#else

namespace {

// A simulation that has been loaded.
struct Loaded : Sim {
    explicit Loaded(const std::string &path) : Sim() {
        gp_destroy(handle);
        EXPECT_EQ(gp_load(path.c_str(), &handle), GP_OK) << gp_last_error();
    }
};

gp_output every(double seconds, bool append = false) {
    gp_output output = make_output();
    output.every_seconds = seconds;
    output.append = append ? 1 : 0;
    return output;
}

} // namespace

// Its weight compresses the column to more than twice its density: more than a step takes, but it is the scene as it was given.
TEST_F(Checkpoint, OfAColumnTooSoftForAnyStepCanBeLoaded) {
    gp_config config = make_config();
    config.sound_speed = 0.9;
    Sim sim(config);
    sim.add(make_floor());
    sim.add(make_column(20, 20));
    EXPECT_EQ(gp_step(sim, 1), GP_E_DIVERGED);
    ASSERT_EQ(sim.state().step, 0);
    ASSERT_EQ(gp_save(sim, path.c_str()), GP_OK) << gp_last_error();
    Loaded loaded(path);
    EXPECT_EQ(snapshot(loaded, 1), snapshot(sim, 1));
}

TEST_F(Checkpoint, SavingOnlyReads) {
    Sim sim;
    add_collapse(sim);
    ASSERT_EQ(gp_step(sim, 5), GP_OK);
    const auto before = snapshot(sim, 3);
    const gp_particles view = sim.view(GP_FIELD_ALL);
    const double x = view.x[7];
    ASSERT_EQ(gp_save(sim, path.c_str()), GP_OK) << gp_last_error();
    EXPECT_EQ(sim.epoch(), view.epoch);
    EXPECT_EQ(view.x[7], x);
    EXPECT_EQ(snapshot(sim, 3), before);
    EXPECT_EQ(files(), 1u) << "nothing is left beside it";

    Loaded loaded(path);
    EXPECT_EQ(snapshot(loaded, 3), before);
    EXPECT_EQ(loaded.epoch(), view.epoch);
    EXPECT_GE(loaded.state().wall_seconds, sim.state().wall_seconds);
    ASSERT_EQ(gp_step(sim, 20), GP_OK);
    ASSERT_EQ(gp_step(loaded, 20), GP_OK);
    EXPECT_EQ(snapshot(loaded, 3), snapshot(sim, 3));
    EXPECT_EQ(gp_add_plate(loaded, nullptr, nullptr), GP_E_ARGUMENT);
    const gp_column late = make_column(2, 2, 50, 50);
    EXPECT_FAILS(gp_add_column(loaded, &late, nullptr), GP_E_STATE, "first step");
}

TEST_F(Checkpoint, BeforeTheFirstStepTheSceneGoesOn) {
    Sim sim;
    add_collapse(sim);
    ASSERT_EQ(gp_set_plate_velocity(sim, 1, 0, 0.5), GP_OK);
    ASSERT_EQ(gp_save(sim, path.c_str()), GP_OK) << gp_last_error();
    Loaded loaded(path);
    for (gp_sim *each : {sim.handle, loaded.handle}) {
        const gp_column more = make_column(2, 2, 0.02, 0.2);
        int32_t id = 0;
        ASSERT_EQ(gp_add_column(each, &more, &id), GP_OK) << gp_last_error();
        EXPECT_EQ(id, 1);
        ASSERT_EQ(gp_step(each, 10), GP_OK);
    }
    EXPECT_EQ(snapshot(loaded, 3), snapshot(sim, 3));

    Sim empty;
    ASSERT_EQ(gp_save(empty, path.c_str()), GP_OK) << gp_last_error();
    Loaded again(path);
    EXPECT_EQ(again.count(), 0);
    ASSERT_EQ(gp_step(again, 3), GP_OK);
    ASSERT_EQ(gp_save(again, path.c_str()), GP_OK) << gp_last_error();
    EXPECT_EQ(Loaded(path).state().step, 3);
}

TEST_F(Checkpoint, AfterDivergenceItCanBeReadAndSavedNotStepped) {
    gp_config config = make_config();
    config.time_step = 4e-3;
    config.allow_unstable_step = 1;
    Sim sim(config);
    add_collapse(sim);
    gp_status status = GP_OK;
    for (int k = 0; k < 200 && status == GP_OK; ++k)
        status = gp_step(sim, 1);
    ASSERT_EQ(status, GP_E_DIVERGED);
    const auto before = snapshot(sim, 3);
    ASSERT_EQ(gp_save(sim, path.c_str()), GP_OK) << gp_last_error();
    Loaded loaded(path);
    EXPECT_EQ(snapshot(loaded, 3), before);
    EXPECT_FAILS(gp_step(loaded, 1), GP_E_STATE, "diverged");
    EXPECT_EQ(gp_save(loaded, path.c_str()), GP_OK) << gp_last_error();
}

TEST_F(Checkpoint, FromInsideTheCallback) {
    struct Host {
        std::string path;
        gp_status status = GP_E_INTERNAL;
        static int32_t run(void *user, gp_sim *sim) {
            Host &host = *static_cast<Host *>(user);
            host.status = gp_save(sim, host.path.c_str());
            return 1; // the step that it has seen is complete
        }
    } host{path};
    Sim sim;
    add_collapse(sim);
    ASSERT_EQ(gp_set_callback(sim, 7, Host::run, &host), GP_OK);
    ASSERT_EQ(gp_run(sim, 0.05), GP_STOPPED);
    ASSERT_EQ(host.status, GP_OK);
    Loaded loaded(path);
    EXPECT_EQ(loaded.state().step, 7);
    EXPECT_EQ(snapshot(loaded, 3), snapshot(sim, 3));
    ASSERT_EQ(gp_set_callback(sim, 1, nullptr, nullptr), GP_OK);
    for (gp_sim *each : {sim.handle, loaded.handle})
        ASSERT_EQ(gp_run(each, 0.01), GP_OK);
    EXPECT_EQ(snapshot(loaded, 3), snapshot(sim, 3));
}

TEST_F(Checkpoint, RefusesWhatIsNoCheckpoint) {
    Sim sim;
    sim.add(make_column(3, 3));
    gp_sim *loaded = sim.handle;
    const auto refuse = [&](const std::string &file, const char *why) {
        loaded = sim.handle;
        EXPECT_FAILS(gp_load(file.c_str(), &loaded), GP_E_IO, why);
        EXPECT_TRUE(last_error_has(file)) << gp_last_error();
        EXPECT_EQ(loaded, nullptr);
    };
    refuse(path, "No such file");
    refuse(directory, "regular file");
    refuse("/dev/zero", "regular file");
    std::ofstream(path) << "";
    refuse(path, "not a checkpoint");
    std::ofstream(path) << "not one, either";
    refuse(path, "not a checkpoint");
    ASSERT_EQ(gp_output_open(sim, h5.c_str(), nullptr), GP_OK);
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    refuse(h5, "HDF5 file, but not a checkpoint");
    ASSERT_EQ(gp_save(sim, path.c_str()), GP_OK);
    std::filesystem::resize_file(path, std::filesystem::file_size(path) - 1);
    refuse(path, "damaged");
}

TEST_F(Checkpoint, WhatCannotBeWrittenLeavesTheOldOneAndTheSimulation) {
    Sim sim;
    add_collapse(sim);
    ASSERT_EQ(gp_step(sim, 3), GP_OK);
    ASSERT_EQ(gp_save(sim, path.c_str()), GP_OK);
    const std::string old = bytes_of(path);
    ASSERT_EQ(gp_step(sim, 3), GP_OK);
    const auto before = snapshot(sim, 3);
    EXPECT_FAILS(gp_save(sim, ""), GP_E_IO, "names no file");
    EXPECT_FAILS(gp_save(sim, (directory + "/none/state.gpc").c_str()), GP_E_IO, "No such file or directory");
    EXPECT_FAILS(gp_save(sim, directory.c_str()), GP_E_IO, "Is a directory");
    EXPECT_FAILS(gp_save(sim, (path + "/x").c_str()), GP_E_IO, "Not a directory");
    EXPECT_FAILS(gp_save(sim, "/dev/full"), GP_E_IO, "regular file");
    EXPECT_FAILS(gp_save(sim, "/proc/state.gpc"), GP_E_IO, "/proc/state.gpc");

    for (const rlim_t room : {rlim_t{0}, rlim_t{1000}, static_cast<rlim_t>(old.size() - 1)}) {
        {
            const test::FileSizeLimit limit(room);
            EXPECT_FAILS(gp_save(sim, path.c_str()), GP_E_IO, std::strerror(EFBIG));
        }
        EXPECT_TRUE(bytes_of(path) == old) << room;
        EXPECT_EQ(files(), 1u);
    }
    EXPECT_EQ(snapshot(sim, 3), before);
    EXPECT_EQ(Loaded(path).state().step, 3);

    ASSERT_EQ(gp_save(sim, (directory + "/elsewhere.gpc").c_str()), GP_OK) << gp_last_error();
    EXPECT_EQ(snapshot(Loaded(directory + "/elsewhere.gpc"), 3), before);
    // Through a link, the file behind it.
    std::filesystem::create_symlink(path, directory + "/link.gpc");
    ASSERT_EQ(gp_save(sim, (directory + "/link.gpc").c_str()), GP_OK) << gp_last_error();
    EXPECT_TRUE(std::filesystem::is_symlink(directory + "/link.gpc"));
    EXPECT_EQ(Loaded(path).state().step, 6);
}

// ---------------------------------------------------------------------------------------------- result files go on

TEST_F(Checkpoint, TheOutputGoesBackToWhatItWas) {
    const double interval = 1e-3;
    const std::string whole = directory + "/whole.h5";
    Sim unbroken;
    add_collapse(unbroken);
    const gp_output options = every(interval);
    ASSERT_EQ(gp_output_open(unbroken, whole.c_str(), &options), GP_OK);
    ASSERT_EQ(gp_run(unbroken, 0.01), GP_OK);
    ASSERT_EQ(gp_output_close(unbroken), GP_OK);
    {
        Sim sim;
        add_collapse(sim);
        ASSERT_EQ(gp_output_open(sim, h5.c_str(), &options), GP_OK);
        ASSERT_EQ(gp_run(sim, 0.0035), GP_OK);
        ASSERT_EQ(gp_output_write(sim), GP_OK);
        ASSERT_EQ(gp_save(sim, path.c_str()), GP_OK);
        ASSERT_EQ(gp_output_write(sim), GP_OK) << "of the same step, but later than the checkpoint";
        ASSERT_EQ(gp_run(sim, 0.008), GP_OK);
    }
    Loaded loaded(path);
    EXPECT_FAILS(gp_output_open(loaded, h5.c_str(), &options), GP_E_STATE, "append");
    EXPECT_EQ(frame_times(h5).size(), 11u) << "and is as it was";
    const gp_output append = every(interval, true);
    ASSERT_EQ(gp_output_open(loaded, h5.c_str(), &append), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_run(loaded, 0.01), GP_OK);
    ASSERT_EQ(gp_output_close(loaded), GP_OK);
    std::vector<double> expected = frame_times(whole);
    expected.insert(expected.begin() + 4, 0.0035);
    // The runs land on other points in time: the frames are those of the same multiples.
    const std::vector<double> found = frame_times(h5);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k)
        EXPECT_NEAR(found[k], expected[k], 0.3 * interval);
}

TEST_F(Checkpoint, AppendedFilesHaveToFit) {
    Sim sim;
    add_collapse(sim);
    const gp_output append = every(0, true), plain = every(0);
    EXPECT_FAILS(gp_output_open(sim, h5.c_str(), &append), GP_E_IO, "No such file");
    EXPECT_FALSE(std::filesystem::exists(h5));
    ASSERT_EQ(gp_output_open(sim, h5.c_str(), &plain), GP_OK);
    ASSERT_EQ(gp_output_write(sim), GP_OK);
    ASSERT_EQ(gp_step(sim, 2), GP_OK);
    ASSERT_EQ(gp_output_write(sim), GP_OK);
    Sim other;
    other.add(make_column(3, 3));
    EXPECT_FAILS(gp_output_open(other, h5.c_str(), &append), GP_E_IO, "particles");
    Sim same;
    add_collapse(same);
    EXPECT_FAILS(gp_output_open(same, h5.c_str(), &append), GP_E_IO, "another output is writing");
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    const std::string before = bytes_of(h5);
    gp_output wrong = append;
    wrong.fields |= GP_FIELD_SXX;
    EXPECT_FAILS(gp_output_open(sim, h5.c_str(), &wrong), GP_E_IO, "fields");
    wrong = append;
    wrong.fields = (wrong.fields & ~GP_FIELD_PRESSURE) | GP_FIELD_SXX;
    EXPECT_FAILS(gp_output_open(sim, h5.c_str(), &wrong), GP_E_IO, "lacks the field sxx");
    Sim in_two; // as many particles, but in two columns
    in_two.add(make_column(12, 5));
    in_two.add(make_column(12, 5, 0, 5 * spacing));
    EXPECT_FAILS(gp_output_open(in_two, h5.c_str(), &append), GP_E_IO, "other values of column");
    wrong = append;
    wrong.single_precision = 1;
    EXPECT_FAILS(gp_output_open(sim, h5.c_str(), &wrong), GP_E_IO, "precision");
    wrong = append;
    wrong.append = 2;
    EXPECT_FAILS(gp_output_open(sim, h5.c_str(), &wrong), GP_E_ARGUMENT, "append");
    std::ofstream(directory + "/text.h5") << "text";
    EXPECT_FAILS(gp_output_open(sim, (directory + "/text.h5").c_str(), &append), GP_E_IO, "text.h5");
    EXPECT_TRUE(bytes_of(h5) == before) << "nothing has touched it";
    EXPECT_EQ(files(), 3u);

    // Closed and opened again, without a checkpoint.
    ASSERT_EQ(gp_step(sim, 1), GP_OK);
    ASSERT_EQ(gp_output_open(sim, h5.c_str(), &append), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_output_write(sim), GP_OK);
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    EXPECT_EQ(frame_times(h5).size(), 3u);
    EXPECT_EQ(frame_times(h5).back(), sim.state().time);

    // Frames that the simulation counted on are gone.
    ASSERT_EQ(gp_output_open(sim, h5.c_str(), &append), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_output_write(sim), GP_OK);
    ASSERT_EQ(gp_save(sim, path.c_str()), GP_OK);
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    ASSERT_EQ(gp_output_open(sim, h5.c_str(), &plain), GP_OK);
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    Loaded loaded(path);
    EXPECT_FAILS(gp_output_open(loaded, h5.c_str(), &append), GP_E_IO, "when the simulation was saved");
}

#endif
