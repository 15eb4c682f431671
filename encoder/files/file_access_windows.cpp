// SPDX-License-Identifier: MIT
// The calls on files, by the names that Windows gives them; names and numbers of errors, converted.
#include <fcntl.h>
#include <io.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "encoder/files/file_access.hpp"
#include "encoder/files/windows_names.hpp"

namespace microtin::files {
namespace {

constexpr DWORD kShareAll = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;

HANDLE handle_of(int file) {
  return reinterpret_cast<HANDLE>(_get_osfhandle(file));
}

// A descriptor that owns the handle, or -1.
int descriptor_of(HANDLE handle, int access) {
  if (handle == INVALID_HANDLE_VALUE) {
    set_errno();
    return -1;
  }
  const int file =
      _open_osfhandle(reinterpret_cast<intptr_t>(handle), access | _O_BINARY | _O_NOINHERIT);
  if (file < 0) CloseHandle(handle);
  return file;
}

// A handle that lets others remove and rename the file, as POSIX does.
int open_there(const std::string& path, DWORD rights, int access) {
  return descriptor_of(CreateFileW(wide(path).c_str(), rights, kShareAll, nullptr, OPEN_EXISTING,
                                   FILE_ATTRIBUTE_NORMAL, nullptr),
                       access);
}

uint64_t joined(DWORD high, DWORD low) {
  return static_cast<uint64_t>(high) << 32 | low;
}

bool take_state(HANDLE handle, FileState& state) {
  state = {};
  const DWORD type = GetFileType(handle);
  if (type == FILE_TYPE_UNKNOWN) {
    set_errno();
    return false;
  }
  if (type != FILE_TYPE_DISK) return true;
  BY_HANDLE_FILE_INFORMATION found{};
  if (GetFileInformationByHandle(handle, &found) == 0) {
    set_errno();
    return false;
  }
  state.is_regular = (found.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) == 0;
  state.size = joined(found.nFileSizeHigh, found.nFileSizeLow);
  state.volume = found.dwVolumeSerialNumber;
  state.number = joined(found.nFileIndexHigh, found.nFileIndexLow);
  return true;
}

}  // namespace

std::FILE* open_stream(const std::string& path, const char* mode) {
  const std::string all =
      std::string(mode) + (std::string(mode).find('b') == std::string::npos ? "b" : "");
  return _wfopen(wide(path).c_str(), wide(all).c_str());
}

int open_to_read(const std::string& path) {
  return open_there(path, GENERIC_READ, _O_RDONLY);
}

int open_to_write(const std::string& path) {
  return open_there(path, GENERIC_WRITE, _O_WRONLY);
}

// Another thread may remove the file while it is open: the one that Ctrl-C starts.
int create_file(const std::string& path, NewFile kind) {
  const bool is_nameless = kind == NewFile::kNameless;
  const DWORD rights = GENERIC_WRITE | (is_nameless ? GENERIC_READ | DELETE : 0);
  const DWORD flags = is_nameless ? FILE_ATTRIBUTE_TEMPORARY | FILE_FLAG_DELETE_ON_CLOSE
                                  : static_cast<DWORD>(FILE_ATTRIBUTE_NORMAL);
  return descriptor_of(
      CreateFileW(wide(path).c_str(), rights, kShareAll, nullptr, CREATE_NEW, flags, nullptr),
      is_nameless ? _O_RDWR : _O_WRONLY);
}

bool examine(int file, FileState& state) {
  return take_state(handle_of(file), state);
}

bool examine(const std::string& path, FileState& state) {
  const HANDLE handle = CreateFileW(wide(path).c_str(), FILE_READ_ATTRIBUTES, kShareAll, nullptr,
                                    OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, nullptr);
  if (handle == INVALID_HANDLE_VALUE) {
    set_errno();
    return false;
  }
  const bool is_known = take_state(handle, state);
  CloseHandle(handle);
  return is_known;
}

bool lists_descriptors(const std::filesystem::path&) {
  return false;
}

int duplicate(int file) {
  return _dup(file);
}

void close_file(int file) {
  _close(file);
}

// The folder's rules decide who may read a new file.
bool take_after(int, const FileState&) {
  return true;
}

int64_t read_at(int file, uint64_t offset, void* to, std::size_t size) {
  constexpr std::size_t kMost = std::size_t{1} << 30;  // a DWORD holds it
  OVERLAPPED where{};
  where.Offset = static_cast<DWORD>(offset);
  where.OffsetHigh = static_cast<DWORD>(offset >> 32);
  DWORD taken = 0;
  const auto wanted = static_cast<DWORD>(std::min(size, kMost));
  if (ReadFile(handle_of(file), to, wanted, &taken, &where) != 0) return taken;
  if (GetLastError() == ERROR_HANDLE_EOF) return 0;
  set_errno();
  return -1;
}

bool seek_to(std::FILE* stream, uint64_t offset) {
  return _fseeki64(stream, static_cast<int64_t>(offset), SEEK_SET) == 0;
}

bool replace_file(const std::string& from, const std::string& to) {
  if (MoveFileExW(wide(from).c_str(), wide(to).c_str(), MOVEFILE_REPLACE_EXISTING) != 0)
    return true;
  set_errno();
  return false;
}

void remove_file(const std::string& path) {
  DeleteFileW(wide(path).c_str());
}

std::FILE* open_temporary_stream() {
  wchar_t folder[MAX_PATH + 1];
  const DWORD size = GetTempPathW(MAX_PATH + 1, folder);
  if (size == 0 || size > MAX_PATH) {
    errno = ENOENT;
    return nullptr;
  }
  const std::string stem =
      narrow({folder, size}) + "microtin-" + std::to_string(process_number()) + "-";
  for (int i = 0;; ++i) {
    const int file = create_file(stem + std::to_string(i), NewFile::kNameless);
    if (file >= 0) return _fdopen(file, "w+b");
    if (errno != EEXIST || i == 1000) return nullptr;
  }
}

uint64_t process_number() {
  return GetCurrentProcessId();
}

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
