// SPDX-License-Identifier: MIT
// Joins rasters, which are read in pieces.
#include "encoder/import/mosaic.hpp"

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/base/text.hpp"
#include "encoder/exact/decimal.hpp"
#include "encoder/exact/fraction.hpp"
#include "encoder/exact/lattice_map.hpp"
#include "encoder/exact/units.hpp"
#include "encoder/import/raster.hpp"
#include "encoder/import/reference.hpp"

namespace microtin::importing {
namespace {

bool is_alike(const Reference& a, const Reference& b) {
  return a.horizontal_unit == b.horizontal_unit && a.vertical_unit == b.vertical_unit &&
         a.horizontal_epsg == b.horizontal_epsg && a.vertical_epsg == b.vertical_epsg &&
         a.wkt == b.wkt;
}

std::string text_of(const Reference& reference) {
  std::string text = "x and y " + std::string(name_of(reference.horizontal_unit)) + ", heights " +
                     std::string(name_of(reference.vertical_unit));
  if (reference.horizontal_epsg != 0) text += ", EPSG:" + std::to_string(reference.horizontal_epsg);
  if (reference.vertical_epsg != 0) text += ":" + std::to_string(reference.vertical_epsg);
  return text;
}

// What to do about two files that are not alike.
std::string remedy(const NamedSource& first, const NamedSource& part, const Reference& a,
                   const Reference& b) {
  for (const auto& [file, reference] : {std::tie(first, a), std::tie(part, b)}) {
    if (reference.horizontal_unit != Unit::kUnknown || !reference.wkt.empty()) continue;
    if (suffix_of(file.path) == ".asc") {
      return "add the missing .prj next to " + file.path + ", or set an EPSG code for all";
    }
  }
  const bool is_unknown = a.vertical_unit == Unit::kUnknown || b.vertical_unit == Unit::kUnknown;
  const std::string others = is_unknown ? ", or set units for all" : "";
  return (std::holds_alternative<PointCloud>(part.source) ? "bring all points into one system first"
                                                          : "bring it there with gdalwarp") +
         others;
}

}  // namespace

void expect_alike(const NamedSource& first, const NamedSource& part, const Reference& a,
                  const Reference& b) {
  if (is_alike(a, b)) return;
  throw Error(part.path + ": its units or its coordinate system (" + text_of(b) +
              ") are not those of " + first.path + " (" + text_of(a) +
              "): " + remedy(first, part, a, b));
}

std::vector<bool> turned_east(const std::vector<LongitudeSpan>& spans) {
  constexpr double kHalfTurn = 180;
  std::vector<LongitudeSpan> sorted = spans;
  std::sort(sorted.begin(), sorted.end(),
            [](const LongitudeSpan& a, const LongitudeSpan& b) { return a.west < b.west; });
  double east = sorted[0].east, last_west = -std::numeric_limits<double>::infinity();
  for (const LongitudeSpan& span : sorted) {
    if (span.west - east > kHalfTurn) last_west = east;
    east = std::max(east, span.east);
  }
  std::vector<bool> turned;
  turned.reserve(spans.size());
  for (const LongitudeSpan& span : spans) turned.push_back(span.east <= last_west);
  return turned;
}

std::string turned_text(const std::vector<bool>& turned, double east) {
  const auto count = std::count(turned.begin(), turned.end(), true);
  if (count == 0) return "";
  return "; " + std::to_string(count) +
         (count == 1
              ? " lies beyond 180 degrees east and continues its neighbours' longitudes, to "
              : " lie beyond 180 degrees east and continue their neighbours' longitudes, to ") +
         to_string(*shortest_decimal(east));
}

namespace {

// A rectangle on the grid of the first raster's posts.
struct Box {
  int64_t x, y, width, height;

  int64_t right() const { return x + width; }
  int64_t top() const { return y + height; }

  Box shared_with(const Box& other) const {
    const int64_t left = std::max(x, other.x), bottom = std::max(y, other.y);
    return {left, bottom, std::max<int64_t>(0, std::min(right(), other.right()) - left),
            std::max<int64_t>(0, std::min(top(), other.top()) - bottom)};
  }

