#!/bin/sh
# Builds every preset and runs its tests: the device alone, the fuzz targets for half a minute, clang with
# clang-tidy, the sanitizers, and last the release with the comparison of host and device.
set -eu
cd "$(dirname "$0")/.."
for preset in cortex-m4 fuzz clang sanitize release; do
  cmake --workflow --preset "$preset"
done
