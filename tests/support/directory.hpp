// A new directory for a test's files, removed at the end with all that is in it.
#pragma once

#include <gtest/gtest.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

namespace test {

class TemporaryDirectory {
public:
    explicit TemporaryDirectory(const std::string &name) : path_(testing::TempDir() + name + "_XXXXXX") {
        if (::mkdtemp(&path_[0]) == nullptr)
            throw std::system_error(errno, std::generic_category(), path_);
    }
    TemporaryDirectory(const TemporaryDirectory &) = delete;
    TemporaryDirectory &operator=(const TemporaryDirectory &) = delete;
    ~TemporaryDirectory() { std::filesystem::remove_all(path_); }
    const std::string &path() const { return path_; }

private:
    std::string path_;
};

} // namespace test
