// The command embed: a C header from a stream.
#include "encoder/stream/embed.hpp"

#include <filesystem>

#include "encoder/base/error_context.hpp"
#include "encoder/cli/commands.hpp"
#include "encoder/cli/report.hpp"
#include "encoder/files/file_target.hpp"
#include "encoder/files/output_file.hpp"

namespace microtin::cli {

void run_embed(const std::string& input, const std::string& output) {
  refuse_overwriting({input}, output);
  const std::vector<uint8_t> stream = read_stream(input);
  const DecodedTerrain terrain = with_file_context(input, [&] { return DecodedTerrain(stream); });
  const std::string name =
      output == "-" ? "terrain" : std::filesystem::path(output).stem().string();
  OutputFile out(output);
  out.write(embed(stream, microtin_vertex_count(terrain.mesh()), name));
  out.commit();
}

}  // namespace microtin::cli
