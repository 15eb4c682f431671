// SPDX-License-Identifier: MIT
// Writes shards, checks that they belong together, and joins them.
#include "encoder/pack/shard.hpp"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <system_error>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/files/file_access.hpp"
#include "encoder/stream/header.hpp"
#include "encoder/verify/everywhere.hpp"

namespace microtin::pack {
namespace {

namespace fs = std::filesystem;

using Bytes = std::vector<uint8_t>;

constexpr uint8_t kShardMagic[5] = {'m', 't', 's', 'h', 5};  // and version
constexpr std::size_t kStartBytes = sizeof kShardMagic + 4, kRangeBytes = 8;
constexpr uint32_t kMostHeadBytes = 1 << 17;
constexpr uint32_t kNotMade = 0xFFFFFFFF;  // a tile without terrain
constexpr std::size_t kSummaryBytes =
    4 + 4 + 4 + 2 + 2 + 4 + 4 + 4 * 8 + 5 * 9 + 5 + 1 + 2 * 8 + 3 * 9;  // without the check

// What the tiles of a pack depend on.
Bytes write_identity(const PackPlan& plan, const PackContent& pack) {
  const PackOptions& options = plan.options;
  Bytes identity = write_pack_header(pack);
  append_number(identity, options.max_vertices, 4);
  append_number(identity, options.max_vertices_wide, 4);
  append_number(identity, static_cast<uint64_t>(options.simplify.search), 1);
  append_number(identity, options.simplify.effort.degree, 1);
  append_number(identity, static_cast<uint64_t>(options.simplify.effort.coding), 1);
  append_number(identity, options.lattice.never_below ? 1 : 0, 1);
  append_number(identity, is_bound_everywhere(options.lattice) ? 1 : 0, 1);
  append_number(identity, plan.fingerprint, 8);
  if (plan.tiled.lines != nullptr) append_number(identity, plan.tiled.lines->fingerprint(), 8);
  return identity;
}

void append_decimal(Bytes& bytes, Decimal value) {
  append_number(bytes, static_cast<uint64_t>(value.mantissa), 8);
  append_number(bytes, static_cast<uint64_t>(value.decimals), 1);
}

Bytes write_summary(const TileSummary& tile) {
  const Verification& v = tile.measured;
  Bytes bytes;
  append_number(bytes, tile.bytes, 4);
  append_number(bytes, tile.stream_hash, 4);
  append_number(bytes, tile.vertices, 4);
  append_number(bytes, static_cast<uint16_t>(tile.lowest), 2);
  append_number(bytes, static_cast<uint16_t>(tile.highest), 2);
  append_number(bytes, tile.below, 4);
  append_number(bytes, tile.above, 4);
  for (const uint64_t count : {v.posts, v.covered, v.voids, uint64_t{v.within_bound}}) {
    append_number(bytes, count, 8);
  }
  for (const Decimal error : {v.max_error, v.max_below, v.max_above, v.rms_error, v.mean_error}) {
    append_decimal(bytes, error);
  }
  append_number(bytes, tile.compact ? tile.compact->repeats : kNotMade, 4);
  append_number(bytes, tile.compact && tile.compact->is_narrow ? 1 : 0, 1);
  const BoundSpan bounds = v.bounds.value_or(BoundSpan{});
  append_number(bytes, v.bounds ? 1 : 0, 1);
  append_number(bytes, bounds.bounded, 8);
  append_number(bytes, bounds.unbounded, 8);
  for (const Decimal bound : {bounds.least, bounds.largest, bounds.ratio}) {
    append_decimal(bytes, bound);
  }
  append_check(bytes, 0);
  return bytes;
}

[[noreturn]] void fail_to_write(const std::string& path) {
  throw Error(path + ": cannot be written: " + std::generic_category().message(errno));
}

void require(bool legal) {
  if (!legal) throw Error(describe(MICROTIN_STATUS_MALFORMED));
}

// Numbers one after the other, low bytes first.
class NumberReader {
 public:
  explicit NumberReader(const Bytes& bytes) : at_(bytes.data()) {}

