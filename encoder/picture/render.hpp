// SPDX-License-Identifier: MIT
// The pictures: maps of decoded terrains with a legend, pages for browsers, and profiles. Each has
// a source of its own.
#ifndef MICROTIN_ENCODER_PICTURE_RENDER_HPP
#define MICROTIN_ENCODER_PICTURE_RENDER_HPP

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "encoder/exact/units.hpp"
#include "encoder/export/mesh.hpp"
#include "encoder/layers.hpp"
#include "encoder/picture/drawing.hpp"
#include "encoder/picture/palette.hpp"
#include "encoder/stream/edge_marks.hpp"
#include "encoder/verify/verify.hpp"
#include "microtin/profile.hpp"

namespace microtin::picture {

struct Portrait {
  SurfaceModel model;
  Metadata metadata;
  uint64_t vertices = 0, bytes = 0;
  uint64_t tiles = 0;  // 0: a stream
  bool mesh = true;    // draw the triangles' lines
  PaletteKind palette = PaletteKind::kLand;
  bool contours = false;
  std::optional<Decimal> interval;  // of contours, in the unit of heights; a round one if not given
  std::string title;                // above the map; letters that draw_text has
  bool coordinates = false;         // on the frame
  bool north_arrow = false;
  std::vector<MarkedLine> lines = {};  // of the model's vertices
};

// How a terrain compares with its source.
struct Comparison {
  Spot cell;  // lattice steps between neighbouring posts, along x and y
  std::function<Verification(const PostVisitor&)> verify;
};

constexpr uint32_t kNarrowest = 200, kWidest = 8192;

// A PNG file, `width` pixels wide: shaded relief, tinted by height, in which the triangles' lines
// fade in from the left to the right; heights, scale, size and errors, as far as the metadata tell.
// Lines of the terrain have the colour of their class. With a comparison also a map of the errors.
// Only triangles all of whose vertices are at the water level are water. Throws Error for other
// widths and if there is no vertex.
std::vector<uint8_t> render_png(const Portrait& portrait, uint32_t width,
                                const Comparison* comparison = nullptr);

constexpr size_t kMostSvgTriangles = 200'000;

// An SVG file of the same, without errors: a path for the triangles of each colour, lines and
// contours as paths, letters as strokes; some 25 bytes a triangle, twice that with lines. Throws
// Error for more triangles, too.
std::string render_svg(const Portrait& portrait, uint32_t width);

// Where the map of such a picture lies, as a world file says it: six lines, in the units of x and
// y.
std::string world_file(const Portrait& portrait, uint32_t width, bool with_comparison);

// Pages for browsers: one file, which needs nothing else.

// With @TITLE@ and other places to be filled; empty if the build left the page out.
std::string_view viewer_page();

// Why the build left the page out; empty if it has the page.
std::string_view viewer_absence();

constexpr uint64_t kLargestPage = 100'000'000;  // bytes of a terrain

// The page of a terrain in a file with the given content; `flat` is a PNG for browsers that cannot
// draw. Throws Error if the program was built without the page, and for larger files.
std::string render_page(const Portrait& portrait, const std::string& title, const std::string& file,
                        const std::vector<uint8_t>& flat);

// Profiles: the terrain on the curved Earth, the ray above it, and its Fresnel zone.

struct ProfilePicture {
  const encoder::Profile& profile;
  encoder::SightOptions options;
  std::optional<encoder::LineOfSight> sight;
  Unit vertical;
};

// The Earth's bulge is added to the terrain, so that the ray is straight. Parts without heights are
// grey. `width` is a number of pixels, kNarrowest to kWidest.
std::vector<uint8_t> profile_png(const ProfilePicture& picture, uint32_t width);
std::string profile_svg(const ProfilePicture& picture, uint32_t width);

}  // namespace microtin::picture

#endif
