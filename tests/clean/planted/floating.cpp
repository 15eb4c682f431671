// SPDX-License-Identifier: MIT
// Must be rejected by symbols.cmake: floating point, which calls helpers on a core without
// it.
extern "C" double planted(double a, double b) {
  return a * b;
}
