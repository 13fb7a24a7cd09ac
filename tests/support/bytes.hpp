// All that a file holds.
#pragma once

#include <fstream>
#include <iterator>
#include <string>

namespace test {

template <class Bytes = std::string> Bytes bytes_of(const std::string &path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

} // namespace test
