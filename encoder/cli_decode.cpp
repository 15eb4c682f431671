#include "encoder/cli_commands.hpp"
#include "encoder/cli_report.hpp"
#include "encoder/error_context.hpp"
#include "encoder/export.hpp"
#include "encoder/output_file.hpp"
#include "encoder/pack_surface.hpp"

namespace microtin {

void run_decode(const DecodeRequest& request) {
  refuse_overwriting(request.input, request.output);
  const MeshFormat format = mesh_format_of(request.output);
  const std::vector<uint8_t> stream = read_stream(request.input);
  const SurfaceModel model = about(request.input, [&] {
    return is_pack(stream) ? model_of(PackFile(stream)) : model_of(DecodedTerrain(stream).mesh());
  });
  OutputFile out(request.output);
  export_model(model, format, request.lattice ? Coordinates::kLattice : Coordinates::kReal, out);
  out.commit();
}

}  // namespace microtin
