// SPDX-License-Identifier: MIT
// Reads and checks the public options, and translates them.
#include "encoder/product/public_options.hpp"

#include <cerrno>
#include <cstdlib>
#include <iterator>
#include <optional>
#include <type_traits>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/base/text.hpp"
#include "encoder/exact/decimal.hpp"
#include "encoder/import/breaklines.hpp"
#include "encoder/import/reference.hpp"
#include "encoder/pack/encode.hpp"
#include "encoder/terrain/source_notes.hpp"
#include "microtin/microtin.h"
#include "shared/format.hpp"

namespace microtin::product {
namespace {

// A number that check_options has seen, or nothing for an empty text.
std::optional<Decimal> decimal_of(const std::string& text) {
  return text.empty() ? std::nullopt : parse_decimal(text);
}

Search search_of(encoder::SearchEffort effort) {
  switch (effort) {
    case encoder::SearchEffort::kFast:
      return Search::kFast;
    case encoder::SearchEffort::kBest:
      return Search::kBest;
    case encoder::SearchEffort::kNormal:
      break;
  }
  return Search::kNormal;
}

Coding coding_of(encoder::Coding coding) {
  switch (coding) {
    case encoder::Coding::kQuick:
      return Coding::kQuick;
    case encoder::Coding::kDense:
      return Coding::kDense;
    case encoder::Coding::kBalanced:
      break;
  }
  return Coding::kBalanced;
}

BoundScope places_of(encoder::BoundAt bound_at) {
  switch (bound_at) {
    case encoder::BoundAt::kLattice:
      return BoundScope::kLattice;
    case encoder::BoundAt::kEverywhere:
      return BoundScope::kEverywhere;
    case encoder::BoundAt::kPoints:
      break;
  }
  return BoundScope::kTruePlaces;
}

DuplicateRule rule_of(encoder::Duplicates duplicates) {
  switch (duplicates) {
    case encoder::Duplicates::kLowest:
      return DuplicateRule::kLowest;
    case encoder::Duplicates::kHighest:
      return DuplicateRule::kHighest;
    case encoder::Duplicates::kMean:
      return DuplicateRule::kMean;
    case encoder::Duplicates::kMiddle:
      break;
  }
  return DuplicateRule::kMiddle;
}

SurfaceKind surface_of(encoder::SurfaceKind surface) {
  return static_cast<SurfaceKind>(surface);  // the same numbers, those of the note
}

SourceNotes notes_of(const encoder::Options& options) {
  return {options.source_name,
          options.date,
          options.lineage,
          options.attribution,
          options.license,
          options.valid,
          parse_epoch(options.epoch),
          parse_source_accuracy(options.source_accuracy)};
}

// The units and systems that are requested.
Reference requested_of(const encoder::Options& options) {
  Reference requested;
  requested.horizontal_epsg = options.horizontal_epsg;
  requested.vertical_epsg = options.vertical_epsg;
  requested.depths = options.depths;
  if (!options.units.empty()) read_units(options.units, requested);
  return requested;
}

}  // namespace

EncodeOptions options_of(const encoder::Options& options) {
  check_options(options);
  EncodeOptions all;
  all.lattice.max_error = decimal_of(options.max_error);
  all.lattice.z_step = decimal_of(options.z_step);
  all.lattice.xy_step = decimal_of(options.xy_step);
  all.lattice.never_below = options.never_below;
  all.lattice.duplicates = rule_of(options.duplicates);
  all.max_vertices = options.max_vertices;
  all.max_bytes = options.max_bytes;
  all.tile_vertices = options.tile_vertices;
  all.tile_size = options.tile_size;
  all.lattice.bound_at = places_of(options.bound_at);
  all.search = search_of(options.effort);
  all.effort = {options.max_degree, coding_of(options.coding)};
  all.surface = surface_of(options.surface);
  all.digest = options.digest;
  all.phases = options.phases;
  all.notes = notes_of(options);
  return all;
}

void take_breaklines(const encoder::Options& options, const FeatureFiles& files,
                     EncodeOptions& all) {
  if (options.breaklines.empty()) return;
  BreaklineFile read = read_breaklines(options.breaklines, files);
  all.lattice.breaklines = std::move(read.lines);
  all.lattice.line_classes = std::move(read.classes);
}

Preparation preparation_of(const encoder::Options& options, Preparation preparation) {
  if (options.route.empty() != options.route_width.empty()) {
    throw Error(parameter("route") + " and " + parameter("route_width") + " go together; set both");
  }
  if (!options.route_edge_error.empty() && options.route.empty()) {
    throw Error(parameter("route_edge_error") + " needs " + parameter("route"));
  }
  preparation.max_error = decimal_of(options.max_error);
  preparation.error_map = options.error_map;
  preparation.area = options.area;
  preparation.route = options.route;
  preparation.route_width = decimal_of(options.route_width);
  preparation.route_edge_error = decimal_of(options.route_edge_error);
  preparation.obstacles = options.obstacles;
  preparation.breaklines = options.breaklines;
  preparation.requested = requested_of(options);
  return preparation;
}

namespace {

using encoder::Options;
using Table = std::vector<NamedOption>;

template <auto member>
constexpr NamedOption::Choice kChoice = {
    [](const Options& options) { return static_cast<uint32_t>(options.*member); },
    [](Options& options, uint32_t number) {
      options.*member = static_cast<std::remove_reference_t<decltype(options.*member)>>(number);
    }};

NamedOption text(const char* name, std::string Options::*member) {
  NamedOption option{name};
  option.text = member;
  return option;
}

NamedOption text(const char* name, std::string Options::*member,
                 bool (*is_allowed)(const std::string&), const char* wanted) {
  NamedOption option = text(name, member);
  option.is_allowed = is_allowed;
  option.wanted = wanted;
  return option;
}

NamedOption file(const char* name, std::string Options::*member) {
  NamedOption option = text(name, member);
  option.is_file = true;
  option.wanted = "the name of a file";
  return option;
}

NamedOption decimal(const char* name, std::string Options::*member) {
  const auto is_decimal = [](const std::string& value) {
    const std::optional<Decimal> number = parse_decimal(value);
    return number && number->mantissa >= 0;
  };
  return text(name, member, is_decimal, "a decimal number from 0 up");
}

NamedOption flag(const char* name, bool Options::*member) {
  NamedOption option{name};
  option.flag = member;
  return option;
}

NamedOption number(const char* name, uint32_t Options::*member, uint32_t least, uint32_t most) {
  NamedOption option{name};
  option.number = member;
  option.least = least;
  option.most = most;
  return option;
}

template <auto member>
NamedOption choice(const char* name, std::vector<std::string> words) {
  NamedOption option{name};
  option.choice = &kChoice<member>;
  option.words = std::move(words);
  return option;
}

constexpr const char* kSurfaces[] = {"unknown", "ground", "top", "bed", "geoid", "obstacles"};

Table surface_options() {
  return {
      decimal("max_error", &Options::max_error),
      file("error_map", &Options::error_map),
      file("area", &Options::area),
      file("route", &Options::route),
      decimal("route_width", &Options::route_width),
      decimal("route_edge_error", &Options::route_edge_error),
      file("breaklines", &Options::breaklines),
      file("obstacles", &Options::obstacles),
      number("max_vertices", &Options::max_vertices, 3, kMaxVertices),
      number("max_bytes", &Options::max_bytes, 1, UINT32_MAX),
      flag("never_below", &Options::never_below),
      decimal("z_step", &Options::z_step),
      decimal("xy_step", &Options::xy_step),
      choice<&Options::bound_at>("bound_at", {"points", "lattice", "everywhere"}),
      choice<&Options::duplicates>("duplicates", {"middle", "lowest", "highest", "mean"}),
      choice<&Options::effort>("effort", {"fast", "normal", "best"}),
      choice<&Options::coding>("coding", {"quick", "balanced", "dense"}),
      number("max_degree", &Options::max_degree, kMinDegree, kMaxDegree),
      number("tile_vertices", &Options::tile_vertices, pack::kFewestTileVertices, kMaxVertices),
      number("tile_size", &Options::tile_size, 1, kLatticeMax),
  };
}

Table reference_options() {
  const auto is_unit = [](const std::string& value) {
    Reference requested;
    return read_units(value, requested);
  };
  return {
      text("units", &Options::units, is_unit,
           "a unit, or two with a colon, such as metre, degree:metre or :foot"),
      flag("depths", &Options::depths),
      number("horizontal_epsg", &Options::horizontal_epsg, 1, UINT32_MAX),
      number("vertical_epsg", &Options::vertical_epsg, 1, UINT32_MAX),
  };
}

Table note_options() {
  const auto is_date = [](const std::string& value) { return is_iso_date(value); };
  const auto is_validity = [](const std::string& value) { return is_iso_validity(value); };
  const auto is_epoch = [](const std::string& value) { return parse_epoch(value).has_value(); };
  const auto is_accuracy = [](const std::string& value) {
    return parse_source_accuracy(value).has_value();
  };
  return {
      choice<&Options::surface>("surface", {std::begin(kSurfaces), std::end(kSurfaces)}),
      text("source_name", &Options::source_name),
      text("date", &Options::date, is_date, "a date such as 2026, 2026-11 or 2026-11-21"),
      text("lineage", &Options::lineage),
      text("attribution", &Options::attribution),
      text("license", &Options::license),
      text("valid", &Options::valid, is_validity,
           "dates such as 2024-01/2025-06, 2024-01/.. or ../2025"),
      text("epoch", &Options::epoch, is_epoch, "a year such as 2020.5"),
      text("source_accuracy", &Options::source_accuracy, is_accuracy,
           "LE90, LE95 or RMSE and a number, such as 'LE90 4'"),
      flag("digest", &Options::digest),
      flag("phases", &Options::phases),
  };
}

const Table& all_options() {
  static const Table all = [] {
    Table options = surface_options();
    for (const Table& more : {reference_options(), note_options()}) {
      options.insert(options.end(), more.begin(), more.end());
    }
    return options;
  }();
  return all;
}

bool set_number(uint32_t& number, const std::string& value) {
  const bool is_number = !value.empty() && value.find_first_not_of("0123456789") == value.npos;
  errno = 0;
  const unsigned long long read = std::strtoull(value.c_str(), nullptr, 10);
  number = static_cast<uint32_t>(read);
  return is_number && errno == 0 && read <= UINT32_MAX;
}

void check(const NamedOption& option, const Options& options) {
  const auto expect = [&](bool holds, const std::string& rule) {
    if (!holds) throw Error(parameter(option.name) + rule);
  };
  if (option.number != nullptr) {
    const uint32_t value = options.*option.number;
    expect(value == 0 || (value >= option.least && value <= option.most),
           ": use " + std::to_string(option.least) + " to " + std::to_string(option.most) +
               ", or 0 for the default");
  } else if (option.text != nullptr && option.is_allowed != nullptr) {
    const std::string& value = options.*option.text;
    expect(value.empty() || option.is_allowed(value),
           ": '" + value + "' is not allowed; use " + option.wanted);
  }
}

}  // namespace

std::string alternatives(const std::vector<std::string>& names) {
  std::string text;
  for (size_t i = 0; i < names.size(); ++i) {
    if (i != 0) text += i + 1 == names.size() ? " or " : ", ";
    text += names[i];
  }
  return text;
}

const NamedOption& named_option(std::string_view name) {
  for (const NamedOption& option : all_options()) {
    if (name == option.name) return option;
  }
  throw Error("there is no option " + parameter(std::string(name)));
}

std::string wanted_by(const NamedOption& option) {
  if (option.choice != nullptr) return alternatives(option.words);
  if (option.flag != nullptr) return "true or false";
  if (option.number != nullptr) return "a whole number below 2^32";
  return option.wanted == nullptr ? "a text" : option.wanted;
}

bool set(const NamedOption& option, Options& options, const std::string& value) {
  if (option.number != nullptr) return set_number(options.*option.number, value);
  if (option.flag != nullptr) {
    options.*option.flag = value == "true";
    return value == "true" || value == "false";
  }
  if (option.text != nullptr) {
    options.*option.text = value;
    return value.empty() ? !option.is_file
                         : option.is_allowed == nullptr || option.is_allowed(value);
  }
  for (uint32_t i = 0; i < option.words.size(); ++i) {
    if (value != option.words[i]) continue;
    option.choice->set(options, i);
    return true;
  }
  return false;
}

void check_options(const Options& options) {
  for (const NamedOption& option : all_options()) check(option, options);
}

}  // namespace microtin::product

namespace microtin::encoder {

const char* name_of(SurfaceKind kind) {
  return product::kSurfaces[static_cast<size_t>(kind)];
}

const char* name_of(BoundSide side) {
  constexpr const char* kSides[] = {"", "both", "never_below", "never_above"};
  return kSides[static_cast<size_t>(side)];
}

void set_option(Options& options, const std::string& name, const std::string& value) {
  const product::NamedOption& option = product::named_option(name);
  if (product::set(option, options, value)) return;
  throw base::Error(base::parameter(name) + ": '" + value + "' is not allowed; use " +
                    product::wanted_by(option));
}

}  // namespace microtin::encoder
