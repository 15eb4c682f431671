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
#include <memory>
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

// Joins shards to the pack that a single run makes: returns what it contains but for its streams,
// which go to the spool. Throws Error naming the shard if one is damaged, of another pack, or holds
// a tile that another one holds, too; and if tiles are missing.
PackContent merge_shards(const std::vector<std::string>& paths, StreamSpool& streams);

}  // namespace microtin::pack

#endif
