// SPDX-License-Identifier: MIT
// Reading terrains from the files they come in, and lists of such files.
#ifndef MICROTIN_ENCODER_IMPORT_IMPORT_HPP
#define MICROTIN_ENCODER_IMPORT_IMPORT_HPP

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "encoder/files/input.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/degrees.hpp"
#include "encoder/terrain/raster_reader.hpp"
#include "encoder/terrain/source.hpp"

namespace microtin::importing {

// Files of GDAL's that name others to be read (.vrt), and names of its virtual file systems
// (/vsi...): the author of such a file chooses what is read.
enum class Indirect { kRefused, kAllowed };

// Reads a file by its suffix: .hgt, .zip (one .hgt), .asc (with a .prj next to it, if there is
// one), .xyz, .csv, .txt (points, or a grid by what they begin with), .las, .laz, .ply, .obj; in
// builds with GDAL all others by GDAL. "-" reads points from standard input. `classes` are for .las
// and .laz alone; `band`, from 1 on, says which one of several GDAL reads. Throws Error naming the
// file and, for text, the line.
Source import_terrain(const std::string& path, const std::optional<ClassSet>& classes = {},
                      Indirect indirect = Indirect::kRefused, uint32_t band = 0);

// All files that it is read from: more than one by GDAL, where GDAL can open it.
std::vector<std::string> terrain_files(const std::string& path, Indirect indirect);

// The suffixes of files that are read, for people.
std::string terrain_kinds();

// Whether a folder is searched for files with this suffix, such as ".asc", in lower case.
bool is_terrain_suffix(const std::string& suffix);

using OpenSource = std::variant<std::unique_ptr<RasterReader>, PointCloud>;

// Opens such a file. .hgt and .asc files are read in pieces, .asc once as a whole before, to check
// it and to learn where its posts are: 8 bytes of memory for each 512 of them. Others are kept in
// memory. Throws Error as import_terrain does, and if it cannot be read in pieces.
OpenSource open_terrain(const std::string& path, const std::optional<ClassSet>& classes = {},
                        Indirect indirect = Indirect::kRefused, uint32_t band = 0);

// The formats, from a file's content. `name` goes into messages.

// SRTM: a square of posts, 3601 in a row or any number from 2 on, of which the first and the last
// lie a degree apart, or 3601 or 1201 rows of fewer columns, 2, 3, 4 or 6 times as far apart, such
// as 1801; big-endian metres from the north-west corner, -32768 where there is none. The
// name's first seven characters (N43E007) place the south-west post.
Raster import_hgt(const std::string& name, const std::string& bytes);
std::unique_ptr<RasterReader> open_hgt(const std::string& name, std::unique_ptr<ByteSource> bytes);

// Whether a text begins as an ESRI ASCII grid does, by a key of its header.
bool is_grid(std::string_view text);

// ESRI ASCII grid. Heights lie at the centres of cells. What it refers to stands elsewhere.
Raster import_asc(const std::string& name, const std::string& text);
std::unique_ptr<RasterReader> open_asc(const std::string& name, std::unique_ptr<ByteSource> text,
                                       Reference reference = {});

// Points, one a line: x, y and, if there is a third column, z; separated by blanks, tabs, commas or
// semicolons. Lines that are blank or begin with # are skipped. The first other line may be a
// header: it is one if none of its fields is a number. Where it names x and y (also easting,
// longitude, lon; northing, latitude, lat) and z (height, elevation, altitude), it says which
// columns these are; z is the third if it names none. Longitudes are degrees. All lines have the
// same number of columns; others are ignored, but must hold numbers unless they are named.
PointCloud import_points(const std::string& name, const std::string& text);

// Points of LAS 1.0 to 1.4, formats 0 to 10, with codes and units from GeoTIFF keys or well-known
// text, also compressed as LAZ: formats 0 to 3, and 6 to 10 in layers. Takes the classes requested;
// if none are, the ground (2) or, in a file without, all but noise (7 and 18). Points flagged as
// withheld are never taken.
PointCloud import_las(const std::string& name, const std::string& bytes,
                      const std::optional<ClassSet>& classes);

// Vertices of a PLY file, text or binary, and of a Wavefront OBJ file; z is up. Binary fractions
// stand for the shortest decimal that becomes them. Faces are left out.
PointCloud import_ply(const std::string& name, const std::string& bytes);
PointCloud import_obj(const std::string& name, const std::string& text);

// The one .hgt file in a zip archive.
Raster import_zip(const std::string& name, const std::string& bytes);

#ifdef MICROTIN_WITH_GDAL
// The only band of heights in what GDAL opens, or that of a number from 1 on. Columns must run
// east, rows south or north. Posts are void by the band's value for that, or by its mask. Heights,
// cell sizes and corners stand for the shortest decimals that become them.
Raster import_gdal(const std::string& path, Indirect indirect, uint32_t band);
std::vector<std::string> gdal_files(const std::string& path, Indirect indirect);
#endif

// Lists of files that make up a terrain, and of cells that are sea.

struct CellList {
  std::vector<std::string> files;  // or folders
  std::vector<DegreeCell> sea;
};

// Reads a list of a name a line; names are relative to the list's folder. "sea N50W010" says that a
// cell without a file is sea. Blank lines and those that begin with # are skipped. Throws Error
// naming the list and the line.
CellList read_cell_list(const std::string& path);

}  // namespace microtin::importing

#endif
