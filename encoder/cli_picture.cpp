#include <sstream>

#include "encoder/cli_commands.hpp"
#include "encoder/cli_report.hpp"
#include "encoder/error_context.hpp"
#include "encoder/fractal.hpp"
#include "encoder/output_file.hpp"
#include "encoder/render.hpp"

namespace microtin {

void run_fractal(const std::string& output, uint32_t size, uint64_t seed) {
  OutputFile out(output);
  std::ostringstream text;
  text.exceptions(std::ios::badbit);  // else a text for which memory is short ends early, unsaid
  write_fractal_asc(text, size, seed);
  out.write(text.str());
  out.commit();
}

void run_render(const std::string& input, const std::string& output, uint32_t width) {
  refuse_overwriting(input, output);
  const std::vector<uint8_t> stream = read_stream(input);
  const DecodedTerrain terrain = about(input, [&] { return DecodedTerrain(stream); });
  OutputFile out(output);
  const std::vector<uint8_t> picture = render_png(terrain.mesh(), width);
  out.write(picture);
  out.commit();
}

}  // namespace microtin
