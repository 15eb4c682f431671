// Packs as bytes (PACK.md), on the host.
#ifndef MICROTIN_ENCODER_PACK_FILE_HPP
#define MICROTIN_ENCODER_PACK_FILE_HPP

#include <cstdint>
#include <optional>
#include <vector>

#include "encoder/decoded_terrain.hpp"
#include "encoder/metadata.hpp"
#include "encoder/pack_encode.hpp"
#include "shared/pack_format.hpp"

namespace microtin {

// The placement is the pack's, whatever the metadata say. Throws Error if notes or streams are too
// long.
std::vector<uint8_t> write_pack(const EncodedPack& pack, Metadata metadata);

// Whether bytes begin as those of a pack do.
bool is_pack(const std::vector<uint8_t>& bytes);

class PackFile {
 public:
  // Reads header and index. Throws Error if they are damaged or break a rule.
  explicit PackFile(std::vector<uint8_t> bytes);

  const TileGrid& grid() const { return header_.grid; }
  const PackHeader& header() const { return header_; }
  const Metadata& metadata() const { return metadata_; }
  const std::vector<PackEntry>& entries() const { return entries_; }  // by tile
  std::size_t bytes() const { return bytes_.size(); }

  // A tile, decoded; nothing if it has no terrain. Throws Error naming the tile if it is damaged,
  // not the one in the index, or leaves its box.
  std::optional<DecodedTerrain> tile(uint32_t number) const;

 private:
  void read_header();
  void read_index();

  std::vector<uint8_t> bytes_;
  PackHeader header_{};
  Metadata metadata_;
  std::vector<PackEntry> entries_;
};

}  // namespace microtin

#endif
