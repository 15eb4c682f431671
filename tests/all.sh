#!/bin/sh
# SPDX-License-Identifier: MIT
# Builds every preset and runs its tests: the release; clang with clang-tidy and, at the same time, what seldom keeps
# two processors busy, the devices, analyzers and some planted faults; other sanitizers; the fuzz targets for a short
# while; and the sanitizers. Says what it skips for want of a compiler, and when each part began.
set -eu
cd "$(dirname "$0")/.."
export CMAKE_BUILD_PARALLEL_LEVEL="${CMAKE_BUILD_PARALLEL_LEVEL-$(nproc)}"
began=$(date +%s)

part() { echo "== $(($(date +%s) - began)) s: $*"; }

# Whether the commands are there; says which is not.
have() {
  for tool; do
    command -v "$tool" >/dev/null || { echo "skipped, for want of $tool"; return 1; }
  done
}

beside() {
  part devices
  tests/devices.sh
  part analyzers
  tests/analyse.sh || [ $? -eq 77 ] # skipped
  part planted faults
  fuzz/mutate cavity_bound certified no_conflict staged_bytes tie_break
}

part release
cmake --workflow --preset release

log=build/beside.log
beside >$log 2>&1 &
beside=$!
trap 'kill $beside 2>/dev/null || true' EXIT
part clang with clang-tidy
if have clang++ clang-tidy; then cmake --workflow --preset clang; fi
failed=0
wait $beside || failed=$?
trap - EXIT
cat $log
[ $failed -eq 0 ] || exit $failed

part strict sanitizers
if have clang++; then fuzz/strict; fi
part fuzz targets
if have clang++; then cmake --workflow --preset fuzz; fi
part sanitizers
cmake --workflow --preset sanitize
