#!/bin/sh
# Builds every preset and runs its tests: the release, the devices, the fuzz targets for a short while, clang with
# clang-tidy, and the sanitizers.
set -eu
cd "$(dirname "$0")/.."
cmake --workflow --preset release
tests/devices.sh
for preset in fuzz clang sanitize; do
  cmake --workflow --preset "$preset"
done
