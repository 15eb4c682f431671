#!/bin/sh
# SPDX-License-Identifier: MIT
# Static analysis in addition to clang-tidy: of the decoder by gcc -fanalyzer, of all by the one-definition rule
# (preset odr) and by cppcheck with tests/cppcheck.
set -eu
cd "$(dirname "$0")/.."
cmake --preset release >/dev/null # for its flags
for target in microtin_decoder microtin_decoder_16; do
  for source in decoder/*.cpp; do
    flags=$(tests/flags build/release $target "$source")
    g++ $flags -O1 -fanalyzer -Werror -c "$source" -o /dev/null
  done
done
cmake --preset odr >/dev/null
cmake --build --preset odr
if ! command -v cppcheck >/dev/null; then
  echo "skipped: cppcheck is not installed"
  exit 77
fi
check() { # FOLDER TARGET SOURCE: with the paths and definitions of that source of the target
  flags=$(tests/flags build/release "$2" "$3" | tr ' ' '\n' | grep -E '^-(I|D|std)' | sed "s/^-std/--std/; s,-I$PWD/,-I,; s,-I$PWD,-I.,")
  cppcheck -j "$(nproc)" --quiet --enable=warning,portability --error-exitcode=1 --suppressions-list=tests/cppcheck \
    -i decoder/examples $flags "$1"
}
check decoder microtin_decoder decoder/decoder.cpp
check encoder microtin_encoder encoder/stream/encode.cpp
