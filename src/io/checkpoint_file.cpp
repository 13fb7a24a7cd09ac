#include "io/checkpoint_file.hpp"

#include <cinttypes>
#include <cstring>

namespace gp::io {

namespace {

constexpr std::size_t text_size = 512; // of the user block
constexpr std::size_t memory_step = std::size_t{1} << 20;
constexpr char title[] = "granperi checkpoint\n";
constexpr unsigned char hdf5_signature[] = {0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};

// Any change in up to eight bytes beside each other changes it: every step is one to one.
uint64_t checksum_of(const unsigned char *bytes, std::size_t size, uint64_t sum) {
    for (std::size_t k = 0; k < size; k += 8) {
        uint64_t word = 0;
        for (std::size_t b = 0; b < 8 && k + b < size; ++b)
            word |= static_cast<uint64_t>(bytes[k + b]) << (8 * b);
        sum = (sum ^ word) * 0x9E3779B97F4A7C15u;
        sum ^= sum >> 32;
    }
    return sum;
}

// The text but for its checksum counts, too.
uint64_t checksum_of(const std::string &text, const std::vector<unsigned char> &bytes) {
    const uint64_t of_text =
        checksum_of(reinterpret_cast<const unsigned char *>(text.data()), text.size(), text.size());
    return checksum_of(bytes.data() + text_size, bytes.size() - text_size, of_text);
}

std::string text_without_checksum(uint64_t format, const std::string &library, std::size_t size) {
    return title + format_text("format %" PRIu64 "\nlibrary %s\nbytes %020" PRIu64 "\n", format, library.c_str(),
                               static_cast<uint64_t>(size));
}

std::string whole_text(const std::string &text, uint64_t checksum) {
    std::string whole = text + format_text("checksum %016" PRIx64 "\n", checksum);
    whole.resize(text_size, '\0');
    return whole;
}

// The word after "name " at the beginning of the line at `at`, which moves to the next line; "" if it is not there.
std::string word_of_line(const std::string &text, const char *name, std::size_t &at) {
    const std::size_t length = std::strlen(name), end = text.find('\n', at);
    if (end == std::string::npos || text.compare(at, length, name) != 0)
        return "";
    const std::string word = text.substr(at + length, end - at - length);
    at = end + 1;
    return word;
}

bool is_hdf5(const std::vector<unsigned char> &bytes) {
    return bytes.size() >= sizeof hdf5_signature &&
           std::memcmp(bytes.data(), hdf5_signature, sizeof hdf5_signature) == 0;
}

Error bad_file(const std::string &path, const std::string &why) {
    return make_error(GP_E_IO, "%s: %s", path.c_str(), why.c_str());
}

// Everything about the file that can be told without HDF5.
void check_bytes(const std::string &path, const std::vector<unsigned char> &bytes) {
    if (bytes.size() < sizeof title - 1 || std::memcmp(bytes.data(), title, sizeof title - 1) != 0)
        throw bad_file(path, is_hdf5(bytes) ? "an HDF5 file, but not a checkpoint of granperi (gp_save)"
                                            : "not a checkpoint of granperi (gp_save)");
    if (bytes.size() <= text_size)
        throw bad_file(path, format_text("the checkpoint is cut off after %zu bytes", bytes.size()));
    const std::string text(reinterpret_cast<const char *>(bytes.data()), text_size);
    std::size_t at = sizeof title - 1;
    const std::string format = word_of_line(text, "format ", at), library = word_of_line(text, "library ", at);
    const std::string size = word_of_line(text, "bytes ", at);
    const auto is_number = [](const std::string &word) {
        return !word.empty() && word.size() <= 20 && word.find_first_not_of("0123456789") == std::string::npos;
    };
    if (!is_number(format) || format.size() > 9 || library.empty() || !is_number(size))
        throw bad_file(path, "the checkpoint is damaged: its first lines");
    const unsigned long long expected = std::strtoull(size.c_str(), nullptr, 10);
    if (bytes.size() != expected)
        throw bad_file(path, format_text("the checkpoint is damaged: %zu bytes of %llu", bytes.size(), expected));
    const unsigned long long number = std::strtoull(format.c_str(), nullptr, 10);
    const std::string own = text_without_checksum(number, library, bytes.size());
    if (text != whole_text(own, checksum_of(own, bytes)))
        throw bad_file(path, "the checkpoint is damaged: its checksum is wrong");
    if (number == 0)
        throw bad_file(path, "there is no format 0 of checkpoints");
    if (number != checkpoint_format) // what an earlier step left out cannot be made up: volume, walls, sums of the state
        throw make_error(GP_E_VERSION, "%s: written by granperi %s in format %llu; this version, %s, reads format %u",
                         path.c_str(), library.c_str(), number, gp_version_string(), checkpoint_format);
}

} // namespace

void seal(std::vector<unsigned char> &file, uint32_t format) {
    const std::string text = text_without_checksum(format, gp_version_string(), file.size());
    const std::string whole = whole_text(text, checksum_of(text, file));
    std::copy(whole.begin(), whole.end(), file.begin());
}

// ------------------------------------------------------------------------------------------------------ writing

CheckpointWriter::CheckpointWriter(const std::string &file_path) {
    path = file_path;
    check_version();
    access = own(H5Pcreate(H5P_FILE_ACCESS), "describe the checkpoint");
    check(H5Pset_fapl_core(access, memory_step, false), "describe the checkpoint");
    check(H5Pset_fclose_degree(access, H5F_CLOSE_STRONG), "describe the checkpoint");
    file = own(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), "make the checkpoint");
}

