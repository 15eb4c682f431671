// SPDX-License-Identifier: MIT
/* What a firmware built with -fshort-enums sees of the public headers: short_enums.cpp is compiled
 * so, the tests and the library are not. */
#ifndef MICROTIN_TESTS_DECODER_SHORT_ENUMS_H
#define MICROTIN_TESTS_DECODER_SHORT_ENUMS_H

#include "decoder/adapters/ardupilot.h"
#include "decoder/adapters/inav.h"
#include "microtin/compact_pack.h"
#include "microtin/encoder.h"
#include "microtin/requests.h"

#define MICROTIN_PUBLIC_STRUCTS                                                                   \
  {                                                                                               \
    sizeof(microtin_axis), sizeof(microtin_stream_info), sizeof(microtin_segment),                \
        sizeof(microtin_segment_state), sizeof(microtin_segment_extremes), sizeof(microtin_path), \
        sizeof(microtin_crossing), sizeof(microtin_path_clearance), sizeof(microtin_grid_spec),   \
        sizeof(microtin_gradient), sizeof(microtin_position), sizeof(microtin_grid_extremes),     \
        sizeof(microtin_path_search), sizeof(microtin_pack_info), sizeof(microtin_request),       \
        sizeof(microtin_requests), sizeof(microtin_spot), sizeof(microtin_spots),                 \
        sizeof(microtin_stride), sizeof(microtin_inav), sizeof(microtin_inav_look),               \
        sizeof(microtin_ardupilot_block), sizeof(microtin_ardupilot),                             \
        sizeof(microtin_raster_data), sizeof(microtin_point_data), sizeof(microtin_options),      \
        sizeof(microtin_report), sizeof(microtin_grid), sizeof(microtin_surface_info),            \
        sizeof(microtin_triangles)                                                                \
  }

#ifdef __cplusplus
extern "C" {
#endif

/* Sizes of the structs above. */
size_t short_enums_size(uint32_t i);
size_t short_enums_status_size(void);

/* As a caller has it whose variable holds something else before. */
uint32_t short_enums_why(const microtin_pack* pack, uint32_t i);

#ifdef __cplusplus
}
#endif

#endif