  bool empty() const { return width == 0 || height == 0; }
};

// Frames of rasters; in degrees those beyond 180 continue their neighbours' longitudes.
struct Frames {
  explicit Frames(const std::vector<NamedSource>& sources) {
    std::vector<LongitudeSpan> spans;
    bool is_degrees = true;
    for (const NamedSource& source : sources) {
      all.push_back(std::get<std::unique_ptr<RasterReader>>(source.source)->frame());
      const Raster& frame = all.back();
      is_degrees = is_degrees && frame.reference.horizontal_unit == Unit::kDegree;
      const double west = offset_of(frame.x);
      spans.push_back({west, west + step_of(frame.x) * (frame.width - 1)});
    }
    if (!is_degrees) return;
    const std::vector<bool> turned = turned_east(spans);
    double east = 0;
    for (size_t i = 0; i < all.size(); ++i) {
      if (!turned[i]) continue;
      all[i].x = names_of_x(all[i].x, true).back();
      east = std::max(east, spans[i].east + 360);
    }
    text = turned_text(turned, east);
  }

  std::vector<Raster> all;
  std::string text;  // for the user
};

// Posts of a raster, by their places on the lattice.
struct Piece {
  int64_t x, y, x_spacing, y_spacing;  // of the first post, and from one to the next
  int64_t columns, rows;
  std::vector<int64_t> heights;

  int64_t height(int64_t column, int64_t row) const {
    return heights[static_cast<size_t>(row * columns + column)];
  }
  // kNoPost where there is none.
  int64_t height_at(int64_t px, int64_t py) const {
    const int64_t dx = px - x, dy = py - y;
    if (dx < 0 || dy < 0 || dx % x_spacing != 0 || dy % y_spacing != 0) return kNoPost;
    if (dx / x_spacing >= columns || dy / y_spacing >= rows) return kNoPost;
    return height(dx / x_spacing, dy / y_spacing);
  }
  // Whether a post has a height at a corner of the cell that a place is in.
  bool has_height_around(int64_t px, int64_t py) const {
    const int64_t west = (px - x) / x_spacing, south = (py - y) / y_spacing;
    for (int64_t row = south; row <= std::min(south + 1, rows - 1); ++row) {
      for (int64_t column = west; column <= std::min(west + 1, columns - 1); ++column) {
        if (is_height(height(column, row))) return true;
      }
    }
    return false;
  }
  // Calls visit(x, y, height).
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (int64_t row = 0; row < rows; ++row) {
      for (int64_t column = 0; column < columns; ++column) {
        visit(x + column * x_spacing, y + row * y_spacing, height(column, row));
      }
    }
  }
};

struct Part {
  std::string path;
  std::unique_ptr<RasterReader> raster;
  PostPlaces places;
  Box box;  // from the first to the last post

  // The posts of a rectangle that shares places with the box, and those next to them around it,
  // with this many decimals.
  Piece read(const Box& wanted, int decimals) const {
    const Box inner = wanted.shared_with(box);
    const auto first = [](int64_t from, int64_t spacing) { return from / spacing; };
    const auto last = [](int64_t end, int64_t spacing) {
      return (end - 1 + spacing - 1) / spacing;
    };
    const int64_t sx = places.x_spacing, sy = places.y_spacing;
    const int64_t west = first(inner.x - box.x, sx), south = first(inner.y - box.y, sy);
    const int64_t columns = last(inner.right() - box.x, sx) - west + 1;
    const int64_t rows = last(inner.top() - box.y, sy) - south + 1;
    Raster piece = raster->read({static_cast<uint32_t>(west), static_cast<uint32_t>(south),
                                 static_cast<uint32_t>(columns), static_cast<uint32_t>(rows)});
    if (!refine(piece.heights, power_of_ten(decimals - piece.decimals))) {
      throw Error(path + ": its heights do not fit the decimals of the other files; round them");
    }
    return {box.x + west * sx, box.y + south * sy, sx, sy, columns, rows, std::move(piece.heights)};
  }

