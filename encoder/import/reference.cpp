// SPDX-License-Identifier: MIT
// In which units and systems a terrain lies: what its file, codes and people state, settled, and
// its numbers converted.
#include "encoder/import/reference.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/exact/fraction.hpp"
#include "encoder/import/crs.hpp"

namespace microtin::importing {
namespace {

std::string text_of(Unit unit) {
  return std::string(name_of(unit));
}

std::string text_of(const StatedUnit& unit) {
  return unit.other.empty() ? text_of(unit.unit) : unit.other;
}

bool is_same(const StatedUnit& a, const StatedUnit& b) {
  return a.unit == b.unit && a.other == b.other;
}

std::string code_text(uint32_t code) {
  return "EPSG " + std::to_string(code);
}

// One of both kinds of systems, by its code and its unit.
struct System {
  uint32_t code;
  StatedUnit unit;
};

System horizontal_of(const Reference& reference) {
  return {reference.horizontal_epsg, {reference.horizontal_unit, reference.horizontal_other}};
}

System vertical_of(const Reference& reference) {
  return {reference.vertical_epsg, {reference.vertical_unit, reference.vertical_other}};
}

std::string factor_text(const DecimalFactor& factor) {
  const Wide power = power_of_ten(std::max(0, -factor.decimals));
  return to_string(make_decimal(factor.numerator * power, std::max(0, factor.decimals)));
}

class Settlement {
 public:
  Settlement(const Reference& file, const Reference& requested)
      : file_(file), requested_(requested) {
    all_.warnings = file.warnings;
    all_.wkt = file.wkt;
    all_.notes = file.notes;
  }

  SettledReference settle() {
    settle_places();
    settle_heights();
    if (keeps_no_vertical_part_) all_.wkt = horizontal_part(all_.wkt);
    return {std::move(all_), conversion_};
  }

 private:
  void warn(const std::string& text) { all_.warnings.push_back(text); }

  void settle_places() {
    const System requested = complete(false, horizontal_of(requested_)),
                 file = horizontal_of(file_);
    if (!file_.unread.empty()) {
      if (requested.code == 0 && !requested.unit.is_stated()) throw Error(file_.unread);
      warn("the options override the system of the file, which is not read: " + file_.unread);
    }
    if (requested.code != 0) all_.wkt.clear();
    all_.horizontal_epsg = chosen(requested.code, file.code);
    StatedUnit unit = chosen("x and y", requested.unit, file.unit);
    if (!unit.other.empty()) {
      const bool is_own = !requested.unit.is_stated();
      if (is_own && (all_.horizontal_epsg != 0 || !all_.wkt.empty())) {
        throw Error("the unit of x and y is " + unit.other +
                    ", and their system has no other: bring them into a system of metres or feet " +
                    "with gdalwarp -t_srs, or set units");
      }
      unit.unit = converted("x and y", unit.other, conversion_.xy);
      const std::optional<CodedSystem> system = system_of_file_code(all_.horizontal_epsg);
      if (system && system->unit != unit.unit) {
        throw Error(code_text(all_.horizontal_epsg) + " has the unit " + text_of(system->unit) +
                    ", not " + text_of(unit.unit));
      }
    }
    all_.horizontal_unit = unit.unit;
  }

  // One unit that is requested is that of heights, too, unless codes say another.
  System requested_heights() const {
    const System requested = vertical_of(requested_), places = horizontal_of(requested_);
    const bool is_length = places.unit.is_stated() && places.unit.unit != Unit::kDegree;
    return requested_.one_unit && is_length && requested.code == 0 ? System{0, places.unit}
                                                                   : requested;
  }

  void settle_heights() {
    const System requested = complete(true, requested_heights()), file = vertical_of(file_);
    keeps_no_vertical_part_ = requested.code != 0 || requested.unit.is_stated();
    all_.vertical_epsg = chosen(requested.code, file.code);
    StatedUnit unit = chosen("heights", requested.unit, file.unit);
    if (!unit.other.empty()) {
      unit.unit = converted("heights", unit.other, conversion_.z);
      forget_system_of_other_unit(unit.unit);
      keeps_no_vertical_part_ = true;
    }
    all_.vertical_unit = unit.unit;
    settle_direction(requested.code);
  }

