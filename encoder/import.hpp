// Reading terrains from the files they come in.
#ifndef MICROTIN_ENCODER_IMPORT_HPP
#define MICROTIN_ENCODER_IMPORT_HPP

#include <memory>
#include <string>

#include "encoder/byte_source.hpp"
#include "encoder/raster_reader.hpp"
#include "encoder/source.hpp"

namespace microtin {

// Reads a file by its suffix: .hgt, .asc, or .xyz, .csv, .txt (points). "-" reads points from
// standard input. Throws Error naming the file and, for text, the line.
Source import_terrain(const std::string& path);

// The formats, from a file's content. `name` goes into messages.

// SRTM: a square of posts, 3601 in a row or any number from 2 on, of which the first and the last
// lie a degree apart; big-endian metres from the north-west corner, -32768 where there is none. The
// name's first seven characters (N43E007) place the south-west post.
Raster import_hgt(const std::string& name, const std::string& bytes);
std::unique_ptr<RasterReader> open_hgt(const std::string& name, std::unique_ptr<ByteSource> bytes);

// ESRI ASCII grid. Heights lie at the centres of cells.
Raster import_asc(const std::string& name, const std::string& text);
std::unique_ptr<RasterReader> open_asc(const std::string& name, std::unique_ptr<ByteSource> text);

// Points, one a line: x, y and, if there is a third column, z; separated by blanks, tabs, commas or
// semicolons. Lines that are blank or begin with # are skipped. The first other line may be a
// header: it is one if none of its fields is a number. All lines have the same number of columns;
// those behind the third are ignored, but must hold numbers.
PointCloud import_points(const std::string& name, const std::string& text);

}  // namespace microtin

#endif
