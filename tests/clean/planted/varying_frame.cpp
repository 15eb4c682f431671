// SPDX-License-Identifier: MIT
// Must be rejected by callgraph.py: a frame whose size depends on data.
extern "C" void fill(void* bytes);

extern "C" void planted(unsigned size) {
  fill(__builtin_alloca(size));
}
