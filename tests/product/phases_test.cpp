// SPDX-License-Identifier: MIT
// The digest and the phases that a header states: true by a decoder that sees less of the stream,
// by every door, and compared by verify and check.
#include "encoder/product/phases.hpp"

#include <doctest/doctest.h>

#include "encoder/stream/header.hpp"
#include "microtin/encoder.h"
#include "microtin/encoder.hpp"
#include "microtin/surface.hpp"
#include "tests/support/device.hpp"
#include "tests/support/files.hpp"
#include "tests/support/session.hpp"

using namespace microtin::tests;
namespace library = microtin::encoder;

namespace {

// 120 x 110 posts, with all of them as vertices: several sections.
std::string grid() {
  std::string text = "ncols 120\nnrows 110\nxllcenter 0\nyllcenter 0\ncellsize 1\n";
  for (int row = 0; row < 110; ++row) {
    for (int column = 0; column < 120; ++column) {
      text +=
          std::to_string((column * column * 37 + row * row * 61 + column * row * 17) % 89) + ' ';
    }
    text += '\n';
  }
  return text;
}

struct Encoded {
  Encoded() {
    session.write("t.asc", grid());
    const Session::Result result =
        session.run("encode t.asc --units metre --max-degree 6 --digest --phases -o t.mtin");
    REQUIRE_MESSAGE(result.code == 0, result.err);
    bytes = bytes_of_file(session.folder() + "/t.mtin");
    header = read_header(bytes);
  }

  // Writes the stream with other notes.
  void write(const Metadata& metadata) const {
    write_file(session.folder() + "/t.mtin", with_metadata(bytes, metadata));
  }

  Session session;
  std::vector<uint8_t> bytes;
  Header header;
};

}  // namespace

TEST_CASE("phases: a decoder has the stated vertices after the stated bytes") {
  const Encoded encoded;
  const std::vector<PhaseEnd>& phases = encoded.header.metadata.phases;
  REQUIRE(phases.size() > 2);
  const uint32_t head = encoded.header.info.header_bytes;
  for (const PhaseEnd& end : phases) {
    for (const bool is_short : {false, true}) {
      const Device device(encoded.header.info.vertices);
      size_t used = 0;
      const size_t size = head + static_cast<size_t>(end.bytes) - (is_short ? 1 : 0);
      microtin_decoder_feed(device.decoder, encoded.bytes.data(), size, &used, 0);
      uint32_t hint = 0;
      int32_t height = 0;
      const bool is_verified = microtin_mesh_height_at(device.mesh, 0, 0, &hint, &height, 0, 0) !=
                               MICROTIN_QUERY_UNVERIFIED;
      const bool is_reached =
          is_verified && microtin_mesh_vertex_count(device.mesh) == end.vertices;
      CHECK(is_reached == !is_short);
    }
  }
  CHECK(phases.back().vertices == encoded.header.info.vertices);
  CHECK(head + phases.back().bytes == encoded.bytes.size());
  CHECK(to_string(*phases.back().max_error) == "0");
  CHECK(phases.front().max_error->mantissa > 0);
}

TEST_CASE("phases: info, C++ and C return them, and the digest of the mesh") {
  const Encoded encoded;
  const std::string path = encoded.session.folder() + "/t.mtin";
  const std::vector<PhaseEnd>& phases = encoded.header.metadata.phases;
  const auto surface = library::Surface::from_file(path);
  microtin_surface* in_c = nullptr;
  REQUIRE(microtin_surface_from_file(path.c_str(), &in_c) == MICROTIN_STATUS_OK);
  microtin_surface_info info{};
  info.size = sizeof info;
  REQUIRE(microtin_surface_get_info(in_c, &info) == MICROTIN_STATUS_OK);
  REQUIRE(surface.info().phases.size() == phases.size());
  REQUIRE(info.phase_count == phases.size());
  const std::string text = encoded.session.run("info t.mtin").out,
                    json = encoded.session.run("info --json t.mtin").out;
  for (size_t i = 0; i < phases.size(); ++i) {
    const library::Phase& phase = surface.info().phases[i];
    CHECK(phase.vertices == phases[i].vertices);
    CHECK(phase.bytes == phases[i].bytes + encoded.header.info.header_bytes);
    CHECK(phase.max_error == to_string(*phases[i].max_error));
    CHECK(info.phases[i].vertices == phase.vertices);
    CHECK(info.phases[i].bytes == phase.bytes);
    CHECK(info.phases[i].max_error == phase.max_error);
    const std::string numbers =
        std::to_string(phase.vertices) + ", \"bytes\": " + std::to_string(phase.bytes);
    CHECK_MESSAGE(contains(json, "{\"vertices\": " + numbers), json);
    CHECK_MESSAGE(contains(text, std::to_string(phase.bytes) + "  "), text);
  }
  const Device device(encoded.header.info.vertices);
  REQUIRE(device.decode(encoded.bytes) == MICROTIN_STATUS_OK);
  char digits[17];
  std::snprintf(digits, sizeof digits, "%016llx",
                static_cast<unsigned long long>(microtin_mesh_digest(device.mesh)));
  CHECK(surface.info().digest == digits);
  CHECK(info.digest == std::string(digits));
  CHECK(contains(text, std::string("\ndigest: \"") + digits + "\"\n"));
  microtin_surface_free(in_c);
}

TEST_CASE("phases: verify and check compare what a header states with the stream") {
  const Encoded encoded;
  const std::string verify = "verify t.mtin t.asc --units metre";
  CHECK(encoded.session.run(verify).code == 0);
  CHECK(encoded.session.run("check t.mtin").code == 0);
  Metadata other = encoded.header.metadata;
  ++*other.digest;
  encoded.write(other);
  for (const std::string& command : {verify, std::string("check t.mtin")}) {
    CHECK(contains(encoded.session.failure(command),
                   "t.mtin: the digest in its header is not that of its mesh\n"));
  }
  other = encoded.header.metadata;
  ++other.phases[1].bytes;
  encoded.write(other);
  for (const std::string& command : {verify, std::string("check t.mtin")}) {
    CHECK(contains(encoded.session.failure(command), "t.mtin: phase 2 in the header has "));
  }
  other = encoded.header.metadata;
  other.phases.pop_back();
  encoded.write(other);
  CHECK(contains(encoded.session.failure("check t.mtin"), "t.mtin: its header states "));
  other = encoded.header.metadata;
  other.phases[0].max_error = Decimal{1, 1};
  encoded.write(other);
  CHECK(encoded.session.run("check t.mtin").code == 0);  // which has no source
  CHECK(contains(encoded.session.failure(verify), "t.mtin: phase 1 in the header is up to "));
}

TEST_CASE("phases: packs take neither digest nor phases, by any door") {
  const Session session;
  session.write("t.asc", grid());
  for (const std::string option : {"digest", "phases"}) {
    CHECK(session.failure("encode t.asc --units metre --" + option + " -o t.mtp") ==
          "t.asc: --" + option + " is an option of streams; leave it out\n");
    CHECK(contains(session.failure("plan t.asc --units metre --shards 2 --" + option),
                   "--" + option + " is an option of streams"));
  }
}