void CheckpointWriter::group(const char *name) {
    group_ = make_group(name, 16);
}

void CheckpointWriter::write_array(const char *name, hid_t stored, hid_t native, std::size_t size, const void *values) {
    const std::string what = std::string("write ") + name;
    Id how = own(H5Pcreate(H5P_DATASET_CREATE), what);
    check(H5Pset_obj_track_times(how, false), what); // the same state gives the same bytes
    const Id extent = space({size}, {size});
    const Id dataset = own(H5Dcreate2(group_, name, stored, extent, H5P_DEFAULT, how, H5P_DEFAULT), what);
    if (size > 0)
        check(H5Dwrite(dataset, native, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), what);
}

std::vector<unsigned char> CheckpointWriter::bytes() {
    group_.close();
    check(H5Fflush(file, H5F_SCOPE_LOCAL), "make the checkpoint");
    const ssize_t size = check(H5Fget_file_image(file, nullptr, 0), "make the checkpoint");
    // HDF5 finds itself behind a block of 512 bytes.
    std::vector<unsigned char> whole(text_size + static_cast<std::size_t>(size));
    check(H5Fget_file_image(file, whole.data() + text_size, static_cast<std::size_t>(size)), "make the checkpoint");
    file.close();
    seal(whole);
    return whole;
}

// ------------------------------------------------------------------------------------------------------ reading

CheckpointReader::CheckpointReader(const std::string &file_path, std::vector<unsigned char> bytes)
    : file_size_(bytes.size()) {
    path = file_path;
    check_version();
    check_bytes(path, bytes);
    access = own(H5Pcreate(H5P_FILE_ACCESS), "open the checkpoint");
    check(H5Pset_fapl_core(access, memory_step, false), "open the checkpoint");
    check(H5Pset_fclose_degree(access, H5F_CLOSE_STRONG), "open the checkpoint");
    // copies them
    check(H5Pset_file_image(access, bytes.data() + text_size, bytes.size() - text_size), "open the checkpoint");
    bytes = {};
    // HDF5 makes sure that there is no file of the name that it is given for what is in memory.
    file = own(H5Fopen("/dev/null/granperi checkpoint", H5F_ACC_RDONLY, access), "open the checkpoint");
}

void CheckpointReader::refuse(const std::string &why) const {
    throw bad_file(path, "not a usable checkpoint: " + why);
}

void CheckpointReader::group(const char *name) {
    group_name_ = name;
    group_ = own(H5Gopen2(file, name, H5P_DEFAULT), std::string("open ") + name);
}

void CheckpointReader::require_type(const std::string &what, hid_t found, hid_t stored) const {
    if (check(H5Tequal(found, stored), "read " + what) == 0)
        refuse(what + " is of another type");
}

void CheckpointReader::read_value(const char *name, hid_t stored, hid_t native, void *number) const {
    const std::string what = group_name_ + "/" + name;
    const Id attribute = own(H5Aopen(group_, name, H5P_DEFAULT), "read " + what);
    const Id type = own(H5Aget_type(attribute), "read " + what), extent = own(H5Aget_space(attribute), "read " + what);
    require_type(what, type, stored);
    if (H5Sget_simple_extent_type(extent) != H5S_SCALAR)
        refuse(what + " is not a single number");
    check(H5Aread(attribute, native, number), "read " + what);
}

Id CheckpointReader::open_array(const char *name, hid_t stored) const {
    const std::string what = group_name_ + "/" + name;
    Id dataset = own(H5Dopen2(group_, name, H5P_DEFAULT), "read " + what);
    const Id type = own(H5Dget_type(dataset), "read " + what);
    require_type(what, type, stored);
    // What gp_save writes; anything else could lead to other files or to more than the file holds.
    const Id how = own(H5Dget_create_plist(dataset), "read " + what);
    if (H5Pget_layout(how) != H5D_CONTIGUOUS || H5Pget_external_count(how) != 0 || H5Pget_nfilters(how) != 0)
        refuse(what + " is stored in another way");
    return dataset;
}

std::size_t CheckpointReader::array_size(const char *name, hid_t dataset, std::size_t item) const {
    const std::string what = group_name_ + "/" + name;
    const Id extent = own(H5Dget_space(dataset), "read " + what);
    if (H5Sget_simple_extent_type(extent) != H5S_SIMPLE || H5Sget_simple_extent_ndims(extent) != 1)
        refuse(what + " is not a row of numbers");
    hsize_t size = 0;
    check(H5Sget_simple_extent_dims(extent, &size, nullptr), "read " + what);
    if (size > file_size_ / item || (size > 0 && H5Dget_storage_size(dataset) != size * item))
        refuse(what + " is longer than the file");
    return static_cast<std::size_t>(size);
}

void CheckpointReader::read_array(const char *name, hid_t dataset, hid_t native, void *values, std::size_t size) const {
    if (size > 0)
        check(H5Dread(dataset, native, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), "read " + group_name_ + "/" + name);
}

} // namespace gp::io
