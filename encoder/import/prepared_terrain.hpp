// SPDX-License-Identifier: MIT
// Terrains as they are encoded, and as they are compared with the result; and folders of their
// files.
#ifndef MICROTIN_ENCODER_IMPORT_PREPARED_TERRAIN_HPP
#define MICROTIN_ENCODER_IMPORT_PREPARED_TERRAIN_HPP

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "encoder/import/bound_map.hpp"
#include "encoder/import/features.hpp"
#include "encoder/import/import.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/degrees.hpp"
#include "encoder/terrain/raster_reader.hpp"

namespace microtin::importing {

// The files of a terrain: for a folder those in it, by name, of the suffix that most of its terrain
// files have. Throws Error if a folder holds none.
std::vector<std::string> files_in(const std::string& path);

// What people should know of a folder that holds terrain files of other suffixes, too; else empty.
std::string left_out_of(const std::string& path);

// What is where a terrain has no file: unknown, or sea at the water level.
enum class Absent : uint8_t { kVoid, kSea };

// What is done to a terrain.
struct Preparation {
  std::vector<std::string> more_files;     // of the same terrain, after the one named first
  std::string cells;                       // the list that named some of them, or empty
  std::optional<ClassSet> classes;         // take these points of a .las or .laz file
  bool gridded = false;                    // points are the posts of a raster
  uint32_t fill_voids = 0;                 // interpolate voids of up to this many posts; 0: none
  std::optional<Decimal> water_level;      // voids that are left are water at this height
  std::string water_mask;                  // the file that marks water; everywhere if there is none
  Absent absent = Absent::kVoid;           // what places in none of the files are
  std::vector<DegreeCell> sea;             // cells of which those places are sea
  Indirect indirect = Indirect::kRefused;  // files that name others
  uint32_t band = 0;                       // of a file that has several, from 1 on
  std::string area;                        // the file of polygons outside of which all is void
  std::string route;                       // the file of lines far from which all is void
  std::optional<Decimal> route_width;      // metres; together with `route`
  std::optional<Decimal> route_edge_error;  // the bound there; max_error is that at the lines
  std::string error_map;                    // the file of posts' own bounds; empty: none
  std::string obstacles;                    // the file of what raises the terrain; empty: none
  std::string breaklines;                   // the file of lines, which are read elsewhere
  std::shared_ptr<const FileTexts> texts;   // that stand for such files; null: there are none
  std::shared_ptr<ReadFeatures> features = std::make_shared<ReadFeatures>();  // of such files
  std::optional<Decimal> max_error;  // the bound where that says nothing
  // Settled with each file's; nothing: units and systems are left alone, where no heights are used.
  std::optional<Reference> requested = Reference{};
};

// How the files of features are read.
FeatureFiles feature_files_of(const Preparation& preparation);

// Throws Error naming the file if one of the files of features states another system, or has
// positions that there are not.
void expect_systems(const Preparation& preparation, const Reference& terrain);

// All files that a terrain is read from, those of a folder and a list too; none for one without a
// name. Throws Error as preparing does.
std::vector<std::string> files_of(const std::string& path, const Preparation& preparation);

// Cuts a terrain to the area, gives its samples the bounds of the map, and raises it to the
// obstacles, as the files of `preparation` say. `map`, if there is one, replaces its error map.
// Throws Error naming the file.
void shape(Source& source, const Preparation& preparation,
           std::optional<BoundMap> map = std::nullopt);

// Throws Error naming the file. `map` is as for `shape`.
Source prepared_terrain(const std::string& path, const Preparation& preparation,
                        std::optional<BoundMap> map = std::nullopt);

// Opens a prepared source whose raster is read in pieces. Throws Error when a piece is read, too.
// `map` is as for `shape`.
OpenSource prepared_source(const std::string& path, const Preparation& preparation,
                           std::optional<BoundMap> map = std::nullopt);

// Parts of a sentence about what was done to a terrain: empty if nothing was.
std::string describe_preparation(const Mended& mended, const std::string& selection);

}  // namespace microtin::importing

#endif
