// SPDX-License-Identifier: MIT
// Puts together what is known of units and systems, and says what is not.
#include "encoder/product/reference.hpp"

#include <optional>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/exact/units.hpp"
#include "encoder/import/epsg.hpp"

namespace microtin::product {
namespace {

std::string text_of(Unit unit) {
  return std::string(name_of(unit));
}

// One of both kinds of systems, by its code and its unit.
struct System {
  uint32_t code;
  Unit unit;
};

class Settlement {
 public:
  // What the codes and units that are asked for say together.
  System asked(bool is_vertical, System wanted) {
    if (wanted.code == 0) return wanted;
    const std::string name = "EPSG " + std::to_string(wanted.code);
    const std::optional<CodedSystem> system = system_of_code(wanted.code);
    if (!system) {
      remarks_.push_back(name + " is not among the codes known here, and is taken as it is" +
                         (wanted.unit == Unit::kUnknown ? ": give its units" : ""));
      return wanted;
    }
    if (system->is_vertical != is_vertical) {
      throw Error(name + (is_vertical ? " is a horizontal system" : " is a vertical system") +
                  ": codes are given as HORIZONTAL:VERTICAL");
    }
    if (wanted.unit != Unit::kUnknown && wanted.unit != system->unit) {
      throw Error(name + " has the unit " + text_of(system->unit) + ", not " +
                  text_of(wanted.unit));
    }
    return {wanted.code, system->unit};
  }

  // Which of the file's codes and units give way is told.
  uint32_t chosen(uint32_t asked, uint32_t file) {
    if (asked == 0) return file;
    if (file != 0 && file != asked) {
      remarks_.push_back("EPSG " + std::to_string(asked) + " is taken; the file says EPSG " +
                         std::to_string(file));
    }
    return asked;
  }

  Unit chosen(const char* what, Unit asked, Unit file) {
    if (asked == Unit::kUnknown) return file;
    if (file != Unit::kUnknown && file != asked) {
      remarks_.push_back(std::string(what) + " are taken as " + text_of(asked) +
                         "; the file says " + text_of(file));
    }
    return asked;
  }

  void complete(Reference& reference) {
    if (reference.horizontal_unit == Unit::kUnknown) {
      const uint32_t code = reference.horizontal_epsg;
      remarks_.push_back(code == 0 ? "the unit of x and y is not known: give units or an EPSG code"
                                   : "the unit of x and y is not known, nor is EPSG " +
                                         std::to_string(code) + " here: give units");
    }
    if (reference.vertical_unit != Unit::kUnknown) return;
    if (reference.horizontal_unit == Unit::kDegree) {
      throw Error(
          "places are degrees, and the unit of heights is not known: give units, degree:metre or "
          "degree:foot, or a vertical code, as in EPSG 4326:5773");
    }
    reference.vertical_unit = reference.horizontal_unit;
    if (reference.vertical_unit == Unit::kUnknown) return;
    const Unit other = reference.vertical_unit == Unit::kMetre ? Unit::kFoot : Unit::kMetre;
    remarks_.push_back("heights are taken as " + text_of(reference.vertical_unit) +
                       ", as x and y are; if they are not, give units, such as :" + text_of(other));
  }

  std::vector<std::string> take_remarks() { return std::move(remarks_); }

 private:
  std::vector<std::string> remarks_;
};

}  // namespace

SettledReference settle(const Reference& file, const Reference& asked) {
  Settlement settlement;
  const System xy = settlement.asked(false, {asked.horizontal_epsg, asked.horizontal_unit});
  const System z = settlement.asked(true, {asked.vertical_epsg, asked.vertical_unit});
  Reference all = file;
  if (xy.code != 0) all.wkt.clear();
  all.horizontal_epsg = settlement.chosen(xy.code, file.horizontal_epsg);
  all.vertical_epsg = settlement.chosen(z.code, file.vertical_epsg);
  all.horizontal_unit = settlement.chosen("x and y", xy.unit, file.horizontal_unit);
  all.vertical_unit = settlement.chosen("heights", z.unit, file.vertical_unit);
  settlement.complete(all);
  return {std::move(all), settlement.take_remarks()};
}

bool read_units(const std::string& text, Reference& asked) {
  const size_t colon = text.find(':');
  const std::string horizontal = text.substr(0, colon);
  if (colon == std::string::npos || !horizontal.empty()) {
    const std::optional<Unit> unit = unit_named(horizontal);
    if (!unit) return false;
    asked.horizontal_unit = *unit;
  }
  if (colon == std::string::npos) return true;
  const std::optional<Unit> unit = unit_named(text.substr(colon + 1));
  if (!unit || *unit == Unit::kDegree) return false;
  asked.vertical_unit = *unit;
  return true;
}

}  // namespace microtin::product
