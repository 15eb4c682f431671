// SPDX-License-Identifier: MIT
// A terrain as a web page that shows it: one file, which needs nothing else.
#ifndef MICROTIN_ENCODER_PICTURE_PAGE_HPP
#define MICROTIN_ENCODER_PICTURE_PAGE_HPP

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "encoder/picture/render.hpp"

namespace microtin::picture {

// With @TITLE@ and other places to be filled; empty if the build left the page out.
std::string_view viewer_page();

// Why the build left the page out; empty if it has the page.
std::string_view viewer_absence();

constexpr uint64_t kLargestPage = 100'000'000;  // bytes of a terrain

// The page of a terrain in a file with the given content; `flat` is a PNG for browsers that cannot
// draw. Throws Error if the program was built without the page, and for larger files.
std::string render_page(const Portrait& portrait, const std::string& title, const std::string& file,
                        const std::vector<uint8_t>& flat);

}  // namespace microtin::picture

#endif
