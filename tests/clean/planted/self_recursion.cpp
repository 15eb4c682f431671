// SPDX-License-Identifier: MIT
// Must be rejected by callgraph.py: a function that calls itself.
extern "C" int planted(int n) {
  return n < 2 ? n : planted(n - 1) * planted(n - 2);
}
