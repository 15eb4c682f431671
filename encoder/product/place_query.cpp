// SPDX-License-Identifier: MIT
// Answers by the exact surface, or by a device's pack that reads the same file.
#include "encoder/product/place_query.hpp"

#include <algorithm>

#include "encoder/base/error.hpp"
#include "encoder/files/input.hpp"
#include "encoder/pack/file.hpp"
#include "encoder/pack/shard.hpp"
#include "encoder/stream/header.hpp"

namespace microtin::product {
namespace {

constexpr uint32_t kSlots = 4;  // a place can lie in this many tiles at once

// Vertices of a slot to begin with, whatever the header says of the largest tile.
constexpr uint32_t kUsualCapacity = 1u << 14;

// A microtin_read whose `context` is a ByteSource.
int32_t read_source(void* context, uint64_t offset, uint8_t* buffer, size_t size) {
  try {
    return static_cast<int32_t>(
        static_cast<const ByteSource*>(context)->read(offset, buffer, size));
  } catch (const Error&) {
    return -1;
  }
}

// Throws unless the header was read.
void expect_header(microtin_status status) {
  if (status == MICROTIN_STATUS_CHECKSUM || status == MICROTIN_STATUS_MALFORMED ||
      status == MICROTIN_STATUS_TRUNCATED) {
    throw Damaged(describe(status));
  }
  if (status == MICROTIN_STATUS_UNSUPPORTED_VERSION || status == MICROTIN_STATUS_IO)
    throw Error(describe(status));
}

DecodedStream decoded(std::vector<uint8_t> bytes) {
  microtin_stream_info info;
  const microtin_status status = microtin_read_stream_info(bytes.data(), bytes.size(), &info);
  if (status == MICROTIN_STATUS_BAD_MAGIC || status == MICROTIN_STATUS_UNSUPPORTED_VERSION) {
    throw Error(describe(status));
  }
  try {
    DecodedTerrain terrain(bytes);
    return {std::move(bytes), std::move(terrain)};
  } catch (const Error& error) {
    throw Damaged(error.text());
  }
}

// A file's bytes; notes in `has_failed` that one could not be read.
class WatchedBytes : public ByteSource {
 public:
  WatchedBytes(std::unique_ptr<ByteSource> bytes, std::shared_ptr<bool> has_failed)
      : bytes_(std::move(bytes)), has_failed_(std::move(has_failed)) {}
  uint64_t size() const override { return bytes_->size(); }
  size_t read(uint64_t offset, void* to, size_t size) const override {
    try {
      return bytes_->read(offset, to, size);
    } catch (const Error&) {
      *has_failed_ = true;
      throw;
    }
  }

