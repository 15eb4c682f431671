// SPDX-License-Identifier: MIT
// Options as names and texts, for callers whose options are texts.
#include <cerrno>
#include <cstdlib>
#include <string>
#include <type_traits>

#include "encoder/base/error.hpp"
#include "microtin/encoder.hpp"

namespace microtin::encoder {
namespace {

template <auto member>
bool set_text(Options& options, const std::string& text) {
  options.*member = text;
  return true;
}

template <auto member>
bool set_flag(Options& options, const std::string& text) {
  options.*member = text == "true";
  return text == "true" || text == "false";
}

template <auto member>
bool set_number(Options& options, const std::string& text) {
  const bool is_number = !text.empty() && text.find_first_not_of("0123456789") == text.npos;
  errno = 0;
  const unsigned long long number = std::strtoull(text.c_str(), nullptr, 10);
  options.*member = static_cast<uint32_t>(number);
  return is_number && errno == 0 && number <= UINT32_MAX;
}

// The choices in the order of their enumerators.
template <auto member, const char* const* names, int count>
bool set_choice(Options& options, const std::string& text) {
  for (int i = 0; i < count; ++i) {
    if (text != names[i]) continue;
    using Choice = std::remove_reference_t<decltype(options.*member)>;
    options.*member = static_cast<Choice>(i);
    return true;
  }
  return false;
}

constexpr const char* kEfforts[] = {"fast", "normal", "best"};
constexpr const char* kCodings[] = {"quick", "balanced", "dense"};
constexpr const char* kPlaces[] = {"points", "lattice", "everywhere"};
constexpr const char* kSurfaces[] = {"unknown", "ground", "top", "bed", "geoid", "obstacles"};
constexpr const char* kSides[] = {"", "both", "never_below", "never_above"};
constexpr const char* kRules[] = {"middle", "lowest", "highest", "mean"};

struct NamedOption {
  const char* name;
  bool (*set)(Options& options, const std::string& text);
  const char* wanted;
};

constexpr const char *kText = "a text", *kFlag = "true or false",
                     *kNumber = "a whole number below 2^32";

constexpr NamedOption kOptions[] = {
    {"max_error", set_text<&Options::max_error>, kText},
    {"error_map", set_text<&Options::error_map>, kText},
    {"area", set_text<&Options::area>, kText},
    {"route", set_text<&Options::route>, kText},
    {"route_width", set_text<&Options::route_width>, kText},
    {"route_edge_error", set_text<&Options::route_edge_error>, kText},
    {"breaklines", set_text<&Options::breaklines>, kText},
    {"obstacles", set_text<&Options::obstacles>, kText},
    {"max_vertices", set_number<&Options::max_vertices>, kNumber},
    {"max_bytes", set_number<&Options::max_bytes>, kNumber},
    {"never_below", set_flag<&Options::never_below>, kFlag},
    {"z_step", set_text<&Options::z_step>, kText},
    {"xy_step", set_text<&Options::xy_step>, kText},
    {"bound_at", set_choice<&Options::bound_at, kPlaces, 3>, "points, lattice or everywhere"},
    {"duplicates", set_choice<&Options::duplicates, kRules, 4>, "middle, lowest, highest or mean"},
    {"effort", set_choice<&Options::effort, kEfforts, 3>, "fast, normal or best"},
    {"coding", set_choice<&Options::coding, kCodings, 3>, "quick, balanced or dense"},
    {"max_degree", set_number<&Options::max_degree>, kNumber},
    {"tile_vertices", set_number<&Options::tile_vertices>, kNumber},
    {"tile_size", set_number<&Options::tile_size>, kNumber},
    {"units", set_text<&Options::units>, kText},
    {"depths", set_flag<&Options::depths>, kFlag},
    {"horizontal_epsg", set_number<&Options::horizontal_epsg>, kNumber},
    {"vertical_epsg", set_number<&Options::vertical_epsg>, kNumber},
    {"surface", set_choice<&Options::surface, kSurfaces, 6>,
     "ground, top, bed, geoid, obstacles or unknown"},
    {"source_name", set_text<&Options::source_name>, kText},
    {"date", set_text<&Options::date>, kText},
    {"lineage", set_text<&Options::lineage>, kText},
    {"attribution", set_text<&Options::attribution>, kText},
    {"license", set_text<&Options::license>, kText},
    {"valid", set_text<&Options::valid>, kText},
    {"epoch", set_text<&Options::epoch>, kText},
    {"source_accuracy", set_text<&Options::source_accuracy>, kText},
    {"digest", set_flag<&Options::digest>, kFlag},
    {"phases", set_flag<&Options::phases>, kFlag},
};

}  // namespace

const char* name_of(SurfaceKind kind) {
  return kSurfaces[static_cast<size_t>(kind)];
}

const char* name_of(BoundSide side) {
  return kSides[static_cast<size_t>(side)];
}

void set_option(Options& options, const std::string& name, const std::string& value) {
  for (const NamedOption& option : kOptions) {
    if (name != option.name) continue;
    if (option.set(options, value)) return;
    throw base::Error(base::parameter(name) + ": '" + value + "' is not allowed; use " +
                      option.wanted);
  }
  throw base::Error("there is no option " + base::parameter(name));
}

}  // namespace microtin::encoder
