#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>

#include "encoder/error.hpp"
#include "encoder/header.hpp"
#include "microtin/microtin.h"
#include "tests/bench/peers.hpp"
#include "tests/bench/speed.hpp"
#include "tests/bench/table.hpp"

namespace microtin::bench {
namespace {

Bytes read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(path + ": cannot be opened");
  return Bytes(std::istreambuf_iterator<char>(file), {});
}

// Our decoder, with its fixed arrays.
class Ours {
 public:
  explicit Ours(const Bytes& stream) : stream_(stream) {
    const microtin_info info = read_header(stream).info;
    mesh_.resize((info.mesh_bytes + 7) / 8);
    decoder_.resize((info.decoder_bytes + 7) / 8);
  }

  void decode() {
    microtin_mesh* mesh = nullptr;
    microtin_decoder* decoder = nullptr;
    microtin_mesh_init(mesh_.data(), mesh_.size() * 8, &mesh);
    microtin_decoder_init(decoder_.data(), decoder_.size() * 8, mesh, &decoder);
    size_t used = 0;
    microtin_feed(decoder, stream_.data(), stream_.size(), 0, &used);
    if (microtin_finish(decoder) != MICROTIN_DONE) throw Error("a stream does not decode");
  }

 private:
  const Bytes& stream_;
  std::vector<uint64_t> mesh_, decoder_;
};

void expect_triangles(size_t count) {
  if (count == 0) throw Error("a peer found no triangle");
}

// What is measured, in the order of column_names.
std::vector<Work> works_for(const Bytes& stream) {
  const auto ours = std::make_shared<Ours>(stream);
  const auto surface = std::make_shared<Surface>(surface_of(stream));
  const std::optional<Triangulator> delaunay = triangulator();
  std::vector<Work> works = {[ours] { ours->decode(); }};
  for (const Codec& codec : fast_codecs()) {
    const Bytes bytes = checked_encode(codec, *surface);
    works.push_back([codec, bytes] { codec.decode(bytes); });
    if (codec.sends_triangles || !delaunay) continue;
    works.push_back([codec, bytes, delaunay] {
      expect_triangles(delaunay->count_triangles(codec.decode(bytes).vertices));
    });
  }
  if (delaunay) {
    works.push_back(
        [surface, delaunay] { expect_triangles(delaunay->count_triangles(surface->vertices)); });
  }
  return works;
}

Row column_names() {
  Row names{"microtin"};
  const std::optional<Triangulator> delaunay = triangulator();
  for (const Codec& codec : fast_codecs()) {
    names.push_back(codec.name);
    if (!codec.sends_triangles && delaunay) names.push_back(codec.name + " + " + delaunay->name);
  }
  if (delaunay) names.push_back(delaunay->name + " alone");
  return names;
}

}  // namespace

void print_decode_speed(const std::vector<std::string>& paths, const Measure& measure,
                        const std::string& unit) {
  Row head{"stream", "vertices"};
  for (const std::string& name : column_names()) head.push_back(name);
  print_head(("Decoding, " + unit + " per vertex").c_str(), head);
  for (const std::string& path : paths) {
    const Bytes stream = read(path);
    const uint32_t vertices = read_header(stream).info.vertices;
    Row row{std::filesystem::path(path).stem().string(), number(size_t{vertices})};
    for (const double cost : measure(works_for(stream))) row.push_back(number(cost / vertices, 0));
    print_row(row);
  }
}

}  // namespace microtin::bench
