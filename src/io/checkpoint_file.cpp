#include "io/checkpoint_file.hpp"

#include <algorithm>
#include <cinttypes>
#include <cstring>

#include "io/checkpoint_store.hpp"

namespace gp::io {

namespace {

constexpr std::size_t text_size = 512;                   // of the user block
constexpr std::size_t piece_size = std::size_t{1} << 18; // of a file that is read for its checksum
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

// The text but for its checksum counts, too.
uint64_t checksum_of(const std::string &text) {
    return checksum_of(reinterpret_cast<const unsigned char *>(text.data()), text.size(), text.size());
}
std::string sealed(const std::string &text, const unsigned char *bytes, std::size_t size) {
    return whole_text(text, checksum_of(bytes, size, checksum_of(text)));
}

// The same of a file behind its text.
std::string sealed(const std::string &text, int fd, uint64_t size, const std::string &path) {
    uint64_t sum = checksum_of(text);
    std::vector<unsigned char> piece(piece_size);
    for (uint64_t at = text_size; at < size;) {
        const std::size_t some =
            read_some(fd, piece.data(), static_cast<std::size_t>(std::min<uint64_t>(piece_size, size - at)), at, path);
        if (some == 0)
            break;
        sum = checksum_of(piece.data(), some, sum);
        at += some;
    }
    return whole_text(text, sum);
}

Error bad_file(const std::string &path, const std::string &why) {
    return make_error(GP_E_IO, "%s: %s", path.c_str(), why.c_str());
}

// What the text says.
struct Said {
    unsigned long long format;
    std::string library;
};

Said check_text(const std::string &path, const std::string &text, uint64_t size_of_file) {
    const bool is_hdf5 =
        text.size() >= sizeof hdf5_signature && std::memcmp(text.data(), hdf5_signature, sizeof hdf5_signature) == 0;
    if (text.compare(0, sizeof title - 1, title) != 0)
        throw bad_file(path, is_hdf5 ? "an HDF5 file, but not a checkpoint of granperi (gp_save)"
                                     : "not a checkpoint of granperi (gp_save)");
    if (size_of_file <= text_size)
        throw bad_file(path, format_text("the checkpoint is cut off after %" PRIu64 " bytes", size_of_file));
    std::size_t at = sizeof title - 1;
    const std::string format = word_of_line(text, "format ", at), library = word_of_line(text, "library ", at);
    const std::string size = word_of_line(text, "bytes ", at);
    const auto is_number = [](const std::string &word) {
        return !word.empty() && word.size() <= 20 && word.find_first_not_of("0123456789") == std::string::npos;
    };
    if (!is_number(format) || format.size() > 9 || library.empty() || !is_number(size))
        throw bad_file(path, "the checkpoint is damaged: its first lines");
    const unsigned long long expected = std::strtoull(size.c_str(), nullptr, 10);
    if (size_of_file != expected)
        throw bad_file(path,
                       format_text("the checkpoint is damaged: %" PRIu64 " bytes of %llu", size_of_file, expected));
    return {std::strtoull(format.c_str(), nullptr, 10), library};
}

} // namespace

void seal(std::vector<unsigned char> &file, uint32_t format) {
    const std::string text = text_without_checksum(format, gp_version_string(), file.size());
    const std::string whole = sealed(text, file.data() + text_size, file.size() - text_size);
    std::copy(whole.begin(), whole.end(), file.begin());
}

namespace {

std::unique_ptr<CheckpointStore> store_in(int fd, haddr_t size) {
    auto store = std::make_unique<CheckpointStore>();
    store->fd = fd;
    store->shift = text_size;
    store->end = size;
    return store;
}

} // namespace

// ------------------------------------------------------------------------------------------------------ writing

CheckpointWriter::CheckpointWriter(const std::string &file_path) : new_file_(file_path) {
    path = file_path;
    check_version();
    store_ = store_in(new_file_.descriptor(), 0);
    driver = own(H5FDregister(&checkpoint_store_driver()), "register the file driver");
    access = own(H5Pcreate(H5P_FILE_ACCESS), "describe the checkpoint");
    CheckpointStore *const target = store_.get();
    check(H5Pset_driver(access, driver, &target), "describe the checkpoint");
    check(H5Pset_fclose_degree(access, H5F_CLOSE_STRONG), "describe the checkpoint");
    file = own(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), "make the checkpoint");
}

CheckpointWriter::~CheckpointWriter() {
    group_.close();
    file.close(); // before the store goes
}

void CheckpointWriter::group(const char *name) {
    group_ = make_group(name, 16);
}

Id CheckpointWriter::make_array(const char *name, hid_t stored, std::size_t size) {
    const std::string what = std::string("write ") + name;
    Id how = own(H5Pcreate(H5P_DATASET_CREATE), what);
    check(H5Pset_obj_track_times(how, false), what);           // the same state gives the same bytes,
    check(H5Pset_alloc_time(how, H5D_ALLOC_TIME_EARLY), what); // in whatever order they come
    check(H5Pset_fill_time(how, H5D_FILL_TIME_NEVER), what);
    const Id extent = space({size}, {size});
    return own(H5Dcreate2(group_, name, stored, extent, H5P_DEFAULT, how, H5P_DEFAULT), what);
}