  // What the codes and units that are requested say together.
  System complete(bool is_vertical, System wanted) {
    if (wanted.code == 0) return wanted;
    const std::optional<CodedSystem> system = system_of_code(wanted.code);
    if (!system) {
      warn(code_text(wanted.code) + " is not a code known here, and is kept as it is" +
           (wanted.unit.is_stated() ? "" : ": set its units"));
      return wanted;
    }
    if (system->is_vertical != is_vertical) {
      throw Error(code_text(wanted.code) +
                  (is_vertical ? " is a horizontal system" : " is a vertical system") +
                  ": use HORIZONTAL:VERTICAL");
    }
    const StatedUnit unit{system->unit, system->other};
    if (wanted.unit.is_stated() && wanted.unit.other.empty() && !is_same(wanted.unit, unit)) {
      throw Error(code_text(wanted.code) + " has the unit " + text_of(unit) + ", not " +
                  text_of(wanted.unit));
    }
    return {wanted.code, wanted.unit.is_stated() ? wanted.unit : unit};
  }

  // Warns which of the file's codes and units give way.
  uint32_t chosen(uint32_t requested, uint32_t file) {
    if (requested == 0) return file;
    if (file != 0 && file != requested) {
      warn(code_text(requested) + " overrides the file's " + code_text(file));
    }
    return requested;
  }

  StatedUnit chosen(const char* what, const StatedUnit& requested, const StatedUnit& file) {
    if (!requested.is_stated()) return file;
    if (file.is_stated() && !is_same(requested, file)) {
      warn(std::string(what) + " are taken as " + text_of(requested) + "; the file says " +
           text_of(file));
    }
    return requested;
  }

  // The unit that numbers are in after it.
  Unit converted(const std::string& what, const std::string& name, DecimalFactor& factor) {
    const LengthUnit* const length = length_named(name);
    if (length == nullptr) {
      throw Error("the unit of " + what + " is \"" + name +
                  "\", which is not known: convert them, or set units");
    }
    const std::optional<DecimalFactor> exact = factor_of(*length);
    if (!exact) {
      throw Error("the unit of " + what + " is " + name + ", " + std::to_string(length->numerator) +
                  "/" + std::to_string(length->denominator) + " " + text_of(length->base) +
                  ", which no decimal is exactly: convert them, or set units");
    }
    factor = *exact;
    warn(what + " in the unit " + name + " are converted to " + text_of(length->base) + ": times " +
         factor_text(factor));
    return length->base;
  }

  void forget_system_of_other_unit(Unit unit) {
    const std::optional<CodedSystem> system = system_of_file_code(all_.vertical_epsg);
    if (!system || system->unit == unit) return;
    warn(code_text(all_.vertical_epsg) + " has another unit, and is not noted");
    all_.vertical_epsg = 0;
  }

  // Codes that are requested decide the direction, too.
  void settle_direction(uint32_t asked_code) {
    const uint32_t code = all_.vertical_epsg;
    const std::optional<CodedSystem> system = system_of_file_code(code);
    const bool is_coded_depth = system && system->is_depth;
    const bool stated = is_coded_depth || (asked_code == 0 && file_.depths);
    if (stated && !requested_.depths) {
      throw Error((is_coded_depth ? "heights are depths (" + code_text(code) + ")"
                                  : std::string("heights are depths by the file's system")) +
                  ", which grow downwards: negate them with " + parameter("depths") +
                  ", or set a vertical EPSG code of "
                  "heights");
    }
    if (!stated && file_.depths)
      warn("heights are taken as they are, although the file says depths");
    if (!requested_.depths) return;
    conversion_.z.numerator = -conversion_.z.numerator;
    keeps_no_vertical_part_ = true;
    warn(depths_warning(stated, is_coded_depth, system));
  }

  std::string depths_warning(bool stated, bool is_coded_depth,
                             const std::optional<CodedSystem>& system) {
    std::string text = "depths are turned into heights";
    if (is_coded_depth) {
      text += ": " + code_text(all_.vertical_epsg) +
              (system->heights != 0 ? " becomes " + code_text(system->heights)
                                    : ", which has no system of heights, is not noted");
      all_.vertical_epsg = system->heights;
    } else if (!stated && file_.vertical_epsg != 0) {
      text += "; the file says heights (" + code_text(file_.vertical_epsg) + ")";
    }
    return text;
  }

