// SPDX-License-Identifier: MIT
// Must be rejected by symbols.cmake: global state behind a hundred sections.
template <int kNumber>
int next() {
  return next<kNumber - 1>() + 1;
}

template <>
int next<0>() {
  static int calls;
  return ++calls;
}

extern "C" int planted() {
  return next<100>();
}
