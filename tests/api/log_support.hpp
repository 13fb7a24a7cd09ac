// What a simulation tells its log.
#pragma once

#include <functional>

#include "api_support.hpp"

namespace api {

struct Log {
    std::vector<std::string> warnings, notes;
    static void run(void *user, int32_t level, const char *text) {
        Log &log = *static_cast<Log *>(user);
        (level == GP_LOG_WARNING ? log.warnings : log.notes).emplace_back(text);
    }
    std::string all() const {
        std::string text;
        for (const std::string &line : warnings)
            text += line + "\n";
        return text;
    }
    // Warnings that have all these words.
    int count(const std::vector<std::string> &words) const {
        int found = 0;
        for (const std::string &line : warnings) {
            bool has_all = true;
            for (const std::string &word : words)
                has_all = has_all && line.find(word) != std::string::npos;
            found += has_all;
        }
        return found;
    }
};

using Build = std::function<void(Sim &)>;

// All that the scene tells until this time, looked at in four parts.
inline Log log_of(const gp_config &config, const Build &build, double time) {
    Sim sim(config);
    Log log;
    EXPECT_EQ(gp_set_log(sim, Log::run, &log), GP_OK);
    build(sim);
    EXPECT_TRUE(log.warnings.empty()) << log.all();
    for (int k = 1; k <= 4; ++k)
        EXPECT_EQ(gp_run(sim, time * k / 4), GP_OK) << gp_last_error();
    return log;
}

// A warning with all these words has come exactly once.
inline void expect_once(const gp_config &config, const Build &build, double time,
                        const std::vector<std::string> &words) {
    const Log log = log_of(config, build, time);
    EXPECT_EQ(log.count(words), 1) << log.all();
}

inline void expect_silence(const gp_config &config, const Build &build, double time) {
    const Log log = log_of(config, build, time);
    EXPECT_TRUE(log.warnings.empty()) << log.all();
}

} // namespace api
