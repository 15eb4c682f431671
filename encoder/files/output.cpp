// SPDX-License-Identifier: MIT
// Output that appears complete or not at all, what its name leads to, and streams that wait for it.
#include "encoder/files/output.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstddef>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/files/file_access.hpp"
#include "encoder/files/process.hpp"

namespace microtin::files {
namespace fs = std::filesystem;
namespace {

constexpr int kMostLinks = 40;  // as the system's own

std::optional<int> number_of_descriptor(const fs::path& path) {
  const std::string name = path.filename().string();
  const char* const end = name.data() + name.size();
  int number = -1;
  const auto [next, error] = std::from_chars(name.data(), end, number);
  if (error != std::errc() || next != end || number < 0) return std::nullopt;
  if (!lists_descriptors(path.parent_path())) return std::nullopt;
  return number;
}

// The name behind links, as far as a descriptor: where that leads is not for us to open.
fs::path behind_links(const std::string& path) {
  fs::path target = fs::u8path(path);
  std::error_code ignored;  // what cannot be examined is no link, and cannot be opened
  for (int links = 0; fs::is_symlink(fs::symlink_status(target, ignored)); ++links) {
    if (number_of_descriptor(target)) break;
    if (links == kMostLinks) {
      throw Error(path + ": " + std::generic_category().message(ELOOP));
    }
    const fs::path next = fs::read_symlink(target, ignored);
    target = target.parent_path() / next;  // `next` alone if that is absolute
  }
  return target;
}

// What a name stands for if that is a regular file.
std::optional<FileState> regular_file(const std::string& path, int standard) {
  FileState state;
  const bool is_known = path == "-" ? examine(standard, state) : examine(path, state);
  if (!is_known || !state.is_regular) return std::nullopt;
  return state;
}

}  // namespace

std::optional<int> descriptor_named(const std::string& path) {
  if (path == "-") return kStandardOutput;
  return number_of_descriptor(behind_links(path));
}

std::optional<std::string> replaced_by(const std::string& path) {
  if (descriptor_named(path)) return std::nullopt;
  const std::string target = behind_links(path).string();
  std::error_code ignored;  // a target that cannot be examined is one that cannot be opened
  if (fs::is_directory(fs::u8path(target), ignored)) throw Error(path + ": is a directory");
  FileState state;
  if (examine(target, state) && !state.is_regular) return std::nullopt;
  return target;
}

void refuse_overwriting(const std::vector<std::string>& inputs, const std::string& output) {
  for (const std::string& written : {output, std::string("-")}) {
    const std::optional<FileState> target = regular_file(written, kStandardOutput);
    for (const std::string& input : inputs) {
      const std::optional<FileState> source = regular_file(input, kStandardInput);
      if (!target || !source) continue;
      if (source->volume != target->volume || source->number != target->number) continue;
      throw Error((written == "-" ? "standard output" : written) +
                  ": is also an input; choose another output");
    }
  }
}

std::FILE* stream_of(int file, const char* mode) {
  std::FILE* const stream = file < 0 ? nullptr : fdopen(file, mode);
  if (stream == nullptr && file >= 0) {
    const int error = errno;
    close_file(file);
    errno = error;
  }
  return stream;
}

int open_new(std::string& name, NewFile kind) {
  constexpr int kMostLeftovers = 1000;
  const std::string stem = name + std::to_string(process_number());
  name = stem;
  for (int i = 0;; ++i) {
    const int file = create_file(name, kind);
    if (file >= 0 || errno != EEXIST || i == kMostLeftovers) return file;
    name = stem + '-' + std::to_string(i);
  }
}

OutputFile::OutputFile(const std::string& path) : path_(path) {
  if (const std::optional<std::string> target = replaced_by(path)) {
    target_ = *target;
    open_temporary();
    return;
  }
  const std::optional<int> descriptor = descriptor_named(path);
  if (descriptor == kStandardOutput) {
    file_ = stdout;
  } else if (descriptor) {
    file_ = stream_of(duplicate(*descriptor), "wb");
  } else {
    file_ = stream_of(open_to_write(path), "wb");
  }
  if (file_ == nullptr) fail();
}

void OutputFile::open_temporary() {
  std::string name = target_ + ".part-";
  FileState old;
  const bool replaces = examine(target_, old);
  const SignalsHeld held;
  const int file = open_new(name, replaces ? NewFile::kPrivate : NewFile::kUsual);
  if (file < 0) fail();
  file_ = stream_of(file, "wb");
  if (file_ == nullptr || (replaces && !take_after(file, old))) {
    const int error = errno;
    if (file_ != nullptr) std::fclose(file_);
    remove_file(name);
    errno = error;
    fail();
  }
  temporary_ = std::move(name);  // nothing may throw from here on: the file would stay
  leftover_.emplace(temporary_);
}

OutputFile::~OutputFile() {
  if (file_ != nullptr && file_ != stdout) std::fclose(file_);
  if (!temporary_.empty()) remove_file(temporary_);
}

void OutputFile::write(std::string_view bytes) {
  if (bytes.empty()) return;  // there may be no data to point at
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail();
}

void OutputFile::commit() {
  if (std::fflush(file_) != 0) fail();
  if (file_ == stdout) return;
  std::FILE* file = file_;
  file_ = nullptr;
  if (std::fclose(file) != 0) fail();
  if (temporary_.empty()) return;
  if (!replace_file(temporary_, target_)) fail();
  leftover_.reset();
  temporary_.clear();
}

void OutputFile::fail() const {
  const int error = errno;
  const std::string text = path_ + ": cannot be written: " + std::generic_category().message(error);
  if (file_ == stdout && nobody_reads(error)) throw NobodyReads(text);
  throw Error(text);
}

namespace {

std::FILE* open_nameless(const std::string& output) {
  const std::optional<std::string> target = replaced_by(output);
  if (!target) return open_temporary_stream();
  std::string name = *target + ".streams-";
  const SignalsHeld held;
  return stream_of(open_new(name, NewFile::kNameless), "w+b");
}

}  // namespace

StreamSpool::StreamSpool(const std::string& output)
    : output_(output), file_(open_nameless(output), &std::fclose) {
  if (!file_) fail();
}

uint64_t StreamSpool::add(const std::vector<uint8_t>& stream) {
  if (stream.empty()) return 0;
  const uint64_t end = places_.bytes();
  const uint64_t place =
      places_.place(stream, [&](uint64_t offset) { return holds(stream, offset); });
  if (place != end) return place;
  if (std::fwrite(stream.data(), 1, stream.size(), file_.get()) != stream.size()) fail();
  return end;
}

// The file stays where it is written next.
bool StreamSpool::holds(const std::vector<uint8_t>& stream, uint64_t offset) {
  std::vector<uint8_t> there(stream.size());
  const uint64_t end = places_.bytes();
  go_to(offset);
  if (std::fread(there.data(), 1, there.size(), file_.get()) != there.size()) fail();
  go_to(end);
  return there == stream;
}

void StreamSpool::clear() {
  go_to(0);
  places_ = {};
}

void StreamSpool::copy_to(OutputFile& out) {
  if (std::fflush(file_.get()) != 0) fail();
  go_to(0);
  std::vector<char> piece(65536);
  for (uint64_t left = places_.bytes(); left != 0;) {
    const std::size_t size = std::min<uint64_t>(left, piece.size());
    if (std::fread(piece.data(), 1, size, file_.get()) != size) fail();
    out.write({piece.data(), size});
    left -= size;
  }
}

void StreamSpool::go_to(uint64_t offset) {
  if (!seek_to(file_.get(), offset)) fail();
}

void StreamSpool::fail() const {
  throw Error(output_ + ": cannot be written: " + std::generic_category().message(errno));
}

uint64_t StreamPlaces::place(const std::vector<uint8_t>& stream, const IsAt& is_at) {
  const std::string_view text(reinterpret_cast<const char*>(stream.data()), stream.size());
  const size_t hash = std::hash<std::string_view>()(text);
  const auto [first, last] = places_.equal_range(hash);
  for (auto at = first; at != last; ++at) {
    const Place& place = at->second;
    if (place.size == stream.size() && is_at(place.offset)) return place.offset;
  }
  const uint64_t end = bytes_;
  places_.emplace(hash, Place{end, stream.size()});
  bytes_ += stream.size();
  return end;
}

uint64_t JoinedStreams::add(const std::vector<uint8_t>& stream) {
  if (stream.empty()) return 0;
  const uint64_t end = bytes_.size();
  const uint64_t place = places_.place(stream, [&](uint64_t offset) {
    return std::equal(stream.begin(), stream.end(),
                      bytes_.begin() + static_cast<std::ptrdiff_t>(offset));
  });
  if (place == end) bytes_.insert(bytes_.end(), stream.begin(), stream.end());
  return place;
}

}  // namespace microtin::files
