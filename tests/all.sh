#!/bin/sh
# SPDX-License-Identifier: MIT
# all.sh [change|nightly]: every check of the repository, or those that each change must pass, or only the others.
# change: the release with gcc and all tests; the host again with clang, clang-tidy and sanitizers, and its quick tests; at
# the same time, since they seldom keep two processors busy, the devices that differ most; the fuzz targets for a short
# while.
# nightly: the slow tests under sanitizers, all devices, analyzers, other sanitizers, some planted faults, and the
# proof on Debian 13.
# Prints what it skips and why, and when each part began.
set -eu
cd "$(dirname "$0")/.."
export CMAKE_BUILD_PARALLEL_LEVEL="${CMAKE_BUILD_PARALLEL_LEVEL-$(nproc)}"
began=$(date +%s)

part() { echo "== $(($(date +%s) - began)) s: $*"; }

# Whether the commands are there; says which is not.
have() {
  for tool; do
    command -v "$tool" >/dev/null || { echo "skipped, without $tool"; return 1; }
  done
}

# Another generation of compilers, on a fresh Debian 13 that comes from the network.
debian_13() {
  have debootstrap || return 0
  probe=$(mktemp -d)
  if [ "$(id -u)" != 0 ] || ! timeout 120 debootstrap --print-debs trixie "$probe/trixie" >/dev/null 2>&1; then
    echo "skipped: Debian 13, which needs root and Debian's mirror"
    rm -rf "$probe"
    return 0
  fi
  rm -rf "$probe"
  .ci/prove trixie compilers
}

# Small and usual ARM, RISC-V, 16-bit int, high bytes first, WebAssembly; the others are their relatives.
unlike_devices="cortex-m0 cortex-m4 rv32imc avr s390x wasm32"

build_sanitized() {
  cmake --preset sanitize
  cmake --build --preset sanitize
}

change() {
  part release
  cmake --workflow --preset release

  log=build/beside.log
  {
    part devices
    tests/devices.sh $unlike_devices
  } >$log 2>&1 &
  beside=$!
  trap 'kill $beside 2>/dev/null || true' EXIT
  part clang, clang-tidy and sanitizers
  if have clang++ clang-tidy; then
    build_sanitized
    ctest --preset sanitize -L quick
  fi
  failed=0
  wait $beside || failed=$?
  trap - EXIT
  cat $log
  [ $failed -eq 0 ] || exit $failed

  part fuzz targets
  if have clang++; then cmake --workflow --preset fuzz; fi
}

nightly() {
  part slow tests under sanitizers
  if have clang++ clang-tidy; then
    build_sanitized
    # Without the preset, whose filter is in the way of another one.
    ctest --test-dir build/sanitize --output-on-failure --no-tests=error -j "$(nproc)" -LE '^(quick|once)$'
  fi
  part strict sanitizers
  if have clang++; then fuzz/strict; fi
  part devices
  cmake --preset release
  cmake --build --preset release
  tests/devices.sh
  part analyzers
  tests/analyse.sh || [ $? -eq 77 ] # skipped
  part planted faults
  fuzz/mutate cavity_bound certified no_conflict staged_bytes tie_break
  part Debian 13
  debian_13
}

case ${1-} in
  change | nightly) $1 ;;
  '')
    change
    nightly
    ;;
  *)
    echo "usage: all.sh [change|nightly]" >&2
    exit 2
    ;;
esac