void CheckpointWriter::append(Growing &array, const void *values, std::size_t count) {
    if (count == 0)
        return;
    const std::string what = "write " + array.name;
    const Id memory = space({count}, {count}), place = space({array.size}, {array.size});
    const hsize_t first = array.done, some = count;
    check(H5Sselect_hyperslab(place, H5S_SELECT_SET, &first, nullptr, &some, nullptr), what);
    check(H5Dwrite(array.dataset, array.native, memory, place, H5P_DEFAULT, values), what);
    array.done += count;
    if (store_->error != 0)
        throw io_failure(path, "write the file", store_->error);
}

void CheckpointWriter::put_into_place() {
    group_.close();
    const bool good = H5Fclose(file.release()) >= 0;
    if (store_->error != 0)
        throw io_failure(path, "write the file", store_->error);
    check(good ? 0 : -1, "make the checkpoint");
    const uint64_t size = text_size + store_->end;
    const std::string text = text_without_checksum(checkpoint_format, gp_version_string(), size);
    const std::string whole = sealed(text, new_file_.descriptor(), size, path);
    if (!write_all(new_file_.descriptor(), whole.data(), whole.size(), 0))
        throw io_failure(path, "write the file", errno);
    new_file_.put_into_place();
}

// ------------------------------------------------------------------------------------------------------ reading

CheckpointReader::CheckpointReader(const std::string &file_path) : old_file_(file_path), text_(text_size, '\0') {
    path = file_path;
    text_.resize(read_some(old_file_.descriptor(), text_.data(), text_.size(), 0, path));
    check_text(path, text_, old_file_.size());
}

CheckpointReader::~CheckpointReader() {
    group_.close();
    file.close(); // before the store goes
}

void CheckpointReader::require_whole() const {
    const Said said = check_text(path, text_, old_file_.size());
    const std::string own = text_without_checksum(said.format, said.library, old_file_.size());
    if (text_ != sealed(own, old_file_.descriptor(), old_file_.size(), path))
        throw bad_file(path, "the checkpoint is damaged: its checksum is wrong");
    if (said.format == 0)
        throw bad_file(path, "there is no format 0 of checkpoints");
    // What an earlier step left out cannot be made up: volume, walls, sums of the state, the mean pressure.
    if (said.format != checkpoint_format)
        throw make_error(GP_E_VERSION, "%s: written by granperi %s in format %llu; this version, %s, reads format %u",
                         path.c_str(), said.library.c_str(), said.format, gp_version_string(), checkpoint_format);
}

void CheckpointReader::open() {
    check_version();
    store_ = store_in(old_file_.descriptor(), old_file_.size() - text_size);
    driver = own(H5FDregister(&checkpoint_store_driver()), "register the file driver");
    access = own(H5Pcreate(H5P_FILE_ACCESS), "open the checkpoint");
    CheckpointStore *const source = store_.get();
    check(H5Pset_driver(access, driver, &source), "open the checkpoint");
    check(H5Pset_fclose_degree(access, H5F_CLOSE_STRONG), "open the checkpoint");
    file = own(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access), "open the checkpoint");
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
    if (size > old_file_.size() / item || (size > 0 && H5Dget_storage_size(dataset) != size * item))
        refuse(what + " is longer than the file");
    return static_cast<std::size_t>(size);
}

void CheckpointReader::require_size(const char *name, std::size_t size, std::size_t expected) const {
    if (size != expected)
        refuse(group_name_ + "/" + name + format_text(": %zu values, expected %zu", size, expected));
}

void CheckpointReader::read_some_of(const char *name, hid_t dataset, hid_t native, std::size_t first, std::size_t count,
                                    void *values) const {
    if (count == 0)
        return;
    const std::string what = "read " + group_name_ + "/" + name;
    const Id place = own(H5Dget_space(dataset), what), memory = space({count}, {count});
    const hsize_t start = first, some = count;
    check(H5Sselect_hyperslab(place, H5S_SELECT_SET, &start, nullptr, &some, nullptr), what);
    check(H5Dread(dataset, native, memory, place, H5P_DEFAULT, values), what);
}

void CheckpointReader::read_at(const char *name, hid_t dataset, hid_t native, const std::vector<hsize_t> &places,
                               void *values) const {
    if (places.empty())
        return;
    const std::string what = "read " + group_name_ + "/" + name;
    const Id place = own(H5Dget_space(dataset), what), memory = space({places.size()}, {places.size()});
    check(H5Sselect_elements(place, H5S_SELECT_SET, places.size(), places.data()), what);
    check(H5Dread(dataset, native, memory, place, H5P_DEFAULT, values), what);
}

} // namespace gp::io
