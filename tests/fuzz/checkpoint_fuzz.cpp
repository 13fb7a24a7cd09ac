// Checkpoints with the right checksum and wrong contents: the input names numbers and arrays of a good file and what to put
// there. Such a file is refused with a text, or what is loaded can be read, stepped, saved and destroyed.
#include <hdf5.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "edit.hpp"
#include "io/checkpoint_file.hpp"

using namespace fuzz;

namespace {

constexpr std::size_t text_size = 512;

// With all that a checkpoint has: a table of knots, a load, a host's motion, a set of particles, an open output.
Sample sample(int kind) {
    const std::string path = own_file("sample.gp");
    gp_sim *sim = make_scene(kind);
    gp_step(sim, kind == 0 ? 0 : 3);
    ALWAYS(checked(gp_save(sim, path.c_str())) == GP_OK);
    gp_destroy(sim);
    std::ifstream file(path, std::ios::binary);
    file.seekg(text_size);
    return Sample({std::istreambuf_iterator<char>(file), {}});
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, std::size_t size) {
    static const Sample samples[] = {sample(0), sample(1), sample(2), sample(3)};
    Bytes in(data, std::min<std::size_t>(size, 256));
    const uint8_t first = in.byte();
    std::vector<unsigned char> file(text_size);
    const std::vector<unsigned char> edited = edit(samples[first % 4], in);
    file.insert(file.end(), edited.begin(), edited.end());
    gp::io::seal(file);
    if (first >= 240 && size > 3) // damage: cut off, or a byte of it changed, and no right checksum
        file.resize(file.size() * data[1] / 256);
    else if (first >= 200 && size > 3)
        file[(data[1] * 256u + data[2]) % file.size()] ^= data[3];
    const std::string path = own_file("edited.gp");
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char *>(file.data()), static_cast<std::streamsize>(file.size()));
    gp_sim *sim = reinterpret_cast<gp_sim *>(1);
    if (checked(gp_load(path.c_str(), &sim)) < 0) {
        ALWAYS(sim == nullptr);
        return 0;
    }
    bits_of(sim, false);
    const gp_status status = checked(gp_step(sim, 3));
    if (status >= 0)
        bits_of(sim, true);
    double x[4] = {0, 0.01, 0.02, 0.03}, height[4];
    checked(gp_get_surface(sim, 4, x, height));
    gp_load load{};
    load.struct_size = sizeof load;
    checked(gp_get_plate_load(sim, 0, &load));
    checked(gp_save(sim, path.c_str()));
    gp_destroy(sim);
    return 0;
}
