#!/bin/sh
# SPDX-License-Identifier: MIT
# Makes a terrain, encodes it, lets an emulated Cortex-M4 decode it, and draws it. Leaves everything in
# build/demo.
set -eu
cd "$(dirname "$0")/.."
demo=$PWD/build/demo
mkdir -p "$demo"

# Runs a command silently; shows what it printed if it fails.
quietly() {
  "$@" >"$demo/log" 2>&1 || { cat "$demo/log"; exit 1; }
}

echo "== Build"
quietly cmake --workflow --preset tool
microtin=build/tool/microtin
quietly c++ -std=c++17 -O2 -I. -Idecoder/include tests/firmware/host_report.cpp build/tool/libmicrotin_decoder.a \
  -o "$demo/host_report"

echo "== A terrain of 321 x 321 posts, encoded with an error of at most 12 m"
$microtin fractal --size 321 --seed 9 -o "$demo/terrain.asc"
$microtin encode "$demo/terrain.asc" --max-error 12 -o "$demo/terrain.mtin"
$microtin verify "$demo/terrain.mtin" "$demo/terrain.asc"
echo "as 16-bit grid: $((321 * 321 * 2)) bytes"
echo "as microtin:    $(wc -c <"$demo/terrain.mtin") bytes"

echo "== The same stream in the flash of a Cortex-M4, decoded there (emulated by QEMU)"
"$demo/host_report" "$demo/terrain.mtin" >"$demo/terrain.report"
quietly cmake --preset cortex-m4 -B "$demo/cortex-m4" \
  -DMICROTIN_FIRMWARE_STREAM="$demo/terrain.mtin"
quietly cmake --build "$demo/cortex-m4" --target mps2-an386.terrain
sh toolchains/run.sh mps2-an386 "$demo/cortex-m4/tests/firmware/mps2-an386.terrain" \
  >"$demo/terrain.device"
echo "device:"
head -5 "$demo/terrain.device"
echo "host:"
head -5 "$demo/terrain.report"
cmp "$demo/terrain.device" "$demo/terrain.report"
echo "identical, all $(wc -l <"$demo/terrain.report") lines"

echo "== A picture"
$microtin render "$demo/terrain.mtin" --width 440 -o "$demo/terrain.png"
echo "build/demo/terrain.png"
