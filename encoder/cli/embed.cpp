// SPDX-License-Identifier: MIT
// The command embed: a C header from a stream.
#include "encoder/stream/embed.hpp"

#include <filesystem>

#include "encoder/cli/commands.hpp"
#include "encoder/files/file_target.hpp"
#include "encoder/files/output_file.hpp"
#include "encoder/product/document.hpp"

namespace microtin::cli {

void run_embed(const std::string& input, const std::string& output) {
  refuse_overwriting({input}, output);
  const DecodedStream stream = read_stream(input);
  const std::string name =
      output == "-" ? "terrain" : std::filesystem::path(output).stem().string();
  OutputFile out(output);
  out.write(embed(stream.bytes, microtin_vertex_count(stream.terrain.mesh()), name));
  out.commit();
}

}  // namespace microtin::cli
