// Status texts, version, features, and the text of the last error.
#include <cstdio>
#include <set>
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
