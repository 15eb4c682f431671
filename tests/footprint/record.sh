#!/bin/sh
# SPDX-License-Identifier: MIT
# record.sh [PRESET...]: measures the decoder for all devices, or for some, and makes that the budget and the tables of
# shared/docs/sizes.md and the README. build/release must hold the tools.
set -eu
cd "$(dirname "$0")/../.."
[ $# -ne 0 ] || set -- cortex-m0 cortex-m3 cortex-m4 cortex-m7 cortex-m33 rv32imc rv32i avr s390x i386 wasm32 xtensa
streams=$PWD/build/devices/footprint
tests/footprint/streams.sh build/release/microtin "$streams"
measured=""
for preset; do
  cmake --preset "$preset" -DMICROTIN_FOOTPRINT_STREAMS="$streams" >/dev/null
  cmake --build --preset "$preset" --target tests/footprint/all
  ctest --test-dir "build/$preset" -R '^footprint$' >/dev/null || true  # above the budget that is to be replaced
  measured="$measured build/$preset/tests/footprint"
done
# shellcheck disable=SC2086
python3 tests/footprint/footprint.py record $measured
