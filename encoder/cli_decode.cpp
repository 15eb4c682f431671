#include "encoder/cli_commands.hpp"
#include "encoder/cli_report.hpp"
#include "encoder/error_context.hpp"
#include "encoder/export.hpp"
#include "encoder/output_file.hpp"
#include "encoder/pack_surface.hpp"

namespace microtin {

namespace {

SurfaceModel read_model(const std::string& input) {
  const std::optional<PackFile> pack = open_pack(input);
  if (pack) return about(input, [&] { return model_of(*pack); });
  const std::vector<uint8_t> stream = read_stream(input);
  return about(input, [&] { return model_of(DecodedTerrain(stream).mesh()); });
}

}  // namespace

void run_decode(const DecodeRequest& request) {
  refuse_overwriting(request.input, request.output);
  const MeshFormat format = mesh_format_of(request.output);
  const SurfaceModel model = read_model(request.input);
  OutputFile out(request.output);
  export_model(model, format, request.lattice ? Coordinates::kLattice : Coordinates::kReal, out);
  out.commit();
}

}  // namespace microtin
