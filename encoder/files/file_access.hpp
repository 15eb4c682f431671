// SPDX-License-Identifier: MIT
// The calls on files that differ between operating systems. One source implements them for POSIX,
// another for Windows. Names are UTF-8. A call that fails leaves the reason in errno.
#ifndef MICROTIN_ENCODER_FILES_FILE_ACCESS_HPP
#define MICROTIN_ENCODER_FILES_FILE_ACCESS_HPP

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>

#include "encoder/layers.hpp"

namespace microtin::files {

// Descriptors that every process has.
constexpr int kStandardInput = 0, kStandardOutput = 1;

// What a system knows of an open file, or of what has a name.
struct FileState {
  bool is_regular = false;
  uint64_t size = 0;
  uint64_t volume = 0, number = 0;          // equal for two names of one file alone
  uint32_t owner = 0, group = 0, mode = 0;  // 0 on Windows
};

// Opens a stream of bytes: on no system are ends of lines converted. Null if that fails.
std::FILE* open_stream(const std::string& path, const char* mode);

// Opens a file for reading, or what is there (such as a device) for writing. Returns a descriptor,
// which programs that this process starts do not inherit, or -1.
int open_to_read(const std::string& path);
int open_to_write(const std::string& path);

// Who may read a new file, and how long it stays: kNameless is private, and is gone once closed.
enum class NewFile { kUsual, kPrivate, kNameless };

// Creates a file, which is open for writing, and for reading if it is nameless. Returns a
// descriptor, or -1: with EEXIST if something has this name.
int create_file(const std::string& path, NewFile kind);

// Returns whether the state is known. The name of a link stands for what it leads to.
bool examine(int file, FileState& state);
bool examine(const std::string& path, FileState& state);

// Whether a folder lists the descriptors of this process, as /dev/fd does.
bool lists_descriptors(const std::filesystem::path& folder);

// Returns another descriptor of an open file, or -1.
int duplicate(int file);

// Gives a file that this process has created the owner and the mode of an older one, where the
// system knows them. Returns whether the file is at most as open to others as the older one.
bool take_after(int file, const FileState& old);

void close_file(int file);

// Reads up to `size` bytes from an offset, in any thread. Returns how many, 0 at the end, or -1.
int64_t read_at(int file, uint64_t offset, void* to, std::size_t size);
bool seek_to(std::FILE* stream, uint64_t offset);

// A file takes the place of another one, or of none, in one step.
bool replace_file(const std::string& from, const std::string& to);
void remove_file(const std::string& path);

// Opens a nameless file in the folder for temporary files. Null if that fails.
std::FILE* open_temporary_stream();

// The number of this process, for names of its files.
uint64_t process_number();

}  // namespace microtin::files

#endif
