// SPDX-License-Identifier: MIT
/* A terrain in flash, linked as a C array and decoded where it lies, in pieces between other tasks;
 * then heights at places given in degrees. */
#include "microtin/microtin.h"
#include "print.h"
#include "terrain.h" /* microtin embed hills.mtin -o terrain.h */

/* Both workspaces, in units that align them. */
static uint64_t mesh_space[(MICROTIN_MESH_BYTES(TERRAIN_VERTICES) + 7) / 8];
static uint64_t decoder_space[(MICROTIN_DECODER_BYTES(TERRAIN_VERTICES) + 7) / 8];

static microtin_status decode(microtin_decoder* decoder, int32_t* pieces) {
  const uint8_t* next = terrain_stream;
  size_t left = sizeof terrain_stream;
  microtin_status status = MICROTIN_STATUS_STEP_LIMIT;
  for (*pieces = 0; status == MICROTIN_STATUS_STEP_LIMIT; ++*pieces) {
    size_t used;
    status = microtin_decoder_feed(decoder, next, left, &used, 200);
    next += used;
    left -= used;
    /* Other tasks have their turn here. */
  }
  return status == MICROTIN_STATUS_NEED_INPUT ? microtin_decoder_finish(decoder) : status;
}

/* Height in millimetres at a place in 1e-7 degrees; 0 if there is none. */
static int height_at(const microtin_mesh* mesh, int32_t longitude, int32_t latitude,
                     int32_t* height) {
  static uint32_t hint; /* the next place is likely to be near this one */
  microtin_axis x, y, z;
  int32_t place_x, place_y, steps;
  microtin_mesh_axes(mesh, &x, &y, &z);
  if (microtin_axis_to_lattice(&x, longitude, 10000000, &place_x) != MICROTIN_STATUS_OK) return 0;
  if (microtin_axis_to_lattice(&y, latitude, 10000000, &place_y) != MICROTIN_STATUS_OK) return 0;
  if (microtin_mesh_height_at(mesh, place_x, place_y, &hint, &steps, 0, 0) != MICROTIN_QUERY_OK)
    return 0;
  return microtin_axis_height(&z, steps, 1000, height) == MICROTIN_STATUS_OK;
}

int firmware_main(void) {
  static const int32_t places[3][2] = {
      {71234567, -325000000}, {75000000, -323333333}, {99999999, -325000000}};
  microtin_mesh* mesh;
  microtin_decoder* decoder;
  int32_t pieces, i;
  if (microtin_mesh_init(mesh_space, sizeof mesh_space, &mesh) != MICROTIN_STATUS_OK) return 1;
  if (microtin_decoder_init(decoder_space, sizeof decoder_space, mesh, &decoder) !=
      MICROTIN_STATUS_OK) {
    return 1;
  }
  if (decode(decoder, &pieces) != MICROTIN_STATUS_OK) return 1;
  print_number((int32_t)microtin_mesh_vertex_count(mesh));
  print(" vertices in ");
  print_number(pieces);
  print(" pieces\n");
  for (i = 0; i < 3; ++i) {
    int32_t height;
    print_number(places[i][0]);
    print(" ");
    print_number(places[i][1]);
    if (height_at(mesh, places[i][0], places[i][1], &height)) {
      print(": ");
      print_number(height);
      print(" mm\n");
    } else {
      print(": no terrain\n");
    }
  }
  return 0;
}
