// Files that are whole or not there: written beside their place, synced, and then renamed into it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include <unistd.h>

namespace gp::io {

// Writes all of it from an offset on, however often the system takes only a part. False, with errno, where it cannot.
bool write_all(int fd, const void *source, std::size_t size, uint64_t offset) noexcept;

// Where a file of that name is put: of a symbolic link to a file, what it points to. Throws gp::Error(GP_E_IO) where the
// name is taken by something that is not a regular file, or names none.
std::string replaceable_path(const std::string &path);

// Owns a file descriptor.
class Descriptor {
public:
    explicit Descriptor(int fd) : fd_(fd) {}
    Descriptor(const Descriptor &) = delete;
    Descriptor &operator=(const Descriptor &) = delete;
    ~Descriptor() { close(); }
    operator int() const { return fd_; }
    bool close() { return fd_ < 0 || ::close(std::exchange(fd_, -1)) == 0; }

private:
    int fd_;
};

// The new file of that path, or the old one: nothing between, whatever happens to the program or the machine. It is
// <path>.part-<process>-<number> until put_into_place; a program killed before may leave that, one that gives up does not. All
// throw gp::Error(GP_E_IO); then the old file is as it was.
class NewFile {
public:
    explicit NewFile(const std::string &path);
    NewFile(const NewFile &) = delete;
    NewFile &operator=(const NewFile &) = delete;
    ~NewFile();
    int descriptor() const { return descriptor_; } // to write to, and to read again
    void put_into_place();

private:
    std::string path_, target_, part_;
    Descriptor descriptor_;
};

// Renames a file that is on the disk into the place of another, and has the directory remember it.
void move_into_place(const std::string &from, const std::string &path);

// Throws gp::Error(GP_E_IO) if there is no regular file of that name that may be read.
void require_regular_file(const std::string &path);

// A regular file to be read. Throws gp::Error(GP_E_IO).
class OldFile {
public:
    explicit OldFile(const std::string &path);
    int descriptor() const { return descriptor_; }
    uint64_t size() const { return size_; }

private:
    Descriptor descriptor_;
    uint64_t size_ = 0;
};

// As much of it as there is. path: for gp::Error(GP_E_IO).
std::size_t read_some(int fd, void *bytes, std::size_t size, uint64_t offset, const std::string &path);
// And zeros behind that. False on failure.
bool read_or_zeros(int fd, void *bytes, std::size_t size, uint64_t offset) noexcept;

} // namespace gp::io