  // The box and places around it where the next posts would be the neighbours of its last.
  Box reach() const {
    const int64_t x = places.x_spacing - int64_t{1}, y = places.y_spacing - int64_t{1};
    return {box.x - x, box.y - y, box.width + 2 * x, box.height + 2 * y};
  }
};

Box box_of(const PostPlaces& places, const Raster& frame) {
  const int64_t columns = frame.width, rows = frame.height;
  return {places.x, places.y, (columns - 1) * places.x_spacing + 1,
          (rows - 1) * places.y_spacing + 1};
}

// The largest difference of two heights at a post.
struct Difference {
  int64_t height = 0;  // with the whole's decimals
  int64_t x = 0, y = 0;
  std::string first, second;
};

class Mosaic : public RasterReader {
 public:
  explicit Mosaic(std::vector<NamedSource> sources) {
    const Frames frames(sources);
    frame_ = frames.all[0];
    std::vector<std::string> paths;
    for (size_t i = 0; i < sources.size(); ++i) {
      paths.push_back(sources[i].path);
      expect_alike(sources[0], sources[i], frame_.reference, frames.all[i].reference);
    }
    const CommonLattice lattice = common_lattice(frames.all, paths);
    frame_.x = lattice.x;
    frame_.y = lattice.y;
    for (size_t i = 0; i < sources.size(); ++i) {
      const PostPlaces& places = lattice.rasters[i];
      add_statements(frames.all[i].reference, frame_.reference);
      parts_.push_back({paths[i],
                        std::move(std::get<std::unique_ptr<RasterReader>>(sources[i].source)),
                        places, box_of(places, frames.all[i])});
      frame_.decimals = std::max(frame_.decimals, frames.all[i].decimals);
      frame_.x_spacing = std::max(frame_.x_spacing, places.x_spacing);
      frame_.y_spacing = std::max(frame_.y_spacing, places.y_spacing);
    }
    const std::string shift = warning_on_shift(lattice.rasters, paths);
    if (!shift.empty()) frame_.reference.warnings.push_back(shift);
    find_frame();
    compare_parts();
    if (is_sparse(frame_)) frame_.selection += lattice_text();
    frame_.selection += frames.text;
  }

  Raster read(const PostRectangle& r) const override {
    Raster whole = crop_frame(frame_, r);
    whole.heights.assign(size_t{r.width} * r.height, kVoidHeight);
    const Box wanted{x_ + r.x, y_ + r.y, int64_t{r.width}, int64_t{r.height}};
    Canvas canvas{wanted, whole.heights};
    std::vector<Piece> pieces;
    for (const Part& part : parts_) {
      if (is_sparse(frame_)) canvas.clear(part.reach());
      if (!wanted.shared_with(part.box).empty()) {
        pieces.push_back(part.read(wanted, frame_.decimals));
      }
    }
    for (const Piece& piece : pieces) canvas.draw(piece);
    if (is_sparse(frame_) && pieces.size() > 1) {
      for (const Piece& piece : pieces) canvas.fill(piece);
    }
    return whole;
  }

  std::vector<bool> absent_in(const PostRectangle& r) const override {
    const Box wanted{x_ + r.x, y_ + r.y, int64_t{r.width}, int64_t{r.height}};
    std::vector<bool> absent(size_t{r.width} * r.height, true);
    for (const Part& part : parts_) {
      const Box box = wanted.shared_with(part.box);
      for (int64_t y = box.y; y < box.top(); ++y) {
        const int64_t from = (y - wanted.y) * wanted.width + box.x - wanted.x;
        std::fill_n(absent.begin() + from, box.width, false);
      }
    }
    return absent;
  }

 private:
  // The heights of a rectangle.
  struct Canvas {
    Box box;
    std::vector<int64_t>& heights;

    int64_t& at(int64_t x, int64_t y) const {
      return heights[static_cast<size_t>((y - box.y) * box.width + x - box.x)];
    }
    bool holds(int64_t x, int64_t y) const {
      return x >= box.x && x < box.right() && y >= box.y && y < box.top();
    }
    // No place there is void because no file has it.
    void clear(const Box& part) const {
      const Box inner = box.shared_with(part);
      for (int64_t y = inner.y; y < inner.top(); ++y) {
        for (int64_t x = inner.x; x < inner.right(); ++x) at(x, y) = kNoPost;
      }
    }
    // The first height counts, and any height instead of a void.
    void draw(const Piece& piece) const {
      piece.for_each([&](int64_t x, int64_t y, int64_t z) {
        if (holds(x, y) && !is_height(at(x, y))) at(x, y) = z;
      });
    }
    // Posts of another grid do away with a void post between them.
    void fill(const Piece& piece) const {
      const Box inner =
          box.shared_with({piece.x, piece.y, (piece.columns - 1) * piece.x_spacing + 1,
                           (piece.rows - 1) * piece.y_spacing + 1});
      for (int64_t y = inner.y; y < inner.top(); ++y) {
        for (int64_t x = inner.x; x < inner.right(); ++x) {
          if (at(x, y) != kVoidHeight || piece.height_at(x, y) != kNoPost) continue;
          if (piece.has_height_around(x, y)) at(x, y) = kNoPost;
        }
      }
    }
  };

