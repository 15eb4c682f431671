#!/bin/sh
# SPDX-License-Identifier: MIT
# devices.sh [PRESET...]: builds the presets for devices, or some of them, and runs their tests under emulation,
# on the repository's streams and on a terrain that build/release encodes now. A preset without its compiler is
# skipped and says so.
set -eu
cd "$(dirname "$0")/.."
[ $# -ne 0 ] || set -- cortex-m0 cortex-m3 cortex-m4 cortex-m7 cortex-m33 rv32imc rv32i avr s390x i386 \
  wasm32 xtensa

tools_for() {
  case $1 in
    cortex-*) echo arm-none-eabi-g++ ;;
    rv32*) echo riscv64-unknown-elf-g++ ;;
    avr) echo avr-g++ ;;
    s390x) echo s390x-linux-gnu-g++ ;;
    i386) echo i686-linux-gnu-g++ ;;
    wasm32) echo clang++ wasm-ld llvm-ar obj2yaml ;;
    xtensa) echo xtensa-lx106-elf-g++ ;;
  esac
}

# A terrain that the smallest device holds, and what the host says of it.
terrain=$PWD/build/devices/terrain
mkdir -p build/devices
build/release/microtin fractal --size 193 --seed 9 -o "$terrain.asc"
build/release/microtin encode "$terrain.asc" --max-vertices 300 -o "$terrain.mtin"
build/release/tests/host_report "$terrain.mtin" >"$terrain.report"

build/release/microtin embed tests/golden/1.0/hills.mtin -o build/devices/terrain.h
# What the module for browsers is tested on.
area=build/devices/area
tests/npm/area build/release/microtin $area
tests/footprint/streams.sh build/release/microtin build/devices/footprint

for preset; do
  missing=$(for tool in $(tools_for "$preset"); do command -v "$tool" >/dev/null || echo "$tool"; done)
  if [ -n "$missing" ]; then
    echo "skipped: $preset, without" $missing
    continue
  fi
  cmake --preset "$preset" -DMICROTIN_FIRMWARE_STREAM="$terrain.mtin" \
    -DMICROTIN_FOOTPRINT_STREAMS="$PWD/build/devices/footprint" -DMICROTIN_EMBEDDED="$PWD/build/devices"
  cmake --build --preset "$preset"
  ctest --preset "$preset"
  sed -n 's/^ *\(skipped: .*\)/\1/p' "build/$preset/Testing/Temporary/LastTest.log" | sort -u
done
