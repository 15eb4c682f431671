// SPDX-License-Identifier: MIT
#include "tests/faults/injected.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <new>

#include "microtin/microtin.h"

namespace microtin::faults {
namespace {

Counters* active = nullptr;
bool reading_failed = false;

// Null if the request fails.
void* memory_of(std::size_t size) {
  if (active == nullptr) return std::malloc(size);
  active->largest_request = std::max<uint64_t>(active->largest_request, size);
  return active->memory.fails() ? nullptr : std::malloc(size);
}

bool file_fails() {
  if (active == nullptr || !active->files.fails()) return false;
  errno = EIO;
  return true;
}

}  // namespace

void inject(Counters* counters) {
  active = counters;
}

// What the linker's option --wrap calls in place of the C library, and the library itself.
std::FILE* real_fopen(const char* path, const char* mode) __asm__("__real_fopen");
std::FILE* real_fdopen(int file, const char* mode) __asm__("__real_fdopen");
size_t real_fread(void* to, size_t size, size_t count, std::FILE* file) __asm__("__real_fread");
size_t real_fwrite(const void* from, size_t size, size_t count,
                   std::FILE* file) __asm__("__real_fwrite");
int real_ferror(std::FILE* file) __asm__("__real_ferror");
int real_fflush(std::FILE* file) __asm__("__real_fflush");
int real_fclose(std::FILE* file) __asm__("__real_fclose");
int real_rename(const char* from, const char* to) __asm__("__real_rename");

ssize_t real_pread(int file, void* to, size_t size, off_t offset) __asm__("__real_pread");

std::FILE* wrap_fopen(const char* path, const char* mode) __asm__("__wrap_fopen");
std::FILE* wrap_fdopen(int file, const char* mode) __asm__("__wrap_fdopen");
size_t wrap_fread(void* to, size_t size, size_t count, std::FILE* file) __asm__("__wrap_fread");
size_t wrap_fwrite(const void* from, size_t size, size_t count,
                   std::FILE* file) __asm__("__wrap_fwrite");
int wrap_ferror(std::FILE* file) __asm__("__wrap_ferror");
int wrap_fflush(std::FILE* file) __asm__("__wrap_fflush");
int wrap_fclose(std::FILE* file) __asm__("__wrap_fclose");
int wrap_rename(const char* from, const char* to) __asm__("__wrap_rename");
ssize_t wrap_pread(int file, void* to, size_t size, off_t offset) __asm__("__wrap_pread");

std::FILE* wrap_fopen(const char* path, const char* mode) {
  return file_fails() ? nullptr : real_fopen(path, mode);
}

std::FILE* wrap_fdopen(int file, const char* mode) {
  return file_fails() ? nullptr : real_fdopen(file, mode);
}

size_t wrap_fread(void* to, size_t size, size_t count, std::FILE* file) {
  reading_failed = file_fails();
  return reading_failed ? 0 : real_fread(to, size, count, file);
}

size_t wrap_fwrite(const void* from, size_t size, size_t count, std::FILE* file) {
  return file_fails() ? 0 : real_fwrite(from, size, count, file);
}

int wrap_ferror(std::FILE* file) {
  return reading_failed ? 1 : real_ferror(file);
}

int wrap_fflush(std::FILE* file) {
  return file_fails() ? EOF : real_fflush(file);
}

int wrap_fclose(std::FILE* file) {
  const int result = real_fclose(file);
  return file_fails() ? EOF : result;
}

int wrap_rename(const char* from, const char* to) {
  return file_fails() ? -1 : real_rename(from, to);
}

ssize_t wrap_pread(int file, void* to, size_t size, off_t offset) {
  return file_fails() ? -1 : real_pread(file, to, size, offset);
}

microtin_status real_finish(microtin_decoder* decoder) __asm__("__real_microtin_decoder_finish");
microtin_query_result real_height_at(const microtin_mesh* mesh, int32_t x, int32_t y,
                                     uint32_t* hint, int32_t* height, uint32_t flags,
                                     uint32_t step_limit) __asm__("__real_microtin_mesh_height_at");
microtin_status wrap_finish(microtin_decoder* decoder) __asm__("__wrap_microtin_decoder_finish");
microtin_query_result wrap_height_at(const microtin_mesh* mesh, int32_t x, int32_t y,
                                     uint32_t* hint, int32_t* height, uint32_t flags,
                                     uint32_t step_limit) __asm__("__wrap_microtin_mesh_height_at");

microtin_status wrap_finish(microtin_decoder* decoder) {
  const microtin_status status = real_finish(decoder);
  return active != nullptr && active->streams.fails() ? MICROTIN_STATUS_MALFORMED : status;
}

microtin_query_result wrap_height_at(const microtin_mesh* mesh, int32_t x, int32_t y,
                                     uint32_t* hint, int32_t* height, uint32_t flags,
                                     uint32_t step_limit) {
  const microtin_query_result kind = real_height_at(mesh, x, y, hint, height, flags, step_limit);
  if (active != nullptr && kind == MICROTIN_QUERY_OK && active->heights.fails()) *height += 1 << 24;
  return kind;
}

}  // namespace microtin::faults

void* operator new(std::size_t size) {
  void* const memory = microtin::faults::memory_of(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return microtin::faults::memory_of(size);
}

void operator delete(void* memory) noexcept {
  std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
