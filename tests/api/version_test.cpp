// Status texts, version, features, and the text of the last error.
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <set>
#include <string>
#include <thread>

#include "api_support.hpp"

using namespace api;

TEST(Version, NumberAndTextSayTheHeadersVersion) {
    EXPECT_EQ(gp_version(), GP_VERSION_MAJOR * 10000u + GP_VERSION_MINOR * 100u + GP_VERSION_PATCH);
    char text[32];
    std::snprintf(text, sizeof text, "%d.%d.%d", GP_VERSION_MAJOR, GP_VERSION_MINOR, GP_VERSION_PATCH);
    EXPECT_STREQ(gp_version_string(), text);
}

TEST(Version, FeaturesAreZeroOrOne) {
    for (const char *name : {"hdf5", "openmp"}) {
        EXPECT_GE(gp_has_feature(name), 0) << name;
        EXPECT_LE(gp_has_feature(name), 1) << name;
    }
    for (const char *name : {"", "HDF5", "hdf", "hdf5 ", "mpi"})
        EXPECT_EQ(gp_has_feature(name), 0) << name;
    EXPECT_EQ(gp_has_feature(nullptr), 0);
}

namespace {

constexpr const char *levels[] = {"generic", "x86-64", "x86-64-v2", "x86-64-v3", "x86-64-v4"};

// Sets an environment variable for a while.
struct Environment {
    Environment(const char *name, const char *value) : name_(name) {
        if (const char *before = std::getenv(name))
            before_ = before;
        setenv(name, value, 1);
    }
    Environment(const Environment &) = delete;
    Environment &operator=(const Environment &) = delete;
    ~Environment() {
        if (before_)
            setenv(name_, before_->c_str(), 1);
        else
            unsetenv(name_);
    }

private:
    const char *name_;
    std::optional<std::string> before_;
};

} // namespace

TEST(Version, OneInstructionSetRuns) {
    int found = 0;
    for (const char *level : levels)
        found += gp_has_feature(level);
    EXPECT_EQ(found, 1);
#ifdef __x86_64__
    EXPECT_EQ(gp_has_feature("generic"), 0);
#else
    EXPECT_EQ(gp_has_feature("generic"), 1);
#endif
}

// What runs is chosen by the first call: to ask for anything else is an error, not ignored.
TEST(Version, AskingForAnInstructionSetThatDoesNotRunIsRefused) {
    const gp_config config = make_config();
    for (const char *level : {levels[0], levels[1], levels[2], levels[3], levels[4], "", "avx2", "X86-64"}) {
        const Environment environment("GRANPERI_LEVEL", level);
        gp_sim *sim = nullptr;
        if (gp_has_feature(level)) {
            EXPECT_EQ(gp_create(&config, &sim), GP_OK) << level;
            gp_destroy(sim);
            continue;
        }
        EXPECT_EQ(gp_create(&config, &sim), GP_E_UNSUPPORTED) << level;
        EXPECT_EQ(sim, nullptr);
        EXPECT_TRUE(last_error_has("GRANPERI_LEVEL") && last_error_has(level) && last_error_has("x86-64"))
            << gp_last_error();
        EXPECT_EQ(gp_load_file("nowhere.h5", &sim), GP_E_UNSUPPORTED) << level;
    }
}

TEST(Status, EveryStatusHasItsOwnText) {
    std::set<std::string> texts;
    for (gp_status status = GP_E_INTERNAL; status <= GP_STOPPED; ++status) {
        ASSERT_NE(gp_status_string(status), nullptr);
        EXPECT_STRNE(gp_status_string(status), "");
        EXPECT_STRNE(gp_status_string(status), "unknown status");
        texts.insert(gp_status_string(status));
    }
    EXPECT_EQ(texts.size(), 10u);
    for (gp_status status : {2, -9, 1000, INT32_MIN, INT32_MAX})
        EXPECT_STREQ(gp_status_string(status), "unknown status");
}

TEST(Status, LastErrorIsEmptyInAThreadWithoutErrorsAndBelongsToItsThread) {
    gp_create(nullptr, nullptr);
    EXPECT_STRNE(gp_last_error(), "");
    const std::string ours = gp_last_error();
    std::string before, after;
    std::thread([&] {
        before = gp_last_error();
        gp_config config;
        gp_config_init(&config, sizeof config, 77);
        after = gp_last_error();
    }).join();
    EXPECT_EQ(before, "");
    EXPECT_NE(after.find("77"), std::string::npos) << after;
    EXPECT_EQ(gp_last_error(), ours);
}

TEST(Status, LastErrorNamesArgumentValueAndExpectation) {
    gp_config config = make_config();
    config.horizon = 8.5;
    gp_sim *sim;
    EXPECT_EQ(gp_create(&config, &sim), GP_E_ARGUMENT);
    EXPECT_TRUE(last_error_has("horizon") && last_error_has("8.5") && last_error_has("1.8") && last_error_has("8"))
        << gp_last_error();
}

// "of this thread's most recent error": a success does not wipe it out.
TEST(Status, LastErrorStaysAfterSuccess) {
    gp_create(nullptr, nullptr);
    const std::string text = gp_last_error();
    gp_version();
    EXPECT_EQ(gp_last_error(), text);
}
