// SPDX-License-Identifier: MIT
// The page that encoder/viewer makes, as the program holds it.
#ifndef MICROTIN_ENCODER_PICTURE_VIEWER_PAGE_HPP
#define MICROTIN_ENCODER_PICTURE_VIEWER_PAGE_HPP

#include <string_view>

namespace microtin::picture {

// With @TITLE@ and other places to be filled; empty if it could not be built.
std::string_view viewer_page();

// The tools that were missing then.
std::string_view viewer_wants();

}  // namespace microtin::picture

#endif
