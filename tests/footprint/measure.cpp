// SPDX-License-Identifier: MIT
// Measures what decoding the linked stream and asking for heights takes: prints a line "name value"
// for each number, all in instructions if not said otherwise.
#include "microtin/microtin.hpp"
#include "tests/firmware/linked_stream.hpp"
#include "tests/firmware/report.hpp"
#include "tests/footprint/statistics.hpp"
#include "toolchains/counter.hpp"
#include "toolchains/firmware.h"

namespace {

using TerrainOfTile = microtin::Terrain<MICROTIN_MAX_VERTICES>;

constexpr uint32_t kSide = 45;  // sqrt(2,000)
constexpr uint32_t kQueries = 2048, kSegments = 256;

void say(const char* name, uint32_t value) {
  microtin::print(put_char, name);
  microtin::print(put_char, " ");
  microtin::print(put_char, value);
  microtin::print(put_char, "\n");
}

// Instructions between two readings of the counter with nothing between.
uint32_t overhead() {
  const uint32_t before = instruction_count();
  return instruction_count() - before;
}

// Decodes in pieces of one step: the most expensive of them.
uint32_t dearest_step(TerrainOfTile& terrain) {
  static microtin::Decoder<MICROTIN_MAX_VERTICES> decoder(terrain);
  Statistics steps;
  size_t at = 0;
  microtin_status status = MICROTIN_STATUS_STEP_LIMIT;
  while (status == MICROTIN_STATUS_STEP_LIMIT) {
    size_t used = 0;
    const uint32_t before = instruction_count();
    status = decoder.feed(stream_begin + at, stream_size() - at, &used, 1);
    steps.add(instruction_count() - before);
    at += used;
  }
  return steps.most() - overhead();
}

enum class Start { kZero, kLast, kFound };

// Heights along a path of `kQueries` places. `finder` tells hints.
template <class Path, class Form, class Finder>
Statistics ask(const Form& terrain, const Finder& finder, Start start, Path& path) {
  Statistics queries;
  const uint32_t nothing = overhead();
  uint32_t hint = 0;
  int32_t height = 0;
  typename Path::Place p = path.next();
  terrain.height_at(p.x, p.y, &hint, &height);  // arrives where the path starts
  for (uint32_t i = 0; i < kQueries; ++i) {
    p = path.next();
    const uint32_t before = instruction_count();
    if (start == Start::kZero) hint = 0;
    if (start == Start::kFound) hint = finder.hint(p.x, p.y);
    terrain.height_at(p.x, p.y, &hint, &height);
    queries.add(instruction_count() - before - nothing);
  }
  return queries;
}

struct FinePlace {
  int32_t x, y;
};

// Bytes of RAM of an object.
template <class Object>
void say_ram(const char* kind, uint32_t capacity) {
  microtin::print(put_char, "ram_");
  microtin::print(put_char, kind);
  microtin::print(put_char, "_");
  microtin::print(put_char, capacity);
  say("", sizeof(Object));
}

// Prints the sizes of the objects for `Capacity` vertices.
template <uint32_t Capacity>
void say_ram() {
  say_ram<microtin::Terrain<Capacity>>("terrain", Capacity);
  say_ram<microtin::Decoder<Capacity>>("decoder", Capacity);
  say_ram<microtin::CompactTerrain<Capacity>>("compact", Capacity);
  say_ram<microtin::CompactTerrain<Capacity, true>>("narrow", Capacity);
}

// Anywhere in the box.
class Anywhere {
 public:
  using Place = FinePlace;
  explicit Anywhere(const microtin::ProbeBox& box) : box_(box) {}
  Place next() {
    const int32_t x = numbers_.between(box_.west, box_.east);
    return {x, numbers_.between(box_.south, box_.north)};
  }

 private:
  microtin::ProbeBox box_;
  microtin::ProbeNumbers numbers_;
};

// From the south-west to the north-east.
class Straight {
 public:
  using Place = FinePlace;
  explicit Straight(const microtin::ProbeBox& box) : box_(box) {}
  Place next() {
    const int32_t i = i_++, n = static_cast<int32_t>(kQueries);
    return {box_.west + (box_.east - box_.west) / n * i,
            box_.south + (box_.north - box_.south) / n * i};
  }

