// SPDX-License-Identifier: MIT
// The page that encoder/viewer makes, as the program holds it.
#ifndef MICROTIN_ENCODER_PICTURE_VIEWER_PAGE_HPP
#define MICROTIN_ENCODER_PICTURE_VIEWER_PAGE_HPP

#include <string_view>

namespace microtin::picture {

// With @TITLE@ and other places to be filled; empty if the build left the page out.
std::string_view viewer_page();

// Why the build left the page out; empty if it has the page.
std::string_view viewer_absence();

}  // namespace microtin::picture

#endif
