#!/bin/sh
# SPDX-License-Identifier: MIT
# width.sh INCLUDE COMPILER: the width of numbers that microtin/config.h chooses, for each list of predefined macros; and
# for each compiler of a device that is installed, by its own.
set -eu
include=$1 compiler=$2

bits() { printf '#include "microtin/config.h"\nbits MICROTIN_INDEX_BITS\n' | "$@" -I"$include" -E -x c++ - | sed -n 's/^bits //p'; }

expect() {
  wanted=$1
  shift
  found=$(bits "$@")
  if [ "$found" != "$wanted" ]; then
    echo "rejected: $* has $found bits, not $wanted"
    exit 1
  fi
}

# A platform is its macros, and none of the compiler's own.
platform() {
  wanted=$1
  shift
  expect "$wanted" "$compiler" -undef "$@"
}

platform 16 -D__AVR__
platform 16 -D__arm__
platform 16 -D__xtensa__
platform 16 -D__riscv -D__riscv_xlen=32
platform 32 -D__riscv -D__riscv_xlen=64
for system in __linux__ __unix__ __APPLE__ _WIN32; do
  platform 32 -D$system -D__arm__
  platform 32 -D$system -D__xtensa__
  platform 32 -D$system -D__riscv -D__riscv_xlen=32
done
for other in __i386__ __x86_64__ __aarch64__ __wasm__ __s390x__ __powerpc__; do platform 32 -D$other; done
platform 32 -D__AVR__ -DMICROTIN_INDEX_BITS=32

device() {
  if command -v "$2" >/dev/null; then expect "$@"; else echo "skipped: $2 is not installed"; fi
}

device 16 arm-none-eabi-g++ -mcpu=cortex-m4 -mthumb
device 16 riscv64-unknown-elf-g++ -march=rv32imc -mabi=ilp32
device 32 riscv64-unknown-elf-g++ -march=rv64gc -mabi=lp64 -ffreestanding
device 16 avr-g++
device 16 xtensa-lx106-elf-g++
device 32 s390x-linux-gnu-g++
device 32 i686-linux-gnu-g++
device 16 clang++ --target=arm-none-eabi -mcpu=cortex-m4
device 16 clang++ --target=riscv32-unknown-elf
device 32 clang++ --target=arm-linux-gnueabihf
device 32 clang++ --target=wasm32
echo "all as said"
