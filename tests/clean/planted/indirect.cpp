// SPDX-License-Identifier: MIT
// Must be rejected by callgraph.py: a call of whatever a pointer holds.
extern "C" int planted(int (*function)()) {
  return function() + 1;
}
