// SPDX-License-Identifier: MIT
// Hands pixels to the PNG writer.
#include "encoder/picture/png.hpp"

#include <algorithm>
#include <new>

namespace {

// The picture's writer goes on writing when memory is short: it must not come back to that. What
// it holds is lost, as the program ends.
void* allocate(size_t size) {
  return ::operator new(std::max<size_t>(size, 1));  // clang's analyzer follows a size of 0
}

void release(void* memory) {
  ::operator delete(memory);
}

void* grow(void* old, size_t old_size, size_t size) {
  void* const grown = allocate(size);
  std::copy_n(static_cast<const char*>(old), std::min(old_size, size), static_cast<char*>(grown));
  release(old);
  return grown;
}

}  // namespace

// Functions: where the writer has "a ? STBIW_FREE(b), 0 : 0", clang 14 calls a plain ::operator
// delete for any a.
#define STBIW_MALLOC(size) allocate(static_cast<size_t>(size))
#define STBIW_REALLOC_SIZED(old, old_size, size) \
  grow(old, static_cast<size_t>(old_size), static_cast<size_t>(size))
#define STBIW_FREE(memory) release(memory)
#define STBI_WRITE_NO_STDIO
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

#include "encoder/base/error.hpp"

namespace microtin::picture {

std::vector<uint8_t> png(const std::vector<uint8_t>& rgb, uint32_t width, uint32_t height) {
  const auto append = [](void* file, void* data, int size) {
    const auto* bytes = static_cast<const uint8_t*>(data);
    static_cast<std::vector<uint8_t>*>(file)->insert(
        static_cast<std::vector<uint8_t>*>(file)->end(), bytes, bytes + size);
  };
  std::vector<uint8_t> file;
  const int w = static_cast<int>(width), h = static_cast<int>(height);
  if (stbi_write_png_to_func(append, &file, w, h, 3, rgb.data(), 3 * w) == 0) {
    throw Error("the picture does not fit into memory");
  }
  return file;
}

}  // namespace microtin::picture