 private:
  std::unique_ptr<ByteSource> bytes_;
  std::shared_ptr<bool> has_failed_;
};

uint32_t parts_of(Decimal value) {
  return static_cast<uint32_t>(power_of_ten(value.decimals));
}

}  // namespace

void AskedPack::lay_out(uint32_t slots, uint32_t capacity) {
  space_.assign((MICROTIN_PACK_BYTES(uint64_t{slots}, uint64_t{capacity}) + 7) / 8, 0);
  microtin_pack_init(space_.data(), space_.size() * 8, slots, capacity, &pack_);
  capacity_ = capacity;
}

microtin_status AskedPack::serve(int64_t x, int64_t y) {
  const microtin_segment segment = {x, y, x, y};
  return microtin_pack_load_with(pack_, &segment, read_source, bytes_.get(), 0);
}

AskedPack::AskedPack(std::unique_ptr<ByteSource> bytes) : bytes_(std::move(bytes)) {
  lay_out(1, 3);
  const microtin_status status = serve(-1, -1);  // outside: the header alone is read
  if (microtin_pack_get_info(pack_, &info_) != MICROTIN_STATUS_OK) expect_header(status);
  lay_out(kSlots, std::clamp(info_.max_tile_vertices, 3u, kUsualCapacity));
}

// The vertices of the largest tile that was refused because it was too big, as its stream states.
// A tile whose header cannot be read stays a bad one.
uint32_t AskedPack::wanted_capacity(const PackFile& file) const {
  uint32_t most = 0, tile = 0, why = 0;
  for (uint32_t i = 0; i < MICROTIN_PACK_MAX_BAD_TILES; ++i) {
    if (microtin_pack_bad_tile(pack_, i, &tile, &why) != MICROTIN_STATUS_OK ||
        why != MICROTIN_STATUS_TOO_BIG) {
      continue;
    }
    try {
      most = std::max(most, file.vertices(tile));
    } catch (const Error&) {
    }
  }
  return most;
}

microtin_query_result AskedPack::height_at(int64_t x, int64_t y, const PackFile& file,
                                           int32_t* height) {
  microtin_status status = serve(x, y);
  while (status == MICROTIN_STATUS_BAD_TILES) {
    const uint32_t capacity = wanted_capacity(file);
    if (capacity <= capacity_) break;
    lay_out(kSlots, capacity);
    status = serve(x, y);
  }
  if (status == MICROTIN_STATUS_IO) throw Error(describe(MICROTIN_STATUS_IO));
  return microtin_pack_height_at(pack_, x, y, &hint_, height);
}

PlaceQuery::Pack PlaceQuery::opened_pack(const std::string& path) {
  AskedPack device(open_file(path));
  const auto has_failed = std::make_shared<bool>(false);
  try {
    auto file = std::make_unique<PackFile>(
        std::make_unique<WatchedBytes>(open_file(path), has_failed), PackFile::Index::kLater);
    return {std::move(device), std::move(file), has_failed};
  } catch (const Error& error) {
    if (*has_failed) throw;
    throw Damaged(error.text());  // in what a device does not look at
  }
}

std::variant<DecodedStream, PlaceQuery::Pack> PlaceQuery::opened(const std::string& path) {
  std::unique_ptr<ByteSource> source;
  if (is_regular_file(path)) source = open_file(path);
  if (source) refuse_shard(path, *source);
  const bool pack = source && is_pack(*source);
  const std::string text = pack ? std::string() : read_file(path);
  try {
    if (pack) return opened_pack(path);
    return decoded(std::vector<uint8_t>(text.begin(), text.end()));
  } catch (const Damaged& damaged) {
    throw Damaged(path + ": " + damaged.text());
  } catch (const Error& error) {
    throw Error(path + ": " + error.text());
  }
}

PlaceQuery::PlaceQuery(const std::string& path) : content_(opened(path)) {
  const auto* const pack = std::get_if<Pack>(&content_);
  surface_ = pack != nullptr ? sampled(*pack->file, BadTiles::kAnswer)
                             : sampled(std::get<DecodedStream>(content_).terrain.mesh());
  const Metadata notes = pack != nullptr
                             ? pack->file->metadata()
                             : read_header(std::get<DecodedStream>(content_).bytes).metadata;
  horizontal_ = notes.horizontal_unit;
  vertical_ = notes.vertical_unit;
  surface_.is_degrees = horizontal_ == Unit::kDegree;
}

std::vector<Axis> PlaceQuery::names_of_x(bool on_lattice) const {
  if (on_lattice) return {Axis{0, 1, 1}};
  return exact::names_of_x(surface_.placement.x, surface_.is_degrees);
}

Placement PlaceQuery::placement() const {
  return surface_.placement;
}

ExactAnswer PlaceQuery::height_at(Decimal x, Decimal y, bool on_lattice) {
  const auto row = coordinate_of(y, on_lattice ? Axis{0, 1, 1} : surface_.placement.y);
  ExactAnswer answer{MICROTIN_QUERY_OUTSIDE, {0, 0, 1}};
  for (const Axis& name : names_of_x(on_lattice)) {
    const auto column = coordinate_of(x, name);
    if (!column || !row || answer.kind != MICROTIN_QUERY_OUTSIDE) continue;
    answer = surface_.height_at(place_of(*column, *row));
  }
  expect_read();
  return answer;
}

encoder::Profile PlaceQuery::profile(Position from, Position to) {
  encoder::Profile profile = profile_of(surface_, horizontal_, vertical_, from, to);
  expect_read();
  return profile;
}

void PlaceQuery::expect_read() const {
  const auto* const pack = std::get_if<Pack>(&content_);
  if (pack != nullptr && *pack->has_failed) throw Error(describe(MICROTIN_STATUS_IO));
}

ExactAnswer PlaceQuery::device_height_at(Decimal x, Decimal y, bool on_lattice) {
  Placement place = on_lattice ? Placement() : placement();
  int32_t height = 0;
  microtin_query_result kind = MICROTIN_QUERY_OUTSIDE;
  for (const Axis& name : names_of_x(on_lattice)) {
    if (kind != MICROTIN_QUERY_OUTSIDE) break;
    place.x = name;
    kind = std::holds_alternative<Pack>(content_) ? pack_height_at(place, x, y, &height)
                                                  : stream_height_at(place, x, y, &height);
  }
  expect_read();
  return {kind, height_of_answer(height)};
}

microtin_query_result PlaceQuery::stream_height_at(const Placement& place, Decimal x, Decimal y,
                                                   int32_t* height) {
  int32_t column = 0, row = 0;
  if (microtin_axis_to_lattice(&place.x, x.mantissa, parts_of(x), &column) != MICROTIN_STATUS_OK ||
      microtin_axis_to_lattice(&place.y, y.mantissa, parts_of(y), &row) != MICROTIN_STATUS_OK) {
    return MICROTIN_QUERY_OUTSIDE;
  }
  return microtin_mesh_height_at(std::get<DecodedStream>(content_).terrain.mesh(), column, row,
                                 &hint_, height, 0, 0);
}

microtin_query_result PlaceQuery::pack_height_at(const Placement& place, Decimal x, Decimal y,
                                                 int32_t* height) {
  Pack& pack = std::get<Pack>(content_);
  const microtin_pack_info& info = pack.device.info();
  int64_t column = 0, row = 0;
  if (microtin_pack_axis_to_lattice(&place.x, info.x_max, x.mantissa, parts_of(x), &column) !=
          MICROTIN_STATUS_OK ||
      microtin_pack_axis_to_lattice(&place.y, info.y_max, y.mantissa, parts_of(y), &row) !=
          MICROTIN_STATUS_OK) {
    return MICROTIN_QUERY_OUTSIDE;
  }
  return pack.device.height_at(column, row, *pack.file, height);
}

}  // namespace microtin::product
