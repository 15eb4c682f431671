// SPDX-License-Identifier: MIT
// Units of coordinates by name and by length.
#ifndef MICROTIN_ENCODER_EXACT_UNITS_HPP
#define MICROTIN_ENCODER_EXACT_UNITS_HPP

#include <optional>
#include <string_view>

#include "encoder/exact/metadata.hpp"
#include "encoder/layers.hpp"

namespace microtin::exact {

// "metre", "US survey foot", "unknown".
std::string_view name_of(Unit unit);

// "m", "ft"; empty if it is not known or of no fixed length.
std::string_view symbol_of(Unit unit);

// As files and people write it, in any case: m, metre, meters, deg, degree, ft, foot, feet, us-ft,
// us-foot, US survey foot, ...
std::optional<Unit> unit_named(std::string_view name);

// Nothing if it is not known or of no fixed length.
std::optional<double> metres_per(Unit unit);

// The unit of that many metres, within 10^-7 of them: files round the US survey foot.
Unit unit_of_metres(double metres);

}  // namespace microtin::exact

#endif
