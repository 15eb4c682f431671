// SPDX-License-Identifier: MIT
// What a process gets from Windows, and what Ctrl-C does.
#include <fcntl.h>
#include <io.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>

#include "encoder/files/process.hpp"
#include "encoder/files/windows_names.hpp"

namespace microtin::files {

// What a process gets from Windows.

namespace {

UINT code_page_before = 0;

// The console belongs to other programs too.
void restore_code_page() {
  SetConsoleOutputCP(code_page_before);
}

}  // namespace

bool hold_closed_standard_files() {
  for (std::FILE* const stream : {stdin, stdout, stderr}) {
    if (_fileno(stream) >= 0) _setmode(_fileno(stream), _O_BINARY);
  }
  code_page_before = GetConsoleOutputCP();
  if (code_page_before != 0 && code_page_before != CP_UTF8) {
    SetConsoleOutputCP(CP_UTF8);
    std::atexit(restore_code_page);
  }
  return true;
}

void make_signals_errors() {}  // Windows returns these errors

// Writing to a pipe whose reader has ended is EPIPE, or EINVAL while the pipe closes.
bool nobody_reads(int error) {
  return error == EBADF || error == EPIPE || error == EINVAL;
}

void allow_many_open_files() {
  _setmaxstdio(2048);  // the most that msvcrt.dll can
}

bool errors_go_to_terminal() {
  DWORD mode = 0;  // which only a console has
  return GetConsoleMode(GetStdHandle(STD_ERROR_HANDLE), &mode) != 0;
}

std::vector<std::string> program_arguments(int, const char* const*) {
  int count = 0;
  wchar_t** const arguments = CommandLineToArgvW(GetCommandLineW(), &count);
  std::vector<std::string> result;
  for (int i = 0; i < count; ++i) result.push_back(narrow(arguments[i]));
  LocalFree(arguments);
  return result;
}

uint64_t machine_memory() {
  MEMORYSTATUSEX status{};
  status.dwLength = sizeof status;
  return GlobalMemoryStatusEx(&status) != 0 ? status.ullTotalPhys : 0;
}

// Ctrl-C and its like, which Windows answers in a thread of its own, remove the leftovers.

namespace {

// Held while a file is created and is not yet a leftover. Once a thread may enter it twice.
struct Section {
  Section() : own() { InitializeCriticalSection(&own); }
  CRITICAL_SECTION own;
};

Section& section() {
  static Section* const only = new Section;  // never destroyed: a handler may still wait for it
  return *only;
}

// Ends the process as Windows does by default, with this status. No other file is created before.
BOOL WINAPI remove_and_die(DWORD) {
  EnterCriticalSection(&section().own);
  for_each_leftover([](const char* path) { DeleteFileW(wide(path).c_str()); });
  TerminateProcess(GetCurrentProcess(), STATUS_CONTROL_C_EXIT);
  return TRUE;
}

}  // namespace

void remove_leftovers_on_signals() {
  section();
  SetConsoleCtrlHandler(remove_and_die, TRUE);
}

SignalsHeld::SignalsHeld() {
  EnterCriticalSection(&section().own);
}

SignalsHeld::~SignalsHeld() {
  LeaveCriticalSection(&section().own);
}

}  // namespace microtin::files
