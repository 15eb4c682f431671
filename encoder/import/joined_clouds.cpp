// SPDX-License-Identifier: MIT
// Joins clouds of points.
#include <algorithm>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/exact/fraction.hpp"
#include "encoder/exact/lattice_map.hpp"
#include "encoder/import/cloud.hpp"
#include "encoder/import/mosaic.hpp"
#include "encoder/import/reference.hpp"

namespace microtin::importing {
namespace {

void refine_cloud(PointCloud& cloud, int xy_decimals, int z_decimals, const std::string& path) {
  const int64_t xy = power_of_ten(xy_decimals - cloud.xy_decimals);
  const int64_t z = power_of_ten(z_decimals - cloud.z_decimals);
  if (xy == 1 && z == 1) return;  // as for most files: else time would be quadratic in them
  for (SourcePoint& p : cloud.points) {
    if (!terrain::refine(p.x, xy) || !terrain::refine(p.y, xy) || !terrain::refine(p.z, z)) {
      throw Error(path + ": its numbers do not fit the decimals of the other files; round them");
    }
  }
  cloud.xy_decimals = xy_decimals;
  cloud.z_decimals = z_decimals;
}

// Where points of several files share a place: how far they differ there.
class SharedPlaces {
 public:
  // Files' points follow each other; `ends` says where each one's do.
  SharedPlaces(const PointCloud& cloud, const std::vector<size_t>& ends)
      : cloud_(cloud), ends_(ends), order_(cloud.points.size()) {
    std::iota(order_.begin(), order_.end(), size_t{0});
    std::sort(order_.begin(), order_.end(), [this](size_t a, size_t b) {
      const SourcePoint &p = cloud_.points[a], &q = cloud_.points[b];
      return std::tie(p.x, p.y, a) < std::tie(q.x, q.y, b);
    });
    for (size_t begin = 0; begin < order_.size();) begin = compare_from(begin);
  }

  std::string text(const std::vector<NamedSource>& parts) const {
    if (places_ == 0) return ", which share no place";
    const std::string at = std::to_string(places_) + " places that they share";
    if (difference_ == 0) return ", which agree at " + at;
    const CoordinateText place(decimal_axis(cloud_.xy_decimals));
    const SourcePoint& p = cloud_.points[first_];
    return "; at " + at + " they differ by up to " +
           to_string(make_decimal(difference_, cloud_.z_decimals)) + ", most at x " + place(p.x) +
           ", y " + place(p.y) + " in " + parts[file_of(first_)].path + " and " +
           parts[file_of(second_)].path + "; all count";
  }

 private:
  size_t file_of(size_t point) const {
    return static_cast<size_t>(std::upper_bound(ends_.begin(), ends_.end(), point) - ends_.begin());
  }

  // The points of one place, in the order of their files; those of earlier files are compared by
  // their lowest and highest. Returns where the next place begins.
  size_t compare_from(size_t begin) {
    const SourcePoint& place = cloud_.points[order_[begin]];
    const size_t first_file = file_of(order_[begin]);
    size_t low = order_[begin], high = low, own_low = low, own_high = low, file = first_file;
    bool is_shared = false;
    size_t end = begin;
    for (; end < order_.size(); ++end) {
      const size_t point = order_[end];
      const SourcePoint& p = cloud_.points[point];
      if (p.x != place.x || p.y != place.y) break;
      if (const size_t own = file_of(point); own != file) {
        file = own;
        low = lower(low, own_low);
        high = higher(high, own_high);
        own_low = own_high = point;
      }
      own_low = lower(own_low, point);
      own_high = higher(own_high, point);
      if (file == first_file) continue;
      is_shared = true;
      note(low, point);
      note(high, point);
    }
    if (is_shared) ++places_;
    return end;
  }

  size_t lower(size_t a, size_t b) const { return cloud_.points[b].z < cloud_.points[a].z ? b : a; }
  size_t higher(size_t a, size_t b) const {
    return cloud_.points[b].z > cloud_.points[a].z ? b : a;
  }

  void note(size_t a, size_t b) {
    const Wide difference = magnitude(Wide{cloud_.points[a].z} - cloud_.points[b].z);
    if (difference <= difference_) return;
    difference_ = difference;
    first_ = a;
    second_ = b;
  }

  const PointCloud& cloud_;
  const std::vector<size_t>& ends_;
  std::vector<size_t> order_;
  uint64_t places_ = 0;
  Wide difference_ = 0;
  size_t first_ = 0, second_ = 0;
};

// The ground of one file does not go with all but the noise of another.
void expect_same_classes(const NamedSource& first, const NamedSource& part, const PointCloud& a,
                         const PointCloud& b) {
  if (!a.classes || !b.classes || *a.classes == *b.classes) return;
  throw Error(part.path + ": " + b.selection + ", but " + first.path + ": " + a.selection +
              "; choose the classes of all files by " + parameter("classes"));
}

// In degrees, files beyond 180 continue their neighbours' longitudes. Says so for the user.
std::string turn(std::vector<NamedSource>& parts) {
  std::vector<LongitudeSpan> spans;
  for (const NamedSource& part : parts) {
    const auto& cloud = std::get<PointCloud>(part.source);
    if (cloud.reference.horizontal_unit != Unit::kDegree || cloud.points.empty()) return "";
    const auto [west, east] =
        std::minmax_element(cloud.points.begin(), cloud.points.end(),
                            [](const SourcePoint& p, const SourcePoint& q) { return p.x < q.x; });
    const auto scale = static_cast<double>(power_of_ten(cloud.xy_decimals));
    spans.push_back({static_cast<double>(west->x) / scale, static_cast<double>(east->x) / scale});
  }
  const std::vector<bool> turned = turned_east(spans);
  double east = 0;
  for (size_t i = 0; i < parts.size(); ++i) {
    if (!turned[i]) continue;
    auto& cloud = std::get<PointCloud>(parts[i].source);
    for (SourcePoint& p : cloud.points) p.x += 360 * power_of_ten(cloud.xy_decimals);
    east = std::max(east, spans[i].east + 360);
  }
  return turned_text(turned, east);
}

PointCloud joined(std::vector<NamedSource> parts) {
  PointCloud whole = std::move(std::get<PointCloud>(parts[0].source));
  std::vector<size_t> ends = {whole.points.size()};
  for (size_t i = 1; i < parts.size(); ++i) {
    PointCloud& part = std::get<PointCloud>(parts[i].source);
    expect_alike(parts[0], parts[i], whole.reference, part.reference);
    add_statements(part.reference, whole.reference);
    expect_same_classes(parts[0], parts[i], whole, part);
    const int xy = std::max(whole.xy_decimals, part.xy_decimals);
    const int z = std::max(whole.z_decimals, part.z_decimals);
    refine_cloud(whole, xy, z, parts[i].path);
    refine_cloud(part, xy, z, parts[i].path);
    whole.points.insert(whole.points.end(), part.points.begin(), part.points.end());
    if (!part.classes) whole.classes.reset();
    add(whole.counts, part.counts);
    ends.push_back(whole.points.size());
    part = PointCloud();
  }
  whole.selection = std::to_string(parts.size()) + " files" + SharedPlaces(whole, ends).text(parts);
  if (whole.classes) whole.selection += "; " + taken_text(whole.counts, *whole.classes);
  return whole;
}

}  // namespace

PointCloud join_clouds(std::vector<NamedSource> parts) {
  const std::string turned = turn(parts);
  PointCloud whole = joined(std::move(parts));
  whole.selection += turned;
  return whole;
}

}  // namespace microtin::importing
