#include "encoder/png.hpp"

#define STBI_WRITE_NO_STDIO
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

#include "encoder/error.hpp"

namespace microtin {

std::vector<uint8_t> png(const std::vector<uint8_t>& rgba, uint32_t width, uint32_t height) {
  const auto append = [](void* file, void* data, int size) {
    const auto* bytes = static_cast<const uint8_t*>(data);
    static_cast<std::vector<uint8_t>*>(file)->insert(
        static_cast<std::vector<uint8_t>*>(file)->end(), bytes, bytes + size);
  };
  std::vector<uint8_t> file;
  const int w = static_cast<int>(width), h = static_cast<int>(height);
  if (stbi_write_png_to_func(append, &file, w, h, 4, rgba.data(), 4 * w) == 0) {
    throw Error("the picture does not fit into memory");
  }
  return file;
}

}  // namespace microtin
