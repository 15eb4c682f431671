// SPDX-License-Identifier: MIT
// Names and errors of Windows as the other sources know them: UTF-8 and errno. Included by the
// sources for Windows alone.
#ifndef MICROTIN_ENCODER_FILES_WINDOWS_NAMES_HPP
#define MICROTIN_ENCODER_FILES_WINDOWS_NAMES_HPP

#define WIN32_LEAN_AND_MEAN
#ifndef NOMINMAX
#define NOMINMAX
#endif
#include <windows.h>
// It needs windows.h.
#include <shellapi.h>

#include <string>

#include "encoder/layers.hpp"

namespace microtin::files {

// Text that is not UTF-8, or not UTF-16, becomes an empty one, which is the name of no file.
std::wstring wide(const std::string& text);
std::string narrow(const std::wstring& text);

// Sets errno to what the last failed call of Windows means.
void set_errno();

}  // namespace microtin::files

#endif
