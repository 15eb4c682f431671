#!/bin/sh
# SPDX-License-Identifier: MIT
# Run in the repository's root. Builds the targets as OSS-Fuzz wants them, with the compiler, flags and engine of the
# environment, into $OUT: each with its seeds, past findings, dictionary and the length of its inputs
# (fuzz/targets/list).
set -eu
source=$PWD
build=$WORK/microtin
cmake -S "$source" -B "$build" -G Ninja -DMICROTIN_FUZZ=ON -DMICROTIN_TESTS=OFF -DMICROTIN_VIEWER=OFF \
  "-DMICROTIN_FUZZ_ENGINE=$LIB_FUZZING_ENGINE"
cmake --build "$build" --target fuzz_targets

grep '^[a-z]' "$source/fuzz/targets/list" | while read -r name _ length seeds dictionary _; do
  target=$OUT/${name}_fuzz
  cp "$build/fuzz/${name}_fuzz" "$target"
  printf '[libfuzzer]\nmax_len = %s\n' "$length" >"$target.options"
  [ "$dictionary" = - ] || cp "$source/fuzz/$dictionary.dict" "$target.dict"
  corpus=$WORK/corpus-$name
  rm -rf "$corpus"
  mkdir "$corpus"
  case $seeds in
    golden) cp "$source"/tests/golden/1.0/*.mtin "$corpus" ;;
    own) cp "$source/fuzz/seeds/$name"/* "$corpus" ;;
  esac
  [ ! -d "$source/fuzz/findings/$name" ] || cp "$source/fuzz/findings/$name"/* "$corpus"
  [ -z "$(ls "$corpus")" ] || (cd "$corpus" && cmake -E tar cf "${target}_seed_corpus.zip" --format=zip .)
done
