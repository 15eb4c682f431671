// SPDX-License-Identifier: MIT
// What decoding a stream costs, compared with other programs.
#include <filesystem>
#include <memory>

#include "encoder/base/error.hpp"
#include "encoder/files/input.hpp"
#include "encoder/stream/header.hpp"
#include "microtin/microtin.h"
#include "tests/bench/layers.hpp"
#include "tests/bench/peers/peers.hpp"
#include "tests/bench/speed.hpp"
#include "tests/bench/table.hpp"

namespace microtin::bench {
namespace {

// Our decoder, with its fixed arrays.
class Ours {
 public:
  explicit Ours(const Bytes& stream) : stream_(stream) {
    const microtin_stream_info info = read_header(stream).info;
    mesh_.resize((info.mesh_bytes + 7) / 8);
    decoder_.resize((info.decoder_bytes + 7) / 8);
  }

  void decode() {
    microtin_mesh* mesh = nullptr;
    microtin_decoder* decoder = nullptr;
    microtin_mesh_init(mesh_.data(), mesh_.size() * 8, &mesh);
    microtin_decoder_init(decoder_.data(), decoder_.size() * 8, mesh, &decoder);
    size_t used = 0;
    microtin_decoder_feed(decoder, stream_.data(), stream_.size(), &used, 0);
    if (microtin_decoder_finish(decoder) != MICROTIN_STATUS_OK)
      throw Error("a stream does not decode");
  }

 private:
  Bytes stream_;
  std::vector<uint64_t> mesh_, decoder_;
};

struct Contender {
  std::string name;
  Work work;
};

std::vector<Contender> contenders(const Bytes& stream) {
  const auto ours = std::make_shared<Ours>(stream);
  const auto surface = std::make_shared<Surface>(surface_of(stream));
  const std::optional<Triangulator> peer = triangulator();
  const auto triangulate = [peer](const std::vector<Vertex>& vertices) {
    if (peer->count_triangles(vertices) == 0) throw Error(peer->name + " found no triangle");
  };
  std::vector<Contender> all = {{"microtin", [ours] { ours->decode(); }}};
  for (const Codec& codec : fast_codecs()) {
    const Bytes bytes = checked_encode(codec, *surface);
    all.push_back({codec.name, [codec, bytes] { codec.decode_and_drop(bytes); }});
    if (codec.sends_triangles || !peer) continue;
    all.push_back({codec.name + " + " + peer->name,
                   [codec, bytes, triangulate] { triangulate(codec.decode(bytes).vertices); }});
  }
  if (peer) {
    all.push_back(
        {peer->name + " alone", [surface, triangulate] { triangulate(surface->vertices); }});
  }
  return all;
}

void print_names(const std::vector<Contender>& contenders, const std::string& unit) {
  Row head{"stream", "vertices"};
  for (const Contender& contender : contenders) head.push_back(contender.name);
  print_head("Decoding, " + unit + " per vertex", head);
}

}  // namespace

void print_decode_speed(const std::vector<std::string>& paths, const Measure& measure,
                        const std::string& unit) {
  for (const std::string& path : paths) {
    const std::string file = read_file(path);
    const Bytes stream(file.begin(), file.end());
    const uint32_t vertices = read_header(stream).info.vertices;
    const std::vector<Contender> all = contenders(stream);
    if (path == paths.front()) print_names(all, unit);
    std::vector<Work> works;
    works.reserve(all.size());
    for (const Contender& contender : all) works.push_back(contender.work);
    Row row{std::filesystem::path(path).stem().string(), number(size_t{vertices})};
    for (const double cost : measure(works)) row.push_back(number(cost / vertices, 0));
    print_row(row);
  }
}

}  // namespace microtin::bench
