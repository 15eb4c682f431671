// SPDX-License-Identifier: MIT
// Ctrl-C and its like, which Windows answers in a thread of its own, remove the leftovers.
#include "encoder/files/leftovers.hpp"
#include "encoder/files/windows_names.hpp"

namespace microtin::files {
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
