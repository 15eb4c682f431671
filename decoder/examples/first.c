// SPDX-License-Identifier: MIT
/* The first steps: a terrain in flash, decoded where it lies, and the height in its middle. */
#include "microtin/microtin.h"
#include "print.h"
#include "terrain.h" /* microtin embed terrain.mtin -o terrain.h */

/* Both workspaces, in units that align them. */
static uint64_t mesh_space[(MICROTIN_MESH_BYTES(TERRAIN_VERTICES) + 7) / 8];
static uint64_t decoder_space[(MICROTIN_DECODER_BYTES(TERRAIN_VERTICES) + 7) / 8];

int firmware_main(void) {
  microtin_mesh* mesh;
  microtin_decoder* decoder;
  microtin_axis x, y, z;
  size_t used;
  uint32_t hint = 0;
  int32_t height, millimetres;
  if (microtin_mesh_init(mesh_space, sizeof mesh_space, &mesh) != MICROTIN_STATUS_OK ||
      microtin_decoder_init(decoder_space, sizeof decoder_space, mesh, &decoder) !=
          MICROTIN_STATUS_OK ||
      microtin_decoder_feed(decoder, terrain_stream, sizeof terrain_stream, &used, 0) !=
          MICROTIN_STATUS_OK) {
    return 1;
  }
  microtin_mesh_axes(mesh, &x, &y, &z);
  if (microtin_mesh_height_at(mesh, 32 * 256, 32 * 256, &hint, &height, 0, 0) !=
          MICROTIN_QUERY_OK ||
      microtin_axis_height(&z, height, 1000, &millimetres) != MICROTIN_STATUS_OK) {
    return 1;
  }
  print_number((int32_t)microtin_mesh_vertex_count(mesh));
  print(" vertices, height ");
  print_number(millimetres);
  print(" mm\n");
  return 0;
}
