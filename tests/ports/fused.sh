#!/bin/sh
# SPDX-License-Identifier: MIT
# fused.sh SOURCES MICROTIN: builds the program for processors that multiply and add at once, with the compiler's usual
# freedom to do so, and compares its streams and packs with those of MICROTIN. Exits with 77 if this processor cannot.
set -eu
grep -qw fma /proc/cpuinfo 2>/dev/null || { echo "skipped: this processor does not multiply and add at once"; exit 77; }
build=$(mktemp -d)
trap 'rm -rf "$build"' EXIT
cmake -S "$1" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE= -DMICROTIN_TESTS=OFF -DMICROTIN_JOINED=ON -DMICROTIN_VIEWER=OFF \
  -DCMAKE_CXX_FLAGS="-O2 -mfma" >"$build/log"
cmake --build "$build" --target microtin >>"$build/log" || { tail "$build/log"; exit 1; }
cd "$build"
microtin=$2
"$microtin" fractal --size 257 --seed 5 -o t.asc
compare() { # SUFFIX OPTION...
  suffix=$1
  shift
  "$microtin" encode t.asc "$@" -o "one$suffix" >/dev/null
  ./microtin encode t.asc "$@" -o "two$suffix" >/dev/null
  cmp "one$suffix" "two$suffix"
}
compare .mtin --max-error 5
compare .mtin --max-error 5 --fast
compare .mtin --max-error 3 --never-below
compare .mtin --max-vertices 400
compare .mtp --max-error 4 --tile-vertices 300
echo "the same streams"
