// SPDX-License-Identifier: MIT
// A part of a pack's tiles in a file of its own, until merge puts all together.
//
//   head     "mtsh", the version, the length of what follows up to the check, 4 bytes; the pack's
//            header (format-pack.md) with errors and heights left open; the options and the
//            raster's fingerprint; CRC-32 of all that: shards of one pack have the same
//   range    the numbers of the first and the last tile, 4 bytes each
//   tiles    in order: a summary of fixed size, its CRC-32, the stream
#ifndef MICROTIN_ENCODER_PACK_SHARD_HPP
#define MICROTIN_ENCODER_PACK_SHARD_HPP

#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "encoder/files/input.hpp"
#include "encoder/files/output.hpp"
#include "encoder/layers.hpp"
#include "encoder/pack/file.hpp"

namespace microtin::pack {

// Throws Error if a file of this name begins as a shard does, of any version.
void refuse_shard(const std::string& name, const ByteSource& bytes);

class ShardWriter {
 public:
  // The output must outlive this.
  ShardWriter(const PackPlan& plan, const PackContent& pack, TileRange range, OutputFile& out);

  // In the order of numbers.
  void add(const EncodedTile& tile);

 private:
  OutputFile& out_;
};

// Tiles that are finished, in a file from which a later run goes on. It begins as a shard, with as
// many of its tiles as there are.
class TileLog {
 public:
  using Take = std::function<void(uint32_t tile, EncodedTile&&)>;

  // Opens the file, or begins it. Gives away the tiles in it, in order; what was not written whole
  // is dropped. Throws Error if it is of another pack or of other tiles.
  TileLog(const std::string& path, const PackPlan& plan, const PackContent& pack, TileRange range,
          const Take& take);

  // The first tile that is not there.
  uint32_t next() const { return next_; }

  // In the order of numbers. Throws Error naming the file.
  void add(const EncodedTile& tile);

  // Removes the file.
  void remove();

 private:
  uint64_t read(const std::vector<uint8_t>& start, TileRange range, const Take& take);
  void write(const std::vector<uint8_t>& bytes);

  std::string path_;
  uint32_t next_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

// The size of the tiles in such a file; nothing if there is none.
std::optional<uint32_t> logged_tile_size(const std::string& path);

// Joins shards to the pack that a single run makes: returns what it contains but for its streams,
// which go to the spool. Throws Error naming the shard if one is damaged, of another pack, or holds
// a tile that another one holds, too; and if tiles are missing.
PackContent merge_shards(const std::vector<std::string>& paths, StreamSpool& streams);

}  // namespace microtin::pack

#endif
