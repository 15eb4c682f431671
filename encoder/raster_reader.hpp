// A raster of which rectangles are read, so that the whole need not fit into memory.
#ifndef MICROTIN_ENCODER_RASTER_READER_HPP
#define MICROTIN_ENCODER_RASTER_READER_HPP

#include <memory>
#include <string>
#include <utility>

#include "encoder/crop.hpp"
#include "encoder/source.hpp"

namespace microtin {

// Reading from several threads at once is allowed.
class RasterReader {
 public:
  RasterReader() = default;
  RasterReader(const RasterReader&) = delete;
  RasterReader& operator=(const RasterReader&) = delete;
  virtual ~RasterReader() = default;

  // The raster without its heights.
  const Raster& frame() const { return frame_; }

  // The posts of a rectangle within the raster, at their real coordinates. Throws Error.
  virtual Raster read(const PostRectangle& rectangle) const = 0;

 protected:
  Raster frame_;
};

class RasterInMemory : public RasterReader {
 public:
  explicit RasterInMemory(Raster raster);

  Raster read(const PostRectangle& rectangle) const override { return crop(raster_, rectangle); }

 private:
  Raster raster_;
};

// Opens a file that import_terrain reads. .hgt and .asc files are read in pieces, .asc once as a
// whole before, to check it and to learn where its posts are: 8 bytes of memory for each 512 of
// them. Others are kept in memory. Throws Error as import_terrain does, and if it holds points or
// cannot be read in pieces.
std::unique_ptr<RasterReader> open_raster(const std::string& path);

// The raster with its small voids filled as fill_voids does. Memory and time of a rectangle grow
// with the extent of the small voids in it.
std::unique_ptr<RasterReader> with_voids_filled(std::unique_ptr<RasterReader> raster,
                                                uint32_t largest);

}  // namespace microtin

#endif
