// SPDX-License-Identifier: MIT
// A firmware program as a module of WebAssembly, with one import and one export.
#include "toolchains/firmware.h"

extern "C" __attribute__((import_module("console"), import_name("put"))) void put(int c);

void put_char(char c) {
  put(c);
}

extern "C" __attribute__((export_name("run"))) int run() {
  return firmware_main();
}
