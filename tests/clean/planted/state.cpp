// SPDX-License-Identifier: MIT
// Must be rejected by symbols.cmake: global state.
extern "C" int planted() {
  static int calls;
  return ++calls;
}
