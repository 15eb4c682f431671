#include <filesystem>

#include "encoder/cli_commands.hpp"
#include "encoder/cli_report.hpp"
#include "encoder/embed.hpp"
#include "encoder/error_context.hpp"
#include "encoder/file_target.hpp"
#include "encoder/output_file.hpp"

namespace microtin {

void run_embed(const std::string& input, const std::string& output) {
  refuse_overwriting({input}, output);
  const std::vector<uint8_t> stream = read_stream(input);
  const DecodedTerrain terrain = about(input, [&] { return DecodedTerrain(stream); });
  const std::string name =
      output == "-" ? "terrain" : std::filesystem::path(output).stem().string();
  OutputFile out(output);
  out.write(embed(stream, microtin_vertex_count(terrain.mesh()), name));
  out.commit();
}

}  // namespace microtin
