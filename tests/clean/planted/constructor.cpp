// SPDX-License-Identifier: MIT
// Must be rejected by symbols.cmake: a static constructor.
extern "C" int planted();

extern const int kPlanted;
const int kPlanted = planted();
