#!/bin/sh
# Builds every preset and runs its tests: the release and the devices; other sanitizers and analyzers; the fuzz
# targets for a short while and some planted faults; clang with clang-tidy; and the sanitizers.
set -eu
cd "$(dirname "$0")/.."
cmake --workflow --preset release
tests/devices.sh
fuzz/strict
tests/analyse.sh || [ $? -eq 77 ] # skipped
cmake --workflow --preset fuzz
fuzz/mutate cavity_bound certified no_conflict staged_bytes tie_break
cmake --workflow --preset clang
cmake --workflow --preset sanitize
