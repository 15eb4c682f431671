// SPDX-License-Identifier: MIT
// Lines of a terrain on a map.
#ifndef MICROTIN_ENCODER_PICTURE_LINES_HPP
#define MICROTIN_ENCODER_PICTURE_LINES_HPP

#include <vector>

#include "encoder/export/mesh.hpp"
#include "encoder/layers.hpp"
#include "encoder/picture/drawing.hpp"
#include "encoder/picture/frame.hpp"
#include "encoder/stream/edge_marks.hpp"

namespace microtin::picture {

// In the colour of each line's class. The lines' vertices are those of the model; `unit` as of
// legends.
void draw_marked_lines(Drawing& drawing, const MapFrame& frame, const SurfaceModel& model,
                       const std::vector<MarkedLine>& lines, double unit);

}  // namespace microtin::picture

#endif