  uint64_t next(int width) {
    uint64_t value = 0;
    for (int i = 0; i < width; ++i) value |= static_cast<uint64_t>(*at_++) << 8 * i;
    return value;
  }
  uint32_t next32() { return static_cast<uint32_t>(next(4)); }
  uint32_t next_margin() {
    const uint32_t margin = next32();
    require(margin <= kMarginMost || margin == kNotStated);
    return margin;
  }
  int16_t next_height() { return static_cast<int16_t>(static_cast<uint16_t>(next(2))); }
  Decimal next_decimal() {
    const auto mantissa = static_cast<int64_t>(next(8));
    const auto decimals = static_cast<int>(next(1));
    require(decimals <= kMaxDecimals);
    return {mantissa, decimals};
  }
  Decimal next_error() {
    const Decimal error = next_decimal();
    require(error.mantissa >= 0);
    return error;
  }

 private:
  const uint8_t* at_;
};

// What a tile can have: no more posts than the lattice has places, and no error above the largest.
bool is_possible(const Verification& v) {
  constexpr uint64_t kMostPosts = uint64_t{kLatticeMax + 1} * (kLatticeMax + 1);
  const Decimal mean = v.mean_error;
  return v.posts <= kMostPosts && v.voids <= kMostPosts - v.posts && v.covered <= v.posts &&
         v.max_below <= v.max_error && v.max_above <= v.max_error && v.rms_error <= v.max_error &&
         mean.mantissa > INT64_MIN && mean <= v.max_error &&
         Decimal{-mean.mantissa, mean.decimals} <= v.max_error;
}

TileSummary read_summary(const Bytes& bytes) {
  NumberReader reader(bytes);
  TileSummary tile;
  Verification& v = tile.measured;
  tile.bytes = reader.next32();
  tile.stream_hash = reader.next32();
  tile.vertices = reader.next32();
  tile.lowest = reader.next_height();
  tile.highest = reader.next_height();
  tile.below = reader.next_margin();
  tile.above = reader.next_margin();
  v.posts = reader.next(8);
  v.covered = reader.next(8);
  v.voids = reader.next(8);
  v.within_bound = reader.next(8) != 0;
  v.max_error = reader.next_error();
  v.max_below = reader.next_error();
  v.max_above = reader.next_error();
  v.rms_error = reader.next_error();
  v.mean_error = reader.next_decimal();
  const uint32_t repeats = reader.next32();
  const bool is_narrow = reader.next(1) != 0;
  require(is_possible(v) && tile.vertices <= kMaxVertices &&
          (repeats <= kMaxVertices || repeats == kNotMade));
  const bool has_bounds = reader.next(1) != 0;
  const BoundSpan bounds{reader.next(8), reader.next(8), reader.next_error(), reader.next_error(),
                         reader.next_error()};
  if (has_bounds) v.bounds = bounds;
  if (repeats != kNotMade) tile.compact = CompactForm{tile.vertices, repeats, is_narrow};
  return tile;
}

void expect_check(const Bytes& bytes) {
  const std::size_t size = bytes.size() - kCheckBytes;
  if (crc32(0, bytes.data(), size) != read_u32(bytes.data() + size)) {
    throw Error(describe(MICROTIN_STATUS_CHECKSUM));
  }
}

// A shard, of which tiles are read one after the other.
class Shard {
 public:
  explicit Shard(const std::string& path) : path_(path), bytes_(open_file(path)) {
    with_file_context(path_, [&] {
      const Bytes start = take(std::min<uint64_t>(kStartBytes, bytes_->size()));
      if (start.size() < kStartBytes ||
          !std::equal(kShardMagic, kShardMagic + sizeof kShardMagic, start.begin())) {
        throw Error("not a shard that this version of microtin made; encode it again");
      }
      const uint32_t size = read_u32(start.data() + sizeof kShardMagic);
      if (size < kPackFixedBytes || size > kMostHeadBytes)
        throw Error(describe(MICROTIN_STATUS_CHECKSUM));
      head_ = take(size + kCheckBytes);
      expect_check(head_);
      const Bytes range = take(kRangeBytes + kCheckBytes);
      expect_check(range);
      range_ = {read_u32(range.data()), read_u32(range.data() + 4)};
      require(range_.first <= range_.last);
    });
  }

