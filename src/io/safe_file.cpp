#include "io/safe_file.hpp"

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "error.hpp"

namespace gp::io {

namespace {

[[noreturn]] void fail(const std::string &path, const char *what, int number) {
    throw make_error(number == ENOMEM ? GP_E_MEMORY : GP_E_IO, "%s: cannot %s: %s", path.c_str(), what,
                     std::generic_category().message(number).c_str());
}

std::string directory_of(const std::string &path) {
    const std::size_t slash = path.rfind('/');
    return slash == std::string::npos ? "." : slash == 0 ? "/" : path.substr(0, slash);
}

int open_part(const std::string &path, std::string &part) {
    static std::atomic<uint32_t> counter{0};
    const std::size_t name = path.rfind('/') + 1; // 0 without a directory
    for (int attempt = 0; attempt < 1000; ++attempt) {
        // The longest name that file systems take is 255 bytes.
        std::string candidate =
            path.substr(0, name) + path.substr(name, 200) +
            format_text(".part-%ld-%u", static_cast<long>(::getpid()), static_cast<unsigned>(counter++));
        const int fd = ::open(candidate.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (fd >= 0) {
            part = std::move(candidate);
            return fd;
        }
        if (errno != EEXIST)
            break;
    }
    fail(path, "create a file beside it", errno);
}

void rename_file(const std::string &from, const std::string &path) {
    if (::rename(from.c_str(), path.c_str()) != 0)
        fail(path, "rename the new file into its place", errno);
}

// Opened before the rename, after which nothing else may fail.
int open_directory(const std::string &path) {
    return ::open(directory_of(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
}

// Some file systems cannot sync a directory, and some directories may be written but not read: the file is there.
void sync_directory(const Descriptor &directory, const std::string &path) {
    if (directory >= 0 && ::fsync(directory) != 0 && errno != EINVAL && errno != ENOTSUP)
        fail(path, "sync its directory", errno);
}

int open_regular(const std::string &path) {
    const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    struct stat status;
    if (fd < 0)
        fail(path, "open the file", errno);
    if (::fstat(fd, &status) == 0 && S_ISREG(status.st_mode))
        return fd;
    ::close(fd);
    throw make_error(GP_E_IO, "%s: cannot open the file: not a regular file", path.c_str());
}

} // namespace

bool write_all(int fd, const void *source, std::size_t size, uint64_t offset) noexcept {
    const char *bytes = static_cast<const char *>(source);
    while (size > 0) {
        const ssize_t n = ::pwrite(fd, bytes, size, static_cast<off_t>(offset));
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0) {
            errno = n == 0 ? EIO : errno;
            return false;
        }
        bytes += n;
        size -= static_cast<std::size_t>(n);
        offset += static_cast<uint64_t>(n);
    }
    return true;
}

std::string replaceable_path(const std::string &path) {
    if (path.empty() || path.back() == '/')
        throw make_error(GP_E_IO, "%s: cannot create the file: the path names no file", path.c_str());
    struct stat status;
    if (::stat(path.c_str(), &status) != 0) {
        if (errno != ENOENT)
            fail(path, "create the file", errno);
        return path;
    }
    if (S_ISDIR(status.st_mode))
        fail(path, "create the file", EISDIR);
    if (!S_ISREG(status.st_mode))
        throw make_error(GP_E_IO, "%s: cannot create the file: not a regular file", path.c_str());
    if (::lstat(path.c_str(), &status) == 0 && S_ISLNK(status.st_mode)) {
        char *const resolved = ::realpath(path.c_str(), nullptr);
        if (resolved == nullptr)
            fail(path, "follow the link", errno);
        const std::string target = resolved;
        std::free(resolved);
        return target;
    }
    return path;
}

void move_into_place(const std::string &from, const std::string &path) {
    const Descriptor directory(open_directory(path));
    rename_file(from, path);
    sync_directory(directory, path);
}

NewFile::NewFile(const std::string &path)
    : path_(path), target_(replaceable_path(path)), descriptor_(open_part(target_, part_)) {}

NewFile::~NewFile() {
    if (!part_.empty())
        ::unlink(part_.c_str());
}

void NewFile::put_into_place() {
    if (::fsync(descriptor_) != 0)
        fail(path_, "sync the file", errno);
    if (!descriptor_.close())
        fail(path_, "close the file", errno);
    const Descriptor directory(open_directory(target_));
    rename_file(part_, target_);
    part_.clear();
    sync_directory(directory, target_);
}

void require_regular_file(const std::string &path) {
    const Descriptor file(open_regular(path));
}

OldFile::OldFile(const std::string &path) : descriptor_(open_regular(path)) {
    struct stat status;
    if (::fstat(descriptor_, &status) != 0)
        fail(path, "read the file", errno);
    size_ = static_cast<uint64_t>(status.st_size);
}

std::size_t read_some(int fd, void *bytes, std::size_t size, uint64_t offset, const std::string &path) {
    std::size_t done = 0;
    while (done < size) {
        const ssize_t n =
            ::pread(fd, static_cast<char *>(bytes) + done, size - done, static_cast<off_t>(offset + done));
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0)
            fail(path, "read the file", errno);
        if (n == 0)
            break;
        done += static_cast<std::size_t>(n);
    }
    return done;
}

bool read_or_zeros(int fd, void *bytes, std::size_t size, uint64_t offset) noexcept {
    try {
        const std::size_t done = read_some(fd, bytes, size, offset, "");
        std::memset(static_cast<char *>(bytes) + done, 0, size - done);
        return true;
    } catch (const std::exception &) {
        return false;
    }
}

} // namespace gp::io
