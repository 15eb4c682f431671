// SPDX-License-Identifier: MIT
#include "encoder/import/conversion.hpp"

#include <algorithm>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/exact/fraction.hpp"

namespace microtin::importing {
namespace {

bool is_plain(const DecimalFactor& factor) {
  return factor.numerator == 1 && factor.decimals == 0;
}

[[noreturn]] void refuse() {
  throw Error("its numbers have too many digits to be converted exactly: round them first");
}

// A factor for whole numbers, and the decimals that these have afterwards.
class Multiplier {
 public:
  Multiplier(const DecimalFactor& factor, int decimals)
      : factor_(factor.numerator), decimals_(decimals + factor.decimals) {
    constexpr int kMost = 18;
    if (decimals_ > kMost) refuse();
    for (; decimals_ < 0; ++decimals_) factor_ *= 10;
  }

  int decimals() const { return decimals_; }

  void apply(int64_t& number) const {
    if (magnitude(number) > terrain::kLargestNumber / magnitude(factor_)) refuse();
    number *= factor_;
  }

 private:
  int64_t factor_;
  int decimals_;
};

void convert_axis(Axis& axis, const DecimalFactor& factor) {
  if (is_plain(factor)) return;
  const Wide above = factor.numerator * Wide{power_of_ten(std::max(0, -factor.decimals))};
  const Wide below = power_of_ten(std::max(0, factor.decimals));
  axis = reduced_axis(axis.offset * above, static_cast<Wide>(axis.numerator) * above,
                      static_cast<Wide>(axis.denominator) * below);
}

void convert_heights(Raster& raster, const Multiplier& multiplier) {
  raster.decimals = multiplier.decimals();
  for (int64_t& height : raster.heights) {
    if (height != kVoidHeight) multiplier.apply(height);
  }
}

void convert(Raster& raster, const Conversion& conversion) {
  convert_axis(raster.x, conversion.xy);
  convert_axis(raster.y, conversion.xy);
  if (!is_plain(conversion.z)) convert_heights(raster, {conversion.z, raster.decimals});
}

void convert(PointCloud& cloud, const Conversion& conversion) {
  const Multiplier xy(conversion.xy, cloud.xy_decimals), z(conversion.z, cloud.z_decimals);
  for (SourcePoint& p : cloud.points) {
    xy.apply(p.x);
    xy.apply(p.y);
    z.apply(p.z);
  }
  cloud.xy_decimals = xy.decimals();
  cloud.z_decimals = z.decimals();
}

class ConvertedRaster : public RasterReader {
 public:
  ConvertedRaster(std::unique_ptr<RasterReader> raster, SettledReference settled)
      : raster_(std::move(raster)), settled_(std::move(settled)) {
    frame_ = raster_->frame();
    take(frame_);
  }

  Raster read(const terrain::PostRectangle& rectangle) const override {
    Raster part = raster_->read(rectangle);
    take(part);
    return part;
  }

 private:
  void take(Raster& raster) const {
    convert(raster, settled_.conversion);
    raster.reference = settled_.reference;
  }

  std::unique_ptr<RasterReader> raster_;
  SettledReference settled_;
};

}  // namespace

bool is_plain(const Conversion& conversion) {
  return is_plain(conversion.xy) && is_plain(conversion.z);
}

void convert(Source& source, const SettledReference& settled) {
  std::visit(
      [&](auto& one) {
        if (!is_plain(settled.conversion)) convert(one, settled.conversion);
        one.reference = settled.reference;
      },
      source);
}

void settle_source(Source& source, const Reference& asked) {
  convert(source, settle(terrain::reference_of(source), asked));
}

void settle_source(OpenSource& source, const Reference& asked) {
  auto* const raster = std::get_if<std::unique_ptr<RasterReader>>(&source);
  if (raster != nullptr) {
    SettledReference settled = settle((*raster)->frame().reference, asked);
    *raster = std::make_unique<ConvertedRaster>(std::move(*raster), std::move(settled));
    return;
  }
  Source cloud = std::move(std::get<PointCloud>(source));
  settle_source(cloud, asked);
  source = std::move(std::get<PointCloud>(cloud));
}

}  // namespace microtin::importing
