// SPDX-License-Identifier: MIT
// Converts names between UTF-8 and UTF-16, and numbers of errors of Windows to errno.
#include "encoder/files/windows_names.hpp"

#include <cerrno>
#include <system_error>

namespace microtin::files {

std::wstring wide(const std::string& text) {
  const int size = static_cast<int>(text.size());  // names have at most 32,767 characters
  std::wstring result(static_cast<size_t>(MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS,
                                                              text.data(), size, nullptr, 0)),
                      L'\0');
  MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, text.data(), size, result.data(),
                      static_cast<int>(result.size()));
  return result;
}

std::string narrow(const std::wstring& text) {
  const int size = static_cast<int>(text.size());
  std::string result(
      static_cast<size_t>(WideCharToMultiByte(CP_UTF8, WC_ERR_INVALID_CHARS, text.data(), size,
                                              nullptr, 0, nullptr, nullptr)),
      '\0');
  WideCharToMultiByte(CP_UTF8, WC_ERR_INVALID_CHARS, text.data(), size, result.data(),
                      static_cast<int>(result.size()), nullptr, nullptr);
  return result;
}

void set_errno() {
  const std::error_code error(static_cast<int>(GetLastError()), std::system_category());
  const std::error_condition known = error.default_error_condition();
  errno = known.category() == std::generic_category() ? known.value() : EIO;
}

}  // namespace microtin::files