 private:
  microtin::ProbeBox box_;
  int32_t i_ = 0;
};

template <class Path, class Form, class Finder>
void measure_heights(const char* mean, const char* most, const microtin::ProbeBox& box,
                     const Form& terrain, const Finder& finder, Start start) {
  Path path(box);
  const Statistics queries = ask(terrain, finder, start, path);
  say(mean, queries.mean());
  say(most, queries.most());
}

// A query along a segment, of a mesh and of a compact terrain.
microtin_query_result extremes(const microtin_mesh* mesh, const microtin_segment& segment,
                               microtin_segment_state* state, uint32_t step_limit) {
  microtin_segment_extremes found;
  return microtin_mesh_segment_extremes(mesh, &segment, state, &found, step_limit);
}
microtin_query_result extremes(const microtin_compact* terrain, const microtin_segment& segment,
                               microtin_segment_state* state, uint32_t step_limit) {
  microtin_segment_extremes found;
  return microtin_compact_segment_extremes(terrain, &segment, state, &found, step_limit);
}

// Steps behind the search for the begin.
template <class Form>
uint32_t steps_of(const Form* terrain, const microtin_segment& segment) {
  microtin_segment_state state = {};
  uint32_t steps = 0;
  while (extremes(terrain, segment, &state, 1) == MICROTIN_QUERY_STEP_LIMIT) {
    if (state.stage != 0) ++steps;
  }
  return steps;
}

// Segments between any two places of the box, from the triangle where each begins.
template <class Form>
void measure_segments(const char* const* names, const microtin::ProbeBox& box,
                      const Form* terrain) {
  Statistics segments, steps;
  Anywhere places(box);
  const uint32_t nothing = overhead();
  for (uint32_t i = 0; i < kSegments; ++i) {
    const FinePlace begin = places.next(), end = places.next();
    const microtin_segment here = {begin.x, begin.y, begin.x, begin.y},
                           segment = {begin.x, begin.y, end.x, end.y};
    microtin_segment_state found = {}, state = {};
    extremes(terrain, here, &found, 0);
    state.triangle = found.triangle;
    const uint32_t before = instruction_count();
    extremes(terrain, segment, &state, 0);
    segments.add(instruction_count() - before - nothing);
    steps.add(steps_of(terrain, segment));
  }
  say(names[0], segments.mean());
  say(names[1], segments.most());
  say(names[2], segments.sum() / steps.sum());
}

constexpr const char* kSegmentNames[] = {"segment_mean", "segment_worst", "segment_step"};
constexpr const char* kCompactSegmentNames[] = {"compact_segment_mean", "compact_segment_worst",
                                                "compact_segment_step"};

// The terrain made compact, in pieces of this many steps; the most expensive of them.
microtin_compact* compact;

uint32_t make_compact(TerrainOfTile& terrain, uint32_t piece) {
  alignas(
      MICROTIN_ALIGNMENT) static unsigned char space[MICROTIN_COMPACT_BYTES(MICROTIN_MAX_VERTICES)],
      scratch[MICROTIN_COMPACTOR_BYTES(MICROTIN_MAX_VERTICES)];
  microtin_compactor* compactor = nullptr;
  microtin_compactor_init(space, sizeof space, terrain.mesh(), scratch, sizeof scratch, &compactor);
  Statistics pieces;
  microtin_status status = MICROTIN_STATUS_STEP_LIMIT;
  while (status == MICROTIN_STATUS_STEP_LIMIT) {
    const uint32_t before = instruction_count();
    status = microtin_compactor_run(compactor, &compact, piece);
    pieces.add(instruction_count() - before);
  }
  return pieces.most() - overhead();
}

// Asked as terrains and buckets are.
struct CompactFace {
  uint32_t hint(int32_t x, int32_t y) const { return microtin_compact_hint(compact, x, y); }
  void height_at(int32_t x, int32_t y, uint32_t* hint, int32_t* height) const {
    microtin_compact_height_at(compact, x, y, hint, height, 0);
  }
};

}  // namespace

int firmware_main() {
  say_ram<250>();
  say_ram<1000>();
  say_ram<10000>();

  static TerrainOfTile terrain;
  say("worst_step", dearest_step(terrain));
  say("compact_worst_step", make_compact(terrain, 1));

  const uint32_t before = instruction_count();
  static microtin::Decoder<MICROTIN_MAX_VERTICES> decoder(terrain);
  size_t used = 0;
  const microtin_status status = decoder.feed(stream_begin, stream_size(), &used);
  const uint32_t decoding = instruction_count() - before - overhead();
  if (status != MICROTIN_STATUS_OK) return 1;
  const uint32_t vertices = terrain.vertices();
  say("decode_per_vertex", decoding / vertices);

  static microtin::Buckets<kSide> buckets;
  const uint32_t unbuilt = instruction_count();
  buckets.build(terrain.mesh());
  say("buckets_build", instruction_count() - unbuilt - overhead());

  const microtin::ProbeBox box = microtin::probe_box(terrain.mesh());
  measure_heights<Straight>("warm_mean", "warm_worst", box, terrain, buckets, Start::kLast);
  measure_heights<Anywhere>("cold_mean", "cold_worst", box, terrain, buckets, Start::kZero);
  measure_heights<Anywhere>("far_mean", "far_worst", box, terrain, buckets, Start::kLast);
  measure_heights<Anywhere>("buckets_mean", "buckets_worst", box, terrain, buckets, Start::kFound);

  measure_segments(kSegmentNames, box, static_cast<const microtin_mesh*>(terrain.mesh()));

  say("compact_make", make_compact(terrain, 0) / vertices);
  say("compact_bytes", static_cast<uint32_t>(microtin_compact_size(compact)));
  const CompactFace face;
  measure_heights<Straight>("compact_warm_mean", "compact_warm_worst", box, face, face,
                            Start::kLast);
  measure_heights<Anywhere>("compact_far_mean", "compact_far_worst", box, face, face, Start::kLast);
  measure_heights<Anywhere>("compact_found_mean", "compact_found_worst", box, face, face,
                            Start::kFound);
  measure_segments(kCompactSegmentNames, box, static_cast<const microtin_compact*>(compact));
  return 0;
}