  const std::string& path() const { return path_; }
  const Bytes& head() const { return head_; }
  TileRange range() const { return range_; }

  TileSummary next_summary() {
    return with_file_context(path_, [&] {
      const Bytes bytes = take(kSummaryBytes + kCheckBytes);
      expect_check(bytes);
      return read_summary(bytes);
    });
  }

  uint64_t offset() const { return offset_; }

  Bytes next_stream(const TileSummary& tile) {
    return with_file_context(path_, [&] {
      Bytes stream = take(tile.bytes);
      if (tile.bytes != 0 &&
          stream_hash(kStreamHash, stream.data(), stream.size()) != tile.stream_hash) {
        throw Error(describe(MICROTIN_STATUS_CHECKSUM));
      }
      return stream;
    });
  }

 private:
  Bytes take(uint64_t size) {
    Bytes bytes = bytes_at(*bytes_, offset_, size);
    offset_ += size;
    return bytes;
  }

  std::string path_;
  std::unique_ptr<ByteSource> bytes_;
  Bytes head_;
  TileRange range_{};
  uint64_t offset_ = 0;
};

// By their first tiles, after a look at whether they belong together.
std::vector<Shard> open_all(const std::vector<std::string>& paths) {
  std::vector<Shard> shards;
  for (const std::string& path : paths) {
    shards.emplace_back(path);
    if (shards.back().head() != shards.front().head()) {
      throw Error(path + ": is of another terrain, or made with other options, than " + paths[0]);
    }
  }
  std::sort(shards.begin(), shards.end(),
            [](const Shard& a, const Shard& b) { return a.range().first < b.range().first; });
  return shards;
}

void expect_all_tiles(const std::vector<Shard>& shards, const TileGrid& grid) {
  uint64_t next = 0;
  const auto fail_if_missing = [&](uint64_t end) {
    if (next >= end) return;
    const std::string first = std::to_string(next), last = std::to_string(end - 1);
    throw Error(next + 1 == end ? "tile " + first + " is in no shard; name its shard, too"
                                : "tiles " + first + " to " + last +
                                      " are in no shard; name their shards, too");
  };
  for (std::size_t i = 0; i < shards.size(); ++i) {
    const TileRange range = shards[i].range();
    fail_if_missing(range.first);
    if (range.first < next) {
      throw Error(shards[i].path() + ": tile " + std::to_string(range.first) + " is also in " +
                  shards[i - 1].path());
    }
    next = uint64_t{range.last} + 1;
  }
  fail_if_missing(tile_count(grid));
  require(next == tile_count(grid));
}

// The pack that a head announces.
PackContent read_content(const Bytes& head) {
  PackHeader header{};
  require(read_pack_header(head.data(), &header) == MICROTIN_STATUS_OK &&
          pack_index_start(header) <= head.size() && !has_too_many_tiles(header.grid));
  return {header.grid, read_placement_and_notes(header, head.data()), {}};
}

}  // namespace

void refuse_shard(const std::string& name, const ByteSource& bytes) {
  constexpr std::size_t kWithoutVersion = sizeof kShardMagic - 1;
  uint8_t magic[kWithoutVersion] = {};
  if (bytes.read(0, magic, sizeof magic) != sizeof magic ||
      !std::equal(magic, magic + kWithoutVersion, kShardMagic)) {
    return;
  }
  throw Error(name + ": is a shard, a part of a pack: join all shards with \"microtin merge\"");
}

namespace {

// What a shard begins with.
Bytes write_start(const PackPlan& plan, const PackContent& pack, TileRange range) {
  const Bytes identity = write_identity(plan, pack);
  Bytes start(kShardMagic, kShardMagic + sizeof kShardMagic);
  append_number(start, identity.size(), 4);
  start.insert(start.end(), identity.begin(), identity.end());
  append_check(start, kStartBytes);
  const std::size_t range_start = start.size();
  append_number(start, range.first, 4);
  append_number(start, range.last, 4);
  append_check(start, range_start);
  return start;
}

}  // namespace

ShardWriter::ShardWriter(const PackPlan& plan, const PackContent& pack, TileRange range,
                         OutputFile& out)
    : out_(out) {
  out_.write(write_start(plan, pack, range));
}

void ShardWriter::add(const EncodedTile& tile) {
  out_.write(write_summary(tile.summary));
  out_.write(tile.stream);
}

TileLog::TileLog(const std::string& path, const PackPlan& plan, const PackContent& pack,
                 TileRange range, const Take& take)
    : path_(path), next_(range.first), file_(nullptr, &std::fclose) {
  const Bytes start = write_start(plan, pack, range);
  const bool is_there = fs::exists(fs::u8path(path));
  const uint64_t whole = is_there ? read(start, range, take) : 0;
  if (is_there) fs::resize_file(fs::u8path(path), whole);
  file_.reset(open_stream(path, "ab"));
  if (file_ == nullptr) fail_to_write(path);
  if (whole == 0) write(start);
}

// Returns how many bytes hold whole tiles.
uint64_t TileLog::read(const Bytes& start, TileRange range, const Take& take) {
  const std::unique_ptr<ByteSource> bytes = open_file(path_);
  Bytes found(std::min<uint64_t>(start.size(), bytes->size()));
  found.resize(bytes->read(0, found.data(), found.size()));
  if (!std::equal(found.begin(), found.end(), start.begin())) {
    throw Error(path_ + ": holds tiles of another terrain, or made with other options; remove it");
  }
  if (found.size() < start.size()) return 0;
  uint64_t whole = start.size();
  try {
    Shard shard(path_);
    for (; next_ <= range.last; ++next_) {
      EncodedTile tile;
      tile.summary = shard.next_summary();
      tile.stream = shard.next_stream(tile.summary);
      whole = shard.offset();
      take(next_, std::move(tile));
    }
  } catch (const Error&) {  // what comes then was being written when the run ended
  }
  return whole;
}

void TileLog::write(const Bytes& bytes) {
  const bool is_written = std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) == bytes.size() &&
                          std::fflush(file_.get()) == 0;
  if (!is_written) fail_to_write(path_);
}

void TileLog::add(const EncodedTile& tile) {
  write(write_summary(tile.summary));
  write(tile.stream);
  ++next_;
}

void TileLog::remove() {
  file_.reset();
  std::error_code none;
  fs::remove(fs::u8path(path_), none);
}

std::optional<uint32_t> logged_tile_size(const std::string& path) {
  if (!fs::exists(fs::u8path(path))) return std::nullopt;
  try {
    const TileGrid grid = read_content(Shard(path).head()).grid;
    return std::max(grid.width, grid.height);
  } catch (const Error&) {  // not even its beginning is whole
    return std::nullopt;
  }
}

PackContent merge_shards(const std::vector<std::string>& paths, StreamSpool& streams) {
  std::vector<Shard> shards = open_all(paths);
  PackContent pack = with_file_context(paths[0], [&] { return read_content(shards[0].head()); });
  expect_all_tiles(shards, pack.grid);
  for (Shard& shard : shards) {
    for (uint64_t tile = shard.range().first; tile <= shard.range().last; ++tile) {
      TileSummary summary = shard.next_summary();
      summary.offset = streams.add(shard.next_stream(summary));
      pack.tiles.push_back(summary);
    }
  }
  return pack;
}

}  // namespace microtin::pack
