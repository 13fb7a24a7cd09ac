// For the tests of result files as a program sees them.
#pragma once

#include <filesystem>
#include <fstream>

#include "../support/directory.hpp"
#include "api_support.hpp"

#ifdef GP_TEST_HDF5
#include "../support/result_file.hpp"
#endif

namespace api {

#ifdef GP_TEST_HDF5
using test::frame_times;
#endif

class Output : public testing::Test {
protected:
    const test::TemporaryDirectory temporary{"granperi_output"};
    const std::string directory = temporary.path(), path = directory + "/run.h5";
};

} // namespace api
