#!/bin/sh
# Builds every preset and runs its tests: the fuzz targets for half a minute, clang with clang-tidy, the
# sanitizers, the release, and last the devices.
set -eu
cd "$(dirname "$0")/.."
for preset in fuzz clang sanitize release; do
  cmake --workflow --preset "$preset"
done
tests/devices.sh