  // Cells of which sizes, and what they share.
  std::string lattice_text() const {
    const CoordinateText x({0, frame_.x.numerator, frame_.x.denominator});
    const CoordinateText y({0, frame_.y.numerator, frame_.y.denominator});
    return "; their posts share a lattice of " + x(1) + " x " + y(1) +
           ", on which they are up to " + x(frame_.x_spacing) + " x " + y(frame_.y_spacing) +
           " apart";
  }

  void find_frame() {
    Box all = parts_[0].box;
    for (const Part& part : parts_) {
      const int64_t right = std::max(all.right(), part.box.right());
      const int64_t top = std::max(all.top(), part.box.top());
      all.x = std::min(all.x, part.box.x);
      all.y = std::min(all.y, part.box.y);
      all.width = right - all.x;
      all.height = top - all.y;
      if (all.width > INT32_MAX || all.height > INT32_MAX) {
        throw Error(part.path + ": lies more than 2^31 posts from " + parts_[0].path);
      }
    }
    expect_held(all);
    x_ = all.x;
    y_ = all.y;
    frame_.width = static_cast<uint32_t>(all.width);
    frame_.height = static_cast<uint32_t>(all.height);
    frame_.x = moved_axis(frame_.x, x_);
    frame_.y = moved_axis(frame_.y, y_);
  }

  void expect_held(const Box& all) const {
    uint64_t held = 0;
    for (const Part& part : parts_) held += static_cast<uint64_t>(part.box.width * part.box.height);
    if (can_hold(held, static_cast<uint64_t>(all.width), static_cast<uint64_t>(all.height))) return;
    throw Error(parts_[0].path + " and others: lie so far apart that they have " +
                std::to_string(held) + " of " + std::to_string(all.width) + " x " +
                std::to_string(all.height) + " posts: encode distant files by themselves");
  }

  void compare_parts() {
    uint64_t overlaps = 0;
    Difference largest;
    for (size_t i = 0; i < parts_.size(); ++i) {
      for (size_t j = i + 1; j < parts_.size(); ++j) {
        if (parts_[i].box.shared_with(parts_[j].box).empty()) continue;
        ++overlaps;
        compare(parts_[i], parts_[j], largest);
      }
    }
    frame_.selection = std::to_string(parts_.size()) + " files" + text_of(overlaps, largest);
  }

  // In strips, so that memory stays small.
  void compare(const Part& a, const Part& b, Difference& largest) const {
    constexpr int64_t kRows = 64;
    const Box all = a.box.shared_with(b.box);
    for (int64_t y = all.y; y < all.top(); y += kRows) {
      const Box strip{all.x, y, all.width, std::min(kRows, all.top() - y)};
      const Piece mine = a.read(strip, frame_.decimals), others = b.read(strip, frame_.decimals);
      mine.for_each([&](int64_t x, int64_t py, int64_t z) {
        if (!is_height(z)) return;
        const int64_t other = others.height_at(x, py);
        if (!is_height(other)) return;
        const auto difference = static_cast<int64_t>(magnitude(Wide{z} - other));
        if (difference <= largest.height) return;
        largest = {difference, x - x_, py - y_, a.path, b.path};
      });
    }
  }

  std::string text_of(uint64_t overlaps, const Difference& largest) const {
    if (overlaps == 0) return ", none of which overlap";
    if (largest.height == 0) return ", which agree where they overlap";
    return "; where they overlap they differ by up to " +
           to_string(make_decimal(largest.height, frame_.decimals)) + ", most at x " +
           CoordinateText(frame_.x)(largest.x) + ", y " + CoordinateText(frame_.y)(largest.y) +
           " in " + largest.first + " and " + largest.second + "; the first one counts";
  }

  std::vector<Part> parts_;
  int64_t x_ = 0, y_ = 0;  // of the whole's first post on the first raster's grid
};

bool is_cloud(const NamedSource& named) {
  return std::holds_alternative<PointCloud>(named.source);
}

}  // namespace

OpenSource join(std::vector<NamedSource> parts) {
  if (parts.size() == 1) return std::move(parts[0].source);
  for (const NamedSource& part : parts) {
    if (is_cloud(part) == is_cloud(parts[0])) continue;
    throw Error(part.path + (is_cloud(part) ? ": are points, but " : ": is a raster, but ") +
                parts[0].path + (is_cloud(part) ? " is a raster" : " are points"));
  }
  if (is_cloud(parts[0])) return join_clouds(std::move(parts));
  return std::make_unique<Mosaic>(std::move(parts));
}

}  // namespace microtin::importing
