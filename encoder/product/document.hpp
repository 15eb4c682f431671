// SPDX-License-Identifier: MIT
// What the encoder has made, read back and checked: a stream or a pack, whichever a file holds.
#ifndef MICROTIN_ENCODER_PRODUCT_DOCUMENT_HPP
#define MICROTIN_ENCODER_PRODUCT_DOCUMENT_HPP

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "encoder/export/queries.hpp"
#include "encoder/import/breaklines.hpp"
#include "encoder/import/prepared_terrain.hpp"
#include "encoder/layers.hpp"
#include "encoder/pack/file.hpp"
#include "encoder/stream/decoded_terrain.hpp"
#include "encoder/terrain/polygons.hpp"
#include "encoder/verify/breaklines.hpp"
#include "encoder/verify/verify.hpp"

namespace microtin::product {

struct DecodedStream {
  std::vector<uint8_t> bytes;
  DecodedTerrain terrain;
};

// The bytes of a stream's file, or of standard input for "-", decoded. Throws Error naming it.
DecodedStream read_stream(const std::string& path);

// As many as a stream can have.
constexpr uint64_t kMostVerticesAtOnce = kMaxVertices;

// All functions throw Error naming the file.
class Document {
 public:
  // A pack if the file begins as one does, else a stream, which is decoded. "-" is a stream.
  explicit Document(const std::string& path);
  Document(const std::string& name, std::unique_ptr<ByteSource> bytes);

  const std::string& path() const { return path_; }

  // What it is: one of them is not null.
  const PackFile* pack() const { return std::get_if<PackFile>(&content_); }
  const DecodedStream* stream() const { return std::get_if<DecodedStream>(&content_); }
  DecodedStream* stream() { return std::get_if<DecodedStream>(&content_); }

  Metadata metadata() const;
  uint64_t bytes() const;
  uint64_t vertices() const;  // of a pack: those on borders once for each tile, as its header says
  uint64_t counted_vertices() const;  // as the streams' own headers say
  uint64_t tiles() const;             // 0: a stream

  // A tile of a pack as PackFile has it.
  std::optional<DecodedTerrain> tile(uint32_t number) const;

  // With units. All of a pack's tiles are decoded, if they have at most this many vertices
  // together; each takes some 150 bytes.
  SurfaceModel model(uint64_t most_vertices = kMostVerticesAtOnce) const;

  // With units: what a decoder has of a stream after its first bytes. Throws Error for a pack, too.
  SurfaceModel model_after(uint64_t bytes) const;

  // The document must outlive it.
  SampledSurface sampled() const;

 private:
  SurfaceModel with_units(SurfaceModel model) const;

  std::string path_;
  std::variant<PackFile, DecodedStream> content_;
};

// What a header promises of the heights.
struct Promise {
  std::optional<Decimal> bound;        // of posts with bounds of their own: their scale
  std::optional<StatedBounds> bounds;  // if posts have bounds of their own
  std::optional<Decimal> water_level;  // at which posts are exact
};

// Throws Error naming the file if a terrain is given another water level than it notes.
void expect_water_level(const std::string& path, const std::optional<Decimal>& noted,
                        const std::optional<Decimal>& given);

// Throws Error if a terrain is known to be in other units or systems than a stream or a pack. Those
// that one of them does not state are no difference.
void expect_same_system(const Metadata& file, const Reference& terrain);

// A terrain that a document is compared with: read in pieces for a pack, whole for a stream. Of a
// LAS or LAZ file the classes are taken that the document notes, if none are requested; of points
// that share a place those that stand for all by the document's rule.
class Original {
 public:
  // The document must outlive it. Throws Error naming the terrain's file.
  Original(const Document& document, const std::string& path, const Preparation& preparation);

  // A raster's frame, or the points: one of them is not null.
  const Raster* raster() const;
  const PointCloud* cloud() const;

  // Throws Error if the terrain was given another water level than the document notes.
  Promise promise() const;

  // Queries the document at every post or point. Throws Error as for a mesh or a pack.
  Verification compare(const std::optional<Decimal>& bound, const Progress& progress,
                       const PostVisitor& visit) const;

  // What a comparison found, and whether the promise is kept.
  struct Judgement {
    Promise promise;
    Verification found;
    uint64_t water_moved;
    std::optional<Verification> true_places;  // of points, where the document notes such errors
    std::optional<Decimal> true_bound;        // that is promised there
  };
  // Throws Error also if only one of document and terrain has bounds of an error map.
  Judgement judge(const Progress& progress) const;

  // Looks for lines among the edges, at heights within the bound that is promised, and compares the
  // marks of a stream with them. Throws Error for a pack of points.
  FoundBreaklines breaklines(const BreaklineFile& file) const;

 private:
  const Document& document_;
  std::optional<Decimal> water_level_;
  std::variant<Source, OpenSource> source_;
};

// A pack by name, read tile by tile.
struct OpenPack {
  std::vector<uint8_t> header;  // with placement, notes and check
  PackFile file;                // reads an entry of the index with the entry's tile
};

// Throws Error naming the file if it is no pack, if its header is wrong, or if its index is cut
// off.
OpenPack open_pack(const std::string& path);

// What is damaged in a file, and how two packs differ: a source of its own.

struct Checked {
  uint32_t tiles = 0;  // of a pack; 0: a stream
  std::vector<TileFault> faults;
};

// Decodes all of a stream, or all tiles of a pack. Throws Error naming the file if it is a stream
// that is damaged, or a pack whose header is wrong or whose index is cut off.
Checked check_file(const std::string& path);

struct Difference {
  uint32_t tiles = 0;
  bool is_header_same = false;   // placement and notes, too
  std::vector<uint32_t> differ;  // the tiles of which bytes differ
};

// Throws Error naming a file that is no pack, or is damaged; or both, if they have other tiles or
// another lattice.
Difference compare_packs(const std::string& first, const std::string& second);

}  // namespace microtin::product

#endif
