// Result files to be continued (gp_output.append), with other contents, shapes, types or links than the library writes, or
// cut off. They are refused with a text or continued; the simulation stays as it was and can write elsewhere.
#include <hdf5.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "edit.hpp"

using namespace fuzz;

namespace {

gp_output options_of(bool append) {
    gp_output options;
    ALWAYS(gp_output_init(&options, sizeof options) == GP_OK);
    options.every_seconds = 1e-4;
    options.append = append;
    return options;
}

Sample sample(gp_sim *sim) {
    const std::string path = own_file("sample.h5");
    const gp_output options = options_of(false);
    ALWAYS(checked(gp_output_open(sim, path.c_str(), &options)) == GP_OK);
    ALWAYS(checked(gp_step(sim, 4)) == GP_OK && checked(gp_output_close(sim)) == GP_OK);
    std::ifstream file(path, std::ios::binary);
    return Sample({std::istreambuf_iterator<char>(file), {}});
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, std::size_t size) {
    static gp_sim *const sim = make_scene(1);
    static const Sample good = sample(sim);
    static const std::string before = bits_of(sim, true);
    Bytes in(data, std::min<std::size_t>(size, 256));
    const uint8_t first = in.byte();
    std::vector<unsigned char> file = edit(good, in);
    if (first >= 230 && size > 3)
        file.resize(file.size() * data[1] / 256);
    const std::string path = own_file("edited.h5");
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char *>(file.data()), static_cast<std::streamsize>(file.size()));
    const gp_output options = options_of(true);
    if (checked(gp_output_open(sim, path.c_str(), &options)) == GP_OK) {
        ALWAYS(checked(gp_output_write(sim)) == GP_OK);
        ALWAYS(checked(gp_output_close(sim)) == GP_OK);
    } else if (data[0] % 8 == 0) {
        const gp_output anew = options_of(false);
        ALWAYS(checked(gp_output_open(sim, path.c_str(), &anew)) == GP_OK);
        ALWAYS(checked(gp_output_close(sim)) == GP_OK);
    }
    ALWAYS(bits_of(sim, true) == before);
    return 0;
}
