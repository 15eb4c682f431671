// SPDX-License-Identifier: MIT
// The command embed: a C header from a stream or a pack.
#include "encoder/stream/embed.hpp"

#include <filesystem>

#include "encoder/cli/commands.hpp"
#include "encoder/files/input.hpp"
#include "encoder/files/output.hpp"
#include "encoder/product/document.hpp"

namespace microtin::cli {
namespace {

std::string source_of(const Document& document, const std::string& name) {
  if (const DecodedStream* const stream = document.stream()) {
    return embed(stream->bytes, Embedded::kStream,
                 microtin_mesh_vertex_count(stream->terrain.mesh()), name);
  }
  const std::string bytes = read_file(document.path());
  return embed({bytes.begin(), bytes.end()}, Embedded::kPack,
               document.pack()->header().most_vertices, name);
}

}  // namespace

void run_embed(const std::string& input, const std::string& output) {
  refuse_overwriting({input}, output);
  const Document document(input);
  const std::string name =
      output == "-" ? "terrain" : std::filesystem::u8path(output).stem().string();
  OutputFile out(output);
  out.write(source_of(document, name));
  out.commit();
}

}  // namespace microtin::cli
