// Files that are whole or not there: written beside their place, synced, and then renamed into it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace gp::io {

// Writes all of it from an offset on, however often the system takes only a part. False, with errno, where it cannot.
bool write_all(int fd, const void *source, std::size_t size, uint64_t offset) noexcept;

// Where a file of that name is put: of a symbolic link to a file, what it points to. Throws gp::Error(GP_E_IO) where the
// name is taken by something that is not a regular file, or names none.
std::string replaceable_path(const std::string &path);

// The new file of that path, or the old one: nothing between, whatever happens to the program or the machine. A program
// killed in it may leave <path>.part-<process>-<number>. Throws gp::Error(GP_E_IO); then the old file is as it was.
void replace_file(const std::string &path, const unsigned char *bytes, std::size_t size);

// Renames a file that is on the disk into the place of another, and has the directory remember it.
void move_into_place(const std::string &from, const std::string &path);

// Throws gp::Error(GP_E_IO) if there is no regular file of that name that may be read.
void require_regular_file(const std::string &path);

// All of a regular file. Throws gp::Error(GP_E_IO).
std::vector<unsigned char> read_file(const std::string &path);

} // namespace gp::io
