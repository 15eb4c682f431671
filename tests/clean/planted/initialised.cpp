// SPDX-License-Identifier: MIT
// Must be rejected by symbols.cmake: global state that does not start as zero.
extern "C" int planted() {
  static int calls = 7;
  return ++calls;
}
