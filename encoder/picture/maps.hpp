// SPDX-License-Identifier: MIT
// The two kinds of maps: a relief, which is shaded, tinted by height and shows the triangles; and
// how far a terrain is from its source.
#ifndef MICROTIN_ENCODER_PICTURE_MAPS_HPP
#define MICROTIN_ENCODER_PICTURE_MAPS_HPP

#include <optional>

#include "encoder/export/scene.hpp"
#include "encoder/layers.hpp"
#include "encoder/picture/drawing.hpp"
#include "encoder/picture/frame.hpp"
#include "encoder/picture/palette.hpp"

namespace microtin::picture {

constexpr Colour kWater{0.56, 0.73, 0.84};

class Relief {
 public:
  // Heights are lattice steps. Triangles with all vertices at `water` are water. The model must
  // outlive this.
  Relief(const SurfaceModel& model, const Ground& ground, std::optional<int64_t> water,
         PaletteKind palette);

  int64_t lowest() const { return lowest_; }
  int64_t highest() const { return highest_; }
  bool has_water() const;
  const Palette& palette() const { return palette_; }

  void draw_ground(Canvas& canvas, const MapFrame& frame) const;

  // Draws the relief as areas, each of one colour, for a drawing. Those of a colour together.
  void draw_facets(Svg& svg, const MapFrame& frame) const;

  // What heights are multiplied with for the light.
  double slope_scale() const { return slope_scale_; }

  // The triangles' lines fade in from the middle to the right. `line_width` in pixels.
  void draw_lines(Canvas& canvas, const MapFrame& frame, double line_width) const;

  // All of the same strength.
  void draw_wires(Svg& svg, const MapFrame& frame, double line_width) const;

 private:
  using Triangle = std::array<uint32_t, 3>;

  void find_normals(const Ground& ground);
  template <class Visit>
  void for_each_normal(const Ground& ground, const Visit& visit) const;
  bool is_water(const Triangle& triangle) const;
  Colour colour(const Triangle& triangle, const std::array<double, 3>& weights) const;

  const SurfaceModel& model_;
  std::optional<int64_t> water_;
  std::vector<Vector> normals_;  // upward, of any length
  int64_t lowest_ = 0, highest_ = 0;
  Palette palette_;
  double slope_scale_ = 1;
};

// From -1, too low, over 0 to 1, too high.
Colour error_colour(double relative);

class ErrorMap {
 public:
  // `cell` lattice steps lie between posts. Each post is drawn as large as the whole steps that may
  // lie between their places on the lattice, so that neighbours meet.
  ErrorMap(const MapFrame& frame, Spot cell);

  // The error of a post at a place on the lattice. A pixel keeps the largest one in it.
  void add(double x, double y, double above);

  // Errors of a magnitude of `scale` get the full colours.
  void draw(Canvas& canvas, double scale) const;

 private:
  MapFrame frame_;
  Spot reach_;  // in pixels
  std::vector<float> errors_;
};

}  // namespace microtin::picture

#endif
