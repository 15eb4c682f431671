// SPDX-License-Identifier: MIT
// A firmware program as a program of Linux.
#include <stdio.h>

#include "toolchains/firmware.h"

void put_char(char c) {
  putchar(c);
}

int main() {
  return firmware_main();
}
