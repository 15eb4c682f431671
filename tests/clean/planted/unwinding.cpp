// SPDX-License-Identifier: MIT
// Must be rejected by symbols.cmake when compiled with unwind tables.
extern "C" int planted(int a) {
  return a + 1;
}
