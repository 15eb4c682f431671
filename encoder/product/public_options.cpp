// SPDX-License-Identifier: MIT
#include "encoder/product/public_options.hpp"

#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/import/breaklines.hpp"
#include "encoder/import/reference.hpp"
#include "encoder/product/named_options.hpp"

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

// The units and systems that are asked for.
Reference asked_of(const encoder::Options& options) {
  Reference asked;
  asked.horizontal_epsg = options.horizontal_epsg;
  asked.vertical_epsg = options.vertical_epsg;
  asked.depths = options.depths;
  if (!options.units.empty()) read_units(options.units, asked);
  return asked;
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

void take_breaklines(const encoder::Options& options, EncodeOptions& all) {
  if (options.breaklines.empty()) return;
  BreaklineFile read = read_breaklines(options.breaklines);
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
  preparation.asked = asked_of(options);
  return preparation;
}

}  // namespace microtin::product
