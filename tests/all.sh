#!/bin/sh
# Builds every preset and runs its tests: the fuzz targets for half a minute, clang with clang-tidy, the
# sanitizers, the release; other sanitizers and analyzers; some planted faults; and last the devices.
set -eu
cd "$(dirname "$0")/.."
for preset in fuzz clang sanitize release; do
  cmake --workflow --preset "$preset"
done
fuzz/strict
tests/analyse.sh || [ $? -eq 77 ] # skipped
fuzz/mutate cavity_bound certified no_conflict staged_bytes tie_break
tests/devices.sh