  const Reference &file_, &requested_;
  Reference all_;
  Conversion conversion_;
  bool keeps_no_vertical_part_ = false;  // of well-known text, as it says something else
};

}  // namespace

SettledReference settle(const Reference& file, const Reference& requested) {
  return Settlement(file, requested).settle();
}

Reference completed(Reference reference) {
  const auto warn = [&](const std::string& text) { reference.warnings.push_back(text); };
  if (reference.horizontal_unit == Unit::kUnknown) {
    const uint32_t code = reference.horizontal_epsg;
    warn(code == 0
             ? "the unit of x and y is not known: set units or an EPSG code"
             : "the unit of x and y is not known, nor is " + code_text(code) + " here: set units");
  }
  if (reference.vertical_unit != Unit::kUnknown) return reference;
  if (reference.horizontal_unit == Unit::kDegree) {
    throw Error(
        "positions are in degrees, and the unit of heights is not known: set units, degree:metre "
        "or degree:foot, or a vertical code, as in EPSG 4326:5773");
  }
  reference.vertical_unit = reference.horizontal_unit;
  if (reference.vertical_unit == Unit::kFoot || reference.vertical_unit == Unit::kUsSurveyFoot) {
    warn("heights are taken as " + text_of(reference.vertical_unit) +
         ", as x and y are; if they are not, set units, such as :metre");
  }
  return reference;
}

void expect_same_horizontal_system(const Reference& file, const Reference& terrain) {
  const Unit there = file.horizontal_unit, here = terrain.horizontal_unit;
  if (there != here && there != Unit::kUnknown && here != Unit::kUnknown) {
    throw Error("its x and y are in the unit " + text_of(there) + ", and those of the terrain in " +
                text_of(here) + "; bring it into the terrain's system");
  }
  const uint32_t code = file.horizontal_epsg, own = terrain.horizontal_epsg;
  if (code != own && code != 0 && own != 0) {
    throw Error("is in " + code_text(code) + ", and the terrain in " + code_text(own) +
                "; bring it into the terrain's system");
  }
}

bool read_units(const std::string& text, Reference& requested) {
  const size_t colon = text.find(':');
  const auto is_known = [](const StatedUnit& unit) {
    return unit.unit != Unit::kUnknown || length_named(unit.other) != nullptr;
  };
  if (colon != 0) {
    const StatedUnit unit = unit_named(text.substr(0, colon));
    if (!is_known(unit)) return false;
    state_horizontal_unit(unit, requested);
  }
  requested.one_unit = colon == std::string::npos;
  if (requested.one_unit) return true;
  const StatedUnit unit = unit_named(text.substr(colon + 1));
  if (!is_known(unit) || unit.unit == Unit::kDegree) return false;
  state_vertical_unit(unit, requested);
  return true;
}

void state_horizontal_unit(const StatedUnit& unit, Reference& reference) {
  if (!unit.is_stated()) return;
  reference.horizontal_unit = unit.unit;
  reference.horizontal_other = unit.other;
}

void state_vertical_unit(const StatedUnit& unit, Reference& reference) {
  if (!unit.is_stated()) return;
  const bool is_angle = unit.unit == Unit::kDegree;
  reference.vertical_unit = is_angle ? Unit::kUnknown : unit.unit;
  reference.vertical_other = is_angle ? text_of(unit.unit) : unit.other;
}

void add_statements(const Reference& from, Reference& to) {
  std::vector<std::string> warnings = from.warnings;
  for (std::string& text : terrain::join(from.notes, to.notes)) warnings.push_back(std::move(text));
  for (const std::string& warn : warnings) {
    if (std::find(to.warnings.begin(), to.warnings.end(), warn) == to.warnings.end()) {
      to.warnings.push_back(warn);
    }
  }
}

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
    if (is_height(height)) multiplier.apply(height);
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

void settle_source(Source& source, const Reference& requested) {
  convert(source, settle(terrain::reference_of(source), requested));
}

void settle_source(OpenSource& source, const Reference& requested) {
  auto* const raster = std::get_if<std::unique_ptr<RasterReader>>(&source);
  if (raster != nullptr) {
    SettledReference settled = settle((*raster)->frame().reference, requested);
    *raster = std::make_unique<ConvertedRaster>(std::move(*raster), std::move(settled));
    return;
  }
  Source cloud = std::move(std::get<PointCloud>(source));
  settle_source(cloud, requested);
  source = std::move(std::get<PointCloud>(cloud));
}

}  // namespace microtin::importing
