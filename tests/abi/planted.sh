#!/bin/sh
# SPDX-License-Identifier: MIT
# planted.sh: check finds each change of the interface that is planted in a copy of the sources, and allows what programs
# that are compiled already do not notice. Exits with 77 if abidiff is not installed.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
command -v abidiff >/dev/null || { echo "skipped: abidiff is not installed"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

copy() {
  rm -rf "$work/sources"
  mkdir "$work/sources"
  cp -r "$here/../../decoder" "$here/../../encoder" "$here/../../shared" "$here/../../.ci" "$work/sources"
}

plant() { # FILE EDIT: changes a file of the copy by sed
  cp "$work/sources/$1" "$work/before"
  sed -i "$2" "$work/sources/$1"
  if cmp -s "$work/sources/$1" "$work/before"; then echo "rejected: $2 changes nothing"; exit 1; fi
}

found() { # TEXT...: check fails, and prints each text
  if "$here/check" "$work/sources" >"$work/printed"; then echo "rejected: a change was not found: $*"; exit 1; fi
  for text; do
    grep -q "$text" "$work/printed" || { cat "$work/printed"; echo "rejected: not printed: $text"; exit 1; }
  done
}

c=encoder/include/microtin/encoder.h
symbols=.ci/debian/libmicrotin1.symbols
at_end='s|^} microtin_options;|  double another;\n&|'

copy
plant decoder/include/microtin/segment.h '/^typedef struct microtin_path {/,/^}/s|int32_t|int64_t|'
plant decoder/include/microtin/microtin.h 's|MICROTIN_STATUS_MALFORMED = [0-9]*|MICROTIN_STATUS_MALFORMED = 200|'
plant $c 's|^} microtin_phase;|  double another;\n&|'
plant $c 's|^  uint32_t never_below;|  double another;\n&|'
plant encoder/exports.map 's|global:.*|global: microtin_[a-u]*;|'
found "struct microtin_path" MICROTIN_STATUS_MALFORMED "struct microtin_phase" "struct microtin_options" \
  "function .*microtin_version_number"

copy
plant $c "$at_end"
plant $c 's|^  uint32_t effort;|  uint16_t effort, half;|'
found "microtin_options::effort"

copy
plant $c 's|const double\* heights;|const float* heights;|'
found "microtin_raster_data::heights"

copy
plant $symbols 's|microtin_version_number@|microtin_gone@|'
found "not in libmicrotin1.symbols: microtin_version_number" "not in the library: microtin_gone"

copy
plant $c "$at_end"
plant $symbols '$a \ microtin_another@Base 1.0.0'
plant decoder/include/microtin/microtin.h 's|^  MICROTIN_STATUS_BAD_MAGIC|  MICROTIN_STATUS_ANOTHER = 200,\n&|'
plant encoder/product/encoder_c.cpp '$a extern "C" int microtin_another(int a); int microtin_another(int a) { return a; }'
"$here/check" "$work/sources" >"$work/printed" || { cat "$work/printed"; echo "rejected: an addition is not allowed"; exit 1; }
echo "8 changes found, 3 additions allowed"
